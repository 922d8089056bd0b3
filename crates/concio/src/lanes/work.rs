//! The numbers of all lanes of a group, and one iteration of the stage (T1) in every lane at once.
//!
//! What is done to a lane are the operations of [`crate::integrate::stage`] in the same order, but for three things
//! that change no bit: what a lane does not need at the moment is computed all the same, the prediction and the elastic
//! part are made anew in every iteration, and the factorisation gathers what it takes from an entry instead of
//! scattering it.

use pulp::{Simd, WithSimd};

use crate::integrate::tableau::{STAGES, Tableau};
use crate::lanes::rows::{Law, Mask, Read, Rows, V, WIDTH, Write, friction};
use crate::lanes::topology::{NONE, Topology};

/// As in the stage of a single run.
pub const MOST_ITERATIONS: u32 = 12;
const FAR: f64 = 0.02;
const STILL: f64 = 1e-3;

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

/// Friction where it is linearised.
#[derive(Debug)]
pub struct TangentRows {
    pub velocity: Rows,
    pub mu: Rows,
    pub slope: Rows,
}

impl TangentRows {
    fn new(rubs: usize) -> Self {
        TangentRows { velocity: Rows::new(rubs), mu: Rows::new(rubs), slope: Rows::new(rubs) }
    }
}

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
    // What the model says.
    pub mass: Rows,
    pub damping: Rows,
    pub stiffness: Rows,
    pub normal: Rows,
    /// N in the equation of a plus N in that of b.
    pub normals: Rows,
    pub static_: Rows,
    pub excess: Rows,
    pub dynamic: Rows,
    pub slip: Rows,
    pub steep: Rows,
    pub alpha: Rows,
    /// δ_v/β, and the slope at rest.
    pub width: Rows,
    pub slope_at_rest: Rows,
    // The state after the last accepted step.
    pub z: Rows,
    pub v: Rows,
    pub a: Rows,
    pub saved: TangentRows,
    pub saved_engaged: Rows,
    /// Stiffness of each joint as it acts: 0 where it is open.
    pub engaged: Rows,
    pub tangents: TangentRows,
    // Stages of the step, from 1.
    pub stage_z: Vec<Rows>,
    pub stage_v: Vec<Rows>,
    pub stage_a: Vec<Rows>,
    pub stage_mu: Vec<Rows>,
    // The iteration.
    pub before_z: Rows,
    pub before_v: Rows,
    pub elastic_diagonal: Rows,
    pivot: Rows,
    lower: Rows,
    scaled: Rows,
    change: Rows,
    rhs: Rows,
    error_z: Rows,
    before: Rows,
    pub velocity: Rows,
    mu: Rows,
    slope: Rows,
    target: Rows,
    missed: Rows,
    missed_rubs: Vec<u32>,
    pub misses: Vec<Miss>,
}

impl Work {
    /// Zeros for `topology`.
    pub fn new(topology: Topology, tableau: Tableau) -> Self {
        let (n, e, r) = (topology.unknowns as usize, topology.joints.len(), topology.rubs.len());
        let (fill, stages) = (topology.fill as usize, tableau.stages);
        let (of_unknowns, of_rubs) = (|| Rows::new(n + 2), || Rows::new(r));
        let per_stage = |len: usize| (0..stages).map(|_| Rows::new(len)).collect::<Vec<_>>();
        Work {
            tableau,
            lane: Rows::new(LANE_ROWS),
            mass: of_unknowns(),
            damping: Rows::new(e),
            stiffness: Rows::new(e),
            normal: of_rubs(),
            normals: of_rubs(),
            static_: of_rubs(),
            excess: of_rubs(),
            dynamic: of_rubs(),
            slip: of_rubs(),
            steep: of_rubs(),
            alpha: of_rubs(),
            width: of_rubs(),
            slope_at_rest: of_rubs(),
            z: of_unknowns(),
            v: of_unknowns(),
            a: of_unknowns(),
            saved: TangentRows::new(r),
            saved_engaged: Rows::new(topology.one_sided.len()),
            engaged: Rows::new(e),
            tangents: TangentRows::new(r),
            stage_z: per_stage(n + 2),
            stage_v: per_stage(n + 2),
            stage_a: per_stage(n + 2),
            stage_mu: per_stage(r),
            before_z: of_unknowns(),
            before_v: of_unknowns(),
            elastic_diagonal: of_unknowns(),
            pivot: of_unknowns(),
            lower: Rows::new(fill),
            scaled: Rows::new(fill),
            change: of_unknowns(),
            rhs: of_unknowns(),
            error_z: of_unknowns(),
            before: of_rubs(),
            velocity: of_rubs(),
            mu: of_rubs(),
            slope: of_rubs(),
            target: of_rubs(),
            missed: of_rubs(),
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
        work.factorise(simd);
        solve(simd, &work.topology, &work.scaled, &work.pivot, &mut work.change);
        work.flip(simd);
        work.mismatch(simd);
        solve(simd, &work.topology, &work.scaled, &work.pivot, &mut work.rhs);
        work.measure(simd);
    }
}

impl Work {
    /// z_p and V_p.
    #[inline(always)]
    fn predict<S: Simd>(&mut self, simd: S) {
        let (z, v, a) = (self.z.read(simd), self.v.read(simd), self.a.read(simd));
        let (mut to_z, mut to_v) = (self.before_z.write(simd), self.before_v.write(simd));
        let lane = self.lane.read(simd);
        let weight = lane.at(WEIGHTS as u32);
        for k in 0..self.topology.unknowns {
            to_z.set(k, z.at(k) + weight * v.at(k));
            to_v.set(k, v.at(k) + weight * a.at(k));
        }
        for j in 1..self.tableau.stages - 1 {
            let (v, a) = (self.stage_v[j].read(simd), self.stage_a[j].read(simd));
            let weight = lane.at((WEIGHTS + j) as u32);
            for k in 0..self.topology.unknowns {
                to_z.add(k, weight * v.at(k));
                to_v.add(k, weight * a.at(k));
            }
        }
    }

