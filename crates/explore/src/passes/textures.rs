//! Simplifies shaders and their textures: replaces shaders that read textures by shaders that do not, and
//! uploaded texels by a clear value.

use crate::document::draws_of;
use crate::edit::{Edit, below, pointer, value_at};
use serde_json::{Map, Value, json};

/// The shaders that replace others, the simplest first.
const SIMPLE: [&str; 2] = ["uniform_color", "flat_color"];
/// The maximum number of colours that are tried in place of a shader's own.
const COLORS: usize = 6;

/// Simplifies the shader of each draw.
pub(crate) fn shaders(document: &Value, texel: Option<[u32; 2]>) -> Vec<Edit> {
    let mut edits = Vec::new();
    for pointer in draws_of(document) {
        let Some(draw) = value_at(document, &pointer) else {
            continue;
        };
        let shader = draw["shader"].as_str().unwrap_or_default();
        let rank = SIMPLE.iter().position(|s| *s == shader);
        let texels = colors_of_textures(document, draw, texel);
        if rank.is_none_or(|rank| rank > 0) {
            for color in colors(draw).into_iter().chain(texels.clone()).take(COLORS) {
                let mut edit = without_inputs(draw, &pointer);
                edit.replace = vec![
                    (below(&pointer, "shader"), json!(SIMPLE[0])),
                    (below(&pointer, "params"), json!({ "color": color })),
                ];
                edits.push(edit);
            }
        }
        if rank.is_none() {
            let mut edit = without_inputs(draw, &pointer);
            edit.replace = vec![(below(&pointer, "shader"), json!(SIMPLE[1]))];
            edits.push(edit.clone());
            for color in texels.into_iter().chain([json!(1)]) {
                let mut edit = edit.clone();
                let mesh = json!({ "kind": "cover", "value": color });
                edit.replace.push((below(&pointer, "mesh"), mesh));
                edits.push(edit);
            }
        }
    }
    edits
}

/// Returns an edit that removes the keys that only shaders with textures have.
fn without_inputs(draw: &Value, pointer: &[crate::edit::EditStep]) -> Edit {
    let keys = ["textures", "sampler", "early_tests", "clip_distances"];
    let given = keys.into_iter().filter(|key| draw.get(key).is_some());
    Edit {
        remove: given.map(|key| below(pointer, key)).collect(),
        ..Edit::default()
    }
}

/// Returns the colours in a draw: those of its parameters, then those of its mesh.
fn colors(draw: &Value) -> Vec<Value> {
    let params = &draw["params"];
    let mesh = &draw["mesh"];
    let colors = [&params["color"], &params["back_color"], &mesh["value"]];
    let colors = colors.into_iter().filter(|v| !v.is_null()).cloned();
    let of_mesh = mesh["values"].as_array().into_iter().flatten().cloned();
    let mut values: Vec<Value> = Vec::new();
    for color in colors.chain([json!(1)]).chain(of_mesh) {
        if !values.contains(&color) {
            values.push(color);
        }
    }
    values
}

/// Returns the colours of a draw's textures at the wrong texel.
fn colors_of_textures(document: &Value, draw: &Value, texel: Option<[u32; 2]>) -> Vec<Value> {
    let names = draw["textures"].as_array().into_iter().flatten();
    let attachments = &document["scene"]["attachments"];
    let colors = names.filter_map(|name| color(attachments.get(name.as_str()?)?, texel));
    colors.collect()
}

/// Replaces uploaded texels by a clear value.
pub(crate) fn texels(document: &Value, texel: Option<[u32; 2]>) -> Vec<Edit> {
    let mut edits = Vec::new();
    let attachments = document["scene"]["attachments"].as_object();
    for (name, attachment) in attachments.into_iter().flatten() {
        if attachment.get("texels").is_none() {
            continue;
        }
        let attachment_pointer = pointer!["scene", "attachments", name.as_str()];
        edits.push(Edit::removal(below(&attachment_pointer, "texels")));
        if let Some(color) = color(attachment, texel) {
            let mut edit = Edit::removal(below(&attachment_pointer, "texels"));
            edit.replace
                .push((below(&attachment_pointer, "clear"), color));
            edits.push(edit);
        }
        // Makes all texels equal, for shaders that need uploaded texels.
        let values = attachment["texels"]["values"].as_array();
        if let (Some(values), Some(value)) = (values, raw(attachment, texel))
            && attachment["texels"]["kind"] != "grid"
        {
            let alike = vec![value; values.len()];
            let pointer = below(&below(&attachment_pointer, "texels"), "values");
            edits.push(Edit::replacement(pointer, alike));
        }
    }
    edits
}

/// Returns the uploaded values at a texel, or at the first texel.
fn raw(attachment: &Value, texel: Option<[u32; 2]>) -> Option<Value> {
    let texels: &Map<String, Value> = attachment["texels"].as_object()?;
    let values = texels.get("values")?.as_array()?;
    let [x, y] = texel.unwrap_or([0, 0]).map(|v| v as usize);
    let nth = |list: &[Value], index: usize| list.get(index).or(list.first()).cloned();
    match texels.get("kind")?.as_str()? {
        "columns" => nth(values, x),
        "rows" => nth(values, y),
        "grid" => nth(nth(values, y)?.as_array()?, x),
        _ => None,
    }
}

/// Returns the colour of an attachment's texels at a texel as a clear value: codes of normalized formats
/// become fractions of the largest code.
fn color(attachment: &Value, texel: Option<[u32; 2]>) -> Option<Value> {
    if let Some(clear) = attachment.get("clear") {
        return clear.is_array().then(|| clear.clone());
    }
    let format = attachment["format"].as_str()?;
    let most = match format {
        "rgb10a2unorm" => [1023.0, 1023.0, 1023.0, 3.0],
        _ if format.ends_with("float") || format.ends_with("uint") => [1.0; 4],
        _ if format.ends_with("snorm") => [127.0; 4],
        _ => [255.0; 4],
    };
    let raw = raw(attachment, texel)?;
    let channels = raw.as_array()?.iter().zip(most);
    let share = |(value, most): (&Value, f64)| {
        let share = value.as_f64()? / most;
        Some(if share.fract() == 0.0 {
            json!(share as i64)
        } else {
            json!((share * 1e4).round() / 1e4)
        })
    };
    channels.map(share).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_texture_becomes_a_colour() {
        let document = json!({ "scene": {
            "attachments": { "t": {
                "format": "rgba8unorm", "texels": { "kind": "columns", "values": [[0, 0, 0, 0], [255, 51, 0, 255]] }
            } },
            "passes": [{ "draws": [{
                "mesh": { "kind": "full" }, "shader": "texel_color", "textures": ["t"], "cull": "back"
            }] }]
        } });
        let edits = shaders(&document, Some([1, 7]));
        let draw =
            |edit: &Edit| edit.apply(&document).unwrap()["scene"]["passes"][0]["draws"][0].clone();
        let expected = json!({
            "mesh": { "kind": "full" }, "shader": "uniform_color",
            "params": { "color": [1, 0.2, 0, 1] }, "cull": "back"
        });
        assert!(edits.iter().any(|edit| draw(edit) == expected));
        let cleared = texels(&document, Some([1, 7]))[1].apply(&document).unwrap();
        let expected = json!({ "format": "rgba8unorm", "clear": [1, 0.2, 0, 1] });
        assert_eq!(cleared["scene"]["attachments"]["t"], expected);
        let simplest =
            json!({ "scene": { "passes": [{ "draws": [{ "shader": "uniform_color" }] }] } });
        assert_eq!(shaders(&simplest, None), []);
    }
}
