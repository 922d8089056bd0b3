//! Velocities at the end of a step from contact with dry friction, without penalty.
//!
//! With v the velocities after the step, v_f what they would be without contact, u_n and u_t the velocities with which the
//! two sides of a contact point part and slide, p_n and p_t the impulses there:
//!
//! (P1)  M (v − v_f) = Σ Hᵀ p
//!
//! (P2)  0 ≤ u_n + b ⊥ p_n ≥ 0
//!
//! (P3)  |p_t| ≤ μ p_n, and p_t = −μ p_n sign(u_t) where u_t ≠ 0
//!
//! b is e u_n of before for a restitution e, or what a gap that is still open allows. (P2) and (P3) are the fixed points of
//!
//! (P4)  p_n = [p_n − ρ (u_n + b)]₊,   p_t = clamp(p_t − ρ u_t, ±μ p_n)
//!
//! for any ρ > 0 (Alart and Curnier 1991). [`Solver::newton`] takes the p on the right, and the p_n that bounds friction,
//! from the last iterate. (P1) is then the gradient of a convex function of v, quadratic in pieces: Newton's method with a
//! search along the line finds its least value in a few solutions, and p is taken anew from there until it stays: an
//! augmented Lagrangian. The matrix is that of the masses and ρ over the contacts that bear; it is symmetric, and factorised
//! only when one of them opens, closes, sticks or slips. [`Solver::gauss_seidel`] goes through the contacts one by one, as
//! contact dynamics usually does (Jean 1999).

use crate::blocks::{Blocks, Slot, Triple};

/// ρ over the mass that a contact moves: large for few repetitions, small enough for 16 digits.
const STIFFENING: f64 = 1e4;
/// Newton iterations after which a step is given up.
const MOST: usize = 200;
/// Points on a line at which the slope is looked at, at most.
const LOOKS: usize = 30;
/// Slope that is left on a line, over that at its start.
const FLAT: f64 = 1e-3;
/// What a solution with factors of another step must leave of the residual at most.
const STALE: f64 = 0.1;

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

/// A contact point during one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// First body; none for what moves with the base.
    pub a: Option<usize>,
    /// Second body.
    pub b: usize,
    /// Where the pair stands in the matrix, for two bodies.
    pub slot: Option<Slot>,
    /// Derivatives of the parting velocity by the velocities of both.
    pub normal: [Triple; 2],
    /// The same of the sliding velocity.
    pub tangent: [Triple; 2],
    /// μ.
    pub friction: f64,
    /// b [m/s].
    pub bias: f64,
    /// ρ of normal and tangent [kg].
    pub rho: [f64; 2],
    /// Impulses p_n and p_t [N s]; what they are on entry is where the solution starts.
    pub impulse: [f64; 2],
    /// What it does.
    pub status: Status,
}

impl Contact {
    /// Parting and sliding velocity [m/s].
    pub fn velocity(&self, v: &[Triple]) -> [f64; 2] {
        let second = v[self.b];
        let mut u = [dot(self.normal[1], second), dot(self.tangent[1], second)];
        if let Some(a) = self.a {
            u[0] += dot(self.normal[0], v[a]);
            u[1] += dot(self.tangent[0], v[a]);
        }
        u
    }

    /// The right side of (P4), friction bounded by `bound`: impulses and what they mean.
    #[inline]
    fn law(&self, [u_n, u_t]: [f64; 2], bound: f64) -> ([f64; 2], Status) {
        let p_n = (self.impulse[0] - self.rho[0] * (u_n + self.bias)).max(0.0);
        let p_t = self.impulse[1] - self.rho[1] * u_t;
        if !(p_n > 0.0 || bound > 0.0) {
            ([0.0; 2], Status::Open)
        } else if p_t > bound {
            ([p_n, bound], Status::Forth)
        } else if p_t < -bound {
            ([p_n, -bound], Status::Back)
        } else {
            ([p_n, p_t], Status::Stick)
        }
    }

    /// Sets ρ from the masses: that of a push at this point.
    pub fn weigh(&mut self, inverse_mass: &[Triple]) {
        let of = |rows: [Triple; 2]| {
            let one = |row: Triple, body: usize| (0..3).map(|k| row[k] * row[k] * inverse_mass[body][k]).sum::<f64>();
            1.0 / (self.a.map_or(0.0, |a| one(rows[0], a)) + one(rows[1], self.b))
        };
        self.rho = [of(self.normal), of(self.tangent)].map(|m| STIFFENING * m);
    }
}

/// How a step was solved.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Linear systems solved, or rounds through the contacts.
    pub iterations: usize,
    /// Matrices factorised.
    pub factorisations: usize,
    /// Times that impulses were taken anew.
    pub rounds: usize,
    /// Largest violation of (P2) and (P3) [m/s].
    pub residual: f64,
    /// Whether it came below what was asked for.
    pub converged: bool,
}

