//! Shares of the variance.
//!
//! With base points A, B and A_i, which is A with column i of B (A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259,
//! table 2 (b) and (f), the latter by M. Jansen, Comput. Phys. Commun. 117 (1999) 35):
//!
//! (V1)  S_i V = mean[ f(B) (f(A_i) − f(A)) ],   T_i V = ½ mean[ (f(A) − f(A_i))² ]
//!
//! V is the variance of f(A) and f(B) together; their mean is taken off f first, which changes (V1) by nothing in the mean
//! and takes most of its scatter away where f is far from 0. The interval of T_i is that of its logarithm.

use super::{Index, jackknife};

/// Shares of one factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// S: of the factor alone.
    pub first: Index,
    /// T: of the factor and all its interactions.
    pub total: Index,
}

/// Shares of `k` factors from k + 2 blocks of equally many rows: A, B, A_1 … A_k. Base points with a run without value are
/// left out.
///
/// # Errors
/// Fewer than two whole base points; a measure that does not vary.
pub fn shares(values: &[Option<f64>], k: usize, confidence: f64) -> Result<Vec<Shares>, String> {
    let n = values.len() / (k + 2);
    let point = |i: usize| (0..k + 2).map(|block| values[block * n + i]).collect::<Option<Vec<f64>>>();
    let points: Vec<Vec<f64>> = (0..n).filter_map(point).collect();
    if points.len() < 2 {
        return Err(format!("{} complete; it takes two", ["no base point is", "one base point is"][points.len()]));
    }
    let first = points[0][0];
    if points.iter().all(|p| p[0] == first && p[1] == first) {
        return Err("it does not vary".into());
    }
    let indices = jackknife(points.len(), points.len() as f64 - 1.0, confidence, &|parts| {
        let n = parts.len() as f64;
        let mean = parts.iter().map(|&p| points[p][0] + points[p][1]).sum::<f64>() / (2.0 * n);
        let square = |v: f64| (v - mean) * (v - mean);
        let variance = parts.iter().map(|&p| square(points[p][0]) + square(points[p][1])).sum::<f64>() / (2.0 * n);
        let of = |factor: usize| {
            let sum = |term: &dyn Fn(f64, f64, f64) -> f64| {
                parts.iter().map(|&p| term(points[p][0], points[p][1], points[p][2 + factor])).sum::<f64>() / n
            };
            let first = sum(&|a, b, mixed| (b - mean) * (mixed - a));
            let total = sum(&|a, _, mixed| 0.5 * (a - mixed) * (a - mixed));
            [first / variance, (total / variance).ln()]
        };
        (0..k).flat_map(of).collect()
    });
    // A mean of squares scatters by its size: what moves nothing has none.
    let total = |log: &Index| {
        let value = log.value.exp();
        Index { value, interval: if value == 0.0 { [0.0; 2] } else { log.interval.map(f64::exp) } }
    };
    Ok(indices.chunks(2).map(|i| Shares { first: i[0], total: total(&i[1]) }).collect())
}
