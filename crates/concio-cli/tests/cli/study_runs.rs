//! Studies as a user runs them: killed, sharded, on a full disk, with mistakes.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use crate::support::{PROGRAM, chance};

const WALL: &str = r#"
model = "shear"
set = "report"
[[panel]]
bond = "running"
courses = 6
bricks = 4
[load]
top = "10 kN/m"
beam = "driven"
[motion]
duration = "60 ms"
top = { sine = { amplitude = "5 mm", frequency = "5 Hz" } }
"#;

const STUDY: &str = r#"
title = "Friction and load"
wall = "wall.toml"
[design]
kind = "latin-hypercube"
runs = 120
seed = 2
[[vary]]
name = "friction"
path = "joint.friction.static"
from = 0.4
to = 0.8
also = [{ path = "joint.friction.dynamic", times = 0.7 }]
[[vary]]
path = "load.top"
from = "5 kN/m"
to = "15 kN/m"
[keep]
joints = ["displacement"]
"#;
const KILLS: u32 = 10;

fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("wall.toml"), WALL).unwrap();
    let study = folder.path().join("friction.toml");
    fs::write(&study, STUDY).unwrap();
    (folder, study)
}

fn concio(study: &Path, out: &Path, rest: &[&str]) -> Command {
    let mut command = Command::new(PROGRAM);
    command.args(["study", rest[0]]).arg(study).arg("--out").arg(out).args(&rest[1..]);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

fn tables(out: &Path) -> [Vec<u8>; 4] {
    ["runs.csv", "joints.csv", "runs.parquet", "joints.parquet"].map(|name| fs::read(out.join(name)).unwrap())
}

/// Whether the folder of a study holds a run.
fn rows(out: &Path) -> bool {
    let Ok(files) = fs::read_dir(out.join("runs")) else { return false };
    files
        .flatten()
        .any(|file| file.path().extension().is_some_and(|e| e == "jsonl") && file.metadata().unwrap().len() > 0)
}

/// A study of fewer runs, for what needs no time.
fn short() -> (tempfile::TempDir, PathBuf) {
    let (folder, study) = folder();
    fs::write(folder.path().join("wall.toml"), WALL.replace("60 ms", "20 ms")).unwrap();
    fs::write(&study, STUDY.replace("runs = 120", "runs = 24")).unwrap();
    (folder, study)
}

#[test]
fn ten_kills_and_two_racing_processes_change_nothing() {
    let (folder, study) = folder();
    let [whole, broken, raced] = ["whole", "broken", "raced"].map(|name| folder.path().join(name));
    let output = concio(&study, &whole, &["run"]).output().unwrap();
    assert!(output.status.success(), "{}", text(&output));
    let mut killed = 0;
    for kill in 0..KILLS {
        let mut child = concio(&study, &broken, &["run", "--threads", "1"]).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(20 + chance() % 150));
        // However slow the machine is, one of them is killed with runs on disk.
        while kill == 3 && !rows(&broken) && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(5));
        }
        // SIGKILL: the process has no say.
        child.kill().unwrap();
        killed += u32::from(!child.wait().unwrap().success());
    }
    let status = concio(&study, &broken, &["status"]).output().unwrap();
    println!("{killed} killed; {}", text(&status));
    assert!(killed >= KILLS - 2, "{killed} of {KILLS} kills met a study: it is too quick for this test");
    let ended = |line: &str| line.trim_start().starts_with("completed") && !line.ends_with(" 0");
    assert!(text(&status).lines().any(ended), "no run had ended before a kill: {}", text(&status));
    let output = concio(&study, &broken, &["run"]).output().unwrap();
    assert!(output.status.success(), "{}", text(&output));
    assert!(tables(&whole) == tables(&broken), "the tables differ");
    // Both do everything.
    let mut race = [1, 2].map(|_| concio(&study, &raced, &["run", "--threads", "1"]).spawn().unwrap());
    for child in &mut race {
        assert!(child.wait().unwrap().success());
    }
    assert!(tables(&whole) == tables(&raced), "the tables differ");
}

