//! Velocities at the end of a step by an interior point method.
//!
//! The impulses p of a contact obey up to four bounds,
//!
//! (P5)  s₁ = p_n − least,   s₂ = most − p_n,   s₃ = B − p_t,   s₄ = B + p_t,   B = μ [p_n + s_n]₊ + hold
//!
//! with s_n what springs beside press, and with a multiplier λ ≥ 0 for each, 0 ≤ λ ⊥ s ≥ 0,
//!
//! (P5a)  u_n + b + E_n (p_n − p_n⁰) + μ |ũ_t| = λ₁ − λ₂ + μ (λ₃ + λ₄),   ũ_t = u_t + E_t (p_t − p_t⁰) = λ₄ − λ₃
//!
//! are (P2) and (P3): μ |ũ_t| takes back the opening that the edges of friction would give to what slides (De Saxcé and Feng 1998).
//! For given μ |ũ_t| and s_n these are the conditions of a convex quadratic program, whichever impulses redundant contacts share.
//! E is 1/ρ of (P4), that of a spring where a contact is compliant; elsewhere it is small, p⁰ is what the
//! contact bore before, and both choose among impulses that give the same motion those nearest to p⁰. Where friction alone holds a
//! contact down, s₃ and s₄ keep p_n from falling below 0.
//!
//! Every iteration solves (P1), (P5) and (P5a), linear about the iterate and with products λ s that fall, for v: a matrix like that
//! of [`crate::contact`] with a full 2 × 2 block for each contact. It is factorised once per iteration and used for a
//! prediction, a correction (Mehrotra 1992) and another towards equal products (Gondzio 1996), each with μ |ũ_t| and s_n as the last
//! one left them. However many contacts open and close, that takes a dozen or two of iterations.

use crate::blocks::{Blocks, Triple};
use crate::contact::{Contact, Effort, Status, unbalance, worse};
use crate::mixing::{self, Mixing};

/// Iterations after which a step is given up.
const MOST: usize = 60;
/// 1/E over ρ of a rigid contact: more leaves what head joints bear to the cones instead of to what they bore before, less
/// gives way by more than the tolerance.
const FIRM: f64 = 1e4;
/// Iterations in which what is left has to be halved: once it is small enough, and before.
const PATIENCE: usize = 8;
const STALLED: usize = 25;
/// μ beyond which μ |ũ_t| of the last direction is no good guess for the next.
const STEEP: f64 = 3.0;
/// Least distance from the bounds at the start, over what is out of balance, and over what was borne before.
const FLOOR: f64 = 1.0;
const SHARE: f64 = 0.02;
/// Least multiplier at the start, over what is out of balance.
const CRACK: f64 = 0.01;
/// Share of the way to the boundary that is gone.
const INSIDE: f64 = 0.995;
/// How much farther the second correction is to come, and how far products may lie from their mean.
const REACH: f64 = 0.3;
const SPREAD: f64 = 10.0;
/// Share of the way from which a direction is worth to be made exact in μ |ũ_t|, and what that may be off by then, over what is left.
const WORTH: f64 = 0.3;
const EXACT: f64 = 0.1;
/// Part of the way of an inexact direction that an exact one has to go.
const WORSE: f64 = 0.1;
/// Share of the way after which products are evened out instead of reduced.
const STUCK: f64 = 0.03;
/// What distances from bounds are rounded by, over the impulses: to mend it would keep the way short where a bound is met.
const ROUNDED: f64 = 1e-13;
/// Part of the squares of multipliers by which a single one is told from several.
const SLIGHT: f64 = 1e-8;

/// Where the bodies of a contact stand, none being the base, and how their velocities part and slide it.
#[derive(Debug, Clone, Copy)]
struct Rows {
    a: u32,
    b: u32,
    normal: [Triple; 2],
    tangent: [Triple; 2],
}

const BASE: u32 = u32::MAX;

/// A contact during a solution: with two bounds, those of friction, or with four.
#[derive(Debug, Clone, Copy)]
struct Point<const N: usize> {
    /// How far each bound is away, and its multiplier: friction forth and back, least and most p_n.
    s: [f64; N],
    lambda: [f64; N],
    /// By how much (P5) and (P5a) are off.
    astray: [f64; N],
    off: [f64; 2],
    /// μ where the contact is pressed, 0 where it is pulled.
    mu: f64,
    /// Diagonal of E.
    soft: [f64; 2],
    /// ũ_t.
    sliding: f64,
    /// Change of |ũ_t| and of B along the direction.
    slides: f64,
    gives: f64,
    /// Second-order part of the products.
    second: [f64; N],
    /// K⁻¹ with K = E + Σ λ/s a aᵀ, a the normals of the bounds; K⁻¹ a; impulses where velocities stay.
    inverse: [f64; 3],
    lift: [[f64; 2]; N],
    right: [f64; 2],
    /// Mass that a push moves, and spring across [kg].
    mass: f64,
    rho: f64,
    /// Changes along the direction.
    way: Way<N>,
    d_sliding: f64,
    d_gives: f64,
    /// Impulses, and those that it is drawn to, p⁰.
    p: [f64; 2],
    anchor: [f64; 2],
    /// Whether the impulse across and along may change, whether there is friction, and which bounds there are.
    moves: [bool; 2],
    rubs: bool,
    on: [bool; N],
}

