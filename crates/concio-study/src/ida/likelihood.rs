//! The likelihood of a lognormal fragility, its largest value and its profiles.
//!
//! (F1)  P(limit reached at intensity y) = Φ(z),   z = ln(y/θ)/β = a + b x,   x = ln y,  b = 1/β,  a = −ln θ/β
//!
//! (F2)  l(a, b) = Σ ln[b φ(z)] + Σ ln[Φ(z_2) − Φ(z_1)] + Σ ln Φ(−z) + Σ [k ln Φ(z) + (n − k) ln Φ(−z)]
//!
//! over capacities that were found, those known to lie between two runs, records that did not reach the limit (their largest intensity), and stripes where k of
//! n records reached it. l is concave in (a, b) (Pratt, J. Am. Stat. Assoc. 76 (1981) 103): Newton's method with steps
//! that are halved until l rises finds the maximum from anywhere, and along any straight line too. Fixing θ, β or the
//! probability at an intensity leaves a straight line each, so profiles are one-dimensional maxima.

use statrs::function::erf::erfc;

/// What one record, or one stripe, says of the fragility.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Evidence {
    /// The limit is reached at this intensity, above 0.
    At(f64),
    /// It is reached somewhere between these.
    Within([f64; 2]),
    /// It is not reached up to this intensity.
    Above(f64),
    /// It is reached at this intensity already, the lowest that was run.
    Below(f64),
    /// It is reached by `reached` of `of` records at this intensity.
    Stripe {
        /// The intensity, above 0.
        intensity: f64,
        /// Records that reach the limit.
        reached: usize,
        /// Records in all.
        of: usize,
    },
}

/// ln √(2π).
const LN_ROOT_TAU: f64 = 0.918_938_533_204_672_8;
/// From here down ln Φ is taken from its asymptotic series: its error there is below 1e-9.
const FAR: f64 = -20.0;
const MOST_STEPS: usize = 200;

/// ln Φ(z) and its first two derivatives.
fn ln_phi(z: f64) -> [f64; 3] {
    let value = if z > FAR {
        (0.5 * erfc(-z * std::f64::consts::FRAC_1_SQRT_2)).ln()
    } else {
        let s = 1.0 / (z * z);
        -0.5 * z * z - (-z).ln() - LN_ROOT_TAU + (-s * (1.0 - s * (3.0 - s * (15.0 - 105.0 * s)))).ln_1p()
    };
    let mills = (-0.5 * z * z - LN_ROOT_TAU - value).exp();
    [value, mills, -mills * (z + mills)]
}

/// Φ(z).
pub fn phi(z: f64) -> f64 {
    0.5 * erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}

/// One term of (F2): ln y less the centre, how often the limit was found there, reached, not reached; or where it lies between `x` and `to`.
#[derive(Debug, Clone, Copy)]
struct Term {
    x: f64,
    to: Option<f64>,
    at: f64,
    reached: f64,
    not: f64,
}

/// The likelihood (F2) of some evidence.
#[derive(Debug, Clone)]
pub struct Likelihood {
    terms: Vec<Term>,
    /// Mean of ln y, taken off every x.
    pub centre: f64,
    /// Spread of ln y: the scale of β where the search begins.
    spread: f64,
}

/// A point (a, b).
pub type Place = [f64; 2];

/// l, its derivatives by a and b, and the second ones by a², a b and b².
type Sums = (f64, [f64; 2], [f64; 3]);

impl Likelihood {
    /// Of evidence at intensities above 0.
    pub fn new(evidence: &[Evidence]) -> Self {
        let term = |e: &Evidence| {
            let mut to = None;
            let (y, [at, reached, not]) = match *e {
                Evidence::Within([low, high]) => {
                    to = Some(high.ln());
                    (low, [0.0; 3])
                }
                Evidence::At(y) => (y, [1.0, 0.0, 0.0]),
                Evidence::Above(y) => (y, [0.0, 0.0, 1.0]),
                Evidence::Below(y) => (y, [0.0, 1.0, 0.0]),
                Evidence::Stripe { intensity, reached, of } => {
                    (intensity, [0.0, reached as f64, of.saturating_sub(reached) as f64])
                }
            };
            Term { x: y.ln(), to, at, reached, not }
        };
        let mut terms: Vec<Term> = evidence.iter().map(term).collect();
        let n = terms.len().max(1) as f64;
        let centre = terms.iter().map(Term::middle).sum::<f64>() / n;
        for t in &mut terms {
            (t.x, t.to) = (t.x - centre, t.to.map(|to| to - centre));
        }
        let spread = (terms.iter().map(|t| t.middle().powi(2)).sum::<f64>() / n).sqrt();
        Likelihood { terms, centre, spread }
    }

