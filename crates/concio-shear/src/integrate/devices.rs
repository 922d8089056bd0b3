//! Devices with laws of their own as the stage sees them: force and tangent over the relative velocity at its end.
//!
//! ζ of (I5) is one more unknown of (S1), eliminated inside the stage: ζ = ζ_p + τ ζ̇(w, ζ) is solved for every w that the
//! iteration tries, and its slope dζ/dw is part of the matrix. s of (I7) is a function of the displacement at the end of
//! the stage and of s before the step. Where the tangent misses the law by much, the next one is drawn where the law
//! meets a line, as for friction.

use concio_law::device::{Law, Origin, Response};

use crate::integrate::joints::{FAR, Joints, MEETING, MOST_SEARCHED};
use crate::integrate::tableau::STAGES;
use crate::state::DeviceState;
use crate::system::System;

/// One device.
#[derive(Debug, Clone)]
struct Fitted {
    law: Law,
    joint: usize,
    /// Before the step.
    start: DeviceState,
    /// ζ̇ of the stages so far, that at the start first.
    rates: [f64; STAGES],
    /// The stage under way.
    stage: usize,
    from: Origin,
    /// w_p.
    before: f64,
    /// Where the tangent is drawn, and the law at the last iterate.
    tangent: Response,
    found: Response,
}

/// Scratch for all devices.
#[derive(Debug, Clone)]
pub struct Devices {
    list: Vec<Fitted>,
    /// The devices at the end of the last stage.
    now: Vec<DeviceState>,
}

impl Devices {
    pub fn new(system: &System) -> Self {
        let fitted = |d: &crate::law::Nonlinear| Fitted {
            law: d.law,
            joint: d.joint as usize,
            start: DeviceState::default(),
            rates: [0.0; STAGES],
            stage: 0,
            from: Origin::default(),
            before: 0.0,
            tangent: Response::default(),
            found: Response::default(),
        };
        let list: Vec<Fitted> = system.nonlinear.iter().map(fitted).collect();
        Devices { now: vec![DeviceState::default(); list.len()], list }
    }

    /// Takes over the devices before a step.
    pub fn hold(&mut self, states: &[DeviceState]) {
        for (device, state) in self.list.iter_mut().zip(states) {
            (device.start, device.stage) = (*state, 0);
            device.rates[0] = state.rate;
            device.from.internal = state.internal;
            device.tangent = Response::default();
        }
    }

    /// ζ_p of stage `i` of a step of `h`, with the row `a` of the scheme.
    #[inline]
    pub fn predict(&mut self, i: usize, h: f64, a: &[f64; STAGES]) {
        for device in &mut self.list {
            let sum: f64 = a[..i].iter().zip(&device.rates).map(|(a, rate)| a * rate).sum();
            (device.stage, device.from.internal) = (i, device.start.internal + h * sum);
        }
    }

    /// Draws tangents at the prediction; true when the matrix changes with them.
    #[inline]
    pub fn start(&mut self, system: &System, [z, v]: [&[f64]; 2], tau: f64) -> bool {
        let mut changed = false;
        for device in &mut self.list {
            let [a, b] = system.sides[device.joint].map(|s| s as usize);
            (device.from.d, device.from.tau) = (z[a] - z[b], tau);
            device.before = v[a] - v[b];
            let slope = device.tangent.slope;
            device.tangent = device.law.respond(device.before, &device.from);
            device.found = device.tangent;
            changed |= device.tangent.slope != slope;
        }
        changed
    }

    /// Visits the slopes over velocity [N s/m]: `add(joint, slope)`.
    #[inline]
    pub fn slopes(&self, mut add: impl FnMut(usize, f64)) {
        for device in self.list.iter().filter(|d| d.tangent.slope != 0.0) {
            add(device.joint, device.tangent.slope);
        }
    }

    /// Visits the forces [N] of the tangents at the prediction.
    #[inline]
    pub fn forces(&self, mut add: impl FnMut(usize, f64)) {
        for device in &self.list {
            let t = &device.tangent;
            add(device.joint, t.force + t.slope * (device.before - t.w));
        }
    }

    /// The laws after a change of the velocities.
    #[inline]
    pub fn look(&mut self, joints: &Joints, change: &[f64]) {
        for device in &mut self.list {
            let [a, b] = joints.sides[device.joint].map(|s| s as usize);
            device.found = device.law.respond(device.before + (change[a] - change[b]), &device.from);
        }
    }

    /// Visits the forces [N] by which the tangents miss the laws.
    #[inline]
    pub fn mismatch(&self, mut add: impl FnMut(usize, f64)) {
        for device in &self.list {
            let (t, f) = (&device.tangent, &device.found);
            add(device.joint, f.force - (t.force + t.slope * (f.w - t.w)));
        }
    }

