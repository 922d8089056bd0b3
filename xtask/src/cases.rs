//! Runs the cases of the research report anew and keeps what docs/report-cases.md shows of them.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::command::{Outcome, run};
use crate::concio_dev;

/// Replaces docs/report-cases.json and the pictures in docs/img/report; the tables follow with `cargo xtask docs`.
pub fn make(root: &Path) -> Outcome {
    let out = root.join("target").join("report-cases");
    if out.exists() {
        fs::remove_dir_all(&out).map_err(|e| format!("{}: {e}", out.display()))?;
    }
    run(Command::new(concio_dev(root)).args(["cases", "--figures", "--out"]).arg(&out).current_dir(root))?;
    copy(&out.join("findings.json"), &root.join("docs").join("report-cases.json"))?;
    let pictures = root.join("docs").join("img").join("report");
    fs::create_dir_all(&pictures).map_err(|e| format!("{}: {e}", pictures.display()))?;
    let figures = out.join("figures");
    let entries = fs::read_dir(&figures).map_err(|e| format!("{}: {e}", figures.display()))?;
    for entry in entries.filter_map(Result::ok) {
        copy(&entry.path(), &pictures.join(entry.file_name()))?;
    }
    Ok(())
}

fn copy(from: &Path, to: &Path) -> Outcome {
    fs::copy(from, to).map(drop).map_err(|e| format!("{}: {e}", to.display()))
}
