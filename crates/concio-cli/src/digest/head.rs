//! What is asked first of a run: how it failed, when it cracked, whether it fell, how far it leaned, what it bore.

use concio::bond::BondRow;
use concio::drift::BEAM;
use concio::failure::{Collapsed, Failure};
use concio::outcome::Outcome;
use concio::store::JointRow;
use serde_json::Value;

use super::{LARGE_SLIDE, ROUNDING, beside, number};
use crate::format::{counted, percent, si, significant};

/// Part of d0 at life safety (Circolare, C8.7.1.2.1.6).
const LIFE: f64 = 0.4;

/// An answer: the one word or number that is looked for, and what belongs to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// What is asked.
    pub name: &'static str,
    /// The word or number.
    pub value: String,
    /// When, where and of what; empty where nothing is to be added.
    pub note: String,
    /// Whether it is one to worry about.
    pub grave: bool,
}

impl Answer {
    fn new(name: &'static str, value: impl Into<String>, note: impl Into<String>) -> Self {
        Answer { name, value: value.into(), note: note.into(), grave: false }
    }

    fn grave(self, grave: bool) -> Self {
        Answer { grave, ..self }
    }

    /// In one line.
    pub fn line(&self) -> String {
        let Answer { value, note, .. } = self;
        // What a number is one of follows it without a comma.
        let apart = if note.is_empty() || note.starts_with("of ") { " " } else { ", " };
        format!("{value}{apart}{note}").trim_end().into()
    }
}

/// The answers, in the order in which they are asked.
pub fn head(joints: &[JointRow], outcome: &Outcome, summary: &Value) -> Vec<Answer> {
    if let Some(rocking) = summary.get("rocking").filter(|rocking| !rocking.is_null()) {
        return of_rocking(outcome, rocking);
    }
    let planar = outcome.layout.touching > 0;
    vec![
        if planar { failure(outcome, summary) } else { slide(outcome, summary) },
        first_crack(joints, outcome, summary),
        if planar {
            collapse(outcome, summary)
        } else {
            Answer::new("collapse", "–", "a shear wall cannot: its blocks move horizontally alone")
        },
        peak_drift(outcome),
        residual_drift(outcome),
        base_shear(outcome, summary),
    ]
}

/// The answers of a wall that rocks out of its plane.
fn of_rocking(outcome: &Outcome, rocking: &Value) -> Vec<Answer> {
    let of = |key: &str| rocking.get(key).and_then(Value::as_f64);
    let told = |key: &str, digits| of(key).map_or("–".into(), |v| significant(v, digits));
    let hinge = format!("hinge at {}, sets off at α = {}", si(of("hinge").unwrap_or(0.0), "m"), told("multiplier", 4));
    let kind = rocking.get("mechanism").and_then(Value::as_str).unwrap_or("–");
    let lifts = match of("first_lift_off") {
        Some(time) => {
            let [lifts, impacts] =
                ["lift_offs", "impacts"].map(|key| rocking.get(key).and_then(Value::as_u64).unwrap_or_default());
            Answer::new("first lift-off", at(time), format!("{lifts} from rest, {impacts} impacts")).grave(true)
        }
        None => Answer::new("first lift-off", "none", "the wall rests"),
    };
    let collapse = match outcome.totals.collapse {
        Some(collapse) => Answer::new("collapse", at(collapse.time), "the wall lies on the ground").grave(true),
        None => Answer::new("collapse", "none", format!("until t = {} s", significant(outcome.time_reached, 4))),
    };
    let peak = outcome.worst_drift().map_or(0.0, |row| row.peak);
    let side = if peak < 0.0 { "inwards" } else { "outwards" };
    // The turn is told over θ0 of its own side; d_C0 is where the control point is then.
    let other = if peak < 0.0 { " outwards" } else { "" };
    let d0 = of("d0").map_or("its weights hold at any turn".into(), |d0| format!("d_C0 = {}{other}", si(d0, "m")));
    let over = of("peak_over_d0");
    let turn = over.map_or("–".into(), |over| format!("{} θ0", significant(over, 4)));
    let note = format!("{} at the control point, {side}; {d0}", si(peak.abs(), "m"));
    let turn = Answer::new("peak turn", turn, note).grave(over.is_some_and(|over| over > LIFE));
    vec![
        Answer::new("mechanism", kind, hinge),
        lifts,
        collapse,
        turn,
        residual_drift(outcome),
        Answer::new("base shear", si(outcome.totals.base_shear_peak, "N"), at(outcome.totals.base_shear_time)),
    ]
}

