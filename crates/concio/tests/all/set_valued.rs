//! Friction that sticks truly, against closed forms. A3 to A6 are those of the project's reference collection; each
//! is computed here from its formula too, where there is one.

use std::f64::consts::PI;

use concio::bond::Bond;
use concio::case::{self, Pulse, PulseShape, Ramp, Scheme, Signal, Solver};
use concio::excitation::Excitation;
use concio::ground::signal::{GroundMotion, compile};
use concio::law::Stribeck;
use concio::record::StopReason;
use concio::run::{prepare_case, run_in_memory};
use concio::samples::{Histories, Link, lumped, respond, shaking, solver};
use concio::simulate::{Sampling, Simulation};
use concio::wall::End;
use concio_verified::{agrees, farthest};

const M: f64 = 100.0;
const K: f64 = 4e5;
const N: f64 = 981.0;

fn coulomb(static_: f64, dynamic: f64) -> Stribeck {
    Stribeck { static_, dynamic, slip_velocity: 0.0, beta: f64::INFINITY, alpha: 0.0 }
}

fn fine(tolerance: f64) -> Solver {
    solver(Scheme::TrBdf2, tolerance)
}

fn first(h: &Histories) -> Vec<f64> {
    h.displacement.iter().map(|row| row[0]).collect()
}

fn signal(signal: Signal) -> GroundMotion {
    compile(&signal, std::path::Path::new("")).unwrap()
}

/// A3: amplitudes fall by 2μN/k each half cycle, and after eight the block stays where it is, at 0.228 mm.
#[test]
fn coulomb_decrement_and_where_it_stops() {
    let (mu, x0) = (0.3, 0.012);
    let links = [Link::spring(0, End::Base, K, 0.0), Link::friction(0, End::Base, coulomb(mu, mu), N)];
    let half = PI / (K / M).sqrt();
    let model = lumped(&[M], &links, Excitation::of_base(GroundMotion::AtRest, 12.0 * half));
    // Samples at the turning points.
    let h = respond(&model, &fine(1e-9), half, &[x0], &[0.0]).unwrap();
    let x = first(&h);
    let exact = |k: usize| (x0 - k as f64 * 2.0 * mu * N / K) * if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let off = farthest((0..=8).map(|k| (x[k] / x0, exact(k) / x0)));
    let subject = "Friction: Coulomb's law beside a spring, amplitudes of 8 half cycles, largest error over x₀";
    agrees!(subject, "x₀ − 2 n μN/k", "", off, 0.0, abs: 1e-6);
    let against = "x₀ − 16 μN/k";
    agrees!("Friction: Coulomb's law beside a spring, where it stops", against, "m", x[8], 0.000228, abs: 1e-6 * x0);
    assert_eq!(x[9..], [x[9]; 4], "it moved after it stopped");
    assert!(h.residual < 1e-6, "energy residual {}", h.residual);
}

/// A4: a block on a belt of 0.05 m/s, μ_s 0.6, μ_k 0.4.
#[test]
fn stick_slip_belt() {
    let (mu_s, mu_k, v) = (0.6, 0.4, 0.05f64);
    let links = [Link::spring(0, End::Base, K, 0.0), Link::friction(0, End::Top, coulomb(mu_s, mu_k), N)];
    let ramp = Ramp { amplitude: (v * 100.0).into(), start: 0.0.into(), rise: 100.0.into() };
    let model = lumped(&[M], &links, Excitation::of_top(signal(Signal::Ramp(ramp)), 1.0));
    let h = respond(&model, &fine(1e-9), 1e-5, &[mu_k * N / K], &[v]).unwrap();
    let x = first(&h);
    let (release, centre) = (mu_s * N / K, mu_k * N / K);
    let omega = (K / M).sqrt();
    let slip = (2.0 * PI - 2.0 * ((release - centre) * omega / v).atan()) / omega;
    let period = slip + 2.0 * (release - centre) / v;
    assert!((period - 0.10140535380222271f64).abs() < 1e-14, "A4's T_total");
    // Sticking, the block passes the centre at the speed of the belt: instants to a fraction of a sample.
    let passes: Vec<f64> = (1..x.len())
        .filter(|&i| x[i - 1] < centre && x[i] >= centre)
        .map(|i| 1e-5 * (i as f64 - (x[i] - centre) / (x[i] - x[i - 1])))
        .collect();
    assert!(passes.len() >= 8, "{passes:?}");
    let measured = (passes[passes.len() - 1] - passes[0]) / (passes.len() - 1) as f64;
    let against = "sticking to μ_s N/k, then a half wave about μ_k N/k";
    agrees!("Friction: static and dynamic, block on a belt, period", against, "s", measured, period, 1e-6);
    let largest = x.iter().fold(0.0f64, |a, x| a.max(*x));
    let exact = centre + ((release - centre).powi(2) + (v / omega).powi(2)).sqrt();
    agrees!("Friction: static and dynamic, block on a belt, peak", against, "m", largest, exact, 1e-6);
}

