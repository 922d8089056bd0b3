//! Every input of a run as plain structs in SI. Reading, units and validation live in `case/`.
//!
//! The structs mirror the wall file key by key; what the keys mean, their bounds and defaults is said here and
//! goes from here into the JSON Schema. Every number is finite and, unless it is 0, between 1e-18 and 1e18 in
//! magnitude (in SI): products of a few of them can then neither overflow nor vanish. Narrower bounds stand at the keys.

use std::path::{Path, PathBuf};

mod build;
mod change;
pub(crate) mod de;
mod devices;
mod document;
mod extent;
mod forms;
mod node;
pub mod out_of_plane;
pub mod plausible;
mod read;
mod schema;
mod sets;
mod size;
mod templates;
pub mod validate;

pub(crate) use devices::{BETA, GAMMA};
pub use devices::{Device, DeviceLaw};
pub use document::{Document, LARGEST_FILE};
pub use extent::Extent;
pub use node::Syntax;
pub use out_of_plane::{OutOfPlane, Rocking};
pub use read::{CaseFile, canonical_json, example, from_str, read};
pub use templates::{describe, schema, starter, unit};
pub use validate::validate;

pub use crate::wall::JointKind;

pub use concio_shear::system::Scheme;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{
    Acceleration, Angle, EnergyPerArea, Force, ForcePerLength, Frequency, Length, Mass, SpecificWeight, Stiffness,
    Stress, Time, Velocity,
};

/// Samples of a synthetic motion are fewer than this.
pub(crate) const SYNTHETIC_SAMPLES: f64 = 2e5;
/// Samples that a run may keep.
pub(crate) const MOST_SAMPLES: f64 = 1e7;

/// Step unless the wall file says otherwise [s].
pub const PLANAR_STEP: f64 = 1e-3;
/// The same without inertia, where what stands for it is the smaller the longer steps are.
pub const QUASI_STATIC_STEP: f64 = 2e-2;

/// A wall, its joints, its loads and its motion: all that one run needs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Free text shown in reports.
    #[serde(default)]
    pub title: String,
    /// Which unknowns a block has.
    pub model: ModelKind,
    /// A named parameter set of the research report, from which brick, mortar, stiffness and friction are taken where the
    /// file does not give them: `"report"` (section 4.2), `"p1"` … `"p4"` (Table 1).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub set: Option<ParameterSet>,
    /// Panels from left to right, at least one; two and more stand in series in one plane. A wall may have up to
    /// 1,000 panels and 500,000 blocks.
    #[serde(rename = "panel")]
    pub panels: Vec<Panel>,
    /// Tie rods, up to 1,000. Planar walls alone.
    #[serde(default, rename = "tie", skip_serializing_if = "Vec::is_empty")]
    pub ties: Vec<Tie>,
    /// Forces on blocks from outside, up to 1,000. Planar walls alone.
    #[serde(default, rename = "force", skip_serializing_if = "Vec::is_empty")]
    pub forces: Vec<BlockForce>,
    /// Floors, ties, side walls, gable and site for mechanisms out of the plane, which `concio mechanisms` assesses and walls of
    /// `model = "rocking"` go through. Runs and limit analysis in the plane do not read it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub out_of_plane: Option<OutOfPlane>,
    /// Which mechanism out of the plane a wall of `model = "rocking"` goes through, and how.
    #[serde(default, skip_serializing_if = "is_default")]
    pub rocking: Rocking,
    /// Laws of the joints.
    pub joint: Joints,
    /// Loads at the top.
    #[serde(default)]
    pub load: Load,
    /// Motion of base and top; runs need it.
    #[serde(default)]
    pub motion: Motion,
    /// Time integration.
    #[serde(default)]
    pub solver: Solver,
    /// What is kept.
    #[serde(default)]
    pub output: Output,
}

/// The unknowns of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ModelKind {
    /// One horizontal degree of freedom per block (the research report's model).
    Shear,
    /// Horizontal, vertical and rotation: blocks rock, lift off and slide.
    Planar,
    /// The turn of a mechanism out of the plane of the wall: one body or a chain of two that rocks (`out_of_plane`).
    Rocking,
}

impl ModelKind {
    /// As wall files and results spell it.
    pub fn name(self) -> &'static str {
        match self {
            ModelKind::Shear => "shear",
            ModelKind::Planar => "planar",
            ModelKind::Rocking => "rocking",
        }
    }
}

/// A named parameter set. In the file: `set = "p1"`, or `set = { name = "p1", at = 0.25 }`.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterSet {
    /// `report`, `p1`, `p2`, `p3` or `p4`.
    pub name: SetName,
    /// Where in the printed ranges the value is taken: 0 the lower end, 1 the upper; 0 … 1, default 0.5.
    pub at: f64,
}

/// Names of the parameter sets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SetName {
    /// Section 4.2 of the research report.
    Report,
    /// Table 1, column p1.
    P1,
    /// Table 1, column p2.
    P2,
    /// Table 1, column p3.
    P3,
    /// Table 1, column p4.
    P4,
}