/// A time of the run.
fn at(time: f64) -> String {
    format!("t = {} s", significant(time, 4))
}

/// How a planar wall failed.
fn failure(outcome: &Outcome, summary: &Value) -> Answer {
    let found = summary.get("failure").filter(|f| !f.is_null());
    let Some(failure) = found.and_then(|f| serde_json::from_value::<Failure>(f.clone()).ok()) else {
        return Answer::new("failure", "not known", "the run kept no frames (output.frames)");
    };
    if failure.modes.is_empty() {
        return cracked(outcome).unwrap_or_else(|| Answer::new("failure", "none", ""));
    }
    let names: Vec<&str> = failure.modes.iter().map(|mode| mode.name()).collect();
    let part = |share: f64| format!("{:.0} %", 100.0 * share);
    let (turning, sliding, top) = (part(failure.rocking), part(failure.sliding), si(failure.top, "m"));
    let note = format!("{}: of {top} at the top, {turning} is turning, {sliding} planes that slid", at(failure.time));
    Answer::new("failure", names.join(", "), note).grave(true)
}

/// What a shear wall has in the place of a mode of failure: joints that slid or cracked.
fn slide(outcome: &Outcome, summary: &Value) -> Answer {
    let of = |key: &str| summary.pointer(&format!("/slide/{key}"));
    let share = of("of_overlap").and_then(Value::as_f64).unwrap_or(0.0);
    let (way, joint) = (of("displacement").and_then(Value::as_f64).unwrap_or(0.0), of("joint").and_then(Value::as_str));
    let over = match of("kind").and_then(Value::as_str) {
        Some(kind @ ("base" | "top")) => format!("of what lies on the {kind}, at"),
        _ => "of the overlap of".into(),
    };
    let slid = format!("{}, {} {over} {}", si(way, "m"), percent(share), joint.unwrap_or("–"));
    if share > LARGE_SLIDE {
        return Answer::new("failure", "slid far", format!("by {slid}")).grave(true);
    }
    if let Some(cracked) = cracked(outcome) {
        return cracked;
    }
    let slips = outcome.envelopes.joint_slip.iter().any(|slip| *slip > 0.0);
    let note = if slips { format!("joints slid by at most {slid}") } else { "no joint slid or cracked".into() };
    // What had not happened when a run broke off may have happened next.
    let value = if outcome.stop_reason.is_end() { "none" } else { "–" };
    Answer::new("failure", value, note + &until(outcome))
}

/// How many bonds cracked, where some did and no more came of it.
fn cracked(outcome: &Outcome) -> Option<Answer> {
    let count = |is: fn(&BondRow) -> bool| outcome.bonds.iter().filter(|bond| is(bond)).count();
    let (cracked, broken) = (count(|b| b.damage > 0.0), count(|b| b.damage == 1.0));
    let note = format!("{cracked} of {} bonded joints, {broken} of them broken", outcome.bonds.len());
    (cracked > 0).then(|| Answer::new("failure", "cracked", note).grave(true))
}

/// Of a run that stopped early, how far what it says goes.
fn until(outcome: &Outcome) -> String {
    let stopped = || format!(" before the run stopped early, {}", at(outcome.time_reached));
    if outcome.stop_reason.is_end() { String::new() } else { stopped() }
}

/// When and where a bond cracked first, and how many with it: joints that are equal crack together but for rounding.
fn first_crack(joints: &[JointRow], outcome: &Outcome, summary: &Value) -> Answer {
    let bonds = &outcome.bonds;
    let Some(first) = outcome.first_crack() else {
        let why =
            if bonds.is_empty() { "no joint is bonded".into() } else { format!("of {} bonded joints", bonds.len()) };
        return Answer::new("first crack", "none", why);
    };
    let name = joints.get(first.joint).map_or("", |j| j.name.as_str());
    let mut note = together(bonds, first.cracked, name);
    let of = |key: &str| summary.pointer(&format!("/bonds/{key}")).and_then(Value::as_f64);
    if first.cracked == 0.0 {
        note += ", under its loads before the motion";
    } else if let Some(beam) = of("first_beam") {
        note += &format!(", top beam at {}", si(beam, "m"));
    } else if let Some(acceleration) = of("first_acceleration") {
        note += &format!(", base at {} g", significant(acceleration / concio::G, 4));
    }
    Answer::new("first crack", at(first.cracked), note).grave(true)
}

