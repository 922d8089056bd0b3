//! What the lines above the numbers of a text file say: interval, names of the columns, words that may be a unit.

use crate::ground::source::{Source, leading_number};

/// Lines whose words are listened to.
pub(super) const HEADER: usize = 200;

/// The interval that a header line names.
pub(super) fn named_interval(source: &Source, data_line: usize) -> Option<(usize, f64)> {
    const PERIOD: [&str; 5] = ["dt", "time step", "timestep", "sampling interval", "sample interval"];
    const RATE: [&str; 4] = ["sampling rate", "sample rate", "sampling frequency", "fs"];
    source.head(data_line.min(HEADER)).find_map(|(index, line)| {
        let lower = line.to_lowercase();
        let period = PERIOD.iter().find_map(|key| keyed_number(&lower, key));
        let period = period.map(|(value, unit)| if unit.starts_with("ms") { value * 1e-3 } else { value });
        let rate = || {
            let (value, unit) = RATE.iter().find_map(|key| keyed_number(&lower, key))?;
            Some(if unit.starts_with("khz") { 1e-3 / value } else { 1.0 / value })
        };
        period.or_else(rate).map(|dt| (index, dt))
    })
}

/// The number and the text behind it in `key = 0.01 s`; the key must be a word of its own.
fn keyed_number<'a>(line: &'a str, key: &str) -> Option<(f64, &'a str)> {
    let mut from = 0;
    while let Some(at) = line.get(from..)?.find(key).map(|at| at + from) {
        from = at + key.len();
        let before = line[..at].chars().next_back();
        let rest = line[from..].trim_start();
        let Some(value) = rest.strip_prefix(['=', ':']).filter(|_| before.is_none_or(|c| !c.is_alphanumeric())) else {
            continue;
        };
        let unit =
            value.trim_start().trim_start_matches(|c: char| c.is_ascii_digit() || "+-.e".contains(c)).trim_start();
        return leading_number(value).map(|number| (number, unit));
    }
    None
}

/// Titles of the columns: the last header line, when it has as many fields as there are columns.
pub(super) fn column_names<'a>(source: &Source<'a>, data_line: usize, columns: usize) -> Vec<&'a str> {
    let above = (0..data_line).rev().map(|index| source.line(index));
    let Some(title) = above.into_iter().find(|line| !line.trim().is_empty()) else { return Vec::new() };
    let title = title.trim_start().trim_start_matches(['#', '%', '/']).trim();
    let separator = [';', ',', '\t'].into_iter().find(|c| title.contains(*c));
    let fields: Vec<&str> = match separator {
        Some(c) => title.split(c).map(|field| field.trim().trim_matches('"')).collect(),
        None if columns == 1 => vec![title],
        None if title.starts_with(['[', '(']) => title.split_whitespace().collect(),
        None => titles(title),
    };
    let keyed = title.contains(['=', ':']);
    if fields.len() == columns && !keyed { fields } else { Vec::new() }
}

/// Titles between blanks; what stands in brackets belongs to the one before.
fn titles(line: &str) -> Vec<&str> {
    let (mut starts, mut depth, mut blank) = (Vec::new(), 0, true);
    for (at, c) in line.char_indices() {
        match c {
            '[' | '(' => depth += 1,
            ']' | ')' => depth = (depth - 1).max(0),
            _ if blank && depth == 0 && !c.is_whitespace() => starts.push(at),
            _ => {}
        }
        blank = c.is_whitespace();
    }
    let ends = starts.iter().skip(1).copied().chain([line.len()]);
    starts.iter().zip(ends).map(|(start, end)| line[*start..end].trim_end()).collect()
}

/// Words of a header line that may be a unit: in brackets, behind `units:`, behind `units of`.
pub(in crate::ground) fn unit_words(line: &str) -> Vec<&str> {
    let mut words: Vec<&str> = bracketed(line).collect();
    let lower = line.to_ascii_lowercase();
    let key = ["units of", "units", "unit"].into_iter().find_map(|key| lower.find(key).map(|at| at + key.len()));
    if let Some(end_of_key) = key {
        let rest = line[end_of_key..].trim_start().trim_start_matches(['=', ':']).trim_start();
        let end = rest.find(|c: char| c.is_whitespace() || matches!(c, ',' | ';' | '"')).unwrap_or(rest.len());
        words.push(rest[..end].trim_end_matches('.'));
    }
    words
}

/// What stands in square or round brackets.
pub(super) fn bracketed(line: &str) -> impl Iterator<Item = &str> {
    line.split(['[', '(']).skip(1).filter_map(|part| part.split([']', ')']).next()).map(str::trim)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_a_header() {
        assert_eq!(keyed_number("npts = 5, dt= .005 sec", "dt").map(|n| n.0), Some(0.005));
        assert_eq!(keyed_number("width = 5", "dt"), None);
        assert_eq!(unit_words("# Units: cm/s2, corrected"), ["cm/s2"]);
        assert_eq!(unit_words("# acceleration in units of g."), ["g"]);
        assert_eq!(bracketed("time [s], acc [m/s2]").collect::<Vec<_>>(), ["s", "m/s2"]);
    }
}
