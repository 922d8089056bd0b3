//! A record file as lines, and the number fields in them: free, glued together, or of fixed width.

use std::path::Path;

use crate::{InputError, Result};

/// Most samples that a file may hold, all its components together: as many as a run keeps of one channel, and fourteen hours of two
/// components at 100 Hz. It bounds lines as well.
pub const MOST_SAMPLES: usize = 10_000_000;

/// The end of a file under DOS and CP/M, which fill the rest of it with the same, or with anything.
const END_OF_FILE: char = '\u{1a}';
/// What marks of an end of COSMOS end with.
const QUANTITIES: [&str; 3] = ["acceleration", "velocity", "displacement"];
/// Longest part of a header line that is looked at [bytes]: what follows is no header, and a file may be one line.
const LONGEST_HEADER_LINE: usize = 1 << 14;

/// A file in memory. Lines are counted from 0 here and from 1 in messages.
pub(super) struct Source<'a> {
    pub path: &'a Path,
    pub lines: Vec<&'a str>,
    /// Line in which text goes on behind the end-of-file mark; where there is one, what stands before it is the file.
    pub behind_mark: Option<usize>,
}

impl<'a> Source<'a> {
    /// Cuts the text at line feeds; carriage returns before them (one, or two as in some archives) are dropped.
    /// A file without any line feed is cut at carriage returns.
    pub fn new(path: &'a Path, text: &'a str) -> Self {
        let (text, rest) = text.split_once(END_OF_FILE).unwrap_or((text, ""));
        let end = line_end(text);
        let lines: Vec<&str> = text.split(end).map(|line| line.trim_end_matches('\r')).collect();
        let is_padding = |c: char| c == END_OF_FILE || c == '\0' || c.is_whitespace();
        let behind_mark = (!rest.chars().all(is_padding)).then(|| lines.len() - 1);
        Source { path, lines, behind_mark }
    }

    /// A line, empty beyond the end of the file.
    pub fn line(&self, index: usize) -> &'a str {
        self.lines.get(index).copied().unwrap_or("")
    }

    /// The first lines, none longer than a header line.
    pub fn head(&self, count: usize) -> impl Iterator<Item = (usize, &'a str)> {
        self.lines.iter().copied().map(header_part).enumerate().take(count)
    }

    /// The first line from `line` on that is neither blank nor the mark of an end of channel: where the next channel begins.
    pub fn next_channel(&self, line: usize) -> Option<usize> {
        let starts = |text: &&str| {
            let text = header_part(text.trim_start());
            !text.is_empty() && !is_end_mark(text)
        };
        self.lines.iter().skip(line).position(starts).map(|k| line + k)
    }

    /// An error in this file.
    pub fn error(&self, what: impl Into<String>) -> InputError {
        InputError::new(what).in_file(self.path)
    }

    /// An error in a line of this file.
    pub fn error_at(&self, index: usize, what: impl Into<String>) -> InputError {
        self.error(what).at_line(index + 1)
    }

    /// The error of a header that declares another number of samples than follow it.
    pub fn count_error(&self, index: usize, key: &str, declared: u64, found: usize) -> InputError {
        let error = self
            .error_at(index, format!("the header declares {declared} samples, the file holds {found}"))
            .key(key)
            .allowed("equal counts");
        if declared > found as u64 {
            error.help(CUT)
        } else {
            error.help("the file was changed after it was written: fetch it again")
        }
    }

    /// The error of a file with more samples than are read, if `found` are; `line` is the last one.
    pub fn room(&self, line: usize, found: usize) -> Result<()> {
        if found <= MOST_SAMPLES {
            return Ok(());
        }
        let error = self.error_at(line, format!("the file holds more than {MOST_SAMPLES} samples"));
        Err(error.allowed(format!("up to {MOST_SAMPLES} samples, as many as a run keeps")).into())
    }
}

/// Said of a file whose end is missing.
pub(super) const CUT: &str = "the file was cut off: fetch it again";

/// What parts the lines of a text.
pub(super) fn line_end(text: &str) -> char {
    if text.contains('\n') { '\n' } else { '\r' }
}

/// The beginning of a line, as long as headers are.
fn header_part(line: &str) -> &str {
    let mut end = line.len().min(LONGEST_HEADER_LINE);
    while !line.is_char_boundary(end) {
        end -= 1;
    }
    &line[..end]
}

/// Words with one blank between them.
pub(super) fn words(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What follows `key`, in upper or lower case; the key is given in lower case.
pub(super) fn after<'a>(line: &'a str, key: &str) -> Option<&'a str> {
    line.to_ascii_lowercase().find(key).map(|at| &line[at + key.len()..])
}

