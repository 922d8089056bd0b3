//! Lognormal fragility fitted by maximum likelihood, with confidence from the profile of the likelihood.
//!
//! - Capacities of records, those that did not reach the limit included: K. A. Porter, R. Kennedy, R. Bachman,
//!   Earthquake Spectra 23 (2007) 471; equation (F2) of [`super::likelihood`].
//! - Fixed stripes, binomial: J. W. Baker, Earthquake Spectra 31 (2015) 579.
//! - Intervals are where twice the likelihood's fall from its maximum stays below c: 3.84 for 95 %, the quantile of χ²;
//!   where n capacities were found, n ln(1 + t²/(n − 1)) with Student's t, which is exact for the median of capacities
//!   that were all found. Where a motion has several curves, or one curve counts at several intensities, n is the number of motions, and the fall is larger by
//!   what the variance is larger for it ([`Likelihood::clustered`]).

use std::f64::consts::PI;

use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::statistics::student;

use super::likelihood::{Evidence, Likelihood, Place, phi};

/// A fitted fragility.
#[derive(Debug, Clone)]
pub struct Fragility {
    /// θ, the intensity at which half of the records reach the limit.
    pub median: f64,
    /// β, standard deviation of the logarithm of capacities.
    pub dispersion: f64,
    /// Interval of the median; 0 or infinite where it has no end.
    pub median_interval: [f64; 2],
    /// Interval of the dispersion; likewise.
    pub dispersion_interval: [f64; 2],
    likelihood: Likelihood,
    place: Place,
    largest: f64,
    fall: f64,
    /// Cluster of each entry of the evidence, and how many there are; none where all are independent.
    clusters: Option<(Vec<usize>, usize)>,
}

/// Directions in which the end of the plausible region is looked for.
const DIRECTIONS: usize = 96;
/// How far from the best value an interval is looked for: that many of the first steps, doubled each.
const DOUBLINGS: usize = 30;

/// Fits (F1) to independent records; `confidence` is that of the intervals, between 0 and 1.
///
/// # Errors
/// Why the evidence determines no lognormal.
pub fn fit(evidence: &[Evidence], confidence: f64) -> Result<Fragility, &'static str> {
    fit_clusters(evidence, &(0..evidence.len()).collect::<Vec<_>>(), confidence)
}

/// The same of records of which some belong together: `of` names the cluster of each, such as its motion.
///
/// # Errors
/// As [`fit`].
pub fn fit_clusters(evidence: &[Evidence], of: &[usize], confidence: f64) -> Result<Fragility, &'static str> {
    if evidence.len() < 2 {
        return Err("fewer than two records or stripes");
    }
    let reached = |e: &Evidence| !matches!(e, Evidence::Above(_) | Evidence::Stripe { reached: 0, .. });
    if !evidence.iter().any(reached) {
        return Err("no record reaches the limit");
    }
    let at_once = |e: &Evidence| match e {
        Evidence::Below(_) => true,
        Evidence::Stripe { reached, of, .. } => reached == of,
        _ => false,
    };
    if evidence.iter().all(at_once) {
        return Err("every record reaches the limit at its lowest intensity");
    }
    if !overlap(evidence) {
        return Err(
            "what reaches the limit and what does not do not overlap: the dispersion is not determined, and intensities between would tell it",
        );
    }
    let likelihood = Likelihood::new(evidence);
    let place = likelihood.largest()?;
    let mut names = of.to_vec();
    names.sort_unstable();
    names.dedup();
    let known = |name: &usize| names.binary_search(name).unwrap_or(0);
    let clusters = (names.len() < evidence.len()).then(|| (of.iter().map(known).collect(), names.len()));
    // Clusters that tell of a capacity; where none does, as of stripes, all.
    let located = |e: &Evidence| matches!(e, Evidence::At(_) | Evidence::Within(_));
    let mut telling: Vec<usize> = evidence.iter().zip(of).filter(|(e, _)| located(e)).map(|(_, of)| *of).collect();
    telling.sort_unstable();
    telling.dedup();
    let n = if clusters.is_some() && telling.is_empty() { names.len() } else { telling.len() } as f64;
    let [a, b] = place;
    let mut fit = Fragility {
        median: (likelihood.centre - a / b).exp(),
        dispersion: 1.0 / b,
        median_interval: [0.0, f64::INFINITY],
        dispersion_interval: [0.0, f64::INFINITY],
        largest: likelihood.at(place),
        fall: 0.5 * threshold(n, clusters.is_some(), confidence),
        likelihood,
        place,
        clusters,
    };
    fit.median_interval = fit.interval_of_median();
    fit.dispersion_interval = fit.interval_of_dispersion();
    Ok(fit)
}

