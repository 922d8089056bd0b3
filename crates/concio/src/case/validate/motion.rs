//! Motions of base and top.

use super::{Bound, Findings};
use crate::case::SYNTHETIC_SAMPLES;
use crate::case::{
    Baseline, Case, DisplacementPath, Motion, Pulse, Ramp, RecordChannel, RecordInput, Signal, Sine, Sweep, Synthetic,
    Tilt,
};
use crate::quantity::Time;

pub(super) fn check(f: &mut Findings, case: &Case) {
    let m = &case.motion;
    match m.duration {
        Some(duration) => f.quantity("motion.duration", duration, Bound::Above0),
        None if *m == Motion::default() => {
            f.push("motion", "the key is missing", "a table `[motion]`: Motion of base and top");
        }
        None if !m.has_length() => {
            let what = "the key is missing, and no record says how long the run is";
            f.push("motion.duration", what, "above 0 s");
        }
        None => {}
    }
    for (key, s) in m.signals() {
        signal(f, &format!("motion.{key}"), s);
        if let (Some((name, start)), Some(duration)) = (start(s), m.duration)
            && start.si() >= duration.si()
            && duration.si() > 0.0
        {
            let what = format!("{start} is when the run has ended: nothing would move");
            f.push(format_args!("motion.{key}.{name}.start"), what, format!("below motion.duration, {duration}"));
        }
    }
}

fn signal(f: &mut Findings, key: &str, signal: &Signal) {
    match signal {
        Signal::None => {}
        Signal::Record(r) => record(f, key, r),
        Signal::Sine(s) => sine(f, key, s),
        Signal::Ramp(r) => ramp(f, key, r),
        Signal::Tilt(t) => tilt(f, key, t),
        Signal::Path(p) => path(f, key, p),
        Signal::Pulse(p) => pulse(f, key, p),
        Signal::Sweep(s) => sweep(f, key, s),
        Signal::Synthetic(s) => synthetic(f, key, s),
    }
}

/// When a motion begins that says so, below the key of its form.
fn start(signal: &Signal) -> Option<(&'static str, Time)> {
    match signal {
        Signal::Ramp(ramp) => Some(("ramp", ramp.start)),
        Signal::Tilt(tilt) => Some(("tilt", tilt.start)),
        Signal::Pulse(pulse) => Some(("pulse", pulse.start)),
        _ => None,
    }
}

fn record(f: &mut Findings, key: &str, r: &RecordInput) {
    if r.record.as_os_str().is_empty() {
        f.push(format_args!("{key}.record"), "the path is empty", "the path of a record, relative to the wall file");
    }
    match &r.channel {
        Some(RecordChannel::Number(0)) => f.push(format_args!("{key}.channel"), "0 is out of range", "from 1"),
        Some(RecordChannel::Name(name)) if name.trim().is_empty() => {
            f.push(format_args!("{key}.channel"), "the name is empty", "the name of a component, or its number from 1");
        }
        _ => {}
    }
    if let Some(scale) = r.scale {
        f.number(format_args!("{key}.scale"), scale, Bound::Finite);
    }
    if let Some(pga) = r.pga {
        f.quantity(format_args!("{key}.pga"), pga, Bound::Above0);
        if r.scale.is_some() {
            f.push(format_args!("{key}.pga"), "both `scale` and `pga` are given", "one of them");
        }
    }
    if let Some(trim) = r.trim {
        for (k, v) in trim.into_iter().enumerate() {
            f.quantity(format_args!("{key}.trim[{k}]"), v, Bound::From0);
        }
        f.rising(format_args!("{key}.trim"), trim, false);
    }
    for (name, interval) in [("resample", r.resample), ("dt", r.dt)] {
        if let Some(v) = interval {
            f.quantity(format_args!("{key}.{name}"), v, Bound::Above0);
        }
    }
    match r.baseline {
        Baseline::None => {}
        Baseline::Polynomial(degree) => {
            f.number(format_args!("{key}.baseline.polynomial"), degree as f64, Bound::Between(0.0, 6.0));
        }
        Baseline::HighPass { corner, order } => {
            f.quantity(format_args!("{key}.baseline.high_pass"), corner, Bound::Above0);
            f.number(format_args!("{key}.baseline.order"), order as f64, Bound::Between(1.0, 8.0));
        }
    }
}

