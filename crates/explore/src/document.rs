//! What a document holds, counted and listed.

use serde_json::Value;

/// Returns the number of keys in a value: the members of all its objects.
pub fn keys(value: &Value) -> usize {
    match value {
        Value::Object(map) => map.len() + map.values().map(keys).sum::<usize>(),
        Value::Array(list) => list.iter().map(keys).sum(),
        _ => 0,
    }
}

/// Returns the number of words and numbers in a value.
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
    /// The keys of a draw that say what is drawn.
    const DRAWN: [&str; 4] = ["mesh", "params", "shader", "textures"];
    /// The keys of a pass that name its parts.
    const PARTS: [&str; 5] = ["clears", "color", "depth_stencil", "draws", "read"];
    let mut all: Vec<String> = Vec::new();
    let mut add = |value: &Value, without: &[&str]| {
        for (key, value) in value.as_object().into_iter().flatten() {
            let state = format!("{key} {value}");
            if !without.contains(&key.as_str()) && !all.contains(&state) {
                all.push(state);
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
    all
}

/// Returns the items of a list; none where there is no list.
pub(crate) fn list<'v>(value: &'v Value, key: &str) -> &'v [Value] {
    value.get(key).and_then(Value::as_array).map_or(&[], |l| l)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

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
        let due = [
            "depth_stencil_read_only true",
            "logic \"xor\"",
            "path {\"state\":\"dynamic\"}",
        ];
        assert_eq!(states(&scene), due);
    }
}
