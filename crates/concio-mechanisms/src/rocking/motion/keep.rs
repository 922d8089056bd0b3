//! What is kept of a run: events, peaks, the account, histories.

use super::{EVENTS, Run};
use crate::rocking::motion::Turned;
use crate::rocking::response::{Energies, Event, Peak, Response, Stop, TieOutcome, What};
use crate::rocking::shaking::Piece;
use crate::rocking::side::Side;
use crate::rocking::state::{Phase, Row};

impl<'s> Run<'s> {
    pub(super) fn side(&self) -> &'s Side {
        &self.system.sides[self.state.side]
    }

    pub(super) fn is_beyond(&self) -> bool {
        self.is_beyond_at(self.state.row[0])
    }

    pub(super) fn is_beyond_at(&self, turn: f64) -> bool {
        self.state.d0[self.state.side].is_some_and(|most| most > 0.0 && turn > most)
    }

    pub(super) fn tell(&mut self, what: What) {
        if self.events.len() == EVENTS {
            self.more_events += 1;
            return;
        }
        let sign = self.side().sign;
        // An impact is found just behind θ = 0, a bounce starts from it.
        let rotation = if self.state.row[0] > 0.0 { sign * self.state.row[0] } else { 0.0 };
        self.events.push(Event {
            time: self.state.t,
            what,
            rotation,
            velocity: sign * self.state.row[1],
            impulse: 0.0,
        });
    }

    /// Peaks and account after a step.
    pub(super) fn note(&mut self) {
        if self.state.row[0] > self.state.peaks[self.state.side].0 {
            self.state.peaks[self.state.side] = (self.state.row[0], self.state.t);
        }
        self.note_pulls();
        self.account();
    }

    pub(super) fn note_pulls(&mut self) {
        let side = self.side();
        let pose = side.pose(self.state.row[0]);
        for (tie, grip) in self.state.ties.iter_mut().zip(&side.ties) {
            tie.peak = tie.peak.max(tie.force(side.displacement(&pose, grip)));
        }
    }

    pub(super) fn account(&mut self) {
        self.state.scale = self.state.scale.max(self.state.row[2].abs());
        self.state.residual = self.state.residual.max(self.energies(&self.state.row).residual().abs());
    }

    pub(super) fn energies(&self, row: &Row) -> Energies {
        let [turn, velocity, input, friction] = *row;
        let side = self.side();
        let pose = side.pose(turn);
        let (mut elastic, mut taken) = (0.0, 0.0);
        for (tie, grip) in self.state.ties.iter().zip(&side.ties) {
            let displacement = side.displacement(&pose, grip);
            elastic += tie.elastic(displacement);
            taken += tie.taken(displacement);
        }
        Energies {
            kinetic: 0.5 * side.terms(&pose, &self.state.gone).inertia * velocity * velocity,
            place: side.potential(turn, &self.state.gone),
            elastic,
            impact: self.state.impact,
            friction,
            ties: taken,
            floors: self.state.floors,
            input,
            start: self.state.start,
        }
    }

    pub(super) fn sample_time(&self) -> Option<f64> {
        let taken = self.state.samples;
        (self.history.is_some() && taken < self.samples).then_some(taken as f64 * self.interval)
    }

    /// θ̈ to the side to which it is turned, and the force of hinges and side walls on it, positive outwards [rad/s², N].
    fn borne(&self, row: &Row, at: [f64; 2]) -> [f64; 2] {
        let [turn, velocity, ..] = *row;
        let acceleration = if let Phase::Moves(way) = self.state.phase { self.rates(way, row, at)[1] } else { 0.0 };
        let side = self.side();
        let pose = side.pose(turn);
        let ties = self.state.ties.iter().zip(&side.ties).map(|(tie, grip)| tie.force(side.displacement(&pose, grip)));
        let kept = side.masses.iter().filter(|mass| !mass.floor.is_some_and(|floor| self.state.gone[floor]));
        let of_masses = kept.map(|mass| {
            let track = pose.track(&mass.grip);
            let relative = track.dx * acceleration + track.ddx * velocity * velocity;
            mass.along * (side.sign * relative - at[0]) - side.sign * mass.thrust
        });
        [acceleration, of_masses.sum::<f64>() + ties.sum::<f64>()]
    }

    /// Where the wall is, as of now.
    pub fn turned(&self) -> Turned {
        let at = self.shaking.piece(self.state.t).at(self.state.t);
        let side = self.side();
        let [turn, velocity, ..] = self.state.row;
        let [acceleration, shear] = self.borne(&self.state.row, at);
        let of_control = side.displacement(&side.pose(turn), &side.control);
        let turned = [turn, velocity, acceleration].map(|v| side.sign * v);
        Turned { turned, displacement: of_control, shear, over_d0: self.over_d0() }
    }

    /// θ over that at which what still bears on the wall holds no longer; none where there is no such turn.
    fn over_d0(&self) -> Option<f64> {
        self.system.d0[self.state.side].filter(|most| *most > 0.0).map(|most| self.state.row[0] / most)
    }

    /// The account.
    pub fn account_now(&self) -> Energies {
        self.energies(&self.state.row)
    }

    /// Ties, in their order.
    pub fn ties(&self) -> Vec<TieOutcome> {
        let outcome = |i: usize| {
            let tie = &self.state.ties[i];
            TieOutcome { peak: tie.peak, set: tie.set_at(self.plate(i)), broke: self.state.broke[i] }
        };
        (0..self.state.ties.len()).map(outcome).collect()
    }

    pub(super) fn keep_first(&mut self) {
        let row = self.state.row;
        let piece = self.shaking.piece(self.state.t);
        if self.sample_time().is_some() {
            self.push(0.0, &row, &piece);
        }
    }

    /// Samples within a step, by the cubic through rows and rates at both of its ends.
    pub(super) fn keep_within(&mut self, piece: &Piece, way: f64, (from, row): (f64, Row), (to, next): (f64, Row)) {
        if self.sample_time().is_none_or(|t| t > to) || to <= from {
            return;
        }
        let h = to - from;
        let (first, last) = (self.rates(way, &row, piece.at(from)), self.rates(way, &next, piece.at(to)));
        while let Some(t) = self.sample_time().filter(|t| *t <= to) {
            let s = ((t - from) / h).clamp(0.0, 1.0);
            let r = 1.0 - s;
            let at = |i: usize| {
                let straight = r * row[i] + s * next[i];
                let rise = next[i] - row[i];
                straight + s * r * (r * (h * first[i] - rise) - s * (h * last[i] - rise))
            };
            let mut sample = std::array::from_fn(at);
            sample[0] = f64::max(sample[0], 0.0);
            self.push(t, &sample, piece);
        }
    }

    /// Samples of a wall at rest.
    pub(super) fn keep_until(&mut self, to: f64) {
        while let Some(t) = self.sample_time().filter(|t| *t <= to) {
            let (row, piece) = (self.state.row, self.shaking.piece(t));
            self.push(t, &row, &piece);
        }
    }

    pub(super) fn push(&mut self, t: f64, row: &Row, piece: &Piece) {
        let energies = self.energies(row);
        let [acceleration, shear] = self.borne(row, piece.at(t));
        let side = self.side();
        let pose = side.pose(row[0]);
        let Some(history) = &mut self.history else { return };
        history.time.push(t);
        history.rotation.push(side.sign * row[0]);
        history.velocity.push(side.sign * row[1]);
        history.acceleration.push(side.sign * acceleration);
        history.shear.push(shear);
        history.displacement.push(side.displacement(&pose, &side.control));
        history.ground.push(piece.at(t)[0]);
        let pulls = self.state.ties.iter().zip(&side.ties).map(|(tie, grip)| tie.force(side.displacement(&pose, grip)));
        history.ties.extend(pulls);
        history.energies.push(energies);
        self.state.samples += 1;
    }

    pub(super) fn finish(self, stop: Stop) -> Response {
        let energies = self.energies(&self.state.row);
        let peak = |i: usize| {
            let side = &self.system.sides[i];
            let (rotation, time) = self.state.peaks[i];
            let displacement = side.sign * side.displacement(&side.pose(rotation), &side.control);
            let over_d0 = self.system.d0[i].filter(|most| *most > 0.0).map(|most| rotation / most);
            Peak { rotation, time, displacement, over_d0 }
        };
        Response {
            stop,
            peak: peak(0),
            inwards: (self.system.sides.len() > 1).then(|| peak(1)),
            d0: self.system.capacity(0),
            first_lift_off: self.state.first_lift_off,
            counts: self.state.counts,
            ties: self.ties(),
            energies,
            residual: self.state.residual,
            scale: self.state.scale,
            events: self.events,
            more_events: self.more_events,
            history: self.history,
        }
    }
}
