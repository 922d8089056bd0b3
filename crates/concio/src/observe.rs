//! Envelopes and totals after every step.
//!
//! Unknowns and joints are gone through in chunks: what belongs to them is gathered one by one into short arrays, over
//! which loops become vector instructions.

use pulp::Arch;

use crate::integrate::dense::extreme;
use crate::law::spring_force;
use crate::model::Model;
use crate::state::State;
use crate::wide::wide;

/// Unknowns or joints that are looked at together.
const CHUNK: usize = 32;

type Values = [f64; CHUNK];

/// Brings envelopes and totals up to date after an accepted step of `h` that began with the
/// displacements and velocities `start`.
pub fn observe(model: &Model, state: &mut State, h: f64, start: [&[f64]; 2]) {
    let mut pull = 0.0;
    wide(
        Arch::new(),
        #[inline(always)]
        || {
            unknowns(model, state, h, start);
            joints(model, state, h, start, &mut pull);
        },
    );
    rubs(model, state, h, &mut pull);
    bonds(model, state, h, start, &mut pull);
    contacts(model, state, &mut pull);
    let totals = &mut state.totals;
    totals.top_force_peak = totals.top_force_peak.max(pull.abs());
    totals.top_force_square += h * pull * pull;
    totals.peak_input = totals.peak_input.max(state.energies.input().abs());
    totals.peak_residual = totals.peak_residual.max(state.energies.residual().abs());
}

/// What stands for the top beam in the joints' sides.
fn top(model: &Model) -> usize {
    model.floating_beam().unwrap_or(model.top())
}

/// The largest of `values`, from 0.
#[inline(always)]
fn largest(values: &[f64]) -> f64 {
    let mut peaks = [0.0f64; 8];
    let (whole, rest) = values.as_chunks::<8>();
    for values in whole {
        for (peak, value) in peaks.iter_mut().zip(values) {
            *peak = peak.max(*value);
        }
    }
    peaks.iter().chain(rest).fold(0.0, |peak, value| value.max(peak))
}

#[inline(always)]
fn raise(peaks: &mut [f64], value: impl Fn(usize) -> f64) {
    for (i, peak) in peaks.iter_mut().enumerate() {
        *peak = peak.max(value(i));
    }
}

/// Peaks of the unknowns, and the scale of the tolerances.
#[inline(always)]
fn unknowns(model: &Model, state: &mut State, h: f64, [z_0, v_0]: [&[f64]; 2]) {
    let (n, blocks) = (model.unknowns(), model.wall.blocks.len());
    let env = &mut state.envelopes;
    let (mut farthest, mut far, mut fast) = ([0.0; CHUNK], [0.0; CHUNK], [0.0; CHUNK]);
    for from in (0..n).step_by(CHUNK) {
        let to = (from + CHUNK).min(n);
        let count = to - from;
        let (z, v, a) = (&state.z[from..to], &state.v[from..to], &state.a[from..to]);
        let (z_0, v_0) = (&z_0[from..to], &v_0[from..to]);
        for i in 0..count {
            far[i] = z[i].abs();
            fast[i] = v[i].abs();
            farthest[i] = far[i].max(extreme([z_0[i], z[i]], [v_0[i], v[i]], h).abs());
        }
        raise(&mut env.block_displacement[from..to], |i| farthest[i]);
        raise(&mut env.block_velocity[from..to], |i| fast[i]);
        for (peak, a) in env.block_acceleration[from..to].iter_mut().zip(a) {
            *peak = peak.max(a.abs());
        }
        state.scale[0] = state.scale[0].max(largest(&far[..count]));
        state.scale[1] = state.scale[1].max(largest(&fast[..count]));
        let moved = largest(&farthest[..blocks.clamp(from, to) - from]);
        state.totals.peak_relative_displacement = state.totals.peak_relative_displacement.max(moved);
    }
}

/// Joints of a chunk: relative displacement and velocity at the start and at the end of the step, relative acceleration,
/// and the elastic law.
struct Gathered {
    d: [Values; 2],
    w: [Values; 2],
    dw: Values,
    stiffness: Values,
    one_sided: [bool; CHUNK],
    upright: [bool; CHUNK],
    rigid: [bool; CHUNK],
}

