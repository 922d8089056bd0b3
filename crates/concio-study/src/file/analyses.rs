//! The tables of a study file that ask something of its runs.

use concio::case::Selector;
use concio::quantity::{Length, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{Follower, PerJoint, Spacing};
use crate::intensity::Intensity;
use crate::limits::{Criterion, Rule};

/// `[sensitivity]`: indices of the factors for some measures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sensitivity {
    /// Measures of a run (docs/studies), at least one: `peak_joint_displacement`, `friction_energy`, …
    pub of: Vec<String>,
    /// Confidence of the intervals, between 0 and 1; default 0.95.
    #[serde(default = "confidence")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub confidence: f64,
}

/// `[ida]`: every motion of the study at rising intensity. Give `intensities` or `hunt`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ida {
    /// What intensity is measured by; default `pga`.
    #[serde(default)]
    pub intensity: Intensity,
    /// T of `sa` [s], above 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Time>,
    /// Measure of a run (docs/studies) that says how much the wall suffers: `peak_drift`, `largest_slip`,
    /// `joints_cracked`, …
    pub damage: String,
    /// Limit states, at least one.
    pub limits: Vec<Limit>,
    /// Damage from which on the wall counts as collapsed, above 0, as in `limits`. A run that the solver could not finish, and
    /// one of a planar wall of which a block fell, counts as collapse in any case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub collapse: Option<Value>,
    /// Intensities at which every motion is run, rising, each above 0: a number in SI or a text with its unit.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub intensities: Vec<Value>,
    /// Intensities that are found motion by motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hunt: Option<Hunt>,
    /// How often a year the intensities of the site are exceeded: makes annual rates of the fragilities.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hazard: Option<HazardInput>,
    /// Confidence of intervals and bands, between 0 and 1; default 0.95.
    #[serde(default = "confidence")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub confidence: f64,
}

fn confidence() -> f64 {
    0.95
}

/// A hazard curve of the site, for the intensity that the analysis has.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HazardInput {
    /// Intensities, rising, two at least, each above 0: a number in SI or a text with its unit.
    pub intensities: Vec<Value>,
    /// At what rate each is exceeded [1/year], above 0, falling.
    pub rates: Vec<f64>,
}

/// A limit state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limit {
    /// Its name in tables and figures, unique.
    pub name: String,
    /// Damage at which it is reached, above 0: a number in SI, or a text with its unit; of drifts and of parts of d0 also "1 %".
    pub value: Value,
}

/// Hunt and fill: growing steps up to collapse, then the gap below the collapse is closed, then the widest gaps are filled. Gaps that hold a limit are closed
/// before that, and before the hunt goes on where the runs that are left would not do for both.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hunt {
    /// First intensity, above 0.
    pub first: Value,
    /// First step, above 0.
    pub step: Value,
    /// What each step is longer than the one before, from 0; default half of `step`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub growth: Option<Value>,
    /// Intensity that is not exceeded, above `first`.
    pub most: Value,
    /// Runs per motion, 4 … 1,000; default 12.
    #[serde(default = "runs")]
    #[schemars(range(min = 4, max = 1000))]
    pub runs: usize,
    /// Gap that holds the collapse or a limit, over the intensity below it, that is small enough; above 0, default 0.1.
    #[serde(default = "resolution")]
    pub resolution: f64,
}

fn runs() -> usize {
    12
}

fn resolution() -> f64 {
    0.1
}

/// `[first-crack]` of a study file: at which scale of each motion does a first joint crack? Takes the place of the
/// study's runs; `scales` beside it is an error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FirstCrackInput {
    /// What counts as a crack; default `bond`.
    pub criterion: Criterion,
    /// `opening`, `slip`: limit [m], above 0; default 0.1 mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<Length>,
    /// Largest relative distance of the two scales between which the crack lies, 1e-5 … 1; default 0.01.
    pub interval: f64,
    /// How many lower scales are tried besides, 0 … 100; default 3. They lie evenly between 0 and the answer; a run of the
    /// search within a tenth of their distance counts for one.
    #[schemars(range(min = 0, max = 100))]
    pub checks: usize,
    /// Periods of the spectral accelerations that are told beside those at the wall's own first period [s], above 0;
    /// default 0.1, 0.2 and 0.5 s.
    pub periods: Vec<Time>,
}

