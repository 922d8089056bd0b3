//! What a run leaves on disk: one HDF5 file when it is over ([`hdf5`], with a [`vtkhdf`] group in it), a [`journal`]
//! while it goes on, a [`summary()`] in JSON, and copies in other formats ([`export`]). What is read back has a [`digest`].
//! docs/results.md describes them all.

pub mod digest;
pub mod export;
mod fields;
mod h5;
pub mod hdf5;
pub mod journal;
mod outlines;
mod read;
mod summary;
pub mod vtkhdf;

use crate::bond::BondRow;
use crate::case::{DeviceLaw, FrictionLaw, SpringLaw};
use crate::law::Bonded;
use crate::outcome::Outcome;
use crate::wall::{Joint, Wall};
use concio_shear::law::Elastic;
use concio_shear::law::spring_force;

pub use journal::{Journal, JournalHeader};
pub use summary::{
    Moving, RunFacts, is_summary, read_summary, residual_relative, summary, top_force_rms, write_summary,
};

/// Version of the layout of result files; raised when a reader of the former version would misread a file.
pub const SCHEMA_VERSION: u32 = 11;

/// Where a result comes from. Nothing in it depends on clock, machine or folder: equal inputs give equal files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Provenance {
    /// The resolved case, as JSON.
    pub case_json: String,
    /// Hash over everything the result depends on: case, records, version.
    pub inputs_hash: String,
    /// Version of Concio.
    pub version: String,
    /// Model solved: `shear`, `planar`.
    pub model: String,
}

/// A joint and the numbers it was compiled to.
#[derive(Debug, Clone, PartialEq)]
pub struct JointRow {
    /// Geometry.
    pub joint: Joint,
    /// Unique name, `p1c1b1|p1c2b1`.
    pub name: String,
    /// Elastic law.
    pub law: SpringLaw,
    /// Stiffness as it acts [N/m]: overlap weight, and in shear walls rigidity of a no-tension joint, included; of planar walls that along the joint.
    pub stiffness: f64,
    /// Stiffness across of a joint of a planar wall that is pressed [N/m]; 0 in shear walls, of rigid and of open joints.
    pub normal_stiffness: f64,
    /// Damping as it acts [N s/m]: overlap weight included.
    pub damping: f64,
    /// Normal force in the equation of `a` and of `b` [N]; equal unless `overburden`.
    pub normal_force: [f64; 2],
    /// Friction; none for a joint that does not rub.
    pub friction: Option<FrictionRow>,
    /// Restitution of a rigid joint; 0 for the others.
    pub restitution: f64,
    /// Law of the device in place of mortar, if it has one.
    pub device: Option<DeviceLaw>,
}

impl JointRow {
    /// Elastic force on the lower or left block, against its relative motion [N], at x_a − x_b = `d` [m]; `bond` is the
    /// joint's bond, if it has one, and its damage.
    pub fn elastic_force(&self, d: f64, bond: Option<(&BondRow, f64)>) -> f64 {
        let upright = self.joint.kind.is_upright();
        let unilateral = upright && self.law.parts();
        match bond {
            None => spring_force(unilateral, self.stiffness, d),
            Some((bond, damage)) => {
                let elastic = Elastic { stiffness: self.stiffness, damping: self.damping, unilateral };
                Bonded { joint: 0, rub: None, law: bond.law(upright) }.force(&elastic, damage, d)
            }
        }
    }
}

/// Friction of one joint (theory, equation 6).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionRow {
    /// The law.
    pub law: FrictionLaw,
    /// μ_s.
    pub static_: f64,
    /// μ_d.
    pub dynamic: f64,
    /// δ_v [m/s].
    pub slip_velocity: f64,
    /// β.
    pub beta: f64,
    /// α [s²/m²].
    pub alpha: f64,
}

impl FrictionRow {
    /// Velocity up to which motion is creep of the regularised law and no slip [m/s]; 0 for laws that stick truly.
    pub fn creeps_below(&self) -> f64 {
        match self.law {
            FrictionLaw::Stribeck => self.slip_velocity,
            FrictionLaw::StribeckStick | FrictionLaw::Coulomb | FrictionLaw::None => 0.0,
        }
    }
}

/// Everything a result file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredRun {
    /// Layout version of the file.
    pub schema_version: u32,
    /// Inputs and version.
    pub provenance: Provenance,
    /// Blocks and panels.
    pub wall: Wall,
    /// Joints.
    pub joints: Vec<JointRow>,
    /// Histories, frames, envelopes, energies, totals, counters.
    pub outcome: Outcome,
}
