//! Case files, and the cases that the product of their axes gives.

use crate::each::unroll;
use crate::error::{At, CaseError};
use crate::json::parse_json;
use crate::pairwise::{self, Cover};
use crate::values::{is_word, typed};
use crate::wire::{self, AxisValue, FileWire, QuickWire, SceneSource};
use etalon_frame::without_mark;
use etalon_methods::Model;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::sync::Arc;

/// The maximum number of cases of a file.
const MAX_CASES: usize = 1 << 20;

/// The name of the axis of methods.
pub(crate) const METHOD: &str = "method";

/// The part of each file's product of axes that is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Profile {
    /// The candidates, without the redundant ones that `redundant.txt` lists.
    #[default]
    Quick,
    /// The part that the file's `quick` selects. `"pairwise"`: enough cases that every two values of every
    /// two axes occur together. `{ "each": 2 }`: enough that every value occurs in two cases. `{ "where": …
    /// }`: the cases with these values. `{ "any": [ … ] }`: the cases with the values of any row. Without
    /// `quick`, everything. Files of methods keep all methods, at some values of the other axes.
    Candidates,
    /// The whole product.
    Full,
}

/// A parsed case file.
#[derive(Clone, Debug)]
pub struct CaseFile {
    name: String,
    pub(crate) stem: String,
    pub(crate) text: String,
    pub(crate) wire: FileWire,
    pub(crate) source: SceneSource,
    /// The scene of one's own that the methods draw, in place of one that the file names.
    pub(crate) model: Option<Arc<Model>>,
    /// The ids of candidates that the quick profile leaves out.
    pub(crate) redundant: BTreeSet<String>,
    count: usize,
}

/// A case of a file, by its index in the product of the axes.
#[derive(Clone, Copy, Debug)]
pub struct CaseRef<'a> {
    pub(crate) file: &'a CaseFile,
    pub(crate) index: usize,
}

impl CaseFile {
    /// Parses a case file. `name` is the path below the cases folder, with `.json`.
    /// One check after the other, each with its place.
    ///
    /// # Errors
    /// With file, line and key, if the text is not JSON, a key is unknown or an axis is unusable. Scenes are
    /// checked by [`CaseRef::build`].
    pub fn parse(name: &str, text: &str) -> Result<Self, CaseError> {
        let text = without_mark(text);
        let fail = |at: At| at.locate(name, text);
        let mut value: Value = parse_json(text).map_err(|e| CaseError {
            file: name.to_owned(),
            line: e.line(),
            key: String::new(),
            message: format!("not valid JSON: {e}"),
        })?;
        unroll(&mut value).map_err(fail)?;
        let mut wire: FileWire = typed(&value).map_err(fail)?;
        let stem = name.strip_suffix(".json").unwrap_or(name).to_owned();
        if !stem.split('/').all(is_word) {
            return Err(fail(At::new(
                "the file's path becomes part of ids: letters, digits, '-', '_' and '.' only",
            )));
        }
        let mut count = 1_usize;
        for (axis, values) in &wire.axes {
            let values: &[AxisValue] = values;
            let bad = |message: &str| fail(At::new(message).key(axis).key("axes"));
            if !is_word(axis) {
                return Err(bad(
                    "an axis's name consists of letters, digits, '-', '_' and '.'",
                ));
            }
            if values.is_empty() {
                return Err(bad("an axis needs a value"));
            }
            let mut names = HashSet::new();
            for (i, value) in values.iter().enumerate() {
                let bad = |message: String| fail(At::new(message).index(i).key(axis).key("axes"));
                if !is_word(&value.name) {
                    return Err(bad(format!(
                        "`{}` would be part of ids, which allow only letters, digits, '-', '_', '+' and '.'; give it a name",
                        value.name
                    )));
                }
                if !names.insert(value.name.as_str()) {
                    return Err(bad(format!("the name `{}` occurs twice", value.name)));
                }
            }
            count = count
                .checked_mul(values.len())
                .filter(|n| *n <= MAX_CASES)
                .ok_or_else(|| bad("the product of the axes is too large"))?;
        }
        for (name, derived) in &wire.derived {
            if wire.axes.contains_key(name) {
                return Err(fail(
                    At::new("an axis already has this name")
                        .key(name)
                        .key("derived"),
                ));
            }
            let Some(axis) = wire.axes.get(&derived.axis) else {
                return Err(fail(
                    At::new(format!("there is no axis `{}`", derived.axis))
                        .key("axis")
                        .key(name)
                        .key("derived"),
                ));
            };
            let values = derived.values.as_ref();
            if let Some(mismatch) = values.and_then(|values| values.mismatch(&derived.axis, axis)) {
                return Err(fail(
                    At::new(mismatch).key("values").key(name).key("derived"),
                ));
            }
        }
        wire::changes::check(&wire).map_err(fail)?;
        let unknown = |chosen: &BTreeMap<String, String>| -> Option<At> {
            chosen.iter().find_map(|(axis, name)| {
                let values = wire.axes.get(axis).map_or(&[][..], |axis| axis);
                let known = values.iter().any(|v| v.name == *name);
                let message = format!("no axis `{axis}` has a value `{name}`");
                (!known).then(|| At::new(message).key(axis))
            })
        };
        let wrong = match &wire.quick {
            Some(QuickWire::Where(chosen)) => unknown(chosen).map(|error| error.key("where")),
            Some(QuickWire::Any(rows)) => {
                let mut rows = rows.iter().enumerate();
                rows.find_map(|(i, chosen)| Some(unknown(chosen)?.index(i).key("any")))
            }
            _ => None,
        };
        if let Some(error) = wrong {
            return Err(fail(error.key("quick")));
        }
        let source = wire.take_source().map_err(fail)?;
        if matches!(source, SceneSource::Method(_))
            && let Some(quick) = &wire.quick
            && !quick.takes_all_of(METHOD)
        {
            let message = "methods are compared at the same parameters, so the quick profile must take all of them: \
                           `{ \"where\": … }` or `{ \"any\": [ … ] }`, without `method`";
            return Err(fail(At::new(message).key("quick")));
        }
        Ok(Self {
            name: name.to_owned(),
            stem,
            text: text.to_owned(),
            wire,
            source,
            model: None,
            redundant: BTreeSet::new(),
            count,
        })
    }

