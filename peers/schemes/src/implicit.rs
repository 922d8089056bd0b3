//! Schemes whose stages are Concio's (T1): velocities V with
//!
//!   M (V − V_p) + τ Σ B f(δ_p + τ w, w) = −τ M a_0(t),   w = Bᵀ V,
//!
//! solved by Newton's method, the tangent of (6) moved along the law where it misses it (docs/theory.md, section 5).

use peer_system::{Law, Side, System};

use crate::dense::Dense;
use crate::impulses::meet;
use crate::motion::{Counts, Motion, Step};

/// Iterations of a stage.
const MOST: usize = 60;
/// Change of the velocities at which it ends, over the largest, and [m/s].
const ACCURACY: [f64; 2] = [1e-9, 1e-14];
/// Mismatch of tangent and law, as a fraction of μ_s, from which the tangent is moved.
const FAR: f64 = 0.02;

/// How a step is made of stages.
enum Scheme {
    /// One stage with τ = θ h, the end by extrapolation; with `energy` the one-sided springs' force is the difference of
    /// their energy over that of their displacement.
    OneStage { theta: f64, energy: bool },
    /// Springs and dashpots at θ = 1/2, friction at the velocity of the end: Moreau–Jean's θ scheme.
    FrictionAtEnd,
    /// Stiffly accurate with an explicit first stage: γ and the rows of a below the diagonal.
    RungeKutta { gamma: f64, rows: Vec<Vec<f64>> },
}

/// Where a stage takes its forces, V being the unknown velocity.
#[derive(Clone, Copy)]
struct Lever {
    /// Time of the stage [s], of V_p and of V.
    t: f64,
    start: f64,
    end: f64,
    /// τ of the forces [s].
    tau: f64,
    /// Springs act at δ_p + `spring` w [s].
    spring: f64,
    /// Dashpots act at `dashpot` w + (1 − `dashpot`) w_p.
    dashpot: f64,
}

impl Lever {
    /// That of (T1).
    fn plain(t: f64, tau: f64) -> Self {
        Lever { t, start: t, end: t, tau, spring: tau, dashpot: 1.0 }
    }
}

/// A scheme and its scratch.
pub struct Implicit {
    scheme: Scheme,
    matrix: Dense,
    /// Diagonal without friction.
    stiff: Vec<f64>,
    /// Tangents of the friction laws: velocity, coefficient, slope.
    tangents: Vec<[f64; 3]>,
    /// Linearised springs: force at velocity w, slope, w.
    springs: Vec<[f64; 3]>,
    /// Acceleration at the end of the last step.
    acceleration: Option<Vec<f64>>,
    friction: Vec<f64>,
}

impl Implicit {
    /// By name.
    pub fn new(system: &System, name: &str) -> Self {
        let (n, joints) = (system.mass.len(), system.joints.len());
        let one = |theta, energy| Scheme::OneStage { theta, energy };
        let scheme = match name {
            "backward-euler" => one(1.0, false),
            "energy" => one(0.5, true),
            "theta" => Scheme::FrictionAtEnd,
            "tr-bdf2" => tr_bdf2(),
            "esdirk4" => esdirk4(),
            _ => one(0.5, false),
        };
        let rest = |j: &peer_system::Joint| j.friction.map_or([0.0; 3], |f| [0.0, 0.0, f.at(0.0).1]);
        Implicit {
            scheme,
            matrix: Dense::new(n),
            stiff: vec![0.0; n],
            tangents: system.joints.iter().map(rest).collect(),
            springs: vec![[0.0; 3]; joints],
            acceleration: None,
            friction: vec![0.0; joints],
        }
    }

