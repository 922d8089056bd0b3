//! Velocities at the end of a step by an interior point method, for contacts that bear no tension.
//!
//! What friction can bear is a cone with two edges, and with α, β ≥ 0 along them
//!
//! (P5)  p = C γ = (α + β, μ (α − β)),   0 ≤ w = Cᵀ (ũ + E (p − p⁰)) ⊥ γ ≥ 0,   ũ = (u_n + b + μ |u_t|, u_t)
//!
//! are (P2) and (P3): μ |u_t| takes back the opening that the edges would give to what slides (De Saxcé and Feng 1998).
//! For given μ |u_t| these are the conditions of a convex quadratic program, whichever impulses redundant contacts share.
//! E has 1/ρ of (P4) on its diagonal, that of a spring where a contact is compliant; elsewhere it is small, p⁰ is what the
//! contact bore before, and both choose among impulses that give the same motion those nearest to p⁰.
//!
//! Every iteration solves (P1) and (P5), linear about the iterate and with a product γ w that falls, for v: a matrix like that
//! of [`crate::contact`] with a full 2 × 2 block for each contact. It is factorised once per iteration and used for a
//! prediction, a correction (Mehrotra 1992) and another towards equal products (Gondzio 1996), each with μ |u_t| as the last
//! one left it. However many contacts open and close, that takes a dozen or two of iterations.

use crate::blocks::{Blocks, Triple};
use crate::contact::{Contact, Effort, Status, unbalance, worse};

/// Iterations after which a step is given up.
const MOST: usize = 60;
/// 1/E over ρ of a rigid contact: more leaves what head joints bear to the cones instead of to what they bore before, less
/// gives way by more than the tolerance.
const FIRM: f64 = 1e4;
/// Iterations in which what is left has to be halved, once it is small enough.
const PATIENCE: usize = 8;
/// μ beyond which μ |u_t| of the last direction is no good guess for the next.
const STEEP: f64 = 3.0;
/// Least impulse at the start, over what is out of balance, and over what was borne before.
const FLOOR: f64 = 1.0;
const SHARE: f64 = 0.02;
/// Least opening at the start, over what is out of balance.
const CRACK: f64 = 0.01;
/// Share of the way to the boundary that is gone.
const INSIDE: f64 = 0.995;
/// How much farther the second correction is to come, and how far products may lie from their mean.
const REACH: f64 = 0.3;
const SPREAD: f64 = 10.0;

/// A contact during a solution.
#[derive(Debug, Clone, Copy, Default)]
struct Point {
    gamma: [f64; 2],
    w: [f64; 2],
    /// p⁰.
    anchor: [f64; 2],
    /// Diagonal of E.
    soft: [f64; 2],
    /// Sliding velocity that is not a spring's.
    sliding: f64,
    /// By how much w lies off (P5).
    off: [f64; 2],
    /// Change of μ |u_t| along the direction.
    opens: f64,
    /// Second-order part of the products.
    second: [f64; 2],
    /// S⁻¹ with S = W Γ⁻¹ + Cᵀ E C, and what it is applied to.
    inverse: [f64; 3],
    right: [f64; 2],
    d_gamma: [f64; 2],
    d_w: [f64; 2],
    d_sliding: f64,
    kept: [[f64; 2]; 2],
}

/// Room for the solution.
#[derive(Debug, Clone, Default)]
pub(crate) struct Interior {
    points: Vec<Point>,
    residual: Vec<Triple>,
    step: Vec<Triple>,
    kept: Vec<Triple>,
    work: Vec<Triple>,
}

/// What is left of the conditions [m/s], and the mean product γ w.
struct Left {
    residual: f64,
    mean: f64,
    /// Largest E (p − p⁰) of a rigid contact [m/s].
    drawn: f64,
}

