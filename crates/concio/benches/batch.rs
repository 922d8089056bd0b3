//! A batch of slipping panels with μ_s from 0.4 to 0.8 in lanes, beside the same runs one by one and on two threads.
//! `cargo bench -p concio --bench batch` prints the table of docs/decisions/0005-lanes.md; numbers after `--` are the
//! number of runs (64) and how many of them are run alone too (8).

use std::path::Path;
use std::time::Instant;

use concio::case::{Syntax, from_str};
use concio::many::{Job, simulate_many};
use concio::outcome::Outcome;
use concio::run::{Prepared, prepare_case, run_in_memory};

const PANEL: &str = include_str!("../../../xtask/walls/driven-top.toml");
/// Rounds in which the ways take turns; the median counts.
const ROUNDS: usize = 3;

fn main() {
    let mut numbers = std::env::args().filter_map(|arg| arg.parse::<usize>().ok());
    let (runs, alone) = (numbers.next().unwrap_or(64), numbers.next().unwrap_or(8));
    println!("| tolerance | alone [s per run] | in lanes | alone / lanes | one thread / two | mean work [J] |");
    println!("|---|---|---|---|---|---|");
    for tolerance in [1e-3, 1e-2, 3e-2, 1e-1] {
        let prepared: Vec<Prepared> = (0..runs).filter_map(|k| panel(k, runs, tolerance)).collect();
        let jobs: Vec<Job> = prepared.iter().map(Job::from).collect();
        let some = prepared.iter().step_by(runs.div_ceil(alone.max(1)).max(1));
        let mut times = [const { Vec::new() }; 3];
        let mut work = 0.0;
        for _ in 0..ROUNDS {
            let count = some.clone().count();
            times[0].push(seconds(|| some.clone().for_each(|run| drop(run_in_memory(run)))) / count as f64);
            times[1].push(seconds(|| work = mean_work(simulate_many(&jobs, 1))) / runs as f64);
            times[2].push(seconds(|| drop(simulate_many(&jobs, 2))) / runs as f64);
        }
        let [single, lanes, threads] = times.map(median);
        println!(
            "| {tolerance:e} | {single:.4} | {lanes:.4} | {:.2} | {:.2} | {work:.3} |",
            single / lanes,
            lanes / threads
        );
    }
}

/// Run `k` of `runs`.
fn panel(k: usize, runs: usize, tolerance: f64) -> Option<Prepared> {
    let mu = 0.4 + 0.4 * k as f64 / runs.saturating_sub(1).max(1) as f64;
    let law = format!("static = {mu}, dynamic = {}", 0.7 * mu);
    let mut case = from_str(&PANEL.replace("static = 0.6, dynamic = 0.42", &law), Syntax::Toml, None).ok()?.case;
    case.solver.tolerance = tolerance;
    prepare_case(case, Path::new("")).ok()
}

fn mean_work(outcomes: Vec<concio::Result<Outcome>>) -> f64 {
    let works: Vec<f64> = outcomes.into_iter().flatten().map(|out| out.energies.input_top).collect();
    works.iter().sum::<f64>() / works.len() as f64
}

fn seconds(what: impl FnOnce()) -> f64 {
    let start = Instant::now();
    what();
    start.elapsed().as_secs_f64()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
