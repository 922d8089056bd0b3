//! What is measured: systems, how their errors are told, and which program runs them at which tolerance how often.

use super::programs::Method;

/// A system to measure on.
pub struct Case {
    /// Its name in the data, on the command line and in names of pictures.
    pub name: &'static str,
    /// What it is, for the page.
    pub title: &'static str,
    /// Wall file from the root.
    pub wall: &'static str,
    /// What is replaced in the wall file, once; its duration is replaced always.
    pub changes: Vec<[String; 2]>,
    /// Whether it needs the record.
    pub record: bool,
    /// End of the motion and interval of the samples [s].
    pub duration: f64,
    pub interval: f64,
    /// How an error is told.
    pub judge: Judge,
    /// Runs in the order in which they are drawn.
    pub runs: Vec<Run>,
}

/// How the error of a run is told.
#[derive(Clone, Copy)]
pub enum Judge {
    /// Work [J] and rms force [N] of the top, with what they may differ by: where motion is chaotic.
    Account { work: f64, rms: f64, may: [f64; 2] },
    /// Displacements of all unknowns at all samples, against CVODE at these tolerances, over their peak.
    Histories { rtol: f64, atol: f64 },
}

/// A program at a tolerance.
#[derive(Clone, Copy)]
pub struct Run {
    pub method: Method,
    /// Relative tolerance, or the step [s] of a method with a fixed one.
    pub tolerance: f64,
    /// Absolute tolerance [m, m/s]; Concio has none.
    pub absolute: f64,
    /// How often it is timed.
    pub times: usize,
}

/// The tolerance of CVODE that the others are compared with.
pub const BASELINE: f64 = 1e-4;

/// Runs of one method at several tolerances.
fn runs(method: Method, tolerances: &[f64], absolute: f64, times: usize) -> Vec<Run> {
    tolerances.iter().map(|&tolerance| Run { method, tolerance, absolute, times }).collect()
}

/// All cases; `quick` ones are too short and too few to mean anything.
pub fn all(quick: bool) -> Vec<Case> {
    let mut all = vec![slipping(), slip_start(), shaken(), strong_motion(), large(), smooth(), one_block()];
    if quick {
        for case in &mut all {
            case.duration *= if case.record { 0.1 } else { 0.04 };
            case.runs.retain(|r| r.tolerance >= 1e-5);
            for run in &mut case.runs {
                run.times = 1;
            }
        }
    }
    all
}

fn slipping() -> Case {
    use Method::{Concio, Cvode};
    Case {
        name: "slipping",
        title: "6 × 4 panel (27 blocks), driven top, stick-slip at kilohertz, 0.5 s",
        wall: "xtask/walls/driven-top.toml",
        changes: Vec::new(),
        record: false,
        duration: 0.5,
        interval: 2.5e-4,
        // What CVODE comes to as its tolerance goes down (docs/performance.md).
        judge: Judge::Account { work: 47.16, rms: 1.2023e5, may: [5e-3, 2e-3] },
        runs: [
            runs(Concio, &[1e-1, 3e-2, 1e-2, 3e-3, 1e-3], 0.0, 5),
            runs(Concio, &[1e-4], 0.0, 3),
            runs(Cvode, &[1e-3], 1e-10, 1),
            runs(Cvode, &[BASELINE], 1e-10, 5),
            runs(Cvode, &[1e-5], 1e-11, 1),
        ]
        .concat(),
    }
}

/// Short enough for every program, and for motion not to be chaotic yet.
fn slip_start() -> Case {
    use Method::{Concio, ConcioOrder4, Cvode, DiffsolBdf, DiffsolTrBdf2, Lsoda, Radau};
    Case {
        name: "slip-start",
        title: "the first 20 ms of *slipping*: joints let go one after another",
        wall: "xtask/walls/driven-top.toml",
        changes: Vec::new(),
        record: false,
        duration: 0.02,
        interval: 1e-4,
        judge: Judge::Histories { rtol: 1e-9, atol: 1e-16 },
        runs: [
            runs(Concio, &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6], 0.0, 5),
            runs(ConcioOrder4, &[1e-3, 1e-4, 1e-5, 1e-6], 0.0, 3),
            runs(Cvode, &[1e-3, BASELINE, 1e-5, 1e-6], 1e-12, 5),
            runs(DiffsolBdf, &[1e-3, 1e-4, 1e-5], 1e-12, 1),
            runs(DiffsolTrBdf2, &[1e-3, 1e-4, 1e-5], 1e-12, 1),
            runs(Radau, &[1e-3, 1e-4], 1e-12, 1),
            runs(Lsoda, &[1e-3, 1e-4], 1e-12, 1),
        ]
        .concat(),
    }
}

fn shaken() -> Case {
    use Method::{Concio, ConcioOrder4, Cvode};
    Case {
        name: "shaken",
        title: "the same panel, free top, 2 kN/m, Norcia 2016-10-30 (HGE) × 1.7, 20 s",
        wall: "xtask/walls/ground-shaking.toml",
        changes: vec![["[solver]\ntolerance = 1e-6\n".into(), String::new()]],
        record: true,
        duration: 20.0,
        interval: 5e-3,
        judge: Judge::Histories { rtol: 1e-8, atol: 1e-16 },
        runs: [
            runs(Concio, &[1e-1, 3e-2, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6], 0.0, 5),
            runs(ConcioOrder4, &[1e-1, 1e-3, 1e-5, 1e-6], 0.0, 3),
            runs(Cvode, &[1e-3, BASELINE], 1e-10, 5),
            runs(Cvode, &[1e-5, 1e-6], 1e-12, 3),
        ]
        .concat(),
    }
}

