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
        .stderr_eq(str![
            "warning: in every run, such as free: the largest base shear, [..] that friction can bear[..]\n"
        ]);
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

/// Two runs of one wall with other friction, in folders `a` and `b`.
fn two_runs() -> Desk {
    let desk = Desk::new();
    desk.put("other.toml", WALL.replace("static = 0.6, dynamic = 0.42", "static = 0.5, dynamic = 0.35"));
    desk.concio("run wall.toml --out a").assert().success();
    desk.concio("run other.toml --out b").assert().success();
    desk
}

/// What differs in the input, the numbers of both with difference and ratio, figures and page.
#[test]
fn two_runs_are_set_side_by_side() {
    let desk = two_runs();
    let done = desk.concio("compare a b").assert().success();
    let stdout = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
    let lines: Vec<Vec<&str>> = stdout.lines().map(|line| line.split_whitespace().collect()).collect();
    for line in [
        &["input", "a", "b"][..],
        &["joint.friction.dynamic", "0.42", "0.35"],
        &["joint.friction.static", "0.6", "0.5"],
        &["ended", "completed", "completed"],
        &["open", "concio-compare/a-b/report.html"],
    ] {
        assert!(lines.iter().any(|l| l == line), "{line:?}:\n{stdout}");
    }
    let (json, sides) =
        (desk.json("concio-compare/a-b/compare.json"), ["a", "b"].map(|k| desk.json(&format!("{k}/summary.json"))));
    assert_eq!(json["inputs"].as_array().map(Vec::len), Some(2), "{}", json["inputs"]);
    for (name, at) in [
        ("peak displacement", "/peak_relative_displacement"),
        ("friction", "/energy/friction"),
        ("peak base shear", "/base_shear_peak"),
    ] {
        let pair = json["numbers"]
            .as_array()
            .expect("numbers")
            .iter()
            .find(|p| p["name"] == name)
            .unwrap_or_else(|| panic!("no {name}"));
        let [a, b] = [0, 1].map(|k| number(sides[k].pointer(at).expect("a number")));
        assert_eq!((number(&pair["values"][0]), number(&pair["values"][1])), (a, b), "{name}");
        assert!(
            (number(&pair["difference"]) - (b - a)).abs() <= 1e-12 * a.abs() && number(&pair["ratio"]) == b / a,
            "{name}"
        );
    }
    let page = desk.get("concio-compare/a-b/report.html");
    for part in ["<h1>a beside b</h1>", "What differs", "joint.friction.static", "Numbers", "Histories", "<svg"] {
        assert!(page.contains(part), "{part}");
    }
    // Friction works less where it holds less: neither run is told as the other.
    for (figure, curves) in [("histories", "top"), ("loop", "base shear"), ("energies", "friction")] {
        let svg = desk.get(&format!("concio-compare/a-b/figures/{figure}.svg"));
        assert!(svg.contains("<svg") && svg.matches("<path").count() > 4, "{figure}: {curves}");
    }
    // The folder of the comparison may be chosen, and that of a run may not.
    desk.concio("compare a b --out c").assert().success();
    assert!(desk.path("c/report.html").is_file());
}

/// A run beside the same run, and beside one whose record has other values under the same name.
#[test]
fn runs_of_equal_input_say_so() {
    let desk = Desk::new();
    let (head, _) = WALL.split_once("duration = \"0.05 s\"").expect("the motion");
    let wall =
        head.replace("beam = \"driven\"", "beam = { mass = \"400 kg\" }") + "base = { record = \"quake.txt\" }\n";
    desk.put("wall.toml", wall);
    let quake = |g: &str| format!("# dt = 0.01 s, units: g\n0.0\n{g}\n-{g}\n0.0\n");
    desk.put("quake.txt", quake("0.1"));
    for out in ["a", "b"] {
        desk.concio(&format!("run wall.toml --out {out}")).assert().success();
    }
    let said =
        |line: &str| String::from_utf8_lossy(&desk.concio(line).assert().success().get_output().stdout).into_owned();
    assert!(said("compare a b").starts_with("  the input is the same\n"));
    let numbers = desk.json("concio-compare/a-b/compare.json")["numbers"].clone();
    assert!(numbers.as_array().expect("numbers").iter().all(|pair| number(&pair["difference"]) == 0.0), "{numbers}");
    desk.put("quake.txt", quake("0.2"));
    desk.concio("run wall.toml --out b").assert().success();
    assert!(said("compare a b").contains("the content of their records differs"));
}

/// A planar stone under its own weight.
const STONE: &str = "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 1\nbricks = 1\n\
    brick = { length = 0.5, height = 0.5, thickness = 0.5, specific_weight = 20e3 }\nmortar = { bed = 0, head = 0 }\n\
    [joint]\nbed = { law = \"rigid\" }\nhead = { law = \"none\" }\nfriction = { law = \"coulomb\", static = 0.6 }\n[motion]\nduration = 0.05\n";

#[test]
fn what_cannot_be_set_side_by_side_is_refused() {
    let desk = two_runs();
    desk.put("stone.toml", STONE);
    desk.concio("run stone.toml --out stone").assert().success();
    desk.put("empty/note.txt", "nothing");
    desk.put("cut/journal.bin", "rows");
    desk.concio("run wall.toml --out going").assert().success();
    desk.put("going/journal.bin", "rows");
    desk.concio("run wall.toml --out mixed").assert().success();
    desk.put("mixed/summary.json", desk.get("b/summary.json"));
    for (command, parts) in [
        ("compare a", &["required", "<B>"][..]),
        ("compare", &["required"]),
        ("compare a nothing", &["nothing: there is no such folder", "two folders are compared"]),
        ("compare a wall.toml", &["wall.toml: is no folder", "`concio run` wrote to"]),
        ("compare empty b", &["empty: there is no result.h5"]),
        ("compare a cut", &["cut: there is no result.h5", "goes on with it"]),
        ("compare a going", &["going: a run in this folder has not ended", "goes on with it"]),
        ("compare a mixed", &["mixed/summary.json", "belongs to another run"]),
        ("compare a a", &["a: is compared with itself", "two runs"]),
        ("compare a ./a/../a", &["is compared with itself"]),
        ("compare a stone", &["is a run of a shear wall, and stone one of a planar wall", "one model"]),
        ("compare a b --out b", &["is that of a run, whose report it would replace"]),
        ("compare a b --out wall.toml", &["the folder for the results is a file"]),
        ("compare a b c", &["'c' cannot be used with", "concio compare [OPTIONS] <A> <B>"]),
    ] {
        let refused = desk.concio(command).assert().code(2);
        let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        for part in parts {
            assert!(message.contains(part), "{command}: {part}\n{message}");
        }
        assert!(!desk.path("concio-compare").exists(), "{command}: something was written");
    }
}
