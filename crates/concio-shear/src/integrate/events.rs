//! Events: instants at which a law or the motion jumps, and over which no step may pass.
//!
//! A step that was tried is asked for the first of them. The relative displacement of a joint between the ends of a step
//! is taken as the cubic
//!
//!   (V1)  d(θ) = d_0 + θ h w_0 + θ² (3 Δ − h (2 w_0 + w_1)) − θ³ (2 Δ − h (w_0 + w_1)),   Δ = d_1 − d_0
//!
//! through displacements and velocities there. Where it passes its limit by more than is allowed the step is tried again,
//! as long as the cubic says; the nearer its end is to the event the better the cubic, so that few attempts are
//! needed. An attempt that stays short of the event is a step like any other: nothing is lost by taking it.
//! Joints that remember how far they went, s of (I7) and δ_m of (B3), know it at the ends of steps alone: where one turns inside a step so that its memory
//! would miss more than the step may be off, the step ends at the turn.

use crate::dynamics::TOUCHING;
use crate::state::State;
use crate::system::System;
use concio_law::device::Law;

/// By which fraction a brittle bond may exceed its strength when the step ends at which it cracks.
const EXCEEDING: f64 = 1e-7;
/// What sides that touched before may overlap by at last [m], and the least that they come nearer in an event.
const OVERLAP: f64 = 5e-13;
const LEAST: f64 = 5e-16;
/// How near, as a fraction of the step, an event must be to be aimed at before the step is tried.
const NEAR: f64 = 0.01;

/// Relative displacement of a joint at the ends of a step, growing towards the limit.
#[derive(Debug, Clone, Copy)]
struct Path {
    d: [f64; 2],
    w: [f64; 2],
    h: f64,
}

/// What a relative displacement may reach: `target` is where the event is, `limit` what a step must not exceed.
#[derive(Debug, Clone, Copy)]
struct Reach {
    target: f64,
    limit: f64,
}

/// What is watched; every kind of event is a joint whose relative displacement reaches something.
#[derive(Debug, Clone, Copy)]
enum Watch {
    /// A rigid joint that closes.
    Closing,
    /// A brittle bond, which cracks at the relative displacement `limit`.
    Cracking { limit: f64 },
}

impl Watch {
    /// What the relative displacement that is `d` at the start of the step may reach.
    fn reach(self, d: f64) -> Reach {
        match self {
            Watch::Closing => {
                if d < -TOUCHING {
                    return Reach { target: 0.0, limit: TOUCHING };
                }
                // Sides that touch and creep towards each other from rest leave where they are with the square of
                // time: the event is where they have got a little nearer, each time less.
                let room = (0.25 * (OVERLAP - d.max(0.0))).max(LEAST);
                Reach { target: d.max(0.0) + room, limit: d.max(0.0) + 1.5 * room }
            }
            Watch::Cracking { limit } => {
                Reach { target: limit * (1.0 + 0.5 * EXCEEDING), limit: limit * (1.0 + EXCEEDING) }
            }
        }
    }
}

/// Joints that are watched, with the sign that makes the watched displacement grow.
fn watched<'a>(system: &'a System, state: &'a State) -> impl Iterator<Item = (Watch, usize, f64)> + 'a {
    let closing = system.contacts.iter().map(|c| (Watch::Closing, c.joint as usize, 1.0));
    let bonds = system.bonds.iter().zip(&state.bonds);
    let brittle = bonds.filter(|(bond, held)| bond.law.is_brittle() && held.damage == 0.0);
    let cracking = brittle.flat_map(|(bond, _)| {
        let watch = (Watch::Cracking { limit: bond.law.limit() }, bond.joint as usize, -1.0);
        // What is bonded against opening alone does not crack in compression.
        [Some(watch), (!bond.law.opens).then_some((watch.0, watch.1, 1.0))].into_iter().flatten()
    });
    closing.chain(cracking)
}

/// Events that one instant can bring at most.
pub fn at_once(system: &System) -> usize {
    system.contacts.len() + 2 * system.bonds.len()
}

/// When, counted from the start of the step [s], the first event is over which the step of `h` from `state` to `z`, `v`
/// has passed; none when it may be accepted. What a joint remembers may be off by `within` [m].
pub fn first(system: &System, state: &State, [z, v]: [&[f64]; 2], h: f64, within: f64) -> Option<f64> {
    let mut earliest: Option<f64> = None;
    let mut sooner = |at: f64| earliest = Some(earliest.map_or(at, |e| e.min(at)));
    let path = |joint: usize, sign: f64| {
        let [a, b] = system.sides[joint].map(|s| s as usize);
        let d = [sign * (state.z[a] - state.z[b]), sign * (z[a] - z[b])];
        let w = [sign * (state.v[a] - state.v[b]), sign * (v[a] - v[b])];
        Path { d, w, h }
    };
    for (watch, joint, sign) in watched(system, state) {
        let path = path(joint, sign);
        let reach = watch.reach(path.d[0]);
        if path.highest() > reach.limit {
            sooner(h * path.crossing(reach.target));
        }
    }
    let mut turn = |joint: u32, remembers: &dyn Fn(f64, f64) -> f64, known: f64| {
        let up = path(joint as usize, 1.0);
        let sign = up.w[0].signum();
        if up.w[0] * up.w[1] >= 0.0 {
            return;
        }
        let path = path(joint as usize, sign);
        let [at, end] = [path.turning(), path.d[1]];
        let turned = remembers(remembers(known, sign * path.at(at)), sign * end);
        if (turned - remembers(known, sign * end)).abs() > within {
            sooner(h * at);
        }
    };
    for (device, held) in system.nonlinear.iter().zip(&state.devices) {
        if let Law::ReCentring(_) = device.law {
            turn(device.joint, &|known, d| device.law.settled(known, d), held.internal);
        }
    }
    for (bond, held) in
        system.bonds.iter().zip(&state.bonds).filter(|(bond, held)| !bond.law.is_brittle() && held.damage < 1.0)
    {
        turn(bond.joint, &|known, d| known.max(bond.law.stretch(d)), held.reach.max(bond.law.limit()));
    }
    // Shorter at any rate: attempts must come to an end.
    earliest.map(|at| at.min(h * (1.0 - 1e-9)))
}

