//! One run in its lane: what [`Run`] decides between the steps, with the same operations.

use crate::integrate::stage::{Failure, MOST_ITERATIONS};
use crate::integrate::step::{BEGINNING, STAGE_ACCURACY, Tolerance};
use crate::integrate::tableau::STAGES;
use crate::lanes::account::{Account, POWER, Peaks, Powers};
use crate::lanes::work::{
    ACCELERATION, ACCURACY, ALPHA, AT, BAD_PIVOT, CORRECTION, DAMPING, DYNAMIC, ENGAGED, ERROR_SUM, ERROR_V, ERROR_Z,
    EXCESS, FLIPPED, GROUND, LARGEST_NORMAL, MU, NORMAL, NORMALS, SAVED, SCALE_V, SCALE_Z, SLIP, SLOPE, SLOPE_AT_REST,
    STAGE, STATIC, STEEP, STEP, STIFFNESS, SUM, TAU, VELOCITY, WEIGHTS, WIDTH_AT_REST, Work, Z,
};
use crate::run::{Keep, Plan, Run, Verdict};
use crate::state::Power;
use concio_law::account::{Energies, StopReason};
use concio_law::motion::Kinematics;

/// What a lane does after an iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Next {
    /// Another one.
    Iterate {
        /// A joint has opened or closed.
        flipped: bool,
    },
    /// The stage has converged.
    Stage,
    /// The step is too long.
    Shorter,
}

/// A run in a lane. Its state is in the rows; the arrays of `run` are brought up to date where they are read.
pub struct Lane<'m> {
    /// Number of the run.
    pub number: usize,
    run: Run<'m>,
    plan: Plan,
    tolerance: Tolerance,
    /// Stage of the step under way, from 1, and its iterations so far.
    pub stage: usize,
    iterations: usize,
    /// Work since the last accepted step.
    all_iterations: u64,
    factorisations: u64,
    factors_hold: bool,
    /// Whether something was not finite in the try that has just been given up.
    not_finite: bool,
    /// Why the run has stopped.
    pub stopped: Option<StopReason>,
    top: Kinematics,
    /// Base acceleration at the stages of the step under way.
    ground: [f64; STAGES],
    /// Energy account and powers at its end.
    energies: Energies,
    power: Power,
    /// Step that waits for its account [s], and where the tops are at its end [m].
    waiting: f64,
    top_at: f64,
    /// Whether an accepted step waits for its account.
    pub pending: bool,
}

impl<'m> Lane<'m> {
    pub fn new(number: usize, run: Run<'m>) -> Self {
        Lane {
            number,
            run,
            plan: Plan::default(),
            tolerance: Tolerance { z: 0.0, v: 0.0, energy: 0.0 },
            stage: 0,
            iterations: 0,
            all_iterations: 0,
            factorisations: 0,
            factors_hold: false,
            not_finite: false,
            stopped: None,
            top: Kinematics::default(),
            ground: [0.0; STAGES],
            energies: Energies::default(),
            power: Power::default(),
            waiting: 0.0,
            top_at: 0.0,
            pending: false,
        }
    }

    /// Share of the run that is done, from 0 to 1.
    pub fn share(&self) -> f64 {
        self.run.state.t / self.run.excitation.duration()
    }

    /// Writes system and state into lane `i`.
    pub fn load(&mut self, w: &mut Work, account: &mut Account, i: usize) {
        let system = self.run.system;
        for (m, &p) in system.mass.iter().zip(&w.topology.place) {
            w.mass.set(p as usize, i, *m);
        }
        for (e, law) in system.elastic.iter().enumerate() {
            w.joints.set(e, DAMPING, i, law.damping);
            w.stiffness.set(e, i, law.stiffness);
        }
        for (r, rub) in system.rubs.iter().enumerate() {
            let law = &rub.law;
            let constants = [
                rub.normal[0],
                law.static_ - law.dynamic,
                law.dynamic,
                law.slip_velocity,
                law.beta / law.slip_velocity,
                law.alpha,
                rub.largest_normal(),
            ];
            for (row, value) in [NORMAL, EXCESS, DYNAMIC, SLIP, STEEP, ALPHA, LARGEST_NORMAL].into_iter().zip(constants)
            {
                w.rubs.set(r, row, i, value);
            }
            w.searches.set(r, STATIC, i, law.static_);
            w.searches.set(r, WIDTH_AT_REST, i, law.slip_velocity / law.beta);
            w.searches.set(r, SLOPE_AT_REST, i, law.slope_at_rest());
            w.searches.set(r, NORMALS, i, rub.normal[0] + rub.normal[1]);
        }
        for (k, joint) in w.topology.one_sided.iter().enumerate() {
            w.one_sided.set(k, STIFFNESS, i, system.elastic[joint.joint as usize].stiffness);
        }
        self.forget_stages(w, i);
        self.load_state(w, account, i);
    }

