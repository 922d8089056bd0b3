//! The numbers of all lanes of a group, and one iteration of the stage (T1) in every lane at once.
//!
//! What is done to a lane are the operations of [`crate::integrate::stage`] in the same order, but for three things
//! that change no bit: what a lane does not need at the moment is computed all the same, the prediction and the elastic
//! part are made anew in every iteration, and the factorisation gathers what it takes from an entry instead of
//! scattering it.

use pulp::{Simd, WithSimd};

use crate::integrate::joints::FAR;
use crate::integrate::stage::STILL;
use crate::integrate::tableau::{STAGES, Tableau};
use crate::lanes::rows::{Groups, Law, Mask, Read, Rows, V, WIDTH, friction};
use crate::lanes::topology::{Incidence, NONE, SHARES, TO_A, TO_B, TO_DIAGONAL, Topology};

/// Rows of [`Work::lane`]: one number per lane.
pub const TAU: usize = 0;
pub const GROUND: usize = 1;
/// Allowed error of V [m/s].
pub const ACCURACY: usize = 2;
/// Step [s].
pub const STEP: usize = 3;
/// Largest correction, sum of all, whether a joint opened or closed, whether a pivot was not positive.
pub const CORRECTION: usize = 4;
pub const SUM: usize = 5;
pub const FLIPPED: usize = 6;
pub const BAD_PIVOT: usize = 7;
/// One where the lane's stage has converged, where it goes on with another iteration.
pub const CONVERGED: usize = 8;
pub const GOING: usize = 18;
/// Number of the lane's stage.
pub const STAGE: usize = 9;
/// Largest estimated error of velocity and displacement, and their sum.
pub const ERROR_V: usize = 10;
pub const ERROR_Z: usize = 11;
pub const ERROR_SUM: usize = 12;
/// One where the step was accepted, where it was given up.
pub const ACCEPTED: usize = 13;
pub const GIVEN_UP: usize = 14;
/// Largest |z| and |v| of the accepted state.
pub const SCALE_Z: usize = 15;
pub const SCALE_V: usize = 16;
/// One where an accepted step waits for its account.
pub const PENDING: usize = 17;
/// h a_ij of the lane's stage, one row per earlier stage.
pub const WEIGHTS: usize = 19;
const LANE_ROWS: usize = WEIGHTS + STAGES;

/// Rows of [`Work::joints`]: damping, and the stiffness as it acts, 0 where the joint is open.
pub const DAMPING: usize = 0;
pub const ENGAGED: usize = 1;
/// Rows of [`Work::rubs`]: N in the equation of a, μ_s − μ_d, μ_d, δ_v, β/δ_v, α, the larger N of both sides.
pub const NORMAL: usize = 0;
pub const EXCESS: usize = 1;
pub const DYNAMIC: usize = 2;
pub const SLIP: usize = 3;
pub const STEEP: usize = 4;
pub const ALPHA: usize = 5;
pub const LARGEST_NORMAL: usize = 6;
/// Rows of [`Work::searches`]: μ_s, δ_v/β, the slope at rest, the sum of N on both sides.
pub const STATIC: usize = 0;
pub const WIDTH_AT_REST: usize = 1;
pub const SLOPE_AT_REST: usize = 2;
pub const NORMALS: usize = 3;
/// Rows of [`Work::one_sided`]: stiffness, and the stiffness that acts in the accepted state.
pub const STIFFNESS: usize = 0;
pub const SAVED: usize = 1;
/// Rows of [`Work::state`] and [`Work::stages`]; the prediction has the first two.
pub const Z: usize = 0;
pub const VELOCITY: usize = 1;
pub const ACCELERATION: usize = 2;
/// Rows of [`Work::tangents`], [`Work::saved`] and the laws: velocity, μ, dμ/dv; the last have V_p too.
pub const AT: usize = 0;
pub const MU: usize = 1;
pub const SLOPE: usize = 2;
const BEFORE: usize = 3;
/// Rows of the factors: L D and L.
const LOWER: usize = 0;
const SCALED: usize = 1;

