//! The joints of a system as the stage reads them: one array per quantity, unknowns by their place in the elimination
//! order.

use crate::system::System;
use concio_law::friction::{Smooth, Stribeck};

/// Mismatch of tangent and law, as a fraction of μ_s, beyond which the next tangent is moved along the law.
pub const FAR: f64 = 0.02;
/// How near to the law, as a fraction of μ_s, that place has to be found.
pub const MEETING: f64 = 0.01;
/// Points of the law that are tried for it at most.
pub const MOST_SEARCHED: usize = 20;

/// Where a joint's coupling stands in the matrix, if it has one: joints with a support do not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slot(u32);

impl Slot {
    #[inline(always)]
    pub fn at(self) -> Option<usize> {
        (self.0 != u32::MAX).then_some(self.0 as usize)
    }
}

/// All joints.
#[derive(Debug, Clone)]
pub struct Joints {
    /// Both sides by place; base and top keep their numbers n and n + 1.
    pub sides: Vec<[u32; 2]>,
    pub slot: Vec<Slot>,
    pub stiffness: Vec<f64>,
    /// Joints whose stiffness acts in compression only.
    pub one_sided: Vec<u32>,
}

impl Joints {
    /// `slots`: of the joints between two unknowns, in their order.
    pub fn new(system: &System, places: &[u32], slots: &[u32]) -> Self {
        let n = system.unknowns();
        let place = |i: u32| places.get(i as usize).copied().unwrap_or(i);
        let mut slots = slots.iter();
        let slot = |side: &[u32; 2]| {
            let found = if (side[1] as usize) < n { slots.next() } else { None };
            Slot(found.copied().unwrap_or(u32::MAX))
        };
        Joints {
            sides: system.sides.iter().map(|s| s.map(place)).collect(),
            slot: system.sides.iter().map(slot).collect(),
            stiffness: system.elastic.iter().map(|law| law.stiffness).collect(),
            one_sided: (0..system.sides.len() as u32).filter(|&e| system.elastic[e as usize].unilateral).collect(),
        }
    }
}

/// The rigid joints.
#[derive(Debug, Clone)]
pub struct Contacts {
    /// Both sides by place, and in the order of the system.
    pub sides: Vec<[u32; 2]>,
    pub of_system: Vec<[u32; 2]>,
    pub slot: Vec<Slot>,
}

impl Contacts {
    pub fn new(system: &System, joints: &Joints) -> Self {
        let indices = || system.contacts.iter().map(|c| c.joint as usize);
        Contacts {
            sides: indices().map(|e| joints.sides[e]).collect(),
            of_system: indices().map(|e| system.sides[e]).collect(),
            slot: indices().map(|e| joints.slot[e]).collect(),
        }
    }

    pub fn len(&self) -> usize {
        self.sides.len()
    }
}

/// The joints that rub.
#[derive(Debug, Clone)]
pub struct Rubs {
    /// Index of the joint.
    pub joint: Vec<u32>,
    pub sides: Vec<[u32; 2]>,
    pub slot: Vec<Slot>,
    /// Normal force in the equation of each side [N].
    pub normal: Vec<[f64; 2]>,
    /// μ_s − μ_d, μ_d, δ_v, β/δ_v, α.
    excess: Vec<f64>,
    dynamic: Vec<f64>,
    slip_velocity: Vec<f64>,
    steep: Vec<f64>,
    alpha: Vec<f64>,
    /// The joints among these, by index here, whose law is set-valued.
    pub sticking: Vec<u32>,
    /// Part of each that rubs, 0 … 1; empty where no joint is bonded.
    cracked: Vec<f64>,
}

/// Steepness by which a set-valued law in slip goes through the same operations as (6): any speed is far up the branch.
const VERTICAL: f64 = 1e200;

impl Rubs {
    pub fn new(system: &System, joints: &Joints) -> Self {
        let rubs = || system.rubs.iter();
        let at_once = |r: &crate::law::Rub| r.law.sticks() && r.law.slip_velocity == 0.0;
        Rubs {
            joint: rubs().map(|r| r.joint).collect(),
            sides: rubs().map(|r| joints.sides[r.joint as usize]).collect(),
            slot: rubs().map(|r| joints.slot[r.joint as usize]).collect(),
            normal: rubs().map(|r| r.normal).collect(),
            excess: rubs().map(|r| if at_once(r) { 0.0 } else { r.law.static_ - r.law.dynamic }).collect(),
            dynamic: rubs().map(|r| r.law.dynamic).collect(),
            slip_velocity: rubs().map(|r| if at_once(r) { 1.0 } else { r.law.slip_velocity }).collect(),
            steep: rubs().map(|r| if r.law.sticks() { VERTICAL } else { r.law.beta / r.law.slip_velocity }).collect(),
            alpha: rubs().map(|r| r.law.alpha).collect(),
            cracked: if system.bonds.is_empty() { Vec::new() } else { vec![1.0; system.rubs.len()] },
            sticking: (0..system.rubs.len() as u32).filter(|&r| system.rubs[r as usize].law.sticks()).collect(),
        }
    }

