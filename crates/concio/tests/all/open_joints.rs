//! Joints of law `none` in planar walls: nothing acts across or along them, and their sides meet where they come to touch.

use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::planar::Rest;
use concio::run::{Prepared, prepare_case};
use concio_verified::agrees;

use crate::common::ready::{close, ran, ready};

const JOINTS: &str = r#"
[joint]
bed = { law = "rigid" }
head = { law = "HEAD" }
connection = { law = "none" }
friction = { law = "coulomb", static = 0.7, dynamic = 0.7, on = "all" }
[motion]
base = { tilt = { acceleration = "-0.4 g", rise = "8 s" } }
duration = "8 s"
quasi_static = true
[output]
blocks = ["all"]
"#;

/// A pier of 0.5 m × 2 m, `courses` high, and `gap` beside it a wall of 3 m × 2 m.
fn beside(courses: usize, gap: f64) -> String {
    let panel = |bricks: usize, length: f64, rest: &str| {
        format!(
            "[[panel]]\nbond = \"running\"\ncourses = {courses}\nbricks = {bricks}\n{rest}\
             brick = {{ length = {length}, height = {}, thickness = 0.3, specific_weight = 20e3 }}\nmortar = {{ bed = 0, head = 0 }}\n",
            2.0 / courses as f64
        )
    };
    let pier = panel(1, 0.5, "").replace("running", "stack");
    let wall = if courses == 1 { panel(1, 3.0, "") } else { panel(6, 0.5, "") };
    format!("model = \"planar\"\n{pier}{wall}connection = {gap}\n{}", JOINTS.replace("HEAD", "rigid"))
}

/// The pier turns about its foot until its top has closed the gap: h sin θ = gap, its middle b/2 (1 − cos θ) + h/2 sin θ away.
#[test]
fn a_pier_turns_over_alone_until_it_leans_on_its_neighbour() {
    for gap in [0.03, 0.3] {
        let (_, outcome) = ran(&beside(1, gap));
        let sine: f64 = gap / 2.0;
        let middle = 0.25 * (1.0 - sine.asin().cos()) + sine;
        let path = outcome.history("block/p1c1b1/displacement").expect("a history");
        let most = path.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let subject = format!("Springs: pier beside an open joint, way until it leans on its neighbour; {gap} m");
        agrees!(subject, "b/2 (1 − cos θ) + h/2 sin θ, h sin θ = gap", "m", most, middle, 1e-3);
        // Alone it bears a quarter of its weight; what the wall beside it bears is friction, 0.4 of its own.
        assert!(outcome.totals.minimum_gap > -1e-6, "{}", outcome.totals.minimum_gap);
    }
}

/// Blocks of other courses do not hold it either, across whichever gap.
#[test]
fn courses_beside_each_other_do_not_touch_across_an_open_joint() {
    for gap in [0.03, 0.3] {
        let text = beside(8, gap).replace("\"8 s\"", "\"5.5 s\"").replace("rise = \"5.5 s\"", "rise = \"8 s\"");
        let (prepared, outcome) = ran(&text);
        // By 0.275 g the pier has left its foot; a wall that held it would have kept it where it was.
        let pier = prepared.model.wall.blocks.iter().position(|b| b.name == "p1c8b1").expect("the top of the pier");
        let gone = outcome.envelopes.block_displacement[pier];
        assert!(gone > 5e-3, "{gone} m at a gap of {gap} m");
        let wall = prepared.model.wall.blocks.iter().position(|b| b.name == "p2c8b1").expect("the top of the wall");
        assert!(outcome.envelopes.block_displacement[wall] < 1e-6);
    }
}

