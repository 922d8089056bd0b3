//! K-NET and KiK-net in ASCII (`.NS`, `.EW`, `.UD`, `.NS2`): 17 lines of a name and a value, the last of them `Memo.`, then whole numbers,
//! eight in a line, that the scale factor `3920(gal)/6182761` turns into acceleration.
//!
//! The numbers stand on an offset of the instrument; `Max. Acc. (gal)` of the header is the peak without their mean, which is therefore
//! taken off. How many there are follows from duration and sampling frequency.

use crate::Result;
use crate::ground::record::{Format, Raw, Record, finish};
use crate::ground::source::{CUT, Source, free_fields, leading_number, missing, not_a_number, number, unreadable};

/// Lines of the header.
const HEADER: usize = 17;
const NAMES: [&str; 6] =
    ["Origin Time", "Station Code", "Sampling Freq(Hz)", "Duration Time(s)", "Scale Factor", "Max. Acc. (gal)"];

/// Three of the names, so that a file whose header is damaged still counts as one.
pub(super) fn is_format(source: &Source) -> bool {
    NAMES.iter().filter(|name| find(source, name).is_some()).count() >= 3
}

pub(super) fn read(source: &Source) -> Result<Record> {
    let (dt_line, frequency) = required(source, "Sampling Freq(Hz)")?;
    let rate = leading_number(frequency).filter(|rate| *rate > 0.0);
    let rate = rate.ok_or_else(|| unreadable(source, dt_line, "Sampling Freq(Hz)", "a frequency such as 100Hz"))?;
    let (count_line, duration) = required(source, "Duration Time(s)")?;
    let duration = number(duration).filter(|seconds| *seconds > 0.0);
    let duration = duration.ok_or_else(|| unreadable(source, count_line, "Duration Time(s)", "seconds above 0"))?;
    let (units_line, scale) = required(source, "Scale Factor")?;
    let scale = factor(scale);
    let scale =
        scale.ok_or_else(|| unreadable(source, units_line, "Scale Factor", "a factor such as 3920(gal)/6182761"))?;
    let data_line = find(source, "Memo.").map_or(HEADER, |(line, _)| line + 1);
    let mut values = samples(source, data_line)?;
    let declared = (rate * duration).round() as u64;
    if values.len() as u64 != declared {
        return Err(source.count_error(count_line, "Duration Time(s)", declared, values.len()).into());
    }
    values.iter_mut().for_each(|value| *value *= scale);
    let text = |name| find(source, name).map_or("", |(_, value)| value);
    finish(
        source,
        Raw {
            dt: 1.0 / rate,
            values,
            units: "gal".into(),
            station: text("Station Code").into(),
            event: text("Origin Time").into(),
            channel: direction(text("Dir.")),
            dt_line,
            units_line,
            data_line,
            offset: true,
            ..Raw::of(Format::Knet)
        },
    )
}

/// Line and value of a name.
fn find<'a>(source: &Source<'a>, name: &str) -> Option<(usize, &'a str)> {
    source.head(HEADER).find_map(|(index, line)| Some((index, line.strip_prefix(name)?.trim())))
}

fn required<'a>(source: &Source<'a>, name: &'static str) -> Result<(usize, &'a str)> {
    find(source, name).ok_or_else(|| missing(source, HEADER, name).into())
}

/// `3920(gal)/6182761` [gal].
fn factor(text: &str) -> Option<f64> {
    let (numerator, denominator) = text.split_once("(gal)/")?;
    let factor = number(numerator)? / number(denominator)?;
    (factor.is_finite() && factor != 0.0).then_some(factor)
}

fn samples(source: &Source, start: usize) -> Result<Vec<f64>> {
    let mut values = Vec::new();
    let mut ends: Vec<usize> = Vec::new();
    for (index, line) in source.lines.iter().copied().enumerate().skip(start) {
        let mut end = 0;
        for (column, field) in free_fields(line).enumerate() {
            values.push(number(field).ok_or_else(|| not_a_number(source, index, field))?);
            // Fields stand flush right below each other: one that ends early has lost digits.
            end = line.len() - line[end..].trim_start().len() + field.len();
            match ends.get(column) {
                Some(due) if *due != end => {
                    let error = source
                        .error_at(index, format!("the number `{field}` ends in column {end}, those above it in {due}"));
                    return Err(error.help(CUT).into());
                }
                Some(_) => {}
                None => ends.push(end),
            }
        }
        source.room(index, values.len())?;
    }
    Ok(values)
}

/// The direction as the names of the files say it: KiK-net's header numbers them.
pub(super) fn direction(text: &str) -> String {
    let name = match text {
        "1" => "NS1 (borehole)",
        "2" => "EW1 (borehole)",
        "3" => "UD1 (borehole)",
        "4" => "NS2 (surface)",
        "5" => "EW2 (surface)",
        "6" => "UD2 (surface)",
        other => other,
    };
    name.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_factors() {
        assert_eq!(factor("2000(gal)/8388608"), Some(2000.0 / 8_388_608.0));
        for bad in ["", "2000/8388608", "(gal)/1", "1(gal)/0", "0(gal)/5", "1(gal)/x"] {
            assert_eq!(factor(bad), None, "{bad}");
        }
    }
}
