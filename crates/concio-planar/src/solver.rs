//! Velocities at the end of a step that satisfy (P1) to (P4) of [`crate::contact`].
//!
//! [`Solver::newton`] takes the p on the right, and the p_n that bounds friction,
//! from the last iterate. (P1) is then the gradient of a convex function of v, quadratic in pieces: Newton's method with a
//! search along the line finds its least value in a few solutions, and p is taken anew from there until it stays: an
//! augmented Lagrangian. The matrix is that of the masses and ρ over the contacts that bear; it is symmetric, and factorised
//! only when one of them opens, closes, sticks or slips. Where this does not end at once, an interior point method goes on.
//! Where few contacts bear, as under a block that rocks, it begins with what they did in the step before.
//! [`Solver::gauss_seidel`] goes through the contacts one by one, as contact dynamics usually does (Jean 1999).

use serde::{Deserialize, Serialize};

use crate::blocks::{Blocks, Factors, Triple};
use crate::contact::{Answer, Contact, Effort, Linear, STIFFENING, Status, unbalance, worse};
use crate::interior::{Interior, Survey, inertia};
use crate::order::Orders;

/// Newton iterations after which a step is given up.
const MOST: usize = 200;
/// Newton iterations before the interior point method takes over where it can, and what each may leave out of balance.
const FEW: usize = 4;
const QUICKLY: f64 = 0.1;
/// Times in a row that the first of these fails after which it is left out for so many steps, where the second ends by Newton's method: a wall
/// that slides goes on sliding. Twice as many each time that it fails again, so many times at most.
const FAILING: u32 = 4;
const LEFT_OUT: u32 = 8;
const DOUBLED: u32 = 3;
/// Points on a line at which the slope is looked at, at most.
const LOOKS: usize = 30;
/// Slope that is left on a line, over that at its start.
const FLAT: f64 = 1e-3;
/// What a solution with factors of another step must leave of the residual at most.
const STALE: f64 = 0.1;

/// What a solver takes from step to step: the next begins with the factors of the last, and with what failed before, and ends at other bits
/// without them.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Known {
    known: Vec<(bool, bool)>,
    factors: Factors,
    failures: u32,
    left_out: u32,
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
    trial: Vec<Answer>,
    velocity: Vec<[f64; 2]>,
    change: Vec<[f64; 2]>,
    /// What bounds friction [N s].
    bound: Vec<f64>,
    interior: Interior,
    /// Times in a row that the augmented Lagrangian failed, and steps that it has been left out since.
    failures: u32,
    left_out: u32,
    /// Velocities, and of each contact offsets, impulses and what they mean, before an attempt.
    start: Vec<Triple>,
    kept: Vec<([f64; 2], [f64; 2], Status)>,
}

impl Solver {
    /// For so many bodies, of which these pairs may touch.
    pub(crate) fn new(bodies: usize, pairs: &[(usize, usize)], orders: &Orders) -> Self {
        let zero = vec![[0.0; 3]; bodies];
        Solver {
            matrix: Blocks::new(bodies, pairs, orders),
            known: Vec::new(),
            residual: zero.clone(),
            work: zero.clone(),
            step: zero,
            trial: Vec::new(),
            velocity: Vec::new(),
            change: Vec::new(),
            bound: Vec::new(),
            interior: Interior::default(),
            failures: 0,
            left_out: 0,
            start: Vec::new(),
            kept: Vec::new(),
        }
    }

    /// Whether it is for no bodies.
    pub fn is_empty(&self) -> bool {
        self.residual.is_empty()
    }

    /// The matrix, for the slots of its pairs.
    pub fn matrix(&self) -> &Blocks {
        &self.matrix
    }

    /// What the next step begins with.
    pub fn known(&self) -> Known {
        let (failures, left_out) = (self.failures, self.left_out);
        match self.known.is_empty() {
            true => Known { failures, left_out, ..Known::default() },
            false => Known { known: self.known.clone(), factors: self.matrix.keep(), failures, left_out },
        }
    }

    /// Goes on with what a solver of the same bodies and pairs knew; false where it is not of these.
    pub fn take_up(&mut self, Known { known, factors, failures, left_out }: Known) -> bool {
        let fits = known.is_empty() || self.matrix.take_up(factors);
        (self.failures, self.left_out) = (failures, left_out);
        self.known = if fits { known } else { Vec::new() };
        fits
    }

