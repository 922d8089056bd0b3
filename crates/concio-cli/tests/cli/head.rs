//! What a person asks first: the head of the terminal and of the report, with numbers that are known.

use crate::support::Desk;

/// A stone of 1 m × 0.02 m × 1 m and 400 N on dry springs of 10 MN/m (two half bricks count), pushed without inertia by a base
/// acceleration that grows by 0.1 g in a second: it slides from t = 4 s on, at μ = 0.4, having leant on its springs by 160 N over them.
const STONE: &str = r#"
title = "Stone"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = 1, height = 0.02, thickness = 1, specific_weight = 20e3 }
mortar = { bed = 0, head = 0 }
[joint]
damping_ratio = 0
head = { law = "none" }
bed = { law = "no-tension", stiffness = "5e6 N/m", normal_to_shear = 2.4, rigidity = 1 }
friction = { law = "coulomb", static = 0.4, dynamic = 0.4 }
[motion]
base = { tilt = { acceleration = 9.81, rise = 10 } }
duration = 4.5
quasi_static = true
"#;

/// The lines of the head, by their names, in their order.
fn head(told: &str) -> Vec<(String, String)> {
    let head = told.split("\n\n").next().expect("a head");
    let pair = |line: &str| {
        let (name, value) = line.trim_start().split_once("  ").unwrap_or_else(|| panic!("{line}"));
        (name.to_string(), value.trim().to_string())
    };
    head.lines().map(pair).collect()
}

fn ran(desk: &Desk, text: &str) -> (String, Vec<(String, String)>) {
    desk.put("wall.toml", text);
    let run = desk.concio("run wall.toml --out r").assert().success();
    let told = String::from_utf8_lossy(&run.get_output().stdout).into_owned();
    let head = head(&told);
    (told, head)
}

const ASKED: [&str; 6] = ["failure", "first crack", "collapse", "peak drift", "residual drift", "peak base shear"];

#[test]
fn a_push_is_told_with_what_is_known_of_it() {
    let desk = Desk::new();
    let (told, head) = ran(&desk, STONE);
    let names: Vec<&str> = head.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ASKED, "{told}");
    let of = |name: &str| &head.iter().find(|(n, _)| n == name).expect("a line").1;
    assert!(of("failure").starts_with("bed sliding, t = "), "{told}");
    assert_eq!(of("first crack"), "none, no joint is bonded");
    assert_eq!(of("collapse"), "none, until t = 4.500 s");
    assert!(of("residual drift").ends_with("at the end"), "{told}");
    let shear = of("peak base shear");
    // A step is 20 ms, and the first of them that slides has borne all but rounding.
    let began = ["3.980", "4.000", "4.020"]
        .map(|t| format!("0.4000 of the vertical force at rest: 160.0 N, t = {t} s, top at −1"));
    assert!(began.iter().any(|start| shear.starts_with(start)), "{shear}");
    let top: f64 =
        shear.split("top at −").nth(1).and_then(|t| t.strip_suffix(" µm")).expect("µm").parse().expect("a number");
    assert!((top / 16.0 - 1.0).abs() < 0.03, "{top} µm, not 16");
    // The report has the same answers, then the warnings, then the rest.
    let report = desk.get("r/report.html").replace('\u{a0}', " ");
    let at = |part: &str| report.find(part).unwrap_or_else(|| panic!("{part} is not in the report"));
    let answers = &report[at("<dl class=\"answers\">")..at("<dl class=\"tiles\">")];
    let words = |text: &str| text.split([',', ' ', '\n']).collect::<String>();
    let shown = answers.split('<').map(|part| part.split_once('>').map_or(part, |(_, text)| text)).collect::<String>();
    for (name, line) in &head {
        assert!(words(&shown).contains(&words(&format!("{name}{line}"))), "{name} {line}: {shown}");
    }
    assert!(
        at("<dl class=\"answers\">") < at("<dl class=\"tiles\">")
            && at("<dl class=\"tiles\">") < at("<div id=\"app\">")
    );
}

/// Warnings stand directly beneath the head of the report.
#[test]
fn warnings_follow_the_answers() {
    let desk = Desk::new();
    let (_, _) = ran(
        &desk,
        &STONE
            .replace("static = 0.4, dynamic = 0.4", "static = 0.4, dynamic = 0.4, on = \"all\"")
            .replace("length = 1,", "length = 100,"),
    );
    let report = desk.get("r/report.html");
    let at = |part: &str| report.find(part).unwrap_or_else(|| panic!("{part} is not in the report"));
    let [answers, end, warning, tiles] =
        ["<dl class=\"answers\">", "</dl>", "<p class=\"note\"><b>Warning:</b>", "<dl class=\"tiles\">"].map(at);
    assert!(answers < end && end < warning && warning < tiles);
}

