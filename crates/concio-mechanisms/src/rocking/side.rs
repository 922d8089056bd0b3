//! Kinematics of a mechanism on one side of its position at rest, and the terms of (OP10).
//!
//! Turn ϑ ≥ 0, X to the side to which it turns, Z up, both from the hinge of the lower body. With r a point's place at rest:
//!
//! ```text
//! lower body   X = r_X cos ϑ + r_Z sin ϑ        Z = r_Z cos ϑ − r_X sin ϑ        X′ = Z, Z′ = −X
//! upper body   X = X_B + r_X cos φ − r_Z sin φ  Z = Z_B + r_X sin φ + r_Z cos φ  (r from the middle hinge B)
//! closure      X_B(ϑ) + c_X cos φ − c_Z sin φ = X_B(0) + c_X                      (the top C stays at its X)
//! ```
//!
//! The closure is solved for φ exactly; φ′ = X_B′/b and φ″ = (X_B″ − φ′² a)/b follow with a, b the turned arm C − B.

use std::f64::consts::FRAC_PI_2;

use concio_law::G;

use super::mechanism::{Floor, Linkage, Mechanism, Member, Part, Place, Rub, Spot, Tie};

/// The arm from the middle hinge to the top counts as down when it is inclined by more than this [rad]: its weight has long overcome it, and the closure is singular
/// where it lies flat.
const LYING: f64 = std::f64::consts::FRAC_PI_3;
/// Places at which the first root of the restoring moment is looked for.
const SCAN: usize = 2000;

/// A point of the chain as it moves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Track {
    /// Place [m].
    pub x: f64,
    pub z: f64,
    /// First and second derivatives after ϑ [m].
    pub dx: f64,
    pub dz: f64,
    pub ddx: f64,
    pub ddz: f64,
}

/// A point of a body: its arm from the hinge of the body, and X at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grip {
    member: Member,
    arm: [f64; 2],
    rest: [f64; 2],
}

/// The chain at one ϑ.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pose {
    sin: f64,
    cos: f64,
    upper: Turned,
}

/// The upper body: its hinge, sine and cosine of its turn, and how it turns on.
#[derive(Debug, Clone, Copy, Default)]
struct Turned {
    hinge: Track,
    sin: f64,
    cos: f64,
    dphi: f64,
    ddphi: f64,
}

/// What bears on the mechanism, by its masses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Mass {
    pub grip: Grip,
    /// Mass that moves to and fro, and up and down [kg].
    pub along: f64,
    pub up: f64,
    /// Moment of inertia about its centre [kg m²].
    inertia: f64,
    /// Force to the side to which it turns [N].
    pub thrust: f64,
    /// Its place among the floors.
    pub floor: Option<usize>,
}

/// The terms of (OP10) at one ϑ.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Terms {
    /// m* [kg m²] and half of its derivative.
    pub inertia: f64,
    pub half_slope: f64,
    /// Σ W Z′: what the weights hold against the turn [N m].
    pub weight: f64,
    /// Σ H X′: what thrusts add to it [N m].
    pub thrust: f64,
    /// Σ m X′ [kg m].
    pub push: f64,
}

/// A mechanism that turns to one side, ready to be evaluated.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Side {
    /// 1 outwards, −1 inwards.
    pub sign: f64,
    /// Hinge of the lower body.
    hinge: [f64; 2],
    /// Middle hinge from that of the lower body, and top from the middle hinge.
    chain: Option<[[f64; 2]; 2]>,
    pub masses: Vec<Mass>,
    pub floors: Vec<Grip>,
    pub ties: Vec<Grip>,
    pub rubs: Vec<Grip>,
    pub control: Grip,
    /// Turn at which it lies on the ground [rad].
    pub end: f64,
}

/// X runs to the side to which it turns, x from the outer face inwards.
fn flipped(sign: f64, at: Place) -> [f64; 2] {
    [-sign * at[0], at[1]]
}

fn less(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

impl Grip {
    fn of(sign: f64, hinge: [f64; 2], chain: Option<[[f64; 2]; 2]>, spot: &Spot) -> Self {
        let rest = less(flipped(sign, spot.at), hinge);
        let arm = match (spot.member, chain) {
            (Member::Upper, Some([middle, _])) => less(rest, middle),
            _ => rest,
        };
        Grip { member: spot.member, arm, rest }
    }
}

/// How a point of the wall has moved.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moved {
    /// How far it has gone outwards and upwards [m].
    pub displacement: [f64; 2],
    /// Velocity outwards [m/s].
    pub velocity: f64,
    /// Acceleration outwards and upwards, relative to the ground [m/s²].
    pub acceleration: [f64; 2],
    /// Turn of its body, positive outwards [rad].
    pub rotation: f64,
}