fn sine(f: &mut Findings, key: &str, s: &Sine) {
    match (s.amplitude, s.acceleration) {
        (Some(amplitude), None) => f.quantity(format_args!("{key}.sine.amplitude"), amplitude, Bound::Finite),
        (None, Some(acceleration)) => f.quantity(format_args!("{key}.sine.acceleration"), acceleration, Bound::Finite),
        (both, _) => {
            let what = if both.is_some() {
                "both a displacement and an acceleration are given"
            } else {
                "neither a displacement nor an acceleration is given"
            };
            f.push(format_args!("{key}.sine"), what, "exactly one of `amplitude` and `acceleration`");
        }
    }
    f.quantity(format_args!("{key}.sine.frequency"), s.frequency, Bound::Above0);
    f.quantity(format_args!("{key}.sine.ramp"), s.ramp, Bound::From0);
    if let Some(cycles) = s.cycles {
        f.number(format_args!("{key}.sine.cycles"), cycles, Bound::Above0);
    }
}

fn ramp(f: &mut Findings, key: &str, r: &Ramp) {
    f.quantity(format_args!("{key}.ramp.amplitude"), r.amplitude, Bound::Finite);
    f.quantity(format_args!("{key}.ramp.start"), r.start, Bound::From0);
    f.quantity(format_args!("{key}.ramp.rise"), r.rise, Bound::Above0);
}

fn tilt(f: &mut Findings, key: &str, t: &Tilt) {
    f.quantity(format_args!("{key}.tilt.acceleration"), t.acceleration, Bound::Finite);
    f.quantity(format_args!("{key}.tilt.rise"), t.rise, Bound::Above0);
    f.quantity(format_args!("{key}.tilt.start"), t.start, Bound::From0);
}

/// Most places of a path: each step of a run looks for its own among them.
const MOST_PLACES: usize = 1000;

fn path(f: &mut Findings, key: &str, p: &DisplacementPath) {
    f.quantity(format_args!("{key}.path.speed"), p.speed, Bound::Above0);
    if !(1..=MOST_PLACES).contains(&p.displacements.len()) {
        let what = format!("{} displacements are given", p.displacements.len());
        f.push(format_args!("{key}.path.displacements"), what, "at least one, up to 1,000");
    }
    let mut before = 0.0;
    for (k, d) in p.displacements.iter().enumerate() {
        f.quantity(format_args!("{key}.path.displacements[{k}]"), *d, Bound::Finite);
        if d.si() == before {
            let what = if k == 0 { format!("the path starts at {d} already") } else { format!("{d} stands before it") };
            let allowed = "each displacement other than the one before it, the first other than 0";
            f.push(format_args!("{key}.path.displacements[{k}]"), what, allowed);
        }
        before = d.si();
    }
}

fn pulse(f: &mut Findings, key: &str, p: &Pulse) {
    f.quantity(format_args!("{key}.pulse.acceleration"), p.acceleration, Bound::Finite);
    f.quantity(format_args!("{key}.pulse.duration"), p.duration, Bound::Above0);
    f.quantity(format_args!("{key}.pulse.start"), p.start, Bound::From0);
}

fn sweep(f: &mut Findings, key: &str, s: &Sweep) {
    f.quantity(format_args!("{key}.sweep.acceleration"), s.acceleration, Bound::Finite);
    for (k, v) in s.frequency.into_iter().enumerate() {
        f.quantity(format_args!("{key}.sweep.frequency[{k}]"), v, Bound::Above0);
    }
    f.quantity(format_args!("{key}.sweep.duration"), s.duration, Bound::Above0);
}

fn synthetic(f: &mut Findings, key: &str, s: &Synthetic) {
    f.quantity(format_args!("{key}.synthetic.pga"), s.pga, Bound::Above0);
    f.quantity(format_args!("{key}.synthetic.dt"), s.dt, Bound::Above0);
    f.quantity(format_args!("{key}.synthetic.duration"), s.duration, Bound::Finite);
    if s.duration.si() <= 2.0 {
        f.push(format_args!("{key}.synthetic.duration"), format!("{} is out of range", s.duration), "above 2 s");
    }
    let least = s.duration.si() / SYNTHETIC_SAMPLES;
    if s.dt.si() > 0.0 && s.dt.si() <= least {
        let allowed = format!("above {least:e} s for this duration");
        f.push(format_args!("{key}.synthetic.dt"), format!("{} gives 200,000 samples or more", s.dt), allowed);
    }
    for (k, v) in s.corners.into_iter().enumerate() {
        f.quantity(format_args!("{key}.synthetic.corners[{k}]"), v, Bound::Above0);
    }
    let [b, c, d] = s.corners;
    f.rising(format_args!("{key}.synthetic.corners"), [b, c], false);
    f.rising(format_args!("{key}.synthetic.corners"), [c, d], false);
}
