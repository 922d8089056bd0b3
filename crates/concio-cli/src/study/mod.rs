//! What `concio study` writes beside tables: figures and one page, made of sections that every analysis brings.

pub mod page;
pub mod sections;

pub use page::write;
