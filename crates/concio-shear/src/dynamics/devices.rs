//! What devices with laws of their own bear, store and take between displacements and velocities that are known.

use crate::law::Nonlinear;
use crate::state::{DeviceState, State};
use crate::system::System;
use concio_law::account::Energies;

/// Brings internal variables and their rates to what displacements and velocities of `state` allow.
pub fn settle(system: &System, state: &mut State) {
    for (device, held) in system.nonlinear.iter().zip(&mut state.devices) {
        let [a, b] = system.sides[device.joint as usize].map(|s| s as usize);
        held.internal = device.law.settled(held.internal, state.z[a] - state.z[b]);
        held.rate = device.law.rate(state.v[a] - state.v[b], held.internal);
    }
}

/// Forces on side a [N]: `add(joint, force)` for every device.
#[inline]
pub fn forces(system: &System, devices: &[DeviceState], [z, v]: [&[f64]; 2], mut add: impl FnMut(usize, f64)) {
    for (device, state) in system.nonlinear.iter().zip(devices) {
        let e = device.joint as usize;
        let [a, b] = system.sides[e].map(|s| s as usize);
        add(e, device.law.force(z[a] - z[b], v[a] - v[b], state.internal));
    }
}

/// Elastic energy of the devices beyond that of the springs [J].
pub fn stored(system: &System, devices: &[DeviceState], z: &[f64]) -> f64 {
    let stored = |(device, state): (&Nonlinear, &DeviceState)| {
        let [a, b] = system.sides[device.joint as usize].map(|s| s as usize);
        device.law.stored(z[a] - z[b], state.internal)
    };
    system.nonlinear.iter().zip(devices).map(stored).sum()
}

/// Dissipated on the way from `before` to `after` [J] where no rate says it: `add(joint, energy)`.
pub fn spending(system: &System, before: &[DeviceState], after: &[DeviceState], mut add: impl FnMut(usize, f64)) {
    for (device, (before, after)) in system.nonlinear.iter().zip(before.iter().zip(after)) {
        let spent = device.law.spent(before.internal, after.internal);
        if spent != 0.0 {
            add(device.joint as usize, spent);
        }
    }
}

/// Their sum into the account.
pub fn book(system: &System, before: &[DeviceState], after: &[DeviceState], energies: &mut Energies) {
    spending(system, before, after, |_, spent| energies.device += spent);
}
