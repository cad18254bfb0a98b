//! Scenes from the text of case files.

use etalon_case::{CaseFile, Profile};
use etalon_scene::Scene;

/// Draws red.
pub(crate) const PAINT: &str = r#""shader": "uniform_color", "params": { "color": [1, 0, 0, 1] }"#;
/// Draws front faces red, back faces green.
pub(crate) const FACING: &str =
    r#""shader": "front_facing", "params": { "color": [1, 0, 0, 1], "back_color": [0, 1, 0, 1] }"#;
/// A quadrilateral over exactly the viewport.
pub(crate) const WHOLE: &str = r#""topology": "triangle-strip", "mesh": { "kind": "vertices",
    "positions": [[-1, 1, 0], [-1, -1, 0], [1, 1, 0], [1, -1, 0]] }"#;
/// A triangle over every sample; rectangles are certain of the texels' centres only.
pub(crate) const EVERYWHERE: &str = r#""mesh": { "kind": "vertices", "values": [[1, 0, 0, 1]],
    "positions": [[-1, -1, 0], [3, -1, 0], [-1, 3, 0]] }"#;

/// The scene of a case file with this text as its `scene`.
pub fn scene(json: &str) -> Scene {
    let text = format!(r#"{{ "about": "A check.", "spec": [], "scene": {json} }}"#);
    let file = CaseFile::parse("check.json", &text).unwrap_or_else(|e| panic!("{e}: {json}"));
    let case = file.cases(Profile::Full).next().unwrap();
    case.build().unwrap_or_else(|e| panic!("{e}: {json}")).scene
}

/// A scene from the insides of its attachments and passes, and what is read back.
pub(crate) fn scene_of(attachments: &str, passes: &str, read: &[&str]) -> Scene {
    scene(&format!(
        r#"{{ "attachments": {{ {attachments} }}, "passes": [ {passes} ], "read": {read:?} }}"#
    ))
}

/// A scene of draws into an `rgba8unorm` attachment `color` of 16 by 16 texels, cleared to blue.
pub(crate) fn over_blue(draws: &[String]) -> Scene {
    scene_of(
        r#""color": { "format": "rgba8unorm", "clear": [0, 0, 1, 1] }"#,
        &format!(r#"{{ "color": ["color"], "draws": [ {} ] }}"#, list(draws)),
        &["color"],
    )
}

/// A scene of one draw, as the insides of its JSON, over blue.
pub(crate) fn one_draw(draw: &str) -> Scene {
    over_blue(&[format!("{{ {draw} }}")])
}

/// The elements of a JSON list.
pub(crate) fn list(elements: &[String]) -> String {
    elements.join(", ")
}

/// An `rgba8unorm` attachment of 16 by 16 texels that all hold the same.
pub(crate) fn uploaded(name: &str, texel: [u32; 4]) -> String {
    format!(
        r#""{name}": {{ "format": "rgba8unorm", "texels": {{ "kind": "rows", "values": {:?} }} }}"#,
        [texel; 16]
    )
}

/// A `blend` key with the same operation and factors for colour and alpha.
pub(crate) fn blend(operation: &str, src: &str, dst: &str) -> String {
    let both = format!(
        r#"{{ "operation": "{operation}", "src_factor": "{src}", "dst_factor": "{dst}" }}"#
    );
    format!(r#""blend": {{ "color": {both}, "alpha": {both} }}"#)
}
