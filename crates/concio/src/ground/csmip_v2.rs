//! CSMIP volume 2: per channel 25 text lines, 100 integers (16I5), 100 reals (8F10.3), then acceleration, velocity
//! and displacement, each announced by a line such as
//! ` 3251 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)`.
//! Fields are ten characters wide and need not be separated. Velocity and displacement are passed over: the engine
//! integrates the acceleration itself, so that the three agree.

use crate::Result;
use crate::case::HistoryQuantity;
use crate::ground::record::{Format as FileFormat, Raw, Record, finish};
use crate::ground::source::{Format, Source, count, fixed_block, leading_number};

const SAMPLES: Format = Format { per_line: 8, width: 10 };
/// Lines in which the first announcement is looked for: 25 + 7 + 13 and some to spare.
const HEADER: usize = 80;

pub(super) fn is_format(source: &Source) -> bool {
    source.head(HEADER).any(|(_, line)| is_announcement(line))
}

pub(super) fn read(source: &Source) -> Result<Vec<Record>> {
    let announcements = source.lines.iter().enumerate().filter(|(_, line)| is_announcement(line));
    announcements.map(|(index, line)| channel(source, index, line)).collect()
}

fn is_announcement(line: &str) -> bool {
    line.to_ascii_uppercase().contains("POINTS OF ACCEL DATA")
}

fn channel(source: &Source, index: usize, line: &str) -> Result<Record> {
    let upper = line.to_ascii_uppercase();
    let bad = |key: &'static str, allowed: &'static str| {
        source.error_at(index, "the announcement of the samples is incomplete").key(key).allowed(allowed)
    };
    let declared = upper.split_whitespace().next().and_then(count);
    let declared = declared.ok_or_else(|| bad("POINTS", "a whole number from 2"))?;
    let dt = after(&upper, "SPACED AT").and_then(leading_number);
    let dt = dt.ok_or_else(|| bad("SPACED AT", "a time in seconds"))?;
    let units = after(&upper, "UNITS:").unwrap_or("").split(')').next().unwrap_or("").trim().to_owned();
    let (values, end) = fixed_block(source, index + 1, declared, SAMPLES, "POINTS OF ACCEL DATA")?;
    let next = source.line(end);
    if !next.trim().is_empty() && !next.bytes().any(|b| b.is_ascii_alphabetic()) {
        return Err(source
            .error_at(end, format!("more samples than the {declared} that the header declares"))
            .key("POINTS OF ACCEL DATA")
            .into());
    }
    let start = title(source, index);
    finish(
        source,
        Raw {
            format: FileFormat::CsmipV2,
            quantity: HistoryQuantity::Acceleration,
            dt,
            values,
            units,
            station: words(source.line(start + 6)),
            event: words(source.line(start + 8)),
            channel: words(source.line(start + 7)),
            dt_line: index,
            units_line: index,
            data_line: index + 1,
        },
    )
}

/// The first line of the channel's header: the last `CORRECTED ACCELEROGRAM` before its samples.
fn title(source: &Source, announcement: usize) -> usize {
    let is_title = |line: &str| line.trim_start().to_ascii_uppercase().starts_with("CORRECTED ACCEL");
    let range = announcement.saturating_sub(HEADER)..announcement;
    range.rev().find(|index| is_title(source.line(*index))).unwrap_or(announcement.saturating_sub(45))
}

fn after<'a>(line: &'a str, key: &str) -> Option<&'a str> {
    line.find(key).map(|at| &line[at + key.len()..])
}

fn words(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}
