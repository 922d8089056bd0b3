//! Memory per block. Alone in its program, because it counts what the whole program asks for.

use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::run::prepare_case;
use concio::simulate::{Progress, Simulation};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const WALL: &str = r#"
model = "shear"
set = "report"
[[panel]]
bond = "running"
courses = 250
bricks = 400
[joint]
friction = { law = "stribeck", static = 0.6, dynamic = 0.42 }
[load]
top = "2 kN/m"
[motion]
duration = "0.3 s"
base = { synthetic = { seed = 3, pga = "0.8 g", duration = "4 s" } }
[output]
interval = "0.01 s"
frames = "0 s"
"#;

/// A model and a run under way, without output, take no more than 2 kB per block.
#[test]
fn memory_per_block() {
    let before = MEMORY.current_usage();
    let file = from_str(WALL, Syntax::Toml, None).unwrap();
    file.validate().unwrap();
    let p = prepare_case(file.case.clone(), Path::new("")).unwrap();
    let blocks = p.model.wall.blocks.len();
    assert_eq!(blocks, 100_125);
    let mut run = Simulation::new(&p.model, &p.case.solver, &p.sampling).unwrap();
    let ready = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    assert_eq!(run.advance(2), Progress::Running);
    assert_eq!(run.state().counters.steps, 2);
    let per_block = (ready - before) / blocks;
    assert!(per_block <= 2000, "{per_block} bytes per block");
    // The time loop asks for nothing.
    assert!(MEMORY.peak_usage() <= ready, "{} bytes more while stepping", MEMORY.peak_usage() - ready);
    drop(run);
    planar();
}

const DRY: &str = r#"
model = "planar"
[[panel]]
bond = "running"
courses = 10
bricks = 10
brick = { length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18e3 }
mortar = { bed = 0, head = 0 }
[joint]
bed = { law = "rigid" }
head = { law = "rigid" }
friction = { law = "coulomb", static = 0.6, dynamic = 0.6, on = "all" }
[motion]
duration = "2 s"
base = { sine = { acceleration = "0.8 g", frequency = 3, ramp = "0.1 s" } }
[output]
interval = "0.1 s"
frames = "0 s"
"#;

/// A planar wall whose bodies stay near their neighbours asks for nothing either, once it has slid for the first time.
fn planar() {
    let file = from_str(DRY, Syntax::Toml, None).unwrap();
    file.validate().unwrap();
    let p = prepare_case(file.case.clone(), Path::new("")).unwrap();
    let mut run = Simulation::new(&p.model, &p.case.solver, &p.sampling).unwrap();
    assert_eq!(run.advance(100), Progress::Running);
    let ready = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    assert_eq!(run.advance(100), Progress::Running);
    assert!(MEMORY.peak_usage() <= ready, "{} bytes more while stepping", MEMORY.peak_usage() - ready);
}
