//! One step of a scheme, its error estimate, and the linear algebra behind it.

mod fronts;
pub(crate) mod groups;
pub(crate) mod joints;
pub(crate) mod linear;
mod order;
pub(crate) mod stage;
pub(crate) mod step;
pub(crate) mod tableau;
