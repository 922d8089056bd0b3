//! Doors and windows: what is cut, what the lintel touches, and how the load comes down beside them.

use std::collections::BTreeSet;

use concio::case::{Case, JointKind, NormalForce, Syntax, from_str};
use concio::graph;
use concio::pattern::{self, Jamb, lay};
use concio::wall::{End, Wall};
use proptest::prelude::*;

const REST: &str = r#"
[joint]
bed = { law = "elastic", stiffness = "36 N/mm3" }
head = { law = "no-tension", stiffness = "15 N/mm3" }
friction = { law = "coulomb", static = 0.6, dynamic = 0.6 }
[load]
top = "3 kN/m"
[motion]
duration = 1
"#;

fn case(panel: &str) -> Case {
    let brick = "brick = { length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18e3 }";
    let text = format!("model = \"shear\"\n[[panel]]\n{brick}\n{panel}\n{REST}");
    let file = from_str(&text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}\n{text}"));
    file.validate().unwrap_or_else(|e| panic!("{e}\n{text}"));
    file.case
}

fn wall(panel: &str) -> Wall {
    lay(&case(panel)).unwrap_or_else(|e| panic!("{e}"))
}

/// All that is above the base comes down on it.
fn balance(wall: &Wall) {
    let joints = graph::joints(wall, false);
    let forces = graph::normal_forces(wall, &joints, 3e3, false, NormalForce::Transmitted);
    let base: f64 = joints.iter().zip(&forces).filter(|(j, _)| j.kind == JointKind::Base).map(|(_, n)| n[0]).sum();
    let top = |b: &&concio::wall::Block| b.course + 1 == wall.panels[b.panel].courses;
    let load: f64 = wall.blocks.iter().filter(top).map(|b| 3e3 * b.length()).sum();
    let all = load + wall.blocks.iter().map(|b| b.weight()).sum::<f64>();
    assert!((base / all - 1.0).abs() < 1e-12, "{base} N on the base, {all} N above it");
}

fn named<'w>(wall: &'w Wall, name: &str) -> &'w concio::wall::Block {
    wall.blocks.iter().find(|b| b.name == name).unwrap_or_else(|| panic!("no block {name}"))
}

const DOOR: &str = "bond = \"running\"\ncourses = 8\nbricks = 6\nmortar = { bed = 0.01, head = 0.01 }\n[[panel.opening]]\n\
                    x = 0.5\ny = 0\nwidth = 0.6\nheight = 0.26\nlintel = { height = 0.13, bearing = 0.15 }\n";

/// Courses of 0.065 m: the door takes four of them away, its lintel two.
#[test]
fn a_door_with_a_lintel() {
    let wall = wall(DOOR);
    let lintel = named(&wall, "p1o1");
    let close = |a: [f64; 2], b: [f64; 2]| assert!((0..2).all(|k| (a[k] - b[k]).abs() < 1e-12), "{a:?} {b:?}");
    close(lintel.x, [0.35, 1.25]);
    close(lintel.y, [0.26, 0.39]);
    assert_eq!((lintel.course, lintel.lowest_course()), (5, 4));
    for block in &wall.blocks {
        let row = block.course;
        let zone = match row {
            0..=3 => [0.5, 1.1],
            4 | 5 if block.name != "p1o1" => [0.34, 1.26],
            _ => continue,
        };
        assert!(block.x[1] <= zone[0] + 1e-12 || block.x[0] >= zone[1] - 1e-12, "{} at {:?}", block.name, block.x);
    }
    // Bricks end at 0.25, 0.51, …: the second of the bottom course is cut at the door, the fifth begins there.
    close(named(&wall, "p1c1b2").x, [0.26, 0.5]);
    close(named(&wall, "p1c1b3").x, [1.1, 1.29]);
    let names: BTreeSet<&str> = wall.blocks.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names.len(), wall.blocks.len());

    let joints = graph::joints(&wall, true);
    let number = wall.blocks.iter().position(|b| b.name == "p1o1").expect("a lintel");
    let touches = |kind: JointKind| {
        let mut of: Vec<String> = joints
            .iter()
            .filter(|j| j.kind == kind && (j.a == number || j.b == End::Block(number)))
            .map(|j| graph::name(&wall, j))
            .collect();
        of.sort();
        of
    };
    // It lies on what is left of the course below at either end and has two courses beside it on either side.
    assert_eq!(
        touches(JointKind::Bed).iter().filter(|n| n.ends_with("|p1o1")).count(),
        4,
        "{:?}",
        touches(JointKind::Bed)
    );
    assert_eq!(touches(JointKind::Head), ["p1c5b2|p1o1", "p1c6b2|p1o1", "p1o1|p1c5b3", "p1o1|p1c6b3"]);
    // No joint leads through the door.
    for joint in joints.iter().filter(|j| j.kind == JointKind::Head) {
        let [x, y] = [joint.line[0], 0.5 * (joint.line[1] + joint.line[3])];
        assert!(!(y < 0.26 && (0.5..1.1).contains(&x)), "{}", graph::name(&wall, joint));
    }
    balance(&wall);
}

