//! Motions that are one, however the study file writes them.

use std::fmt::Write as _;

use concio::InputError;
use concio_study::{Plan, alike};

use crate::common::Desk;

const WALL: &str = r#"
model = "shear"
[[panel]]
bond = "stack"
courses = 2
bricks = 1
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[joint]
bed = { law = "elastic", stiffness = "5.4e7 N/m" }
head = { law = "no-tension", stiffness = "5.4e7 N/m", rigidity = 10 }
friction = { law = "stribeck", static = 0.3, dynamic = 0.3, slip_velocity = "1 mm/s" }
bond = { tensile_strength = "0.1 MPa", cohesion = "0.2 MPa" }
[motion]
duration = "6 s"
base = "none"
"#;

/// Samples of noise that rises and falls within four seconds, 10 ms apart, after so many of silence.
fn noise(seed: u64, silence: usize) -> String {
    let mut dice = concio::dice::Dice::new(seed);
    let rise = |k: usize| (k as f64 * 0.01 / 2.0) * (1.0 - (k as f64 * 0.01 / 2.0 - 1.0).powi(2)).max(0.0);
    let values: Vec<f64> = (0..=400).map(|k| rise(k) * (2.0 * dice.unit() - 1.0)).collect();
    let mut text = "t [s],a [m/s2]\n".to_string();
    let all = std::iter::repeat_n(0.0, silence).chain(values);
    all.enumerate().for_each(|(k, a)| {
        let _ = writeln!(text, "{:.2},{a:.9}", k as f64 * 0.01);
    });
    text
}

fn desk() -> Desk {
    let desk = Desk::new(WALL);
    for (name, seed, silence) in [("a.csv", 1, 0), ("b.csv", 2, 0), ("late.csv", 1, 137)] {
        std::fs::write(desk.path(name), noise(seed, silence)).expect("a record");
    }
    desk
}

const IDA: &str =
    "[ida]\ndamage = \"peak_displacement\"\nlimits = [{ name = \"d\", value = \"5 mm\" }]\nintensities = [\"0.1 g\"]\n";
const CRACKS: &str = "[cracks]\ncriterion = \"bond\"\n";
const FIRST: &str = "[first-crack]\ncriterion = \"bond\"\n";
const RECORD: &str = "record = \"a.csv\"";

/// A study of two motions, the second on line 6 of the file.
fn study(question: &str, second: [&str; 2]) -> String {
    let [base, more] = second;
    format!(
        "wall = \"wall.toml\"\n[[motion]]\nname = \"m1\"\nbase = {{ {RECORD} }}\n[[motion]]\nbase = {{ {base} }}\nname = \"m2\"\n{more}\n{question}"
    )
}

fn refused(desk: &Desk, study: &str) -> Option<InputError> {
    match desk.plan(study) {
        Err(concio::Error::Input(e)) => Some(*e),
        Err(other) => panic!("{other}"),
        Ok(_) => None,
    }
}

/// What is one motion to an incremental analysis is refused with the line of the second; what is not, is not.
#[test]
fn an_incremental_analysis_tells_one_motion_however_it_is_written() {
    let desk = desk();
    for second in [
        ["record = \"a.csv\"", ""],
        ["record = \"a.csv\", pga = \"0.5 g\"", ""],
        ["record = \"a.csv\", scale = 3", ""],
        ["record = \"a.csv\", resample = \"5 ms\"", ""],
        ["record = \"a.csv\", resample = \"5 ms\", pga = 1", ""],
        ["record = \"a.csv\", baseline = { polynomial = 0 }", ""],
        ["record = \"a.csv\", trim = [\"0 s\", \"3.5 s\"]", ""],
        ["record = \"a.csv\", trim = [\"0.313 s\", \"3.6 s\"]", ""],
        ["record = \"late.csv\"", ""],
        ["record = \"late.csv\", resample = \"5 ms\", scale = 2", ""],
    ] {
        let error = refused(&desk, &study(IDA, second)).unwrap_or_else(|| panic!("{second:?} passes"));
        assert_eq!((error.key.as_deref(), error.line), (Some("motion[1].base"), Some(6)), "{second:?}: {error}");
        assert!(error.what.contains("`m1` and `m2` are one motion"), "{error}");
        assert!(error.file.is_some_and(|f| f.ends_with("study.toml")));
    }
    // Runs that end at other times may be meant to be compared: told, and run.
    for length in ["3.5 s", "9 s"] {
        let plan = desk.plan(&study(IDA, ["record = \"a.csv\"", &format!("duration = \"{length}\"")])).expect("a plan");
        assert!(plan.doubts.iter().any(|doubt| doubt.contains("`m1` and `m2` are one")), "{:?}", plan.doubts);
    }
    for second in ["record = \"b.csv\"", "record = \"a.csv\", reverse = true"] {
        let plan = desk.plan(&study(IDA, [second, ""])).expect("two motions");
        assert!(plan.doubts.is_empty(), "{second}: {:?}", plan.doubts);
    }
    let drawn = format!(
        "design = {{ kind = \"latin-hypercube\", runs = 8 }}\n{}",
        study(IDA, ["record = \"a.csv\", pga = 1", ""])
    );
    assert!(refused(&desk, &drawn).is_some_and(|e| e.line == Some(7)));
}