/// Solves steps of bodies whose pairs stay the same.
#[derive(Debug, Clone)]
pub struct Solver {
    matrix: Blocks,
    /// What the factors were made for.
    known: Vec<(bool, bool)>,
    residual: Vec<Triple>,
    work: Vec<Triple>,
    step: Vec<Triple>,
    /// Of each contact: impulses by (P4) and what they mean, velocities, and their change along the line.
    trial: Vec<([f64; 2], Status)>,
    velocity: Vec<[f64; 2]>,
    change: Vec<[f64; 2]>,
    /// What bounds friction [N s].
    bound: Vec<f64>,
}

impl Solver {
    /// For so many bodies, of which these pairs may touch.
    pub fn new(bodies: usize, pairs: &[(usize, usize)]) -> Self {
        let zero = vec![[0.0; 3]; bodies];
        Solver {
            matrix: Blocks::new(bodies, pairs),
            known: Vec::new(),
            residual: zero.clone(),
            work: zero.clone(),
            step: zero,
            trial: Vec::new(),
            velocity: Vec::new(),
            change: Vec::new(),
            bound: Vec::new(),
        }
    }

    /// The matrix, for the slots of its pairs.
    pub fn matrix(&self) -> &Blocks {
        &self.matrix
    }

    /// Newton's method on (P1) with (P4), to `tolerance` [m/s]. `v` holds a guess on entry.
    pub fn newton(
        &mut self,
        mass: &[Triple],
        free: &[Triple],
        contacts: &mut [Contact],
        v: &mut [Triple],
        tolerance: f64,
    ) -> Effort {
        let mut effort = Effort::default();
        let n = contacts.len();
        self.trial.resize(n, Default::default());
        self.velocity.resize(n, [0.0; 2]);
        self.change.resize(n, [0.0; 2]);
        self.bound.clear();
        self.bound.extend(contacts.iter().map(|c| c.friction * c.impulse[0]));
        let mut fresh = false;
        let mut size = self.unbalanced(mass, free, contacts, v);
        while effort.iterations < MOST {
            if size <= tolerance {
                effort.residual = self.accept(contacts);
                effort.rounds += 1;
                size = self.unbalanced(mass, free, contacts, v);
                if effort.residual <= tolerance && size <= tolerance {
                    effort.converged = true;
                    break;
                }
                if size <= 1e-3 * tolerance {
                    continue;
                }
            }
            if !self.factors_fit() {
                self.factorise(mass, contacts);
                effort.factorisations += 1;
                fresh = true;
            }
            self.step.copy_from_slice(&self.residual);
            self.matrix.solve(&mut self.step, &mut self.work);
            effort.iterations += 1;
            self.go(mass, free, contacts, v);
            let now = self.unbalanced(mass, free, contacts, v);
            if !fresh && now > STALE * size {
                self.known.clear();
            }
            size = now;
        }
        effort
    }

    /// From `v` against `self.step` as far as the convex function falls.
    fn go(&mut self, mass: &[Triple], free: &[Triple], contacts: &[Contact], v: &mut [Triple]) {
        // Masses alone: slope at the start and its growth.
        let (mut slope, mut growth) = (0.0, 0.0);
        for body in 0..v.len() {
            for k in 0..3 {
                let d = -self.step[body][k];
                slope += d * mass[body][k] * (v[body][k] - free[body][k]);
                growth += d * d * mass[body][k];
            }
        }
        for (change, contact) in self.change.iter_mut().zip(contacts) {
            *change = contact.velocity(&self.step).map(|x| -x);
        }
        let at = |share: f64| {
            let mut sum = slope + share * growth;
            for (k, contact) in contacts.iter().enumerate() {
                let (u, d) = (self.velocity[k], self.change[k]);
                let p = contact.law([u[0] + share * d[0], u[1] + share * d[1]], self.bound[k]).0;
                sum -= p[0] * d[0] + p[1] * d[1];
            }
            sum
        };
        let whole = at(1.0);
        let mut share = 1.0;
        let start = at(0.0);
        if whole > FLAT * start.abs() {
            // The slope rises along the line and is straight in pieces: regula falsi, halving the end that stays (Illinois).
            let (mut low, mut high) = ((0.0, start), (1.0, whole));
            for _ in 0..LOOKS {
                share = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
                let now = at(share);
                if now.abs() <= FLAT * start.abs() {
                    break;
                }
                if now > 0.0 {
                    high = (share, now);
                    low.1 *= 0.5;
                } else {
                    low = (share, now);
                    high.1 *= 0.5;
                }
            }
        }
        for (v, step) in v.iter_mut().zip(&self.step) {
            (0..3).for_each(|k| v[k] -= share * step[k]);
        }
    }