/// A5: steady amplitude of a block with Coulomb friction under P0 cos ωt, in units of P0/k, also where it sticks for
/// part of the cycle and Den Hartog's formula does not hold (the exact piecewise solution then).
#[test]
fn den_hartog() {
    let rows = [
        (0.8, 0.2, 2.7114152554374567),
        (0.8, 0.5, 2.332234987541274),
        (0.8, 0.7, 1.8037904161326552),
        (1.25, 0.2, 1.7082175349494955),
        (1.25, 0.5, 1.2825568503425595),
        (1.25, 0.7, 0.43636165101798075),
        (2.0, 0.2, 0.3179797338056601),
        (2.0, 0.5, 0.22047927592206112),
        (2.0, 0.7, 0.07009969363428104),
        (0.6, 0.5, 1.486581571431088),
        (0.9, 0.5, 4.215903716779148),
    ];
    let omega = (K / M).sqrt();
    for (beta, ratio, exact) in rows {
        let frequency = beta * omega / (2.0 * PI);
        let a = 9.0;
        let mu = ratio * M * a / N;
        let links = [Link::spring(0, End::Base, K, 0.0), Link::friction(0, End::Base, coulomb(mu, mu), N)];
        let cycles = 80.0;
        let motion = Excitation::of_base(shaking(a, frequency).unwrap(), cycles / frequency);
        let model = lumped(&[M], &links, motion);
        let h = respond(&model, &fine(1e-7), 1.0 / (frequency * 400.0), &[0.0], &[0.0]).unwrap();
        let x = first(&h);
        let last = &x[x.len() - 400..];
        let (low, high) = last.iter().fold((0.0f64, 0.0f64), |(l, h), x| (l.min(*x), h.max(*x)));
        let amplitude = 0.5 * (high - low) / (M * a / K);
        // Between samples, 1/400 of a cycle apart, a peak is missed by up to 3e-5 of itself.
        let subject = format!("Friction: Coulomb's law under a sine, amplitude; β = {beta}, F/P₀ = {ratio}");
        let against = "Den Hartog 1931; where it sticks in between, piecewise solution";
        agrees!(subject, against, "P₀/k", amplitude, exact, 1e-4);
    }
}

/// A6: slip of a rigid block (μ 0.2) under pulses of 0.5 g and 0.2 s: V²/2 (1/(μg) − 1/A) for the rectangle.
#[test]
fn newmark_pulses() {
    let v: f64 = 4.905 * 0.2;
    let rectangle: f64 = 0.5 * v * v * (1.0 / (0.2 * 9.81) - 1.0 / 4.905);
    assert!((rectangle - 0.14715).abs() < 1e-12);
    for (shape, exact) in [(PulseShape::Rectangular, rectangle), (PulseShape::HalfSine, 0.04495112308557409)] {
        let pulse = Pulse { shape, acceleration: 4.905.into(), duration: 0.2.into(), start: 0.0.into() };
        let motion = Excitation::of_base(signal(Signal::Pulse(pulse)), 0.6);
        let model = lumped(&[M], &[Link::friction(0, End::Base, coulomb(0.2, 0.2), M * 9.81)], motion);
        let h = respond(&model, &fine(1e-8), 1e-3, &[0.0], &[0.0]).unwrap();
        assert_eq!(h.stop_reason, StopReason::Completed);
        let slip = first(&h).last().unwrap().abs();
        let subject = format!("Friction: Coulomb's law, slip under a pulse of 0.5 g; {shape:?}");
        agrees!(subject, "Newmark's sliding block", "m", slip, exact, 1e-5);
    }
}

