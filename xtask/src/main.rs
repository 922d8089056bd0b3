//! Project chores: `cargo xtask ci` and the generated documents.
fn main() {}
