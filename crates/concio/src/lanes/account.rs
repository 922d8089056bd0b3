//! Energies and envelopes of accepted steps, in the lanes that wait for it.
//!
//! Nothing that a step does depends on them, so they are made up for several lanes at once, just before the stages of
//! a step that waits are overwritten. Operations and their order are those of [`crate::dynamics::power`] and
//! [`crate::dynamics::observe`].

use pulp::{Simd, WithSimd};

use crate::integrate::tableau::STAGES;
use crate::lanes::rows::{Mask, Rows, V, WIDTH};
use crate::lanes::topology::NONE;
use crate::lanes::work::{PENDING, Work};
use crate::record::Envelopes;

/// Per-joint and per-unknown sums and peaks of all lanes.
#[derive(Debug)]
pub struct Account {
    /// Rate of each joint's dissipation at the last accepted state [W].
    pub joint_power: Rows,
    /// Peaks of displacement, velocity and acceleration.
    pub unknowns: [Rows; 3],
    /// Peaks of displacement, velocity, acceleration, force, opening and closing; slip; dissipation.
    pub joints: [Rows; 8],
    /// Step of the waiting account [s].
    pub step: [f64; WIDTH],
}

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

/// Place of the dissipation in [`Account::joints`].
const DISSIPATION: usize = 7;

impl Account {
    pub fn new(unknowns: usize, joints: usize) -> Self {
        Account {
            joint_power: Rows::new(joints),
            unknowns: std::array::from_fn(|_| Rows::new(unknowns)),
            joints: std::array::from_fn(|_| Rows::new(joints)),
            step: [0.0; WIDTH],
        }
    }

    /// The envelopes as rows of [`Account::unknowns`] and [`Account::joints`].
    fn envelopes(from: &mut Envelopes) -> ([&mut Vec<f64>; 3], [&mut Vec<f64>; 8]) {
        (
            [&mut from.block_displacement, &mut from.block_velocity, &mut from.block_acceleration],
            [
                &mut from.joint_displacement,
                &mut from.joint_velocity,
                &mut from.joint_acceleration,
                &mut from.joint_force,
                &mut from.joint_opening,
                &mut from.joint_closing,
                &mut from.joint_slip,
                &mut from.joint_dissipation,
            ],
        )
    }

    /// Takes the envelopes of a run into its lane.
    pub fn load(&mut self, lane: usize, place: &[u32], envelopes: &mut Envelopes) {
        let (unknowns, joints) = Self::envelopes(envelopes);
        for (rows, values) in self.unknowns.iter_mut().zip(unknowns) {
            for (value, &p) in values.iter().zip(place) {
                rows.set(p as usize, lane, *value);
            }
        }
        for (rows, values) in self.joints.iter_mut().zip(joints) {
            for (e, value) in values.iter().enumerate() {
                rows.set(e, lane, *value);
            }
        }
    }

