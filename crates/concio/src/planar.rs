//! Planar walls: from a wall and its laws to rigid bodies that slide, open and rock, and their run.
//!
//! Geometry, joints, laws, motions, results and studies are those of the shear model; only what a block can do differs.
//! The mechanics are those of `concio_planar`.

use std::collections::{BTreeMap, HashSet};

use concio_law::friction::Stribeck;
use concio_planar::body::Body;
use concio_planar::joint::{self, Bond as PointBond, Friction, Law, Normal, Shear};
use concio_planar::motion::{Link, Motion, Setting, System};
use concio_planar::shape::{Place, Polygon, touches};
use concio_planar::tie::Tie as Rod;
use concio_shear::law::{Bonded, Elastic};

use crate::assign::JointLaw;
use crate::assign::load_masses;
use crate::bond::{Bond, Snap, Snaps};
use crate::case::plausible::rounded;
use crate::case::{Acts, Beam, BeamRotation, BlockForce, Case, Device, DeviceLaw, JointKind, Spring, StopAt, Tie};
use crate::device;
use crate::error::{InputError, Result};
use crate::quantity::{Length, shown};
use crate::wall::{Block, End, Joint, Wall};

pub use concio_planar::motion::Vibration;

/// How far outside of its block a tie may be fixed [m]: what numbers are rounded by.
const BESIDE: f64 = 1e-6;

/// Largest way of a body in a step without inertia at which the wall stands under its loads [m].
const STANDS: f64 = 1e-10;
/// Steps in which it has to come to that.
const SETTLING: usize = 400;
/// Way of a body over the least height of a block from which a wall that has not come to that is falling, and from which what has
/// come to rest is no longer the wall.
const FALLING: f64 = 0.01;
const FELL: f64 = 0.25;

/// A wall whose blocks rise and turn.
#[derive(Debug, Clone)]
pub struct Planar {
    /// Bodies, blocks first and the beam last, their joints in the order of the wall's, their loads.
    pub system: System,
    /// Centre of each block from that of its body [m], which has the load on the block too.
    pub offset: Vec<[f64; 2]>,
    /// Whether there is nothing in each joint: its sides meet where they come to touch.
    pub open: Vec<bool>,
    /// Step h [s].
    pub step: f64,
    /// Whether inertia is left out.
    pub still: bool,
    /// Forces of the wall file on blocks.
    pub forces: Vec<Pushes>,
    /// How long after a collapse the run ends [s]; none where it goes on to the end of the motion.
    pub after_collapse: Option<f64>,
}

/// A force on a block as time goes by.
#[derive(Debug, Clone, PartialEq)]
pub struct Pushes {
    /// Number of the block.
    pub block: usize,
    /// Values along x and y, one after the other [N].
    values: [Vec<f64>; 2],
    /// How long each acts [s].
    every: f64,
}

impl Pushes {
    /// What acts in a step that begins at `t` [N]: of values that change there within rounding, the later ones.
    pub fn at(&self, t: f64) -> [f64; 2] {
        let number = (t / self.every * (1.0 + 1e-12) + 1e-9).floor() as usize;
        [0, 1].map(|k| {
            let values = &self.values[k];
            values.get(number).or(values.last()).copied().unwrap_or(0.0)
        })
    }
}

impl Planar {
    /// The slowest vibration of the wall as it stands under its loads ([`concio_planar::motion::Motion::slowest`]).
    pub fn slowest(&self) -> Option<Vibration> {
        standing(self).0.slowest()
    }

    /// How the wall takes its loads before anything moves.
    pub fn rest(&self) -> Rest {
        standing(self).1
    }

    /// Longest step that resolves the joints whose springs let go, as they ring between the blocks beside them [s]: that of the
    /// stiffest by [`joint::RESOLVED`]. Infinite where springs act in both directions alone. `cracked`: bonded joints count as cracked through.
    pub fn resolving_step(&self, cracked: bool) -> f64 {
        let light = |body: Option<usize>| body.map_or(0.0, |b| 1.0 / self.system.bodies[b].mass);
        let square = |link: &Link| {
            let law = if cracked { link.law.cracked() } else { link.law };
            let along = if law.shear.series { law.shear.stiffness } else { 0.0 };
            match law.normal {
                Normal::Springs { press, .. } => press.max(along) * (light(link.a) + light(Some(link.b))),
                Normal::Rigid { .. } => 0.0,
            }
        };
        joint::RESOLVED / self.system.links.iter().map(square).fold(0.0, f64::max).sqrt()
    }
}

