//! What shakes the wall, and how its response is computed.

use concio_law::G;
use concio_law::error::{InputError, Result};
use concio_law::motion::{AtRest, Component, Segment};

/// The side to which positive values of a record point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Positive {
    /// The ground accelerates from the outer face inwards, which lifts the wall off.
    Inwards,
    /// The ground accelerates outwards.
    Outwards,
}

impl Positive {
    /// The other side.
    pub fn reversed(self) -> Self {
        match self {
            Positive::Inwards => Positive::Outwards,
            Positive::Outwards => Positive::Inwards,
        }
    }
}

/// Motion of the ground.
#[derive(Debug, Clone, Copy)]
pub struct Shaking<'g> {
    /// Horizontal motion across the wall.
    pub across: &'g dyn Component,
    /// To where its positive values point.
    pub positive: Positive,
    /// Vertical motion, positive upwards. It acts on all weights.
    pub vertical: &'g dyn Component,
    /// Both are multiplied by it.
    pub scale: f64,
}

impl<'g> Shaking<'g> {
    /// A horizontal motion as it is.
    pub fn across(motion: &'g dyn Component, positive: Positive) -> Self {
        Shaking { across: motion, positive, vertical: &AtRest, scale: 1.0 }
    }
    /// The same towards the other side.
    pub fn reversed(self) -> Self {
        Shaking { positive: self.positive.reversed(), ..self }
    }
    /// The same times a factor.
    pub fn times(self, factor: f64) -> Self {
        Shaking { scale: factor * self.scale, ..self }
    }

    /// When both end for good [s]; none for what goes on.
    pub fn end(&self) -> Option<f64> {
        Some(self.across.end()?.max(self.vertical.end()?))
    }

    fn inwards(&self) -> f64 {
        match self.positive {
            Positive::Inwards => self.scale,
            Positive::Outwards => -self.scale,
        }
    }

    /// The smooth piece that is active just after `t`.
    #[inline]
    pub(super) fn piece(&self, t: f64) -> Piece {
        let (across, up) = (piece(self.across, t), piece(self.vertical, t));
        Piece { end: across.end.min(up.end), across, up, inwards: self.inwards(), scale: self.scale }
    }

    /// Jumps of the velocity at `t`, inwards and upwards [m/s].
    pub(super) fn jumps(&self, t: f64) -> [f64; 2] {
        [self.inwards() * self.across.velocity_jump(t), self.scale * self.vertical.velocity_jump(t)]
    }

    /// Longest step that resolves both [s].
    pub(super) fn longest_step(&self) -> f64 {
        self.across.longest_step().min(self.vertical.longest_step())
    }
}

/// The motion inside one smooth piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    across: Segment,
    up: Segment,
    inwards: f64,
    scale: f64,
    /// Last instant [s].
    pub end: f64,
}

impl Piece {
    /// Acceleration of the ground inwards [m/s²], and the weights over those at rest, 1 + v̈/g.
    #[inline]
    pub fn at(&self, t: f64) -> [f64; 2] {
        [self.inwards * self.across.acceleration(t), 1.0 + self.scale * self.up.acceleration(t) / G]
    }
}

/// One that ends within rounding of `t` has ended, so that breaks of both motions that are meant to coincide do.
fn piece(motion: &dyn Component, t: f64) -> Segment {
    let segment = motion.segment(t);
    if segment.end - t <= 1e-12 * t.abs().max(1e-3) { motion.segment(segment.end) } else { segment }
}

/// How a response is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// End of the shaking [s]; where none is given, that of the motion. Above 0.
    pub duration: Option<f64>,
    /// Time after the end in which the wall may come to rest [s]; from 0. 60 s by default.
    pub tail: f64,
    /// Longest step [s]; above 0. None: a sample of the record, and a fraction of the quickest motion of the wall and its ties.
    pub step: Option<f64>,
    /// Interval of the histories [s]; none without histories. Above 0. It does not change the run.
    pub interval: Option<f64>,
    /// Rotation [rad] and velocity [rad/s] at t = 0. Rotations from 0, below the end of the mechanism; negative ones where the wall rocks to both sides.
    pub start: [f64; 2],
}

impl Default for Setting {
    fn default() -> Self {
        Setting { duration: None, tail: 60.0, step: None, interval: None, start: [0.0; 2] }
    }
}

/// Samples of a history at most.
const MOST_SAMPLES: f64 = 1e7;

impl Setting {
    /// When the shaking ends [s].
    ///
    /// # Errors
    /// A number out of its bounds; a motion that never ends and no duration.
    pub(super) fn end(&self, shaking: &Shaking) -> Result<f64> {
        let wrong = |key: &str, value: f64, unit: &str, allowed: &str| {
            Err(InputError::new(format!("{value} {unit}").trim_end()).key(key).allowed(allowed).into())
        };
        if !shaking.scale.is_finite() {
            return wrong("scale", shaking.scale, "", "finite");
        }
        if !(self.tail >= 0.0 && self.tail.is_finite()) {
            return wrong("tail", self.tail, "s", "from 0");
        }
        if let Some(step) = self.step.filter(|step| !(*step > 0.0)) {
            return wrong("step", step, "s", "above 0");
        }
        let Some(end) = self.duration.or(shaking.end()) else {
            let error = InputError::new("a motion that never ends, and no duration").key("duration");
            return Err(error.allowed("above 0 s").into());
        };
        if !(end >= 0.0 && end.is_finite()) || self.duration == Some(0.0) {
            return wrong("duration", end, "s", "above 0");
        }
        if let Some(interval) = self.interval {
            if !(interval > 0.0) {
                return wrong("interval", interval, "s", "above 0");
            }
            if !((end + self.tail) / interval <= MOST_SAMPLES) {
                return wrong("interval", interval, "s", "at most 1e7 samples up to the end of the tail");
            }
        }
        Ok(end)
    }
}
