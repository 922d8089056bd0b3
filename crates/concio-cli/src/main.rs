//! The `concio` command: arguments in, files and tables out. The mechanics are in the `concio` crate.

use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser};

mod args;
mod cases;
mod commands;
mod digest;
mod draw;
mod failure;
mod figures;
mod files;
mod format;
mod motion;
mod progress;
mod report;
mod stop;
mod study;

fn main() -> ExitCode {
    let cli = args::Cli::try_parse().unwrap_or_else(|error| suggesting(error).exit());
    match commands::dispatch(cli.command) {
        Ok(code) => code,
        Err(failure) => failure.show(),
    }
}

/// Adds the option that was meant to an error about an unknown one. The parser's own measure finds none for letters
/// that changed places in a short word.
fn suggesting(mut error: clap::Error) -> clap::Error {
    if error.kind() != ErrorKind::UnknownArgument || error.get(ContextKind::SuggestedArg).is_some() {
        return error;
    }
    let Some(ContextValue::String(given)) = error.get(ContextKind::InvalidArg) else { return error };
    let word = given.trim_start_matches('-').to_string();
    let command = args::Cli::command();
    let used = std::env::args().skip(1).find_map(|a| command.find_subcommand(a).cloned());
    let options = used.iter().flat_map(|c| c.get_arguments()).filter_map(|a| a.get_long());
    let near = options.map(|o| (strsim::damerau_levenshtein(&word, o), o)).min();
    if let Some((_, option)) = near.filter(|(mistyped, _)| *mistyped <= 1 && word.len() > 1) {
        error.insert(ContextKind::SuggestedArg, ContextValue::String(format!("--{option}")));
    }
    error
}
