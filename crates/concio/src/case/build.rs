//! Walls built in Rust instead of read: the pieces of a [`Case`] with the defaults of wall files, in SI units.

use std::path::Path;

use super::read::{CaseFile, from_str};
use super::{
    Bond, Brick, Case, Ends, First, Friction, FrictionLaw, Joints, Load, ModelKind, Mortar, Motion, Output, Panel,
    Rocking, Solver, Spring, SpringLaw, Syntax,
};
use crate::error::Result;
use crate::quantity::{SpecificWeight, Stiffness};

impl Case {
    /// A wall of one panel, without load, ties, forces and bond.
    pub fn new(model: ModelKind, panel: Panel, joint: Joints, motion: Motion) -> Self {
        Case {
            title: String::new(),
            model,
            set: None,
            panels: vec![panel],
            ties: Vec::new(),
            forces: Vec::new(),
            out_of_plane: None,
            rocking: Rocking::default(),
            joint,
            load: Load::default(),
            motion,
            solver: Solver::default(),
            output: Output::default(),
        }
    }
}

impl Brick {
    /// Of length, height and thickness [m] and a specific weight [N/m³].
    pub fn new([length, height, thickness]: [f64; 3], specific_weight: impl Into<SpecificWeight>) -> Self {
        Brick {
            length: length.into(),
            height: height.into(),
            thickness: thickness.into(),
            specific_weight: specific_weight.into(),
        }
    }
}

impl Panel {
    /// A running bond of so many courses and bricks, with mortar of these thicknesses in bed and head joints [m].
    pub fn running(courses: usize, bricks: usize, brick: Brick, [bed, head]: [f64; 2]) -> Self {
        Panel {
            name: None,
            bond: Bond::Running,
            courses: Some(courses),
            bricks: Some(bricks),
            ends: Ends::default(),
            first: First::default(),
            brick,
            mortar: Mortar { bed: bed.into(), head: head.into() },
            course_list: Vec::new(),
            random: None,
            blocks: Vec::new(),
            arch: None,
            openings: Vec::new(),
            connection: None,
        }
    }

    /// The same with head joints in line.
    pub fn stack(courses: usize, bricks: usize, brick: Brick, mortar: [f64; 2]) -> Self {
        Panel { bond: Bond::Stack, ..Panel::running(courses, bricks, brick, mortar) }
    }
}

impl Joints {
    /// Bed and head joints without friction and bond.
    pub fn new(bed: Spring, head: Spring) -> Self {
        Joints {
            damping_ratio: super::default_damping_ratio(),
            bed,
            head,
            base: None,
            top: None,
            connection: None,
            friction: Friction::default(),
            bond: None,
            changes: Vec::new(),
        }
    }
}

impl Spring {
    /// Of this law and stiffness: of the whole joint [N/m], or per area ([`Stiffness`]).
    pub fn new(law: SpringLaw, stiffness: impl Into<Stiffness>) -> Self {
        Spring {
            law,
            stiffness: stiffness.into(),
            rigidity: super::default_rigidity(),
            stiffness_factor: super::one(),
            restitution: None,
            rocking_restitution: None,
            damping_ratio: None,
            normal_to_shear: super::ISOTROPIC,
            compressive_strength: None,
        }
    }

    /// Rigid, its sides part freely.
    pub fn rigid() -> Self {
        Spring::new(SpringLaw::Rigid, 0.0)
    }

    /// Nothing.
    pub fn none() -> Self {
        Spring::new(SpringLaw::None, 0.0)
    }
}

impl Friction {
    /// Coulomb's law with one coefficient.
    pub fn coulomb(mu: f64) -> Self {
        Friction { law: FrictionLaw::Coulomb, static_: mu, dynamic: mu, ..Friction::default() }
    }
}

impl CaseFile {
    /// A case that was built, to be validated and run as one that was read; record paths are relative to the working directory.
    ///
    /// # Errors
    /// As [`crate::case::from_str`], by keys alone.
    pub fn of(case: &Case) -> Result<CaseFile> {
        from_str(&super::canonical_json(case), Syntax::Json, None::<&Path>)
    }
}
