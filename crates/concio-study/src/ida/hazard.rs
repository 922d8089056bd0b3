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

/// How often a year a limit is reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rate {
    /// λ_L [1/year].
    pub value: f64,
    /// Interval at the confidence of the fit; none where it has no end.
    pub interval: Option<[f64; 2]>,
    /// The most that shaking beyond the last point of the curve may add [1/year].
    pub beyond: f64,
}

impl Hazard {
    /// λ_L a year of a limit with this median and dispersion.
    pub fn rate(&self, median: f64, dispersion: f64) -> f64 {
        let z = |y: f64| (y / median).ln() / dispersion;
        let part = |pair: &[[f64; 2]]| {
            let [[y0, rate0], [y1, rate1]] = [pair[0], pair[1]];
            let k = (rate0 / rate1).ln() / (y1 / y0).ln();
            let [z0, z1] = [z(y0), z(y1)];
            let [far, near] = [z0, z1].map(|z| z + k * dispersion);
            // Of the tail that is the smaller one: the difference of two numbers next to 1 has no digits.
            let shifted = if far > 0.0 { phi(-far) - phi(-near) } else { phi(near) - phi(far) };
            let moved = rate0 * (k * (y0 / median).ln() + 0.5 * (k * dispersion).powi(2)).exp() * shifted;
            let rises = phi(z1) - phi(z0);
            // λ lies between its ends where Φ rises; a product of nothing and what is beyond all numbers has no digits.
            let within = if moved.is_finite() { moved.clamp(rate1 * rises, rate0 * rises) } else { rate1 * rises };
            phi(z0) * rate0 - phi(z1) * rate1 + within
        };
        let [last, rate] = self.points.last().copied().unwrap_or_default();
        self.points.windows(2).map(part).sum::<f64>() + phi(z(last)) * rate
    }

    /// The same of a fit.
    pub fn of(&self, fit: &Fragility) -> Rate {
        let value = self.rate(fit.median, fit.dispersion);
        let widened = |[low, high]: [f64; 2], [median, dispersion]: [f64; 2]| {
            let rate = self.rate(median, dispersion);
            [low.min(rate), high.max(rate)]
        };
        let interval = fit.plausible().map(|all| all.into_iter().fold([value; 2], widened));
        let [last, exceeded] = self.points.last().copied().unwrap_or_default();
        Rate { value, interval, beyond: exceeded * (1.0 - fit.probability(last)) }
    }
}
