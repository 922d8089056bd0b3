//! Blocks and joints of a wall: what geometry alone says. `pattern` makes the blocks, `graph` the joints.

use crate::case::JointKind;

/// A rigid block (brick, stone).
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Unique name, `p1c2b3` (panel, course, place; each from 1) unless given by the user.
    pub name: String,
    /// Panel, from 0.
    pub panel: usize,
    /// Course in its panel, from 0 at the bottom.
    pub course: usize,
    /// Left and right edge [m].
    pub x: [f64; 2],
    /// Bottom and top edge [m].
    pub y: [f64; 2],
    /// Out-of-plane thickness B [m].
    pub thickness: f64,
    /// γ [N/m³].
    pub specific_weight: f64,
}

impl Block {
    /// L_i [m].
    pub fn length(&self) -> f64 {
        self.x[1] - self.x[0]
    }
    /// H_i [m].
    pub fn height(&self) -> f64 {
        self.y[1] - self.y[0]
    }
    /// m_i = γ L_i H_i B / g [kg] (theory, section 1).
    pub fn mass(&self) -> f64 {
        self.weight() / crate::G
    }
    /// m_i g [N].
    pub fn weight(&self) -> f64 {
        self.specific_weight * self.length() * self.height() * self.thickness
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
    /// Block index: the left block of a head joint or connection, the lower of a bed joint, the block of a support.
    pub a: usize,
    /// The other side.
    pub b: End,
    /// Overlap weight w = 2 ℓ/L_ref of bed and support joints; 1 for head joints.
    pub weight: f64,
    /// Overlap ℓ [m]: contact length.
    pub overlap: f64,
    /// Middle line of the contact: x0, y0, x1, y1 [m].
    pub line: [f64; 4],
}