/// A stack of courses of blocks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Panel {
    /// Name used in selectors, unique in the wall, up to 200 bytes; default `p1`, `p2`, … from left to right.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// How the blocks are laid.
    pub bond: Bond,
    /// Number of courses, from 1 (`running`, `stack`, and `irregular` with `random`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1))]
    pub courses: Option<usize>,
    /// Number of whole bricks in a course, from 1 (`running`, `stack`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1))]
    pub bricks: Option<usize>,
    /// Ends of a running bond.
    #[serde(default)]
    pub ends: Ends,
    /// What the bottom course of a running bond starts with.
    #[serde(default)]
    pub first: First,
    /// The reference brick: its length is L_ref in the overlap weight, its mass M_ref in the damping.
    pub brick: Brick,
    /// Thickness of the mortar joints; both 0 for a dry wall.
    #[serde(default)]
    pub mortar: Mortar,
    /// Irregular texture by explicit lists: courses from the bottom, each with its height and brick lengths.
    #[serde(default, rename = "course", skip_serializing_if = "Vec::is_empty")]
    pub course_list: Vec<Course>,
    /// Irregular texture drawn from a seeded distribution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub random: Option<RandomTexture>,
    /// Blocks one by one (`bond = "explicit"`).
    #[serde(default, rename = "block", skip_serializing_if = "Vec::is_empty")]
    pub blocks: Vec<ExplicitBlock>,
    /// The arch (`bond = "arch"`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arch: Option<Arch>,
    /// Doors and windows (`running`, `stack`, `irregular`), up to 1,000.
    #[serde(default, rename = "opening", skip_serializing_if = "Vec::is_empty")]
    pub openings: Vec<Opening>,
    /// Thickness of the connection to the panel on the left [m], from 0; default the head mortar of this panel. Not
    /// for the first panel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub connection: Option<Length>,
}

/// A circular arch of equal voussoirs with radial joints without thickness, called `p1c1b1`, … from the left. Its thickness
/// out of plane and its weight are those of the panel's brick. The springers have level beds; those of a segment are
/// pentagons, filled up to below the end of their backs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Arch {
    /// Clear span [m], above 0.
    pub span: Length,
    /// Rise of the intrados over the springing [m], above 0 and up to half the span: a semicircle.
    pub rise: Length,
    /// Thickness of the ring [m], above 0.
    pub thickness: Length,
    /// Number of voussoirs, 3 … 1,000.
    #[schemars(range(min = 3, max = 1000))]
    pub voussoirs: usize,
    /// Height of the springing [m], from 0: there the base bears the springers. Default 0.
    #[serde(default)]
    pub springing: Length,
}

/// A door or a window: blocks inside are left out, those that its sides cut are cut there. A rest no longer than the head
/// mortar is left out too, so that a jamb may be ragged by up to two head joints; `concio check` tells. In courses and bricks
/// (`"4 courses"`, `"2.5 bricks"`; bricks in running and stack bond) an opening takes the place of so many of them, and its
/// jambs are straight where bricks are counted in halves, in stack bond in wholes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Opening {
    /// Left side [m], from 0: from the panel's leftmost edge; or how many bricks stand to its left, from 0.
    pub x: Extent,
    /// Bottom [m], from 0: from the base; or how many whole courses lie below, from 0. It lies on a bed joint; a door has 0.
    pub y: Extent,
    /// Width [m], or bricks that are taken out, above 0; the opening lies within the panel.
    pub width: Extent,
    /// Height [m], or whole courses that are taken out, above 0; the top lies on a bed joint.
    pub height: Extent,
    /// Move edges that are given as lengths to the nearest joints, and tell by how much: heights to bed joints; sides and
    /// bearings to where jambs come out straight, in running and stack bond. Default false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub snap: bool,
    /// One block over the opening; default none: then the blocks over it have to bridge it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lintel: Option<Lintel>,
}

/// A lintel, called `p1o1` after panel and opening.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lintel {
    /// Height [m], or whole courses that it takes the place of, above 0; the lintel's top lies on a bed joint.
    pub height: Extent,
    /// How far it reaches onto the wall on either side [m], or over how many bricks, above 0.
    pub bearing: Extent,
    /// Specific weight [N/m³], above 0; default the brick's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub specific_weight: Option<SpecificWeight>,
}

/// How the blocks of a panel are laid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Bond {
    /// Alternate courses shifted by half a pitch.
    Running,
    /// Head joints in line.
    Stack,
    /// Course heights and brick lengths vary.
    Irregular,
    /// Every block is listed.
    Explicit,
    /// A ring of voussoirs. Planar walls and limit analysis alone.
    Arch,
}

/// Ends of the courses of a running bond.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Ends {
    /// Half bricks of length (L − t_h)/2 close every second course; the head mortar is thinner than the brick is long.
    #[default]
    Flush,
    /// Every second course stands out by half a pitch.
    Toothed,
}

/// Start of the bottom course of a running bond.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum First {
    /// Whole bricks.
    #[default]
    Full,
    /// A half brick (flush) or a shift by half a pitch (toothed).
    Half,
}

/// The reference brick of a panel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Brick {
    /// L [m], above 0.
    pub length: Length,
    /// H [m], above 0.
    pub height: Length,
    /// B [m], above 0: out of plane.
    pub thickness: Length,
    /// γ [N/m³], above 0; or a density with its unit (`"1800 kg/m3"`), which is taken times g = 9.81 m/s².
    pub specific_weight: SpecificWeight,
}

/// Mortar thicknesses.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mortar {
    /// t_b [m], from 0: horizontal joints.
    pub bed: Length,
    /// t_h [m], from 0: vertical joints.
    pub head: Length,
}

