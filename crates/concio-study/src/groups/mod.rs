//! The dimensionless form of the equations of motion.
//!
//! With a mass M, a stiffness K, Ω = √(K/M), a length Λ, and u = x/Λ, τ = Ω t, μ_i = m_i/M, k_ij = K_ij/K,
//! γ_ij = C_ij/C, C = 2ξΩM, equation (1) of the theory becomes (Buckingham; the research report's 4.6)
//!
//! (G1)  μ_i u_i″ + 2ξ Σ γ_ij (u_i′ − u_j′) + Σ k_ij (u_i − u_j) + Σ n_ij μ(ΛΩ (u_i′ − u_j′)) = −μ_i A(τ)
//!
//! with n_ij = N_ij/(M Ω² Λ) and A = a/(Ω² Λ). M is the mass of the first panel's reference brick and K the stiffness K_H of
//! bed joints, K_V where they have none. Λ enters as a factor of u alone and may be any length: the reference brick's
//! unless another is asked for. Walls of one texture whose groups are equal move alike, u(τ) for u(τ). Bonds and rigid
//! joints add groups that are not told here.

pub mod realise;
pub mod table1;

use std::f64::consts::TAU;
use std::path::Path;

use concio::case::{Beam, Brick, Case, Signal};
use concio::model::Model;
use concio::{InputError, Result};
use serde::Serialize;

use crate::intensity::{DAMPING, Intensity, Sampled};
use crate::motions;

pub use realise::{PREFIX, realise};

/// M, K, Ω, Λ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Reference {
    /// M [kg].
    pub mass: f64,
    /// K [N/m].
    pub stiffness: f64,
    /// Ω [rad/s].
    pub frequency: f64,
    /// Λ [m].
    pub length: f64,
}

impl Reference {
    /// Of a case; Λ [m] is the length of the first panel's reference brick where none is given.
    ///
    /// # Errors
    /// A wall without panel or stiffness.
    pub fn of(case: &Case, length: Option<f64>) -> Result<Self> {
        let Some(panel) = case.panels.first() else {
            return Err(InputError::new("the wall has no panel").key("panel").into());
        };
        let brick = panel.brick;
        let sides = brick.length.si() * brick.height.si() * brick.thickness.si();
        let mass = brick.specific_weight.si() * sides / concio::G;
        let of = |spring: &concio::case::Spring, area: f64| match spring.law.is_open() {
            true => 0.0,
            false => spring.stiffness.over(area),
        };
        let [bed, head] = areas(&brick);
        let stiffness = [of(&case.joint.bed, bed), of(&case.joint.head, head)].into_iter().find(|k| *k > 0.0);
        let Some(stiffness) = stiffness else {
            let error =
                InputError::new("the dimensionless form needs a stiffness, and neither bed nor head joints have one");
            return Err(error.key("joint.bed.stiffness").allowed("above 0 N/m").into());
        };
        let length = length.unwrap_or(brick.length.si());
        Ok(Reference { mass, stiffness, frequency: (stiffness / mass).sqrt(), length })
    }

    /// ΛΩ [m/s], the unit of velocities.
    pub fn velocity(&self) -> f64 {
        self.length * self.frequency
    }

    /// Ω²Λ [m/s²], the unit of accelerations.
    pub fn acceleration(&self) -> f64 {
        self.frequency * self.frequency * self.length
    }

    /// KΛ [N], the unit of forces.
    pub fn force(&self) -> f64 {
        self.stiffness * self.length
    }
}

/// Areas [m²] of a half-brick contact and of a head joint of the reference brick: what stands for the wall where one
/// number has to be had of a stiffness per area.
fn areas(brick: &Brick) -> [f64; 2] {
    [0.5 * brick.length.si(), brick.height.si()].map(|side| side * brick.thickness.si())
}

