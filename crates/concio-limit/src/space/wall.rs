//! A planar wall extruded by its thickness.
//!
//! The wall's x becomes y, its y becomes z. Blocks start at x = 0, the outer face, and reach inwards by their own thickness;
//! a joint is as deep as the thinner of its blocks. What the planar analysis takes from the wall file holds here too: which
//! sides touch, friction, loads on the blocks, a beam with mass.

use super::assembly::{Assembly, Body, Contact, ContactKind, Vector};
use super::problem::Problem;
use crate::assembly::{ContactPoint, Other};
use crate::{LimitError, Problem as Planar};

/// Where a wall is pushed to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Face {
    /// To its outer face, −x.
    #[default]
    Outwards,
    /// To its inner face, +x.
    Inwards,
}

/// Of a planar problem: its loads, joints and blocks with thickness, pushed across its plane.
///
/// What pushes in the plane pushes with the same force across it, at half of the thickness. A beam is as thick as the
/// thickest block and lies with its outer face on the wall's. That its turn may be held in the plane plays no part.
///
/// # Errors
/// Blocks that are polygons.
pub fn of_wall(planar: &Planar, towards: Face) -> Result<Problem, LimitError> {
    let wall = &planar.wall;
    if let Some(block) = wall.blocks.iter().find(|b| !b.is_rectangle()) {
        return Err(LimitError::Wrong(format!(
            "block {} is a polygon: out of the plane, blocks are rectangles with level and upright sides",
            block.name
        )));
    }
    let thickest = wall.blocks.iter().map(|b| b.thickness).fold(0.0, f64::max);
    let thickness = |body: usize| wall.blocks.get(body).map_or(thickest, |b| b.thickness);
    let bodies = planar.assembly.bodies.iter().enumerate().map(|(i, body)| {
        let edge = |k: usize, far: bool| {
            let values = body.corners.iter().map(|c| c[k]);
            if far { values.fold(f64::NEG_INFINITY, f64::max) } else { values.fold(f64::INFINITY, f64::min) }
        };
        let corner = |index: usize| -> Vector {
            let x = if index & 1 == 1 { thickness(i) } else { 0.0 };
            [x, body.centre[0] + edge(0, index >> 1 & 1 == 1), body.centre[1] + edge(1, index >> 2 & 1 == 1)]
        };
        Body {
            name: body.name.clone(),
            centre: [0.5 * thickness(i), body.centre[0], body.centre[1]],
            corners: [0, 1, 2, 3, 4, 5, 6, 7].map(corner),
            weight: -planar.dead[i][1],
        }
    });
    let bodies: Vec<Body> = bodies.collect();
    let ends = planar.assembly.points.chunks_exact(2).zip(planar.friction.chunks_exact(2));
    let contacts: Vec<Contact> = ends
        .filter_map(|(ends, mu)| {
            let other = match ends[0].b {
                Other::Body(b) => Some(b),
                Other::Base => None,
                // A beam without mass is a load alone: there is nothing to lean on.
                Other::Beam => return None,
            };
            let deep = other.map_or(thickness(ends[0].a), |b| thickness(b).min(thickness(ends[0].a)));
            Some(contact(&planar.joints[ends[0].joint], ends, other, deep, mu[0]))
        })
        .collect();
    let sign = if towards == Face::Outwards { -1.0 } else { 1.0 };
    let mut problem = Problem::new(Assembly { bodies, contacts }, [sign, 0.0, 0.0]);
    // What presses and what pushes differ where a load has no mass.
    for (i, live) in planar.live.iter().enumerate() {
        problem.pushed[i] = false;
        problem.loads.push(super::PointLoad {
            body: i,
            at: problem.assembly.bodies[i].centre,
            force: [0.0; 3],
            pushes: live[0].abs(),
        });
    }
    Ok(problem)
}

fn contact(name: &str, ends: &[ContactPoint], b: Option<usize>, deep: f64, friction: f64) -> Contact {
    let normal = ends[0].normal;
    let [p, q] = [ends[0].at, ends[1].at];
    Contact {
        name: name.into(),
        kind: match (b, normal[0] != 0.0) {
            (None, _) => ContactKind::Base,
            (Some(_), true) => ContactKind::Head,
            (Some(_), false) => ContactKind::Bed,
        },
        a: ends[0].a,
        b,
        corners: [[0.0, p[0], p[1]], [deep, p[0], p[1]], [deep, q[0], q[1]], [0.0, q[0], q[1]]],
        normal: [0.0, normal[0], normal[1]],
        friction,
        gives_way: None,
    }
}
