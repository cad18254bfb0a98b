//! Reduces sizes: crops pictures, preferably to the wrong texel, and removes samples.

use crate::document::{draws_of, list};
use crate::edit::{Edit, Pointer, below, pointer, value_at};
use serde_json::{Value, json};

/// The size of attachments without `size`.
const DEFAULT: [u64; 2] = [16, 16];

/// The sides that are tried.
const SIDES: [u64; 6] = [1, 2, 4, 8, 16, 64];

/// Crops all attachments of a size together.
pub(crate) fn sizes(document: &Value, texel: Option<[u32; 2]>) -> Vec<Edit> {
    let Some(attachments) = document["scene"]["attachments"].as_object() else {
        return Vec::new();
    };
    let given = |a: &Value| -> Option<[u64; 2]> {
        let size = a.get("size")?.as_array()?;
        Some([size.first()?.as_u64()?, size.get(1)?.as_u64()?])
    };
    let default = attachments.values().find_map(given).unwrap_or(DEFAULT);
    let size = |a: &Value| given(a).unwrap_or(default);
    let mut all_sizes: Vec<[u64; 2]> = attachments.values().map(size).collect();
    all_sizes.sort_unstable();
    all_sizes.dedup();
    let mut edits = Vec::new();
    for from in all_sizes.into_iter().rev() {
        for side in SIDES {
            let to = from.map(|s| s.min(side));
            if to == from {
                continue;
            }
            let at_texel = texel.map(|t| [0, 1].map(|i| u64::from(t[i]).min(from[i] - to[i])));
            let mut origins: Vec<[u64; 2]> = at_texel.into_iter().collect();
            if !origins.contains(&[0, 0]) {
                origins.push([0, 0]);
            }
            for origin in origins {
                let window = Window { origin, size: to };
                let mut edit = Edit::default();
                for (name, attachment) in attachments {
                    if size(attachment) == from {
                        let pointer = pointer!["scene", "attachments", name.as_str()];
                        edit.replace.push((below(&pointer, "size"), json!(to)));
                        window.crop_texels(attachment, &pointer, &mut edit);
                    }
                }
                window.crop_rectangles(document, &mut edit);
                edits.push(edit);
            }
        }
    }
    edits
}

/// A part of a picture.
#[derive(Clone, Copy)]
struct Window {
    origin: [u64; 2],
    size: [u64; 2],
}

impl Window {
    fn crop_texels(
        self,
        attachment: &Value,
        attachment_pointer: &[crate::edit::EditStep],
        edit: &mut Edit,
    ) {
        let texels = &attachment["texels"];
        let Some(values) = texels["values"].as_array() else {
            return;
        };
        let cut = |list: &[Value], axis: usize| -> Vec<Value> {
            let skipped = list.iter().skip(self.origin[axis] as usize);
            skipped.take(self.size[axis] as usize).cloned().collect()
        };
        let values = match texels["kind"].as_str() {
            Some("columns") => cut(values, 0),
            Some("rows") => cut(values, 1),
            Some("grid") => cut(values, 1)
                .iter()
                .map(|row| json!(cut(row.as_array().map_or(&[], |r| r), 0)))
                .collect(),
            _ => return,
        };
        let pointer = below(&below(attachment_pointer, "texels"), "values");
        edit.replace.push((pointer, json!(values)));
    }

    /// Moves rectangles with the picture, and clips them to it.
    fn crop_rectangles(self, document: &Value, edit: &mut Edit) {
        for draw in draws_of(document) {
            self.crop(document, below(&draw, "scissor"), edit);
            let full_viewport = value_at(document, &below(&draw, "viewport")).is_none();
            let mesh = below(&draw, "mesh");
            let texels = below(&mesh, "texels");
            if let Some(corners) = value_at(document, &texels)
                .and_then(numbers)
                .filter(|_| full_viewport)
            {
                let [l, t] = [0, 1].map(|i| self.moved(corners[i], i));
                let [r, b] = [0, 1].map(|i| self.moved(corners[i + 2], i));
                edit.replace.push((texels, json!([l, t, r, b])));
            }
            // Viewports can extend beyond the picture but, on some drivers, not before its start, so they
            // are cropped too.
            let rect = below(&below(&draw, "viewport"), "rect");
            self.crop(document, rect, edit);
        }
        let passes = list(&document["scene"], "passes").iter().enumerate();
        for (p, pass) in passes {
            for c in 0..list(pass, "clears").len() {
                let pointer = pointer!["scene", "passes", p, "clears", c, "rect"];
                self.crop(document, pointer, edit);
            }
        }
        self.crop(document, pointer!["relation", "within"], edit);
    }