    /// Solves a step to `tolerance` [m/s]: the augmented Lagrangian, for as long as it falls quickly, as it does where
    /// contacts go on doing what they did; then, unless a contact moves nothing, an interior point method, which may leave
    /// `enough` [m/s] where it does not come nearer. `v` holds a guess on entry. Where the first failed several times in a row it is left out
    /// for some steps. Where neither solves it the former goes on, for a few hundred iterations at most; a step that is rather taken in two
    /// (`halves`) is left unsolved instead where nearly all contacts have springs.
    pub fn newton(
        &mut self,
        mass: &[Triple],
        free: &[Triple],
        contacts: &mut [Contact],
        v: &mut [Triple],
        (tolerance, enough): (f64, f64),
        halves: bool,
    ) -> Effort {
        // All that is asked of each, in one go: where there are many they are far away.
        let mut survey = Survey::default();
        self.begin_keeping(v);
        for contact in contacts.iter() {
            survey.see(contact);
            self.keep_one(contact);
        }
        if !survey.fits {
            return self.lagrangian((mass, free), contacts, v, tolerance, (MOST, f64::INFINITY));
        }
        // From nothing the first presses blocks against each other no more than they have to be.
        let limit = if survey.new { (MOST, f64::INFINITY) } else { (FEW, QUICKLY) };
        let left_out = !survey.new && self.left_out < self.pause() && survey.may_end();
        let first = if left_out {
            self.left_out += 1;
            Effort { residual: f64::INFINITY, ..Effort::default() }
        } else {
            let first = self.lagrangian((mass, free), contacts, v, tolerance, limit);
            self.left_out = 0;
            if first.converged {
                self.failures = 0;
                return first;
            }
            let most = if survey.may_end() { FAILING + DOUBLED } else { FAILING };
            self.failures = most.min(self.failures + 1);
            self.restore(contacts, v);
            first
        };
        // Its factors overwrite those that are known.
        self.known.clear();
        let halves = halves && survey.may_end();
        let bodies = (mass, free);
        let second = self.interior.solve(&mut self.matrix, bodies, (contacts, &survey), v, (tolerance, enough), halves);
        if second.residual <= enough {
            return first.then(second);
        }
        if left_out {
            self.left_out = self.pause();
        }
        if halves {
            return first.then(second);
        }
        // An interior point method that went astray says nothing.
        let nearer = !left_out && second.residual <= first.residual;
        if nearer {
            self.keep(contacts, v);
        } else {
            self.restore(contacts, v);
        }
        let third = self.lagrangian((mass, free), contacts, v, tolerance, (MOST, f64::INFINITY));
        let effort = first.then(second).then(third);
        if nearer && worse(second.residual, third.residual) > second.residual {
            self.restore(contacts, v);
            return Effort { residual: second.residual, ..effort };
        }
        effort
    }

    /// Steps for which the augmented Lagrangian is left out.
    fn pause(&self) -> u32 {
        self.failures.checked_sub(FAILING).map_or(0, |more| LEFT_OUT << more.min(DOUBLED))
    }

    fn keep(&mut self, contacts: &[Contact], v: &[Triple]) {
        self.begin_keeping(v);
        contacts.iter().for_each(|contact| self.keep_one(contact));
    }

    fn begin_keeping(&mut self, v: &[Triple]) {
        self.kept.clear();
        self.start.clear();
        self.start.extend_from_slice(v);
    }

    fn keep_one(&mut self, contact: &Contact) {
        self.kept.push((contact.law.map(|l| l.offset), contact.impulse, contact.status));
    }

    fn restore(&self, contacts: &mut [Contact], v: &mut [Triple]) {
        for (contact, (offset, impulse, status)) in contacts.iter_mut().zip(&self.kept) {
            (0..2).for_each(|k| contact.law[k].offset = offset[k]);
            (contact.impulse, contact.status) = (*impulse, *status);
        }
        v.copy_from_slice(&self.start);
    }

