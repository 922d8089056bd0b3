//! What is kept while a run goes on: channels at a fixed interval, full frames, envelopes, energies, counters.
//! Buffers are made before the run; the time loop fills them and its caller empties them.

pub use concio_law::account::{Counters, Energies, Envelopes, Event, EventKind, StopReason};
use serde::{Deserialize, Serialize};

use crate::wall::Block;

/// A history kept at every sample.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Channel {
    /// Path-like name: `top/displacement`, `energy/friction`, `block/p1c1b1/velocity`, `joint/p1c1b1|p1c2b1/slip`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// One sentence.
    pub description: String,
}

/// What a run keeps, settled before it starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Layout {
    /// Interval of the samples [s]; sample k is at k·interval, the first at t = 0.
    pub interval: f64,
    /// Number of samples of the whole run, the one at t = 0 included.
    pub samples: usize,
    /// A frame is kept at every this many samples; 0 for none.
    pub frame_every: usize,
    /// Number of moving bodies in a frame: the blocks, then the beam if it has motion of its own. In the shear model that is
    /// a beam with mass; in the planar model any beam, because it can lift and turn.
    pub unknowns: usize,
    /// Number of bodies whose vertical displacement and rotation a frame holds: `unknowns` in the planar model, 0 in the
    /// shear model.
    #[serde(default)]
    pub turned: usize,
    /// Number of joints whose slip, opening and pressure a frame holds: all of them in the planar model, where they follow
    /// from no law of the joint alone; none in the shear model.
    #[serde(default)]
    pub touching: usize,
    /// Number of joints whose friction a frame holds: all of them where a law is set-valued, since what holds a joint
    /// at rest follows from no velocity, a joint is bonded, or a device has a law of its own; otherwise none.
    #[serde(default)]
    pub held: usize,
    /// Number of bonded joints, whose damage a frame holds.
    #[serde(default)]
    pub bonded: usize,
    /// The histories.
    pub channels: Vec<Channel>,
}

/// Number of arrays in a recording, and how many of them are of samples; the others are of frames.
const ARRAYS: usize = 13;
const SAMPLED: usize = 2;

/// Samples and frames, row by row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recording {
    /// Time of each sample [s].
    pub time: Vec<f64>,
    /// `time.len()` rows of one value per channel.
    pub values: Vec<f64>,
    /// Time of each frame [s].
    pub frame_time: Vec<f64>,
    /// `frame_time.len()` rows: horizontal displacement of every unknown, of its centre, relative to the base [m].
    pub frame_displacement: Vec<f64>,
    /// `frame_time.len()` rows: horizontal velocity of every unknown relative to the base [m/s].
    pub frame_velocity: Vec<f64>,
    /// `frame_time.len()` rows: horizontal acceleration of every unknown relative to the base [m/s²].
    pub frame_acceleration: Vec<f64>,
    /// `frame_time.len()` rows of `layout.turned`: how far the centre of every body has risen [m].
    pub frame_vertical: Vec<f64>,
    /// `frame_time.len()` rows of `layout.turned`: rotation of every body about its centre, counterclockwise, in rad.
    pub frame_rotation: Vec<f64>,
    /// `frame_time.len()` rows: friction force on side a of every joint [N]; rows of none unless a law is set-valued, a
    /// joint is bonded, or a device has a law of its own, whose force counts here. In the planar model the whole
    /// tangential force of every joint.
    pub frame_friction: Vec<f64>,
    /// `frame_time.len()` rows of `layout.touching`: sliding along every joint [m]; of bed and support joints the lower side
    /// less the upper one, of upright joints how far the left side has risen over the right one.
    pub frame_slip: Vec<f64>,
    /// `frame_time.len()` rows of `layout.touching`: widest opening of every joint over its length [m], from 0.
    pub frame_opening: Vec<f64>,
    /// `frame_time.len()` rows of `layout.touching`: normal force of every joint [N], positive in compression.
    pub frame_pressure: Vec<f64>,
    /// `frame_time.len()` rows: damage of every bonded joint, 0 … 1.
    pub frame_damage: Vec<f64>,
    /// What happened at one instant, in the order of time.
    pub events: Vec<Event>,
}

impl Recording {
    /// When and where a planar wall counted as collapsed; none where it did not.
    pub fn collapse(&self) -> Option<&Event> {
        self.events.iter().find(|e| e.kind == EventKind::Collapse)
    }

    /// How many of these rising instants [s] a planar wall stood, that of its collapse included; all where it did not collapse.
    pub fn standing(&self, times: &[f64]) -> usize {
        // Times of samples and of steps differ by rounding.
        self.collapse().map_or(times.len(), |event| times.partition_point(|t| *t <= event.time * (1.0 + 1e-9)))
    }