#[inline(always)]
fn joints(model: &Model, state: &mut State, h: f64, [z_0, v_0]: [&[f64]; 2], pull: &mut f64) {
    let top = top(model);
    let zero = [0.0; CHUNK];
    let none = [false; CHUNK];
    let mut at =
        Gathered { d: [zero; 2], w: [zero; 2], dw: zero, stiffness: zero, one_sided: none, upright: none, rigid: none };
    let mut contacts = model.contacts.iter().map(|c| c.joint as usize).peekable();
    for from in (0..model.joints.len()).step_by(CHUNK) {
        let to = (from + CHUNK).min(model.joints.len());
        let laws = model.elastic[from..to].iter().zip(&model.sides[from..to]).zip(&model.joints[from..to]);
        for (i, ((law, &[a, b]), joint)) in laws.enumerate() {
            let (a, b) = (a as usize, b as usize);
            at.d[0][i] = z_0[a] - z_0[b];
            at.w[0][i] = v_0[a] - v_0[b];
            at.d[1][i] = state.z[a] - state.z[b];
            at.w[1][i] = state.v[a] - state.v[b];
            at.dw[i] = state.a[a] - state.a[b];
            at.stiffness[i] = law.stiffness;
            at.one_sided[i] = law.unilateral;
            at.upright[i] = joint.kind.is_upright();
            at.rigid[i] = contacts.next_if_eq(&(from + i)).is_some();
            if b == top {
                *pull += spring_force(law.unilateral, law.stiffness, at.d[1][i]) + law.damping * at.w[1][i];
            }
        }
        peaks(&at, from, to, state, h);
    }
}

/// Peaks of the joints `from` to `to`.
#[inline(always)]
fn peaks(at: &Gathered, from: usize, to: usize, state: &mut State, h: f64) {
    let (env, totals) = (&mut state.envelopes, &mut state.totals);
    let (mut least, mut most) = ([0.0; CHUNK], [0.0; CHUNK]);
    for i in 0..CHUNK {
        let d = at.d[1][i];
        // Where the relative motion turned inside the step, or its start, which is known already.
        let turn = extreme([at.d[0][i], d], [at.w[0][i], at.w[1][i]], h);
        least[i] = d.min(turn);
        // A rigid joint never closes inside a step, whatever the parabola says.
        most[i] = if at.rigid[i] { d } else { d.max(turn) };
    }
    let force = |i: usize, d: f64| spring_force(at.one_sided[i], at.stiffness[i], d);
    raise(&mut env.joint_displacement[from..to], |i| most[i].max(-least[i]));
    raise(&mut env.joint_velocity[from..to], |i| at.w[1][i].abs());
    raise(&mut env.joint_acceleration[from..to], |i| at.dw[i].abs());
    raise(&mut env.joint_force[from..to], |i| force(i, most[i]).max(-force(i, least[i])));
    // d = x_left − x_right: the gap is −d.
    raise(&mut env.joint_opening[from..to], |i| if at.upright[i] { -least[i] } else { 0.0 });
    raise(&mut env.joint_closing[from..to], |i| if at.upright[i] { most[i] } else { 0.0 });
    let count = to - from;
    let (mut closed, mut slip) = ([0.0; CHUNK], [0.0; CHUNK]);
    for i in 0..count {
        closed[i] = if at.upright[i] { most[i] } else { 0.0 };
        slip[i] = if at.upright[i] { 0.0 } else { at.w[1][i].abs() };
    }
    totals.minimum_gap = totals.minimum_gap.min(-largest(&closed[..count]));
    totals.peak_slip_velocity = totals.peak_slip_velocity.max(largest(&slip[..count]));
}

fn rubs(model: &Model, state: &mut State, h: f64, pull: &mut f64) {
    let top = top(model);
    for (rub, mu) in model.rubs.iter().zip(&state.tangents.mu) {
        let [a, b] = model.sides[rub.joint as usize].map(|s| s as usize);
        let w = (state.v[a] - state.v[b]).abs();
        if w > if rub.law.sticks() { 0.0 } else { rub.law.slip_velocity } {
            state.envelopes.joint_slip[rub.joint as usize] += h * w;
        }
        if b == top {
            *pull += rub.normal[0] * mu;
        }
    }
}

fn bonds(model: &Model, state: &mut State, h: f64, [z_0, v_0]: [&[f64]; 2], pull: &mut f64) {
    let top = top(model);
    for (bond, held) in model.bonds.iter().zip(&mut state.bonds) {
        let e = bond.joint as usize;
        let [a, b] = model.sides[e].map(|s| s as usize);
        let d = state.z[a] - state.z[b];
        let beyond = bond.beyond(&model.elastic[e], held.damage, d);
        let turn = extreme([z_0[a] - z_0[b], d], [v_0[a] - v_0[b], state.v[a] - state.v[b]], h);
        let force = |d: f64| bond.force(&model.elastic[e], bond.law.damage_at(held.damage, d), d).abs();
        held.peak = held.peak.max(force(d)).max(force(turn));
        state.envelopes.joint_force[e] = held.peak;
        if b == top {
            *pull += beyond;
        }
    }
}

fn contacts(model: &Model, state: &mut State, pull: &mut f64) {
    let top = top(model);
    for (contact, borne) in model.contacts.iter().zip(&state.tangents.reaction) {
        let e = contact.joint as usize;
        let force = &mut state.envelopes.joint_force[e];
        *force = force.max(*borne);
        if model.sides[e][1] as usize == top {
            *pull += borne;
        }
    }
}