/// The same stones as polygons, and as rectangles with an open head joint between them.
#[test]
fn polygons_and_rectangles_agree() {
    let stones = |second: &str| {
        format!(
            r#"
model = "planar"
[[panel]]
bond = "explicit"
brick = {{ length = 0.5, height = 2, thickness = 0.3, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0.03 }}
block = [{{ id = "pier", course = 1, x = 0, y = 0, length = 0.5, height = 2 }}, {second}]
{}"#,
            JOINTS.replace("HEAD", "none")
        )
    };
    let found = [
        r#"{ course = 1, x = 0.53, y = 0, length = 3, height = 2 }"#,
        r#"{ course = 1, corners = [[0.53, 0], [3.53, 0], [3.53, 1.9], [3.43, 2], [0.53, 2]] }"#,
    ]
    .map(|second| {
        let (prepared, outcome) = ran(&stones(second));
        assert_eq!(prepared.model.joints.len(), 3);
        outcome.history("block/pier/displacement").expect("a history").into_iter().fold(0.0, f64::max)
    });
    let sine: f64 = 0.015;
    let middle = 0.25 * (1.0 - sine.asin().cos()) + sine;
    for (found, shape) in found.into_iter().zip(["rectangle", "polygon"]) {
        let subject = format!("Springs: pier and its neighbour, way until they touch; {shape}");
        agrees!(subject, "b/2 (1 − cos θ) + h/2 sin θ, h sin θ = gap", "m", found, middle, 1e-3);
    }
}

fn courses(bed: &str, base: &str, mortar: f64) -> String {
    format!(
        r#"
model = "planar"
[[panel]]
bond = "running"
courses = 3
bricks = 2
brick = {{ length = 0.4, height = 0.2, thickness = 0.3, specific_weight = 20e3 }}
mortar = {{ bed = {mortar}, head = {mortar} }}
[joint]
bed = {{ {bed} }}
base = {{ {base} }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 0.6, dynamic = 0.6, on = "all" }}
[motion]
duration = 0.1
"#
    )
}

/// What lies over an open bed joint sinks by its thickness, course by course, and then lies.
#[test]
fn courses_sink_through_open_bed_joints() {
    let rigid = r#"law = "rigid""#;
    let none = r#"law = "none""#;
    for (bed, base, settled) in [(none, rigid, 0.02), (rigid, none, 0.01), (none, none, 0.03), (rigid, rigid, 0.0)] {
        let Rest::Stands { settled: found, .. } = ready(&courses(bed, base, 0.01)).model.planar().unwrap().rest()
        else {
            panic!("{bed}, {base}: it stands")
        };
        let law = |text: &str| if text == none { "open" } else { "rigid" };
        let subject =
            format!("Springs: three courses on open joints, way they sink; bed {}, base {}", law(bed), law(base));
        agrees!(subject, "thickness of the open joints", "m", found, settled, abs: 1e-6);
    }
}

