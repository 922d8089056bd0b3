//! Reading a result file back. A file that is foreign, broken, cut short or from a later version is an error.

use std::path::Path;

use serde::Deserialize;
use serde::de::IntoDeserializer;
use serde::de::value::{Error as KeywordError, StrDeserializer};

use crate::bond::BondRow;
use crate::case::{DeviceLaw, JointKind};
use crate::drift::DriftRow;
use crate::error::{Error, Result};
use crate::outcome::{Before, Collapse, Outcome, TieRow, Totals};
use crate::record::{Channel, Counters, Energies, Envelopes, Event, EventKind, Layout, Recording};
use crate::store::fields::{self, BASE, FORMAT, Field, Frames, NO_DEVICE, NO_FRICTION, TOP, layout_against};
use crate::store::h5::Source;
use crate::store::outlines;
use crate::store::{FrictionRow, JointRow, Provenance, SCHEMA_VERSION, StoredRun, digest};
use crate::wall::{Block, End, Joint, PanelInfo, Wall};

/// Reads a run back from `path`, bit for bit what was written.
///
/// # Errors
/// [`Error::Store`] when the file is not a whole result of this schema version, or not what was written;
/// [`Error::Io`] when it cannot be opened.
pub fn read(path: &Path) -> Result<StoredRun> {
    let digest = digest::check(path)?;
    let source = Source::open(path)?;
    let schema_version = check_format(&source)?;
    if digest.is_none() {
        // Said after the version: files of earlier ones have no digest.
        return Err(Error::Store { path: path.to_path_buf(), what: digest::CHANGED.into() });
    }
    let panels = read_panels(&source)?;
    let wall = Wall { blocks: read_blocks(&source, panels.len())?, panels };
    let joints = read_joints(&source, wall.blocks.len())?;
    let bonds = read_bonds(&source, joints.len())?;
    let layout = read_layout(&source, bonds.len())?;
    if layout.unknowns < wall.blocks.len() {
        let what = format!("is {} for {} blocks", layout.unknowns, wall.blocks.len());
        return Err(source.wrong("layout/unknowns", what));
    }
    if let Some(what) = layout_against(&layout, joints.len()) {
        return Err(source.wrong("layout", format!("has {what}")));
    }
    let recording = read_recording(&source, &layout, joints.len())?;
    let envelopes = read_envelopes(&source, layout.unknowns, joints.len())?;
    let outcome = Outcome {
        rocking: None,
        deepest: None,
        falling: None,
        recording,
        bonds,
        ties: read_ties(&source)?,
        drifts: read_drifts(&source)?,
        envelopes,
        energies: read_numbers(&source, "energy", &fields::ENERGIES, Energies::default())?,
        totals: Totals {
            collapse: read_collapse(&source, wall.blocks.len())?,
            ..read_numbers(&source, "totals", &fields::TOTALS, Totals::default())?
        },
        counters: read_numbers(&source, "counters", &fields::COUNTERS, Counters::default())?,
        stop_reason: keyword(&source, "stop_reason", &source.attribute("stop_reason")?)?,
        time_reached: source.number("totals/time_reached")?,
        layout,
    };
    Ok(StoredRun { schema_version, provenance: read_provenance(&source)?, wall, joints, outcome })
}

/// Hash of the inputs of the run in `path`; none where that is no result of this version.
pub fn inputs_hash(path: &Path) -> Option<String> {
    let source = Source::open(path).ok()?;
    check_format(&source).ok()?;
    source.attribute("inputs_hash").ok()
}

fn check_format(source: &Source) -> Result<u32> {
    // A file without the attribute is HDF5 of someone else: saying so helps more than the name of the attribute.
    if source.attribute("format").ok().as_deref() != Some(FORMAT) {
        return Err(source.wrong("/", format!("is not a result of Concio (no attribute `format` = `{FORMAT}`)")));
    }
    match source.number::<u32>("schema_version")? {
        SCHEMA_VERSION => Ok(SCHEMA_VERSION),
        other => Err(source.wrong("schema_version", format!("is {other}; this version reads {SCHEMA_VERSION}"))),
    }
}

fn read_provenance(source: &Source) -> Result<Provenance> {
    Ok(Provenance {
        case_json: source.texts("case")?.into_iter().next().ok_or_else(|| source.wrong("case", "is empty".into()))?,
        inputs_hash: source.attribute("inputs_hash")?,
        version: source.attribute("version")?,
        model: source.attribute("model")?,
    })
}

