//! Warnings on a case file that builds: names that are unused, and parameters that are used but not given.
//!
//! They need no judge, so `--cases` can afford them. `etalon check` adds the warnings that need one.

use crate::error::{At, CaseError};
use crate::file::{CaseFile, METHOD, Profile};
use etalon_scene::Shader;
use serde_json::Value;
use std::collections::BTreeSet;

/// The maximum number of cases of a file whose draws are inspected.
const LOOKED_AT: usize = 256;

/// The maximum number of warnings of a file; locating each one searches the whole text.
const MOST: usize = 64;

impl CaseFile {
    /// Returns the first warnings; none of them is an error. They concern axes and derived values that
    /// nothing uses, and draws whose shader reads a parameter that the file does not give.
    pub fn warnings(&self) -> Vec<CaseError> {
        let mut warnings = self.unused();
        warnings.extend(self.missing_params());
        let located = warnings
            .into_iter()
            .map(|warning| warning.locate(self.name(), &self.text));
        let mut seen = BTreeSet::new();
        located
            .filter(|warning| seen.insert(warning.to_string()))
            .take(MOST)
            .collect()
    }

    /// Returns the key of the scene, or of the value that it is made from.
    pub fn scene_key(&self) -> &'static str {
        let wire = &self.wire;
        let made = [
            ("random", &wire.random),
            ("states", &wire.states),
            ("sequence", &wire.sequence),
            ("method", &wire.method),
        ];
        let given = made.into_iter().find(|(_, value)| !value.is_null());
        given.map_or("scene", |(key, _)| key)
    }

    /// Returns a warning at a key of the file; numbers are indices into lists.
    pub fn warning(&self, keys: &[&str], message: impl Into<String>) -> CaseError {
        let steps = keys.iter().rev();
        let place = steps.fold(At::new(message), |place, key| match key.parse() {
            Ok(index) => place.index(index),
            Err(_) => place.key(key),
        });
        place.locate(self.name(), &self.text)
    }

    fn unused(&self) -> Vec<At> {
        let Value::Object(mut file) = self.json() else {
            return Vec::new();
        };
        let mut used = BTreeSet::new();
        for key in ["$schema", "axes", "derived", "about", "spec"] {
            file.remove(key);
        }
        for value in file.values() {
            names(value, &mut used);
        }
        let wire = &self.wire;
        if self.is_method() {
            used.insert(METHOD.to_owned());
        }
        used.extend(wire.parameter.clone());
        let mut found = Vec::new();
        for (name, derived) in &wire.derived {
            if used.contains(name) {
                used.insert(derived.axis.clone());
            } else {
                let message = format!(
                    "nothing uses this value: write \"${name}\" where it belongs, or remove it"
                );
                found.push(At::new(message).key(name).key("derived"));
            }
        }
        for (name, axis) in &wire.axes {
            if !used.contains(name) {
                let message = format!(
                    "nothing uses this axis, so its {} values give the same case: write \"${name}\" where it \
                     belongs, or remove it",
                    axis.len()
                );
                found.push(At::new(message).key(name).key("axes"));
            }
        }
        found
    }

    /// Returns warnings about draws whose shader reads a parameter that is not given and is therefore 0.
    fn missing_params(&self) -> Vec<At> {
        let mut found = Vec::new();
        if self.is_method() || !self.wire.random.is_null() || !self.wire.states.is_null() {
            return found;
        }
        for case in self.cases(Profile::Full).take(LOOKED_AT) {
            let Ok(scene) = case.scene_value(&case.values()) else {
                return found;
            };
            let list = |value: &Value, key: &str| -> Vec<Value> {
                value
                    .get(key)
                    .and_then(Value::as_array)
                    .cloned()
                    .unwrap_or_default()
            };
            for (p, pass) in list(&scene, "passes").iter().enumerate() {
                // Without a written colour, a parameter is visible only if the shader discards by it.
                let colors = !list(pass, "color").is_empty();
                for (d, draw) in list(pass, "draws").iter().enumerate() {
                    let masked = draw.get("write_mask").is_some_and(|mask| mask == "");
                    for (shader, name) in unset(draw) {
                        if !shader.discards() && (!colors || masked) {
                            continue;
                        }
                        let message = format!(
                            "the shader {shader} reads `params.{name}`, which is not given and is therefore 0: give it, even if it is \
                             [0, 0, 0, 0]"
                        );
                        let place = At::new(message);
                        let place = if self.wire.sequence.is_null() {
                            place
                                .index(d)
                                .key("draws")
                                .index(p)
                                .key("passes")
                                .key("scene")
                        } else {
                            place.key("sequence")
                        };
                        found.push(place);
                    }
                }
            }
        }
        found
    }
}

/// Returns the parameters that a draw's shader reads and the draw does not give.
fn unset(draw: &Value) -> Vec<(Shader, &'static str)> {
    let shader: Option<Shader> = draw
        .get("shader")
        .and_then(|s| serde_json::from_value(s.clone()).ok());
    let Some(shader) = shader.filter(|s| s.uses_params()) else {
        return Vec::new();
    };
    let given = |name: &str| draw.get("params").is_some_and(|p| p.get(name).is_some());
    // Tiles give each of their draws a colour.
    let tiles = draw.get("tiles").is_some_and(|t| !t.is_null());
    [
        ("color", "params.color"),
        ("back_color", "params.back_color"),
    ]
    .into_iter()
    .filter(|(name, word)| {
        shader.wgsl().contains(word) && !given(name) && !(tiles && *name == "color")
    })
    .map(|(name, _)| (shader, name))
    .collect()
}

/// Collects the names in `"$name"`.
fn names(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::String(text) => found.extend(text.strip_prefix('$').map(str::to_owned)),
        Value::Array(list) => list.iter().for_each(|v| names(v, found)),
        Value::Object(map) => map.values().for_each(|v| names(v, found)),
        Value::Null | Value::Bool(_) | Value::Number(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Library;

    #[test]
    fn unused_names_and_missing_parameters_are_told_on_their_lines() {
        let text = r#"{ "about": "t", "spec": ["t"],
  "axes": { "used": [1, 2],
    "idle": [1, 2, 3] },
  "derived": {
    "none": { "axis": "used" } },
  "scene": { "attachments": { "c": { "format": "rgba8unorm", "size": ["$used", 4] } },
    "passes": [ { "color": ["c"], "draws": [
      { "mesh": { "kind": "full" }, "shader": "front_facing", "params": { "color": [1, 0, 0, 1] } },
      { "mesh": { "kind": "full" }, "shader": "uniform_color" } ] } ],
    "read": ["c"] } }"#;
        let file = CaseFile::parse("t.json", text).expect("parses");
        let found: Vec<(usize, String)> = file
            .warnings()
            .into_iter()
            .map(|w| (w.line, w.key))
            .collect();
        let expected = [
            (5, "derived.none"),
            (3, "axes.idle"),
            (8, "scene.passes[0].draws[0]"),
            (9, "scene.passes[0].draws[1]"),
        ];
        assert_eq!(found, expected.map(|(line, key)| (line, key.to_owned())));
    }

    #[test]
    fn the_built_in_files_have_no_warnings() {
        let library = Library::built_in();
        let warnings: Vec<String> = library
            .files()
            .flat_map(|f| f.warnings())
            .map(|w| w.to_string())
            .collect();
        assert!(warnings.is_empty(), "{}", warnings.join("\n"));
    }
}
