//! The numbers of a run that the terminal and the report both show.

use concio::outcome::{Outcome, TieRow};
use concio::record::StopReason;
use concio::store::JointRow;
use concio::wall::Wall;
use serde_json::Value;

use crate::format::{clock, exponent, si};

mod head;

pub use head::{Answer, head};

/// What is less than this fraction of the largest value of its kind is rounding, and is told as 0.
const ROUNDING: f64 = 1e-9;
/// Relative displacement of a bed joint over its overlap, of base and top over all that lies there, from which a shear wall has slid far: its joints stay
/// as they were laid.
const LARGE_SLIDE: f64 = 0.1;
/// Displacement that is none [m]: the floor below which the solver sees no errors, unless the file gives another.
const NOWHERE: f64 = 1e-14;

/// Names and values of what is told after the head.
pub fn rows(wall: &Wall, joints: &[JointRow], outcome: &Outcome, summary: &Value) -> Vec<(&'static str, String)> {
    let (totals, energies) = (&outcome.totals, &outcome.energies);
    let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let moved = moved(outcome);
    let length = |value: f64| si(beside(value, moved), "m");
    let velocity = beside(totals.peak_slip_velocity, largest(&outcome.envelopes.block_velocity));
    let opening = largest(&outcome.envelopes.joint_opening);
    // In the shear model bed joints cannot open.
    let (opens, deepest) = match outcome.layout.touching {
        0 => ("head joints", 0.0 - totals.minimum_gap),
        _ => ("joints", largest(&outcome.envelopes.joint_closing)),
    };
    let mut rows = vec![("peak displacement", peak(wall, outcome, moved))];
    // Hinges do not slide.
    if outcome.rocking.is_none() {
        rows.push(("peak slip velocity", si(velocity, "m/s")));
    }
    rows.push((opens, format!("opened {}, pressed in {}", length(opening), length(deepest))));
    let [base, weight] = ["/base_load", "/weight"].map(|key| number(summary, key));
    let load = beside(base - weight, base);
    if load > 0.0 {
        let told = format!(
            "{} on the base at rest, {} of it load beside the weight of wall and beam",
            si(base, "N"),
            si(load, "N")
        );
        rows.push(("vertical force", told));
    }
    if let Some(push) = summary.get("push").filter(|push| !push.is_null()) {
        let stiffness = si(number(push, "/stiffness"), "N/m");
        let ultimate = push.get("ultimate").and_then(Value::as_f64);
        let borne = match ultimate {
            Some(ultimate) => format!("four fifths of it borne until {} at the top", si(ultimate, "m")),
            None if outcome.totals.collapse.is_some() => "it did not fall by a fifth before the wall collapsed".into(),
            None => "it never fell by a fifth".into(),
        };
        rows.push(("peak of the push", format!("secant stiffness {stiffness}, {borne}")));
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
    }
    if let Some(ties) = ties(&outcome.ties) {
        rows.push(("ties", ties));
    }
    if totals.top_force_peak > 0.0 {
        let rms = si(number(summary, "/top_force_rms"), "N");
        rows.push(("force of the top beam", format!("{} peak, {rms} rms", si(totals.top_force_peak, "N"))));
    }
    if energies.initial != 0.0 {
        rows.push(("energy at the start", si(energies.initial, "J")));
    }
    let work = totals.peak_work.max(energies.initial.abs());
    let energy = |value: f64| si(beside(value, work), "J");
    rows.push(("work done on the wall", energy(energies.input())));
    rows.push(("  kinetic", energy(energies.kinetic)));
    rows.push(("  elastic", energy(energies.elastic)));
    rows.push(("  damping", energy(energies.damping)));
    let creeps = concio::run::only_creeps(joints, outcome);
    rows.push((if creeps { "  friction (creep)" } else { "  friction" }, energy(energies.friction)));
    if energies.bond != 0.0 {
        let lost = if outcome.rocking.is_some() { "  floors that fell" } else { "  broken bonds" };
        rows.push((lost, energy(energies.bond)));
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
    rows.push(("energy residual", format!("{} of the largest work", exponent(residual(summary), 1))));
    let counters = &outcome.counters;
    let mut steps = format!("{}, {} rejected, {} repeated", counters.steps, counters.rejected, counters.failed);
    if counters.unsolved > 0 {
        steps += &format!(", {} with contact left unsolved", counters.unsolved);
    }
    rows.push(("steps", steps));
    rows.push(("solver time", clock(number(summary, "/solve_seconds"))));
    rows
}

/// The peak displacement, of which block it was, and how far blocks are from their places when the wall comes to its end standing.
fn peak(wall: &Wall, outcome: &Outcome, moved: f64) -> String {
    let mut told = format!("{} relative to the base", si(moved, "m"));
    if !outcome.stop_reason.is_end() {
        told += " before the run stopped early";
    }
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

/// What the ties bore, and how many yielded.
fn ties(ties: &[TieRow]) -> Option<String> {
    let most = ties.iter().max_by(|a, b| a.force.total_cmp(&b.force))?;
    let yielded = ties.iter().filter(|t| t.yielded.is_finite()).count();
    let (force, count) = (si(most.force, "N"), ties.len());
    Some(format!("{force} at most, in that from {} to {}; {yielded} of {count} yielded", most.from, most.to))
}

fn number(summary: &Value, pointer: &str) -> f64 {
    summary.pointer(pointer).and_then(Value::as_f64).unwrap_or(f64::NAN)
}

/// The largest displacement of a block, 0 where it is none [m].
fn moved(outcome: &Outcome) -> f64 {
    let moved = outcome.totals.peak_relative_displacement;
    if moved < NOWHERE { 0.0 } else { moved }
}

/// `value`, or 0 where it is rounding beside `large`, the largest of its kind.
fn beside(value: f64, large: f64) -> f64 {
    if value.abs() <= ROUNDING * large.abs() && value.is_finite() { 0.0 } else { value }
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
pub fn why(reason: StopReason, rocks: bool) -> &'static str {
    match reason {
        StopReason::Collapsed if rocks => "the wall lies on the ground",
        StopReason::Completed => "the end was reached",
        StopReason::Collapsed => "the wall collapsed, which `motion.stop_at` makes the end of the run",
        StopReason::Interrupted => "interrupted; what was computed is written, and the same command goes on from here",
        StopReason::StepTooShort => {
            "the step became too short for the tolerance; raise solver.tolerance, take `law = \"stribeck-stick\"` for friction of law `coulomb` with \
             `dynamic` below `static`, or check the stiffnesses and masses"
        }
        StopReason::Airborne => {
            "the ground falls faster than the wall would: nothing presses on its hinge; look at motion.vertical"
        }
        StopReason::NotFinite => "a value became infinite; check the stiffnesses, the masses and the motion",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_told_as_nothing() {
        assert_eq!([beside(1e-17, 1e-6), beside(-3e-16, 1e-6), beside(0.0, 0.0)], [0.0; 3]);
        assert_eq!([beside(2e-15, 1e-6), beside(1e-20, 1e-20)], [2e-15, 1e-20]);
        assert!(beside(f64::NAN, 1.0).is_nan() && beside(f64::INFINITY, f64::INFINITY).is_infinite());
    }
}
