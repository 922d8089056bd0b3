//! Tables as comma-separated values: one header line whose entries carry the unit, `name [unit]`.

use std::borrow::Cow;
use std::fmt::{Display, Write as _};
use std::fs::{self, File};
use std::path::Path;

use csv::Writer;

use crate::error::{Error, Result};
use crate::files;
use crate::record::Envelopes;
use crate::store::fields::{self, Field, NO_FRICTION, check_lengths, device_name, keyword};
use crate::store::{FrictionRow, StoredRun};
use crate::wall::{Block, End};

/// Writes `histories.csv`, `blocks.csv`, `joints.csv`, `block_envelopes.csv`, `joint_envelopes.csv` and `drift.csv`, `corners.csv` where a
/// block is no rectangle, `bonds.csv` where joints are bonded, `ties.csv` where there are ties and `events.csv` where something
/// happened, into `folder`, which is made if need be. A table that this run has not, left by another, is removed. Numbers read
/// back to the same bits.
///
/// # Errors
/// [`Error::Io`] when the disk fails, [`Error::Store`] when the run contradicts itself.
pub fn csv(run: &StoredRun, folder: &Path) -> Result<()> {
    check_lengths(folder, &run.wall, &run.joints, &run.outcome)?;
    fs::create_dir_all(folder).map_err(|e| Error::io(folder, e))?;
    table(&folder.join("histories.csv"), |t| histories(t, run))?;
    table(&folder.join("blocks.csv"), |t| blocks(t, run))?;
    let shaped = run.wall.blocks.iter().any(|b| !b.is_rectangle());
    table_if(shaped, &folder.join("corners.csv"), |t| corners(t, run))?;
    table(&folder.join("joints.csv"), |t| joints(t, run))?;
    table(&folder.join("block_envelopes.csv"), |t| {
        envelopes(t, "block", &fields::BLOCK_ENVELOPES, &unknown_names(run), &run.outcome.envelopes)
    })?;
    table_if(!run.outcome.bonds.is_empty(), &folder.join("bonds.csv"), |t| bonds(t, run))?;
    table(&folder.join("drift.csv"), |t| drifts(t, run))?;
    table_if(!run.outcome.ties.is_empty(), &folder.join("ties.csv"), |t| ties(t, run))?;
    table_if(!run.outcome.recording.events.is_empty(), &folder.join("events.csv"), |t| events(t, run))?;
    table(&folder.join("joint_envelopes.csv"), |t| {
        let names: Vec<&str> = run.joints.iter().map(|j| j.name.as_str()).collect();
        envelopes(t, "joint", &fields::JOINT_ENVELOPES, &names, &run.outcome.envelopes)
    })
}

/// Names of the unknowns: the blocks', then `beam` for the beam's.
fn unknown_names(run: &StoredRun) -> Vec<&str> {
    let blocks = run.wall.blocks.iter().map(|b| b.name.as_str());
    blocks.chain(std::iter::repeat("beam")).take(run.outcome.layout.unknowns).collect()
}

/// A text as a cell: a program for tables takes one that begins like a formula for one and reckons it, and what stands in a file
/// of somebody else's must not be reckoned; an apostrophe before it makes it a text.
pub fn cell(text: &str) -> Cow<'_, str> {
    let reckoned = match text.chars().next() {
        Some('=' | '@' | '\t' | '\r') => true,
        Some('+' | '-') => text.parse::<f64>().is_err(),
        _ => false,
    };
    if reckoned { format!("'{text}").into() } else { text.into() }
}

/// A file being written row by row.
struct Table {
    writer: Writer<File>,
    cell: String,
}

impl Table {
    fn text(&mut self, text: &str) -> csv::Result<()> {
        self.writer.write_field(&*cell(text))
    }

    fn cell(&mut self, value: impl Display) -> csv::Result<()> {
        self.cell.clear();
        // Writing to a string fails only if the value's own formatting does.
        write!(self.cell, "{value}").map_err(std::io::Error::other)?;
        self.writer.write_field(&self.cell)
    }

    /// The shortest digits that read back to the same bits; an exponent, because slips of 1e-9 m are ordinary.
    fn number(&mut self, value: f64) -> csv::Result<()> {
        self.cell(format_args!("{value:e}"))
    }

    fn head(&mut self, name: &str, unit: &str) -> csv::Result<()> {
        if unit == "1" { self.cell(name) } else { self.cell(format_args!("{name} [{unit}]")) }
    }

    fn end_row(&mut self) -> csv::Result<()> {
        self.writer.write_record(None::<&[u8]>)
    }
}

fn table(path: &Path, fill: impl FnOnce(&mut Table) -> csv::Result<()>) -> Result<()> {
    files::replace(path, |temporary| {
        let file = File::create(temporary).map_err(|e| Error::io(path, e))?;
        let writer = csv::WriterBuilder::new().buffer_capacity(1 << 16).from_writer(file);
        let mut table = Table { writer, cell: String::new() };
        fill(&mut table).map_err(|e| Error::io(path, e.into()))?;
        table.writer.flush().map_err(|e| Error::io(path, e))
    })
}

fn table_if(has: bool, path: &Path, fill: impl FnOnce(&mut Table) -> csv::Result<()>) -> Result<()> {
    if has { table(path, fill) } else { files::remove_if_there(path) }
}

