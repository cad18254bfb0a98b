//! A scene as a readable list: attachments, passes, and draws with their state that differs from the default.
//!
//! A draw's serialized state is compared with a default draw's field by field, so that new states show
//! without a change here.

use etalon_scene::{
    Attachment, AttachmentContents, ColorTarget, Draw, PassOperations, Path, QueryScope, Scene,
    Shader, SharedMesh, Viewport,
};
use serde::Serialize;
use serde_json::Value;
use std::sync::LazyLock;

/// The largest number of draws that are listed for a pass.
const DRAWS: usize = 24;
/// The largest number of characters of a value.
const LONGEST: usize = 160;
/// Fields that are listed on their own lines.
const LISTED_APART: [&str; 5] = ["mesh", "shader", "viewport", "params", "targets"];

/// Returns the lines, indented by two spaces per level.
pub(crate) fn lines(scene: &Scene) -> Vec<String> {
    let mut lines = Vec::new();
    let name = |index: usize| scene.attachments[index].name.clone();
    for attachment in &scene.attachments {
        lines.push(about(attachment));
    }
    for (i, pass) in scene.passes.iter().enumerate() {
        let mut targets: Vec<String> = pass.color.iter().map(|c| name(*c)).collect();
        targets.extend(pass.depth_stencil.map(name));
        let mut line = format!("pass {i} on {}", targets.join(", "));
        for (from, to) in pass.color.iter().zip(&pass.resolve) {
            if let Some(to) = to {
                line.push_str(&format!(", resolves {} to {}", name(*from), name(*to)));
            }
        }
        if let Some(resolve) = pass.depth_stencil_resolve {
            line.push_str(&format!(
                ", resolves depth by {} and stencil by {} to {}",
                resolve.depth,
                resolve.stencil,
                name(resolve.to)
            ));
        }
        if pass.depth_stencil_read_only {
            line.push_str(", depth and stencil read only");
        }
        lines.push(line);
        let operations = changes(&pass.operations, &PassOperations::default());
        lines.extend(operations.map(|line| format!("  operations {line}")));
        for clear in &pass.clears {
            let target = serde_json::to_value(clear).map_or_else(|_| String::new(), |v| short(&v));
            lines.push(format!("  clear command {target}"));
        }
        for (d, draw) in pass.draws.iter().enumerate().take(DRAWS) {
            lines.extend(of_draw(scene, d, draw, scene.pass_size(pass)));
        }
        if pass.draws.len() > DRAWS {
            lines.push(format!("  and {} further draws", pass.draws.len() - DRAWS));
        }
    }
    let path = changes(&scene.path, &Path::default());
    lines.extend(path.map(|line| format!("path {line}")));
    let read: Vec<String> = scene.read.iter().map(|r| name(*r)).collect();
    lines.push(format!("reads back {}", read.join(", ")));
    for counter in &scene.counters {
        lines.push(format!(
            "counts {} as {}",
            counter.kind.name(),
            counter.name
        ));
    }
    if scene.query_scope != QueryScope::Draw {
        lines.push(format!("a query encloses a {}", scene.query_scope.name()));
    }
    lines
}

fn about(a: &Attachment) -> String {
    let [width, height] = a.size;
    let samples = match a.samples {
        1 => String::new(),
        n => format!(", {n} samples"),
    };
    let contents = match &a.contents {
        AttachmentContents::Color(color) => format!("cleared to {color:?}"),
        AttachmentContents::DepthStencil { depth, stencil } => {
            match (a.format.has_depth(), a.format.has_stencil()) {
                (true, true) => format!("cleared to depth {depth}, stencil {stencil}"),
                (true, false) => format!("cleared to {depth}"),
                _ => format!("cleared to {stencil}"),
            }
        }
        AttachmentContents::Texels(codes) => format!("{} uploaded codes", codes.len()),
    };
    format!(
        "{}: {}, {width} by {height}{samples}, {contents}",
        a.name, a.format
    )
}