/// A direction of impulses, distances and multipliers.
#[derive(Debug, Clone, Copy)]
struct Way<const N: usize> {
    p: [f64; 2],
    s: [f64; N],
    lambda: [f64; N],
}

impl<const N: usize> Way<N> {
    const NONE: Self = Way { p: [0.0; 2], s: [0.0; N], lambda: [0.0; N] };
}

/// Contacts with as many bounds.
#[derive(Debug, Clone)]
struct Group<const N: usize> {
    /// Their numbers.
    which: Vec<u32>,
    rows: Vec<Rows>,
    points: Vec<Point<N>>,
    kept: Vec<Way<N>>,
}

impl<const N: usize> Default for Group<N> {
    fn default() -> Self {
        Group { which: Vec::new(), rows: Vec::new(), points: Vec::new(), kept: Vec::new() }
    }
}

/// Room for the solution.
#[derive(Debug, Clone, Default)]
pub(crate) struct Interior {
    /// Contacts that only friction bounds, and the others.
    cones: Group<2>,
    others: Group<4>,
    residual: Vec<Triple>,
    step: Vec<Triple>,
    kept: Vec<Triple>,
    work: Vec<Triple>,
    mixing: Mixing,
    lagging: [Vec<f64>; 2],
    /// Share of the way that was gone last.
    last: f64,
}

/// What is left of the conditions [m/s].
#[derive(Debug, Clone, Copy, Default)]
struct Left {
    residual: f64,
    /// Largest E (p − p⁰) of a rigid contact.
    drawn: f64,
    /// Sum of the products λ s, and their number.
    products: f64,
    number: usize,
}

impl Left {
    fn mean(&self) -> f64 {
        self.products / self.number.max(1) as f64
    }
}

/// What a direction comes to.
#[derive(Debug, Clone, Copy)]
struct Course {
    /// How far it may be gone, 1 at most.
    share: f64,
    /// Growth of the products with the share and its square.
    growth: [f64; 2],
    /// By how much |ũ_t| and B are off that it was made with [m/s].
    off: f64,
}

impl Course {
    const BEGIN: Course = Course { share: 1.0, growth: [0.0; 2], off: 0.0 };
}

/// How second-order parts and what lags behind come from the last direction.
#[derive(Debug, Clone, Copy)]
enum Correction {
    /// As it was gone so far; products are taken whole.
    Whole { share: f64 },
    /// As it was gone so far; products at the share `wide` are drawn towards the target.
    Even { share: f64, wide: f64 },
    /// Second-order parts stay.
    Stays,
}

/// Whether [`Interior::solve`] knows what a contact does.
pub(crate) fn fits(contact: &Contact) -> bool {
    contact.friction <= STEEP && contact.moved[0].is_finite()
}

impl Interior {
    /// Solves a step to `tolerance` [m/s], or for as long as that gets nearer to it from `enough` [m/s] on; `v` holds a guess on entry.
    pub(crate) fn solve(
        &mut self,
        matrix: &mut Blocks,
        (mass, free): (&[Triple], &[Triple]),
        contacts: &mut [Contact],
        v: &mut [Triple],
        (tolerance, enough): (f64, f64),
    ) -> Effort {
        self.start(mass, free, contacts, v, tolerance);
        let mut effort = Effort { rounds: 1, ..Effort::default() };
        let (mut least, mut since) = (f64::INFINITY, 0);
        loop {
            let left = self.look(mass, free, contacts, v);
            effort.residual = worse(left.residual, left.drawn);
            if left.residual <= tolerance {
                if left.drawn <= tolerance {
                    effort.converged = true;
                    break;
                }
                self.cones.anchor(contacts);
                self.others.anchor(contacts);
                effort.rounds += 1;
            }
            (least, since) = if effort.residual <= 0.5 * least { (effort.residual, 0) } else { (least, since + 1) };
            let stays = since >= if effort.residual <= enough { PATIENCE } else { STALLED };
            if effort.iterations == MOST || stays || !left.residual.is_finite() {
                break;
            }
            self.factorise(matrix, mass, contacts);
            effort.iterations += 1;
            let share = self.direct(matrix, &left, tolerance);
            // Where products vanish before the conditions hold, rounding ends in nothing over nothing.
            if !self.step.iter().flatten().all(|x| x.is_finite()) {
                break;
            }
            for (v, step) in v.iter_mut().zip(&self.step) {
                (0..3).for_each(|k| v[k] += share * step[k]);
            }
            self.cones.go(share);
            self.others.go(share);
            self.last = share;
        }
        effort.factorisations = effort.iterations;
        self.cones.tell(contacts, v);
        self.others.tell(contacts, v);
        effort
    }

    /// Within the bounds, near what was borne before: as far from them as that is off balance.
    fn start(&mut self, mass: &[Triple], free: &[Triple], contacts: &[Contact], v: &[Triple], tolerance: f64) {
        for room in [&mut self.residual, &mut self.step, &mut self.kept, &mut self.work] {
            room.resize(v.len(), [0.0; 3]);
        }
        self.last = 1.0;
        self.cones.clear();
        self.others.clear();
        inertia(&mut self.residual, mass, free, v);
        for (number, contact) in contacts.iter().enumerate() {
            let u = contact.velocity(v);
            let p = match is_cone(contact) && contact.pressure[1] == f64::INFINITY {
                true => self.cones.add(number, contact, u),
                false => self.others.add(number, contact, u),
            };
            contact.push(&mut self.residual, contact.whole(p, u));
        }
        let scale = unbalance(&self.residual, mass).max(tolerance);
        self.cones.enter(contacts, v, scale);
        self.others.enter(contacts, v, scale);
    }

