//! Shortens lists: removes further frames, passes, draws, clear commands and counters.

use crate::document::{draws_of, list, parts, passes_of};
use crate::edit::{Edit, below, pointer};
use serde_json::{Map, Value, json};
use std::ops::Range;

/// Removes variants, readings, literal values and the relation between frames.
pub(crate) fn frames(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let keys = ["variants", "submissions", "relation", "expect"];
    let given: Vec<&str> = keys
        .into_iter()
        .filter(|key| document.get(key).is_some())
        .collect();
    let mut edits = Vec::new();
    for sizes in parts(given.len()) {
        let pointers = given[sizes].iter().map(|key| pointer![*key]);
        edits.push(Edit {
            remove: pointers.collect(),
            ..Edit::default()
        });
    }
    for key in ["variants", "submissions", "expect"] {
        for part in parts(list(document, key).len()) {
            edits.push(Edit {
                remove: part.map(|i| pointer![key, i]).collect(),
                ..Edit::default()
            });
        }
    }
    edits
}

/// Removes passes.
pub(crate) fn passes(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let parts = parts(passes_of(document)).into_iter();
    parts
        .map(|part| {
            let mut edit = renumbered(document, "/passes", &part);
            edit.remove = part.map(|i| pointer!["scene", "passes", i]).collect();
            edit
        })
        .collect()
}

/// Removes draws. Clear commands keep their order among the remaining draws.
pub(crate) fn draws(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (p, pass) in list(&document["scene"], "passes").iter().enumerate() {
        for part in parts(list(pass, "draws").len()) {
            let mut edit = renumbered(document, &format!("/passes/{p}/draws"), &part);
            for (c, clear) in list(pass, "clears").iter().enumerate() {
                let Some(before) = clear["before"].as_u64() else {
                    continue;
                };
                let gone = part.clone().filter(|i| (*i as u64) < before).count() as u64;
                if gone > 0 {
                    let pointer = pointer!["scene", "passes", p, "clears", c, "before"];
                    edit.replace.push((pointer, json!(before - gone)));
                }
            }
            let pointers = part.map(|d| pointer!["scene", "passes", p, "draws", d]);
            edit.remove = pointers.collect();
            edits.push(edit);
        }
    }
    edits
}

/// Removes clear commands.
pub(crate) fn clears(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (p, pass) in list(&document["scene"], "passes").iter().enumerate() {
        for part in parts(list(pass, "clears").len()) {
            let pointers = part.map(|c| pointer!["scene", "passes", p, "clears", c]);
            edits.push(Edit {
                remove: pointers.collect(),
                ..Edit::default()
            });
        }
    }
    edits
}

/// Removes counters, with their names in draws.
pub(crate) fn counters(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let scene = &document["scene"];
    let Some(counters) = scene.get("counters").and_then(Value::as_object) else {
        return Vec::new();
    };
    let names: Vec<&String> = counters.keys().collect();
    let mut edits = Vec::new();
    for part in parts(names.len()) {
        let gone = &names[part];
        let all_gone = gone.len() == names.len();
        let mut edit = Edit {
            remove: if all_gone {
                vec![pointer!["scene", "counters"]]
            } else {
                gone.iter()
                    .map(|name| pointer!["scene", "counters", name.as_str()])
                    .collect()
            },
            ..Edit::default()
        };
        for draw in draws_of(document) {
            let counters = below(&draw, "counters");
            let Some(Value::Array(used)) = crate::edit::value_at(document, &counters) else {
                continue;
            };
            let pointers = used.iter().enumerate().filter_map(|(i, name)| {
                let name = name.as_str()?;
                gone.iter().any(|g| *g == name).then(|| below(&counters, i))
            });
            if all_gone {
                edit.remove.push(counters.clone());
            } else {
                edit.remove.extend(pointers);
            }
        }
        edits.push(edit);
    }
    // A draw without counters.
    for draw in draws_of(document) {
        edits.push(Edit::removal(below(&draw, "counters")));
    }
    edits
}

