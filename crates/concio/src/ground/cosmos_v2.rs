//! COSMOS volume 2 (`.V2`, `.V2c`): text lines, integer and real header values whose layouts the file names, comments
//! that start with `|`, then samples announced by a line such as
//! `42000 acceleration pts, approx  210 secs, units=cm/sec2(04),Format=(1E15.6)`. A file may hold several channels.
//!
//! The sample interval is real-header value 62, in milliseconds: value 34 is that of the raw record.

use crate::Result;
use crate::case::HistoryQuantity;
use crate::ground::record::{Format as FileFormat, Raw, Record, finish};
use crate::ground::source::{Format, Source, count, fixed_block, fortran_format, not_a_number, number};

/// Lines in which the header of the first channel is looked for.
const HEADER: usize = 60;
/// Place of the sample interval among the real-header values, from 0.
const INTERVAL: usize = 61;

pub(super) fn is_format(source: &Source) -> bool {
    source.head(HEADER).any(|(_, line)| line.contains("Real-header values follow"))
}

pub(super) fn read(source: &Source) -> Result<Vec<Record>> {
    let announcements = source.lines.iter().enumerate().filter(|(_, line)| is_announcement(line));
    let channels: Vec<Record> =
        announcements.map(|(index, line)| channel(source, index, line)).collect::<Result<_>>()?;
    if channels.is_empty() {
        let error = source.error("the file announces no acceleration samples").key("acceleration pts");
        return Err(error.help("take the acceleration file of the same record").into());
    }
    Ok(channels)
}

fn is_announcement(line: &str) -> bool {
    let lower = line.to_ascii_lowercase();
    lower.contains("acceleration pts") && lower.contains("format=")
}

fn channel(source: &Source, index: usize, line: &str) -> Result<Record> {
    let bad = |key: &'static str, allowed: &'static str| {
        source.error_at(index, "the announcement of the samples is incomplete").key(key).allowed(allowed)
    };
    let declared = line.split_whitespace().next().and_then(count);
    let declared = declared.ok_or_else(|| bad("acceleration pts", "a whole number from 2"))?;
    let format = after(line, "format=").and_then(fortran_format);
    let format = format.ok_or_else(|| bad("Format", "a Fortran format such as (8F10.3)"))?;
    let units = after(line, "units=").unwrap_or("").split(['(', ',']).next().unwrap_or("").trim().to_owned();
    let (reals_line, reals) = reals(source, index)?;
    let dt_line = reals_line + 1 + INTERVAL / reals.format.per_line;
    let interval = reals.values.get(INTERVAL).copied().filter(|dt| Some(*dt) != reals.unknown);
    let interval = interval.ok_or_else(|| {
        let error = source.error_at(dt_line, "the header does not give the sample interval");
        error.key("real-header value 62").allowed("an interval in milliseconds")
    })?;
    let (values, _) = fixed_block(source, index + 1, declared, format, "acceleration pts")?;
    refuse_unknown(source, index + 1, &values, reals.unknown, format)?;
    refuse_more(source, index, declared, values.len().div_ceil(format.per_line))?;
    let start = start_of_channel(source, index);
    finish(
        source,
        Raw {
            format: FileFormat::CosmosV2,
            quantity: HistoryQuantity::Acceleration,
            dt: interval * 1e-3,
            values,
            units,
            station: words(source.line(start + 4)).trim_start_matches("Statn No: ").to_owned(),
            event: words(source.line(start + 1)).trim_start_matches("Record of ").to_owned(),
            channel: words(source.line(start + 8)).trim_start_matches("Sta Chan ").to_owned(),
            dt_line,
            units_line: index,
            data_line: index + 1,
        },
    )
}

struct Reals {
    values: Vec<f64>,
    format: Format,
    /// The value that stands for "not known".
    unknown: Option<f64>,
}

/// The real-header values that precede line `before`.
fn reals(source: &Source, before: usize) -> Result<(usize, Reals)> {
    let mut above = (0..before).rev();
    let line = above.find(|index| source.line(*index).contains("Real-header values follow"));
    let line = line.ok_or_else(|| source.error_at(before, "no real-header values stand before these samples"))?;
    let text = source.line(line);
    let layout = text.split_whitespace().next().and_then(count).zip(after(text, "format=").and_then(fortran_format));
    let (number_of, format) = layout.ok_or_else(|| {
        let error = source.error_at(line, "the announcement of the real-header values is incomplete");
        error.allowed("100 Real-header values follow on  20 lines, Format= (5F15.6)")
    })?;
    let (values, _) = fixed_block(source, line + 1, number_of, format, "Real-header values")?;
    Ok((line, Reals { values, format, unknown: unknown(source, line) }))
}

/// The number after the comma in `Values used when parameter or data value is unknown/unspecified:   -999, -999.00`.
fn unknown(source: &Source, before: usize) -> Option<f64> {
    let mut above = (0..before).rev().map(|index| source.line(index));
    let line = above.find(|line| line.contains("unknown/unspecified"))?;
    number(line.rsplit_once(',')?.1)
}

/// A sample with the value for "not known" is a gap.
fn refuse_unknown(source: &Source, start: usize, values: &[f64], unknown: Option<f64>, format: Format) -> Result<()> {
    let Some(unknown) = unknown else { return Ok(()) };
    let Some(k) = values.iter().position(|value| *value == unknown) else { return Ok(()) };
    let line = start + k / format.per_line;
    Err(not_a_number(source, line, &unknown.to_string())
        .help("the header says that this value stands for an unknown sample")
        .into())
}

fn refuse_more(source: &Source, index: usize, declared: u64, lines: usize) -> Result<()> {
    let next = source.line(index + 1 + lines).trim();
    if next.is_empty() || next.bytes().any(|b| b.is_ascii_alphabetic() && !matches!(b, b'e' | b'E')) {
        return Ok(());
    }
    let error =
        source.error_at(index + 1 + lines, format!("more samples than the {declared} that the header declares"));
    Err(error.key("acceleration pts").into())
}

/// The first text line of the channel: after the end of the channel before it.
fn start_of_channel(source: &Source, announcement: usize) -> usize {
    let mut above = (0..announcement).rev();
    above.find(|index| source.line(*index).starts_with("End-of-data")).map_or(0, |index| index + 1)
}

/// What follows `key`, which is in lower case, in any case.
fn after<'a>(line: &'a str, key: &str) -> Option<&'a str> {
    line.to_ascii_lowercase().find(key).map(|at| &line[at + key.len()..])
}

fn words(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}
