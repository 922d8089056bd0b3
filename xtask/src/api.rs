//! The pages of the engine's interface: rustdoc must have nothing to say against them.

use std::path::Path;

use crate::command::{Outcome, cargo};

/// Units in square brackets, which rustdoc takes for links: `/// Length [m].` It cannot be told otherwise, and
/// switching its check off would hide links that are really broken.
const UNITS: [&str; 15] = ["m", "m²", "m³", "mm", "rad", "Pa", "s", "N", "J", "W", "kg", "Hz", "bytes", "px", "pt"];

/// Makes the pages and fails on any warning but the one about units.
pub fn check(root: &Path) -> Outcome {
    let mut doc = cargo(root);
    // The whole workspace, as the lints have: for some packages alone, dependencies would have other features and be checked anew.
    doc.args(["doc", "--locked", "--release", "--workspace", "--lib", "--no-deps"]);
    let output = doc.output().map_err(|e| format!("cargo doc: {e}"))?;
    let text = String::from_utf8_lossy(&output.stderr);
    let said: Vec<&str> = text.split("\n\n").filter(|part| is_complaint(part)).collect();
    if !output.status.success() || !said.is_empty() {
        return Err(if said.is_empty() { text.into_owned() } else { said.join("\n\n") });
    }
    println!("{}", root.join("target/doc/concio/index.html").display());
    Ok(())
}

fn is_complaint(part: &str) -> bool {
    let complaints = part.lines().filter(|l| l.starts_with("warning: ") || l.starts_with("error: "));
    // Cargo's own line at the end counts what was shown before.
    let mut complaints = complaints.filter(|l| !l.contains("generated") && !l.contains("could not document"));
    complaints.any(|l| !UNITS.iter().any(|unit| l.ends_with(&format!("unresolved link to `{unit}`"))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_no_links_and_all_else_is_a_complaint() {
        assert!(!is_complaint("warning: unresolved link to `m`\n --> src/a.rs:1:1"));
        assert!(!is_complaint("warning: `concio` (lib doc) generated 127 warnings"));
        assert!(is_complaint("warning: unresolved link to `Model`\n --> src/a.rs:1:1"));
        assert!(is_complaint("warning: unresolved link to `mass`"));
        assert!(is_complaint("error: expected one of `;`"));
    }
}
