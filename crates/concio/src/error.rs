//! The two kinds of failure a caller meets: a wrong input (the user mends it) and an environment that failed.

use std::fmt;
use std::path::{Path, PathBuf};

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

/// What is wrong with an input, where, and what is allowed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct InputError {
    /// The file, when the input came from one.
    pub file: Option<PathBuf>,
    /// Line in the file, from 1.
    pub line: Option<usize>,
    /// Column in the line, from 1.
    pub column: Option<usize>,
    /// Key of the wall file (`panel[0].brick.length`) or field of a record header.
    pub key: Option<String>,
    /// What is wrong, with the value found.
    pub what: String,
    /// The allowed values or range.
    pub allowed: Option<String>,
    /// How to mend it, when that is known ("did you mean `courses`?").
    pub help: Option<String>,
}

impl InputError {
    /// An error that says `what`; place and range follow with the other methods.
    pub fn new(what: impl Into<String>) -> Self {
        InputError { what: what.into(), ..Default::default() }
    }
    /// Names the file, unless one is named already.
    pub fn in_file(mut self, file: &Path) -> Self {
        self.file.get_or_insert_with(|| file.to_path_buf());
        self
    }
    /// Names the line (from 1).
    pub fn at_line(mut self, line: usize) -> Self {
        self.line = Some(line);
        self
    }
    /// Names the key.
    pub fn key(mut self, key: impl Into<String>) -> Self {
        self.key = Some(key.into());
        self
    }
    /// Names the allowed values.
    pub fn allowed(mut self, allowed: impl Into<String>) -> Self {
        self.allowed = Some(allowed.into());
        self
    }
    /// Adds a hint.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}:", file.display())?;
            if let Some(line) = self.line {
                write!(f, "{line}:")?;
                if let Some(column) = self.column {
                    write!(f, "{column}:")?;
                }
            }
            write!(f, " ")?;
        }
        if let Some(key) = &self.key {
            write!(f, "{key}: ")?;
        }
        write!(f, "{}", self.what)?;
        if let Some(allowed) = &self.allowed {
            write!(f, "; allowed: {allowed}")?;
        }
        if let Some(help) = &self.help {
            write!(f, "; {help}")?;
        }
        Ok(())
    }
}

impl std::error::Error for InputError {}
