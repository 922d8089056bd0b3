//! `stop_at = "collapse"`: a run ends some time after it, with the bits of one that goes on.

use std::path::Path;

use concio::case::{Signal, Syntax, canonical_json, from_str};
use concio::quantity::Acceleration;
use concio::record::StopReason;
use concio::run::{Control, Prepared, RESULT, prepare_case, run, run_in_memory};
use concio::store::hdf5;

/// A slender stone that turns over: from 0.2 g on, here under 0.3 g.
fn stone(stop: &str) -> Prepared {
    let text = format!(
        r#"
model = "planar"
[[panel]]
bond = "stack"
courses = 1
bricks = 1
brick = {{ length = 0.2, height = 1.0, thickness = 0.5, specific_weight = 20e3 }}
mortar = {{ bed = 0, head = 0 }}
[joint]
bed = {{ law = "rigid" }}
head = {{ law = "none" }}
friction = {{ law = "coulomb", static = 0.8 }}
[motion]
duration = "8 s"
{stop}
base = {{ tilt = {{ acceleration = "0.3 g", rise = "10 ms" }} }}
[output]
interval = "2 ms"
frames = "20 ms"
"#
    );
    let file = from_str(&text, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
    file.validate().unwrap_or_else(|e| panic!("{e}"));
    // What is kept of the input says the same.
    assert_eq!(from_str(&canonical_json(&file.case), Syntax::Json, None).expect("a case").case, file.case);
    prepare_case(file.case, Path::new(".")).expect("a wall")
}

#[test]
fn a_run_ends_after_its_collapse_with_the_bits_of_one_that_goes_on() {
    let whole = run_in_memory(&stone("")).expect("a run");
    assert_eq!(whole.stop_reason, StopReason::Completed);
    let collapse = whole.totals.collapse.expect("it turns over");
    for (stop, after) in [
        ("stop_at = \"collapse\"", 2.0),
        ("stop_at = { collapse = \"0.25 s\" }", 0.25),
        ("stop_at = { collapse = 0 }", 0.0),
    ] {
        let short = run_in_memory(&stone(stop)).expect("a run");
        assert_eq!((short.stop_reason, short.totals.collapse), (StopReason::Collapsed, Some(collapse)), "{stop}");
        // The first step whose forces belong to no earlier instant; steps of 1 ms.
        let late = short.time_reached - (collapse.time + after);
        assert!((0.0..1e-3 + 1e-12).contains(&late), "{stop}: {late} s late");
        let (a, b) = (&short.recording, &whole.recording);
        assert!(a.time.len() > 100 && a.time.len() < b.time.len(), "{stop}");
        assert_eq!(a.time[..], b.time[..a.time.len()], "{stop}");
        let same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits());
        assert!(same(&a.values, &b.values) && same(&a.frame_rotation, &b.frame_rotation), "{stop}");
        // Peaks are those of the time before the collapse, in both.
        assert_eq!(short.envelopes.block_displacement, whole.envelopes.block_displacement, "{stop}");
    }
    // A wall that stands is not stopped.
    let mut case = stone("stop_at = \"collapse\"").case;
    let Signal::Tilt(tilt) = &mut case.motion.base else { panic!("{:?}", case.motion.base) };
    tilt.acceleration = Acceleration::from_si(0.09 * concio::G);
    let out = run_in_memory(&prepare_case(case, Path::new(".")).expect("a wall")).expect("a run");
    assert_eq!((out.stop_reason, out.totals.collapse), (StopReason::Completed, None));
}

/// Stopped by the user on the way and taken up again, it ends where it would have; the file says why.
#[test]
fn a_run_that_is_taken_up_ends_at_the_same_step() {
    let prepared = stone("stop_at = { collapse = \"0.1 s\" }");
    let folders = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let once = run(&prepared, folders[0].path(), &mut |_| Control::Continue).expect("a run");
    let first = run(&prepared, folders[1].path(), &mut |_| Control::Stop).expect("a run");
    assert_eq!(first.outcome.stop_reason, StopReason::Interrupted);
    let again = run(&prepared, folders[1].path(), &mut |_| Control::Continue).expect("a run");
    assert!(again.resumed_from.is_some_and(|t| t > 0.0));
    assert_eq!(again.outcome, once.outcome);
    assert_eq!(
        (&again.summary["stop_reason"], &again.summary["collapse"]),
        (&"collapsed".into(), &once.summary["collapse"])
    );
    let kept = hdf5::read(&folders[1].path().join(RESULT)).expect("a result");
    assert_eq!(kept.outcome.stop_reason, StopReason::Collapsed);
    assert!(!folders[1].path().join("journal.bin").exists());
    // That it ends while the stone is still falling is meant.
    let told = again.summary["warning_kinds"].to_string();
    assert!(told.contains("collapse") && !told.contains("under-way"), "{told}");
}