impl Side {
    /// How a point has moved at a turn to this side, its velocity and its acceleration [rad, rad/s, rad/s²].
    pub fn moved(&self, spot: &Spot, [turn, velocity, acceleration]: [f64; 3]) -> Moved {
        let pose = self.pose(turn);
        let grip = Grip::of(self.sign, self.hinge, self.chain, spot);
        let at = pose.track(&grip);
        let rotation = if spot.member == Member::Lower { turn } else { -pose.upper.sin.atan2(pose.upper.cos) };
        Moved {
            displacement: [self.sign * (at.x - grip.rest[0]), at.z - grip.rest[1]],
            velocity: self.sign * at.dx * velocity,
            acceleration: [
                self.sign * (at.dx * acceleration + at.ddx * velocity * velocity),
                at.dz * acceleration + at.ddz * velocity * velocity,
            ],
            rotation: self.sign * rotation,
        }
    }

    /// Compiles what turns to the side of `sign`.
    pub fn new(mechanism: &Mechanism, linkage: &Linkage, sign: f64) -> Self {
        let flip = |at: Place| flipped(sign, at);
        let (hinge, chain) = match *linkage {
            Linkage::One { hinge } => (flip(hinge), None),
            Linkage::Two { base, middle, top } => {
                let [base, middle, top] = [base, middle, top].map(flip);
                (base, Some([less(middle, base), less(top, middle)]))
            }
        };
        let grip = |spot: &Spot| Grip::of(sign, hinge, chain, spot);
        let part = |part: &Part| {
            let mass = part.weight / G;
            Mass { grip: grip(&part.centre), along: mass, up: mass, inertia: part.inertia, thrust: 0.0, floor: None }
        };
        let floor = |(i, floor): (usize, &Floor)| Mass {
            grip: grip(&floor.at),
            along: floor.pushes / G,
            up: floor.load / G,
            inertia: 0.0,
            thrust: sign * floor.thrust,
            floor: Some(i),
        };
        let floors = mechanism.floors.iter().enumerate().map(floor);
        let mut side = Side {
            sign,
            hinge,
            chain,
            masses: mechanism.parts.iter().map(part).chain(floors).collect(),
            floors: mechanism.floors.iter().map(|floor: &Floor| grip(&floor.at)).collect(),
            ties: mechanism.ties.iter().map(|tie: &Tie| grip(&tie.at)).collect(),
            rubs: mechanism.rubs.iter().map(|rub: &Rub| grip(&rub.at)).collect(),
            control: grip(&mechanism.control),
            end: FRAC_PI_2,
        };
        side.end = side.reach();
        side
    }

    /// Where the chain is at ϑ.
    #[inline]
    pub fn pose(&self, turn: f64) -> Pose {
        let (sin, cos) = turn.sin_cos();
        let mut pose = Pose { sin, cos, upper: Turned::default() };
        let Some([middle, top]) = self.chain else { return pose };
        let hinge = pose.lower(middle);
        let length = top[0].hypot(top[1]);
        // a = c_X cos φ − c_Z sin φ = c sin(δ − φ), tan δ = c_X/c_Z.
        let a = top[0] + middle[0] - hinge.x;
        let phi = top[0].atan2(top[1]) - (a / length).clamp(-1.0, 1.0).asin();
        let (sin, cos) = phi.sin_cos();
        let b = top[0] * sin + top[1] * cos;
        let dphi = hinge.dx / b;
        pose.upper = Turned { hinge, sin, cos, dphi, ddphi: (hinge.ddx - dphi * dphi * a) / b };
        pose
    }

    /// The largest turn that the chain can make [rad].
    fn reach(&self) -> f64 {
        let Some([middle, top]) = self.chain else { return FRAC_PI_2 };
        let lies = |turn: f64| {
            let (sin, cos) = turn.sin_cos();
            let a = top[0] + middle[0] - (middle[0] * cos + middle[1] * sin);
            a < -LYING.sin() * top[0].hypot(top[1])
        };
        let Some(k) = (1..=SCAN).find(|k| lies(*k as f64 / SCAN as f64 * FRAC_PI_2)) else { return FRAC_PI_2 };
        bisect((k - 1) as f64 / SCAN as f64 * FRAC_PI_2, k as f64 / SCAN as f64 * FRAC_PI_2, |turn| !lies(turn))
    }

