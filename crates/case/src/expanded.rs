//! A case's scene as JSON with all values substituted; and a file's scene before that, with the values.

use crate::error::CaseError;
use crate::file::{CaseFile, CaseRef};
use crate::values::substitute;
use serde_json::{Map, Value, json};

impl CaseRef<'_> {
    /// Returns the file.
    pub fn file(&self) -> &CaseFile {
        self.file
    }

    /// Returns the scene of the case, or the value that it is made from, as JSON under its key.
    ///
    /// # Errors
    /// If a name has no value.
    pub fn expanded(&self) -> Result<Value, CaseError> {
        let key = self.file.scene_key();
        let values = self.values();
        let value = substitute(self.file.source.value(), &values)
            .map_err(|error| error.key(key))
            .and_then(|value| self.changed(value, &values))
            .map_err(|error| error.locate(self.file.name(), &self.file.text))?;
        Ok(json!({ key: value }))
    }
}

impl CaseFile {
    /// Returns what the cases have in common: `about`, `spec`, the key of the scene, the scene with `"$name"`
    /// for values, each axis as pairs of name and value, the derived values, and the changes.
    pub fn template(&self) -> Value {
        let wire = &self.wire;
        let axes: Map<String, Value> = wire
            .axes
            .iter()
            .map(|(axis, values)| {
                let pairs: Vec<Value> = values.iter().map(|v| json!([v.name, v.value])).collect();
                (axis.clone(), Value::Array(pairs))
            })
            .collect();
        let derived: Map<String, Value> = wire
            .derived
            .iter()
            .map(|(name, d)| {
                let axis = &wire.axes[&d.axis];
                let listed = d.values.as_ref().map(|values| {
                    let each = (0..axis.len()).filter_map(|number| values.get(axis, number));
                    each.map(|(value, _)| value).collect::<Vec<_>>()
                });
                (name.clone(), json!([d.axis, d.shift, listed]))
            })
            .collect();
        json!({
            "about": wire.about,
            "spec": wire.spec,
            "key": self.scene_key(),
            "scene": self.source.value(),
            "axes": axes,
            "derived": derived,
            "changes": wire.changes,
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::{Library, Profile};

    #[test]
    fn an_expanded_scene_names_no_axis() {
        let library = Library::built_in();
        for file in library.files() {
            for case in file.cases(Profile::Full).take(3) {
                let text = case.expanded().expect("expands").to_string();
                assert!(!text.contains("\"$"), "{}: {text}", case.id());
            }
        }
    }
}
