//! National strong-motion network of Turkey (NSMN, AFAD): 17 lines `NAME : value`, titles, then three columns of acceleration in gal without
//! time. Text may be Latin-1. What AFAD writes today has the header of ITACA and ESM and is read as such.

use crate::Result;
use crate::ground::record::{Format, Raw, Record, finish};
use crate::ground::source::{Source, count, free_fields, number, required, rows, unreadable};

/// Lines in which the header is looked for.
const HEADER: usize = 40;

pub(super) fn is_format(source: &Source) -> bool {
    let title = source.line(0).contains("STRONG GROUND MOTION RECORDS OF TURK");
    title || (required(source, HEADER, "NUMBER OF DATA").is_ok() && required(source, HEADER, "RAW PGA VALUES").is_ok())
}

pub(super) fn read(source: &Source) -> Result<Vec<Record>> {
    let (count_line, npts) = required(source, HEADER, "NUMBER OF DATA")?;
    let declared =
        count(npts).ok_or_else(|| unreadable(source, count_line, "NUMBER OF DATA", "a whole number from 2"))?;
    let (dt_line, dt) = required(source, HEADER, "SAMPLING INTERVAL")?;
    let dt = number(dt).ok_or_else(|| unreadable(source, dt_line, "SAMPLING INTERVAL", "a time in seconds"))?;
    let (units_line, _) = required(source, HEADER, "RAW PGA VALUES")?;
    let units = source.line(units_line).split(['(', ')']).nth(1).unwrap_or("").trim();
    let is_data =
        |line: &str| free_fields(line).next().is_some() && free_fields(line).all(|field| number(field).is_some());
    let data_line = (dt_line + 1..HEADER).find(|line| is_data(source.line(*line)));
    let data_line =
        data_line.ok_or_else(|| source.error_at(HEADER.min(source.lines.len()) - 1, "no samples follow the header"))?;
    let titles: Vec<&str> = source.line(data_line - 1).split_whitespace().collect();
    if titles.is_empty() {
        return Err(source.error_at(data_line - 1, "no names of components stand above the samples").into());
    }
    let found = rows(source, data_line, titles.len(), true, |line| Some(free_fields(line).collect()))?;
    if found.lines.len() as u64 != declared {
        return Err(source.count_error(count_line, "NUMBER OF DATA", declared, found.lines.len()).into());
    }
    let text = |key| required(source, HEADER, key).map_or(String::new(), |(_, value)| value.into());
    let station = format!("{} {}", text("STATION ID"), text("PLACE"));
    let record = |(values, title): (Vec<f64>, &str)| {
        finish(
            source,
            Raw {
                dt,
                values,
                units: units.into(),
                station: station.trim().into(),
                event: text("EARTHQUAKE DATE"),
                channel: title.into(),
                dt_line,
                units_line,
                data_line,
                ..Raw::of(Format::Nsmn)
            },
        )
    };
    found.columns.into_iter().zip(titles).map(record).collect()
}
