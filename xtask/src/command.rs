//! Running programs.

use std::path::Path;
use std::process::Command;
use std::sync::Mutex;

/// What a chore comes to: nothing, or why it failed.
pub type Outcome = Result<(), String>;

/// Checks that this machine could not make.
static SKIPPED: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Says of a check that it cannot be made here, and counts it.
pub fn skip(what: &str) {
    println!("skipped: {what}");
    SKIPPED.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(what.to_string());
}

/// Those that were said to be so far.
pub fn skipped() -> Vec<String> {
    SKIPPED.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).clone()
}

/// Cargo in the root of the repository.
pub fn cargo(root: &Path) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root);
    command
}

/// Runs a program, its output shown; fails when the program does.
pub fn run(command: &mut Command) -> Outcome {
    let status = command.status().map_err(|e| format!("{}: {e}", shown(command)))?;
    if status.success() { Ok(()) } else { Err(format!("{} failed ({status})", shown(command))) }
}

/// Runs a program and gives back what it printed.
pub fn read(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|e| format!("{}: {e}", shown(command)))?;
    if !output.status.success() {
        let errors = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{} failed ({}):\n{errors}", shown(command), output.status));
    }
    String::from_utf8(output.stdout).map_err(|e| format!("{}: {e}", shown(command)))
}

fn shown(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(|w| w.to_string_lossy()).collect::<Vec<_>>().join(" ")
}
