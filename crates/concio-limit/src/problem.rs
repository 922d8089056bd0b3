//! From a wall file to blocks, contact points, friction and loads.

use concio::assign::{self, JointLaw};
use concio::case::{Beam, BeamRotation, Case, JointKind, Joints, ModelKind, Motion, NormalForce};
use concio::model::Model;
use concio::planar;
use concio::quantity::{Stress, Time};
use concio::wall::{Joint, Wall};
use concio::{G, InputError, Result, run};
use concio_planar::body::Body;

use crate::assembly::{Assembly, Other};

/// Distance of the sides of a joint over its length up to which they touch: rounding.
const TOUCHING: f64 = 1e-9;

/// What the live load is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Push {
    /// The weight of every block, turned to the horizontal.
    #[default]
    Body,
    /// The dead load of the blocks of the top course, the load on them included, turned to the horizontal.
    Top,
}

/// Where the live load pushes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Towards {
    /// To −x.
    Left,
    /// To +x.
    #[default]
    Right,
}

/// Friction of head joints and connections.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Heads {
    /// What the wall file says.
    #[default]
    AsGiven,
    /// None.
    Frictionless,
}

/// What is asked of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// What pushes.
    pub push: Push,
    /// Where to.
    pub towards: Towards,
    /// Friction of head joints.
    pub heads: Heads,
}

/// A wall of rigid dry blocks under dead and live load.
#[derive(Debug, Clone)]
pub struct Problem {
    /// The wall.
    pub wall: Wall,
    /// Names of its joints.
    pub joints: Vec<String>,
    /// Blocks, a beam with mass after them, and contact points.
    pub assembly: Assembly,
    /// μ of every contact point, from 0.
    pub friction: Vec<f64>,
    /// Dead load at the centre of every body [N].
    pub dead: Vec<[f64; 2]>,
    /// Live load at the centre of every body at λ = 1 [N].
    pub live: Vec<[f64; 2]>,
    /// A body that keeps its turn, as a beam does whose rotation is held.
    pub level: Option<usize>,
    /// Whether a load on the blocks has mass, and pushes with them.
    pub laden: bool,
    /// What of the wall file holds or pushes blocks and is left out: ties, forces on blocks.
    pub left_out: Vec<&'static str>,
    /// What the analysis leaves out of the wall file, or takes otherwise than it may be meant.
    pub warnings: Vec<String>,
}

impl Problem {
    /// Of a valid case.
    ///
    /// A beam with mass is one more rigid body on the top course: the load on the wall is its weight, its mass what the body
    /// load takes hold of, at the middle of its height, as in a run.
    ///
    /// # Errors
    /// Beams that something else holds, devices in joints, walls that cannot be laid.
    pub fn of(given: &Case, options: Options) -> Result<Problem> {
        if given.model == ModelKind::Rocking {
            let error = InputError::new("the wall rocks out of its plane, and limit analysis is that of blocks in it")
                .key("model");
            let error = error.allowed("`shear` or `planar`");
            return Err(error.help("`concio mechanisms` has the multipliers of this file as it is").into());
        }
        let case = at_rest(given)?;
        let model = run::prepare_case(case.clone(), std::path::Path::new("."))?.model;
        let sides = sides(&case, &model)?;
        let laden = assign::load_masses(&case, &model.wall);
        let mut assembly = Assembly::of(&model.wall, &model.joints, |e| sides[e] != Sides::Apart, &laden);
        let mut dead: Vec<f64> = model.wall.blocks.iter().map(|b| b.weight()).collect();
        let mut live = match options.push {
            Push::Body => dead.iter().zip(&laden).map(|(weight, load)| weight + load * G).collect(),
            Push::Top => vec![0.0; dead.len()],
        };
        let loaded = model.wall.loaded();
        if let Beam::Mass(mass) = case.load.beam {
            let (beam, length) = beam(&case, &model, mass.si());
            assembly.bodies.push(beam);
            let load = case.load.top.per_length(length) * length;
            dead.push(load);
            live.push(if options.push == Push::Body { mass.si() * G } else { load });
            for point in assembly.points.iter_mut().filter(|p| p.b == Other::Beam) {
                point.b = Other::Body(model.wall.blocks.len());
            }
        } else {
            let load = case.load.top.per_length(loaded.iter().sum());
            dead.iter_mut().zip(&loaded).for_each(|(dead, length)| *dead += load * length);
        }
        if options.push == Push::Top {
            (0..loaded.len()).filter(|&i| loaded[i] > 0.0).for_each(|i| live[i] = dead[i]);
        }
        let blocks = model.wall.blocks.len();
        let level = assembly.bodies.len() > blocks && case.load.beam_rotation == BeamRotation::Fixed;
        let sign = if options.towards == Towards::Right { 1.0 } else { -1.0 };
        Ok(Problem {
            joints: model.joint_names(),
            friction: friction(&case, &model, &assembly, &sides, options.heads)?,
            assembly,
            dead: dead.iter().map(|w| [0.0, -w]).collect(),
            live: live.iter().map(|w| [sign * w, 0.0]).collect(),
            level: level.then_some(blocks),
            laden: model.load_mass > 0.0,
            left_out: left_out(given),
            warnings: warnings(given, &model, &sides),
            wall: model.wall,
        })
    }
}

