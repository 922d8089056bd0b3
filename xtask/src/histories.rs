//! Displacements of all unknowns at all samples, row by row from the first sample after t = 0, and how far apart two are.

use std::fs;
use std::path::Path;

/// What a peer wrote: 64-bit floats.
pub fn of_peer(path: &Path) -> Result<Vec<f64>, String> {
    let bytes = fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok(bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect())
}

/// What `concio export --csv` wrote of a run that keeps all blocks; it has a row for t = 0.
pub fn of_concio(path: &Path) -> Result<Vec<f64>, String> {
    let text = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut lines = text.lines();
    let is_block = |name: &str| name.trim_matches('"').starts_with("block/") && name.contains("/displacement");
    let header = lines.next().unwrap_or("").split(',');
    let columns: Vec<usize> = header.enumerate().filter(|(_, n)| is_block(n)).map(|(k, _)| k).collect();
    if columns.is_empty() {
        return Err(format!("{} has no columns of blocks", path.display()));
    }
    let mut values = Vec::new();
    for row in lines.skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        for &column in &columns {
            values.push(cells.get(column).and_then(|c| c.parse().ok()).ok_or("a cell is no number")?);
        }
    }
    Ok(values)
}

/// Largest displacement.
pub fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| f64::max(m, v.abs()))
}

/// Largest difference over the peak of the reference.
pub fn difference(found: &[f64], reference: &[f64]) -> Result<f64, String> {
    if found.len() != reference.len() || found.is_empty() {
        return Err(format!("{} values, {} of the reference", found.len(), reference.len()));
    }
    // A value that is not a number must not pass for a small difference.
    let apart = |(a, b): (&f64, &f64)| if a.is_nan() { f64::INFINITY } else { (a - b).abs() };
    Ok(found.iter().zip(reference).map(apart).fold(0.0, f64::max) / peak(reference))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_told_over_the_peak() {
        assert_eq!(difference(&[1.0, -2.0], &[1.0, -4.0]), Ok(0.5));
        assert_eq!(difference(&[f64::NAN, -4.0], &[1.0, -4.0]), Ok(f64::INFINITY));
        assert!(difference(&[1.0], &[1.0, 2.0]).is_err());
        assert_eq!(peak(&[1.0, -4.0]), 4.0);
    }
}
