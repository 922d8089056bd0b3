//! Where the law meets the line of a joint's impedance, for joints of any lanes side by side: the operations of the
//! search in [`crate::integrate::stage`] in eight rows at a time, whatever lanes the joints are in.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use pulp::{Simd, WithSimd};

use crate::integrate::joints::{MEETING, MOST_SEARCHED};
use crate::lanes::rows::{Law, V, WIDTH, friction};
use crate::lanes::work::{
    ALPHA, AT, DYNAMIC, EXCESS, MU, Miss, NORMALS, SLIP, SLOPE, SLOPE_AT_REST, STATIC, STEEP, TAU, WIDTH_AT_REST, Work,
};

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
            work.unpack(some, found);
        }
        work.misses = misses;
    }
}

/// Up to eight searches. Places that are not taken find the law met at once.
struct Pack {
    /// τ, the diagonal on both sides, the sum of N on both sides: what the impedance follows from.
    tau: [f64; WIDTH],
    diagonals: [[f64; WIDTH]; 2],
    normals: [f64; WIDTH],
    /// Where the tangent was at the last velocity, and that velocity.
    target: [f64; WIDTH],
    velocity: [f64; WIDTH],
    width: [f64; WIDTH],
    static_: [f64; WIDTH],
    slope_at_rest: [f64; WIDTH],
    law: [[f64; WIDTH]; 5],
}

impl Work {
    fn pack(&self, misses: &[Miss]) -> Pack {
        let (zero, one) = ([0.0; WIDTH], [1.0; WIDTH]);
        let mut p = Pack {
            tau: one,
            diagonals: [one; 2],
            normals: one,
            target: zero,
            velocity: zero,
            width: one,
            static_: one,
            slope_at_rest: zero,
            law: [zero, zero, one, one, zero],
        };
        for (i, miss) in misses.iter().enumerate() {
            let (r, lane) = (miss.rub as usize, miss.lane as usize);
            let [a, b] = self.topology.rubs[r].sides;
            p.tau[i] = self.lane.at(TAU, lane);
            p.diagonals[0][i] = self.elastic_diagonal.at(a as usize, lane);
            // Base and top do not give way.
            let gives_way = b < self.topology.unknowns;
            p.diagonals[1][i] = if gives_way { self.elastic_diagonal.at(b as usize, lane) } else { f64::INFINITY };
            (p.target[i], p.velocity[i]) = (miss.target, self.laws.at(r, AT, lane));
            for (row, to) in [STATIC, WIDTH_AT_REST, SLOPE_AT_REST, NORMALS].into_iter().zip([
                &mut p.static_,
                &mut p.width,
                &mut p.slope_at_rest,
                &mut p.normals,
            ]) {
                to[i] = self.searches.at(r, row, lane);
            }
            for (row, to) in [EXCESS, DYNAMIC, SLIP, STEEP, ALPHA].into_iter().zip(&mut p.law) {
                to[i] = self.rubs.at(r, row, lane);
            }
        }
        p
    }

    fn unpack(&mut self, misses: &[Miss], found: [[f64; WIDTH]; 3]) {
        for (i, miss) in misses.iter().enumerate() {
            for (row, values) in [AT, MU, SLOPE].into_iter().zip(&found) {
                self.tangents.set(miss.rub as usize, row, miss.lane as usize, values[i]);
            }
        }
    }
}

impl Pack {
    /// Velocity, μ and slope where each search ends.
    #[inline(always)]
    fn search<S: Simd>(&self, simd: S) -> [[f64; WIDTH]; 3] {
        let row = |values: [f64; WIDTH]| V::of(simd, values);
        let [excess, dynamic, slip, steep, alpha] = self.law.map(row);
        let law = Law { excess, dynamic, slip_velocity: slip, steep, alpha };
        let (zero, one) = (V::splat(simd, 0.0), V::splat(simd, 1.0));
        let [at_a, at_b] = self.diagonals.map(row);
        let free = 1.0 / at_a + 1.0 / at_b;
        let z = 1.0 / (row(self.tau) * 0.5 * row(self.normals) * free);
        let signed = row(self.target) + z * row(self.velocity);
        let (c, width, static_) = (signed.abs(), row(self.width), row(self.static_));
        let mut high = c / z;
        let meets = c.above(zero).and(high.at_most(V::splat(simd, f64::MAX)));
        let (z, c) = (meets.pick(z, one), meets.pick(c, zero));
        high = meets.pick(high, one);
        let mut v = meets.pick(first(c, high, width, static_), zero);
        let near = MEETING * static_;
        let mut low = zero;
        let (mut mu, mut slope) = friction(law, v);
        let mut searching = meets;
        for _ in 0..MOST_SEARCHED {
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
        let sign = one.with_sign_of(signed);
        let slope = meets.pick(slope, row(self.slope_at_rest));
        [(sign * v).numbers(), meets.pick(sign * mu, zero).numbers(), slope.numbers()]
    }
}

/// On the branch that the right side points to: the inverse of the arctangent (to a tenth), or the velocity.
#[inline(always)]
fn first<S: Simd>(c: V<S>, high: V<S>, width: V<S>, static_: V<S>) -> V<S> {
    let like = |value| V::splat(c.simd(), value);
    let ratio = c / static_;
    let square = ratio * ratio;
    let on_rise = width * ratio * (FRAC_PI_2 - (FRAC_PI_2 - 2.0 * FRAC_2_PI) * square) / (1.0 - square);
    let (limit, zero) = (like(0.95), like(0.0));
    let v = ratio.below(limit).pick(on_rise, high);
    v.above(zero).and(v.below(high)).pick(v, 0.5 * high)
}
