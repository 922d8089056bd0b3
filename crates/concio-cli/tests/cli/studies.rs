//! What `concio study` says of a study: when it is checked, when it is over, in its report, and when it is wrong.

use snapbox::str;

use crate::support::{Desk, WALL};

/// The wall of the desk, shaken for a moment.
fn shaken() -> String {
    let free = WALL.replace("beam = \"driven\"", "beam = { mass = \"499 kg\" }");
    let (head, _) = free.split_once("top = { sine").expect("the motion");
    format!("{head}base = {{ pulse = {{ shape = \"one-sine\", acceleration = \"0.6 g\", duration = \"40 ms\" }} }}\n")
}

const MOTIONS: &str = r#"
[[motion]]
name = "strong"
base = { pulse = { shape = "one-sine", acceleration = "0.9 g", duration = "40 ms" } }
[[motion]]
name = "weak"
base = { pulse = { shape = "one-sine", acceleration = "0.3 g", duration = "40 ms" } }
"#;
const VARY: &str = r#"
[[vary]]
name = "friction"
path = "joint.friction.static"
distribution = { law = "lognormal", median = 0.6, dispersion = 0.1, low = 0.5 }
"#;
const DRAWN: &str = "[design]\nkind = \"latin-hypercube\"\nruns = 6\nseed = 4\n";
const CRACK: &str = "[first-crack]\ncriterion = \"slip\"\n";
const IDA: &str = "[ida]\ndamage = \"largest_slip\"\nlimits = [{ name = \"a\", value = \"1 mm\" }]\n\
                   intensities = [\"0.2 g\", \"0.4 g\"]\n";

fn desk(study: &str) -> Desk {
    let desk = Desk::new();
    desk.put("wall.toml", shaken());
    desk.put("study.toml", format!("wall = \"wall.toml\"\n{study}"));
    desk
}

/// What a command that succeeds prints on standard output, and on standard error.
fn said(desk: &Desk, line: &str) -> [String; 2] {
    let done = desk.concio(line).assert().success();
    [&done.get_output().stdout, &done.get_output().stderr].map(|t| String::from_utf8_lossy(t).into_owned())
}

fn holds(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part}:\n{text}");
    }
}

/// Sensitivity and ranking: asked, answered on the terminal, and what was run in the report.
#[test]
fn a_study_says_what_was_run_and_what_it_answers() {
    let asked = "[sensitivity]\nof = [\"peak_drift\"]\n[ranking]\nlisted = 2\nby = [\"displacement\"]\n";
    let desk = desk(&format!("{DRAWN}{VARY}{MOTIONS}{asked}"));
    let parts = [
        "asks       sensitivity of peak_drift\n",
        "asks       critical joints by relative displacement\n",
        "design     Latin hypercube: 6 runs, seed 4\n",
        "varies     friction (joint.friction.static): lognormal, median 0.6, dispersion 0.1, cut off below 0.5\n",
        "motion     strong: one-sine pulse, acceleration 8.829 m/s² = 0.9000 g, 0.04 s from 0 s\n",
    ];
    let [text, warned] = said(&desk, "study check study.toml --out out");
    let squeezed = text.replace("  ", " ");
    for part in parts.map(|p| p.replace("  ", " ").replace("  ", " ")) {
        let words = |t: &str| t.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words(&squeezed).contains(&words(&part)), "{part}:\n{text}");
    }
    assert!(text.contains("runs") && warned.is_empty(), "{warned}");
    let [text, _] = said(&desk, "study run study.toml --out out");
    holds(
        &text,
        &["sensitivity of", "rank regression coefficient", "peak_drift", "critical joints", "by relative displacement"],
    );
    // Two joints are listed, no third.
    let places: Vec<&str> = text.lines().filter(|l| l.trim_start().starts_with(['1', '2', '3'])).collect();
    assert_eq!(places.len(), 2, "{text}");
    let page = desk.get("out/report.html");
    let (_, first) = page.split_once("<h2>").expect("a section");
    assert!(first.starts_with("What was run</h2>"));
    holds(
        &page,
        &[
            "Design: Latin hypercube: 6 runs, seed 4.",
            "All 6 runs were completed.",
            "lognormal, median 0.6, dispersion 0.1, cut off below 0.5",
            "0.9000 g",
            "Blocks do not rock",
            "Wall of the first run: 10 blocks",
        ],
    );
}

