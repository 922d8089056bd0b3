//! `concio mechanisms` as a user types it.

use serde_json::Value;

use crate::support::Desk;

const FACADE: &str = include_str!("../../../../examples/limit/facade.toml");

/// A wall of one block wide, h 6 m and t 0.5 m, γ 18 kN/m³, and what stands behind it.
fn wall(behind: &str) -> String {
    format!(
        "title = \"One wall\"\nmodel = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 12\nbricks = 5\n\
         brick = {{ length = 1.0, height = 0.5, thickness = 0.5, specific_weight = 18e3 }}\n\
         [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
         friction = {{ law = \"coulomb\", static = 0.6 }}\n{behind}\n[motion]\nduration = 1.0\n"
    )
}

const SITE: &str = "[out_of_plane.site]\nlife_safety = { ground_acceleration = \"0.25 g\", soil_factor = 1.2, amplification = 2.4, corner_period = 0.35 }\n\
                    collapse = { ground_acceleration = \"0.25 g\", soil_factor = 1.2, amplification = 2.4, corner_period = 0.35 }";

fn json(desk: &Desk, line: &str) -> Value {
    let done = desk.concio(line).assert().success();
    serde_json::from_slice(&done.get_output().stdout).expect("JSON")
}

fn text(desk: &Desk, line: &str) -> String {
    let done = desk.concio(line).assert().success();
    String::from_utf8_lossy(&done.get_output().stdout).into_owned()
}

fn near(value: &Value, expected: f64, within: f64) {
    let found = value.as_f64().unwrap_or_else(|| panic!("{value} is no number"));
    assert!((found - expected).abs() <= within * expected.abs(), "{found} instead of {expected}");
}

/// The mechanisms of a kind, hinges from below.
fn of_kind<'v>(result: &'v Value, kind: &str) -> Vec<&'v Value> {
    let all = result["mechanisms"].as_array().expect("mechanisms");
    all.iter().filter(|m| m["kind"] == kind).collect()
}

#[test]
fn a_wall_file_as_it_is_gives_multipliers_and_says_what_it_lacks() {
    let desk = Desk::new();
    desk.put("wall.toml", wall(""));
    let told = text(&desk, "mechanisms wall.toml");
    for part in [
        "One wall",
        "overturning (OP3)",
        "0.08333",
        "out_of_plane: the file has no such table",
        "what not to believe",
        "upper bound",
    ] {
        assert!(told.contains(part), "{part}:\n{told}");
    }
    let all = text(&desk, "mechanisms wall.toml --all");
    assert_eq!(all.matches("overturning (OP3)").count(), 12, "{all}");
    // The wall file of the starter and the shear model's work as they are, too.
    desk.concio("new starter.toml").assert().success();
    desk.concio("mechanisms starter.toml").assert().success();
    desk.concio("new shear.toml --model shear").assert().success();
    desk.concio("mechanisms shear.toml").assert().success();
}

/// The numbers of S5, from a file.
#[test]
fn a_site_gives_the_checks() {
    let desk = Desk::new();
    desk.put("wall.toml", wall(SITE));
    let result = json(&desk, "mechanisms wall.toml --json");
    let base = of_kind(&result, "overturning")[0];
    near(&base["multiplier"], 0.0833333, 1e-5);
    near(&base["acceleration"], 0.605556, 1e-5);
    let check = &base["checks"]["life_safety_by_displacement"];
    near(&check["capacity"], 0.0996546, 1e-5);
    near(&check["period"], 2.765259, 1e-5);
    near(&check["ratio"], 0.697888, 1e-5);
    near(&base["checks"]["collapse_by_displacement"]["ratio"], 1.124478, 1e-5);
    near(&base["checks"]["life_safety"]["ratio"], 0.411523, 1e-5);
    assert!(base["checks"]["damage"]["not_made"].as_str().expect("why").contains("no hazard"));
    // Aloft the floor spectrum is not guessed.
    let aloft = of_kind(&result, "overturning")[6];
    let why = aloft["checks"]["life_safety_by_displacement"]["not_made"].as_str().expect("why");
    assert!(why.contains("unclear at its source"), "{why}");
    let spectrum = format!(
        "{SITE}\n[[out_of_plane.floor_spectrum]]\nz = 3.0\nperiods = [0, 0.3, 1, 4]\naccelerations = [4, 12, 5, 0.5]"
    );
    desk.put("wall.toml", wall(&spectrum));
    let result = json(&desk, "mechanisms wall.toml --json");
    let aloft = of_kind(&result, "overturning")[6];
    assert!(aloft["checks"]["life_safety_by_displacement"]["ratio"].as_f64().expect("a ratio") > 0.0);
}

/// The wall of S8, its side walls from the file.
#[test]
fn side_walls_hold_and_go_along() {
    let desk = Desk::new();
    let side = |x: f64| {
        format!(
            "[[out_of_plane.side_wall]]\nx = {x}\nthickness = 0.4\ncourse_height = 0.25\noverlap = 0.2\nfriction = 0.6\n"
        )
    };
    desk.put("wall.toml", wall(&(side(0.2) + &side(4.8))));
    let result = json(&desk, "mechanisms wall.toml --json");
    let held = of_kind(&result, "overturning-with-side-walls");
    let at = |z: f64| held.iter().find(|m| m["hinge"].as_f64() == Some(z)).expect("a hinge");
    // Levels of this wall are half a metre apart: the least of S8 lies at 1.00.
    near(&at(1.0)["multiplier"], 0.264194, 1e-4);
    assert_eq!(result["least"]["hinge"], 1.0);
    assert!(of_kind(&result, "overturning").iter().all(|m| m["counts"] == false));
    assert_eq!(of_kind(&result, "corner").len(), 24);
    let code = json(&desk, "mechanisms wall.toml --json --overlaps code");
    let held = of_kind(&code, "overturning-with-side-walls");
    let least = held.iter().filter_map(|m| m["multiplier"].as_f64()).fold(f64::INFINITY, f64::min);
    assert!((least - 0.2446).abs() < 1e-3, "{least}");
}

