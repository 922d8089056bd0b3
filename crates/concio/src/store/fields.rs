//! Tables of the quantities a result holds: name on disk, unit, meaning, and where they are kept. Writer, reader and
//! exports go through the same tables, so that none of them can forget a quantity that the others know.

use std::collections::BTreeSet;
use std::path::Path;

use serde::Serialize;

use crate::bond::BondRow;
use crate::case::{DeviceLaw, FrictionLaw};
use crate::drift::DriftRow;
use crate::error::{Error, Result};
use crate::outcome::{Outcome, TieRow, Totals};
use crate::record::{Channel, Counters, Energies, Envelopes, Layout, Recording};
use crate::store::{FrictionRow, JointRow};
use crate::wall::{Block, End, PanelInfo, Wall};

/// A quantity of type `V` kept in a `T`.
pub(super) struct Field<T, V> {
    /// Name on disk.
    pub name: &'static str,
    /// SI unit, `1` when there is none.
    pub unit: &'static str,
    /// One sentence.
    pub description: &'static str,
    /// Reads it.
    pub get: fn(&T) -> &V,
    /// Where it is kept.
    pub slot: fn(&mut T) -> &mut V,
}

/// A quantity of which a frame holds one row.
pub(super) struct Frames {
    /// The quantity.
    pub field: Field<Recording, Vec<f64>>,
    /// Length of a row. Where it is 0 nothing is stored, but for the motion of the unknowns, which every result has.
    pub width: fn(&Layout) -> usize,
}

impl Frames {
    /// Whether a result of that layout holds it.
    pub fn is_in(&self, layout: &Layout) -> bool {
        (self.width)(layout) > 0 || MOTION.contains(&self.field.name)
    }
}

/// Frames that every result holds.
const MOTION: [&str; 3] = ["displacement", "velocity", "acceleration"];

macro_rules! field {
    ($name:literal, $unit:literal, $($member:ident).+ $([$index:literal])?, $description:literal) => {
        Field {
            name: $name,
            unit: $unit,
            description: $description,
            get: |of| &of.$($member).+ $([$index])?,
            slot: |of| &mut of.$($member).+ $([$index])?,
        }
    };
}

macro_rules! frames {
    ($name:literal, $unit:literal, $member:ident, $width:ident, $description:literal) => {
        Frames { field: field!($name, $unit, $member, $description), width: |layout| layout.$width }
    };
}

/// What frames hold beside their time.
pub(super) const FRAMES: [Frames; 10] = [
    frames!(
        "displacement",
        "m",
        frame_displacement,
        unknowns,
        "Horizontal displacement of every unknown relative to the base."
    ),
    frames!("velocity", "m/s", frame_velocity, unknowns, "Horizontal velocity of every unknown relative to the base."),
    frames!(
        "acceleration",
        "m/s2",
        frame_acceleration,
        unknowns,
        "Horizontal acceleration of every unknown relative to the base."
    ),
    frames!("vertical", "m", frame_vertical, turned, "How far the centre of every unknown has risen."),
    frames!("rotation", "rad", frame_rotation, turned, "Rotation of every unknown about its centre, counterclockwise."),
    frames!("friction", "N", frame_friction, held, "Friction force of every joint on its lower or left side."),
    frames!(
        "slip",
        "m",
        frame_slip,
        touching,
        "Sliding along every joint: lower side less upper, left side less right."
    ),
    frames!("opening", "m", frame_opening, touching, "Widest opening of every joint over its length, from 0."),
    frames!("pressure", "N", frame_pressure, touching, "Normal force of every joint, positive in compression."),
    frames!("damage", "1", frame_damage, bonded, "Damage of every bonded joint, 0 to 1, in the order of /bonds."),
];

/// Envelopes with one value per unknown.
pub(super) const BLOCK_ENVELOPES: [Field<Envelopes, Vec<f64>>; 3] = [
    field!("displacement", "m", block_displacement, "Largest displacement relative to the base, sign dropped."),
    field!("velocity", "m/s", block_velocity, "Largest velocity relative to the base, sign dropped."),
    field!("acceleration", "m/s2", block_acceleration, "Largest acceleration relative to the base, sign dropped."),
];

