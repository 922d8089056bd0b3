//! What a study costs beside its solver, and what a second core brings: `cargo bench --bench overhead [-- RUNS TURNS]`.
//!
//! The same slipping panels go through `simulate_many` alone, prepared beforehand, and through a runner with a store on
//! disk, on one thread and on two. The four take turns on pieces of 250 panels, every other time in reverse order, so that
//! what a machine does in the course of minutes meets all of them alike: 1,000 runs and three turns unless said. Printed
//! are the ratios of the times by the clock, piece by piece, their medians, and the ratios of the sums. Every piece is a
//! study of its own, which opens its store and waits for its last runs.

use std::ops::Range;
use std::path::Path;
use std::time::Instant;

use concio::case::Case;
use concio::many::{Job, simulate_many};
use concio::run::{Control, prepare_case};
use concio_study::file::Keep;
use concio_study::runner::{Progress, Runner};
use concio_study::{Plan, StudyFile};

/// Panels of a piece.
const PIECE: usize = 250;
const WALL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../xtask/walls/driven-top.toml");

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len() % 2 == 1 { values[half] } else { 0.5 * (values[half - 1] + values[half]) }
}

/// Time of the study of some runs of the file, with all that belongs to it.
fn study(path: &Path, runs: Range<usize>, threads: usize) -> Result<f64, Box<dyn std::error::Error>> {
    let out = tempfile::tempdir_in(path.parent().ok_or("no folder")?)?;
    let go_on = |_: &Progress| Control::Continue;
    let begun = Instant::now();
    let cases = cases(path, runs)?;
    Runner::open(out.path(), &Keep::default(), threads, &go_on)?.rows(&cases)?;
    Ok(begun.elapsed().as_secs_f64())
}

/// Time of the solver alone.
fn solver(path: &Path, runs: Range<usize>, threads: usize) -> Result<f64, Box<dyn std::error::Error>> {
    let cases = cases(path, runs)?;
    let prepared = cases.iter().map(|c| prepare_case(c.clone(), Path::new(""))).collect::<concio::Result<Vec<_>>>()?;
    let jobs: Vec<Job> = prepared.iter().map(Job::from).collect();
    let begun = Instant::now();
    simulate_many(&jobs, threads);
    Ok(begun.elapsed().as_secs_f64())
}

fn cases(path: &Path, runs: Range<usize>) -> concio::Result<Vec<Case>> {
    let plan = Plan::of(StudyFile::read(path)?)?;
    runs.map(|i| plan.case(i)).collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut numbers = std::env::args().filter_map(|a| a.parse().ok());
    let (runs, turns): (usize, usize) = (numbers.next().unwrap_or(1000), numbers.next().unwrap_or(3));
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("study.toml");
    let text = format!(
        "wall = {WALL:?}\n[design]\nkind = \"latin-hypercube\"\nruns = {runs}\n[[vary]]\npath = \"joint.friction.static\"\n\
         from = 0.4\nto = 0.8\nalso = [{{ path = \"joint.friction.dynamic\", times = 0.7 }}]\n"
    );
    std::fs::write(&path, text)?;
    let mut pieces: Vec<[f64; 4]> = Vec::new();
    for turn in 0..turns {
        for first in (0..runs).step_by(PIECE) {
            let mut times = [0.0; 4];
            let mut order = [0, 1, 2, 3];
            if pieces.len() % 2 == 1 {
                order.reverse();
            }
            for program in order {
                let (piece, threads) = (first..runs.min(first + PIECE), 1 + program / 2);
                let time = if program % 2 == 0 { study } else { solver };
                times[program] = time(&path, piece, threads)?;
            }
            pieces.push(times);
            let [a, b, c, d] = RATIOS.map(|(_, of, over)| times[of] / times[over]);
            println!("turn {turn}, from run {first}: {a:.4} {b:.4} {c:.4} {d:.4}");
        }
    }
    for (what, of, over) in RATIOS {
        let middle = median(pieces.iter().map(|times| times[of] / times[over]).collect());
        let sum = |program: usize| pieces.iter().map(|times| times[program]).sum::<f64>();
        println!("{what}: median {middle:.4}, of the sums {:.4}", sum(of) / sum(over));
    }
    Ok(())
}

/// Studies on one thread (0) and on two (2), solvers on one (1) and on two (3).
const RATIOS: [(&str, usize, usize); 4] = [
    ("study over solver, one thread", 0, 1),
    ("study over solver, two threads", 2, 3),
    ("study, one thread over two", 0, 2),
    ("solver, one thread over two", 1, 3),
];
