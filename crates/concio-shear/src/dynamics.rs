//! Forces, envelopes and energies of a state.

use crate::law::spring_force;
use crate::law::{Elastic, Support};
use crate::state::{DeviceState, Power, State, Tangents, View};
use crate::system::System;
use concio_law::account::Energies;
use concio_law::bond::BondState;
use concio_law::motion::Drive;

pub mod devices;

/// How near to each other the sides of a rigid joint touch [m].
pub const TOUCHING: f64 = 1e-13;

/// Displacements and velocities with what the laws are there.
#[derive(Debug, Clone, Copy)]
pub struct Moving<'a> {
    /// [m]
    pub z: &'a [f64],
    /// [m/s]
    pub v: &'a [f64],
    /// What the laws are there.
    pub laws: &'a Tangents,
    /// The bonds at the start of the step.
    pub bonds: &'a [BondState],
    /// The devices, at this instant.
    pub devices: &'a [DeviceState],
}

/// What bonds change of the elastic forces on side a [N]: `change(joint, force)` for every one.
fn bonds_beyond(system: &System, bonds: &[BondState], z: &[f64], mut change: impl FnMut(usize, f64)) {
    for (bond, state) in system.bonds.iter().zip(bonds) {
        let e = bond.joint as usize;
        let [a, b] = system.sides[e].map(|s| s as usize);
        let d = z[a] - z[b];
        change(e, bond.beyond(&system.elastic[e], bond.law.damage_at(state.damage, d), d));
    }
}

/// Motion and laws, from which forces follow.
#[derive(Debug, Clone, Copy)]
pub struct Acting<'a> {
    z: &'a [f64],
    v: &'a [f64],
    mu: &'a [f64],
    reaction: &'a [f64],
    bonds: &'a [BondState],
    devices: &'a [DeviceState],
}

impl<'a> Acting<'a> {
    /// Of a state, or of an instant inside a step.
    pub fn of(at: View<'a>) -> Self {
        Acting { z: at.z, v: at.v, mu: at.mu, reaction: at.reaction, bonds: at.bonds, devices: at.devices }
    }
}

/// Horizontal force of the joints of a support on the blocks that lie at it, against the blocks' motion relative to it [N].
pub fn borne_by(system: &System, support: &Support, at: Acting<'_>) -> f64 {
    let sides = |e: u32| system.sides[e as usize].map(|s| s as usize);
    let mut borne = 0.0;
    for &e in &support.joints {
        let ([a, b], law) = (sides(e), &system.elastic[e as usize]);
        let d = at.z[a] - at.z[b];
        borne += law.damping * (at.v[a] - at.v[b]) + spring_force(law.unilateral, law.stiffness, d);
    }
    for &r in &support.rubs {
        borne += system.rubs[r as usize].normal[0] * at.mu[r as usize];
    }
    for &k in &support.bonds {
        let (bond, held) = (&system.bonds[k as usize], &at.bonds[k as usize]);
        let [a, b] = sides(bond.joint);
        let d = at.z[a] - at.z[b];
        borne += bond.beyond(&system.elastic[bond.joint as usize], bond.law.damage_at(held.damage, d), d);
    }
    for &k in &support.devices {
        let (device, held) = (&system.nonlinear[k as usize], &at.devices[k as usize]);
        let [a, b] = sides(device.joint);
        borne += device.law.force(at.z[a] - at.z[b], at.v[a] - at.v[b], held.internal);
    }
    for &c in &support.contacts {
        borne += at.reaction[c as usize];
    }
    borne
}

/// Force of a joint as it acts on side a, with the sign of (2)–(5): `(elastic, viscous, friction)` [N]. What a rigid joint
/// bears counts as elastic, the law of its own of a device as friction; what a bond changes is left out.
pub fn joint_forces(system: &System, at: View, index: [Option<usize>; 3], joint: usize) -> (f64, f64, f64) {
    let [rub, contact, device] = index;
    let [a, b] = system.sides[joint].map(|s| s as usize);
    let (d, w) = (at.z[a] - at.z[b], at.v[a] - at.v[b]);
    let law = &system.elastic[joint];
    let friction = match device {
        Some(k) => system.nonlinear[k].law.force(d, w, at.devices[k].internal),
        None => rub.map_or(0.0, |r| system.rubs[r].normal[0] * at.mu[r]),
    };
    let borne = contact.map_or(0.0, |c| at.reaction[c]);
    (spring_force(law.unilateral, law.stiffness, d) + borne, law.damping * w, friction)
}

