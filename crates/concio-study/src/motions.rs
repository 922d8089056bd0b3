//! Motions of a study: records and synthetic ones under a name, and any of them scaled.

use std::path::Path;

use concio::case::{Motion, Signal};
use concio::quantity::{Acceleration, Length, Velocity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A motion of the base.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionInput {
    /// Its name in tables and figures, unique.
    pub name: String,
    /// The motion, as `motion.base` of a wall file; record files are relative to the study file.
    pub base: Signal,
    /// Vertical motion of the base, as `motion.vertical`: of the same record. Planar walls alone; default that of the wall file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vertical: Option<Signal>,
    /// Length of the run [s], above 0; default that of the wall file if it gives one, or of the record.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration: Option<concio::quantity::Time>,
    /// With `interfaces`: kept out of the search, to see afterwards whether what it found helps in motions that it did
    /// not know. Default false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub held_out: bool,
}

/// The motion `factor` times as strong.
pub fn scaled(signal: &Signal, factor: f64) -> Signal {
    let acceleration = |a: Acceleration| Acceleration::from_si(a.si() * factor);
    let mut scaled = signal.clone();
    match &mut scaled {
        Signal::None => {}
        Signal::Record(record) => match record.pga {
            Some(pga) => record.pga = Some(acceleration(pga)),
            None => record.scale = Some(record.scale.unwrap_or(1.0) * factor),
        },
        Signal::Sine(sine) => {
            sine.amplitude = sine.amplitude.map(|a| Length::from_si(a.si() * factor));
            sine.acceleration = sine.acceleration.map(acceleration);
        }
        Signal::Ramp(ramp) => ramp.amplitude = Length::from_si(ramp.amplitude.si() * factor),
        Signal::Tilt(tilt) => tilt.acceleration = acceleration(tilt.acceleration),
        Signal::Path(path) => {
            path.displacements.iter_mut().for_each(|u| *u = Length::from_si(u.si() * factor));
            // Its corners stay where they are in time.
            path.speed = Velocity::from_si(path.speed.si() * factor.abs());
        }
        Signal::Pulse(pulse) => pulse.acceleration = acceleration(pulse.acceleration),
        Signal::Sweep(sweep) => sweep.acceleration = acceleration(sweep.acceleration),
        Signal::Synthetic(synthetic) => synthetic.pga = acceleration(synthetic.pga),
    }
    scaled
}

/// Makes what shakes the base `factor` times as strong: its horizontal motion, and the vertical one with it.
pub fn strengthen(motion: &mut Motion, factor: f64) {
    motion.base = scaled(&motion.base, factor);
    motion.vertical = scaled(&motion.vertical, factor);
}

/// The motion with its record file relative to the working directory instead of to `folder`.
pub fn rooted(signal: &Signal, folder: &Path) -> Signal {
    let mut rooted = signal.clone();
    if let Signal::Record(record) = &mut rooted {
        record.record = folder.join(&record.record);
    }
    rooted
}