/// Envelopes with one value per joint.
pub(super) const JOINT_ENVELOPES: [Field<Envelopes, Vec<f64>>; 10] = [
    field!("displacement", "m", joint_displacement, "Largest relative displacement of the sides, sign dropped."),
    field!("velocity", "m/s", joint_velocity, "Largest relative velocity of the sides, sign dropped."),
    field!("acceleration", "m/s2", joint_acceleration, "Largest relative acceleration of the sides, sign dropped."),
    field!(
        "slip",
        "m",
        joint_slip,
        "Way slipped: |relative velocity| integrated over the time above the slip velocity."
    ),
    field!(
        "opening",
        "m",
        joint_opening,
        "Widest gap of a head joint or connection; in the planar model of any joint."
    ),
    field!("closing", "m", joint_closing, "Deepest closure of a head joint or connection."),
    field!("force", "N", joint_force, "Largest elastic force, or force of rigid contact, sign dropped."),
    field!("dissipation", "J", joint_dissipation, "Energy dissipated by damping, friction and impacts."),
    field!("impulse", "N s", joint_impulse, "Largest impulse of an impact of a rigid joint."),
    field!("impacts", "1", joint_impacts, "Number of impacts of a rigid joint."),
];

/// The energy account.
pub(super) const ENERGIES: [Field<Energies, f64>; 11] = [
    field!("input_base", "J", input_base, "Work of the base motion on the motion relative to the base."),
    field!("input_top", "J", input_top, "Work of the driven top beam."),
    field!("initial", "J", initial, "Kinetic and elastic energy at t = 0 that no work of the run brought."),
    field!("kinetic", "J", kinetic, "Kinetic energy."),
    field!("elastic", "J", elastic, "Elastic energy of the joints."),
    field!("damping", "J", damping, "Energy dissipated by viscous damping."),
    field!("friction", "J", friction, "Energy dissipated by friction."),
    field!("bond", "J", bond, "Energy dissipated by breaking bonds."),
    field!("device", "J", device, "Energy dissipated by the hysteresis of devices and by ties that yield."),
    field!("impact", "J", impact, "Energy lost in the impacts of rigid joints."),
    field!("nonreciprocal", "J", nonreciprocal, "Energy taken out by friction whose action differs from its reaction."),
];

/// Numbers that sum a run up.
pub(super) const TOTALS: [Field<Totals, f64>; 13] = [
    field!(
        "peak_relative_displacement",
        "m",
        peak_relative_displacement,
        "Largest displacement of a block relative to the base, sign dropped."
    ),
    field!("peak_slip_velocity", "m/s", peak_slip_velocity, "Largest relative velocity of a bed or support joint."),
    field!("peak_friction_force", "N", peak_friction_force, "Largest friction force in a joint, sign dropped."),
    field!("base_shear_peak", "N", base_shear_peak, "Largest horizontal force of the base on the wall, sign dropped."),
    field!("base_shear_time", "s", base_shear_time, "When the base shear first came within 1e-4 of its largest."),
    field!(
        "base_shear_displacement",
        "m",
        base_shear_displacement,
        "Displacement of the top relative to the base then."
    ),
    field!("top_force_peak", "N", top_force_peak, "Largest force of the top beam on the wall, sign dropped."),
    field!("top_force_square", "N2 s", top_force_square, "Time integral of the square of that force."),
    field!("minimum_gap", "m", minimum_gap, "Most negative gap of a head joint or connection, from 0 down."),
    field!(
        "contact_residual",
        "m/s",
        contact_residual,
        "Largest relative velocity left where rigid contact forbids it."
    ),
    field!("peak_input", "J", peak_input, "Largest work done on the wall, sign dropped."),
    field!("peak_work", "J", peak_work, "Largest sum of the works of base, weights and beam, each without its sign."),
    field!("peak_residual", "J", peak_residual, "Largest residual of the energy account, sign dropped."),
];

