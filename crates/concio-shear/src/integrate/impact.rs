//! Impacts of rigid joints. Sides a and b of joint j approach each other with w_j = v_a − v_b. Of all joints that touch,
//!
//!   (R3)  M (v⁺ − v⁻) = −Σ_j B_j p_j
//!   (R4)  0 ≤ p_j  ⊥  w_j⁺ ≤ −e_j w_j⁻
//!
//! that is Newton's law of impact where a joint closes, and rest or parting where it touched before. A joint that parted
//! may be left closing: it collides in the next round of the same instant. (Forbidding that at once would bring energy
//! in; with one e for all, (R4) takes (1 − e)/(1 + e) of ½ (v⁺ − v⁻)ᵀ M (v⁺ − v⁻), Moreau, in *Nonsmooth Mechanics and
//! Applications*, Springer 1988. Where joints of different e would bring energy in, the least e holds for all.)
//! Friction, springs and dashpots are bounded and bring no impulse. In a row of blocks (R4) is a complementarity problem with an M-matrix:
//! adding joints that still approach, until there are none, ends after at most as many rounds as there are joints
//! (Chandrasekaran, Opsearch 7 (1970) 263); where connections branch a joint may have to be taken back, at last one at
//! a time by least index (Murty, Linear Algebra Appl. 9 (1974) 65). The joints that bear are held as in a stage.

use crate::dynamics::TOUCHING;
use crate::integrate::groups::Groups;
use crate::integrate::linear::{Factoring, Matrix};
use crate::state::State;
use crate::system::System;

/// Slope that holds a joint, over the largest reduced mass; each refinement leaves about the inverse of it.
const HOLD: f64 = 1e6;
/// Refinements of the velocities.
const REFINEMENTS: usize = 6;
/// Rounds in which all joints change at once; afterwards they do one by one.
const AT_ONCE: usize = 8;
/// Rounds of collisions at one instant, after which joints stay closed that close.
pub const COLLISIONS: usize = 200;
/// Impulse that counts as none, as a fraction of the largest.
const NO_IMPULSE: f64 = 1e-12;

/// Scratch for impacts.
#[derive(Debug, Clone)]
pub struct Impacts {
    matrix: Matrix,
    slots: Vec<u32>,
    hold: f64,
    groups: Groups,
    touching: Vec<bool>,
    active: Vec<bool>,
    plastic: Vec<bool>,
    /// Joints that do not part at first, and may not close more after all.
    resting: Vec<bool>,
    /// Joints that touched when the step began at whose end they collide: they bounce no higher than is seen.
    pub lingering: Vec<bool>,
    target: Vec<f64>,
    /// w⁻ of every rigid joint [m/s].
    pub before: Vec<f64>,
    /// w⁺ of every rigid joint [m/s].
    pub after: Vec<f64>,
    /// p of every rigid joint [N s].
    pub impulse: Vec<f64>,
    initial: Vec<f64>,
    rhs: Vec<f64>,
}

impl Impacts {
    /// Scratch for `system`.
    pub fn new(system: &System) -> Self {
        let n = system.unknowns();
        let sides = || system.contacts.iter().map(|c| system.sides[c.joint as usize].map(|s| s as usize));
        let pairs: Vec<(usize, usize)> = sides().filter(|s| s[1] < n).map(|[a, b]| (a, b)).collect();
        let n = if system.contacts.is_empty() { 0 } else { n };
        let (matrix, among) = Matrix::new(n, if n > 0 { &pairs } else { &[] }, &[], Factoring::Symmetric);
        let mut among = among.into_iter();
        let slots = sides().map(|s| if s[1] < n { among.next().unwrap_or(u32::MAX) } else { u32::MAX }).collect();
        let inverse = |i: usize| system.mass.get(i).map_or(0.0, |m| m.recip());
        let reduced = sides().map(|[a, b]| (inverse(a) + inverse(b)).recip()).fold(0.0, f64::max);
        let c = system.contacts.len();
        Impacts {
            matrix,
            slots,
            hold: HOLD * reduced,
            groups: Groups::new(if c > 0 { n } else { 0 }),
            touching: vec![false; c],
            active: vec![false; c],
            plastic: vec![false; c],
            resting: vec![false; c],
            lingering: vec![false; c],
            target: vec![0.0; c],
            before: vec![0.0; c],
            after: vec![0.0; c],
            impulse: vec![0.0; c],
            initial: vec![0.0; if c > 0 { n + 2 } else { 0 }],
            rhs: vec![0.0; if c > 0 { n } else { 0 }],
        }
    }

