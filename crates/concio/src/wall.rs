//! Blocks and joints of a wall: what geometry alone says. `pattern` makes the blocks, `graph` the joints.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::polygon;

/// Contacts and overlaps shorter than this part of L_ref count as none: they come from rounding.
pub const CONTACT_TOLERANCE: f64 = 1e-6;
/// Relative error allowed when bricks have to make up a width.
pub(crate) const SLACK: f64 = 1e-9;

/// Kinds of joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum JointKind {
    /// Between blocks of adjacent courses.
    Bed,
    /// Between neighbours in a course.
    Head,
    /// Bottom course on the base.
    Base,
    /// Top beam on the top course.
    Top,
    /// Between panels.
    Connection,
}

impl JointKind {
    /// Whether blocks stand side by side at it: head joints and connections of panels, which open and close.
    pub fn is_upright(self) -> bool {
        matches!(self, JointKind::Head | JointKind::Connection)
    }
}

/// A rigid block (brick, stone).
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Unique name, `p1c2b3` (panel, course, place; each from 1) unless given by the user.
    pub name: String,
    /// Panel, from 0.
    pub panel: usize,
    /// Course in its panel, from 0 at the bottom; of a block as high as several, the topmost of them.
    pub course: usize,
    /// Left and right edge [m].
    pub x: [f64; 2],
    /// Bottom and top edge [m].
    pub y: [f64; 2],
    /// What makes it other than a rectangle in one course, if anything does.
    pub shape: Option<Box<Shape>>,
    /// Out-of-plane thickness B [m].
    pub thickness: f64,
    /// γ [N/m³].
    pub specific_weight: f64,
}

/// Shape of a block that is no rectangle, or is higher than a course.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Number of courses that it takes up: 1 but for lintels.
    pub span: usize,
    /// Corners [m], counterclockwise; none of a rectangle whose sides are level and upright.
    pub corners: Vec<[f64; 2]>,
}

impl Shape {
    /// Of a block with these edges and corners; none where there is nothing to say.
    pub fn of(span: usize, corners: Vec<[f64; 2]>, x: [f64; 2], y: [f64; 2]) -> Option<Box<Self>> {
        let corners = if corners == polygon::of_box(x, y) { Vec::new() } else { corners };
        (span != 1 || !corners.is_empty()).then(|| Box::new(Shape { span, corners }))
    }
}

impl Block {
    /// Number of courses that it takes up: 1 but for lintels.
    pub fn span(&self) -> usize {
        self.shape.as_ref().map_or(1, |shape| shape.span)
    }
    /// Corners [m], counterclockwise: of a rectangle the four, from the bottom left.
    pub fn corners(&self) -> Vec<[f64; 2]> {
        let own = self.shape.as_ref().filter(|shape| !shape.corners.is_empty());
        own.map_or_else(|| self.box_corners().to_vec(), |shape| shape.corners.clone())
    }
    /// The lowest course that it takes up, from 0.
    pub fn lowest_course(&self) -> usize {
        (self.course + 1).saturating_sub(self.span())
    }
    /// L_i [m]: from its leftmost to its rightmost corner.
    pub fn length(&self) -> f64 {
        self.x[1] - self.x[0]
    }
    /// H_i [m]: from its lowest to its highest corner.
    pub fn height(&self) -> f64 {
        self.y[1] - self.y[0]
    }
    /// Whether it is a rectangle whose sides are level and upright.
    pub fn is_rectangle(&self) -> bool {
        self.shape.as_ref().is_none_or(|shape| shape.corners.is_empty())
    }
    /// Corners of the rectangle around it [m], counterclockwise from the bottom left.
    pub fn box_corners(&self) -> [[f64; 2]; 4] {
        let ([x0, x1], [y0, y1]) = (self.x, self.y);
        [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
    }
    /// Area [m²].
    pub fn area(&self) -> f64 {
        if self.is_rectangle() { self.length() * self.height() } else { 0.5 * polygon::doubled_area(&self.corners()) }
    }
    /// Centre of gravity at rest [m]: what a block's displacement is told of, and what it turns about.
    pub fn centre(&self) -> [f64; 2] {
        if self.is_rectangle() {
            return [0.5 * (self.x[0] + self.x[1]), 0.5 * (self.y[0] + self.y[1])];
        }
        polygon::centroid(&self.corners())
    }
    /// ∫ r² dA about the centre, in m⁴.
    pub fn polar_moment(&self) -> f64 {
        polygon::polar_moment(&self.corners())
    }
    /// m_i = γ L_i H_i B / g [kg] of a rectangle (theory, section 1).
    pub fn mass(&self) -> f64 {
        self.weight() / crate::G
    }
    /// m_i g [N].
    pub fn weight(&self) -> f64 {
        if self.is_rectangle() {
            return self.specific_weight * self.length() * self.height() * self.thickness;
        }
        self.specific_weight * self.area() * self.thickness
    }
}

/// What all blocks of a panel share.
#[derive(Debug, Clone, PartialEq)]
pub struct PanelInfo {
    /// Name, `p1`, `p2`, … unless given.
    pub name: String,
    /// Number of courses.
    pub courses: usize,
    /// L_ref [m].
    pub reference_length: f64,
    /// H of the reference brick [m].
    pub reference_height: f64,
    /// M_ref [kg].
    pub reference_mass: f64,
    /// Mortar thicknesses t_b, t_h [m].
    pub mortar: [f64; 2],
    /// Thickness of the connection to the panel on the left [m].
    pub connection: f64,
}

/// The blocks of a wall, panel by panel, course by course from the bottom, left to right.
#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    /// The panels from left to right.
    pub panels: Vec<PanelInfo>,
    /// The blocks.
    pub blocks: Vec<Block>,
}