    /// What is left of (P1), into `self.residual`, and of (P5).
    fn look(&mut self, mass: &[Triple], free: &[Triple], contacts: &[Contact], v: &[Triple]) -> Left {
        inertia(&mut self.residual, mass, free, v);
        let mut left = Left::default();
        self.cones.look(contacts, v, &mut self.residual, &mut left);
        self.others.look(contacts, v, &mut self.residual, &mut left);
        left.residual = worse(left.residual, unbalance(&self.residual, mass));
        left
    }

    fn factorise(&mut self, matrix: &mut Blocks, mass: &[Triple], contacts: &[Contact]) {
        matrix.reset(mass);
        self.cones.couple(contacts, matrix);
        self.others.couple(contacts, matrix);
        matrix.factorise();
    }

    /// The direction, into `self.step` and the points, and how far it is gone.
    fn direct(&mut self, matrix: &Blocks, left: &Left, tolerance: f64) -> f64 {
        let mean = left.mean();
        let first = self.pass(matrix, 0.0, 1.0, Correction::Stays);
        let after = left.products + first.share * (first.growth[0] + first.share * first.growth[1]);
        let after = after / left.number.max(1) as f64;
        // Rounding takes products of nothing below 0.
        let falls = if mean > 0.0 { (mean * (after / mean).powi(3)).max(0.0) } else { 0.0 };
        let target = if self.last < STUCK { mean } else { falls };
        let second = self.pass(matrix, target, INSIDE, Correction::Whole { share: first.share });
        self.keep();
        let wide = (second.share + REACH).min(1.0);
        let third = self.pass(matrix, target, INSIDE, Correction::Even { share: second.share, wide });
        let enough = EXACT * left.residual.max(tolerance);
        let best = second.share.max(third.share);
        let exact = (best >= WORTH && third.off > enough).then(|| {
            if third.share > second.share {
                self.keep();
            }
            self.settle(matrix, target, third, enough)
        });
        match exact {
            Some(share) if share >= WORSE * best => share,
            None if third.share > second.share => third.share,
            _ => {
                self.step.copy_from_slice(&self.kept);
                self.cones.restore();
                self.others.restore();
                best
            }
        }
    }

    /// The direction for which what lags behind is that of the direction itself, to `enough` [m/s] or nearly; how far it may be gone.
    fn settle(&mut self, matrix: &Blocks, target: f64, mut course: Course, enough: f64) -> f64 {
        let n = self.cones.points.len() + 2 * self.others.points.len();
        self.mixing.begin(n);
        for _ in 0..mixing::MOST {
            let [x, g] = &mut self.lagging;
            x.clear();
            g.clear();
            self.cones.lag(x, g);
            self.others.lag(x, g);
            self.mixing.next(x, g);
            let left = self.cones.take(x);
            self.others.take(left);
            course = self.pass(matrix, target, INSIDE, Correction::Stays);
            if course.off <= enough {
                break;
            }
        }
        course.share
    }

    fn keep(&mut self) {
        self.kept.copy_from_slice(&self.step);
        self.cones.keep();
        self.others.keep();
    }

    /// A direction to products of `target`; how far it may be gone, `keep` of the way to the boundary.
    fn pass(&mut self, matrix: &Blocks, target: f64, keep: f64, correction: Correction) -> Course {
        for (step, residual) in self.step.iter_mut().zip(&self.residual) {
            *step = residual.map(|r| -r);
        }
        self.cones.aim(target, correction, &mut self.step);
        self.others.aim(target, correction, &mut self.step);
        matrix.solve(&mut self.step, &mut self.work);
        let mut course = Course::BEGIN;
        self.cones.turn(&self.step, target, keep, &mut course);
        self.others.turn(&self.step, target, keep, &mut course);
        course
    }
}

impl<const N: usize> Group<N> {
    fn clear(&mut self) {
        self.which.clear();
        self.rows.clear();
        self.points.clear();
    }

    /// Another contact; what it is taken to bear.
    fn add(&mut self, number: usize, contact: &Contact, u: [f64; 2]) -> [f64; 2] {
        let point = Point::lay(contact, u);
        self.which.push(number as u32);
        let Contact { a, b, normal, tangent, .. } = *contact;
        self.rows.push(Rows { a: a.map_or(BASE, |a| a as u32), b: b as u32, normal, tangent });
        self.points.push(point);
        point.p
    }

    fn enter(&mut self, contacts: &[Contact], v: &[Triple], scale: f64) {
        for (point, which) in self.points.iter_mut().zip(&self.which) {
            let contact = &contacts[*which as usize];
            point.enter(contact, contact.velocity(v), scale);
        }
    }

    fn look(&mut self, contacts: &[Contact], v: &[Triple], residual: &mut [Triple], left: &mut Left) {
        for (point, which) in self.points.iter_mut().zip(&self.which) {
            let contact = &contacts[*which as usize];
            let u = contact.velocity(v);
            point.look(contact, u, left);
            contact.push(residual, contact.whole(point.p, u));
        }
    }