#[test]
fn floors_that_hold_make_an_arch_and_a_weak_one_gives_way() {
    let desk = Desk::new();
    let floor = |keys: &str| {
        wall(&format!("[[out_of_plane.floor]]\nz = 6\nload = \"10 kN/m\"\nat = 0.25\nholds = true\n{keys}"))
    };
    desk.put("wall.toml", floor(""));
    let result = json(&desk, "mechanisms wall.toml --json");
    let arch = of_kind(&result, "vertical-arch")[0];
    // (OP6) on the joint beside x*: W 54 kN, N 10 kN, both per metre.
    let n: f64 = 10.0 / 54.0;
    let at = |x: f64| 2.0 * 0.5 / 6.0 * (1.0 + n * (1.0 + 0.5 * x / (1.0 - x))) / x;
    let least = (1..12).map(|i| at(f64::from(i) / 12.0)).fold(f64::INFINITY, f64::min);
    near(&arch["multiplier"], least, 1e-9);
    assert!(arch["notes"].to_string().contains("assumed to be borne"), "{}", arch["notes"]);
    assert!(of_kind(&result, "overturning").is_empty());
    desk.put("wall.toml", floor("connection = \"0.5 kN/m\""));
    let result = json(&desk, "mechanisms wall.toml --json");
    assert!(of_kind(&result, "vertical-arch")[0]["notes"].to_string().contains("gives way first"));
    let fallen = of_kind(&result, "overturning");
    near(&fallen[0]["multiplier"], (54.0 * 0.25 + 10.0 * 0.25 + 0.5 * 6.0) / (54.0 * 3.0 + 10.0 * 6.0), 1e-9);
}

#[test]
fn the_facade_of_the_guide_gives_all_in_one_folder() {
    let desk = Desk::new();
    desk.put("facade.toml", FACADE);
    let told = text(&desk, "mechanisms facade.toml --out assessed");
    for part in [
        "corner (OP5)",
        "overturning with side walls (OP4)",
        "flap (OP8)",
        "worst check",
        "twists",
        "open assessed/report.html",
    ] {
        assert!(told.contains(part), "{part}:\n{told}");
    }
    // The worst check is that of a higher flap than the least one: it has a row of its own.
    let rows: Vec<&str> = told.lines().filter(|line| line.starts_with("  flap (OP8) ")).collect();
    assert!(rows.len() == 2 && rows[0].contains(" 0.00 m ") && rows[1].contains(" 3.75 m "), "{told}");
    let result = desk.json("assessed/mechanisms.json");
    assert!(rows[1].contains(&format!(" {:.3} ", result["worst_check"]["ratio"].as_f64().expect("a ratio"))), "{told}");
    let found = result["mechanisms"].as_array().expect("mechanisms");
    assert!(found.len() > 60, "{}", found.len());
    let csv = desk.get("assessed/mechanisms.csv");
    assert_eq!(csv.lines().count(), found.len() + 1);
    assert!(csv.starts_with("mechanism,equation,counts,hinge"), "{csv}");
    let page = desk.get("assessed/report.html");
    for part in
        ["Assumed", "elevation, from outside", "Circolare", "may disintegrate", "upper bound", "a* = α0 g/(e* FC)"]
    {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("http://") || page.contains("http://www.w3.org"), "the page fetches something");
    assert!(desk.get("assessed/figures/overturning-with-side-walls.svg").contains("<path"));
    // The tie breaks: its curve has a step.
    let tied = of_kind(&result, "overturning")[0];
    let curve: Vec<f64> =
        tied["curve"].as_array().expect("a curve").iter().filter_map(|p| p["multiplier"].as_f64()).collect();
    let drop = curve.windows(2).map(|p| p[0] - p[1]).fold(0.0, f64::max);
    assert!(drop > 0.02, "{drop}");
}

