//! The account of a run: energies, peaks, events, counted work, and why it ended.

use serde::{Deserialize, Serialize};

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
    pub fn sort(events: &mut [Event]) {
        let rank = |event: &Event| (event.joint, event.kind as u8);
        events.sort_unstable_by(|a, b| a.time.total_cmp(&b.time).then_with(|| rank(a).cmp(&rank(b))));
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
    /// Of so many unknowns and joints at rest, and so many joints whose impacts are counted.
    pub fn at_rest(unknowns: usize, joints: usize, impacts: usize) -> Self {
        let zeros = |n: usize| vec![0.0; n];
        Envelopes {
            block_displacement: zeros(unknowns),
            block_velocity: zeros(unknowns),
            block_acceleration: zeros(unknowns),
            joint_displacement: zeros(joints),
            joint_velocity: zeros(joints),
            joint_acceleration: zeros(joints),
            joint_slip: zeros(joints),
            joint_opening: zeros(joints),
            joint_closing: zeros(joints),
            joint_force: zeros(joints),
            joint_dissipation: zeros(joints),
            joint_impulse: zeros(impacts),
            joint_impacts: zeros(impacts),
        }
    }

    /// Whether it is of so many unknowns, joints and joints whose impacts are counted.
    pub fn fits(&self, unknowns: usize, joints: usize, impacts: usize) -> bool {
        let blocks = [&self.block_displacement, &self.block_velocity, &self.block_acceleration];
        let of_joints = [
            &self.joint_displacement,
            &self.joint_velocity,
            &self.joint_acceleration,
            &self.joint_slip,
            &self.joint_opening,
            &self.joint_closing,
            &self.joint_force,
            &self.joint_dissipation,
        ];
        blocks.iter().all(|x| x.len() == unknowns)
            && of_joints.iter().all(|x| x.len() == joints)
            && [&self.joint_impulse, &self.joint_impacts].iter().all(|x| x.len() == impacts)
    }

    /// Takes the sign from what is 0: which of two zeros is the larger is the processor's choice.
    pub fn drop_signs_of_zero(&mut self) {
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

    /// What base and top beam did, each without its sign: where they cancel, [`Energies::input`] is no measure of what flowed.
    pub fn works(&self) -> f64 {
        self.input_base.abs() + self.input_top.abs()
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
    /// The ground fell faster than a rocking wall would: nothing presses on its hinge, and its equation says nothing of what follows.
    Airborne,
}

impl StopReason {
    /// Whether the run went as far as it was to go.
    pub fn is_end(self) -> bool {
        matches!(self, StopReason::Completed | StopReason::Collapsed)
    }
}

/// Numbers that sum a run up; taken at every accepted step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Totals {
    /// Largest |displacement| of a block relative to the base [m].
    pub peak_relative_displacement: f64,
    /// Largest |relative velocity| of a bed or support joint [m/s].
    pub peak_slip_velocity: f64,
    /// Largest |friction force| in a joint [N], on the side that it is larger on; of a bonded joint that of its cracked
    /// part, none while it is intact; of one that sticks what it holds. 0 where nothing rubs.
    pub peak_friction_force: f64,
    /// Largest |horizontal force of the base on the wall| [N]; of a planar wall the mean over a step, impacts among it, until a collapse,
    /// and without inertia the largest against the load.
    pub base_shear_peak: f64,
    /// When it first came within 10⁻⁴ of that [s]: where a wall slides, its largest shear lasts, but for rounding.
    pub base_shear_time: f64,
    /// Displacement of the top relative to the base then [m]: of a beam that moves, else the mean of the top courses.
    pub base_shear_displacement: f64,
    /// Largest |force| that the top beam exerts on the wall [N]; 0 without a beam.
    pub top_force_peak: f64,
    /// ∫ F² dt of that force [N² s], until a collapse; its rms is √(this / that time).
    pub top_force_square: f64,
    /// Most negative gap of a head joint or connection [m], from 0 down.
    pub minimum_gap: f64,
    /// Largest relative velocity that rigid contact was left with where it should be 0, over all steps and impacts
    /// [m/s]: the residual of the contact problem.
    pub contact_residual: f64,
    /// Largest |work done on the wall| so far [J].
    pub peak_input: f64,
    /// Largest sum of the works of base and beam so far, each without its sign [J]; of a planar wall also those of what acts vertically, its
    /// weights among it, apart from those of what acts horizontally.
    pub peak_work: f64,
    /// Largest |residual of the energy account| so far [J].
    pub peak_residual: f64,
    /// Of a planar wall, the first block that had fallen or turned over; none where none did.
    pub collapse: Option<Collapse>,
}

/// Part by which a base shear has to exceed an earlier one to count as another: of one that lasts, the beginning is told.
const LASTING: f64 = 1e-4;

/// Part of the works done on the wall, their sizes added, that their net is taken for at least.
const CANCELLING: f64 = 0.2;

impl Totals {
    /// Largest residual of the energy account over the largest energy in play, the works done on the wall or what it had at the start, `initial` [J];
    /// 0 when there was none. The work at the end is no measure: what a driven beam gives it may take back. Nor is the net of works that cancel: a
    /// beam that tips a rigid wall brings what its weights take, and what is left is known no better than they are. It counts for no less than a
    /// fifth of them.
    pub fn residual_relative(&self, initial: f64) -> f64 {
        let scale = self.peak_input.max(initial.abs()).max(CANCELLING * self.peak_work);
        if scale == 0.0 { 0.0 } else { self.peak_residual / scale }
    }

    /// Takes the size of the base shear at `t` [N], with the tops at `top` [m]; `marked` is the one at [`Totals::base_shear_time`].
    #[inline]
    pub fn raise_base_shear(&mut self, marked: &mut f64, shear: f64, t: f64, top: f64) {
        self.base_shear_peak = self.base_shear_peak.max(shear);
        if shear > *marked * (1.0 + LASTING) {
            *marked = shear;
            (self.base_shear_time, self.base_shear_displacement) = (t, top);
        }
    }
}

/// What a planar wall counts as collapsed by.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Collapse {
    /// When [s].
    pub time: f64,
    /// The block, by its index.
    pub block: usize,
    /// Its displacement [m].
    pub way: f64,
    /// Whether it had turned over; else it had fallen.
    pub turned: bool,
    /// What the run until then was like; none in results of earlier versions.
    #[serde(default)]
    pub before: Option<Before>,
}

/// How far a run may be believed that ended in a collapse: until then.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Before {
    /// Largest residual of the energy account over the largest energy in play, from 0.
    pub residual: f64,
    /// Steps.
    pub steps: u64,
    /// Steps whose contact was left unsolved.
    pub unsolved: u64,
    /// Steps without inertia that ended before the wall had come to rest.
    pub moving: u64,
}

impl Collapse {
    /// What its block did, having turned over or fallen.
    pub fn what(&self) -> &'static str {
        collapsed(self.turned)
    }
}

/// What a block did that has turned over, or else fallen.
pub fn collapsed(turned: bool) -> &'static str {
    if turned { "turned by 45°" } else { "had fallen by half of its height" }
}