fn of_draw(scene: &Scene, number: usize, draw: &Draw, [width, height]: [u32; 2]) -> Vec<String> {
    let vertices = draw.mesh.vertices.len();
    let indices = draw
        .mesh
        .indices
        .as_ref()
        .map_or_else(String::new, |i| format!(", {} indices", i.len()));
    let mut lines = vec![format!(
        "  draw {number}: {}, {vertices} vertices{indices}",
        draw.shader.name()
    )];
    let mut add = |line: String| lines.push(format!("    {line}"));
    if draw.shader.uses_params() {
        add(format!("params color {:?}", draw.params.color));
        if draw.shader.wgsl().contains("params.back_color") {
            add(format!("params back_color {:?}", draw.params.back_color));
        }
    }
    let default = Viewport {
        rect: [0.0, 0.0, width as f32, height as f32],
        depth: [0.0, 1.0],
    };
    if draw.viewport != default {
        add(format!(
            "viewport rect {:?}, depth {:?}",
            draw.viewport.rect, draw.viewport.depth
        ));
    }
    for (i, target) in draw.targets.iter().enumerate() {
        for line in changes(target, &ColorTarget::default()) {
            add(match draw.targets.len() {
                1 => line,
                _ => format!("target {i} {line}"),
            });
        }
    }
    let names = |indices: &[usize]| -> String {
        let names = indices.iter().map(|i| scene.attachments[*i].name.clone());
        names.collect::<Vec<_>>().join(", ")
    };
    if !draw.textures.is_empty() {
        add(format!("textures {}", names(&draw.textures)));
    }
    let mut changed = draw.clone();
    changed.mesh = SharedMesh::default();
    changed.targets.clear();
    changed.textures.clear();
    let mut state = serde_json::to_value(changed).unwrap_or_default();
    for field in LISTED_APART {
        state[field] = PLAIN[field].clone();
    }
    differences(&state, &PLAIN).into_iter().for_each(add);
    lines
}

/// A draw of the default state, serialized.
static PLAIN: LazyLock<Value> = LazyLock::new(|| {
    let rect = Viewport {
        rect: [0.0; 4],
        depth: [0.0, 1.0],
    };
    let draw = Draw::new(Shader::UniformColor, SharedMesh::default(), rect);
    serde_json::to_value(draw).unwrap_or_default()
});

/// Returns the fields of a state that differ from the default.
fn changes<T: Serialize + PartialEq>(
    value: &T,
    plain: &T,
) -> impl Iterator<Item = String> + use<T> {
    let differing = if value == plain {
        Vec::new()
    } else {
        let [values, plain] = [value, plain].map(|t| serde_json::to_value(t).unwrap_or_default());
        differences(&values, &plain)
    };
    differing.into_iter()
}

/// Returns the fields of one value that differ from another's.
fn differences(value: &Value, plain: &Value) -> Vec<String> {
    let Value::Object(members) = value else {
        return Vec::new();
    };
    let changed = members
        .iter()
        .filter(|(key, value)| plain.get(key.as_str()) != Some(*value));
    changed
        .map(|(key, value)| {
            let text: String = format!("{key} {}", short(value));
            if text.chars().count() > LONGEST {
                text.chars().take(LONGEST).chain(['…']).collect()
            } else {
                text
            }
        })
        .collect()
}

/// Formats a value without quotes.
fn short(value: &Value) -> String {
    match value {
        Value::Null => "off".to_owned(),
        Value::String(text) => text.clone(),
        Value::Array(list) => format!(
            "[{}]",
            list.iter().map(short).collect::<Vec<_>>().join(", ")
        ),
        Value::Object(map) => {
            let parts: Vec<String> = map
                .iter()
                .map(|(key, value)| format!("{key} {}", short(value)))
                .collect();
            format!("{{ {} }}", parts.join(", "))
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_case::{Library, Profile};

    #[test]
    fn only_states_that_are_not_the_default_are_listed() {
        let library = Library::built_in();
        let text_of = |id: &str| {
            let mut cases = library.cases(Profile::Full);
            let case = cases.find(|c| c.id() == id).unwrap().build().unwrap();
            lines(&case.scene).join("\n")
        };
        let text = text_of("depth/compare/compare=less/format=depth32float-stencil8/write=true");
        assert!(text.contains("depth32float"), "{text}");
        assert!(text.contains("compare less"), "{text}");
        for absent in ["cull", "scissor", "blend", "topology"] {
            assert!(!text.contains(absent), "{absent}: {text}");
        }
    }

    #[test]
    fn every_scene_has_a_short_list() {
        let library = Library::built_in();
        for file in library.files() {
            let case = file.cases(Profile::Full).next().unwrap().build().unwrap();
            let text = lines(&case.scene);
            assert!(text.len() >= 2, "{}", case.id);
            assert!(
                text.iter().all(|line| line.chars().count() < 400),
                "{}: {text:#?}",
                case.id
            );
        }
    }
}
