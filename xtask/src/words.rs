//! How many words the documents have, and how long their sentences are.

use std::fs;
use std::path::Path;

use crate::command::Outcome;

/// Words of a sentence in the mean at most, over each of these.
const MOST: f64 = 22.0;
/// The documents whose sentences are held to that.
const HELD: [&str; 3] = ["README.md", "ARCHITECTURE.md", "docs/guide"];

/// Prints the count, and fails where sentences are too long in the mean.
pub fn check(root: &Path) -> Outcome {
    for name in HELD.iter().chain(&["docs"]) {
        let mut texts = Vec::new();
        collect(&root.join(name), &mut texts)?;
        let lengths: Vec<usize> = texts.iter().flat_map(|text| sentences(text)).collect();
        let words: usize = texts.iter().map(|text| text.split_whitespace().count()).sum();
        let mean = lengths.iter().sum::<usize>() as f64 / lengths.len().max(1) as f64;
        println!("{name}: {words} words; {} sentences of {mean:.1} words in the mean", lengths.len());
        if HELD.contains(name) && !(mean <= MOST) {
            return Err(format!("{name}: sentences have {mean:.1} words in the mean, at most {MOST}"));
        }
    }
    Ok(())
}

/// The text of a document, or of all in a folder.
fn collect(path: &Path, texts: &mut Vec<String>) -> Outcome {
    let wrong = |e: std::io::Error| format!("{}: {e}", path.display());
    if path.is_dir() {
        let mut entries: Vec<_> = fs::read_dir(path).map_err(wrong)?.filter_map(|e| e.ok().map(|e| e.path())).collect();
        entries.sort();
        return entries
            .iter()
            .filter(|p| p.is_dir() || p.extension().is_some_and(|e| e == "md"))
            .try_for_each(|p| collect(p, texts));
    }
    texts.push(fs::read_to_string(path).map_err(wrong)?);
    Ok(())
}

/// Words in each sentence of the prose: code, tables, headings and equations left out; of two words or fewer none is one.
fn sentences(text: &str) -> Vec<usize> {
    let prose: String = text.split("```").step_by(2).collect();
    let mut lengths = Vec::new();
    let mut count = 0;
    let mut end = |count: &mut usize| {
        let words = std::mem::take(count);
        if words > 2 {
            lengths.push(words);
        }
    };
    for line in prose.lines() {
        let begins = line.trim_start();
        let apart = begins.is_empty() || line.starts_with("    ") || begins.starts_with(['#', '|', '!', '<']);
        if apart || begins.starts_with("- ") {
            end(&mut count);
        }
        if apart {
            continue;
        }
        for word in begins.split_whitespace().filter(|word| word.contains(char::is_alphanumeric)) {
            count += 1;
            if word.trim_end_matches(['*', ')', '"', '`']).ends_with(['.', '!', '?']) {
                end(&mut count);
            }
        }
    }
    end(&mut count);
    lengths
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_end_at_points_lists_and_tables() {
        let text = "# A heading of five words\n\nOne thought here. Two more\nwords follow. Three of them.\n- an item of five words\n\n| a | b |\n```\nno words of code\n```\nThe end is near";
        assert_eq!(sentences(text), [3, 4, 3, 5, 4]);
    }
}
