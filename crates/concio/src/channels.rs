//! Channels of a run: what they are, and how to read them off a state.

use std::collections::HashMap;

use concio_law::motion::{Drive, Excitation as _};
use concio_mechanisms::rocking::Moved;
use concio_planar::motion::Seen;
use concio_shear::dynamics::{Acting, borne_by, joint_forces, peak};
use concio_shear::state::View;

use crate::bond::BondState;
use crate::case::DeviceLaw;
use crate::error::{InputError, Result};
use crate::model::{Model, System};
use crate::record::{Channel, Energies};
use crate::wall::JointKind;

/// A selected history beyond the ones that are always kept.
#[derive(Debug, Clone, Copy)]
enum Watched {
    Block(usize),
    /// With its index among the joints that rub, the rigid ones and the devices with laws of their own, and that among
    /// the bonds.
    Joint(usize, [Option<usize>; 3], Option<usize>),
}

/// The channels of a run: what they are and how to read them off a state.
#[derive(Debug, Clone)]
pub struct Channels {
    watched: Vec<Watched>,
}

const ALWAYS: [(&str, &str, &str); 10] = [
    ("base/acceleration", "m/s2", "absolute acceleration of the base"),
    ("base/displacement", "m", "absolute displacement of the base"),
    ("base/shear", "N", "horizontal force of the base on the wall"),
    ("top/displacement", "m", "mean displacement of the top courses relative to the base"),
    ("top/velocity", "m/s", "mean velocity of the top courses relative to the base"),
    ("top/force", "N", "horizontal force of the top beam on the wall"),
    ("beam/displacement", "m", "displacement of the top beam relative to the base"),
    ("beam/velocity", "m/s", "velocity of the top beam relative to the base"),
    ("beam/acceleration", "m/s2", "acceleration of the top beam relative to the base"),
    ("peak/displacement", "m", "largest absolute displacement of a block relative to the base at the moment"),
];
const ENERGIES: [(&str, &str); 11] = [
    ("input", "work done on the wall by base and top motion"),
    ("kinetic", "kinetic energy of the motion relative to the base"),
    ("elastic", "elastic energy of the joints"),
    ("damping", "dissipated by viscous damping"),
    ("friction", "dissipated by friction"),
    ("bond", "dissipated by the breaking of bonds"),
    ("device", "dissipated by the hysteresis of devices"),
    ("impact", "lost in the impacts of rigid joints"),
    ("nonreciprocal", "taken out by friction whose action differs from its reaction"),
    ("residual", "kinetic + elastic + dissipated - input"),
    ("top", "part of input that a driven top beam brings"),
];
const BLOCK: [(&str, &str, &str); 3] = [
    ("displacement", "m", "displacement relative to the base"),
    ("velocity", "m/s", "velocity relative to the base"),
    ("acceleration", "m/s2", "acceleration relative to the base"),
];
const JOINT: [(&str, &str, &str); 5] = [
    ("slip", "m", "relative displacement (gap of a head joint: positive is open)"),
    ("velocity", "m/s", "relative velocity (positive opens a head joint)"),
    (
        "elastic",
        "N",
        "elastic force, or that of rigid contact, on the lower or left block, against its relative motion",
    ),
    ("damping", "N", "viscous force, same sign"),
    ("friction", "N", "friction force, or that of a device with a law of its own, same sign"),
];

/// What they are of a rocking wall, where that is not what they are of others. Its section has x inwards.
const ROCKING: [(&str, &str); 10] = [
    ("base/acceleration", "absolute acceleration of the base, inwards"),
    ("base/displacement", "absolute displacement of the base, inwards"),
    ("base/shear", "horizontal force of hinges and side walls on the wall, inwards"),
    ("top/displacement", "displacement of the control point relative to the base, outwards"),
    ("top/velocity", "velocity of the control point relative to the base, outwards"),
    (
        "peak/displacement",
        "largest displacement of control point and centres of bodies relative to the base at the moment",
    ),
    ("energy/elastic", "energy of place of weights and thrusts, and elastic energy of ties"),
    ("energy/friction", "dissipated by friction of side walls and seats"),
    ("energy/bond", "gone with floors that lost their seat"),
    ("energy/device", "dissipated by ties that yielded or broke"),
];

/// Beside them, of the blocks of planar and rocking walls.
const PLANAR_BLOCK: [(&str, &str, &str); 2] = [
    ("vertical", "m", "how far the centre has risen"),
    ("rotation", "rad", "rotation about the centre, counterclockwise"),
];

/// Beside those of joints, of the joints of planar walls.
const PLANAR_JOINT: [(&str, &str, &str); 2] = [
    ("opening", "m", "widest distance of the sides along the joint, from 0"),
    ("pressure", "N", "normal force, compression positive"),
];

