//! `cargo xtask schemes`: the tables of docs/decisions/0007-schemes.md, from peers/schemes at fixed steps on a smooth and a
//! slipping system. They are printed, not written: what follows from them is said by hand.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::command::{Outcome, cargo, read};
use crate::{concio, histories, peers};

/// Steps on the smooth system [s], each half of the one before.
const HALVES: [&str; 4] = ["1e-4", "5e-5", "2.5e-5", "1.25e-5"];
/// Error of the reference there, about.
const EXACT: f64 = 1e-10;
/// Methods there.
const SMOOTH: [&str; 8] =
    ["backward-euler", "midpoint", "energy", "theta", "moreau-jean-law", "tr-bdf2", "esdirk4", "explicit-law"];
/// Methods and steps [s] on the slipping system; what is not here takes minutes or is unstable.
const SLIPPING: [(&str, &[&str]); 7] = [
    ("backward-euler", &["2e-5", "1e-5", "5e-6"]),
    ("midpoint", &["2e-5", "1e-5", "5e-6"]),
    ("energy", &["2e-5", "1e-5", "5e-6"]),
    ("theta", &["1e-5", "5e-6"]),
    ("tr-bdf2", &["4e-5", "2e-5", "1e-5"]),
    ("esdirk4", &["4e-5", "2e-5", "1e-5"]),
    ("explicit", &["2e-6"]),
];
/// Methods on its first 20 ms.
const START: [(&str, &[&str]); 3] =
    [("moreau-jean", &["4e-5", "1e-5"]), ("moreau-jean-1", &["4e-5", "1e-5"]), ("tr-bdf2", &["4e-5", "1e-5"])];

/// Prints the tables.
pub fn compare(root: &Path) -> Outcome {
    let folder = root.join("target/schemes");
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let cvode = folder.join("cvode_shear");
    peers::compile(root, &cvode)?;
    read(cargo(root).args(["build", "--quiet", "--release", "--locked", "--package", "schemes"]))?;
    let program = concio(root).with_file_name(format!("schemes{}", std::env::consts::EXE_SUFFIX));
    let bench = Bench { program, cvode, folder };
    println!("Smooth system (xtask/walls/smooth.toml), largest error of the histories over the peak:\n");
    smooth(&bench, &bench.system(root, "xtask/walls/smooth.toml", None)?)?;
    println!("\nSlipping system (xtask/walls/driven-top.toml, 0.5 s):\n");
    slipping(&bench, &bench.system(root, "xtask/walls/driven-top.toml", None)?, &SLIPPING)?;
    println!("\nIts first 20 ms:\n");
    slipping(&bench, &bench.system(root, "xtask/walls/driven-top.toml", Some(0.02))?, &START)
}

/// Where the programs are.
struct Bench {
    program: PathBuf,
    cvode: PathBuf,
    folder: PathBuf,
}

impl Bench {
    /// Prints the system of a wall file, its motion cut off.
    fn system(&self, root: &Path, wall: &str, duration: Option<f64>) -> Result<PathBuf, String> {
        let text = read(Command::new(concio(root)).arg("system").arg(root.join(wall)))?;
        let mut system: Value = serde_json::from_str(&text).map_err(|e| e.to_string())?;
        if let Some(duration) = duration {
            system["duration"] = duration.into();
        }
        let path = self.folder.join("system.json");
        fs::write(&path, system.to_string()).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(path)
    }

    /// Runs a method; what it says, and its histories.
    fn run(&self, method: &str, system: &Path, step: &str, interval: &str) -> Result<(Value, Vec<f64>), String> {
        let out = self.folder.join("history.bin");
        let said = read(Command::new(&self.program).args([method]).arg(system).args([step, "0", interval]).arg(&out))?;
        Ok((serde_json::from_str(&said).map_err(|e| e.to_string())?, histories::of_peer(&out)?))
    }

    /// The same of CVODE.
    fn reference(&self, system: &Path, tolerances: [&str; 2], interval: &str) -> Result<(Value, Vec<f64>), String> {
        let out = self.folder.join("reference.bin");
        let said = read(Command::new(&self.cvode).arg(system).args(tolerances).arg(interval).arg(&out))?;
        Ok((serde_json::from_str(&said).map_err(|e| e.to_string())?, histories::of_peer(&out)?))
    }
}

fn smooth(bench: &Bench, system: &Path) -> Outcome {
    let (_, exact) = bench.reference(system, ["1e-12", "1e-18"], "1e-3")?;
    println!(
        "| scheme | {} | order | factorisations a step |\n|---|{}---|---|",
        HALVES.join(" s | "),
        "---|".repeat(4)
    );
    for method in SMOOTH {
        let (mut errors, mut factorisations) = (Vec::new(), 0.0);
        for step in HALVES {
            let (said, found) = bench.run(method, system, step, "1e-3")?;
            errors.push(histories::difference(&found, &exact)?);
            factorisations = number(&said, "factorisations") / number(&said, "steps");
        }
        // Between the last two that lie above what the reference is off by.
        let last = errors.iter().rposition(|e| *e > EXACT).unwrap_or(1).max(1);
        let order = (errors[last - 1] / errors[last]).log2();
        let cells: Vec<String> = errors.iter().map(|e| format!("{e:.1e}")).collect();
        println!("| {method} | {} | {order:.1} | {factorisations:.1} |", cells.join(" | "));
    }
    Ok(())
}

fn slipping(bench: &Bench, system: &Path, methods: &[(&str, &[&str])]) -> Outcome {
    println!(
        "| scheme | step [s] | work [J] | rms force [kN] | slip [mm] | factorisations | iterations a step | stages cut off | time over CVODE's |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let (said, _) = bench.reference(system, ["1e-4", "1e-10"], "2e-5")?;
    let base = number(&said, "solve_seconds");
    row("CVODE, rtol 10⁻⁴", "", &said, base);
    for (method, steps) in methods {
        for step in *steps {
            let (said, _) = bench.run(method, system, step, "1e-3")?;
            row(method, step, &said, base);
        }
    }
    Ok(())
}

fn row(method: &str, step: &str, said: &Value, base: f64) {
    let of = |key: &str| number(said, key);
    println!(
        "| {method} | {step} | {:.3} | {:.3} | {:.1} | {:.0} | {:.1} | {:.0} | {:.2} |",
        of("top_work"),
        1e-3 * of("top_force_rms"),
        1e3 * of("slip"),
        of("factorisations"),
        of("iterations") / of("steps"),
        of("unconverged"),
        of("solve_seconds") / base
    );
}

/// A number, or what is not one where a program does not tell it.
fn number(said: &Value, key: &str) -> f64 {
    said.get(key).and_then(Value::as_f64).unwrap_or(f64::NAN)
}
