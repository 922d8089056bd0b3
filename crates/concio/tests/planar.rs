//! Planar walls from their files against closed forms.

use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::outcome::Outcome;
use concio::record::EventKind;
use concio::run::{Prepared, prepare, run_in_memory};

fn prepared(text: &str) -> Prepared {
    let file = from_str(text, Syntax::Toml, None).expect("a wall file");
    file.validate().expect("a valid wall");
    prepare(file.case, Path::new(".")).expect("a wall that stands")
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
    let width = outcome.layout.channels.len();
    let at = outcome.layout.channels.iter().position(|c| c.name == name).expect("a channel");
    outcome.recording.values.chunks(width).map(|row| row[at]).collect()
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
        let error = x.iter().zip(&outcome.recording.time).map(|(x, t)| (x - exact(*t)).abs()).fold(0.0, f64::max);
        let size = x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let residual = outcome.totals.peak_residual / outcome.totals.peak_input;
        assert!(residual < 1e-6, "{residual:e}");
        error / size
    };
    let [coarse, fine] = ["2e-3", "1e-3"].map(error);
    assert!(fine < 3e-3 && (coarse / fine - 4.0).abs() < 0.5, "{coarse:e} {fine:e}");
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
    close(-outcome.recording.frame_rotation[last], rotation, 1e-3);
    close(outcome.recording.frame_displacement[last], shear + 0.25 * rotation, 1e-3);
    close(channel(&outcome, "base/shear").last().copied().unwrap_or(0.0).abs(), force, 1e-3);
}

/// A block on rigid dry ground slides when it is tilted by μ, and turns over by b/h; the run tells the collapse.
#[test]
fn a_block_tilts_until_it_slides_or_turns() {
    let tilted = |mu: f64, height: f64| {
        let text = block(&format!(
            r#"
[joint]
bed = {{ law = "rigid" }}
head = {{ law = "rigid" }}
friction = {{ law = "coulomb", static = {mu}, dynamic = {mu} }}
[motion]
duration = "10 s"
quasi_static = true
base = {{ tilt = {{ acceleration = "-1 g", rise = "10 s" }} }}
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
    let slides = tilted(0.4, 0.5);
    assert!((starts(&slides) - 4.0).abs() < 0.041, "{}", starts(&slides));
    assert!(!slides.recording.events.iter().any(|e| e.kind == EventKind::Collapse));
    let turns = tilted(0.7, 1.25);
    assert!((starts(&turns) - 4.0).abs() < 0.041, "{}", starts(&turns));
    assert!(turns.recording.events.iter().any(|e| e.kind == EventKind::Collapse));
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
    assert!((crack - lambda).abs() < 0.01 * lambda, "{crack} instead of {lambda}");
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
    close(x, 0.05 * mass / 10e3, 1e-3);
    close(outcome.energies.damping, outcome.energies.input(), 1e-3);
}
