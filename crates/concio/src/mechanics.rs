//! What moves in a run: where the models of walls part ways while time goes on.

use concio_law::drift::Lean;
use concio_shear::run as shear;

use crate::case::Solver;
use crate::error::{InputError, Result};
use crate::keeper::{self, Keeper};
use crate::model::{Model, System};
use crate::outcome::{Deepest, Falling, RockingOutcome, TieRow};
use crate::planar_run;
use crate::record::{Layout, StopReason};
use crate::rocking_run;
use crate::state::State;

/// What moves, and how far it is.
#[derive(Debug, Clone)]
pub(crate) enum Mechanics<'m> {
    Shear(Box<shear::Run<'m>>),
    Planar(Box<planar_run::Run>),
    Rocking(Box<rocking_run::Run<'m>>),
}

/// What a result tells besides the state at a run's end: how panels lean, what ties bore [N], what became of a façade, what was crushed, and how
/// a wall falls.
pub(crate) struct Ending<'r> {
    pub leans: &'r [Lean],
    pub ties: Vec<TieRow>,
    pub rocking: Option<RockingOutcome>,
    pub deepest: Option<Deepest>,
    pub falling: Option<Falling>,
}

impl<'m> Mechanics<'m> {
    /// At rest, with the sample of that in the buffer.
    ///
    /// # Errors
    /// A rocking wall that cannot be built.
    pub fn begin(solver: &Solver, keeper: &mut Keeper<'m>) -> Result<Self> {
        let model = keeper.model;
        Ok(match &model.system {
            System::Shear => {
                let control = shear::Control {
                    scheme: solver.scheme,
                    tolerance: solver.tolerance,
                    floor: solver.floor.si(),
                    longest_step: solver.max_step.map_or(f64::INFINITY, |h| h.si()),
                };
                let Layout { interval, samples, frame_every, .. } = keeper.layout;
                let schedule = shear::Schedule { interval, samples, frame_every };
                let run = shear::Run::new(&model.shear, &model.excitation, control, schedule, keeper);
                Mechanics::Shear(Box::new(run))
            }
            System::Planar(planar) => {
                let longest = keeper::WINDOW as f64 * keeper.layout.interval;
                let mut run = Box::new(planar_run::Run::new(model, planar, longest));
                let Keeper { channels, layout, recording, .. } = keeper;
                run.sample(model, channels, layout, recording);
                Mechanics::Planar(run)
            }
            System::Rocking(rocking) => {
                let mut run = Box::new(rocking_run::Run::new(model, rocking, keeper.layout.interval)?);
                let Keeper { channels, layout, recording, .. } = keeper;
                run.begin(model, channels, layout, recording);
                Mechanics::Rocking(run)
            }
        })
    }

    /// How many events may happen at one instant.
    pub fn events_at_once(model: &Model) -> usize {
        // A planar wall may crush too, and collapse.
        let more = if model.planar().is_some() { model.joints.len() + 1 } else { 0 };
        shear::Run::events_at_once(&model.shear) + more
    }

    /// Motion and account after the last accepted step.
    pub fn state(&self) -> State<'_> {
        match self {
            Mechanics::Shear(run) => {
                let state = &run.state;
                State {
                    t: state.t,
                    z: &state.z,
                    v: &state.v,
                    a: &state.a,
                    bonds: &state.bonds,
                    energies: &state.energies,
                    envelopes: &state.envelopes,
                    totals: &state.totals,
                    counters: &state.counters,
                }
            }
            Mechanics::Planar(run) => run.state().shown(),
            Mechanics::Rocking(run) => run.state().shown(),
        }
    }

    /// Why it goes no further before its time is over.
    pub fn over(&self, model: &Model) -> Option<StopReason> {
        match self {
            Mechanics::Shear(_) => None,
            Mechanics::Planar(run) => run.collapsed(model).then_some(StopReason::Collapsed),
            Mechanics::Rocking(run) => run.over(),
        }
    }

    /// One step, and the samples of which all is known after it.
    pub fn step(&mut self, keeper: &mut Keeper<'m>) -> std::result::Result<(), StopReason> {
        match self {
            Mechanics::Shear(run) => run.step(keeper),
            Mechanics::Planar(run) => {
                let Keeper { model, channels, layout, recording } = keeper;
                run.step(model, channels, layout, recording)
            }
            Mechanics::Rocking(run) => {
                let Keeper { model, channels, layout, recording } = keeper;
                run.step(model, channels, layout, recording)
            }
        }
    }

    /// Displacement [m, m] and rotation [rad] of every moving body.
    pub fn places(&self, model: &Model) -> Vec<[f64; 3]> {
        match self {
            Mechanics::Shear(run) => {
                let blocks = &run.state.z[..model.wall.blocks.len()];
                let beam = model.floating_beam().map(|beam| &run.state.z[beam]);
                blocks.iter().chain(beam).map(|z| [*z, 0.0, 0.0]).collect()
            }
            Mechanics::Planar(run) => run.places(),
            Mechanics::Rocking(run) => run.places(),
        }
    }

    /// All that changes, as bytes.
    pub fn keep(&self) -> Vec<u8> {
        match self {
            Mechanics::Shear(run) => run.keep(),
            Mechanics::Planar(run) => run.keep(),
            Mechanics::Rocking(run) => run.keep(),
        }
    }

    /// Goes on from what was kept; false where it is not of this model.
    pub fn take_up(&mut self, model: &Model, bytes: &[u8]) -> bool {
        match self {
            Mechanics::Shear(run) => run.take_up(bytes),
            Mechanics::Planar(run) => run.take_up(model, bytes),
            Mechanics::Rocking(run) => run.take_up(bytes),
        }
    }

    /// Starts a wall of the shear model anew from `z` [m] and `v` [m/s] instead of rest.
    pub fn start_from(&mut self, z: &[f64], v: &[f64], keeper: &mut Keeper<'m>) {
        if let Mechanics::Shear(run) = self {
            keeper.recording.clear();
            run.start_from(z, v, keeper);
        }
    }

    /// Pushes a block of a planar wall from now on [N].
    ///
    /// # Errors
    /// Walls of another model.
    pub fn push(&mut self, block: usize, force: [f64; 2]) -> Result<()> {
        let Mechanics::Planar(run) = self else {
            let error = InputError::new("forces act on blocks of planar walls").key("model").allowed("`planar`");
            return Err(error.into());
        };
        run.push(block, force);
        Ok(())
    }

    /// At the end of the run.
    pub fn ending(&self, model: &Model) -> Ending<'_> {
        let of = |leans, ties| Ending { leans, ties, rocking: None, deepest: None, falling: None };
        match self {
            Mechanics::Shear(run) => of(&run.state.leans, Vec::new()),
            Mechanics::Planar(run) => {
                Ending { deepest: run.deepest(), falling: run.falling(), ..of(&run.state().leans, run.ties(model)) }
            }
            Mechanics::Rocking(run) => Ending { rocking: Some(run.row()), ..of(&run.state().leans, run.ties()) },
        }
    }
}
