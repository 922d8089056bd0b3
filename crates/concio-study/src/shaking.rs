//! What a motion is to a wall: its peaks and spectral accelerations as the run has them, and the wall's first mode.

use concio::excitation::Excitation;
use concio::model::Model;
use concio::planar::Vibration;

use crate::intensity::{DAMPING, Sampled};

/// Relative change of ω² at which the iteration for the first period ends, and its rounds.
const SETTLED: f64 = 1e-10;
const ROUNDS: usize = 200;

/// Peaks of the motion of a base.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Shaking {
    /// Largest |acceleration| [m/s²].
    pub pga: f64,
    /// Largest |velocity| [m/s].
    pub pgv: f64,
    /// Pseudo-acceleration of 5 % damping at each period asked for [m/s²].
    pub sa: Vec<f64>,
    /// The same at the first period of the wall.
    pub at_first: Option<f64>,
    /// At the first period with the damping of the first mode, which may be far from 5 % [m/s²].
    pub at_first_damped: Option<f64>,
}

/// First mode of a wall whose joints are intact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Period [s].
    pub period: f64,
    /// Damping ratio.
    pub damping: f64,
}

impl Shaking {
    /// Of the motion of a base over a run; spectra at `periods` [s] and for the wall's first `mode`.
    pub fn of(excitation: &Excitation, periods: &[f64], mode: Option<Mode>) -> Self {
        let base = Sampled::of(&excitation.base, excitation.duration);
        Shaking {
            pga: base.pga(),
            pgv: base.pgv(),
            sa: base.psa(DAMPING, periods),
            at_first: mode.map(|m| base.psa(DAMPING, &[m.period])[0]),
            at_first_damped: mode.map(|m| base.psa(m.damping, &[m.period])[0]),
        }
    }
}

/// First mode of a wall all of whose joints are intact: bonds have their stiffness in both directions, elastic
/// joints theirs, devices that of rest; head joints without tension or bond are left out. None when nothing holds the wall. Of a planar wall its slowest
/// vibration about where it stands ([`concio::planar::Planar::slowest`]).
///
/// Inverse iteration with the Rayleigh quotient; the systems are solved by conjugate gradients, preconditioned by the
/// diagonal (e.g. J. Nocedal, S. Wright, Numerical Optimization, 2nd ed. 2006, algorithm 5.3).
pub fn first_mode(model: &Model) -> Option<Mode> {
    if let Some(planar) = model.planar() {
        let of = |v: Vibration| Mode { period: 2.0 * std::f64::consts::PI / v.frequency, damping: v.damping };
        return planar.slowest().map(of);
    }
    let n = model.unknowns();
    let mut stiffness: Vec<f64> =
        model.shear.elastic.iter().map(|e| if e.unilateral { 0.0 } else { e.stiffness }).collect();
    for bond in &model.shear.bonds {
        stiffness[bond.joint as usize] = bond.law.stiffness;
    }
    for device in &model.shear.nonlinear {
        stiffness[device.joint as usize] += device.law.initial_stiffness();
    }
    let springs = Springs { model, stiffness };
    let mut x = vec![1.0; n];
    let mut before = f64::INFINITY;
    for _ in 0..ROUNDS {
        let load: Vec<f64> = model.shear.mass.iter().zip(&x).map(|(m, x)| m * x).collect();
        x = springs.solve(&load)?;
        let top: f64 = x.iter().zip(&load).map(|(x, f)| x * f).sum();
        let bottom: f64 = x.iter().zip(&model.shear.mass).map(|(x, m)| m * x * x).sum();
        // K x = M x_old: the quotient of x is xᵀ K x / xᵀ M x.
        let square = top / bottom;
        if !(square.is_finite() && square > 0.0) {
            return None;
        }
        if (square - before).abs() <= SETTLED * square {
            let damping = |e: usize| model.shear.elastic[e].damping * springs.stretch(&x, e).powi(2);
            let damped: f64 = (0..model.shear.elastic.len()).map(damping).sum();
            let omega = square.sqrt();
            let period = 2.0 * std::f64::consts::PI / omega;
            return Some(Mode { period, damping: damped / (2.0 * omega * bottom) });
        }
        before = square;
        let scale = 1.0 / bottom.sqrt();
        x.iter_mut().for_each(|x| *x *= scale);
    }
    None
}

