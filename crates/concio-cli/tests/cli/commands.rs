//! The commands as a user types them: output, files, exit status.

use std::fs;
use std::process::{Command, Stdio};

use serde_json::Value;
use snapbox::str;

use crate::support::{Desk, PROGRAM, WALL};

#[test]
fn run_writes_its_files_and_names_the_report() {
    let desk = Desk::new();
    let run = desk.concio("run wall.toml").assert().success();
    // The springs of its joints bear more than friction can, which is all that there is to say.
    let run =
        run.stderr_eq(str!["warning: the largest base shear, [..], is above the 3.08 kN that friction can bear[..]\n"]);
    let stdout = String::from_utf8_lossy(&run.get_output().stdout).into_owned();
    for part in ["peak displacement", "peak slip velocity", "energy residual", "open concio-run/wall/report.html"] {
        assert!(stdout.contains(part), "{part}:\n{stdout}");
    }
    let summary = desk.json("concio-run/wall/summary.json");
    for key in [
        "blocks",
        "joints",
        "unknowns",
        "steps",
        "solve_seconds",
        "peak_relative_displacement",
        "peak_slip_velocity",
        "top_work",
        "top_force_peak",
        "top_force_rms",
        "minimum_gap",
    ] {
        assert!(summary[key].is_number(), "{key} in {summary}");
    }
    for key in ["input", "kinetic", "elastic", "damping", "friction", "bond", "residual_relative"] {
        assert!(summary["energy"][key].is_number(), "energy.{key} in {summary}");
    }
    assert_eq!(summary["stop_reason"], "completed");
    assert!(summary["peak_slip_velocity"].as_f64() > Some(1e-3), "the joints of this wall slip");
    let names = fs::read_dir(desk.path("concio-run/wall")).expect("the folder").count();
    assert_eq!(names, 3, "result, summary and report, and no journal any more");
}

#[test]
fn run_without_a_file_says_what_it_runs() {
    let desk = Desk::new();
    let run = desk.concio("run").assert().success();
    let output = run.get_output();
    assert!(String::from_utf8_lossy(&output.stderr).contains("built-in example"));
    assert!(String::from_utf8_lossy(&output.stdout).ends_with("open concio-run/example/report.html\n"));
    let summary = desk.json("concio-run/example/summary.json");
    assert!(summary["peak_slip_velocity"].as_f64() > Some(1e-3), "its joints slip");
}

#[test]
fn equal_inputs_give_equal_results() {
    let desk = Desk::new();
    for out in ["a", "b"] {
        desk.concio(&format!("run wall.toml --out {out}")).assert().success();
    }
    assert!(fs::read(desk.path("a/result.h5")).expect("a") == fs::read(desk.path("b/result.h5")).expect("b"));
}

#[test]
fn the_report_needs_nothing_else() {
    let desk = Desk::new();
    desk.concio("run wall.toml --out r").assert().success();
    let report = desk.get("r/report.html");
    for part in ["Small wall", "Energy by mechanism", "Summary", "When not to believe", "[[panel]]", "p1c4b2"] {
        assert!(report.contains(part), "{part}");
    }
    let hash = desk.json("r/summary.json")["inputs_hash"].as_str().expect("a hash").to_string();
    for part in ["concio run wall.toml --out r", &hash, "default-src 'none'", "The MIT License", "<noscript>"] {
        assert!(report.contains(part), "{part}");
    }
    let report = report.replace("url(#", "within(");
    for reference in ["src=", "href=", "@import", "url(", "<link", "<iframe"] {
        assert!(!report.contains(reference), "{reference}");
    }
    assert!(report.len() < 2_000_000, "{} bytes", report.len());
    fs::remove_file(desk.path("r/report.html")).expect("the report");
    desk.concio("plot r").assert().success();
    let report = desk.get("r/report.html");
    assert!(report.contains("Energy by mechanism") && report.contains("concio run case.json"));
}

/// What a user gives as a title or name must not end the script that carries it.
#[test]
fn a_title_cannot_break_the_report() {
    let desk = Desk::new();
    let title = "</script><b>Small & wall";
    desk.put("wall.toml", WALL.replace("Small wall", title));
    desk.concio("run wall.toml --out r").assert().success();
    let report = desk.get("r/report.html");
    assert!(!report.contains("</script><b>"));
    assert!(report.contains("&lt;/script&gt;&lt;b&gt;Small &amp; wall"));
    // That of the colours, the data and the program.
    assert_eq!(report.matches("</script>").count(), 3);
}

