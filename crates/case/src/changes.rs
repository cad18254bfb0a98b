//! Named changes of a file's scene. A case makes several of them.

use crate::error::At;
use crate::file::{CaseFile, CaseRef};
use crate::values::substitute;
use crate::wire::changes::{AND, WITH, names};
use serde_json::Value;
use std::collections::BTreeMap;

impl CaseFile {
    /// Returns the names of the file's changes, in alphabetical order.
    pub(crate) fn changes(&self) -> impl Iterator<Item = &str> {
        self.wire.changes.keys().map(String::as_str)
    }

    /// Returns the name of the case in which these changes meet.
    pub fn name_of_changes(names: &[&str]) -> String {
        names.join(&AND.to_string())
    }

    /// Returns the names of changes of each case, in the order of the axis.
    pub(crate) fn changes_of_cases(&self) -> impl Iterator<Item = Vec<&str>> {
        let is_changed = !self.wire.changes.is_empty();
        let axis = self.wire.axes.get(WITH).filter(|_| is_changed);
        axis.into_iter()
            .flat_map(|axis| axis.iter())
            .map(|value| names(&value.name).collect())
    }
}

impl CaseRef<'_> {
    /// Makes the changes that the case names.
    pub(crate) fn changed(
        &self,
        mut scene: Value,
        values: &BTreeMap<&str, &Value>,
    ) -> Result<Value, At> {
        let wire = &self.file.wire;
        if wire.changes.is_empty() {
            return Ok(scene);
        }
        let value = self.file.positions(self.index)[WITH];
        for name in names(&wire.axes[WITH][value].name) {
            for (pointer, value) in &wire.changes[name] {
                substitute(value, values)
                    .and_then(|value| set(&mut scene, pointer, value))
                    .map_err(|e| e.key(pointer).key(name).key("changes"))?;
            }
        }
        Ok(scene)
    }
}

/// Sets a value at a JSON pointer, whose parent exists: a key of an object, or an item of a list. As in JSON Patch,
/// the last step `-` adds an item to a list.
fn set(scene: &mut Value, pointer: &str, value: Value) -> Result<(), At> {
    let missing = || At::new("the scene has no value above this JSON pointer");
    let (parent, last) = pointer.rsplit_once('/').ok_or_else(missing)?;
    match scene.pointer_mut(parent).ok_or_else(missing)? {
        Value::Object(object) => {
            object.insert(last.to_owned(), value);
        }
        Value::Array(list) => {
            let index = match last {
                "-" => list.len(),
                _ => last.parse().map_err(|_| missing())?,
            };
            match index.cmp(&list.len()) {
                std::cmp::Ordering::Less => list[index] = value,
                std::cmp::Ordering::Equal => list.push(value),
                std::cmp::Ordering::Greater => return Err(missing()),
            }
        }
        _ => return Err(missing()),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::{CaseError, CaseFile, Profile};
    use serde_json::{Value, json};

    fn file(with: &Value, changes: &Value) -> Result<CaseFile, CaseError> {
        let text = json!({
            "about": "a", "spec": [], "axes": { "with": with, "cull": ["none", "back"] }, "changes": changes,
            "scene": {
                "attachments": { "color": { "format": "rgba8unorm" } },
                "passes": [{ "color": ["color"], "draws": [
                    { "mesh": { "kind": "full" }, "shader": "uniform_color", "params": { "color": 1 }, "cull": "$cull",
                      "targets": [] }] }],
                "read": ["color"]
            }
        });
        CaseFile::parse("a/b.json", &text.to_string())
    }

    #[test]
    fn a_case_makes_the_changes_that_it_names() {
        let changes = json!({
            "face": { "/passes/0/draws/0/front_face": "cw" },
            "masked": { "/passes/0/draws/0/targets/0": { "write_mask": "r" } },
            "whole": { "/passes/0/draws/0/targets/0": {} }
        });
        let file = file(&json!(["face+masked", "whole"]), &changes).expect("it is read");
        let cases: Vec<_> = file.cases(Profile::Full).collect();
        assert_eq!(cases[1].id(), "a/b/cull=none/with=whole");
        let expanded = cases[2].expanded().expect("it expands");
        let draw = &expanded["scene"]["passes"][0]["draws"][0];
        assert_eq!(draw["front_face"], "cw");
        assert_eq!(draw["cull"], "back");
        assert_eq!(draw["targets"], json!([{ "write_mask": "r" }]));
        let draw = &cases[2].build().expect("it builds").scene.passes[0].draws[0];
        assert_eq!(draw.targets[0].write_mask, 1);
    }

    #[test]
    fn changes_that_cannot_be_made_are_refused() {
        let change = json!({ "face": { "/passes/0/draws/0/front_face": "cw" } });
        let refused = |with: Value, changes: &Value| {
            let error = file(&with, changes).expect_err("it is refused");
            (error.key, error.message)
        };
        assert_eq!(
            refused(json!(["face+mask"]), &change),
            (
                "axes.with[0]".to_owned(),
                "there is no change `mask`".to_owned()
            )
        );
        let joined = json!({ "a+b": {} });
        assert_eq!(refused(json!(["a"]), &joined).0, "changes.a+b");
        let far = json!({ "far": { "/passes/1/draws": [] } });
        let file = file(&json!(["far"]), &far).expect("it is read");
        let error = file
            .cases(Profile::Full)
            .next()
            .expect("a case")
            .build()
            .expect_err("no pass");
        assert_eq!(
            error.message,
            "the scene has no value above this JSON pointer"
        );
        assert_eq!(error.key, "changes.far./passes/1/draws");
    }
}