/// What lies over the door comes down on its two sides, half of it on each if both are alike.
#[test]
fn the_lintel_parts_its_load_by_its_bearings() {
    // Stack bond of 5 bricks of 0.25 m without mortar; the lintel bears on 0.1 m of the outer ones.
    let wall = wall(
        "bond = \"stack\"\ncourses = 4\nbricks = 5\n[[panel.opening]]\nx = 0.25\ny = 0\nwidth = 0.75\nheight = 0.11\n\
         lintel = { height = 0.055, bearing = 0.1, specific_weight = \"25 kN/m3\" }\n",
    );
    assert!((named(&wall, "p1o1").weight() / (25e3 * 0.95 * 0.055 * 0.12) - 1.0).abs() < 1e-12);
    let joints = graph::joints(&wall, false);
    let forces = graph::normal_forces(&wall, &joints, 3e3, false, NormalForce::Transmitted);
    let of = |name: &str| {
        let e = joints.iter().position(|j| graph::name(&wall, j) == name).unwrap_or_else(|| panic!("no joint {name}"));
        forces[e][0]
    };
    // Over the lintel: its weight, three bricks with their loads, and 0.1 m of those that lie on it and the rests beside.
    let column = |length: f64| length * (3e3 + 18e3 * 0.055 * 0.12);
    let on_lintel = column(0.75) + 2.0 * column(0.25) * (0.1 / 0.25);
    let expected = 0.5 * (on_lintel + named(&wall, "p1o1").weight());
    for name in ["p1c2b1|p1o1", "p1c2b2|p1o1"] {
        assert!((of(name) / expected - 1.0).abs() < 1e-12, "{name}: {} N, not {expected} N", of(name));
    }
    balance(&wall);
}

/// A beam over two piers: the lintel is the top of the wall and bears load and beam.
#[test]
fn a_lintel_may_be_the_top_of_the_wall() {
    let wall = wall(
        "bond = \"stack\"\ncourses = 4\nbricks = 5\n[[panel.opening]]\nx = 0.25\ny = 0\nwidth = 0.75\nheight = 0.11\n\
         lintel = { height = 0.11, bearing = 0.25 }\n",
    );
    let names: Vec<&str> = wall.blocks.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names, ["p1c1b1", "p1c1b2", "p1c2b1", "p1c2b2", "p1o1"]);
    let tops: Vec<_> = graph::joints(&wall, true).into_iter().filter(|j| j.kind == JointKind::Top).collect();
    assert_eq!(tops.iter().map(|j| j.overlap).collect::<Vec<_>>(), [1.25]);
    balance(&wall);
}

