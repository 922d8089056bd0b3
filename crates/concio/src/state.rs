//! Where a run is.

use crate::bond::BondState;
use crate::outcome::Totals;
use crate::record::{Counters, Energies, Envelopes};

/// Motion and account of a run after its last step, whatever its model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State<'a> {
    /// Time [s].
    pub t: f64,
    /// Displacement, velocity and acceleration relative to the base: bodies; of shear walls base (0) and top follow [m, m/s, m/s²].
    pub z: &'a [f64],
    /// See above.
    pub v: &'a [f64],
    /// See above.
    pub a: &'a [f64],
    /// What has become of the bonds, in the order of the model's.
    pub bonds: &'a [BondState],
    /// Energy account.
    pub energies: &'a Energies,
    /// Peaks per block and joint.
    pub envelopes: &'a Envelopes,
    /// Peaks of the run.
    pub totals: &'a Totals,
    /// Work of the solver.
    pub counters: &'a Counters,
}
