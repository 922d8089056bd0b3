//! The scale of a record at which a wall first lifts off: at rest all forces are linear in the ground's acceleration, so no run is needed.

use super::motion::Run;
use super::shaking::{Setting, Shaking};
use super::system::System;

/// Parts of the longest useful step of a motion in closed form: 400 in a period, of which the largest is within 4e-5 of the peak.
const FINER: f64 = 20.0;

/// A first lift-off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LiftOff {
    /// Factor of the motion, its own scale not counted.
    pub scale: f64,
    /// When [s].
    pub time: f64,
    /// Whether it turns outwards; inwards only where the wall rocks to both sides.
    pub outwards: bool,
}

impl System {
    /// Acceleration of the ground at which it sets off from rest to a side [m/s²], friction and pretension included.
    pub fn lifts_off_at(&self, side: usize) -> f64 {
        let forces = Run::at_rest(self).forces(side, 0.0, [0.0, 1.0]);
        (forces.rub - forces.push) / forces.terms.push
    }

    /// The least scale of a motion up to `end` at which the wall sets off.
    pub fn first_lift_off(&self, shaking: &Shaking, end: f64) -> Option<LiftOff> {
        let rest = Run::at_rest(self);
        let held: Vec<f64> = (0..self.sides.len()).map(|side| -rest.drives(side, [0.0, 1.0])).collect();
        let mut first: Option<LiftOff> = None;
        let mut t = 0.0;
        while t < end {
            let piece = shaking.piece(t);
            let until = piece.end.min(end);
            let steps = (until - t) / shaking.longest_step();
            let parts = if steps <= 1.0 + 1e-9 { 1 } else { (FINER * steps).ceil() as usize };
            for k in 0..=parts {
                let time = t + (until - t) * k as f64 / parts as f64;
                let at = piece.at(time);
                for (side, held) in held.iter().enumerate() {
                    let gained = rest.drives(side, at) + held;
                    let scale = held / gained;
                    if gained > 0.0 && first.is_none_or(|first| scale < first.scale) {
                        first = Some(LiftOff { scale, time, outwards: side == 0 });
                    }
                }
            }
            t = until;
        }
        first
    }
}

impl<'s> Run<'s> {
    /// A wall on a ground that does not move.
    pub(super) fn at_rest(system: &'s System) -> Self {
        let ground = Shaking::across(&concio_law::motion::AtRest, super::Positive::Inwards);
        Run::new(system, ground, &Setting::default(), 0.0)
    }
}
