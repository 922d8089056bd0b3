//! The motion of base and top beam in coordinates relative to the base.

/// A motion (stand-in until the ground module lands).
#[derive(Debug, Clone, PartialEq)]
pub enum GroundMotion {
    /// None.
    AtRest,
    /// Piecewise-linear acceleration.
    Samples {
        /// interval
        dt: f64,
        /// values
        acceleration: Vec<f64>,
    },
    /// Displacement sine.
    Sine {
        /// m
        amplitude: f64,
        /// Hz
        frequency: f64,
        /// s
        ramp: f64,
    },
}

impl GroundMotion {
    fn acceleration(&self, t: f64) -> f64 {
        match self {
            GroundMotion::Samples { dt, acceleration } => {
                let s = t / dt;
                let i = s as usize;
                if i + 1 >= acceleration.len() {
                    return *acceleration.last().unwrap_or(&0.0);
                }
                acceleration[i] * (1.0 - (s - i as f64)) + acceleration[i + 1] * (s - i as f64)
            }
            _ => 0.0,
        }
    }
    fn motion(&self, t: f64) -> (f64, f64) {
        match *self {
            GroundMotion::Sine { amplitude, frequency, ramp } => {
                let w = 2.0 * std::f64::consts::PI * frequency;
                let (r, dr) = if ramp > 0.0 && t < ramp { (t / ramp, 1.0 / ramp) } else { (1.0, 0.0) };
                let (s, c) = (w * t).sin_cos();
                (amplitude * s * r, amplitude * (w * c * r + s * dr))
            }
            _ => (0.0, 0.0),
        }
    }
    fn next_break(&self, t: f64) -> f64 {
        match self {
            GroundMotion::Samples { dt, .. } => ((t / dt * (1.0 + 1e-12) + 1e-9).floor() + 1.0) * dt,
            GroundMotion::Sine { ramp, .. } if t < *ramp => *ramp,
            _ => f64::INFINITY,
        }
    }
}

/// What moves the wall, and for how long.
#[derive(Debug, Clone, PartialEq)]
pub struct Excitation {
    /// U0.
    pub base: GroundMotion,
    /// U1 of a driven beam.
    pub top: GroundMotion,
    /// End of the run [s].
    pub duration: f64,
}

impl Excitation {
    /// Base acceleration at t [m/s²].
    pub fn base_acceleration(&self, t: f64, _from: f64) -> f64 {
        self.base.acceleration(t)
    }
    /// Displacement and velocity of the top relative to the base.
    pub fn top_relative(&self, t: f64, _from: f64) -> (f64, f64) {
        self.top.motion(t)
    }
    /// Motions as `concio system` prints them.
    pub fn system_motions(&self) -> crate::error::Result<(serde_json::Value, serde_json::Value)> {
        Ok((serde_json::Value::Null, serde_json::Value::Null))
    }
    /// Absolute displacement and acceleration of the base.
    pub fn base_motion(&self, t: f64) -> (f64, f64) {
        (self.base.motion(t).0, self.base.acceleration(t))
    }
    /// Longest step.
    pub fn longest_step(&self) -> f64 {
        match &self.top {
            GroundMotion::Sine { frequency, .. } => 0.05 / frequency,
            _ => f64::INFINITY,
        }
    }
    /// Whether the acceleration or velocity jumps at t.
    pub fn jumps_at(&self, _t: f64) -> bool {
        false
    }
    /// Next kink.
    pub fn next_break(&self, t: f64) -> f64 {
        self.base.next_break(t).min(self.top.next_break(t)).min(self.duration)
    }
}
