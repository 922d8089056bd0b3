//! One step of an ESDIRK scheme (S1) and its filtered error estimate
//!
//!   (P1)  (I − τ f_y) e = h Σ_i (b_i − b̂_i) k_i
//!
//! (Hosea & Shampine 1996): without the filter the stiff parts, which the scheme damps, would govern the step. What
//! the step adds to the residual of the energy account is held too,
//!
//!   (P2)  |Δ(E_kin + E_el + E_diss − W_in)| ≤ 5·10⁻⁵ · tolerance · max |W_in|

use pulp::Arch;

use crate::dynamics::TOUCHING;
use crate::dynamics::devices;
use crate::dynamics::{Moving, power, stored_energy};
use crate::integrate::cracks;
use crate::integrate::dense::{hermite, weights};
use crate::integrate::impact::Impacts;
use crate::integrate::stage::{Failure, Stage};
use crate::integrate::tableau::{STAGES, Tableau, tableau};
use crate::law::Rub;
use crate::state::{DeviceState, Instant, Power, State, Tangents};
use crate::system::Scheme;
use crate::system::System;
use crate::wide::wide;
use concio_law::account::Energies;
use concio_law::bond::BondState;
use concio_law::motion::Drive;

/// Scratch of a step; nothing here outlives it but the tangents, which belong to the state.
#[derive(Debug, Clone)]
pub struct Step {
    arch: Arch,
    scheme: Scheme,
    tableau: Tableau,
    pub stage: Stage,
    pub impacts: Impacts,
    tangents: Tangents,
    pub stage_v: Vec<Vec<f64>>,
    pub stage_a: Vec<Vec<f64>>,
    pub stage_power: [Power; STAGES],
    /// Of the stages after the first: that is the state's.
    stage_joint_power: Vec<Vec<f64>>,
    top_acceleration: f64,
    /// Displacement, energy account and friction at the start of the accepted step.
    pub start_z: Vec<f64>,
    pub start_energies: Energies,
    /// The energy account at the end of the step.
    account: Energies,
    /// Friction and what rigid joints bear at the start, where laws are set-valued.
    start_mu: Vec<f64>,
    start_stuck: Vec<bool>,
    start_reaction: Vec<f64>,
    start_bonds: Vec<BondState>,
    start_devices: Vec<DeviceState>,
    /// Displacement of the end of the step, with base and top.
    pub z: Vec<f64>,
}

/// Absolute tolerances of displacement [m], velocity [m/s] and the step's part in the energy residual [J].
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    pub z: f64,
    pub v: f64,
    pub energy: f64,
}

/// A step that brings more than this times the work so far is the start of the motion: there is nothing yet to measure
/// its energy by.
pub const BEGINNING: f64 = 2.0;
/// Allowed error of the stage iteration as a fraction of the tolerance of the step.
pub const STAGE_ACCURACY: f64 = 0.02;
/// Part of the energy that a step may add to the residual which is left to what its stages leave out of balance, all together,
/// in large walls.
const UNBALANCED: f64 = 0.2;
/// Way of a joint in a step from one impact to the next below which it has not bounced [m].
const LOW: f64 = 10.0 * TOUCHING;
/// Part of a step that is left at most where a joint turned round in it.
const SHORTER: f64 = 0.9;
/// Time at whose end a joint is sought at rest, over that at which it comes to rest: the last stage finds it at rest up to 1.25.
const BEYOND_TURN: f64 = 1.01;
/// Part of a step below which what is left of a slide is not sought.
const SOONEST: f64 = 1e-3;
/// Step in which nothing moves, over the shortest time scale of the system.
const INSTANT: f64 = 1e-6;

/// `sum` += `weight` · `values`.
#[inline(always)]
fn add(sum: &mut [f64], weight: f64, values: &[f64]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += weight * value;
    }
}

