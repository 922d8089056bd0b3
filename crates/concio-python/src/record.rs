//! Records: read or given, and what is done to them. A record that came from a file and was treated in the order of the wall file is
//! known by what a wall file would say of it, so that its runs are those of the command line.

use std::path::{Path, PathBuf};

use concio::case::{Document, RecordInput, Syntax};
use concio::ground::record::{Format, INTERVAL_RANGE, Record as History};
use concio::ground::{Library, MOST_SAMPLES, STANDARD_GRAVITY, measure, process, response_spectrum};
use concio::quantity::Acceleration;
use concio::{Error, InputError};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Map, Value, json};

use crate::failure::Raised;
use crate::json;

/// Keys of a record in the order in which a wall file has them done; those of one place exclude each other.
const ORDER: [&[&str]; 5] = [&["trim"], &["reverse"], &["baseline"], &["resample"], &["scale", "pga"]];

/// An accelerogram. Immutable: what is done to it makes another.
#[pyclass(frozen, module = "concio._native")]
pub struct Record {
    pub history: History,
    /// The table of a wall file that gives it; none when no file does.
    given: Option<Map<String, Value>>,
    /// Whether its peak was chosen, by a factor or as such: its unit says nothing then.
    pub sized: bool,
    /// Names of the components in its file.
    #[pyo3(get)]
    components: Vec<String>,
}

/// Reads the keys of a record of a wall file, units in them.
fn input(keys: &Map<String, Value>) -> Result<RecordInput, Raised> {
    let text = Value::Object(keys.clone()).to_string();
    let read = Document::parse(&text, Syntax::Json, None).and_then(|document| document.to());
    read.map_err(|error| match error {
        // There is no file: places in it say nothing.
        Error::Input(e) => InputError { line: None, column: None, ..*e }.into(),
        other => other.into(),
    })
}

fn object(text: &str) -> PyResult<Map<String, Value>> {
    match json::of_text(text)? {
        Value::Object(keys) => Ok(keys),
        _ => Ok(Map::new()),
    }
}

#[pymethods]
impl Record {
    /// Reads what a table of a wall file names, as JSON: `record` and the keys beside it.
    #[staticmethod]
    fn read(py: Python<'_>, keys: &str) -> PyResult<Self> {
        let given = object(keys)?;
        let input = input(&given)?;
        let read = || {
            let library = Library::default();
            let components = library.component(&input, Path::new(""))?.names;
            Ok::<_, Error>((library.record(&input, Path::new(""))?, components))
        };
        let (history, components) = py.detach(read).map_err(Raised::from)?;
        let sized = input.scale.is_some() || input.pga.is_some();
        Ok(Record { history, given: Some(given), sized, components })
    }

    /// Of samples, `unit` being that of an acceleration.
    #[staticmethod]
    fn from_array(acceleration: PyReadonlyArray1<'_, f64>, dt: f64, unit: &str) -> PyResult<Self> {
        let wrong = |key: &str, what: String, allowed: &str| -> PyErr {
            Raised::from(InputError::new(what).key(key).allowed(allowed)).into()
        };
        // As of a file of text: archives mean standard gravity.
        let factor = match unit {
            "g" => STANDARD_GRAVITY,
            _ => Acceleration::parse(&format!("1 {unit}"))
                .map_err(|what| wrong("units", what, "a unit of acceleration, such as g or m/s2"))?
                .si(),
        };
        let acceleration: Vec<f64> = acceleration.as_array().iter().map(|a| a * factor).collect();
        let [shortest, longest] = INTERVAL_RANGE;
        if !(shortest..=longest).contains(&dt) {
            return Err(wrong("dt", format!("sample interval {dt} s"), &format!("{shortest} … {longest} s")));
        }
        if !(2..=MOST_SAMPLES).contains(&acceleration.len()) {
            let what = format!("{} samples", acceleration.len());
            return Err(wrong("acceleration", what, &format!("2 … {MOST_SAMPLES} samples")));
        }
        if let Some(k) = acceleration.iter().position(|a| !a.is_finite()) {
            return Err(wrong("acceleration", format!("sample {k} is {}", acceleration[k]), "finite numbers"));
        }
        let history = History {
            format: Format::Text,
            dt,
            acceleration,
            displacement: None,
            units: unit.into(),
            station: String::new(),
            event: String::new(),
            channel: String::new(),
            remarks: Vec::new(),
        };
        Ok(Record { history, given: None, sized: false, components: Vec::new() })
    }

