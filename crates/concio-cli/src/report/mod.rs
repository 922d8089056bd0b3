//! report.html: one file without references to others, to be read anywhere and years later.

use std::path::{Path, PathBuf};

use concio::case::{self, Beam, Case, Syntax};
use concio::outcome::Outcome;
use concio::run::{Finished, Prepared};
use concio::store::{JointRow, StoredRun};
use concio::wall::Wall;
use serde_json::Value;

use crate::failure::Failure;
use crate::files;

mod data;
mod doubts;
mod figures;
mod pack;
mod page;

/// What a report is made of.
#[derive(Debug)]
pub struct Content<'a> {
    /// Name of the run, from its folder.
    pub name: String,
    /// The resolved input.
    pub case: Case,
    /// The wall file as it was given.
    pub text: Option<&'a str>,
    /// The command that made the result, where it is known.
    pub command: Option<String>,
    /// Blocks.
    pub wall: &'a Wall,
    /// Joints and their laws.
    pub joints: &'a [JointRow],
    /// The result.
    pub outcome: &'a Outcome,
    /// Content of summary.json.
    pub summary: &'a Value,
}

impl<'a> Content<'a> {
    /// Of a run that has just ended: `joints` are those of its model, `text` is its wall file. The command is the caller's
    /// to add.
    pub fn of_run(
        out: &Path,
        prepared: &'a Prepared,
        joints: &'a [JointRow],
        finished: &'a Finished,
        text: &'a str,
    ) -> Self {
        Content {
            name: name(out),
            case: prepared.case.clone(),
            text: Some(text),
            command: None,
            wall: &prepared.model.wall,
            joints,
            outcome: &finished.outcome,
            summary: &finished.summary,
        }
    }

    /// Of a run read back from its files.
    pub fn of_stored(folder: &Path, run: &'a StoredRun, summary: &'a Value) -> Result<Self, Failure> {
        let case = case::from_str(&run.provenance.case_json, Syntax::Json, None)?.case;
        Ok(Content {
            name: name(folder),
            case,
            text: None,
            command: None,
            wall: &run.wall,
            joints: &run.joints,
            outcome: &run.outcome,
            summary,
        })
    }

    /// Whether blocks rise and turn.
    fn is_planar(&self) -> bool {
        self.outcome.layout.turned > 0
    }

    /// A history by the name of its channel.
    fn history(&self, name: &str) -> Option<Vec<f64>> {
        self.outcome.history(name)
    }
}

/// What was typed to run `file`, or the built-in example, as a shell takes it.
pub fn command(file: Option<&Path>, out: &Path) -> String {
    let words = file.into_iter().chain([Path::new("--out"), out]);
    let quoted = words.map(|word| {
        let word = word.display().to_string();
        let plain = |c: char| c.is_alphanumeric() || "._-/\\:".contains(c);
        if word.chars().all(plain) { word } else { format!("'{}'", word.replace('\'', "'\\''")) }
    });
    format!("concio run {}", quoted.collect::<Vec<_>>().join(" "))
}

fn name(folder: &Path) -> String {
    folder.file_name().map_or_else(|| "run".into(), |n| n.to_string_lossy().into_owned())
}

/// Writes the report into the folder of the run; its path.
pub fn write(folder: &Path, content: &Content) -> Result<PathBuf, Failure> {
    let path = folder.join(concio::run::REPORT);
    write_to(&path, content)?;
    Ok(path)
}

/// Writes the report to a file.
pub fn write_to(path: &Path, content: &Content) -> Result<(), Failure> {
    files::write(path, &page::html(content))
}

/// What the top beam does, as it is written on it.
pub fn beam_label(case: &Case) -> String {
    match case.load.beam {
        Beam::Free => String::new(),
        Beam::Driven => "top beam, driven".into(),
        Beam::Tied => "top beam, moves with the base".into(),
        Beam::Mass(m) => format!("top beam, {}", crate::draw::wall::mass(m.si())),
    }
}