/// How a wall takes its loads before anything moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rest {
    /// It stands.
    Stands {
        /// How far blocks and beam have settled at most [m].
        settled: f64,
        /// Joints whose bond its loads have cracked.
        cracked: usize,
        /// Steps of that whose contact was left unsolved.
        unsolved: u64,
    },
    /// It has not come to rest in the steps that it is given, and how far it was then [m]: its joints are soft, or it falls slowly.
    Settles(f64),
    /// It falls, or has come to rest as something else.
    Falls,
}

/// The top beam as a body: its level is that of the highest panel.
pub(crate) struct BeamBody {
    /// The body.
    pub body: Body,
    /// Length on which it lies [m].
    pub length: f64,
}

/// The beam of a planar wall; none where the top is free.
pub(crate) fn beam(case: &Case, wall: &Wall, joints: &[Joint]) -> Option<BeamBody> {
    if case.load.beam == Beam::Free {
        return None;
    }
    let tops: Vec<&Joint> = joints.iter().filter(|j| j.kind == JointKind::Top).collect();
    // As far as the load lies on the blocks under it, whatever part of them it touches.
    let loaded = wall.loaded();
    let length: f64 = tops.iter().map(|j| loaded[j.a]).sum();
    let [left, right] =
        tops.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |e, j| [e[0].min(j.line[0]), e[1].max(j.line[2])]);
    let level = top_level(wall);
    let height = beam_height(case, wall);
    let mass = match case.load.beam {
        Beam::Mass(mass) => mass.si(),
        // Held from side to side, it needs a mass for its rise and turn relative to the base alone; its load is a dead one, which nothing shakes.
        _ => tops.iter().map(|j| wall.blocks[j.a].mass()).sum(),
    };
    Some(BeamBody { body: Body::rectangle("beam", [left, right], [level, level + height], mass), length })
}

/// Height of the beam [m]: half of the highest reference brick unless given.
pub fn beam_height(case: &Case, wall: &Wall) -> f64 {
    let usual = 0.5 * wall.panels.iter().map(|p| p.reference_height).fold(0.0, f64::max);
    case.load.beam_height.map_or(usual, |h| h.si())
}

/// A convex block as it is: where its joints have mortar, its sides keep the distance that they were laid with.
pub fn polygon(block: &crate::wall::Block) -> Body {
    let centre = block.centre();
    let mass = block.mass();
    Body {
        name: block.name.clone(),
        centre,
        corners: block.corners().iter().map(|c| [c[0] - centre[0], c[1] - centre[1]]).collect(),
        mass,
        inertia: mass * block.polar_moment() / block.area(),
    }
}

/// Puts a load of this mass [kg] on a block, along the whole of its top: both move as one, about their common centre.
pub fn bear(body: &mut Body, block: &crate::wall::Block, mass: f64) {
    if mass == 0.0 {
        return;
    }
    let up = block.y[1] - body.centre[1];
    let rise = up * mass / (body.mass + mass);
    body.inertia += body.mass * rise * rise + mass * ((up - rise).powi(2) + block.length().powi(2) / 12.0);
    body.mass += mass;
    body.centre[1] += rise;
    body.corners.iter_mut().for_each(|corner| corner[1] -= rise);
}

/// Level that the blocks under a beam reach to, that of the highest block [m].
pub fn top_level(wall: &Wall) -> f64 {
    wall.blocks.iter().map(|b| b.y[1]).fold(f64::NEG_INFINITY, f64::max)
}

