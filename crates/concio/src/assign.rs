//! Which law each joint gets: the common ones of its kind, then the changes of the wall file in their order.

use std::cell::OnceCell;
use std::collections::{BTreeSet, HashMap, HashSet};

use crate::G;
use crate::case::plausible::rounded;
use crate::case::{
    Beam, Case, Device, Friction, FrictionLaw, FrictionOn, FrictionPreset, JointBond, JointChange, JointKind, Joints,
    ModelKind, NormalForce, Selector, Spring, SpringLaw,
};
use crate::error::{InputError, Result};
use crate::graph;
use crate::quantity::shown;
use crate::wall::{Joint, Wall};
use concio_law::friction::Stribeck;

/// Which joints rub and where their normal force comes from, the preset taken into account.
pub(crate) fn friction_choice(friction: &Friction) -> (FrictionOn, NormalForce) {
    match friction.preset {
        Some(FrictionPreset::Report) => (FrictionOn::All, NormalForce::Overburden),
        None => (friction.on, friction.normal_force),
    }
}

/// What holds for one joint after all changes.
#[derive(Debug, Clone, Copy)]
pub struct JointLaw {
    /// The spring as the wall file says it, changes included; law `none` where a device stands. Its stiffness is to be
    /// had from [`JointLaw::stiffness`].
    pub spring: Spring,
    /// ζ, 0 … 2.
    pub damping_ratio: f64,
    friction: FrictionLaw,
    parameters: Stribeck,
    /// Whether this joint is one of those that rub, by `friction.on` or by a change of its own.
    may_rub: bool,
    /// Whether nothing is in it, in planar walls: it rubs where its sides come to touch.
    empty: bool,
    /// Its bond, if it is one of those that have one; `on` has no meaning here.
    pub bond: Option<BondValues>,
    /// Number of the change that gives it a device in place of all these.
    device: Option<u32>,
}

/// Bond of one joint as the wall file gives it, changes included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondValues {
    /// f_t in Pa.
    pub tensile_strength: f64,
    /// c in Pa.
    pub cohesion: f64,
    /// tan φ.
    pub tan_angle: f64,
    /// G_f^I of opening and G_f^II of shear [N/m]; 0 where it is brittle.
    pub energy: [f64; 2],
    /// η.
    pub residual: f64,
}

impl BondValues {
    fn of(bond: &JointBond) -> Self {
        BondValues {
            tensile_strength: bond.tensile_strength.si(),
            cohesion: bond.cohesion.si(),
            tan_angle: bond.friction_angle.si().tan(),
            energy: [bond.mode_1_energy.si(), bond.mode_2_energy.si()],
            residual: bond.residual_stiffness,
        }
    }
}

impl JointLaw {
    /// Whether there is nothing between the sides: neither mortar nor a device.
    pub fn is_open(&self) -> bool {
        self.spring.law.is_open() && self.device.is_none()
    }

    /// Stiffness of the whole joint [N/m], overlap weight or area taken into account: neither is to be multiplied to it
    /// again. Without [`Spring::rigidity`] and [`Spring::stiffness_factor`].
    pub fn stiffness(&self, joint: &Joint, wall: &Wall) -> f64 {
        joint.weight * self.nominal_stiffness(joint, wall)
    }

    /// K_H or K_V [N/m]: what times the overlap weight is the stiffness of the joint.
    pub(crate) fn nominal_stiffness(&self, joint: &Joint, wall: &Wall) -> f64 {
        self.spring.stiffness.over(joint.area(wall) / joint.weight)
    }

    /// Whether its springs have no stiffness.
    fn lacks_stiffness(&self) -> bool {
        let Spring { law, stiffness, stiffness_factor, .. } = self.spring;
        law.has_springs() && stiffness.amount() * stiffness_factor == 0.0
    }

    /// Whether it bears pressure up to a strength.
    fn crushes(&self) -> bool {
        self.spring.compressive_strength.is_some() && !self.spring.law.is_open()
    }

