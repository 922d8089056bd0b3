//! From a wall file to what its continuum needs: sizes, stiffness and strength of the joints of a panel.

use concio::assign::{self, JointLaw};
use concio::case::{Acts, Bond, Case, JointKind, ModelKind};
use concio::wall::{End, Joint, Wall};
use concio::{InputError, Result, graph, pattern};

use crate::cell::{Cell, CellCourse, Laying};
use crate::joint::{Stiffness, Strength};
use crate::running::RunningBond;

/// Relative difference of stiffnesses that are one.
const SAME: f64 = 1e-9;

/// Stiffness of head joints that part freely.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Heads {
    /// As they are when pressed.
    #[default]
    Closed,
    /// Head joints of every law bear nothing.
    Open,
}

/// A wall with the laws of its joints, as its continuum sees it.
#[derive(Debug, Clone)]
pub struct Texture {
    /// The wall as it is laid.
    pub wall: Wall,
    /// Its joints.
    pub joints: Vec<Joint>,
    /// Stiffness of every joint.
    pub stiffness: Vec<Stiffness>,
    laws: Vec<JointLaw>,
    case: Case,
}

/// The bond of a panel.
#[derive(Debug, Clone)]
pub enum Pattern {
    /// Running bond, with its cell.
    Running(RunningBond, Cell),
    /// Another bond that repeats.
    Repeated(Cell),
    /// None that repeats, and why.
    Irregular(String),
}

/// Strength of the joints of a panel; none where nothing is in them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strengths {
    /// Bed joints.
    pub bed: Option<Strength>,
    /// Head joints.
    pub head: Option<Strength>,
}

impl Texture {
    /// Of a valid case.
    ///
    /// # Errors
    /// Walls that cannot be laid; joints that are rigid, or devices; bed joints with nothing in them.
    pub fn of(case: &Case, heads: Heads) -> Result<Texture> {
        let wall = pattern::lay(case)?;
        let beam = case.load.beam != concio::case::Beam::Free;
        let joints = graph::joints(&wall, beam);
        let laws = assign::resolve(case, &wall, &joints)?;
        let stiffness = joints.iter().zip(&laws).map(|(joint, law)| match joint.kind {
            _ if joint.kind.is_upright() && heads == Heads::Open => Ok(Stiffness::open()),
            JointKind::Bed | JointKind::Head => elastic(case, &wall, joint, law),
            // They are no part of the continuum, whatever they are.
            _ => Ok(elastic(case, &wall, joint, law).unwrap_or_default()),
        });
        let stiffness = stiffness.collect::<Result<_>>()?;
        Ok(Texture { wall, joints, stiffness, laws, case: case.clone() })
    }

    /// Numbers of the joints of a panel of one kind, between its own blocks.
    fn of_kind(&self, panel: usize, kind: JointKind) -> impl Iterator<Item = usize> {
        (0..self.joints.len()).filter(move |e| {
            let joint = &self.joints[*e];
            joint.kind == kind && matches!(joint.b, End::Block(_)) && self.wall.blocks[joint.a].panel == panel
        })
    }