/// Rates of the energy account, and of each joint's dissipation into `joint` [W].
pub fn power(system: &System, at: Moving<'_>, ground: f64, joint: &mut [f64]) -> Power {
    let Moving { z, v, laws, bonds, devices } = at;
    let mut p = Power::default();
    for (m, v) in system.mass.iter().zip(v) {
        p.base -= m * v;
    }
    p.base *= ground;
    for (e, (law, &[a, b])) in system.elastic.iter().zip(&system.sides).enumerate() {
        let w = v[a as usize] - v[b as usize];
        joint[e] = law.damping * w * w;
        p.damping += joint[e];
    }
    for (rub, &mu) in system.rubs.iter().zip(&laws.mu) {
        let [a, b] = system.sides[rub.joint as usize];
        let (a, b) = (a as usize, b as usize);
        let lost = 0.5 * (rub.normal[0] + rub.normal[1]) * mu * (v[a] - v[b]);
        p.friction += lost;
        joint[rub.joint as usize] += lost;
        if !system.reciprocal && b < system.unknowns() {
            p.nonreciprocal += 0.5 * (rub.normal[0] - rub.normal[1]) * mu * (v[a] + v[b]);
        }
    }
    for (device, held) in system.nonlinear.iter().zip(devices) {
        let e = device.joint as usize;
        let [a, b] = system.sides[e].map(|s| s as usize);
        let lost = device.law.lost(v[a] - v[b], held.internal);
        *if device.law.is_viscous() { &mut p.damping } else { &mut p.device } += lost;
        joint[e] += lost;
    }
    // A beam with mass does no work from outside, and the top is at rest beside it. Closed, a rigid joint does no work
    // but that of the support that it presses.
    let at = Acting { z, v, mu: &laws.mu, reaction: &laws.reaction, bonds, devices };
    p.top = -borne_by(system, &system.on_beam, at) * v[system.top()];
    p
}

/// Makes tangents, accelerations and powers consistent with displacements, velocities and motion at `state.t`:
/// at the start, and where the motion has a jump.
pub fn settle(system: &System, drive: &Drive, state: &mut State) {
    let n = system.unknowns();
    let top = drive.top(state.t);
    state.z[n + 1] = top.u;
    state.v[n + 1] = top.v;
    for (e, (law, &[a, b])) in system.elastic.iter().zip(&system.sides).enumerate() {
        if law.unilateral {
            state.tangents.closed[e] = state.z[a as usize] - state.z[b as usize] > 0.0;
        }
    }
    for (r, rub) in system.rubs.iter().enumerate() {
        let [a, b] = system.sides[rub.joint as usize].map(|s| s as usize);
        let w = state.v[a] - state.v[b];
        // A set-valued joint at rest sticks, held by the force that held it, until it is found to let go.
        state.tangents.stuck[r] = rub.law.sticks() && w == 0.0;
        if !state.tangents.stuck[r] {
            (state.tangents.mu[r], state.tangents.slope[r]) = rub.law.at(w);
        }
        state.tangents.velocity[r] = w;
    }
    // Of a bonded joint the cracked part rubs, if there is any.
    for (bond, held) in system.bonds.iter().zip(&state.bonds) {
        let rubs = bond.law.rubbing(held);
        let Some(r) = bond.rub.map(|r| r as usize).filter(|_| rubs < 1.0) else { continue };
        let law = system.rubs[r].law.times(rubs);
        state.tangents.stuck[r] &= rubs > 0.0;
        if !state.tangents.stuck[r] {
            (state.tangents.mu[r], state.tangents.slope[r]) = law.at(state.tangents.velocity[r]);
        }
    }
    for (c, contact) in system.contacts.iter().enumerate() {
        let [a, b] = system.sides[contact.joint as usize].map(|s| s as usize);
        let touches = state.z[a] - state.z[b] >= -TOUCHING;
        state.tangents.contact[c] = touches && state.v[a] == state.v[b];
        if !state.tangents.contact[c] {
            state.tangents.reaction[c] = 0.0;
        }
    }
    devices::settle(system, state);
    accelerate(system, drive, state);
}

