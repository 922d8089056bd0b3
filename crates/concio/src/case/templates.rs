//! What helps to write a wall file: the JSON Schema, the starter file, the built-in example.

use serde_json::{Map, Value, json};

use super::{Case, CaseFile, Syntax, from_str};
use crate::Result;

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
    schema
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

/// A commented wall file to start from, in TOML.
pub fn starter() -> &'static str {
    include_str!("starter.toml")
}

/// The built-in wall: a brick panel of six courses under a heavy floor, shaken by a synthetic record.
///
/// # Errors
/// None in a released version: a test reads it.
pub fn example() -> Result<CaseFile> {
    from_str(include_str!("builtin.toml"), Syntax::Toml, None)
}
