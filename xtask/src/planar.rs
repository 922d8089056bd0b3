//! Makes the runs and pictures of docs/planar.md anew: dry walls beside their laboratory tests, one panel that fails in three ways, an arch.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::json;

use crate::command::{Outcome, read};
use crate::{concio, concio_dev};

/// Loads of the laboratory walls [kN/m] and the units that were tested under them (../shared/reference/dry-walls).
const TESTED: [(u32, &[&str]); 4] = [
    (40, &["WS40_Vasconcelos2005"]),
    (100, &["WS1100_Vasconcelos2009", "WS2100_Vasconcelos2009", "WS3100_Vasconcelos2009", "WS4100_Vasconcelos2009"]),
    (175, &["WS1175_Vasconcelos2009", "WS2175_Vasconcelos2009", "WS3175_Vasconcelos2009"]),
    (250, &["WS1250_Vasconcelos2009", "WS2250_Vasconcelos2009", "WS3250_Vasconcelos2009"]),
];

/// Bricks, courses and load [kN/m] of the panels, with the name of their picture.
const PANELS: [(&str, u32, u32, u32); 3] = [("rocking", 4, 16, 50), ("diagonal", 6, 10, 150), ("sliding", 12, 4, 10)];

/// Draws all of them.
pub fn make(root: &Path) -> Outcome {
    let scratch = root.join("target").join("planar");
    let images = root.join("docs").join("img").join("planar");
    for folder in [&scratch, &images] {
        fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    for (name, bricks, courses, load) in PANELS {
        let wall = text(root, "16-shear-panel.toml")?
            .replace("bricks = 6\n", &format!("bricks = {bricks}\n"))
            .replace("courses = 10\n", &format!("courses = {courses}\n"))
            .replace("top = \"150 kN/m\"", &format!("top = \"{load} kN/m\""));
        let run = ran(root, &scratch, name, &wall)?;
        deformed(root, &run, &images, name)?;
    }
    // On its way down, not when it is.
    let falling = text(root, "17-arch.toml")?.replace("duration = \"3.2 s\"", "duration = \"2.4 s\"");
    let arch = ran(root, &scratch, "arch", &falling)?;
    deformed(root, &arch, &images, "arch")?;
    let facade = ran(root, &scratch, "facade", &text(root, "large/facade.toml")?)?;
    deformed(root, &facade, &images, "facade")?;
    let beside = root.join("../shared/reference/dry-walls");
    for (load, units) in TESTED {
        let name = format!("ws-{load}");
        let wall =
            text(root, "15-dry-shear-wall.toml")?.replace("top = \"100 kN/m\"", &format!("top = \"{load} kN/m\""));
        let run = ran(root, &scratch, &name, &wall)?;
        if load == 100 {
            deformed(root, &run, &images, "ws-100-wall")?;
        }
        if !beside.is_dir() {
            crate::command::skip(&format!("figure {name} (measured curves not found)"));
            continue;
        }
        let mut series = vec![json!({ "name": "Concio", "points": computed(root, &run)? })];
        for unit in units {
            let file = beside.join(format!("envelope_{unit}.csv"));
            let measured = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
            series.push(json!({ "name": unit.split('_').next(), "points": envelope(&measured) }));
        }
        let chart = json!({
            "title": format!("Dry wall WS under {load} kN"),
            "x": "displacement of the top [mm]",
            "y": "horizontal force [kN]",
            "series": series,
            "plain": true,
        });
        let file = scratch.join("chart.json");
        fs::write(&file, chart.to_string()).map_err(|e| format!("{}: {e}", file.display()))?;
        let svg = read(Command::new(concio_dev(root)).arg("chart").arg(&file))?;
        let picture = images.join(format!("{name}.svg"));
        fs::write(&picture, svg).map_err(|e| format!("{}: {e}", picture.display()))?;
    }
    Ok(())
}

fn text(root: &Path, example: &str) -> Result<String, String> {
    let file = root.join("examples").join(example);
    fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))
}

/// Runs a wall, its results in a folder of this name.
fn ran(root: &Path, scratch: &Path, name: &str, wall: &str) -> Result<std::path::PathBuf, String> {
    let (file, out) = (scratch.join(format!("{name}.toml")), scratch.join(name));
    fs::write(&file, wall).map_err(|e| format!("{}: {e}", file.display()))?;
    println!("{name}:\n{}", read(Command::new(concio(root)).arg("run").arg(&file).arg("--out").arg(&out))?);
    Ok(out)
}

fn deformed(root: &Path, run: &Path, images: &Path, name: &str) -> Outcome {
    read(Command::new(concio(root)).arg("plot").arg(run).args(["--figure", "deformed"]))?;
    let (from, to) = (run.join("figures").join("deformed.svg"), images.join(format!("{name}.svg")));
    fs::copy(&from, &to).map(|_| ()).map_err(|e| format!("{}: {e}", from.display()))
}

/// Force of the beam over its displacement [mm, kN].
fn computed(root: &Path, run: &Path) -> Result<Vec<[f64; 2]>, String> {
    read(Command::new(concio(root)).arg("export").arg(run).arg("--csv"))?;
    let file = run.join("csv").join("histories.csv");
    let table = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    let mut rows = table.lines().filter(|l| !l.starts_with('#'));
    let names: Vec<&str> = rows.next().unwrap_or_default().split(',').collect();
    let column = |name: &str| {
        let at = names.iter().position(|n| n.starts_with(name));
        at.ok_or_else(|| format!("{}: no column {name}", file.display()))
    };
    let (way, force) = (column("beam/displacement")?, column("top/force")?);
    let point = |row: &str| {
        let cells: Vec<&str> = row.split(',').collect();
        let value = |at: usize| cells.get(at)?.parse::<f64>().ok();
        Some([1e3 * value(way)?, 1e-3 * value(force)?])
    };
    Ok(rows.filter_map(point).collect())
}

/// The measured side on which the wall was pushed forwards.
fn envelope(table: &str) -> Vec<[f64; 2]> {
    let point = |row: &str| {
        let mut cells = row.split(',').map(|c| c.trim().parse::<f64>().ok());
        Some([cells.next()??, cells.next()??])
    };
    table.lines().filter_map(point).filter(|p| p[0] >= 0.0 && p[0] <= 25.0).collect()
}
