//! What is asked: bodies that touch, what loads them, and what holds them.

use super::assembly::{Assembly, ContactKind, Vector, length, plus, scaled};
use crate::LimitError;

/// A force on a body, such as that of a floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointLoad {
    /// The body, by index.
    pub body: usize,
    /// Where it acts [m].
    pub at: Vector,
    /// Dead load [N].
    pub force: Vector,
    /// Weight of the mass that pushes there [N], whether the body carries it or not: the live load is λ times it.
    pub pushes: f64,
}

/// A tie: it pulls a body with a force from 0 to that at which it yields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tie {
    /// The body, by index.
    pub body: usize,
    /// The body at its other end; none: what does not move.
    pub to: Option<usize>,
    /// Where it holds the body [m].
    pub at: Vector,
    /// Where its other end is [m].
    pub end: Vector,
    /// Force at which it yields [N], from 0.
    pub yields: f64,
}

/// A support that pushes a body at a point with any force, such as a roller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// The body, by index.
    pub body: usize,
    /// Where it pushes [m].
    pub at: Vector,
    /// Where it pushes to; its length plays no part.
    pub direction: Vector,
    /// μ, from 0; a roller has 0.
    pub friction: f64,
}

/// Blocks in space under dead and live load.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// The bodies and where they touch.
    pub assembly: Assembly,
    /// Where weight pulls to; its length plays no part.
    pub down: Vector,
    /// Where the live load pushes to; its length plays no part. At λ = 1 it is a body's weight.
    pub direction: Vector,
    /// Whether a body is pushed, by index.
    pub pushed: Vec<bool>,
    /// Whether a body is held in its place, as the base is, by index.
    pub held: Vec<bool>,
    /// Forces on bodies.
    pub loads: Vec<PointLoad>,
    /// Ties.
    pub ties: Vec<Tie>,
    /// Supports.
    pub supports: Vec<Support>,
    /// Normal force at which the stones of each contact crush under even pressure [N]; empty: none do. See [`Problem::crushing`].
    pub bears: Vec<f64>,
}

impl Problem {
    /// All bodies pushed along a direction, none held, weight along −z.
    pub fn new(assembly: Assembly, direction: Vector) -> Self {
        let count = assembly.bodies.len();
        Problem {
            assembly,
            down: [0.0, 0.0, -1.0],
            direction,
            pushed: vec![true; count],
            held: vec![false; count],
            loads: Vec::new(),
            ties: Vec::new(),
            supports: Vec::new(),
            bears: Vec::new(),
        }
    }

    /// The body of a name.
    pub fn body(&self, name: &str) -> Option<usize> {
        self.assembly.bodies.iter().position(|b| b.name == name)
    }

    /// The problem with contacts that stand upright without friction.
    pub fn frictionless_heads(&self) -> Self {
        Problem { assembly: self.assembly.clone().frictionless_heads(), ..self.clone() }
    }

    /// The problem with the contact points of bed joints drawn in, see [`Assembly::drawn_in`].
    pub fn drawn_in(&self) -> Self {
        Problem { assembly: self.assembly.clone().drawn_in(), ..self.clone() }
    }

    /// The problem with stones that crush at a strength [Pa]: a contact bears as much over the area that it has here.
    ///
    /// Contact points that are to be drawn in, are so afterwards.
    pub fn crushing(&self, strength: f64) -> Self {
        let area = |c: &super::Contact| c.sides().iter().product::<f64>();
        Problem { bears: self.assembly.contacts.iter().map(|c| strength * area(c)).collect(), ..self.clone() }
    }

    /// Whether anything rubs where blocks stand side by side.
    pub fn heads_rub(&self) -> bool {
        self.assembly.contacts.iter().any(|c| c.kind == ContactKind::Head && c.friction > 0.0)
    }

    /// The live load at λ = 1 [N]: of every body, then of every point load.
    pub fn live_load(&self) -> f64 {
        let bodies = self.assembly.bodies.iter().enumerate().filter(|(i, _)| self.pushed[*i] && !self.held[*i]);
        let loads = self.loads.iter().filter(|l| !self.held[l.body]);
        bodies.map(|(_, b)| b.weight).sum::<f64>() + loads.map(|l| l.pushes).sum::<f64>()
    }

