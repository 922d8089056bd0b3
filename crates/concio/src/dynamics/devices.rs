//! What devices with laws of their own bear, store and take between displacements and velocities that are known.

use crate::device::Nonlinear;
use crate::model::Model;
use crate::record::Energies;
use crate::state::{DeviceState, State};

/// Brings internal variables and their rates to what displacements and velocities of `state` allow.
pub fn settle(model: &Model, state: &mut State) {
    for (device, held) in model.nonlinear.iter().zip(&mut state.devices) {
        let [a, b] = model.sides[device.joint as usize].map(|s| s as usize);
        held.internal = device.law.settled(held.internal, state.z[a] - state.z[b]);
        held.rate = device.law.rate(state.v[a] - state.v[b], held.internal);
    }
}

/// Forces on side a [N]: `add(joint, force)` for every device.
#[inline]
pub fn forces(model: &Model, devices: &[DeviceState], [z, v]: [&[f64]; 2], mut add: impl FnMut(usize, f64)) {
    for (device, state) in model.nonlinear.iter().zip(devices) {
        let e = device.joint as usize;
        let [a, b] = model.sides[e].map(|s| s as usize);
        add(e, device.law.force(z[a] - z[b], v[a] - v[b], state.internal));
    }
}

/// Elastic energy of the devices beyond that of the springs [J].
pub fn stored(model: &Model, devices: &[DeviceState], z: &[f64]) -> f64 {
    let stored = |(device, state): (&Nonlinear, &DeviceState)| {
        let [a, b] = model.sides[device.joint as usize].map(|s| s as usize);
        device.law.stored(z[a] - z[b], state.internal)
    };
    model.nonlinear.iter().zip(devices).map(stored).sum()
}

/// Dissipated on the way from `before` to `after` [J] where no rate says it: `add(joint, energy)`.
pub fn spending(model: &Model, before: &[DeviceState], after: &[DeviceState], mut add: impl FnMut(usize, f64)) {
    for (device, (before, after)) in model.nonlinear.iter().zip(before.iter().zip(after)) {
        let spent = device.law.spent(before.internal, after.internal);
        if spent != 0.0 {
            add(device.joint as usize, spent);
        }
    }
}

/// Their sum into the account.
pub fn book(model: &Model, before: &[DeviceState], after: &[DeviceState], energies: &mut Energies) {
    spending(model, before, after, |_, spent| energies.device += spent);
}
