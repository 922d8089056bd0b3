//! Files that somebody else wrote: they command no terminal, break no drawing and exhaust no machine.

use std::fs;
use std::process::Command;

use resvg::usvg::{Options, Tree};

use crate::support::{Desk, PROGRAM, WALL};

#[path = "../../../concio-study/tests/mutants/mod.rs"]
mod mutants;

/// Sets the title of a terminal, clears it, colours it; C1's own introducer, marks that turn the order of reading, and an end of
/// line with what looks like a message of ours.
const HOSTILE: &str = "N\u{1b}]0;owned\u{7}\u{1b}[2J\u{9b}31m\u{202e}\u{2066}\u{200f}\u{61c}\nerror: not ours";

/// The same in the quotes of TOML and JSON.
fn quoted(text: &str) -> String {
    text.chars().map(|c| format!("\\u{:04x}", u32::from(c))).collect()
}

/// What a terminal would obey.
fn commands(text: &str) -> Vec<char> {
    let turns =
        |c: char| matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    text.chars().filter(|c| turns(*c) || (c.is_control() && !matches!(c, '\n' | '\t'))).collect()
}

fn said(desk: &Desk, arguments: &[&str]) -> String {
    let output = Command::new(PROGRAM).current_dir(desk.path("")).args(arguments).output().unwrap();
    let [out, error] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8(bytes.clone()).unwrap());
    // Colours are for terminals alone: here are none of our own either.
    assert_eq!(commands(&out), [], "{arguments:?}: {out:?}");
    assert_eq!(commands(&error), [], "{arguments:?}: {error:?}");
    assert!(!format!("\n{out}\n{error}").contains("\nerror: not ours"), "{arguments:?}: {out}{error}");
    format!("{out}{error}")
}

/// Two blocks with such names, in such a panel.
fn named(name: &str) -> String {
    let block = |id: &str, course: usize| {
        let y = 0.01 + 0.065 * (course - 1) as f64;
        format!("[[panel.block]]\nid = \"{id}\"\ncourse = {course}\nx = 0\ny = {y}\nlength = 0.25\nheight = 0.055\n")
    };
    // Names of blocks have no blanks.
    let id: String = name.chars().filter(|c| !c.is_whitespace()).collect();
    let (title, id) = (quoted(name), quoted(&id));
    let blocks = [block(&format!("{id}1"), 1), block(&format!("{id}2"), 2)].concat();
    let wall = WALL.replace("title = \"Small wall\"", &format!("title = \"{title}\""));
    let wall = wall.replace(
        "bond = \"running\"\ncourses = 4\nbricks = 2\n",
        &format!("name = \"{title}\"\nbond = \"explicit\"\n"),
    );
    wall.replace("[joint]", &format!("{blocks}\n[joint]"))
}

#[test]
fn nothing_in_a_file_commands_a_terminal() {
    let desk = Desk::new();
    desk.put("wall.toml", named(HOSTILE));
    assert!(said(&desk, &["check", "wall.toml", "--joints"]).contains("]0;owned"));
    said(&desk, &["run", "wall.toml", "-o", "o"]);
    said(&desk, &["plot", "o", "--figure", "all", "--blocks", HOSTILE]);
    said(&desk, &["plot", "o", "--figure", "all"]);
    said(&desk, &["export", "o", "--csv"]);
    said(&desk, &["system", "wall.toml"]);
    let asked = desk.get("wall.toml") + &format!("[output]\njoints = [\"{}\"]\n", quoted(HOSTILE));
    desk.put("asked.toml", asked);
    assert!(said(&desk, &["check", "asked.toml"]).contains("output.joints"));
    desk.put("raw.toml", format!("title = \"{HOSTILE}\"\n"));
    said(&desk, &["check", "raw.toml"]);
    desk.put("key.toml", format!("\"{}\" = 1\n", quoted(HOSTILE)));
    said(&desk, &["check", "key.toml"]);
    let planar = named(HOSTILE).replace("model = \"shear\"", "model = \"planar\"");
    desk.put("planar.toml", planar.replace("beam = \"driven\"", "").replace("top = { sine", "base = { sine"));
    said(&desk, &["limit", "planar.toml"]);
    said(&desk, &["limit", "planar.toml", "--json"]);
    let study = format!(
        "title = \"{0}\"\nwall = \"wall.toml\"\n[[vary]]\nname = \"{0}\"\npath = \"joint.friction.static\"\nvalues = [0.5, 0.6]\n",
        quoted(HOSTILE)
    );
    desk.put("study.toml", study.clone());
    for what in ["check", "run", "status", "export"] {
        let said = said(&desk, &["study", what, "study.toml", "--out", "s"]);
        assert_eq!(said.contains("]0;owned"), what != "export", "{what}: {said}");
    }
    desk.put("lost.toml", study.replace("joint.friction.static", &quoted(HOSTILE)));
    said(&desk, &["study", "check", "lost.toml"]);
}

