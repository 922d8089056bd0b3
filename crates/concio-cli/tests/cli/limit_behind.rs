//! `concio limit --out-of-plane` with what `[out_of_plane]` puts behind a wall, beside `concio mechanisms` of the same file.

use concio_verified::agrees;
use serde_json::Value;

use crate::support::Desk;

/// Courses of one stone of `length` m, 0.5 m high and thick, 18 kN/m³, 6 m together.
fn column(length: f64, behind: &str) -> String {
    wall("stack", 12, 1, [length, 0.5, 0.5], 18e3, behind)
}

fn wall(
    bond: &str,
    courses: usize,
    bricks: usize,
    [length, height, thickness]: [f64; 3],
    weight: f64,
    behind: &str,
) -> String {
    format!(
        "title = \"Wall\"\nmodel = \"planar\"\n[[panel]]\nbond = \"{bond}\"\ncourses = {courses}\nbricks = {bricks}\n\
         brick = {{ length = {length:?}, height = {height:?}, thickness = {thickness:?}, specific_weight = {weight:?} }}\n\
         mortar = {{ bed = 0, head = 0 }}\n[joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
         friction = {{ law = \"coulomb\", static = 0.6, on = \"all\" }}\n{behind}\n[motion]\nduration = 1.0\n"
    )
}

fn json(desk: &Desk, line: &str) -> Value {
    let done = desk.concio(line).assert().success();
    serde_json::from_slice(&done.get_output().stdout).expect("JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// λ, and α0 of the least mechanism.
fn both(desk: &Desk, wall: &str) -> [f64; 2] {
    desk.put("wall.toml", wall);
    let found = json(desk, "limit wall.toml --out-of-plane --json");
    assert_eq!(found["certified"], true, "{found}");
    let mechanisms = json(desk, "mechanisms wall.toml --json");
    let alpha = number(&mechanisms["least"]["multiplier"]);
    assert!((number(&found["behind"]["mechanisms"][0]["multiplier"]) - alpha).abs() < 1e-12, "{found}");
    [number(&found["multiplier"]), alpha]
}

fn same(what: &str, desk: &Desk, wall: &str, expected: f64) {
    let [lambda, alpha] = both(desk, wall);
    agrees!(format!("Limit analysis in space: {what}"), "closed form by hand", "", lambda, expected, 1e-6);
    agrees!(format!("Mechanisms: {what}"), "closed form by hand", "", alpha, expected, 1e-6);
}

/// (OP3): (W t/2 + T h)/(W h/2), W 54 kN, T 1.08 kN at 6 m. Pushed inwards the tie holds nothing, and λ is t/h.
#[test]
fn a_tie_at_the_top() {
    let desk = Desk::new();
    let tied = column(1.0, "[[out_of_plane.anchor]]\nz = 6\nyield_force = 1080\n");
    same("façade with a tie at its top", &desk, &tied, (54.0 * 0.25 + 1.08 * 6.0) / (54.0 * 3.0));
    let inwards = json(&desk, "limit wall.toml --out-of-plane --json --towards inwards");
    assert!((number(&inwards["multiplier"]) - 0.5 / 6.0).abs() < 1e-6, "{}", inwards["multiplier"]);
    assert_eq!(inwards["behind"]["mechanisms"], serde_json::json!([]), "closed forms are of falling outwards");
    let done = desk.concio("limit wall.toml --out-of-plane").assert().success();
    let [told, warned] =
        [&done.get_output().stdout, &done.get_output().stderr].map(|o| String::from_utf8_lossy(o).into_owned());
    assert!(told.contains("0 floors, 1 tie") && told.contains("(OP3) at z = 0 m: equal to λ"), "{told}");
    assert!(!warned.contains("out_of_plane is not read"), "{warned}");
}

/// (OP3) about the joint at 3 m, above the seat of the lower floor: (27 · 0.25 + 6 · 0.25 − 0.8 · 3)/(27 · 1.5 + 6 · 3). Two stones
/// beside each other share what lies on them.
#[test]
fn floors_that_press_push_thrust_and_rub() {
    let desk = Desk::new();
    let floors = "[[out_of_plane.floor]]\nz = 3\nload = 12e3\nat = 0.35\npush = 2e3\nseat_friction = 0.3\n\
                  [[out_of_plane.floor]]\nz = 6\nload = 6e3\nat = 0.25\nthrust = 800.0\n";
    let expected = (27.0 * 0.25 + 6.0 * 0.25 - 0.8 * 3.0) / (27.0 * 1.5 + 6.0 * 3.0);
    same("floors above a hinge", &desk, &column(1.0, floors), expected);
    same("floors on two stones a course", &desk, &wall("stack", 12, 2, [0.5, 0.5, 0.5], 18e3, floors), expected);
    // With a strong connection above, all turns about the base: (54 · 0.25 + 12 · 0.35 + 6 · 0.25 + 3.6 · 3 + 2 · 6 − 0.8 · 6)/(162 + 14 · 3 + 6 · 6).
    let connected = format!("{floors}connection = 2e3\n");
    let base = (13.5 + 4.2 + 1.5 + 10.8 + 12.0 - 4.8) / (162.0 + 42.0 + 36.0);
    let above = (27.0 * 0.25 + 6.0 * 0.25 + (2.0 - 0.8) * 3.0) / 58.5;
    assert!(base < above);
    same("floors with seat friction and a connection", &desk, &column(1.0, &connected), base);
}

/// (OP6), 30 courses of 0.1 m: W = N = 18 kN, N in the middle of the thickness. Both joints beside x* = 0.586 are as
/// in the reference of limit analysis: 0.9, with its crack on course 20.
#[test]
fn a_floor_that_holds_the_top() {
    let desk = Desk::new();
    let behind = "[[out_of_plane.floor]]\nz = 3\nload = 18e3\nat = 0.15\nholds = true\n";
    same("vertical arch below a floor that holds", &desk, &wall("stack", 30, 1, [1.0, 0.1, 0.3], 20e3, behind), 0.9);
    let done = desk.concio("limit wall.toml --out-of-plane").assert().success();
    let warned = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(warned.contains("holds whatever pushes"), "{warned}");
    // A connection of 4 kN gives way before: the wall turns about its base, (W t/2 + N t/2 + 4 h)/(W h/2 + N h).
    let weak = behind.to_string() + "connection = 4e3\n";
    same(
        "a floor that holds, and gives way",
        &desk,
        &wall("stack", 30, 1, [1.0, 0.1, 0.3], 20e3, &weak),
        (18.0 * 0.15 + 18.0 * 0.15 + 4.0 * 3.0) / (18.0 * 1.5 + 18.0 * 3.0),
    );
}

/// A façade of 10 courses of whole and half stones of 0.4 × 0.2 × 0.2 m, with side walls of the same texture: what is built from the
/// file is the texture whose values another program computed.
#[test]
fn side_walls_block_by_block() {
    let desk = Desk::new();
    let side = |x: f64| format!("[[out_of_plane.side_wall]]\nx = {x:?}\nthickness = 0.2\n");
    let facade = |sides: &str| wall("running", 10, 5, [0.4, 0.2, 0.2], 20e3, sides);
    for (what, sides, rub, smooth, closed, told) in [
        (
            "two side walls",
            side(0.1) + &side(1.9),
            0.36518,
            0.33139,
            0.33529,
            ["(OP4) at z = 0.4000 m: low, 8.1", " % below λ; high, 1.1"],
        ),
        ("one side wall", side(0.1), 0.25775, 0.22370, 0.24641, ["(OP4) at z = ", ": low, 4."]),
    ] {
        desk.put("wall.toml", facade(&sides));
        let found = json(&desk, "limit wall.toml --out-of-plane --json");
        let against = "a second program of the same cone program";
        let what = |part: &str| format!("Limit analysis in space: façade with {what} from a file{part}");
        agrees!(what(""), against, "", number(&found["multiplier"]), rub, 1e-4);
        let of_smooth = number(&found["frictionless_heads"]["multiplier"]);
        agrees!(what("; smooth heads"), against, "", of_smooth, smooth, 1e-4);
        let kinds = found["behind"]["mechanisms"].as_array().expect("mechanisms");
        let least = kinds.iter().find(|m| m["kind"] == "overturning-with-side-walls").expect("side walls");
        assert!((number(&least["multiplier"]) - closed).abs() < 1e-4 * closed, "{least}");
        let text = String::from_utf8_lossy(
            &desk.concio("limit wall.toml --out-of-plane").assert().success().get_output().stdout,
        )
        .into_owned();
        assert!(told.iter().all(|part| text.contains(part)), "{told:?}:\n{text}");
    }
}

/// Courses of the side wall that are not the wall's own keep their slope l/h_b; a load on it holds by its friction.
#[test]
fn side_walls_of_other_courses_and_their_load() {
    let desk = Desk::new();
    let found = |keys: &str| {
        let side = format!("[[out_of_plane.side_wall]]\nx = 0.1\nthickness = 0.2\nfirst_opening = 0.8\n{keys}");
        desk.put("wall.toml", wall("running", 4, 3, [0.4, 0.2, 0.2], 20e3, &side));
        let found = json(&desk, "limit wall.toml --out-of-plane --json");
        [number(&found["multiplier"]), number(&found["behind"]["side_wall_blocks"])]
    };
    let [same, blocks] = found("");
    let [scaled, as_many] = found("course_height = 0.1\noverlap = 0.1\n");
    assert!((same - scaled).abs() < 1e-6 && blocks == as_many, "{same} {scaled}");
    let [laden, _] = found("load = 5e3\n");
    assert!(laden > same * 1.01, "{laden} {same}");
}

/// (OP9): a gable of 0.3 m on a thicker wall turns alone, 3 t/(2 h_g).
#[test]
fn a_gable_on_the_wall() {
    let desk = Desk::new();
    let gable = "[out_of_plane.gable]\nheight = 2.0\nthickness = 0.3\n";
    desk.put("wall.toml", wall("running", 2, 4, [1.0, 0.5, 0.6], 20e3, gable));
    let found = json(&desk, "limit wall.toml --out-of-plane --json");
    agrees!("Limit analysis in space: gable", "3 t/(2 h_g)", "", number(&found["multiplier"]), 0.225, 1e-6);
    // With a ridge beam: (W t/2 + P c − H h_g)/(W h_g/3 + (P + Q) h_g), W = 24 kN.
    let beam = gable.to_string() + "ridge_load = 3e3\nridge_at = 0.1\nridge_push = 1e3\nridge_thrust = 200.0\n";
    desk.put("wall.toml", wall("running", 2, 4, [1.0, 0.5, 0.6], 20e3, &beam));
    let found = json(&desk, "limit wall.toml --out-of-plane --json");
    let expected = (24.0 * 0.15 + 3.0 * 0.1 - 0.2 * 2.0) / (24.0 * 2.0 / 3.0 + 4.0 * 2.0);
    agrees!(
        "Limit analysis in space: gable with a ridge beam",
        "(OP9)",
        "",
        number(&found["multiplier"]),
        expected,
        1e-6
    );
    // Its flaps bear less, and λ knows none of them.
    let done = desk.concio("limit wall.toml --out-of-plane").assert().success();
    let text = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
    let flaps = text.lines().find(|line| line.contains("flaps of the gable")).unwrap_or_else(|| panic!("{text}"));
    assert!(flaps.contains("holds the gable as one body and knows no flaps: it counts"), "{flaps}");
}

/// (OP2) in the table sets hinges back here too: the wall of the closed form, 0.0773333 and with a triangle 0.0753333.
#[test]
fn strength_of_the_table_sets_hinges_back() {
    let desk = Desk::new();
    for (pressure, expected) in [("rectangular", 0.0773333), ("triangular", 0.0753333)] {
        let keys = format!("[out_of_plane]\nstrength = 1.5e6\npressure = \"{pressure}\"\n");
        let [lambda, alpha] = both(&desk, &column(1.0, &keys));
        assert!(
            (lambda - expected).abs() < 1e-5 * expected && (alpha - expected).abs() < 1e-5 * expected,
            "{lambda} {alpha}"
        );
    }
}

/// Panels of two thicknesses share the front: outwards to the back is what inwards is to the front.
#[test]
fn the_back_as_the_outer_face() {
    let desk = Desk::new();
    let two = |table: &str| {
        let panel = |t: f64| {
            format!(
                "[[panel]]\nbond = \"stack\"\ncourses = 3\nbricks = 1\nbrick = {{ length = 1.0, height = 0.5, thickness = {t:?}, \
                 specific_weight = 20e3 }}\nmortar = {{ bed = 0, head = 0 }}\n"
            )
        };
        format!(
            "model = \"planar\"\n{}{}connection = 0\n[joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
             friction = {{ law = \"coulomb\", static = 0.6, on = \"all\" }}\n{table}[motion]\nduration = 1.0\n",
            panel(0.5),
            panel(0.3)
        )
    };
    let found = |table: &str, way: &str| {
        desk.put("wall.toml", two(table));
        number(&json(&desk, &format!("limit wall.toml --out-of-plane --json --towards {way}"))["multiplier"])
    };
    let back = "[out_of_plane]\noutside = \"back\"\n";
    let [front_out, front_in, back_out, back_in] =
        [found("", "outwards"), found("", "inwards"), found(back, "outwards"), found(back, "inwards")];
    assert!((front_out - front_in).abs() > 1e-3, "{front_out} {front_in}");
    assert!((back_out - front_in).abs() < 1e-5 && (back_in - front_out).abs() < 1e-5, "{back_out} {back_in}");
}

#[test]
fn what_is_left_out_is_told() {
    let desk = Desk::new();
    let opening = "opening = [{ x = 0.4, y = 0.0, width = 0.8, height = 0.8, lintel = { height = 0.2, bearing = 0.2 } }]\n[joint]";
    let behind = "[[out_of_plane.anchor]]\nz = 0.5\nx = 0.8\nyield_force = 1e3\n\
                  [[out_of_plane.side_wall]]\nx = 0.8\nthickness = 0.2\n[[out_of_plane.side_wall]]\nx = 0.1\nthickness = 0.2\nbonded = false\n";
    desk.put("wall.toml", wall("running", 6, 4, [0.4, 0.2, 0.2], 20e3, behind).replace("[joint]", opening));
    let done = desk.concio("limit wall.toml --out-of-plane").assert().success();
    let warned = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    for part in
        ["lies in an opening", "the side wall at x = 0.8000 m is left out", "not bonded, and so left out: 1 side wall"]
    {
        assert!(warned.contains(part), "{part}:\n{warned}");
    }
}
