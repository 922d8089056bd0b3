//! Steps: (OP10) by the classical Runge–Kutta scheme of order 4, and the instant of the first event in a step.

use super::Run;
use crate::rocking::pull::Pull;
use crate::rocking::response::Stop;
use crate::rocking::shaking::Piece;
use crate::rocking::side::Terms;
use crate::rocking::state::Row;

/// How often a step is halved to find where it is slowest: the instant within 1e-6 of its length.
const HALVINGS: usize = 20;

/// Moments about the lower hinge.
pub(in crate::rocking) struct Forces {
    pub terms: Terms,
    /// That of the inertia forces of the moving ground.
    pub ground: f64,
    /// All that pushes it to open, friction apart.
    pub push: f64,
    /// Friction, against the motion.
    pub rub: f64,
}

impl Run<'_> {
    /// A step to `to`, or to the first event on the way.
    pub(super) fn step(&mut self, piece: &Piece, way: f64, to: f64, h: f64) -> Option<Stop> {
        let (from, row) = (self.state.t, self.state.row);
        let mut next = self.advanced(piece, way, row, from, h);
        let mut instant = to;
        let mut cut = self.crosses(way, &next);
        if !cut && let Some((slowest, there)) = self.slowest(piece, way, (from, row), (to, next)) {
            cut = self.crosses(way, &there);
            if cut {
                (instant, next) = (slowest, there);
            }
        }
        if cut {
            (instant, next) = self.first(piece, way, (from, row), (instant, next));
        }
        self.keep_within(piece, way, (from, row), (instant, next));
        (self.state.t, self.state.row) = (instant, next);
        self.note();
        if cut { self.meet(way) } else { None }
    }

    /// The first row at which an event has come about, known to rounding: between one before it and one behind it.
    pub(super) fn first(
        &mut self,
        piece: &Piece,
        way: f64,
        (from, row): (f64, Row),
        (mut high, mut next): (f64, Row),
    ) -> (f64, Row) {
        // How far the event is passed, where it is a landing or a turn: most are. False position with halved ends, every third time bisection.
        let passed = |lands: bool, row: &Row| if lands { -row[0] } else { -way * row[1] };
        let mut lands = next[0] < 0.0;
        let (mut low, mut before, mut behind) = (from, passed(lands, &row), passed(lands, &next));
        let mut shrunk = 0;
        for k in 0_u32.. {
            let Some(middle) = between(low, high) else { break };
            let straight = low + (high - low) * (before / (before - behind));
            let guessed = k % 3 < 2 && before < 0.0 && behind > 0.0 && low < straight && straight < high;
            let instant = if guessed { straight } else { middle };
            let tried = self.advanced(piece, way, row, from, instant - from);
            if self.crosses(way, &tried) {
                if lands != (tried[0] < 0.0) {
                    lands = !lands;
                    before = f64::NAN;
                }
                (high, next, behind) = (instant, tried, passed(lands, &tried));
                before *= if shrunk == 1 { 0.5 } else { 1.0 };
                shrunk = 1;
            } else {
                (low, before) = (instant, passed(lands, &tried));
                behind *= if shrunk == -1 { 0.5 } else { 1.0 };
                shrunk = -1;
            }
        }
        (high, next)
    }

    /// Where a step that slows down and then speeds up is slowest: it may have turned back and turned again there.
    pub(super) fn slowest(
        &mut self,
        piece: &Piece,
        way: f64,
        (from, row): (f64, Row),
        (to, next): (f64, Row),
    ) -> Option<(f64, Row)> {
        // The parabola of velocities with these ends and this mean, without an evaluation.
        let mean = (next[0] - row[0]) / (to - from);
        let slope = |this: f64, other: f64| way * (6.0 * mean - 4.0 * this - 2.0 * other);
        if slope(row[1], next[1]) >= 0.0 || slope(next[1], row[1]) >= 0.0 {
            return None;
        }
        let speeds_up = |run: &Self, row: &Row, t: f64| way * run.rates(way, row, piece.at(t))[1] > 0.0;
        let (mut low, mut high, mut found) = (from, to, next);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let tried = self.advanced(piece, way, row, from, middle - from);
            if speeds_up(self, &tried, middle) { (high, found) = (middle, tried) } else { low = middle }
        }
        Some((high, found))
    }

    /// The row after `h`, by one step of order 4.
    pub(super) fn advanced(&mut self, piece: &Piece, way: f64, row: Row, t: f64, h: f64) -> Row {
        self.state.counts.evaluations += 4;
        let (start, middle, end) = (piece.at(t), piece.at(t + 0.5 * h), piece.at(t + h));
        let k1 = self.rates(way, &row, start);
        let k2 = self.rates(way, &moved(&row, &k1, 0.5 * h), middle);
        let k3 = self.rates(way, &moved(&row, &k2, 0.5 * h), middle);
        let k4 = self.rates(way, &moved(&row, &k3, h), end);
        std::array::from_fn(|i| row[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    }

    /// (OP10) for θ̈, and the powers of the ground and of friction.
    #[inline]
    pub(super) fn rates(&self, way: f64, row: &Row, at: [f64; 2]) -> Row {
        let [turn, velocity, ..] = *row;
        let forces = self.forces(self.state.side, turn, at);
        let Terms { inertia, half_slope, .. } = forces.terms;
        let acceleration = (forces.push - way * forces.rub - half_slope * velocity * velocity) / inertia;
        [velocity, acceleration, forces.ground * velocity, way * forces.rub * velocity]
    }

    /// Moments about the lower hinge at a turn: all that pushes it to open, friction apart.
    #[inline]
    pub(in crate::rocking) fn forces(&self, side: usize, turn: f64, [inwards, weight]: [f64; 2]) -> Forces {
        let system = self.system;
        let side = &system.sides[side];
        let pose = side.pose(turn);
        let terms = side.terms(&pose, &self.state.gone);
        let ground = side.sign * inwards * terms.push - (weight - 1.0) * terms.weight;
        let mut push = ground - terms.weight + terms.thrust;
        for (tie, grip) in self.state.ties.iter().zip(&side.ties) {
            let at = pose.track(grip);
            push -= side.sign * at.dx * tie.force(side.displacement(&pose, grip));
        }
        let mut rub = system.friction_moment;
        for ((grip, [force, _]), spent) in side.rubs.iter().zip(&system.rubs).zip(&self.state.spent) {
            if !spent {
                rub += force * pose.track(grip).dx.abs();
            }
        }
        for ((grip, [force, _]), gone) in side.floors.iter().zip(&system.floors).zip(&self.state.gone) {
            if !gone && *force > 0.0 {
                rub += force * weight.max(0.0) * pose.track(grip).dx.abs();
            }
        }
        Forces { terms, ground, push, rub }
    }

    /// Whether an event lies before this row.
    pub(super) fn crosses(&self, way: f64, row: &Row) -> bool {
        let [turn, velocity, ..] = *row;
        // What is no number is an event too: it must not pass for a step that went well.
        if !(turn >= 0.0 && way * velocity >= 0.0 && turn <= self.side().end)
            || self.is_beyond_at(turn) != self.state.beyond
        {
            return true;
        }
        let side = self.side();
        let pose = side.pose(turn);
        let outwards = side.sign * way > 0.0;
        let pulled = |(tie, grip): (&Pull, _)| tie.change(side.displacement(&pose, grip), outwards).is_some();
        self.state.ties.iter().zip(&side.ties).any(pulled)
            || (0..self.state.gone.len())
                .any(|i| !self.state.gone[i] && side.displacement(&pose, &side.floors[i]) > self.system.floors[i][1])
            || (0..self.state.spent.len())
                .any(|i| !self.state.spent[i] && side.displacement(&pose, &side.rubs[i]).abs() > self.system.rubs[i][1])
    }
}

fn moved(row: &Row, rates: &Row, h: f64) -> Row {
    std::array::from_fn(|i| row[i] + h * rates[i])
}

/// An instant between two; none where there is none but for rounding.
pub(super) fn between(low: f64, high: f64) -> Option<f64> {
    let middle = 0.5 * (low + high);
    (high - low > 4.0 * f64::EPSILON * high.abs() && middle > low && middle < high).then_some(middle)
}