/// A group and what the wall has of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Group {
    /// Its name in study files, behind `group.`.
    pub name: &'static str,
    /// Its formula.
    pub formula: &'static str,
    /// Least and largest value in the wall; none where the wall has no such thing.
    pub value: Option<[f64; 2]>,
    /// Range over the sets of Table 1, or section 4.2, of the research report; none where it prints no numbers. Where Λ is not the
    /// length of the wall's reference brick, the bricks of the research report are as many Λ long.
    pub table1: Option<[f64; 2]>,
    /// Key of the wall file that a study changes to realise a value of the group; none where it cannot be varied.
    pub realised_by: Option<&'static str>,
}

/// The groups of a wall that was made ready. Record paths start from `folder`.
///
/// # Errors
/// As [`Reference::of`]; a record that cannot be read.
pub fn groups(case: &Case, model: &Model, folder: &Path, reference: &Reference) -> Result<Vec<Group>> {
    let range = table1::ranges();
    // Λ over the brick's length: of the research report's walls as of this one.
    let units = reference.length / Reference::of(case, None)?.length;
    let (r, joint) = (reference, &case.joint);
    let of = |values: &mut dyn Iterator<Item = f64>| {
        values.fold(None, |range: Option<[f64; 2]>, v| Some(range.map_or([v, v], |[a, b]| [a.min(v), b.max(v)])))
    };
    let one = |v: f64| Some([v, v]);
    let blocks = model.wall.blocks.len();
    let springs = |kind: fn(concio::case::JointKind) -> bool| {
        let chosen = model.joints.iter().zip(&model.shear.elastic).filter(move |(j, _)| kind(j.kind));
        of(&mut chosen.map(|(_, e)| e.stiffness / r.stiffness))
    };
    let damping =
        of(&mut model.shear.elastic.iter().map(|e| e.damping / (2.0 * r.frequency * r.mass)).filter(|x| *x > 0.0));
    let normal = of(&mut model.shear.rubs.iter().flat_map(|rub| rub.normal).map(|n| n / r.force()));
    let brick = case.panels[0].brick.length.si();
    let beam = if let Beam::Mass(m) = case.load.beam { one(m.si() / r.mass) } else { None };
    let rubs = (!model.shear.rubs.is_empty()).then_some(joint.friction);
    let smooth = rubs.filter(|f| f.law == concio::case::FrictionLaw::Stribeck);
    let base = base_motion(case, folder, r)?;
    let top = top_amplitude(case).map(|u| u / r.length);
    Ok(GROUPS
        .iter()
        .map(|&(name, formula, realised_by)| {
            let value = match name {
                "mass" => of(&mut model.shear.mass[..blocks].iter().map(|m| m / r.mass)),
                "weight" => one(r.mass * concio::G / r.force()),
                "beam_mass" => beam,
                "stiffness" => springs(|k| !k.is_upright()),
                "head_stiffness" => springs(|k| k.is_upright()),
                "damping" => damping,
                "load" => {
                    let length = model.wall.loaded().iter().sum();
                    one(case.load.top.per_length(length) * brick / r.force()).filter(|v| v[0] > 0.0)
                }
                "normal_force" => normal,
                "static" => rubs.and_then(|f| one(f.static_)),
                "dynamic" => rubs.and_then(|f| one(f.dynamic)),
                "slip_velocity" => smooth.and_then(|f| one(f.slip_velocity.si() / r.velocity())),
                "beta" => smooth.and_then(|f| one(f.beta)),
                "alpha" => rubs.and_then(|f| one(f.alpha * r.velocity() * r.velocity())),
                "acceleration" => base.map(|[a, _]| [a, a]),
                "frequency" => base.map(|[_, f]| [f, f]).filter(|f| f[0].is_finite()),
                "top_displacement" => top.map(|u| [u, u]),
                _ => one(model.excitation.duration * r.frequency),
            };
            let table1 = range.iter().find(|(n, _)| *n == name);
            let table1 = table1.map(|(_, range)| range.map(|v| v * units.powi(power_of_length(name))));
            Group { name, formula, value, table1, realised_by }
        })
        .collect())
}

/// The key of a wall file that a study changes to give a group its value.
pub fn realised_by(name: &str) -> Option<&'static str> {
    GROUPS.iter().find(|(known, _, _)| *known == name)?.2
}

