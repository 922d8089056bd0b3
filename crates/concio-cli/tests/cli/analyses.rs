//! Sensitivity, incremental analysis and dimensionless groups as they are typed.

use crate::support::Desk;

pub const SLIDING: &str = r#"model = "shear"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[joint]
bed = { law = "none" }
head = { law = "none" }
friction = { law = "coulomb", static = 0.2, dynamic = 0.2 }
[motion]
duration = "1.5 s"
base = { pulse = { shape = "rectangular", acceleration = "0.5 g", duration = "0.2 s" } }
"#;

pub const IDA: &str = r#"title = "Sliding"
wall = "sliding.toml"
[[motion]]
name = "rectangle"
base = { pulse = { shape = "rectangular", acceleration = "0.5 g", duration = "0.2 s" } }
[[motion]]
name = "half sine"
base = { pulse = { shape = "half-sine", acceleration = "0.5 g", duration = "0.2 s" } }
[[motion]]
name = "one sine"
base = { pulse = { shape = "one-sine", acceleration = "0.5 g", duration = "0.4 s" } }
[ida]
damage = "largest_slip"
limits = [{ name = "2 cm", value = "20 mm" }, { name = "5 cm", value = "50 mm" }]
collapse = "0.3 m"
hunt = { first = "0.15 g", step = "0.15 g", most = "2 g", runs = 8 }
"#;

