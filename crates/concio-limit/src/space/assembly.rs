//! Bodies in space and the rectangles in which they touch.
//!
//! Between bodies that touch in a convex polygon, any pressure has the resultant of four pushes in a rectangle's corners.
//! What it does not have is their friction: in the corners a joint resists a twist with all of its pressure at the longest
//! arm, which pressure spread evenly does not reach. [`Assembly::drawn_in`] gives the low side.

use std::fmt;

/// Distances below this part of the largest coordinate come from rounding.
const TOUCHING: f64 = 1e-9;

/// Part of their way from the middle at which the corners of a rectangle twist like even pressure: the mean distance of its
/// points from its middle over half of its diagonal, 0.541 for a square, down to 0.5 for a long one.
///
/// With sides c, t and d² = c² + t², (S9) r̄ = d/6 + c²/(12 t) ln((t + d)/c) + t²/(12 c) ln((c + d)/t).
pub fn even_twist([c, t]: [f64; 2]) -> f64 {
    if !(c > 0.0 && t > 0.0) {
        return 0.5;
    }
    let d = c.hypot(t);
    let mean = d / 6.0 + c * c / (12.0 * t) * ((t + d) / c).ln() + t * t / (12.0 * c) * ((c + d) / t).ln();
    mean / (0.5 * d)
}

/// A point or a vector in space: x, y, z.
pub type Vector = [f64; 3];

/// A box with sides along the axes: what textures are built of.
#[derive(Debug, Clone, PartialEq)]
pub struct Cuboid {
    /// Unique name.
    pub name: String,
    /// Smallest and largest x, y and z [m].
    pub edges: [[f64; 2]; 3],
    /// γ [N/m³].
    pub specific_weight: f64,
}

impl Cuboid {
    /// Volume [m³].
    pub fn volume(&self) -> f64 {
        self.edges.iter().map(|e| e[1] - e[0]).product()
    }
}

/// A rigid body.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Unique name.
    pub name: String,
    /// Centre of gravity [m].
    pub centre: Vector,
    /// Corners [m]. Bits 0, 1 and 2 of a corner's index say whether it is at the far end of the first, second and third edge.
    pub corners: [Vector; 8],
    /// Weight [N], from 0.
    pub weight: f64,
}

/// How a contact lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactKind {
    /// A block lies on another one.
    Bed,
    /// Blocks stand side by side: head joints, collar joints between leaves, upright joints of corners.
    Head,
    /// A block lies on the base.
    Base,
}

/// A plane quadrangle in which two bodies touch, or a body and what does not move.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// Name, such as `a|b`.
    pub name: String,
    /// How it lies.
    pub kind: ContactKind,
    /// The body on the side that the normal leaves.
    pub a: usize,
    /// The body that it enters; none: the base.
    pub b: Option<usize>,
    /// Corners in turn [m].
    pub corners: [Vector; 4],
    /// Unit normal from `a` to `b`.
    pub normal: Vector,
    /// μ, from 0. A joint that never slides has 1, not a large number: that would spoil the accuracy of the program.
    pub friction: f64,
    /// Normal force at which its sides give way as one [N], such as an abutment's thrust; none: they never do.
    pub gives_way: Option<f64>,
}

impl Contact {
    /// Middle of the corners [m].
    pub fn middle(&self) -> Vector {
        [0, 1, 2].map(|k| 0.25 * self.corners.iter().map(|c| c[k]).sum::<f64>())
    }

    /// Lengths of a rectangle's sides [m]: from corner 0 to 1, and to 3.
    pub fn sides(&self) -> [f64; 2] {
        [1, 3].map(|k| length(minus(self.corners[k], self.corners[0])))
    }

    /// The corners with each side cut by a length at both ends [m], no further than to the middle.
    pub fn set_back(&self, by: [f64; 2]) -> [Vector; 4] {
        let (sides, middle) = (self.sides(), self.middle());
        let half = [1, 3].map(|k| scaled(minus(self.corners[k], self.corners[0]), 0.5));
        let part = [0, 1].map(|k| if sides[k] > 0.0 { (1.0 - 2.0 * by[k] / sides[k]).max(0.0) } else { 0.0 });
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|sign| plus(middle, plus(scaled(half[0], sign[0] * part[0]), scaled(half[1], sign[1] * part[1]))))
    }
}

/// Bodies that touch.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Assembly {
    /// The bodies.
    pub bodies: Vec<Body>,
    /// Where they touch.
    pub contacts: Vec<Contact>,
}

/// Why boxes make no wall.
#[derive(Debug, Clone, PartialEq)]
pub enum TextureError {
    /// A box without volume, or with an edge that is no number: its name.
    NoVolume(String),
    /// Two boxes reach into each other: their names.
    Overlap(String, String),
    /// A number of a texture is out of its range: what, and what is allowed.
    Range(&'static str, &'static str),
}

impl fmt::Display for TextureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TextureError::NoVolume(name) => write!(f, "block {name} has no volume"),
            TextureError::Overlap(a, b) => write!(f, "blocks {a} and {b} reach into each other"),
            TextureError::Range(what, allowed) => write!(f, "{what} is out of range; allowed: {allowed}"),
        }
    }
}

impl std::error::Error for TextureError {}

