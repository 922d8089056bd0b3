//! Bonds of a wall, compiled for the shear model, and what results say of them. The law, (B1) to (B5), is in `concio_law`.

pub use concio_law::bond::{Bond, BondState};
use concio_shear::law::{Bonded, Elastic, Rub};

use crate::assign::BondValues;
use crate::assign::{JointLaw, resolve};
use crate::case::Case;
use crate::error::{InputError, Result};
use crate::graph;
use crate::quantity::shown;
use crate::wall::{Joint, Wall};

/// A bonded joint and what became of it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BondRow {
    /// Index of the joint.
    pub joint: usize,
    /// Force at which it cracks [N].
    pub strength: f64,
    /// Stiffness of the intact joint [N/m]; of a head joint or connection in tension.
    pub stiffness: f64,
    /// Fraction of it that a cracked joint keeps, 0 … 1.
    pub residual_stiffness: f64,
    /// Energy that it takes to break [J].
    pub energy: f64,
    /// Length over which the strength falls, δ_c of (B3) [m]; 0 when it is brittle.
    pub decay: f64,
    /// Damage at the end, the part of the stiffness that is lost, 0 … 1.
    pub damage: f64,
    /// Part of the joint's length along which it has cracked, 0 … 1; of shear walls all of it at once.
    pub crack: f64,
    /// The part of it that lies at the joint's first end, left or below; the rest lies at the other.
    pub crack_start: f64,
    /// Energy that breaking has taken [J].
    pub spent: f64,
    /// When it first cracked [s]; infinite when it did not.
    pub cracked: f64,
    /// When nothing was left of it [s]; infinite when something is.
    pub broken: f64,
}

impl BondRow {
    /// The bond of a joint in a result.
    pub(crate) fn of(bonded: &Bonded, state: &BondState) -> Self {
        let (joint, law) = (bonded.joint as usize, &bonded.law);
        let whole = if state.damage > 0.0 { [1.0, 0.0] } else { [0.0; 2] };
        let [crack_start, crack_end] = state.crack.unwrap_or(whole);
        BondRow {
            joint,
            strength: law.strength,
            stiffness: law.stiffness,
            residual_stiffness: law.residual,
            energy: law.energy(),
            decay: law.decay,
            damage: state.damage,
            crack: crack_start + crack_end,
            crack_start,
            spent: state.spent,
            cracked: state.cracked,
            broken: state.broken,
        }
    }
}

/// What `case`, whose wall and joints these are, says of the bond of every joint; none for joints that `on` leaves out.
///
/// # Errors
/// None that compiling the model did not have.
pub fn given(case: &Case, wall: &Wall, joints: &[Joint]) -> Result<Vec<Option<BondValues>>> {
    Ok(resolve(case, wall, joints)?.iter().map(|law| law.bond).collect())
}

/// The bonds of a wall. Head joints that are bonded open when they have cracked: their springs in `elastic` are
/// made one-sided, the bond has the tension.
pub(crate) fn compile(
    wall: &Wall,
    joints: &[Joint],
    laws: &[JointLaw],
    normal: &[[f64; 2]],
    rubs: &[Rub],
    elastic: &mut [Elastic],
) -> Result<Vec<Bonded>> {
    let mut bonds = Vec::new();
    let mut snaps = Snaps::default();
    let mut rub = 0;
    for (e, (joint, law)) in joints.iter().zip(laws).enumerate() {
        while rub < rubs.len() && (rubs[rub].joint as usize) < e {
            rub += 1;
        }
        let Some(b) = law.bond else { continue };
        let opens = joint.kind.is_upright();
        let area = joint.area(wall);
        let pressed = 0.5 * (normal[e][0] + normal[e][1]) * b.tan_angle;
        let strength = if opens { b.tensile_strength * area } else { b.cohesion * area + pressed };
        if strength <= 0.0 {
            continue;
        }
        let stiffness = law.stiffness(joint, wall) * law.spring.stiffness_factor;
        if !law.spring.law.has_springs() || stiffness == 0.0 {
            return Err(without_stiffness(&graph::name(wall, joint)).into());
        }
        let (residual, energy) = if opens { (0.0, b.energy[0]) } else { (b.residual, b.energy[1]) };
        let Some(bond) = Bond::new(strength, stiffness, residual, energy * area, opens) else {
            let brittle = Bond { strength, stiffness, residual, decay: 0.0, opens };
            let snap = Snap { joint: e, least: brittle.least_energy() / area, given: energy, whole: residual == 1.0 };
            snaps.add(usize::from(!opens), snap);
            continue;
        };
        elastic[e].unilateral |= opens;
        let rub = (rub < rubs.len() && rubs[rub].joint as usize == e).then_some(rub as u32);
        bonds.push(Bonded { joint: e as u32, rub, law: bond });
    }
    snaps.refused(wall, joints)?;
    Ok(bonds)
}

/// A joint whose fracture energy is too small.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Snap {
    pub joint: usize,
    /// Least fracture energy, and that given [N/m].
    pub least: f64,
    pub given: f64,
    /// Whether nothing of its stiffness goes.
    pub whole: bool,
}

/// In either mode, the joint that would need the most.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Snaps([Option<Snap>; 2]);

impl Snaps {
    /// Takes in a joint that would snap back in `mode`, 0 or 1.
    pub fn add(&mut self, mode: usize, snap: Snap) {
        let worst = &mut self.0[mode];
        if worst.is_none_or(|w| snap.least > w.least) {
            *worst = Some(snap);
        }
    }

    /// # Errors
    /// Where there is one.
    pub fn refused(&self, wall: &Wall, joints: &[Joint]) -> Result<()> {
        for (key, snap) in ["mode_1_energy", "mode_2_energy"].into_iter().zip(self.0) {
            if let Some(snap) = snap {
                return Err(snap.refused(key, &graph::name(wall, &joints[snap.joint])).into());
            }
        }
        Ok(())
    }
}

impl Snap {
    fn refused(&self, key: &str, name: &str) -> InputError {
        let at = format!("joint.bond.{key}");
        if self.whole {
            let what = format!("joint {name} keeps its whole stiffness when it cracks: there is nothing to soften");
            return InputError::new(what).key(at).allowed("0, or residual_stiffness below 1");
        }
        // Rounded up, so that the number in the message is one that is allowed.
        let digits = 10f64.powi(2 - self.least.log10().floor() as i32);
        let least = (self.least * digits).floor() + 1.0;
        let given = shown(self.given);
        InputError::new(format!("{given} N/m is less than joint {name} stores at its strength: it would snap back"))
            .key(at)
            .allowed(format!("from {} N/m, or 0 for a brittle bond", shown(least / digits)))
            .help("the energy that a joint stores at its strength is F²/(2 k) over its area")
    }
}

fn without_stiffness(name: &str) -> InputError {
    InputError::new(format!("joint {name} has no stiffness: a bond is elastic until it cracks"))
        .key("joint.bond")
        .allowed("law `elastic` or `no-tension` with a stiffness above 0, or leave the joint out with `on`")
}
