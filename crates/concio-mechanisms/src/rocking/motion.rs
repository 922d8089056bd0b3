//! The time loop: phases, steps, events.
//!
//! The wall is closed (θ = 0), held open by friction, or moves to one side. A phase of motion has one sign of velocity, so that θ is monotonic and
//! friction smooth in it; its end is an event like an impact. Steps are those of the classical Runge–Kutta scheme of order 4, and end at breaks of
//! the motion of the ground. A step that an event cuts is repeated with half of its length, until the instant is known to rounding: the
//! scheme keeps its order, and no interpolation decides what happens first.

use concio::G;

use super::mechanism::{Back, Mechanism, Restitution};
use super::pull::{Change, Pull};
use super::response::{Capacity, Counts, Energies, Event, History, Peak, Response, Stop, TieOutcome, What};
use super::shaking::{Piece, Setting, Shaking};
use super::side::{Side, Terms};

/// Velocity below which it rests after an impact [rad/s]: bounces get smaller without end.
const REST: f64 = 1e-7;
/// Longest step by the quickest motion: ω h.
const STEP: f64 = 0.02;
/// Longest step where nothing else limits it [s].
const LONGEST: f64 = 0.01;
/// How often a step is halved to find where it is slowest: the instant within 1e-6 of its length.
const HALVINGS: usize = 20;
/// Events that are kept.
const EVENTS: usize = 4096;
/// Steps of a run at most.
const MOST_STEPS: u64 = 200_000_000;
/// Share of the largest turn up to which the quickest motion is looked for: the chain is singular at its end.
const LOOKED_AT: f64 = 0.98;

/// A mechanism, compiled.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct System {
    /// Outwards; inwards, where it rocks to both sides.
    pub sides: Vec<Side>,
    /// Turn at which the weights hold no longer.
    pub d0: [Option<f64>; 2],
    /// What an impact leaves; none for (OP11).
    restitution: Option<f64>,
    friction_moment: f64,
    /// Friction and seat of floors, force and overlap of rubs; +∞ where they are never lost.
    floors: Vec<[f64; 2]>,
    rubs: Vec<[f64; 2]>,
    ties: Vec<Pull>,
    /// Longest step that resolves wall and ties [s].
    step: f64,
}

impl System {
    /// Compiles a mechanism whose numbers have been checked.
    pub fn new(mechanism: &Mechanism) -> Self {
        let none_gone = vec![false; mechanism.floors.len()];
        let mut sides = vec![Side::new(mechanism, &mechanism.linkage, 1.0)];
        let restitution = match mechanism.back {
            Back::SideWalls(Restitution::Given(e)) => Some(e),
            Back::SideWalls(Restitution::Block) => Some(super::block_restitution(mechanism.slenderness())),
            Back::Free { inwards, restitution } => {
                sides.push(Side::new(mechanism, &inwards, -1.0));
                restitution
            }
        };
        let never = f64::INFINITY;
        let mut system = System {
            d0: [0, 1].map(|i| sides.get(i).and_then(|side: &Side| side.unstable_from(&none_gone))),
            restitution,
            friction_moment: mechanism.friction_moment,
            floors: mechanism.floors.iter().map(|f| [f.friction * f.load, f.seat.unwrap_or(never)]).collect(),
            rubs: mechanism.rubs.iter().map(|rub| [rub.force, rub.overlap.unwrap_or(never)]).collect(),
            ties: mechanism.ties.iter().map(Pull::new).collect(),
            step: LONGEST,
            sides,
        };
        let quickest = system.sides.iter().map(|side| quickest(side, mechanism, &none_gone)).fold(0.0, f64::max);
        system.step = LONGEST.min(STEP / quickest);
        system
    }
}