/// The first run of a study whose step becomes too short: the report names it and its cause.
#[test]
fn a_run_that_fails_is_in_the_report_with_its_cause() {
    let desk = desk("[[vary]]\npath = \"motion.base.record\"\nvalues = [\"good.txt\", \"bad.txt\"]\n");
    let wall = shaken();
    let (head, _) = wall.split_once("base = { pulse").expect("the motion");
    desk.put("wall.toml", format!("{head}base = {{ record = \"good.txt\" }}\n").replace("duration = \"0.05 s\"\n", ""));
    desk.put("good.txt", "# dt = 0.01 s, units: g\n0.0\n0.1\n-0.2\n");
    desk.put("bad.txt", "# dt = 0.01 s, units: g\n0.0\n0.1\nnan\n");
    desk.concio("study run study.toml --out out").assert().code(1);
    let page = desk.get("out/report.html");
    holds(
        &page,
        &["Of 2 runs, 1 completed, 1 failed.", "Runs without a complete result", "motion.base.record = bad.txt"],
    );
}

/// First cracking: the same first section for a study and for one wall; by slip, springs count.
#[test]
fn first_cracking_says_what_was_run_and_that_springs_count() {
    let desk = desk(&format!("{CRACK}limit = \"1 um\"\nchecks = 0\ninterval = 0.5\n{MOTIONS}"));
    let [text, _] = said(&desk, "study check study.toml");
    holds(&text, &["first cracking (slip) under 2 motions", "0.3000 g", "0 runs"]);
    let [_, noted] = said(&desk, "study run study.toml --out out");
    holds(&noted, &["note: criterion slip", "elastically counts"]);
    holds(
        &desk.get("out/report.html"),
        &[
            "<h2>What was run</h2>",
            "Design: grid, every value with every other: 2 cases",
            "0.9000 g",
            "Blocks do not rock",
            "elastically counts",
        ],
    );
    let [_, noted] =
        said(&desk, "first-crack wall.toml --criterion slip --limit 1um --checks 0 --interval 0.5 --out one");
    holds(&noted, &["elastically counts"]);
    holds(&desk.get("one/report.html"), &["<h2>What was run</h2>", "0.6000 g", "10 blocks", "Blocks do not rock"]);
    let [_, noted] =
        said(&desk, "first-crack wall.toml --criterion opening --limit 1um --checks 0 --interval 0.5 --out two");
    assert!(!noted.contains("elastically counts"), "{noted}");
}

/// Numbers that are hardly meant, and motions that a run cuts: a study warns of them as `concio check` does.
#[test]
fn the_warnings_of_the_wall_are_those_of_its_studies() {
    let desk = desk("[[vary]]\npath = \"joint.friction.static\"\nvalues = [0.6, 0.7]\n");
    desk.put("wall.toml", shaken().replace("specific_weight = \"18 kN/m3\"", "specific_weight = \"1.8 kN/m3\""));
    let [_, of_wall] = said(&desk, "check wall.toml");
    holds(&of_wall, &["warning: panel[0].brick.specific_weight is 1800 N/m3"]);
    // That of the wall file stands in every run; what a run itself is warned of comes behind it.
    let in_every = of_wall.replace("warning: ", "warning: in every run: ");
    for command in ["check", "run"] {
        let [_, warned] = said(&desk, &format!("study {command} study.toml --out out"));
        assert!(warned.starts_with(&in_every), "{command}: {warned}");
        assert_eq!(warned.matches("specific_weight").count(), 1, "{command}: {warned}");
    }
    // A record of which a run sees a part alone.
    let record = format!("# dt = 0.01 s, units: g\n{}", "0.1\n-0.1\n".repeat(50));
    desk.put("long.txt", record);
    desk.put(
        "study.toml",
        format!("wall = \"wall.toml\"\n{MOTIONS}[[motion]]\nname = \"long\"\nbase = {{ record = \"long.txt\" }}\n"),
    );
    let [_, warned] = said(&desk, "study check study.toml --out out");
    assert_eq!(warned.matches("specific_weight").count(), 1, "{warned}");
    holds(&warned, &["warning: in 1 of 3 runs, run 3 (motion = long): motion.duration cuts the record of the base"]);
}

