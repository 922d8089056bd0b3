//! Devices in the place of mortar, (I1) to (I7): one block on each against closed forms and against an integration of its
//! own, and walls that have some.

use std::path::Path;

use concio::Error;
use concio::case::{DeviceLaw, Scheme, Syntax, from_str};
use concio::many::{Job, simulate_many};
use concio::outcome::Outcome;
use concio::record::{Recording, StopReason};
use concio::run::{Prepared, joint_rows, prepare_case, run_in_memory};
use concio::simulate::{Progress, Simulation};
use concio_verified::{agrees, farthest};

use crate::common::ready::{channel, ready};

/// A single block, 10 kg, under 40 kN/m, with the devices `base` below and `top` above it.
const BLOCK: &str = r#"
model = "shear"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = 59454.54545454545 }
[joint]
bed = { law = "elastic", stiffness = "5.4e7 N/m" }
head = { law = "none" }
friction = { law = "stribeck", static = 0.6, dynamic = 0.42 }
[[joint.change]]
at = { kind = ["base"] }
device = BASE
[[joint.change]]
at = { kind = ["top"] }
device = TOP
[load]
top = "40 kN/m"
beam = "BEAM"
[motion]
duration = DURATION
MOTION
[solver]
scheme = "tr-bdf2"
tolerance = TOLERANCE
[output]
interval = INTERVAL
frames = INTERVAL
joints = ["all"]
"#;
const MASS: f64 = 10.0;
/// A device that does nothing.
const NOTHING: &str = r#"{ law = "elastic", stiffness = 0 }"#;

struct Run {
    base: &'static str,
    top: &'static str,
    beam: &'static str,
    motion: String,
    duration: f64,
    tolerance: f64,
    samples: usize,
}

impl Run {
    fn on(base: &'static str, duration: f64) -> Self {
        let motion = r#"base = "none""#.into();
        Run { base, top: NOTHING, beam: "tied", motion, duration, tolerance: 1e-7, samples: 400 }
    }

    fn prepared(&self) -> Prepared {
        let text = BLOCK
            .replace("BASE", self.base)
            .replace("TOP", self.top)
            .replace("BEAM", self.beam)
            .replace("MOTION", &self.motion)
            .replace("DURATION", &self.duration.to_string())
            .replace("TOLERANCE", &self.tolerance.to_string())
            .replace("INTERVAL", &(self.duration / self.samples as f64).to_string());
        ready(&text)
    }

    /// From a displacement and a velocity.
    fn go(&self, z: f64, v: f64) -> Outcome {
        go(&self.prepared(), z, v)
    }
}

fn go(p: &Prepared, z: f64, v: f64) -> Outcome {
    let mut run = Simulation::new(&p.model, &p.case.solver, &p.sampling).unwrap();
    run.start_from(&[z], &[v]);
    let (rows, reason) = run.run_to_end();
    assert_eq!(reason, StopReason::Completed);
    run.outcome(rows, reason)
}

fn residual(outcome: &Outcome) -> f64 {
    outcome.totals.peak_residual / outcome.totals.peak_input.max(outcome.energies.initial.abs())
}

/// Force of the device below, all its parts.
fn force(outcome: &Outcome) -> Vec<f64> {
    let part = |name: &str| channel(outcome, &format!("joint/base|p1c1b1/{name}"));
    let (elastic, damping, friction) = (part("elastic"), part("damping"), part("friction"));
    elastic.iter().zip(damping).zip(friction).map(|((e, d), f)| e + d + f).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m: f64, v| m.max(v.abs()))
}