    /// Gives them back.
    pub fn unload(&self, lane: usize, place: &[u32], envelopes: &mut Envelopes) {
        let (unknowns, joints) = Self::envelopes(envelopes);
        for (rows, values) in self.unknowns.iter().zip(unknowns) {
            for (value, &p) in values.iter_mut().zip(place) {
                *value = rows.at(p as usize, lane);
            }
        }
        for (rows, values) in self.joints.iter().zip(joints) {
            for (e, value) in values.iter_mut().enumerate() {
                *value = rows.at(e, lane);
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
        let mass = w.mass.read(simd);
        let mut power = self.account.joint_power.write(simd);
        let mut sums = self.account.joints[DISSIPATION].write(simd);
        let weight = step * w.tableau.b[0];
        for e in 0..t.joints.len() as u32 {
            sums.set_where(waits, e, sums.at(e) + weight * power.at(e));
        }
        let (damping, stiffness, normals) = (w.damping.read(simd), w.stiffness.read(simd), w.normals.read(simd));
        let normal = w.normal.read(simd);
        for i in 1..=last {
            let (z, v, mu) = (w.stage_z[i].read(simd), w.stage_v[i].read(simd), w.stage_mu[i].read(simd));
            let weight = step * w.tableau.b[i];
            let mut momentum = zero;
            for k in 0..n {
                let p = t.place[k as usize];
                momentum = momentum - mass.at(p) * v.at(p);
            }
            let (mut damped, mut rubbed, mut pull) = (zero, zero, zero);
            for (e, joint) in (0u32..).zip(&t.joints) {
                let [a, b] = joint.sides;
                let difference = v.at(a) - v.at(b);
                let mut lost = damping.at(e) * difference * difference;
                damped = damped + lost;
                if joint.to_top {
                    let d = z.at(a) - z.at(b);
                    let force = stiffness.at(e) * d;
                    let force = if joint.one_sided == NONE { force } else { d.above(zero).pick(force, zero) };
                    pull = pull + (damping.at(e) * difference + force);
                }
                if joint.rub != NONE {
                    let mu = mu.at(joint.rub);
                    let by_friction = 0.5 * normals.at(joint.rub) * mu * difference;
                    rubbed = rubbed + by_friction;
                    lost = lost + by_friction;
                }
                sums.set_where(waits, e, sums.at(e) + weight * lost);
                if i == last {
                    power.set_where(waits, e, lost);
                }
            }
            for &r in &t.rubs_of_top {
                pull = pull + normal.at(r) * mu.at(r);
            }
            self.totals.momentum[i] = momentum.numbers();
            self.totals.damping[i] = damped.numbers();
            self.totals.friction[i] = rubbed.numbers();
            self.totals.top[i] = (pull.negated() * v.at(n + 1)).numbers();
        }
    }

    /// Peaks of the unknowns and the kinetic energy.
    #[inline(always)]
    fn observe_unknowns<S: Simd>(&mut self, simd: S) {
        let (w, t) = (self.work, &self.work.topology);
        let waits = Mask::of(w.lane.read(simd).at(PENDING as u32));
        let (z, v, a, mass) = (w.z.read(simd), w.v.read(simd), w.a.read(simd), w.mass.read(simd));
        let [of_z, of_v, of_a] = &mut self.account.unknowns;
        let (mut of_z, mut of_v, mut of_a) = (of_z.write(simd), of_v.write(simd), of_a.write(simd));
        let (mut kinetic, mut most) = (V::splat(simd, 0.0), V::splat(simd, 0.0));
        for k in 0..t.unknowns {
            let p = t.place[k as usize];
            let (z, v) = (z.at(p).abs(), v.at(p).abs());
            kinetic = kinetic + 0.5 * mass.at(p) * v * v;
            of_z.raise_where(waits, p, z);
            of_v.raise_where(waits, p, v);
            of_a.raise_where(waits, p, a.at(p).abs());
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
        let (z, v, a) = (w.z.read(simd), w.v.read(simd), w.a.read(simd));
        let (damping, stiffness, normal) = (w.damping.read(simd), w.stiffness.read(simd), w.normal.read(simd));
        let (mu, slip_velocity) = (w.stage_mu[w.tableau.stages - 1].read(simd), w.slip.read(simd));
        let rows = &mut self.account.joints;
        let [of_d, of_w, of_dw, of_f, opening, closing, slip, _] = rows.each_mut().map(|rows| rows.write(simd));
        let (mut of_d, mut of_w, mut of_dw, mut of_f) = (of_d, of_w, of_dw, of_f);
        let (mut opening, mut closing, mut slip) = (opening, closing, slip);
        let (mut elastic, mut pull) = (zero, zero);
        let (mut fastest, mut deepest) = (zero, zero);
        for (e, joint) in (0u32..).zip(&t.joints) {
            let [i, k] = joint.sides;
            let (d, dv) = (z.at(i) - z.at(k), v.at(i) - v.at(k));
            let force = stiffness.at(e) * d;
            let force = if joint.one_sided == NONE { force } else { d.above(zero).pick(force, zero) };
            elastic = elastic + 0.5 * force * d;
            of_d.raise_where(waits, e, d.abs());
            of_w.raise_where(waits, e, dv.abs());
            of_dw.raise_where(waits, e, (a.at(i) - a.at(k)).abs());
            of_f.raise_where(waits, e, force.abs());
            if joint.upright {
                opening.raise_where(waits, e, d.negated());
                closing.raise_where(waits, e, d);
                deepest = deepest.max(d);
            } else {
                fastest = fastest.max(dv.abs());
            }
            if joint.to_beam {
                pull = pull + (force + damping.at(e) * dv);
            }
            if joint.rub != NONE {
                let slips = dv.abs().above(slip_velocity.at(joint.rub)).and(waits);
                slip.set_where(slips, e, slip.at(e) + step * dv.abs());
            }
        }
        for &r in &t.rubs_of_beam {
            pull = pull + normal.at(r) * mu.at(r);
        }
        self.totals.elastic = elastic.numbers();
        self.totals.slip_velocity = fastest.numbers();
        self.totals.closing = deepest.numbers();
        self.totals.pull = pull.numbers();
    }
}
