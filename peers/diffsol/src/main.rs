//! Integrates a system that `concio system` printed with diffsol.
//!
//! ```text
//! diffsol-shear METHOD SYSTEM.json RTOL ATOL INTERVAL HISTORY.bin
//! ```
//!
//! METHOD is bdf, tr-bdf2 or esdirk34. The Jacobian is sparse: diffsol finds its pattern and colours its columns. Prints
//! one line of JSON; HISTORY.bin gets the displacements of all unknowns at INTERVAL, 2 INTERVAL, …
//!
//! Two things to know: without a stop at every sample of a record the solver steps over a whole earthquake; and
//! `max_nonlinear_solver_failures` counts over the whole run, not per step.

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use diffsol::{
    FaerSparseLU, FaerSparseMat, FaerVec, OdeBuilder, OdeEquations, OdeSolverMethod, OdeSolverStopReason, Vector,
};
use peer_system::System;
use serde_json::json;

const USAGE: &str = "usage: diffsol-shear bdf|tr-bdf2|esdirk34 SYSTEM.json RTOL ATOL INTERVAL HISTORY.bin";

/// What is read off a run.
struct Run {
    history: Vec<f64>,
    seconds: f64,
    steps: usize,
    factorisations: usize,
    work: f64,
    square: f64,
    largest: f64,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments == ["--version"] {
        println!("diffsol 0.18.0 with the sparse LU of faer");
        return ExitCode::SUCCESS;
    }
    match solve(&arguments) {
        Ok(line) => {
            println!("{line}");
            ExitCode::SUCCESS
        }
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

fn solve(arguments: &[String]) -> Result<String, Box<dyn Error>> {
    let [method, path, rtol, atol, interval, out] = arguments else { return Err(USAGE.into()) };
    let system = System::read(path)?;
    let (n, interval) = (system.mass.len(), interval.parse()?);
    let mut problem = OdeBuilder::<FaerSparseMat<f64>>::new()
        .rtol(rtol.parse()?)
        .atol([atol.parse()?])
        .h0(1e-6)
        .use_coloring(true)
        .rhs_implicit(
            |y, _, t, rate| system.rates(y, t, rate),
            |y, _, t, v, product| system.jacobian_times(y, t, v, product),
        )
        .init(|_, _, y| y.fill(0.0), 2 * n)
        .build()?;
    problem.ode_options.max_nonlinear_solver_failures = usize::MAX;
    problem.ode_options.max_error_test_failures = 1000;
    problem.ode_options.min_timestep = 1e-16;
    type Lu = FaerSparseLU<f64>;
    let run = match method.as_str() {
        "bdf" => drive(&system, problem.bdf::<Lu>()?, interval)?,
        "tr-bdf2" => drive(&system, problem.tr_bdf2::<Lu>()?, interval)?,
        "esdirk34" => drive(&system, problem.esdirk34::<Lu>()?, interval)?,
        _ => return Err(USAGE.into()),
    };
    std::fs::write(out, run.history.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>())?;
    Ok(json!({
        "steps": run.steps,
        "factorisations": run.factorisations,
        "solve_seconds": run.seconds,
        "peak_relative_displacement": run.history.iter().fold(0.0, |m: f64, z| m.max(z.abs())),
        "top_work": run.work,
        "top_force_peak": run.largest,
        "top_force_rms": (run.square / system.duration).sqrt(),
    })
    .to_string())
}

/// Steps to the end, from one stop to the next.
fn drive<'a, Eqn, S>(system: &System, mut solver: S, interval: f64) -> Result<Run, Box<dyn Error>>
where
    Eqn: OdeEquations<T = f64, V = FaerVec<f64>> + 'a,
    S: OdeSolverMethod<'a, Eqn>,
{
    let n = system.mass.len();
    let mut run =
        Run { history: Vec::new(), seconds: 0.0, steps: 0, factorisations: 0, work: 0.0, square: 0.0, largest: 0.0 };
    let samples = (system.duration / interval * (1.0 + 1e-12) + 1e-9).floor() as usize;
    let (mut sample, mut t, mut before) = (1, 0.0, system.top_force(&vec![0.0; 2 * n], 0.0));
    let start = Instant::now();
    for stop in system.stops() {
        solver.set_stop_time(stop)?;
        loop {
            let reason = solver.step()?;
            let now = solver.state().t;
            let force = system.top_force(&solver.state().y.clone_as_vec(), now);
            run.work += 0.5 * (now - t) * (force.0 * force.1 + before.0 * before.1);
            run.square += 0.5 * (now - t) * (force.0.powi(2) + before.0.powi(2));
            run.largest = run.largest.max(force.0.abs());
            (t, before) = (now, force);
            while sample <= samples && sample as f64 * interval <= t + 1e-9 * interval {
                let y = solver.interpolate((sample as f64 * interval).min(t))?.clone_as_vec();
                run.history.extend_from_slice(&y[..n]);
                sample += 1;
            }
            if reason == OdeSolverStopReason::TstopReached {
                break;
            }
        }
    }
    run.seconds = start.elapsed().as_secs_f64();
    let statistics = solver.get_statistics();
    (run.steps, run.factorisations) = (statistics.number_of_steps, statistics.number_of_linear_solver_setups);
    Ok(run)
}
