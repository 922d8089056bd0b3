//! Wall files: read, changed, made ready, and asked for what needs no run.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Parser;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use concio::InputError;
use concio::case::{self, CaseFile, Syntax, canonical_json};
use concio::ground::coverage::{is_of_peak, odd_unit};
use concio::ground::signal::from_record;
use concio::run::{prepare, prepare_moved};
use concio::warning::{Warning, WarningKind};
use concio_cli::args::Cli;
use concio_cli::commands::{self, Answer, wall_file};
use concio_cli::failure::Failure;
use pyo3::prelude::*;
use serde_json::Value;

use crate::failure::Raised;
use crate::prepared::Prepared;
use crate::record::Record;
use crate::{examples, json};

/// A wall file that is valid.
#[pyclass(frozen, module = "concio._native")]
pub struct Case {
    file: CaseFile,
    /// Whether its text is one that the user wrote, so that lines in it mean something.
    written: bool,
    /// Whether it was read from its file; else that only says where paths begin.
    read: bool,
}

impl Case {
    fn valid(file: CaseFile, written: bool, read: bool) -> Result<Self, Raised> {
        let findings = file.findings();
        let case = Case { file, written, read };
        if findings.is_empty() { Ok(case) } else { Err(case.raised(Raised::Input(findings))) }
    }

    fn raised(&self, error: impl Into<Raised>) -> Raised {
        placed(error.into(), self.written, self.file.path().filter(|_| !self.read))
    }
}

/// Takes from an error in a text its file where that is `none`, and in one that nobody wrote the line too.
fn placed(error: Raised, written: bool, none: Option<&Path>) -> Raised {
    match error {
        Raised::Input(all) => {
            let bare = |e: InputError| match e.file.as_deref() {
                Some(file) if Some(file) != none => unplaced(e, none),
                _ if written => InputError { file: None, ..e },
                _ => InputError { file: None, line: None, column: None, ..e },
            };
            Raised::Input(all.into_iter().map(bare).collect())
        }
        other => other,
    }
}

/// Takes from a remedy the place in the file that is `none`.
fn unplaced(error: InputError, none: Option<&Path>) -> InputError {
    let Some((help, name)) = error.help.as_ref().zip(none.map(|none| none.display().to_string())) else { return error };
    let Some((before, after)) = help.split_once(&name) else { return error };
    let after = after.strip_prefix(':').map_or(after, |line| line.trim_start_matches(|c: char| c.is_ascii_digit()));
    InputError { help: Some(format!("{before}the wall file{after}")), ..error }
}

