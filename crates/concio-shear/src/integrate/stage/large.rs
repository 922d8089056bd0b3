//! The iteration of large walls, (T1) as `iterate` solves it, without a factorisation per iteration.
//!
//! A wall of a hundred thousand blocks has hundreds of head joints that open or close in every stage, and the tangent of
//! every joint that rubs moves a little. Both are small changes of the matrix that was factorised as the step began, so its
//! factors lead conjugate gradients (`conjugate`) instead. What differs from `iterate`:
//!
//! * It begins at velocities that go on as the stages before did, and joints that are open or closed there.
//! * Joints open and close where the search has come to, and the search goes on from there: each costs its two blocks and
//!   nothing else.
//! * The iteration ends by forces, (T3): what is out of balance at any block is below [`PART_OF_GROUND`] of the force that the
//!   ground brings or [`PART_OF_MOTION`] of the largest acceleration times its mass, would move it by less than the
//!   accuracy if its neighbours were held, and works less than a part of what the energy account allows; with the tangents
//!   up to [`SEARCHED`] of that, with the laws to all of it.

use serde::{Deserialize, Serialize};

use super::{Failure, MOST_ITERATIONS, Stage};
use crate::integrate::conjugate::largest;
use crate::state::Tangents;
use crate::system::System;

/// Iterations after which the matrix is factorised as it is now.
const MOST_LED: usize = 8;
/// Times that joints may open and close in one search.
const MOST_ROUNDS: usize = 30;
/// Force that may be out of balance: part of the mass times the acceleration of the ground, and of the largest in the stage.
const PART_OF_GROUND: f64 = 1e-4;
const PART_OF_MOTION: f64 = 1e-2;
/// Part of that at which the search with the tangents ends where laws may miss them, and part of it up to which a joint stays
/// open or closed as it was.
const SEARCHED: f64 = 0.9;
const FELT: f64 = 0.25;
/// Least acceleration that counts, over the accuracy of the velocity in a stage.
const FAINT: f64 = 1e-3;

/// Spring of a joint over all else that holds one of its blocks from which on its opening or closing is no small change, and how
/// many of these are left to the search.
const STRONG: f64 = 10.0;
const MOST_STRONG: u32 = 4;
/// What a factorisation costs, in iterations.
const FACTORISATION: u64 = 4;
/// Length of a step over that of the factors, within which they serve.
const ALIKE: std::ops::RangeInclusive<f64> = 0.6..=1.7;

/// How long factors have served, and how well: they are made anew when a further try with them costs more than all tries
/// with new ones did on average.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Wear {
    /// τ of their matrix [s].
    tau: f64,
    /// Tries of a step with them, iterations of the first, of the last, and of all beyond as many as the first took each.
    tries: u64,
    first: u64,
    last: u64,
    beyond: u64,
    /// Joints that have opened or closed since and hold their blocks more than all else does.
    strong: u32,
}

impl Wear {
    /// Of factors made in the try at hand.
    fn new(tau: f64) -> Self {
        Wear { tau, tries: 1, first: 0, last: 0, beyond: 0, strong: 0 }
    }

    /// Another try of a step begins; whether they serve for it.
    fn begin(&mut self) -> bool {
        if self.tries == 1 {
            self.first = self.last;
        }
        let beyond = self.last.saturating_sub(self.first);
        self.beyond += beyond;
        let worn = beyond * self.tries > FACTORISATION + self.beyond;
        (self.tries, self.last) = (self.tries + 1, 0);
        !worn
    }
}

/// What may be left of the equations.
#[derive(Debug, Clone, Copy)]
pub struct Enough {
    /// Impulse over mass that the ground brings [m/s].
    ground: f64,
    /// Error of V that is allowed [m/s].
    accuracy: f64,
    /// Work that is allowed, over what the impulses out of balance do [J].
    work: f64,
}

/// What is left.
#[derive(Debug, Clone, Copy)]
struct Left {
    /// Largest excess over what is allowed [N s]; none where it is not above 0.
    excess: f64,
    /// Work of what is out of balance [J].
    work: f64,
}

