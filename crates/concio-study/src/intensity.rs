//! How strong a motion of the base is: PGA, PGV, spectral acceleration.
//!
//! All are of the part of the motion that the run goes through, and proportional to its scale.

use std::path::Path;

use concio::case::{Case, Signal};
use concio::ground::process::load;
use concio::ground::signal::compile;
use concio::ground::{measures, response_spectrum, synthetic};
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
        let (dt, acceleration) = samples(case)?;
        let most = |values: &[f64]| measures::peak(dt, values).value.abs();
        let value = match self {
            Intensity::Pga | Intensity::Scale => most(&acceleration),
            Intensity::Pgv => most(&velocities(case, dt, acceleration.len())?),
            Intensity::Sa => response_spectrum(dt, &acceleration, DAMPING, &[period]).psa[0],
        };
        if value > 0.0 && value.is_finite() {
            return Ok(value);
        }
        let error = InputError::new(format!("the motion has a {} of {value}", self.name())).key("motion.base");
        Err(error.allowed("a motion that shakes").into())
    }
}

/// Velocities of the base [m/s] at `number` instants `dt` apart, exact at each.
fn velocities(case: &Case, dt: f64, number: usize) -> Result<Vec<f64>> {
    let motion = compile(&case.motion.base, Path::new(""))?;
    Ok((0..number).map(|k| motion.at(k as f64 * dt).v).collect())
}

/// Sample interval [s] and accelerations [m/s²] of the base, up to the end of the run.
pub fn samples(case: &Case) -> Result<(f64, Vec<f64>)> {
    let here = Path::new("");
    let record = match &case.motion.base {
        Signal::Record(input) => Some(load(input, here)?),
        Signal::Synthetic(input) => Some(synthetic::generate(input)?),
        _ => None,
    };
    let duration = case.motion.duration.map(|d| d.si());
    if let Some(mut record) = record {
        if let Some(duration) = duration {
            record.acceleration.truncate((duration / record.dt * (1.0 + 1e-9)) as usize + 1);
        }
        return Ok((record.dt, record.acceleration));
    }
    let motion = compile(&case.motion.base, here)?;
    let missing = || -> Error {
        InputError::new("is needed: the motion has no end of its own")
            .key("motion.duration")
            .allowed("above 0 s")
            .into()
    };
    let duration = duration.or_else(|| motion.end().filter(|end| *end > 0.0)).ok_or_else(missing)?;
    // A rectangle has no useful step: its length counts then.
    let whole = motion.end().filter(|end| *end > 0.0).unwrap_or(duration).min(duration) / LEAST_SAMPLES;
    let fine = (motion.longest_useful_step() / SAMPLES_PER_STEP).min(whole);
    // Less a little: a whole number of periods is one, whatever rounding makes of it.
    let number = (duration / fine - 1e-6).ceil().clamp(1.0, MOST_SAMPLES);
    let dt = duration / number;
    Ok((dt, (0..=number as usize).map(|k| motion.acceleration(k as f64 * dt)).collect()))
}
