//! Every shader of the suite, translated and drawn.

use super::Checked;
use crate::scenes::scene;
use crate::subject::Subject;
use etalon_scene::Shader;

/// With as many attachments as a shader has outputs, and with fewer.
pub(crate) fn every_shader_draws(s: &Subject) -> Checked {
    for shader in Shader::ALL {
        for targets in 1..=shader.outputs() {
            let _ = s.draw(&scene(&with_shader(*shader, targets)));
        }
    }
    Ok(())
}

/// A scene that draws with a shader to so many attachments.
fn with_shader(shader: Shader, targets: usize) -> String {
    let format = if shader.writes_integers() {
        "rgba8uint"
    } else {
        "rgba8unorm"
    };
    let names = &["a", "b", "c", "d"][..targets];
    let color = names
        .iter()
        .map(|name| format!(r#""{name}": {{ "format": "{format}", "size": [4, 4] }}"#));
    let textures = &["s", "t"][..shader.textures()];
    let sampler = r#", "sampler": { "filter": "linear", "address": ["repeat", "repeat"] }"#;
    let (counter, counters) = if shader.counts_runs() {
        (
            r#", "counters": ["runs"]"#,
            r#", "counters": { "runs": "shader-runs" }"#,
        )
    } else {
        ("", "")
    };
    format!(
        r#"{{ "attachments": {{ {}, "depth": {{ "format": "depth32float", "size": [4, 4] }},
                "s": {{ "format": "rgba8unorm", "size": [4, 4] }}, "t": {{ "format": "rgba8unorm", "size": [4, 4] }} }},
            "passes": [ {{ "color": {names:?}, "depth_stencil": "depth", "draws": [ {{
                "mesh": {{ "kind": "cover", "uv": [0.5, 0.5, 1, 1] }}, "shader": "{}", "textures": {textures:?},
                "params": {{ "color": [1, 2, 1, 0] }}, "depth": {{ "compare": "always", "write": true }}
                {} {counter} }} ] }} ],
            "read": {names:?} {counters} }}"#,
        color.collect::<Vec<_>>().join(","),
        shader.name(),
        if shader.samples_texture() {
            sampler
        } else {
            ""
        },
    )
}
