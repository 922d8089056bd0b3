//! A run of the shear model: steps under error control, breaks of the motion, cracks and impacts. What is kept of it is its caller's.

use concio_law::account::{Event, EventKind, StopReason};
use concio_law::motion::{Drive, Excitation};

use crate::dynamics::{accelerate, book_impact, kick, observe, settle, stored_energy};
use crate::integrate::cracks;
use crate::integrate::events;
use crate::integrate::impact::{COLLISIONS, Impacts};
use crate::integrate::stage::{self, Failure};
use crate::integrate::step::{Step, Tolerance};
use crate::state::{Instant, State, View};
use crate::system::{Scheme, System};

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
/// Samples in a step at most.
pub const WINDOW: usize = 128;
/// Closing velocity below which an impact is taken as plastic, over the tolerance of velocities: bounces that the
/// tolerance does not see come to an end.
const PLASTIC: f64 = 0.1;

/// How a run is integrated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Control {
    /// The scheme.
    pub scheme: Scheme,
    /// Relative tolerance of the local error against the largest motion so far.
    pub tolerance: f64,
    /// Displacement below which errors do not count [m].
    pub floor: f64,
    /// Longest step [s]; infinite for any that the motion allows.
    pub longest_step: f64,
}

/// When samples are due.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    /// Interval of the samples [s]; sample k is at k·interval, the first at t = 0.
    pub interval: f64,
    /// Number of samples of the whole run.
    pub samples: usize,
    /// Samples from one frame to the next; 0 for no frames.
    pub frame_every: usize,
}

/// Who keeps what a run tells.
pub trait Keep {
    /// Sample `k` is due at the instant `at`.
    fn sample(&mut self, k: u64, drive: &Drive, at: View<'_>);
    /// Where events are heard.
    fn events(&mut self) -> &mut Vec<Event>;
}

/// A run under way.
#[derive(Debug, Clone)]
pub struct Run<'m> {
    /// What moves.
    pub system: &'m System,
    /// What moves it.
    pub excitation: &'m dyn Excitation,
    /// How it is integrated.
    pub control: Control,
    schedule: Schedule,
    /// The state after the last accepted step.
    pub state: State,
    /// The step under way.
    pub(crate) work: Step,
    /// An instant inside a step, of which a sample is taken.
    instant: Instant,
    /// The smooth piece of the motion in which the state lies; follows from the time.
    pub(crate) drive: Drive,
    longest_step: f64,
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

impl<'m> Run<'m> {
    /// From rest at t = 0, whose sample is kept.
    pub fn new(
        system: &'m System,
        excitation: &'m dyn Excitation,
        control: Control,
        schedule: Schedule,
        keep: &mut dyn Keep,
    ) -> Self {
        let mut state = State::at_rest(system);
        let drive = excitation.drive(0.0);
        let mut work = Step::new(system, control.scheme);
        kick(system, &mut state, excitation.base_velocity_jump(0.0));
        settle_all(system, &drive, &mut work, &mut state);
        begin_account(system, &mut state);
        state.step = (0.01 / system.stiffest.sqrt()).min(excitation.duration());
        if !state.step.is_finite() {
            state.step = excitation.duration();
        }
        let longest_step = control.longest_step.min(excitation.longest_step());
        let instant = Instant::new(system);
        let mut run = Run { system, excitation, control, schedule, state, work, instant, drive, longest_step };
        run.sample(keep);
        run
    }

    /// How many events there are at most at one instant.
    pub fn events_at_once(system: &System) -> usize {
        events::at_once(system)
    }

    /// Starts from displacements and velocities relative to the base instead of rest; before the first step.
    /// `z` and `v` have one value per unknown. The sample at t = 0 is kept anew.
    pub fn start_from(&mut self, z: &[f64], v: &[f64], keep: &mut dyn Keep) {
        let n = self.system.unknowns();
        self.state.z[..n].copy_from_slice(z);
        self.state.v[..n].copy_from_slice(v);
        self.settle(keep);
        if !self.system.bonds.is_empty() {
            // What is strained beyond its strength from the start is cracked from the start.
            let (z, v) = (self.state.z.clone(), self.state.v.clone());
            let heard = keep.events();
            cracks::grow(self.system, &mut self.state, &z, &v, 0.0, |event| heard.push(event));
            self.settle(keep);
        }
        begin_account(self.system, &mut self.state);
        self.state.samples = 0;
        self.sample(keep);
    }

    /// Lets the impacts happen that are due at this instant, and makes what follows from displacements and velocities
    /// consistent with the motion.
    fn settle(&mut self, keep: &mut dyn Keep) {
        if Impacts::due(self.system, &self.state) {
            let slow = PLASTIC * self.tolerance(0.0).v;
            let heard = keep.events();
            collide(self.system, &mut self.work, &mut self.state, slow, |event| heard.push(event));
            self.state.counters.events += 1;
        }
        self.work.linger(self.system, &self.state, 0.0);
        settle_all(self.system, &self.drive, &mut self.work, &mut self.state);
    }

