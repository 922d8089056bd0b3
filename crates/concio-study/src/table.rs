//! The table of a study: one line per run, in the order of the plan. CSV and Parquet.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use concio::{Error, Result};
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use serde_json::Value;

use crate::factors::amount;
use crate::files;
use crate::measures::{End, MEASURES, Row};
use crate::plan::Plan;

/// A column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Heading.
    pub name: String,
    /// SI unit; empty for pure numbers and texts.
    pub unit: String,
    /// Its cells.
    pub cells: Cells,
}

/// Cells; none where there is no value.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// Numbers.
    Numbers(Vec<Option<f64>>),
    /// Texts.
    Texts(Vec<Option<String>>),
}

/// A table.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Its columns, equally long.
    pub columns: Vec<Column>,
}

impl Table {
    /// Adds a column of numbers.
    pub fn numbers(&mut self, name: impl Into<String>, unit: impl Into<String>, cells: Vec<Option<f64>>) {
        self.columns.push(Column { name: name.into(), unit: unit.into(), cells: Cells::Numbers(cells) });
    }

    /// Adds a column of texts.
    pub fn texts(&mut self, name: impl Into<String>, cells: Vec<Option<String>>) {
        self.columns.push(Column { name: name.into(), unit: String::new(), cells: Cells::Texts(cells) });
    }

    /// Number of lines.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |c| match &c.cells {
            Cells::Numbers(v) => v.len(),
            Cells::Texts(v) => v.len(),
        })
    }

    /// Whether it has no lines.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A column of numbers by name.
    pub fn column(&self, name: &str) -> Option<&[Option<f64>]> {
        self.columns.iter().find(|c| c.name == name).and_then(|c| match &c.cells {
            Cells::Numbers(v) => Some(v.as_slice()),
            Cells::Texts(_) => None,
        })
    }
}

/// All runs of a plan with the values of their factors and what was measured; `rows` as the runs stand in the plan, none
/// where a run is not done.
pub fn of_plan(plan: &Plan, rows: &[Option<&Row>]) -> Table {
    let mut table = Table::default();
    table.numbers("run", "", (0..rows.len()).map(|i| Some((i + 1) as f64)).collect());
    let labels: Vec<Vec<Value>> = (0..rows.len()).map(|i| plan.labels(i)).collect();
    for (k, factor) in plan.factors.iter().enumerate() {
        let cells: Vec<&Value> = labels.iter().map(|row| &row[k]).collect();
        let numbers: Vec<Option<f64>> = match factor.unit.is_empty() {
            true => cells.iter().map(|c| c.as_f64()).collect(),
            false => cells.iter().map(|c| amount(c).map(|(v, _)| v)).collect(),
        };
        if numbers.iter().all(Option::is_some) {
            table.numbers(&factor.name, &factor.unit, numbers);
        } else {
            let text = |c: &&Value| Some(c.as_str().map_or_else(|| c.to_string(), str::to_string));
            table.texts(&factor.name, cells.iter().map(text).collect());
        }
    }
    let end = |row: &&Row| match row.end {
        End::Completed => "completed".to_string(),
        End::Stopped => "stopped".into(),
        End::Failed => "failed".into(),
    };
    table.texts("end", rows.iter().map(|r| Some(r.as_ref().map_or("not run".into(), end))).collect());
    for (k, measure) in MEASURES.iter().enumerate() {
        let cells = rows.iter().map(|r| r.and_then(|r| r.numbers.get(k).copied().flatten())).collect();
        table.numbers(measure.name, measure.unit, cells);
    }
    let text = |pick: fn(&Row) -> Option<String>| rows.iter().map(|r| r.and_then(pick)).collect();
    table.texts("peak_joint", text(|r| r.peak_joint.clone()));
    table.texts("first_joint", text(|r| r.first_joint.clone()));
    table.texts("cause", text(|r| r.cause.clone()));
    table.texts("id", text(|r| Some(r.id.clone())));
    table
}

