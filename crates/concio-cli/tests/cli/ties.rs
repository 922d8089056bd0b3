//! Walls with tie rods, run as a user runs them.

use serde_json::Value;

use crate::support::Desk;

/// A block of 5 kN with μ = 0.4 that a push of 0.7 of its weight would move, held by a rod.
const WALL: &str = r#"
model = "planar"
[[panel]]
bond = "explicit"
block = [{ id = "stone", course = 1, x = 0, y = 0, length = 1, height = 0.25 }]
brick = { length = 1, height = 0.25, thickness = 1, specific_weight = 20e3 }
[joint]
bed = { law = "rigid" }
head = { law = "rigid" }
friction = { law = "coulomb", static = 0.4, dynamic = 0.4 }
[[tie]]
from = "base"
at = [-2, 0.125]
to = "stone"
to_at = [-0.5, 0]
stiffness = "5 MN/m"
[motion]
duration = "1 s"
quasi_static = true
base = { tilt = { acceleration = "-0.7 g", rise = "0.5 s" } }
"#;

#[test]
fn a_run_tells_what_its_rods_bore() {
    let desk = Desk::new();
    desk.put("tied.toml", WALL);
    let done = desk.concio("run tied.toml --out tied").assert().success();
    let output = done.get_output();
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(text.contains("at most, in that from base to stone; 0 of 1 yielded"), "{text}");
    assert!(!text.contains("left out"), "{text}");
    let tie = &desk.json("tied/summary.json")["ties"][0];
    let force = tie["peak_force"].as_f64().expect("a force");
    assert!((force - 0.3 * 5e3).abs() < 1.0, "{tie}");
    assert!(tie["yielded"].is_null(), "{tie}");
    desk.concio("export tied --csv").assert().success();
    let rows = desk.get("tied/csv/ties.csv");
    assert!(rows.starts_with("from,to,force [N],stretch [m],yielded [s]\nbase,stone,1"), "{rows}");
}

#[test]
fn check_tells_rods_and_joints() {
    let desk = Desk::new();
    desk.put("tied.toml", WALL.replace("stiffness = \"5 MN/m\"", "stiffness = \"5 MN/m\"\nyield_force = \"2 kN\""));
    let done = desk.concio("check tied.toml --svg tied.svg").assert().success();
    let drawing = desk.get("tied.svg");
    assert!(drawing.contains("<title>tie 1</title>") && drawing.contains("tie (1)"), "{drawing}");
    let text = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
    let row = |start: &str| {
        let line = text
            .lines()
            .map(str::trim_start)
            .find(|l| l.starts_with(start))
            .unwrap_or_else(|| panic!("{start}: {text}"));
        line.split_whitespace().map(String::from).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(row("joints"), "joints number pressed sheared friction crushed by");
    assert_eq!(row("base "), "base 1 rigid, e = 0 – 0.400 –");
    assert_eq!(row("ties"), "ties from at to at length stiffness yields at");
    assert_eq!(row("1 "), "1 base -2.000, 0.125 m stone 0.000, 0.125 m 2.000 m 5.000 MN/m 2.000 kN");
    // A base that goes to the left leaves the stone behind to its right; the rod is on its left side alone.
    assert!(text.contains("pushes the wall to the right; it is not symmetric: run the other sign too\n"), "{text}");
    // A rod on either side, of one kind; then the second stiffer, stronger, or slack.
    let both = |of_second: &str| {
        let second = format!(
            "[[tie]]\nfrom = \"base\"\nat = [3, 0.125]\nto = \"stone\"\nto_at = [0.5, 0]\n{of_second}\n[motion]"
        );
        desk.put("tied.toml", WALL.replace("[motion]", &second).replace("\"-0.7 g\"", "\"0.7 g\""));
        let said = desk.concio("check tied.toml").assert().success().get_output().stdout.clone();
        String::from_utf8_lossy(&said).contains("pushes the wall to the left\n")
    };
    assert!(both("stiffness = \"5 MN/m\""));
    for other in [
        "stiffness = \"6 MN/m\"",
        "stiffness = \"5 MN/m\"\nyield_force = \"2 kN\"",
        "stiffness = \"5 MN/m\"\nslack = \"1 mm\"",
    ] {
        assert!(!both(other), "{other}");
    }
}

/// A stone alone, two stones side by side, and what makes a push to one side another than one to the other.
#[test]
fn check_says_whether_the_other_sign_is_another_push() {
    let desk = Desk::new();
    let (head, rest) = WALL.split_once("[[tie]]").expect("a tie");
    let (_, motion) = rest.split_once("[motion]").expect("a motion");
    // Forces act on walls with inertia.
    let motion = motion.replace("quasi_static = true\n", "");
    let pushed = |head: &str, more: &str| {
        desk.put("wall.toml", format!("{head}{more}\n[motion]{motion}"));
        let said = desk.concio("check wall.toml").assert().success().get_output().stdout.clone();
        let said = String::from_utf8_lossy(&said).into_owned();
        said.lines().find_map(|line| Some(line.split_once("pushes the wall to the right")?.1.to_string()))
    };
    let (same, other) = (Some(String::new()), Some("; it is not symmetric: run the other sign too".to_string()));
    let panel = |weight: f64, thickness: f64| {
        format!(
            "[[panel]]\nbond = \"stack\"\ncourses = 1\nbricks = 1\nmortar = {{ bed = 0, head = 0 }}\n\
             brick = {{ length = 1, height = 0.25, thickness = {thickness}, specific_weight = {weight} }}\n"
        )
    };
    let two = |weight: f64, thickness: f64| {
        let joints = head.split_once("[joint]").expect("joints").1;
        format!(
            "model = \"planar\"\n{}{}[joint]{joints}",
            panel(20e3, 1.0),
            panel(weight, thickness) + "connection = 0.01\n"
        )
    };
    assert_eq!(pushed(head, ""), same);
    assert_eq!(pushed(head, "[[force]]\nblock = \"stone\"\nx = [100]"), other);
    assert_eq!(
        [pushed(&two(20e3, 1.0), ""), pushed(&two(21e3, 1.0), ""), pushed(&two(20e3, 0.9), "")],
        [same.clone(), other.clone(), other.clone()]
    );
    let changed = |at: &str| pushed(head, &format!("[[joint.change]]\nat = {{ {at} }}\nfriction = {{ static = 0.5 }}"));
    assert_eq!(
        [changed("region = [0, -1, 0.6, 1]"), changed("kind = [\"base\"]"), changed("region = [-9, -9, 9, 9]")],
        [other, same.clone(), same]
    );
    desk.put("wall.toml", WALL.replace("\"-0.7 g\"", "0"));
    let said = desk.concio("check wall.toml").assert().success().get_output().stdout.clone();
    assert!(!String::from_utf8_lossy(&said).contains("pushes the wall"));
}

#[test]
fn limit_analysis_says_that_it_leaves_rods_out() {
    let desk = Desk::new();
    desk.put("tied.toml", WALL);
    let done = desk.concio("limit tied.toml").assert().success();
    let [said, told] =
        [&done.get_output().stdout, &done.get_output().stderr].map(|s| String::from_utf8_lossy(s).into_owned());
    assert!(told.contains("the ties are left out"), "{told}");
    assert!(said.contains(" for associative friction, without the ties\n"), "{said}");
    desk.concio("limit tied.toml --out found").assert().success();
    let found: Value = serde_json::from_str(&desk.get("found/limit.json")).expect("JSON");
    assert_eq!(found["left_out"], serde_json::json!(["ties"]));
}
