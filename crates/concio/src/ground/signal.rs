//! The motion that the time integration follows, compiled from the wall file's signal.
//!
//! A motion is a row of smooth pieces ([`Segment`]). The integrator asks for the piece that is active just after an
//! instant, steps within it up to its end and so never meets a jump inside a step:
//!
//! ```text
//! let segment = motion.segment(t);        // active on [segment.start, segment.end]
//! … segment.at(t + h) …                   // any h with t + h ≤ segment.end
//! ```
//!
//! Conventions. Before t = 0 the motion is at rest. A record's acceleration is linear between samples, its velocity
//! and displacement are the exact integrals; after the last sample the acceleration is zero and the velocity stays.
//! A displacement history is followed by its natural cubic spline: the offset of the first sample is kept, the
//! velocity starts with the spline's slope, and after the last sample the velocity stays. Signals given as an
//! acceleration are integrated from rest; when they end, the acceleration is zero and the velocity stays; that of a tilt
//! never ends. A sine, ramp or path given as a displacement stands still where it ends. A swept sine is sampled at 100 points per cycle of its
//! highest frequency, which is within 5e-4 of its amplitude, and followed as a record.

use std::f64::consts::PI;
use std::path::Path;

use crate::case;
use crate::ground::library::Library;
use crate::ground::process::integrate;
use crate::ground::record::{Format, Record};
use crate::ground::spline;
use crate::quantity::shown;
use crate::{InputError, Result};
use concio_law::motion::{Component, Form, Pieces};
pub use concio_law::motion::{Kinematics, Segment};

/// Longest step of a sine, as a fraction of its period.
const STEP_PER_PERIOD: f64 = 1.0 / 20.0;
/// Samples of a swept sine per cycle of its highest frequency, and at most in all.
const SWEEP_SAMPLES: f64 = 100.0;
const MOST_SWEEP_SAMPLES: f64 = 1e7;
/// Instants closer to a sample than this fraction of the interval are that sample.
const SLACK: f64 = 1e-9;

/// A motion of base or top, ready to be followed.
#[derive(Debug, Clone, PartialEq)]
pub enum GroundMotion {
    /// At rest at zero.
    AtRest,
    /// Acceleration that is linear between samples.
    Samples(Samples),
    /// Pieces in closed form.
    Pieces(Pieces),
}

/// Motion at equidistant samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    dt: f64,
    motion: Vec<Kinematics>,
    /// Whether displacements were given, not accelerations.
    displaced: bool,
}

impl GroundMotion {
    /// An acceleration [m/s²] at samples from t = 0, `dt` [s] apart, linear in between; from rest, and no acceleration after the last.
    ///
    /// # Errors
    /// An interval that is not above 0, fewer than two samples, a sample that is no number.
    pub fn sampled(dt: f64, acceleration: &[f64]) -> Result<Self> {
        let dt = positive("dt", dt, "s")?;
        if acceleration.len() < 2 {
            return Err(InputError::new(format!("{} samples", acceleration.len())).allowed("2 or more").into());
        }
        acceleration.iter().try_for_each(|a| finite("acceleration", *a).map(|_| ()))?;
        let (velocity, displacement) = integrate(dt, acceleration, 0.0, 0.0);
        let rows = displacement.into_iter().zip(velocity).zip(acceleration);
        let motion = rows.map(|((u, v), &a)| Kinematics { u, v, a }).collect();
        Ok(GroundMotion::Samples(Samples { dt, motion, displaced: false }))
    }

    /// The piece that is active just after `t`. An instant that is a break but for rounding counts as the break.
    #[inline]
    pub fn segment(&self, t: f64) -> Segment {
        match self {
            GroundMotion::AtRest => Segment { start: f64::NEG_INFINITY, end: f64::INFINITY, form: Form::rest(0.0) },
            GroundMotion::Samples(samples) => samples.segment(t),
            GroundMotion::Pieces(pieces) => pieces.segment(t),
        }
    }

    /// Displacement, velocity and acceleration at `t`; at a break those just after it.
    #[inline]
    pub fn at(&self, t: f64) -> Kinematics {
        self.segment(t).at(t)
    }

    /// Acceleration at `t` [m/s²]; at a break the one just after it.
    #[inline]
    pub fn acceleration(&self, t: f64) -> f64 {
        self.segment(t).acceleration(t)
    }

    /// The next instant after `t` at which the motion is not smooth: a record sample, the start or end of a pulse or
    /// ramp. +∞ when there is none.
    #[inline]
    pub fn next_break(&self, t: f64) -> f64 {
        self.segment(t).end
    }