    /// Whether the sides of a rigid joint that touches approach each other.
    pub fn due(system: &System, state: &State) -> bool {
        system.contacts.iter().any(|contact| {
            let [a, b] = system.sides[contact.joint as usize].map(|s| s as usize);
            state.z[a] - state.z[b] >= -TOUCHING && state.v[a] > state.v[b]
        })
    }

    /// Solves (R3) and (R4) for the velocities in `state`, once; `collision` counts from 0 at one instant. Joints that
    /// close more slowly than `slow` [m/s], or are `lingering`, stay closed, so that bounces come to an end. Returns the largest
    /// |w⁺ − target| [m/s] of the joints that bear.
    pub fn solve(&mut self, system: &System, state: &mut State, slow: f64, collision: usize) -> f64 {
        let at_most = if collision < COLLISIONS { 1.0 } else { 0.0 };
        self.start(system, state, slow, at_most);
        self.find(system, state);
        if self.lost() < 0.0 {
            let touching = |c: &usize| self.touching[*c];
            let least = (0..self.touching.len()).filter(touching).map(|c| system.contacts[c].restitution);
            let slowed =
                (0..self.touching.len()).any(|c| self.touching[c] && self.before[c] > 0.0 && self.target[c] == 0.0);
            let least = if slowed { 0.0 } else { least.fold(at_most, f64::min) };
            state.v.copy_from_slice(&self.initial);
            self.start(system, state, slow, least);
            self.find(system, state);
        }
        let residual = self.misfit();
        self.come_to_rest(system, state);
        residual
    }

    /// Energy lost [J].
    fn lost(&self) -> f64 {
        let joints = self.impulse.iter().zip(&self.before).zip(&self.after);
        let (lost, size) = joints.fold((0.0, 0.0), |(lost, size), ((p, before), after)| {
            (lost + p * (before + after), size + (p * before).abs())
        });
        // Impulses are known to ten digits.
        if lost.abs() < 1e-9 * size { 0.0 } else { 0.5 * lost }
    }

    fn find(&mut self, system: &System, state: &mut State) {
        for round in 0..AT_ONCE + 4 * system.contacts.len() {
            self.bear(system, state);
            if !self.change(round >= AT_ONCE) {
                break;
            }
        }
    }

    fn start(&mut self, system: &System, state: &State, slow: f64, at_most: f64) {
        self.initial.copy_from_slice(&state.v);
        for (c, contact) in system.contacts.iter().enumerate() {
            let [a, b] = system.sides[contact.joint as usize].map(|s| s as usize);
            let w = state.v[a] - state.v[b];
            self.touching[c] = state.z[a] - state.z[b] >= -TOUCHING;
            self.resting[c] = self.touching[c] && (w >= 0.0 || at_most == 0.0);
            self.before[c] = w;
            let e = if w > 0.0 && (w <= slow || self.lingering[c]) { 0.0 } else { contact.restitution.min(at_most) };
            // No negative zero: a target of 0 is rest.
            self.target[c] = if e > 0.0 { -e * w } else { 0.0 };
            self.active[c] = self.touching[c] && w > 0.0;
        }
    }

    /// The velocities with which the active joints meet their targets, and the impulses that this takes.
    fn bear(&mut self, system: &System, state: &mut State) {
        let n = system.unknowns();
        self.assemble(system);
        state.v.copy_from_slice(&self.initial);
        self.impulse.fill(0.0);
        for _ in 0..REFINEMENTS {
            for (i, &place) in self.matrix.places().iter().enumerate() {
                self.rhs[place as usize] = system.mass[i] * (self.initial[i] - state.v[i]);
            }
            for (c, contact) in system.contacts.iter().enumerate().filter(|(c, _)| self.active[*c]) {
                let [a, b] = system.sides[contact.joint as usize].map(|s| s as usize);
                let p = self.impulse[c] + self.hold * (state.v[a] - state.v[b] - self.target[c]);
                self.rhs[self.matrix.places()[a] as usize] -= p;
                if b < n {
                    self.rhs[self.matrix.places()[b] as usize] += p;
                }
            }
            self.matrix.solve(&mut self.rhs);
            for (i, &place) in self.matrix.places().iter().enumerate() {
                state.v[i] += self.rhs[place as usize];
            }
            for (c, contact) in system.contacts.iter().enumerate() {
                let [a, b] = system.sides[contact.joint as usize].map(|s| s as usize);
                self.after[c] = state.v[a] - state.v[b];
                if self.active[c] {
                    self.impulse[c] += self.hold * (self.after[c] - self.target[c]);
                }
            }
        }
    }

