//! The only time loop.
//!
//! [`Simulation::advance`] takes steps until its budget is spent, its record buffer is full or the run ends; it
//! does no I/O and allocates nothing, but for pairs of a planar wall that are looked up anew. The caller empties the buffer, shows progress, saves the state.

use concio_shear::run as shear;

use crate::bond::BondRow;
use crate::case::Solver;
use crate::channels::Channels;
use crate::error::{InputError, Result};
use crate::keeper::{self, Keeper};
use crate::mechanics::{Ending, Mechanics};
use crate::model::Model;
use crate::outcome::Outcome;
use crate::record::{Layout, Recording, StopReason};
use crate::state::State;

/// A run under way.
#[derive(Debug, Clone)]
pub struct Simulation<'m> {
    keeper: Keeper<'m>,
    mechanics: Mechanics<'m>,
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
        let system = &model.shear;
        let holds = model.turns() || system.sticks() || !system.bonds.is_empty() || !system.nonlinear.is_empty();
        let layout = Layout {
            interval: sampling.interval,
            samples: (duration / sampling.interval * (1.0 + 1e-12) + 1e-9).floor() as usize + 1,
            frame_every: sampling.frame_every,
            unknowns: model.unknowns(),
            turned: if model.turns() { model.unknowns() } else { 0 },
            touching: if model.turns() { model.joints.len() } else { 0 },
            held: if holds { model.joints.len() } else { 0 },
            bonded: model.shear.bonds.len(),
            channels: list,
        };
        let frames = if layout.frame_every > 0 { (2 * keeper::WINDOW).div_ceil(layout.frame_every) } else { 0 };
        let events = keeper::EVENTS + Mechanics::events_at_once(model);
        let recording = Recording::with_room(&layout, 2 * keeper::WINDOW, frames, events);
        let mut keeper = Keeper { model, channels, layout, recording };
        let mechanics = Mechanics::begin(solver, &mut keeper)?;
        Ok(Simulation { keeper, mechanics })
    }

    /// Says whether the names in `sampling` are those of blocks and joints.
    ///
    /// # Errors
    /// A name that no block or joint bears.
    pub fn check(model: &Model, sampling: &Sampling) -> Result<()> {
        Channels::new(model, &sampling.blocks, &sampling.joints).map(|_| ())
    }

    /// Starts a wall of the shear model from displacements and velocities relative to the base instead of rest; before the first step.
    /// `z` and `v` have one value per unknown. Planar walls start where they rest under their loads, whatever is asked.
    pub fn start_from(&mut self, z: &[f64], v: &[f64]) {
        self.mechanics.start_from(z, v, &mut self.keeper);
    }

    /// Pushes a block of a planar wall at its centre from now on, to the right and upwards [N], besides what the wall file has it pushed with. What the next
    /// step starts from is to be read before: a force that follows the motion is then that of the step's start.
    ///
    /// # Errors
    /// A block that is not there, forces that are not finite, walls of another model.
    pub fn push(&mut self, block: usize, force: [f64; 2]) -> Result<()> {
        let blocks = self.keeper.model.wall.blocks.len();
        if block >= blocks {
            return Err(InputError::new(format!("there is no block {block}"))
                .key("block")
                .allowed(format!("0 … {}", blocks - 1))
                .into());
        }
        if !force.iter().all(|f| f.is_finite()) {
            return Err(InputError::new(format!("is {force:?} N")).key("force").allowed("finite forces").into());
        }
        self.mechanics.push(block, force)
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
            if let Err(reason) = self.mechanics.step(&mut self.keeper) {
                return Progress::Ended(reason);
            }
        }
        self.over().map_or(Progress::Running, Progress::Ended)
    }

    /// Why the run goes no further, where it has come to its end. No step is shortened for an end after a collapse: until then the run
    /// has the bits of one that goes on.
    fn over(&self) -> Option<StopReason> {
        let model = self.keeper.model;
        if self.time() >= model.excitation.duration { Some(StopReason::Completed) } else { self.mechanics.over(model) }
    }

    /// Whether [`Simulation::advance`] waits for the buffer to be emptied.
    pub fn buffer_is_full(&self) -> bool {
        self.keeper.is_full()
    }
    /// How far the run is.
    pub fn status(&self) -> Status {
        let State { t, counters, .. } = self.state();
        let duration = self.keeper.model.excitation.duration;
        Status { time: t, duration, steps: counters.steps, resumed_from: None }
    }
    /// Samples since the buffer was last cleared.
    pub fn recording(&self) -> &Recording {
        &self.keeper.recording
    }
    /// Empties the buffer, keeping its memory.
    pub fn clear_recording(&mut self) {
        self.keeper.recording.clear();
    }
    /// What is kept.
    pub fn layout(&self) -> &Layout {
        &self.keeper.layout
    }
    /// Motion and account after the last accepted step.
    pub fn state(&self) -> State<'_> {
        self.mechanics.state()
    }
    /// Where every moving body is after the last accepted step, the blocks first and then a beam with motion of its own: displacement of its
    /// centre along x and y relative to the base [m] and rotation, counterclockwise, in rad. In the shear model only the first is not 0.
    pub fn places(&self) -> Vec<[f64; 3]> {
        self.mechanics.places(self.keeper.model)
    }
    /// The run of a wall of the shear model.
    pub fn shear(&self) -> Option<&shear::Run<'m>> {
        if let Mechanics::Shear(run) = &self.mechanics { Some(run) } else { None }
    }
    /// Time reached [s].
    pub fn time(&self) -> f64 {
        self.state().t
    }

    /// The state as bytes, from which [`Simulation::restore`] continues with the same bits. The record buffer is
    /// not part of it: empty it first.
    pub fn save(&self) -> Vec<u8> {
        self.mechanics.keep()
    }
    /// Goes back to a saved state; false when the bytes are not one of this model's, and the simulation is then to be made anew.
    pub fn restore(&mut self, bytes: &[u8]) -> bool {
        self.clear_recording();
        self.mechanics.take_up(self.keeper.model, bytes)
    }

    /// What keeps it and what moves in it, which the lanes of a batch take apart; the run itself, if it is of another model.
    pub(crate) fn into_parts(self) -> std::result::Result<(Keeper<'m>, shear::Run<'m>), Self> {
        match self {
            Simulation { keeper, mechanics: Mechanics::Shear(run) } => Ok((keeper, *run)),
            other => Err(other),
        }
    }
    /// The reverse of [`Simulation::into_parts`].
    pub(crate) fn from_parts(keeper: Keeper<'m>, run: shear::Run<'m>) -> Self {
        Simulation { keeper, mechanics: Mechanics::Shear(Box::new(run)) }
    }

    /// Runs to the end in memory: all rows, and why it ended.
    pub fn run_to_end(&mut self) -> (Recording, StopReason) {
        let mut rows = Recording::default();
        loop {
            let progress = self.advance(u64::MAX);
            rows.append(self.recording());
            self.clear_recording();
            if let Progress::Ended(reason) = progress {
                return (rows, reason);
            }
        }
    }

    /// The result, with the recording that the caller collected.
    pub fn outcome(self, recording: Recording, stop_reason: StopReason) -> Outcome {
        let Simulation { keeper: Keeper { model, layout, .. }, mechanics } = self;
        let Ending { leans, ties, rocking, deepest, falling } = mechanics.ending(model);
        let state = mechanics.state();
        let bonds = model.shear.bonds.iter().zip(state.bonds).map(|(bond, state)| BondRow::of(bond, state)).collect();
        let mut envelopes = state.envelopes.clone();
        // Runs without rigid joints count no impacts, results do.
        envelopes.joint_impulse.resize(model.joints.len(), 0.0);
        envelopes.joint_impacts.resize(model.joints.len(), 0.0);
        envelopes.drop_signs_of_zero();
        // What was cut short had yet to come to rest, and rubble leans no more.
        let completes = stop_reason == StopReason::Completed && state.totals.collapse.is_none();
        let drifts = model.shear.tops.rows(leans, model.shear.settles, state.t, completes);
        Outcome {
            bonds,
            drifts,
            ties,
            rocking,
            deepest,
            falling,
            layout,
            recording,
            time_reached: state.t,
            energies: *state.energies,
            envelopes,
            totals: *state.totals,
            counters: *state.counters,
            stop_reason,
        }
    }
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
