//! The numbers of a run that the terminal and the report both show.

use concio::outcome::Outcome;
use concio::record::StopReason;
use concio::store::JointRow;
use serde_json::Value;

use crate::format::{clock, si};

/// Names and values, the important ones first.
pub fn rows(outcome: &Outcome, joints: &[JointRow], summary: &Value) -> Vec<(&'static str, String)> {
    let (totals, energies) = (&outcome.totals, &outcome.energies);
    let number = |pointer: &str| summary.pointer(pointer).and_then(Value::as_f64).unwrap_or(f64::NAN);
    let opening = outcome.envelopes.joint_opening.iter().copied().fold(0.0, f64::max);
    let mut rows = vec![
        ("peak displacement", format!("{} relative to the base", si(totals.peak_relative_displacement, "m"))),
        ("peak slip velocity", si(totals.peak_slip_velocity, "m/s")),
        ("head joints", format!("opened {}, pressed in {}", si(opening, "m"), si(0.0 - totals.minimum_gap, "m"))),
    ];
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
            rows.push(("  first crack", format!("t = {}, joint {name}", crate::format::seconds(first.cracked))));
        }
    }
    if totals.top_force_peak > 0.0 {
        let rms = si(number("/top_force_rms"), "N");
        rows.push(("force of the top beam", format!("{} peak, {rms} rms", si(totals.top_force_peak, "N"))));
    }
    if energies.initial != 0.0 {
        rows.push(("energy at the start", si(energies.initial, "J")));
    }
    rows.push(("work done on the wall", si(energies.input(), "J")));
    rows.push(("  kinetic", si(energies.kinetic, "J")));
    rows.push(("  elastic", si(energies.elastic, "J")));
    rows.push(("  damping", si(energies.damping, "J")));
    let creeps = concio::run::only_creeps(joints, outcome);
    rows.push((if creeps { "  friction (creep)" } else { "  friction" }, si(energies.friction, "J")));
    if energies.bond != 0.0 {
        rows.push(("  broken bonds", si(energies.bond, "J")));
    }
    if energies.device != 0.0 {
        rows.push(("  devices", si(energies.device, "J")));
    }
    if energies.impact != 0.0 {
        rows.push(("  impacts", si(energies.impact, "J")));
    }
    if energies.nonreciprocal != 0.0 {
        rows.push(("  unbalanced friction", si(energies.nonreciprocal, "J")));
    }
    rows.push(("energy residual", format!("{:.1e} of the largest work", residual(summary))));
    let counters = &outcome.counters;
    rows.push(("steps", format!("{}, {} rejected, {} repeated", counters.steps, counters.rejected, counters.failed)));
    rows.push(("solver time", clock(number("/solve_seconds"))));
    rows
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
        StopReason::Interrupted => "interrupted; what was computed is written, and the same command goes on from here",
        StopReason::StepTooShort => {
            "the step became too short for the tolerance; raise solver.tolerance or check the stiffnesses and masses"
        }
        StopReason::NotFinite => "a value became infinite; check the stiffnesses, the masses and the motion",
    }
}
