//! Central Weather Administration of Taiwan (CWA, before that the Bureau, CWB): lines `#Name: value`, then time and a column for each
//! direction in gal, in fields of ten characters (`#Data: 4F10.3`).

use crate::Result;
use crate::ground::record::{Format as FileFormat, Raw, Record, Remark, finish};
use crate::ground::source::{
    Source, fixed_fields, fortran_format, missing, named, number, refuse_other_times, required, rows, unreadable,
};

/// Lines in which the header is looked for.
const HEADER: usize = 60;
/// A unit of the last digit of the times [s].
const ROUNDING: f64 = 0.001;

/// Three of the names, so that a file whose header is damaged still counts as one.
pub(super) fn is_format(source: &Source) -> bool {
    const NAMES: [&str; 5] = ["#StationCode", "#SampleRate", "#RecordLength", "#AmplitudeUnit", "#DataSequence"];
    NAMES.iter().filter(|name| named(source, HEADER, name).is_some()).count() >= 3
}

pub(super) fn read(source: &Source) -> Result<Vec<Record>> {
    let (dt_line, rate) = required(source, HEADER, "#SampleRate")?;
    let rate = number(rate).filter(|rate| *rate > 0.0);
    let rate = rate.ok_or_else(|| unreadable(source, dt_line, "SampleRate(Hz)", "a rate above 0"))?;
    let (count_line, length) = required(source, HEADER, "#RecordLength")?;
    let length = number(length).filter(|seconds| *seconds > 0.0);
    let length = length.ok_or_else(|| unreadable(source, count_line, "RecordLength(sec)", "seconds above 0"))?;
    let (units_line, unit) = required(source, HEADER, "#AmplitudeUnit")?;
    let unit = unit.split([' ', '.', ',']).next().unwrap_or("");
    let (sequence_line, sequence) = required(source, HEADER, "#DataSequence")?;
    let names = components(sequence);
    if names.is_empty() {
        return Err(
            unreadable(source, sequence_line, "DataSequence", "a sequence such as `Time U(+); N(+); E(+)`").into()
        );
    }
    let format = source.head(HEADER).find_map(|(line, text)| Some((line, text.strip_prefix("#Data:")?)));
    let (format_line, format) = format.ok_or_else(|| missing(source, HEADER, "#Data"))?;
    let data_line =
        (format_line.max(sequence_line) + 1..source.lines.len()).find(|line| !source.line(*line).trim().is_empty());
    let data_line = data_line.ok_or_else(|| source.error_at(source.lines.len() - 1, "no samples follow the header"))?;
    let width = fortran_format(format)
        .ok_or_else(|| unreadable(source, format_line, "Data", "a Fortran format such as 4F10.3"))?
        .width;
    let found = rows(source, data_line, names.len() + 1, true, |line| fixed_fields(line, width))?;
    let declared = (rate * length).round() as u64;
    if found.lines.len() as u64 != declared {
        return Err(source.count_error(count_line, "RecordLength(sec)", declared, found.lines.len()).into());
    }
    refuse_other_times(source, &found, 0, 1.0 / rate, ROUNDING)?;
    let start = found.columns[0].first().copied().unwrap_or(0.0);
    let remarks: Vec<Remark> = (start.abs() > ROUNDING).then_some(Remark::Start { time: start }).into_iter().collect();
    let text = |key| named(source, HEADER, key).map_or("", |(_, value)| value);
    let record = |(values, name): (Vec<f64>, String)| {
        finish(
            source,
            Raw {
                dt: 1.0 / rate,
                values,
                units: unit.into(),
                station: format!("{} {}", text("#StationCode"), text("#StationName")).trim().into(),
                event: text("#Origin Time").into(),
                channel: name,
                dt_line,
                units_line,
                data_line,
                remarks: remarks.clone(),
                ..Raw::of(FileFormat::Cwb)
            },
        )
    };
    found.columns.into_iter().skip(1).zip(names).map(record).collect()
}

/// `U`, `N` and `E` of `Time U(+); N(+); E(+)`.
fn components(sequence: &str) -> Vec<String> {
    let sequence = sequence.trim().strip_prefix("Time").unwrap_or(sequence);
    let name = |part: &str| part.split('(').next().unwrap_or("").trim().to_owned();
    sequence.split(';').map(name).filter(|name| !name.is_empty()).collect()
}
