//! The numbers of equations: what the code cites stands in docs/theory.md, and what stands there the code cites.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::command::Outcome;

/// The page of the equations, from the root.
pub const THEORY: &str = "docs/theory.md";

/// Checks both directions over the engine's sources.
pub fn check(root: &Path) -> Outcome {
    let theory = fs::read_to_string(root.join(THEORY)).map_err(|e| format!("{THEORY}: {e}"))?;
    let known = defined(&theory);
    let (mut cited, mut wrong) = (BTreeSet::new(), Vec::new());
    let mut files = Vec::new();
    for package in ["concio", "concio-law", "concio-shear"] {
        sources(&root.join("crates").join(package).join("src"), &mut files)?;
    }
    for (name, text) in &files {
        // A file may number an equation of its own, which then means nothing outside of it.
        let own = own(text);
        for number in citations(text) {
            if known.contains(&number) {
                cited.insert(number);
            } else if !own.contains(&number) {
                wrong.push(format!("{name} cites ({number}), which is not in {THEORY}"));
            }
        }
    }
    wrong.extend(known.difference(&cited).map(|number| format!("({number}) of {THEORY} is cited by no source")));
    println!("{} equations in {THEORY}, all cited", known.len());
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

/// Numbers that start an indented line: `    (6) μ(v) = …`.
pub fn defined(theory: &str) -> BTreeSet<String> {
    theory.lines().filter_map(|l| l.strip_prefix("    (")).filter_map(number).collect()
}

fn own(source: &str) -> BTreeSet<String> {
    let comments = source.lines().filter_map(|l| l.trim_start().strip_prefix("//!"));
    comments.filter_map(|l| l.trim_start().strip_prefix('(')).filter_map(number).collect()
}

/// The number before the bracket that closes: a digit, or a capital and a digit.
fn number(text: &str) -> Option<String> {
    let (inside, _) = text.split_once(')')?;
    let digits = inside.strip_prefix(|c: char| c.is_ascii_uppercase()).unwrap_or(inside);
    let is_number =
        (1..=2).contains(&digits.len()) && !digits.starts_with('0') && digits.bytes().all(|b| b.is_ascii_digit());
    is_number.then(|| inside.to_string())
}

/// Numbers in comments, set off by a blank from the word before: `f(1)` is code, ` (1)` an equation.
fn citations(source: &str) -> Vec<String> {
    let comments = source.lines().filter_map(|l| l.split_once("//").map(|(_, comment)| comment));
    let parts = comments.flat_map(|c| c.split([' ', '`']).filter_map(|w| w.strip_prefix('(')));
    parts.filter_map(number).collect()
}

fn sources(folder: &Path, files: &mut Vec<(String, String)>) -> Outcome {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for path in entries.filter_map(|e| e.ok().map(|e| e.path())) {
        if path.is_dir() {
            sources(&path, files)?;
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            files.push((path.display().to_string(), text));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_are_found_where_they_stand() {
        let theory = "text (9)\n\n    (6) μ(v)\n    (S1)  Y\n    more (5)\n";
        assert_eq!(defined(theory), ["6", "S1"].map(String::from).into());
        assert_eq!(own("//! (S1)  a = b\n//! cites (2)\n"), ["S1".to_string()].into());
    }

    #[test]
    fn citations_are_those_of_comments() {
        let source = "/// Law (6), after (S1).\nlet a = f (3);\n// f(4) and (see) (12) and (a1)\nlet x = 1; // (5)\n";
        assert_eq!(citations(source), ["6", "S1", "12", "5"]);
    }
}
