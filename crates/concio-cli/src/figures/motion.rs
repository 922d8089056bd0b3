//! What moves the wall: acceleration, velocity, displacement, and the response spectrum.

use concio::InputError;
use concio::case::Beam;
use concio::ground::response_spectrum;
use concio_study::intensity::Sampled;

use crate::format::seconds;

use super::data::Data;
use super::{Options, letter};
use crate::draw::chart::{self, Axis, Line, Panel, Sheet};
use crate::draw::output::Drawing;

const BASE: &str = "base";
/// Damping ratio of the spectrum.
pub const DAMPING: f64 = 0.05;
/// Periods of the spectrum [s]: that many from the shortest to the longest, at equal ratios.
const PERIODS: (usize, f64, f64) = (400, 0.02, 10.0);

/// A motion at equal intervals.
struct Moved {
    name: &'static str,
    /// Of its acceleration.
    channel: &'static str,
    time: Vec<f64>,
    /// Acceleration, velocity, displacement, in SI.
    histories: [Vec<f64>; 3],
}

/// The periods of a spectrum [s].
pub fn periods() -> Vec<f64> {
    let (n, low, high) = PERIODS;
    (0..n).map(|k| low * (high / low).powf(k as f64 / (n - 1) as f64)).collect()
}

/// Acceleration, velocity, displacement of the base and its 5 % response spectrum; of a driven beam too.
pub fn motion(data: &Data, options: &Options) -> Result<Drawing, InputError> {
    let found: Vec<Moved> = [base(data), beam(data)].into_iter().flatten().filter(Moved::moves).collect();
    if found.is_empty() {
        return Err(InputError::new("neither base nor beam moves in the time shown").key("--from, --to"));
    }
    const SHOWN: [(&str, &str); 3] = [("acceleration", "m/s²"), ("velocity", "m/s"), ("displacement", "m")];
    let columns = options.columns(1);
    let mut panels: Vec<Panel> = SHOWN
        .iter()
        .enumerate()
        .map(|(k, (quantity, unit))| Panel {
            heading: letter(k, 4, quantity),
            x: Axis { quantity: "time".into(), unit: "s", ..Axis::default() },
            y: Axis { quantity: (*quantity).into(), unit, ..Axis::default() },
            lines: found
                .iter()
                .enumerate()
                .map(|(style, m)| Line { x: (&m.time).into(), y: (&m.histories[k]).into(), style })
                .collect(),
            rising: true,
            bare: columns == 1 && k < 2,
            marked: false,
        })
        .collect();
    panels.push(spectrum(data, &found));
    let named = found.len() > 1 || found[0].name != BASE;
    Ok(chart::draw(&Sheet {
        title: "Motion of base and top beam, and response spectrum with 5 % damping".into(),
        legend: if named { found.iter().map(|m| m.name.into()).collect() } else { Vec::new() },
        panels,
        columns,
        width: options.points(),
        height: Some(62.0),
    }))
}

impl Moved {
    fn moves(&self) -> bool {
        self.histories.iter().flatten().any(|v| *v != 0.0)
    }
}

/// Of the whole motion, whatever time is shown: that of the base as it was given where its record is there, else as the run kept it.
fn spectrum<'a>(data: &Data, found: &[Moved]) -> Panel<'a> {
    let periods = periods();
    let kept = data.run.outcome.layout.interval;
    let mut coarse = false;
    let line = |(style, moved): (usize, &Moved)| {
        let given = if moved.name == BASE { Sampled::of_case(&data.case).ok() } else { None };
        coarse |= given.is_none();
        let (dt, acceleration) =
            given.map_or_else(|| (kept, data.whole(moved.channel)), |given| (given.dt, given.acceleration));
        let spectrum = response_spectrum(dt, &acceleration, DAMPING, &periods);
        Line { x: spectrum.periods.into(), y: spectrum.psa.into(), style }
    };
    let lines: Vec<Line> = found.iter().enumerate().map(line).collect();
    let samples = if coarse { format!(", samples every {}", seconds(kept)) } else { String::new() };
    let heading = format!("5 % response spectrum{samples}");
    let top = lines.iter().flat_map(|l| l.y.iter()).fold(0.0f64, |m, v| m.max(*v));
    Panel {
        heading: letter(3, 4, &heading),
        x: Axis { quantity: "period".into(), unit: "s", range: Some([PERIODS.1, PERIODS.2]), logarithmic: true },
        y: Axis { quantity: "pseudo-acc.".into(), unit: "m/s²", range: Some([0.0, 1.08 * top]), logarithmic: false },
        lines,
        rising: true,
        bare: false,
        marked: false,
    }
}

fn base(data: &Data) -> Option<Moved> {
    let (a, u) = (data.channel("base/acceleration")?, data.channel("base/displacement")?);
    let velocity = velocity(data.run.outcome.layout.interval, &a.values, &u.values);
    Some(Moved { name: BASE, channel: "base/acceleration", time: a.time, histories: [a.values, velocity, u.values] })
}

/// A driven beam, relative to the base.
fn beam(data: &Data) -> Option<Moved> {
    if data.case.load.beam != Beam::Driven {
        return None;
    }
    let (u, v, a) =
        (data.channel("beam/displacement")?, data.channel("beam/velocity")?, data.channel("beam/acceleration")?);
    Some(Moved {
        name: "top beam, relative to the base",
        channel: "beam/acceleration",
        time: u.time,
        histories: [a.values, v.values, u.values],
    })
}

/// Velocity from samples of displacement and acceleration, exact where the acceleration is linear between them:
/// v_k = (u_{k+1} − u_k)/h − h (2 a_k + a_{k+1})/6.
fn velocity(h: f64, a: &[f64], u: &[f64]) -> Vec<f64> {
    let n = a.len().min(u.len());
    let forward = |k: usize| (u[k + 1] - u[k]) / h - h * (2.0 * a[k] + a[k + 1]) / 6.0;
    let backward = |k: usize| (u[k] - u[k - 1]) / h + h * (2.0 * a[k] + a[k - 1]) / 6.0;
    (0..n)
        .map(|k| {
            if k + 1 < n {
                forward(k)
            } else if n > 1 {
                backward(k)
            } else {
                0.0
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// u = t³ − 2 t² + 3 t, whose acceleration is linear: v = 3 t² − 4 t + 3.
    #[test]
    fn velocities_of_linear_accelerations_are_exact() {
        let h = 0.05;
        let t: Vec<f64> = (0..40).map(|k| h * f64::from(k)).collect();
        let u: Vec<f64> = t.iter().map(|t| t * t * t - 2.0 * t * t + 3.0 * t).collect();
        let a: Vec<f64> = t.iter().map(|t| 6.0 * t - 4.0).collect();
        for (v, t) in velocity(h, &a, &u).iter().zip(&t) {
            assert!((v - (3.0 * t * t - 4.0 * t + 3.0)).abs() < 1e-12);
        }
    }
}