/// A block that sticks up to μ_s g and slides with μ_d g, beside a spring of ω², on a base of the acceleration `a`, in steps of
/// `dt`: displacements relative to the base after every step.
fn sliding(a: impl Fn(f64) -> f64, [mu_s, mu_d]: [f64; 2], omega: f64, duration: f64, dt: f64) -> Vec<f64> {
    let (most, slides) = (mu_s * 9.81, mu_d * 9.81);
    let (mut x, mut v) = (0.0, 0.0);
    let pushed = |t: f64, x: f64| -a(t) - omega * omega * x;
    let step = |k: usize| {
        let t = k as f64 * dt;
        let way: f64 = if v == 0.0 { pushed(t, x) } else { v };
        if v != 0.0 || way.abs() > most {
            let friction = -slides * way.signum();
            let w = v + dt * (pushed(t + 0.5 * dt, x + 0.5 * dt * v) + friction);
            // What turns round has come to rest on the way.
            (x, v) = if w * way > 0.0 { (x + 0.5 * dt * (v + w), w) } else { (x + 0.5 * dt * v, 0.0) };
        }
        x
    };
    (0..(duration / dt).round() as usize).map(step).collect()
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| x.abs().max(most))
}

/// Friction that falls at once as a block lets go for the first time, which nothing has moved before: slip under pulses of 0.6 g and 0.3 s with μ_s = 0.5
/// and μ_d = 0.3, at the default tolerance and at a fine one. V²/2 (1/(μ_d g) − 1/A) for the rectangle. Under the half sine the block starts at t_1,
/// when A sin ωt = μ_s g, and has V = A/ω (1 + cos ωt_1) − μ_d g (T − t_1) at its end T. The whole sine is integrated in steps of 0.1 µs.
#[test]
fn newmark_pulses_with_less_friction_in_slip() {
    let (mu_s, mu_d, a, duration) = (0.5, 0.3, 0.6 * 9.81, 0.3);
    let slides = mu_d * 9.81;
    let (v, omega) = (a * duration, PI / duration);
    let rectangle = 0.5 * v * v * (1.0 / slides - 1.0 / a);
    let from = (mu_s * 9.81 / a).asin() / omega;
    let (cosine, left) = ((omega * from).cos(), duration - from);
    let v = a / omega * (1.0 + cosine) - slides * left;
    let way = a / omega * cosine * left + a / (omega * omega) * (omega * from).sin() - 0.5 * slides * left * left;
    let half = way + v * v / (2.0 * slides);
    let base = |t: f64| if t < duration { a * (2.0 * omega * t).sin() } else { 0.0 };
    let whole = sliding(base, [mu_s, mu_d], 0.0, 1.2, 1e-7);
    let (end, farthest) = (whole[whole.len() - 1].abs(), largest(&whole));
    let default = Solver::default();
    for (scheme, tolerance, within) in
        [(default.scheme, default.tolerance, 5e-3), (default.scheme, 1e-8, 1e-5), (Scheme::Esdirk4, 1e-8, 1e-5)]
    {
        // Under the whole sine the block comes back: what it may miss is a part of how far it was.
        for (shape, exact, way) in [
            (PulseShape::Rectangular, rectangle, rectangle),
            (PulseShape::HalfSine, half, half),
            (PulseShape::OneSine, end, farthest),
        ] {
            let pulse = Pulse { shape, acceleration: a.into(), duration: duration.into(), start: 0.1.into() };
            let motion = Excitation::of_base(signal(Signal::Pulse(pulse)), 1.3);
            let model = lumped(&[M], &[Link::friction(0, End::Base, coulomb(mu_s, mu_d), M * 9.81)], motion);
            let h = respond(&model, &solver(scheme, tolerance), 1e-3, &[0.0], &[0.0]).unwrap();
            assert_eq!(h.stop_reason, StopReason::Completed, "{shape:?}, {scheme:?}, {tolerance:e}");
            let slip = first(&h).last().unwrap().abs();
            let subject = format!(
                "Friction: static and dynamic, slip under a pulse of 0.6 g, tolerance {tolerance:e}; {shape:?}, {scheme:?}"
            );
            agrees!(subject, "Newmark's sliding block", "m", slip, exact, abs: within * way);
        }
    }
}