/// m v̇ = −c v: v_0 e^{−ct/m}, and what comes to rest has gone v_0 m/c.
#[test]
fn a_dashpot_stops_a_block() {
    let run = Run::on(r#"{ law = "viscous", damping = "2 kN s/m" }"#, 0.05);
    let outcome = run.go(0.0, 0.3);
    let frames = outcome.recording.time.iter().zip(&outcome.recording.frame_velocity);
    let off = farthest(frames.map(|(t, v)| (*v, 0.3 * (-2e3 * t / MASS).exp())));
    let of = |what: &str| format!("Devices: viscous, block of 0.3 m/s, {what}");
    agrees!(of("largest error of its speed"), "v₀ e^(−ct/m)", "m/s", off, 0.0, abs: 1e-6);
    let last = *outcome.recording.frame_displacement.last().unwrap();
    agrees!(of("way"), "v₀ m/c", "m", last, 0.3 * MASS / 2e3, 1e-4);
    agrees!(of("energy taken"), "½ m v₀²", "J", outcome.energies.damping, 0.5 * MASS * 0.09, 1e-5);
    assert!(residual(&outcome) < 1e-5, "{}", residual(&outcome));
}

/// m v̇ = −c v_0 (v/v_0)^α: v^(1 − α) falls linearly, and the block comes to rest at a known instant.
#[test]
fn a_dashpot_with_a_power_stops_a_block_in_finite_time() {
    for (law, alpha, v_0) in [
        (r#"{ law = "viscous", damping = "50 N s/m", exponent = 0.3 }"#, 0.3, 1.0),
        (r#"{ law = "viscous", damping = "200 N s/m", exponent = 0.5, reference_velocity = "0.1 m/s" }"#, 0.5, 0.1f64),
    ] {
        let (v, beyond) = (0.3f64, 1.0 - alpha);
        let c = if alpha == 0.3 { 50.0 } else { 200.0 };
        // d(v^(1−α))/dt = −(1 − α) c v_0^(1−α)/m.
        let falling = beyond * c * v_0.powf(beyond) / MASS;
        let stop = v.powf(beyond) / falling;
        let outcome = Run::on(law, 1.5 * stop).go(0.0, v);
        let exact = |t: f64| (v.powf(beyond) - falling * t).max(0.0).powf(1.0 / beyond);
        let frames = outcome.recording.time.iter().zip(&outcome.recording.frame_velocity);
        let off = farthest(frames.map(|(t, found)| (*found, exact(*t))));
        let of = |what: &str| format!("Devices: viscous with an exponent, block of 0.3 m/s, {what}; α = {alpha}");
        // Below 1e-4 v_0 the law is linear.
        let against = "v^(1−α) falls by (1 − α) c v_0^(1−α)/m";
        agrees!(of("largest error of its speed"), against, "m/s", off, 0.0, abs: 3e-5);
        let energies = &outcome.energies;
        agrees!(of("energy taken"), "½ m v₀²", "J", energies.damping, energies.initial, 1e-5);
        let lost = outcome.envelopes.joint_dissipation[0];
        assert!((lost / outcome.energies.damping - 1.0).abs() < 1e-9, "{lost}");
        assert!(residual(&outcome) < 1e-5);
    }
}

/// A spring with a dashpot: the period and the decay of a damped oscillator.
#[test]
fn an_elastic_device_is_an_oscillator() {
    let (k, c, z) = (4e5f64, 120.0f64, 1e-3);
    let decay = 0.5 * c / MASS;
    let omega = (k / MASS - decay * decay).sqrt();
    let outcome = Run::on(r#"{ law = "elastic", stiffness = "400 kN/m", damping = 120 }"#, 0.2).go(z, 0.0);
    let exact = |t: f64| z * (-decay * t).exp() * ((omega * t).cos() + decay / omega * (omega * t).sin());
    let frames = outcome.recording.time.iter().zip(&outcome.recording.frame_displacement);
    let off = farthest(frames.map(|(t, found)| (found / z, exact(*t) / z)));
    let subject = "Devices: elastic with damping, free decay, largest error over x₀";
    agrees!(subject, "x₀ e^(−ct/2m) (cos ωt + c/(2mω) sin ωt)", "", off, 0.0, abs: 1e-4);
    assert!(residual(&outcome) < 1e-5, "{}", residual(&outcome));
    // The weight on it changes nothing, and mortar and friction are gone.
    assert_eq!(outcome.energies.friction, 0.0);
    let force = outcome.envelopes.joint_force[0];
    agrees!("Devices: elastic with damping, peak force", "k x₀", "N", force, k * z, 1e-9);
}

/// Beside a spring each half cycle loses 2 F_s/k of the amplitude, whatever the weight; the account has the work.
#[test]
fn a_friction_damper_loses_four_slip_forces_over_stiffness_in_a_cycle() {
    let (k, slip, z) = (1e6f64, 300.0, 5.5e-3);
    let half = std::f64::consts::PI * (MASS / k).sqrt();
    for base in [
        r#"{ law = "friction-damper", slip_force = "300 N", slip_velocity = "0.01 mm/s" }"#,
        r#"{ law = "friction-damper", slip_force = "300 N", sticks = true }"#,
    ] {
        // The ends of the samples fall on the turns. Nine half cycles: then the spring cannot overcome the damper.
        let run =
            Run { top: r#"{ law = "elastic", stiffness = "1000 kN/m" }"#, samples: 480, ..Run::on(base, 12.0 * half) };
        let outcome = run.go(z, 0.0);
        let exact = |n: i32| (z - 2.0 * f64::from(n) * slip / k) * if n % 2 == 0 { 1.0 } else { -1.0 };
        let frames = &outcome.recording.frame_displacement;
        let off = farthest((0..=9).map(|n| (frames[40 * n as usize], exact(n))));
        let name = if base.contains("sticks") { "sticking" } else { "regularised" };
        let of = |what: &str| format!("Devices: friction damper beside a spring, {what}; {name}");
        agrees!(of("amplitudes of 9 half cycles, largest error"), "x₀ − 2 n F_s/k", "m", off, 0.0, abs: 2e-6);
        let way: f64 = (0..9).map(|n| 2.0 * (z - (2.0 * f64::from(n) + 1.0) * slip / k)).sum();
        agrees!(of("energy taken"), "F_s times the way", "J", outcome.energies.friction, slip * way, 1e-3);
        assert!(residual(&outcome) < 1e-5, "{}", residual(&outcome));
    }
}

/// Under a constant force beyond the slip load the block accelerates with what is left.
#[test]
fn a_friction_damper_slips_at_its_force() {
    let motion = r#"base = { pulse = { shape = "rectangular", acceleration = "50 m/s2", duration = "1 s" } }"#;
    let run = Run {
        motion: motion.into(),
        ..Run::on(r#"{ law = "friction-damper", slip_force = "0.3 kN", slip_velocity = "0.01 mm/s" }"#, 0.1)
    };
    let outcome = run.go(0.0, 0.0);
    let exact = -0.5 * (50.0 - 300.0 / MASS) * 0.01;
    let found = *outcome.recording.frame_displacement.last().unwrap();
    agrees!("Devices: friction damper that slips, way", "½ (a − F_s/m) t²", "m", found, exact, 1e-5);
    let last = force(&outcome).last().unwrap().abs();
    agrees!("Devices: friction damper that slips, force", "F_s", "N", last, 300.0, 1e-5);
    // Below it, it holds but for creep.
    let held = Run { motion: run.motion.replace("50 m/s2", "25 m/s2"), ..run };
    let held = Run { base: r#"{ law = "friction-damper", slip_force = "0.3 kN", sticks = true }"#, ..held };
    assert_eq!(largest(&held.go(0.0, 0.0).recording.frame_displacement), 0.0);
}

/// (I4) and (I5) of one device.
#[derive(Clone, Copy)]
struct Hysteresis {
    force: f64,
    displacement: f64,
    hardening: f64,
    amplitude: f64,
    beta: f64,
    gamma: f64,
    n: f64,
}

impl Hysteresis {
    fn rate(&self, w: f64, zeta: f64) -> f64 {
        let grown =
            self.beta * w.abs() * zeta.abs().powf(self.n - 1.0) * zeta + self.gamma * w * zeta.abs().powf(self.n);
        (self.amplitude * w - grown) / self.displacement
    }

    fn force(&self, d: f64, zeta: f64) -> f64 {
        self.hardening * self.force / self.displacement * d + (1.0 - self.hardening) * self.force * zeta
    }

    fn law(&self) -> &'static str {
        let Hysteresis { force, displacement, hardening, amplitude, beta, gamma, n } = self;
        let law = format!(
            r#"{{ law = "bouc-wen", yield_force = {force}, yield_displacement = {displacement}, hardening = {hardening},
               amplitude = {amplitude:e}, beta = {beta:e}, gamma = {gamma:e}, sharpness = {n:e} }}"#
        );
        Box::leak(law.replace('\n', " ").into_boxed_str())
    }
}

/// Displacement, velocity and ζ after `steps` steps of `h` of the classical scheme of order 4, from `y` at t = 0; the block
/// under the base acceleration `ground`. Every `keep`-th is returned.
fn independent(
    law: &Hysteresis,
    ground: impl Fn(f64) -> f64,
    mut y: [f64; 3],
    h: f64,
    steps: usize,
    keep: usize,
) -> Vec<[f64; 3]> {
    let f = |t: f64, y: [f64; 3]| [y[1], -law.force(y[0], y[2]) / MASS - ground(t), law.rate(y[1], y[2])];
    let ahead = |y: [f64; 3], k: [f64; 3], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
    let mut kept = vec![y];
    for step in 0..steps {
        let t = step as f64 * h;
        let k1 = f(t, y);
        let k2 = f(t + 0.5 * h, ahead(y, k1, 0.5 * h));
        let k3 = f(t + 0.5 * h, ahead(y, k2, 0.5 * h));
        let k4 = f(t + h, ahead(y, k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        if (step + 1) % keep == 0 {
            kept.push(y);
        }
    }
    kept
}

const PLAIN: Hysteresis =
    Hysteresis { force: 800.0, displacement: 2e-4, hardening: 0.05, amplitude: 1.0, beta: 0.5, gamma: 0.5, n: 2.0 };

/// A block on a hysteretic device, shaken far beyond yielding, moves as an integration of its own says.
#[test]
fn a_shaken_hysteretic_block_moves_as_integrated_independently() {
    for law in [
        PLAIN,
        Hysteresis { n: 1.0, ..PLAIN },
        Hysteresis { beta: 0.7, gamma: -0.4, n: 3.5, ..PLAIN },
        Hysteresis { amplitude: 1.6, beta: 0.9, gamma: 0.9, n: 12.0, hardening: 0.0, ..PLAIN },
    ] {
        let motion = r#"base = { sine = { acceleration = "120 m/s2", frequency = "11 Hz" } }"#.to_string();
        let run = Run { motion, ..Run::on(law.law(), 0.4) };
        let outcome = run.go(0.0, 0.0);
        let ground = |t: f64| 120.0 * (std::f64::consts::TAU * 11.0 * t).sin();
        // The motion of a sine in acceleration starts at rest.
        let exact = independent(&law, ground, [0.0; 3], 1e-5, 40_000, 100);
        let (found, forces) = (&outcome.recording.frame_displacement, force(&outcome));
        let size = exact.iter().fold(0.0f64, |m, y| m.max(y[0].abs()));
        assert!(size > 5.0 * law.displacement, "{size}");
        let of = |what: &str| format!("Devices: Bouc–Wen, block shaken at 11 Hz, {what}; n = {}", law.n);
        let against = "Runge and Kutta's method of order 4, steps of 10 µs";
        let ways = farthest(exact.iter().enumerate().map(|(k, y)| (found[k] / size, y[0] / size)));
        agrees!(of("largest error of x over its peak"), against, "", ways, 0.0, abs: 2e-4);
        let forces = exact.iter().enumerate().map(|(k, y)| (forces[k] / law.force, law.force(y[0], y[2]) / law.force));
        agrees!(of("largest error of the force over F_y"), against, "", farthest(forces), 0.0, abs: 3e-3);
        assert!(outcome.energies.device > 10.0 * law.force * law.displacement);
        assert!(residual(&outcome) < 1e-5, "{}", residual(&outcome));
    }
}

/// A block drawn to and fro by a stiff spring, quasi-statically.
fn drawn(law: &'static str, amplitude: f64, cycles: f64, samples: usize) -> Outcome {
    let motion = format!("top = {{ sine = {{ amplitude = {amplitude}, frequency = 1 }} }}");
    let top = r#"{ law = "elastic", stiffness = "1e6 kN/m", damping = 2e5 }"#;
    Run { top, beam: "driven", motion, samples, tolerance: 1e-4, ..Run::on(law, cycles) }.go(0.0, 0.0)
}

/// Loops under a quasi-static drive: ζ as a function of the displacement, the work of a cycle, and for a large n the bilinear
/// loop.
#[test]
fn hysteretic_loops_are_those_of_the_equation() {
    let (amplitude, samples) = (1e-3, 3000);
    let law = Hysteresis { n: 1.5, gamma: 0.2, beta: 0.8, ..PLAIN };
    let outcome = drawn(law.law(), amplitude, 2.0, samples);
    let d: Vec<f64> = channel(&outcome, "joint/base|p1c1b1/slip").iter().map(|d| -d).collect();
    let forces = force(&outcome);
    // The slip of a base joint is that of the base against the block.
    let sign = if (d[400] * forces[400]).is_sign_positive() { 1.0 } else { -1.0 };
    let (mut zeta, mut work, mut worst) = (0.0, 0.0, 0.0f64);
    for k in 1..d.len() {
        let (from, to) = (sign * d[k - 1], sign * d[k]);
        let before = law.force(from, zeta);
        let parts = 50;
        let h = (to - from) / f64::from(parts);
        for _ in 0..parts {
            let slope = |zeta: f64| law.rate(1.0, zeta) * 1.0;
            let f = |zeta: f64| if h >= 0.0 { slope(zeta) } else { -law.rate(-1.0, zeta) };
            let k1 = f(zeta);
            let k2 = f(zeta + 0.5 * h * k1);
            let k3 = f(zeta + 0.5 * h * k2);
            zeta += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + f(zeta + h * k3));
        }
        if k > samples / 2 {
            work += 0.5 * (before + law.force(to, zeta)) * (to - from);
        }
        worst = worst.max((forces[k] - law.force(to, zeta)).abs());
    }
    let of = |what: &str| format!("Devices: Bouc–Wen with n = 1.5, drawn slowly, {what}");
    let against = "ζ as a function of the displacement (I5)";
    agrees!(of("largest error of the force over F_y"), against, "", worst / law.force, 0.0, abs: 2e-3);
    let device = channel(&outcome, "energy/device");
    let cycle = device[samples] - device[samples / 2];
    agrees!(of("energy of a cycle"), against, "J", cycle, work, 2e-3);
    assert!(residual(&outcome) < 1e-4);

    let sharp = Hysteresis { n: 100.0, ..PLAIN };
    let outcome = drawn(sharp.law(), amplitude, 2.0, samples);
    let device = channel(&outcome, "energy/device");
    let cycle = device[samples] - device[samples / 2];
    let bilinear = 4.0 * (1.0 - sharp.hardening) * sharp.force * (amplitude - sharp.displacement);
    let of = |what: &str| format!("Devices: Bouc–Wen with n = 100, drawn slowly, {what}");
    let against = "bilinear, 4 (1 − r) F_y (x − d_y)";
    agrees!(of("energy of a cycle"), against, "J", cycle, bilinear, 0.01);
    let peak = outcome.envelopes.joint_force[0];
    let exact = sharp.force * (1.0 + sharp.hardening * (amplitude / sharp.displacement - 1.0));
    agrees!(of("peak force"), "bilinear, F_y (1 + r (x/d_y − 1))", "N", peak, exact, 0.01);
}

const FLAG: &str = r#"{ law = "re-centring", stiffness = "5e6 N/m", post_stiffness = "2e5 N/m", activation_force = "1 kN", flag = 0.7 }"#;

/// The flag: its corners, its area, and nothing left of it when the motion ends.
#[test]
fn a_re_centring_device_draws_a_flag_and_comes_back() {
    let (first, second, activation, flag) = (5e6, 2e5, 1e3, 0.7);
    let (amplitude, samples) = (2e-3, 4000);
    let outcome = drawn(FLAG, amplitude, 1.0, samples);
    let (d, forces) = (outcome.recording.frame_displacement.clone(), force(&outcome));
    let yields = activation / first;
    for k in 0..=samples {
        let (x, f) = (d[k].abs(), forces[k] * d[k].signum());
        let loads = k % (samples / 2) <= samples / 4;
        let upper = if x < yields { first * x } else { activation + second * (x - yields) };
        let turn = largest(&d);
        let line = activation + second * (turn - yields) - first * (turn - x);
        let low = (1.0 - flag) * yields;
        let lower = if x < low { first * x } else { first * low + second * (x - low) };
        let exact = if loads { upper } else { line.max(lower) };
        // Where samples lie between a turn and the point before it, the branch is not known.
        let near = (k % (samples / 2)).abs_diff(samples / 4) < 40;
        let slack = if near { 0.02 } else { 2e-3 };
        assert!((f - exact).abs() < slack * activation, "{f} instead of {exact} at {x}, sample {k}");
    }
    let turn = largest(&d);
    let area = 2.0 * flag * activation * (1.0 - second / first) * (turn - yields);
    let subject = "Devices: re-centring, energy of a cycle";
    agrees!(subject, "area of the flag, 2 β F_a (1 − k₂/k₁) (x − d_a)", "J", outcome.energies.device, area, 1e-3);
    assert!(d[samples].abs() < 1e-6 && forces[samples].abs() < 5.0, "{} m, {} N left", d[samples], forces[samples]);
    assert!(residual(&outcome) < 1e-4, "{}", residual(&outcome));

    // Struck, with a little damping, it swings out and rests where it was; an elasto-plastic one does not.
    let damped = FLAG.replace("flag = 0.7", "flag = 0.7, damping = 800");
    let run = Run { tolerance: 1e-4, ..Run::on(Box::leak(damped.into_boxed_str()), 1.0) };
    let outcome = run.go(0.0, 1.5);
    let end = outcome.recording.frame_displacement.last().unwrap().abs();
    assert!(outcome.totals.peak_relative_displacement > 10.0 * yields && end < 1e-3 * yields, "{end}");
    assert!(outcome.energies.device > 0.1 * outcome.energies.initial && residual(&outcome) < 1e-4);
    let yielding = Hysteresis { hardening: 0.0, n: 20.0, ..PLAIN };
    let run = Run { tolerance: 1e-4, ..Run::on(yielding.law(), 1.0) };
    assert!(run.go(0.0, 1.5).recording.frame_displacement.last().unwrap().abs() > 10.0 * yielding.displacement);
}

/// β_f = 0 is a bilinear elastic spring: nothing is dissipated, the energy comes back.
#[test]
fn a_flag_without_height_dissipates_nothing() {
    let law = FLAG.replace("flag = 0.7", "flag = 0");
    let outcome = Run { tolerance: 1e-5, ..Run::on(Box::leak(law.into_boxed_str()), 0.2) }.go(0.0, 0.5);
    assert_eq!((outcome.energies.device, outcome.energies.damping), (0.0, 0.0));
    // 5e-5 of the tolerance, in every of some thousand steps.
    assert!(residual(&outcome) < 1e-5, "{}", residual(&outcome));
    // ½ m v² = ½ F_a d_a + F_a (x − d_a) + ½ k_2 (x − d_a)².
    let (yields, energy) = (1e3 / 5e6, 0.5 * MASS * 0.25);
    let beyond = energy - 0.5 * 1e3 * yields;
    let exact = yields + (-1e3 + (1e6f64 + 2.0 * 2e5 * beyond).sqrt()) / 2e5;
    let found = outcome.totals.peak_relative_displacement;
    let against = "½ m v² = ½ F_a d_a + F_a (x − d_a) + ½ k₂ (x − d_a)²";
    agrees!("Devices: re-centring without height of its flag, struck, peak", against, "m", found, exact, 1e-4);
}

/// Loaded in one direction the laws are smooth: errors fall with the order of the scheme.
#[test]
fn hysteresis_keeps_the_order_of_the_schemes() {
    let (duration, v) = (2e-3, 0.4);
    let exact = independent(&PLAIN, |_| 0.0, [0.0, v, 0.0], duration / 200_000.0, 200_000, 200_000)[1];
    for (scheme, least) in [(Scheme::TrBdf2, 3.6), (Scheme::Esdirk4, 12.0)] {
        let error = |steps: u32| {
            let mut p = Run::on(PLAIN.law(), duration).prepared();
            p.case.solver.scheme = scheme;
            p.case.solver.tolerance = 0.1;
            p.case.solver.max_step = Some((duration / f64::from(steps)).into());
            (p.sampling.interval, p.sampling.frame_every) = (duration, 1);
            let outcome = go(&p, 0.0, v);
            let taken = outcome.counters.steps as f64 / f64::from(steps);
            assert!((1.0..1.4).contains(&taken), "{} steps, {steps} expected", outcome.counters.steps);
            (outcome.recording.frame_displacement[1] - exact[0]).abs() / exact[0]
        };
        let errors = [error(80), error(160), error(320)];
        println!("{scheme:?}: {errors:?}");
        for pair in errors.windows(2) {
            assert!(pair[0] / pair[1] > least || pair[1] < 1e-12, "{scheme:?}: {errors:?}");
        }
    }
}

const PANEL: &str = r#"
model = "shear"
set = "report"
[[panel]]
bond = "running"
courses = 6
bricks = 4
[joint]
friction = { law = "stribeck", static = 0.4, dynamic = 0.28 }
CHANGES
[load]
top = "10 kN/m"
beam = { mass = "1 t" }
[motion]
duration = "0.5 s"
base = { pulse = { shape = "ricker", acceleration = "1.5 g", duration = "0.2 s" } }
"#;

/// A panel whose bed joints of the third course, and some others, are devices.
fn panel(third: &str) -> Prepared {
    let changes = format!(
        r#"[[joint.change]]
        at = {{ kind = ["bed"], course = [3] }}
        device = {third}
        [[joint.change]]
        at = {{ joints = ["p1c5b2|p1c5b3", "base|p1c1b1"] }}
        device = {{ law = "viscous", damping = "20 kN s/m" }}"#
    );
    let mut p = ready(&PANEL.replace("CHANGES", &changes));
    p.case.output.joints = vec!["all".into()];
    p.sampling.joints = vec!["all".into()];
    p
}

const SOFT: &str = r#"{ law = "bouc-wen", yield_force = "100 N", yield_displacement = "0.02 mm", hardening = 0.02 }"#;
const CENTRED: &str = r#"{ law = "re-centring", stiffness = "5e6 N/m", post_stiffness = "2e5 N/m", activation_force = "100 N", flag = 0.9 }"#;
const POWER: &str = r#"{ law = "viscous", damping = "2 kN s/m", exponent = 0.4 }"#;

/// Walls with devices: the account closes, restarts and threads change no bit.
#[test]
fn walls_with_devices_keep_their_energy_and_their_bits() {
    let sharp = SOFT.replace("hardening = 0.02", "hardening = 0, sharpness = 50");
    for law in [
        r#"{ law = "viscous", damping = "20 kN s/m" }"#,
        r#"{ law = "elastic", stiffness = "2e6 N/m", damping = "1 kN s/m" }"#,
        r#"{ law = "friction-damper", slip_force = "120 N" }"#,
        r#"{ law = "friction-damper", slip_force = "120 N", sticks = true }"#,
        SOFT,
        &sharp,
        CENTRED,
        POWER,
    ] {
        let p = panel(law);
        let new = || Simulation::new(&p.model, &p.case.solver, &p.sampling).unwrap();
        let mut run = new();
        let (rows, reason) = run.run_to_end();
        assert_eq!(reason, StopReason::Completed, "{law}");
        let whole = run.outcome(rows, reason);
        println!("{law}\n  {:?}\n  {:?} residual {:e}", whole.counters, whole.energies, residual(&whole));
        assert!(residual(&whole) < 1e-4, "energy residual {} with {law}", residual(&whole));
        let hysteretic = law.contains("bouc-wen") || law.contains("re-centring");
        assert_eq!(whole.energies.device > 0.0, hysteretic, "{law}");
        let by_joint: f64 = whole.envelopes.joint_dissipation.iter().sum();
        let e = &whole.energies;
        assert!((by_joint / (e.damping + e.friction + e.device) - 1.0).abs() < 1e-9, "{law}");
        // The same from checkpoints.
        let mut run = new();
        let (mut rows, mut stride) = (Recording::default(), 1);
        let reason = loop {
            let progress = run.advance(stride);
            rows.append(run.recording());
            run.clear_recording();
            if let Progress::Ended(reason) = progress {
                break reason;
            }
            let bytes = run.save();
            run = new();
            assert!(run.restore(&bytes));
            stride = stride * 3 % 1009;
        };
        assert!(run.outcome(rows, reason) == whole, "other bits after restarts, {law}");
        // And in batches, on one thread and on two.
        for threads in [1, 2] {
            let jobs: Vec<Job> = (0..5).map(|_| Job::from(&p)).collect();
            for outcome in simulate_many(&jobs, threads) {
                assert!(outcome.unwrap() == whole, "other bits in a batch, {law}");
            }
        }
    }
}

/// A device takes the place of spring, friction and bond of its joint, and results name it; numbers are those of the joint.
#[test]
fn a_device_replaces_the_mortar() {
    let text = PANEL.replace(
        "CHANGES",
        r#"bond = { cohesion = "0.1 MPa" }
        head = { law = "rigid" }
        [[joint.change]]
        at = { joints = ["p1c1b1|p1c2b1", "p1c5b2|p1c5b3"] }
        device = { law = "friction-damper", slip_force = "2 kN" }
        [[joint.change]]
        at = { joints = ["p1c1b1|p1c2b1"] }
        device = { law = "elastic", stiffness = "3 kN/m" }
        [[joint.change]]
        at = { kind = ["bed"] }
        spring = { stiffness = "1e7 N/m" }"#,
    );
    let p = ready(&text);
    let rows = joint_rows(&p.model);
    let of = |name: &str| rows.iter().position(|r| r.name == name).unwrap();
    let (bed, head) = (of("p1c1b1|p1c2b1"), of("p1c5b2|p1c5b3"));
    // The later device stays, whatever a later change says of the mortar.
    assert_eq!((rows[bed].device, rows[bed].stiffness, rows[bed].damping), (Some(DeviceLaw::Elastic), 3e3, 0.0));
    assert!(rows[bed].friction.is_none());
    assert_eq!(rows[head].device, Some(DeviceLaw::FrictionDamper));
    assert_eq!((rows[head].normal_force, rows[head].stiffness, rows[head].damping), ([2e3; 2], 0.0, 0.0));
    assert_eq!(rows.iter().filter(|r| r.device.is_some()).count(), 2);
    let bonded: Vec<usize> = p.model.shear.bonds.iter().map(|b| b.joint as usize).collect();
    assert!(!bonded.contains(&bed) && !bonded.contains(&head));
    assert!(p.model.shear.contacts.iter().all(|c| c.joint as usize != head));
    // The weight on the other joints is the same.
    let plain = ready(&PANEL.replace("CHANGES", ""));
    for rub in &p.model.shear.rubs {
        let same = plain.model.shear.rubs.iter().find(|r| r.joint == rub.joint);
        assert!(rub.joint as usize == head || same.unwrap().normal == rub.normal);
    }
}

/// Devices of no effect: an elastic one with the numbers of the mortar gives the bits of the mortar.
#[test]
fn an_elastic_device_like_the_mortar_gives_its_bits() {
    let plain = ready(&PANEL.replace("CHANGES", "").replace("law = \"stribeck\"", "law = \"none\""));
    let e = plain.model.joint_names().iter().position(|n| n == "p1c1b1|p1c2b2").unwrap();
    let law = plain.model.shear.elastic[e];
    let change = format!(
        r#"[[joint.change]]
        at = {{ joints = ["p1c1b1|p1c2b2"] }}
        device = {{ law = "elastic", stiffness = {:e}, damping = {:e} }}"#,
        law.stiffness, law.damping
    );
    let text = PANEL.replace("CHANGES", &change).replace("law = \"stribeck\"", "law = \"none\"");
    assert!(run_in_memory(&ready(&text)).unwrap() == run_in_memory(&plain).unwrap());
}

/// A name that no joint bears is told, and where it is that of a joint turned round, its own.
#[test]
fn a_device_needs_a_joint() {
    for (name, allowed) in [
        ("p9c1b1|p1c2b2", "names as `concio check` lists"),
        ("p1c2b2|p1c1b1", "the same blocks the other way round: `p1c1b1|p1c2b2`"),
    ] {
        let change = format!(
            "[[joint.change]]\nat = {{ joints = [\"{name}\"] }}\ndevice = {{ law = \"viscous\", damping = 100 }}"
        );
        let file = from_str(&PANEL.replace("CHANGES", &change), Syntax::Toml, None).unwrap();
        match prepare_case(file.case.clone(), Path::new("")) {
            Err(Error::Input(e)) => {
                assert_eq!(e.key.as_deref(), Some("joint.change[0].at"));
                assert!(e.what.contains(&format!("no joint is named `{name}`")), "{e}");
                assert!(e.allowed.as_ref().is_some_and(|a| a.starts_with(allowed)), "{e}");
            }
            other => panic!("{other:?}"),
        }
    }
}

/// What joints remember of how far they went, s of (I7) and δ_m of (B3), is known at turns inside steps too: with ESDIRK4 a flag and a bond that softens go as with
/// steps of a fiftieth.
#[test]
fn memory_knows_turns_inside_steps() {
    let flag = r#"
        bed = { law = "elastic", stiffness = "2000 N/m" }
        head = { law = "none" }
        friction = { law = "none" }
        [[joint.change]]
        at = { kind = ["base"] }
        device = { law = "re-centring", stiffness = "6000 N/m", activation_force = "4 N", flag = 0.9, post_stiffness = "1500 N/m" }
        "#;
    let bond = r#"
        bed = { law = "elastic", stiffness = "2500 N/m" }
        head = { law = "none" }
        friction = { law = "none" }
        bond = { cohesion = "666.67 Pa", friction_angle = "0 deg", tensile_strength = "0 Pa", mode_2_energy = "9.3253 N/m", on = ["base"] }
        "#;
    for (what, joint, frequency) in [("re-centring flag", flag, 2.7), ("bond that softens", bond, 5.0)] {
        let moves = |solver: &str| {
            let text = format!(
                r#"
                model = "shear"
                [[panel]]
                bond = "stack"
                courses = 1
                bricks = 1
                brick = {{ length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }}
                [joint]
                damping_ratio = 0
                {joint}
                [load]
                beam = "free"
                [motion]
                duration = "1.5 s"
                base = {{ sine = {{ acceleration = "2.7 m/s2", frequency = {frequency}, ramp = "1 s" }} }}
                [solver]
                scheme = "esdirk4"
                {solver}
                [output]
                interval = "5 ms"
                blocks = ["all"]
                "#
            );
            let outcome = run_in_memory(&ready(&text)).unwrap();
            outcome.history("block/p1c1b1/displacement").unwrap()
        };
        let (found, fine) = (moves("tolerance = 1e-6"), moves("tolerance = 1e-8\nmax_step = \"0.1 ms\""));
        let most = fine.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let off = farthest(found.iter().zip(&fine).map(|(a, b)| (a / most, b / most)));
        let subject = format!("Devices: memory of a {what}, one block, motion over its largest with tolerance 1e-6");
        agrees!(subject, "steps of 0.1 ms", "", off, 0.0, abs: 2e-5);
    }
}
