//! `concio schema`.

use crate::failure::Failure;
use crate::files;

/// Prints the JSON Schema of the wall file.
pub fn schema() -> Result<(), Failure> {
    files::print_json(&format!("{:#}\n", concio::case::schema()))
}