/// A push that grows to 0.7 g for a tenth of a second and turns to a smaller one the other way, held from then on: the stone that it sent off stops, and
/// friction at rest, 0.4, holds it under any load between that in slip, 0.3, and itself. Alone, and with another on it; by both laws that stick.
#[test]
fn a_stone_that_stops_under_a_load_that_friction_holds_stays() {
    let interval = 5e-3;
    let nearly = Stribeck { slip_velocity: 1e-4, ..coulomb(0.4, 0.3) };
    for held in (0..10).map(|k| 0.305 + 0.01 * f64::from(k)) {
        let samples: Vec<f64> = (0..300)
            .map(|k| {
                if k < 10 {
                    0.0
                } else if k < 30 {
                    -0.7 * 9.81
                } else {
                    held * 9.81
                }
            })
            .collect();
        let base = |t: f64| {
            let (at, part) = ((t / interval) as usize, (t / interval).fract());
            let of = |k: usize| samples[k.min(299)];
            of(at) + part * (of(at + 1) - of(at))
        };
        let way = sliding(base, [0.4, 0.3], 0.0, 1.4, 1e-6);
        let way = way[way.len() - 1].abs();
        for (name, law, within) in [("coulomb", coulomb(0.4, 0.3), 1e-3), ("stribeck-stick", nearly, 3e-3)] {
            for (stones, scheme) in [(1, Scheme::TrBdf2), (2, Scheme::TrBdf2), (1, Scheme::Esdirk4)] {
                let rubs = |i: usize| {
                    let below = if i == 0 { End::Base } else { End::Block(i - 1) };
                    Link::friction(i, below, law, (stones - i) as f64 * M * 9.81)
                };
                let links: Vec<Link> = (0..stones).map(rubs).collect();
                let ground = GroundMotion::sampled(interval, &samples).expect("a motion");
                let model = lumped(&vec![M; stones], &links, Excitation::of_base(ground, 1.4));
                let still = vec![0.0; stones];
                let solver = solver(scheme, Solver::default().tolerance);
                let h = respond(&model, &solver, 1e-2, &still, &still).expect("a run");
                let found = first(&h).last().expect("a sample").abs();
                let subject = format!(
                    "Friction: a slide that stops under a held load; {held:.3} g, {name}, {scheme:?}, {stones} stones"
                );
                agrees!(subject, "Newmark's sliding block", "m", found, way, within);
            }
        }
    }
}

