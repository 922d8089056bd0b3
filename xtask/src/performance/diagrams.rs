//! Work–precision diagrams: error over time, a curve per program, drawn by the command `concio-dev chart`.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

use super::cases::{self, Case, Judge};
use super::measure::{Measured, Performance, Timed};
use crate::command::{Outcome, read};
use crate::concio_dev;

/// Draws all into a folder.
pub fn draw(root: &Path, all: &Performance, folder: &Path) -> Outcome {
    fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for (name, svg) in drawn(root, all)? {
        let file = folder.join(name);
        fs::write(&file, svg).map_err(|e| format!("{}: {e}", file.display()))?;
    }
    Ok(())
}

/// Name and content of every diagram.
pub fn drawn(root: &Path, all: &Performance) -> Result<Vec<(String, String)>, String> {
    let folder = root.join("target/performance");
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut diagrams = Vec::new();
    for case in cases::all(false) {
        let Some(measured) = all.cases.get(case.name) else { continue };
        let chart = chart(&case, measured);
        let file = folder.join("chart.json");
        fs::write(&file, chart.to_string()).map_err(|e| format!("{}: {e}", file.display()))?;
        let svg = read(Command::new(concio_dev(root)).arg("chart").arg(&file))?;
        diagrams.push((format!("{}.svg", case.name), svg));
    }
    Ok(diagrams)
}

fn chart(case: &Case, measured: &Measured) -> Value {
    let error = |run: &Timed| match case.judge {
        Judge::Account { work, .. } => Some(100.0 * (run.work / work - 1.0).abs()),
        Judge::Histories { .. } => run.error.map(|e| 1e6 * e),
    };
    let label = match case.judge {
        Judge::Account { .. } => "error of the work [%]",
        Judge::Histories { .. } => "error [ppm of the peak]",
    };
    let mut names: Vec<&str> = Vec::new();
    for run in &measured.runs {
        if !names.contains(&run.program.as_str()) {
            names.push(&run.program);
        }
    }
    let points = |name: &str| -> Vec<[f64; 2]> {
        let of = measured.runs.iter().filter(|r| r.program == name);
        let point = |r: &Timed| Some([r.median()?, error(r)?]);
        of.filter_map(point).filter(|p| p.iter().all(|v| v.is_finite() && *v > 0.0)).collect()
    };
    let series: Vec<Value> = names.iter().map(|name| json!({ "name": name, "points": points(name) })).collect();
    json!({
        "title": format!("Error over solver time, {}", case.name),
        "x": "solver time [s]",
        "y": label,
        "series": series,
    })
}
