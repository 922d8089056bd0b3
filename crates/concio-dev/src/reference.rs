//! The reference of the command line as Markdown (docs/cli.md) and as man pages, made from the same text as `--help`.

use std::fs;
use std::io;
use std::path::Path;

use clap::CommandFactory;
use clap_mangen::Man;
use concio::Error;
use concio_study::measures::{MEASURES, Measure};

use concio_cli::args::Cli;
use concio_cli::failure::Failure;
use concio_cli::files;

/// Prints the reference.
pub fn reference() -> Result<(), Failure> {
    let mut text = String::from(
        "# Command line\n\nMade from the program by `cargo xtask docs`; `concio COMMAND --help` prints the same. Every command has\n\
         `--help` and `--version`.\n",
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

/// Writes `concio.1`, `concio-run.1` and so on into a folder, which is made if need be.
pub fn man(folder: &Path) -> Result<(), Failure> {
    let failed = |source| Error::Io { path: folder.into(), source };
    fs::create_dir_all(folder).map_err(failed)?;
    pages().map_err(failed)?.iter().try_for_each(|(name, page)| files::write(&folder.join(name), page))
}

/// The man pages of the command and of all below it, with their names.
fn pages() -> io::Result<Vec<(String, String)>> {
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    let mut all = Vec::new();
    let mut left = vec![command];
    while let Some(command) = left.pop() {
        left.extend(command.get_subcommands().filter(|c| !c.is_hide_set()).cloned());
        let man = Man::new(command);
        all.push((man.get_filename(), page(&man)?));
    }
    Ok(all)
}

/// A page whose examples keep their lines: clap_mangen fills them as it fills prose.
fn page(man: &Man) -> io::Result<String> {
    let (mut page, mut extra) = (Vec::new(), Vec::new());
    man.render(&mut page)?;
    man.render_extra_section(&mut extra)?;
    let (page, extra) = (String::from_utf8_lossy(&page), String::from_utf8_lossy(&extra));
    let body = extra.split_once(EXTRA).map_or("", |(_, body)| body);
    Ok(page.replace(&format!("{EXTRA}{body}"), &format!(".SH EXAMPLES\n.nf\n{body}.fi\n")))
}

/// The heading that clap_mangen gives to what stands after the options.
const EXTRA: &str = ".SH EXTRA\n";

/// Of a command and all below it.
fn sections(text: &mut String, name: &str, command: &clap::Command) {
    section(text, name, command);
    for sub in command.get_subcommands().filter(|c| !c.is_hide_set() && c.get_name() != "help") {
        sections(text, &format!("{name} {}", sub.get_name()), sub);
    }
}

/// What every command has is told of the program alone.
const SHARED: [&str; 2] = ["help", "version"];

fn section(text: &mut String, name: &str, command: &clap::Command) {
    let mut command = command.clone().term_width(100);
    if command.get_name() != name {
        command = command.mut_args(|a| if SHARED.contains(&a.get_id().as_str()) { a.hide(true) } else { a });
    }
    let help = command.render_long_help().to_string();
    let help: Vec<&str> = help.lines().map(str::trim_end).collect();
    text.push_str(&format!("\n## {name}\n\n```text\n{}\n```\n", help.join("\n").trim_end()));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str) -> String {
        let page = pages().unwrap().into_iter().find(|(n, _)| n == name).map(|(_, page)| page);
        page.unwrap_or_else(|| panic!("{name} is not there"))
    }

    #[test]
    fn every_command_has_a_page() {
        let mut reference = String::new();
        let mut command = Cli::command();
        command.build();
        sections(&mut reference, "concio", &command);
        let mut commands: Vec<String> =
            reference.lines().filter_map(|l| l.strip_prefix("## ")).map(|c| c.replace(' ', "-") + ".1").collect();
        let mut pages: Vec<String> = pages().unwrap().into_iter().map(|(name, _)| name).collect();
        commands.sort();
        pages.sort();
        assert_eq!(pages, commands);
        assert!(pages.contains(&"concio-study-run.1".to_string()), "{pages:?}");
    }

    #[test]
    fn examples_keep_their_lines() {
        let page = named("concio.1");
        let (_, examples) = page.split_once(".SH EXAMPLES\n.nf\n").expect("it has examples");
        let (examples, _) = examples.split_once(".fi\n").expect("they end");
        assert!(examples.contains("\n  concio run wall.toml "), "{examples}");
        assert!(!page.contains("EXTRA"), "{page}");
    }
}