    /// M + τ Σ B (c + τ k) Bᵀ, and −τ (M a_0 + Σ B (c w_p + k (δ_p + τ w_p))) into `change`.
    #[inline(always)]
    fn assemble_elastic<S: Simd>(&mut self, simd: S) {
        let (tau, ground) = (self.lane.read(simd).at(TAU as u32), self.lane.read(simd).at(GROUND as u32));
        let (mass, zero) = (self.mass.read(simd), V::splat(simd, 0.0));
        let (mut diagonal, mut lower) = (self.elastic_diagonal.write(simd), self.lower.write(simd));
        let mut load = self.change.write(simd);
        let against = tau.negated();
        for k in 0..self.topology.unknowns {
            diagonal.set(k, mass.at(k));
            load.set(k, against * mass.at(k) * ground);
        }
        for slot in 0..self.topology.fill {
            lower.set(slot, zero);
        }
        let (damping, engaged) = (self.damping.read(simd), self.engaged.read(simd));
        let (z, v) = (self.before_z.read(simd), self.before_v.read(simd));
        for (e, joint) in (0u32..).zip(&self.topology.joints) {
            let [a, b] = joint.sides;
            let (damping, engaged) = (damping.at(e), engaged.at(e));
            let s = tau * (damping + tau * engaged);
            diagonal.add(a, s);
            if joint.slot != NONE {
                diagonal.add(b, s);
                lower.subtract(joint.slot, s);
            }
            let w = v.at(a) - v.at(b);
            let f = tau * (damping * w + engaged * (z.at(a) - z.at(b) + tau * w));
            load.subtract(a, f);
            load.add(b, f);
        }
    }

    /// The diagonal alone, for lanes in which a joint has just opened or closed.
    #[inline(always)]
    fn assemble_diagonal<S: Simd>(&mut self, simd: S) {
        let tau = self.lane.read(simd).at(TAU as u32);
        let (mass, damping, engaged) = (self.mass.read(simd), self.damping.read(simd), self.engaged.read(simd));
        let mut diagonal = self.elastic_diagonal.write(simd);
        for k in 0..self.topology.unknowns {
            diagonal.set(k, mass.at(k));
        }
        for (e, joint) in (0u32..).zip(&self.topology.joints) {
            let s = tau * (damping.at(e) + tau * engaged.at(e));
            diagonal.add(joint.sides[0], s);
            if joint.slot != NONE {
                diagonal.add(joint.sides[1], s);
            }
        }
    }