/// Makes bodies and laws of a wall, whose joints bear `normal` at rest [N].
///
/// # Errors
/// Devices that planar walls do not have, ties without length.
pub(crate) fn compile(
    case: &Case,
    wall: &Wall,
    joints: &[Joint],
    laws: &[JointLaw],
    normal: &[[f64; 2]],
) -> Result<Planar> {
    let mut bodies = bodies(wall, joints, laws);
    let n = bodies.len();
    let mut loads: Vec<[f64; 2]> = wall.blocks.iter().map(|b| [0.0, -b.weight()]).collect();
    for ((body, block), mass) in bodies.iter_mut().zip(&wall.blocks).zip(load_masses(case, wall)) {
        bear(body, block, mass);
    }
    let from = |(block, body): (&crate::wall::Block, &Body)| [0, 1].map(|k| block.centre()[k] - body.centre[k]);
    let offset: Vec<[f64; 2]> = wall.blocks.iter().zip(&bodies).map(from).collect();
    let mut held = vec![[false; 3]; n];
    let mut shaken = vec![true; n];
    match beam(case, wall, joints) {
        Some(beam) => {
            loads.push([0.0, -case.load.top.per_length(beam.length) * beam.length]);
            let level = case.load.beam_rotation == BeamRotation::Fixed;
            let sideways = matches!(case.load.beam, Beam::Driven | Beam::Tied);
            held.push([sideways, false, level]);
            shaken.push(!sideways);
            bodies.push(beam.body);
        }
        None => {
            let lengths = wall.loaded();
            let load = case.load.top.per_length(lengths.iter().sum());
            for (load_on, length) in loads.iter_mut().zip(lengths) {
                load_on[1] -= load * length;
            }
        }
    }
    let other = Law::dry(common_friction(case));
    let link = |(joint, law): (&Joint, &JointLaw)| {
        let (a, b) = match joint.b {
            End::Block(b) => (Some(joint.a), b),
            End::Base => (None, joint.a),
            End::Top => (Some(joint.a), n),
        };
        match law.is_open() {
            // Sides that come to touch rub as joints of their kind do.
            true => Link { a, b, law: Law::dry(law.touching().map(friction)), apart: apart(wall, joint) },
            false => Link::closed(a, b, compile_law(case, wall, joint, law)),
        }
    };
    softening(wall, joints, laws, normal)?;
    let links = joints.iter().zip(laws).map(link).collect();
    let ties = ties(case, wall, &offset)?;
    let system = System { bodies, links, ties, other, load: loads, held, shaken };
    let open = laws.iter().map(JointLaw::is_open).collect();
    let after_collapse = case.motion.stop_at.map(|StopAt::Collapse(after)| after.si());
    let (step, still) = (case.planar_step(), case.motion.quasi_static);
    let forces = case.forces.iter().enumerate().map(|(i, force)| pushes(i, force, wall)).collect::<Result<_>>()?;
    Ok(Planar { system, offset, open, step, still, forces, after_collapse })
}

fn pushes(i: usize, force: &BlockForce, wall: &Wall) -> Result<Pushes> {
    let block = wall.blocks.iter().position(|b| b.name == force.block).ok_or_else(|| {
        let what = format!("no block is called `{}`", force.block);
        InputError::new(what).key(format!("force[{i}].block")).allowed("names of blocks")
    })?;
    let values = [&force.x, &force.y].map(|values| values.iter().map(|v| v.si()).collect());
    Ok(Pushes { block, values, every: force.every.map_or(f64::INFINITY, |every| every.si()) })
}