    /// Solves a stage; `old` are displacements at the start of the step if the energy is to be kept.
    fn stage(
        &mut self,
        system: &System,
        [z, v]: [&[f64]; 2],
        old: Option<&[f64]>,
        lever: Lever,
        counts: &mut Counts,
    ) -> Result<Vec<f64>, String> {
        let (n, tau, ground) = (system.mass.len(), lever.tau, system.ground(lever.t));
        let top = (system.top(lever.t).0, system.top(lever.end).1);
        let start = system.top(lever.start).1;
        // V_p with the top where a joint finds it, so that relative() serves for any velocity.
        let base: Vec<f64> = z.iter().chain(v).copied().collect();
        let mut solution = v.to_vec();
        for (spring, joint) in self.springs.iter_mut().zip(&system.joints) {
            let (d, w) = system.relative(joint, &base, (top.0 - lever.spring * top.1, top.1));
            *spring = elastic(joint, d, w, lever.spring, old.map(|z| relative_of(z, joint)));
        }
        for k in 0..MOST {
            counts.iterations += 1;
            self.assemble(system, lever, counts);
            let mut rhs: Vec<f64> = (0..n).map(|i| system.mass[i] * (v[i] - tau * ground)).collect();
            for (e, joint) in system.joints.iter().enumerate() {
                let [at, mu, slope] = self.tangents[e];
                let [force, stiffness, w] = self.springs[e];
                let normal = joint.normal_force[0];
                let (_, w_p) = system.relative(joint, &base, (0.0, start));
                let behind = (1.0 - lever.dashpot) * joint.damping * w_p;
                let constant = force - stiffness * w + normal * (mu - slope * at) + behind;
                let rate = lever.dashpot * joint.damping + stiffness + normal * slope;
                rhs[joint.a] -= tau * constant;
                match joint.b {
                    Side::Block(b) => rhs[b] += tau * constant,
                    Side::Support(support) => {
                        rhs[joint.a] += tau * rate * if support == peer_system::Support::Top { top.1 } else { 0.0 };
                    }
                }
            }
            self.matrix.solve(&mut rhs);
            let largest = rhs.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            let change = rhs.iter().zip(&solution).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
            if !largest.is_finite() || rhs.iter().any(|v| v.is_nan()) {
                return Err("the velocities are not finite".into());
            }
            solution = rhs;
            let kept = self.relinearise(system, [&base, &solution], old, top, lever);
            if kept && change <= ACCURACY[0] * largest + ACCURACY[1] {
                break;
            }
            counts.unconverged += u64::from(k + 1 == MOST);
        }
        for ((friction, joint), tangent) in self.friction.iter_mut().zip(&system.joints).zip(&self.tangents) {
            *friction = joint.normal_force[0] * tangent[1];
        }
        Ok(solution)
    }

    /// J = M + τ Σ B (c + τ k + N μ′) Bᵀ; where it is not positive, falling branches are taken as flat.
    fn assemble(&mut self, system: &System, lever: Lever, counts: &mut Counts) {
        let tau = lever.tau;
        for flat in [false, true] {
            self.matrix.set_diagonal(&system.mass);
            for (spring, joint) in self.springs.iter().zip(&system.joints) {
                self.matrix.couple(joint.a, block(joint.b), tau * (lever.dashpot * joint.damping + spring[1]));
            }
            for i in 0..system.mass.len() {
                self.stiff[i] = self.matrix.diagonal(i);
            }
            for (tangent, joint) in self.tangents.iter_mut().zip(&system.joints) {
                if flat {
                    tangent[2] = tangent[2].max(0.0);
                }
                self.matrix.couple(joint.a, block(joint.b), tau * joint.normal_force[0] * tangent[2]);
            }
            counts.factorisations += 1;
            if self.matrix.factorise() {
                return;
            }
        }
    }

    /// Springs and laws at the new velocities; whether none of them was far from its tangent.
    fn relinearise(
        &mut self,
        system: &System,
        [base, solution]: [&[f64]; 2],
        old: Option<&[f64]>,
        top: (f64, f64),
        lever: Lever,
    ) -> bool {
        let n = system.mass.len();
        let now: Vec<f64> = base[..n].iter().chain(solution).copied().collect();
        let mut kept = true;
        for (e, joint) in system.joints.iter().enumerate() {
            let (d, w) = system.relative(joint, &now, (top.0 - lever.spring * top.1, top.1));
            let spring = elastic(joint, d, w, lever.spring, old.map(|z| relative_of(z, joint)));
            let before = self.springs[e];
            kept &= (before[1] == 0.0) == (spring[1] == 0.0);
            self.springs[e] = spring;
            let Some(law) = joint.friction else { continue };
            let [at, mu, slope] = self.tangents[e];
            let drawn = mu + slope * (w - at);
            let (found, steep) = law.at(w);
            self.tangents[e] = [w, found, steep];
            if (found - drawn).abs() > FAR * law.fixed {
                kept = false;
                let free = 1.0 / self.stiff[joint.a] + block(joint.b).map_or(0.0, |b| 1.0 / self.stiff[b]);
                let s = lever.tau * joint.normal_force[0] * free;
                let (at, _) = meet(&law, false, s, w + s * drawn);
                let (mu, slope) = law.at(at);
                self.tangents[e] = [at, mu, slope];
            }
        }
        kept
    }
}

/// The unknown on the other side.
fn block(side: Side) -> Option<usize> {
    if let Side::Block(b) = side { Some(b) } else { None }
}

/// Relative displacement at the start of the step; of one-sided joints, which have blocks on both sides.
fn relative_of(z: &[f64], joint: &peer_system::Joint) -> f64 {
    z[joint.a] - block(joint.b).map_or(0.0, |b| z[b])
}

/// Elastic force at δ_p + τ w, its slope over w, and w. With the displacement at the start of a step of 2 τ the force of a
/// one-sided spring is the change of its energy over that of its displacement (Gonzalez, J. Nonlinear Sci. 6, 1996).
fn elastic(joint: &peer_system::Joint, d: f64, w: f64, tau: f64, start: Option<f64>) -> [f64; 3] {
    let k = joint.stiffness;
    match start.filter(|_| joint.law == Law::NoTension) {
        None => {
            let tangent = joint.tangent(d + tau * w);
            [tangent * (d + tau * w), tau * tangent, w]
        }
        Some(first) => {
            let last = first + 2.0 * tau * w;
            let (p, q) = (first.max(0.0), last.max(0.0));
            let change = last - first;
            if change.abs() <= 1e-12 * (first.abs() + last.abs()) {
                let tangent = joint.tangent(first);
                return [tangent * 0.5 * (first + last), tau * tangent, w];
            }
            let force = 0.5 * k * (q * q - p * p) / change;
            [force, 2.0 * tau * (k * q - force) / change, w]
        }
    }
}