#[test]
fn shards_do_one_study_together() {
    let (folder, study) = short();
    let [whole, shared] = ["whole", "shared"].map(|name| folder.path().join(name));
    assert!(concio(&study, &whole, &["run"]).output().unwrap().status.success());
    for shard in ["2/3", "3/3"] {
        let output = concio(&study, &shared, &["run", "--shard", shard]).output().unwrap();
        assert!(output.status.success(), "{}", text(&output));
        assert!(text(&output).contains("left to other shards"), "{}", text(&output));
        assert!(!shared.join("runs.csv").exists());
    }
    let status = concio(&study, &shared, &["status"]).output().unwrap();
    assert!(text(&status).contains("completed  16") && text(&status).contains("not run    8"), "{}", text(&status));
    assert!(concio(&study, &shared, &["resume", "--shard", "1/3"]).output().unwrap().status.success());
    assert!(tables(&whole) == tables(&shared), "the tables differ");
}

/// GNU parallel as the help shows it, where there is one.
#[test]
fn gnu_parallel_does_the_shards() {
    let Ok(version) = Command::new("parallel").arg("--version").output() else {
        concio_verified::skip("GNU parallel is not installed");
        return;
    };
    if !text(&version).contains("GNU parallel") {
        concio_verified::skip("`parallel` is another program");
        return;
    }
    let (folder, study) = short();
    let [whole, shared] = ["whole", "shared"].map(|name| folder.path().join(name));
    assert!(concio(&study, &whole, &["run"]).output().unwrap().status.success());
    let binary = PROGRAM;
    let mut parallel = Command::new("parallel");
    parallel.args(["-j", "2", binary, "study", "run"]).arg(&study).arg("--out").arg(&shared);
    let output = parallel.args(["--threads", "1", "--shard", "{}/4", ":::", "1", "2", "3", "4"]).output().unwrap();
    assert!(output.status.success(), "{}", text(&output));
    // Whether the last to end saw all runs there depends on who was last; the tables are made of what is there.
    assert!(concio(&study, &shared, &["export"]).output().unwrap().status.success());
    assert!(tables(&whole) == tables(&shared), "the tables differ");
}

/// A limit on the size of files stands for a disk that is full.
#[cfg(unix)]
#[test]
fn a_full_disk_loses_nothing_that_was_written() {
    let (folder, study) = short();
    let [whole, full] = ["whole", "full"].map(|name| folder.path().join(name));
    assert!(concio(&study, &whole, &["run"]).output().unwrap().status.success());
    let script = "trap '' XFSZ; ulimit -f 16; exec \"$0\" study run \"$1\" --out \"$2\"";
    let mut bash = Command::new("bash");
    bash.args(["-c", script, PROGRAM]).arg(&study).arg(&full);
    let output = bash.output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", text(&output));
    assert!(text(&output).contains("part-0001.jsonl"), "{}", text(&output));
    let status = concio(&study, &full, &["status"]).output().unwrap();
    assert!(text(&status).contains("completed") && text(&status).contains("not run"), "{}", text(&status));
    assert!(!full.join("runs.csv").exists());
    assert!(concio(&study, &full, &["run"]).output().unwrap().status.success());
    assert!(tables(&whole) == tables(&full), "the tables differ");
}

#[test]
fn mistakes_are_told_with_their_line_and_nothing_is_written() {
    let (folder, study) = folder();
    let out = folder.path().join("out");
    for (from, to, says) in [
        (
            "path = \"joint.friction.static\"",
            "path = \"joint.fricton.static\"",
            "friction.toml:10:1: vary[0].path: joint.fricton: unknown key",
        ),
        ("kind = \"latin-hypercube\"", "kind = \"latin\"", "friction.toml:5:8: design.kind"),
        ("wall = \"wall.toml\"", "wall = \"wal.toml\"", "friction.toml:3:1: wall: there is no file"),
        ("runs = 120", "runs = 0", "friction.toml:6:1: design.runs: 0 is out of range"),
        ("joints = [\"displacement\"]", "joints = [\"displacment\"]", "did you mean `displacement`?"),
    ] {
        assert!(STUDY.contains(from));
        fs::write(&study, STUDY.replace(from, to)).unwrap();
        let output = concio(&study, &out, &["run"]).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", text(&output));
        println!("{}", text(&output));
        assert!(text(&output).contains(says), "{}", text(&output));
        assert!(!out.exists());
    }
    fs::write(&study, STUDY).unwrap();
    for rest in [&["run", "--shard", "4/3"][..], &["run", "--threads", "0"], &["resume"]] {
        let output = concio(&study, &out, rest).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", text(&output));
        assert!(!out.exists());
    }
}
