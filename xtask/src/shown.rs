//! What documents show is tried: wall files are valid, commands can be typed and print what is quoted.
//!
//! A block of TOML with `model` and `[[panel]]` is a wall file and is checked; where it begins with `# wall.toml` it also is
//! the file of that name for the commands that follow. In a block marked `console` every line `$ concio …` is run in a
//! folder of the document's own and has to end with status 0, or with another one in a block marked `console fails`; the
//! lines below it have to come in the output, in this order. `…` stands for what is
//! left out: whole lines, or a part of one; but warnings are shown. Numbers that `concio run` prints are compared with a tolerance, because stick-slip
//! amplifies the last digit of a machine's exponential.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::Outcome;
use crate::concio;

/// The record that the guide uses, from the root.
pub const RECORD: &str = "docs/guide/quake.at2";

/// Documents with wall files and commands, from the root.
fn documents(root: &Path) -> Result<Vec<PathBuf>, String> {
    let own = [
        "README.md",
        "docs/wall-file.md",
        "docs/constrained.md",
        "docs/planar.md",
        "docs/limit-analysis.md",
        "docs/mechanisms.md",
        "docs/continuum.md",
    ];
    let mut documents = own.map(|name| root.join(name)).to_vec();
    for folder in ["docs/guide", "docs/howto"] {
        let folder = root.join(folder);
        let entries = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let mut found: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
        found.retain(|p| p.extension().is_some_and(|e| e == "md"));
        found.sort();
        documents.append(&mut found);
    }
    Ok(documents)
}

/// Tries all of them.
pub fn check(root: &Path) -> Outcome {
    let (mut walls, mut commands) = (0, 0);
    for document in documents(root)? {
        let text = fs::read_to_string(&document).map_err(|e| format!("{}: {e}", document.display()))?;
        let name = document.strip_prefix(root).unwrap_or(&document).display().to_string();
        let desk = desk(root, &name)?;
        for block in blocks(&text) {
            let tried = match block.language {
                "toml" if is_wall(block.text) => {
                    walls += 1;
                    wall(root, &desk, block.text)
                }
                "console" => session(root, &desk, block.text, false).map(|n| commands += n),
                "console fails" => session(root, &desk, block.text, true).map(|n| commands += n),
                _ => Ok(()),
            };
            tried.map_err(|why| format!("{name}, line {}: {why}", block.line))?;
        }
    }
    println!("{walls} wall files and {commands} commands shown in documents hold");
    if walls == 0 || commands == 0 { Err("the documents show no wall files or no commands".into()) } else { Ok(()) }
}

/// An empty folder with the guide's record in it.
fn desk(root: &Path, name: &str) -> Result<PathBuf, String> {
    let desk = root.join("target").join("shown").join(name.replace(['/', '.'], "-"));
    let fail = |e: std::io::Error| format!("{}: {e}", desk.display());
    if desk.exists() {
        fs::remove_dir_all(&desk).map_err(fail)?;
    }
    fs::create_dir_all(&desk).map_err(fail)?;
    fs::copy(root.join(RECORD), desk.join("quake.at2")).map_err(fail)?;
    Ok(desk)
}

struct Block<'a> {
    language: &'a str,
    /// Line of its first line, from 1.
    line: usize,
    text: &'a str,
}

fn blocks(text: &str) -> Vec<Block<'_>> {
    let mut blocks = Vec::new();
    let mut line = 1;
    for (k, part) in text.split("```").enumerate() {
        if k % 2 == 1
            && let Some((language, text)) = part.split_once('\n')
        {
            blocks.push(Block { language: language.trim(), line: line + 1, text });
        }
        line += part.matches('\n').count();
    }
    blocks
}

fn is_wall(text: &str) -> bool {
    ["model = ", "[[panel]]"].iter().all(|start| text.lines().any(|l| l.starts_with(start)))
}