/// Work of the solver.
pub(super) const COUNTERS: [Field<Counters, u64>; 10] = [
    field!("steps", "1", steps, "Accepted steps."),
    field!("rejected", "1", rejected, "Steps rejected by the error control."),
    field!("failed", "1", failed, "Steps repeated because the iteration did not converge."),
    field!("iterations", "1", iterations, "Iterations on the laws of the joints."),
    field!("factorisations", "1", factorisations, "Matrix factorisations."),
    field!("events", "1", events, "Instants at which something happened that ended a step."),
    field!("located", "1", located, "Attempts at steps that were cut for them."),
    field!("impacts", "1", impacts, "Impacts of rigid joints."),
    field!(
        "unsolved",
        "1",
        unsolved,
        "Steps whose contact was left with more than a hundred times the tolerance, without inertia with more than it."
    ),
    field!("moving", "1", moving, "Steps without inertia that ended before what slowed down had come to rest."),
];

/// Real quantities of a block.
pub(super) const BLOCKS: [Field<Block, f64>; 6] = [
    field!("x0", "m", x[0], "Left edge."),
    field!("x1", "m", x[1], "Right edge."),
    field!("y0", "m", y[0], "Bottom edge."),
    field!("y1", "m", y[1], "Top edge."),
    field!("thickness", "m", thickness, "Thickness out of plane."),
    field!("specific_weight", "N/m3", specific_weight, "Specific weight."),
];

/// Real quantities of a panel.
pub(super) const PANELS: [Field<PanelInfo, f64>; 6] = [
    field!("reference_length", "m", reference_length, "Length of the reference brick."),
    field!("reference_height", "m", reference_height, "Height of the reference brick."),
    field!("reference_mass", "kg", reference_mass, "Mass of the reference brick."),
    field!("bed_mortar", "m", mortar[0], "Thickness of the bed joints."),
    field!("head_mortar", "m", mortar[1], "Thickness of the head joints."),
    field!("connection", "m", connection, "Thickness of the connection to the panel on the left."),
];

/// Real quantities of a joint.
pub(super) const JOINTS: [Field<JointRow, f64>; 12] = [
    field!("weight", "1", joint.weight, "Overlap weight; 1 for head joints."),
    field!("overlap", "m", joint.overlap, "Contact length."),
    field!("x0", "m", joint.line[0], "Contact line, start."),
    field!("y0", "m", joint.line[1], "Contact line, start."),
    field!("x1", "m", joint.line[2], "Contact line, end."),
    field!("y1", "m", joint.line[3], "Contact line, end."),
    field!("stiffness", "N/m", stiffness, "Stiffness as it acts; of planar walls along the joint."),
    field!(
        "normal_stiffness",
        "N/m",
        normal_stiffness,
        "Stiffness across a pressed joint of a planar wall; 0 in shear walls."
    ),
    field!("damping", "N s/m", damping, "Damping, overlap weight included."),
    field!("normal_force_a", "N", normal_force[0], "Normal force in the equation of a."),
    field!("normal_force_b", "N", normal_force[1], "Normal force in the equation of b."),
    field!("restitution", "1", restitution, "Restitution of a rigid joint; 0 for the others."),
];

/// Real quantities of friction.
pub(super) const FRICTION: [Field<FrictionRow, f64>; 5] = [
    field!("friction_static", "1", static_, "Static coefficient; 0 without friction."),
    field!("friction_dynamic", "1", dynamic, "Dynamic coefficient; 0 without friction."),
    field!("friction_slip_velocity", "m/s", slip_velocity, "Slip velocity; 0 without friction."),
    field!("friction_beta", "1", beta, "Slope of the first branch; 0 without friction."),
    field!("friction_alpha", "s2/m2", alpha, "Slope of the slip branch; 0 without friction."),
];

