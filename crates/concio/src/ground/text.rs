//! Columns of text: one column of values for each component, behind a time column or without one; or one component row by row. Columns are
//! parted by comma, semicolon, tab or blanks; with semicolons, and between blanks or tabs where no number has a point, a comma is a decimal point. Lines
//! that start with `#`, `%` or `//`, and lines that start with a word before the first sample, are header. From the header come the interval
//! (`dt = 0.01 s`, `sampling rate: 200 Hz`), the unit (`acceleration [cm/s2]`, `units: g`), the layout (`layout: rows`) and, from its last line,
//! the names of the columns; times are in seconds, or in milliseconds where their title says so (`time [ms]`).

use crate::case::{HistoryLayout, HistoryQuantity};
use crate::ground::record::{Format, Raw, Record, Remark, TextOptions, finish, name};
use crate::ground::source::Source;
use crate::ground::units;
use crate::{InputError, Result};

mod header;
mod table;

pub(super) use header::unit_words;
use header::{HEADER, bracketed, column_names, named_interval};
use table::{Table, is_comment, is_title, table};

/// How far a time step may be from the others, as a fraction of the interval, beyond what rounding in print explains.
const STEP_TOLERANCE: f64 = 0.01;
/// How far a time may be from an even grid beyond that, over the interval: steps that all pass may add up to an uneven column.
const GRID_TOLERANCE: f64 = 0.5;
/// Most columns without titles that are believed to be components.
const MOST_UNTITLED: usize = 3;
/// Part of the steps that grow in a column that is time, damaged or not: no acceleration does that.
const GROWING: f64 = 0.95;
/// Change along rows over that along columns below which columns read like one component row by row.
const LIKE_ROWS: f64 = 0.7;
/// How to say that a file is one component row by row, and that it is not.
const AS_ROWS: &str = "add `layout = \"rows\"` to the input, or a line `# layout: rows` to the file";
const AS_COLUMNS: &str = "`layout = \"columns\"`";

pub(super) fn read(source: &Source, options: &TextOptions) -> Result<Vec<Record>> {
    let layout = layout(source, options)?;
    let table = table(source, layout == Some(HistoryLayout::Rows))?;
    let data_line = table.lines[0];
    let names = column_names(source, data_line, table.columns.len());
    let known = named_interval(source, data_line).is_some() || options.dt.is_some();
    let (interval, columns) = if is_timed(&table, &names, layout, known) {
        (timed(source, &table, options)?, 1)
    } else {
        if layout.is_none() {
            refuse_doubtful(source, &table, &names)?;
        }
        (untimed(source, &table, options)?, 0)
    };
    let others: Vec<Option<&str>> = names.iter().map(|title| other_than(title, options.quantity)).collect();
    refuse_others(source, data_line, &others, columns, options.quantity)?;
    let header = header_unit(source, data_line, options.quantity);
    let mut records = Vec::new();
    for (index, values) in table.columns.into_iter().enumerate().skip(columns) {
        // Velocities and displacements beside accelerations are no components.
        if others.get(index).is_some_and(Option::is_some) {
            continue;
        }
        let title = names.get(index).copied().unwrap_or("");
        let (units_line, units) = unit(source, data_line, title, header, options)?;
        let raw = Raw {
            quantity: options.quantity,
            dt: interval.dt,
            values,
            units,
            channel: title.split(['[', '(']).next().unwrap_or("").trim().to_owned(),
            dt_line: interval.line,
            units_line,
            data_line,
            remarks: interval.start.map(|time| Remark::Start { time }).into_iter().collect(),
            ..Raw::of(Format::Text)
        };
        records.push(finish(source, raw)?);
    }
    Ok(records)
}

/// What a column has by its title, where that is another quantity than the one that is read.
fn other_than(title: &str, quantity: HistoryQuantity) -> Option<&'static str> {
    const NAMED: [(&str, &[&str]); 5] = [
        ("acceleration", &["acc", "accel", "acceleration"]),
        ("displacement", &["disp", "displ", "displacement", "drift"]),
        ("velocity", &["vel", "velocity"]),
        ("a spectrum", &["sa", "psa", "psv", "freq", "frequency", "period", "spectrum"]),
        ("force", &["force", "load"]),
    ];
    let lower = title.to_lowercase();
    let mut words = lower.split(|c: char| !c.is_alphanumeric());
    let word = words.find(|word| word.contains(char::is_alphabetic)).unwrap_or("");
    // `vel1` is a velocity, `SA01` a sensor.
    let stem = word.trim_matches(char::is_numeric);
    let is_named = |what: &str, words: &[&str]| words.contains(if what == "a spectrum" { &word } else { &stem });
    let of_unit = bracketed(&lower).any(is_unit_of_velocity).then_some("velocity");
    let named = NAMED.iter().find(|(what, words)| is_named(what, words)).map(|(what, _)| *what);
    named.or(of_unit).filter(|what| *what != name(quantity))
}

