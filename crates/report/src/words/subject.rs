//! Names of texels, scenes and pictures, and lists of words.

use etalon_frame::{SceneName, Side};

/// Returns the name of a texel or of its samples: `samples 0, 1 and 3 of texel 1,1`.
pub(super) fn texel_name([x, y]: [u32; 2], samples: &[u32]) -> String {
    match samples {
        [] => format!("texel {x},{y}"),
        [sample] => format!("sample {sample} of texel {x},{y}"),
        several => {
            let numbers: Vec<String> = several.iter().map(u32::to_string).collect();
            format!("samples {} of texel {x},{y}", list(&numbers, "and"))
        }
    }
}

/// Returns the name of a scene of a case.
pub(super) fn scene_name(scene: &SceneName) -> String {
    match scene {
        SceneName::Own => "in the scene".to_owned(),
        SceneName::Variant(name) => format!("in variant {name}"),
    }
}

/// Returns the name of one of two pictures.
pub(super) fn side_name(side: &Side) -> String {
    match side {
        Side::Scene(scene) => scene_name(scene),
        Side::Attachment(name) => format!("in attachment {name}"),
    }
}

/// Returns `a, b and c`.
pub(super) fn list(parts: &[String], word: &str) -> String {
    match parts.split_last() {
        Some((last, before)) if !before.is_empty() => {
            format!("{} {word} {last}", before.join(", "))
        }
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}
