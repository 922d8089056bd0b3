//! Warnings on the terminal, those about a key of the wall file with its line.

use concio::case::CaseFile;
use concio::warning::Warning;
use concio_study::warned::Sentence;

use crate::files;

/// Warnings of many runs that are told at most.
const MOST_SENTENCES: usize = 12;

/// Tells warnings, those about a key of the wall file with its line.
pub fn warn(file: &CaseFile, warnings: &[Warning]) {
    for warning in warnings {
        files::note(&format!("warning: {warning}{}", place(file, warning)));
    }
}

/// Tells what many runs of a wall file warn of.
pub fn warn_of_runs(file: &CaseFile, told: &[Sentence]) {
    for sentence in told.iter().take(MOST_SENTENCES) {
        // Where it is not the same everywhere, it is not the wall file that says the number.
        let place = if sentence.everywhere { place(file, &sentence.text) } else { String::new() };
        files::note(&format!("warning: {sentence}{place}"));
    }
    if told.len() > MOST_SENTENCES {
        files::note(&format!("warning: and {} more that differ", told.len() - MOST_SENTENCES));
    }
}

/// Where in the wall file that stands which a warning begins with; empty where it begins with no key.
fn place(file: &CaseFile, warning: &str) -> String {
    let place = file.path().zip(file.line_of(warning)).map(|(path, line)| format!(" ({}:{line})", path.display()));
    place.unwrap_or_default()
}
