//! Micro-benchmarks of the inner loop: friction law, assembly, factorisation, solution, a step. By hand:
//! `cargo bench --package concio --bench parts`. Each is at a state in the middle of a run: the 27 blocks of
//! xtask/walls/driven-top.toml in stick-slip, and 410 shaken ones.

use std::hint::black_box;
use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::law::Stribeck;
use concio::run::{Prepared, prepare_case};
use concio::samples::sharp_friction;
use concio::simulate::Simulation;
use concio_shear::{Part, Parts};
use divan::Bencher;
use divan::counter::ItemsCount;

fn main() {
    divan::main();
}

const SLIPPING: &str = include_str!("../../../xtask/walls/driven-top.toml");
const SHAKEN: &str = "
model = \"shear\"
set = \"report\"
[[panel]]
bond = \"running\"
courses = 20
bricks = 20
[joint]
friction = { law = \"stribeck\", static = 0.6, dynamic = 0.42 }
[load]
top = \"2 kN/m\"
[motion]
duration = \"4 s\"
base = { synthetic = { seed = 3, pga = \"0.8 g\", duration = \"4 s\" } }
";
/// The walls by name, with the time to which they are run first [s].
const WALLS: [(&str, &str, f64); 2] = [("27 blocks", SLIPPING, 0.05), ("410 blocks", SHAKEN, 1.0)];
const NAMES: [&str; 2] = [WALLS[0].0, WALLS[1].0];

/// Calls `measure` with a run in its middle.
fn in_the_middle(name: &str, measure: impl FnOnce(&Prepared, Simulation)) {
    let (_, text, until) = WALLS.iter().find(|w| w.0 == name).expect("one of the names");
    let file = from_str(text, Syntax::Toml, None).expect("a wall file");
    file.validate().expect("a valid one");
    let prepared = prepare_case(file.case, Path::new("")).expect("a wall that stands");
    let mut run = Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling).expect("no names");
    while run.time() < *until {
        run.advance(100);
        run.clear_recording();
    }
    measure(&prepared, run);
}

/// (6) and its slope for one joint.
#[divan::bench(args = [1e-7, 1e-5, 1e-3, 1e-1])]
fn law(bencher: Bencher, velocity: f64) {
    let law: Stribeck = sharp_friction(0.6, 0.42, 1e-3, 100.0);
    bencher.bench_local(|| black_box(&law).at(black_box(velocity)));
}

/// The same for all joints, one by one from the memory: what the vector loop replaces.
#[divan::bench(args = NAMES)]
fn laws_one_by_one(bencher: Bencher, wall: &str) {
    in_the_middle(wall, |prepared, run| {
        let rubs = &prepared.model.shear.rubs;
        let velocity = &run.shear().expect("a shear wall").state.tangents.velocity;
        bencher.counter(ItemsCount::new(rubs.len())).bench_local(|| {
            rubs.iter()
                .zip(velocity)
                .map(|(r, v)| black_box(r.law.at(*v)))
                .fold(0.0, |sum, (mu, slope)| sum + mu + slope)
        });
    });
}

fn part(bencher: Bencher, wall: &str, part: Part, items: fn(&Prepared) -> usize) {
    in_the_middle(wall, |prepared, run| {
        let mut parts = Parts::of(&prepared.model.shear, &run.shear().expect("a shear wall").state);
        assert!(parts.run(Part::Factors), "a matrix that is not positive is given up half way: nothing to measure");
        bencher.counter(ItemsCount::new(items(prepared))).bench_local(|| parts.run(part));
    });
}

#[divan::bench(args = NAMES)]
fn laws(bencher: Bencher, wall: &str) {
    part(bencher, wall, Part::Laws, |p| p.model.shear.rubs.len());
}

#[divan::bench(args = NAMES)]
fn elastic_assembly(bencher: Bencher, wall: &str) {
    part(bencher, wall, Part::Elastic, |p| p.model.joints.len());
}

#[divan::bench(args = NAMES)]
fn friction_assembly_and_factorisation(bencher: Bencher, wall: &str) {
    part(bencher, wall, Part::Factors, |p| p.model.unknowns());
}

#[divan::bench(args = NAMES)]
fn solution(bencher: Bencher, wall: &str) {
    part(bencher, wall, Part::Solution, |p| p.model.unknowns());
}

/// A step with its error estimate and bookkeeping.
#[divan::bench(args = NAMES)]
fn step(bencher: Bencher, wall: &str) {
    in_the_middle(wall, |prepared, run| {
        let counter = ItemsCount::new(prepared.model.unknowns());
        bencher.counter(counter).with_inputs(|| run.clone()).bench_local_refs(|run| run.advance(1));
    });
}
