//! Planar walls from their files against closed forms.

use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::run::{Prepared, prepare_case, run_in_memory};
use concio::wall::End;
use concio_verified::{agrees, farthest};

use crate::common::planar::{block, stack};
use crate::common::ready::{channel, close, ran, ready};

/// Steps of the period of a spring mass with k_s = 1 MN/m and the dashpot of ζ = 0: x = u_0 cos ω t after a pulse of the base.
#[test]
fn a_block_on_springs_swings_as_its_stiffness_says() {
    // High springs across the joint hold the block upright: its base is as wide as it is high.
    let text = block(
        r#"
[joint]
damping_ratio = 0
bed = { law = "elastic", stiffness = "2.5e5 N/m", normal_to_shear = 1e6 }
head = { law = "none" }
[motion]
duration = "1 s"
base = { pulse = { shape = "rectangular", acceleration = 1, duration = "0.05 s" } }
[solver]
step = STEP
"#,
    );
    let mass = 5e3 / concio::G;
    // Two half bricks lie on the base.
    let omega = (2.0 * 2.5e5 / mass).sqrt();
    let exact = |t: f64| {
        let swing = |t: f64| (1.0 - (omega * t).cos()) / (omega * omega);
        -swing(t) + if t > 0.05 { swing(t - 0.05) } else { 0.0 }
    };
    let error = |step: &str| {
        let (_, outcome) = ran(&text.replace("STEP", step));
        let x = channel(&outcome, "top/displacement");
        let error = farthest(x.iter().zip(&outcome.recording.time).map(|(x, t)| (*x, exact(*t))));
        let size = x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let residual = outcome.totals.peak_residual / outcome.totals.peak_input;
        assert!(residual < 1e-6, "{residual:e}");
        error / size
    };
    let [coarse, fine] = ["2e-3", "1e-3"].map(error);
    let subject = "Springs: block after a pulse, steps of 1 ms, largest error over its peak";
    agrees!(subject, "A/ω² (1 − cos ωt), twice", "", fine, 0.0, abs: 3e-3);
    agrees!("Springs: block after a pulse, how the error falls where the step is halved", "4, second order", "", coarse / fine, 4.0, abs: 0.5);
}

/// A layer of springs k_n ℓ resists turning with k_n ℓ³/12: a horizontal force at the top, here that of a tilt, turns the block by
/// its moment over that.
#[test]
fn a_layer_of_springs_turns_as_a_layer() {
    let (_, outcome) = ran(&block(
        r#"
[joint]
bed = { law = "elastic", stiffness = "36e6 N/m3", normal_to_shear = 2 }
head = { law = "none" }
[motion]
duration = "1 s"
quasi_static = true
base = { tilt = { acceleration = "-0.1 g", rise = "1 s" } }
"#,
    ));
    let (force, area) = (0.1 * 5e3, 0.5);
    let shear = force / (36e6 * area);
    // The weight turns it further as it leans.
    let rotation = force * 0.25 / (72e6 * area * 0.25 / 12.0 - 5e3 * 0.25);
    let last = outcome.recording.frame_time.len() - 1;
    let (turn, way) = (-outcome.recording.frame_rotation[last], outcome.recording.frame_displacement[last]);
    let against = "f h/2/(k_n ℓ³/12 − W h/2)";
    agrees!("Springs: block tilted on an elastic bed joint, turn", against, "rad", turn, rotation, 1e-3);
    let against = "f/k_s ℓ and the turn's part";
    agrees!("Springs: block tilted on an elastic bed joint, way", against, "m", way, shear + 0.25 * rotation, 1e-3);
    let found = channel(&outcome, "base/shear").last().copied().unwrap_or(0.0).abs();
    agrees!("Springs: block tilted on an elastic bed joint, base shear", "0.1 W", "N", found, force, 1e-3);
}

