//! The time loop: phases, steps, events.
//!
//! The wall is closed (θ = 0), held open by friction, or moves to one side. A phase of motion has one sign of velocity, so that θ is monotonic and
//! friction smooth in it; its end is an event like an impact. Steps are those of the classical Runge–Kutta scheme of order 4, and end at breaks of
//! the motion of the ground. A step that an event cuts is repeated with other lengths, until the instant is known to rounding: the scheme
//! keeps its order, and no interpolation decides what happens first.

mod events;
mod keep;
mod step;

use serde::{Deserialize, Serialize};

use super::pull::Pull;
use super::response::{Counts, Event, History, Response, Stop, What};
use super::shaking::{Piece, Setting, Shaking};
use super::state::{Phase, State};
use super::system::System;

use step::between;

/// Velocity below which it rests after an impact [rad/s]: bounces get smaller without end.
const REST: f64 = 1e-7;
/// Samples that a wall at rest takes in one step at most, and samples that room is made for at the start.
const MOST_AT_ONCE: f64 = 1024.0;
const MOST_BUFFERED: u64 = 1 << 16;
/// Events that are kept.
const EVENTS: usize = 4096;
/// Steps of a run at most.
const MOST_STEPS: u64 = 200_000_000;

/// A run under way.
#[derive(Debug, Clone)]
pub struct Run<'s> {
    system: &'s System,
    shaking: Shaking<'s>,
    state: State,
    events: Vec<Event>,
    more_events: u64,
    history: Option<History>,
    interval: f64,
    samples: u64,
    step: f64,
    /// Longest step that resolves the motion of the ground, and takes no more samples than a buffer has room for [s].
    resolves: f64,
    piece: Piece,
    /// When the shaking is over, and when the run at the latest [s].
    shaking_ends: f64,
    limit: f64,
}

/// What is kept of a run ([`Run::keep`]).
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Kept(State);

/// How a wall stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turned {
    /// θ, θ̇ and θ̈, positive outwards [rad, rad/s, rad/s²].
    pub turned: [f64; 3],
    /// Of the control point, positive outwards [m].
    pub displacement: f64,
    /// As in [`History::shear`] [N].
    pub shear: f64,
    /// |θ| over that at which the weights hold no longer; none where they always hold.
    pub over_d0: Option<f64>,
}

impl<'s> Run<'s> {
    /// A run from the start of its setting; the shaking is over at `shaking_ends`.
    pub(super) fn new(system: &'s System, shaking: Shaking<'s>, setting: &Setting, shaking_ends: f64) -> Self {
        let limit = shaking_ends + setting.tail;
        let samples =
            setting.interval.map_or(0, |interval| (limit / interval * (1.0 + 1e-12) + 1e-9).floor() as u64 + 1);
        let room = samples.min(MOST_BUFFERED) as usize;
        let interval = setting.interval.unwrap_or(f64::INFINITY);
        let mut run = Run {
            system,
            shaking,
            state: State::new(system, setting.start),
            events: Vec::with_capacity(EVENTS),
            more_events: 0,
            history: setting.interval.map(|_| History::with_room(room, system.ties.len())),
            interval,
            samples,
            step: setting.step.unwrap_or_else(|| system.step(&shaking)),
            resolves: shaking.longest_step().min(MOST_AT_ONCE * interval),
            piece: shaking.piece(0.0),
            shaking_ends,
            limit,
        };
        // Ties that the start has stretched are where a slow pull would have brought them.
        run.settle_ties(true);
        run.note_pulls();
        run.state.beyond = run.is_beyond();
        run.state.start = {
            let energies = run.energies(&run.state.row);
            energies.kinetic + energies.place + energies.elastic + energies.ties
        };
        run.state.scale = run.state.start.abs();
        run.state.peaks[run.state.side] = (run.state.row[0], 0.0);
        run.set_off();
        run.keep_first();
        run
    }

    /// Runs on: to the end of the shaking, at most through the tail.
    pub(super) fn go(mut self) -> Response {
        let stop = loop {
            if let Some(stop) = self.advance() {
                break stop;
            }
        };
        if matches!(stop, Stop::AtRest { .. }) {
            self.keep_until(self.shaking_ends.max(self.state.t));
        }
        self.finish(stop)
    }