/// The worked calculation of the guide: its wall, and the numbers that it has by hand, to the digits that it shows.
#[test]
fn the_guide_calculates_what_the_command_finds() {
    let page = include_str!("../../../../docs/guide/13-out-of-plane.md");
    let start = page.find("# wall.toml").expect("a wall file");
    let end = start + page[start..].find("```").expect("its end");
    let desk = Desk::new();
    desk.put("wall.toml", &page[start..end]);
    let result = json(&desk, "mechanisms wall.toml --json");
    let turns = of_kind(&result, "overturning");
    let at = |z: f64| *turns.iter().find(|m| m["hinge"].as_f64() == Some(z)).expect("a hinge");
    let strip = of_kind(&result, "horizontal-arch")[0];
    // Where, what, digits as the page shows them, and by hand.
    let hand = [
        (&at(0.0)["multiplier"], "0.06810", 14.3 / 210.0),
        (&at(0.0)["participation"], "0.952", 210.0 * 210.0 / (66.0 * 702.0)),
        (&at(0.0)["acceleration"], "0.5199", 14.3 / 210.0 * 9.81 * 66.0 * 702.0 / (210.0 * 210.0 * 1.35)),
        (&at(0.0)["checks"]["life_safety"]["ratio"], "0.442", 0.441615),
        (&at(0.0)["last_turn"], "0.06795", 14.3f64.atan2(210.125)),
        (&at(0.0)["last_displacement"], "0.2270", 702.0 / 210.0 * 14.3f64.atan2(210.125).sin()),
        (&at(0.0)["checks"]["life_safety_by_displacement"]["capacity"], "0.0908", 0.0907889),
        (&at(0.0)["checks"]["life_safety_by_displacement"]["acceleration"], "0.3116", 0.311628),
        (&at(0.0)["checks"]["life_safety_by_displacement"]["period"], "2.849", 2.848771),
        (&at(0.0)["checks"]["life_safety_by_displacement"]["demand"], "0.1054", 0.1054482),
        (&at(0.0)["checks"]["life_safety_by_displacement"]["ratio"], "0.861", 0.860981),
        (&at(3.0)["multiplier"], "0.1190", 6.25 / 52.5),
        (&at(3.0)["participation"], "0.919", 52.5 * 52.5 / (31.0 * 96.75)),
        (&at(3.0)["acceleration"], "0.9413", 6.25 / 52.5 * 9.81 * 31.0 * 96.75 / (52.5 * 52.5 * 1.35)),
        (&at(3.0)["checks"]["life_safety"]["demand"], "3.407", 5.65056 * 0.6 * 1.01f64.sqrt()),
        (
            &at(3.0)["checks"]["life_safety"]["ratio"],
            "0.553",
            2.0 * 6.25 / 52.5 * 9.81 * 31.0 * 96.75 / (52.5 * 52.5 * 1.35 * 5.65056 * 0.6 * 1.01f64.sqrt()),
        ),
        (&strip["multiplier"], "0.2457", 120.0 / 437.5 - 0.5 / 17.5),
        (&strip["acceleration"], "1.786", (120.0 / 437.5 - 0.5 / 17.5) * 9.81 / 1.35),
        (&strip["checks"]["life_safety"]["demand"], "5.963", 5.65056 * 1.05 * 1.01f64.sqrt()),
        (
            &strip["checks"]["life_safety"]["ratio"],
            "0.599",
            2.0 * (120.0 / 437.5 - 0.5 / 17.5) * 9.81 / (1.35 * 5.65056 * 1.05 * 1.01f64.sqrt()),
        ),
    ];
    let told = &page[end..];
    for (found, digits, expected) in hand {
        near(found, expected, 1e-5);
        let places = digits.split('.').nth(1).map_or(0, str::len);
        assert_eq!(format!("{:.places$}", found.as_f64().expect("a number")), digits);
        assert!(told.contains(digits), "{digits} stands on the page");
    }
}

/// Under real records, where they are at hand, the wall of the guide sets off at α0 g over the peak of that sign, and falls or nearly
/// does; the façade turns as the guide says.
#[test]
fn the_guide_shakes_its_wall_by_records() {
    let beside = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let shared = std::env::var_os("CONCIO_SHARED").map_or(beside, std::path::PathBuf::from);
    let page = include_str!("../../../../docs/guide/13-out-of-plane.md");
    let start = page.find("# wall.toml").expect("a wall file");
    let end = start + page[start..].find("```").expect("its end");
    let desk = Desk::new();
    desk.put("wall.toml", &page[start..end]);
    // Each falls under one sign, and by chance under the other.
    for (name, peak, other, falls, turns) in [
        ("IT.NRC..HGE.D.20161030.064018.C.ACC.ASC", 0.4857, 0.160, "outwards", [0.71, 0.61]),
        ("IT.AQK..HNE.D.20090406.013240.C.ACC.ASC", 0.3300, 0.239, "inwards", [0.081, 0.189]),
    ] {
        let record = shared.join("records/itaca_esm").join(name);
        if !record.exists() {
            concio_verified::skip("the records of the guide's wall (shared/ not found)");
            return;
        }
        let result = json(&desk, &format!("mechanisms wall.toml --json --record {}", record.display()));
        let all = result["time_history"]["mechanisms"].as_array().expect("mechanisms");
        let base = all.iter().find(|m| m["kind"] == "overturning").expect("the base");
        let signs = ["inwards", "outwards"].map(|positive| {
            let signs = base["signs"].as_array().expect("signs");
            signs.iter().find(|sign| sign["positive"] == positive).expect("a sign")
        });
        near(&signs[0]["first_lift_off_factor"], 14.3 / 210.0 / peak, 2e-3);
        near(&signs[1]["first_lift_off_factor"], other, 5e-3);
        let facade = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/limit/facade.toml");
        let result = json(&desk, &format!("mechanisms {facade} --json --record {}", record.display()));
        let upper = &result["time_history"]["mechanisms"][0];
        assert_eq!(upper["kind"], "overturning");
        for (sign, expected) in upper["signs"].as_array().expect("signs").iter().zip(turns) {
            assert_eq!(sign["verdict"], "stands", "{name}");
            near(&sign["outwards"]["over_d0"], expected, 0.03);
        }
        for sign in signs {
            let verdict = if sign["positive"] == falls { "falls" } else { "chance" };
            assert_eq!(sign["verdict"], verdict, "{name}");
            assert!(sign["fell"].as_u64() > Some(0), "{name}: {sign}");
        }
    }
}