    /// Newton's method on (P1) with (P4), so many iterations at most and as long as each of them leaves no more than a
    /// share of what is out of balance; with a share below 1, after [`Solver::keep`], it may begin with what goes on as it did.
    fn lagrangian(
        &mut self,
        (mass, free): (&[Triple], &[Triple]),
        contacts: &mut [Contact],
        v: &mut [Triple],
        tolerance: f64,
        (most, share): (usize, f64),
    ) -> Effort {
        let mut effort = Effort::default();
        let n = contacts.len();
        self.trial.resize(n, Default::default());
        self.velocity.resize(n, [0.0; 2]);
        self.change.resize(n, [0.0; 2]);
        self.bound.clear();
        let pressed = |c: &Contact| c.bound(c.impulse[0].clamp(c.pressure[0], c.pressure[1]), c.velocity(v)[0]);
        self.bound.extend(contacts.iter().map(pressed));
        let mut fresh = false;
        let mut size = self.unbalanced(mass, free, contacts, v);
        if share < 1.0 && size > tolerance && self.is_determined(contacts) {
            self.resume((mass, free), contacts, v);
            (effort.iterations, effort.factorisations, fresh) = (1, 1, true);
            let limit = (share * size).max(tolerance);
            size = self.unbalanced(mass, free, contacts, v);
            if !(size <= limit) {
                v.copy_from_slice(&self.start);
                size = self.unbalanced(mass, free, contacts, v);
            }
        }
        while effort.iterations < most {
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
            // What is no number says so too.
            if !fresh && (now > STALE * size || now.is_nan()) {
                self.known.clear();
            }
            let slowly = now > (share * size).max(tolerance);
            size = now;
            if slowly {
                break;
            }
        }
        if !effort.converged {
            effort.residual = worse(effort.residual, size);
        }
        effort
    }

    /// Whether contacts that bore before hold no more than the bodies at them have velocities: where a block rocks their impulses follow from
    /// the motion; in walls there are mostly more.
    fn is_determined(&mut self, contacts: &[Contact]) -> bool {
        let mut held = 0;
        self.step.fill([0.0; 3]);
        for (contact, bound) in contacts.iter().zip(&self.bound) {
            let answer = contact.goes_on([0.0; 2], *bound);
            let holds = usize::from(answer.yields) + usize::from(answer.status == Status::Stick);
            if holds > 0 {
                held += holds;
                if held > 3 * self.step.len() {
                    return false;
                }
                contact.rows.each([1.0; 2], |body, _| self.step[body] = [1.0; 3]);
            }
        }
        held as f64 <= self.step.iter().flatten().sum()
    }

