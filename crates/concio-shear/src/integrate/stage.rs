//! One implicit stage: find the velocities V of
//!
//!   (T1)  M (V − V_p) + τ Σ_j B_j f_j(δ_p + τ w_j, w_j) = −τ M a_0(t),   w = Bᵀ V,   τ = γ h
//!
//! with z = z_p + τ V, so that only velocities are unknown. Newton's method on the joints' tangents, with two
//! departures that (6) and (3) need:
//!
//! * Where the tangent of (6) misses the law by much, the next tangent is not taken at the new velocity w but where
//!   the law meets the line through the new point (w, f) of slope −Z, Z being the impedance τ⁻¹(1/J_aa + 1/J_bb)⁻¹
//!   that the joint sees with its neighbours held. On the steep branch this follows the force, on the flat one the
//!   velocity, as limiting does for diodes in circuit simulators; plain Newton cycles between the two (theory,
//!   section 6).
//! * Unilateral joints keep an active set; a joint whose state changes makes another iteration.
//!
//! Rigid joints that touch: `stage/contacts.rs`.
//!
//! The iteration ends when the correction that the remaining force mismatch would cause, through the last factors, is
//! below the tolerance; that correction is still applied.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use pulp::{Arch, Simd, WithSimd};

use crate::integrate::bonds::Bonds;
use crate::integrate::devices::Devices;
use crate::integrate::flips::Flips;
use crate::integrate::groups::Groups;
use crate::integrate::joints::{Contacts, FAR, Joints, MEETING, MOST_SEARCHED, Rubs};
use crate::integrate::linear::{Factoring, MOST_LISTED, Matrix};
use crate::integrate::sums::Sums;
use crate::state::{DeviceState, Tangents};
use crate::system::System;
use concio_law::bond::BondState;
use concio_law::friction::Stribeck;

mod contacts;
mod large;
mod parts;

pub use large::Kept;
use large::Wear;
pub use parts::{Part, Parts};

/// Iterations after which a stage is given up and the step shortened. Of the stages that converge, 99 in 100 take
/// fewer than eight.
pub const MOST_ITERATIONS: usize = 8;
/// The same where joints stick truly or are rigid: those that hang together let go one after the other, however short
/// the step.
const MOST_WITH_HELD: usize = 60;
/// Iterations after which rigid joints open or close one at a time, by least index.
const AT_ONCE: usize = 8;
/// Stiffness that holds a sticking joint while its friction is sought, over the impedance that it sees: each iteration
/// leaves about the inverse of it of the velocity.
const HOLD: f64 = 1e6;
/// Velocity that a sticking joint may be left with before it is set to rest, as a fraction of the accuracy.
pub const STILL: f64 = 1e-3;
/// Speed that is none [m/s]: below it a set-valued law in slip has no slope of its own.
const AT_REST: f64 = 1e-150;
/// Unknowns for which few flips are followed through the factors: smaller matrices are factorised as fast, in larger
/// walls too many joints change at a time, and those whose factors lead a search flip in it.
const FOLLOWED: std::ops::RangeInclusive<usize> = MOST_LISTED + 1..=20_000;
/// Unknowns up to which matrices are factorised whenever they change.
const FACTORISED: usize = 4_000;
/// Friction by which a sticking joint may exceed μ_s, as a fraction of it: what holds it is known to about this.
const EXCESS: f64 = 1e-7;

