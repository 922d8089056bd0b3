//! What is done to a record before it shakes a wall: trim, reverse, baseline, resample, scale, in this order; and the
//! integration of a piecewise-linear acceleration.
//!
//! D. M. Boore & S. Akkar, Earthquake Engng Struct. Dyn. 32 (2003) 2069; D. M. Boore, Bull. Seism. Soc. Am. 95 (2005) 745;
//! R. Paolucci et al., Record processing in ITACA, in Earthquake Data in Engineering Seismology (Springer 2011) 99.

use sci_rs::signal::filter::design::{DigitalFilter, FilterBandType, FilterOutputType, butter_dyn};
use sci_rs::signal::filter::sosfiltfilt_dyn;

use crate::case::{Baseline, RecordInput};
use crate::ground::record::{Record, interval_error};
use crate::ground::source::MOST_SAMPLES;
use crate::ground::spline::{self, Ends};
use crate::quantity::shown;
use crate::{InputError, Result};

/// Order of the low-pass before coarsening, and its corner over the new Nyquist frequency.
const ANTI_ALIAS: (usize, f64) = (8, 0.8);
/// Zeros before and behind a record while it is high-passed, over order/corner; Boore (2005) asks for half of it.
const PAD: f64 = 1.5;
/// Most of them at either end.
const MOST_PAD: f64 = 1e6;
/// Time over which a high-passed record is brought from rest and back to it, over the period of the corner. Half of it
/// would change the acceleration twice as much, twice of it would displace the base twice as far.
const RISE: f64 = 0.5;
/// Slack for times that are whole numbers of intervals but for rounding.
const SLACK: f64 = 1e-9;

/// Trims, reverses, corrects the baseline, resamples and scales as `input` says, in this order.
///
/// # Errors
/// [`crate::Error::Input`] when a number of `input` does not suit the record; it carries the allowed range.
pub fn prepare(record: Record, input: &RecordInput) -> Result<Record> {
    let mut record = record;
    correct(&mut record, input)?;
    size(&mut record, input)?;
    Ok(record)
}

/// Largest accelerations before and after each step that may lower it [m/s²].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Peaks {
    /// `trim`.
    pub trim: [f64; 2],
    /// `baseline`: an offset is no shaking, so the mean does not count before it.
    pub baseline: [f64; 2],
    /// `resample`; the second is that of the prepared record but for its scale.
    pub resample: [f64; 2],
}

/// [`prepare`] but for the scale.
pub(super) fn correct(record: &mut Record, input: &RecordInput) -> Result<Peaks> {
    let raw = record.largest();
    if let Some([from, to]) = input.trim {
        trim(record, from.si(), to.si())?;
    }
    if input.reverse {
        reverse(record);
    }
    let trimmed = record.largest();
    let mean = record.acceleration.iter().sum::<f64>() / record.npts().max(1) as f64;
    let shaking = record.acceleration.iter().fold(0.0, |most: f64, a| most.max((a - mean).abs()));
    correct_baseline(record, input.baseline)?;
    let corrected = record.largest();
    if let Some(dt) = input.resample {
        resample(record, dt.si())?;
    }
    let resample = [corrected, record.largest()];
    Ok(Peaks { trim: [raw, trimmed], baseline: [shaking, corrected], resample })
}

/// The scale of [`prepare`].
pub(super) fn size(record: &mut Record, input: &RecordInput) -> Result<()> {
    match (input.scale, input.pga) {
        (Some(_), Some(_)) => {
            let error = InputError::new("both `scale` and `pga` are given").key("pga");
            Err(error.allowed("one of them").into())
        }
        (Some(factor), None) => scale(record, factor),
        (None, Some(pga)) => scale_to_pga(record, pga.si()),
        (None, None) => Ok(()),
    }
}

/// A number without the digits that rounding leaves behind.
fn tidy(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}

