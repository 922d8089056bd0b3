//! The VTKHDF view of a run: one polygon per block, one step per frame, so that ParaView and `vtkHDFReader`
//! play a result file as it is. Format: VTK file formats, "VTKHDF", transient UnstructuredGrid, version 2.0.
//!
//! Blocks share no points: each has its corners, in the order of the blocks, counter-clockwise, those of a rectangle from the
//! bottom left.

use std::path::Path;

use crate::error::Result;
use crate::files;
use crate::outcome::Outcome;
use crate::record::Motion;
use crate::store::StoredRun;
use crate::store::fields::{self, check_lengths};
use crate::store::h5::{Label, Sink, label};
use crate::store::outlines::Outlines;
use crate::wall::{Block, Wall};

/// VTK's numbers of the cell with four corners, and of that with any number of them.
const VTK_QUAD: u8 = 9;
/// See [`VTK_QUAD`].
const VTK_POLYGON: u8 = 7;

/// Writes the VTKHDF group alone to a file of its own (by custom `.vtkhdf`).
///
/// # Errors
/// [`Error::Io`](crate::Error::Io) or [`Error::Store`](crate::Error::Store) when it cannot be written.
pub fn write(path: &Path, run: &StoredRun) -> Result<()> {
    check_lengths(path, &run.wall, &run.joints, &run.outcome)?;
    files::replace(path, |temporary| {
        let mut sink = Sink::create(temporary, path)?;
        write_group(&mut sink, &run.wall, &run.outcome)?;
        sink.close()
    })
}

/// Writes the group `/VTKHDF`.
pub(super) fn write_group(sink: &mut Sink, wall: &Wall, outcome: &Outcome) -> Result<()> {
    sink.list_attribute("VTKHDF", "Version", &[2i64, 0])?;
    sink.ascii_attribute("VTKHDF", "Type", "UnstructuredGrid")?;
    let outlines = Outlines::of(&wall.blocks);
    write_grid(sink, &outlines)?;
    write_constant_data(sink, &wall.blocks, outcome)?;
    if outcome.recording.frame_time.is_empty() {
        return Ok(());
    }
    write_moving_data(sink, &outlines, outcome)?;
    write_steps(sink, &outlines, outcome)
}

fn write_grid(sink: &mut Sink, outlines: &Outlines) -> Result<()> {
    let (points, cells) = (outlines.corners.len(), outlines.centres.len());
    let none = |description| label("1", description);
    sink.list("VTKHDF/NumberOfPoints", &[points as i64], none("Points of the grid."))?;
    sink.list("VTKHDF/NumberOfCells", &[cells as i64], none("Cells of the grid: the blocks."))?;
    sink.list("VTKHDF/NumberOfConnectivityIds", &[points as i64], none("Entries of Connectivity."))?;
    let corners: Vec<f64> = outlines.corners.iter().flat_map(|&[x, y]| [x, y, 0.0]).collect();
    sink.array("VTKHDF/Points", &[points, 3], &corners, label("m", "Corners of the blocks at rest."))?;
    let connectivity: Vec<i64> = (0..points as i64).collect();
    sink.list("VTKHDF/Connectivity", &connectivity, none("Points of the cells."))?;
    sink.list("VTKHDF/Offsets", &outlines.starts(), none("Where the points of a cell start."))?;
    let kind = |corners: usize| if corners == 4 { VTK_QUAD } else { VTK_POLYGON };
    let kinds: Vec<u8> = outlines.each().map(|(_, corners)| kind(corners.len())).collect();
    sink.list("VTKHDF/Types", &kinds, none("Kind of cell."))
}

fn write_constant_data(sink: &mut Sink, blocks: &[Block], outcome: &Outcome) -> Result<()> {
    for (name, values, label) in constant_data(blocks, outcome) {
        sink.list(&format!("VTKHDF/CellData/{name}"), &values, label)?;
    }
    Ok(())
}