/// Scratch of the stage. Unknowns are numbered by their place in the elimination order, base and top last; only
/// `z`, `v` and `solution` are in the order of the system.
#[derive(Debug, Clone)]
pub struct Stage {
    arch: Arch,
    pub matrix: Matrix,
    joints: Joints,
    rubs: Rubs,
    /// Sums over all joints and over those that rub, and room for what is summed.
    of_joints: Sums,
    of_rubs: Sums,
    parts: Vec<[f64; 2]>,
    bonds: Bonds,
    pub devices: Devices,
    contacts: Contacts,
    mass: Vec<f64>,
    /// z_p and V_p, with base and top at the end.
    pub z: Vec<f64>,
    pub v: Vec<f64>,
    /// V.
    pub solution: Vec<f64>,
    /// Diagonal and lower triangle of M + τ Σ B (c + τ k) Bᵀ for `tau` and the active set `closed`.
    diagonal: Vec<f64>,
    lower: Vec<f64>,
    tau: f64,
    closed: Vec<bool>,
    /// Whether the factors hold for `tau` and `closed`, no joint rubbing.
    factors_hold: bool,
    /// Of large walls alone, see `large`: how the factors have served, if there are any.
    wear: Option<Wear>,
    /// Whether the last try of a step was solved: only then do its factors serve on.
    pub solved: bool,
    /// Acceleration that a stage begins with, in the order of the system [m/s²].
    pub guess: Vec<f64>,
    /// V_p by place [m/s].
    speed: Vec<f64>,
    /// Room for the right side b or for x.
    trial: Vec<f64>,
    /// Work that a stage's impulses out of balance may do [J].
    pub work: f64,
    /// Right side without friction, with and for V_p.
    load: Vec<f64>,
    /// V − V_p, and the correction, with base and top at the end.
    change: Vec<f64>,
    rhs: Vec<f64>,
    /// δ_p + τ w_p and w_p of all joints.
    predicted: Vec<[f64; 2]>,
    /// δ_p + τ w_p of the one-sided joints.
    gap: Vec<f64>,
    /// w_p and w of the joints that rub, and the law at w.
    before: Vec<f64>,
    velocity: Vec<f64>,
    mu: Vec<f64>,
    slope: Vec<f64>,
    /// Slope that holds the joints with set-valued laws, [`HOLD`] times the largest impedance.
    hold: f64,
    /// Whether a rigid joint may close: it touched when the step began.
    pub eligible: Vec<bool>,
    /// The same for this stage: it still touches, or is closed.
    touching: Vec<bool>,
    /// Slope that holds closed rigid joints [N s/m]; w_p and w of all rigid joints.
    clamp: f64,
    parting: Vec<f64>,
    closing: Vec<f64>,
    /// Largest |w| that a closed rigid joint was left with before it was set to rest [m/s].
    pub contact_residual: f64,
    groups: Groups,
    /// Joints whose state is no longer that of the factors.
    flips: Flips,
    /// Counts.
    pub iterations: u64,
    pub factorisations: u64,
}

/// Why a stage was given up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// No convergence, or a pivot that is not positive: the step is too long.
    TooLong,
    /// A value that is not finite.
    NotFinite,
}

/// [`Stage::iterate`] as an operation that is compiled for several sets of instructions.
struct Iteration<'a> {
    stage: &'a mut Stage,
    system: &'a System,
    tangents: &'a mut Tangents,
    tau: f64,
    ground: f64,
    accuracy: f64,
}

impl WithSimd for Iteration<'_> {
    type Output = Result<(), Failure>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Iteration { stage, system, tangents, tau, ground, accuracy } = self;
        if stage.matrix.is_led() {
            stage.iterate_large(system, tangents, tau, ground, accuracy)
        } else {
            stage.iterate(system, tangents, tau, ground, accuracy)
        }
    }
}

/// [`Matrix::solve`] likewise, with what has changed since.
struct Linear<'a> {
    matrix: &'a mut Matrix,
    flips: &'a Flips,
    b: &'a mut [f64],
}

impl WithSimd for Linear<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let n = self.b.len() - 2;
        if self.matrix.is_led() {
            self.matrix.solve_roughly(&mut self.b[..n]);
            return;
        }
        self.matrix.solve(&mut self.b[..n]);
        self.flips.correct(self.b);
    }
}