    fn sums(&self, place: Place) -> Sums {
        let (mut l, mut g, mut h) = (0.0, [0.0; 2], [0.0; 3]);
        for t in &self.terms {
            let (value, [by_a, by_b], [aa, ab, bb]) = t.of(place);
            l += value;
            g = [g[0] + by_a, g[1] + by_b];
            h = [h[0] + aa, h[1] + ab, h[2] + bb];
        }
        (l, g, h)
    }

    /// What each entry adds to the derivatives of l by a and b. That by a is less the expected z of an entry, given what it tells: of a capacity that was found its own.
    pub fn scores(&self, place: Place) -> Vec<[f64; 2]> {
        self.terms.iter().map(|t| t.of(place).1).collect()
    }

    /// By what factor the variance of a quantity with the derivatives `by` a and b is larger than that of independent terms where terms of one cluster are
    /// not: `of` is the cluster of each term, and there are `clusters` of them, of which `alone` are independent, two at least (the sandwich of P. J. Huber, 1967, by clusters).
    pub fn clustered(&self, place: Place, by: [f64; 2], of: &[usize], [clusters, alone]: [usize; 2]) -> f64 {
        let mut scores = vec![[0.0; 2]; clusters];
        for (first, cluster) in self.scores(place).into_iter().zip(of) {
            scores[*cluster] = [0, 1].map(|k| scores[*cluster][k] + first[k]);
        }
        let (_, _, [aa, ab, bb]) = self.sums(place);
        let det = aa * bb - ab * ab;
        // (−H)⁻¹ by.
        let row = [-(bb * by[0] - ab * by[1]) / det, -(aa * by[1] - ab * by[0]) / det];
        let independent = row[0] * by[0] + row[1] * by[1];
        let few = alone as f64 / (alone as f64 - 1.0);
        let together: f64 = scores.iter().map(|g| (row[0] * g[0] + row[1] * g[1]).powi(2)).sum();
        (few * together / independent).max(1.0)
    }

    /// l at a place.
    pub fn at(&self, place: Place) -> f64 {
        self.sums(place).0
    }

    /// The place of the largest likelihood.
    ///
    /// # Errors
    /// Why there is none.
    pub fn largest(&self) -> Result<Place, &'static str> {
        if !(self.spread > 0.0) {
            return Err(
                "all capacities are the same, or lie between the same two runs: runs at intensities between would tell the dispersion",
            );
        }
        let mut place = [0.0, 1.0 / self.spread];
        let mut sums = self.sums(place);
        for _ in 0..MOST_STEPS {
            let (l, g, h) = sums;
            let det = h[0] * h[2] - h[1] * h[1];
            if !(det > 0.0) {
                break;
            }
            let step = [-(h[2] * g[0] - h[1] * g[1]) / det, -(h[0] * g[1] - h[1] * g[0]) / det];
            let gain = g[0] * step[0] + g[1] * step[1];
            if gain < 1e-18 * (1.0 + l.abs()) && step[1].abs() < 1e-9 * place[1] {
                return Ok(place);
            }
            let Some(risen) = self.rise(place, step, l) else { break };
            (place, sums) = risen;
            if place[1] * self.spread > 1e4 {
                return Err(
                    "one intensity may be the capacity of all records, as far as their runs tell: the dispersion is not determined, and runs between would tell it",
                );
            }
            if place[1] * self.spread < 1e-4 {
                break;
            }
        }
        Err(
            "how often the limit is reached does not rise enough with intensity for a lognormal with a finite dispersion",
        )
    }

    /// Where the step leads, halved until the likelihood does not fall and b stays above 0, and what (F2) is there.
    fn rise(&self, place: Place, mut step: [f64; 2], from: f64) -> Option<(Place, Sums)> {
        for _ in 0..60 {
            let next = [place[0] + step[0], place[1] + step[1]];
            if next[1] > 0.1 * place[1] {
                let sums = self.sums(next);
                if sums.0 >= from - 1e-13 * from.abs() {
                    return Some((next, sums));
                }
            }
            step = step.map(|s| 0.5 * s);
        }
        None
    }

    /// The largest l on the line through `place` with direction `d`.
    pub fn on_line(&self, mut place: Place, d: [f64; 2]) -> f64 {
        let mut sums = self.sums(place);
        for _ in 0..MOST_STEPS {
            let (l, g, h) = sums;
            let slope = g[0] * d[0] + g[1] * d[1];
            let curve = h[0] * d[0] * d[0] + 2.0 * h[1] * d[0] * d[1] + h[2] * d[1] * d[1];
            if !(curve < 0.0) {
                return l;
            }
            let t = -slope / curve;
            if (slope * t).abs() < 1e-13 * (1.0 + l.abs()) {
                return l;
            }
            let Some(risen) = self.rise(place, [t * d[0], t * d[1]], l) else { return l };
            (place, sums) = risen;
        }
        sums.0
    }
}

