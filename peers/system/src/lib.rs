//! A system that `concio system` printed (docs/system.md), for the programs in Rust that are compared with Concio.
//! Equations (1) to (6) of docs/theory.md; as one system of first order its unknowns are first all displacements [m], then
//! all velocities [m/s].

use std::error::Error;
use std::f64::consts::{FRAC_2_PI, TAU};
use std::fs;

use serde::Deserialize;

/// A system as docs/system.md describes it.
#[derive(Debug, Deserialize)]
pub struct System {
    /// Masses [kg].
    pub mass: Vec<f64>,
    /// The joints.
    pub joints: Vec<Joint>,
    base: Option<Record>,
    top: Option<Top>,
    /// End of the motion [s].
    pub duration: f64,
}

/// A joint.
#[derive(Debug, Deserialize)]
pub struct Joint {
    /// One side.
    pub a: usize,
    /// The other.
    pub b: Side,
    /// Whether the stiffness acts both ways.
    pub law: Law,
    /// k [N/m].
    pub stiffness: f64,
    /// c [N s/m].
    pub damping: f64,
    /// N in the equations of a and b [N].
    pub normal_force: [f64; 2],
    /// (6), if it rubs.
    pub friction: Option<Friction>,
}

/// A side of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Side {
    /// An unknown.
    Block(usize),
    /// A support.
    Support(Support),
}

/// What moves as given.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Support {
    /// At rest.
    Base,
    /// The top beam.
    Top,
}

/// Law of the stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// Both ways.
    Elastic,
    /// For positive relative displacements only.
    NoTension,
}

/// Friction (6).
#[derive(Debug, Clone, Copy, Deserialize)]
pub struct Friction {
    /// μ_s.
    #[serde(rename = "static")]
    pub fixed: f64,
    /// μ_d.
    pub dynamic: f64,
    /// δ_v [m/s].
    pub slip_velocity: f64,
    /// β.
    pub beta: f64,
    /// α [s²/m²].
    pub alpha: f64,
}

#[derive(Debug, Deserialize)]
struct Record {
    dt: f64,
    acceleration: Vec<f64>,
}

#[derive(Debug, Deserialize)]
struct Top {
    sine: Sine,
}

#[derive(Debug, Deserialize)]
struct Sine {
    amplitude: f64,
    frequency: f64,
    ramp: f64,
}

impl Friction {
    /// (6) and its slope [s/m] at a velocity [m/s].
    pub fn at(&self, v: f64) -> (f64, f64) {
        let (speed, steep) = (v.abs(), self.beta / self.slip_velocity);
        let decay = (self.fixed - self.dynamic) * (-speed / self.slip_velocity).exp();
        let (level, z) = (decay + self.dynamic, steep * speed);
        let angle = FRAC_2_PI * z.atan();
        let slope = FRAC_2_PI * steep / (1.0 + z * z) * level - angle * decay / self.slip_velocity;
        ((angle * level + self.alpha * speed * speed).copysign(v), slope + 2.0 * self.alpha * speed)
    }
}

impl System {
    /// Reads what `concio system` printed.
    ///
    /// # Errors
    /// A file that cannot be read or is something else.
    pub fn read(path: &str) -> Result<System, Box<dyn Error>> {
        Ok(serde_json::from_str(&fs::read_to_string(path)?)?)
    }

    /// Where the solver has to stop: at every sample of the record, and at the end.
    pub fn stops(&self) -> Vec<f64> {
        let mut stops = Vec::new();
        if let Some(record) = &self.base {
            let samples = 1..record.acceleration.len();
            stops.extend(samples.map(|k| k as f64 * record.dt).filter(|t| *t < self.duration * (1.0 - 1e-9)));
        }
        stops.push(self.duration);
        stops
    }

    /// Acceleration of the base [m/s²].
    pub fn ground(&self, t: f64) -> f64 {
        let Some(record) = &self.base else { return 0.0 };
        let place = t / record.dt;
        let k = place as usize;
        match (record.acceleration.get(k), record.acceleration.get(k + 1)) {
            (Some(a), Some(b)) => a + (place - k as f64) * (b - a),
            _ => record.acceleration.last().copied().unwrap_or(0.0),
        }
    }

