//! The numbers of a run that the terminal and the report both show.

use concio::outcome::{BondRow, Outcome, TieRow};
use concio::planar::{Collapsed, Failure};
use concio::record::StopReason;
use concio::store::JointRow;
use concio::wall::Wall;
use serde_json::Value;

use crate::format::{clock, si, significant};

/// What is less than this fraction of the largest value of its kind is rounding, and is told as 0.
const ROUNDING: f64 = 1e-9;
/// Displacement that is none [m]: the floor below which the solver sees no errors, unless the file gives another.
const NOWHERE: f64 = 1e-14;

/// Names and values, the important ones first.
pub fn rows(wall: &Wall, joints: &[JointRow], outcome: &Outcome, summary: &Value) -> Vec<(&'static str, String)> {
    let (totals, energies) = (&outcome.totals, &outcome.energies);
    let number = |pointer: &str| summary.pointer(pointer).and_then(Value::as_f64).unwrap_or(f64::NAN);
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let moved = totals.peak_relative_displacement;
    let moved = if moved < NOWHERE { 0.0 } else { moved };
    let length = |value: f64| si(beside(value, moved), "m");
    let velocity = beside(totals.peak_slip_velocity, largest(&outcome.envelopes.block_velocity));
    let opening = largest(&outcome.envelopes.joint_opening);
    // In the shear model bed joints cannot open.
    let (opens, deepest) = match outcome.layout.touching {
        0 => ("head joints", 0.0 - totals.minimum_gap),
        _ => ("joints", largest(&outcome.envelopes.joint_closing)),
    };
    let mut rows = vec![
        ("peak displacement", peak(wall, outcome, moved)),
        ("peak slip velocity", si(velocity, "m/s")),
        (opens, format!("opened {}, pressed in {}", length(opening), length(deepest))),
    ];
    if let Some(failure) = failure(summary) {
        rows.push(("failure", failure));
    }
    let devices = joints.iter().filter(|j| j.device.is_some()).count();
    if devices > 0 {
        let taken = joints.iter().zip(&outcome.envelopes.joint_dissipation).filter(|(j, _)| j.device.is_some());
        let taken = si(taken.map(|(_, energy)| energy).sum(), "J");
        rows.push(("devices", format!("{devices} of {} joints, dissipated {taken}", joints.len())));
    }
    let bonds = &outcome.bonds;
    if !bonds.is_empty() {
        let cracked = bonds.iter().filter(|b| b.damage > 0.0).count();
        let broken = bonds.iter().filter(|b| b.damage == 1.0).count();
        rows.push(("bonds", format!("{cracked} of {} cracked, {broken} broken", bonds.len())));
        if let Some(first) = outcome.first_crack() {
            let name = joints.get(first.joint).map_or("", |j| j.name.as_str());
            rows.push(("  first crack", first_crack(bonds, first.cracked, name)));
        }
    }
    if let Some(ties) = ties(&outcome.ties) {
        rows.push(("ties", ties));
    }
    if let Some(collapse) = collapse(summary) {
        rows.push(("collapse", collapse));
    }
    let (shear, load) = (number("/base_shear_peak"), number("/base_load"));
    if shear > 0.0 {
        let share = significant(shear / load, 4);
        rows.push(("largest base shear", format!("{}, {share} of the vertical force at rest", si(shear, "N"))));
    }
    if totals.top_force_peak > 0.0 {
        let rms = si(number("/top_force_rms"), "N");
        rows.push(("force of the top beam", format!("{} peak, {rms} rms", si(totals.top_force_peak, "N"))));
    }
    if energies.initial != 0.0 {
        rows.push(("energy at the start", si(energies.initial, "J")));
    }
    let work = totals.peak_input.max(energies.initial.abs());
    let energy = |value: f64| si(beside(value, work), "J");
    rows.push(("work done on the wall", energy(energies.input())));
    rows.push(("  kinetic", energy(energies.kinetic)));
    rows.push(("  elastic", energy(energies.elastic)));
    rows.push(("  damping", energy(energies.damping)));
    let creeps = concio::run::only_creeps(joints, outcome);
    rows.push((if creeps { "  friction (creep)" } else { "  friction" }, energy(energies.friction)));
    if energies.bond != 0.0 {
        rows.push(("  broken bonds", energy(energies.bond)));
    }
    if energies.device != 0.0 {
        rows.push(("  hysteresis of devices", si(energies.device, "J")));
    }
    if energies.impact != 0.0 {
        rows.push(("  impacts", energy(energies.impact)));
    }
    if energies.nonreciprocal != 0.0 {
        rows.push(("  unbalanced friction", energy(energies.nonreciprocal)));
    }
    rows.push(("energy residual", format!("{:.1e} of the largest work", residual(summary))));
    let counters = &outcome.counters;
    let mut steps = format!("{}, {} rejected, {} repeated", counters.steps, counters.rejected, counters.failed);
    if counters.unsolved > 0 {
        steps += &format!(", {} with contact left unsolved", counters.unsolved);
    }
    rows.push(("steps", steps));
    rows.push(("solver time", clock(number("/solve_seconds"))));
    rows
}

