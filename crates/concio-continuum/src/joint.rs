//! What a joint does per area, and a joint as springs at points.
//!
//! A joint is integrated at two Gauss points along its length, which is exact: jumps of rigid bricks are linear there, and
//! the thickness is integrated in closed form.

use crate::springs::{IMPOSED, Spring};

/// Elastic stiffness of a joint per area [N/m³], from 0.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Stiffness {
    /// k_n, across the joint.
    pub normal: f64,
    /// k_t, along it in the plane of the wall.
    pub tangential: f64,
    /// k_s, along it out of the plane.
    pub transverse: f64,
}

impl Stiffness {
    /// Of a joint that is sheared alike in both directions: k_s = k_t.
    pub fn new(normal: f64, tangential: f64) -> Stiffness {
        Stiffness { normal, tangential, transverse: tangential }
    }

    /// Of a joint with nothing in it.
    pub fn open() -> Stiffness {
        Stiffness::default()
    }
}

/// Strength of a joint per area: |τ| ≤ c − μ σ and −f_c ≤ σ ≤ f_t, tension positive.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Strength {
    /// c in Pa, from 0.
    pub cohesion: f64,
    /// μ, from 0.
    pub friction: f64,
    /// f_t in Pa, from 0; above c/μ it has no meaning, and c/μ stands for it.
    pub tension: f64,
    /// f_c in Pa, above 0; infinite where nothing limits the pressure.
    pub compression: f64,
}

impl Strength {
    /// Coulomb's law up to its apex: f_t = c/μ.
    pub fn coulomb(cohesion: f64, friction: f64) -> Strength {
        let tension = if cohesion > 0.0 { cohesion / friction } else { 0.0 };
        Strength { cohesion, friction, tension, compression: f64::INFINITY }
    }

    /// Friction alone.
    pub fn dry(friction: f64) -> Strength {
        Strength::coulomb(0.0, friction)
    }

    /// f_t or c/μ, whichever is less.
    pub fn reached_tension(&self) -> f64 {
        if self.friction > 0.0 { self.tension.min(self.cohesion / self.friction) } else { self.tension }
    }
}

/// A joint between a brick and a brick beside it, or the image of one.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// Index of the brick on the side that `normal` looks away from.
    pub a: usize,
    /// Index of the other brick.
    pub b: usize,
    /// From the centre of `a` to that of `b`, or of its image [m].
    pub apart: [f64; 2],
    /// From the centre of `a` to the middle of the joint [m].
    pub middle: [f64; 2],
    /// Unit normal, from a to b.
    pub normal: [f64; 2],
    /// Contact length, above 0 [m].
    pub length: f64,
    /// Its stiffness.
    pub stiffness: Stiffness,
}

impl Contact {
    pub(crate) fn tangent(&self) -> [f64; 2] {
        [-self.normal[1], self.normal[0]]
    }

    /// Gauss points: place from the centre of `a`, and length.
    fn points(&self) -> [([f64; 2], f64); 2] {
        let t = self.tangent();
        let at = |s: f64| [0, 1].map(|k| self.middle[k] + s * t[k]);
        let s = 0.5 * self.length / 3f64.sqrt();
        [(at(-s), 0.5 * self.length), (at(s), 0.5 * self.length)]
    }

    /// Springs of the plane under (ε11, ε22, γ12, rotation of all bricks), for a wall of this thickness.
    pub(crate) fn in_plane(&self, thickness: f64) -> Vec<Spring> {
        let [d1, d2] = self.apart;
        let mut springs = Vec::with_capacity(4);
        for (p, length) in self.points() {
            let from_b = [p[0] - d1, p[1] - d2];
            for (axis, k) in [(self.normal, self.stiffness.normal), (self.tangent(), self.stiffness.tangential)] {
                let turn = |r: [f64; 2]| -r[1] * axis[0] + r[0] * axis[1];
                let rows = [[-axis[0], -axis[1], -turn(p)], [axis[0], axis[1], turn(from_b)]];
                let mut imposed = [0.0; IMPOSED];
                imposed[0] = d1 * axis[0];
                imposed[1] = d2 * axis[1];
                imposed[2] = 0.5 * (d2 * axis[0] + d1 * axis[1]);
                springs.push(Spring { bodies: [self.a, self.b], rows, imposed, stiffness: k * length * thickness });
            }
        }
        springs.retain(|s| s.stiffness > 0.0);
        springs
    }

    /// Springs out of the plane under (χ11, χ22, 2 χ12, γ1, γ2). A brick has the deflection w and turns so that its points move by
    /// x3 ψ in the plane and by w − ψ·r out of it.
    pub(crate) fn out_of_plane(&self, thickness: f64) -> Vec<Spring> {
        let [d1, d2] = self.apart;
        let bodies = [self.a, self.b];
        let cubed = thickness.powi(3) / 12.0;
        let mut springs = Vec::with_capacity(4);
        for (axis, k) in [(self.normal, self.stiffness.normal), (self.tangent(), self.stiffness.tangential)] {
            let rows = [[0.0, -axis[0], -axis[1]], [0.0, axis[0], axis[1]]];
            let imposed = [d1 * axis[0], d2 * axis[1], 0.5 * (d2 * axis[0] + d1 * axis[1]), 0.0, 0.0];
            springs.push(Spring { bodies, rows, imposed, stiffness: k * self.length * cubed });
        }
        for (p, length) in self.points() {
            let rows = [[-1.0, p[0], p[1]], [1.0, -(p[0] - d1), -(p[1] - d2)]];
            // d χ (m − p), m in the middle between the centres.
            let r = [0.5 * d1 - p[0], 0.5 * d2 - p[1]];
            let imposed = [d1 * r[0], d2 * r[1], 0.5 * (d1 * r[1] + d2 * r[0]), d1, d2];
            springs.push(Spring { bodies, rows, imposed, stiffness: self.stiffness.transverse * length * thickness });
        }
        springs.retain(|s| s.stiffness > 0.0);
        springs
    }
}
