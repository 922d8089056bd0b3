//! What a mechanism in space does, contact by contact.

use super::assembly::{Vector, cross, length, minus, plus};
use super::equations::Equations;
use super::{Problem, radius};
use crate::MechanismKind;
use crate::equations::power;

/// What the four corners of a contact do, per unit of the largest velocity of a block's corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactMotion {
    /// The contact, by index.
    pub contact: usize,
    /// Opening of its corners, (S3), the dilation μ |s| of slip included: from 0, and below it where stones crush.
    pub opening: [f64; 4],
    /// Size of their slip, (S3).
    pub slip: [f64; 4],
    /// Whether it slides: a corner slips and opens by no more than its dilation.
    pub slides: bool,
    /// Whether it opens: a corner opens by more than its dilation.
    pub opens: bool,
}

/// A mechanism in space.
#[derive(Debug, Clone)]
pub struct Mechanism {
    /// How the wall falls.
    pub kind: MechanismKind,
    /// Velocity of every body's centre: the fastest corner has velocity 1.
    pub velocities: Vec<Vector>,
    /// Rotation of every body [1/m], about x, y and z.
    pub rotations: Vec<Vector>,
    /// The contacts that slide or open, by index.
    pub contacts: Vec<ContactMotion>,
}

impl Mechanism {
    /// Velocity of a point of a body.
    pub fn at(&self, problem: &Problem, body: usize, point: Vector) -> Vector {
        let arm = minus(point, problem.assembly.bodies[body].centre);
        plus(self.velocities[body], cross(self.rotations[body], arm))
    }
}

/// Motion below this part of the largest velocity is none.
const NOTHING: f64 = 1e-4;

pub(super) fn describe(problem: &Problem, equations: &Equations, found: &[f64]) -> Mechanism {
    let bodies = &problem.assembly.bodies;
    let three = |body: usize, from: usize| match equations.first[body] {
        Some(row) => [0, 1, 2].map(|k| found[row + from + k]),
        None => [0.0; 3],
    };
    let velocities: Vec<Vector> = (0..bodies.len()).map(|i| three(i, 0)).collect();
    let rotations: Vec<Vector> = (0..bodies.len()).map(|i| three(i, 3).map(|v| v / equations.length)).collect();
    let corner = |i: usize, c: Vector| length(plus(velocities[i], cross(rotations[i], minus(c, bodies[i].centre))));
    let fastest = (0..bodies.len()).flat_map(|i| bodies[i].corners.map(|c| corner(i, c)));
    let fastest = fastest.fold(f64::MIN_POSITIVE, f64::max);
    let mut contacts = Vec::new();
    for (k, points) in equations.points.chunks(4).take(problem.assembly.contacts.len()).enumerate() {
        let mu = problem.assembly.contacts[k].friction;
        let opening = [0, 1, 2, 3].map(|c| power(&points[c].normal, found) / fastest);
        let slip = [0, 1, 2, 3].map(|c: usize| {
            let [a, b] = [0, 1].map(|t| power(&points[c].tangents[t], found));
            a.hypot(b) / fastest
        });
        let opens = |c: usize| opening[c] - mu * slip[c] > NOTHING;
        let slips = |c: usize| slip[c] > NOTHING && !opens(c);
        let motion = ContactMotion { contact: k, opening, slip, slides: (0..4).any(slips), opens: (0..4).any(opens) };
        if motion.slides || motion.opens {
            contacts.push(motion);
        }
    }
    let turns = (0..bodies.len()).any(|i| length(rotations[i]) * radius(&bodies[i]) / fastest > NOTHING);
    let kind = match (contacts.iter().any(|c| c.slides), turns && contacts.iter().any(|c| c.opens)) {
        (true, false) => MechanismKind::Sliding,
        (false, _) => MechanismKind::Overturning,
        (true, true) => MechanismKind::Mixed,
    };
    let per = |all: Vec<Vector>| all.into_iter().map(|v| v.map(|v| v / fastest)).collect();
    Mechanism { kind, velocities: per(velocities), rotations: per(rotations), contacts }
}
