//! The folder of a run: what stands in it is of one run, however the programs ended that wrote there.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;

use concio::case::{Syntax, from_str};
use concio::run::{Control, Prepared, REPORT, RESULT, SUMMARY, prepare_case, run};
use concio::store::hdf5;

fn wall(title: &str) -> Prepared {
    let text = format!(
        r#"
title = "{title}"
model = "shear"
set = "report"
[[panel]]
bond = "running"
courses = 4
bricks = 2
[load]
top = "10 kN/m"
beam = "driven"
[motion]
duration = "0.2 s"
top = {{ sine = {{ amplitude = "2 mm", frequency = "2 Hz", ramp = "0.05 s" }} }}
"#
    );
    let file = from_str(&text, Syntax::Toml, None).unwrap();
    prepare_case(file.case.clone(), Path::new("")).unwrap()
}

/// A run whose process is gone at its first look around.
fn killed(prepared: &Prepared, out: &Path) {
    let gone = catch_unwind(AssertUnwindSafe(|| run(prepared, out, &mut |_| resume_unwind(Box::new(())))));
    assert!(gone.is_err(), "the run was over before it was looked at");
}

fn whole(prepared: &Prepared, out: &Path) {
    run(prepared, out, &mut |_| Control::Continue).unwrap();
    fs::write(out.join(REPORT), "made of both").unwrap();
}

/// Beside the journal of another wall they would be taken for that wall's.
#[test]
fn results_of_another_wall_are_gone_before_a_run_begins_beside_them() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    whole(&wall("one"), out);
    killed(&wall("other"), out);
    assert!(out.join("journal.bin").exists());
    for name in [RESULT, SUMMARY, REPORT] {
        assert!(!out.join(name).exists(), "{name} of the other wall stands there still");
    }
    whole(&wall("other"), out);
    assert!(hdf5::read(&out.join(RESULT)).unwrap().provenance.case_json.contains("other"));
    // A page or summary without a result, or a result that cannot be read, is nobody's.
    fs::write(out.join(RESULT), "cut off").unwrap();
    killed(&wall("other"), out);
    assert!(!out.join(RESULT).exists() && !out.join(SUMMARY).exists() && !out.join(REPORT).exists());
}

/// They are what the run would make: nobody is misled, and a slip costs no hours.
#[test]
fn results_of_the_same_wall_stay_until_they_are_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    whole(&wall("one"), out);
    let before = [RESULT, SUMMARY, REPORT].map(|name| fs::read(out.join(name)).unwrap());
    killed(&wall("one"), out);
    assert!(out.join("journal.bin").exists());
    assert!([RESULT, SUMMARY, REPORT].map(|name| fs::read(out.join(name)).unwrap()) == before);
}

/// Another program that is at work in the folder keeps what it has.
#[test]
fn a_run_that_finds_another_at_work_removes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    whole(&wall("one"), out);
    let mut tried = false;
    run(&wall("one"), out, &mut |_| {
        let error = run(&wall("other"), out, &mut |_| Control::Continue).unwrap_err().to_string();
        assert!(error.contains("another run is writing"), "{error}");
        assert!(out.join(RESULT).exists() && out.join(SUMMARY).exists());
        tried = true;
        Control::Stop
    })
    .unwrap();
    assert!(tried);
}