/// Walls of one block as a user writes them, at the default tolerance: on friction alone, and beside a soft spring.
#[test]
fn a_column_of_one_brick_slides_where_friction_falls_at_once() {
    let mass: f64 = (20e3 * 0.2 * 0.3 + 50e3) / 9.81;
    let (a, frequency) = (0.7 * 9.81, 2.0);
    for (bed, stiffness) in
        [(r#"{ law = "none" }"#, 0.0), (r#"{ law = "elastic", stiffness = "0.001 N/mm3" }"#, 1e6 * 0.3)]
    {
        let text = format!(
            r#"
model = "shear"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = {{ length = "1 m", height = "0.2 m", thickness = "0.3 m", specific_weight = "20 kN/m3" }}
mortar = {{ bed = 0, head = 0 }}
[joint]
damping_ratio = 0
bed = {bed}
head = {{ law = "rigid" }}
friction = {{ law = "coulomb", static = 0.5, dynamic = 0.3, on = "bed" }}
[load]
top = "50 kN/m"
[motion]
duration = "3 s"
base = {{ sine = {{ acceleration = "0.7 g", frequency = "2 Hz", ramp = "0 s" }} }}
[output]
interval = "1 ms"
blocks = ["all"]
"#
        );
        let file = case::from_str(&text, case::Syntax::Toml, None).unwrap();
        let prepared = prepare_case(file.case, std::path::Path::new(".")).unwrap();
        let outcome = run_in_memory(&prepared).unwrap();
        assert_eq!(outcome.stop_reason, StopReason::Completed, "{bed}");
        let omega = f64::sqrt(stiffness / mass);
        let exact = sliding(|t| a * (2.0 * PI * frequency * t).sin(), [0.5, 0.3], omega, 3.0, 1e-6);
        let history = outcome.history("block/p1c1b1/displacement").unwrap();
        let (peak, end) = (largest(&exact), exact[exact.len() - 1]);
        let subject = |what: &str| {
            format!("Friction: static and dynamic, a wall of one brick under 0.7 g at 2 Hz, {what}; {bed}")
        };
        let against = "Newmark's sliding block in steps of 1 µs";
        agrees!(subject("peak"), against, "m", outcome.totals.peak_relative_displacement, peak, 5e-3);
        agrees!(subject("end"), against, "m", history[history.len() - 1], end, abs: 5e-3 * peak);
    }
}

/// A block under a constant base acceleration A: stuck, its joint bears m A; in slip μ_k N, whatever μ_s would allow; a
/// bond that holds leaves nothing to friction.
#[test]
fn friction_force_is_what_the_joint_bears() {
    let (mu_s, mu_k) = (0.5, 0.3);
    let bond = Bond { strength: 1e4, stiffness: K, residual: 0.0, decay: 0.0, opens: false };
    let law = coulomb(mu_s, mu_k);
    let free = Link::friction(0, End::Base, law, N);
    let bonded = Link::bonded(0, End::Base, bond, Some((law, N)));
    for (link, a, exact, name) in [
        (free, 3.0, 300.0, "stuck"),
        (free, -3.0, 300.0, "stuck the other way"),
        (free, 6.0, mu_k * N, "slipping"),
        (bonded, 3.0, 0.0, "bonded"),
    ] {
        let pulse =
            Pulse { shape: PulseShape::Rectangular, acceleration: a.into(), duration: 0.2.into(), start: 0.05.into() };
        let model = lumped(&[M], &[link], Excitation::of_base(signal(Signal::Pulse(pulse)), 0.6));
        let sampling = Sampling { interval: 0.01, frame_every: 0, blocks: Vec::new(), joints: Vec::new() };
        let mut run = Simulation::new(&model, &fine(1e-8), &sampling).unwrap();
        assert_eq!(run.run_to_end().1, StopReason::Completed);
        let found = run.state().totals.peak_friction_force;
        let subject = format!("Friction: force of a block accelerated at once; {name}");
        agrees!(subject, "min(m a, μ_k N), nothing beside a bond", "N", found, exact, abs: 1e-9 * M * a.abs());
    }
}

/// Blocks on a slope of their own: five in a row, each stuck to the next and to the base, pushed by less than they can
/// bear. Nothing moves, in 1000 s.
#[test]
fn what_sticks_stays() {
    let links: Vec<Link> = (0..5)
        .flat_map(|i| {
            let next = if i < 4 { End::Block(i + 1) } else { End::Base };
            [
                Link::spring(i, End::Base, K, 100.0),
                Link::friction(i, next, coulomb(0.5, 0.3), N),
                Link::friction(i, End::Base, coulomb(0.5, 0.3), N),
            ]
        })
        .collect();
    // A step of base acceleration of 0.4 g: 392 N on each of the blocks.
    let pulse =
        Pulse { shape: PulseShape::Rectangular, acceleration: 3.92.into(), duration: 1e4.into(), start: 0.5.into() };
    let motion = Excitation::of_base(signal(Signal::Pulse(pulse)), 1000.0);
    let model = lumped(&[M; 5], &links, motion);
    let h = respond(&model, &fine(1e-4), 10.0, &[0.0; 5], &[0.0; 5]).unwrap();
    assert_eq!(h.stop_reason, StopReason::Completed);
    assert!(h.displacement.iter().flatten().all(|x| *x == 0.0), "{:?}", h.displacement.last());
    assert!(h.velocity.iter().flatten().all(|v| *v == 0.0));
}
