//! One implicit stage: find the velocities V of
//!
//!   (T1)  M (V − V_p) + τ Σ_j B_j f_j(δ_p + τ w_j, w_j) = −τ M a_0(t),   w = Bᵀ V,   τ = γ h
//!
//! with z = z_p + τ V, so that only velocities are unknown. Newton's method on the joints' tangents, with two
//! departures that (6) and (3) need:
//!
//! * Where the tangent of (6) misses the law by much, the next tangent is not taken at the new velocity w but where
//!   the law meets the line through the new point (w, f) of slope −Z, Z being the impedance τ⁻¹(1/J_aa + 1/J_bb)⁻¹
//!   that the joint sees with its neighbours held. On the steep branch this follows the force, on the flat one the
//!   velocity, as limiting does for diodes in circuit simulators; plain Newton cycles between the two (theory,
//!   section 6).
//! * Unilateral joints keep an active set; a joint whose state changes makes another iteration.
//!
//! The iteration ends when the correction that the remaining force mismatch would cause, through the last factors,
//! is below the tolerance; that correction is still applied.

use crate::integrate::linear::Matrix;
use crate::law::Stribeck;
use crate::model::Model;
use crate::state::Tangents;

/// Iterations after which a stage is given up and the step halved.
const MOST_ITERATIONS: usize = 30;
/// Mismatch of tangent and law, as a fraction of μ_s, beyond which the next tangent is moved along the law.
const FAR: f64 = 0.02;

/// Scratch of the stage.
#[derive(Debug, Clone)]
pub struct Stage {
    pub matrix: Matrix,
    /// Slot of each joint's coupling in the matrix; `u32::MAX` for joints with a support.
    slots: Vec<u32>,
    /// z_p and V_p, with base and top at the end.
    pub z: Vec<f64>,
    pub v: Vec<f64>,
    /// V: guess before, solution after.
    pub solution: Vec<f64>,
    /// Sum of joint forces on each unknown.
    force: Vec<f64>,
    rhs: Vec<f64>,
    mu: Vec<f64>,
    slope: Vec<f64>,
    /// τ of the factors, when they hold for the active set as it is and no joint rubs.
    factors_for: f64,
    /// Counts.
    pub iterations: u64,
    pub factorisations: u64,
}

/// Why a stage was given up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// No convergence, or a pivot that is not positive: the step is too long.
    TooLong,
    /// A value that is not finite.
    NotFinite,
}

impl Stage {
    /// Scratch for `model`.
    pub fn new(model: &Model) -> Self {
        let n = model.unknowns();
        let coupled = |s: &[u32; 2]| (s[1] as usize) < n;
        let pairs: Vec<(usize, usize)> =
            model.sides.iter().filter(|s| coupled(s)).map(|s| (s[0] as usize, s[1] as usize)).collect();
        let (matrix, found) = Matrix::new(n, &pairs);
        let mut found = found.into_iter();
        let slots =
            model.sides.iter().map(|s| if coupled(s) { found.next().unwrap_or(u32::MAX) } else { u32::MAX }).collect();
        Stage {
            matrix,
            slots,
            z: vec![0.0; n + 2],
            v: vec![0.0; n + 2],
            solution: vec![0.0; n + 2],
            force: vec![0.0; n + 2],
            rhs: vec![0.0; n],
            mu: vec![0.0; model.rubs.len()],
            slope: vec![0.0; model.rubs.len()],
            factors_for: 0.0,
            iterations: 0,
            factorisations: 0,
        }
    }

    /// Forgets the factors: what a step does must not depend on what was tried before it.
    pub fn forget_factors(&mut self) {
        self.factors_for = 0.0;
    }

