//! Runs that are over. Their histories and frames belong to Python's arrays, which nobody may write to; they are copied back only to be
//! written into a file.

use std::path::PathBuf;

use concio::case::{Syntax, from_str};
use concio::outcome::Outcome;
use concio::record::Recording;
use concio::run::{RESULT, SUMMARY, keep};
use concio::store::{self, RunFacts, StoredRun, hdf5, read_summary};
use concio_cli::report::{self, Content};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Value, json};

use crate::failure::Raised;
use crate::record::shut;
use crate::{json, tables};

/// Kind and sentence of what is told of a result without a summary.
const NO_SUMMARY: (&str, &str) = (
    "no-summary",
    "the result has no summary.json beside it, which says what speaks against believing it: of a run of a study the column \
     warning_kinds of its rows does",
);

/// A run that is over.
#[pyclass(frozen, module = "concio._native")]
pub struct Run {
    /// Without histories and frames.
    stored: StoredRun,
    summary: Value,
    /// The wall file as it was given.
    #[pyo3(get)]
    text: Option<String>,
    /// Whether Ctrl-C ended it.
    #[pyo3(get)]
    interrupted: bool,
    time: Py<PyArray1<f64>>,
    values: Py<PyArray2<f64>>,
    frame_time: Py<PyArray1<f64>>,
    frames: Vec<(&'static str, Py<PyArray2<f64>>)>,
}

/// The arrays of frames of a recording, each with its name and the number of its columns.
type OfFrames<'r> = [(&'static str, &'r mut Vec<f64>, usize); 10];

fn of_frames<'r>(recording: &'r mut Recording, layout: &concio::record::Layout) -> OfFrames<'r> {
    [
        ("displacement", &mut recording.frame_displacement, layout.unknowns),
        ("velocity", &mut recording.frame_velocity, layout.unknowns),
        ("acceleration", &mut recording.frame_acceleration, layout.unknowns),
        ("vertical", &mut recording.frame_vertical, layout.turned),
        ("rotation", &mut recording.frame_rotation, layout.turned),
        ("friction", &mut recording.frame_friction, layout.held),
        ("slip", &mut recording.frame_slip, layout.touching),
        ("opening", &mut recording.frame_opening, layout.touching),
        ("pressure", &mut recording.frame_pressure, layout.touching),
        ("damage", &mut recording.frame_damage, layout.bonded),
    ]
}

/// Values of `rows` rows as an array of Python, which takes the memory over.
fn rows<'py>(py: Python<'py>, values: Vec<f64>, rows: usize, width: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
    Ok(shut(PyArray1::from_vec(py, values).reshape([rows, width])?))
}

impl Run {
    pub fn new(
        py: Python<'_>,
        mut stored: StoredRun,
        summary: Value,
        text: Option<String>,
        interrupted: bool,
    ) -> PyResult<Self> {
        let mut recording = std::mem::take(&mut stored.outcome.recording);
        // Events are few, and read on this side.
        stored.outcome.recording.events = std::mem::take(&mut recording.events);
        let layout = &stored.outcome.layout;
        let (samples, of) = (recording.time.len(), recording.frame_time.len());
        let values = rows(py, std::mem::take(&mut recording.values), samples, layout.channels.len())?.unbind();
        let mut frames = Vec::new();
        for (name, values, width) in of_frames(&mut recording, layout) {
            frames.push((name, rows(py, std::mem::take(values), of, width)?.unbind()));
        }
        let list = |values: Vec<f64>| shut(PyArray1::from_vec(py, values)).unbind();
        let (time, frame_time) = (list(recording.time), list(recording.frame_time));
        Ok(Run { stored, summary, text, interrupted, time, values, frame_time, frames })
    }

    /// With histories and frames in it.
    fn whole(&self, py: Python<'_>) -> PyResult<StoredRun> {
        let mut stored = self.stored.clone();
        let Outcome { recording, layout, .. } = &mut stored.outcome;
        recording.time = self.time.bind(py).to_vec()?;
        recording.values = self.values.bind(py).to_vec()?;
        recording.frame_time = self.frame_time.bind(py).to_vec()?;
        for ((_, to, _), (_, from)) in of_frames(recording, layout).into_iter().zip(&self.frames) {
            *to = from.bind(py).to_vec()?;
        }
        Ok(stored)
    }
}

/// The summary of a result that has none.
fn without_facts(stored: &StoredRun) -> Result<Value, Raised> {
    let StoredRun { provenance, wall, joints, outcome, .. } = stored;
    let case = from_str(&provenance.case_json, Syntax::Json, None)?.case;
    let unknown = f64::NAN;
    let facts = RunFacts {
        duration: case.motion.duration.map_or(unknown, |duration| duration.si()),
        weight: unknown,
        base_load: unknown,
        solve_seconds: unknown,
        resumed_from: None,
        push: None,
        at_first_crack: None,
        warnings: Vec::new(),
    };
    let mut summary = store::summary(provenance, wall, joints, outcome, &facts);
    summary["warnings"] = json!([NO_SUMMARY.1]);
    summary["warning_kinds"] = json!([NO_SUMMARY.0]);
    Ok(summary)
}

