//! Runs of a batch are the runs that they would be alone.

use std::path::Path;
use std::sync::Mutex;

use concio::case::{Scheme, Syntax, from_str};
use concio::many::{Job, simulate_each, simulate_many};
use concio::outcome::Outcome;
use concio::record::StopReason;
use concio::run::{Control, Prepared, prepare_case, run_in_memory};

const PANEL: &str = r#"
model = "shear"
set = "report"
[[panel]]
bond = "running"
courses = 4
bricks = 3
"#;
const FRICTION: &str = r#"
[joint]
friction = { law = "stribeck", static = 0.6, dynamic = 0.42 }
"#;
const DRIVEN: &str = r#"
[load]
top = "10 kN/m"
beam = "driven"
[motion]
duration = "0.03 s"
top = { sine = { amplitude = "10 mm", frequency = "3 Hz" } }
"#;
const SHAKEN: &str = r#"
[load]
top = "2 kN/m"
[motion]
duration = "0.5 s"
base = { synthetic = { seed = 3, pga = "0.8 g", duration = "4 s" } }
"#;
const PULSE: &str = r#"
[load]
top = "20 kN/m"
beam = { mass = "2 t" }
[motion]
duration = "0.06 s"
base = { pulse = { shape = "rectangular", acceleration = "1.5 g", duration = "0.02 s", start = "0.01 s" } }
"#;

fn ready(text: &str) -> Prepared {
    let file = from_str(text, Syntax::Toml, None).unwrap();
    file.validate().unwrap();
    let mut case = file.case.clone();
    case.output.joints = vec!["all".into()];
    case.output.blocks = vec!["all".into()];
    prepare_case(case, Path::new("")).unwrap()
}

/// Runs that differ in everything that runs side by side may differ in.
fn variants(text: &str, count: usize) -> Vec<Prepared> {
    let vary = |k: usize| {
        let mut prepared = ready(text);
        let change = 1.0 + 0.07 * k as f64;
        for elastic in &mut prepared.model.shear.elastic {
            elastic.stiffness *= change;
        }
        for rub in &mut prepared.model.shear.rubs {
            rub.law.static_ *= 1.0 / change;
            rub.normal = rub.normal.map(|n| n * change);
        }
        for mass in &mut prepared.model.shear.mass {
            *mass *= change;
        }
        prepared.case.solver.tolerance *= if k % 3 == 1 { 3.0 } else { 1.0 };
        prepared.model.excitation.duration *= 1.0 - 0.05 * (k % 2) as f64;
        prepared.sampling.interval *= 1.0 + (k % 4) as f64;
        prepared
    };
    (0..count).map(vary).collect()
}

fn batch(runs: &[Prepared], threads: usize) -> Vec<Outcome> {
    let jobs: Vec<Job> = runs.iter().map(Job::from).collect();
    simulate_many(&jobs, threads).into_iter().map(Result::unwrap).collect()
}

fn alone(runs: &[Prepared]) -> Vec<Outcome> {
    runs.iter().map(|run| run_in_memory(run).unwrap()).collect()
}

/// Histories, frames, envelopes, energies and counters to the last bit: elastic, closing head joints, friction, a
/// driven top, a record, jumps of the motion, a beam with mass, both schemes.
#[test]
fn lanes_have_the_bits_of_single_runs() {
    let elastic = format!("{PANEL}[joint]\nhead = {{ law = \"elastic\", stiffness = \"5.4e7 N/m\" }}\n{SHAKEN}");
    let unilateral = format!("{PANEL}{SHAKEN}");
    let cases = [
        elastic.as_str(),
        unilateral.as_str(),
        &format!("{PANEL}{FRICTION}{DRIVEN}"),
        &format!("{PANEL}{FRICTION}{SHAKEN}"),
        &format!("{PANEL}{FRICTION}{PULSE}"),
    ];
    for text in cases {
        for scheme in [Scheme::TrBdf2, Scheme::Esdirk4] {
            let mut runs = variants(text, 5);
            runs.iter_mut().for_each(|run| run.case.solver.scheme = scheme);
            let singles = alone(&runs);
            assert!(singles.iter().all(|out| out.stop_reason == StopReason::Completed && out.counters.steps > 50));
            for (k, (many, single)) in batch(&runs, 1).iter().zip(&singles).enumerate() {
                assert_eq!(many.counters, single.counters, "{scheme:?}, run {k} of {text}");
                assert!(many == single, "{scheme:?}, run {k} of {text}");
            }
        }
    }
}