/// Two lintels of two courses that meet have one joint, panels beside a lintel too.
#[test]
fn lintels_have_one_joint_with_each_neighbour() {
    let panel = "bond = \"stack\"\ncourses = 5\nbricks = 8\n[[panel.opening]]\nx = 0.25\ny = 0\nwidth = 0.5\nheight = 0.055\n\
                 lintel = { height = 0.11, bearing = 0.25 }\n[[panel.opening]]\nx = 1.25\ny = 0\nwidth = 0.5\nheight = 0.055\n\
                 lintel = { height = 0.11, bearing = 0.25 }\n";
    let brick = "brick = { length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18e3 }";
    let wall = wall(&format!(
        "{panel}[[panel]]\n{brick}\nbond = \"stack\"\ncourses = 1\nbricks = 1\n[[panel]]\nbrick = {{ length = 0.25, height = 0.22, thickness = 0.12, specific_weight = 18e3 }}\nbond = \"stack\"\ncourses = 1\nbricks = 1\n"
    ));
    let joints = graph::joints(&wall, false);
    let names: Vec<String> = joints.iter().map(|j| graph::name(&wall, j)).collect();
    assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "{names:?}");
    let between = joints.iter().find(|j| graph::name(&wall, j) == "p1o1|p1o2").expect("lintels that touch");
    assert!((between.overlap - 0.11).abs() < 1e-12);
    balance(&wall);
}

#[test]
fn a_block_may_bridge_a_small_opening() {
    let wall = wall(
        "bond = \"running\"\ncourses = 4\nbricks = 3\n[[panel.opening]]\nx = 0.42\ny = 0.055\nwidth = 0.15\nheight = 0.055\n",
    );
    // The second course: half, whole, whole and half bricks; the opening parts the third of them.
    let second: Vec<[f64; 2]> = wall.blocks.iter().filter(|b| b.course == 1).map(|b| b.x).collect();
    assert_eq!(second.len(), 5);
    for (x, expected) in second.iter().zip([[0.0, 0.125], [0.125, 0.375], [0.375, 0.42], [0.57, 0.625], [0.625, 0.75]])
    {
        assert!((0..2).all(|k| (x[k] - expected[k]).abs() < 1e-12), "{second:?}");
    }
    balance(&wall);
}

/// Heights of a random texture are not known beforehand: the message names them, to be copied.
#[test]
fn the_heights_in_a_message_are_allowed() {
    let panel = |y: f64, height: f64| {
        format!(
            "bond = \"irregular\"\ncourses = 8\nmortar = {{ bed = 0.01, head = 0.01 }}\n\
             random = {{ seed = 4, width = 1.5, length = [0.12, 0.3], height = [0.05, 0.09], stagger = 0.02 }}\n\
             [[panel.opening]]\nx = 0.5\ny = {y}\nwidth = 0.4\nheight = {height}\nlintel = {{ height = 5.0, bearing = 0.2 }}\n"
        )
    };
    let refused = |text: &str| match lay(&case(text)) {
        Err(concio::Error::Input(e)) => *e,
        other => panic!("{other:?}"),
    };
    let last = |e: &concio::InputError| -> f64 {
        let allowed = e.allowed.clone().unwrap_or_default();
        let first = allowed.split(' ').next().unwrap_or_default();
        first.parse().unwrap_or_else(|_| panic!("{e}"))
    };
    let e = refused(&panel(0.1234, 0.1));
    assert_eq!(e.key.as_deref(), Some("panel[0].opening[0].y"), "{e}");
    let y = last(&e);
    let e = refused(&panel(y, 0.2));
    assert_eq!(e.key.as_deref(), Some("panel[0].opening[0].height"), "{e}");
    let height = last(&e);
    let e = refused(&panel(y, height));
    assert_eq!(e.key.as_deref(), Some("panel[0].opening[0].lintel.height"), "{e}");
    let text = panel(y, height).replace("height = 5.0", &format!("height = {}", last(&e)));
    balance(&wall(&text));
}

