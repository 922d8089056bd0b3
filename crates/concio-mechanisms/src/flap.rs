//! Flaps with oblique hinges: a vertical crack parts two of them, and each turns about a line in the outer face.
//!
//! (OP8) α0 = [ W (t/2) sin ϑ + Σ P_i c_i sin ϑ + H t cos ϑ ] / [ W e_G + Σ (P_i + Q_i) e_i ]
//!
//! ϑ is the angle of the hinge from the vertical, e a distance from it in the plane of the wall, c a depth behind the outer face, H the
//! thrust on the crack, where the inner edges of both flaps press on each other. Derived from (OP1). ϑ = 90° is overturning, ϑ = 0 (OP7).
//! Without H the abutments must give way by t cos ϑ per unit turn.

use crate::body::{Body, Hold, HoldLaw, Press, Weight};
use crate::facade::{Floor, Masonry, Tie, moments};

/// A flap of a wall.
#[derive(Debug, Clone, PartialEq)]
pub struct Flap {
    /// Outline in the elevation [m], convex, its corners anticlockwise.
    pub outline: Vec<[f64; 2]>,
    /// Two points of its hinge [m], the upper one second; the flap lies above the line.
    pub hinge: [[f64; 2]; 2],
    /// Distance of the middle of its crack from the hinge is taken of this line [m]: foot and head of the crack.
    pub crack: [[f64; 2]; 2],
    /// H [N], from 0.
    pub thrust: f64,
}

/// A load at a point of a flap.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PointLoad {
    /// Where it acts in the elevation [m].
    pub at: [f64; 2],
    /// P [N], from 0.
    pub load: f64,
    /// c [m]: depth behind the outer face.
    pub depth: f64,
    /// Q [N], from 0.
    pub pushing: f64,
}

impl Flap {
    /// ϑ [rad], from 0 to π/2.
    pub fn angle(&self) -> f64 {
        let [from, to] = self.hinge;
        (to[0] - from[0]).abs().atan2((to[1] - from[1]).abs())
    }

    /// e [m]: distance of a point from the hinge, positive on the side of the flap.
    pub fn distance(&self, [y, z]: [f64; 2]) -> f64 {
        let [from, to] = self.hinge;
        let along = [to[0] - from[0], to[1] - from[1]];
        let side = along[0] * (z - from[1]) - along[1] * (y - from[0]);
        // Upwards of the hinge is the side of the flap, whichever way the line runs.
        side * if along[0] < 0.0 { -1.0 } else { 1.0 } / along[0].hypot(along[1])
    }

    /// Area [m²] and centroid of the outline.
    pub fn area(&self) -> (f64, [f64; 2]) {
        let [area, y, z] = moments(&self.outline);
        (area, [y / area, z / area])
    }

    /// The body of a flap of masonry with point loads.
    pub fn body(&self, masonry: &Masonry, loads: &[PointLoad]) -> Body {
        let own = masonry.within(&self.outline);
        let mut body = Body { hinge_angle: self.angle(), ..Body::default() };
        let height = self.distance(own.centroid);
        body.weights.push(Weight { carried: own.weight, pushing: 0.0, depth: 0.5 * masonry.thickness, height });
        body.weights.extend(loads.iter().map(|p| Weight {
            carried: p.load,
            pushing: p.pushing,
            depth: p.depth,
            height: self.distance(p.at),
        }));
        if self.thrust > 0.0 {
            let [foot, head] = self.crack;
            let middle = [0.5 * (foot[0] + head[0]), 0.5 * (foot[1] + head[1])];
            let (force, depth, height) = (self.thrust, masonry.thickness, self.distance(middle));
            body.presses.push(Press { force, depth, height });
        }
        body
    }

    /// The same with the parts of floors, spread over `extent` along the wall [m], and the ties that lie on it.
    pub fn laden(&self, masonry: &Masonry, floors: &[Floor], ties: &[Tie], extent: [f64; 2]) -> Body {
        let length = extent[1] - extent[0];
        let mut body = self.body(masonry, &[]);
        for floor in floors {
            let Some([from, to]) = self.width(floor.level) else { continue };
            let (from, to) = (from.max(extent[0]), to.min(extent[1]));
            let part = (to - from).max(0.0) / length;
            let height = self.distance([0.5 * (from + to), floor.level]);
            if part == 0.0 || height <= 0.0 {
                continue;
            }
            let depth = floor.depth;
            body.weights.push(Weight { carried: part * floor.load, pushing: part * floor.pushing, depth, height });
            if floor.thrust != 0.0 {
                body.thrusts.push(crate::body::Thrust { force: part * floor.thrust, depth, height });
            }
            let friction = part * floor.friction * floor.load;
            if friction > 0.0 {
                body.holds.push(Hold { force: friction, depth, height, law: HoldLaw::Friction { until: floor.seat } });
            }
            if floor.connection > 0.0 {
                let law = HoldLaw::Tie { stiffness: None, slack: 0.0, breaks: None };
                body.holds.push(Hold { force: part * floor.connection, depth, height, law });
            }
        }
        for tie in ties {
            let at = [tie.position, tie.level];
            let inside = self.width(tie.level).is_some_and(|[from, to]| (from..=to).contains(&tie.position));
            if inside && self.distance(at) > 0.0 {
                let law = HoldLaw::Tie { stiffness: tie.stiffness, slack: tie.slack, breaks: tie.breaks };
                let force = tie.comes_to(self.distance(at) * body.falls_at().sin());
                body.holds.push(Hold { force, depth: 0.0, height: self.distance(at), law });
            }
        }
        body
    }

    /// Where a level passes through the outline [m].
    fn width(&self, level: f64) -> Option<[f64; 2]> {
        let n = self.outline.len();
        let crossing = |i: usize| {
            let ([a, b], [c, d]) = (self.outline[i], self.outline[(i + 1) % n]);
            if b == d {
                return (b == level).then_some([a.min(c), a.max(c)]);
            }
            let part = (level - b) / (d - b);
            (-1e-9..=1.0 + 1e-9).contains(&part).then_some([a + part * (c - a); 2])
        };
        (0..n).filter_map(crossing).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }
}
