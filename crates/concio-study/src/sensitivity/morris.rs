//! Elementary effects.
//!
//! (M1)  d_i = [y(x + Δ e_i) − y(x)]/Δ,   μ = mean d,   μ* = mean |d|,   σ = deviation of d
//!
//! x runs over 0 … 1: the share of a distribution, the value of a list between its least and its largest, names at equal
//! distances. So an effect is that of the factor's whole range in the unit of the measure. μ* ranks the factors (F.
//! Campolongo, J. Cariboni, A. Saltelli, Environ. Model. Softw. 22 (2007) 1509); σ beside it tells curvature and
//! interaction from a straight line (Morris 1991).

use super::{Bootstrap, Index};

/// Effects of one factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effect {
    /// μ.
    pub mean: Index,
    /// μ*.
    pub absolute: Index,
    /// σ, over one less than the trajectories.
    pub deviation: Index,
}

/// Effects of `k` factors from trajectories of k + 1 rows each. Trajectories with a run without value are left out.
///
/// # Errors
/// Fewer than two whole trajectories.
pub fn effects(
    shares: &[Vec<f64>],
    values: &[Option<f64>],
    k: usize,
    bootstrap: &Bootstrap,
) -> Result<Vec<Effect>, String> {
    let trajectories: Vec<Vec<f64>> =
        shares.chunks(k + 1).zip(values.chunks(k + 1)).filter_map(|(x, y)| elementary(x, y, k)).collect();
    if trajectories.len() < 2 {
        return Err(format!("only {} trajectories are complete; it takes two", trajectories.len()));
    }
    let indices = bootstrap.indices(trajectories.len(), &|parts| {
        let of = |factor: usize| {
            let n = parts.len() as f64;
            let d = || parts.iter().map(|&t| trajectories[t][factor]);
            let mean = d().sum::<f64>() / n;
            let absolute = d().map(f64::abs).sum::<f64>() / n;
            let deviation = (d().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
            [mean, absolute, deviation]
        };
        (0..k).flat_map(of).collect()
    });
    Ok(indices.chunks(3).map(|i| Effect { mean: i[0], absolute: i[1], deviation: i[2] }).collect())
}

/// (M1) along a trajectory, one per factor.
fn elementary(x: &[Vec<f64>], y: &[Option<f64>], k: usize) -> Option<Vec<f64>> {
    let mut effects = vec![0.0; k];
    for (x, y) in x.windows(2).zip(y.windows(2)) {
        let factor = (0..k).find(|&f| x[0][f] != x[1][f])?;
        effects[factor] = (y[1]? - y[0]?) / (x[1][factor] - x[0][factor]);
    }
    (y.len() == k + 1).then_some(effects)
}