impl Step {
    pub fn new(system: &System, scheme: Scheme) -> Self {
        let n = system.unknowns();
        let tableau = tableau(scheme);
        let rows = |len: usize| vec![vec![0.0; len]; tableau.stages];
        Step {
            arch: Arch::new(),
            scheme,
            tableau,
            stage: Stage::new(system),
            impacts: Impacts::new(system),
            tangents: Tangents::at_rest(system),
            stage_v: rows(n + 2),
            stage_a: rows(n),
            stage_power: Default::default(),
            stage_joint_power: vec![vec![0.0; system.sides.len()]; tableau.stages - 1],
            top_acceleration: 0.0,
            start_z: vec![0.0; n + 2],
            start_energies: Energies::default(),
            account: Energies::default(),
            start_mu: vec![0.0; if system.set_valued() { system.rubs.len() } else { 0 }],
            start_stuck: vec![false; if system.set_valued() { system.rubs.len() } else { 0 }],
            start_reaction: vec![0.0; system.contacts.len()],
            start_bonds: vec![BondState::INTACT; system.bonds.len()],
            start_devices: vec![DeviceState::default(); system.nonlinear.len()],
            z: vec![0.0; n + 2],
        }
    }

    /// Power with which the error estimate grows with the step.
    pub fn error_order(&self) -> f64 {
        self.tableau.error_order
    }

    /// Tries a step of `h` from `state`, inside the smooth piece `drive` of the motion. Returns the
    /// error over the tolerance; the result stays in `self` until [`Step::accept`].
    pub fn attempt(
        &mut self,
        system: &System,
        state: &State,
        drive: &Drive,
        h: f64,
        tolerance: Tolerance,
    ) -> Result<f64, Failure> {
        let n = system.unknowns();
        let tau = self.tableau.diagonal * h;
        self.stage_v[0].copy_from_slice(&state.v);
        self.stage_a[0].copy_from_slice(&state.a[..n]);
        self.stage_power[0] = state.power;
        self.tangents.copy_from(&state.tangents);
        self.stage.contact_residual = 0.0;
        self.stage.begin(system, &state.bonds, &state.devices);
        let known = state.totals.peak_input + state.energies.initial;
        let judged = known > 0.0 && tolerance.energy > 0.0;
        // An impulse p at a block of velocity v in stage i brings b_i/γ p v to the account.
        let implicit = &self.tableau.b[1..self.tableau.stages];
        let share = self.tableau.diagonal / implicit.iter().map(|b| b.abs()).sum::<f64>();
        self.stage.work = if judged { UNBALANCED * tolerance.energy * share } else { f64::INFINITY };
        self.find_touching(system, state);
        for i in 1..self.tableau.stages {
            let t = state.t + self.tableau.c[i] * h;
            self.predict(state, i, h, n);
            self.stage.devices.predict(i, h, &self.tableau.a[i]);
            let top = drive.top(t);
            let ground = drive.base_acceleration(t);
            self.stage.z[n + 1] = top.u - tau * top.v;
            self.stage.solution[n + 1] = top.v;
            self.top_acceleration = top.a;
            if !self.stage.guess.is_empty() {
                self.guess(i);
            }
            self.stage.solve(system, &mut self.tangents, tau, ground, STAGE_ACCURACY * tolerance.v)?;
            self.stage_v[i].copy_from_slice(&self.stage.solution);
            self.follow(i, tau);
            let devices = self.stage.devices.now();
            let at = Moving { z: &self.z, v: &self.stage_v[i], laws: &self.tangents, bonds: &state.bonds, devices };
            self.stage_power[i] = power(system, at, ground, &mut self.stage_joint_power[i - 1]);
        }
        let error = wide(
            self.arch,
            #[inline(always)]
            || self.error(system, h, tau, tolerance),
        );
        self.stage.solved = true;
        let unbalanced = self.account(system, state, h);
        let judged = self.account.input().abs() <= BEGINNING * known && tolerance.energy > 0.0;
        Ok(if judged { error.max(unbalanced.abs() / tolerance.energy) } else { error })
    }

    /// Which rigid joints touch as the step begins: these alone may close in it otherwise than by an impact.
    fn find_touching(&mut self, system: &System, state: &State) {
        for (touches, contact) in self.stage.eligible.iter_mut().zip(&system.contacts) {
            let [a, b] = system.sides[contact.joint as usize].map(|s| s as usize);
            *touches = state.z[a] - state.z[b] >= -TOUCHING;
        }
    }

