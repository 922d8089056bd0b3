//! Natural cubic spline through equidistant samples. Its second derivative is linear between samples, so a
//! displacement history becomes the same kind of motion as an accelerogram.

/// Second derivatives at the samples: M_{k−1} + 4 M_k + M_{k+1} = 6 (u_{k−1} − 2 u_k + u_{k+1})/dt², zero at both
/// ends. The matrix is diagonally dominant, so elimination needs no pivots.
pub(super) fn second_derivatives(dt: f64, u: &[f64]) -> Vec<f64> {
    let n = u.len();
    let mut m = vec![0.0; n];
    if n < 3 {
        return m;
    }
    let mut upper = vec![0.0; n];
    for k in 1..n - 1 {
        let right = 6.0 * (u[k - 1] - 2.0 * u[k] + u[k + 1]) / (dt * dt);
        let pivot = 4.0 - upper[k - 1];
        upper[k] = 1.0 / pivot;
        m[k] = (right - m[k - 1]) / pivot;
    }
    for k in (1..n - 1).rev() {
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
        let m = second_derivatives(dt, &u);
        let v = first_derivatives(dt, &u, &m);
        for (k, (_, slope, curvature)) in exact.iter().enumerate() {
            assert!((m[k] - curvature).abs() < 1e-12 && (v[k] - slope).abs() < 1e-12, "sample {k}");
        }
    }

    #[test]
    fn two_samples_make_a_line() {
        let m = second_derivatives(0.5, &[1.0, 2.0]);
        assert_eq!(m, [0.0, 0.0]);
        assert_eq!(first_derivatives(0.5, &[1.0, 2.0], &m), [2.0, 2.0]);
    }
}