/// Returns an edit that renumbers the JSON pointers and orders of variants and of the judge's scene after
/// items of a list are removed.
fn renumbered(document: &Value, list: &str, gone: &Range<usize>) -> Edit {
    let number = |i: usize| match i {
        i if gone.contains(&i) => None,
        i if i >= gone.end => Some(i - gone.len()),
        i => Some(i),
    };
    let pointer = |old: &str| -> Option<String> {
        let Some(path) = old.strip_prefix(list).and_then(|r| r.strip_prefix('/')) else {
            return Some(old.to_owned());
        };
        let (item, path) = path
            .split_once('/')
            .map_or((path, None), |(i, r)| (i, Some(r)));
        let Ok(item) = item.parse() else {
            return Some(old.to_owned());
        };
        let item = number(item)?;
        Some(match path {
            Some(path) => format!("{list}/{item}/{path}"),
            None => format!("{list}/{item}"),
        })
    };
    let moved = |changes: &Value| -> Map<String, Value> {
        let each = changes.as_object().into_iter().flatten();
        each.filter_map(|(old, value)| Some((pointer(old)?, value.clone())))
            .collect()
    };
    let mut edit = Edit::default();
    if let Some(changes) = document.get("judged_as") {
        let changes = moved(changes);
        if Value::Object(changes.clone()) != document["judged_as"] {
            edit.replace.push((pointer!["judged_as"], changes.into()));
        }
    }
    let variants = document.get("variants").and_then(Value::as_array);
    for (v, variant) in variants.into_iter().flatten().enumerate() {
        for key in ["patch", "permute"] {
            let Some(changes) = variant.get(key) else {
                continue;
            };
            let mut changes = moved(changes);
            if key == "permute"
                && let Some(Value::Array(order)) = changes.get_mut(list)
            {
                let kept = order.iter().filter_map(Value::as_u64);
                let kept = kept.filter_map(|i| number(i as usize)).map(|i| json!(i));
                *order = kept.collect();
            }
            if Value::Object(changes.clone()) != *variant.get(key).unwrap_or(&Value::Null) {
                edit.replace
                    .push((pointer!["variants", v, key], changes.into()));
            }
        }
    }
    edit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pointers_orders_and_clears_follow_the_draws() {
        let document = json!({
            "scene": { "passes": [{
                "clears": [{ "before": 0 }, { "before": 2 }, { "before": 3 }],
                "draws": [{ "shader": "a" }, { "shader": "b" }, { "shader": "c" }]
            }] },
            "variants": [{
                "name": "v",
                "patch": { "/passes/0/draws/1/shader": "x", "/passes/0/draws/2": "y", "/read": [] },
                "permute": { "/passes/0/draws": [2, 1, 0] }
            }],
            "judged_as": { "/passes/0/draws/2/shader": "z" }
        });
        let edits = draws(&document, None);
        // The edits remove all, then single items, since half of three is one.
        let without_second = edits[2].apply(&document).unwrap();
        let pass = &without_second["scene"]["passes"][0];
        assert_eq!(pass["draws"], json!([{ "shader": "a" }, { "shader": "c" }]));
        assert_eq!(
            pass["clears"],
            json!([{ "before": 0 }, { "before": 1 }, { "before": 2 }])
        );
        assert_eq!(
            without_second["variants"][0],
            json!({
                "name": "v",
                "patch": { "/passes/0/draws/1": "y", "/read": [] },
                "permute": { "/passes/0/draws": [1, 0] }
            })
        );
        let expected = json!({ "/passes/0/draws/1/shader": "z" });
        assert_eq!(without_second["judged_as"], expected);
    }

    #[test]
    fn removing_a_counter_removes_its_uses() {
        let document = json!({ "scene": {
            "counters": { "a": "samples-passed", "b": "shader-runs" },
            "passes": [{ "draws": [{ "counters": ["a", "b"] }, { "counters": ["b"] }] }]
        } });
        let edits = counters(&document, None);
        let none = edits[0].apply(&document).unwrap();
        assert_eq!(
            none,
            json!({ "scene": { "passes": [{ "draws": [{}, {}] }] } })
        );
        let without_a = edits[1].apply(&document).unwrap();
        let draws = &without_a["scene"]["passes"][0]["draws"];
        assert_eq!(
            *draws,
            json!([{ "counters": ["b"] }, { "counters": ["b"] }])
        );
    }
}
