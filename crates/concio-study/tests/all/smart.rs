//! Smart interfaces from the study file to the answer: the same whatever the threads and whether it was interrupted,
//! better than what it started from, and wrong study files refused with their line.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use concio::run::Control;
use concio::{Error, InputError};
use concio_study::Plan;
use concio_study::answer::{Answer, Line, Spread, answer};
use concio_study::interfaces::{self, Question};
use concio_study::measures::Row;
use concio_study::runner::{Progress, Runner};
use concio_study::search::Design;

use crate::common::Desk;

/// Nine blocks under a beam, shaken by pulses.
const WALL: &str = r#"
model = "shear"
[[panel]]
bond = "running"
courses = 3
bricks = 2
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[joint]
damping_ratio = 0.05
bed = { law = "elastic", stiffness = "5.4e7 N/m" }
head = { law = "no-tension", stiffness = "5.4e7 N/m", rigidity = 10 }
friction = { law = "stribeck", static = 0.3, dynamic = 0.3, slip_velocity = "1 mm/s" }
BOND
[load]
top = "20 kN/m"
beam = { mass = "1 t" }
[motion]
duration = "60 ms"
base = { pulse = { shape = "one-sine", acceleration = "0.6 g", duration = "40 ms" } }
"#;

const BOND: &str = r#"bond = { tensile_strength = "0.1 MPa", cohesion = "0.1 MPa" }"#;

const STUDY: &str = r#"
title = "Dampers in a small wall"
wall = "wall.toml"

[[motion]]
name = "slow"
base = { pulse = { shape = "one-sine", acceleration = "0.6 g", duration = "40 ms" } }

[[motion]]
name = "quick"
base = { pulse = { shape = "half-sine", acceleration = "0.9 g", duration = "15 ms" } }

[[motion]]
name = "unknown"
base = { pulse = { shape = "one-sine", acceleration = "0.7 g", duration = "25 ms" } }
held_out = true

[interfaces]
at = { kind = ["bed", "base", "top"] }
count = 3
runs = 400
population = 8
draws = 5
copies = 4
finalists = 2

[[interfaces.objective]]
measure = "peak_joint_displacement"

[[interfaces.device]]
name = "viscous"
change = { spring = { stiffness_factor = 0, damping_ratio = 1 }, friction = { law = "none" } }
parameter = [{ path = "spring.stiffness", from = "1e6 N/m", to = "1e12 N/m", spacing = "log" }]

[[interfaces.device]]
name = "rougher"
change = { friction = {} }
parameter = [{ path = "friction.static", from = 0.1, to = 1, also = [{ path = "friction.dynamic", times = 1 }] }]
"#;

fn dry() -> String {
    WALL.replace("BOND", "")
}

/// Runs a plan and asks its question; none where `most` looks of the watch had passed.
fn asked(plan: &Plan, out: &Path, threads: usize, most: usize) -> Option<(Question, Answer)> {
    let looks = AtomicUsize::new(0);
    let watch = |_: &Progress| match looks.fetch_add(1, Ordering::Relaxed) < most {
        true => Control::Continue,
        false => Control::Stop,
    };
    let question = interfaces::question(plan).expect("a question");
    let cases: Vec<_> = (0..plan.points.len()).map(|n| plan.case(n).expect("a case")).collect();
    let mut runner = Runner::open(out, &plan.file.study.keep, threads, &watch).expect("a store");
    let rows = runner.rows(&cases).expect("rows")?;
    let rows: Vec<&Row> = rows.iter().collect();
    runner.joints.clear();
    let answer = answer(plan, &question, &rows, &mut runner).expect("an answer")?;
    Some((question, answer))
}