/// The case without motion, its joints dry, the load that of a wall that is free to fall.
fn at_rest(case: &Case) -> Result<Case> {
    if matches!(case.load.beam, Beam::Driven | Beam::Tied) {
        let error = InputError::new("a beam that is driven or tied holds the top of the wall").key("load.beam");
        return Err(error.allowed("\"free\", or { mass = … }").into());
    }
    if let Some(number) = case.joint.changes.iter().position(|c| c.device.is_some()) {
        let error =
            InputError::new("limit analysis knows dry joints alone").key(format!("joint.change[{number}].device"));
        return Err(error.help("take the devices out of the wall file").into());
    }
    let mut case = case.clone();
    case.motion = Motion { duration: Some(Time::from_si(1.0)), ..Motion::default() };
    case.output = Default::default();
    // A model has the friction of those joints alone that carry load by its own account; by this one all do.
    case.joint.friction.normal_force = NormalForce::Overburden;
    // Nor does it matter here whether a bond would snap back. Without it `elastic` joints could not crush, and here none does.
    let joint = &mut case.joint;
    joint.bond = None;
    joint.changes.iter_mut().for_each(|change| change.bond = None);
    strengths(joint).into_iter().for_each(|strength| *strength = None);
    Ok(case)
}

/// Compressive strengths of joints [Pa] other than that of the bed joints.
pub fn other_strengths(joints: &Joints) -> Vec<f64> {
    let mut others = joints.clone();
    others.bed.compressive_strength = None;
    strengths(&mut others).into_iter().filter_map(|strength| Some(strength.as_ref()?.si())).collect()
}

/// Where joints may have a compressive strength.
fn strengths(joint: &mut Joints) -> Vec<&mut Option<Stress>> {
    let others = [&mut joint.base, &mut joint.top, &mut joint.connection].into_iter().flatten();
    let springs = [&mut joint.bed, &mut joint.head].into_iter().chain(others).map(|s| &mut s.compressive_strength);
    let changes = joint.changes.iter_mut().filter_map(|change| change.spring.as_mut());
    springs.chain(changes.map(|spring| &mut spring.compressive_strength)).collect()
}

fn left_out(case: &Case) -> Vec<&'static str> {
    let besides = [("ties", !case.ties.is_empty()), ("forces on blocks", !case.forces.is_empty())];
    besides.into_iter().filter_map(|(what, given)| given.then_some(what)).collect()
}

