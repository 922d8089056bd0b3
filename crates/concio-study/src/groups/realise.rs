//! From the value of a group to the key of the wall file that realises it.

use std::path::Path;

use concio::case::{Beam, CaseFile, Signal};
use concio::quantity::{Frequency, Length, Time};
use concio::{InputError, Result};
use serde_json::Value;

use super::{GROUPS, Reference, frequency, top_amplitude};
use crate::intensity::Intensity;
use crate::motions;
use crate::values::{Changes, number};

/// What the path of a group begins with.
pub const PREFIX: &str = "group.";

/// The wall with `plain` changes and then the values of some groups, solved for in the order of the table of groups: first
/// those that change M and Ω. Λ is the length of the first panel's reference brick.
///
/// # Errors
/// Groups that are not known or cannot be varied, values that are no number, motions that a group cannot change.
pub fn realise(wall: &CaseFile, plain: Changes, groups: &Changes) -> Result<CaseFile> {
    for (path, _) in groups {
        let name = &path[PREFIX.len()..];
        if !GROUPS.iter().any(|g| g.0 == name && g.2.is_some()) {
            let known: Vec<&str> = GROUPS.iter().filter(|g| g.2.is_some()).map(|g| g.0).collect();
            let what = match GROUPS.iter().any(|g| g.0 == name) {
                true => format!("the group `{name}` follows from others and cannot be varied"),
                false => format!("there is no group `{name}`"),
            };
            return Err(InputError::new(what).key(path.clone()).allowed(known.join(", ")).into());
        }
    }
    let rooted = plain.iter().any(|(path, _)| path == "motion.base");
    let mut changes = plain;
    let mut file = wall.changed(&changes)?;
    for (name, _, key) in GROUPS {
        let Some((path, value)) = groups.iter().find(|(path, _)| path[PREFIX.len()..] == *name) else { continue };
        let amount = value.as_f64().filter(|v| *v >= 0.0 && v.is_finite()).ok_or_else(|| {
            InputError::new(format!("{value} is out of range")).key(path.clone()).allowed("a number from 0")
        })?;
        let folder = if rooted { Path::new("").to_path_buf() } else { wall.folder().to_path_buf() };
        let value = solve(&file, name, amount, &folder).map_err(|e| match e {
            concio::Error::Input(e) if e.key.is_none() => e.key(path.clone()).into(),
            other => other,
        })?;
        changes.push((key.unwrap_or_default().to_string(), value));
        file = wall.changed(&changes)?;
    }
    Ok(file)
}

/// What stands at the key of the group `name` when it has the value `amount`.
fn solve(file: &CaseFile, name: &str, amount: f64, folder: &Path) -> Result<Value> {
    let case = &file.case;
    let r = Reference::of(case, None)?;
    let brick = case.panels[0].brick;
    let sides = brick.length.si() * brick.height.si() * brick.thickness.si();
    let json = |signal: Signal| {
        serde_json::to_value(signal).map_err(|e| InputError::new(format!("the motion cannot be written: {e}")).into())
    };
    let value = match name {
        "weight" => amount * r.force() / sides,
        "beam_mass" => amount * r.mass,
        "head_stiffness" => amount * r.stiffness / head_rigidity(file),
        // ξ γ of a half-brick bed joint is ζ by definition of C.
        "damping" | "static" | "dynamic" | "beta" => amount,
        "load" => amount * r.force() / brick.length.si(),
        "slip_velocity" => amount * r.velocity(),
        "alpha" => amount / (r.velocity() * r.velocity()),
        "duration" => amount / r.frequency,
        "acceleration" => {
            let mut rooted = case.clone();
            rooted.motion.base = motions::rooted(&case.motion.base, folder);
            let pga = Intensity::Pga.of(&rooted, 0.0)?;
            return json(motions::scaled(&case.motion.base, amount * r.acceleration() / pga));
        }
        "frequency" => return json(with_frequency(&case.motion.base, amount * r.frequency)?),
        _ => return json(with_amplitude(file, amount * r.length)?),
    };
    Ok(number(value))
}

/// κ where head joints bear compression alone, else 1.
fn head_rigidity(file: &CaseFile) -> f64 {
    let head = &file.case.joint.head;
    if head.law.is_no_tension() { head.rigidity } else { 1.0 }
}

fn with_frequency(signal: &Signal, omega: f64) -> Result<Signal> {
    let Some(now) = frequency(signal).filter(|_| omega > 0.0) else {
        let error = InputError::new("the motion of the base has no frequency that could be changed");
        return Err(error.allowed("a sine or a pulse, and a value above 0").into());
    };
    let ratio = omega / (std::f64::consts::TAU * now);
    let mut signal = signal.clone();
    match &mut signal {
        Signal::Sine(sine) => {
            sine.frequency = Frequency::from_si(sine.frequency.si() * ratio);
            sine.ramp = Time::from_si(sine.ramp.si() / ratio);
        }
        Signal::Pulse(pulse) => {
            pulse.duration = Time::from_si(pulse.duration.si() / ratio);
            pulse.start = Time::from_si(pulse.start.si() / ratio);
        }
        _ => {}
    }
    Ok(signal)
}

fn with_amplitude(file: &CaseFile, amplitude: f64) -> Result<Signal> {
    let case = &file.case;
    let (Beam::Driven, Some(now)) = (case.load.beam, top_amplitude(case).filter(|u| *u > 0.0)) else {
        let error = InputError::new("the top is not driven by a displacement");
        return Err(error.allowed("a driven beam, moved by a path, or a sine or ramp with an `amplitude`").into());
    };
    let mut top = case.motion.top.clone();
    match &mut top {
        Signal::Sine(sine) => sine.amplitude = sine.amplitude.map(|u| Length::from_si(u.si() * amplitude / now)),
        Signal::Ramp(ramp) => ramp.amplitude = Length::from_si(ramp.amplitude.si() * amplitude / now),
        path @ Signal::Path(_) => return Ok(motions::scaled(path, amplitude / now)),
        _ => {}
    }
    Ok(top)
}
