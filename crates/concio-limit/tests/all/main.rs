//! Tests of limit analysis, one program.

mod limit;
mod limit_reference;
mod limit_walls;
mod tilt;
mod tilted_arch;