/// Ties as rods between bodies; the base is the first of the two.
fn ties(case: &Case, wall: &Wall, offset: &[[f64; 2]]) -> Result<Vec<Rod>> {
    let rod = |(i, tie): (usize, &Tie)| {
        let wrong = |end: &str, what: String, allowed: &str| {
            InputError::new(what).key(format!("tie[{i}].{end}")).allowed(allowed)
        };
        let body = |end: &str, name: &String| match wall.blocks.iter().position(|b| b.name == *name) {
            None if name != Tie::BASE => {
                Err(wrong(end, format!("no block is called `{name}`"), "`base`, or names of blocks"))
            }
            found => Ok(found),
        };
        let ends = [(body("from", &tie.from)?, tie.at), (body("to", &tie.to)?, tie.to_at)]
            .map(|(body, at)| (body, at.map(|x| x.si())));
        let ((a, at_a), (Some(b), at_b)) = (if ends[1].0.is_some() { (ends[0], ends[1]) } else { (ends[1], ends[0]) })
        else {
            return Err(
                wrong("to", "both ends are fixed to the base".into(), "another block than `from`, or `base`").into()
            );
        };
        let place = |body: Option<usize>, at: [f64; 2]| {
            let from = body.map_or([0.0; 2], |body| wall.blocks[body].centre());
            [from[0] + at[0], from[1] + at[1]]
        };
        if place(a, at_a) == place(Some(b), at_b) {
            return Err(
                wrong("to_at", "both ends are at the same place".into(), "a place apart from that of `from`").into()
            );
        }
        let yield_force = tie.yield_force.map_or(f64::INFINITY, |f| f.si());
        // Of a body, from its own centre.
        let of_body = |body: Option<usize>, at: [f64; 2]| body.map_or(at, |b| [0, 1].map(|k| at[k] + offset[b][k]));
        Ok(Rod {
            a,
            b,
            at: [of_body(a, at_a), of_body(Some(b), at_b)],
            stiffness: tie.stiffness.si(),
            yield_force,
            slack: tie.slack.si(),
        })
    };
    case.ties.iter().enumerate().map(rod).collect()
}

/// How far beside a wall its ties may be fixed to the base, over the larger of its sides: to frames and buttresses.
const BUTTRESS: f64 = 2.0;

/// How far a place is outside of the wall, over the larger of its sides, and the rectangle around it, if that is farther than ties go.
fn far_from(wall: &Wall, at: [f64; 2]) -> Option<([[f64; 2]; 2], f64)> {
    let around = [0, 1].map(|k| {
        let sides = wall.blocks.iter().map(|block| if k == 0 { block.x } else { block.y });
        // The base is at height 0.
        let first = [if k == 0 { f64::INFINITY } else { 0.0 }, f64::NEG_INFINITY];
        sides.fold(first, |e, side| [e[0].min(side[0]), e[1].max(side[1])])
    });
    let [x, y] = [0, 1].map(|k| (around[k][0] - at[k]).max(at[k] - around[k][1]).max(0.0));
    let size = around.iter().map(|[from, to]| to - from).fold(0.0, f64::max);
    let far = x.hypot(y);
    (far > BUTTRESS * size).then_some((around, far))
}

/// Says of ties that they are fixed outside of their block: a plate lies on it at the farthest; on the base far from the wall.
pub(crate) fn detached(case: &Case, wall: &Wall) -> Vec<String> {
    let doubt = |i: usize, key: &str, name: &String, at: [f64; 2]| {
        if name == Tie::BASE {
            let ([x, y], far) = far_from(wall, at)?;
            let [px, py, far, x0, x1, y1] = [at[0], at[1], far, x[0], x[1], y[1]].map(|v| shown(rounded(v, 4)));
            return Some(format!(
                "tie[{i}].{key} is fixed to the base at x = {px} m, y = {py} m, {far} m away from the wall, which goes from x = {x0} to {x1} m and up to y = {y1} m; \
                 look at its unit"
            ));
        }
        let block = wall.blocks.iter().find(|b| b.name == *name)?;
        let centre = block.centre();
        let place = [centre[0] + at[0], centre[1] + at[1]];
        let corners = block.corners();
        let beyond = |(k, p): (usize, &[f64; 2])| {
            let q = corners[(k + 1) % corners.len()];
            let (way, there) = ([q[0] - p[0], q[1] - p[1]], [place[0] - p[0], place[1] - p[1]]);
            (way[1] * there[0] - way[0] * there[1]) / way[0].hypot(way[1])
        };
        let far = corners.iter().enumerate().map(beyond).fold(f64::NEG_INFINITY, f64::max);
        (far > BESIDE).then(|| format!("tie[{i}].{key} lies {:.3} m outside of block {name}", far))
    };
    let both = |(i, tie): (usize, &Tie)| {
        let [at, to_at] = [tie.at, tie.to_at].map(|at| at.map(|x| x.si()));
        [doubt(i, "at", &tie.from, at), doubt(i, "to_at", &tie.to, to_at)]
    };
    case.ties.iter().enumerate().flat_map(both).flatten().collect()
}

