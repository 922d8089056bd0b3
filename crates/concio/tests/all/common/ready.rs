//! Wall files as texts.

use std::path::Path;

use concio::case::{Case, Syntax, from_str};
use concio::outcome::Outcome;
use concio::run::{Prepared, prepare_case};

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

/// The last sample of a history.
pub fn last(outcome: &Outcome, name: &str) -> f64 {
    let width = outcome.layout.channels.len();
    let at = outcome.layout.channels.iter().position(|c| c.name == name).expect("a channel");
    outcome.recording.values[outcome.recording.values.len() - width + at]
}
