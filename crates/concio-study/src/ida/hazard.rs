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
use crate::values::short;

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
    /// Interval at the confidence of the fit, with what shaking beyond the last point may add; no end above where the limit is reached at the first point already.
    pub interval: [f64; 2],
    /// The most that shaking beyond the last point of the curve may add [1/year].
    pub beyond: f64,
    /// Part of the records that reach the limit at the first point already.
    pub first: f64,
}

impl Rate {
    /// What the rate lacks, where what lies beyond the ends of the curve matters.
    pub fn doubt(&self) -> Option<String> {
        let mut told = Vec::new();
        if self.beyond > FROM_BEYOND * self.value {
            told.push(format!("shaking beyond the hazard curve may add {} a year", short(self.beyond)));
        }
        if self.first > FROM_FIRST {
            let percent = short(1e2 * self.first);
            told.push(format!(
                "{percent} % reach the limit at the first intensity of the hazard curve already: the rate is a lower bound, for what is below is left out"
            ));
        } else if self.interval[1].is_infinite() {
            told.push(
                "the limit may be reached at the first intensity of the hazard curve already: begin it lower, or run more records"
                    .into(),
            );
        }
        (!told.is_empty()).then(|| told.join("; "))
    }
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
        let [first, last] = [self.points.first(), self.points.last()].map(|point| point.copied().unwrap_or_default());
        let value = self.rate(fit.median, fit.dispersion);
        let beyond = last[1] * (1.0 - fit.probability(last[0]));
        let [mut low, mut high] = match fit.plausible() {
            Some(all) => all.into_iter().fold([value, value + beyond], |[low, high], [median, dispersion]| {
                let rate = self.rate(median, dispersion);
                let more = last[1] * phi(-(last[0] / median).ln() / dispersion);
                [low.min(rate), high.max(rate + more)]
            }),
            // Without an end the fits agree in probabilities at least.
            None => self.between(fit),
        };
        if fit.band(first[0])[1] > FROM_FIRST {
            high = f64::INFINITY;
        }
        low = low.min(value);
        Rate { value, interval: [low, high], beyond, first: fit.probability(first[0]) }
    }

    /// λ_L where the probability at each intensity is the least and the most that the confidence allows, beyond the last point too.
    fn between(&self, fit: &Fragility) -> [f64; 2] {
        let (mut sums, mut before) = ([0.0; 2], None::<[f64; 2]>);
        for pair in self.points.windows(2) {
            let [[y0, rate0], [y1, rate1]] = [pair[0], pair[1]];
            for k in 0..=PARTS {
                let part = k as f64 / PARTS as f64;
                let (y, rate) = (y0 * (y1 / y0).powf(part), rate0 * (rate1 / rate0).powf(part));
                let band = fit.band(y);
                if let Some([low, was]) = before {
                    sums = [sums[0] + low * (was - rate), sums[1] + band[1] * (was - rate)];
                }
                before = Some([band[0], rate]);
            }
        }
        let last = self.points.last().map_or(0.0, |point| point[1]);
        [sums[0] + before.map_or(0.0, |[low, _]| low) * last, sums[1] + last]
    }
}

/// Part of the rate from which what lies beyond the last point is told, and part of the records from which what lies below the first is.
const FROM_BEYOND: f64 = 0.02;
const FROM_FIRST: f64 = 0.02;
/// Parts of a piece of the curve where a rate is summed.
const PARTS: usize = 50;
