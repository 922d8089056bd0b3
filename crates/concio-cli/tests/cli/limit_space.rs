//! `concio limit --out-of-plane` as a user types it.

use serde_json::Value;

use crate::support::Desk;

/// One block of 1 m × 2 m and 0.5 m thick: across its plane it turns at t/h = 0.25, or slides at μ.
fn block(mu: f64, bed: &str) -> String {
    format!(
        "title = \"Block\"\nmodel = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 1\nbricks = 1\n\
         brick = {{ length = 1.0, height = 2.0, thickness = 0.5, specific_weight = 20e3 }}\nmortar = {{ bed = 0, head = 0 }}\n\
         [joint]\nbed = {{ {bed} }}\nhead = {{ law = \"none\" }}\n\
         friction = {{ law = \"coulomb\", static = {mu}, dynamic = {mu} }}\n[motion]\nduration = 1.0\n"
    )
}

const RIGID: &str = "law = \"rigid\"";

/// A wall with a door and a lintel, whose head joints rub.
const DOOR: &str = r#"
model = "planar"
[[panel]]
bond = "running"
courses = 8
bricks = 6
brick = { length = "0.4 m", height = "0.2 m", thickness = "0.3 m", specific_weight = "20 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
opening = [{ x = "0.41 m", y = 0, width = "0.81 m", height = "0.84 m", lintel = { height = "0.21 m", bearing = "0.2 m" } }]
[joint]
bed = { law = "rigid" }
head = { law = "rigid" }
friction = { law = "coulomb", static = 0.6, dynamic = 0.6, on = "all" }
[motion]
duration = 1
"#;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn found(desk: &Desk, line: &str) -> Value {
    let done = desk.concio(line).assert().success();
    serde_json::from_slice(&done.get_output().stdout).expect("JSON")
}

#[test]
fn a_block_turns_or_slides_across_its_plane() {
    let desk = Desk::new();
    for (mu, kind, lambda, part) in
        [(0.7, "overturning", "0.250000", "equal to λ"), (0.2, "sliding", "0.200000", "--above")]
    {
        desk.put("block.toml", block(mu, RIGID));
        let done = desk.concio("limit block.toml --out-of-plane --out found").assert().success();
        let text = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
        for part in ["Block", kind, lambda, part, "by forces", "outwards", "an estimate", "closed form", "base|p1c1b1"]
        {
            assert!(text.contains(part), "{part}:\n{text}");
        }
        let written = desk.json("found/limit.json");
        assert_eq!((&written["mechanism"]["kind"], &written["out_of_plane"]), (&kind.into(), &true.into()));
        assert!((number(&written["closed_form"]["multiplier"]) - 0.25).abs() < 1e-9);
        let drawing = desk.get("found/mechanism.svg");
        assert!(drawing.contains(kind) && drawing.contains("<path"), "{drawing}");
    }
}

/// The exit status is that of λ; that λ of smooth heads is known less well stands in the JSON too.
#[test]
fn smooth_heads_without_a_certificate_are_told() {
    let opening = |x: f64, y: f64, width: f64, height: f64| {
        format!(
            "{{ x = \"{x} m\", y = \"{y} m\", width = \"{width} m\", height = \"{height} m\", \
             lintel = {{ height = \"0.25 m\", bearing = \"0.3 m\" }}, snap = true }}"
        )
    };
    let windows = [(1.0, 0.9, 1.3), (5.9, 0.9, 1.3), (1.0, 4.0, 1.4), (5.9, 4.0, 1.4)];
    let openings: Vec<String> = std::iter::once(opening(3.4, 0.0, 1.2, 2.25))
        .chain(windows.map(|(x, y, height)| opening(x, y, 1.1, height)))
        .collect();
    let desk = Desk::new();
    desk.put(
        "house.toml",
        format!(
            "model = \"planar\"\n[[panel]]\nbond = \"running\"\ncourses = 24\nbricks = 16\n\
             brick = {{ length = \"490 mm\", height = \"240 mm\", thickness = \"450 mm\", specific_weight = \"21 kN/m3\" }}\n\
             mortar = {{ bed = \"10 mm\", head = \"10 mm\" }}\nopening = [{}]\n\
             [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\nfriction = {{ law = \"coulomb\", static = 0.6, on = \"all\" }}\n\
             [load]\ntop = \"12 kN/m\"\nbeam = {{ mass = \"9 t\" }}\n[motion]\nduration = 1\n",
            openings.join(", ")
        ),
    );
    let result = found(&desk, "limit house.toml --out-of-plane --json");
    let smooth = &result["frictionless_heads"];
    assert_eq!([&result["certified"], &smooth["certified"]], [true, false], "a wall whose λ alone is certified");
    let told = result["warnings"].as_array().expect("warnings");
    let part = "no certificate for λ of smooth heads: its bounds are 0.000";
    assert_eq!(told.iter().filter(|w| w.as_str().is_some_and(|w| w.starts_with(part))).count(), 1, "{told:?}");
    let done = desk.concio("limit house.toml --out-of-plane").assert().success();
    let said = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert_eq!(said.matches("no certificate").count(), 1, "{said}");
}