/// Without inertia samples are taken at the ends of steps: what grows steadily is a line, not a stair.
#[test]
fn samples_without_inertia_are_those_of_steps() {
    let text = block(
        r#"
[joint]
bed = { law = "elastic", stiffness = "36e6 N/m3" }
head = { law = "none" }
[motion]
duration = "DURATION s"
quasi_static = true
base = { tilt = { acceleration = "0.1 g", rise = "DURATION s" } }
"#,
    );
    for (duration, interval) in [("1", 0.02), ("100", 0.06)] {
        let (prepared, outcome) = ran(&text.replace("DURATION", duration));
        assert!((prepared.sampling.interval - interval).abs() < 1e-12, "{}", prepared.sampling.interval);
        let x = channel(&outcome, "top/displacement");
        let last = x[x.len() - 1].abs() / (x.len() - 1) as f64;
        let uneven = |w: &[f64]| ((w[1] - w[0]).abs() / last - 1.0).abs();
        // The weight, which leans, makes it grow by a little more.
        assert!(x.windows(2).map(uneven).fold(0.0, f64::max) < 0.02, "{duration}");
    }
}

#[test]
fn a_resumed_run_has_the_bits_of_one_that_was_not_stopped() {
    use concio::record::Recording;
    use concio::simulate::Simulation;
    let prepared = ready(
        r#"
model = "planar"
[[panel]]
bond = "running"
courses = 4
bricks = 3
brick = { length = 0.25, height = 0.1, thickness = 0.12, specific_weight = 18e3 }
[joint]
bed = { law = "no-tension", stiffness = "36e9 N/m3", rigidity = 1 }
head = { law = "no-tension", stiffness = "36e9 N/m3", rigidity = 1 }
friction = { law = "stribeck", static = 0.6, dynamic = 0.5, on = "all" }
[motion]
duration = "0.4 s"
base = { sine = { acceleration = "0.9 g", frequency = "5 Hz" } }
vertical = { sine = { acceleration = "0.2 g", frequency = "7 Hz" } }
"#,
    );
    let whole = run_in_memory(&prepared).expect("a run");
    let new = || Simulation::new(&prepared.model, &prepared.case.solver, &prepared.sampling).expect("a run");
    let mut first = new();
    let mut rows = Recording::default();
    for _ in 0..7 {
        first.advance(20);
        rows.append(first.recording());
        first.clear_recording();
    }
    let saved = first.save();
    let mut second = new();
    assert!(second.restore(&saved));
    let (rest, reason) = second.run_to_end();
    rows.append(&rest);
    let resumed = second.outcome(rows, reason);
    assert_eq!(resumed, whole);
    let residual = whole.totals.peak_residual / whole.totals.peak_input;
    assert!(residual < 1e-3, "{residual:e}");
}

/// Times of steps add up with rounding: what is left at the end is no step of its own, in which accelerations would be what rounding makes of velocities.
#[test]
fn a_run_ends_with_a_whole_step() {
    for (duration, step, steps) in [(1.5, 1e-4, 15_000), (3.0, 1e-3, 3_000), (0.7, 7e-5, 10_000), (0.1005, 1e-3, 101)] {
        let (_, outcome) = ran(&block(&format!(
            r#"
[joint]
bed = {{ law = "no-tension", stiffness = "10 N/mm3", rigidity = 1 }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 0.6, dynamic = 0.6 }}
[motion]
duration = {duration}
base = {{ sine = {{ acceleration = "0.05 g", frequency = "3 Hz" }} }}
[solver]
step = {step}
"#
        )));
        assert_eq!(outcome.counters.steps, steps);
        let most = outcome.envelopes.joint_acceleration.iter().fold(0.0, |most: f64, a| most.max(*a));
        assert!(most < 0.5, "{most} m/s² between blocks that stick");
    }
}

/// What the base bears under every joint on it [N].
fn pressures(text: &str) -> (Prepared, Vec<f64>) {
    let (prepared, outcome) = ran(text);
    let joints = prepared.model.joints.len();
    let last = outcome.recording.frame_pressure.len() - joints;
    let pressures = outcome.recording.frame_pressure[last..].to_vec();
    (prepared, pressures)
}

