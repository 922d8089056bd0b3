//! COSMOS volumes 1 and 2 (`.V1`, `.V2`, `.V2c`): text lines, integer and real header values whose layouts the file names, comments
//! that start with `|`, then samples announced by a line such as
//! `42000 acceleration pts, approx  210 secs, units=cm/sec2(04),Format=(1E15.6)`. A file may hold several channels.
//!
//! The code of the unit in brackets counts (table 2 of the format, version 1.20); what stands before it is free text. The sample interval is
//! real-header value 62, in milliseconds: value 34 is that of the raw record.

use crate::Result;
use crate::case::HistoryQuantity;
use crate::ground::record::{Format as FileFormat, Raw, Record, Remark, finish, tell_fewer};
use crate::ground::source::{
    CUT, Format, Source, after, channels_of_recorder, count, fixed_block, fortran_format, not_a_number, number,
    refuse_more, require_end_mark, unreadable, words,
};
use crate::ground::units;

/// Lines in which the header of the first channel is looked for.
const HEADER: usize = 60;
/// Lines in which the samples of a channel are announced, from its first line: 13 of text, 45 of numbers, and comments.
const ANNOUNCED: usize = 400;
/// Place of the sample interval among the real-header values, from 0.
const INTERVAL: usize = 61;
const UNKNOWN: &str = "unknown/unspecified";
/// Codes of units of acceleration; others are of other quantities.
const CODES: [(u32, &str); 6] = [(2, "g"), (4, "cm/sec2"), (7, "in/sec2"), (10, "gal"), (11, "mg"), (12, "microg")];

pub(super) fn is_format(source: &Source) -> bool {
    let title = source.line(0).to_ascii_lowercase();
    let titled = title.contains("acceleration") && title.contains("(format v");
    titled || source.head(HEADER).any(|(_, line)| line.contains("Real-header values follow"))
}

pub(super) fn read(source: &Source) -> Result<Vec<Record>> {
    let (mut records, mut line, mut channels) = (Vec::new(), 0, 0);
    while let Some(start) = source.next_channel(line) {
        channels += 1;
        let (record, end) = channel(source, start, channels)?;
        records.extend(record);
        line = end;
    }
    if records.is_empty() {
        let error = source.error("the file announces no acceleration samples").key("acceleration pts");
        return Err(error.help("take the acceleration file of the same record").into());
    }
    tell_fewer(&mut records, channels_of_recorder(source, HEADER));
    Ok(records)
}

/// What is announced where: ` pts`, units and the format of the samples.
fn is_announcement(line: &str) -> bool {
    let lower = line.to_ascii_lowercase();
    lower.contains(" pts") && lower.contains("units") && layout(line).is_some()
}

/// The Fortran format behind `Format=`, with or without blanks.
fn layout(line: &str) -> Option<Format> {
    after(line, "format").and_then(|rest| fortran_format(rest.trim_start().strip_prefix('=')?))
}

/// The channel whose header begins at line `start`, and the line behind it; none for one of velocity or displacement.
fn channel(source: &Source, start: usize, place: usize) -> Result<(Option<Record>, usize)> {
    let last = source.lines.len().min(start + ANNOUNCED);
    let index = (start..last).find(|line| is_announcement(source.line(*line)));
    let index = index.ok_or_else(|| {
        let what = format!("the header of channel {place} is not followed by the announcement of its samples");
        source.error_at(last - 1, what).key("acceleration pts").help(CUT)
    })?;
    let line = source.line(index);
    let lower = line.to_ascii_lowercase();
    if lower.contains("raw accel") || lower.contains("counts") {
        let error = source.error_at(index, "the samples are counts of the instrument, not acceleration").key("units");
        return Err(error.help("this is a volume 0: take volume 1 or 2 of the same record").into());
    }
    let declared = line.split_whitespace().next().and_then(count);
    let declared = declared.ok_or_else(|| unreadable(source, index, "acceleration pts", "a whole number from 2"))?;
    let format =
        layout(line).ok_or_else(|| unreadable(source, index, "Format", "a Fortran format such as (8F10.3)"))?;
    let (values, end) = fixed_block(source, index + 1, declared, format, "acceleration pts")?;
    refuse_more(source, end, declared, "acceleration pts")?;
    require_end_mark(source, end)?;
    if !lower.contains("acceleration pts") {
        return Ok((None, end));
    }
    let (dt_line, dt) = interval(source, start, index)?;
    refuse_unknown(source, index + 1, &values, unknown(source, start, index), format)?;
    let (units, remark) = units(source, index)?;
    let label = words(source.line(start + 8));
    let label = label.trim_start_matches("Sta Chan").trim_start_matches("Sta Cha:").trim().to_owned();
    let record = finish(
        source,
        Raw {
            dt,
            values,
            units,
            station: words(source.line(start + 4)).trim_start_matches("Statn No: ").to_owned(),
            event: words(source.line(start + 1)).trim_start_matches("Record of ").to_owned(),
            channel: label,
            dt_line,
            units_line: index,
            data_line: index + 1,
            remarks: remark.into_iter().collect(),
            ..Raw::of(FileFormat::Cosmos)
        },
    )?;
    Ok((Some(record), end))
}