#[test]
fn nothing_in_a_record_commands_a_terminal() {
    let desk = Desk::new();
    let event = HOSTILE.replace('\n', " ");
    let values = "0.0 0.1 0.3 -0.2 0.1\n".repeat(20);
    desk.put(
        "q.at2",
        format!(
            "PEER STRONG MOTION\n{event}, STATION, 90\nACCELERATION IN UNITS OF G\nNPTS= 100, DT= .0100 SEC\n{values}"
        ),
    );
    assert!(said(&desk, &["record", "q.at2"]).contains("]0;owned"));
    // Programs get what the file says.
    let json: serde_json::Value = serde_json::from_str(&said(&desk, &["record", "q.at2", "--json"])).unwrap();
    assert!(json["event"].as_str().unwrap().contains("\u{1b}]0;owned\u{7}"), "{}", json["event"]);
    desk.put("bad.at2", desk.get("q.at2").replacen("0.1", "\u{1b}[2J", 1));
    said(&desk, &["record", "bad.at2"]);
}

#[test]
fn nothing_that_is_typed_commands_a_terminal() {
    let desk = Desk::new();
    for arguments in [
        vec![HOSTILE],
        vec!["--\u{1b}[2J"],
        vec!["run", HOSTILE],
        vec!["run", "wall.toml", HOSTILE],
        vec!["run", "--\u{1b}[2J", "wall.toml"],
        vec!["record", "a.at2", "--dt", HOSTILE],
        vec!["plot", HOSTILE],
        vec!["plot", "o", "--figure", HOSTILE],
        vec!["export", HOSTILE, "--csv"],
        vec!["study", HOSTILE],
        vec!["study", "check", HOSTILE],
        vec!["new", "no/\u{1b}[2J.toml"],
        vec!["completions", HOSTILE],
    ] {
        let output = said(&desk, &arguments);
        assert!(output.contains("error"), "{arguments:?}: {output}");
    }
}

/// Arguments need not be text.
#[cfg(target_os = "linux")]
#[test]
fn arguments_that_are_no_text_are_refused() {
    use std::os::unix::ffi::OsStrExt;
    let odd = std::ffi::OsStr::from_bytes(b"\xff\x1b[2J");
    for before in [&[][..], &["study"], &["record", "a.at2", "--dt"]] {
        let output = Command::new(PROGRAM).args(before).arg(odd).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{before:?}");
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.starts_with("error: ") && commands(&error).is_empty(), "{error:?}");
    }
}

/// XML has no control characters, U+FFFE and U+FFFF, whatever a name has.
#[test]
fn every_name_gives_a_drawing() {
    let desk = Desk::new();
    for (k, name) in
        ["a\u{fffe}b", "a\u{ffff}", "\u{1}\u{b}\u{1f}\u{7f}", "<&\"'>]]>", "\u{85}\u{2028}\u{feff}\u{10ffff}", HOSTILE]
            .iter()
            .enumerate()
    {
        desk.put("wall.toml", named(name) + "[output]\nblocks = \"all\"\njoints = \"all\"\n");
        desk.put("wall.toml", desk.get("wall.toml").replace("\"all\"", "[\"all\"]"));
        said(&desk, &["check", "wall.toml", "--svg", "wall.svg"]);
        let valid = |file: &str| drop(Tree::from_str(&desk.get(file), &Options::default()).expect(file));
        valid("wall.svg");
        let out = format!("o{k}");
        said(&desk, &["run", "wall.toml", "-o", &out]);
        said(&desk, &["plot", &out, "--figure", "all"]);
        let drawn = fs::read_dir(desk.path(&out).join("figures")).unwrap().map(|e| e.unwrap().file_name());
        let drawn: Vec<_> = drawn.map(|name| name.into_string().unwrap()).collect();
        assert!(drawn.len() >= 10, "{drawn:?}");
        drawn.iter().for_each(|name| valid(&format!("{out}/figures/{name}")));
        let page = desk.get(&format!("{out}/report.html"));
        let odd = |c: &char| (c.is_control() && !matches!(c, '\n' | '\t')) || matches!(c, '\u{fffe}' | '\u{ffff}');
        let drawings = page.split("<noscript>").nth(2).expect("the part without scripts").split("</noscript>").next();
        assert_eq!(drawings.unwrap().chars().find(odd), None);
        said(&desk, &["export", &out, "--csv"]);
        said(&desk, &["export", &out, "--vtkhdf"]);
        said(&desk, &["export", &out, "--npz"]);
    }
}

/// A program for tables would reckon them.
#[test]
fn no_name_is_a_formula() {
    let desk = Desk::new();
    desk.put("wall.toml", named("=HYPERLINK(1)"));
    said(&desk, &["run", "wall.toml", "-o", "o"]);
    said(&desk, &["export", "o", "--csv"]);
    let blocks = desk.get("o/csv/blocks.csv");
    assert!(blocks.contains("\n'=HYPERLINK(1)1,'=HYPERLINK(1),"), "{blocks}");
    // Negative numbers are numbers, and names such as -1 too.
    assert!(desk.get("o/csv/histories.csv").contains(",-"));
}

