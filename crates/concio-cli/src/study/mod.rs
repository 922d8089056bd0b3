//! What `concio study` writes beside tables: figures and one page, made of sections that every analysis brings.

pub mod asked;
pub mod bars;
pub mod choices;
pub mod crack_map;
pub mod cracks;
pub mod first_crack;
pub mod ida;
pub mod interfaces;
pub mod interval_bars;
pub mod page;
pub mod ranking;
pub mod sections;
pub mod sensitivity;
pub mod wall_map;

pub use page::write;
