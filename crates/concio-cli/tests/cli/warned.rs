//! Warnings of runs reach whoever runs many of them.

use serde_json::Value;

use crate::support::Desk;

/// Eight courses of five bricks under a beam of 5 t, which weighs 49,050 N, shaken for a moment.
const WALL: &str = r#"title = "South wall"
model = "shear"
[[panel]]
bond = "running"
courses = 8
bricks = 5
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[joint]
damping_ratio = 0.05
bed = { law = "elastic", stiffness = "5.4e7 N/m" }
head = { law = "no-tension", stiffness = "5.4e7 N/m" }
friction = { law = "stribeck", static = 0.4, dynamic = 0.28, slip_velocity = "1 mm/s" }
[load]
top = "40 kN/m"
beam = { mass = "5 t" }
[motion]
duration = "50 ms"
base = { pulse = { shape = "one-sine", acceleration = "0.3 g", duration = "40 ms" } }
"#;

/// A load with a median of 10 kN/m, which brings some 12.9 kN to the 1.29 m of the top.
const STUDY: &str = r#"wall = "wall.toml"
[design]
kind = "latin-hypercube"
runs = 12
seed = 1
[[vary]]
name = "static friction"
path = "joint.friction.static"
from = 0.4
to = 0.8
also = [{ path = "joint.friction.dynamic", times = 0.7 }]
[[vary]]
path = "load.top"
distribution = { law = "lognormal", median = "10 kN/m", dispersion = 0.3 }
"#;

fn desk(study: &str) -> Desk {
    let desk = Desk::new();
    desk.put("wall.toml", WALL);
    desk.put("study.toml", study);
    desk
}

fn said(desk: &Desk, line: &str) -> [String; 2] {
    let done = desk.concio(line).assert().success();
    [&done.get_output().stdout, &done.get_output().stderr].map(|t| String::from_utf8_lossy(t).into_owned())
}

fn holds(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part}:\n{text}");
    }
}

/// The beam is too heavy for the load in every one of twelve runs, though not in the wall file: told before, counted after, in the table
/// and at the head of the report.
#[test]
fn a_warning_of_every_run_is_told_by_check_run_status_table_and_report() {
    let desk = desk(STUDY);
    let [_, of_wall] = said(&desk, "check wall.toml");
    assert_eq!(of_wall, "", "51,600 N of load are more than the beam");
    let [_, before] = said(&desk, "study check study.toml --out out");
    holds(
        &before,
        &[
            "warning: in every run, such as run 1 (static friction = ",
            "the beam weighs 49050 N but load.top brings only",
        ],
    );
    assert_eq!(before.matches("warning: ").count(), 1, "{before}");
    let [text, noted] = said(&desk, "study run study.toml --out out");
    holds(&text, &["warnings   in 12 of 12 runs (heavy-beam 12"]);
    // Once: it was told before the runs.
    assert_eq!(noted.matches("the beam weighs").count(), 1, "{noted}");
    let [text, noted] = said(&desk, "study status study.toml --out out");
    holds(&text, &["warnings   in 12 of 12 runs (heavy-beam 12"]);
    holds(&noted, &["warning: in every run, such as run 1 ("]);
    let table = desk.get("out/runs.csv");
    let heading: Vec<&str> = table.lines().next().expect("a heading").split(',').collect();
    let place = |name: &str| heading.iter().position(|h| *h == name).unwrap_or_else(|| panic!("{name}: {heading:?}"));
    for line in table.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        assert!(cells[place("warnings")].parse::<u32>().is_ok_and(|n| n >= 1), "{line}");
        assert!(cells[place("warning_kinds")].split(' ').any(|kind| kind == "heavy-beam"), "{line}");
    }
    assert_eq!(table.lines().count(), 13);
    let page = desk.get("out/report.html");
    let (head, rest) = page.split_once("<h2>").expect("sections");
    holds(head, &["with warnings</th><td>12</td>"]);
    holds(
        rest,
        &[
            "Warnings in 12 of 12 runs (heavy-beam 12",
            "read them before the results",
            "Warnings of the runs",
            "<td>heavy-beam</td>",
        ],
    );
    let parquet = std::fs::read(desk.path("out/runs.parquet")).expect("a table");
    assert!(parquet.windows(13).any(|w| w == b"warning_kinds"));
    // What is told of runs is kept with them, for whoever reads the folder.
    let part = desk.get("out/runs/part-0001.jsonl");
    let row: Value = serde_json::from_str(part.lines().next().expect("a run")).expect("JSON");
    assert_eq!(row["warnings"][0]["kind"], "heavy-beam");
}