/// Ctrl-C, then the same command: the result is that of a run that nobody stopped.
#[cfg(unix)]
#[test]
fn an_interrupted_run_goes_on_to_the_same_bits() {
    let desk = Desk::new();
    desk.put("long.toml", WALL.replace("0.05 s\"\ntop", "0.4 s\"\ntop"));
    desk.concio("run long.toml --out whole").assert().success();
    let mut child = Command::new(PROGRAM)
        .args(["run", "long.toml", "--out", "parts"])
        .current_dir(desk.path(""))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("concio starts");
    while !desk.path("parts/journal.bin").exists() {
        assert!(child.try_wait().expect("the state of the run").is_none(), "it ended before it could be stopped");
        std::thread::yield_now();
    }
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("kill").success());
    let output = child.wait_with_output().expect("the run ends");
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("stopped early at t = "));
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(told.contains("relative to the base before the run stopped early"), "{told}");
    assert_eq!(desk.json("parts/summary.json")["stop_reason"], "interrupted");
    assert!(desk.get("parts/report.html").contains("Stopped early"));
    let again = desk.concio("run long.toml --out parts").assert().success();
    let told = String::from_utf8_lossy(&again.get_output().stderr).into_owned();
    let from = desk.json("parts/summary.json")["resumed_from"].as_f64().expect("a time");
    let (_, time) = told.split_once("taken up at t = ").expect("it says that it goes on");
    let time: f64 = time.split_whitespace().next().and_then(|t| t.parse().ok()).expect("a time");
    // As printed, to four digits.
    assert!((time - from).abs() <= 5e-4 * from, "{time} {from}");
    assert!(
        fs::read(desk.path("parts/result.h5")).expect("parts")
            == fs::read(desk.path("whole/result.h5")).expect("whole")
    );
}

