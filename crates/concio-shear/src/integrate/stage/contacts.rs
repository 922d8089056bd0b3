//! Rigid joints in a stage, and what sticks together.
//!
//! A rigid joint that touches is closed, w = 0 under a force λ ≥ 0, or open, w ≤ 0 under none (R2). It is held like a
//! sticking joint, by a slope from the force found last; one that would have to pull is opened, one whose sides approach
//! each other is closed.

use super::{HOLD, STILL, Stage};
use crate::dynamics::TOUCHING;
use crate::state::Tangents;
use crate::system::System;

impl Stage {
    /// Sticking joints come to rest altogether: blocks that hang together have one velocity.
    pub(super) fn rest(&mut self, system: &System, tangents: &mut Tangents) {
        let Tangents { stuck, contact, .. } = tangents;
        self.groups.rest(system, stuck, contact, &self.touching, &mut self.solution);
        for &r in &self.rubs.sticking {
            if tangents.stuck[r as usize] {
                tangents.velocity[r as usize] = 0.0;
            }
        }
    }

    /// Which rigid joints touch, the slope that holds them, and their velocities in the prediction.
    pub(super) fn start_contacts(&mut self, tangents: &Tangents) {
        self.clamp = 0.0;
        for (c, &[a, b]) in self.contacts.sides.iter().enumerate() {
            let free = self.diagonal[a as usize].recip() + self.diagonal.get(b as usize).map_or(0.0, |d| d.recip());
            self.clamp = self.clamp.max(HOLD / (self.tau * free));
            let [i, k] = self.contacts.of_system[c].map(|s| s as usize);
            self.parting[c] = self.v[i] - self.v[k];
            let touches = tangents.contact[c] || self.z[i] - self.z[k] >= -TOUCHING;
            self.touching[c] = self.eligible[c] && touches;
        }
    }

    /// The slopes of closed rigid joints, added to the matrix.
    #[inline(always)]
    pub(super) fn assemble_contacts(&mut self, system: &System, tangents: &Tangents) {
        let s = self.tau * self.clamp;
        for (c, &[a, b]) in self.contacts.sides.iter().enumerate().filter(|(c, _)| tangents.contact[*c]) {
            self.matrix.diagonal[a as usize] += s;
            if let Some(slot) = self.contacts.slot[c].at() {
                self.matrix.diagonal[b as usize] += s;
                self.matrix.lower[slot] -= s;
                if !system.reciprocal {
                    self.matrix.upper[slot] -= s;
                }
            }
        }
    }

    /// Force λ + σ w_p of closed rigid joints, on the right side.
    #[inline(always)]
    pub(super) fn push_contacts(&mut self, tangents: &Tangents) {
        for (c, &[a, b]) in self.contacts.sides.iter().enumerate().filter(|(c, _)| tangents.contact[*c]) {
            let f = self.tau * (tangents.reaction[c] + self.clamp * self.parting[c]);
            self.change[a as usize] -= f;
            self.change[b as usize] += f;
        }
    }

    /// What rigid joint `c` has to do, if it is not as it is: open when it would pull so that it is felt, close when
    /// its sides approach each other.
    #[inline(always)]
    fn turns(&self, c: usize, tangents: &Tangents, accuracy: f64) -> bool {
        if tangents.contact[c] {
            let force = tangents.reaction[c] + self.clamp * self.closing[c];
            self.tau * force < -STILL * accuracy * self.mass[self.contacts.sides[c][0] as usize]
        } else {
            self.touching[c] && self.closing[c] > 0.0
        }
    }

    #[inline(always)]
    pub(super) fn contacts_settled(&self, tangents: &Tangents, accuracy: f64) -> bool {
        (0..self.contacts.len()).all(|c| {
            !self.turns(c, tangents, accuracy) && (!tangents.contact[c] || self.closing[c].abs() <= STILL * accuracy)
        })
    }

    /// Keeps the forces found, opens and closes rigid joints: all that have to, or the first of them alone.
    #[inline(always)]
    pub(super) fn move_contacts(&mut self, tangents: &mut Tangents, accuracy: f64, one: bool) {
        let mut moved = false;
        for c in 0..self.contacts.len() {
            if self.turns(c, tangents, accuracy) && !(one && moved) {
                moved = true;
                tangents.contact[c] = !tangents.contact[c];
                tangents.reaction[c] = 0.0;
            } else if tangents.contact[c] {
                tangents.reaction[c] += self.clamp * self.closing[c];
            }
        }
    }

    /// Forces of the closed rigid joints at the solution.
    #[inline(always)]
    pub(super) fn finish_contacts(&mut self, tangents: &mut Tangents) {
        for (c, &[a, b]) in self.contacts.sides.iter().enumerate() {
            if tangents.contact[c] {
                let w = self.parting[c] + self.change[a as usize] - self.change[b as usize];
                tangents.reaction[c] = (tangents.reaction[c] + self.clamp * w).max(0.0);
                self.contact_residual = self.contact_residual.max(w.abs());
            } else {
                tangents.reaction[c] = 0.0;
            }
        }
    }

    /// Gives blocks that stick together one acceleration [m/s²], that of the support if they stick to one.
    pub fn join(&mut self, system: &System, tangents: &Tangents, acceleration: &mut [f64]) {
        if !self.rubs.sticking.is_empty() || self.contacts.len() > 0 {
            self.groups.find(system, &tangents.stuck, &tangents.contact);
            self.groups.average(&system.mass, acceleration);
        }
    }
}
