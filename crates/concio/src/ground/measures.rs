//! Measures of a motion: peaks, Arias intensity, significant duration, Housner intensity.

use std::f64::consts::PI;

use serde::Serialize;

use crate::ground::process::integrate;
use crate::ground::record::Record;
use crate::ground::spectrum::response_spectrum;
use crate::ground::spline;
use crate::ground::units::STANDARD_GRAVITY;

/// Damping ratio of the Housner intensity.
pub const HOUSNER_DAMPING: f64 = 0.05;
/// Periods over which the Housner intensity integrates [s].
pub const HOUSNER_PERIODS: [f64; 2] = [0.1, 2.5];
/// Intervals of the trapezoidal rule of the Housner intensity: one every 0.01 s.
const HOUSNER_STEPS: usize = 240;

/// A largest magnitude with its sign and its time.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Peak {
    /// Value, with its sign.
    pub value: f64,
    /// When it is reached first [s].
    pub time: f64,
}

/// Measures of one motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Measures {
    /// Peak ground acceleration [m/s²].
    pub pga: Peak,
    /// Mean of the acceleration over the samples [m/s²].
    pub mean: f64,
    /// Peak of the acceleration without its mean [m/s²].
    pub pga_without_mean: Peak,
    /// Peak ground velocity at the samples [m/s].
    pub pgv: Peak,
    /// Peak ground displacement at the samples [m], counted from where the motion starts.
    pub pgd: Peak,
    /// Arias intensity π/(2g) ∫ a² dt [m/s] with g = 9.80665 m/s², by the trapezoidal rule over the samples.
    pub arias: f64,
    /// Significant duration: from 5 % to 95 % of the Arias intensity [s].
    pub d5_95: f64,
    /// When 5 % of the Arias intensity is reached [s].
    pub t5: f64,
    /// Housner intensity: integral of the 5 % pseudo-velocity over periods of 0.1 to 2.5 s [m].
    pub housner: f64,
    /// Velocity at the end [m/s].
    pub final_velocity: f64,
    /// Displacement at the end [m], counted from where the motion starts.
    pub final_displacement: f64,
}

/// Measures of a record. A motion starts from rest, except a displacement history, whose velocity is its spline's.
pub fn measure(record: &Record) -> Measures {
    let (dt, a) = (record.dt, &record.acceleration);
    let (v, u) = match &record.displacement {
        None => integrate(dt, a, 0.0, 0.0),
        Some(u) => (spline::first_derivatives(dt, u, a), {
            let start = u.first().copied().unwrap_or(0.0);
            u.iter().map(|x| x - start).collect()
        }),
    };
    let (arias, [t5, t95]) = arias(dt, a);
    let mean = a.iter().sum::<f64>() / a.len().max(1) as f64;
    Measures {
        pga: peak(dt, a),
        mean,
        pga_without_mean: peak_about(mean, dt, a),
        pgv: peak(dt, &v),
        pgd: peak(dt, &u),
        arias,
        d5_95: t95 - t5,
        t5,
        housner: housner(dt, a),
        final_velocity: v.last().copied().unwrap_or(0.0),
        final_displacement: u.last().copied().unwrap_or(0.0),
    }
}

/// The sample of largest magnitude, the first of equals.
pub fn peak(dt: f64, values: &[f64]) -> Peak {
    peak_about(0.0, dt, values)
}

/// The sample farthest from `middle`, counted from there.
fn peak_about(middle: f64, dt: f64, values: &[f64]) -> Peak {
    let mut peak = Peak::default();
    for (k, &value) in values.iter().enumerate() {
        let value = value - middle;
        if value.abs() > peak.value.abs() {
            peak = Peak { value, time: k as f64 * dt };
        }
    }
    peak
}

/// Arias intensity [m/s] and the times at which 5 % and 95 % of it are reached [s].
///
/// The archives' own figures come from the sum over the samples; the exact integral of the linear interpolant is
/// lower by a few per cent when the record is coarse, so it would not compare with them.
pub fn arias(dt: f64, acceleration: &[f64]) -> (f64, [f64; 2]) {
    let mut total = 0.0;
    let sums: Vec<f64> = acceleration
        .windows(2)
        .map(|pair| {
            total += 0.5 * dt * (pair[0] * pair[0] + pair[1] * pair[1]);
            total
        })
        .collect();
    let reached = |fraction: f64| {
        let goal = fraction * total;
        let k = sums.partition_point(|sum| *sum < goal);
        let before = if k == 0 { 0.0 } else { sums[k - 1] };
        let rise = sums.get(k).map_or(0.0, |sum| sum - before);
        dt * (k as f64 + if rise > 0.0 { (goal - before) / rise } else { 0.0 })
    };
    (PI / (2.0 * STANDARD_GRAVITY) * total, [reached(0.05), reached(0.95)])
}

/// Housner intensity [m]: trapezoidal rule with steps of 0.01 s.
pub fn housner(dt: f64, acceleration: &[f64]) -> f64 {
    let [low, high] = HOUSNER_PERIODS;
    let step = (high - low) / HOUSNER_STEPS as f64;
    let periods: Vec<f64> = (0..=HOUSNER_STEPS).map(|k| low + k as f64 * step).collect();
    let psv = response_spectrum(dt, acceleration, HOUSNER_DAMPING, &periods).psv;
    psv.windows(2).map(|pair| 0.5 * step * (pair[0] + pair[1])).sum()
}
