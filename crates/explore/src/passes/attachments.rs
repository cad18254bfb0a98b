//! Removes attachments: from passes, from read-back, or entirely if they are unused.

use crate::document::{list, parts};
use crate::edit::{Edit, below, pointer};
use serde_json::{Value, json};

/// Removes each attachment of a pass, with all keys that refer to it.
pub(crate) fn bound(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (p, pass) in list(&document["scene"], "passes").iter().enumerate() {
        let pointer = pointer!["scene", "passes", p];
        if pass.get("depth_stencil").is_some() {
            edits.push(without_depth_stencil(pass, &pointer));
        }
        if pass.get("depth_stencil_resolve").is_some() {
            edits.push(Edit::removal(below(&pointer, "depth_stencil_resolve")));
        }
        for location in (0..list(pass, "color").len()).rev() {
            edits.push(without_color(pass, &pointer, location));
        }
    }
    edits
}

fn without_depth_stencil(pass: &Value, pointer: &[crate::edit::EditStep]) -> Edit {
    let mut edit = Edit::default();
    let keys = [
        "depth_stencil",
        "depth_stencil_read_only",
        "depth_stencil_resolve",
    ];
    for key in keys {
        if pass.get(key).is_some() {
            edit.remove.push(below(pointer, key));
        }
    }
    for key in ["depth", "stencil"] {
        if pass["operations"].get(key).is_some() {
            edit.remove.push(below(&below(pointer, "operations"), key));
        }
    }
    for (c, clear) in list(pass, "clears").iter().enumerate() {
        if clear.get("color").is_none() {
            edit.remove.push(below(&below(pointer, "clears"), c));
        }
    }
    for (d, draw) in list(pass, "draws").iter().enumerate() {
        for key in ["depth", "stencil", "depth_bounds"] {
            if draw.get(key).is_some() {
                edit.remove
                    .push(below(&below(&below(pointer, "draws"), d), key));
            }
        }
    }
    edit
}

fn without_color(pass: &Value, pointer: &[crate::edit::EditStep], location: usize) -> Edit {
    let mut edit = Edit::removal(below(&below(pointer, "color"), location));
    for (part, members) in [
        (below(pointer, "resolve"), list(pass, "resolve")),
        (
            below(&below(pointer, "operations"), "color"),
            list(&pass["operations"], "color"),
        ),
    ] {
        if members.len() > location {
            edit.remove.push(below(&part, location));
        }
    }
    for (c, clear) in list(pass, "clears").iter().enumerate() {
        let part = below(&below(pointer, "clears"), c);
        match clear.get("color").and_then(Value::as_u64) {
            Some(number) if number == location as u64 => edit.remove.push(part),
            Some(number) if number > location as u64 => {
                edit.replace
                    .push((below(&part, "color"), json!(number - 1)));
            }
            _ => {}
        }
    }
    for (d, draw) in list(pass, "draws").iter().enumerate() {
        if list(draw, "targets").len() > location {
            let targets = below(&below(&below(pointer, "draws"), d), "targets");
            edit.remove.push(below(&targets, location));
        }
    }
    edit
}

/// Removes attachments from the list of read-back attachments.
pub(crate) fn read(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let count = list(&document["scene"], "read").len();
    let parts = parts(count).into_iter().filter(|part| part.len() < count);
    parts
        .map(|part| Edit {
            remove: part.map(|i| pointer!["scene", "read", i]).collect(),
            ..Edit::default()
        })
        .collect()
}

/// Removes attachments that nothing refers to, together and one by one.
pub(crate) fn unused(document: &Value, _: Option<[u32; 2]>) -> Vec<Edit> {
    let scene = &document["scene"];
    let mut named = Vec::new();
    collect(&scene["passes"], &mut named);
    collect(&scene["read"], &mut named);
    let attachments = scene["attachments"].as_object();
    let names = attachments.into_iter().flatten().map(|(name, _)| name);
    let unused: Vec<_> = names
        .filter(|name| !named.contains(&name.as_str()))
        .map(|name| pointer!["scene", "attachments", name.as_str()])
        .collect();
    let parts = parts(unused.len()).into_iter();
    parts
        .map(|part| Edit {
            remove: unused[part].to_vec(),
            ..Edit::default()
        })
        .collect()
}

/// Adds all strings in a value.
fn collect<'v>(value: &'v Value, names: &mut Vec<&'v str>) {
    match value {
        Value::String(text) => names.push(text),
        Value::Array(list) => list.iter().for_each(|v| collect(v, names)),
        Value::Object(map) => map.values().for_each(|v| collect(v, names)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn removing_an_attachment_removes_what_refers_to_it() {
        let document = json!({ "scene": {
            "attachments": { "a": {}, "b": {}, "d": {}, "t": {} },
            "passes": [{
                "color": ["a", "b"], "depth_stencil": "d", "resolve": [null, "t"],
                "clears": [{ "color": 0 }, { "color": 1 }, { "depth": 1 }],
                "draws": [{ "targets": [{}, { "write_mask": "r" }], "depth": {}, "cull": "back" }]
            }],
            "read": ["a"]
        } });
        let edits = bound(&document, None);
        let no_depth = edits[0].apply(&document).unwrap();
        let pass = &no_depth["scene"]["passes"][0];
        assert_eq!(pass.get("depth_stencil"), None);
        assert_eq!(pass["clears"], json!([{ "color": 0 }, { "color": 1 }]));
        assert_eq!(pass["draws"][0].get("depth"), None);
        let no_first = edits[2].apply(&document).unwrap();
        let pass = &no_first["scene"]["passes"][0];
        assert_eq!(pass["color"], json!(["b"]));
        assert_eq!(pass["resolve"], json!(["t"]));
        assert_eq!(pass["clears"], json!([{ "color": 0 }, { "depth": 1 }]));
        assert_eq!(pass["draws"][0]["targets"], json!([{ "write_mask": "r" }]));
        assert_eq!(unused(&document, None), []);
        let unused = unused(&no_depth, None);
        assert_eq!(
            unused[0],
            Edit::removal(pointer!["scene", "attachments", "d"])
        );
    }
}
