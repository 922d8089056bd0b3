//! Energies and envelopes of the lanes.
//!
//! Nothing that a step does depends on the envelopes and on what each joint dissipates, so they are made up for several
//! lanes at once, just before the stages of a step that waits are overwritten. Operations and their order are those of [`crate::dynamics::power`] and
//! [`crate::dynamics::observe`].

use pulp::{Simd, WithSimd};

use crate::integrate::tableau::STAGES;
use crate::lanes::rows::{Groups, Mask, V, WIDTH};
use crate::lanes::topology::NONE;
use crate::lanes::work::{ACCELERATION, DAMPING, LARGEST_NORMAL, NORMAL, NORMALS, PENDING, SLIP, VELOCITY, Work, Z};
use concio_law::account::Envelopes;

/// Per-joint and per-unknown sums and peaks of all lanes.
#[derive(Debug)]
pub struct Account {
    /// Peaks of displacement, velocity and acceleration.
    pub unknowns: Groups<3>,
    /// Rows [`DISPLACEMENT`] to [`POWER`].
    pub joints: Groups<9>,
    /// Step of the waiting account [s].
    pub step: [f64; WIDTH],
}

/// Rows of [`Account::joints`]: the envelopes, and the rate of the dissipation at the last accepted state [W].
const DISPLACEMENT: usize = 0;
const SPEED: usize = 1;
const RATE: usize = 2;
const FORCE: usize = 3;
const OPENING: usize = 4;
const CLOSING: usize = 5;
const SLIPPED: usize = 6;
const DISSIPATION: usize = 7;
pub const POWER: usize = 8;

/// What the energy of a step comes to, lane by lane; the powers by stage.
#[derive(Debug, Clone, Default)]
pub struct Powers {
    /// −Σ m v, to be multiplied with the base's acceleration.
    pub momentum: [[f64; WIDTH]; STAGES],
    pub damping: [[f64; WIDTH]; STAGES],
    pub friction: [[f64; WIDTH]; STAGES],
    pub top: [[f64; WIDTH]; STAGES],
    pub kinetic: [f64; WIDTH],
    pub elastic: [f64; WIDTH],
}

/// Peaks of a step, lane by lane.
#[derive(Debug, Clone, Default)]
pub struct Peaks {
    pub displacement: [f64; WIDTH],
    pub slip_velocity: [f64; WIDTH],
    pub closing: [f64; WIDTH],
    pub friction: [f64; WIDTH],
    pub pull: [f64; WIDTH],
    pub base_shear: [f64; WIDTH],
}

impl Account {
    pub fn new(unknowns: usize, joints: usize) -> Self {
        Account { unknowns: Groups::new(unknowns), joints: Groups::new(joints), step: [0.0; WIDTH] }
    }

    /// The envelopes in the order of the rows.
    fn envelopes(from: &mut Envelopes) -> ([&mut Vec<f64>; 3], [&mut Vec<f64>; 8]) {
        let joints = [
            &mut from.joint_displacement,
            &mut from.joint_velocity,
            &mut from.joint_acceleration,
            &mut from.joint_force,
            &mut from.joint_opening,
            &mut from.joint_closing,
            &mut from.joint_slip,
            &mut from.joint_dissipation,
        ];
        ([&mut from.block_displacement, &mut from.block_velocity, &mut from.block_acceleration], joints)
    }

    /// Takes the envelopes of a run into its lane.
    pub fn load(&mut self, lane: usize, place: &[u32], envelopes: &mut Envelopes) {
        let (unknowns, joints) = Self::envelopes(envelopes);
        for (row, values) in unknowns.into_iter().enumerate() {
            for (value, &p) in values.iter().zip(place) {
                self.unknowns.set(p as usize, row, lane, *value);
            }
        }
        for (row, values) in joints.into_iter().enumerate() {
            for (e, value) in values.iter().enumerate() {
                self.joints.set(e, row, lane, *value);
            }
        }
    }

    /// Gives them back.
    pub fn unload(&self, lane: usize, place: &[u32], envelopes: &mut Envelopes) {
        let (unknowns, joints) = Self::envelopes(envelopes);
        for (row, values) in unknowns.into_iter().enumerate() {
            for (value, &p) in values.iter_mut().zip(place) {
                *value = self.unknowns.at(p as usize, row, lane);
            }
        }
        for (row, values) in joints.into_iter().enumerate() {
            for (e, value) in values.iter_mut().enumerate() {
                *value = self.joints.at(e, row, lane);
            }
        }
    }
}

/// Powers at the stages of the lanes that end a step, and the energy stored at its end.
pub struct Balance<'a> {
    pub work: &'a Work,
    pub powers: &'a mut Powers,
}

impl WithSimd for Balance<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        for stage in 1..self.work.tableau.stages {
            self.at_stage(simd, stage);
        }
        self.stored(simd);
    }
}

