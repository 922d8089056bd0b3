//! `concio first-crack` and `[first-crack]`, `[cracks]` of a study, as a user types them.

use snapbox::str;

use crate::support::{Desk, WALL};

const MOTION: &str = "base = { sine = { acceleration = \"0.3 g\", frequency = \"5 Hz\", ramp = \"0.1 s\" } }\n";
const BOND: &str = "[joint.bond]\ntensile_strength = \"0.05 MPa\"\ncohesion = \"0.1 MPa\"\n";

/// The wall of the desk under a shaken base, bonded.
fn bonded() -> String {
    let free = WALL.replace("beam = \"driven\"", "beam = { mass = \"1 t\" }");
    let (head, _) = free.split_once("top = { sine").expect("the motion");
    let (joints, load) = head.split_once("[load]").expect("the loads");
    format!("{joints}{BOND}[load]{load}{MOTION}").replace("duration = \"0.05 s\"", "duration = \"0.4 s\"")
}

pub fn desk() -> Desk {
    let desk = Desk::new();
    desk.put("wall.toml", bonded());
    desk.put(
        "quake.at2",
        std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/guide/quake.at2")).expect("a record"),
    );
    desk
}

fn refused(desk: &Desk, line: &str, parts: &[&str]) {
    let before = desk.list();
    let message = desk.concio(line).assert().code(2).stdout_eq(str![""]);
    let message = String::from_utf8_lossy(&message.get_output().stderr).into_owned();
    for part in parts {
        assert!(message.contains(part), "{line}, {part}:\n{message}");
    }
    assert_eq!(desk.list(), before, "{line}: nothing is written");
}

#[test]
fn the_first_crack_is_told_with_its_runs() {
    let desk = desk();
    let told = desk.concio("first-crack wall.toml --out out --threads 1").assert().success();
    let told = String::from_utf8_lossy(&told.get_output().stdout).into_owned();
    assert!(told.contains("the wall's own motion") && told.contains("open out/report.html"), "{told}");
    let found = desk.json("out/first-crack.json");
    let motion = &found["motions"][0];
    let number = |v: &serde_json::Value| v.as_f64().expect("a number");
    let [below, crack] = [0, 1].map(|k| number(&motion["scale"][k]));
    assert!(below < crack && crack <= 1.01 * below, "{below} {crack}");
    // The sine has 0.3 g at scale 1.
    assert!((number(&motion["pga"][1]) / (0.3 * 9.81 * crack) - 1.0).abs() < 1e-3, "{motion}");
    let trials = motion["trials"].as_array().expect("the runs");
    for scale in [below, crack] {
        let run = trials.iter().find(|t| number(&t["scale"]) == scale).expect("an end is a run");
        assert_eq!(run["cracked"].as_bool(), Some(scale == crack));
    }
    assert!(motion["lower_scales"].as_array().is_some_and(|l| l.len() >= 3));
    for file in ["first-crack.csv", "first-crack-runs.csv", "report.html", "figures/first-crack.svg"] {
        assert!(desk.path("out").join(file).is_file(), "{file}");
    }
    // Again: nothing is run, nothing changes; another folder and more threads give the same bytes.
    let first = desk.get("out/first-crack.json");
    let runs = || std::fs::read_dir(desk.path("out/runs")).expect("the runs").count();
    let before = runs();
    desk.concio("first-crack wall.toml --out out").assert().success();
    assert_eq!((runs(), desk.get("out/first-crack.json")), (before, first.clone()));
    desk.concio("first-crack wall.toml --out other --threads 2").assert().success();
    assert_eq!(desk.get("other/first-crack.json"), first);
}

#[test]
fn records_take_the_place_of_the_motion() {
    let desk = desk();
    desk.concio("first-crack wall.toml --records quake.at2 --criterion slip --limit 0.002mm --out out")
        .assert()
        .success();
    let found = desk.json("out/first-crack.json");
    assert_eq!((found["motions"][0]["motion"].as_str(), found["limit"].as_f64()), (Some("quake"), Some(2e-6)));
    assert!(matches!(found["motions"][0]["kind"].as_str(), Some("bed" | "base" | "top")), "{found}");
}

