//! The end of a solution: Newton's method on (P4) as it is, from an iterate of the interior point method, or from what was borne before.
//!
//! Near the solution it is known of nearly every bound whether it holds. With that taken for granted, the laws are linear; what then pulls at a
//! bound lets go, what passes one is held, and the next iterate solves again. A bound that neither holds nor is far away, as where a joint
//! is about to slide, costs the interior point method half a digit in each iteration, and here nothing. From afar this goes in circles.

use super::{Interior, Method, Step, Whole};
use crate::blocks::{Blocks, Triple};
use crate::contact::{Contact, Effort};

/// What may be left where it begins, over the tolerance.
pub(super) const NEAR: f64 = 1e4;
/// Iterations at most. As many is the patience of interior points with what is left already so little that it may stay, and at most in a step that may
/// be halved.
pub(super) const MOST: usize = 12;
/// Iterations after which each has to leave less than the last, or let fewer contacts do something else than all before: in a large wall what is left
/// is that of one place, and rises there while the others settle.
const FREELY: usize = 3;
/// No more than one of so many contacts, those left out among them, may do something else than in the last look once patience is over: where more do, hardly any is solved.
pub(super) const SETTLED: usize = 10;

impl Interior {
    /// Solves a step from where it is, with the bounds at first that the last direction tells (`led`). Where it does not
    /// converge, `v` and the points are as they were.
    pub(super) fn finish(
        &mut self,
        matrix: &mut Blocks,
        &Step { bodies: (mass, free), tolerance, .. }: &Step,
        contacts: &[Contact],
        v: &mut [Triple],
        (led, patience): (bool, usize),
    ) -> Effort {
        let mut effort = Effort::default();
        self.before.clear();
        self.before.extend_from_slice(v);
        self.plain.keep();
        self.usual.keep();
        self.limited.keep();
        let (mut last, mut fewest) = (f64::INFINITY, usize::MAX);
        for k in 0..=MOST {
            let method = match k {
                0 => Method::AtBounds { led },
                _ => Method::Onwards,
            };
            let Whole { residual: left, changed, .. } = self.look(matrix, (mass, free), contacts, v, method);
            if left <= tolerance {
                effort.residual = left;
                self.plain.settle(v);
                self.usual.settle(contacts, v);
                self.limited.settle(contacts, v);
                effort.converged = true;
                return effort;
            }
            let far = k >= patience && changed * SETTLED > contacts.len();
            let falls = !far && (k <= FREELY || left < last || changed < fewest);
            if k > 0 {
                fewest = fewest.min(changed);
            }
            if k == MOST || !left.is_finite() || !falls {
                break;
            }
            last = left;
            effort.iterations += 1;
            self.begin_right_side();
            matrix.factorise_and_solve(&mut self.step, &mut self.work);
            self.leap(v);
        }
        v.copy_from_slice(&self.before);
        self.plain.restore();
        self.usual.restore();
        self.limited.restore();
        Effort { residual: f64::INFINITY, ..effort }
    }

    /// Goes all of the direction.
    fn leap(&mut self, v: &mut [Triple]) {
        self.plain.leap();
        self.usual.jump(&self.step);
        self.limited.jump(&self.step);
        for (v, step) in v.iter_mut().zip(&self.step) {
            (0..3).for_each(|k| v[k] += step[k]);
        }
        // Looks write where directions are.
        std::mem::swap(&mut self.step, &mut self.gone);
    }
}