/// One run, fewer than lanes, more than lanes; any number of threads; other neighbours.
#[test]
fn no_run_depends_on_its_neighbours_or_on_the_threads() {
    let runs = variants(&format!("{PANEL}{FRICTION}{DRIVEN}"), 19);
    let singles = alone(&runs);
    for (from, count, threads) in [(0, 1, 1), (3, 2, 1), (4, 7, 1), (0, 19, 1), (0, 19, 2), (2, 17, 3), (5, 9, 0)] {
        let some = batch(&runs[from..from + count], threads);
        assert!(some == singles[from..from + count], "{count} runs from {from} on {threads} threads");
    }
}

/// Walls that cannot share lanes, and models that lanes do not take, in one call: results in the order of the jobs.
#[test]
fn walls_of_other_kinds_in_one_batch() {
    let sticking = FRICTION.replace("\"stribeck\"", "\"stribeck-stick\"");
    let overburden = FRICTION.replace("static", "normal_force = \"overburden\", static");
    let taller = PANEL.replace("courses = 4", "courses = 5");
    let mut runs = Vec::new();
    for panel in [PANEL, &taller] {
        for friction in [FRICTION, &sticking, &overburden] {
            runs.extend(variants(&format!("{panel}{friction}{DRIVEN}"), 4));
        }
    }
    // Neighbours in the list are then of different kinds.
    let runs: Vec<Prepared> = (0..runs.len()).map(|k| runs[7 * k % runs.len()].clone()).collect();
    let many = batch(&runs, 2);
    assert!(many == alone(&runs));
    assert_eq!(many.iter().filter(|out| out.layout.held > 0).count(), 8);
}

/// A run that cannot start and one that breaks down leave the others as they are.
#[test]
fn a_run_that_fails_does_not_hurt_the_others() {
    let mut runs = variants(&format!("{PANEL}{FRICTION}{DRIVEN}"), 10);
    let singles = alone(&runs);
    runs[2].sampling.blocks = vec!["no such block".into()];
    runs[5].model.shear.elastic[3].damping = f64::NAN;
    let jobs: Vec<Job> = runs.iter().map(Job::from).collect();
    for (k, (many, single)) in simulate_many(&jobs, 1).into_iter().zip(&singles).enumerate() {
        match k {
            2 => assert!(many.unwrap_err().to_string().contains("no such block")),
            5 => {
                let (out, single) = (many.unwrap(), run_in_memory(&runs[5]).unwrap());
                assert_ne!(out.stop_reason, StopReason::Completed);
                assert_eq!((out.stop_reason, out.counters), (single.stop_reason, single.counters));
            }
            _ => assert!(many.unwrap() == *single, "run {k}"),
        }
    }
}

