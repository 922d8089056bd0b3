//! The compiled wall: its blocks and joints, what moves it, and the mechanics of the model that its file names.

use concio_planar::joint::Normal;
use concio_shear::law::{Contact, Elastic, Rub};
use concio_shear::system as shear;

use crate::G;
use crate::assign::{self, JointLaw, friction_choice, load_masses, resolve};
use crate::bond;
use crate::case::{Acts, Beam, Bond, Case, DeviceLaw, JointKind, ModelKind, SpringLaw, TopLoad, plausible};
use crate::device::{self, Device};
use crate::drift;
use crate::error::{InputError, Result};
use crate::excitation::Excitation;
use crate::graph;
use crate::ground::signal::GroundMotion;
use crate::planar::{self, Planar};
use crate::quantity::Length;
use crate::rocking::{self, Rocking};
use crate::wall::{Block, End, Joint, Wall};
use crate::warning::{Warning, WarningKind};

/// Everything a run needs and nothing it changes.
#[derive(Debug, Clone)]
pub struct Model {
    /// The blocks.
    pub wall: Wall,
    /// The joints.
    pub joints: Vec<Joint>,
    /// What the top beam does.
    pub beam: Beam,
    /// What `load.top` brings to the wall, the weight of a beam with it [N].
    pub top_load: f64,
    /// Mass of that load on the blocks of a wall without a beam, which is in the masses of `shear` too [kg].
    pub load_mass: f64,
    /// The joints with a device in place of mortar, in the order of the joints.
    pub devices: Vec<Device>,
    /// Motion of base and top, and the end of the run.
    pub excitation: Excitation,
    /// Masses and joints as the shear model has them, which results of all models list.
    pub shear: shear::System,
    /// What moves, by the model that the wall file names.
    pub system: System,
    /// Things a user should know before believing the result.
    pub warnings: Vec<Warning>,
}

/// The mechanics of a wall.
#[derive(Debug, Clone)]
pub enum System {
    /// Blocks that slide in level planes: [`Model::shear`].
    Shear,
    /// Blocks that rise and turn too.
    Planar(Box<Planar>),
    /// A mechanism that turns out of the plane.
    Rocking(Box<Rocking>),
}