    /// Crops a rectangle of left, top, width and height.
    fn crop(self, document: &Value, pointer: Pointer, edit: &mut Edit) {
        let Some([x, y, w, h]) = value_at(document, &pointer).and_then(numbers) else {
            return;
        };
        let [l, t] = [self.moved(x, 0), self.moved(y, 1)];
        let [r, b] = [self.moved(x + w, 0), self.moved(y + h, 1)];
        edit.replace.push((pointer, json!([l, t, r - l, b - t])));
    }

    /// Returns a coordinate, relative to the window.
    fn moved(self, value: u64, axis: usize) -> u64 {
        let moved = value.saturating_sub(self.origin[axis]);
        moved.min(self.size[axis])
    }
}

/// Returns four non-negative integers.
fn numbers(value: &Value) -> Option<[u64; 4]> {
    let list = value.as_array()?.iter();
    let as_integer = |v: &Value| v.as_f64().filter(|v| *v >= 0.0 && v.fract() == 0.0);
    let sizes: Vec<u64> = list
        .map(|v| as_integer(v).map(|v| v as u64))
        .collect::<Option<_>>()?;
    sizes.try_into().ok()
}

/// Reduces the samples of all attachments with the most samples. With a single sample left, attachments are
/// read without a resolve.
pub(crate) fn samples(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let Some(attachments) = document["scene"]["attachments"].as_object() else {
        return Vec::new();
    };
    let samples_of = |a: &Value| a["samples"].as_u64().unwrap_or(1);
    let most = attachments.values().map(samples_of).max().unwrap_or(1);
    let mut edits = Vec::new();
    for to in [1, 2, 4, 8].into_iter().filter(|to| *to < most) {
        let mut edit = Edit::default();
        for (name, attachment) in attachments {
            if samples_of(attachment) == most {
                let pointer = pointer!["scene", "attachments", name.as_str(), "samples"];
                match to {
                    1 => edit.remove.push(pointer),
                    _ => edit.replace.push((pointer, json!(to))),
                }
            }
        }
        if to == 1 {
            for draw in draws_of(document) {
                let pointer = below(&draw, "multisample");
                if value_at(document, &pointer).is_some() {
                    edit.remove.push(pointer);
                }
            }
            let mut unresolved = edit.clone();
            let mut read = list(&document["scene"], "read").to_vec();
            let passes = list(&document["scene"], "passes").iter().enumerate();
            for (p, pass) in passes {
                if pass.get("resolve").is_some() {
                    let pointer = pointer!["scene", "passes", p, "resolve"];
                    unresolved.remove.push(pointer);
                }
                let pairs = list(pass, "color").iter().zip(list(pass, "resolve"));
                for (from, resolved) in pairs {
                    for name in read.iter_mut().filter(|name| *name == resolved) {
                        *name = from.clone();
                    }
                }
            }
            unresolved
                .replace
                .push((pointer!["scene", "read"], json!(read)));
            edits.push(edit);
            edits.push(unresolved);
        } else {
            edits.push(edit);
        }
    }
    edits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_cropped_to_the_wrong_texel() {
        let document = json!({ "scene": {
            "attachments": {
                "c": { "size": [4, 4] },
                "t": { "texels": { "kind": "columns", "values": [0, 1, 2, 3] } }
            },
            "passes": [{ "draws": [{ "scissor": [1, 0, 3, 2], "mesh": { "texels": [0, 0, 3, 3] } }] }]
        } });
        let first = sizes(&document, Some([2, 1]))[0].apply(&document).unwrap();
        let expected = json!({ "scene": {
            "attachments": {
                "c": { "size": [1, 1] },
                "t": { "size": [1, 1], "texels": { "kind": "columns", "values": [2] } }
            },
            "passes": [{ "draws": [{ "scissor": [0, 0, 1, 1], "mesh": { "texels": [0, 0, 1, 1] } }] }]
        } });
        assert_eq!(first, expected);
    }

    #[test]
    fn without_samples_nothing_is_resolved() {
        let document = json!({ "scene": {
            "attachments": { "m": { "samples": 4 }, "r": {} },
            "passes": [{ "color": ["m"], "resolve": ["r"], "draws": [{ "multisample": {} }] }],
            "read": ["r"]
        } });
        let edits = samples(&document, None);
        let unresolved = edits[1].apply(&document).unwrap();
        let expected = json!({ "scene": {
            "attachments": { "m": {}, "r": {} },
            "passes": [{ "color": ["m"], "draws": [{}] }],
            "read": ["m"]
        } });
        assert_eq!(unresolved, expected);
        let two = edits[2].apply(&document).unwrap();
        assert_eq!(two["scene"]["attachments"]["m"]["samples"], 2);
    }
}