fn is_unit_of_velocity(unit: &str) -> bool {
    let length = unit.strip_suffix("/s").or_else(|| unit.strip_suffix("/sec"));
    length.is_some_and(|length| units::factor(length, HistoryQuantity::Displacement).is_some())
}

/// Refuses files of which no column has what is read, and those whose first column stands in the place of time and is none.
fn refuse_others(
    source: &Source,
    data_line: usize,
    others: &[Option<&str>],
    columns: usize,
    quantity: HistoryQuantity,
) -> Result<()> {
    let title_line = data_line.saturating_sub(1);
    let wanted = name(quantity);
    let time = columns == 1 && others.first().is_some_and(Option::is_some);
    let values = others.get(columns..).unwrap_or_default();
    let found = match (time, values.iter().all(Option::is_some)) {
        (true, _) => others.first().copied().flatten(),
        (false, true) => values.first().copied().flatten(),
        (false, false) => None,
    };
    // Lines that are no titles of these columns have their units still.
    let line = source.line(title_line).to_lowercase();
    let has = |is: &dyn Fn(&str) -> bool| others.is_empty() && bracketed(&line).any(is);
    let rated = has(&is_unit_of_velocity) && !has(&|unit| units::factor(unit, quantity).is_some());
    let Some(found) = found.or(rated.then_some("velocity")) else { return Ok(()) };
    let what = if time {
        format!("the first column is {found}, not time")
    } else {
        format!("no column holds {wanted}: they are {found}")
    };
    let error = source
        .error_at(title_line, what)
        .allowed("columns of acceleration, or of displacement with `quantity = \"displacement\"`");
    Err(error.into())
}

/// The layout that file or caller names.
fn layout(source: &Source, options: &TextOptions) -> Result<Option<HistoryLayout>> {
    let named = source.head(HEADER).filter(|(_, line)| is_comment(line) || is_title(line)).find_map(|(index, line)| {
        let lower = line.to_lowercase();
        let word = lower.split_once("layout")?.1.trim_start().strip_prefix([':', '='])?.trim_start();
        let layout = [("rows", HistoryLayout::Rows), ("columns", HistoryLayout::Columns)];
        layout.into_iter().find(|(name, _)| word.starts_with(name)).map(|(name, layout)| (index, name, layout))
    });
    match (named, options.layout) {
        (Some((line, name, found)), Some(given)) if found != given => {
            let error =
                source.error_at(line, format!("the file says that its layout is {name}, the input says otherwise"));
            Err(error.key("layout").help("leave `layout` out").into())
        }
        (Some((.., found)), _) => Ok(Some(found)),
        (None, given) => Ok(given),
    }
}

struct Interval {
    dt: f64,
    line: usize,
    /// Where a time column starts, if not at 0 [s].
    start: Option<f64>,
}

/// Whether the first column is time: its title says so, or it grows. Where an interval is known and it does neither, it is a component.
fn is_timed(table: &Table, names: &[&str], layout: Option<HistoryLayout>, interval_is_known: bool) -> bool {
    if table.columns.len() == 1 || layout == Some(HistoryLayout::Rows) {
        return false;
    }
    let title = names.first().copied().unwrap_or("").to_lowercase();
    let word = title.split(['[', '(', ' ']).find(|word| !word.is_empty()).unwrap_or("").trim_matches(['"', '\'']);
    const TIMES: [&str; 12] =
        ["time", "times", "t", "s", "sec", "seconds", "ms", "zeit", "temps", "tempo", "tiempo", "zaman"];
    TIMES.contains(&word) || grows(&table.columns[0]) || (!interval_is_known && names.is_empty())
}

