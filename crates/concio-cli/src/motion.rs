//! What moves base and top, in words and numbers, and what a run leaves of a record.

use std::path::Path;

use concio::Error;
use concio::case::{Baseline, Beam, PulseShape, RecordInput, Signal};
use concio::ground::coverage::{Coverage, coverage};
use concio::ground::formats;
use concio::ground::record::{Record, TextOptions};
use concio::ground::{Measures, channel, measure, process, synthetic};
use concio::run::Prepared;

use crate::failure::Failure;
use crate::format::{plain, seconds, si, significant};

/// Lines that say what moves the wall: names and values.
type Rows = Vec<(&'static str, String)>;

/// The motion of a run; `folder` is where relative record paths start. Of a wall that is `lopsided` a push the other way is another push.
pub fn describe(prepared: &Prepared, folder: &Path, lopsided: bool) -> Result<Rows, Failure> {
    let (motion, duration) = (&prepared.case.motion, prepared.model.excitation.duration);
    let driven = prepared.case.load.beam == Beam::Driven;
    let mut found = Rows::new();
    for (name, signal) in motion.signals() {
        if (name == "top" && !driven) || (name == "vertical" && *signal == Signal::None) {
            continue;
        }
        match signal {
            Signal::Record(input) => of_record(&mut found, name, input, folder, duration)?,
            Signal::Synthetic(input) => {
                let made = synthetic::generate(input)?;
                found.push((name, format!("synthetic accelerogram, seed {}", input.seed)));
                found.push(("", samples(&made)));
                found.push(("", peak(&made)));
                used(&mut found, &made, duration);
            }
            closed => {
                found.push((name, closed_form(closed)));
                let in_plane = name == "base" && prepared.model.rocking().is_none();
                let other = if lopsided { "; it is not symmetric: run the other sign too" } else { "" };
                let told = sense(closed).filter(|_| in_plane);
                found.extend(told.map(|side| ("", format!("pushes the wall to the {side}{other}"))));
            }
        }
    }
    Ok(found)
}

fn of_record(
    found: &mut Rows,
    name: &'static str,
    input: &RecordInput,
    folder: &Path,
    duration: f64,
) -> Result<(), Failure> {
    let path = folder.join(&input.record);
    let mut channels = formats::read(&path, &TextOptions::from(input))?;
    let place = channel::choose(&channels, input.channel.as_ref()).map_err(Error::from)?;
    let count = channels.len();
    let mut record = channels.swap_remove(place);
    let label = format!("channel {} of {count} {}", place + 1, record.channel);
    found.push((name, format!("{}, {}, {}", path.display(), record.format.name(), label.trim_end())));
    found.extend(record.remarks.iter().map(|remark| ("", remark.to_string())));
    let steps = steps(input);
    if !steps.is_empty() {
        found.push(("", format!("in the file {}, {}", samples(&record), peak(&record))));
    }
    for (what, step) in steps {
        let done = process::prepare(record.clone(), &step)?;
        found.push(("", format!("{what}: {}", changes(&record, &done))));
        record = done;
    }
    let factor = match input.pga {
        Some(pga) => pga.si() / measure(&record).pga.value.abs(),
        None => input.scale.unwrap_or(1.0),
    };
    let record = process::prepare(record, &RecordInput { scale: input.scale, pga: input.pga, ..untouched(input) })?;
    found.push(("", samples(&record)));
    found.push(("", format!("scale factor {}, {}", significant(factor, 5), peak(&record))));
    used(found, &record, duration);
    Ok(())
}

/// The record as the file has it.
fn untouched(input: &RecordInput) -> RecordInput {
    RecordInput {
        scale: None,
        pga: None,
        trim: None,
        reverse: false,
        resample: None,
        baseline: Baseline::None,
        ..input.clone()
    }
}

/// What is done to the record before it is scaled, in this order, each in words and alone.
fn steps(input: &RecordInput) -> Vec<(String, RecordInput)> {
    let mut steps = Vec::new();
    if let Some([from, to]) = input.trim {
        let what = format!("trimmed from {} to {}", seconds(from.si()), seconds(to.si()));
        steps.push((what, RecordInput { trim: input.trim, ..untouched(input) }));
    }
    if input.reverse {
        steps.push(("played backwards".into(), RecordInput { reverse: true, ..untouched(input) }));
    }
    let corrected = || RecordInput { baseline: input.baseline, ..untouched(input) };
    match input.baseline {
        Baseline::None => {}
        Baseline::Polynomial(degree) => steps.push((format!("polynomial of degree {degree} taken off"), corrected())),
        Baseline::HighPass { corner, order } => {
            steps.push((format!("high-passed at {} Hz, order {order}, both ways", plain(corner.si())), corrected()));
        }
    }
    if let Some(interval) = input.resample {
        let what = format!("resampled every {}", seconds(interval.si()));
        steps.push((what, RecordInput { resample: input.resample, ..untouched(input) }));
    }
    steps
}

/// What a step changed: number of samples, peak and end displacement, before and after.
fn changes(before: &Record, after: &Record) -> String {
    let (from, to) = (measure(before), measure(after));
    let arrow = |from: String, to: String| if from == to { from } else { format!("{from} → {to}") };
    let count = arrow(before.npts().to_string(), after.npts().to_string());
    let peak = |m: &Measures| significant(m.pga.value.abs(), 4);
    let end = |m: &Measures| si(m.final_displacement, "m");
    format!(
        "{count} samples, PGA {} m/s², end displacement {}",
        arrow(peak(&from), peak(&to)),
        arrow(end(&from), end(&to))
    )
}

fn samples(record: &Record) -> String {
    format!("{} samples every {}, {}", record.npts(), seconds(record.dt), seconds(record.duration()))
}

fn peak(record: &Record) -> String {
    let pga = measure(record).pga;
    let size = pga.value.abs();
    format!("PGA {} m/s² = {} g at {}", significant(size, 4), significant(size / concio::G, 4), seconds(pga.time))
}

/// How much of a record the run goes through.
fn used(found: &mut Rows, record: &Record, duration: f64) {
    let text = match coverage(record, duration) {
        Coverage::Whole => "used whole".into(),
        Coverage::Cut => format!("{} of {} used", seconds(duration), seconds(record.duration())),
        Coverage::Silence(rest) => format!("used whole, then {} without acceleration", seconds(rest)),
    };
    found.push(("", text));
}

/// Any motion in a line, as the file says it: nothing is read.
pub fn short(signal: &Signal) -> String {
    match signal {
        Signal::Record(input) => {
            let mut text = format!("record {}", input.record.display());
            if let Some(channel) = &input.channel {
                text += &format!(", channel {channel}");
            }
            text += &match (input.pga, input.scale) {
                (Some(pga), _) => format!(", scaled to a PGA of {} g", plain(pga.si() / concio::G)),
                (None, scale) => format!(", scale {}", plain(scale.unwrap_or(1.0))),
            };
            if let Some([from, to]) = input.trim {
                text += &format!(", from {} to {}", seconds(from.si()), seconds(to.si()));
            }
            text + if input.reverse { ", played backwards" } else { "" }
        }
        Signal::Synthetic(input) => format!(
            "synthetic accelerogram, seed {}, PGA {} g, {}",
            input.seed,
            plain(input.pga.si() / concio::G),
            seconds(input.duration.si())
        ),
        closed => closed_form(closed),
    }
}

/// To which side what pushes one way pushes the wall, along its plane: inertia points against the acceleration of the base.
fn sense(signal: &Signal) -> Option<&'static str> {
    let acceleration = match signal {
        Signal::Tilt(tilt) => tilt.acceleration.si(),
        Signal::Pulse(pulse) => match pulse.shape {
            PulseShape::Rectangular | PulseShape::HalfSine => pulse.acceleration.si(),
            PulseShape::OneSine | PulseShape::Ricker => return None,
        },
        _ => return None,
    };
    let side = if acceleration > 0.0 { "left" } else { "right" };
    (acceleration != 0.0).then_some(side)
}

