//! What happens at an instant and counts: an impact, friction that falls or turns round, a bond that breaks.
//!
//! A step moves bodies by the mean of their velocities before and after it, and what acts in it acts until its end. Where such an instant
//! changes much, its step is taken in parts, so that it comes within a short one.

use super::{Motion, Owner, Pull};
use crate::G;
use crate::blocks::Triple;
use crate::contact::Contact;
use crate::crack::Crack;
use crate::joint::{Law, Part, Point, RESTING, Start, slides};

/// Part of the energy of motion from which landing counts, and what counts as motion at least, over the velocity that gravity gives in a
/// step: stones that settle are no landing.
const LANDING: f64 = 0.02;
const SETTLES: f64 = 5.0;
/// Part of the energy of motion from which what bonds take in a step counts, how long it goes on to, and what counts as motion at least, over the velocity
/// that gravity gives in that time [s]: short steps need no parts.
const SPENT: f64 = 0.01;
const RINGS: f64 = 5e-3;
/// How many steps, or parts of steps, ahead it is looked whether a load crushes a joint as a whole: how it swings until then decides how far.
const NEARS: f64 = 50.0;
/// What a joint bears before it closes, over all that it takes as it closes and over the energy of motion, from which it counts; for ties the second limit alone holds.
const EARLY: f64 = 0.01;
const EARLY_COUNTS: f64 = 1e-5;
/// What is crushed of an edge in a whole step, over what its springs are pressed in by where that begins, from which it counts.
const FAST: f64 = 0.02;
/// Force that falls at once over weight and load, from which it counts.
const GIVES_WAY: f64 = 0.05;
/// Part by which what a rigid point bears grows in half a step at most where it grows on so.
const STEADY: f64 = 0.2;
/// Friction that is wrong in a slide that turns round over all friction in a whole step, from which it counts.
const TURNS: f64 = 0.05;
/// Part by which the shear of a bonded rigid joint is below its strength where it breaks.
const SHEARED: f64 = 1e-9;

impl Motion {
    /// Whether something happens at an instant of the step of `h` [s], as it was solved, that counts.
    pub(super) fn jolts(&self, h: f64) -> bool {
        !self.setting.still
            && (self.lands() || self.closes_early(h) || self.sudden && self.lets_go(h) || self.turns_round(h))
    }

    /// Whether so much is lost as rigid joints close in the step that it counts when in it they do.
    fn lands(&self) -> bool {
        let closing = |(_, owner): &(&Contact, &Owner)| {
            let link = self.pairs[owner.pair].link;
            owner.start.velocity[0] < 0.0 && !self.laws.part(link, owner.part).is_compliant()
        };
        let lost = |(contact, owner): (&Contact, &Owner)| {
            -0.5 * contact.impulse[0] * (owner.start.velocity[0] + contact.velocity(&self.after)[0])
        };
        let lost: f64 = self.contacts.iter().zip(&self.owners).filter(closing).map(lost).sum();
        lost > LANDING * self.energy_of_motion(SETTLES * self.setting.step)
    }

    /// Energy of motion, at least that of what has fallen for so long [s, J].
    fn energy_of_motion(&self, settling: f64) -> f64 {
        self.kinetic() + 0.5 * self.weight * G * settling * settling
    }

    /// Whether bonds take so much of the motion in a step of `h` [s] that it counts how what they held rings then, or a joint nears its strength as a whole; or did a
    /// little before. After the first halvings, of a step that is not as long (`soon`), only the joint counts: how its spring swings takes shorter ones.
    pub(super) fn rings(&mut self, h: f64, soon: bool) -> bool {
        if self.setting.still {
            return false;
        }
        let nears = self.crushes && self.nears_crushing(h);
        if nears || soon && self.spent() > SPENT * self.energy_of_motion(RINGS) {
            self.rings_until = self.time + RINGS;
        }
        nears || soon && (self.time < self.rings_until || self.crushes && self.crushes_fast(h))
    }

    /// Whether joints that were crushed, or slack ties, bear so much before they close that it counts: what closes in a step bears in all of it, so that a joint
    /// is spared crushing and a tie pulls too soon. Other joints are not asked: their springs ring in shorter steps.
    fn closes_early(&self, h: f64) -> bool {
        let crushing = |(_, owner): &(&Contact, &Owner)| {
            owner.part == Part::Dry && self.pairs[owner.pair].crack.as_ref().is_some_and(Crack::is_crushed)
        };
        let took = |contact: &Contact, start: &Start, crushed: f64| {
            let way = -0.5 * h * (start.velocity[0] + contact.velocity(&self.after)[0]);
            let force = contact.impulse[0] / h;
            [force * (start.gap + crushed).min(way).max(0.0), (force * way).max(0.0)]
        };
        let counts =
            |early: f64| early > 0.0 && early > EARLY_COUNTS * self.energy_of_motion(SETTLES * self.setting.step);
        let sum = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        let (joints, ties) = self.contacts.split_at(self.owners.len());
        let of_joint = |(contact, owner): (&Contact, &Owner)| {
            took(contact, &owner.start, self.pairs[owner.pair].points[owner.point].crushed)
        };
        let of_tie = |(contact, pull): (&Contact, &Pull)| took(contact, &pull.start, self.yielded(pull));
        let [early, _] = ties.iter().zip(&self.pulls).map(of_tie).fold([0.0; 2], sum);
        if counts(early) || !self.crushes {
            return counts(early);
        }
        let [early, all] = joints.iter().zip(&self.owners).filter(crushing).map(of_joint).fold([0.0; 2], sum);
        early > EARLY * all && counts(early)
    }

