//! Contact with dry friction in a step: what a contact point is, and what it bears at a velocity.
//!
//! With v the velocities after the step, v_f what they would be without contact, u_n and u_t the velocities with which the
//! two sides of a contact point part and slide, p_n and p_t the impulses there:
//!
//! (P1)  M (v − v_f) = Σ Hᵀ p
//!
//! (P4)  p_n = [p_n⁰ − ρ (u_n + b)]₊,   p_t = clamp(p_t⁰ − ρ u_t, ±μ p_n)
//!
//! b is e u_n of before for a restitution e, or what a gap that is still open allows. ρ is that of a spring over the step, and p⁰ what the spring bears
//! where nothing moves. Between stones ρ is so large that they hardly yield, and p⁰ is what they bore before: for ρ → ∞ this is
//!
//! (P2)  0 ≤ u_n + b ⊥ p_n ≥ 0
//!
//! (P3)  |p_t| ≤ μ p_n, and p_t = −μ p_n sign(u_t) where u_t ≠ 0
//!
//! (Alart and Curnier 1991), whose impulses are not unique where a wall holds more contacts than its stones can move; those of (P4) are.
//! Bounds of tension and crushing are further limits of p_n, linear springs further terms of (P1).

use crate::blocks::{Blocks, Slot, Triple};

/// What a contact point does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Status {
    /// Bears nothing.
    #[default]
    Open,
    /// Bears and does not slide.
    Stick,
    /// Slides, the impulse along the tangent.
    Forth,
    /// Slides, the impulse against the tangent.
    Back,
}

/// A linear part of what a contact bears: offset − ρ u.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Linear {
    /// Impulse where the velocity is 0 [N s].
    pub offset: f64,
    /// ρ [kg].
    pub rho: f64,
}

impl Linear {
    /// At the velocity `u` [m/s], in N s.
    #[inline(always)]
    pub(crate) fn at(&self, u: f64) -> f64 {
        self.offset - self.rho * u
    }
}

/// Where the two bodies of a contact stand, and how their velocities part and slide it: what is fetched most often.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rows {
    /// [`BASE`] for what moves with the base.
    a: u32,
    b: u32,
    /// Derivatives of the parting velocity by the velocities of both, those that are prescribed left out.
    pub normal: [Triple; 2],
    /// The same of the sliding velocity.
    pub tangent: [Triple; 2],
}

pub(crate) const BASE: u32 = u32::MAX;

/// The same in fewer numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Levers {
    /// [`BASE`] first for what moves with the base.
    pub bodies: [u32; 2],
    /// That on the second body.
    pub normal: [f64; 2],
    /// Arms of the normal and of the tangent on the first and on the second body.
    pub across: [f64; 2],
    pub along: [f64; 2],
}

impl Rows {
    /// First body; none for what moves with the base.
    pub fn first(&self) -> Option<usize> {
        if self.a == BASE { None } else { Some(self.a as usize) }
    }

    /// Second body.
    pub fn second(&self) -> usize {
        self.b as usize
    }

    /// Where no velocity is prescribed: the tangent is the normal turned then, and the first body is pushed as the second, the other way.
    pub fn levers(&self) -> Option<Levers> {
        let [first, second] = [0, 1].map(|side| [self.normal[side], self.tangent[side]]);
        let normal = [second[0][0], second[0][1]];
        let tangent = [-normal[1], normal[0]];
        let directions = |of: &[Triple; 2]| of.map(|row| [row[0], row[1]]);
        let opposite = [normal, tangent].map(|direction| direction.map(|x| -x));
        let fits = directions(&second) == [normal, tangent] && (self.a == BASE || directions(&first) == opposite);
        let arms = |k: usize| [if self.a == BASE { 0.0 } else { first[k][2] }, second[k][2]];
        fits.then(|| Levers { bodies: [self.a, self.b], normal, across: arms(0), along: arms(1) })
    }

    /// By how much the parting and the sliding velocity change with velocities that change by `v`.
    #[inline(always)]
    pub fn change(&self, v: &[Triple]) -> [f64; 2] {
        let second = &v[self.b as usize];
        let mut u = [dot(&self.normal[1], second), dot(&self.tangent[1], second)];
        if self.a != BASE {
            let first = &v[self.a as usize];
            u[0] += dot(&self.normal[0], first);
            u[1] += dot(&self.tangent[0], first);
        }
        u
    }

    /// The speed at which the two would approach if each went its fastest, with velocities as large as `v` [m/s].
    fn fastest(&self, v: &[Triple]) -> f64 {
        let of =
            |side: usize, body: u32| (0..3).map(|k| (self.normal[side][k] * v[body as usize][k]).abs()).sum::<f64>();
        of(1, self.b) + if self.a == BASE { 0.0 } else { of(0, self.a) }
    }