/// A course of an explicit irregular texture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Course {
    /// Height [m], above 0.
    pub height: Length,
    /// Brick lengths from left to right [m], at least one, each above 0.
    pub bricks: Vec<Length>,
    /// Shift of the course's left end from the panel's [m], of either sign; default 0.
    #[serde(default)]
    pub offset: Length,
}

impl Course {
    /// Where it begins and ends along its panel [m]; `head` is the thickness of the mortar between its bricks.
    pub fn ends(&self, head: Length) -> [f64; 2] {
        let left = self.offset.si();
        let mortar = head.si() * self.bricks.len().saturating_sub(1) as f64;
        [left, left + self.bricks.iter().map(|length| length.si()).sum::<f64>() + mortar]
    }
}

/// A seeded irregular texture: course heights and brick lengths uniform within bounds, all courses of one width.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RandomTexture {
    /// Seed: the same seed gives the same texture on every machine.
    pub seed: u64,
    /// Width of the panel [m], at least the shortest brick.
    pub width: Length,
    /// Shortest and longest brick [m], above 0, in this order.
    pub length: [Length; 2],
    /// Lowest and highest course [m], above 0, in this order.
    pub height: [Length; 2],
    /// Least distance between the middles of head joints of adjacent courses [m], from 0 to half of the shortest brick
    /// and not above the difference of the two lengths.
    pub stagger: Length,
}

/// A block given by hand.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExplicitBlock {
    /// Name, unique in the wall and without blanks, `|` or commas, up to 200 bytes; default from panel, course and place (`p1c2b3`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// Course, from 1 at the bottom; every course up to the highest has a block. Only courses one apart share joints.
    #[schemars(range(min = 1))]
    pub course: usize,
    /// Left edge [m]; a panel after the first is then moved as a whole to the right of the one before it. Needed unless
    /// `corners` are given, like `y`, `length` and `height`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x: Option<Length>,
    /// Bottom edge [m], from 0: the base is at 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y: Option<Length>,
    /// Length [m], above 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<Length>,
    /// Height [m], above 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<Length>,
    /// Corners [x, y] of a convex block [m] instead of `x`, `y`, `length` and `height`: 3 to 16, in their order round the
    /// block one way or the other, y from 0. Blocks that are no level rectangles are for planar walls.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corners: Vec<[Length; 2]>,
    /// Specific weight of this block [N/m³], above 0; default the brick's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub specific_weight: Option<SpecificWeight>,
}

impl ExplicitBlock {
    /// Its corners [m] as they are given.
    pub fn outline(&self) -> Vec<[f64; 2]> {
        let of = |l: Option<Length>| l.map_or(0.0, Length::si);
        if self.corners.is_empty() {
            let (x, y) = (of(self.x), of(self.y));
            return crate::polygon::of_box([x, x + of(self.length)], [y, y + of(self.height)]);
        }
        self.corners.iter().map(|c| c.map(Length::si)).collect()
    }
    /// Whether it is a rectangle whose sides are level and upright.
    pub fn is_rectangle(&self) -> bool {
        let corners = self.outline();
        let [x, y] = crate::polygon::bounds(&corners);
        let on = |v: f64, ends: [f64; 2]| v == ends[0] || v == ends[1];
        self.corners.is_empty() || (corners.len() == 4 && corners.iter().all(|c| on(c[0], x) && on(c[1], y)))
    }
}

/// A rod between two blocks, or a block and the base, that bears tension alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tie {
    /// What one end is fixed to: the name of a block, or `base`.
    pub from: String,
    /// What the other end is fixed to, another than `from`.
    pub to: String,
    /// Where it is fixed to `from` [m]: x and y from the block's centre of gravity, of the base from the origin of the wall.
    /// Default the centre.
    #[serde(default)]
    pub at: [Length; 2],
    /// Where it is fixed to `to` [m], likewise.
    #[serde(default)]
    pub to_at: [Length; 2],
    /// E A over its length [N/m], above 0.
    pub stiffness: ForcePerLength,
    /// Force at which it yields [N], above 0; default none: it does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_force: Option<Force>,
    /// By how much its ends may part before it bears [m], from 0. Default 0.
    #[serde(default)]
    pub slack: Length,
}

impl Tie {
    /// What an end is fixed to that is fixed to no block.
    pub const BASE: &'static str = "base";
}

/// A force on a block at its centre of gravity, from the start of the motion on: the wall has come to rest without it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlockForce {
    /// Name of the block.
    pub block: String,
    /// To the right [N]: one value, or one after the other, each for `every`, the last to the end. Default none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub x: Vec<Force>,
    /// Upwards [N], likewise. Default none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub y: Vec<Force>,
    /// How long each value acts [s], above 0; needed where there is more than one. A step has the value of its start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub every: Option<Time>,
}

/// Laws of the joints of the wall.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joints {
    /// ζ of equation (4), 0 … 2, on every interface; 0 is no damping. Default 0.05.
    #[serde(default = "default_damping_ratio")]
    #[schemars(range(min = 0.0, max = 2.0))]
    pub damping_ratio: f64,
    /// Bed joints, equation (2).
    pub bed: Spring,
    /// Head joints, equation (3).
    pub head: Spring,
    /// Bottom course on the base; default as `bed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<Spring>,
    /// Top beam on the top course; default as `bed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub top: Option<Spring>,
    /// Between panels in series; default as `head`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub connection: Option<Spring>,
    /// Friction, equations (5) and (6).
    #[serde(default)]
    pub friction: Friction,
    /// Mortar that holds until it cracks, equations (B1) to (B4); default none: dry joints.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bond: Option<JointBond>,
    /// Joints with laws of their own, applied in the order of the file: later ones win. Up to 100,000.
    #[serde(default, rename = "change", skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<JointChange>,
}