#[pymethods]
impl Case {
    /// Reads a file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        Ok(py.detach(|| Case::valid(case::read(&path)?, true, true))?)
    }

    /// Reads a text; `file` is named in errors and is what paths of records are relative to. `written` says that a user wrote it.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, is_json: bool, file: Option<PathBuf>, written: bool) -> PyResult<Self> {
        let syntax = if is_json { Syntax::Json } else { Syntax::Toml };
        let read = || {
            let file = case::from_str(text, syntax, file.as_deref())
                .map_err(|e| placed(e.into(), written, file.as_deref()))?;
            Case::valid(file, written, false)
        };
        Ok(py.detach(read)?)
    }

    /// An example by its name; none of that name comes back as none.
    #[staticmethod]
    fn example(name: &str) -> PyResult<Option<Self>> {
        let Some(text) = examples::text(name) else { return Ok(None) };
        let file = case::from_str(text, Syntax::Toml, None).map_err(Raised::from)?;
        Ok(Some(Case::valid(file, true, false)?))
    }

    /// The same wall with other values: a JSON object of key paths and what stands there instead.
    fn changed(&self, py: Python<'_>, changes: &str) -> PyResult<Self> {
        let Value::Object(changes) = json::of_text(changes)? else {
            return Ok(Case { file: self.file.clone(), written: self.written, read: self.read });
        };
        let changes: Vec<(String, Value)> = changes.into_iter().collect();
        let changed = || {
            let file = self.file.changed(&changes).map_err(|e| self.raised(e))?;
            Case::valid(file, self.written, self.read)
        };
        Ok(py.detach(changed)?)
    }

    /// Makes it ready to run; `base` moves the base instead of what the file says, which has to be nothing then.
    fn prepare(&self, py: Python<'_>, base: Option<&Record>) -> PyResult<Prepared> {
        let prepared = || {
            let prepared = match base {
                None => prepare(&self.file),
                Some(record) => prepare_moved(&self.file, from_record(&record.history)),
            };
            let mut prepared = prepared.map_err(|e| self.raised(wall_file::all(&self.file, e)))?;
            // Only here it is known in which unit the array was given; the last of the doubts tells that no file gives the motion.
            let as_given = base.filter(|record| !record.sized);
            let unit = "motion.base: the unit of the record";
            let doubted = |record: &&Record| odd_unit(unit, "its unit", &record.history);
            let odd = as_given.and_then(|record| doubted(&record));
            if odd.is_some() {
                prepared.model.warnings.retain(|w| !is_of_peak(w));
            }
            let odd = odd.map(|text| Warning::new(WarningKind::UnlikelyRecord, text));
            let last = prepared.model.warnings.len().saturating_sub(1);
            prepared.model.warnings.splice(last..last, odd);
            let warnings = prepared.model.warnings.iter();
            let doubts = warnings.map(|w| (w.clone(), self.file.line_of(w).filter(|_| self.written))).collect();
            Ok::<_, Raised>(Prepared { prepared: Arc::new(prepared), text: self.text().map(str::to_string), doubts })
        };
        Ok(py.detach(prepared)?)
    }

    /// What the command line prints with `--json` when it is given these arguments for this wall, of which the first is the command, and the
    /// mechanism as SVG where there is one.
    fn answer(&self, py: Python<'_>, arguments: Vec<String>) -> PyResult<(Py<PyAny>, Option<String>)> {
        let name = self.file.path().unwrap_or(Path::new("wall"));
        let (head, options) = arguments.split_at(arguments.len().min(1));
        let line = [OsString::from("concio")].into_iter().chain(head.iter().map(OsString::from));
        let line = line.chain([name.as_os_str().to_owned()]).chain(options.iter().map(OsString::from));
        let cli = Cli::try_parse_from(line).map_err(|e| Raised::from(misused(&e)))?;
        let answer = py.detach(|| {
            let answer = commands::answer(&cli.command, &self.file)?;
            answer.ok_or_else(|| Failure::Other("this command gives no answer".into(), None))
        });
        let Answer { value, drawing } = answer.map_err(|e| self.raised(in_memory(e, self.file.path())))?;
        Ok((json::to_python(py, &value)?.unbind(), drawing))
    }

    /// The text that it was read from, without what was changed.
    #[getter]
    fn text(&self) -> Option<&str> {
        self.written.then(|| self.file.text())
    }

    /// The file that it was read from.
    #[getter]
    fn path(&self) -> Option<&Path> {
        self.file.path().filter(|_| self.read)
    }

    /// The folder that paths of records are relative to.
    #[getter]
    fn folder(&self) -> PathBuf {
        self.file.folder().to_path_buf()
    }

    /// What the wall file says itself, changes in it, as JSON: without defaults.
    #[getter]
    fn given(&self) -> String {
        self.file.given().to_string()
    }

    /// All that the wall file says, defaults in it, SI, as JSON.
    #[getter]
    fn json(&self) -> String {
        canonical_json(&self.file.case)
    }
}

/// Takes the name of a file from errors of a wall that is in none.
fn in_memory(failure: Failure, path: Option<&Path>) -> Failure {
    match failure {
        Failure::Input(all) if path.is_none() => {
            let bare = |e: InputError| match &e.file {
                Some(file) if file == Path::new("wall") => InputError { file: None, ..e },
                _ => e,
            };
            Failure::Input(all.into_iter().map(bare).collect())
        }
        other => other,
    }
}

/// What is wrong with arguments, in the words of keywords.
fn misused(error: &clap::Error) -> InputError {
    let word = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.clone()),
        Some(ContextValue::Strings(texts)) => Some(texts.join(", ")),
        _ => None,
    };
    let given = |kind| word(kind).map(|arg| keywords(&arg).join(" or "));
    let key = given(ContextKind::InvalidArg);
    let value = word(ContextKind::InvalidValue).filter(|value| !value.is_empty());
    let reason = std::error::Error::source(error).map(ToString::to_string);
    let text = error.to_string();
    let line = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_string();
    let what = match (error.kind(), value, reason) {
        (ErrorKind::MissingRequiredArgument, ..) => "is not given, and another argument that is given needs it".into(),
        (ErrorKind::ArgumentConflict, ..) => {
            format!("cannot be given with {}", given(ContextKind::PriorArg).unwrap_or_else(|| "another".into()))
        }
        (_, Some(value), Some(reason)) => format!("`{value}`: {reason}"),
        (_, Some(value), None) => format!("`{value}` is not allowed"),
        _ => line,
    };
    InputError { key, allowed: word(ContextKind::ValidValue), ..InputError::new(what) }
}

/// The keywords of the options that a word of the command line names, such as `<--record <FILE>|--shaken>`.
fn keywords(arg: &str) -> Vec<String> {
    let ends = |c: char| !c.is_ascii_alphanumeric() && c != '-';
    let options = arg.split("--").skip(1).map(|rest| rest.split(ends).next().unwrap_or_default());
    let names = options.map(|name| if name == "all" { "every".into() } else { name.replace('-', "_") });
    let mut names: Vec<String> = names.collect();
    names.dedup();
    names
}
