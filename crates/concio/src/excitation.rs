//! The motion of base and top beam as the equations see it: in coordinates relative to the base (theory, section 2).

pub use concio_law::motion::Drive;
use concio_law::motion::Excitation as Motion;
use serde_json::{Value, json};

use crate::case::{Beam, Sine};
use crate::error::{InputError, Result};
use crate::ground::signal::{GroundMotion, Segment};

/// Samples per period when a closed form is printed for another solver.
const PRINTED_PER_PERIOD: f64 = 100.0;

/// Samples that are printed at most.
const MOST_PRINTED: f64 = 1e7;

/// What moves the wall, and for how long.
#[derive(Debug, Clone, PartialEq)]
pub struct Excitation {
    /// U0.
    pub base: GroundMotion,
    /// U1; at rest unless the beam is driven.
    pub top: GroundMotion,
    /// V0, positive upwards; at rest in shear walls.
    pub vertical: GroundMotion,
    /// Whether U1 is prescribed; otherwise the top follows the base (tied) or is no support at all.
    pub driven: bool,
    /// The top's sine as the wall file gives it, for [`Excitation::system_motions`].
    pub top_sine: Option<Sine>,
    /// End of the run [s].
    pub duration: f64,
}

impl Excitation {
    /// A motion of the base alone.
    pub fn of_base(base: GroundMotion, duration: f64) -> Self {
        let (top, vertical) = (GroundMotion::AtRest, GroundMotion::AtRest);
        Excitation { base, top, vertical, driven: false, top_sine: None, duration }
    }
    /// A driven top above a base at rest.
    pub fn of_top(top: GroundMotion, duration: f64) -> Self {
        let (base, vertical) = (GroundMotion::AtRest, GroundMotion::AtRest);
        Excitation { base, top, vertical, driven: true, top_sine: None, duration }
    }

    /// Motions of base and top as `concio system` prints them. What is not a record is sampled, 100 points a period.
    ///
    /// # Errors
    /// A driven top that is not a displacement sine, or stands on a moving base; a base motion with jumps: the format
    /// cannot say it.
    pub fn system_motions(&self, beam: Beam) -> Result<(Value, Value)> {
        let refuse = |what: &str| {
            InputError::new(format!("`concio system` cannot print {what}"))
                .key("motion")
                .allowed("a base motion without jumps, or a driven top with a displacement sine above a base at rest")
        };
        let base = match &self.base {
            GroundMotion::AtRest => Value::Null,
            moving if jumps(moving, self.duration) => {
                return Err(refuse("a base motion whose acceleration or velocity jumps").into());
            }
            moving => sampled(moving, self.duration).ok_or_else(|| refuse("a base motion of so many samples"))?,
        };
        if beam != Beam::Driven {
            return Ok((base, Value::Null));
        }
        if base != Value::Null {
            return Err(refuse("a driven top above a moving base").into());
        }
        match self.top_sine {
            Some(Sine { amplitude: Some(amplitude), frequency, ramp, cycles: None, .. }) => {
                let sine = json!({"amplitude": amplitude.si(), "frequency": frequency.si(), "ramp": ramp.si()});
                Ok((base, json!({ "sine": sine })))
            }
            _ => Err(refuse("this motion of the top").into()),
        }
    }
}

impl Motion for Excitation {
    fn drive(&self, t: f64) -> Drive {
        let base = piece(&self.base, t);
        let top = self.driven.then(|| piece(&self.top, t));
        let vertical = piece(&self.vertical, t);
        let end = base.end.min(top.map_or(f64::INFINITY, |s| s.end)).min(vertical.end).min(self.duration);
        Drive { base, top, vertical, end }
    }
    fn longest_step(&self) -> f64 {
        let top = if self.driven { self.top.longest_useful_step() } else { f64::INFINITY };
        self.base.longest_useful_step().min(self.vertical.longest_useful_step()).min(top)
    }
    fn base_velocity_jump(&self, t: f64) -> f64 {
        self.base.velocity_jump(t)
    }
    fn duration(&self) -> f64 {
        self.duration
    }
}

/// The piece just after `t`; one that ends within rounding of `t` counts as ended, so that breaks of base and top that
/// are meant to coincide do.
fn piece(motion: &GroundMotion, t: f64) -> Segment {
    let segment = motion.segment(t);
    if segment.end - t <= 1e-12 * t.abs().max(1e-3) { motion.segment(segment.end) } else { segment }
}

/// Whether acceleration or velocity jump at a break of the motion.
fn jumps(motion: &GroundMotion, duration: f64) -> bool {
    let mut t = 0.0;
    while t < duration {
        let before = motion.segment(t);
        if motion.velocity_jump(t) != 0.0 {
            return true;
        }
        if before.end < duration {
            let (left, right) = (before.acceleration(before.end), motion.acceleration(before.end));
            // Near a zero crossing rounding is measured by the piece's other end, not by the small values that meet.
            let size = left.abs().max(right.abs()).max(before.acceleration(t).abs());
            if (left - right).abs() > 1e-9 * size {
                return true;
            }
        }
        t = before.end;
    }
    motion.acceleration(0.0) != 0.0 && motion.sample_interval().is_none()
}

fn sampled(motion: &GroundMotion, duration: f64) -> Option<Value> {
    let step = motion.longest_useful_step();
    let dt = motion.sample_interval().unwrap_or_else(|| (step * 20.0 / PRINTED_PER_PERIOD).min(duration / 1000.0));
    let count = (duration / dt).ceil() + 1.0;
    if !(count <= MOST_PRINTED) {
        return None;
    }
    // The last sample of a record is its own, not the rest after it.
    let last = motion.sample_interval().and(motion.end()).map_or(f64::INFINITY, |end| (end / dt).round());
    let at = |k: usize| {
        let (k, t) = (k as f64, k as f64 * dt);
        if k == last { motion.segment((k - 0.5) * dt).at(t).a } else { motion.acceleration(t) }
    };
    let acceleration: Vec<f64> = (0..=count as usize).map(at).collect();
    Some(json!({"dt": dt, "acceleration": acceleration}))
}