    /// Adds what impulses do to both bodies.
    #[inline(always)]
    pub fn push(&self, balance: &mut [Triple], p: [f64; 2]) {
        self.each(p, |body, push| (0..3).for_each(|k| balance[body][k] += push[k]));
    }

    /// Adds what resists to a matrix that is not symmetric: across and along to the same, and along to across.
    #[inline(always)]
    pub fn couple(&self, slot: Option<Slot>, matrix: &mut Blocks, [nn, tt, tn]: [f64; 3]) {
        let Rows { normal, tangent, .. } = *self;
        let along = |side: usize| [0, 1, 2].map(|k| tn * normal[side][k] + tt * tangent[side][k]);
        let across = |side: usize| normal[side].map(|x| nn * x);
        let (b, second) = (self.second(), [across(1), along(1)]);
        matrix.add_products(b, [normal[1], tangent[1]], second);
        if let (Some(a), Some(slot)) = (self.first(), slot) {
            let first = [across(0), along(0)];
            matrix.add_products(a, [normal[0], tangent[0]], first);
            matrix.add_pairs_of_products(slot, [normal, tangent], [[first[0], second[0]], [first[1], second[1]]]);
        }
    }

    /// What impulses do to each body.
    #[inline(always)]
    pub(crate) fn each(&self, p: [f64; 2], mut on: impl FnMut(usize, Triple)) {
        let of = |side: usize| [0, 1, 2].map(|k| self.normal[side][k] * p[0] + self.tangent[side][k] * p[1]);
        if self.a != BASE {
            on(self.a as usize, of(0));
        }
        on(self.b as usize, of(1));
    }
}

/// A contact point during one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Its bodies and directions.
    pub(crate) rows: Rows,
    /// Where the pair stands in the matrix, for two bodies; the first is eliminated first.
    pub slot: Option<Slot>,
    /// Parting and sliding velocity that prescribed motion brings [m/s].
    pub drift: [f64; 2],
    /// μ.
    pub friction: f64,
    /// What friction bears beside μ p_n [N s].
    pub hold: f64,
    /// Least and largest p_n: bond and crushing [N s].
    pub pressure: [f64; 2],
    /// b [m/s].
    pub bias: f64,
    /// (P4) of normal and tangent: p of before and ρ.
    pub law: [Linear; 2],
    /// By how many times nearer than others its law along is to be met: a force of what is very stiff is known no better than its length.
    pub tight: f64,
    /// What acts beside them, normal and along the tangent.
    pub spring: [Linear; 2],
    /// Mass that a push at this point moves, in both directions [kg].
    pub moved: [f64; 2],
    /// Impulses p_n and p_t by (P4) [N s].
    pub impulse: [f64; 2],
    /// What it does.
    pub status: Status,
    /// Whether it is left out of the solution: open too far to bear anything in the step, by what is known before.
    pub(crate) left_out: bool,
}

/// By how many times the speed at which its bodies could approach at their fastest a contact may be too far open to bear, and be left out. With half of it one step in 28
/// of a falling façade is solved again as something closed all the same, a wall of rigid stones that rocks takes 8 % more iterations; with twice as much a fifth fewer are left out.
const STRUCK: f64 = 4.0;

impl Contact {
    /// Of a body with another, or with the base, that bore `impulse` [N s] before and has no law yet. Derivatives of the parting and
    /// of the sliding velocity by the velocities of both, those that are prescribed left out; masses say what a push moves. It has its bodies in
    /// the order of elimination, with their derivatives, so that no go through the contacts has to look.
    pub fn new(
        (mut a, mut b): (Option<usize>, usize),
        mut slot: Option<Slot>,
        [mut normal, mut tangent]: [[Triple; 2]; 2],
        inverse_mass: &[Triple],
        impulse: [f64; 2],
    ) -> Self {
        if let (Some(first), Some(given)) = (a, slot) {
            let (straight, sides) = given.straighten([0, 1].map(|k| ([first, b][k], normal[k], tangent[k])));
            (slot, a, b) = (Some(straight), Some(sides[0].0), sides[1].0);
            (normal, tangent) = (sides.map(|side| side.1), sides.map(|side| side.2));
        }
        let of = |rows: [Triple; 2]| {
            let one = |row: Triple, body: usize| (0..3).map(|k| row[k] * row[k] * inverse_mass[body][k]).sum::<f64>();
            1.0 / (a.map_or(0.0, |a| one(rows[0], a)) + one(rows[1], b))
        };
        let all = [of(normal), of(tangent)];
        // A push against what is held moves nothing: the mass of the other direction stands for it.
        let known = all.into_iter().find(|m| m.is_finite()).unwrap_or(1.0);
        let moved = all.map(|m| if m.is_finite() { m } else { known });
        Contact {
            rows: Rows { a: a.map_or(BASE, |a| a as u32), b: b as u32, normal, tangent },
            slot,
            drift: [0.0; 2],
            friction: 0.0,
            hold: 0.0,
            pressure: [0.0, f64::INFINITY],
            bias: 0.0,
            law: [Linear::default(); 2],
            tight: 1.0,
            spring: [Linear::default(); 2],
            moved,
            impulse,
            status: Status::Open,
            left_out: false,
        }
    }