    /// The one stiffness of a kind of joint in a panel; none where they differ or there are none.
    fn one(&self, panel: usize, kind: JointKind) -> Option<Stiffness> {
        let mut all = self.of_kind(panel, kind).map(|e| self.stiffness[e]);
        let first = all.next()?;
        let same = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs());
        let is_first = |k: Stiffness| {
            same(k.normal, first.normal) && same(k.tangential, first.tangential) && same(k.transverse, first.transverse)
        };
        all.all(is_first).then_some(first)
    }

    /// Bed and head joints as a cell has them; a panel of one brick or course has no other joints than those of its base and none.
    fn laying(&self, panel: usize) -> Option<Laying> {
        let info = &self.wall.panels[panel];
        let has = |kind| self.of_kind(panel, kind).next().is_some();
        let bed = if has(JointKind::Bed) { self.one(panel, JointKind::Bed)? } else { return None };
        let head = if has(JointKind::Head) { self.one(panel, JointKind::Head)? } else { Stiffness::open() };
        let thickness = self.case.panels[panel].brick.thickness.si();
        Some(Laying { thickness, mortar: info.mortar, bed, head })
    }

    /// The bond of a panel; `repeated` takes courses that are listed one by one as a cell.
    ///
    /// # Errors
    /// Arches, panels without bed joints, listed courses that do not repeat.
    pub fn pattern(&self, panel: usize, repeated: bool) -> Result<Pattern> {
        let given = &self.case.panels[panel];
        let key = |name: &str| format!("panel[{panel}].{name}");
        if given.bond == Bond::Arch {
            let error = InputError::new("an arch has no courses, and no continuum").key(key("bond"));
            return Err(error.allowed("running, stack, irregular, explicit").into());
        }
        if self.of_kind(panel, JointKind::Bed).next().is_none() {
            let error = InputError::new("a panel of one course has no bed joints between bricks").key(key("courses"));
            return Err(error.allowed("two courses or more").into());
        }
        let differ = || Pattern::Irregular("its joints differ in stiffness from place to place".into());
        let brick = [given.brick.length.si(), given.brick.height.si(), given.brick.thickness.si()];
        match given.bond {
            Bond::Running => {
                let Some(laying) = self.laying(panel) else { return Ok(differ()) };
                let bond = RunningBond::new(brick, laying.mortar, laying.bed, laying.head)?;
                Ok(Pattern::Running(bond, Cell::shifted(brick[0], brick[1], 0.5, &laying)?))
            }
            Bond::Stack => {
                let Some(laying) = self.laying(panel) else { return Ok(differ()) };
                Ok(Pattern::Repeated(Cell::shifted(brick[0], brick[1], 0.0, &laying)?))
            }
            _ if repeated => {
                if given.course_list.is_empty() {
                    let error = InputError::new("only courses that are listed can be taken as a cell").key(key("bond"));
                    return Err(error.allowed("bond = \"irregular\" with [[panel.course]]").into());
                }
                let Some(laying) = self.laying(panel) else { return Ok(differ()) };
                let course = |c: &concio::case::Course| CellCourse {
                    height: c.height.si(),
                    bricks: c.bricks.iter().map(|l| l.si()).collect(),
                    offset: c.offset.si(),
                };
                let courses: Vec<CellCourse> = given.course_list.iter().map(course).collect();
                let placed = |e| if let concio::Error::Input(e) = e { (*e).key(key("course")).into() } else { e };
                Ok(Pattern::Repeated(Cell::of_courses(&courses, 0.0, &laying).map_err(placed)?))
            }
            _ => Ok(Pattern::Irregular("its bond does not repeat".into())),
        }
    }

    /// Strength of intact joints, where they have a bond; cohesion and friction as the file says. None without a bond.
    pub fn bonded(&self, panel: usize) -> Option<Strengths> {
        let of = |kind| {
            let e = self.of_kind(panel, kind).next()?;
            let law = &self.laws[e];
            if law.is_open() {
                return None;
            }
            match law.bond.filter(|b| b.tensile_strength > 0.0 || b.cohesion > 0.0) {
                Some(b) => Some(Strength {
                    cohesion: b.cohesion,
                    friction: b.tan_angle,
                    tension: b.tensile_strength,
                    compression: compression(law),
                }),
                None => self.dry_joint(e),
            }
        };
        let bonded = |kind| {
            self.of_kind(panel, kind)
                .next()
                .and_then(|e| self.laws[e].bond)
                .is_some_and(|b| b.cohesion > 0.0 || b.tensile_strength > 0.0)
        };
        let any = bonded(JointKind::Bed) || bonded(JointKind::Head);
        any.then(|| Strengths { bed: of(JointKind::Bed), head: of(JointKind::Head) })
    }

    /// Strength of cracked joints: static friction, no tension.
    pub fn dry(&self, panel: usize) -> Strengths {
        let of = |kind| self.of_kind(panel, kind).next().and_then(|e| self.dry_joint(e));
        Strengths { bed: of(JointKind::Bed), head: of(JointKind::Head) }
    }

    fn dry_joint(&self, e: usize) -> Option<Strength> {
        let law = &self.laws[e];
        let friction = law.rubs().map_or(0.0, |f| f.static_);
        (!law.is_open()).then(|| Strength { compression: compression(law), ..Strength::dry(friction) })
    }

    /// Whether some head joints part freely.
    pub fn heads_part(&self, panel: usize) -> bool {
        self.of_kind(panel, JointKind::Head).any(|e| self.laws[e].spring.law.is_no_tension())
    }

    /// The largest `rigidity` of `no-tension` joints of a panel, with its key; none where no such joint counts.
    pub fn rigidity(&self, panel: usize) -> Option<(&'static str, f64)> {
        let of = |(kind, key): (JointKind, &'static str)| {
            let joints = self.of_kind(panel, kind);
            let counts = joints.filter(|e| self.laws[*e].spring.law.is_no_tension() && self.stiffness[*e].normal > 0.0);
            counts.map(|e| self.laws[e].spring.rigidity).max_by(f64::total_cmp).map(|times| (key, times))
        };
        let kinds = [(JointKind::Bed, "joint.bed.rigidity"), (JointKind::Head, "joint.head.rigidity")];
        kinds.into_iter().filter_map(of).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Ratio k_n/k_t of the bed joints.
    pub fn bed_ratio(&self, panel: usize) -> Option<f64> {
        let k = self.one(panel, JointKind::Bed)?;
        Some(k.normal / k.tangential)
    }

    /// The model of the file.
    pub fn model(&self) -> ModelKind {
        self.case.model
    }
}

