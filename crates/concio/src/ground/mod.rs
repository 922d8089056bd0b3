//! Ground motion: record files of the archives, their processing and measures, synthetic accelerograms, and the
//! motion that the time integration asks for its value at any instant.
//!
//! Path of a record: [`record::read`] → [`process::prepare`] → [`measures`], or → [`signal::compile`]. Runs that share
//! records get them from a [`Library`].

pub mod coverage;
pub mod library;
pub mod measures;
pub mod process;
pub mod record;
pub mod signal;
pub mod synthetic;

mod cosmos_v2;
mod csmip_v2;
mod itaca_asc;
mod peer_at2;
mod pieces;
mod source;
mod spectrum;
mod spline;
mod text;
mod units;
mod usgs_smc;

pub use library::Library;
pub use measures::{Measures, Peak, measure};
pub use record::{Format, Record, TextOptions};
pub use signal::{GroundMotion, Kinematics, Segment, compile};
pub use spectrum::{Spectrum, response_spectrum};
pub use units::STANDARD_GRAVITY;