    fn load_state(&mut self, w: &mut Work, account: &mut Account, i: usize) {
        let state = &mut self.run.state;
        for (k, &p) in w.topology.place.iter().enumerate() {
            w.state.set(p as usize, Z, i, state.z[k]);
            w.state.set(p as usize, VELOCITY, i, state.v[k]);
            w.state.set(p as usize, ACCELERATION, i, state.a[k]);
        }
        let t = &state.tangents;
        for rows in [&mut w.tangents, &mut w.saved] {
            for r in 0..t.mu.len() {
                rows.set(r, AT, i, t.velocity[r]);
                rows.set(r, MU, i, t.mu[r]);
                rows.set(r, SLOPE, i, t.slope[r]);
            }
        }
        for (e, law) in self.run.system.elastic.iter().enumerate() {
            w.joints.set(e, ENGAGED, i, if t.closed[e] { law.stiffness } else { 0.0 });
        }
        for (k, joint) in w.topology.one_sided.iter().enumerate() {
            w.one_sided.set(k, SAVED, i, w.joints.at(joint.joint as usize, ENGAGED, i));
        }
        for (e, power) in state.joint_power.iter().enumerate() {
            account.joints.set(e, POWER, i, *power);
        }
        account.load(i, &w.topology.place, &mut state.envelopes);
    }

    /// What is left in stages that have not been reached is multiplied by 0, and must be finite for that.
    fn forget_stages(&self, w: &mut Work, i: usize) {
        for stage in &mut w.stages {
            for k in 0..stage.len() {
                stage.set(k, VELOCITY, i, 0.0);
                stage.set(k, ACCELERATION, i, 0.0);
            }
        }
    }

    /// Brings displacements, velocities, accelerations and tangents of the run up to date.
    fn unload_state(&mut self, w: &Work, i: usize) {
        let state = &mut self.run.state;
        for (k, &p) in w.topology.place.iter().enumerate() {
            state.z[k] = w.state.at(p as usize, Z, i);
            state.v[k] = w.state.at(p as usize, VELOCITY, i);
            state.a[k] = w.state.at(p as usize, ACCELERATION, i);
        }
        let t = &mut state.tangents;
        for r in 0..t.mu.len() {
            t.velocity[r] = w.saved.at(r, AT, i);
            t.mu[r] = w.saved.at(r, MU, i);
            t.slope[r] = w.saved.at(r, SLOPE, i);
        }
        for (k, joint) in w.topology.one_sided.iter().enumerate() {
            t.closed[joint.joint as usize] = w.one_sided.at(k, SAVED, i) > 0.0;
        }
    }

    /// Starts a step from the state.
    pub fn begin_step(&mut self, w: &mut Work, i: usize) {
        self.plan = self.run.plan();
        self.begin_attempt(w, i);
    }

    /// Starts the next try of the step.
    pub fn begin_attempt(&mut self, w: &mut Work, i: usize) {
        self.run.size(&mut self.plan);
        self.tolerance = self.run.tolerance(self.plan.h);
        self.factors_hold = false;
        if std::mem::take(&mut self.not_finite) {
            self.forget_stages(w, i);
        }
        w.lane.set(STEP, i, self.plan.h);
        w.lane.set(TAU, i, w.tableau.diagonal * self.plan.h);
        w.lane.set(ACCURACY, i, STAGE_ACCURACY * self.tolerance.v);
        self.begin_stage(w, i, 1);
    }

