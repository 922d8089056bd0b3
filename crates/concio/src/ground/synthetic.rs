//! stub
use crate::{Result, case, ground::record::Record};
pub fn generate(_: &case::Synthetic) -> Result<Record> {
    todo!()
}
