//! Runs of a case, all programs in turn, and the data that is kept of them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::cases::{BASELINE, Case, Judge, Run};
use super::machine::Machine;
use super::programs::{Family, Method, Program};
use crate::command::{Outcome, read};
use crate::histories;
use crate::peers::{RECORD, shared};

/// Time by the clock after which a run is stopped [s].
const LONGEST: f64 = 150.0;
/// Time by the clock after which a run is not repeated [s].
const LONG: f64 = 20.0;

/// Everything that was measured.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Performance {
    /// The machine of the last measurement.
    pub machine: Machine,
    /// By name of the case.
    pub cases: BTreeMap<String, Measured>,
    /// What benchmarks of Concio alone printed, by name.
    #[serde(default)]
    pub printed: BTreeMap<String, Printed>,
}

/// What a benchmark printed.
#[derive(Debug, Serialize, Deserialize)]
pub struct Printed {
    /// Day of the measurement, and the processor that it was made on where that is not the machine of the others.
    pub date: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub processor: String,
    pub text: String,
}

/// One case.
#[derive(Debug, Serialize, Deserialize)]
pub struct Measured {
    pub title: String,
    /// Day of the measurement.
    pub date: String,
    pub unknowns: u64,
    pub joints: u64,
    /// End of the motion and interval of the samples [s].
    pub duration: f64,
    pub interval: f64,
    /// What errors are told against.
    pub reference: String,
    /// Peak displacement of the reference [m]; of a case judged by work and force none.
    pub peak: Option<f64>,
    pub runs: Vec<Timed>,
}

/// One program at one tolerance.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Timed {
    pub program: String,
    /// Relative tolerance.
    pub tolerance: f64,
    /// Absolute tolerance.
    pub absolute: f64,
    /// Solver time of every repetition [s]; empty where it did not come to an end.
    pub seconds: Vec<f64>,
    /// Why not.
    pub stopped: Option<String>,
    pub steps: u64,
    pub factorisations: Option<u64>,
    /// Largest difference from the reference, over its peak.
    pub error: Option<f64>,
    /// Work [J] and rms force [N] of the top.
    pub work: f64,
    pub rms: f64,
}

impl Timed {
    /// Median of the times; of two the mean.
    pub fn median(&self) -> Option<f64> {
        let mut sorted = self.seconds.clone();
        sorted.sort_by(f64::total_cmp);
        let n = sorted.len();
        (n > 0).then(|| 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]))
    }
}

/// What was measured before, or nothing.
pub fn load(path: &Path) -> Result<Performance, String> {
    match fs::read_to_string(path) {
        Ok(text) => serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display())),
        Err(_) => Ok(Performance::default()),
    }
}

/// Writes it down.
pub fn save(all: &Performance, path: &Path) -> Outcome {
    let text = serde_json::to_string_pretty(all).map_err(|e| e.to_string())?;
    fs::write(path, text + "\n").map_err(|e| format!("{}: {e}", path.display()))
}

/// The files of a case.
struct Desk {
    folder: PathBuf,
    wall: String,
    system: PathBuf,
}

/// Measures a case with the programs that are there; `None` where its record is not.
pub fn case(root: &Path, folder: &Path, case: &Case, programs: &[Program]) -> Result<Option<Measured>, String> {
    println!("\n== {}: {}", case.name, case.title);
    let Some(wall) = wall(root, case)? else {
        crate::command::skip(&format!("{} (its record is not beside the project)", case.name));
        return Ok(None);
    };
    let desk = desk(root, folder, case, wall)?;
    let system = number_table(&fs::read_to_string(&desk.system).map_err(|e| e.to_string())?)?;
    let count = |key: &str| system.get(key).and_then(Value::as_array).map_or(0, |a| a.len() as u64);
    let (reference, history) = reference(&desk, case, programs)?;
    let planned: Vec<(&Run, &Program)> = case
        .runs
        .iter()
        .filter_map(|run| programs.iter().find(|p| p.family == run.method.family()).map(|p| (run, p)))
        .collect();
    let mut runs = Vec::new();
    for (run, program) in &planned {
        runs.push(first(root, &desk, case, run, program, history.as_deref())?);
        shown(&runs[runs.len() - 1]);
    }
    // In turn, so that what else the machine does falls on all.
    for round in 1..planned.iter().map(|(run, _)| run.times).max().unwrap_or(0) {
        println!("   round {} of the others", round + 1);
        for ((run, program), timed) in planned.iter().zip(&mut runs) {
            let once_more = round < run.times && timed.seconds.first().is_some_and(|s| *s < LONG);
            if once_more {
                let (values, _) = call(&desk, case, run, program, false)?;
                timed.seconds.push(number(&values?, "solve_seconds")?);
            }
        }
    }
    Ok(Some(Measured {
        title: case.title.into(),
        date: super::machine::today(),
        unknowns: count("mass"),
        joints: count("joints"),
        duration: case.duration,
        interval: case.interval,
        reference,
        peak: history.as_deref().map(histories::peak),
        runs,
    }))
}