fn default_damping_ratio() -> f64 {
    0.05
}

/// Elastic law of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spring {
    /// The law.
    pub law: SpringLaw,
    /// K_H or K_V [N/m], from 0: of a half-brick contact for bed joints, of the whole joint for head joints; or with a
    /// unit such as N/mm3 per area of the joint. `elastic` and `no-tension` need it. In planar walls it is the
    /// tangential stiffness of bed, base and top joints, the normal one of head joints and connections.
    #[serde(default)]
    pub stiffness: Stiffness,
    /// κ of equation (3), above 0: how much stiffer than `stiffness` a closed no-tension joint is. Default 1000.
    #[serde(default = "default_rigidity")]
    #[schemars(range(min = 0.0))]
    pub rigidity: f64,
    /// Factor on the elastic force alone, from 0: 0 takes the stiffness away and leaves the damping (case 5).
    /// Default 1.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0))]
    pub stiffness_factor: f64,
    /// e of equation (R4), 0 … 1: what a rigid joint gives back of the closing velocity of an impact. For law `rigid`
    /// alone; default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: Option<f64>,
    /// η of docs/planar.md, 0 … 1: what is left at most of the velocity with which a rigid joint turns as it rocks from one of its ends
    /// to the other. For law `rigid` of planar walls alone; default what the impact itself leaves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub rocking_restitution: Option<f64>,
    /// ζ of this kind of joint, 0 … 2; default the common one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 2.0))]
    pub damping_ratio: Option<f64>,
    /// k_n/k_s, above 0: how much stiffer the joint is when pressed than when sheared. Planar walls alone; default 2.4,
    /// a layer of mortar with a Poisson's ratio of 0.2.
    #[serde(default = "isotropic", skip_serializing_if = "is_isotropic")]
    #[schemars(range(min = 0.0))]
    pub normal_to_shear: f64,
    /// f_c in Pa, above 0: largest pressure that the joint bears before it crushes. Planar walls alone; default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compressive_strength: Option<Stress>,
}

fn default_rigidity() -> f64 {
    1000.0
}
/// 2 (1 + ν) of an isotropic layer that is thin beside its length, ν = 0.2.
const ISOTROPIC: f64 = 2.4;

fn isotropic() -> f64 {
    ISOTROPIC
}
pub(crate) fn is_isotropic(ratio: &f64) -> bool {
    *ratio == ISOTROPIC
}
fn one() -> f64 {
    1.0
}
fn yes() -> bool {
    true
}

/// Elastic laws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpringLaw {
    /// Linear in both directions, equation (2).
    Elastic,
    /// Compression only, κ times the stiffness, equation (3). For head joints and connections, in planar walls for every
    /// joint.
    NoTension,
    /// Compression only and rigid: sides part freely and never overlap, equations (R1) to (R4). For head joints and
    /// connections, in planar walls for every joint; in shear walls `stiffness` gives it its damping (4) alone.
    Rigid,
    /// No elastic force and no damping.
    None,
}

/// What a law means to either model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Acts {
    /// Nothing acts.
    Not,
    /// Sides part freely and never overlap.
    Rigidly,
    /// Springs with so many times the stiffness act in compression, and in tension if they pull.
    ByStiffness {
        /// Factor on the stiffness.
        times: f64,
        /// Whether they act in tension too.
        pulls: bool,
    },
}

impl Spring {
    /// What its law means.
    pub fn acts(&self) -> Acts {
        match self.law {
            SpringLaw::None => Acts::Not,
            SpringLaw::Rigid => Acts::Rigidly,
            SpringLaw::Elastic => Acts::ByStiffness { times: 1.0, pulls: true },
            SpringLaw::NoTension => Acts::ByStiffness { times: self.rigidity, pulls: false },
        }
    }
}

impl SpringLaw {
    /// Whether it is [`SpringLaw::Elastic`].
    pub fn is_elastic(self) -> bool {
        self == SpringLaw::Elastic
    }
    /// Whether it is [`SpringLaw::NoTension`].
    pub fn is_no_tension(self) -> bool {
        self == SpringLaw::NoTension
    }
    /// Whether it is [`SpringLaw::Rigid`].
    pub fn is_rigid(self) -> bool {
        self == SpringLaw::Rigid
    }
    /// Whether it is [`SpringLaw::None`].
    pub fn is_open(self) -> bool {
        self == SpringLaw::None
    }
    /// Whether it is one of springs.
    pub fn has_springs(self) -> bool {
        !self.is_rigid() && !self.is_open()
    }
    /// Whether its sides part freely.
    pub fn parts(self) -> bool {
        self.is_no_tension() || self.is_rigid()
    }
}

