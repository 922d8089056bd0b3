//! How work, force and slip of the slipping panel depend on tolerance and step where (6) falls, for δ_v from 10⁻² to
//! 10⁻⁴ m/s. `cargo bench -p concio --bench negative_slope` prints the tables of docs/negative-slope.md.

use std::path::Path;

use concio::case::{Case, Syntax, from_str};
use concio::record::StopReason;
use concio::run::{prepare_case, run_in_memory};

/// The panel of examples/02, and how it is run.
const PANEL: &str = include_str!("../../../xtask/walls/driven-top.toml");
/// Runs of one setting: the top's amplitude off by millionths, which in a chaotic regime makes other histories.
const MEMBERS: usize = 5;

/// What is compared between runs.
struct Answer {
    work: f64,
    rms: f64,
    peak: f64,
    slip: f64,
    fastest: f64,
    steps: f64,
    residual: f64,
}

fn run(slip_velocity: f64, tolerance: f64, max_step: Option<f64>, member: usize) -> Option<Answer> {
    let text = format!("{PANEL}\n");
    let mut case: Case = from_str(&text, Syntax::Toml, None).ok()?.case;
    let factor = 1.0 + 1e-6 * member as f64;
    case.solver.tolerance = tolerance;
    case.solver.max_step = max_step.map(Into::into);
    let text = toml_of(&case, slip_velocity, factor);
    let case = from_str(&text, Syntax::Json, None).ok()?.case;
    let prepared = prepare_case(case, Path::new("")).ok()?;
    let out = run_in_memory(&prepared).ok()?;
    (out.stop_reason == StopReason::Completed).then(|| Answer {
        work: out.energies.input_top,
        rms: (out.totals.top_force_square / out.time_reached).sqrt(),
        peak: out.totals.top_force_peak,
        slip: out.envelopes.joint_slip.iter().sum(),
        fastest: out.totals.peak_slip_velocity,
        steps: out.counters.steps as f64,
        residual: out.totals.peak_residual / out.totals.peak_input,
    })
}

/// The case as JSON with another slip velocity and the top's amplitude times `factor`.
fn toml_of(case: &Case, slip_velocity: f64, factor: f64) -> String {
    let mut value = serde_json::to_value(case).unwrap_or_default();
    value["joint"]["friction"]["slip_velocity"] = slip_velocity.into();
    let amplitude = value.pointer_mut("/motion/top/sine/amplitude");
    if let Some(amplitude) = amplitude {
        *amplitude = (amplitude.as_f64().unwrap_or(f64::NAN) * factor).into();
    }
    value.to_string()
}

/// Mean and half the range over the members.
fn spread(answers: &[Answer], of: fn(&Answer) -> f64) -> (f64, f64) {
    let values = || answers.iter().map(of);
    let mean = values().sum::<f64>() / answers.len() as f64;
    (mean, 0.5 * (values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)))
}

fn row(first: &str, slip_velocity: f64, tolerance: f64, max_step: Option<f64>) {
    let answers: Vec<Answer> = (0..MEMBERS).filter_map(|m| run(slip_velocity, tolerance, max_step, m)).collect();
    if answers.is_empty() {
        return println!("| {first} | did not finish |");
    }
    let (work, dw) = spread(&answers, |a| a.work);
    let (rms, dr) = spread(&answers, |a| a.rms * 1e-3);
    let (peak, dp) = spread(&answers, |a| a.peak * 1e-3);
    let (slip, ds) = spread(&answers, |a| a.slip * 1e3);
    let (fastest, df) = spread(&answers, |a| a.fastest * 1e3);
    let (steps, _) = spread(&answers, |a| a.steps);
    let worst = answers.iter().map(|a| a.residual).fold(0.0, f64::max);
    println!(
        "| {first} | {work:.2} ± {dw:.2} | {rms:.2} ± {dr:.2} | {peak:.1} ± {dp:.1} | {slip:.0} ± {ds:.0} | \
         {fastest:.0} ± {df:.0} | {steps:.0} | {worst:.0e} |"
    );
}

fn main() {
    let head =
        "work J | rms force kN | peak force kN | slip, all joints mm | fastest slip mm/s | steps | energy residual |";
    for slip_velocity in [1e-2, 3e-3, 1e-3, 3e-4, 1e-4] {
        println!("\nδ_v = {slip_velocity:e} m/s\n\n| tolerance | {head}\n|---|---|---|---|---|---|---|---|");
        for tolerance in [1e-1, 3e-2, 1e-2, 1e-3, 1e-4] {
            row(&format!("{tolerance:.0e}"), slip_velocity, tolerance, None);
        }
    }
    for slip_velocity in [1e-2, 1e-3, 1e-4] {
        println!(
            "\nδ_v = {slip_velocity:e} m/s, tolerance 1e-2\n\n| longest step s | {head}\n|---|---|---|---|---|---|---|---|"
        );
        for step in [1e-4, 3e-5, 1e-5, 3e-6] {
            row(&format!("{step:.0e}"), slip_velocity, 1e-2, Some(step));
        }
    }
}
