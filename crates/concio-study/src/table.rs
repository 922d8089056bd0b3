//! The table of a study: one line per run, in the order of the plan. CSV and Parquet.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use concio::files;
use concio::store::export::cell as text_cell;
use concio::warning::Warning;
use concio::{Error, Result};
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use serde_json::Value;

use crate::file::PerJoint;
use crate::measures::{End, MEASURES, OWN, Row};
use crate::plan::Plan;
use crate::values::amount;

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
    let [run, end_of, peak_joint, first_joint, cause, warned, kinds, id] = OWN;
    table.numbers(run, "", (0..rows.len()).map(|i| Some((i + 1) as f64)).collect());
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
    table.texts(end_of, rows.iter().map(|r| Some(r.as_ref().map_or("not run".into(), end))).collect());
    for (k, measure) in MEASURES.iter().enumerate() {
        let cells = rows.iter().map(|r| r.and_then(|r| r.numbers.get(k).copied().flatten())).collect();
        table.numbers(measure.name, measure.unit, cells);
    }
    let text = |pick: fn(&Row) -> Option<String>| rows.iter().map(|r| r.and_then(pick)).collect();
    table.texts(peak_joint, text(|r| r.peak_joint.clone()));
    table.texts(first_joint, text(|r| r.first_joint.clone()));
    table.texts(cause, text(|r| r.cause.clone()));
    // What the files show counts as in all that tells of the study.
    let all =
        |(number, row): (usize, &Option<&Row>)| Some([plan.unit_doubts(number), (*row)?.warnings.clone()].concat());
    let all: Vec<Option<Vec<Warning>>> = rows.iter().enumerate().map(all).collect();
    let whole = |row: &Option<&Row>| row.is_some_and(|row| row.end != End::Failed);
    let count = |(row, all): (&Option<&Row>, &Option<Vec<Warning>>)| {
        all.as_ref().filter(|_| whole(row)).map(|all| all.len() as f64)
    };
    table.numbers(warned, "", rows.iter().zip(&all).map(count).collect());
    table.texts(kinds, all.iter().map(|all| crate::warned::kinds(all.as_ref()?)).collect());
    table.texts(id, text(|r| Some(r.id.clone())));
    table
}

/// Writes what was kept per joint, one line per run and joint, as `joints.csv` and `joints.parquet` into `folder`, each whole
/// or not at all. `names` are the joints of a run, by its place in the plan. Lines are written as they are made: a study may
/// have more of them than memory holds.
///
/// # Errors
/// [`Error::Io`].
pub fn write_joints(rows: &[Option<&Row>], names: &dyn Fn(usize) -> Vec<String>, folder: &Path) -> Result<()> {
    let paths = ["joints.csv", "joints.parquet"].map(|name| folder.join(name));
    files::replace(&paths[0], |csv| {
        files::replace(&paths[1], |parquet| {
            let wrong = |what: String| Error::Store { path: folder.join("joints"), what };
            let file = |path| fs::File::create(path).map_err(|e| Error::io(path, e));
            let mut lines = Lines::new(rows, file(csv)?, file(parquet)?).map_err(|e| wrong(e.to_string()))?;
            for (number, row) in rows.iter().enumerate() {
                if let Some(row) = row.filter(|row| !row.joints.is_empty()) {
                    lines.run(number, row, &names(number)).map_err(|e| wrong(e.to_string()))?;
                }
            }
            lines.close().map_err(|e| wrong(e.to_string()))
        })
    })
}

/// Lines per group of rows in the Parquet file of joints: what is in memory at a time.
const LINES_AT_ONCE: usize = 1 << 18;

/// The two files of joints under way.
struct Lines {
    kinds: Vec<PerJoint>,
    csv: csv::Writer<fs::File>,
    parquet: SerializedFileWriter<fs::File>,
    runs: Vec<Option<f64>>,
    joints: Vec<Option<ByteArray>>,
    values: Vec<Vec<Option<f64>>>,
    /// A cell of CSV.
    cell: String,
}

type Written = std::result::Result<(), Box<dyn std::error::Error>>;

impl Lines {
    fn new(
        rows: &[Option<&Row>],
        csv: fs::File,
        parquet: fs::File,
    ) -> std::result::Result<Self, Box<dyn std::error::Error>> {
        let mut kinds: Vec<PerJoint> = rows.iter().flatten().flat_map(|r| r.joints.keys().copied()).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let name = |kind: &PerJoint| {
            let text = serde_json::to_value(kind).ok().and_then(|v| v.as_str().map(str::to_string));
            text.unwrap_or_default()
        };
        let (number, text) = (Kind::Number, Kind::Text);
        let mut columns = vec![("run".to_string(), String::new(), number), ("joint".into(), String::new(), text)];
        columns.extend(kinds.iter().map(|kind| (name(kind), kind.unit().to_string(), number)));
        let mut csv = csv::Writer::from_writer(csv);
        csv.write_record(columns.iter().map(|(name, unit, _)| heading(name, unit)))?;
        let parquet = parquet_writer(&columns, parquet)?;
        let values = vec![Vec::new(); kinds.len()];
        Ok(Lines { kinds, csv, parquet, runs: Vec::new(), joints: Vec::new(), values, cell: String::new() })
    }