/// Reversed, or filtered: told, not refused.
#[test]
fn what_resembles_a_motion_is_told() -> concio::Result<()> {
    let desk = desk();
    let plan = desk.plan(&study(IDA, ["record = \"a.csv\", scale = -2", ""]))?;
    assert!(
        plan.doubts.len() == 1 && plan.doubts[0].contains("`m1` and `m2` are one but for their sign"),
        "{:?}",
        plan.doubts
    );
    let [pair] = alike::pairs(&plan)[..] else { panic!("one pair") };
    assert!((pair.factor + 2.0).abs() < 1e-8 && pair.correlation > 1.0 - 1e-12, "{pair:?}");
    let filtered = "record = \"a.csv\", baseline = { high_pass = \"0.5 Hz\" }";
    let plan = desk.plan(&study(IDA, [filtered, ""]))?;
    assert!(
        plan.doubts.len() == 1 && plan.doubts[0].contains("resemble each other with a correlation of 9"),
        "{:?}",
        plan.doubts
    );
    Ok(())
}

/// Pulses are compared by their numbers: durations that differ in the sixth digit are two motions.
#[test]
fn closed_forms_are_one_but_for_strength_and_start() {
    let desk = desk();
    let pulse = |a: &str, more: &str| format!("pulse = {{ shape = \"half-sine\", acceleration = \"{a}\", {more} }}");
    let of = |second: &str| {
        let text = study(IDA, [second, ""]).replacen(RECORD, &pulse("0.5 g", "duration = \"0.2 s\""), 1);
        desk.plan(&text.replace("base = {", "duration = \"1 s\"\nbase = {")).map(|plan: Plan| plan.doubts)
    };
    assert!(of(&pulse("0.3 g", "duration = \"0.2 s\", start = \"0.1 s\"")).is_err());
    assert!(of(&pulse("-0.5 g", "duration = \"0.2 s\"")).is_ok_and(|d| d.len() == 1));
    assert!(of(&pulse("0.5 g", "duration = \"0.200001 s\"")).is_ok_and(|d| d.is_empty()));
}

/// Without scaling, motions of two strengths are two, of which is told where they are taken as independent.
#[test]
fn every_question_that_counts_motions_refuses_one_that_is_there_twice() {
    let desk = desk();
    for question in [CRACKS, FIRST, "[ranking]\n", "[sensitivity]\nof = [\"peak_displacement\"]\n"] {
        let error = refused(&desk, &study(question, [RECORD, ""])).expect("an error");
        assert!(error.line == Some(6) && error.what.contains("it would count twice"), "{question}: {error}");
        let plan = desk.plan(&study(question, ["record = \"a.csv\", scale = 2", ""])).expect("a plan");
        let told = question == CRACKS || question == FIRST;
        assert_eq!(plan.doubts.iter().filter(|d| d.contains("one but for their strength")).count(), usize::from(told));
    }
    // Without a question nothing counts; each motion of a list may have a wall of its own.
    assert!(desk.plan(&study("", [RECORD, ""])).is_ok_and(|plan| plan.doubts.is_empty()));
    let own = "[[vary]]\npath = \"joint.friction.static\"\nvalues = [0.2, 0.4]\n[design]\nkind = \"list\"\n";
    let plan = desk.plan(&study(&format!("{own}{FIRST}"), [RECORD, ""])).expect("two walls");
    assert!(plan.doubts.len() == 1 && plan.doubts[0].contains("are one:"), "{:?}", plan.doubts);
}

#[test]
fn a_held_out_motion_is_none_that_the_search_knows() {
    let desk = desk();
    let search = "[interfaces]\ncount = 1\nruns = 60\npopulation = 6\n[[interfaces.objective]]\nmeasure = \"peak_drift\"\n\
                  [[interfaces.device]]\nname = \"d\"\nchange = { device = { law = \"viscous\", damping = \"10 kN s/m\" } }\n";
    let error = refused(&desk, &study(search, [RECORD, "held_out = true"])).expect("an error");
    assert!(error.line == Some(6) && error.what.contains("known to the search"), "{error}");
    let plan = desk.plan(&study(search, ["record = \"a.csv\", scale = 2", "held_out = true"])).expect("a plan");
    assert_eq!(plan.doubts.len(), 1);
    let plan = desk.plan(&study(search, ["record = \"b.csv\"", "held_out = true"])).expect("a plan");
    assert!(plan.doubts.is_empty());
}

/// Curves of designs that take values again are no independent draws.
#[test]
fn incremental_analyses_draw_independently() {
    let desk = desk();
    for kind in ["sobol", "morris"] {
        let design = format!("design = {{ kind = \"{kind}\", runs = 4 }}\n{}", study(IDA, ["record = \"b.csv\"", ""]));
        let error = refused(&desk, &design).expect("an error");
        assert!(error.key.as_deref() == Some("design.kind") && error.line == Some(1), "{error}");
    }
}
