//! Numbers and tables for people: a minus is U+2212, as in figures and reports, a zero has no sign, and rounding of what is
//! nothing is 0. Files, JSON and whatever may be typed into a wall file keep the hyphen.

use std::borrow::Cow;

/// Size in SI, or of a pure number, from which it is one: what is less is rounding.
pub const NOTHING: f64 = 1e-15;

/// Whether a number is 0 but for rounding.
fn is_nothing(value: f64) -> bool {
    value.abs() < NOTHING
}

/// A number as it was written out, with the sign that it has on paper.
fn signed(text: &str) -> String {
    let digits = text.strip_prefix('-').filter(|digits| digits.chars().all(|c| matches!(c, '0' | '.')));
    digits.unwrap_or(text).replace('-', "−")
}

/// With that many decimals.
pub fn fixed(value: f64, decimals: usize) -> String {
    signed(&format!("{value:.decimals$}"))
}

/// With an exponent and that many decimals: `1.3e−10`.
pub fn exponent(value: f64, decimals: usize) -> String {
    if is_nothing(value) { "0".into() } else { signed(&format!("{value:.decimals$e}")) }
}

/// A fraction in per cent, three digits: `0.423 %`, `12.0 %`.
pub fn percent(fraction: f64) -> String {
    if is_nothing(fraction) { "0".into() } else { format!("{} %", significant(100.0 * fraction, 3)) }
}

/// A value with its unit and a decimal prefix, four significant digits: `1.198 µm`, `53.40 kN`.
pub fn si(value: f64, unit: &str) -> String {
    const PREFIXES: [(&str, f64); 8] =
        [("G", 1e9), ("M", 1e6), ("k", 1e3), ("", 1.0), ("m", 1e-3), ("µ", 1e-6), ("n", 1e-9), ("p", 1e-12)];
    // Numbers without unit have one in result files.
    let unit = if unit == "1" { "" } else { unit };
    if is_nothing(value) || !value.is_finite() {
        return format!("{} {unit}", significant(value, 4)).trim_end().into();
    }
    // Rounded first: 999.96 reads 1.000 k, not 1000.
    let value: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    match PREFIXES.iter().find(|(_, factor)| value.abs() >= *factor) {
        Some(_) if unit.is_empty() && (1e-3..1e6).contains(&value.abs()) => significant(value, 4),
        Some((prefix, factor)) if value.abs() < 1e12 && !unit.is_empty() => {
            format!("{} {prefix}{unit}", significant(value / factor, 4))
        }
        _ => format!("{} {unit}", exponent(value, 3)).trim_end().into(),
    }
}

/// As [`si`], without zeros behind the last digit: `15 ms`.
pub fn short(value: f64, unit: &str) -> String {
    let text = si(value, unit);
    let (number, unit) = text.split_once(' ').unwrap_or((&text, ""));
    let number = if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number };
    format!("{number} {unit}").trim_end().into()
}

/// A number of things: `1 run`, `2 runs`. `one` takes an s.
pub fn counted(number: usize, one: &str) -> String {
    format!("{number} {one}{}", if number == 1 { "" } else { "s" })
}

/// Decimal notation with that many significant digits.
pub fn significant(value: f64, digits: i32) -> String {
    if is_nothing(value) {
        return "0".into();
    }
    if !value.is_finite() {
        return signed(&value.to_string());
    }
    let decimals = (digits - 1 - value.abs().log10().floor() as i32).max(0) as usize;
    if decimals > MOST_DECIMALS {
        let digits = (digits - 1).max(0) as usize;
        return exponent(value, digits);
    }
    fixed(value, decimals)
}

/// A number of an axis that reaches as far as `largest`, without the digits that rounding leaves behind.
pub fn tick(value: f64, largest: f64) -> String {
    if value.abs() <= 1e-9 * largest.abs() { "0".into() } else { without_zeros(significant(value, 6)) }
}

/// Decimals from which a number is written with an exponent.
const MOST_DECIMALS: usize = 15;

/// A time in seconds as it is, without the digits that rounding leaves behind: `12.325 s`, `39.99 s`, `65 s`.
pub fn seconds(value: f64) -> String {
    format!("{} s", plain(value))
}

/// At most nine significant digits, no zeros behind the last.
pub fn plain(value: f64) -> String {
    without_zeros(significant(value, 9))
}

/// Decimals without zeros behind the last digit.
fn without_zeros(text: String) -> String {
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
    padded(rows, width(rows))
}

/// Width of the longest name.
pub fn width<'a>(rows: impl IntoIterator<Item = &'a (&'a str, String)>) -> usize {
    rows.into_iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0)
}

/// Names, all as wide as the longest is to be, and values.
pub fn padded(rows: &[(&str, String)], width: usize) -> String {
    rows.iter().map(|(name, value)| format!("  {name:<width$}  {}\n", line(value))).collect()
}

/// Whether a terminal obeys a character instead of showing it: control characters, and marks that turn the order of what is
/// read (Unicode Bidirectional Algorithm, 2.1 to 2.6), which make a text read as another.
pub fn commands(c: char) -> bool {
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || (c.is_control() && !matches!(c, '\n' | '\t'))
}

/// A text that a terminal shows as it is; what it would obey is replaced by U+FFFD.
pub fn plain_text(text: &str) -> Cow<'_, str> {
    match text.contains(commands) {
        false => text.into(),
        true => text.replace(commands, "\u{fffd}").into(),
    }
}

/// [`plain_text`] of one line: ends of lines in a name must not make lines of our own.
pub fn line(text: &str) -> Cow<'_, str> {
    match text.contains(['\n', '\t']) {
        false => plain_text(text),
        true => plain_text(text).replace(['\n', '\t'], " ").into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes() {
        assert_eq!(si(1.198e-6, "m"), "1.198 µm");
        assert_eq!(si(-2.348e5, "N"), "−234.8 kN");
        assert_eq!(si(0.99999, "J"), "1.000 J");
        assert_eq!(si(0.0, "J"), "0 J");
        assert_eq!(si(1e-15, "m"), "1.000e−15 m");
        assert_eq!((si(0.75, "1"), si(2e7, ""), short(0.5, "1")), ("0.7500".into(), "2.000e7".into(), "0.5".into()));
        assert_eq!(si(f64::NAN, "m"), "NaN m");
    }

    /// Zeros have no sign, what is rounding is 0, and there is one minus.
    #[test]
    fn zeros_and_signs() {
        for nothing in [-0.0, 0.0, 1e-23, -3e-17] {
            assert_eq!(
                (si(nothing, "m"), significant(nothing, 3), plain(nothing)),
                ("0 m".into(), "0".into(), "0".into())
            );
            assert_eq!(
                (exponent(nothing, 1), percent(nothing), seconds(nothing)),
                ("0".into(), "0".into(), "0 s".into())
            );
        }
        assert_eq!((fixed(-0.004, 2), fixed(-0.006, 2), fixed(-0.0, 0)), ("0.00".into(), "−0.01".into(), "0".into()));
        assert_eq!((exponent(-1.3e-10, 1), si(f64::NEG_INFINITY, "N")), ("−1.3e−10".into(), "−inf N".into()));
        assert_eq!(
            (percent(0.004234), percent(-0.12), plain(-4.5)),
            ("0.423 %".into(), "−12.0 %".into(), "−4.5".into())
        );
    }

    #[test]
    fn ticks_are_those_of_their_axis() {
        assert_eq!([-2.5, 1.7e-13, 0.30000000000000004].map(|v| tick(v, 5.0)), ["−2.5", "0", "0.3"]);
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
