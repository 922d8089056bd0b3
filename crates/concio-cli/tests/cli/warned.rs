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

/// What only the way shows in which the wall file writes a number counts in the table as it does in the account.
#[test]
fn doubts_of_units_are_in_the_table() {
    let desk = desk("wall = \"wall.toml\"\n[[vary]]\npath = \"joint.friction.static\"\nvalues = [0.4, 0.6]\n");
    let base = "base = { synthetic = { seed = 1, pga = 0.3, duration = \"3 s\", dt = \"5 ms\" } }";
    let shaken: String =
        WALL.lines().map(|l| if l.starts_with("base = ") { base } else { l }.to_string() + "\n").collect();
    desk.put("wall.toml", &shaken);
    let [text, _] = said(&desk, "study run study.toml --out out");
    holds(&text, &["unlikely-number 2"]);
    let table = desk.get("out/runs.csv");
    let heading: Vec<&str> = table.lines().next().expect("a heading").split(',').collect();
    let place = |name: &str| heading.iter().position(|h| *h == name).unwrap_or_else(|| panic!("{name}: {heading:?}"));
    for line in table.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        assert!(cells[place("warning_kinds")].split(' ').any(|kind| kind == "unlikely-number"), "{line}");
        assert!(
            cells[place("warnings")]
                .parse::<usize>()
                .is_ok_and(|n| n >= cells[place("warning_kinds")].split(' ').count()),
            "{line}"
        );
    }
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

/// What a wall file is asked about, a study is: in values, choices, draws and motions.
#[test]
fn accelerations_without_a_unit_are_asked_about_in_studies() {
    let pulse = "base = { pulse = { shape = \"one-sine\", acceleration = \"0.1 g\", duration = \"40 ms\" } }";
    let motion = |name: &str, a: &str| {
        format!("[[motion]]\nname = \"{name}\"\nduration = \"50 ms\"\n{}\n", pulse.replace("\"0.1 g\"", a))
    };
    let key = "motion.base.pulse.acceleration";
    let vary = |over: &str| format!("[[vary]]\npath = \"{key}\"\n{over}\n");
    let draws = "[design]\nkind = \"random\"\nruns = 2\n";
    let asked = format!("{key} is 0.2 m/s2, a number without a unit; did you mean \"0.2 g\"?");
    for (study, says) in [
        (vary("values = [0.2, 0.4]"), Some(&*asked)),
        (
            format!("[[vary]]\nname = \"a\"\nchoices = [{{ name = \"x\", set = {{ \"{key}\" = 0.2 }} }}]\n"),
            Some(&*asked),
        ),
        (
            format!("{draws}{}", vary("distribution = { law = \"uniform\", low = 0.2, high = 0.4 }")),
            Some("a number without a unit"),
        ),
        (motion("a", "0.2") + &motion("b", "\"0.7 g\""), Some(&*asked)),
        // With a unit it is meant, however small it is in SI; so is a large number.
        (vary("values = [\"0.02 g\", \"0.04 g\"]"), None),
        (vary("values = [2, 4]"), None),
        (motion("a", "\"0.1 g\""), None),
    ] {
        let desk = desk(&format!("wall = \"wall.toml\"\n{study}"));
        let [_, told] = said(&desk, "study check study.toml");
        let Some(says) = says else {
            assert!(!told.contains("without a unit"), "{study}: {told}");
            continue;
        };
        holds(&told, &[says]);
        // No line of the wall file says it.
        assert!(!told.contains("wall.toml:"), "{told}");
        if says == asked && study.starts_with("[[vary]]\npath") {
            let [told, notes] = said(&desk, "study run study.toml --out out");
            holds(&notes, &[says]);
            holds(&told, &["unlikely-number 2"]);
            holds(&desk.get("out/report.html"), &["a number without a unit", "motion.base.pulse.acceleration [m/s²]"]);
            assert!(desk.get("out/runs.csv").contains("motion.base.pulse.acceleration [m/s²]"));
        }
    }
}

