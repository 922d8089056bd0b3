//! docs/performance.md: text by hand around tables made from docs/performance.json.

use std::fs;
use std::path::Path;

use super::{DATA, diagrams, measure, tables};
use crate::command::Outcome;

const PAGE: &str = "docs/performance.md";
const BETWEEN: [&str; 2] = ["<!-- tables: made by cargo xtask performance -->\n", "<!-- end of tables -->\n"];

/// Paths and contents of the page and its diagrams, as the measurements make them.
pub fn with_tables(root: &Path) -> Result<Vec<(String, String)>, String> {
    let all = measure::load(&root.join(DATA))?;
    let text = fs::read_to_string(root.join(PAGE)).map_err(|e| format!("{PAGE}: {e}"))?;
    let parts = text.split_once(BETWEEN[0]).and_then(|(head, rest)| Some((head, rest.split_once(BETWEEN[1])?.1)));
    let (head, tail) = parts.ok_or_else(|| format!("{PAGE}: the lines around its tables are missing"))?;
    let page = [head, BETWEEN[0], "\n", &tables::all(&all), "\n", BETWEEN[1], tail].concat();
    let mut made = vec![(PAGE.to_string(), page)];
    let pictures = diagrams::drawn(root, &all)?;
    made.extend(pictures.into_iter().map(|(name, svg)| (format!("docs/img/performance/{name}"), svg)));
    Ok(made)
}

/// Writes the page.
pub fn write(root: &Path) -> Outcome {
    for (path, text) in with_tables(root)? {
        let file = root.join(&path);
        fs::write(&file, text).map_err(|e| format!("{}: {e}", file.display()))?;
        println!("{path}");
    }
    Ok(())
}
