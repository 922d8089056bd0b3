//! The parts of a wall that its mechanisms share: masonry, floors, ties.

/// Masonry seen from the front: rectangles with their weight, of one thickness.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Masonry {
    /// t [m], above 0.
    pub thickness: f64,
    /// Rectangles; those of openings weigh less than nothing.
    pub pieces: Vec<Piece>,
}

/// A rectangle of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Left and right end along the wall [m].
    pub y: [f64; 2],
    /// Bottom and top [m].
    pub z: [f64; 2],
    /// Weight per area of the elevation [N/m²]: γ t; below 0 for an opening.
    pub weight: f64,
}

/// Weight of a part with its centroid.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Part {
    /// Weight [N].
    pub weight: f64,
    /// Centroid [m]: along the wall and up.
    pub centroid: [f64; 2],
}

impl Masonry {
    /// A wall of one thickness t, height h, length L [m] and specific weight γ [N/m³], with openings `[y0, z0, width, height]` [m].
    pub fn rectangle(thickness: f64, height: f64, length: f64, specific_weight: f64, openings: &[[f64; 4]]) -> Masonry {
        let weight = specific_weight * thickness;
        let whole = Piece { y: [0.0, length], z: [0.0, height], weight };
        let opening = |[y, z, b, h]: &[f64; 4]| Piece { y: [*y, y + b], z: [*z, z + h], weight: -weight };
        Masonry { thickness, pieces: std::iter::once(whole).chain(openings.iter().map(opening)).collect() }
    }

    /// What lies between two levels [m].
    pub fn between(&self, from: f64, to: f64) -> Part {
        self.within(&[[f64::MIN, from], [f64::MAX, from], [f64::MAX, to], [f64::MIN, to]])
    }

    /// What lies above a level [m].
    pub fn above(&self, level: f64) -> Part {
        self.between(level, f64::MAX)
    }

    /// What lies inside of a convex polygon [m], its corners anticlockwise.
    pub fn within(&self, polygon: &[[f64; 2]]) -> Part {
        let [mut weight, mut y, mut z] = [0.0; 3];
        for piece in &self.pieces {
            // Level bands are by far the most: no clipping, and no infinite corners in it.
            let [area, my, mz] = match band(polygon) {
                Some([from, to]) => rectangle(piece.y, [piece.z[0].max(from), piece.z[1].min(to)]),
                None => moments(&clipped(piece, polygon)),
            };
            weight += piece.weight * area;
            y += piece.weight * my;
            z += piece.weight * mz;
        }
        if weight == 0.0 {
            return Part::default();
        }
        Part { weight, centroid: [y / weight, z / weight] }
    }

    /// Level of the top [m]; 0 without pieces.
    pub fn top(&self) -> f64 {
        self.pieces.iter().map(|p| p.z[1]).fold(0.0, f64::max)
    }

    /// Length of masonry on a level [m]: openings that begin there, end there or go through it are left out.
    pub fn bearing(&self, level: f64) -> f64 {
        let above = |p: &Piece| p.z[0] <= level && level < p.z[1];
        let below = |p: &Piece| p.z[0] < level && level <= p.z[1];
        let mut ends: Vec<f64> = self.pieces.iter().filter(|p| above(p) || below(p)).flat_map(|p| p.y).collect();
        ends.sort_by(f64::total_cmp);
        // The ground bears from end to end.
        let rests = self.pieces.iter().any(below);
        let covers = |y: f64, touches: &dyn Fn(&Piece) -> bool| {
            let there = self.pieces.iter().filter(|p| touches(p) && p.y[0] < y && y < p.y[1]);
            there.map(|p| p.weight.signum()).sum::<f64>() > 0.0
        };
        let borne = |w: &[f64]| {
            let middle = 0.5 * (w[0] + w[1]);
            let bears = covers(middle, &above) && (!rests || covers(middle, &below));
            if bears { w[1] - w[0] } else { 0.0 }
        };
        ends.windows(2).map(borne).sum()
    }
}

