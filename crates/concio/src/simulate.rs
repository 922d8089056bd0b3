//! The only time loop.
//!
//! [`Simulation::advance`] takes steps until its budget is spent, its record buffer is full or the run ends; it
//! does no I/O and allocates nothing. The caller empties the buffer, shows progress, saves the state.

use crate::case::Solver;
use crate::dynamics::{Channels, accelerate, kick, observe, settle};
use crate::error::Result;
use crate::excitation::Drive;
use crate::integrate::stage::{Factors, Failure};
use crate::integrate::step::{Step, Tolerance};
use crate::model::Model;
use crate::outcome::Outcome;
use crate::record::{Layout, Recording, StopReason};
use crate::run::Status;
use crate::state::State;

/// Shortest step as a fraction of the shortest time scale 1/ω; below it the tolerance cannot be held.
const SHORTEST: f64 = 1e-9;
/// Samples that the record buffer holds.
const BUFFER: usize = 256;

/// A run under way.
#[derive(Debug, Clone)]
pub struct Simulation<'m> {
    model: &'m Model,
    solver: Solver,
    channels: Channels,
    layout: Layout,
    state: State,
    work: Step,
    recording: Recording,
    /// The smooth piece of the motion in which the state lies; follows from the time.
    drive: Drive,
    longest_step: f64,
}

/// What [`Simulation::advance`] came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Progress {
    /// Steps remain; empty the buffer and go on.
    Running,
    /// The run has ended.
    Ended(StopReason),
}

/// How a run samples, from the wall file's `[output]` with its defaults resolved.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampling {
    /// Interval of the samples [s].
    pub interval: f64,
    /// Samples from one frame to the next; 0 for no frames.
    pub frame_every: usize,
    /// Blocks whose histories are kept.
    pub blocks: Vec<String>,
    /// Joints whose histories are kept.
    pub joints: Vec<String>,
}

impl<'m> Simulation<'m> {
    /// A run from rest at t = 0.
    ///
    /// # Errors
    /// Names in `sampling` that no block or joint bears.
    pub fn new(model: &'m Model, solver: &Solver, sampling: &Sampling) -> Result<Self> {
        let (channels, list) = Channels::new(model, &sampling.blocks, &sampling.joints)?;
        let duration = model.excitation.duration;
        let layout = Layout {
            interval: sampling.interval,
            samples: (duration / sampling.interval * (1.0 + 1e-12) + 1e-9).floor() as usize + 1,
            frame_every: sampling.frame_every,
            unknowns: model.unknowns(),
            held: if model.sticks() { model.joints.len() } else { 0 },
            channels: list,
        };
        let mut state = State::at_rest(model);
        let drive = model.excitation.drive(0.0);
        kick(model, &mut state, model.excitation.base_velocity_jump(0.0));
        let mut work = Step::new(model, solver.scheme);
        settle_all(model, &drive, &mut work, &mut state);
        state.step = (0.01 / model.stiffest.sqrt()).min(duration);
        if !state.step.is_finite() {
            state.step = duration;
        }
        begin_account(model, &mut state);
        let frames = if layout.frame_every > 0 { BUFFER.div_ceil(layout.frame_every) } else { 0 };
        let recording = Recording::with_room(&layout, BUFFER, frames);
        let longest_step = solver.max_step.map_or(f64::INFINITY, |h| h.si()).min(model.excitation.longest_step());
        let mut run =
            Simulation { model, solver: *solver, channels, layout, state, work, recording, drive, longest_step };
        run.sample();
        Ok(run)
    }

    /// Says whether the names in `sampling` are those of blocks and joints.
    ///
    /// # Errors
    /// A name that no block or joint bears.
    pub fn check(model: &Model, sampling: &Sampling) -> Result<()> {
        Channels::new(model, &sampling.blocks, &sampling.joints).map(|_| ())
    }

    /// Starts from displacements and velocities relative to the base instead of rest; before the first step.
    /// `z` and `v` have one value per unknown.
    pub fn start_from(&mut self, z: &[f64], v: &[f64]) {
        let n = self.model.unknowns();
        self.state.z[..n].copy_from_slice(z);
        self.state.v[..n].copy_from_slice(v);
        self.settle();
        begin_account(self.model, &mut self.state);
        self.state.samples = 0;
        self.clear_recording();
        self.sample();
    }

    /// Makes what follows from displacements and velocities consistent with the motion at this instant.
    fn settle(&mut self) {
        settle_all(self.model, &self.drive, &mut self.work, &mut self.state);
    }

