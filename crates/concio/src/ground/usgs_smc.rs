//! USGS strong-motion compact disc (`.smc`): 11 text lines, 48 integers (8I10), 50 reals (5E15.7), comments that
//! start with `|`, then samples of fixed width, usually 8(1PE10.4E1). Acceleration in cm/s², displacement in cm.

use crate::Result;
use crate::case::HistoryQuantity;
use crate::ground::record::{Format as FileFormat, Raw, Record, finish};
use crate::ground::source::{Format, Source, fixed_block, fixed_fields, not_a_number, number};

const TEXT_LINES: usize = 11;
const INTEGERS: Format = Format { per_line: 8, width: 10 };
const INTEGER_LINES: usize = 6;
const REALS: Format = Format { per_line: 5, width: 15 };
const REAL_LINES: usize = 10;
/// Values that stand for "not known".
const NO_INTEGER: f64 = -32768.0;
const NO_REAL: f64 = 1.7e38;
/// Layouts of the samples: the usual one, then those of files with more digits.
const SAMPLES: [Format; 3] =
    [Format { per_line: 8, width: 10 }, Format { per_line: 5, width: 14 }, Format { per_line: 5, width: 15 }];

/// A first line such as `2 CORRECTED ACCELEROGRAM`, and asterisks or a station code below it.
pub(super) fn is_format(source: &Source) -> bool {
    let first = source.line(0).trim_end();
    let title = first.trim_start_matches(|c: char| c.is_ascii_digit()).trim();
    let titles = ["UNCORRECTED ACCELEROGRAM", "CORRECTED ACCELEROGRAM", "VELOCITY", "DISPLACEMENT"];
    first.starts_with(|c: char| c.is_ascii_digit()) && titles.contains(&title)
}

pub(super) fn read(source: &Source) -> Result<Record> {
    let quantity = quantity(source)?;
    let integers = block(source, TEXT_LINES, INTEGER_LINES, INTEGERS)?;
    let reals_start = TEXT_LINES + INTEGER_LINES;
    let reals = block(source, reals_start, REAL_LINES, REALS)?;
    let npts_line = TEXT_LINES + 2;
    let npts = known(source, &integers, 16, npts_line, NO_INTEGER, "number of samples (integer 17)")?;
    let rate = known(source, &reals, 1, reals_start, NO_REAL, "sampling rate (real 2)")?;
    let comments = integers.get(15).copied().filter(|n| (0.0..=1e4).contains(n)).unwrap_or(0.0) as usize;
    let data_line = reals_start + REAL_LINES + comments;
    let (values, end) = samples(source, data_line, npts as u64)?;
    refuse_rest(source, end, npts as u64, values.len())?;
    finish(
        source,
        Raw {
            quantity,
            dt: 1.0 / rate,
            values,
            units: if quantity == HistoryQuantity::Acceleration { "cm/s2" } else { "cm" }.to_owned(),
            station: station(source.line(5)),
            event: source.line(3).split_whitespace().collect::<Vec<_>>().join(" "),
            channel: after(source.line(5), "component=").to_owned(),
            dt_line: reals_start,
            units_line: 0,
            data_line,
            ..Raw::of(FileFormat::UsgsSmc)
        },
    )
}

fn quantity(source: &Source) -> Result<HistoryQuantity> {
    let title = source.line(0);
    if title.contains("ACCELEROGRAM") {
        Ok(HistoryQuantity::Acceleration)
    } else if title.contains("DISPLACEMENT") {
        Ok(HistoryQuantity::Displacement)
    } else {
        let error = source.error_at(0, format!("a history of `{}` is not read", title.trim()));
        Err(error.allowed("ACCELEROGRAM, DISPLACEMENT").help("take the accelerogram of the same record").into())
    }
}

/// A header value above 0 that is not the one that stands for "not known".
fn known(source: &Source, values: &[f64], index: usize, line: usize, none: f64, what: &'static str) -> Result<f64> {
    let found = values.get(index).copied().filter(|v| *v != none && *v > 0.0);
    found.ok_or_else(|| source.error_at(line, format!("the header does not give the {what}")).key(what).into())
}

/// A header block of fixed-width numbers.
fn block(source: &Source, start: usize, lines: usize, format: Format) -> Result<Vec<f64>> {
    let mut values = Vec::new();
    for line in start..start + lines {
        let fields = fixed_fields(source.line(line), format.width).unwrap_or_default();
        if fields.len() != format.per_line {
            let what =
                format!("a header line of {} fields of {} characters is expected here", format.per_line, format.width);
            return Err(source.error_at(line, what).into());
        }
        for field in fields {
            values.push(number(field).ok_or_else(|| not_a_number(source, line, field))?);
        }
    }
    Ok(values)
}

/// The samples, in the first layout whose width fits their first line.
fn samples(source: &Source, start: usize, declared: u64) -> Result<(Vec<f64>, usize)> {
    let first = source.line(start).trim_end();
    let fits = |format: &&Format| {
        let fields = fixed_fields(first, format.width).unwrap_or_default();
        first.len().is_multiple_of(format.width)
            && fields.len() <= format.per_line
            && fields.iter().all(|field| number(field).is_some())
    };
    let format = SAMPLES.iter().find(fits).unwrap_or(&SAMPLES[0]);
    fixed_block(source, start, declared, *format, "number of samples (integer 17)")
}

/// More samples than the header declares.
fn refuse_rest(source: &Source, end: usize, declared: u64, found: usize) -> Result<()> {
    let rest = source.lines.iter().skip(end).filter(|line| !line.trim().is_empty()).count();
    if rest == 0 {
        return Ok(());
    }
    let key = "number of samples (integer 17)";
    Err(source.count_error(TEXT_LINES + 2, key, declared, found + rest).into())
}

fn after<'a>(line: &'a str, key: &str) -> &'a str {
    line.find(key).map_or("", |at| line[at + key.len()..].trim())
}

fn station(line: &str) -> String {
    let name = after(line, "station =");
    let end = name.find("component").unwrap_or(name.len());
    name[..end].trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn title_tells_the_format() {
        let path = std::path::Path::new("x");
        assert!(is_format(&Source::new(path, "2 CORRECTED ACCELEROGRAM   \r\n*")));
        assert!(!is_format(&Source::new(path, "CORRECTED ACCELEROGRAM   36456\r\n*")));
    }
}
