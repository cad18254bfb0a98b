//! Vertices with any w: the rasterizer's pictures of primitives that extend behind the eye are legal.

use crate::common::{APIS, config, draw, limits, scene};
use etalon_frame::compare;
use etalon_reference::judgements;
use etalon_scene::{PrimitiveTopology, Scene};
use proptest::prelude::*;
use proptest::sample::select;

/// Side of the attachments in texels.
const SIZE: u32 = 8;

/// The shaders that show coverage, facing, attributes, depth and w.
const SHADERS: [&str; 11] = [
    "front_facing",
    "flat_color",
    "frag_coord_depth",
    "stepped_perspective",
    "stepped_perspective_centroid",
    "stepped_perspective_sample",
    "stepped_linear",
    "stepped_linear_centroid",
    "stepped_linear_sample",
    "stepped_frag_coord",
    "clip_flat",
];

#[derive(Clone, Debug)]
struct Inputs {
    topology: PrimitiveTopology,
    /// Place in normalized coordinates, depth and w.
    vertices: Vec<([f32; 3], f32)>,
    uv: Vec<[f32; 2]>,
    shader: &'static str,
    samples: u32,
    clamps: bool,
    slope: f32,
    depth: [f32; 2],
}

/// Factors that place positions in front of the eye, behind it, in its plane, near it and far away.
fn w() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => select(vec![1.0_f32, 2.0, 0.5, 4.0, 0.25, 8.0]),
        3 => select(vec![-1.0_f32, -2.0, -0.5, -0.25]),
        1 => select(vec![1e-6_f32, -1e-6, 1e3, -1e3]),
        2 => -3.0_f32..3.0,
    ]
}

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => -1.5_f32..1.5,
        2 => (-8_i8..=8).prop_map(|n| f32::from(n) / 4.0),
        1 => select(vec![-40_000.0_f32, 40_000.0, 3e6, -3e6, 300.0]),
    ]
}

fn depth() -> impl Strategy<Value = f32> {
    prop_oneof![
        5 => 0.0_f32..1.0,
        2 => select(vec![0.0_f32, 1.0, 0.5]),
        2 => -2.0_f32..3.0,
    ]
}

fn inputs() -> impl Strategy<Value = Inputs> {
    let vertex = (coordinate(), coordinate(), depth(), w()).prop_map(|(x, y, z, w)| ([x, y, z], w));
    let uv = (0.0_f32..8.0, -1.0_f32..8.0).prop_map(|(u, v)| [u, v]);
    use PrimitiveTopology::{LineStrip, PointList, TriangleFan, TriangleStrip};
    let topology = prop_oneof![
        1 => select(vec![PointList, LineStrip]),
        4 => select(vec![TriangleStrip, TriangleFan]),
    ];
    (
        (topology, prop::collection::vec((vertex, uv), 3..6)),
        select(SHADERS.as_slice()),
        select(vec![1_u32, 1, 4]),
        any::<bool>(),
        prop_oneof![2 => Just(0.0_f32), 1 => select(vec![1.0_f32, -1.0])],
        select(vec![[0.0_f32, 1.0], [0.0, 1.0], [0.25, 0.75], [1.0, 0.0]]),
    )
        .prop_map(
            |((topology, points), shader, samples, clamps, slope, depth)| {
                let (vertices, uv) = points.into_iter().unzip();
                Inputs {
                    topology,
                    vertices,
                    uv,
                    shader,
                    samples,
                    clamps,
                    slope,
                    // The rasterizer clamps a biased depth to the viewport's range, which not every API allows.
                    depth: if slope == 0.0 { depth } else { [0.0, 1.0] },
                }
            },
        )
}

fn scene_of(inputs: &Inputs) -> Scene {
    let positions: Vec<[f32; 4]> = inputs
        .vertices
        .iter()
        .map(|([x, y, z], w)| [x * w, y * w, z * w, *w])
        .collect();
    let values: Vec<[f32; 4]> = (0..positions.len())
        .map(|i| [i % 2, i / 2 % 2, i / 4 % 2, 1].map(|bit| bit as f32))
        .collect();
    let samples = inputs.samples;
    scene(&format!(
        r#"{{"attachments":{{
              "color":{{"format":"rgba8unorm","size":[{SIZE},{SIZE}],"samples":{samples},"clear":[0,0,0,0]}},
              "depth":{{"format":"depth24plus-stencil8","samples":{samples},"clear":{{"depth":0.5,"stencil":0}}}}}},
            "passes":[{{"color":["color"],"depth_stencil":"depth","draws":[{{
              "mesh":{{"kind":"vertices","positions":{positions:?},"values":{values:?},"uv":{uv:?}}},
              "topology":"{topology}","shader":"{shader}","provoking":"first",
              "params":{{"color":[4,7,0,1],"back_color":[0,0,1,1]}},
              "depth_clamp":{clamps},"depth_bias":{{"slope":{slope:?}}},
              "viewport":{{"rect":[0,0,{SIZE},{SIZE}],"depth":{depth:?}}},
              "depth":{{"compare":"less","write":true}},
              "stencil":{{"front":{{"compare":"always","pass_op":"increment-wrap","depth_fail_op":"increment-wrap"}},
                          "back":{{"compare":"always","pass_op":"decrement-wrap","depth_fail_op":"decrement-wrap"}}}}}}]}}],
            "read":["color","depth"]}}"#,
        uv = inputs.uv,
        topology = inputs.topology,
        shader = inputs.shader,
        clamps = inputs.clamps,
        slope = inputs.slope,
        depth = inputs.depth,
    ))
}

fn assert_legal(inputs: &Inputs) -> Result<(), TestCaseError> {
    let scene = scene_of(inputs);
    let frame = draw(&scene);
    for api in APIS {
        let judgement = judgements(&scene, &limits(api)).remove(0);
        let found = compare(&frame, &judgement.legal, &judgement.yardstick, 4).expect("images");
        prop_assert_eq!(found.texels.wrong, 0, "{}: {:?}", api, found);
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(400))]

    #[test]
    fn frames_of_geometry_behind_the_eye_are_legal(inputs in inputs()) {
        let eye = |([x, y, _], w): &([f32; 3], f32)| [x * w, y * w, *w] == [0.0; 3];
        prop_assume!(!inputs.vertices.iter().any(eye));
        assert_legal(&inputs)?;
    }
}
