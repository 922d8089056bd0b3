//! Fewer points that look the same as all.

/// Of a curve over a rising abscissa: of every one of `columns` columns the lowest and the highest point, and the last
/// point. Points that are not finite are left out.
pub fn columns(x: &[f64], y: &[f64], columns: usize) -> Vec<(f64, f64)> {
    let points = finite(x, y);
    if points.len() <= 2 * columns {
        return points;
    }
    let mut kept = Vec::with_capacity(2 * columns + 2);
    for column in 0..columns {
        let part = &points[column * points.len() / columns..(column + 1) * points.len() / columns];
        let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let (Some(low), Some(high)) = (part.iter().min_by(by_value), part.iter().max_by(by_value)) else { continue };
        kept.extend(if low.0 <= high.0 { [*low, *high] } else { [*high, *low] });
    }
    kept.extend(points.last());
    kept
}

/// Of a curve in the plane: points from which no other is farther than `near` times the extent of the curve in either
/// direction (Ramer, Douglas and Peucker, in the norm of the larger component), and the extremes of both coordinates.
pub fn path(x: &[f64], y: &[f64], near: f64) -> Vec<(f64, f64)> {
    let points = finite(x, y);
    if points.len() < 3 {
        return points;
    }
    let extent = |get: fn(&(f64, f64)) -> f64| {
        let [low, high] =
            points.iter().map(get).fold([f64::INFINITY, f64::NEG_INFINITY], |e, v| [e[0].min(v), e[1].max(v)]);
        if high > low { high - low } else { 1.0 }
    };
    let scale = [1.0 / extent(|p| p.0), 1.0 / extent(|p| p.1)];
    let mut keep = vec![false; points.len()];
    let mut ends = vec![0, points.len() - 1];
    let by = |get: fn(&(f64, f64)) -> f64| {
        let order = |&a: &usize, &b: &usize| get(&points[a]).total_cmp(&get(&points[b]));
        [(0..points.len()).min_by(order), (0..points.len()).max_by(order)]
    };
    ends.extend(by(|p| p.0).into_iter().chain(by(|p| p.1)).flatten());
    ends.sort_unstable();
    ends.dedup();
    ends.iter().for_each(|&k| keep[k] = true);
    let mut open: Vec<[usize; 2]> = ends.windows(2).map(|w| [w[0], w[1]]).collect();
    while let Some([from, to]) = open.pop() {
        let far = (from + 1..to).map(|k| (distance(&points, [from, k, to], scale), k));
        let Some((distance, k)) = far.max_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        if distance > near {
            keep[k] = true;
            open.extend([[from, k], [k, to]]);
        }
    }
    points.into_iter().zip(keep).filter_map(|(p, kept)| kept.then_some(p)).collect()
}

/// From point `k` to the straight line between `from` and `to`, both coordinates scaled.
fn distance(points: &[(f64, f64)], [from, k, to]: [usize; 3], scale: [f64; 2]) -> f64 {
    let at = |i: usize| [points[i].0 * scale[0], points[i].1 * scale[1]];
    let (a, p, b) = (at(from), at(k), at(to));
    let (d, e) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length = d[0] * d[0] + d[1] * d[1];
    let along = if length > 0.0 { ((d[0] * e[0] + d[1] * e[1]) / length).clamp(0.0, 1.0) } else { 0.0 };
    (e[0] - along * d[0]).abs().max((e[1] - along * d[1]).abs())
}

fn finite(x: &[f64], y: &[f64]) -> Vec<(f64, f64)> {
    x.iter().copied().zip(y.iter().copied()).filter(|(x, y)| x.is_finite() && y.is_finite()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_every_peak() {
        let x: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut y = vec![0.0; x.len()];
        (y[31_415], y[92_653]) = (7.0, -3.0);
        let kept = columns(&x, &y, 700);
        assert!(kept.len() <= 1401);
        assert!(kept.contains(&(31_415.0, 7.0)) && kept.contains(&(92_653.0, -3.0)));
        assert!(kept.windows(2).all(|w| w[0].0 <= w[1].0));
    }

    /// A spiral: thinned to a fraction, with its extremes, and nowhere farther from all points than it may be.
    #[test]
    fn thinned_paths_stay_where_they_were() {
        let turn = |k: i32| f64::from(k) * 1e-3;
        let x: Vec<f64> = (0..50_000).map(|k| 1e-6 * turn(k) * turn(k).cos()).collect();
        let y: Vec<f64> = (0..50_000).map(|k| 3e-3 * turn(k) * turn(k).sin()).collect();
        let kept = path(&x, &y, 1e-3);
        assert!(kept.len() < 2_000 && kept.len() > 100, "{}", kept.len());
        for values in [&x, &y] {
            let peak = values.iter().copied().fold(0.0, f64::max);
            assert!(kept.iter().any(|p| p.0 == peak || p.1 == peak));
        }
        let scale = [1.0 / (2e-6 * 50.0), 1.0 / (6e-3 * 50.0)];
        for k in (0..50_000).step_by(97) {
            let near = kept.windows(2).map(|w| distance(&[w[0], (x[k], y[k]), w[1]], [0, 1, 2], scale));
            assert!(near.fold(f64::INFINITY, f64::min) <= 1.2e-3, "point {k}");
        }
    }
}
