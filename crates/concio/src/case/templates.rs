//! What helps to write a wall file: the JSON Schema and the starter files.

use std::sync::OnceLock;

use serde_json::{Map, Value, json};

use super::schema::{follow, referred, steps};
use super::{Case, ModelKind};

/// The JSON Schema (draft 2020-12) of the wall file, with the documentation of every key.
pub fn schema() -> Value {
    let mut schema = schemars::schema_for!(Case).to_value();
    schema["title"] = json!("Concio wall file");
    // A parameter set gives these keys, so their absence is wrong only without one.
    let without_set = json!({ "not": { "required": ["set"] } });
    relax(&mut schema, &["joint"]);
    schema["if"] = without_set;
    schema["then"] = json!({ "required": ["joint"] });
    if let Some(definitions) = schema.get_mut("$defs").and_then(Value::as_object_mut) {
        relax_definition(definitions, "Joints", &["bed", "head"]);
        relax_definition(definitions, "Spring", &["law"]);
        relax_definition(definitions, "Friction", &["law"]);
        relax_definition(definitions, "Panel", &["brick"]);
        relax_definition(definitions, "Brick", &["length", "height", "thickness", "specific_weight"]);
        relax_definition(definitions, "Mortar", &["bed", "head"]);
    }
    without_null(&mut schema);
    schema
}

/// Takes out the nulls that stand for absent values: in a wall file the key is left out instead.
fn without_null(schema: &mut Value) {
    match schema {
        Value::Array(items) => items.iter_mut().for_each(without_null),
        Value::Object(table) => {
            if let Some(types) = table.get_mut("type").and_then(Value::as_array_mut) {
                types.retain(|t| t != "null");
                if let [only] = types.as_slice() {
                    table["type"] = only.clone();
                }
            }
            if let Some(options) = table.get_mut("anyOf").and_then(Value::as_array_mut) {
                options.retain(|o| o.get("type").is_none_or(|t| t != "null"));
            }
            table.values_mut().for_each(without_null);
        }
        _ => {}
    }
}

fn relax_definition(definitions: &mut Map<String, Value>, name: &str, keys: &[&str]) {
    if let Some(definition) = definitions.get_mut(name) {
        relax(definition, keys);
    }
}

/// Takes keys out of the list of the required ones.
fn relax(schema: &mut Value, keys: &[&str]) {
    if let Some(required) = schema.get_mut("required").and_then(Value::as_array_mut) {
        required.retain(|name| !name.as_str().is_some_and(|n| keys.contains(&n)));
    }
}

/// A commented wall file of this model to start from, in TOML.
pub fn starter(model: ModelKind) -> &'static str {
    match model {
        ModelKind::Shear => include_str!("starter.toml"),
        ModelKind::Planar => include_str!("starter-planar.toml"),
        ModelKind::Rocking => include_str!("starter-rocking.toml"),
    }
}

/// What the schema says of a key (`panel[0].brick.length`): meaning, unit, bounds, default.
pub fn describe(key: &str) -> Option<String> {
    let schema = schema();
    let found = follow(&schema, &schema, &steps(key))?;
    found.get("description").and_then(Value::as_str).map(|text| text.replace('\n', " "))
}

/// Unit of a number without one at a key such as `motion.base.pga`: m/s²; none of pure numbers and of keys whose unit depends on others.
pub fn unit(key: &str) -> Option<String> {
    // A study asks for each of its factors.
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    let schema = SCHEMA.get_or_init(schema);
    let text = follow(schema, schema, &steps(key))?.get("description")?.as_str()?;
    let (_, behind) = text.split_once('[')?;
    let (unit, rest) = behind.split_once(']')?;
    let is_unit = !rest.contains('[') && unit.chars().all(|c| c.is_alphabetic() || matches!(c, '/' | '²' | '³' | ' '));
    is_unit.then(|| unit.to_string())
}

/// The words that a key may stand for; none where it takes others too.
pub(crate) fn choices(key: &str) -> Option<Vec<String>> {
    let schema = schema();
    let found = follow(&schema, &schema, &steps(key))?;
    let found = found.get("items").filter(|_| key.ends_with(']')).unwrap_or(found);
    let found = referred(&schema, found).unwrap_or(found);
    let word = |option: &Value| option.as_str().map(str::to_string);
    match (found.get("enum"), found.get("oneOf")) {
        (Some(Value::Array(words)), _) => words.iter().map(word).collect(),
        (_, Some(Value::Array(options))) => options.iter().map(|o| o.get("const").and_then(word)).collect(),
        _ => None,
    }
}

/// How a table of the wall file begins in TOML: `[motion]`, `[[panel]]`; none where a key is none.
pub(crate) fn table(key: &str) -> Option<String> {
    let schema = schema();
    let found = follow(&schema, &schema, &steps(key))?;
    let of = |at: &Value| referred(&schema, at).unwrap_or(at).get("properties").is_some();
    match found.get("items") {
        Some(items) if of(items) => Some(format!("[[{key}]]")),
        _ => of(found).then(|| format!("[{key}]")),
    }
}
