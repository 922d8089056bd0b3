//! The motion inside an accepted step.
//!
//!   (S2)  v(t_n + θh) = Σ_i L_i(θ) V_i,   z(t_n + θh) = Σ_i L_i(θ) Z_i   (TR-BDF2)
//!   (S3)  z, v = cubic Hermite polynomials through (z, v) and (v, a) at both ends   (ESDIRK4)
//!
//! L_i are the Lagrange polynomials on the stages' instants c_i. (S2) is built from the stages alone, which the scheme
//! damps: the acceleration at the start of a step that passes over a stiff transient would overshoot in (S3). It is of
//! second order like TR-BDF2 itself, its error a third of the step's; (S3) is of third order, for smooth motion.

use crate::integrate::tableau::STAGES;
use crate::system::Scheme;

/// Weights of the stages' velocities and accelerations at one instant θ of a step of `h`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// z = z_n + Σ `of_z[i]` V_i + `of_end` (z_{n+1} − z_n) [s].
    pub of_z: [f64; STAGES],
    pub of_end: f64,
    /// v = Σ `of_v[i]` V_i + Σ `of_a[i]` A_i.
    pub of_v: [f64; STAGES],
    pub of_a: [f64; STAGES],
    /// a = Σ `rate_v[i]` V_i + Σ `rate_a[i]` A_i.
    pub rate_v: [f64; STAGES],
    pub rate_a: [f64; STAGES],
}

/// The weights at θ = `x` in a step of `h` [s] whose last stage is `last`.
pub fn weights(scheme: Scheme, c: &[f64; STAGES], last: usize, x: f64, h: f64) -> Weights {
    let zero = [0.0; STAGES];
    let mut w = Weights { of_z: zero, of_end: 0.0, of_v: zero, of_a: zero, rate_v: zero, rate_a: zero };
    match scheme {
        Scheme::TrBdf2 => {
            let l = lagrange([c[0], c[1], c[2]], x);
            w.of_v[..3].copy_from_slice(&l);
            w.rate_a[..3].copy_from_slice(&l);
            // Z_1 − z_n = c_1 h (V_0 + V_1)/2, the trapezoidal stage.
            w.of_z[0] = 0.5 * c[1] * h * l[1];
            w.of_z[1] = w.of_z[0];
            w.of_end = l[2];
        }
        Scheme::Esdirk4 => {
            let [end, from, to] = hermite(x);
            w.of_end = end;
            (w.of_z[0], w.of_z[last]) = (h * from, h * to);
            (w.of_v[0], w.of_v[last]) = (1.0 - end, end);
            (w.of_a[0], w.of_a[last]) = (h * from, h * to);
            let rise = 6.0 * x * (1.0 - x) / h;
            (w.rate_v[0], w.rate_v[last]) = (-rise, rise);
            (w.rate_a[0], w.rate_a[last]) = (1.0 - 4.0 * x + 3.0 * x * x, 3.0 * x * x - 2.0 * x);
        }
    }
    w
}

/// Quadratic through 1 at one of `nodes` and 0 at the others, for each.
fn lagrange(nodes: [f64; 3], x: f64) -> [f64; 3] {
    std::array::from_fn(|i| {
        let [j, k] = [nodes[(i + 1) % 3], nodes[(i + 2) % 3]];
        (x - j) * (x - k) / ((nodes[i] - j) * (nodes[i] - k))
    })
}

/// Cubic Hermite polynomials on [0, 1]: of the value at the end, of the slopes at the start and at the end.
pub fn hermite(x: f64) -> [f64; 3] {
    [x * x * (3.0 - 2.0 * x), x * (1.0 - x) * (1.0 - x), x * x * (x - 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::tableau::tableau;

    /// Polynomials that the interpolants contain come out exactly: v of degree 2 (S2), z and v of degree 3 (S3).
    #[test]
    fn polynomials_are_kept() {
        for (scheme, degree) in [(Scheme::TrBdf2, 2), (Scheme::Esdirk4, 3)] {
            let (t, h) = (tableau(scheme), 0.3);
            let last = t.stages - 1;
            let v: [f64; STAGES] = std::array::from_fn(|i| (t.c[i] * h).powi(degree) - 0.4);
            let a: [f64; STAGES] = std::array::from_fn(|i| f64::from(degree) * (t.c[i] * h).powi(degree - 1));
            for x in [0.0, 0.2, 0.7, 1.0] {
                let w = weights(scheme, &t.c, last, x, h);
                let dot = |p: &[f64; STAGES], q: &[f64; STAGES]| -> f64 { p.iter().zip(q).map(|(p, q)| p * q).sum() };
                let at = x * h;
                assert!((dot(&w.of_v, &v) + dot(&w.of_a, &a) - (at.powi(degree) - 0.4)).abs() < 1e-14, "{scheme:?}");
                let rate = f64::from(degree) * at.powi(degree - 1);
                assert!((dot(&w.rate_v, &v) + dot(&w.rate_a, &a) - rate).abs() < 1e-13, "{scheme:?}");
            }
            // z = t² of z' = 2 t, which both contain.
            let v: [f64; STAGES] = std::array::from_fn(|i| 2.0 * t.c[i] * h);
            let w = weights(scheme, &t.c, last, 0.37, h);
            let z: f64 = w.of_z.iter().zip(&v).map(|(w, v)| w * v).sum::<f64>() + w.of_end * h * h;
            assert!((z - (0.37 * h).powi(2)).abs() < 1e-15, "{scheme:?}: {z}");
        }
    }
}
