//! The `concio` command: arguments in, files and tables out. The mechanics are in the `concio` crate.

use std::process::ExitCode;

use clap::Parser;

mod args;
mod commands;
mod digest;
mod draw;
mod failure;
mod files;
mod format;
mod progress;
mod report;
mod stop;

fn main() -> ExitCode {
    match commands::dispatch(args::Cli::parse().command) {
        Ok(code) => code,
        Err(failure) => failure.show(),
    }
}
