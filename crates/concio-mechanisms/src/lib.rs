//! Mechanisms out of the plane of a wall.

pub mod rocking;