    /// Starts a stage.
    pub fn begin_stage(&mut self, w: &mut Work, i: usize, stage: usize) {
        (self.stage, self.iterations) = (stage, 0);
        let h = self.plan.h;
        let tau = w.tableau.diagonal * h;
        let t = self.run.state.t + w.tableau.c[stage] * h;
        let top = self.run.drive.top(t);
        let n = w.topology.unknowns as usize;
        w.prediction.set(n + 1, Z, i, top.u - tau * top.v);
        w.prediction.set(n + 1, VELOCITY, i, top.v);
        self.top = top;
        self.ground[stage] = self.run.drive.base_acceleration(t);
        w.lane.set(GROUND, i, self.ground[stage]);
        w.lane.set(STAGE, i, stage as f64);
        for j in 0..w.tableau.stages {
            w.lane.set(WEIGHTS + j, i, if j < stage { h * w.tableau.a[stage][j] } else { 0.0 });
        }
    }

    /// What the iteration has come to.
    pub fn judge(&mut self, w: &Work, i: usize) -> Next {
        self.iterations += 1;
        self.all_iterations += 1;
        if !(self.factors_hold && w.topology.rubs.is_empty()) {
            self.factorisations += 1;
        }
        let flipped = w.lane.at(FLIPPED, i) > 0.0;
        self.factors_hold = !flipped;
        let failure = if w.lane.at(BAD_PIVOT, i) > 0.0 {
            Failure::TooLong
        } else if !w.lane.at(SUM, i).is_finite() {
            Failure::NotFinite
        } else if !flipped && w.lane.at(CORRECTION, i) <= w.lane.at(ACCURACY, i) {
            return Next::Stage;
        } else if self.iterations == MOST_ITERATIONS {
            Failure::TooLong
        } else {
            return Next::Iterate { flipped };
        };
        self.not_finite = failure == Failure::NotFinite;
        if let Verdict::Stop(reason) = self.run.judge(Err(failure), &mut self.plan) {
            self.stopped = Some(reason);
        }
        Next::Shorter
    }

    /// Whether the step whose last stage has ended is accepted; how long the next try is follows.
    pub fn verdict(&mut self, w: &Work, powers: &Powers, i: usize) -> bool {
        let error = (w.lane.at(ERROR_V, i) / self.tolerance.v).max(w.lane.at(ERROR_Z, i) / self.tolerance.z);
        let error = if w.lane.at(ERROR_SUM, i).is_finite() { error } else { f64::INFINITY };
        self.not_finite = !error.is_finite();
        let unbalanced = self.balance(w, powers, i);
        let state = &self.run.state;
        let known = state.totals.peak_input + state.energies.initial;
        let judged = self.energies.input().abs() <= BEGINNING * known && self.tolerance.energy > 0.0;
        let error = if judged { error.max(unbalanced.abs() / self.tolerance.energy) } else { error };
        match self.run.judge(Ok(error), &mut self.plan) {
            Verdict::Accept => true,
            Verdict::Repeat => false,
            Verdict::Stop(reason) => {
                self.stopped = Some(reason);
                false
            }
        }
    }

    /// The energy account at the end of the step; returns what the step adds to its residual [J].
    fn balance(&mut self, w: &Work, powers: &Powers, i: usize) -> f64 {
        let (h, state) = (self.plan.h, &self.run.state);
        (self.energies, self.power) = (state.energies, state.power);
        self.power.accrue(h * w.tableau.b[0], &mut self.energies);
        for stage in 1..w.tableau.stages {
            self.power = Power {
                base: powers.momentum[stage][i] * self.ground[stage],
                top: powers.top[stage][i],
                damping: powers.damping[stage][i],
                friction: powers.friction[stage][i],
                device: 0.0,
                nonreciprocal: 0.0,
            };
            self.power.accrue(h * w.tableau.b[stage], &mut self.energies);
        }
        (self.energies.kinetic, self.energies.elastic) = (powers.kinetic[i], powers.elastic[i]);
        self.energies.residual() - state.energies.residual()
    }

    /// The run at the end of its step, whose envelopes wait.
    pub fn accept(&mut self, w: &mut Work, account: &mut Account, i: usize) {
        w.state.set(w.topology.unknowns as usize + 1, ACCELERATION, i, self.top.a);
        let Run { system, state, work, .. } = &mut self.run;
        (work.start_energies, work.stage_power[0]) = (state.energies, state.power);
        (state.energies, state.power) = (self.energies, self.power);
        state.t = self.plan.end(state.t);
        state.scale[0] = state.scale[0].max(w.lane.at(SCALE_Z, i));
        state.scale[1] = state.scale[1].max(w.lane.at(SCALE_V, i));
        state.counters.steps += 1;
        state.counters.iterations += std::mem::take(&mut self.all_iterations);
        state.counters.factorisations += std::mem::take(&mut self.factorisations);
        state.totals.peak_input = state.totals.peak_input.max(state.energies.input().abs());
        state.totals.peak_work = state.totals.peak_work.max(state.energies.works());
        state.totals.peak_residual = state.totals.peak_residual.max(state.energies.residual().abs());
        let place = &w.topology.place;
        let z = |k: usize| w.state.at(place[k] as usize, Z, i);
        self.top_at = system.tops.of_wall(z);
        let span = [state.t - self.plan.h, state.t];
        system.tops.follow(&mut state.leans, span, system.settles, z);
        (self.waiting, self.pending) = (self.plan.h, true);
        account.step[i] = self.plan.h;
    }