impl Wall {
    /// On how much of each block a load along the top of the wall lies [m]: blocks of the top courses, of polygons what is seen of
    /// them from above; 0 of all others.
    pub fn loaded(&self) -> Vec<f64> {
        let mut lengths = vec![0.0; self.blocks.len()];
        for (panel, info) in self.panels.iter().enumerate() {
            let top = |(_, b): &(usize, &Block)| b.panel == panel && b.course + 1 == info.courses;
            let blocks: Vec<(usize, &Block)> = self.blocks.iter().enumerate().filter(top).collect();
            if blocks.iter().all(|(_, b)| b.is_rectangle()) {
                blocks.iter().for_each(|(i, b)| lengths[*i] = b.length());
                continue;
            }
            let backs: Vec<(usize, Vec<[f64; 2]>)> = blocks.iter().map(|(i, b)| (*i, b.corners())).collect();
            let mut cuts: Vec<f64> = backs.iter().flat_map(|(_, corners)| corners.iter().map(|c| c[0])).collect();
            cuts.sort_by(f64::total_cmp);
            for cut in cuts.windows(2) {
                let middle = 0.5 * (cut[0] + cut[1]);
                let heights = backs.iter().filter_map(|(i, corners)| Some((*i, polygon::top_at(corners, middle)?)));
                if let Some((highest, _)) = heights.max_by(|a, b| a.1.total_cmp(&b.1)) {
                    lengths[highest] += cut[1] - cut[0];
                }
            }
        }
        lengths
    }
}

/// One side of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// A block, by index.
    Block(usize),
    /// The base.
    Base,
    /// The top beam.
    Top,
}

/// A joint between two blocks, or a block and base or beam.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Kind.
    pub kind: JointKind,
    /// Block index: the left block of a head joint or connection, the lower of a bed joint, the block of a support. Of an
    /// inclined joint, the block whose side at the joint looks upwards (bed) or to the right (head).
    pub a: usize,
    /// The other side.
    pub b: End,
    /// Overlap weight w = 2 ℓ/L_ref of bed and support joints; 1 for head joints, ℓ/H where blocks are polygons.
    pub weight: f64,
    /// Overlap ℓ [m]: contact length.
    pub overlap: f64,
    /// Middle line of the contact: x0, y0, x1, y1 [m], from left to right or, of head joints, upwards.
    pub line: [f64; 4],
}

impl Joint {
    /// Course from 1 that it counts to in a wall file: a bed joint to that which lies on it, the joints of the top to one more than there are.
    pub fn course(&self, wall: &Wall) -> usize {
        let below = wall.blocks[self.a].course + 1;
        match (self.kind, self.b) {
            (JointKind::Bed, End::Block(upper)) => wall.blocks[upper].course + 1,
            // Beside a lintel of several courses that of the brick, on either side.
            (JointKind::Head, End::Block(right)) => below.min(wall.blocks[right].course + 1),
            (JointKind::Top, _) => below + 1,
            _ => below,
        }
    }

    /// Area of the contact [m²]: its length times the thickness of the thinner block.
    pub fn area(&self, wall: &Wall) -> f64 {
        let of = |i: usize| wall.blocks[i].thickness;
        let thickness = match self.b {
            End::Block(b) => of(self.a).min(of(b)),
            End::Base | End::Top => of(self.a),
        };
        self.overlap * thickness
    }
}
