//! Where the inputs of two runs differ, key by key.

use concio::case;
use concio::quantity::shown;
use concio_study::table::Table;
use serde_json::Value;

/// Letters of a value that are shown.
const LONGEST: usize = 60;

/// A key at which two cases differ; none where a case does not have it.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The key of the wall file.
    pub key: String,
    /// What stands there, in SI.
    pub values: [Option<String>; 2],
}

/// All differences of two resolved cases, by the alphabet of their keys.
pub fn differences(a: &Value, b: &Value) -> Vec<Difference> {
    let mut found = Vec::new();
    walk("", [Some(a), Some(b)], &mut found);
    for difference in &mut found {
        let unit = unit(&difference.key);
        for value in difference.values.iter_mut().flatten() {
            if value.parse::<f64>().is_ok() {
                value.push_str(&unit);
            }
        }
    }
    found
}

fn walk(key: &str, values: [Option<&Value>; 2], found: &mut Vec<Difference>) {
    match values {
        [Some(a), Some(b)] if a == b => {}
        [Some(Value::Object(a)), Some(Value::Object(b))] => {
            let below = |name: &String| if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
            let more = b.keys().filter(|name| !a.contains_key(*name));
            a.keys().chain(more).for_each(|name| walk(&below(name), [a.get(name), b.get(name)], found));
        }
        [Some(Value::Array(a)), Some(Value::Array(b))] if a.len() == b.len() => {
            let pairs = a.iter().zip(b).enumerate();
            pairs.for_each(|(k, (a, b))| walk(&format!("{key}[{k}]"), [Some(a), Some(b)], found));
        }
        values => found.push(Difference { key: key.into(), values: values.map(|value| value.map(text)) }),
    }
}

/// A value in a line.
fn text(value: &Value) -> String {
    let text = match value {
        Value::Number(number) => number.as_f64().map_or_else(|| number.to_string(), shown),
        Value::String(text) => text.clone(),
        Value::Array(items) if items.iter().any(|item| item.is_object() || item.is_array()) => {
            return if items.len() == 1 { "1 entry".into() } else { format!("{} entries", items.len()) };
        }
        Value::Array(items) => format!("[{}]", items.iter().map(text).collect::<Vec<_>>().join(", ")),
        Value::Object(table) => {
            let entries = table.iter().map(|(name, value)| format!("{name} = {}", text(value)));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    };
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// The unit that the documentation of a key names, behind a blank; empty where it names none.
fn unit(key: &str) -> String {
    let Some(about) = case::describe(key) else { return String::new() };
    let brackets = about.split('[').skip(1).filter_map(|part| part.split_once(']')).map(|(inside, _)| inside);
    let unit =
        brackets.into_iter().find(|inside| !inside.contains([',', '`', ' ']) && inside.contains(char::is_alphabetic));
    let word = |name: &&str| about.contains(&format!(" in {name}"));
    unit.or_else(|| ["Pa", "rad"].into_iter().find(word)).map_or(String::new(), |unit| format!(" {unit}"))
}

/// The differences as a table.
pub fn table(names: [&str; 2], found: &[Difference]) -> Table {
    let mut table = Table::default();
    table.texts("key", found.iter().map(|d| Some(d.key.clone())).collect());
    for (k, name) in names.into_iter().enumerate() {
        let cell = |d: &Difference| Some(d.values[k].clone().unwrap_or_else(|| "–".into()));
        table.texts(name, found.iter().map(cell).collect());
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn every_key_that_differs_is_told_with_its_unit() {
        let a = json!({ "model": "shear", "panel": [{ "brick": { "length": 0.25, "height": 0.055 }, "block": [{ "x": 1 }] }],
                        "joint": { "friction": { "static": 0.30000000000000004 } }, "motion": { "duration": 2.0, "base": "none" } });
        let b = json!({ "model": "shear", "panel": [{ "brick": { "length": 0.3, "height": 0.055 }, "block": [] }],
                        "joint": { "friction": { "static": 0.6 } }, "motion": { "base": { "ramp": { "rise": 1.0 } } },
                        "solver": { "tolerance": 0.01 } });
        let found = differences(&a, &b);
        let told: Vec<[&str; 3]> = found
            .iter()
            .map(|d| [d.key.as_str(), d.values[0].as_deref().unwrap_or("–"), d.values[1].as_deref().unwrap_or("–")])
            .collect();
        assert_eq!(
            told,
            [
                ["joint.friction.static", "0.3", "0.6"],
                ["motion.base", "none", "{ ramp = { rise = 1 } }"],
                ["motion.duration", "2 s", "–"],
                ["panel[0].block", "1 entry", "[]"],
                ["panel[0].brick.length", "0.25 m", "0.3 m"],
                ["solver", "–", "{ tolerance = 0.01 }"],
            ]
        );
        assert!(differences(&a, &a).is_empty());
    }
}