    fn couple(&mut self, contacts: &[Contact], matrix: &mut Blocks) {
        for (point, which) in self.points.iter_mut().zip(&self.which) {
            let contact = &contacts[*which as usize];
            point.invert();
            let [a, b, c] = point.inverse;
            contact.couple(matrix, [a + contact.spring[0].rho, b, c + contact.spring[1].rho]);
        }
    }

    /// Impulses where velocities stay, onto the bodies.
    fn aim(&mut self, target: f64, correction: Correction, step: &mut [Triple]) {
        for (point, rows) in self.points.iter_mut().zip(&self.rows) {
            point.correct(target, correction);
            point.aim(target);
            rows.push(step, point.right);
        }
    }

    fn turn(&mut self, step: &[Triple], target: f64, keep: f64, course: &mut Course) {
        for (point, rows) in self.points.iter_mut().zip(&self.rows) {
            point.turn(rows.change(step), target, keep, course);
        }
    }

    fn keep(&mut self) {
        self.kept.clear();
        self.kept.extend(self.points.iter().map(|point| point.way));
    }

    fn restore(&mut self) {
        self.points.iter_mut().zip(&self.kept).for_each(|(point, way)| point.way = *way);
    }

    /// What lags behind in the direction, and what the direction makes of it [m/s].
    fn lag(&self, x: &mut Vec<f64>, g: &mut Vec<f64>) {
        for point in &self.points {
            x.push(point.mu * point.slides);
            g.push(point.mu * point.slide(1.0));
            if N > 2 {
                x.push(point.gives / point.mass);
                g.push(point.d_gives / point.mass);
            }
        }
    }

    /// Takes from `x` what is to lag behind; what is left of it.
    fn take<'a>(&mut self, mut x: &'a [f64]) -> &'a [f64] {
        for point in &mut self.points {
            let own = if N > 2 { 2 } else { 1 };
            point.slides = if point.mu > 0.0 { x[0] / point.mu } else { 0.0 };
            if N > 2 {
                point.gives = x[1] * point.mass;
            }
            x = &x[own..];
        }
        x
    }

    fn go(&mut self, share: f64) {
        for point in &mut self.points {
            (0..2).for_each(|k| point.p[k] += share * point.way.p[k]);
            for i in 0..N {
                point.s[i] += share * point.way.s[i];
                point.lambda[i] += share * point.way.lambda[i];
            }
        }
    }

    /// Draws rigid contacts to what they bear now.
    fn anchor(&mut self, contacts: &[Contact]) {
        for (point, which) in self.points.iter_mut().zip(&self.which) {
            let contact = &contacts[*which as usize];
            (0..2).filter(|k| !contact.compliant[*k]).for_each(|k| point.anchor[k] = point.p[k]);
        }
    }

    fn tell(&self, contacts: &mut [Contact], v: &[Triple]) {
        for (point, which) in self.points.iter().zip(&self.which) {
            point.tell(&mut contacts[*which as usize], v);
        }
    }
}

impl Rows {
    #[inline]
    fn change(&self, v: &[Triple]) -> [f64; 2] {
        let dot = |row: &Triple, v: &Triple| row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
        let second = &v[self.b as usize];
        let mut u = [dot(&self.normal[1], second), dot(&self.tangent[1], second)];
        if self.a != BASE {
            let first = &v[self.a as usize];
            u[0] += dot(&self.normal[0], first);
            u[1] += dot(&self.tangent[0], first);
        }
        u
    }

    #[inline(always)]
    fn push(&self, balance: &mut [Triple], p: [f64; 2]) {
        let mut on = |body: u32, side: usize| {
            let balance = &mut balance[body as usize];
            (0..3).for_each(|k| balance[k] += self.normal[side][k] * p[0] + self.tangent[side][k] * p[1]);
        };
        if self.a != BASE {
            on(self.a, 0);
        }
        on(self.b, 1);
    }
}

/// Whether friction alone keeps p_n from falling below 0.
fn is_cone(contact: &Contact) -> bool {
    let alone = contact.pressure[0] == 0.0 && contact.hold == 0.0 && contact.spring[0] == Default::default();
    alone && contact.friction > 0.0 && !is_fixed(contact) && contact.moved[1].is_finite()
}

/// Whether what presses stays whatever moves.
fn is_fixed(contact: &Contact) -> bool {
    contact.compliant[0] && contact.law[0].rho == 0.0
}

/// E of a contact across or along.
fn soft(contact: &Contact, k: usize) -> f64 {
    1.0 / (contact.law[k].rho * if contact.compliant[k] { 1.0 } else { FIRM })
}