/// Strain at which a tie yields, from its force and stiffness: steel at 0.001 to 0.005, ropes and laminates at 0.03, and anchors give as well.
const YIELDS: [f64; 2] = [2e-5, 0.05];
/// Where a guess at what was meant lies.
const MOSTLY: [f64; 2] = [2e-4, 0.03];
/// Part of the weight of a wall and its load below which what a tie bears is nothing to it.
const FEEBLE: f64 = 1e-3;

/// Where the ends of a tie are [m].
fn ends_of(tie: &Tie, wall: &Wall) -> [[f64; 2]; 2] {
    let end = |name: &String, at: [Length; 2]| {
        let centre = wall.blocks.iter().find(|b| b.name == *name).map_or([0.0; 2], Block::centre);
        [centre[0] + at[0].si(), centre[1] + at[1].si()]
    };
    [end(&tie.from, tie.at), end(&tie.to, tie.to_at)]
}

/// Where the ties of a wall begin and end, x and y of both [m].
pub fn tie_lines(case: &Case, wall: &Wall) -> Vec<[f64; 4]> {
    case.ties.iter().map(|tie| ends_of(tie, wall)).map(|[[x0, y0], [x1, y1]]| [x0, y0, x1, y1]).collect()
}

/// Distance of the ends of a tie [m].
fn span(tie: &Tie, wall: &Wall) -> f64 {
    let [from, to] = ends_of(tie, wall);
    (to[0] - from[0]).hypot(to[1] - from[1])
}

/// Says of ties that they yield at a strain at which none does, or bear nothing beside `weight` [N], that of the wall and its load.
pub(crate) fn unlikely_ties(case: &Case, wall: &Wall, weight: f64) -> Vec<String> {
    let told = |(i, tie): (usize, &Tie)| {
        let (force, length) = (tie.yield_force?.si(), span(tie, wall));
        let strain = force / tie.stiffness.si() / length;
        let within = |[low, high]: [f64; 2], v: f64| (low..=high).contains(&v);
        let number = |v: f64| shown(rounded(v, 3));
        // Cramps and dowels are short and give where they are held.
        let stretches = force / tie.stiffness.si() > YIELDS[1] * span(tie, wall).max(1.0);
        let what = if strain < YIELDS[0] || strain > YIELDS[1] && stretches {
            let at = format!("{} m yields when it is {} % longer", number(length), number(100.0 * strain));
            format!("at its `stiffness` a tie of {at}, and steel does at 0.1 to 0.5 %")
        } else if force < FEEBLE * weight {
            format!("{} of the weight of wall and load, next to nothing", number(force / weight))
        } else {
            return None;
        };
        let meant =
            [1e3, 1e-3].into_iter().find(|factor| within(MOSTLY, factor * strain) && factor * force > FEEBLE * weight);
        let meant = meant.map_or("look at its unit and that of `stiffness`".into(), |factor| {
            format!("did you mean \"{} kN\"?", number(1e-3 * factor * force))
        });
        Some(format!("tie[{i}].yield_force is {} kN: {what}; {meant}", number(1e-3 * force)))
    };
    case.ties.iter().enumerate().filter_map(told).collect()
}

/// How far the sides of a joint are apart as the blocks are laid, without mortar [m].
pub fn apart(wall: &Wall, joint: &Joint) -> f64 {
    let block = &wall.blocks[joint.a];
    let between = match joint.b {
        End::Base => block.y[0],
        End::Top => top_level(wall) - block.y[1],
        End::Block(b) => {
            let placed = |block| {
                let body = polygon(block);
                let mut placed = Polygon::of(&body);
                placed.put(&Polygon::of(&body), &Place { centre: body.centre, angle: 0.0 });
                placed
            };
            let ends = touches(&placed(block), &placed(&wall.blocks[b]), f64::INFINITY);
            ends.map_or(0.0, |ends| ends[0].gap.min(ends[1].gap))
        }
    };
    between.max(0.0)
}