fn read_panels(source: &Source) -> Result<Vec<PanelInfo>> {
    let names = source.texts("wall/panels/name")?;
    let courses: Vec<i64> = source.list("wall/panels/courses", names.len())?;
    let mut panels = Vec::with_capacity(names.len());
    for (name, courses) in names.into_iter().zip(courses) {
        panels.push(PanelInfo {
            name,
            courses: index(source, "wall/panels/courses", courses)?,
            reference_length: 0.0,
            reference_height: 0.0,
            reference_mass: 0.0,
            mortar: [0.0; 2],
            connection: 0.0,
        });
    }
    read_columns(source, "wall/panels", &fields::PANELS, &mut panels)?;
    Ok(panels)
}

fn read_blocks(source: &Source, panel_count: usize) -> Result<Vec<Block>> {
    let names = source.texts("wall/blocks/name")?;
    let panels: Vec<i64> = source.list("wall/blocks/panel", names.len())?;
    let courses: Vec<i64> = source.list("wall/blocks/course", names.len())?;
    let mut blocks = Vec::with_capacity(names.len());
    for ((name, panel), course) in names.into_iter().zip(panels).zip(courses) {
        blocks.push(Block {
            name,
            panel: index(source, "wall/blocks/panel", panel)
                .and_then(|p| if p < panel_count { Ok(p) } else { Err(no_panel(source, p)) })?,
            course: index(source, "wall/blocks/course", course)?,
            x: [0.0; 2],
            y: [0.0; 2],
            shape: None,
            thickness: 0.0,
            specific_weight: 0.0,
        });
    }
    read_columns(source, "wall/blocks", &fields::BLOCKS, &mut blocks)?;
    outlines::read(source, &mut blocks)?;
    Ok(blocks)
}

fn no_panel(source: &Source, panel: usize) -> crate::error::Error {
    source.wrong("wall/blocks/panel", format!("there is no panel {panel}"))
}

fn read_joints(source: &Source, blocks: usize) -> Result<Vec<JointRow>> {
    let names = source.texts("wall/joints/name")?;
    let kinds: Vec<JointKind> = read_keywords(source, "wall/joints/kind", names.len())?;
    let laws = read_keywords(source, "wall/joints/law", names.len())?;
    let devices = read_devices(source, names.len())?;
    let a: Vec<i64> = source.list("wall/joints/a", names.len())?;
    let b: Vec<i64> = source.list("wall/joints/b", names.len())?;
    let friction = read_friction(source, names.len())?;
    let mut joints = Vec::with_capacity(names.len());
    for (k, name) in names.into_iter().enumerate() {
        let a = block(source, "wall/joints/a", a[k], blocks)?;
        let b = match b[k] {
            BASE => End::Base,
            TOP => End::Top,
            other => End::Block(block(source, "wall/joints/b", other, blocks)?),
        };
        let joint = Joint { kind: kinds[k], a, b, weight: 0.0, overlap: 0.0, line: [0.0; 4] };
        let (law, friction) = (laws[k], friction[k]);
        joints.push(JointRow {
            joint,
            name,
            law,
            stiffness: 0.0,
            normal_stiffness: 0.0,
            damping: 0.0,
            normal_force: [0.0; 2],
            friction,
            restitution: 0.0,
            device: devices[k],
        });
    }
    read_columns(source, "wall/joints", &fields::JOINTS, &mut joints)?;
    Ok(joints)
}

fn read_devices(source: &Source, joints: usize) -> Result<Vec<Option<DeviceLaw>>> {
    let names = source.texts("wall/joints/device")?;
    if names.len() != joints {
        return Err(source.wrong("wall/joints/device", format!("has {} texts for {joints} joints", names.len())));
    }
    let law = |name: &String| match name.as_str() {
        NO_DEVICE => Ok(None),
        other => DeviceLaw::named(other)
            .map(Some)
            .ok_or_else(|| source.wrong("wall/joints/device", format!("holds `{other}`, which is no law of a device"))),
    };
    names.iter().map(law).collect()
}