impl Balance<'_> {
    #[inline(always)]
    fn at_stage<S: Simd>(&mut self, simd: S, i: usize) {
        let (w, t) = (self.work, &self.work.topology);
        let zero = V::splat(simd, 0.0);
        let (mass, searches, rubs) = (w.mass.read(simd), w.searches.read(simd), w.rubs.read(simd));
        let (joints, stiffness) = (w.joints.read(simd), w.stiffness.read(simd));
        let (stage, mu) = (w.stages[i].read(simd), w.stage_mu[i].read(simd));
        let mut momentum = zero;
        for &p in &t.place[..t.unknowns as usize] {
            momentum = momentum - mass.at(p) * stage.of(p, VELOCITY);
        }
        let (mut damped, mut rubbed, mut pull) = (zero, zero, zero);
        for ((joint, stiffness), at) in joints.iter().zip(stiffness.iter()).zip(&t.joints) {
            let [a, b] = at.sides;
            let difference = stage.of(a, VELOCITY) - stage.of(b, VELOCITY);
            damped = damped + joint.row(DAMPING) * difference * difference;
            if at.to_top {
                let force = spring(simd, at.one_sided, stiffness, stage.of(a, Z) - stage.of(b, Z));
                pull = pull + (joint.row(DAMPING) * difference + force);
            }
        }
        for ((search, mu), at) in searches.iter().zip(mu.iter()).zip(&t.rubs) {
            let [a, b] = at.sides;
            let difference = stage.of(a, VELOCITY) - stage.of(b, VELOCITY);
            rubbed = rubbed + 0.5 * search.row(NORMALS) * mu * difference;
        }
        for &r in &t.rubs_of_top {
            pull = pull + rubs.of(r, NORMAL) * mu.at(r);
        }
        self.powers.momentum[i] = momentum.numbers();
        self.powers.damping[i] = damped.numbers();
        self.powers.friction[i] = rubbed.numbers();
        self.powers.top[i] = (pull.negated() * stage.of(t.unknowns + 1, VELOCITY)).numbers();
    }

    #[inline(always)]
    fn stored<S: Simd>(&mut self, simd: S) {
        let (w, t) = (self.work, &self.work.topology);
        let zero = V::splat(simd, 0.0);
        let (mass, stiffness) = (w.mass.read(simd), w.stiffness.read(simd));
        let end = w.stages[w.tableau.stages - 1].read(simd);
        let (mut kinetic, mut elastic) = (zero, zero);
        for &p in &t.place[..t.unknowns as usize] {
            let v = end.of(p, VELOCITY);
            kinetic = kinetic + 0.5 * mass.at(p) * v * v;
        }
        for (stiffness, at) in stiffness.iter().zip(&t.joints) {
            let d = end.of(at.sides[0], Z) - end.of(at.sides[1], Z);
            elastic = elastic + 0.5 * spring(simd, at.one_sided, stiffness, d) * d;
        }
        self.powers.kinetic = kinetic.numbers();
        self.powers.elastic = elastic.numbers();
    }
}

/// The account of the lanes with [`PENDING`].
pub struct Settle<'a> {
    pub work: &'a Work,
    pub account: &'a mut Account,
    pub peaks: &'a mut Peaks,
}

impl WithSimd for Settle<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        self.dissipate(simd);
        self.observe_unknowns(simd);
        self.observe_joints(simd);
    }
}