#[test]
fn wrong_questions_are_refused() {
    let desk = desk();
    desk.put("dry.toml", bonded().replace(BOND, ""));
    desk.put("still.toml", bonded().replace(MOTION, "base = \"none\"\n"));
    refused(&desk, "first-crack wall.toml --records quake.at2,no.at2", &["--records", "no.at2"]);
    refused(&desk, "first-crack wall.toml --records quake.at2,quake.at2", &["--records", "twice"]);
    refused(
        &desk,
        "first-crack dry.toml",
        &["dry.toml: joint.bond: no joint of this wall is bonded", "[joint.bond]", "`--criterion slip`"],
    );
    refused(&desk, "first-crack still.toml", &["still.toml", "motion.base", "at rest", "--records"]);
    refused(&desk, "first-crack wall.toml --criterion slip --limit 0mm", &["--limit", "above 0mm"]);
    refused(&desk, "first-crack wall.toml --criterion slip --limit 0.1", &["--limit", "the unit is missing"]);
    refused(&desk, "first-crack wall.toml --limit 0.1mm", &["--limit", "a bond has its strength"]);
    refused(&desk, "first-crack wall.toml --interval 2", &["--interval", "1e-5 to 1"]);
    refused(&desk, "first-crack none.toml", &["none.toml"]);
}

pub const STUDY: &str = "wall = \"wall.toml\"\n\n[first-crack]\n\n[[motion]]\nname = \"there\"\nbase = { record = \"quake.at2\" }\n\n\
                     [[motion]]\nname = \"back\"\nbase = { record = \"quake.at2\", reverse = true }\n";

#[test]
fn wrong_studies_of_cracks_name_their_line() {
    let desk = desk();
    desk.put("dry.toml", bonded().replace(BOND, ""));
    desk.put("still.toml", bonded().replace(MOTION, "base = \"none\"\n"));
    let wrong: [(&str, &str, &[&str]); 8] = [
        ("wall.toml\"\n", "dry.toml\"\n", &["study.toml:3:", "no joint of this wall is bonded"]),
        ("[first-crack]\n", "[first-crack]\ncriterion = \"slip\"\nlimit = \"0 mm\"\n", &["study.toml:5:", "above 0 m"]),
        ("[first-crack]\n", "[first-crack]\nlimit = \"1 mm\"\n", &["study.toml:4:", "a bond has its strength"]),
        ("[first-crack]\n", "[first-crack]\ninterval = 0\n", &["study.toml:4:", "1e-5 to 1"]),
        ("[first-crack]\n", "scales = [1.0]\n[first-crack]\n", &["study.toml:3:", "scales"]),
        ("[first-crack]\n", "[cracks]\nthreshold = 0\n", &["study.toml:4:", "cracks.threshold", "above 0, to 1"]),
        ("[first-crack]\n", "[cracks]\ncriterion = \"slip\"\nlimit = \"-1 mm\"\n", &["study.toml:5:", "cracks.limit"]),
        ("\"quake.at2\" }", "\"no.at2\" }", &["study.toml:7:", "no.at2"]),
    ];
    for (old, new, parts) in wrong {
        let text = STUDY.replacen(old, new, 1);
        assert_ne!(text, STUDY, "{old}");
        desk.put("study.toml", text);
        for command in ["study check study.toml", "study run study.toml --out out"] {
            refused(&desk, command, parts);
        }
    }
    desk.put("study.toml", "wall = \"still.toml\"\n[first-crack]\n");
    refused(&desk, "study run study.toml --out out", &["study.toml", "there is no motion"]);
    desk.put("study.toml", STUDY.replace("[first-crack]", "[cracks]").replace("wall.toml", "dry.toml"));
    refused(&desk, "study run study.toml --out out", &["study.toml:3:", "cracks", "looks at no joint"]);
    let courses = "\n[[vary]]\npath = \"panel[0].courses\"\nvalues = [3, 4]\n";
    desk.put("study.toml", STUDY.replace("[first-crack]", "[cracks]") + courses);
    refused(&desk, "study run study.toml --out out", &["study.toml:3:", "different blocks"]);
}

/// Shards do the motions between them; reports and status come from what is there.
#[test]
fn shards_share_the_motions() {
    let desk = desk();
    desk.put("study.toml", STUDY);
    desk.concio("study run study.toml --out out --shard 1/2").assert().success();
    assert!(!desk.path("out/report.html").exists());
    desk.concio("study report study.toml --out out").assert().code(1);
    desk.concio("study run study.toml --out out --shard 2/2").assert().success();
    let first = desk.get("out/first-crack.csv");
    desk.concio("study run study.toml --out whole").assert().success();
    assert_eq!(desk.get("whole/first-crack.csv"), first);
    let status = desk.concio("study status study.toml --out out").assert().success();
    let status = String::from_utf8_lossy(&status.get_output().stdout).into_owned();
    assert!(status.contains("there") && status.contains("back"), "{status}");
}

