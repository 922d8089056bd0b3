//! One step of an ESDIRK scheme (S1) and its filtered error estimate
//!
//!   (P1)  (I − τ f_y) e = h Σ_i (b_i − b̂_i) k_i
//!
//! (Hosea & Shampine 1996): without the filter the stiff parts, which the scheme damps, would govern the step.

use crate::case::Scheme;
use crate::dynamics::power;
use crate::excitation::Drive;
use crate::integrate::stage::{Factors, Failure, Stage};
use crate::integrate::tableau::{STAGES, Tableau, tableau};
use crate::model::Model;
use crate::state::{Power, State, Tangents};

/// Scratch of a step; nothing here outlives it but the tangents, which belong to the state.
#[derive(Debug, Clone)]
pub struct Step {
    tableau: Tableau,
    pub stage: Stage,
    tangents: Tangents,
    stage_v: Vec<Vec<f64>>,
    stage_a: Vec<Vec<f64>>,
    stage_power: [Power; STAGES],
    /// Of the stages after the first: that is the state's.
    stage_joint_power: Vec<Vec<f64>>,
    error_v: Vec<f64>,
    error_z: Vec<f64>,
    top_acceleration: f64,
    /// Displacement of the end of the step, with base and top.
    pub z: Vec<f64>,
}

/// Absolute tolerances of displacement [m] and velocity [m/s].
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    pub z: f64,
    pub v: f64,
}

/// Allowed error of the stage iteration as a fraction of the tolerance of the step.
const STAGE_ACCURACY: f64 = 0.02;
/// Step in which nothing moves, over the shortest time scale of the model.
const INSTANT: f64 = 1e-6;

impl Step {
    pub fn new(model: &Model, scheme: Scheme) -> Self {
        let n = model.unknowns();
        let tableau = tableau(scheme);
        let rows = |len: usize| vec![vec![0.0; len]; tableau.stages];
        Step {
            tableau,
            stage: Stage::new(model),
            tangents: Tangents::at_rest(model),
            stage_v: rows(n + 2),
            stage_a: rows(n),
            stage_power: Default::default(),
            stage_joint_power: vec![vec![0.0; model.joints.len()]; tableau.stages - 1],
            error_v: vec![0.0; n],
            error_z: vec![0.0; n],
            top_acceleration: 0.0,
            z: vec![0.0; n + 2],
        }
    }

    /// Power with which the error estimate grows with the step.
    pub fn error_order(&self) -> f64 {
        self.tableau.error_order
    }

    /// Makes the factors that a saved run had; false when they are not of this model.
    pub fn restore(&mut self, model: &Model, factors: &Factors) -> bool {
        self.stage.restore(model, &mut self.tangents, factors)
    }

    /// Tries a step of `h` from `state`, inside the smooth piece `drive` of the motion. Returns the
    /// error over the tolerance; the result stays in `self` until [`Step::accept`].
    pub fn attempt(
        &mut self,
        model: &Model,
        state: &State,
        drive: &Drive,
        h: f64,
        tolerance: Tolerance,
    ) -> Result<f64, Failure> {
        let n = model.unknowns();
        let tau = self.tableau.diagonal * h;
        self.stage_v[0].copy_from_slice(&state.v);
        self.stage_a[0].copy_from_slice(&state.a[..n]);
        self.stage_power[0] = state.power;
        self.tangents.copy_from(&state.tangents);
        for i in 1..self.tableau.stages {
            let t = state.t + self.tableau.c[i] * h;
            self.predict(state, i, h, n);
            let top = drive.top(t);
            let ground = drive.base_acceleration(t);
            self.stage.z[n + 1] = top.u - tau * top.v;
            self.stage.solution[n + 1] = top.v;
            self.top_acceleration = top.a;
            self.stage.solve(model, &mut self.tangents, tau, ground, STAGE_ACCURACY * tolerance.v)?;
            let (v, a) = (&mut self.stage_v[i], &mut self.stage_a[i]);
            v.copy_from_slice(&self.stage.solution);
            for k in 0..n {
                a[k] = (v[k] - self.stage.v[k]) / tau;
            }
            for k in 0..n + 2 {
                self.z[k] = self.stage.z[k] + tau * v[k];
            }
            self.stage_power[i] =
                power(model, &self.z, v, &self.tangents.mu, ground, &mut self.stage_joint_power[i - 1]);
        }
        Ok(self.error(model, h, tau, tolerance))
    }

