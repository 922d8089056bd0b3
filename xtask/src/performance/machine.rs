//! The machine and the versions that a measurement is of.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde::{Deserialize, Serialize};

use super::programs::Program;
use crate::command::{cargo, read};

/// A machine and what ran on it.
#[derive(Debug, Default, Clone, Serialize, Deserialize)]
pub struct Machine {
    /// Type of the processor, and how many the system sees.
    pub processor: String,
    pub processors: usize,
    pub system: String,
    /// Programs and compilers.
    pub versions: Vec<String>,
}

/// This one.
pub fn describe(root: &Path, programs: &[Program]) -> Machine {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let said = |command: &mut Command| read(command).ok().and_then(|t| t.lines().next().map(str::to_string));
    let mut versions: Vec<String> = programs.iter().map(|p| p.version.clone()).collect();
    versions.extend(
        said(cargo(root).args(["rustc", "--version"])).or_else(|| said(Command::new("rustc").arg("--version"))),
    );
    versions.extend(said(Command::new("g++").arg("--version")));
    Machine { processor: processor(), processors, system: system(), versions }
}

fn processor() -> String {
    let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let value = |key: &str| {
        let line = text.lines().find(|l| l.starts_with(key))?;
        line.split_once(':').map(|(_, v)| v.trim().to_string())
    };
    match (value("model name"), value("cpu family"), value("model\t")) {
        (Some(name), Some(family), Some(model)) => format!("{name} (family {family}, model {model})"),
        _ => std::env::consts::ARCH.into(),
    }
}

fn system() -> String {
    let text = fs::read_to_string("/etc/os-release").unwrap_or_default();
    let name = text.lines().find_map(|l| l.strip_prefix("PRETTY_NAME="));
    name.map_or_else(|| std::env::consts::OS.into(), |n| n.trim_matches('"').into())
}

/// The day, as `date` says it.
pub fn today() -> String {
    read(Command::new("date").args(["-u", "+%Y-%m-%d"])).map_or_else(|_| "unknown".into(), |t| t.trim().into())
}