#[test]
fn crack_lines_are_counted_over_runs() {
    let desk = desk();
    let scales = "wall = \"wall.toml\"\nscales = [2.0, 8.0]\n";
    let study = STUDY.replace("[first-crack]", "[cracks]").replace("wall = \"wall.toml\"\n", scales);
    let vary = "\n[[vary]]\npath = \"joint.bond.cohesion\"\nvalues = [\"0.08 MPa\", \"0.1 MPa\"]\n";
    desk.put("study.toml", study.replace("quake.at2\"", "quake.at2\", pga = \"0.2 g\"") + vary);
    desk.concio("study run study.toml --out out").assert().success();
    let lines = |name: &str| desk.get(name).lines().skip(1).map(str::to_string).collect::<Vec<_>>();
    let joints = lines("out/cracks.csv");
    let of = |group: &str| joints.iter().filter(|l| l.starts_with(&format!("{group},"))).count();
    assert!(of("all runs") > 0 && of("all runs") == of("scale 2") && of("scale 2") == of("scale 8"), "{joints:?}");
    assert!(joints.iter().filter(|l| l.starts_with("all runs,")).all(|l| l.split(',').nth(3) == Some("8")));
    // What is counted is what the runs say: 4 runs at each scale, kept without being asked for.
    let kept = desk.get("out/joints.csv");
    assert!(kept.lines().next().is_some_and(|l| l.contains("cracked")));
    let cells = |line: &str| line.split(',').map(str::to_string).collect::<Vec<_>>();
    for line in joints.iter().filter(|l| l.starts_with("all runs,")) {
        let line = cells(line);
        let cracked = kept.lines().map(cells).filter(|k| k[1] == line[1] && !k[2].is_empty()).count();
        assert_eq!(line[4], cracked.to_string(), "{line:?}");
    }
    assert!(desk.get("out/report.html").contains("Crack lines"));
    assert!(desk.path("out/figures/crack-lines.svg").is_file() && desk.path("out/crack-lines.csv").is_file());
}

const PLANAR: &str = r#"model = "planar"

[[panel]]
bond = "running"
courses = 3
bricks = 2
brick = { length = "250 mm", height = "120 mm", thickness = "250 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }

[joint]
bed = { law = "elastic", stiffness = "15 N/mm3" }
head = { law = "elastic", stiffness = "36 N/mm3" }
friction = { law = "coulomb", static = 0.6, dynamic = 0.6, on = "all" }
bond = { tensile_strength = "0.1 MPa", cohesion = "0.1 MPa", friction_angle = "31 deg" }

[motion]
base = { sine = { acceleration = "0.3 g", frequency = "5 Hz", ramp = "0.1 s" } }
duration = "0.3 s"
"#;

/// Reports of planar walls tell the limits of their own model; a wall that loads alone crack is not shaken ever more gently.
#[test]
fn planar_walls_have_limits_of_their_own_and_cracks_at_rest_are_told() {
    let desk = Desk::new();
    desk.put("wall.toml", PLANAR);
    desk.concio("first-crack wall.toml --interval 0.2 --out out").assert().success();
    let report = desk.get("out/report.html");
    assert!(report.contains("Limits of the planar model") && !report.contains("Blocks do not rock"));
    // Records are looked for where the wall file is, the vertical one too.
    let record = "{ record = \"up.txt\", units = \"m/s2\", dt = 0.01 }";
    desk.put("sub/up.txt", "0\n0.1\n0.2\n-0.1\n0\n");
    desk.put("sub/wall.toml", format!("{PLANAR}vertical = {record}\n"));
    desk.concio("first-crack sub/wall.toml --interval 0.2 --out up").assert().success();
    desk.put("weak.toml", PLANAR.replace("tensile_strength = \"0.1 MPa\", ", ""));
    let told = desk.concio("first-crack weak.toml --out weak").assert().code(1);
    let told = String::from_utf8_lossy(&told.get_output().stderr).into_owned()
        + &String::from_utf8_lossy(&told.get_output().stdout);
    assert!(told.contains("cracks under the loads at rest"), "{told}");
}
