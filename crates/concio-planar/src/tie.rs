//! Tie rods: straight, between a point of one body and a point of another or of the base, in tension alone.
//!
//! A rod of stiffness k = E A/ℓ bears
//!
//! (P7) f = k [ℓ − ℓ_0 − s − e_p]₊ ≤ f_y
//!
//! ℓ being the distance of its ends, which turn with their bodies, ℓ_0 that as the bodies were laid, s its slack and e_p by how
//! much it has yielded, which grows so that f never exceeds f_y. Its line over a step is that of the middle, and its force (P6). It is a
//! joint in compression only that is crushed ([`crate::joint`]), turned over: what its ends part by closes it. How its force changes
//! with its direction within a step is left out of the matrix.

use serde::{Deserialize, Serialize};

use crate::joint::{Law, Normal, Point};

/// A tie rod.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tie {
    /// First body; none for the base.
    pub a: Option<usize>,
    /// Second body, another than the first.
    pub b: usize,
    /// Its ends as the bodies were laid [m]: from the centres of both, of the base from the origin. They lie apart.
    pub at: [[f64; 2]; 2],
    /// k [N/m], above 0.
    pub stiffness: f64,
    /// f_y [N], above 0; infinite where it does not yield.
    pub yield_force: f64,
    /// s [m], from 0.
    pub slack: f64,
}

impl Tie {
    /// What it is as a joint.
    pub(crate) fn law(&self) -> Law {
        let normal = Normal::Springs { both: 0.0, press: self.stiffness, damping: 0.0 };
        Law { normal, crushing: self.yield_force, ..Law::dry(None) }
    }
}

/// What has become of a tie.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Strain {
    pub(crate) point: Point,
    /// Force on its second body in the last step [N].
    pub pull: [f64; 2],
}

impl Strain {
    /// e_p [m].
    pub fn yielded(&self) -> f64 {
        self.point.crushed
    }

    /// By how much the ends lie farther apart than where it begins to bear, ℓ − ℓ_0 − s [m]; below 0 where it is slack.
    pub fn stretch(&self) -> f64 {
        -self.point.gap
    }

    /// f of `tie` at the end of the last step [N].
    pub fn force(&self, tie: &Tie) -> f64 {
        tie.stiffness * (self.stretch() - self.yielded()).max(0.0)
    }
}