impl Term {
    fn middle(&self) -> f64 {
        0.5 * (self.x + self.to.unwrap_or(self.x))
    }

    /// What it adds to (F2).
    fn of(&self, [a, b]: Place) -> Sums {
        let (x, z) = (self.x, a + b * self.x);
        if let Some(to) = self.to {
            return between([x, to], [z, a + b * to]);
        }
        let (mut l, mut d1, mut d2) = (self.at * (b.ln() - 0.5 * z * z - LN_ROOT_TAU), -self.at * z, -self.at);
        if self.reached > 0.0 {
            let [v, s, c] = ln_phi(z);
            (l, d1, d2) = (l + self.reached * v, d1 + self.reached * s, d2 + self.reached * c);
        }
        if self.not > 0.0 {
            let [v, s, c] = ln_phi(-z);
            (l, d1, d2) = (l + self.not * v, d1 - self.not * s, d2 + self.not * c);
        }
        (l, [d1, d1 * x + self.at / b], [d2, d2 * x, d2 * x * x - self.at / (b * b)])
    }
}

/// ln[Φ(z_2) − Φ(z_1)] with its derivatives.
fn between(x: [f64; 2], z: [f64; 2]) -> Sums {
    // Of the tail that is the smaller one: the difference of two numbers next to 1 has no digits.
    let [far, near] = if z[0] > 0.0 { [-z[1], -z[0]] } else { z };
    let [far, near] = [far, near].map(|z| ln_phi(z)[0]);
    let value = near + (-(far - near).exp()).ln_1p();
    let density = z.map(|z| (-0.5 * z * z - LN_ROOT_TAU - value).exp());
    // Σ ± φ x^p and Σ ± (−z φ) x^p.
    let first = |p: i32| density[1] * x[1].powi(p) - density[0] * x[0].powi(p);
    let second = |p: i32| z[0] * density[0] * x[0].powi(p) - z[1] * density[1] * x[1].powi(p);
    let [g, h] = [first(0), first(1)];
    (value, [g, h], [second(0) - g * g, second(1) - g * h, second(2) - h * h])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Φ(−1) = 0.15865525393145707; ln Φ(−30) = −454.3212439 by the asymptotic series (Abramowitz & Stegun 26.2.12).
    #[test]
    fn the_logarithm_of_phi_holds_far_out() {
        assert!((ln_phi(-1.0)[0] - 0.158_655_253_931_457_07f64.ln()).abs() < 1e-9);
        assert!((ln_phi(-30.0)[0] + 454.321_243_956).abs() < 1e-7);
        let (above, below) = (ln_phi(FAR + 1e-9), ln_phi(FAR - 1e-9));
        // The curvature is the difference of two numbers four hundred times as large.
        for (k, allowed) in [1e-9, 1e-8, 1e-5].into_iter().enumerate() {
            assert!((above[k] / below[k] - 1.0).abs() < allowed, "{k}: {above:?} {below:?}");
        }
    }

    #[test]
    fn derivatives_are_those_of_the_value() {
        let evidence = [
            Evidence::At(0.2),
            Evidence::At(0.5),
            Evidence::Above(0.7),
            Evidence::Below(0.1),
            Evidence::Stripe { intensity: 0.4, reached: 2, of: 5 },
            Evidence::Within([0.3, 0.42]),
            Evidence::Within([1.2, 1.5]),
        ];
        let l = Likelihood::new(&evidence);
        let (p, e) = ([0.3, 1.7], 1e-5);
        let (_, g, h) = l.sums(p);
        for k in 0..2 {
            let mut q = [p, p];
            (q[0][k], q[1][k]) = (p[k] - e, p[k] + e);
            let slope = (l.at(q[1]) - l.at(q[0])) / (2.0 * e);
            assert!((slope - g[k]).abs() < 1e-7, "{slope} {}", g[k]);
            let curve = (l.sums(q[1]).1[k] - l.sums(q[0]).1[k]) / (2.0 * e);
            assert!((curve - h[2 * k]).abs() < 1e-6, "{curve} {}", h[2 * k]);
        }
    }
}
