//! What `concio study` writes beside tables: figures and one page, made of sections that every analysis brings.

pub mod bars;
pub mod crack_map;
pub mod cracks;
pub mod first_crack;
pub mod page;
pub mod sections;

pub use page::write;
