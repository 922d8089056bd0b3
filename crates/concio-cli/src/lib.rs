//! The `concio` command: arguments in, files and tables out. The mechanics are in the `concio` crate.
//!
//! A library only so that `concio-dev`, which the project's own chores call, draws and writes as it does: nothing here is stable.

use std::ffi::OsString;
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser};

#[doc(hidden)]
pub mod args;
#[doc(hidden)]
pub mod commands;
#[doc(hidden)]
pub mod digest;
#[doc(hidden)]
pub mod draw;
#[doc(hidden)]
pub mod failure;
#[doc(hidden)]
pub mod figures;
#[doc(hidden)]
pub mod files;
#[doc(hidden)]
pub mod format;
#[doc(hidden)]
pub mod mechanisms;
#[doc(hidden)]
pub mod motion;
#[doc(hidden)]
pub mod progress;
#[doc(hidden)]
pub mod report;
#[doc(hidden)]
pub mod stop;
#[doc(hidden)]
pub mod study;
#[doc(hidden)]
pub mod warned;

/// Does what the arguments of the process say.
pub fn run() -> ExitCode {
    run_with(std::env::args_os().collect())
}

/// Does what these arguments say, of which the first is the name of the program.
#[doc(hidden)]
pub fn run_with(arguments: Vec<OsString>) -> ExitCode {
    let cli = match args::Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        // Help is no failure.
        Err(_) => {
            let told = misused(&arguments);
            // A closed terminal leaves nothing to do but to exit with the right status.
            let _ = told.print();
            return ExitCode::from(u8::try_from(told.exit_code()).unwrap_or(failure::WRONG_INPUT));
        }
    };
    match commands::dispatch(cli.command) {
        Ok(code) => code,
        Err(failure) => failure.show(),
    }
}

/// What is told of the arguments: help, or what is wrong with them. They are quoted there, so that it is told of them as a
/// terminal can show them.
fn misused(arguments: &[OsString]) -> clap::Error {
    let shown = |argument: &OsString| format::line(&argument.to_string_lossy()).into_owned();
    let arguments: Vec<String> = arguments.iter().map(shown).collect();
    match args::Cli::try_parse_from(&arguments) {
        Err(error) => suggesting(error, arguments.get(1..).unwrap_or_default()),
        Ok(_) => {
            let what = "an argument is not valid UTF-8, or holds characters that cannot be shown";
            args::Cli::command().error(ErrorKind::InvalidValue, what)
        }
    }
}

/// Adds what was meant to an error about arguments.
fn suggesting(error: clap::Error, arguments: &[String]) -> clap::Error {
    match error.kind() {
        ErrorKind::UnknownArgument if error.get(ContextKind::SuggestedArg).is_none() => {
            suggesting_option(error, arguments)
        }
        ErrorKind::InvalidSubcommand => suggesting_run(error, arguments),
        _ => error,
    }
}

/// A file in the place of a command is to be run.
fn suggesting_run(mut error: clap::Error, arguments: &[String]) -> clap::Error {
    let Some(ContextValue::String(given)) = error.get(ContextKind::InvalidSubcommand) else { return error };
    let file = given.ends_with(".toml").then(|| given.clone());
    let before = arguments.iter().take_while(|a| Some(*a) != file.as_ref());
    let command = before.fold(String::from("concio"), |line, a| line + " " + a);
    if let Some(file) = file {
        let tip = format!("to run a file: `{command} run {file}`").into();
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
    }
    error
}

/// Adds the option that was meant to an error about an unknown one. The parser's own measure finds none for letters
/// that changed places in a short word.
fn suggesting_option(mut error: clap::Error, arguments: &[String]) -> clap::Error {
    let Some(ContextValue::String(given)) = error.get(ContextKind::InvalidArg) else { return error };
    let word = given.trim_start_matches('-').to_string();
    let command = args::Cli::command();
    let used = arguments.iter().find_map(|a| command.find_subcommand(a).cloned());
    let options = used.iter().flat_map(|c| c.get_arguments()).filter_map(|a| a.get_long());
    let near = options.map(|o| (strsim::damerau_levenshtein(&word, o), o)).min();
    if let Some((_, option)) = near.filter(|(mistyped, _)| *mistyped <= 1 && word.len() > 1) {
        error.insert(ContextKind::SuggestedArg, ContextValue::String(format!("--{option}")));
    }
    error
}
