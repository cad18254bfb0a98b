//! Signatures: what of a scene tells one failure from another.
//!
//! Values are left out, since the same bug leaves other numbers and words in every scene: a driver that has one
//! logic operation wrong mostly has all of them wrong. Only words that choose other code altogether stay, such as
//! those of formats and shaders.

use crate::document::list;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fmt;

/// The keys of which the words stay.
const KEPT: [&str; 9] = [
    "counter",
    "early_tests",
    "format",
    "path",
    "polygon_mode",
    "shader",
    "topology",
    "advanced_blend",
    "depth_stencil_resolve",
];

/// The keys of a scene that are not at their default, some with their words.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Signature(BTreeSet<String>);

impl Signature {
    /// Returns the signature of a document.
    pub fn of(document: &Value) -> Self {
        let mut all = BTreeSet::new();
        let scene = &document["scene"];
        for attachment in scene["attachments"].as_object().into_iter().flatten() {
            let format = attachment.1["format"].as_str().unwrap_or_default();
            if format != "rgba8unorm" {
                all.insert(format!("format={format}"));
            }
            for key in ["samples", "texels"] {
                if attachment.1.get(key).is_some() {
                    all.insert(key.to_owned());
                }
            }
        }
        for pass in list(scene, "passes") {
            for (key, value) in pass.as_object().into_iter().flatten() {
                if !["color", "depth_stencil", "draws", "resolve"].contains(&key.as_str()) {
                    add(&mut all, key, value);
                }
            }
            if pass.get("resolve").is_some() {
                all.insert("resolve".to_owned());
            }
            for (key, value) in list(pass, "draws")
                .iter()
                .filter_map(Value::as_object)
                .flatten()
            {
                match key.as_str() {
                    "params" | "textures" | "counters" => {}
                    // Nearly everything is drawn with these.
                    "shader" if value == "uniform_color" || value == "flat_color" => {}
                    "mesh" if value["kind"] != "vertices" => {}
                    key => add(&mut all, key, value),
                }
            }
        }
        if let Some(kinds) = scene["counters"].as_object() {
            kinds
                .values()
                .for_each(|kind| add(&mut all, "counter", kind));
        }
        if let Some(path) = scene.get("path") {
            add(&mut all, "path", path);
        }
        if document.get("submissions").is_some() {
            all.insert("submissions".to_owned());
        }
        Self(all)
    }

    /// True if a scene has all keys of this signature, and so may show the same. A signature without keys is in
    /// none: everything would show it.
    pub fn is_in(&self, document: &Value) -> bool {
        !self.0.is_empty() && self.0.is_subset(&Self::of(document).0)
    }
}

impl fmt::Display for Signature {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all: Vec<&str> = self.0.iter().map(String::as_str).collect();
        f.write_str(&all.join(", "))
    }
}

/// Adds the keys below a value with their words.
fn add(all: &mut BTreeSet<String>, path: &str, value: &Value) {
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                add(all, &format!("{path}.{key}"), value);
            }
        }
        Value::Array(list) if list.iter().any(Value::is_object) => {
            for value in list {
                add(all, path, value);
            }
        }
        Value::String(word) if KEPT.iter().any(|key| path.starts_with(key)) => {
            all.insert(format!("{path}={word}"));
        }
        Value::Null => {}
        _ => {
            all.insert(path.to_owned());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn document(draw: Value) -> Value {
        json!({ "scene": {
            "attachments": { "c": { "format": "rgba8unorm", "size": [4, 4] } },
            "passes": [{ "color": ["c"], "draws": [draw] }], "read": ["c"]
        } })
    }

    #[test]
    fn keys_tell_failures_apart_and_values_do_not() {
        let of = |logic: &str, red: f64, topology: &str| {
            Signature::of(&document(json!({
                "mesh": { "kind": "full" }, "shader": "uniform_color", "logic": logic,
                "params": { "color": [red, 0, 0, 0] }, "topology": topology
            })))
        };
        let one = of("xor", 0.5, "line-list");
        assert_eq!(one, of("nor", 0.25, "line-list"));
        assert_ne!(one, of("xor", 0.5, "point-list"));
        assert_eq!(one.to_string(), "logic, topology=line-list");
    }

    #[test]
    fn a_scene_with_all_keys_may_show_the_same() {
        let small = document(json!({ "shader": "uniform_color", "depth": { "compare": "less" } }));
        let large = document(json!({
            "shader": "texel_color", "depth": { "compare": "never", "write": true }, "cull": "back"
        }));
        assert!(Signature::of(&small).is_in(&large));
        assert!(!Signature::of(&large).is_in(&small));
        let other = document(json!({ "shader": "front_facing", "depth": { "compare": "less" } }));
        assert!(!Signature::of(&other).is_in(&large));
        let nothing = document(json!({ "shader": "uniform_color" }));
        assert!(!Signature::of(&nothing).is_in(&large));
    }
}
