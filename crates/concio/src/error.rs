//! The two kinds of failure a caller meets: a wrong input (the user mends it) and an environment that failed.

use std::path::PathBuf;

pub use concio_law::error::InputError;

/// Result with [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// Everything a fallible function of the engine returns.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The input is wrong: exit status 2 on the command line.
    #[error(transparent)]
    Input(#[from] Box<InputError>),
    /// A file could not be read or written.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A result file or journal is not what this version writes.
    #[error("{path}: {what}")]
    Store {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
}

impl Error {
    /// An [`Error::Io`] of a path.
    pub fn io(path: impl Into<PathBuf>, source: std::io::Error) -> Self {
        Error::Io { path: path.into(), source }
    }
}

impl From<InputError> for Error {
    fn from(e: InputError) -> Self {
        Error::Input(Box::new(e))
    }
}