impl Stage {
    /// Scratch for `system`.
    pub fn new(system: &System) -> Self {
        let n = system.unknowns();
        let coupled = |s: &&[u32; 2]| (s[1] as usize) < n;
        let pairs: Vec<(usize, usize)> =
            system.sides.iter().filter(coupled).map(|s| (s[0] as usize, s[1] as usize)).collect();
        let (matrix, slots) = Matrix::new(n, &pairs, &system.centres, factoring(system));
        let joints = Joints::new(system, matrix.places(), &slots);
        let rubs = Rubs::new(system, &joints);
        let contacts = Contacts::new(system, &joints);
        let mut mass = vec![0.0; n];
        for (m, &place) in system.mass.iter().zip(matrix.places()) {
            mass[place as usize] = *m;
        }
        let led = matrix.is_led();
        let (fill, zeros) = (matrix.lower.len(), |len: usize| vec![0.0; len]);
        Stage {
            arch: Arch::new(),
            of_joints: Sums::new(n, &joints.sides),
            of_rubs: Sums::new(n, &rubs.sides),
            parts: vec![[0.0; 2]; joints.sides.len()],
            z: zeros(n + 2),
            v: zeros(n + 2),
            solution: zeros(n + 2),
            diagonal: zeros(n),
            lower: zeros(fill),
            tau: 0.0,
            closed: vec![false; system.sides.len()],
            load: zeros(n + 2),
            change: zeros(n + 2),
            rhs: zeros(n + 2),
            predicted: vec![[0.0; 2]; joints.sides.len()],
            gap: zeros(joints.one_sided.len()),
            before: zeros(rubs.len()),
            velocity: zeros(rubs.len()),
            mu: zeros(rubs.len()),
            slope: zeros(rubs.len()),
            hold: 0.0,
            eligible: vec![false; contacts.len()],
            touching: vec![false; contacts.len()],
            clamp: 0.0,
            parting: zeros(contacts.len()),
            closing: zeros(contacts.len()),
            contact_residual: 0.0,
            groups: Groups::new(if contacts.len() > 0 || !rubs.sticking.is_empty() { n } else { 0 }),
            flips: Flips::new(if !led && FOLLOWED.contains(&n) && system.bonds.is_empty() { n } else { 0 }),
            factors_hold: false,
            wear: None,
            solved: false,
            guess: zeros(if led { n } else { 0 }),
            speed: zeros(if led { n } else { 0 }),
            trial: zeros(if led { n + 2 } else { 0 }),
            work: f64::INFINITY,
            iterations: 0,
            factorisations: 0,
            matrix,
            joints,
            rubs,
            bonds: Bonds::new(system),
            devices: Devices::new(system),
            contacts,
            mass,
        }
    }

    /// Starts a step: forgets the factors, because what it does must not depend on what was tried before it, and takes
    /// over the damage of the bonds and the state of the devices.
    pub fn begin(&mut self, system: &System, bonds: &[BondState], devices: &[DeviceState]) {
        self.tau = 0.0;
        self.begin_try();
        self.devices.hold(devices);
        self.bonds.hold(system, bonds, &mut self.joints, &mut self.rubs);
    }

    /// Part of a joint that rubs, 0 … 1, by the place of its friction.
    pub fn rubbing(&self, r: usize) -> f64 {
        self.rubs.part(r)
    }

    /// Visits the tangent stiffness of every bond [N/m] with the joint's index; closed head joints are left out.
    pub fn bond_tangents(&self, closed: &[bool], add: impl FnMut(usize, f64)) {
        self.bonds.tangents(closed, add);
    }

    /// Solves (T1) for τ = `tau` [s] and base acceleration `ground` [m/s²]; `accuracy` [m/s] is the error of V that
    /// is allowed. `self.z`, `self.v` hold z_p and V_p, `self.solution` the top's velocity in its last place (and
    /// z_p there is u_1 − τ u̇_1, so that z = z_p + τ V holds for all).
    pub fn solve(
        &mut self,
        system: &System,
        tangents: &mut Tangents,
        tau: f64,
        ground: f64,
        accuracy: f64,
    ) -> Result<(), Failure> {
        // The instructions of the machine at hand: wider vectors, the same operations and so the same bits.
        self.arch.dispatch(Iteration { stage: self, system, tangents, tau, ground, accuracy })
    }

    #[inline(always)]
    fn iterate(
        &mut self,
        system: &System,
        tangents: &mut Tangents,
        tau: f64,
        ground: f64,
        accuracy: f64,
    ) -> Result<(), Failure> {
        let n = self.mass.len();
        self.v[n + 1] = self.solution[n + 1];
        if self.tau != tau || self.closed != tangents.closed {
            self.tau = tau;
            self.assemble_elastic(system, tangents);
        }
        self.start(system, tangents);
        self.load_elastic(system, ground);
        let held = self.contacts.len() > 0 || !self.rubs.sticking.is_empty();
        let most = if held { MOST_WITH_HELD } else { MOST_ITERATIONS };
        for iteration in 0..most {
            self.iterations += 1;
            self.assemble(system, tangents)?;
            self.right_side(tangents);
            self.matrix.solve(&mut self.change[..n]);
            if self.flip_and_follow(tangents, accuracy) {
                self.mismatch(system, tangents);
            } else {
                let correction = self.correction(system, tangents)?;
                let settled = self.settled(system, tangents, accuracy) && self.contacts_settled(tangents, accuracy);
                if settled && correction <= accuracy {
                    self.finish(system, tangents);
                    return Ok(());
                }
            }
            if self.closed != tangents.closed {
                self.assemble_elastic(system, tangents);
                self.load_elastic(system, ground);
            }
            self.move_tangents(system, tangents);
            self.move_contacts(tangents, accuracy, iteration >= AT_ONCE);
        }
        Err(Failure::TooLong)
    }

