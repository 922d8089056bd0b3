//! One file per command.

use std::process::ExitCode;

use concio::case::CaseFile;
use serde_json::Value;

use crate::args::Command;
use crate::failure::Failure;

mod check;
mod compare;
mod completions;
mod continuum;
mod export;
mod first_crack;
mod limit;
mod limit_behind;
mod limit_space;
mod mechanisms;
mod new;
mod plot;
pub mod record;
pub mod run;
mod scale;
mod schema;
pub mod study;
mod system;
pub mod wall_file;

/// What an analysis says of a wall that was read already.
pub struct Answer {
    /// What `--json` prints.
    pub value: Value,
    /// The mechanism as an SVG that a page can hold, where there is one.
    pub drawing: Option<String>,
}

/// The answer of an analysis; none of the other commands.
pub fn answer(command: &Command, file: &CaseFile) -> Result<Option<Answer>, Failure> {
    Ok(Some(match command {
        Command::Limit(args) if args.out_of_plane => limit_space::answer(args, file)?,
        Command::Limit(args) => limit::answer(args, file)?,
        Command::Continuum(args) => Answer { value: continuum::value(args, file)?, drawing: None },
        Command::Mechanisms(args) => mechanisms::answer(args, file)?,
        _ => return Ok(None),
    }))
}

/// Runs a command. Errors are shown by the caller.
pub fn dispatch(command: Command) -> Result<ExitCode, Failure> {
    match command {
        Command::Run(args) => return run::run(&args),
        Command::FirstCrack(args) => return first_crack::first_crack(&args),
        Command::Study(args) => return study::run_command(&args.what),
        Command::Limit(args) if args.out_of_plane => return limit_space::limit(&args),
        Command::Limit(args) => return limit::limit(&args),
        Command::Continuum(args) => continuum::continuum(&args),
        Command::Mechanisms(args) => mechanisms::mechanisms(&args),
        Command::Check(args) => check::check(&args),
        Command::Compare(args) => compare::compare(&args),
        Command::New(args) => new::new(&args),
        Command::Schema(_) => schema::schema(),
        Command::Record(args) => record::record(&args),
        Command::System(args) => system::system(&args),
        Command::Scale(args) => scale::scale(&args),
        Command::Export(args) => export::export(&args),
        Command::Plot(args) => plot::plot(&args),
        Command::Completions(args) => completions::completions(args.shell),
    }
    .map(|()| ExitCode::SUCCESS)
}