    /// Takes at most `steps` steps, fewer when the buffer is full or the run ends.
    pub fn advance(&mut self, steps: u64) -> Progress {
        let end = self.model.excitation.duration;
        for _ in 0..steps {
            if self.state.t >= end {
                return Progress::Ended(StopReason::Completed);
            }
            if self.buffer_is_full() {
                return Progress::Running;
            }
            if let Err(reason) = self.step() {
                return Progress::Ended(reason);
            }
        }
        if self.state.t >= end { Progress::Ended(StopReason::Completed) } else { Progress::Running }
    }

    /// One accepted step, to the next break of the motion or sample at the farthest.
    fn step(&mut self) -> std::result::Result<(), StopReason> {
        let break_at = self.drive.end;
        // A sample that falls on a break but for rounding is taken there.
        let at_break = self.next_sample() >= break_at - self.slack();
        let target = if at_break { break_at } else { self.next_sample() };
        let shortest = SHORTEST / self.model.stiffest.sqrt().max(1.0);
        let mut proposed = self.state.step;
        loop {
            let remaining = target - self.state.t;
            let mut h = proposed.min(self.longest_step);
            let lands = h >= remaining * (1.0 - 1e-9);
            if lands {
                h = remaining;
            } else if h > 0.5 * remaining {
                h = 0.5 * remaining;
            }
            let tolerance = self.tolerance();
            let attempt = self.work.attempt(self.model, &self.state, &self.drive, h, tolerance);
            let factor = match attempt {
                Ok(error) if error <= 1.0 => {
                    let grow = growth(error, self.work.error_order()).min(5.0);
                    let free = h * grow;
                    // A step cut short by a landing says little about the one that the error allows.
                    self.state.step = if lands && proposed > h { free.max(proposed) } else { free };
                    self.accept(if lands { target } else { self.state.t + h }, h, at_break && lands);
                    return Ok(());
                }
                Ok(error) if error.is_finite() => {
                    self.state.counters.rejected += 1;
                    growth(error, self.work.error_order()).clamp(0.1, 0.8)
                }
                Err(Failure::TooLong) => {
                    self.state.counters.failed += 1;
                    0.4
                }
                Ok(_) | Err(Failure::NotFinite) => {
                    self.state.counters.failed += 1;
                    if h <= shortest {
                        return Err(StopReason::NotFinite);
                    }
                    0.25
                }
            };
            if h <= shortest {
                return Err(StopReason::StepTooShort);
            }
            proposed = h * factor;
        }
    }

    /// When the next sample is due [s]; +∞ after the last.
    fn next_sample(&self) -> f64 {
        if self.state.samples >= self.layout.samples as u64 {
            return f64::INFINITY;
        }
        (self.state.samples as f64 * self.layout.interval).min(self.model.excitation.duration)
    }

    /// Instants closer than this are one [s].
    fn slack(&self) -> f64 {
        1e-9 * self.layout.interval
    }

    fn tolerance(&self) -> Tolerance {
        let [z, v] = self.state.scale;
        let floor = self.solver.floor.si();
        Tolerance {
            z: self.solver.tolerance * z + floor,
            v: self.solver.tolerance * v + floor * self.model.stiffest.sqrt(),
        }
    }

    fn accept(&mut self, t: f64, h: f64, at_break: bool) {
        self.work.accept(self.model, &mut self.state, t, h);
        self.state.counters.steps += 1;
        self.state.counters.iterations += std::mem::take(&mut self.work.stage.iterations);
        self.state.counters.factorisations += std::mem::take(&mut self.work.stage.factorisations);
        observe(self.model, &mut self.state, h);
        if at_break && t < self.model.excitation.duration {
            self.enter_piece(t);
        }
        if t >= self.next_sample() - self.slack() {
            self.sample();
        }
    }