    pub fn len(&self) -> usize {
        self.joint.len()
    }

    /// Makes a part of joint `r` rub, from 0 to 1: the rest is bonded.
    pub fn crack(&mut self, system: &System, r: usize, part: f64) {
        if self.cracked[r] != part {
            let law = system.rubs[r].law.times(part);
            self.cracked[r] = part;
            self.excess[r] = if law.sticks() && law.slip_velocity == 0.0 { 0.0 } else { law.static_ - law.dynamic };
            self.dynamic[r] = law.dynamic;
            self.alpha[r] = law.alpha;
        }
    }

    /// The law of the part of joint `r` that rubs; `room` is where it is put if that is not the whole.
    #[inline(always)]
    pub fn law<'a>(&self, system: &'a System, r: usize, room: &'a mut Stribeck) -> &'a Stribeck {
        let law = &system.rubs[r].law;
        if self.cracked.is_empty() {
            return law;
        }
        *room = law.times(self.cracked[r]);
        room
    }

    /// Part of joint `r` that rubs, 0 … 1.
    #[inline(always)]
    pub fn part(&self, r: usize) -> f64 {
        if self.cracked.is_empty() { 1.0 } else { self.cracked[r] }
    }

    /// μ_s of the part of joint `r` that rubs.
    #[inline(always)]
    pub fn most(&self, system: &System, r: usize) -> f64 {
        self.part(r) * system.rubs[r].law.static_
    }

    /// |μ| and its slope [s/m] of a set-valued law as slip begins.
    pub fn breaking_away(&self, r: usize) -> (f64, f64) {
        (self.excess[r] + self.dynamic[r], -self.excess[r] / self.slip_velocity[r])
    }

    /// (6) and its slope at the velocities `w` of all joints: the operations of [`Stribeck::at`], joint by joint, and
    /// so its bits. One plain loop, which becomes vector instructions.
    #[inline(always)]
    pub fn laws(&self, w: &[f64], mu: &mut [f64], slope: &mut [f64]) {
        let n = w.len();
        let (excess, dynamic, slip) = (&self.excess[..n], &self.dynamic[..n], &self.slip_velocity[..n]);
        let (steep, alpha) = (&self.steep[..n], &self.alpha[..n]);
        let (mu, slope) = (&mut mu[..n], &mut slope[..n]);
        for r in 0..n {
            let law = Smooth {
                excess: excess[r],
                dynamic: dynamic[r],
                slip_velocity: slip[r],
                steep: steep[r],
                alpha: alpha[r],
            };
            let value;
            (value, slope[r]) = law.at(w[r].abs());
            mu[r] = value.copysign(w[r]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{Link, Side, lumped};

    /// The loop over all joints gives the bits of the law of each.
    #[test]
    fn all_laws_at_once_are_the_law_of_each() {
        let law = |slip_velocity, beta, alpha| Stribeck { static_: 0.6, dynamic: 0.42, slip_velocity, beta, alpha };
        let laws =
            [law(1e-3, 100.0, 0.0), law(1e-2, 3.0, 0.7), law(1e-3, f64::INFINITY, 0.2), law(0.0, f64::INFINITY, 0.0)];
        let links: Vec<Link> = laws.iter().map(|law| Link::friction(0, Side::Base, *law, 100.0)).collect();
        let system = lumped(&[1.0], &links, 1.0);
        let rubs = Rubs::new(&system, &Joints::new(&system, &[0], &[]));
        let (mut mu, mut slope) = ([0.0; 4], [0.0; 4]);
        for size in [1e-12, 1e-9, 1e-6, 1e-5, 3e-4, 1e-3, 0.05, 2.0] {
            for w in [size, -size] {
                rubs.laws(&[w; 4], &mut mu, &mut slope);
                for (r, law) in laws.iter().enumerate() {
                    let (exact, steep) = law.at(w);
                    if law.sticks() {
                        // The limit goes another way to the same numbers.
                        assert!((mu[r] - exact).abs() <= 1e-15 && (slope[r] - steep).abs() <= 1e-12 * steep.abs());
                    } else {
                        assert_eq!((mu[r], slope[r]), (exact, steep), "{law:?} at {w}");
                    }
                }
            }
        }
    }
}