fn read_friction(source: &Source, joints: usize) -> Result<Vec<Option<FrictionRow>>> {
    let rubs: Vec<u8> = source.list("wall/joints/friction", joints)?;
    let laws = read_keywords(source, "wall/joints/friction_law", joints)?;
    let mut rows: Vec<FrictionRow> = laws.into_iter().map(|law| FrictionRow { law, ..NO_FRICTION }).collect();
    read_columns(source, "wall/joints", &fields::FRICTION, &mut rows)?;
    Ok(rows.into_iter().zip(rubs).map(|(row, rubs)| (rubs != 0).then_some(row)).collect())
}

/// None in a file without them.
fn read_bonds(source: &Source, joints: usize) -> Result<Vec<BondRow>> {
    if !source.has("bonds/joint") {
        return Ok(Vec::new());
    }
    let indices: Vec<i64> = source.array("bonds/joint", &[None])?;
    let mut bonds = Vec::with_capacity(indices.len());
    for value in indices {
        let joint = index(source, "bonds/joint", value)?;
        if joint >= joints {
            return Err(source.wrong("bonds/joint", format!("names joint {joint} of {joints}")));
        }
        bonds.push(BondRow { joint, ..BondRow::default() });
    }
    read_columns(source, "bonds", &fields::BONDS, &mut bonds)?;
    Ok(bonds)
}

/// None in a file without them.
fn read_ties(source: &Source) -> Result<Vec<TieRow>> {
    if !source.has("ties/from") {
        return Ok(Vec::new());
    }
    let (from, to) = (source.texts("ties/from")?, source.texts("ties/to")?);
    if to.len() != from.len() {
        return Err(source.wrong("ties/to", format!("has {} entries, expected {}", to.len(), from.len())));
    }
    let mut ties: Vec<TieRow> =
        from.into_iter().zip(to).map(|(from, to)| TieRow { from, to, ..TieRow::default() }).collect();
    read_columns(source, "ties", &fields::TIES, &mut ties)?;
    Ok(ties)
}

fn read_drifts(source: &Source) -> Result<Vec<DriftRow>> {
    let tops = source.texts("drift/top")?;
    let mut drifts: Vec<DriftRow> = tops.into_iter().map(|top| DriftRow { top, ..DriftRow::default() }).collect();
    read_columns(source, "drift", &fields::DRIFTS, &mut drifts)?;
    Ok(drifts)
}

/// None in a file without it.
fn read_collapse(source: &Source, blocks: usize) -> Result<Option<Collapse>> {
    if !source.has("collapse/time") {
        return Ok(None);
    }
    Ok(Some(Collapse {
        time: source.number("collapse/time")?,
        block: block(source, "collapse/block", source.number("collapse/block")?, blocks)?,
        way: source.number("collapse/displacement")?,
        turned: source.number::<u8>("collapse/turned")? != 0,
        before: read_before(source)?,
    }))
}

/// None in a file without it.
fn read_before(source: &Source) -> Result<Option<Before>> {
    if !source.has("collapse/before/residual") {
        return Ok(None);
    }
    Ok(Some(Before {
        residual: source.number("collapse/before/residual")?,
        steps: source.number("collapse/before/steps")?,
        unsolved: source.number("collapse/before/unsolved")?,
        moving: source.number("collapse/before/moving")?,
    }))
}

fn read_layout(source: &Source, bonded: usize) -> Result<Layout> {
    let names = source.texts("layout/channels")?;
    let unlabelled = |name| Channel { name, unit: String::new(), description: String::new() };
    let mut channels: Vec<Channel> = names.into_iter().map(unlabelled).collect();
    for (path, channel) in fields::channel_paths(&channels).iter().zip(&mut channels) {
        let dataset = format!("history/{path}");
        channel.unit = source.label(&dataset, "unit")?;
        channel.description = source.label(&dataset, "description")?;
    }
    Ok(Layout {
        interval: source.number("layout/interval")?,
        samples: count(source, "layout/samples")?,
        frame_every: count(source, "layout/frame_every")?,
        unknowns: count(source, "layout/unknowns")?,
        held: count(source, "layout/held")?,
        turned: count(source, "layout/turned")?,
        touching: count(source, "layout/touching")?,
        bonded,
        channels,
    })
}

