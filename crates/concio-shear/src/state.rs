//! All that changes during a run. Saved and restored whole, so that a resumed run continues with the same bits.

use serde::{Deserialize, Serialize};

use crate::system::System;
use concio_law::account::Totals;
use concio_law::account::{Counters, Energies, Envelopes};
use concio_law::bond::BondState;
use concio_law::drift::Lean;

/// The state between two steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time [s].
    pub t: f64,
    /// Displacement relative to the base [m]: unknowns, then base (0) and top.
    pub z: Vec<f64>,
    /// Velocity relative to the base [m/s], same places.
    pub v: Vec<f64>,
    /// Acceleration relative to the base [m/s²], same places.
    pub a: Vec<f64>,
    /// Rates of the energy account at `t` [W].
    pub power: Power,
    /// Step that the error control would take next [s].
    pub step: f64,
    /// How long the last step from a break of the motion might have been [s]; +∞ before any.
    pub step_from_break: f64,
    /// Whether the next step begins at one.
    pub from_break: bool,
    /// Largest |z| and |v| so far: the scale of the tolerances.
    pub scale: [f64; 2],
    /// Force of the top beam on the wall after the last step, its sign turned [N].
    pub pull: f64,
    /// Rate of each joint's dissipation at `t` [W].
    pub joint_power: Vec<f64>,
    /// Tangents of the joints' laws, from which the next step starts.
    pub tangents: Tangents,
    /// What has become of the bonds, in the order of the system's.
    pub bonds: Vec<BondState>,
    /// What has become of the devices with laws of their own, in the order of the system's.
    pub devices: Vec<DeviceState>,
    /// Base shear at `totals.base_shear_time` [N].
    pub marked_shear: f64,
    /// How the tops have gone.
    pub leans: Vec<Lean>,
    /// Samples kept so far.
    pub samples: u64,
    /// Energy account.
    pub energies: Energies,
    /// Peaks per block and joint.
    pub envelopes: Envelopes,
    /// Peaks of the run.
    pub totals: Totals,
    /// Work of the solver.
    pub counters: Counters,
}

/// Motion, friction and energies at one instant: those of a [`State`], or of an instant inside a step.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    /// Time [s].
    pub t: f64,
    /// Displacement, velocity and acceleration relative to the base: unknowns, then base and top.
    pub z: &'a [f64],
    /// [m/s]
    pub v: &'a [f64],
    /// [m/s²]
    pub a: &'a [f64],
    /// Friction coefficient of every joint that rubs.
    pub mu: &'a [f64],
    /// What every rigid joint bears [N].
    pub reaction: &'a [f64],
    /// The bonds.
    pub bonds: &'a [BondState],
    /// The devices.
    pub devices: &'a [DeviceState],
    /// The energy account.
    pub energies: &'a Energies,
}

/// What a [`View`] shows, where it is not a state's. The step lends it room for the motion.
#[derive(Debug, Clone)]
pub struct Instant {
    /// Time [s].
    pub t: f64,
    /// Displacement [m].
    pub z: Vec<f64>,
    /// Velocity [m/s].
    pub v: Vec<f64>,
    /// Acceleration [m/s²].
    pub a: Vec<f64>,
    /// Friction coefficients.
    pub mu: Vec<f64>,
    /// What every rigid joint bears [N].
    pub reaction: Vec<f64>,
    /// The bonds.
    pub bonds: Vec<BondState>,
    /// The devices.
    pub devices: Vec<DeviceState>,
    /// The energy account.
    pub energies: Energies,
}

impl Instant {
    /// Room for an instant of `system`.
    pub fn new(system: &System) -> Self {
        Instant {
            t: 0.0,
            z: Vec::new(),
            v: Vec::new(),
            a: Vec::new(),
            mu: vec![0.0; system.rubs.len()],
            reaction: vec![0.0; system.contacts.len()],
            bonds: vec![BondState::INTACT; system.bonds.len()],
            devices: vec![DeviceState::default(); system.nonlinear.len()],
            energies: Energies::default(),
        }
    }
    /// What it holds.
    pub fn view(&self) -> View<'_> {
        let Instant { t, z, v, a, mu, reaction, bonds, devices, energies } = self;
        View { t: *t, z, v, a, mu, reaction, bonds, devices, energies }
    }
}

/// What a run has done to a device with a law of its own.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct DeviceState {
    /// ζ of (I5), a pure number, or s of (I7) [m]; 0 for a law without history.
    pub internal: f64,
    /// ζ̇ [1/s].
    pub rate: f64,
}

/// Rates of the works in [`Energies`] [W].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Power {
    /// Of the base motion.
    pub base: f64,
    /// Of a driven top.
    pub top: f64,
    /// Lost to damping.
    pub damping: f64,
    /// Lost to friction.
    pub friction: f64,
    /// Lost to the hysteresis of devices.
    pub device: f64,
    /// Lost to the difference of action and reaction.
    pub nonreciprocal: f64,
}

