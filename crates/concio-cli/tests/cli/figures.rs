//! `concio plot --figure` as a user types it.

use std::fs;

use resvg::usvg::{Options, Tree};

use crate::support::{Desk, WALL};

const NAMES: [&str; 10] = [
    "deformed",
    "phase",
    "joint-phase",
    "joint-histories",
    "peak-acceleration",
    "acceleration",
    "hysteresis",
    "top-force",
    "energies",
    "motion",
];

/// A desk with a result in `r`.
fn drawn_from(wall: &str) -> Desk {
    let desk = Desk::new();
    desk.put("wall.toml", wall);
    desk.concio("run wall.toml --out r").assert().success();
    desk
}

fn told(done: &snapbox::cmd::OutputAssert) -> [String; 2] {
    let output = done.get_output();
    [&output.stdout, &output.stderr].map(|b| String::from_utf8_lossy(b).into_owned())
}

#[test]
fn every_figure_is_drawn_and_listed() {
    let desk = drawn_from(WALL);
    let [listed, _] = told(&desk.concio("plot r --figure all").assert().success());
    let expected: Vec<String> = NAMES.iter().map(|n| format!("r/figures/{n}.svg")).collect();
    assert_eq!(listed.lines().collect::<Vec<_>>(), expected);
    for (name, words) in [
        ("deformed", &["t = ", "displacements × ", "wall: 100 mm"][..]),
        ("phase", &["displacement [", "velocity [mm/s]", "(a) p1c4b"]),
        ("joint-phase", &["slip [", "gap [", "velocity [mm/s]"]),
        ("joint-histories", &["gap [", "time [", "head joint"]),
        ("peak-acceleration", &["relative acceleration [m/s²]", "largest ", "peak over the whole history"]),
        ("acceleration", &["relative acceleration [m/s²]", "t = "]),
        ("hysteresis", &["friction force [kN]", "slip ["]),
        ("top-force", &["force of top beam [kN]", "displacement of top beam ["]),
        ("energies", &["energy [", "time [", "work done", "friction"]),
        ("motion", &["acceleration [m/s²]", "period [s]", "top beam, relative to the base"]),
    ] {
        let svg = desk.get(&format!("r/figures/{name}.svg"));
        let tree = Tree::from_str(&svg, &Options::default()).expect(name);
        // 85 mm at 96 px to the inch.
        assert!((tree.size().width() - 321.26).abs() < 0.01, "{name}: {}", tree.size().width());
        for word in words {
            assert!(svg.contains(word), "{name}: {word}");
        }
        // Letters are outlines: no program needs a font to show the file.
        assert!(!svg.contains("<text") && !svg.contains("font"), "{name}");
    }
}

#[test]
fn the_report_is_made_without_a_figure() {
    let desk = drawn_from(WALL);
    fs::remove_file(desk.path("r/report.html")).expect("the report");
    desk.concio("plot r").assert().success();
    assert!(desk.path("r/report.html").exists() && !desk.path("r/figures").exists());
    let [_, error] = told(&desk.concio("plot r --scale 5").assert().code(2));
    assert!(error.contains("--figure"), "{error}");
}

#[test]
fn a_damaged_result_is_told_with_what_mends_it() {
    let desk = drawn_from(WALL);
    let refused = |what: &str, file: &str, because: &str| {
        let [_, error] = told(&desk.concio(what).assert().code(2));
        for part in [file, "cannot be used", because, "`concio run` with the wall file writes it again"] {
            assert!(error.contains(part), "{what}: {part}\n{error}");
        }
    };
    let summary = desk.get("r/summary.json");
    desk.put("r/summary.json", &summary[..summary.len() / 2]);
    refused("plot r", "summary.json", "EOF");
    desk.put("r/summary.json", summary.replace("\"inputs_hash\": \"", "\"inputs_hash\": \"0"));
    refused("plot r", "summary.json", "digest");
    desk.put("other.toml", WALL.replace("2 mm", "1 mm"));
    desk.concio("run other.toml -o q").assert().success();
    desk.put("r/summary.json", desk.get("q/summary.json"));
    refused("plot r", "summary.json", "belongs to another run");
    fs::remove_file(desk.path("r/summary.json")).expect("the summary");
    refused("plot r", "summary.json", "No such file");
    desk.concio("plot r --figure energies").assert().success();
    let whole = fs::read(desk.path("r/result.h5")).expect("the result");
    fs::write(desk.path("r/result.h5"), &whole[..whole.len() / 2]).expect("half of it");
    refused("plot r --figure energies", "result.h5", "");
    refused("export r --csv", "result.h5", "");
    // HDF5 itself would not tell: a number in the middle of the file is another.
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 1;
    fs::write(desk.path("r/result.h5"), flipped).expect("a file");
    for what in ["plot r", "plot r --figure energies", "export r --csv", "export r --npz", "export r --vtkhdf"] {
        refused(what, "result.h5", "its digest is missing or does not match");
    }
    assert!(!desk.path("r/csv").exists() && !desk.path("r/result.npz").exists());
    fs::remove_file(desk.path("r/result.h5")).expect("the result");
    told(&desk.concio("export r --csv").assert().code(2));
}

