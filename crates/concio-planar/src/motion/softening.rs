//! Bonds that soften in a step, solved with what they lose in it.
//!
//! A bond is known as a step begins. If its springs bore what that has, a body that a load pushes slowly would stay on it, a little
//! farther stretched after each step, while the load grows. So what the bond loses on the straight way of the step
//! ([`crate::crack`]) is taken from its springs, which go on to resist with what does not soften, and the step is solved again
//! until both agree. With inertia it is the mean over the way, so that the work of the bond is what it stores and takes; without,
//! that at the end. Where the two do not agree, the step is taken in two halves. The shortest steps are solved with the bond as
//! it was at their start.

use super::Motion;
use crate::contact::{Effort, Linear, worse};
use crate::crack::{HELD, Softened, earlier};
use crate::joint::Part;

/// What the forces of a bond may be off by in a step, over what it would bear had nothing cracked, by the first solution.
pub(super) const OFF: f64 = 1e-3;
/// Rounds in which only what does not soften resists, rounds half-way to the whole stiffness, and most rounds: where the first go in circles, as over stiff
/// springs in long steps, the others come nearer each time.
const TANGENTS: usize = 16;
pub(super) const BETWEEN: usize = 24;
pub(super) const MOST: usize = 40;
/// Rounds with the whole stiffness ahead of these without inertia: they come to the nearest rest there is, which others may leap over.
const WHOLE: usize = 12;

/// What is left of a bond, at its two contact points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Softens {
    /// The first of its two contacts.
    contact: usize,
    /// What acts there across and along if nothing cracks.
    own: [[Linear; 2]; HELD],
    /// What is to act there in the next solution.
    next: [[Linear; 2]; HELD],
    /// What they would bear had nothing cracked, as the step was solved first [N s].
    borne: f64,
    /// What breaking takes in the step [J].
    taken: f64,
    /// How much of the step was over when a part of it broke at once.
    breaks_at: Option<f64>,
}

impl Motion {
    /// Rounds with the whole stiffness ahead of the others.
    pub(super) fn ahead(&self) -> usize {
        if self.setting.still { WHOLE } else { 0 }
    }

    /// Keeps the bond of a joint for this step, if its contacts, from `first` on, begin with the two that stand for one.
    pub(super) fn begin_softening(&mut self, first: usize) {
        let held = self.owners[first..].iter().take_while(|owner| owner.part == Part::Held).count();
        let own = |k: usize| self.contacts[first + k].spring;
        if held == HELD && self.laws.of(self.pairs[self.owners[first].pair].link).is_compliant() {
            let own = [own(0), own(1)];
            self.softens.push(Softens { contact: first, own, next: own, borne: 0.0, taken: 0.0, breaks_at: None });
        }
    }