/// A finite number, in the notation of C or Fortran (`1.5`, `.5E-02`, `-1.D+3`).
pub(super) fn number(field: &str) -> Option<f64> {
    let field = field.trim();
    let plain = |b: &u8| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b'e' | b'E');
    let value: f64 = if field.as_bytes().iter().all(plain) {
        field.parse().ok()?
    } else {
        field.replace(['d', 'D'], "E").parse().ok()?
    };
    value.is_finite().then_some(value)
}

/// A count of samples: a whole number from 0. Values that no memory holds are kept, for the message.
pub(super) fn count(field: &str) -> Option<u64> {
    number(field).and_then(whole)
}

/// A number as a count of samples.
pub(super) fn whole(value: f64) -> Option<u64> {
    (value >= 0.0 && value.fract() == 0.0).then_some(value as u64)
}

/// The number that `text` starts with, after blanks.
pub(super) fn leading_number(text: &str) -> Option<f64> {
    let text = text.trim_start();
    let part = |c: char| c.is_ascii_digit() || "+-.eEdD".contains(c);
    let end = text.find(|c| !part(c)).unwrap_or(text.len());
    // A unit may follow without a blank ("0.005sec" ends in a part that looks like an exponent).
    let field = text[..end].trim_end_matches(|c: char| !c.is_ascii_digit() && c != '.');
    number(field)
}

/// Fields between blanks; a sign that is not that of an exponent starts a new field, since a full Fortran field
/// leaves no blank before it.
pub(super) fn free_fields(line: &str) -> impl Iterator<Item = &str> {
    line.split_whitespace().flat_map(|token| {
        let bytes = token.as_bytes();
        let cut = move |i: &usize| {
            matches!(bytes[*i], b'+' | b'-') && !matches!(bytes[*i - 1], b'e' | b'E' | b'd' | b'D' | b'+' | b'-')
        };
        let mut start = 0;
        let ends: Vec<usize> = (1..bytes.len()).filter(cut).chain([bytes.len()]).collect();
        ends.into_iter().map(move |end| {
            let field = &token[start..end];
            start = end;
            field
        })
    })
}

/// Fields of a fixed width; the last may be shorter. None when a boundary falls into a character of several bytes.
pub(super) fn fixed_fields(line: &str, width: usize) -> Option<Vec<&str>> {
    let line = line.trim_end();
    let starts = (0..line.len()).step_by(width.max(1));
    starts.map(|start| line.get(start..(start + width.max(1)).min(line.len()))).collect()
}

/// A Fortran format of numbers: `(10I8)`, `(5F15.6)`, `(1E15.6)`, `(8(1PE10.4E1))`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Format {
    pub per_line: usize,
    pub width: usize,
}

/// Reads the first group of a Fortran format.
pub(super) fn fortran_format(text: &str) -> Option<Format> {
    let text = text.trim().trim_start_matches('(').trim_start().to_ascii_uppercase();
    let letter = text.find(['I', 'F', 'E', 'G', 'D'])?;
    let (head, tail) = text.split_at(letter);
    // "8(1P" and "1P8" both mean eight fields; the scale factor P says nothing about the layout.
    let per_line = head
        .split(['(', ','])
        .map(|part| part.rsplit('P').next().unwrap_or(part).trim())
        .find(|part| !part.is_empty())
        .map_or(Some(1), |part| part.parse().ok())?;
    let digits: String = tail.chars().skip(1).take_while(char::is_ascii_digit).collect();
    let width = digits.parse().ok()?;
    ((1..=1000).contains(&per_line) && (1..=200).contains(&width)).then_some(Format { per_line, width })
}

/// `declared` numbers in lines of fixed-width fields from line `start`; the line after them comes back too.
/// Blank lines end the block, as does a line that is not numbers. Fields stand flush right: a last one that is narrower than the others
/// has lost its end.
pub(super) fn fixed_block(
    source: &Source,
    start: usize,
    declared: u64,
    format: Format,
    key: &str,
) -> Result<(Vec<f64>, usize)> {
    let mut values = Vec::new();
    let mut line = start;
    while (values.len() as u64) < declared {
        let text = source.line(line);
        let is_data = !text.trim().is_empty() && !text.trim_start().starts_with(['/', '|']) && !is_prose(text);
        if !is_data {
            return Err(source.count_error(start.saturating_sub(1), key, declared, values.len()).into());
        }
        let fields = fixed_fields(text, format.width).unwrap_or_else(|| vec![text]);
        for (column, field) in fields.into_iter().enumerate() {
            let value = number(field).ok_or_else(|| not_a_number(source, line, field).key(key))?;
            if column >= format.per_line {
                let what = format!(
                    "{} fields of {} characters are expected here, more were found",
                    format.per_line, format.width
                );
                return Err(source.error_at(line, what).key(key).into());
            }
            values.push(value);
        }
        source.room(line, values.len())?;
        line += 1;
    }
    if values.len() as u64 > declared {
        return Err(source.count_error(start.saturating_sub(1), key, declared, values.len()).into());
    }
    if line > start && !source.line(line - 1).trim_end().len().is_multiple_of(format.width) {
        let what = format!("the last field is narrower than {} characters", format.width);
        return Err(source.error_at(line - 1, what).key(key).help(CUT).into());
    }
    Ok((values, line))
}

