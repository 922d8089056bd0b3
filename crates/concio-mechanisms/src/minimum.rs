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
    // The lowest so far: an end of the interval, or of where the function is defined, may be lower than all that lies inside.
    let mut found = (at(best), lowest);
    let mut tell = |x: f64| {
        let value = value(x);
        if value < found.1 {
            found = (x, value);
        }
        (value, found.0)
    };
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = (at(best.saturating_sub(1)), at((best + 1).min(tried)));
    let mut points = [high - golden * (high - low), low + golden * (high - low)];
    let mut values = points.map(|x| tell(x).0);
    let mut lowest_at = at(best);
    for _ in 0..80 {
        // Where both points are undefined, the lowest so far tells on which side it is not.
        let down = values[0] < values[1] || (values[0] == values[1] && lowest_at < 0.5 * (low + high));
        let value;
        if down {
            high = points[1];
            points = [high - golden * (high - low), points[0]];
            (value, lowest_at) = tell(points[0]);
            values = [value, values[0]];
        } else {
            low = points[0];
            points = [points[1], low + golden * (high - low)];
            (value, lowest_at) = tell(points[1]);
            values = [values[1], value];
        }
    }
    found.0
}
