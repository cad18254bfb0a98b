//! Signatures: the parts of a scene that distinguish failures.
//!
//! Values are left out, because the same bug shows with different numbers and words in every scene: a
//! driver that gets one logic operation wrong usually gets all of them wrong. Only words that select
//! entirely different code are kept, such as those of formats and shaders. [`Signature::exact`] keeps more,
//! to decide whether two failures are the same beyond what groups of failures need.

use serde_json::Value;
use std::collections::BTreeSet;
use std::fmt;

/// The keys whose words are kept.
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

/// The keys whose numbers are values of colours and depths: most code is right from 0 to 1, and less of it
/// outside.
const VALUES: [&str; 5] = ["blend_constant", "clear", "clears", "operations", "params"];

/// The keys of a scene that are not at their default, some with their words.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Signature(BTreeSet<String>);

/// The parts of a scene that become its signature.
#[derive(Clone, Copy, PartialEq, Eq)]
enum SceneDetail {
    /// Keys, and the words of some keys.
    Keys,
    /// Keys, all words, and whether colours and depths are below 0 or above 1.
    Words,
}

impl Signature {
    /// Returns the signature of a document.
    pub fn of(document: &Value) -> Self {
        Self::with(document, SceneDetail::Keys)
    }

    /// Returns the signature with everything except numbers: all words and booleans, sample counts, and
    /// whether values of colours and depths are below 0 or above 1.
    pub fn exact(document: &Value) -> Self {
        Self::with(document, SceneDetail::Words)
    }

    fn with(document: &Value, detail: SceneDetail) -> Self {
        let mut states = BTreeSet::new();
        let add = |states: &mut BTreeSet<String>, path: &str, value: &Value| {
            add(states, path, value, detail);
        };
        let scene = &document["scene"];
        for attachment in scene["attachments"].as_object().into_iter().flatten() {
            let format = attachment.1["format"].as_str().unwrap_or_default();
            if format != "rgba8unorm" {
                states.insert(format!("format={format}"));
            }
            for key in ["samples", "texels"] {
                match attachment.1.get(key) {
                    Some(count) if key == "samples" && detail == SceneDetail::Words => {
                        states.insert(format!("{key}={count}"));
                    }
                    Some(_) => {
                        states.insert(key.to_owned());
                    }
                    None => {}
                }
            }
        }
        for pass in list(scene, "passes") {
            for (key, value) in pass.as_object().into_iter().flatten() {
                if !["color", "depth_stencil", "draws", "resolve"].contains(&key.as_str()) {
                    add(&mut states, key, value);
                }
            }
            if pass.get("resolve").is_some() {
                states.insert("resolve".to_owned());
            }
            for (key, value) in list(pass, "draws")
                .iter()
                .filter_map(Value::as_object)
                .flatten()
            {
                match key.as_str() {
                    "params" if detail == SceneDetail::Words => {
                        add_sides(&mut states, key, value);
                    }
                    "params" | "textures" | "counters" => {}
                    // Nearly every scene uses one of these.
                    "shader" if value == "uniform_color" || value == "flat_color" => {}
                    "mesh" if value["kind"] != "vertices" => {}
                    key => add(&mut states, key, value),
                }
            }
        }
        if let Some(kinds) = scene["counters"].as_object() {
            kinds
                .values()
                .for_each(|kind| add(&mut states, "counter", kind));
        }
        if let Some(path) = scene.get("path") {
            add(&mut states, "path", path);
        }
        if document.get("submissions").is_some() {
            states.insert("submissions".to_owned());
        }
        Self(states)
    }

    /// Returns true if another signature has all keys of this one, so that its scene can show the same
    /// failure. The result is false for a signature without keys, because every signature has all of its
    /// keys.
    pub fn is_within(&self, other: &Self) -> bool {
        !self.0.is_empty() && self.0.is_subset(&other.0)
    }

    /// Returns the signature with groups of keys instead of keys: `stencil` for all of its keys. Words are
    /// kept, except depth and stencil formats, since most bugs do not depend on a particular one.
    #[must_use]
    pub fn coarse(&self) -> Self {
        let group = |key: &String| match (key.contains('='), key.split_once('.')) {
            (false, Some((group, _))) => group.to_owned(),
            _ => key.clone(),
        };
        Self(self.without_depth_formats().0.iter().map(group).collect())
    }

