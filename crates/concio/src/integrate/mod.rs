//! One step of a scheme, its error estimate, and the linear algebra behind it.

pub(crate) mod bonds;
mod conjugate;
pub(crate) mod cracks;
pub(crate) mod dense;
mod dense_columns;
pub(crate) mod devices;
pub(crate) mod events;
pub(crate) mod flips;
mod fronts;
pub(crate) mod groups;
pub(crate) mod impact;
pub(crate) mod joints;
pub(crate) mod linear;
mod order;
pub(crate) mod stage;
pub(crate) mod step;
pub(crate) mod tableau;