/// The quickest angular frequency of the wall with its ties [rad/s].
fn quickest(side: &Side, mechanism: &Mechanism, gone: &[bool]) -> f64 {
    const PLACES: usize = 64;
    let width = LOOKED_AT * side.end / PLACES as f64;
    let square = |k: usize| {
        let (low, high) = (side.pose(k as f64 * width), side.pose((k + 1) as f64 * width));
        let [from, to] = [low, high].map(|pose| side.terms(&pose, gone));
        let place = ((to.weight - to.thrust) - (from.weight - from.thrust)).abs() / width;
        let ties = mechanism.ties.iter().zip(&side.ties).map(|(tie, grip)| tie.stiffness * low.track(grip).dx.powi(2));
        (place + ties.sum::<f64>()) / from.inertia
    };
    (0..PLACES).map(square).fold(0.0, f64::max).sqrt()
}

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
        self.keep_until(shaking_ends.max(self.t));
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

    // ---- at rest -------------------------------------------------------------------------------------------------

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

    // ---- in motion -----------------------------------------------------------------------------------------------

    /// A step to `to`, or to the first event on the way.
    fn step(&mut self, piece: &Piece, way: f64, to: f64, h: f64) -> Option<Stop> {
        let (from, row) = (self.t, self.row);
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
        self.keep(piece, way, (from, row), (instant, next));
        (self.t, self.row) = (instant, next);
        self.note();
        if cut { self.meet(way) } else { None }
    }

    /// The first row at which an event has come about, known to rounding: between one before it and one behind it.
    fn first(
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
    fn slowest(
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
    fn advanced(&mut self, piece: &Piece, way: f64, row: Row, t: f64, h: f64) -> Row {
        self.counts.evaluations += 4;
        let (start, middle, end) = (piece.at(t), piece.at(t + 0.5 * h), piece.at(t + h));
        let k1 = self.rates(way, &row, start);
        let k2 = self.rates(way, &moved(&row, &k1, 0.5 * h), middle);
        let k3 = self.rates(way, &moved(&row, &k2, 0.5 * h), middle);
        let k4 = self.rates(way, &moved(&row, &k3, h), end);
        std::array::from_fn(|i| row[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    }

    /// (OP10) for θ̈, and the powers of the ground and of friction.
    #[inline]
    fn rates(&self, way: f64, row: &Row, at: [f64; 2]) -> Row {
        let [turn, velocity, ..] = *row;
        let forces = self.forces(self.side, turn, at);
        let Terms { inertia, half_slope, .. } = forces.terms;
        let acceleration = (forces.push - way * forces.rub - half_slope * velocity * velocity) / inertia;
        [velocity, acceleration, forces.ground * velocity, way * forces.rub * velocity]
    }

    /// Moments about the lower hinge at a turn: all that pushes it to open, friction apart.
    #[inline]
    fn forces(&self, side: usize, turn: f64, [inwards, weight]: [f64; 2]) -> Forces {
        let system = self.system;
        let side = &system.sides[side];
        let pose = side.pose(turn);
        let terms = side.terms(&pose, &self.gone);
        let ground = side.sign * inwards * terms.push - (weight - 1.0) * terms.weight;
        let mut push = ground - terms.weight + terms.thrust;
        for (tie, grip) in self.ties.iter().zip(&side.ties) {
            let at = pose.track(grip);
            push -= side.sign * at.dx * tie.force(side.displacement(&pose, grip));
        }
        let mut rub = system.friction_moment;
        for ((grip, [force, _]), spent) in side.rubs.iter().zip(&system.rubs).zip(&self.spent) {
            if !spent {
                rub += force * pose.track(grip).dx.abs();
            }
        }
        for ((grip, [force, _]), gone) in side.floors.iter().zip(&system.floors).zip(&self.gone) {
            if !gone && *force > 0.0 {
                rub += force * weight.max(0.0) * pose.track(grip).dx.abs();
            }
        }
        Forces { terms, ground, push, rub }
    }

    /// Whether an event lies before this row.
    fn crosses(&self, way: f64, row: &Row) -> bool {
        let [turn, velocity, ..] = *row;
        // What is no number is an event too: it must not pass for a step that went well.
        if !(turn >= 0.0 && way * velocity >= 0.0 && turn <= self.side().end) || self.is_beyond_at(turn) != self.beyond
        {
            return true;
        }
        let side = self.side();
        let pose = side.pose(turn);
        let outwards = side.sign * way > 0.0;
        let pulled = |(tie, grip): (&Pull, _)| tie.change(side.displacement(&pose, grip), outwards).is_some();
        self.ties.iter().zip(&side.ties).any(pulled)
            || (0..self.gone.len())
                .any(|i| !self.gone[i] && side.displacement(&pose, &side.floors[i]) > self.system.floors[i][1])
            || (0..self.spent.len())
                .any(|i| !self.spent[i] && side.displacement(&pose, &side.rubs[i]).abs() > self.system.rubs[i][1])
    }

    /// All that has come about just behind an event.
    fn meet(&mut self, way: f64) -> Option<Stop> {
        let [turn, velocity, ..] = self.row;
        let end = self.side().end;
        if !(turn.is_finite() && velocity.is_finite()) {
            return Some(Stop::NotFinite { time: self.t });
        }
        if turn > end {
            self.tell(What::Fall);
            return Some(Stop::Fallen { time: self.t, beyond: self.beyond_since });
        }
        self.pull_ties(way);
        self.lose();
        let beyond = self.is_beyond();
        if beyond != self.beyond {
            self.beyond = beyond;
            self.tell(if beyond { What::BeyondD0 } else { What::BackFromD0 });
            if beyond {
                self.counts.beyond_d0 += 1;
                self.beyond_since = self.t;
            }
        }
        if turn < 0.0 {
            self.land();
        } else if way * velocity < 0.0 {
            self.row[1] = 0.0;
            self.turn_ties();
            self.set_off();
        }
        None
    }

    /// An impact (OP11).
    fn land(&mut self) {
        self.counts.impacts += 1;
        self.tell(What::Impact);
        let velocity = self.row[1].abs();
        let before = self.twice_kinetic(self.side);
        self.row[0] = 0.0;
        self.turn_ties();
        let other = 1 - self.side;
        let left = match (self.system.sides.get(other), self.system.restitution) {
            (None, restitution) => restitution.unwrap_or(0.0),
            // Floors that are gone may have taken what the check of the mechanism saw.
            (Some(_), Some(given)) => given.min((before / self.twice_kinetic(other)).sqrt()),
            (Some(opening), None) => self.side().passes_on(opening, &self.gone),
        };
        if self.system.sides.len() > 1 {
            self.side = other;
        }
        self.beyond = self.is_beyond();
        let after = if left * velocity < REST { 0.0 } else { left * velocity };
        self.row[1] = after;
        self.impact += 0.5 * (before * velocity * velocity - self.twice_kinetic(self.side) * after * after);
        if after > 0.0 {
            self.phase = Phase::Moves(1.0);
            self.depart();
        } else {
            self.phase = Phase::Closed;
        }
        self.account();
    }

    /// Twice the kinetic energy at θ = 0 for a unit of velocity.
    fn twice_kinetic(&self, side: usize) -> f64 {
        let side = &self.system.sides[side];
        side.terms(&side.pose(0.0), &self.gone).inertia
    }

    /// A jump of the ground's velocity is an impulse on all masses.
    fn jump(&mut self) {
        let [inwards, up] = self.shaking.jumps(self.t);
        if (inwards == 0.0 && up == 0.0) || self.t <= self.jumped {
            return;
        }
        // Breaks of both motions that are meant to coincide may differ by rounding.
        self.jumped = self.t + 1e-8;
        let before = self.energies(&self.row).kinetic;
        let gained = |side: &Side, turn: f64| {
            let terms = side.terms(&side.pose(turn), &self.gone);
            (side.sign * inwards * terms.push - up * terms.weight / G) / terms.inertia
        };
        if self.phase == Phase::Closed {
            let Some(side) = (0..self.system.sides.len()).find(|i| gained(&self.system.sides[*i], 0.0) > REST) else {
                return;
            };
            self.row[1] = gained(&self.system.sides[side], 0.0);
            self.side = side;
            self.counts.lift_offs += 1;
            self.depart();
            self.tell(What::LiftOff);
        } else {
            self.row[1] += gained(self.side(), self.row[0]);
        }
        let work = self.energies(&self.row).kinetic - before;
        self.row[2] += work;
        self.scale = self.scale.max(self.row[2].abs());
        self.turn_ties();
        if self.row[0] <= 0.0 && self.row[1] < 0.0 {
            self.land();
        } else {
            self.set_off();
        }
    }

    // ---- ties, floors, friction ----------------------------------------------------------------------------------

    fn pull_ties(&mut self, way: f64) {
        let outwards = self.side().sign * way > 0.0;
        for i in 0..self.ties.len() {
            let displacement = self.plate(i);
            while let Some(change) = self.ties[i].change(displacement, outwards) {
                self.ties[i].take(change, displacement);
                match change {
                    Change::Yielded => self.tell(What::TieYields(i)),
                    Change::Broke => {
                        self.broke[i] = Some(self.t);
                        self.tell(What::TieBreaks(i));
                    }
                    Change::Tightened | Change::Slackened => {}
                }
            }
        }
    }

    /// Ties at a start: on the branch of their law that a slow pull would have brought them to.
    fn settle_ties(&mut self, outwards: bool) {
        for i in 0..self.ties.len() {
            let displacement = self.plate(i);
            while let Some(change) = self.ties[i].change(displacement, outwards) {
                self.ties[i].take(change, displacement);
                self.broke[i] = (change == Change::Broke).then_some(0.0);
            }
            self.ties[i].turn_back(displacement);
        }
    }

    fn turn_ties(&mut self) {
        for i in 0..self.ties.len() {
            let displacement = self.plate(i);
            self.ties[i].turn_back(displacement);
        }
    }

    /// Displacement of a tie's plate.
    fn plate(&self, tie: usize) -> f64 {
        let side = self.side();
        side.displacement(&side.pose(self.row[0]), &side.ties[tie])
    }

    /// Floors whose seat ends, friction whose overlap is spent.
    fn lose(&mut self) {
        let side = &self.system.sides[self.side];
        let pose = side.pose(self.row[0]);
        for i in 0..self.gone.len() {
            if self.gone[i] || !(side.displacement(&pose, &side.floors[i]) > self.system.floors[i][1]) {
                continue;
            }
            let square = self.row[1] * self.row[1];
            let of_floor = side.masses.iter().filter(|mass| mass.floor == Some(i));
            self.floors += of_floor.map(|m| m.potential(&pose) + 0.5 * m.inertia(&pose) * square).sum::<f64>();
            self.gone[i] = true;
            self.d0 = [0, 1].map(|k| self.system.sides.get(k).and_then(|side| side.unstable_from(&self.gone)));
            self.tell(What::SeatLost(i));
        }
        for i in 0..self.spent.len() {
            if !self.spent[i] && side.displacement(&pose, &side.rubs[i]).abs() > self.system.rubs[i][1] {
                self.spent[i] = true;
                self.tell(What::RubLost(i));
            }
        }
    }

    // ---- what is noted -------------------------------------------------------------------------------------------

    fn side(&self) -> &'s Side {
        &self.system.sides[self.side]
    }

    fn is_beyond(&self) -> bool {
        self.is_beyond_at(self.row[0])
    }

    fn is_beyond_at(&self, turn: f64) -> bool {
        self.d0[self.side].is_some_and(|most| turn > most)
    }

    fn tell(&mut self, what: What) {
        if self.events.len() == EVENTS {
            self.more_events += 1;
            return;
        }
        let sign = self.side().sign;
        // An impact is found just behind θ = 0, a bounce starts from it.
        let rotation = if self.row[0] > 0.0 { sign * self.row[0] } else { 0.0 };
        self.events.push(Event { time: self.t, what, rotation, velocity: sign * self.row[1] });
    }

    /// Peaks and account after a step.
    fn note(&mut self) {
        if self.row[0] > self.peaks[self.side].0 {
            self.peaks[self.side] = (self.row[0], self.t);
        }
        self.note_pulls();
        self.account();
    }

    fn note_pulls(&mut self) {
        let side = self.side();
        let pose = side.pose(self.row[0]);
        for (tie, grip) in self.ties.iter_mut().zip(&side.ties) {
            tie.peak = tie.peak.max(tie.force(side.displacement(&pose, grip)));
        }
    }

    fn account(&mut self) {
        self.scale = self.scale.max(self.row[2].abs());
        self.residual = self.residual.max(self.energies(&self.row).residual().abs());
    }

    fn energies(&self, row: &Row) -> Energies {
        let [turn, velocity, input, friction] = *row;
        let side = self.side();
        let pose = side.pose(turn);
        let (mut elastic, mut taken) = (0.0, 0.0);
        for (tie, grip) in self.ties.iter().zip(&side.ties) {
            let displacement = side.displacement(&pose, grip);
            elastic += tie.elastic(displacement);
            taken += tie.taken(displacement);
        }
        Energies {
            kinetic: 0.5 * side.terms(&pose, &self.gone).inertia * velocity * velocity,
            place: side.potential(turn, &self.gone),
            elastic,
            impact: self.impact,
            friction,
            ties: taken,
            floors: self.floors,
            input,
            start: self.start,
        }
    }

    // ---- histories -----------------------------------------------------------------------------------------------

    fn sample_time(&self) -> Option<f64> {
        let taken = self.history.as_ref()?.time.len();
        (taken < self.samples).then_some(taken as f64 * self.interval)
    }

    fn keep_first(&mut self) {
        let row = self.row;
        let piece = self.shaking.piece(self.t);
        if self.sample_time().is_some() {
            self.push(0.0, &row, &piece);
        }
    }

    /// Samples within a step, by the cubic through rows and rates at both of its ends.
    fn keep(&mut self, piece: &Piece, way: f64, (from, row): (f64, Row), (to, next): (f64, Row)) {
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
    fn keep_until(&mut self, to: f64) {
        while let Some(t) = self.sample_time().filter(|t| *t <= to) {
            let (row, piece) = (self.row, self.shaking.piece(t));
            self.push(t, &row, &piece);
        }
    }

    fn push(&mut self, t: f64, row: &Row, piece: &Piece) {
        let energies = self.energies(row);
        let side = self.side();
        let pose = side.pose(row[0]);
        let Some(history) = &mut self.history else { return };
        history.time.push(t);
        history.rotation.push(side.sign * row[0]);
        history.velocity.push(side.sign * row[1]);
        history.displacement.push(side.displacement(&pose, &side.control));
        history.ground.push(piece.at(t)[0]);
        let pulls = self.ties.iter().zip(&side.ties).map(|(tie, grip)| tie.force(side.displacement(&pose, grip)));
        history.ties.extend(pulls);
        history.energies.push(energies);
    }

    fn finish(self, stop: Stop) -> Response {
        let energies = self.energies(&self.row);
        let peak = |i: usize| {
            let side = &self.system.sides[i];
            let (rotation, time) = self.peaks[i];
            let displacement = side.sign * side.displacement(&side.pose(rotation), &side.control);
            let over_d0 = self.system.d0[i].filter(|most| *most > 0.0).map(|most| rotation / most);
            Peak { rotation, time, displacement, over_d0 }
        };
        let outcome = |i: usize| {
            let tie = &self.ties[i];
            TieOutcome { peak: tie.peak, set: tie.set_at(self.plate(i)), broke: self.broke[i] }
        };
        Response {
            stop,
            peak: peak(0),
            inwards: (self.system.sides.len() > 1).then(|| peak(1)),
            d0: self.system.capacity(),
            first_lift_off: self.first_lift_off,
            counts: self.counts,
            ties: (0..self.ties.len()).map(outcome).collect(),
            energies,
            residual: self.residual,
            scale: self.scale,
            events: self.events,
            more_events: self.more_events,
            history: self.history,
        }
    }
}

/// Moments about the lower hinge.
struct Forces {
    terms: Terms,
    /// That of the inertia forces of the moving ground.
    ground: f64,
    /// All that pushes it to open, friction apart.
    push: f64,
    /// Friction, against the motion.
    rub: f64,
}

impl System {
    /// The largest part of the velocity that an impact may leave: more would give energy.
    pub fn most_restitution(&self) -> f64 {
        let [outwards, inwards] = self.sides.as_slice() else { return 1.0 };
        let none_gone = vec![false; self.floors.len()];
        let [out, inw] = [outwards, inwards].map(|side| side.terms(&side.pose(0.0), &none_gone).inertia);
        (out / inw).min(inw / out).sqrt()
    }

    /// Longest step under a motion of the ground, where none is given [s].
    pub fn step(&self, shaking: &Shaking) -> f64 {
        self.step.min(shaking.longest_step())
    }

    /// d0 outwards.
    pub fn capacity(&self) -> Option<Capacity> {
        let side = &self.sides[0];
        let rotation = self.d0[0]?;
        Some(Capacity { rotation, displacement: side.displacement(&side.pose(rotation), &side.control) })
    }

    /// α(θ) outwards without ties and friction.
    pub fn multiplier_at(&self, rotation: f64) -> f64 {
        let side = &self.sides[0];
        if !(0.0..=side.end).contains(&rotation) {
            return f64::NAN;
        }
        let terms = side.terms(&side.pose(rotation), &vec![false; self.floors.len()]);
        (terms.weight - terms.thrust) / (G * terms.push)
    }

    /// Part of the velocity that an impact at the end of a turn outwards leaves.
    pub fn restitution(&self) -> f64 {
        let none_gone = vec![false; self.floors.len()];
        match (self.restitution, self.sides.get(1)) {
            (Some(given), _) => given,
            (None, Some(inwards)) => self.sides[0].passes_on(inwards, &none_gone),
            (None, None) => 0.0,
        }
    }

    /// Acceleration of the ground at which it sets off from rest to a side [m/s²], friction and pretension included.
    pub fn lifts_off_at(&self, side: usize) -> f64 {
        let forces = Run::at_rest(self).forces(side, 0.0, [0.0, 1.0]);
        (forces.rub - forces.push) / forces.terms.push
    }
}

fn moved(row: &Row, rates: &Row, h: f64) -> Row {
    std::array::from_fn(|i| row[i] + h * rates[i])
}

/// An instant between two; none where there is none but for rounding.
fn between(low: f64, high: f64) -> Option<f64> {
    let middle = 0.5 * (low + high);
    (high - low > 4.0 * f64::EPSILON * high.abs() && middle > low && middle < high).then_some(middle)
}
