//! What every model of a wall shares: laws of joints, the motion that drives it, the account of a run.
//!
//! - [`friction`], [`bond`], [`device`]: forces as functions of relative displacement and velocity.
//! - [`motion`]: motions as smooth pieces.
//! - [`error`]: what is wrong with an input.
//! - [`account`], [`drift`]: energies, peaks, events and counters of a run, and how far its tops went.

pub mod account;
pub mod bond;
pub mod device;
pub mod drift;
pub mod elementary;
pub mod error;
pub mod friction;
pub mod motion;

/// Acceleration of gravity [m/s²] (theory).
pub const G: f64 = 9.81;