/// A brick that 0.1 MPa hold to the base cracks where m a is c A: at 20 times its weight over 50 kPa, slowly.
#[test]
fn the_first_crack_is_told_with_joint_time_and_acceleration() {
    let desk = Desk::new();
    let text = r#"
model = "shear"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = 0.25, height = 0.5, thickness = 0.12, specific_weight = 20e3 }
mortar = { bed = 0, head = 0 }
[joint]
damping_ratio = 0.5
bed = { law = "elastic", stiffness = "5e7 N/m" }
head = { law = "none" }
friction = { law = "stribeck", static = 0.6, dynamic = 0.42, slip_velocity = "1 mm/s" }
[joint.bond]
tensile_strength = "0.1 MPa"
cohesion = "0.1 MPa"
friction_angle = 0
mode_1_energy = "5 N/m"
mode_2_energy = "5000 N/m"
[motion]
base = { tilt = { acceleration = 117.72, rise = 12 } }
duration = 12
"#;
    let (told, head) = ran(&desk, text);
    // c A = 3 kN of a brick of 300 N: 10 g, at 1 g in a second.
    let crack = &head[1].1;
    let number = |after: &str| -> f64 {
        crack.split(after).nth(1).and_then(|t| t.split(' ').next()).expect("a number").parse().expect("a number")
    };
    assert!((number("t = ") - 10.0).abs() < 0.05 && (number("base at ") - 10.0).abs() < 0.05, "{crack}");
    assert!(crack.contains("joint base|p1c1b1, base at") && crack.ends_with(" g"), "{crack}");
    assert!(head[0].1.starts_with("cracked, 1 of 1 bonded joints") || head[0].1.starts_with("slid far"), "{told}");
}

/// A stone of 1 m × 2 m and 40 kN, bonded at 50 kPa, is pulled there by 6 M/(b ℓ²) − N/(b ℓ) = 56 kPa at 0.4 g and stands.
#[test]
fn a_wall_that_cracked_and_stands_has_cracked() {
    let desk = Desk::new();
    let bed = "bed = { law = \"elastic\", stiffness = \"100 N/mm3\" }\nbond = { tensile_strength = \"50 kPa\", cohesion = \"0.2 MPa\", \
        friction_angle = \"30 deg\", mode_1_energy = \"10 N/m\", mode_2_energy = \"100 N/m\" }";
    let lines = STONE.lines().map(|line| if line.starts_with("bed =") { bed } else { line });
    let stone = lines.collect::<Vec<_>>().join("\n").replace("height = 0.02", "height = 2").replace("4.5", "4");
    let (told, head) = ran(&desk, &stone);
    assert_eq!(head[0], ("failure".into(), "cracked, 1 of 1 bonded joints, 0 of them broken".into()), "{told}");
}

/// A stone on a base that jumps to 0.8 g for 0.1 s lags by 0.4 g, as μ = 0.4 drags it along, and catches up at 0.4 g: 2 · ½ · 0.4 g · (0.1 s)².
/// It is the base joint that slid, and nothing else can.
#[test]
fn a_wall_that_slides_as_a_whole_is_told_with_its_base() {
    let desk = Desk::new();
    let text = r#"
model = "shear"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = 1, height = 0.2, thickness = 0.5, specific_weight = 20e3 }
mortar = { bed = 0, head = 0 }
[joint]
bed = { law = "none" }
head = { law = "none" }
friction = { law = "coulomb", static = 0.4 }
[motion]
duration = "0.5 s"
base = { pulse = { shape = "rectangular", acceleration = "ACCELERATION g", duration = "0.1 s" } }
"#;
    let (told, head) = ran(&desk, &text.replace("ACCELERATION", "0.8"));
    assert!(
        head[0].1.starts_with("none, joints slid by at most 39.24 mm, 3.92 % of what lies on the base, at base|p1c1b1"),
        "{told}"
    );
    // 2.2 g: 1.8 g behind for 0.1 s, and 0.45 s at 0.4 g to make up for that: the joint has slid by half of the stone.
    let (told, head) = ran(&desk, &text.replace("ACCELERATION", "2.2").replace("0.5 s", "1 s"));
    assert!(head[0].1.starts_with("slid far, by 485.6 mm"), "{told}");
}

/// All is 0 where nothing moves, and no zero has a sign or an exponent.
#[test]
fn a_wall_at_rest_is_told_in_zeros() {
    for (model, failure, collapse) in [
        ("shear", "none, no joint slid or cracked", "–, a shear wall cannot: its blocks move horizontally alone"),
        ("planar", "none", "none, until t = 0.1000 s"),
    ] {
        let desk = Desk::new();
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
        let (told, head) = ran(&desk, &text);
        let values: Vec<&str> = head.iter().map(|(_, value)| value.as_str()).collect();
        assert_eq!(
            values,
            [failure, "none, no joint is bonded", collapse, "0, the top did not move", "0", "0"],
            "{told}"
        );
        // The residual is a pure number, so small as it is.
        for line in told.lines().filter(|line| !line.contains("energy residual")) {
            assert!(["-0", "−0", "e-", "e−"].iter().all(|wrong| !line.contains(wrong)), "{model}: {line}");
        }
        let report = desk.get("r/report.html");
        let shown =
            &report[report.find("<dl class=\"answers\">").expect("answers")..report.find("</dl>").expect("their end")];
        assert!(!shown.contains("−0") && !shown.contains("e−") && shown.contains("<b>0</b>"), "{shown}");
    }
}