impl Assembly {
    /// Of boxes, the lowest of which stand on a wide base, with one μ for all contacts.
    ///
    /// Contacts are listed by the index of the lower, then of the upper body.
    ///
    /// # Errors
    /// Boxes without volume, and boxes that reach into each other.
    pub fn of_boxes(boxes: &[Cuboid], friction: f64) -> Result<Self, TextureError> {
        let sound = |b: &Cuboid| b.edges.iter().all(|e| e[1] > e[0] && e[0].is_finite() && e[1].is_finite());
        if let Some(flat) = boxes.iter().find(|b| !sound(b)) {
            return Err(TextureError::NoVolume(flat.name.clone()));
        }
        let largest = boxes.iter().flat_map(|b| b.edges).flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
        let slack = TOUCHING * largest;
        let ground = boxes.iter().map(|b| b.edges[2][0]).fold(f64::INFINITY, f64::min);
        let mut contacts = Vec::new();
        for (i, this) in boxes.iter().enumerate() {
            if this.edges[2][0] - ground <= slack {
                let face = [this.edges[0], this.edges[1], [this.edges[2][0]; 2]];
                contacts.push(Contact {
                    name: format!("base|{}", this.name),
                    kind: ContactKind::Base,
                    a: i,
                    b: None,
                    corners: rectangle(face, 2),
                    normal: [0.0, 0.0, -1.0],
                    friction,
                    gives_way: None,
                });
            }
            for (j, that) in boxes.iter().enumerate().skip(i + 1) {
                contacts.extend(touch([i, j], [this, that], slack, friction)?);
            }
        }
        Ok(Assembly { bodies: boxes.iter().map(body).collect(), contacts })
    }

    /// With contacts that stand upright without friction.
    pub fn frictionless_heads(mut self) -> Self {
        self.contacts.iter_mut().filter(|c| c.kind == ContactKind::Head).for_each(|c| c.friction = 0.0);
        self
    }

    /// With the corners of bed joints and base drawn in to their [`even_twist`].
    ///
    /// They twist no stronger than even pressure does, and rock about lines inside the blocks: λ comes out too low.
    pub fn drawn_in(mut self) -> Self {
        for contact in self.contacts.iter_mut().filter(|c| c.kind != ContactKind::Head) {
            let sides = contact.sides();
            contact.corners = contact.set_back(sides.map(|side| 0.5 * side * (1.0 - even_twist(sides))));
        }
        self
    }

    /// Turned about the origin by a rotation matrix, rows first.
    pub fn turned(&self, rotation: [Vector; 3]) -> Self {
        let of = |p: Vector| rotation.map(|row| dot(row, p));
        let bodies = self.bodies.iter().map(|b| Body { centre: of(b.centre), corners: b.corners.map(of), ..b.clone() });
        let contacts =
            self.contacts.iter().map(|c| Contact { corners: c.corners.map(of), normal: of(c.normal), ..c.clone() });
        Assembly { bodies: bodies.collect(), contacts: contacts.collect() }
    }
}

/// A homogeneous box.
pub(super) fn body(of: &Cuboid) -> Body {
    let corner = |index: usize| [0, 1, 2].map(|k| of.edges[k][index >> k & 1]);
    Body {
        name: of.name.clone(),
        centre: of.edges.map(|e| 0.5 * (e[0] + e[1])),
        corners: [0, 1, 2, 3, 4, 5, 6, 7].map(corner),
        weight: of.specific_weight * of.volume(),
    }
}

/// Where two boxes touch.
pub(super) fn touch(
    index: [usize; 2],
    [this, that]: [&Cuboid; 2],
    slack: f64,
    friction: f64,
) -> Result<Option<Contact>, TextureError> {
    let shared = [0, 1, 2].map(|k| {
        let (a, b) = (this.edges[k], that.edges[k]);
        [a[0].max(b[0]), a[1].min(b[1])]
    });
    let deep = shared.map(|s| s[1] - s[0]);
    if deep.iter().all(|d| *d > slack) {
        return Err(TextureError::Overlap(this.name.clone(), that.name.clone()));
    }
    let meets = |k: usize| deep[k].abs() <= slack && (0..3).all(|other| other == k || deep[other] > slack);
    Ok([0, 1, 2].into_iter().find(|k| meets(*k)).map(|k| {
        // From the one with the smaller coordinate to the other.
        let first = this.edges[k][1] <= that.edges[k][0] + slack;
        let (a, b) = if first { (0, 1) } else { (1, 0) };
        let mut normal = [0.0; 3];
        normal[k] = 1.0;
        let names = [&this.name, &that.name];
        Contact {
            name: format!("{}|{}", names[a], names[b]),
            kind: if k == 2 { ContactKind::Bed } else { ContactKind::Head },
            a: index[a],
            b: Some(index[b]),
            corners: rectangle(shared, k),
            normal,
            friction,
            gives_way: None,
        }
    }))
}

/// Corners of the rectangle across an axis.
fn rectangle(edges: [[f64; 2]; 3], across: usize) -> [Vector; 4] {
    let (u, v) = ((across + 1) % 3, (across + 2) % 3);
    [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| {
        let mut corner = [0.0; 3];
        (corner[u], corner[v], corner[across]) =
            (edges[u][i], edges[v][j], 0.5 * (edges[across][0] + edges[across][1]));
        corner
    })
}

pub(crate) fn plus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] + b[k])
}

pub(crate) fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub(crate) fn scaled(a: Vector, by: f64) -> Vector {
    a.map(|v| v * by)
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}
