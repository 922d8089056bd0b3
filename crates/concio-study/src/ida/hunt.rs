//! At which intensities a motion is run.

use super::Way;
use super::curve::Point;

impl Way {
    /// The intensities to run next, given those that were run, rising. Empty when the curve is done.
    ///
    /// The hunt is an order of questions that the answers decide: all are asked anew from the points known, so that an
    /// analysis that is taken up again asks the same.
    ///
    /// Gaps that hold one of `limits` are closed before others are filled, and before the hunt goes on where the runs that are left would not do for both.
    pub fn next(&self, points: &[Point], limits: &[f64]) -> Vec<f64> {
        match self {
            Way::List(list) if points.is_empty() => list.clone(),
            Way::List(_) => Vec::new(),
            Way::Hunt { first, step, growth, most, runs, resolution } => {
                if points.len() >= *runs {
                    return Vec::new();
                }
                let Some(last) = points.last() else { return vec![*first] };
                let collapse = points.iter().position(|p| p.collapsed);
                let open = open(points, limits, [*resolution, 0.1 * first]);
                let widest = open.iter().reduce(|a, b| if b.width > a.width * (1.0 + 1e-12) { b } else { a });
                let close = || widest.map(|gap| vec![gap.middle]);
                // What is left is just enough for them.
                if runs - points.len() <= open.iter().map(|gap| gap.runs).sum()
                    && let Some(next) = close()
                {
                    return next;
                }
                let Some(collapse) = collapse else {
                    if last.intensity >= most * (1.0 - 1e-12) {
                        return close().unwrap_or_else(|| fill(points));
                    }
                    let (mut next, mut length) = (*first, *step);
                    while next <= last.intensity * (1.0 + 1e-12) {
                        (next, length) = (next + length, length + growth);
                    }
                    return vec![next.min(*most)];
                };
                let high = points[collapse].intensity;
                let low = collapse.checked_sub(1).map_or(0.0, |i| points[i].intensity);
                if high - low > resolution * low.max(0.1 * first) {
                    // A third: runs that collapse cost the most and say the least.
                    return vec![low + (high - low) / 3.0];
                }
                close().unwrap_or_else(|| fill(&points[..collapse]))
            }
        }
    }
}

/// A gap that holds a limit and is wider than it may be.
struct Gap {
    /// Over the intensity below it.
    width: f64,
    middle: f64,
    /// How many runs close it.
    runs: usize,
}

/// Those of the limits that are reached, for each gap one; intensities below `least` count as that.
fn open(points: &[Point], limits: &[f64], [resolution, least]: [f64; 2]) -> Vec<Gap> {
    let mut uppers: Vec<usize> = limits.iter().filter_map(|l| points.iter().position(|p| p.reaches(*l))).collect();
    uppers.sort_unstable();
    uppers.dedup();
    let gap = |upper: usize| {
        let low = upper.checked_sub(1).map_or(0.0, |i| points[i].intensity);
        let gap = points[upper].intensity - low;
        let width = gap / low.max(least);
        Gap { width, middle: low + 0.5 * gap, runs: (width / resolution).log2().ceil().max(1.0) as usize }
    };
    uppers.into_iter().map(gap).filter(|gap| gap.width > resolution).collect()
}

/// The middle of the widest gap, the lowest of several, that below the first intensity included.
fn fill(points: &[Point]) -> Vec<f64> {
    let below = std::iter::once(0.0).chain(points.iter().map(|p| p.intensity));
    let gaps = below.zip(points).map(|(low, p)| (p.intensity - low, low));
    let widest = gaps.reduce(|a, b| if b.0 > a.0 * (1.0 + 1e-12) { b } else { a });
    widest.map_or_else(Vec::new, |(gap, low)| vec![low + 0.5 * gap])
}