/// When, counted from the start of a step of `h` [s], a relative displacement that is below `target` there reaches it, if
/// it is beyond it at the end; `d` and `w` are those at start and end.
pub fn reaches(d: [f64; 2], w: [f64; 2], h: f64, target: f64) -> f64 {
    if d[0] < target && h > 0.0 { h * Path { d, w, h }.crossing(target) } else { 0.0 }
}

/// When the next event is, if it is so near that it can be aimed at before a step of `h` [s] is tried: velocity and
/// acceleration say it.
pub fn near(system: &System, state: &State, h: f64) -> Option<f64> {
    let mut earliest = NEAR * h;
    let mut found = None;
    for (watch, joint, sign) in watched(system, state) {
        let [a, b] = system.sides[joint].map(|s| s as usize);
        let (d, w) = (sign * (state.z[a] - state.z[b]), sign * (state.v[a] - state.v[b]));
        let way = watch.reach(d).target - d;
        if w > 0.0 && way > TOUCHING && way < earliest * w {
            let root = w * w + 2.0 * sign * (state.a[a] - state.a[b]) * way;
            let at = if root > 0.0 { 2.0 * way / (w + root.sqrt()) } else { way / w };
            earliest = at;
            found = Some(at);
        }
    }
    found
}

impl Path {
    /// (V1).
    fn at(&self, theta: f64) -> f64 {
        let (rise, [w0, w1]) = (self.d[1] - self.d[0], self.w.map(|w| self.h * w));
        self.d[0] + theta * (w0 + theta * ((3.0 * rise - 2.0 * w0 - w1) - theta * (2.0 * rise - w0 - w1)))
    }

    /// The largest displacement: at the end, or inside where it first grows and then falls.
    fn highest(&self) -> f64 {
        if self.w[0] > 0.0 && self.w[1] < 0.0 { self.at(self.turning()).max(self.d[1]) } else { self.d[1] }
    }

    /// Where the velocity, from above 0 at the start to below it at the end, is 0.
    fn turning(&self) -> f64 {
        let (rise, [w0, w1]) = (self.d[1] - self.d[0], self.w.map(|w| self.h * w));
        let (a, b) = (-3.0 * (2.0 * rise - w0 - w1), 2.0 * (3.0 * rise - 2.0 * w0 - w1));
        bisect(|t| w0 + t * (b + t * a), 1.0)
    }

    /// Where the displacement first reaches `target`, which it passes.
    fn crossing(&self, target: f64) -> f64 {
        let end = if self.d[1] > target { 1.0 } else { self.turning() };
        bisect(|t| target - self.at(t), end)
    }
}

/// Where `f`, positive at 0 and not at `end`, changes its sign: regula falsi (Illinois) inside bisection.
fn bisect(f: impl Fn(f64) -> f64, end: f64) -> f64 {
    let (mut low, mut high) = (0.0, end);
    let (mut at_low, mut at_high) = (f(low), f(high));
    for _ in 0..100 {
        let secant = low + (high - low) * at_low / (at_low - at_high);
        let inside = secant > low && secant < high;
        let t = if inside { secant } else { 0.5 * (low + high) };
        if !(t > low && t < high) {
            break;
        }
        let value = f(t);
        if value == 0.0 {
            return t;
        }
        if value > 0.0 {
            (low, at_low) = (t, value);
            at_high *= 0.5;
        } else {
            (high, at_high) = (t, value);
            at_low *= 0.5;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path that is a cubic is followed exactly: where it first reaches a level, though it ends below it.
    #[test]
    fn the_first_crossing_of_a_cubic_is_found() {
        // d = −(θ − 0.3)(θ − 0.6)(θ + 1), h = 2.
        let d = |t: f64| -(t - 0.3) * (t - 0.6) * (t + 1.0);
        let slope = |t: f64| -((t - 0.6) * (t + 1.0) + (t - 0.3) * (t + 1.0) + (t - 0.3) * (t - 0.6));
        let path = Path { d: [d(0.0), d(1.0)], w: [slope(0.0) / 2.0, slope(1.0) / 2.0], h: 2.0 };
        for t in [0.1, 0.3, 0.45, 0.9] {
            assert!((path.at(t) - d(t)).abs() < 1e-15);
        }
        assert!(path.highest() > 0.0, "{}", path.highest());
        assert!((path.crossing(0.0) - 0.3).abs() < 1e-12, "{}", path.crossing(0.0));
    }

    /// A body that starts at rest on the limit leaves it with the square of time: the crossing is found all the same.
    #[test]
    fn a_start_at_rest_on_the_limit_is_no_dead_end() {
        let reach = Watch::Closing.reach(0.0);
        let h = 1e-4;
        let path = Path { d: [0.0, 0.5 * 100.0 * h * h], w: [0.0, 100.0 * h], h };
        assert!(path.highest() > reach.limit);
        let t = h * path.crossing(reach.target);
        assert!((0.5 * 100.0 * t * t / reach.target - 1.0).abs() < 1e-9, "{t}");
    }
}
