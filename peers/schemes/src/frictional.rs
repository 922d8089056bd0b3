//! Schemes that find friction impulses by Gauss–Seidel over the joints, one joint at a time with the others held:
//! Moreau–Jean's θ scheme, and central differences.

use peer_system::{Side, Support, System};

use crate::dense::Dense;
use crate::impulses::meet;
use crate::motion::{Counts, Motion, Step};

/// Sweeps over all joints after which a step is taken as it is.
const MOST: usize = 500;
/// Largest change of a velocity in a sweep at which the sweeps end [m/s], with (6) and with the set-valued law.
const ACCURACY: [f64; 2] = [1e-9, 1e-6];
/// Changes of the set of closed one-sided joints in a step.
const MOST_SETS: usize = 30;

/// M (v₁ − v₀) + h Σ B (k δ_θ + c w_θ) + Σ B p = −h M a_0, p = h N μ(w₁), x_θ = θ x₁ + (1 − θ) x₀ (Jean, Comput. Methods
/// Appl. Mech. Eng. 177, 1999; Acary & Brogliato 2008).
pub struct MoreauJean {
    theta: f64,
    sharp: bool,
    closed: Vec<bool>,
    /// h for which matrix and `response` hold.
    made_for: f64,
    matrix: Dense,
    /// Joints that rub, and Bᵀ M̂⁻¹ B among them, and M̂⁻¹ B.
    rubs: Vec<usize>,
    response: Vec<Vec<f64>>,
    columns: Vec<Vec<f64>>,
    impulse: Vec<f64>,
}

impl MoreauJean {
    pub fn new(system: &System, theta: f64, sharp: bool) -> Self {
        let rubs = rubs(system);
        MoreauJean {
            theta,
            sharp,
            closed: system.joints.iter().map(|j| j.law == peer_system::Law::Elastic).collect(),
            made_for: 0.0,
            matrix: Dense::new(system.mass.len()),
            impulse: vec![0.0; rubs.len()],
            response: Vec::new(),
            columns: Vec::new(),
            rubs,
        }
    }

    /// M̂ = M + h Σ B (θ c + h θ² k) Bᵀ and what impulses do to velocities through it.
    fn prepare(&mut self, system: &System, h: f64, counts: &mut Counts) {
        self.matrix.set_diagonal(&system.mass);
        for (joint, closed) in system.joints.iter().zip(&self.closed) {
            let k = if *closed { joint.stiffness } else { 0.0 };
            let s = h * self.theta * (joint.damping + h * self.theta * k);
            self.matrix.couple(joint.a, block(joint.b), s);
        }
        counts.factorisations += 1;
        // Positive definite: masses, and terms that are not negative.
        self.matrix.factorise();
        let column = |&e: &usize| {
            let joint = &system.joints[e];
            let mut column = vec![0.0; system.mass.len()];
            column[joint.a] = 1.0;
            if let Side::Block(b) = joint.b {
                column[b] = -1.0;
            }
            self.matrix.solve(&mut column);
            column
        };
        self.columns = self.rubs.iter().map(column).collect();
        let across = |column: &Vec<f64>, &e: &usize| {
            let joint = &system.joints[e];
            column[joint.a] - block(joint.b).map_or(0.0, |b| column[b])
        };
        self.response = self.columns.iter().map(|c| self.rubs.iter().map(|e| across(c, e)).collect()).collect();
        self.made_for = h;
    }

    /// Change of the velocities with the current set of closed joints.
    fn change(&mut self, system: &System, motion: &Motion, h: f64, counts: &mut Counts) -> Vec<f64> {
        let (n, theta) = (system.mass.len(), self.theta);
        let y: Vec<f64> = motion.z.iter().chain(&motion.v).copied().collect();
        let (top, end) = (system.top(motion.t), system.top(motion.t + h));
        let ground = system.ground(motion.t + theta * h);
        let mut change: Vec<f64> = system.mass.iter().map(|m| -h * m * ground).collect();
        for (joint, closed) in system.joints.iter().zip(&self.closed) {
            let (d, w) = system.relative(joint, &y, top);
            let k = if *closed { joint.stiffness } else { 0.0 };
            let f = h * (k * (d + h * theta * w) + joint.damping * w);
            change[joint.a] -= f;
            match joint.b {
                Side::Block(b) => change[b] += f,
                Side::Support(Support::Top) => {
                    let s = h * theta * (joint.damping + h * theta * k);
                    change[joint.a] += s * (end.1 - top.1);
                }
                Side::Support(Support::Base) => {}
            }
        }
        self.matrix.solve(&mut change);
        let now: Vec<f64> = (0..n).map(|i| motion.v[i] + change[i]).collect();
        let at_end: Vec<f64> = motion.z.iter().chain(&now).copied().collect();
        let mut w: Vec<f64> = self.rubs.iter().map(|&e| system.relative(&system.joints[e], &at_end, end).1).collect();
        for (p, response) in self.impulse.iter().zip(&self.response) {
            w.iter_mut().zip(response).for_each(|(w, r)| *w -= r * p);
        }
        self.sweep(system, &mut w, h, counts);
        for (p, column) in self.impulse.iter().zip(&self.columns) {
            change.iter_mut().zip(column).for_each(|(x, c)| *x -= c * p);
        }
        change
    }

