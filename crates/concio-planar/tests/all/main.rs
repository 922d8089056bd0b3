//! Tests of planar blocks, one program.

mod account;
mod cracks;
mod devices;
mod fibres;
mod motion;
mod rocking;
mod ties;
mod vibration;
