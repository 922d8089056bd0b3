//! The time loop: phases, steps, events.
//!
//! The wall is closed (θ = 0), held open by friction, or moves to one side. A phase of motion has one sign of velocity, so that θ is monotonic and
//! friction smooth in it; its end is an event like an impact. Steps are those of the classical Runge–Kutta scheme of order 4, and end at breaks of
//! the motion of the ground. A step that an event cuts is repeated with other lengths, until the instant is known to rounding: the scheme
//! keeps its order, and no interpolation decides what happens first.

mod events;
mod keep;
mod step;

use super::pull::Pull;
use super::response::{Event, History, Response, Stop, What};
use super::shaking::{Piece, Setting, Shaking};
use super::state::{Phase, State};
use super::system::System;

use step::between;

/// Velocity below which it rests after an impact [rad/s]: bounces get smaller without end.
const REST: f64 = 1e-7;
/// Events that are kept.
const EVENTS: usize = 4096;
/// Steps of a run at most.
const MOST_STEPS: u64 = 200_000_000;

/// A run under way.
pub(super) struct Run<'s> {
    system: &'s System,
    shaking: Shaking<'s>,
    state: State,
    events: Vec<Event>,
    more_events: u64,
    history: Option<History>,
    interval: f64,
    samples: usize,
    step: f64,
    /// Longest step that resolves the motion of the ground [s].
    resolves: f64,
}

impl<'s> Run<'s> {
    /// A run from the start of its setting; `end` is that of shaking and tail.
    pub fn new(system: &'s System, shaking: Shaking<'s>, setting: &Setting, end: f64) -> Self {
        let samples =
            setting.interval.map_or(0, |interval| (end / interval * (1.0 + 1e-12) + 1e-9).floor() as usize + 1);
        let mut run = Run {
            system,
            shaking,
            state: State::new(system, setting.start),
            events: Vec::with_capacity(EVENTS),
            more_events: 0,
            history: setting.interval.map(|_| History::with_room(samples, system.ties.len())),
            interval: setting.interval.unwrap_or(f64::INFINITY),
            samples,
            step: setting.step.unwrap_or_else(|| system.step(&shaking)),
            resolves: shaking.longest_step(),
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
        run
    }

    /// Runs on: to the end of the shaking, at most through the tail.
    pub fn go(mut self, shaking_ends: f64, tail: f64) -> Response {
        self.keep_first();
        let stop = self.follow(shaking_ends, tail);
        if matches!(stop, Stop::AtRest { .. }) {
            self.keep_until(shaking_ends.max(self.state.t));
        }
        self.finish(stop)
    }

    fn follow(&mut self, shaking_ends: f64, tail: f64) -> Stop {
        let limit = shaking_ends + tail;
        loop {
            self.jump();
            if self.over(shaking_ends) {
                return Stop::AtRest { time: self.state.t };
            }
            if self.state.t >= limit {
                return Stop::Moving;
            }
            let piece = self.shaking.piece(self.state.t);
            let end = piece.end.min(if self.state.t < shaking_ends { shaking_ends } else { limit });
            if let Some(stop) = self.through(&piece, end, shaking_ends) {
                return stop;
            }
        }
    }

    /// Whether the shaking is over and the wall rests.
    fn over(&self, shaking_ends: f64) -> bool {
        self.state.t >= shaking_ends && !matches!(self.state.phase, Phase::Moves(_))
    }

    /// Through a smooth piece of the ground's motion, up to `end`.
    fn through(&mut self, piece: &Piece, end: f64, shaking_ends: f64) -> Option<Stop> {
        while self.state.t < end && !self.over(shaking_ends) {
            if self.state.counts.steps >= MOST_STEPS {
                return Some(Stop::StepsSpent);
            }
            self.state.counts.steps += 1;
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
            let stop = match self.state.phase {
                Phase::Moves(way) => self.step(piece, way, to, h),
                Phase::Closed | Phase::Held => {
                    self.wait(piece, to);
                    None
                }
            };
            if stop.is_some() {
                return stop;
            }
        }
        None
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