    /// The joint's device, if it has one.
    pub fn device<'c>(&self, case: &'c Case) -> Option<&'c Device> {
        case.joint.changes.get(self.device? as usize)?.device.as_ref()
    }

    /// The friction law, if the joint has one and is among those that rub: law `stribeck-stick` has an infinite β, law
    /// `coulomb` a slip velocity of 0 too.
    pub fn rubs(&self) -> Option<Stribeck> {
        if self.empty { None } else { self.touching() }
    }

    /// The same of a joint in which there is nothing, once its sides have come to touch.
    pub fn touching(&self) -> Option<Stribeck> {
        let law = self.parameters;
        match self.friction {
            _ if !self.may_rub || self.device.is_some() => None,
            FrictionLaw::None => None,
            FrictionLaw::Stribeck => Some(law),
            FrictionLaw::StribeckStick => Some(Stribeck { beta: f64::INFINITY, ..law }),
            FrictionLaw::Coulomb => Some(Stribeck { beta: f64::INFINITY, slip_velocity: 0.0, ..law }),
        }
    }
}

/// The law of every joint of `wall`, in the order of `joints`.
///
/// # Errors
/// Selectors that name nothing or meet no joint, laws that make no sense for a kind of joint.
pub fn resolve(case: &Case, wall: &Wall, joints: &[Joint]) -> Result<Vec<JointLaw>> {
    let settings = &case.joint;
    for (kind, key, spring) in [
        (JointKind::Bed, "bed", Some(settings.bed)),
        (JointKind::Base, "base", settings.base),
        (JointKind::Top, "top", settings.top),
    ] {
        let law = spring.map_or(SpringLaw::Elastic, |s| s.law);
        check_spring(case.model, kind, law).map_err(|e| e.key(format!("joint.{key}.law")))?;
    }
    let mut laws: Vec<JointLaw> = joints.iter().map(|j| common_law(settings, j.kind)).collect();
    looks(settings, joints.len())?;
    let choice = Choice { wall, joints, names: OnceCell::new() };
    for (number, change) in settings.changes.iter().enumerate() {
        let chosen = choice.of(&change.at).map_err(|e| e.key(format!("joint.change[{number}].at")))?;
        let rocks = change.spring.is_some_and(|c| c.rocking_restitution.is_some());
        let rigid = |e: &usize| match change.spring.and_then(|c| c.law) {
            Some(law) => law.is_rigid(),
            None => laws[*e].spring.law.is_rigid(),
        };
        if rocks && !chosen.iter().any(rigid) {
            let error = InputError::new("none of the joints that this changes is `rigid`");
            let key = format!("joint.change[{number}].spring.rocking_restitution");
            return Err(error.key(key).allowed("law = \"rigid\", or no `rocking_restitution`").into());
        }
        for e in chosen {
            let law = &mut laws[e];
            if let Some(c) = &change.spring {
                law.spring.law = c.law.unwrap_or(law.spring.law);
                law.spring.stiffness = c.stiffness.unwrap_or(law.spring.stiffness);
                law.spring.rigidity = c.rigidity.unwrap_or(law.spring.rigidity);
                law.spring.restitution = c.restitution.or(law.spring.restitution);
                law.spring.rocking_restitution = c.rocking_restitution.or(law.spring.rocking_restitution);
                law.spring.stiffness_factor = c.stiffness_factor.unwrap_or(law.spring.stiffness_factor);
                law.damping_ratio = c.damping_ratio.unwrap_or(law.damping_ratio);
                law.spring.normal_to_shear = c.normal_to_shear.unwrap_or(law.spring.normal_to_shear);
                law.spring.compressive_strength = c.compressive_strength.or(law.spring.compressive_strength);
            }
            if let Some(c) = &change.friction {
                law.friction = c.law.unwrap_or(law.friction);
                // Joints that `on` leaves out rub where a change names them or their kind, not where it meets them among others.
                law.may_rub |= c.law.is_some() || !change.at.kind.is_empty() || !change.at.joints.is_empty();
                let p = &mut law.parameters;
                p.static_ = c.static_.unwrap_or(p.static_);
                p.dynamic = c.dynamic.unwrap_or(p.dynamic);
                p.slip_velocity = c.slip_velocity.map_or(p.slip_velocity, |v| v.si());
                p.beta = c.beta.unwrap_or(p.beta);
                p.alpha = c.alpha.unwrap_or(p.alpha);
            }
            if let Some(c) = &change.bond {
                let b = law.bond.get_or_insert(BondValues::of(&JointBond::default()));
                b.tensile_strength = c.tensile_strength.map_or(b.tensile_strength, |v| v.si());
                b.cohesion = c.cohesion.map_or(b.cohesion, |v| v.si());
                b.tan_angle = c.friction_angle.map_or(b.tan_angle, |v| v.si().tan());
                b.energy[0] = c.mode_1_energy.map_or(b.energy[0], |v| v.si());
                b.energy[1] = c.mode_2_energy.map_or(b.energy[1], |v| v.si());
                b.residual = c.residual_stiffness.unwrap_or(b.residual);
            }
            if change.device.is_some() {
                law.device = Some(number as u32);
            }
            check_spring(case.model, joints[e].kind, law.spring.law)
                .map_err(|e| e.key(format!("joint.change[{number}].spring.law")))?;
        }
    }
    for law in laws.iter_mut().filter(|law| law.device.is_some()) {
        (law.bond, law.spring.law) = (None, SpringLaw::None);
    }
    if case.model == ModelKind::Planar {
        for law in laws.iter_mut().filter(|law| law.is_open()) {
            (law.bond, law.empty) = (None, true);
        }
        bears(case, wall, joints, &laws)?;
    }
    Ok(laws)
}

