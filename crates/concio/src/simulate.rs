//! The only time loop.
//!
//! [`Simulation::advance`] takes steps until its budget is spent, its record buffer is full or the run ends; it
//! does no I/O and allocates nothing, but for pairs of a planar wall that are looked up anew. The caller empties the buffer, shows progress, saves the state.

use crate::case::Solver;
use crate::channels::Channels;
use crate::dynamics::devices;
use crate::dynamics::{accelerate, book_impact, kick, observe, settle, stored_energy};
use crate::error::Result;
use crate::excitation::Drive;
use crate::integrate::cracks;
use crate::integrate::events;
use crate::integrate::impact::{COLLISIONS, Impacts};
use crate::integrate::stage::{self, Failure};
use crate::integrate::step::{Step, Tolerance};
use crate::model::Model;
use crate::outcome::Outcome;
use crate::planar_run;
use crate::record::{Event, EventKind, Layout, Recording, StopReason};
use crate::state::{Instant, State, View};

/// Shortest step as a fraction of the shortest time scale 1/ω; below it the tolerance cannot be held.
const SHORTEST: f64 = 1e-9;
/// What one step may add to the residual of the energy account, over the tolerance and the largest work so far. Chosen
/// so that the examples close within 10⁻⁴ at the default tolerance (decision 0003).
const ENERGY: f64 = 5e-5;
/// Most by which a step is longer than the one before: longer leaps fail more often than they save.
const MOST_GROWTH: f64 = 2.0;
/// The error of a step from a break of the motion grows with a power of its length that is lower by this than elsewhere:
/// 2.2 to 2.5 for 3, measured with TR-BDF2 in walls of 100,000 blocks.
const ROUGHER: f64 = 0.75;
/// Tolerance below which the energy is held no tighter: rounding, and the velocities that joints coming to rest lose.
const FINEST: f64 = 1e-4;
/// Steps shorter than this over the shortest time scale are not shortened further for the energy's sake: friction that
/// jumps loses what it loses.
const UNFELT: f64 = 1e-4;
/// By what joints that remember how far they went may miss it, over the tolerance of displacements.
const MEMORY: f64 = 0.1;
/// Samples in a step at most; the record buffer holds twice as many.
const WINDOW: usize = 128;
/// Events that it holds, beside as many as may happen at one instant.
const EVENTS: usize = 1024;
/// Closing velocity below which an impact is taken as plastic, over the tolerance of velocities: bounces that the
/// tolerance does not see come to an end.
const PLASTIC: f64 = 0.1;

/// A run under way.
#[derive(Debug, Clone)]
pub struct Simulation<'m> {
    pub(crate) model: &'m Model,
    pub(crate) solver: Solver,
    channels: Channels,
    layout: Layout,
    pub(crate) state: State,
    pub(crate) work: Step,
    recording: Recording,
    /// An instant inside a step, of which a sample is taken.
    instant: Instant,
    /// The smooth piece of the motion in which the state lies; follows from the time.
    pub(crate) drive: Drive,
    longest_step: f64,
    /// The bodies of a planar wall, whose steps are their own.
    planar: Option<Box<planar_run::Run>>,
}

/// A step under way: where it aims, and its present try.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Plan {
    /// Where the step ends at the latest [s]: a break of the motion or a frame.
    target: f64,
    /// Whether that is a break of the motion.
    to_break: bool,
    /// Step that the error control asks for [s].
    proposed: f64,
    /// Whether a try has been too long.
    shortened: bool,
    /// Step at whose end something happens [s].
    event: Option<f64>,
    /// Step of the present try [s], and whether it ends at `target`.
    pub h: f64,
    lands: bool,
}

impl Plan {
    /// Where the present try ends [s], from `t`.
    pub fn end(&self, t: f64) -> f64 {
        if self.lands { self.target } else { t + self.h }
    }
    /// Whether it ends at a break of the motion.
    pub fn meets_break(&self) -> bool {
        self.to_break && self.lands
    }
}

