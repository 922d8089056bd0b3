//! The end of a solution: Newton's method on (P2) and (P3) as they are, from an iterate of the interior point method.
//!
//! Near the solution it is known of nearly every bound whether it holds. With that taken for granted, the laws are linear; what then pulls at a
//! bound lets go, what passes one is held, and the next iterate solves again. A bound that neither holds nor is far away, as where a joint
//! is about to slide, costs the interior point method half a digit in each iteration, and here nothing. From afar this goes in circles, and
//! rigid contacts, which share impulses out among them, hold more bounds than there are velocities.

use super::{Group, Interior, Left, Method, Point, View, Way, soft};
use crate::blocks::{Blocks, Digits, Triple};
use crate::contact::{Contact, Effort, worse};

/// What may be left where it begins, over the tolerance.
pub(super) const NEAR: f64 = 1e4;
/// What is left then, over that, before it begins again.
pub(super) const AGAIN: f64 = 0.1;
/// Share of rigid contacts beyond which it does not begin.
const RIGID: f64 = 0.1;
/// Iterations at most, and those after which each has to leave less than the last.
const MOST: usize = 12;
const FREELY: usize = 3;

/// Whether so few contacts are rigid that impulses follow from velocities.
pub(super) fn may_end(contacts: &[Contact]) -> bool {
    let rubs = |c: &Contact| c.friction > 0.0 || c.hold > 0.0;
    let rigid = contacts.iter().filter(|c| !c.compliant[0] || (!c.compliant[1] && rubs(c))).count();
    (rigid as f64) < RIGID * contacts.len() as f64
}

impl Interior {
    /// Solves a step to `tolerance` [m/s] from where it is, with the bounds at first that the last direction tells (`led`). Where it does not
    /// converge, `v` and the points are as they were, but not what a look makes of them.
    pub(super) fn finish(
        &mut self,
        matrix: &mut Blocks,
        (mass, free): (&[Triple], &[Triple]),
        contacts: &[Contact],
        v: &mut [Triple],
        tolerance: f64,
        led: bool,
    ) -> Effort {
        let mut effort = Effort::default();
        self.before.clear();
        self.before.extend_from_slice(v);
        self.usual.keep();
        self.limited.keep();
        let mut last = f64::INFINITY;
        for k in 0..=MOST {
            let method = Method::AtBounds { led: led && k == 0 };
            let Left { residual: left, drawn, .. } = self.look(matrix, (mass, free), contacts, v, method);
            if left <= tolerance {
                effort.residual = worse(left, drawn);
                if drawn <= tolerance {
                    self.usual.settle(contacts, v);
                    self.limited.settle(contacts, v);
                    effort.converged = true;
                    return effort;
                }
                self.usual.anchor(contacts);
                self.limited.anchor(contacts);
                effort.rounds += 1;
                last = f64::INFINITY;
                continue;
            }
            let falls = k <= FREELY || left < last;
            if k == MOST || !left.is_finite() || !falls {
                break;
            }
            last = left;
            effort.iterations += 1;
            self.begin_right_side();
            matrix.factorise_and_solve(&mut self.step, &mut self.work, Digits::All);
            self.usual.jump(&self.step);
            self.limited.jump(&self.step);
            for (v, step) in v.iter_mut().zip(&self.step) {
                (0..3).for_each(|k| v[k] += step[k]);
            }
        }
        v.copy_from_slice(&self.before);
        self.usual.restore();
        self.limited.restore();
        effort
    }
}

impl<const N: usize> Group<N> {
    fn keep(&mut self) {
        self.before.clear();
        self.before.extend(self.points.iter().map(|point| [point.p, point.anchor, point.soft]));
    }

    fn restore(&mut self) {
        for (point, before) in self.points.iter_mut().zip(&self.before) {
            [point.p, point.anchor, point.soft] = *before;
        }
    }

    fn jump(&mut self, step: &[Triple]) {
        for ((point, view), rows) in self.points.iter_mut().zip(&self.views).zip(&self.rows) {
            let change = point.follows(view, rows.change(step), view.right);
            (0..2).for_each(|k| point.p[k] += change[k]);
        }
    }