    /// Whether there is nothing in it, events included.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty() && self.frame_time.is_empty() && self.events.is_empty()
    }

    /// Adds the rows of `other` at the end.
    pub fn append(&mut self, other: &Recording) {
        for (to, from) in self.arrays_mut().into_iter().zip(other.arrays()) {
            to.extend_from_slice(from);
        }
        self.events.extend_from_slice(&other.events);
    }

    /// The arrays in the order in which a journal keeps them, samples first, then frames.
    pub(crate) fn arrays(&self) -> [&Vec<f64>; ARRAYS] {
        [
            &self.time,
            &self.values,
            &self.frame_time,
            &self.frame_displacement,
            &self.frame_velocity,
            &self.frame_acceleration,
            &self.frame_friction,
            &self.frame_damage,
            &self.frame_vertical,
            &self.frame_rotation,
            &self.frame_slip,
            &self.frame_opening,
            &self.frame_pressure,
        ]
    }

    /// Rows and length of a row of every array for so many samples and frames, in the order of [`Recording::arrays`].
    pub(crate) fn shapes(layout: &Layout, samples: usize, frames: usize) -> [(usize, usize); ARRAYS] {
        let n = layout.unknowns;
        let (turned, touching) = (layout.turned, layout.touching);
        let of_frames = [1, n, n, n, layout.held, layout.bonded, turned, turned, touching, touching, touching];
        let mut shapes = [(samples, layout.channels.len()); ARRAYS];
        shapes[0].1 = 1;
        shapes[SAMPLED..].copy_from_slice(&of_frames.map(|width| (frames, width)));
        shapes
    }

    /// The same arrays, to be filled.
    pub(crate) fn arrays_mut(&mut self) -> [&mut Vec<f64>; ARRAYS] {
        [
            &mut self.time,
            &mut self.values,
            &mut self.frame_time,
            &mut self.frame_displacement,
            &mut self.frame_velocity,
            &mut self.frame_acceleration,
            &mut self.frame_friction,
            &mut self.frame_damage,
            &mut self.frame_vertical,
            &mut self.frame_rotation,
            &mut self.frame_slip,
            &mut self.frame_opening,
            &mut self.frame_pressure,
        ]
    }

    /// Empties it and keeps its room.
    pub(crate) fn clear(&mut self) {
        self.arrays_mut().into_iter().for_each(Vec::clear);
        self.events.clear();
    }

    /// Empty, with room for so many samples, frames and events.
    pub(crate) fn with_room(layout: &Layout, samples: usize, frames: usize, events: usize) -> Self {
        let mut recording = Recording { events: Vec::with_capacity(events), ..Recording::default() };
        let shapes = Recording::shapes(layout, samples, frames);
        for (array, (rows, width)) in recording.arrays_mut().into_iter().zip(shapes) {
            array.reserve_exact(rows.saturating_mul(width));
        }
        recording
    }
}

/// Motion of a block or of the top beam, relative to the base; the horizontal one unless said.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// Of the centre [m].
    pub displacement: f64,
    /// [m/s]
    pub velocity: f64,
    /// [m/s²]
    pub acceleration: f64,
    /// How far the centre has risen [m]; 0 in the shear model.
    pub vertical: f64,
    /// Rotation about the centre, counterclockwise, in rad; 0 in the shear model.
    pub rotation: f64,
}

impl Motion {
    /// Displacement [m] of the point that is at `arm` [m] from the centre when the body is at rest, by the whole rotation
    /// and not only its first order.
    pub fn of_point(&self, arm: [f64; 2]) -> [f64; 2] {
        if self.rotation == 0.0 {
            return [self.displacement, self.vertical];
        }
        // cos φ − 1 without the digits that small rotations lose in the difference.
        let (sine, less) = (self.rotation.sin(), -2.0 * (0.5 * self.rotation).sin().powi(2));
        [self.displacement + less * arm[0] - sine * arm[1], self.vertical + sine * arm[0] + less * arm[1]]
    }

    /// Displacement [m] of the point of `block` that is at `point` [m] when the block is at rest.
    pub fn of_point_in(&self, block: &Block, point: [f64; 2]) -> [f64; 2] {
        let centre = block.centre();
        self.of_point([point[0] - centre[0], point[1] - centre[1]])
    }

    /// Of unknown `index` in frame `frame`; both must be there.
    pub fn in_frame(layout: &Layout, recording: &Recording, frame: usize, index: usize) -> Self {
        let at = frame * layout.unknowns + index;
        let turned = |rows: &[f64]| if layout.turned > 0 { rows[frame * layout.turned + index] } else { 0.0 };
        Motion {
            displacement: recording.frame_displacement[at],
            velocity: recording.frame_velocity[at],
            acceleration: recording.frame_acceleration[at],
            vertical: turned(&recording.frame_vertical),
            rotation: turned(&recording.frame_rotation),
        }
    }
}