/// Flaps whose thrust makes the level hinge the least: its angle is told, not what rounding leaves of tan 90°.
#[test]
fn a_level_hinge_of_flaps_is_one_of_90_degrees() {
    let desk = Desk::new();
    let gable = "height = 2.2\nbase = 3.48\nthickness = 0.245\nridge_load = 1705\ncrack_thrust = 1956";
    desk.put("wall.toml", wall(&format!("[out_of_plane.gable]\n{gable}")));
    let told = text(&desk, "mechanisms wall.toml");
    let line = told.lines().find(|l| l.contains("flaps of the gable")).expect("flaps");
    assert!(line.contains("90°"), "{line}");
    let all = json(&desk, "mechanisms wall.toml --json --all");
    let mut flaps = all["mechanisms"].as_array().expect("mechanisms").iter().filter(|m| m["kind"] == "gable-flaps");
    assert!(flaps.any(|m| m["cracks"][0].is_null()) && !all.to_string().contains("e16"), "{all}");
}

/// The gable end of the examples has every kind of mechanism that the façade lacks, and its strength sets them back.
#[test]
fn the_gable_end_of_the_examples() {
    let desk = Desk::new();
    desk.put("gable.toml", include_str!("../../../../examples/limit/gable-end.toml"));
    let told = text(&desk, "mechanisms gable.toml --out assessed");
    for part in
        ["gable (OP9)", "flaps of the gable (OP9)", "vertical arch (OP6)", "horizontal arch (OP7)", "outer leaf (OP3)"]
    {
        assert!(told.contains(part), "{part}:\n{told}");
    }
    assert!(!told.contains("side walls are too near"), "a floor holds the top:\n{told}");
    let result = desk.json("assessed/mechanisms.json");
    // (OP9) with (OP2): base 8 m, h_g 2.4 m, t 0.4 m, 19 kN/m³; f_h 2 MPa as a triangle, P 10 kN at 0.2 m, Q 15 kN, H 1 kN.
    let weight = 0.5 * 19.0 * 0.4 * 8.0 * 2.4;
    let setback = 2.0 * (weight + 10.0) / (3.0 * 2000.0 * 8.0);
    let resists = (weight + 10.0) * (0.2 - setback) - 2.4;
    near(&of_kind(&result, "gable")[0]["multiplier"], resists / (weight * 0.8 + 25.0 * 2.4), 1e-9);
    near(&of_kind(&result, "gable")[0]["setback"], setback, 1e-9);
    // The outer face is the back one: the picture of the front shows the inside.
    assert!(desk.get("assessed/report.html").contains("elevation, from inside"));
}

/// The plateau of a trilinear curve ends on the curve of rigid blocks; its ends are asked for in order.
#[test]
fn a_trilinear_curve_is_told_where_it_is_asked_for() {
    let desk = Desk::new();
    desk.put("wall.toml", wall(""));
    let result = json(&desk, "mechanisms wall.toml --trilinear 0.1,0.4 --json");
    let base = of_kind(&result, "overturning")[0];
    let whole = (0.5f64 / 6.0).atan();
    let plateau = (whole - (0.4 * whole.sin()).asin()).tan();
    near(&base["trilinear"]["multiplier"], plateau, 1e-9);
    near(&base["trilinear"]["acceleration"], plateau * 9.81 / 1.35, 1e-9);
    assert!(text(&desk, "mechanisms wall.toml --trilinear 0.1,0.4").contains("trilinear: α = 0.0"));
    assert!(of_kind(&json(&desk, "mechanisms wall.toml --json"), "overturning")[0]["trilinear"].is_null());
    for wrong in ["0.4,0.1", "0.1", "0,0.4", "0.1,1", "0.1,0.2,0.3", "a,b"] {
        let done = desk.concio(&format!("mechanisms wall.toml --trilinear {wrong}")).assert().code(2);
        assert!(String::from_utf8_lossy(&done.get_output().stderr).contains("two rising numbers"), "{wrong}");
    }
}

#[test]
fn runs_in_the_plane_say_that_they_do_not_read_it() {
    let desk = Desk::new();
    desk.put("facade.toml", FACADE);
    for command in ["check", "limit"] {
        let done = desk.concio(&format!("{command} facade.toml")).assert();
        let told = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
        assert!(told.contains("out_of_plane is not read in the plane"), "{command}: {told}");
    }
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    let desk = Desk::new();
    let refused = |behind: &str, parts: &[&str]| {
        desk.put("wall.toml", wall(behind));
        let done = desk.concio("mechanisms wall.toml").assert().code(2);
        let told = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
        for part in parts {
            assert!(told.contains(part), "{part}:\n{told}");
        }
    };
    let floor = |keys: &str| format!("[[out_of_plane.floor]]\n{keys}");
    refused(&floor("z = 8\nload = 1e4"), &["wall.toml:13:", "out_of_plane.floor[0].z", "above the wall", "up to 6 m"]);
    refused(&floor("z = 3\nload = -1"), &["wall.toml:14:", "out_of_plane.floor[0].load", "from 0 N/m"]);
    refused(&floor("z = 3\nload = 1e4\nat = 0.8"), &["out_of_plane.floor[0].at", "behind the wall", "0 … 0.5 m"]);
    refused(&floor("z = 3\nload = 1e4\nseet = 1"), &["out_of_plane.floor[0].seet", "unknown key"]);
    refused(
        "[out_of_plane]\nconfidence_factor = 1.2",
        &["confidence_factor", "crushing at hinges is left out", "1.35"],
    );
    refused("[out_of_plane]\nleaves = [0.2, 0.2]", &["out_of_plane.leaves", "0.4 m thick", "0.5 m"]);
    refused("[[out_of_plane.anchor]]\nz = 5\nx = 9\nyield_force = 1e4", &["anchor[0].x", "beside the wall", "0 … 5 m"]);
    refused("[out_of_plane.site]\nlife_safety = { ground_acceleration = 1 }", &["amplification", "key is missing"]);
    refused(
        "[[out_of_plane.side_wall]]\nx = 0\nthickness = \"0.4 kN\"",
        &["side_wall[0].thickness", "not a unit of length"],
    );
    let gable = "[out_of_plane.gable]\nheight = 1.5\nridge_load = 5000\nridge_at = 0.9";
    refused(gable, &["wall.toml:15:", "gable.ridge_at", "0.9 m lies behind the gable", "0 … 0.5 m"]);
    refused(
        "[out_of_plane.building]\nheight = 3\nstoreys = 2",
        &["out_of_plane.building.height", "3 m is lower than the wall", "from 6 m, the top of the wall"],
    );
    refused(
        "[[out_of_plane.floor_spectrum]]\nz = 60\nperiods = [0, 1]\naccelerations = [4, 5]",
        &["floor_spectrum[0].z", "60 m lies above the building", "up to 6.5 m, half a metre above its top"],
    );
    desk.put("arch.toml", include_str!("../../../../examples/17-arch.toml"));
    let done = desk.concio("mechanisms arch.toml").assert().code(2);
    assert!(String::from_utf8_lossy(&done.get_output().stderr).contains("not of arches"));
    desk.concio("mechanisms nowhere.toml").assert().code(2);
}

