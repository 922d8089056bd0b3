//! `summary.json`: the numbers of a run that other programs read.

use std::path::Path;

use serde_json::{Value, json};

use crate::case::JointKind;
use crate::error::{Error, Result};
use crate::failure;
use crate::files::{self, LARGEST_INPUT, read_input};
use crate::outcome::{Outcome, Push, TieRow};
use crate::record::Energies;
use crate::store::{JointRow, Provenance, digest};
use crate::wall::Wall;
use crate::warning::Warning;

/// What a run knows beside its outcome.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RunFacts {
    /// Duration asked for [s].
    pub duration: f64,
    /// Weight of all that has mass: blocks, and the top beam where it has one [N].
    pub weight: f64,
    /// Vertical force on the base at rest: weight of the blocks, and `load.top` [N].
    pub base_load: f64,
    /// Time by the clock that solving took [s], since the resume if there was one.
    pub solve_seconds: f64,
    /// Time from which a run that had been cut off was taken up [s].
    pub resumed_from: Option<f64>,
    /// What became of a push, where the run is one.
    pub push: Option<Push>,
    /// What moved when the first bond cracked.
    pub at_first_crack: Option<Moving>,
    /// What the user should know.
    pub warnings: Vec<Warning>,
}

/// What a run is moved by at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moving {
    /// Horizontal acceleration of the base [m/s²].
    pub acceleration: f64,
    /// Displacement of a driven top beam relative to the base [m].
    pub beam: Option<f64>,
}

/// The content of summary.json; keys and units in docs/results.md. A value that is not finite becomes `null`, because
/// JSON knows no other.
pub fn summary(
    provenance: &Provenance,
    wall: &Wall,
    joints: &[JointRow],
    outcome: &Outcome,
    facts: &RunFacts,
) -> Value {
    let totals = &outcome.totals;
    let graph: Vec<_> = joints.iter().map(|row| row.joint.clone()).collect();
    let mut summary = json!({
        "blocks": wall.blocks.len(),
        "joints": joints.len(),
        // A mechanism has one unknown, its turn.
        "unknowns": if outcome.rocking.is_some() { 1 } else { outcome.layout.unknowns + 2 * outcome.layout.turned },
        "weight": facts.weight,
        "base_load": facts.base_load,
        "model": provenance.model,
        "duration": facts.duration,
        "time_reached": outcome.time_reached,
        "stop_reason": outcome.stop_reason,
        "steps": outcome.counters.steps,
        "solve_seconds": facts.solve_seconds,
        "resumed_from": facts.resumed_from,
        "peak_relative_displacement": totals.peak_relative_displacement,
        "peak_slip_velocity": totals.peak_slip_velocity,
        "top_work": outcome.energies.input_top,
        "base_shear_peak": totals.base_shear_peak,
        "base_shear_time": totals.base_shear_time,
        "base_shear_displacement": totals.base_shear_displacement,
        "push": facts.push,
        "drift": drift(outcome),
        "slide": slide(outcome, joints),
        "top_force_peak": totals.top_force_peak,
        "top_force_rms": top_force_rms(outcome),
        "minimum_gap": totals.minimum_gap,
        "contact_residual": totals.contact_residual,
        "collapse": failure::Collapsed::of(outcome, wall),
        "failure": failure::failure(wall, &graph, &outcome.recording),
        "bonds": bonds(outcome, joints, facts.at_first_crack),
        "ties": ties(outcome),
        "rocking": outcome.rocking,
        "devices": devices(outcome, joints),
        "energy": energy(&outcome.energies, residual_relative(outcome)),
        "counters": outcome.counters,
        "inputs_hash": provenance.inputs_hash,
        "version": provenance.version,
        "warnings": facts.warnings.iter().map(|w| &w.text).collect::<Vec<_>>(),
        "warning_kinds": facts.warnings.iter().map(|w| w.kind).collect::<Vec<_>>(),
    });
    unsign_zeros(&mut summary);
    summary
}

/// A zero has no sign.
fn unsign_zeros(value: &mut Value) {
    match value {
        Value::Number(number) if number.as_f64() == Some(0.0) && number.is_f64() => *value = json!(0.0),
        Value::Array(values) => values.iter_mut().for_each(unsign_zeros),
        Value::Object(values) => values.values_mut().for_each(unsign_zeros),
        _ => {}
    }
}

/// Writes a summary, its digest in it ([`digest::seal`]): whole or not at all.
///
/// # Errors
/// [`Error::Io`] when the disk fails.
pub fn write_summary(path: &Path, summary: &Value) -> Result<()> {
    let mut summary = summary.clone();
    digest::seal(&mut summary);
    let text = serde_json::to_string_pretty(&summary);
    let mut text = text.map_err(|e| Error::Store { path: path.to_path_buf(), what: e.to_string() })?;
    text.push('\n');
    files::replace_bytes(path, text.as_bytes())
}

