//! What a run gives back.

use serde::{Deserialize, Serialize};

use crate::record::{Counters, Energies, Envelopes, Layout, Recording, StopReason};

/// The whole result of one run. Equal inputs give equal bits; times of the clock are therefore kept elsewhere.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// What was kept.
    pub layout: Layout,
    /// Histories and frames.
    pub recording: Recording,
    /// Peaks per block and joint.
    pub envelopes: Envelopes,
    /// Energy account at the end.
    pub energies: Energies,
    /// Peaks over the run.
    pub totals: Totals,
    /// Work of the solver.
    pub counters: Counters,
    /// Why it ended.
    pub stop_reason: StopReason,
    /// Time reached [s].
    pub time_reached: f64,
}

/// Numbers that sum a run up; taken at every accepted step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Totals {
    /// Largest |displacement| of a block relative to the base [m].
    pub peak_relative_displacement: f64,
    /// Largest |relative velocity| of a bed or support joint [m/s].
    pub peak_slip_velocity: f64,
    /// Largest |force| that the top beam exerts on the wall [N]; 0 without a beam.
    pub top_force_peak: f64,
    /// ∫ F² dt of that force [N² s]; its rms is √(this / time reached).
    pub top_force_square: f64,
    /// Most negative gap of a head joint or connection [m], from 0 down.
    pub minimum_gap: f64,
    /// Largest relative velocity that rigid contact was left with where it should be 0, over all steps and impacts
    /// [m/s]: the residual of the contact problem.
    pub contact_residual: f64,
    /// Largest |work done on the wall| so far [J].
    pub peak_input: f64,
    /// Largest |residual of the energy account| so far [J].
    pub peak_residual: f64,
}
