//! What stands and pulls out of the plane of a wall: keys of `[out_of_plane]` and `[rocking]`. Runs in the plane do not read them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{Acceleration, Angle, Force, ForcePerLength, Length, SpecificWeight, Stress, Time};

/// What a wall needs to be assessed out of its plane: floors, ties, side walls, gable, site. `concio mechanisms` and walls of
/// `model = "rocking"` read it; runs and limit analysis in the plane do not. Distances in the thickness are from the outer face, the one to which the wall falls.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OutOfPlane {
    /// Which face is the outer one, to which the wall falls; default `front`, the one that drawings show.
    #[serde(skip_serializing_if = "super::is_default")]
    pub outside: Face,
    /// f_h [Pa], above 0: compressive strength that sets hinges back from the face, equation (OP2). Default none: rigid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strength: Option<Stress>,
    /// Block of pressure at a hinge; default `rectangular`.
    #[serde(skip_serializing_if = "super::is_default")]
    pub pressure: PressureBlock,
    /// Thicknesses of leaves from the outside [m], each above 0, together the wall's; up to 10. Default one leaf.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub leaves: Vec<Length>,
    /// Whether headers tie the leaves, so that they turn as one wall; default false where leaves are given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leaves_tied: Option<bool>,
    /// FC, 1 … 1.35: confidence factor on the capacity. Default 1.35, that of LC1, which the code asks for whenever crushing is
    /// left out; without `strength` no lower one is taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1.0, max = 1.35))]
    pub confidence_factor: Option<f64>,
    /// q, 1 … 3: behaviour factor of the linear check for life safety. Default 2.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1.0, max = 3.0))]
    pub behaviour_factor: Option<f64>,
    /// Floors and roof, up to 100.
    #[serde(rename = "floor", skip_serializing_if = "Vec::is_empty")]
    pub floors: Vec<FloorLoad>,
    /// Ties that hold the wall back, up to 1,000.
    #[serde(rename = "anchor", skip_serializing_if = "Vec::is_empty")]
    pub anchors: Vec<Anchor>,
    /// Walls that meet this one from behind, up to 100.
    #[serde(rename = "side_wall", skip_serializing_if = "Vec::is_empty")]
    pub side_walls: Vec<SideWall>,
    /// A triangular gable on top of the wall.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gable: Option<Gable>,
    /// A strip that may bend outwards between two abutments, equation (OP7).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strip: Option<Strip>,
    /// The site: hazard by limit state. Default none: no checks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub site: Option<Site>,
    /// The building, for mechanisms whose hinge lies aloft; default one as high as the wall, with a storey for each floor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub building: Option<Building>,
    /// Spectra of floors S_eZ, up to 100. Default none: checks aloft that need one are not made.
    #[serde(rename = "floor_spectrum", skip_serializing_if = "Vec::is_empty")]
    pub floor_spectra: Vec<FloorSpectrum>,
}

/// Which mechanism rocks, and how.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Rocking {
    /// Its kind; default that of the mechanism with the least α0 of all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mechanism: Option<RockingKind>,
    /// Level of its hinge above the base [m], from 0: a bed joint. Default the one with the least α0. With `mechanism` alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hinge: Option<Length>,
    /// e, 0 … 1: velocity after an impact over that before. Default by formula. It is chosen, not known: try others.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: Option<f64>,
    /// To which side positive values of `motion.base` point; default `inwards`, which lifts the wall off. A record has no sign that a façade
    /// knows: try both.
    #[serde(skip_serializing_if = "super::is_default")]
    pub positive: Towards,
}

/// Mechanisms that rock: those with level hinges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RockingKind {
    /// Overturning about a bed joint.
    Overturning,
    /// The same with wedges of side walls, or held by their friction.
    OverturningWithSideWalls,
    /// Overturning of the outer leaf alone.
    OverturningOfOuterLeaf,
    /// A storey that bulges between two levels that hold it.
    VerticalArch,
    /// Overturning of the whole gable.
    Gable,
}

/// Sides of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Towards {
    /// From the outer face inwards.
    #[default]
    Inwards,
    /// Outwards.
    Outwards,
}

/// Faces of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Face {
    /// The one that drawings show.
    #[default]
    Front,
    /// The other one.
    Back,
}

