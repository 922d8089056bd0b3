//! A NumPy archive: a ZIP file of `.npy` arrays. An array has the name that its dataset has in the HDF5 file.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use npyz::{AutoSerialize, WriteOptions, WriterBuilder};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use crate::error::{Error, Result};
use crate::files;
use crate::outcome::{Before, Collapse};
use crate::store::fields::{self, Field, Frames, NO_FRICTION, check_lengths, device_name, keyword, other_side};
use crate::store::outlines::{self, Outlines};
use crate::store::{FrictionRow, StoredRun};
use crate::wall::Block;

/// Writes the whole run to `path`: `numpy.load(path)["history/top/displacement"]`.
/// Texts are arrays of bytes in UTF-8 (`|S`). Equal runs give equal bytes.
///
/// # Errors
/// [`Error::Io`] when the disk fails, [`Error::Store`] when the run contradicts itself.
pub fn npz(run: &StoredRun, path: &Path) -> Result<()> {
    check_lengths(path, &run.wall, &run.joints, &run.outcome)?;
    files::replace(path, |temporary| {
        let file = File::create(temporary).map_err(|e| Error::io(path, e))?;
        let mut archive = Archive { zip: ZipWriter::new(BufWriter::new(&file)) };
        let done = match fill(&mut archive, run) {
            Ok(()) => archive.zip.finish().map_err(io::Error::from).and_then(|mut end| end.flush()),
            Err(error) => {
                // An archive that is dropped unfinished tries to write its end, and prints that it cannot. The file is closed all the same.
                std::mem::forget(archive);
                Err(error)
            }
        };
        done.map_err(|e| Error::io(path, e))
    })
}

struct Archive<'f> {
    zip: ZipWriter<BufWriter<&'f File>>,
}

impl Archive<'_> {
    /// Starts the entry of an array of that many bytes.
    fn start(&mut self, name: &str, bytes: usize) -> io::Result<()> {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .compression_level(Some(1))
            // A header of 128 bytes, often less, comes before the data; the limit of plain ZIP is 4 GiB.
            .large_file(bytes >= u32::MAX as usize - 4096);
        Ok(self.zip.start_file(format!("{name}.npy"), options)?)
    }

    fn array<T>(&mut self, name: &str, shape: &[usize], values: impl IntoIterator<Item = T>) -> io::Result<()>
    where
        T: AutoSerialize,
    {
        self.start(name, shape.iter().product::<usize>().saturating_mul(size_of::<T>()))?;
        let shape: Vec<u64> = shape.iter().map(|&n| n as u64).collect();
        // One buffer between the numbers and the compressor, which is slow when fed eight bytes at a time.
        let buffered = BufWriter::with_capacity(1 << 16, &mut self.zip);
        let mut writer = WriteOptions::new().default_dtype().shape(&shape).writer(buffered).begin_nd()?;
        writer.extend(values)?;
        writer.finish()
    }

    fn list(&mut self, name: &str, values: &[f64]) -> io::Result<()> {
        self.array(name, &[values.len()], values.iter().copied())
    }

    fn integers(&mut self, name: &str, values: impl ExactSizeIterator<Item = i64>) -> io::Result<()> {
        self.array(name, &[values.len()], values)
    }

    /// Texts as bytes of the length of the longest.
    fn texts(&mut self, name: &str, texts: &[impl AsRef<str>]) -> io::Result<()> {
        // NumPy has no arrays of texts of length 0.
        let longest = texts.iter().map(|t| t.as_ref().len()).max().unwrap_or(0).max(1);
        self.start(name, longest.saturating_mul(texts.len()))?;
        let kind = format!("|S{longest}").parse().map_err(io::Error::other)?;
        let options = WriteOptions::<[u8]>::new().dtype(npyz::DType::Plain(kind));
        let mut writer = options.shape(&[texts.len() as u64]).writer(&mut self.zip).begin_nd()?;
        for text in texts {
            writer.push(text.as_ref().as_bytes())?;
        }
        writer.finish()
    }
}

