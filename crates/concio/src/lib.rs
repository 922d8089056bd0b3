//! Concio: the in-plane earthquake response of block masonry.
//!
//! Main path: [`case`] → [`pattern`] → [`graph`] → [`model`] → [`simulate`] → [`outcome`].
//!
//! A wall is a text, or a file read by [`case::read`]; a run gives histories, peaks and energies in SI units:
//!
//! ```
//! use std::path::Path;
//!
//! use concio::case::{Syntax, from_str};
//! use concio::run::{prepare, run_in_memory};
//!
//! let wall = from_str(
//!     r#"
//!     model = "planar"
//!     [[panel]]
//!     bond = "stack"
//!     courses = 1
//!     bricks = 1
//!     brick = { length = "1 m", height = "0.4 m", thickness = "0.5 m", specific_weight = "20 kN/m3" }
//!     mortar = { bed = 0, head = 0 }
//!     [joint]
//!     bed = { law = "rigid" }
//!     head = { law = "none" }
//!     friction = { law = "coulomb", static = 0.3 }
//!     [motion]
//!     quasi_static = true
//!     base = { tilt = { acceleration = "0.5 g", rise = "5 s" } }
//!     duration = "5 s"
//!     "#,
//!     Syntax::Toml,
//!     None,
//! )?;
//! wall.validate()?;
//! let outcome = run_in_memory(&prepare(wall.case, Path::new("."))?)?;
//! // A block of 4 kN that slides on its base bears μ N.
//! assert!((outcome.totals.base_shear_peak / 1.2e3 - 1.0).abs() < 1e-2);
//! # Ok::<(), concio::Error>(())
//! ```

pub mod assign;
pub mod bond;
pub mod case;
mod channels;
pub mod constrained;
pub mod device;
pub mod dice;
pub mod drift;
pub mod error;
pub mod excitation;
pub mod failure;
pub mod files;
pub mod graph;
pub mod ground;
mod keeper;
pub mod law;
pub mod many;
pub mod model;
pub mod moment;
pub mod outcome;
pub mod pattern;
pub mod planar;
mod planar_run;
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

pub use error::{Error, InputError, Result};

/// Acceleration of gravity [m/s²] (theory).
pub const G: f64 = 9.81;