/// A joint in a lane whose tangent has to be moved along the law.
#[derive(Debug, Clone, Copy)]
pub struct Miss {
    pub rub: u32,
    pub lane: u32,
    pub target: f64,
}

/// All numbers; unknowns by place, base and top after them.
#[derive(Debug)]
pub struct Work {
    pub topology: Topology,
    pub tableau: Tableau,
    /// What a lane is at, see [`TAU`] and after.
    pub lane: Rows,
    // What the system says.
    pub mass: Rows,
    pub joints: Groups<2>,
    pub stiffness: Rows,
    pub rubs: Groups<7>,
    pub searches: Groups<4>,
    pub one_sided: Groups<2>,
    /// The state after the last accepted step, and the tangents there.
    pub state: Groups<3>,
    pub saved: Groups<3>,
    /// The state at the start of the last accepted step.
    pub start: Groups<3>,
    pub tangents: Groups<3>,
    /// Stages of the step, from 1, and the friction there.
    pub stages: Vec<Groups<3>>,
    pub stage_mu: Vec<Rows>,
    // The iteration.
    pub prediction: Groups<2>,
    pub elastic_diagonal: Rows,
    /// What joints and those that rub add to diagonal and right side.
    joint_shares: Groups<SHARES>,
    rub_shares: Groups<SHARES>,
    diagonal: Rows,
    pivot: Rows,
    factors: Groups<2>,
    change: Rows,
    rhs: Rows,
    error_z: Rows,
    pub laws: Groups<4>,
    target: Rows,
    missed: Rows,
    missed_rubs: Vec<u32>,
    pub misses: Vec<Miss>,
}

impl Work {
    /// Zeros for `topology`.
    pub fn new(topology: Topology, tableau: Tableau) -> Self {
        let (n, e, r) = (topology.unknowns as usize, topology.joints.len(), topology.rubs.len());
        let unknowns = || Rows::new(n + 2);
        Work {
            tableau,
            lane: Rows::new(LANE_ROWS),
            mass: unknowns(),
            joints: Groups::new(e),
            stiffness: Rows::new(e),
            rubs: Groups::new(r),
            searches: Groups::new(r),
            one_sided: Groups::new(topology.one_sided.len()),
            state: Groups::new(n + 2),
            saved: Groups::new(r),
            start: Groups::new(n + 2),
            tangents: Groups::new(r),
            stages: (0..tableau.stages).map(|_| Groups::new(n + 2)).collect(),
            stage_mu: (0..tableau.stages).map(|_| Rows::new(r)).collect(),
            prediction: Groups::new(n + 2),
            elastic_diagonal: unknowns(),
            joint_shares: Groups::new(e),
            rub_shares: Groups::new(r),
            diagonal: unknowns(),
            pivot: unknowns(),
            factors: Groups::new(topology.fill as usize),
            change: unknowns(),
            rhs: unknowns(),
            error_z: unknowns(),
            laws: Groups::new(r),
            target: Rows::new(r),
            missed: Rows::new(r),
            missed_rubs: Vec::with_capacity(r),
            misses: Vec::with_capacity(r * WIDTH),
            topology,
        }
    }
}

/// One iteration in every lane; leaves [`CORRECTION`], [`SUM`], [`FLIPPED`] and [`BAD_PIVOT`].
pub struct Iterate<'a>(pub &'a mut Work);

impl WithSimd for Iterate<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let work = self.0;
        work.predict(simd);
        work.assemble_elastic(simd);
        work.assemble_friction(simd);
        work.gather(simd);
        work.factorise(simd);
        solve(simd, &work.topology, &work.factors, &work.pivot, &mut work.change);
        work.flip(simd);
        work.mismatch(simd);
        solve(simd, &work.topology, &work.factors, &work.pivot, &mut work.rhs);
        work.measure(simd);
    }
}