impl<const N: usize> Point<N> {
    /// What it bore before, within its bounds.
    fn lay(contact: &Contact, u: [f64; 2]) -> Self {
        let [least, most] = contact.pressure;
        let fixed = is_fixed(contact);
        let p_n = if fixed { contact.law[0].offset } else { contact.impulse[0] }.clamp(least, most);
        let bound = contact.bound(p_n, u[0]);
        let p = [p_n, contact.impulse[1].clamp(-bound, bound)];
        let rubs = (contact.friction > 0.0 || contact.hold > 0.0) && contact.moved[1].is_finite();
        let moves = [!fixed, rubs && (bound > 0.0 || is_cone(contact))];
        let bounds = [moves[1], moves[1], !fixed && least.is_finite() && !is_cone(contact), !fixed && most.is_finite()];
        Point {
            s: [0.0; N],
            lambda: [0.0; N],
            astray: [0.0; N],
            off: [0.0; 2],
            mu: contact.friction,
            soft: [0, 1].map(|k| if moves[k] { soft(contact, k) } else { 0.0 }),
            sliding: 0.0,
            slides: 0.0,
            gives: 0.0,
            second: [0.0; N],
            inverse: [0.0; 3],
            lift: [[0.0; 2]; N],
            right: [0.0; 2],
            mass: contact.moved[0],
            rho: contact.spring[0].rho,
            way: Way::NONE,
            d_sliding: 0.0,
            d_gives: 0.0,
            p,
            anchor: [0, 1].map(|k| if contact.compliant[k] { contact.law[k].offset } else { p[k] }),
            moves,
            rubs,
            on: std::array::from_fn(|i| bounds[i]),
        }
    }

    /// Whether there is bound `i`.
    #[inline]
    fn has(&self, i: usize) -> bool {
        N == 2 || self.on[i]
    }

    /// Impulses, distances and multipliers at the start, where velocities are out of balance by `scale` [m/s]: so far from
    /// the bounds that bearing or not stays open.
    fn enter(&mut self, contact: &Contact, u: [f64; 2], scale: f64) {
        let mu = contact.friction;
        let floor = FLOOR * contact.moved[0] * scale + SHARE * self.p[0].abs();
        let [least, most] = contact.pressure;
        let cone = is_cone(contact);
        let inside = floor.min(0.5 * (most - least));
        if cone {
            let side = self.p[1] / mu;
            let [a, b] = [self.p[0] + side, self.p[0] - side].map(|g| (0.5 * g).max(floor));
            self.p = [a + b, mu * (a - b)];
        } else {
            if N > 2 && self.on[2] {
                self.p[0] = self.p[0].max(least + inside);
            }
            if N > 2 && self.on[3] {
                self.p[0] = self.p[0].min(most - inside);
            }
            let bound = contact.bound(self.p[0], u[0]);
            let room = (bound - floor.min(0.5 * bound)).max(0.0);
            self.p[1] = self.p[1].clamp(-room, room);
        }
        let across = u[0] + contact.bias + self.shift(0);
        self.sliding = u[1] + self.shift(1);
        let bound = contact.bound(self.p[0], u[0]);
        let up = if cone { 0.5 * (across / mu + self.sliding.abs()) } else { 0.0 };
        let part = if cone { 0.5 } else { 1.0 };
        let far = self.far(contact, bound);
        let wanted = [up - part * self.sliding, up + part * self.sliding, across, -across];
        let edge = if cone { 2.0 * mu } else { 1.0 };
        for i in 0..N {
            let edge = if i < 2 { edge } else { 1.0 };
            self.s[i] = far[i].max(edge * floor);
            self.lambda[i] = wanted[i].max(CRACK * FLOOR * scale * floor / self.s[i]);
        }
    }

    /// Distances from the bounds by the impulses.
    #[inline]
    fn far(&self, contact: &Contact, bound: f64) -> [f64; N] {
        let ([p_n, p_t], [least, most]) = (self.p, contact.pressure);
        let far = [bound - p_t, bound + p_t, p_n - least, most - p_n];
        std::array::from_fn(|i| far[i])
    }

    /// Normals of the bounds.
    #[inline]
    fn normals(&self) -> [[f64; 2]; N] {
        let normals = [[self.mu, -1.0], [self.mu, 1.0], [1.0, 0.0], [-1.0, 0.0]];
        std::array::from_fn(|i| normals[i])
    }

    /// E (p − p⁰).
    #[inline]
    fn shift(&self, k: usize) -> f64 {
        self.soft[k] * (self.p[k] - self.anchor[k])
    }

    /// By how much it is off at the velocity `u`.
    #[inline]
    fn look(&mut self, contact: &Contact, u: [f64; 2], left: &mut Left) {
        let cone = N == 2 || is_cone(contact);
        let beside = if cone { 0.0 } else { contact.spring[0].offset - contact.spring[0].rho * u[0] };
        self.mu = if cone || self.tends(contact, u[0]) + beside > 0.0 { contact.friction } else { 0.0 };
        let bound = (self.mu * (self.p[0] + beside)).max(0.0) + contact.hold;
        if !cone && self.rubs {
            self.grip(bound, contact);
            self.mu = if self.moves[1] { self.mu } else { 0.0 };
        }
        let shift = [self.shift(0), self.shift(1)];
        self.sliding = u[1] + shift[1];
        let far = self.far(contact, bound);
        let rounded = ROUNDED * (self.p[0].abs() + self.p[1].abs() + bound.abs());
        let normals = self.normals();
        self.off = [u[0] + contact.bias + shift[0] + self.mu * self.sliding.abs(), self.sliding];
        for i in 0..N {
            if !self.has(i) {
                self.astray[i] = 0.0;
                continue;
            }
            let (s, l) = (self.s[i], self.lambda[i]);
            let astray = far[i] - s;
            // What is no number stays one, to be seen.
            self.astray[i] = if astray.abs() <= rounded { 0.0 } else { astray };
            (0..2).for_each(|k| self.off[k] -= normals[i][k] * l);
            left.residual = worse(worse(left.residual, self.astray[i].abs() / self.mass), (s / self.mass).min(l));
            left.products += s * l;
            left.number += 1;
        }
        for k in 0..2 {
            if N > 2 && !self.moves[k] {
                self.off[k] = 0.0;
            }
            left.residual = worse(left.residual, self.off[k].abs());
            if !contact.compliant[k] {
                left.drawn = left.drawn.max(shift[k].abs());
            }
        }
        (self.slides, self.gives, self.second) = (0.0, 0.0, [0.0; N]);
    }

