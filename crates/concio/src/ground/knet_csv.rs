//! K-NET and KiK-net as CSV: header lines that start with `#`, each name above its value, then date, time since the first sample, and a
//! column for each direction in gal (`N-S(gal),E-W(gal),U-D(gal)`; KiK-net numbers six of them).
//!
//! The values stand on the offset of the instrument, as in the ASCII files: their mean is taken off. How many rows there are follows from
//! duration and sampling frequency.

use crate::Result;
use crate::ground::knet::direction;
use crate::ground::record::{Format, Raw, Record, finish};
use crate::ground::source::{Source, missing, number, refuse_other_times, rows, unreadable};

/// Lines in which the header is looked for.
const HEADER: usize = 60;
/// Half a unit of the last digit of the times [s].
const ROUNDING: f64 = 0.005;

pub(super) fn is_format(source: &Source) -> bool {
    source.line(0).trim_start().starts_with("#K-NET CSV") || find(source, "#Time,RelativeTime").is_some()
}

pub(super) fn read(source: &Source) -> Result<Vec<Record>> {
    let (dt_line, rate) = below(source, "#SamplingFrequency")?;
    let rate = number(rate).filter(|rate| *rate > 0.0);
    let rate = rate.ok_or_else(|| unreadable(source, dt_line, "SamplingFrequency(Hz)", "a frequency above 0"))?;
    let (count_line, duration) = below(source, "#DurationTime")?;
    let duration = number(duration).filter(|seconds| *seconds > 0.0);
    let duration = duration.ok_or_else(|| unreadable(source, count_line, "DurationTime(s)", "seconds above 0"))?;
    let (titles_line, titles) =
        find(source, "#Time,RelativeTime").ok_or_else(|| missing(source, HEADER, "#Time,RelativeTime(s),…"))?;
    let titles: Vec<&str> = titles.split(',').skip(2).map(str::trim).collect();
    if titles.is_empty() {
        return Err(source.error_at(titles_line, "no component is named here").into());
    }
    let data_line = titles_line + 1;
    // The date is no number: the time since the first sample says the same.
    let found = rows(source, data_line, titles.len() + 1, false, |line| {
        Some(line.split(',').skip(1).map(str::trim).collect())
    })?;
    let declared = (rate * duration).round() as u64;
    if found.lines.len() as u64 != declared {
        return Err(source.count_error(count_line, "DurationTime(s)", declared, found.lines.len()).into());
    }
    refuse_other_times(source, &found, 0, 1.0 / rate, ROUNDING)?;
    let first = |key: &'static str| {
        below(source, key).map_or(String::new(), |(_, text)| text.split(',').next().unwrap_or("").into())
    };
    let (station, event) = (first("#Code"), first("#OriginTime"));
    let components = found.columns.into_iter().skip(1).zip(titles);
    let record = |(values, title): (Vec<f64>, &str)| {
        let (name, unit) = title.split_once('(').unwrap_or((title, ""));
        finish(
            source,
            Raw {
                dt: 1.0 / rate,
                values,
                units: unit.trim_end_matches(')').trim().into(),
                station: station.clone(),
                event: event.clone(),
                channel: direction(name.trim()),
                dt_line,
                units_line: titles_line,
                data_line,
                offset: true,
                ..Raw::of(Format::KnetCsv)
            },
        )
    };
    components.map(record).collect()
}

fn find<'a>(source: &Source<'a>, start: &str) -> Option<(usize, &'a str)> {
    source.head(HEADER).find(|(_, line)| line.starts_with(start))
}

/// What stands in the line below the one that starts with `name`, and the line.
fn below<'a>(source: &Source<'a>, name: &'static str) -> Result<(usize, &'a str)> {
    let (line, _) = find(source, name).ok_or_else(|| missing(source, HEADER, name))?;
    Ok((line + 1, source.line(line + 1).trim_start_matches('#').trim()))
}
