//! Planar walls that slide, rock and ring against closed forms.

use std::path::Path;

use std::f64::consts::PI;

use concio::G;
use concio::case::{Syntax, from_str};
use concio::outcome::Outcome;
use concio::run::prepare_case;
use concio_verified::{agrees, farthest};

use crate::common::planar::{block, stack};
use crate::common::ready::{channel, close, ran};

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
    let figures = [(long, 20.6e-3), (short, 24.1e-3), (shortest, 29.8e-3), (firm, 14.8e-3), (firmer, 14.8e-3)];
    for ((found, _), figure) in figures {
        assert!((found / figure - 1.0).abs() < 0.03, "{found} m instead of {figure} m");
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

/// Slip of a block whose friction falls from μ_s to μ_d at once, or whose rigid bond breaks (c A/N + tan φ in place of μ_s), under a half sine A sin ω t of
/// T = π/ω: it begins at sin ω t_0 = μ_s g/A, and ends where the friction of motion has taken its velocity. The default step too: what acted
/// at rest acts until a step's end.
#[test]
fn a_block_slides_as_its_friction_falls() {
    let (moving, a, t) = (0.35, 0.7 * G, 0.25);
    let omega = PI / t;
    let slip = |rest: f64| {
        let t0 = (rest * G / a).asin() / omega;
        let (begins, braked) = (t - t0, moving * G);
        let speed = a / omega * ((omega * t0).cos() + 1.0) - braked * begins;
        let way =
            a / omega * (begins * (omega * t0).cos() + (omega * t0).sin() / omega) - 0.5 * braked * begins * begins;
        way + speed * speed / (2.0 * braked)
    };
    let bond = "bond = { cohesion = \"1 kPa\", tensile_strength = \"50 kPa\", friction_angle = \"26.565 deg\" }";
    let fallen = [("whose friction falls at once", 0.5, "", 0.5), ("whose rigid bond breaks", moving, bond, 0.6)];
    for ((which, rest, bond, until), step) in fallen.into_iter().flat_map(|fallen| [(fallen, 1e-3), (fallen, 2e-4)]) {
        let (_, outcome) = ran(&block(&format!(
            r#"
[joint]
bed = {{ law = "rigid" }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = {rest}, dynamic = {moving} }}
{bond}
[motion]
base = {{ pulse = {{ shape = "half-sine", acceleration = {a}, duration = {t} }} }}
duration = "0.6 s"
[solver]
step = {step}
"#
        )));
        let subject = format!("Sliding: block {which}, planar, steps of {} ms", 1e3 * step);
        let expected = slip(until);
        agrees!(subject, "Newmark's sliding block", "m", outcome.totals.peak_relative_displacement, expected, 2e-3);
    }
}

/// What is left of the slip of a block there and back under a sine A sin ω t of one period: friction turns round as it does, at any instant of a step.
/// On springs in line with friction it turns with them.
#[test]
fn a_block_that_slides_to_and_fro_comes_to_rest_where_it_should() {
    let (a, period, duration) = (0.8 * G, 0.3, 1.0);
    // 10 N/mm³ under 2 t/m³, 0.2 m high.
    let stiffness = 10e9 / (0.2 * 20e3 / G);
    let integrated = |springs: bool, rest: f64, moving: f64| {
        let (h, mut x, mut v, mut borne, mut peak) = (2e-6f64, 0.0f64, 0.0f64, 0.0f64, 0.0f64);
        for step in 0..(duration / h) as usize {
            let t = (step as f64 + 0.5) * h;
            let pushed = if t < period { -a * (2.0 * PI * t / period).sin() } else { 0.0 };
            let holds = v == 0.0 && pushed.abs() <= rest * G;
            let against = if v == 0.0 { pushed } else { v };
            borne = match springs {
                true => (borne - stiffness * h * v).clamp(-moving * G, moving * G),
                false if holds => -pushed,
                false => -(moving * G).copysign(against),
            };
            let after = v + h * (pushed + borne);
            let after = if !springs && v * after < 0.0 { 0.0 } else { after };
            x += 0.5 * h * (v + after);
            (v, peak) = (after, peak.max(x.abs()));
        }
        [peak, x]
    };
    let on_springs = "law = \"no-tension\", stiffness = \"10 N/mm3\", rigidity = 1";
    for (springs, rest, moving) in [(false, 0.4, 0.4), (false, 0.5, 0.35), (true, 0.4, 0.4)] {
        let [peak, left] = integrated(springs, rest, moving);
        let (which, law) = if springs { (" on springs", on_springs) } else { ("", "law = \"rigid\"") };
        let text = block(&format!(
            r#"
[joint]
bed = {{ {law} }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = {rest}, dynamic = {moving} }}
[motion]
base = {{ pulse = {{ shape = "one-sine", acceleration = {a}, duration = {period} }} }}
duration = {duration}
"#
        ));
        let (_, outcome) = ran(&text.replace("length = 0.5, height = 0.5", "length = 1, height = 0.2"));
        let subject = format!("Sliding: block{which} to and fro, μ_s {rest}, μ_d {moving}, planar");
        let found = outcome.totals.peak_relative_displacement;
        agrees!(format!("{subject}, peak"), "integration in steps of 2 µs", "m", found, peak, 2e-3);
        let found = *channel(&outcome, "top/displacement").last().expect("a sample");
        agrees!(format!("{subject}, left at the end"), "integration in steps of 2 µs", "m", found, left, 5e-2);
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
