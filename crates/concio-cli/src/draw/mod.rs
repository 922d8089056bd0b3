//! Figures as SVG: the wall by own hand, curves by the plotting library.

pub mod axonometry;
pub mod chart;
pub mod curves;
pub mod font;
pub mod mechanism;
pub mod out_of_plane;
pub mod output;
pub mod scale;
pub mod svg;
pub mod thin;
pub mod wall;

pub use svg::escape;
