//! Python for the checks: the readers that users have (h5py, NumPy, VTK) and the peers of statistics (SALib, SciPy, eqsig, pycma), in a virtual environment under target/.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::command::{Outcome, read, run};
use crate::concio;
use crate::examples::folder;

/// What the checks import, by the names under which it is installed.
const PACKAGES: [&str; 7] = ["h5py", "numpy", "vtk", "scipy", "SALib", "eqsig", "cma"];
/// The example whose result is read.
const EXAMPLE: &str = "04-two-panels";

/// The interpreter of the environment, which is made if need be; `None`, with a printed reason, where Python or the
/// packages are not to be had.
pub fn environment(root: &Path) -> Result<Option<PathBuf>, String> {
    let folder = root.join("target").join("venv");
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let imports = PACKAGES.map(|p| format!("import {p}")).join("\n");
    let works = |python: &Path| {
        let status = Command::new(python).arg("-c").arg(&imports).stdout(Stdio::null()).stderr(Stdio::null()).status();
        status.is_ok_and(|s| s.success())
    };
    if works(&python) {
        return Ok(Some(python));
    }
    let skipped = |what: &str| {
        crate::command::skip(&format!("readers and peers in Python ({what})"));
        Ok(None)
    };
    if read(Command::new("python3").args(["-m", "venv"]).arg(&folder)).is_err() {
        return skipped("python3 -m venv does not work here");
    }
    let mut install = Command::new(&python);
    install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]).args(PACKAGES);
    if read(&mut install).is_err() || !works(&python) {
        return skipped("h5py, numpy, vtk, scipy, SALib, eqsig or cma cannot be installed here");
    }
    Ok(Some(python))
}

/// Exports the result of an example in every format and reads all of them.
pub fn read_results(root: &Path, python: Option<&Path>) -> Outcome {
    let Some(python) = python else {
        crate::command::skip("readers in Python (no environment)");
        return Ok(());
    };
    let result = folder(root, EXAMPLE);
    for format in ["--csv", "--npz", "--vtkhdf"] {
        read(Command::new(concio(root)).arg("export").arg(&result).arg(format))?;
    }
    let mut check = Command::new(python);
    check.arg(root.join("crates/concio/tests/python/check_result.py")).arg(result.join("result.h5"));
    check.arg("--csv").arg(result.join("csv")).arg("--npz").arg(result.join("result.npz"));
    run(check.arg("--vtkhdf").arg(result.join("result.vtkhdf")))
}
