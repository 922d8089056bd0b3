//! Tests of planar blocks, one program.

mod account;
mod cracks;
mod devices;
mod motion;
mod rocking;
mod ties;
mod vibration;