impl Default for FirstCrackInput {
    fn default() -> Self {
        let periods = [0.1, 0.2, 0.5].map(Time::from_si).to_vec();
        FirstCrackInput { criterion: Criterion::default(), limit: None, interval: 0.01, checks: 3, periods }
    }
}

/// `[cracks]` of a study file: how often and in which order joints crack, and which lines they form.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CracksInput {
    /// What counts as a crack; default `bond`.
    pub criterion: Criterion,
    /// `opening`, `slip`: limit [m], above 0; default 0.1 mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<Length>,
    /// Share of the runs in which a joint has to crack to be part of a line, above 0, to 1; default 0.5.
    pub threshold: f64,
}

impl Default for CracksInput {
    fn default() -> Self {
        CracksInput { criterion: Criterion::default(), limit: None, threshold: 0.5 }
    }
}

impl CracksInput {
    /// What counts as a crack.
    pub fn rule(&self) -> Rule {
        Rule::new(self.criterion, self.limit.map(Length::si))
    }

    /// What has to be kept per joint.
    pub fn keeps(&self) -> PerJoint {
        match self.criterion {
            Criterion::Bond => PerJoint::Cracked,
            Criterion::Opening => PerJoint::Opening,
            Criterion::Slip => PerJoint::Displacement,
        }
    }
}

/// Asks for the critical joints.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Ranking {
    /// By what; default the research report's relative acceleration, then relative displacement and dissipated energy.
    pub by: Vec<PerJoint>,
    /// Joints that the report of the study lists and draws as critical, from 1.
    #[schemars(range(min = 1))]
    pub listed: usize,
}

impl Default for Ranking {
    fn default() -> Self {
        Ranking { by: vec![PerJoint::Acceleration, PerJoint::Displacement, PerJoint::Dissipation], listed: 10 }
    }
}

/// Asks which joints to replace by which devices.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Interfaces {
    /// Joints that may be replaced, chosen as by `joint.change` of a wall file; default all.
    #[serde(default)]
    pub at: Selector,
    /// Most joints that are replaced, from 1. Either this or `share`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1))]
    pub count: Option<usize>,
    /// The same as a part of all joints of the wall, above 0 and up to 1, rounded down.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
    /// What is to become small or large: one objective, or two.
    #[serde(default, rename = "objective")]
    pub objectives: Vec<ObjectiveInput>,
    /// Alternatives in place of mortar, at least one; all joints of a design have the same.
    #[serde(default, rename = "device")]
    pub devices: Vec<DeviceInput>,
    /// Runs that the search may ask for; the greedy placements are tuned with as many again. At least one
    /// generation: `population` designs of every device under every motion of the search.
    #[schemars(range(min = 1))]
    pub runs: usize,
    /// Designs of a generation of each device, 4 … 1000. Default 16.
    #[serde(default = "population")]
    #[schemars(range(min = 4, max = 1000))]
    pub population: usize,
    /// Random placements to compare with, 1 … 10,000. Default 30.
    #[serde(default = "draws")]
    #[schemars(range(min = 1, max = 10_000))]
    pub draws: usize,
    /// Runs of each motion that differ by `perturbation` alone, for the scatter of what is compared, 4 … 1000. Default 8.
    #[serde(default = "copies")]
    #[schemars(range(min = 4, max = 1000))]
    pub copies: usize,
    /// Relative change of the motion from one of them to the next, above 0 and up to 0.01. Default 1e-6.
    #[serde(default = "perturbation")]
    pub perturbation: f64,
    /// Best designs of the search that are run in `copies`, 1 … 100: the best mean of them is its answer; of two objectives
    /// they are the front, from its ends inwards. Default 4.
    #[serde(default = "finalists")]
    #[schemars(range(min = 1, max = 100))]
    pub finalists: usize,
    /// `first_cracking`: scales that the first crack counts as where it lies below or above them, rising, above 0. Default
    /// 0.02 to 20.
    #[serde(default = "scales")]
    pub crack_scales: [f64; 2],
    /// `first_cracking`: width of the interval that it is found in, over its middle, above 0 and below 1. Default 0.02.
    #[serde(default = "within")]
    pub crack_within: f64,
    /// Seed of everything that is drawn. Default 1.
    #[serde(default = "seed")]
    pub seed: u64,
}

