//! Standardised rank regression coefficients (A. Saltelli, J. Marivoet, Reliab. Engng Syst. Saf. 28 (1990) 229).
//!
//! Values and factors are replaced by their ranks (equal ones by the mean of theirs), brought to mean 0 and deviation 1, and
//! the ranks of the measure are fitted to those of the factors by least squares:
//!
//! (R1)  y = Σ b_i x_i + e,   R² = 1 − Σ e²/Σ y²
//!
//! b_i lies between −1 and 1 where factors vary independently; R² near 1 says that the measure rises or falls with the
//! factors throughout, and that the b_i tell all.

use std::collections::BTreeMap;

use super::{Index, jackknife};
use crate::design::FREEDOM;
use crate::statistics::ranks;

/// Coefficients of the factors that are `ordered`, none for the others, and R². Rows without value are left out. `motions` are those of the rows: where some
/// share theirs, what is independent are the motions.
///
/// # Errors
/// Too few runs, nothing to regress on, factors that move together.
pub fn coefficients(
    shares: &[Vec<f64>],
    values: &[Option<f64>],
    ordered: &[bool],
    (motions, confidence): (&[usize], f64),
) -> Result<(Vec<Option<Index>>, f64), String> {
    let used: Vec<usize> = (0..values.len()).filter(|&i| values[i].is_some()).collect();
    let y: Vec<f64> = used.iter().filter_map(|&i| values[i]).collect();
    let varies = |f: usize| used.iter().any(|&i| shares[i][f] != shares[used[0]][f]);
    if y.len() < 2 {
        return Err("fewer than two runs have a value".into());
    }
    let factors: Vec<usize> = (0..ordered.len()).filter(|&f| ordered[f] && !used.is_empty() && varies(f)).collect();
    if factors.is_empty() {
        return Err("no factor has values with an order".into());
    }
    let least = factors.len() + FREEDOM;
    if y.len() < least {
        return Err(format!("{} runs are too few for {} factors: it takes {least}", y.len(), factors.len()));
    }
    if y.iter().all(|v| *v == y[0]) {
        return Err("it does not vary".into());
    }
    let columns: Vec<Vec<f64>> = factors.iter().map(|&f| used.iter().map(|&i| shares[i][f]).collect()).collect();
    let all: Vec<usize> = (0..y.len()).collect();
    if regression(&columns, &y, &all).is_none() {
        return Err("factors move together: their parts cannot be told from each other".into());
    }
    let none = || vec![f64::NAN; factors.len() + 1];
    let mut alike: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    used.iter().enumerate().for_each(|(row, &run)| alike.entry(motions[run]).or_default().push(row));
    let alike: Vec<Vec<usize>> =
        if alike.len() < 2 { all.iter().map(|&row| vec![row]).collect() } else { alike.into_values().collect() };
    let freedom = y.len() as f64 - factors.len() as f64 - 1.0;
    let of = |parts: &[usize]| {
        let rows: Vec<usize> = parts.iter().flat_map(|&part| &alike[part]).copied().collect();
        regression(&columns, &y, &rows).unwrap_or_else(none)
    };
    let found = jackknife(alike.len(), freedom, confidence, &of);
    let mut coefficients = vec![None; ordered.len()];
    for (f, index) in factors.iter().zip(&found) {
        coefficients[*f] = Some(*index);
    }
    Ok((coefficients, found[factors.len()].value))
}

/// (R1) of some rows: the coefficients, then R². None where the factors do not determine it.
fn regression(columns: &[Vec<f64>], y: &[f64], rows: &[usize]) -> Option<Vec<f64>> {
    let of = |column: &[f64]| standardised(&ranks(&rows.iter().map(|&r| column[r]).collect::<Vec<_>>()));
    let x = columns.iter().map(|c| of(c)).collect::<Option<Vec<_>>>()?;
    let y = of(y)?;
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / rows.len() as f64;
    let matrix: Vec<Vec<f64>> = x.iter().map(|a| x.iter().map(|b| dot(a, b)).collect()).collect();
    let right: Vec<f64> = x.iter().map(|a| dot(a, &y)).collect();
    let mut b = solve(matrix, right.clone())?;
    let explained = b.iter().zip(&right).map(|(b, r)| b * r).sum();
    b.push(explained);
    Some(b)
}

fn standardised(values: &[f64]) -> Option<Vec<f64>> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let deviation = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt();
    (deviation > 0.0).then(|| values.iter().map(|v| (v - mean) / deviation).collect())
}

/// Solves a symmetric positive definite system of correlations by Cholesky; none where a pivot is lost in rounding.
fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    const LEAST_PIVOT: f64 = 1e-9;
    let n = b.len();
    for j in 0..n {
        for k in 0..j {
            a[j][j] -= a[j][k] * a[j][k];
        }
        if !(a[j][j] > LEAST_PIVOT) {
            return None;
        }
        a[j][j] = a[j][j].sqrt();
        for i in j + 1..n {
            for k in 0..j {
                a[i][j] -= a[i][k] * a[j][k];
            }
            a[i][j] /= a[j][j];
        }
    }
    for i in 0..n {
        for k in 0..i {
            b[i] -= a[i][k] * b[k];
        }
        b[i] /= a[i][i];
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            b[i] -= a[k][i] * b[k];
        }
        b[i] /= a[i][i];
    }
    Some(b)
}