/// Refuses joints of planar walls that bear no pressure, or that would bear it in a way that no joint does.
fn bears(case: &Case, wall: &Wall, joints: &[Joint], laws: &[JointLaw]) -> Result<()> {
    type Fault = fn(&JointLaw) -> bool;
    let faults: [(Fault, &str, &str); 3] = [
        (
            JointLaw::lacks_stiffness,
            "a joint without stiffness would let the blocks of a planar wall pass through each other",
            "`stiffness` and `stiffness_factor` above 0; `law = \"none\"` where there is nothing between them",
        ),
        (
            |law| law.crushes() && law.spring.law.is_elastic() && law.strong_bond().is_none(),
            "a joint of law `elastic` without a bond pulls without limit, and cannot crush",
            "`law = \"no-tension\"`, a `bond`, or no `compressive_strength`",
        ),
        (
            |law| law.crushes() && (law.spring.restitution.is_some() || law.spring.rocking_restitution.is_some()),
            "a joint that can crush gives back what its springs store, not a part of its velocity",
            "`compressive_strength` without `restitution` and `rocking_restitution`, or those alone",
        ),
    ];
    for (has, message, allowed) in faults {
        let Some(e) = laws.iter().position(|law| law.device.is_none() && has(law)) else { continue };
        let choice = Choice { wall, joints, names: OnceCell::new() };
        let changes = |change: &JointChange| {
            change.spring.is_some() && choice.of(&change.at).is_ok_and(|chosen| chosen.contains(&e))
        };
        let key = match case.joint.changes.iter().rposition(changes) {
            Some(number) => format!("joint.change[{number}].spring"),
            None => format!("joint.{}", given_at(&case.joint, joints[e].kind)),
        };
        return Err(InputError::new(message).key(key).allowed(allowed).into());
    }
    Ok(())
}