fn grows(column: &[f64]) -> bool {
    let growing = column.windows(2).filter(|pair| pair[1] > pair[0]).count();
    column.len() > 1 && growing as f64 >= GROWING * (column.len() - 1) as f64
}

/// Columns without time and without titles: many, or such as change less along the rows than along the columns, are hardly components.
fn refuse_doubtful(source: &Source, table: &Table, names: &[&str]) -> Result<()> {
    let count = table.columns.len();
    if table.like_decimal_commas {
        let error = source.error_at(table.lines[0], "two columns of whole numbers, or one with decimal commas?");
        let help = format!("of decimal commas make points; if they are two: {AS_COLUMNS} in the input");
        return Err(error.help(help).into());
    }
    if count == 1 || !names.is_empty() {
        return Ok(());
    }
    let why = if count > MOST_UNTITLED {
        format!("{count} columns without titles and without time")
    } else if looks_like_rows(&table.columns) {
        format!(
            "{count} columns without titles and without time, which change less along the rows than along the columns"
        )
    } else {
        return Ok(());
    };
    let what = format!("{why}: {count} components, or one component row by row?");
    let help = format!(
        "if they are one: {AS_ROWS}; if they are {count}: {AS_COLUMNS} in the same way, or titles above the columns"
    );
    Err(source.error_at(table.lines[0], what).key("layout").allowed("columns, rows").help(help).into())
}

fn looks_like_rows(columns: &[Vec<f64>]) -> bool {
    let rows = columns[0].len();
    let mut along = [0.0, 0.0];
    for k in 0..rows {
        for (c, column) in columns.iter().enumerate() {
            // In a file of one component the first value of a row follows the last one of the row before.
            let before = if c > 0 {
                columns[c - 1][k]
            } else if k > 0 {
                columns[columns.len() - 1][k - 1]
            } else {
                column[k]
            };
            along[0] += (column[k] - before).abs();
            along[1] += if k > 0 { (column[k] - column[k - 1]).abs() } else { 0.0 };
        }
    }
    along[0] < LIKE_ROWS * along[1]
}

/// No time column: the interval comes from the header or the caller.
fn untimed(source: &Source, table: &Table, options: &TextOptions) -> Result<Interval> {
    let data_line = table.lines[0];
    let named = named_interval(source, data_line);
    let (line, dt) = match (named, options.dt) {
        (Some((line, dt)), Some(given)) if (dt - given).abs() > 1e-9 * given.abs() => {
            let what = format!("the file names the interval {dt} s, the input {given} s");
            return Err(source.error_at(line, what).key("dt").help("leave `dt` out").into());
        }
        (Some(named), _) => named,
        (None, Some(given)) => (data_line, given),
        (None, None) => {
            let what = match table.columns.len() {
                1 => "a single column, and no sample interval is named".into(),
                n => format!("{n} columns, none of them time, and no sample interval is named"),
            };
            let help = "add `dt = \"0.005 s\"` to the input, or a line `# dt = 0.005 s` to the file";
            return Err(source.error_at(data_line, what).key("dt").help(help).into());
        }
    };
    Ok(Interval { dt, line, start: None })
}

/// Seconds in the unit that the title of the time column names, 1 where it names none.
fn time_unit(source: &Source, table: &Table) -> f64 {
    let names = column_names(source, table.lines[0], table.columns.len());
    let title = names.first().copied().unwrap_or("").to_lowercase();
    let milli = bracketed(&title).any(|unit| ["ms", "msec", "milliseconds"].contains(&unit));
    if milli { 1e-3 } else { 1.0 }
}