/// Keeps the samples from `from` to `to` [s]; the first of them is at t = 0 then.
///
/// # Errors
/// [`InputError`] unless 0 ≤ from < to ≤ duration and two samples remain.
pub fn trim(record: &mut Record, from: f64, to: f64) -> Result<()> {
    let range = 0.0..=record.duration() + SLACK * record.dt;
    let first = (from / record.dt - SLACK).ceil();
    let last = (to / record.dt + SLACK).floor();
    if !(range.contains(&from) && range.contains(&to) && last >= first + 1.0) {
        let allowed = format!("0 ≤ from < to ≤ {} s, two samples or more", tidy(record.duration()));
        return Err(InputError::new(format!("from {} s to {} s", shown(from), shown(to)))
            .key("trim")
            .allowed(allowed)
            .into());
    }
    let last = (last as usize).min(record.npts() - 1);
    let kept = first as usize..=last;
    match &mut record.displacement {
        None => record.acceleration = record.acceleration[kept].to_vec(),
        Some(u) => *u = u[kept].to_vec(),
    }
    refit(record);
    Ok(())
}

/// Puts the last sample first. The acceleration is a(T − t) then, of a displacement history too, whose spline does not
/// know the direction; velocities change their sign with it.
pub fn reverse(record: &mut Record) {
    record.acceleration.reverse();
    if let Some(u) = &mut record.displacement {
        u.reverse();
    }
    refit(record);
}

/// Corrects the acceleration.
///
/// # Errors
/// [`InputError`] for a displacement history, and for orders and corners out of range.
pub fn correct_baseline(record: &mut Record, baseline: Baseline) -> Result<()> {
    if baseline != Baseline::None && record.displacement.is_some() {
        let error = InputError::new("a displacement history has no acceleration baseline").key("baseline");
        return Err(error.allowed("none").into());
    }
    match baseline {
        Baseline::None => Ok(()),
        Baseline::Polynomial(degree) => subtract_polynomial(&mut record.acceleration, degree),
        Baseline::HighPass { corner, order } => high_pass(record, corner.si(), order),
    }
}

/// Subtracts the least-squares polynomial of a degree from equidistant samples.
///
/// The polynomials are made orthogonal over the samples by the three-term recurrence of Forsythe (1957), so that
/// no ill-conditioned system is solved.
///
/// # Errors
/// [`InputError`] unless the degree is 0 … 6 and below the number of samples.
pub fn subtract_polynomial(values: &mut [f64], degree: usize) -> Result<()> {
    if degree > 6 || degree >= values.len() {
        let error = InputError::new(format!("degree {degree}, {} samples", values.len())).key("baseline.polynomial");
        return Err(error.allowed("0 … 6, below the number of samples").into());
    }
    let n = values.len() as f64;
    let x: Vec<f64> = (0..values.len()).map(|k| (2.0 * k as f64 - (n - 1.0)) / n).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (mut before, mut current) = (vec![0.0; x.len()], vec![1.0; x.len()]);
    let mut norm_before = 1.0;
    for _ in 0..=degree {
        let norm = dot(&current, &current);
        let weight = dot(values, &current) / norm;
        values.iter_mut().zip(&current).for_each(|(value, p)| *value -= weight * p);
        // The samples lie evenly about x = 0, so the middle coefficient of the recurrence vanishes.
        let back = if before[0] == 0.0 { 0.0 } else { norm / norm_before };
        let next = x.iter().zip(&current).zip(&before).map(|((x, p), q)| x * p - back * q).collect();
        before = std::mem::replace(&mut current, next);
        norm_before = norm;
    }
    Ok(())
}

