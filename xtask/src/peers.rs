//! Solves the same systems with SUNDIALS CVODE and compares. The peer program knows nothing of walls: it reads what
//! `concio system` prints, so that assembly and integration are checked apart (peers/README.md). A case whose record is
//! not beside the project (`CONCIO_SHARED`, else ../shared) is skipped.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::command::{Outcome, read};
use crate::{concio, histories};

/// Libraries and flags of the peer program.
const FLAGS: [&str; 9] = [
    "-O3",
    "-march=native",
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
pub const RECORD: &str = "records/itaca_esm/IT.NRC..HGE.D.20161030.064018.C.ACC.ASC";

/// A system that both solve.
struct Case<'a> {
    name: &'a str,
    wall: String,
    /// Relative and absolute tolerance of CVODE.
    tolerances: [&'a str; 2],
    /// Keys that both summaries have, and how far they may differ from each other.
    agree: Vec<(&'a str, f64)>,
    /// How far displacements may differ at any instant, over the peak; none where motion is chaotic.
    histories: Option<f64>,
}

/// Compares all cases.
pub fn compare(root: &Path) -> Outcome {
    let folder = root.join("target/peers");
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let peer = folder.join("cvode_shear");
    if let Err(why) = compile(root, &peer) {
        if Path::new("/usr/include/cvode/cvode.h").is_file() && Path::new("/usr/include/nlohmann/json.hpp").is_file() {
            return Err(format!("the libraries are there but the peer program does not compile: {why}"));
        }
        crate::command::skip(&format!(
            "comparison with CVODE (it cannot be compiled here: {})",
            why.lines().next().unwrap_or("")
        ));
        return Ok(());
    }
    let peak: (&str, f64) = ("peak_relative_displacement", 1e-3);
    let file = |path: &str| fs::read_to_string(root.join(path)).map_err(|e| format!("{path}: {e}"));
    let mut cases = vec![
        Case {
            name: "frictionless",
            wall: file("examples/08-frictionless.toml")?,
            tolerances: ["1e-8", "1e-14"],
            agree: vec![peak, ("top_force_peak", 1e-2)],
            histories: Some(5e-3),
        },
        Case {
            name: "slipping",
            wall: file("xtask/walls/driven-top.toml")?,
            tolerances: ["1e-4", "1e-10"],
            agree: vec![("top_work", 1e-2), ("top_force_peak", 1e-2), ("peak_relative_displacement", 1e-2)],
            histories: None,
        },
    ];
    match shared(root).join(RECORD).canonicalize() {
        Ok(record) => cases.push(Case {
            name: "ground-shaking",
            wall: file("xtask/walls/ground-shaking.toml")?.replace("RECORD", &record.to_string_lossy()),
            tolerances: ["1e-8", "1e-16"],
            agree: vec![peak],
            histories: Some(5e-3),
        }),
        Err(_) => crate::command::skip("comparison with CVODE under ground shaking (shared/ not found)"),
    }
    cases.iter().try_for_each(|case| one(root, &folder, &peer, case).map_err(|why| format!("{}: {why}", case.name)))
}

/// Larger reference data beside the project.
pub fn shared(root: &Path) -> PathBuf {
    std::env::var_os("CONCIO_SHARED").map_or_else(|| root.join("../shared"), PathBuf::from)
}

/// Compiles the program that calls CVODE.
pub fn compile(root: &Path, program: &Path) -> Outcome {
    read(Command::new("g++").arg(root.join("peers/cvode_shear.cpp")).arg("-o").arg(program).args(FLAGS)).map(drop)
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
    for &(key, tolerance) in &case.agree {
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
    let found = histories::of_concio(&out.join("csv/histories.csv"))?;
    let difference = histories::difference(&found, &histories::of_peer(&history)?)?;
    println!("{:<15} histories of all blocks differ by {difference:.1e} of the peak", case.name);
    if difference <= tolerance { Ok(()) } else { Err(format!("histories may differ by {tolerance} only")) }
}

fn number_table(text: &str) -> Result<Value, String> {
    serde_json::from_str(text).map_err(|e| format!("not JSON: {e}"))
}

fn number(table: &Value, key: &str) -> Result<f64, String> {
    table.get(key).and_then(Value::as_f64).ok_or_else(|| format!("`{key}` is missing"))
}