/// Questions that would be passed over in silence, and lists that choose nothing: text below `wall = …`, the place, parts
/// of the message.
const WRONG: [(&str, &[&str], &str, &[&str]); 18] = [
    ("ranking beside a search of its own", &[CRACK, "[ranking]\n"], "study.toml:4:", &["ranking", "`[first-crack]`"]),
    ("keep beside it", &[CRACK, "[keep]\njoints = [\"slip\"]\n"], "study.toml:5:", &["keep.joints", "`[first-crack]`"]),
    ("whole results beside it", &[CRACK, "[keep]\nresults = true\n"], "study.toml:5:", &["keep.results"]),
    (
        "ranking beside an incremental analysis",
        &[MOTIONS, IDA, "[ranking]\n"],
        "study.toml:13:",
        &["ranking", "`[ida]`"],
    ),
    (
        "values per joint that no table shows",
        &[MOTIONS, IDA, "[keep]\njoints = [\"slip\"]\n"],
        "study.toml:14:",
        &["keep.joints", "`[ida]`"],
    ),
    (
        "damage without bonds",
        &["[ranking]\nby = [\"slip\", \"damage\"]\n"],
        "study.toml:3:",
        &["ranking.by[1]", "joint.bond"],
    ),
    (
        "joints that differ",
        &["[ranking]\n[[vary]]\npath = \"panel[0].bricks\"\nvalues = [2, 3]\n"],
        "study.toml:2:",
        &["different joints", "leave blocks"],
    ),
    (
        "fewer runs than one",
        &["[design]\nkind = \"random\"\nruns = -1\n"],
        "study.toml:4:",
        &["design.runs", "the number -1 cannot stand here", "a whole number from 1"],
    ),
    (
        "runs of a hunt",
        &[
            MOTIONS,
            "[ida]\ndamage = \"largest_slip\"\nlimits = []\nhunt = { first = 1, step = 1, most = 9, runs = 4.5 }\n",
        ],
        "study.toml:12:",
        &["ida.hunt.runs", "a whole number, 4 … 1,000"],
    ),
    ("no scale", &["scales = []\n"], "study.toml:2:", &["scales", "is empty", "above 0"]),
    ("a scale twice", &["scales = [1.0, 2.0, 1]\n"], "study.toml:2:", &["scales[2]", "1 stands there twice", "once"]),
    (
        "a design of nothing",
        &["[design]\nkind = \"morris\"\nruns = 4\n"],
        "study.toml:2:",
        &["nothing varies", "[[vary]]"],
    ),
    (
        "one motion at two strengths",
        &[
            "[[motion]]\nname = \"a\"\nbase = { sine = { acceleration = 1, frequency = 3, cycles = 2 } }\n",
            "[[motion]]\nname = \"b\"\nbase = { sine = { acceleration = 2, frequency = 3, cycles = 2 } }\n",
            IDA,
        ],
        "study.toml:7:",
        &["`a` and `b` are one motion"],
    ),
    ("nothing that varies", &["vary = []\n"], "study.toml:2:", &["vary"]),
    (
        "a value that another key bounds",
        &["[[vary]]\npath = \"joint.friction.static\"\nvalues = [0.1]\n"],
        "study.toml:2:",
        &["dynamic", "`also`"],
    ),
    (
        "a kind of joint that chooses none",
        &["[interfaces]\nat = { kind = [] }\ncount = 1\nruns = 100\n"],
        "study.toml:3:",
        &["interfaces.at.kind", "is empty"],
    ),
    (
        "a key that follows and is none",
        &[
            "[[vary]]\npath = \"joint.friction.static\"\nvalues = [0.6]\nalso = [\n{ path = \"joint.friction.dynmic\", times = 1 }]\n",
        ],
        "study.toml:6:",
        &["vary[0].also[0].path", "did you mean `dynamic`?"],
    ),
    (
        "the second motion",
        &[
            "[[motion]]\nname = \"a\"\nbase = { sine = { acceleration = 1, frequency = 3 } }\nduration = 1\n",
            "[[motion]]\nname = \"b\"\nbase = { sine = { acceleration = 1, frequency = -3 } }\nduration = 1\n",
        ],
        "study.toml:6:",
        &["motion[1]", "motion.base.sine.frequency", "above 0"],
    ),
];

