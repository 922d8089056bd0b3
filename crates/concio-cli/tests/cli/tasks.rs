//! `concio study plan` and `concio study work`: what distributes a study gets the tables of `concio study run`.

use std::fs;

use crate::support::Desk;
use crate::{analyses, first_crack};

/// The tasks that can be done now.
fn planned(desk: &Desk, line: &str) -> Vec<String> {
    let told = desk.concio(&format!("study plan {line} --json")).assert().success().get_output().stdout.clone();
    String::from_utf8(told).expect("text").lines().map(str::to_string).collect()
}

/// Does a study by tasks: the last of each plan first, one of them twice, the rows of each in a file of its own. How often it was planned.
fn by_tasks(desk: &Desk, study: &str, out: &str) -> usize {
    let runs = desk.path(out).join("runs");
    for round in 0..100 {
        let mut tasks = planned(desk, &format!("{study} --out {out} --runs 3"));
        tasks.reverse();
        if tasks.is_empty() {
            return round;
        }
        tasks.extend(tasks.first().cloned());
        fs::create_dir_all(&runs).expect("a folder");
        for (number, task) in tasks.iter().enumerate() {
            let rows = desk.concio("study work --threads 1").stdin(task.clone() + "\n").assert().success();
            let rows = rows.get_output().stdout.clone();
            fs::write(runs.join(format!("of-{round:02}-{number:02}.jsonl")), rows).expect("rows");
        }
    }
    panic!("{study} never ends");
}

fn same(desk: &Desk, names: &[&str]) {
    for name in names {
        assert!(desk.get(&format!("whole/{name}")) == desk.get(&format!("tasks/{name}")), "{name} differs");
    }
}

const DRAWN: &str = r#"wall = "wall.toml"
[[motion]]
name = "there"
base = { record = "quake.at2", pga = "0.3 g" }
[design]
kind = "latin-hypercube"
runs = 8
seed = 2
[[vary]]
path = "joint.friction.static"
from = 0.4
to = 0.8
also = [{ path = "joint.friction.dynamic", times = 0.7 }]
"#;

/// Records travel with their tasks, rows come back to the byte, in whatever order and however often.
#[test]
fn a_sweep_by_tasks_is_that_of_one_process() {
    let desk = first_crack::desk();
    let keep = "[keep]\njoints = [\"displacement\"]\n";
    desk.put("study.toml", format!("{DRAWN}{keep}"));
    desk.concio("study run study.toml --out whole").assert().success();
    let tasks = planned(&desk, "study.toml --out tasks --runs 3");
    assert_eq!(tasks.len(), 3);
    assert!(!desk.path("tasks").exists(), "planning writes nothing");
    // Elsewhere there is no record.
    fs::rename(desk.path("quake.at2"), desk.path("away.at2")).expect("a record");
    desk.put("tasks/runs/a.jsonl", "");
    let mut rows = Vec::new();
    for task in &tasks[1..] {
        rows.extend(desk.concio("study work").stdin(task.clone()).assert().success().get_output().stdout.clone());
    }
    // A worker that was killed left half a line.
    let half = rows.len() - 40;
    desk.put("tasks/runs/a.jsonl", &rows[..half]);
    fs::rename(desk.path("away.at2"), desk.path("quake.at2")).expect("a record");
    let told = desk.concio("study plan study.toml --out tasks").assert().success().get_output().stdout.clone();
    assert_eq!(String::from_utf8_lossy(&told), "  runs   4\n  tasks  1\n");
    assert_eq!(by_tasks(&desk, "study.toml", "tasks"), 1);
    desk.concio("study report study.toml --out tasks").assert().success();
    same(&desk, &["runs.csv", "joints.csv"]);
    assert_eq!(desk.concio("study run study.toml --out tasks").assert().success().get_output().status.code(), Some(0));
}

/// Whole results go to the folder that all workers see, with the bytes of one process.
#[test]
fn results_of_tasks_are_those_of_one_process() {
    let desk = first_crack::desk();
    desk.put("study.toml", format!("{DRAWN}[keep]\nresults = true\n").replace("runs = 8", "runs = 3"));
    desk.concio("study run study.toml --out whole").assert().success();
    let tasks = planned(&desk, "study.toml --out tasks --runs 2").join("\n");
    desk.concio("study work --out tasks").stdin(tasks).assert().success().stdout_eq("");
    assert!(planned(&desk, "study.toml --out tasks").is_empty());
    desk.concio("study report study.toml --out tasks").assert().success();
    same(&desk, &["runs.csv"]);
    let results = fs::read_dir(desk.path("whole/results")).expect("results");
    let mut number = 0;
    for result in results.flatten() {
        let own = fs::read(result.path()).expect("a result");
        let other = fs::read(desk.path("tasks/results").join(result.file_name())).expect("a result");
        assert!(own == other, "{:?}", result.file_name());
        number += 1;
    }
    assert_eq!(number, 3);
}

/// What asks for more when it has seen the first rows does so from plan to plan.
#[test]
fn searches_by_tasks_are_those_of_one_process() {
    let desk = first_crack::desk();
    desk.put("sliding.toml", analyses::SLIDING);
    desk.put("ida.toml", analyses::IDA);
    desk.put("crack.toml", first_crack::STUDY);
    let tables: [(&str, &[&str]); 2] = [
        ("ida.toml", &["ida.csv", "capacities.csv", "fragility.csv"]),
        ("crack.toml", &["first-crack.csv", "first-crack-runs.csv"]),
    ];
    for (study, names) in tables {
        for out in ["whole", "tasks"] {
            if desk.path(out).exists() {
                fs::remove_dir_all(desk.path(out)).expect("a folder");
            }
        }
        desk.concio(&format!("study run {study} --out whole")).assert().success();
        assert!(by_tasks(&desk, study, "tasks") > 2, "{study} asks once");
        desk.concio(&format!("study report {study} --out tasks")).assert().success();
        same(&desk, names);
    }
}

/// What is no task, or was changed on its way, is refused with its line; nothing is done.
#[test]
fn what_is_no_task_is_refused() {
    let desk = first_crack::desk();
    desk.put("study.toml", DRAWN);
    let task = planned(&desk, "study.toml --runs 1").swap_remove(0);
    let other = |from: &str, to: &str| {
        assert!(task.contains(from), "{from}");
        task.replacen(from, to, 1)
    };
    for (line, told) in [
        ("wall.toml".into(), "is no task"),
        (other("\"measures\":", "\"measures\":1"), "is of version"),
        (other("\"records\":{", "\"records\":{\"other.at2\":\"\u{20ac}\","), "no byte"),
        (other("\"pga\":2.943", "\"pga\":3.9"), "was laid out as"),
    ] {
        let refused = desk.concio("study work").stdin(format!("\n{line}\n")).assert().code(2).stdout_eq("");
        let said = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(said.contains("standard input:2: ") && said.contains(told), "{said}");
    }
}