/// The levels of a polygon that is a band without ends.
fn band(polygon: &[[f64; 2]]) -> Option<[f64; 2]> {
    (polygon.len() == 4 && polygon[0][0] == f64::MIN).then(|| [polygon[0][1], polygon[2][1]])
}

/// Area and first moments of a rectangle; nothing where it is turned inside out.
fn rectangle(y: [f64; 2], z: [f64; 2]) -> [f64; 3] {
    let area = (y[1] - y[0]).max(0.0) * (z[1] - z[0]).max(0.0);
    [area, 0.5 * area * (y[0] + y[1]), 0.5 * area * (z[0] + z[1])]
}

/// The part of a piece inside of a convex polygon (Sutherland and Hodgman).
fn clipped(piece: &Piece, polygon: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let ([a, b], [c, d]) = (piece.y, piece.z);
    let mut corners = vec![[a, c], [b, c], [b, d], [a, d]];
    for i in 0..polygon.len() {
        let (from, to) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let side = |p: [f64; 2]| (to[0] - from[0]) * (p[1] - from[1]) - (to[1] - from[1]) * (p[0] - from[0]);
        let mut left = Vec::with_capacity(corners.len() + 1);
        for k in 0..corners.len() {
            let (p, q) = (corners[k], corners[(k + 1) % corners.len()]);
            let (at_p, at_q) = (side(p), side(q));
            if at_p >= 0.0 {
                left.push(p);
            }
            if (at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0) {
                let part = at_p / (at_p - at_q);
                left.push([p[0] + part * (q[0] - p[0]), p[1] + part * (q[1] - p[1])]);
            }
        }
        corners = left;
    }
    corners
}

/// Area and first moments of a polygon, its corners anticlockwise.
pub fn moments(corners: &[[f64; 2]]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for i in 0..corners.len() {
        let ([a, b], [c, d]) = (corners[i], corners[(i + 1) % corners.len()]);
        let cross = a * d - c * b;
        sums[0] += 0.5 * cross;
        sums[1] += cross * (a + c) / 6.0;
        sums[2] += cross * (b + d) / 6.0;
    }
    sums
}

/// A floor or a roof on a wall.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Floor {
    /// z [m]: level above the base.
    pub level: f64,
    /// P [N]: load on the wall, from 0.
    pub load: f64,
    /// x_P [m]: distance of its resultant from the outer face.
    pub depth: f64,
    /// Q [N]: weight of mass that pushes the wall but rests elsewhere, from 0.
    pub pushing: f64,
    /// H [N]: horizontal thrust, positive outwards.
    pub thrust: f64,
    /// μ_f of the seat, from 0.
    pub friction: f64,
    /// Length of the seat [m], above 0: friction is gone when the wall has moved so far. None: unknown.
    pub seat: Option<f64>,
    /// Force up to which a connection holds the wall back [N], from 0.
    pub connection: f64,
}

/// A tie that holds the wall back.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tie {
    /// z [m]: level above the base.
    pub level: f64,
    /// Position along the wall [m].
    pub position: f64,
    /// Force at which it or its anchorage yields [N], above 0.
    pub force: f64,
    /// Stiffness [N/m], above 0; none: rigid up to its force.
    pub stiffness: Option<f64>,
    /// Displacement at which it begins to bear [m], from 0.
    pub slack: f64,
    /// Displacement at which it breaks [m], above 0; none: it does not.
    pub breaks: Option<f64>,
}

impl Tie {
    /// What it comes to [N] where its end moves by `reach` [m] before the mechanism would fall without it: soft, slack and brittle ties bear less than
    /// their force.
    pub fn comes_to(&self, reach: f64) -> f64 {
        let Some(stiffness) = self.stiffness.or((self.slack > 0.0 || self.breaks.is_some()).then_some(f64::INFINITY))
        else {
            return self.force;
        };
        let most = self.breaks.map_or(reach, |breaks| breaks.min(reach));
        if most > self.slack { (stiffness * (most - self.slack)).min(self.force) } else { 0.0 }
    }
}
