//! Impacts of rigid joints. Sides a and b of joint j approach each other with w_j = v_a − v_b. Of all joints that touch,
//!
//!   (R3)  M (v⁺ − v⁻) = −Σ_j B_j p_j
//!   (R4)  0 ≤ p_j  ⊥  w_j⁺ ≤ −e_j max(w_j⁻, 0)
//!
//! that is Newton's law of impact where a joint closes, and rest or parting where it touched before. Friction, springs
//! and dashpots are bounded and bring no impulse. In a row of blocks (R4) is a complementarity problem with an M-matrix:
//! adding joints that still approach, until there are none, ends after at most as many rounds as there are joints
//! (Chandrasekaran, Opsearch 7 (1970) 263); where connections branch a joint may have to be taken back, at last one at
//! a time by least index (Murty, Linear Algebra Appl. 9 (1974) 65). The joints that bear are held as in a stage.

use crate::integrate::events::TOUCHING;
use crate::integrate::groups::Groups;
use crate::integrate::linear::Matrix;
use crate::model::Model;
use crate::state::State;

/// Slope that holds a joint, over the largest reduced mass; each refinement leaves about the inverse of it.
const HOLD: f64 = 1e6;
/// Refinements of the velocities.
const REFINEMENTS: usize = 6;
/// Rounds in which all joints change at once; afterwards they do one by one.
const AT_ONCE: usize = 8;
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
    /// Scratch for `model`.
    pub fn new(model: &Model) -> Self {
        let n = model.unknowns();
        let sides = || model.contacts.iter().map(|c| model.sides[c.joint as usize].map(|s| s as usize));
        let pairs: Vec<(usize, usize)> = sides().filter(|s| s[1] < n).map(|[a, b]| (a, b)).collect();
        let (matrix, among) = if model.contacts.is_empty() { Matrix::new(0, &[]) } else { Matrix::new(n, &pairs) };
        let mut among = among.into_iter();
        let slots = sides().map(|s| if s[1] < n { among.next().unwrap_or(u32::MAX) } else { u32::MAX }).collect();
        let inverse = |i: usize| model.mass.get(i).map_or(0.0, |m| m.recip());
        let reduced = sides().map(|[a, b]| (inverse(a) + inverse(b)).recip()).fold(0.0, f64::max);
        let c = model.contacts.len();
        Impacts {
            matrix,
            slots,
            hold: HOLD * reduced,
            groups: Groups::new(if c > 0 { n } else { 0 }),
            touching: vec![false; c],
            active: vec![false; c],
            plastic: vec![false; c],
            target: vec![0.0; c],
            before: vec![0.0; c],
            after: vec![0.0; c],
            impulse: vec![0.0; c],
            initial: vec![0.0; if c > 0 { n + 2 } else { 0 }],
            rhs: vec![0.0; if c > 0 { n } else { 0 }],
        }
    }

    /// Whether the sides of a rigid joint that touches approach each other.
    pub fn due(model: &Model, state: &State) -> bool {
        model.contacts.iter().any(|contact| {
            let [a, b] = model.sides[contact.joint as usize].map(|s| s as usize);
            state.z[a] - state.z[b] >= -TOUCHING && state.v[a] > state.v[b]
        })
    }

    /// Solves (R3) and (R4) for the velocities in `state`. Joints that close more slowly than `slow` [m/s] stay closed,
    /// so that bounces come to an end. Returns the largest |w⁺ − target| [m/s] of the joints that bear.
    pub fn solve(&mut self, model: &Model, state: &mut State, slow: f64) -> f64 {
        self.start(model, state, slow);
        for round in 0..AT_ONCE + 4 * model.contacts.len() {
            self.bear(model, state);
            if !self.change(round >= AT_ONCE) {
                break;
            }
        }
        let residual = self.misfit();
        self.come_to_rest(model, state);
        residual
    }

    fn start(&mut self, model: &Model, state: &State, slow: f64) {
        self.initial.copy_from_slice(&state.v);
        for (c, contact) in model.contacts.iter().enumerate() {
            let [a, b] = model.sides[contact.joint as usize].map(|s| s as usize);
            let w = state.v[a] - state.v[b];
            self.touching[c] = state.z[a] - state.z[b] >= -TOUCHING;
            self.before[c] = w;
            self.target[c] = if w > slow { -contact.restitution * w } else { 0.0 };
            self.active[c] = self.touching[c] && w > 0.0;
        }
    }

    /// The velocities with which the active joints meet their targets, and the impulses that this takes.
    fn bear(&mut self, model: &Model, state: &mut State) {
        let n = model.unknowns();
        self.assemble(model);
        state.v.copy_from_slice(&self.initial);
        self.impulse.fill(0.0);
        for _ in 0..REFINEMENTS {
            for (i, &place) in self.matrix.places().iter().enumerate() {
                self.rhs[place as usize] = model.mass[i] * (self.initial[i] - state.v[i]);
            }
            for (c, contact) in model.contacts.iter().enumerate().filter(|(c, _)| self.active[*c]) {
                let [a, b] = model.sides[contact.joint as usize].map(|s| s as usize);
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
            for (c, contact) in model.contacts.iter().enumerate() {
                let [a, b] = model.sides[contact.joint as usize].map(|s| s as usize);
                self.after[c] = state.v[a] - state.v[b];
                if self.active[c] {
                    self.impulse[c] += self.hold * (self.after[c] - self.target[c]);
                }
            }
        }
    }

    /// M + σ Σ B Bᵀ over the active joints, factorised. Symmetric and positive definite whatever they are.
    fn assemble(&mut self, model: &Model) {
        let n = model.unknowns();
        self.matrix.lower.fill(0.0);
        for i in 0..n {
            let place = self.matrix.places()[i] as usize;
            self.matrix.diagonal[place] = model.mass[i];
        }
        for (c, contact) in model.contacts.iter().enumerate().filter(|(c, _)| self.active[*c]) {
            let [a, b] = model.sides[contact.joint as usize].map(|s| s as usize);
            let place = self.matrix.places()[a] as usize;
            self.matrix.diagonal[place] += self.hold;
            if b < n {
                let place = self.matrix.places()[b] as usize;
                self.matrix.diagonal[place] += self.hold;
                self.matrix.lower[self.slots[c] as usize] -= self.hold;
            }
        }
        let factorised = self.matrix.factorise(true);
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
                self.touching[c] && self.after[c] > self.target[c].min(0.0)
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
    fn come_to_rest(&mut self, model: &Model, state: &mut State) {
        for c in 0..self.active.len() {
            self.impulse[c] = self.impulse[c].max(0.0);
            self.plastic[c] = self.active[c] && self.target[c] == 0.0;
        }
        self.groups.rest(model, &[], &mut self.plastic, &self.touching, &mut state.v);
        for (c, contact) in model.contacts.iter().enumerate() {
            let [a, b] = model.sides[contact.joint as usize].map(|s| s as usize);
            self.after[c] = state.v[a] - state.v[b];
        }
    }
}
