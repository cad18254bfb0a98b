//! Pictures of the rasterizer.

use etalon_backend::Backend;
use etalon_case::{CaseFile, Library, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::Frame;
use etalon_scene::Scene;

fn frame(text: &str) -> Frame {
    let file = CaseFile::parse("t.json", text).expect("parses");
    let case = file.cases(Profile::Full).next().expect("a case").build();
    let backend = CpuBackend::new("cpu");
    let case = case.expect("builds");
    let mut prepared = backend.prepare(&case.scene).expect("prepares");
    prepared.submit().expect("draws");
    prepared.read_back().expect("reads")
}

#[test]
fn the_first_row_is_at_the_top_and_the_first_column_at_the_left() {
    let frame = frame(
        r#"{"about":"t","spec":["t"],"scene":{
        "attachments":{"color":{"format":"rgba8unorm","size":[20,8]}},
        "passes":[{"color":["color"],"draws":[{"mesh":{"kind":"rect","texels":[0,0,3,2],"value":[1,0,0,1]},
        "shader":"flat_color"}]}],"read":["color"]}}"#,
    );
    for y in 0..8 {
        for x in 0..20 {
            let expected = if x < 3 && y < 2 {
                [255, 0, 0, 255]
            } else {
                [0; 4]
            };
            assert_eq!(frame.images[0].sample(x, y, 0), expected, "({x}, {y})");
        }
    }
}

#[test]
fn a_slanted_triangle_has_depths_between_its_vertices() {
    let frame = frame(
        r#"{"about":"t","spec":["t"],"scene":{
        "attachments":{"depth":{"format":"depth32float","size":[16,16],"clear":1}},
        "passes":[{"depth_stencil":"depth","draws":[{"mesh":{"kind":"vertices",
        "positions":[[-1,-1,0],[3,-1,0.5],[-1,3,0]]},"shader":"uniform_color",
        "depth":{"compare":"less","write":true}}]}],"read":["depth"]}}"#,
    );
    let image = &frame.images[0];
    let depth_at = |x| f32::from_bits(image.sample(x, 9, 0)[0]);
    for x in 0..16 {
        let expected = 0.25 * (x as f32 + 0.5) / 16.0;
        assert!(
            (depth_at(x) - expected).abs() < 1e-6,
            "{x}: {} for {expected}",
            depth_at(x)
        );
    }
}

/// Draws three layers over the whole picture with one shader, nearest first, with a depth test. Returns the
/// number of shaded fragments and the picture.
fn layers(shader: &str) -> (u64, Vec<u32>) {
    let layer = |z: f32, color: &str| {
        format!(
            r#"{{"mesh":{{"kind":"full","value":{color},"z":{z}}},"shader":"{shader}",
            "params":{{"back_color":[20,0,0,0]}},"counters":["shaded"],"depth":{{"compare":"less","write":true}}}}"#
        )
    };
    let layers = [
        layer(0.25, "[1,0,0,1]"),
        layer(0.5, "[0,1,0,1]"),
        layer(0.75, "[0,0,1,1]"),
    ];
    let frame = frame(&format!(
        r#"{{"about":"t","spec":["t"],"scene":{{
        "attachments":{{"color":{{"format":"rgba8unorm","size":[20,8]}},"depth":{{"format":"depth32float","clear":1}}}},
        "counters":{{"shaded":"fragment-invocations"}},
        "passes":[{{"color":["color"],"depth_stencil":"depth","draws":[{}]}}],"read":["color"]}}}}"#,
        layers.join(",")
    ));
    (frame.counters[0], frame.images[0].codes.clone())
}

#[test]
fn hidden_fragments_are_shaded_only_where_the_shader_may_change_what_the_tests_see() {
    let (early, picture) = layers("expensive_color");
    assert_eq!(early, 20 * 8);
    assert_eq!(picture, [255, 0, 0, 255].repeat(20 * 8));
    for shader in ["expensive_depth", "expensive_discard"] {
        assert_eq!(layers(shader), (3 * 20 * 8, picture.clone()), "{shader}");
    }
}

#[test]
fn each_location_gets_its_own_colour() {
    let frame = frame(
        r#"{"about":"t","spec":["t"],"scene":{
        "attachments":{"a":{"format":"rgba8unorm","size":[4,4]},"b":{"format":"rgba8unorm","size":[4,4]},
        "before":{"format":"rgba32float","size":[4,4]}},
        "passes":[{"color":["a","b"],"draws":[{"mesh":{"kind":"full","value":[0,0,1,0],"z":1},"shader":"peel",
        "textures":["before"]}]}],"read":["a","b"]}}"#,
    );
    assert_eq!(frame.images[0].sample(1, 1, 0), [0, 0, 255, 0]);
    assert_eq!(frame.images[1].sample(1, 1, 0), [255, 0, 0, 255]);
}

