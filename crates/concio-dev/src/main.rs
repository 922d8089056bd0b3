//! The `concio-dev` command: what only the project itself needs of the program. Its chores call it.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueHint};
use concio_cli::failure::Failure;

mod cases;
mod chart;
mod reference;

/// What only the project itself needs of Concio's program.
#[derive(Debug, Parser)]
#[command(version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Cases(Cases),
    /// Print the reference of the command line as Markdown.
    Reference {
        /// Print the table of the measures of a run instead.
        #[arg(long)]
        measures: bool,
    },
    /// Write the man pages of the command and of all below it.
    Man {
        /// Folder of the pages; it is made if need be.
        folder: PathBuf,
    },
    /// Print a diagram of measured points as SVG (docs/performance.md).
    Chart {
        /// Title, labels of the axes and series of points, as JSON.
        file: PathBuf,
    },
}

/// Run the cases of the research report and answer its findings.
///
/// The five cases of the research report's parametric analyses (its Figures 22 to 27) are built in; their wall files are those of
/// examples/report. Each is run under several settings of what the research report does not print, and each again with changes too
/// small to mean anything, because stick-slip makes single trajectories chaotic. Every finding of the research report is answered
/// yes or no with the numbers that decide; docs/report-cases.md explains them.
///
/// Writes a folder per case as `concio run` does, findings.json and findings.md. What is done is not done again: after
/// Ctrl-C or a kill the same command goes on.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  concio-dev cases
  concio-dev cases --figures --out report-cases")]
pub struct Cases {
    /// Folder of the results.
    #[arg(short, long, value_name = "DIR", default_value = "concio-run/report-cases", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
    /// Draw what the research report's Figures 22 to 27 show, as SVG in DIR/figures.
    #[arg(long)]
    pub figures: bool,
    /// Print the tables of a findings.json as Markdown and run nothing.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = ["out", "figures"])]
    pub tables: Option<PathBuf>,
}

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Cases(args) => cases::command::cases(&args),
        Command::Reference { measures: false } => ended(reference::reference()),
        Command::Reference { measures: true } => ended(reference::measures()),
        Command::Man { folder } => ended(reference::man(&folder)),
        Command::Chart { file } => ended(chart::chart(&file)),
    };
    done.unwrap_or_else(|failure| failure.show())
}

fn ended(done: Result<(), Failure>) -> Result<ExitCode, Failure> {
    done.map(|()| ExitCode::SUCCESS)
}
