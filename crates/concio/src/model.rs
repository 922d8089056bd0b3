//! The compiled system: immutable arrays that the time loop reads. One horizontal degree of freedom per block, and one for
//! a top beam with mass (theory, sections 2 and 3).

use crate::G;
use crate::assign::{JointLaw, friction_choice, load_masses, resolve};
use crate::bond::{self, Bonded};
use crate::case::{Beam, Bond, Case, DeviceLaw, JointKind, ModelKind, Signal, SpringLaw, plausible};
use crate::device::{self, Device, Nonlinear};
use crate::drift::{self, Tops};
use crate::error::{InputError, Result};
use crate::excitation::Excitation;
use crate::graph;
use crate::law::{Contact, Elastic, Rub, Support};
use crate::planar::{self, Planar};
use crate::quantity::Length;
use crate::wall::{Block, End, Joint, Wall};
use crate::warning::{Warning, WarningKind};

/// Everything a run needs and nothing it changes.
#[derive(Debug, Clone)]
pub struct Model {
    /// The blocks.
    pub wall: Wall,
    /// Where its tops are.
    pub tops: Tops,
    /// The joints, in the order of the arrays below.
    pub joints: Vec<Joint>,
    /// What the top beam does.
    pub beam: Beam,
    /// What `load.top` brings to the wall, the weight of a beam with it [N].
    pub top_load: f64,
    /// Mass of that load on the blocks of a wall without a beam, which is in `mass` too [kg].
    pub load_mass: f64,
    /// Mass of every unknown [kg]: blocks, then the beam if it has mass.
    pub mass: Vec<f64>,
    /// Both sides of each joint as indices of unknowns; [`Model::base`] and [`Model::top`] stand for the supports.
    pub sides: Vec<[u32; 2]>,
    /// Elastic part of each joint.
    pub elastic: Vec<Elastic>,
    /// Frictional part of the joints that rub.
    pub rubs: Vec<Rub>,
    /// The joints whose mortar holds until it cracks; `elastic` has their springs as they are before.
    pub bonds: Vec<Bonded>,
    /// The joints with a device in the place of mortar, in the order of the joints.
    pub devices: Vec<Device>,
    /// What some of them do beyond the springs and dashpots in `elastic` and the friction in `rubs`.
    pub nonlinear: Vec<Nonlinear>,
    /// The rigid unilateral joints, in the order of the joints.
    pub contacts: Vec<Contact>,
    /// What is joined to the base, and to the top beam, be it driven, tied or one with mass.
    pub on_base: Support,
    /// See above.
    pub on_beam: Support,
    /// Motion of base and top, and the end of the run.
    pub excitation: Excitation,
    /// True when every joint's normal force is the same on both sides: the stage matrices are symmetric then.
    pub reciprocal: bool,
    /// Largest ω² = Σk/m of a block over its bilateral joints [1/s²], never 0: the time scale of the first step and
    /// of the floor of the velocities.
    pub stiffest: f64,
    /// What the blocks of a planar wall are and do; none in the shear model, which the arrays above are of.
    pub planar: Option<Planar>,
    /// Things a user should know before believing the result.
    pub warnings: Vec<Warning>,
}

