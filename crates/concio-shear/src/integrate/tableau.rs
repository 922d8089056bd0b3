//! Singly diagonally implicit Runge–Kutta schemes with an explicit first stage (ESDIRK), stiffly accurate:
//! the last stage is the end of the step.
//!
//!   (S1)  Y_i = y_n + h Σ_{j≤i} a_ij f(t_n + c_j h, Y_j),   y_{n+1} = Y_s,   a_ii = γ for i > 1
//!
//! References: Bank et al., IEEE Trans. Electron Devices 32 (1985) 1992 and Hosea & Shampine, Appl. Numer. Math. 20
//! (1996) 21 (TR-BDF2 with its third-order companion); Kennedy & Carpenter, Appl. Numer. Math. 44 (2003) 139
//! (ARK4(3)6L\[2\]SA, implicit part).

use crate::system::Scheme;

/// Most stages of any scheme here.
pub const STAGES: usize = 6;

/// Coefficients of a scheme.
#[derive(Debug, Clone, Copy)]
pub struct Tableau {
    /// Number of stages, the explicit one included.
    pub stages: usize,
    /// Order of the result.
    #[cfg_attr(not(test), expect(dead_code, reason = "read by the tests of the order"))]
    pub order: u32,
    /// γ.
    pub diagonal: f64,
    /// a_ij, strictly below the diagonal.
    pub a: [[f64; STAGES]; STAGES],
    /// Weights of the result.
    pub b: [f64; STAGES],
    /// b − b̂: weights of the error estimate.
    pub error: [f64; STAGES],
    /// c.
    pub c: [f64; STAGES],
    /// Power of h that the error estimate grows with.
    pub error_order: f64,
}

/// The coefficients of `scheme`.
pub fn tableau(scheme: Scheme) -> Tableau {
    match scheme {
        Scheme::TrBdf2 => tr_bdf2(),
        Scheme::Esdirk4 => esdirk4(),
    }
}

fn tr_bdf2() -> Tableau {
    let g = 2.0 - std::f64::consts::SQRT_2;
    let (d, w) = (g / 2.0, std::f64::consts::SQRT_2 / 4.0);
    let embedded = [(1.0 - w) / 3.0, (3.0 * w + 1.0) / 3.0, d / 3.0];
    let mut t = Tableau {
        stages: 3,
        order: 2,
        diagonal: d,
        a: [[0.0; STAGES]; STAGES],
        b: [w, w, d, 0.0, 0.0, 0.0],
        error: [0.0; STAGES],
        c: [0.0, g, 1.0, 0.0, 0.0, 0.0],
        error_order: 3.0,
    };
    t.a[1][0] = d;
    t.a[2][..2].copy_from_slice(&[w, w]);
    for (i, &e) in embedded.iter().enumerate() {
        t.error[i] = t.b[i] - e;
    }
    t
}

fn esdirk4() -> Tableau {
    let mut t = Tableau {
        stages: 6,
        order: 4,
        diagonal: 0.25,
        a: [[0.0; STAGES]; STAGES],
        b: [82889.0 / 524892.0, 0.0, 15625.0 / 83664.0, 69875.0 / 102672.0, -2260.0 / 8211.0, 0.25],
        error: [0.0; STAGES],
        c: [0.0, 0.5, 83.0 / 250.0, 31.0 / 50.0, 17.0 / 20.0, 1.0],
        error_order: 4.0,
    };
    t.a[1][0] = 0.25;
    t.a[2][..2].copy_from_slice(&[8611.0 / 62500.0, -1743.0 / 31250.0]);
    t.a[3][..3].copy_from_slice(&[5012029.0 / 34652500.0, -654441.0 / 2922500.0, 174375.0 / 388108.0]);
    t.a[4][..4].copy_from_slice(&[
        15267082809.0 / 155376265600.0,
        -71443401.0 / 120774400.0,
        730878875.0 / 902184768.0,
        2285395.0 / 8070912.0,
    ]);
    t.a[5] = t.b;
    t.a[5][5] = 0.0;
    let embedded = [
        4586570599.0 / 29645900160.0,
        0.0,
        178811875.0 / 945068544.0,
        814220225.0 / 1159782912.0,
        -3700637.0 / 11593932.0,
        61727.0 / 225920.0,
    ];
    for (i, &e) in embedded.iter().enumerate() {
        t.error[i] = t.b[i] - e;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Order conditions (Hairer, Nørsett, Wanner, *Solving ODEs I*, II.2) up to the order of the result, for the
    /// embedded weights up to theirs, and the row sums.
    #[test]
    fn order_conditions_hold() {
        for scheme in [Scheme::TrBdf2, Scheme::Esdirk4] {
            let t = tableau(scheme);
            let mut a = t.a;
            for i in 1..t.stages {
                a[i][i] = t.diagonal;
                let sum: f64 = a[i].iter().sum();
                assert!((sum - t.c[i]).abs() < 1e-14, "{scheme:?} row {i}");
            }
            let mut embedded = t.b;
            for i in 0..t.stages {
                embedded[i] -= t.error[i];
            }
            let c2 = t.c.map(|c| c * c);
            let c3 = t.c.map(|c| c * c * c);
            let mul =
                |x: [f64; STAGES]| std::array::from_fn::<f64, STAGES, _>(|i| (0..STAGES).map(|j| a[i][j] * x[j]).sum());
            let times = |x: [f64; STAGES], y: [f64; STAGES]| std::array::from_fn::<f64, STAGES, _>(|i| x[i] * y[i]);
            let conditions: [(u32, [f64; STAGES], f64); 8] = [
                (1, [1.0; STAGES], 1.0),
                (2, t.c, 1.0 / 2.0),
                (3, c2, 1.0 / 3.0),
                (3, mul(t.c), 1.0 / 6.0),
                (4, c3, 1.0 / 4.0),
                (4, times(t.c, mul(t.c)), 1.0 / 8.0),
                (4, mul(c2), 1.0 / 12.0),
                (4, mul(mul(t.c)), 1.0 / 24.0),
            ];
            let embedded_order = 3;
            for (order, vector, value) in conditions {
                for (weights, holds_to) in [(t.b, t.order), (embedded, embedded_order)] {
                    let sum: f64 = (0..t.stages).map(|i| weights[i] * if order == 1 { 1.0 } else { vector[i] }).sum();
                    if order <= holds_to {
                        assert!((sum - value).abs() < 1e-13, "{scheme:?} order {order}: {sum} against {value}");
                    }
                }
            }
        }
    }
}