    /// Says which joints touched when the last step, of `h` [s], began, and hardly left each other in it: they collide
    /// without bouncing. With h = 0 none.
    pub fn linger(&mut self, system: &System, state: &State, h: f64) {
        let joints = self.impacts.lingering.iter_mut().zip(&self.stage.eligible).zip(&system.contacts);
        for ((lingers, touched), contact) in joints {
            let [a, b] = system.sides[contact.joint as usize].map(|s| s as usize);
            *lingers = h > 0.0 && *touched && (state.v[a] - state.v[b]) * h <= LOW;
        }
    }

    /// Whether a joint lets go in the step that was attempted whose friction drops at once as it does.
    pub fn drops(&self, system: &System, state: &State) -> bool {
        let stuck = state.tangents.stuck.iter().zip(&self.tangents.stuck);
        let lets_go = |((before, after), rub): ((&bool, &bool), &Rub)| *before && !after && rub.law.drops();
        stuck.zip(&system.rubs).any(lets_go)
    }

    /// How long a step is at whose end the first of the joints comes to rest that turned round in the step of `h` [s] that was attempted, although friction at
    /// rest, above that of slip, may hold them there [s]; none below `shortest`. Stages beyond a turn know only of friction in slip.
    pub fn turn(&self, system: &System, state: &State, h: f64, shortest: f64) -> Option<f64> {
        let (n, v, a) = (system.unknowns(), self.v(), &self.stage_a[self.tableau.stages - 1]);
        let after = |i: usize| {
            if i < n {
                a[i]
            } else if i == n {
                0.0
            } else {
                self.top_acceleration
            }
        };
        let moved = |i: usize, force: f64| if i < n { force / system.mass[i] } else { 0.0 };
        let first = |(r, rub): (usize, &Rub)| {
            let [i, k] = system.sides[rub.joint as usize].map(|s| s as usize);
            let before = state.v[i] - state.v[k];
            if before * (v[i] - v[k]) >= 0.0 {
                return None;
            }
            // Held where the load is below μ_s N. The load is that at the end of the step and of sides that move freely: joints beside may turn too. So the
            // bound lies as far above μ_s as μ_d lies below.
            let friction = moved(i, rub.normal[0]) + moved(k, rub.normal[1]);
            let without = after(i) - after(k) + self.tangents.mu[r] * friction;
            let slows = state.a[k] - state.a[i];
            let rests = if slows * before > 0.0 { BEYOND_TURN * before / slows } else { 0.5 * h };
            let (part, law) = (self.stage.rubbing(r), &rub.law);
            let [held, most] = [law.static_, 2.0 * law.static_ - law.dynamic].map(|mu| part * mu * friction);
            // A slide that goes on may as well turn inside a step.
            let least = if without.abs() < held { shortest } else { shortest.max(SOONEST * h) };
            (without.abs() < most && rests > least).then_some(rests.min(SHORTER * h))
        };
        let slid = system.rubs.iter().enumerate().filter(|(r, rub)| rub.law.holds() && !state.tangents.stuck[*r]);
        slid.filter_map(first).reduce(f64::min)
    }

    /// Whether a joint came to rest in the accepted step whose friction at rest is above that of slip.
    pub fn rests(&self, system: &System, end: &State) -> bool {
        let stuck = self.start_stuck.iter().zip(&end.tangents.stuck).zip(&system.rubs);
        stuck.into_iter().any(|((before, after), rub)| *after && !before && rub.law.holds())
    }

    /// Velocity at the end of the step that was attempted, with base and top.
    pub fn v(&self) -> &[f64] {
        &self.stage_v[self.tableau.stages - 1]
    }

    /// Finds which joints with set-valued laws that are at rest let go, and how much friction holds the others, by an
    /// implicit step too short for anything to move.
    pub fn let_go(&mut self, system: &System, drive: &Drive, state: &mut State) {
        let n = system.unknowns();
        let tau = INSTANT / system.stiffest.sqrt();
        let largest = state.a[..n].iter().fold(0.0f64, |m, a| m.max(a.abs()));
        self.find_touching(system, state);
        let (top, stage) = (drive.top(state.t), &mut self.stage);
        stage.z.copy_from_slice(&state.z);
        stage.v.copy_from_slice(&state.v);
        stage.solution[n + 1] = top.v + tau * top.a;
        stage.begin(system, &state.bonds, &state.devices);
        self.tangents.copy_from(&state.tangents);
        let found =
            stage.solve(system, &mut self.tangents, tau, drive.base_acceleration(state.t), 1e-6 * tau * largest);
        // Not work of a step: a restored run, which is not settled anew, must count the same.
        (stage.iterations, stage.factorisations, stage.contact_residual) = (0, 0, 0.0);
        if found.is_ok() {
            state.tangents.mu.copy_from_slice(&self.tangents.mu);
            state.tangents.stuck.copy_from_slice(&self.tangents.stuck);
            state.tangents.velocity.copy_from_slice(&self.tangents.velocity);
            state.tangents.slope.copy_from_slice(&self.tangents.slope);
            state.tangents.contact.copy_from_slice(&self.tangents.contact);
            state.tangents.reaction.copy_from_slice(&self.tangents.reaction);
        }
    }