    /// Finds which joints with set-valued laws that are at rest let go, and how much friction holds the others, by an
    /// implicit step too short for anything to move.
    pub fn let_go(&mut self, model: &Model, drive: &Drive, state: &mut State) {
        let n = model.unknowns();
        let tau = INSTANT / model.stiffest.sqrt();
        let largest = state.a[..n].iter().fold(0.0f64, |m, a| m.max(a.abs()));
        let (top, stage) = (drive.top(state.t), &mut self.stage);
        stage.z.copy_from_slice(&state.z);
        stage.v.copy_from_slice(&state.v);
        stage.solution[n + 1] = top.v + tau * top.a;
        self.tangents.copy_from(&state.tangents);
        let found = stage.solve(model, &mut self.tangents, tau, drive.base_acceleration(state.t), 1e-6 * tau * largest);
        // Not work of a step: a restored run, which is not settled anew, must count the same.
        (stage.iterations, stage.factorisations) = (0, 0);
        if found.is_ok() {
            state.tangents.mu.copy_from_slice(&self.tangents.mu);
            state.tangents.stuck.copy_from_slice(&self.tangents.stuck);
            state.tangents.velocity.copy_from_slice(&self.tangents.velocity);
            state.tangents.slope.copy_from_slice(&self.tangents.slope);
        }
    }

    fn predict(&mut self, state: &State, i: usize, h: f64, n: usize) {
        self.stage.z[..n].copy_from_slice(&state.z[..n]);
        self.stage.v[..n].copy_from_slice(&state.v[..n]);
        for j in 0..i {
            let weight = h * self.tableau.a[i][j];
            if weight != 0.0 {
                let (v, a) = (&self.stage_v[j], &self.stage_a[j]);
                for k in 0..n {
                    self.stage.z[k] += weight * v[k];
                    self.stage.v[k] += weight * a[k];
                }
            }
        }
    }

    /// (P1) with f_y from the last stage: (M + τC + τ²K) e_v = M r_v − τ K r_z, e_z = r_z + τ e_v.
    fn error(&mut self, model: &Model, h: f64, tau: f64, tolerance: Tolerance) -> f64 {
        let n = model.unknowns();
        self.error_v.fill(0.0);
        self.error_z.fill(0.0);
        for i in 0..self.tableau.stages {
            let weight = h * self.tableau.error[i];
            let (v, a) = (&self.stage_v[i], &self.stage_a[i]);
            for k in 0..n {
                self.error_v[k] += weight * a[k];
                self.error_z[k] += weight * v[k];
            }
        }
        for (e, m) in self.error_v.iter_mut().zip(&model.mass) {
            *e *= m;
        }
        for (e, (law, &[a, b])) in model.elastic.iter().zip(&model.sides).enumerate() {
            if self.tangents.closed[e] {
                let (a, b) = (a as usize, b as usize);
                let other = if b < n { self.error_z[b] } else { 0.0 };
                let f = tau * law.stiffness * (self.error_z[a] - other);
                self.error_v[a] -= f;
                if b < n {
                    self.error_v[b] += f;
                }
            }
        }
        self.stage.solve_linear(&mut self.error_v);
        let (mut worst, mut sum) = (0.0f64, 0.0);
        for (ev, ez) in self.error_v.iter().zip(&self.error_z) {
            let ez = ez + tau * ev;
            worst = worst.max(ev.abs() / tolerance.v).max(ez.abs() / tolerance.z);
            sum += ev + ez;
        }
        // A maximum passes over what is not a number, a sum does not.
        if sum.is_finite() { worst } else { f64::INFINITY }
    }

    /// Moves `state` to the end of the step that was attempted.
    pub fn accept(&mut self, model: &Model, state: &mut State, t: f64, h: f64) {
        let n = model.unknowns();
        let last = self.tableau.stages - 1;
        state.t = t;
        state.z.copy_from_slice(&self.z);
        state.v.copy_from_slice(&self.stage_v[last]);
        state.a[..n].copy_from_slice(&self.stage_a[last]);
        state.a[n + 1] = self.top_acceleration;
        self.stage.join(model, &self.tangents, &mut state.a);
        state.power = self.stage_power[last];
        for i in 0..=last {
            self.stage_power[i].accrue(h * self.tableau.b[i], &mut state.energies);
            let weight = h * self.tableau.b[i];
            if weight != 0.0 {
                let power = if i == 0 { &state.joint_power } else { &self.stage_joint_power[i - 1] };
                for (sum, p) in state.envelopes.joint_dissipation.iter_mut().zip(power) {
                    *sum += weight * p;
                }
            }
        }
        state.joint_power.copy_from_slice(&self.stage_joint_power[last - 1]);
        state.tangents.copy_from(&self.tangents);
    }
}
