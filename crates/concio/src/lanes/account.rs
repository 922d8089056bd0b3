//! Energies and envelopes of accepted steps, in the lanes that wait for it.
//!
//! Nothing that a step does depends on them, so they are made up for several lanes at once, just before the stages of
//! a step that waits are overwritten. Operations and their order are those of [`crate::dynamics::power`] and
//! [`crate::dynamics::observe`].

use pulp::{Simd, WithSimd};

use crate::integrate::tableau::STAGES;
use crate::lanes::rows::{Groups, Mask, V, WIDTH};
use crate::lanes::topology::NONE;
use crate::lanes::work::{ACCELERATION, DAMPING, NORMAL, NORMALS, PENDING, SLIP, VELOCITY, Work, Z};
use crate::record::Envelopes;

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

/// What the account of a step comes to, lane by lane; the powers by stage.
#[derive(Debug, Clone, Default)]
pub struct Totals {
    /// −Σ m v, to be multiplied with the base's acceleration.
    pub momentum: [[f64; WIDTH]; STAGES],
    pub damping: [[f64; WIDTH]; STAGES],
    pub friction: [[f64; WIDTH]; STAGES],
    pub top: [[f64; WIDTH]; STAGES],
    pub kinetic: [f64; WIDTH],
    pub elastic: [f64; WIDTH],
    pub displacement: [f64; WIDTH],
    pub slip_velocity: [f64; WIDTH],
    pub closing: [f64; WIDTH],
    pub pull: [f64; WIDTH],
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

/// The account of the lanes with [`PENDING`].
pub struct Settle<'a> {
    pub work: &'a Work,
    pub account: &'a mut Account,
    pub totals: &'a mut Totals,
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
    /// Powers at the stages, and each joint's dissipation over the step.
    #[inline(always)]
    fn dissipate<S: Simd>(&mut self, simd: S) {
        let (w, t) = (self.work, &self.work.topology);
        let zero = V::splat(simd, 0.0);
        let (last, n) = (w.tableau.stages - 1, t.unknowns);
        let waits = Mask::of(w.lane.read(simd).at(PENDING as u32));
        let step = V::of(simd, self.account.step);
        let (mass, searches, rubs) = (w.mass.read(simd), w.searches.read(simd), w.rubs.read(simd));
        let (joints, stiffness) = (w.joints.read(simd), w.stiffness.read(simd));
        let mut account = self.account.joints.write(simd);
        for i in 1..=last {
            let (stage, mu) = (w.stages[i].read(simd), w.stage_mu[i].read(simd));
            let weight = step * w.tableau.b[i];
            let mut momentum = zero;
            for &p in &t.place[..n as usize] {
                momentum = momentum - mass.at(p) * stage.of(p, VELOCITY);
            }
            let (mut damped, mut rubbed, mut pull) = (zero, zero, zero);
            let of_joint = account.iter_mut().zip(joints.iter()).zip(stiffness.iter());
            for (((mut sums, joint), stiffness), at) in of_joint.zip(&t.joints) {
                if i == 1 {
                    let lost = sums.row(DISSIPATION) + (step * w.tableau.b[0]) * sums.row(POWER);
                    sums.set_where(waits, DISSIPATION, lost);
                }
                let ([za, va, _], [zb, vb, _]) = (stage.at(at.sides[0]), stage.at(at.sides[1]));
                let difference = va - vb;
                let mut lost = joint.row(DAMPING) * difference * difference;
                damped = damped + lost;
                if at.to_top {
                    let force = spring(simd, at.one_sided, stiffness, za - zb);
                    pull = pull + (joint.row(DAMPING) * difference + force);
                }
                if at.rub != NONE {
                    let by_friction = 0.5 * searches.of(at.rub, NORMALS) * mu.at(at.rub) * difference;
                    rubbed = rubbed + by_friction;
                    lost = lost + by_friction;
                }
                sums.set_where(waits, DISSIPATION, sums.row(DISSIPATION) + weight * lost);
                if i == last {
                    sums.set_where(waits, POWER, lost);
                }
            }
            for &r in &t.rubs_of_top {
                pull = pull + rubs.of(r, NORMAL) * mu.at(r);
            }
            self.totals.momentum[i] = momentum.numbers();
            self.totals.damping[i] = damped.numbers();
            self.totals.friction[i] = rubbed.numbers();
            self.totals.top[i] = (pull.negated() * stage.of(n + 1, VELOCITY)).numbers();
        }
    }

