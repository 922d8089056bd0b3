//! Errors of the engine as exceptions of Python: `concio.InputError` for what the user mends, `OSError` for what the system refuses.

use std::path::PathBuf;

use concio::{Error, InputError};
use concio_cli::failure::Failure;
use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// An error on its way to Python.
pub enum Raised {
    /// Mistakes in the input, at least one.
    Input(Vec<InputError>),
    /// A file that the system does not give or take.
    System(PathBuf, std::io::Error),
    /// Anything else.
    Other(String),
    /// An exception that Python raised itself.
    Python(PyErr),
}

impl From<Error> for Raised {
    fn from(error: Error) -> Self {
        match error {
            Error::Input(e) => Raised::Input(vec![*e]),
            Error::Io { path, source } => Raised::System(path, source),
            Error::Store { path, what } => Raised::Input(vec![InputError::new(what).in_file(&path)]),
        }
    }
}

impl From<InputError> for Raised {
    fn from(error: InputError) -> Self {
        Raised::Input(vec![error])
    }
}

impl From<Failure> for Raised {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Input(all) => Raised::Input(all),
            Failure::Other(what, help) => Raised::Other(help.map_or(what.clone(), |help| format!("{what}; {help}"))),
            Failure::ReaderGone => Raised::Other("nobody reads what is written".into()),
        }
    }
}

impl From<PyErr> for Raised {
    fn from(error: PyErr) -> Self {
        Raised::Python(error)
    }
}

impl From<Raised> for PyErr {
    fn from(raised: Raised) -> Self {
        match raised {
            Raised::Input(all) => Python::attach(|py| input_error(py, &all).unwrap_or_else(|e| e)),
            Raised::System(path, source) => {
                let number = source.raw_os_error().unwrap_or(0);
                PyOSError::new_err((number, source.to_string(), path))
            }
            Raised::Other(what) => PyRuntimeError::new_err(what),
            Raised::Python(error) => error,
        }
    }
}

/// A `concio.InputError` of the first mistake, the others in its `more`.
fn input_error(py: Python<'_>, all: &[InputError]) -> PyResult<PyErr> {
    let class = py.import("concio.errors")?.getattr("InputError")?;
    let mut made = Vec::with_capacity(all.len());
    for error in all {
        let fields = PyDict::new(py);
        fields.set_item("key", &error.key)?;
        fields.set_item("file", error.file.as_ref().map(|file| file.display().to_string()))?;
        fields.set_item("line", error.line)?;
        fields.set_item("column", error.column)?;
        fields.set_item("allowed", &error.allowed)?;
        fields.set_item("help", &error.help)?;
        made.push(class.call((&error.what,), Some(&fields))?);
    }
    let Some((first, more)) = made.split_first() else {
        return Ok(PyRuntimeError::new_err("an input is wrong, and nothing is said of it"));
    };
    first.setattr("more", pyo3::types::PyTuple::new(py, more)?)?;
    Ok(PyErr::from_value(first.clone()))
}
