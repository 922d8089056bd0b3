//! Walls that are ready to run.

use std::sync::Arc;
use std::time::Instant;

use concio::outcome::Outcome;
use concio::planar::tie_lines;
use concio::run::{self, joint_rows, run_watched};
use concio::simulate::Simulation as Steps;
use concio::store::{SCHEMA_VERSION, StoredRun};
use concio::warning::Warning;
use concio_cli::draw::wall::{Paint, Subject, draw};
use concio_cli::report::beam_label;
use concio_study::shaking::first_mode;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::failure::Raised;
use crate::run::Run;
use crate::simulation::Simulation;
use crate::tables;
use crate::watch::Watch;

/// A wall, laid and compiled, its records read. Immutable.
#[pyclass(frozen, module = "concio._native")]
pub struct Prepared {
    pub prepared: Arc<run::Prepared>,
    /// The wall file as it was given.
    pub text: Option<String>,
    /// What is hardly meant, and the line of the wall file where that is known.
    pub doubts: Vec<(Warning, Option<usize>)>,
}

#[pymethods]
impl Prepared {
    /// Columns of the blocks.
    fn blocks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables::blocks(py, &self.prepared.model.wall)
    }

    /// Columns of the joints.
    fn joints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let model = &self.prepared.model;
        tables::joints(py, &model.wall, &joint_rows(model))
    }

    /// Kind, sentence and line of every doubt.
    fn check(&self) -> Vec<(&'static str, &str, Option<usize>)> {
        self.doubts.iter().map(|(doubt, line)| (doubt.kind.name(), doubt.text.as_str(), *line)).collect()
    }

    /// The drawing of `concio check --svg`.
    fn svg(&self) -> String {
        let model = &self.prepared.model;
        let (names, beam) = (model.joint_names(), beam_label(&self.prepared.case));
        let ties = tie_lines(&self.prepared.case, &model.wall);
        let subject = Subject { wall: &model.wall, joints: &model.joints, names: &names, ties: &ties, beam: &beam };
        draw(&subject, Paint::Kinds)
    }

    /// `shear` or `planar`.
    #[getter]
    fn model(&self) -> &'static str {
        self.prepared.case.model.name()
    }

    /// Length of the run [s].
    #[getter]
    fn duration(&self) -> f64 {
        self.prepared.model.excitation.duration
    }

    /// Weight of all that has mass [N].
    #[getter]
    fn weight(&self) -> f64 {
        self.prepared.model.weight()
    }

    /// First period of the wall, its joints intact [s]; none where there is none. A wall that rocks has one for every amplitude.
    fn first_period(&self, py: Python<'_>) -> Option<f64> {
        let model = &self.prepared.model;
        let mode = py.detach(|| if model.rocking().is_some() { None } else { first_mode(model) });
        mode.map(|mode| mode.period)
    }

    /// What a result of this run is known by.
    #[getter]
    fn inputs_hash(&self) -> &str {
        &self.prepared.inputs_hash
    }

    /// Runs to the end, other threads of Python beside it. `progress` is called with the share that is done, 0 … 1. Ctrl-C ends it where
    /// it is; what a callback raises comes out of here.
    fn run(&self, py: Python<'_>, progress: Option<Py<PyAny>>) -> PyResult<Run> {
        let mut watch = Watch::new(progress);
        let start = Instant::now();
        let duration = self.prepared.model.excitation.duration;
        let outcome =
            py.detach(|| run_watched(&self.prepared, &mut |steps: &Steps| watch.look(|| steps.time() / duration)));
        match watch.error {
            Some(error) => Err(error),
            None => {
                let outcome = outcome.map_err(Raised::from)?;
                self.ended(py, outcome, start.elapsed().as_secs_f64(), watch.interrupted)
            }
        }
    }

    /// A run to be taken step by step.
    fn simulation(&self, py: Python<'_>) -> PyResult<Simulation> {
        Ok(py.detach(|| Simulation::begin(&self.prepared))?)
    }
}

impl Prepared {
    /// What became of its run.
    pub fn ended(&self, py: Python<'_>, outcome: Outcome, seconds: f64, interrupted: bool) -> PyResult<Run> {
        let summary = py.detach(|| run::summary(&self.prepared, &outcome, seconds, None));
        let stored = StoredRun {
            schema_version: SCHEMA_VERSION,
            provenance: self.prepared.provenance(),
            wall: self.prepared.model.wall.clone(),
            joints: joint_rows(&self.prepared.model),
            outcome,
        };
        Run::new(py, stored, summary, self.text.clone(), interrupted)
    }
}