/// The table of `[joint]` that a kind of joint takes its spring from.
fn given_at(settings: &Joints, kind: JointKind) -> &'static str {
    match kind {
        JointKind::Base if settings.base.is_some() => "base",
        JointKind::Top if settings.top.is_some() => "top",
        JointKind::Connection if settings.connection.is_some() => "connection",
        JointKind::Bed | JointKind::Base | JointKind::Top => "bed",
        JointKind::Head | JointKind::Connection => "head",
    }
}

/// Joints that may be looked at for all changes together: some seconds.
const MOST_LOOKS: usize = 1_000_000_000;

/// A change that names no joints looks at all of them.
fn looks(settings: &Joints, joints: usize) -> Result<()> {
    let changes = settings.changes.iter().filter(|change| change.at.joints.is_empty()).count();
    if changes.saturating_mul(joints) <= MOST_LOOKS {
        return Ok(());
    }
    let what = format!("{changes} changes that choose among {joints} joints are too many");
    let allowed =
        format!("up to {} of them in this wall; those that name their joints do not count", MOST_LOOKS / joints);
    Err(InputError::new(what).key("joint.change").allowed(allowed).into())
}

/// Bed and support joints of shear walls slide both ways and do nothing else: a law for one direction has no meaning
/// there.
fn check_spring(model: ModelKind, kind: JointKind, law: SpringLaw) -> std::result::Result<(), InputError> {
    if kind.is_upright() || model == ModelKind::Planar || !law.parts() {
        return Ok(());
    }
    let name = if law.is_rigid() { "rigid" } else { "no-tension" };
    let what = format!("law `{name}` is for head joints and connections; this joint slides in both directions");
    Err(InputError::new(what).allowed("elastic, none; with `model = \"planar\"` every law"))
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
        bond: settings.bond.as_ref().filter(|b| b.on.contains(&kind)).map(BondValues::of),
        device: None,
        empty: false,
    }
}

/// Indices of the joints for which all conditions hold.
///
/// # Errors
/// A name that no joint or panel bears, or conditions that hold for no joint.
pub fn select(at: &Selector, wall: &Wall, joints: &[Joint]) -> std::result::Result<Vec<usize>, InputError> {
    Choice { wall, joints, names: OnceCell::new() }.of(at)
}

/// Size of the wall beyond which a corner of a region that chooses nothing is in another unit.
const FAR: f64 = 5.0;

/// Says of regions that hold all joints that the other conditions choose: a corner in another unit, as a rule. Of walls whose changes are all resolved.
pub(crate) fn idle_regions(case: &Case, wall: &Wall, joints: &[Joint]) -> Vec<String> {
    let choice = Choice { wall, joints, names: OnceCell::new() };
    let number = |at: &Selector| choice.of(at).map_or(0, |chosen| chosen.len());
    let [right, top] = wall.blocks.iter().fold([0.0f64; 2], |[x, y], b| [x.max(b.x[1]), y.max(b.y[1])]);
    let told = |(i, change): (usize, &JointChange)| {
        let region = change.at.region?;
        let (inside, all) = (number(&change.at), number(&Selector { region: None, ..change.at.clone() }));
        let far = FAR * right.max(top);
        (inside == all && all > 1 && region.iter().any(|corner| corner.si().abs() > far)).then(|| {
            let [x0, y0, x1, y1] = region.map(|corner| shown(rounded(corner.si(), 6)));
            format!(
                "joint.change[{i}].at.region, from {x0}, {y0} to {x1}, {y1} m, holds all {all} joints that the rest of `at` chooses, in a wall up to x = {} m, y = {} m: it leaves \
                 none out. Bare numbers are in m; leave `region` out if all are meant",
                shown(rounded(right, 4)),
                shown(rounded(top, 4))
            )
        })
    };
    case.joint.changes.iter().enumerate().filter_map(told).collect()
}

/// Joints to choose from, with their names once somebody asks for one: a wall may have thousands of changes.
struct Choice<'w> {
    wall: &'w Wall,
    joints: &'w [Joint],
    names: OnceCell<HashMap<String, usize>>,
}