    /// Keeps the samples inside the accepted step.
    pub fn sample_inside(&mut self, w: &Work, i: usize, keep: &mut dyn Keep) {
        let t = self.run.state.t;
        if !self.run.samples_inside(t) {
            return;
        }
        self.unload_state(w, i);
        let step = &mut self.run.work;
        for (k, &p) in w.topology.place.iter().take(w.topology.unknowns as usize).enumerate() {
            let p = p as usize;
            step.start_z[k] = w.start.at(p, Z, i);
            (step.stage_v[0][k], step.stage_a[0][k]) = (w.start.at(p, VELOCITY, i), w.start.at(p, ACCELERATION, i));
            for (j, stage) in w.stages.iter().enumerate().skip(1) {
                (step.stage_v[j][k], step.stage_a[j][k]) = (stage.at(p, VELOCITY, i), stage.at(p, ACCELERATION, i));
            }
        }
        self.run.samples_before(t, self.plan.h, keep);
    }

    /// Where the run has arrived: the jump of the base's velocity if the rates start anew, and whether the run ends.
    pub fn arrives(&mut self) -> (Option<f64>, bool) {
        let t = self.run.state.t;
        let ends = t >= self.run.excitation.duration();
        let restarts = if self.plan.meets_break() && !ends { self.run.turn_piece(t) } else { None };
        (restarts, ends)
    }

    /// Takes up a jump of the motion.
    pub fn restart(&mut self, w: &mut Work, account: &mut Account, i: usize, jump: f64, keep: &mut dyn Keep) {
        self.unload_state(w, i);
        account.unload(i, &w.topology.place, &mut self.run.state.envelopes);
        self.run.restart(jump, keep);
        self.load_state(w, account, i);
    }

    /// Keeps the sample that is due at the end of the step, if there is one.
    pub fn sample(&mut self, w: &Work, i: usize, keep: &mut dyn Keep) {
        if self.run.sample_is_due() {
            self.unload_state(w, i);
            self.run.sample(keep);
        }
    }

    /// The peaks of the step that waited.
    pub fn enter_account(&mut self, peaks: &Peaks, i: usize) {
        self.pending = false;
        let pull = peaks.pull[i];
        let before = std::mem::replace(&mut self.run.state.pull, pull);
        let sum = &mut self.run.state.totals;
        sum.peak_relative_displacement = sum.peak_relative_displacement.max(peaks.displacement[i]);
        sum.peak_slip_velocity = sum.peak_slip_velocity.max(peaks.slip_velocity[i]);
        sum.minimum_gap = sum.minimum_gap.min(-peaks.closing[i]);
        sum.peak_friction_force = sum.peak_friction_force.max(peaks.friction[i]);
        sum.top_force_peak = sum.top_force_peak.max(pull.abs());
        sum.top_force_square += 0.5 * self.waiting * (before * before + pull * pull);
        self.run.state.raise_base_shear(peaks.base_shear[i].abs(), self.top_at);
    }

    /// The run at the end of a step whose account is made up.
    pub fn leave(mut self, w: &Work, account: &Account, i: usize) -> Run<'m> {
        self.unload_state(w, i);
        let state = &mut self.run.state;
        account.unload(i, &w.topology.place, &mut state.envelopes);
        for (e, power) in state.joint_power.iter_mut().enumerate() {
            *power = account.joints.at(e, POWER, i);
        }
        self.run
    }

    /// The run where it ends, of whose motion nothing more is asked.
    pub fn end(mut self, w: &Work, account: &Account, i: usize) -> Run<'m> {
        account.unload(i, &w.topology.place, &mut self.run.state.envelopes);
        self.run
    }
}