/// Beside them, of joints with a bond.
const DAMAGE: (&str, &str, &str) = ("damage", "1", "damage of the bond: part of its stiffness that is lost, 0 to 1");

impl Channels {
    /// The channels for the block and joint names asked for (`all` for every one).
    ///
    /// # Errors
    /// A name that no block or joint bears.
    pub fn new(model: &Model, blocks: &[String], joints: &[String]) -> Result<(Self, Vec<Channel>)> {
        let block_names: Vec<String> = model.wall.blocks.iter().map(|b| b.name.clone()).collect();
        let joint_names = model.joint_names();
        let rocks = matches!(model.system, System::Rocking(_));
        let chosen_blocks = match rocks {
            true => (0..block_names.len()).collect(),
            false => chosen("output.blocks", "block", blocks, &block_names)?,
        };
        let mut watched: Vec<Watched> = chosen_blocks.into_iter().map(Watched::Block).collect();
        let system = &model.shear;
        let (rub, contact, bond) = (system.rub_of_joint(), system.contact_of_joint(), system.bond_of_joint());
        let device = system.nonlinear_of_joint();
        let turns = model.turns();
        let joint = |e: usize| Watched::Joint(e, [rub[e], contact[e], device[e]], bond[e]);
        watched.extend(chosen("output.joints", "joint", joints, &joint_names)?.into_iter().map(joint));
        let channel =
            |name: String, unit: &str, text: &str| Channel { name, unit: unit.into(), description: text.into() };
        let mut list: Vec<Channel> = ALWAYS.iter().map(|(n, u, d)| channel((*n).into(), u, d)).collect();
        list.extend(ENERGIES.iter().map(|(n, d)| channel(format!("energy/{n}"), "J", d)));
        for w in &watched {
            match *w {
                Watched::Block(i) => {
                    let of_planar = turns.then_some(&PLANAR_BLOCK).into_iter().flatten();
                    let name = &block_names[i];
                    list.extend(
                        BLOCK.iter().chain(of_planar).map(|(n, u, d)| channel(format!("block/{name}/{n}"), u, d)),
                    );
                }
                Watched::Joint(e, _, bond) => {
                    let of_bond = bond.map(|_| &DAMAGE);
                    let of_planar = turns.then_some(&PLANAR_JOINT).into_iter().flatten();
                    list.extend(
                        JOINT
                            .iter()
                            .chain(of_planar)
                            .chain(of_bond)
                            .map(|(n, u, d)| channel(format!("joint/{}/{n}", joint_names[e]), u, d)),
                    );
                }
            }
        }
        for (name, text) in ROCKING.iter().filter(|_| rocks) {
            if let Some(channel) = list.iter_mut().find(|channel| channel.name == *name) {
                channel.description = (*text).into();
            }
        }
        Ok((Channels { watched }, list))
    }

    /// [`Channels::sample`] of a rocking wall.
    pub(crate) fn sample_rocking(&self, at: &RockingRow, row: &mut Vec<f64>) {
        let Moved { displacement: [out, _], velocity, .. } = at.control;
        row.extend([at.ground[0], at.ground[1], at.shear, out, velocity, 0.0]);
        row.extend([0.0; 3]);
        row.push(at.moved.iter().fold(out.abs(), |most, m| most.max(m.displacement[0].abs())));
        push_energies(at.energies, row);
        for w in &self.watched {
            if let Watched::Block(i) = *w {
                let Moved { displacement: [out, up], velocity, acceleration: [acceleration, _], rotation } =
                    at.moved[i];
                // No zero has a sign.
                row.extend([0.0 - out, 0.0 - velocity, 0.0 - acceleration, up, rotation]);
            }
        }
    }

    /// [`Channels::sample`] of a planar wall.
    pub(crate) fn sample_planar(&self, model: &Model, at: Row, row: &mut Vec<f64>) {
        let mean = |values: &[f64]| model.shear.tops.of_courses(|i| values[i]);
        let base = model.excitation.drive(at.t).base(at.t);
        row.extend([base.a, base.u, at.shear, mean(at.z), mean(at.v), at.pull]);
        row.extend(model.floating_beam().map_or([0.0; 3], |beam| [at.z[beam], at.v[beam], at.a[beam]]));
        row.push(peak(&at.z[..model.wall.blocks.len()]));
        push_energies(at.energies, row);
        for w in &self.watched {
            match *w {
                Watched::Block(i) => row.extend([at.z[i], at.v[i], at.a[i], at.vertical[i], at.rotation[i]]),
                Watched::Joint(e, index, bond) => {
                    let (seen, kind) = (&at.seen[e], model.joints[e].kind);
                    let sign = turned(kind);
                    let (moved, speed, force) = match kind.is_upright() {
                        true => (seen.gap[1], seen.parting, seen.pressure),
                        false => (sign * seen.slide, sign * seen.speed, -sign * (seen.shear - seen.friction)),
                    };
                    let device = model.devices.binary_search_by_key(&(e as u32), |device| device.joint);
                    row.extend([moved, speed]);
                    row.extend(match device.map(|k| model.devices[k].law) {
                        Err(_) => [force, 0.0, -sign * seen.friction],
                        Ok(law) => {
                            let whole = if kind.is_upright() { seen.pressure } else { -sign * seen.shear };
                            match law {
                                DeviceLaw::Elastic => [whole, 0.0, 0.0],
                                DeviceLaw::Viscous if index[2].is_none() => [0.0, whole, 0.0],
                                _ => [0.0, 0.0, whole],
                            }
                        }
                    });
                    row.extend([seen.gap[1].max(0.0), seen.pressure]);
                    row.extend(bond.map(|b| at.bonds[b].damage));
                }
            }
        }
    }