    /// Distances and multipliers of the impulses as they are.
    fn settle(&mut self, contacts: &[Contact], v: &[Triple]) {
        for (point, which) in self.points.iter_mut().zip(&self.which) {
            let contact = &contacts[*which as usize];
            point.settle(contact, contact.velocity(v));
        }
    }
}

impl<const N: usize> Point<N> {
    /// Which bounds hold by the last direction: those whose distance falls faster than the multiplier (El-Bakry, Tapia and Zhang 1994).
    fn led(&self, way: &Way<N>) -> [bool; N] {
        std::array::from_fn(|i| self.on[i] && self.lambda[i] * way.s[i] < self.s[i] * way.lambda[i])
    }

    /// What it leaves of (P2) and (P3) at the velocity `u`, and what impulses do where the bounds hold that hold by impulses and velocities now,
    /// or by the last direction.
    pub(super) fn choose(
        &mut self,
        contact: &Contact,
        u: [f64; 2],
        way: Option<&mut Way<N>>,
        view: &mut View<N>,
        left: &mut Left,
    ) {
        let [least, most] = contact.pressure;
        let pressed = self.p[0] + contact.spring[0].at(u[0]);
        let mu = if self.dry || pressed > 0.0 { contact.friction } else { 0.0 };
        let by_way = way.is_some();
        let led = way.map_or([false; N], |way| self.led(way));
        (view.response, view.right) = ([0.0; 3], [0.0; 2]);
        if self.moves[0] {
            let off = u[0] + contact.bias + self.shift(0);
            let tends = self.p[0] - self.mass * off;
            left.residual = worse(left.residual, (self.p[0] - tends.clamp(least, most)).abs() / self.mass);
            let held = match by_way {
                true => [led[2], N > 3 && led[N - 1]],
                false => [tends <= least, tends >= most],
            };
            match held {
                [true, _] => view.right[0] = least - self.p[0],
                [_, true] => view.right[0] = most - self.p[0],
                _ => {
                    view.response[0] = 1.0 / self.soft[0];
                    view.right[0] = -off / self.soft[0];
                }
            }
            if !contact.compliant[0] {
                left.drawn = left.drawn.max(self.shift(0).abs());
            }
        }
        if self.rubs {
            if self.soft[1] == 0.0 {
                self.soft[1] = soft(contact, 1);
            }
            let bound = (mu * pressed).max(0.0) + contact.hold;
            let off = u[1] + self.shift(1);
            let tends = self.p[1] - contact.moved[1] * off;
            left.residual = worse(left.residual, (self.p[1] - tends.clamp(-bound, bound)).abs() / contact.moved[1]);
            let slides = match (by_way && self.on[0], led[0] && led[1]) {
                (true, true) => [tends > 0.0, tends <= 0.0],
                (true, false) => [led[0], led[1]],
                _ => [tends >= bound, tends <= -bound],
            };
            let to = |sign: f64| sign * (mu * pressed + contact.hold) - self.p[1] + sign * mu * view.right[0];
            match slides {
                [true, _] => (view.response[2], view.right[1]) = (-mu, to(1.0)),
                [_, true] => (view.response[2], view.right[1]) = (mu, to(-1.0)),
                _ => {
                    view.response[1] = 1.0 / self.soft[1];
                    view.right[1] = -off / self.soft[1];
                }
            }
            if !contact.compliant[1] {
                left.drawn = left.drawn.max(self.shift(1).abs());
            }
        }
    }

    fn settle(&mut self, contact: &Contact, u: [f64; 2]) {
        let bound = contact.bound(self.p[0], u[0]);
        let grips = self.rubs && (self.dry || bound > 0.0);
        (self.moves[1], self.on[0], self.on[1]) = (grips, grips, grips);
        self.s = self.far(contact, bound).map(|s| s.max(0.0));
        self.lambda = self.wanted(contact, u).map(|l| l.max(0.0));
    }
}
