//! Lognormal fragility fitted by maximum likelihood, with confidence from the profile of the likelihood.
//!
//! - Capacities of records, those that did not reach the limit included: K. A. Porter, R. Kennedy, R. Bachman,
//!   Earthquake Spectra 23 (2007) 471; equation (F2) of [`super::likelihood`].
//! - Fixed stripes, binomial: J. W. Baker, Earthquake Spectra 31 (2015) 579.
//! - Intervals are where twice the likelihood's fall from its maximum stays below c: 3.84 for 95 %, the quantile of χ²;
//!   where n capacities were found, n ln(1 + t²/(n − 1)) with Student's t, which is exact for the median of capacities
//!   that were all found.
//! - Where a motion has several curves, what is independent are the motions, by one-way random effects on the expected ln y
//!   of the curves (`Falls::of_motions`):
//!
//! (F5)  β² ~ A + B,   A = MSB/m,   B = (1 − 1/m) MSW
//!
//!   with the mean squares MSB between J motions of m curves each and MSW within. The median has MSB and J − 1 degrees of freedom; the ends of β are
//!   those of F. A. Graybill, C.-M. Wang (J. Am. Stat. Assoc. 75 (1980) 869), A + B ± √(h_A² A² + h_B² B²), where A alone and B alone have the ends (1 ± h) of as many
//!   independent capacities as they have degrees of freedom, and one more. Curves of a motion that are all the same are as one.
//! - Where one curve counts at several intensities, the fall is larger by what the variance of the curves' scores is larger ([`Likelihood::clustered`]), and where a motion has several
//!   curves, by as much more as with one z of each curve, the sum of its own.

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
    falls: Falls,
    one_motion: bool,
}

/// How far the likelihood may fall from its maximum.
#[derive(Debug, Clone, Copy)]
struct Falls {
    median: f64,
    /// Towards smaller dispersions and towards larger ones.
    dispersion: [f64; 2],
}

/// Directions in which the end of the plausible region is looked for.
const DIRECTIONS: usize = 96;
/// How far from the best value an interval is looked for: that many of the first steps, doubled each.
const DOUBLINGS: usize = 30;
/// How far an end of a median may lie off it, as a factor, and how large a dispersion may be: what lies beyond is no end.
const FARTHEST: f64 = 1e6;
const WIDEST: f64 = 100.0;

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
    fit_curves(evidence, [of, of], confidence)
}

/// The same of curves that count at several intensities: the curve of each entry, and its motion.
///
/// # Errors
/// As [`fit`].
pub fn fit_curves(
    evidence: &[Evidence],
    [curves, of]: [&[usize]; 2],
    confidence: f64,
) -> Result<Fragility, &'static str> {
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
    let located = |e: &Evidence| matches!(e, Evidence::At(_) | Evidence::Within(_));
    if !overlap(evidence) {
        return Err(if evidence.iter().any(located) {
            "one intensity may be the capacity of all records, as far as their runs tell: the dispersion is not determined, and runs between would tell it"
        } else {
            "what reaches the limit and what does not do not overlap: the dispersion is not determined, and intensities between would tell it"
        });
    }
    let likelihood = Likelihood::new(evidence);
    let place = likelihood.largest()?;
    let (clusters, names) = numbered(of);
    let found = evidence.iter().filter(|e| located(e)).count() as f64;
    // Clusters that tell of a capacity.
    let mut telling: Vec<usize> = evidence.iter().zip(of).filter(|(e, _)| located(e)).map(|(_, of)| *of).collect();
    telling.sort_unstable();
    telling.dedup();
    let telling = telling.len() as f64;
    let [a, b] = place;
    let z = || likelihood.scores(place).into_iter().map(|score| -score[0]);
    let one_motion = names < 2;
    // Under one motion its curves are independent, each of which counts once at several intensities.
    let (clusters, names) = if one_motion && found == 0.0 { numbered(curves) } else { (clusters, names) };
    let falls = if names == evidence.len() || one_motion && found > 0.0 {
        Falls::alike(0.5 * threshold(found, confidence))
    } else if names < 2 || found > 0.0 && telling < 2.0 {
        Falls::alike(f64::INFINITY)
    } else if found > 0.0 {
        Falls::of_motions(&z().collect::<Vec<_>>(), (&clusters, names), [found, telling], confidence)
    } else {
        let (curves, count) = numbered(curves);
        let (mut sums, mut motions) = (vec![0.0; count], vec![0; count]);
        for ((z, curve), motion) in z().zip(&curves).zip(&clusters) {
            (sums[*curve], motions[*curve]) = (sums[*curve] + z, *motion);
        }
        let falls = Falls::of_motions(&sums, (&motions, names), [count, names].map(|n| n as f64), confidence);
        let wider = |by| likelihood.clustered(place, by, &curves, [count, names]);
        let [of_median, of_dispersion] = [wider([-1.0 / b, a / (b * b)]), wider([0.0, 1.0 / b])];
        Falls { median: of_median * falls.median, dispersion: falls.dispersion.map(|fall| of_dispersion * fall) }
    };
    let mut fit = Fragility {
        median: (likelihood.centre - a / b).exp(),
        dispersion: 1.0 / b,
        median_interval: [0.0, f64::INFINITY],
        dispersion_interval: [0.0, f64::INFINITY],
        largest: likelihood.at(place),
        falls,
        likelihood,
        place,
        one_motion,
    };
    fit.median_interval = fit.interval_of_median();
    fit.dispersion_interval = fit.interval_of_dispersion();
    Ok(fit)
}