/// Reads a summary, without its digest.
///
/// # Errors
/// [`Error::Store`] when it is no JSON, or not what was written; [`Error::Io`] when it cannot be read.
pub fn read_summary(path: &Path) -> Result<Value> {
    let wrong = |what: String| Error::Store { path: path.to_path_buf(), what };
    let bytes = read_input(path, LARGEST_INPUT).map_err(|e| wrong(e.to_string()))?;
    let summary: Value = serde_json::from_slice(&bytes).map_err(|e| wrong(format!("it is no JSON: {e}")))?;
    digest::opened(summary).ok_or_else(|| wrong(digest::CHANGED.into()))
}

/// Whether a file is the summary of a run, whole or damaged.
pub fn is_summary(path: &Path) -> bool {
    let text = read_input(path, LARGEST_INPUT).ok();
    let summary = text.and_then(|bytes| serde_json::from_slice::<Value>(&bytes).ok());
    summary.is_some_and(|summary| summary.get("inputs_hash").is_some())
}

/// [`crate::outcome::Totals::residual_relative`] of the whole run.
pub fn residual_relative(outcome: &Outcome) -> f64 {
    outcome.totals.residual_relative(outcome.energies.initial)
}

/// Root mean square of the force of the top beam over the time reached, until a collapse at the longest [N].
pub fn top_force_rms(outcome: &Outcome) -> f64 {
    let totals = &outcome.totals;
    let time = totals.collapse.map_or(f64::INFINITY, |collapse| collapse.time).min(outcome.time_reached);
    if time > 0.0 { (totals.top_force_square / time).sqrt() } else { 0.0 }
}

/// How far the top went that went farthest over its height.
fn drift(outcome: &Outcome) -> Value {
    let Some(row) = outcome.worst_drift() else { return Value::Null };
    json!({
        "top": row.top,
        "height": row.height,
        "peak": row.ratio(row.peak),
        "displacement": row.peak,
        "time": row.time,
        "residual": row.ratio(row.residual),
        "swing": row.ratio(row.swing),
    })
}

/// Which joint of a shear wall slid farthest over its overlap, or over the length of all that lies on the base or under the top; devices are to move. Null
/// of planar walls, whose joints follow.
fn slide(outcome: &Outcome, joints: &[JointRow]) -> Value {
    if outcome.layout.touching > 0 {
        return Value::Null;
    }
    let moved = joints.iter().zip(&outcome.envelopes.joint_displacement);
    let flat = moved.filter(|(row, _)| !row.joint.kind.is_upright() && row.device.is_none());
    let length = |own: &JointRow| match own.joint.kind {
        JointKind::Bed => own.joint.overlap,
        kind => joints.iter().filter(|row| row.joint.kind == kind).map(|row| row.joint.overlap).sum(),
    };
    let slid = flat.map(|(row, d)| (row, *d, d / length(row)));
    let Some((row, displacement, ratio)) = slid.max_by(|a, b| a.2.total_cmp(&b.2)) else { return Value::Null };
    json!({ "joint": row.name, "kind": row.joint.kind, "displacement": displacement, "of_overlap": ratio })
}

/// How many bonds cracked and broke, and which was the first; null where no joint is bonded.
fn bonds(outcome: &Outcome, joints: &[JointRow], moving: Option<Moving>) -> Value {
    let bonds = &outcome.bonds;
    if bonds.is_empty() {
        return Value::Null;
    }
    let first = outcome.first_crack();
    json!({
        "joints": bonds.len(),
        "cracked": bonds.iter().filter(|b| b.damage > 0.0).count(),
        "broken": bonds.iter().filter(|b| b.damage == 1.0).count(),
        "first_crack": first.map(|b| b.cracked),
        "first_joint": first.and_then(|b| joints.get(b.joint)).map(|j| &j.name),
        "first_acceleration": moving.map(|m| m.acceleration),
        "first_beam": moving.and_then(|m| m.beam),
    })
}

/// How many joints have a device, and what these took; null where none has.
fn devices(outcome: &Outcome, joints: &[JointRow]) -> Value {
    let taken = joints.iter().zip(&outcome.envelopes.joint_dissipation).filter(|(row, _)| row.device.is_some());
    let (count, taken) = taken.fold((0, 0.0), |(count, sum), (_, taken)| (count + 1, sum + taken));
    if count == 0 { Value::Null } else { json!({ "joints": count, "dissipated": taken }) }
}

/// What each tie bore; null where there are none.
fn ties(outcome: &Outcome) -> Value {
    let row = |tie: &TieRow| {
        json!({
            "from": tie.from,
            "to": tie.to,
            "peak_force": tie.force,
            "yielded": tie.yielded,
            "stretch": tie.stretch,
        })
    };
    if outcome.ties.is_empty() { Value::Null } else { outcome.ties.iter().map(row).collect() }
}

fn energy(energies: &Energies, residual_relative: f64) -> Value {
    json!({
        "initial": energies.initial,
        "input": energies.input(),
        "kinetic": energies.kinetic,
        "elastic": energies.elastic,
        "damping": energies.damping,
        "friction": energies.friction,
        "bond": energies.bond,
        "device": energies.device,
        "impact": energies.impact,
        "nonreciprocal": energies.nonreciprocal,
        "residual_relative": residual_relative,
    })
}
