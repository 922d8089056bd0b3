//! Studies: many runs of one wall, and what they answer together.
//!
//! Main path: [`mod@file`] (what the study file says) → [`factors`] (what varies) → [`design`] (which combinations) →
//! [`plan`] (the runs, each with its wall and its id) → [`runner`] (does those that the store does not have) →
//! [`store`] → [`table`]. Analyses over the runs: [`sensitivity`], [`ida`]; [`groups`] is the dimensionless form.
//!
//! A run is known by its id, the hash of everything its result depends on. The store keeps what was measured of each
//! run under its id, so nothing is ever run twice: a study that is taken up again, a shard, a search that asks for a
//! wall it has seen before all read the store first.

pub mod alike;
pub mod answer;
pub mod bench;
pub mod cma;
pub mod crack_lines;
pub mod design;
pub mod drive;
pub mod factors;
pub mod file;
pub mod first_crack;
pub mod groups;
pub mod ida;
pub mod intensity;
pub mod interfaces;
pub mod limits;
pub mod measures;
pub mod motions;
pub mod pareto;
pub mod placement;
pub mod plan;
mod questions;
pub mod ranking;
pub mod runner;
pub mod search;
pub mod sensitivity;
pub mod shaking;
mod statistics;
pub mod store;
pub mod table;
pub mod task;
pub mod values;
pub mod warned;

pub use file::StudyFile;
pub use plan::Plan;
pub use runner::Runner;
pub use task::Task;