    /// What friction's tangents add to matrix and right side.
    #[inline(always)]
    fn assemble_friction<S: Simd>(&mut self, simd: S) {
        let tau = self.lane.read(simd).at(TAU as u32);
        let (elastic, mut diagonal) = (self.elastic_diagonal.read(simd), self.pivot.write(simd));
        for k in 0..self.topology.unknowns {
            diagonal.set(k, elastic.at(k));
        }
        let (mut lower, mut change, mut before) =
            (self.lower.write(simd), self.change.write(simd), self.before.write(simd));
        let (v, normal, t) = (self.before_v.read(simd), self.normal.read(simd), &self.tangents);
        let (velocity, mu, slope) = (t.velocity.read(simd), t.mu.read(simd), t.slope.read(simd));
        for (r, rub) in (0u32..).zip(&self.topology.rubs) {
            let [a, b] = rub.sides;
            let (normal, slope) = (normal.at(r), slope.at(r));
            let s = tau * slope * normal;
            diagonal.add(a, s);
            if rub.slot != NONE {
                diagonal.add(b, s);
                lower.subtract(rub.slot, s);
            }
            let w = v.at(a) - v.at(b);
            before.set(r, w);
            let f = tau * (mu.at(r) + slope * (w - velocity.at(r)));
            change.subtract(a, normal * f);
            change.add(b, normal * f);
        }
        let (n, zero) = (self.topology.unknowns, V::splat(simd, 0.0));
        change.set(n, zero);
        change.set(n + 1, zero);
    }