fn fill(archive: &mut Archive, run: &StoredRun) -> io::Result<()> {
    let provenance = &run.provenance;
    archive.texts("case", &[&provenance.case_json])?;
    archive.texts("version", &[&provenance.version])?;
    archive.texts("model", &[&provenance.model])?;
    archive.texts("inputs_hash", &[&provenance.inputs_hash])?;
    archive.texts("stop_reason", &[keyword(&run.outcome.stop_reason)])?;
    fill_blocks(archive, run)?;
    fill_panels(archive, run)?;
    fill_joints(archive, run)?;
    fill_recording(archive, run)?;
    fill_sums(archive, run)
}

fn fill_blocks(archive: &mut Archive, run: &StoredRun) -> io::Result<()> {
    let blocks = &run.wall.blocks;
    archive.texts("wall/blocks/name", &blocks.iter().map(|b| &b.name).collect::<Vec<_>>())?;
    archive.integers("wall/blocks/panel", blocks.iter().map(|b| b.panel as i64))?;
    archive.integers("wall/blocks/course", blocks.iter().map(|b| b.course as i64))?;
    archive.list("wall/blocks/mass", &blocks.iter().map(Block::mass).collect::<Vec<_>>())?;
    columns(archive, "wall/blocks", &fields::BLOCKS, blocks)?;
    let outlines = Outlines::of(blocks);
    archive.integers(outlines::START, outlines.starts().into_iter())?;
    archive.array(outlines::CORNERS, &[outlines.corners.len(), 2], outlines.corners.as_flattened().iter().copied())?;
    archive.integers(outlines::SPAN, blocks.iter().map(|b| b.span() as i64))
}

fn fill_panels(archive: &mut Archive, run: &StoredRun) -> io::Result<()> {
    let panels = &run.wall.panels;
    archive.texts("wall/panels/name", &panels.iter().map(|p| &p.name).collect::<Vec<_>>())?;
    archive.integers("wall/panels/courses", panels.iter().map(|p| p.courses as i64))?;
    columns(archive, "wall/panels", &fields::PANELS, panels)
}

fn fill_joints(archive: &mut Archive, run: &StoredRun) -> io::Result<()> {
    let joints = &run.joints;
    archive.texts("wall/joints/name", &joints.iter().map(|j| &j.name).collect::<Vec<_>>())?;
    archive.texts("wall/joints/kind", &joints.iter().map(|j| keyword(&j.joint.kind)).collect::<Vec<_>>())?;
    archive.texts("wall/joints/law", &joints.iter().map(|j| keyword(&j.law)).collect::<Vec<_>>())?;
    archive.texts("wall/joints/device", &joints.iter().map(|j| device_name(j.device)).collect::<Vec<_>>())?;
    archive.integers("wall/joints/a", joints.iter().map(|j| j.joint.a as i64))?;
    archive.integers("wall/joints/b", joints.iter().map(|j| other_side(j.joint.b)))?;
    columns(archive, "wall/joints", &fields::JOINTS, joints)?;
    archive.array("wall/joints/friction", &[joints.len()], joints.iter().map(|j| u8::from(j.friction.is_some())))?;
    let friction: Vec<FrictionRow> = joints.iter().map(|j| j.friction.unwrap_or(NO_FRICTION)).collect();
    archive.texts("wall/joints/friction_law", &friction.iter().map(|f| keyword(&f.law)).collect::<Vec<_>>())?;
    columns(archive, "wall/joints", &fields::FRICTION, &friction)
}

