//! The JSON schema of case files.

use crate::place::EACH;
use crate::wire::FileWire;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

/// Returns the JSON schema of a case file. Below `scene`, `judged_as` and `expect`, any value may also be the
/// name of an axis or derived value: `"$name"`. Any object in a list may have the key `each`.
pub fn schema() -> Value {
    let mut root = schemars::schema_for!(FileWire).to_value();
    let mut items = BTreeSet::new();
    item_types(&root, &mut items);
    if let Some(definitions) = root.get_mut("$defs").and_then(Value::as_object_mut) {
        for (name, definition) in definitions.iter_mut() {
            if !matches!(name.as_str(), "AxisValue" | "DerivedWire") {
                admit_placeholders(definition);
            }
            if items.contains(name) {
                admit_each(definition);
            }
        }
    }
    root
}

/// Collects the names of the definitions that list items refer to.
fn item_types(schema: &Value, found: &mut BTreeSet<String>) {
    match schema {
        Value::Object(map) => {
            let item = map.get("items").and_then(|items| items["$ref"].as_str());
            found.extend(item.and_then(|item| Some(item.strip_prefix("#/$defs/")?.to_owned())));
            map.values().for_each(|value| item_types(value, found));
        }
        Value::Array(list) => list.iter().for_each(|value| item_types(value, found)),
        _ => {}
    }
}

/// Lets the objects of a definition have the key `each`.
fn admit_each(schema: &mut Value) {
    if let Some(properties) = schema.get_mut("properties").and_then(Value::as_object_mut) {
        let mut list = json!({ "type": "array", "minItems": 1 });
        wrap(&mut list);
        let each = json!({
            "description": "Lists of equal length: the item unrolls to one item per value, which replaces `\"$name\"`.",
            "type": "object",
            "minProperties": 1,
            "additionalProperties": list
        });
        properties.insert(EACH.to_owned(), each);
    }
    if let Some(variants) = schema.get_mut("anyOf").and_then(Value::as_array_mut) {
        variants.iter_mut().for_each(admit_each);
    }
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
        // The tag of a tagged union stays literal; otherwise its branches could not be distinguished.
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
