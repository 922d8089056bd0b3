//! A wall with all that its mechanisms need: masonry with its openings, floors, ties, side walls, site. The engine makes it of a wall file.

use crate::checks::{Building, Hazard, Spectrum};
use crate::corner::CornerLoad;
use crate::facade::{Floor, Masonry, Tie};
use crate::gable::Gable;
use crate::setback::Crushing;
use crate::side_wall::SideWall;

/// A wall with all that its mechanisms need, in SI.
#[derive(Debug, Clone)]
pub struct Wall {
    /// Masonry.
    pub masonry: Masonry,
    /// γ of the first panel [N/m³].
    pub specific_weight: f64,
    /// Left and right end [m].
    pub extent: [f64; 2],
    /// Level of the top [m].
    pub top: f64,
    /// Levels of hinges [m], rising, the base first.
    pub levels: Vec<f64>,
    /// Openings [m]: left, bottom, right, top.
    pub openings: Vec<[f64; 4]>,
    /// Mean height of courses and mean overlap of blocks [m].
    pub texture: [f64; 2],
    /// μ of bed joints.
    pub friction: f64,
    /// E of the masonry upwards [Pa]: what its bed joints give between rigid blocks, k_n times the height of a course. None of joints
    /// without stiffness.
    pub modulus: Option<f64>,
    /// Whether the outer face is the back one, which drawings of the wall file do not show.
    pub back: bool,
    /// Floors, with their place in the file where they have one, in rising order.
    pub floors: Vec<FloorOf>,
    /// Ties.
    pub ties: Vec<Tie>,
    /// Bonded side walls.
    pub side_walls: Vec<Side>,
    /// Side walls that are not bonded.
    pub loose: usize,
    /// Thickness of the outer leaf [m], where leaves are not tied.
    pub leaf: Option<f64>,
    /// Crushing at hinges.
    pub crushing: Crushing,
    /// Gable.
    pub gable: Option<(Gable, f64)>,
    /// Strip for a horizontal arch: lower level, thrust, span, friction.
    pub strip: Option<[f64; 4]>,
    /// FC.
    pub confidence: f64,
    /// q.
    pub behaviour: f64,
    /// Hazard by limit state.
    pub hazard: Hazard,
    /// The building.
    pub building: Building,
    /// Floor spectra with their levels [m].
    pub floor_spectra: Vec<(f64, Spectrum)>,
    /// Data that the file lacks or that are taken otherwise than they may be meant, each with what is assumed.
    pub assumed: Vec<Assumed>,
}

/// A floor, and how it holds the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorOf {
    /// The loads.
    pub floor: Floor,
    /// Whether the table of floors has it; else it is `load.top`, or the gable as what lies below feels it.
    pub given: bool,
    /// Whether it holds the wall at its level.
    pub holds: bool,
    /// Whether it cannot turn.
    pub clamps: bool,
}

/// A bonded side wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Side {
    /// Where its middle meets the wall [m].
    pub at: f64,
    /// It.
    pub wall: SideWall,
    /// Whether it stands at an end of the wall, so that there is a corner.
    pub corner: Option<CornerOf>,
}

/// A corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerOf {
    /// Load of a hip rafter.
    pub load: CornerLoad,
    /// φ [rad].
    pub direction: f64,
    /// Distance of the wall's first opening from the corner [m].
    pub opening: Option<f64>,
}

/// A datum that is assumed.
#[derive(Debug, Clone, PartialEq)]
pub struct Assumed {
    /// Key of the wall file that would say it.
    pub key: String,
    /// What is assumed, and on which side that is.
    pub what: String,
}

/// Heights within this are one level [m].
const LEVEL: f64 = 1e-6;
/// Ties up to so far above a floor bear its reaction [m].
const BESIDE: f64 = 0.5;

impl Wall {
    /// L [m].
    pub fn length(&self) -> f64 {
        self.extent[1] - self.extent[0]
    }

    /// What is known to bear the reaction of a floor that holds [N]: its connection, ties near it, and with one of them its
    /// seat. None where nothing says.
    pub fn borne(&self, upper: &FloorOf) -> Option<f64> {
        let known = upper.floor.connection + self.beside(upper.floor.level);
        (known > 0.0).then_some(known + upper.floor.friction * upper.floor.load)
    }

    /// Force of the ties that bear the reaction of a support at a level [N].
    pub fn beside(&self, level: f64) -> f64 {
        self.ties.iter().filter(|tie| self.is_beside(tie, level)).map(|tie| tie.force).sum()
    }

    /// Whether a tie is so near a support at a level [m] that it bears its reaction: from the bed joint below it on.
    pub fn is_beside(&self, tie: &Tie, level: f64) -> bool {
        tie.level >= self.joint_below(level) && tie.level <= level + BESIDE
    }

    /// Level of the bed joint below another one, or of the base [m].
    pub(crate) fn joint_below(&self, level: f64) -> f64 {
        self.levels.iter().copied().rfind(|z| *z < level - LEVEL).unwrap_or(0.0)
    }
}
