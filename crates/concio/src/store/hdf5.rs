//! One HDF5 file per run: `result.h5`. docs/results.md lists every dataset with shape and unit.

use std::path::Path;

use crate::drift::DriftRow;
use crate::error::{Error, Result};
use crate::files;
use crate::outcome::{Before, Collapse, Outcome, TieRow};
use crate::record::{Event, Layout, Recording};
use crate::store::digest;
use crate::store::fields::{self, FORMAT, Field, Frames, NO_FRICTION, check_lengths, device_name, keyword, other_side};
use crate::store::h5::{Sink, label};
use crate::store::outlines::{self, Outlines};
use crate::store::{FrictionRow, JointRow, Provenance, SCHEMA_VERSION, vtkhdf};
use crate::wall::{Block, PanelInfo, Wall};

pub use crate::store::read::{inputs_hash, read};

/// Writes a run to `path`, its [`digest`] behind it: whole or not at all, replacing a file of that name. Equal arguments give
/// equal bytes.
///
/// # Errors
/// [`Error::Store`] when lengths in `outcome` contradict each other or `wall`; [`Error::Io`] when the disk fails.
pub fn write(path: &Path, provenance: &Provenance, wall: &Wall, joints: &[JointRow], outcome: &Outcome) -> Result<()> {
    check_lengths(path, wall, joints, outcome)?;
    files::replace(path, |temporary| {
        let mut sink = Sink::create(temporary, path)?;
        write_head(&mut sink, provenance, outcome)?;
        write_wall(&mut sink, wall)?;
        write_joints(&mut sink, joints)?;
        write_layout(&mut sink, &outcome.layout)?;
        write_history(&mut sink, &outcome.layout, &outcome.recording)?;
        write_frames(&mut sink, &outcome.layout, &outcome.recording)?;
        write_bonds(&mut sink, outcome)?;
        write_drifts(&mut sink, &outcome.drifts)?;
        write_ties(&mut sink, &outcome.ties)?;
        write_collapse(&mut sink, outcome.totals.collapse.as_ref())?;
        write_events(&mut sink, &outcome.recording.events)?;
        write_sums(&mut sink, outcome)?;
        vtkhdf::write_group(&mut sink, wall, outcome)?;
        sink.close()?;
        digest::append(temporary).map_err(|e| Error::io(path, e))
    })
}

fn write_head(sink: &mut Sink, provenance: &Provenance, outcome: &Outcome) -> Result<()> {
    sink.attribute("/", "format", FORMAT)?;
    sink.number_attribute("/", "schema_version", i64::from(SCHEMA_VERSION))?;
    sink.attribute("/", "version", &provenance.version)?;
    sink.attribute("/", "model", &provenance.model)?;
    sink.attribute("/", "inputs_hash", &provenance.inputs_hash)?;
    sink.attribute("/", "stop_reason", &keyword(&outcome.stop_reason))?;
    sink.number_attribute("/", "time_reached", outcome.time_reached)?;
    // Once more as a dataset: `rust-hdf5` reads numbers from attributes of datasets only, not of groups.
    sink.number("schema_version", SCHEMA_VERSION, label("1", "Version of the layout of this file."))?;
    sink.texts("case", &[&provenance.case_json], "The resolved case, JSON.")
}

fn write_wall(sink: &mut Sink, wall: &Wall) -> Result<()> {
    let blocks = &wall.blocks;
    sink.texts("wall/blocks/name", &names(blocks, |b| &b.name), "Name of the block.")?;
    let number = |of: fn(&Block) -> usize| blocks.iter().map(|b| of(b) as i64).collect::<Vec<_>>();
    sink.list("wall/blocks/panel", &number(|b| b.panel), label("1", "Panel, from 0."))?;
    sink.list("wall/blocks/course", &number(|b| b.course), label("1", "Course in the panel, from 0 at the bottom."))?;
    let mass: Vec<f64> = blocks.iter().map(Block::mass).collect();
    sink.list("wall/blocks/mass", &mass, label("kg", "Mass."))?;
    write_columns(sink, "wall/blocks", &fields::BLOCKS, blocks)?;
    write_outlines(sink, blocks)?;

    let panels: &[PanelInfo] = &wall.panels;
    sink.texts("wall/panels/name", &names(panels, |p| &p.name), "Name of the panel.")?;
    let courses: Vec<i64> = panels.iter().map(|p| p.courses as i64).collect();
    sink.list("wall/panels/courses", &courses, label("1", "Number of courses."))?;
    write_columns(sink, "wall/panels", &fields::PANELS, panels)
}

fn write_outlines(sink: &mut Sink, blocks: &[Block]) -> Result<()> {
    let outlines = Outlines::of(blocks);
    let start = label("1", "First corner of the block in corners; one entry more than blocks, the number of corners.");
    sink.list(outlines::START, &outlines.starts(), start)?;
    let corners = label("m", "Corners of the blocks, x and y, counterclockwise.");
    sink.array(outlines::CORNERS, &[outlines.corners.len(), 2], outlines.corners.as_flattened(), corners)?;
    let span: Vec<i64> = blocks.iter().map(|b| b.span() as i64).collect();
    sink.list(outlines::SPAN, &span, label("1", "Courses that the block takes up: 1 but for lintels."))
}

