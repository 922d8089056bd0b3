//! What is read back is what was written, or it is told.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use concio::dice::Dice;

use crate::support::{Desk, PROGRAM};

const STUDY: &str = r#"
wall = "wall.toml"
[[vary]]
name = "friction"
path = "joint.friction.static"
values = [0.5, 0.6, 0.7]
[keep]
joints = ["displacement", "slip"]
results = true
"#;

/// Standard output and error of a command that ends with that status.
fn told(desk: &Desk, line: &str, status: i32) -> [String; 2] {
    let output = desk.concio(line).assert().code(status);
    let output = output.get_output();
    [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned())
}

fn studied() -> Desk {
    let desk = Desk::new();
    desk.put("study.toml", STUDY);
    told(&desk, "study run study.toml -o s", 0);
    desk
}

/// The one part of a store.
fn part(desk: &Desk) -> PathBuf {
    let mut parts: Vec<_> = fs::read_dir(desk.path("s/runs")).unwrap().map(|e| e.unwrap().path()).collect();
    parts.sort();
    parts.remove(0)
}

fn tables(desk: &Desk) -> Vec<Vec<u8>> {
    let names = ["runs.csv", "runs.parquet", "joints.csv", "joints.parquet"];
    names.iter().map(|name| fs::read(desk.path("s").join(name)).unwrap()).collect()
}

fn flip(path: &Path, n: u64) -> Vec<u8> {
    let whole = fs::read(path).unwrap();
    let mut dice = Dice::new(n);
    let (at, bit) = (dice.below(whole.len()), dice.below(8));
    let mut bytes = whole.clone();
    bytes[at] ^= 1 << bit;
    fs::write(path, bytes).unwrap();
    whole
}

/// Over all files of a store. The library is tried with more of them (`concio-study`, `concio`).
#[test]
fn a_bit_flipped_in_a_study_is_told_or_changes_nothing() {
    let desk = studied();
    let mut files: Vec<PathBuf> = ["s/runs", "s/results"]
        .iter()
        .flat_map(|folder| fs::read_dir(desk.path(folder)).unwrap().map(|e| e.unwrap().path()))
        .collect();
    files.sort();
    assert_eq!(files.len(), 4);
    let status = told(&desk, "study status study.toml -o s", 0);
    told(&desk, "study export study.toml -o s", 0);
    let before = tables(&desk);
    let mut seen = [0; 2];
    for n in 0..16 {
        let path = &files[n % files.len()];
        let whole = flip(path, n as u64);
        let [printed, error] = told(&desk, "study status study.toml -o s", 0);
        let [_, of_export] = told(&desk, "study export study.toml -o s", 0);
        let is_told = error.contains("does not count") && of_export.contains("does not count");
        assert!(is_told || ([printed, error] == status && tables(&desk) == before), "{n}: {}", path.display());
        seen[usize::from(is_told)] += 1;
        fs::write(path, whole).unwrap();
    }
    assert!(seen[1] >= 4, "{seen:?}: those in rows are told at least");
}

#[test]
fn a_row_that_was_changed_is_told_and_its_run_done_again() {
    let desk = studied();
    let before = tables(&desk);
    let part = part(&desk);
    let text = fs::read_to_string(&part).unwrap();
    // The last digit of a number, in the second line: still JSON, and nothing odd about it.
    let start = text.find('\n').unwrap() + 1;
    let digit = start + text[start..].find(",null").unwrap() - 1;
    assert!(text.as_bytes()[digit].is_ascii_digit());
    let mut bytes = text.clone().into_bytes();
    bytes[digit] ^= 1;
    fs::write(&part, &bytes).unwrap();
    let [printed, error] = told(&desk, "study status study.toml -o s", 0);
    assert!(printed.contains("not run") && error.contains("part-0001.jsonl:2: its digest"), "{printed}{error}");
    let [_, error] = told(&desk, "study run study.toml -o s", 0);
    assert!(error.contains("part-0001.jsonl:2: its digest") && error.contains("does its run again"), "{error}");
    assert!(tables(&desk) == before);
    // A line that a kill cut off is told too.
    fs::write(&part, &text[..text.len() - 30]).unwrap();
    fs::remove_file(desk.path("s/runs/part-0002.jsonl")).unwrap();
    let [_, error] = told(&desk, "study resume study.toml -o s", 0);
    assert!(error.contains("part-0001.jsonl:3: the line is not whole"), "{error}");
    assert!(tables(&desk) == before);
}

