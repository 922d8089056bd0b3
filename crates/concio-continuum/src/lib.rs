//! The equivalent continuum of a wall.
