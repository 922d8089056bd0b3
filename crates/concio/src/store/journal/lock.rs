//! One run per folder: a lock on a file in it, which the system gives up when the process ends, however it ends.

use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::files::{self, remove_if_there};

/// A locked folder.
#[derive(Debug)]
pub(super) struct Lock {
    path: PathBuf,
    file: File,
}

impl Lock {
    /// Takes the lock or says that another run has it.
    pub fn take(folder: &Path) -> Result<Lock> {
        let path = folder.join("journal.lock");
        loop {
            let Some(file) = made_or_opened(&path)? else { continue };
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    let what = "another run is writing to this folder; wait for it or choose another folder";
                    return Err(Error::Store { path: folder.to_path_buf(), what: what.into() });
                }
                // Some network file systems have no locks: better a run without this guard than none.
                Err(TryLockError::Error(e)) if no_locks_here(&e) => {}
                Err(TryLockError::Error(e)) => return Err(Error::io(&path, e)),
            }
            // Between opening and locking, a run that ended may have removed the file: a lock on a file without a
            // name keeps nobody out.
            if files::is_named(&file, &path) {
                return Ok(Lock { path, file });
            }
        }
    }

    /// Removes the file, then gives up the lock.
    pub fn remove(self) -> Result<()> {
        let path = self.path.clone();
        if cfg!(windows) {
            // Windows does not remove a file that is open. Nor can another run open one that is about to go, so that
            // the order matters on the other systems only.
            drop(self);
            return remove_if_there(&path);
        }
        remove_if_there(&path)
    }
}

impl Drop for Lock {
    /// Closing the file is not enough: a process forked meanwhile holds a copy of it until it runs its own program.
    fn drop(&mut self) {
        let _ = self.file.unlock();
    }
}

/// None where the file came or went meanwhile.
fn made_or_opened(path: &Path) -> Result<Option<File>> {
    match File::options().read(true).write(true).create_new(true).open(path) {
        Ok(file) => return Ok(Some(file)),
        Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
        Err(e) => return Err(Error::io(path, e)),
    }
    // A link or a pipe is nobody's lock. A file stays: another run may hold it.
    if fs::symlink_metadata(path).is_ok_and(|named| !named.is_file()) {
        remove_if_there(path)?;
    }
    files::open_itself(path)
}

/// Whether the file system says that it knows no locks (ENOLCK, ENOSYS, EOPNOTSUPP).
fn no_locks_here(error: &std::io::Error) -> bool {
    const ENOLCK: i32 = 37;
    error.kind() == std::io::ErrorKind::Unsupported
        || (cfg!(target_os = "linux") && error.raw_os_error() == Some(ENOLCK))
}