    /// The correction that the mismatch causes into `rhs`, and its largest velocity.
    #[inline(always)]
    fn correction(&mut self, system: &System, tangents: &Tangents) -> Result<f64, Failure> {
        let n = self.mass.len();
        self.mismatch(system, tangents);
        self.matrix.solve(&mut self.rhs[..n]);
        self.flips.correct(&mut self.rhs);
        // A sum, because a maximum would pass over what is not a number.
        let (mut correction, mut sum) = (0.0f64, 0.0);
        for d in &self.rhs[..n] {
            correction = correction.max(d.abs());
            sum += d.abs();
        }
        if sum.is_finite() { Ok(correction) } else { Err(Failure::NotFinite) }
    }

    /// Three arrays of the unknowns, base and top, that hold nothing between two stages.
    pub fn idle(&mut self) -> [&mut Vec<f64>; 3] {
        [&mut self.load, &mut self.change, &mut self.rhs]
    }

    /// Solves with the last factors; `b` in the order of the system.
    pub fn solve_linear(&mut self, b: &mut [f64]) {
        let n = self.mass.len();
        for (value, &place) in b.iter().zip(self.matrix.places()) {
            self.rhs[place as usize] = *value;
        }
        self.rhs[n..].fill(0.0);
        self.arch.dispatch(Linear { matrix: &mut self.matrix, flips: &self.flips, b: &mut self.rhs });
        for (value, &place) in b.iter_mut().zip(self.matrix.places()) {
            *value = self.rhs[place as usize];
        }
    }

    /// Diagonal and lower triangle without friction.
    #[inline(always)]
    fn assemble_elastic(&mut self, system: &System, tangents: &Tangents) {
        self.factors_hold = false;
        self.closed.copy_from_slice(&tangents.closed);
        self.diagonal.copy_from_slice(&self.mass);
        self.lower.fill(0.0);
        let (j, tau) = (&self.joints, self.tau);
        let (diagonal, lower) = (&mut self.diagonal[..], &mut self.lower[..]);
        let laws = system.elastic.iter().zip(&j.stiffness).zip(&self.closed);
        for ((part, slot), ((law, stiffness), &closed)) in self.parts.iter_mut().zip(&j.slot).zip(laws) {
            let stiffness = if closed { *stiffness } else { 0.0 };
            let s = tau * (law.damping + tau * stiffness);
            *part = [s; 2];
            if let Some(slot) = slot.at() {
                lower[slot] -= s;
            }
        }
        self.of_joints.add(diagonal, &self.parts);
        self.bonds.open(&self.closed, |e, stiffness| {
            let ([a, b], s) = (j.sides[e], tau * tau * stiffness);
            diagonal[a as usize] += s;
            if let Some(slot) = j.slot[e].at() {
                diagonal[b as usize] += s;
                lower[slot] -= s;
            }
        });
    }

    /// Relative displacements and velocities of the prediction.
    #[inline(always)]
    fn start(&mut self, system: &System, tangents: &mut Tangents) {
        // One slope for all: joints side by side then bear equal parts of what each can bear.
        self.hold = HOLD * self.rubs.sticking.iter().fold(0.0f64, |m, &r| m.max(self.impedance(r as usize)));
        for &r in &self.rubs.sticking {
            let r = r as usize;
            if tangents.stuck[r] {
                tangents.slope[r] = self.hold;
                tangents.velocity[r] = 0.0;
            }
        }
        let (z, v, tau) = (&self.z, &self.v, self.tau);
        if self.bonds.start(system, &mut self.rubs, [z, v], tau) {
            self.factors_hold = false;
        }
        if self.devices.start(system, [z, v], tau) {
            self.factors_hold = false;
        }
        for (predicted, sides) in self.predicted.iter_mut().zip(&system.sides) {
            let [a, b] = sides.map(|s| s as usize);
            let w = v[a] - v[b];
            *predicted = [z[a] - z[b] + tau * w, w];
        }
        for (gap, &e) in self.gap.iter_mut().zip(&self.joints.one_sided) {
            *gap = self.predicted[e as usize][0];
        }
        for (before, &e) in self.before.iter_mut().zip(&self.rubs.joint) {
            *before = self.predicted[e as usize][1];
        }
        self.start_contacts(tangents);
    }