    /// The terms of (OP10), without floors that are `gone`.
    #[inline]
    pub fn terms(&self, pose: &Pose, gone: &[bool]) -> Terms {
        let mut terms = Terms::default();
        for mass in &self.masses {
            if mass.floor.is_some_and(|floor| gone[floor]) {
                continue;
            }
            let at = pose.track(&mass.grip);
            let (dphi, ddphi) = pose.spin(mass.grip.member);
            terms.inertia += mass.along * at.dx * at.dx + mass.up * at.dz * at.dz + mass.inertia * dphi * dphi;
            terms.half_slope += mass.along * at.dx * at.ddx + mass.up * at.dz * at.ddz + mass.inertia * dphi * ddphi;
            terms.weight += mass.up * G * at.dz;
            terms.thrust += mass.thrust * at.dx;
            terms.push += mass.along * at.dx;
        }
        terms
    }

    /// Momentum outwards and upwards at rest for a unit of velocity that opens it [kg m].
    pub fn momentum(&self, gone: &[bool]) -> [f64; 2] {
        let pose = self.pose(0.0);
        let kept = self.masses.iter().filter(|mass| !mass.floor.is_some_and(|floor| gone[floor]));
        kept.fold([0.0; 2], |sum, mass| {
            let at = pose.track(&mass.grip);
            [sum[0] + self.sign * mass.along * at.dx, sum[1] + mass.up * at.dz]
        })
    }

    /// Energy of place of weights and thrusts, 0 at rest [J].
    pub fn potential(&self, turn: f64, gone: &[bool]) -> f64 {
        let pose = self.pose(turn);
        let kept = self.masses.iter().filter(|mass| !mass.floor.is_some_and(|floor| gone[floor]));
        kept.map(|mass| mass.potential(&pose)).sum()
    }

    /// Turn at which the weights hold no longer, 0 where they do not hold at rest [rad]; none where they always hold. Ties and friction are left out.
    pub fn unstable_from(&self, gone: &[bool]) -> Option<f64> {
        let holds = |turn: f64| {
            let terms = self.terms(&self.pose(turn), gone);
            terms.weight > terms.thrust
        };
        if !holds(0.0) {
            return Some(0.0);
        }
        let place = |k: usize| k as f64 / SCAN as f64 * self.end;
        let k = (1..=SCAN).find(|k| !holds(place(*k)))?;
        Some(bisect(place(k - 1), place(k), holds))
    }

    /// Displacement of a point outwards at ϑ [m].
    #[inline]
    pub fn displacement(&self, pose: &Pose, grip: &Grip) -> f64 {
        self.sign * (pose.track(grip).x - grip.rest[0])
    }

    /// Velocity after an impact on this side's closing over that before, when the other side opens (OP11); 0 where the impact leaves nothing that opens.
    pub fn passes_on(&self, other: &Side, gone: &[bool]) -> f64 {
        let (from, to) = (self.pose(0.0), other.pose(0.0));
        let (mut both, mut new) = (0.0, 0.0);
        for (before, after) in self.masses.iter().zip(&other.masses) {
            if before.floor.is_some_and(|floor| gone[floor]) {
                continue;
            }
            let (old, opened) = (from.track(&before.grip), to.track(&after.grip));
            let (old_spin, new_spin) = (from.spin(before.grip.member).0, to.spin(after.grip.member).0);
            // One side closes and the other opens: to and fro and in turning both go one way, up and down each its own.
            both += before.along * old.dx * opened.dx - before.up * old.dz * opened.dz
                + before.inertia * old_spin * new_spin;
            new += before.along * opened.dx * opened.dx
                + before.up * opened.dz * opened.dz
                + before.inertia * new_spin * new_spin;
        }
        (both / new).max(0.0)
    }
}

impl Mass {
    /// Energy of place, 0 at rest [J].
    pub fn potential(&self, pose: &Pose) -> f64 {
        let at = pose.track(&self.grip);
        self.up * G * (at.z - self.grip.rest[1]) - self.thrust * (at.x - self.grip.rest[0])
    }

    /// Twice the kinetic energy for a unit of ϑ̇² [kg m²].
    pub fn inertia(&self, pose: &Pose) -> f64 {
        let at = pose.track(&self.grip);
        let (dphi, _) = pose.spin(self.grip.member);
        self.along * at.dx * at.dx + self.up * at.dz * at.dz + self.inertia * dphi * dphi
    }
}

impl Pose {
    #[inline]
    fn lower(&self, arm: [f64; 2]) -> Track {
        let x = arm[0] * self.cos + arm[1] * self.sin;
        let z = arm[1] * self.cos - arm[0] * self.sin;
        Track { x, z, dx: z, dz: -x, ddx: -x, ddz: -z }
    }