    /// Draws the next tangents at the last iterate, or where the law meets the line of slope −Z through it; `diagonal` is
    /// that of the matrix without devices. True when the matrix changes.
    #[inline]
    pub fn move_tangents(&mut self, joints: &Joints, diagonal: &[f64], tau: f64) -> bool {
        let mut changed = false;
        for device in &mut self.list {
            let (t, f) = (device.tangent, device.found);
            let target = t.force + t.slope * (f.w - t.w);
            let size = if device.law.size() > 0.0 { device.law.size() } else { f.force.abs().max(target.abs()) };
            device.tangent = if (f.force - target).abs() > FAR * size {
                let [a, b] = joints.sides[device.joint].map(|s| s as usize);
                let free = diagonal[a].recip() + diagonal.get(b).map_or(0.0, |d| d.recip());
                meet(&device.law, &device.from, f, target, 1.0 / (tau * free), MEETING * size)
            } else {
                f
            };
            changed |= device.tangent.slope != t.slope;
        }
        changed
    }

    /// The devices at the solution.
    #[inline]
    pub fn finish(&mut self, joints: &Joints, change: &[f64]) {
        self.look(joints, change);
        for (device, now) in self.list.iter_mut().zip(&mut self.now) {
            let at = &device.found;
            let rate = match device.law {
                Law::BoucWen(_) => (at.internal - device.from.internal) / device.from.tau,
                Law::Power(_) | Law::ReCentring(_) => 0.0,
            };
            device.rates[device.stage] = rate;
            *now = DeviceState { internal: at.internal, rate };
        }
    }

    /// The devices at the end of the last stage.
    pub fn now(&self) -> &[DeviceState] {
        &self.now
    }

    /// Visits what the errors of displacements and of ζ bring into (P1): `add(joint, force)` [N]; `error_z` [m], with 0 of
    /// supports, and the scheme's `weights` of the error, for a step of `h`.
    pub fn errors(
        &self,
        system: &System,
        h: f64,
        weights: &[f64; STAGES],
        error_z: &[f64],
        mut add: impl FnMut(usize, f64),
    ) {
        for device in &self.list {
            let [a, b] = system.sides[device.joint].map(|s| s as usize);
            let moved = error_z[a] - error_z.get(b).copied().unwrap_or(0.0);
            let (at, tau) = (&device.found, device.from.tau);
            let error: f64 = weights.iter().zip(&device.rates).map(|(w, rate)| w * rate).sum();
            add(device.joint, device.law.stiffness_of(at, tau) * moved + device.law.force_of(h * error, at, tau));
        }
    }

    /// ζ inside the accepted step, at the fraction `x` of it, for which the scheme's interpolation gives `of_end` and
    /// `of_stages`, or s at the displacements `z`.
    pub fn inside(
        &self,
        system: &System,
        end: &[DeviceState],
        [of_end, x]: [f64; 2],
        of_stages: &[f64; STAGES],
        z: &[f64],
        at: &mut [DeviceState],
    ) {
        for ((device, end), at) in self.list.iter().zip(end).zip(at) {
            let [a, b] = system.sides[device.joint].map(|s| s as usize);
            let from = device.start.internal;
            let between: f64 = of_stages.iter().zip(&device.rates).map(|(w, rate)| w * rate).sum();
            at.internal = match device.law {
                Law::BoucWen(_) => from + of_end * (end.internal - from) + between,
                Law::ReCentring(_) | Law::Power(_) => device.law.settled(from, z[a] - z[b]),
            };
            at.rate = device.start.rate + x * (end.rate - device.start.rate);
        }
    }
}

/// The law where f(w) + Z w = `target` + Z w_0, from the point `f` at w_0: Newton inside the bracket that a law which never
/// falls leaves. Two digits are enough.
fn meet(law: &Law, from: &Origin, f: Response, target: f64, z: f64, near: f64) -> Response {
    let (w_0, other) = (f.w, f.w - (f.force - target) / z);
    if !other.is_finite() {
        return f;
    }
    let (mut low, mut high) = (w_0.min(other), w_0.max(other));
    let mut found = f;
    for _ in 0..MOST_SEARCHED {
        let excess = found.force + z * (found.w - w_0) - target;
        if excess.abs() <= near {
            break;
        }
        if excess < 0.0 {
            low = found.w;
        } else {
            high = found.w;
        }
        let newton = found.w - excess / (found.slope + z);
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        found = law.respond(next, from);
    }
    found
}
