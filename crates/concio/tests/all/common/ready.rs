//! Wall files as texts, made ready and run.

use std::path::Path;

use concio::case::{Case, Syntax, from_str};
use concio::outcome::Outcome;
use concio::run::{Prepared, prepare_case, run_in_memory};

/// A wall file made ready to run.
pub fn ready(text: &str) -> Prepared {
    edited(text, |_| {})
}

/// The same with changes that the text does not make.
pub fn edited(text: &str, edit: impl FnOnce(&mut Case)) -> Prepared {
    let file = from_str(text, Syntax::Toml, None).unwrap();
    file.validate().unwrap();
    let mut case = file.case.clone();
    edit(&mut case);
    prepare_case(case, Path::new("")).unwrap()
}

/// What comes of a wall file, and the wall.
pub fn ran(text: &str) -> (Prepared, Outcome) {
    let prepared = ready(text);
    let outcome = run_in_memory(&prepared).expect("a run");
    (prepared, outcome)
}

/// All samples of a history.
pub fn channel(outcome: &Outcome, name: &str) -> Vec<f64> {
    outcome.history(name).expect(name)
}

/// Whether a number is as expected, but for a part of it.
#[track_caller]
pub fn close(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() <= relative, "{found} instead of {expected}");
}

/// The last sample of a history.
pub fn last(outcome: &Outcome, name: &str) -> f64 {
    let width = outcome.layout.channels.len();
    let at = outcome.layout.channels.iter().position(|c| c.name == name).expect("a channel");
    outcome.recording.values[outcome.recording.values.len() - width + at]
}
