//! Cost per block and step, and memory per block, from 1,000 to 100,000 blocks.
//!
//!     cargo bench --bench large [-- STEPS]
//!
//! A panel under a synthetic earthquake, from rest: STEPS steps (60 unless said) after the first 20, in which the step
//! size finds itself. Panels grow to all sides first, then in length alone, at 25 courses. The three sizes of a series go
//! in turn, five rounds of the same steps, small walls as often as it takes to time them; medians of the costs and of their
//! ratios to the smallest wall's in the same round. Laying the wall and finding the order of elimination are timed
//! apart. Iterations and factorisations are those of all steps, the first ones too. Bytes are those that model and run ask
//! for, without output.
//!
//! Part of the growth has nothing to do with the solver: small walls live in the caches. The last lines tell it: as many
//! small walls as make up the largest, one step of each in turn.

use std::path::Path;
use std::time::Instant;

use concio::Result;
use concio::case::{Syntax, from_str};
use concio::run::{Prepared, prepare_case};
use concio::simulate::Simulation;
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const FIRST: u64 = 20;
const ROUNDS: usize = 5;
/// Least time of a measurement [s].
const LEAST: f64 = 1.0;

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

/// A wall that has made its first steps.
struct Wall<'a> {
    blocks: usize,
    laid: f64,
    ready: f64,
    bytes: usize,
    run: Simulation<'a>,
    begin: Vec<u8>,
    /// µs per block and step, round by round.
    costs: Vec<f64>,
}

/// A wall that is laid, with the seconds and bytes that it took.
struct Laid {
    prepared: Prepared,
    seconds: f64,
    bytes: usize,
}

impl Laid {
    fn new(courses: usize, bricks: usize, friction: &str) -> Result<Self> {
        let before = MEMORY.current_usage();
        let start = Instant::now();
        let file = from_str(&wall(courses, bricks, friction), Syntax::Toml, None)?;
        file.validate()?;
        let prepared = prepare_case(file.case, Path::new(""))?;
        Ok(Laid { prepared, seconds: start.elapsed().as_secs_f64(), bytes: MEMORY.current_usage() - before })
    }
}

impl<'a> Wall<'a> {
    fn new(of: &'a Laid) -> Result<Self> {
        let Laid { prepared, .. } = of;
        let before = MEMORY.current_usage();
        let start = Instant::now();
        let mut run = Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling)?;
        let ready = start.elapsed().as_secs_f64();
        let bytes = of.bytes + MEMORY.current_usage() - before;
        run.advance(FIRST);
        let begin = run.save();
        let blocks = prepared.model.wall.blocks.len();
        Ok(Wall { blocks, laid: of.seconds, ready, bytes, run, begin, costs: Vec::new() })
    }

    /// The same steps once more, and again until they have taken long enough to tell.
    fn measure(&mut self, steps: u64) {
        let (mut seconds, mut taken) = (0.0, 0);
        while seconds < LEAST {
            assert!(self.run.restore(&self.begin), "its own state");
            let start = Instant::now();
            self.run.advance(steps);
            seconds += start.elapsed().as_secs_f64();
            taken += self.run.state().counters.steps - FIRST;
        }
        self.costs.push(1e6 * seconds / taken as f64 / self.blocks as f64);
    }
}

fn median(of: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = of.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Walls of three sizes in turn; a line for each.
fn measure(sizes: [(usize, usize); 3], friction: &str, steps: u64) -> Result<()> {
    let mut laid = Vec::new();
    for (courses, bricks) in sizes {
        laid.push(Laid::new(courses, bricks, friction)?);
    }
    let mut walls = laid.iter().map(Wall::new).collect::<Result<Vec<_>>>()?;
    for _ in 0..ROUNDS {
        walls.iter_mut().for_each(|wall| wall.measure(steps));
    }
    for wall in &walls {
        let counted = wall.run.state().counters;
        let ratios = wall.costs.iter().zip(&walls[0].costs).map(|(a, b)| a / b);
        println!(
            "{friction:>9} {:>8} {:>8.2} {:>8.2} {:>10.3} {:>8.2} {:>8.1} {:>8.2} {:>8.0}",
            wall.blocks,
            wall.laid,
            wall.ready,
            median(wall.costs.iter().copied()),
            median(ratios),
            counted.iterations as f64 / counted.steps as f64,
            counted.factorisations as f64 / counted.steps as f64,
            wall.bytes as f64 / wall.blocks as f64,
        );
    }
    Ok(())
}

/// Small walls, `count` of them, one step of each in turn: prints a line. Each is from another seed, so that they do not
/// step alike.
fn in_turn(count: u64, friction: &str, steps: u64, smallest: Option<f64>) -> Result<f64> {
    let mut all = Vec::new();
    for seed in 0..count {
        let file =
            from_str(&wall(25, 40, friction).replace("seed = 3", &format!("seed = {seed}")), Syntax::Toml, None)?;
        all.push(prepare_case(file.case, Path::new(""))?);
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
        measure([(25, 40), (80, 125), (250, 400)], friction, steps)?;
        measure([(25, 40), (25, 400), (25, 4000)], friction, steps)?;
        let one = in_turn(1, friction, steps, None)?;
        in_turn(99, friction, steps, Some(one))?;
    }
    Ok(())
}