    /// Solves (T1) for τ = `tau` [s] and base acceleration `ground` [m/s²]; `accuracy` [m/s] is the error of V that
    /// is allowed. `self.z`, `self.v` hold z_p and V_p, `self.solution` the top's velocity in its last place (and
    /// z_p there is u_1 − τ u̇_1, so that z = z_p + τ V holds for all).
    pub fn solve(
        &mut self,
        model: &Model,
        tangents: &mut Tangents,
        tau: f64,
        ground: f64,
        accuracy: f64,
    ) -> Result<(), Failure> {
        let n = model.unknowns();
        self.solution[..n].copy_from_slice(&self.v[..n]);
        for _ in 0..MOST_ITERATIONS {
            self.iterations += 1;
            self.assemble(model, tangents, tau)?;
            self.residual(model, tangents, tau, ground);
            self.matrix.solve(&mut self.rhs);
            for (v, d) in self.solution.iter_mut().zip(&self.rhs) {
                *v -= d;
            }
            let flipped = self.flip(model, tangents, tau);
            self.mismatch(model, tangents, tau);
            self.matrix.solve(&mut self.rhs);
            // A sum, because a maximum would pass over what is not a number.
            let (mut correction, mut sum) = (0.0f64, 0.0);
            for d in &self.rhs {
                correction = correction.max(d.abs());
                sum += d.abs();
            }
            if !sum.is_finite() {
                return Err(Failure::NotFinite);
            }
            if !flipped && correction <= accuracy {
                self.finish(model, tangents);
                return Ok(());
            }
            self.move_tangents(model, tangents, tau);
        }
        Err(Failure::TooLong)
    }

    /// Applies the last correction and leaves the tangents at the solution.
    fn finish(&mut self, model: &Model, tangents: &mut Tangents) {
        for (r, rub) in model.rubs.iter().enumerate() {
            let [a, b] = model.sides[rub.joint as usize].map(|s| s as usize);
            tangents.velocity[r] = self.solution[a] - self.solution[b];
        }
        for (v, d) in self.solution.iter_mut().zip(&self.rhs) {
            *v -= d;
        }
        for (r, rub) in model.rubs.iter().enumerate() {
            let [a, b] = model.sides[rub.joint as usize].map(|s| s as usize);
            let w = self.solution[a] - self.solution[b];
            tangents.mu[r] = self.mu[r] + self.slope[r] * (w - tangents.velocity[r]);
            tangents.slope[r] = self.slope[r];
            tangents.velocity[r] = w;
        }
    }

    /// J = M + τ Σ B (c + τ k + N μ') Bᵀ, factorised.
    fn assemble(&mut self, model: &Model, tangents: &Tangents, tau: f64) -> Result<(), Failure> {
        if model.rubs.is_empty() && self.factors_for == tau {
            return Ok(());
        }
        self.matrix.set_diagonal(&model.mass);
        for (e, law) in model.elastic.iter().enumerate() {
            let stiffness = if tangents.closed[e] { law.stiffness } else { 0.0 };
            let s = tau * (law.damping + tau * stiffness);
            self.add(model.sides[e], e, s, s);
        }
        for (r, rub) in model.rubs.iter().enumerate() {
            let s = tau * tangents.slope[r];
            self.add(model.sides[rub.joint as usize], rub.joint as usize, s * rub.normal[0], s * rub.normal[1]);
        }
        self.factorisations += 1;
        self.factors_for = 0.0;
        self.matrix.factorise(model.reciprocal).map_err(|_| Failure::TooLong)?;
        self.factors_for = tau;
        Ok(())
    }

    #[inline]
    fn add(&mut self, [a, b]: [u32; 2], joint: usize, in_a: f64, in_b: f64) {
        match self.slots[joint] {
            u32::MAX => self.matrix.add_diagonal(a as usize, in_a),
            slot => self.matrix.add(slot, a as usize, b as usize, in_a, in_b),
        }
    }

    /// Left side of (T1) less its right side, with the tangents in place of (6), into `rhs`.
    fn residual(&mut self, model: &Model, tangents: &Tangents, tau: f64, ground: f64) {
        self.force.fill(0.0);
        for (e, (law, &[a, b])) in model.elastic.iter().zip(&model.sides).enumerate() {
            let (a, b) = (a as usize, b as usize);
            let w = self.solution[a] - self.solution[b];
            let d = self.z[a] - self.z[b] + tau * w;
            let f = law.damping * w + if tangents.closed[e] { law.stiffness * d } else { 0.0 };
            self.force[a] += f;
            self.force[b] -= f;
        }
        for (r, rub) in model.rubs.iter().enumerate() {
            let [a, b] = model.sides[rub.joint as usize];
            let (a, b) = (a as usize, b as usize);
            let w = self.solution[a] - self.solution[b];
            let mu = tangents.mu[r] + tangents.slope[r] * (w - tangents.velocity[r]);
            self.force[a] += rub.normal[0] * mu;
            self.force[b] -= rub.normal[1] * mu;
        }
        for i in 0..model.unknowns() {
            let inertia = model.mass[i] * (self.solution[i] - self.v[i] + tau * ground);
            self.rhs[i] = inertia + tau * self.force[i];
        }
    }