/// Exit status 2 with a message within the memory given, whatever a file asks for.
#[cfg(target_os = "linux")]
#[test]
fn what_asks_for_too_much_is_refused() {
    let desk = Desk::new();
    let many = |table: &str, n: usize| WALL.replace("[load]", &(table.repeat(n) + "[load]"));
    let change = "[[joint.change]]\nat = { course = [1] }\nfriction = { static = 0.4, dynamic = 0.3 }\n";
    let panel = WALL.split("[joint]").next().unwrap().split("\n\n").nth(1).unwrap();
    desk.put("changes.toml", many(change, 100_001));
    desk.put("more.toml", many(change, 300_000));
    desk.put("large.toml", many("# nothing\n", 4_000_000));
    desk.put(
        "dense.toml",
        many("", 0).replace("[joint]", &format!("[joint]\nchange = [{}]", "{a=1},".repeat(1_000_000))),
    );
    desk.put("dense.json", format!("{{\"panel\": [{}1]}}", "{\"a\":1},".repeat(1_000_000)));
    desk.put("panels.toml", WALL.replace("[joint]", &format!("{}\n[joint]", format!("{panel}\n").repeat(20_000))));
    desk.put("deep.json", format!("{}1{}", "[".repeat(1_000_000), "]".repeat(1_000_000)));
    desk.put("deep.toml", format!("a = {}1{}", "[".repeat(1_000_000), "]".repeat(1_000_000)));
    desk.put("keys.toml", format!("{} = 1", vec!["a"; 500_000].join(".")));
    desk.put("word.toml", format!("{} = 1", "a".repeat(5_000_000)));
    desk.put("courses.toml", WALL.replace("courses = 4", "courses = 1000000000"));
    desk.put(
        "step.toml",
        WALL.replace("\"shear\"", "\"planar\"")
            .replace("\nbeam = \"driven\"", "")
            .replace("top = { sine", "base = { sine")
            + "[solver]\nstep = \"1e-15 s\"\n",
    );
    for (name, says) in [
        ("changes.toml", "up to 100000"),
        ("more.toml", "up to 1 GiB"),
        ("large.toml", "up to 32 MiB"),
        ("dense.toml", "up to 1 GiB"),
        ("dense.json", "up to 1 GiB"),
        ("panels.toml", "up to 1000"),
        ("deep.json", "not valid JSON"),
        ("deep.toml", "not valid TOML"),
        ("keys.toml", "not valid TOML"),
        ("word.toml", "unknown key"),
        ("courses.toml", "blocks"),
        ("step.toml", "solver.step"),
    ] {
        refused(&desk, &format!("check {name}"), says);
    }
    let study = |path: &str| format!("wall = \"wall.toml\"\n[[vary]]\npath = \"{path}\"\nvalues = [1, 2]\n");
    desk.put("path.toml", study(&vec!["a"; 55_000].join(".")));
    desk.put("runs.toml", study("joint.friction.static") + "[design]\nkind = \"random\"\nruns = 1000000000\n");
    refused(&desk, "study check path.toml", "up to 64 steps");
    refused(&desk, "study check runs.toml", "up to 500,000");
}

/// With 2 GB of memory, of addresses even, which are more.
#[cfg(target_os = "linux")]
fn refused(desk: &Desk, line: &str, says: &str) {
    let command = format!("ulimit -v 2000000; exec {PROGRAM} {line}");
    let output = Command::new("sh").args(["-c", &command]).current_dir(desk.path("")).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{line}: {error:.2000}");
    assert!(error.contains(says) && error.len() < 20_000, "{line}: {error:.2000}");
}

/// A few of those that the library is tried with (`concio-study`, `mutations`), by the program.
#[cfg(target_os = "linux")]
#[test]
fn mutated_files_end_with_status_0_or_2() {
    let desk = Desk::new();
    let (walls, studies) = (mutants::examples(""), mutants::examples("studies"));
    let mut dice = concio::dice::Dice::new(3);
    for number in 0..32 {
        let (files, line) = if number % 4 == 0 { (&studies, "study check") } else { (&walls, "check") };
        let file = mutants::mutant(&files[dice.below(files.len())], &mut dice);
        desk.put("mutant.toml", &file);
        let command = format!("ulimit -v 2500000; exec {PROGRAM} {line} mutant.toml");
        let output = Command::new("sh").args(["-c", &command]).current_dir(desk.path("")).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        let text = String::from_utf8_lossy(&file);
        assert!(matches!(output.status.code(), Some(0 | 2)), "{number}: {:?}\n{error}\n{text}", output.status);
    }
}
