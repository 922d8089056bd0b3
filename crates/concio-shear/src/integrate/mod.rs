//! One step of a scheme, its error estimate, and the linear algebra behind it.

pub mod bonds;
mod conjugate;
pub mod cracks;
pub mod dense;
mod dense_columns;
pub mod devices;
pub mod events;
pub mod flips;
mod fronts;
pub mod groups;
pub mod impact;
pub mod joints;
pub mod linear;
mod order;
mod pattern;
pub mod stage;
pub mod step;
pub mod sums;
pub mod tableau;
