//! Wrong inputs as a user meets them: file, line, cause and allowed range on standard error, exit status 2, nothing
//! written.

use snapbox::str;

use crate::support::{Desk, WALL};

/// What is wrong, the text that is replaced in the wall and by what, and parts of the message.
const WRONG: [(&str, &str, &str, &[&str]); 21] = [
    ("unknown key", "courses = 4", "corses = 4", &["bad.toml:6:", "corses", "courses"]),
    ("wrong unit", "\"55 mm\"", "\"55 kg\"", &["bad.toml:8:", "kg", "mm"]),
    ("no unit", "\"250 mm\"", "\"250\"", &["bad.toml:8:", "unit"]),
    ("negative length", "\"250 mm\"", "\"-250 mm\"", &["bad.toml:8:", "panel[0].brick.length", "above 0"]),
    ("no courses", "courses = 4", "courses = 0", &["bad.toml:6:", "courses", "from 1"]),
    ("negative load", "top = \"10 kN/m\"", "top = \"-1 kN/m\"", &["bad.toml:18:", "load.top"]),
    ("no slip velocity", "\"1 mm/s\"", "\"0 mm/s\"", &["bad.toml:15:", "slip_velocity", "above 0"]),
    ("dynamic above static", "dynamic = 0.42", "dynamic = 0.7", &["bad.toml:15:", "dynamic"]),
    ("a beam that nobody drives", "beam = \"driven\"", "beam = \"free\"", &["bad.toml:", "motion.top"]),
    ("broken TOML", "[joint]", "[joint", &["bad.toml:11:"]),
    (
        "a record that is not there",
        "top = { sine",
        "base = { record = \"no.at2\" }\ntop = { sine",
        &["no.at2", "bad.toml:23 as motion.base.record"],
    ),
    ("letters swapped", "courses = 4", "coures = 4", &["bad.toml:6:", "did you mean `courses`?"]),
    ("a decimal comma", "static = 0.6", "static = 0,6", &["bad.toml:15:", "write 0.6"]),
    ("a decimal comma in a text", "\"250 mm\"", "\"2,5 m\"", &["bad.toml:8:", "write 2.5"]),
    ("an open brace", "head = \"10 mm\" }", "head = \"10 mm\"", &["bad.toml:", "of line 9 not closed?"]),
    (
        "a required key misspelt",
        "static = 0.6",
        "statc = 0.6",
        &["joint.friction.static", "is `statc` meant to be `static`?"],
    ),
    ("a required table misspelt", "[load]", "[laod]", &["laod", "`load`"]),
    ("number of courses", "courses = 4", "course = 4", &["bad.toml:6:", "did you mean `courses`?"]),
    ("single brackets", "[[panel]]", "[panel]\n[panel]", &["bad.toml:5:", "`[[panel]]`"]),
    (
        "a bed joint that does not slide",
        "law = \"elastic\"",
        "law = \"rigid\"",
        &["bad.toml:13:", "`rigid` is for head joints", "elastic, none"],
    ),
    (
        "too much restitution",
        "rigidity = 1000",
        "restitution = 0.5",
        &["bad.toml:14:", "joint.head.restitution", "`rigid`"],
    ),
];

#[test]
fn wrong_walls_are_refused_with_their_place() {
    for (name, old, new, parts) in WRONG {
        let desk = Desk::new();
        let wall = WALL.replace(old, new);
        assert_ne!(wall, WALL, "{name}");
        desk.put("bad.toml", wall);
        for command in ["check bad.toml --svg wall.svg", "run bad.toml", "system bad.toml"] {
            let refused = desk.concio(command).assert().code(2).stdout_eq(str![""]);
            let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
            assert!(message.starts_with("error: "), "{name}: {message}");
            for part in parts {
                assert!(message.contains(part), "{name}, {part}:\n{message}");
            }
        }
        assert_eq!(desk.list(), ["bad.toml", "wall.toml"], "{name}: nothing is written");
    }
}

