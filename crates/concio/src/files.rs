//! Files that are there whole or not at all: written under a temporary name in the same folder, synced, renamed. Names are of their
//! own, `.NAME.….tmp`, so that any number of programs may write the same file at once; the last one stands.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use tempfile::TempPath;

use crate::error::{Error, Result};

const ENDING: &str = ".tmp";

/// Longest record that is read [bytes]. One of ten million samples, as many as a
/// run keeps, takes half of it at thirteen characters a sample.
pub const LARGEST_INPUT: u64 = 256 << 20;

/// Why an input file was not read.
#[derive(Debug)]
pub enum Unread {
    /// It is no regular file: reading a pipe or a device may never end.
    Irregular(&'static str),
    /// It is longer than that [bytes].
    Large(u64),
    /// The system's reason.
    Io(io::Error),
}

impl fmt::Display for Unread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unread::Irregular(what) => write!(f, "it is {what}, not a file"),
            Unread::Large(most) => write!(f, "it is larger than {} MiB", most >> 20),
            Unread::Io(reason) => write!(f, "{reason}"),
        }
    }
}

/// The bytes of an input file of up to `most` of them.
///
/// # Errors
/// [`Unread`] for what is no regular file, which is not even opened, for longer files, and for those that
/// the system does not give.
pub fn read_input(path: &Path, most: u64) -> std::result::Result<Vec<u8>, Unread> {
    let kind = fs::metadata(path).map_err(Unread::Io)?;
    if kind.is_dir() {
        return Err(Unread::Irregular("a folder"));
    }
    if !kind.is_file() {
        return Err(Unread::Irregular("a pipe or a device"));
    }
    if kind.len() > most {
        return Err(Unread::Large(most));
    }
    let mut bytes = Vec::new();
    // A file may grow while it is read.
    let file = File::open(path).map_err(Unread::Io)?;
    file.take(most + 1).read_to_end(&mut bytes).map_err(Unread::Io)?;
    if bytes.len() as u64 > most { Err(Unread::Large(most)) } else { Ok(bytes) }
}

/// Calls `write` with a temporary name and gives the file its name `path` once everything has reached the disk.
/// A file of that name is replaced.
///
/// # Errors
/// [`Error::Io`], [`Error::Store`] where `path` is not the name of a file, or what `write` returns; a file of that name is then as it was.
pub fn replace(path: &Path, write: impl FnOnce(&Path) -> Result<()>) -> Result<()> {
    let temporary = whole(path, write)?;
    temporary.persist(path).map_err(|e| Error::io(path, e.error))?;
    sync_folder_of(path)
}

/// [`replace`] for content that is in memory.
///
/// # Errors
/// Those of [`replace`].
pub fn replace_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    replace(path, |temporary| fs::write(temporary, bytes).map_err(|e| Error::io(path, e)))
}

/// As [`replace_bytes`], but a file of that name stays; whether there was none.
///
/// # Errors
/// Those of [`replace`].
pub fn create_bytes(path: &Path, bytes: &[u8]) -> Result<bool> {
    let temporary = whole(path, |temporary| fs::write(temporary, bytes).map_err(|e| Error::io(path, e)))?;
    match temporary.persist_noclobber(path) {
        Ok(()) => sync_folder_of(path).map(|()| true),
        Err(e) if e.error.kind() == ErrorKind::AlreadyExists => Ok(false),
        Err(e) => Err(Error::io(path, e.error)),
    }
}

/// Removes what killed programs may have left of [`replace`] of `path`. To be called where nothing else writes that file.
pub(crate) fn remove_leftovers(path: &Path) -> Result<()> {
    let (folder, prefix) = (folder_of(path), prefix(path)?);
    for entry in fs::read_dir(folder).map_err(|e| Error::io(folder, e))? {
        let name = entry.map_err(|e| Error::io(folder, e))?.file_name();
        let left = name.to_str().is_some_and(|name| name.starts_with(&prefix) && name.ends_with(ENDING));
        if left {
            remove_if_there(&folder.join(name))?;
        }
    }
    Ok(())
}