/// A motion that is no record, with its numbers.
fn closed_form(signal: &Signal) -> String {
    match signal {
        Signal::None | Signal::Record(_) | Signal::Synthetic(_) => "at rest".into(),
        Signal::Sine(s) => {
            let size = match (s.amplitude, s.acceleration) {
                (Some(u), _) => format!("displacement {}", si(u.si(), "m")),
                (None, Some(a)) => acceleration(a.si()),
                (None, None) => String::new(),
            };
            let ramp = if s.ramp.si() > 0.0 { format!(", ramp of {}", seconds(s.ramp.si())) } else { String::new() };
            let cycles = s.cycles.map_or(String::new(), |n| format!(", {n} cycles"));
            format!("sine of {} Hz, {size}{ramp}{cycles}", s.frequency.si())
        }
        Signal::Ramp(r) => format!(
            "ramp to {} from {} within {}",
            si(r.amplitude.si(), "m"),
            seconds(r.start.si()),
            seconds(r.rise.si())
        ),
        Signal::Tilt(t) => format!(
            "tilt to an {} from {} within {}",
            acceleration(t.acceleration.si()),
            seconds(t.start.si()),
            seconds(t.rise.si())
        ),
        Signal::Path(p) => {
            let places = p.displacements.iter().map(|u| si(u.si(), "m"));
            let shown: Vec<String> = match p.displacements.len() {
                0..=6 => places.collect(),
                many => places.take(5).chain([format!("… ({many} in all)")]).collect(),
            };
            format!("path to {} at {}", shown.join(", "), si(p.speed.si(), "m/s"))
        }
        Signal::Pulse(p) => {
            let shape = match p.shape {
                PulseShape::Rectangular => "rectangular pulse",
                PulseShape::HalfSine => "half-sine pulse",
                PulseShape::OneSine => "one-sine pulse",
                PulseShape::Ricker => "Ricker pulse",
            };
            let place = format!("{} from {}", seconds(p.duration.si()), seconds(p.start.si()));
            format!("{shape}, {}, {place}", acceleration(p.acceleration.si()))
        }
        Signal::Sweep(s) => format!(
            "sine swept from {} to {} Hz in {}, {}",
            s.frequency[0].si(),
            s.frequency[1].si(),
            seconds(s.duration.si()),
            acceleration(s.acceleration.si())
        ),
    }
}

fn acceleration(a: f64) -> String {
    format!("acceleration {} m/s² = {} g", significant(a, 4), significant(a / concio::G, 4))
}
