//! Reading a wall file with all its mistakes told at once.

use std::path::Path;

use concio::case::{self, CaseFile};
use concio::run::{self, Prepared};

use crate::failure::Failure;

/// Reads and validates a wall file.
pub fn read(path: &Path) -> Result<CaseFile, Failure> {
    let file = case::read(path)?;
    let findings = file.findings();
    if findings.is_empty() { Ok(file) } else { Err(Failure::Input(findings)) }
}

/// Lays the wall, compiles the system, reads the records.
pub fn prepare(file: &CaseFile) -> Result<Prepared, Failure> {
    Ok(run::prepare(file.case.clone(), file.folder()).map_err(|e| file.locate(e))?)
}