/// The peak displacement, of which block it was, and how far blocks are from their places when the wall comes to its end standing.
fn peak(wall: &Wall, outcome: &Outcome, moved: f64) -> String {
    let mut told = format!("{} relative to the base", si(moved, "m"));
    let farthest = wall.blocks.iter().zip(&outcome.envelopes.block_displacement).max_by(|a, b| a.1.total_cmp(b.1));
    if let Some((block, _)) = farthest.filter(|_| moved > 0.0) {
        told += &format!(", of {}", block.name);
        let last = outcome.history("peak/displacement").and_then(|history| history.last().copied());
        if let Some(last) = last.filter(|_| outcome.recording.collapse().is_none()) {
            told += &format!("; {} at the end", si(beside(last, moved), "m"));
        }
    }
    told
}

/// How a planar wall failed, in words.
fn failure(summary: &Value) -> Option<String> {
    let failure: Failure = serde_json::from_value(summary.get("failure")?.clone()).ok()?;
    if failure.modes.is_empty() {
        return Some("none".into());
    }
    let names: Vec<&str> = failure.modes.iter().map(|mode| mode.name()).collect();
    let part = |share: f64| format!("{:.0} %", 100.0 * share);
    let top = format!("top {} at t = {} s", si(failure.top, "m"), significant(failure.time, 4));
    let (turning, sliding) = (part(failure.rocking), part(failure.sliding));
    Some(format!("{}; {top}: {turning} of it turning, {sliding} planes that slid", names.join(", ")))
}

/// Which block of a planar wall fell first, and when.
fn collapse(summary: &Value) -> Option<String> {
    let collapse: Collapsed = serde_json::from_value(summary.get("collapse")?.clone()).ok()?;
    let (time, way) = (significant(collapse.time, 4), si(collapse.displacement, "m"));
    let (block, did) = (&collapse.block, collapse.what());
    let others = match collapse.fallen {
        None => String::new(),
        Some(1) => "; 1 block down at the end".into(),
        Some(fallen) => format!("; {fallen} blocks down at the end"),
    };
    Some(format!("t = {time} s: block {block} {did}, {way} from its place{others}"))
}

/// What the ties bore, and how many yielded.
fn ties(ties: &[TieRow]) -> Option<String> {
    let most = ties.iter().max_by(|a, b| a.force.total_cmp(&b.force))?;
    let yielded = ties.iter().filter(|t| t.yielded.is_finite()).count();
    let (force, count) = (si(most.force, "N"), ties.len());
    Some(format!("{force} at most, in that from {} to {}; {yielded} of {count} yielded", most.from, most.to))
}

/// `value`, or 0 where it is rounding beside `large`, the largest of its kind.
fn beside(value: f64, large: f64) -> f64 {
    if value.abs() <= ROUNDING * large.abs() && value.is_finite() { 0.0 } else { value }
}

/// When and where a bond cracked first, and how many with it: joints that are equal crack together but for rounding.
fn first_crack(bonds: &[BondRow], time: f64, name: &str) -> String {
    let together = bonds.iter().filter(|b| b.cracked <= time * (1.0 + ROUNDING)).count();
    let others = if together > 1 { format!(" and {} more", together - 1) } else { String::new() };
    format!("t = {} s, joint {name}{others}", significant(time, 4))
}

/// Residual of the energy account over the largest work.
pub fn residual(summary: &Value) -> f64 {
    summary.pointer("/energy/residual_relative").and_then(Value::as_f64).unwrap_or(f64::NAN)
}

/// What the user is warned of.
pub fn warnings(summary: &Value) -> impl Iterator<Item = &str> {
    summary.get("warnings").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str)
}

/// Why a run stopped early, and what to do about it.
pub fn why(reason: StopReason) -> &'static str {
    match reason {
        StopReason::Completed => "the end was reached",
        StopReason::Collapsed => "the wall collapsed, which `motion.stop_at` makes the end of the run",
        StopReason::Interrupted => "interrupted; what was computed is written, and the same command goes on from here",
        StopReason::StepTooShort => {
            "the step became too short for the tolerance; raise solver.tolerance or check the stiffnesses and masses"
        }
        StopReason::NotFinite => "a value became infinite; check the stiffnesses, the masses and the motion",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_that_crack_together_are_counted() {
        let cracked = |cracked: f64| BondRow { cracked, ..BondRow::default() };
        let bonds = [0.282_321_4, 0.282_321_400_000_01, 0.282_322, f64::INFINITY].map(cracked);
        assert_eq!(first_crack(&bonds, 0.282_321_4, "a|b"), "t = 0.2823 s, joint a|b and 1 more");
        assert_eq!(first_crack(&bonds[2..], 0.282_322, "c|d"), "t = 0.2823 s, joint c|d");
    }

    #[test]
    fn rounding_is_told_as_nothing() {
        assert_eq!([beside(1e-17, 1e-6), beside(-3e-16, 1e-6), beside(0.0, 0.0)], [0.0; 3]);
        assert_eq!([beside(2e-15, 1e-6), beside(1e-20, 1e-20)], [2e-15, 1e-20]);
        assert!(beside(f64::NAN, 1.0).is_nan() && beside(f64::INFINITY, f64::INFINITY).is_infinite());
    }
}
