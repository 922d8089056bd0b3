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

#[cfg(test)]
mod tests {
    use super::*;

    fn point(intensity: f64, collapsed: bool) -> Point {
        Point { intensity, scale: intensity, damage: Some(intensity), collapsed, id: String::new() }
    }

    /// Steps of 0.1, 0.15, 0.2, … up to the collapse at 0.97, thirds until the gap is 10 %, then the widest gaps.
    #[test]
    fn hunts_then_closes_in_then_fills() {
        let way = Way::Hunt { first: 0.05, step: 0.1, growth: 0.05, most: 5.0, runs: 12, resolution: 0.1 };
        let mut points: Vec<Point> = Vec::new();
        let mut asked = Vec::new();
        while let [next] = way.next(&points)[..] {
            asked.push(next);
            let place = points.partition_point(|p| p.intensity < next);
            points.insert(place, point(next, next >= 0.97));
        }
        assert_eq!(asked.len(), 12);
        let third = 0.85 + 0.2 / 3.0;
        let closed = third + (1.05 - third) / 3.0;
        let expected = [0.05, 0.15, 0.3, 0.5, 0.75, 1.05, 0.85, third, closed, 0.625, 0.4, 0.225];
        for (asked, expected) in asked.iter().zip(expected) {
            assert!((asked - expected).abs() < 1e-12, "{asked} {expected}");
        }
        let collapse = points.iter().position(|p| p.collapsed).unwrap_or(0);
        assert!(points[collapse].intensity / points[collapse - 1].intensity < 1.1);
    }

    #[test]
    fn without_collapse_it_goes_to_the_end_and_fills() {
        let way = Way::Hunt { first: 0.5, step: 1.0, growth: 0.0, most: 2.0, runs: 6, resolution: 0.1 };
        let mut points: Vec<Point> = Vec::new();
        while let [next] = way.next(&points)[..] {
            let place = points.partition_point(|p| p.intensity < next);
            points.insert(place, point(next, false));
        }
        let intensities: Vec<f64> = points.iter().map(|p| p.intensity).collect();
        assert_eq!(intensities, [0.5, 1.0, 1.25, 1.5, 1.75, 2.0]);
    }
}