fn fill_recording(archive: &mut Archive, run: &StoredRun) -> io::Result<()> {
    let (layout, recording) = (&run.outcome.layout, &run.outcome.recording);
    archive.list("history/time", &recording.time)?;
    let (samples, width) = (recording.time.len(), layout.channels.len());
    for (index, path) in fields::channel_paths(&layout.channels).iter().enumerate() {
        let column = (0..samples).map(|row| recording.values[row * width + index]);
        archive.array(&format!("history/{path}"), &[samples], column)?;
    }
    archive.list("frames/time", &recording.frame_time)?;
    for Frames { field, width } in fields::FRAMES.iter().filter(|f| f.is_in(layout)) {
        let shape = [recording.frame_time.len(), width(layout)];
        archive.array(&format!("frames/{}", field.name), &shape, (field.get)(recording).iter().copied())?;
    }
    if layout.bonded > 0 {
        archive.integers("bonds/joint", run.outcome.bonds.iter().map(|b| b.joint as i64))?;
        columns(archive, "bonds", &fields::BONDS, &run.outcome.bonds)?;
    }
    let drifts = &run.outcome.drifts;
    archive.texts("drift/top", &drifts.iter().map(|d| &d.top).collect::<Vec<_>>())?;
    columns(archive, "drift", &fields::DRIFTS, drifts)?;
    let ties = &run.outcome.ties;
    if !ties.is_empty() {
        archive.texts("ties/from", &ties.iter().map(|t| &t.from).collect::<Vec<_>>())?;
        archive.texts("ties/to", &ties.iter().map(|t| &t.to).collect::<Vec<_>>())?;
        columns(archive, "ties", &fields::TIES, ties)?;
    }
    let events = &recording.events;
    if events.is_empty() {
        return Ok(());
    }
    archive.list("events/time", &events.iter().map(|e| e.time).collect::<Vec<_>>())?;
    archive.integers("events/joint", events.iter().map(|e| i64::from(e.joint)))?;
    archive.texts("events/kind", &events.iter().map(|e| keyword(&e.kind)).collect::<Vec<_>>())?;
    archive.list("events/value", &events.iter().map(|e| e.value).collect::<Vec<_>>())
}

fn fill_sums(archive: &mut Archive, run: &StoredRun) -> io::Result<()> {
    let outcome = &run.outcome;
    for field in &fields::BLOCK_ENVELOPES {
        archive.list(&format!("envelope/block/{}", field.name), (field.get)(&outcome.envelopes))?;
    }
    for field in &fields::JOINT_ENVELOPES {
        archive.list(&format!("envelope/joint/{}", field.name), (field.get)(&outcome.envelopes))?;
    }
    for field in &fields::ENERGIES {
        archive.array(&format!("energy/{}", field.name), &[], [*(field.get)(&outcome.energies)])?;
    }
    for field in &fields::TOTALS {
        archive.array(&format!("totals/{}", field.name), &[], [*(field.get)(&outcome.totals)])?;
    }
    for field in &fields::COUNTERS {
        archive.array(&format!("counters/{}", field.name), &[], [*(field.get)(&outcome.counters)])?;
    }
    if let Some(Collapse { time, block, way, turned, before }) = outcome.totals.collapse {
        archive.array("collapse/time", &[], [time])?;
        archive.array("collapse/block", &[], [block as i64])?;
        archive.array("collapse/displacement", &[], [way])?;
        archive.array("collapse/turned", &[], [u8::from(turned)])?;
        if let Some(Before { residual, steps, unsolved, moving }) = before {
            archive.array("collapse/before/residual", &[], [residual])?;
            for (name, count) in [("steps", steps), ("unsolved", unsolved), ("moving", moving)] {
                archive.array(&format!("collapse/before/{name}"), &[], [count])?;
            }
        }
    }
    archive.array("totals/time_reached", &[], [outcome.time_reached])
}

fn columns<T>(archive: &mut Archive, group: &str, columns: &[Field<T, f64>], items: &[T]) -> io::Result<()> {
    for column in columns {
        let values = items.iter().map(|item| *(column.get)(item));
        archive.array(&format!("{group}/{}", column.name), &[items.len()], values)?;
    }
    Ok(())
}
