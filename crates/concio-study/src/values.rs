//! Values as a study file gives them: numbers, amounts with a unit, and changes of a wall file.

use concio::Result;
use concio::quantity::shown;
use serde_json::{Number, Value};

/// Changes of a wall file: key paths and values.
pub type Changes = Vec<(String, Value)>;

/// Longest text that is looked at for a number [bytes].
const LONGEST_AMOUNT: usize = 1000;

/// The error that `wrong` makes of it where there are more than `most` of what is said at a key.
pub(crate) fn few(number: usize, most: usize, wrong: impl Fn(String, &str) -> concio::Error) -> Result<()> {
    match number > most {
        true => Err(wrong(format!("{number} of them are too many"), &format!("up to {most}"))),
        false => Ok(()),
    }
}

/// A number and its unit, of a number or a text such as "10 mm".
pub fn amount(value: &Value) -> Option<(f64, String)> {
    match value {
        Value::Number(n) => n.as_f64().map(|v| (v, String::new())),
        Value::String(text) => {
            let text = text.trim();
            if text.len() > LONGEST_AMOUNT {
                return None;
            }
            // The longest start that is a number: "1e3 m" and "2 e/s" differ in where the unit begins.
            let cuts = text.char_indices().map(|(i, _)| i).chain([text.len()]).skip(1);
            let end = cuts.filter(|&i| text[..i].trim().parse::<f64>().is_ok()).last()?;
            let number: f64 = text[..end].trim().parse().ok()?;
            number.is_finite().then(|| (number, text[end..].trim().to_string()))
        }
        _ => None,
    }
}

/// A value as a wall file says it.
pub(crate) fn written(value: f64, unit: &str) -> Value {
    if unit.is_empty() { number(value) } else { Value::String(format!("{value:?} {unit}")) }
}

/// A number with four digits, for sentences.
pub(crate) fn short(value: f64) -> String {
    shown(format!("{value:.3e}").parse().unwrap_or(value))
}

/// A number as JSON; null when it is none.
pub fn number(value: f64) -> Value {
    Number::from_f64(value).map_or(Value::Null, Value::Number)
}