/// Pulses of 2 Hz of so many m/s², 2 s of them, then rest: a record as text.
fn record(peak: f64) -> String {
    let value = |k: usize| {
        let t = 0.01 * k as f64;
        if t < 2.0 { peak * (std::f64::consts::TAU * 2.0 * t).sin() } else { 0.0 }
    };
    let lines = (0..300).map(|k| format!("{:.2} {:.6}\n", 0.01 * k as f64, value(k)));
    format!("time [s], acceleration [m/s2]\n{}", lines.collect::<String>().replace(' ', ", "))
}

/// A record takes the least of each kind through it, with both signs; what has no time history says why.
#[test]
fn a_record_is_followed_with_both_signs() {
    let desk = Desk::new();
    desk.put("facade.toml", FACADE);
    desk.put("shaking.csv", record(3.0));
    let told = text(&desk, "mechanisms facade.toml --record shaking.csv --out assessed");
    for part in [
        "time history under shaking.csv, channel 1 of 1",
        "peak 2.994 m/s² = 0.3052 g",
        "no vertical motion",
        "turn/θ0",
        "d_C0: where the control point is at θ0",
        "inwards",
        "outwards",
        "stands",
        "no time history: it turns about an inclined hinge",
        "side walls stop it when it comes back",
        "lies 3.00 m above the ground",
        "chosen, not known",
    ] {
        assert!(told.contains(part), "{part}:\n{told}");
    }
    let result = desk.json("assessed/mechanisms.json");
    let all = result["time_history"]["mechanisms"].as_array().expect("mechanisms");
    let sides = all.iter().find(|m| m["kind"] == "overturning-with-side-walls").expect("a mechanism");
    assert_eq!(sides["signs"].as_array().map(Vec::len), Some(2));
    near(&sides["sets_off"], sides["multiplier"].as_f64().expect("a number"), 1e-9);
    for sign in sides["signs"].as_array().expect("signs") {
        assert_eq!((&sign["runs"], &sign["fell"]), (&6.into(), &0.into()));
        let low = sign["peak_turns"][0].as_f64().expect("a turn");
        let own = sign["outwards"]["turn"].as_f64().expect("a turn");
        assert!(low > 0.0 && low <= own && own <= sign["peak_turns"][1].as_f64().expect("a turn"));
        assert!(sign["energy_residual"].as_f64().expect("a number") < 1e-3);
    }
    let histories = desk.get("assessed/time-history-overturning-with-side-walls.csv");
    let head = histories.lines().next().expect("a heading");
    for column in ["time [s]", "positive-inwards/displacement [m]", "positive-outwards/turn [rad]"] {
        assert!(head.contains(column), "{head}");
    }
    assert!(histories.lines().count() >= 300);
    let page = desk.get("assessed/report.html");
    assert!(page.contains("Time history") && page.contains("d_SLV") && page.contains("positive outwards"));
    assert!(desk.path("assessed/figures/time-history-overturning-with-side-walls.svg").exists());
}

/// A record in another unit than it says, and one that shakes the ground up and down.
#[test]
fn records_that_are_hardly_meant_are_warned_of() {
    let desk = Desk::new();
    desk.put("facade.toml", FACADE);
    let values: String = (0..300).map(|k| format!("{:.6}\n", 3.0 * (0.2 * f64::from(k)).sin())).collect();
    desk.put("bare.txt", &values);
    desk.put("weak.txt", format!("# dt = 0.01 s, units: cm/s2\n{values}"));
    desk.put("both.txt", format!("# dt = 0.01 s, units: m/s2\nE-W UP\n{}", values.replace('\n', " 1\n")));
    let said = |line: &str| {
        let done = desk.concio(&format!("mechanisms facade.toml --record {line}")).assert().success();
        String::from_utf8_lossy(&done.get_output().stderr).into_owned()
    };
    let weak = |what: &str, remedy: &str| {
        format!(
            "warning: {what} is \"cm/s2\", in which the record's peak acceleration is 0.00306 g: it hardly moves a wall. Is it 0.306 g? Then {remedy} is \"m/s2\""
        )
    };
    let given = said("bare.txt --dt 0.01 --units cm/s2");
    assert!(given.contains(&weak("--units", "--units")), "{given}");
    let named = said("weak.txt");
    assert!(named.contains(&weak("--record: the unit in the file", "its unit")), "{named}");
    for fine in ["bare.txt --dt 0.01 --units m/s2", "weak.txt --scale 100", "weak.txt --pga 0.3g"] {
        let told = said(fine);
        assert!(!told.contains("hardly moves"), "{fine}: {told}");
    }
    let upright = "warning: the component `UP` that shakes the wall to and fro is a vertical one by its name";
    assert!(said("both.txt --channel UP").contains(upright));
    assert!(!said("both.txt --channel E-W").contains("vertical one by its name"));
}

