//! The extension module `concio._native`: what the Python package asks of the engine. Tables, pictures and texts are made in Python
//! (`python/concio`), whose functions check what comes in; here numbers move, and nothing is decided.

use std::ffi::OsString;
use std::process::ExitCode;

use concio_cli::failure::{STOPPED, WRONG_INPUT};
use pyo3::prelude::*;

mod amount;
mod case;
mod elsewhere;
mod examples;
mod failure;
mod json;
mod many;
mod prepared;
mod record;
mod run;
mod simulation;
mod study;
mod tables;
mod watch;

/// The command line: does what `arguments` say, of which the first is the name of the program; the exit status.
#[pyfunction]
fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    let code = py.detach(|| concio_cli::run_with(arguments));
    if code == ExitCode::SUCCESS {
        0
    } else if code == ExitCode::from(WRONG_INPUT) {
        WRONG_INPUT
    } else {
        STOPPED
    }
}

/// Native part of the package.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<case::Case>()?;
    module.add_class::<prepared::Prepared>()?;
    module.add_class::<record::Record>()?;
    module.add_class::<run::Run>()?;
    module.add_class::<simulation::Simulation>()?;
    module.add_function(wrap_pyfunction!(amount::in_si, module)?)?;
    module.add_function(wrap_pyfunction!(command, module)?)?;
    module.add_function(wrap_pyfunction!(examples::example_names, module)?)?;
    module.add_function(wrap_pyfunction!(many::run_many, module)?)?;
    module.add_function(wrap_pyfunction!(elsewhere::task_work, module)?)?;
    module.add_function(wrap_pyfunction!(study::study_check, module)?)?;
    module.add_function(wrap_pyfunction!(study::study_report, module)?)?;
    module.add_function(wrap_pyfunction!(study::study_run, module)?)
}