struct Springs<'m> {
    model: &'m Model,
    stiffness: Vec<f64>,
}

impl Springs<'_> {
    /// Relative displacement of joint `e`.
    fn stretch(&self, x: &[f64], e: usize) -> f64 {
        let [a, b] = self.model.shear.sides[e].map(|i| x.get(i as usize).copied().unwrap_or(0.0));
        a - b
    }

    fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for (e, (k, [a, b])) in self.stiffness.iter().zip(&self.model.shear.sides).enumerate() {
            let force = k * self.stretch(x, e);
            for (side, sign) in [(a, 1.0), (b, -1.0)] {
                if let Some(y) = y.get_mut(*side as usize) {
                    *y += sign * force;
                }
            }
        }
        y
    }

    fn solve(&self, load: &[f64]) -> Option<Vec<f64>> {
        let n = load.len();
        let mut diagonal = vec![0.0; n];
        for (k, sides) in self.stiffness.iter().zip(&self.model.shear.sides) {
            for side in sides {
                if let Some(d) = diagonal.get_mut(*side as usize) {
                    *d += k;
                }
            }
        }
        if diagonal.iter().any(|d| *d <= 0.0) {
            return None;
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let divided = |r: &[f64]| r.iter().zip(&diagonal).map(|(r, d)| r / d).collect::<Vec<f64>>();
        let (mut x, mut r) = (vec![0.0; n], load.to_vec());
        let mut y = divided(&r);
        let mut p = y.clone();
        let (mut rho, first) = (dot(&r, &y), dot(load, &divided(load)));
        for _ in 0..10 * n + 100 {
            if rho <= 1e-24 * first {
                return Some(x);
            }
            let kp = self.times(&p);
            let along = rho / dot(&p, &kp);
            if !along.is_finite() {
                return None;
            }
            for i in 0..n {
                x[i] += along * p[i];
                r[i] -= along * kp[i];
            }
            y = divided(&r);
            let next = dot(&r, &y);
            p.iter_mut().zip(&y).for_each(|(p, y)| *p = y + next / rho * *p);
            rho = next;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use concio::device::{Law, ReCentring};
    use concio::ground::GroundMotion;
    use concio::samples::{Link, lumped};
    use concio::wall::End;

    /// A chain of equal masses and springs, fixed at one end: ω = 2 √(k/m) sin(π/(2 (2n + 1))). Dashpots in proportion to the
    /// springs damp it by ω c/(2 k).
    #[test]
    fn the_first_period_of_a_chain_is_the_closed_form() {
        let (n, k, m, c) = (12, 5.4e7, 3.0, 900.0);
        let link = |i: usize| Link::spring(i, if i == 0 { End::Base } else { End::Block(i - 1) }, k, c);
        let links: Vec<Link> = (0..n).map(link).collect();
        let model = lumped(&vec![m; n], &links, Excitation::of_base(GroundMotion::AtRest, 1.0));
        let angle = std::f64::consts::PI / (2.0 * (2.0 * n as f64 + 1.0));
        let omega = 2.0 * f64::sqrt(k / m) * angle.sin();
        let found = first_mode(&model).expect("the chain is held");
        assert!((found.period * omega / (2.0 * std::f64::consts::PI) - 1.0).abs() < 1e-9, "{found:?}");
        assert!((found.damping * 2.0 * k / (omega * c) - 1.0).abs() < 1e-6, "{found:?}");
        // A device has the stiffness that it has at rest.
        let law = Law::ReCentring(ReCentring { stiffness: k, activation: 1e-3, flag: 0.5 });
        let device = Link::device(0, End::Base, law, 0.0, 0.0);
        let held = lumped(&[m], &[device], Excitation::of_base(GroundMotion::AtRest, 1.0));
        let found = first_mode(&held).expect("the device holds it");
        assert!((found.period / (2.0 * std::f64::consts::PI * f64::sqrt(m / k)) - 1.0).abs() < 1e-9, "{found:?}");
        let loose = lumped(&[m], &[], Excitation::of_base(GroundMotion::AtRest, 1.0));
        assert_eq!(first_mode(&loose), None);
    }
}