/// Every hinge level has its files; a tie begins at no force, so that the wall sets off below α0.
#[test]
fn all_hinges_are_followed_and_ties_begin_at_no_force() {
    let desk = Desk::new();
    desk.put(
        "wall.toml",
        wall("[[out_of_plane.anchor]]\nz = \"5.5 m\"\nyield_force = \"10 kN\"\nstiffness = \"2 MN/m\"\n"),
    );
    desk.put("shaking.csv", record(1.5));
    let told = text(&desk, "mechanisms wall.toml --record shaking.csv --all --out assessed");
    assert!(told.contains("the wall sets off below α0"), "{told}");
    let result = desk.json("assessed/mechanisms.json");
    let all = result["time_history"]["mechanisms"].as_array().expect("mechanisms");
    assert_eq!(all.iter().filter(|m| m["kind"] == "overturning").count(), 12);
    let base = all.iter().find(|m| m["kind"] == "overturning" && m["hinge"] == 0.0).expect("the base");
    near(&base["sets_off"], 0.0833333, 1e-5);
    assert!(base["multiplier"].as_f64() > Some(0.084));
    let head = desk.get("assessed/time-history-overturning-0.00m.csv");
    assert!(head.lines().next().expect("a heading").contains("positive-inwards/tie-1 [N]"), "{head}");
    assert!(desk.path("assessed/figures/time-history-overturning-5.00m.svg").exists());
}

/// A stronger motion overturns a wall that nothing holds; the lift-off of a wall without ties is α0 of the peak.
#[test]
fn scale_and_peak_move_lift_off_and_fall() {
    let desk = Desk::new();
    desk.put("wall.toml", wall(""));
    desk.put("shaking.csv", record(3.0));
    let of = |line: &str| {
        let result = json(&desk, &format!("mechanisms wall.toml --record shaking.csv --json {line}"));
        let all = result["time_history"]["mechanisms"].as_array().expect("mechanisms").clone();
        all.into_iter().find(|m| m["kind"] == "overturning").expect("a mechanism")
    };
    let plain = of("");
    near(&plain["sets_off"], 0.0833333, 1e-5);
    near(&plain["signs"][0]["first_lift_off_factor"], 0.0833333 * 9.81 / 3.0, 2e-3);
    let scaled = of("--scale 2");
    near(&scaled["signs"][0]["first_lift_off_factor"], 0.0833333 * 9.81 / 6.0, 2e-3);
    let peak = of("--pga 0.05g");
    assert_eq!(peak["signs"][0]["verdict"], "rests");
    let strong = of("--scale 20");
    assert!(strong["signs"].as_array().expect("signs").iter().any(|s| s["verdict"] == "falls"), "{strong}");
    assert!(strong["signs"][0]["fallen_at"].as_f64().is_some());
    // An upward motion of the same file changes the answer.
    let both = of("--vertical shaking.csv");
    assert_ne!(both["signs"][0]["peak_turns"], plain["signs"][0]["peak_turns"]);
}

/// The motion of the wall file, and what may be mistaken.
#[test]
fn the_motion_of_the_file_and_mistakes() {
    let desk = Desk::new();
    desk.put("facade.toml", FACADE);
    desk.put("still.toml", wall(""));
    desk.put("shaking.csv", record(3.0));
    desk.put("zero.csv", record(0.0));
    // A load near the inner face: impacts that leave all of the velocity would give energy on one side.
    desk.put("laden.toml", wall("[[out_of_plane.floor]]\nz = \"3 m\"\nload = \"20 kN/m\"\nat = \"0.45 m\"\n"));
    let told = text(&desk, "mechanisms facade.toml --shaken");
    assert!(told.contains("half-sine pulse") && told.contains("is taken across the wall"), "{told}");
    let none = text(&desk, "mechanisms facade.toml");
    assert!(!none.contains("time history"), "{none}");
    let refused = |line: &str, parts: &[&str]| {
        let done = desk.concio(line).assert().code(2);
        let error = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
        for part in parts {
            assert!(error.contains(part), "{part}: {error}");
        }
    };
    refused("mechanisms still.toml --shaken", &["still.toml", "motion.base", "at rest", "--record"]);
    refused("mechanisms facade.toml --record none.at2", &["none.at2"]);
    refused("mechanisms facade.toml --record facade.toml", &["facade.toml"]);
    refused("mechanisms facade.toml --record zero.csv", &["zero.csv", "--record", "zero throughout"]);
    refused("mechanisms facade.toml --record shaking.csv --channel 4", &["shaking.csv", "--channel", "allowed"]);
    refused("mechanisms facade.toml --record shaking.csv --shaken", &["cannot be used with"]);
    refused("mechanisms facade.toml --scale 2", &["--record"]);
    refused("mechanisms facade.toml --record shaking.csv --pga 0.3", &["the unit is missing"]);
    refused("mechanisms facade.toml --record shaking.csv --scale 2 --pga 0.3g", &["cannot be used with"]);
    // What begins with a minus is a number that is refused as such, and no option.
    for (line, allowed) in [
        ("mechanisms facade.toml --record shaking.csv --scale -1", "a number above 0"),
        ("mechanisms facade.toml --record shaking.csv --pga -0.3g", "above 0 g"),
        ("mechanisms facade.toml --record shaking.csv --restitution -0.5", "a number from 0 to 1"),
        ("mechanisms facade.toml --trilinear -0.1,0.4", "two rising numbers above 0"),
        ("limit facade.toml --out-of-plane --above -1m", "above 0m"),
    ] {
        refused(line, &["invalid value '-", allowed]);
    }
    refused("mechanisms facade.toml --record shaking.csv --restitution 1.5", &["from 0 to 1"]);
    refused(
        "mechanisms laden.toml --record shaking.csv --restitution 1",
        &["--restitution", "would give energy", "allowed"],
    );
}