#[test]
fn threads_and_interruptions_change_nothing() {
    let desk = Desk::new(&dry());
    let plan = desk.plan(STUDY).expect("a plan");
    let out = |name: &str| desk.path(name);
    let (question, one) = asked(&plan, &out("one"), 1, usize::MAX).expect("an end");
    let (_, two) = asked(&plan, &out("two"), 2, usize::MAX).expect("an end");
    assert_eq!(one, two);
    // Stopped again and again, a few generations further each time.
    let mut most = 3;
    let pieces = loop {
        match asked(&plan, &out("pieces"), 2, most) {
            Some((_, answer)) => break answer,
            None => most += 7,
        }
    };
    assert!(most > 3, "it was never stopped");
    assert_eq!(one, pieces);

    // Runs are counted: 2 motions a design; 8 designs, and those known from the greedy placements, of 2 devices at a time.
    let [greedy, search, all] = one.runs;
    assert!(search <= 400 && greedy <= 400 && all > search + greedy, "{:?}", one.runs);
    assert_eq!((one.random.len(), one.placed.len(), one.greedy.len(), one.greedy_as_found.len()), (5, 5, 3, 3));
    assert_eq!((question.names.len(), question.places.most), (question.joints.len(), 3));
    let found = one.search[one.chosen].design.as_ref().expect("a design");
    assert!((1..=3).contains(&found.joints.len()));
    // Greedy places are tuned with no less than a generation short of what the search has, all rankings together, and stand
    // beside it with its own device too, in the same joints.
    assert!(greedy + 3 * 2 * 8 * 2 >= search, "{:?}", one.runs);
    for (tuned, alike) in one.greedy.iter().zip(&one.greedy_as_found) {
        let [tuned, alike] = [tuned, alike].map(|l| l.design.as_ref().expect("a design"));
        assert_eq!((&tuned.joints, alike.device, &alike.shares), (&alike.joints, found.device, &found.shares));
    }
    // The search starts from the greedy designs and can only gain on the motions that it sees.
    let verdict = one.verdict(&question, 0, false).expect("a verdict");
    let (_, tuned) = verdict.greedy[0].expect("a tuned placement");
    let (_, search) = verdict.search;
    assert!(search.mean <= tuned.mean && search.mean < verdict.unreinforced.mean, "{verdict:?}");
    assert!(one.verdict(&question, 0, true).is_some_and(|v| v.unreinforced.mean > 0.0));
    assert!(one.search.iter().all(|l| l.scenes.len() == 3 && l.held_out.len() == 1));
}

/// A line with the values of each copy under the two known motions; the held-out one has that of the second.
fn line(question: &Question, name: &str, design: Option<(usize, f64)>, copies: &[[f64; 2]]) -> Line {
    let spread = |of: &dyn Fn(&[f64; 2]) -> f64| {
        let n = copies.len() as f64;
        let mean = copies.iter().map(of).sum::<f64>() / n;
        let square: f64 = copies.iter().map(|copy| (of(copy) - mean).powi(2)).sum();
        Spread { mean, deviation: if n > 1.0 { (square / (n - 1.0)).sqrt() } else { 0.0 } }
    };
    let scene = |k: usize| vec![spread(&|copy| copy[k]).mean];
    assert_eq!(question.of(true), [2]);
    Line {
        name: name.into(),
        design: design.map(|(joint, share)| Design { device: 0, joints: vec![joint], shares: vec![share] }),
        training: vec![spread(&|copy| 0.5 * (copy[0] + copy[1]))],
        held_out: vec![spread(&|copy| copy[1])],
        scenes: [0, 1, 1].map(scene).to_vec(),
        first: [0, 1, 1].map(|k| vec![copies[0][k]]).to_vec(),
    }
}