#[pymethods]
impl Run {
    /// Reads `result.h5` and `summary.json` of a folder; `text` is the wall file as it was given, where that is known.
    #[staticmethod]
    fn open(py: Python<'_>, folder: PathBuf, text: Option<String>) -> PyResult<Self> {
        let read = || {
            let stored = hdf5::read(&folder.join(RESULT))?;
            let summary = read_summary(&folder.join(SUMMARY))?;
            let hash = summary.get("inputs_hash").and_then(Value::as_str);
            if hash != Some(&stored.provenance.inputs_hash) {
                let error = concio::InputError::new("it belongs to another run than result.h5");
                return Err(Raised::from(error.in_file(&folder.join(SUMMARY))));
            }
            Ok::<_, Raised>((stored, summary))
        };
        let (stored, summary) = py.detach(read)?;
        Run::new(py, stored, summary, text, false)
    }

    /// Reads a result without a summary beside it, as studies keep them. What only a summary knows is null there, of which a warning tells.
    #[staticmethod]
    fn read(py: Python<'_>, file: PathBuf) -> PyResult<Self> {
        let (stored, summary) = py.detach(|| {
            let stored = hdf5::read(&file).map_err(Raised::from)?;
            let summary = without_facts(&stored)?;
            Ok::<_, Raised>((stored, summary))
        })?;
        Run::new(py, stored, summary, None, false)
    }

    /// Writes `result.h5` and `summary.json` into a folder.
    fn save(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        let whole = self.whole(py)?;
        Ok(py.detach(|| keep(&whole, &self.summary, &folder)).map_err(Raised::from)?)
    }

    /// Writes the report to a file.
    fn report(&self, py: Python<'_>, path: PathBuf, name: String) -> PyResult<()> {
        let whole = self.whole(py)?;
        let written = py.detach(|| {
            let case = from_str(&whole.provenance.case_json, Syntax::Json, None)?.case;
            let content = Content {
                name,
                case,
                text: self.text.as_deref(),
                command: None,
                wall: &whole.wall,
                joints: &whole.joints,
                outcome: &whole.outcome,
                summary: &self.summary,
            };
            report::write_to(&path, &content).map_err(Raised::from)
        });
        Ok(written?)
    }

    /// What `summary.json` holds.
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        json::to_python(py, &self.summary)
    }

    /// The resolved wall file as JSON.
    #[getter]
    fn case(&self) -> &str {
        &self.stored.provenance.case_json
    }

    /// Name, unit and meaning of every channel.
    fn channels(&self) -> Vec<(&str, &str, &str)> {
        let channels = self.stored.outcome.layout.channels.iter();
        channels.map(|c| (c.name.as_str(), c.unit.as_str(), c.description.as_str())).collect()
    }

    /// Times of the samples [s].
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.time.bind(py).clone()
    }

    /// A row per sample, a column per channel.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.values.bind(py).clone()
    }

    /// Times of the frames [s].
    #[getter]
    fn frame_time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.frame_time.bind(py).clone()
    }

    /// The arrays of frames, a row per frame; without columns those that this run does not keep.
    fn frames<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let frames = PyDict::new(py);
        for (name, values) in &self.frames {
            frames.set_item(name, values.bind(py))?;
        }
        Ok(frames)
    }

    /// Columns of the blocks, peaks among them.
    fn blocks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let table = tables::blocks(py, &self.stored.wall)?;
        let (n, envelopes) = (self.stored.wall.blocks.len(), &self.stored.outcome.envelopes);
        for (name, values) in [
            ("peak_displacement", &envelopes.block_displacement),
            ("peak_velocity", &envelopes.block_velocity),
            ("peak_acceleration", &envelopes.block_acceleration),
        ] {
            table.set_item(name, &values[..n])?;
        }
        Ok(table)
    }

    /// Columns of the joints, peaks and damage among them.
    fn joints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let StoredRun { wall, joints, outcome, .. } = &self.stored;
        let table = tables::joints(py, wall, joints)?;
        let envelopes = &outcome.envelopes;
        for (name, values) in [
            ("peak_displacement", &envelopes.joint_displacement),
            ("slip", &envelopes.joint_slip),
            ("opening", &envelopes.joint_opening),
            ("closing", &envelopes.joint_closing),
            ("peak_force", &envelopes.joint_force),
            ("dissipation", &envelopes.joint_dissipation),
            ("impacts", &envelopes.joint_impacts),
        ] {
            table.set_item(name, values)?;
        }
        let mut damage = vec![f64::NAN; joints.len()];
        let mut cracked = damage.clone();
        for bond in &outcome.bonds {
            damage[bond.joint] = bond.damage;
            cracked[bond.joint] = bond.cracked;
        }
        table.set_item("damage", damage)?;
        table.set_item("cracked_at", cracked)?;
        Ok(table)
    }

    /// Indices of the joints whose damage frames hold, in their order.
    fn bonded(&self) -> Vec<usize> {
        self.stored.outcome.bonds.iter().map(|bond| bond.joint).collect()
    }

    /// What happened at one instant.
    fn events<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        tables::events(py, &self.stored.joints, &self.stored.outcome.recording.events)
    }

    /// How far the tops went.
    fn drifts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows = self.stored.outcome.drifts.iter().map(|row| {
            json!({
                "top": row.top, "height": row.height, "peak": row.peak, "time": row.time, "residual": row.residual, "swing": row.swing,
            })
        });
        json::to_python(py, &rows.collect())
    }
}