impl Work {
    /// z_p and V_p of the unknowns.
    #[inline(always)]
    fn predict<S: Simd>(&mut self, simd: S) {
        let n = self.topology.unknowns as usize;
        let lane = self.lane.read(simd);
        let state = self.state.read(simd);
        let mut prediction = self.prediction.write(simd);
        let weight = lane.at(WEIGHTS as u32);
        for (mut p, s) in prediction.iter_mut().zip(state.iter()).take(n) {
            p.set(Z, s.row(Z) + weight * s.row(VELOCITY));
            p.set(VELOCITY, s.row(VELOCITY) + weight * s.row(ACCELERATION));
        }
        for j in 1..self.tableau.stages - 1 {
            let stage = self.stages[j].read(simd);
            let weight = lane.at((WEIGHTS + j) as u32);
            for (mut p, s) in prediction.iter_mut().zip(stage.iter()).take(n) {
                p.add(Z, weight * s.row(VELOCITY));
                p.add(VELOCITY, weight * s.row(ACCELERATION));
            }
        }
    }

    /// What the joints add to M + τ Σ B (c + τ k) Bᵀ and −τ (M a_0 + Σ B (c w_p + k (δ_p + τ w_p))).
    #[inline(always)]
    fn assemble_elastic<S: Simd>(&mut self, simd: S) {
        let tau = self.lane.read(simd).at(TAU as u32);
        let zero = V::splat(simd, 0.0);
        let mut factors = self.factors.write(simd);
        for mut entry in factors.iter_mut() {
            entry.set(LOWER, zero);
        }
        let (joints, motion) = (self.joints.read(simd), self.prediction.read(simd));
        let mut shares = self.joint_shares.write(simd);
        let of_joint = joints.iter().zip(shares.iter_mut());
        for ((joint, mut share), at) in of_joint.zip(&self.topology.joints) {
            let [a, b] = at.sides;
            let (damping, engaged) = (joint.row(DAMPING), joint.row(ENGAGED));
            let s = tau * (damping + tau * engaged);
            let ([za, va], [zb, vb]) = (motion.at(a), motion.at(b));
            let w = va - vb;
            let f = tau * (damping * w + engaged * (za - zb + tau * w));
            share.set(TO_DIAGONAL, s);
            share.set(TO_B, f);
            share.set(TO_A, f.negated());
            if at.slot != NONE {
                factors.group(at.slot).subtract(LOWER, s);
            }
        }
    }

    /// The elastic diagonal alone, for lanes in which a joint has just opened or closed.
    #[inline(always)]
    fn assemble_diagonal<S: Simd>(&mut self, simd: S) {
        let tau = self.lane.read(simd).at(TAU as u32);
        let mut shares = self.joint_shares.write(simd);
        for (joint, mut share) in self.joints.read(simd).iter().zip(shares.iter_mut()) {
            share.set(TO_DIAGONAL, tau * (joint.row(DAMPING) + tau * joint.row(ENGAGED)));
        }
        let shares = self.joint_shares.rows().read(simd);
        let mut lists = &self.topology.of_joints.rows[..];
        let diagonals = self.elastic_diagonal.write(simd).into_iter();
        let of_unknown = diagonals.zip(self.mass.read(simd).iter()).zip(&self.topology.of_joints.counts);
        for ((mut diagonal, mass), &count) in of_unknown {
            let (list, rest) = lists.split_at(count as usize);
            lists = rest;
            let mut d = mass;
            for &[to_diagonal, _] in list {
                d = d + shares.at(to_diagonal);
            }
            diagonal.set(0, d);
        }
    }

