//! The `concio` command.
fn main() {}
