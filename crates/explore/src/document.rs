//! Counting and listing the parts of a document.

use crate::edit::{Pointer, pointer};
use serde_json::Value;
use std::ops::Range;

/// Returns the number of keys in a value, over all its objects.
pub fn keys(value: &Value) -> usize {
    match value {
        Value::Object(map) => map.len() + map.values().map(keys).sum::<usize>(),
        Value::Array(list) => list.iter().map(keys).sum(),
        _ => 0,
    }
}

/// Returns the number of scalars in a value.
pub fn leaves(value: &Value) -> usize {
    match value {
        Value::Object(map) => map.values().map(leaves).sum(),
        Value::Array(list) => list.iter().map(leaves).sum(),
        _ => 1,
    }
}

/// Returns the states of a scene that are not the default, each once and in order of passes and draws:
/// `logic "xor"`, `depth {"compare":"less","write":true}`.
pub fn states(scene: &Value) -> Vec<String> {
    /// The keys of a draw that state what is drawn.
    const DRAWN: [&str; 4] = ["mesh", "params", "shader", "textures"];
    /// The keys of a pass that name its parts.
    const PARTS: [&str; 5] = ["clears", "color", "depth_stencil", "draws", "read"];
    let mut states: Vec<String> = Vec::new();
    let mut add = |value: &Value, without: &[&str]| {
        for (key, value) in value.as_object().into_iter().flatten() {
            let state = format!("{key} {value}");
            if !without.contains(&key.as_str()) && !states.contains(&state) {
                states.push(state);
            }
        }
    };
    for pass in list(scene, "passes") {
        add(pass, &PARTS);
        for clear in list(pass, "clears") {
            add(&serde_json::json!({ "clear": clear }), &[]);
        }
        for draw in list(pass, "draws") {
            add(draw, &DRAWN);
        }
    }
    if let Some(path) = scene.get("path") {
        add(&serde_json::json!({ "path": path }), &[]);
    }
    states
}

/// Returns the items of a list; empty if there is no such list.
pub(crate) fn list<'v>(value: &'v Value, key: &str) -> &'v [Value] {
    value.get(key).and_then(Value::as_array).map_or(&[], |l| l)
}

/// Returns the parts of a list with `length` items that are removed together: the whole list, both halves,
/// quarters, down to single items.
pub(crate) fn parts(length: usize) -> Vec<Range<usize>> {
    let mut ranges = Vec::new();
    let mut size = length;
    while size > 0 {
        let starts = (0..length).step_by(size);
        ranges.extend(starts.map(|start| start..(start + size).min(length)));
        size /= 2;
    }
    ranges
}

/// Returns the number of passes of a scene.
pub(crate) fn passes_of(document: &Value) -> usize {
    list(&document["scene"], "passes").len()
}

/// Returns the paths of all draws.
pub(crate) fn draws_of(document: &Value) -> Vec<Pointer> {
    let passes = list(&document["scene"], "passes").iter();
    let each = passes.enumerate().flat_map(|(p, pass)| {
        let draws = 0..list(pass, "draws").len();
        draws.map(move |d| pointer!["scene", "passes", p, "draws", d])
    });
    each.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn parts_begin_with_the_whole_and_get_smaller() {
        assert_eq!(parts(4), [0..4, 0..2, 2..4, 0..1, 1..2, 2..3, 3..4]);
        assert_eq!(parts(3), [0..3, 0..1, 1..2, 2..3]);
        assert!(parts(0).is_empty());
    }

    #[test]
    fn keys_and_leaves_are_counted_at_every_depth() {
        let value = json!({ "a": [1, { "b": "c", "d": [] }], "e": { "f": null } });
        assert_eq!((keys(&value), leaves(&value)), (5, 3));
    }

    #[test]
    fn states_are_listed_once() {
        let draw = json!({ "mesh": { "kind": "full" }, "shader": "flat_color", "logic": "xor" });
        let scene = json!({
            "passes": [{ "color": ["c"], "depth_stencil_read_only": true, "draws": [draw, draw] }],
            "path": { "state": "dynamic" }
        });
        let expected = [
            "depth_stencil_read_only true",
            "logic \"xor\"",
            "path {\"state\":\"dynamic\"}",
        ];
        assert_eq!(states(&scene), expected);
    }
}