/// What becomes of a try.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// It is the step.
    Accept,
    /// A shorter one follows.
    Repeat,
    /// The run ends.
    Stop(StopReason),
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
        let turns = model.planar.is_some();
        let layout = Layout {
            interval: sampling.interval,
            samples: (duration / sampling.interval * (1.0 + 1e-12) + 1e-9).floor() as usize + 1,
            frame_every: sampling.frame_every,
            unknowns: model.unknowns(),
            turned: if turns { model.unknowns() } else { 0 },
            touching: if turns { model.joints.len() } else { 0 },
            held: if turns || model.sticks() || !model.bonds.is_empty() || !model.nonlinear.is_empty() {
                model.joints.len()
            } else {
                0
            },
            bonded: model.bonds.len(),
            channels: list,
        };
        let mut state = State::at_rest(model);
        let drive = model.excitation.drive(0.0);
        let longest = WINDOW as f64 * layout.interval;
        let planar = model.planar.as_ref().map(|planar| Box::new(planar_run::Run::new(model, planar, longest)));
        let mut work = Step::new(model, solver.scheme);
        if let Some(bodies) = &planar {
            bodies.begin(&mut state);
        } else {
            kick(model, &mut state, model.excitation.base_velocity_jump(0.0));
            settle_all(model, &drive, &mut work, &mut state);
            begin_account(model, &mut state);
        }
        state.step = (0.01 / model.stiffest.sqrt()).min(duration);
        if !state.step.is_finite() {
            state.step = duration;
        }
        let frames = if layout.frame_every > 0 { (2 * WINDOW).div_ceil(layout.frame_every) } else { 0 };
        let recording = Recording::with_room(&layout, 2 * WINDOW, frames, EVENTS + events::at_once(model));
        let longest_step = solver.max_step.map_or(f64::INFINITY, |h| h.si()).min(model.excitation.longest_step());
        let instant = Instant::new(model);
        let mut run = Simulation {
            model,
            solver: *solver,
            channels,
            layout,
            state,
            work,
            recording,
            instant,
            drive,
            longest_step,
            planar,
        };
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
        self.clear_recording();
        self.settle();
        if !self.model.bonds.is_empty() {
            // What is strained beyond its strength from the start is cracked from the start.
            let (z, v) = (self.state.z.clone(), self.state.v.clone());
            let heard = &mut self.recording.events;
            cracks::grow(self.model, &mut self.state, &z, &v, 0.0, |event| heard.push(event));
            self.settle();
        }
        begin_account(self.model, &mut self.state);
        self.state.samples = 0;
        self.sample();
    }

    /// Lets the impacts happen that are due at this instant, and makes what follows from displacements and velocities
    /// consistent with the motion.
    fn settle(&mut self) {
        if Impacts::due(self.model, &self.state) {
            let slow = PLASTIC * self.tolerance(0.0).v;
            let heard = &mut self.recording.events;
            collide(self.model, &mut self.work, &mut self.state, slow, |event| heard.push(event));
            self.state.counters.events += 1;
        }
        self.work.linger(self.model, &self.state, 0.0);
        settle_all(self.model, &self.drive, &mut self.work, &mut self.state);
    }

    /// Takes at most `steps` steps, fewer when the buffer is full or the run ends.
    pub fn advance(&mut self, steps: u64) -> Progress {
        for _ in 0..steps {
            if let Some(reason) = self.over() {
                return Progress::Ended(reason);
            }
            if self.buffer_is_full() {
                return Progress::Running;
            }
            if let Err(reason) = self.step() {
                return Progress::Ended(reason);
            }
        }
        self.over().map_or(Progress::Running, Progress::Ended)
    }

    /// Why the run goes no further, where it has come to its end. No step is shortened for an end after a collapse: until then the run
    /// has the bits of one that goes on.
    fn over(&self) -> Option<StopReason> {
        if self.state.t >= self.model.excitation.duration {
            return Some(StopReason::Completed);
        }
        let told = self.planar.as_ref()?.told_until();
        let after = self.model.planar.as_ref()?.after_collapse?;
        let collapse = self.state.totals.collapse?;
        (told >= collapse.time + after).then_some(StopReason::Collapsed)
    }

    /// One accepted step, to the next break of the motion or frame at the farthest.
    fn step(&mut self) -> std::result::Result<(), StopReason> {
        if self.planar.is_some() {
            return self.step_bodies();
        }
        let mut plan = self.plan();
        loop {
            self.size(&mut plan);
            let tolerance = self.tolerance(plan.h);
            let attempt = self.work.attempt(self.model, &self.state, &self.drive, plan.h, tolerance);
            if attempt.is_ok_and(|error| error <= 1.0) {
                let first =
                    events::first(self.model, &self.state, [&self.work.z, self.work.v()], plan.h, MEMORY * tolerance.z);
                if first.is_some() {
                    self.state.counters.located += 1;
                    plan.event = first;
                    continue;
                }
            }
            match self.judge(attempt, &mut plan) {
                Verdict::Accept => {
                    self.accept(plan.end(self.state.t), plan.h, plan.meets_break());
                    return Ok(());
                }
                Verdict::Repeat => {}
                Verdict::Stop(reason) => return Err(reason),
            }
        }
    }

    /// A step of a planar wall, and the samples of which all is known after it.
    fn step_bodies(&mut self) -> std::result::Result<(), StopReason> {
        let due = self.sample_time(self.state.samples);
        let Simulation { model, state, recording, planar: Some(bodies), .. } = self else { return Ok(()) };
        let heard = &mut recording.events;
        let from = heard.len();
        let stepped = bodies.step(model, state, due, |event| heard.push(event));
        Event::sort(&mut heard[from..]);
        let told = bodies.told_until();
        let ends = stepped.is_ok() && self.over() == Some(StopReason::Completed);
        let until = self.slack() + if ends { self.state.t } else { told };
        while self.sample_time(self.state.samples) <= until {
            self.sample();
        }
        stepped
    }

    /// Where the next step aims.
    pub(crate) fn plan(&self) -> Plan {
        let break_at = self.drive.end;
        let frame_at = self.sample_time(self.landing());
        // A sample that falls on a break but for rounding is taken there.
        let to_break = frame_at >= break_at - self.slack();
        let target = if to_break { break_at } else { frame_at };
        let State { t, step, step_from_break, from_break, .. } = self.state;
        let proposed = if from_break { step.min(step_from_break) } else { step };
        let event = events::near(self.model, &self.state, proposed.min(target - t));
        Plan { target, to_break, proposed, shortened: false, event, h: 0.0, lands: false }
    }

    /// Length of the next try.
    pub(crate) fn size(&self, plan: &mut Plan) {
        let remaining = plan.target - self.state.t;
        let mut h = plan.proposed.min(self.longest_step);
        let lands = h >= remaining * (1.0 - 1e-9);
        if lands {
            h = remaining;
        } else if h > 0.5 * remaining {
            h = 0.5 * remaining;
        }
        (plan.h, plan.lands) = plan.event.map_or((h, lands), |at| (at, false));
    }

    /// What becomes of a try with this error over the tolerance, and how long the next one is.
    pub(crate) fn judge(&mut self, attempt: std::result::Result<f64, Failure>, plan: &mut Plan) -> Verdict {
        let shortest = SHORTEST / self.model.stiffest.sqrt().max(1.0);
        let (h, order) = (plan.h, self.work.error_order());
        let factor = match attempt {
            Ok(error) if error <= 1.0 => {
                let state = &mut self.state;
                if state.from_break {
                    let reach = h * growth(error, order - ROUGHER);
                    state.step_from_break = if plan.shortened { reach } else { reach.max(h) };
                }
                state.from_break = plan.meets_break();
                let longer = h * growth(error, order).min(MOST_GROWTH);
                // What has just been too long is not tried again at once.
                let free = if plan.shortened { longer.min(h) } else { longer };
                // A step cut short by a landing says little about the one that the error allows.
                let cut = (plan.lands || plan.event.is_some()) && plan.proposed > h;
                state.step = if cut { free.max(plan.proposed) } else { free };
                return Verdict::Accept;
            }
            Ok(error) if error.is_finite() => {
                self.state.counters.rejected += 1;
                growth(error, if self.state.from_break { order - ROUGHER } else { order }).clamp(0.1, 0.8)
            }
            Err(Failure::TooLong) => {
                self.state.counters.failed += 1;
                0.4
            }
            Ok(_) | Err(Failure::NotFinite) => {
                self.state.counters.failed += 1;
                if h <= shortest {
                    return Verdict::Stop(StopReason::NotFinite);
                }
                0.25
            }
        };
        if h <= shortest {
            return Verdict::Stop(StopReason::StepTooShort);
        }
        plan.event = None;
        (plan.proposed, plan.shortened) = (h * factor, true);
        Verdict::Repeat
    }

    /// The next sample at which a step has to end: a frame, whose accelerations then obey (1), or for the buffer's sake.
    fn landing(&self) -> u64 {
        let every = |count: usize| self.state.samples.next_multiple_of(count.max(1) as u64);
        let frame = if self.layout.frame_every > 0 { every(self.layout.frame_every) } else { u64::MAX };
        every(WINDOW).min(frame)
    }

    /// When sample `k` is due [s]; +∞ after the last.
    fn sample_time(&self, k: u64) -> f64 {
        if k >= self.layout.samples as u64 {
            return f64::INFINITY;
        }
        (k as f64 * self.layout.interval).min(self.model.excitation.duration)
    }

    /// Instants closer than this are one [s].
    fn slack(&self) -> f64 {
        1e-9 * self.layout.interval
    }

    /// Of a step of `h` [s].
    pub(crate) fn tolerance(&self, h: f64) -> Tolerance {
        let [z, v] = self.state.scale;
        let work = self.state.totals.peak_input + self.state.energies.initial;
        let felt = h * self.model.stiffest.sqrt() > UNFELT;
        let floor = self.solver.floor.si();
        Tolerance {
            z: self.solver.tolerance * z + floor,
            v: self.solver.tolerance * v + floor * self.model.stiffest.sqrt(),
            energy: if felt { self.solver.tolerance.max(FINEST) * ENERGY * work } else { f64::INFINITY },
        }
    }

    fn accept(&mut self, t: f64, h: f64, at_break: bool) {
        self.work.begin(self.model, &self.state);
        let heard = &mut self.recording.events;
        let from = heard.len();
        let broke =
            cracks::grow(self.model, &mut self.state, &self.work.z, self.work.v(), h, |event| heard.push(event));
        Event::sort(&mut heard[from..]);
        self.work.accept(self.model, &mut self.state, t, h);
        self.state.counters.steps += 1;
        self.state.counters.iterations += std::mem::take(&mut self.work.stage.iterations);
        self.state.counters.factorisations += std::mem::take(&mut self.work.stage.factorisations);
        let residual = std::mem::take(&mut self.work.stage.contact_residual);
        self.state.totals.contact_residual = self.state.totals.contact_residual.max(residual);
        // Before anything of what happens at the end of the step.
        self.samples_before(t, h);
        if broke {
            self.settle();
        }
        observe(self.model, &mut self.state, h, self.work.start());
        self.happen(h);
        if at_break
            && t < self.model.excitation.duration
            && let Some(jump) = self.turn_piece(t)
        {
            self.restart(jump);
        }
        if self.sample_is_due() {
            self.sample();
        }
    }

    /// Whether the state's instant is that of the next sample.
    pub(crate) fn sample_is_due(&self) -> bool {
        self.sample_time(self.state.samples) <= self.state.t + self.slack()
    }

    /// Whether a sample lies inside the step that ended at `t`.
    pub(crate) fn samples_inside(&self, t: f64) -> bool {
        self.sample_time(self.state.samples) < t - self.slack()
    }

    /// Takes the samples that lie inside the step of `h` that ended at `t`.
    pub(crate) fn samples_before(&mut self, t: f64, h: f64) {
        let inside = |run: &Self| run.sample_time(run.state.samples) < t - run.slack();
        if !inside(self) {
            return;
        }
        self.work.lend(&mut self.instant);
        while inside(self) {
            let due = self.sample_time(self.state.samples);
            self.work.inside(self.model, &self.drive, &self.state, h, due, &mut self.instant);
            let Simulation { model, drive, channels, layout, state, recording, instant, .. } = self;
            keep(model, drive, channels, layout, instant.view(), state.samples, recording);
            state.samples += 1;
        }
        self.work.lend(&mut self.instant);
    }

    /// What a step of `h` that ended at an event leads to.
    fn happen(&mut self, h: f64) {
        if Impacts::due(self.model, &self.state) {
            self.work.linger(self.model, &self.state, h);
            self.settle();
            observe(self.model, &mut self.state, 0.0, self.work.start());
        }
    }

    /// Goes on into the piece of the motion that starts at `t`. Records only have kinks there; where acceleration or
    /// velocity jumps, the jump of the base's velocity [m/s], with which to call [`Simulation::restart`].
    pub(crate) fn turn_piece(&mut self, t: f64) -> Option<f64> {
        let before = self.drive;
        self.drive = self.model.excitation.drive(t);
        let jump = self.model.excitation.base_velocity_jump(t);
        let (old, new) = (before.base_acceleration(t), self.drive.base_acceleration(t));
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs());
        let smooth = jump == 0.0 && close(old, new) && close(before.top(t).v, self.drive.top(t).v);
        (!smooth).then_some(jump)
    }

    /// The rates at the start of the next step are those after a jump of the motion.
    pub(crate) fn restart(&mut self, jump: f64) {
        if jump != 0.0 {
            kick(self.model, &mut self.state, jump);
        }
        self.settle();
    }

    /// Takes the sample that is due at the state's own instant.
    pub(crate) fn sample(&mut self) {
        let at = self.sample_time(self.state.samples);
        let Simulation { model, drive, channels, layout, state, recording, planar, .. } = self;
        if let Some(bodies) = planar {
            bodies.sample(model, channels, layout, state, (state.samples, at), recording);
            state.samples += 1;
            return;
        }
        keep(model, drive, channels, layout, state.view(), state.samples, recording);
        state.samples += 1;
    }

    /// Whether [`Simulation::advance`] waits for the buffer to be emptied.
    pub fn buffer_is_full(&self) -> bool {
        self.recording.time.len() >= WINDOW || self.recording.events.len() >= EVENTS
    }
    /// How far the run is.
    pub fn status(&self) -> Status {
        let steps = self.state.counters.steps;
        Status { time: self.state.t, duration: self.model.excitation.duration, steps, resumed_from: None }
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
        let bodies = self.planar.as_ref().map(|bodies| bodies.keep());
        postcard::to_stdvec(&(&self.state, bodies, self.work.stage.keep())).unwrap_or_default()
    }
    /// Goes back to a saved state; false when the bytes are not one of this model's, and the simulation is then to be made anew.
    pub fn restore(&mut self, bytes: &[u8]) -> bool {
        let Ok((state, kept, factors)) =
            postcard::from_bytes::<(State, Option<planar_run::Kept>, Option<stage::Kept>)>(bytes)
        else {
            return false;
        };
        let bodies = match (&mut self.planar, kept) {
            (Some(bodies), Some(kept)) => bodies.take_up(kept),
            (None, None) => true,
            _ => false,
        };
        if !bodies || !state.fits(self.model) || !self.work.stage.take_up(factors) {
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
        let bonds = self.model.bonds.iter().zip(&self.state.bonds).map(|(bond, state)| bond.row(state)).collect();
        let mut envelopes = self.state.envelopes;
        // Runs without rigid joints count no impacts, results do.
        envelopes.joint_impulse.resize(self.model.joints.len(), 0.0);
        envelopes.joint_impacts.resize(self.model.joints.len(), 0.0);
        envelopes.drop_signs_of_zero();
        let settles = self.model.settles();
        // What was cut short had yet to come to rest, and rubble leans no more.
        let completes = stop_reason == StopReason::Completed && self.state.totals.collapse.is_none();
        let drifts = self.model.tops.rows(&self.state.leans, settles, self.state.t, completes);
        Outcome {
            bonds,
            drifts,
            ties: self.planar.map_or_else(Vec::new, |bodies| bodies.ties(self.model)),
            layout: self.layout,
            recording,
            time_reached: self.state.t,
            energies: self.state.energies,
            envelopes,
            totals: self.state.totals,
            counters: self.state.counters,
            stop_reason,
        }
    }
}