/// What was kept per joint: one line per run and joint. `names` are the joints of a run, by its place in the plan.
pub fn of_joints(rows: &[Option<&Row>], names: &dyn Fn(usize) -> Vec<String>) -> Table {
    let mut kinds: Vec<_> = rows.iter().flatten().flat_map(|r| r.joints.keys().copied()).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let (mut run, mut joint) = (Vec::new(), Vec::new());
    let mut values = vec![Vec::new(); kinds.len()];
    for (number, row) in rows.iter().enumerate().filter_map(|(i, r)| r.map(|r| (i, r))) {
        if row.joints.is_empty() {
            continue;
        }
        for (e, name) in names(number).into_iter().enumerate() {
            run.push(Some((number + 1) as f64));
            joint.push(Some(name));
            for (kind, column) in kinds.iter().zip(&mut values) {
                column.push(row.joints.get(kind).and_then(|v| v.get(e).copied().flatten()));
            }
        }
    }
    let mut table = Table::default();
    table.numbers("run", "", run);
    table.texts("joint", joint);
    for (kind, column) in kinds.into_iter().zip(values) {
        let name = serde_json::to_value(kind).ok().and_then(|v| v.as_str().map(str::to_string)).unwrap_or_default();
        table.numbers(name, kind.unit(), column);
    }
    table
}

/// Writes CSV: headings with their units in brackets, numbers that read back to the same bits. Whole or not at all.
///
/// # Errors
/// [`Error::Io`].
pub fn write_csv(table: &Table, path: &Path) -> Result<()> {
    let wrong = |e: csv::Error| Error::Store { path: path.to_path_buf(), what: e.to_string() };
    let mut writer = csv::Writer::from_writer(Vec::new());
    let heading = |c: &Column| if c.unit.is_empty() { c.name.clone() } else { format!("{} [{}]", c.name, c.unit) };
    writer.write_record(table.columns.iter().map(heading)).map_err(wrong)?;
    for line in 0..table.len() {
        let cell = |c: &Column| match &c.cells {
            Cells::Numbers(v) => v[line].map_or_else(String::new, |v| format!("{v}")),
            Cells::Texts(v) => v[line].clone().unwrap_or_default(),
        };
        writer.write_record(table.columns.iter().map(cell)).map_err(wrong)?;
    }
    let bytes = writer.into_inner().map_err(|e| Error::Store { path: path.to_path_buf(), what: e.to_string() })?;
    files::replace_bytes(path, &bytes)
}

/// Writes Parquet: doubles and texts, both optional; units stand in the key-value metadata under `unit:NAME`. Whole or
/// not at all.
///
/// # Errors
/// [`Error::Io`].
pub fn write_parquet(table: &Table, path: &Path) -> Result<()> {
    files::replace(path, |temporary| {
        let file = fs::File::create(temporary).map_err(|e| Error::io(path, e))?;
        parquet(table, file).map_err(|e| Error::Store { path: path.to_path_buf(), what: e.to_string() })
    })
}

fn parquet(table: &Table, file: fs::File) -> parquet::errors::Result<()> {
    let mut fields = Vec::new();
    for column in &table.columns {
        let (physical, logical) = match column.cells {
            Cells::Numbers(_) => (Physical::DOUBLE, None),
            Cells::Texts(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(&column.name, physical);
        fields.push(Arc::new(field.with_repetition(Repetition::OPTIONAL).with_logical_type(logical).build()?));
    }
    let schema = Arc::new(Type::group_type_builder("study").with_fields(fields).build()?);
    let units = table.columns.iter().filter(|c| !c.unit.is_empty());
    let units = units.map(|c| KeyValue::new(format!("unit:{}", c.name), c.unit.clone())).collect();
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(format!("concio {}", env!("CARGO_PKG_VERSION")))
        .set_key_value_metadata(Some(units))
        .build();
    let mut writer = SerializedFileWriter::new(file, schema, Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for column in &table.columns {
        let Some(mut out) = group.next_column()? else { break };
        match &column.cells {
            Cells::Numbers(cells) => {
                let values: Vec<f64> = cells.iter().flatten().copied().collect();
                let present: Vec<i16> = cells.iter().map(|c| i16::from(c.is_some())).collect();
                out.typed::<DoubleType>().write_batch(&values, Some(&present), None)?;
            }
            Cells::Texts(cells) => {
                let values: Vec<ByteArray> = cells.iter().flatten().map(|t| ByteArray::from(t.as_str())).collect();
                let present: Vec<i16> = cells.iter().map(|c| i16::from(c.is_some())).collect();
                out.typed::<ByteArrayType>().write_batch(&values, Some(&present), None)?;
            }
        }
        out.close()?;
    }
    group.close()?;
    writer.close()?;
    Ok(())
}
