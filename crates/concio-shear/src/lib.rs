//! The shear model of a wall: blocks slide in level planes, on joints with springs, dashpots, stick-slip friction, bonds that crack, devices and
//! rigid unilateral contact. [`system::System`] is what it integrates, [`run::Run`] integrates it; [`lanes`] does eight runs at once.

pub mod dynamics;
mod integrate;
pub mod lanes;
pub mod law;
pub mod run;
pub mod samples;
pub mod state;
pub mod system;
mod wide;

#[doc(hidden)]
pub use integrate::stage::{Part, Parts};