/// The wall file of a case; `None` where it needs the record and that is missing.
fn wall(root: &Path, case: &Case) -> Result<Option<String>, String> {
    let mut text = fs::read_to_string(root.join(case.wall)).map_err(|e| format!("{}: {e}", case.wall))?;
    if case.record {
        let Ok(record) = shared(root).join(RECORD).canonicalize() else { return Ok(None) };
        text = text.replace("RECORD", &record.to_string_lossy());
    }
    for [from, to] in &case.changes {
        if !text.contains(from) {
            return Err(format!("{} has no `{}` to replace", case.wall, from.trim()));
        }
        text = text.replacen(from, to, 1);
    }
    let mut durations = 0;
    let line = |line: &str| {
        if line.starts_with("duration = ") {
            durations += 1;
            return format!("duration = {}\n", case.duration);
        }
        format!("{line}\n")
    };
    let text: String = text.lines().map(line).collect();
    if durations == 1 { Ok(Some(text)) } else { Err(format!("{} should have one duration", case.wall)) }
}

fn desk(root: &Path, folder: &Path, case: &Case, wall: String) -> Result<Desk, String> {
    let folder = folder.join(format!("{}-{}", case.name, case.duration));
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let (file, system) = (folder.join("wall.toml"), folder.join("system.json"));
    fs::write(&file, &wall).map_err(|e| format!("{}: {e}", file.display()))?;
    let text = read(Command::new(crate::concio(root)).arg("system").arg(&file))?;
    fs::write(&system, text).map_err(|e| format!("{}: {e}", system.display()))?;
    Ok(Desk { folder, wall, system })
}

/// What errors are told against, in words and as displacements. A reference that was computed of the same system is
/// taken again.
fn reference(desk: &Desk, case: &Case, programs: &[Program]) -> Result<(String, Option<Vec<f64>>), String> {
    let (rtol, atol) = match case.judge {
        Judge::Account { work, rms, .. } => return Ok((format!("work {work} J, rms force {rms:.0} N"), None)),
        Judge::Histories { rtol, atol } => (rtol, atol),
    };
    let words = format!("CVODE at rtol {rtol:e}, atol {atol:e}");
    let (values, key) = (desk.folder.join("reference.bin"), desk.folder.join("reference.txt"));
    let system = fs::read_to_string(&desk.system).map_err(|e| e.to_string())?;
    let made_from = format!("{words}, samples every {} s\n{system}", case.interval);
    if fs::read_to_string(&key).ok().as_ref() != Some(&made_from) {
        println!("   reference: {words}");
        let cvode = programs.iter().find(|p| p.family == Family::Cvode).ok_or("CVODE is missing")?;
        let mut solve = cvode.command();
        solve.arg(&desk.system).args([rtol, atol, case.interval].map(|v| format!("{v:e}"))).arg(&values);
        read(&mut solve)?;
        fs::write(&key, made_from).map_err(|e| format!("{}: {e}", key.display()))?;
    }
    Ok((words, Some(histories::of_peer(&values)?)))
}

/// The first run at a tolerance, which tells the error too.
fn first(
    root: &Path,
    desk: &Desk,
    case: &Case,
    run: &Run,
    program: &Program,
    reference: Option<&[f64]>,
) -> Result<Timed, String> {
    let mut timed = Timed {
        program: run.method.name().into(),
        tolerance: run.tolerance,
        absolute: run.absolute,
        seconds: Vec::new(),
        stopped: None,
        steps: 0,
        factorisations: None,
        error: None,
        work: 0.0,
        rms: 0.0,
    };
    let (values, files) = call(desk, case, run, program, false)?;
    let values = match values {
        Ok(values) => values,
        Err(why) => {
            timed.stopped = Some(why);
            return Ok(timed);
        }
    };
    timed.seconds.push(number(&values, "solve_seconds")?);
    timed.steps = number(&values, "steps")? as u64;
    let factorisations = values.get("factorisations").or_else(|| values.pointer("/counters/factorisations"));
    timed.factorisations = factorisations.and_then(Value::as_u64);
    (timed.work, timed.rms) = (number(&values, "top_work")?, number(&values, "top_force_rms")?);
    if let Some(reference) = reference {
        let found = if program.family == Family::Concio {
            // Histories of all blocks cost time to write: not in the run that is timed.
            let (values, out) = call(desk, case, run, program, true)?;
            values?;
            read(Command::new(crate::concio(root)).arg("export").arg(&out).arg("--csv"))?;
            histories::of_concio(&out.join("csv/histories.csv"))?
        } else {
            histories::of_peer(&files)?
        };
        timed.error = Some(histories::difference(&found, reference)?);
    }
    Ok(timed)
}