const ARCH: &str = r#"
model = "planar"
[[panel]]
bond = "arch"
arch = { span = "2 m", rise = "1 m", thickness = "0.3 m", voussoirs = 15, springing = "SPRINGING" }
brick = { length = 0.3, height = 0.2, thickness = 0.5, specific_weight = 20e3 }
[joint]
bed = { law = "rigid" }
head = { law = "rigid" }
friction = { law = "coulomb", static = 0.7, dynamic = 0.7, on = "all" }
[load]
top = "LOAD"
[motion]
duration = "0.5 s"
"#;

/// A symmetric arch bears the same on either side, on the base or on abutments at a height, and no more than its weight and what
/// lies on its width of 2.6 m.
#[test]
fn an_arch_stands_and_bears_the_same_on_either_side() {
    for (springing, load) in [("0 m", 0.0), ("1.5 m", 0.0), ("1.5 m", 1e4)] {
        let text = ARCH.replace("SPRINGING", springing).replace("LOAD", &format!("{load:?} N/m"));
        let (prepared, pressures) = pressures(&text);
        let names = prepared.model.joint_names();
        let of = |name: &str| pressures[names.iter().position(|n| n == name).expect("a joint")];
        let weight: f64 = prepared.model.wall.blocks.iter().map(|b| b.weight()).sum();
        let [left, right] = ["base|p1c1b1", "base|p1c1b15"].map(of);
        let told = |what: &str| format!("Walls and loads: arch, {what}; springing {springing}, load {load} N/m");
        agrees!(told("both springings"), "weight and load", "N", left + right, weight + 2.6 * load, 1e-6);
        agrees!(told("left springing"), "right springing", "N", left, right, 1e-6);
        close(prepared.model.base_load(), left + right, 1e-6);
        let joints = prepared.model.joints.iter().zip(&names).filter(|(j, _)| j.b != concio::wall::End::Base);
        assert!(
            joints.clone().count() == 14 && joints.clone().all(|(_, name)| of(name) > 1e3),
            "{names:?} {pressures:?}"
        );
    }
}

/// What presses on the base at rest is the load of the base, with a beam and without; that of the shear model is the same.
#[test]
fn the_base_bears_its_load() {
    for beam in [r#""free""#, r#""tied""#, r#"{ mass = "1 t" }"#] {
        let text = stack(
            3,
            &format!(
                r#"mortar = {{ bed = 0.01, head = 0.01 }}
[joint]
damping_ratio = 0.5
bed = {{ law = "no-tension", stiffness = "10 N/mm3", rigidity = 1 }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 0.6, dynamic = 0.6 }}
[load]
top = "20 kN/m"
beam = {beam}
[motion]
duration = "0.1 s"
"#
            ),
        );
        let (planar, pressures) = pressures(&text);
        let base = planar.model.joints.iter().position(|joint| joint.b == End::Base).expect("a joint with the base");
        let subject =
            format!("Walls and loads: three blocks under 20 kN/m, what the base bears; beam {}", beam.replace('"', ""));
        agrees!(subject, "weight and load", "N", pressures[base], 3.0 * 2e3 + 20e3 * 0.5, 1e-6);
        close(planar.model.base_load(), pressures[base], 1e-6);
        let shear = text.replace("planar", "shear").replace("no-tension", "elastic").replace(", rigidity = 1", "");
        let shear = shear.replace("10 N/mm3", "1e7 N/m");
        close(ready(&shear).model.base_load(), planar.model.base_load(), 1e-12);
    }
}

/// Head joints without anything in them, beside rigid ones: the wall slides as one with full head joints.
#[test]
fn empty_head_joints_bear_nothing() {
    let text = r#"
model = "planar"
[[panel]]
bond = "running"
courses = 6
bricks = 4
brick = { length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18e3 }
[joint]
bed = { law = "rigid" }
head = { law = "none" }
friction = { law = "coulomb", static = 0.6, dynamic = 0.6 }
[motion]
duration = "1 s"
base = { sine = { acceleration = "0.8 g", frequency = "3 Hz" } }
"#;
    let (_, outcome) = ran(text);
    let found = outcome.totals.peak_relative_displacement;
    let subject = "Sliding: dry wall of 6 courses, μ = 0.6, under 0.8 g at 3 Hz, peak slip";
    agrees!(subject, "Newmark's sliding block", "m", found, 6.556e-3, 1e-3);
    assert!(outcome.totals.contact_residual < 1e-7, "{:e}", outcome.totals.contact_residual);
}