    /// What friction's tangents add to matrix and right side.
    #[inline(always)]
    fn assemble_friction<S: Simd>(&mut self, simd: S) {
        let tau = self.lane.read(simd).at(TAU as u32);
        let (mut factors, mut laws) = (self.factors.write(simd), self.laws.write(simd));
        let (motion, rubs, tangents) = (self.prediction.read(simd), self.rubs.read(simd), self.tangents.read(simd));
        let mut shares = self.rub_shares.write(simd);
        let of_rub = rubs.iter().zip(tangents.iter()).zip(laws.iter_mut()).zip(shares.iter_mut());
        for ((((rub, tangent), mut law), mut share), at) in of_rub.zip(&self.topology.rubs) {
            let [a, b] = at.sides;
            let (normal, slope) = (rub.row(NORMAL), tangent.row(SLOPE));
            let s = tau * slope * normal;
            let w = motion.of(a, VELOCITY) - motion.of(b, VELOCITY);
            law.set(BEFORE, w);
            let f = normal * (tau * (tangent.row(MU) + slope * (w - tangent.row(AT))));
            share.set(TO_DIAGONAL, s);
            share.set(TO_B, f);
            share.set(TO_A, f.negated());
            if at.slot != NONE {
                factors.group(at.slot).subtract(LOWER, s);
            }
        }
    }

    /// Diagonal and right side of every unknown: mass, elastic joints, friction.
    #[inline(always)]
    fn gather<S: Simd>(&mut self, simd: S) {
        let (tau, ground) = (self.lane.read(simd).at(TAU as u32), self.lane.read(simd).at(GROUND as u32));
        let against = tau.negated();
        let (joints, rubs) = (self.joint_shares.rows().read(simd), self.rub_shares.rows().read(simd));
        let (of_joints, of_rubs) = (&self.topology.of_joints, &self.topology.of_rubs);
        let (mut joint_lists, mut rub_lists) = (&of_joints.rows[..], &of_rubs.rows[..]);
        let to = self
            .elastic_diagonal
            .write(simd)
            .into_iter()
            .zip(self.diagonal.write(simd).into_iter())
            .zip(self.change.write(simd).into_iter());
        let of_unknown = to.zip(self.mass.read(simd).iter()).zip(of_joints.counts.iter().zip(&of_rubs.counts));
        for ((((mut elastic, mut diagonal), mut change), mass), (&joint_count, &rub_count)) in of_unknown {
            let (list, rest) = joint_lists.split_at(joint_count as usize);
            joint_lists = rest;
            let (mut d, mut load) = (mass, against * mass * ground);
            for &[to_diagonal, to_load] in list {
                (d, load) = (d + joints.at(to_diagonal), load + joints.at(to_load));
            }
            elastic.set(0, d);
            let (list, rest) = rub_lists.split_at(rub_count as usize);
            rub_lists = rest;
            for &[to_diagonal, to_load] in list {
                (d, load) = (d + rubs.at(to_diagonal), load + rubs.at(to_load));
            }
            diagonal.set(0, d);
            change.set(0, load);
        }
    }

    /// L D Lᵀ of what was assembled; the pivots become D⁻¹.
    #[inline(always)]
    fn factorise<S: Simd>(&mut self, simd: S) {
        let (diagonal, mut pivot, mut factors) =
            (self.diagonal.read(simd), self.pivot.write(simd), self.factors.write(simd));
        let zero = V::splat(simd, 0.0);
        let mut bad = zero.above(zero);
        let t = &self.topology;
        let (mut rows, mut counts, mut products) = (&t.row_entries[..], &t.product_counts[..], &t.products[..]);
        let mut at = 0u32;
        let columns = t.row_counts.iter().zip(&t.column_counts);
        for (((&in_row, &in_column), mut d), mut pivot) in columns.zip(diagonal.iter()).zip(pivot.iter_mut()) {
            let (of_row, rest) = rows.split_at(in_row as usize);
            rows = rest;
            for &[_, p] in of_row {
                let [lower, scaled] = factors.group(p).both();
                d = d - scaled * lower;
            }
            bad = bad.or(d.above(zero).not());
            let inverse = 1.0 / d;
            pivot.set(0, inverse);
            let (of_column, rest) = counts.split_at(in_column as usize);
            counts = rest;
            for &count in of_column {
                let (of_entry, rest) = products.split_at(count as usize);
                products = rest;
                let mut value = factors.of(at, LOWER);
                for &[p, q] in of_entry {
                    value = value - factors.of(p, SCALED) * factors.of(q, LOWER);
                }
                let mut entry = factors.group(at);
                entry.set(LOWER, value);
                entry.set(SCALED, value * inverse);
                at += 1;
            }
        }
        self.lane.write(simd).set(BAD_PIVOT as u32, bad.as_row());
    }

