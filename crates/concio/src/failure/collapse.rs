//! When a planar wall counts as collapsed, and what is told of it.

use concio_law::account::collapsed;
use serde::{Deserialize, Serialize};

use crate::outcome::{Collapse, Outcome};
use crate::wall::Wall;

/// Fall of a block over its height, and turn in rad, from which its wall counts as collapsed.
const FALLEN: f64 = 0.5;
const TURNED: f64 = std::f64::consts::FRAC_PI_4;

/// Whether a block of this height [m] that has turned and risen so far [rad, m] has turned over (true) or fallen (false); none where it stands.
pub(crate) fn is_down(turn: f64, rise: f64, height: f64) -> Option<bool> {
    if turn.abs() > TURNED { Some(true) } else { (-rise > FALLEN * height).then_some(false) }
}

/// A collapse as the summary of a run tells it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Collapsed {
    /// When [s].
    pub time: f64,
    /// The first block that had fallen or turned over.
    pub block: String,
    /// Its displacement then [m].
    pub displacement: f64,
    /// Whether it had turned over; else it had fallen.
    pub turned: bool,
    /// How many blocks had fallen or turned over in the last frame; none where there are no frames.
    pub fallen: Option<usize>,
}

impl Collapsed {
    /// Of a run; none where the wall did not collapse.
    pub fn of(outcome: &Outcome, wall: &Wall) -> Option<Self> {
        let Collapse { time, block, way, turned, .. } = outcome.totals.collapse?;
        let name = &wall.blocks.get(block)?.name;
        let fallen = fallen(outcome, wall);
        Some(Collapsed { time, block: name.clone(), displacement: way, turned, fallen })
    }

    /// What its block did.
    pub fn what(&self) -> &'static str {
        collapsed(self.turned)
    }
}

/// How many blocks have fallen or turned over in the last frame.
fn fallen(outcome: &Outcome, wall: &Wall) -> Option<usize> {
    let width = outcome.layout.turned;
    let last = |rows: &'_ [f64]| rows.len().checked_sub(width.max(1));
    let (turns, rises) = (&outcome.recording.frame_rotation, &outcome.recording.frame_vertical);
    let moved = turns[last(turns)?..].iter().zip(&rises[last(rises)?..]).zip(&wall.blocks);
    Some(moved.filter(|((turn, rise), block)| is_down(**turn, **rise, block.height()).is_some()).count())
}