    /// What p_n would be without friction, whose bounds would not let the whole pass from pressure to tension.
    #[inline]
    fn tends(&self, contact: &Contact, u_n: f64) -> f64 {
        let [least, most] = contact.pressure;
        let free = match contact.compliant[0] {
            true => contact.law[0].offset - contact.law[0].rho * (u_n + contact.bias),
            false => self.p[0] - self.mass * (u_n + contact.bias),
        };
        free.clamp(least, most)
    }

    /// Friction that may bear nothing is left out until it may bear something again.
    fn grip(&mut self, bound: f64, contact: &Contact) {
        let grips = bound > 0.0;
        if self.moves[1] && !grips {
            self.p[1] = 0.0;
        } else if !self.moves[1] && grips {
            for i in 0..2 {
                self.s[i] = bound;
                self.lambda[i] = CRACK * bound / contact.moved[1];
            }
            self.anchor[1] = if contact.compliant[1] { contact.law[1].offset } else { 0.0 };
            self.soft[1] = soft(contact, 1);
        }
        (self.moves[1], self.on[0], self.on[1]) = (grips, grips, grips);
    }

    #[inline]
    fn invert(&mut self) {
        let [e_n, e_t] = self.soft;
        let (mut x, mut z, mut y) = (e_n, 0.0, e_t);
        let normals = self.normals();
        let d: [f64; N] = std::array::from_fn(|i| if self.has(i) { self.lambda[i] / self.s[i] } else { 0.0 });
        // The determinant as a sum of squares: what is near a bound is nearly singular.
        let mut determinant = e_n * e_t;
        for i in 0..N {
            let [n, t] = normals[i];
            x += d[i] * n * n;
            z += d[i] * n * t;
            y += d[i] * t * t;
            determinant += d[i] * (e_t * n * n + e_n * t * t);
            for j in 0..i {
                determinant += d[i] * d[j] * crossed(normals[i], normals[j]).powi(2);
            }
        }
        let whole = N == 2 || self.moves == [true; 2];
        let over = 1.0 / determinant;
        self.inverse = match self.moves {
            _ if whole => [y * over, -z * over, x * over],
            [true, _] => [1.0 / x, 0.0, 0.0],
            [_, true] => [0.0, 0.0, 1.0 / y],
            _ => [0.0; 3],
        };
        for i in 0..N {
            let [n, t] = normals[i];
            if !whole {
                self.lift[i] = applied(self.inverse, [n, t]);
                continue;
            }
            let mut lift = [e_t * n, e_n * t];
            for j in 0..N {
                let across = crossed(normals[i], normals[j]);
                lift[0] += d[j] * normals[j][1] * across;
                lift[1] -= d[j] * normals[j][0] * across;
            }
            self.lift[i] = lift.map(|l| l * over);
        }
    }

    /// Second-order parts and what lags behind, from the last direction.
    #[inline]
    fn correct(&mut self, target: f64, correction: Correction) {
        let share = match correction {
            Correction::Stays => return,
            Correction::Whole { share } | Correction::Even { share, .. } => share,
        };
        for i in 0..N {
            let (ds, dl) = (self.way.s[i], self.way.lambda[i]);
            if let Correction::Even { wide, .. } = correction {
                let product = (self.s[i] + wide * ds) * (self.lambda[i] + wide * dl);
                let missing = product.clamp(target / SPREAD, SPREAD * target) - product;
                self.second[i] -= missing.max(-SPREAD * target);
            } else {
                self.second[i] = ds * dl;
            }
        }
        self.slides = self.slide(share);
        self.gives = share * self.d_gives;
    }

    /// By how much |ũ_t| grows over a share of the direction [m/s].
    #[inline]
    fn slide(&self, share: f64) -> f64 {
        (self.sliding + share * self.d_sliding).abs() - self.sliding.abs()
    }

    /// By how much bound `i` is missed where the impulses stay.
    #[inline]
    fn missed(&self, i: usize) -> f64 {
        self.astray[i] + if N > 2 && i < 2 { self.gives } else { 0.0 }
    }

    /// Impulses for products of `target` where velocities stay.
    #[inline]
    fn aim(&mut self, target: f64) {
        self.right = applied(self.inverse, [-self.off[0] - self.mu * self.slides, -self.off[1]]);
        for i in 0..N {
            if self.has(i) {
                let (s, l) = (self.s[i], self.lambda[i]);
                let held = (target - self.second[i] - l * self.missed(i)) / s - l;
                (0..2).for_each(|k| self.right[k] += self.lift[i][k] * held);
            }
        }
    }

