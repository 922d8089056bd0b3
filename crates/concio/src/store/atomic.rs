//! Files that are there whole or not at all: written under a temporary name in the same folder, synced, renamed.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// Calls `write` with a temporary name and gives the file its name `path` once everything has reached the disk.
/// A file of that name is replaced; it stays as it was when something fails.
pub(super) fn replace(path: &Path, write: impl FnOnce(&Path) -> Result<()>) -> Result<()> {
    let temporary = temporary_name(path)?;
    // Made here so that a folder that is missing or closed is the system's error, not one of a file format.
    File::create(&temporary).map_err(|e| Error::io(path, e))?;
    let written = write(&temporary).and_then(|()| commit(&temporary, path));
    if written.is_err() {
        // The first error is the one that matters; a leftover is overwritten by the next attempt.
        let _ = fs::remove_file(&temporary);
    }
    written
}

/// [`replace`] for content that is in memory already.
pub(super) fn replace_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    replace(path, |temporary| fs::write(temporary, bytes).map_err(|e| Error::io(path, e)))
}

/// Removes what a killed [`replace`] of `path` may have left.
pub(super) fn remove_leftover(path: &Path) -> Result<()> {
    match fs::remove_file(temporary_name(path)?) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(Error::io(path, e)),
        _ => Ok(()),
    }
}

/// Makes the names in a folder durable. Systems that cannot open a folder keep names durable by themselves.
pub(super) fn sync_folder_of(path: &Path) -> Result<()> {
    if cfg!(unix) {
        let folder = folder_of(path);
        File::open(folder).and_then(|f| f.sync_all()).map_err(|e| Error::io(folder, e))?;
    }
    Ok(())
}

fn commit(temporary: &Path, path: &Path) -> Result<()> {
    // Opened for writing because Windows refuses to sync a handle that may only read.
    let file = File::options().write(true).open(temporary).map_err(|e| Error::io(path, e))?;
    file.sync_all().map_err(|e| Error::io(path, e))?;
    fs::rename(temporary, path).map_err(|e| Error::io(path, e))?;
    sync_folder_of(path)
}

fn temporary_name(path: &Path) -> Result<PathBuf> {
    let Some(name) = path.file_name() else {
        return Err(Error::Store { path: path.to_path_buf(), what: "is not the name of a file".into() });
    };
    let mut temporary = OsString::from(name);
    temporary.push(".tmp");
    Ok(path.with_file_name(temporary))
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}
