//! Uncorrected volume 1 of Caltech and those who took it over (USC, CSMIP, RENADIC of Chile, BHRC of Iran): for each channel 13 lines of text,
//! 100 integers (7 lines), 50 reals (7 lines), then one of three:
//!
//! - pairs of time and acceleration in fields of a fixed width, five pairs in a line, at equal steps or, from film, at others;
//! - accelerations announced by `13200 Accelerogram points at 200 pts/sec in units of g .  Format: (8f9.6)` (CSMIP since 2012) or by
//!   `12001 POINTS OF ACCEL DATA EQUALLY SPACED AT .005 SEC.  (UNITS: G)` (before that, of digital instruments);
//! - accelerations in `10E13.6` (BHRC, `* VOL1DS`), whose interval is the length over the number.
//!
//! Acceleration is in g/10 or in g, as the header says. Samples at unequal steps are taken over to equal ones on which all of them lie, where the
//! printed times allow it.
//! M. D. Trifunac & V. W. Lee, Routine computer processing of strong-motion accelerograms, EERL 73-03 (1973).

use crate::Result;
use crate::ground::record::{Format as FileFormat, Raw, Record, Remark, finish, tell_fewer, tell_unmarked};
use crate::ground::source::MOST_SAMPLES;
use crate::ground::source::{
    CUT, Format, Source, after, channels_of_recorder, fixed_block, fortran_format, free_fields, is_marked,
    leading_number, not_a_number, number, refuse_more, require_end_mark, unreadable, whole, words,
};

/// Lines of text, of integers and of reals.
const TEXT_LINES: usize = 13;
const NUMBER_LINES: usize = 14;
const BHRC: Format = Format { per_line: 10, width: 13 };
const COUNT: &str = "NO. OF POINTS";
/// Most samples that equal steps make of one at unequal ones.
const MOST_PER_SAMPLE: u64 = 20;

/// Two of the marks in the text of the first channel. Volume 3, the spectra, has them too.
pub(super) fn is_format(source: &Source) -> bool {
    let text: Vec<String> = source.head(TEXT_LINES).map(|(_, line)| line.to_ascii_uppercase()).collect();
    let title = text.first().map_or("", String::as_str);
    let has = |mark: &str| text.iter().any(|line| line.contains(mark));
    let marks = [
        title.contains("UNCORRECTED ACCELEROGRAM DATA") || title.starts_with("* VOL1"),
        has(COUNT),
        has("UNITS") && (has("SEC AND G") || has("SECONDS AND G") || has("ACCEL IS G")),
    ];
    !title.contains("SPECTRA") && marks.into_iter().filter(|mark| *mark).count() >= 2
}

pub(super) fn read(source: &Source) -> Result<Vec<Record>> {
    let (mut records, mut line, marked) = (Vec::new(), 0, is_marked(source));
    while let Some(start) = source.next_channel(line) {
        let (record, end) = channel(source, start, records.len() + 1)?;
        if marked {
            require_end_mark(source, end)?;
        }
        records.push(record);
        line = end;
    }
    tell_fewer(&mut records, channels_of_recorder(source, TEXT_LINES));
    // USC keeps one channel in a file, without a mark behind it.
    let alone = source.line(0).trim_start().to_ascii_uppercase().starts_with("FILE");
    tell_unmarked(&mut records, marked || alone);
    Ok(records)
}

/// Samples as one of the three layouts gives them.
struct Samples {
    dt: f64,
    values: Vec<f64>,
    dt_line: usize,
    /// Line behind them.
    end: usize,
    remarks: Vec<Remark>,
}