/// The design of the search drawn again is no rival; a design that was run once is compared with the same copy of the search;
/// a scatter below a thousandth is none to count in.
#[test]
fn verdicts_compare_like_with_like() {
    let desk = Desk::new(&dry());
    let plan = desk.plan(STUDY).expect("a plan");
    let question = interfaces::question(&plan).expect("a question");
    let line = |name: &str, design, copies: &[[f64; 2]]| line(&question, name, design, copies);
    let wide = [[1.0, 1.0], [1.1, 1.1], [1.2, 1.2], [1.3, 1.3]];
    let mut answer = Answer {
        ranks: Vec::new(),
        unreinforced: line("unreinforced", None, &[[3.0, 3.0]; 4]),
        greedy: vec![
            line("greedy a", Some((1, 0.3)), &[[1.5, 1.5]; 4]),
            line("greedy b", Some((2, 0.3)), &[[1.4, 1.4]; 4]),
        ],
        greedy_as_found: vec![line("greedy a, found", Some((1, 0.5)), &[[1.6, 1.6]; 4])],
        search: vec![line("search", Some((0, 0.5)), &wide)],
        chosen: 0,
        random: vec![line("random 1", Some((3, 0.1)), &[[2.0, 0.5]]), line("random 2", Some((4, 0.1)), &[[9.0, 9.0]])],
        placed: vec![line("random 1", Some((0, 0.5)), &[[0.9, 0.9]]), line("random 2", Some((5, 0.5)), &[[1.2, 0.9]])],
        trace: Vec::new(),
        greedy_trace: Vec::new(),
        runs: [0; 3],
    };
    let deviation = f64::sqrt(0.05 / 3.0);
    let v = answer.verdict(&question, 0, false).expect("a verdict");
    assert_eq!(v.same.iter().map(|l| l.name.as_str()).collect::<Vec<_>>(), ["random 1"]);
    let near = |found: f64, right: f64| assert!((found - right).abs() < 1e-12, "{found} {right}");
    // Copy 1: 1.05 against 1.0, although the mean of the search is 1.15.
    assert_eq!((v.rival.name.as_str(), v.motions), ("random 2", [1, 2]));
    near(v.gain, 0.05 / 1.05);
    near(v.scatters.expect("copies that differ"), 0.05 / (2f64.sqrt() * deviation));
    let [tuned, as_found] = v.greedy.map(|g| g.expect("a placement").0.name.clone());
    assert_eq!([tuned.as_str(), as_found.as_str()], ["greedy b", "greedy a, found"]);
    let [random, placed] = v.random.map(|d| d.expect("draws"));
    assert_eq!([random.best, random.median], [1.25, 5.125]);
    near(placed.median, 0.975);
    // Held out: 0.9 of the same copy, where the search has 1.0; 0.5 of the one that is best in the search's motions.
    let v = answer.verdict(&question, 0, true).expect("a verdict");
    near(v.gain, (0.5 - 1.0) / 0.5);
    assert_eq!(v.motions, [0, 1]);
    // Copies that hardly differ, and a rival in copies.
    answer.search = vec![line("search", Some((0, 0.5)), &[[1.0, 1.0], [1.0, 1.0 + 1e-6], [1.0, 1.0], [1.0, 1.0]])];
    answer.random.clear();
    answer.placed.clear();
    let v = answer.verdict(&question, 0, false).expect("a verdict");
    assert_eq!((v.rival.name.as_str(), v.scatters, v.motions), ("greedy b", None, [2, 2]));
    assert!((v.gain - 0.4 / 1.4).abs() < 1e-6 && v.random == [None; 2], "{v:?}");
}

/// Within a hundredth of the range in its spacing: 10^(6 + 6 share) N/m.
#[test]
fn parameters_at_their_bounds_are_told() {
    let desk = Desk::new(&dry());
    let question = interfaces::question(&desk.plan(STUDY).expect("a plan")).expect("a question");
    let of = |device: usize, share: f64| question.devices[device].at_bounds(&[share]).join("");
    assert_eq!(of(0, 0.995), "stiffness is at its upper bound, 1000000000000 N/m");
    assert_eq!(of(0, 0.005), "stiffness is at its lower bound, 1000000 N/m");
    assert_eq!(of(1, 0.0), "static is at its lower bound, 0.1");
    assert_eq!(of(0, 0.011) + &of(0, 0.989), "");
}