    /// Accelerations that stage `i` begins with: those of the two stages before, drawn on.
    fn guess(&mut self, i: usize) {
        let c = &self.tableau.c;
        let guess = &mut self.stage.guess;
        if i < 2 {
            let n = guess.len();
            guess.copy_from_slice(&self.stage_a[0][..n]);
            return;
        }
        let on = (c[i] - c[i - 1]) / (c[i - 1] - c[i - 2]);
        for ((g, a), b) in guess.iter_mut().zip(&self.stage_a[i - 1]).zip(&self.stage_a[i - 2]) {
            *g = a + on * (a - b);
        }
    }

    fn predict(&mut self, state: &State, i: usize, h: f64, n: usize) {
        let (z, v) = (&mut self.stage.z[..n], &mut self.stage.v[..n]);
        z.copy_from_slice(&state.z[..n]);
        v.copy_from_slice(&state.v[..n]);
        for j in 0..i {
            let weight = h * self.tableau.a[i][j];
            if weight != 0.0 {
                wide(
                    self.arch,
                    #[inline(always)]
                    || {
                        add(z, weight, &self.stage_v[j]);
                        add(v, weight, &self.stage_a[j]);
                    },
                );
            }
        }
    }

    /// Acceleration and displacement at stage `i` from its velocity.
    fn follow(&mut self, i: usize, tau: f64) {
        let (v, a, z, before) = (&self.stage_v[i], &mut self.stage_a[i], &mut self.z, &self.stage);
        wide(
            self.arch,
            #[inline(always)]
            || {
                for ((a, v), v_p) in a.iter_mut().zip(v).zip(&before.v) {
                    *a = (v - v_p) / tau;
                }
                for ((z, z_p), v) in z.iter_mut().zip(&before.z).zip(v) {
                    *z = z_p + tau * v;
                }
            },
        );
    }

    /// (P1) with f_y from the last stage: (M + τC + τ²K) e_v = M r_v − τ K r_z, e_z = r_z + τ e_v.
    #[inline(always)]
    fn error(&mut self, system: &System, h: f64, tau: f64, tolerance: Tolerance) -> f64 {
        let n = system.unknowns();
        // Room of the stage, given back below.
        let [load, change, _] = self.stage.idle();
        let (mut error_v, mut error_z) = (std::mem::take(load), std::mem::take(change));
        error_v.fill(0.0);
        error_z.fill(0.0);
        for i in 0..self.tableau.stages {
            let weight = h * self.tableau.error[i];
            add(&mut error_v, weight, &self.stage_a[i]);
            add(&mut error_z, weight, &self.stage_v[i]);
        }
        for (e, m) in error_v.iter_mut().zip(&system.mass) {
            *e *= m;
        }
        for (e, (law, &[a, b])) in system.elastic.iter().zip(&system.sides).enumerate() {
            if self.tangents.closed[e] {
                let (a, b) = (a as usize, b as usize);
                let other = if b < n { error_z[b] } else { 0.0 };
                let f = tau * law.stiffness * (error_z[a] - other);
                error_v[a] -= f;
                if b < n {
                    error_v[b] += f;
                }
            }
        }
        let closed = &self.tangents.closed;
        self.stage.bond_tangents(closed, |e, stiffness| {
            let [a, b] = system.sides[e].map(|s| s as usize);
            let beyond = stiffness - if closed[e] { system.elastic[e].stiffness } else { 0.0 };
            if beyond != 0.0 {
                let f = tau * beyond * (error_z[a] - if b < n { error_z[b] } else { 0.0 });
                error_v[a] -= f;
                if b < n {
                    error_v[b] += f;
                }
            }
        });
        self.stage.devices.errors(system, h, &self.tableau.error, &error_z[..n], |e, force| {
            let [a, b] = system.sides[e].map(|s| s as usize);
            error_v[a] -= tau * force;
            if b < n {
                error_v[b] += tau * force;
            }
        });
        self.stage.solve_linear(&mut error_v);
        let (mut worst, mut sum) = (0.0f64, 0.0);
        for (ev, ez) in error_v[..n].iter().zip(&error_z) {
            let ez = ez + tau * ev;
            worst = worst.max(ev.abs() / tolerance.v).max(ez.abs() / tolerance.z);
            sum += ev + ez;
        }
        let [load, change, _] = self.stage.idle();
        (*load, *change) = (error_v, error_z);
        // A maximum passes over what is not a number, a sum does not.
        if sum.is_finite() { worst } else { f64::INFINITY }
    }

