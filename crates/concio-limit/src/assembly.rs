//! Bodies and contact points of a wall.
//!
//! A joint is a straight line between two blocks, or a block and base or beam. Forces along it are those of two contact
//! points, its ends: between rigid bodies that touch along a line, any normal stress that pushes everywhere has the
//! resultant of two pushes there, and what slides at one end slides at the other. Where there is mortar the line runs in
//! its middle, and each block reaches to it.

use concio::case::JointKind;
use concio::wall::{Block, End, Joint, Wall};
use concio_planar::body::Body;

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
    /// Contact points, two for each joint whose sides touch, in the order of the wall's joints.
    pub points: Vec<ContactPoint>,
}

impl Assembly {
    /// Of a wall, those of its joints ([`concio::graph::joints`]) whose sides touch, and the mass of the load on its blocks [kg].
    pub fn of(wall: &Wall, joints: &[Joint], touch: impl Fn(usize) -> bool, laden: &[f64]) -> Self {
        let bodies = wall.blocks.iter().zip(laden).map(|(block, load)| body(block, *load)).collect();
        let closed = joints.iter().enumerate().filter(|(number, _)| touch(*number));
        let points = closed.flat_map(|(number, joint)| points(wall, number, joint)).collect();
        Assembly { bodies, points }
    }
}

/// A brick as a rigid body: m and m (L² + H²)/12 (model notes, section 7); a polygon with its own moment; with the load that lies on it.
fn body(block: &Block, load: f64) -> Body {
    let mut body = match block.is_rectangle() {
        true => Body::rectangle(&block.name, block.x, block.y, block.mass()),
        false => concio::planar::polygon(block),
    };
    concio::planar::bear(&mut body, block, load);
    body
}

fn points(wall: &Wall, number: usize, joint: &Joint) -> [ContactPoint; 2] {
    let [x0, y0, x1, y1] = place(wall, joint);
    let b = match joint.b {
        End::Block(b) => Other::Body(b),
        End::Base => Other::Base,
        End::Top => Other::Beam,
    };
    // From the left block to the right one, from the lower to the upper; out of a block into base or beam.
    let normal = match joint.kind {
        _ if x0 != x1 && y0 != y1 => across(wall, joint),
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

/// Where the sides of a joint touch: rectangular blocks reach through their mortar to base and beam, as in a run.
fn place(wall: &Wall, joint: &Joint) -> [f64; 4] {
    let [x0, y0, x1, y1] = joint.line;
    match joint.kind {
        JointKind::Base if wall.blocks[joint.a].is_rectangle() => [x0, 0.0, x1, 0.0],
        JointKind::Top if wall.blocks[joint.a].is_rectangle() => {
            let level = concio::planar::top_level(wall);
            [x0, level, x1, level]
        }
        _ => [x0, y0, x1, y1],
    }
}

/// Unit normal of a sloping joint, out of its first block.
fn across(wall: &Wall, joint: &Joint) -> [f64; 2] {
    let [x0, y0, x1, y1] = joint.line;
    let length = (x1 - x0).hypot(y1 - y0);
    let normal = [(y1 - y0) / length, (x0 - x1) / length];
    let centre = wall.blocks[joint.a].centre();
    let outwards = normal[0] * (x0 - centre[0]) + normal[1] * (y0 - centre[1]);
    normal.map(|n| n * outwards.signum())
}
