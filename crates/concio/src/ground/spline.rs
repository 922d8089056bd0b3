//! Cubic splines through equidistant samples. Their second derivative is linear between samples, so a displacement history
//! becomes the same kind of motion as an accelerogram.

/// How a spline ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ends {
    /// Without curvature: a natural spline.
    Natural,
    /// Without slope: what it describes starts and ends at rest.
    AtRest,
}

/// Second derivatives at the samples: M_{k−1} + 4 M_k + M_{k+1} = 6 (u_{k−1} − 2 u_k + u_{k+1})/dt², at the ends M = 0, or
/// 2 M_0 + M_1 = 6 (u_1 − u_0)/dt² and its mirror image. The matrix is diagonally dominant, so elimination needs no pivots.
pub(super) fn second_derivatives(dt: f64, u: &[f64], ends: Ends) -> Vec<f64> {
    let n = u.len();
    let (mut m, mut upper) = (vec![0.0; n], vec![0.0; n]);
    let at_rest = ends == Ends::AtRest && n > 1;
    let right = |difference: f64| 6.0 * difference / (dt * dt);
    if at_rest {
        (upper[0], m[0]) = (0.5, 0.5 * right(u[1] - u[0]));
    }
    for k in 1..n.saturating_sub(1) {
        let pivot = 4.0 - upper[k - 1];
        upper[k] = 1.0 / pivot;
        m[k] = (right(u[k - 1] - 2.0 * u[k] + u[k + 1]) - m[k - 1]) / pivot;
    }
    if at_rest {
        m[n - 1] = (right(u[n - 2] - u[n - 1]) - m[n - 2]) / (2.0 - upper[n - 2]);
    }
    for k in (0..n.saturating_sub(1)).rev() {
        m[k] -= upper[k] * m[k + 1];
    }
    m
}

/// First derivatives at the samples of the spline through `u` with second derivatives `m`.
pub(super) fn first_derivatives(dt: f64, u: &[f64], m: &[f64]) -> Vec<f64> {
    let n = u.len();
    (0..n)
        .map(|k| match (k + 1 < n, k > 0) {
            (true, _) => (u[k + 1] - u[k]) / dt - dt * (2.0 * m[k] + m[k + 1]) / 6.0,
            (false, true) => (u[k] - u[k - 1]) / dt + dt * (2.0 * m[k] + m[k - 1]) / 6.0,
            (false, false) => 0.0,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reproduces_a_spline_exactly() {
        // u'' rises linearly from 0 to L and falls back to 0: a natural spline itself, with closed-form u and u'.
        let (dt, half) = (0.25, 8);
        let l = dt * half as f64;
        let closed = |x: f64| {
            let y = (x - l).max(0.0);
            match x <= l {
                true => (x.powi(3) / 6.0, x * x / 2.0, x),
                false => (
                    l.powi(3) / 6.0 + l * l * y / 2.0 + l * y * y / 2.0 - y.powi(3) / 6.0,
                    l * l / 2.0 + l * y - y * y / 2.0,
                    l - y,
                ),
            }
        };
        let exact: Vec<_> = (0..=2 * half).map(|k| closed(k as f64 * dt)).collect();
        let u: Vec<f64> = exact.iter().map(|e| e.0).collect();
        let m = second_derivatives(dt, &u, Ends::Natural);
        let v = first_derivatives(dt, &u, &m);
        for (k, (_, slope, curvature)) in exact.iter().enumerate() {
            assert!((m[k] - curvature).abs() < 1e-12 && (v[k] - slope).abs() < 1e-12, "sample {k}");
        }
    }

    #[test]
    fn two_samples_make_a_line() {
        let m = second_derivatives(0.5, &[1.0, 2.0], Ends::Natural);
        assert_eq!(m, [0.0, 0.0]);
        assert_eq!(first_derivatives(0.5, &[1.0, 2.0], &m), [2.0, 2.0]);
    }

    #[test]
    fn a_spline_at_rest_at_its_ends_reproduces_a_cubic() {
        // u = x² (3 − 2 x): u' = 0 at 0 and 1, u'' = 6 − 12 x.
        let (dt, n) = (0.125, 9);
        let u: Vec<f64> = (0..n).map(|k| f64::from(k) * dt).map(|x| x * x * (3.0 - 2.0 * x)).collect();
        let m = second_derivatives(dt, &u, Ends::AtRest);
        for (k, m) in m.iter().enumerate() {
            assert!((m - (6.0 - 12.0 * k as f64 * dt)).abs() < 1e-11, "sample {k}: {m}");
        }
        let v = first_derivatives(dt, &u, &m);
        assert!(v[0].abs() < 1e-12 && v[n as usize - 1].abs() < 1e-12);
        assert_eq!(second_derivatives(dt, &[1.0], Ends::AtRest), [0.0]);
    }
}
