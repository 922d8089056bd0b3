//! What a run gives back.

pub use concio_law::account::{Before, Collapse, Totals};
use serde::{Deserialize, Serialize};

use crate::bond::{Bond, BondRow};
use crate::drift::DriftRow;
use crate::record::{Counters, Energies, Envelopes, Layout, Recording, StopReason};

/// Part of its peak down to which the force of a push counts as borne, and what displacements may differ by from rounding.
const FOUR_FIFTHS: f64 = 0.8;
const ROUNDING: f64 = 1e-9;

/// How stiff a wall was that is pushed, and how far it went.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Push {
    /// Secant stiffness: the largest base shear over the displacement of the top then [N/m].
    pub stiffness: f64,
    /// Largest displacement of the top at which it bore four fifths of that [m]; none where it never went on with less.
    pub ultimate: Option<f64>,
}

/// The whole result of one run. Equal inputs give equal bits; clock times are therefore kept elsewhere.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// What was kept.
    pub layout: Layout,
    /// Histories and frames.
    pub recording: Recording,
    /// Peaks per block and joint.
    pub envelopes: Envelopes,
    /// The joints with a bond and what became of it, in the order of the joints.
    pub bonds: Vec<BondRow>,
    /// The ties and what became of them, in the order of the wall file.
    pub ties: Vec<TieRow>,
    /// What became of the mechanism of a rocking wall; none of other models, and of a run that is read back from its files.
    pub rocking: Option<RockingOutcome>,
    /// The joint of a planar wall with inertia that was crushed deepest; none where none was, and of a run that is read back from its files.
    pub deepest: Option<Deepest>,
    /// How a planar wall without inertia was falling when the run ended; none where it was at rest, and of a run that is read back from its files.
    pub falling: Option<Falling>,
    /// How far its tops went: that of a beam that moves, then those of the panels that have none.
    pub drifts: Vec<DriftRow>,
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

impl Outcome {
    /// The history of a channel by its name, one value per sample; none where there is no such channel.
    pub fn history(&self, name: &str) -> Option<Vec<f64>> {
        let channels = &self.layout.channels;
        let at = channels.iter().position(|c| c.name == name)?;
        Some(self.recording.values.chunks_exact(channels.len()).map(|row| row[at]).collect())
    }

    /// What a push tells: base shear over the displacement of the top, from the samples and the peak of all steps, until a collapse; none without any shear.
    pub fn push(&self) -> Option<Push> {
        let (shear, courses, beam) =
            (self.history("base/shear")?, self.history("top/displacement")?, self.history("beam/displacement")?);
        let top = if beam.iter().any(|d| *d != 0.0) { beam } else { courses };
        let end = self.totals.collapse.map_or(f64::INFINITY, |collapse| collapse.time);
        let stood = self.recording.time.iter().take_while(|t| **t <= end).count();
        let between = (self.totals.base_shear_peak, self.totals.base_shear_displacement.abs());
        let samples = || shear[..stood].iter().map(|f| f.abs()).zip(top[..stood].iter().map(|d| d.abs()));
        let borne = || std::iter::once(between).chain(samples());
        let (peak, displacement) = borne().fold((0.0, 0.0), |most, now| if now.0 > most.0 { now } else { most });
        let ultimate = borne().filter(|(f, _)| *f >= FOUR_FIFTHS * peak).map(|(_, d)| d).fold(0.0, f64::max);
        let fell = borne().any(|(_, d)| d > ultimate * (1.0 + ROUNDING));
        (peak > 0.0 && displacement > 0.0)
            .then(|| Push { stiffness: peak / displacement, ultimate: fell.then_some(ultimate) })
    }

    /// The bond that cracked first, of several at once the one of the first joint; none when none cracked.
    pub fn first_crack(&self) -> Option<&BondRow> {
        let cracked = self.bonds.iter().filter(|b| b.cracked.is_finite());
        cracked.min_by(|a, b| a.cracked.total_cmp(&b.cracked))
    }

    /// The top that went farthest over its height.
    pub fn worst_drift(&self) -> Option<&DriftRow> {
        self.drifts.iter().max_by(|a, b| a.ratio(a.peak).abs().total_cmp(&b.ratio(b.peak).abs()))
    }
}

/// How deep a joint was crushed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Deepest {
    /// Number of the joint.
    pub joint: usize,
    /// By how much at its deepest [m].
    pub depth: f64,
    /// The most that one step added to that [m]: of one taken in parts their mean.
    pub at_once: f64,
}

/// How a wall without inertia falls.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Falling {
    /// Since when it has not come to rest [s].
    pub since: f64,
    /// The block that goes farthest.
    pub block: usize,
    /// How far it went in the last step [m].
    pub way: f64,
}

/// What became of a rocking wall. Numbers that there are not are infinite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RockingOutcome {
    /// Kind of mechanism, as `concio mechanisms` spells it.
    pub mechanism: String,
    /// Level of its hinge above the base [m].
    pub hinge: f64,
    /// α0 at which it sets off: ties have no pull yet.
    pub multiplier: f64,
    /// e: velocity after an impact over that before.
    pub restitution: f64,
    /// Displacement of the control point [m] and turn [rad] at which weights and thrusts hold no longer, outwards.
    pub d0: f64,
    /// See above.
    pub rotation_d0: f64,
    /// Farthest turn, to either side, over that at which the weights hold no longer there; none where they always hold.
    pub peak_over_d0: f64,
    /// When it first left its position at rest [s].
    pub first_lift_off: f64,
    /// How often it went beyond d0.
    pub beyond_d0: u64,
    /// How often it left its position at rest, and met it again.
    pub lift_offs: u64,
    /// See above.
    pub impacts: u64,
    /// When each tie broke [s].
    pub broken_ties: Vec<f64>,
    /// When each floor lost its seat and fell off the wall [s].
    pub lost_seats: Vec<f64>,
}

/// What became of a tie.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TieRow {
    /// What one end is fixed to: a block, or `base`, which comes first.
    pub from: String,
    /// The block that the other end is fixed to.
    pub to: String,
    /// Largest force that it bore [N], from 0.
    pub force: f64,
    /// By how much it has yielded [m], from 0.
    pub stretch: f64,
    /// When it first yielded [s]; infinite when it did not, 0 where it had to before the motion began.
    pub yielded: f64,
}

impl BondRow {
    /// Mean damage of what has cracked of it, 0 … 1.
    pub fn damage_of_crack(&self) -> f64 {
        if self.crack > 0.0 { (self.damage / self.crack).min(1.0) } else { 0.0 }
    }

    /// Where it has cracked: from where to where, 0 … 1 along the joint from its first end.
    pub fn cracks(&self) -> [[f64; 2]; 2] {
        [[0.0, self.crack_start], [1.0 - (self.crack - self.crack_start), 1.0]]
    }

    /// The law, for a joint that is bonded against opening alone or not.
    pub fn law(&self, opens: bool) -> Bond {
        let BondRow { strength, stiffness, residual_stiffness, decay, .. } = *self;
        Bond { strength, stiffness, residual: residual_stiffness, decay, opens }
    }
}
