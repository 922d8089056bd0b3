//! How strong a motion of the base is: PGA, PGV, spectral acceleration.
//!
//! All are of the part of the motion that the run goes through, and proportional to its scale.

use std::path::Path;

use concio::case::Case;
use concio::ground::signal::{GroundMotion, compile};
use concio::ground::{measures, response_spectrum};
use concio::quantity::shown;
use concio::{Error, InputError, Result};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Damping ratio of the spectral acceleration.
pub const DAMPING: f64 = 0.05;
/// Samples of a motion in closed form over its longest useful step, a twentieth of a period, and at most in all: peaks are
/// met to 5e-6.
const SAMPLES_PER_STEP: f64 = 50.0;
const MOST_SAMPLES: f64 = 2e6;
/// Samples from the start to the end of a motion in closed form, at least.
const LEAST_SAMPLES: f64 = 2000.0;

/// Intensity measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Intensity {
    /// Peak ground acceleration [m/s²].
    #[default]
    Pga,
    /// Peak ground velocity [m/s].
    Pgv,
    /// Pseudo-spectral acceleration at a period, 5 % damping [m/s²].
    Sa,
    /// The factor on the motion itself.
    Scale,
}

impl Intensity {
    /// SI unit; empty for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            Intensity::Pga | Intensity::Sa => "m/s²",
            Intensity::Pgv => "m/s",
            Intensity::Scale => "",
        }
    }

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Intensity::Pga => "PGA",
            Intensity::Pgv => "PGV",
            Intensity::Sa => "Sa",
            Intensity::Scale => "scale",
        }
    }

    /// Of the base motion of a case as it stands; `period` [s] is that of `Sa`. Record paths start from the working
    /// directory.
    ///
    /// # Errors
    /// A record that cannot be read; a motion that is none.
    pub fn of(self, case: &Case, period: f64) -> Result<f64> {
        if self == Intensity::Scale {
            return Ok(1.0);
        }
        let base = Sampled::of_case(case)?;
        let value = match self {
            Intensity::Pga | Intensity::Scale => base.pga(),
            Intensity::Pgv => base.pgv(),
            Intensity::Sa => base.psa(DAMPING, &[period])[0],
        };
        if value > 0.0 && value.is_finite() {
            return Ok(value);
        }
        let error = InputError::new(format!("the motion has a {} of {}", self.name(), shown(value))).key("motion.base");
        Err(error.allowed("a motion that shakes").into())
    }
}

/// The motion of a base over a run, at equal intervals from its start: records at their samples, closed forms at a
/// thousandth of their period.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// Interval [s].
    pub dt: f64,
    /// Accelerations [m/s²], linear in between.
    pub acceleration: Vec<f64>,
    /// Velocities [m/s].
    pub velocity: Vec<f64>,
}

impl Sampled {
    /// Over a run of `duration` [s].
    pub fn of(base: &GroundMotion, duration: f64) -> Self {
        let record = base.sample_interval().map(|dt| (dt, (duration / dt * (1.0 + 1e-9)).floor()));
        let (dt, intervals) = record.unwrap_or_else(|| {
            // A rectangle has no useful step: its length counts then.
            let whole = base.end().filter(|end| *end > 0.0).unwrap_or(duration).min(duration) / LEAST_SAMPLES;
            let fine = (base.longest_useful_step() / SAMPLES_PER_STEP).min(whole);
            // Less a little: a whole number of periods is one, whatever rounding makes of it.
            let number = (duration / fine - 1e-6).ceil().clamp(1.0, MOST_SAMPLES);
            (duration / number, number)
        });
        // What comes after a break is what stands there; but the last sample of a record is its own, not the rest after it.
        let last = record.and(base.end()).map_or(f64::INFINITY, |end| (end / dt).round());
        let at = |k: usize| {
            let (k, t) = (k as f64, k as f64 * dt);
            if k == last { base.segment((k - 0.5) * dt).at(t) } else { base.at(t) }
        };
        let motion = (0..=intervals as usize).map(at);
        let (acceleration, velocity) = motion.map(|m| (m.a, m.v)).unzip();
        Sampled { dt, acceleration, velocity }
    }

    /// Over the run of a case. Record paths start from the working directory.
    ///
    /// # Errors
    /// A record that cannot be read; a motion without end in a run without duration.
    pub fn of_case(case: &Case) -> Result<Self> {
        let motion = compile(&case.motion.base, Path::new(""))?;
        let duration = case.motion.duration.map(|d| d.si());
        let duration = duration.or_else(|| motion.end().filter(|end| *end > 0.0)).ok_or_else(|| -> Error {
            let error = InputError::new("is needed: the motion has no end of its own").key("motion.duration");
            error.allowed("above 0 s").into()
        })?;
        Ok(Self::of(&motion, duration))
    }

    /// Largest |acceleration| [m/s²].
    pub fn pga(&self) -> f64 {
        measures::peak(self.dt, &self.acceleration).value.abs()
    }

    /// Largest |velocity| [m/s].
    pub fn pgv(&self) -> f64 {
        measures::peak(self.dt, &self.velocity).value.abs()
    }

    /// Pseudo-accelerations at `periods` [s] with a damping ratio [m/s²].
    pub fn psa(&self, damping: f64, periods: &[f64]) -> Vec<f64> {
        response_spectrum(self.dt, &self.acceleration, damping, periods).psa
    }
}
