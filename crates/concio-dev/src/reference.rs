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
    section(&mut text, "concio", &mut command);
    let names: Vec<String> = command
        .get_subcommands()
        .filter(|c| !c.is_hide_set() && c.get_name() != "help")
        .map(|c| c.get_name().into())
        .collect();
    for name in names {
        if let Some(sub) = command.find_subcommand_mut(&name) {
            let mut sub = sub.clone().term_width(100);
            section(&mut text, &format!("concio {name}"), &mut sub);
        }
    }
    files::print(&text)
}

/// Prints the measures of a run as a table.
pub fn measures() -> Result<(), Failure> {
    let unit = |unit: &str| if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
    let line = |m: &Measure| format!("| `{}`{} | {} |\n", m.name, unit(m.unit), m.text.replace('|', "\\|"));
    let lines: String = MEASURES.iter().map(line).collect();
    files::print(&format!("| measure | is |\n|---|---|\n{lines}"))
}

fn section(text: &mut String, name: &str, command: &mut clap::Command) {
    let help = command.render_long_help().to_string();
    let help: Vec<&str> = help.lines().map(str::trim_end).collect();
    text.push_str(&format!("\n## {name}\n\n```text\n{}\n```\n", help.join("\n").trim_end()));
}
