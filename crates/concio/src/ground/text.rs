//! Columns of text: one column of values with the interval named in the header or by the caller, or a time column
//! and one value column per channel. Columns are parted by comma, semicolon, tab or blanks; with semicolons a comma
//! is a decimal point. Lines that start with `#`, `%` or `//`, and lines that start with a word before the first
//! sample, are header. From the header come the interval (`dt = 0.01 s`, `sampling rate: 200 Hz`) and the unit
//! (`acceleration [cm/s2]`, `units: g`); times are in seconds, or in milliseconds where their title says so (`time [ms]`).

use crate::case::HistoryQuantity;
use crate::ground::record::{Format, Raw, Record, TextOptions, finish, name};
use crate::ground::source::{Source, leading_number, not_a_number, number};
use crate::ground::units;
use crate::{InputError, Result};

/// Lines whose header words are listened to.
const HEADER: usize = 200;
/// How far a time step may be from the others, as a fraction of the interval, beyond what rounding in print explains.
const STEP_TOLERANCE: f64 = 0.01;

pub(super) fn read(source: &Source, options: &TextOptions) -> Result<Vec<Record>> {
    let table = table(source)?;
    let (interval, columns) =
        if table.columns.len() == 1 { single(source, &table, options)? } else { timed(source, &table, options)? };
    let data_line = table.lines[0];
    let names = column_names(source, data_line, table.columns.len());
    let mut records = Vec::new();
    for (index, values) in table.columns.into_iter().enumerate().skip(columns) {
        let title = names.get(index).copied().unwrap_or("");
        let (units_line, units) = unit(source, data_line, title, options)?;
        let raw = Raw {
            format: Format::Text,
            quantity: options.quantity,
            dt: interval.dt,
            values,
            units,
            station: String::new(),
            event: String::new(),
            channel: title.split(['[', '(']).next().unwrap_or("").trim().to_owned(),
            dt_line: interval.line,
            units_line,
            data_line,
        };
        records.push(finish(source, raw)?);
    }
    Ok(records)
}

/// The numbers of the file, column by column, and the line of each row.
struct Table<'a> {
    columns: Vec<Vec<f64>>,
    lines: Vec<usize>,
    /// First field of each row as it is written: its digits tell how far it is rounded.
    first: Vec<&'a str>,
}

fn table<'a>(source: &Source<'a>) -> Result<Table<'a>> {
    let mut table = Table { columns: Vec::new(), lines: Vec::new(), first: Vec::new() };
    for (index, line) in source.lines.iter().copied().enumerate() {
        if line.trim().is_empty() || is_comment(line) || (table.lines.is_empty() && is_title(line)) {
            continue;
        }
        let fields = fields(line);
        if table.columns.is_empty() {
            table.columns = vec![Vec::new(); fields.len()];
        }
        if fields.len() != table.columns.len() {
            let what = format!("{} column(s) here, {} in the lines before", fields.len(), table.columns.len());
            return Err(source.error_at(index, what).allowed("the same number of columns in every line").into());
        }
        for (column, field) in table.columns.iter_mut().zip(&fields) {
            let value = if line.contains(';') { number(&field.replace(',', ".")) } else { number(field) };
            column.push(value.ok_or_else(|| bad_field(source, index, field))?);
        }
        table.lines.push(index);
        table.first.push(fields.first().copied().unwrap_or(""));
    }
    if table.lines.is_empty() {
        let error = source.error("no samples: this is none of the formats that are read");
        return Err(error.allowed("PEER AT2, ITACA/ESM ASC, COSMOS V2, CSMIP V2, USGS SMC, columns of numbers").into());
    }
    Ok(table)
}

fn bad_field(source: &Source, line: usize, field: &str) -> InputError {
    let error = not_a_number(source, line, field);
    let commas = source.line(line).contains(',') && !source.line(line).contains(';');
    if commas { error.help("with decimal commas, part the columns by semicolons") } else { error }
}

fn is_comment(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with(['#', '%']) || line.starts_with("//")
}