    /// Returns the cases of a scene of one's own: a question that it can answer, by these methods. Their ids are
    /// `methods/<question>/gltf=<name>/method=<method>`.
    ///
    /// # Errors
    /// If the name is no part of an id.
    pub(crate) fn of_model(
        (question, methods): (&str, &[&str]),
        name: &str,
        model: Arc<Model>,
    ) -> Result<Self, CaseError> {
        let text = json!({
            "about": "A scene of one's own.",
            "spec": [],
            "axes": { METHOD: methods },
            "method": {},
        });
        let file = Self::parse(
            &format!("methods/{question}/{name}.json"),
            &text.to_string(),
        )?;
        Ok(Self {
            stem: format!("methods/{question}/gltf={name}"),
            model: Some(model),
            ..file
        })
    }

    /// Returns the file as JSON with its lists unrolled.
    pub(crate) fn json(&self) -> Value {
        let mut file = parse_json(&self.text).unwrap_or_default();
        // Parsing the file has already shown that the lists can be unrolled.
        let _unrolled = unroll(&mut file);
        file
    }

    /// Returns true if its scenes are random.
    pub fn is_random(&self) -> bool {
        matches!(self.source, SceneSource::Random(_))
    }

    /// Returns true if the quick profile takes a covering array of every two axes.
    pub fn is_covering(&self) -> bool {
        self.wire.quick == Some(QuickWire::Pairwise)
    }

    /// Returns true if the cases draw by methods.
    pub(crate) fn is_method(&self) -> bool {
        matches!(self.source, SceneSource::Method(_))
    }

    /// Returns true if the cases exist to be measured: methods, and everything in the area `perf`.
    pub fn is_measured(&self) -> bool {
        self.is_method() || self.name.starts_with("perf/")
    }

    /// Returns the file's path below the cases folder.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the file's path without its ending, with which the ids of its cases begin.
    pub fn stem(&self) -> &str {
        &self.stem
    }