impl Settle<'_> {
    /// Each joint's dissipation over the step.
    #[inline(always)]
    fn dissipate<S: Simd>(&mut self, simd: S) {
        let (w, t) = (self.work, &self.work.topology);
        let last = w.tableau.stages - 1;
        let waits = Mask::of(w.lane.read(simd).at(PENDING as u32));
        let step = V::of(simd, self.account.step);
        let (searches, joints) = (w.searches.read(simd), w.joints.read(simd));
        let mut account = self.account.joints.write(simd);
        for i in 1..=last {
            let (stage, mu) = (w.stages[i].read(simd), w.stage_mu[i].read(simd));
            let weight = step * w.tableau.b[i];
            for ((mut sums, joint), at) in account.iter_mut().zip(joints.iter()).zip(&t.joints) {
                if i == 1 {
                    let lost = sums.row(DISSIPATION) + (step * w.tableau.b[0]) * sums.row(POWER);
                    sums.set_where(waits, DISSIPATION, lost);
                }
                let difference = stage.of(at.sides[0], VELOCITY) - stage.of(at.sides[1], VELOCITY);
                let mut lost = joint.row(DAMPING) * difference * difference;
                if at.rub != NONE {
                    lost = lost + 0.5 * searches.of(at.rub, NORMALS) * mu.at(at.rub) * difference;
                }
                sums.set_where(waits, DISSIPATION, sums.row(DISSIPATION) + weight * lost);
                if i == last {
                    sums.set_where(waits, POWER, lost);
                }
            }
        }
    }

    /// Peaks of the unknowns.
    #[inline(always)]
    fn observe_unknowns<S: Simd>(&mut self, simd: S) {
        let (w, t) = (self.work, &self.work.topology);
        let waits = Mask::of(w.lane.read(simd).at(PENDING as u32));
        let half = 0.5 * V::of(simd, self.account.step);
        let (state, start) = (w.state.read(simd), w.start.read(simd));
        let mut peaks = self.account.unknowns.write(simd);
        let mut most = V::splat(simd, 0.0);
        for (k, &p) in (0..t.unknowns).zip(&t.place) {
            let ([z, v, a], [z_0, v_0, _]) = (state.at(p), start.at(p));
            let farthest = z.abs().max(extreme(z_0, [v_0, v], half).abs());
            let mut peaks = peaks.group(p);
            peaks.raise_where(waits, Z, farthest);
            peaks.raise_where(waits, VELOCITY, v.abs());
            peaks.raise_where(waits, ACCELERATION, a.abs());
            if k < t.blocks {
                most = most.max(farthest);
            }
        }
        self.peaks.displacement = most.numbers();
    }

    /// Peaks of the joints and the forces on beam and base.
    #[inline(always)]
    fn observe_joints<S: Simd>(&mut self, simd: S) {
        let (w, t) = (self.work, &self.work.topology);
        let zero = V::splat(simd, 0.0);
        let waits = Mask::of(w.lane.read(simd).at(PENDING as u32));
        let step = V::of(simd, self.account.step);
        let half = 0.5 * step;
        let (state, start) = (w.state.read(simd), w.start.read(simd));
        let (joints, stiffness) = (w.joints.read(simd), w.stiffness.read(simd));
        let (mu, rubs) = (w.stage_mu[w.tableau.stages - 1].read(simd), w.rubs.read(simd));
        let mut account = self.account.joints.write(simd);
        let (mut pull, mut fastest, mut deepest, mut rubbing) = (zero, zero, zero, zero);
        let mut shear = zero;
        let of_joint = account.iter_mut().zip(joints.iter()).zip(stiffness.iter());
        for (((mut peaks, joint), stiffness), at) in of_joint.zip(&t.joints) {
            let [i, k] = at.sides;
            let ([za, va, aa], [zb, vb, ab]) = (state.at(i), state.at(k));
            let ([z0a, v0a, _], [z0b, v0b, _]) = (start.at(i), start.at(k));
            let (d, dv) = (za - zb, va - vb);
            let turn = extreme(z0a - z0b, [v0a - v0b, dv], half);
            let (least, most) = (d.min(turn), d.max(turn));
            let force = |d| spring(simd, at.one_sided, stiffness, d);
            peaks.raise_where(waits, DISPLACEMENT, most.max(least.negated()));
            peaks.raise_where(waits, SPEED, dv.abs());
            peaks.raise_where(waits, RATE, (aa - ab).abs());
            peaks.raise_where(waits, FORCE, force(most).max(force(least).negated()));
            if at.upright {
                peaks.raise_where(waits, OPENING, least.negated());
                peaks.raise_where(waits, CLOSING, most);
                deepest = deepest.max(most);
            } else {
                fastest = fastest.max(dv.abs());
            }
            if at.to_beam {
                pull = pull + (force(d) + joint.row(DAMPING) * dv);
            } else if at.to_base {
                shear = shear + (force(d) + joint.row(DAMPING) * dv);
            }
            if at.rub != NONE {
                rubbing = rubbing.max(rubs.of(at.rub, LARGEST_NORMAL) * mu.at(at.rub).abs());
                let slips = dv.abs().max((v0a - v0b).abs()).above(rubs.of(at.rub, SLIP)).and(waits);
                peaks.set_where(slips, SLIPPED, peaks.row(SLIPPED) + (d - (z0a - z0b)).abs());
            }
        }
        for &r in &t.rubs_of_beam {
            pull = pull + rubs.of(r, NORMAL) * mu.at(r);
        }
        for &r in &t.rubs_of_base {
            shear = shear + rubs.of(r, NORMAL) * mu.at(r);
        }
        self.peaks.slip_velocity = fastest.numbers();
        self.peaks.closing = deepest.numbers();
        self.peaks.friction = rubbing.numbers();
        self.peaks.pull = pull.numbers();
        self.peaks.base_shear = shear.numbers();
    }
}

/// [`crate::dynamics::extreme`] in every lane; `half` the step.
#[inline(always)]
fn extreme<S: Simd>(z: V<S>, v: [V<S>; 2], half: V<S>) -> V<S> {
    let zero = V::splat(half.simd(), 0.0);
    let turns = (v[0] * v[1]).below(zero);
    let at = turns.pick(v[0] / (v[0] - v[1]), zero);
    z + half * at * v[0]
}

/// Elastic force of a joint at relative displacement `d`.
#[inline(always)]
fn spring<S: Simd>(simd: S, one_sided: u32, stiffness: V<S>, d: V<S>) -> V<S> {
    let (force, zero) = (stiffness * d, V::splat(simd, 0.0));
    if one_sided == NONE { force } else { d.above(zero).pick(force, zero) }
}