impl Step for Implicit {
    fn step(&mut self, system: &System, motion: &mut Motion, h: f64, counts: &mut Counts) -> Result<(), String> {
        let n = system.mass.len();
        match &self.scheme {
            &Scheme::OneStage { theta, energy } => {
                let (z, v) = (motion.z.clone(), motion.v.clone());
                let old = energy.then_some(z.as_slice());
                let stage = self.stage(system, [&z, &v], old, Lever::plain(motion.t + theta * h, theta * h), counts)?;
                for i in 0..n {
                    motion.z[i] += h * stage[i];
                    motion.v[i] += (stage[i] - v[i]) / theta;
                }
                motion.friction.copy_from_slice(&self.friction);
            }
            Scheme::FrictionAtEnd => {
                let v = motion.v.clone();
                let z: Vec<f64> = motion.z.iter().zip(&v).map(|(z, v)| z + 0.25 * h * v).collect();
                let (t, start, end) = (motion.t + 0.5 * h, motion.t, motion.t + h);
                let lever = Lever { t, start, end, tau: h, spring: 0.25 * h, dashpot: 0.5 };
                motion.v = self.stage(system, [&z, &v], None, lever, counts)?;
                for i in 0..n {
                    motion.z[i] += 0.5 * h * (v[i] + motion.v[i]);
                }
                motion.friction.copy_from_slice(&self.friction);
            }
            Scheme::RungeKutta { gamma, rows } => {
                let (gamma, rows) = (*gamma, rows.clone());
                let first = self.acceleration.take().unwrap_or_else(|| {
                    let y: Vec<f64> = motion.z.iter().chain(&motion.v).copied().collect();
                    let mut rate = vec![0.0; 2 * n];
                    system.rates(&y, motion.t, &mut rate);
                    rate[n..].to_vec()
                });
                let mut rates = vec![(motion.v.clone(), first, self.friction.clone())];
                for row in &rows {
                    let (mut z, mut v) = (motion.z.clone(), motion.v.clone());
                    for (weight, (dz, dv, _)) in row.iter().zip(&rates) {
                        for i in 0..n {
                            z[i] += h * weight * dz[i];
                            v[i] += h * weight * dv[i];
                        }
                    }
                    let c = row.iter().sum::<f64>() + gamma;
                    let stage =
                        self.stage(system, [&z, &v], None, Lever::plain(motion.t + c * h, gamma * h), counts)?;
                    let dv = stage.iter().zip(&v).map(|(a, b)| (a - b) / (gamma * h)).collect();
                    rates.push((stage, dv, self.friction.clone()));
                }
                // The last row holds the weights.
                let weights: Vec<f64> = rows[rows.len() - 1].iter().copied().chain([gamma]).collect();
                motion.friction.fill(0.0);
                for (weight, (dz, dv, friction)) in weights.iter().zip(&rates) {
                    for i in 0..n {
                        motion.z[i] += h * weight * dz[i];
                        motion.v[i] += h * weight * dv[i];
                    }
                    for (mean, f) in motion.friction.iter_mut().zip(friction) {
                        *mean += weight * f;
                    }
                }
                self.acceleration = rates.pop().map(|(_, dv, _)| dv);
            }
        }
        Ok(())
    }
}

/// Bank et al., IEEE Trans. Electron Devices 32 (1985).
fn tr_bdf2() -> Scheme {
    let (gamma, w) = (1.0 - 0.5f64.sqrt(), 0.5 * 0.5f64.sqrt());
    Scheme::RungeKutta { gamma, rows: vec![vec![gamma], vec![w, w]] }
}

/// Kennedy and Carpenter, Appl. Numer. Math. 44 (2003), implicit part of ARK4(3)6L[2]SA.
fn esdirk4() -> Scheme {
    let rows = vec![
        vec![0.25],
        vec![8611.0 / 62500.0, -1743.0 / 31250.0],
        vec![5012029.0 / 34652500.0, -654441.0 / 2922500.0, 174375.0 / 388108.0],
        vec![
            15267082809.0 / 155376265600.0,
            -71443401.0 / 120774400.0,
            730878875.0 / 902184768.0,
            2285395.0 / 8070912.0,
        ],
        vec![82889.0 / 524892.0, 0.0, 15625.0 / 83664.0, 69875.0 / 102672.0, -2260.0 / 8211.0],
    ];
    Scheme::RungeKutta { gamma: 0.25, rows }
}