    /// Returns the signature without formats of depth and stencil.
    #[must_use]
    pub fn without_depth_formats(&self) -> Self {
        let other = |key: &&String| {
            let format = key.strip_prefix("format=").unwrap_or_default();
            !format.starts_with("depth") && !format.starts_with("stencil")
        };
        Self(self.0.iter().filter(other).cloned().collect())
    }

    /// Returns the signature without the formats and texels of attachments.
    #[must_use]
    pub fn without_formats(&self) -> Self {
        let kept = |key: &&String| !key.starts_with("format=") && *key != "texels";
        Self(self.0.iter().filter(kept).cloned().collect())
    }

    /// Returns the signature without vertices, as if the mesh were an ordinary one.
    #[must_use]
    pub fn without_vertices(&self) -> Self {
        let kept = |key: &&String| !key.starts_with("mesh.") && *key != "mesh";
        Self(self.0.iter().filter(kept).cloned().collect())
    }

    /// Returns the number of keys and words.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns true if the signature has no keys.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the number of keys and words that two signatures share.
    pub fn shared(&self, other: &Self) -> usize {
        self.0.intersection(&other.0).count()
    }

    /// Returns the keys and words of this signature that another signature lacks.
    #[must_use]
    pub fn without(&self, other: &Self) -> Self {
        Self(self.0.difference(&other.0).cloned().collect())
    }
}

impl fmt::Display for Signature {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let states: Vec<&str> = self.0.iter().map(String::as_str).collect();
        f.write_str(&states.join(", "))
    }
}

/// Returns the items of a list; empty if there is no list.
fn list<'v>(value: &'v Value, key: &str) -> &'v [Value] {
    value.get(key).and_then(Value::as_array).map_or(&[], |l| l)
}

/// Adds the keys below a value with their words.
fn add(states: &mut BTreeSet<String>, path: &str, value: &Value, detail: SceneDetail) {
    let words = detail == SceneDetail::Words;
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                add(states, &format!("{path}.{key}"), value, detail);
            }
        }
        Value::Array(list) if list.iter().any(Value::is_object) => {
            for value in list {
                add(states, path, value, detail);
            }
        }
        Value::String(word) if words || KEPT.iter().any(|key| path.starts_with(key)) => {
            states.insert(format!("{path}={word}"));
        }
        Value::Bool(value) if words => {
            states.insert(format!("{path}={value}"));
        }
        Value::Null => {}
        _ => {
            states.insert(path.to_owned());
            for word in value.as_array().into_iter().flatten() {
                if let (true, Some(word)) = (words, word.as_str()) {
                    states.insert(format!("{path}={word}"));
                }
            }
            if words && VALUES.iter().any(|key| path.starts_with(key)) {
                add_sides(states, path, value);
            }
        }
    }
}

