//! All that changes in a run. What is compiled stays as it is.

use serde::{Deserialize, Serialize};

use super::pull::Pull;
use super::response::Counts;
use super::system::System;

/// What it does.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) enum Phase {
    /// At θ = 0.
    Closed,
    /// Stands open, held by friction.
    Held,
    /// Opens (1) or closes (−1).
    Moves(f64),
}

/// What is integrated: turn and velocity, work of the ground and of friction.
pub(super) type Row = [f64; 4];

/// A wall under way, with its account and its peaks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct State {
    /// Time [s].
    pub t: f64,
    /// To which side it is turned, by its place among those of the system.
    pub side: usize,
    pub row: Row,
    pub phase: Phase,
    pub ties: Vec<Pull>,
    /// When ties broke [s].
    pub broke: Vec<Option<f64>>,
    /// Floors that have lost their seat.
    pub gone: Vec<bool>,
    /// Forces of friction whose overlap is used up.
    pub spent: Vec<bool>,
    /// Turn to each side at which the weights hold no longer, of what still bears on the wall [rad].
    pub d0: [Option<f64>; 2],
    /// Whether it is turned farther than that, and since when [s].
    pub beyond: bool,
    pub beyond_since: f64,
    /// Where the smooth piece of the ground's motion was entered that it is in, and where it leaves it [s].
    pub entered: f64,
    pub until: f64,
    /// Samples taken.
    pub samples: u64,
    /// Up to when jumps of the ground's velocity have been dealt with [s].
    pub jumped: f64,
    /// Energy lost in impacts, gone with floors, and at the start [J].
    pub impact: f64,
    pub floors: f64,
    pub start: f64,
    /// Largest residual of the account, and largest energy in play [J].
    pub residual: f64,
    pub scale: f64,
    /// Farthest turn to each side, and when.
    pub peaks: [(f64, f64); 2],
    pub first_lift_off: Option<f64>,
    pub counts: Counts,
}

impl State {
    /// Whether it is one of this system.
    pub fn fits(&self, system: &System) -> bool {
        self.side < system.sides.len()
            && self.ties.len() == system.ties.len()
            && self.broke.len() == system.ties.len()
            && self.gone.len() == system.floors.len()
            && self.spent.len() == system.rubs.len()
    }

    /// At t = 0, turned by `rotation` [rad] at `velocity` [rad/s]. Ties and account are not settled yet.
    pub fn new(system: &System, [rotation, velocity]: [f64; 2]) -> Self {
        let side = usize::from(system.sides.len() > 1 && (rotation < 0.0 || (rotation == 0.0 && velocity < 0.0)));
        let sign = system.sides[side].sign;
        State {
            t: 0.0,
            side,
            row: [sign * rotation, sign * velocity, 0.0, 0.0],
            phase: Phase::Closed,
            ties: system.ties.clone(),
            broke: vec![None; system.ties.len()],
            gone: vec![false; system.floors.len()],
            spent: vec![false; system.rubs.len()],
            d0: system.d0,
            beyond: false,
            beyond_since: 0.0,
            entered: 0.0,
            until: f64::NEG_INFINITY,
            samples: 0,
            jumped: f64::NEG_INFINITY,
            impact: 0.0,
            floors: 0.0,
            start: 0.0,
            residual: 0.0,
            scale: 0.0,
            peaks: [(0.0, 0.0); 2],
            first_lift_off: None,
            counts: Counts::default(),
        }
    }
}