/// Whether a limit is not reached at some intensity at or above one at which it is: otherwise every dispersion down to 0 is more likely than the one above it.
fn overlap(evidence: &[Evidence]) -> bool {
    let (mut stands, mut reached) = (0.0f64, f64::INFINITY);
    for e in evidence {
        let [not, at] = match *e {
            Evidence::At(y) => [y, y],
            Evidence::Within(ends) => ends,
            Evidence::Above(y) => [y, f64::INFINITY],
            Evidence::Below(y) => [0.0, y],
            Evidence::Stripe { intensity, reached, of } => {
                [if reached < of { intensity } else { 0.0 }, if reached > 0 { intensity } else { f64::INFINITY }]
            }
        };
        (stands, reached) = (stands.max(not), reached.min(at));
    }
    let exact = evidence.iter().any(|e| matches!(e, Evidence::At(_) | Evidence::Stripe { .. }));
    stands > reached || exact && stands == reached
}

/// How far twice the likelihood falls: of `n` capacities or clusters. What is known of no capacity falls as that of many, one alone as that of two.
fn threshold(n: f64, clustered: bool, confidence: f64) -> f64 {
    if n < 1.0 || n < 2.0 && clustered {
        let chi = ChiSquared::new(1.0).map_or(f64::NAN, |d| d.inverse_cdf(confidence));
        return if clustered { f64::INFINITY } else { chi };
    }
    let n = n.max(2.0);
    let t = student(n - 1.0, confidence);
    n * (t * t / (n - 1.0)).ln_1p()
}

impl Fragility {
    /// P(limit reached) at an intensity above 0.
    pub fn probability(&self, intensity: f64) -> f64 {
        phi((intensity / self.median).ln() / self.dispersion)
    }

    /// Confidence interval of [`Fragility::probability`].
    pub fn band(&self, intensity: f64) -> [f64; 2] {
        let x = intensity.ln() - self.likelihood.centre;
        let [a, b] = self.place;
        let z = a + b * x;
        // a + b x = z fixed: a line with direction (−x, 1).
        let profile = |z: f64| self.likelihood.on_line([z - b * x, b], [-x, 1.0]);
        let fall = self.fall([1.0, x]);
        let ends = [-1.0, 1.0].map(|sign| self.end(z, 0.1 * sign, fall, &profile));
        [ends[0].map_or(0.0, phi), ends[1].map_or(1.0, phi)]
    }

    fn interval_of_median(&self) -> [f64; 2] {
        let [a, b] = self.place;
        let x = -a / b;
        let profile = |x: f64| self.likelihood.on_line([-b * x, b], [-x, 1.0]);
        let fall = self.fall([-1.0 / b, a / (b * b)]);
        let ends = [-1.0, 1.0].map(|sign| self.end(x, 0.1 * sign * self.dispersion, fall, &profile));
        let of = |x: Option<f64>, none: f64| x.map_or(none, |x| (x + self.likelihood.centre).exp());
        [of(ends[0], 0.0), of(ends[1], f64::INFINITY)]
    }

    fn interval_of_dispersion(&self) -> [f64; 2] {
        let [a, b] = self.place;
        let profile = |s: f64| {
            let other = (-s).exp();
            // Along a alone; the start keeps the median.
            self.likelihood.on_line([a / b * other, other], [1.0, 0.0])
        };
        let fall = self.fall([0.0, 1.0 / b]);
        let ends = [-1.0, 1.0].map(|sign| self.end(-b.ln(), 0.1 * sign, fall, &profile));
        [ends[0].map_or(0.0, f64::exp), ends[1].map_or(f64::INFINITY, f64::exp)]
    }

