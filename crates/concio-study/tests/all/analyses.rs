//! Wrong questions: file, line, cause, what is allowed.

use crate::common::Desk;

const MOTION: &str = "[[motion]]\nname = \"a\"\nbase = { sine = { acceleration = \"0.3 g\", frequency = 3 } }\n\
                      duration = \"1 s\"\n";
const VARY: &str = "[[vary]]\npath = \"joint.friction.static\"\nvalues = [0.5, 0.6]\n";

/// The message about a study file with these lines below `wall = …`.
fn refused(text: &str) -> String {
    let desk = Desk::new(include_str!("../../../concio/tests/data/shear-panel.toml"));
    match desk.plan(&format!("wall = \"wall.toml\"\n{text}")) {
        Ok(_) => "was taken".into(),
        Err(e) => e.to_string(),
    }
}

fn says(text: &str, line: usize, parts: &[&str]) {
    let message = refused(text);
    assert!(message.contains(&format!("study.toml:{line}:")), "{line}: {message}");
    assert!(parts.iter().all(|part| message.contains(part)), "{parts:?}: {message}");
}

#[test]
fn sensitivity_of_nothing() {
    says(&format!("{VARY}[sensitivity]\nof = [\"peak_drifts\"]\n"), 6, &["`peak_drifts`", "peak_drift, "]);
    says(
        &format!("{VARY}[sensitivity]\nof = [\"peak_over_d0\"]\n"),
        6,
        &["shear walls have no `peak_over_d0`", "peak_drift, "],
    );
    says(&format!("{VARY}[sensitivity]\nof = []\n"), 6, &["no measure is named"]);
    says("[sensitivity]\nof = [\"peak_drift\"]\n", 2, &["nothing varies", "[[vary]]"]);
    says(&format!("{VARY}[sensitivity]\nof = [\"peak_drift\"]\nconfidence = 1.0\n"), 7, &["between 0 and 1"]);
}

/// Trajectories need two values of every factor, and ends to go to.
#[test]
fn trajectories_that_cannot_be() {
    let morris = "[design]\nkind = \"morris\"\nruns = 3\n";
    let load = |rest: &str| format!("{morris}{VARY}[[vary]]\npath = \"load.top\"\n{rest}\n");
    let bell = |law: &str| load(&format!("distribution = {{ law = {law} }}"));
    says(&load("values = [\"10 kN/m\"]"), 8, &["`load.top` has one value", "two values or more"]);
    says(&format!("{morris}{VARY}{MOTION}"), 8, &["`motion` has one value"]);
    for law in [
        "\"normal\", mean = 1e4, deviation = 1e3",
        "\"normal\", mean = 1e4, deviation = 1e3, low = 0",
        "\"lognormal\", median = 1e4, dispersion = 0.3, low = 5e3",
        "\"lognormal\", median = 1e4, dispersion = 0.3, low = 0, high = 2e4",
    ] {
        says(&bell(law), 10, &["`load.top` is not cut off on both sides", "4.75", "`low` and `high`"]);
    }
    assert_eq!(refused(&bell("\"normal\", mean = 1e4, deviation = 1e3, low = 8e3, high = 1.2e4")), "was taken");
    // Draws do not go to the ends.
    let drawn = bell("\"normal\", mean = 1e4, deviation = 1e3").replace("morris", "random");
    assert_eq!(refused(&drawn), "was taken");
}

#[test]
fn names_that_are_columns_already() {
    for name in ["run", "peak_drift", "end", "id", "cause", "dissipated_energy"] {
        says(&VARY.replace("path", &format!("name = \"{name}\"\npath")), 3, &[name, "column", "another `name`"]);
    }
    says(&format!("scales = [1, 2]\n{}", VARY.replace("path", "name = \"scale\"\npath")), 2, &["two factors"]);
}

