//! Warnings on a case file that builds: names that nothing uses, and parameters that are given or used in vain.
//!
//! They need no judge, so `--cases` can afford them. `etalon check` adds the warnings that need one.

use crate::error::{At, CaseError};
use crate::file::{CaseFile, METHOD, Profile};
use crate::wire::SceneSource;
use crate::wire::changes::WITH;
use etalon_scene::Shader;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The maximum number of cases of a file whose draws are inspected for parameters that are not given.
const LOOKED_AT: usize = 256;

/// The maximum number of cases of a file that are inspected for parameters that no case uses.
const LOOKED_AT_FOR_IGNORED: usize = 4096;

/// The maximum number of warnings of a file; locating each one searches the whole text.
const MOST: usize = 64;

impl CaseFile {
    /// Returns the first warnings; none of them is an error. They concern axes, derived values and counters
    /// that nothing uses, draws whose shader reads a parameter that the file does not give, and parameters
    /// that the shader ignores.
    pub fn warnings(&self) -> Vec<CaseError> {
        let mut warnings = self.unused();
        warnings.extend(self.unnamed_counters());
        warnings.extend(self.missing_params());
        warnings.extend(self.ignored_params());
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
        self.source.key()
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
        if !wire.changes.is_empty() {
            used.insert(WITH.to_owned());
        }
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
        let made: BTreeSet<&str> = self.changes_of_cases().flatten().collect();
        let unmade = self.changes().filter(|name| !made.contains(name));
        found.extend(unmade.map(|name| {
            let message =
                format!("no case makes this change: name it in the axis `{WITH}`, or remove it");
            At::new(message).key(name).key("changes")
        }));
        found
    }

    /// Returns warnings about counters whose name occurs nowhere else in the file, so that no draw can name
    /// them.
    fn unnamed_counters(&self) -> Vec<At> {
        let mut file = self.json();
        let key = self.source.key();
        let counters = file
            .get_mut(key)
            .and_then(|scene| scene.get_mut("counters"));
        let Some(Value::Object(counters)) = counters.map(Value::take) else {
            return Vec::new();
        };
        let unnamed = counters.keys().filter(|name| !has_string(&file, name));
        let warning = |name: &String| {
            let message = format!(
                "no draw names this counter, so no query is made and the record says 0: name it in the \
                 `counters` of the draws that it counts, as [\"{name}\"], or remove it"
            );
            At::new(message).key(name).key("counters").key(key)
        };
        unnamed.map(warning).collect()
    }

    /// Returns true if each draw of the cases is written in the file.
    fn spells_draws_out(&self) -> bool {
        matches!(
            self.source,
            SceneSource::Scene(_) | SceneSource::Sequence(_)
        )
    }