/// Accelerations and powers from displacements, velocities, friction in `state.tangents` and motion at `state.t`.
pub fn accelerate(system: &System, drive: &Drive, state: &mut State) {
    let n = system.unknowns();
    let ground = drive.base_acceleration(state.t);
    state.a.fill(0.0);
    for (law, &[a, b]) in system.elastic.iter().zip(&system.sides) {
        let (a, b) = (a as usize, b as usize);
        let (d, w) = (state.z[a] - state.z[b], state.v[a] - state.v[b]);
        let f = law.damping * w + spring_force(law.unilateral, law.stiffness, d);
        state.a[a] -= f;
        state.a[b] += f;
    }
    let a = &mut state.a;
    bonds_beyond(system, &state.bonds, &state.z, |e, force| {
        let [i, k] = system.sides[e].map(|s| s as usize);
        a[i] -= force;
        a[k] += force;
    });
    devices::forces(system, &state.devices, [&state.z, &state.v], |e, force| {
        let [i, k] = system.sides[e].map(|s| s as usize);
        a[i] -= force;
        a[k] += force;
    });
    for (rub, mu) in system.rubs.iter().zip(&state.tangents.mu) {
        let [a, b] = system.sides[rub.joint as usize].map(|s| s as usize);
        state.a[a] -= rub.normal[0] * mu;
        state.a[b] += rub.normal[1] * mu;
    }
    for (contact, borne) in system.contacts.iter().zip(&state.tangents.reaction) {
        let [a, b] = system.sides[contact.joint as usize].map(|s| s as usize);
        state.a[a] -= borne;
        state.a[b] += borne;
    }
    for (a, m) in state.a.iter_mut().zip(&system.mass) {
        *a = *a / m - ground;
    }
    state.a[n] = 0.0;
    state.a[n + 1] = drive.top(state.t).a;
    let (bonds, devices) = (&state.bonds, &state.devices);
    let at = Moving { z: &state.z, v: &state.v, laws: &state.tangents, bonds, devices };
    state.power = power(system, at, ground, &mut state.joint_power);
}

