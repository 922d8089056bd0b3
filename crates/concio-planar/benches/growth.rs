//! How the cost of a step grows with the wall: `cargo bench -p concio-planar --bench growth [-- SECONDS]`.
//!
//! Dry running bond of stones 0.4 m × 0.2 m × 0.12 m with soft joints (24 GPa/m, shear 0.4 of it, μ = 0.6) under 3 Hz and 0.5 g in
//! steps of 4 ms, for 0.4 s unless said: square walls, walls of 16 courses that grow in length, and as many of the smallest as make such a
//! wall, one step of each in turn, which is what memory alone costs. Printed are iterations per step, and time per block and step over
//! that of the smallest wall, which goes again beside each of the others.

use std::f64::consts::PI;
use std::time::Instant;

use concio_planar::G;
use concio_planar::body::Body;
use concio_planar::joint::{Friction, Law, Normal, Shear};
use concio_planar::motion::{Forcing, Link, Motion, Setting, System};

const STEP: f64 = 4e-3;
const STONE: [f64; 3] = [0.4, 0.2, 0.12];
const DENSITY: f64 = 1835.0;
const STIFFNESS: f64 = 24e9;
/// Courses and stones per course.
const SQUARE: [[usize; 2]; 4] = [[16, 16], [32, 32], [48, 48], [70, 70]];
const LONG: [[usize; 2]; 4] = [[16, 16], [16, 64], [16, 144], [16, 300]];
/// Walls in turn.
const MANY: [usize; 4] = [1, 4, 9, 19];

fn law(length: f64) -> Law {
    let press = STIFFNESS * length * STONE[2];
    Law {
        normal: Normal::Springs { both: 0.0, press, damping: 0.0 },
        shear: Shear { stiffness: 0.4 * press, damping: 0.0, series: true },
        ..Law::dry(Some(Friction::coulomb(0.6)))
    }
}

/// Half stones at both ends of every second course.
fn wall([courses, stones]: [usize; 2]) -> System {
    let [length, height, thickness] = STONE;
    let (mut bodies, mut links) = (Vec::new(), Vec::new());
    let mut below: Vec<([f64; 2], usize)> = Vec::new();
    for course in 0..courses {
        let y = [course as f64 * height, (course + 1) as f64 * height];
        let mut cuts: Vec<f64> = (0..=stones).map(|k| (k as f64 + 0.5 * (course % 2) as f64) * length).collect();
        if course % 2 == 1 {
            cuts.insert(0, 0.0);
            cuts[stones + 1] = stones as f64 * length;
        }
        let mut row: Vec<([f64; 2], usize)> = Vec::new();
        for cut in cuts.windows(2) {
            let (x, own) = ([cut[0], cut[1]], bodies.len());
            bodies.push(Body::rectangle("stone", x, y, DENSITY * (x[1] - x[0]) * height * thickness));
            if let Some((_, left)) = row.last() {
                links.push(Link::closed(Some(*left), own, law(height)));
            }
            if course == 0 {
                links.push(Link::closed(None, own, law(x[1] - x[0])));
            }
            for (other, under) in &below {
                let overlap = x[1].min(other[1]) - x[0].max(other[0]);
                if overlap > 1e-9 {
                    links.push(Link::closed(Some(*under), own, law(overlap)));
                }
            }
            row.push((x, own));
        }
        below = row;
    }
    System { links, ..System::dry(&bodies, 0.6) }
}

struct Cost {
    blocks: usize,
    /// Per step and wall.
    iterations: f64,
    /// Per block and step [s].
    time: f64,
    halved: u64,
    unsolved: u64,
}

/// This many walls of a size, one step of each in turn.
fn shaken(size: [usize; 2], walls: usize, seconds: f64) -> Cost {
    let system = wall(size);
    let blocks = walls * system.bodies.len();
    let mut motion = Motion::new(&system, Setting::new(STEP));
    motion.stand(1e-9, 400);
    let mut motions = vec![motion; walls];
    let base = |t: f64| 0.5 * G / (6.0 * PI) * (1.0 - (6.0 * PI * t).cos());
    let steps = (seconds / STEP).round();
    let begun = Instant::now();
    for _ in 0..steps as usize {
        for motion in &mut motions {
            motion.go(STEP, &|from, to| Forcing { base: [base(to) - base(from), 0.0], held: 0.0 });
        }
    }
    let time = begun.elapsed().as_secs_f64();
    let sum = |count: fn(&Motion) -> u64| motions.iter().map(count).sum::<u64>();
    Cost {
        blocks,
        iterations: sum(|m| m.counters.iterations) as f64 / (steps * walls as f64),
        time: time / (steps * blocks as f64),
        halved: sum(|m| m.counters.halved),
        unsolved: sum(|m| m.counters.unsolved),
    }
}

fn main() {
    let seconds = std::env::args().find_map(|a| a.parse().ok()).unwrap_or(0.4);
    let one = |size| (size, 1);
    let smallest = SQUARE[0];
    for (what, walls) in [
        ("square", SQUARE.map(one)),
        ("16 courses", LONG.map(one)),
        ("many in turn", MANY.map(|walls| (smallest, walls))),
    ] {
        for (size, number) in walls {
            let (cost, least) = (shaken(size, number, seconds), shaken(smallest, 1, seconds));
            println!(
                "{what}, {} blocks: {:.1} iterations per step, {} halved, {} unsolved, time per block and step {:.2}",
                cost.blocks,
                cost.iterations,
                cost.halved,
                cost.unsolved,
                cost.time / least.time
            );
        }
    }
}
