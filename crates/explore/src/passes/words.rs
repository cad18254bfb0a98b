//! Replaces formats, functions and factors by common ones.

use crate::edit::{Edit, EditStep, Pointer, below, pointer};
use serde_json::{Value, json};

/// The simple values under a key, the simplest first. Values that are not listed are the least simple.
const SIMPLE: [(&str, &[&str]); 14] = [
    ("compare", &["always", "never", "less", "greater", "equal"]),
    ("fail_op", &["zero", "replace", "invert"]),
    ("depth_fail_op", &["zero", "replace", "invert"]),
    ("pass_op", &["zero", "replace", "invert"]),
    ("operation", &["add", "subtract"]),
    ("src_factor", &["one", "zero"]),
    ("dst_factor", &["zero", "one"]),
    ("logic", &["copy", "clear", "set", "invert", "xor"]),
    ("advanced_blend", &["multiply", "screen"]),
    ("cull", &["back", "front"]),
    ("filter", &["nearest"]),
    ("address", &["clamp-to-edge", "repeat"]),
    ("write_mask", &["r", "g", "b", "a"]),
    ("kind", &[]),
];

/// Formats of depth and stencil, the simplest first.
const DEPTH: [&str; 3] = ["depth32float", "stencil8", "depth24plus-stencil8"];

/// Replaces named values of states by simpler ones, and `true` by `false`.
pub(crate) fn words(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let mut edits = Vec::new();
    walk(
        &document["scene"]["passes"],
        pointer!["scene", "passes"],
        &mut |pointer, value| {
            let key = pointer.iter().rev().find_map(|step| match step {
                EditStep::Key(key) => Some(key.as_str()),
                EditStep::Item(_) => None,
            });
            if *value == json!(true) {
                edits.push(Edit::replacement(pointer.clone(), false));
            }
            let (Some(key), Some(word)) = (key, value.as_str()) else {
                return;
            };
            let Some((_, simple)) = SIMPLE.iter().find(|(name, _)| *name == key) else {
                return;
            };
            let rank = simple
                .iter()
                .position(|s| *s == word)
                .unwrap_or(simple.len());
            for other in &simple[..rank] {
                // Masks only lose bits.
                if key != "write_mask" || word.contains(other) {
                    edits.push(Edit::replacement(pointer.clone(), *other));
                }
            }
        },
    );
    edits
}

/// Simplifies formats, for all attachments of a format together.
pub(crate) fn formats(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let Some(attachments) = document["scene"]["attachments"].as_object() else {
        return Vec::new();
    };
    let format = |a: &Value| a["format"].as_str().unwrap_or_default().to_owned();
    let mut formats: Vec<String> = attachments.values().map(format).collect();
    formats.sort_unstable();
    formats.dedup();
    let mut edits = Vec::new();
    for from in formats {
        let depth = from.starts_with("depth") || from.starts_with("stencil");
        let simple: &[&str] = if depth { &DEPTH } else { &["rgba8unorm"] };
        let rank = simple.iter().position(|s| *s == from);
        for to in &simple[..rank.unwrap_or(simple.len())] {
            let mut edit = Edit::default();
            for (name, attachment) in attachments {
                if format(attachment) != from {
                    continue;
                }
                let pointer = pointer!["scene", "attachments", name.as_str()];
                edit.replace.push((below(&pointer, "format"), json!(to)));
                let aspect = match *to {
                    "depth32float" => "depth",
                    "stencil8" => "stencil",
                    _ => continue,
                };
                if let Some(value) = attachment["clear"].get(aspect) {
                    edit.replace.push((below(&pointer, "clear"), value.clone()));
                }
            }
            edits.push(edit);
        }
    }
    edits
}

/// Calls a function with every string, number and boolean below a path.
pub(super) fn walk(value: &Value, pointer: Pointer, each: &mut dyn FnMut(&Pointer, &Value)) {
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                walk(value, below(&pointer, key.as_str()), each);
            }
        }
        Value::Array(list) => {
            for (i, value) in list.iter().enumerate() {
                walk(value, below(&pointer, i), each);
            }
        }
        _ => each(&pointer, value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_become_simpler_and_masks_narrower() {
        let document = json!({ "scene": { "passes": [{ "draws": [
            { "logic": "clear", "write_mask": "gb", "depth": { "compare": "less", "write": true } }
        ] }] } });
        let draws: Vec<Value> = words(&document, None)
            .iter()
            .map(|e| e.apply(&document).unwrap()["scene"]["passes"][0]["draws"][0].clone())
            .collect();
        let with = |key: &str| {
            let values = draws.iter().map(|d| d[key].clone());
            let mut values: Vec<Value> = values.collect();
            values.dedup();
            values
        };
        assert_eq!(
            with("logic"),
            [json!("clear"), json!("copy"), json!("clear")]
        );
        assert_eq!(with("write_mask"), [json!("gb"), json!("g"), json!("b")]);
        let depth = |compare: &str, write: bool| json!({ "compare": compare, "write": write });
        assert_eq!(
            with("depth"),
            [
                depth("always", true),
                depth("never", true),
                depth("less", false),
                depth("less", true)
            ]
        );
    }

    #[test]
    fn a_format_takes_its_part_of_the_clear_value_along() {
        let document = json!({ "scene": { "attachments": {
            "d": { "format": "depth32float-stencil8", "clear": { "depth": 0.5, "stencil": 3 } }
        } } });
        let made = |i: usize| {
            let edit = &formats(&document, None)[i];
            edit.apply(&document).unwrap()["scene"]["attachments"]["d"].clone()
        };
        assert_eq!(made(0), json!({ "format": "depth32float", "clear": 0.5 }));
        assert_eq!(made(1), json!({ "format": "stencil8", "clear": 3 }));
        assert_eq!(made(2)["clear"]["stencil"], 3);
    }
}