    /// Returns warnings about draws whose shader reads a parameter that is not given and is therefore 0.
    fn missing_params(&self) -> Vec<At> {
        let mut found = Vec::new();
        if !self.spells_draws_out() {
            return found;
        }
        for case in self.cases(Profile::Full).take(LOOKED_AT) {
            let Ok(scene) = case.scene_value(&case.values()) else {
                return found;
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
                        found.push(self.at_draw([p, d], At::new(message)));
                    }
                }
            }
        }
        found
    }

    /// Returns warnings about parameters that are given to a draw whose shader reads them in no case.
    fn ignored_params(&self) -> Vec<At> {
        if !self.spells_draws_out() {
            return Vec::new();
        }
        // The shader that ignores a parameter of a draw; `None` if a shader reads it in some case.
        let mut given: BTreeMap<(&str, [usize; 2]), Option<Shader>> = BTreeMap::new();
        for (index, case) in self.cases(Profile::Full).enumerate() {
            if index >= LOOKED_AT_FOR_IGNORED {
                return Vec::new();
            }
            if index >= LOOKED_AT && given.values().all(Option::is_none) {
                break;
            }
            let Ok(scene) = case.scene_value(&case.values()) else {
                return Vec::new();
            };
            for (p, pass) in list(&scene, "passes").iter().enumerate() {
                for (d, draw) in list(pass, "draws").iter().enumerate() {
                    let Some(shader) = shader_of(draw) else {
                        continue;
                    };
                    for name in PARAMS.into_iter().filter(|name| gives(draw, name)) {
                        let ignored = given.entry((name, [p, d])).or_insert(Some(shader));
                        if reads(shader, name) {
                            *ignored = None;
                        }
                    }
                }
            }
        }
        if given.values().all(Option::is_none) {
            return Vec::new();
        }
        // Several draws can come from one place of the file, and some of their shaders can read the parameter.
        let mut places: BTreeMap<(&str, String), Option<At>> = BTreeMap::new();
        for ((name, draw), ignored) in given {
            let warning = ignored.map(|shader| {
                let message = format!(
                    "the shader {shader} does not read `params.{name}`: remove it, or choose a shader that reads it"
                );
                self.at_draw(draw, At::new(message).key(name).key("params"))
            });
            places
                .entry((name, self.key_of_draw(draw)))
                .and_modify(|known| *known = known.take().filter(|_| warning.is_some()))
                .or_insert(warning);
        }
        places.into_values().flatten().collect()
    }

    /// Returns the key of the item in the file that stands for a draw, given the indices of pass and draw. It
    /// is the key of the whole list if an axis gives that, and of the sequence if there is one.
    pub fn key_of_draw(&self, [pass, draw]: [usize; 2]) -> String {
        let file = self.json();
        let list = format!("/scene/passes/{pass}/draws");
        let at = At::new("");
        let at = if file
            .pointer(&format!("{list}/{draw}"))
            .is_some_and(Value::is_object)
        {
            at.index(draw).key("draws").index(pass).key("passes")
        } else if file.pointer(&list).is_some() {
            at.key("draws").index(pass).key("passes")
        } else {
            at.key("passes")
        };
        match self.scene_key() {
            "scene" => at.key("scene").locate(self.name(), &self.text).key,
            other => other.to_owned(),
        }
    }

    /// Moves a place in a draw to the draw's place in the file, given the indices of pass and draw.
    fn at_draw(&self, [pass, draw]: [usize; 2], at: At) -> At {
        if !matches!(self.source, SceneSource::Sequence(_)) {
            let at = at.index(draw).key("draws").index(pass);
            at.key("passes").key("scene")
        } else {
            At::new(at.message).key("sequence")
        }
    }
}

/// The parameters of shaders.
const PARAMS: [&str; 2] = ["color", "back_color"];

/// Returns the items of a list in an object; none if there is no such list.
fn list(value: &Value, key: &str) -> Vec<Value> {
    let list = value.get(key).and_then(Value::as_array);
    list.cloned().unwrap_or_default()
}

/// Returns true if a text occurs as a string in a value; keys do not count.
fn has_string(value: &Value, text: &str) -> bool {
    match value {
        Value::String(string) => string == text,
        Value::Array(list) => list.iter().any(|v| has_string(v, text)),
        Value::Object(map) => map.values().any(|v| has_string(v, text)),
        Value::Null | Value::Bool(_) | Value::Number(_) => false,
    }
}

fn shader_of(draw: &Value) -> Option<Shader> {
    let shader = draw.get("shader")?;
    serde_json::from_value(shader.clone()).ok()
}

/// Returns true if a draw gives a parameter.
fn gives(draw: &Value, name: &str) -> bool {
    draw.get("params").is_some_and(|p| p.get(name).is_some())
}

/// Returns true if a shader reads a parameter.
fn reads(shader: Shader, name: &str) -> bool {
    let member = match name {
        "color" => "params.color",
        _ => "params.back_color",
    };
    shader.uses_params() && shader.wgsl().contains(member)
}