impl Power {
    /// Adds `dt` of these rates to the account.
    pub fn accrue(&self, dt: f64, energies: &mut Energies) {
        energies.input_base += dt * self.base;
        energies.input_top += dt * self.top;
        energies.damping += dt * self.damping;
        energies.friction += dt * self.friction;
        energies.device += dt * self.device;
        energies.nonreciprocal += dt * self.nonreciprocal;
    }
}

/// Tangents of the joints' laws: where the next stage starts from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tangents {
    /// Relative velocity at which (6) is linearised [m/s], per rubbing joint.
    pub velocity: Vec<f64>,
    /// μ there.
    pub mu: Vec<f64>,
    /// dμ/dv there [s/m].
    pub slope: Vec<f64>,
    /// Whether the elastic law acts, per joint.
    pub closed: Vec<bool>,
    /// Whether a joint with a set-valued law sticks, per rubbing joint; `mu` is then the friction that holds it.
    pub stuck: Vec<bool>,
    /// Whether the sides of a rigid joint touch and move as one, per rigid joint.
    pub contact: Vec<bool>,
    /// What they press each other with [N], from 0; 0 while they do not.
    pub reaction: Vec<f64>,
}

impl Tangents {
    /// Of all joints at rest, unilateral joints open (δ = 0).
    pub fn at_rest(system: &System) -> Self {
        let mut tangents = Tangents {
            velocity: vec![0.0; system.rubs.len()],
            mu: vec![0.0; system.rubs.len()],
            slope: system.rubs.iter().map(|r| if r.law.sticks() { 0.0 } else { r.law.slope_at_rest() }).collect(),
            closed: system.elastic.iter().map(|law| !law.unilateral).collect(),
            stuck: system.rubs.iter().map(|r| r.law.sticks()).collect(),
            contact: vec![true; system.contacts.len()],
            reaction: vec![0.0; system.contacts.len()],
        };
        // An intact bond does not rub.
        for r in system.bonds.iter().filter_map(|b| b.rub) {
            tangents.slope[r as usize] = 0.0;
            tangents.stuck[r as usize] = false;
        }
        tangents
    }
    /// Copies without allocating.
    pub fn copy_from(&mut self, other: &Tangents) {
        self.velocity.copy_from_slice(&other.velocity);
        self.mu.copy_from_slice(&other.mu);
        self.slope.copy_from_slice(&other.slope);
        self.closed.copy_from_slice(&other.closed);
        self.stuck.copy_from_slice(&other.stuck);
        self.contact.copy_from_slice(&other.contact);
        self.reaction.copy_from_slice(&other.reaction);
    }
}

impl State {
    /// The motion, friction and energies at its instant.
    pub fn view(&self) -> View<'_> {
        let State { t, z, v, a, bonds, devices, energies, .. } = self;
        View { t: *t, z, v, a, mu: &self.tangents.mu, reaction: &self.tangents.reaction, bonds, devices, energies }
    }

    /// Takes the size of the base shear at its instant [N], with the tops at `top` [m].
    #[inline]
    pub fn raise_base_shear(&mut self, shear: f64, top: f64) {
        self.totals.raise_base_shear(&mut self.marked_shear, shear, self.t, top);
    }

    /// Whether all arrays have the lengths that `system` needs.
    pub fn fits(&self, system: &System) -> bool {
        let (n, e, r) = (system.unknowns(), system.sides.len(), system.rubs.len());
        [&self.z, &self.v, &self.a].iter().all(|x| x.len() == n + 2)
            && self.envelopes.fits(n, e, impacts_of(system))
            && self.joint_power.len() == e
            && [&self.tangents.velocity, &self.tangents.mu, &self.tangents.slope].iter().all(|x| x.len() == r)
            && self.tangents.closed.len() == e
            && self.tangents.stuck.len() == r
            && self.bonds.len() == system.bonds.len()
            && self.devices.len() == system.nonlinear.len()
            && self.leans.len() == system.tops.at_rest().len()
            && self.tangents.contact.len() == system.contacts.len()
            && self.tangents.reaction.len() == system.contacts.len()
    }

    /// At rest at t = 0.
    pub fn at_rest(system: &System) -> Self {
        let (n, e) = (system.unknowns(), system.sides.len());
        let zeros = |n: usize| vec![0.0; n];
        State {
            t: 0.0,
            z: zeros(n + 2),
            v: zeros(n + 2),
            a: zeros(n + 2),
            power: Power::default(),
            step: 0.0,
            step_from_break: f64::INFINITY,
            from_break: false,
            scale: [0.0; 2],
            pull: 0.0,
            joint_power: zeros(e),
            tangents: Tangents::at_rest(system),
            bonds: vec![BondState::INTACT; system.bonds.len()],
            devices: vec![DeviceState::default(); system.nonlinear.len()],
            marked_shear: 0.0,
            leans: system.tops.at_rest(),
            samples: 0,
            energies: Energies::default(),
            envelopes: Envelopes::at_rest(n, e, impacts_of(system)),
            totals: Totals::default(),
            counters: Counters::default(),
        }
    }
}

/// Joints whose impacts are counted: none where none is rigid.
fn impacts_of(system: &System) -> usize {
    if system.contacts.is_empty() { 0 } else { system.sides.len() }
}
