//! Tests of limit analysis, one program.

mod limit;
mod limit_reference;
mod limit_walls;
mod space;
mod space_reference;
mod space_wall;
mod tilt;
mod tilted_arch;