fn wall(root: &Path, desk: &Path, text: &str) -> Outcome {
    let named = text.lines().next().and_then(|l| l.strip_prefix("# ")).filter(|n| n.ends_with(".toml"));
    let name = named.unwrap_or("shown.toml");
    fs::write(desk.join(name), text).map_err(|e| format!("{name}: {e}"))?;
    let (said, status) = type_in(root, desk, &format!("check {name}"))?;
    if status == Some(0) { Ok(()) } else { Err(format!("this wall file is wrong:\n{said}")) }
}

/// Runs the commands of a block; gives back how many there were.
fn session(root: &Path, desk: &Path, text: &str, fails: bool) -> Result<usize, String> {
    let mut count = 0;
    for part in format!("\n{text}").split("\n$ ").skip(1) {
        let (line, quoted) = part.split_once('\n').unwrap_or((part, ""));
        let line = line.split(" #").next().unwrap_or(line).trim();
        let Some(arguments) = line.strip_prefix("concio ") else { continue };
        let (said, status) = type_in(root, desk, arguments)?;
        if !expected(status, fails) {
            return Err(format!("`{line}` ends with status {status:?}:\n{said}"));
        }
        let is_still = |file: &str| fs::read_to_string(desk.join(file)).is_ok_and(|text| text.contains(STILL));
        let tolerance = tolerance(arguments, is_still);
        missing(&said, quoted, tolerance)
            .map_err(|lost| format!("`{line}` does not print `{lost}` (or not at this place), but:\n{said}"))?;
        if let Some(untold) = untold(&said, quoted) {
            return Err(format!("`{line}` warns, and the page does not show it: {untold}"));
        }
        count += 1;
    }
    Ok(count)
}

/// The first warning that the page does not quote, be it cut short: whoever types the command would not know what to make of it.
fn untold<'a>(said: &'a str, quoted: &str) -> Option<&'a str> {
    let told: Vec<&str> = quoted.lines().map(str::trim).filter_map(|l| l.strip_prefix("warning:")).collect();
    let starts =
        |line: &str| told.iter().any(|t| line["warning:".len()..].starts_with(t.split('…').next().unwrap_or(t)));
    said.lines().map(str::trim).find(|line| line.starts_with("warning:") && !starts(line))
}

/// A command that is ended by a signal has no status and is never expected.
fn expected(status: Option<i32>, fails: bool) -> bool {
    status.is_some_and(|s| (s != 0) == fails)
}

/// Runs a command in the folder of the document; examples are those of the project.
fn type_in(root: &Path, desk: &Path, arguments: &str) -> Result<(String, Option<i32>), String> {
    let mut command = Command::new(concio(root));
    let typed = |word: &str| if word.starts_with("examples/") { root.join(word) } else { PathBuf::from(word) };
    let output = command.args(arguments.split_whitespace().map(typed)).current_dir(desk).env("NO_COLOR", "1").output();
    let output = output.map_err(|e| format!("{}: {e}", concio(root).display()))?;
    let said = String::from_utf8_lossy(&output.stderr) + String::from_utf8_lossy(&output.stdout);
    Ok((said.into_owned(), output.status.code()))
}

/// Relative difference allowed between a number that a run prints and the one quoted: of shaken walls, and of those without inertia,
/// which no chance decides.
const RUN_TOLERANCE: f64 = 0.05;
const STILL_TOLERANCE: f64 = 0.005;

/// What wall files without inertia say.
const STILL: &str = "quasi_static = true";

/// That of a command by its arguments, of which a file may be still: what is no run prints the same everywhere.
fn tolerance(arguments: &str, is_still: impl Fn(&str) -> bool) -> f64 {
    match arguments.starts_with("run") {
        false => 0.0,
        true if arguments.split_whitespace().any(is_still) => STILL_TOLERANCE,
        true => RUN_TOLERANCE,
    }
}

/// Equal word by word, numbers up to `tolerance`.
fn alike(line: &str, quote: &str, tolerance: f64) -> bool {
    let [line, quote] = [line, quote].map(|t| t.split_whitespace().collect::<Vec<_>>());
    line.len() == quote.len() && line.iter().zip(&quote).all(|(a, b)| same_word(a, b, tolerance))
}

