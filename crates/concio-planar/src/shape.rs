//! Convex polygons in place, and the contact points between two of them.
//!
//! Two bodies touch across the edge that separates them best; the facing edge of the other is cut to its length, and the
//! two ends of what is left are the contact points (the manifold of polygon collision codes). Between the faces of two
//! bricks these are the ends of their overlap, wherever they have slid to; under a rocking block the two corners.

use serde::{Deserialize, Serialize};

use crate::body::Body;

/// Overlap of two facing edges over the shorter of them below which bricks pass each other: an arris bears nothing.
const ARRIS: f64 = 5e-3;
/// By how much the second body's edge has to separate better than the first's to be preferred, over the length of an edge:
/// between parallel faces the choice must not change from step to step.
const PREFERENCE: f64 = 1e-4;

/// A position: centre [m] and rotation in rad.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Place {
    /// Centre [m].
    pub centre: [f64; 2],
    /// Rotation from the position in which the wall was laid, counterclockwise, in rad.
    pub angle: f64,
}

impl Place {
    /// A vector of the body as it was laid, turned with it.
    pub fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (s, c) = self.angle.sin_cos();
        [c * x - s * y, s * x + c * y]
    }
}

/// A polygon where it is now.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Polygon {
    /// Corners, counterclockwise [m].
    pub corners: Vec<[f64; 2]>,
    /// Unit normals outwards of the edges from each corner to the next.
    pub normals: Vec<[f64; 2]>,
    /// Length of its shortest edge [m].
    pub shortest: f64,
}

impl Polygon {
    /// Of a body that has not moved yet.
    pub fn of(body: &Body) -> Self {
        let n = body.corners.len();
        let mut polygon =
            Polygon { corners: body.corners.clone(), normals: vec![[0.0; 2]; n], shortest: f64::INFINITY };
        for k in 0..n {
            let [p, q] = [body.corners[k], body.corners[(k + 1) % n]];
            let edge = [q[0] - p[0], q[1] - p[1]];
            let length = edge[0].hypot(edge[1]);
            polygon.normals[k] = [edge[1] / length, -edge[0] / length];
            polygon.shortest = polygon.shortest.min(length);
        }
        polygon
    }

    /// Moves to `place`; `rest` is the polygon about its centre, unturned.
    pub fn put(&mut self, rest: &Polygon, place: &Place) {
        let (s, c) = place.angle.sin_cos();
        let turned = |p: &[f64; 2]| [c * p[0] - s * p[1], s * p[0] + c * p[1]];
        for k in 0..rest.corners.len() {
            let [x, y] = turned(&rest.corners[k]);
            self.corners[k] = [place.centre[0] + x, place.centre[1] + y];
            self.normals[k] = turned(&rest.normals[k]);
        }
    }

    fn edge(&self, k: usize) -> [[f64; 2]; 2] {
        [self.corners[k], self.corners[(k + 1) % self.corners.len()]]
    }

    /// The edge that faces `direction` most.
    fn facing(&self, direction: [f64; 2]) -> usize {
        let along = |k: &usize| dot(self.normals[*k], direction);
        (0..self.normals.len()).max_by(|j, k| along(j).total_cmp(&along(k))).unwrap_or(0)
    }
}

/// A contact point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Touch {
    /// Where [m].
    pub at: [f64; 2],
    /// Unit normal, from the first body to the second.
    pub normal: [f64; 2],
    /// Distance of the bodies there [m], negative where they overlap.
    pub gap: f64,
}

/// The contact points of `a` and `b` in the order of the tangent, the normal turned counterclockwise; none where both are
/// farther than `margin` [m].
pub fn touches(a: &Polygon, b: &Polygon, margin: f64) -> Option<[Touch; 2]> {
    let (of_a, edge_a) = separation(a, b);
    let (of_b, edge_b) = separation(b, a);
    if of_a.max(of_b) > margin {
        return None;
    }
    let swapped = of_b > of_a + PREFERENCE * a.shortest.min(b.shortest);
    let (reference, edge, other) = if swapped { (b, edge_b, a) } else { (a, edge_a, b) };
    let out = reference.normals[edge];
    let found = clipped(reference.edge(edge), out, other.edge(other.facing([-out[0], -out[1]])));
    let normal = if swapped { [-out[0], -out[1]] } else { out };
    let touch = |(at, gap): ([f64; 2], f64)| {
        // Half way between the two surfaces.
        let at = [at[0] - 0.5 * gap * out[0], at[1] - 0.5 * gap * out[1]];
        Touch { at, normal, gap }
    };
    let [first, last] = found?;
    // Clipping goes along the reference's own tangent.
    let both = if swapped { [touch(last), touch(first)] } else { [touch(first), touch(last)] };
    (both[0].gap.min(both[1].gap) <= margin).then_some(both)
}

/// The contact points of a polygon with the half-plane y ≤ `level` [m], the first body; none where both are farther than
/// `margin` [m].
pub fn touches_base(a: &Polygon, level: f64, margin: f64) -> Option<[Touch; 2]> {
    let edge = a.edge(a.facing([0.0, -1.0]));
    // Along the tangent of the upward normal, which points to the left.
    let [p, q] = if edge[0][0] > edge[1][0] { edge } else { [edge[1], edge[0]] };
    let touch = |p: [f64; 2]| {
        let gap = p[1] - level;
        Touch { at: [p[0], p[1] - 0.5 * gap], normal: [0.0, 1.0], gap }
    };
    (p[1].min(q[1]) - level <= margin).then_some([touch(p), touch(q)])
}

/// The edge of `a` beyond which `b` lies farthest, and how far.
fn separation(a: &Polygon, b: &Polygon) -> (f64, usize) {
    let mut best = (f64::NEG_INFINITY, 0);
    for (k, (normal, corner)) in a.normals.iter().zip(&a.corners).enumerate() {
        let distance = |p: &[f64; 2]| dot(*normal, *p);
        let nearest = b.corners.iter().map(distance).fold(f64::INFINITY, f64::min) - distance(corner);
        if nearest > best.0 {
            best = (nearest, k);
        }
    }
    best
}

/// The part of `edge` beside the reference edge, both ends with their distance from it, ordered along the reference's
/// tangent; none where an arris is all that is left.
fn clipped(reference: [[f64; 2]; 2], normal: [f64; 2], edge: [[f64; 2]; 2]) -> Option<[([f64; 2], f64); 2]> {
    let tangent = [-normal[1], normal[0]];
    let [low, high] = [reference[0], reference[1]].map(|p| dot(tangent, p));
    // The other edge runs against the reference's.
    let [mut p, mut q] = [edge[1], edge[0]];
    let [s, t] = [p, q].map(|p| dot(tangent, p));
    let bound = (high - low).min(t - s);
    let [from, to] = [s.max(low), t.min(high)];
    if !(to - from > ARRIS * bound) {
        return None;
    }
    let on = |x: f64| {
        let share = (x - s) / (t - s);
        [p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])]
    };
    (p, q) = (on(from), on(to));
    let gap = |x: [f64; 2]| dot(normal, [x[0] - reference[0][0], x[1] - reference[0][1]]);
    Some([(p, gap(p)), (q, gap(q))])
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}
