//! One wall file, three panels: aspect ratio and load on top decide how they fail.

use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::failure::{Failure, Mode, failure};
use concio::run::{prepare_case, run_in_memory};
use concio_verified::agrees;

const PANEL: &str = include_str!("../../../../examples/16-shear-panel.toml");

fn pushed(bricks: usize, courses: usize, load: f64) -> Failure {
    let mut file = from_str(PANEL, Syntax::Toml, None).expect("the example");
    let panel = &mut file.case.panels[0];
    (panel.bricks, panel.courses) = (Some(bricks), Some(courses));
    file.case.load.top = load.into();
    let prepared = prepare_case(file.case, Path::new(".")).expect("a wall");
    let outcome = run_in_memory(&prepared).expect("a run");
    failure(&prepared.model.wall, &prepared.model.joints, &outcome.recording).expect("frames")
}

#[test]
fn panels_rock_crack_or_slide() {
    let slender = pushed(4, 16, 50e3);
    assert_eq!(slender.modes, [Mode::Rocking], "{slender:?}");
    assert!(slender.rocking > 0.8, "{slender:?}");
    let square = pushed(6, 10, 150e3);
    assert_eq!(square.modes, [Mode::Diagonal], "{square:?}");
    let squat = pushed(12, 4, 10e3);
    assert_eq!(squat.modes, [Mode::Sliding], "{squat:?}");
    assert!(squat.sliding > 0.8, "{squat:?}");
}

/// The low wall of Ispra (Anthoine, Magonette and Magenes 1995) under a slow push: a stepped crack through six of its thirteen courses.
#[test]
fn a_crack_from_edge_to_edge_has_a_name() {
    let file = from_str(
        r#"
model = "planar"
[[panel]]
bond = "running"
courses = 13
bricks = 4
brick = { length = "242.5 mm", height = "55 mm", thickness = "250 mm", specific_weight = "20.7 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[joint]
bed = { law = "elastic", stiffness = "11.5 N/mm3" }
head = { law = "elastic", stiffness = "27.7 N/mm3" }
friction = { law = "coulomb", static = 0.577, dynamic = 0.577, on = "all" }
[joint.bond]
tensile_strength = "0.1 MPa"
cohesion = "0.23 MPa"
friction_angle = "30 deg"
mode_1_energy = "10 N/m"
mode_2_energy = "50 N/m"
[[joint.change]]
at = { kind = ["base", "top"] }
bond = { tensile_strength = "0.1 MPa", cohesion = "5 MPa", mode_2_energy = "0 N/m" }
friction = { static = 2, dynamic = 2 }
[load]
top = "154.639175 kN/m"
beam = "driven"
beam_rotation = "fixed"
[motion]
top = { path = { displacements = ["5 mm"], speed = "1 mm/s" } }
duration = "5 s"
quasi_static = true
"#,
        Syntax::Toml,
        None,
    )
    .expect("a wall file");
    let prepared = prepare_case(file.case, Path::new(".")).expect("a wall");
    let outcome = run_in_memory(&prepared).expect("a run");
    let found = failure(&prepared.model.wall, &prepared.model.joints, &outcome.recording).expect("frames");
    assert_eq!(found.modes, [Mode::Diagonal], "{found:?}");
    println!("peak {:.1} kN, {found:?}", 1e-3 * outcome.totals.base_shear_peak);
}

const ISPRA: [(&str, f64, Mode); 2] = [
    (include_str!("../../../../examples/laboratory/ispra-low.toml"), 84e3, Mode::Sliding),
    (include_str!("../../../../examples/laboratory/ispra-high.toml"), 72e3, Mode::Rocking),
];

/// The walls of Ispra within 10 % of the largest forces that were measured (Anthoine, Magonette and Magenes 1995): the high one rocks, the low one parts
/// along its joints.
#[test]
fn the_walls_of_ispra_bear_what_they_bore_in_the_laboratory() {
    for (text, measured, mode) in ISPRA {
        let file = from_str(text, Syntax::Toml, None).expect("the example");
        let prepared = prepare_case(file.case, Path::new(".")).expect("a wall");
        let outcome = run_in_memory(&prepared).expect("a run");
        let found = failure(&prepared.model.wall, &prepared.model.joints, &outcome.recording).expect("frames");
        let peak = outcome.totals.base_shear_peak;
        let name = if mode == Mode::Rocking { "high" } else { "low" };
        let subject = format!("Laboratory: {name} wall of Ispra, peak force");
        agrees!(subject, "measured (Anthoine, Magonette and Magenes 1995)", "N", peak, measured, 0.1);
        assert!(found.modes.contains(&mode), "{found:?}");
    }
}