/// The watch sees the work go on and can end it; what was under way then is kept as far as it came.
#[test]
fn a_batch_can_be_watched_and_stopped() {
    let text = format!("{PANEL}{FRICTION}{DRIVEN}").replace("0.03 s", "0.5 s");
    let mut runs = variants(&text, 12);
    // Long enough for the first runs to be under way at the second look.
    runs.iter_mut().for_each(|run| run.case.solver.tolerance = 1e-4);
    let jobs: Vec<Job> = runs.iter().map(Job::from).collect();
    let shares = Mutex::new(Vec::new());
    let ended: Mutex<Vec<(usize, Outcome)>> = Mutex::new(Vec::new());
    let watch = |standing: concio::many::Standing| {
        assert_eq!(standing.of, 12);
        shares.lock().unwrap().push(standing.share);
        if shares.lock().unwrap().len() > 1 { Control::Stop } else { Control::Continue }
    };
    simulate_each(&jobs, 1, None, &watch, &|k, out| ended.lock().unwrap().push((k, out.unwrap())));
    let shares = shares.into_inner().unwrap();
    assert!(shares[0] == 0.0 && shares[1] > 0.0 && shares[1] < 1.0, "{shares:?}");
    let ended = ended.into_inner().unwrap();
    assert!(ended.len() >= 8);
    let stopped: Vec<_> = ended.iter().filter(|(_, out)| out.stop_reason == StopReason::Interrupted).collect();
    assert_eq!(stopped.len(), 8);
    for (k, out) in &stopped[..2] {
        let single = run_in_memory(&runs[*k]).unwrap();
        let rows = out.recording.time.len();
        assert!(out.time_reached > 0.0 && out.time_reached < single.time_reached);
        assert_eq!(out.recording.values[..], single.recording.values[..rows * single.layout.channels.len()]);
    }
}

/// More kinds than one, more runs than lanes, several threads: the last runs of each kind leave their lanes, and all come to the bits that they
/// have alone. Stopped amid that, each run that had begun is told once, ended or as far as it came.
#[test]
fn last_runs_leave_their_lanes() {
    let taller = PANEL.replace("courses = 4", "courses = 5");
    let mut runs = variants(&format!("{PANEL}{FRICTION}{DRIVEN}"), 13);
    runs.extend(variants(&format!("{taller}{FRICTION}{DRIVEN}"), 11));
    let singles = alone(&runs);
    for threads in [1, 2, 3] {
        assert!(batch(&runs, threads) == singles, "{threads} threads");
    }
    let jobs: Vec<Job> = runs.iter().map(Job::from).collect();
    for after in [5, 12, 20] {
        let told: Mutex<Vec<(usize, Outcome)>> = Mutex::new(Vec::new());
        let watch = |_: concio::many::Standing| match told.lock().unwrap().len() >= after {
            true => Control::Stop,
            false => Control::Continue,
        };
        simulate_each(&jobs, 2, None, &watch, &|k, out| told.lock().unwrap().push((k, out.unwrap())));
        let mut told = told.into_inner().unwrap();
        told.sort_by_key(|(k, _)| *k);
        assert!(told.windows(2).all(|pair| pair[0].0 < pair[1].0), "a run is told twice");
        for (k, out) in &told {
            let (rows, width) = (out.recording.time.len(), out.layout.channels.len());
            assert!(out.stop_reason == StopReason::Interrupted || *out == singles[*k], "run {k}");
            assert_eq!(out.recording.values[..], singles[*k].recording.values[..rows * width], "run {k}");
        }
    }
}

/// Slipping panels with other friction: the mean work of the batch at the default tolerance against that of single
/// runs at a thousandth of it. Single histories are chaotic there, the mean is not.
#[test]
fn mean_work_of_a_slipping_batch() {
    let at = |mu: f64| {
        let law = FRICTION.replace("0.6", &mu.to_string()).replace("0.42", &(0.7 * mu).to_string());
        ready(&format!("{PANEL}{law}{DRIVEN}").replace("0.03 s", "0.05 s"))
    };
    let runs: Vec<Prepared> = (0..16).map(|k| at(0.4 + 0.4 * f64::from(k) / 15.0)).collect();
    let mut tight = runs.clone();
    tight.iter_mut().for_each(|run| run.case.solver.tolerance = 1e-6);
    let mean = |outcomes: &[Outcome]| outcomes.iter().map(|out| out.energies.input_top).sum::<f64>() / 16.0;
    let (loose, exact) = (mean(&batch(&runs, 2)), mean(&alone(&tight)));
    assert!((loose / exact - 1.0).abs() < 0.005, "{loose} against {exact}");
}
