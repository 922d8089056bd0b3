//! Makes the worked examples of docs/studies/ anew: runs what they were made by, puts its output and its figures back.
//!
//! A document says `<!-- made by: concio study run examples/studies/x.toml as x -->`; the block of console text that follows
//! becomes the output of that command (with its results in target/studies/x), and pictures named `img/x-FIGURE.svg` become
//! the figures that it drew. A page that shows pictures alone has no block after the mark.

use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::command::Outcome;
use crate::concio;

const MARK: &str = "<!-- made by: concio ";
const OPEN: &str = "```console\n";
const CLOSE: &str = "```\n";

/// Replaces output and pictures in all documents of docs/studies/, of one alone if it is named.
pub fn make(root: &Path, only: &[String]) -> Outcome {
    let folder = root.join("docs").join("studies");
    let entries = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut pages: Vec<_> = entries.filter_map(Result::ok).map(|e| e.path()).collect();
    pages.retain(|p| p.extension().is_some_and(|e| e == "md"));
    pages.retain(|p| only.is_empty() || only.iter().any(|o| p.file_stem().is_some_and(|s| s == o.as_str())));
    pages.sort();
    if pages.is_empty() {
        return Err(format!("there is no such document in {}", folder.display()));
    }
    // Pages may share a study.
    let mut outputs = HashMap::new();
    pages.iter().try_for_each(|page| renew(root, page, &mut outputs))
}

fn renew(root: &Path, page: &Path, outputs: &mut HashMap<String, String>) -> Outcome {
    let wrong = |e: std::io::Error| format!("{}: {e}", page.display());
    let old = fs::read_to_string(page).map_err(wrong)?;
    let mut new = String::new();
    let mut rest = old.as_str();
    while let Some(start) = rest.find(MARK) {
        let (before, from_mark) = rest.split_at(start);
        let line = from_mark.lines().next().unwrap_or_default();
        let (command, name) = parts(line).ok_or_else(|| format!("{}: not understood: {line}", page.display()))?;
        let output = match outputs.get(&command) {
            Some(output) => output.clone(),
            None => output(root, &command, &name)?,
        };
        outputs.insert(command.clone(), output.clone());
        pictures(root, page, &old, &name)?;
        new.push_str(before);
        new.push_str(line);
        new.push('\n');
        let after = &from_mark[line.len() + 1..];
        rest = after;
        if let Some(block) = after.strip_prefix(OPEN) {
            let end =
                block.find(CLOSE).ok_or_else(|| format!("{}: no end of the block after {line}", page.display()))?;
            new.push_str(&format!("{OPEN}$ concio {command}\n{output}{CLOSE}"));
            rest = &block[end + CLOSE.len()..];
        }
    }
    new.push_str(rest);
    if new == old { Ok(()) } else { fs::write(page, new).map_err(wrong) }
}

/// The arguments of the command, and the name under which its results lie.
fn parts(line: &str) -> Option<(String, String)> {
    let inside = line.strip_prefix(MARK)?.strip_suffix(" -->")?;
    let (command, name) = inside.rsplit_once(" as ")?;
    Some((command.to_string(), name.to_string()))
}

fn output(root: &Path, command: &str, name: &str) -> Result<String, String> {
    let out = root.join("target").join("studies").join(name);
    if out.exists() {
        fs::remove_dir_all(&out).map_err(|e| format!("{}: {e}", out.display()))?;
    }
    println!("concio {command}");
    let mut concio = Command::new(concio(root));
    let output = concio.args(command.split_whitespace()).arg("--out").arg(&out).current_dir(root).output();
    let output = output.map_err(|e| format!("concio {command}: {e}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    if !output.status.success() {
        return Err(format!("concio {command}: {}\n{text}{}", output.status, String::from_utf8_lossy(&output.stderr)));
    }
    // Where the report lies is no result.
    Ok(text.lines().filter(|l| !l.starts_with("open ")).map(|l| format!("{l}\n")).collect())
}

/// Copies the figures that the page shows.
fn pictures(root: &Path, page: &Path, text: &str, name: &str) -> Outcome {
    let start = format!("(img/{name}-");
    for piece in text.split(&start).skip(1) {
        let Some((figure, _)) = piece.split_once(')') else { continue };
        let from = root.join("target").join("studies").join(name).join("figures").join(figure);
        let folder = page.with_file_name("img");
        fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let to = folder.join(format!("{name}-{figure}"));
        fs::copy(&from, &to).map_err(|e| format!("{} to {}: {e}", from.display(), to.display()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_names_command_and_folder() {
        let line = "<!-- made by: concio first-crack a.toml --records b as c -->";
        assert_eq!(parts(line), Some(("first-crack a.toml --records b".into(), "c".into())));
        assert_eq!(parts("<!-- made by: concio study run a.toml -->"), None);
    }
}
