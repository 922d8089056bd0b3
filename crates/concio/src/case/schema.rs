//! Where a key stands in a JSON Schema, and what that says of it.

use serde_json::Value;

/// What a schema says of the whole number at a key; none of keys that are none.
pub(super) fn whole(schema: &Value, key: &str) -> Option<String> {
    let found = follow(schema, schema, &steps(key))?;
    // The list of a list of numbers speaks for its items.
    let found = found.get("items").filter(|_| key.ends_with(']')).unwrap_or(found);
    let bound = |name: &str| found.get(name).and_then(Value::as_f64);
    let low = bound("minimum")?;
    Some(match bound("maximum") {
        Some(high) => format!("a whole number, {} … {}", grouped(low), grouped(high)),
        None => format!("a whole number from {low}"),
    })
}

/// A whole number with commas between its thousands.
fn grouped(number: f64) -> String {
    let digits = number.to_string();
    let groups: Vec<&[u8]> = digits.as_bytes().rchunks(3).rev().collect();
    groups.iter().map(|group| String::from_utf8_lossy(group)).collect::<Vec<_>>().join(",")
}

pub(super) fn steps(key: &str) -> Vec<&str> {
    key.split(['.', '[']).filter(|s| !s.is_empty()).collect()
}

/// What a part of the schema refers to.
pub(super) fn referred<'a>(root: &'a Value, at: &Value) -> Option<&'a Value> {
    let name = at.get("$ref").and_then(Value::as_str)?.strip_prefix("#/$defs/")?;
    root["$defs"].get(name)
}

/// The part of the schema that a path leads to. References are looked into only when the path goes on, so that the
/// description is that of the key and not of its type.
pub(super) fn follow<'a>(root: &'a Value, at: &'a Value, steps: &[&str]) -> Option<&'a Value> {
    let Some((step, rest)) = steps.split_first() else { return Some(at) };
    let next = match step.strip_suffix(']') {
        Some(_) => at.get("items"),
        None => at.get("properties").and_then(|p| p.get(step)),
    };
    if let Some(next) = next {
        // An item has no words of its own; those of its list speak for it.
        let list = rest.is_empty() && step.ends_with(']') && next.get("description").is_none();
        return if list { Some(at) } else { follow(root, next, rest) };
    }
    if let Some(definition) = referred(root, at) {
        return follow(root, definition, steps);
    }
    at.get("anyOf")?.as_array()?.iter().find_map(|option| follow(root, option, steps))
}
