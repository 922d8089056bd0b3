//! `concio limit` as a user types it.

use serde_json::Value;

use crate::support::Desk;

/// One block of 1 m × 2 m: it turns at b/h = 0.5, or slides at μ.
fn block(mu: f64, load: &str) -> String {
    format!(
        "title = \"Block\"\nmodel = \"shear\"\n[[panel]]\nbond = \"stack\"\ncourses = 1\nbricks = 1\n\
         brick = {{ length = 1.0, height = 2.0, thickness = 0.5, specific_weight = 20e3 }}\n\
         [joint]\nbed = {{ law = \"elastic\", stiffness = 1e8 }}\nhead = {{ law = \"none\" }}\n\
         friction = {{ law = \"coulomb\", static = {mu}, dynamic = {mu} }}\n[load]\n{load}\n[motion]\nduration = 1.0\n"
    )
}

#[test]
fn a_block_turns_or_slides() {
    let desk = Desk::new();
    for (mu, kind, lambda, joint) in [(0.7, "overturning", "0.500000", "open"), (0.3, "sliding", "0.300000", "slide")] {
        desk.put("block.toml", block(mu, ""));
        let done = desk.concio("limit block.toml --out found").assert().success();
        let text = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
        let listed = format!("joints that {joint}");
        for part in ["Block", kind, lambda, &listed, "base|p1c1b1", "by forces", "to the right", "an estimate"] {
            assert!(text.contains(part), "{part}:\n{text}");
        }
        assert_eq!(desk.json("found/limit.json")["mechanism"]["kind"], kind);
        let drawing = desk.get("found/mechanism.svg");
        assert!(drawing.contains(kind) && drawing.contains("<path"), "{drawing}");
    }
}