/// Refuses numbers behind a block that ends before line `end`.
pub(super) fn refuse_more(source: &Source, end: usize, declared: u64, key: &str) -> Result<()> {
    let next = source.line(end).trim();
    // `E` may be an exponent; other letters make a title or the mark of an end.
    if next.is_empty() || next.bytes().any(|b| b.is_ascii_alphabetic() && !matches!(b, b'e' | b'E')) {
        return Ok(());
    }
    if next.starts_with(['/', '|']) {
        return Ok(());
    }
    let error = source.error_at(end, format!("more samples than the {declared} that the header declares"));
    Err(error.key(key).into())
}

/// Whether any channel of a file ends with `/&`: archives write it behind all of them, others behind none.
pub(super) fn is_marked(source: &Source) -> bool {
    source.lines.iter().any(|line| line.trim_start().starts_with("/&"))
}

/// Refuses a channel whose samples end before line `end` and that its format's mark does not close, or not in full:
/// `/&  ----------  END OF DATA FOR CHANNEL  1  ----------`, `/&` alone, `End-of-data for Chan  1 acceleration`.
pub(super) fn require_end_mark(source: &Source, end: usize) -> Result<()> {
    let line = (end..source.lines.len()).find(|line| !source.line(*line).trim().is_empty());
    let text = line.map_or("", |line| header_part(source.line(line).trim()));
    if !is_end_mark(text) {
        let error = source.error_at(end.saturating_sub(1), "no mark of the end of the channel follows its samples");
        return Err(error.allowed("`/&` or `End-of-data` behind every channel").help(CUT).into());
    }
    let is_whole = match text.strip_prefix("/&") {
        Some("") => true,
        // As many dashes behind the words as before them.
        Some(rest) => {
            let words = rest.trim().trim_start_matches('-');
            let dashes = rest.trim().len() - words.len();
            after(words, "channel").is_some_and(|rest| rest.len() - rest.trim_end_matches('-').len() >= dashes.max(1))
        }
        // Some writers name the channel alone.
        None => after(text, "for chan").is_some_and(|rest| {
            let last = rest.split_whitespace().next_back().unwrap_or("").to_ascii_lowercase();
            !last.is_empty() && QUANTITIES.iter().all(|quantity| last == *quantity || !quantity.starts_with(&last))
        }),
    };
    if is_whole {
        return Ok(());
    }
    let error = source.error_at(line.unwrap_or(end), format!("`{text}` is no whole mark of the end of a channel"));
    Err(error.help(CUT).into())
}

fn is_end_mark(text: &str) -> bool {
    text.starts_with("/&") || text.to_ascii_lowercase().starts_with("end-of-data")
}

/// Channels of the recorder as headers of this century tell them: `(3 Chns of  3 at Sta)` has the first of both.
pub(super) fn channels_of_recorder(source: &Source, lines: usize) -> Option<u64> {
    source.head(lines).find_map(|(_, line)| {
        let end = line.to_ascii_lowercase().find(" chns of ")?;
        line[..end].rsplit('(').next().and_then(count)
    })
}

/// The header line of a `NAME : value` file whose name contains `key`, and its value.
pub(super) fn named<'a>(source: &Source<'a>, lines: usize, key: &str) -> Option<(usize, &'a str)> {
    source.head(lines).find_map(|(index, line)| {
        let (name, value) = line.split_once(':')?;
        name.contains(key).then(|| (index, value.trim()))
    })
}

/// [`named`], which must be there.
pub(super) fn required<'a>(source: &Source<'a>, lines: usize, key: &'static str) -> Result<(usize, &'a str)> {
    named(source, lines, key).ok_or_else(|| missing(source, lines, key).into())
}

/// The error of a header that lacks `key`; it stands at the end of the header.
pub(super) fn missing(source: &Source, lines: usize, key: &str) -> InputError {
    let last = lines.min(source.lines.len()).saturating_sub(1);
    source.error_at(last, format!("the header has no `{key}`")).key(key)
}

/// The error of a header line that does not give what it should.
pub(super) fn unreadable(source: &Source, line: usize, key: &str, allowed: &str) -> InputError {
    let shown: String = source.line(line).trim().chars().take(60).collect();
    source.error_at(line, format!("`{shown}` gives no such number")).key(key).allowed(allowed)
}