/// Returns the parameters that a draw's shader reads and the draw does not give.
fn unset(draw: &Value) -> Vec<(Shader, &'static str)> {
    let Some(shader) = shader_of(draw) else {
        return Vec::new();
    };
    // Tiles give each of their draws a colour.
    let tiles = draw.get("tiles").is_some_and(|t| !t.is_null());
    PARAMS
        .into_iter()
        .filter(|name| reads(shader, name) && !gives(draw, name) && !(tiles && *name == "color"))
        .map(|name| (shader, name))
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
    fn unused_names_and_missing_parameters_give_warnings_on_their_lines() {
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

    /// Returns line, key and message of the warnings on a file with this scene, from line 2 on.
    fn warnings(axes: &str, scene: &str) -> Vec<(usize, String, String)> {
        let text =
            format!("{{ \"about\": \"t\", \"spec\": [\"t\"], \"axes\": {{ {axes} }},\n{scene} }}");
        let file = CaseFile::parse("t.json", &text).expect("parses");
        for case in file.cases(Profile::Full) {
            case.build().expect("builds");
        }
        let warnings = file.warnings().into_iter();
        warnings.map(|w| (w.line, w.key, w.message)).collect()
    }

    fn places(warnings: &[(usize, String, String)]) -> Vec<(usize, &str)> {
        let places = warnings.iter();
        places.map(|(line, key, _)| (*line, key.as_str())).collect()
    }

    #[test]
    fn a_counter_that_no_draw_names_gives_a_warning() {
        let scene = |counters: &str| {
            format!(
                r#""scene": {{ "attachments": {{ "c": {{ "format": "rgba8unorm" }} }},
  "passes": [ {{ "color": ["c"], "draws": [ {{ "mesh": {{ "kind": "full" }}, "shader": "flat_color",
    "counters": {counters} }} ] }} ], "read": ["c"],
  "counters": {{ "passed": "samples-passed",
    "runs": "fragment-invocations" }} }}"#
            )
        };
        let one = warnings("", &scene(r#"["passed"]"#));
        assert_eq!(places(&one), [(6, "scene.counters.runs")]);
        assert!(one[0].2.contains("[\"runs\"]"), "{one:?}");
        assert_eq!(warnings("", &scene(r#"["passed", "runs"]"#)), []);
        let axis = r#""which": [{ "name": "a", "value": ["passed"] }, { "name": "b", "value": ["runs"] }]"#;
        assert_eq!(warnings(axis, &scene(r#""$which""#)), []);
    }

    #[test]
    fn a_parameter_that_the_shader_ignores_gives_a_warning() {
        let drawn = |draws: &str| {
            format!(
                r#""scene": {{ "attachments": {{ "c": {{ "format": "rgba8unorm" }} }}, "passes": [ {{ "color": ["c"],
  "draws": {draws} }} ], "read": ["c"] }}"#
            )
        };
        let scene = |draw: &str| {
            drawn(&format!(
                r#"[ {{ "mesh": {{ "kind": "full" }}, "shader": "flat_color" }},
    {draw} ]"#
            ))
        };
        let ignored = r#"{ "mesh": { "kind": "full" }, "shader": "uniform_color",
      "params": { "color": [1, 0, 0, 1],
        "back_color": [0, 1, 0, 1] } }"#;
        let one = warnings("", &scene(ignored));
        let place = (6, "scene.passes[0].draws[1].params.back_color");
        assert_eq!(places(&one), [place]);
        assert!(one[0].2.contains("uniform_color"), "{one:?}");
        // A shader on an axis, and items that come from one place, count together.
        let some = r#""shader": ["uniform_color", "front_facing"]"#;
        let axis = ignored.replace("\"uniform_color\"", "\"$shader\"");
        assert_eq!(warnings(some, &scene(&axis)), []);
        let each = axis.replacen('{', &format!("{{ \"each\": {{ {some} }},"), 1);
        assert_eq!(warnings("", &scene(&each)), []);
        let list = |draw: &str| format!(r#""list": [{{ "name": "a", "value": [{draw}] }}]"#);
        assert_eq!(warnings(&list(&each), &drawn("\"$list\"")), []);
        assert_eq!(warnings(&list(ignored), &drawn("\"$list\"")).len(), 1);
        let none = r#""shader": ["uniform_color", "flat_color_depth"]"#;
        assert_eq!(places(&warnings(none, &scene(&axis))), [place]);
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
