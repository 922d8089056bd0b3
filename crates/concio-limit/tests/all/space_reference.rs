//! Limit analysis in space against values computed before by a second program, and closed forms of walls.

use concio_limit::space::{
    Assembly, Cuboid, Facade, Limit, Problem, analyse, without_dilation,
};

/// γ [N/m³].
const WEIGHT: f64 = 20e3;
const OUTWARDS: [f64; 3] = [-1.0, 0.0, 0.0];

fn facade(length: f64, sides: [bool; 2], course: f64, courses: usize, depth: f64) -> Facade {
    Facade { thickness: 0.2, course, courses, length, sides, depth, specific_weight: WEIGHT }
}

fn problem(blocks: &[Cuboid], mu: f64) -> Problem {
    Problem::new(Assembly::of_boxes(blocks, mu).expect("a wall"), OUTWARDS)
}

fn found(what: &str, problem: &Problem) -> Limit {
    let start = std::time::Instant::now();
    let limit = analyse(problem).unwrap_or_else(|e| panic!("{what}: {e}"));
    println!(
        "{what}: {} bodies, {} contacts: {:.6} … {:.6} gap {:.1e} unbalanced {:.1e} N, {} its, {:.2?} {:?}",
        problem.assembly.bodies.len(),
        problem.assembly.contacts.len(),
        limit.bounds[0],
        limit.bounds[1],
        limit.gap(),
        limit.unbalanced,
        limit.iterations,
        start.elapsed(),
        limit.mechanism.kind,
    );
    limit
}

#[test]
fn explore() {
    let l1 = facade(2.0, [false; 2], 0.2, 10, 0.0).blocks().unwrap();
    found("L1", &problem(&l1, 0.6));
    for (name, length, sides, mu) in [
        ("L3", 2.0, [true, true], 0.6),
        ("L4", 2.0, [true, true], 0.3),
        ("L5", 4.0, [true, true], 0.6),
        ("L5 .3", 4.0, [true, true], 0.3),
        ("L6", 2.0, [true, false], 0.6),
    ] {
        let blocks = facade(length, sides, 0.2, 10, 2.4).blocks().unwrap();
        let p = problem(&blocks, mu);
        found(name, &p);
        found(&format!("{name} frictionless"), &p.frictionless_heads());
    }
    let blocks = facade(2.0, [true, true], 0.1, 20, 4.8).blocks().unwrap();
    let p = problem(&blocks, 0.6);
    found("L7", &p);
    found("L7 frictionless", &p.frictionless_heads());
}
#[test]
fn explore_nodil() {
    let blocks = facade(2.0, [true; 2], 0.2, 10, 2.4).blocks().unwrap();
    let p = problem(&blocks, 0.6);
    let l = found("L3", &p);
    println!("{:?}", without_dilation(&p, &l));
}
