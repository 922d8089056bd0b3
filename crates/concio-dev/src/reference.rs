//! The reference of the command line as Markdown (docs/cli.md), made from the same text as `--help`.

use clap::CommandFactory;
use concio_study::measures::{MEASURES, Measure};

use concio_cli::args::Cli;
use concio_cli::failure::Failure;
use concio_cli::files;

/// Prints the reference.
pub fn reference() -> Result<(), Failure> {
    let mut text = String::from(
        "# Command line\n\nMade from the program by `cargo xtask docs`; `concio COMMAND --help` prints the same.\n",
    );
    // The width of the terminal must not show in a file.
    let mut command = Cli::command().term_width(100);
    command.build();
    sections(&mut text, "concio", &command);
    files::print(&text)
}

/// Prints the measures of a run as a table.
pub fn measures() -> Result<(), Failure> {
    let unit = |unit: &str| if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
    let line = |m: &Measure| format!("| `{}`{} | {} |\n", m.name, unit(m.unit), m.text.replace('|', "\\|"));
    let lines: String = MEASURES.iter().map(line).collect();
    files::print(&format!("| measure | is |\n|---|---|\n{lines}"))
}

/// Of a command and all below it.
fn sections(text: &mut String, name: &str, command: &clap::Command) {
    section(text, name, command);
    for sub in command.get_subcommands().filter(|c| !c.is_hide_set() && c.get_name() != "help") {
        sections(text, &format!("{name} {}", sub.get_name()), sub);
    }
}

fn section(text: &mut String, name: &str, command: &clap::Command) {
    let help = command.clone().term_width(100).render_long_help().to_string();
    let help: Vec<&str> = help.lines().map(str::trim_end).collect();
    text.push_str(&format!("\n## {name}\n\n```text\n{}\n```\n", help.join("\n").trim_end()));
}
