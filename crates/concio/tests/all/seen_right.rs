//! Walls that were once read, loaded or told of wrongly, each by what comes out of it.

use concio::run::Prepared;
use concio_verified::agrees;

use crate::common::ready::{channel, ran, ready};

/// The place of a joint by its name.
fn joint(prepared: &Prepared, name: &str) -> usize {
    let names = prepared.model.joint_names();
    names.iter().position(|n| n == name).unwrap_or_else(|| panic!("{name}: {names:?}"))
}

/// A change that names a course changes what rubs there, and lets nothing rub that did not.
#[test]
fn a_change_of_a_course_lets_no_head_joint_rub() {
    let prepared = ready(
        r#"
model = "planar"
[[panel]]
bond = "running"
courses = 3
bricks = 2
brick = { length = "250 mm", height = "60 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = 0, head = 0 }
[joint]
bed = { law = "no-tension", rigidity = 1, stiffness = "5e7 N/m" }
head = { law = "no-tension", rigidity = 1, stiffness = "5e7 N/m" }
friction = { law = "coulomb", static = 0.6, dynamic = 0.6, on = "bed" }
[[joint.change]]
at = { course = [2] }
friction = { static = 0.4, dynamic = 0.4 }
[motion]
duration = "10 ms"
base = { sine = { acceleration = "0.1 g", frequency = "5 Hz" } }
"#,
    );
    let links = &prepared.model.planar().expect("a planar wall").system.links;
    let mut found = [0; 3];
    for (own, link) in prepared.model.joints.iter().zip(links) {
        match link.law.friction.map(|friction| friction.static_) {
            None => {
                assert!(own.kind.is_upright());
                found[0] += 1;
            }
            Some(mu) => {
                assert!(!own.kind.is_upright() && [0.4, 0.6].contains(&mu), "{mu}");
                found[if mu == 0.4 { 1 } else { 2 }] += 1;
            }
        }
    }
    // A course of two and one of three pieces: head joints, bed joints of course 2, all others.
    assert!(found.iter().all(|n| *n > 0), "{found:?}");
}

/// The head joints of a lintel that lies in one course are of that course, on both sides.
#[test]
fn head_joints_of_a_lintel_are_of_its_course() {
    let prepared = ready(
        r#"
model = "shear"
[[panel]]
bond = "stack"
courses = 4
bricks = 5
brick = { length = "250 mm", height = "60 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = 0, head = 0 }
[[panel.opening]]
x = 0.5
y = 0
width = 0.25
height = 0.06
lintel = { height = 0.12, bearing = 0.1 }
[joint]
bed = { law = "elastic", stiffness = "5e7 N/m" }
head = { law = "elastic", stiffness = "5e7 N/m" }
[[joint.change]]
at = { kind = ["head"], course = [2] }
spring = { stiffness = "1e7 N/m" }
[motion]
duration = "10 ms"
base = { sine = { acceleration = "0.1 g", frequency = "5 Hz" } }
"#,
    );
    let names = prepared.model.joint_names();
    let heads = prepared.model.joints.iter().zip(&prepared.model.shear.elastic).zip(&names);
    let of_lintel = heads.filter(|((own, _), name)| own.kind.is_upright() && name.contains("p1o1"));
    let mut stiffness: Vec<f64> = of_lintel.map(|((_, law), _)| law.stiffness).collect();
    stiffness.sort_by(f64::total_cmp);
    // Two in course 2, which the change names, and two in course 3.
    assert_eq!(stiffness, [1e7, 1e7, 5e7, 5e7]);
}

/// A sloping block bears the load over its upper edge, with a beam on it and without.
#[test]
fn a_sloping_block_bears_the_load_on_its_upper_edge() {
    for beam in ["", "beam = \"tied\"\n"] {
        let prepared = ready(&format!(
            r#"
model = "planar"
[[panel]]
bond = "explicit"
brick = {{ length = "0.6 m", height = "0.2 m", thickness = "0.12 m", specific_weight = "18 kN/m3" }}
mortar = {{ bed = 0, head = 0 }}
block = [ {{ course = 1, corners = [[0, 0], [0.6, 0], [0.5, 0.2], [0.1, 0.2]] }} ]
[joint]
bed = {{ law = "elastic", stiffness = "5e7 N/m" }}
head = {{ law = "elastic", stiffness = "5e7 N/m" }}
[load]
top = "10 kN/m"
{beam}[motion]
duration = "10 ms"
base = {{ sine = {{ acceleration = "0.01 g", frequency = "5 Hz" }} }}
"#
        ));
        // 0.1 m² of 0.12 m: 216 N; 10 kN/m on 0.6 m.
        let what = format!(
            "Walls and loads: sloping block, what the base bears{}",
            if beam.is_empty() { "" } else { "; tied beam" }
        );
        agrees!(what, "weight and load by hand", "N", prepared.model.base_load(), 216.0 + 6000.0, 1e-9);
    }
}

/// A beam that is held pushes from the first sample on, and base and beam are in balance.
#[test]
fn the_force_of_a_held_beam_is_known_from_the_first_sample_on() {
    let (_, outcome) = ran(r#"
model = "planar"
[[panel]]
bond = "explicit"
brick = { length = "0.4 m", height = "0.3 m", thickness = "0.12 m", specific_weight = "18 kN/m3" }
mortar = { bed = 0, head = 0 }
block = [
  { course = 1, x = 0,   y = 0,   length = 0.4, height = 0.3 },
  { course = 2, x = 0.1, y = 0.3, length = 0.4, height = 0.3 },
]
[joint]
bed = { law = "elastic", stiffness = "10 N/mm3" }
head = { law = "elastic", stiffness = "10 N/mm3" }
[load]
top = "100 kN/m"
beam = "tied"
[motion]
duration = "20 ms"
[output]
interval = "1 ms"
frames = "1 ms"
"#);
    let [top, base] = ["top/force", "base/shear"].map(|name| channel(&outcome, name));
    assert!(top[0].abs() > 4e3, "{top:?}");
    assert!(top.iter().zip(&base).all(|(top, base)| (top + base).abs() < 1e-6 * top.abs()), "{top:?} {base:?}");
    assert!(top.iter().all(|force| (force / top[0] - 1.0).abs() < 1e-6), "{top:?}");
}

/// The springs that a crack leaves act in a planar wall, and the account counts what they do.
#[test]
fn springs_that_a_crack_leaves_act() {
    let of = |residual: f64| {
        let (_, outcome) = ran(&format!(
            r#"
model = "planar"
[[panel]]
bond = "explicit"
brick = {{ length = 0.25, height = 0.5, thickness = 0.25, specific_weight = 18e3 }}
mortar = {{ bed = 0, head = 0 }}
block = [ {{ id = "a", course = 1, x = 0, y = 0, length = 0.25, height = 0.5 }} ]
[joint]
bed = {{ law = "no-tension", stiffness = "15 N/mm3", rigidity = 10 }}
head = {{ law = "rigid" }}
friction = {{ law = "coulomb", static = 0.6, dynamic = 0.6, on = "all" }}
bond = {{ tensile_strength = "0.005 MPa", cohesion = "0.005 MPa", friction_angle = "31 deg", residual_stiffness = {residual} }}
[motion]
duration = 2
base = {{ sine = {{ acceleration = "1.2 g", frequency = "2 Hz" }} }}
"#
        ));
        let largest = outcome.totals.peak_residual / outcome.totals.peak_input;
        assert!(largest < 1e-4 && outcome.energies.elastic < 10.0, "{largest} {:?}", outcome.energies);
        outcome.energies.input()
    };
    let (held, free) = (of(0.2), of(0.0));
    assert!((held / free - 1.0).abs() > 0.05, "{held} J with springs, {free} J without");
}

/// A stone that bears more by μ_s N than its bond did is told with its joint and both forces.
#[test]
fn a_joint_that_rubs_more_than_its_bond_bore_is_told() {
    let (prepared, outcome) = ran(r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = "250 mm", height = "55 mm", thickness = "250 mm", specific_weight = "20 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[joint]
bed = { law = "elastic", stiffness = "11.5 N/mm3"  }
head = { law = "none" }
friction = { law = "coulomb", static = 1.2, dynamic = 1.2 }
bond = { tensile_strength = "0.1 MPa", cohesion = "0.23 MPa", friction_angle = "30 deg", mode_1_energy = "10 N/m", mode_2_energy = "50 N/m" }
[[joint.change]]
at = { kind = ["top"] }
bond = { tensile_strength = "5 MPa", cohesion = "50 MPa", mode_1_energy = 0, mode_2_energy = 0 }
friction = { static = 5, dynamic = 5 }
[load]
top = "150.0 kN/m"
beam = "driven"
beam_rotation = "fixed"
[motion]
top = { path = { displacements = ["2 mm"], speed = "0.1 mm/s" } }
quasi_static = true
"#);
    let rows = concio::run::joint_rows(&prepared.model);
    let told = concio::run::warnings_of(&prepared.model, &rows, &outcome);
    let base = prepared.model.joint_names()[joint(&prepared, "base|p1c1b1")].clone();
    // 1.2 · (37.5 + 0.076) kN, and 0.23 MPa · 0.25 m · 0.25 m + N tan 30°.
    let says = |w: &concio::warning::Warning| w.contains(&base) && w.contains("45.08 kN") && w.contains("36.07 kN");
    assert!(told.iter().any(says), "{told:?}");
}

/// A piece too short to be a brick is named by where it lies.
#[test]
fn a_sliver_is_named_by_its_place() {
    let text = r#"
model = "shear"
[[panel]]
bond = "stack"
courses = 3
bricks = 6
brick = { length = "1 m", height = "0.25 m", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = 0, head = 0 }
[[panel.opening]]
x = 1
y = 0
width = 1
height = 0.25
lintel = { height = 0.25, bearing = 0.2 }
[[panel.opening]]
x = 3.01
y = 0
width = 1
height = 0.25
lintel = { height = 0.25, bearing = 0.2 }
[joint]
bed = { law = "elastic", stiffness = "5e7 N/m" }
head = { law = "elastic", stiffness = "5e7 N/m" }
[motion]
duration = "10 ms"
"#;
    let file = concio::case::from_str(text, concio::case::Syntax::Toml, None).expect("a wall file");
    let told = match file.validate() {
        Err(error) => error.to_string(),
        Ok(_) => {
            concio::run::prepare_case(file.case.clone(), std::path::Path::new("")).expect_err("a sliver").to_string()
        }
    };
    assert!(told.contains("from x = 3 to 4 m in course 1"), "{told}");
}