#[test]
fn what_is_printed_as_json_is_what_is_written() {
    let desk = Desk::new();
    desk.put("block.toml", block(0.7, RIGID));
    let printed = found(&desk, "limit block.toml --out-of-plane --json --out found");
    assert_eq!(printed, desk.json("found/limit.json"));
    let pressed: f64 = printed["forces"].as_array().expect("forces").iter().map(|f| number(&f["normal"])).sum();
    assert!((pressed - 20e3).abs() < 1e-2, "{pressed} N on the base");
    // It turns about the outer edge, x = 0: the centre goes outwards as fast as it is high, and up by half of the thickness.
    let moved = &printed["mechanism"]["blocks"][0];
    let [x, y, z] = [0, 1, 2].map(|k| number(&moved["velocity"][k]));
    assert!(x < 0.0 && y.abs() < 1e-5 && (z / x + 0.25).abs() < 1e-4, "{moved}");
}

/// With a door: λ is at most that of the wall as one body, at most a little above that of smooth head joints, and the same both ways.
#[test]
fn a_wall_with_a_door() {
    let desk = Desk::new();
    desk.put("door.toml", DOOR);
    let outwards = found(&desk, "limit door.toml --out-of-plane --json");
    let [rub, smooth, turns] = [
        &outwards["multiplier"],
        &outwards["frictionless_heads"]["multiplier"],
        &outwards["closed_form"]["multiplier"],
    ]
    .map(number);
    assert!(smooth <= rub * (1.0 + 1e-6) && rub <= turns * (1.0 + 1e-6), "{smooth} {rub} {turns}");
    assert!(outwards["certified"] == true && outwards["heads_rub"] == true, "{outwards}");
    let inwards = found(&desk, "limit door.toml --out-of-plane --json --towards inwards");
    assert!((number(&inwards["multiplier"]) - rub).abs() < 1e-5 * rub, "{}", inwards["multiplier"]);
    let above = found(&desk, "limit door.toml --out-of-plane --json --above 0.9m");
    assert!(number(&above["multiplier"]) > rub, "{}", above["multiplier"]);
    let low = found(&desk, "limit door.toml --out-of-plane --json --even-twist");
    assert!(number(&low["multiplier"]) < rub, "{}", low["multiplier"]);
}

/// t 0.5, h 6, γ 18 kN/m³, 1.5 MPa: the hinge is 18 mm from the face, λ = 2 (0.25 − 0.018)/6.
#[test]
fn stones_that_crush() {
    let desk = Desk::new();
    let bed = "law = \"no-tension\", stiffness = 1e9, compressive_strength = \"1.5 MPa\"";
    let wall = block(0.7, bed).replace("height = 2.0", "height = 6.0").replace("20e3", "18e3");
    desk.put("block.toml", wall);
    let lambda = found(&desk, "limit block.toml --out-of-plane --json");
    assert!((number(&lambda["multiplier"]) - 0.464 / 6.0).abs() < 1e-6, "{lambda}");
    let done = desk.concio("limit block.toml --out-of-plane").assert().success();
    let [told, warned] = [&done.get_output().stdout, &done.get_output().stderr].map(|o| String::from_utf8_lossy(o));
    assert!(told.contains("hinges set back") && !warned.contains("compressive_strength"), "{told} {warned}");
    // 108 kPa at the base: nothing is certified where the dead load alone crushes.
    desk.put("block.toml", desk.get("block.toml").replace("1.5 MPa", "0.1 MPa"));
    let done = desk.concio("limit block.toml --out-of-plane --json").assert().code(1);
    let [told, warned] = [&done.get_output().stdout, &done.get_output().stderr].map(|o| String::from_utf8_lossy(o));
    assert!(told.contains("\"certified\": false") && warned.contains("more than they bear"), "{told} {warned}");
}