/// Brings envelopes and totals up to date after an accepted step of `h` that began with the
/// displacements and velocities `start`.
pub fn observe(system: &System, state: &mut State, h: f64, start: [&[f64]; 2]) {
    let n = system.unknowns();
    let [z_0, v_0] = start;
    let [shear, pull] =
        [&system.on_base, &system.on_beam].map(|support| borne_by(system, support, Acting::of(state.view())));
    let env = &mut state.envelopes;
    let mut largest = 0.0f64;
    for i in 0..n {
        let (z, v) = (state.z[i].abs(), state.v[i].abs());
        let farthest = z.max(extreme([z_0[i], state.z[i]], [v_0[i], state.v[i]], h).abs());
        if i < system.blocks {
            largest = largest.max(farthest);
        }
        env.block_displacement[i] = env.block_displacement[i].max(farthest);
        env.block_velocity[i] = env.block_velocity[i].max(v);
        env.block_acceleration[i] = env.block_acceleration[i].max(state.a[i].abs());
        state.scale[0] = state.scale[0].max(z);
        state.scale[1] = state.scale[1].max(v);
    }
    let totals = &mut state.totals;
    totals.peak_relative_displacement = totals.peak_relative_displacement.max(largest);
    let mut contacts = system.contacts.iter().peekable();
    for (e, (law, &[a, b])) in system.elastic.iter().zip(&system.sides).enumerate() {
        let (a, b) = (a as usize, b as usize);
        let (d, w, dw) = (state.z[a] - state.z[b], state.v[a] - state.v[b], state.a[a] - state.a[b]);
        // Where the relative motion turned inside the step, or its start, which is known already.
        let turn = extreme([z_0[a] - z_0[b], d], [v_0[a] - v_0[b], w], h);
        // A rigid joint never closes inside a step, whatever the parabola says.
        let rigid = contacts.next_if(|c| c.joint as usize == e).is_some();
        let (least, most) = (d.min(turn), if rigid { d } else { d.max(turn) });
        env.joint_displacement[e] = env.joint_displacement[e].max(most.max(-least));
        env.joint_velocity[e] = env.joint_velocity[e].max(w.abs());
        env.joint_acceleration[e] = env.joint_acceleration[e].max(dw.abs());
        let force = |d: f64| spring_force(law.unilateral, law.stiffness, d);
        env.joint_force[e] = env.joint_force[e].max(force(most).max(-force(least)));
        if system.upright[e] {
            // d = x_left − x_right: the gap is −d.
            env.joint_opening[e] = env.joint_opening[e].max(-least);
            env.joint_closing[e] = env.joint_closing[e].max(most);
            totals.minimum_gap = totals.minimum_gap.min(-most);
        } else {
            totals.peak_slip_velocity = totals.peak_slip_velocity.max(w.abs());
        }
    }
    let mut bonds = system.bonds.iter().zip(&state.bonds).peekable();
    for (rub, mu) in system.rubs.iter().zip(&state.tangents.mu) {
        while bonds.next_if(|(bond, _)| bond.joint < rub.joint).is_some() {}
        // What an intact bond lets its blocks move is no slip.
        let holds = bonds.peek().is_some_and(|(bond, held)| bond.joint == rub.joint && !held.cracked.is_finite());
        totals.peak_friction_force = totals.peak_friction_force.max(rub.largest_normal() * mu.abs());
        let [a, b] = system.sides[rub.joint as usize].map(|s| s as usize);
        let fastest = (state.v[a] - state.v[b]).abs().max((v_0[a] - v_0[b]).abs());
        // At an impact velocities jump and nothing moves.
        if h > 0.0 && !holds && fastest > if rub.law.sticks() { 0.0 } else { rub.law.slip_velocity } {
            env.joint_slip[rub.joint as usize] += ((state.z[a] - state.z[b]) - (z_0[a] - z_0[b])).abs();
        }
    }
    for (bond, held) in system.bonds.iter().zip(&mut state.bonds) {
        let e = bond.joint as usize;
        let [a, b] = system.sides[e].map(|s| s as usize);
        let d = state.z[a] - state.z[b];
        let turn = extreme([z_0[a] - z_0[b], d], [v_0[a] - v_0[b], state.v[a] - state.v[b]], h);
        let force = |d: f64| bond.force(&system.elastic[e], bond.law.damage_at(held.damage, d), d).abs();
        held.peak = held.peak.max(force(d)).max(force(turn));
        env.joint_force[e] = held.peak;
    }
    devices::forces(system, &state.devices, [&state.z, &state.v], |e, force| {
        let [a, b] = system.sides[e].map(|s| s as usize);
        // Spring and law of its own: what the device holds its sides together with.
        let whole = system.elastic[e].stiffness * (state.z[a] - state.z[b]) + force;
        env.joint_force[e] = env.joint_force[e].max(whole.abs());
    });
    for (contact, borne) in system.contacts.iter().zip(&state.tangents.reaction) {
        let e = contact.joint as usize;
        env.joint_force[e] = env.joint_force[e].max(*borne);
    }
    state.raise_base_shear(shear.abs(), system.tops.of_wall(|i| state.z[i]));
    system.tops.follow(&mut state.leans, [state.t - h, state.t], system.settles, |i| state.z[i]);
    let totals = &mut state.totals;
    totals.top_force_peak = totals.top_force_peak.max(pull.abs());
    totals.top_force_square += 0.5 * h * (state.pull * state.pull + pull * pull);
    state.pull = pull;
    totals.peak_input = totals.peak_input.max(state.energies.input().abs());
    totals.peak_work = totals.peak_work.max(state.energies.works());
    totals.peak_residual = totals.peak_residual.max(state.energies.residual().abs());
}

