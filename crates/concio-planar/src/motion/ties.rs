//! Ties in the steps of a motion: one contact each, in compression only along the line that its ends approach each other on.

use super::{Motion, Push};
use crate::contact::Contact;
use crate::joint::{Law, Start};
use crate::shape::Place;
use crate::tie::{Strain, Tie};

/// A tie during a motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rod {
    pub(super) tie: Tie,
    law: Law,
    /// Length from which it bears, ℓ_0 + s of (P7) [m].
    reach: f64,
}

/// Where the contact of a tie comes from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pull {
    rod: usize,
    pub(super) start: Start,
    /// Unit vector from its second end to the first, in the middle of the step.
    line: [f64; 2],
    /// As of [`Owner`].
    lever: f64,
}

impl Motion {
    /// Contacts of the ties, after those of the pairs.
    pub(super) fn fasten(&mut self, h: f64, held: [f64; 2]) {
        self.pulls.clear();
        for number in 0..self.rods.len() {
            if let Some((contact, pull)) = self.pull_of(number, h, held) {
                self.contacts.push(contact);
                self.pulls.push(pull);
            }
        }
    }

    /// None for a tie whose ends have come to the same place: it has no direction, and is slack.
    fn pull_of(&self, number: usize, h: f64, held: [f64; 2]) -> Option<(Contact, Pull)> {
        let Rod { tie, law, reach } = &self.rods[number];
        let middle = |body: usize| {
            let (place, v, fixed) = (self.places[body], self.velocities[body], self.held[body]);
            let way = [if fixed[0] { held[0] } else { v[0] }, v[1], v[2]].map(|v| 0.5 * h * v);
            Place { centre: [place.centre[0] + way[0], place.centre[1] + way[1]], angle: place.angle + way[2] }
        };
        let (a, b) = (tie.a.map(middle), middle(tie.b));
        let (line, _) = between(ends_of(tie, a.as_ref(), &b))?;
        let on_b = self.push(tie.b, turned(&b, tie.at[1]), line);
        let away = line.map(|d| 0.0 - d);
        let on_a = match (tie.a, &a) {
            (Some(body), Some(place)) => self.push(body, turned(place, tie.at[0]), away),
            _ => Push { row: [0.0; 3], velocity: 0.0, lever: 0.0 },
        };
        let strain = &self.strains[number];
        let slot = tie.a.map(|a| self.solver.matrix().slot(a, tie.b));
        let rows = [on_a.row, on_b.row];
        let mut contact = Contact::along((tie.a, tie.b), slot, rows, &self.inverse, h * strain.point.force[0]);
        let lever = on_a.lever + on_b.lever;
        contact.drift[0] = lever * held[1];
        let closing = on_a.velocity + on_b.velocity + lever * held[0];
        let (_, length) = between(ends_of(tie, tie.a.map(|a| &self.places[a]), &self.places[tie.b]))?;
        let start = law.begin(
            &strain.point,
            1.0,
            h,
            (self.setting.still, self.setting.firm(h), contact.moved[0]),
            (reach - length, [closing, 0.0]),
            &mut contact,
        );
        Some((contact, Pull { rod: number, start, line, lever }))
    }

    /// Keeps what the ties have come to, and accounts for their energy.
    pub(super) fn settle_ties(&mut self, h: f64) {
        for strain in &mut self.strains {
            (strain.point.force, strain.pull) = ([0.0; 2], [0.0; 2]);
        }
        for (contact, pull) in self.contacts[self.owners.len()..].iter().zip(&self.pulls) {
            let strain = &mut self.strains[pull.rod];
            let after = contact.velocity(&self.after);
            let law = &self.rods[pull.rod].law;
            let works = law.end(&mut strain.point, 1.0, h, &pull.start, after, contact);
            strain.pull = pull.line.map(|d| d * contact.impulse[0] / h);
            self.account.elastic += works.elastic;
            self.account.impact += works.impact;
            self.account.device += works.bond;
            self.pull -= contact.impulse[0] * pull.lever / h;
        }
    }

    /// By how much a tie has yielded [m].
    pub(super) fn yielded(&self, pull: &Pull) -> f64 {
        self.strains[pull.rod].yielded()
    }

    /// The ties and what has become of them.
    pub fn ties(&self) -> impl Iterator<Item = (&Tie, &Strain)> {
        self.rods.iter().map(|rod| &rod.tie).zip(&self.strains)
    }
}

impl Rod {
    /// As the bodies are laid.
    pub(super) fn new(tie: &Tie, laid: &[Place]) -> Self {
        let length = between(ends_of(tie, tie.a.map(|a| &laid[a]), &laid[tie.b])).map_or(0.0, |(_, length)| length);
        Rod { tie: *tie, law: tie.law(), reach: length + tie.slack }
    }
}

/// A point of a body from its centre, turned with it [m].
fn turned(place: &Place, at: [f64; 2]) -> [f64; 2] {
    let (s, c) = place.angle.sin_cos();
    [c * at[0] - s * at[1], s * at[0] + c * at[1]]
}

/// Ends of a tie [m], its bodies being there.
fn ends_of(tie: &Tie, a: Option<&Place>, b: &Place) -> [[f64; 2]; 2] {
    let end = |place: &Place, at| {
        let arm = turned(place, at);
        [place.centre[0] + arm[0], place.centre[1] + arm[1]]
    };
    [a.map_or(tie.at[0], |a| end(a, tie.at[0])), end(b, tie.at[1])]
}

/// Unit vector from the second of two points to the first, and their distance [m]; none where they are one.
fn between([a, b]: [[f64; 2]; 2]) -> Option<([f64; 2], f64)> {
    let way = [a[0] - b[0], a[1] - b[1]];
    let length = way[0].hypot(way[1]);
    (length > 0.0).then(|| (way.map(|w| w / length), length))
}