/// Friction of the joints.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// The law; a wall without the table has none.
    pub law: FrictionLaw,
    /// μ_s, from 0; every law but `none` needs it.
    #[serde(rename = "static", default)]
    #[schemars(range(min = 0.0))]
    pub static_: f64,
    /// μ_d, from 0 to μ_s; `stribeck` and `stribeck-stick` need it. Default of `coulomb`: μ_s.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub dynamic: f64,
    /// δ_v [m/s], above 0. Default 1 mm/s (section 4.2).
    #[serde(default = "default_slip_velocity")]
    pub slip_velocity: Velocity,
    /// β, above 0: slope of the first branch. Default 100.
    #[serde(default = "default_beta")]
    #[schemars(range(min = 0.0))]
    pub beta: f64,
    /// α [s²/m²], from 0: slope of the slip branch. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub alpha: f64,
    /// Which joints rub; default `bed`.
    #[serde(default)]
    pub on: FrictionOn,
    /// Where the normal force comes from; default `transmitted`.
    #[serde(default)]
    pub normal_force: NormalForce,
    /// `"report"` sets `on = "all"` and `normal_force = "overburden"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preset: Option<FrictionPreset>,
}

fn default_slip_velocity() -> Velocity {
    Velocity::from_si(1e-3)
}
fn default_beta() -> f64 {
    100.0
}

impl Default for Friction {
    fn default() -> Self {
        Friction {
            law: FrictionLaw::None,
            static_: 0.0,
            dynamic: 0.0,
            slip_velocity: default_slip_velocity(),
            beta: default_beta(),
            alpha: 0.0,
            on: FrictionOn::Bed,
            normal_force: NormalForce::Transmitted,
            preset: None,
        }
    }
}

/// Friction laws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FrictionLaw {
    /// Velocity-dependent, regularised, equation (6).
    Stribeck,
    /// Set-valued: sticks truly up to μ_s, slips at μ_d from the first instant, equation (6a). Coulomb's own law
    /// has μ_d = μ_s.
    Coulomb,
    /// Set-valued: sticks truly up to μ_s, in slip as `stribeck`, equation (6b); `beta` has no meaning.
    StribeckStick,
    /// No friction.
    None,
}

/// Which joints rub.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FrictionOn {
    /// Bed and support joints.
    #[default]
    Bed,
    /// All joints, head joints too (the research report's equation 3.1).
    All,
}

/// Bond of the joints: intact joints are elastic and do not rub until they crack.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointBond {
    /// f_t in Pa, from 0: tensile strength of head joints and connections. 0: they are not bonded. Default 0.
    #[serde(default)]
    pub tensile_strength: Stress,
    /// c in Pa, from 0: cohesion of bed and support joints. 0 with `friction_angle` 0: they are not bonded. Default 0.
    #[serde(default)]
    pub cohesion: Stress,
    /// φ in rad, 0 … 80 deg: the vertical load on a bed or support joint adds N tan φ to its strength. Default 0.
    #[serde(default)]
    pub friction_angle: Angle,
    /// G_f^I [N/m], from 0: energy per area of opening a head joint, no less than what it stores at its strength. 0:
    /// brittle. Default 0.
    #[serde(default)]
    pub mode_1_energy: EnergyPerArea,
    /// G_f^II [N/m], from 0: energy per area of shearing a bed or support joint, no less than what it stores at its
    /// strength. 0: brittle. Default 0.
    #[serde(default)]
    pub mode_2_energy: EnergyPerArea,
    /// Fraction of the elastic stiffness that a cracked bed or support joint keeps beside its friction, 0 … 1; below 1
    /// with `mode_2_energy`. 1 is the unbonded elastic joint of equation (2), whose spring never lets go. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub residual_stiffness: f64,
    /// Kinds of joint that are bonded; default all.
    #[serde(default = "all_kinds")]
    pub on: Vec<JointKind>,
}

fn all_kinds() -> Vec<JointKind> {
    vec![JointKind::Bed, JointKind::Head, JointKind::Base, JointKind::Top, JointKind::Connection]
}

impl Default for JointBond {
    fn default() -> Self {
        JointBond {
            tensile_strength: Stress::from_si(0.0),
            cohesion: Stress::from_si(0.0),
            friction_angle: Angle::from_si(0.0),
            mode_1_energy: EnergyPerArea::from_si(0.0),
            mode_2_energy: EnergyPerArea::from_si(0.0),
            residual_stiffness: 0.0,
            on: all_kinds(),
        }
    }
}

/// Normal force in equation (5).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NormalForce {
    /// The load carried by the joint, from statics; action equals reaction.
    #[default]
    Transmitted,
    /// The research report's 3.1: in block i's equation every joint carries w_ij (m_i g + P0_i).
    Overburden,
}

/// Named choices of `on` and `normal_force`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FrictionPreset {
    /// All joints, overburden loads.
    Report,
}

/// Other laws for some joints: at least one of `spring`, `friction` and `bond`, or `device`, is given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointChange {
    /// Which joints: all conditions given must hold.
    pub at: Selector,
    /// The elastic law they get instead; keys not given stay as they are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spring: Option<SpringChange>,
    /// The friction they get instead; keys not given stay as they are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionChange>,
    /// The bond they get instead; keys not given stay as they are. Joints without a bond get one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bond: Option<BondChange>,
    /// The device that they get in the place of their mortar, spring, friction and bond, whatever other changes say of
    /// these; of two devices of a joint the later one stays.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub device: Option<Device>,
}

/// Conditions that choose joints.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Selector {
    /// Kinds of joint.
    pub kind: Vec<JointKind>,
    /// Names of panels of this wall.
    pub panel: Vec<String>,
    /// Courses from 1 at the bottom; a bed joint belongs to the course that lies on it, the top support to none
    /// but the beam's (courses + 1).
    #[schemars(inner(range(min = 1)))]
    pub course: Vec<usize>,
    /// Names of joints, as `concio check` draws them (`p1c1b1|p1c2b1`).
    pub joints: Vec<String>,
    /// Rectangle `[x0, y0, x1, y1]` in which the middle of the joint lies [m]; x0 below x1, y0 below y1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub region: Option<[Length; 4]>,
}