/// Blocks reach to the middle of their mortar joints, to the base and to the beam. Across a joint in which there is nothing they keep their own sides.
fn bodies(wall: &Wall, joints: &[Joint], laws: &[JointLaw]) -> Vec<Body> {
    let mut faces: Vec<[f64; 4]> = wall.blocks.iter().map(|b| [b.x[0], b.x[1], b.y[0], b.y[1]]).collect();
    let level = top_level(wall);
    for (joint, _) in joints.iter().zip(laws).filter(|(_, law)| !law.is_open()) {
        let [x, y, ..] = joint.line;
        match (joint.kind, joint.b) {
            (JointKind::Head | JointKind::Connection, End::Block(b)) => {
                faces[joint.a][1] = faces[joint.a][1].max(x);
                faces[b][0] = faces[b][0].min(x);
            }
            (JointKind::Bed, End::Block(b)) => {
                faces[joint.a][3] = faces[joint.a][3].max(y);
                faces[b][2] = faces[b][2].min(y);
            }
            (JointKind::Base, _) => faces[joint.a][2] = 0.0,
            (JointKind::Top, _) => faces[joint.a][3] = level,
            _ => {}
        }
    }
    part(wall, joints, &mut faces);
    let body = |(block, [left, right, low, high]): (&crate::wall::Block, [f64; 4])| {
        if !block.is_rectangle() {
            return polygon(block);
        }
        let mut body = Body::rectangle(&block.name, block.x, block.y, block.mass());
        let [x, y] = body.centre;
        body.corners = vec![[left - x, low - y], [right - x, low - y], [right - x, high - y], [left - x, high - y]];
        body
    };
    wall.blocks.iter().zip(faces).map(body).collect()
}

/// Part of a block's length over which another may lie above it, or not, by rounding.
const ALIGNED: f64 = 1e-6;

/// Blocks one above the other that face each other over less than the mortar between them have no joint: they keep their own sides, or they would touch there.
fn part(wall: &Wall, joints: &[Joint], faces: &mut [[f64; 4]]) {
    let mut rows: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for (i, block) in wall.blocks.iter().enumerate() {
        rows.entry((block.panel, block.course)).or_default().push(i);
    }
    rows.values_mut().for_each(|row| row.sort_by(|a, b| wall.blocks[*a].x[0].total_cmp(&wall.blocks[*b].x[0])));
    let joined: HashSet<(usize, usize)> = joints
        .iter()
        .filter_map(|j| if let End::Block(b) = j.b { Some((j.a.min(b), j.a.max(b))) } else { None })
        .collect();
    for (upper, block) in wall.blocks.iter().enumerate() {
        let below = block.lowest_course().checked_sub(1).and_then(|course| rows.get(&(block.panel, course)));
        let Some(below) = below else { continue };
        // Those that end right of where it begins, up to the first that begins right of where it ends.
        let first = below.partition_point(|i| wall.blocks[*i].x[1] < block.x[0]).saturating_sub(1);
        for &lower in &below[first..] {
            let beside = &wall.blocks[lower];
            if faces[lower][0] > faces[upper][1] {
                break;
            }
            if joined.contains(&(lower.min(upper), lower.max(upper))) {
                continue;
            }
            let (left, right) = if beside.x[0] < block.x[0] { (lower, upper) } else { (upper, lower) };
            let shorter = wall.blocks[left].length().min(wall.blocks[right].length());
            if faces[left][1] - faces[right][0] > ALIGNED * shorter {
                (faces[left][1], faces[right][0]) = (wall.blocks[left].x[1], wall.blocks[right].x[0]);
            }
        }
    }
}

/// The bonded joints, for their rows in results: the strength of a bed joint without the pressure of the moment, that of a
/// head joint in tension.
pub(crate) fn bonds(wall: &Wall, joints: &[Joint], laws: &[JointLaw]) -> Vec<Bonded> {
    let of = |(e, (joint, law)): (usize, (&Joint, &JointLaw))| {
        let values = law.strong_bond()?;
        let opens = joint.kind.is_upright();
        let area = joint.area(wall);
        let which = usize::from(!opens);
        let strength = area * if opens { values.tensile_strength } else { values.cohesion };
        let stiffness = law.stiffness(joint, wall) * law.spring.stiffness_factor;
        let law = Bond { strength, stiffness, residual: values.residual, decay: 0.0, opens };
        let softening = Bond::new(strength, stiffness, values.residual, values.energy[which] * area, opens);
        Some(Bonded { joint: e as u32, rub: None, law: softening.unwrap_or(law) })
    };
    joints.iter().zip(laws).enumerate().filter_map(of).collect()
}