#[test]
fn instant_and_scale_are_printed_in_the_figure() {
    let desk = drawn_from(WALL);
    let plot = |more: &[&str]| {
        desk.concio("plot r --figure deformed").args(more.iter().copied()).assert().success();
        desk.get("r/figures/deformed.svg")
    };
    let svg = plot(&["--at", "20 ms", "--scale", "5000"]);
    assert!(svg.contains("t = 0.02 s") && svg.contains("displacements × 5000"), "{:.600}", svg);
    assert!(plot(&["--scale", "1"]).contains("displacements to scale"));
    // The same run, the same bytes.
    assert_eq!(plot(&["--width", "double"]), plot(&["--width", "180 mm"]));
}

#[test]
fn files_have_the_size_asked_for() {
    let desk = drawn_from(WALL);
    desk.concio("plot r --figure energies,top-force --format png --width double --dpi 150 --out p").assert().success();
    let png = fs::read(desk.path("p/energies.png")).expect("a PNG");
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n") && desk.path("p/top-force.png").exists());
    // 180 mm at 150 pixels to the inch.
    assert_eq!(png[16..20], 1063u32.to_be_bytes());
    desk.concio("plot r --figure energies --format pdf --out p").assert().success();
    let pdf = fs::read(desk.path("p/energies.pdf")).expect("a PDF");
    assert!(pdf.starts_with(b"%PDF-") && pdf.trim_ascii_end().ends_with(b"%%EOF"));
    let text = String::from_utf8_lossy(&pdf);
    assert!(
        text.contains("DejaVuSans") && !text.contains("/Subtype /Image"),
        "vectors, and text in the font that is shipped"
    );
}

#[test]
fn what_cannot_be_drawn_says_what_to_do_and_leaves_nothing() {
    let desk = drawn_from(WALL);
    for (more, parts) in [
        (&["--figure", "deformd"][..], &["deformed", "deformd"][..]),
        (&["--figure", "phase", "--blocks", "p1c4b9"], &["no block is named `p1c4b9`", "did you mean `p1c4b"]),
        (&["--figure", "all", "--joints", "nothing"], &["no joint is named `nothing`", "for example base|p1c1b1"]),
        (&["--figure", "deformed", "--at", "9 s"], &["9 s is outside of the run", "allowed: 0 s to 0.05 s"]),
        (&["--figure", "deformed", "--at", "9"], &["write 9s"]),
        (&["--figure", "phase", "--from", "2 s"], &["--from", "allowed: a part of 0 s to 0.05 s"]),
        (
            &["--figure", "hysteresis", "--joints", "p1c1b1|p1c1b2"],
            &["has no friction", "choose bed or support joints"],
        ),
        (&["--figure", "deformed", "--width", "5 mm"], &["allowed: 40 mm to 400 mm"]),
    ] {
        let [_, error] = told(&desk.concio("plot r").args(more.iter().copied()).assert().code(2));
        for part in parts {
            assert!(error.contains(part), "{more:?}: {part}\n{error}");
        }
        assert!(!desk.path("r/figures").exists(), "{more:?}");
    }
}