    /// −τ (M a_0 + Σ B (c w_p + k (δ_p + τ w_p))).
    #[inline(always)]
    fn load_elastic(&mut self, system: &System, ground: f64) {
        let n = self.mass.len();
        let tau = self.tau;
        for (load, m) in self.load[..n].iter_mut().zip(&self.mass) {
            *load = -tau * m * ground;
        }
        let j = &self.joints;
        let laws = system.elastic.iter().zip(&j.stiffness).zip(&self.closed);
        for ((part, [d, w]), ((law, stiffness), &closed)) in self.parts.iter_mut().zip(&self.predicted).zip(laws) {
            let elastic = if closed { stiffness * d } else { 0.0 };
            let f = tau * (law.damping * w + elastic);
            *part = [-f, f];
        }
        self.of_joints.add(&mut self.load[..n], &self.parts);
        let load = &mut self.load[..];
        self.bonds.open(&self.closed, |e, stiffness| {
            let ([a, b], [d, _]) = (j.sides[e], self.predicted[e]);
            let f = tau * stiffness * d;
            load[a as usize] -= f;
            load[b as usize] += f;
        });
    }

    /// J = M + τ Σ B (c + τ k + N μ') Bᵀ, factorised.
    #[inline(always)]
    fn assemble(&mut self, system: &System, tangents: &Tangents) -> Result<(), Failure> {
        self.flips.clear();
        if self.factors_hold && self.rubs.len() == 0 && self.contacts.len() == 0 {
            return Ok(());
        }
        self.make(system, tangents);
        self.factorise()
    }

    #[inline(always)]
    fn factorise(&mut self) -> Result<(), Failure> {
        self.factorisations += 1;
        self.factors_hold = false;
        self.matrix.factorise().map_err(|_| Failure::TooLong)?;
        self.factors_hold = true;
        Ok(())
    }

    /// J, not factorised.
    #[inline(always)]
    fn make(&mut self, system: &System, tangents: &Tangents) {
        self.matrix.diagonal.copy_from_slice(&self.diagonal);
        self.matrix.lower.copy_from_slice(&self.lower);
        let (j, matrix, tau, square) = (&self.joints, &mut self.matrix, self.tau, self.tau * self.tau);
        self.bonds.slopes(|e, slope| {
            let ([a, b], s) = (j.sides[e], square * slope);
            matrix.diagonal[a as usize] += s;
            if let Some(slot) = j.slot[e].at() {
                matrix.diagonal[b as usize] += s;
                matrix.lower[slot] -= s;
            }
        });
        self.devices.slopes(|e, slope| {
            let ([a, b], s) = (j.sides[e], tau * slope);
            matrix.diagonal[a as usize] += s;
            if let Some(slot) = j.slot[e].at() {
                matrix.diagonal[b as usize] += s;
                matrix.lower[slot] -= s;
            }
        });
        let rubs = &self.rubs;
        if system.reciprocal {
            let (diagonal, lower) = (&mut self.matrix.diagonal[..], &mut self.matrix.lower[..]);
            let parts = &mut self.parts[..rubs.len()];
            for (((part, slot), normal), slope) in
                parts.iter_mut().zip(&rubs.slot).zip(&rubs.normal).zip(&tangents.slope)
            {
                let s = self.tau * slope * normal[0];
                *part = [s; 2];
                if let Some(slot) = slot.at() {
                    lower[slot] -= s;
                }
            }
            self.of_rubs.add(diagonal, parts);
        } else {
            let matrix = &mut self.matrix;
            matrix.upper.copy_from_slice(&matrix.lower);
            for (r, &[a, b]) in rubs.sides.iter().enumerate() {
                let s = rubs.normal[r].map(|normal| self.tau * tangents.slope[r] * normal);
                self.matrix.diagonal[a as usize] += s[0];
                if let Some(slot) = rubs.slot[r].at() {
                    self.matrix.diagonal[b as usize] += s[1];
                    let (low, up) = if a > b { (s[0], s[1]) } else { (s[1], s[0]) };
                    self.matrix.lower[slot] -= low;
                    self.matrix.upper[slot] -= up;
                }
            }
        }
        self.assemble_contacts(system, tangents);
    }