/// Removes a file; that there is none is no error.
pub(crate) fn remove_if_there(path: &Path) -> Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(Error::io(path, e)),
        _ => Ok(()),
    }
}

/// A file that was made for reading and writing; whatever bore its name is gone, and what that led to, if it was a link, is as it
/// was.
pub(crate) fn make_anew(path: &Path) -> Result<File> {
    remove_if_there(path)?;
    File::options().read(true).write(true).create_new(true).open(path).map_err(|e| Error::io(path, e))
}

/// Opens a file for reading and writing where there is one of that name itself: not where it is a link, a pipe or a device, for
/// others may write to a folder of results.
pub(crate) fn open_itself(path: &Path) -> Result<Option<File>> {
    let io = |e| Error::io(path, e);
    match fs::symlink_metadata(path) {
        Ok(named) if named.is_file() => {}
        Ok(_) => return Ok(None),
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(io(e)),
    }
    match File::options().read(true).write(true).open(path) {
        // A link may have come in between.
        Ok(file) => Ok(is_named(&file, path).then_some(file)),
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(None),
        Err(e) => Err(io(e)),
    }
}

/// Whether an open file has that name itself, and no link that leads to it.
#[cfg(unix)]
pub(crate) fn is_named(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    match (file.metadata(), fs::symlink_metadata(path)) {
        (Ok(ours), Ok(named)) => ours.ino() == named.ino() && ours.dev() == named.dev(),
        _ => false,
    }
}

/// Whether there is such a file, which is as much as these systems tell.
#[cfg(not(unix))]
pub(crate) fn is_named(_file: &File, path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|named| named.is_file())
}

/// Makes the names in a folder durable. Systems that cannot open a folder keep names durable by themselves.
pub(crate) fn sync_folder_of(path: &Path) -> Result<()> {
    if cfg!(unix) {
        let folder = folder_of(path);
        File::open(folder).and_then(|f| f.sync_all()).map_err(|e| Error::io(folder, e))?;
    }
    Ok(())
}

/// What `write` writes, on the disk under a temporary name; removed where it fails.
fn whole(path: &Path, write: impl FnOnce(&Path) -> Result<()>) -> Result<TempPath> {
    let io = |e| Error::io(path, e);
    let prefix = prefix(path)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(ENDING);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o644));
    // Made here so that a folder that is missing or closed is the system's error, not one of a file format.
    let temporary = builder.tempfile_in(folder_of(path)).map_err(io)?.into_temp_path();
    write(&temporary)?;
    // Opened for writing because Windows refuses to sync a handle that may only read.
    File::options().write(true).open(&temporary).and_then(|f| f.sync_all()).map_err(io)?;
    Ok(temporary)
}

fn prefix(path: &Path) -> Result<String> {
    match path.file_name() {
        Some(name) => Ok(format!(".{}.", name.to_string_lossy())),
        None => Err(Error::Store { path: path.to_path_buf(), what: "is not the name of a file".into() }),
    }
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn what_fails_leaves_the_file_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        replace_bytes(&path, b"whole").unwrap();
        let failed = replace(&path, |temporary| {
            fs::write(temporary, "ha").unwrap();
            Err(Error::io(temporary, ErrorKind::StorageFull.into()))
        });
        assert!(failed.is_err());
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        assert!(!create_bytes(&path, b"another").unwrap());
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        assert_eq!(names(folder.path()), ["table.csv"]);
    }

    #[test]
    fn leftovers_are_those_of_the_file() {
        let folder = tempfile::tempdir().unwrap();
        for name in [".a.bin.x7.tmp", ".b.bin.x7.tmp", "a.bin", ".a.bin.", "a.bin.tmp"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        remove_leftovers(&folder.path().join("a.bin")).unwrap();
        assert_eq!(names(folder.path()), [".a.bin.", ".b.bin.x7.tmp", "a.bin", "a.bin.tmp"]);
    }
}