fn write_joints(sink: &mut Sink, joints: &[JointRow]) -> Result<()> {
    sink.texts("wall/joints/name", &names(joints, |j| &j.name), "Name of the joint.")?;
    let kinds: Vec<String> = joints.iter().map(|j| keyword(&j.joint.kind)).collect();
    sink.texts("wall/joints/kind", &kinds, "bed, head, base, top or connection.")?;
    let laws: Vec<String> = joints.iter().map(|j| keyword(&j.law)).collect();
    sink.texts("wall/joints/law", &laws, "Elastic law.")?;
    let devices: Vec<&str> = joints.iter().map(|j| device_name(j.device)).collect();
    sink.texts("wall/joints/device", &devices, "Law of the device in the place of mortar, or none.")?;
    let a: Vec<i64> = joints.iter().map(|j| j.joint.a as i64).collect();
    sink.list("wall/joints/a", &a, label("1", "Index of the block on one side: left, or lower."))?;
    let b: Vec<i64> = joints.iter().map(|j| other_side(j.joint.b)).collect();
    sink.list("wall/joints/b", &b, label("1", "Index of the block on the other side; -1 the base, -2 the top beam."))?;
    write_columns(sink, "wall/joints", &fields::JOINTS, joints)?;

    let friction: Vec<FrictionRow> = joints.iter().map(|j| j.friction.unwrap_or(NO_FRICTION)).collect();
    let rubs: Vec<u8> = joints.iter().map(|j| u8::from(j.friction.is_some())).collect();
    sink.list("wall/joints/friction", &rubs, label("1", "1 when the joint rubs, else 0."))?;
    let laws: Vec<String> = friction.iter().map(|f| keyword(&f.law)).collect();
    sink.texts("wall/joints/friction_law", &laws, "Friction law.")?;
    write_columns(sink, "wall/joints", &fields::FRICTION, &friction)
}

fn names<T>(items: &[T], name: fn(&T) -> &String) -> Vec<&str> {
    items.iter().map(|item| name(item).as_str()).collect()
}

fn write_columns<T>(sink: &mut Sink, group: &str, columns: &[Field<T, f64>], items: &[T]) -> Result<()> {
    for column in columns {
        let values: Vec<f64> = items.iter().map(|item| *(column.get)(item)).collect();
        sink.list(&format!("{group}/{}", column.name), &values, label(column.unit, column.description))?;
    }
    Ok(())
}

fn write_layout(sink: &mut Sink, layout: &Layout) -> Result<()> {
    sink.number("layout/interval", layout.interval, label("s", "Interval of the samples."))?;
    sink.number("layout/samples", layout.samples as u64, label("1", "Samples of the whole run, the first included."))?;
    sink.number("layout/frame_every", layout.frame_every as u64, label("1", "Samples from frame to frame; 0: none."))?;
    sink.number("layout/unknowns", layout.unknowns as u64, label("1", "Unknowns: blocks, then the beam's."))?;
    let held =
        label("1", "Joints whose friction the frames hold: all where a law is set-valued or a joint bonded, else 0.");
    sink.number("layout/held", layout.held as u64, held)?;
    let turned = label("1", "Unknowns whose rise and rotation the frames hold: all in the planar model, else 0.");
    sink.number("layout/turned", layout.turned as u64, turned)?;
    let touching =
        label("1", "Joints whose slip, opening and pressure the frames hold: all in the planar model, else 0.");
    sink.number("layout/touching", layout.touching as u64, touching)?;
    let names: Vec<&str> = layout.channels.iter().map(|c| c.name.as_str()).collect();
    sink.texts("layout/channels", &names, "Names of the channels, in order.")?;
    sink.texts("layout/paths", &fields::channel_paths(&layout.channels), "Where each channel is, under /history.")
}

fn write_history(sink: &mut Sink, layout: &Layout, recording: &Recording) -> Result<()> {
    sink.list("history/time", &recording.time, label("s", "Time of the samples."))?;
    let width = layout.channels.len();
    let mut column = Vec::with_capacity(recording.time.len());
    for (index, (channel, path)) in layout.channels.iter().zip(fields::channel_paths(&layout.channels)).enumerate() {
        column.clear();
        column.extend(recording.values.chunks_exact(width).map(|row| row[index]));
        sink.list(&format!("history/{path}"), &column, label(&channel.unit, &channel.description))?;
    }
    Ok(())
}

fn write_frames(sink: &mut Sink, layout: &Layout, recording: &Recording) -> Result<()> {
    sink.list("frames/time", &recording.frame_time, label("s", "Time of the frames."))?;
    for Frames { field, width } in fields::FRAMES.iter().filter(|f| f.is_in(layout)) {
        let shape = [recording.frame_time.len(), width(layout)];
        let name = format!("frames/{}", field.name);
        sink.array(&name, &shape, (field.get)(recording), label(field.unit, field.description))?;
    }
    Ok(())
}