fn population() -> usize {
    16
}

fn draws() -> usize {
    30
}

fn copies() -> usize {
    8
}

fn perturbation() -> f64 {
    1e-6
}

fn finalists() -> usize {
    4
}

fn scales() -> [f64; 2] {
    [0.02, 20.0]
}

fn within() -> f64 {
    0.02
}

fn seed() -> u64 {
    1
}

/// An objective.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObjectiveInput {
    /// What is measured.
    pub measure: Target,
    /// How the motions are taken together. Default `mean`.
    #[serde(default)]
    pub over: Over,
    /// Whether it is to be small or large; default what serves a wall: dissipated energy and the scale of the first crack
    /// large, the others small.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub goal: Option<Goal>,
}

/// What an objective measures of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// Largest |relative acceleration| of neighbouring blocks [m/s²].
    PeakJointAcceleration,
    /// Largest |relative displacement| of neighbouring blocks [m].
    PeakJointDisplacement,
    /// Largest |relative velocity| of neighbouring blocks [m/s].
    PeakJointVelocity,
    /// Largest |displacement| of a block of a top course over the height of its top.
    PeakDrift,
    /// Largest |force| of the top beam [N].
    TopForcePeak,
    /// Energy dissipated by friction, damping and devices [J]: not by cracks and impacts, which nobody wants more of.
    DissipatedEnergy,
    /// Scale of the motion at which the first bond cracks.
    FirstCracking,
}

impl Target {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Target::PeakJointAcceleration => "peak_joint_acceleration",
            Target::PeakJointDisplacement => "peak_joint_displacement",
            Target::PeakJointVelocity => "peak_joint_velocity",
            Target::PeakDrift => "peak_drift",
            Target::TopForcePeak => "top_force_peak",
            Target::DissipatedEnergy => "dissipated_energy",
            Target::FirstCracking => "first_cracking",
        }
    }

    /// What it is called in texts and at axes.
    pub fn title(self) -> &'static str {
        match self {
            Target::PeakJointAcceleration => "peak relative acceleration",
            Target::PeakJointDisplacement => "peak relative displacement",
            Target::PeakJointVelocity => "peak relative velocity",
            Target::PeakDrift => "peak drift",
            Target::TopForcePeak => "peak force of the beam",
            Target::DissipatedEnergy => "dissipated energy",
            Target::FirstCracking => "scale of the first crack",
        }
    }

    /// SI unit; empty for pure numbers.
    pub fn unit(self) -> &'static str {
        match self {
            Target::PeakJointAcceleration => "m/s²",
            Target::PeakJointDisplacement => "m",
            Target::PeakJointVelocity => "m/s",
            Target::TopForcePeak => "N",
            Target::DissipatedEnergy => "J",
            Target::PeakDrift | Target::FirstCracking => "",
        }
    }
}

/// How the motions are taken together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Over {
    /// Their mean.
    #[default]
    Mean,
    /// The worst of them.
    Worst,
}

/// Whether a measure is to be small or large.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Goal {
    /// Small.
    Minimise,
    /// Large.
    Maximise,
}

/// An alternative in place of mortar.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DeviceInput {
    /// Its name in tables and figures, unique.
    pub name: String,
    /// What the joints get: the keys of a `joint.change` of a wall file without its `at`.
    #[serde(default)]
    pub change: Map<String, Value>,
    /// Its free parameters; none for a device as it is.
    #[serde(default, rename = "parameter", skip_serializing_if = "Vec::is_empty")]
    pub parameters: Vec<ParameterInput>,
}

/// A free parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterInput {
    /// Key path within `change`: `friction.static`.
    pub path: String,
    /// Lower bound: a number, or a text with a unit.
    pub from: Value,
    /// Upper bound, in the same unit.
    pub to: Value,
    /// How the search sees the range. Default `linear`.
    #[serde(default)]
    pub spacing: Spacing,
    /// Other keys of `change` that follow it in proportion: `dynamic` friction that is no less than `static`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<Follower>,
}
