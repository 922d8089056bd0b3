//! `concio export`.

use std::path::{Path, PathBuf};

use concio::store::{StoredRun, export, hdf5};
use concio::{Error, InputError};

use crate::args::Export;
use crate::failure::Failure;
use crate::files;

/// Converts the result of a run.
pub fn export(args: &Export) -> Result<(), Failure> {
    if let Some(out) = &args.out {
        guard(args, out)?;
    }
    let run = stored(&args.dir)?;
    let out = |name| args.out.clone().unwrap_or_else(|| args.dir.join(name));
    let out = if args.csv {
        let out = out("csv");
        export::csv(&run, &out).map(|()| out)
    } else if args.npz {
        let out = out("result.npz");
        export::npz(&run, &out).map(|()| out)
    } else {
        let out = out("result.vtkhdf");
        export::vtkhdf(&run, &out).map(|()| out)
    }?;
    files::note(&format!("{} is written.", out.display()));
    Ok(())
}

/// Refuses an output that would replace a file of another kind.
fn guard(args: &Export, out: &Path) -> Result<(), Failure> {
    if !args.csv {
        return files::guard(out, if args.npz { "npz" } else { "vtkhdf" }, &[]);
    }
    if out.exists() && !out.is_dir() {
        let error = InputError::new("the folder for the tables is a file").in_file(out);
        return Err(error.help("give another folder with --out").into());
    }
    Ok(())
}

/// Reads the result in a folder.
pub fn stored(folder: &Path) -> Result<StoredRun, Failure> {
    let path: PathBuf = folder.join("result.h5");
    if !path.is_file() {
        let mut error = InputError::new("there is no result.h5 in this folder").in_file(folder);
        if folder.join("journal.bin").is_file() {
            error =
                error.help("a run was cut off here: `concio run` with the same wall file and --out goes on with it");
        }
        return Err(error.allowed("the folder that `concio run` wrote to").into());
    }
    hdf5::read(&path).map_err(|error| match error {
        Error::Store { path, what } => unusable(&path, &what),
        other => other.into(),
    })
}

/// A file of a result that was cut off, changed or written by another version.
pub fn unusable(path: &Path, what: &str) -> Failure {
    let error = InputError::new(format!("this file of a result cannot be used: {what}")).in_file(path);
    error.help("`concio run` with the wall file writes it again").into()
}