    /// Brings the active sets up to date.
    #[inline(always)]
    fn flip<S: Simd>(&mut self, simd: S) {
        let zero = V::splat(simd, 0.0);
        let (tau, accuracy) = (self.lane.read(simd).at(TAU as u32), self.lane.read(simd).at(ACCURACY as u32));
        let (motion, change, mass) = (self.prediction.read(simd), self.change.read(simd), self.mass.read(simd));
        let mut joints = self.joints.write(simd);
        let mut flipped = zero.above(zero);
        for (joint, at) in self.one_sided.read(simd).iter().zip(&self.topology.one_sided) {
            let [a, b] = at.sides;
            let ([za, va], [zb, vb]) = (motion.at(a), motion.at(b));
            let gap = za - zb + tau * (va - vb);
            let d = gap + tau * (change.at(a) - change.at(b));
            let stiffness = joint.row(STIFFNESS);
            let felt = (tau * stiffness * d.abs()).above(STILL * accuracy * mass.at(a));
            let mut joint = joints.group(at.joint);
            let (closes, closed) = (d.above(zero), joint.row(ENGAGED).above(zero));
            let flips = felt.and(closes.differs(closed));
            flipped = flipped.or(flips);
            joint.set_where(flips, ENGAGED, closes.pick(stiffness, zero));
        }
        self.lane.write(simd).set(FLIPPED as u32, flipped.as_row());
    }

    /// The laws at the new velocities, and τ Σ B N (μ − tangent) into `rhs`.
    #[inline(always)]
    fn mismatch<S: Simd>(&mut self, simd: S) {
        let tau = self.lane.read(simd).at(TAU as u32);
        let (change, rubs, tangents) = (self.change.read(simd), self.rubs.read(simd), self.tangents.read(simd));
        let (mut laws, mut shares) = (self.laws.write(simd), self.rub_shares.write(simd));
        let of_rub = rubs.iter().zip(tangents.iter()).zip(laws.iter_mut()).zip(shares.iter_mut());
        for ((((rub, tangent), mut at_w), mut share), at) in of_rub.zip(&self.topology.rubs) {
            let [a, b] = at.sides;
            let w = at_w.row(BEFORE) + change.at(a) - change.at(b);
            let law = Law {
                excess: rub.row(EXCESS),
                dynamic: rub.row(DYNAMIC),
                slip_velocity: rub.row(SLIP),
                steep: rub.row(STEEP),
                alpha: rub.row(ALPHA),
            };
            let (mu, slope) = friction(law, w);
            at_w.set(AT, w);
            at_w.set(MU, mu);
            at_w.set(SLOPE, slope);
            let missed = tau * (mu - (tangent.row(MU) + tangent.row(SLOPE) * (w - tangent.row(AT))));
            let f = rub.row(NORMAL) * missed;
            share.set(TO_B, f.negated());
            share.set(TO_A, f);
        }
        let zero = V::splat(simd, 0.0);
        gather_right_side(simd, &self.topology.of_rubs, &self.rub_shares, &mut self.rhs, |_| zero);
    }

    /// Size of the correction.
    #[inline(always)]
    fn measure<S: Simd>(&mut self, simd: S) {
        let (mut most, mut sum) = (V::splat(simd, 0.0), V::splat(simd, 0.0));
        for d in self.rhs.read(simd).iter().take(self.topology.unknowns as usize) {
            (most, sum) = (most.max(d.abs()), sum + d.abs());
        }
        let mut lane = self.lane.write(simd);
        lane.set(CORRECTION as u32, most);
        lane.set(SUM as u32, sum);
    }
}