/// Pressure of masonry that crushes at a hinge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PressureBlock {
    /// Constant: a = N/(2 f_h L).
    #[default]
    Rectangular,
    /// Linear: a = 2N/(3 f_h L).
    Triangular,
}

/// A floor or a roof on the wall, along its whole length.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FloorLoad {
    /// Level above the base [m], above 0 and up to the wall's top.
    pub z: Length,
    /// P [N/m], from 0: load on the wall, per length of it.
    pub load: ForcePerLength,
    /// x_P [m], from 0 to the wall's thickness: distance of the load's resultant from the outer face. Default half of the thickness.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Length>,
    /// Q [N/m], from 0: weight of mass that pushes the wall but rests elsewhere. Default 0.
    #[serde(default)]
    pub push: ForcePerLength,
    /// H [N/m]: horizontal thrust, positive outwards. Default 0.
    #[serde(default)]
    pub thrust: ForcePerLength,
    /// μ_f, from 0: friction of the seat. Default 0.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub seat_friction: f64,
    /// Length of the seat [m], above 0: beams lose it when the wall has moved so far. Default none: not checked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seat_length: Option<Length>,
    /// Force up to which the floor is connected to the wall [N/m], from 0. Default 0.
    #[serde(default)]
    pub connection: ForcePerLength,
    /// Whether the floor holds the wall at its level, whatever it pulls with: then the wall bends between floors, equation
    /// (OP6), and overturns above the highest such floor alone. Default false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub holds: bool,
    /// Whether it cannot turn at its seat, so that its load moves to the outer edge as the wall bends. Default false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub clamps: bool,
}

/// A tie that holds the wall back, its plate on the outer face.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Anchor {
    /// Level above the base [m], above 0 and up to the wall's top.
    pub z: Length,
    /// Position along the wall [m], from 0: from its leftmost edge. Default its middle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x: Option<Length>,
    /// Force at which it yields [N], above 0.
    pub yield_force: Force,
    /// Force at which its anchorage gives way [N], above 0; the lower of both counts. Default none: it does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub anchorage: Option<Force>,
    /// E A over its length [N/m], above 0. Default none: rigid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<ForcePerLength>,
    /// By how much the wall may move before it bears [m], from 0. Default 0.
    #[serde(default)]
    pub slack: Length,
    /// Displacement of the wall at which it breaks [m], above 0. Default none: it does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub breaks_at: Option<Length>,
}

/// A wall that meets this one from behind.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SideWall {
    /// Where its middle meets the wall [m], from 0: from the wall's leftmost edge.
    pub x: Length,
    /// t_s [m], above 0.
    pub thickness: Length,
    /// Whether it is bonded to the wall: blocks of both overlap in turn. Default true.
    #[serde(default = "super::yes", skip_serializing_if = "Clone::clone")]
    pub bonded: bool,
    /// γ [N/m³], above 0. Default that of the first panel's brick.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub specific_weight: Option<SpecificWeight>,
    /// h_b [m], above 0: height of its courses. Default that of the first panel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub course_height: Option<Length>,
    /// l [m], above 0: overlap of its blocks. Default the mean of the first panel's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub overlap: Option<Length>,
    /// μ, from 0: friction of its overlaps. Default `joint.friction.static`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub friction: Option<f64>,
    /// q [N/m], from 0: load on it. Default 0.
    #[serde(default)]
    pub load: ForcePerLength,
    /// Distance of its first opening from this wall's inner face [m], above 0, which bounds the crack. Default none: no opening.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_opening: Option<Length>,
    /// Distance of this wall's first opening from the corner [m], above 0, which bounds the crack of a corner. Default found from
    /// the openings of the panels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub opening_beside: Option<Length>,
    /// What a hip rafter brings to the corner with this wall. Default nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub corner: Option<CornerLoad>,
}

/// What lies on a corner at the top.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CornerLoad {
    /// P [N], from 0. Default 0.
    #[serde(default)]
    pub load: Force,
    /// s_P [m], from 0: distance of P behind the hinge line, which passes through the outer corner. Default 0.
    #[serde(default)]
    pub at: Length,
    /// Q [N], from 0: weight of mass that pushes but rests elsewhere. Default 0.
    #[serde(default)]
    pub push: Force,
    /// H [N]: thrust of the rafter, positive outwards. Default 0.
    #[serde(default)]
    pub thrust: Force,
    /// φ in rad, 10 … 80 deg: direction of falling, from the plane of this wall. Default 45 deg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<Angle>,
}