    fn sweep(&mut self, system: &System, w: &mut [f64], h: f64, counts: &mut Counts) {
        for k in 0..MOST {
            counts.iterations += 1;
            let mut largest = 0.0f64;
            for (j, &e) in self.rubs.iter().enumerate() {
                let joint = &system.joints[e];
                let Some(law) = joint.friction else { continue };
                let own = self.response[j][j];
                let s = own * h * joint.normal_force[0];
                let (_, mu) = meet(&law, self.sharp, s, w[j] + own * self.impulse[j]);
                let step = h * joint.normal_force[0] * mu - self.impulse[j];
                self.impulse[j] += step;
                w.iter_mut().zip(&self.response[j]).for_each(|(w, r)| *w -= r * step);
                largest = largest.max((own * step).abs());
            }
            if largest <= ACCURACY[usize::from(self.sharp)] {
                return;
            }
            counts.unconverged += u64::from(k + 1 == MOST);
        }
    }
}

impl Step for MoreauJean {
    fn step(&mut self, system: &System, motion: &mut Motion, h: f64, counts: &mut Counts) -> Result<(), String> {
        let theta = self.theta;
        let y: Vec<f64> = motion.z.iter().chain(&motion.v).copied().collect();
        let mut change = Vec::new();
        for _ in 0..MOST_SETS {
            if self.made_for != h {
                self.prepare(system, h, counts);
            }
            change = self.change(system, motion, h, counts);
            if change.iter().any(|v| !v.is_finite()) {
                return Err("the velocities are not finite".into());
            }
            let mut flipped = false;
            for (joint, closed) in system.joints.iter().zip(&mut self.closed) {
                let Side::Block(b) = joint.b else { continue };
                let (d, w) = system.relative(joint, &y, (0.0, 0.0));
                let is = joint.tangent(d + h * theta * (w + theta * (change[joint.a] - change[b]))) > 0.0;
                flipped |= joint.stiffness > 0.0 && is != *closed;
                *closed = is;
            }
            if !flipped {
                break;
            }
            self.made_for = 0.0;
        }
        for i in 0..system.mass.len() {
            motion.z[i] += h * (motion.v[i] + theta * change[i]);
            motion.v[i] += change[i];
        }
        motion.friction.fill(0.0);
        for (p, &e) in self.impulse.iter().zip(&self.rubs) {
            motion.friction[e] = p / h;
        }
        Ok(())
    }
}

/// Central differences, velocities half a step after displacements; springs and dashpots explicit, friction implicit.
/// Stable for steps below 2/ω of the stiffest joint.
pub struct Explicit {
    sharp: bool,
    rubs: Vec<usize>,
    impulse: Vec<f64>,
}

impl Explicit {
    pub fn new(system: &System, sharp: bool) -> Self {
        let rubs = rubs(system);
        Explicit { sharp, impulse: vec![0.0; rubs.len()], rubs }
    }
}

impl Step for Explicit {
    fn step(&mut self, system: &System, motion: &mut Motion, h: f64, counts: &mut Counts) -> Result<(), String> {
        let n = system.mass.len();
        let (top, middle, ground) = (system.top(motion.t), system.top(motion.t + 0.5 * h), system.ground(motion.t));
        let y: Vec<f64> = motion.z.iter().chain(&motion.v).copied().collect();
        for joint in &system.joints {
            let (d, w) = system.relative(joint, &y, top);
            let f = h * (joint.tangent(d) * d + joint.damping * w);
            motion.v[joint.a] -= f / system.mass[joint.a];
            if let Side::Block(b) = joint.b {
                motion.v[b] += f / system.mass[b];
            }
        }
        motion.v.iter_mut().for_each(|v| *v -= h * ground);
        let kick = |v: &mut [f64], e: usize, p: f64| {
            let joint = &system.joints[e];
            v[joint.a] -= p / system.mass[joint.a];
            if let Side::Block(b) = joint.b {
                v[b] += p / system.mass[b];
            }
        };
        for (&e, &p) in self.rubs.iter().zip(&self.impulse) {
            kick(&mut motion.v, e, p);
        }
        for k in 0..MOST {
            counts.iterations += 1;
            let mut largest = 0.0f64;
            for (&e, impulse) in self.rubs.iter().zip(&mut self.impulse) {
                let joint = &system.joints[e];
                let Some(law) = joint.friction else { continue };
                let (other, free) = match joint.b {
                    Side::Block(b) => (motion.v[b], 1.0 / system.mass[b]),
                    Side::Support(Support::Top) => (middle.1, 0.0),
                    Side::Support(Support::Base) => (0.0, 0.0),
                };
                let own = free + 1.0 / system.mass[joint.a];
                let w = motion.v[joint.a] - other;
                let (_, mu) = meet(&law, self.sharp, own * h * joint.normal_force[0], w + own * *impulse);
                let step = h * joint.normal_force[0] * mu - *impulse;
                *impulse += step;
                kick(&mut motion.v, e, step);
                largest = largest.max((own * step).abs());
            }
            if largest <= ACCURACY[usize::from(self.sharp)] {
                break;
            }
            counts.unconverged += u64::from(k + 1 == MOST);
        }
        for i in 0..n {
            motion.z[i] += h * motion.v[i];
        }
        if motion.v.iter().any(|v| !(v.abs() < 1e6)) {
            return Err("the motion grows beyond all bounds: the step is too long".into());
        }
        motion.friction.fill(0.0);
        for (p, &e) in self.impulse.iter().zip(&self.rubs) {
            motion.friction[e] = p / h;
        }
        Ok(())
    }
}

/// Joints that rub.
fn rubs(system: &System) -> Vec<usize> {
    let rubs = |e: &usize| system.joints[*e].friction.is_some() && system.joints[*e].normal_force[0] > 0.0;
    (0..system.joints.len()).filter(rubs).collect()
}

/// The unknown on the other side.
fn block(side: Side) -> Option<usize> {
    if let Side::Block(b) = side { Some(b) } else { None }
}