/// Whether [`Interior::solve`] knows what a contact does.
pub(crate) fn fits(contact: &Contact) -> bool {
    let plain = contact.pressure == [0.0, f64::INFINITY] && contact.hold == 0.0 && contact.friction <= STEEP;
    let firm = (0..2).all(|k| !contact.compliant[k] || contact.law[k].rho > 0.0);
    plain && firm && contact.spring[0] == Default::default() && contact.moved.iter().all(|m| m.is_finite())
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
                self.points.iter_mut().zip(contacts.iter()).for_each(|(point, c)| point.anchor_at(c));
                effort.rounds += 1;
            }
            (least, since) = if effort.residual <= 0.5 * least { (effort.residual, 0) } else { (least, since + 1) };
            let stays = effort.residual <= enough && since >= PATIENCE;
            if effort.iterations == MOST || stays || !left.residual.is_finite() {
                break;
            }
            self.factorise(matrix, mass, contacts);
            effort.iterations += 1;
            let share = self.direct(matrix, contacts, left.mean);
            // Where products vanish before the conditions hold, rounding ends in nothing over nothing.
            if !self.step.iter().flatten().all(|x| x.is_finite()) {
                break;
            }
            for (v, step) in v.iter_mut().zip(&self.step) {
                (0..3).for_each(|k| v[k] += share * step[k]);
            }
            for point in &mut self.points {
                for k in 0..2 {
                    point.gamma[k] += share * point.d_gamma[k];
                    point.w[k] += share * point.d_w[k];
                }
            }
        }
        effort.factorisations = effort.iterations;
        self.points.iter().zip(contacts).for_each(|(point, contact)| point.tell(contact));
        effort
    }

    /// Inside the cones, near what was borne before: as far from their edges as that is off balance.
    fn start(&mut self, mass: &[Triple], free: &[Triple], contacts: &[Contact], v: &[Triple], tolerance: f64) {
        let n = v.len();
        self.points.clear();
        self.points.resize(contacts.len(), Point::default());
        for room in [&mut self.residual, &mut self.step, &mut self.kept, &mut self.work] {
            room.resize(n, [0.0; 3]);
        }
        inertia(&mut self.residual, mass, free, v);
        for contact in contacts {
            contact.push(&mut self.residual, contact.whole(borne(contact), contact.velocity(v)));
        }
        let scale = unbalance(&self.residual, mass).max(tolerance);
        for (point, contact) in self.points.iter_mut().zip(contacts) {
            let (p, u, mu) = (borne(contact), contact.velocity(v), contact.friction);
            let side = if mu > 0.0 { p[1] / mu } else { 0.0 };
            let floor = FLOOR * contact.moved[0] * scale + SHARE * p[0];
            point.soft = [0, 1].map(|k| 1.0 / (contact.law[k].rho * if contact.compliant[k] { 1.0 } else { FIRM }));
            point.anchor = [0, 1].map(|k| if contact.compliant[k] { contact.law[k].offset } else { p[k] });
            point.gamma = [0.5 * (p[0] + side), 0.5 * (p[0] - side)].map(|g| g.max(floor));
            let w = across(mu, [u[0] + contact.bias + mu * u[1].abs(), u[1]]);
            point.w = [0, 1].map(|k| w[k].max(CRACK * FLOOR * scale * floor / point.gamma[k]));
        }
    }

    /// What is left of (P1), into `self.residual`, and of (P5).
    fn look(&mut self, mass: &[Triple], free: &[Triple], contacts: &[Contact], v: &[Triple]) -> Left {
        inertia(&mut self.residual, mass, free, v);
        let (mut worst, mut drawn, mut sum) = (0.0f64, 0.0f64, 0.0);
        for (point, contact) in self.points.iter_mut().zip(contacts) {
            let (mu, u) = (contact.friction, contact.velocity(v));
            let p = along(mu, point.gamma);
            let shift = [0, 1].map(|k| point.soft[k] * (p[k] - point.anchor[k]));
            (0..2).filter(|k| !contact.compliant[*k]).for_each(|k| drawn = drawn.max(shift[k].abs()));
            point.sliding = u[1] + shift[1];
            let wanted = across(mu, [u[0] + contact.bias + shift[0] + mu * point.sliding.abs(), point.sliding]);
            point.off = [0, 1].map(|k| point.w[k] - wanted[k]);
            (point.opens, point.second) = (0.0, [0.0; 2]);
            for k in 0..2 {
                let apart = (point.gamma[k] / contact.moved[0]).min(point.w[k]);
                worst = worse(worse(worst, point.off[k].abs()), apart);
                sum += point.gamma[k] * point.w[k];
            }
            contact.push(&mut self.residual, contact.whole(p, u));
        }
        let mean = sum / (2 * self.points.len()).max(1) as f64;
        Left { residual: worse(worst, unbalance(&self.residual, mass)), mean, drawn }
    }

    fn factorise(&mut self, matrix: &mut Blocks, mass: &[Triple], contacts: &[Contact]) {
        matrix.reset(mass);
        for (point, contact) in self.points.iter_mut().zip(contacts) {
            let mu = contact.friction;
            let [e_n, e_t] = [point.soft[0], mu * mu * point.soft[1]];
            let [x, y] = [0, 1].map(|k| point.w[k] / point.gamma[k] + e_n + e_t);
            let z = e_n - e_t;
            let determinant = x * y - z * z;
            let [a, b, c] = [y / determinant, -z / determinant, x / determinant];
            point.inverse = [a, b, c];
            // C S⁻¹ Cᵀ, and the springs beside.
            let stiffness = [a + 2.0 * b + c, mu * (a - c), mu * mu * (a - 2.0 * b + c) + contact.spring[1].rho];
            contact.couple(matrix, stiffness);
        }
        matrix.factorise();
    }

    /// The direction, into `self.step` and the points, and how far it is gone.
    fn direct(&mut self, matrix: &Blocks, contacts: &[Contact], mean: f64) -> f64 {
        let share = self.pass(matrix, contacts, 0.0, 1.0);
        let after = |p: &Point| (0..2).map(|k| p.product(k, share)).sum::<f64>();
        let after = self.points.iter().map(after).sum::<f64>() / (2 * self.points.len()).max(1) as f64;
        // Rounding takes products of nothing below 0.
        let target = (mean * (after / mean).powi(3)).max(0.0);
        for (point, contact) in self.points.iter_mut().zip(contacts) {
            point.second = [0, 1].map(|k| point.d_gamma[k] * point.d_w[k]);
            point.slide(contact.friction, share);
        }
        let share = self.pass(matrix, contacts, target, INSIDE);
        let wide = (share + REACH).min(1.0);
        for (point, contact) in self.points.iter_mut().zip(contacts) {
            point.kept = [point.d_gamma, point.d_w];
            for k in 0..2 {
                let product = point.product(k, wide);
                let missing = product.clamp(target / SPREAD, SPREAD * target) - product;
                point.second[k] -= missing.max(-SPREAD * target);
            }
            point.slide(contact.friction, share);
        }
        self.kept.copy_from_slice(&self.step);
        let farther = self.pass(matrix, contacts, target, INSIDE);
        if farther > share {
            return farther;
        }
        self.step.copy_from_slice(&self.kept);
        self.points.iter_mut().for_each(|point| [point.d_gamma, point.d_w] = point.kept);
        share
    }

    /// A direction to products of `target`; how far it may be gone, `keep` of the way to the boundary and 1 at most.
    fn pass(&mut self, matrix: &Blocks, contacts: &[Contact], target: f64, keep: f64) -> f64 {
        for (step, residual) in self.step.iter_mut().zip(&self.residual) {
            *step = residual.map(|r| -r);
        }
        for (point, contact) in self.points.iter_mut().zip(contacts) {
            point.right =
                [0, 1].map(|k| (target - point.second[k]) / point.gamma[k] - point.w[k] + point.off[k] - point.opens);
            let p = along(contact.friction, applied(point.inverse, point.right));
            contact.push(&mut self.step, p.map(|p| -p));
        }
        matrix.solve(&mut self.step, &mut self.work);
        let mut share: f64 = 1.0;
        for (point, contact) in self.points.iter_mut().zip(contacts) {
            let (mu, du) = (contact.friction, contact.change(&self.step));
            let cu = across(mu, du);
            point.d_gamma = applied(point.inverse, [point.right[0] - cu[0], point.right[1] - cu[1]]);
            let dp = along(mu, point.d_gamma);
            let du = [0, 1].map(|k| du[k] + point.soft[k] * dp[k]);
            let dw = across(mu, du);
            point.d_w = [0, 1].map(|k| dw[k] + point.opens - point.off[k]);
            point.d_sliding = du[1];
            for k in 0..2 {
                for (x, d) in [(point.gamma[k], point.d_gamma[k]), (point.w[k], point.d_w[k])] {
                    if d < 0.0 {
                        share = share.min(-keep * x / d);
                    }
                }
            }
        }
        share
    }
}