fn strong_motion() -> Case {
    use Method::{Concio, Cvode, DiffsolBdf, DiffsolTrBdf2, Lsoda, Radau};
    Case {
        name: "strong-motion",
        title: "one second of *shaken*, at its strongest",
        wall: "xtask/walls/ground-shaking.toml",
        changes: vec![
            ["[solver]\ntolerance = 1e-6\n".into(), String::new()],
            ["scale = 1.7".into(), "scale = 1.7, trim = [\"TRIM s\", \"40 s\"]".replace("TRIM", STRONGEST)],
        ],
        record: true,
        duration: 1.0,
        interval: 5e-3,
        judge: Judge::Histories { rtol: 1e-8, atol: 1e-16 },
        runs: [
            runs(Concio, &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6], 0.0, 5),
            runs(Cvode, &[1e-3, BASELINE], 1e-10, 5),
            runs(Cvode, &[1e-5, 1e-6], 1e-12, 5),
            runs(DiffsolBdf, &[1e-3, 1e-4, 1e-5], 1e-12, 1),
            runs(DiffsolTrBdf2, &[1e-3, 1e-4, 1e-5], 1e-12, 1),
            runs(Radau, &[1e-3, 1e-4], 1e-12, 1),
            runs(Lsoda, &[1e-3, 1e-4], 1e-12, 1),
        ]
        .concat(),
    }
}

fn large() -> Case {
    use Method::{Concio, Cvode};
    Case {
        name: "large",
        title: "20 × 20 panel (410 blocks), shaken likewise, 20 s",
        wall: "xtask/walls/large.toml",
        changes: Vec::new(),
        record: true,
        duration: 20.0,
        interval: 2e-2,
        judge: Judge::Histories { rtol: 1e-8, atol: 1e-16 },
        runs: [
            runs(Concio, &[1e-1, 3e-2, 1e-2, 1e-3, 1e-4, 1e-5], 0.0, 3),
            runs(Cvode, &[1e-3], 1e-10, 1),
            runs(Cvode, &[BASELINE], 1e-10, 3),
        ]
        .concat(),
    }
}

fn smooth() -> Case {
    use Method::{Concio, ConcioOrder4, Cvode, DiffsolBdf, DiffsolTrBdf2, Lsoda, Radau};
    Case {
        name: "smooth",
        title: "the same panel with laws that have no corner, 50 ms",
        wall: "xtask/walls/smooth.toml",
        changes: Vec::new(),
        record: false,
        duration: 0.05,
        interval: 1e-3,
        judge: Judge::Histories { rtol: 1e-12, atol: 1e-18 },
        runs: [
            runs(Concio, &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7], 0.0, 5),
            runs(ConcioOrder4, &[1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8], 0.0, 5),
            runs(Cvode, &[1e-3, BASELINE, 1e-5, 1e-6, 1e-7, 1e-8], 1e-13, 5),
            runs(DiffsolBdf, &[1e-3, 1e-4, 1e-5, 1e-6, 1e-7], 1e-13, 3),
            runs(DiffsolTrBdf2, &[1e-3, 1e-4, 1e-5, 1e-6, 1e-7], 1e-13, 3),
            runs(Radau, &[1e-3, 1e-4, 1e-5], 1e-13, 1),
            runs(Lsoda, &[1e-3, 1e-4, 1e-5, 1e-6], 1e-13, 1),
        ]
        .concat(),
    }
}

fn one_block() -> Case {
    use Method::{Concio, Cvode, DiffsolBdf, DiffsolTrBdf2, Lsoda, Radau};
    Case {
        name: "one-block",
        title: "one brick on a spring, dragged by a sliding beam: stick-slip without chaos, 0.2 s",
        wall: "xtask/walls/one-block.toml",
        changes: Vec::new(),
        record: false,
        duration: 0.2,
        interval: 1e-3,
        judge: Judge::Histories { rtol: 1e-11, atol: 1e-17 },
        runs: [
            runs(Concio, &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6], 0.0, 5),
            runs(Cvode, &[1e-3, BASELINE, 1e-5, 1e-6, 1e-7], 1e-12, 5),
            runs(DiffsolBdf, &[1e-3, 1e-4, 1e-5, 1e-6], 1e-12, 1),
            runs(DiffsolTrBdf2, &[1e-3, 1e-4, 1e-5, 1e-6], 1e-12, 1),
            runs(Radau, &[1e-3, 1e-4, 1e-5], 1e-12, 1),
            runs(Lsoda, &[1e-3, 1e-4, 1e-5, 1e-6], 1e-12, 1),
        ]
        .concat(),
    }
}

/// Where the second of *strong-motion* begins in the record [s].
const STRONGEST: &str = "11.8";
