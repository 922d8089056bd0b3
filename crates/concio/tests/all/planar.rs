//! Planar walls from their files against closed forms.

use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::outcome::Outcome;
use concio::record::EventKind;
use concio::run::{Prepared, prepare_case, run_in_memory};
use concio::wall::End;
use concio_verified::{agrees, farthest};

fn prepared(text: &str) -> Prepared {
    let file = from_str(text, Syntax::Toml, None).expect("a wall file");
    file.validate().expect("a valid wall");
    prepare_case(file.case, Path::new(".")).expect("a wall that stands")
}

fn ran(text: &str) -> (Prepared, Outcome) {
    let prepared = prepared(text);
    let outcome = run_in_memory(&prepared).expect("a run");
    (prepared, outcome)
}

/// One block of 0.5 m × 0.5 m × 1 m and 5 kN.
fn block(rest: &str) -> String {
    format!(
        r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = {{ length = 0.5, height = 0.5, thickness = 1, specific_weight = 20e3 }}
{rest}"#
    )
}

fn channel(outcome: &Outcome, name: &str) -> Vec<f64> {
    outcome.history(name).expect("a channel")
}

fn close(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() <= relative, "{found} instead of {expected}");
}

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

/// A bond that stores more at its strength than breaking takes snaps back; both modes are told with the least that is allowed.
#[test]
fn bonds_that_snap_back_are_refused() {
    let of = |bond: &str| {
        let text = block(&format!(
            "[joint]\nbed = {{ law = \"elastic\", stiffness = \"10 N/mm3\", normal_to_shear = 2 }}\nhead = {{ law = \"none\" }}\n\
             bond = {{ tensile_strength = \"0.2 MPa\", cohesion = \"0.3 MPa\", {bond} }}\n[motion]\nduration = 1"
        ));
        let file = from_str(&text, Syntax::Toml, None).expect("a wall file");
        file.validate().expect("a valid wall");
        prepare_case(file.case, Path::new(".")).map(|_| ()).map_err(|e| e.to_string())
    };
    // f_t²/(2 k_n) = 1 N/m and c²/(2 k_s) = 4.5 N/m.
    assert_eq!(of("mode_1_energy = 1.01, mode_2_energy = 4.51"), Ok(()));
    assert_eq!(of("mode_1_energy = 0"), Ok(()));
    let refused = |bond: &str| of(bond).expect_err("a bond that snaps back");
    let told = refused("mode_1_energy = 0.99");
    assert!(told.contains("joint.bond.mode_1_energy") && told.contains("from 1.01 N/m"), "{told}");
    let told = refused("mode_1_energy = 5, mode_2_energy = 4.49");
    assert!(told.contains("joint.bond.mode_2_energy") && told.contains("from 4.51 N/m"), "{told}");
}

/// A block on rigid dry ground slides when it is tilted by μ, and turns over by b/h; the run tells the collapse, and what it bore and how
/// far it went until then.
#[test]
fn a_block_tilts_until_it_slides_or_turns() {
    let tilted = |mu: f64, height: f64, duration: f64| {
        let text = block(&format!(
            r#"
[joint]
bed = {{ law = "rigid" }}
head = {{ law = "rigid" }}
friction = {{ law = "coulomb", static = {mu}, dynamic = {mu} }}
[motion]
duration = "{duration} s"
quasi_static = true
base = {{ tilt = {{ acceleration = "-1 g", rise = "{duration} s" }} }}
[output]
interval = 0.02
"#
        ));
        ran(&text.replace("height = 0.5", &format!("height = {height}"))).1
    };
    let starts = |outcome: &Outcome| {
        let x = channel(outcome, "top/displacement");
        let first = x.iter().position(|x| x.abs() > 1e-7).expect("it moves");
        outcome.recording.time[first]
    };
    let slides = tilted(0.4, 0.5, 10.0);
    let begins = starts(&slides);
    agrees!("Sliding: block on ground tilted by 0.1 g a second, instant it slides", "μ g", "s", begins, 4.0, abs: 0.041);
    assert!(slides.recording.collapse().is_none());
    let found = slides.totals.base_shear_peak;
    agrees!("Sliding: block on tilted ground, peak base shear", "μ W", "N", found, 0.4 * 5e3, 1e-7);
    let turns = tilted(0.7, 1.25, 10.0);
    let begins = starts(&turns);
    agrees!("Rocking: block on ground tilted by 0.1 g a second, instant it turns", "g b/h", "s", begins, 4.0, abs: 0.041);
    let gone = channel(&turns, "peak/displacement");
    let standing = turns.recording.standing(&turns.recording.time);
    assert!(
        (turns.recording.collapse().expect("it turns over").time - turns.recording.time[standing - 1]).abs() < 1e-9
    );
    close(turns.totals.peak_relative_displacement, gone[standing - 1], 1e-9);
    assert!(gone[standing..].iter().any(|x| *x > 1.2 * gone[standing - 1]));
    // As it turns over it pulls at the base the other way, by more than the tenth of its weight that it bore.
    let thin = tilted(0.7, 5.0, 100.0);
    let standing = thin.recording.standing(&thin.recording.time);
    let away = channel(&thin, "base/shear")[..standing].iter().fold(0.0, |most: f64, x| most.max(*x));
    assert!(away > 0.2 * 5e4, "{away}");
    let found = thin.totals.base_shear_peak;
    agrees!("Rocking: thin block that turns over, peak base shear until then", "W b/h", "N", found, 0.1 * 5e4, 0.02);
}

/// The first crack of a bonded joint in tension comes at the strength: N/A − 6 M/(b ℓ²) = −f_t at the edge.
#[test]
fn the_edge_of_a_bonded_joint_cracks_at_its_strength() {
    let (_, outcome) = ran(&block(
        r#"
[joint]
bed = { law = "elastic", stiffness = "36e6 N/m3" }
head = { law = "none" }
bond = { tensile_strength = "0.05 MPa", cohesion = "1 MPa" }
[motion]
duration = "10 s"
quasi_static = true
base = { tilt = { acceleration = "-10 g", rise = "10 s" } }
[solver]
step = 0.01
"#,
    ));
    let crack = outcome.first_crack().expect("a crack").cracked;
    // 5 kN λ 0.25 m = (f_t + 10 kPa) b ℓ²/6.
    let lambda = (0.05e6 + 10e3) * 0.25 / 6.0 / (5e3 * 0.25);
    let against = "N/A − 6 M/(b ℓ²) = −f_t at the edge";
    agrees!(
        "Bonds: block on a bonded bed joint, base acceleration of the first crack",
        against,
        "g",
        crack,
        lambda,
        0.01
    );
}

