//! Resets states to their defaults, by removing their keys.

use crate::document::{draws_of, parts};
use crate::edit::{Edit, Pointer, below, pointer, value_at};
use serde_json::Value;

/// The keys that a case cannot lack, or that have their own pass.
const KEPT: [&str; 4] = ["format", "kind", "size", "shader"];

/// Removes states of draws: first all states of all draws, then one state of all draws, then states of one
/// draw: all, halves, and so on down to single states.
pub(crate) fn of_draws(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let draws = draws_of(document);
    let states = |draw: &Pointer| -> Vec<Pointer> {
        let map = value_at(document, draw).and_then(Value::as_object);
        let keys = map.into_iter().flat_map(|map| map.keys());
        let keys = keys.filter(|key| !["mesh", "shader"].contains(&key.as_str()));
        keys.map(|key| below(draw, key.as_str())).collect()
    };
    let mut edits = vec![Edit {
        remove: draws.iter().flat_map(&states).collect(),
        ..Edit::default()
    }];
    // One state, from all draws that have it.
    let mut keys: Vec<Pointer> = draws.iter().flat_map(states).collect();
    keys.sort_by(|a, b| a.last().cmp(&b.last()));
    for same in keys.chunk_by(|a, b| a.last() == b.last()) {
        edits.push(Edit {
            remove: same.to_vec(),
            ..Edit::default()
        });
    }
    for draw in &draws {
        let states_of_draw = states(draw);
        for part in parts(states_of_draw.len()) {
            edits.push(Edit {
                remove: states_of_draw[part].to_vec(),
                ..Edit::default()
            });
        }
    }
    edits
}

/// Removes each key of the scene, outer keys first.
pub(crate) fn members(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let mut edits = Vec::new();
    let mut next = vec![pointer!["scene"]];
    while !next.is_empty() {
        let mut inner = Vec::new();
        for pointer in next {
            match value_at(document, &pointer) {
                Some(Value::Object(map)) => {
                    for key in map.keys() {
                        let member = below(&pointer, key.as_str());
                        if !KEPT.contains(&key.as_str()) {
                            edits.push(Edit::removal(member.clone()));
                        }
                        inner.push(member);
                    }
                }
                Some(Value::Array(list)) => {
                    inner.extend((0..list.len()).map(|i| below(&pointer, i)))
                }
                _ => {}
            }
        }
        next = inner;
    }
    edits.extend(sizes(document));
    edits
}

/// Removes sizes that another attachment also has.
fn sizes(document: &Value) -> Vec<Edit> {
    let attachments = document["scene"]["attachments"].as_object();
    let mut given = attachments
        .into_iter()
        .flatten()
        .filter_map(|(name, a)| Some((name, a.get("size")?)));
    let Some((_, first)) = given.next() else {
        return Vec::new();
    };
    given
        .filter(|(_, size)| *size == first)
        .map(|(name, _)| Edit::removal(pointer!["scene", "attachments", name.as_str(), "size"]))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn outer_keys_are_removed_before_inner_ones_and_an_only_size_stays() {
        let document = json!({ "scene": {
            "attachments": { "a": { "format": "f", "size": [4, 4] }, "b": { "size": [4, 4] } },
            "passes": [{ "draws": [{ "stencil": { "front": { "compare": "less" } } }] }]
        } });
        let edits = members(&document, None);
        let pointer = |edit: &Edit| {
            let keys = edit.remove[0].iter().map(|step| match step {
                crate::edit::EditStep::Key(key) => key.clone(),
                crate::edit::EditStep::Item(i) => i.to_string(),
            });
            keys.collect::<Vec<_>>().join("/")
        };
        let pointers: Vec<String> = edits.iter().map(pointer).collect();
        let pointer_of = |name: &str| pointers.iter().position(|p| p.ends_with(name)).unwrap();
        assert!(
            pointer_of("/stencil") < pointer_of("/front")
                && pointer_of("/front") < pointer_of("/compare")
        );
        assert!(pointers.contains(&"scene/attachments/b/size".to_owned()));
        assert!(!pointers.contains(&"scene/attachments/a/size".to_owned()));
        assert!(!pointers.iter().any(|p| p.ends_with("format")));
    }
}
