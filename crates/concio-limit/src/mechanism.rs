//! What a mechanism does, joint by joint.

use crate::Problem;
use crate::equations::Equations;

/// How a wall falls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MechanismKind {
    /// Joints slide, and what opens beside them does so without a turn of any block.
    Sliding,
    /// Joints open, none slides.
    Overturning,
    /// Both.
    Mixed,
}

impl MechanismKind {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            MechanismKind::Sliding => "sliding",
            MechanismKind::Overturning => "overturning",
            MechanismKind::Mixed => "mixed",
        }
    }

    /// What it means.
    pub fn what(self) -> &'static str {
        match self {
            MechanismKind::Sliding => "sliding: no block turns",
            MechanismKind::Overturning => "overturning: no joint slides",
            MechanismKind::Mixed => "mixed: joints slide and joints open",
        }
    }
}

/// What the two ends of a joint do, per unit of the largest velocity of a block's corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointMotion {
    /// The joint, by index.
    pub joint: usize,
    /// Opening of its ends, (L3), from 0: the dilation μ |s| of slip included.
    pub opening: [f64; 2],
    /// Slip of its ends, (L3).
    pub slip: [f64; 2],
    /// Whether it slides: an end slips and opens by no more than its dilation.
    pub slides: bool,
    /// Whether it opens: an end opens by more than its dilation.
    pub opens: bool,
}

/// A mechanism.
#[derive(Debug, Clone)]
pub struct Mechanism {
    /// How the wall falls.
    pub kind: MechanismKind,
    /// Velocity of every body's centre and its rotation, counterclockwise: the fastest corner has velocity 1, so that
    /// rotations are per metre [1/m].
    pub velocities: Vec<[f64; 3]>,
    /// The joints that slide or open, by index.
    pub joints: Vec<JointMotion>,
}

/// Motion below this part of the largest velocity is none.
const NOTHING: f64 = 1e-5;

pub(super) fn describe(problem: &Problem, equations: &Equations, velocities: &[f64]) -> Mechanism {
    let bodies = &problem.assembly.bodies;
    let corner = |v: [f64; 3], r: &[f64; 2]| (v[0] - v[2] * r[1]).hypot(v[1] + v[2] * r[0]);
    let of = |body: usize| {
        let turn = if problem.level == Some(body) { 0.0 } else { velocities[3 * body + 2] / equations.length };
        [velocities[3 * body], velocities[3 * body + 1], turn]
    };
    let fastest = (0..bodies.len()).flat_map(|i| bodies[i].corners.iter().map(move |r| corner(of(i), r)));
    let fastest = fastest.fold(f64::MIN_POSITIVE, f64::max);
    let rates = equations.rates(velocities);
    let mut joints = Vec::new();
    let ends = rates.chunks_exact(2).zip(problem.assembly.points.chunks_exact(2));
    for (pair, (rates, points)) in ends.enumerate() {
        let end = |k: usize| [rates[k][0] / fastest, rates[k][1] / fastest];
        let mu = problem.friction[2 * pair];
        let opens = |k: usize| end(k)[0] - mu * end(k)[1].abs() > NOTHING;
        let slips = |k: usize| end(k)[1].abs() > NOTHING && !opens(k);
        let motion = JointMotion {
            joint: points[0].joint,
            opening: [end(0)[0], end(1)[0]],
            slip: [end(0)[1], end(1)[1]],
            slides: slips(0) || slips(1),
            opens: opens(0) || opens(1),
        };
        if motion.slides || motion.opens {
            joints.push(motion);
        }
    }
    let turns = |i: usize| {
        let radius = bodies[i].corners.iter().map(|r| r[0].hypot(r[1])).fold(0.0, f64::max);
        of(i)[2].abs() * radius / fastest > NOTHING
    };
    let opens = joints.iter().any(|j| j.opens) && (0..bodies.len()).any(turns);
    let kind = match (joints.iter().any(|j| j.slides), opens) {
        (true, false) => MechanismKind::Sliding,
        (false, _) => MechanismKind::Overturning,
        (true, true) => MechanismKind::Mixed,
    };
    let velocities = (0..bodies.len()).map(|i| of(i).map(|v| v / fastest)).collect();
    Mechanism { kind, velocities, joints }
}