/// The channel whose header begins at line `start`, and the line behind it.
fn channel(source: &Source, start: usize, place: usize) -> Result<(Record, usize)> {
    let data_line = start + TEXT_LINES + NUMBER_LINES;
    if source.lines.len() <= data_line {
        let error = source.error_at(source.lines.len() - 1, format!("the header of channel {place} is not whole"));
        return Err(error.help(CUT).into());
    }
    let text =
        |mark: &str| (start..start + TEXT_LINES).find(|line| source.line(*line).to_ascii_uppercase().contains(mark));
    let lacks = |mark: &str| {
        source
            .error_at(start + TEXT_LINES - 1, format!("the header of channel {place} has no `{mark}`"))
            .key(mark.to_owned())
    };
    let count_line = text(COUNT).ok_or_else(|| lacks(COUNT))?;
    let declared = value(source, count_line, "no. of points").and_then(whole).filter(|count| *count >= 2);
    let declared = declared.ok_or_else(|| unreadable(source, count_line, COUNT, "a whole number from 2"))?;
    let units_line = text("UNITS").ok_or_else(|| lacks("UNITS"))?;
    let units = unit(source.line(units_line));
    let units = units.ok_or_else(|| unreadable(source, units_line, "UNITS", "SEC AND G/10, SEC AND G"))?;
    let announced = ["points at", "points of accel"].iter().any(|key| after(source.line(data_line), key).is_some());
    let samples = if announced {
        announced_samples(source, data_line)?
    } else if source.line(start).to_ascii_uppercase().starts_with("* VOL1") {
        spaced(source, count_line, data_line, declared)?
    } else {
        pairs(source, count_line, data_line, declared)?
    };
    refuse_more(source, samples.end, declared, COUNT)?;
    let names = Names::of(source, start);
    let record = finish(
        source,
        Raw {
            dt: samples.dt,
            values: samples.values,
            units,
            station: names.station,
            event: names.event,
            channel: names.channel,
            dt_line: samples.dt_line,
            units_line,
            data_line,
            remarks: samples.remarks,
            ..Raw::of(FileFormat::Volume1)
        },
    )?;
    Ok((record, samples.end))
}

/// The number behind `key =`.
fn value(source: &Source, line: usize, key: &str) -> Option<f64> {
    after(source.line(line), key).and_then(|rest| leading_number(rest.trim_start().strip_prefix('=')?))
}

/// `g/10` or `g`: what stands behind `SEC AND`, or behind `ACCEL IS` where there is no time.
fn unit(line: &str) -> Option<String> {
    let rest = ["sec and", "seconds and", "accel is"].iter().find_map(|key| after(line, key))?;
    let unit = rest.trim_start().split([' ', '.', ',']).next().unwrap_or("").to_ascii_lowercase();
    ["g/10", "g"].contains(&unit.as_str()).then_some(unit)
}

struct Names {
    station: String,
    event: String,
    channel: String,
}

impl Names {
    fn of(source: &Source, start: usize) -> Self {
        let line = |k: usize| source.line(start + k);
        if line(0).to_ascii_uppercase().starts_with("* VOL1") {
            // `L`, `T` or `V` alone in a line; the azimuths of the first two stand behind the station.
            let letter = line(4).trim();
            let (station, about) = line(7).split_once(" Station").unwrap_or((line(7), ""));
            let azimuth =
                after(about, "azimuth").and_then(|rest| after(rest, &format!("{} ", letter.to_ascii_lowercase())));
            let azimuth =
                azimuth.and_then(|rest| rest.split_whitespace().next()).map(|degrees| format!(" {degrees} deg"));
            let channel = format!("{letter}{}", azimuth.unwrap_or_default());
            return Names {
                station: words(station),
                event: words(line(2).trim_start_matches("Origin Time :")),
                channel,
            };
        }
        let channel = (0..TEXT_LINES).map(line).find_map(|text| {
            let upper = text.trim_start().to_ascii_uppercase();
            (upper.starts_with("CHAN") || upper.starts_with("COMP")).then(|| words(text))
        });
        // Archives count the characters of a line at its end.
        let plain = |text: &str| words(text.get(..70).unwrap_or(text));
        let channel = channel.unwrap_or_default();
        let channel = channel
            .strip_prefix("COMP")
            .map_or(channel.clone(), |rest| rest.split_whitespace().next().unwrap_or("").into());
        Names { station: plain(line(5)), event: plain(line(1)), channel }
    }
}