    /// By how much the velocity jumps at a break [m/s]; 0 elsewhere. Only motions given as displacements do: a sine
    /// without ramp at t = 0, a ramp at both ends, a path at its corners, a displacement history at t = 0.
    pub fn velocity_jump(&self, t: f64) -> f64 {
        let after = self.segment(t);
        let slack = match self {
            GroundMotion::AtRest => return 0.0,
            GroundMotion::Samples(samples) => SLACK * samples.dt,
            GroundMotion::Pieces(pieces) => pieces.slack(),
        };
        let is_break = (t - after.start).abs() <= 2.0 * slack;
        // Samples are joined smoothly: what differs there is rounding, and near a zero crossing not even small beside
        // the velocity.
        let is_joined = matches!(self, GroundMotion::Samples(_)) && after.start > 0.0;
        if !is_break || is_joined {
            return 0.0;
        }
        let before = self.segment(after.start - 1e3 * slack);
        let jump = after.at(after.start).v - before.at(after.start).v;
        // Pieces that are joined smoothly differ by rounding alone.
        if jump.abs() <= 1e-12 * after.at(after.start).v.abs() { 0.0 } else { jump }
    }

    /// Sample interval of a record [s].
    pub fn sample_interval(&self) -> Option<f64> {
        match self {
            GroundMotion::Samples(samples) => Some(samples.dt),
            _ => None,
        }
    }

    /// Number of samples of a record; 0 for motions in closed form.
    pub fn samples(&self) -> usize {
        if let GroundMotion::Samples(samples) = self { samples.motion.len() } else { 0 }
    }

    /// When the acceleration ends for good [s]; none for a sine that goes on.
    pub fn end(&self) -> Option<f64> {
        match self {
            GroundMotion::AtRest => Some(0.0),
            GroundMotion::Samples(samples) => Some(samples.motion.len().saturating_sub(1) as f64 * samples.dt),
            GroundMotion::Pieces(pieces) => pieces.end,
        }
    }

    /// Longest step that resolves the motion [s]: a sample interval, a twentieth of a period; +∞ at rest.
    pub fn longest_useful_step(&self) -> f64 {
        match self {
            GroundMotion::AtRest => f64::INFINITY,
            GroundMotion::Samples(samples) => samples.dt,
            GroundMotion::Pieces(pieces) => pieces.longest_step,
        }
    }
}

impl Component for GroundMotion {
    fn segment(&self, t: f64) -> Segment {
        GroundMotion::segment(self, t)
    }
    fn velocity_jump(&self, t: f64) -> f64 {
        GroundMotion::velocity_jump(self, t)
    }
    fn longest_step(&self) -> f64 {
        self.longest_useful_step()
    }
    fn end(&self) -> Option<f64> {
        GroundMotion::end(self)
    }
}

impl Samples {
    /// A record of them, which no file gives.
    pub fn record(&self) -> Record {
        Record {
            format: Format::Text,
            dt: self.dt,
            acceleration: self.motion.iter().map(|m| m.a).collect(),
            displacement: self.displaced.then(|| self.motion.iter().map(|m| m.u).collect()),
            units: String::new(),
            station: String::new(),
            event: String::new(),
            channel: String::new(),
            remarks: Vec::new(),
        }
    }

    #[inline]
    fn segment(&self, t: f64) -> Segment {
        let place = t / self.dt + SLACK;
        if place < 0.0 {
            let form = Form::rest(self.motion.first().map_or(0.0, |first| first.u));
            return Segment { start: f64::NEG_INFINITY, end: 0.0, form };
        }
        let k = place as usize;
        // Interval k runs between two samples; at and after the last one the acceleration is zero.
        let (now, jerk, end) = match (self.motion.get(k), self.motion.get(k.saturating_add(1))) {
            (Some(now), Some(next)) => (*now, (next.a - now.a) / self.dt, (k + 1) as f64 * self.dt),
            _ => {
                let last = self.motion.last().copied().unwrap_or_default();
                return self.after(last);
            }
        };
        let origin = k as f64 * self.dt;
        Segment { start: origin, end, form: Form::Cubic { origin, u: now.u, v: now.v, a: now.a, jerk } }
    }

    fn after(&self, last: Kinematics) -> Segment {
        let origin = self.motion.len().saturating_sub(1) as f64 * self.dt;
        let form = Form::Cubic { origin, u: last.u, v: last.v, a: 0.0, jerk: 0.0 };
        Segment { start: origin, end: f64::INFINITY, form }
    }
}

