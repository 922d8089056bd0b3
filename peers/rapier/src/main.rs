//! The dry wall that slides on its base and the block that rocks, by rapier and by Concio in turn: what they are off by from
//! closed forms, and their times over that of Concio at 1 ms. Both get the base as a push on every body.

use std::f64::consts::TAU;
use std::time::Instant;

use concio_planar::G;
use concio_planar::body::Body;
use concio_planar::motion::{Forcing, Motion, Setting, System};
use concio_planar::shape::Place;
use rapier2d_f64::prelude::*;

/// Largest slip of a rigid block, μ = 0.6, on a base with 0.8 g at 3 Hz during 2 s [m]: Newmark's sliding block, from the
/// exact motion within steps of 1 µs.
const NEWMARK: f64 = 6.555_93e-3;
/// From half of α to upright [s]: Housner's block of 0.6 m × 1.8 m.
const QUARTER: f64 = 0.474_337_658_431_73;
const HALF: [f64; 2] = [0.3, 0.9];
/// Times that everything is run; the least time counts.
const TURNS: usize = 3;

/// How rapier is set.
#[derive(Clone, Copy)]
struct Tuning {
    name: &'static str,
    step: f64,
    iterations: usize,
    /// Typical length [m], to which its allowances refer.
    unit: f64,
    /// Of contacts [Hz]; none as it comes.
    frequency: Option<f64>,
}

enum Program {
    Concio { step: f64 },
    Rapier(Tuning),
}

/// Of both problems: time by the clock [s] and what came out.
#[derive(Default, Clone, Copy)]
struct Result {
    slip: f64,
    slid: f64,
    drift: f64,
    drifted: f64,
    quarter: f64,
    rocked: f64,
}

fn main() {
    let step = |step| Program::Concio { step };
    let tuned =
        |name, step, iterations, unit, frequency| Program::Rapier(Tuning { name, step, iterations, unit, frequency });
    let programs = [
        step(1e-3),
        step(1e-2),
        step(5e-3),
        step(2e-3),
        step(1.0 / 60.0),
        step(2.5e-4),
        tuned("as it comes", 1.0 / 60.0, 4, 1.0, None),
        tuned("as it comes", 1e-3, 4, 1.0, None),
        tuned("length of a brick", 1e-3, 4, 0.05, None),
        tuned("stiff", 1e-3, 4, 0.01, Some(1e3)),
        tuned("stiff", 1e-3, 20, 0.01, Some(1e3)),
        tuned("stiff", 2.5e-4, 4, 0.01, Some(4e3)),
        tuned("stiff", 2.5e-4, 20, 0.01, Some(4e3)),
        tuned("stiff", 1e-4, 20, 0.01, Some(1e4)),
    ];
    let mut best =
        vec![Result { slid: f64::MAX, drifted: f64::MAX, rocked: f64::MAX, ..Result::default() }; programs.len()];
    for _ in 0..TURNS {
        for (program, best) in programs.iter().zip(&mut best) {
            let now = measured(program);
            *best = Result {
                slid: now.slid.min(best.slid),
                drifted: now.drifted.min(best.drifted),
                rocked: now.rocked.min(best.rocked),
                ..now
            };
        }
    }
    println!(
        "| program | step [s] | iterations | slip off by | time | drift at 0.3 g [m] | time | quarter period off by | time |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (program, r) in programs.iter().zip(&best) {
        let (name, step, iterations) = match program {
            Program::Concio { step } => ("Concio".to_string(), *step, "–".to_string()),
            Program::Rapier(t) => (format!("rapier, {}", t.name), t.step, t.iterations.to_string()),
        };
        println!(
            "| {name} | {step:.2e} | {iterations} | {:+.2} % | {:.2} | {:.1e} | {:.2} | {:+.2} % | {:.2} |",
            100.0 * (r.slip / NEWMARK - 1.0),
            r.slid / best[0].slid,
            r.drift,
            r.drifted / best[0].drifted,
            100.0 * (r.quarter / QUARTER - 1.0),
            r.rocked / best[0].rocked
        );
    }
    println!("Time 1: {:.3} s, {:.3} s, {:.5} s.", best[0].slid, best[0].drifted, best[0].rocked);
}

fn measured(program: &Program) -> Result {
    let timed = |run: &dyn Fn() -> f64| {
        let start = Instant::now();
        let found = run();
        (found, start.elapsed().as_secs_f64())
    };
    let shaken = |a: f64| timed(&|| shaken(program, a));
    let ((slip, slid), (drift, drifted)) = (shaken(0.8 * G), shaken(0.3 * G));
    let (quarter, rocked) = timed(&|| quarter(program));
    Result { slip, slid, drift, drifted, quarter, rocked }
}

