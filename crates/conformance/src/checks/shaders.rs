//! Every shader of the suite, translated and drawn.

use super::CheckEnd;
use crate::subject::CheckedBackend;
use etalon_scene::Shader;
use serde_json::{Value, json};

/// Draws with as many attachments as a shader has outputs, and with fewer.
pub(crate) fn every_shader_draws(s: &CheckedBackend) -> CheckEnd {
    for shader in Shader::ALL {
        let most = s.limits().max_color_attachments as usize;
        for targets in 1..=shader.outputs().min(most) {
            let _ = s.show(with_shader(*shader, targets));
        }
    }
    Ok(())
}

/// Returns a scene that draws with a shader to this number of attachments.
fn with_shader(shader: Shader, targets: usize) -> Value {
    let format = if shader.writes_integers() {
        "rgba8uint"
    } else {
        "rgba8unorm"
    };
    let names = &["a", "b", "c", "d", "e", "f", "g", "h"][..targets];
    let samples = if shader.reads_sample() { 4 } else { 1 };
    let (textures, tested) = if shader.reads_stencil() {
        (&["depth"][..], "depth24plus-stencil8")
    } else if shader.reads_sample() {
        // Not the target, whose fetched value a known driver changes when it stores it.
        (&["depth"][..], "depth32float")
    } else {
        (&["s", "t"][..shader.textures()], "depth32float")
    };
    let texture = if shader.writes_mask() || shader.writes_reference() {
        json!({ "format": "rgba32float", "size": [4, 4], "texels":
            { "kind": "rows", "values": [[1, 0.5, 1, 1], [1, 0, 1, 0], [0, 1, 1, 1], [65535, 1, 0, 0]] } })
    } else {
        json!({ "format": "rgba8unorm", "size": [4, 4] })
    };
    let mut attachments =
        json!({ "depth": { "format": tested, "samples": samples }, "s": texture, "t": texture });
    for name in names {
        attachments[*name] = json!({ "format": format, "samples": samples });
    }
    let mut draw = json!({
        "mesh": { "kind": "cover", "uv": [0.5, 0.5, 1, 1] }, "shader": shader.name(), "textures": textures,
        "params": { "color": [1, 2, 1, 0] }, "depth": { "compare": "always", "write": !textures.contains(&"depth") } });
    if shader.samples_texture() {
        draw["sampler"] = json!({ "filter": "linear", "address": ["repeat", "repeat"] });
    }
    let mut counters = json!({});
    if shader.counts_runs() {
        draw["counters"] = json!(["runs"]);
        counters = json!({ "runs": "shader-runs" });
    }
    let layers = if shader.uses_layers() { 4 } else { 0 };
    if shader.uses_pool() {
        draw["params"] = json!({ "color": [4, 4, layers, 0] });
    }
    let pool = shader
        .uses_pool()
        .then(|| json!({ "size": [4, 4], "nodes": 64, "layers": layers }));
    json!({
        "attachments": attachments,
        "passes": [{ "color": names, "depth_stencil": "depth", "draws": [draw] }],
        "read": names,
        "counters": counters,
        "pool": pool,
    })
}
