//! What a study keeps of a run: some numbers, two texts and, if asked for, values per joint.

use std::collections::BTreeMap;

use concio::bond::BondRow;
use concio::case::ModelKind;
use concio::outcome::{Outcome, RockingOutcome};
use concio::quantity::shown;
use concio::run::{Prepared, joint_rows, warnings_of};
use concio::store::{JointRow, residual_relative, top_force_rms};
use concio::warning::Warning;
use serde::{Deserialize, Serialize};

use crate::file::PerJoint;

/// Raised when a measure means something else than before: it stands in every row, and runs measured earlier are done again.
pub const VERSION: u32 = 9;

/// A number of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Measure {
    /// Its name in tables.
    pub name: &'static str,
    /// SI unit; empty for pure numbers.
    pub unit: &'static str,
    /// What it is.
    pub text: &'static str,
}

const fn measure(name: &'static str, unit: &'static str, text: &'static str) -> Measure {
    Measure { name, unit, text }
}

/// The numbers of a run, in the order of [`Row::numbers`].
pub const MEASURES: [Measure; 36] = [
    measure("time_reached", "s", "time at which the run ended"),
    measure("peak_displacement", "m", "largest |displacement| of a block relative to the base"),
    measure(
        "peak_drift",
        "",
        "largest |displacement| of a block of a top course, over the height of its top; `concio run` tells that of the beam or the mean of the course",
    ),
    measure("peak_joint_displacement", "m", "largest |relative displacement| of neighbouring blocks"),
    measure("peak_joint_velocity", "m/s", "largest |relative velocity| of neighbouring blocks"),
    measure("peak_joint_acceleration", "m/s²", "largest |relative acceleration| of neighbouring blocks"),
    measure("peak_slip_velocity", "m/s", "largest |relative velocity| of a bed or support joint"),
    measure("largest_slip", "m", "largest slip path of a joint; of a bonded one from its crack on"),
    measure("total_slip", "m", "slip paths of all joints together"),
    measure("largest_opening", "m", "widest gap of a head joint or connection, in planar walls of any joint"),
    measure("deepest_closing", "m", "deepest closure of a head joint or connection"),
    measure("peak_elastic_force", "N", "largest |elastic force| in a joint"),
    measure("peak_friction_force", "N", "largest |friction force| that a joint bears"),
    measure("peak_viscous_force", "N", "largest |viscous force| in a joint; of shear walls"),
    measure("peak_inertia_force", "N", "largest |mass times relative acceleration| of a block"),
    measure("top_force_peak", "N", "largest |force| of the top beam"),
    measure("top_force_rms", "N", "root mean square of the force of the top beam"),
    measure("top_work", "J", "work of a driven top beam"),
    measure("base_work", "J", "work of the base motion"),
    measure("kinetic_energy", "J", "kinetic energy at the end"),
    measure("elastic_energy", "J", "elastic energy at the end"),
    measure("damping_energy", "J", "dissipated by viscous damping"),
    measure("friction_energy", "J", "dissipated by friction"),
    measure("bond_energy", "J", "dissipated by the breaking of bonds"),
    measure("impact_energy", "J", "lost in impacts"),
    measure("energy_residual", "", "largest residual of the energy account over the largest energy in play"),
    measure("joints_cracked", "", "number of bonds that cracked"),
    measure("joints_broken", "", "number of bonds of which nothing was left"),
    measure("first_crack", "s", "time of the first crack"),
    measure("steps", "", "steps of the solver"),
    measure("device_energy", "J", "dissipated by the hysteresis of devices"),
    measure(
        "dissipated_energy",
        "J",
        "dissipated in all: by friction, damping, devices and breaking bonds, and in impacts",
    ),
    measure(
        "collapse",
        "s",
        "time at which a block of a planar wall had fallen or turned over, or at which a rocking wall lay on the ground",
    ),
    measure(
        "peak_over_d0",
        "",
        "farthest turn of a rocking wall, to either side, over that at which its weights hold no longer",
    ),
    measure("first_lift_off", "s", "time at which a rocking wall first left its position at rest"),
    measure("beyond_d0", "", "how often a rocking wall turned farther than its weights hold"),
];

/// Numbers of [`MEASURES`] that go on after a collapse; all others are those of the time before.
const GO_ON: [&str; 18] = [
    "first_lift_off",
    "beyond_d0",
    "time_reached",
    "top_work",
    "base_work",
    "kinetic_energy",
    "elastic_energy",
    "damping_energy",
    "friction_energy",
    "bond_energy",
    "impact_energy",
    "energy_residual",
    "joints_cracked",
    "joints_broken",
    "first_crack",
    "steps",
    "device_energy",
    "dissipated_energy",
];

