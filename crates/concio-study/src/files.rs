//! Files that are there whole or not at all, whoever else writes them at the same time: shards that end together each
//! write the tables, under temporary names of their own.

use std::fs;
use std::path::Path;

use concio::{Error, Result};

/// Calls `write` with a temporary name in the folder of `path` and renames what it wrote.
///
/// # Errors
/// [`Error::Io`], or what `write` returns; a file of that name is then as it was.
pub fn replace(path: &Path, write: impl FnOnce(&Path) -> Result<()>) -> Result<()> {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let io = |e| Error::io(path, e);
    let mut builder = tempfile::Builder::new();
    builder.prefix(".concio-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o644));
    let temporary = builder.tempfile_in(folder).map_err(io)?.into_temp_path();
    write(&temporary)?;
    fs::File::options().write(true).open(&temporary).and_then(|f| f.sync_all()).map_err(io)?;
    temporary.persist(path).map_err(|e| io(e.error))
}

/// [`replace`] for content that is in memory.
///
/// # Errors
/// [`Error::Io`].
pub fn replace_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    replace(path, |temporary| fs::write(temporary, bytes).map_err(|e| Error::io(path, e)))
}