/// Compiles a signal; record paths are relative to `base`, the folder of the wall file.
///
/// # Errors
/// [`crate::Error::Input`] when a record cannot be read, or a number is out of its range.
pub fn compile(signal: &case::Signal, base: &Path) -> Result<GroundMotion> {
    compile_with(signal, base, &Library::default())
}

/// [`compile`], records taken from `library`.
///
/// # Errors
/// As [`compile`].
pub fn compile_with(signal: &case::Signal, base: &Path, library: &Library) -> Result<GroundMotion> {
    Ok(match signal {
        case::Signal::None => GroundMotion::AtRest,
        case::Signal::Record(input) => from_record(&library.record(input, base)?),
        case::Signal::Sine(sine) => GroundMotion::Pieces(compile_sine(sine)?),
        case::Signal::Ramp(ramp) => GroundMotion::Pieces(compile_ramp(ramp)?),
        case::Signal::Tilt(tilt) => GroundMotion::Pieces(compile_tilt(tilt)?),
        case::Signal::Path(path) => GroundMotion::Pieces(compile_path(path)?),
        case::Signal::Pulse(pulse) => GroundMotion::Pieces(compile_pulse(pulse)?),
        case::Signal::Sweep(sweep) => compile_sweep(sweep)?,
        case::Signal::Synthetic(synthetic) => from_record(&library.synthetic(synthetic)?),
    })
}

/// The motion of a record.
pub fn from_record(record: &Record) -> GroundMotion {
    let (velocity, displacement) = match &record.displacement {
        None => integrate(record.dt, &record.acceleration, 0.0, 0.0),
        Some(u) => (spline::first_derivatives(record.dt, u, &record.acceleration), u.clone()),
    };
    let rows = displacement.into_iter().zip(velocity).zip(&record.acceleration);
    let motion = rows.map(|((u, v), &a)| Kinematics { u, v, a }).collect();
    GroundMotion::Samples(Samples { dt: record.dt, motion, displaced: record.displacement.is_some() })
}

fn compile_sine(sine: &case::Sine) -> Result<Pieces> {
    let frequency = positive("sine.frequency", sine.frequency.si(), "Hz")?;
    let ramp = not_negative("sine.ramp", sine.ramp.si(), "s")?;
    let end = match sine.cycles {
        Some(cycles) => positive("sine.cycles", cycles, "")? / frequency,
        None => f64::INFINITY,
    };
    let omega = 2.0 * PI * frequency;
    let mut pieces = Pieces::new(STEP_PER_PERIOD / frequency);
    match (sine.amplitude, sine.acceleration) {
        (Some(amplitude), None) => {
            let amplitude = finite("sine.amplitude", amplitude.si())?;
            let wave = |sine| Form::Wave { origin: 0.0, omega, line: [0.0; 2], sine, cosine: [0.0; 2] };
            if ramp > 0.0 {
                pieces.displacement(0.0, wave([0.0, amplitude / ramp]));
            }
            if ramp < end {
                pieces.displacement(ramp, wave([amplitude, 0.0]));
            }
            if end.is_finite() {
                pieces.hold(end);
            }
        }
        (None, Some(acceleration)) => {
            let peak = finite("sine.acceleration", acceleration.si())?;
            if ramp > 0.0 {
                pieces.acceleration(0.0, Form::sine_acceleration(0.0, omega, 0.0, peak / ramp));
            }
            if ramp < end {
                pieces.acceleration(ramp, Form::sine_acceleration(0.0, omega, peak, 0.0));
            }
            if end.is_finite() {
                pieces.coast(end);
            }
        }
        _ => {
            let error = InputError::new("give either `amplitude` (displacement) or `acceleration`").key("sine");
            return Err(error.allowed("one of the two").into());
        }
    }
    Ok(pieces)
}

fn compile_ramp(ramp: &case::Ramp) -> Result<Pieces> {
    let amplitude = finite("ramp.amplitude", ramp.amplitude.si())?;
    let start = not_negative("ramp.start", ramp.start.si(), "s")?;
    let rise = positive("ramp.rise", ramp.rise.si(), "s")?;
    let mut pieces = Pieces::new(f64::INFINITY);
    pieces.displacement(start, Form::Cubic { origin: start, u: 0.0, v: amplitude / rise, a: 0.0, jerk: 0.0 });
    pieces.hold(start + rise);
    Ok(pieces)
}

