//! Scenes and how they are looked at.
#![expect(clippy::unwrap_used, reason = "these are tests")]

use crate::GlBackend;
use etalon_backend::Backend;
use etalon_case::{CaseFile, Profile};
use etalon_frame::{Frame, Image};
use etalon_scene::Scene;
use std::time::Duration;

pub(super) const SIZE: u32 = 16;
pub(super) const CLEAR: [u32; 4] = [0, 0, 255, 255];
pub(super) const NONE: [u32; 4] = [0; 4];
pub(super) const RED: [u32; 4] = [255, 0, 0, 255];
pub(super) const GREEN: [u32; 4] = [0, 255, 0, 255];

/// A rectangle in the top left corner.
pub(super) const CORNER: &str = r#"{
    "attachments": {"color": {"format":"rgba8unorm","size":[16,16],"clear":[0,0,1,1]}},
    "passes": [{"color":["color"],"draws":[
        {"mesh":{"kind":"rect","texels":[0,0,5,3]},"shader":"uniform_color","params":{"color":[1,0,0,1]}}]}],
    "read": ["color"]}"#;

pub(super) fn scene(json: &str) -> Scene {
    let text = format!(r#"{{"about":"a","spec":["b"],"scene":{json}}}"#);
    let file = CaseFile::parse("t.json", &text).unwrap();
    file.cases(Profile::Full)
        .next()
        .unwrap()
        .build()
        .unwrap()
        .scene
}

/// Draws twice; both frames must be the same.
pub(super) fn draw(backend: &GlBackend, json: &str) -> Frame {
    let scene = scene(json);
    let mut prepared = backend
        .prepare(&scene)
        .unwrap_or_else(|e| panic!("{e}: {json}"));
    let time = prepared.submit().unwrap();
    assert!(
        time.cpu <= time.wall && time.wall > Duration::ZERO,
        "{time:?}"
    );
    let first = prepared.read_back().unwrap();
    prepared.submit().unwrap();
    let second = prepared.read_back().unwrap();
    assert_eq!(first, second, "{json}");
    for image in &first.images {
        assert_eq!(image.codes.len(), image.expected_len());
    }
    first
}

pub(super) fn each(image: &Image, expected: impl Fn(u32, u32) -> Vec<u32>) {
    for y in 0..image.size[1] {
        for x in 0..image.size[0] {
            let actual = image.sample(x, y, 0);
            assert_eq!(
                actual,
                expected(x, y),
                "{} {} at {x} {y}",
                image.attachment,
                image.aspect
            );
        }
    }
}