fn histories(table: &mut Table, run: &StoredRun) -> csv::Result<()> {
    let (channels, recording) = (&run.outcome.layout.channels, &run.outcome.recording);
    table.head("time", "s")?;
    for channel in channels {
        table.head(&channel.name, &channel.unit)?;
    }
    table.end_row()?;
    for (row, &time) in recording.time.iter().enumerate() {
        table.number(time)?;
        for &value in &recording.values[row * channels.len()..(row + 1) * channels.len()] {
            table.number(value)?;
        }
        table.end_row()?;
    }
    Ok(())
}

fn blocks(table: &mut Table, run: &StoredRun) -> csv::Result<()> {
    for name in ["name", "panel", "course"] {
        table.head(name, "1")?;
    }
    heads(table, &fields::BLOCKS)?;
    table.head("mass", "kg")?;
    table.end_row()?;
    for block in &run.wall.blocks {
        table.text(&block.name)?;
        table.text(run.wall.panels.get(block.panel).map_or("", |p| &p.name))?;
        table.cell(block.course)?;
        numbers(table, &fields::BLOCKS, block)?;
        table.number(Block::mass(block))?;
        table.end_row()?;
    }
    Ok(())
}

/// Of all blocks, rectangles too: one row for each corner.
fn corners(table: &mut Table, run: &StoredRun) -> csv::Result<()> {
    for (name, unit) in [("block", "1"), ("x", "m"), ("y", "m")] {
        table.head(name, unit)?;
    }
    table.end_row()?;
    for block in &run.wall.blocks {
        for [x, y] in block.corners() {
            table.text(&block.name)?;
            table.number(x)?;
            table.number(y)?;
            table.end_row()?;
        }
    }
    Ok(())
}

fn joints(table: &mut Table, run: &StoredRun) -> csv::Result<()> {
    for name in ["name", "kind", "a", "b", "law", "device"] {
        table.head(name, "1")?;
    }
    heads(table, &fields::JOINTS)?;
    table.head("friction_law", "1")?;
    heads(table, &fields::FRICTION)?;
    table.end_row()?;
    let block = |index: usize| run.wall.blocks.get(index).map_or("", |b| b.name.as_str());
    for row in &run.joints {
        table.text(&row.name)?;
        table.cell(keyword(&row.joint.kind))?;
        table.text(block(row.joint.a))?;
        table.text(match row.joint.b {
            End::Block(index) => block(index),
            End::Base => "base",
            End::Top => "top",
        })?;
        table.cell(keyword(&row.law))?;
        table.cell(device_name(row.device))?;
        numbers(table, &fields::JOINTS, row)?;
        let friction: FrictionRow = row.friction.unwrap_or(NO_FRICTION);
        table.cell(keyword(&friction.law))?;
        numbers(table, &fields::FRICTION, &friction)?;
        table.end_row()?;
    }
    Ok(())
}

fn bonds(table: &mut Table, run: &StoredRun) -> csv::Result<()> {
    table.head("joint", "1")?;
    heads(table, &fields::BONDS)?;
    table.end_row()?;
    for bond in &run.outcome.bonds {
        table.text(run.joints.get(bond.joint).map_or("", |j| &j.name))?;
        numbers(table, &fields::BONDS, bond)?;
        table.end_row()?;
    }
    Ok(())
}

fn drifts(table: &mut Table, run: &StoredRun) -> csv::Result<()> {
    table.head("top", "1")?;
    heads(table, &fields::DRIFTS)?;
    table.end_row()?;
    for drift in &run.outcome.drifts {
        table.text(&drift.top)?;
        numbers(table, &fields::DRIFTS, drift)?;
        table.end_row()?;
    }
    Ok(())
}

fn ties(table: &mut Table, run: &StoredRun) -> csv::Result<()> {
    table.head("from", "1")?;
    table.head("to", "1")?;
    heads(table, &fields::TIES)?;
    table.end_row()?;
    for tie in &run.outcome.ties {
        table.text(&tie.from)?;
        table.text(&tie.to)?;
        numbers(table, &fields::TIES, tie)?;
        table.end_row()?;
    }
    Ok(())
}

/// The unit of a value follows from the kind of the event, so that it has a column of its own.
fn events(table: &mut Table, run: &StoredRun) -> csv::Result<()> {
    for (name, unit) in [("time", "s"), ("joint", "1"), ("kind", "1"), ("value", "1"), ("unit", "1")] {
        table.head(name, unit)?;
    }
    table.end_row()?;
    for event in &run.outcome.recording.events {
        table.number(event.time)?;
        table.text(run.joints.get(event.joint as usize).map_or("", |j| &j.name))?;
        table.cell(keyword(&event.kind))?;
        table.number(event.value)?;
        table.cell(event.kind.unit())?;
        table.end_row()?;
    }
    Ok(())
}

fn envelopes(
    table: &mut Table,
    what: &str,
    columns: &[Field<Envelopes, Vec<f64>>],
    names: &[&str],
    values: &Envelopes,
) -> csv::Result<()> {
    table.head(what, "1")?;
    heads(table, columns)?;
    table.end_row()?;
    for (row, name) in names.iter().enumerate() {
        table.text(name)?;
        for column in columns {
            table.number((column.get)(values)[row])?;
        }
        table.end_row()?;
    }
    Ok(())
}

fn heads<T, V>(table: &mut Table, columns: &[Field<T, V>]) -> csv::Result<()> {
    columns.iter().try_for_each(|column| table.head(column.name, column.unit))
}

fn numbers<T>(table: &mut Table, columns: &[Field<T, f64>], of: &T) -> csv::Result<()> {
    columns.iter().try_for_each(|column| table.number(*(column.get)(of)))
}
