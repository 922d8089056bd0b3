//! Walls that rock out of their plane, as a user types it.

use serde_json::Value;

use crate::support::Desk;

/// One metre of a wall that leans on side walls.
const WALL: &str = r#"title = "Leaning wall"
model = "rocking"

[[panel]]
bond = "stack"
courses = 8
bricks = 1
brick = { length = "1 m", height = "0.5 m", thickness = "0.4 m", specific_weight = "20 kN/m3" }
mortar = { bed = 0, head = 0 }

[joint]
bed = { law = "rigid" }
head = { law = "none" }
friction = { law = "coulomb", static = 0.6 }

[[out_of_plane.side_wall]]
x = 0
thickness = "0.3 m"
bonded = false

[motion]
base = { pulse = { shape = "one-sine", acceleration = "2 m/s2", duration = "0.8 s" } }
duration = "20 s"
"#;

fn text(desk: &Desk, line: &str) -> String {
    let done = desk.concio(line).assert().success();
    String::from_utf8_lossy(&done.get_output().stdout).into_owned()
}

fn refused(desk: &Desk, line: &str) -> String {
    let done = desk.concio(line).assert().code(2);
    String::from_utf8_lossy(&done.get_output().stderr).into_owned()
}

/// What pushes it pushes it out of its plane, not to the left or right.
#[test]
fn a_push_out_of_the_plane_has_no_side() {
    let desk = Desk::new();
    desk.put("wall.toml", WALL.replace("one-sine", "half-sine"));
    let told = text(&desk, "check wall.toml");
    assert!(told.contains("half-sine pulse") && !told.contains("pushes the wall to"), "{told}");
}

/// The starter is a wall whose run is the time history of `concio mechanisms`, in the files of other runs.
#[test]
fn the_starter_rocks_as_its_mechanism_does() {
    let desk = Desk::new();
    desk.concio("new facade.toml --model rocking").assert().success();
    let told = text(&desk, "check facade.toml");
    for part in ["overturning, hinge at 0 m", "at α = 0.0", "is a valid wall file"] {
        assert!(told.contains(part), "{part}:\n{told}");
    }
    let told = text(&desk, "run facade.toml --out out");
    for part in ["mechanism", "first lift-off", "peak turn", "energy residual"] {
        assert!(told.contains(part), "{part}:\n{told}");
    }
    let summary = desk.json("out/summary.json");
    let alone = desk.concio("mechanisms facade.toml --shaken --json").assert().success();
    let alone: Value = serde_json::from_slice(&alone.get_output().stdout).expect("JSON");
    let mechanisms = alone["time_history"]["mechanisms"].as_array().expect("mechanisms");
    let own = mechanisms.iter().find(|m| m["kind"] == "overturning").expect("the overturning");
    let sign =
        own["signs"].as_array().and_then(|signs| signs.iter().find(|s| s["positive"] == "inwards")).expect("a sign");
    let rocking = &summary["rocking"];
    assert_eq!((&summary["model"], &summary["unknowns"]), (&Value::from("rocking"), &Value::from(1)));
    for (name, expected) in [
        ("multiplier", &own["sets_off"]),
        ("restitution", &own["restitution"]),
        ("d0", &own["last_displacement"]),
        ("peak_over_d0", &sign["outwards"]["over_d0"]),
        ("first_lift_off", &sign["first_lift_off_time"]),
        ("impacts", &sign["impacts"]),
        ("beyond_d0", &sign["beyond_d0"]),
    ] {
        assert_eq!(&rocking[name], expected, "{name}");
    }
    assert!(rocking["peak_over_d0"].as_f64() > Some(0.0), "{rocking}");
    assert_eq!(summary["drift"]["displacement"], sign["outwards"]["displacement"]);
    assert!(summary["energy"]["residual_relative"].as_f64() < Some(1e-6), "{}", summary["energy"]);
    let page = desk.get("out/report.html");
    for part in ["peak turn", "rocking.positive", "Top of the wall"] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(desk.list().iter().filter(|name| name.as_str() == "out").count(), 1);
    // The same run gives the same result.
    let hash = |folder: &str| desk.json(&format!("{folder}/summary.json"))["rocking"].clone();
    desk.concio("run facade.toml --out again").assert().success();
    assert_eq!(hash("out"), hash("again"));
}

