//! Record files of every format, written to order.

pub mod fixtures;
pub mod writers;