    /// Peaks of the unknowns and the kinetic energy.
    #[inline(always)]
    fn observe_unknowns<S: Simd>(&mut self, simd: S) {
        let (w, t) = (self.work, &self.work.topology);
        let waits = Mask::of(w.lane.read(simd).at(PENDING as u32));
        let (state, mass) = (w.state.read(simd), w.mass.read(simd));
        let mut peaks = self.account.unknowns.write(simd);
        let (mut kinetic, mut most) = (V::splat(simd, 0.0), V::splat(simd, 0.0));
        for (k, &p) in (0..t.unknowns).zip(&t.place) {
            let [z, v, a] = state.at(p).map(
                #[inline(always)]
                |x| x.abs(),
            );
            kinetic = kinetic + 0.5 * mass.at(p) * v * v;
            let mut peaks = peaks.group(p);
            peaks.raise_where(waits, Z, z);
            peaks.raise_where(waits, VELOCITY, v);
            peaks.raise_where(waits, ACCELERATION, a);
            if k < t.blocks {
                most = most.max(z);
            }
        }
        self.totals.kinetic = kinetic.numbers();
        self.totals.displacement = most.numbers();
    }

    /// Peaks of the joints, the elastic energy and the force on the beam.
    #[inline(always)]
    fn observe_joints<S: Simd>(&mut self, simd: S) {
        let (w, t) = (self.work, &self.work.topology);
        let zero = V::splat(simd, 0.0);
        let waits = Mask::of(w.lane.read(simd).at(PENDING as u32));
        let step = V::of(simd, self.account.step);
        let (state, joints, stiffness) = (w.state.read(simd), w.joints.read(simd), w.stiffness.read(simd));
        let (mu, rubs) = (w.stage_mu[w.tableau.stages - 1].read(simd), w.rubs.read(simd));
        let mut account = self.account.joints.write(simd);
        let (mut elastic, mut pull, mut fastest, mut deepest) = (zero, zero, zero, zero);
        let of_joint = account.iter_mut().zip(joints.iter()).zip(stiffness.iter());
        for (((mut peaks, joint), stiffness), at) in of_joint.zip(&t.joints) {
            let ([za, va, aa], [zb, vb, ab]) = (state.at(at.sides[0]), state.at(at.sides[1]));
            let (d, dv) = (za - zb, va - vb);
            let force = spring(simd, at.one_sided, stiffness, d);
            elastic = elastic + 0.5 * force * d;
            peaks.raise_where(waits, DISPLACEMENT, d.abs());
            peaks.raise_where(waits, SPEED, dv.abs());
            peaks.raise_where(waits, RATE, (aa - ab).abs());
            peaks.raise_where(waits, FORCE, force.abs());
            if at.upright {
                peaks.raise_where(waits, OPENING, d.negated());
                peaks.raise_where(waits, CLOSING, d);
                deepest = deepest.max(d);
            } else {
                fastest = fastest.max(dv.abs());
            }
            if at.to_beam {
                pull = pull + (force + joint.row(DAMPING) * dv);
            }
            if at.rub != NONE {
                let slips = dv.abs().above(rubs.of(at.rub, SLIP)).and(waits);
                peaks.set_where(slips, SLIPPED, peaks.row(SLIPPED) + step * dv.abs());
            }
        }
        for &r in &t.rubs_of_beam {
            pull = pull + rubs.of(r, NORMAL) * mu.at(r);
        }
        self.totals.elastic = elastic.numbers();
        self.totals.slip_velocity = fastest.numbers();
        self.totals.closing = deepest.numbers();
        self.totals.pull = pull.numbers();
    }
}

/// Elastic force of a joint at relative displacement `d`.
#[inline(always)]
fn spring<S: Simd>(simd: S, one_sided: u32, stiffness: V<S>, d: V<S>) -> V<S> {
    let (force, zero) = (stiffness * d, V::splat(simd, 0.0));
    if one_sided == NONE { force } else { d.above(zero).pick(force, zero) }
}
