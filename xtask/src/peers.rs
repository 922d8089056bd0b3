//! Solves the same systems with SUNDIALS CVODE and compares. The peer program knows nothing of walls: it reads what
//! `concio system` prints, so that assembly and integration are checked apart. It lies beside the project
//! (`CONCIO_SHARED`, else ../shared) and is not part of it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::command::{Outcome, read};
use crate::concio;

/// Libraries and flags of the peer program.
const FLAGS: [&str; 8] = [
    "-O3",
    "-std=c++17",
    "-I/usr/include/suitesparse",
    "-lsundials_cvode",
    "-lsundials_sunlinsolklu",
    "-lsundials_sunmatrixsparse",
    "-lsundials_nvecserial",
    "-lklu",
];
/// Interval at which histories are compared [s].
const INTERVAL: f64 = 1e-3;
/// The record of the ground shaking, in the folder beside the project.
const RECORD: &str = "records/itaca_esm/IT.NRC..HGE.D.20161030.064018.C.ACC.ASC";

/// A system that both solve.
struct Case<'a> {
    name: &'a str,
    wall: String,
    /// Relative and absolute tolerance of CVODE.
    tolerances: [&'a str; 2],
    /// Keys that both summaries have, and how far they may differ from each other.
    agree: &'a [(&'a str, f64)],
    /// How far displacements may differ at any instant, over the peak; none where motion is chaotic.
    histories: Option<f64>,
}

/// Compares all cases.
pub fn compare(root: &Path) -> Outcome {
    let shared = std::env::var_os("CONCIO_SHARED").map_or_else(|| root.join("../shared"), PathBuf::from);
    let source = shared.join("peers/cvode_shear.cpp");
    if !source.is_file() {
        println!("skipped: comparison with CVODE (shared/ not found)");
        return Ok(());
    }
    let folder = root.join("target/peers");
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let peer = folder.join("cvode_shear");
    if let Err(why) = read(Command::new("g++").arg(&source).arg("-o").arg(&peer).args(FLAGS)) {
        if Path::new("/usr/include/cvode/cvode.h").is_file() && Path::new("/usr/include/nlohmann/json.hpp").is_file() {
            return Err(format!("the libraries are there but the peer program does not compile: {why}"));
        }
        println!("skipped: comparison with CVODE (it cannot be compiled here: {})", why.lines().next().unwrap_or(""));
        return Ok(());
    }
    let peak = ("peak_relative_displacement", 1e-3);
    let file = |path: &str| fs::read_to_string(root.join(path)).map_err(|e| format!("{path}: {e}"));
    let record = shared.join(RECORD);
    let record = record.canonicalize().map_err(|e| format!("{}: {e}", record.display()))?;
    let cases = [
        Case {
            name: "frictionless",
            wall: file("examples/08-frictionless.toml")?,
            tolerances: ["1e-8", "1e-14"],
            agree: &[peak, ("top_force_peak", 1e-2)],
            histories: Some(5e-3),
        },
        Case {
            name: "ground-shaking",
            wall: file("xtask/walls/ground-shaking.toml")?.replace("RECORD", &record.to_string_lossy()),
            tolerances: ["1e-8", "1e-16"],
            agree: &[peak],
            histories: Some(5e-3),
        },
        Case {
            name: "slipping",
            wall: file("examples/02-driven-top.toml")?,
            tolerances: ["1e-4", "1e-10"],
            agree: &[("top_work", 1e-2), ("top_force_peak", 1e-2), ("peak_relative_displacement", 1e-2)],
            histories: None,
        },
    ];
    cases.iter().try_for_each(|case| one(root, &folder, &peer, case).map_err(|why| format!("{}: {why}", case.name)))
}

