//! Rigid blocks that slide, open and rock: a horizontal, a vertical and an angular unknown each.
//!
//! Main path: [`motion`] takes [`body`]s through time, with the contact points of [`shape`], the laws of [`joint`]s and [`tie`]s, the
//! contacts of [`contact`], their [`solver`] with its interior point method, the sparse matrix of [`blocks`] and the order of its elimination. What a wall is, and its files, are the
//! engine's matter.

pub mod blocks;
pub mod body;
pub mod contact;
pub mod crack;
mod fibres;
mod interior;
pub mod joint;
pub mod motion;
mod order;
pub mod shape;
pub mod solver;
pub mod tie;
mod zone;

/// Acceleration of gravity [m/s²].
pub const G: f64 = 9.81;