/// Adds whether any numbers below a value are below 0 or above 1.
fn add_sides(states: &mut BTreeSet<String>, path: &str, value: &Value) {
    match value {
        // Rectangles are not values.
        Value::Object(map) => map
            .iter()
            .filter(|(key, _)| *key != "rect")
            .for_each(|(_, value)| add_sides(states, path, value)),
        Value::Array(list) => list.iter().for_each(|value| add_sides(states, path, value)),
        Value::Number(number) if !path.ends_with(".rect") => {
            let number = number.as_f64().unwrap_or_default();
            let side = match (number < 0.0, number > 1.0) {
                (true, _) => "<0",
                (_, true) => ">1",
                _ => return,
            };
            states.insert(format!("{path}{side}"));
        }
        _ => {}
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
    fn keys_distinguish_failures_and_values_do_not() {
        let signature = |logic: &str, red: f64, topology: &str| {
            Signature::of(&document(json!({
                "mesh": { "kind": "full" }, "shader": "uniform_color", "logic": logic,
                "params": { "color": [red, 0, 0, 0] }, "topology": topology
            })))
        };
        let lines = signature("xor", 0.5, "line-list");
        assert_eq!(lines, signature("nor", 0.25, "line-list"));
        assert_ne!(lines, signature("xor", 0.5, "point-list"));
        assert_eq!(lines.to_string(), "logic, topology=line-list");
    }

    #[test]
    fn a_signature_is_within_one_that_has_all_its_keys() {
        let small = document(json!({ "shader": "uniform_color", "depth": { "compare": "less" } }));
        let large = document(json!({
            "shader": "texel_color", "depth": { "compare": "never", "write": true }, "cull": "back"
        }));
        assert!(Signature::of(&small).is_within(&Signature::of(&large)));
        assert!(!Signature::of(&large).is_within(&Signature::of(&small)));
        let other = document(json!({ "shader": "front_facing", "depth": { "compare": "less" } }));
        assert!(!Signature::of(&other).is_within(&Signature::of(&large)));
        let nothing = document(json!({ "shader": "uniform_color" }));
        assert!(!Signature::of(&nothing).is_within(&Signature::of(&large)));
    }

    #[test]
    fn an_exact_signature_keeps_words_and_drops_numbers() {
        let exact = |draw: Value| Signature::exact(&document(draw));
        let signature = |logic: &str, red: f64, write: bool| {
            exact(json!({
                "mesh": { "kind": "full" }, "shader": "uniform_color", "logic": logic,
                "params": { "color": [red, 0, 0, 0] }, "depth": { "compare": "less", "write": write },
                "scissor": [0, 0, 4, 4]
            }))
        };
        let written = signature("xor", 0.5, true);
        assert_eq!(written, signature("xor", 0.25, true));
        assert_ne!(written, signature("nor", 0.5, true));
        assert_ne!(written, signature("xor", 0.5, false));
        assert_ne!(written, signature("xor", -0.5, true));
        assert_eq!(
            signature("xor", 1.5, true).without(&written).to_string(),
            "params>1",
        );
        let sampler = json!({ "sampler": { "address": ["repeat", "mirror-repeat"] } });
        assert_eq!(
            exact(sampler).to_string(),
            "sampler.address, sampler.address=mirror-repeat, sampler.address=repeat"
        );
        let mut cleared = document(json!({ "shader": "uniform_color" }));
        cleared["scene"]["passes"][0]["clears"] =
            json!([{ "before": 0, "color": 0, "value": [0, 0, -1, 0], "rect": [2, 2, 4, 4] }]);
        assert_eq!(
            Signature::exact(&cleared).to_string(),
            "clears.before, clears.color, clears.rect, clears.value, clears.value<0"
        );
        let mut sampled = cleared.clone();
        sampled["scene"]["attachments"]["c"]["samples"] = json!(4);
        let more = Signature::exact(&sampled).without(&Signature::exact(&cleared));
        assert_eq!(more.to_string(), "samples=4");
    }

    #[test]
    fn signatures_share_their_common_keys() {
        let signature = |draw: Value| Signature::of(&document(draw));
        let small = signature(json!({ "cull": "back" }));
        let large = signature(json!({ "cull": "back", "logic": "xor" }));
        assert!(small.is_within(&large) && !large.is_within(&small));
        assert_eq!((small.shared(&large), large.len()), (1, 2));
        let stencil = |key: &str| {
            signature(
                json!({ "stencil": { "front": { "compare": "always", key: "zero" } },
                "topology": "point-list" }),
            )
        };
        let [first, other] = ["fail_op", "pass_op"].map(stencil);
        assert!(!first.is_within(&other) && first.coarse() == other.coarse());
        assert_eq!(first.coarse().to_string(), "stencil, topology=point-list");
        let mut reduced = document(json!({ "logic": "xor", "mesh": { "kind": "vertices" } }));
        reduced["scene"]["attachments"]["c"]["format"] = json!("r8unorm");
        let reduced = Signature::of(&reduced);
        assert_eq!(reduced.to_string(), "format=r8unorm, logic, mesh.kind");
        assert_eq!(
            reduced.without_vertices().to_string(),
            "format=r8unorm, logic"
        );
        assert_eq!(reduced.without_formats().to_string(), "logic, mesh.kind");
        let none = signature(json!({}));
        assert!(none.is_empty() && !none.is_within(&large));
    }
}