    /// One step, and why the run goes no further, where it does not.
    pub fn advance(&mut self) -> Option<Stop> {
        if self.state.t >= self.state.until || self.over() {
            self.jump();
            if self.over() {
                return Some(Stop::AtRest { time: self.state.t });
            }
            if self.state.t >= self.limit {
                return Some(Stop::Moving);
            }
            self.state.entered = self.state.t;
            self.piece = self.shaking.piece(self.state.t);
            let shaken = self.state.t < self.shaking_ends;
            self.state.until = self.piece.end.min(if shaken { self.shaking_ends } else { self.limit });
            if self.over() {
                return None;
            }
        }
        if self.state.counts.steps >= MOST_STEPS {
            return Some(Stop::StepsSpent);
        }
        self.state.counts.steps += 1;
        let (piece, end) = (self.piece, self.state.until);
        // Steps of equal length up to the end; at rest the motion of the ground alone is to be resolved.
        let longest = if matches!(self.state.phase, Phase::Moves(_)) { self.step } else { self.resolves };
        let left = ((end - self.state.t) / longest - 1e-9).ceil().max(1.0);
        let (to, h) = if left > 1.0 {
            (self.state.t + (end - self.state.t) / left, (end - self.state.t) / left)
        } else {
            (end, end - self.state.t)
        };
        if piece.at(to)[1] <= 0.0 {
            return Some(Stop::Airborne { time: self.state.t });
        }
        match self.state.phase {
            Phase::Moves(way) => self.step(&piece, way, to, h),
            Phase::Closed | Phase::Held => {
                self.wait(&piece, to);
                None
            }
        }
    }

    /// Whether the shaking is over and the wall rests.
    fn over(&self) -> bool {
        self.state.t >= self.shaking_ends && !matches!(self.state.phase, Phase::Moves(_))
    }

    /// Time reached [s].
    pub fn time(&self) -> f64 {
        self.state.t
    }

    /// How often what happened.
    pub fn counts(&self) -> Counts {
        self.state.counts
    }

    /// When the wall first left its position at rest [s].
    pub fn first_lift_off(&self) -> Option<f64> {
        self.state.first_lift_off
    }

    /// Which floors have lost their seat.
    pub fn gone(&self) -> &[bool] {
        &self.state.gone
    }

    /// Samples and events since they were last cleared.
    pub fn kept(&self) -> (Option<&History>, &[Event]) {
        (self.history.as_ref(), &self.events)
    }

    /// Empties samples and events, keeping their memory.
    pub fn clear(&mut self) {
        self.events.clear();
        if let Some(history) = &mut self.history {
            history.clear();
        }
    }

    /// All that changes, from which [`Run::take_up`] goes on with the same bits; samples and events that are not cleared are no part of it.
    pub fn keep(&self) -> Kept {
        Kept(self.state.clone())
    }

    /// Goes back to a state that was kept; false where it is not one of this wall.
    pub fn take_up(&mut self, Kept(state): Kept) -> bool {
        if !state.fits(self.system) {
            return false;
        }
        self.clear();
        self.piece = self.shaking.piece(state.entered);
        self.state = state;
        true
    }

    /// Waits up to `to`, or until it sets off.
    fn wait(&mut self, piece: &Piece, to: f64) {
        if self.loose(piece, self.state.t).is_none() {
            let from = self.state.t;
            let mut instant = to;
            if self.loose(piece, to).is_some() {
                let mut low = from;
                while let Some(middle) = between(low, instant) {
                    if self.loose(piece, middle).is_some() { instant = middle } else { low = middle }
                }
            }
            self.state.t = instant;
            self.keep_until(instant);
        }
        self.set_off_in(piece);
    }

    /// Sets off where something drives it to.
    fn set_off(&mut self) {
        let piece = self.shaking.piece(self.state.t);
        let velocity = self.state.row[1];
        if velocity != 0.0 {
            self.state.phase = Phase::Moves(velocity.signum());
        } else {
            self.state.phase = if self.state.row[0] > 0.0 { Phase::Held } else { Phase::Closed };
            self.set_off_in(&piece);
        }
    }

    fn set_off_in(&mut self, piece: &Piece) {
        let Some((side, way)) = self.loose(piece, self.state.t) else { return };
        if self.state.phase == Phase::Closed {
            self.state.side = side;
            self.state.counts.lift_offs += 1;
            self.depart();
            self.tell(What::LiftOff);
        }
        self.state.phase = Phase::Moves(way);
    }

    fn depart(&mut self) {
        self.state.first_lift_off.get_or_insert(self.state.t);
        self.state.ties.iter_mut().for_each(Pull::depart);
    }

    /// To which side it would set off at `t` from where it stands, and whether it would open (1) or close (−1).
    fn loose(&self, piece: &Piece, t: f64) -> Option<(usize, f64)> {
        let at = piece.at(t);
        let push = |side: usize| {
            let forces = self.forces(side, self.state.row[0], at);
            (forces.push, forces.rub)
        };
        if self.state.phase == Phase::Held {
            let (push, rub) = push(self.state.side);
            return (push.abs() > rub).then_some((self.state.side, push.signum()));
        }
        (0..self.system.sides.len())
            .find(|side| {
                let (push, rub) = push(*side);
                push > rub
            })
            .map(|side| (side, 1.0))
    }

    /// The moment that would open it to a side from rest, less friction [N m].
    pub(super) fn drives(&self, side: usize, at: [f64; 2]) -> f64 {
        let forces = self.forces(side, 0.0, at);
        forces.push - forces.rub
    }
}