/// A motion that runs would warn of is warned of here too, as it shakes the wall, whoever gives it.
#[test]
fn doubtful_motions_are_told() {
    let desk = Desk::new();
    desk.put("wall.toml", wall(""));
    desk.put("shaking.csv", record(3.0));
    desk.put("milli.csv", record(3000.0));
    let lines: Vec<String> = record(3.0).lines().map(String::from).collect();
    let shifted = lines.iter().enumerate().map(|(k, line)| match line.split_once(",") {
        Some((t, a)) if k > 0 => format!("{t}, {}\n", a.trim().parse::<f64>().expect("a number") + 0.5),
        _ => format!("{line}\n"),
    });
    desk.put("offset.csv", shifted.collect::<String>());
    let shaken =
        |keys: &str| wall("").replace("duration = 1.0\n", &format!("duration = \"2.99 s\"\nbase = {{ {keys} }}\n"));
    desk.put("milli.toml", shaken("record = \"milli.csv\""));
    desk.put("pga.toml", shaken("record = \"shaking.csv\", pga = \"3 g\""));
    desk.put("pulse.toml", shaken("pulse = { shape = \"half-sine\", acceleration = \"0.3 g\", duration = \"0.5 s\" }"));
    let look = "look at --units, --scale and --pga";
    let few = "which few records have";
    for (line, parts) in [
        ("wall.toml --record milli.csv", vec!["--record: the record's peak acceleration is 2994 m/s²", look]),
        ("wall.toml --record shaking.csv --pga 35g", vec!["--record: the record's peak", "343.4 m/s²", look]),
        ("wall.toml --record shaking.csv --scale 10", vec!["--record: its peak acceleration is 3.05 g", few]),
        ("wall.toml --record shaking.csv --vertical milli.csv", vec!["--vertical: the record's peak", look]),
        ("wall.toml --record offset.csv", vec!["motion of the base as processed drifts", "offset", "of a wall file"]),
        ("milli.toml --shaken", vec!["motion.base: the record's peak acceleration is 2994 m/s²", "milli.toml:"]),
        ("pga.toml --shaken", vec!["motion.base: its peak acceleration is 3 g", few]),
        ("pulse.toml --shaken --scale 10", vec!["--scale: its peak acceleration is 3 g", few]),
    ] {
        let done = desk.concio(&format!("mechanisms {line} --json")).assert().success();
        let out = done.get_output();
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        let result: Value = serde_json::from_slice(&out.stdout).expect("JSON");
        let kept = result["time_history"]["doubts"].to_string();
        for part in parts {
            assert!(said.contains("warning: ") && said.contains(part), "{line}: {part}: {said}");
            assert!(kept.contains(part) || part.ends_with(".toml:"), "{line}: {part}: {kept}");
        }
    }
    // Whole waves of a cosine come back to where they began.
    let wave = |k: usize| if k <= 200 { 3.0 * (std::f64::consts::TAU * 0.02 * k as f64).cos() } else { 0.0 };
    let waves: String = (0..300).map(|k| format!("{:.2}, {:.6}\n", 0.01 * k as f64, wave(k))).collect();
    desk.put("calm.csv", format!("time [s], acceleration [m/s2]\n{waves}"));
    for line in ["wall.toml --record calm.csv", "wall.toml --record calm.csv --pga 0.35g", "pulse.toml --shaken"] {
        let done = desk.concio(&format!("mechanisms {line}")).assert().success();
        let said = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
        assert!(said.is_empty(), "{line}: {said}");
    }
}

/// A wall that nothing stops falls to either side: its levels are drawn where it goes, and a heading says how far a fall is drawn.
#[test]
fn levels_are_drawn_where_the_wall_goes() {
    let desk = Desk::new();
    desk.put("wall.toml", wall(""));
    desk.put("shaking.csv", record(3.0));
    text(&desk, "mechanisms wall.toml --record shaking.csv --scale 6 --out assessed");
    let page = desk.get("assessed/report.html");
    assert!(page.contains("drawn until"), "no heading says where the curve ends");
    let figure = page.split("<svg").find(|figure| figure.contains("stroke-dasharray=\"1 1.3\"")).expect("levels");
    // First and last ordinate of what is drawn in a style; the legend is drawn likewise, first.
    let drawn = |style: &str| -> Vec<[f64; 2]> {
        let paths = figure.split("<path").filter(|path| path.split('>').next().is_some_and(|own| own.contains(style)));
        let points = |path: &str| path.split(" d=\"M ").nth(1)?.split('"').next().map(str::to_string);
        let ordinates = paths.filter_map(points).map(|points| {
            let pairs: Vec<&str> = points.split(" L ").collect();
            let ordinate = |pair: &str| pair.split(' ').nth(1).expect("a pair").parse().expect("an ordinate");
            [ordinate(pairs[0]), ordinate(pairs[pairs.len() - 1])]
        });
        ordinates.skip(1).collect()
    };
    // d_SLV is 0.4 of d0, and a fall goes beyond both, up on one panel and down on the other.
    let (curves, last, life) =
        (drawn("stroke=\"#0b2545\""), drawn("stroke-dasharray=\"3.6 1.5\""), drawn("stroke-dasharray=\"1 1.3\""));
    assert_eq!([curves.len(), last.len(), life.len()], [2; 3], "{curves:?} {last:?} {life:?}");
    assert!((curves[0][1] - curves[0][0]) * (curves[1][1] - curves[1][0]) < 0.0, "{curves:?}");
    for (([rest, end], [last, _]), [life, _]) in curves.into_iter().zip(last).zip(life) {
        let [at_last, at_life] = [last, life].map(|level| (level - rest) / (end - rest));
        assert!(at_last > 0.5 && at_last < 1.0, "{at_last}");
        assert!((at_life - 0.4 * at_last).abs() < 2e-3, "{at_life} of {at_last}");
    }
}

