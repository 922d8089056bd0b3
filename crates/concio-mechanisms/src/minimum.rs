//! The least of a function of one number.

/// Where a function is least between two ends: the best of so many points, then golden sections beside it. Where values are infinite the
/// function is not defined.
pub(crate) fn least(tried: usize, from: f64, to: f64, value: impl Fn(f64) -> f64) -> f64 {
    let at = |i: usize| from + (to - from) * i as f64 / tried as f64;
    let (mut best, mut lowest) = (0, f64::INFINITY);
    for i in 0..=tried {
        let found = value(at(i));
        if found < lowest {
            (best, lowest) = (i, found);
        }
    }
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = (at(best.saturating_sub(1)), at((best + 1).min(tried)));
    let mut points = [high - golden * (high - low), low + golden * (high - low)];
    let mut values = points.map(&value);
    for _ in 0..80 {
        if values[0] < values[1] {
            high = points[1];
            points = [high - golden * (high - low), points[0]];
            values = [value(points[0]), values[0]];
        } else {
            low = points[0];
            points = [points[1], low + golden * (high - low)];
            values = [values[1], value(points[1])];
        }
    }
    // An end of the interval may be lower than all that lies inside.
    let inside = 0.5 * (low + high);
    if value(inside) <= lowest { inside } else { at(best) }
}