/// Numbers of [`MEASURES`] that walls of the shear model alone have, and those that rocking walls alone have.
const OF_SHEAR: [&str; 1] = ["peak_viscous_force"];
const OF_ROCKING: [&str; 3] = ["peak_over_d0", "first_lift_off", "beyond_d0"];

/// Numbers of [`MEASURES`] that are 0 in every run of a rocking wall: it has hinges and ties in place of joints that slide, and no top beam.
const NOT_OF_ROCKING: [&str; 14] = [
    "peak_joint_displacement",
    "peak_joint_velocity",
    "peak_joint_acceleration",
    "peak_slip_velocity",
    "largest_slip",
    "total_slip",
    "deepest_closing",
    "peak_elastic_force",
    "peak_friction_force",
    "top_force_peak",
    "top_force_rms",
    "top_work",
    "joints_cracked",
    "joints_broken",
];

impl Measure {
    /// Whether runs of such walls have it.
    pub fn is_of(&self, model: ModelKind) -> bool {
        match model {
            ModelKind::Shear => !OF_ROCKING.contains(&self.name),
            ModelKind::Planar => !OF_SHEAR.contains(&self.name) && !OF_ROCKING.contains(&self.name),
            ModelKind::Rocking => !OF_SHEAR.contains(&self.name) && !NOT_OF_ROCKING.contains(&self.name),
        }
    }
}

/// Whether a measure of a planar run is that of the time before a collapse.
pub fn ends_with_collapse(name: &str) -> bool {
    !GO_ON.contains(&name)
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum End {
    /// It reached its end, or that which a collapse was to make.
    Completed,
    /// The solver stopped early; the numbers hold up to there.
    Stopped,
    /// It has no numbers.
    Failed,
}

/// What is kept of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What the run is known by.
    pub id: String,
    /// [`VERSION`] of the measures; 0 of rows older than that number.
    #[serde(default)]
    pub version: u32,
    /// How it ended.
    pub end: End,
    /// Why it stopped or failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cause: Option<String>,
    /// One value per entry of [`MEASURES`]; none where there is none. Empty when the run failed.
    pub numbers: Vec<Option<f64>>,
    /// Joint of the largest relative displacement.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_joint: Option<String>,
    /// Joint that cracked first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_joint: Option<String>,
    /// Digest of the whole result, where that is kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub result: Option<String>,
    /// What a user should know before believing it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
    /// Values per joint, in the order of the joints; none where there is none.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub joints: BTreeMap<PerJoint, Vec<Option<f64>>>,
}

impl Row {
    /// A run without numbers.
    pub fn failed(id: &str, cause: impl Into<String>) -> Self {
        Row {
            id: id.into(),
            version: VERSION,
            end: End::Failed,
            cause: Some(cause.into()),
            numbers: Vec::new(),
            peak_joint: None,
            first_joint: None,
            result: None,
            warnings: Vec::new(),
            joints: BTreeMap::new(),
        }
    }

    /// A number by name; none when the run has none, or there is no such measure.
    pub fn number(&self, name: &str) -> Option<f64> {
        let place = MEASURES.iter().position(|m| m.name == name)?;
        self.numbers.get(place).copied().flatten()
    }

    /// Whether it holds all of `keep` per joint.
    pub fn has(&self, keep: &[PerJoint]) -> bool {
        self.end == End::Failed || keep.iter().all(|k| self.joints.contains_key(k))
    }
}

/// Reads off a run what is kept of it.
pub fn row(id: &str, prepared: &Prepared, outcome: &Outcome, keep: &[PerJoint]) -> Row {
    let (end, cause) = match outcome.stop_reason {
        reason if reason.is_end() => (End::Completed, None),
        other => (End::Stopped, Some(format!("{other:?} at t = {} s", shown(outcome.time_reached)))),
    };
    let model = &prepared.model;
    let name = |e: usize| concio::graph::name(&model.wall, &model.joints[e]);
    let most = largest(&outcome.envelopes.joint_displacement);
    let rows = joint_rows(model);
    let numbers = numbers(prepared, outcome, &rows);
    Row {
        id: id.into(),
        version: VERSION,
        end,
        cause,
        numbers: numbers.into_iter().map(|v| v.is_finite().then_some(v)).collect(),
        peak_joint: most.map(name),
        first_joint: outcome.first_crack().map(|b| name(b.joint)),
        result: None,
        warnings: warnings_of(model, &rows, outcome),
        joints: keep.iter().map(|k| (*k, per_joint(*k, model.joints.len(), outcome))).collect(),
    }
}

/// Place of the largest value above 0, the first of several.
fn largest(values: &[f64]) -> Option<usize> {
    let above = values.iter().enumerate().filter(|(_, v)| **v > 0.0);
    above.reduce(|a, b| if b.1 > a.1 { b } else { a }).map(|(i, _)| i)
}