#[test]
fn two_objectives_and_another_seed() {
    let desk = Desk::new(&dry());
    let two = STUDY.replace(
        "[[interfaces.device]]\nname = \"viscous\"",
        "[[interfaces.objective]]\nmeasure = \"dissipated_energy\"\n[[interfaces.device]]\nname = \"viscous\"",
    );
    let plan = desk.plan(&two).expect("a plan");
    let (question, both) = asked(&plan, &desk.path("o"), 2, usize::MAX).expect("an end");
    assert_eq!(question.objectives.iter().map(|o| o.large).collect::<Vec<_>>(), [false, true]);
    for pair in both.search.windows(2) {
        // From the smallest displacement on, every further design of the front dissipates more.
        let [a, b] = [&pair[0].training, &pair[1].training];
        assert!(a[0].mean < b[0].mean && a[1].mean < b[1].mean);
    }
    let seeded = desk.plan(&STUDY.replace("count = 3", "count = 3\nseed = 2")).expect("a plan");
    let (_, other) = asked(&seeded, &desk.path("o"), 2, usize::MAX).expect("an end");
    let plan = desk.plan(STUDY).expect("a plan");
    let (_, one) = asked(&plan, &desk.path("o"), 2, usize::MAX).expect("an end");
    assert_ne!(other.random, one.random);
}

/// The scale of the first crack of an intact wall, which is linear but for closing head joints, rises in proportion to
/// all strengths.
#[test]
fn first_cracking_is_an_objective() {
    let study = STUDY
        .replace("peak_joint_displacement\"", "first_cracking\"")
        .replace("runs = 400", "runs = 4000\ncrack_within = 0.01")
        // A device in the place of mortar has no bond.
        .replace("friction = { law = \"none\" } }", "friction = { law = \"none\" }, bond = { cohesion = 0 } }");
    let value =
        |bond: &str| first_crack(&WALL.replace("BOND", bond), &study.replace("population = 8", "population = 4"));
    let [single, double] = [value(BOND), value(&BOND.replace("0.1", "0.2"))];
    assert!(single > 0.02 && double < 20.0, "{single} {double}");
    assert!((double / single - 2.0).abs() < 0.03, "{single} {double}");
}

/// The first objective of a study for the wall as it is.
fn first_crack(wall: &str, study: &str) -> f64 {
    let desk = Desk::new(wall);
    let plan = desk.plan(study).expect("a plan");
    let question = interfaces::question(&plan).expect("a question");
    let watch = |_: &Progress| Control::Continue;
    let mut runner = Runner::open(&desk.path("out"), &Default::default(), 2, &watch).expect("a store");
    let mut bench = concio_study::bench::Bench::new(&plan, &question, &mut runner);
    let trial = concio_study::bench::Trial { design: None, scene: 0, factor: 1.0 };
    bench.values(&[trial]).expect("values").expect("not stopped")[0][0]
}

/// A wall that cracks at a scale, stands more, and cracks again: the least scale counts. The wall is a bonded block on one that slides on its base; single runs from 2.5 on by 0.05
/// find the first crack at 2.55 and none from 3 to 4.
#[test]
fn the_least_scale_of_a_first_crack_counts() {
    let wall = r#"
model = "shear"
[[panel]]
bond = "stack"
courses = 2
bricks = 1
brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
mortar = { bed = "10 mm", head = "10 mm" }
[joint]
damping_ratio = 0.002
bed = { law = "elastic", stiffness = "1e5 N/m" }
base = { law = "elastic", stiffness = "1e3 N/m" }
head = { law = "no-tension", stiffness = "5.4e7 N/m", rigidity = 1000 }
friction = { law = "coulomb", static = 0.3, dynamic = 0.3 }
[joint.bond]
tensile_strength = "0.05 MPa"
cohesion = "594 Pa"
friction_angle = "0 deg"
on = ["bed"]
[motion]
duration = "1.5 s"
base = { sine = { acceleration = "0.1 g", frequency = "26 Hz" } }
"#;
    let study = r#"
wall = "wall.toml"
[[motion]]
name = "s"
base = { sine = { acceleration = "0.1 g", frequency = "26 Hz" } }
[interfaces]
at = { kind = ["base"] }
count = 1
runs = 60
population = 4
[[interfaces.objective]]
measure = "first_cracking"
[[interfaces.device]]
name = "spring"
change = { device = { law = "elastic", stiffness = "1e5 N/m" } }
"#;
    let scale = first_crack(wall, study);
    assert!((2.45..2.6).contains(&scale), "{scale}");
}

