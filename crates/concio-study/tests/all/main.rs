//! Tests of the studies, one program.

mod alike;
mod analyses;
mod common;
mod first_crack;
mod fragility;
mod groups;
mod ida;
mod ida_curves;
mod peers;
mod runs;
mod sensitivity;
mod smart;
