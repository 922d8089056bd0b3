//! Any text is either a wall file or an error with a place: no panic, no endless loop, no exhausted memory.
#![no_main]

use concio::case::{CaseFile, Syntax, canonical_json, from_str, validate::block_bound};
use libfuzzer_sys::fuzz_target;

/// Walls up to this size are laid.
const SMALL: usize = 2_000;

fuzz_target!(|text: &str| {
    for syntax in [Syntax::Toml, Syntax::Json] {
        match from_str(text, syntax, None) {
            Ok(file) => follow(&file),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
});

fn follow(file: &CaseFile) {
    for finding in file.findings() {
        assert!(finding.line.is_some() && finding.key.is_some(), "{finding}");
    }
    if file.validate().is_ok() {
        let json = canonical_json(&file.case);
        let again = from_str(&json, Syntax::Json, None).map(|f| f.case);
        assert_eq!(again.ok().as_ref(), Some(&file.case), "{json}");
    }
    let bound = file.case.panels.iter().map(block_bound).fold(0, usize::saturating_add);
    if bound <= SMALL
        && let Ok(wall) = file.wall()
    {
        assert!(wall.blocks.len() <= bound);
        assert!(wall.blocks.iter().all(|b| b.mass() > 0.0 && b.mass().is_finite()));
    }
}
