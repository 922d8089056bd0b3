//! What is kept while a run goes on: channels at a fixed interval, full frames, envelopes, energies, counters.
//! Buffers are made before the run; the time loop fills them and its caller empties them.

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

/// Something that happened at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When [s].
    pub time: f64,
    /// Index of the joint.
    pub joint: u32,
    /// What.
    pub kind: EventKind,
    /// How much; unit and meaning follow from the kind.
    pub value: f64,
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EventKind {
    /// An impact in a rigid joint, with its impulse [N s]. Listed are those that exceed all earlier ones of their joint
    /// by a tenth: few, and the largest among them. How many there were is in the envelopes.
    Impact,
    /// The first crack of a bond, with the stretch at which it came, the relative displacement or the gap [m].
    Crack,
    /// The end of a bond, with its stretch [m]; of a brittle one at the instant of its crack.
    Break,
    /// A block has moved so far that the wall counts as collapsed, with its displacement [m]; the joint is one of that
    /// block's.
    Collapse,
    /// The first crushing of a joint of a planar wall, with its depth [m].
    Crush,
}

impl EventKind {
    /// All kinds; the place in the list is the number that a journal keeps.
    const ALL: [EventKind; 5] =
        [EventKind::Impact, EventKind::Crack, EventKind::Break, EventKind::Collapse, EventKind::Crush];

    /// Unit of [`Event::value`].
    pub fn unit(self) -> &'static str {
        match self {
            EventKind::Impact => "N s",
            EventKind::Crack | EventKind::Break | EventKind::Collapse | EventKind::Crush => "m",
        }
    }
}

impl Event {
    /// Puts what happened within a step into the order of time, at one instant into that of joints.
    pub(crate) fn sort(events: &mut [Event]) {
        let rank = |event: &Event| (event.joint, event.kind as u8);
        events.sort_unstable_by(|a, b| a.time.total_cmp(&b.time).then_with(|| rank(a).cmp(&rank(b))));
    }

    /// Time, joint, kind, value as a journal keeps them.
    pub(crate) fn row(&self) -> [f64; 4] {
        let kind = EventKind::ALL.iter().position(|k| *k == self.kind).unwrap_or(usize::MAX);
        [self.time, f64::from(self.joint), kind as f64, self.value]
    }

    /// The reverse of [`Event::row`]; none for a kind that there is not.
    pub(crate) fn of_row([time, joint, kind, value]: [f64; 4]) -> Option<Self> {
        Some(Event { time, joint: joint as u32, kind: *EventKind::ALL.get(kind as usize)?, value })
    }
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

/// Largest values over the whole run, taken at every accepted step. Signs are dropped unless said.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Envelopes {
    /// Per unknown: |displacement relative to the base| [m].
    pub block_displacement: Vec<f64>,
    /// Per unknown: |velocity relative to the base| [m/s].
    pub block_velocity: Vec<f64>,
    /// Per unknown: |acceleration relative to the base| [m/s²].
    pub block_acceleration: Vec<f64>,
    /// Per joint: |relative displacement| [m].
    pub joint_displacement: Vec<f64>,
    /// Per joint: |relative velocity| [m/s].
    pub joint_velocity: Vec<f64>,
    /// Per joint: |relative acceleration| [m/s²].
    pub joint_acceleration: Vec<f64>,
    /// Per joint: slip path [m], summed over the steps in which |v| exceeds δ_v at an end (0 for joints without friction).
    pub joint_slip: Vec<f64>,
    /// Per joint: widest gap of a head joint or connection [m], from 0 (0 for the others); in the planar model of every joint.
    pub joint_opening: Vec<f64>,
    /// Per joint: deepest closure (negative gap) of a head joint or connection [m], from 0.
    pub joint_closing: Vec<f64>,
    /// Per joint: |elastic force| [N].
    pub joint_force: Vec<f64>,
    /// Per joint: dissipated energy, damping, friction and impacts [J].
    pub joint_dissipation: Vec<f64>,
    /// Per joint: largest impulse of an impact [N s].
    pub joint_impulse: Vec<f64>,
    /// Per joint: number of impacts.
    pub joint_impacts: Vec<f64>,
}