/// What is no sample is told by check, run, table and report: a factor on a grid, and one motion, whose intervals have no ends.
#[test]
fn what_is_no_sample_is_told() {
    let desk = Desk::new();
    desk.put("sliding.toml", SLIDING);
    let friction = "[[vary]]\nname = \"mu\"\npath = \"joint.friction.static\"\nalso = [{ path = \"joint.friction.dynamic\", times = 1 }]\n";
    desk.put("grid.toml", format!("{IDA}{friction}values = [0.2, 0.25]\n"));
    let parts: Vec<&str> = IDA.split("[[motion]]").collect();
    let one = [parts[0], "[[motion]]", parts[1], &IDA[IDA.find("[ida]").unwrap_or_default()..]].concat();
    let drawn = format!("{one}\n[design]\nkind = \"random\"\nruns = 6\n{friction}from = 0.18\nto = 0.25\n");
    desk.put("one.toml", &drawn);
    for (file, told, line) in [
        ("grid", "`mu` are chosen, not drawn", "dispersion"),
        ("one", "the scatter between records is not in", "one motion: the intervals are those of the draws under it"),
    ] {
        let checked = desk.concio(&format!("study check {file}.toml")).assert().success().get_output().stderr.clone();
        assert!(String::from_utf8_lossy(&checked).contains(told), "{checked:?}");
        let run = desk.concio(&format!("study run {file}.toml --out {file}")).assert().success().get_output().clone();
        let [out, err] = [run.stdout, run.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
        assert!(err.contains(told) && out.contains(line), "{err} {out}");
        let page = desk.get(&format!("{file}/report.html"));
        assert!(page.contains(told), "{file}");
    }
    let fits = desk.get("one/fragility.csv");
    assert!(fits.contains("the scatter between records is not in them"), "{fits}");
}

#[test]
fn an_incremental_analysis_by_shards_is_that_of_one_process() {
    let desk = Desk::new();
    desk.put("sliding.toml", SLIDING);
    desk.put("ida.toml", IDA);
    let shown = desk.concio("study check ida.toml").assert().success().get_output().stdout.clone();
    let shown = String::from_utf8_lossy(&shown).into_owned();
    assert!(shown.contains("curves        3") && shown.contains("PGA [m/s²]"), "{shown}");
    let one = desk.concio("study run ida.toml --out one").assert().success().get_output().stdout.clone();
    let one = String::from_utf8_lossy(&one).into_owned();
    assert!(one.contains("2 cm (capacities): median") && one.contains("open one/report.html"), "{one}");
    desk.concio("study run ida.toml --out two --shard 1/2")
        .assert()
        .success()
        .stderr_eq("1 of 3 curves are left to other shards\n");
    desk.concio("study run ida.toml --out two --shard 2/2").assert().success();
    for name in ["ida.csv", "capacities.csv", "fractiles.csv", "fragility.csv", "fragility_curves.csv"] {
        assert_eq!(desk.get(&format!("one/{name}")), desk.get(&format!("two/{name}")), "{name}");
    }
    let lines = desk.get("one/ida.csv").lines().count();
    assert_eq!(lines, 1 + 3 * 8);
    assert!(
        desk.get("one/fragility.csv")
            .starts_with("limit,largest_slip [m],from,reached,between runs,not reached,median [m/s²],")
    );
    let capacities = desk.get("one/capacities.csv");
    assert!(
        capacities.starts_with(
            "curve,runs,highest run [m/s²],2 cm [m/s²],2 cm from [m/s²],2 cm to [m/s²],2 cm is,2 cm below again,"
        ),
        "{capacities}"
    );
    for name in ["ida", "fragility"] {
        assert!(
            desk.path(&format!("one/figures/{name}.svg")).is_file()
                && desk.path(&format!("one/{name}.parquet")).is_file()
        );
    }
    let report = desk.get("one/report.html");
    assert!(report.contains("<h2>Fragility</h2>") && report.contains("<h2>Incremental dynamic analysis</h2>"));
    desk.concio("study status ida.toml --out one").assert().success();
    desk.concio("study report ida.toml --out one").assert().success();
}

/// A hazard curve of the site makes annual rates, and one that is no curve is refused with its line.
#[test]
fn a_hazard_curve_makes_annual_rates() {
    let desk = Desk::new();
    desk.put("sliding.toml", SLIDING);
    let with = |hazard: &str| format!("{IDA}[ida.hazard]\n{hazard}\n");
    desk.put("ida.toml", with("intensities = [\"0.1 g\", \"0.4 g\", \"2 g\"]\nrates = [1e-2, 1e-3, 2e-5]"));
    let told = desk.concio("study run ida.toml --out one").assert().success().get_output().stdout.clone();
    let told = String::from_utf8_lossy(&told).into_owned();
    assert!(told.contains(" a year (") && told.contains(" % in 50 years"), "{told}");
    let head = desk.get("one/fragility.csv").lines().next().unwrap_or_default().to_string();
    assert!(
        head.contains(
            "annual rate [1/year],annual rate from [1/year],annual rate to [1/year],annual rate beyond [1/year]"
        ),
        "{head}"
    );
    for (hazard, says) in [
        ("intensities = [\"0.1 g\"]\nrates = [1e-2]", "1 intensities and 1 rates make no curve"),
        ("intensities = [\"0.4 g\", \"0.1 g\"]\nrates = [1e-2, 1e-3]", "does not lie above the one before it"),
        ("intensities = [\"0.1 g\", \"0.4 g\"]\nrates = [1e-3, 1e-2]", "0.01 is out of range"),
    ] {
        desk.put("ida.toml", with(hazard));
        let error = desk.concio("study check ida.toml").assert().code(2).get_output().stderr.clone();
        let error = String::from_utf8_lossy(&error).into_owned();
        assert!(error.contains(says) && error.contains("ida.toml:"), "{error}");
    }
}

const SENSITIVITY: &str = r#"wall = "sliding.toml"
design = { kind = "morris", runs = 4 }
[[vary]]
name = "friction"
path = "joint.friction.static"
from = 0.1
to = 0.3
also = [{ path = "joint.friction.dynamic", times = 1 }]
[[vary]]
path = "motion.base.pulse.acceleration"
from = "0.4 g"
to = "0.8 g"
[sensitivity]
of = ["largest_slip", "joints_cracked"]
"#;

#[test]
fn indices_are_tabled_and_drawn() {
    let desk = Desk::new();
    desk.put("sliding.toml", SLIDING);
    desk.put("s.toml", SENSITIVITY);
    desk.concio("study run s.toml --out out").assert().success();
    let table = desk.get("out/sensitivity.csv");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(
        lines[0],
        "measure,unit,factor,mu_star,mu_star_low,mu_star_high,sigma,sigma_low,sigma_high,mu,mu_low,mu_high,note"
    );
    assert_eq!(lines.len(), 5);
    assert!(
        lines[1].starts_with("largest_slip,m,friction,0.") && lines[3].starts_with("joints_cracked,,friction,0,0,0")
    );
    assert!(desk.get("out/report.html").contains("<h2>Sensitivity</h2>"));
    assert!(desk.path("out/figures/sensitivity.svg").is_file() && desk.path("out/sensitivity.parquet").is_file());
}

#[test]
fn wrong_questions_end_with_status_2_and_leave_nothing() {
    let desk = Desk::new();
    desk.put("sliding.toml", SLIDING);
    for (from, to, says) in [
        ("[\"largest_slip\", \"joints_cracked\"]", "[\"slips\"]", "s.toml:14:"),
        ("path = \"motion.base.pulse.acceleration\"", "path = \"group.mach\"", "there is no group `mach`"),
    ] {
        desk.put("s.toml", SENSITIVITY.replace(from, to));
        let output = desk.concio("study run s.toml --out out").assert().code(2).get_output().stderr.clone();
        let text = String::from_utf8_lossy(&output).into_owned();
        assert!(text.contains(says) && text.contains("allowed"), "{text}");
    }
    for (from, to, says) in
        [("damage = \"largest_slip\"", "damage = \"slip\"", "ida.toml:13:"), ("20 mm", "0 mm", "ida.toml:14:")]
    {
        desk.put("ida.toml", IDA.replace(from, to));
        let output = desk.concio("study run ida.toml --out out").assert().code(2).get_output().stderr.clone();
        assert!(String::from_utf8_lossy(&output).contains(says), "{}", String::from_utf8_lossy(&output));
    }
    assert_eq!(desk.list(), ["ida.toml", "s.toml", "sliding.toml", "wall.toml"]);
}

#[test]
fn groups_of_a_wall() {
    let desk = Desk::new();
    let text = desk.concio("scale wall.toml").assert().success().get_output().stdout.clone();
    let text = String::from_utf8_lossy(&text).into_owned();
    for part in ["M  3.028 kg", "normal_force", "δ_v/(Λ Ω)", "joint.friction.slip_velocity"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let json = desk.concio("scale wall.toml --json").assert().success().get_output().stdout.clone();
    let json: serde_json::Value = serde_json::from_slice(&json).expect("JSON");
    let group = |name: &str| {
        let groups = json["groups"].as_array().expect("groups");
        groups.iter().find(|g| g["name"] == name).expect("a group").clone()
    };
    // M = 18000 · 0.25 · 0.055 · 0.12/9.81 kg, K = 5.4e7 N/m, Λ = 0.25 m, δ_v = 1 mm/s.
    let omega = (5.4e7f64 / (18_000.0 * 0.25 * 0.055 * 0.12 / 9.81)).sqrt();
    let found = group("slip_velocity")["value"][0].as_f64().expect("a number");
    assert!((found * 0.25 * omega / 1e-3 - 1.0).abs() < 1e-12);
    assert_eq!(group("static")["value"][0], 0.6);
    let long = desk.concio("scale wall.toml --length 2.5m --json").assert().success().get_output().stdout.clone();
    let long: serde_json::Value = serde_json::from_slice(&long).expect("JSON");
    assert_eq!(long["reference"]["length"], 2.5);
    desk.concio("scale wall.toml --length 3").assert().code(2);
}

/// Names have no rank: table and terminal say that the regression is one without them, and how much it explains, with one
/// factor the square of its coefficient.
#[test]
fn a_rank_regression_says_what_it_explains_and_leaves_out() {
    let desk = Desk::new();
    desk.put("sliding.toml", SLIDING);
    let name =
        |n: usize| format!("{{ name = \"{n}\", set = {{ \"joint.friction.dynamic\" = {} }} }}", 0.2 - 0.02 * n as f64);
    let choices = (0..3).map(name).collect::<Vec<_>>().join(", ");
    let study = format!(
        "wall = \"sliding.toml\"\n[[vary]]\nname = \"case\"\nchoices = [{choices}]\n[[vary]]\nname = \"A\"\n\
         path = \"motion.base.pulse.acceleration\"\nfrom = \"0.5 g\"\nto = \"0.9 g\"\ncount = 5\n\
         [sensitivity]\nof = [\"largest_slip\"]\n"
    );
    desk.put("s.toml", study);
    let output = desk.concio("study run s.toml --out out").assert().success().get_output().stdout.clone();
    let table = desk.get("out/sensitivity.csv");
    let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines[0][5..], ["r_squared", "note"], "{table}");
    assert!(table.contains("its values are names"), "{table}");
    assert_eq!(lines[2][6], "of a regression without case", "{table}");
    let [coefficient, explained] = [2, 5].map(|k| lines[2][k].parse::<f64>().expect("a number"));
    assert!((explained - coefficient * coefficient).abs() < 1e-12 && explained > 0.5, "{table}");
    let percent = format!("the regression explains {:.0} %", 1e2 * explained);
    for text in [String::from_utf8_lossy(&output).into_owned(), desk.get("out/report.html")] {
        assert!(text.contains(&percent) && text.contains("it leaves out case, whose values have no order"), "{text}");
    }
}

/// Reversed motions are told by check and by the report; those that are one are refused.
#[test]
fn motions_that_resemble_each_other_are_told() {
    let desk = Desk::new();
    desk.put("sliding.toml", SLIDING);
    let second = "acceleration = \"0.5 g\", duration = \"0.2 s\" } }\n[[motion]]\nname = \"half sine\"";
    let other = |acceleration: &str| {
        let text = IDA.replacen(
            "shape = \"half-sine\", acceleration = \"0.5 g\"",
            &format!("shape = \"rectangular\", acceleration = \"{acceleration}\""),
            1,
        );
        assert!(text.contains(second));
        text
    };
    desk.put("s.toml", other("-0.5 g"));
    let told = "`rectangle` and `half sine` are one but for their sign";
    let checked = desk.concio("study check s.toml").assert().success().get_output().stderr.clone();
    assert!(String::from_utf8_lossy(&checked).contains(told));
    desk.concio("study run s.toml --out out").assert().success();
    assert!(desk.get("out/report.html").contains(told));
    desk.put("s.toml", other("0.7 g"));
    let refused = desk.concio("study check s.toml").assert().code(2).get_output().stderr.clone();
    let refused = String::from_utf8_lossy(&refused).into_owned();
    assert!(refused.contains("s.toml:8:") && refused.contains("are one motion once they are scaled"), "{refused}");
}
