//! Tests of mechanisms, one program.

mod rocking;
mod rocking_random;
mod rocking_reference;