    /// Displacement [m] and velocity [m/s] of the top beam.
    pub fn top(&self, t: f64) -> (f64, f64) {
        let Some(Top { sine }) = &self.top else { return (0.0, 0.0) };
        let omega = TAU * sine.frequency;
        let (factor, rate) = if t < sine.ramp { (t / sine.ramp, 1.0 / sine.ramp) } else { (1.0, 0.0) };
        let (s, c) = (omega * t).sin_cos();
        (sine.amplitude * factor * s, sine.amplitude * (factor * omega * c + rate * s))
    }

    /// Relative displacement and velocity of a joint.
    pub fn relative(&self, joint: &Joint, y: &[f64], top: (f64, f64)) -> (f64, f64) {
        let n = self.mass.len();
        let (z, v) = match joint.b {
            Side::Block(b) => (y[b], y[n + b]),
            Side::Support(Support::Base) => (0.0, 0.0),
            Side::Support(Support::Top) => top,
        };
        (y[joint.a] - z, y[n + joint.a] - v)
    }

    /// ẏ.
    pub fn rates(&self, y: &[f64], t: f64, rate: &mut [f64]) {
        let (n, top) = (self.mass.len(), self.top(t));
        let (first, second) = rate.split_at_mut(n);
        first.copy_from_slice(&y[n..]);
        second.fill(0.0);
        for joint in &self.joints {
            let (d, w) = self.relative(joint, y, top);
            let mu = joint.friction.map_or(0.0, |f| f.at(w).0);
            let smooth = joint.tangent(d) * d + joint.damping * w;
            second[joint.a] -= smooth + joint.normal_force[0] * mu;
            if let Side::Block(b) = joint.b {
                second[b] += smooth + joint.normal_force[1] * mu;
            }
        }
        let ground = self.ground(t);
        for (rate, mass) in second.iter_mut().zip(&self.mass) {
            *rate = *rate / mass - ground;
        }
    }

    /// (∂ẏ/∂y) v.
    pub fn jacobian_times(&self, y: &[f64], t: f64, v: &[f64], product: &mut [f64]) {
        let (n, top) = (self.mass.len(), self.top(t));
        let (first, second) = product.split_at_mut(n);
        first.copy_from_slice(&v[n..]);
        second.fill(0.0);
        for joint in &self.joints {
            let (d, w) = self.relative(joint, y, top);
            let (dz, dv) = self.relative(joint, v, (0.0, 0.0));
            let slope = joint.friction.map_or(0.0, |f| f.at(w).1);
            let smooth = joint.tangent(d) * dz + joint.damping * dv;
            second[joint.a] -= smooth + joint.normal_force[0] * slope * dv;
            if let Side::Block(b) = joint.b {
                second[b] += smooth + joint.normal_force[1] * slope * dv;
            }
        }
        for (product, mass) in second.iter_mut().zip(&self.mass) {
            *product /= mass;
        }
    }

    /// Force of the top beam on the wall [N], and its velocity [m/s].
    pub fn top_force(&self, y: &[f64], t: f64) -> (f64, f64) {
        let top = self.top(t);
        let on = |joint: &&Joint| joint.b == Side::Support(Support::Top);
        let force = |joint: &Joint| {
            let (d, w) = self.relative(joint, y, top);
            let mu = joint.friction.map_or(0.0, |f| f.at(w).0);
            joint.stiffness * d + joint.damping * w + joint.normal_force[0] * mu
        };
        (-self.joints.iter().filter(on).map(force).sum::<f64>(), top.1)
    }
}

impl Joint {
    /// Stiffness [N/m] at a relative displacement [m].
    pub fn tangent(&self, d: f64) -> f64 {
        if self.law == Law::NoTension && d <= 0.0 { 0.0 } else { self.stiffness }
    }
}
