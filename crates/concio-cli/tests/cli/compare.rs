//! `concio compare`.

use serde_json::Value;
use snapbox::str;

use crate::support::{Desk, WALL};

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Free blocks overlap, springs let them a little, rigid joints do not; pairs are those named, figures are drawn.
#[test]
fn constrained_sets_three_walls_against_each_other() {
    let desk = Desk::new();
    let run = desk
        .concio("compare constrained wall.toml --out c --rigidity 10,1e4 --format png")
        .args(["--pairs", "p1c1b1|p1c1b2,p1c3b1|p1c3b2"])
        .assert()
        .success()
        .stderr_eq(str![""]);
    let stdout = String::from_utf8_lossy(&run.get_output().stdout).into_owned();
    for part in ["deepest overlap", "no-tension", "p1c3b1|p1c3b2", "difference from rigid", "rigidity^"] {
        assert!(stdout.contains(part), "{part}:\n{stdout}");
    }
    let json = desk.json("c/compare.json");
    let runs = json["runs"].as_array().expect("three runs");
    assert_eq!(
        runs.iter().map(|r| r["heads"].as_str()).collect::<Vec<_>>(),
        [Some("free"), Some("no-tension"), Some("rigid")]
    );
    let deepest: Vec<f64> = runs.iter().map(|r| number(&r["deepest_interpenetration"])).collect();
    assert!(deepest[0] > 10.0 * deepest[1] && deepest[1] > 1e-10 && deepest[2] <= 1e-12, "{deepest:?}");
    for run in runs {
        assert!(number(&run["energy_residual_relative"]) < 1e-3, "{run}");
        assert_eq!(run["pairs"].as_array().map(Vec::len), Some(2));
    }
    assert!(number(&runs[2]["impacts"]) > 0.0 && number(&runs[0]["impacts"]) == 0.0);
    assert_eq!(json["convergence"].as_array().map(Vec::len), Some(2));
    for file in ["c/pair-1.png", "c/pair-2.png", "c/convergence.png"] {
        assert!(std::fs::metadata(desk.path(file)).is_ok_and(|m| m.len() > 1000), "{file}");
    }
}

#[test]
fn constrained_chooses_pairs_and_a_folder() {
    let desk = Desk::new();
    desk.concio("compare constrained wall.toml").assert().success();
    assert!(desk.get("concio-run/wall-constrained/pair-2.svg").contains("<svg"));
    let json = desk.json("concio-run/wall-constrained/compare.json");
    let of_pairs = |k: usize| number(&json["runs"][0]["pairs"][k]["deepest_interpenetration"]);
    assert_eq!(of_pairs(0), number(&json["runs"][0]["deepest_interpenetration"]), "the deepest comes first");
    assert!(of_pairs(0) >= of_pairs(1));
}

#[test]
fn constrained_refuses_what_it_cannot_compare() {
    let desk = Desk::new();
    desk.put("elastic.toml", WALL.replace("\"no-tension\"", "\"elastic\""));
    desk.put("planar.toml", WALL.replace("\"shear\"", "\"planar\""));
    desk.put("bonded.toml", WALL.replace("[load]", "[joint.bond]\ntensile_strength = \"5 kPa\"\n[load]"));
    for (command, parts) in [
        ("compare constrained elastic.toml", &["joint.head.law", "no-tension", "rigid"][..]),
        ("compare constrained planar.toml", &["model", "knows no planar walls", "allowed: shear"]),
        ("compare constrained bonded.toml", &["joint.bond.tensile_strength", "head joints of this wall are bonded"]),
        (
            "compare constrained wall.toml --pairs base|p1c1b1",
            &["no head joint", "`base|p1c1b1`", "for example p1c1b1|p1c1b2"],
        ),
        ("compare constrained wall.toml --restitution 1.5", &["1.5", "allowed: 0 to 1"]),
        ("compare constrained wall.toml --rigidity 10,0", &["0", "allowed: a number above 0"]),
        ("compare constrained wall.toml --out wall.toml", &["the folder for the results is a file"]),
        ("compare constrained nothing.toml", &["nothing.toml"]),
    ] {
        let refused = desk.concio(command).assert().code(2);
        let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        for part in parts {
            assert!(message.contains(part), "{command}: {part}\n{message}");
        }
        assert_eq!(
            desk.list(),
            ["bonded.toml", "elastic.toml", "planar.toml", "wall.toml"],
            "{command}: something was written"
        );
    }
}
