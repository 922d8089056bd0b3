//! The numbers of a text file: where they begin, what parts them, and which character is the decimal point.

use crate::ground::resemblance;
use crate::ground::source::{Source, not_a_number, number};
use crate::ground::text::AS_ROWS;
use crate::{InputError, Result};

/// Most columns of a file: a line of more is no table.
const MOST_COLUMNS: usize = 1000;

/// The numbers of the file, column by column, and the line of each row; row by row one column, and the line where it begins.
pub(super) struct Table {
    pub columns: Vec<Vec<f64>>,
    pub lines: Vec<usize>,
    /// A unit of the last digit of the numbers in the first column as they are written, the coarsest.
    pub rounding: f64,
    /// Whether every line is two whole numbers with a comma between them and nothing else, like one number with a decimal comma.
    pub like_decimal_commas: bool,
}

pub(super) fn table(source: &Source, by_rows: bool) -> Result<Table> {
    let mut table = Table { columns: Vec::new(), lines: Vec::new(), rounding: 0.0, like_decimal_commas: true };
    let mut found = 0;
    for (index, line) in source.lines.iter().copied().enumerate() {
        if line.trim().is_empty() || is_comment(line) || (table.lines.is_empty() && is_title(line)) {
            continue;
        }
        let (fields, decimal_commas) = fields(line);
        let read = |field: &str| {
            let value = if decimal_commas { number(&field.replace(',', ".")) } else { number(field) };
            value.ok_or_else(|| bad_field(source, index, field))
        };
        if by_rows {
            if table.columns.is_empty() {
                (table.columns, table.lines) = (vec![Vec::new()], vec![index]);
            }
            for field in fields {
                table.columns[0].push(read(field)?);
                source.room(index, table.columns[0].len())?;
            }
            continue;
        }
        let fields: Vec<&str> = fields.take(MOST_COLUMNS + 1).collect();
        if fields.len() > MOST_COLUMNS {
            let error = source.error_at(index, format!("a line of more than {MOST_COLUMNS} numbers"));
            let help = format!("if they are one component: {AS_ROWS}");
            return Err(error.allowed(format!("up to {MOST_COLUMNS} columns")).help(help).into());
        }
        if table.columns.is_empty() {
            table.columns = vec![Vec::new(); fields.len()];
        }
        if fields.len() != table.columns.len() {
            let what = format!("{} column(s) here, {} in the lines before", fields.len(), table.columns.len());
            let error = source.error_at(index, what).allowed("the same number of columns in every line");
            let rows = table.columns.len() > 2;
            return Err(if rows {
                error.help(format!("if they are one component row by row: {AS_ROWS}"))
            } else {
                error
            }
            .into());
        }
        for (column, field) in table.columns.iter_mut().zip(&fields) {
            column.push(read(field)?);
        }
        table.lines.push(index);
        table.like_decimal_commas &= fields.len() == 2 && is_decimal_comma(line.trim());
        table.rounding = table.rounding.max(fields.first().map_or(0.0, |field| resolution(field)));
        found += fields.len();
        source.room(index, found)?;
    }
    if table.lines.is_empty() { Err(resemblance::nothing(source).into()) } else { Ok(table) }
}

fn bad_field(source: &Source, line: usize, field: &str) -> InputError {
    let error = not_a_number(source, line, field);
    if field.contains('"') {
        return error.help("save the numbers without quotes; with decimal commas, part the columns by semicolons");
    }
    // `0,5 1,5 2.5`: what a comma parts still holds a blank.
    let commas = source.line(line).contains(',') && !source.line(line).contains(';');
    if commas && field.trim().contains(char::is_whitespace) {
        error.help("with decimal commas, part the columns by semicolons")
    } else {
        error
    }
}

pub(super) fn is_comment(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with(['#', '%']) || line.starts_with("//")
}

/// A line that starts with a word. A word for an infinite or undefined value is a bad sample instead.
pub(super) fn is_title(line: &str) -> bool {
    let line = line.trim_start().trim_start_matches(['"', '\'', '[', '(']);
    let word: String = line.chars().take_while(|c| c.is_alphabetic()).take(20).collect::<String>().to_lowercase();
    !word.is_empty() && !matches!(word.as_str(), "nan" | "inf" | "infinity")
}

/// Fields of a line, and whether a comma in them is a decimal point; a separator at the end of the line makes no field.
fn fields(line: &str) -> (Box<dyn Iterator<Item = &str> + '_>, bool) {
    let line = line.trim();
    let parted =
        |separator: char| line.strip_suffix(separator).unwrap_or(line).split(separator).map(str::trim).map(unquoted);
    if line.contains(';') {
        (Box::new(parted(';')), true)
    } else if !line.contains(',') {
        (Box::new(line.split_whitespace().map(unquoted)), false)
    } else if has_decimal_commas(line) {
        (Box::new(line.split_whitespace()), true)
    } else {
        (Box::new(parted(',')), false)
    }
}

/// A number without the quotes in which some programs write every cell.
fn unquoted(field: &str) -> &str {
    field.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).map_or(field, str::trim)
}

/// Whether blanks or tabs part two or more numbers with commas in them: `0,01 -0,25`. A comma that parts numbers has a blank behind it
/// or none anywhere.
fn has_decimal_commas(line: &str) -> bool {
    let is_number = |token: &str| {
        let digits = |part: &str| part.bytes().all(|b| b.is_ascii_digit());
        let mantissa = token.split(['e', 'E']).next().unwrap_or("").trim_start_matches(['+', '-']);
        match mantissa.split_once(',') {
            Some((whole, decimals)) => digits(whole) && !decimals.is_empty() && digits(decimals),
            None => !mantissa.is_empty() && digits(mantissa),
        }
    };
    line.split_whitespace().nth(1).is_some() && line.split_whitespace().all(is_number)
}

/// `-0,25`
fn is_decimal_comma(text: &str) -> bool {
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
    text.split_once(',')
        .is_some_and(|(whole, decimals)| digits(whole.trim_start_matches(['+', '-'])) && digits(decimals))
}

/// A unit of the last digit of a number as it is written: 0.01 for `1.25`, 1 for `3`, 1e-5 for `1.25e-3`.
fn resolution(field: &str) -> f64 {
    let (mantissa, exponent) = field.split_once(['e', 'E', 'd', 'D']).unwrap_or((field, "0"));
    let decimals = mantissa.split_once(['.', ',']).map_or(0, |(_, decimals)| decimals.len());
    let exponent: i32 = exponent.parse().unwrap_or(0);
    10f64.powi(exponent.saturating_sub(decimals.min(400) as i32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_of_printed_numbers() {
        for (field, unit) in [("1.25", 0.01), ("3", 1.0), ("1.25e-3", 1e-5), ("1.5E+02", 10.0), ("0,005", 0.001)] {
            assert!((resolution(field) / unit - 1.0).abs() < 1e-12, "{field}");
        }
        assert_eq!(resolution("1e99999999999"), 1.0);
    }
}
