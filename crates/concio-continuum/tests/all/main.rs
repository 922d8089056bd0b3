//! Tests of the continuum, one program.

mod cards;
mod convergence;
mod moduli;
mod references;
mod strength;
mod texture;
mod traps;
mod windows;
