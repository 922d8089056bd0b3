//! One small tree for both file formats: every value knows where in the text it stands, so that errors can say so.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use jsonc_parser::ast;
use toml::de::{DeTable, DeValue};

use crate::InputError;

/// Syntax of a wall file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Syntax {
    /// TOML 1.1.
    Toml,
    /// JSON (RFC 8259), without comments.
    Json,
}

impl Syntax {
    /// By the extension (`.toml`, `.json`); with any other, a text that begins with `{` is JSON.
    pub fn of(path: &Path, text: &str) -> Syntax {
        match path.extension().and_then(|e| e.to_str()) {
            Some(e) if e.eq_ignore_ascii_case("json") => Syntax::Json,
            Some(e) if e.eq_ignore_ascii_case("toml") => Syntax::Toml,
            _ if text.trim_start().starts_with('{') => Syntax::Json,
            _ => Syntax::Toml,
        }
    }
}

/// Nesting beyond this is refused; the deepest documented key lies at 6.
const DEPTH: usize = 24;

/// A value and the byte at which it starts.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Node {
    pub at: usize,
    pub value: Value,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Null,
    Bool(bool),
    /// Wide enough for every `u64` and `i64`.
    Int(i128),
    Float(f64),
    Text(String),
    /// A TOML date or time: no key takes one.
    Date(String),
    List(Vec<Node>),
    Table(Vec<Entry>),
}

/// A key with its value; entries stand in the order of the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    pub key: String,
    pub at: usize,
    pub node: Node,
}

impl Node {
    pub fn get(&self, key: &str) -> Option<&Node> {
        match &self.value {
            Value::Table(entries) => entries.iter().find(|e| e.key == key).map(|e| &e.node),
            _ => None,
        }
    }
    pub fn get_mut(&mut self, key: &str) -> Option<&mut Node> {
        match &mut self.value {
            Value::Table(entries) => entries.iter_mut().find(|e| e.key == key).map(|e| &mut e.node),
            _ => None,
        }
    }
    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }
    pub fn text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }
    /// Gives a table the key unless it has it; other values stay as they are.
    pub fn fill(&mut self, key: &str, value: Value) {
        let at = self.at;
        if !self.has(key)
            && let Value::Table(entries) = &mut self.value
        {
            entries.push(Entry { key: key.to_string(), at, node: Node { at, value } });
        }
    }
    /// What a key path such as `joint.change[0].device` leads to.
    pub fn below(&self, path: &str) -> Option<&Node> {
        path.split(['.', '[']).filter(|s| !s.is_empty()).try_fold(self, |node, step| {
            match (&node.value, step.strip_suffix(']')) {
                (Value::List(items), Some(index)) => items.get(index.parse::<usize>().ok()?),
                _ => node.get(step),
            }
        })
    }
    /// A table of those of its keys that are asked for.
    pub fn part(&self, keys: &[&str]) -> Node {
        let of = |entries: &[Entry]| entries.iter().filter(|e| keys.contains(&e.key.as_str())).cloned().collect();
        let value = if let Value::Table(entries) = &self.value { Value::Table(of(entries)) } else { Value::Null };
        Node { at: self.at, value }
    }
    /// Byte at which a key path (`panel[0].brick.length`) stands; of a key that is absent, its nearest ancestor.
    pub fn find(&self, path: &str) -> usize {
        let (mut node, mut at) = (self, self.at);
        for step in path.split(['.', '[']).filter(|s| !s.is_empty()) {
            let next = match (&node.value, step.strip_suffix(']').map(str::parse::<usize>)) {
                (Value::List(items), Some(Ok(index))) => items.get(index).map(|n| (n, n.at)),
                (Value::Table(entries), None) => entries.iter().find(|e| e.key == step).map(|e| (&e.node, e.at)),
                _ => None,
            };
            let Some(found) = next else { break };
            (node, at) = found;
        }
        at
    }
}

/// The text of a wall file, kept to turn bytes into lines.
#[derive(Debug, Clone, Default)]
pub(crate) struct Source {
    pub path: Option<PathBuf>,
    pub text: String,
}

impl Source {
    /// Line and column of a byte, each from 1; the column counts characters.
    pub fn place(&self, byte: usize) -> (usize, usize) {
        let head = &self.text.as_bytes()[..byte.min(self.text.len())];
        let start = head.iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
        let line = 1 + head.iter().filter(|b| **b == b'\n').count();
        // A byte inside a character counts as that character.
        let column = 1 + head[start..].iter().filter(|b| (**b as i8) >= -0x40).count();
        (line, column)
    }
    /// Adds file, line and column to an error.
    pub fn locate(&self, mut error: InputError, byte: usize) -> InputError {
        let (line, column) = self.place(byte);
        error.line = Some(line);
        error.column = Some(column);
        self.named(error)
    }
    pub fn place_fault(&self, fault: Fault) -> crate::Error {
        self.locate(*fault.error, fault.at).into()
    }
    /// Adds the file to an error.
    pub fn named(&self, error: InputError) -> InputError {
        match &self.path {
            Some(path) => error.in_file(path),
            None => error,
        }
    }
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }
}

