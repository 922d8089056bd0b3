//! `concio new`.

use std::path::Path;

use concio::case::ModelKind;

use crate::args::{Model, New};
use crate::failure::Failure;
use crate::files;

/// Writes the starter file.
pub fn new(args: &New) -> Result<(), Failure> {
    let text = concio::case::starter(match args.model {
        Model::Shear => ModelKind::Shear,
        Model::Planar => ModelKind::Planar,
        Model::Rocking => ModelKind::Rocking,
    });
    if args.file == Path::new("-") {
        return files::print(text);
    }
    files::write_new(&args.file, text)?;
    let name = args.file.display();
    files::note(&format!(
        "{name} is written. Change it, look at it with `concio check {name}`, run it with `concio run {name}`."
    ));
    Ok(())
}