/// Adds to `first` of each unknown what it has of the right side's shares.
#[inline(always)]
fn gather_right_side<S: Simd>(
    simd: S,
    incidence: &Incidence,
    shares: &Groups<SHARES>,
    to: &mut Rows,
    first: impl Fn(V<S>) -> V<S>,
) {
    let shares = shares.rows().read(simd);
    let mut lists = &incidence.rows[..];
    for (mut to, &count) in to.write(simd).into_iter().zip(&incidence.counts) {
        let (list, rest) = lists.split_at(count as usize);
        lists = rest;
        let mut sum = first(to.row(0));
        for &[_, to_load] in list {
            sum = sum + shares.at(to_load);
        }
        to.set(0, sum);
    }
}

/// Solves with the factors in place.
#[inline(always)]
fn solve<S: Simd>(simd: S, t: &Topology, factors: &Groups<2>, pivot: &Rows, b: &mut Rows) {
    let (factors, mut b) = (factors.read(simd), b.write(simd));
    let mut entries = &t.row_entries[..];
    for (k, &count) in (0u32..).zip(&t.row_counts) {
        let (row, rest) = entries.split_at(count as usize);
        entries = rest;
        let mut x = b.at(k);
        for &[c, p] in row {
            x = x - factors.of(p, SCALED) * b.at(c);
        }
        b.set(k, x);
    }
    let mut backward = t.entry_row.iter().zip(factors.iter()).rev();
    for ((k, &count), inverse) in
        (0..t.unknowns).zip(&t.column_counts).zip(pivot.read(simd).iter().take(t.column_counts.len())).rev()
    {
        let mut x = b.at(k) * inverse;
        for (&r, entry) in backward.by_ref().take(count as usize) {
            x = x - entry.row(SCALED) * b.at(r);
        }
        b.set(k, x);
    }
}

/// After an iteration: lanes that have converged end their stage, the others get new tangents. Leaves
/// [`ERROR_V`], [`ERROR_Z`], [`ERROR_SUM`] when a lane has ended a step.
pub struct Advance<'a> {
    pub work: &'a mut Work,
    /// Stages that a lane has just ended.
    pub ended: [bool; STAGES],
    /// Whether a lane goes on in which a joint has opened or closed.
    pub going_flipped: bool,
}

impl WithSimd for Advance<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let work = self.work;
        work.correct(simd);
        for stage in (1..work.tableau.stages).filter(|&i| self.ended[i]) {
            work.end_stage(simd, stage);
        }
        work.move_tangents(simd);
        for stage in (1..work.tableau.stages).filter(|&i| self.ended[i]) {
            work.keep_friction(simd, stage);
        }
        if self.going_flipped && !work.missed_rubs.is_empty() {
            work.assemble_diagonal(simd);
        }
        work.list_misses();
        if self.ended[work.tableau.stages - 1] {
            work.estimate_error(simd);
        }
    }
}

impl Work {
    /// V, in `change` still relative to V_p.
    #[inline(always)]
    fn correct<S: Simd>(&mut self, simd: S) {
        let n = self.topology.unknowns as usize;
        for (mut x, d) in self.change.write(simd).into_iter().zip(self.rhs.read(simd).iter()).take(n) {
            x.subtract(0, d);
        }
    }

    /// Keeps displacement, velocity and acceleration of the lanes that end `stage`.
    #[inline(always)]
    fn end_stage<S: Simd>(&mut self, simd: S, stage: usize) {
        let lane = self.lane.read(simd);
        let tau = lane.at(TAU as u32);
        let ends = ends(simd, &lane, stage);
        let (motion, change) = (self.prediction.read(simd), self.change.read(simd));
        let mut stages = self.stages[stage].write(simd);
        for ((mut to, from), change) in stages.iter_mut().zip(motion.iter()).zip(change.iter()) {
            let before = from.row(VELOCITY);
            let after = before + change;
            to.set_where(ends, VELOCITY, after);
            to.set_where(ends, ACCELERATION, (after - before) / tau);
            to.set_where(ends, Z, from.row(Z) + tau * after);
        }
    }