/// ` 13200 Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)`,
/// `12001 POINTS OF ACCEL DATA EQUALLY SPACED AT .005 SEC.  (UNITS: G)`, whose layout the first line of samples shows.
fn announced_samples(source: &Source, line: usize) -> Result<Samples> {
    const KEY: &str = "points";
    let text = source.line(line);
    let bad = |key: &'static str, allowed: &'static str| unreadable(source, line, key, allowed);
    let declared = leading_number(text).and_then(whole).ok_or_else(|| bad(KEY, "a whole number from 2"))?;
    let rate = after(text, "points at").and_then(leading_number).filter(|rate| *rate > 0.0);
    let dt = rate.map(|rate| 1.0 / rate).or_else(|| after(text, "spaced at").and_then(leading_number));
    let dt = dt.ok_or_else(|| bad(KEY, "`points at 200 pts/sec`, `EQUALLY SPACED AT .005 SEC`"))?;
    let named = after(text, "format:").map(fortran_format);
    let format = named.unwrap_or_else(|| {
        let ends = field_ends(source.line(line + 1));
        ends.first().map(|width| Format { per_line: ends.len(), width: *width })
    });
    let format = format.ok_or_else(|| bad("Format", "a Fortran format such as (8F9.6)"))?;
    let (values, end) = fixed_block(source, line + 1, declared, format, KEY)?;
    Ok(Samples { dt, values, dt_line: line, end, remarks: Vec::new() })
}

/// Ten values in a line; the interval is the length over the number.
fn spaced(source: &Source, count_line: usize, data_line: usize, declared: u64) -> Result<Samples> {
    let duration = value(source, count_line, "duration").filter(|seconds| *seconds > 0.0);
    let duration = duration.ok_or_else(|| unreadable(source, count_line, "DURATION", "seconds above 0"))?;
    let (values, end) = fixed_block(source, data_line, declared, BHRC, COUNT)?;
    Ok(Samples { dt: duration / declared.max(1) as f64, values, dt_line: count_line, end, remarks: Vec::new() })
}

/// Pairs of time and acceleration. Where the fields of a line end is read off the first line, whose times are short: later ones touch
/// the acceleration before them (`0.002100.005`).
fn pairs(source: &Source, count_line: usize, data_line: usize, declared: u64) -> Result<Samples> {
    let ends = field_ends(source.line(data_line));
    let (mut times, mut values, mut lines) = (Vec::new(), Vec::new(), Vec::new());
    let mut rounding: f64 = 0.0;
    let mut line = data_line;
    while (values.len() as u64) < declared {
        let text = source.line(line);
        if text.trim().is_empty() || text.trim_start().starts_with('/') {
            return Err(source.count_error(count_line, COUNT, declared, values.len()).into());
        }
        let fields = cut(text, &ends).filter(|fields| fields.len().is_multiple_of(2));
        let fields = fields.ok_or_else(|| source.error_at(line, "no pairs of time and acceleration").help(CUT))?;
        for pair in fields.chunks_exact(2) {
            let parsed = |field: &str| number(field).ok_or_else(|| not_a_number(source, line, field));
            times.push(parsed(pair[0])?);
            values.push(parsed(pair[1])?);
            lines.push(line);
            rounding = rounding.max(resolution(pair[0]));
        }
        source.room(line, values.len())?;
        line += 1;
    }
    if values.len() as u64 > declared {
        return Err(source.count_error(count_line, COUNT, declared, values.len()).into());
    }
    if let Some(k) = times.windows(2).position(|pair| !(pair[1] > pair[0])) {
        let what = format!("the time does not grow: {} s after {} s", times[k + 1], times[k]);
        return Err(source.error_at(lines[k + 1], what).into());
    }
    let mut samples = Samples { dt: 0.0, values, dt_line: data_line, end: line, remarks: Vec::new() };
    let start = times.first().copied().unwrap_or(0.0);
    if start.abs() > rounding {
        samples.remarks.push(Remark::Start { time: start });
    }
    let even = (times[times.len() - 1] - start) / (times.len().max(2) - 1) as f64;
    let off = times.iter().enumerate().map(|(k, t)| (t - start - k as f64 * even).abs()).fold(0.0, f64::max);
    if off <= 1.001 * rounding {
        samples.dt = even;
    } else {
        equal_steps(source, &mut samples, &times, rounding)?;
    }
    Ok(samples)
}

