//! What a program does that uses the engine as a library.

use concio::case::{
    Brick, Case, CaseFile, Friction, Joints, ModelKind, Motion, Panel, Spring, SpringLaw, Syntax, canonical_json,
    from_str,
};
use concio::ground::signal::GroundMotion;
use concio::many::{Job, simulate_each};
use concio::record::StopReason;
use concio::run::{Control, Prepared, prepare, prepare_moved, run_in_memory, run_watched};
use std::sync::Mutex;

/// A stone of 1 × 0.5 × 0.4 m on its base, without a motion.
fn stone(duration: f64) -> Case {
    let panel = Panel::stack(1, 1, Brick::new([1.0, 0.5, 0.4], 20e3), [0.0, 0.0]);
    let mut joints = Joints::new(Spring::rigid(), Spring::none());
    joints.friction = Friction::coulomb(0.3);
    Case::new(ModelKind::Planar, panel, joints, Motion { duration: Some(duration.into()), ..Motion::default() })
}

/// Under an acceleration of 0.5 g for 0.4 s and none after it, sampled.
fn pushed(duration: f64) -> Prepared {
    let samples: Vec<f64> = (0..=400).map(|_| 0.5 * concio::G).collect();
    let wall = CaseFile::of(&stone(duration)).expect("a wall");
    prepare_moved(&wall, GroundMotion::sampled(1e-3, &samples).expect("a motion")).expect("a run")
}

#[test]
fn a_wall_that_is_built_is_the_one_that_is_read() {
    let text = r#"
        model = "shear"
        [[panel]]
        bond = "running"
        courses = 6
        bricks = 4
        brick = { length = "250 mm", height = "55 mm", thickness = "120 mm", specific_weight = "18 kN/m3" }
        mortar = { bed = "10 mm", head = "12 mm" }
        [joint]
        bed = { law = "elastic", stiffness = "2e7 N/m" }
        head = { law = "no-tension", stiffness = "1e7 N/m" }
        friction = { law = "coulomb", static = 0.6 }
        [motion]
        duration = "2 s"
    "#;
    let read = from_str(text, Syntax::Toml, None).expect("a wall file").case;
    let panel = Panel::running(6, 4, Brick::new([0.25, 0.055, 0.12], 18e3), [0.01, 0.012]);
    let mut joints = Joints::new(Spring::new(SpringLaw::Elastic, 2e7), Spring::new(SpringLaw::NoTension, 1e7));
    joints.friction = Friction { dynamic: read.joint.friction.dynamic, ..Friction::coulomb(0.6) };
    let motion = Motion { duration: Some(2.0.into()), ..Motion::default() };
    let built = CaseFile::of(&Case::new(ModelKind::Shear, panel, joints, motion)).expect("a wall").case;
    assert_eq!(canonical_json(&built), canonical_json(&read));
}

/// Newmark's block: pushed by a for T on ground that then goes on at its speed, it slides by ½ (a − μ g) T² and as much again as μ g takes to stop it,
/// a (a − μ g) T²/(2 μ g) in all.
#[test]
fn a_motion_of_ones_own_moves_the_wall() {
    let outcome = run_in_memory(&pushed(2.0)).expect("a run");
    let (a, mu_g, t) = (0.5 * concio::G, 0.3 * concio::G, 0.4);
    let expected = a * (a - mu_g) * t * t / (2.0 * mu_g);
    let found = outcome.totals.peak_relative_displacement;
    assert!((found / expected - 1.0).abs() < 0.01, "{found} for {expected}");
}

/// Inputs tell runs apart, a motion of one's own too.
#[test]
fn a_motion_of_ones_own_is_part_of_what_a_run_is_known_by() {
    let wall = CaseFile::of(&stone(1.0)).expect("a wall");
    let motion = |a: f64| GroundMotion::sampled(1e-3, &[a, a]).expect("a motion");
    let hash = |a: f64| prepare_moved(&wall, motion(a)).expect("a run").inputs_hash;
    assert_eq!(hash(1.0), hash(1.0));
    assert_ne!(hash(1.0), hash(1.5));
}

#[test]
fn a_monitor_looks_at_every_step_and_stops_the_run_there() {
    let prepared = pushed(2.0);
    let whole = run_in_memory(&prepared).expect("a run");
    let mut steps = 0;
    let part = run_watched(&prepared, &mut |run| {
        steps += 1;
        assert_eq!(run.state().counters.steps, steps);
        if run.time() >= 0.3 { Control::Stop } else { Control::Continue }
    });
    let part = part.expect("a run");
    assert_eq!((part.stop_reason, whole.stop_reason), (StopReason::Interrupted, StopReason::Completed));
    assert!((part.time_reached - 0.3).abs() < 2e-3, "{}", part.time_reached);
    let told = part.recording.time.len();
    assert!(told > 100 && part.recording.time == whole.recording.time[..told]);
    assert!(part.recording.values == whole.recording.values[..part.recording.values.len()]);
}

