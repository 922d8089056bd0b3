//! The compiled system: immutable arrays that the time loop reads. One horizontal unknown per block, and one for
//! a top beam with mass (theory, sections 2 and 3).

use std::collections::{BTreeSet, HashMap};

use crate::case::{
    Beam, Case, Friction, FrictionLaw, FrictionOn, FrictionPreset, JointKind, Joints, NormalForce, Selector, Spring,
    SpringLaw,
};
use crate::error::{InputError, Result};
use crate::excitation::Excitation;
use crate::graph;
use crate::law::Stribeck;
use crate::wall::{Block, End, Joint, Wall};

/// Everything a run needs and nothing it changes.
#[derive(Debug, Clone)]
pub struct Model {
    /// The blocks.
    pub wall: Wall,
    /// The joints, in the order of the arrays below.
    pub joints: Vec<Joint>,
    /// What the top beam does.
    pub beam: Beam,
    /// Mass of every unknown [kg]: blocks, then the beam if it has mass.
    pub mass: Vec<f64>,
    /// Both sides of each joint as indices of unknowns; [`Model::base`] and [`Model::top`] stand for the supports.
    pub sides: Vec<[u32; 2]>,
    /// Elastic part of each joint.
    pub elastic: Vec<Elastic>,
    /// Frictional part of the joints that rub.
    pub rubs: Vec<Rub>,
    /// Motion of base and top, and the end of the run.
    pub excitation: Excitation,
    /// True when every joint's normal force is the same on both sides: the stage matrices are symmetric then.
    pub reciprocal: bool,
    /// Largest ω² = Σk/m of a block over its bilateral joints [1/s²], never 0: the time scale of the first step and
    /// of the floor of the velocities.
    pub stiffest: f64,
    /// Things a user should know before believing the result.
    pub warnings: Vec<String>,
}

/// Elastic and viscous part of a joint, (2)–(4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// w K_H, or κ K_V for a no-tension joint [N/m].
    pub stiffness: f64,
    /// w C [N s/m].
    pub damping: f64,
    /// The stiffness acts in compression only.
    pub unilateral: bool,
}

/// Frictional part of a joint, (5).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rub {
    /// Index of the joint.
    pub joint: u32,
    /// Normal force in the equation of each side [N].
    pub normal: [f64; 2],
    /// μ(v).
    pub law: Stribeck,
}

