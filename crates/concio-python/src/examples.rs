//! The wall files of `examples/` that need no other file, by name.

use pyo3::prelude::*;

macro_rules! examples {
    ($($name:literal = $file:literal,)+) => {
        const EXAMPLES: &[(&str, &str)] = &[$(($name, include_str!(concat!("../../../examples/", $file))),)+];
    };
}

examples! {
    "first-wall" = "01-first-wall.toml",
    "driven-top" = "02-driven-top.toml",
    "irregular-texture" = "03-irregular-texture.toml",
    "two-panels" = "04-two-panels.toml",
    "massive-beam" = "05-massive-beam.toml",
    "pulse" = "06-pulse.toml",
    "frictionless" = "08-frictionless.toml",
    "replaced-joint" = "09-replaced-joint.toml",
    "true-stick" = "10-true-stick.toml",
    "rigid-heads" = "11-rigid-heads.toml",
    "bonded-joints" = "12-bonded-joints.toml",
    "interfaces" = "13-interfaces.toml",
    "sliding-wall" = "14-sliding-wall.toml",
    "dry-shear-wall" = "15-dry-shear-wall.toml",
    "shear-panel" = "16-shear-panel.toml",
    "arch" = "17-arch.toml",
    "pulled-brick" = "18-pulled-brick.toml",
    "rocking-facade" = "19-rocking-facade.toml",
}

/// Names of the examples, in the order of their files.
#[pyfunction]
pub fn example_names() -> Vec<&'static str> {
    EXAMPLES.iter().map(|(name, _)| *name).collect()
}

/// The text of an example.
pub fn text(name: &str) -> Option<&'static str> {
    EXAMPLES.iter().find(|(own, _)| *own == name).map(|(_, text)| *text)
}