/// Appends sample `k`, and the frame if one is due.
fn keep(
    model: &Model,
    drive: &Drive,
    channels: &Channels,
    layout: &Layout,
    at: View,
    k: u64,
    recording: &mut Recording,
) {
    let t = k as f64 * layout.interval;
    recording.time.push(t);
    channels.sample(model, drive, at, &mut recording.values);
    if layout.frame_every == 0 || !k.is_multiple_of(layout.frame_every as u64) {
        return;
    }
    let n = layout.unknowns;
    recording.frame_time.push(t);
    recording.frame_displacement.extend_from_slice(&at.z[..n]);
    recording.frame_velocity.extend_from_slice(&at.v[..n]);
    recording.frame_acceleration.extend_from_slice(&at.a[..n]);
    recording.frame_damage.extend(at.bonds.iter().map(|bond| bond.damage));
    if layout.held > 0 {
        let from = recording.frame_friction.len();
        recording.frame_friction.resize(from + layout.held, 0.0);
        for (rub, mu) in model.rubs.iter().zip(at.mu) {
            recording.frame_friction[from + rub.joint as usize] = rub.normal[0] * mu;
        }
        devices::forces(model, at.devices, [at.z, at.v], |e, force| recording.frame_friction[from + e] = force);
    }
}

/// The impacts that are due, booked and told.
fn collide(model: &Model, work: &mut Step, state: &mut State, slow: f64, mut tell: impl FnMut(Event)) {
    let time = state.t;
    for collision in 0.. {
        let residual = work.impacts.solve(model, state, slow, collision);
        state.totals.contact_residual = state.totals.contact_residual.max(residual);
        let Impacts { before, after, impulse, .. } = &work.impacts;
        book_impact(model, state, [before, after, impulse], |joint, value| {
            tell(Event { time, joint, kind: EventKind::Impact, value });
        });
        if !Impacts::due(model, state) || collision > 2 * COLLISIONS {
            return;
        }
    }
}