/// A line that starts with a word. A word for an infinite or undefined value is a bad sample instead.
fn is_title(line: &str) -> bool {
    let line = line.trim_start().trim_start_matches(['"', '\'', '[', '(']);
    let word: String = line.chars().take_while(|c| c.is_alphabetic()).collect::<String>().to_lowercase();
    !word.is_empty() && !matches!(word.as_str(), "nan" | "inf" | "infinity")
}

/// Fields of a line; a separator at its end makes no field.
fn fields(line: &str) -> Vec<&str> {
    let line = line.trim();
    let separator = if line.contains(';') { Some(';') } else { line.contains(',').then_some(',') };
    match separator {
        Some(separator) => line.strip_suffix(separator).unwrap_or(line).split(separator).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    }
}

struct Interval {
    dt: f64,
    line: usize,
}

/// A single column: the interval comes from the header or the caller; the values start at column 0.
fn single(source: &Source, table: &Table, options: &TextOptions) -> Result<(Interval, usize)> {
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
            let error = source.error_at(data_line, "a single column, and no sample interval is named").key("dt");
            return Err(error
                .help("add `dt = \"0.005 s\"` to the input, or a line `# dt = 0.005 s` to the file")
                .into());
        }
    };
    Ok((Interval { dt, line }, 0))
}

/// The interval that a header line names.
fn named_interval(source: &Source, data_line: usize) -> Option<(usize, f64)> {
    const PERIOD: [&str; 5] = ["dt", "time step", "timestep", "sampling interval", "sample interval"];
    const RATE: [&str; 4] = ["sampling rate", "sample rate", "sampling frequency", "fs"];
    source.head(data_line.min(HEADER)).find_map(|(index, line)| {
        let lower = line.to_lowercase();
        let period = PERIOD.iter().find_map(|key| keyed_number(&lower, key));
        let period = period.map(|(value, unit)| if unit.starts_with("ms") { value * 1e-3 } else { value });
        let rate = || {
            let (value, unit) = RATE.iter().find_map(|key| keyed_number(&lower, key))?;
            Some(if unit.starts_with("khz") { 1e-3 / value } else { 1.0 / value })
        };
        period.or_else(rate).map(|dt| (index, dt))
    })
}

/// The number and the text behind it in `key = 0.01 s`; the key must be a word of its own.
fn keyed_number<'a>(line: &'a str, key: &str) -> Option<(f64, &'a str)> {
    let mut from = 0;
    while let Some(at) = line.get(from..)?.find(key).map(|at| at + from) {
        from = at + key.len();
        let before = line[..at].chars().next_back();
        let rest = line[from..].trim_start();
        let Some(value) = rest.strip_prefix(['=', ':']).filter(|_| before.is_none_or(|c| !c.is_alphanumeric())) else {
            continue;
        };
        let unit =
            value.trim_start().trim_start_matches(|c: char| c.is_ascii_digit() || "+-.e".contains(c)).trim_start();
        return leading_number(value).map(|number| (number, unit));
    }
    None
}

/// Seconds in the unit that the title of the time column names, 1 where it names none.
fn time_unit(source: &Source, table: &Table) -> f64 {
    let names = column_names(source, table.lines[0], table.columns.len());
    let title = names.first().copied().unwrap_or("").to_lowercase();
    let milli = bracketed(&title).any(|unit| ["ms", "msec", "milliseconds"].contains(&unit));
    if milli { 1e-3 } else { 1.0 }
}

/// A time column: the interval comes from it; the values start at column 1.
fn timed(source: &Source, table: &Table, options: &TextOptions) -> Result<(Interval, usize)> {
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
    let rounding = table.first.iter().map(|field| unit * resolution(field)).fold(0.0, f64::max);
    // A column so coarsely rounded that a missing sample would pass for rounding must be even as it is.
    let rounding = if rounding <= 0.5 * typical { rounding } else { 0.0 };
    let hint = "the first of two columns is time; with decimal commas, part the columns by semicolons";
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
    let given = options.dt.map(|dt| (first_line, dt)).or_else(|| named_interval(source, first_line));
    let agrees = |named: f64| (named - dt).abs() <= STEP_TOLERANCE * dt;
    if let Some((line, named)) = given.filter(|(_, named)| !agrees(*named)) {
        let what = format!("the interval is named as {named} s, the time column steps by {dt:.6e} s");
        return Err(source.error_at(line, what).key("dt").into());
    }
    Ok((Interval { dt, line: first_line }, 1))
}

fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// A unit of the last digit of a number as it is written: 0.01 for `1.25`, 1 for `3`, 1e-5 for `1.25e-3`.
fn resolution(field: &str) -> f64 {
    let (mantissa, exponent) = field.split_once(['e', 'E', 'd', 'D']).unwrap_or((field, "0"));
    let decimals = mantissa.split_once(['.', ',']).map_or(0, |(_, decimals)| decimals.len());
    let exponent: i32 = exponent.parse().unwrap_or(0);
    10f64.powi(exponent.saturating_sub(decimals.min(400) as i32))
}

/// Titles of the columns: the last header line, when it has as many fields as there are columns.
fn column_names<'a>(source: &Source<'a>, data_line: usize, columns: usize) -> Vec<&'a str> {
    let above = (0..data_line).rev().map(|index| source.line(index));
    let Some(title) = above.into_iter().find(|line| !line.trim().is_empty()) else { return Vec::new() };
    let title = title.trim_start().trim_start_matches(['#', '%', '/']).trim();
    let separator = [';', ',', '\t'].into_iter().find(|c| title.contains(*c));
    let fields: Vec<&str> = match separator {
        Some(c) => title.split(c).map(|field| field.trim().trim_matches('"')).collect(),
        None if columns == 1 => vec![title],
        None => title.split_whitespace().collect(),
    };
    let keyed = title.contains(['=', ':']);
    if fields.len() == columns && !keyed { fields } else { Vec::new() }
}

/// The unit of a column: from its title, from the rest of the header, from the caller.
fn unit(source: &Source, data_line: usize, title: &str, options: &TextOptions) -> Result<(usize, String)> {
    let is_unit = |unit: &&str| units::factor(unit, options.quantity).is_some();
    let title_line = data_line.saturating_sub(1);
    let in_title = bracketed(title).find(is_unit).map(|unit| (title_line, unit));
    let mut lines = source.head(data_line.min(HEADER));
    let named = in_title.or_else(|| {
        lines.find_map(|(index, line)| unit_words(line).into_iter().find(is_unit).map(|unit| (index, unit)))
    });
    match (named, &options.units) {
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

/// Words of a header line that may be a unit: in brackets, behind `units:`, behind `units of`.
pub(super) fn unit_words(line: &str) -> Vec<&str> {
    let mut words: Vec<&str> = bracketed(line).collect();
    let lower = line.to_ascii_lowercase();
    let key = ["units of", "units", "unit"].into_iter().find_map(|key| lower.find(key).map(|at| at + key.len()));
    if let Some(end_of_key) = key {
        let rest = line[end_of_key..].trim_start().trim_start_matches(['=', ':']).trim_start();
        let end = rest.find(|c: char| c.is_whitespace() || matches!(c, ',' | ';' | '"')).unwrap_or(rest.len());
        words.push(rest[..end].trim_end_matches('.'));
    }
    words
}

/// What stands in square or round brackets.
fn bracketed(line: &str) -> impl Iterator<Item = &str> {
    line.split(['[', '(']).skip(1).filter_map(|part| part.split([']', ')']).next()).map(str::trim)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_of_printed_numbers() {
        for (field, unit) in [("1.25", 0.01), ("3", 1.0), ("1.25e-3", 1e-5), ("1.5E+02", 10.0), ("0,005", 0.001)] {
            assert!((resolution(field) / unit - 1.0).abs() < 1e-12, "{field}");
        }
        assert_eq!(resolution("1e99999999999"), 1.0);
    }

    #[test]
    fn words_of_a_header() {
        assert_eq!(keyed_number("npts = 5, dt= .005 sec", "dt").map(|n| n.0), Some(0.005));
        assert_eq!(keyed_number("width = 5", "dt"), None);
        assert_eq!(unit_words("# Units: cm/s2, corrected"), ["cm/s2"]);
        assert_eq!(unit_words("# acceleration in units of g."), ["g"]);
        assert_eq!(bracketed("time [s], acc [m/s2]").collect::<Vec<_>>(), ["s", "m/s2"]);
    }
}