/// Numbers of another unit are asked about by each command that runs nothing, on standard error, whatever it prints.
#[test]
fn numbers_hardly_meant_are_asked_about() {
    let desk = Desk::new();
    desk.put("floor.toml", FACADE.replace("load = \"12 kN/m\"", "load = 12"));
    desk.put("light.toml", FACADE.replace("\"20 kN/m3\"", "20"));
    let panel = include_str!("../../../../examples/continuum/panel.toml");
    let weight = panel.lines().find(|line| line.contains("specific_weight")).expect("a weight");
    let bare = weight.split("specific_weight = ").next().expect("a start").to_string() + "specific_weight = 18 }";
    desk.put("panel.toml", panel.replace(weight, &bare));
    for (line, told) in [
        ("mechanisms floor.toml --json", "out_of_plane.floor[0].load is 12 N/m"),
        ("mechanisms light.toml", "specific_weight is 20 N/m3"),
        ("limit light.toml --json", "specific_weight is 20 N/m3"),
        ("limit light.toml --out-of-plane --above 3m", "specific_weight is 20 N/m3"),
        ("continuum panel.toml --card lamina", "specific_weight is 18 N/m3"),
    ] {
        let done = desk.concio(line).assert().success();
        let said = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
        assert!(said.contains(told) && said.contains("did you mean") && said.contains(".toml:"), "{line}: {said}");
    }
    desk.put("facade.toml", FACADE);
    let done = desk.concio("mechanisms facade.toml").assert().success();
    assert!(done.get_output().stderr.is_empty());
}

/// Side walls in one half do not hold the other: it overturns as if they were not there, and that counts.
#[test]
fn side_walls_in_one_half_are_told() {
    let desk = Desk::new();
    let side = |x: f64| format!("[[out_of_plane.side_wall]]\nx = {x}\nthickness = 0.4\n");
    let result = |sides: &str| {
        desk.put("wall.toml", wall(sides));
        json(&desk, "mechanisms wall.toml --json")
    };
    let both = result(&(side(0.2) + &side(1.5)));
    let free = of_kind(&both, "overturning");
    assert!(free.iter().all(|m| m["counts"] == true), "{free:?}");
    assert!(free[0]["notes"].to_string().contains("all stand in one half"), "{}", free[0]["notes"]);
    near(&both["least"]["multiplier"], free[0]["multiplier"].as_f64().expect("a number"), 1e-12);
    let held = of_kind(&both, "overturning-with-side-walls");
    assert!(held[0]["notes"].to_string().contains("the façade twists about them"), "{}", held[0]["notes"]);
    let ends = result(&(side(0.2) + &side(4.8)));
    assert!(of_kind(&ends, "overturning").iter().all(|m| m["counts"] == false));
}

/// What only the laid wall shows is told on standard error with its line, by `limit` as well, which takes a file of a rocking wall as it is.
#[test]
fn slips_that_the_wall_shows_are_told_by_each_command() {
    let desk = Desk::new();
    let twice = "[load]\ntop = \"8 kN/m\"\n[[out_of_plane.floor]]\nz = 6\nload = \"8 kN/m\"";
    desk.put("wall.toml", wall(twice));
    let crushes = "[out_of_plane]";
    desk.put(
        "crushes.toml",
        wall(crushes)
            .replace("bed = { law = \"rigid\" }", "bed = { law = \"rigid\", compressive_strength = \"0.3 MPa\" }"),
    );
    let rocks = wall(twice).replace("model = \"planar\"", "model = \"rocking\"").replace("courses = 12", "courses = 2");
    desk.put("rocks.toml", rocks.replace("height = 0.5", "height = 3.0"));
    let slides = wall("").replace("static = 0.6", "static = 0").replace("courses = 12", "courses = 2");
    desk.put("slides.toml", slides.replace("height = 0.5", "height = 3.0") + "[out_of_plane]\n");
    for (line, says) in [
        (
            "mechanisms wall.toml",
            "load.top and out_of_plane.floor[0] at the top both bring 8 kN/m: the load counts twice",
        ),
        ("mechanisms crushes.toml", "joint.bed.compressive_strength: it sets no hinge back here"),
        ("limit rocks.toml --out-of-plane", "load.top and out_of_plane.floor[0] at the top both bring 8 kN/m"),
        ("limit slides.toml --out-of-plane", "λ is 0: something moves at the least push"),
    ] {
        let done = desk.concio(line).assert();
        let out = done.get_output();
        let said = [&out.stdout, &out.stderr].map(|text| String::from_utf8_lossy(text).into_owned()).concat();
        assert!(out.status.code() != Some(2) && said.contains(says), "{line}: {said}");
        assert!(!said.contains("% above λ") || !line.contains("slides"), "{said}");
    }
}