#[test]
fn what_a_rocking_file_lacks_or_what_else_takes_it_is_told() {
    let desk = Desk::new();
    let lacks = WALL.replace("[[out_of_plane.side_wall]]\nx = 0\nthickness = \"0.3 m\"\nbonded = false\n", "");
    desk.put("lacks.toml", &lacks);
    let told = refused(&desk, "run lacks.toml --out out");
    assert!(told.contains("lacks.toml:2") && told.contains("out_of_plane"), "{told}");
    assert!(!desk.list().contains(&"out".into()), "nothing is left");
    desk.put("beam.toml", WALL.replace("[motion]", "[load]\nbeam = \"tied\"\n\n[motion]"));
    let told = refused(&desk, "check beam.toml");
    assert!(told.contains("load.beam") && told.contains("out_of_plane.floor"), "{told}");
    desk.put("rocks.toml", WALL);
    let told = refused(&desk, "limit rocks.toml");
    assert!(told.contains("rocks.toml:2") && told.contains("concio mechanisms"), "{told}");
    let told = refused(&desk, "system rocks.toml");
    assert!(told.contains("rocking"), "{told}");
    desk.put(
        "levels.toml",
        WALL.replace("[motion]", "[rocking]\nmechanism = \"overturning\"\nhinge = 1.2\n\n[motion]"),
    );
    let told = refused(&desk, "check levels.toml");
    assert!(told.contains("the nearest are at 1 m and 1.5 m"), "{told}");
    let (still, _) = WALL.split_once("base = ").expect("a motion");
    desk.put("still.toml", still.to_string() + "duration = \"4 s\"\n");
    let done = desk.concio("run still.toml --out still").assert().success();
    let told = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(told.contains("motion.base is at rest") && !told.contains("acts in the direction"), "{told}");
}

/// A run says how strong its motion is, and of a fall that it ends there.
#[test]
fn a_run_tells_its_peak_and_its_end() {
    let desk = Desk::new();
    desk.put("rocks.toml", WALL.replace("2 m/s2", "6 m/s2"));
    let done = desk.concio("run rocks.toml --out out").assert().success();
    let out = done.get_output();
    let said = [&out.stdout, &out.stderr].map(|text| String::from_utf8_lossy(text).into_owned()).concat();
    for part in ["one-sine pulse, acceleration 6.000 m/s² = 0.6116 g", "the wall lies on the ground"] {
        assert!(said.contains(part), "{part}:\n{said}");
    }
    assert!(!said.contains("stop_at"), "{said}");
}

