//! A wrong input, which its user mends: what every crate that reads numbers says of them.

use std::fmt;
use std::path::{Path, PathBuf};

/// Result with an [`InputError`], boxed because it is large.
pub type Result<T> = std::result::Result<T, Box<InputError>>;

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
