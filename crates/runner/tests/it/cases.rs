//! The cases that the workers draw.

use etalon_case::{Case, Library, Profile};
use std::fs;
use std::path::Path;

/// Returns cases whose heights count up from 1. Writes their case file to the folder.
pub(crate) fn cases(folder: &Path, count: u32) -> Vec<Case> {
    let text = r#"{
        "about": "An attachment is filled.", "spec": ["none"],
        "axes": { "height": { "from": 1, "count": COUNT } },
        "scene": {
            "attachments": { "color": { "format": "rgba8unorm", "size": [4, "$height"] } },
            "passes": [{ "color": ["color"], "draws": [
                { "mesh": { "kind": "full" }, "shader": "uniform_color", "params": { "color": [1, 0, 0, 1] } }
            ] }],
            "read": ["color"]
        }
    }"#
    .replace("COUNT", &count.to_string());
    fs::create_dir_all(folder).unwrap();
    fs::write(folder.join("fill.json"), text).unwrap();
    let library = Library::from_folder(folder).unwrap();
    let built = library.cases(Profile::Full).map(|c| c.build().unwrap());
    let built: Vec<Case> = built.collect();
    assert_eq!(built.len() as u32, count);
    built
}