    /// Tangents at the solution where the stage has ended; elsewhere at the new velocity, or noted as a miss.
    #[inline(always)]
    fn move_tangents<S: Simd>(&mut self, simd: S) {
        self.missed_rubs.clear();
        let lane = self.lane.read(simd);
        let converged = Mask::of(lane.at(CONVERGED as u32));
        let going = Mask::of(lane.at(GOING as u32));
        let (change, laws, searches) = (self.change.read(simd), self.laws.read(simd), self.searches.read(simd));
        let (mut target, mut missed) = (self.target.write(simd), self.missed.write(simd));
        let mut tangents = self.tangents.write(simd);
        let of_rub = tangents.iter_mut().zip(laws.iter()).zip(searches.iter());
        for (r, (((mut tangent, law), search), at)) in (0u32..).zip(of_rub.zip(&self.topology.rubs)) {
            let [a, b] = at.sides;
            let (w, mu, slope) = (law.row(AT), law.row(MU), law.row(SLOPE));
            let aim = tangent.row(MU) + tangent.row(SLOPE) * (w - tangent.row(AT));
            let misses = (mu - aim).abs().above(FAR * search.row(STATIC)).and(going);
            if misses.any() {
                self.missed_rubs.push(r);
                target.set(r, aim);
                missed.set(r, misses.as_row());
            }
            let solution = law.row(BEFORE) + change.at(a) - change.at(b);
            tangent.set(AT, converged.pick(solution, w));
            tangent.set(MU, converged.pick(mu + slope * (solution - w), mu));
            tangent.set(SLOPE, slope);
        }
    }

    /// Keeps the friction of the lanes that end `stage`.
    #[inline(always)]
    fn keep_friction<S: Simd>(&mut self, simd: S, stage: usize) {
        let ends = ends(simd, &self.lane.read(simd), stage);
        let tangents = self.tangents.read(simd);
        for (mut kept, tangent) in self.stage_mu[stage].write(simd).iter_mut().zip(tangents.iter()) {
            kept.set_where(ends, 0, tangent.row(MU));
        }
    }

    fn list_misses(&mut self) {
        self.misses.clear();
        for &rub in &self.missed_rubs {
            for (lane, missed) in self.missed.row(rub as usize).into_iter().enumerate() {
                if missed > 0.0 {
                    let target = self.target.at(rub as usize, lane);
                    self.misses.push(Miss { rub, lane: lane as u32, target });
                }
            }
        }
    }

    /// (P1) in the lanes that end a step.
    #[inline(always)]
    fn estimate_error<S: Simd>(&mut self, simd: S) {
        let (n, last) = (self.topology.unknowns, self.tableau.stages - 1);
        let (tau, step) = (self.lane.read(simd).at(TAU as u32), self.lane.read(simd).at(STEP as u32));
        let zero = V::splat(simd, 0.0);
        let (mut error_v, mut error_z) = (self.rhs.write(simd), self.error_z.write(simd));
        for i in 0..=last {
            let weight = step * self.tableau.error[i];
            let stage = if i == 0 { self.state.read(simd) } else { self.stages[i].read(simd) };
            for ((mut ev, mut ez), s) in error_v.iter_mut().zip(error_z.iter_mut()).zip(stage.iter()) {
                let (old_v, old_z) = if i == 0 { (zero, zero) } else { (ev.row(0), ez.row(0)) };
                ev.set(0, old_v + weight * s.row(ACCELERATION));
                ez.set(0, old_z + weight * s.row(VELOCITY));
            }
        }
        // Base and top have no error.
        for k in [n, n + 1] {
            error_z.set(k, zero);
        }
        let mut shares = self.joint_shares.write(simd);
        let of_joint = self.joints.read(simd).iter().zip(shares.iter_mut());
        for ((joint, mut share), at) in of_joint.zip(&self.topology.joints) {
            let [a, b] = at.sides;
            let f = tau * joint.row(ENGAGED) * (error_z.at(a) - error_z.at(b));
            share.set(TO_B, f);
            share.set(TO_A, f.negated());
        }
        for (mut ev, mass) in error_v.iter_mut().zip(self.mass.read(simd).iter()) {
            ev.set(0, ev.row(0) * mass);
        }
        gather_right_side(simd, &self.topology.of_joints, &self.joint_shares, &mut self.rhs, |ev| ev);
        solve(simd, &self.topology, &self.factors, &self.pivot, &mut self.rhs);
        let (error_v, error_z) = (self.rhs.read(simd), self.error_z.read(simd));
        let (mut most_v, mut most_z, mut sum) = (zero, zero, zero);
        for (ev, ez) in error_v.iter().zip(error_z.iter()).take(n as usize) {
            let ez = ez + tau * ev;
            (most_v, most_z, sum) = (most_v.max(ev.abs()), most_z.max(ez.abs()), sum + (ev + ez));
        }
        let mut lane = self.lane.write(simd);
        lane.set(ERROR_V as u32, most_v);
        lane.set(ERROR_Z as u32, most_z);
        lane.set(ERROR_SUM as u32, sum);
    }
}