    /// The energy account at the end of the step that was attempted; returns what the step adds to its residual [J].
    fn account(&mut self, system: &System, state: &State, h: f64) -> f64 {
        let last = self.tableau.stages - 1;
        self.account = state.energies;
        for i in 0..=last {
            self.stage_power[i].accrue(h * self.tableau.b[i], &mut self.account);
        }
        self.account.bond += cracks::spending(system, &state.bonds, &self.z);
        let (after, z, v) = (self.stage.devices.now(), &self.z, &self.stage_v[last]);
        devices::book(system, &state.devices, after, &mut self.account);
        stored_energy(system, &state.bonds, after, [z, v], &mut self.account);
        self.account.residual() - state.energies.residual()
    }

    /// Keeps what [`Step::inside`] needs of `state`, before anything of the accepted step happens to it.
    pub fn begin(&mut self, system: &System, state: &State) {
        self.start_z.copy_from_slice(&state.z);
        self.start_energies = state.energies;
        if system.set_valued() {
            self.start_mu.copy_from_slice(&state.tangents.mu);
            self.start_stuck.copy_from_slice(&state.tangents.stuck);
            self.start_reaction.copy_from_slice(&state.tangents.reaction);
        }
        self.start_bonds.copy_from_slice(&state.bonds);
        self.start_devices.copy_from_slice(&state.devices);
    }

    /// Moves `state` to the end of the step that was attempted.
    pub fn accept(&mut self, system: &System, state: &mut State, t: f64, h: f64) {
        let n = system.unknowns();
        let last = self.tableau.stages - 1;
        state.t = t;
        state.z.copy_from_slice(&self.z);
        state.v.copy_from_slice(&self.stage_v[last]);
        state.a[..n].copy_from_slice(&self.stage_a[last]);
        state.a[n + 1] = self.top_acceleration;
        self.stage.join(system, &self.tangents, &mut state.a);
        state.power = self.stage_power[last];
        // What cracking took is booked where bonds crack.
        state.energies = Energies { bond: state.energies.bond, ..self.account };
        for i in 0..=last {
            let weight = h * self.tableau.b[i];
            if weight != 0.0 {
                let power = if i == 0 { &state.joint_power } else { &self.stage_joint_power[i - 1] };
                for (sum, p) in state.envelopes.joint_dissipation.iter_mut().zip(power) {
                    *sum += weight * p;
                }
            }
        }
        state.joint_power.copy_from_slice(&self.stage_joint_power[last - 1]);
        let now = self.stage.devices.now();
        let lost = &mut state.envelopes.joint_dissipation;
        devices::spending(system, &state.devices, now, |e, spent| lost[e] += spent);
        state.devices.copy_from_slice(now);
        state.tangents.copy_from(&self.tangents);
    }

    /// Displacements and velocities at the start of the accepted step.
    pub fn start(&self) -> [&[f64]; 2] {
        [&self.start_z, &self.stage_v[0]]
    }

    /// Lends `at` room for a motion, or takes it back: scratch of the stage, idle between steps.
    pub fn lend(&mut self, at: &mut Instant) {
        let [z, v, a] = self.stage.idle();
        std::mem::swap(z, &mut at.z);
        std::mem::swap(v, &mut at.v);
        std::mem::swap(a, &mut at.a);
    }