/// Stones of a course only just touch: what rounding presses them by tells nothing of how the wall swings.
#[test]
fn stones_that_only_just_touch_do_not_hold_each_other() {
    let frequency = |head: &str| {
        let text = format!(
            r#"
model = "planar"
[[panel]]
bond = "running"
courses = 8
bricks = 4
brick = {{ length = 0.4, height = 0.2, thickness = 0.3, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
bed = {{ law = "no-tension", stiffness = "10 N/mm3", rigidity = 1 }}
head = {{ {head} }}
friction = {{ law = "coulomb", static = 0.6, dynamic = 0.6, on = "all" }}
[motion]
duration = "1 s"
base = "none"
"#
        );
        let model = ready(&text).model;
        model.planar().expect("a planar wall").slowest().expect("it swings").frequency
    };
    let without = frequency(r#"law = "none""#);
    for stiffness in [15, 24, 30] {
        let head = format!(r#"law = "no-tension", stiffness = "{stiffness} N/mm3", rigidity = 1"#);
        close(frequency(&head), without, 1e-9);
    }
}

/// A wall stands under its weight before it moves, however short its steps are.
#[test]
fn a_wall_has_settled_when_it_begins() {
    let stored = |step: &str| {
        let (_, outcome) = ran(&stack(
            2,
            &format!(
                r#"
[joint]
bed = {{ law = "elastic", stiffness = "0.15 N/mm3" }}
head = {{ law = "none" }}
[solver]
step = {step}
[motion]
duration = "2 ms"
"#
            ),
        ));
        outcome.energies.initial
    };
    // k = 2.4 · 0.15e9 · 0.5 N/m under 4 kN and 2 kN.
    let exact = 0.5 * (4e3f64.powi(2) + 2e3f64.powi(2)) / (2.4 * 0.15e9 * 0.5);
    for step in ["1e-3", "1e-5"] {
        let subject = format!("Springs: two blocks on soft joints at rest, energy; steps of {step} s");
        agrees!(subject, "Σ N²/(2 k)", "J", stored(step), exact, 1e-6);
    }
}

/// An elastic joint pulls as far as its sides go, and gives back what it stored.
#[test]
fn an_elastic_joint_pulls_at_any_distance() {
    let (_, outcome) = ran(r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = 0.5, height = 0.5, thickness = 1, specific_weight = 20e3 }
[[panel]]
bond = "stack"
courses = 1
bricks = 1
connection = 0
brick = { length = 0.5, height = 0.5, thickness = 1, specific_weight = 20e3 }
[joint]
damping_ratio = 0
bed = { law = "rigid" }
head = { law = "none" }
connection = { law = "elastic", stiffness = "2e4 N/m" }
friction = { law = "coulomb", static = 0, dynamic = 0 }
[[joint.change]]
at = { kind = ["base"], panel = ["p1"] }
friction = { static = 2, dynamic = 2 }
[motion]
duration = "2 s"
base = { pulse = { shape = "rectangular", acceleration = "-0.5 g", duration = "0.2 s" } }
[output]
joints = ["all"]
"#);
    // An oscillator of 1 block after a rectangular push.
    let (mass, stiffness) = (5e3 / concio::G, 2e4f64);
    let omega = (stiffness / mass).sqrt();
    let peak = 2.0 * 0.5 * concio::G / (omega * omega) * (0.5 * omega * 0.2).sin();
    let opened = outcome.envelopes.joint_opening.iter().fold(0.0, |m: f64, o| m.max(*o));
    assert!(peak > 0.05, "{peak}");
    let against = "2 a/ω² sin(ωT/2)";
    agrees!("Springs: elastic joint pulled open by a pulse, peak opening", against, "m", opened, peak, 1e-3);
    let residual = outcome.totals.peak_residual / outcome.totals.peak_input;
    assert!(residual < 1e-6, "{residual:e}");
}

/// Results call bed joints what the wall file does.
#[test]
fn bed_joints_that_bear_no_tension_are_told_so() {
    let wall = ready(include_str!("../../../../examples/15-dry-shear-wall.toml"));
    let rows = concio::run::joint_rows(&wall.model);
    assert!(rows.iter().all(|row| row.law == concio::case::SpringLaw::NoTension));
}

/// Bricks of adjacent courses that face each other over less than a head joint's mortar have no joint, and do not touch: every block is in
/// balance by its joints alone. At overlaps that are one brick carries the other.
#[test]
fn blocks_without_a_joint_do_not_bear_on_each_other() {
    for shift in [-15, -12, -8, -5, -1, 2, 5, 9, 12, 20] {
        let (p, outcome) = ran(&format!(
            r#"
model = "planar"
[[panel]]
bond = "irregular"
brick = {{ length = "250 mm", height = "120 mm", thickness = "250 mm", specific_weight = "18 kN/m3" }}
mortar = {{ bed = "10 mm", head = "10 mm" }}
[[panel.course]]
height = "120 mm"
bricks = ["250 mm", "250 mm"]
[[panel.course]]
height = "120 mm"
bricks = ["{} mm", "{} mm"]
[[panel.course]]
height = "120 mm"
bricks = ["250 mm", "250 mm"]
[joint]
damping_ratio = 0.2
bed = {{ law = "elastic", stiffness = "15 N/mm3" }}
head = {{ law = "elastic", stiffness = "36 N/mm3" }}
friction = {{ law = "coulomb", static = 0.6, dynamic = 0.6, on = "all" }}
bond = {{ tensile_strength = "1 MPa", cohesion = "1.5 MPa", friction_angle = "31 deg" }}
[load]
top = "100 kN/m"
[motion]
duration = "20 ms"
base = "none"
"#,
            250 + shift,
            250 - shift
        ));
        let (recording, joints) = (&outcome.recording, &p.model.joints);
        let at = recording.frame_pressure.len() - joints.len();
        let mut lift = vec![0.0; p.model.wall.blocks.len()];
        for (e, joint) in joints.iter().enumerate() {
            let (pressure, shear) = (recording.frame_pressure[at + e], recording.frame_friction[at + e]);
            match (joint.kind.is_upright(), joint.b) {
                (_, End::Base) => lift[joint.a] += pressure,
                (_, End::Top) => {}
                (false, End::Block(b)) => {
                    lift[joint.a] -= pressure;
                    lift[b] += pressure;
                }
                (true, End::Block(b)) => {
                    lift[joint.a] += shear;
                    lift[b] -= shear;
                }
            }
        }
        for (block, lift) in p.model.wall.blocks.iter().zip(&lift) {
            let load = if block.course == 2 { 100e3 * block.length() } else { 0.0 };
            let off = lift - load - block.weight();
            assert!(off.abs() < 60.0, "{} is off by {off} N at {shift} mm", block.name);
        }
    }
}

/// Stones hang in the air where they lie higher above what is under them than mortar reaches, rectangles and polygons alike.
#[test]
fn stones_in_the_air_are_refused() {
    let told = |base: f64, above: f64, bevel: bool| {
        let stone = |course: usize, y: f64| match bevel {
            false => format!("{{ course = {course}, x = 0, y = {y}, length = 0.5, height = 0.3 }}"),
            true => {
                let (middle, top) = (y + 0.2, y + 0.3);
                format!(
                    "{{ course = {course}, corners = [[0, {y}], [0.5, {y}], [0.5, {middle}], [0.4, {top}], [0, {top}]] }}"
                )
            }
        };
        let panel = block("").replace("\"stack\"", "\"explicit\"").replace("courses = 1\nbricks = 1\n", "");
        let panel = panel.replace("height = 0.5, thickness", "height = 0.3, thickness");
        let stones = [stone(1, base), stone(2, above)].join(", ");
        let joint = "[joint]\nbed = { law = \"rigid\" }\nhead = { law = \"rigid\" }\n[motion]\nduration = 0.01";
        let text = format!("{panel}\nmortar = {{ bed = \"10 mm\", head = 0 }}\nblock = [{stones}]\n{joint}");
        let file = from_str(&text, Syntax::Toml, None).expect("a wall file");
        file.validate().expect("a valid wall");
        prepare_case(file.case, Path::new(".")).map(|_| ()).map_err(|e| e.to_string())
    };
    for bevel in [false, true] {
        assert_eq!(told(0.0, 0.31, bevel), Ok(()));
        assert_eq!(told(0.01, 0.32, bevel), Ok(()));
        let hung = told(0.0, 0.36, bevel).expect_err("it hangs");
        assert!(hung.contains("panel[0].block[1]") && hung.contains("block p1c2b1"), "{hung}");
        let hung = told(0.8, 1.11, bevel).expect_err("both hang");
        assert!(hung.contains("panel[0].block[0]: block p1c1b1 hangs in the air, 0.8 m above the base"), "{hung}");
    }
    // What is uneven by a tenth of a brick's height is packed with mortar.
    assert_eq!(told(0.0, 0.349, false), Ok(()));
}

/// Results tell stiffnesses as they act: along k A, across 2.4 times as much and rigidity besides.
#[test]
fn stiffnesses_are_told_as_they_act() {
    let wall = ready(&stack(
        2,
        r#"
[joint]
bed = { law = "no-tension", stiffness = "10 N/mm3", rigidity = 3 }
head = { law = "none" }
[motion]
duration = "10 ms"
"#,
    ));
    // 0.5 m × 1 m.
    let rows = concio::run::joint_rows(&wall.model);
    let along = farthest(rows.iter().map(|row| (row.stiffness / (10e9 * 0.5), 1.0)));
    let across = farthest(rows.iter().map(|row| (row.normal_stiffness / (2.4 * 3.0 * 10e9 * 0.5), 1.0)));
    agrees!("Springs: stiffness along joints, largest error over it", "k A", "", along, 0.0, abs: 1e-12);
    agrees!("Springs: stiffness across joints, largest error over it", "2.4 r k A", "", across, 0.0, abs: 1e-12);
}

/// A bond that softens in shear from F_0 = c A + N μ to N μ by (P9) has lost a fifth of its peak at δ_0 + δ_c ln(c A/(c A − F_0/5)); what slides
/// on friction alone never does.
#[test]
fn a_push_tells_stiffness_and_ultimate_displacement() {
    let pushed = |bond: &str| {
        let (_, outcome) = ran(&stack(
            1,
            &format!(
                r#"
[joint]
bed = {{ law = "elastic", stiffness = "1 N/mm3" }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 0.3, dynamic = 0.3 }}
{bond}
[[joint.change]]
at = {{ kind = ["top"] }}
spring = {{ stiffness = "2000 N/mm3" }}
friction = {{ static = 3, dynamic = 3 }}
[load]
top = "1000 kN/m"
beam = "driven"
beam_rotation = "fixed"
[motion]
top = {{ path = {{ displacements = ["10 mm"], speed = "1 mm/s" }} }}
quasi_static = true
"#
            ),
        ));
        outcome.push().expect("a push")
    };
    // 0.5 m² under 502 kN.
    let (area, load, cohesion, energy): (f64, f64, f64, f64) = (0.5, 502e3, 0.4e6, 600.0);
    let (strength, friction) = (cohesion * area + 0.3 * load, 0.3 * load);
    let limit = strength / (1e9 * area);
    // (P10).
    let stored = 0.5 * (strength.powi(2) - friction.powi(2)) / (1e9 * area);
    let decay = (energy * area - stored) / ((1.0 - 1e-3) * strength);
    let softening = pushed(
        "bond = { tensile_strength = \"1 MPa\", cohesion = \"0.4 MPa\", friction_angle = \"16.6992442 deg\", mode_1_energy = \"1000 N/m\", mode_2_energy = \"600 N/m\" }",
    );
    let fifth = limit + decay * (cohesion * area / (cohesion * area - 0.2 * strength)).ln();
    close(softening.stiffness, strength / limit, 1e-2);
    close(softening.ultimate.expect("it softens"), fifth, 1e-2);
    assert_eq!(pushed("").ultimate, None);
}
