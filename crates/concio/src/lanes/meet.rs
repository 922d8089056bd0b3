//! Where the law meets the line of a joint's impedance, for joints of any lanes side by side: the operations of the
//! search in [`crate::integrate::stage`] in eight rows at a time, whatever lanes the joints are in.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use pulp::{Simd, WithSimd};

use crate::lanes::rows::{Law, V, WIDTH, friction};
use crate::lanes::work::{Miss, TAU, Work};

/// As in the stage of a single run.
const MEETING: f64 = 0.01;
const MOST: usize = 20;

/// Moves the tangents of all [`Work::misses`].
pub struct Meet<'a>(pub &'a mut Work);

impl WithSimd for Meet<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let work = self.0;
        let misses = std::mem::take(&mut work.misses);
        for some in misses.chunks(WIDTH) {
            let pack = work.pack(some);
            let found = pack.search(simd);
            work.unpack(some, &pack, found);
        }
        work.misses = misses;
    }
}

/// Up to eight searches. Places that are not taken search what is found at once.
struct Pack {
    /// Z, |c| and the sign of c, upper end of the bracket, δ_v/β, first velocity.
    z: [f64; WIDTH],
    c: [f64; WIDTH],
    sign: [f64; WIDTH],
    high: [f64; WIDTH],
    width: [f64; WIDTH],
    v: [f64; WIDTH],
    static_: [f64; WIDTH],
    excess: [f64; WIDTH],
    dynamic: [f64; WIDTH],
    slip: [f64; WIDTH],
    steep: [f64; WIDTH],
    alpha: [f64; WIDTH],
    /// Whether the law is met at rest because there is no line to meet it elsewhere.
    at_rest: [bool; WIDTH],
}

impl Work {
    fn pack(&self, misses: &[Miss]) -> Pack {
        let (zero, one) = ([0.0; WIDTH], [1.0; WIDTH]);
        let mut p = Pack {
            z: one,
            c: zero,
            sign: one,
            high: one,
            width: one,
            v: zero,
            static_: one,
            excess: zero,
            dynamic: zero,
            slip: one,
            steep: one,
            alpha: zero,
            at_rest: [false; WIDTH],
        };
        for (i, miss) in misses.iter().enumerate() {
            let (r, lane) = (miss.rub as usize, miss.lane as usize);
            let [a, b] = self.topology.rubs[r].sides.map(|s| s as usize);
            let mut free = self.elastic_diagonal.at(a, lane).recip();
            free += if b < self.topology.unknowns as usize { self.elastic_diagonal.at(b, lane).recip() } else { 0.0 };
            let tau = self.lane.at(TAU, lane);
            let z = 1.0 / (tau * 0.5 * self.normals.at(r, lane) * free);
            let c = miss.target + z * self.velocity.at(r, lane);
            let high = c.abs() / z;
            (p.static_[i], p.steep[i]) = (self.static_.at(r, lane), self.steep.at(r, lane));
            if c == 0.0 || !high.is_finite() {
                p.at_rest[i] = true;
                continue;
            }
            (p.z[i], p.c[i], p.sign[i], p.high[i]) = (z, c.abs(), c.signum(), high);
            (p.excess[i], p.dynamic[i]) = (self.excess.at(r, lane), self.dynamic.at(r, lane));
            (p.slip[i], p.alpha[i]) = (self.slip.at(r, lane), self.alpha.at(r, lane));
            p.width[i] = self.width.at(r, lane);
            p.v[i] = first(p.c[i], high, p.width[i], p.static_[i]);
        }
        p
    }

    fn unpack(&mut self, misses: &[Miss], pack: &Pack, found: [[f64; WIDTH]; 3]) {
        let [v, mu, slope] = found;
        for (i, miss) in misses.iter().enumerate() {
            let (r, lane) = (miss.rub as usize, miss.lane as usize);
            let at = if pack.at_rest[i] {
                [0.0, 0.0, self.slope_at_rest.at(r, lane)]
            } else {
                [pack.sign[i] * v[i], pack.sign[i] * mu[i], slope[i]]
            };
            self.tangents.velocity.set(r, lane, at[0]);
            self.tangents.mu.set(r, lane, at[1]);
            self.tangents.slope.set(r, lane, at[2]);
        }
    }
}

/// On the branch that the right side points to: the inverse of the arctangent (to a tenth), or the velocity.
fn first(c: f64, high: f64, width: f64, static_: f64) -> f64 {
    let ratio = c / static_;
    let v = if ratio < 0.95 {
        let square = ratio * ratio;
        width * ratio * (FRAC_PI_2 - (FRAC_PI_2 - 2.0 * FRAC_2_PI) * square) / (1.0 - square)
    } else {
        high
    };
    if v > 0.0 && v < high { v } else { 0.5 * high }
}

impl Pack {
    #[inline(always)]
    fn search<S: Simd>(&self, simd: S) -> [[f64; WIDTH]; 3] {
        let row = |values: [f64; WIDTH]| V::of(simd, values);
        let law = Law {
            excess: row(self.excess),
            dynamic: row(self.dynamic),
            slip: row(self.slip),
            steep: row(self.steep),
            alpha: row(self.alpha),
        };
        let (z, c, width, zero) = (row(self.z), row(self.c), row(self.width), V::splat(simd, 0.0));
        let near = MEETING * row(self.static_);
        let (mut low, mut high, mut v) = (zero, row(self.high), row(self.v));
        let (mut mu, mut slope) = friction(law, v);
        let mut searching = zero.at_most(zero);
        for _ in 0..MOST {
            let f = mu + z * v - c;
            searching = searching.and(f.abs().at_most(near).not());
            if !searching.any() {
                break;
            }
            let short = f.below(zero);
            low = searching.and(short).pick(v, low);
            high = searching.and(short.not()).pick(v, high);
            let newton = v - f / (slope + z);
            let inside = newton.above(low).and(newton.below(high));
            let mean = (low.max(1e-3 * width) * high).sqrt().max(low).min(high);
            v = searching.pick(inside.pick(newton, mean), v);
            let (new_mu, new_slope) = friction(law, v);
            mu = searching.pick(new_mu, mu);
            slope = searching.pick(new_slope, slope);
        }
        [v.numbers(), mu.numbers(), slope.numbers()]
    }
}