impl Point {
    fn product(&self, k: usize, share: f64) -> f64 {
        (self.gamma[k] + share * self.d_gamma[k]) * (self.w[k] + share * self.d_w[k])
    }

    fn slide(&mut self, mu: f64, share: f64) {
        self.opens = mu * ((self.sliding + share * self.d_sliding).abs() - self.sliding.abs());
    }

    fn anchor_at(&mut self, contact: &Contact) {
        let p = along(contact.friction, self.gamma);
        (0..2).filter(|k| !contact.compliant[*k]).for_each(|k| self.anchor[k] = p[k]);
    }

    /// Impulses and what they mean.
    fn tell(&self, contact: &mut Contact) {
        let bears = [0, 1].map(|k| self.gamma[k] > contact.moved[0] * self.w[k]);
        let impulse = along(contact.friction, self.gamma);
        (contact.impulse, contact.status) = match bears {
            [false, false] => ([0.0; 2], Status::Open),
            [true, true] => (impulse, Status::Stick),
            [true, false] => (impulse, Status::Forth),
            [false, true] => (impulse, Status::Back),
        };
        for k in 0..2 {
            if !contact.compliant[k] {
                contact.law[k].offset = contact.impulse[k];
            }
        }
    }
}

/// What a contact bore before, within its cone.
fn borne(contact: &Contact) -> [f64; 2] {
    let p_n = contact.impulse[0].max(0.0);
    [p_n, contact.impulse[1].clamp(-contact.friction * p_n, contact.friction * p_n)]
}

fn inertia(residual: &mut [Triple], mass: &[Triple], free: &[Triple], v: &[Triple]) {
    for (body, r) in residual.iter_mut().enumerate() {
        (0..3).for_each(|k| r[k] = mass[body][k] * (v[body][k] - free[body][k]));
    }
}

/// C γ.
fn along(mu: f64, [a, b]: [f64; 2]) -> [f64; 2] {
    [a + b, mu * (a - b)]
}

/// Cᵀ u.
fn across(mu: f64, [u_n, u_t]: [f64; 2]) -> [f64; 2] {
    [u_n + mu * u_t, u_n - mu * u_t]
}

fn applied([a, b, c]: [f64; 3], [x, y]: [f64; 2]) -> [f64; 2] {
    [a * x + b * y, b * x + c * y]
}