/// Kinetic and elastic energy at displacements `z` and velocities `v`; `bonds` as before the step that leads there,
/// `devices` as they are there.
pub fn stored_energy(
    system: &System,
    bonds: &[BondState],
    devices: &[DeviceState],
    [z, v]: [&[f64]; 2],
    energies: &mut Energies,
) {
    energies.kinetic = system.mass.iter().zip(v).map(|(m, v)| 0.5 * m * v * v).sum();
    let moved = |e: usize| z[system.sides[e][0] as usize] - z[system.sides[e][1] as usize];
    let of_joint = |(e, law): (usize, &Elastic)| 0.5 * spring_force(law.unilateral, law.stiffness, moved(e)) * moved(e);
    let mut elastic: f64 = system.elastic.iter().enumerate().map(of_joint).sum();
    bonds_beyond(system, bonds, z, |e, force| elastic += 0.5 * force * moved(e));
    energies.elastic = elastic + devices::stored(system, devices, z);
}

/// Makes an impact part of the account: `before`, `after` are w⁻ and w⁺ [m/s] of the rigid joints and `impulse` what they
/// bore [N s]. What a joint loses is p (w⁻ + w⁺)/2, which is ½ m_eff (1 − e²) w⁻² where one alone closes. Impacts that
/// exceed all earlier ones of their joint by a tenth are told to `tell` by joint and impulse.
pub fn book_impact(
    system: &System,
    state: &mut State,
    [before, after, impulse]: [&[f64]; 3],
    mut tell: impl FnMut(u32, f64),
) {
    let env = &mut state.envelopes;
    for (c, contact) in system.contacts.iter().enumerate().filter(|(c, _)| impulse[*c] > 0.0) {
        let (e, p) = (contact.joint as usize, impulse[c]);
        let lost = 0.5 * p * (before[c] + after[c]);
        state.energies.impact += lost;
        env.joint_dissipation[e] += lost;
        if system.sides[e][1] as usize == system.top() {
            state.energies.input_top -= p * state.v[system.top()];
        }
        if p > NOTABLE * env.joint_impulse[e] {
            tell(contact.joint, p);
        }
        env.joint_impulse[e] = env.joint_impulse[e].max(p);
        env.joint_impacts[e] += 1.0;
        state.counters.impacts += 1;
    }
}

/// Impulse from which an impact is listed, over the largest before it in its joint.
const NOTABLE: f64 = 1.1;

/// The base's velocity jumps by `jump`: blocks keep their absolute velocity. What this does to the kinetic energy of
/// the relative motion is work of the base.
pub fn kick(system: &System, state: &mut State, jump: f64) {
    let n = system.unknowns();
    let kinetic = |v: &[f64]| system.mass.iter().zip(v).map(|(m, v)| 0.5 * m * v * v).sum::<f64>();
    let before = kinetic(&state.v[..n]);
    for v in &mut state.v[..n] {
        *v -= jump;
    }
    let after = kinetic(&state.v[..n]);
    state.energies.input_base += after - before;
    state.energies.kinetic = after;
}

/// Largest size of these values.
pub fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |p, v| v.abs().max(p))
}

/// Largest |z| inside a step of `h` [s] whose ends have displacements `z`, velocities `v`: that of the ends, or where
/// the velocity, linear between them, passes zero.
#[inline(always)]
pub fn extreme(z: [f64; 2], v: [f64; 2], h: f64) -> f64 {
    // θ of the turn if there is one; otherwise 0, where it is the start.
    let turns = v[0] * v[1] < 0.0;
    let at = if turns { v[0] / (v[0] - v[1]) } else { 0.0 };
    z[0] + 0.5 * h * at * v[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A parabola's turn is met exactly.
    #[test]
    fn turns_inside_a_step_are_seen() {
        let (h, turn, peak) = (0.2, 0.07, 3.0);
        let (z, v) = (|t: f64| peak - (t - turn).powi(2), |t: f64| -2.0 * (t - turn));
        assert!((extreme([z(0.0), z(h)], [v(0.0), v(h)], h) - peak).abs() < 1e-15);
        assert_eq!(extreme([1.0, 2.0], [0.5, 0.5], h), 1.0);
    }
}