/// Columns of the table of runs beside factors and measures.
pub const OWN: [&str; 8] = ["run", "end", "peak_joint", "first_joint", "cause", "warnings", "warning_kinds", "id"];

/// Whether the table of runs has a column of this name besides those of its factors.
pub fn is_column(name: &str) -> bool {
    OWN.contains(&name) || MEASURES.iter().any(|m| m.name == name)
}

fn numbers(prepared: &Prepared, outcome: &Outcome, joints: &[JointRow]) -> [f64; MEASURES.len()] {
    let (model, envelopes, totals, energies) =
        (&prepared.model, &outcome.envelopes, &outcome.totals, &outcome.energies);
    let most = |values: &[f64]| values.iter().fold(0.0f64, |m, v| m.max(*v));
    let blocks = &model.wall.blocks;
    let highest = |panel: usize| blocks.iter().filter(|b| b.panel == panel).map(|b| b.course).max();
    let tops: Vec<Option<usize>> = (0..model.wall.panels.len()).map(highest).collect();
    let moved = blocks.iter().zip(&envelopes.block_displacement).filter(|(b, _)| tops[b.panel] == Some(b.course));
    let drift = moved.fold(0.0f64, |m, (b, u)| m.max(u / b.y[1]));
    // That of a rocking wall is the drift of its control point.
    let drift = match (&outcome.rocking, outcome.worst_drift()) {
        (Some(_), Some(row)) => row.ratio(row.peak).abs(),
        _ => drift,
    };
    let of_rocking = |of: &dyn Fn(&RockingOutcome) -> f64| outcome.rocking.as_ref().map_or(f64::NAN, of);
    // Dashpots of planar walls act while their joint is pressed, which envelopes do not tell.
    let viscous = match model.turns() {
        true => f64::NAN,
        false => joints.iter().zip(&envelopes.joint_velocity).fold(0.0f64, |most, (j, v)| most.max(j.damping * v)),
    };
    let inertia = model.shear.mass.iter().zip(&envelopes.block_acceleration).map(|(m, a)| m * a);
    let max = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0f64, f64::max);
    let cracked = |test: &dyn Fn(&BondRow) -> bool| outcome.bonds.iter().filter(|b| test(b)).count() as f64;
    [
        outcome.time_reached,
        totals.peak_relative_displacement,
        drift,
        most(&envelopes.joint_displacement),
        most(&envelopes.joint_velocity),
        most(&envelopes.joint_acceleration),
        totals.peak_slip_velocity,
        most(&envelopes.joint_slip),
        envelopes.joint_slip.iter().sum(),
        most(&envelopes.joint_opening),
        most(&envelopes.joint_closing),
        most(&envelopes.joint_force),
        totals.peak_friction_force,
        viscous,
        max(&mut { inertia }),
        totals.top_force_peak,
        top_force_rms(outcome),
        energies.input_top,
        energies.input_base,
        energies.kinetic,
        energies.elastic,
        energies.damping,
        energies.friction,
        energies.bond,
        energies.impact,
        residual_relative(outcome),
        cracked(&|b| b.damage > 0.0),
        cracked(&|b| b.damage == 1.0),
        outcome.first_crack().map_or(f64::INFINITY, |b| b.cracked),
        outcome.counters.steps as f64,
        energies.device,
        energies.dissipated(),
        totals.collapse.map_or(f64::INFINITY, |collapse| collapse.time),
        of_rocking(&|rocking| rocking.peak_over_d0),
        of_rocking(&|rocking| rocking.first_lift_off),
        of_rocking(&|rocking| rocking.beyond_d0 as f64),
    ]
}

fn per_joint(kind: PerJoint, joints: usize, outcome: &Outcome) -> Vec<Option<f64>> {
    let e = &outcome.envelopes;
    let of_bonds = |value: &dyn Fn(&BondRow) -> f64| {
        let mut all = vec![None; joints];
        for bond in &outcome.bonds {
            all[bond.joint] = Some(value(bond)).filter(|v| v.is_finite());
        }
        all
    };
    let plain = |values: &[f64]| values.iter().map(|v| Some(*v)).collect();
    match kind {
        PerJoint::Displacement => plain(&e.joint_displacement),
        PerJoint::Velocity => plain(&e.joint_velocity),
        PerJoint::Acceleration => plain(&e.joint_acceleration),
        PerJoint::Slip => plain(&e.joint_slip),
        PerJoint::Opening => plain(&e.joint_opening),
        PerJoint::Force => plain(&e.joint_force),
        PerJoint::Dissipation => plain(&e.joint_dissipation),
        PerJoint::Cracked => of_bonds(&|b| b.cracked),
        PerJoint::Damage => of_bonds(&|b| b.damage),
    }
}
