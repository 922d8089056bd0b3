//! Reading a wall file with all its mistakes told at once.

use std::path::Path;

use concio::case::{self, CaseFile, Signal};
use concio::run::{self, Prepared};
use concio::{Error, InputError};

use crate::failure::Failure;
use crate::motion;

/// Reads and validates a wall file.
pub fn read(path: &Path) -> Result<CaseFile, Failure> {
    let file = case::read(path)?;
    let findings = file.findings();
    if findings.is_empty() { Ok(file) } else { Err(Failure::Input(findings)) }
}

/// Lays the wall, compiles the system, reads the records.
pub fn prepare(file: &CaseFile) -> Result<Prepared, Failure> {
    Ok(run::prepare(file.case.clone(), file.folder()).map_err(|e| file.locate(named(file, e)))?)
}

/// What moves the wall: names and values.
pub fn motion(file: &CaseFile, prepared: &Prepared) -> Result<Vec<(&'static str, String)>, Failure> {
    motion::describe(prepared, file.folder())
}

/// Adds to an error in a record where the wall file names that record.
fn named(file: &CaseFile, error: Error) -> Error {
    let Error::Input(mut error) = error else { return error };
    let motions = [("motion.base", &file.case.motion.base), ("motion.top", &file.case.motion.top)];
    let found = motions.into_iter().find(|(_, signal)| {
        let Signal::Record(input) = signal else { return false };
        error.file.as_deref() == Some(file.folder().join(&input.record).as_path())
    });
    if let Some((key, _)) = found {
        let key = format!("{key}.record");
        let place = match file.locate(InputError::new("").key(&*key).into()) {
            Error::Input(at) => at.file.zip(at.line).map(|(path, line)| format!("{}:{line}", path.display())),
            _ => None,
        };
        let place = format!("the record is named in {} as {key}", place.unwrap_or_else(|| "the wall file".into()));
        error.help = Some(error.help.take().map_or_else(|| place.clone(), |help| format!("{help}; {place}")));
    }
    Error::Input(error)
}