fn same_word(a: &str, b: &str, tolerance: f64) -> bool {
    let number = |word: &str| word.trim_end_matches([',', ':']).replace('−', "-").parse::<f64>().ok();
    match (number(a), number(b)) {
        (Some(x), Some(y)) if tolerance > 0.0 => (x - y).abs() <= tolerance * x.abs().max(y.abs()),
        _ => a == b,
    }
}

/// The first quoted line that `said` does not hold after those before it.
fn missing<'a>(said: &str, quoted: &'a str, tolerance: f64) -> Result<(), &'a str> {
    let mut lines = said.lines().map(str::trim);
    for quote in quoted.lines().map(str::trim).filter(|l| !l.is_empty() && *l != "…") {
        let matches = |line: &str| match quote.split_once('…') {
            Some((start, end)) => {
                let [words, start, end] = [line, start, end].map(|t| t.split_whitespace().collect::<Vec<_>>());
                let of = |from: usize, part: &[&str]| {
                    alike(&words[from..from + part.len()].join(" "), &part.join(" "), tolerance)
                };
                words.len() >= start.len() + end.len() && of(0, &start) && of(words.len() - end.len(), &end)
            }
            None => alike(line, quote, tolerance),
        };
        if !lines.any(matches) {
            return Err(quote);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_have_a_language_and_a_line() {
        let found = blocks("a\n```toml\nmodel = 1\n```\nb\n```console\n$ x\n```\n");
        let found: Vec<_> = found.iter().map(|b| (b.language, b.line, b.text)).collect();
        assert_eq!(found, [("toml", 3, "model = 1\n"), ("console", 7, "$ x\n")]);
    }

    #[test]
    fn commands_end_as_their_block_says() {
        assert!(expected(Some(0), false) && expected(Some(2), true));
        assert!(!expected(Some(1), false) && !expected(Some(0), true));
        assert!(!expected(None, false) && !expected(None, true));
        assert_eq!(blocks("```console fails\n$ x\n```\n")[0].language, "console fails");
    }

    #[test]
    fn warnings_have_to_be_shown() {
        let said = "warning: one of 3 m\nelse\n";
        assert_eq!(untold(said, "…\nelse\n"), Some("warning: one of 3 m"));
        assert_eq!(untold(said, "warning: two\n"), Some("warning: one of 3 m"));
        assert_eq!(untold(said, "warning: one …\nelse\n"), None);
        assert_eq!(untold("else\n", ""), None);
    }

    #[test]
    fn runs_without_inertia_are_held_closer_than_shaken_ones() {
        let of = |arguments: &str| tolerance(arguments, |file| file == "slow.toml");
        assert_eq!(
            [of("check slow.toml"), of("run slow.toml"), of("run shaken.toml")],
            [0.0, STILL_TOLERANCE, RUN_TOLERANCE]
        );
        // What a stale quote was off by.
        let [stale, now] = ["peak base shear 0.5476 of the load", "peak base shear 0.5160 of the load"];
        assert!(missing(now, stale, STILL_TOLERANCE).is_err() && missing(now, stale, RUN_TOLERANCE).is_err());
    }

    #[test]
    fn quotes_may_leave_out_but_not_invent() {
        let said = "one\n  two  3 s\nfour\n";
        assert_eq!(missing(said, "one\n…\nfour\n", 0.0), Ok(()));
        assert_eq!(missing(said, "two …\n", 0.0), Ok(()));
        assert_eq!(missing(said, "two … s\n", 0.0), Ok(()));
        assert_eq!(missing(said, "two … m\n", 0.0), Err("two … m"));
        assert_eq!(missing("a 1.02 m, of b at c", "a 1.00 m, … at c", 0.05), Ok(()));
        assert_eq!(missing("a 1.02 m, of b at c", "a 1.00 m, … at c", 0.01), Err("a 1.00 m, … at c"));
        assert_eq!(missing(said, "four\none\n", 0.0), Err("one"));
        assert_eq!(missing(said, "three\n", 0.0), Err("three"));
        assert_eq!(missing(said, "two 3.3 s\n", 0.2), Ok(()));
        assert_eq!(missing(said, "two 3.3 s\n", 0.05), Err("two 3.3 s"));
    }
}
