//! ITACA, ESM and AFAD (`.ASC`): `KEY: value` lines (64 of them in DYNA 1.2), then one sample a line.

use crate::Result;
use crate::case::HistoryQuantity;
use crate::ground::record::{Format, Raw, Record, finish};
use crate::ground::source::{Source, count, missing, not_a_number, number, unreadable};

/// Lines in which the header is looked for.
const HEADER: usize = 200;

pub(super) fn is_format(source: &Source) -> bool {
    find(source, "SAMPLING_INTERVAL_S").is_some() || find(source, "NDATA").is_some()
}

pub(super) fn read(source: &Source) -> Result<Record> {
    let (npts_line, npts) = required(source, "NDATA")?;
    let declared = count(npts).ok_or_else(|| unreadable(source, npts_line, "NDATA", "a whole number from 2"))?;
    let (dt_line, dt) = required(source, "SAMPLING_INTERVAL_S")?;
    let dt = number(dt).ok_or_else(|| unreadable(source, dt_line, "SAMPLING_INTERVAL_S", "a time in seconds"))?;
    let (units_line, units) = required(source, "UNITS")?;
    let quantity = quantity(source)?;
    let data_line = header_end(source);
    let values = samples(source, data_line)?;
    if values.len() as u64 != declared {
        return Err(source.count_error(npts_line, "NDATA", declared, values.len()).into());
    }
    finish(
        source,
        Raw {
            quantity,
            dt,
            values,
            units: units.to_owned(),
            station: joined(source, ["NETWORK", "STATION_CODE"], "."),
            event: joined(source, ["EVENT_NAME", "EVENT_DATE_YYYYMMDD"], " "),
            channel: text(source, "STREAM").to_owned(),
            dt_line,
            units_line,
            data_line,
            ..Raw::of(Format::ItacaAsc)
        },
    )
}

/// Line and value of a key.
fn find<'a>(source: &Source<'a>, key: &str) -> Option<(usize, &'a str)> {
    source.head(HEADER).find_map(|(index, line)| {
        let (name, value) = line.split_once(':')?;
        (name.trim() == key).then_some((index, value.trim()))
    })
}

fn required<'a>(source: &Source<'a>, key: &'static str) -> Result<(usize, &'a str)> {
    find(source, key).ok_or_else(|| missing(source, header_end(source), key).into())
}

fn text<'a>(source: &Source<'a>, key: &str) -> &'a str {
    find(source, key).map_or("", |(_, value)| value)
}

fn joined(source: &Source, keys: [&str; 2], between: &str) -> String {
    let values = keys.map(|key| text(source, key));
    let named: Vec<_> = values.into_iter().filter(|value| !value.is_empty()).collect();
    named.join(between)
}

fn quantity(source: &Source) -> Result<HistoryQuantity> {
    match find(source, "DATA_TYPE") {
        None | Some((_, "")) => Ok(HistoryQuantity::Acceleration),
        // `UNPROCESSED ACCELERATION` too.
        Some((_, kind)) if kind.ends_with("ACCELERATION") => Ok(HistoryQuantity::Acceleration),
        Some((_, kind)) if kind.ends_with("DISPLACEMENT") => Ok(HistoryQuantity::Displacement),
        Some((line, other)) => {
            let shown: String = other.chars().take(40).collect();
            let error = source.error_at(line, format!("a history of `{shown}` is not read")).key("DATA_TYPE");
            Err(error.allowed("ACCELERATION, DISPLACEMENT").help("take the `.ACC.ASC` file of the same record").into())
        }
    }
}

/// The first line after the header that has no key.
fn header_end(source: &Source) -> usize {
    let is_key = |line: &str| line.split_once(':').is_some_and(|(key, _)| number(key).is_none());
    let last = source.head(HEADER).filter(|(_, line)| is_key(line)).last();
    last.map_or(0, |(index, _)| index + 1)
}

fn samples(source: &Source, start: usize) -> Result<Vec<f64>> {
    let mut values = Vec::new();
    for (index, line) in source.lines.iter().enumerate().skip(start) {
        for field in line.split_whitespace() {
            values.push(number(field).ok_or_else(|| not_a_number(source, index, field))?);
        }
        source.room(index, values.len())?;
    }
    Ok(values)
}
