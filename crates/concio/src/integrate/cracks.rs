//! Where bonds crack inside a step, and what they become at its end.
//!
//! Inside a step relative displacements are taken as cubics through displacements and velocities at both ends.

use crate::bond::Bond;
use crate::model::Model;
use crate::state::State;

/// Relative displacements at both ends of a step, and the velocities times its length.
#[derive(Debug, Clone, Copy)]
struct Course {
    d: [f64; 2],
    hw: [f64; 2],
}

impl Course {
    fn of(sides: [u32; 2], state: &State, z: &[f64], v: &[f64], h: f64) -> Self {
        let [a, b] = sides.map(|s| s as usize);
        let hw = [h * (state.v[a] - state.v[b]), h * (v[a] - v[b])];
        Course { d: [state.z[a] - state.z[b], z[a] - z[b]], hw }
    }

    /// Relative displacement after the fraction `s` of the step.
    fn at(&self, s: f64) -> f64 {
        let ([d0, d1], [w0, w1], r) = (self.d, self.hw, 1.0 - s);
        r * r * ((1.0 + 2.0 * s) * d0 + s * w0) + s * s * ((1.0 + 2.0 * r) * d1 - r * w1)
    }

    /// The first fraction of the step at which the bond is stretched by `limit`; none when it is not.
    fn reaches(&self, law: &Bond, limit: f64) -> Option<f64> {
        let ([d0, d1], [w0, w1]) = (self.d, self.hw);
        // The curve lies within the hull of its control points.
        let hull = [d0, d0 + w0 / 3.0, d1 - w1 / 3.0, d1];
        if hull.iter().all(|d| law.stretch(*d) < limit) {
            return None;
        }
        let parts = 16;
        let beyond = |s: f64| law.stretch(self.at(s)) >= limit;
        let part = (1..=parts).find(|k| beyond(f64::from(*k) / f64::from(parts)))?;
        let (mut low, mut high) = (f64::from(part - 1) / f64::from(parts), f64::from(part) / f64::from(parts));
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if beyond(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(high)
    }
}

/// How far below its strength a bond cracks with one that reaches it, as a fraction: joints that are equal but for rounding
/// crack together.
const TOGETHER: f64 = 1e-9;

/// The first fraction of a step of `h` to `z`, `v` at which a brittle bond exceeds its strength by half of `excess`, a
/// fraction of it; none when none exceeds it by more.
pub fn first(model: &Model, state: &State, z: &[f64], v: &[f64], h: f64, excess: f64) -> Option<f64> {
    let mut first = f64::INFINITY;
    for (bond, held) in model.bonds.iter().zip(&state.bonds) {
        if !bond.law.is_brittle() || held.damage > 0.0 {
            continue;
        }
        let course = Course::of(model.sides[bond.joint as usize], state, z, v, h);
        let limit = bond.law.limit();
        if course.reaches(&bond.law, limit * (1.0 + excess)).is_some()
            && let Some(s) = course.reaches(&bond.law, limit * (1.0 + 0.5 * excess))
        {
            first = first.min(s);
        }
    }
    first.is_finite().then_some(first)
}

/// Brings the bonds to the end of a step of `h` to `z`, `v`, before `state` is moved there, and books what cracking took. True
/// when forces jump with it.
pub fn grow(model: &Model, state: &mut State, z: &[f64], v: &[f64], h: f64) -> bool {
    let mut jumps = false;
    for (b, bond) in model.bonds.iter().enumerate() {
        let (law, mut held) = (&bond.law, state.bonds[b]);
        let course = Course::of(model.sides[bond.joint as usize], state, z, v, h);
        let (reach, limit) = (law.stretch(course.d[1]), law.limit());
        if held.broken.is_finite() || reach <= held.reach || reach < limit * (1.0 - TOGETHER) {
            continue;
        }
        let end = state.t + h;
        if law.is_brittle() {
            held.cracked = end;
            held.broken = end;
        } else {
            if reach <= limit {
                continue;
            }
            if held.damage == 0.0 {
                held.cracked = state.t + h * course.reaches(law, limit).unwrap_or(1.0);
            }
            if law.is_broken(reach) {
                held.broken = end;
            }
        }
        held.reach = reach;
        let broken = held.broken.is_finite();
        jumps |= broken;
        held.damage = if broken { 1.0 } else { law.damage(reach).0 };
        let spent = law.spent(reach, held.damage);
        state.energies.bond += spent - held.spent;
        held.spent = spent;
        state.bonds[b] = held;
    }
    jumps
}
