//! Reading a wall file with all its mistakes told at once.

use std::path::Path;

use concio::case::{self, CaseFile, Document, plausible};
use concio::ground::formats;
use concio::ground::record::TextOptions;
use concio::pattern;
use concio::quantity::Time;
use concio::run::{self, Prepared};
use concio::warning::WarningKind;
use concio::{Error, InputError};
use serde_json::{Map, Value};

use crate::failure::Failure;
use crate::motion;

/// Reads and validates a wall file.
pub fn read(path: &Path) -> Result<CaseFile, Failure> {
    valid(unchecked(path)?)
}

/// [`read`] for what has no motion: a file need not say how long a run is.
pub fn read_at_rest(path: &Path) -> Result<CaseFile, Failure> {
    let mut file = unchecked(path)?;
    if file.case.motion.duration.is_none() && !file.case.motion.has_length() {
        file.case.motion.duration = Some(Time::from_si(1.0));
    }
    valid(file)
}

fn unchecked(path: &Path) -> Result<CaseFile, Failure> {
    case::read(path).map_err(|e| match Kind::of(path) {
        Some(Kind::Study) => Failure::from(of_study(path)),
        _ if path.is_file() && is_record(path) => of_record(e).into(),
        _ => e.into(),
    })
}

fn valid(file: CaseFile) -> Result<CaseFile, Failure> {
    let findings = file.findings();
    if findings.is_empty() { Ok(file) } else { Err(Failure::Input(findings)) }
}

/// What a file in TOML or JSON is by its keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// It has panels.
    Wall,
    /// It names a wall.
    Study,
}

impl Kind {
    /// None where a file cannot be read, or its keys do not tell.
    pub fn of(path: &Path) -> Option<Kind> {
        // A pipe was read to its end already, and has no other.
        if !path.is_file() {
            return None;
        }
        let keys: Map<String, Value> = Document::open(path, "a file").ok()?.to().ok()?;
        match (keys.contains_key("panel"), keys.get("wall").is_some_and(Value::is_string)) {
            (true, false) => Some(Kind::Wall),
            (false, true) => Some(Kind::Study),
            _ => None,
        }
    }
}

fn of_study(path: &Path) -> InputError {
    let error = InputError::new("is a study file, and a wall file is wanted").in_file(path);
    error.help("`concio study check` and `concio study run` take study files; the wall file is named in it as `wall`")
}

/// Whether a file that is no wall file can be read as an accelerogram.
fn is_record(path: &Path) -> bool {
    formats::read(path, &TextOptions::default()).is_ok()
}

fn of_record(error: Error) -> Error {
    let Error::Input(error) = error else { return error };
    error.help("this looks like a record: `concio record` measures it, and a wall file names it").into()
}

/// Tells numbers that are hardly meant, for commands that prepare no run, which would tell them.
pub fn doubt(file: &CaseFile) {
    let mut doubts = [file.unit_doubts(), plausible::doubts(&file.case)].concat();
    doubts.retain(|doubt| doubt.kind == WarningKind::UnlikelyNumber);
    crate::warned::warn(file, &doubts);
}

/// Lays the wall, compiles the system, reads the records.
pub fn prepare(file: &CaseFile) -> Result<Prepared, Failure> {
    run::prepare(file).map_err(|error| {
        // A length in the wrong unit makes walls that cannot be laid.
        crate::warned::warn(file, &[file.unit_doubts(), plausible::doubts(&file.case)].concat());
        all(file, error)
    })
}

/// All that is wrong with the geometry of a wall that cannot be laid; else what is wrong.
pub fn all(file: &CaseFile, error: Error) -> Failure {
    let found = pattern::findings(&file.case).into_iter();
    let located = |e: InputError| match file.locate(e.into()) {
        Error::Input(e) => *e,
        other => InputError::new(other.to_string()),
    };
    let found: Vec<InputError> = found.map(located).collect();
    if found.is_empty() { error.into() } else { Failure::Input(found) }
}

/// What moves the wall, which may be `lopsided`: names and values.
pub fn motion(file: &CaseFile, prepared: &Prepared, lopsided: bool) -> Result<Vec<(&'static str, String)>, Failure> {
    motion::describe(prepared, file.folder(), lopsided)
}
