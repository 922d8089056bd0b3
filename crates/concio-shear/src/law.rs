//! What joints of the shear system are made of (theory, section 3).
//!
//! (2) F^el = w K_H δ, (3) F^el = κ K_V δ for a closed head joint and 0 for an open one, (4) F^v = w C δ̇,
//! (5) F^fr = N μ(δ̇). Friction, bonds and devices with laws of their own are in `concio_law`.

use concio_law::bond::Bond;
use concio_law::device::Law;
use concio_law::friction::Stribeck;

/// Elastic force of a joint at relative displacement `d` [N].
#[inline]
pub fn spring_force(unilateral: bool, stiffness: f64, d: f64) -> f64 {
    if unilateral && d <= 0.0 { 0.0 } else { stiffness * d }
}

/// Elastic and viscous part of a joint, (2)–(4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// w K_H, or κ K_V for a no-tension joint [N/m].
    pub stiffness: f64,
    /// w C [N s/m].
    pub damping: f64,
    /// The stiffness acts in compression only.
    pub unilateral: bool,
}

/// Frictional part of a joint, (5).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rub {
    /// Index of the joint.
    pub joint: u32,
    /// Normal force in the equation of each side [N].
    pub normal: [f64; 2],
    /// μ(v).
    pub law: Stribeck,
}

impl Rub {
    /// The normal force on the side where it is larger [N].
    pub fn largest_normal(&self) -> f64 {
        self.normal[0].max(self.normal[1])
    }
}

/// A joint that lets its sides part and never lets them overlap: (R1), (R2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Index of the joint.
    pub joint: u32,
    /// Newton's coefficient of restitution e, 0 … 1.
    pub restitution: f64,
}

/// What is joined to a support, by index in the lists of the [`crate::system::System`].
#[derive(Debug, Clone, Default)]
pub struct Support {
    /// Joints.
    pub joints: Vec<u32>,
    /// Among those that rub.
    pub rubs: Vec<u32>,
    /// Among the bonds.
    pub bonds: Vec<u32>,
    /// Among the rigid joints.
    pub contacts: Vec<u32>,
    /// Among the devices with laws of their own.
    pub devices: Vec<u32>,
}

/// A joint with a bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bonded {
    /// Index of the joint.
    pub joint: u32,
    /// Its index among the joints that rub, if it does.
    pub rub: Option<u32>,
    /// The law.
    pub law: Bond,
}

impl Bonded {
    /// Elastic force on side a [N] at the relative displacement `d` [m]; `elastic` is the joint's own, intact.
    #[inline]
    pub fn force(&self, elastic: &Elastic, damage: f64, d: f64) -> f64 {
        if self.law.opens && d > 0.0 { elastic.stiffness * d } else { self.law.secant(damage) * d }
    }

    /// What [`Bonded::force`] has beyond the force of the intact spring in `elastic`: exactly 0 for an intact bed joint.
    #[inline]
    pub fn beyond(&self, elastic: &Elastic, damage: f64, d: f64) -> f64 {
        self.force(elastic, damage, d) - spring_force(elastic.unilateral, elastic.stiffness, d)
    }
}

/// What a device does beyond a spring, a dashpot and friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nonlinear {
    /// Index of the joint.
    pub joint: u32,
    /// The law.
    pub law: Law,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closed, a head joint that is bonded has the law of its own; open, what is left of the bond.
    #[test]
    fn a_bond_against_opening_leaves_compression_alone() {
        let (strength, stiffness) = (2e3, 5e7);
        let brittle = Bond::new(strength, stiffness, 0.0, 0.0, true).expect("a bond");
        let head = Bonded { joint: 0, rub: None, law: brittle };
        let elastic = Elastic { stiffness: 1e3 * stiffness, damping: 0.0, unilateral: true };
        for damage in [0.0, 0.5, 1.0] {
            assert_eq!(head.force(&elastic, damage, 1e-6), 1e-3 * stiffness);
            assert_eq!(head.force(&elastic, damage, -1e-6), -1e-6 * stiffness * (1.0 - damage));
        }
    }
}