/// The sample interval [s] and its line, from the real-header values of the channel.
fn interval(source: &Source, start: usize, before: usize) -> Result<(usize, f64)> {
    let line = (start..before).rev().find(|index| source.line(*index).contains("Real-header values follow"));
    let line = line.ok_or_else(|| source.error_at(before, "no real-header values stand before these samples"))?;
    let text = source.line(line);
    let announced = text.split_whitespace().next().and_then(count).zip(layout(text));
    let (number_of, format) = announced.ok_or_else(|| {
        let error = source.error_at(line, "the announcement of the real-header values is incomplete");
        error.allowed("100 Real-header values follow on  20 lines, Format= (5F15.6)")
    })?;
    let (values, _) = fixed_block(source, line + 1, number_of, format, "Real-header values")?;
    let dt_line = line + 1 + INTERVAL / format.per_line;
    let unknown = unknown(source, start, before);
    let interval = values.get(INTERVAL).copied().filter(|dt| Some(*dt) != unknown);
    let interval = interval.ok_or_else(|| {
        let error = source.error_at(dt_line, "the header does not give the sample interval");
        error.key("real-header value 62").allowed("an interval in milliseconds")
    })?;
    Ok((dt_line, interval * 1e-3))
}

/// The number after the comma in `Values used when parameter or data value is unknown/unspecified:   -999, -999.00`.
fn unknown(source: &Source, start: usize, before: usize) -> Option<f64> {
    let line = (start..before).map(|index| source.line(index)).find(|line| line.contains(UNKNOWN))?;
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

/// The unit of `units=g.     (02)Format=…`: of its code, and in words where there is none. Told is a code that the words contradict.
fn units(source: &Source, index: usize) -> Result<(String, Option<Remark>)> {
    let rest = after(source.line(index), "units").unwrap_or("").trim_start().trim_start_matches('=');
    let in_words = rest.split(['(', ',']).next().unwrap_or("").trim().trim_end_matches('.').trim().to_owned();
    // The brackets of the format are no code.
    let code =
        rest.split_once('(').and_then(|(_, code)| code.split_once(')')).and_then(|(code, _)| code.trim().parse().ok());
    let Some(code): Option<u32> = code else { return Ok((in_words, None)) };
    let Some((_, of_code)) = CODES.iter().find(|(known, _)| *known == code) else {
        let what = format!("the code {code:02} is not one of a unit of acceleration");
        let codes: Vec<String> = CODES.iter().map(|(code, unit)| format!("{code:02} ({unit})")).collect();
        return Err(source.error_at(index, what).key("units").allowed(codes.join(", ")).into());
    };
    let factor = |unit: &str| units::factor(unit, HistoryQuantity::Acceleration);
    match factor(&in_words) {
        found if found == factor(of_code) => Ok((in_words, None)),
        None => Ok(((*of_code).into(), None)),
        Some(_) => Ok(((*of_code).into(), Some(Remark::UnitByCode { code }))),
    }
}