/// What holds bonded joints, kind by kind, and that rigid joints are rigid.
#[test]
fn check_says_what_bonds_and_rigid_joints_are() {
    let desk = Desk::new();
    let bond = "[joint.bond]\ncohesion = \"0.1 MPa\"\nfriction_angle = \"30 deg\"\nmode_2_energy = \"50 N/m\"\n[load]";
    let head = "head = { law = \"rigid\", restitution = 0.5 }";
    let was = "head = { law = \"no-tension\", stiffness = \"5.4e7 N/m\", rigidity = 1000 }";
    desk.put("rigid.toml", WALL.replace(was, head).replace("[load]", bond));
    let done = desk.concio("check rigid.toml").assert().success();
    let out = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
    let words = |first: &str, which: usize| {
        let line =
            out.lines().filter(|l| l.trim_start().starts_with(first)).nth(which).unwrap_or_else(|| panic!("{out}"));
        line.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert!(words("head", 0).starts_with("head 6 rigid, e = 0.5"), "{out}");
    assert_eq!(words("bonds", 0), "bonds number f_t or c tan φ G_f strength");
    // c A + N tan φ of the bed joints: 0.1 MPa · 0.12 m · 0.12 m and some 1.2 kN · 0.577 of friction.
    assert!(words("bed", 1).starts_with("bed 12 100.0 kPa 0.577 50.00 N/m 2.1"), "{out}");
    desk.put(
        "brittle.toml",
        WALL.replace("[load]", "[joint.bond]\ntensile_strength = \"5 kPa\"\non = [\"head\"]\n[load]"),
    );
    let done = desk.concio("check brittle.toml").assert().success();
    let out = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
    let line = out.lines().filter(|l| l.contains("head")).nth(1).unwrap_or_else(|| panic!("{out}"));
    let words: Vec<&str> = line.split_whitespace().collect();
    // f_t A = 5 kPa · 0.055 m · 0.12 m.
    assert_eq!(words, ["head", "6", "5.000", "kPa", "–", "brittle", "33.00", "N"], "{out}");
}

#[test]
fn check_says_what_the_wall_is() {
    let desk = Desk::new();
    desk.concio("check wall.toml --svg wall.svg").assert().success().stderr_eq(str![""]).stdout_eq(str![[r#"
Small wall

  panel  courses  blocks     width    height      mass
  p1           4      10  510.0 mm  260.0 mm  23.98 kg

  joints  number                stiffness  friction         normal force
  base         2               108.0 MN/m     0.600             2.568 kN
  bed         12               51.84 MN/m     0.600  [..]
  head         6       54.00 GN/m (κ K_V)         –                    –
  top          3  51.84 MN/m … 108.0 MN/m     0.600  1.200 kN … 2.500 kN
  all         23

  unknowns      10
  mass          23.98 kg; mortar, 19 % of its area, weighs nothing
  load on top   4.900 kN, 83.33 kPa on 0.05880 m² of bricks
  first period  [..]
  duration      0.05 s, 2001 samples kept

  base  at rest
  top   sine of 2 Hz, displacement 2.000 mm, ramp of 0.05 s

wall.toml is a valid wall file.

"#]]);
    let drawing = desk.get("wall.svg");
    assert!(drawing.starts_with("<svg ") && drawing.ends_with("</svg>\n"));
    for name in ["p1c1b1", "p1c4b3", "base|p1c1b2", "p1c1b1|p1c2b1"] {
        assert!(drawing.contains(&format!(">{name}<")), "{name}");
    }
    assert_eq!(desk.list(), ["wall.svg", "wall.toml"]);
}

/// Devices have a table of their own, and the rows of the joints know nothing of them.
#[test]
fn check_tells_what_devices_bear() {
    let desk = Desk::new();
    desk.put("devices.toml", include_str!("../../../../examples/13-interfaces.toml"));
    let done = desk.concio("check devices.toml").assert().success();
    let out = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
    let rows: Vec<String> = out.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    for row in [
        "bed 32 51.84 MN/m 0.600 4.814 kN … 5.045 kN",
        "devices number at rest dashpot gives way at",
        "friction-damper 6 – – 500.0 N",
        "re-centring 2 20.00 MN/m – 4.000 kN",
        "bouc-wen 1 100.0 MN/m 1.000 kN s/m 2.000 kN",
        "all joints 70",
    ] {
        assert!(rows.iter().any(|r| r == row), "{row}\n{out}");
    }
}

/// A planar wall is let down onto its joints: whether it stands is told before it is run.
#[test]
fn check_tells_whether_a_planar_wall_stands() {
    let desk = Desk::new();
    let wall = |x: f64| {
        format!(
            "model = \"planar\"\n[[panel]]\nbond = \"explicit\"\n\
             brick = {{ length = 1.0, height = 0.5, thickness = 0.4, specific_weight = \"20 kN/m3\" }}\n\
             [[panel.block]]\ncourse = 1\nx = 0.0\ny = 0.0\nlength = 1.0\nheight = 0.5\n\
             [[panel.block]]\ncourse = 2\nx = {x}\ny = 0.5\nlength = 1.0\nheight = 0.5\n\
             [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
             friction = {{ law = \"coulomb\", static = 0.6, dynamic = 0.6 }}\n[motion]\nduration = \"1 s\"\n"
        )
    };
    // 4 kN stand 0.2 m beside the middle of 0.6 m × 0.4 m: the edge is pulled by N/A (6 e/b − 1) = 16.7 kPa.
    let weak = "[joint.bond]\ntensile_strength = \"1 kPa\"\ncohesion = \"1 kPa\"\non = [\"bed\"]\n";
    let bonded = |x: f64, strength: &str| {
        wall(x).replace("\"rigid\" }\nhead", "\"elastic\", stiffness = \"1 N/mm3\" }\nhead")
            + &weak.replace("1 kPa", strength)
    };
    for (text, told) in [
        (wall(0.4), "under its loads  stands\n"),
        (wall(0.4), "first period     none: its joints are rigid\n"),
        (wall(0.6), "first period     none: the wall falls\n"),
        (wall(0.6), "under its loads  does not stand"),
        (bonded(0.4, "1 kPa"), "at most, 1 of 1 bonds cracked\n"),
        (bonded(0.4, "1 MPa"), "at most\n"),
    ] {
        desk.put("wall.toml", &text);
        let done = desk.concio("check wall.toml").assert().success();
        let out = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
        assert!(out.contains(told), "{text}: {out}");
    }
}

/// What is not asked of a large wall is said, instead of left out: 2,001 blocks on each other, of 0.5 m by 1 mm.
#[test]
fn check_says_what_it_does_not_ask_of_large_walls() {
    let desk = Desk::new();
    desk.put(
        "wall.toml",
        "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 667\nbricks = 3\n\
         brick = { length = 0.5, height = 0.01, thickness = 0.5, specific_weight = 20e3 }\n\
         [joint]\nbed = { law = \"rigid\" }\nhead = { law = \"rigid\" }\n\
         friction = { law = \"coulomb\", static = 0.6 }\n[motion]\nduration = \"1 s\"\n",
    );
    let said = desk.concio("check wall.toml").assert().success().get_output().stdout.clone();
    let said = String::from_utf8_lossy(&said).into_owned();
    for line in [
        "under its loads  not asked of more than 2000 blocks; `concio run` settles the wall first\n",
        "first period     not asked of more than 2000 blocks\n",
    ] {
        assert!(said.contains(line), "{said}");
    }
}

/// Courses that are listed one by one, where their lengths differ: 3 × 0.3 m and two head joints are 0.93 m.
#[test]
fn check_lists_the_lengths_of_courses() {
    let desk = Desk::new();
    let course = |bricks: &str| format!("[[panel.course]]\nheight = 0.15\nbricks = [{bricks}]\n");
    let wall = |last: &str| {
        let courses = [course("0.3, 0.3, 0.3"), course("0.45, 0.465"), course(last)].concat();
        format!(
            "model = \"planar\"\n[[panel]]\nbond = \"irregular\"\n\
             brick = {{ length = 0.3, height = 0.15, thickness = 0.4, specific_weight = 21e3 }}\n\
             mortar = {{ bed = 0.015, head = 0.015 }}\n{courses}\
             [joint]\nbed = {{ law = \"rigid\" }}\nhead = {{ law = \"rigid\" }}\n\
             friction = {{ law = \"coulomb\", static = 0.6 }}\n[motion]\nduration = 1.0\n"
        )
    };
    let said = |last: &str| {
        desk.put("wall.toml", wall(last));
        let said = desk.concio("check wall.toml").assert().success().get_output().stdout.clone();
        let said = String::from_utf8_lossy(&said).into_owned();
        said.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect::<Vec<_>>()
    };
    let found = said("0.3, 0.3, 0.2");
    for line in ["courses of length number which", "p1 930.0 mm 2 1, 2", "p1 830.0 mm 1 3"] {
        assert!(found.iter().any(|l| l == line), "{line}: {found:#?}");
    }
    assert!(!said("0.3, 0.3, 0.3").iter().any(|line| line.starts_with("courses of")));
}

/// The help of the program lists each command once, in groups.
#[test]
fn help_lists_every_command_once() {
    let desk = Desk::new();
    let help = desk.concio("--help").assert().success().get_output().stdout.clone();
    let help = String::from_utf8_lossy(&help).into_owned();
    let (_, commands) = help.split_once("Make and run a wall:").expect("the groups");
    let (commands, rest) = commands.split_once("Options:").expect("the options");
    assert!(rest.contains("--version") && rest.contains("First steps:"), "{rest}");
    let program = <concio_cli::args::Cli as clap::CommandFactory>::command();
    for command in program.get_subcommands().filter(|c| !c.is_hide_set()) {
        let name = format!("  {} ", command.get_name());
        assert_eq!(commands.matches(&name).count(), 1, "{name}");
    }
    assert_eq!(commands.matches("\n  ").count(), program.get_subcommands().filter(|c| !c.is_hide_set()).count());
}

/// Records that are hardly whole, and steps that pass over samples, are told before the run.
#[test]
fn records_that_hardly_shake_are_told() {
    let desk = Desk::new();
    let wall = concio::case::starter(concio::case::ModelKind::Planar);
    let (head, _) = wall.split_once("\n[motion]").expect("a motion");
    let line = |k: usize| format!("{} {}\n", 0.01 * k as f64, if k.is_multiple_of(2) { 0.5 } else { -0.5 });
    let samples = |n: usize| (0..n).map(line).collect::<String>();
    desk.put("two.txt", "# units: g\n0 0.1\n0.01 0.2\n");
    desk.put("zero.txt", format!("# units: g\n{}", samples(200).replace("-0.5", "0.0").replace(" 0.5", " 0.0")));
    desk.put("whole.txt", format!("# units: g\n{}", samples(200)));
    for (record, step, told) in [
        ("two.txt", "1 ms", "2 samples in 0.01 s, less than 1 s"),
        ("zero.txt", "1 ms", "0 from end to end"),
        ("whole.txt", "20 ms", "solver.step is 0.02 s, and the motion has samples 0.01 s apart"),
    ] {
        let motion = format!("[motion]\nbase = {{ record = \"{record}\" }}\n[solver]\nstep = \"{step}\"\n");
        desk.put("shaken.toml", format!("{head}\n{motion}"));
        let said = desk.concio("check shaken.toml").assert().success().get_output().clone();
        let said = [said.stdout, said.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
        assert!(said.contains(told), "{record}: {said}");
    }
    let said = desk.concio("record two.txt").assert().success().get_output().stderr.clone();
    assert!(String::from_utf8_lossy(&said).contains("less than 1 s"), "{said:?}");
}

#[test]
fn new_writes_a_valid_file_and_overwrites_none() {
    let desk = Desk::new();
    desk.concio("new fresh.toml").assert().success();
    desk.concio("check fresh.toml").assert().success();
    desk.concio("new wall.toml").assert().code(2).stderr_eq(str![[r#"
error: wall.toml: the file exists and is not overwritten
help: give another name, or remove it first

"#]]);
    assert_eq!(desk.get("wall.toml"), WALL);
    let refused = desk.concio("new abbey/nave.toml").assert().code(2).get_output().stderr.clone();
    assert!(String::from_utf8_lossy(&refused).contains("the folder abbey does not exist"), "{refused:?}");
    let printed = desk.concio("new -").assert().success();
    assert_eq!(String::from_utf8_lossy(&printed.get_output().stdout), desk.get("fresh.toml"));
}

#[test]
fn the_schema_documents_every_key() {
    let desk = Desk::new();
    let printed = desk.concio("schema").assert().success();
    let schema: Value = serde_json::from_slice(&printed.get_output().stdout).expect("JSON");
    for key in ["model", "panel", "joint", "load", "motion", "solver", "output"] {
        let property = &schema["properties"][key];
        assert!(property["description"].is_string() || property["$ref"].is_string(), "{key}: {property}");
    }
}

/// A record of PEER with a peak that is known: 0.25 g.
const AT2: &str = "PEER STRONG MOTION DATABASE RECORD\nTest event, 1/1/2000, Test station, 090\n\
                   ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=     5, DT=   .0100 SEC\n  0.0 0.1 -0.25 0.1 0.0\n";

#[test]
fn record_measures_an_accelerogram() {
    let desk = Desk::new();
    desk.put("test.AT2", AT2);
    let printed = desk.concio("record test.AT2 --json --svg test.svg").assert().success();
    let json: Value = serde_json::from_slice(&printed.get_output().stdout).expect("JSON");
    assert_eq!((json["npts"].as_u64(), json["dt"].as_f64()), (Some(5), Some(0.01)));
    let pga = json["pga"].as_f64().expect("pga");
    assert!((pga - 0.25 * 9.80665).abs() < 1e-12, "{pga}");
    // π/(2g) ∫a² dt by the trapezoidal rule: (0.1² + 0.25² + 0.1²) g² 0.01 s.
    let arias = std::f64::consts::FRAC_PI_2 * 9.80665 * 0.0825 * 0.01;
    assert!((json["arias"].as_f64().expect("arias") - arias).abs() < 1e-12);
    for key in ["pgv", "pgd", "d5_95", "housner"] {
        assert!(json[key].is_number(), "{key}");
    }
    for key in ["units", "format", "station", "event"] {
        assert!(json[key].is_string(), "{key}");
    }
    assert_eq!(json["spectrum"]["period"].as_array().map(Vec::len), json["spectrum"]["psa"].as_array().map(Vec::len));
    assert!(desk.get("test.svg").contains("response spectrum"));
    let table = desk.concio("record test.AT2").assert().success();
    assert!(String::from_utf8_lossy(&table.get_output().stdout).contains("0.2500 g"));
}

#[test]
fn record_asks_for_what_a_column_leaves_unsaid() {
    let desk = Desk::new();
    desk.put("column.txt", "0.0\n1.0\n-2.0\n0.5\n");
    let refused = desk.concio("record column.txt").assert().code(2);
    assert!(String::from_utf8_lossy(&refused.get_output().stderr).starts_with("error: column.txt:"));
    let told = desk.concio("record column.txt --dt 0.01 --units cm/s2 --json").assert().success();
    let json: Value = serde_json::from_slice(&told.get_output().stdout).expect("JSON");
    assert_eq!(json["pga"].as_f64(), Some(0.02));
    desk.put("test.AT2", AT2);
    let refused = desk.concio("record test.AT2 --channel 2").assert().code(2);
    assert!(String::from_utf8_lossy(&refused.get_output().stderr).contains("allowed: 1, the only one"));
}

#[test]
fn system_is_the_wall_in_numbers() {
    let desk = Desk::new();
    let printed = desk.concio("system wall.toml").assert().success();
    let system: Value = serde_json::from_slice(&printed.get_output().stdout).expect("JSON");
    let masses: Vec<f64> = system["mass"].as_array().expect("mass").iter().filter_map(Value::as_f64).collect();
    // γ L H B / g of a whole brick.
    assert!((masses[0] - 18000.0 * 0.25 * 0.055 * 0.12 / 9.81).abs() < 1e-12, "{masses:?}");
    let joints = system["joints"].as_array().expect("joints");
    let of = |side: &str| joints.iter().filter(|j| j["b"] == side).count();
    assert_eq!((masses.len(), of("base"), of("top")), (10, 2, 3));
    let head = joints.iter().find(|j| j["law"] == "no-tension").expect("a head joint");
    assert_eq!(head["stiffness"].as_f64(), Some(5.4e10));
    assert!(head["friction"].is_null());
    assert_eq!(system["base"], Value::Null);
    assert_eq!(system["top"]["sine"]["amplitude"].as_f64(), Some(0.002));
    assert_eq!(system["duration"].as_f64(), Some(0.05));
}

/// What is printed ends with the last sample of the record, as the run does. A run that goes on after it has a jump there.
#[test]
fn system_ends_with_the_last_sample() {
    let desk = Desk::new();
    desk.put("r.txt", "0\n1\n2\n3\n");
    let top = "top = { sine = { amplitude = \"2 mm\", frequency = \"2 Hz\", ramp = \"0.05 s\" } }";
    let base = "base = { record = \"r.txt\", dt = \"0.1 s\", units = \"m/s2\" }";
    let wall = desk.get("wall.toml").replace("beam = \"driven\"", "beam = \"free\"").replace(top, base);
    desk.put("longer.toml", wall.replace("duration = \"0.05 s\"", "duration = \"0.5 s\""));
    desk.concio("system longer.toml").assert().code(2);
    desk.put("wall.toml", wall.replace("duration = \"0.05 s\"", ""));
    let printed = desk.concio("system wall.toml").assert().success();
    let system: Value = serde_json::from_slice(&printed.get_output().stdout).expect("JSON");
    let samples: Vec<f64> =
        system["base"]["acceleration"].as_array().expect("samples").iter().filter_map(Value::as_f64).collect();
    assert!(
        samples.iter().zip([0.0, 1.0, 2.0, 3.0]).all(|(found, right)| (found - right).abs() < 1e-12),
        "{samples:?}"
    );
    assert!(samples.len() >= 4 && samples[4..].iter().all(|a| *a == 0.0), "{samples:?}");
}

/// What the format cannot say is not said wrongly.
#[test]
fn system_refuses_what_it_cannot_say() {
    let desk = Desk::new();
    desk.put("rigid.toml", WALL.replace("\"no-tension\"", "\"rigid\""));
    desk.put("planar.toml", WALL.replace("\"shear\"", "\"planar\""));
    for (line, part) in [
        ("system rigid.toml", "the rigid joint p1c1b1|p1c1b2 has no place"),
        ("system planar.toml", "knows no planar walls"),
    ] {
        let refused = desk.concio(line).assert().code(2).stdout_eq(str![""]);
        let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(message.contains(part), "{line}: {message}");
    }
}

#[test]
fn results_are_exported() {
    let desk = Desk::new();
    desk.concio("run wall.toml --out r").assert().success();
    desk.concio("export r --csv").assert().success().stdout_eq(str![""]);
    assert!(desk.get("r/csv/histories.csv").starts_with("time [s],"));
    desk.concio("export r --npz --out run.npz").assert().success();
    assert!(fs::read(desk.path("run.npz")).expect("the archive").starts_with(b"PK"));
    desk.concio("export r --vtkhdf").assert().success();
    assert!(fs::read(desk.path("r/result.vtkhdf")).expect("the file").starts_with(b"\x89HDF"));
    desk.concio("export r").assert().code(2);
    desk.concio("export nothing --csv").assert().code(2);
    desk.put("r/result.h5", "not a result");
    desk.concio("export r --csv --out other").assert().code(2);
    assert!(!desk.path("other").exists());
}

#[test]
fn help_teaches_by_example() {
    let desk = Desk::new();
    for command in ["run", "check", "new", "schema", "record", "system", "export", "plot", "completions"] {
        let help = desk.concio(&format!("{command} --help")).assert().success();
        let help = String::from_utf8_lossy(&help.get_output().stdout).into_owned();
        assert!(help.contains("Example") && help.contains(&format!("concio {command}")), "{command}:\n{help}");
    }
    let script = desk.concio("completions bash").assert().success();
    assert!(String::from_utf8_lossy(&script.get_output().stdout).contains("_concio"));
    desk.concio("rum wall.toml").assert().code(2);
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_error() {
    let mut child = Command::new(PROGRAM)
        .arg("schema")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("concio starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
}

/// [`WALL`] shaken at its base by [`AT2`], scaled to 0.5 g; the run is as long as the record without `duration`.
fn shaken(duration: &str) -> String {
    let (head, _) = WALL.split_once("[load]").expect("the wall has loads");
    format!(
        "{head}[load]\ntop = \"10 kN/m\"\n[motion]\n{duration}\nbase = {{ record = \"test.AT2\", pga = \"0.5 g\" }}\n"
    )
}

/// The record's own file is in order: the place that is told is that of the key in the wall file.
#[test]
fn a_channel_that_a_record_does_not_have_is_told_where_it_was_asked_for() {
    let desk = Desk::new();
    desk.put("test.AT2", AT2);
    let wall = shaken("").replace("pga = \"0.5 g\"", "channel = 7");
    let line = 1 + wall.lines().position(|line| line.starts_with("base = ")).expect("the base is shaken");
    desk.put("wall.toml", wall);
    let refused = desk.concio("check wall.toml").assert().code(2);
    let told = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(told.contains(&format!("wall.toml:{line}:")) && told.contains("motion.base.channel"), "{told}");
    assert!(told.contains("test.AT2 has no channel 7") && told.contains("1, the only one"), "{told}");
}

#[test]
fn check_says_how_a_record_is_used() {
    let desk = Desk::new();
    desk.put("test.AT2", AT2);
    for (duration, used, warning) in [
        ("", "used whole", None),
        (
            "duration = \"0.02 s\"",
            "0.02 s of 0.04 s used",
            Some("cuts the record of the base: 0.02 s of 0.04 s is used"),
        ),
        ("duration = \"1 s\"", "then 0.96 s without acceleration", Some("ends at 0.04 s, the run at 1 s: silence")),
    ] {
        desk.put("shaken.toml", shaken(duration));
        let done = desk.concio("check shaken.toml").assert().success();
        let [out, err] = [&done.get_output().stdout, &done.get_output().stderr].map(|b| String::from_utf8_lossy(b));
        // The peak of 0.25 g by the record's g of 9.80665 m/s2 becomes 0.5 g by the wall's of 9.81 m/s2.
        for part in [
            "test.AT2, PEER AT2, channel 1 of 1",
            "5 samples every 0.01 s, 0.04 s",
            "scale factor 2.0007",
            "4.905 m/s² = 0.5000 g at 0.02 s",
            used,
        ] {
            assert!(out.contains(part), "{part}:\n{out}");
        }
        assert!(err.contains("5 samples in 0.04 s, less than 1 s"), "{err}");
        match warning {
            Some(part) => assert!(err.contains(part), "{err}"),
            None => assert_eq!(err.lines().count(), 1, "{err}"),
        }
        let run = desk.concio("run shaken.toml --fresh").assert().success();
        // So short a record makes nothing slip, which only the run can tell.
        let told = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        let (known, creep) = told.split_at_checked(err.len()).expect("the warnings of the check, and one more");
        assert_eq!(known, err);
        assert!(creep.starts_with("warning: no joint slipped") && creep.lines().count() == 1, "{told}");
        // What the terminal said stays with the result.
        let kept = desk.json("concio-run/shaken/summary.json")["warnings"].to_string();
        let report = desk.get("concio-run/shaken/report.html");
        match warning {
            Some(part) => assert!(kept.contains(part) && report.contains(part), "{kept}"),
            // That it is short, and the creep.
            None => assert!(kept.contains(",\"no joint slipped") && kept.matches("\",\"").count() == 1, "{kept}"),
        }
    }
}

#[test]
fn check_lists_joints() {
    let desk = Desk::new();
    let list = desk.concio("check wall.toml --joints").assert().success();
    let list = String::from_utf8_lossy(&list.get_output().stdout).into_owned();
    let row = list.lines().find(|l| l.trim_start().starts_with("base|p1c1b1 ")).expect("a joint");
    let fields: Vec<&str> = row.split_whitespace().collect();
    assert_eq!(fields, ["base|p1c1b1", "base", "1", "2.000", "2.568", "kN"], "{list}");
}

#[test]
fn an_unfinished_run_of_other_inputs_is_discarded_aloud() {
    let desk = Desk::new();
    fs::create_dir_all(desk.path("r")).expect("a folder");
    desk.put("r/checkpoint.bin", "of another run");
    let run = desk.concio("run wall.toml --out r").assert().success();
    let said = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
    assert!(said.contains("of other inputs or damaged: it is discarded"), "{said}");
    assert!(!said.contains("taken up"), "{said}");
}

#[test]
fn a_report_shows_the_histories_asked_for() {
    let desk = Desk::new();
    desk.put("wall.toml", format!("{WALL}\n[output]\nblocks = [\"p1c4b1\"]\njoints = [\"base|p1c1b1\"]\n"));
    desk.concio("run wall.toml --out r").assert().success();
    let report = desk.get("r/report.html");
    for part in ["Blocks and joints asked for", "block p1c4b1", "joint base|p1c1b1", "never slides off"] {
        assert!(report.contains(part), "{part}");
    }
}

/// The blocks of the guide that hold whole tables make one valid wall file.
#[test]
fn the_guide_to_the_wall_file_is_valid() {
    let guide = include_str!("../../../../docs/wall-file.md");
    let blocks = guide.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    let text: String = blocks.filter(|b| b.starts_with(['[', 't'])).collect();
    assert!(text.contains("[output]") && text.contains("title ="), "{text}");
    let desk = Desk::new();
    desk.put("quake.at2", AT2);
    desk.put("guide.toml", text);
    desk.concio("check guide.toml").assert().success();
}

/// The wall in the README is the built-in one, and so is the first example.
#[test]
fn the_first_wall_is_the_same_everywhere() {
    let readme = include_str!("../../../../README.md");
    let snippet = readme.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a wall file");
    let example = include_str!("../../../../examples/01-first-wall.toml");
    let built_in = concio::case::example().expect("the built-in wall").case;
    for text in [snippet, example] {
        let mut case = concio::case::from_str(text, concio::case::Syntax::Toml, None).expect("a wall file").case;
        case.title = built_in.title.clone();
        assert_eq!(case, built_in);
    }
}

/// Doors and windows by their places, sizes, blocks and jambs; by hand: of the pitch of 0.26 m two bricks end at 0.51 m, a side at
/// 0.515 m lies in the head joint behind them.
#[test]
fn check_tells_openings() {
    let desk = Desk::new();
    let wall = |opening: &str| {
        WALL.replace("bricks = 2\n", "bricks = 6\n")
            .replace("courses = 4\n", "courses = 8\n")
            .replace("\n[joint]", &format!("\n[[panel.opening]]\n{opening}\n[joint]"))
    };
    let said = |opening: &str| {
        desk.put("wall.toml", wall(opening));
        let done = desk.concio("check wall.toml").assert().success();
        let text = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
        text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect::<Vec<_>>()
    };
    let counted = "x = \"2 bricks\"\ny = \"0 courses\"\nwidth = \"2 bricks\"\nheight = \"4 courses\"\nlintel = { height = \"2 courses\", bearing = \"0.5 bricks\" }";
    let lines = said(counted);
    for line in [
        "openings from left, base size lintel blocks jambs",
        "p1o1 510 mm, 0 m 530 mm × 270 mm 770 mm × 120 mm 11 left out, 6 cut straight",
    ] {
        assert!(lines.iter().any(|l| l == line), "{line}: {lines:#?}");
    }
    let lengths = "x = 0.515\ny = 0.065\nwidth = 0.5\nheight = 0.2\nlintel = { height = 0.125, bearing = 0.1 }";
    let lines = said(lengths);
    assert!(lines.iter().any(|l| l.ends_with("cut left ragged by 5 mm")), "{lines:#?}");
    let why = "p1o1: in 1 of 3 courses its left side lies in a head joint, or would leave a rest no longer than the mortar, which is left out; widths in half bricks";
    assert!(lines.iter().any(|l| l.starts_with(why)), "{lines:#?}");
    let lines = said(&format!("snap = true\n{lengths}"));
    assert!(lines.iter().any(|l| l.ends_with("cut straight")), "{lines:#?}");
    assert!(lines.contains(&"p1o1: `snap` moved the left side by 5 mm to the left".to_string()), "{lines:#?}");
    // Without openings there is no such table.
    desk.put("wall.toml", WALL);
    let done = desk.concio("check wall.toml").assert().success();
    assert!(!String::from_utf8_lossy(&done.get_output().stdout).contains("openings"));
}

/// All that is wrong with a geometry at once, with the lines.
#[test]
fn check_lists_all_mistakes_of_a_geometry() {
    let desk = Desk::new();
    let openings = "\n[[panel.opening]]\nx = 0.1\ny = 0.03\nwidth = 0.1\nheight = 0.065\n[[panel.opening]]\nx = 0.1\ny = 0.13\nwidth = 3\nheight = 0.065\n[joint]";
    desk.put("wall.toml", WALL.replace("\n[joint]", openings));
    for command in ["check", "run", "limit", "system"] {
        let refused = desk.concio(&format!("{command} wall.toml")).assert().code(2);
        let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        for part in [
            "wall.toml:13:1: panel[0].opening[0].y",
            "wall.toml:15:1: panel[0].opening[0].height",
            "wall.toml:19:1: panel[0].opening[1].width",
        ] {
            assert!(message.contains(part), "{command}: {part}\n{message}");
        }
        assert_eq!(message.matches("error: ").count(), 3, "{command}: {message}");
    }
}

/// A stone that turns over under 0.3 g ends its run when it was asked to: with status 0, and the reason is told everywhere.
#[test]
fn a_run_that_stops_at_a_collapse_has_done_what_it_was_to() {
    let desk = Desk::new();
    desk.put(
        "stone.toml",
        "model = \"planar\"\n[[panel]]\nbond = \"stack\"\ncourses = 1\nbricks = 1\n\
         brick = { length = 0.2, height = 1.0, thickness = 0.5, specific_weight = \"2000 kg/m3\" }\nmortar = { bed = 0, head = 0 }\n\
         [joint]\nbed = { law = \"rigid\" }\nhead = { law = \"none\" }\nfriction = { law = \"coulomb\", static = 0.8 }\n\
         [motion]\nduration = \"8 s\"\nstop_at = { collapse = \"0.5 s\" }\nbase = { tilt = { acceleration = \"0.3 g\", rise = \"10 ms\" } }\n",
    );
    let check = desk.concio("check stone.toml").assert().success();
    assert!(String::from_utf8_lossy(&check.get_output().stdout).contains("; ends 0.5 s after a collapse"));
    let run = desk.concio("run stone.toml --out out").assert().success();
    let noted = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
    assert!(noted.contains(" of 8 s: the wall collapsed, which `motion.stop_at`"), "{noted}");
    let summary = desk.json("out/summary.json");
    assert_eq!(summary["stop_reason"], "collapsed");
    let [reached, fell] =
        ["/time_reached", "/collapse/time"].map(|at| summary.pointer(at).and_then(Value::as_f64).expect("a time"));
    assert!((0.0..1e-3 + 1e-9).contains(&(reached - fell - 0.5)), "{reached} s, collapsed at {fell} s");
    assert!(desk.get("out/report.html").contains("Ended at t = "));
    // Figures and tables are made of it as of any run.
    desk.concio("plot out --figure all").assert().success();
    desk.concio("export out --csv").assert().success();
}