#[test]
fn a_kept_result_that_was_cut_off_is_told_and_made_again() {
    let desk = studied();
    let results = || {
        let mut paths: Vec<_> = fs::read_dir(desk.path("s/results")).unwrap().map(|e| e.unwrap().path()).collect();
        paths.sort();
        paths
    };
    let whole = fs::read(&results()[1]).unwrap();
    for length in [0, 1000] {
        fs::write(&results()[1], &whole[..length]).unwrap();
        let [printed, error] = told(&desk, "study status study.toml -o s", 0);
        assert!(printed.contains("not run") && error.contains(".h5: its digest is missing"), "{printed}{error}");
        let [printed, error] = told(&desk, "study resume study.toml -o s", 0);
        assert!(error.contains(".h5: its digest is missing") && printed.contains("completed"), "{printed}{error}");
        assert!(fs::read(&results()[1]).unwrap() == whole);
    }
}

/// A run that was killed beside the result of another wall: nothing draws or exports that one for it.
#[test]
fn a_result_of_another_wall_is_not_taken_for_that_of_a_run_under_way() {
    let desk = Desk::new();
    told(&desk, "run wall.toml -o o", 0);
    desk.put("long.toml", desk.get("wall.toml").replace("0.05 s\"\ntop", "60 s\"\ntop"));
    let mut child = Command::new(PROGRAM)
        .args(["run", "long.toml", "-o", "o"])
        .current_dir(desk.path(""))
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let patience = Instant::now();
    while !desk.path("o/journal.bin").exists() && patience.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    assert!(!child.wait().unwrap().success(), "the run was over before it was killed");
    assert!(desk.path("o/journal.bin").exists());
    for line in ["plot o", "plot o --figure energies", "export o --csv"] {
        let [_, error] = told(&desk, line, 2);
        assert!(error.contains("no result.h5") && error.contains("a run was cut off here"), "{error}");
    }
    assert!(!desk.path("o/report.html").exists() && !desk.path("o/csv").exists());
}

/// In a folder that others may write to, a link of that name would have a run write over what it leads to.
#[cfg(unix)]
#[test]
fn a_run_writes_over_nothing_that_a_link_leads_to() {
    let desk = Desk::new();
    fs::create_dir(desk.path("o")).unwrap();
    let names = ["journal.bin", "checkpoint.bin", "journal.lock", "result.h5", "summary.json", "report.html"];
    for name in names {
        desk.put(&format!("victims/{name}"), "precious");
        std::os::unix::fs::symlink(desk.path("victims").join(name), desk.path("o").join(name)).unwrap();
    }
    told(&desk, "run wall.toml -o o", 0);
    for name in names {
        assert_eq!(desk.get(&format!("victims/{name}")), "precious", "{name}");
    }
    told(&desk, "export o --csv", 0);
}

/// Tables that a run does not have would be another's.
#[test]
fn an_export_leaves_no_table_of_another_run() {
    let desk = Desk::new();
    told(&desk, "run wall.toml -o o", 0);
    for name in ["bonds.csv", "events.csv", "ties.csv", "corners.csv"] {
        desk.put(&format!("o/csv/{name}"), "of another run");
    }
    told(&desk, "export o --csv", 0);
    let names = fs::read_dir(desk.path("o/csv")).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    assert_eq!(
        names,
        ["block_envelopes.csv", "blocks.csv", "drift.csv", "histories.csv", "joint_envelopes.csv", "joints.csv"]
    );
}