/// Of one course some joints are open and some are not: bricks reach to the middle of their mortar, and the open ones stay as open as they are laid.
#[test]
fn an_open_joint_beside_a_filled_one_is_as_far_open_as_it_is_laid() {
    let text = format!(
        "{}[[joint.change]]\nat = {{ joints = [\"p1c1b2|p1c2b2\"] }}\nspring = {{ law = \"none\" }}\n",
        courses(r#"law = "rigid""#, r#"law = "rigid""#, 0.01)
    );
    let model = ready(&text).model;
    let planar = model.planar().unwrap();
    let names = model.joint_names();
    let open: Vec<&String> = names.iter().zip(&planar.open).filter(|(_, open)| **open).map(|(name, _)| name).collect();
    let heads = |name: &&&String| name.contains("c1b1|p1c1") || name.contains("c2b") || name.contains("c3b1|p1c3");
    assert!(open.iter().all(|name| heads(&name)), "{open:?}");
    let at = names.iter().position(|name| name == "p1c1b2|p1c2b2").expect("the joint");
    close(planar.system.links[at].apart, 0.01, 1e-9);
    // The brick over it lies on the joint beside it, held down by the bricks on it.
    assert!(matches!(planar.rest(), Rest::Stands { settled, .. } if settled < 1e-7), "{:?}", planar.rest());
}

/// Open joints have neither friction nor bond, whatever is said of the wall's, and results say so.
#[test]
fn an_open_joint_has_no_law_of_any_kind() {
    let text = courses(r#"law = "elastic", stiffness = "10 N/mm3""#, r#"law = "rigid""#, 0.01)
        .replace("[motion]", "bond = { tensile_strength = \"0.1 MPa\", cohesion = \"0.1 MPa\" }\n[motion]");
    let prepared = ready(&text);
    let rows = concio::run::joint_rows(&prepared.model);
    let heads: Vec<_> = rows.iter().filter(|row| row.joint.kind.is_upright()).collect();
    assert_eq!(heads.len(), 4);
    for row in heads {
        assert_eq!((row.law, row.friction), (concio::case::SpringLaw::None, None));
    }
    let bonded = prepared.model.shear.bond_of_joint();
    assert!(rows.iter().zip(bonded).all(|(row, bond)| row.joint.kind.is_upright() == bond.is_none()));
}

/// Springs that are none would let blocks through each other.
#[test]
fn springs_without_stiffness_are_refused() {
    let refused = |text: &str| {
        let file = from_str(text, Syntax::Toml, None).expect("a wall file");
        prepare_case(file.case, Path::new(".")).expect_err("no stiffness").to_string()
    };
    let bed = courses(r#"law = "elastic", stiffness = "0 N/m""#, r#"law = "rigid""#, 0.0);
    assert!(refused(&bed).contains("joint.bed: a joint without stiffness"), "{}", refused(&bed));
    let rigid = courses(r#"law = "rigid""#, r#"law = "rigid""#, 0.0);
    let change = "[[joint.change]]\nat = { kind = [\"head\"] }\nspring = { law = \"no-tension\", stiffness = \"1 N/mm3\", stiffness_factor = 0 }\n";
    let told = refused(&format!("{rigid}{change}"));
    assert!(told.contains("joint.change[0].spring") && told.contains("law = \"none\""), "{told}");
}

/// Three piers under a lintel, the middle one 45 mm short: nothing touches there, but blocks given one by one are joined over as much, so it is
/// told. As a joint of law `none` it bears nothing; the outer ones bear half of the lintel each.
#[test]
fn a_thick_joint_is_told_and_bears_nothing_as_an_open_one() {
    let block = |id: &str, course: usize, x: f64, y: f64, length: f64, height: f64| {
        format!(
            "[[panel.block]]\nid = \"{id}\"\ncourse = {course}\nx = {x}\ny = {y}\nlength = {length}\nheight = {height}\n"
        )
    };
    let wall = |rest: &str| {
        let blocks = [
            block("a", 1, 0.0, 0.0, 0.3, 0.5),
            block("b", 1, 1.0, 0.0, 0.3, 0.455),
            block("c", 1, 2.0, 0.0, 0.3, 0.5),
            block("lintel", 2, 0.0, 0.5, 2.3, 0.3),
        ];
        format!(
            "model = \"planar\"\n[[panel]]\nbond = \"explicit\"\n\
             brick = {{ length = 0.3, height = 0.5, thickness = 0.4, specific_weight = 20e3 }}\nmortar = {{ bed = 0, head = 0 }}\n\
             {}[joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
             friction = {{ law = \"coulomb\", static = 0.6 }}\n{rest}[motion]\nduration = 0.1\n",
            blocks.concat()
        )
    };
    let warned =
        |prepared: &Prepared| -> Vec<String> { prepared.model.warnings.iter().map(|w| w.text.clone()).collect() };
    let told = warned(&ready(&wall("")));
    assert!(told.len() == 1 && told[0].starts_with("joint b|lintel is 0.045 m thick, its mortar 0 m"), "{told:?}");
    let (open, outcome) =
        ran(&wall("[[joint.change]]\nat = { joints = [\"b|lintel\"] }\nspring = { law = \"none\" }\n"));
    assert_eq!(warned(&open), Vec::<String>::new());
    let pressure = |name: &str| {
        let joint = open.model.joint_names().iter().position(|n| n == name).expect("a joint");
        outcome.recording.frame_pressure[joint]
    };
    let lintel = 2.3 * 0.3 * 0.4 * 20e3;
    assert_eq!(pressure("b|lintel"), 0.0);
    for name in ["a|lintel", "c|lintel"] {
        let subject =
            format!("Walls and loads: lintel over an open joint, what it presses with; {}", name.replace('|', " and "));
        agrees!(subject, "W/2", "N", pressure(name), 0.5 * lintel, 1e-6);
    }
}