    /// Right side of J (V − V_p) = …, with the tangents in place of (6), into `change`.
    #[inline(always)]
    fn right_side(&mut self, tangents: &Tangents) {
        self.change.copy_from_slice(&self.load);
        let (n, tau, rubs) = (self.mass.len(), self.tau, &self.rubs);
        let parts = &mut self.parts[..rubs.len()];
        let laws = tangents.mu.iter().zip(&tangents.slope).zip(&tangents.velocity).zip(&self.before);
        for ((part, normal), (((mu, slope), at), before)) in parts.iter_mut().zip(&rubs.normal).zip(laws) {
            let f = tau * (mu + slope * (before - at));
            *part = [-normal[0] * f, normal[1] * f];
        }
        self.of_rubs.add(&mut self.change[..n], parts);
        let change = &mut self.change[..];
        let j = &self.joints;
        self.bonds.forces(|e, force| {
            let [a, b] = j.sides[e];
            change[a as usize] -= tau * force;
            change[b as usize] += tau * force;
        });
        self.devices.forces(|e, force| {
            let [a, b] = j.sides[e];
            change[a as usize] -= tau * force;
            change[b as usize] += tau * force;
        });
        self.push_contacts(tangents);
        self.change[n..].fill(0.0);
    }

    /// Brings the active set up to date, and `change` as long as few joints change; true when it has to be sought anew.
    #[inline(always)]
    fn flip_and_follow(&mut self, tangents: &mut Tangents, accuracy: f64) -> bool {
        for _ in 0..MOST_ITERATIONS {
            if !self.flip(tangents, accuracy) {
                return false;
            }
            if !self.follow(tangents) {
                return true;
            }
            self.iterations += 1;
        }
        true
    }

    /// Brings `change` up to date with the active set, tangents as they are, through the factors that there are; false
    /// when too many joints have changed since.
    #[inline(always)]
    fn follow(&mut self, tangents: &Tangents) -> bool {
        if !self.flips.in_use() {
            return false;
        }
        let Stage { flips, matrix, joints, gap, closed, change, tau, .. } = self;
        let differ = |&(_, &e): &(usize, &u32)| tangents.closed[e as usize] != closed[e as usize];
        if !flips.have_room(joints.one_sided.iter().enumerate().filter(differ).map(|(i, _)| i)) {
            return false;
        }
        flips.begin(change);
        let turned = |e: usize, gap: f64| {
            let force = *tau * joints.stiffness[e];
            match (tangents.closed[e], closed[e]) {
                (true, false) => [*tau * force, -force * gap],
                (false, true) => [-*tau * force, force * gap],
                _ => [0.0; 2],
            }
        };
        flips.revise(|i| turned(joints.one_sided[i] as usize, gap[i]));
        for (i, &e) in joints.one_sided.iter().enumerate().filter(differ) {
            flips.add(i, joints.sides[e as usize], turned(e as usize, gap[i]), matrix);
        }
        flips.solution(change)
    }

    /// Brings the active set up to date; true when it changed. A joint whose force is too small to be felt stays as it
    /// is: at rest the sign of its gap is rounding, and would change for ever.
    #[inline(always)]
    fn flip(&mut self, tangents: &mut Tangents, accuracy: f64) -> bool {
        let mut flipped = false;
        for (gap, &e) in self.gap.iter().zip(&self.joints.one_sided) {
            let e = e as usize;
            let [a, b] = self.joints.sides[e].map(|s| s as usize);
            let d = gap + self.tau * (self.change[a] - self.change[b]);
            let felt = self.tau * self.joints.stiffness[e] * d.abs() > STILL * accuracy * self.mass[a];
            if felt && (d > 0.0) != tangents.closed[e] {
                flipped = true;
                tangents.closed[e] = d > 0.0;
            }
        }
        flipped
    }