/// Largest slip of the bottom course during 2 s of 3 Hz [m].
fn shaken(program: &Program, a: f64) -> f64 {
    let base = |t: f64| a / (3.0 * TAU) * (1.0 - (3.0 * TAU * t).cos());
    let (mut scene, step) = Scene::new(program, &wall(), 0.6);
    let start = scene.place(0).centre[0];
    let mut peak: f64 = 0.0;
    for k in 0..(2.0 / step).round() as usize {
        let t = k as f64 * step;
        scene.step(base(t + step) - base(t));
        peak = peak.max((scene.place(0).centre[0] - start).abs());
    }
    peak
}

/// Time from half of α to upright [s].
fn quarter(program: &Program) -> f64 {
    let [b, h] = HALF;
    let (mut scene, step) = Scene::new(program, &[brick("block", [-b, b], [0.0, 2.0 * h])], 10.0);
    let angle = -0.5 * b.atan2(h);
    let (s, c) = angle.sin_cos();
    scene.put(Place { centre: [b - c * b - s * h, -s * b + c * h], angle });
    let mut last = angle;
    for k in 0..(1.0 / step) as usize {
        scene.step(0.0);
        let now = scene.place(0).angle;
        if now >= 0.0 {
            return k as f64 * step + step * last / (last - now);
        }
        last = now;
    }
    f64::NAN
}

fn brick(name: &str, x: [f64; 2], y: [f64; 2]) -> Body {
    Body::rectangle(name, x, y, 1835.0 * 0.12 * (x[1] - x[0]) * (y[1] - y[0]))
}

/// Dry running bond of 10 × 10 bricks, half bricks at the ends of every second course.
fn wall() -> Vec<Body> {
    let (l, h) = (0.25, 0.055);
    let mut bodies = Vec::new();
    for course in 0..10u32 {
        let y = [f64::from(course) * h, f64::from(course + 1) * h];
        let shift = if course % 2 == 0 { 0.0 } else { -0.5 };
        for k in 0..11 {
            let x = [0.0, 1.0].map(|side| (l * (f64::from(k) + shift + side)).clamp(0.0, 10.0 * l));
            if x[1] > x[0] {
                bodies.push(brick(&format!("{course}"), x, y));
            }
        }
    }
    bodies
}

enum Scene {
    Concio(Box<Motion>),
    Rapier { world: Box<PhysicsWorld>, bodies: Vec<RigidBodyHandle>, step: f64 },
}

impl Scene {
    fn new(program: &Program, bodies: &[Body], friction: f64) -> (Self, f64) {
        match program {
            Program::Concio { step } => {
                (Scene::Concio(Box::new(Motion::new(&System::dry(bodies, friction), Setting::new(*step)))), *step)
            }
            Program::Rapier(tuning) => {
                let mut world = Box::new(PhysicsWorld::new());
                let parameters = &mut world.integration_parameters;
                parameters.dt = tuning.step;
                parameters.num_solver_iterations = tuning.iterations;
                parameters.length_unit = tuning.unit;
                if let Some(frequency) = tuning.frequency {
                    parameters.contact_softness.natural_frequency = frequency;
                    parameters.static_contact_softness.natural_frequency = frequency;
                }
                let base = ColliderBuilder::cuboid(10.0, 1.0).translation(Vector::new(0.0, -1.0)).friction(friction);
                world.insert_collider(base, None);
                let mut add = |body: &Body| {
                    let [l, h] = body.corners[2];
                    let rigid = RigidBodyBuilder::dynamic().can_sleep(false);
                    let rigid = rigid.translation(Vector::new(body.centre[0], body.centre[1]));
                    let shape = ColliderBuilder::cuboid(l, h).friction(friction).mass(body.mass);
                    world.insert(rigid, shape).0
                };
                let bodies = bodies.iter().map(&mut add).collect();
                (Scene::Rapier { world, bodies, step: tuning.step }, tuning.step)
            }
        }
    }

    fn put(&mut self, place: Place) {
        match self {
            Scene::Concio(motion) => motion.put(0, place),
            Scene::Rapier { world, bodies, .. } => {
                let at = Pose::new(Vector::new(place.centre[0], place.centre[1]), place.angle);
                world.bodies[bodies[0]].set_position(at, true);
            }
        }
    }

    fn step(&mut self, base: f64) {
        match self {
            Scene::Concio(motion) => motion.step(Forcing { base: [base, 0.0], held: 0.0 }),
            Scene::Rapier { world, step, .. } => {
                world.gravity = Vector::new(-base / *step, -G);
                world.step();
            }
        }
    }

    fn place(&self, body: usize) -> Place {
        match self {
            Scene::Concio(motion) => motion.places[body],
            Scene::Rapier { world, bodies, .. } => {
                let body = &world.bodies[bodies[body]];
                let at = body.translation();
                Place { centre: [at.x, at.y], angle: body.rotation().angle() }
            }
        }
    }
}
