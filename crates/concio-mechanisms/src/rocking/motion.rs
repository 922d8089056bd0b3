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
use super::response::{Counts, Event, History, Response, Stop, What};
use super::shaking::{Piece, Setting, Shaking};
use super::system::System;

use step::between;

/// Velocity below which it rests after an impact [rad/s]: bounces get smaller without end.
const REST: f64 = 1e-7;
/// Events that are kept.
const EVENTS: usize = 4096;
/// Steps of a run at most.
const MOST_STEPS: u64 = 200_000_000;

/// What it does.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    /// At θ = 0.
    Closed,
    /// Stands open, held by friction.
    Held,
    /// Opens (1) or closes (−1).
    Moves(f64),
}

/// What is integrated: turn and velocity, work of the ground and of friction.
type Row = [f64; 4];

/// A run under way.
pub(super) struct Run<'s> {
    system: &'s System,
    shaking: Shaking<'s>,
    t: f64,
    side: usize,
    row: Row,
    phase: Phase,
    ties: Vec<Pull>,
    broke: Vec<Option<f64>>,
    gone: Vec<bool>,
    spent: Vec<bool>,
    /// Turn at which the weights hold no longer, of what still bears on the wall.
    d0: [Option<f64>; 2],
    beyond: bool,
    /// When it last went beyond d0.
    beyond_since: f64,
    /// Up to when a jump of the ground's velocity has been dealt with.
    jumped: f64,
    /// Kept of the account: what is lost in impacts, with floors, at the start.
    impact: f64,
    floors: f64,
    start: f64,
    residual: f64,
    scale: f64,
    peaks: [(f64, f64); 2],
    first_lift_off: Option<f64>,
    counts: Counts,
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
        let [rotation, velocity] = setting.start;
        let side = usize::from(system.sides.len() > 1 && (rotation < 0.0 || (rotation == 0.0 && velocity < 0.0)));
        let sign = system.sides[side].sign;
        let row = [sign * rotation, sign * velocity, 0.0, 0.0];
        let samples =
            setting.interval.map_or(0, |interval| (end / interval * (1.0 + 1e-12) + 1e-9).floor() as usize + 1);
        let mut run = Run {
            system,
            shaking,
            t: 0.0,
            side,
            row,
            phase: Phase::Closed,
            ties: system.ties.clone(),
            broke: vec![None; system.ties.len()],
            gone: vec![false; system.floors.len()],
            spent: vec![false; system.rubs.len()],
            d0: system.d0,
            beyond: false,
            beyond_since: 0.0,
            jumped: f64::NEG_INFINITY,
            impact: 0.0,
            floors: 0.0,
            start: 0.0,
            residual: 0.0,
            scale: 0.0,
            peaks: [(0.0, 0.0); 2],
            first_lift_off: None,
            counts: Counts::default(),
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
        run.beyond = run.is_beyond();
        run.start = {
            let energies = run.energies(&run.row);
            energies.kinetic + energies.place + energies.elastic + energies.ties
        };
        run.scale = run.start.abs();
        run.peaks[side] = (run.row[0], 0.0);
        run.set_off();
        run
    }

    /// Runs on: to the end of the shaking, at most through the tail.
    pub fn go(mut self, shaking_ends: f64, tail: f64) -> Response {
        self.keep_first();
        let stop = self.follow(shaking_ends, tail);
        if matches!(stop, Stop::AtRest { .. }) {
            self.keep_until(shaking_ends.max(self.t));
        }
        self.finish(stop)
    }

    fn follow(&mut self, shaking_ends: f64, tail: f64) -> Stop {
        let limit = shaking_ends + tail;
        loop {
            self.jump();
            if self.over(shaking_ends) {
                return Stop::AtRest { time: self.t };
            }
            if self.t >= limit {
                return Stop::Moving;
            }
            let piece = self.shaking.piece(self.t);
            let end = piece.end.min(if self.t < shaking_ends { shaking_ends } else { limit });
            if let Some(stop) = self.through(&piece, end, shaking_ends) {
                return stop;
            }
        }
    }

    /// Whether the shaking is over and the wall rests.
    fn over(&self, shaking_ends: f64) -> bool {
        self.t >= shaking_ends && !matches!(self.phase, Phase::Moves(_))
    }

    /// Through a smooth piece of the ground's motion, up to `end`.
    fn through(&mut self, piece: &Piece, end: f64, shaking_ends: f64) -> Option<Stop> {
        while self.t < end && !self.over(shaking_ends) {
            if self.counts.steps >= MOST_STEPS {
                return Some(Stop::StepsSpent);
            }
            self.counts.steps += 1;
            // Steps of equal length up to the end; at rest the motion of the ground alone is to be resolved.
            let longest = if matches!(self.phase, Phase::Moves(_)) { self.step } else { self.resolves };
            let left = ((end - self.t) / longest - 1e-9).ceil().max(1.0);
            let (to, h) =
                if left > 1.0 { (self.t + (end - self.t) / left, (end - self.t) / left) } else { (end, end - self.t) };
            if piece.at(to)[1] <= 0.0 {
                return Some(Stop::Airborne { time: self.t });
            }
            let stop = match self.phase {
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
        if self.loose(piece, self.t).is_none() {
            let from = self.t;
            let mut instant = to;
            if self.loose(piece, to).is_some() {
                let mut low = from;
                while let Some(middle) = between(low, instant) {
                    if self.loose(piece, middle).is_some() { instant = middle } else { low = middle }
                }
            }
            self.t = instant;
            self.keep_until(instant);
        }
        self.set_off_in(piece);
    }

    /// Sets off where something drives it to.
    fn set_off(&mut self) {
        let piece = self.shaking.piece(self.t);
        let velocity = self.row[1];
        if velocity != 0.0 {
            self.phase = Phase::Moves(velocity.signum());
        } else {
            self.phase = if self.row[0] > 0.0 { Phase::Held } else { Phase::Closed };
            self.set_off_in(&piece);
        }
    }

    fn set_off_in(&mut self, piece: &Piece) {
        let Some((side, way)) = self.loose(piece, self.t) else { return };
        if self.phase == Phase::Closed {
            self.side = side;
            self.counts.lift_offs += 1;
            self.depart();
            self.tell(What::LiftOff);
        }
        self.phase = Phase::Moves(way);
    }

    fn depart(&mut self) {
        self.first_lift_off.get_or_insert(self.t);
        self.ties.iter_mut().for_each(Pull::depart);
    }

    /// To which side it would set off at `t` from where it stands, and whether it would open (1) or close (−1).
    fn loose(&self, piece: &Piece, t: f64) -> Option<(usize, f64)> {
        let at = piece.at(t);
        let push = |side: usize| {
            let forces = self.forces(side, self.row[0], at);
            (forces.push, forces.rub)
        };
        if self.phase == Phase::Held {
            let (push, rub) = push(self.side);
            return (push.abs() > rub).then_some((self.side, push.signum()));
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