/// Real quantities of a bond.
pub(super) const BONDS: [Field<BondRow, f64>; 11] = [
    field!("strength", "N", strength, "Force at which the joint cracks."),
    field!("stiffness", "N/m", stiffness, "Stiffness of the intact joint; of a head joint in tension."),
    field!("residual_stiffness", "1", residual_stiffness, "Fraction of the stiffness that a cracked joint keeps."),
    field!("energy", "J", energy, "Energy that it takes to break the bond."),
    field!("decay", "m", decay, "Length over which the strength falls; 0 when the bond is brittle."),
    field!("damage", "1", damage, "Damage at the end: part of the stiffness that is lost, 0 to 1."),
    field!("crack", "1", crack, "Part of the joint's length along which it has cracked, 0 to 1."),
    field!("crack_start", "1", crack_start, "Part of it at the joint's left or lower end; the rest is at the other."),
    field!("spent", "J", spent, "Energy that breaking has taken."),
    field!("cracked", "s", cracked, "Time of the first crack; infinite when there was none."),
    field!("broken", "s", broken, "Time at which nothing was left of the bond; infinite when something is."),
];

/// How far a top went.
pub(super) const DRIFTS: [Field<DriftRow, f64>; 5] = [
    field!("height", "m", height, "Height of the top above the base."),
    field!("peak", "m", peak, "Displacement of the top relative to the base when it was farthest."),
    field!("time", "s", time, "When that was."),
    field!(
        "residual",
        "m",
        residual,
        "Mean displacement of the top over the last tenth of the run; infinite when there is none."
    ),
    field!("swing", "m", swing, "By how much it left that mean there at most; infinite when there is none."),
];

/// Real quantities of a tie.
pub(super) const TIES: [Field<TieRow, f64>; 3] = [
    field!("force", "N", force, "Largest force that the tie bore."),
    field!("stretch", "m", stretch, "By how much it has yielded."),
    field!("yielded", "s", yielded, "Time at which it first yielded; infinite when it did not."),
];

/// Where each channel is kept under `/history`: its name, unless HDF5 could not hold it under that name beside the
/// others (an empty part, a name already taken, a name that runs through another channel) – then `channel-N`.
pub(super) fn channel_paths(channels: &[Channel]) -> Vec<String> {
    let mut datasets = BTreeSet::from(["time".to_string()]);
    let mut groups = BTreeSet::new();
    let mut paths = Vec::with_capacity(channels.len());
    for (index, channel) in channels.iter().enumerate() {
        let mut path = channel.name.clone();
        let mut tried = 0;
        while !is_free(&path, &datasets, &groups) {
            path = format!("channel-{index}{}", "-".repeat(tried));
            tried += 1;
        }
        groups.extend(parents(&path).map(str::to_string));
        datasets.insert(path.clone());
        paths.push(path);
    }
    paths
}

fn is_free(path: &str, datasets: &BTreeSet<String>, groups: &BTreeSet<String>) -> bool {
    let sound = path.split('/').all(|part| !part.is_empty() && part != "." && part != "..") && !path.contains('\0');
    sound && !datasets.contains(path) && !groups.contains(path) && !parents(path).any(|p| datasets.contains(p))
}

/// `a`, `a/b` of `a/b/c`.
fn parents(path: &str) -> impl Iterator<Item = &str> {
    path.match_indices('/').map(|(at, _)| &path[..at])
}

/// Value of the attribute `format` of a result file.
pub(super) const FORMAT: &str = "concio-result";

/// `b` of a joint on the base, and of one under the top beam.
pub(super) const BASE: i64 = -1;
/// See [`BASE`].
pub(super) const TOP: i64 = -2;

/// Friction of a joint that does not rub, as it is stored.
pub(super) const NO_FRICTION: FrictionRow =
    FrictionRow { law: FrictionLaw::None, static_: 0.0, dynamic: 0.0, slip_velocity: 0.0, beta: 0.0, alpha: 0.0 };

/// What a result calls the device of a joint without one.
pub(super) const NO_DEVICE: &str = "none";

/// What a result calls the device of a joint.
pub(super) fn device_name(law: Option<DeviceLaw>) -> &'static str {
    law.map_or(NO_DEVICE, DeviceLaw::name)
}