    /// (P1) as it stands at `v`, into `self.residual`; what (P4) says of each contact, into `self.trial`. Returns its
    /// largest part over the mass [m/s].
    fn unbalanced(&mut self, mass: &[Triple], free: &[Triple], contacts: &[Contact], v: &[Triple]) -> f64 {
        for (body, r) in self.residual.iter_mut().enumerate() {
            (0..3).for_each(|k| r[k] = mass[body][k] * (v[body][k] - free[body][k]));
        }
        for (k, contact) in contacts.iter().enumerate() {
            self.velocity[k] = contact.velocity(v);
            self.trial[k] = contact.law(self.velocity[k], self.bound[k]);
            let (p, status) = self.trial[k];
            if status == Status::Open {
                continue;
            }
            if let Some(a) = contact.a {
                push(&mut self.residual[a], contact.normal[0], contact.tangent[0], p);
            }
            push(&mut self.residual[contact.b], contact.normal[1], contact.tangent[1], p);
        }
        let part = |(r, m): (&Triple, &Triple)| {
            (r[0] / m[0]).abs().max((r[1] / m[1]).abs()).max((r[2] * r[2] / (m[2] * m[0])).sqrt())
        };
        self.residual.iter().zip(mass).map(part).fold(0.0, f64::max)
    }

    /// Takes the impulses of the last iterate; returns by how much they still violate the laws [m/s].
    fn accept(&mut self, contacts: &mut [Contact]) -> f64 {
        let mut worst: f64 = 0.0;
        for (k, contact) in contacts.iter_mut().enumerate() {
            let (p, status) = self.trial[k];
            for k in 0..2 {
                worst = worst.max((p[k] - contact.impulse[k]).abs() / contact.rho[k]);
            }
            (contact.impulse, contact.status) = (p, status);
            self.bound[k] = contact.friction * p[0];
        }
        worst
    }

    /// Whether the last factors are those of the contacts that bear and stick now.
    fn factors_fit(&self) -> bool {
        self.known.len() == self.trial.len() && self.trial.iter().zip(&self.known).all(|(t, k)| stiff(t) == *k)
    }

    fn factorise(&mut self, mass: &[Triple], contacts: &[Contact]) {
        self.known.clear();
        self.known.extend(self.trial.iter().map(stiff));
        self.matrix.reset(mass);
        for (contact, (normal, tangent)) in contacts.iter().zip(&self.known) {
            if *normal {
                couple(&mut self.matrix, contact, contact.rho[0], contact.normal);
            }
            if *tangent {
                couple(&mut self.matrix, contact, contact.rho[1], contact.tangent);
            }
        }
        self.matrix.factorise();
    }

    /// Contact by contact, again and again, until none changes a velocity by more than `tolerance` [m/s].
    pub fn gauss_seidel(
        &mut self,
        mass: &[Triple],
        free: &[Triple],
        contacts: &mut [Contact],
        v: &mut [Triple],
        tolerance: f64,
        rounds: usize,
    ) -> Effort {
        let inverse: Vec<Triple> = mass.iter().map(|m| m.map(|m| 1.0 / m)).collect();
        v.copy_from_slice(free);
        for contact in contacts.iter() {
            thrust(contact, contact.impulse, &inverse, v);
        }
        let mut effort = Effort::default();
        while effort.iterations < rounds {
            let mut worst: f64 = 0.0;
            for contact in contacts.iter_mut() {
                let [u_n, u_t] = contact.velocity(v);
                // One contact alone: its own masses are ρ.
                let own = contact.rho.map(|r| r / STIFFENING);
                let alone = Contact { rho: own, ..*contact };
                let p_n = alone.law([u_n, u_t], 0.0).0[0];
                let (p, status) = alone.law([u_n, u_t], contact.friction * p_n);
                let change = [p[0] - contact.impulse[0], p[1] - contact.impulse[1]];
                worst = worst.max((change[0] / own[0]).abs()).max((change[1] / own[1]).abs());
                thrust(contact, change, &inverse, v);
                (contact.impulse, contact.status) = (p, status);
            }
            effort.iterations += 1;
            effort.residual = worst;
            if worst <= tolerance {
                effort.converged = true;
                break;
            }
        }
        effort
    }
}

/// Whether a contact resists in its normal and along its tangent.
fn stiff((p, status): &([f64; 2], Status)) -> (bool, bool) {
    (p[0] > 0.0, *status == Status::Stick)
}

/// Adds `times` the square of a row over both bodies of a contact.
fn couple(matrix: &mut Blocks, contact: &Contact, times: f64, rows: [Triple; 2]) {
    matrix.add(contact.b, times, rows[1]);
    if let (Some(a), Some(slot)) = (contact.a, contact.slot) {
        matrix.add(a, times, rows[0]);
        matrix.add_pair(slot, times, rows);
    }
}

/// Adds an impulse to the velocities.
fn thrust(contact: &Contact, p: [f64; 2], inverse: &[Triple], v: &mut [Triple]) {
    let mut on = |body: usize, side: usize| {
        for k in 0..3 {
            v[body][k] += inverse[body][k] * (contact.normal[side][k] * p[0] + contact.tangent[side][k] * p[1]);
        }
    };
    if let Some(a) = contact.a {
        on(a, 0);
    }
    on(contact.b, 1);
}

fn push(r: &mut Triple, normal: Triple, tangent: Triple, p: [f64; 2]) {
    for k in 0..3 {
        r[k] -= normal[k] * p[0] + tangent[k] * p[1];
    }
}

fn dot(a: Triple, b: Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