    /// Place and derivatives of a point.
    #[inline]
    pub fn track(&self, grip: &Grip) -> Track {
        if grip.member == Member::Lower {
            return self.lower(grip.arm);
        }
        let Turned { hinge, sin, cos, dphi, ddphi } = self.upper;
        let a = grip.arm[0] * cos - grip.arm[1] * sin;
        let b = grip.arm[0] * sin + grip.arm[1] * cos;
        Track {
            x: hinge.x + a,
            z: hinge.z + b,
            dx: hinge.dx - dphi * b,
            dz: hinge.dz + dphi * a,
            ddx: hinge.ddx - ddphi * b - dphi * dphi * a,
            ddz: hinge.ddz + ddphi * a - dphi * dphi * b,
        }
    }

    /// Turn of a body for a turn of the lower one, first and second derivative.
    #[inline]
    fn spin(&self, member: Member) -> (f64, f64) {
        match member {
            Member::Lower => (1.0, 0.0),
            Member::Upper => (-self.upper.dphi, -self.upper.ddphi),
        }
    }
}

/// Where `holds` ends between `low`, where it is true, and `high`, where it is not.
fn bisect(low: f64, high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (low, high);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rocking::mechanism::{Back, Restitution};

    /// A chain with a floor on each body, that turns outwards or inwards.
    fn side(sign: f64) -> Side {
        let [t, h] = [0.3, 3.2];
        let mut arch = Mechanism::arch([t, h], 17.28e3, 5e3, 0.1, 0.6, Back::SideWalls(Restitution::Given(0.0)));
        let floor = Floor { thrust: 300.0, pushes: 3e3, ..Floor::carried(Spot::lower([0.1, 1.5]), 2e3) };
        arch.floors.push(floor);
        arch.floors.push(Floor { at: Spot::upper([0.2, 2.8]), ..floor });
        let inwards = Linkage::Two { base: [t, 0.0], middle: [0.0, 0.6 * h], top: [0.2, h] };
        Side::new(&arch, if sign > 0.0 { &arch.linkage } else { &inwards }, sign)
    }

    /// Derivatives are those of places: by differences, at several turns, to both sides.
    #[test]
    fn derivatives_are_those_of_places() {
        let gone = [false; 3];
        for side in [side(1.0), side(-1.0)] {
            for turn in [0.0, 0.03, 0.2, 0.4] {
                let d = 1e-5;
                let [before, at, after] = [turn - d, turn, turn + d].map(|turn| side.pose(turn));
                let close = |what: &str, found: f64, expected: f64, scale: f64| {
                    assert!((found - expected).abs() < 1e-7 * scale, "{what} at {turn}: {found} instead of {expected}");
                };
                for mass in &side.masses {
                    let [a, b, c] = [before, at, after].map(|pose| pose.track(&mass.grip));
                    close("x′", b.dx, (c.x - a.x) / (2.0 * d), 10.0);
                    close("z′", b.dz, (c.z - a.z) / (2.0 * d), 10.0);
                    close("x″", b.ddx, (c.dx - a.dx) / (2.0 * d), 10.0);
                    close("z″", b.ddz, (c.dz - a.dz) / (2.0 * d), 10.0);
                }
                let [a, b, c] = [before, at, after].map(|pose| side.terms(&pose, &gone));
                close("½ m*′", b.half_slope, 0.5 * (c.inertia - a.inertia) / (2.0 * d), 1e5);
                let place = |turn: f64| side.potential(turn, &gone);
                close("U′ − H x′", b.weight - b.thrust, (place(turn + d) - place(turn - d)) / (2.0 * d), 1e5);
                let moved = |pose: &Pose| side.masses.iter().map(|m| m.along * pose.track(&m.grip).x).sum::<f64>();
                close("Σ m x′", b.push, (moved(&after) - moved(&before)) / (2.0 * d), 1e5);
            }
        }
    }

    /// The top of the chain stays where it is held, the arms keep their lengths, and the displacement of a point counts outwards.
    #[test]
    fn the_chain_closes() {
        let [outwards, inwards] = [side(1.0), side(-1.0)];
        for side in [&outwards, &inwards] {
            let top = side.floors[0];
            for turn in [0.0, 0.1, 0.3, 0.99 * side.end] {
                let pose = side.pose(turn);
                assert!(side.displacement(&pose, &top).abs() < 1e-14, "{turn}");
                let (top, hinge) = (pose.track(&top), pose.upper.hinge);
                let [_, arm] = side.chain.unwrap();
                let length = (top.x - hinge.x).hypot(top.z - hinge.z);
                assert!((length - arm[0].hypot(arm[1])).abs() < 1e-14);
            }
        }
        let control = |side: &Side| side.displacement(&side.pose(0.1), &side.control);
        assert!(control(&outwards) > 0.15 && control(&inwards) < -0.15);
    }
}