    /// Brings the active set up to date; true when it changed.
    fn flip(&mut self, model: &Model, tangents: &mut Tangents, tau: f64) -> bool {
        let mut flipped = false;
        for (e, (law, &[a, b])) in model.elastic.iter().zip(&model.sides).enumerate() {
            if law.unilateral {
                let (a, b) = (a as usize, b as usize);
                let d = self.z[a] - self.z[b] + tau * (self.solution[a] - self.solution[b]);
                let closed = d > 0.0;
                flipped |= closed != tangents.closed[e];
                tangents.closed[e] = closed;
            }
        }
        if flipped {
            self.factors_for = 0.0;
        }
        flipped
    }

    /// The laws at the new velocities, and τ Σ B N (μ − tangent) into `rhs`.
    fn mismatch(&mut self, model: &Model, tangents: &Tangents, tau: f64) {
        self.rhs.fill(0.0);
        let n = self.rhs.len();
        for (r, rub) in model.rubs.iter().enumerate() {
            let [a, b] = model.sides[rub.joint as usize];
            let (a, b) = (a as usize, b as usize);
            let w = self.solution[a] - self.solution[b];
            (self.mu[r], self.slope[r]) = rub.law.at(w);
            let missed = tau * (self.mu[r] - tangents.mu[r] - tangents.slope[r] * (w - tangents.velocity[r]));
            self.rhs[a] += rub.normal[0] * missed;
            if b < n {
                self.rhs[b] -= rub.normal[1] * missed;
            }
        }
    }

    fn move_tangents(&mut self, model: &Model, tangents: &mut Tangents, tau: f64) {
        let n = self.rhs.len();
        for (r, rub) in model.rubs.iter().enumerate() {
            let [a, b] = model.sides[rub.joint as usize];
            let (a, b) = (a as usize, b as usize);
            let w = self.solution[a] - self.solution[b];
            let old = tangents.slope[r];
            let target = tangents.mu[r] + old * (w - tangents.velocity[r]);
            let (mut at, mut mu, mut slope) = (w, self.mu[r], self.slope[r]);
            if (mu - target).abs() > FAR * rub.law.static_ {
                let normal = 0.5 * (rub.normal[0] + rub.normal[1]);
                // Falling slopes of the neighbours may outweigh the rest: no less than the mass is seen.
                let seen =
                    |i: usize, normal: f64| (self.matrix.diagonal(i) - tau * normal * old).max(model.mass[i]).recip();
                let free_a = seen(a, rub.normal[0]);
                let free_b = if b < n { seen(b, rub.normal[1]) } else { 0.0 };
                let impedance = 1.0 / (tau * normal * (free_a + free_b));
                at = meet(&rub.law, impedance, target + impedance * w);
                (mu, slope) = rub.law.at(at);
            }
            tangents.velocity[r] = at;
            tangents.mu[r] = mu;
            tangents.slope[r] = slope;
        }
    }
}

/// Velocity at which μ(v) + z v = c: safeguarded Newton inside the bracket [0, c/z]. Three digits are enough, it is
/// only where the next tangent is drawn.
fn meet(law: &Stribeck, z: f64, c: f64) -> f64 {
    let (sign, c) = (c.signum(), c.abs());
    if c == 0.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, c / z);
    if !high.is_finite() {
        return 0.0;
    }
    let width = law.slip_velocity / law.beta;
    // Start on the branch that the right side points to: the inverse of the arctangent, or the velocity.
    let ratio = c / law.static_;
    let mut v = if ratio < 0.95 { width * (std::f64::consts::FRAC_PI_2 * ratio).tan() } else { high };
    if !(v > low && v < high) {
        v = 0.5 * high;
    }
    for _ in 0..20 {
        let (mu, slope) = law.at(v);
        let f = mu + z * v - c;
        if f.abs() <= 1e-3 * law.static_ {
            break;
        }
        if f < 0.0 {
            low = v;
        } else {
            high = v;
        }
        let next = v - f / (slope + z);
        // Bisect in the geometric mean: the law lives on scales from δ_v/β to metres per second.
        v = if next > low && next < high { next } else { (low.max(1e-3 * width) * high).sqrt().clamp(low, high) };
    }
    sign * v
}