/// What a [`JointChange`] changes of the elastic law.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SpringChange {
    /// The law.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub law: Option<SpringLaw>,
    /// K_H or K_V [N/m], or per area of the joint, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<Stiffness>,
    /// κ, above 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rigidity: Option<f64>,
    /// e, 0 … 1, of a rigid joint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: Option<f64>,
    /// η, 0 … 1, of a rigid joint. Planar walls alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub rocking_restitution: Option<f64>,
    /// Factor on the elastic force alone, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness_factor: Option<f64>,
    /// ζ, 0 … 2.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping_ratio: Option<f64>,
    /// k_n/k_s, above 0. Planar walls alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normal_to_shear: Option<f64>,
    /// f_c in Pa, above 0. Planar walls alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compressive_strength: Option<Stress>,
}

/// What a [`JointChange`] changes of the friction.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FrictionChange {
    /// The law.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub law: Option<FrictionLaw>,
    /// μ_s, from 0.
    #[serde(rename = "static", skip_serializing_if = "Option::is_none")]
    pub static_: Option<f64>,
    /// μ_d, from 0 to μ_s; follows a `static` of law `coulomb` where nothing gives it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dynamic: Option<f64>,
    /// δ_v [m/s], above 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slip_velocity: Option<Velocity>,
    /// β, above 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beta: Option<f64>,
    /// α [s²/m²], from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alpha: Option<f64>,
}

/// What a [`JointChange`] changes of the bond; strengths of 0 take it away.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BondChange {
    /// f_t in Pa, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tensile_strength: Option<Stress>,
    /// c in Pa, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cohesion: Option<Stress>,
    /// φ in rad, 0 … 80 deg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction_angle: Option<Angle>,
    /// G_f^I [N/m], from 0; 0: brittle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mode_1_energy: Option<EnergyPerArea>,
    /// G_f^II [N/m], from 0; 0: brittle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mode_2_energy: Option<EnergyPerArea>,
    /// Fraction of the stiffness that stays, 0 … 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub residual_stiffness: Option<f64>,
}

/// Loads at the top of the wall.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Load {
    /// q [N/m], from 0: vertical load per length of brick, which mortar is no part of; or the whole, `{ force = "150 kN" }`. Default 0.
    pub top: TopLoad,
    /// Mass of what bears down on a wall without a beam [kg], from 0: the ground shakes it with the blocks that it lies on, spread over them as
    /// the load is. Default the load over g; 0 for a load that moves with nothing, such as that of a jack. A beam has a mass of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass: Option<Mass>,
    /// The top beam.
    pub beam: Beam,
    /// Whether the beam may turn. Planar walls with a beam alone; default free.
    #[serde(skip_serializing_if = "is_default")]
    pub beam_rotation: BeamRotation,
    /// Height of the beam [m], above 0: what drives, holds and loads it acts at its middle. Planar walls with a beam alone;
    /// default half of a brick's height.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beam_height: Option<Length>,
}

/// Vertical load on the top: per length of brick, `"40 kN/m"`, or the whole, `{ force = "150 kN" }`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TopLoad {
    /// q [N/m].
    PerLength(ForcePerLength),
    /// q times the length of brick that it lies on [N].
    Force(Force),
}

impl TopLoad {
    /// q [N/m] where it lies on `length` [m]; 0 where that is 0.
    pub fn per_length(self, length: f64) -> f64 {
        match self {
            TopLoad::PerLength(q) => q.si(),
            TopLoad::Force(_) if length == 0.0 => 0.0,
            TopLoad::Force(force) => force.si() / length,
        }
    }
}

impl Default for TopLoad {
    fn default() -> Self {
        0.0.into()
    }
}

impl From<f64> for TopLoad {
    /// Per length [N/m].
    fn from(si: f64) -> Self {
        TopLoad::PerLength(si.into())
    }
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Rotation of the top beam of a planar wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BeamRotation {
    /// The beam turns as the wall below makes it: a wall that stands alone.
    #[default]
    Free,
    /// The beam stays level: a pier between stiff spandrels.
    Fixed,
}

/// The top beam: `"free"`, `"driven"`, `"tied"` or `{ mass = "1000 kg" }`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Beam {
    /// No beam, the load only.
    #[default]
    Free,
    /// Its motion is prescribed by `motion.top`.
    Driven,
    /// It moves with the base.
    Tied,
    /// A rigid beam with this mass [kg], above 0: one more unknown.
    Mass(Mass),
}

/// Motion of base and top.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Motion {
    /// Length of the run [s], above 0; default the length of the longest record, synthetic record or path, without one
    /// the key is needed. By default a rocking wall has 60 s more to come to rest in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<Time>,
    /// What ends the run before: `"collapse"`, 2 s after a block has fallen or turned over, or so long after it,
    /// `{ collapse = "0.5 s" }`, from 0. Planar walls alone; default nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop_at: Option<StopAt>,
    /// U0: motion of the base.
    pub base: Signal,
    /// U1: motion of the top beam; given exactly when `load.beam` is `driven`.
    pub top: Signal,
    /// V0: vertical motion of the base, positive upwards. Planar and rocking walls alone; default none.
    #[serde(skip_serializing_if = "is_default")]
    pub vertical: Signal,
    /// Leave inertia out: every step starts at rest, and what moves the wall does so slowly. Planar walls alone; default
    /// false.
    #[serde(skip_serializing_if = "is_default")]
    pub quasi_static: bool,
}