/// The error of a study file.
fn refused(wall: &str, study: &str) -> InputError {
    match Desk::new(wall).plan(study) {
        Err(Error::Input(e)) => *e,
        other => panic!("{:?}", other.map(|_| "a plan")),
    }
}

#[test]
fn wrong_questions_are_refused_with_their_line() {
    let measure = "measure = \"peak_joint_displacement\"";
    let second = |more: &str| format!("{measure}\n[[interfaces.objective]]\n{more}");
    let swap = |from: &str, to: &str| {
        assert!(STUDY.contains(from), "{from}");
        STUDY.replace(from, to)
    };
    let all_held = swap("held_out = true", "").replace("base = {", "held_out = true\nbase = {");
    for (study, key, says) in [
        (swap(measure, &second(measure)), "interfaces.objective[1].measure", "the objective twice"),
        (
            swap(measure, &second(&format!("{measure}\ngoal = \"maximise\""))),
            "interfaces.objective[1].measure",
            "minimised and maximised at once",
        ),
        (swap(&format!("[[interfaces.objective]]\n{measure}"), ""), "interfaces.objective", "0 objectives"),
        (swap("peak_joint_displacement", "first_cracking"), "interfaces.objective[0].measure", "bonded"),
        (swap("count = 3", "count = 0"), "interfaces.count", "0 is out of range"),
        (swap("count = 3", "count = 100"), "interfaces.count", "out of range"),
        (swap("count = 3", "share = 0.001"), "interfaces.share", "which is 0"),
        (swap("count = 3", "share = 0.1\ncount = 3"), "interfaces.share", "contradict"),
        (swap("count = 3\n", ""), "interfaces", "how many"),
        (swap("1e6 N/m", "1e13 N/m"), "interfaces.device[0].parameter[0].to", "reversed"),
        (swap("to = 1,", "to = \"1 N\","), "interfaces.device[1].parameter[0].to", "unit"),
        (swap("from = 0.1", "from = -0.1"), "interfaces.device[1].change", "static"),
        (swap("friction.static", "friction.statik"), "interfaces.device[1].change", "unknown key"),
        (swap("name = \"rougher\"", "name = \"viscous\""), "interfaces.device[1].name", "two devices"),
        (swap("[\"bed\", \"base\", \"top\"]", "[\"connection\"]"), "interfaces.at", "no joint meets"),
        (swap("runs = 400", "runs = 31"), "interfaces.runs", "less than one generation"),
        (swap("copies = 4", "copies = 3"), "interfaces.copies", "3 is out of range"),
        (all_held, "motion[0].held_out", "every motion is held out"),
    ] {
        let error = refused(&dry(), &study);
        assert_eq!(error.key.as_deref(), Some(key), "{error}");
        assert!(error.what.contains(says), "{error}");
        assert!(error.line.is_some() && error.file.is_some(), "{error}");
    }
    let plain = STUDY.split("[interfaces]").next().unwrap_or_default();
    let error = refused(&dry(), plain);
    assert_eq!(error.key.as_deref(), Some("motion[2].held_out"), "{error}");
}

#[test]
fn wrong_rankings_are_refused() {
    for (by, says) in [("[]", "nothing"), ("[\"cracked\"]", "no measure"), ("[\"slip\", \"slip\"]", "twice")] {
        let error = refused(&dry(), &format!("wall = \"wall.toml\"\n[ranking]\nby = {by}\n"));
        assert!(error.what.contains(says) && error.line.is_some(), "{error}");
    }
    let desk = Desk::new(&dry());
    let plan = desk.plan("wall = \"wall.toml\"\n[ranking]\n").expect("a plan");
    assert_eq!(plan.file.study.keep.joints.len(), 3);
}
