//! Python for the checks: the readers that users have (h5py, NumPy, VTK), the peers of statistics (SALib, SciPy, eqsig, pycma) and what checks the
//! package `concio`, in a virtual environment under target/.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::command::{Outcome, read, run};
use crate::concio;
use crate::examples::folder;

/// What the checks import, by the names under which it is installed.
const PACKAGES: [&str; 23] = [
    "h5py",
    "numpy",
    "vtk",
    "scipy",
    "SALib",
    "eqsig",
    "cma",
    "distributed",
    "ipykernel",
    "jupytext",
    "matplotlib",
    "maturin",
    "mypy",
    "nbclient",
    "obspy",
    "pandas",
    "pint",
    "pyright",
    "pyrotd",
    "pytest",
    "ruff",
    "tqdm",
    "xarray",
];
/// What is installed beside it and not imported: types for mypy.
const TYPES: [&str; 1] = ["pandas-stubs"];
/// Where the package `concio` is.
const PACKAGE: &str = "crates/concio-python";
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
    install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]).args(PACKAGES).args(TYPES);
    if read(&mut install).is_err() || !works(&python) {
        return skipped(&format!("one of {} cannot be installed here", PACKAGES.join(", ")));
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

/// Builds the wheel of the package `concio`, installs it and checks it: tests, examples in its documentation, stubs, types, style.
pub fn check_package(root: &Path, python: Option<&Path>) -> Outcome {
    let Some(python) = python else {
        crate::command::skip("package for Python (no environment)");
        return Ok(());
    };
    let recent = "import sys; sys.exit(sys.version_info < (3, 10))";
    if read(Command::new(python).args(["-c", recent])).is_err() {
        crate::command::skip("package for Python (python3 is older than 3.10)");
        return Ok(());
    }
    let module = |name: &str| {
        let mut command = Command::new(python);
        command.current_dir(root).args(["-m", name]);
        command
    };
    let wheels = root.join("target/wheels");
    // A wheel of an earlier version would be installed too.
    if wheels.exists() {
        std::fs::remove_dir_all(&wheels).map_err(|e| format!("{}: {e}", wheels.display()))?;
    }
    run(module("maturin").args(["build", "--quiet", "--release", "--locked", "--out"]).arg(&wheels))?;
    let mut install = module("pip");
    install.args(["install", "--quiet", "--disable-pip-version-check", "--no-index", "--no-deps", "--force-reinstall"]);
    run(install.arg("--find-links").arg(&wheels).arg("concio"))?;
    let [sources, tests, notebooks] = ["python", "tests", "notebooks"].map(|folder| format!("{PACKAGE}/{folder}"));
    run(module("pytest").args(["--quiet", "-rs", "--doctest-modules", "--pyargs", "concio", &tests]))?;
    run(module("mypy.stubtest").arg("concio"))?;
    run(module("mypy").args(["--no-error-summary", &format!("{sources}/concio"), &tests]))?;
    // Their names are no names of modules: one by one.
    for notebook in python_files(&root.join(&notebooks))? {
        run(module("mypy").arg("--no-error-summary").arg(notebook))?;
    }
    // It fetches the program it wraps when it is first called.
    if read(module("pyright").arg("--version")).is_ok() {
        let mut pyright = module("pyright");
        pyright.arg("--pythonpath").arg(python);
        run(pyright.args(["--level", "error", &sources, &notebooks]))?;
    } else {
        crate::command::skip("pyright (it cannot be fetched here)");
    }
    run(module("ruff").args(["check", "--quiet", PACKAGE]))?;
    run(module("ruff").args(["format", "--quiet", "--check", PACKAGE]))
}

/// The Python files of a folder, in order.
fn python_files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == "py"));
    files.sort();
    Ok(files)
}