    fn run(&mut self, number: usize, row: &Row, names: &[String]) -> Written {
        let run = (number + 1) as f64;
        for (e, name) in names.iter().enumerate() {
            self.runs.push(Some(run));
            self.joints.push(Some(ByteArray::from(name.as_str())));
            cell(&mut self.csv, &mut self.cell, Some(run))?;
            self.csv.write_field(&*text_cell(name))?;
            for (kind, column) in self.kinds.iter().zip(&mut self.values) {
                let value = row.joints.get(kind).and_then(|v| v.get(e).copied().flatten());
                column.push(value);
                cell(&mut self.csv, &mut self.cell, value)?;
            }
            self.csv.write_record(None::<&[u8]>)?;
            if self.runs.len() == LINES_AT_ONCE {
                self.group()?;
            }
        }
        Ok(())
    }

    /// Writes what is in memory as a group of rows.
    fn group(&mut self) -> Written {
        let mut group = self.parquet.next_row_group()?;
        write_column::<DoubleType>(&mut group, &self.runs)?;
        write_column::<ByteArrayType>(&mut group, &self.joints)?;
        for column in &mut self.values {
            write_column::<DoubleType>(&mut group, column)?;
            column.clear();
        }
        group.close()?;
        self.runs.clear();
        self.joints.clear();
        Ok(())
    }

    fn close(mut self) -> Written {
        if !self.runs.is_empty() {
            self.group()?;
        }
        self.csv.flush()?;
        self.parquet.close()?;
        Ok(())
    }
}

/// Writes a number of CSV, which reads back to the same bits; nothing where there is none.
fn cell(csv: &mut csv::Writer<fs::File>, text: &mut String, value: Option<f64>) -> Written {
    text.clear();
    if let Some(value) = value {
        write!(text, "{value}")?;
    }
    Ok(csv.write_field(&*text)?)
}

fn heading(name: &str, unit: &str) -> String {
    let name = text_cell(name);
    if unit.is_empty() { name.into_owned() } else { format!("{name} [{unit}]") }
}

/// Writes CSV: headings with their units in brackets, numbers that read back to the same bits. Whole or not at all.
///
/// # Errors
/// [`Error::Io`].
pub fn write_csv(table: &Table, path: &Path) -> Result<()> {
    let wrong = |e: csv::Error| Error::Store { path: path.to_path_buf(), what: e.to_string() };
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(table.columns.iter().map(|c| heading(&c.name, &c.unit))).map_err(wrong)?;
    for line in 0..table.len() {
        let cell = |c: &Column| match &c.cells {
            Cells::Numbers(v) => v[line].map_or_else(String::new, |v| format!("{v}")),
            Cells::Texts(v) => v[line].as_deref().map_or_else(String::new, |v| text_cell(v).into_owned()),
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
    let kind = |cells: &Cells| match cells {
        Cells::Numbers(_) => Kind::Number,
        Cells::Texts(_) => Kind::Text,
    };
    let columns: Vec<_> = table.columns.iter().map(|c| (c.name.clone(), c.unit.clone(), kind(&c.cells))).collect();
    let mut writer = parquet_writer(&columns, file)?;
    let mut group = writer.next_row_group()?;
    for column in &table.columns {
        match &column.cells {
            Cells::Numbers(cells) => write_column::<DoubleType>(&mut group, cells)?,
            Cells::Texts(cells) => {
                let texts: Vec<_> = cells.iter().map(|t| t.as_deref().map(ByteArray::from)).collect();
                write_column::<ByteArrayType>(&mut group, &texts)?;
            }
        }
    }
    group.close()?;
    writer.close()?;
    Ok(())
}

/// What the cells of a column of Parquet are.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Number,
    Text,
}

/// A file of columns, each with its name and unit.
fn parquet_writer(
    columns: &[(String, String, Kind)],
    file: fs::File,
) -> parquet::errors::Result<SerializedFileWriter<fs::File>> {
    let mut fields = Vec::new();
    for (name, _, kind) in columns {
        let (physical, logical) = match kind {
            Kind::Number => (Physical::DOUBLE, None),
            Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(name, physical);
        fields.push(Arc::new(field.with_repetition(Repetition::OPTIONAL).with_logical_type(logical).build()?));
    }
    let schema = Arc::new(Type::group_type_builder("study").with_fields(fields).build()?);
    let units = columns.iter().filter(|(_, unit, _)| !unit.is_empty());
    let units = units.map(|(name, unit, _)| KeyValue::new(format!("unit:{name}"), unit.clone())).collect();
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(format!("concio {}", env!("CARGO_PKG_VERSION")))
        .set_key_value_metadata(Some(units))
        .build();
    SerializedFileWriter::new(file, schema, Arc::new(properties))
}

type Group<'g> = SerializedRowGroupWriter<'g, fs::File>;

fn write_column<T: DataType>(group: &mut Group, cells: &[Option<T::T>]) -> parquet::errors::Result<()> {
    let Some(mut out) = group.next_column()? else { return Ok(()) };
    let values: Vec<T::T> = cells.iter().flatten().cloned().collect();
    let present: Vec<i16> = cells.iter().map(|c| i16::from(c.is_some())).collect();
    out.typed::<T>().write_batch(&values, Some(&present), None)?;
    out.close()
}