    /// Another record, treated as these keys of a wall file say, given as JSON.
    fn treated(&self, py: Python<'_>, keys: &str) -> PyResult<Self> {
        let keys = object(keys)?;
        let mut step = keys.clone();
        step.insert("record".into(), "".into());
        let step = input(&step)?;
        let history = py.detach(|| process::prepare(self.history.clone(), &step)).map_err(Raised::from)?;
        // A wall file treats a record in one order: what was done in another has no words there.
        let place = |key: &String| ORDER.iter().position(|own| own.contains(&key.as_str()));
        let last = |keys: &Map<String, Value>| keys.keys().filter_map(place).max();
        let given = self.given.as_ref().filter(|given| last(given) < keys.keys().filter_map(place).min());
        let given = given.map(|given| given.clone().into_iter().chain(keys).collect());
        let sized = self.sized || step.scale.is_some() || step.pga.is_some();
        Ok(Record { history, given, sized, components: self.components.clone() })
    }

    /// What a wall file in `folder` says of it, as JSON; none where it has no words for it.
    fn words(&self, folder: PathBuf) -> Option<String> {
        let mut given = self.given.clone()?;
        let path = PathBuf::from(given.get("record")?.as_str()?);
        let below = path.strip_prefix(&folder).unwrap_or(&path);
        given.insert("record".into(), below.to_str()?.into());
        Some(Value::Object(given).to_string())
    }

    /// Time from one sample to the next [s].
    #[getter]
    fn dt(&self) -> f64 {
        self.history.dt
    }

    /// Time from the first sample to the last [s].
    #[getter]
    fn duration(&self) -> f64 {
        self.history.duration()
    }

    /// Accelerations [m/s²], read-only.
    fn acceleration<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        shut(PyArray1::from_slice(py, &self.history.acceleration))
    }

    /// Velocities [m/s] and displacements [m], from rest; displacements of a displacement history are its own.
    fn integrated<'py>(&self, py: Python<'py>) -> [Bound<'py, PyArray1<f64>>; 2] {
        let history = &self.history;
        let (v, u) = process::integrate(history.dt, &history.acceleration, 0.0, 0.0);
        [v, history.displacement.clone().unwrap_or(u)].map(|values| shut(PyArray1::from_vec(py, values)))
    }

    /// Format, station, event, channel, unit and remarks, as its file has them.
    fn facts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let history = &self.history;
        let facts = json!({
            "format": if self.given.is_some() { history.format.name() } else { "array" },
            "station": history.station,
            "event": history.event,
            "channel": history.channel,
            "units": history.units,
            "remarks": history.remarks.iter().map(ToString::to_string).collect::<Vec<_>>(),
        });
        json::to_python(py, &facts)
    }

    /// Its measures, SI.
    fn measures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let measures = py.detach(|| json!(measure(&self.history)));
        json::to_python(py, &measures)
    }

    /// Spectral displacement [m], pseudo-velocity [m/s] and pseudo-acceleration [m/s²] at periods [s].
    fn spectrum<'py>(
        &self,
        py: Python<'py>,
        periods: PyReadonlyArray1<'_, f64>,
        damping: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let periods: Vec<f64> = periods.as_array().to_vec();
        let found = py.detach(|| response_spectrum(self.history.dt, &self.history.acceleration, damping, &periods));
        let spectrum = PyDict::new(py);
        for (name, values) in [("sd", found.sd), ("psv", found.psv), ("psa", found.psa)] {
            spectrum.set_item(name, shut(PyArray1::from_vec(py, values)))?;
        }
        Ok(spectrum)
    }
}

/// An array that may be read only.
pub fn shut<'py, T: numpy::Element, D: numpy::ndarray::Dimension>(
    array: Bound<'py, numpy::PyArray<T, D>>,
) -> Bound<'py, numpy::PyArray<T, D>> {
    array.readwrite().make_nonwriteable();
    array
}