/// Numbers of `[ida]` without a unit, and what chosen factors are not asked about.
#[test]
fn numbers_of_an_incremental_analysis_are_asked_about() {
    let motion = "[[motion]]\nname = \"a\"\nduration = \"50 ms\"\n\
                  base = { pulse = { shape = \"one-sine\", acceleration = 0.1, duration = \"40 ms\" } }\n";
    let of = |damage: &str, limit: &str, rest: &str| {
        format!(
            "wall = \"wall.toml\"\n{motion}[ida]\ndamage = \"{damage}\"\nlimits = [{{ name = \"L\", value = {limit} }}]\n{rest}\n"
        )
    };
    let g = "intensities = [\"0.2 g\", \"0.6 g\"]";
    for (study, says) in [
        (of("peak_displacement", "10", g), "ida.limits[0].value is 10 m, more than 0.5 m; did you mean \"10 mm\"?"),
        (of("peak_drift", "1", g), "ida.limits[0].value is 1, more than 0.2: a drift of 100 %; did you mean 0.01?"),
        (
            of("peak_drift", "0.01", "intensities = [0.2, 0.6]"),
            "ida.intensities go up to 0.6 m/s2, numbers without a unit; did you mean \"0.6 g\"",
        ),
        (
            of("peak_drift", "0.01", "hunt = { first = 0.1, step = 0.1, most = 2 }"),
            "ida.hunt.first, step and most go up to 2 m/s2",
        ),
        (
            of("peak_drift", "0.01", &format!("intensity = \"sa\"\nperiod = 300\n{g}")),
            "ida.period is 300 s, more than 10 s; did you mean \"300 ms\"?",
        ),
        (
            of("peak_drift", "0.01", "intensity = \"pgv\"\nintensities = [10, 20]"),
            "the largest of ida.intensities is 20 m/s, more than 4 m/s; did you mean \"20 cm/s\"?",
        ),
    ] {
        let [_, told] = said(&desk(&study), "study check study.toml");
        holds(&told, &[says]);
    }
    for study in [
        of("peak_drift", "1.0", g).replace("limits = [{", "limits = [{ name = \"l\", value = \"0.5 %\" }, {"),
        of("peak_drift", "\"1 %\"", g),
        of("peak_displacement", "\"1 m\"", g),
        of("peak_drift", "0.02", "intensities = [2, 6]"),
    ] {
        let [told, notes] = said(&desk(&study), "study check study.toml");
        assert!(!notes.contains("did you mean"), "{notes}");
        holds(&told, &["damage", "L ("]);
    }
    // In per cent, and with what the measure is beside what a run tells.
    let [told, _] = said(&desk(&of("peak_drift", "\"1 %\"", g)), "study check study.toml");
    holds(&told, &["L (0.01)\n", "`concio run` tells that of the beam or the mean of the course"]);
}

/// A record of 1 m/s² is brought to 9.81 m/s² by a factor that the analysis chose.
#[test]
fn a_factor_that_an_analysis_chose_is_not_asked_about() {
    let study = "wall = \"wall.toml\"\n[[motion]]\nname = \"a\"\nbase = { record = \"a.txt\", units = \"m/s2\" }\n[ida]\n\
                 damage = \"peak_drift\"\nlimits = [{ name = \"L\", value = 0.01 }]\nintensities = [\"1 g\"]\n";
    let desk = desk(study);
    let sample = |k: usize| (k as f64 * 0.3).sin() * (-(k as f64 - 5.236).powi(2) / 100.0).exp();
    let most = (0..60).map(|k| sample(k).abs()).fold(0.0, f64::max);
    let lines: String = (0..60).map(|k| format!("{} {}\n", k as f64 * 0.02, sample(k) / most)).collect();
    desk.put("a.txt", lines);
    let [found, told] = said(&desk, "study run study.toml --out out");
    // A single curve determines no fragility; what it found is told.
    holds(
        &found,
        &["L (capacities): not reached up to 9.810 m/s² by the one curve; a fragility is fitted to two or more"],
    );
    assert!(!told.contains("conversion to or from g"), "{told}");
    assert!(desk.get("out/ida.csv").contains("9.8"), "{}", desk.get("out/ida.csv"));
    // Tables of another question are told of and stay.
    desk.put("plain.toml", "wall = \"wall.toml\"\n[[vary]]\npath = \"joint.friction.static\"\nvalues = [0.4]\n");
    let [_, told] = said(&desk, "study run plain.toml --out out");
    holds(
        &told,
        &[
            "ida.csv, capacities.csv, fragility.csv, fragility_curves.csv, fractiles.csv in out are of an earlier question",
        ],
    );
    assert!(desk.get("out/ida.csv").contains("9.8"));
    // And a path with a step too many is told the other.
    desk.put("path.toml", "wall = \"wall.toml\"\n[[vary]]\npath = \"motion.base.record.pga\"\nvalues = [\"0.3 g\"]\n");
    let done = desk.concio("study check path.toml").assert().failure();
    holds(&String::from_utf8_lossy(&done.get_output().stderr), &["did you mean the path `motion.base.pga`?"]);
}