/// A beam that stays level bears more than one that turns: 0.400475 and 0.231175, by linear programs of the same wall of which one leaves out the
/// moment of the beam.
#[test]
fn a_level_beam_is_held() {
    let desk = Desk::new();
    let wall = |rotation: &str| {
        format!(
            "model = \"planar\"\n[[panel]]\nbond = \"running\"\ncourses = 10\nbricks = 2\n\
             brick = {{ length = 0.4, height = 0.2, thickness = 0.3, specific_weight = 20e3 }}\nmortar = {{ bed = 0, head = 0 }}\n\
             [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
             friction = {{ law = \"coulomb\", static = 0.6, dynamic = 0.6, on = \"all\" }}\n\
             [load]\ntop = 25e3\nbeam = {{ mass = 2000 }}\nbeam_rotation = \"{rotation}\"\n[motion]\nduration = 1\n"
        )
    };
    for (rotation, expected) in [("fixed", 0.400475), ("free", 0.231175)] {
        desk.put("wall.toml", wall(rotation));
        let done = desk.concio("limit wall.toml --json --towards left").assert().success();
        let found: Value = serde_json::from_slice(&done.get_output().stdout).expect("JSON");
        let bounds = [0, 1].map(|k| found["bounds"][k].as_f64().expect("a bound"));
        assert!(bounds.iter().all(|b| (b - expected).abs() < 1e-6), "{rotation}: {bounds:?}");
    }
}

#[test]
fn what_is_printed_as_json_is_what_is_written() {
    let desk = Desk::new();
    desk.put("block.toml", block(0.7, "top = 10e3"));
    let done = desk.concio("limit block.toml --json --out found --towards left").assert().success();
    let printed: Value = serde_json::from_slice(&done.get_output().stdout).expect("JSON");
    assert_eq!(printed, desk.json("found/limit.json"));
    assert_eq!((&printed["towards"], &printed["certified"]), (&"left".into(), &true.into()));
    // λ (W h/2 + Q h) = (W + Q) b/2 with W = 20 kN, Q = 10 kN and h = 2 b.
    let bounds = [0, 1].map(|k| printed["bounds"][k].as_f64().expect("a bound"));
    assert!(bounds.iter().all(|b| (b - 0.375).abs() < 1e-7), "{bounds:?}");
    let pressed: f64 = printed["forces"].as_array().expect("forces").iter().filter_map(|f| f["normal"].as_f64()).sum();
    assert!((pressed - 30e3).abs() < 1e-3, "{pressed} N on the base");
}

/// What has no motion asks for none; a run does.
#[test]
fn a_wall_without_motion_is_analysed_at_rest() {
    let desk = Desk::new();
    let own = block(0.7, "");
    let (still, _) = own.split_once("[motion]").expect("a motion");
    desk.put("block.toml", still);
    desk.put("named.toml", format!("{still}[motion]\nbase = \"none\"\n"));
    for command in ["limit", "limit --out-of-plane", "mechanisms"] {
        for file in ["block.toml", "named.toml"] {
            desk.concio(&format!("{command} {file}")).assert().success();
        }
    }
    for command in ["check block.toml", "run block.toml", "mechanisms block.toml --shaken"] {
        let refused = desk.concio(command).assert().code(2);
        let said = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(said.contains("motion: the key is missing"), "{command}: {said}");
    }
}

#[test]
fn without_a_folder_nothing_is_written() {
    let desk = Desk::new();
    desk.put("block.toml", block(0.7, ""));
    let before = desk.list();
    desk.concio("limit block.toml").assert().success();
    assert_eq!(desk.list(), before);
}

#[test]
fn walls_that_cannot_be_asked_are_refused() {
    let desk = Desk::new();
    let refused = |parts: &[&str]| {
        let done = desk.concio("limit block.toml").assert().code(2);
        let text = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
        for part in parts {
            assert!(text.contains(part), "{part}:\n{text}");
        }
    };
    desk.put("block.toml", block(0.7, "beam = \"tied\""));
    refused(&["block.toml:13:", "load.beam", "allowed"]);
    let device = "[[joint.change]]\nat = { kind = [\"base\"] }\ndevice = { law = \"friction-damper\", slip_force = 1e3 }\n[motion]";
    desk.put("block.toml", block(0.7, "").replace("[motion]", device));
    refused(&["block.toml:", "joint.change[0].device", "dry joints"]);
    let falls = "bond = \"explicit\"\nblock = [{ course = 1, x = 0, y = 0, length = 1, height = 1 }, \
                 { course = 2, x = 0.8, y = 1, length = 1, height = 1 }]";
    desk.put("block.toml", block(0.7, "").replace("bond = \"stack\"\ncourses = 1\nbricks = 1", falls));
    refused(&["block.toml", "does not stand", "allowed"]);
    desk.put("block.toml", block(-0.7, ""));
    refused(&["block.toml:11:", "joint.friction.static", "allowed"]);
}

#[test]
fn a_bond_that_is_left_out_is_told() {
    let desk = Desk::new();
    let bond = "bond = { cohesion = 1e5, friction_angle = \"30 deg\" }\n[load]";
    desk.put("block.toml", block(0.7, "").replace("[load]", bond));
    let done = desk.concio("limit block.toml").assert().success();
    let text = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(text.contains("warning") && text.contains("bond"), "{text}");
}

/// Joints that are `elastic` crush only with a bond: that both are left out leaves a wall as it is.
#[test]
fn a_bonded_wall_that_crushes_is_analysed_as_a_dry_one() {
    let desk = Desk::new();
    let wall = |strength: &str, change: &str| {
        let bed = format!("bed = {{ law = \"elastic\", stiffness = \"5 N/mm3\"{strength} }}");
        format!(
            "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 4\nbricks = 1\n\
             brick = {{ length = 1.0, height = 0.5, thickness = 0.5, specific_weight = 20e3 }}\nmortar = {{ bed = 0, head = 0 }}\n\
             [joint]\n{bed}\nhead = {{ law = \"rigid\" }}\nfriction = {{ law = \"coulomb\", static = 0.7 }}\n\
             bond = {{ tensile_strength = \"0.1 MPa\", cohesion = \"0.15 MPa\", friction_angle = \"31 deg\" }}\n\
             {change}\n[motion]\nduration = 1\n"
        )
    };
    let strong = ", compressive_strength = \"3 MPa\"";
    let one = "[[joint.change]]\nat = { kind = [\"base\"] }\nspring = { compressive_strength = \"2 MPa\" }";
    let mut found = Vec::new();
    for (strength, change) in [("", ""), (strong, ""), ("", one)] {
        desk.put("wall.toml", wall(strength, change));
        for across in ["", " --out-of-plane"] {
            let done = desk.concio(&format!("limit wall.toml --json{across}")).assert().success();
            let out = done.get_output();
            let result: serde_json::Value = serde_json::from_slice(&out.stdout).expect("JSON");
            let told = String::from_utf8_lossy(&out.stderr).into_owned();
            assert!(told.contains("the bond of the joints is left out"), "{told}");
            let reads = strength == strong && !across.is_empty();
            let crushes = !reads && (strength, change) != ("", "");
            assert_eq!(told.contains("compressive_strength is left out"), crushes, "{told}");
            if !reads {
                found.push(result["multiplier"].as_f64().expect("a number"));
            }
        }
    }
    // A stack of 1 m by 2 m turns at 0.5, across its plane at 0.25.
    for (k, lambda) in found.iter().enumerate() {
        let right = if k == 1 || k == 4 { 0.25 } else { 0.5 };
        assert!((lambda - right).abs() < 1e-5, "{found:?}");
    }
}

/// A door near the left end: what is told is the weaker way, with the other beside it, and each way alone tells the same of itself.
#[test]
fn a_wall_is_pushed_to_its_weaker_side() {
    let desk = Desk::new();
    desk.put(
        "door.toml",
        r#"
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
friction = { law = "coulomb", static = 0.6, dynamic = 0.6 }
[motion]
duration = 1
"#,
    );
    let of = |line: &str| -> Value {
        let done = desk.concio(line).assert().success();
        serde_json::from_slice(&done.get_output().stdout).expect("JSON")
    };
    let number = |value: &Value| value.as_f64().expect("a number");
    let both = of("limit door.toml --json");
    let [left, right] = ["left", "right"].map(|side| of(&format!("limit door.toml --json --towards {side}")));
    assert!(number(&left["multiplier"]) < 0.95 * number(&right["multiplier"]), "{left} {right}");
    assert_eq!((&both["towards"], &both["multiplier"]), (&left["towards"], &left["multiplier"]));
    assert_eq!(
        (&both["other_way"]["towards"], &both["other_way"]["multiplier"]),
        (&"right".into(), &right["multiplier"])
    );
    assert!(left["other_way"].is_null());
    let done = desk.concio("limit door.toml").assert().success();
    let [told, warned] = [&done.get_output().stdout, &done.get_output().stderr].map(|o| String::from_utf8_lossy(o));
    assert!(told.contains("to the left") && told.contains("to the right"), "{told}");
    assert!(warned.contains("mortar counts as a dry joint"), "{warned}");
}

/// The wall file of docs/limit-analysis.md, whose λ is published.
#[test]
fn the_example_has_its_published_multiplier() {
    let desk = Desk::new();
    desk.put("wall.toml", include_str!("../../../../examples/limit/dry-wall.toml"));
    let of = |line: &str| -> Value {
        let done = desk.concio(line).assert().success();
        serde_json::from_slice(&done.get_output().stdout).expect("JSON")
    };
    let multiplier = |found: &Value| found["multiplier"].as_f64().expect("a number");
    let found = of("limit wall.toml --json");
    // M. C. Ferris and F. Tin-Loi, International Journal of Mechanical Sciences 43 (2001) 209–224, example 2.
    assert!((multiplier(&found) - 0.58000).abs() < 1e-5, "{found}");
    assert_eq!(found["mechanism"]["kind"], "mixed");
    let frictionless = of("limit wall.toml --json --heads frictionless");
    assert!((multiplier(&frictionless) - 0.56296).abs() < 1e-4, "{}", frictionless["multiplier"]);
}

/// A stone between two others, over nothing: rigid friction holds it by forces that cancel, and once stones yield it falls. `check`, `run` and `limit` all
/// say so.
#[test]
fn a_stone_that_nothing_presses_falls() {
    let desk = Desk::new();
    let stone = |id: &str, x: f64, y: f64| {
        format!(
            "[[panel.block]]\nid = \"{id}\"\ncourse = 1\ncorners = [[{x}, {y}], [{r}, {y}], [{r}, 0.9], [{m}, 1], [{x}, 0.9]]\n",
            r = x + 0.5,
            m = x + 0.25
        )
    };
    let wall = format!(
        "model = \"planar\"\n[[panel]]\nbond = \"explicit\"\n\
         brick = {{ length = 0.5, height = 0.5, thickness = 0.5, specific_weight = 20e3 }}\nmortar = {{ bed = 0, head = 0 }}\n{}{}{}\
         [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
         friction = {{ law = \"coulomb\", static = 0.7, dynamic = 0.7, on = \"all\" }}\n[motion]\nduration = 0.6\nbase = \"none\"\n",
        stone("left", 0.0, 0.0),
        stone("middle", 0.5, 0.6),
        stone("right", 1.0, 0.0)
    );
    desk.put("hangs.toml", wall);
    let said = |line: &str, status: i32| {
        let output = desk.concio(line).assert().code(status).get_output().clone();
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat()
    };
    assert!(said("check hangs.toml", 0).contains("does not stand"));
    assert!(said("run hangs.toml --out out", 0).contains("block middle had fallen"));
    let limit = said("limit hangs.toml --out limits", 0);
    assert!(limit.contains("λ does not hold") && limit.contains("falls under its own loads"), "{limit}");
    assert_eq!(desk.json("limits/limit.json")["falls_by_itself"], true);
    desk.put("block.toml", block(0.7, "").replace("shear", "planar"));
    let limit = said("limit block.toml --out stands", 0);
    assert!(
        !limit.contains("λ does not hold") && desk.json("stands/limit.json")["falls_by_itself"] == false,
        "{limit}"
    );
}