/// A rule ends each run by itself, on any number of threads.
#[test]
fn a_rule_ends_runs_of_a_batch() {
    let walls: Vec<Prepared> = [1.0, 1.5, 2.0].map(pushed).into();
    let jobs: Vec<Job> = walls.iter().map(Job::from).collect();
    let until = |job: &Job| -> Box<dyn Fn(&concio::state::State) -> bool> {
        let half = 0.5 * job.model.excitation.duration;
        Box::new(move |state| state.t >= half)
    };
    for threads in [1, 2] {
        let ends = Mutex::new(vec![0.0; jobs.len()]);
        simulate_each(&jobs, threads, Some(&until), &|_| Control::Continue, &|number, outcome| {
            let outcome = outcome.expect("a run");
            assert_eq!((outcome.stop_reason, outcome.recording.time.len()), (StopReason::Completed, 0));
            ends.lock().expect("no panic")[number] = outcome.time_reached;
        });
        let ends = ends.into_inner().expect("no panic");
        assert!(ends.iter().zip([0.5, 0.75, 1.0]).all(|(t, end)| (t - end).abs() < 2e-3), "{ends:?}");
    }
}

/// A motion that no file gives is doubted as a record is, and every run of it says that its result does not hold it.
#[test]
fn a_motion_of_ones_own_is_doubted_as_records_are() {
    use concio::warning::WarningKind::{Drift, MotionInNoFile, RecordCut, UnlikelyPeak};
    let kinds = |peak: f64, duration: f64| -> Vec<_> {
        // Two seconds of a sine whose velocity never turns: it drifts.
        let samples: Vec<f64> = (0..=400).map(|k| peak * (f64::from(k) * 0.01 * std::f64::consts::PI).sin()).collect();
        let wall = CaseFile::of(&stone(duration)).expect("a wall");
        let prepared = prepare_moved(&wall, GroundMotion::sampled(5e-3, &samples).expect("a motion")).expect("a run");
        let kinds = prepared.model.warnings.iter().map(|warning| warning.kind);
        kinds.filter(|kind| [Drift, MotionInNoFile, RecordCut, UnlikelyPeak].contains(kind)).collect()
    };
    assert_eq!(kinds(3.0, 2.0), [Drift, MotionInNoFile]);
    assert_eq!(kinds(100.0, 1.0), [RecordCut, Drift, UnlikelyPeak, MotionInNoFile]);
    let wall = CaseFile::of(&stone(1.0)).expect("a wall");
    let still = prepare_moved(&wall, GroundMotion::AtRest).expect("a run");
    assert!(still.model.warnings.iter().all(|warning| warning.kind != MotionInNoFile));
}

/// What is wrong with a wall is said with its place, whichever step finds it.
#[test]
fn preparing_says_where_a_wall_is_wrong() {
    let text = canonical_json(&stone(1.0)).replace("\"courses\":1", "\"courses\":0");
    let file = from_str(&text, Syntax::Json, Some(std::path::Path::new("wall.json"))).expect("a wall file");
    let error = prepare(&file).expect_err("no courses").to_string();
    assert!(error.contains("wall.json:1") && error.contains("courses"), "{error}");
    let moving = CaseFile::of(&stone(1.0)).expect("a wall").changed(&[(
        "motion.base".into(),
        serde_json::json!({ "pulse": { "shape": "rectangular", "acceleration": 1.0, "duration": 1.0 } }),
    )]);
    let error = prepare_moved(&moving.expect("a wall"), GroundMotion::AtRest).expect_err("two motions").to_string();
    assert!(error.contains("motion.base"), "{error}");
    for (dt, samples) in [(0.0, vec![1.0; 3]), (1e-3, vec![1.0]), (1e-3, vec![1.0, f64::NAN])] {
        assert!(GroundMotion::sampled(dt, &samples).is_err(), "{dt} {samples:?}");
    }
}

/// A load that has no mass is missing under a motion of one's own too.
#[test]
fn a_motion_of_ones_own_asks_for_the_mass_of_loads() {
    let mut wall = stone(1.0);
    (wall.load.top, wall.load.mass) = (40e3.into(), Some(0.0.into()));
    let motion = GroundMotion::sampled(1e-3, &[1.0, 1.0]).expect("a motion");
    let prepared = prepare_moved(&CaseFile::of(&wall).expect("a wall"), motion).expect("a run");
    let kinds: Vec<_> = prepared.model.warnings.iter().map(|warning| warning.kind).collect();
    assert!(kinds.contains(&concio::warning::WarningKind::MasslessLoad), "{kinds:?}");
}