/// A record given as a wall file, a folder that is not there, and names beyond the wall.
#[test]
fn what_was_meant_is_guessed() {
    let desk = Desk::new();
    let record = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/guide/quake.at2");
    desk.put("quake.at2", std::fs::read(record).expect("the record of the guide"));
    desk.put("reach.toml", format!("{WALL}[output]\nblocks = [\"p1c9b1\"]\n"));
    let told = [
        ("check quake.at2", "`concio record` measures it"),
        ("check wall.toml --svg nodir/x.svg", "the folder nodir does not exist"),
        ("record quake.at2 --svg nodir/x.svg", "the folder nodir does not exist"),
        ("check reach.toml", "panel 1 has 4 courses"),
        ("plot r --figure deformed --at 3", "write 3s"),
        ("plot r --figure deformed --width 85", "write 85mm"),
    ];
    for (command, part) in told {
        let refused = desk.concio(command).assert().code(2).stdout_eq(str![""]);
        let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(message.contains(part), "{command}:\n{message}");
    }
}

/// Friction work below the slip velocity is called creep, wherever the numbers of a run are told.
#[test]
fn a_wall_in_which_nothing_slips_only_creeps() {
    let desk = Desk::new();
    let creeps = |line: &str, name: &str| {
        let run = desk.concio(line).assert().success();
        let [out, err] =
            [&run.get_output().stdout, &run.get_output().stderr].map(|t| String::from_utf8_lossy(t).into_owned());
        let summary = desk.json(&format!("{name}/summary.json"));
        let warned = |text: &str| text.contains("no joint slipped: the friction work");
        let found = [out.contains("friction (creep)"), warned(&err), warned(&summary["warnings"].to_string())];
        assert_eq!(warned(&desk.get(&format!("{name}/report.html"))), found[2]);
        found
    };
    assert_eq!(creeps("run wall.toml --out slips", "slips"), [false; 3]);
    desk.put(
        "held.toml",
        WALL.replace("\"2 mm\"", "\"1 um\"").replace("slip_velocity = \"1 mm/s\"", "slip_velocity = \"100 mm/s\""),
    );
    assert_eq!(creeps("run held.toml --out held", "held"), [true; 3]);
}

/// As a person types what was meant in g.
#[test]
fn accelerations_without_a_unit_are_asked_about() {
    let desk = Desk::new();
    let sine =
        |a: &str| format!("top = {{ sine = {{ acceleration = {a}, frequency = \"2 Hz\", ramp = \"0.05 s\" }} }}\n");
    let (head, _) = WALL.split_once("top = { sine").expect("the motion");
    desk.put("bare.toml", format!("{head}{}", sine("0.3")));
    desk.put("unit.toml", format!("{head}{}", sine("\"0.03 g\"")));
    let said = |line: &str| {
        let checked = desk.concio(line).assert().success();
        String::from_utf8_lossy(&checked.get_output().stderr).into_owned()
    };
    assert!(said("check bare.toml").contains("motion.top.sine.acceleration is 0.3 m/s2"));
    assert_eq!(said("check unit.toml"), "");
}