#[test]
fn nothing_that_a_study_says_is_passed_over() {
    for (name, text, place, parts) in WRONG {
        let desk = desk(&text.concat());
        for command in ["check", "run"] {
            let refused = desk.concio(&format!("study {command} study.toml --out out")).assert().code(2);
            let refused = refused.stdout_eq(str![""]);
            let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
            assert!(message.starts_with("error: ") && message.contains("allowed: "), "{name}: {message}");
            for part in parts.iter().chain([&place]) {
                assert!(message.contains(part), "{name}, {part}:\n{message}");
            }
        }
        assert_eq!(desk.list(), ["study.toml", "wall.toml"], "{name}: nothing is written");
    }
}

/// Rows that were made before anything was kept per joint are no answer to a question that needs it.
#[test]
fn a_question_asked_later_has_its_runs_done_again() {
    let desk = desk(&format!("{MOTIONS}{VARY}{DRAWN}"));
    desk.concio("study run study.toml --out out").assert().success();
    let asked = format!("{MOTIONS}{VARY}{DRAWN}[cracks]\ncriterion = \"slip\"\nlimit = \"0.001 um\"\n");
    desk.put("study.toml", format!("wall = \"wall.toml\"\n{asked}"));
    let refused = desk.concio("study report study.toml --out out").assert().code(2);
    assert!(String::from_utf8_lossy(&refused.get_output().stderr).contains("or holds what it keeps"));
    let [said, _] = said(&desk, "study status study.toml --out out");
    assert!(said.contains("not run"), "{said}");
    desk.concio("study run study.toml --out out").assert().success();
    assert!(desk.get("out/report.html").contains("Crack"));
}

/// A record that the run cuts: said when it is checked, and kept in the report.
#[test]
fn warnings_stand_in_the_report() {
    let desk = desk(
        "[[motion]]\nname = \"cut\"\nbase = { synthetic = { seed = 1, pga = \"0.2 g\", duration = \"3 s\" } }\nduration = \"0.2 s\"\n",
    );
    let [_, warned] = said(&desk, "study run study.toml --out out");
    assert!(warned.contains("warning: ") && warned.contains("0.2 s"), "{warned}");
    let report = desk.get("out/report.html");
    holds(&report, &["Warnings", "0.2 s of 3 s used"]);
}

#[test]
fn wall_and_study_files_are_told_apart() {
    let desk = desk(VARY);
    for (line, part) in [
        ("run study.toml", "is a study file"),
        ("check study.toml", "`concio study check`"),
        ("first-crack study.toml", "is a study file"),
        ("study run wall.toml", "is a wall file"),
        ("study check wall.toml", "`concio check`"),
        ("study status wall.toml", "is a wall file"),
        ("study resume wall.toml", "is a wall file"),
        ("study resume none.toml", "none.toml"),
    ] {
        let refused = desk.concio(line).assert().code(2).stdout_eq(str![""]);
        let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(message.contains(part), "{line}: {message}");
    }
}
