//! Impacts of joints that rock from one end to the other, and lose more than a push at the end that lands can take.
//!
//! Where no end rebounds and none slides, an impact leaves (i + cos 2α)/(1 + i) of the angular velocity of a block (Housner
//! 1963), because the push acts at the end that lands. Where less is known to be left, the end that opens is held back: with
//! ℓ the approach that the laws take from the landing end in a step, u_n^ℓ the parting velocity there and b ≥ 0 what its gap leaves of its approach,
//!
//! (P8)  u_n − u_n^ℓ ≤ max(u_n⁻, 0) + η ℓ + b
//!
//! at the other one, which is pulled in the impact as the end that lands is pushed, against the motion. For a block on its base η is what
//! is left of its angular velocity, unless the impact itself leaves less; more it cannot leave.

use super::Motion;
use crate::G;
use crate::contact::Contact;

/// Approach of an end that stands, over the velocity that gravity gives in a step or with which the other end parts: above what contact may be
/// violated by, and ten times what stones yield by under their own weight.
const STANDING: f64 = 1e-3;
/// The same over the approach of the end that lands: the end that a block turns on yields to its turn, back and forth in parts of a step.
const PIVOTS: f64 = 1e-2;

/// What holds the turn of a joint back during one step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hold {
    /// Its contact among the others.
    opens: usize,
    /// Its velocity along the line of the hold at the start of the step [m/s].
    before: f64,
    /// As of [`super::Owner`].
    lever: f64,
}

impl Motion {
    /// Holds for ends that open as the other end of their joint lands, after the contacts of all else.
    pub(super) fn hold_back(&mut self, h: f64) {
        self.holds.clear();
        if !self.rocks || self.setting.still {
            return;
        }
        for first in 0..self.owners.len() {
            let own = self.owners[first].pair;
            if first > 0 && self.owners[first - 1].pair == own {
                continue;
            }
            let pair = &self.pairs[own];
            let Some(rocking) = self.laws.of(pair.link).rocking() else { continue };
            // What a bond holds does not rock.
            if pair.crack.as_ref().is_some_and(|crack| !crack.is_gone()) {
                continue;
            }
            let last = first + self.owners[first..].iter().take_while(|owner| owner.pair == own).count() - 1;
            for (lands, opens) in [(first, last), (last, first)] {
                if let Some((contact, hold)) = self.hold_of(lands, opens, rocking, h) {
                    self.contacts.push(contact);
                    self.holds.push(hold);
                }
            }
        }
    }

    /// None where this is no rocking impact: the one end does not land, or the other does too or was far off.
    fn hold_of(&self, lands: usize, opens: usize, rocking: f64, h: f64) -> Option<(Contact, Hold)> {
        // A bias above 0 is what a gap still allows, one below 0 a rebound.
        let approach = |k: usize| {
            let u = self.owners[k].start.velocity[0];
            if u < 0.0 { -u - self.contacts[k].bias.max(0.0) } else { 0.0 }
        };
        let lost = approach(lands);
        let end = &self.owners[opens];
        let parting = end.start.velocity[0].max(0.0);
        // Parts of a step ask as the whole does.
        let whole = self.setting.step.max(h);
        let slow = STANDING * parting.max(G * whole);
        let near = end.start.gap <= whole * (parting - self.owners[lands].start.velocity[0]);
        if !(lost > slow && approach(opens) <= slow.max(PIVOTS * lost) && near) {
            return None;
        }
        // By how much faster the end that lands parts than the one that opens.
        let [to, from] = [&self.contacts[lands], &self.contacts[opens]];
        let line = [0, 1].map(|body| std::array::from_fn(|k| to.rows.normal[body][k] - from.rows.normal[body][k]));
        let mut contact = Contact::along((from.rows.first(), from.rows.second()), from.slot, line, &self.inverse, 0.0);
        contact.law[0].rho = self.setting.firm(whole) * contact.moved[0];
        contact.drift[0] = to.drift[0] - from.drift[0];
        contact.bias = parting + rocking * lost + to.bias.max(0.0);
        let [to, from] = [&self.owners[lands], end];
        let before = to.start.velocity[0] - from.start.velocity[0];
        Some((contact, Hold { opens, before, lever: to.lever[0] - from.lever[0] }))
    }

    /// Accounts for what holds take, and tells it of their joints.
    pub(super) fn settle_holds(&mut self, h: f64) {
        let own = self.owners.len() + self.pulls.len();
        for (contact, hold) in self.contacts[own..].iter().zip(&self.holds) {
            let after = contact.velocity(&self.after)[0];
            let taken = -contact.impulse[0] * 0.5 * (hold.before + after);
            self.account.impact += taken;
            self.pull -= contact.impulse[0] * hold.lever / h;
            if let Some(link) = self.pairs[self.owners[hold.opens].pair].link {
                self.seen[link].taken += taken;
            }
        }
    }
}
