//! Bending strength of a dry running bond per length, under the pressure n per length:
//!
//! (H8) M22 = n t/2,  M11 = μ n b r̄/(2a)
//! (H9) r̄ = d/6 + c²/(12 t) ln((t + d)/c) + t²/(12 c) ln((c + d)/t),  d² = c² + t²
//!
//! Bed joints open about an edge, or turn on their friction: r̄ is the mean distance of a contact c × t from its middle. The
//! pressure is uniform over a contact; free to go to the corners it would bear up to 1.85 times M11. Blocks do not crush.

use crate::running::RunningBond;

/// Bending strength per length [N].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Bending {
    /// M11: courses bend horizontally.
    pub m11: f64,
    /// M22: the wall bends about a bed joint.
    pub m22: f64,
}

/// (H8) of a wall under `pressure` per length, from 0 [N/m], with friction μ, from 0.
pub fn dry_bending(bond: &RunningBond, friction: f64, pressure: f64) -> Bending {
    let m11 = friction * pressure * bond.pitch * mean_distance(bond.contact, bond.thickness) / (2.0 * bond.rise);
    Bending { m11, m22: 0.5 * pressure * bond.thickness }
}

/// (H9): mean distance of a rectangle from its middle [m].
fn mean_distance(c: f64, t: f64) -> f64 {
    let d = c.hypot(t);
    d / 6.0 + c * c / (12.0 * t) * ((t + d) / c).ln() + t * t / (12.0 * c) * ((c + d) / t).ln()
}

#[cfg(test)]
mod tests {
    use super::mean_distance;

    #[test]
    fn the_mean_distance_is_that_of_a_grid_of_points() {
        for (c, t) in [(0.13, 0.12), (0.2, 0.3), (0.05, 0.5)] {
            let n = 400;
            let at = |k: usize, l: f64| ((k as f64 + 0.5) / f64::from(n) - 0.5) * l;
            let sum: f64 = (0..n as usize)
                .flat_map(|i| (0..n as usize).map(move |j| (i, j)))
                .map(|(i, j)| at(i, c).hypot(at(j, t)))
                .sum();
            let mean = sum / f64::from(n * n);
            assert!((mean_distance(c, t) / mean - 1.0).abs() < 1e-5, "{c} × {t}: {} {mean}", mean_distance(c, t));
        }
    }
}
