//! What is asked first of a run, against closed forms: base shear with its time and displacement, drifts, the first crack.

use std::path::Path;

use concio::G;
use concio::outcome::Outcome;
use concio::run::{Control, run, run_in_memory};
use concio_verified::agrees;
use serde_json::Value;

use crate::common::ready::ready;

fn close(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{found} instead of {expected}");
}

fn ran(text: &str) -> Outcome {
    run_in_memory(&ready(text)).expect("a run")
}

/// The summary of a run into a folder.
fn summary(text: &str) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let prepared = ready(text);
    run(&prepared, folder.path(), &mut |_| Control::Continue).expect("a run");
    let text = std::fs::read_to_string(folder.path().join("summary.json")).expect("a summary");
    serde_json::from_str(&text).expect("JSON")
}

/// A stone of 1 m × 1 m and this height [m] on a flat joint, pushed without inertia by a base acceleration that grows by 0.1 g in a
/// second. Its joint counts for two half bricks: it is twice as stiff as the file says.
fn pushed(height: f64, joint: &str, duration: f64) -> String {
    format!(
        r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = {{ length = 1, height = {height}, thickness = 1, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
damping_ratio = 0
head = {{ law = "none" }}
{joint}
[motion]
base = {{ tilt = {{ acceleration = {}, rise = 10 }} }}
duration = {duration}
quasi_static = true
"#,
        G
    )
}

/// Under a stone of 400 N, so flat that it presses evenly, the base shear is the load until it slides at μ W = 160 N, and that from
/// t = 4 s on; until then it stands on its springs, at F/k_s.
#[test]
fn a_stone_that_slides_has_borne_what_friction_does_when_it_began_to() {
    let joint = r#"bed = { law = "no-tension", stiffness = "5e6 N/m", normal_to_shear = 2.4, rigidity = 1 }
friction = { law = "coulomb", static = 0.4, dynamic = 0.4 }"#;
    let outcome = ran(&pushed(0.02, joint, 4.5));
    let totals = &outcome.totals;
    agrees!("Sliding: flat stone pushed slowly, peak base shear", "μ W", "N", totals.base_shear_peak, 160.0, 1e-5);
    // A step is 20 ms; of the shear that lasts the beginning is told, not what rounding makes the largest.
    assert!((totals.base_shear_time - 4.0).abs() <= 0.021, "{} s", totals.base_shear_time);
    close(-totals.base_shear_displacement, 160.0 / 1e7, 0.03);
}

/// On springs that hold in both directions the end is the peak, and what is left of it without inertia: shear and turning add up,
/// x = F/k_s + F (h/2)²/(k_n L²/12 − W h/2), of which the second part is that of the centre.
#[test]
fn without_inertia_the_residual_is_the_end() {
    let joint = r#"bed = { law = "elastic", stiffness = "5e6 N/m", normal_to_shear = 2.4 }
friction = { law = "none" }"#;
    let outcome = ran(&pushed(0.5, joint, 2.0));
    let (weight, arm) = (1e4, 0.25);
    let force = 0.2 * weight;
    let leans = force / 1e7 + force * arm * arm / (2.4e7 / 12.0 - weight * arm);
    assert_eq!(outcome.drifts.len(), 1);
    let drift = &outcome.drifts[0];
    assert_eq!((drift.top.as_str(), drift.height, drift.swing), ("p1", arm, 0.0));
    let against = "F/k_s + F (h/2)²/(k_n L²/12 − W h/2)";
    agrees!("Springs: stone pushed slowly, drift", against, "m", -drift.peak, leans, 1e-3);
    assert_eq!((drift.residual, drift.time), (drift.peak, 2.0));
    close(outcome.totals.base_shear_peak, force, 1e-5);
    assert!((outcome.totals.base_shear_time - 2.0).abs() < 0.021);
}

/// Two piers of one brick each that nothing joins, one on springs three times as soft: it leans three times as far, and is named.
/// The base accelerates slowly, so that each follows m a/k; in the last tenth it stands still there.
#[test]
fn of_free_standing_panels_the_one_that_leans_most_is_told() {
    let text = format!(
        r#"
model = "shear"
[[panel]]
name = "stiff"
bond = "stack"
courses = 1
bricks = 1
brick = {{ length = 0.5, height = 0.5, thickness = 1, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[[panel]]
name = "soft"
bond = "stack"
courses = 1
bricks = 1
brick = {{ length = 0.5, height = 0.5, thickness = 1, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
damping_ratio = 0.3
bed = {{ law = "elastic", stiffness = "3e6 N/m" }}
head = {{ law = "none" }}
friction = {{ law = "none" }}
[[joint.change]]
at = {{ kind = ["connection"] }}
spring = {{ law = "none" }}
[[joint.change]]
at = {{ kind = ["base"], panel = ["soft"] }}
spring = {{ stiffness_factor = {} }}
[motion]
base = {{ tilt = {{ acceleration = 1, rise = 2 }} }}
duration = 4
"#,
        1.0 / 3.0
    );
    let outcome = ran(&text);
    // w = 2 ℓ/L_ref of the support.
    let at_rest = 5e3 / G / (2.0 * 1e6);
    let worst = outcome.worst_drift().expect("a drift");
    assert_eq!((worst.top.as_str(), worst.height), ("soft", 0.25));
    agrees!(
        "Springs: soft pier on a base that accelerates slowly, drift",
        "m a/k",
        "m",
        -worst.residual,
        at_rest,
        1e-3
    );
    close(-worst.peak, at_rest, 0.05);
    assert!(worst.swing < 1e-2 * at_rest, "{} m", worst.swing);
    close(outcome.drifts[0].residual, worst.residual / 3.0, 1e-3);
    let told = summary(&text);
    assert_eq!(told["drift"]["top"], "soft");
    close(told["drift"]["residual"].as_f64().expect("a number"), worst.residual / 0.25, 1e-12);
    close(told["base_shear_peak"].as_f64().expect("a number"), 1e4 / G, 0.05);
}

/// A brick that mortar of 0.1 MPa holds to the base, which accelerates slowly: it cracks where m a is c A, at c A/m.
#[test]
fn the_first_crack_tells_what_the_base_did() {
    let text = |motion: &str, beam: &str| {
        format!(
            r#"
model = "shear"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = {{ length = 0.25, height = 0.5, thickness = 0.12, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
damping_ratio = 0.5
bed = {{ law = "elastic", stiffness = "5e7 N/m" }}
head = {{ law = "none" }}
friction = {{ law = "stribeck", static = 0.6, dynamic = 0.42, slip_velocity = "1 mm/s" }}
[joint.bond]
tensile_strength = "0.1 MPa"
cohesion = "0.1 MPa"
friction_angle = 0
mode_1_energy = "5 N/m"
mode_2_energy = "5000 N/m"
{beam}
[motion]
{motion}
"#
        )
    };
    let (mass, strength) = (0.25 * 0.5 * 0.12 * 20e3 / G, 1e5 * 0.25 * 0.12);
    let grows = "base = { tilt = { acceleration = 120, rise = 12 } }\nduration = 12";
    let told = summary(&text(grows, ""));
    let bonds = &told["bonds"];
    let number = |key: &str| bonds[key].as_f64().unwrap_or_else(|| panic!("{key}: {bonds}"));
    let (found, expected) = (number("first_acceleration"), strength / mass);
    agrees!("Bonds: brick on mortar, base acceleration of the first crack", "c A/m", "m/s²", found, expected, 0.01);
    let found = number("first_crack");
    agrees!("Bonds: brick on mortar, instant of the first crack", "c A/m", "s", found, expected / 10.0, 0.01);
    assert!(
        bonds["first_joint"].as_str().is_some_and(|joint| joint.starts_with("base|")) && bonds["first_beam"].is_null(),
        "{bonds}"
    );
    // A beam that is driven over a base at rest: what it has moved by is told.
    let driven = "top = { path = { displacements = [0.02], speed = \"1 mm/s\" } }\nduration = 1";
    let told = summary(&text(driven, "[load]\ntop = \"1 kN/m\"\nbeam = \"driven\""));
    let bonds = &told["bonds"];
    let [time, beam] =
        ["first_crack", "first_beam"].map(|key| bonds[key].as_f64().unwrap_or_else(|| panic!("{key}: {bonds}")));
    let subject = "Bonds: brick under a driven beam, way of the beam at the first crack";
    agrees!(subject, "speed and time", "m", beam, 1e-3 * time, 1e-6);
    assert_eq!(bonds["first_acceleration"], 0.0);
    assert_eq!(told["drift"]["top"], "beam");
}

/// Nothing moves: all that is told is 0, and no zero has a sign.
#[test]
fn a_wall_at_rest_has_zeros_without_signs() {
    for model in ["shear", "planar"] {
        let text = format!(
            r#"
model = "{model}"
[[panel]]
bond = "running"
courses = 3
bricks = 2
brick = {{ length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18e3 }}
mortar = {{ bed = 0.01, head = 0.01 }}
[joint]
bed = {{ law = "elastic", stiffness = "5.4e7 N/m" }}
head = {{ law = "no-tension", stiffness = "5.4e7 N/m" }}
friction = {{ law = "coulomb", static = 0.6, dynamic = 0.6 }}
[motion]
duration = 0.1
"#
        );
        let told = summary(&text);
        let text = serde_json::to_string(&told).expect("JSON");
        assert!(!text.contains("-0.0"), "{text}");
        assert_eq!(
            (&told["drift"]["residual"], &told["drift"]["time"]),
            (&Value::from(0.0), &Value::from(0.0)),
            "{model}"
        );
        assert!(told["base_shear_peak"].as_f64().is_some_and(|shear| shear < 1e-6), "{model}: {told}");
        assert!(told["bonds"].is_null() && told["collapse"].is_null());
        let slide = &told["slide"];
        assert_eq!(slide.is_null(), model == "planar", "{slide}");
    }
}

/// Of a wall that falls, peaks are those until then, and nothing is left to lean; the same of a run that is cut short.
#[test]
fn a_wall_that_falls_and_a_run_that_is_stopped_have_no_residual() {
    let text = r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = 0.2, height = 1.0, thickness = 0.5, specific_weight = 20e3 }
mortar = { bed = 0, head = 0 }
[joint]
bed = { law = "rigid" }
head = { law = "none" }
friction = { law = "coulomb", static = 0.8, dynamic = 0.8 }
[motion]
duration = 2
base = { tilt = { acceleration = 3, rise = 0.01 } }
"#;
    let outcome = ran(text);
    let collapse = outcome.totals.collapse.expect("it falls");
    let drift = outcome.worst_drift().expect("a drift");
    assert!(drift.time <= collapse.time && drift.residual == f64::INFINITY, "{drift:?}");
    // Half its height times sin 45°, and what its toe is away from its middle.
    close(drift.peak.abs(), 0.5 * 0.5f64.sqrt() + 0.1 - 0.1 * 0.5f64.sqrt(), 0.05);
    let told = summary(text);
    assert!(told["drift"]["residual"].is_null() && told["drift"]["swing"].is_null());
    let folder = tempfile::tempdir().expect("a folder");
    let mut looks = 0;
    let prepared =
        ready(&text.replace("duration = 2", "duration = 500").replace("acceleration = 3", "acceleration = 0.1"));
    let stopped = run(&prepared, folder.path(), &mut |_| {
        looks += 1;
        if looks > 1 { Control::Stop } else { Control::Continue }
    });
    let outcome = stopped.expect("a run").outcome;
    assert!(outcome.time_reached < 500.0 && outcome.drifts[0].residual == f64::INFINITY);
    assert!(Path::new(folder.path()).join("result.h5").exists());
}
