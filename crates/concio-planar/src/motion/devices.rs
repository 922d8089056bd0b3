//! Devices with laws of their own in the steps of a motion: linear about a velocity for one solution, and about what it gives for the next, until both
//! are the same.
//!
//! A device follows its law along the straight way of a step, however far that goes, and bears the mean of it: what it stores and loses is
//! its work. Lines are tangents at first; where these go in circles, as at a corner, they are so steep that they cannot.

use super::Motion;
use crate::contact::{Contact, Effort, Linear, worse};
use crate::joint::{Device, Slope};

/// Solutions for tangents, and at most.
const TANGENTS: usize = 8;
const MOST: usize = 60;

/// A contact with such a device.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bent {
    contact: usize,
    device: Device,
    /// What acts beside the device in its direction.
    beside: Linear,
}

impl Bent {
    pub(super) fn of(device: &Device, number: usize, contact: &Contact) -> Self {
        Bent { contact: number, device: *device, beside: contact.spring[device.direction] }
    }
}

impl Motion {
    /// Lines about the velocities of before.
    pub(super) fn begin_devices(&mut self, h: f64) {
        for k in 0..self.bent.len() {
            let Bent { contact, device, .. } = self.bent[k];
            let after = self.owners[contact].start.velocity[device.direction];
            self.bend(k, h, after, Slope::Tangent);
        }
    }

    /// Solves again until the lines are those of the solution, after a first one that took `effort`.
    pub(super) fn follow_devices(&mut self, h: f64, effort: Effort) -> Effort {
        let mut effort = effort;
        for round in 0.. {
            let slope = if round < TANGENTS { Slope::Tangent } else { Slope::Steep };
            let mut missed = 0.0;
            for k in 0..self.bent.len() {
                let Bent { contact, device, .. } = self.bent[k];
                let after = self.contacts[contact].velocity(&self.after)[device.direction];
                missed = worse(missed, self.bend(k, h, after, slope));
            }
            if !(missed > self.setting.tolerance) || round == MOST {
                effort.residual = worse(effort.residual, missed);
                break;
            }
            effort = effort.then(self.solve());
        }
        effort
    }

    /// Makes a device linear about the velocity `after` at the end of the step [m/s]; returns by how much the line of before missed it there
    /// [m/s].
    fn bend(&mut self, k: usize, h: f64, after: f64, slope: Slope) -> f64 {
        let Bent { contact, device, beside } = self.bent[k];
        let owner = &self.owners[contact];
        let pair = &self.pairs[owner.pair];
        let law = pair.link.map_or(&self.other, |k| &self.links[k].law);
        let contact = &mut self.contacts[contact];
        let spring = &mut contact.spring[device.direction];
        let line = Linear { offset: spring.offset - beside.offset, rho: spring.rho - beside.rho };
        let point = (&pair.points[owner.point], owner.share);
        let (next, missed) = law.bent(&device, point, h, &owner.start, (after, slope), line);
        *spring = Linear { offset: beside.offset + next.offset, rho: beside.rho + next.rho };
        missed.abs() / contact.moved[device.direction]
    }
}