/// What does not change from frame to frame: name, one value per block, label.
fn constant_data<'a>(blocks: &[Block], outcome: &'a Outcome) -> Vec<(String, Vec<f64>, Label<'a>)> {
    let of = |value: fn(&Block) -> f64| blocks.iter().map(value).collect::<Vec<f64>>();
    let mut data = vec![
        ("mass".to_string(), of(Block::mass), label("kg", "Mass.")),
        ("course".to_string(), of(|b| b.course as f64), label("1", "Course in the panel, from 0 at the bottom.")),
        ("panel".to_string(), of(|b| b.panel as f64), label("1", "Panel, from 0.")),
    ];
    for field in &fields::BLOCK_ENVELOPES {
        // The beam, if it has an unknown, comes after the blocks and has no cell.
        let values = (field.get)(&outcome.envelopes)[..blocks.len()].to_vec();
        data.push((format!("peak_{}", field.name), values, label(field.unit, field.description)));
    }
    data
}

fn write_moving_data(sink: &mut Sink, outlines: &Outlines, outcome: &Outcome) -> Result<()> {
    let (layout, recording, unknowns) = (&outcome.layout, &outcome.recording, outcome.layout.unknowns);
    let (frames, count) = (recording.frame_time.len(), outlines.centres.len());
    let displacement = label("m", "Displacement of the corners relative to the base.");
    let points = [frames, outlines.corners.len(), 3];
    sink.frames("VTKHDF/PointData/displacement", points, displacement, |frame, row: &mut [f32]| {
        for (index, (centre, corners)) in outlines.each().enumerate() {
            let motion = Motion::in_frame(layout, recording, frame, index);
            for k in corners {
                let [x, y] = outlines.corners[k];
                let way = motion.of_point([x - centre[0], y - centre[1]]);
                (row[3 * k], row[3 * k + 1]) = (way[0] as f32, way[1] as f32);
            }
        }
    })?;
    if layout.turned > 0 {
        let rotation = label("rad", "Rotation, counterclockwise.");
        sink.frames("VTKHDF/CellData/rotation", [frames, count, 1], rotation, |frame, row: &mut [f32]| {
            let values = &recording.frame_rotation[frame * layout.turned..];
            row.iter_mut().zip(values).for_each(|(to, from)| *to = *from as f32);
        })?;
    }
    let velocity = label("m/s", "Horizontal velocity relative to the base.");
    sink.frames("VTKHDF/CellData/velocity", [frames, count, 3], velocity, |frame, row: &mut [f32]| {
        let values = &recording.frame_velocity[frame * unknowns..];
        for (vector, value) in row.chunks_exact_mut(3).zip(values) {
            vector[0] = *value as f32;
        }
    })
}

/// One step per frame; the grid and the constant data start at 0 in all of them.
fn write_steps(sink: &mut Sink, outlines: &Outlines, outcome: &Outcome) -> Result<()> {
    let (points, blocks) = (outlines.corners.len(), outlines.centres.len());
    let times = &outcome.recording.frame_time;
    let steps = times.len();
    let none = label("1", "Offset of each step.");
    sink.number_attribute("VTKHDF/Steps", "NSteps", steps as i64)?;
    sink.list("VTKHDF/Steps/Values", times, label("s", "Time of each step."))?;
    let zeros = vec![0i64; steps];
    sink.list("VTKHDF/Steps/NumberOfParts", &vec![1i64; steps], label("1", "Pieces of the grid in each step."))?;
    for name in ["PartOffsets", "PointOffsets"] {
        sink.list(&format!("VTKHDF/Steps/{name}"), &zeros, none)?;
    }
    for name in ["CellOffsets", "ConnectivityIdOffsets"] {
        sink.array(&format!("VTKHDF/Steps/{name}"), &[steps, 1], &zeros, none)?;
    }
    let every = |length: usize| (0..steps).map(|k| (k * length) as i64).collect::<Vec<_>>();
    sink.list("VTKHDF/Steps/PointDataOffsets/displacement", &every(points), none)?;
    sink.list("VTKHDF/Steps/CellDataOffsets/velocity", &every(blocks), none)?;
    if outcome.layout.turned > 0 {
        sink.list("VTKHDF/Steps/CellDataOffsets/rotation", &every(blocks), none)?;
    }
    for name in ["mass", "course", "panel"] {
        sink.list(&format!("VTKHDF/Steps/CellDataOffsets/{name}"), &zeros, none)?;
    }
    for field in &fields::BLOCK_ENVELOPES {
        sink.list(&format!("VTKHDF/Steps/CellDataOffsets/peak_{}", field.name), &zeros, none)?;
    }
    Ok(())
}