impl Support {
    /// Of the support with number `side` in `sides`.
    pub(crate) fn of(
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

impl Model {
    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.mass.len()
    }
    /// Weight of all that has mass: blocks, the load on them, and the top beam where it has one [N].
    pub fn weight(&self) -> f64 {
        let blocks: f64 = self.wall.blocks.iter().map(Block::weight).sum();
        let of_load = if let Beam::Mass(mass) = self.beam { mass.si() } else { self.load_mass };
        blocks + of_load * G
    }
    /// Vertical force on the base at rest: blocks, and what `load.top` brings [N].
    pub fn base_load(&self) -> f64 {
        self.wall.blocks.iter().map(Block::weight).sum::<f64>() + self.top_load
    }
    /// Index that stands for the base in [`Model::sides`].
    pub fn base(&self) -> usize {
        self.mass.len()
    }
    /// Index that stands for a driven or tied top in [`Model::sides`].
    pub fn top(&self) -> usize {
        self.mass.len() + 1
    }

    /// Compiles a wall, its laws and its motion.
    ///
    /// # Errors
    /// Blocks that rest on nothing, selectors that name no joint, laws of a later version, bonds that would snap back.
    pub fn compile(case: &Case, wall: Wall, excitation: Excitation) -> Result<Model> {
        let beam = case.load.beam;
        let has_beam = !matches!(beam, Beam::Free);
        let joints = graph::joints(&wall, has_beam);
        let laws = resolve(case, &wall, &joints)?;
        let (_, from) = friction_choice(&case.joint.friction);
        let turns = case.model == ModelKind::Planar;
        let lies = if turns { planar::beam(case, &wall, &joints).map(|b| b.length) } else { None };
        let lies = lies.unwrap_or_else(|| wall.loaded().iter().sum());
        let per_length = case.load.top.per_length(lies);
        let normal = graph::normal_forces(&wall, &joints, per_length, has_beam, from);
        let laden = load_masses(case, &wall);
        let mut mass: Vec<f64> = wall.blocks.iter().zip(&laden).map(|(b, load)| b.mass() + load).collect();
        let top_load = per_length * lies;
        let floating = match beam {
            Beam::Mass(m) => Some(m.si()),
            // It rises and turns, if it does not slide.
            Beam::Driven | Beam::Tied if turns => planar::beam(case, &wall, &joints).map(|b| b.body.mass),
            _ => None,
        };
        let floating = floating.map(|m| {
            mass.push(m);
            mass.len() - 1
        });
        let n = mass.len();
        let side = |joint: &Joint| {
            let b = match joint.b {
                End::Block(b) => b,
                End::Base => n,
                End::Top => floating.unwrap_or(n + 1),
            };
            [joint.a as u32, b as u32]
        };
        let sides: Vec<[u32; 2]> = joints.iter().map(side).collect();
        let mut elastic: Vec<Elastic> =
            joints.iter().zip(&laws).map(|(joint, law)| compile_elastic(&wall, joint, law)).collect();
        let (devices, nonlinear) = device::compile(case, &laws, &mut elastic);
        let rub = |(e, (law, &normal)): (usize, (&JointLaw, &[f64; 2]))| {
            if let Some(device) = law.device(case) {
                return device::rub(e, device);
            }
            let loaded = normal[0] > 0.0 || normal[1] > 0.0;
            law.rubs().filter(|_| loaded).map(|law| Rub { joint: e as u32, normal, law })
        };
        let mut rubs: Vec<Rub> = laws.iter().zip(&normal).enumerate().filter_map(rub).collect();
        rubs.shrink_to_fit();
        let bonds = match turns {
            true => planar::bonds(&wall, &joints, &laws),
            false => bond::compile(&wall, &joints, &laws, &normal, &rubs, &mut elastic)?,
        };
        let reciprocal = rubs.iter().all(|r| sides[r.joint as usize][1] as usize >= n || r.normal[0] == r.normal[1]);
        let stiffest = stiffest(&mass, &sides, &device::at_rest(&elastic, &nonlinear), excitation.duration);
        let idle = laws.iter().zip(&normal).filter(|(law, n)| law.rubs().is_some() && n[0] == 0.0).count();
        let mut warnings = warnings(case, &wall, rubs.len(), if turns { 0 } else { idle }, reciprocal);
        let massless = massless(case, top_load, &mass[..wall.blocks.len()]);
        warnings.extend(massless.map(|text| Warning::new(WarningKind::MasslessLoad, text)));
        let stronger = stronger_cracked(&wall, &joints, &laws, &normal);
        warnings.extend(stronger.map(|text| Warning::new(WarningKind::UnlikelyJoint, text)));
        let crushed = crushed_at_rest(&wall, &joints, &laws, &normal).filter(|_| turns);
        warnings.extend(crushed.map(|text| Warning::new(WarningKind::UnlikelyJoint, text)));
        let wide = wide_joint(case, &wall, &joints, &laws);
        warnings.extend(wide.map(|text| Warning::new(WarningKind::UnlikelyJoint, text)));
        let detached = planar::detached(case, &wall).into_iter();
        warnings.extend(detached.map(|text| Warning::new(WarningKind::DetachedTie, text)));
        let planar = turns.then(|| planar::compile(case, &wall, &joints, &laws, &normal)).transpose()?;
        let rigid = |(e, law): (usize, &JointLaw)| {
            let spring = &law.spring;
            (spring.law == SpringLaw::Rigid)
                .then_some(Contact { joint: e as u32, restitution: spring.restitution.unwrap_or(0.0) })
        };
        let contacts: Vec<Contact> = laws.iter().enumerate().filter_map(rigid).collect();
        let support = |side| Support::of(side, &sides, &rubs, &bonds, &contacts, &nonlinear);
        let (on_base, on_beam) = (support(n), support(floating.unwrap_or(n + 1)));
        // A tied beam stays where the base is.
        let moves = matches!(beam, Beam::Driven | Beam::Mass(_));
        let tops = Tops::of(&wall, &joints, moves.then_some(floating.unwrap_or(n + 1)));
        Ok(Model {
            tops,
            wall,
            joints,
            beam,
            top_load,
            load_mass: laden.iter().sum(),
            mass,
            sides,
            elastic,
            rubs,
            bonds,
            devices,
            nonlinear,
            contacts,
            on_base,
            on_beam,
            excitation,
            reciprocal,
            stiffest,
            planar,
            warnings,
        })
    }

    /// Whether a joint has a law that is no function of the motion: friction that sticks truly, or rigid contact.
    pub fn set_valued(&self) -> bool {
        !self.contacts.is_empty() || self.sticks()
    }

    /// Index in [`Model::contacts`] of every rigid joint.
    pub fn contact_of_joint(&self) -> Vec<Option<usize>> {
        let mut index = vec![None; self.joints.len()];
        for (c, contact) in self.contacts.iter().enumerate() {
            index[contact.joint as usize] = Some(c);
        }
        index
    }

    /// Whether a joint has a set-valued friction law.
    pub fn sticks(&self) -> bool {
        self.rubs.iter().any(|r| r.law.sticks())
    }

    /// Index in [`Model::bonds`] of every bonded joint.
    pub fn bond_of_joint(&self) -> Vec<Option<usize>> {
        let mut index = vec![None; self.joints.len()];
        for (b, bond) in self.bonds.iter().enumerate() {
            index[bond.joint as usize] = Some(b);
        }
        index
    }

    /// Law of the device of every joint that has one.
    pub fn device_of_joint(&self) -> Vec<Option<DeviceLaw>> {
        let mut law = vec![None; self.joints.len()];
        for device in &self.devices {
            law[device.joint as usize] = Some(device.law);
        }
        law
    }

    /// Refuses a planar wall for `what`, which knows horizontal displacements alone.
    ///
    /// # Errors
    /// The wall is planar.
    pub fn shear_only(&self, what: &str) -> Result<()> {
        match self.planar {
            None => Ok(()),
            Some(_) => {
                Err(InputError::new(format!("{what} knows no planar walls")).key("model").allowed("shear").into())
            }
        }
    }

    /// Index in [`Model::nonlinear`] of every joint with such a device.
    pub fn nonlinear_of_joint(&self) -> Vec<Option<usize>> {
        let mut index = vec![None; self.joints.len()];
        for (k, device) in self.nonlinear.iter().enumerate() {
            index[device.joint as usize] = Some(k);
        }
        index
    }

    /// Index in [`Model::rubs`] of every joint that rubs.
    pub fn rub_of_joint(&self) -> Vec<Option<usize>> {
        let mut index = vec![None; self.joints.len()];
        for (r, rub) in self.rubs.iter().enumerate() {
            index[rub.joint as usize] = Some(r);
        }
        index
    }
    /// Name of every joint.
    pub fn joint_names(&self) -> Vec<String> {
        self.joints.iter().map(|j| graph::name(&self.wall, j)).collect()
    }
    /// When the last part of a run begins, over which residual drifts are means [s].
    pub fn settles(&self) -> f64 {
        drift::settles(self.excitation.duration, self.planar.as_ref().is_some_and(|planar| planar.still))
    }
    /// Index of the beam's unknown.
    pub fn floating_beam(&self) -> Option<usize> {
        (self.mass.len() > self.wall.blocks.len()).then_some(self.wall.blocks.len())
    }
}

/// Largest ω² = Σk/m of an unknown over its bilateral joints; where there are none, over the closed unilateral ones;
/// and no less than one swing in the run, so that a wall without stiffness has a time scale too.
pub(crate) fn stiffest(mass: &[f64], sides: &[[u32; 2]], elastic: &[Elastic], duration: f64) -> f64 {
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

fn compile_elastic(wall: &Wall, joint: &Joint, law: &JointLaw) -> Elastic {
    let (spring, nominal) = (&law.spring, law.nominal_stiffness(joint, wall));
    let upright = joint.kind.is_upright();
    let (stiffness, damping, unilateral) = match spring.law {
        SpringLaw::None => (0.0, 0.0, false),
        SpringLaw::Elastic => (nominal, law.damping_ratio, false),
        SpringLaw::NoTension => (nominal * spring.rigidity, law.damping_ratio, upright),
        // What it bears follows from the motion of its sides, not from a stiffness.
        SpringLaw::Rigid => (0.0, law.damping_ratio, false),
    };
    let reference = wall.panels[wall.blocks[joint.a].panel].reference_mass;
    Elastic {
        stiffness: joint.weight * stiffness * spring.stiffness_factor,
        damping: joint.weight * 2.0 * damping * (nominal * reference).sqrt(),
        unilateral,
    }
}

/// Says of bonded joints that bear more once they have cracked than before: μ_s N under the loads at rest is above c A + N tan φ.
fn stronger_cracked(wall: &Wall, joints: &[Joint], laws: &[JointLaw], normal: &[[f64; 2]]) -> Option<String> {
    let over = |e: usize| {
        let (bond, friction) = (laws[e].bond.as_ref()?, laws[e].rubs()?);
        let force = normal[e][0];
        let [intact, cracked] =
            [bond.cohesion * joints[e].area(wall) + force * bond.tan_angle, friction.static_ * force];
        (!joints[e].kind.is_upright() && cracked > intact * (1.0 + 1e-9)).then_some((cracked, intact, e))
    };
    let all: Vec<(f64, f64, usize)> = (0..joints.len()).filter_map(over).collect();
    let (cracked, intact, e) = all.iter().max_by(|a, b| (a.0 - a.1).total_cmp(&(b.0 - b.1)))?;
    let others = if all.len() > 1 { format!(", and {} more are like it", all.len() - 1) } else { String::new() };
    Some(format!(
        "joint {} would be stronger cracked than whole: friction bears {:.2} kN under the loads at rest (μ_s N), its bond {:.2} kN (c A + N tan φ){others}; \
         look at friction.static and friction_angle",
        graph::name(wall, &joints[*e]),
        1e-3 * cracked,
        1e-3 * intact,
    ))
}

/// Part of its strength from which on the pressure of a joint at rest is told.
const NEARLY_CRUSHED: f64 = 0.9;

/// Says of joints that their loads crush them at rest, or nearly: why the wall does not stand is asked for first.
fn crushed_at_rest(wall: &Wall, joints: &[Joint], laws: &[JointLaw], normal: &[[f64; 2]]) -> Option<String> {
    let strained = |e: usize| {
        let strength = laws[e].spring.compressive_strength?.si() * joints[e].area(wall);
        (!joints[e].kind.is_upright()).then_some((normal[e][0] / strength, e))
    };
    let all: Vec<(f64, usize)> = (0..joints.len()).filter_map(strained).filter(|s| s.0 >= NEARLY_CRUSHED).collect();
    let (part, e) = all.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let others = if all.len() > 1 { format!(", and {} more joints are like it", all.len() - 1) } else { String::new() };
    let pressure = normal[e][0] / joints[e].area(wall);
    let then = if part >= 1.0 { "the wall does not stand" } else { "hardly anything is left for the motion" };
    Some(format!(
        "joint {} is pressed by {} MPa at rest, and its compressive_strength is {} MPa: {then}{others}",
        graph::name(wall, &joints[e]),
        plausible::rounded(1e-6 * pressure, 3),
        plausible::rounded(1e-6 * pressure / part, 3),
    ))
}

/// How much thicker than its mortar a bed joint of blocks given one by one is without a word, over the height of the brick: what drawings are
/// rounded by.
const THICKER: f64 = 5e-3;

/// Says of blocks given one by one that they lie above what is under them without touching it, where the joint between them is taken for a closed one.
fn wide_joint(case: &Case, wall: &Wall, joints: &[Joint], laws: &[JointLaw]) -> Option<String> {
    let beyond = |e: usize| {
        let (joint, law) = (&joints[e], &laws[e]);
        let from = match (joint.kind, joint.b) {
            (JointKind::Bed, End::Block(b)) => wall.blocks[b].y[0] - wall.blocks[joint.a].y[1],
            (JointKind::Base, _) => wall.blocks[joint.a].y[0],
            _ => return None,
        };
        let number = wall.blocks[joint.a].panel;
        let (panel, explicit) = (&wall.panels[number], case.panels[number].bond == Bond::Explicit);
        let beyond = from - panel.mortar[0];
        let told = explicit && !law.is_open() && beyond > panel.mortar[0] + THICKER * panel.reference_height;
        told.then_some((from, panel.mortar[0], joint))
    };
    let all: Vec<(f64, f64, &Joint)> = (0..joints.len()).filter_map(beyond).collect();
    let (from, mortar, joint) = all.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let others = if all.len() > 1 { format!(", and {} more are like it", all.len() - 1) } else { String::new() };
    Some(format!(
        "joint {} is {} thick, its mortar {}{others}: it bears all the same, as if it were filled. If there is air in it, give it the law `none` \
         (joint.change); else look at `y` of the block above it",
        graph::name(wall, joint),
        Length::from_si(*from),
        Length::from_si(*mortar),
    ))
}

/// Says what becomes of a panel whose top does not reach the beam's bed joint.
fn under_beam(wall: &Wall, panel: usize) -> Option<String> {
    let (gap, info) = (graph::below_beam(wall, panel), &wall.panels[panel]);
    let consequence = if gap > graph::packing(wall, panel) {
        "more than half a brick: it carries neither the beam nor load.top"
    } else if gap > 0.5 * info.mortar[0] + 1e-6 * info.reference_height {
        "the gap is taken as packed with mortar"
    } else {
        return None;
    };
    Some(format!("panel {} ends {:.0} mm below the highest one under the beam; {consequence}", info.name, 1e3 * gap))
}

/// Part of the mass of all that is shaken which a load may lack without a word.
const LACKING: f64 = 0.05;

/// Says of a load that it has no mass, or too little, where the base moves: what it presses with is not what shakes the wall. `blocks` are the masses
/// of the blocks with what lies on them [kg].
fn massless(case: &Case, top_load: f64, blocks: &[f64]) -> Option<String> {
    let upright = case.motion.vertical != Signal::None;
    let sideways = case.motion.base != Signal::None;
    let of_blocks: f64 = blocks.iter().sum();
    let (shaken, has, remedy) = match case.load.beam {
        Beam::Free => {
            let has = case.load.mass.map_or(top_load / G, |mass| mass.si());
            (sideways || upright, has, "leave load.mass out, and the load has the mass of its weight")
        }
        Beam::Mass(mass) => (sideways || upright, mass.si(), "raise load.beam.mass"),
        Beam::Driven | Beam::Tied => {
            (upright, 0.0, "a beam that is held from side to side has none: give it a mass instead")
        }
    };
    let missing = top_load / G - has;
    let beside = if case.load.beam == Beam::Free { 0.0 } else { has };
    (shaken && missing > LACKING * (of_blocks + beside)).then(|| {
        format!(
            "load.top weighs {} kN ({} kg), but only {} kg of it move with the wall. The ground does not shake the other {} kg, so forces and \
             displacements come out too small; {remedy}",
            plausible::rounded(1e-3 * top_load, 4),
            plausible::rounded(top_load / G, 4),
            plausible::rounded(has, 4),
            plausible::rounded(missing, 4)
        )
    })
}

/// Weight of a beam over its load from which it is told: masses are given in round numbers.
const HEAVIER: f64 = 1.01;

/// `rubs` joints rub, `idle` ones have a friction law but no normal force.
fn warnings(case: &Case, wall: &Wall, rubs: usize, idle: usize, reciprocal: bool) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let mut add = |kind, text: String| warnings.push(Warning::new(kind, text));
    if idle > 0 && rubs > 0 {
        let text = format!(
            "{idle} joints have a friction law but carry no weight and do not rub (head joints, with transmitted loads)"
        );
        add(WarningKind::IdleFriction, text);
    }
    if !reciprocal {
        add(
            WarningKind::Overburden,
            "overburden loads: action and reaction of friction differ, energy is not conserved (see energy/nonreciprocal)"
                .into(),
        );
    }
    if rubs == 0 && idle > 0 {
        add(WarningKind::IdleFriction, "friction is given but no joint carries a normal force".into());
    }
    if case.load.beam != Beam::Free {
        let below = (0..wall.panels.len()).filter_map(|panel| under_beam(wall, panel));
        below.for_each(|text| add(WarningKind::BelowBeam, text));
    }
    if let Beam::Mass(m) = case.load.beam {
        let carries: Vec<bool> =
            (0..wall.panels.len()).map(|p| graph::below_beam(wall, p) <= graph::packing(wall, p)).collect();
        let under = |b: &&Block| carries[b.panel] && b.course + 1 == wall.panels[b.panel].courses;
        let length: f64 = wall.blocks.iter().filter(under).map(Block::length).sum();
        let load = case.load.top.per_length(length) * length;
        if m.si() * crate::G > HEAVIER * load {
            let text = format!(
                "the beam weighs {:.0} N but load.top brings only {load:.0} N to the wall; its weight acts through load.top alone",
                m.si() * crate::G
            );
            add(WarningKind::HeavyBeam, text);
        }
    }
    warnings
}
