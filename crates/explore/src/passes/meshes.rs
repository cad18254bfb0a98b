//! Simplifies meshes: replaces many primitives by one, and shortens lists.

use crate::document::{draws_of, parts};
use crate::edit::{Edit, below, value_at};
use serde_json::{Map, Value, json};

/// The mesh kinds with a single primitive, the simplest first.
const WHOLE: [&str; 2] = ["full", "cover"];
/// The maximum number of parts of a mesh that are tried as the whole mesh.
const PARTS: usize = 12;

/// Simplifies the mesh of each draw.
pub(crate) fn meshes(document: &Value, texel: Option<[u32; 2]>) -> Vec<Edit> {
    let mut edits = Vec::new();
    for pointer in draws_of(document) {
        let mesh_pointer = below(&pointer, "mesh");
        let Some(Value::Object(mesh)) = value_at(document, &mesh_pointer) else {
            continue;
        };
        let kind = mesh.get("kind").and_then(Value::as_str).unwrap_or_default();
        let rank = WHOLE.iter().position(|k| *k == kind);
        for simpler in &WHOLE[..rank.unwrap_or(WHOLE.len())] {
            for mesh in wholes(mesh, simpler, texel) {
                edits.push(Edit::replacement(mesh_pointer.clone(), mesh));
            }
        }
        edits.extend(shorter(mesh, &mesh_pointer));
    }
    edits
}

/// Returns the parts of a mesh as whole meshes of a kind, the plain one first.
fn wholes(mesh: &Map<String, Value>, kind: &str, texel: Option<[u32; 2]>) -> Vec<Value> {
    let mut meshes = vec![json!({ "kind": kind })];
    let list = |key: &str| -> Vec<Value> {
        let list = mesh.get(key).and_then(Value::as_array);
        list.cloned().unwrap_or_default()
    };
    let (values, z, windings) = (list("values"), list("z"), list("windings"));
    let part_of = |key: &str, items: &[Value], part: usize| -> Option<Value> {
        let single = mesh.get(key).filter(|v| !v.is_array() || key == "value");
        if items.is_empty() {
            single.cloned()
        } else {
            items.get(part % items.len()).cloned()
        }
    };
    let count = values.len().max(z.len()).max(1);
    // Begins with the part at the wrong texel, approximately.
    let first = texel
        .map_or(0, |[x, _]| x as usize * count / 16)
        .min(count - 1);
    let order = std::iter::once(first).chain((0..count).filter(|i| *i != first));
    for part in order.take(PARTS) {
        let mut replacement = json!({ "kind": kind });
        let keys = [
            ("value", part_of("value", &values, part)),
            ("z", part_of("z", &z, part)),
            ("winding", part_of("winding", &windings, part)),
        ];
        for (key, value) in keys {
            let fits = key != "winding" || kind == "full";
            if let Some(value) = value.filter(|_| fits) {
                replacement[key] = value;
            }
        }
        if !meshes.contains(&replacement) {
            meshes.push(replacement);
        }
    }
    meshes
}

/// Returns edits that shorten a list of the mesh: by a primitive for vertices, and by an item for other
/// lists.
fn shorter(mesh: &Map<String, Value>, pointer: &[crate::edit::EditStep]) -> Vec<Edit> {
    let mut edits = Vec::new();
    for key in ["values", "z", "windings", "uv", "indices"] {
        let length = mesh.get(key).and_then(Value::as_array).map_or(0, Vec::len);
        if !(2..=64).contains(&length) {
            continue;
        }
        for part in parts(length).into_iter().filter(|p| p.len() < length) {
            let pointers = part.map(|i| below(&below(pointer, key), i));
            edits.push(Edit {
                remove: pointers.collect(),
                ..Edit::default()
            });
        }
    }
    let length = |key: &str| mesh.get(key).and_then(Value::as_array).map_or(0, Vec::len);
    let count = length("positions");
    if count > 3 && mesh.get("indices").is_none() {
        for part in parts(count / 3).into_iter().filter(|p| p.len() < count / 3) {
            let vertices = part.start * 3..part.end * 3;
            let mut edit = Edit::default();
            for key in ["positions", "values", "uv"] {
                if length(key) == count {
                    let pointers = vertices.clone().map(|i| below(&below(pointer, key), i));
                    edit.remove.extend(pointers);
                }
            }
            edits.push(edit);
        }
    }
    edits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_becomes_a_full_mesh() {
        let document = json!({ "scene": { "passes": [{ "draws": [{ "mesh": {
            "kind": "columns", "values": [0, [1, 0, 0, 1]], "z": [0.25, 0.5], "windings": ["cw"]
        } }] }] } });
        let edits = meshes(&document, Some([15, 0]));
        let made = |edit: &Edit| {
            edit.apply(&document).unwrap()["scene"]["passes"][0]["draws"][0]["mesh"].clone()
        };
        assert_eq!(made(&edits[0]), json!({ "kind": "full" }));
        let expected = json!({ "kind": "full", "value": [1, 0, 0, 1], "z": 0.5, "winding": "cw" });
        assert_eq!(made(&edits[1]), expected);
    }

    #[test]
    fn vertices_are_removed_by_whole_triangles() {
        let document = json!({ "scene": { "passes": [{ "draws": [{ "mesh": {
            "kind": "vertices", "positions": [0, 1, 2, 3, 4, 5], "values": [0]
        } }] }] } });
        let edits = meshes(&document, None);
        let last = edits.last().unwrap().apply(&document).unwrap();
        let mesh = &last["scene"]["passes"][0]["draws"][0]["mesh"];
        assert_eq!(mesh["positions"], json!([0, 1, 2]));
    }
}