/// By which part of its length a rigid joint is pressed in where it crushes: what is crushed is known of joints with springs. It is a hundredth of what
/// stones of 0.5 m are pressed in, whose strain at their strength is 1e-3; stiffer springs ring within a step, and walls of them are hard to solve. They are damped as
/// others are: blocks that slide on springs without dashpots hop, in steps that resolve it.
const PRESSED_IN: f64 = 1e-5;

/// The same of a joint whose springs are given, at least.
fn pressed_in(case: &Case) -> f64 {
    if case.motion.quasi_static { 0.1 * PRESSED_IN } else { PRESSED_IN }
}

/// Factor on the stiffness of springs in both directions; along a joint that does not pull there is none.
fn pulling(spring: &Spring) -> f64 {
    if let Acts::ByStiffness { times, pulls: true } = spring.acts() { times } else { 1.0 }
}

fn compile_law(case: &Case, wall: &Wall, joint: &Joint, law: &JointLaw) -> Law {
    if let Some(device) = law.device(case) {
        return device_law(joint, device);
    }
    let spring = &law.spring;
    let ways = ways(joint, law);
    let [across, along] = ways;
    let given = law.stiffness(joint, wall);
    let stiffness = given * spring.stiffness_factor;
    let reference = wall.panels[wall.blocks[joint.a].panel].reference_mass;
    let dashpot = |k: f64| 2.0 * law.damping_ratio * (k * joint.weight * reference).sqrt();
    let area = joint.area(wall);
    let bond = law.strong_bond().map(|values| PointBond {
        tension: values.tensile_strength * area,
        cohesion: values.cohesion * area,
        tan_angle: values.tan_angle,
        energy: values.energy.map(|energy| energy * area),
        residual: values.residual,
    });
    let crushing = spring.compressive_strength.map_or(f64::INFINITY, |f| f.si() * area);
    let rigid = crushing / (PRESSED_IN * joint.overlap);
    let stiffest = crushing / (pressed_in(case) * joint.overlap);
    let (normal, series) = match spring.acts() {
        Acts::Rigidly if crushing.is_finite() => {
            let (both, press) = if bond.is_some() { (rigid, 0.0) } else { (0.0, rigid) };
            (Normal::Springs { both, press, damping: dashpot(rigid) }, true)
        }
        Acts::Rigidly => {
            let (restitution, rocking) = (spring.restitution, spring.rocking_restitution);
            (Normal::Rigid { restitution: restitution.unwrap_or(0.0), rocking: rocking.unwrap_or(1.0) }, false)
        }
        Acts::ByStiffness { times, pulls: false } => {
            let [own, closed] = [1.0, times].map(|k| (across * stiffness * k).min(stiffest));
            let (both, press) = if bond.is_some() { (own, (closed - own).max(0.0)) } else { (0.0, closed) };
            (Normal::Springs { both, press, damping: dashpot(across * given) }, true)
        }
        Acts::ByStiffness { .. } | Acts::Not => {
            let both = (across * stiffness * pulling(spring)).min(stiffest);
            (Normal::Springs { both, press: 0.0, damping: dashpot(across * given) }, false)
        }
    };
    let shear = match spring.acts() {
        Acts::Rigidly if crushing.is_finite() => Shear { stiffness: rigid, damping: dashpot(rigid), series },
        Acts::Rigidly => Shear { stiffness: 0.0, damping: 0.0, series: false },
        _ => Shear { stiffness: along * stiffness * pulling(spring), damping: dashpot(along * given), series },
    };
    Law {
        normal,
        shear,
        friction: law.rubs().map(friction),
        bond,
        crushing,
        slip: [0.0; 2],
        device: None,
        follows: false,
    }
}

/// Energy of a spring at its strength [J].
fn stored(strength: f64, stiffness: f64) -> f64 {
    0.5 * strength * strength / stiffness
}