    /// Returns the cases of a profile; the last axis (in alphabetical order) varies fastest.
    pub fn cases(&self, profile: Profile) -> impl Iterator<Item = CaseRef<'_>> {
        let indices = match profile {
            Profile::Full => (0..self.count).collect(),
            Profile::Quick | Profile::Candidates => self.candidates(),
        };
        let case = move |index| CaseRef { file: self, index };
        let leaves_out = profile == Profile::Quick && !self.redundant.is_empty();
        let is_kept = move |case: &CaseRef| !leaves_out || !self.redundant.contains(&case.id());
        indices.into_iter().map(case).filter(is_kept)
    }

    /// Returns the indices of the cases that `quick` selects, in ascending order.
    fn candidates(&self) -> Vec<usize> {
        let all = 0..self.count;
        let mut indices: Vec<usize> = match &self.wire.quick {
            None => all.collect(),
            Some(QuickWire::Pairwise) => self.covering(Cover::Pairs),
            Some(QuickWire::Each(n)) => self.covering(Cover::AtLeast(n.get())),
            Some(QuickWire::First(n)) => all.take(n.get()).collect(),
            Some(QuickWire::Where(chosen)) => all.filter(|i| self.has(*i, chosen)).collect(),
            Some(QuickWire::Any(rows)) => all
                .filter(|i| rows.iter().any(|chosen| self.has(*i, chosen)))
                .collect(),
        };
        indices.sort_unstable();
        indices
    }

    /// Returns true if the case at an index of the product has these values.
    fn has(&self, index: usize, chosen: &BTreeMap<String, String>) -> bool {
        let positions = self.positions(index);
        chosen
            .iter()
            .all(|(axis, name)| self.wire.axes[axis][positions[axis.as_str()]].name == *name)
    }

    /// Returns the indices in the product of a covering array's rows, in the order in which they cover most.
    fn covering(&self, cover: Cover) -> Vec<usize> {
        let lengths: Vec<usize> = self.wire.axes.values().map(|axis| axis.len()).collect();
        let index = |row: &Vec<usize>| {
            let axes = row.iter().zip(&lengths);
            axes.fold(0, |index, (value, length)| index * length + value)
        };
        pairwise::rows(&lengths, cover).iter().map(index).collect()
    }

    pub(crate) fn positions(&self, mut index: usize) -> BTreeMap<&str, usize> {
        let mut positions = BTreeMap::new();
        for (axis, values) in self.wire.axes.iter().rev() {
            positions.insert(axis.as_str(), index % values.len());
            index /= values.len();
        }
        positions
    }
}

impl CaseRef<'_> {
    /// Returns true if the case exists to be measured.
    pub fn is_measured(&self) -> bool {
        self.file.is_measured()
    }

    /// Returns the stable id: the file's path and each axis with its value, in alphabetical order, except
    /// that the method of a method case comes first.
    pub fn id(&self) -> String {
        let mut id = self.file.stem.clone();
        let mut axes: Vec<(&str, usize)> = self.file.positions(self.index).into_iter().collect();
        if self.file.is_method() {
            axes.sort_by_key(|(axis, _)| *axis != METHOD);
        }
        for (axis, value) in axes {
            id.push('/');
            id.push_str(axis);
            id.push('=');
            id.push_str(&self.file.wire.axes[axis][value].name);
        }
        id
    }

    /// Returns the value of each axis and derived value.
    pub(crate) fn values(&self) -> BTreeMap<&str, &Value> {
        let wire = &self.file.wire;
        let positions = self.file.positions(self.index);
        let mut values: BTreeMap<&str, &Value> = positions
            .iter()
            .map(|(axis, value)| (*axis, &wire.axes[*axis][*value].value))
            .collect();
        for (name, derived) in &wire.derived {
            let list = &wire.axes[&derived.axis];
            let index = derived.index(list, positions[derived.axis.as_str()]);
            let given = derived
                .values
                .as_ref()
                .and_then(|values| values.get(list, index));
            values.insert(name, given.map_or(&list[index].value, |(value, _)| value));
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_one_source_of_scenes() {
        let parsed = |sources: &str| {
            let text = format!(r#"{{ "about": "a", "spec": []{sources} }}"#);
            CaseFile::parse("a/b.json", &text).map(|file| file.source.key())
        };
        let refused = |sources| parsed(sources).expect_err("it is refused").message;
        assert_eq!(parsed(r#", "states": {}"#).ok(), Some("states"));
        assert_eq!(
            parsed(r#", "scene": {}, "random": null"#).ok(),
            Some("scene")
        );
        assert_eq!(refused(""), "a case file needs a scene");
        let both = r#", "random": {}, "scene": {}"#;
        assert_eq!(refused(both), "`random` excludes `scene`");
    }
}