    /// The problem turned about the origin by a rotation matrix, rows first.
    pub fn turned(&self, rotation: [Vector; 3]) -> Self {
        let of = |p: Vector| rotation.map(|row| super::assembly::dot(row, p));
        Problem {
            assembly: self.assembly.turned(rotation),
            down: of(self.down),
            direction: of(self.direction),
            loads: self.loads.iter().map(|l| PointLoad { at: of(l.at), force: of(l.force), ..*l }).collect(),
            ties: self.ties.iter().map(|t| Tie { at: of(t.at), end: of(t.end), ..*t }).collect(),
            supports: self
                .supports
                .iter()
                .map(|s| Support { at: of(s.at), direction: of(s.direction), ..*s })
                .collect(),
            ..self.clone()
        }
    }

    /// # Errors
    /// Numbers that are none or out of their range, indices of no body, a live load of nothing.
    pub(super) fn check(&self) -> Result<(), LimitError> {
        let bodies = self.assembly.bodies.len();
        let wrong = |what: &str| Err(LimitError::Wrong(what.into()));
        let numbers = |v: &Vector| v.iter().all(|x| x.is_finite());
        let from_zero = |v: f64| v.is_finite() && v >= 0.0;
        let way = |v: Vector| numbers(&v) && length(v) > 0.0;
        if bodies == 0 {
            return wrong("there are no blocks");
        }
        if self.pushed.len() != bodies || self.held.len() != bodies {
            return wrong("pushed and held need one entry for each block");
        }
        if !way(self.direction) || !way(self.down) {
            return wrong("the directions of weight and live load need a length");
        }
        let known = |i: usize| i < bodies;
        let contacts = &self.assembly.contacts;
        let named = contacts.iter().flat_map(|c| [Some(c.a), c.b]).chain(self.ties.iter().map(|t| t.to)).flatten();
        let named = named.chain(self.loads.iter().map(|l| l.body)).chain(self.ties.iter().map(|t| t.body));
        if !named.chain(self.supports.iter().map(|s| s.body)).all(known) {
            return wrong("a contact, load, tie or support is on a block that there is not");
        }
        if !contacts.iter().all(|c| c.corners.iter().all(numbers) && (length(c.normal) - 1.0).abs() < 1e-9) {
            return wrong("contacts need corners that are numbers and normals of length 1");
        }
        let frictions = contacts.iter().map(|c| c.friction).chain(self.supports.iter().map(|s| s.friction));
        if !frictions.clone().all(from_zero) {
            return wrong("friction coefficients are at least 0");
        }
        if !contacts.iter().filter_map(|c| c.gives_way).all(from_zero) {
            return wrong("a contact gives way at a force of at least 0");
        }
        if !(self.bears.is_empty() || self.bears.len() == contacts.len()) {
            return wrong("what contacts bear needs one entry for each of them, or none");
        }
        if !self.bears.iter().all(|b| b.is_finite() && *b > 0.0) {
            return wrong("what crushes has a strength and an area above 0");
        }
        if !self.assembly.bodies.iter().all(|b| from_zero(b.weight) && numbers(&b.centre)) {
            return wrong("weights of blocks are at least 0");
        }
        if !self.loads.iter().all(|l| numbers(&l.at) && numbers(&l.force) && from_zero(l.pushes)) {
            return wrong("loads need numbers, and what they push with is at least 0");
        }
        let along = |t: &Tie| way(plus(t.end, scaled(t.at, -1.0)));
        if !self.ties.iter().all(|t| numbers(&t.at) && along(t) && from_zero(t.yields)) {
            return wrong("ties need a length, and yield at a force of at least 0");
        }
        if !self.supports.iter().all(|s| numbers(&s.at) && way(s.direction)) {
            return wrong("supports need a place and a direction");
        }
        if !(self.live_load() > 0.0) {
            return wrong("nothing that may move is pushed");
        }
        Ok(())
    }
}