fn compression(law: &JointLaw) -> f64 {
    law.spring.compressive_strength.map_or(f64::INFINITY, |f| f.si())
}

/// Stiffness of a joint per area, as it is pressed.
fn elastic(case: &Case, wall: &Wall, joint: &Joint, law: &JointLaw) -> Result<Stiffness> {
    let name = || graph::name(wall, joint);
    let given_at = if joint.kind.is_upright() { "joint.head.law" } else { "joint.bed.law" };
    if law.device(case).is_some() {
        let error = InputError::new(format!("joint {} has a device: a continuum has none", name())).key("joint.change");
        return Err(error.allowed("joints of mortar, or dry ones").into());
    }
    let spring = &law.spring;
    let (times, pulls) = match spring.acts() {
        Acts::Rigidly => {
            let error =
                InputError::new(format!("joint {} is rigid: a wall of rigid bricks and joints has no moduli", name()));
            let allowed = if joint.kind.is_upright() {
                "elastic, no-tension, none; or --heads open"
            } else {
                "elastic, no-tension"
            };
            return Err(error.key(given_at).allowed(allowed).into());
        }
        Acts::Not if joint.kind.is_upright() => return Ok(Stiffness::open()),
        Acts::Not => {
            let error = InputError::new(format!("nothing is in joint {}: the wall has no stiffness upwards", name()));
            return Err(error.key(given_at).allowed("elastic, no-tension").into());
        }
        Acts::ByStiffness { times, pulls } => (times, pulls),
    };
    let given = law.stiffness(joint, wall) * spring.stiffness_factor / joint.area(wall);
    if !joint.kind.is_upright() && !(given > 0.0) {
        let error =
            InputError::new(format!("joint {} has no stiffness", name())).key(given_at.replace("law", "stiffness"));
        return Err(error.allowed("above 0").into());
    }
    let ratio = spring.normal_to_shear;
    let [across, along] = if joint.kind.is_upright() { [given, given / ratio] } else { [given * ratio, given] };
    // In planar walls the spring along a joint that does not pull is not multiplied.
    let along = if pulls { along * times } else { along };
    Ok(Stiffness::new(across * times, along))
}
