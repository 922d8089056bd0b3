//! The programs that are compared, made ready to be called. What a machine lacks is skipped with a line that says so.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{cargo, read};
use crate::{concio, peers};

/// A method of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// TR-BDF2, the default.
    Concio,
    /// ESDIRK4(3)6L[2]SA.
    ConcioOrder4,
    Cvode,
    DiffsolBdf,
    DiffsolTrBdf2,
    Radau,
    Lsoda,
}

/// Who brings a method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    Concio,
    Cvode,
    Diffsol,
    Scipy,
}

impl Method {
    /// Name on the page and in the data.
    pub fn name(self) -> &'static str {
        match self {
            Method::Concio => "Concio",
            Method::ConcioOrder4 => "Concio, esdirk4",
            Method::Cvode => "CVODE",
            Method::DiffsolBdf => "diffsol, BDF",
            Method::DiffsolTrBdf2 => "diffsol, TR-BDF2",
            Method::Radau => "SciPy, Radau",
            Method::Lsoda => "SciPy, LSODA",
        }
    }

    pub fn family(self) -> Family {
        match self {
            Method::Concio | Method::ConcioOrder4 => Family::Concio,
            Method::Cvode => Family::Cvode,
            Method::DiffsolBdf | Method::DiffsolTrBdf2 => Family::Diffsol,
            Method::Radau | Method::Lsoda => Family::Scipy,
        }
    }

    /// What its program calls it; empty where the program has one.
    pub fn word(self) -> &'static str {
        match self {
            Method::Concio => "tr-bdf2",
            Method::ConcioOrder4 => "esdirk4",
            Method::Cvode => "",
            Method::DiffsolBdf => "bdf",
            Method::DiffsolTrBdf2 => "tr-bdf2",
            Method::Radau => "Radau",
            Method::Lsoda => "LSODA",
        }
    }
}

/// A program that can be called.
#[derive(Debug, Clone)]
pub struct Program {
    pub family: Family,
    /// The file to call and what comes before its arguments.
    pub call: Vec<OsString>,
    /// What it says of itself and its libraries.
    pub version: String,
}

impl Program {
    pub fn command(&self) -> Command {
        let mut command = Command::new(&self.call[0]);
        command.args(&self.call[1..]);
        command
    }
}

/// Concio, CVODE, and of the others those named, or all.
///
/// # Errors
/// A name of no program; CVODE missing, for it is what all are compared with.
pub fn ready(root: &Path, folder: &Path, names: &[String]) -> Result<Vec<Program>, String> {
    const KNOWN: [&str; 4] = ["concio", "cvode", "diffsol", "scipy"];
    if let Some(name) = names.iter().find(|n| !KNOWN.contains(&n.as_str())) {
        return Err(format!("no program `{name}`; there are {}", KNOWN.join(", ")));
    }
    fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let wanted = |name: &str| names.is_empty() || names.iter().any(|n| n == name);
    let mut all = vec![cvode(root, folder)?];
    if wanted("concio") {
        all.push(own(root)?);
    }
    for (name, make) in [("diffsol", diffsol as fn(&Path) -> Result<Program, String>), ("scipy", scipy)] {
        if wanted(name) {
            match make(root) {
                Ok(program) => all.push(program),
                Err(why) => crate::command::skip(&format!("{name} ({})", why.lines().last().unwrap_or(""))),
            }
        }
    }
    Ok(all)
}

fn own(root: &Path) -> Result<Program, String> {
    let program = concio(root);
    let version = read(Command::new(&program).arg("--version"))?.trim().to_string();
    Ok(Program { family: Family::Concio, call: vec![program.into()], version })
}

fn cvode(root: &Path, folder: &Path) -> Result<Program, String> {
    let program = folder.join("cvode_shear");
    peers::compile(root, &program)?;
    let version = read(Command::new(&program).arg("--version"))?.trim().to_string();
    Ok(Program { family: Family::Cvode, call: vec![program.into()], version })
}

/// A workspace of its own, so that who only builds Concio does not build diffsol.
fn diffsol(root: &Path) -> Result<Program, String> {
    let (folder, target) = (root.join("peers/diffsol"), root.join("target/peers-diffsol"));
    println!("diffsol is built if need be, which takes minutes the first time");
    let mut build = cargo(&folder);
    read(build.args(["build", "--release", "--locked", "--quiet", "--target-dir"]).arg(&target))?;
    let program = target.join("release").join(format!("diffsol-shear{}", std::env::consts::EXE_SUFFIX));
    let version = read(Command::new(&program).arg("--version"))?.trim().to_string();
    Ok(Program { family: Family::Diffsol, call: vec![program.into()], version })
}

fn scipy(root: &Path) -> Result<Program, String> {
    let folder = root.join("target/venv-peers");
    let python: PathBuf = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let script = root.join("peers/scipy_shear.py");
    let version = || read(Command::new(&python).arg(&script).arg("--version"));
    let version = match version() {
        Ok(version) => version,
        Err(_) => {
            read(Command::new("python3").args(["-m", "venv"]).arg(&folder))?;
            let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "numpy", "scipy"];
            read(Command::new(&python).args(install))?;
            version()?
        }
    };
    Ok(Program { family: Family::Scipy, call: vec![python.into(), script.into()], version: version.trim().into() })
}
