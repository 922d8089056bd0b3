//! Concio: the in-plane earthquake response of block masonry.
//!
//! Main path: [`case`] → [`pattern`] → [`graph`] → [`model`] → [`simulate`] → [`outcome`].

pub mod assign;
pub mod bond;
pub mod case;
pub mod constrained;
pub mod device;
pub mod dice;
pub mod drift;
mod dynamics;
mod elementary;
pub mod error;
pub mod excitation;
pub mod files;
pub mod graph;
pub mod ground;
mod integrate;
mod lanes;
pub mod law;
pub mod many;
pub mod model;
pub mod moment;
pub mod outcome;
pub mod pattern;
pub mod planar;
mod polygon;
pub mod quantity;
pub mod record;
pub mod run;
pub mod samples;
pub mod simulate;
pub mod state;
pub mod store;
pub mod system;
pub mod wall;
pub mod warning;
mod wide;

pub use error::{Error, InputError, Result};
#[doc(hidden)]
pub use integrate::stage::{Part, Parts};

/// Acceleration of gravity [m/s²] (theory).
pub const G: f64 = 9.81;