/// What ends a run before its motion does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StopAt {
    /// So long after the wall counts as collapsed, from 0 [s].
    Collapse(Time),
}

impl StopAt {
    /// Time after a collapse unless one is given [s]: what falls has come down, from up to 20 m.
    pub const AFTER_COLLAPSE: f64 = 2.0;
}

impl Motion {
    /// The three motions, each with its key.
    pub fn signals(&self) -> [(&'static str, &Signal); 3] {
        [("base", &self.base), ("top", &self.top), ("vertical", &self.vertical)]
    }

    /// Whether a run without `duration` ends with the motion: after other signals a wall still has something to do.
    pub fn has_length(&self) -> bool {
        self.signals().iter().any(|(_, s)| matches!(s, Signal::Record(_) | Signal::Synthetic(_) | Signal::Path(_)))
    }

    /// The three motions.
    pub fn signals_mut(&mut self) -> [&mut Signal; 3] {
        [&mut self.base, &mut self.top, &mut self.vertical]
    }
}

/// A motion: `"none"`, or a table with exactly one of `record`, `sine`, `ramp`, `tilt`, `path`, `pulse`, `sweep`,
/// `synthetic` (and beside `record` the keys of [`RecordInput`]).
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Signal {
    /// At rest.
    #[default]
    None,
    /// A file.
    Record(RecordInput),
    /// A sine.
    Sine(Sine),
    /// A ramp of the displacement.
    Ramp(Ramp),
    /// An acceleration that grows and stays.
    Tilt(Tilt),
    /// A displacement that goes from place to place.
    Path(DisplacementPath),
    /// A pulse.
    Pulse(Pulse),
    /// A swept sine.
    Sweep(Sweep),
    /// A seeded spectrum-compatible accelerogram.
    Synthetic(Synthetic),
}

/// An accelerogram or displacement history from a file, and what is done to it, in this order:
/// trim, reverse, baseline, resample, scale.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordInput {
    /// The file, relative to the wall file; its format is found from its content.
    #[serde(serialize_with = "forms::path_as_text")]
    pub record: PathBuf,
    /// Which component of a file with several; default the first horizontal one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channel: Option<RecordChannel>,
    /// Factor on the values, of either sign; default 1. Not together with `pga`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Scale to this peak acceleration [m/s²], above 0, instead of `scale`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pga: Option<Acceleration>,
    /// Keep this interval of the record [s]: `[from, to]`, from 0, in this order; it starts at t = 0 then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trim: Option<[Time; 2]>,
    /// Play it backwards: the last sample first; default false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub reverse: bool,
    /// New sample interval [s], above 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resample: Option<Time>,
    /// Baseline correction; default none.
    #[serde(default)]
    pub baseline: Baseline,
    /// What the values of a CSV/TXT file are; default acceleration.
    #[serde(default)]
    pub quantity: HistoryQuantity,
    /// Unit of the values of a CSV/TXT file that does not name one (`"g"`, `"cm/s2"`, `"mm"`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<String>,
    /// Sample interval of a CSV/TXT file without a time column that does not name one [s], above 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dt: Option<Time>,
    /// How the values stand in a CSV/TXT file; default `columns`, unless the file says otherwise (`# layout: rows`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<HistoryLayout>,
}

/// A component of a record: its place in the file from 1, or its name there, of which a word is enough (`"N-S"`, `"Up"`, `"HNE"`).
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RecordChannel {
    /// Place in the file, from 1.
    Number(usize),
    /// The name, or a word of it; upper and lower case are one.
    Name(String),
}

/// How the values stand in a text file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HistoryLayout {
    /// One column for each component, after a time column or without one.
    Columns,
    /// One component without time, row by row: every line goes on where the line before it ends.
    Rows,
}

/// What the values of a text history are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HistoryQuantity {
    /// Acceleration.
    #[default]
    Acceleration,
    /// Displacement.
    Displacement,
}

/// Baseline correction: `"none"`, `{ polynomial = 2 }` or `{ high-pass = "0.1 Hz", order = 4 }`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Baseline {
    /// As it is.
    #[default]
    None,
    /// Subtract the least-squares polynomial of this degree (0 … 6) from the acceleration.
    Polynomial(usize),
    /// Butterworth high-pass, forward and backward.
    HighPass {
        /// Corner, above 0 and below the Nyquist frequency.
        corner: Frequency,
        /// Order, 1 … 8; default 4.
        order: usize,
    },
}

/// A sine, at rest before t = 0: u = amplitude · min(1, t/ramp) · sin(2π f t), or the same of the acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sine {
    /// Displacement amplitude [m], of either sign; give this or `acceleration`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<Length>,
    /// Acceleration amplitude [m/s²], of either sign; give this or `amplitude`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<Acceleration>,
    /// f [Hz], above 0.
    pub frequency: Frequency,
    /// Time over which the amplitude grows linearly [s], from 0; default 0.
    #[serde(default)]
    pub ramp: Time,
    /// Number of cycles after which it ends, above 0; default: goes on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cycles: Option<f64>,
}

