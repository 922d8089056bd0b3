//! What `concio study` writes beside tables: figures and one page, made of sections that every analysis brings.

pub mod bars;
pub mod choices;
pub mod ida;
pub mod page;
pub mod sections;
pub mod sensitivity;

pub use page::write;