fn warnings(case: &Case, model: &Model, sides: &[Sides]) -> Vec<String> {
    let bonded = case.joint.bond.is_some() || case.joint.changes.iter().any(|c| c.bond.is_some());
    let bonded = bonded.then(|| "the bond of the joints is left out: they count as dry".to_string());
    let besides = left_out(case)
        .into_iter()
        .map(|what| format!("the {what} are left out: the multiplier is that of the wall without them"));
    let mortar = |p: &concio::case::Panel| p.mortar.bed.si() > 0.0 || p.mortar.head.si() > 0.0;
    let laid = case.panels.iter().any(mortar).then(|| {
        "mortar counts as a dry joint, a line in its middle: it bears no tension, and blocks touch there".to_string()
    });
    let weight = model.load_mass * G;
    let presses = (case.load.beam == Beam::Free && weight < (1.0 - LACKING) * model.top_load).then(|| {
        let [all, has] = [model.top_load, weight].map(|force| 1e-3 * force);
        format!(
            "of the {all:.2} kN that load.top brings, {has:.2} kN push: the rest has no mass, and presses alone. Leave load.mass out, and all of it pushes"
        )
    });
    let crushes = strengths(&mut case.joint.clone()).iter().any(|strength| strength.is_some());
    let crushes = crushes.then(|| {
        "compressive_strength is left out: joints bear any pressure at their edges, and the multiplier is too high where they would crush".to_string()
    });
    let touching = sides.iter().filter(|sides| **sides == Sides::Touching).count();
    let touching = (touching > 0).then(|| {
        format!("the sides of {touching} joints of law `none` touch as they are laid: blocks press and rub there. A gap between them keeps them apart")
    });
    let across = case.out_of_plane.is_some().then(|| concio::model::NOT_IN_PLANE.to_string());
    bonded.into_iter().chain(across).chain(laid).chain(besides).chain(presses).chain(crushes).chain(touching).collect()
}

/// Part of a load that may have no mass without a word.
const LACKING: f64 = 0.01;

/// The beam and the length on which it lies [m].
fn beam(case: &Case, model: &Model, mass: f64) -> (Body, f64) {
    let tops: Vec<_> = model.joints.iter().filter(|j| j.kind == JointKind::Top).collect();
    let loaded = model.wall.loaded();
    let length: f64 = tops.iter().map(|j| loaded[j.a]).sum();
    let touched: f64 = tops.iter().map(|j| j.overlap).sum();
    // It lies so that it presses alike everywhere, wherever its ends are.
    let x = tops.iter().map(|j| 0.5 * (j.line[0] + j.line[2]) * j.overlap).sum::<f64>() / touched;
    let [left, right, y] = tops.iter().fold([f64::INFINITY, f64::NEG_INFINITY, 0.0], |e, j| {
        [e[0].min(j.line[0]), e[1].max(j.line[2]), f64::max(e[2], j.line[1])]
    });
    let half = 0.5 * planar::beam_height(case, &model.wall);
    let corners = vec![[left - x, -half], [right - x, -half], [right - x, half], [left - x, half]];
    let inertia = mass * (right - left).powi(2) / 12.0;
    (Body { name: "beam".into(), centre: [x, y + half], corners, mass, inertia }, length)
}

/// How the sides of a joint lie.
#[derive(Clone, Copy, PartialEq)]
enum Sides {
    /// On mortar, or one on the other.
    Joined,
    /// With nothing between them, touching as they are laid.
    Touching,
    /// With air between them.
    Apart,
}

/// The sides of every joint. In shear walls a bed joint of law `none` bears the weight all the same, and rubs.
fn sides(case: &Case, model: &Model) -> Result<Vec<Sides>> {
    let laws = assign::resolve(case, &model.wall, &model.joints)?;
    let of = |(joint, law): (&Joint, &JointLaw)| match law.is_open() {
        true if case.model == ModelKind::Shear && !joint.kind.is_upright() => Sides::Joined,
        true if planar::apart(&model.wall, joint) > TOUCHING * joint.overlap => Sides::Apart,
        true => Sides::Touching,
        false => Sides::Joined,
    };
    Ok(model.joints.iter().zip(&laws).map(of).collect())
}

fn friction(case: &Case, model: &Model, assembly: &Assembly, sides: &[Sides], heads: Heads) -> Result<Vec<f64>> {
    let mut of_joint = vec![0.0; model.joints.len()];
    for rub in &model.shear.rubs {
        of_joint[rub.joint as usize] = rub.law.static_;
    }
    // What comes to touch rubs as joints of its kind do, in a run too.
    let laws = assign::resolve(case, &model.wall, &model.joints)?;
    for e in (0..sides.len()).filter(|e| sides[*e] == Sides::Touching) {
        of_joint[e] = laws[e].touching().map_or(0.0, |law| law.static_);
    }
    let frictionless = |joint: usize| heads == Heads::Frictionless && model.joints[joint].kind.is_upright();
    Ok(assembly.points.iter().map(|p| if frictionless(p.joint) { 0.0 } else { of_joint[p.joint] }).collect())
}