/// [`settle`], which of the joints at rest let go under the forces of this instant, and the energy stored.
fn settle_all(model: &Model, drive: &Drive, work: &mut Step, state: &mut State) {
    settle(model, drive, state);
    stored_energy(model, &state.bonds, &state.devices, [&state.z, &state.v], &mut state.energies);
    if model.set_valued() {
        work.let_go(model, drive, state);
        accelerate(model, drive, state);
        work.stage.join(model, &state.tangents, &mut state.a);
    }
}

/// Starts envelopes and energy account from the state as it is: what energy it has is no residual.
fn begin_account(model: &Model, state: &mut State) {
    let (z, v) = (state.z.clone(), state.v.clone());
    observe(model, state, 0.0, [&z, &v]);
    state.energies.initial = 0.0;
    state.energies.initial = state.energies.residual();
    state.totals.peak_residual = 0.0;
}

/// Step factor 0.9 (1/error)^(1/order).
fn growth(error: f64, order: f64) -> f64 {
    if error <= 0.0 { f64::INFINITY } else { 0.9 * error.powf(-1.0 / order) }
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Status {
    /// Time reached [s].
    pub time: f64,
    /// End of the run [s].
    pub duration: f64,
    /// Steps taken, those before a resume included.
    pub steps: u64,
    /// Time from which an unfinished run was taken up [s]; none of one that began at 0, or that was not taken up by [`crate::run::run`].
    pub resumed_from: Option<f64>,
}

impl Status {
    /// Share of the run that is done, from 0 to 1.
    pub fn share(&self) -> f64 {
        self.time / self.duration
    }
}
