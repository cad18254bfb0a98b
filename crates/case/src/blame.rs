//! Finds the position in a case file that causes an error of one case.
//!
//! A scene is checked after all values have been substituted, so an error refers to a key of the scene. The
//! axis value is at fault if that key contains `"$name"`, or if the same scene builds with every other value
//! that is tried.

use crate::error::At;
use crate::file::CaseRef;
use crate::place::PathStep;

/// The maximum number of other values of an axis that are tried.
const TRIED: usize = 6;

impl CaseRef<'_> {
    /// Moves an error of this case to the axis value that causes it, if there is one.
    pub(crate) fn blame(&self, at: At) -> At {
        if matches!(at.path.first(), Some(PathStep::Key(key)) if key == "axes" || key == "derived")
        {
            return at;
        }
        let used = at.clone().locate(self.file.name(), &self.file.text).key;
        let moved = self
            .by_placeholder(&at)
            .or_else(|| self.by_other_values().map(|axis| self.own_value(&axis)));
        match moved {
            Some(path) => At {
                path,
                message: match used.as_str() {
                    "" => at.message,
                    used => format!("{} (used at {used})", at.message),
                },
            },
            None => at,
        }
    }

    /// Returns the path of the value behind the `"$name"` that an error's path leads to.
    fn by_placeholder(&self, at: &At) -> Option<Vec<PathStep>> {
        let file = self.file.json();
        let mut value = &file;
        let mut steps = at.path.iter();
        loop {
            if let Some(name) = value.as_str().and_then(|text| text.strip_prefix('$')) {
                let mut path = self.origin(name)?;
                path.extend(steps.cloned());
                return Some(path);
            }
            value = match steps.next()? {
                PathStep::Key(key) => value.get(key)?,
                PathStep::Index(index) => value.get(index)?,
            };
        }
    }

    /// Returns the path of the value that replaces a name in this case.
    fn origin(&self, name: &str) -> Option<Vec<PathStep>> {
        let wire = &self.file.wire;
        if wire.axes.contains_key(name) {
            return Some(self.own_value(name));
        }
        let derived = wire.derived.get(name)?;
        let axis = wire.axes.get(&derived.axis)?;
        let index = derived.index(axis, self.file.positions(self.index)[derived.axis.as_str()]);
        let values = derived.values.as_ref();
        Some(match values.and_then(|values| values.get(axis, index)) {
            Some((_, step)) => {
                let path = ["derived", name, "values"].map(|key| PathStep::Key(key.to_owned()));
                path.into_iter().chain([step]).collect()
            }
            None => self.value_of(&derived.axis, index),
        })
    }

    /// Returns the path of this case's value on an axis.
    fn own_value(&self, axis: &str) -> Vec<PathStep> {
        self.value_of(axis, self.file.positions(self.index)[axis])
    }

    /// Returns the path of a value of an axis: below `value` if it has a name, the whole axis if that is a
    /// range.
    fn value_of(&self, axis: &str, index: usize) -> Vec<PathStep> {
        let mut path = vec![
            PathStep::Key("axes".to_owned()),
            PathStep::Key(axis.to_owned()),
        ];
        if let Some(listed) = self.file.json()["axes"][axis].get(index) {
            path.push(PathStep::Index(index));
            if *listed != self.file.wire.axes[axis][index].value {
                path.push(PathStep::Key("value".to_owned()));
            }
        }
        path
    }

    /// Returns the only axis whose other values all build; `None` if there is not exactly one.
    fn by_other_values(&self) -> Option<String> {
        let lengths: Vec<(&String, usize)> = self
            .file
            .wire
            .axes
            .iter()
            .map(|(name, axis)| (name, axis.len()))
            .collect();
        let positions = self.file.positions(self.index);
        let mut found = None;
        for (axis, length) in &lengths {
            let others = (0..*length).filter(|value| *value != positions[axis.as_str()]);
            let mut tried = 0;
            let always_fails = others.take(TRIED).all(|other| {
                tried += 1;
                let place = |(name, length): &(&String, usize)| {
                    let value = if name == axis {
                        other
                    } else {
                        positions[name.as_str()]
                    };
                    (value, *length)
                };
                let index = lengths
                    .iter()
                    .map(place)
                    .fold(0, |index, (value, length)| index * length + value);
                Self {
                    file: self.file,
                    index,
                }
                .try_build()
                .is_ok()
            });
            if tried > 0 && always_fails && found.replace((*axis).clone()).is_some() {
                return None;
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use crate::{CaseError, CaseFile, Profile};

    const FILE: &str = r#"{ "about": "t", "spec": ["t"],
  "axes": {
    "compare": ["less",
      "lesser"],
    "format": ["rgba8unorm", "depth16unorm"],
    "rect": [{ "name": "all", "value": [0, 0, 4, 4] },
      { "name": "out", "value": [0, 0, 4] }]
  },
  "scene": { "attachments": { "c": { "format": "FORMAT" }, "d": { "format": "depth32float" } },
    "passes": [ { "color": ["c"], "depth_stencil": "d", "draws": [ { "mesh": { "kind": "full" },
      "shader": "uniform_color", "params": { "color": [1, 0, 0, 1] }, "scissor": RECT,
      "depth": { "compare": COMPARE, "write": true } } ] } ],
    "read": ["c"] } }"#;

    fn first_error(format: &str, rect: &str, compare: &str) -> CaseError {
        let text = FILE
            .replace("FORMAT", format)
            .replace("RECT", rect)
            .replace("COMPARE", compare);
        let file = CaseFile::parse("t.json", &text).expect("parses");
        let found = file
            .cases(Profile::Full)
            .find_map(|case| case.build().err());
        found.expect("some case is wrong")
    }

    #[test]
    fn a_wrong_axis_value_is_blamed_on_its_own_line() {
        let error = first_error("rgba8unorm", "null", "\"$compare\"");
        assert_eq!((error.line, error.key.as_str()), (4, "axes.compare[1]"));
        assert_eq!(
            error.message,
            "unknown variant `lesser`, expected one of `never`, `less`, `equal`, `less-equal`, `greater`, \
             `not-equal`, `greater-equal`, `always` (used at scene.passes[0].draws[0].depth.compare)"
        );
        let error = first_error("rgba8unorm", "\"$rect\"", "\"less\"");
        assert_eq!((error.line, error.key.as_str()), (7, "axes.rect[1].value"));
        // The pass refuses the attachment. The error is at the pass's key, but its cause is the format.
        let error = first_error("$format", "null", "\"less\"");
        assert_eq!((error.line, error.key.as_str()), (5, "axes.format[1]"));
        assert_eq!(
            error.message,
            "`c` is not a colour attachment (used at scene.passes[0].color[0])"
        );
    }

    #[test]
    fn an_error_that_no_axis_value_causes_keeps_its_place() {
        let error = first_error("rgba8unorm", "null", "\"smaller\"");
        assert_eq!(error.key, "scene.passes[0].draws[0].depth.compare");
    }
}
