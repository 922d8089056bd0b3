//! Devices with laws of their own in the steps of a motion: linear about a velocity for one solution, and about what it gives for the next, until both
//! are the same.
//!
//! A device follows its law along the straight way of a step, however far that goes, and bears the mean of it: what it stores and loses is
//! its work. Lines are tangents at first; where these go in circles, as at a corner, chords of the last two iterates, and in the end lines so steep that
//! they cannot. Bonds that soften (`softening.rs`) are found in the same rounds.

use super::{Motion, softening};
use crate::contact::{Contact, Effort, Linear, worse};
use crate::joint::Device;

/// Solutions for tangents, for chords, and at most.
const TANGENTS: usize = 8;
const CHORDS: usize = 24;
const MOST: usize = 60;

/// A contact with such a device.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bent {
    contact: usize,
    device: Device,
    /// What acts beside the device in its direction.
    beside: Linear,
    /// Velocity at the end of the step [m/s] and impulse there [N s] that the line goes through.
    at: [f64; 2],
}

impl Bent {
    pub(super) fn of(device: &Device, number: usize, contact: &Contact) -> Self {
        Bent { contact: number, device: *device, beside: contact.spring[device.direction], at: [0.0; 2] }
    }
}

impl Motion {
    /// Lines about the velocities of before.
    pub(super) fn begin_devices(&mut self, h: f64) {
        for k in 0..self.bent.len() {
            let Bent { contact, device, .. } = self.bent[k];
            let after = self.owners[contact].start.velocity[device.direction];
            self.bend(k, h, after, 0);
        }
    }

    /// Solves again until the lines of devices and bonds are those of the solution, after a first one that took `effort`; no longer where contact stays unsolved.
    pub(super) fn follow_lines(&mut self, h: f64, halves: bool, effort: Effort) -> Effort {
        let mut effort = effort;
        for round in 0.. {
            let (mut missed, mut off) = (0.0, 0.0);
            for k in 0..self.bent.len() {
                let Bent { contact, device, .. } = self.bent[k];
                let after = self.contacts[contact].velocity(&self.after)[device.direction];
                missed = worse(missed, self.bend(k, h, after, round));
            }
            for k in 0..self.softens.len() {
                off = worse(off, self.softened(k, h, round));
            }
            if round == 0 && self.setting.still {
                self.uncracked = self.uncracked(h);
            }
            let part = self.setting.part(h);
            let solved = effort.residual <= part * self.setting.enough();
            self.astray = off > softening::OFF;
            let most = self.ahead() + if halves { softening::BETWEEN } else { softening::MOST };
            let settled = off <= softening::OFF || round >= most;
            let ends = missed <= part * self.setting.tolerance && settled;
            if !solved || ends || round == MOST {
                effort.residual = worse(effort.residual, missed);
                break;
            }
            self.soften();
            effort = effort.then(self.solve(h, halves));
        }
        effort
    }

    /// Makes a device linear about the velocity `after` at the end of the step [m/s]; returns by how much the line of before missed it there
    /// [m/s].
    fn bend(&mut self, k: usize, h: f64, after: f64, round: usize) -> f64 {
        let Bent { contact, device, beside, at } = self.bent[k];
        let owner = &self.owners[contact];
        let pair = &self.pairs[owner.pair];
        let law = self.laws.of(pair.link);
        let contact = &mut self.contacts[contact];
        let spring = &mut contact.spring[device.direction];
        let line = Linear { offset: spring.offset - beside.offset, rho: spring.rho - beside.rho };
        let of = |after: f64| law.borne(&device, (&pair.points[owner.point], owner.share), h, &owner.start, after);
        let borne = of(after);
        let missed = (borne.impulse - line.at(after)).abs() / contact.moved[device.direction];
        // The force of a dashpot with a power of the velocity is concave on either side of rest: tangents come nearer from rest, and never from
        // beyond. Where one has led through rest, the next is that at rest.
        let from = owner.start.velocity[device.direction];
        let viscous = device.law.is_viscous();
        let turned = viscous && round > 0 && (from + after) * (from + at[0]) < 0.0;
        let (after, borne) = if turned { (-from, of(-from)) } else { (after, borne) };
        let rho = match round {
            0..TANGENTS => borne.rho,
            TANGENTS..CHORDS if viscous => borne.rho,
            TANGENTS..CHORDS if after != at[0] => {
                ((at[1] - borne.impulse) / (after - at[0])).max(borne.rho).min(borne.steepest)
            }
            _ => borne.steepest,
        };
        self.bent[k].at = [after, borne.impulse];
        *spring = Linear { offset: beside.offset + borne.impulse + rho * after, rho: beside.rho + rho };
        missed
    }
}