    /// L D Lᵀ of `pivot` and `lower`; `pivot` becomes D⁻¹, `scaled` L.
    #[inline(always)]
    fn factorise<S: Simd>(&mut self, simd: S) {
        let (mut pivot, mut lower, mut scaled) =
            (self.pivot.write(simd), self.lower.write(simd), self.scaled.write(simd));
        let zero = V::splat(simd, 0.0);
        let mut bad = zero.above(zero);
        let t = &self.topology;
        let (mut rows, mut counts, mut products) = (&t.row_entries[..], &t.product_counts[..], &t.products[..]);
        let mut at = 0u32;
        for (k, (&in_row, &in_column)) in (0u32..).zip(t.row_counts.iter().zip(&t.column_counts)) {
            let (of_row, rest) = rows.split_at(in_row as usize);
            rows = rest;
            let mut d = pivot.at(k);
            for &[_, p] in of_row {
                d = d - scaled.at(p) * lower.at(p);
            }
            bad = bad.or(d.above(zero).not());
            let inverse = 1.0 / d;
            pivot.set(k, inverse);
            let (of_column, rest) = counts.split_at(in_column as usize);
            counts = rest;
            for &count in of_column {
                let (of_entry, rest) = products.split_at(count as usize);
                products = rest;
                let mut value = lower.at(at);
                for &[p, q] in of_entry {
                    value = value - scaled.at(p) * lower.at(q);
                }
                lower.set(at, value);
                scaled.set(at, value * inverse);
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
        let (z, v, change) = (self.before_z.read(simd), self.before_v.read(simd), self.change.read(simd));
        let (mass, stiffness, mut engaged) =
            (self.mass.read(simd), self.stiffness.read(simd), self.engaged.write(simd));
        let mut flipped = zero.above(zero);
        for joint in &self.topology.one_sided {
            let [a, b] = joint.sides;
            let gap = z.at(a) - z.at(b) + tau * (v.at(a) - v.at(b));
            let d = gap + tau * (change.at(a) - change.at(b));
            let stiffness = stiffness.at(joint.joint);
            let felt = (tau * stiffness * d.abs()).above(STILL * accuracy * mass.at(a));
            let (closes, closed) = (d.above(zero), engaged.at(joint.joint).above(zero));
            let flips = felt.and(closes.differs(closed));
            flipped = flipped.or(flips);
            engaged.set_where(flips, joint.joint, closes.pick(stiffness, zero));
        }
        self.lane.write(simd).set(FLIPPED as u32, flipped.as_row());
    }

    /// The laws at the new velocities, and τ Σ B N (μ − tangent) into `rhs`.
    #[inline(always)]
    fn mismatch<S: Simd>(&mut self, simd: S) {
        let (n, zero) = (self.topology.unknowns, V::splat(simd, 0.0));
        let tau = self.lane.read(simd).at(TAU as u32);
        let mut rhs = self.rhs.write(simd);
        for k in 0..n {
            rhs.set(k, zero);
        }
        let (before, change, normal) = (self.before.read(simd), self.change.read(simd), self.normal.read(simd));
        let (excess, dynamic, slip) = (self.excess.read(simd), self.dynamic.read(simd), self.slip.read(simd));
        let (steep, alpha) = (self.steep.read(simd), self.alpha.read(simd));
        let (at, drawn, inclination) =
            (self.tangents.velocity.read(simd), self.tangents.mu.read(simd), self.tangents.slope.read(simd));
        let (mut velocity, mut mus, mut slopes) =
            (self.velocity.write(simd), self.mu.write(simd), self.slope.write(simd));
        for (r, rub) in (0u32..).zip(&self.topology.rubs) {
            let [a, b] = rub.sides;
            let w = before.at(r) + change.at(a) - change.at(b);
            let law = Law {
                excess: excess.at(r),
                dynamic: dynamic.at(r),
                slip: slip.at(r),
                steep: steep.at(r),
                alpha: alpha.at(r),
            };
            let (mu, slope) = friction(law, w);
            velocity.set(r, w);
            mus.set(r, mu);
            slopes.set(r, slope);
            let missed = tau * (mu - (drawn.at(r) + inclination.at(r) * (w - at.at(r))));
            let f = normal.at(r) * missed;
            rhs.add(a, f);
            rhs.subtract(b, f);
        }
        rhs.set(n, zero);
        rhs.set(n + 1, zero);
    }

    /// Size of the correction.
    #[inline(always)]
    fn measure<S: Simd>(&mut self, simd: S) {
        let (mut most, mut sum) = (V::splat(simd, 0.0), V::splat(simd, 0.0));
        let rhs = self.rhs.read(simd);
        for k in 0..self.topology.unknowns {
            let d = rhs.at(k).abs();
            (most, sum) = (most.max(d), sum + d);
        }
        let mut lane = self.lane.write(simd);
        lane.set(CORRECTION as u32, most);
        lane.set(SUM as u32, sum);
    }
}

/// Solves with the factors in place.
#[inline(always)]
fn solve<S: Simd>(simd: S, t: &Topology, scaled: &Rows, pivot: &Rows, b: &mut Rows) {
    let (scaled, pivot, mut b) = (scaled.read(simd), pivot.read(simd), b.write(simd));
    let mut entries = &t.row_entries[..];
    for (k, &count) in (0u32..).zip(&t.row_counts) {
        let (row, rest) = entries.split_at(count as usize);
        entries = rest;
        let mut x = b.at(k);
        for &[c, p] in row {
            x = x - scaled.at(p) * b.at(c);
        }
        b.set(k, x);
    }
    let mut at = t.fill;
    for (k, &count) in (0..t.unknowns).zip(&t.column_counts).rev() {
        let mut x = b.at(k) * pivot.at(k);
        for _ in 0..count {
            at -= 1;
            x = x - scaled.at(at) * b.at(t.entry_row[at as usize]);
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
        let (rhs, mut change) = (self.rhs.read(simd), self.change.write(simd));
        for k in 0..self.topology.unknowns {
            change.subtract(k, rhs.at(k));
        }
    }

    /// Keeps velocity, displacement and acceleration of the lanes that end `stage`.
    #[inline(always)]
    fn end_stage<S: Simd>(&mut self, simd: S, stage: usize) {
        let lane = self.lane.read(simd);
        let tau = lane.at(TAU as u32);
        let ends = ends(simd, &lane, stage);
        let (z, v, change) = (self.before_z.read(simd), self.before_v.read(simd), self.change.read(simd));
        let mut to_z = self.stage_z[stage].write(simd);
        let (mut to_v, mut to_a) = (self.stage_v[stage].write(simd), self.stage_a[stage].write(simd));
        for k in 0..self.topology.unknowns + 2 {
            let before = v.at(k);
            let after = before + change.at(k);
            to_v.set_where(ends, k, after);
            to_a.set_where(ends, k, (after - before) / tau);
            to_z.set_where(ends, k, z.at(k) + tau * after);
        }
    }

    /// Tangents at the solution where the stage has ended; elsewhere at the new velocity, or noted as a miss.
    #[inline(always)]
    fn move_tangents<S: Simd>(&mut self, simd: S) {
        self.missed_rubs.clear();
        let lane = self.lane.read(simd);
        let converged = Mask::of(lane.at(CONVERGED as u32));
        let going = Mask::of(lane.at(GOING as u32));
        let (before, change, velocity) = (self.before.read(simd), self.change.read(simd), self.velocity.read(simd));
        let (mu, slope, static_) = (self.mu.read(simd), self.slope.read(simd), self.static_.read(simd));
        let t = &mut self.tangents;
        let (mut t_velocity, mut t_mu, mut t_slope) =
            (t.velocity.write(simd), t.mu.write(simd), t.slope.write(simd));
        let (mut target, mut missed) = (self.target.write(simd), self.missed.write(simd));
        for (r, rub) in (0u32..).zip(&self.topology.rubs) {
            let [a, b] = rub.sides;
            let (w, mu, slope) = (velocity.at(r), mu.at(r), slope.at(r));
            let aim = t_mu.at(r) + t_slope.at(r) * (w - t_velocity.at(r));
            let misses = (mu - aim).abs().above(FAR * static_.at(r)).and(going);
            if misses.any() {
                self.missed_rubs.push(r);
                target.set(r, aim);
                missed.set(r, misses.as_row());
            }
            let solution = before.at(r) + change.at(a) - change.at(b);
            t_velocity.set(r, converged.pick(solution, w));
            t_mu.set(r, converged.pick(mu + slope * (solution - w), mu));
            t_slope.set(r, slope);
        }
        for stage in 1..self.tableau.stages {
            let ends = ends(simd, &lane, stage);
            if ends.any() {
                let mut kept = self.stage_mu[stage].write(simd);
                for r in 0..self.topology.rubs.len() as u32 {
                    kept.set_where(ends, r, t_mu.at(r));
                }
            }
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
        {
            let (mut error_v, mut error_z) = (self.rhs.write(simd), self.error_z.write(simd));
            for i in 0..=last {
                let weight = step * self.tableau.error[i];
                let (v, a) = if i == 0 {
                    (self.v.read(simd), self.a.read(simd))
                } else {
                    (self.stage_v[i].read(simd), self.stage_a[i].read(simd))
                };
                for k in 0..n {
                    let old = |rows: &Write<S>| if i == 0 { V::splat(simd, 0.0) } else { rows.at(k) };
                    let (of_v, of_z) = (old(&error_v), old(&error_z));
                    error_v.set(k, of_v + weight * a.at(k));
                    error_z.set(k, of_z + weight * v.at(k));
                }
            }
            let mass = self.mass.read(simd);
            for k in 0..n {
                error_v.set(k, error_v.at(k) * mass.at(k));
            }
            let engaged = self.engaged.read(simd);
            for (e, joint) in (0u32..).zip(&self.topology.joints) {
                let [a, b] = joint.sides;
                let mut stretch = error_z.at(a);
                if b < n {
                    stretch = stretch - error_z.at(b);
                }
                let f = tau * engaged.at(e) * stretch;
                error_v.subtract(a, f);
                if b < n {
                    error_v.add(b, f);
                }
            }
        }
        solve(simd, &self.topology, &self.scaled, &self.pivot, &mut self.rhs);
        let (error_v, error_z) = (self.rhs.read(simd), self.error_z.read(simd));
        let zero = V::splat(simd, 0.0);
        let (mut most_v, mut most_z, mut sum) = (zero, zero, zero);
        for k in 0..n {
            let ev = error_v.at(k);
            let ez = error_z.at(k) + tau * ev;
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
            let (mut z, mut v, mut a) = (w.z.write(simd), w.v.write(simd), w.a.write(simd));
            let (new_z, new_v, new_a) =
                (w.stage_z[last].read(simd), w.stage_v[last].read(simd), w.stage_a[last].read(simd));
            let (mut most_z, mut most_v) = (V::splat(simd, 0.0), V::splat(simd, 0.0));
            for k in 0..w.topology.unknowns {
                z.set_where(accepted, k, new_z.at(k));
                v.set_where(accepted, k, new_v.at(k));
                a.set_where(accepted, k, new_a.at(k));
                (most_z, most_v) = (most_z.max(new_z.at(k).abs()), most_v.max(new_v.at(k).abs()));
            }
            for k in w.topology.unknowns..w.topology.unknowns + 2 {
                z.set_where(accepted, k, new_z.at(k));
                v.set_where(accepted, k, new_v.at(k));
            }
            let mut lane = w.lane.write(simd);
            lane.set(SCALE_Z as u32, most_z);
            lane.set(SCALE_V as u32, most_v);
        }
        exchange(simd, accepted, given_up, &mut w.saved.velocity, &mut w.tangents.velocity);
        exchange(simd, accepted, given_up, &mut w.saved.mu, &mut w.tangents.mu);
        exchange(simd, accepted, given_up, &mut w.saved.slope, &mut w.tangents.slope);
        let (mut saved, mut engaged) = (w.saved_engaged.write(simd), w.engaged.write(simd));
        for (i, joint) in (0u32..).zip(&w.topology.one_sided) {
            let (old, new) = (saved.at(i), engaged.at(joint.joint));
            saved.set(i, accepted.pick(new, old));
            engaged.set(joint.joint, given_up.pick(old, new));
        }
    }
}

/// Keeps what is new in the lanes that go on, and takes back what was kept in those that go back.
#[inline(always)]
fn exchange<S: Simd>(simd: S, on: Mask<S>, back: Mask<S>, saved: &mut Rows, now: &mut Rows) {
    let rows = saved.len() as u32;
    let (mut saved, mut now) = (saved.write(simd), now.write(simd));
    for r in 0..rows {
        let (old, new) = (saved.at(r), now.at(r));
        saved.set(r, on.pick(new, old));
        now.set(r, back.pick(old, new));
    }
}