    /// One accepted step, to the next break of the motion or frame at the farthest.
    ///
    /// # Errors
    /// Why the run goes no further.
    pub fn step(&mut self, keep: &mut dyn Keep) -> Result<(), StopReason> {
        let mut plan = self.plan();
        loop {
            self.size(&mut plan);
            let tolerance = self.tolerance(plan.h);
            let attempt = self.work.attempt(self.system, &self.state, &self.drive, plan.h, tolerance);
            let attempt = self.over_a_drop(attempt, plan.h);
            if attempt.is_ok_and(|error| error <= 1.0) {
                let first = events::first(
                    self.system,
                    &self.state,
                    [&self.work.z, self.work.v()],
                    plan.h,
                    MEMORY * tolerance.z,
                );
                let shortest = self.shortest().max(f64::EPSILON * self.state.t);
                let turn = || self.work.turn(self.system, &self.state, plan.h, shortest);
                let first = first.or_else(turn);
                if first.is_some() {
                    self.state.counters.located += 1;
                    plan.event = first;
                    continue;
                }
            }
            match self.judge(attempt, &mut plan) {
                Verdict::Accept => {
                    self.accept(plan.end(self.state.t), plan.h, plan.meets_break(), keep);
                    return Ok(());
                }
                Verdict::Repeat => {}
                Verdict::Stop(reason) => return Err(reason),
            }
        }
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
        let event = events::near(self.system, &self.state, proposed.min(target - t));
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

    /// Shortest step [s].
    fn shortest(&self) -> f64 {
        SHORTEST / self.system.stiffest.sqrt().max(1.0)
    }

    /// The error of a try. Where friction drops at once, as static friction above the dynamic does when its joint lets
    /// go, (P1) compares forces before and after, and shrinks with the step no faster than it: at the first slip of a
    /// wall no step is short enough for a tolerance that has no motion yet to measure by. The shortest step then finds
    /// the instant, and is taken as it is: what follows begins with the friction of slip.
    fn over_a_drop(&self, attempt: Result<f64, Failure>, h: f64) -> Result<f64, Failure> {
        match attempt {
            Ok(error)
                if error > 1.0
                    && error.is_finite()
                    && h <= self.shortest()
                    && self.work.drops(self.system, &self.state) =>
            {
                Ok(0.0)
            }
            _ => attempt,
        }
    }

    /// What becomes of a try with this error over the tolerance, and how long the next one is.
    pub(crate) fn judge(&mut self, attempt: std::result::Result<f64, Failure>, plan: &mut Plan) -> Verdict {
        let shortest = self.shortest();
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
        let frame = if self.schedule.frame_every > 0 { every(self.schedule.frame_every) } else { u64::MAX };
        every(WINDOW).min(frame)
    }

    /// When sample `k` is due [s]; +∞ after the last.
    fn sample_time(&self, k: u64) -> f64 {
        if k >= self.schedule.samples as u64 {
            return f64::INFINITY;
        }
        (k as f64 * self.schedule.interval).min(self.excitation.duration())
    }

    /// Instants closer than this are one [s].
    fn slack(&self) -> f64 {
        1e-9 * self.schedule.interval
    }

    /// Of a step of `h` [s].
    pub(crate) fn tolerance(&self, h: f64) -> Tolerance {
        let [z, v] = self.state.scale;
        let work = self.state.totals.peak_input + self.state.energies.initial;
        let felt = h * self.system.stiffest.sqrt() > UNFELT;
        let floor = self.control.floor;
        Tolerance {
            z: self.control.tolerance * z + floor,
            v: self.control.tolerance * v + floor * self.system.stiffest.sqrt(),
            energy: if felt { self.control.tolerance.max(FINEST) * ENERGY * work } else { f64::INFINITY },
        }
    }

    fn accept(&mut self, t: f64, h: f64, at_break: bool, keep: &mut dyn Keep) {
        self.work.begin(self.system, &self.state);
        let heard = keep.events();
        let from = heard.len();
        let broke =
            cracks::grow(self.system, &mut self.state, &self.work.z, self.work.v(), h, |event| heard.push(event));
        Event::sort(&mut heard[from..]);
        self.work.accept(self.system, &mut self.state, t, h);
        self.state.counters.steps += 1;
        self.state.counters.iterations += std::mem::take(&mut self.work.stage.iterations);
        self.state.counters.factorisations += std::mem::take(&mut self.work.stage.factorisations);
        let residual = std::mem::take(&mut self.work.stage.contact_residual);
        self.state.totals.contact_residual = self.state.totals.contact_residual.max(residual);
        // Before anything of what happens at the end of the step.
        self.samples_before(t, h, keep);
        if broke {
            self.settle(keep);
        } else if self.work.rests(self.system, &self.state) {
            // What arrests a joint does not go on once it is at rest.
            settle_all(self.system, &self.drive, &mut self.work, &mut self.state);
        }
        observe(self.system, &mut self.state, h, self.work.start());
        self.happen(h, keep);
        if at_break
            && t < self.excitation.duration()
            && let Some(jump) = self.turn_piece(t)
        {
            self.restart(jump, keep);
        }
        if self.sample_is_due() {
            self.sample(keep);
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
    pub(crate) fn samples_before(&mut self, t: f64, h: f64, keep: &mut dyn Keep) {
        let inside = |run: &Self| run.sample_time(run.state.samples) < t - run.slack();
        if !inside(self) {
            return;
        }
        self.work.lend(&mut self.instant);
        while inside(self) {
            let due = self.sample_time(self.state.samples);
            self.work.inside(self.system, &self.drive, &self.state, h, due, &mut self.instant);
            keep.sample(self.state.samples, &self.drive, self.instant.view());
            self.state.samples += 1;
        }
        self.work.lend(&mut self.instant);
    }

    /// What a step of `h` that ended at an event leads to.
    fn happen(&mut self, h: f64, keep: &mut dyn Keep) {
        if Impacts::due(self.system, &self.state) {
            self.work.linger(self.system, &self.state, h);
            self.settle(keep);
            observe(self.system, &mut self.state, 0.0, self.work.start());
        }
    }

    /// Goes on into the piece of the motion that starts at `t`. Records only have kinks there; where acceleration or
    /// velocity jumps, the jump of the base's velocity [m/s], with which to call [`Run::restart`].
    pub(crate) fn turn_piece(&mut self, t: f64) -> Option<f64> {
        let before = self.drive;
        self.drive = self.excitation.drive(t);
        let jump = self.excitation.base_velocity_jump(t);
        let (old, new) = (before.base_acceleration(t), self.drive.base_acceleration(t));
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs());
        let smooth = jump == 0.0 && close(old, new) && close(before.top(t).v, self.drive.top(t).v);
        (!smooth).then_some(jump)
    }

    /// The rates at the start of the next step are those after a jump of the motion.
    pub(crate) fn restart(&mut self, jump: f64, keep: &mut dyn Keep) {
        if jump != 0.0 {
            kick(self.system, &mut self.state, jump);
        }
        self.settle(keep);
    }

    /// Takes the sample that is due at the state's own instant.
    pub fn sample(&mut self, keep: &mut dyn Keep) {
        keep.sample(self.state.samples, &self.drive, self.state.view());
        self.state.samples += 1;
    }

    /// The state as bytes, from which [`Run::take_up`] goes on with the same bits.
    pub fn keep(&self) -> Vec<u8> {
        // Plain vectors of numbers into memory: nothing that could fail.
        postcard::to_stdvec(&(&self.state, self.work.stage.keep())).unwrap_or_default()
    }

    /// Goes back to a state that was kept; false when the bytes are not one of this system's, and the run is then to be made anew.
    pub fn take_up(&mut self, bytes: &[u8]) -> bool {
        let Ok((state, factors)) = postcard::from_bytes::<(State, Option<stage::Kept>)>(bytes) else { return false };
        if !state.fits(self.system) || !self.work.stage.take_up(factors) {
            return false;
        }
        self.drive = self.excitation.drive(state.t);
        self.state = state;
        true
    }
}

/// The impacts that are due, booked and told.
fn collide(system: &System, work: &mut Step, state: &mut State, slow: f64, mut tell: impl FnMut(Event)) {
    let time = state.t;
    for collision in 0.. {
        let residual = work.impacts.solve(system, state, slow, collision);
        state.totals.contact_residual = state.totals.contact_residual.max(residual);
        let Impacts { before, after, impulse, .. } = &work.impacts;
        book_impact(system, state, [before, after, impulse], |joint, value| {
            tell(Event { time, joint, kind: EventKind::Impact, value });
        });
        if !Impacts::due(system, state) || collision > 2 * COLLISIONS {
            return;
        }
    }
}

/// [`settle`], which of the joints at rest let go under the forces of this instant, and the energy stored.
fn settle_all(system: &System, drive: &Drive, work: &mut Step, state: &mut State) {
    settle(system, drive, state);
    stored_energy(system, &state.bonds, &state.devices, [&state.z, &state.v], &mut state.energies);
    if system.set_valued() {
        work.let_go(system, drive, state);
        accelerate(system, drive, state);
        work.stage.join(system, &state.tangents, &mut state.a);
    }
}

/// Starts envelopes and energy account from the state as it is: what energy it has is no residual.
fn begin_account(system: &System, state: &mut State) {
    let (z, v) = (state.z.clone(), state.v.clone());
    observe(system, state, 0.0, [&z, &v]);
    state.energies.initial = 0.0;
    state.energies.initial = state.energies.residual();
    state.totals.peak_residual = 0.0;
}

/// Step factor 0.9 (1/error)^(1/order).
fn growth(error: f64, order: f64) -> f64 {
    if error <= 0.0 { f64::INFINITY } else { 0.9 * error.powf(-1.0 / order) }
}
