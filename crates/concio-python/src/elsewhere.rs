//! Runs that an executor of Python does.

use std::sync::{Mutex, PoisonError};

use concio::run::Control;
use concio_study::runner::{Deliver, Progress};
use concio_study::store::{line_of, parsed};
use concio_study::{Task, drive};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;

use crate::failure::Raised;
use crate::watch::{Board, Watch, beside};

/// Tasks as Python goes through them: a line is made when it is asked for, because each holds its records.
#[pyclass(module = "concio._native")]
pub struct Lines {
    tasks: std::vec::IntoIter<Task>,
}

#[pymethods]
impl Lines {
    fn __iter__(lines: PyRef<'_, Self>) -> PyRef<'_, Self> {
        lines
    }

    fn __next__(&mut self) -> Option<String> {
        self.tasks.next().map(|task| task.line())
    }
}

/// Hands tasks to Python: `rows`, called with their lines, gives lists of rows as they come, and empty ones now and then.
pub struct Executor {
    rows: Py<PyAny>,
    /// What it raised.
    error: Mutex<Option<PyErr>>,
}

impl Executor {
    /// Of a function of Python.
    pub fn new(rows: Py<PyAny>) -> Self {
        Executor { rows, error: Mutex::new(None) }
    }

    /// Has tasks done until the board says stop, or something is raised.
    pub fn work(&self, tasks: Vec<Task>, deliver: &mut Deliver, board: &Board) -> concio::Result<Control> {
        let lines = Lines { tasks: tasks.into_iter() };
        let mut wrong = None;
        let done = Python::attach(|py| -> PyResult<Control> {
            let given = self.rows.bind(py).call1((lines,))?;
            for some in given.try_iter()? {
                for line in some?.extract::<Vec<String>>()? {
                    let row = parsed(line.trim_end().as_bytes()).map_err(PyValueError::new_err)?;
                    match deliver(row) {
                        Ok(Control::Continue) => {}
                        Ok(Control::Stop) => return close(&given),
                        Err(error) => {
                            wrong = Some(error);
                            return close(&given);
                        }
                    }
                }
                if board.stopped() {
                    return close(&given);
                }
            }
            Ok(Control::Continue)
        });
        match (done, wrong) {
            (_, Some(error)) => Err(error),
            (Ok(control), None) => Ok(control),
            (Err(error), None) => {
                self.error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                Ok(Control::Stop)
            }
        }
    }

    /// What was raised on the way.
    pub fn raised(&self) -> Option<PyErr> {
        self.error.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Ends a generator, so that it cancels what has not begun.
fn close(given: &Bound<'_, PyAny>) -> PyResult<Control> {
    if given.hasattr("close")? {
        given.call_method0("close")?;
    }
    Ok(Control::Stop)
}

/// Does the runs of a task; a line per run.
#[pyfunction]
pub fn task_work(py: Python<'_>, task: &str, threads: usize) -> PyResult<Vec<String>> {
    let mut watch = Watch::new(None);
    let done = py.detach(|| {
        beside(&mut watch, |board| -> Result<Vec<String>, Raised> {
            let look = |progress: &Progress| board.look(progress.share);
            let (rows, _) = drive::work(&Task::parse(task)?, None, threads, &look)?;
            rows.iter().map(|row| line_of(row).map_err(|e| Raised::Other(e.to_string()))).collect()
        })
    });
    if watch.interrupted {
        return Err(PyKeyboardInterrupt::new_err(()));
    }
    if let Some(error) = watch.error {
        return Err(error);
    }
    Ok(done.map_err(|_| Raised::Other("the task panicked: this is an error of the engine".into()))??)
}
