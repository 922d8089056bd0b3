//! Figures as SVG: the wall by own hand, curves by the plotting library.

pub mod curves;
mod svg;
pub mod wall;

pub use svg::escape;
