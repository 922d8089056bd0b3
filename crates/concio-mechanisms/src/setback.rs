//! How far a hinge lies behind the outer face where masonry crushes.
//!
//! (OP2) a = N/(2 f_h L) for a rectangular block of pressure, a = 2N/(3 f_h L) for a triangular one.
//!
//! Derived: the resultant N of the pressure on a strip of length L lies in the middle of the rectangle, or at a third of the triangle.

/// How masonry bears the pressure at a hinge.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Crushing {
    /// It does not crush: the hinge lies on the face.
    #[default]
    Rigid,
    /// A rectangular block of pressure f_h [Pa], above 0.
    Rectangular(f64),
    /// A triangular one with its peak f_h [Pa], above 0.
    Triangular(f64),
}

impl Crushing {
    /// a [m] under a force N [N] on a hinge of length L [m], above 0.
    pub fn setback(self, force: f64, length: f64) -> f64 {
        match self {
            Crushing::Rigid => 0.0,
            Crushing::Rectangular(strength) => force / (2.0 * strength * length),
            Crushing::Triangular(strength) => 2.0 * force / (3.0 * strength * length),
        }
    }

    /// Whether crushing is left out, so that the code asks for the confidence factor of LC1.
    pub fn is_left_out(self) -> bool {
        self == Crushing::Rigid
    }
}
