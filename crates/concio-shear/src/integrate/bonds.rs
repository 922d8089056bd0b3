//! Bonds as the stage sees them: secants that hold for the whole step, and beyond them the softening (B3) of joints that
//! are stretched further than ever before, with its tangent.
//!
//! The damage that a stage implies is not kept: every stage starts from the state before the step, so that repeating a
//! step changes nothing. Brittle bonds do not crack inside a step; the time loop ends steps where they do.

use crate::integrate::joints::{Joints, Rubs};
use crate::system::System;
use concio_law::bond::Bond;
use concio_law::bond::BondState;

/// What a bond has beyond the secant of its joint at some relative displacement.
#[derive(Debug, Clone, Copy, Default)]
struct Softening {
    /// Relative displacement x_a − x_b [m].
    at: f64,
    /// Force on side a [N].
    force: f64,
    /// Its slope [N/m].
    slope: f64,
    /// χ and its slope against x_a − x_b [1/m].
    rubs: f64,
    growth: f64,
}

/// One bond.
#[derive(Debug, Clone)]
struct Soft {
    law: Bond,
    limit: f64,
    joint: usize,
    rub: Option<usize>,
    /// D and χ before the step.
    held: f64,
    held_rubs: f64,
    /// δ_p + τ w_p.
    start: f64,
    /// Where the tangent is drawn, and the law at the last iterate.
    tangent: Softening,
    found: Softening,
}

impl Soft {
    #[inline]
    fn softening(&self, d: f64) -> Softening {
        let (law, reach) = (&self.law, self.law.stretch(d));
        let held = Softening { at: d, rubs: self.held_rubs, ..Softening::default() };
        if law.is_brittle() || reach <= self.limit {
            return held;
        }
        let [(damage, growth), (rubs, spread)] = law.worn(reach);
        if damage <= self.held {
            return held;
        }
        let softer = law.secant(damage) - law.secant(self.held);
        let falling = law.stiffness * (1.0 - law.residual) * growth * reach;
        Softening { at: d, force: softer * d, slope: softer - falling, rubs, growth: spread * d.signum() }
    }
}

/// Scratch for all bonds.
#[derive(Debug, Clone)]
pub struct Bonds {
    list: Vec<Soft>,
}

impl Bonds {
    pub fn new(system: &System) -> Self {
        let soft = |b: &crate::law::Bonded| Soft {
            law: b.law,
            limit: b.law.limit(),
            joint: b.joint as usize,
            rub: b.rub.map(|r| r as usize),
            held: 0.0,
            held_rubs: 0.0,
            start: 0.0,
            tangent: Softening::default(),
            found: Softening::default(),
        };
        Bonds { list: system.bonds.iter().map(soft).collect() }
    }

    /// Takes over the damage before a step.
    pub fn hold(&mut self, system: &System, states: &[BondState], joints: &mut Joints, rubs: &mut Rubs) {
        for (bond, state) in self.list.iter_mut().zip(states) {
            (bond.held, bond.held_rubs) = (state.damage, bond.law.rubbing(state));
            bond.tangent = Softening::default();
            if !bond.law.opens {
                joints.stiffness[bond.joint] = bond.law.secant(bond.held);
            }
            if let Some(r) = bond.rub {
                rubs.crack(system, r, bond.held_rubs);
            }
        }
    }

    /// Draws tangents at the prediction; true when the matrix changes with them.
    #[inline]
    pub fn start(&mut self, system: &System, rubs: &mut Rubs, [z, v]: [&[f64]; 2], tau: f64) -> bool {
        let mut changed = false;
        for bond in &mut self.list {
            let [a, b] = system.sides[bond.joint].map(|s| s as usize);
            bond.start = z[a] - z[b] + tau * (v[a] - v[b]);
            let slope = bond.tangent.slope;
            bond.tangent = bond.softening(bond.start);
            bond.found = bond.tangent;
            changed |= bond.tangent.slope != slope;
            if let Some(r) = bond.rub {
                rubs.crack(system, r, bond.tangent.rubs);
            }
        }
        changed
    }

    /// Visits what acts beyond the tangents of the springs: `add(joint, stiffness)` for open head joints that are still bonded.
    #[inline]
    pub fn open(&self, closed: &[bool], mut add: impl FnMut(usize, f64)) {
        for bond in self.list.iter().filter(|b| b.law.opens && !closed[b.joint]) {
            add(bond.joint, bond.law.secant(bond.held));
        }
    }

    /// Visits the slopes of softening [N/m].
    #[inline]
    pub fn slopes(&self, mut add: impl FnMut(usize, f64)) {
        for bond in self.list.iter().filter(|b| b.tangent.slope != 0.0) {
            add(bond.joint, bond.tangent.slope);
        }
    }

    /// Visits the forces [N] of the tangents at the prediction.
    #[inline]
    pub fn forces(&self, mut add: impl FnMut(usize, f64)) {
        for bond in &self.list {
            let t = &bond.tangent;
            if t.slope != 0.0 || t.force != 0.0 {
                add(bond.joint, t.force + t.slope * (bond.start - t.at));
            }
        }
    }

    /// The laws after a change of the velocities, and how much of each joint rubs then.
    #[inline]
    pub fn look(&mut self, system: &System, joints: &Joints, rubs: &mut Rubs, change: &[f64], tau: f64) {
        for bond in &mut self.list {
            let [a, b] = joints.sides[bond.joint].map(|s| s as usize);
            let before = bond.found.rubs;
            bond.found = bond.softening(bond.start + tau * (change[a] - change[b]));
            if let Some(r) = bond.rub.filter(|_| bond.found.rubs != before) {
                rubs.crack(system, r, bond.found.rubs);
            }
        }
    }

    /// Adds to the slopes of friction that more of the joint rubs as it is stretched: `mu` are those of the parts that rub.
    #[inline]
    pub fn rub_more(&self, mu: &[f64], slope: &mut [f64], tau: f64) {
        for bond in self.list.iter().filter(|b| b.found.growth != 0.0 && b.found.rubs > 0.0) {
            if let Some(r) = bond.rub {
                slope[r] += tau * bond.found.growth * mu[r] / bond.found.rubs;
            }
        }
    }

    /// Visits the forces [N] by which the tangents miss the laws.
    #[inline]
    pub fn mismatch(&self, mut add: impl FnMut(usize, f64)) {
        for bond in &self.list {
            let (t, f) = (&bond.tangent, &bond.found);
            if t.slope != 0.0 || t.force != 0.0 || f.force != 0.0 {
                add(bond.joint, f.force - (t.force + t.slope * (f.at - t.at)));
            }
        }
    }

    /// Draws the next tangents at the last iterate; true when the matrix changes with them.
    #[inline]
    pub fn move_tangents(&mut self) -> bool {
        let mut changed = false;
        for bond in &mut self.list {
            changed |= bond.tangent.slope != bond.found.slope;
            bond.tangent = bond.found;
        }
        changed
    }

    /// Visits the tangent stiffness [N/m] of every bond in the state of the last iterate, where head joints are `closed`
    /// or not; those of closed head joints are left to their springs.
    pub fn tangents(&self, closed: &[bool], mut add: impl FnMut(usize, f64)) {
        for bond in self.list.iter().filter(|b| !(b.law.opens && closed[b.joint])) {
            add(bond.joint, bond.law.secant(bond.held) + bond.found.slope);
        }
    }
}