impl Model {
    /// What a planar wall is; none of the shear model.
    pub fn planar(&self) -> Option<&Planar> {
        if let System::Planar(planar) = &self.system { Some(planar) } else { None }
    }
    /// What a rocking wall is; none of other models.
    pub fn rocking(&self) -> Option<&Rocking> {
        if let System::Rocking(rocking) = &self.system { Some(rocking) } else { None }
    }
    /// Whether its blocks rise and turn.
    pub fn turns(&self) -> bool {
        !matches!(self.system, System::Shear)
    }
    /// Number of bodies.
    pub fn unknowns(&self) -> usize {
        self.shear.unknowns()
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
    /// Compiles a wall, its laws and its motion.
    ///
    /// # Errors
    /// Blocks that rest on nothing, selectors that name no joint, laws of a later version, bonds that would snap back.
    pub fn compile(case: &Case, wall: Wall, excitation: Excitation) -> Result<Model> {
        if case.model == ModelKind::Rocking {
            return Ok(Model::of_rocking(rocking::compile(case, &excitation)?, excitation));
        }
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
        // A tied beam stays where the base is.
        let moves = matches!(beam, Beam::Driven | Beam::Mass(_));
        let tops = drift::tops(&wall, &joints, moves.then_some(floating.unwrap_or(n + 1)));
        let settles = drift::settles(excitation.duration, turns && case.motion.quasi_static);
        let rigid = |(e, law): (usize, &JointLaw)| {
            let spring = &law.spring;
            spring.law.is_rigid().then_some(Contact { joint: e as u32, restitution: spring.restitution.unwrap_or(0.0) })
        };
        let shear = shear::System {
            blocks: wall.blocks.len(),
            mass,
            sides,
            upright: joints.iter().map(|joint| joint.kind.is_upright()).collect(),
            elastic,
            rubs,
            bonds,
            nonlinear,
            contacts: laws.iter().enumerate().filter_map(rigid).collect(),
            centres: wall.blocks.iter().map(|b| [0.5 * (b.x[0] + b.x[1]), 0.5 * (b.y[0] + b.y[1])]).collect(),
            tops,
            settles,
            ..shear::System::default()
        }
        .completed(excitation.duration);
        let idle = laws.iter().zip(&normal).filter(|(law, n)| law.rubs().is_some() && n[0] == 0.0).count();
        let mut warnings = warnings(case, &wall, shear.rubs.len(), if turns { 0 } else { idle }, shear.reciprocal);
        let massless = massless(case, &excitation, top_load, &shear.mass[..wall.blocks.len()]);
        warnings.extend(massless.map(|text| Warning::new(WarningKind::MasslessLoad, text)));
        let stronger = stronger_cracked(&wall, &joints, &laws, &normal);
        warnings.extend(stronger.map(|text| Warning::new(WarningKind::UnlikelyJoint, text)));
        let crushed = crushed_at_rest(&wall, &joints, &laws, &normal).filter(|_| turns);
        warnings.extend(crushed.map(|text| Warning::new(WarningKind::UnlikelyJoint, text)));
        let wide = wide_joint(case, &wall, &joints, &laws);
        warnings.extend(wide.map(|text| Warning::new(WarningKind::UnlikelyJoint, text)));
        let slides = kept_by_sliding(&wall, &joints, &laws).filter(|_| turns);
        warnings.extend(slides.map(|text| Warning::new(WarningKind::UnlikelyJoint, text)));
        let detached = planar::detached(case, &wall).into_iter();
        warnings.extend(detached.map(|text| Warning::new(WarningKind::DetachedTie, text)));
        let idle = assign::idle_regions(case, &wall, &joints).into_iter();
        warnings.extend(idle.map(|text| Warning::new(WarningKind::IdleKey, text)));
        let weight = wall.blocks.iter().map(Block::weight).sum::<f64>() + top_load;
        let feeble = planar::unlikely_ties(case, &wall, weight).into_iter();
        warnings.extend(feeble.map(|text| Warning::new(WarningKind::UnlikelyNumber, text)));
        let system = match turns {
            true => System::Planar(Box::new(planar::compile(case, &wall, &joints, &laws, &normal)?)),
            false => System::Shear,
        };
        let load_mass = laden.iter().sum();
        Ok(Model { wall, joints, beam, top_load, load_mass, devices, excitation, shear, system, warnings })
    }

    /// Of a wall that rocks: its floors are the load on top.
    fn of_rocking(compiled: rocking::Compiled, excitation: Excitation) -> Model {
        let rocking::Compiled { rocking, wall, joints, shear, duration, warnings } = compiled;
        let floors = &rocking.mechanism.floors;
        let [load, pushing] = floors.iter().fold([0.0; 2], |sum, floor| [sum[0] + floor.load, sum[1] + floor.pushes]);
        Model {
            wall,
            joints,
            beam: Beam::Free,
            top_load: load,
            load_mass: pushing / G,
            devices: Vec::new(),
            excitation: Excitation { duration, ..excitation },
            shear,
            system: System::Rocking(Box::new(rocking)),
            warnings,
        }
    }

    /// How a joint resists as compiled, be it `rigid` or not: bond, device and factors included.
    pub fn acting_law(&self, joint: usize, rigid: bool) -> SpringLaw {
        let law = &self.shear.elastic[joint];
        // Bed joints bear no tension in planar walls alone.
        let planar = self.planar().map(|planar| planar.system.links[joint].law.normal);
        let presses = matches!(planar, Some(Normal::Springs { both: 0.0, press, .. }) if press > 0.0);
        match law {
            _ if rigid => SpringLaw::Rigid,
            l if l.unilateral || presses => SpringLaw::NoTension,
            l if l.stiffness == 0.0 && l.damping == 0.0 => SpringLaw::None,
            _ => SpringLaw::Elastic,
        }
    }

    /// Law of the device of every joint that has one.
    pub fn device_of_joint(&self) -> Vec<Option<DeviceLaw>> {
        let mut law = vec![None; self.joints.len()];
        for device in &self.devices {
            law[device.joint as usize] = Some(device.law);
        }
        law
    }

    /// Refuses a planar or rocking wall for `what`, which knows horizontal displacements alone.
    ///
    /// # Errors
    /// The wall is planar or rocks.
    pub fn shear_only(&self, what: &str) -> Result<()> {
        let of = match self.system {
            System::Shear => return Ok(()),
            System::Planar(_) => "planar",
            System::Rocking(_) => "rocking",
        };
        Err(InputError::new(format!("{what} knows no {of} walls")).key("model").allowed("shear").into())
    }

    /// Name of every joint.
    pub fn joint_names(&self) -> Vec<String> {
        self.joints.iter().map(|j| graph::name(&self.wall, j)).collect()
    }
    /// Index of the beam's unknown.
    pub fn floating_beam(&self) -> Option<usize> {
        self.shear.floating_beam()
    }
}

fn compile_elastic(wall: &Wall, joint: &Joint, law: &JointLaw) -> Elastic {
    let (spring, nominal) = (&law.spring, law.nominal_stiffness(joint, wall));
    let upright = joint.kind.is_upright();
    let (stiffness, damping, unilateral) = match spring.acts() {
        Acts::Not => (0.0, 0.0, false),
        // What it bears follows from the motion of its sides, not from a stiffness.
        Acts::Rigidly => (0.0, law.damping_ratio, false),
        Acts::ByStiffness { times, pulls } => (nominal * times, law.damping_ratio, upright && !pulls),
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

/// Says of blocks on one whole joint that no impact leaves them as little of their turn as `rocking_restitution` says: from
/// (1 − η)/(1 + η) = μ_s B/H on, B × H the block, friction does not hold the foot that the turn ends about, which slides instead.
fn kept_by_sliding(wall: &Wall, joints: &[Joint], laws: &[JointLaw]) -> Option<String> {
    let keeps = |e: usize| {
        let (joint, law) = (&joints[e], &laws[e]);
        let above = match (joint.kind, joint.b) {
            (JointKind::Bed, End::Block(b)) => b,
            (JointKind::Base, _) => joint.a,
            _ => return None,
        };
        let [width, height] = [wall.blocks[above].x, wall.blocks[above].y].map(|[from, to]| to - from);
        let given = law.spring.rocking_restitution.filter(|_| joint.overlap > (1.0 - 1e-6) * width)?;
        let grip = law.rubs().map_or(0.0, |friction| friction.static_) * width / height;
        let least = ((1.0 - grip) / (1.0 + grip)).max(0.0);
        (least > given + 1e-9).then_some((least, given, joint))
    };
    let all: Vec<(f64, f64, &Joint)> = (0..joints.len()).filter_map(keeps).collect();
    let (least, given, joint) = all.iter().max_by(|a, b| (a.0 - a.1).total_cmp(&(b.0 - b.1)))?;
    let others = if all.len() > 1 { format!(", and {} more are like it", all.len() - 1) } else { String::new() };
    Some(format!(
        "the block on joint {} keeps more of its turn than rocking_restitution = {given}: its foot slides where it keeps less than {} \
         ((1 - μ_s B/H) / (1 + μ_s B/H)){others}; look at friction.static",
        graph::name(wall, joint),
        plausible::rounded(*least, 3),
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
    Some(format!(
        "load.beam: panel {} ends {:.0} mm below the highest one under the beam; {consequence}. Give the panels under it one height, by `courses`, \
         `brick.height` and `mortar.bed`",
        info.name,
        1e3 * gap
    ))
}

/// Height over thickness from which no wall stands, floors or not: three storeys of half a brick have 75.
const SLENDEREST: f64 = 100.0;

/// Says of a panel that it is higher than any wall of its thickness.
fn slender(wall: &Wall, panel: usize) -> Option<String> {
    let blocks = || wall.blocks.iter().filter(|block| block.panel == panel);
    let [height, thickness] = blocks().fold([0.0, f64::INFINITY], |[h, t], b| [b.y[1].max(h), b.thickness.min(t)]);
    (height > SLENDEREST * thickness).then(|| {
        format!(
            "panel[{panel}].brick.thickness is {} m, and the panel {} m high, {:.0} times as much, more than {SLENDEREST}; look at thickness, \
             `brick.height` and `courses`",
            plausible::rounded(thickness, 4),
            plausible::rounded(height, 4),
            height / thickness
        )
    })
}

/// Part of the mass of all that is shaken which a load may lack without a word.
const LACKING: f64 = 0.05;

/// Says of a load that it has no mass, or too little, where the base moves: what it presses with is not what shakes the wall. `blocks` are the masses
/// of the blocks with what lies on them [kg].
fn massless(case: &Case, excitation: &Excitation, top_load: f64, blocks: &[f64]) -> Option<String> {
    let upright = excitation.vertical != GroundMotion::AtRest;
    let sideways = excitation.base != GroundMotion::AtRest;
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

/// Said where `[out_of_plane]` stands beside a run in the plane.
pub const NOT_IN_PLANE: &str = "out_of_plane is not read in the plane of the wall: its floors, ties and side walls load and hold nothing here; \
     `concio mechanisms` reads it";

/// `rubs` joints rub, `idle` ones have a friction law but no normal force.
fn warnings(case: &Case, wall: &Wall, rubs: usize, idle: usize, reciprocal: bool) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let mut add = |kind, text: String| warnings.push(Warning::new(kind, text));
    let slender = (0..wall.panels.len()).filter_map(|panel| slender(wall, panel));
    slender.for_each(|text| add(WarningKind::UnlikelyNumber, text));
    if case.out_of_plane.is_some() {
        add(WarningKind::IdleKey, NOT_IN_PLANE.into());
    }
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
        let weight = m.si() * G;
        if weight > HEAVIER * load {
            let (whole, unit) = match case.load.top {
                TopLoad::PerLength(_) => (length, "kN/m"),
                TopLoad::Force(_) => (1.0, "kN"),
            };
            let [least, most] = [1e-3 * weight / whole, load / G].map(|v| plausible::rounded(v, 4));
            let lighter = if load > 0.0 { format!(", or load.beam.mass {most} kg or less") } else { String::new() };
            let text = format!(
                "load.beam.mass: the beam weighs {weight:.0} N but load.top brings only {load:.0} N to the wall; its weight acts through load.top alone. Let load.top \
                 be {least} {unit} or more{lighter}"
            );
            add(WarningKind::HeavyBeam, text);
        }
    }
    warnings
}
