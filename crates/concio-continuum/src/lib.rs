//! The equivalent continuum of a wall: what a finite element program needs in the place of bricks and joints, and how far that
//! is from the wall.
//!
//! ```
//! use concio_continuum::{RunningBond, Stiffness};
//!
//! // Bricks of 260 × 65 × 120 mm that touch, joints of 86.4 and 36 N/mm³.
//! let joints = Stiffness::new(86.4e9, 36e9);
//! let bond = RunningBond::new([0.26, 0.065, 0.12], [0.0, 0.0], joints, joints)?;
//! let constants = bond.moduli().constants().expect("a bond that leans to no side");
//! assert!((constants.e1 / 31_824e6 - 1.0).abs() < 1e-9);
//! # Ok::<(), concio::Error>(())
//! ```
//!
//! | what | where |
//! |---|---|
//! | (H1) to (H4), running bond in closed form | [`RunningBond`] |
//! | other bonds, several bricks in a cell | [`Cell`], [`Moduli::of_cell`] |
//! | (H5) to (H7), strength by planes and by programs | [`planes`], [`Domain`] |
//! | bending strength of dry walls | [`dry_bending`] |
//! | how far the continuum is off | [`scale`], [`panel_stiffness`], [`membrane_stiffness`] |
//! | walls without a cell | [`window`] |
//! | all of it from a wall file | [`analyse`] |
//! | cards of finite element programs | [`Card`] |
//!
//! Axis 1 lies along the courses, 2 upwards, 3 out of the plane. Tension is positive. Bricks are rigid unless
//! [`Moduli::in_series`] is asked.

use std::fmt;

mod analysis;
mod bending;
mod card;
mod cell;
mod joint;
mod membrane;
mod moduli;
mod panel;
mod polar;
mod running;
mod springs;
mod strength;
mod texture;
mod units;
mod window;

pub use analysis::{Found, Options, Scale, ScaleCurve, StrengthFound, Windows, analyse, scale_curve};
pub use bending::{Bending, dry_bending};
pub use card::{Card, Density, Format};
pub use cell::{Cell, CellBrick, CellCourse, Laying};
pub use joint::{Contact, Stiffness, Strength};
pub use membrane::membrane_stiffness;
pub use moduli::{Constants, Couple, Moduli};
pub use panel::{panel_stiffness, scale};
pub use running::RunningBond;
pub use strength::{Domain, Plane, Planes, Reach, cut, holds, planes};
pub use texture::{Heads, Pattern, Strengths, Texture};
pub use units::Units;
pub use window::{Window, WindowModuli, window, windows};

/// Why there is no continuum.
#[derive(Debug)]
pub enum ContinuumError {
    /// The input is wrong.
    Input(concio::Error),
    /// A system of equations or a linear program was not solved; its own words.
    NotSolved(String),
    /// Nothing holds the wall together along an axis.
    FallsApart,
    /// The point from which a strength is asked for lies outside of the domain.
    Outside,
}

impl fmt::Display for ContinuumError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ContinuumError::Input(error) => write!(f, "{error}"),
            ContinuumError::NotSolved(why) => write!(f, "equations were not solved: {why}"),
            ContinuumError::FallsApart => write!(f, "nothing holds the wall together along an axis"),
            ContinuumError::Outside => write!(f, "the wall does not bear the stress that strength is asked from"),
        }
    }
}

impl std::error::Error for ContinuumError {}

impl From<concio::Error> for ContinuumError {
    fn from(error: concio::Error) -> Self {
        ContinuumError::Input(error)
    }
}

impl From<concio::InputError> for ContinuumError {
    fn from(error: concio::InputError) -> Self {
        ContinuumError::Input(error.into())
    }
}
