//! PEER NGA time series (`.AT2`): a few text lines, one with `NPTS` and `DT`, then acceleration in g.
//!
//! The number line has several dialects: `NPTS=  4000, DT= .01000 SEC`, the same in lower case, without `SEC` or
//! with a trailing comma, `4000  .01000  NPTS, DT`, and the two keys on lines of their own.

use crate::Result;
use crate::case::HistoryQuantity;
use crate::ground::record::{Format, Raw, Record, finish};
use crate::ground::source::{Source, count, free_fields, leading_number, not_a_number, number, whole};
use crate::ground::text::unit_words;
use crate::ground::units;

/// Lines in which the header is looked for.
const HEADER: usize = 60;

/// A line with the word NPTS and its value that is not a comment of a text file. Prose and other formats (JSON) may
/// mention the word.
pub(super) fn is_format(source: &Source) -> bool {
    find(source, "NPTS").is_some_and(|(index, after)| {
        let leads = source.line(index).split_whitespace().next().and_then(count).is_some();
        leads || after.trim_start().starts_with(['=', ':'])
    })
}

pub(super) fn read(source: &Source) -> Result<Record> {
    let header = header(source)?;
    let (units_line, units) = units(source, header.end)?;
    let mut values = Vec::new();
    for (index, line) in source.lines.iter().enumerate().skip(header.end) {
        for field in free_fields(line) {
            values.push(number(field).ok_or_else(|| not_a_number(source, index, field))?);
        }
        source.room(index, values.len())?;
    }
    if header.npts != values.len() as u64 {
        return Err(source.count_error(header.npts_line, "NPTS", header.npts, values.len()).into());
    }
    finish(
        source,
        Raw {
            dt: header.dt,
            values,
            units,
            event: source.line(1).trim().to_owned(),
            dt_line: header.dt_line,
            units_line,
            data_line: header.end,
            ..Raw::of(Format::PeerAt2)
        },
    )
}

struct Header {
    npts: u64,
    npts_line: usize,
    dt: f64,
    dt_line: usize,
    /// First line of the samples.
    end: usize,
}

fn header(source: &Source) -> Result<Header> {
    let missing = |key: &str| source.error(format!("the header has no {key}")).key(key.to_owned());
    let (npts_line, after) = find(source, "NPTS").ok_or_else(|| missing("NPTS"))?;
    if !after.trim_start().starts_with(['=', ':']) {
        return numbers_first(source, npts_line);
    }
    let bad = |line: usize, key: &str, allowed: &str| {
        let text: String = source.line(line).trim().chars().take(60).collect();
        source.error_at(line, format!("`{text}` gives no number")).key(key.to_owned()).allowed(allowed.to_owned())
    };
    let npts = leading_number(value(after)).and_then(whole);
    let npts = npts.ok_or_else(|| bad(npts_line, "NPTS", "a whole number from 2"))?;
    let (dt_line, after) = find(source, "DT").ok_or_else(|| missing("DT"))?;
    let dt = leading_number(value(after)).ok_or_else(|| bad(dt_line, "DT", "a time in seconds"))?;
    Ok(Header { npts, npts_line, dt, dt_line, end: npts_line.max(dt_line) + 1 })
}

/// `4000  .01000  NPTS, DT`
fn numbers_first(source: &Source, line: usize) -> Result<Header> {
    let mut fields = source.line(line).split_whitespace();
    let npts = fields.next().and_then(count);
    let dt = fields.next().and_then(number);
    match (npts, dt) {
        (Some(npts), Some(dt)) => Ok(Header { npts, npts_line: line, dt, dt_line: line, end: line + 1 }),
        _ => {
            let error = source.error_at(line, "NPTS and DT have no values").key("NPTS");
            Err(error.help("write `NPTS=  4000, DT= .01000 SEC`").into())
        }
    }
}

/// The text behind `NPTS =`.
fn value(after: &str) -> &str {
    after.trim_start().trim_start_matches(['=', ':'])
}

/// The first header line with `key` as a word, and what follows the key.
fn find<'a>(source: &Source<'a>, key: &str) -> Option<(usize, &'a str)> {
    let lines = source.head(HEADER).filter(|(_, line)| !line.trim_start().starts_with(['#', '%']));
    for (index, line) in lines {
        let upper = line.to_ascii_uppercase();
        let mut from = 0;
        while let Some(at) = upper.get(from..).and_then(|rest| rest.find(key)).map(|at| at + from) {
            let end = at + key.len();
            let bytes = upper.as_bytes();
            let alone = (at == 0 || !bytes[at - 1].is_ascii_alphanumeric())
                && bytes.get(end).is_none_or(|b| !b.is_ascii_alphanumeric());
            if alone {
                return Some((index, &line[end..]));
            }
            from = end;
        }
    }
    None
}

/// The unit that the header names, and its line; g when it names none, as the format says. Programs that borrow the
/// header's form for other units write them in brackets or behind `units:`.
fn units(source: &Source, end: usize) -> Result<(usize, String)> {
    for (index, line) in source.head(end) {
        let upper = line.to_ascii_uppercase();
        if ["VELOCITY TIME", "DISPLACEMENT TIME"].iter().any(|other| upper.contains(other)) {
            let error = source.error_at(index, "this is not an acceleration history");
            return Err(error.allowed("ACCELERATION").help("take the `.AT2` file of the same record").into());
        }
        let Some(at) = upper.find("UNITS OF ") else { continue };
        let unit = line[at + "UNITS OF ".len()..].trim_start();
        let end = unit.find(|c: char| c.is_whitespace() || matches!(c, '.' | ',' | ';')).unwrap_or(unit.len());
        return Ok((index, unit[..end].to_owned()));
    }
    let is_unit = |unit: &&str| units::factor(unit, HistoryQuantity::Acceleration).is_some();
    let mut lines = source.head(end);
    let named = lines.find_map(|(index, line)| unit_words(line).into_iter().find(is_unit).map(|unit| (index, unit)));
    let (line, unit) = named.unwrap_or((0, "g"));
    Ok((line, unit.to_owned()))
}