/// Lanes that have just ended `stage`.
#[inline(always)]
fn ends<S: Simd>(simd: S, lane: &Read<S>, stage: usize) -> Mask<S> {
    let of_lane = lane.at(STAGE as u32);
    let stage = V::splat(simd, stage as f64);
    Mask::of(lane.at(CONVERGED as u32)).and(of_lane.at_most(stage)).and(stage.at_most(of_lane))
}

/// Moves the lanes with [`ACCEPTED`] to the end of their step, those with [`GIVEN_UP`] back to its start. Leaves
/// [`SCALE_Z`] and [`SCALE_V`].
pub struct Turn<'a>(pub &'a mut Work);

impl WithSimd for Turn<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let w = self.0;
        let last = w.tableau.stages - 1;
        let accepted = Mask::of(w.lane.read(simd).at(ACCEPTED as u32));
        let given_up = Mask::of(w.lane.read(simd).at(GIVEN_UP as u32));
        if accepted.any() {
            let (mut most_z, mut most_v) = (V::splat(simd, 0.0), V::splat(simd, 0.0));
            let (mut state, mut start) = (w.state.write(simd), w.start.write(simd));
            let arrived = w.stages[last].read(simd);
            let unknowns = state.iter_mut().zip(start.iter_mut()).zip(arrived.iter());
            for (k, ((mut to, mut start), from)) in (0u32..).zip(unknowns) {
                for row in [Z, VELOCITY, ACCELERATION] {
                    start.set_where(accepted, row, to.row(row));
                    to.set_where(accepted, row, from.row(row));
                }
                if k < w.topology.unknowns {
                    (most_z, most_v) = (most_z.max(from.row(Z).abs()), most_v.max(from.row(VELOCITY).abs()));
                }
            }
            let mut lane = w.lane.write(simd);
            lane.set(SCALE_Z as u32, most_z);
            lane.set(SCALE_V as u32, most_v);
        }
        for (mut saved, mut now) in w.saved.write(simd).iter_mut().zip(w.tangents.write(simd).iter_mut()) {
            for row in [AT, MU, SLOPE] {
                let (old, new) = (saved.row(row), now.row(row));
                saved.set(row, accepted.pick(new, old));
                now.set(row, given_up.pick(old, new));
            }
        }
        let mut joints = w.joints.write(simd);
        for (mut one_sided, at) in w.one_sided.write(simd).iter_mut().zip(&w.topology.one_sided) {
            let mut joint = joints.group(at.joint);
            let (old, new) = (one_sided.row(SAVED), joint.row(ENGAGED));
            one_sided.set(SAVED, accepted.pick(new, old));
            joint.set(ENGAGED, given_up.pick(old, new));
        }
    }
}
