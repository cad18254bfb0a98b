//! The JSON schema of case files.

use crate::wire::FileWire;
use serde_json::{Map, Value, json};

/// The JSON schema of a case file. Below `scene`, `judged_as` and `expect`, any value may also be
/// the name of an axis or derived value: `"$name"`.
pub fn schema() -> Value {
    let mut root = schemars::schema_for!(FileWire).to_value();
    if let Some(definitions) = root.get_mut("$defs").and_then(Value::as_object_mut) {
        for (name, definition) in definitions.iter_mut() {
            if !matches!(name.as_str(), "AxisValue" | "DerivedWire") {
                admit_placeholders(definition);
            }
        }
    }
    root
}

/// Lets every property and item below a schema also be a placeholder.
fn admit_placeholders(schema: &mut Value) {
    let Some(object) = schema.as_object_mut() else {
        return;
    };
    for (key, value) in object.iter_mut() {
        match (key.as_str(), value) {
            ("properties", Value::Object(properties)) => wrap_all(properties),
            ("items" | "additionalProperties", value @ Value::Object(_)) => wrap(value),
            ("anyOf" | "oneOf" | "allOf", Value::Array(list)) => {
                list.iter_mut().for_each(admit_placeholders);
            }
            _ => {}
        }
    }
}

fn wrap_all(properties: &mut Map<String, Value>) {
    for (name, value) in properties.iter_mut() {
        // The tag of a tagged union stays literal, else no branch could be told from another.
        if name != "kind" {
            wrap(value);
        }
    }
}

fn wrap(value: &mut Value) {
    admit_placeholders(value);
    let inner = value.take();
    *value = json!({ "anyOf": [inner, { "type": "string", "pattern": "^\\$[A-Za-z0-9._+-]+$" }] });
}