/// Names as numbers from 0, and how many there are.
fn numbered(names: &[usize]) -> (Vec<usize>, usize) {
    let mut known = names.to_vec();
    known.sort_unstable();
    known.dedup();
    (names.iter().map(|name| known.binary_search(name).unwrap_or(0)).collect(), known.len())
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
fn threshold(n: f64, confidence: f64) -> f64 {
    if n < 1.0 {
        return ChiSquared::new(1.0).map_or(f64::NAN, |d| d.inverse_cdf(confidence));
    }
    let n = n.max(2.0);
    n * relative(n - 1.0, confidence)
}

/// ln(1 + t²/ν): how far twice the likelihood of ν + 1 capacities falls, for each.
fn relative(freedom: f64, confidence: f64) -> f64 {
    let t = student(freedom, confidence);
    (t * t / freedom).ln_1p()
}

/// The ends of a variance over its unbiased estimate with so many degrees of freedom, as the likelihood of one capacity more has them: r − ln r = 1 + ln(1 + t²/ν) with
/// r = (s²/σ²) ν/(ν + 1).
fn ends(freedom: f64, confidence: f64) -> [f64; 2] {
    let c = 1.0 + relative(freedom, confidence);
    let root = |mut inside: f64, mut outside: f64| {
        for _ in 0..100 {
            let middle: f64 = 0.5 * (inside + outside);
            if middle.exp() - middle < c { inside = middle } else { outside = middle }
        }
        inside
    };
    let share = freedom / (freedom + 1.0);
    [share * (-root(0.0, 2.0 * c)).exp(), share * (-root(0.0, -c)).exp()]
}

impl Falls {
    fn alike(fall: f64) -> Self {
        Falls { median: fall, dispersion: [fall; 2] }
    }

    /// Of curves with the expected z, each `of` one of so many motions, two at least; as many curves are `found` as tell of a capacity, and as many motions are `telling` as have such curves.
    fn of_motions(z: &[f64], (of, motions): (&[usize], usize), [found, telling]: [f64; 2], confidence: f64) -> Self {
        let mut sums = vec![[0.0; 2]; motions];
        for (z, of) in z.iter().zip(of) {
            sums[*of] = [sums[*of][0] + z, sums[*of][1] + 1.0];
        }
        let (n, j) = (z.len() as f64, motions as f64);
        let over = |f: fn(&[f64; 2]) -> f64| sums.iter().map(f).sum::<f64>();
        let total: f64 = z.iter().map(|z| z * z).sum();
        let between = over(|[sum, count]| sum * sum / count);
        let each = (n - over(|[_, count]| count * count) / n) / (j - 1.0);
        let few = telling / (telling - 1.0);
        // A and B of (F5), over z; of motions that do not tell of a capacity there are no degrees of freedom.
        let a = few * between / (each * j);
        let b = (1.0 - 1.0 / each) * (total - between).max(0.0) / (n - j).max(1.0);
        let [of_a, of_b] = [telling - 1.0, ((n - j) * found / n).max(1.0)].map(|freedom| ends(freedom, confidence));
        let end = |k: usize, sign: f64| a + b + sign * ((of_a[k] - 1.0) * a).hypot((of_b[k] - 1.0) * b);
        // The fall of `found` capacities whose variance is total/n to one that is `end`.
        let fall = |end: f64, within: fn(f64, f64) -> f64| {
            let r = within(total / n / end, 1.0);
            0.5 * found * (r - 1.0 - r.ln())
        };
        let t = student(telling - 1.0, confidence);
        let together = few * over(|[sum, _]| sum * sum) / total;
        Falls {
            median: 0.5 * found * (t * t * together / found).ln_1p(),
            dispersion: [fall(end(0, -1.0), f64::max), fall(end(1, 1.0), f64::min)],
        }
    }

    /// Towards dispersions that are larger by a number above 0, or smaller.
    fn of_dispersion(&self, larger: f64) -> f64 {
        self.dispersion[usize::from(larger > 0.0)]
    }
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
        // Of z the median over β has the variance 1/n and β z²/(2 n); a larger z is that of a smaller β above the median, and of a larger one below.
        let fall = |sign: f64| {
            let part = 0.5 * z * z;
            (self.falls.median + part * self.falls.of_dispersion(-sign * z)) / (1.0 + part)
        };
        let end = |sign: f64| self.end(z, 0.1 * sign, fall(sign), &profile);
        let ends = [-1.0, 1.0].map(end);
        [ends[0].map_or(0.0, phi), ends[1].map_or(1.0, phi)]
    }

    fn interval_of_median(&self) -> [f64; 2] {
        let [a, b] = self.place;
        let x = -a / b;
        let profile = |x: f64| self.likelihood.on_line([-b * x, b], [-x, 1.0]);
        let end = |sign: f64| self.end(x, 0.1 * sign * self.dispersion, self.falls.median, &profile);
        let ends = [-1.0, 1.0].map(|sign| end(sign).filter(|end| (end - x).abs() < FARTHEST.ln()));
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
        let ends = [0, 1].map(|k| self.end(-b.ln(), [-0.1, 0.1][k], self.falls.dispersion[k], &profile).map(f64::exp));
        [ends[0].unwrap_or(0.0), ends[1].filter(|end| *end < WIDEST).unwrap_or(f64::INFINITY)]
    }

    /// Medians and dispersions around the region that the confidence allows, for the interval of whatever follows from both; none where it has no end, or draws
    /// under one motion say nothing of others.
    pub fn plausible(&self) -> Option<Vec<[f64; 2]>> {
        let ends = [self.median_interval, self.dispersion_interval];
        if self.one_motion || ends.iter().any(|[low, high]| !(*low > 0.0 && high.is_finite())) {
            return None;
        }
        let [a, b] = self.place;
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
            // An ellipse whose axes end where the two intervals do, in the measure of the likelihood.
            let [m, d] = [direction[0].powi(2), 2.0 * direction[1].powi(2)];
            let fall = (m + d) / (m / self.falls.median + d / self.falls.of_dispersion(direction[1]));
            let end = self.end(0.0, 0.1, fall, &|way| self.likelihood.at(at(direction, way)))?;
            let [a, b] = at(direction, end);
            Some([(self.likelihood.centre - a / b).exp(), 1.0 / b])
        };
        (0..DIRECTIONS).map(one).collect()
    }

    /// What median and dispersion do not hold.
    pub fn doubt(&self) -> Option<&'static str> {
        self.one_motion.then_some(
            "one motion: the intervals are those of the draws under it, and the scatter between records is not in them",
        )
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