fn compile_tilt(tilt: &case::Tilt) -> Result<Pieces> {
    let reached = finite("tilt.acceleration", tilt.acceleration.si())?;
    let start = not_negative("tilt.start", tilt.start.si(), "s")?;
    let rise = positive("tilt.rise", tilt.rise.si(), "s")?;
    let mut pieces = Pieces::new(f64::INFINITY);
    let growing = Form::Cubic { origin: start, u: 0.0, v: 0.0, a: 0.0, jerk: reached / rise };
    let steady = Form::Cubic { origin: start + rise, u: 0.0, v: 0.0, a: reached, jerk: 0.0 };
    pieces.acceleration(start, growing).acceleration(start + rise, steady);
    Ok(pieces)
}

fn compile_path(path: &case::DisplacementPath) -> Result<Pieces> {
    let speed = positive("path.speed", path.speed.si(), "m/s")?;
    let mut pieces = Pieces::new(f64::INFINITY);
    let (mut time, mut place) = (0.0, 0.0);
    for target in &path.displacements {
        let target = finite("path.displacements", target.si())?;
        let way: f64 = target - place;
        if way == 0.0 {
            let error = InputError::new("a displacement is that which comes before it").key("path.displacements");
            return Err(error.allowed("each other than the one before it, the first other than 0").into());
        }
        let v = speed.copysign(way);
        pieces.displacement(time, Form::Cubic { origin: time, u: place, v, a: 0.0, jerk: 0.0 });
        time += way.abs() / speed;
        place = target;
    }
    pieces.rest(time, place);
    Ok(pieces)
}

fn compile_pulse(pulse: &case::Pulse) -> Result<Pieces> {
    let peak = finite("pulse.acceleration", pulse.acceleration.si())?;
    let length = positive("pulse.duration", pulse.duration.si(), "s")?;
    let start = not_negative("pulse.start", pulse.start.si(), "s")?;
    // The Ricker wavelet is cut 1.5 durations beside its peak, where it is below 1e-8 of it.
    let (form, span, period) = match pulse.shape {
        case::PulseShape::Rectangular => {
            (Form::Cubic { origin: start, u: 0.0, v: 0.0, a: peak, jerk: 0.0 }, length, f64::INFINITY)
        }
        case::PulseShape::HalfSine => (Form::sine_acceleration(start, PI / length, peak, 0.0), length, 2.0 * length),
        case::PulseShape::OneSine => (Form::sine_acceleration(start, 2.0 * PI / length, peak, 0.0), length, length),
        case::PulseShape::Ricker => {
            let b = (PI / length) * (PI / length);
            (Form::Ricker { origin: start + 1.5 * length, line: [0.0; 2], peak, b }, 3.0 * length, length)
        }
    };
    let mut pieces = Pieces::new(STEP_PER_PERIOD * period);
    pieces.acceleration(start, form).coast(start + span);
    Ok(pieces)
}

fn compile_sweep(sweep: &case::Sweep) -> Result<GroundMotion> {
    let peak = finite("sweep.acceleration", sweep.acceleration.si())?;
    let length = positive("sweep.duration", sweep.duration.si(), "s")?;
    let from = positive("sweep.frequency[0]", sweep.frequency[0].si(), "Hz")?;
    let to = positive("sweep.frequency[1]", sweep.frequency[1].si(), "Hz")?;
    let intervals = (SWEEP_SAMPLES * from.max(to) * length).ceil().max(1.0);
    if intervals > MOST_SWEEP_SAMPLES {
        let error = InputError::new(format!("{intervals:e} samples of the swept sine")).key("sweep.duration");
        return Err(error
            .allowed(format!("highest frequency × duration up to {:e}", MOST_SWEEP_SAMPLES / SWEEP_SAMPLES))
            .into());
    }
    let growth = (to / from).ln();
    let cycles = |s: f64| match sweep.logarithmic && growth != 0.0 {
        true => from * length * (growth * s).exp_m1() / growth,
        false => length * s * (from + 0.5 * (to - from) * s),
    };
    let value = |k: usize| peak * (2.0 * PI * cycles(k as f64 / intervals)).sin();
    let acceleration: Vec<f64> = (0..=intervals as usize).map(value).collect();
    let dt = length / intervals;
    GroundMotion::sampled(dt, &acceleration)
}

fn positive(key: &'static str, value: f64, unit: &str) -> Result<f64> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(InputError::new(format!("{value} {unit}").trim_end()).key(key).allowed("above 0").into())
}

fn not_negative(key: &'static str, value: f64, unit: &str) -> Result<f64> {
    if value >= 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(InputError::new(format!("{value} {unit}")).key(key).allowed("from 0").into())
}

fn finite(key: &'static str, value: f64) -> Result<f64> {
    if value.is_finite() { Ok(value) } else { Err(InputError::new(shown(value)).key(key).allowed("finite").into()) }
}
