//! Texts with units, as numbers in SI.

use concio::InputError;
use concio::quantity::{Force, Quantity, Time};
use pyo3::prelude::*;

use crate::failure::Raised;

/// Reads `"5 ms"` or `"1 kN"` as `of`, which is `time` or `force`; errors are of `key`.
#[pyfunction]
pub fn in_si(text: &str, of: &str, key: &str) -> PyResult<f64> {
    let read = match of {
        "force" => Force::parse(text).map(Quantity::si),
        _ => Time::parse(text).map(Quantity::si),
    };
    let wrong = |told: String| {
        let (what, allowed) = told.split_once("; allowed: ").unwrap_or((&told, ""));
        let error = InputError::new(what).key(key);
        Raised::from(if allowed.is_empty() { error } else { error.allowed(allowed) })
    };
    Ok(read.map_err(wrong)?)
}