/// Nothing where no joint is bonded.
fn write_bonds(sink: &mut Sink, outcome: &Outcome) -> Result<()> {
    let bonds = &outcome.bonds;
    if bonds.is_empty() {
        return Ok(());
    }
    let joints: Vec<i64> = bonds.iter().map(|b| b.joint as i64).collect();
    sink.list("bonds/joint", &joints, label("1", "Index of the joint."))?;
    write_columns(sink, "bonds", &fields::BONDS, bonds)
}

fn write_drifts(sink: &mut Sink, drifts: &[DriftRow]) -> Result<()> {
    sink.texts("drift/top", &names(drifts, |d| &d.top), "Name of the panel, or beam.")?;
    write_columns(sink, "drift", &fields::DRIFTS, drifts)
}

/// Nothing where there are none.
fn write_ties(sink: &mut Sink, ties: &[TieRow]) -> Result<()> {
    if ties.is_empty() {
        return Ok(());
    }
    sink.texts("ties/from", &names(ties, |t| &t.from), "What one end is fixed to, base first.")?;
    sink.texts("ties/to", &names(ties, |t| &t.to), "The block that the other end is fixed to.")?;
    write_columns(sink, "ties", &fields::TIES, ties)
}

/// Nothing where the wall did not collapse.
fn write_collapse(sink: &mut Sink, collapse: Option<&Collapse>) -> Result<()> {
    let Some(Collapse { time, block, way, turned, before }) = collapse else { return Ok(()) };
    sink.number("collapse/time", *time, label("s", "When the first block had fallen or turned over."))?;
    sink.number("collapse/block", *block as i64, label("1", "Index of that block."))?;
    sink.number("collapse/displacement", *way, label("m", "Its displacement then."))?;
    sink.number(
        "collapse/turned",
        u8::from(*turned),
        label("1", "1 where it had turned over, 0 where it had fallen."),
    )?;
    let Some(Before { residual, steps, unsolved, moving }) = before else { return Ok(()) };
    let told = "Largest residual of the energy account until then over the largest energy in play.";
    sink.number("collapse/before/residual", *residual, label("1", told))?;
    sink.number("collapse/before/steps", *steps, label("1", "Steps until then."))?;
    sink.number(
        "collapse/before/unsolved",
        *unsolved,
        label("1", "Steps until then whose contact was left unsolved."),
    )?;
    let told = "Steps without inertia until then that ended before the wall had come to rest.";
    sink.number("collapse/before/moving", *moving, label("1", told))
}

/// Nothing where nothing happened: other readers refuse a list of no texts.
fn write_events(sink: &mut Sink, events: &[Event]) -> Result<()> {
    if events.is_empty() {
        return Ok(());
    }
    let numbers = |of: fn(&Event) -> f64| events.iter().map(of).collect::<Vec<_>>();
    let joints: Vec<i64> = events.iter().map(|e| i64::from(e.joint)).collect();
    let kinds: Vec<String> = events.iter().map(|e| keyword(&e.kind)).collect();
    sink.list("events/time", &numbers(|e| e.time), label("s", "When it happened."))?;
    sink.list("events/joint", &joints, label("1", "Index of the joint."))?;
    sink.texts("events/kind", &kinds, "What happened.")?;
    let value = label(
        "SI",
        "Impulse of an impact [N s]; stretch of a bond that cracks or is broken, depth of the first crushing, displacement of a block in a collapse [m].",
    );
    sink.list("events/value", &numbers(|e| e.value), value)
}

fn write_sums(sink: &mut Sink, outcome: &Outcome) -> Result<()> {
    for (group, envelopes) in
        [("envelope/block", &fields::BLOCK_ENVELOPES[..]), ("envelope/joint", &fields::JOINT_ENVELOPES[..])]
    {
        for field in envelopes {
            let values = (field.get)(&outcome.envelopes);
            sink.list(&format!("{group}/{}", field.name), values, label(field.unit, field.description))?;
        }
    }
    write_numbers(sink, "energy", &fields::ENERGIES, &outcome.energies)?;
    write_numbers(sink, "totals", &fields::TOTALS, &outcome.totals)?;
    write_numbers(sink, "counters", &fields::COUNTERS, &outcome.counters)?;
    sink.number("totals/time_reached", outcome.time_reached, label("s", "Time reached."))
}

/// Every number as a dataset with its unit and as an attribute of its group.
fn write_numbers<T, V>(sink: &mut Sink, group: &str, numbers: &[Field<T, V>], of: &T) -> Result<()>
where
    V: rust_hdf5::H5Type,
{
    for field in numbers {
        let value = *(field.get)(of);
        sink.number(&format!("{group}/{}", field.name), value, label(field.unit, field.description))?;
        sink.number_attribute(group, field.name, value)?;
    }
    Ok(())
}