#[test]
fn analyses_that_have_no_answer() {
    let ida = |text: &str| format!("{MOTION}[ida]\n{text}");
    let limits = "limits = [{ name = \"a\", value = \"1 mm\" }]\n";
    let damage = "damage = \"largest_slip\"\n";
    let list = "intensities = [\"0.2 g\", \"0.4 g\"]\n";
    assert_eq!(refused(&ida(&format!("{damage}{limits}{list}"))), "was taken");
    says(&format!("[ida]\n{damage}{limits}{list}"), 2, &["no motions", "[[motion]]"]);
    says(&ida(&format!("{damage}limits = []\n{list}")), 8, &["no limit states"]);
    let zero = limits.replace("1 mm", "0 mm");
    says(&ida(&format!("{damage}{zero}{list}")), 8, &["limits[0].value", "above 0"]);
    let wrong = limits.replace("1 mm", "1 kg");
    says(&ida(&format!("{damage}{wrong}{list}")), 8, &["limits[0].value", "in m"]);
    says(&ida(&format!("damage = \"slippage\"\n{limits}{list}")), 7, &["`slippage`", "largest_slip"]);
    says(&ida(&format!("damage = \"first_crack\"\n{limits}{list}")), 7, &["no measure of damage"]);
    let rocks = "damage = \"peak_over_d0\"\n";
    says(&ida(&format!("{rocks}{limits}{list}")), 7, &["shear walls have no `peak_over_d0`", "peak_viscous_force"]);
    says(&ida(&format!("{damage}{limits}")), 6, &["`intensities`", "`hunt`"]);
    says(&ida(&format!("{damage}{limits}intensities = [0.4, 0.2]\n")), 9, &["rising"]);
    says(&ida(&format!("{damage}{limits}intensities = [-1]\n")), 9, &["above 0"]);
    let hunt = "hunt = { first = 1, step = 1, most = 0.5 }\n";
    says(&ida(&format!("{damage}{limits}{hunt}")), 9, &["hunt.most", "above `first`"]);
    says(&ida(&format!("{damage}{limits}{list}{hunt}")), 10, &["contradict"]);
    says(&ida(&format!("{damage}{limits}{list}intensity = \"sa\"\n")), 6, &["period", "above 0 s"]);
    says(&ida(&format!("{damage}{limits}{list}collapse = 1e-4\n")), 8, &["beyond `collapse`"]);
    says(&format!("scales = [1, 2]\n{}", ida(&format!("{damage}{limits}{list}"))), 2, &["contradict"]);
}

/// Joints can be counted together where they lie the same; weight and thickness of bricks move none.
#[test]
fn cracks_are_counted_where_joints_are_the_same() -> concio::Result<()> {
    let desk = Desk::new(include_str!("../../../concio/tests/data/shear-panel.toml"));
    let check = |path: &str, values: &str| {
        let vary = format!("[[vary]]\npath = \"panel[*].brick.{path}\"\nvalues = {values}\n");
        let plan = desk.plan(&format!("wall = \"wall.toml\"\n{vary}[cracks]\ncriterion = \"slip\"\n"))?;
        plan.file.study.cracks.map_or(Ok(()), |cracks| cracks.check(&plan))
    };
    check("specific_weight", "[\"16 kN/m3\", \"20 kN/m3\"]")?;
    check("thickness", "[\"120 mm\", \"250 mm\"]")?;
    let error = check("length", "[\"250 mm\", \"300 mm\"]").expect_err("other joints").to_string();
    assert!(error.contains("study.toml:5:") && error.contains("different blocks"), "{error}");
    Ok(())
}

#[test]
fn groups_that_are_none() {
    let vary = |path: &str, values: &str| format!("[[vary]]\npath = \"{path}\"\nvalues = {values}\n");
    says(&vary("group.froude", "[0.1]"), 3, &["no group `froude`", "slip_velocity"]);
    says(&vary("group.normal_force", "[0.1]"), 3, &["cannot be varied"]);
    says(&vary("group.load", "[\"1 kN\"]"), 4, &["group.load", "from 0"]);
    says(&vary("group.frequency", "[0.1]"), 4, &["no frequency"]);
    says(&vary("group.top_displacement", "[0.1]"), 4, &["not driven"]);
}