    /// Whether the edge of some joint is crushed so fast in a step of `h` [s] that it counts how what bears there changes meanwhile.
    fn crushes_fast(&self, h: f64) -> bool {
        let part = FAST * h / self.setting.step;
        self.any_crushing(h, |crack, law, _, gaps| crack.crushes_by(law, gaps(1.0)) > part)
    }

    /// Whether some joint is crushed soon as a whole if what presses it goes on to grow as in this step of `h` [s].
    fn nears_crushing(&self, h: f64) -> bool {
        let mut at = 0;
        self.owners.chunk_by(|a, b| a.pair == b.pair).any(|owners| {
            let contacts = &self.contacts[at..at + owners.len()];
            at += owners.len();
            let link = self.pairs[owners[0].pair].link;
            let strength = self.laws.of(link).crushing;
            let Some(link) = link.filter(|link| strength.is_finite() && self.seen[*link].touches) else { return false };
            let pressed =
                contacts.iter().map(|contact| contact.total(contact.velocity(&self.after))[0]).sum::<f64>() / h;
            pressed + NEARS * (pressed - self.seen[link].pressure) > strength
        })
    }

    /// Whether slides turn round in the step so that friction, which acts one way in all of it, is wrong by so much that it counts. What stones that
    /// flutter do to each other cancels.
    fn turns_round(&self, h: f64) -> bool {
        // What a bond bears is no friction.
        let rubs = || self.contacts.iter().zip(&self.owners).filter(|(_, owner)| owner.part != Part::Held);
        let most = |contact: &Contact, after: [f64; 2]| contact.bound(contact.impulse[0], after[0]);
        let turned = |(contact, owner): (&Contact, &Owner)| {
            let (before, after) = (owner.start.velocity[1], contact.velocity(&self.after));
            friction_turned(contact, before, after, most(contact, after), h)
        };
        // What rested does not turn round.
        let slid = rubs().filter(|(_, owner)| owner.start.velocity[1].abs() > RESTING * G * h);
        let wrong: f64 = slid.map(turned).sum();
        if wrong == 0.0 {
            return false;
        }
        let all: f64 = rubs().map(|(contact, _)| most(contact, contact.velocity(&self.after))).sum();
        wrong.abs() * h > TURNS * all * self.setting.step
    }

    /// Whether so much falls at once in the step, of friction at rest and of what rigid bonds bear, that it counts when in it that happens.
    fn lets_go(&self, h: f64) -> bool {
        let (counts, mut falls, mut at) = (GIVES_WAY * self.bears * h, 0.0, 0);
        for owners in self.owners.chunk_by(|a, b| a.pair == b.pair) {
            let pair = &self.pairs[owners[0].pair];
            let contacts = &self.contacts[at..at + owners.len()];
            let law = self.laws.of(pair.link);
            at += owners.len();
            // A step bears what acts in its middle: by its end that has gone on to grow.
            let ahead = |contact: &Contact, owner: &Owner| {
                [0, 1].map(|k| contact.impulse[k] + 0.5 * (contact.impulse[k] - h * pair.points[owner.point].force[k]))
            };
            falls += self.friction_falls(contacts, owners, h, &ahead);
            let Some(crack) = pair.crack.as_ref().filter(|_| !law.is_compliant()) else { continue };
            let bears = bears_more(law, contacts, owners);
            let force = |point: usize| {
                let own = owners.iter().zip(contacts).filter(|(owner, _)| owner.point == point);
                let sum = |sum: [f64; 2], p: [f64; 2]| [sum[0] + p[0] / h, sum[1] + p[1] / h];
                own.map(|(owner, contact)| ahead(contact, owner)).fold([0.0; 2], sum)
            };
            if bears > 0.0 && crack.breaks_rigid(law, &force, bond_slides(law, contacts, owners, ahead)) {
                falls += bears;
            }
        }
        falls > counts
    }