#[test]
fn texture_coordinates_reach_shaders_that_read_them_as_numbers() {
    let frame = frame(
        r#"{"about":"t","spec":["t"],"scene":{
        "attachments":{"color":{"format":"rgba32float","size":[16,4]}},
        "passes":[{"color":["color"],"draws":[{"mesh":{"kind":"vertices","positions":[[-1,-1,0],[3,-1,0],[-1,3,0]],
        "values":[[1,1,1,1]],"uv":[[-0.5,0],[1.5,0],[-0.5,0]]},"shader":"edge_alpha"}]}],"read":["color"]}}"#,
    );
    for x in 0..16 {
        let alpha = f32::from_bits(frame.images[0].sample(x, 2, 0)[3]);
        let expected = (x as f32 + 0.5) / 16.0;
        assert!(
            (alpha - expected).abs() < 1e-6,
            "{x}: {alpha} for {expected}"
        );
    }
}

/// Returns the columns and rows of the texels, of 8 by 8, that a mesh covers in a viewport.
fn covered(positions: &str, state: &str, viewport: [f32; 4]) -> Vec<[u32; 2]> {
    let frame = frame(&format!(
        r#"{{"about":"t","spec":["t"],"scene":{{
        "attachments":{{"color":{{"format":"rgba8unorm","size":[8,8]}}}},
        "passes":[{{"color":["color"],"draws":[{{"mesh":{{"kind":"vertices","positions":{positions}}},
        "shader":"uniform_color","params":{{"color":[1,1,1,1]}},"viewport":{{"rect":{viewport:?},"depth":[0,1]}},{state}}}]}}],
        "read":["color"]}}}}"#
    ));
    let texels = (0..64).map(|i| [i % 8, i / 8]);
    texels
        .filter(|[x, y]| frame.images[0].sample(*x, *y, 0)[0] > 0)
        .collect()
}

/// A viewport whose top is in the second row, above or below the row's samples.
const ABOVE: [f32; 4] = [2.0, 1.375, 4.0, 4.0];
const BELOW: [f32; 4] = [2.0, 1.625, 4.0, 4.0];

#[test]
fn a_line_beside_the_viewport_covers_no_sample_inside() {
    let line = r#""topology":"line-list""#;
    let outline = r#""polygon_mode":"line""#;
    let row: Vec<[u32; 2]> = (2..6).map(|x| [x, 1]).collect();
    for (y, expected) in [(1.0, row.clone()), (1.03125, vec![])] {
        let ends = format!("[[-1,{y},0.5],[1,{y},0.5]]");
        assert_eq!(covered(&ends, line, ABOVE), expected, "{y}");
    }
    // Only the part beyond the far plane is inside.
    let leaving = "[[-1,1.03125,0.25],[1,0.96875,3]]";
    assert_eq!(covered(leaving, line, ABOVE), Vec::<[u32; 2]>::new());
    let beside = "[[-1,1.03125,0.5],[1,1.03125,0.5],[-1,1.125,0.5]]";
    assert_eq!(covered(beside, outline, ABOVE), Vec::<[u32; 2]>::new());
}

#[test]
fn a_line_that_leaves_the_viewport_is_clipped_along_the_line() {
    let line = r#""topology":"line-list""#;
    // Half of the line is above the viewport, in the row of the other half.
    let rising = "[[-1,0.96875,0.5],[1,1.03125,0.5]]";
    assert_eq!(covered(rising, line, ABOVE), [[2, 1], [3, 1]]);
    // The samples of the row are above the viewport, but the line is not.
    let row: Vec<[u32; 2]> = (2..6).map(|x| [x, 1]).collect();
    for ends in ["[[-1,1,0.5],[1,1,0.5]]", "[[-1.5,1,0.5],[1.5,1,0.5]]"] {
        assert_eq!(covered(ends, line, BELOW), row, "{ends}");
    }
}

/// The rasterizer does not execute the path values `start` and `draws`, so a scene on its path must draw the
/// same picture as the scene.
#[test]
fn a_scene_on_its_path_draws_the_same_picture() {
    let library = Library::built_in();
    let backend = CpuBackend::new("cpu");
    let draw = |scene: &Scene| {
        let mut prepared = backend.prepare(scene).expect("prepares");
        prepared.submit().expect("draws");
        prepared.read_back().expect("reads")
    };
    let mut made_over = 0;
    for file in library.files_where(|stem| stem.starts_with("paths/")) {
        for case in file.cases(Profile::Quick) {
            let case = case.build().expect("builds");
            let on_path = case.scene.on_path();
            if on_path.passes == case.scene.passes {
                continue;
            }
            made_over += 1;
            let same = draw(&case.scene) == draw(&on_path);
            assert!(same, "{}", case.id);
        }
    }
    assert!(made_over > 100, "{made_over} scenes are made over");
}