fn read_recording(source: &Source, layout: &Layout, joints: usize) -> Result<Recording> {
    let time: Vec<f64> = source.array("history/time", &[None])?;
    let width = layout.channels.len();
    let mut values = vec![0.0; time.len() * width];
    for (index, path) in fields::channel_paths(&layout.channels).iter().enumerate() {
        let column: Vec<f64> = source.list(&format!("history/{path}"), time.len())?;
        for (row, value) in values.chunks_exact_mut(width).zip(column) {
            row[index] = value;
        }
    }
    let frame_time: Vec<f64> = source.array("frames/time", &[None])?;
    let frames = frame_time.len();
    let events = read_events(source, joints)?;
    let mut recording = Recording { time, values, frame_time, events, ..Recording::default() };
    for Frames { field, width } in fields::FRAMES.iter().filter(|f| f.is_in(layout)) {
        let shape = [Some(frames), Some(width(layout))];
        *(field.slot)(&mut recording) = source.array(&format!("frames/{}", field.name), &shape)?;
    }
    Ok(recording)
}

fn read_events(source: &Source, joints: usize) -> Result<Vec<Event>> {
    if !source.has("events/time") {
        return Ok(Vec::new());
    }
    let time: Vec<f64> = source.array("events/time", &[None])?;
    let joint: Vec<i64> = source.list("events/joint", time.len())?;
    let kinds: Vec<EventKind> = read_keywords(source, "events/kind", time.len())?;
    let value: Vec<f64> = source.list("events/value", time.len())?;
    let mut events = Vec::with_capacity(time.len());
    for (k, &kind) in kinds.iter().enumerate() {
        let index = index(source, "events/joint", joint[k])?;
        if index >= joints {
            return Err(source.wrong("events/joint", format!("names joint {index} of {joints}")));
        }
        events.push(Event { time: time[k], joint: index as u32, kind, value: value[k] });
    }
    Ok(events)
}

fn read_envelopes(source: &Source, unknowns: usize, joints: usize) -> Result<Envelopes> {
    let mut envelopes = Envelopes::default();
    for field in &fields::BLOCK_ENVELOPES {
        *(field.slot)(&mut envelopes) = source.list(&format!("envelope/block/{}", field.name), unknowns)?;
    }
    for field in &fields::JOINT_ENVELOPES {
        *(field.slot)(&mut envelopes) = source.list(&format!("envelope/joint/{}", field.name), joints)?;
    }
    Ok(envelopes)
}

fn read_numbers<T, V: rust_hdf5::H5Type>(
    source: &Source,
    group: &str,
    numbers: &[Field<T, V>],
    mut into: T,
) -> Result<T> {
    for field in numbers {
        *(field.slot)(&mut into) = source.number(&format!("{group}/{}", field.name))?;
    }
    Ok(into)
}

fn read_columns<T>(source: &Source, group: &str, columns: &[Field<T, f64>], items: &mut [T]) -> Result<()> {
    for column in columns {
        let values: Vec<f64> = source.list(&format!("{group}/{}", column.name), items.len())?;
        for (item, value) in items.iter_mut().zip(values) {
            *(column.slot)(item) = value;
        }
    }
    Ok(())
}

fn read_keywords<T: for<'de> Deserialize<'de>>(source: &Source, name: &str, length: usize) -> Result<Vec<T>> {
    let texts = source.texts(name)?;
    if texts.len() != length {
        return Err(source.wrong(name, format!("has {} entries, expected {length}", texts.len())));
    }
    texts.iter().map(|text| keyword(source, name, text)).collect()
}

fn keyword<T: for<'de> Deserialize<'de>>(source: &Source, name: &str, text: &str) -> Result<T> {
    let deserializer: StrDeserializer<KeywordError> = text.into_deserializer();
    T::deserialize(deserializer).map_err(|e| source.wrong(name, format!("holds an {e}")))
}

fn count(source: &Source, name: &str) -> Result<usize> {
    let value: u64 = source.number(name)?;
    usize::try_from(value).map_err(|_| source.wrong(name, format!("is {value}, too large")))
}

fn index(source: &Source, name: &str, value: i64) -> Result<usize> {
    usize::try_from(value).map_err(|_| source.wrong(name, format!("holds {value}, expected 0 or more")))
}

fn block(source: &Source, name: &str, value: i64, blocks: usize) -> Result<usize> {
    let index = index(source, name, value)?;
    if index < blocks { Ok(index) } else { Err(source.wrong(name, format!("names block {index} of {blocks}"))) }
}
