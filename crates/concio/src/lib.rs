//! Concio: the in-plane earthquake response of block masonry.
//!
//! ```
//! use concio::run::{prepare, run_in_memory};
//!
//! let wall = concio::case::example()?;                   // or case::read, case::from_str, CaseFile::of
//! let outcome = run_in_memory(&prepare(&wall)?)?;
//! assert!(outcome.totals.base_shear_peak > 5e3);         // N; everything is SI
//! # Ok::<(), concio::Error>(())
//! ```
//!
//! A run gives histories, peaks and energies ([`outcome`]). [`run::run`] writes them into a folder and resumes what was interrupted,
//! [`run::run_watched`] lets a monitor look on, [`many`] does many runs at once. Three programs to start from are in `crates/concio/examples`:
//! `run.rs`; `sweep.rs`, a wall built without a file; `own_motion.rs`, a motion of one's own.
//!
//! | what | where |
//! |---|---|
//! | wall files, and walls built in Rust | [`case`], [`quantity`], [`error`] |
//! | records, filters, spectra, motions | [`ground`], [`excitation`] |
//! | blocks and joints | [`pattern`], [`wall`], [`graph`] |
//! | which law each joint has | [`assign`], [`law`], [`bond`], [`device`] |
//! | the compiled wall | [`model`], [`planar`], [`rocking`], [`facade`] |
//! | steps | [`simulate`], [`state`]; mechanics in `concio_shear` and `concio_planar` |
//! | what a run gives | [`outcome`], [`record`], [`drift`], [`failure`], [`moment`] |
//! | from a file to a folder of results | [`run`], [`store`], [`warning`], [`files`] |
//! | many runs, other uses | [`many`], [`constrained`], [`system`], [`samples`], [`dice`] |
//!
//! A wall of a text:
//!
//! ```
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
//! let outcome = run_in_memory(&prepare(&wall)?)?;
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
pub mod facade;
pub mod failure;
pub mod files;
pub mod graph;
pub mod ground;
mod keeper;
pub mod law;
pub mod many;
mod mechanics;
pub mod model;
pub mod moment;
pub mod outcome;
pub mod pattern;
pub mod planar;
mod planar_run;
mod polygon;
pub mod quantity;
pub mod record;
pub mod rocking;
mod rocking_run;
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
pub use concio_law::G;