#[test]
fn all_leaves_out_what_the_run_did_not_keep() {
    let free = WALL.replace("beam = \"driven\"", "beam = \"free\"");
    let (head, _) = free.split_once("top = { sine").expect("the motion of the top");
    let base = "base = { sine = { acceleration = \"0.3 g\", frequency = \"5 Hz\" } }\n[output]\nframes = 0\n";
    let desk = drawn_from(&format!("{head}{base}"));
    let [listed, notes] = told(&desk.concio("plot r --figure all").assert().success());
    assert_eq!(
        listed.lines().collect::<Vec<_>>(),
        ["r/figures/peak-acceleration.svg", "r/figures/energies.svg", "r/figures/motion.svg"]
    );
    for part in
        ["note: left out: figure deformed: the run kept no frames", "figure top-force: the wall has no top beam"]
    {
        assert!(notes.contains(part), "{part}\n{notes}");
    }
    let [_, error] = told(&desk.concio("plot r --figure phase").assert().code(2));
    assert!(error.contains("the run kept no frames") && error.contains("blocks = ["), "{error}");
    let [_, error] = told(&desk.concio("plot r --figure top-force").assert().code(2));
    assert!(error.contains("beam = \"driven\""), "{error}");
}

/// Blocks and joints of the wall file are drawn from every sample; of others a note says how to have them.
#[test]
fn frames_are_told_from_samples() {
    let wall = format!("{WALL}\n[output]\nblocks = [\"p1c4b1\"]\n");
    let desk = drawn_from(&wall);
    let [_, notes] = told(&desk.concio("plot r --figure phase").assert().success());
    assert_eq!(notes, "");
    assert!(desk.get("r/figures/phase.svg").contains("<desc>") && desk.get("r/figures/phase.svg").contains("p1c4b1"));
    let [_, notes] = told(&desk.concio("plot r --figure phase --blocks p1c1b1").assert().success());
    assert!(notes.contains("drawn from frames") && notes.contains("blocks = [\"p1c1b1\"]"), "{notes}");
}

/// Cracks are drawn of bonded walls alone, at the end or at an instant, and told on the terminal.
#[test]
fn cracks_are_drawn_and_told() {
    let bonded = WALL.replace("[load]", "[joint.bond]\ncohesion = \"20 kPa\"\ntensile_strength = \"5 kPa\"\n[load]");
    assert_ne!(bonded, WALL);
    let desk = drawn_from(&bonded);
    let [told_by_run, _] = told(&desk.concio("run wall.toml --out s").assert().success());
    let line = |name: &str| told_by_run.lines().find(|l| l.trim_start().starts_with(name)).unwrap_or_default();
    assert!(line("bonds").contains("of 23 cracked"), "{told_by_run}");
    // Four digits of the time.
    let crack: Vec<&str> = line("first crack").split_whitespace().collect();
    assert!(crack[4].trim_start_matches(['0', '.']).len() == 4 && crack[5..7] == ["s,", "joint"], "{crack:?}");
    desk.concio("plot r --figure cracks").assert().success();
    let svg = desk.get("r/figures/cracks.svg");
    let described = svg.lines().find(|l| l.contains("<desc>")).expect("a description");
    assert!(
        described.contains("damage of the bond, 0 = intact") && described.contains("of 23 bonds cracked"),
        "{described}"
    );
    assert!(!described.contains(" 0 of 23 bonds"), "{described}");
    desk.concio("plot r --figure cracks --at 0s").assert().success();
    let svg = desk.get("r/figures/cracks.svg");
    let described = svg.lines().find(|l| l.contains("<desc>")).expect("a description");
    assert!(described.contains(" 0 of 23 bonds cracked, 0 of them broken"), "{described}");
    assert!(!described.contains("not bonded"), "{described}");
    let beds = bonded.replace("[load]", "on = [\"bed\"]\n[load]");
    let desk = drawn_from(&beds);
    desk.concio("plot r --figure cracks").assert().success();
    let svg = desk.get("r/figures/cracks.svg");
    let described = svg.lines().find(|l| l.contains("<desc>")).expect("a description");
    assert!(described.contains("of 12 bonds") && described.contains("not bonded"), "{described}");
    assert!(desk.get("r/report.html").contains("base|p1c1b1: not bonded"));
    let dry = drawn_from(WALL);
    let [_, said] = told(&dry.concio("plot r --figure cracks").assert().failure());
    assert!(said.contains("no joint of this run is bonded"), "{said}");
}
