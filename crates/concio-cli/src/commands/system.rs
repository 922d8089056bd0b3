//! `concio system`.

use super::wall_file;
use crate::args::System;
use crate::failure::Failure;
use crate::files;

/// Prints the assembled system.
pub fn system(args: &System) -> Result<(), Failure> {
    let file = wall_file::read(&args.file)?;
    let prepared = wall_file::prepare(&file)?;
    let system = concio::system::system(&prepared.model).map_err(|e| file.locate(e))?;
    files::print_json(&format!("{system}\n"))
}
