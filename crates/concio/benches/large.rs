//! Cost per block and step, and memory per block, from 1,000 to 100,000 blocks.
//!
//!     cargo bench --bench large [-- STEPS]
//!
//! A panel under a synthetic earthquake, from rest: STEPS steps (60 unless said) after the first 20, in which the step
//! size finds itself. Panels grow to all sides first, then in length alone, at 25 courses. Laying the wall and finding
//! the order of elimination are timed apart. Bytes are those that model and run ask for, without output.
//!
//! Part of the growth has nothing to do with the solver: small walls live in the caches. The last lines tell it: as many
//! small walls as make up the largest, one step of each in turn.

use std::path::Path;
use std::time::Instant;

use concio::Result;
use concio::case::{Syntax, from_str};
use concio::run::prepare;
use concio::simulate::Simulation;
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const FIRST: u64 = 20;

fn wall(courses: usize, bricks: usize, friction: &str) -> String {
    format!(
        r#"
model = "shear"
set = "report"
[[panel]]
bond = "running"
courses = {courses}
bricks = {bricks}
[joint]
friction = {{ law = "{friction}", static = 0.6, dynamic = 0.42 }}
[load]
top = "2 kN/m"
[motion]
duration = "4 s"
base = {{ synthetic = {{ seed = 3, pga = "0.3 g", duration = "4 s" }} }}
[output]
interval = "0.01 s"
frames = "0 s"
"#
    )
}

/// Prints a line; returns µs per block and step.
fn measure(courses: usize, bricks: usize, friction: &str, steps: u64, smallest: Option<f64>) -> Result<f64> {
    let before = MEMORY.current_usage();
    let start = Instant::now();
    let file = from_str(&wall(courses, bricks, friction), Syntax::Toml, None)?;
    file.validate()?;
    let prepared = prepare(file.case, Path::new(""))?;
    let laid = start.elapsed().as_secs_f64();
    let mut run = Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling)?;
    let ready = start.elapsed().as_secs_f64() - laid;
    let bytes = MEMORY.current_usage() - before;
    run.advance(FIRST);
    let counted = run.state().counters;
    let start = Instant::now();
    run.advance(steps);
    let seconds = start.elapsed().as_secs_f64();
    let blocks = prepared.model.wall.blocks.len();
    let now = run.state().counters;
    let taken = (now.steps - counted.steps) as f64;
    let cost = 1e6 * seconds / taken / blocks as f64;
    println!(
        "{friction:>9} {blocks:>8} {laid:>8.2} {ready:>8.2} {cost:>10.3} {:>8.2} {:>8.1} {:>8.1} {:>8.0}",
        cost / smallest.unwrap_or(cost),
        (now.iterations - counted.iterations) as f64 / taken,
        (now.factorisations - counted.factorisations) as f64 / taken,
        bytes as f64 / blocks as f64,
    );
    Ok(cost)
}

/// Small walls, `count` of them, one step of each in turn: prints a line. Each is from another seed, so that they do not
/// step alike.
fn in_turn(count: u64, friction: &str, steps: u64, smallest: Option<f64>) -> Result<f64> {
    let mut all = Vec::new();
    for seed in 0..count {
        let file =
            from_str(&wall(25, 40, friction).replace("seed = 3", &format!("seed = {seed}")), Syntax::Toml, None)?;
        all.push(prepare(file.case, Path::new(""))?);
    }
    let mut runs = Vec::new();
    for prepared in &all {
        runs.push(Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling)?);
    }
    for run in &mut runs {
        run.advance(FIRST);
    }
    let start = Instant::now();
    for _ in 0..steps {
        for run in &mut runs {
            run.advance(1);
        }
    }
    let blocks: usize = all.iter().map(|p| p.model.wall.blocks.len()).sum();
    let cost = 1e6 * start.elapsed().as_secs_f64() / (steps as f64 * blocks as f64);
    let ratio = cost / smallest.unwrap_or(cost);
    println!("{friction:>9} {blocks:>8} in {count} walls in turn {cost:>10.3} {ratio:>8.2}");
    Ok(cost)
}

fn main() -> Result<()> {
    let steps = std::env::args().skip(1).find_map(|a| a.parse().ok()).unwrap_or(60);
    println!(" friction   blocks  lay [s] make [s] us/blk/stp    ratio  its/stp fact/stp  B/block");
    for friction in ["stribeck", "none"] {
        for sizes in [[(25, 40), (80, 125), (250, 400)], [(25, 40), (25, 400), (25, 4000)]] {
            let mut smallest = None;
            for (courses, bricks) in sizes {
                let cost = measure(courses, bricks, friction, steps, smallest)?;
                smallest = smallest.or(Some(cost));
            }
        }
        let one = in_turn(1, friction, steps, None)?;
        in_turn(99, friction, steps, Some(one))?;
    }
    Ok(())
}