/// Refuses bonds that store more at their strength than breaking takes, in either direction and under the pressure at rest.
fn softening(wall: &Wall, joints: &[Joint], laws: &[JointLaw], normal: &[[f64; 2]]) -> Result<()> {
    let mut snaps = Snaps::default();
    for (number, (joint, law)) in joints.iter().zip(laws).enumerate() {
        let stiffness = law.stiffness(joint, wall) * law.spring.stiffness_factor;
        let springs = law.spring.law.has_springs() && stiffness > 0.0;
        let Some(values) = law.strong_bond().filter(|_| springs) else { continue };
        let (area, ways) = (joint.area(wall), ways(joint, law));
        let pressure = if joint.kind.is_upright() { 0.0 } else { normal[number][0] / area };
        let shear = values.cohesion + pressure * values.tan_angle;
        for (mode, strength) in [values.tensile_strength, shear].into_iter().enumerate() {
            // Of shear the part that goes.
            let goes = if mode == 1 { 1.0 - values.residual } else { 1.0 };
            let (least, given) = (goes * stored(strength * area, ways[mode] * stiffness) / area, values.energy[mode]);
            if given > 0.0 && (given <= least || goes == 0.0) {
                snaps.add(mode, Snap { joint: number, least, given, whole: goes == 0.0 });
            }
        }
    }
    snaps.refused(wall, joints)
}

/// Stiffnesses across and along over that of the wall file, which is that of the shear model: along a bed joint, across a head
/// joint.
fn ways(joint: &Joint, law: &JointLaw) -> [f64; 2] {
    let ratio = law.spring.normal_to_shear;
    if joint.kind.is_upright() { [1.0, 1.0 / ratio] } else { [ratio, 1.0] }
}

/// A device lies in the plane of a bed joint, which bears pressure beside it, and across a head joint, which bears nothing
/// else.
fn device_law(joint: &Joint, device: &Device) -> Law {
    let Elastic { stiffness, damping, .. } = device::elastic(device);
    let slip = device.slip_force.filter(|_| device.law == DeviceLaw::FrictionDamper).map_or(0.0, |f| f.si());
    let own = |direction| device::nonlinear(device).map(|law| joint::Device { direction, law });
    match joint.kind.is_upright() {
        true => {
            let normal = Normal::Springs { both: stiffness, press: 0.0, damping };
            Law { normal, slip: [slip, 0.0], device: own(0), follows: true, ..Law::dry(None) }
        }
        false => {
            let shear = Shear { stiffness, damping, series: false };
            Law { shear, slip: [0.0, slip], device: own(1), ..Law::dry(None) }
        }
    }
}

fn friction(law: Stribeck) -> Friction {
    let Stribeck { static_, dynamic, slip_velocity, alpha, .. } = law;
    Friction { static_, dynamic, slip_velocity, alpha }
}

/// What blocks rub with that come to touch where there was no joint.
fn common_friction(case: &Case) -> Option<Friction> {
    use crate::case::FrictionLaw;
    let f = &case.joint.friction;
    let slip_velocity = if f.law == FrictionLaw::Coulomb { 0.0 } else { f.slip_velocity.si() };
    (f.law != FrictionLaw::None).then_some(Friction {
        static_: f.static_,
        dynamic: f.dynamic,
        slip_velocity,
        alpha: f.alpha,
    })
}

/// The wall at rest under its loads, and how it takes them. What does not come to rest moves on in the run, from where it was laid.
pub(crate) fn standing(planar: &Planar) -> (Motion, Rest) {
    let setting = Setting { still: planar.still, ..Setting::new(planar.step) };
    let mut motion = Motion::new(&planar.system, setting.clone());
    let least = planar.system.bodies.iter().map(Body::height).fold(f64::INFINITY, f64::min);
    let most = if motion.stand(STANDS, SETTLING) { FELL } else { FALLING };
    let settled = motion.strayed_by(&planar.system);
    // What is no number has not stood.
    if settled <= most * least {
        let has_cracked = |e: &usize| motion.crack(*e).is_some_and(|crack| crack.cracked.is_finite());
        let cracked = (0..planar.system.links.len()).filter(has_cracked).count();
        let unsolved = motion.unsettled;
        return (motion, Rest::Stands { settled, cracked, unsolved });
    }
    let rest = if settled <= FELL * least { Rest::Settles(settled) } else { Rest::Falls };
    (Motion::new(&planar.system, setting), rest)
}