impl Envelopes {
    /// Takes the sign from what is 0: which of two zeros is the larger is the processor's choice.
    pub(crate) fn drop_signs_of_zero(&mut self) {
        let Envelopes {
            block_displacement,
            block_velocity,
            block_acceleration,
            joint_displacement,
            joint_velocity,
            joint_acceleration,
            joint_slip,
            joint_opening,
            joint_closing,
            joint_force,
            joint_dissipation,
            joint_impulse,
            joint_impacts,
        } = self;
        let blocks = [block_displacement, block_velocity, block_acceleration];
        let joints = [joint_displacement, joint_velocity, joint_acceleration, joint_slip, joint_opening, joint_closing];
        let forces = [joint_force, joint_dissipation, joint_impulse, joint_impacts];
        blocks.into_iter().chain(joints).chain(forces).flatten().for_each(|x| *x += 0.0);
    }
}

/// The energy account (7) at one instant [J]; all work is done in coordinates relative to the base.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Energies {
    /// Work of the base motion (inertia forces −m a on the relative motion).
    pub input_base: f64,
    /// Work of a driven top beam.
    pub input_top: f64,
    /// Kinetic and elastic energy at t = 0 that no work of the run brought.
    pub initial: f64,
    /// Kinetic energy.
    pub kinetic: f64,
    /// Elastic energy of the joints.
    pub elastic: f64,
    /// Dissipated by viscous damping.
    pub damping: f64,
    /// Dissipated by friction.
    pub friction: f64,
    /// Dissipated by the breaking of bonds.
    pub bond: f64,
    /// Dissipated by the hysteresis of devices, and by ties that yield.
    pub device: f64,
    /// Lost in the impacts of rigid joints.
    pub impact: f64,
    /// Taken out by friction forces whose action differs from their reaction (`overburden`).
    pub nonreciprocal: f64,
}

impl Energies {
    /// Work done on the wall.
    pub fn input(&self) -> f64 {
        self.input_base + self.input_top
    }

    /// Lost in all ways that a wall loses energy [J].
    pub fn dissipated(&self) -> f64 {
        self.friction + self.damping + self.device + self.bond + self.impact
    }

    /// E_kin + E_el − E_0 + E_diss − W_in: 0 but for the errors of the integration.
    pub fn residual(&self) -> f64 {
        self.kinetic
            + self.elastic
            + self.damping
            + self.friction
            + self.bond
            + self.impact
            + self.nonreciprocal
            + self.device
            - self.initial
            - self.input()
    }
}

/// Counted work of the solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Counters {
    /// Accepted steps.
    pub steps: u64,
    /// Steps rejected by the error control.
    pub rejected: u64,
    /// Steps repeated because the iteration did not converge.
    pub failed: u64,
    /// Iterations on the joints' laws.
    pub iterations: u64,
    /// Matrix factorisations.
    pub factorisations: u64,
    /// Instants at which a step was ended because something happened there.
    pub events: u64,
    /// Attempts at steps that were cut for them.
    pub located: u64,
    /// Impacts of rigid joints.
    pub impacts: u64,
    /// Steps whose contact was left with more than a hundred times the tolerance, without inertia with more than it.
    #[serde(default)]
    pub unsolved: u64,
    /// Steps without inertia that ended before what slowed down had come to rest.
    #[serde(default)]
    pub moving: u64,
}

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StopReason {
    /// The end of the motion was reached.
    Completed,
    /// The wall collapsed, and the run was to end then.
    Collapsed,
    /// The user stopped it.
    Interrupted,
    /// The step became too short: the tolerance cannot be held.
    StepTooShort,
    /// A value became infinite or not a number.
    NotFinite,
}

impl StopReason {
    /// Whether the run went as far as it was to go.
    pub fn is_end(self) -> bool {
        matches!(self, StopReason::Completed | StopReason::Collapsed)
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
