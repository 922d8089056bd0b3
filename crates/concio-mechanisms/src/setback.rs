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

    /// [`Crushing::setback`] in a wall of thickness t [m]: where the block of pressure has no place in it, the hinge is taken to lie on the
    /// other face. 0 without a length.
    pub fn setback_within(self, force: f64, length: f64, thickness: f64) -> f64 {
        match length > 0.0 {
            true if self.width(force, length) > thickness => thickness,
            true => self.setback(force, length),
            false => 0.0,
        }
    }

    /// Width [m] of the block of pressure: one that is wider than the wall has no place in it.
    pub fn width(self, force: f64, length: f64) -> f64 {
        match self {
            Crushing::Rigid => 0.0,
            Crushing::Rectangular(strength) => force / (strength * length),
            Crushing::Triangular(strength) => 2.0 * force / (strength * length),
        }
    }

    /// The force N [N] along a wall of thickness t [m], through hinges of length L [m] at both of its faces, whose moment N (t − 2a) is largest: a
    /// is t/4 then, and more force crushes more of the lever than it brings. Without end where nothing crushes.
    pub fn best_force(self, length: f64, thickness: f64) -> f64 {
        0.25 * thickness / self.setback(1.0, length)
    }

    /// Whether crushing is left out, so that the code asks for the confidence factor of LC1.
    pub fn is_left_out(self) -> bool {
        self == Crushing::Rigid
    }
}