    /// The laws at the new velocities, and τ Σ B N (μ − tangent) into `rhs`.
    #[inline(always)]
    fn mismatch(&mut self, system: &System, tangents: &Tangents) {
        self.bonds.look(system, &self.joints, &mut self.rubs, &self.change, self.tau);
        self.devices.look(&self.joints, &self.change);
        let (rubs, change, tau) = (&self.rubs, &self.change[..], self.tau);
        for ((&[a, b], before), w) in rubs.sides.iter().zip(&self.before).zip(&mut self.velocity) {
            *w = before + change[a as usize] - change[b as usize];
        }
        rubs.laws(&self.velocity, &mut self.mu, &mut self.slope);
        self.bonds.rub_more(&self.mu, &mut self.slope, tau);
        for ((w, before), &[a, b]) in self.closing.iter_mut().zip(&self.parting).zip(&self.contacts.sides) {
            *w = before + change[a as usize] - change[b as usize];
        }
        for &r in &rubs.sticking {
            let r = r as usize;
            if tangents.stuck[r] {
                // What holds it is not a function of velocity: the tangent is the law.
                self.mu[r] = tangents.mu[r] + tangents.slope[r] * self.velocity[r];
                self.slope[r] = tangents.slope[r];
            } else if self.velocity[r].abs() < AT_REST {
                // Meant to slip, at rest because others hold both sides: the steep foot of the law is none of its own.
                let (level, slope) = rubs.breaking_away(r);
                (self.mu[r], self.slope[r]) = (level.copysign(tangents.velocity[r]), slope);
            }
        }
        let (n, parts) = (self.mass.len(), &mut self.parts[..rubs.len()]);
        let laws = tangents.mu.iter().zip(&tangents.slope).zip(&tangents.velocity).zip(&self.velocity).zip(&self.mu);
        for ((part, normal), ((((drawn, slope), at), w), mu)) in parts.iter_mut().zip(&rubs.normal).zip(laws) {
            let missed = tau * (mu - (drawn + slope * (w - at)));
            *part = [normal[0] * missed, -normal[1] * missed];
        }
        let rhs = &mut self.rhs[..];
        rhs.fill(0.0);
        self.of_rubs.add(&mut rhs[..n], parts);
        let j = &self.joints;
        self.bonds.mismatch(|e, force| {
            let [a, b] = j.sides[e];
            rhs[a as usize] += tau * force;
            rhs[b as usize] -= tau * force;
        });
        self.devices.mismatch(|e, force| {
            let [a, b] = j.sides[e];
            rhs[a as usize] += tau * force;
            rhs[b as usize] -= tau * force;
        });
        self.rhs[n..].fill(0.0);
    }

    /// τ⁻¹(1/J_aa + 1/J_bb)⁻¹/N: change of μ over change of velocity, neighbours held. The joint's own tangent is not
    /// part of what it sees; its neighbours', whose falling slopes may outweigh the rest, are left out too.
    #[inline(always)]
    fn impedance(&self, r: usize) -> f64 {
        let [a, b] = self.rubs.sides[r].map(|s| s as usize);
        let [in_a, in_b] = self.rubs.normal[r];
        let free = self.diagonal[a].recip() + self.diagonal.get(b).map_or(0.0, |d| d.recip());
        1.0 / (self.tau * 0.5 * (in_a + in_b) * free)
    }

    /// Whether every joint with a set-valued law is where its tangent was drawn: at rest within μ_s, or slipping the
    /// way it was meant to.
    #[inline(always)]
    fn settled(&self, system: &System, tangents: &Tangents, accuracy: f64) -> bool {
        self.rubs.sticking.iter().all(|&r| {
            let r = r as usize;
            let (w, most) = (self.velocity[r], self.rubs.most(system, r));
            if tangents.stuck[r] {
                self.mu[r].abs() <= most * (1.0 + EXCESS) && w.abs() <= STILL * accuracy
            } else {
                // A joint whose bond is whole does not rub whichever way it moves.
                most == 0.0 || w * tangents.velocity[r].signum() >= -STILL * accuracy
            }
        })
    }

    /// Puts a set-valued law where it meets the line of slope −Z through the last point: at rest, or in slip.
    #[inline(always)]
    fn place(&self, law: &Stribeck, r: usize, tangents: &mut Tangents) {
        let w = self.velocity[r];
        let target = tangents.mu[r] + tangents.slope[r] * (w - tangents.velocity[r]);
        if !tangents.stuck[r] && w * tangents.velocity[r] > 0.0 {
            // Slipping on: Newton's tangent.
            (tangents.velocity[r], tangents.mu[r], tangents.slope[r]) = (w, self.mu[r], self.slope[r]);
            return;
        }
        let impedance = self.impedance(r);
        let c = if tangents.stuck[r] { target } else { target + impedance * w };
        tangents.stuck[r] = law.static_ > 0.0 && c.abs() <= law.static_ * (1.0 + EXCESS);
        if tangents.stuck[r] {
            (tangents.velocity[r], tangents.mu[r], tangents.slope[r]) = (0.0, c, self.hold);
            return;
        }
        let mut speed = 0.0;
        for _ in 0..3 {
            speed = (c.abs() - law.in_slip(speed).0) / impedance;
        }
        let speed = speed.max(f64::MIN_POSITIVE);
        let (level, slope) = law.in_slip(speed);
        (tangents.velocity[r], tangents.mu[r], tangents.slope[r]) = (speed.copysign(c), level.copysign(c), slope);
    }