/// Butterworth high-pass of the acceleration, forward and backward: no phase shift, twice the order, half the
/// amplitude at the corner. The motion starts and ends at rest where it started.
///
/// A record that was cut, or triggered late, begins with a velocity that its samples do not tell, and a filtered one
/// moves before it starts, because the filter looks ahead (Boore & Akkar 2003; Boore 2005): integrated from rest, both
/// drift. The mean is taken off and the filter runs over zeros at both ends, which hold what it does beyond the record. Archives
/// keep them, or taper the displacement (Paolucci et al. 2011). Here they would lengthen the run by tens of seconds, and a taper of a
/// record that was cut adds accelerations above its own. What the motion has at either end is therefore taken off it as a
/// line that fades within half a period of the corner, and the acceleration is the one that belongs to what is left.
fn high_pass(record: &mut Record, corner: f64, order: usize) -> Result<()> {
    let nyquist = 0.5 / record.dt;
    if !(corner > 0.0 && corner < nyquist) {
        let error = InputError::new(format!("corner {} Hz", shown(corner))).key("baseline.high_pass");
        return Err(error.allowed(format!("above 0, below the Nyquist frequency {} Hz", tidy(nyquist))).into());
    }
    if !(1..=8).contains(&order) {
        return Err(InputError::new(format!("order {order}")).key("baseline.order").allowed("1 … 8").into());
    }
    enough(record.npts(), order)?;
    let (n, dt) = (record.npts(), record.dt);
    let mean = record.acceleration.iter().sum::<f64>() / n as f64;
    let pad = (PAD * order as f64 / (corner * dt)).ceil().min(MOST_PAD) as usize;
    let mut padded = vec![0.0; pad + n + pad];
    padded[pad..pad + n].iter_mut().zip(&record.acceleration).for_each(|(to, a)| *to = a - mean);
    let filtered = butterworth(&padded, dt, corner, order, FilterBandType::Highpass)?;
    let (velocity, displacement) = integrate(dt, &filtered, 0.0, 0.0);
    let (v, u) = (&velocity[pad..pad + n], &displacement[pad..pad + n]);
    let length = (n - 1) as f64 * dt;
    let rise = (RISE / corner).min(length);
    let at_rest = |k: usize| {
        let (t, left) = (k as f64 * dt, length - k as f64 * dt);
        u[k] - fading(t / rise) * (u[0] + v[0] * t) - fading(left / rise) * (u[n - 1] - v[n - 1] * left)
    };
    let moved: Vec<f64> = (0..n).map(at_rest).collect();
    record.acceleration = spline::second_derivatives(dt, &moved, Ends::AtRest);
    Ok(())
}

/// From 1 at 0 to 0 from 1 on, without slope and curvature at both.
fn fading(x: f64) -> f64 {
    if x < 1.0 { 1.0 - x * x * x * (10.0 - x * (15.0 - 6.0 * x)) } else { 0.0 }
}

/// Samples below this number are less than the mirror image by which the filter continues a record at both ends.
fn enough(npts: usize, order: usize) -> Result<()> {
    let least = 3 * (2 * order.div_ceil(2) + 1) + 1;
    if npts < least {
        let error = InputError::new(format!("{npts} samples are too few for a filter of order {order}"));
        return Err(error.allowed(format!("{least} samples or more")).into());
    }
    Ok(())
}

fn butterworth(values: &[f64], dt: f64, corner: f64, order: usize, band: FilterBandType) -> Result<Vec<f64>> {
    enough(values.len(), order)?;
    let kind = Some(FilterOutputType::Sos);
    let filtered = match butter_dyn(order, vec![corner], Some(band), Some(false), kind, Some(1.0 / dt)) {
        DigitalFilter::Sos(filter) => sosfiltfilt_dyn(values.iter(), &filter.sos),
        // The output type asked for is the one above.
        DigitalFilter::Ba(_) | DigitalFilter::Zpk(_) => Vec::new(),
    };
    if filtered.len() != values.len() || filtered.iter().any(|value| !value.is_finite()) {
        let error =
            InputError::new(format!("the filter of order {order} with corner {} Hz is not stable", shown(corner)));
        return Err(error.key("baseline").help("raise the corner or lower the order").into());
    }
    Ok(filtered)
}

