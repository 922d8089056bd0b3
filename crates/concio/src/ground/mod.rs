//! Ground motion: record files of the archives, their processing and measures, synthetic accelerograms, and the
//! motion that the time integration asks for its value at any instant.
//!
//! Path of a record: [`formats::read`] → [`process::prepare`] → [`measures`], or → [`signal::compile`]. Runs that share
//! records get them from a [`Library`].

pub mod channel;
pub mod coverage;
pub mod formats;
pub mod library;
pub mod measures;
pub mod process;
pub mod record;
pub mod signal;
pub mod synthetic;

mod cosmos;
mod csmip_v2;
mod cwb;
mod geonet;
mod itaca_asc;
mod knet;
mod knet_csv;
mod nsmn;
mod peer_at2;

mod remark;
mod resemblance;
mod source;
mod spectrum;
mod spline;
mod text;
mod unam_asa;
mod units;
mod usgs_smc;
mod volume_1;

pub use library::Library;
pub use measures::{Measures, Peak, measure};
pub use record::{Format, Record, Remark, TextOptions};
pub use signal::{GroundMotion, Kinematics, Segment, compile};
pub use source::MOST_SAMPLES;
pub use spectrum::{Spectrum, response_spectrum};
pub use units::STANDARD_GRAVITY;