impl Stage {
    #[inline(always)]
    pub(super) fn iterate_large(
        &mut self,
        system: &System,
        tangents: &mut Tangents,
        tau: f64,
        ground: f64,
        accuracy: f64,
    ) -> Result<(), Failure> {
        let n = self.mass.len();
        self.v[n + 1] = self.solution[n + 1];
        let enough = Enough { ground: PART_OF_GROUND * tau * ground.abs(), accuracy, work: self.work };
        let first = self.tau != tau;
        self.tau = tau;
        self.begin_large();
        self.start(system, tangents);
        let most = enough.impulse(&self.change[..n]);
        if first {
            // From the state and nothing else: what was tried before is not part of a checkpoint.
            self.assemble_elastic(system, tangents);
        }
        self.make(system, tangents);
        self.flip_large(tangents, most, accuracy);
        self.load_elastic(system, ground);
        for _ in 0..MOST_ITERATIONS {
            if !self.wear.is_some_and(|wear| ALIKE.contains(&(tau / wear.tau))) {
                self.factorise_large()?;
            }
            self.search(tangents, enough)?;
            self.mismatch(system, tangents);
            let most = enough.impulse(&self.change[..n]);
            if self.left(most, accuracy, |i| self.rhs[i]).is_enough(enough.work) {
                self.finish_large(tangents);
                return Ok(());
            }
            self.move_tangents(system, tangents);
            self.make(system, tangents);
        }
        Err(Failure::TooLong)
    }

    #[inline(always)]
    fn factorise_large(&mut self) -> Result<(), Failure> {
        self.wear = None;
        self.factorise()?;
        self.wear = Some(Wear::new(self.tau));
        Ok(())
    }

    /// Takes the guess, and V_p, to the places of the unknowns.
    #[inline(always)]
    fn begin_large(&mut self) {
        let n = self.mass.len();
        for ((a, v), &place) in self.guess.iter().zip(&self.v).zip(self.matrix.places()) {
            self.change[place as usize] = self.tau * a;
            self.speed[place as usize] = *v;
        }
        self.change[n..].fill(0.0);
    }

    /// Solves J x = b for the tangents as they are, joints opening and closing on the way.
    #[inline(always)]
    fn search(&mut self, tangents: &mut Tangents, enough: Enough) -> Result<(), Failure> {
        let n = self.mass.len();
        self.trial.copy_from_slice(&self.change);
        self.right_side(tangents);
        std::mem::swap(&mut self.trial, &mut self.change);
        self.matrix.begin(&self.trial[..n], &self.change[..n]);
        let share = if self.rubs.len() == 0 { 1.0 } else { SEARCHED };
        let (mut led, mut factorised, mut most) = (0, 0, enough.impulse(&self.change[..n]));
        for _ in 0..MOST_ROUNDS {
            while !self.left(share * most, share * enough.accuracy, |_| 0.0).is_enough(share * enough.work) {
                let changed = self.wear.is_none_or(|wear| wear.strong > MOST_STRONG);
                if led == MOST_LED || changed {
                    if factorised == MOST_ITERATIONS {
                        return Err(Failure::TooLong);
                    }
                    self.factorise_large()?;
                    self.matrix.turn();
                    (led, factorised) = (0, factorised + 1);
                }
                led += 1;
                self.iterations += 1;
                self.wear.iter_mut().for_each(|wear| wear.last += 1);
                self.matrix.advance(&mut self.change[..n]).map_err(|_| Failure::TooLong)?;
                most = enough.impulse(&self.change[..n]);
            }
            if !self.flip_large(tangents, most, enough.accuracy) {
                return Ok(());
            }
            self.matrix.turn();
        }
        Err(Failure::TooLong)
    }

    /// What is left where at most `most` times the mass [m/s] and `accuracy` times the diagonal [m/s] may be out of balance,
    /// with the tangents, or with the laws that miss them by `missed` [N s].
    #[inline(always)]
    fn left(&self, most: f64, accuracy: f64, missed: impl Fn(usize) -> f64) -> Left {
        let (mut excess, mut work) = (f64::NEG_INFINITY, 0.0);
        let matrix = self.matrix.residual().iter().zip(&self.matrix.diagonal);
        let blocks = matrix.zip(&self.mass).zip(self.change.iter().zip(&self.speed));
        for (i, (((r, d), m), (x, v))) in blocks.enumerate() {
            let r = r - missed(i);
            excess = excess.max(r.abs() - (most * m).min(accuracy * d));
            // What is no number stays one here.
            work += r * (v + x);
        }
        Left { excess, work }
    }

