//! Tests of mechanisms, one program.

mod rocking;
mod rocking_reference;