/// Names, formulas, and keys that realise them.
const GROUPS: [(&str, &str, Option<&str>); 17] = [
    ("mass", "μ_i = m_i/M", None),
    ("weight", "M g/(K Λ)", Some("panel[*].brick.specific_weight")),
    ("beam_mass", "M_b/M", Some("load.beam.mass")),
    ("stiffness", "k_ij = K_ij/K of bed and support joints", None),
    ("head_stiffness", "k_ij = K_ij/K of head joints and connections, closed", Some("joint.head.stiffness")),
    ("damping", "ξ γ_ij = C_ij/(2 Ω M)", Some("joint.damping_ratio")),
    ("load", "q L/(K Λ)", Some("load.top")),
    ("normal_force", "n_ij = N_ij/(M Ω² Λ)", None),
    ("static", "μ_s", Some("joint.friction.static")),
    ("dynamic", "μ_d", Some("joint.friction.dynamic")),
    ("slip_velocity", "δ_v/(Λ Ω)", Some("joint.friction.slip_velocity")),
    ("beta", "β", Some("joint.friction.beta")),
    ("alpha", "α (Λ Ω)²", Some("joint.friction.alpha")),
    ("duration", "Ω T of the run", Some("motion.duration")),
    ("frequency", "2π f/Ω of the base motion", Some("motion.base")),
    ("acceleration", "A = PGA/(Ω² Λ)", Some("motion.base")),
    ("top_displacement", "U₁/Λ of a driven top", Some("motion.top")),
];

/// Power of Λ in a group.
fn power_of_length(name: &str) -> i32 {
    match name {
        "weight" | "load" | "normal_force" | "slip_velocity" | "acceleration" | "top_displacement" => -1,
        "alpha" => 2,
        _ => 0,
    }
}

/// PGA/(Ω²Λ) and frequency over Ω; that of a record is where its 5 % pseudo-acceleration is largest. None at rest.
fn base_motion(case: &Case, folder: &Path, r: &Reference) -> Result<Option<[f64; 2]>> {
    if case.motion.base == Signal::None {
        return Ok(None);
    }
    let mut rooted = case.clone();
    rooted.motion.base = motions::rooted(&case.motion.base, folder);
    let pga = Intensity::Pga.of(&rooted, 0.0)?;
    let frequency = match frequency(&case.motion.base) {
        Some(frequency) => frequency,
        None => predominant(&rooted)?,
    };
    Ok(Some([pga / r.acceleration(), TAU * frequency / r.frequency]))
}

/// Frequency of a motion that has one [Hz].
fn frequency(signal: &Signal) -> Option<f64> {
    match signal {
        Signal::Sine(sine) => Some(sine.frequency.si()),
        Signal::Pulse(pulse) => Some(match pulse.shape {
            concio::case::PulseShape::HalfSine | concio::case::PulseShape::Rectangular => 0.5 / pulse.duration.si(),
            _ => 1.0 / pulse.duration.si(),
        }),
        _ => None,
    }
}

fn predominant(case: &Case) -> Result<f64> {
    let periods: Vec<f64> = (0..200).map(|k| 0.02 * 250f64.powf(f64::from(k) / 199.0)).collect();
    let psa = Sampled::of_case(case)?.psa(DAMPING, &periods);
    let best = (0..periods.len()).max_by(|&a, &b| psa[a].total_cmp(&psa[b]));
    Ok(best.map_or(f64::NAN, |k| 1.0 / periods[k]))
}

/// Amplitude of a driven top that is given as a displacement [m].
fn top_amplitude(case: &Case) -> Option<f64> {
    match (&case.load.beam, &case.motion.top) {
        (Beam::Driven, Signal::Sine(sine)) => sine.amplitude.map(|u| u.si().abs()),
        (Beam::Driven, Signal::Ramp(ramp)) => Some(ramp.amplitude.si().abs()),
        (Beam::Driven, Signal::Path(path)) => path.displacements.iter().map(|u| u.si().abs()).reduce(f64::max),
        _ => None,
    }
}