/// Wherever a lintel ends, bricks of both its courses lie beside it at a head joint; none is shorter than a rest may be, or longer than a brick by more
/// than two joints.
#[test]
fn a_lintel_has_its_head_joints_wherever_it_ends() {
    for step in 0..=270 {
        let x = 0.4 + 1e-3 * step as f64;
        let text = DOOR.replace("x = 0.5\n", &format!("x = {x:.3}\n"));
        let wall = wall(&text);
        let beside: Vec<_> = graph::joints(&wall, true)
            .into_iter()
            .filter(|j| j.kind == JointKind::Head && graph::name(&wall, j).contains("p1o1"))
            .collect();
        assert_eq!(beside.len(), 4, "x = {x:.3}");
        assert!(wall.blocks.iter().all(|b| b.name == "p1o1" || b.length() <= 0.25 + 2.0 * 0.01 + 1e-9), "x = {x:.3}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, ..ProptestConfig::default() })]

    /// Wherever openings may be: nothing lies in them or through each other, names are unique, and the load comes down.
    #[test]
    fn openings_of_all_bonds(
        bond in 0usize..3,
        x in 0.0f64..1.2,
        width in 0.1f64..0.9,
        from in 0usize..5,
        rows in 1usize..4,
        lintel in 1usize..3,
        bearing in 0.05f64..0.3,
        mortar in prop_oneof![Just(0.0), Just(0.01)],
    ) {
        let bond = [
            "bond = \"running\"\nbricks = 8",
            "bond = \"stack\"\nbricks = 8",
            "bond = \"irregular\"\nrandom = { seed = 9, width = 2, length = [0.12, 0.3], height = [0.055, 0.055], stagger = 0.02 }",
        ][bond];
        let pitch = 0.055 + mortar;
        let text = format!(
            "{bond}\ncourses = 9\nmortar = {{ bed = {mortar}, head = {mortar} }}\n[[panel.opening]]\nx = {x}\ny = {}\n\
             width = {width}\nheight = {}\nlintel = {{ height = {}, bearing = {bearing} }}\n",
            from as f64 * pitch, rows as f64 * pitch, lintel as f64 * pitch
        );
        match lay(&case(&text)) {
            // Slivers and bearings beyond the panel are refused.
            Err(e) => prop_assert!(e.to_string().contains("the cut leaves") || e.to_string().contains("beyond the panel"), "{e}"),
            Ok(wall) => {
                let overlap = |p: [f64; 2], q: [f64; 2]| p[1].min(q[1]) - p[0].max(q[0]);
                let hole = ([x, x + width], [from as f64 * pitch + mortar, (from + rows) as f64 * pitch]);
                for (i, a) in wall.blocks.iter().enumerate() {
                    prop_assert!(overlap(a.x, hole.0) < 1e-6 || overlap(a.y, hole.1) < 1e-6, "{} in the opening", a.name);
                    prop_assert!(a.length() > 0.0049);
                    for b in &wall.blocks[i + 1..] {
                        prop_assert!(overlap(a.x, b.x) < 1e-9 || overlap(a.y, b.y) < 1e-9, "{} {}", a.name, b.name);
                        prop_assert_ne!(&a.name, &b.name);
                    }
                }
                balance(&wall);
            }
        }
    }
}

/// Heights of courses without mortar are sums that rounding puts a little above or below what is written: an opening on every one.
#[test]
fn openings_lie_on_any_dry_bed() {
    let brick = "brick = { length = 0.4, height = 0.2, thickness = 0.4, specific_weight = 20e3 }\nmortar = { bed = 0, head = 0 }";
    for bottom in 0..30 {
        let opening = format!(
            "[[panel.opening]]\nx = 1.2\ny = {:.1}\nwidth = 0.8\nheight = 0.6\nlintel = {{ height = 0.2, bearing = 0.2 }}",
            0.2 * bottom as f64
        );
        let panel = format!("bond = \"running\"\ncourses = 36\nbricks = 8\n{opening}");
        let text = format!("model = \"shear\"\n[[panel]]\n{brick}\n{panel}\n{REST}");
        let file = from_str(&text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let wall = lay(&file.case).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(named(&wall, "p1o1").lowest_course(), bottom + 3);
    }
}

const WALL: &str =
    "bond = \"running\"\ncourses = 8\nbricks = 6\nmortar = { bed = 0.01, head = 0.01 }\n[[panel.opening]]\n";

fn close(a: [f64; 2], b: [f64; 2]) {
    assert!((0..2).all(|k| (a[k] - b[k]).abs() < 1e-12), "{a:?} is not {b:?}");
}

/// Two bricks to the left of a door that takes the place of two bricks in four courses, under a lintel of two courses that lies on
/// half a brick: with a pitch of 0.26 m from 0.51 m to 1.04 m. Course by course, counted by hand: of a course of whole bricks the
/// third and fourth go, of one that begins with a half brick the fourth of seven goes and its neighbours are cut to half bricks; beside the
/// lintel, of which whole bricks are cut to halves and the others end at it, five go.
#[test]
fn an_opening_in_courses_and_bricks() {
    let text = format!(
        "{WALL}x = \"2 bricks\"\ny = \"0 courses\"\nwidth = \"2 bricks\"\nheight = \"4 courses\"\n\
         lintel = {{ height = \"2 courses\", bearing = \"0.5 bricks\" }}\n"
    );
    let case = case(&text);
    let wall = lay(&case).unwrap_or_else(|e| panic!("{e}"));
    let lintel = named(&wall, "p1o1");
    close(lintel.x, [0.39, 1.16]);
    // It begins where the bricks of the fifth course do and ends where those of the sixth do.
    close(lintel.y, [0.27, 0.38 + 0.01]);
    assert_eq!(
        wall.blocks.iter().map(|b| b.course).fold([0; 8], |mut n, c| (n[c] += 1, n).1),
        [4, 6, 4, 6, 4, 5, 6, 7]
    );
    for (course, faces) in [(0, [0.51, 1.04]), (1, [0.51, 1.04]), (4, [0.38, 1.17]), (5, [0.38, 1.17])] {
        let of = || wall.blocks.iter().filter(move |b| b.course == course && b.name != "p1o1");
        let left = of().map(|b| b.x[1]).filter(|x| *x < 0.7).fold(0.0, f64::max);
        let right = of().map(|b| b.x[0]).filter(|x| *x > 0.7).fold(f64::INFINITY, f64::min);
        close([left, right], faces);
    }
    let [laid] = pattern::openings(&case).expect("a wall").try_into().expect("one opening");
    close(laid.x, [0.51, 1.04]);
    close(laid.y, [0.0, 0.27]);
    assert_eq!((laid.removed, laid.cut), (2 * (2 + 1) + 5, 2 * 2 + 2));
    let straight = Some(Jamb { courses: 4, short: 0, by: 0.0 });
    assert_eq!((laid.jambs, laid.moved.len()), ([straight, straight], 0));
    balance(&wall);
    // What the file says is kept, and reads back as it was.
    let json = concio::case::canonical_json(&case);
    assert!(json.contains("\"0.5 bricks\"") && json.contains("\"4 courses\""), "{json}");
    assert_eq!(from_str(&json, Syntax::Json, None).expect("a case").case, case);
}

/// Whatever the number of half bricks, jambs in running bond come out straight and no block is shorter than half a brick.
#[test]
fn openings_in_half_bricks_have_straight_jambs() {
    for (first, bond) in [("full", "running"), ("half", "running"), ("full", "stack")] {
        let step = if bond == "running" { 1 } else { 2 };
        for from in (0..10).step_by(step) {
            for width in (step..12 - from).step_by(step) {
                let text = WALL.replace("\"running\"", &format!("\"{bond}\"")).replace(
                    "bricks = 6\n",
                    &if bond == "running" {
                        format!("bricks = 6\nfirst = \"{first}\"\n")
                    } else {
                        "bricks = 6\n".into()
                    },
                );
                let [x, wide] = [from, width].map(|halves| 0.5 * halves as f64);
                let text = format!(
                    "{text}x = \"{x} bricks\"\ny = \"2 courses\"\nwidth = \"{wide} bricks\"\nheight = \"3 courses\"\n\
                     lintel = {{ height = \"1 course\", bearing = 0.05 }}\n"
                );
                let case = case(&text);
                let wall = match lay(&case) {
                    // At the panel's ends there is nothing for a lintel to lie on.
                    Err(e) if e.to_string().contains("beyond the panel") => continue,
                    other => other.unwrap_or_else(|e| panic!("{e}\n{text}")),
                };
                let [laid] = pattern::openings(&case).expect("a wall").try_into().expect("one opening");
                for jamb in laid.jambs {
                    assert_eq!(
                        jamb.map(|j| (j.short, j.courses)),
                        Some((0, 3)),
                        "{bond} {first} {x} + {wide}: {laid:?}"
                    );
                }
                let beside = wall.blocks.iter().filter(|b| (2..5).contains(&b.course));
                let shortest = beside.map(|b| b.length()).fold(f64::INFINITY, f64::min);
                assert!(shortest > 0.12 - 1e-9, "{bond} {first} {x} + {wide}: {shortest} m");
            }
        }
    }
}

/// A side in a head joint of every second course: those end before it, by hand at 0.51 m; `snap` moves the side there, the other to
/// the next head joint, and a bottom within a course to the bed below it.
#[test]
fn ragged_jambs_are_told_and_snap_mends_them() {
    let keys = "x = 0.515\ny = 0.08\nwidth = 0.5\nheight = 0.2\nlintel = { height = 0.12, bearing = 0.1 }\n";
    let off =
        case(&format!("{WALL}{}", keys.replace("y = 0.08", "y = 0.065").replace("height = 0.12", "height = 0.125")));
    let [laid] = pattern::openings(&off).expect("a wall").try_into().expect("one opening");
    let [Some(left), Some(right)] = laid.jambs else { panic!("{laid:?}") };
    // Courses 2 to 4 beside it: the third has whole bricks.
    assert!((left.courses, left.short) == (3, 1) && (left.by - 0.005).abs() < 1e-12, "{left:?}");
    assert_eq!((right.short, laid.moved.len()), (0, 0));
    let snapped = case(&format!("{WALL}snap = true\n{keys}"));
    let [laid] = pattern::openings(&snapped).expect("a wall").try_into().expect("one opening");
    close(laid.x, [0.51, 1.04]);
    close(laid.y, [0.065, 0.27]);
    assert!(laid.jambs.iter().flatten().all(|jamb| jamb.short == 0), "{laid:?}");
    let lintel = laid.lintel.expect("a lintel");
    // Half a brick of bearing on either side; up to the top of the sixth course.
    close(lintel, [1.04 - 0.51 + 2.0 * 0.12, 0.39 - 0.27]);
    let moved: Vec<(&str, i64)> = laid.moved.iter().map(|(what, by)| (*what, (1e6 * by).round() as i64)).collect();
    let expected = [
        ("the bearing", 20_000),
        ("the left side", -5_000),
        ("the right side", 25_000),
        ("the bottom", -15_000),
        ("the top", -10_000),
    ];
    assert_eq!(moved, expected);
    balance(&lay(&snapped).expect("a wall"));
}

/// All that is wrong with the edges of all openings stands in one list.
#[test]
fn all_bad_edges_are_listed_at_once() {
    let text = format!(
        "{WALL}x = 1.5\ny = 0.1\nwidth = 0.3\nheight = 0.13\n[[panel.opening]]\nx = 0.3\ny = 0.065\nwidth = 0.3\nheight = 0.1\n\
         lintel = {{ height = 0.13, bearing = 400 }}\n[[panel.opening]]\nx = 0.3\ny = 0\nwidth = \"1 brick\"\nheight = \"9 courses\"\n"
    );
    let case = case(&text);
    let keys: Vec<String> = pattern::findings(&case).into_iter().filter_map(|e| e.key).collect();
    let expected =
        ["opening[0].width", "opening[0].y", "opening[0].height", "opening[1].lintel.bearing", "opening[2].height"];
    assert_eq!(keys, expected.map(|key| format!("panel[0].{key}")));
    // The first of them is what `lay` says.
    assert!(lay(&case).expect_err("wrong").to_string().starts_with("panel[0].opening[0].width"));
}