    /// By how much the friction of a joint falls as points of it begin to slide in the step, or at its end by what they bear `ahead` there [N s].
    fn friction_falls(
        &self,
        contacts: &[Contact],
        owners: &[Owner],
        h: f64,
        ahead: &impl Fn(&Contact, &Owner) -> [f64; 2],
    ) -> f64 {
        let pair = &self.pairs[owners[0].pair];
        let compliant = self.laws.of(pair.link).is_compliant();
        let gives = |(contact, owner): &(&Contact, &Owner)| {
            let after = contact.velocity(&self.after);
            let [across, along] = ahead(contact, owner);
            // What a rigid joint bore as a slide turned round says nothing of what is to come.
            let steady = compliant || (along - contact.impulse[1]).abs() <= STEADY * contact.impulse[1].abs();
            slides(contact, after[1], h) || steady && along.abs() > contact.bound(across, after[0])
        };
        let own = || contacts.iter().zip(owners);
        let falls = |(contact, owner): (&Contact, &Owner)| {
            let law = self.laws.part(pair.link, owner.part);
            // What a bond lets go is known as a whole.
            let falls = falls_by(law, &pair.points[owner.point]).filter(|_| owner.part != Part::Held)?;
            gives(&(contact, owner)).then_some(falls * contact.impulse[0])
        };
        let falls = own().filter_map(falls).sum();
        // A rigid joint slides as a whole: one end that bears little gives way first by what the other yields.
        let begins = || compliant || own().all(|both| both.0.impulse[0] == 0.0 || gives(&both));
        if falls > 0.0 && begins() { falls } else { 0.0 }
    }
}

/// By how much the friction of a contact that slid at `before` is wrong where it turns round in the step, slowed down and then pushed the other
/// way beyond friction: what slides has the mass that presses it, and is pushed evenly. Its sign is that of `before` [N s].
fn friction_turned(contact: &Contact, before: f64, after: [f64; 2], most: f64, h: f64) -> f64 {
    let bears = contact.impulse[1] * before.signum();
    let mass = contact.total(after)[0].max(0.0) / (G * h);
    let stopped = mass * before.abs();
    let push = bears + stopped - mass * after[1] * before.signum();
    // Part of the step before it turns.
    let part = stopped / (push + most);
    // Friction in line with a spring that takes the whole step or more to turn it round does not turn at once: the step resolves it.
    let at_once = contact.law[1].rho * (before - after[1]).abs() > 2.0 * most;
    let turns = at_once && push > most && part < 1.0;
    if turns { (bears - most * (1.0 - 2.0 * part)).copysign(before) } else { 0.0 }
}

/// By how much the friction coefficient of a point at rest falls as it begins to slide, if it does.
pub(super) fn falls_by(law: &Law, point: &Point) -> Option<f64> {
    let friction = law.friction.filter(|_| point.speed == 0.0)?;
    let falls = friction.static_ - friction.slowly(true);
    (falls > 0.0).then_some(falls)
}

/// Whether a rigid joint slides at all of its contacts that bear, `at` being one of them: one that bears little gives way first by what the other yields.
pub(super) fn slides_whole(at: usize, contacts: &[Contact], owners: &[Owner], after: &[Triple], h: f64) -> bool {
    let pair = owners[at].pair;
    let before = owners[..at].iter().rev().take_while(|other| other.pair == pair).count();
    let own = contacts[at - before..].iter().zip(&owners[at - before..]).take_while(|(_, other)| other.pair == pair);
    own.into_iter().all(|(c, _)| c.impulse[0] == 0.0 || slides(c, c.velocity(after)[1], h))
}

/// Whether a bonded rigid joint with these contacts, which bear so much, is torn or sheared through. How rigid points share the shear is not
/// known: the joint has its strength as a whole.
pub(super) fn bond_slides(
    law: &Law,
    contacts: &[Contact],
    owners: &[Owner],
    borne: impl Fn(&Contact, &Owner) -> [f64; 2],
) -> bool {
    let (mut pressed, mut shear, mut strength, mut torn) = (0.0, 0.0, 0.0, [false, true]);
    for (contact, owner) in contacts.iter().zip(owners).filter(|(_, owner)| owner.part == Part::Held) {
        let [across, along] = borne(contact, owner);
        pressed += across;
        shear += along;
        strength += contact.hold;
        if contact.pressure[0] < 0.0 {
            torn = [true, torn[1] && across <= contact.pressure[0]];
        }
    }
    let tan = law.bond.map_or(0.0, |bond| if pressed < 0.0 { bond.tan_pulled() } else { bond.tan_angle });
    strength += tan * pressed;
    torn == [true; 2] || strength.is_finite() && shear.abs() >= strength * (1.0 - SHEARED) && shear != 0.0
}

/// What a bonded rigid joint with these contacts bears beyond what it would without bond: its pull, and its shear beyond friction [N s].
fn bears_more(law: &Law, contacts: &[Contact], owners: &[Owner]) -> f64 {
    let held = contacts.iter().zip(owners).filter(|(_, owner)| owner.part == Part::Held).map(|(contact, _)| contact);
    let [pressed, pulled, shear] = held.fold([0.0; 3], |[p, q, s], contact| {
        let [across, along] = contact.impulse;
        [p + across.max(0.0), q + (-across).max(0.0), s + along]
    });
    let friction = law.friction.map_or(0.0, |friction| friction.static_);
    pulled + (shear.abs() - friction * pressed).max(0.0)
}
