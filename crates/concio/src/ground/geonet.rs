//! GeoNet, New Zealand, volumes 1 and 2 (`.V1A`, `.V2A`): for each component 16 lines of text, 40 integers (10I8), 60 reals (10F8.0), then
//! acceleration in mm/s², and in volume 2 velocity and displacement, in fields of eight characters, ten in a line.
//!
//! Integers 34, 35 and 36 count them, with what the processing put before and behind the record: times of peaks in the header do not know of
//! it. The interval stands in the text. Velocity and displacement are passed over, but must be there.
//! W. J. Cousins, GNS accelerogram data files: standard format (2008).

use crate::Result;
use crate::ground::record::{Format as FileFormat, Raw, Record, finish, tell_fewer};
use crate::ground::source::{
    CUT, Format, Source, after, fixed_block, leading_number, refuse_more, unreadable, whole, words,
};

/// Components of an instrument, one file for all.
const COMPONENTS: u64 = 3;
const TEXT_LINES: usize = 16;
const INTEGERS: Format = Format { per_line: 10, width: 8 };
const INTEGER_LINES: usize = 4;
const HEADER: usize = TEXT_LINES + INTEGER_LINES + 6;
/// Places of the counts of acceleration, velocity and displacement among the integers, from 0.
const COUNTS: [usize; 3] = [33, 34, 35];
const BLOCKS: [&str; 3] = ["acceleration samples", "velocity samples", "displacement samples"];

/// `Corrected accelerogram` or its opposite, and the lines that no other format has.
pub(super) fn is_format(source: &Source) -> bool {
    let lower = source.line(0).to_ascii_lowercase();
    let starts = |start: &str| source.head(TEXT_LINES).any(|(_, line)| line.starts_with(start));
    let marks =
        [lower.contains("corrected accelerogram"), starts("Site "), starts("Number of points"), starts("Component ")];
    marks.into_iter().filter(|mark| *mark).count() >= 3
}

pub(super) fn read(source: &Source) -> Result<Vec<Record>> {
    let (mut records, mut line) = (Vec::new(), 0);
    while let Some(start) = source.next_channel(line) {
        let (record, end) = component(source, start, records.len() + 1)?;
        records.push(record);
        line = end;
    }
    tell_fewer(&mut records, Some(COMPONENTS));
    Ok(records)
}

/// The component whose header begins at line `start`, and the line behind it.
fn component(source: &Source, start: usize, number: usize) -> Result<(Record, usize)> {
    if source.lines.len() < start + HEADER + 1 {
        let error = source.error_at(source.lines.len() - 1, format!("the header of component {number} is not whole"));
        return Err(error.help(CUT).into());
    }
    let integers_line = start + TEXT_LINES;
    let (integers, _) = fixed_block(source, integers_line, 40, INTEGERS, "integers of the header")?;
    let counts_line = integers_line + INTEGER_LINES - 1;
    let count = |block: usize| {
        let value = integers.get(COUNTS[block]).copied().and_then(whole);
        value.ok_or_else(|| unreadable(source, counts_line, BLOCKS[block], "a whole number from 0"))
    };
    let (dt_line, dt) = interval(source, start)?;
    let (units_line, unit) = unit(source, start)?;
    let data_line = start + HEADER;
    let declared = count(0)?;
    let (mut values, mut end) = fixed_block(source, data_line, declared, INTEGERS, BLOCKS[0])?;
    for block in [1, 2] {
        (_, end) = fixed_block(source, end, count(block)?, INTEGERS, BLOCKS[block])?;
    }
    refuse_more(source, end, declared, BLOCKS[0])?;
    values.iter_mut().for_each(|value| *value *= unit);
    let station = [source.line(start + 1), source.line(start + 2)].map(words);
    let code = station[0].split(' ').nth(1).unwrap_or("");
    let record = finish(
        source,
        Raw {
            dt,
            values,
            units: "mm/s/s".into(),
            station: format!("{code} {}", station[1]).trim().into(),
            event: words(&format!("{} {}", source.line(start + 7), source.line(start + 6))),
            channel: words(source.line(start + 12).trim_start_matches("Component")),
            dt_line,
            units_line,
            data_line,
            ..Raw::of(FileFormat::Geonet)
        },
    )?;
    Ok((record, end))
}

/// `Instrument corrected data at 0.020 sec intervals`, `Raw readings in units of 1.00 mm/s/s  at intervals of 0.005 s`.
fn interval(source: &Source, start: usize) -> Result<(usize, f64)> {
    let line = (start..start + TEXT_LINES).find(|line| source.line(*line).contains("intervals"));
    let line = line.ok_or_else(|| {
        let error = source.error_at(start + TEXT_LINES - 1, "the text of the header names no interval");
        error.key("interval").allowed("a line such as `Instrument corrected data at 0.020 sec intervals`")
    })?;
    let text = source.line(line);
    let dt = after(text, "intervals of")
        .and_then(leading_number)
        .or_else(|| after(text, "data at").and_then(leading_number));
    Ok((line, dt.ok_or_else(|| unreadable(source, line, "interval", "a time in seconds"))?))
}

/// Raw readings may be in multiples of 1 mm/s².
fn unit(source: &Source, start: usize) -> Result<(usize, f64)> {
    let line = (start..start + TEXT_LINES).find(|line| source.line(*line).contains("in units of"));
    let Some(line) = line else { return Ok((start, 1.0)) };
    let text = after(source.line(line), "in units of").unwrap_or("");
    let unit = leading_number(text).filter(|unit| *unit > 0.0 && text.contains("mm/s/s"));
    Ok((line, unit.ok_or_else(|| unreadable(source, line, "units", "a factor and mm/s/s"))?))
}