    /// Velocities at which contacts go on doing what they did, whether they then can or not.
    fn resume(&mut self, (mass, free): (&[Triple], &[Triple]), contacts: &[Contact], v: &mut [Triple]) {
        inertia(&mut self.residual, mass, free, v);
        for (k, contact) in contacts.iter().enumerate() {
            let u = contact.velocity(v);
            self.trial[k] = contact.goes_on(u, self.bound[k]);
            contact.push(&mut self.residual, contact.whole(self.trial[k].impulse, u));
        }
        // Factors of the last step would leave what has turned since.
        self.factorise(mass, contacts);
        self.step.copy_from_slice(&self.residual);
        self.matrix.solve(&mut self.step, &mut self.work);
        for (v, step) in v.iter_mut().zip(&self.step) {
            (0..3).for_each(|k| v[k] -= step[k]);
        }
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
            *change = contact.rows.change(&self.step).map(|x| -x);
        }
        let at = |share: f64| {
            let mut sum = slope + share * growth;
            for (k, contact) in contacts.iter().enumerate() {
                let (u, d) = (self.velocity[k], self.change[k]);
                let u = [u[0] + share * d[0], u[1] + share * d[1]];
                let p = contact.whole(contact.answer(u, self.bound[k]).impulse, u);
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
        inertia(&mut self.residual, mass, free, v);
        for (k, contact) in contacts.iter().enumerate() {
            self.velocity[k] = contact.velocity(v);
            self.trial[k] = contact.answer(self.velocity[k], self.bound[k]);
            contact.push(&mut self.residual, contact.whole(self.trial[k].impulse, self.velocity[k]));
        }
        unbalance(&self.residual, mass)
    }

    /// Takes the impulses of the last iterate; returns by how much they still violate the laws [m/s].
    fn accept(&mut self, contacts: &mut [Contact]) -> f64 {
        let mut worst: f64 = 0.0;
        for (k, contact) in contacts.iter_mut().enumerate() {
            let Answer { impulse, status, .. } = self.trial[k];
            for k in 0..2 {
                if !contact.compliant[k] {
                    worst = worse(worst, (impulse[k] - contact.law[k].offset).abs() / contact.law[k].rho);
                    contact.law[k].offset = impulse[k];
                }
            }
            (contact.impulse, contact.status) = (impulse, status);
            let bound = contact.bound(impulse[0], self.velocity[k][0]);
            if contact.compliant[1] && status != Status::Stick {
                worst = worst.max((bound - self.bound[k]).abs() / (STIFFENING * contact.moved[1]));
            }
            self.bound[k] = bound;
        }
        worst
    }

    /// Whether the last factors are those of the contacts that bear and stick now.
    fn factors_fit(&self) -> bool {
        self.known.len() == self.trial.len()
            && !self.known.is_empty()
            && self.trial.iter().zip(&self.known).all(|(t, k)| stiff(t) == *k)
    }

    fn factorise(&mut self, mass: &[Triple], contacts: &[Contact]) {
        self.known.clear();
        self.known.extend(self.trial.iter().map(stiff));
        self.matrix.reset(mass);
        for (contact, (normal, tangent)) in contacts.iter().zip(&self.known) {
            let rho = |k: usize, on: bool| contact.spring[k].rho + if on { contact.law[k].rho } else { 0.0 };
            for (rho, rows) in [(rho(0, *normal), contact.rows.normal), (rho(1, *tangent), contact.rows.tangent)] {
                if rho > 0.0 {
                    couple(&mut self.matrix, contact, rho, rows);
                }
            }
        }
        self.matrix.factorise();
    }

    /// Contact by contact, again and again, until none changes a velocity by more than `tolerance` [m/s]: for contacts
    /// that are rigid, without bonds and springs.
    pub fn gauss_seidel(
        &mut self,
        inverse_mass: &[Triple],
        free: &[Triple],
        contacts: &mut [Contact],
        v: &mut [Triple],
        tolerance: f64,
        rounds: usize,
    ) -> Effort {
        v.copy_from_slice(free);
        for contact in contacts.iter() {
            thrust(contact, contact.impulse, inverse_mass, v);
        }
        let mut effort = Effort::default();
        while effort.iterations < rounds {
            let mut worst: f64 = 0.0;
            for contact in contacts.iter_mut() {
                let u = contact.velocity(v);
                // One contact alone: the mass that it moves is ρ.
                let own = contact.moved;
                let law = [0, 1].map(|k| Linear { offset: contact.impulse[k], rho: own[k] });
                let alone = Contact { law, ..*contact };
                let p_n = alone.answer(u, 0.0).impulse[0];
                let Answer { impulse: p, status, .. } = alone.answer(u, contact.friction * p_n);
                let change = [p[0] - contact.impulse[0], p[1] - contact.impulse[1]];
                worst = worst.max((change[0] / own[0]).abs()).max((change[1] / own[1]).abs());
                thrust(contact, change, inverse_mass, v);
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
fn stiff(answer: &Answer) -> (bool, bool) {
    (answer.yields, answer.status == Status::Stick)
}

/// Adds `times` the square of a row over both bodies of a contact.
fn couple(matrix: &mut Blocks, contact: &Contact, times: f64, rows: [Triple; 2]) {
    matrix.add(contact.rows.second(), times, rows[1]);
    if let (Some(a), Some(slot)) = (contact.rows.first(), contact.slot) {
        matrix.add(a, times, rows[0]);
        matrix.add_pair(slot, times, rows);
    }
}

/// Adds an impulse to the velocities.
fn thrust(contact: &Contact, p: [f64; 2], inverse: &[Triple], v: &mut [Triple]) {
    contact.rows.each(p, |body, push| (0..3).for_each(|k| v[body][k] += inverse[body][k] * push[k]));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After four failures in a row the augmented Lagrangian is left out, for longer with each that follows, up to 64 steps.
    #[test]
    fn what_goes_on_failing_is_left_out_for_longer() {
        let mut solver = Solver::new(0, &[], &Orders::anywhere());
        let pauses = [0, 3, 4, 5, 6, 7, u32::MAX].map(|failures| {
            solver.failures = failures;
            solver.pause()
        });
        assert_eq!(pauses, [0, 0, 8, 16, 32, 64, 64]);
    }
}
