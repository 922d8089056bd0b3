//! How often a year a limit is reached: a fragility over a hazard curve (C. A. Cornell, Bull. Seism. Soc. Am. 58 (1968) 1583).
//!
//! (F3)  λ_L = ∫ P(y) |dλ(y)|
//!
//! λ(y) is the annual rate at which an intensity y is exceeded, straight between its points in logarithms: λ_i (y/y_i)^(−k). There the integral has a closed form, with
//! x = ln y and z of (F1):
//!
//! (F4)  [−Φ(z) λ + λ_i e^(k (x_i − ln θ) + k² β²/2) Φ(z + k β)] from x_i to x_(i+1)
//!
//! Nothing is known beyond the ends. Above the last point shaking counts as if it were that of the last, which is the least that it does; below the first it counts for nothing.

use super::fragility::Fragility;
use super::likelihood::phi;

/// A hazard curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Hazard {
    /// Intensity in SI, rising, and the rate at which it is exceeded a year, falling; two points at least.
    pub points: Vec<[f64; 2]>,
}

impl Hazard {
    /// λ_L a year of a limit with this median and dispersion.
    pub fn rate(&self, median: f64, dispersion: f64) -> f64 {
        let z = |y: f64| (y / median).ln() / dispersion;
        let part = |pair: &[[f64; 2]]| {
            let [[y0, rate0], [y1, rate1]] = [pair[0], pair[1]];
            let k = (rate0 / rate1).ln() / (y1 / y0).ln();
            let shifted = phi(z(y1) + k * dispersion) - phi(z(y0) + k * dispersion);
            let moved = rate0 * (k * (y0 / median).ln() + 0.5 * (k * dispersion).powi(2)).exp();
            // Far out a product of nothing and what is beyond all numbers.
            let moved = if shifted > 0.0 { moved * shifted } else { 0.0 };
            phi(z(y0)) * rate0 - phi(z(y1)) * rate1 + moved
        };
        let [last, rate] = self.points.last().copied().unwrap_or_default();
        self.points.windows(2).map(part).sum::<f64>() + phi(z(last)) * rate
    }

    /// The same of a fit, with the interval of its confidence, and the most that shaking beyond the last point may add.
    pub fn of(&self, fit: &Fragility) -> ([f64; 3], f64) {
        let rate = self.rate(fit.median, fit.dispersion);
        let all = fit.plausible().into_iter().map(|[median, dispersion]| self.rate(median, dispersion));
        let [low, high] = all.fold([rate, rate], |[low, high], rate| [low.min(rate), high.max(rate)]);
        let [last, exceeded] = self.points.last().copied().unwrap_or_default();
        ([rate, low, high], exceeded * (1.0 - fit.probability(last)))
    }
}
