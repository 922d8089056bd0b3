//! What an event brings: impacts (OP11), turns, ties that yield and break, floors that lose their seat.

use concio_law::G;

use super::{REST, Run};
use crate::rocking::pull::Change;
use crate::rocking::response::{Stop, What};
use crate::rocking::side::Side;
use crate::rocking::state::Phase;

impl Run<'_> {
    /// All that has come about just behind an event.
    pub(super) fn meet(&mut self, way: f64) -> Option<Stop> {
        let [turn, velocity, ..] = self.state.row;
        let end = self.side().end;
        if !(turn.is_finite() && velocity.is_finite()) {
            return Some(Stop::NotFinite { time: self.state.t });
        }
        if turn > end {
            self.tell(What::Fall);
            return Some(Stop::Fallen { time: self.state.t, beyond: self.state.beyond_since });
        }
        self.pull_ties(way);
        self.lose();
        let beyond = self.is_beyond();
        if beyond != self.state.beyond {
            self.state.beyond = beyond;
            self.tell(if beyond { What::BeyondD0 } else { What::BackFromD0 });
            if beyond {
                self.state.counts.beyond_d0 += 1;
                self.state.beyond_since = self.state.t;
            }
        }
        if turn < 0.0 {
            self.land();
        } else if way * velocity < 0.0 {
            self.state.row[1] = 0.0;
            self.turn_ties();
            self.set_off();
        }
        None
    }

    /// An impact (OP11).
    pub(super) fn land(&mut self) {
        self.state.counts.impacts += 1;
        self.tell(What::Impact);
        let velocity = self.state.row[1].abs();
        let closing = self.side().momentum(&self.state.gone);
        let before = self.twice_kinetic(self.state.side);
        self.state.row[0] = 0.0;
        self.turn_ties();
        let other = 1 - self.state.side;
        let left = match (self.system.sides.get(other), self.system.restitution) {
            (None, restitution) => restitution.unwrap_or(0.0),
            // Floors that are gone may have taken what the check of the mechanism saw.
            (Some(_), Some(given)) => given.min((before / self.twice_kinetic(other)).sqrt()),
            (Some(opening), None) => self.side().passes_on(opening, &self.state.gone),
        };
        if self.system.sides.len() > 1 {
            self.state.side = other;
        }
        self.state.beyond = self.is_beyond();
        let after = if left * velocity < REST { 0.0 } else { left * velocity };
        let opening = self.side().momentum(&self.state.gone);
        let change = [0, 1].map(|axis| closing[axis] * velocity + opening[axis] * after);
        if let Some(impact) = self.events.last_mut().filter(|event| event.what == What::Impact) {
            impact.impulse = change[0].hypot(change[1]);
        }
        self.state.row[1] = after;
        self.state.impact += 0.5 * (before * velocity * velocity - self.twice_kinetic(self.state.side) * after * after);
        if after > 0.0 {
            self.state.phase = Phase::Moves(1.0);
            self.depart();
        } else {
            self.state.phase = Phase::Closed;
        }
        self.account();
    }

    /// Twice the kinetic energy at θ = 0 for a unit of velocity.
    pub(super) fn twice_kinetic(&self, side: usize) -> f64 {
        let side = &self.system.sides[side];
        side.terms(&side.pose(0.0), &self.state.gone).inertia
    }

    /// A jump of the ground's velocity is an impulse on all masses.
    pub(super) fn jump(&mut self) {
        let [inwards, up] = self.shaking.jumps(self.state.t);
        if (inwards == 0.0 && up == 0.0) || self.state.t <= self.state.jumped {
            return;
        }
        // Breaks of both motions that are meant to coincide may differ by rounding.
        self.state.jumped = self.state.t + 1e-8;
        let before = self.energies(&self.state.row).kinetic;
        let gained = |side: &Side, turn: f64| {
            let terms = side.terms(&side.pose(turn), &self.state.gone);
            (side.sign * inwards * terms.push - up * terms.weight / G) / terms.inertia
        };
        if self.state.phase == Phase::Closed {
            let Some(side) = (0..self.system.sides.len()).find(|i| gained(&self.system.sides[*i], 0.0) > REST) else {
                return;
            };
            self.state.row[1] = gained(&self.system.sides[side], 0.0);
            self.state.side = side;
            self.state.counts.lift_offs += 1;
            self.depart();
            self.tell(What::LiftOff);
        } else {
            self.state.row[1] += gained(self.side(), self.state.row[0]);
        }
        let work = self.energies(&self.state.row).kinetic - before;
        self.state.row[2] += work;
        self.state.scale = self.state.scale.max(self.state.row[2].abs());
        self.turn_ties();
        if self.state.row[0] <= 0.0 && self.state.row[1] < 0.0 {
            self.land();
        } else {
            self.set_off();
        }
    }

    pub(super) fn pull_ties(&mut self, way: f64) {
        let outwards = self.side().sign * way > 0.0;
        for i in 0..self.state.ties.len() {
            let displacement = self.plate(i);
            while let Some(change) = self.state.ties[i].change(displacement, outwards) {
                self.state.ties[i].take(change, displacement);
                match change {
                    Change::Yielded => self.tell(What::TieYields(i)),
                    Change::Broke => {
                        self.state.broke[i] = Some(self.state.t);
                        self.tell(What::TieBreaks(i));
                    }
                    Change::Tightened | Change::Slackened => {}
                }
            }
        }
    }

    /// Ties at a start: on the branch of their law that a slow pull would have brought them to.
    pub(super) fn settle_ties(&mut self, outwards: bool) {
        for i in 0..self.state.ties.len() {
            let displacement = self.plate(i);
            while let Some(change) = self.state.ties[i].change(displacement, outwards) {
                self.state.ties[i].take(change, displacement);
                self.state.broke[i] = (change == Change::Broke).then_some(0.0);
            }
            self.state.ties[i].turn_back(displacement);
        }
    }

    pub(super) fn turn_ties(&mut self) {
        for i in 0..self.state.ties.len() {
            let displacement = self.plate(i);
            self.state.ties[i].turn_back(displacement);
        }
    }

    /// Displacement of a tie's plate.
    pub(super) fn plate(&self, tie: usize) -> f64 {
        let side = self.side();
        side.displacement(&side.pose(self.state.row[0]), &side.ties[tie])
    }

    /// Floors whose seat ends, friction whose overlap is spent.
    pub(super) fn lose(&mut self) {
        let side = &self.system.sides[self.state.side];
        let pose = side.pose(self.state.row[0]);
        for i in 0..self.state.gone.len() {
            if self.state.gone[i] || !(side.displacement(&pose, &side.floors[i]) > self.system.floors[i][1]) {
                continue;
            }
            let square = self.state.row[1] * self.state.row[1];
            let of_floor = side.masses.iter().filter(|mass| mass.floor == Some(i));
            self.state.floors += of_floor.map(|m| m.potential(&pose) + 0.5 * m.inertia(&pose) * square).sum::<f64>();
            self.state.gone[i] = true;
            self.state.d0 =
                [0, 1].map(|k| self.system.sides.get(k).and_then(|side| side.unstable_from(&self.state.gone)));
            self.tell(What::SeatLost(i));
        }
        for i in 0..self.state.spent.len() {
            if !self.state.spent[i] && side.displacement(&pose, &side.rubs[i]).abs() > self.system.rubs[i][1] {
                self.state.spent[i] = true;
                self.tell(What::RubLost(i));
            }
        }
    }
}