/// t 0.5, h 1.5, γ 20 kN/m³, 0.1 MPa, three bricks a course: the course as a whole is pressed by 30 kPa at its base, so that the
/// hinge lies 0.075 m inside: λ = 2 (0.25 − 0.075)/1.5.
#[test]
fn courses_of_bricks_crush_as_a_whole() {
    let desk = Desk::new();
    desk.put(
        "wall.toml",
        "model = \"planar\"\n[[panel]]\nbond = \"running\"\ncourses = 6\nbricks = 3\n\
         brick = { length = 0.5, height = 0.25, thickness = 0.5, specific_weight = 20e3 }\nmortar = { bed = 0, head = 0 }\n\
         [joint]\nbed = { law = \"rigid\", compressive_strength = \"0.1 MPa\" }\nhead = { law = \"rigid\" }\n\
         friction = { law = \"coulomb\", static = 0.6, on = \"all\" }\n[motion]\nduration = 1\n",
    );
    let found = found(&desk, "limit wall.toml --out-of-plane --json");
    for lambda in
        [&found["multiplier"], &found["frictionless_heads"]["multiplier"], &found["closed_form"]["multiplier"]]
    {
        assert!((number(lambda) - 0.35 / 1.5).abs() < 1e-5, "{found}");
    }
    assert!(
        found["certified"] == true && found["crushing"]["overloaded"].as_array().is_some_and(Vec::is_empty),
        "{found}"
    );
}

/// A bonded façade with openings whose stones crush: at its jambs stones are held by the friction of head joints, so that smooth ones bear nothing.
#[test]
fn heads_without_which_a_wall_falls_leave_lambda() {
    let desk = Desk::new();
    let opening = |x: f64, y: f64, height: f64| {
        format!(
            "[[panel.opening]]\nx = {x}\ny = {y}\nwidth = 1\nheight = {height}\nlintel = {{ height = \"1 course\", bearing = 0.25 }}\n"
        )
    };
    let openings = [opening(3.0, 0.0, 2.25), opening(1.0, 1.0, 1.25), opening(1.0, 4.0, 1.25)].concat();
    desk.put(
        "facade.toml",
        format!(
            "model = \"planar\"\n[[panel]]\nbond = \"running\"\ncourses = 24\nbricks = 14\n\
             brick = {{ length = 0.49, height = 0.24, thickness = 0.38, specific_weight = 18e3 }}\nmortar = {{ bed = 0.01, head = 0.01 }}\n\
             {openings}[joint]\nbed = {{ law = \"elastic\", stiffness = \"5 N/mm3\", compressive_strength = \"3 MPa\" }}\n\
             head = {{ law = \"elastic\", stiffness = \"5 N/mm3\" }}\nfriction = {{ law = \"coulomb\", static = 0.6, on = \"all\" }}\n\
             bond = {{ tensile_strength = \"0.1 MPa\", cohesion = \"0.15 MPa\", friction_angle = \"31 deg\" }}\n\
             [load]\ntop = \"12 kN/m\"\n[motion]\nduration = 1\n"
        ),
    );
    let done = desk.concio("limit facade.toml --out-of-plane --json").assert().success();
    let warned = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(warned.contains("without friction of the head joints the wall is not found to stand"), "{warned}");
    let found: Value = serde_json::from_slice(&done.get_output().stdout).expect("JSON");
    let (lambda, closed) = (number(&found["multiplier"]), number(&found["closed_form"]["multiplier"]));
    assert!((lambda - closed).abs() < 1e-4 * closed && found["frictionless_heads"].is_null(), "{lambda} {closed}");
    assert_eq!(found["heads_rub"], true);
}

#[test]
fn what_cannot_be_asked_is_refused() {
    let desk = Desk::new();
    desk.put("block.toml", block(0.7, RIGID));
    let refused = |line: &str, parts: &[&str]| {
        let done = desk.concio(line).assert().code(2);
        let text = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
        for part in parts {
            assert!(text.contains(part), "{part}:\n{text}");
        }
    };
    refused("limit block.toml --out-of-plane --towards left", &["outwards", "inwards"]);
    refused("limit block.toml --towards outwards", &["left and right", "--out-of-plane"]);
    refused("limit block.toml --out-of-plane --heads frictionless", &["head joints"]);
    refused("limit block.toml --out-of-plane --above 5m", &["5 m", "below 1", "highest block"]);
    refused("limit block.toml --out-of-plane --above 5", &["unit"]);
    refused("limit block.toml --above 1m", &["--out-of-plane"]);
    let corners =
        "bond = \"explicit\"\nblock = [{ id = \"stone\", course = 1, corners = [[0, 0], [1, 0], [0.8, 1], [0.2, 1]] }]";
    desk.put("block.toml", block(0.7, RIGID).replace("bond = \"stack\"\ncourses = 1\nbricks = 1", corners));
    refused("limit block.toml --out-of-plane", &["block.toml", "stone", "polygon", "rectangles"]);
}
