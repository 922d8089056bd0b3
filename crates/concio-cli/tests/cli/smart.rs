//! Critical joints and smart interfaces as a user types them.

use crate::support::Desk;

const WALL: &str = r#"
model = "shear"
[[panel]]
bond = "running"
courses = 3
bricks = 2
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[joint]
bed = { law = "elastic", stiffness = "5.4e7 N/m" }
head = { law = "no-tension", stiffness = "5.4e7 N/m", rigidity = 10 }
friction = { law = "stribeck", static = 0.3, dynamic = 0.3, slip_velocity = "1 mm/s" }
[load]
top = "20 kN/m"
beam = { mass = "1 t" }
[motion]
duration = "50 ms"
base = { pulse = { shape = "one-sine", acceleration = "0.6 g", duration = "40 ms" } }
"#;

const STUDY: &str = r#"title = "Dampers"
wall = "wall.toml"
[[motion]]
name = "known"
base = { pulse = { shape = "one-sine", acceleration = "0.6 g", duration = "40 ms" } }
[[motion]]
name = "unknown"
base = { pulse = { shape = "one-sine", acceleration = "0.8 g", duration = "25 ms" } }
held_out = true
[ranking]
listed = 3
[interfaces]
at = { kind = ["bed"] }
count = 2
runs = 60
population = 6
draws = 3
copies = 4
[[interfaces.objective]]
measure = "peak_joint_acceleration"
[[interfaces.objective]]
measure = "peak_drift"
[[interfaces.device]]
name = "viscous"
change = { spring = { stiffness_factor = 0, damping_ratio = 1 }, friction = { law = "none" } }
parameter = [{ path = "spring.stiffness", from = "1e6 N/m", to = "1e12 N/m", spacing = "log" }]
"#;

fn desk(study: &str) -> Desk {
    let desk = Desk::new();
    desk.put("wall.toml", WALL);
    desk.put("study.toml", study);
    desk
}

#[test]
fn a_search_ends_with_report_tables_and_figures() {
    let desk = desk(STUDY);
    desk.concio("study run study.toml --out out").assert().code(0);
    let page = desk.get("out/report.html");
    for text in ["Smart interfaces", "Critical joints", "held out", "greedy by relative acceleration", "replaced"] {
        assert!(page.contains(text), "{text}");
    }
    for file in ["interfaces.csv", "interfaces-by-motion.csv", "interfaces-draws.csv", "ranking.csv"] {
        assert!(desk.get(&format!("out/{file}")).lines().count() > 2, "{file}");
    }
    for figure in ["interfaces-convergence", "interfaces-placement", "interfaces-front", "critical-joints"] {
        assert!(desk.path(&format!("out/figures/{figure}.svg")).is_file(), "{figure}");
    }
    // Three lines of each kind of draws, of the wall as it is, of the rankings, and what was found.
    let compared = desk.get("out/interfaces.csv");
    for name in ["unreinforced", "\"random, median of 3\"", "search,viscous"] {
        assert!(compared.lines().any(|l| l.starts_with(name)), "{name}: {compared}");
    }
    assert!(compared.lines().next().is_some_and(|l| l.ends_with("which joints")), "{compared}");
    let greedy = compared.lines().find(|l| l.starts_with("greedy by"));
    assert!(greedy.is_some_and(|l| l.contains("p1c")), "{compared}");
    // Sentences say what the table says, kind by kind.
    let table: Vec<Vec<String>> = compared.lines().map(cells).collect();
    for (row, what) in [
        ("random, median of 3", "random placements"),
        ("random places of the found device, median of 3", "random places of the device found"),
    ] {
        let line = table.iter().find(|cells| cells[0] == row).expect("a row");
        let told = page.split(&format!("of 3 {what} the best ")).nth(1).and_then(|t| t.split("the median ").nth(1));
        let told: f64 = told.and_then(|t| t.split(' ').next()).and_then(|t| t.parse().ok()).expect("a number");
        let value: f64 = line[4].parse().expect("a number");
        assert!((told / value - 1.0).abs() < 6e-4, "{row}: {told} {value}");
    }
    for text in ["the best tuned greedy placement (greedy by ", "the better one under ", "of 1 motion."] {
        assert!(page.contains(text), "{text}");
    }
    let designs = compared.lines().filter(|l| l.starts_with("search,")).count();
    assert_eq!(page.contains("(the knee)"), designs > 1);
    // All is in the store: the report is made again, to the last byte, without a run.
    let parts = || std::fs::read_dir(desk.path("out/runs")).map(Iterator::count).unwrap_or(0);
    let before = parts();
    std::fs::remove_file(desk.path("out/report.html")).expect("a page to remove");
    desk.concio("study report study.toml --out out").assert().code(0);
    assert!(desk.get("out/report.html") == page && parts() == before);
}

#[test]
fn a_search_that_has_not_ended_is_said_to_go_on() {
    let desk = desk(STUDY);
    let plain = STUDY.split("[interfaces]").next().unwrap_or_default().replace("held_out = true", "");
    desk.put("plain.toml", plain);
    desk.concio("study run plain.toml --out out").assert().code(0);
    let output = desk.concio("study report study.toml --out out").output().expect("an end");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && text.contains("`concio study run` goes on with it"), "{text}");
    assert!(!desk.get("out/report.html").contains("Smart interfaces"));
}

/// Six designs of one device under one motion are a generation: 60 runs are ten, and 59 too few to learn from.
#[test]
fn a_search_of_few_generations_is_warned_of() {
    for (runs, warned) in [("59", true), ("60", false)] {
        let desk = desk(&STUDY.replace("runs = 60", &format!("runs = {runs}")));
        let output = desk.concio("study check study.toml").output().expect("an end");
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{text}");
        assert_eq!(text.contains("9 generations") && text.contains("10 generations take 60 runs"), warned, "{text}");
    }
}

#[test]
fn wrong_questions_end_with_status_2_before_anything_is_run() {
    for (from, to, says) in [
        ("peak_drift", "peak_joint_acceleration", "the objective twice"),
        ("count = 2", "count = 0", "0 is out of range"),
        ("peak_drift", "first_cracking", "nothing can crack"),
        ("\"1e12 N/m\"", "\"1e2 N/m\"", "reversed"),
    ] {
        let desk = desk(&STUDY.replace(from, to));
        let output = desk.concio("study run study.toml --out out").output().expect("an end");
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(text.contains("study.toml:") && text.contains(says) && text.contains("allowed:"), "{text}");
        assert!(!desk.path("out").exists());
    }
}

/// The cells of a line of CSV.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            c => cells.last_mut().into_iter().for_each(|cell| cell.push(c)),
        }
    }
    cells
}