    /// Appends one row of values.
    pub fn sample(&self, model: &Model, drive: &Drive, at: View, row: &mut Vec<f64>) {
        let system = &model.shear;
        let beam = model.floating_beam().unwrap_or(system.top());
        let [shear, pull] =
            [&system.on_base, &system.on_beam].map(|support| 0.0 - borne_by(system, support, Acting::of(at)));
        let mean = |values: &[f64]| system.tops.of_courses(|i| values[i]);
        let base = drive.base(at.t);
        let energies = at.energies;
        row.extend([base.a, base.u, shear, mean(at.z), mean(at.v), pull]);
        row.extend([at.z[beam], at.v[beam], at.a[beam]]);
        row.push(peak(&at.z[..model.wall.blocks.len()]));
        push_energies(energies, row);
        for w in &self.watched {
            match *w {
                Watched::Block(i) => row.extend([at.z[i], at.v[i], at.a[i]]),
                Watched::Joint(e, index, bond) => {
                    let [a, b] = system.sides[e].map(|s| s as usize);
                    let sign = if model.joints[e].kind.is_upright() { -1.0 } else { 1.0 };
                    let (elastic, viscous, friction) = joint_forces(system, at, index, e);
                    let (d, v) = (at.z[a] - at.z[b], at.v[a] - at.v[b]);
                    let bond = bond.map(|b| (&system.bonds[b], at.bonds[b].damage));
                    let elastic = bond.map_or(elastic, |(bond, damage)| bond.force(&system.elastic[e], damage, d));
                    row.extend([sign * d, sign * v, elastic, viscous, friction]);
                    row.extend(bond.map(|(_, damage)| damage));
                }
            }
        }
    }
}

/// The energy channels, in the order of [`ENERGIES`].
fn push_energies(energies: &Energies, row: &mut Vec<f64>) {
    let Energies { input_top, kinetic, elastic, damping, friction, bond, device, impact, nonreciprocal, .. } =
        *energies;
    row.extend([energies.input(), kinetic, elastic, damping, friction, bond, device, impact, nonreciprocal]);
    row.extend([energies.residual(), input_top]);
}

fn chosen(key: &str, what: &str, asked: &[String], names: &[String]) -> Result<Vec<usize>> {
    if asked.iter().any(|a| a == "all") {
        return Ok((0..names.len()).collect());
    }
    let places: HashMap<&String, usize> = names.iter().enumerate().map(|(i, n)| (n, i)).collect();
    let mut indices = Vec::with_capacity(asked.len());
    for name in asked {
        let i = *places.get(name).ok_or_else(|| {
            InputError::new(format!("no {what} is named `{name}`"))
                .key(key)
                .allowed(format!("\"all\", or names as `concio check` draws them, for example {}", names[0]))
        })?;
        indices.push(i);
    }
    Ok(indices)
}

/// What channels of a rocking wall are read off.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RockingRow<'a> {
    /// The control point.
    pub control: Moved,
    /// Acceleration and displacement of the ground inwards [m/s², m].
    pub ground: [f64; 2],
    /// Force of hinges and side walls on the wall, positive inwards [N].
    pub shear: f64,
    pub energies: &'a Energies,
    /// Centres of the bodies.
    pub moved: &'a [Moved],
}

/// What channels of a planar wall are read off.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row<'a> {
    pub t: f64,
    pub z: &'a [f64],
    pub v: &'a [f64],
    pub a: &'a [f64],
    pub vertical: &'a [f64],
    pub rotation: &'a [f64],
    pub seen: &'a [Seen],
    pub bonds: &'a [BondState],
    pub energies: &'a Energies,
    /// Force of the beam, and horizontal force of the base, on the wall [N].
    pub pull: f64,
    pub shear: f64,
}

/// Force along a joint on its lower or left side, against its relative motion [N], of a force on its second side
/// along its tangent; and slip of the way of the second side: base joints have the base as the first side, not the second.
pub(crate) fn turned(kind: JointKind) -> f64 {
    if kind == JointKind::Base { -1.0 } else { 1.0 }
}