impl Model {
    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.mass.len()
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
    /// Blocks that rest on nothing, selectors that name no joint, laws of a later version.
    pub fn compile(case: &Case, wall: Wall, excitation: Excitation) -> Result<Model> {
        let beam = case.load.beam;
        let has_beam = !matches!(beam, Beam::Free);
        let joints = graph::joints(&wall, has_beam);
        let laws = resolve(case, &wall, &joints)?;
        let (_, from) = friction_choice(&case.joint.friction);
        let normal = graph::normal_forces(&wall, &joints, case.load.top.si(), has_beam, from);
        let mut mass: Vec<f64> = wall.blocks.iter().map(|b| b.mass()).collect();
        let floating = if let Beam::Mass(m) = beam {
            mass.push(m.si());
            Some(mass.len() - 1)
        } else {
            None
        };
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
        let elastic: Vec<Elastic> =
            joints.iter().zip(&laws).map(|(joint, law)| compile_elastic(&wall, joint, law)).collect();
        let rub = |(e, (law, &normal)): (usize, (&JointLaw, &[f64; 2]))| {
            let loaded = normal[0] > 0.0 || normal[1] > 0.0;
            law.rubs().filter(|_| loaded).map(|law| Rub { joint: e as u32, normal, law })
        };
        let rubs: Vec<Rub> = laws.iter().zip(&normal).enumerate().filter_map(rub).collect();
        let reciprocal = rubs.iter().all(|r| sides[r.joint as usize][1] as usize >= n || r.normal[0] == r.normal[1]);
        let stiffest = stiffest(&mass, &sides, &elastic, excitation.duration);
        let idle = laws.iter().zip(&normal).filter(|(law, n)| law.rubs().is_some() && n[0] == 0.0).count();
        let warnings = warnings(case, &wall, rubs.len(), idle, reciprocal);
        Ok(Model { wall, joints, beam, mass, sides, elastic, rubs, excitation, reciprocal, stiffest, warnings })
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
    /// Index of the beam's unknown.
    pub fn floating_beam(&self) -> Option<usize> {
        (self.mass.len() > self.wall.blocks.len()).then_some(self.wall.blocks.len())
    }
}

/// Which joints rub and where their normal force comes from, the preset taken into account.
fn friction_choice(friction: &Friction) -> (FrictionOn, NormalForce) {
    match friction.preset {
        Some(FrictionPreset::Report) => (FrictionOn::All, NormalForce::Overburden),
        None => (friction.on, friction.normal_force),
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
    let spring = &law.spring;
    let upright = matches!(joint.kind, JointKind::Head | JointKind::Connection);
    let (stiffness, damping, unilateral) = match spring.law {
        SpringLaw::None => (0.0, 0.0, false),
        SpringLaw::Elastic => (spring.stiffness.si(), law.damping_ratio, false),
        SpringLaw::NoTension | SpringLaw::Rigid => {
            (spring.stiffness.si() * spring.rigidity, law.damping_ratio, upright)
        }
    };
    let reference = wall.panels[wall.blocks[joint.a].panel].reference_mass;
    Elastic {
        stiffness: joint.weight * stiffness * spring.stiffness_factor,
        damping: joint.weight * 2.0 * damping * (spring.stiffness.si() * reference).sqrt(),
        unilateral,
    }
}

/// What holds for one joint after all changes.
#[derive(Debug, Clone, Copy)]
struct JointLaw {
    spring: Spring,
    damping_ratio: f64,
    friction: FrictionLaw,
    parameters: Stribeck,
    /// Whether this joint is one of those that rub, by `friction.on` or by a change of its own.
    may_rub: bool,
}

impl JointLaw {
    fn rubs(&self) -> Option<Stribeck> {
        (self.may_rub && self.friction != FrictionLaw::None).then_some(self.parameters)
    }
}

fn resolve(case: &Case, wall: &Wall, joints: &[Joint]) -> Result<Vec<JointLaw>> {
    let settings = &case.joint;
    for (kind, key, spring) in [
        (JointKind::Bed, "bed", Some(settings.bed)),
        (JointKind::Base, "base", settings.base),
        (JointKind::Top, "top", settings.top),
    ] {
        let law = spring.map_or(SpringLaw::Elastic, |s| s.law);
        check_spring(kind, law).map_err(|e| e.key(format!("joint.{key}.law")))?;
    }
    let mut laws: Vec<JointLaw> = joints.iter().map(|j| common_law(settings, j.kind)).collect();
    for (number, change) in settings.changes.iter().enumerate() {
        let chosen = select(&change.at, wall, joints).map_err(|e| e.key(format!("joint.change[{number}].at")))?;
        for e in chosen {
            let law = &mut laws[e];
            if let Some(c) = &change.spring {
                law.spring.law = c.law.unwrap_or(law.spring.law);
                law.spring.stiffness = c.stiffness.unwrap_or(law.spring.stiffness);
                law.spring.rigidity = c.rigidity.unwrap_or(law.spring.rigidity);
                law.spring.stiffness_factor = c.stiffness_factor.unwrap_or(law.spring.stiffness_factor);
                law.damping_ratio = c.damping_ratio.unwrap_or(law.damping_ratio);
            }
            if let Some(c) = &change.friction {
                law.friction = c.law.unwrap_or(law.friction);
                law.may_rub = true;
                let p = &mut law.parameters;
                p.static_ = c.static_.unwrap_or(p.static_);
                p.dynamic = c.dynamic.unwrap_or(p.dynamic);
                p.slip_velocity = c.slip_velocity.map_or(p.slip_velocity, |v| v.si());
                p.beta = c.beta.unwrap_or(p.beta);
                p.alpha = c.alpha.unwrap_or(p.alpha);
            }
            check_spring(joints[e].kind, law.spring.law)
                .map_err(|e| e.key(format!("joint.change[{number}].spring.law")))?;
        }
    }
    Ok(laws)
}

/// Bed and support joints slide both ways: a law for one direction has no meaning there.
fn check_spring(kind: JointKind, law: SpringLaw) -> std::result::Result<(), InputError> {
    let upright = matches!(kind, JointKind::Head | JointKind::Connection);
    if law == SpringLaw::NoTension && !upright {
        let what = "law `no-tension` is for head joints and connections; this joint slides in both directions";
        return Err(InputError::new(what).allowed("elastic, none"));
    }
    Ok(())
}

fn common_law(settings: &Joints, kind: JointKind) -> JointLaw {
    let spring = match kind {
        JointKind::Bed => settings.bed,
        JointKind::Head => settings.head,
        JointKind::Base => settings.base.unwrap_or(settings.bed),
        JointKind::Top => settings.top.unwrap_or(settings.bed),
        JointKind::Connection => settings.connection.unwrap_or(settings.head),
    };
    let f = &settings.friction;
    let parameters = Stribeck {
        static_: f.static_,
        dynamic: f.dynamic,
        slip_velocity: f.slip_velocity.si(),
        beta: f.beta,
        alpha: f.alpha,
    };
    JointLaw {
        spring,
        damping_ratio: spring.damping_ratio.unwrap_or(settings.damping_ratio),
        friction: f.law,
        parameters,
        may_rub: friction_choice(f).0 == FrictionOn::All
            || matches!(kind, JointKind::Bed | JointKind::Base | JointKind::Top),
    }
}

/// Indices of the joints for which all conditions hold.
///
/// # Errors
/// A name that no joint or panel bears, or conditions that hold for no joint.
pub fn select(at: &Selector, wall: &Wall, joints: &[Joint]) -> std::result::Result<Vec<usize>, InputError> {
    let mut listed = None;
    if !at.joints.is_empty() {
        let names: HashMap<String, usize> = joints.iter().enumerate().map(|(e, j)| (graph::name(wall, j), e)).collect();
        let mut set = BTreeSet::new();
        for name in &at.joints {
            let e = names.get(name).ok_or_else(|| {
                InputError::new(format!("no joint is named `{name}`"))
                    .allowed("names as `concio check` lists and draws them, for example base|p1c1b1 or p1c1b1|p1c2b1")
            })?;
            if !set.insert(*e) {
                return Err(InputError::new(format!("joint `{name}` is listed twice")).allowed("each joint once"));
            }
        }
        listed = Some(set);
    }
    for name in &at.panel {
        if !wall.panels.iter().any(|p| p.name == *name) {
            let all = wall.panels.iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", ");
            return Err(InputError::new(format!("no panel is named `{name}`")).allowed(all));
        }
    }
    let holds = |joint: &Joint| {
        let block = &wall.blocks[joint.a];
        let course = match (joint.kind, joint.b) {
            (JointKind::Bed, End::Block(upper)) => wall.blocks[upper].course + 1,
            (JointKind::Top, _) => block.course + 2,
            _ => block.course + 1,
        };
        let middle = [0.5 * (joint.line[0] + joint.line[2]), 0.5 * (joint.line[1] + joint.line[3])];
        (at.kind.is_empty() || at.kind.contains(&joint.kind))
            && (at.panel.is_empty() || at.panel.contains(&wall.panels[block.panel].name))
            && (at.course.is_empty() || at.course.contains(&course))
            && at.region.is_none_or(|[x0, y0, x1, y1]| {
                (x0.si()..=x1.si()).contains(&middle[0]) && (y0.si()..=y1.si()).contains(&middle[1])
            })
    };
    let chosen: Vec<usize> = match listed {
        Some(set) => set.into_iter().filter(|&e| holds(&joints[e])).collect(),
        None => (0..joints.len()).filter(|&e| holds(&joints[e])).collect(),
    };
    if chosen.is_empty() {
        return Err(InputError::new("no joint meets these conditions")
            .allowed("conditions that hold together for at least one joint; `concio check` lists all joints"));
    }
    Ok(chosen)
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

/// `rubs` joints rub, `idle` ones have a friction law but no normal force.
fn warnings(case: &Case, wall: &Wall, rubs: usize, idle: usize, reciprocal: bool) -> Vec<String> {
    let mut warnings = Vec::new();
    if idle > 0 && rubs > 0 {
        warnings.push(format!(
            "{idle} joints have a friction law but carry no weight and do not rub (head joints, with transmitted loads)"
        ));
    }
    if !reciprocal {
        warnings.push(
            "overburden loads: action and reaction of friction differ, energy is not conserved (see energy/nonreciprocal)"
                .into(),
        );
    }
    if rubs == 0 && idle > 0 {
        warnings.push("friction is given but no joint carries a normal force".into());
    }
    if case.load.beam != Beam::Free {
        warnings.extend((0..wall.panels.len()).filter_map(|panel| under_beam(wall, panel)));
    }
    if let Beam::Mass(m) = case.load.beam {
        let carries: Vec<bool> =
            (0..wall.panels.len()).map(|p| graph::below_beam(wall, p) <= graph::packing(wall, p)).collect();
        let under = |b: &&Block| carries[b.panel] && b.course + 1 == wall.panels[b.panel].courses;
        let length: f64 = wall.blocks.iter().filter(under).map(Block::length).sum();
        let load = case.load.top.si() * length;
        if m.si() * crate::G > 1.001 * load {
            warnings.push(format!(
                "the beam weighs {:.0} N but load.top brings only {load:.0} N to the wall; its weight acts through load.top alone",
                m.si() * crate::G
            ));
        }
    }
    warnings
}