#[test]
fn a_resumed_run_has_the_bits_of_one_that_was_not_stopped() {
    use concio::record::Recording;
    use concio::simulate::Simulation;
    let prepared = prepared(
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

/// A dashpot c in the place of the bed joint and nothing else: a pulse a of length T moves the block by a T m/c and no farther.
#[test]
fn a_dashpot_damps_without_a_spring() {
    let (_, outcome) = ran(&block(
        r#"
[joint]
bed = { law = "rigid" }
head = { law = "none" }
[[joint.change]]
at = { kind = ["base"] }
device = { law = "viscous", damping = 10e3 }
[motion]
duration = "1 s"
base = { pulse = { shape = "rectangular", acceleration = -1, duration = "0.05 s" } }
"#,
    ));
    let mass = 5e3 / concio::G;
    let x = *channel(&outcome, "top/displacement").last().expect("a sample");
    agrees!("Devices: viscous below a planar block, way after a pulse", "a T m/c", "m", x, 0.05 * mass / 10e3, 1e-3);
    let (taken, given) = (outcome.energies.damping, outcome.energies.input());
    agrees!("Devices: viscous below a planar block, energy taken", "energy of the pulse", "J", taken, given, 1e-3);
}

/// Devices whose force is no straight line: below a block that cannot turn over, and between two that slide.
const DEVICES: [&str; 4] = [
    r#"{ law = "viscous", damping = 2e3, exponent = 0.4, reference_velocity = 0.1 }"#,
    r#"{ law = "bouc-wen", yield_force = 400, yield_displacement = "1 mm", hardening = 0.05, damping = 50 }"#,
    r#"{ law = "bouc-wen", yield_force = 400, yield_displacement = "1 mm", sharpness = 20, beta = 0.9, gamma = 0.1 }"#,
    r#"{ law = "re-centring", stiffness = 4e5, activation_force = 400, flag = 0.8, post_stiffness = 1e4 }"#,
];

/// Two flat blocks side by side, each on the base without friction, with this device at these joints.
fn on_device(model: &str, kind: &str, device: &str, solver: &str) -> Outcome {
    let text = format!(
        r#"
model = "{model}"
[[panel]]
bond = "stack"
courses = 1
bricks = 2
brick = {{ length = 0.5, height = 0.05, thickness = 1, specific_weight = 20e3 }}
[joint]
damping_ratio = 0
bed = {{ law = "{bed}", stiffness = 0 }}
head = {{ law = "none" }}
friction = {{ law = "none" }}
[[joint.change]]
at = {{ kind = ["base"] }}
device = {below}
[[joint.change]]
at = {{ kind = ["head"] }}
device = {between}
[[joint.change]]
at = {{ joints = ["base|p1c1b1"] }}
device = {left}
[motion]
duration = "1.5 s"
base = {{ sine = {{ acceleration = 9, frequency = "3 Hz" }} }}
[solver]
{solver}
[output]
interval = 0.01
blocks = ["all"]
"#,
        bed = if model == "shear" { "elastic" } else { "rigid" },
        below = if kind == "base" { device } else { r#"{ law = "elastic", stiffness = 0 }"# },
        between = if kind == "base" { r#"{ law = "elastic", stiffness = 0 }"# } else { device },
        // The left block holds back the right one through what is between them, or both go their way.
        left = if kind == "base" { device } else { r#"{ law = "viscous", damping = 1500 }"# },
    );
    ran(&text).1
}

/// Blocks that can but slide are those of the shear model, whatever their devices; errors fall with the square of the step, less where the
/// law has corners, every step is solved, and the account closes to what a solution leaves.
#[test]
fn devices_do_what_they_do_in_the_shear_model() {
    for (kind, device) in ["base", "head"].into_iter().flat_map(|kind| DEVICES.map(|device| (kind, device))) {
        // How far the device is stretched.
        let of = |outcome: &Outcome| -> Vec<f64> {
            let [a, b] = ["p1c1b1", "p1c1b2"].map(|block| channel(outcome, &format!("block/{block}/displacement")));
            if kind == "base" { b } else { a.iter().zip(b).map(|(a, b)| a - b).collect() }
        };
        let exact = of(&on_device("shear", kind, device, "tolerance = 1e-7"));
        let size = exact.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let [coarse, fine] = ["2e-3", "1e-3"].map(|step| {
            let outcome = on_device("planar", kind, device, &format!("step = {step}"));
            assert!(outcome.totals.peak_residual < 1e-6 * outcome.totals.peak_input, "{kind} {device}");
            assert_eq!(outcome.counters.unsolved, 0);
            let taken = outcome.energies.device + outcome.energies.damping;
            assert!(taken > 0.3 * outcome.energies.input() && outcome.energies.impact.abs() < 1e-6 * taken);
            of(&outcome).iter().zip(&exact).fold(0.0, |most: f64, (x, y)| most.max((x - y).abs())) / size
        });
        let long = on_device("planar", kind, device, "step = 2e-2");
        assert!(
            long.counters.unsolved == 0 && long.counters.iterations < 12 * long.counters.steps,
            "{:?}",
            long.counters
        );
        println!("{kind} {device}: {coarse:e} {fine:e}");
        assert!(coarse < 2e-2 && coarse > 2.0 * fine, "{kind} {device}: {coarse:e} {fine:e}");
    }
}

/// Bricks of 0.5 m × 0.2 m × 1 m, 2 kN each, one on the other.
fn stack(courses: usize, rest: &str) -> String {
    format!(
        r#"
model = "planar"
[[panel]]
bond = "stack"
courses = {courses}
bricks = 1
brick = {{ length = 0.5, height = 0.2, thickness = 1, specific_weight = 20e3 }}
{rest}"#
    )
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
        close(prepared(&shear).model.base_load(), planar.model.base_load(), 1e-12);
    }
}

/// Sliding on springs is unstable, which a step of 1 ms does not resolve: the wall moves farther in shorter steps, and the run says so. On rigid
/// joints the step matters little. Figures of docs/planar.md.
#[test]
fn a_wall_that_flutters_moves_farther_in_short_steps() {
    let told = |joints: &str, step: f64| {
        let (prepared, outcome) = ran(&format!(
            r#"
model = "planar"
[[panel]]
bond = "running"
courses = 5
bricks = 6
brick = {{ length = "0.4 m", height = "0.2 m", thickness = "0.3 m", specific_weight = "20 kN/m3" }}
mortar = {{ bed = 0, head = 0 }}
[joint]
damping_ratio = 0.05
{joints}
friction = {{ law = "coulomb", static = 0.6, on = "all" }}
[motion]
duration = "1.2 s"
base = {{ pulse = {{ shape = "one-sine", acceleration = "0.8 g", duration = "0.5 s" }} }}
[solver]
step = {step}
"#
        ));
        let summary = concio::run::summary(&prepared, &outcome, 0.0, None);
        let warns = summary["warnings"].to_string().contains("blocks slid on springs that ring faster");
        (outcome.totals.peak_relative_displacement, warns)
    };
    let springs = r#"
bed = { law = "no-tension", stiffness = "10 N/mm3", rigidity = 1, normal_to_shear = 2.4 }
head = { law = "no-tension", stiffness = "24 N/mm3", rigidity = 1, normal_to_shear = 2.4 }"#;
    let rigid = "bed = { law = \"rigid\" }\nhead = { law = \"rigid\" }";
    let [long, short, shortest] = [1e-3, 0.25e-3, 0.02e-3].map(|step| told(springs, step));
    let [firm, firmer] = [1e-3, 0.25e-3].map(|step| told(rigid, step));
    assert!(long.1 && short.1 && !firm.1 && !firmer.1);
    let figures = [(long, 18.9e-3), (short, 23.2e-3), (shortest, 38.4e-3), (firm, 14.8e-3), (firmer, 14.8e-3)];
    for ((found, _), figure) in figures {
        assert!((found / figure - 1.0).abs() < 0.03, "{found} m instead of {figure} m");
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
        let model = prepared(&text).model;
        model.planar().expect("a planar wall").slowest().expect("it swings").frequency
    };
    let without = frequency(r#"law = "none""#);
    for stiffness in [15, 24, 30] {
        let head = format!(r#"law = "no-tension", stiffness = "{stiffness} N/mm3", rigidity = 1"#);
        close(frequency(&head), without, 1e-9);
    }
}

/// Without inertia, a block that sticks to a driven beam goes where the beam goes, and the beam does the work of the friction below.
#[test]
fn a_slow_beam_takes_the_wall_along() {
    let (prepared, outcome) = ran(&stack(
        1,
        r#"
[joint]
bed = { law = "rigid" }
head = { law = "none" }
friction = { law = "coulomb", static = 0.3, dynamic = 0.3 }
[[joint.change]]
at = { kind = ["top"] }
friction = { static = 1, dynamic = 1 }
[load]
top = "100 kN/m"
beam = "driven"
beam_rotation = "fixed"
[motion]
top = { path = { displacements = ["10 mm"], speed = "1 mm/s" } }
duration = "10 s"
quasi_static = true
"#,
    ));
    let beam = prepared.model.unknowns();
    let last = outcome.recording.frame_displacement.len() - beam;
    close(outcome.recording.frame_displacement[last], 10e-3, 1e-6);
    // In every step it starts from rest, which takes m 2 v/h beside, a thousandth.
    let (expected, e) = (0.3 * 52e3 * 10e-3, &outcome.energies);
    agrees!("Sliding: block driven slowly by a beam, energy of friction", "μ N d", "J", e.friction, expected, 2e-3);
    agrees!("Sliding: block driven slowly by a beam, work of the beam", "μ N d", "J", e.input_top, expected, 2e-3);
}

/// A block under 50 kN that a beam drives slowly bears μ_s N as long as it slides: on rigid joints, where what rests bears anything up to that, and on springs, where
/// `stribeck-stick` weakens with a speed that means nothing here.
#[test]
fn a_block_that_slides_slowly_bears_its_friction() {
    let stribeck = r#""stribeck-stick", static = 0.2, dynamic = 0.1, slip_velocity = "1 mm/s""#;
    let coulomb = r#""coulomb", static = 0.2, dynamic = 0.2"#;
    for (bed, friction, name) in [
        (r#"law = "rigid""#, coulomb, "rigid joint"),
        (r#"law = "no-tension", stiffness = "5 N/mm3", rigidity = 1"#, stribeck, "springs and stribeck-stick"),
    ] {
        for step in [5, 20, 80] {
            let (_, outcome) = ran(&block(&format!(
                r#"
[joint]
bed = {{ {bed} }}
head = {{ law = "none" }}
friction = {{ law = {friction} }}
[[joint.change]]
at = {{ kind = ["top"] }}
friction = {{ static = 9, dynamic = 9 }}
[load]
top = {{ force = "50 kN" }}
beam = "driven"
beam_height = 0.1
[motion]
top = {{ path = {{ displacements = ["2 mm", "-2 mm"], speed = "1 mm/s" }} }}
quasi_static = true
[solver]
step = "{step} ms"
[output]
interval = "80 ms"
"#
            )));
            let (time, shear) = (&outcome.recording.time, channel(&outcome, "base/shear"));
            let sliding = time.iter().zip(&shear).filter(|(t, _)| (1.0..1.9).contains(*t) || (4.0..5.9).contains(*t));
            let off = sliding.map(|(_, shear)| (shear.abs() / (0.2 * 55e3) - 1.0).abs()).fold(0.0, f64::max);
            let subject =
                format!("Sliding: block driven slowly, largest error of its force; {name}, steps of {step} ms");
            agrees!(subject, "μ_s N", "", off, 0.0, abs: 2e-3);
        }
    }
}

/// Without inertia, devices bear what their laws say of the way of the beam, there and back: (I4) its limit and a part by hardening, (I6) its flag.
#[test]
fn a_slow_beam_draws_the_loop_of_a_device() {
    let force = |device: &str| {
        let (prepared, outcome) = ran(&stack(
            1,
            &format!(
                r#"
[joint]
bed = {{ law = "rigid" }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 1, dynamic = 1 }}
[[joint.change]]
at = {{ kind = ["base"] }}
device = {device}
[load]
top = "100 kN/m"
beam = "driven"
beam_rotation = "fixed"
[motion]
top = {{ path = {{ displacements = ["10 mm", "5 mm"], speed = "1 mm/s" }} }}
duration = "15 s"
quasi_static = true
"#
            ),
        ));
        let count = prepared.model.joints.iter().filter(|j| j.kind == concio::case::JointKind::Base).count() as f64;
        assert_eq!(outcome.counters.unsolved, 0);
        let at = |t: f64| {
            let at = outcome.recording.time.partition_point(|s| *s < t - 1e-9);
            channel(&outcome, "top/force")[at] / count
        };
        // All that the wall moves under its load is the way of the device, 10 mm there and 5 mm back.
        close(outcome.envelopes.joint_slip[0], 15e-3, 1e-3);
        [at(10.0).abs(), at(15.0) * at(10.0).signum()]
    };
    let [pushed, back] =
        force(r#"{ law = "re-centring", stiffness = 4e6, activation_force = 4e3, flag = 0.75, post_stiffness = 1e5 }"#);
    let of = |what: &str| format!("Devices: re-centring below a beam driven slowly, force {what}");
    let against = "the flag's upper branch (I6)";
    agrees!(of("there"), against, "N", pushed, 1e5 * 10e-3 + (4e6 - 1e5) * 1e-3, 1e-4);
    let against = "the flag's lower branch (I6)";
    agrees!(of("halfway back"), against, "N", back, 1e5 * 5e-3 + (4e6 - 1e5) * 0.25e-3, 1e-4);
    let [pushed, back] =
        force(r#"{ law = "bouc-wen", yield_force = 4e3, yield_displacement = "1 mm", hardening = 0.1 }"#);
    let of = |what: &str| format!("Devices: Bouc–Wen below a beam driven slowly, force {what}");
    let against = "r k d ± (1 − r) F_y (I4)";
    agrees!(of("there"), against, "N", pushed, 0.1 * 4e6 * 10e-3 + 0.9 * 4e3, 1e-4);
    agrees!(of("halfway back"), against, "N", back, 0.1 * 4e6 * 5e-3 - 0.9 * 4e3, 1e-2);
}

/// Twice as much as the joint's strength, by whatever law: the wall comes down, and no joint has borne more than its strength.
#[test]
fn joints_of_every_law_are_crushed() {
    for law in ["rigid", "elastic", "no-tension"] {
        let stiffness = if law == "rigid" { "" } else { ", stiffness = \"15 N/mm3\", rigidity = 1" };
        let stiffness = if law == "elastic" { ", stiffness = \"15 N/mm3\"" } else { stiffness };
        let bond =
            if law == "elastic" { "bond = { tensile_strength = \"0.1 MPa\", cohesion = \"0.1 MPa\" }" } else { "" };
        let text = |load: &str| {
            stack(
                2,
                &format!(
                    r#"
[joint]
bed = {{ law = "{law}"{stiffness}, compressive_strength = "1 MPa" }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 0.6, dynamic = 0.6 }}
{bond}
[load]
top = "{load}"
mass = 0
[motion]
duration = "0.1 s"
"#
                ),
            )
        };
        let (prepared, outcome) = ran(&text("2000 kN/m"));
        let events = &outcome.recording.events;
        assert!(events.iter().any(|e| e.kind == EventKind::Crush), "{law}");
        // The event is of a joint of the block that the totals name.
        let (told, named) = (outcome.recording.collapse().expect(law), outcome.totals.collapse.expect(law));
        assert_eq!((told.time, told.value), (named.time, named.way), "{law}");
        let joint = &prepared.model.joints[told.joint as usize];
        assert!(joint.a == named.block || joint.b == concio::wall::End::Block(named.block), "{law}");
        let (_, below) = ran(&text("900 kN/m"));
        assert!(
            below.recording.events.is_empty() && below.totals.collapse.is_none(),
            "{law}: {:?}",
            below.recording.events
        );
    }
}

/// A stone that turns over on a toe that crushes leans on a block of stress f_c as long as its weight needs: λ = (ℓ/2 − N/(2 f_c b))/h_c.
#[test]
fn a_toe_that_crushes_is_a_block_of_stress() {
    let springs = r#"law = "no-tension", stiffness = "100 N/mm3", rigidity = 1"#;
    let rigid = r#"law = "rigid""#;
    for (law, strength) in [(springs, 0.1), (springs, 0.3), (rigid, 0.06), (rigid, 0.14), (rigid, 0.3), (rigid, 3.0)] {
        // 0.5 m × 2 m × 1 m.
        let (length, height, weight) = (0.5, 2.0, 20e3);
        let stone = block(&format!(
            r#"
[joint]
bed = {{ {law}, compressive_strength = "{strength} MPa" }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 0.7, dynamic = 0.7 }}
[motion]
quasi_static = true
base = {{ tilt = {{ acceleration = "0.5 g", rise = "60 s" }} }}
duration = "60 s"
"#
        ));
        let (_, outcome) = ran(&stone.replace("height = 0.5", "height = 2"));
        let leans_on = weight / (strength * 1e6);
        let expected = 0.5 * (length - leans_on) / (0.5 * height);
        let name = if law == rigid { "rigid joint" } else { "springs without tension" };
        let subject = format!("Crushing: stone of 0.5 m × 2 m that turns over; {name}, f_c = {strength} MPa");
        let against = "λ = (ℓ/2 − N/(2 f_c b))/h_c";
        // While it falls it bears what its other corners do.
        let standing = |(shear, moved): (&f64, &f64)| (*moved < 0.1).then_some(shear.abs());
        let shear = channel(&outcome, "base/shear");
        let moved = channel(&outcome, "peak/displacement");
        let bears = shear.iter().zip(&moved).map_while(standing).fold(0.0, f64::max);
        agrees!(subject, against, "", bears / weight, expected, 0.007);
        assert!(outcome.recording.events.iter().any(|e| e.kind == EventKind::Crush));
    }
}

/// What a stone of 0.5 m × 2 m that rocks keeps of its angular velocity from impact to impact: what the wall file says (P8), or what
/// the impact leaves (Housner 1963) where that is less.
#[test]
fn a_stone_rocks_with_the_restitution_of_its_joint() {
    let (b, h) = (0.25f64, 1.0f64);
    let (radius, housner) = (b.hypot(h), 1.0 - 1.5 * (b / b.hypot(h)).powi(2));
    let (bed, change) = ("", "[[joint.change]]\nat = { kind = [\"base\"] }\nspring = { rocking_restitution = 0.8 }");
    // The default step too: impacts fall within a step.
    for (given, change, expected, step) in [
        (bed, "", housner, 2e-4),
        (bed, "", housner, 1e-3),
        (", rocking_restitution = 0.99", "", housner, 2e-4),
        (", rocking_restitution = 0.8", "", 0.8, 2e-4),
        (", rocking_restitution = 0.8", "", 0.8, 1e-3),
        (bed, change, 0.8, 2e-4),
    ] {
        let stone = block(&format!(
            r#"
[joint]
bed = {{ law = "rigid"{given} }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 0.7, dynamic = 0.7 }}
{change}
[motion]
base = {{ pulse = {{ shape = "half-sine", acceleration = "0.45 g", duration = "0.4 s" }} }}
duration = "4 s"
[solver]
step = {step}
"#
        ));
        let (_, outcome) = ran(&stone.replace("height = 0.5", "height = 2"));
        assert!(outcome.totals.peak_residual < 1e-4 * outcome.totals.peak_input);
        // Joints tell all that impacts took.
        let (told, energies) = (&outcome.envelopes.joint_dissipation, &outcome.energies);
        close(told.iter().sum(), energies.impact + energies.friction, 1e-9);
        // Energy above that at rest over the weight, at the ends of the swings after the pulse.
        let depth = |x: f64| (radius * radius - (b - x.abs()).powi(2)).sqrt() - h;
        let x = channel(&outcome, "top/displacement");
        let first = outcome.recording.time.iter().position(|t| *t > 0.4).expect("time");
        let ends = x[first..].windows(3).filter(|w| w[1].abs() > w[0].abs() && w[1].abs() >= w[2].abs());
        let depths: Vec<f64> = ends.map(|w| depth(w[1])).filter(|d| *d > 1e-4).collect();
        assert!(depths.len() > 3, "{given}{change}: {depths:?}");
        let off = farthest(depths.windows(2).map(|pair| ((pair[1] / pair[0]).sqrt() / expected, 1.0)));
        let given = if change.is_empty() { given } else { ", changed" };
        let subject = format!(
            "Rocking: stone of a wall file, angular velocity left by impacts, largest error over it; steps of {} ms{given}",
            1e3 * step
        );
        agrees!(subject, "the lesser of η and 1 − 3/2 sin² α (Housner 1963)", "", off, 0.0, abs: 1e-2);
    }
}

/// What a change of joints that are not rigid says of their rocking is refused.
#[test]
fn only_rigid_joints_rock() {
    let stone = block(
        r#"
[joint]
bed = { law = "no-tension", stiffness = "1 N/mm3" }
head = { law = "none" }
[[joint.change]]
at = { kind = ["base"] }
spring = { rocking_restitution = 0.8 }
[motion]
duration = "0.1 s"
"#,
    );
    let file = from_str(&stone, Syntax::Toml, None).expect("a wall file");
    let error = prepare_case(file.case, Path::new(".")).expect_err("no joint rocks").to_string();
    assert!(error.contains("joint.change[0].spring.rocking_restitution") && error.contains("rigid"), "{error}");
}

/// A stone of 0.5 m × 2 m whose foot slides keeps (1 − μ B/H)/(1 + μ B/H) of its turn at least: 0.702 with μ = 0.7, 0.538 with 1.2.
#[test]
fn a_foot_that_slides_is_told() {
    for (given, friction, least) in
        [(0.8, 0.7, None), (0.6, 0.7, Some("0.702")), (0.6, 1.2, None), (0.0, 1.2, Some("0.538"))]
    {
        let stone = block(&format!(
            r#"
[joint]
bed = {{ law = "rigid", rocking_restitution = {given} }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = {friction}, dynamic = {friction} }}
[motion]
duration = "0.1 s"
"#
        ))
        .replace("height = 0.5", "height = 2");
        let file = from_str(&stone, Syntax::Toml, None).expect("a wall file");
        let warnings = prepare_case(file.case, Path::new(".")).expect("a wall").model.warnings.clone();
        let told = warnings.iter().find(|warning| warning.contains("rocking_restitution ="));
        assert_eq!(told.is_some(), least.is_some(), "{warnings:?}");
        assert!(least.is_none_or(|least| told.is_some_and(|told| told.contains(least))), "{told:?}");
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

/// Breaking in shear takes G_f^II A under any pressure, and friction μ N takes the place of what the strength c A + N tan φ loses on the way (B4), (B5).
#[test]
fn a_full_break_takes_its_energy_under_any_pressure() {
    for load in [5.0, 100.0, 500.0] {
        let (_, outcome) = ran(&stack(
            1,
            &format!(
                r#"
[joint]
damping_ratio = 0
bed = {{ law = "elastic", stiffness = "15 N/mm3" }}
top = {{ law = "rigid" }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 0.6, dynamic = 0.6 }}
[joint.bond]
cohesion = "0.1 MPa"
tensile_strength = "0.1 MPa"
friction_angle = "30.96375653 deg"
mode_2_energy = "200 N/m"
on = ["base"]
[[joint.change]]
at = {{ kind = ["top"] }}
bond = {{ tensile_strength = "10 MPa", cohesion = "10 MPa" }}
[load]
top = "{load} kN/m"
beam = "driven"
beam_rotation = "fixed"
[motion]
top = {{ path = {{ displacements = ["30 mm"], speed = "1 mm/s" }} }}
duration = "30 s"
quasi_static = true
[solver]
step = "10 ms"
"#
            ),
        ));
        // 2 mm of softening length at most: nothing is left after fifteen of them. tan φ = μ.
        let energies = &outcome.energies;
        let pressure = 2e3 + 0.5e3 * load;
        let (strength, limit) = (50e3 + 0.6 * pressure, (50e3 + 0.6 * pressure) / 7.5e9);
        let softens = 100.0 / strength - 0.5 * limit;
        let spent: f64 = outcome.bonds.iter().map(|bond| bond.spent).sum();
        let subject = format!("Bonds: planar block sheared off by a beam, energy; under {load} kN/m");
        agrees!(subject, "G_f^II A (B4), (B5)", "J", spent, 100.0, 2e-3);
        close(energies.bond, 100.0, 2e-3);
        close(outcome.bonds[0].energy, 100.0, 1e-3);
        let rubbed = 0.6 * pressure * (30e-3 - limit - softens);
        let subject = format!("Bonds: planar block sheared off by a beam, work of the beam; under {load} kN/m");
        agrees!(subject, "G_f^II A + μ N (d − δ₀ − softening)", "J", energies.input_top, 100.0 + rubbed, 0.05);
        assert!(energies.friction > 0.99 * rubbed, "{} {rubbed}", energies.friction);
    }
}

/// What friction does to a slow push does not follow from the steps it is taken in.
#[test]
fn slow_friction_is_that_of_any_step() {
    let forces = |law: &str, step: &str| {
        let (_, outcome) = ran(&stack(
            1,
            &format!(
                r#"
[joint]
bed = {{ law = "no-tension", stiffness = "15 N/mm3", rigidity = 1 }}
head = {{ law = "none" }}
friction = {{ law = "{law}", static = 0.6, dynamic = 0.3, slip_velocity = "1 mm/s" }}
[[joint.change]]
at = {{ kind = ["top"] }}
friction = {{ static = 2, dynamic = 2 }}
[load]
top = "100 kN/m"
beam = "driven"
beam_rotation = "fixed"
[motion]
top = {{ path = {{ displacements = ["5 mm"], speed = "1 mm/s" }} }}
duration = "5 s"
quasi_static = true
[solver]
step = {step}
"#
            ),
        ));
        let last = *channel(&outcome, "top/force").last().expect("samples");
        [outcome.totals.top_force_peak, last.abs()]
    };
    for (law, after) in [("stribeck-stick", 0.6), ("coulomb", 0.3)] {
        for step in ["20e-3", "2e-3"] {
            let [peak, last] = forces(law, step);
            assert!(peak < 0.6 * 52e3 * 1.0001, "{law} {step}: {peak}");
            let subject = format!("Friction: planar block driven slowly, force at the end; {law}, steps of {step} s");
            let against = if law == "coulomb" { "μ_d N" } else { "μ_s N" };
            agrees!(subject, against, "N", last, after * 52e3, 1e-3);
        }
    }
}

/// Results call bed joints what the wall file does.
#[test]
fn bed_joints_that_bear_no_tension_are_told_so() {
    let wall = prepared(include_str!("../../../../examples/15-dry-shear-wall.toml"));
    let rows = concio::run::joint_rows(&wall.model);
    assert!(rows.iter().all(|row| row.law == concio::case::SpringLaw::NoTension));
}

/// Joints that do not rub neither bear shear nor store or lose anything by it.
#[test]
fn nothing_is_lost_by_friction_that_there_is_not() {
    let (_, outcome) = ran(&block(
        r#"
[joint]
bed = { law = "no-tension", stiffness = "15 N/mm3", rigidity = 1 }
head = { law = "none" }
[motion]
base = { sine = { amplitude = "5 mm", frequency = "2 Hz" } }
duration = "0.5 s"
"#,
    ));
    let energies = &outcome.energies;
    assert!(energies.friction.abs() < 1e-12 && energies.damping < 1e-6, "{energies:?}");
    // The block stays where it is while the base moves under it.
    let slip = outcome.envelopes.joint_slip.iter().fold(0.0, |m: f64, x| m.max(*x));
    assert!(slip > 5e-3, "{slip}");
}

/// A bonded wall shaken to pieces: stones that come upon other edges while their mortar holds in part work on no spring. Its account was off
/// by a quarter of all work when that stretched and pressed them.
#[test]
fn the_account_of_a_bonded_wall_that_falls_closes() {
    let (_, outcome) = ran(r#"
model = "planar"
[[panel]]
bond = "running"
courses = 6
bricks = 1
ends = "toothed"
brick = { length = "400 mm", height = "55 mm", thickness = "120 mm", specific_weight = "16 kN/m3" }
mortar = { bed = 0, head = 0 }
[joint]
bed = { law = "elastic", stiffness = "24 N/mm3" }
head = { law = "elastic", stiffness = "80 N/mm3" }
friction = { law = "stribeck-stick", static = 0.6, dynamic = 0.6, slip_velocity = "1 mm/s", on = "all" }
bond = { tensile_strength = "0.02 MPa", cohesion = "0.2 MPa", friction_angle = "30 deg", mode_1_energy = "5 N/m", mode_2_energy = "200 N/m" }
[load]
top = "20 kN/m"
beam = { mass = "0.2 t" }
[motion]
duration = "1.5 s"
base = { synthetic = { seed = 28, pga = "1.5 g", duration = "4 s" } }
[solver]
step = "2 ms"
"#);
    let residual = outcome.totals.peak_residual / outcome.totals.peak_input;
    assert!(outcome.totals.collapse.is_some() && outcome.energies.bond > 5.0, "{:?}", outcome.energies);
    assert!(residual < 1e-4, "{residual:e}");
}

/// Steps of a millisecond leave a tower on stiff joints its own period of 24 ms: after twenty of them a third of what a push gave it is there. Damped as the
/// joints alone were for their ringing it would stand still after three.
#[test]
fn a_tower_rings_at_steps_that_do_not_resolve_its_joints() {
    let (_, outcome) = ran(r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 10
bricks = 1
brick = { length = "800 mm", height = "200 mm", thickness = "300 mm", specific_weight = "20 kN/m3" }
mortar = { bed = 0, head = 0 }
[joint]
damping_ratio = 0
bed = { law = "no-tension", stiffness = "10 N/mm3", rigidity = 1 }
head = { law = "no-tension", stiffness = "10 N/mm3", rigidity = 1 }
friction = { law = "coulomb", static = 0.6, dynamic = 0.6 }
[load]
top = "20 kN/m"
[motion]
duration = "0.5 s"
base = { pulse = { shape = "half-sine", acceleration = "0.05 g", duration = "0.05 s" } }
[solver]
step = "1 ms"
"#);
    let e = &outcome.energies;
    let left = 1.0 - (e.impact + e.friction) / e.input_base;
    assert!(left > 0.25 && e.impact > 0.0, "{left} {e:?}");
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
    let wall = prepared(&stack(
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

/// The work of a force on an undamped wall that is driven for a period is 0, whatever the step: forces belong to the instants of displacements.
#[test]
fn an_undamped_wall_has_no_loop() {
    for (step, interval) in [("1 ms", "1 ms"), ("1 ms", "0.25 ms"), ("0.1 ms", "1 ms"), ("0.7 ms", "1 ms")] {
        let (_, outcome) = ran(&format!(
            r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 4
bricks = 1
brick = {{ length = 1, height = 0.25, thickness = 0.12, specific_weight = 18e3 }}
[joint]
damping_ratio = 0
bed = {{ law = "elastic", stiffness = "1 N/mm3" }}
head = {{ law = "none" }}
friction = {{ law = "none" }}
[load]
top = "20 kN/m"
beam = "driven"
beam_rotation = "fixed"
[motion]
duration = "0.5 s"
top = {{ sine = {{ amplitude = "1 mm", frequency = "10 Hz", ramp = "0.2 s" }} }}
[solver]
step = "{step}"
[output]
interval = "{interval}"
joints = ["p1c1b1|p1c2b1"]
blocks = ["p1c2b1"]
"#
        ));
        let last = (0.1 / concio::quantity::Time::parse(interval).expect("a time").si()).round() as usize;
        let loop_of = |force: &str, way: &str| {
            let [force, way] = [force, way].map(|name| channel(&outcome, name));
            let from = force.len() - 1 - last;
            // Over the ellipse of a force that is a quarter of a period behind: twice the damping ratio.
            let work: f64 = (from..from + last).map(|k| 0.5 * (force[k] + force[k + 1]) * (way[k + 1] - way[k])).sum();
            let most = |x: &[f64]| x[from..].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            work / (std::f64::consts::PI * most(&force) * most(&way))
        };
        let joint = "joint/p1c1b1|p1c2b1";
        for (force, way) in [
            ("top/force", "beam/displacement"),
            ("base/shear", "beam/displacement"),
            (&format!("{joint}/elastic"), &format!("{joint}/slip")),
        ] {
            let found = loop_of(force, way);
            // Of forces that are means over the step before a sample it is 3.1e-2; the wall's own vibration leaves some 10⁻⁴.
            assert!(found.abs() < 1e-3, "{force} at {step}, samples of {interval}: {found:e}");
        }
    }
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

/// A crack lies at the end of the joint that opens: a block that is tilted to the right opens at its left, and the other way round.
#[test]
fn a_crack_lies_at_the_end_that_opens() {
    for (sign, at_start) in [(-1.0, true), (1.0, false)] {
        let (_, outcome) = ran(&format!(
            r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 2
bricks = 1
brick = {{ length = "1 m", height = "0.5 m", thickness = "0.3 m", specific_weight = "20 kN/m3" }}
mortar = {{ bed = 0, head = 0 }}
[joint]
bed = {{ law = "elastic", stiffness = "50 N/mm3" }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 2, dynamic = 2 }}
bond = {{ tensile_strength = "0.05 MPa", cohesion = "5 MPa", mode_1_energy = "20 N/m" }}
[motion]
duration = "10 s"
base = {{ tilt = {{ acceleration = "{} g", rise = "10 s" }} }}
quasi_static = true
"#,
            1.4 * sign
        ));
        let bond = &outcome.bonds[0];
        assert!(bond.crack > 0.05 && bond.crack < 0.5, "{bond:?}");
        assert_eq!(bond.crack_start, if at_start { bond.crack } else { 0.0 });
        let [first, last] = bond.cracks();
        let drawn = if at_start { first } else { last };
        assert!((drawn[1] - drawn[0] - bond.crack).abs() < 1e-12, "{drawn:?}");
    }
}

/// A block of 1 m × `height` on one joint of `joint`, pushed or tilted by `rest`.
fn on_one_joint(height: &str, weight: &str, joint: &str, rest: &str) -> Outcome {
    let (_, outcome) = ran(&format!(
        "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 1\nbricks = 1\n\
         brick = {{ length = \"1 m\", height = \"{height}\", thickness = \"0.25 m\", specific_weight = \"{weight}\" }}\n\
         mortar = {{ bed = 0, head = 0 }}\n[joint]\nhead = {{ law = \"none\" }}\n{joint}\n[motion]\nquasi_static = true\n{rest}"
    ));
    outcome
}

/// A bonded rigid joint that is sheared and turned bears c A + N tan φ as a whole: 12.5 kN + 1 kN tan 30° over a weight of 1 kN.
#[test]
fn a_bonded_rigid_joint_is_sheared_as_a_whole() {
    let joint = "bed = { law = \"rigid\" }\nfriction = { law = \"coulomb\", static = 0.4, dynamic = 0.4 }\n\
                 bond = { tensile_strength = \"1 MPa\", cohesion = \"0.05 MPa\", friction_angle = \"30 deg\" }";
    let tilt = "base = { tilt = { acceleration = \"15 g\", rise = \"10 s\" } }\nduration = \"10 s\"";
    let outcome = on_one_joint("0.2 m", "20 kN/m3", joint, tilt);
    close(outcome.totals.base_shear_peak / 1e3, 12.5 + 30f64.to_radians().tan(), 3e-3);
}

/// The energy account closes where a joint crushes, and where the last of a bond breaks as the joint is open on one side.
#[test]
fn the_account_closes_where_joints_crush_and_where_bonds_end() {
    let push = |ways: &str| format!("top = {{ path = {{ displacements = {ways}, speed = \"1 mm/s\" }} }}\n");
    let load =
        "[load]\ntop = { force = \"75 kN\" }\nbeam = \"driven\"\nbeam_height = \"0.02 m\"\n[solver]\nstep = \"5 ms\"\n";
    let crushed = "bed = { law = \"no-tension\", rigidity = 1, stiffness = \"5 N/mm3\", compressive_strength = \"2 MPa\" }\n\
                   friction = { law = \"coulomb\", static = 0.6, dynamic = 0.6 }";
    let broken = "bed = { law = \"elastic\", stiffness = \"5 N/mm3\" }\nfriction = { law = \"coulomb\", static = 0.6, dynamic = 0.6 }\n\
                  bond = { tensile_strength = \"0.1 MPa\", cohesion = \"50 MPa\", friction_angle = \"0 deg\", mode_1_energy = \"10 N/m\" }\n\
                  [[joint.change]]\nat = { kind = [\"top\"] }\nspring = { stiffness = \"20000 N/mm3\" }\nfriction = { law = \"none\" }\n\
                  bond = { tensile_strength = \"5000 MPa\", cohesion = \"5000 MPa\", mode_1_energy = 0, mode_2_energy = 0 }";
    for (joint, ways, weight) in [
        (crushed, "[\"2 mm\", \"-2 mm\", \"2 mm\"]", "20 kN/m3"),
        (broken, "[\"1 mm\", \"-1 mm\", \"3 mm\"]", "0.001 kN/m3"),
    ] {
        let outcome = on_one_joint("1 m", weight, joint, &(push(ways) + load));
        let residual = outcome.totals.peak_residual / outcome.totals.peak_input;
        assert!(residual < 1e-4, "{residual:e}");
    }
}

/// What is crushed of a joint is gone: a stone of 1 m × 2 m that is pushed over, back and over again by 2 % bears what 2,000 strips do, and crushing takes what it
/// takes from them. Springs of 4,800 N/mm³ are pressed in by less than 1e-6 of the length at their strength, and act as stiff as that.
#[test]
fn a_crushed_joint_does_not_heal() {
    for (law, pressed_in) in [
        (r#""rigid""#, 1e-5),
        (r#""no-tension", rigidity = 1, stiffness = "2000 N/mm3""#, 1e-6),
        (r#""no-tension", rigidity = 1, normal_to_shear = 1, stiffness = "4 N/mm3""#, 1e-4),
    ] {
        crushed_to_and_fro(law, pressed_in);
    }
}

fn crushed_to_and_fro(law: &str, pressed_in: f64) {
    let (length, height, thickness, strength, weight, load) = (1.0, 2.0, 0.3, 0.4e6, 12e3, 10e3);
    let joint = format!("[joint]\nbed = {{ law = {law}, compressive_strength = \"0.4 MPa\" }}\n");
    let stone = block(
        &(joint
            + r#"
head = { law = "none" }
top = { law = "rigid" }
friction = { law = "coulomb", static = 1.9, dynamic = 1.9 }
[load]
top = "10 kN/m"
beam = "driven"
[motion]
quasi_static = true
top = { path = { displacements = ["50 mm", "0 mm", "50 mm"], speed = "5 mm/s" } }
"#),
    );
    let stone = stone.replace("length = 0.5", "length = 1").replace("height = 0.5", "height = 2");
    let (_, outcome) = ran(&stone.replace("thickness = 1", "thickness = 0.3"));
    // The block's centre is at half its height, the beam's half a metre above it.
    let (angles, lever) = (channel(&outcome, "top/displacement"), height + 0.5);
    let pushed = channel(&outcome, "top/force");
    const STRIPS: usize = 2000;
    let area = length * thickness;
    let stiffness = strength / (pressed_in * length);
    let (mut crushed, mut sunk, mut taken) = (vec![0.0f64; STRIPS], 0.0, 0.0);
    let x = |n: usize| ((n as f64 + 0.5) / STRIPS as f64 - 0.5) * length;
    let mut off = 0.0f64;
    for (angle, pushed) in angles.iter().zip(&pushed) {
        let bears = |sunk: f64, n: usize, gone: f64| (stiffness * (sunk + angle * x(n) - gone)).clamp(0.0, strength);
        let all = |sunk: f64, crushed: &[f64]| (0..STRIPS).map(|n| bears(sunk, n, crushed[n])).sum::<f64>();
        let [mut low, mut high] = [sunk - 1e-3, sunk + 1e-3];
        for _ in 0..45 {
            let middle = 0.5 * (low + high);
            let enough = all(middle, &crushed) * area / STRIPS as f64 > weight + load;
            *if enough { &mut high } else { &mut low } = middle;
        }
        sunk = low;
        let moment = (0..STRIPS).map(|n| bears(sunk, n, crushed[n]) * x(n)).sum::<f64>() * area / STRIPS as f64;
        for (n, gone) in crushed.iter_mut().enumerate() {
            let further = (sunk + angle * x(n) - strength / stiffness - *gone).max(0.0);
            taken += further * strength * area / STRIPS as f64;
            *gone += further;
        }
        let expected = (moment - weight * 0.5 * height * angle - load * lever * angle) / lever;
        off += (pushed - expected).abs() / angles.len() as f64;
    }
    let subject = format!(
        "Crushing: {} joint pressed in by {pressed_in:e} of its length, stone of 1 m × 2 m pushed over by 2 %, back and again",
        law.split('"').nth(1).unwrap_or_default()
    );
    agrees!(format!("{subject}; energy that crushing takes"), "2,000 strips", "J", outcome.energies.bond, taken, 1e-2);
    let most = pushed.iter().copied().fold(0.0, f64::max);
    let force = format!("{subject}; how far its force is off in the mean, over the largest");
    agrees!(force, "2,000 strips", "", off / most, 0.0, abs: 1e-2);
}