/// An error and the byte it belongs to. Boxed, for results are passed up through every level of the tree.
#[derive(Debug)]
pub(crate) struct Fault {
    pub error: Box<InputError>,
    pub at: usize,
}

impl Fault {
    pub fn new(error: InputError, at: usize) -> Fault {
        Fault { error: Box::new(error), at }
    }
}

/// Parses TOML.
pub(crate) fn parse_toml(source: &Source) -> crate::Result<Node> {
    let table = DeTable::parse(&source.text).map_err(|e| {
        let message = e.message().trim().replace('\n', ", ");
        source.locate(InputError::new(format!("not valid TOML: {message}")), e.span().map_or(0, |s| s.start))
    })?;
    let at = table.span().start;
    from_toml(DeValue::Table(table.into_inner()), at, DEPTH).map_err(|fault| source.place_fault(fault))
}

/// Takes the parser's tables apart as it goes: they are the larger ones.
fn from_toml(value: DeValue<'_>, at: usize, depth: usize) -> Result<Node, Fault> {
    let depth = deeper(depth, at)?;
    let value = match value {
        DeValue::String(s) => Value::Text(s.into_owned()),
        DeValue::Integer(i) => i128::from_str_radix(i.as_str(), i.radix())
            .map(Value::Int)
            .map_err(|_| Fault::new(InputError::new(format!("`{i}` is too large for a whole number")), at))?,
        DeValue::Float(f) => number(f.as_str(), at)?,
        DeValue::Boolean(b) => Value::Bool(b),
        DeValue::Datetime(d) => Value::Date(d.to_string()),
        DeValue::Array(items) => {
            let item = |v: toml::Spanned<DeValue<'_>>| {
                let at = v.span().start;
                from_toml(v.into_inner(), at, depth)
            };
            Value::List(items.into_iter().map(item).collect::<Result<_, _>>()?)
        }
        DeValue::Table(table) => {
            let entry = |(k, v): (toml::Spanned<std::borrow::Cow<'_, str>>, toml::Spanned<DeValue<'_>>)| {
                let (key_at, at) = (k.span().start, v.span().start);
                let node = from_toml(v.into_inner(), at, depth)?;
                Ok(Entry { key: k.into_inner().into_owned(), at: key_at, node })
            };
            let mut entries = table.into_iter().map(entry).collect::<Result<Vec<_>, Fault>>()?;
            // The parser sorts by name; the first error of a file should be the first in its text.
            entries.sort_by_key(|e| e.at);
            Value::Table(entries)
        }
    };
    Ok(Node { at, value })
}

/// Parses JSON; only the standard's syntax.
pub(crate) fn parse_json(source: &Source) -> crate::Result<Node> {
    let options = jsonc_parser::ParseOptions {
        allow_comments: false,
        allow_loose_object_property_names: false,
        allow_trailing_commas: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    };
    let parsed = jsonc_parser::parse_to_ast(&source.text, &jsonc_parser::CollectOptions::default(), &options)
        .map_err(|e| source.locate(InputError::new(format!("not valid JSON: {}", e.kind())), e.range().start))?;
    let value = parsed.value.ok_or_else(|| source.locate(InputError::new("the file is empty"), 0))?;
    from_json(&value, DEPTH).map_err(|fault| source.place_fault(fault))
}

fn from_json(value: &ast::Value<'_>, depth: usize) -> Result<Node, Fault> {
    let at = jsonc_parser::common::Ranged::range(value).start;
    let depth = deeper(depth, at)?;
    let value = match value {
        ast::Value::StringLit(s) => Value::Text(s.value.to_string()),
        ast::Value::NumberLit(n) => match n.value.parse::<i128>() {
            Ok(i) => Value::Int(i),
            Err(_) => number(n.value, at)?,
        },
        ast::Value::BooleanLit(b) => Value::Bool(b.value),
        ast::Value::NullKeyword(_) => Value::Null,
        ast::Value::Array(a) => Value::List(a.elements.iter().map(|v| from_json(v, depth)).collect::<Result<_, _>>()?),
        ast::Value::Object(object) => json_table(object, depth)?,
    };
    Ok(Node { at, value })
}

fn json_table(object: &ast::Object<'_>, depth: usize) -> Result<Value, Fault> {
    let mut seen = BTreeMap::new();
    let mut entries = Vec::with_capacity(object.properties.len());
    for property in &object.properties {
        let (key, at) = (property.name.as_str(), property.range.start);
        if seen.insert(key, at).is_some() {
            return Err(Fault::new(InputError::new("the key stands twice in one object").key(key), at));
        }
        entries.push(Entry { key: key.to_string(), at, node: from_json(&property.value, depth)? });
    }
    Ok(Value::Table(entries))
}

fn number(text: &str, at: usize) -> Result<Value, Fault> {
    text.parse::<f64>()
        .map(Value::Float)
        .map_err(|_| Fault::new(InputError::new(format!("`{text}` is not a number")), at))
}

fn deeper(depth: usize, at: usize) -> Result<usize, Fault> {
    depth.checked_sub(1).ok_or_else(|| {
        Fault::new(InputError::new("values are nested too deeply").allowed(format!("up to {DEPTH} levels")), at)
    })
}