fn together(bonds: &[BondRow], time: f64, name: &str) -> String {
    let together = bonds.iter().filter(|b| b.cracked <= time * (1.0 + ROUNDING)).count();
    let others = if together > 1 { format!(" and {} more", together - 1) } else { String::new() };
    format!("joint {name}{others}")
}

/// Which block of a planar wall fell first, and when.
fn collapse(outcome: &Outcome, summary: &Value) -> Answer {
    let found = summary.get("collapse").filter(|c| !c.is_null());
    let Some(collapse) = found.and_then(|c| serde_json::from_value::<Collapsed>(c.clone()).ok()) else {
        return Answer::new("collapse", "none", format!("until t = {} s", significant(outcome.time_reached, 4)));
    };
    let way = si(collapse.displacement, "m");
    let down = collapse.fallen.map_or(String::new(), |n| format!("; {} down at the end", counted(n, "block")));
    let note = format!("block {} {}, {way} from its place{down}", collapse.block, collapse.what());
    Answer::new("collapse", at(collapse.time), note).grave(true)
}

/// How far the top went that went farthest over its height.
fn peak_drift(outcome: &Outcome) -> Answer {
    let Some(row) = outcome.worst_drift() else { return Answer::new("peak drift", "–", "") };
    let peak = moved(outcome, row.peak);
    if peak == 0.0 {
        return Answer::new("peak drift", "0", format!("the top did not move{}", until(outcome)));
    }
    let whose = match row.top.as_str() {
        BEAM => "top beam".into(),
        // That of a façade is its control point.
        _ if outcome.rocking.is_some() => "top".into(),
        _ if outcome.drifts.len() == 1 => "mean of the top course".into(),
        panel => format!("mean of the top course of panel {panel}"),
    };
    let note = format!("{}: {whose} at {} of {} height", at(row.time), si(peak, "m"), si(row.height, "m"));
    Answer::new("peak drift", percent(row.ratio(peak).abs()), note)
}

/// What is left of it at the end.
fn residual_drift(outcome: &Outcome) -> Answer {
    let name = "residual drift";
    let Some(row) = outcome.worst_drift() else { return Answer::new(name, "–", "") };
    if !row.residual.is_finite() {
        let why = match outcome.totals.collapse {
            Some(_) => "the wall collapsed",
            None => "the run stopped early",
        };
        return Answer::new(name, "–", why);
    }
    let [residual, swing] = [row.residual, row.swing].map(|way| row.ratio(moved(outcome, way)));
    let note = match swing {
        0.0 if residual == 0.0 => String::new(),
        0.0 => "at the end".into(),
        _ => format!("mean of the last tenth of the run, ± {}", percent(swing)),
    };
    Answer::new(name, percent(residual), note)
}

/// A displacement, 0 where it is rounding beside what the wall moved.
fn moved(outcome: &Outcome, way: f64) -> f64 {
    beside(way, super::moved(outcome))
}

/// What the base bore at most, over what presses on it.
fn base_shear(outcome: &Outcome, summary: &Value) -> Answer {
    let totals = &outcome.totals;
    let load = number(summary, "/base_load");
    let shear = beside(totals.base_shear_peak, load);
    let name = "peak base shear";
    if shear == 0.0 {
        return Answer::new(name, "0", "");
    }
    let top = si(moved(outcome, totals.base_shear_displacement), "m");
    let note =
        format!("of the vertical force at rest: {}, {}, top at {top}", si(shear, "N"), at(totals.base_shear_time));
    Answer::new(name, significant(shear / load, 4), note)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_that_crack_together_are_counted() {
        let cracked = |cracked: f64| BondRow { cracked, ..BondRow::default() };
        let bonds = [0.282_321_4, 0.282_321_400_000_01, 0.282_322, f64::INFINITY].map(cracked);
        assert_eq!(together(&bonds, 0.282_321_4, "a|b"), "joint a|b and 1 more");
        assert_eq!(together(&bonds[2..], 0.282_322, "c|d"), "joint c|d");
    }

    #[test]
    fn answers_are_lines() {
        let line = |value: &str, note: &str| Answer::new("", value, note).line();
        assert_eq!(line("none", ""), "none");
        assert_eq!(line("0.5", "of the weight: 3 kN"), "0.5 of the weight: 3 kN");
        assert_eq!(line("rocking", "t = 1 s"), "rocking, t = 1 s");
    }
}