    /// Opens and closes joints, and brings matrix, load and residual up to date with each; whether there was any. A joint
    /// whose force is a small part of what may be out of balance, as in `left`, stays as it is.
    #[inline(always)]
    fn flip_large(&mut self, tangents: &mut Tangents, most: f64, accuracy: f64) -> bool {
        let Stage { joints, gap, mass, change, closed, matrix, diagonal, lower, load, tau, wear, .. } = self;
        let tau = *tau;
        let (mut any, mut strong) = (false, 0);
        for (gap, &e) in gap.iter().zip(&joints.one_sided) {
            let e = e as usize;
            let [a, b] = joints.sides[e].map(|s| s as usize);
            let d = gap + tau * (change[a] - change[b]);
            let impulse = tau * joints.stiffness[e];
            if (d > 0.0) == closed[e] || impulse * d.abs() <= FELT * (most * mass[a]).min(accuracy * matrix.diagonal[a])
            {
                continue;
            }
            any = true;
            closed[e] = d > 0.0;
            tangents.closed[e] = closed[e];
            let impulse = if closed[e] { impulse } else { -impulse };
            let (spring, push) = (tau * impulse, impulse * gap);
            strong += u32::from(is_strong(spring.abs(), !closed[e], [a, b], &matrix.diagonal));
            load[a] -= push;
            load[b] += push;
            diagonal[a] += spring;
            matrix.stiffen(joints.slot[e].at(), [a, b], spring, impulse * d);
            if let Some(slot) = joints.slot[e].at() {
                diagonal[b] += spring;
                lower[slot] -= spring;
            }
        }
        wear.iter_mut().for_each(|wear| wear.strong += strong);
        any
    }

    /// Another try of a step begins: worn factors are forgotten. Those of a try that failed are no good.
    pub(super) fn begin_try(&mut self) {
        self.wear = self.wear.filter(|_| self.solved).and_then(|mut wear| wear.begin().then_some(wear));
        self.solved = false;
    }

    /// What the factors of large walls are, for a run that is taken up again: they may be those of a step before.
    pub fn keep(&self) -> Option<Kept> {
        let wear = self.wear.filter(|_| self.solved)?;
        let factors = self.matrix.rough_factors()?.map(<[f32]>::to_vec);
        Some(Kept { wear, factors })
    }

    /// Takes them up; false where they are none of this wall's.
    pub fn take_up(&mut self, kept: Option<Kept>) -> bool {
        self.wear = kept.as_ref().map(|kept| kept.wear);
        self.solved = kept.is_some();
        kept.is_none_or(|kept| self.matrix.take_up(&kept.factors))
    }

    /// Leaves the tangents at the solution, where the laws are.
    #[inline(always)]
    fn finish_large(&mut self, tangents: &mut Tangents) {
        for (i, &place) in self.matrix.places().iter().enumerate() {
            self.solution[i] = self.v[i] + self.change[place as usize];
        }
        tangents.mu.copy_from_slice(&self.mu);
        tangents.slope.copy_from_slice(&self.slope);
        tangents.velocity.copy_from_slice(&self.velocity);
    }
}

/// Whether a joint's spring outweighs all else that holds one of its sides; `acts` says whether it is part of `diagonal`.
#[inline(always)]
fn is_strong(spring: f64, acts: bool, sides: [usize; 2], diagonal: &[f64]) -> bool {
    let own = if acts { spring } else { 0.0 };
    sides.iter().any(|&side| diagonal.get(side).is_some_and(|d| spring > STRONG * (d - own)))
}

/// Factors and their wear.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Kept {
    wear: Wear,
    factors: [Vec<f32>; 2],
}

impl Enough {
    /// Impulse over mass that may be left where velocities change by `x` [m/s].
    #[inline(always)]
    fn impulse(self, x: &[f64]) -> f64 {
        self.ground.max(PART_OF_MOTION * largest(x)).max(FAINT * self.accuracy)
    }
}

impl Left {
    #[inline(always)]
    fn is_enough(self, work: f64) -> bool {
        self.excess <= 0.0 && self.work.abs() <= work
    }
}