    /// Medians and dispersions around the region that the confidence allows, for the interval of whatever follows from both; none where it has no end.
    pub fn plausible(&self) -> Option<Vec<[f64; 2]>> {
        let ends = [self.median_interval, self.dispersion_interval];
        if ends.iter().any(|[low, high]| !(*low > 0.0 && high.is_finite())) {
            return None;
        }
        let [a, b] = self.place;
        // Of the two the wider, where runs share their motions.
        let fall = self.fall([-1.0 / b, a / (b * b)]).max(self.fall([0.0, 1.0 / b]));
        let direction = |k: usize| {
            let turn = 2.0 * PI * k as f64 / DIRECTIONS as f64;
            // Of the median, in dispersions, and of ln β.
            [turn.cos(), turn.sin()]
        };
        let at = |[m, s]: [f64; 2], way: f64| {
            let other = b * (-s * way).exp();
            [-(-a / b + m * way / b) * other, other]
        };
        let one = |k: usize| {
            let direction = direction(k);
            let end = self.end(0.0, 0.1, fall, &|way| self.likelihood.at(at(direction, way)))?;
            let [a, b] = at(direction, end);
            Some([(self.likelihood.centre - a / b).exp(), 1.0 / b])
        };
        (0..DIRECTIONS).map(one).collect()
    }

    /// How far the profile of a quantity with these derivatives by a and b may fall.
    fn fall(&self, by: [f64; 2]) -> f64 {
        match &self.clusters {
            Some((of, clusters)) if *clusters > 1 => {
                self.fall * self.likelihood.clustered(self.place, by, of, *clusters)
            }
            _ => self.fall,
        }
    }

    /// Where the profile has fallen by that much; none when it does not within reach.
    fn end(&self, best: f64, first: f64, fall: f64, profile: &dyn Fn(f64) -> f64) -> Option<f64> {
        if fall.is_infinite() {
            return None;
        }
        let inside = |v: f64| profile(v) >= self.largest - fall;
        let (mut step, mut low) = (first, best);
        let mut high = None;
        for _ in 0..DOUBLINGS {
            if inside(best + step) {
                (low, step) = (best + step, 2.0 * step);
            } else {
                high = Some(best + step);
                break;
            }
        }
        let mut high = high?;
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if inside(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(0.5 * (low + high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With all capacities found the likelihood's maximum has a closed form, and the interval of the median is Student's.
    #[test]
    fn capacities_that_were_all_found() -> Result<(), &'static str> {
        let y = [0.21f64, 0.35, 0.4, 0.28, 0.55, 0.31, 0.62, 0.24];
        let evidence: Vec<Evidence> = y.iter().map(|y| Evidence::At(*y)).collect();
        let found = fit(&evidence, 0.95)?;
        let n = y.len() as f64;
        let mean = y.iter().map(|y| y.ln()).sum::<f64>() / n;
        let squares = y.iter().map(|y| (y.ln() - mean).powi(2)).sum::<f64>();
        assert!((found.median / mean.exp() - 1.0).abs() < 1e-9);
        assert!((found.dispersion / (squares / n).sqrt() - 1.0).abs() < 1e-9);
        // t(0.975, 7) = 2.364624.
        let half = 2.364_624 * (squares / (n - 1.0) / n).sqrt();
        for (k, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let exact = (mean + sign * half).exp();
            assert!((found.median_interval[k] / exact - 1.0).abs() < 1e-5, "{} {exact}", found.median_interval[k]);
        }
        // At the median the band is the image of the median's interval to first order, and holds one half.
        let [low, high] = found.band(found.median);
        assert!(low < 0.5 && high > 0.5 && (found.probability(found.median) - 0.5).abs() < 1e-12);
        Ok(())
    }

    #[test]
    fn evidence_that_determines_nothing() {
        let at = |y: f64| Evidence::At(y);
        assert!(fit(&[at(0.3)], 0.95).is_err());
        assert!(fit(&[at(0.3), at(0.3), at(0.3)], 0.95).is_err());
        let stripe = |intensity, reached| Evidence::Stripe { intensity, reached, of: 10 };
        assert!(fit(&[stripe(0.1, 0), stripe(0.2, 0), stripe(0.4, 10)], 0.95).is_err());
        assert!(fit(&[stripe(0.1, 5), stripe(0.2, 3), stripe(0.4, 1)], 0.95).is_err());
        assert!(fit(&[Evidence::Above(0.5), Evidence::Above(0.7)], 0.95).is_err());
        assert!(fit(&[stripe(0.1, 1), stripe(0.2, 4), stripe(0.4, 9)], 0.95).is_ok());
    }
}
