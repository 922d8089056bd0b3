//! What a study costs beside its solver, and what a second core brings: `cargo bench --bench overhead [-- RUNS TURNS]`.
//!
//! The same slipping panels go through `simulate_many` alone, prepared beforehand, and through a runner with a store on
//! disk, in turn; ratios of their times by the clock are printed, of medians over the turns: 1,000 runs and three turns unless
//! said.

use std::path::Path;
use std::time::Instant;

use concio::many::{Job, simulate_many};
use concio::run::{Control, prepare};
use concio_study::file::Keep;
use concio_study::runner::{Progress, Runner};
use concio_study::{Plan, StudyFile};

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut numbers = std::env::args().filter_map(|a| a.parse().ok());
    let (runs, turns): (usize, usize) = (numbers.next().unwrap_or(1000), numbers.next().unwrap_or(3));
    let wall = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/02-driven-top.toml");
    let folder = tempfile::tempdir()?;
    let text = format!(
        "wall = {wall:?}\n[design]\nkind = \"latin-hypercube\"\nruns = {runs}\n[[vary]]\npath = \"joint.friction.static\"\n\
         from = 0.4\nto = 0.8\nalso = [{{ path = \"joint.friction.dynamic\", times = 0.7 }}]\n"
    );
    let path = folder.path().join("study.toml");
    std::fs::write(&path, text)?;
    let go_on = |_: &Progress| Control::Continue;
    let mut times = vec![Vec::new(); 4];
    for turn in 0..turns {
        for threads in [1, 2] {
            let begun = Instant::now();
            let plan = Plan::of(StudyFile::read(&path)?)?;
            let cases = (0..runs).map(|i| plan.case(i)).collect::<concio::Result<Vec<_>>>()?;
            let out = folder.path().join(format!("{turn}-{threads}"));
            Runner::open(&out, &Keep::default(), threads, &go_on)?.rows(&cases)?;
            times[threads - 1].push(begun.elapsed().as_secs_f64());
            let prepared =
                cases.iter().map(|c| prepare(c.clone(), Path::new(""))).collect::<concio::Result<Vec<_>>>()?;
            let jobs: Vec<Job> = prepared.iter().map(Job::from).collect();
            let begun = Instant::now();
            simulate_many(&jobs, threads);
            times[1 + threads].push(begun.elapsed().as_secs_f64());
        }
    }
    let [one, two, solver, solver_two] = [0, 1, 2, 3].map(|k| median(times[k].clone()));
    println!("{runs} runs, study over solver: {:.4} on one thread, {:.4} on two", one / solver, two / solver_two);
    println!("one thread over two: study {:.3}, solver {:.3}", one / two, solver / solver_two);
    println!("seconds per run on one thread: {:.4}", one / runs as f64);
    Ok(())
}