/// Analyses that choose their runs themselves count too: first cracks, incremental analyses, of a wall file and of a study.
#[test]
fn analyses_that_choose_their_runs_count_their_warnings() {
    let light = WALL.replace("top = \"40 kN/m\"", "top = \"10 kN/m\"");
    let of = |rest: &str| {
        let desk = desk(&format!("wall = \"wall.toml\"\n{rest}"));
        desk.put("wall.toml", &light);
        desk
    };
    let motions = "[[motion]]\nname = \"a\"\nbase = { pulse = { shape = \"one-sine\", acceleration = \"0.3 g\", duration = \"40 ms\" } }\n";
    let desk =
        of(&format!("{motions}[first-crack]\ncriterion = \"slip\"\nlimit = \"1 um\"\nchecks = 0\ninterval = 0.5\n"));
    let [text, noted] = said(&desk, "study run study.toml --out out");
    holds(&text, &["warnings in ", "heavy-beam "]);
    assert_eq!(noted.matches("the beam weighs").count(), 1, "{noted}");
    let table = desk.get("out/first-crack-runs.csv");
    assert!(table.lines().next().is_some_and(|h| h.ends_with("warnings,warning_kinds")), "{table}");
    assert!(table.lines().skip(1).all(|line| line.contains("heavy-beam")), "{table}");
    let page = desk.get("out/report.html");
    holds(&page, &["runs with warnings", "Warnings in ", "<td>heavy-beam</td>"]);
    let [text, noted] =
        said(&desk, "first-crack wall.toml --criterion slip --limit 1um --checks 0 --interval 0.5 --out one");
    holds(&text, &["heavy-beam "]);
    assert_eq!(noted.matches("warning: in every run: load.beam.mass: the beam weighs").count(), 1, "{noted}");

    let desk = of(&format!(
        "{motions}[ida]\ndamage = \"largest_slip\"\nlimits = [{{ name = \"a\", value = \"1 mm\" }}]\nintensities = [\"0.1 g\", \"0.2 g\"]\n"
    ));
    let [text, _] = said(&desk, "study run study.toml --out out");
    holds(&text, &["warnings  in 2 of 2 runs (heavy-beam 2"]);
    assert!(desk.get("out/ida.csv").lines().skip(1).all(|line| line.contains("heavy-beam")));
    holds(&desk.get("out/report.html"), &["Warnings in 2 of 2 runs (heavy-beam 2"]);
    let [text, noted] = said(&desk, "study status study.toml --out out");
    holds(&text, &["heavy-beam 2"]);
    holds(&noted, &["warning: in every run: load.beam.mass: the beam weighs"]);
}

/// The three runs of `compare constrained`.
#[test]
fn compared_head_joints_tell_what_their_wall_warns_of() {
    let desk = desk("");
    desk.put("wall.toml", WALL.replace("top = \"40 kN/m\"", "top = \"10 kN/m\""));
    let [_, noted] = said(&desk, "compare constrained wall.toml --out c");
    assert_eq!(noted.matches("the beam weighs").count(), 1, "{noted}");
}

/// A run that cannot be made ready is told before hundreds are done.
#[test]
fn check_tells_which_run_will_fail() {
    let desk = desk(
        "wall = \"wall.toml\"\n[[vary]]\npath = \"motion.base\"\nvalues = [\n{ record = \"good.txt\" },\n{ record = \"bad.txt\" }]\n",
    );
    desk.put("good.txt", "# dt = 0.01 s, units: g\n0.0\n0.1\n-0.2\n0.0\n0.0\n0.0\n");
    desk.put("bad.txt", "# dt = 0.01 s, units: g\n0.0\n0.1\nnan\n");
    let [_, noted] = said(&desk, "study check study.toml --out out");
    holds(&noted, &["warning: run 2 (", "cannot be run: ", "bad.txt:4"]);
}
