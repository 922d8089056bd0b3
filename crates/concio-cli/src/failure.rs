//! Errors as the user sees them, and the exit status that goes with them.

use std::fmt::Write as _;
use std::io;
use std::process::ExitCode;

use anstyle::{AnsiColor, Style};
use concio::files::{LARGEST_INPUT, read_input};
use concio::{Error, InputError};

use crate::format;

/// Exit status of a run that stopped early or a file that could not be written.
pub const STOPPED: u8 = 1;
/// Exit status of a wrong input.
pub const WRONG_INPUT: u8 = 2;

const RED: Style = AnsiColor::Red.on_default().bold();
const BLUE: Style = AnsiColor::Blue.on_default().bold();
const BOLD: Style = Style::new().bold();

/// Longest part of a line that an excerpt shows [characters].
const EXCERPT: usize = 100;
/// Longest part of a message [characters]: names of files may be of any length.
const MOST_SHOWN: usize = 4000;

/// Why a command ends without having done its work.
#[derive(Debug)]
pub enum Failure {
    /// Mistakes in the input, one or more.
    Input(Vec<InputError>),
    /// Something else went wrong, and what may mend it.
    Other(String, Option<&'static str>),
    /// Whoever read the output has gone, as `head` does: nothing to complain about.
    ReaderGone,
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Input(e) => Failure::Input(vec![*e]),
            // Named by its kind: the system's text may bear the name of a temporary file.
            Error::Io { path, source } => {
                let what = match source.kind() {
                    io::ErrorKind::Other => source.to_string(),
                    kind => kind.to_string(),
                };
                Failure::Other(format!("{}: {what}", path.display()), remedy(source.kind()))
            }
            other => Failure::Other(other.to_string(), None),
        }
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Failure::Input(vec![error])
    }
}

impl Failure {
    /// Prints the failure on standard error; its exit status.
    pub fn show(&self) -> ExitCode {
        // A closed standard error leaves nothing to do but to exit with the right status.
        let print = |text: &str| {
            let _ = io::Write::write_all(&mut anstream::stderr().lock(), text.as_bytes());
        };
        match self {
            Failure::Input(errors) => {
                print(&errors.iter().map(render).collect::<Vec<_>>().join("\n"));
                ExitCode::from(WRONG_INPUT)
            }
            Failure::Other(what, help) => {
                let what = shown(what);
                let help = help.map_or(String::new(), |help| format!("{BLUE}help{BLUE:#}: {help}\n"));
                print(&format!("{RED}error{RED:#}: {what}\n{help}"));
                ExitCode::from(STOPPED)
            }
            Failure::ReaderGone => ExitCode::SUCCESS,
        }
    }
}

/// What the user can do about a file that cannot be read or written.
fn remedy(kind: io::ErrorKind) -> Option<&'static str> {
    match kind {
        io::ErrorKind::NotFound => Some("make the folder first, or give another name"),
        io::ErrorKind::NotADirectory => Some("a part of the path is a file: give another name"),
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            Some("this place may not be written to: give another name")
        }
        io::ErrorKind::StorageFull => Some("the disk is full"),
        _ => None,
    }
}

/// A part of a message: one line that a terminal shows as it is, and no more of it than somebody reads.
fn shown(text: &str) -> String {
    let text = format::line(text);
    match text.char_indices().nth(MOST_SHOWN) {
        None => text.into_owned(),
        Some((end, _)) => format!("{}… ({} characters more)", &text[..end], text[end..].chars().count()),
    }
}

/// `error: FILE:LINE:COLUMN: key: what`, the line of the file with a caret, the allowed range, a hint. Colours are ours: what is
/// quoted of files must bring none.
fn render(error: &InputError) -> String {
    let mut text = format!("{RED}error{RED:#}: {BOLD}");
    if let Some(file) = &error.file {
        let _ = write!(text, "{}:", shown(&file.display().to_string()));
        for place in [error.line, error.column].into_iter().map_while(|n| n) {
            let _ = write!(text, "{place}:");
        }
        text.push(' ');
    }
    if let Some(key) = &error.key {
        let _ = write!(text, "{}: ", shown(key));
    }
    let _ = writeln!(text, "{}{BOLD:#}", shown(&error.what));
    text.push_str(&excerpt(error).unwrap_or_default());
    if let Some(allowed) = &error.allowed {
        let _ = writeln!(text, "{BLUE}allowed{BLUE:#}: {}", shown(allowed));
    }
    if let Some(help) = &error.help {
        let _ = writeln!(text, "{BLUE}help{BLUE:#}: {}", shown(help));
    }
    text
}

/// The line at fault. None when it cannot be shown; the message stands without it.
fn excerpt(error: &InputError) -> Option<String> {
    let number = error.line?;
    let bytes = read_input(error.file.as_ref()?, LARGEST_INPUT).ok()?;
    let line = bytes.split(|b| *b == b'\n').nth(number.checked_sub(1)?)?;
    // Tabs would shift the caret.
    let line: Vec<char> = format::line(String::from_utf8_lossy(line).trim_end()).chars().collect();
    let column = error.column.unwrap_or(1).saturating_sub(1).min(line.len());
    // Records have lines of thousands of characters: show the neighbourhood of the column.
    let from = column.saturating_sub(EXCERPT / 2).min(line.len().saturating_sub(EXCERPT));
    let shown: String = line.iter().skip(from).take(EXCERPT).collect();
    let width = number.to_string().len();
    let mut text = format!("{BLUE}{number:>width$} |{BLUE:#} {shown}\n");
    if error.column.is_some() {
        let _ = writeln!(text, "{BLUE}{:>width$} |{BLUE:#} {}{RED}^{RED:#}", "", " ".repeat(column - from));
    }
    Some(text)
}

/// The readers' hints name keys of a wall file; here they are options.
pub(crate) fn as_options(error: Error) -> Error {
    let Error::Input(mut error) = error else { return error };
    error.help = error.help.take().filter(|help| !help.contains("wall file")).map(|help| {
        help.replace("add `dt = \"0.005 s\"` to the input", "give --dt 0.005")
            .replace("give the interval (`dt`)", "give --dt")
            .replace("add `units = \"cm/s2\"` to the input", "give --units cm/s2")
            .replace("add `layout = \"rows\"` to the input", "give --layout rows")
            .replace("`layout = \"columns\"` in the input", "--layout columns")
            .replace("`layout = \"columns\"` in the same way", "--layout columns")
            .replace("set `quantity = \"acceleration\"`", "give --quantity acceleration")
            .replace("set `quantity = \"displacement\"`", "give --quantity displacement")
            .replace("leave `dt` out", "leave --dt out")
            .replace("leave `layout` out", "leave --layout out")
            .replace("leave `units` out", "leave --units out")
    });
    error.what = error.what.replace("s, the input ", "s, --dt ").replace("`, the input `", "`, --units `");
    Error::Input(error)
}