    /// Applies the last correction and leaves the tangents at the solution.
    #[inline(always)]
    fn finish(&mut self, system: &System, tangents: &mut Tangents) {
        for (change, d) in self.change.iter_mut().zip(&self.rhs) {
            *change -= d;
        }
        for (i, &place) in self.matrix.places().iter().enumerate() {
            self.solution[i] = self.v[i] + self.change[place as usize];
        }
        let (change, laws) = (&self.change[..], self.mu.iter().zip(&self.slope).zip(&self.velocity));
        let tangent = tangents.mu.iter_mut().zip(&mut tangents.velocity);
        let joints = self.rubs.sides.iter().zip(&self.before);
        for ((&[a, b], before), ((mu, velocity), ((drawn, slope), at))) in joints.zip(tangent.zip(laws)) {
            let w = before + change[a as usize] - change[b as usize];
            *mu = drawn + slope * (w - at);
            *velocity = w;
        }
        tangents.slope.copy_from_slice(&self.slope);
        self.devices.finish(&self.joints, &self.change);
        self.finish_contacts(tangents);
        if !self.rubs.sticking.is_empty() || self.contacts.len() > 0 {
            self.rest(system, tangents);
        }
    }

    #[inline(always)]
    fn move_tangents(&mut self, system: &System, tangents: &mut Tangents) {
        if self.bonds.move_tangents() {
            self.factors_hold = false;
        }
        if self.devices.move_tangents(&self.joints, &self.diagonal, self.tau) {
            self.factors_hold = false;
        }
        let mut room = NO_FRICTION;
        for r in 0..self.rubs.len() {
            let w = self.velocity[r];
            let old = tangents.slope[r];
            let target = tangents.mu[r] + old * (w - tangents.velocity[r]);
            let (mut at, mut mu, mut slope) = (w, self.mu[r], self.slope[r]);
            let law = self.rubs.law(system, r, &mut room);
            if law.sticks() {
                self.place(law, r, tangents);
                continue;
            }
            if (mu - target).abs() > FAR * law.static_ {
                let impedance = self.impedance(r);
                (at, mu, slope) = meet(law, impedance, target + impedance * w);
            }
            tangents.velocity[r] = at;
            tangents.mu[r] = mu;
            tangents.slope[r] = slope;
        }
    }
}

/// Factors lead a search in large walls whose joints are springs, dashpots and friction that is a function of velocity; where
/// joints are held, cracked or bridged by devices with laws of their own, matrices differ by too much.
fn factoring(system: &System) -> Factoring {
    let smooth = !system.set_valued() && system.bonds.is_empty() && system.nonlinear.is_empty();
    match system.reciprocal {
        false => Factoring::Unsymmetric,
        true if smooth && system.unknowns() > FACTORISED => Factoring::Led,
        true => Factoring::Symmetric,
    }
}

/// Where a law is put together.
const NO_FRICTION: Stribeck = Stribeck { static_: 0.0, dynamic: 0.0, slip_velocity: 1.0, beta: 1.0, alpha: 0.0 };

/// Velocity at which μ(v) + z v = c, and the law there with its slope: safeguarded Newton inside the bracket [0, c/z].
/// Two digits are enough, it is only where the next tangent is drawn.
fn meet(law: &Stribeck, z: f64, c: f64) -> (f64, f64, f64) {
    let (sign, c) = (c.signum(), c.abs());
    let (mut low, mut high) = (0.0, c / z);
    if c == 0.0 || !high.is_finite() {
        return (0.0, 0.0, law.slope_at_rest());
    }
    let width = law.slip_velocity / law.beta;
    // Start on the branch that the right side points to: the inverse of the arctangent (to a tenth), or the velocity.
    let ratio = c / law.static_;
    let mut v = if ratio < 0.95 {
        let square = ratio * ratio;
        width * ratio * (FRAC_PI_2 - (FRAC_PI_2 - 2.0 * FRAC_2_PI) * square) / (1.0 - square)
    } else {
        high
    };
    if !(v > low && v < high) {
        v = 0.5 * high;
    }
    let mut found = law.at(v);
    for _ in 0..MOST_SEARCHED {
        let (mu, slope) = found;
        let f = mu + z * v - c;
        if f.abs() <= MEETING * law.static_ {
            break;
        }
        if f < 0.0 {
            low = v;
        } else {
            high = v;
        }
        let next = v - f / (slope + z);
        // Bisect in the geometric mean: the law lives on scales from δ_v/β to metres per second.
        v = if next > low && next < high { next } else { (low.max(1e-3 * width) * high).sqrt().clamp(low, high) };
        found = law.at(v);
    }
    (sign * v, sign * found.0, found.1)
}
