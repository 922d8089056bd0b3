//! Runs every wall file in examples/ and looks at its energy account; runs the programs of the library.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::command::{Outcome, cargo, read, run};
use crate::{concio, program};

/// Largest residual of the energy account over the largest work.
const LARGEST_RESIDUAL: f64 = 1e-3;

/// Examples whose runs warn, and the kind of it: what they show is what is warned of.
const WARNED: [(&str, &str); 9] = [
    ("01-first-wall", "ring faster than"),
    ("03-irregular-texture", "ring faster than"),
    ("04-two-panels", "ring faster than"),
    ("09-replaced-joint", "ring faster than"),
    ("10-true-stick", "a matter of chance"),
    ("17-arch", "collapsed"),
    ("19-rocking-facade", "ties begin at no force"),
    ("19-rocking-facade", "rocks outwards only"),
    ("19-rocking-facade", "a matter of chance"),
];

/// The results of an example.
pub fn folder(root: &Path, name: &str) -> PathBuf {
    root.join("target").join("examples-out").join(name)
}

/// Runs them all.
pub fn run_all(root: &Path) -> Outcome {
    let files = wall_files(root)?;
    println!("{:<28} {:>6} {:>6} {:>9} {:>8} {:>9}", "example", "blocks", "joints", "steps", "s", "residual");
    for file in files {
        one(root, &file)?;
    }
    // Too large to be run each time, or run by a test.
    for file in ["large/facade.toml", "laboratory/ispra-low.toml", "laboratory/ispra-high.toml"] {
        read(Command::new(concio(root)).arg("check").arg(format!("examples/{file}")).current_dir(root))?;
    }
    in_rust(root)?;
    studies(root)
}

/// Runs the programs of crates/concio/examples.
fn in_rust(root: &Path) -> Outcome {
    let folder = root.join("crates").join("concio").join("examples");
    let entries = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
    files.sort();
    // The whole workspace, as the tests have it: for one package alone, dependencies would have other features and be built anew.
    run(cargo(root).args(["build", "--quiet", "--locked", "--release", "--workspace", "--examples"]))?;
    for name in files.iter().filter_map(|path| path.file_stem()) {
        read(&mut Command::new(program(root, &format!("examples/{}", name.to_string_lossy()))))?;
    }
    println!("{} programs of crates/concio/examples run", files.len());
    if files.is_empty() { Err("there are no programs".into()) } else { Ok(()) }
}

/// Checks the study files of examples/studies/ and the walls that they start from; `cargo xtask studies` runs them.
fn studies(root: &Path) -> Outcome {
    let folder = root.join("examples").join("studies");
    let entries = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).filter(|p| is_wall(p)).collect();
    files.sort();
    for file in &files {
        let text = fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
        let words: &[&str] =
            if text.lines().any(|l| l.starts_with("wall = ")) { &["study", "check"] } else { &["check"] };
        read(Command::new(concio(root)).args(words).arg(file).current_dir(root))?;
    }
    println!("{} files of examples/studies hold", files.len());
    if files.is_empty() { Err("there are no studies".into()) } else { Ok(()) }
}

/// The wall files of examples/, in order.
pub fn wall_files(root: &Path) -> Result<Vec<PathBuf>, String> {
    let folder = root.join("examples");
    let entries = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).filter(|p| is_wall(p)).collect();
    files.sort();
    if files.is_empty() { Err("there are no examples".into()) } else { Ok(files) }
}

fn is_wall(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "toml" || e == "json")
}

fn one(root: &Path, file: &Path) -> Outcome {
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let text = fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    if !text.starts_with("# ") {
        return Err(format!("{name}: an example starts with a comment on what it shows"));
    }
    let out = folder(root, &name);
    read(Command::new(concio(root)).arg("run").arg(file).arg("--fresh").arg("--out").arg(&out))?;
    let summary = fs::read_to_string(out.join("summary.json")).map_err(|e| format!("{name}: {e}"))?;
    let summary: Value = serde_json::from_str(&summary).map_err(|e| format!("{name}: {e}"))?;
    let number = |pointer: &str| summary.pointer(pointer).and_then(Value::as_f64).unwrap_or(f64::NAN);
    let residual = number("/energy/residual_relative");
    println!(
        "{name:<28} {:>6} {:>6} {:>9} {:>8.2} {residual:>9.1e}",
        number("/blocks"),
        number("/joints"),
        number("/steps"),
        number("/solve_seconds")
    );
    for file in ["result.h5", "report.html"] {
        if !out.join(file).is_file() {
            return Err(format!("{name}: {file} is missing"));
        }
    }
    let warnings = summary["warnings"].as_array().map(Vec::as_slice).unwrap_or_default();
    let told = |warning: &Value| {
        let words = WARNED.iter().filter(|(example, _)| *example == name).map(|(_, word)| *word);
        warning.as_str().is_some_and(|text| words.into_iter().any(|word| text.contains(word)))
    };
    if let Some(warning) = warnings.iter().find(|warning| !told(warning)) {
        return Err(format!("{name}: its run warns, which no example should: {warning}"));
    }
    // Written so that a residual that is not a number fails too.
    if residual <= LARGEST_RESIDUAL {
        Ok(())
    } else {
        Err(format!("{name}: the residual of the energy account is {residual:.1e}, more than {LARGEST_RESIDUAL}"))
    }
}