/// A triangular gable on top of the wall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gable {
    /// h_g [m], above 0.
    pub height: Length,
    /// Length of its base [m], above 0. Default the wall's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<Length>,
    /// t [m], above 0. Default the wall's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thickness: Option<Length>,
    /// P [N], from 0: load of the ridge beam. Default 0.
    #[serde(default)]
    pub ridge_load: Force,
    /// c [m], from 0 to the gable's thickness: depth of that load behind the outer face. Default half of the thickness.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ridge_at: Option<Length>,
    /// Q [N], from 0: weight of mass that pushes but rests elsewhere. Default 0.
    #[serde(default)]
    pub ridge_push: Force,
    /// H [N]: thrust at the ridge, positive outwards. Default 0.
    #[serde(default)]
    pub ridge_thrust: Force,
    /// Thrust on the crack below the ridge [N], from 0, with which flaps press on each other. Default 0.
    #[serde(default)]
    pub crack_thrust: Force,
}

/// A strip of the wall that may bend outwards between two abutments.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Strip {
    /// Level of its lower edge [m], from 0.
    pub from: Length,
    /// H_r [N], from 0: thrust at which the weaker abutment gives way: a tie along the wall, a side wall in its plane.
    pub thrust: Force,
    /// Span between the abutments [m], above 0. Default the length of the wall.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub span: Option<Length>,
    /// μ, from 0: friction of the bed joint below the strip. Default 0: left out.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub friction: f64,
}

/// Hazard of a site by limit state. Limit states that are not given are not checked.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Site {
    /// Damage (SLD).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damage: Option<Hazard>,
    /// Life safety (SLV).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub life_safety: Option<Hazard>,
    /// Collapse prevention (SLC).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collapse: Option<Hazard>,
}

impl Site {
    /// Keys of the limit states.
    pub const NAMES: [&str; 3] = ["damage", "life_safety", "collapse"];

    /// The limit states that are given, by key.
    pub fn hazards(&self) -> impl Iterator<Item = (&'static str, &Hazard)> {
        let given = [&self.damage, &self.life_safety, &self.collapse];
        Site::NAMES.into_iter().zip(given).filter_map(|(name, hazard)| Some((name, hazard.as_ref()?)))
    }
}

/// An elastic spectrum: the four parameters of the code, or columns at 5 % damping.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Hazard {
    /// a_g [m/s²], above 0: peak ground acceleration on rock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground_acceleration: Option<Acceleration>,
    /// S, above 0: soil and topography. Default 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub soil_factor: Option<f64>,
    /// F0, above 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub amplification: Option<f64>,
    /// T_C [s], above 0: C_C T_C*.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corner_period: Option<Time>,
    /// Periods [s], each from 0, rising and the first 0, up to 10,000; instead of the parameters.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub periods: Vec<Time>,
    /// S_e(T, 5 %) at them [m/s²], each from 0 and the first above 0; as many as periods.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub accelerations: Vec<Acceleration>,
}

/// The building whose floors shake a mechanism aloft.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Building {
    /// H [m], no less than the height of the wall.
    pub height: Length,
    /// Number of storeys, 1 … 100.
    #[schemars(range(min = 1, max = 100))]
    pub storeys: usize,
    /// T_1 [s], above 0. Default 0.05 H^0.75.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Time>,
    /// ξ_1, 0 … 0.3. Default 0.05.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 0.3))]
    pub damping_ratio: Option<f64>,
    /// γ_1, above 0. Default 3n/(2n + 1).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub participation: Option<f64>,
}

/// A floor spectrum S_eZ as columns at 5 % damping.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FloorSpectrum {
    /// Level [m], from 0 to half a metre above the building; a mechanism takes the one that is nearest to its hinge, if it is not farther than half a metre.
    pub z: Length,
    /// Periods [s], each from 0, rising and the first 0, up to 10,000.
    pub periods: Vec<Time>,
    /// S_eZ at them [m/s²], each from 0 and the first above 0; as many as periods.
    pub accelerations: Vec<Acceleration>,
}
