//! Checks that what the documents point to is there: links between them, headings, and paths of the tree.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::command::Outcome;

/// Folders whose names at the start of a word in backticks make it a path of the tree.
const TREE: [&str; 7] = ["crates/", "docs/", "examples/", "peers/", "xtask/", "report-ui/", ".ci/"];

/// Checks every Markdown file of the project.
pub fn check(root: &Path) -> Outcome {
    let mut files = Vec::new();
    collect(root, &mut files)?;
    let mut wrong = Vec::new();
    let mut count = 0;
    for file in &files {
        let text = fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
        for target in targets(&text) {
            count += 1;
            if let Err(why) = check_link(file, &target) {
                wrong.push(format!("{}: ({target}) {why}", file.display()));
            }
        }
        for path in tree_paths(&text) {
            count += 1;
            if !root.join(&path).exists() {
                wrong.push(format!("{}: `{path}` is not there", file.display()));
            }
        }
    }
    println!("{count} links and paths in {} documents", files.len());
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Outcome {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for path in entries.filter_map(|e| e.ok().map(|e| e.path())) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let skipped = name.starts_with('.') || ["target", "concio-run", "node_modules"].contains(&name.as_str());
        if path.is_dir() && !skipped {
            collect(&path, files)?;
        } else if name.ends_with(".md") {
            files.push(path);
        }
    }
    Ok(())
}

/// Targets of `[text](target)` outside of code.
fn targets(text: &str) -> Vec<String> {
    let prose = without_code(text);
    let links = prose.split("](").skip(1).filter_map(|rest| rest.split([')', ' ', '\n']).next());
    links.map(str::to_string).collect()
}

/// A text with the targets of its links outside of code replaced.
pub fn relinked(text: &str, new: impl Fn(&str) -> Result<String, String>) -> Result<String, String> {
    let prose = |text: &str| -> Result<String, String> {
        let mut parts = text.split("](");
        let mut out = parts.next().unwrap_or_default().to_string();
        for part in parts {
            let end = part.find([')', ' ', '\n']).unwrap_or(part.len());
            out += "](";
            out += &new(&part[..end])?;
            out += &part[end..];
        }
        Ok(out)
    };
    // What stands between two marks of code is prose at even places.
    let outside = |text: &str, mark: &str, change: &dyn Fn(&str) -> Result<String, String>| {
        let parts = text.split(mark).enumerate();
        let parts: Result<Vec<_>, _> = parts.map(|(i, p)| if i % 2 == 0 { change(p) } else { Ok(p.into()) }).collect();
        parts.map(|parts| parts.join(mark))
    };
    outside(text, "```", &|part| outside(part, "`", &prose))
}

/// Words in backticks that start like a path of the tree and hold no placeholder.
fn tree_paths(text: &str) -> BTreeSet<String> {
    let fenced = text.split("```").step_by(2).collect::<String>();
    let words = fenced.split('`').skip(1).step_by(2).flat_map(str::split_whitespace);
    let is_path = |w: &&str| TREE.iter().any(|t| w.starts_with(t)) && !w.contains(['*', '{', '<', 'N']);
    words.filter(is_path).map(|w| w.trim_end_matches([',', '.', ';']).to_string()).collect()
}

fn without_code(text: &str) -> String {
    text.split("```").step_by(2).map(|part| part.split('`').step_by(2).collect::<String>()).collect()
}

fn check_link(file: &Path, target: &str) -> Result<(), &'static str> {
    if target.starts_with("http://") || target.starts_with("https://") || target.starts_with("mailto:") {
        return Ok(());
    }
    let (path, heading) = target.split_once('#').unwrap_or((target, ""));
    let folder = file.parent().unwrap_or(Path::new("."));
    let path = if path.is_empty() { file.to_path_buf() } else { folder.join(path) };
    if !path.exists() {
        return Err("is not there");
    }
    if heading.is_empty() {
        return Ok(());
    }
    let text = fs::read_to_string(&path).map_err(|_| "cannot be read")?;
    let found = text.lines().filter(|l| l.starts_with('#')).any(|l| slug(l.trim_start_matches('#')) == heading);
    if found { Ok(()) } else { Err("has no such heading") }
}

/// The anchor that Markdown renderers give a heading.
fn slug(heading: &str) -> String {
    let kept = heading.trim().to_lowercase();
    let kept = kept.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_in_prose_are_found_and_those_in_code_are_not() {
        let text = "See [a](docs/a.md#part) and `[b](c)`.\n```\n[d](e)\n```\n[f](g.md)";
        assert_eq!(targets(text), ["docs/a.md#part", "g.md"]);
    }

    #[test]
    fn links_in_prose_are_replaced_and_those_in_code_are_not() {
        let text = "See [a](a.md#part), [`x`](b.md) and `[b](c)`.\n```\n[d](e)\n```\n![f](g.svg)";
        let new = relinked(text, |target| Ok(format!("new/{target}")));
        let wanted = "See [a](new/a.md#part), [`x`](new/b.md) and `[b](c)`.\n```\n[d](e)\n```\n![f](new/g.svg)";
        assert_eq!(new, Ok(wanted.into()));
        assert_eq!(relinked(text, |target| Err(target.into())), Err("a.md#part".into()));
    }

    #[test]
    fn headings_become_anchors() {
        assert_eq!(slug(" The HDF5 file"), "the-hdf5-file");
        assert_eq!(slug(" Joints: kinds, laws"), "joints-kinds-laws");
    }

    #[test]
    fn missing_targets_are_told() {
        assert_eq!(check_link(Path::new("README.md"), "no/such.md"), Err("is not there"));
        assert_eq!(check_link(Path::new("README.md"), "https://example.org"), Ok(()));
    }
}