/// Brings the record to a new sample interval, up to the last new sample within it.
///
/// The acceleration is interpolated linearly: an interval that divides the old one leaves the piecewise-linear
/// motion as it was, any other cuts its corners. Before coarsening a Butterworth low-pass of order 8, forward and
/// backward, with its corner at 0.8 of the new Nyquist frequency takes away what would be mirrored into the band.
/// A displacement history is interpolated by its spline.
///
/// # Errors
/// [`InputError`] when the interval is out of range or leaves fewer than two or more than [`MOST_SAMPLES`] samples.
pub fn resample(record: &mut Record, dt: f64) -> Result<()> {
    if let Some(error) = interval_error(dt) {
        return Err(error.key("resample").into());
    }
    let last = (record.duration() / dt + SLACK).floor();
    if !(1.0..MOST_SAMPLES as f64).contains(&last) {
        let error =
            InputError::new(format!("interval {} s makes {} samples", shown(dt), shown(last + 1.0))).key("resample");
        return Err(error.allowed(format!("2 … {MOST_SAMPLES} samples")).into());
    }
    if record.displacement.is_none() && dt > record.dt * (1.0 + SLACK) {
        let corner = ANTI_ALIAS.1 * 0.5 / dt;
        record.acceleration =
            butterworth(&record.acceleration, record.dt, corner, ANTI_ALIAS.0, FilterBandType::Lowpass)?;
    }
    let times = (0..=last as usize).map(|k| k as f64 * dt);
    match &record.displacement {
        None => record.acceleration = times.map(|t| interpolate(record, t).1).collect(),
        Some(_) => {
            let u = times.map(|t| interpolate(record, t).0).collect();
            record.displacement = Some(u);
        }
    }
    record.dt = dt;
    refit(record);
    Ok(())
}

/// Displacement (of a displacement history) and acceleration within the record.
fn interpolate(record: &Record, t: f64) -> (f64, f64) {
    let dt = record.dt;
    let k = ((t / dt + SLACK).floor() as usize).min(record.npts() - 2);
    let s = (t / dt - k as f64).clamp(0.0, 1.0);
    let (a, b) = (record.acceleration[k], record.acceleration[k + 1]);
    let acceleration = if s < SLACK { a } else { a + s * (b - a) };
    let displacement = record.displacement.as_ref().map_or(0.0, |u| {
        let r = 1.0 - s;
        r * u[k] + s * u[k + 1] + dt * dt / 6.0 * ((r * r * r - r) * a + (s * s * s - s) * b)
    });
    (displacement, acceleration)
}

/// Multiplies the motion by a factor.
///
/// # Errors
/// [`InputError`] when the factor is not finite.
pub fn scale(record: &mut Record, factor: f64) -> Result<()> {
    if !factor.is_finite() {
        return Err(InputError::new(format!("factor {}", shown(factor))).key("scale").allowed("finite").into());
    }
    record.acceleration.iter_mut().for_each(|a| *a *= factor);
    record.displacement.iter_mut().flatten().for_each(|u| *u *= factor);
    Ok(())
}

/// Scales the motion to a peak acceleration [m/s²]; signs stay.
///
/// # Errors
/// [`InputError`] unless the peak is above 0 and the record is not all zero.
pub fn scale_to_pga(record: &mut Record, pga: f64) -> Result<()> {
    let peak = record.acceleration.iter().fold(0.0_f64, |peak, a| peak.max(a.abs()));
    if !(pga > 0.0 && pga.is_finite()) {
        return Err(InputError::new(format!("peak acceleration {} m/s2", shown(pga)))
            .key("pga")
            .allowed("above 0")
            .into());
    }
    if peak == 0.0 {
        let error = InputError::new("the record is zero throughout and cannot be scaled to a peak").key("pga");
        return Err(error.help("check unit and channel").into());
    }
    scale(record, pga / peak)
}

/// The spline belongs to its displacements: made again after they changed.
fn refit(record: &mut Record) {
    if let Some(u) = &record.displacement {
        record.acceleration = spline::second_derivatives(record.dt, u, Ends::Natural);
    }
}

/// Velocity [m/s] and displacement [m] at the samples of an acceleration that is linear between them: exact.
pub fn integrate(dt: f64, acceleration: &[f64], v0: f64, u0: f64) -> (Vec<f64>, Vec<f64>) {
    let (mut velocity, mut displacement) =
        (Vec::with_capacity(acceleration.len()), Vec::with_capacity(acceleration.len()));
    let (mut v, mut u) = (v0, u0);
    for (k, a) in acceleration.iter().enumerate() {
        if k > 0 {
            let before = acceleration[k - 1];
            u += dt * (v + dt * (2.0 * before + a) / 6.0);
            v += dt * (before + a) / 2.0;
        }
        velocity.push(v);
        displacement.push(u);
    }
    (velocity, displacement)
}