/// The index on disk of a joint's other side.
pub(super) fn other_side(end: End) -> i64 {
    match end {
        End::Block(index) => index as i64,
        End::Base => BASE,
        End::Top => TOP,
    }
}

/// Name of a value of a closed set, as wall files spell it.
pub(super) fn keyword<T: Serialize>(value: &T) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::String(text)) => text,
        // Only sets without data are stored, and those are texts.
        _ => String::new(),
    }
}

/// Nothing is written from an outcome whose arrays contradict each other.
pub(super) fn check_lengths(path: &Path, wall: &Wall, joints: &[JointRow], outcome: &Outcome) -> Result<()> {
    let (layout, recording) = (&outcome.layout, &outcome.recording);
    let unknowns = layout.unknowns;
    let refuse = |what: String| Err(Error::Store { path: path.to_path_buf(), what });
    let expect = |what: &str, found: usize, expected: usize| {
        let message = || format!("not written: {what} has {found} values where {expected} are expected");
        if found == expected { Ok(()) } else { refuse(message()) }
    };
    if unknowns < wall.blocks.len() {
        return refuse(format!("not written: {unknowns} unknowns for {} blocks", wall.blocks.len()));
    }
    expect("histories", recording.values.len(), recording.time.len() * layout.channels.len())?;
    if let Some(what) = layout_against(layout, joints.len()) {
        return refuse(format!("not written: {what}"));
    }
    for Frames { field, width } in &FRAMES {
        let expected = recording.frame_time.len() * width(layout);
        expect(&format!("frames of {}", field.name), (field.get)(recording).len(), expected)?;
    }
    expect("list of bonds", outcome.bonds.len(), layout.bonded)?;
    if let Some(bond) = outcome.bonds.iter().find(|b| b.joint >= joints.len()) {
        return refuse(format!("not written: a bond of joint {} of {}", bond.joint, joints.len()));
    }
    if let Some(event) = recording.events.iter().find(|e| e.joint as usize >= joints.len()) {
        return refuse(format!("not written: an event names joint {} of {}", event.joint, joints.len()));
    }
    for field in &BLOCK_ENVELOPES {
        expect(field.name, (field.get)(&outcome.envelopes).len(), unknowns)?;
    }
    for field in &JOINT_ENVELOPES {
        expect(field.name, (field.get)(&outcome.envelopes).len(), joints.len())?;
    }
    Ok(())
}

/// What contradicts itself in a layout for so many joints: either all of them, or all bodies, are held, or none.
pub(super) fn layout_against(layout: &Layout, joints: usize) -> Option<String> {
    let Layout { unknowns, turned, touching, .. } = *layout;
    if turned != 0 && turned != unknowns {
        return Some(format!("{turned} rotations for {unknowns} unknowns"));
    }
    (touching != 0 && touching != joints).then(|| format!("{touching} slips for {joints} joints"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths_of(names: &[&str]) -> Vec<String> {
        let channel = |n: &&str| Channel { name: n.to_string(), unit: "m".into(), description: String::new() };
        channel_paths(&names.iter().map(channel).collect::<Vec<_>>())
    }

    #[test]
    fn ordinary_names_are_paths() {
        let names = ["top/displacement", "joint/p1c1b1|p1c2b1/slip", "energy/friction"];
        assert_eq!(paths_of(&names), names);
    }

    #[test]
    fn names_that_cannot_be_paths_are_numbered() {
        assert_eq!(paths_of(&["a/b", "a", "a/b/c", "time"]), ["a/b", "channel-1", "channel-2", "channel-3"]);
        assert_eq!(paths_of(&["", "/x", "a//b", "./a"]), ["channel-0", "channel-1", "channel-2", "channel-3"]);
        assert_eq!(paths_of(&["a", "a", "a\0b"]), ["a", "channel-1", "channel-2"]);
        assert_eq!(paths_of(&["channel-1", "channel-1"]), ["channel-1", "channel-1-"]);
        assert_eq!(paths_of(&["channel-1/a", "channel-1", "channel-\0"]), ["channel-1/a", "channel-1-", "channel-2"]);
    }
}