#[test]
fn a_message_shows_the_line_and_a_caret() {
    let desk = Desk::new();
    desk.put("bad.toml", WALL.replace("courses = 4", "courses = 0"));
    desk.concio("check bad.toml").assert().code(2).stderr_eq(str![[r#"
error: bad.toml:6:1: panel[0].courses: 0 is out of range
6 | courses = 0
  | ^
allowed: [..]

"#]]);
}

#[test]
fn all_mistakes_are_told_at_once() {
    let desk = Desk::new();
    desk.put("bad.toml", WALL.replace("courses = 4", "courses = 0").replace("\"1 mm/s\"", "\"0 mm/s\""));
    let refused = desk.concio("check bad.toml").assert().code(2);
    let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert_eq!(message.matches("error: bad.toml:").count(), 2, "{message}");
}

#[test]
fn files_that_are_no_wall_files() {
    let desk = Desk::new();
    desk.put("empty.toml", "");
    desk.put("binary.toml", [0xff, 0x00, 0x9b, 0x1b]);
    for file in ["none.toml", "empty.toml", "binary.toml", "."] {
        let refused = desk.concio(&format!("run {file}")).assert().code(2).stdout_eq(str![""]);
        let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(message.starts_with(&format!("error: {file}")), "{message}");
        assert!(!message.contains('\u{1b}'), "control characters of a file must not reach the terminal");
    }
    assert_eq!(desk.list(), ["binary.toml", "empty.toml", "wall.toml"]);
}

#[test]
fn a_record_is_named_with_its_line() {
    let desk = Desk::new();
    desk.put("bad.txt", "# dt = 0.01 s, units: g\n0.0\n0.1\nnan\n");
    let refused = desk.concio("record bad.txt --json --svg out.svg").assert().code(2).stdout_eq(str![""]);
    let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(message.starts_with("error: bad.txt:4: "), "{message}");
    assert_eq!(desk.list(), ["bad.txt", "wall.toml"]);
}

#[test]
fn a_folder_that_cannot_be() {
    let desk = Desk::new();
    desk.concio("run wall.toml --out wall.toml").assert().code(2).stderr_eq(str![[r#"
error: wall.toml: the folder for the results is a file
help: give another folder with --out

"#]]);
    desk.concio("run wall.toml --out wall.toml/deeper").assert().code(1).stdout_eq(str![""]);
    desk.concio("check wall.toml --svg no/such/folder/wall.svg").assert().code(2);
    assert_eq!(desk.list(), ["wall.toml"]);
}

/// Outputs that would replace a file of the user's own, and what is said of them.
#[test]
fn files_of_the_user_are_not_overwritten() {
    let desk = Desk::new();
    desk.put("quake.txt", "# dt = 0.01 s, units: g\n0.0\n0.1\n-0.2\n");
    desk.put("notes.md", "mine");
    desk.concio("run wall.toml --out r").assert().success();
    let own = ["wall.toml", "quake.txt", "notes.md"];
    let before = own.map(|name| desk.get(name));
    for (line, part) in [
        ("check wall.toml --svg wall.toml", "overwrite the input"),
        ("check wall.toml --svg ./r/../wall.toml", "overwrite the input"),
        ("check wall.toml --svg notes.md", "ending in .svg"),
        ("check wall.toml --svg r", "is a folder"),
        ("record quake.txt --svg quake.txt", "overwrite the input"),
        ("record quake.txt --svg wall.toml", "ending in .svg"),
        ("export r --npz --out wall.toml", "ending in .npz"),
        ("export r --vtkhdf --out r/result.h5", "ending in .vtkhdf"),
        ("export r --csv --out notes.md", "is a file"),
    ] {
        let refused = desk.concio(line).assert().code(2).stdout_eq(str![""]);
        let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(message.contains(part) && message.contains("help: give another"), "{line}: {message}");
    }
    assert_eq!(own.map(|name| desk.get(name)), before);
    // What the program wrote itself it may write again.
    for line in ["check wall.toml --svg w.svg", "record quake.txt --svg w.svg", "export r --npz --out a.npz"] {
        desk.concio(line).assert().success();
        desk.concio(line).assert().success();
    }
}

#[test]
fn an_option_that_was_meant() {
    let desk = Desk::new();
    let refused = desk.concio("run wall.toml --otu r").assert().code(2);
    assert!(String::from_utf8_lossy(&refused.get_output().stderr).contains("'--out'"));
}

#[test]
fn a_file_in_the_place_of_a_command() {
    let desk = Desk::new();
    for (typed, meant) in
        [("wall.toml", "`concio run wall.toml`"), ("study studies/x.toml", "`concio study run studies/x.toml`")]
    {
        let refused = desk.concio(typed).assert().code(2);
        let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(message.contains(meant), "{message}");
    }
}

#[test]
fn files_that_are_no_records() {
    let desk = Desk::new();
    for (name, content, part) in [
        ("sheet.xlsx", &b"PK\x03\x04\x14\x00"[..], "spreadsheet"),
        ("picture.txt", b"\x89PNG\r\n\x1a\n", "picture"),
        ("data.bin", b"1.0\n\x00\x01", "binary"),
        ("page.json", b"{ \"NPTS\": 5, \"note\": \"NPTS = 5\" }\n", "JSON"),
        ("prose.txt", b"The NPTS of this record is not known.\n", "no samples"),
        ("column.txt", b"0\n1\n2\n", "give --dt 0.005"),
    ] {
        desk.put(name, content);
        let refused = desk.concio(&format!("record {name}")).assert().code(2).stdout_eq(str![""]);
        let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(message.contains(part) && !message.contains("wall file"), "{name}: {message}");
    }
}
