//! The slowest small vibration of bodies about where they stand.

use super::{Motion, Owner};
use crate::blocks::Triple;
use crate::contact::Contact;
use crate::joint::Normal;

/// Relative change of ω² at which the iteration ends, its rounds, and the change that will do after them: two modes nearly as slow as each other are
/// told apart by and by, and what is found lies between them.
const SETTLED: f64 = 1e-11;
const ROUNDS: usize = 1000;
const NEAR: f64 = 1e-6;
/// What stands for a rigid contact, over the stiffest spring: many in a row give way by more, as do those of a tall stack, and are tried again stiffer.
const RIGID: [f64; 2] = [1e6, 1e9];
/// The part of a vibration's energy in rigid contacts above which they are not stiff enough, or nothing else swings.
const ALL: f64 = 1e-3;
/// Share of the largest impulse below which a contact counts as bearing nothing: rounding, and what a solution leaves.
const NOTHING: f64 = 1e-7;

/// A small vibration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vibration {
    /// Circular frequency ω [1/s].
    pub frequency: f64,
    /// Damping ratio by the dashpots.
    pub damping: f64,
}

/// A spring and a dashpot along a row of the two bodies.
struct Holds {
    rows: [Triple; 2],
    /// Whether nothing gives way, and the stiffness is to be that of the rigid.
    rigid: bool,
    stiffness: f64,
    damping: f64,
}

impl Motion {
    /// The slowest vibration about where the bodies stand after the last step, with the joints that bear there as they bear: springs in
    /// compression only where they are pressed, and friction holds, as it does at rest; rigid contacts that bear hold, along too where they rub. The
    /// weight's own stiffness is left out. None where nothing but rigid contacts would swing, or nothing holds a body.
    ///
    /// Inverse iteration with the Rayleigh quotient.
    pub fn slowest(&self) -> Option<Vibration> {
        let swings = |rigid: &f64| {
            let (found, inside) = self.swing(*rigid)?;
            (inside <= ALL).then_some(found)
        };
        RIGID.iter().find_map(swings)
    }

    /// The same with rigid contacts that are so many times as stiff as the stiffest spring, and the part of its energy that they have.
    fn swing(&self, stiffer: f64) -> Option<(Vibration, f64)> {
        let mut matrix = self.solver.matrix().clone();
        // What is held stays: any stiffness of its own does.
        let stays = |held: &[bool; 3]| [0, 1, 2].map(|k| if held[k] { 1.0 } else { 0.0 });
        matrix.reset(&self.held.iter().map(stays).collect::<Vec<_>>());
        let least = NOTHING * self.contacts.iter().fold(0.0, |most: f64, c| most.max(c.impulse[0].abs()));
        let held = || {
            self.contacts
                .iter()
                .zip(&self.owners)
                .map(|(contact, owner)| (contact, self.holding(contact, owner, least)))
        };
        let stiffest = held().flat_map(|(_, both)| both).fold(0.0, |most: f64, h| most.max(h.stiffness));
        let mut springs = Vec::new();
        for (contact, both) in held() {
            for mut holds in both {
                if holds.rigid {
                    holds.stiffness = stiffer * stiffest;
                }
                if holds.stiffness == 0.0 && holds.damping == 0.0 {
                    continue;
                }
                matrix.add(contact.rows.second(), holds.stiffness, holds.rows[1]);
                if let (Some(a), Some(slot)) = (contact.rows.first(), contact.slot) {
                    matrix.add(a, holds.stiffness, holds.rows[0]);
                    matrix.add_pair(slot, holds.stiffness, holds.rows);
                }
                springs.push((contact.rows.first(), contact.rows.second(), holds));
            }
        }
        matrix.factorise();
        let free = |body: usize, k: usize| !self.held[body][k];
        let start = |(body, held): (usize, &[bool; 3])| {
            let sway = 1.0 + self.places[body].centre[1].abs();
            [sway, 0.1 * sway, 0.1].map(|x| if held[0] { 0.1 * x } else { x })
        };
        let mut x: Vec<Triple> = self.held.iter().enumerate().map(start).collect();
        let mut work = vec![[0.0; 3]; x.len()];
        let mut before = f64::INFINITY;
        for round in 1..=ROUNDS {
            let push = |(body, x): (usize, &Triple)| {
                [0, 1, 2].map(|k| if free(body, k) { self.mass[body][k] * x[k] } else { 0.0 })
            };
            let load: Vec<Triple> = x.iter().enumerate().map(push).collect();
            x.copy_from_slice(&load);
            matrix.solve(&mut x, &mut work);
            let top: f64 = x.iter().zip(&load).map(|(x, f)| (0..3).map(|k| x[k] * f[k]).sum::<f64>()).sum();
            let bottom: f64 =
                x.iter().zip(&self.mass).map(|(x, m)| (0..3).map(|k| m[k] * x[k] * x[k]).sum::<f64>()).sum();
            let square = top / bottom;
            if !(square.is_finite() && square > 0.0) {
                return None;
            }
            if (square - before).abs() <= if round < ROUNDS { SETTLED } else { NEAR } * square {
                let stretch = |(a, b, holds): &(Option<usize>, usize, Holds)| {
                    let along = |body: usize, row: &Triple| (0..3).map(|k| row[k] * x[body][k]).sum::<f64>();
                    a.map_or(0.0, |a| along(a, &holds.rows[0])) + along(*b, &holds.rows[1])
                };
                let frequency = square.sqrt();
                let taken: f64 = springs.iter().map(|s| s.2.damping * stretch(s).powi(2)).sum();
                let rigid: f64 = springs.iter().filter(|s| s.2.rigid).map(|s| s.2.stiffness * stretch(s).powi(2)).sum();
                let damping = taken / (2.0 * frequency * bottom);
                return Some((Vibration { frequency, damping }, rigid / (square * bottom)));
            }
            before = square;
            let scale = 1.0 / bottom.sqrt();
            x.iter_mut().flatten().for_each(|x| *x *= scale);
        }
        None
    }

    /// What a point is held by, across and along, if it bears more than `least` [N s].
    fn holding(&self, contact: &Contact, owner: &Owner, least: f64) -> [Holds; 2] {
        let law = self.laws.part(self.pairs[owner.pair].link, owner.part);
        let pressed = contact.impulse[0] > least;
        let [across, along] = law.tangent(pressed);
        let bears = matches!(law.normal, Normal::Rigid { .. }) && contact.impulse[0].abs() > least;
        let holds = |rows, [stiffness, damping]: [f64; 2], rigid: bool| Holds {
            rows,
            rigid: rigid && stiffness == 0.0,
            stiffness: owner.share * stiffness,
            damping: owner.share * damping,
        };
        let sticks = contact.friction > 0.0 || contact.hold > 0.0;
        [holds(contact.rows.normal, across, bears), holds(contact.rows.tangent, along, bears && sticks)]
    }
}
