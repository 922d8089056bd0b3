//! Bodies and contact points of a wall.
//!
//! A joint is a straight line between two blocks, or a block and base or beam. Forces along it are those of two contact
//! points, its ends: between rigid bodies that touch along a line, any normal stress that pushes everywhere has the
//! resultant of two pushes there, and what slides at one end slides at the other. Where there is mortar the line runs in
//! its middle, and each block reaches to it.

use concio::case::JointKind;
use concio::wall::{Block, End, Joint, Wall};

/// A rigid block.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Unique name.
    pub name: String,
    /// Centre of gravity [m].
    pub centre: [f64; 2],
    /// Corners from the centre, counterclockwise [m].
    pub corners: Vec<[f64; 2]>,
    /// Mass [kg].
    pub mass: f64,
    /// Moment of inertia about the centre [kg m²].
    pub inertia: f64,
}

impl Body {
    /// A brick of the wall: m and m (L² + H²)/12 (model notes, section 7).
    pub fn of(block: &Block) -> Self {
        let (l, h) = (0.5 * block.length(), 0.5 * block.height());
        let mass = block.mass();
        Body {
            name: block.name.clone(),
            centre: [0.5 * (block.x[0] + block.x[1]), 0.5 * (block.y[0] + block.y[1])],
            corners: vec![[-l, -h], [l, -h], [l, h], [-l, h]],
            mass,
            inertia: mass * (l * l + h * h) / 3.0,
        }
    }
}

/// What a body touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Other {
    /// Another body, by index.
    Body(usize),
    /// The base.
    Base,
    /// The top beam.
    Beam,
}

/// An end of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPoint {
    /// Joint, by index.
    pub joint: usize,
    /// The body on the side that the normal leaves.
    pub a: usize,
    /// The side that it enters.
    pub b: Other,
    /// Where [m].
    pub at: [f64; 2],
    /// Unit normal from `a` to `b`.
    pub normal: [f64; 2],
    /// Length of the joint that it stands for [m]: half of it.
    pub length: f64,
}

impl ContactPoint {
    /// Unit tangent, the normal turned by a right angle counterclockwise.
    pub fn tangent(&self) -> [f64; 2] {
        [-self.normal[1], self.normal[0]]
    }
}

/// A wall as bodies that touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Assembly {
    /// Bodies, in the order of the wall's blocks.
    pub bodies: Vec<Body>,
    /// Contact points, two for each joint in the order of the wall's joints.
    pub points: Vec<ContactPoint>,
}

impl Assembly {
    /// Of a wall and its joints ([`concio::graph::joints`]).
    pub fn of(wall: &Wall, joints: &[Joint]) -> Self {
        let bodies = wall.blocks.iter().map(Body::of).collect();
        let points = joints.iter().enumerate().flat_map(|(number, joint)| points(number, joint)).collect();
        Assembly { bodies, points }
    }
}

fn points(number: usize, joint: &Joint) -> [ContactPoint; 2] {
    let [x0, y0, x1, y1] = joint.line;
    let b = match joint.b {
        End::Block(b) => Other::Body(b),
        End::Base => Other::Base,
        End::Top => Other::Beam,
    };
    // From the left block to the right one, from the lower to the upper; out of a block into base or beam.
    let normal = match joint.kind {
        JointKind::Head | JointKind::Connection => [1.0, 0.0],
        JointKind::Bed | JointKind::Top => [0.0, 1.0],
        JointKind::Base => [0.0, -1.0],
    };
    [[x0, y0], [x1, y1]].map(|at| ContactPoint {
        joint: number,
        a: joint.a,
        b,
        at,
        normal,
        length: 0.5 * joint.overlap,
    })
}