    /// Finds what is left of a bond at the end of a step of `h` [s] as it was solved last; returns by how much what acts misses that, over what it would
    /// bear had nothing cracked.
    pub(super) fn softened(&mut self, bond: usize, h: f64, round: usize) -> f64 {
        let Softens { contact: first, own, .. } = self.softens[bond];
        let acts: [_; HELD] = std::array::from_fn(|k| self.contacts[first + k].spring);
        let pair = &self.pairs[self.owners[first].pair];
        let Some(crack) = &pair.crack else { return 0.0 };
        let after: [[f64; 2]; HELD] = std::array::from_fn(|k| self.contacts[first + k].velocity(&self.after));
        let stretched = |k: usize| {
            let owner = &self.owners[first + k];
            let before = [owner.start.gap, pair.points[owner.point].slide];
            [0, 1].map(|d| before[d] + 0.5 * h * (owner.start.velocity[d] + after[k][d]))
        };
        let ends = crack.line_of_held([stretched(0), stretched(1)]);
        let softened = crack.softened(self.laws.of(pair.link), &ends, self.setting.still);
        if softened.is_none() && acts == own {
            self.softens[bond].next = own;
            self.softens[bond].taken = 0.0;
            return 0.0;
        }
        let softened = softened.unwrap_or(Softened::NOTHING);
        let [near, far] = crack.held_at();
        let [whole, moment] = softened.across;
        let second = if far > near { (moment - near * whole) / (far - near) } else { 0.5 * whole };
        let lost =
            [[whole - second, 0.5 * softened.along], [second, 0.5 * softened.along]].map(|lost| lost.map(|f| h * f));
        let (mut missed, mut all) = (0.0, 0.0);
        for k in 0..HELD {
            for d in 0..2 {
                let (own, u) = (own[k][d], after[k][d]);
                let bears = own.at(u) + lost[k][d];
                missed = worse(missed, (bears - acts[k][d].at(u)).abs());
                all += own.at(u).abs();
                let rho = own.rho
                    * match round.checked_sub(self.ahead()) {
                        Some(0..TANGENTS) => softened.left[d][k],
                        Some(TANGENTS..BETWEEN) => 0.5 * (1.0 + softened.left[d][k]),
                        _ => 1.0,
                    };
                self.softens[bond].next[k][d] = Linear { offset: bears + rho * u, rho };
            }
        }
        let bond = &mut self.softens[bond];
        bond.taken = softened.taken;
        bond.breaks_at = softened.breaks_at;
        if bond.borne == 0.0 {
            bond.borne = all;
        }
        if bond.borne == 0.0 { 0.0 } else { missed / bond.borne }
    }

    /// Solves a step of `h` [s] with all bonds as they were at its start.
    pub(super) fn solve_as_it_was(&mut self, h: f64) -> Effort {
        for Softens { contact: first, own, .. } in &self.softens {
            (0..HELD).for_each(|k| self.contacts[first + k].spring = own[k]);
        }
        self.softens.clear();
        self.guess();
        let effort = self.solve(h, false);
        let effort = self.follow_lines(h, false, effort);
        self.count(effort);
        effort
    }

    /// What a step of `h` [s] without inertia bears as it is solved first, had nothing cracked in it: pull of what is held and base shear [N], and how much
    /// of it was over when a bond broke at once; none where none did.
    pub(super) fn uncracked(&self, h: f64) -> Option<([f64; 2], f64)> {
        let part = self.softens.iter().fold(None, |first, bond| earlier(first, bond.breaks_at))?;
        let mut borne = [-self.resisted(h), 0.0];
        for (contact, owner) in self.contacts.iter().zip(&self.owners) {
            let [across, along] = contact.total(contact.velocity(&self.after));
            borne[0] -= (across * owner.lever[0] + along * owner.lever[1]) / h;
            borne[1] -= if self.pairs[owner.pair].a.is_none() { along / h } else { 0.0 };
        }
        Some((borne, part))
    }

    /// By how much the pull of what is held and the base shear would be larger had nothing cracked in a step of `h` [s] [N].
    pub(super) fn softened_by(&self, h: f64) -> [f64; 2] {
        let mut more = [0.0; 2];
        for Softens { contact: first, own, .. } in &self.softens {
            for k in 0..HELD {
                let (contact, owner) = (&self.contacts[first + k], &self.owners[first + k]);
                let u = contact.velocity(&self.after);
                let lost = [0, 1].map(|d| (own[k][d].at(u[d]) - contact.spring[d].at(u[d])) / h);
                more[0] -= lost[0] * owner.lever[0] + lost[1] * owner.lever[1];
                more[1] -= if self.pairs[owner.pair].a.is_none() { lost[1] } else { 0.0 };
            }
        }
        more
    }

    /// What breaking takes of all bonds in the step, as it was solved last [J].
    pub(super) fn spent(&self) -> f64 {
        self.softens.iter().map(|bond| bond.taken).sum()
    }

    /// Has all bonds bear what was found.
    pub(super) fn soften(&mut self) {
        for Softens { contact: first, next, .. } in &self.softens {
            (0..HELD).for_each(|k| self.contacts[first + k].spring = next[k]);
        }
    }
}
