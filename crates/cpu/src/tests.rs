use super::*;
use etalon_case::{CaseFile, Profile};

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
            let due = if x < 3 && y < 2 {
                [255, 0, 0, 255]
            } else {
                [0; 4]
            };
            assert_eq!(frame.images[0].sample(x, y, 0), due, "({x}, {y})");
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
    let at = |x| f32::from_bits(image.sample(x, 9, 0)[0]);
    for x in 0..16 {
        let due = 0.25 * (x as f32 + 0.5) / 16.0;
        assert!((at(x) - due).abs() < 1e-6, "{x}: {} for {due}", at(x));
    }
}