    /// The direction where velocities change by `du`, and what it comes to.
    #[inline]
    fn turn(&mut self, du: [f64; 2], target: f64, keep: f64, course: &mut Course) {
        let back = applied(self.inverse, du);
        let d_p = [self.right[0] - back[0], self.right[1] - back[1]];
        self.way.p = d_p;
        self.d_sliding = du[1] + self.soft[1] * d_p[1];
        // (P5a), which is linear but for μ |ũ_t|.
        let left = [du[0] + self.soft[0] * d_p[0] + self.off[0] + self.mu * self.slides, self.d_sliding + self.off[1]];
        if N == 2 {
            let up = left[0] / self.mu;
            (self.way.lambda[0], self.way.lambda[1]) = (0.5 * (up - left[1]), 0.5 * (up + left[1]));
        } else {
            self.d_gives = -self.mu * self.rho * du[0];
            self.multipliers(left, target);
        }
        let normals = self.normals();
        // What bears at a bound lies at it to rounding: distances follow from the products there.
        let edge = if N == 2 { self.mass * 4.0 * self.mu * self.mu } else { self.mass };
        for i in 0..N {
            if self.has(i) {
                let ([n, t], s, l) = (normals[i], self.s[i], self.lambda[i]);
                let dl = self.way.lambda[i];
                let ds = match s < edge * l {
                    true => (target - self.second[i] - s * dl) / l - s,
                    false => n * d_p[0] + t * d_p[1] + self.missed(i),
                };
                self.way.s[i] = ds;
                if ds < 0.0 {
                    course.share = course.share.min(-keep * s / ds);
                }
                if dl < 0.0 {
                    course.share = course.share.min(-keep * l / dl);
                }
                course.growth[0] += s * dl + l * ds;
                course.growth[1] += ds * dl;
            }
        }
        course.off = course.off.max(self.mu * (self.slide(1.0) - self.slides).abs());
        if N > 2 {
            course.off = course.off.max((self.d_gives - self.gives).abs() / self.mass);
        }
    }

    /// Changes of the multipliers that leave nothing of `left`: those of the products, and as their squares what rounding leaves of
    /// it where a bound is met.
    fn multipliers(&mut self, mut left: [f64; 2], target: f64) {
        let normals = self.normals();
        let (mut x, mut z, mut y) = (0.0, 0.0, 0.0);
        for i in (0..N).filter(|i| self.on[*i]) {
            let ([n, t], s, l) = (normals[i], self.s[i], self.lambda[i]);
            let ds = n * self.way.p[0] + t * self.way.p[1] + self.missed(i);
            let dl = (target - self.second[i] - l * ds) / s - l;
            self.way.lambda[i] = dl;
            left = [left[0] - n * dl, left[1] - t * dl];
            (x, z, y) = (x + l * l * n * n, z + l * l * n * t, y + l * l * t * t);
        }
        (0..2).filter(|k| !self.moves[*k]).for_each(|k| left[k] = 0.0);
        let slight = SLIGHT * (x + y);
        let (x, y) = (x + slight, y + slight);
        let determinant = x * y - z * z;
        if determinant > 0.0 {
            let mend = [(y * left[0] - z * left[1]) / determinant, (x * left[1] - z * left[0]) / determinant];
            for i in (0..N).filter(|i| self.on[*i]) {
                self.way.lambda[i] += self.lambda[i].powi(2) * (normals[i][0] * mend[0] + normals[i][1] * mend[1]);
            }
        }
    }

    /// Impulses and what they mean.
    fn tell(&self, contact: &mut Contact, v: &[Triple]) {
        let cone = is_cone(contact);
        let edge = if cone { 2.0 * self.mu } else { 1.0 };
        let at = [edge, edge, 1.0, 1.0];
        let held: [bool; N] =
            std::array::from_fn(|i| self.has(i) && self.s[i] <= self.mass * at[i] * at[i] * self.lambda[i]);
        let [least, most] = contact.pressure;
        let p_n = match held.get(2..) {
            Some([true, _]) => least,
            Some([_, true]) => most,
            _ if cone && held[0] && held[1] => 0.0,
            _ => self.p[0].clamp(least, most),
        };
        let bound = contact.bound(p_n, contact.velocity(v)[0]);
        let p_t = if self.moves[1] { self.p[1].clamp(-bound, bound) } else { 0.0 };
        (contact.impulse, contact.status) = match [held[0], held[1]] {
            _ if p_n == 0.0 && !(bound > 0.0) => ([0.0; 2], Status::Open),
            [true, false] => ([p_n, p_t], Status::Forth),
            [false, true] => ([p_n, p_t], Status::Back),
            _ => ([p_n, p_t], Status::Stick),
        };
        for k in 0..2 {
            if !contact.compliant[k] {
                contact.law[k].offset = contact.impulse[k];
            }
        }
    }
}

fn inertia(residual: &mut [Triple], mass: &[Triple], free: &[Triple], v: &[Triple]) {
    for (body, r) in residual.iter_mut().enumerate() {
        (0..3).for_each(|k| r[k] = mass[body][k] * (v[body][k] - free[body][k]));
    }
}