/// Rows of `columns` numbers each from line `start` to the end of the file, column by column; `fields` parts a row. With `flush` all rows
/// are as wide as the first: one that is narrower has lost its end.
pub(super) fn rows<'a>(
    source: &Source<'a>,
    start: usize,
    columns: usize,
    flush: bool,
    fields: impl Fn(&'a str) -> Option<Vec<&'a str>>,
) -> Result<Rows> {
    let mut found = Rows { columns: vec![Vec::new(); columns], lines: Vec::new() };
    let width = source.line(start).trim_end().len();
    for (index, line) in source.lines.iter().copied().enumerate().skip(start) {
        if line.trim().is_empty() {
            continue;
        }
        let row = fields(line).unwrap_or_else(|| vec![line]);
        if row.len() != columns {
            let what = format!("{} number(s) here, {columns} are expected", row.len());
            let error = source.error_at(index, what).allowed("the same number of values in every line");
            return Err(if index + 1 >= source.lines.len() { error.help(CUT) } else { error }.into());
        }
        if flush && line.trim_end().len() != width {
            let what = format!("a row of {} characters, the first has {width}", line.trim_end().len());
            return Err(source.error_at(index, what).allowed("rows of one width").help(CUT).into());
        }
        for (column, field) in found.columns.iter_mut().zip(&row) {
            column.push(number(field).ok_or_else(|| not_a_number(source, index, field))?);
        }
        found.lines.push(index);
        source.room(index, columns * found.lines.len())?;
    }
    Ok(found)
}

/// What [`rows`] finds.
pub(super) struct Rows {
    pub columns: Vec<Vec<f64>>,
    /// Line of each row.
    pub lines: Vec<usize>,
}

/// Refuses a time column that is not k · dt, within `rounding` [s] and half a step.
pub(super) fn refuse_other_times(source: &Source, rows: &Rows, column: usize, dt: f64, rounding: f64) -> Result<()> {
    let times = &rows.columns[column];
    let start = times.first().copied().unwrap_or(0.0);
    let off = |(k, t): (usize, &f64)| !((t - start - k as f64 * dt).abs() <= rounding + 0.5 * dt);
    let Some(k) = times.iter().enumerate().position(off) else { return Ok(()) };
    let what = format!("the time is {} s where {} s is due", times[k], start + k as f64 * dt);
    Err(source.error_at(rows.lines[k], what).allowed(format!("steps of {dt} s, as the header says")).into())
}

/// Whether a line reads like text: three letters side by side, which no number contains, damaged or not.
fn is_prose(line: &str) -> bool {
    let letters = line.as_bytes().windows(3);
    let mut letters = letters.filter(|three| three.iter().all(u8::is_ascii_alphabetic));
    letters.next().is_some() && !is_not_finite(line)
}

/// Whether a line holds a word for a value that is not a number.
fn is_not_finite(line: &str) -> bool {
    let line = line.to_ascii_lowercase();
    line.contains("nan") || line.contains("inf")
}

/// The error of a field that is not a finite number.
pub(super) fn not_a_number(source: &Source, line: usize, field: &str) -> InputError {
    let shown: String = field.trim().chars().take(40).collect();
    source.error_at(line, format!("`{shown}` is not a finite number")).allowed("finite numbers")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_fortran_and_c() {
        assert_eq!(number(" -.1D+02 "), Some(-10.0));
        assert_eq!(number(".5E-02"), Some(0.005));
        for bad in ["nan", "inf", "-Infinity", "1e999", "", "1.0x", "0x10", "1_000"] {
            assert_eq!(number(bad), None, "{bad}");
        }
        assert_eq!(leading_number(" .00244 SEC"), Some(0.00244));
        assert_eq!(leading_number("0.005sec"), Some(0.005));
        assert_eq!(leading_number("1e-2s"), Some(0.01));
    }

    #[test]
    fn glued_fields_part_at_signs() {
        let fields: Vec<_> = free_fields("-.123E-01-.456E-02  1.0+2.0").collect();
        assert_eq!(fields, ["-.123E-01", "-.456E-02", "1.0", "+2.0"]);
    }

    #[test]
    fn formats() {
        let format = |per_line, width| Some(Format { per_line, width });
        assert_eq!(fortran_format("(10I8)"), format(10, 8));
        assert_eq!(fortran_format("(1E15.6)"), format(1, 15));
        assert_eq!(fortran_format("(5f15.6)"), format(5, 15));
        assert_eq!(fortran_format("(8(1pe10.4e1))"), format(8, 10));
        assert_eq!(fortran_format("E15.6"), format(1, 15));
        assert_eq!(fortran_format("(0F10.3)"), None);
        assert_eq!(fortran_format("(8X)"), None);
    }
}