    /// Goes on into the piece of the motion that starts at `t`. Records only have kinks there; where acceleration or
    /// velocity jumps, the rates at the start of the next step are those after the jump.
    fn enter_piece(&mut self, t: f64) {
        let before = self.drive;
        self.drive = self.model.excitation.drive(t);
        let jump = self.model.excitation.base_velocity_jump(t);
        if jump != 0.0 {
            kick(self.model, &mut self.state, jump);
        }
        let (old, new) = (before.base_acceleration(t), self.drive.base_acceleration(t));
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs());
        if jump != 0.0 || !close(old, new) || !close(before.top(t).v, self.drive.top(t).v) {
            self.settle();
        }
    }

    fn sample(&mut self) {
        let (state, recording) = (&mut self.state, &mut self.recording);
        recording.time.push(state.samples as f64 * self.layout.interval);
        self.channels.sample(self.model, &self.drive, state, &mut recording.values);
        if self.layout.frame_every > 0 && state.samples.is_multiple_of(self.layout.frame_every as u64) {
            let n = self.layout.unknowns;
            recording.frame_time.push(state.samples as f64 * self.layout.interval);
            recording.frame_displacement.extend_from_slice(&state.z[..n]);
            recording.frame_velocity.extend_from_slice(&state.v[..n]);
            recording.frame_acceleration.extend_from_slice(&state.a[..n]);
            if self.layout.held > 0 {
                let from = recording.frame_friction.len();
                recording.frame_friction.resize(from + self.layout.held, 0.0);
                for (rub, mu) in self.model.rubs.iter().zip(&state.tangents.mu) {
                    recording.frame_friction[from + rub.joint as usize] = rub.normal[0] * mu;
                }
            }
        }
        state.samples += 1;
    }

    /// Whether [`Simulation::advance`] waits for the buffer to be emptied.
    pub fn buffer_is_full(&self) -> bool {
        self.recording.time.len() >= BUFFER
    }
    /// How far the run is.
    pub fn status(&self) -> Status {
        Status { time: self.state.t, duration: self.model.excitation.duration, steps: self.state.counters.steps }
    }
    /// Samples since the buffer was last cleared.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }
    /// Empties the buffer, keeping its memory.
    pub fn clear_recording(&mut self) {
        self.recording.clear();
    }
    /// What is kept.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }
    /// The state after the last accepted step.
    pub fn state(&self) -> &State {
        &self.state
    }
    /// Time reached [s].
    pub fn time(&self) -> f64 {
        self.state.t
    }

    /// The state as bytes, from which [`Simulation::restore`] continues with the same bits. The record buffer is
    /// not part of it: empty it first.
    pub fn save(&self) -> Vec<u8> {
        // Plain vectors of numbers into memory: nothing that could fail.
        postcard::to_stdvec(&(&self.state, self.work.stage.factors())).unwrap_or_default()
    }
    /// Goes back to a saved state; false when the bytes are not one of this model's.
    pub fn restore(&mut self, bytes: &[u8]) -> bool {
        let Ok((state, factors)) = postcard::from_bytes::<(State, Factors)>(bytes) else { return false };
        if !state.fits(self.model) || !self.work.restore(self.model, &factors) {
            return false;
        }
        self.drive = self.model.excitation.drive(state.t);
        self.state = state;
        self.clear_recording();
        true
    }

    /// Runs to the end in memory: all rows, and why it ended.
    pub fn run_to_end(&mut self) -> (Recording, StopReason) {
        let mut rows = Recording::default();
        loop {
            let progress = self.advance(u64::MAX);
            rows.append(&self.recording);
            self.clear_recording();
            if let Progress::Ended(reason) = progress {
                return (rows, reason);
            }
        }
    }

    /// The result, with the recording that the caller collected.
    pub fn outcome(self, recording: Recording, stop_reason: StopReason) -> Outcome {
        Outcome {
            layout: self.layout,
            recording,
            time_reached: self.state.t,
            energies: self.state.energies,
            envelopes: self.state.envelopes,
            totals: self.state.totals,
            counters: self.state.counters,
            stop_reason,
        }
    }
}

/// [`settle`], and which of the joints at rest let go under the forces of this instant.
fn settle_all(model: &Model, drive: &Drive, work: &mut Step, state: &mut State) {
    settle(model, drive, state);
    if model.sticks() {
        work.let_go(model, drive, state);
        accelerate(model, drive, state);
        work.stage.join(model, &state.tangents, &mut state.a);
    }
}

/// Starts envelopes and energy account from the state as it is: what energy it has is no residual.
fn begin_account(model: &Model, state: &mut State) {
    observe(model, state, 0.0);
    state.energies.initial = state.energies.kinetic + state.energies.elastic - state.energies.input();
    state.totals.peak_residual = 0.0;
}

/// Step factor 0.9 (1/error)^(1/order).
fn growth(error: f64, order: f64) -> f64 {
    if error <= 0.0 { 5.0 } else { 0.9 * error.powf(-1.0 / order) }
}
