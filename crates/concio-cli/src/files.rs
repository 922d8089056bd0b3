//! Files and streams that are written whole or not at all. All that goes to a terminal goes through here or
//! [`crate::failure`]: text of files (titles, names, lines of records) must not command it.

use std::cell::RefCell;
use std::fmt::Write as _;
use std::io::{self, ErrorKind, Write};
use std::path::Path;

use concio::{InputError, files};

use crate::failure::Failure;
use crate::format::{commands, line, plain_text};

thread_local! {
    /// What the user would be told, where nothing is printed.
    static KEPT: RefCell<Option<Vec<String>>> = const { RefCell::new(None) };
}

/// Does work of which a program wants the files and not the lines on the terminal: this thread prints none meanwhile. Returns what the user would
/// be told on standard error too, line by line.
pub fn silently<T>(work: impl FnOnce() -> T) -> (T, Vec<String>) {
    struct Before(Option<Vec<String>>);
    impl Drop for Before {
        fn drop(&mut self) {
            KEPT.replace(self.0.take());
        }
    }
    let _before = Before(KEPT.replace(Some(Vec::new())));
    let done = work();
    (done, KEPT.take().unwrap_or_default())
}

/// Prints to standard output.
pub fn print(text: &str) -> Result<(), Failure> {
    write_out(&plain_text(text))
}

/// Prints a text of JSON: characters that a terminal would obey are escaped, so that programs read what files say.
pub fn print_json(json: &str) -> Result<(), Failure> {
    let mut text = String::with_capacity(json.len());
    for c in json.chars() {
        match commands(c) {
            // None of them needs a surrogate, and JSON has them in texts alone.
            true => drop(write!(text, "\\u{:04x}", u32::from(c))),
            false => text.push(c),
        }
    }
    write_out(&text)
}

/// Writes a text as it is.
pub fn write_out(text: &str) -> Result<(), Failure> {
    if KEPT.with_borrow(Option::is_some) {
        return Ok(());
    }
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        Err(e) if e.kind() == ErrorKind::BrokenPipe => Err(Failure::ReaderGone),
        Err(e) => Err(Failure::Other(format!("standard output: {e}"), None)),
    }
}

/// Tells the user something in one line on standard error, which may be closed.
pub fn note(text: &str) {
    let kept = KEPT.with_borrow_mut(|kept| kept.as_mut().map(|kept| kept.push(line(text).into_owned())));
    if kept.is_none() {
        let _ = writeln!(io::stderr().lock(), "{}", line(text));
    }
}

/// Writes a file whole or not at all.
pub fn write(path: &Path, content: &(impl AsRef<[u8]> + ?Sized)) -> Result<(), Failure> {
    Ok(files::replace_bytes(path, content.as_ref())?)
}

/// Refuses an output in a folder that does not exist.
fn in_a_folder(out: &Path) -> Result<(), Failure> {
    let Some(folder) = out.parent().filter(|p| !p.as_os_str().is_empty() && !p.exists()) else { return Ok(()) };
    let error = InputError::new(format!("the folder {} does not exist", folder.display())).in_file(out);
    Err(error.help("make it first, or give another name").into())
}

/// Refuses an output that would replace one of the user's own files: an input of the same command, or any file that
/// does not bear the ending of what is written; and a folder that does not exist. To be called before the work is done.
pub fn guard(out: &Path, ending: &str, inputs: &[&Path]) -> Result<(), Failure> {
    in_a_folder(out)?;
    let Ok(target) = out.canonicalize() else { return Ok(()) };
    let refuse = |what: String| {
        let error = InputError::new(what).in_file(out);
        Err(error.help(format!("give another name, ending in .{ending}")).into())
    };
    if inputs.iter().any(|input| input.canonicalize().is_ok_and(|input| input == target)) {
        return refuse("the output would overwrite the input".into());
    }
    if target.is_dir() {
        return refuse("the output is a folder".into());
    }
    if !out.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending)) {
        return refuse(format!("the file exists, and only a file ending in .{ending} is replaced"));
    }
    Ok(())
}

/// As [`write`], but a file of that name is an error.
pub fn write_new(path: &Path, text: &str) -> Result<(), Failure> {
    in_a_folder(path)?;
    if files::create_bytes(path, text.as_bytes())? {
        return Ok(());
    }
    let error = InputError::new("the file exists and is not overwritten").in_file(path);
    Err(error.help("give another name, or remove it first").into())
}