/// Columns in which the numbers of a line end.
fn field_ends(line: &str) -> Vec<usize> {
    let mut end = 0;
    let placed = free_fields(line).map(|field| {
        end = line.len() - line[end..].trim_start().len() + field.len();
        end
    });
    placed.collect()
}

/// The fields of a line that end in those columns: as many as it has. None where it ends inside of one, goes on behind the last or a
/// boundary falls into a character.
fn cut<'a>(line: &'a str, ends: &[usize]) -> Option<Vec<&'a str>> {
    let line = line.trim_end();
    let used = ends.iter().position(|end| *end >= line.len())?;
    if ends[used] != line.len() {
        return None;
    }
    let starts = std::iter::once(0).chain(ends.iter().copied());
    starts.zip(&ends[..=used]).map(|(start, end)| line.get(start..*end)).collect()
}

/// A unit of the last digit of a time as it is printed.
fn resolution(field: &str) -> f64 {
    field.trim().split_once('.').map_or(1.0, |(_, decimals)| 10f64.powi(-(decimals.len().min(12) as i32)))
}

/// Takes samples at unequal steps over to equal ones: those that the printed times are whole multiples of, where that does not make more than
/// [`MOST_PER_SAMPLE`] of one; else the shortest multiple that does not.
fn equal_steps(source: &Source, samples: &mut Samples, times: &[f64], rounding: f64) -> Result<()> {
    let ticks: Vec<u64> = times.iter().map(|t| ((t - times[0]) / rounding).round() as u64).collect();
    let mut steps: Vec<u64> = ticks.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let shared = steps.iter().copied().fold(0, greatest_common_divisor).max(1);
    let total = ticks.last().copied().unwrap_or(0);
    let most = (MOST_PER_SAMPLE * ticks.len() as u64).min(MOST_SAMPLES as u64);
    let times_shared = (total / shared).div_ceil(most).max(1);
    let step = shared * times_shared;
    let (mut k, mut made) = (0, Vec::with_capacity((total / step) as usize + 1));
    for at in (0..=total).step_by(step as usize) {
        while k + 2 < ticks.len() && ticks[k + 1] <= at {
            k += 1;
        }
        // Times printed finer than the coarsest of them may share a tick.
        let part = (at - ticks[k]) as f64 / (ticks[k + 1] - ticks[k]).max(1) as f64;
        made.push(samples.values[k] + part * (samples.values[k + 1] - samples.values[k]));
    }
    source.room(samples.dt_line, made.len())?;
    // Tenths of a second are not sums of thousandths: through the decimal number of ticks in a second.
    let seconds = |ticks: u64| ticks as f64 / (1.0 / rounding).round();
    steps.sort_unstable();
    samples.remarks.push(Remark::Resampled {
        samples: times.len(),
        steps: [seconds(steps[0]), seconds(steps[steps.len() - 1])],
        dt: seconds(step),
        exact: times_shared == 1,
    });
    (samples.dt, samples.values) = (seconds(step), made);
    Ok(())
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    let (mut a, mut b) = (a, b);
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_cut_where_those_of_the_first_line_end() {
        let ends = field_ends("  0.000 -0.000  0.005  0.000");
        assert_eq!(ends, [7, 14, 21, 28]);
        assert_eq!(
            cut("100.000  0.002100.005  0.004  ", &ends),
            Some(vec!["100.000", "  0.002", "100.005", "  0.004"])
        );
        assert_eq!(cut("100.000  0.002", &ends), Some(vec!["100.000", "  0.002"]));
        assert_eq!(cut("100.000  0.00", &ends), None);
        assert_eq!(cut("100.000  0.002100.005  0.004 1", &ends), None);
    }

    #[test]
    fn units_of_the_archives() {
        for (line, found) in [
            ("UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = -0.125 G, AT   6.365 SEC", Some("g/10")),
            ("UNITS ARE SECONDS AND G/10", Some("g/10")),
            ("Units of uncor data are sec and g .        Max  =   .079 g , at  30.590 sec.", Some("g")),
            ("UNITS OF UNCOR ACCEL IS G.                 MAX  =   .058 G, AT   9.425 SEC.", Some("g")),
            ("UNITS ARE SEC AND CM", None),
        ] {
            assert_eq!(unit(line).as_deref(), found, "{line}");
        }
    }
}