    /// Motion, friction and energies at `t`, inside the accepted step of `h` that `end` is the end of.
    pub fn inside(&self, system: &System, drive: &Drive, end: &State, h: f64, t: f64, at: &mut Instant) {
        let (n, last) = (system.unknowns(), self.tableau.stages - 1);
        let x = 1.0 - (end.t - t) / h;
        let w = weights(self.scheme, &self.tableau.c, last, x, h);
        at.t = t;
        for k in 0..n {
            at.z[k] = self.start_z[k] + w.of_end * (end.z[k] - self.start_z[k]);
        }
        // The base; the room that was lent holds anything.
        at.z[n] = 0.0;
        at.v.fill(0.0);
        at.a.fill(0.0);
        for i in 0..=last {
            let (v, a) = (&self.stage_v[i], &self.stage_a[i]);
            for k in 0..n {
                at.z[k] += w.of_z[i] * v[k];
                at.v[k] += w.of_v[i] * v[k] + w.of_a[i] * a[k];
                at.a[k] += w.rate_v[i] * v[k] + w.rate_a[i] * a[k];
            }
        }
        let top = drive.top(t);
        (at.z[n + 1], at.v[n + 1], at.a[n + 1]) = (top.u, top.v, top.a);
        self.laws_inside(system, end, x, at);
        self.account_inside(end, h, x, at);
        at.energies.bond += cracks::spending(system, &self.start_bonds, &at.z);
        self.stage.devices.inside(system, &end.devices, [w.of_end, x], &w.of_z, &at.z, &mut at.devices);
        devices::book(system, &self.start_devices, &at.devices, &mut at.energies);
        stored_energy(system, &self.start_bonds, &at.devices, [&at.z, &at.v], &mut at.energies);
    }

    fn laws_inside(&self, system: &System, end: &State, x: f64, at: &mut Instant) {
        let mix = |from: f64, to: f64| from + x * (to - from);
        // First the part of each joint that rubs: of a bonded one what has cracked.
        at.mu.fill(1.0);
        at.bonds.copy_from_slice(&self.start_bonds);
        for (bond, held) in system.bonds.iter().zip(&mut at.bonds) {
            let [a, b] = system.sides[bond.joint as usize].map(|s| s as usize);
            let d = at.z[a] - at.z[b];
            held.damage = bond.law.damage_at(held.damage, d);
            held.reach = held.reach.max(bond.law.stretch(d));
            if let Some(r) = bond.rub {
                at.mu[r as usize] = bond.law.rubbing(held);
            }
        }
        for (r, rub) in system.rubs.iter().enumerate() {
            let [a, b] = system.sides[rub.joint as usize].map(|s| s as usize);
            at.mu[r] = if self.held(rub, r, end) {
                mix(self.start_mu[r], end.tangents.mu[r])
            } else {
                rub.law.times(at.mu[r]).value(at.v[a] - at.v[b])
            };
        }
        for (c, borne) in at.reaction.iter_mut().enumerate() {
            *borne = mix(self.start_reaction[c], end.tangents.reaction[c]);
        }
    }

    /// Whether a joint stuck all through the accepted step.
    fn held(&self, rub: &Rub, r: usize, end: &State) -> bool {
        rub.law.sticks() && self.start_stuck[r] && end.tangents.stuck[r]
    }

    /// The works so far: cubic in time, with the rates at both ends.
    fn account_inside(&self, end: &State, h: f64, x: f64, at: &mut Instant) {
        let [to_end, from, to] = hermite(x);
        let (e_0, e_1, p_0, p_1) = (&self.start_energies, &end.energies, &self.stage_power[0], &end.power);
        let cubic = |e: fn(&Energies) -> f64, p: fn(&Power) -> f64| {
            e(e_0) + to_end * (e(e_1) - e(e_0)) + h * (from * p(p_0) + to * p(p_1))
        };
        at.energies = Energies {
            input_base: cubic(|e| e.input_base, |p| p.base),
            input_top: cubic(|e| e.input_top, |p| p.top),
            damping: cubic(|e| e.damping, |p| p.damping),
            friction: cubic(|e| e.friction, |p| p.friction),
            device: cubic(|e| e.device, |p| p.device),
            nonreciprocal: cubic(|e| e.nonreciprocal, |p| p.nonreciprocal),
            ..*e_0
        };
    }
}
