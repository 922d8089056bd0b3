//! Numbers and tables for people.

use std::borrow::Cow;

use crate::files::line;

/// A value with its unit and a decimal prefix, four significant digits: `1.198 µm`, `53.40 kN`.
pub fn si(value: f64, unit: &str) -> String {
    const PREFIXES: [(&str, f64); 8] =
        [("G", 1e9), ("M", 1e6), ("k", 1e3), ("", 1.0), ("m", 1e-3), ("µ", 1e-6), ("n", 1e-9), ("p", 1e-12)];
    if value == 0.0 || !value.is_finite() {
        return format!("{value} {unit}").trim_end().into();
    }
    // Rounded first: 999.96 reads 1.000 k, not 1000.
    let value: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    match PREFIXES.iter().find(|(_, factor)| value.abs() >= *factor) {
        Some((prefix, factor)) if value.abs() < 1e12 => format!("{} {prefix}{unit}", significant(value / factor, 4)),
        _ => format!("{value:.3e} {unit}"),
    }
}

/// As [`si`], without zeros behind the last digit: `15 ms`.
pub fn short(value: f64, unit: &str) -> String {
    let text = si(value, unit);
    let (number, unit) = text.split_once(' ').unwrap_or((&text, ""));
    let number = if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number };
    format!("{number} {unit}")
}

/// A number of things: `1 run`, `2 runs`. `one` takes an s.
pub fn counted(number: usize, one: &str) -> String {
    format!("{number} {one}{}", if number == 1 { "" } else { "s" })
}

/// Decimal notation with that many significant digits.
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let decimals = (digits - 1 - value.abs().log10().floor() as i32).max(0) as usize;
    if decimals > MOST_DECIMALS {
        let digits = (digits - 1).max(0) as usize;
        return format!("{value:.digits$e}");
    }
    format!("{value:.decimals$}")
}

/// Decimals from which a number is written with an exponent.
const MOST_DECIMALS: usize = 15;

/// A time in seconds as it is, without the digits that rounding leaves behind: `12.325 s`, `39.99 s`, `65 s`.
pub fn seconds(value: f64) -> String {
    format!("{} s", plain(value))
}

/// At most nine significant digits, no zeros behind the last.
pub fn plain(value: f64) -> String {
    let text = significant(value, 9);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').into()
    } else {
        text
    }
}

/// A time by the clock: `0.42 s`, `3 min 12 s`.
pub fn clock(seconds: f64) -> String {
    if seconds < 60.0 {
        return format!("{} s", significant(seconds, 3));
    }
    let whole = seconds.round() as u64;
    match (whole / 3600, whole / 60 % 60, whole % 60) {
        (0, minutes, seconds) => format!("{minutes} min {seconds} s"),
        (hours, minutes, _) => format!("{hours} h {minutes} min"),
    }
}

/// Rows with aligned columns: the first to the left, the others to the right. A cell is one line, whatever a name in it holds.
pub fn columns(rows: &[Vec<String>]) -> String {
    let rows: Vec<Vec<Cow<str>>> = rows.iter().map(|row| row.iter().map(|cell| line(cell)).collect()).collect();
    let width = |k: usize| rows.iter().filter_map(|r| r.get(k)).map(|c| c.chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..rows.iter().map(Vec::len).max().unwrap_or(0)).map(width).collect();
    let text = |row: &Vec<Cow<str>>| {
        let cells = row.iter().zip(&widths).enumerate();
        let cells = cells.map(|(k, (c, &w))| if k == 0 { format!("{c:<w$}") } else { format!("{c:>w$}") });
        format!("  {}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    rows.iter().map(text).collect()
}

/// Names and values in two columns.
pub fn pairs(rows: &[(&str, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    rows.iter().map(|(name, value)| format!("  {name:<width$}  {}\n", line(value))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes() {
        assert_eq!(si(1.198e-6, "m"), "1.198 µm");
        assert_eq!(si(-2.348e5, "N"), "-234.8 kN");
        assert_eq!(si(0.99999, "J"), "1.000 J");
        assert_eq!(si(0.0, "J"), "0 J");
        assert_eq!(si(1e-15, "m"), "1.000e-15 m");
        assert_eq!(si(f64::NAN, "m"), "NaN m");
    }

    #[test]
    fn times() {
        assert_eq!(seconds(49.995000000000005), "49.995 s");
        assert_eq!((seconds(65.0), seconds(0.0), seconds(12.325)), ("65 s".into(), "0 s".into(), "12.325 s".into()));
        assert_eq!(plain(1000.0), "1000");
        assert_eq!(clock(0.4166), "0.417 s");
        assert_eq!(clock(192.2), "3 min 12 s");
        assert_eq!(clock(7500.0), "2 h 5 min");
    }

    #[test]
    fn tables_align() {
        let row = |a: &str, b: &str| vec![a.to_string(), b.to_string()];
        assert_eq!(columns(&[row("bed", "46"), row("connection", "7")]), "  bed         46\n  connection   7\n");
    }
}