fn crossed(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn applied([a, b, c]: [f64; 3], [x, y]: [f64; 2]) -> [f64; 2] {
    [a * x + b * y, b * x + c * y]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Linear;

    /// Numbers from −1 to 1.
    struct Draw(u64);

    impl Draw {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 33) as f64 / (1u64 << 30) as f64 - 1.0
        }

        fn of(&mut self, low: f64, high: f64) -> f64 {
            low + (high - low) * 0.5 * (self.next() + 1.0)
        }
    }

    const MASS: Triple = [2.0, 2.0, 0.3];

    /// Contacts of six bodies in a row and of each with the base, of every kind: rigid and springs, with bounds of tension and crushing,
    /// what friction bears beside pressure, springs and dashpots beside, none across, none along.
    fn contacts(draw: &mut Draw, matrix: &Blocks) -> Vec<Contact> {
        let inverse = vec![MASS.map(|m| 1.0 / m); 6];
        let mut contacts = Vec::new();
        for b in 0..6usize {
            for a in [None, b.checked_sub(1)] {
                let (mut n, mut t) = ([draw.next(), draw.next()], [0.0; 2]);
                let length = n[0].hypot(n[1]);
                n = n.map(|x| x / length);
                (t[0], t[1]) = (-n[1], n[0]);
                let row = |d: [f64; 2], sign: f64, arm: f64| [sign * d[0], sign * d[1], arm];
                let arms = [draw.next(), draw.next(), draw.next(), draw.next()].map(|x| 0.3 * x);
                let rows =
                    [[row(n, -1.0, arms[0]), row(n, 1.0, arms[1])], [row(t, -1.0, arms[2]), row(t, 1.0, arms[3])]];
                if a.is_none() && b > 0 && draw.next() > 0.0 {
                    continue;
                }
                let slot = a.map(|a| matrix.slot(a, b));
                let mut c = Contact::rigid((a, b), slot, rows, &inverse, [draw.of(0.0, 2.0), draw.of(-0.5, 0.5)]);
                let kind = |draw: &mut Draw, odds: f64| draw.of(0.0, 1.0) < odds;
                c.friction = if kind(draw, 0.8) { draw.of(0.05, 0.8) } else { 0.0 };
                c.bias = if kind(draw, 0.3) { draw.of(-0.3, 0.3) } else { 0.0 };
                if kind(draw, 0.3) {
                    c.hold = draw.of(0.0, 1.0);
                }
                if kind(draw, 0.3) {
                    c.pressure[0] = -draw.of(0.0, 1.0);
                }
                if kind(draw, 0.3) {
                    c.pressure[1] = draw.of(0.1, 2.0);
                }
                for k in 0..2 {
                    if kind(draw, 0.4) {
                        c.compliant[k] = true;
                        c.law[k] = Linear { offset: draw.of(-0.3, 1.0), rho: c.moved[k] * draw.of(0.1, 50.0) };
                    }
                }
                for k in 0..2 {
                    if kind(draw, 0.2) {
                        c.spring[k] = Linear { offset: draw.of(-0.5, 0.5), rho: c.moved[k] * draw.of(0.1, 5.0) };
                    }
                }
                if kind(draw, 0.1) {
                    // Nothing presses but the spring beside.
                    (c.compliant[0], c.law[0]) = (true, Linear::default());
                    c.pressure = [0.0, f64::INFINITY];
                }
                contacts.push(c);
            }
        }
        contacts
    }

    /// What a solution leaves of (P1) to (P4), looked up in the laws themselves [m/s].
    fn left(contacts: &[Contact], v: &[Triple], free: &[Triple]) -> f64 {
        let mut balance: Vec<Triple> =
            (0..6).map(|body| [0, 1, 2].map(|k| MASS[k] * (v[body][k] - free[body][k]))).collect();
        let mut worst: f64 = 0.0;
        for c in contacts {
            let u = c.velocity(v);
            c.push(&mut balance, c.whole(c.impulse, u));
            let law = |k: usize| match c.compliant[k] {
                true => c.law[k],
                false => Linear { offset: c.impulse[k], rho: c.moved[k] },
            };
            let at = |k: usize, u: f64| law(k).offset - law(k).rho * u;
            let bound = c.bound(c.impulse[0], u[0]);
            let wanted = [at(0, u[0] + c.bias).clamp(c.pressure[0], c.pressure[1]), at(1, u[1]).clamp(-bound, bound)];
            for k in 0..2 {
                let over = if c.compliant[k] { c.law[k].rho.max(c.moved[k]) } else { c.moved[k] };
                worst = worse(worst, (wanted[k] - c.impulse[k]).abs() / over);
            }
        }
        worse(worst, unbalance(&balance, &[MASS; 6]))
    }

    /// Whatever bounds contacts have, what is called solved obeys their laws; nearly all is solved.
    #[test]
    fn every_kind_of_contact_obeys_its_laws() {
        let pairs: Vec<_> = (1..6).map(|b| (b - 1, b)).collect();
        let mut matrix = Blocks::new(6, &pairs);
        let mut solved = 0;
        let mut interior = Interior::default();
        for seed in 0..500 {
            let mut draw = Draw(seed);
            let mut contacts = contacts(&mut draw, &matrix);
            let free: Vec<Triple> = (0..6).map(|_| [draw.next(), draw.next(), draw.next()]).collect();
            let mut v = vec![[0.0; 3]; 6];
            let effort = interior.solve(&mut matrix, (&[MASS; 6], &free), &mut contacts, &mut v, (1e-6, 1e-6));
            let left = left(&contacts, &v, &free);
            if effort.converged {
                solved += 1;
                assert!(left < 1e-5, "seed {seed}: {left:e} {effort:?}");
            }
        }
        // Contacts that point anywhere may have no solution.
        assert!(solved > 440, "{solved}");
    }
}
