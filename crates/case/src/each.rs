//! List items that unroll to several: `{ "each": { "top": [0, 4] }, "texels": [0, "$top", 16, 16] }`.
//!
//! They are unrolled as soon as a file is read, so all later indices count the unrolled items.

use crate::error::At;
use crate::place::EACH;
use crate::values::{is_word, replace, typed};
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// The maximum number of items that a file's lists can unroll to.
const MAX_ITEMS: usize = 1 << 16;

/// Replaces each list item that has the key `each` by one item per value.
pub(crate) fn unroll(file: &mut Value) -> Result<(), At> {
    let keys = ["axes", "derived"].into_iter();
    let taken = keys.filter_map(|key| file.get(key)?.as_object());
    let mut unrolling = Unrolling {
        taken: taken.flat_map(Map::keys).cloned().collect(),
        items: 0,
    };
    unrolling.value(file)
}

struct Unrolling {
    /// The names of axes, derived values and enclosing items.
    taken: Vec<String>,
    /// The number of unrolled items so far.
    items: usize,
}

impl Unrolling {
    fn value(&mut self, value: &mut Value) -> Result<(), At> {
        match value {
            Value::Array(list) if !list.iter().all(Value::is_number) => self.list(list),
            Value::Object(map) => map
                .iter_mut()
                .try_for_each(|(key, value)| self.value(value).map_err(|e| e.key(key))),
            _ => Ok(()),
        }
    }

    fn list(&mut self, list: &mut Vec<Value>) -> Result<(), At> {
        let mut unrolled = Vec::with_capacity(list.len());
        for mut item in list.drain(..) {
            let outer_names = self.taken.len();
            let each = item.as_object_mut().and_then(|map| map.remove(EACH));
            let items = match each {
                Some(each) => self
                    .items(&item, &each)
                    .map_err(|e| e.index(unrolled.len()))?,
                None => vec![item],
            };
            for mut item in items {
                self.value(&mut item).map_err(|e| e.index(unrolled.len()))?;
                unrolled.push(item);
            }
            self.taken.truncate(outer_names);
        }
        *list = unrolled;
        Ok(())
    }

    /// Returns the items that an item unrolls to.
    fn items(&mut self, item: &Value, each: &Value) -> Result<Vec<Value>, At> {
        let lists: BTreeMap<String, Vec<Value>> = typed(each).map_err(|e| e.key(EACH))?;
        let Some((first, count)) = lists.iter().map(|(name, list)| (name, list.len())).next()
        else {
            return Err(At::new("a list of values is missing").key(EACH));
        };
        for (name, list) in &lists {
            let message = if !is_word(name) {
                "a name consists of letters, digits, '-', '_' and '.'".to_owned()
            } else if self.taken.contains(name) {
                "an axis, a derived value or an enclosing item already has this name".to_owned()
            } else if list.is_empty() {
                "a value is missing".to_owned()
            } else if list.len() != count {
                format!("`{first}` has {count} values, and this has {}", list.len())
            } else {
                continue;
            };
            return Err(At::new(message).key(name).key(EACH));
        }
        self.items += count;
        if self.items > MAX_ITEMS {
            let message = format!("the lists of a file can unroll to at most {MAX_ITEMS} items");
            return Err(At::new(message).key(EACH));
        }
        let mut used = BTreeSet::new();
        let mut items = Vec::with_capacity(count);
        for place in 0..count {
            items.push(replace(item, &mut |name| {
                Ok(match lists.get_key_value(name) {
                    Some((name, list)) => {
                        used.insert(name);
                        list[place].clone()
                    }
                    None => json!(format!("${name}")),
                })
            })?);
        }
        if let Some(name) = lists.keys().find(|name| !used.contains(name)) {
            let message = format!("nothing uses these values: write \"${name}\" where they belong");
            return Err(At::new(message).key(name).key(EACH));
        }
        self.taken.extend(lists.into_keys());
        Ok(items)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CaseError, CaseFile, Profile};