    /// Of what acts along one line alone and bore `impulse` [N s] before.
    pub(crate) fn along(
        bodies: (Option<usize>, usize),
        slot: Option<Slot>,
        line: [Triple; 2],
        inverse_mass: &[Triple],
        impulse: f64,
    ) -> Self {
        let own = Contact::new(bodies, slot, [line, line], inverse_mass, [impulse, 0.0]);
        Contact { rows: Rows { tangent: [[0.0; 3]; 2], ..own.rows }, ..own }
    }

    /// Parting and sliding velocity [m/s].
    #[inline(always)]
    pub fn velocity(&self, v: &[Triple]) -> [f64; 2] {
        let change = self.rows.change(v);
        [change[0] + self.drift[0], change[1] + self.drift[1]]
    }

    /// Leaves it out if it is open so far that it bears nothing at velocities near `v` and `free`, those without contact [m/s].
    pub(crate) fn leave_out(&mut self, v: &[Triple], free: &[Triple]) {
        let alone = self.spring == [Linear::default(); 2] && self.hold == 0.0 && self.pressure[0] == 0.0;
        let speed = || self.rows.fastest(v).max(self.rows.fastest(free)) + self.drift[0].abs();
        self.left_out = alone && self.impulse == [0.0; 2] && self.law[0].at(self.bias - STRUCK * speed()) < 0.0;
        if self.left_out {
            self.status = Status::Open;
        }
    }

    /// Whether it would bear something at velocities `v` [m/s].
    pub(crate) fn closes(&self, v: &[Triple]) -> bool {
        self.law[0].at(self.velocity(v)[0] + self.bias) > 0.0
    }

    /// What bounds friction where p_n is what it is at the velocity `u_n` [m/s], in N s.
    #[inline(always)]
    pub(crate) fn bound(&self, p_n: f64, u_n: f64) -> f64 {
        self.friction * (p_n + self.spring[0].at(u_n)).max(0.0) + self.hold
    }

    /// All that it bears at the velocity `u` [m/s] at the end of the step, in N s.
    pub fn total(&self, u: [f64; 2]) -> [f64; 2] {
        self.whole(self.impulse, u)
    }

    /// Whole impulses at the velocity `u` [m/s] where (P4) gives `p`, in N s.
    #[inline(always)]
    pub(crate) fn whole(&self, p: [f64; 2], u: [f64; 2]) -> [f64; 2] {
        [p[0] + self.spring[0].at(u[0]), p[1] + self.spring[1].at(u[1])]
    }

    /// Takes what impulses do from the balance of both bodies.
    #[inline(always)]
    pub(crate) fn push(&self, balance: &mut [Triple], p: [f64; 2]) {
        if p != [0.0; 2] {
            self.rows.push(balance, p.map(|p| -p));
        }
    }
}

/// How a step was solved.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Linear systems solved, each with factors of its own.
    pub iterations: usize,
    /// Largest violation of (P4) [m/s].
    pub residual: f64,
    /// Whether it came below what was asked for.
    pub converged: bool,
}

impl Effort {
    /// This one, and another that ended it.
    pub(crate) fn then(self, last: Effort) -> Effort {
        Effort { iterations: self.iterations + last.iterations, ..last }
    }
}

/// The largest part of a balance over the mass [m/s].
pub(crate) fn unbalance(balance: &[Triple], mass: &[Triple]) -> f64 {
    let part = |(r, m): (&Triple, &Triple)| {
        let turn = (r[2] * r[2] / (m[2] * m[0])).sqrt();
        worse(worse((r[0] / m[0]).abs(), (r[1] / m[1]).abs()), turn)
    };
    balance.iter().zip(mass).map(part).fold(0.0, worse)
}

/// The larger of two violations; one that is no number is the largest.
#[inline(always)]
pub(crate) fn worse(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

#[inline(always)]
fn dot(a: &Triple, b: &Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
