//! What the shear model integrates: immutable arrays of masses and joints, with one horizontal degree of freedom per block, and one for a top
//! beam with mass (theory, sections 2 and 3). It knows no wall.

use concio_law::drift::Tops;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::law::{Bonded, Contact, Elastic, Nonlinear, Rub, Support};

/// Everything that a step needs and nothing that it changes.
#[derive(Debug, Clone, Default)]
pub struct System {
    /// Mass of every unknown [kg]: blocks, then the beam if it has mass.
    pub mass: Vec<f64>,
    /// How many of the unknowns are blocks.
    pub blocks: usize,
    /// Both sides of each joint as indices of unknowns; [`System::base`] and [`System::top`] stand for the supports.
    pub sides: Vec<[u32; 2]>,
    /// Whether each joint is a head joint or a connection, which opens where the others slide.
    pub upright: Vec<bool>,
    /// Elastic part of each joint.
    pub elastic: Vec<Elastic>,
    /// Frictional part of the joints that rub, in the order of the joints.
    pub rubs: Vec<Rub>,
    /// The joints whose mortar holds until it cracks, likewise; `elastic` has their springs as they are before.
    pub bonds: Vec<Bonded>,
    /// What some devices do beyond the springs and dashpots in `elastic` and the friction in `rubs`, likewise.
    pub nonlinear: Vec<Nonlinear>,
    /// The rigid unilateral joints, likewise.
    pub contacts: Vec<Contact>,
    /// Where the blocks lie [m], for the order of the elimination.
    pub centres: Vec<[f64; 2]>,
    /// Which unknowns are the tops.
    pub tops: Tops,
    /// From when on the run counts for residual drifts [s].
    pub settles: f64,
    /// What is joined to the base, and to the top beam, be it driven, tied or one with mass; by [`System::completed`], as all below.
    pub on_base: Support,
    /// See above.
    pub on_beam: Support,
    /// True when every joint's normal force is the same on both sides: the stage matrices are symmetric then.
    pub reciprocal: bool,
    /// Largest ω² = Σk/m of a block over its bilateral joints [1/s²], never 0: the time scale of the first step and
    /// of the floor of the velocities.
    pub stiffest: f64,
}

/// Integration schemes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// TR-BDF2: order 2, L-stable.
    TrBdf2,
    /// ESDIRK4(3)6L\[2\]SA: order 4, L-stable; for smooth motion and tight tolerances.
    Esdirk4,
}

impl System {
    /// With what follows from the arrays; `duration` is that of the run [s].
    pub fn completed(mut self, duration: f64) -> Self {
        let n = self.unknowns();
        let support = |side| Support::of(side, &self.sides, &self.rubs, &self.bonds, &self.contacts, &self.nonlinear);
        let (on_base, on_beam) = (support(n), support(self.floating_beam().unwrap_or(n + 1)));
        (self.on_base, self.on_beam) = (on_base, on_beam);
        let sides = &self.sides;
        let both = |r: &Rub| sides[r.joint as usize][1] as usize >= n || r.normal[0] == r.normal[1];
        self.reciprocal = self.rubs.iter().all(both);
        // Springs with the stiffness at rest of the devices beside them.
        let mut at_rest = self.elastic.clone();
        for device in &self.nonlinear {
            at_rest[device.joint as usize].stiffness += device.law.initial_stiffness();
        }
        self.stiffest = stiffest(&self.mass, &self.sides, &at_rest, duration);
        self
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.mass.len()
    }
    /// Index that stands for the base in [`System::sides`].
    pub fn base(&self) -> usize {
        self.mass.len()
    }
    /// Index that stands for a driven or tied top in [`System::sides`].
    pub fn top(&self) -> usize {
        self.mass.len() + 1
    }
    /// Index of the beam's unknown.
    pub fn floating_beam(&self) -> Option<usize> {
        (self.mass.len() > self.blocks).then_some(self.blocks)
    }

    /// Whether a joint has a law that is no function of the motion: friction that sticks truly, or rigid contact.
    pub fn set_valued(&self) -> bool {
        !self.contacts.is_empty() || self.sticks()
    }
    /// Whether a joint has a set-valued friction law.
    pub fn sticks(&self) -> bool {
        self.rubs.iter().any(|r| r.law.sticks())
    }

    /// Index in [`System::contacts`] of every rigid joint.
    pub fn contact_of_joint(&self) -> Vec<Option<usize>> {
        self.of_joints(self.contacts.iter().map(|contact| contact.joint))
    }
    /// Index in [`System::bonds`] of every bonded joint.
    pub fn bond_of_joint(&self) -> Vec<Option<usize>> {
        self.of_joints(self.bonds.iter().map(|bond| bond.joint))
    }
    /// Index in [`System::nonlinear`] of every joint with such a device.
    pub fn nonlinear_of_joint(&self) -> Vec<Option<usize>> {
        self.of_joints(self.nonlinear.iter().map(|device| device.joint))
    }
    /// Index in [`System::rubs`] of every joint that rubs.
    pub fn rub_of_joint(&self) -> Vec<Option<usize>> {
        self.of_joints(self.rubs.iter().map(|rub| rub.joint))
    }

    fn of_joints(&self, joints: impl Iterator<Item = u32>) -> Vec<Option<usize>> {
        let mut index = vec![None; self.sides.len()];
        joints.enumerate().for_each(|(k, e)| index[e as usize] = Some(k));
        index
    }
}

impl Support {
    /// Of the support with number `side` in `sides`.
    pub fn of(
        side: usize,
        sides: &[[u32; 2]],
        rubs: &[Rub],
        bonds: &[Bonded],
        contacts: &[Contact],
        nonlinear: &[Nonlinear],
    ) -> Self {
        fn those(joints: impl Iterator<Item = u32>, on: impl Fn(u32) -> bool) -> Vec<u32> {
            joints.enumerate().filter(|(_, e)| on(*e)).map(|(k, _)| k as u32).collect()
        }
        let on = |e: u32| sides[e as usize][1] as usize == side;
        Support {
            joints: those(0..sides.len() as u32, on),
            rubs: those(rubs.iter().map(|r| r.joint), on),
            bonds: those(bonds.iter().map(|b| b.joint), on),
            contacts: those(contacts.iter().map(|c| c.joint), on),
            devices: those(nonlinear.iter().map(|d| d.joint), on),
        }
    }
}

/// Largest ω² = Σk/m of an unknown over its bilateral joints; where there are none, over the closed unilateral ones;
/// and no less than one swing in the run, so that a wall without stiffness has a time scale too.
fn stiffest(mass: &[f64], sides: &[[u32; 2]], elastic: &[Elastic], duration: f64) -> f64 {
    let n = mass.len();
    let over = |unilateral: bool| {
        let mut sum = vec![0.0; n + 2];
        for (side, law) in sides.iter().zip(elastic).filter(|(_, law)| law.unilateral == unilateral) {
            sum[side[0] as usize] += law.stiffness;
            sum[side[1] as usize] += law.stiffness;
        }
        mass.iter().zip(&sum).map(|(m, k)| k / m).fold(0.0, f64::max)
    };
    let bilateral = over(false);
    let largest = if bilateral > 0.0 { bilateral } else { over(true) };
    largest.max((std::f64::consts::TAU / duration).powi(2))
}