/// A time column: the interval comes from it; the values start at column 1.
fn timed(source: &Source, table: &Table, options: &TextOptions) -> Result<Interval> {
    let unit = time_unit(source, table);
    let time: Vec<f64> = table.columns[0].iter().map(|t| unit * t).collect();
    let n = time.len();
    let first_line = table.lines[0];
    if n < 2 {
        return Err(source
            .error_at(first_line, format!("the file holds {n} sample(s)"))
            .allowed("2 samples or more")
            .into());
    }
    let steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let typical = median(&steps);
    let printed = unit * table.rounding;
    // A column so coarsely rounded that a missing sample would pass for rounding must be even as it is.
    let rounding = if printed <= 0.5 * typical { printed } else { 0.0 };
    let commas = if table.like_decimal_commas { "of decimal commas make points; " } else { "" };
    let hint = format!(
        "{commas}the first of several columns is time; if there is none, give the interval (`dt`); for one component row by \
         row: {AS_ROWS}"
    );
    if !(typical > 0.0 && typical.is_finite()) {
        let error = source.error_at(table.lines[1], format!("the time column does not grow: step {typical} s"));
        return Err(error.allowed("equal steps above 0").help(hint).into());
    }
    // Each of two times is off by half a unit of its last digit at most.
    let tolerance = STEP_TOLERANCE * typical + 1.001 * rounding;
    if let Some(k) = steps.iter().position(|step| (step - typical).abs() > tolerance) {
        let what = format!("the time column steps by {:.6e} s here and by {typical:.6e} s elsewhere", steps[k]);
        return Err(source.error_at(table.lines[k + 1], what).allowed("equal steps").help(hint).into());
    }
    let dt = (time[n - 1] - time[0]) / (n - 1) as f64;
    let off = |(k, t): (usize, &f64)| (t - time[0] - k as f64 * dt).abs() > GRID_TOLERANCE * dt + 1.001 * rounding;
    if let Some(k) = time.iter().enumerate().position(off) {
        let what = format!("the time is {} s here, {} s with equal steps", time[k], time[0] + k as f64 * dt);
        return Err(source.error_at(table.lines[k], what).allowed("equal steps").into());
    }
    let given = options.dt.map(|dt| (first_line, dt)).or_else(|| named_interval(source, first_line));
    let agrees = |named: f64| (named - dt).abs() <= STEP_TOLERANCE * dt;
    if let Some((line, named)) = given.filter(|(_, named)| !agrees(*named)) {
        let what = format!("the interval is named as {named} s, the time column steps by {dt:.6e} s");
        return Err(source.error_at(line, what).key("dt").into());
    }
    let start = Some(time[0]).filter(|start| start.abs() > STEP_TOLERANCE * dt);
    Ok(Interval { dt, line: first_line, start })
}

fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The unit that the header names, and its line.
fn header_unit<'a>(source: &Source<'a>, data_line: usize, quantity: HistoryQuantity) -> Option<(usize, &'a str)> {
    let is_unit = |unit: &&str| units::factor(unit, quantity).is_some();
    let mut lines = source.head(data_line.min(HEADER));
    lines.find_map(|(index, line)| unit_words(line).into_iter().find(is_unit).map(|unit| (index, unit)))
}

/// The unit of a column: from its title, from the rest of the header, from the caller.
fn unit(
    source: &Source,
    data_line: usize,
    title: &str,
    header: Option<(usize, &str)>,
    options: &TextOptions,
) -> Result<(usize, String)> {
    let title_line = data_line.saturating_sub(1);
    let is_unit = |unit: &&str| units::factor(unit, options.quantity).is_some();
    let in_title = bracketed(title).find(is_unit).map(|unit| (title_line, unit));
    match (in_title.or(header), &options.units) {
        (Some((line, unit)), Some(given))
            if units::factor(unit, options.quantity) != units::factor(given, options.quantity) =>
        {
            let what = format!("the file names the unit `{unit}`, the input `{given}`");
            Err(source.error_at(line, what).key("units").help("leave `units` out").into())
        }
        (Some((line, unit)), _) => Ok((line, unit.to_owned())),
        (None, Some(given)) => Ok((data_line, given.clone())),
        (None, None) => Err(no_unit(source, data_line, options.quantity).into()),
    }
}

fn no_unit(source: &Source, data_line: usize, quantity: HistoryQuantity) -> InputError {
    let other = match quantity {
        HistoryQuantity::Acceleration => HistoryQuantity::Displacement,
        HistoryQuantity::Displacement => HistoryQuantity::Acceleration,
    };
    let mut words = source.head(data_line.min(HEADER)).flat_map(|(_, line)| bracketed(line).collect::<Vec<_>>());
    let error = source
        .error_at(data_line, format!("no unit of {} is named", name(quantity)))
        .key("units")
        .allowed(units::allowed(quantity));
    match words.find(|word| units::factor(word, other).is_some()) {
        Some(word) => error.help(format!("`{word}` is a unit of {0}: set `quantity = \"{0}\"`", name(other))),
        None => error.help("add `units = \"cm/s2\"` to the input, or a line `# units: cm/s2` to the file"),
    }
}