    fn unrolled(mut value: Value) -> Value {
        unroll(&mut value).expect("unrolls");
        value
    }

    /// Returns the error of a file whose pass has these draws, below line 4.
    fn error(draws: &str) -> CaseError {
        let text = format!(
            r#"{{ "about": "t", "spec": ["t"], "axes": {{ "compare": ["less", "greater"] }},
  "derived": {{ "other": {{ "axis": "compare", "shift": 1 }} }},
  "scene": {{ "attachments": {{ "d": {{ "format": "depth32float" }} }}, "passes": [
    {{ "depth_stencil": "d", "draws": [
{draws}
    ] }} ], "read": ["d"] }} }}"#
        );
        let file = match CaseFile::parse("t.json", &text) {
            Ok(file) => file,
            Err(error) => return error,
        };
        let mut cases = file.cases(Profile::Full);
        cases.find_map(|case| case.build().err()).expect("is wrong")
    }

    #[track_caller]
    fn refused(draws: &str, line: usize, key: &str, message: &str) {
        let error = error(draws);
        assert_eq!((error.line, error.key.as_str()), (line, key), "{error}");
        assert_eq!(error.message, message);
    }

    #[test]
    fn an_item_expands_once_per_value_and_its_names_go_in_parallel() {
        let list = json!([
            0,
            { "each": { "top": [0, 4], "clear": [{ "depth": 1 }, null] }, "rect": [0, "$top"], "clear": "$clear", "z": "$axis" },
            { "end": true },
        ]);
        let expected = json!([
            0,
            { "rect": [0, 0], "clear": { "depth": 1 }, "z": "$axis" },
            { "rect": [0, 4], "clear": null, "z": "$axis" },
            { "end": true },
        ]);
        assert_eq!(
            unrolled(json!({ "draws": list })),
            json!({ "draws": expected })
        );
    }

    #[test]
    fn items_nest_and_inner_ones_see_the_values_of_outer_ones() {
        let list = json!([{
            "each": { "color": ["a", "b"], "rows": [[1], [2, 3]] },
            "color": "$color",
            "draws": [{ "each": { "row": "$rows" }, "at": ["$row", "$color"] }],
        }]);
        let expected = json!([
            { "color": "a", "draws": [{ "at": [1, "a"] }] },
            { "color": "b", "draws": [{ "at": [2, "b"] }, { "at": [3, "b"] }] },
        ]);
        assert_eq!(unrolled(list), expected);
    }

    #[test]
    fn an_object_that_is_no_item_keeps_the_key() {
        let quick = json!({ "quick": { "each": 2 } });
        assert_eq!(unrolled(quick.clone()), quick);
    }

    #[test]
    fn wrong_values_are_refused_with_their_place() {
        let place = "scene.passes[0].draws[0].each";
        for (each, key, words) in [
            ("{}", "", "a list of values is missing"),
            (r#"{ "z": [] }"#, ".z", "a value is missing"),
            (
                r#"{ "z": 1 }"#,
                ".z",
                "invalid type: integer `1`, expected a sequence",
            ),
            ("[1]", "", "invalid type: sequence, expected a map"),
            (
                r#"{ "n": [1, 2], "z": [1] }"#,
                ".z",
                "`n` has 2 values, and this has 1",
            ),
            (
                r#"{ "z": [0], "idle": [1] }"#,
                ".idle",
                r#"nothing uses these values: write "$idle" where they belong"#,
            ),
            (
                r#"{ "a b": [1] }"#,
                ".a b",
                "a name consists of letters, digits, '-', '_' and '.'",
            ),
            (
                r#"{ "compare": [1] }"#,
                ".compare",
                "an axis, a derived value or an enclosing item already has this name",
            ),
            (
                r#"{ "other": [1] }"#,
                ".other",
                "an axis, a derived value or an enclosing item already has this name",
            ),
        ] {
            let draw = format!(
                r#"{{ "each": {each}, "mesh": {{ "kind": "full", "z": "$z" }}, "shader": "uniform_color" }}"#
            );
            refused(&draw, 5, &format!("{place}{key}"), words);
        }
        let inner = r#"{ "each": { "z": [0] }, "mesh": { "kind": "full", "z": "$z" }, "shader": "uniform_color" },
            { "each": { "z": [0, 1] }, "mesh": { "kind": "full", "z": "$z" },
              "targets": [{ "each": { "z": ["r"] }, "write_mask": "$z" }], "shader": "uniform_color" }"#;
        let key = "scene.passes[0].draws[1].targets[0].each.z";
        refused(
            inner,
            7,
            key,
            "an axis, a derived value or an enclosing item already has this name",
        );
    }

    #[test]
    fn a_file_cannot_expand_to_any_number_of_items() {
        let hundred: Vec<usize> = (0..100).collect();
        let mut list = json!([{ "each": { "n0": hundred }, "n": "$n0" }]);
        for level in 1..4 {
            let name = format!("n{level}");
            list = json!([{ "each": { &name: hundred }, "n": format!("${name}"), "list": list }]);
        }
        let error = unroll(&mut list).expect_err("is refused");
        let message = "the lists of a file can unroll to at most 65536 items";
        assert_eq!(error.message, message);
    }

    #[test]
    fn errors_of_unrolled_items_lead_to_the_text() {
        let draws = |each: &str, write: &str| {
            format!(
                r#"{{ "each": {{ "own": ["less",
{each}] }},
  "mesh": {{ "kind": "full" }}, "shader": "uniform_color",
  "depth": {{ "compare": "$own",
    "write": {write} }} }},
{{ "mesh": {{ "kind": "full" }}, "shader": "uniform_color",
  "depth": {{ "compare": "lesser", "write": true }} }}"#
            )
        };
        let place = "scene.passes[0].draws[0]";
        let unknown = |name| {
            format!(
                "unknown variant `{name}`, expected one of `never`, `less`, `equal`, `less-equal`, `greater`, \
                 `not-equal`, `greater-equal`, `always`"
            )
        };
        let used = format!("{} (used at {place}.depth.compare)", unknown("lessest"));
        let wrong = draws("\"lessest\"", "true");
        refused(&wrong, 6, &format!("{place}.each.own[1]"), &used);
        let wrong = draws("\"greater\"", "\"yes\"");
        refused(
            &wrong,
            9,
            &format!("{place}.depth.write"),
            r#"invalid type: string "yes", expected a boolean"#,
        );
        // The item after an item that unrolls to two.
        let wrong = draws("\"$other\"", "true");
        refused(
            &wrong,
            11,
            "scene.passes[0].draws[1].depth.compare",
            &unknown("lesser"),
        );
    }

    #[test]
    fn errors_lead_through_nested_items_and_axes() {
        let text = r#"{ "about": "t", "spec": ["t"], "axes": {
  "samples": [{ "each": { "name": ["one", "three"],
      "count": [1,
        3] },
    "name": "$name", "value": "$count" }] },
  "scene": { "attachments": { "a": { "format": "rgba8unorm", "samples": "$samples" } }, "passes": [
    { "each": { "masks": [["r"], ["r",
        "x"]] },
      "color": ["a"], "draws": [
        { "each": { "mask": "$masks" }, "mesh": { "kind": "full" }, "shader": "uniform_color",
          "write_mask": "$mask" } ] } ],
    "read": ["a"] } }"#;
        let refused = |text: &str, line: usize, key: &str| {
            let file = CaseFile::parse("t.json", text).expect("parses");
            let mut cases = file.cases(Profile::Full);
            let error = cases.find_map(|case| case.build().err());
            let error = error.expect("a case is wrong");
            assert_eq!((error.line, error.key.as_str()), (line, key), "{error}");
        };
        refused(text, 8, "scene.passes[0].each.masks[1][1]");
        refused(
            &text.replace("\"x\"", "\"g\""),
            4,
            "axes.samples[0].each.count[1]",
        );
    }
}
