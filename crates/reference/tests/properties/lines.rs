//! Lines with missing fragments: how many may be missing, wherever they are.

use crate::common::{APIS, draw, limits, scene};
use etalon_frame::{Api, Frame, Grade};
use etalon_reference::{Rules, legal_set, line_gap};
use etalon_scene::Scene;

/// A white line, or what `state` makes of it, on a black picture of 16 texels by 8.
fn line(mesh: &str, state: &str) -> Scene {
    scene(&format!(
        r#"{{"attachments":{{"c":{{"format":"rgba8unorm","size":[16,8],"clear":[0,0,0,0]}}}},
            "passes":[{{"color":["c"],"draws":[{{"shader":"uniform_color","params":{{"color":[1,1,1,1]}},
              "mesh":{{"kind":"vertices","units":"texels",{mesh}}},{state}}}]}}],"read":["c"]}}"#
    ))
}

const LIST: &str = r#""topology":"line-list""#;
const HORIZONTAL: &str = r#""positions":[[2.5,4.5,0.5],[13.5,4.5,0.5]]"#;

/// Returns a frame with other texels: for each, its codes.
fn changed(frame: &Frame, codes: impl Fn([u32; 2]) -> Option<u32>) -> Frame {
    let mut frame = frame.clone();
    for (i, texel) in frame.images[0].codes.chunks_exact_mut(4).enumerate() {
        if let Some(code) = codes([i as u32 % 16, i as u32 / 16]) {
            texel.fill(code);
        }
    }
    frame
}

/// Returns the smallest legal and the largest possible number of fragments of a line that lacks some, by an
/// API's musts.
fn gap(scene: &Scene, api: Api, frame: &Frame) -> Option<[usize; 2]> {
    let limits = limits(api);
    let rules = Rules::of(&limits).bound_by(Grade::Proven);
    let legal = legal_set(scene, &limits, &rules);
    let found = line_gap(scene, &limits, &rules, frame, &legal)?;
    assert!(found.wrong.iter().all(|texel| !texel.channels.is_empty()));
    Some(found.fragments)
}

/// The APIs whose texts count fragments.
const COUNTING: [Api; 3] = [Api::Vulkan, Api::OpenGl, Api::OpenGlEs];

#[test]
fn a_line_that_is_missing_is_a_gap() {
    // From 2.5 to 13.5 ten columns are crossed from side to side; one of their fragments may be missing.
    let slanted = r#""positions":[[2.5,2.75,0.5],[13.5,5.25,0.5]]"#;
    for mesh in [HORIZONTAL, slanted] {
        let scene = line(mesh, LIST);
        let drawn = draw(&scene);
        let missing = changed(&drawn, |_| Some(0));
        for api in COUNTING {
            assert_eq!(gap(&scene, api, &drawn), None, "{api}");
            assert_eq!(gap(&scene, api, &missing), Some([9, 0]), "{api}");
        }
        assert_eq!(gap(&scene, Api::WebGpu, &missing), None);
    }
    let vertical = line(r#""positions":[[4.5,6.5,0.5],[4.5,1.5,0.5]]"#, LIST);
    let missing = changed(&draw(&vertical), |_| Some(0));
    for api in COUNTING {
        assert_eq!(gap(&vertical, api, &missing), Some([3, 0]), "{api}");
    }
}

#[test]
fn a_line_may_be_shifted_by_a_texel_and_lack_one_fragment() {
    let scene = line(HORIZONTAL, LIST);
    let drawn = draw(&scene);
    for row in [3, 5] {
        let beside = changed(&drawn, |[x, y]| match y {
            4 => Some(0),
            _ if y == row && (3..13).contains(&x) => Some(255),
            _ => None,
        });
        let two_beside = changed(&drawn, |[x, y]| match y {
            4 => Some(0),
            _ if y + 4 == 2 * row && (3..13).contains(&x) => Some(255),
            _ => None,
        });
        let one_less = changed(&beside, |[x, _]| (x == 7).then_some(0));
        let two_less = changed(&beside, |[x, _]| [7, 9].contains(&x).then_some(0));
        for api in COUNTING {
            assert_eq!(gap(&scene, api, &beside), None, "{api}");
            assert_eq!(gap(&scene, api, &one_less), None, "{api}");
            assert_eq!(gap(&scene, api, &two_less), Some([9, 8]), "{api}");
            assert_eq!(gap(&scene, api, &two_beside), Some([9, 0]), "{api}");
        }
    }
}

#[test]
fn only_fragments_that_change_something_can_be_missing() {
    let never = format!(r#"{LIST},"write_mask":"""#);
    let scissored = format!(r#"{LIST},"scissor":[0,0,16,2]"#);
    let half = format!(r#"{LIST},"scissor":[0,0,8,8]"#);
    for state in [never, scissored] {
        let scene = line(HORIZONTAL, &state);
        for api in APIS {
            assert_eq!(gap(&scene, api, &draw(&scene)), None, "{api} {state}");
        }
    }
    // None of the visible columns, 3 to 7, has a fragment.
    let scene = line(HORIZONTAL, &half);
    let missing = changed(&draw(&scene), |_| Some(0));
    for api in COUNTING {
        let found = gap(&scene, api, &missing).expect("a gap");
        assert!(found[1] < found[0], "{api} {found:?}");
    }
}

#[test]
fn a_line_that_is_clipped_is_not_counted() {
    let beyond = line(r#""positions":[[-8,4.5,0.5],[13.5,4.5,0.5]]"#, LIST);
    let far = line(r#""positions":[[2.5,4.5,-2],[13.5,4.5,0.5]]"#, LIST);
    for scene in [beyond, far] {
        let missing = changed(&draw(&scene), |_| Some(0));
        for api in APIS {
            assert_eq!(gap(&scene, api, &missing), None, "{api}");
        }
    }
}

#[test]
fn an_edge_of_an_outline_is_a_line() {
    let triangle = r#""positions":[[1.5,6.5,0.5],[14.5,6.5,0.5],[14.5,1.5,0.5]]"#;
    let scene = line(triangle, r#""polygon_mode":"line""#);
    let drawn = draw(&scene);
    let without = changed(&drawn, |[_, y]| (y == 6).then_some(0));
    for api in [Api::Vulkan, Api::OpenGl] {
        assert_eq!(gap(&scene, api, &drawn), None, "{api}");
        let [least, most] = gap(&scene, api, &without).expect("a gap");
        assert_eq!(least, 11, "{api}");
        assert!(most < 6, "{api} {most}");
    }
}
