//! A TOML or JSON file that knows where each of its values stands. Wall files are read from one; so are study files.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use super::de;
use super::node::{Node, Source, Syntax, parse_json, parse_toml};
use super::schema::whole;
use super::size;
use crate::files::{Unread, read_input};
use crate::{Error, InputError, Result};

/// Longest wall file that is read [bytes]: a hundred thousand blocks given by hand take a third of it.
pub const LARGEST_FILE: u64 = 32 << 20;

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

    /// What the file says at a key such as `motion[0].base`, with the units that it gives.
    pub fn given(&self, path: &str) -> Option<serde_json::Value> {
        self.tree.below(path).map(super::change::to_json)
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

/// Adds to an error of a parser what it is often owed to.
fn hinted(error: Error, text: &str, syntax: Syntax) -> Error {
    let Error::Input(mut error) = error else { return error };
    if let (None, Some(number)) = (&error.help, error.line) {
        let line = text.lines().nth(number - 1).unwrap_or("");
        error.help = curly(line);
        if error.help.is_some() || syntax == Syntax::Json {
            return Error::Input(error);
        }
        error.help = both_kinds(text, line);
        if error.help.is_some() {
            return Error::Input(error);
        }
        let values = line.split(['=', '{']).skip(1);
        error.help = values.map(str::trim).find_map(de::decimal_comma).or_else(|| {
            if line.trim_start().starts_with("[panel]") {
                return Some("panels stand under two brackets each: `[[panel]]`".into());
            }
            let opened = unclosed(text, number)?;
            Some(format!("is the `{{` or `[` of line {opened} not closed?"))
        });
    }
    Error::Input(error)
}

/// What to write where a list of tables is also a table: `[a]` and `[[a]]`.
fn both_kinds(text: &str, line: &str) -> Option<String> {
    let header = |line: &str| {
        let inner = line.trim().split('#').next()?.trim().strip_prefix('[')?.strip_suffix(']')?;
        let list = inner.strip_prefix('[').and_then(|name| name.strip_suffix(']'));
        Some((list.unwrap_or(inner).trim().to_string(), list.is_some()))
    };
    let (name, is_list) = header(line)?;
    let other = text.lines().position(|other| header(other).is_some_and(|(n, list)| n == name && list != is_list))?;
    Some(format!(
        "line {} has it with other brackets: where there may be several, write `[[{name}]]` both times",
        other + 1
    ))
}

/// What to write instead of a line with quotes that word processors make, where they stand outside of a text.
fn curly(line: &str) -> Option<String> {
    let straight = |c: char| match c {
        '“' | '”' | '„' | '‟' | '«' | '»' | '″' => Some('"'),
        '‘' | '’' | '‚' | '‛' => Some('\''),
        _ => None,
    };
    let mut quote = None;
    let outside = line.chars().any(|c| {
        match (quote, c) {
            (Some(q), _) => quote = (q != c).then_some(q),
            (None, '"' | '\'') => quote = Some(c),
            _ => {}
        }
        quote.is_none() && straight(c).is_some()
    });
    let line: String = line.trim().chars().map(|c| straight(c).unwrap_or(c)).collect();
    outside.then(|| format!("the line has curly quotes; texts stand in straight ones: {line}"))
}

/// Line of the innermost bracket that is opened before line `end` (from 1) and not closed by then. Texts and comments
/// are passed over; texts of several lines are not known, for the hint is a question.
fn unclosed(text: &str, end: usize) -> Option<usize> {
    let mut open = Vec::new();
    for (index, line) in text.lines().enumerate().take(end.saturating_sub(1)) {
        let mut quote = None;
        let mut letters = line.chars();
        while let Some(c) = letters.next() {
            match (quote, c) {
                (Some('"'), '\\') => {
                    letters.next();
                }
                (Some(q), _) => quote = (q != c).then_some(q),
                (None, '"' | '\'') => quote = Some(c),
                (None, '#') => break,
                (None, '{' | '[') => open.push(index + 1),
                (None, '}' | ']') => {
                    open.pop();
                }
                _ => {}
            }
        }
    }
    open.pop()
}