/// Calls a program: what it says or why it was stopped, and where its histories are.
fn call(
    desk: &Desk,
    case: &Case,
    run: &Run,
    program: &Program,
    all_blocks: bool,
) -> Result<(Result<Value, String>, PathBuf), String> {
    if program.family == Family::Concio {
        let file = desk.folder.join("concio.toml");
        let blocks = if all_blocks { "blocks = [\"all\"]\n" } else { "" };
        let text = format!(
            "{}\n[output]\ninterval = {}\n{blocks}[solver]\nscheme = \"{}\"\ntolerance = {:e}\n",
            desk.wall,
            case.interval,
            run.method.word(),
            run.tolerance
        );
        fs::write(&file, text).map_err(|e| format!("{}: {e}", file.display()))?;
        let out = desk.folder.join("concio");
        let mut solve = program.command();
        solve.arg("run").arg(&file).arg("--fresh").arg("--out").arg(&out);
        if let Err(why) = limited(&mut solve)? {
            return Ok((Err(why), out));
        }
        let summary = fs::read_to_string(out.join("summary.json")).map_err(|e| e.to_string())?;
        return Ok((Ok(number_table(&summary)?), out));
    }
    let history = desk.folder.join("history.bin");
    let mut solve = program.command();
    let numbers = [run.tolerance, run.absolute, case.interval].map(|v| format!("{v:e}"));
    solve.args(Some(run.method.word()).filter(|w| !w.is_empty())).arg(&desk.system).args(numbers).arg(&history);
    match limited(&mut solve)? {
        Ok(text) => Ok((Ok(number_table(&text)?), history)),
        Err(why) => Ok((Err(why), history)),
    }
}

/// Runs a program, at most [`LONGEST`]; what it printed, or why it did not end well.
fn limited(command: &mut Command) -> Result<Result<String, String>, String> {
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|e| e.to_string())?;
    let start = Instant::now();
    loop {
        if child.try_wait().map_err(|e| e.to_string())?.is_some() {
            break;
        }
        if start.elapsed().as_secs_f64() > LONGEST {
            child.kill().and_then(|()| child.wait().map(drop)).map_err(|e| e.to_string())?;
            return Ok(Err(format!("not done after {LONGEST:.0} s")));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().map_err(|e| e.to_string())?;
    if output.status.success() {
        return Ok(Ok(String::from_utf8_lossy(&output.stdout).into_owned()));
    }
    let errors = String::from_utf8_lossy(&output.stderr);
    Ok(Err(errors.lines().rfind(|l| !l.trim().is_empty()).unwrap_or("failed").trim().to_string()))
}

fn shown(run: &Timed) {
    let seconds = run.median().map_or_else(|| run.stopped.clone().unwrap_or_default(), |s| format!("{s:>9.4} s"));
    let error = run.error.map_or(String::new(), |e| format!("  error {e:.2e}"));
    let work = if run.work == 0.0 { String::new() } else { format!("  {:.4} J  {:.1} N", run.work, run.rms) };
    println!("   {:<18} {:>7.0e} {seconds}  {:>8} steps{error}{work}", run.program, run.tolerance, run.steps);
}

/// The run that the others of a case are compared with.
pub fn baseline(measured: &Measured) -> Option<&Timed> {
    measured.runs.iter().find(|r| r.program == Method::Cvode.name() && r.tolerance == BASELINE)
}

fn number_table(text: &str) -> Result<Value, String> {
    serde_json::from_str(text).map_err(|e| format!("not JSON: {e}"))
}

fn number(table: &Value, key: &str) -> Result<f64, String> {
    table.get(key).and_then(Value::as_f64).ok_or_else(|| format!("`{key}` is missing"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_times() {
        let mut run = Timed {
            program: String::new(),
            tolerance: 0.0,
            absolute: 0.0,
            seconds: vec![3.0, 1.0, 10.0],
            stopped: None,
            steps: 0,
            factorisations: None,
            error: None,
            work: 0.0,
            rms: 0.0,
        };
        assert_eq!(run.median(), Some(3.0));
        run.seconds.push(2.0);
        assert_eq!(run.median(), Some(2.5));
        run.seconds.clear();
        assert_eq!(run.median(), None);
    }

    #[test]
    fn programs_that_fail_say_why() {
        let mut fails = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        assert!(limited(fails.arg("--no-such-option")).expect("it starts").is_err());
    }
}
