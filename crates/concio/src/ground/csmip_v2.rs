//! CSMIP volume 2: per channel 25 text lines, 100 integers (16I5), 100 reals (8F10.3), then acceleration, velocity and displacement, each
//! announced by a line such as
//!
//! - ` 3251 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)` (1980s and 1990s),
//! - `  7500 points of accel data equally spaced at  .010 sec, in cm/sec2. (8f10.6)` (since 2012),
//! - `  1887 POINTS OF ACC DATA EQUALLY SPACED AT   .020 SEC.  IN UNITS CM/SEC/SEC` (Caltech and USC).
//!
//! Fields are ten characters wide and need not be separated. Velocity and displacement are passed over: the engine
//! integrates the acceleration itself, so that the three agree. Where the header says that they follow, they must be there.

use crate::Result;
use crate::ground::record::{Format as FileFormat, Raw, Record, finish, tell_fewer, tell_unmarked};
use crate::ground::source::{
    CUT, Format, Source, after, channels_of_recorder, count, fixed_block, fixed_fields, fortran_format, is_marked,
    leading_number, refuse_more, require_end_mark, unreadable, words,
};

const SAMPLES: Format = Format { per_line: 8, width: 10 };
/// Lines in which the announcement of a channel is looked for: 25 + 7 + 13 and some to spare.
const HEADER: usize = 80;
const TEXT_LINES: usize = 25;
/// The blocks, and the places of the counts of velocity and displacement among the integers, from 0.
const BLOCKS: [(&str, usize); 2] = [("VEL", 63), ("DIS", 65)];

/// An announcement, or the titles of both volumes where that is damaged.
pub(super) fn is_format(source: &Source) -> bool {
    let title = |line: usize, mark: &str| source.line(line).trim_start().to_ascii_uppercase().starts_with(mark);
    let titles = title(0, "CORRECTED ACCELEROGRAM") && (title(1, "UNCORRECTED ACCELEROGRAM") || title(1, "FILE"));
    let uncorrected = source.line(0).to_ascii_uppercase().contains("UNCORRECTED");
    titles || (!uncorrected && source.head(HEADER).any(|(_, line)| is_announcement(line, "ACC")))
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
    tell_unmarked(&mut records, marked);
    Ok(records)
}

fn is_announcement(line: &str, block: &str) -> bool {
    let upper = line.to_ascii_uppercase();
    let of = upper.find("POINTS OF ").map(|at| &upper[at + "POINTS OF ".len()..]);
    of.is_some_and(|rest| rest.starts_with(block) && rest.contains(" DATA EQUALLY SPACED"))
}

/// The channel whose header begins at line `start`, and the line behind it.
fn channel(source: &Source, start: usize, place: usize) -> Result<(Record, usize)> {
    let end_of_header = source.lines.len().min(start + HEADER);
    let index = (start..end_of_header).find(|line| is_announcement(source.line(*line), "ACC"));
    let index = index.ok_or_else(|| {
        let what = format!("the header of channel {place} is not followed by `POINTS OF ACCEL DATA`");
        source.error_at(end_of_header - 1, what).key("POINTS OF ACCEL DATA").help(CUT)
    })?;
    let line = source.line(index);
    let dt = after(line, "spaced at").and_then(leading_number);
    let dt = dt.ok_or_else(|| unreadable(source, index, "SPACED AT", "a time in seconds"))?;
    let (values, mut end) = block(source, index)?;
    for (name, place) in BLOCKS {
        if is_announcement(source.line(end), name) {
            (_, end) = block(source, end)?;
        } else if is_promised(source, start, index, place) {
            let what =
                format!("the header promises velocity and displacement, and no `POINTS OF {name}… DATA` follows");
            return Err(source.error_at(end.min(source.lines.len() - 1), what).help(CUT).into());
        }
    }
    let record = finish(
        source,
        Raw {
            dt,
            values,
            units: units(line),
            station: words(source.line(start + 6)),
            event: words(source.line(start + 8)),
            channel: words(source.line(start + 7)),
            dt_line: index,
            units_line: index,
            data_line: index + 1,
            ..Raw::of(FileFormat::CsmipV2)
        },
    )?;
    Ok((record, end))
}

/// The numbers that line `index` announces, and the line behind them.
fn block(source: &Source, index: usize) -> Result<(Vec<f64>, usize)> {
    const KEY: &str = "POINTS OF … DATA";
    let line = source.line(index);
    let declared = line.split_whitespace().next().and_then(count);
    let declared = declared.ok_or_else(|| unreadable(source, index, KEY, "a whole number from 2"))?;
    let format = line.rsplit_once('(').and_then(|(_, format)| fortran_format(format)).unwrap_or(SAMPLES);
    let (values, end) = fixed_block(source, index + 1, declared, format, KEY)?;
    refuse_more(source, end, declared, KEY)?;
    Ok((values, end))
}

/// Whether the header says that velocity and displacement follow: by their counts, or in words.
fn is_promised(source: &Source, start: usize, announcement: usize, place: usize) -> bool {
    let integers =
        (start + TEXT_LINES..announcement).flat_map(|line| fixed_fields(source.line(line), 5).unwrap_or_default());
    let counted = integers.take(100).nth(place).and_then(count).is_some_and(|count| count > 1);
    let said = (start..announcement.min(start + TEXT_LINES)).any(|line| {
        let upper = source.line(line).to_ascii_uppercase();
        upper.contains("VELOC") && upper.contains("DISPL") && upper.contains("DATA")
    });
    counted || said
}

/// The unit that an announcement names: in brackets, behind `IN UNITS`, or behind `, in`.
fn units(line: &str) -> String {
    let in_brackets = after(line, "units:").and_then(|rest| rest.split(')').next());
    let in_words =
        || after(line, "in units").or_else(|| after(line, ", in ")).and_then(|rest| rest.split(['(']).next());
    let unit = in_brackets.or_else(in_words).unwrap_or("");
    unit.trim().trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_all_times() {
        for (line, unit) in [
            (" 3251 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)", "CM/SEC/SEC"),
            ("  7500 points of accel data equally spaced at  .010 sec, in cm/sec2. (8f10.6)    ", "cm/sec2"),
            (" 12000 points of accel data equally spaced at  .005 sec, in cm/sec2.", "cm/sec2"),
            ("  1887 POINTS OF ACC DATA EQUALLY SPACED AT   .020 SEC.  IN UNITS CM/SEC/SEC", "CM/SEC/SEC"),
        ] {
            assert_eq!(units(line), unit, "{line}");
            assert!(is_announcement(line, "ACC") && !is_announcement(line, "VEL"));
        }
        assert!(!is_announcement(
            "  7500 points of instrument- and baseline-corrected accel, veloc and displ data ",
            "ACC"
        ));
    }
}