impl Choice<'_> {
    /// As [`select`].
    fn of(&self, at: &Selector) -> std::result::Result<Vec<usize>, InputError> {
        let listed = if at.joints.is_empty() { None } else { Some(self.listed(&at.joints)?) };
        let panels = self.panels(&at.panel)?;
        let courses: HashSet<usize> = at.course.iter().copied().collect();
        let holds = |e: &usize| {
            let joint = &self.joints[*e];
            let middle = [0.5 * (joint.line[0] + joint.line[2]), 0.5 * (joint.line[1] + joint.line[3])];
            (at.kind.is_empty() || at.kind.contains(&joint.kind))
                && (panels.is_empty() || panels.contains(&self.wall.blocks[joint.a].panel))
                && (courses.is_empty() || courses.contains(&joint.course(self.wall)))
                && at.region.is_none_or(|[x0, y0, x1, y1]| {
                    (x0.si()..=x1.si()).contains(&middle[0]) && (y0.si()..=y1.si()).contains(&middle[1])
                })
        };
        let chosen: Vec<usize> = match listed {
            Some(set) => set.into_iter().filter(holds).collect(),
            None => (0..self.joints.len()).filter(holds).collect(),
        };
        if chosen.is_empty() {
            return Err(InputError::new("no joint meets these conditions")
                .allowed("conditions that hold together for at least one joint; `concio check` lists all joints"));
        }
        Ok(chosen)
    }

    fn listed(&self, wanted: &[String]) -> std::result::Result<BTreeSet<usize>, InputError> {
        let named = || self.joints.iter().enumerate().map(|(e, j)| (graph::name(self.wall, j), e)).collect();
        let names = self.names.get_or_init(named);
        let mut set = BTreeSet::new();
        for name in wanted {
            let e = names.get(name).ok_or_else(|| {
                let error = InputError::new(format!("no joint is named `{name}`"));
                match name.split_once('|').map(|(a, b)| format!("{b}|{a}")).filter(|turned| names.contains_key(turned))
                {
                    Some(turned) => error.allowed(format!("the same blocks the other way round: `{turned}`")),
                    None => error.allowed(
                        "names as `concio check` lists and draws them, for example base|p1c1b1 or p1c1b1|p1c2b1",
                    ),
                }
            })?;
            if !set.insert(*e) {
                return Err(InputError::new(format!("joint `{name}` is listed twice")).allowed("each joint once"));
            }
        }
        Ok(set)
    }

    /// Panels by their names.
    fn panels(&self, wanted: &[String]) -> std::result::Result<HashSet<usize>, InputError> {
        let place = |name: &String| {
            let found = self.wall.panels.iter().position(|p| p.name == *name);
            found.ok_or_else(|| {
                let all = self.wall.panels.iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", ");
                InputError::new(format!("no panel is named `{name}`")).allowed(all)
            })
        };
        wanted.iter().map(place).collect()
    }
}

impl JointLaw {
    /// Its bond; strengths of 0 are none.
    pub(crate) fn strong_bond(&self) -> Option<&BondValues> {
        self.bond.as_ref().filter(|b| b.tensile_strength > 0.0 || b.cohesion > 0.0 || b.tan_angle > 0.0)
    }
}

/// Mass of what bears down on each block of a wall without a beam [kg]: in proportion to the load on it.
pub fn load_masses(case: &Case, wall: &Wall) -> Vec<f64> {
    if case.load.beam != Beam::Free {
        return vec![0.0; wall.blocks.len()];
    }
    let lengths = wall.loaded();
    let whole: f64 = lengths.iter().sum();
    let per_length = case.load.mass.map_or(case.load.top.per_length(whole) / G, |mass| mass.si() / whole);
    lengths.into_iter().map(|length| per_length * length).collect()
}
