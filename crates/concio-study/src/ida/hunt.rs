//! At which intensities a motion is run.

use super::curve::Point;

/// How intensities are chosen.
#[derive(Debug, Clone, PartialEq)]
pub enum Way {
    /// These, for every motion.
    List(Vec<f64>),
    /// Hunt and fill.
    Hunt {
        /// First intensity.
        first: f64,
        /// First step.
        step: f64,
        /// What each step is longer than the one before.
        growth: f64,
        /// Intensity that is not exceeded.
        most: f64,
        /// Runs per motion.
        runs: usize,
        /// Gap below the collapse over the intensity below it that is small enough.
        resolution: f64,
    },
}

impl Way {
    /// The intensities to run next, given those that were run, rising. Empty when the curve is done.
    ///
    /// The hunt is an order of questions that the answers decide: all are asked anew from the points known, so that an
    /// analysis that is taken up again asks the same.
    pub fn next(&self, points: &[Point]) -> Vec<f64> {
        match self {
            Way::List(list) if points.is_empty() => list.clone(),
            Way::List(_) => Vec::new(),
            Way::Hunt { first, step, growth, most, runs, resolution } => {
                if points.len() >= *runs {
                    return Vec::new();
                }
                let Some(last) = points.last() else { return vec![*first] };
                let collapse = points.iter().position(|p| p.collapsed);
                let Some(collapse) = collapse else {
                    if last.intensity >= most * (1.0 - 1e-12) {
                        return fill(points);
                    }
                    let taken = points.len() - 1;
                    return vec![(last.intensity + step + taken as f64 * growth).min(*most)];
                };
                let high = points[collapse].intensity;
                let low = collapse.checked_sub(1).map_or(0.0, |i| points[i].intensity);
                if high - low > resolution * low.max(0.1 * first) {
                    // A third: runs that collapse cost the most and say the least.
                    return vec![low + (high - low) / 3.0];
                }
                fill(&points[..collapse])
            }
        }
    }
}

/// The middle of the widest gap, the lowest of several, that below the first intensity included.
fn fill(points: &[Point]) -> Vec<f64> {
    let below = std::iter::once(0.0).chain(points.iter().map(|p| p.intensity));
    let gaps = below.zip(points).map(|(low, p)| (p.intensity - low, low));
    let widest = gaps.reduce(|a, b| if b.0 > a.0 * (1.0 + 1e-12) { b } else { a });
    widest.map_or_else(Vec::new, |(gap, low)| vec![low + 0.5 * gap])
}
