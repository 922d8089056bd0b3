//! Concio: the in-plane earthquake response of block masonry.
//!
//! Main path: [`case`] → [`pattern`] → [`graph`] → [`model`] → [`simulate`] → [`outcome`].

pub mod case;
pub mod error;
pub mod ground;
pub mod outcome;
pub mod quantity;
pub mod record;
pub mod wall;

pub use error::{Error, InputError, Result};

/// Acceleration of gravity [m/s²] (model, head).
pub const G: f64 = 9.81;
