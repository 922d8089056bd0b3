//! A TOML or JSON file that knows where each of its values stands. Wall files are read from one; so are study files.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use super::de;
use super::node::{Node, Source, parse_json, parse_toml};
use super::read::{LARGEST_FILE, Syntax, hinted};
use super::size;
use super::templates::whole;
use crate::files::{Unread, read_input};
use crate::{InputError, Result};

/// Said of a file without content.
pub(super) const EMPTY: &str = "the file is empty";

/// A file that was read, its values not interpreted yet.
#[derive(Debug, Clone)]
pub struct Document {
    pub(super) source: Source,
    pub(super) tree: Node,
}

impl Document {
    /// Reads a file; `kind` is what errors call it ("a wall file").
    ///
    /// # Errors
    /// [`crate::Error::Input`] when the file cannot be read, is larger than [`LARGEST_FILE`], no UTF-8, or neither TOML
    /// nor JSON.
    pub fn open(path: &Path, kind: &str) -> Result<Self> {
        let refuse = |what: String| {
            let allowed = format!("{kind} in TOML or JSON, UTF-8, up to {} MiB", LARGEST_FILE >> 20);
            InputError::new(what).in_file(path).allowed(allowed)
        };
        let bytes = read_input(path, LARGEST_FILE).map_err(|e| match e {
            Unread::Irregular(what) => refuse(format!("is {what}, not {kind}")),
            Unread::Large(_) => refuse(format!("is too large for {kind}")),
            Unread::Io(reason) => refuse(format!("cannot be read: {reason}")),
        })?;
        if [[0xff, 0xfe], [0xfe, 0xff]].iter().any(|mark| bytes.starts_with(mark)) {
            return Err(refuse("is UTF-16 text".into()).help("save it as UTF-8").into());
        }
        let text = String::from_utf8(bytes).map_err(|e| {
            let good = &e.as_bytes()[..e.utf8_error().valid_up_to()];
            let line = 1 + good.iter().filter(|b| **b == b'\n').count();
            refuse("is not UTF-8 text".into()).at_line(line)
        })?;
        Self::parse(&text, Syntax::of(path, &text), Some(path))
    }

    /// Reads a text; `file` is named in errors and is what paths in it are relative to.
    ///
    /// # Errors
    /// [`crate::Error::Input`] when it is empty, not of this syntax, or takes too much memory.
    pub fn parse(text: &str, syntax: Syntax, file: Option<&Path>) -> Result<Self> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text).to_string();
        let source = Source { path: file.map(Path::to_path_buf), text };
        if source.text.trim().is_empty() {
            return Err(source.locate(InputError::new(EMPTY), 0).into());
        }
        size::check(&source.text, syntax).map_err(|e| source.named(e))?;
        let tree = match syntax {
            Syntax::Toml => parse_toml(&source),
            Syntax::Json => parse_json(&source),
        };
        let tree = tree.map_err(|e| hinted(e, &source.text, syntax))?;
        Ok(Document { source, tree })
    }

    /// The file.
    pub fn path(&self) -> Option<&Path> {
        self.source.path()
    }

    /// Its text.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    /// The folder that paths in it are relative to: the file's own, or the working directory.
    pub fn folder(&self) -> PathBuf {
        self.path().and_then(Path::parent).unwrap_or(Path::new("")).to_path_buf()
    }

    /// Its values as a `T`.
    ///
    /// # Errors
    /// [`crate::Error::Input`] with line, key and what is allowed there.
    pub fn to<T: DeserializeOwned + JsonSchema>(&self) -> Result<T> {
        de::from_node(&self.tree).map_err(|mut fault| {
            let e = &mut fault.error;
            if e.allowed.as_deref() == Some(de::WHOLE)
                && let Some(key) = &e.key
                && let Some(range) = whole(&schemars::schema_for!(T).to_value(), key)
            {
                e.allowed = Some(range);
            }
            self.source.place_fault(fault)
        })
    }

    /// Whether the file gives a key: `scales`, `interfaces.at.kind`.
    pub fn has(&self, path: &str) -> bool {
        path.split('.').try_fold(&self.tree, |node, step| node.get(step)).is_some()
    }

    /// Adds file, line and column to an error about a key; a key that the file leaves out stands where its nearest
    /// table does. Errors that name a place already stay as they are.
    pub fn locate(&self, error: InputError) -> InputError {
        match &error.key {
            _ if error.line.is_some() || error.file.is_some() => error,
            Some(key) => {
                let byte = self.tree.find(key);
                self.source.locate(error, byte)
            }
            None => self.source.named(error),
        }
    }
}
