//! Scenes as JSON, with the keys of case files.

use etalon_case::{CaseFile, Profile};
use etalon_frame::TextureFormat;
use etalon_scene::Scene;
use serde_json::{Value, json};

/// Returns the scene of a case file whose `scene` is `body`. Two keys are optional: without `passes`, there
/// is one pass of `draws` to all attachments that are not its textures; without `read`, all attachments are
/// read back.
pub fn scene(mut body: Value) -> Scene {
    if let Some(draws) = body.as_object_mut().unwrap().remove("draws") {
        body["passes"] = json!([pass(&body["attachments"], &draws)]);
    }
    if body.get("read").is_none() {
        let attachments = body["attachments"].as_object().unwrap();
        body["read"] = attachments.keys().cloned().collect();
    }
    let text = json!({ "about": "A check.", "spec": [], "scene": body }).to_string();
    let file = CaseFile::parse("check.json", &text).unwrap_or_else(|e| panic!("{e}: {text}"));
    let case = file.cases(Profile::Full).next().unwrap();
    case.build().unwrap_or_else(|e| panic!("{e}: {text}")).scene
}

/// Returns a pass to all attachments that no draw names as a texture.
fn pass(attachments: &Value, draws: &Value) -> Value {
    let textures = draws.as_array().unwrap().iter();
    let textures = textures.filter_map(|draw| draw["textures"].as_array());
    let textures: Vec<_> = textures.flatten().collect();
    let mut pass = json!({ "color": [], "draws": draws });
    for (name, attachment) in attachments.as_object().unwrap() {
        let format: TextureFormat = serde_json::from_value(attachment["format"].clone()).unwrap();
        if textures.contains(&&json!(name)) {
            continue;
        }
        if format.is_color() {
            pass["color"].as_array_mut().unwrap().push(json!(name))
        } else {
            pass["depth_stencil"] = json!(name)
        }
    }
    pass
}

/// Returns an object with the keys of both; those of `more` take precedence.
pub fn with(mut object: Value, more: Value) -> Value {
    let Value::Object(more) = more else {
        panic!("{more} is not an object");
    };
    object.as_object_mut().unwrap().extend(more);
    object
}

/// Returns a scene of one draw to an attachment `color` of 16 by 16 texels, cleared to blue.
pub(crate) fn over_blue(draw: Value) -> Value {
    json!({ "attachments": { "color": blue() }, "draws": [draw] })
}

/// Returns an `rgba8unorm` attachment cleared to blue.
pub(crate) fn blue() -> Value {
    json!({ "format": "rgba8unorm", "clear": [0, 0, 1, 1] })
}

/// Returns an `rgba8unorm` attachment with these rows, columns or grid of texels.
pub(crate) fn uploaded(kind: &str, texels: impl Into<Value>) -> Value {
    let texels: Value = texels.into();
    json!({ "format": "rgba8unorm", "texels": { "kind": kind, "values": texels } })
}

/// Returns an `rgba8unorm` attachment of 16 by 16 equal texels.
pub(crate) fn filled(texel: [u32; 4]) -> Value {
    uploaded("rows", [texel; 16])
}

/// Returns the parameters of a shader that draws red.
pub(crate) fn red() -> Value {
    json!({ "color": [1, 0, 0, 1] })
}

/// Returns the parameters of a shader that draws green.
pub(crate) fn green() -> Value {
    json!({ "color": [0, 1, 0, 1] })
}

/// Returns the parameters of a shader that distinguishes red from green.
pub(crate) fn red_or_green() -> Value {
    json!({ "color": [1, 0, 0, 1], "back_color": [0, 1, 0, 1] })
}

/// Returns the parts of a draw in red, except its mesh.
pub(crate) fn painted() -> Value {
    json!({ "shader": "uniform_color", "params": red() })
}

/// Returns a mesh over all texels.
pub(crate) fn full() -> Value {
    json!({ "kind": "full" })
}

/// Returns a mesh of the texels from one corner up to another, which is exclusive.
pub(crate) fn rect(texels: [u32; 4]) -> Value {
    json!({ "kind": "rect", "texels": texels })
}

/// Returns a draw of green over a part.
pub(crate) fn green_over(texels: [u32; 4]) -> Value {
    json!({ "mesh": rect(texels), "shader": "uniform_color", "params": green() })
}

/// Returns the corners of [`rect`] as vertices of a triangle strip, which covers all samples of its texels.
pub(crate) fn corners([left, top, right, bottom]: [u32; 4]) -> Value {
    json!({ "kind": "vertices", "units": "texels", "positions":
        [[left, top, 0], [left, bottom, 0], [right, top, 0], [right, bottom, 0]] })
}

/// Returns a triangle over every sample; a `rect` is only certain to cover the texels' centres.
pub(crate) fn everywhere(value: Value) -> Value {
    json!({ "kind": "vertices", "values": [value],
            "positions": [[-1, -1, 0], [3, -1, 0], [-1, 3, 0]] })
}

/// Returns a depth test.
pub(crate) fn test(compare: &str, write: bool) -> Value {
    json!({ "compare": compare, "write": write })
}

/// Returns the operation and factors of a blend component.
pub(crate) fn component(operation: &str, src: &str, dst: &str) -> Value {
    json!({ "operation": operation, "src_factor": src, "dst_factor": dst })
}

/// Returns a blend state with the same operation and factors for colour and alpha.
pub(crate) fn blend(operation: &str, src: &str, dst: &str) -> Value {
    let both = component(operation, src, dst);
    json!({ "color": both, "alpha": both })
}