/// A displacement that grows linearly and stays.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ramp {
    /// Displacement reached [m], of either sign.
    pub amplitude: Length,
    /// When it starts [s], from 0, before the run ends; default 0.
    #[serde(default)]
    pub start: Time,
    /// How long it takes [s], above 0.
    pub rise: Time,
}

/// An acceleration that grows linearly and stays, as if the ground were tilted slowly: a horizontal force on every block
/// in proportion to its mass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tilt {
    /// Acceleration reached [m/s²], of either sign.
    pub acceleration: Acceleration,
    /// How long it takes [s], above 0.
    pub rise: Time,
    /// When it starts [s], from 0, before the run ends; default 0.
    #[serde(default)]
    pub start: Time,
}

/// A displacement that goes from 0 to each of the given ones in turn, at one speed, and stays at the last.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DisplacementPath {
    /// Displacements in their order [m], of either sign: at least one, up to 1,000, each other than the one before it
    /// and the first other than 0.
    pub displacements: Vec<Length>,
    /// How fast it goes [m/s], above 0.
    pub speed: Velocity,
}

/// A pulse of the acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pulse {
    /// Its family.
    pub shape: PulseShape,
    /// Peak acceleration [m/s²], of either sign.
    pub acceleration: Acceleration,
    /// Length of the rectangle, of the half sine, of the whole sine; 1/(dominant frequency) of the Ricker
    /// wavelet [s]. Above 0.
    pub duration: Time,
    /// When it starts [s], from 0, before the run ends; default 0 (the Ricker wavelet's peak lies 1.5 durations later).
    #[serde(default)]
    pub start: Time,
}

/// Families of pulses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PulseShape {
    /// Constant.
    Rectangular,
    /// Half a sine.
    HalfSine,
    /// One whole sine.
    OneSine,
    /// Ricker wavelet (second derivative of a Gaussian).
    Ricker,
}

/// A sine whose frequency moves from one end to the other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// Acceleration amplitude [m/s²], of either sign.
    pub acceleration: Acceleration,
    /// Start and end frequency [Hz], each above 0.
    pub frequency: [Frequency; 2],
    /// Time of the sweep [s], above 0.
    pub duration: Time,
    /// Exponential instead of linear growth of the frequency.
    #[serde(default)]
    pub logarithmic: bool,
}

/// A seeded accelerogram whose 5 % response spectrum follows a target (EN 1998-1 type 1 or 2 shape).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Synthetic {
    /// Seed.
    pub seed: u64,
    /// Design ground acceleration a_g times soil factor [m/s²], above 0: the spectrum's value at T = 0.
    pub pga: Acceleration,
    /// Duration [s], above 2.
    pub duration: Time,
    /// Sample interval [s], above 0 and up to 0.02; default 0.005. Fewer than 200,000 samples.
    #[serde(default = "default_synthetic_dt")]
    pub dt: Time,
    /// Corner periods T_B, T_C, T_D of the target [s], above 0 and rising; default EN 1998-1 type 1, ground B: 0.15, 0.5, 2.
    #[serde(default = "default_corners")]
    pub corners: [Time; 3],
}

fn default_synthetic_dt() -> Time {
    Time::from_si(0.005)
}
fn default_corners() -> [Time; 3] {
    [0.15, 0.5, 2.0].map(Time::from_si)
}

/// Time integration.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Solver {
    /// The scheme.
    pub scheme: Scheme,
    /// Relative tolerance of the local error against the largest motion so far, 1e-12 … 0.1. Default 1e-2.
    #[schemars(range(min = 1e-12, max = 0.1))]
    pub tolerance: f64,
    /// Displacement [m] below which errors do not count, above 0. Default 1e-14.
    pub floor: Length,
    /// Longest step [s], above 0; default none but the sample interval of the records.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_step: Option<Time>,
    /// Step of a planar wall [s], from 1e-8; default 1 ms, without inertia 20 ms. Longest step of a rocking wall; default what resolves it. Not
    /// for shear walls.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<Time>,
}

impl Default for Solver {
    fn default() -> Self {
        Solver { scheme: Scheme::TrBdf2, tolerance: 1e-2, floor: Length::from_si(1e-14), max_step: None, step: None }
    }
}

/// What a run keeps. Envelopes and energies are always kept.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Output {
    /// Interval of the histories [s], above 0; default the record's sample interval, or duration/2000; without inertia
    /// so many whole steps that there are no more than 2000. Up to 10,000,000 samples.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval: Option<Time>,
    /// Interval of the full frames (displacement and velocity of every block) [s], from 0 (no frames);
    /// default duration/400, rounded to a multiple of `interval`. Not shorter than `interval`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frames: Option<Time>,
    /// Blocks whose displacement, velocity and acceleration histories are kept; `["all"]` for every block.
    pub blocks: Vec<String>,
    /// Joints whose slip, slip velocity, elastic force and friction force histories are kept; `["all"]` for all.
    pub joints: Vec<String>,
}

impl Case {
    /// Step of a planar wall [s].
    pub(crate) fn planar_step(&self) -> f64 {
        let own = if self.motion.quasi_static { QUASI_STATIC_STEP } else { PLANAR_STEP };
        self.solver.step.map_or(own, |h| h.si())
    }

    /// The name of a panel (from 0): its own, or `p1`, `p2`, ….
    pub fn panel_name(&self, panel: usize) -> String {
        self.panels.get(panel).and_then(|p| p.name.clone()).unwrap_or_else(|| format!("p{}", panel + 1))
    }
}