fn one(root: &Path, folder: &Path, peer: &Path, case: &Case) -> Outcome {
    let (wall, out) = (folder.join(format!("{}.toml", case.name)), folder.join(case.name));
    let system = folder.join(format!("{}.json", case.name));
    let history = folder.join(format!("{}.bin", case.name));
    let write = |path: &Path, text: &str| fs::write(path, text).map_err(|e| format!("{}: {e}", path.display()));
    write(&wall, &format!("{}\n[output]\ninterval = {INTERVAL}\nblocks = [\"all\"]\n", case.wall))?;
    let concio = || Command::new(concio(root));
    write(&system, &read(concio().arg("system").arg(&wall))?)?;
    read(concio().arg("run").arg(&wall).arg("--fresh").arg("--out").arg(&out))?;
    read(concio().arg("export").arg(&out).arg("--csv"))?;
    let mut solve = Command::new(peer);
    solve.arg(&system).args(case.tolerances).arg(INTERVAL.to_string()).arg(&history);
    let theirs = number_table(&read(&mut solve)?)?;
    let text = fs::read_to_string(out.join("summary.json")).map_err(|e| e.to_string())?;
    let ours = number_table(&text)?;
    for &(key, tolerance) in case.agree {
        let (a, b) = (number(&ours, key)?, number(&theirs, key)?);
        let difference = (a - b).abs() / b.abs();
        println!("{:<15} {key:<27} {a:>14.7e}  CVODE {b:>14.7e}  differs by {difference:.1e}", case.name);
        if !(difference <= tolerance) {
            return Err(format!("{key} may differ by {tolerance} only"));
        }
    }
    println!(
        "{:<15} solver time {:.2} s, CVODE {:.2} s",
        case.name,
        number(&ours, "solve_seconds")?,
        number(&theirs, "solve_seconds")?
    );
    let Some(tolerance) = case.histories else { return Ok(()) };
    let peak = number(&theirs, "peak_relative_displacement")?;
    let difference = largest_difference(&out.join("csv/histories.csv"), &history)? / peak;
    println!("{:<15} histories of all blocks differ by {difference:.1e} of the peak", case.name);
    if difference <= tolerance { Ok(()) } else { Err(format!("histories may differ by {tolerance} only")) }
}

fn number_table(text: &str) -> Result<Value, String> {
    serde_json::from_str(text).map_err(|e| format!("not JSON: {e}"))
}

fn number(table: &Value, key: &str) -> Result<f64, String> {
    table.get(key).and_then(Value::as_f64).ok_or_else(|| format!("`{key}` is missing"))
}

/// Largest difference between the displacements in a table of ours and those in a file of CVODE, which has no row for
/// t = 0 and holds the blocks in our order.
fn largest_difference(ours: &Path, theirs: &Path) -> Result<f64, String> {
    let text = fs::read_to_string(ours).map_err(|e| format!("{}: {e}", ours.display()))?;
    let bytes = fs::read(theirs).map_err(|e| format!("{}: {e}", theirs.display()))?;
    let values: Vec<f64> = bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    let mut lines = text.lines();
    let header = lines.next().unwrap_or("");
    let is_block = |name: &str| name.trim_matches('"').starts_with("block/") && name.contains("/displacement");
    let columns: Vec<usize> = header.split(',').enumerate().filter(|(_, n)| is_block(n)).map(|(k, _)| k).collect();
    if columns.is_empty() || !values.len().is_multiple_of(columns.len()) {
        return Err(format!("{} columns of blocks, {} values of CVODE", columns.len(), values.len()));
    }
    let rows: Vec<&str> = lines.skip(1).collect();
    let samples = values.len() / columns.len();
    if rows.len() < samples {
        return Err(format!("{} samples of ours, {samples} of CVODE", rows.len()));
    }
    let mut largest = 0.0;
    for (row, theirs) in rows.iter().zip(values.chunks_exact(columns.len())) {
        let cells: Vec<&str> = row.split(',').collect();
        for (&column, theirs) in columns.iter().zip(theirs) {
            let ours: f64 = cells.get(column).and_then(|c| c.parse().ok()).ok_or("a cell is no number")?;
            // A value that is not a number must not pass for a small difference.
            largest = f64::max(largest, if ours.is_nan() { f64::INFINITY } else { (ours - theirs).abs() });
        }
    }
    Ok(largest)
}