    /// M + σ Σ B Bᵀ over the active joints, factorised. Symmetric and positive definite whatever they are.
    fn assemble(&mut self, system: &System) {
        let n = system.unknowns();
        self.matrix.lower.fill(0.0);
        for i in 0..n {
            let place = self.matrix.places()[i] as usize;
            self.matrix.diagonal[place] = system.mass[i];
        }
        for (c, contact) in system.contacts.iter().enumerate().filter(|(c, _)| self.active[*c]) {
            let [a, b] = system.sides[contact.joint as usize].map(|s| s as usize);
            let place = self.matrix.places()[a] as usize;
            self.matrix.diagonal[place] += self.hold;
            if b < n {
                let place = self.matrix.places()[b] as usize;
                self.matrix.diagonal[place] += self.hold;
                self.matrix.lower[self.slots[c] as usize] -= self.hold;
            }
        }
        let factorised = self.matrix.factorise();
        debug_assert!(factorised.is_ok());
    }

    /// Adds joints that approach too fast and takes back those that would have to pull, or the first of them alone;
    /// false when there are none.
    fn change(&mut self, one: bool) -> bool {
        let largest = self.impulse.iter().fold(0.0f64, |m, p| m.max(p.abs()));
        let mut changed = false;
        for c in 0..self.active.len() {
            let wrong = if self.active[c] {
                self.impulse[c] < -NO_IMPULSE * largest
            } else {
                self.touching[c] && self.after[c] > self.target[c]
            };
            if wrong && !(one && changed) {
                self.active[c] = !self.active[c];
                changed = true;
            }
        }
        changed
    }

    fn misfit(&self) -> f64 {
        (0..self.active.len())
            .filter(|&c| self.active[c])
            .fold(0.0, |m, c| (self.after[c] - self.target[c]).abs().max(m))
    }

    /// Joints that bear and do not bounce get one velocity on both sides, to the bit.
    fn come_to_rest(&mut self, system: &System, state: &mut State) {
        for c in 0..self.active.len() {
            self.impulse[c] = self.impulse[c].max(0.0);
            self.plastic[c] = self.active[c] && self.target[c] == 0.0;
        }
        self.groups.rest(system, &[], &mut self.plastic, &self.resting, &mut state.v);
        for (c, contact) in system.contacts.iter().enumerate() {
            let [a, b] = system.sides[contact.joint as usize].map(|s| s as usize);
            self.after[c] = state.v[a] - state.v[b];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{Link, Side, lumped};
    use proptest::prelude::*;

    proptest! {
        /// One round among touching and open joints of a row, or of one with branches: (R3) by momentum, (R4) in every
        /// joint, no gain of energy though each joint has an e of its own.
        #[test]
        fn one_round_is_complementary(
            row in prop::collection::vec((0.1f64..10.0, -1.0f64..1.0, prop::bool::ANY, 0usize..4), 2..14),
            branched in prop::bool::ANY,
        ) {
            let mass: Vec<f64> = row.iter().map(|r| r.0).collect();
            let of = [0.0, 0.4, 0.8, 1.0];
            let left = |i: usize| if branched { (i - 1) / 2 } else { i - 1 };
            let links: Vec<Link> =
                (1..row.len()).map(|i| Link::rigid(left(i), Side::Block(i), of[row[i].3])).collect();
            let system = lumped(&mass, &links, 1.0);
            let mut state = State::at_rest(&system);
            for (i, r) in row.iter().enumerate() {
                state.v[i] = r.1;
                // Open joints: 1 m and more to the right.
                state.z[i] = if r.2 { 0.0 } else { 1.0 + i as f64 };
            }
            let before = state.v.clone();
            let mut impacts = Impacts::new(&system);
            let residual = impacts.solve(&system, &mut state, 0.0, 0);
            prop_assert!(residual <= 1e-13, "{residual:e}");
            let momentum = |v: &[f64]| mass.iter().zip(v).map(|(m, v)| m * v).sum::<f64>();
            prop_assert!((momentum(&state.v) - momentum(&before)).abs() <= 1e-12 * mass.iter().sum::<f64>());
            let energy = |v: &[f64]| mass.iter().zip(v).map(|(m, v)| 0.5 * m * v * v).sum::<f64>();
            prop_assert!(energy(&state.v) <= energy(&before) * (1.0 + 1e-9));
            for (c, link) in links.iter().enumerate() {
                let [a, b] = [link.a, c + 1];
                let w = state.v[a] - state.v[b];
                let p = impacts.impulse[c];
                if state.z[a] - state.z[b] < -TOUCHING {
                    prop_assert!(p == 0.0);
                    continue;
                }
                prop_assert!(p >= 0.0);
                prop_assert!(w <= impacts.target[c] + 1e-13, "joint {} closes with {}", c, w);
                let slack = (w - impacts.target[c]).abs();
                prop_assert!(p * slack <= 1e-11 * mass.iter().sum::<f64>(), "joint {} bears {} and parts", c, p);
            }
        }
    }
}