/// Both signs as a factor, fragilities with limits in parts of d0, and collapse.
#[test]
fn studies_take_rocking_walls() {
    let desk = Desk::new();
    desk.put("rocks.toml", WALL);
    desk.put(
        "sweep.toml",
        "wall = \"rocks.toml\"\nscales = [0.25, 0.75, 1.5, 3.0]\n[[vary]]\npath = \"rocking.positive\"\nvalues = [\"inwards\", \"outwards\"]\n",
    );
    desk.concio("study run sweep.toml --out sweep").assert().success();
    let table = desk.get("sweep/runs.csv");
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let head: Vec<&str> = lines.next().expect("a head").split(',').collect();
    let column =
        |name: &str| head.iter().position(|h| h.starts_with(name)).unwrap_or_else(|| panic!("{name}: {head:?}"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 8, "{table}");
    let (over, fell, lifts) = (column("peak_over_d0"), column("collapse"), column("first_lift_off"));
    let peaks: Vec<f64> = rows.iter().map(|row| row[over].parse().expect("a number")).collect();
    // 0.5 m/s² lift nothing off, 6 m/s² throw it over.
    let still = rows.iter().zip(&peaks).filter(|(row, peak)| row[lifts].is_empty() && **peak == 0.0).count();
    let fallen = rows.iter().zip(&peaks).filter(|(row, peak)| !row[fell].is_empty() && **peak > 1.0).count();
    assert!(still == 2 && fallen >= 2, "{table}");
    let motion = |k: usize, length: f64| {
        format!(
            "[[motion]]\nname = \"m{k}\"\nbase = {{ pulse = {{ shape = \"one-sine\", acceleration = \"1 m/s2\", duration = {length:?} }} }}\n"
        )
    };
    let motions: String = [0.6, 0.8, 1.0, 1.3].into_iter().enumerate().map(|(k, length)| motion(k, length)).collect();
    desk.put(
        "ida.toml",
        format!(
            "wall = \"rocks.toml\"\n{motions}[ida]\ndamage = \"peak_over_d0\"\n\
             limits = [{{ name = \"life\", value = 0.4 }}, {{ name = \"collapse prevention\", value = 0.6 }}]\n\
             hunt = {{ first = \"0.5 m/s2\", step = \"0.5 m/s2\", most = \"12 m/s2\" }}\n"
        ),
    );
    let told = text(&desk, "study run ida.toml --out ida");
    for part in ["life", "collapse prevention", "median"] {
        assert!(told.contains(part), "{part}:\n{told}");
    }
    // Before it lifts off at 0.1 g there is no damage; beyond the collapse of the pulse of 0.8 s, 0.2844 g with e = 0.4708, there is no standing.
    let runs = desk.get("ida/ida.csv");
    assert!(runs.contains("yes") && runs.contains("no"), "{runs}");
    // Limits in percent: what is found is the collapse.
    let percent = desk.get("ida.toml").replace("value = 0.4", "value = 40");
    desk.put("percent.toml", percent);
    let done = desk.concio("study run percent.toml --out percent").assert().success();
    let said = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    let told =
        "life: its limit is 40 d0, beyond which a wall falls: its capacity is that of collapse; did you mean 0.40?";
    assert!(said.contains(told) && !said.contains("prevention: its limit"), "{said}");
}

/// A strong tie lets what is above it turn alone: rows of another body are not to be compared in silence.
#[test]
fn a_study_whose_runs_follow_other_hinges_is_told() {
    let desk = Desk::new();
    let tied = WALL.replace("[motion]", "[[out_of_plane.anchor]]\nz = 3\nyield_force = \"1 kN\"\n\n[motion]");
    let rocks =
        |keys: &str| desk.put("rocks.toml", tied.replace("[motion]", &format!("[rocking]\n{keys}\n\n[motion]")));
    let said = |vary: &str| {
        desk.put("study.toml", format!("wall = \"rocks.toml\"\n{vary}"));
        let done = desk.concio("study check study.toml --out out").assert().success();
        String::from_utf8_lossy(&done.get_output().stderr).into_owned()
    };
    let forces = "[[vary]]\npath = \"out_of_plane.anchor[0].yield_force\"\nvalues = [\"1 kN\", \"2 kN\", \"100 kN\"]\n";
    let told = "warning: the runs do not follow one mechanism: run 1 (out_of_plane.anchor[0].yield_force = 1 kN) has overturning with its hinge at 0.00 m, \
                run 3 (out_of_plane.anchor[0].yield_force = 100 kN) has overturning with its hinge at 3.00 m, and their peaks are of different bodies";
    rocks("mechanism = \"overturning\"");
    let warned = said(forces);
    assert!(warned.contains(told) && warned.matches("do not follow").count() == 1, "{warned}");
    // The same body in another size, hinges that are asked for, and one that is held to.
    for fine in [
        "[[vary]]\npath = \"panel[0].brick.height\"\nvalues = [\"0.5 m\", \"0.45 m\"]\n",
        "[[vary]]\npath = \"rocking.hinge\"\nvalues = [0.0, 1.0]\n",
    ] {
        let warned = said(fine);
        assert!(!warned.contains("do not follow"), "{fine}: {warned}");
    }
    rocks("mechanism = \"overturning\"\nhinge = 0");
    assert!(!said(forces).contains("do not follow"));
}

/// First cracking is the first lift-off, which needs no run: g α0 over the peak of the motion.
#[test]
fn first_cracking_is_the_first_lift_off() {
    let desk = Desk::new();
    desk.put("rocks.toml", WALL);
    let told = text(&desk, "first-crack rocks.toml");
    // α0 = 0.1, the peak 2 m/s² = 0.2039 g: at 0.4905 of it.
    assert!(told.contains("0.4905"), "{told}");
    let told = refused(&desk, "first-crack rocks.toml --criterion opening");
    assert!(told.contains("lifts off"), "{told}");
}
