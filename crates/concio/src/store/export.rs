//! Copies of a result in other formats: CSV for spreadsheets, NPZ for NumPy, a VTKHDF file for ParaView.

use std::path::Path;

use crate::error::Result;
use crate::store::{StoredRun, vtkhdf as vtk};

mod csv;
mod npz;

pub use csv::{cell, csv};
pub use npz::npz;

/// Writes the frames as a file that ParaView opens.
///
/// # Errors
/// [`Error::Io`](crate::Error::Io) or [`Error::Store`](crate::Error::Store) when it cannot be written.
pub fn vtkhdf(run: &StoredRun, path: &Path) -> Result<()> {
    vtk::write(path, run)
}
