//! Random scenes from the whole model: formats, samples, viewports, every topology, every state.

use crate::scenes::{Inputs, blend, four, list, maybe, number, stencil, winding};
use etalon_scene::{
    BlendFactor, BlendOperation, CompareFunction, CullMode, FrontFace, LogicOperation,
};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

/// The attachments of a scene.
#[derive(Clone, Copy, Debug)]
struct Ground {
    size: [u32; 2],
    samples: u32,
    targets: usize,
    has_depth: bool,
    has_stencil: bool,
}

const FORMATS: [&str; 12] = [
    "r8unorm",
    "rg8unorm",
    "rgba8unorm",
    "rgba8unorm-srgb",
    "bgra8unorm",
    "rgba8snorm",
    "rgb10a2unorm",
    "b5g6r5unorm",
    "bgr5a1unorm",
    "bgra4unorm",
    "rg11b10ufloat",
    "rgba16float",
];

fn unit() -> BoxedStrategy<String> {
    number(Inputs::Any, false)
}

/// The position of a vertex: clip space inside and outside of the viewport, texel centres and corners.
fn coordinate() -> BoxedStrategy<String> {
    prop_oneof![
        3 => (0_i32..=16).prop_map(|i| (i - 8) as f32 / 8.0),
        2 => (-300_i32..=300).prop_map(|i| i as f32 / 256.0),
        1 => -1.5_f32..=1.5,
    ]
    .prop_map(|v| format!("{v:?}"))
    .boxed()
}

/// Topology and mesh.
fn mesh() -> BoxedStrategy<(&'static str, String)> {
    let z = prop_oneof![3 => unit(), 1 => select(vec!["-0.3", "1.25"]).prop_map(str::to_owned)];
    let vertex = (coordinate(), coordinate(), z)
        .prop_map(|(x, y, z)| format!("[{x},{y},{z}]"))
        .boxed();
    let index = prop_oneof![6 => (0_u32..3).prop_map(|i| i.to_string()), 1 => Just("null".into())];
    let topologies = vec![
        "point-list",
        "line-list",
        "line-strip",
        "triangle-list",
        "triangle-list",
        "triangle-strip",
        "triangle-fan",
    ];
    let value = || four(Inputs::Any, false);
    let loose = (
        select(topologies),
        list(vertex, 3..=5),
        list(value(), 1..=3),
        proptest::option::of(vec(index, 3..=6)),
    )
        .prop_map(|(topology, positions, values, indices)| {
            let indices = match indices {
                // A list has no restart index.
                Some(listed) if topology.ends_with("strip") || topology.ends_with("fan") => {
                    format!(r#","indices":[{}]"#, listed.join(","))
                }
                _ => String::new(),
            };
            let mesh = format!(
                r#"{{"kind":"vertices","positions":{positions},"values":{values}{indices}}}"#
            );
            (topology, mesh)
        });
    let covered = (value(), unit(), winding(), any::<bool>()).prop_map(|(v, z, f, cover)| {
        let mesh = if cover {
            format!(r#"{{"kind":"cover","value":{v},"z":{z}}}"#)
        } else {
            format!(r#"{{"kind":"full","value":{v},"z":{z},"winding":{f}}}"#)
        };
        ("triangle-list", mesh)
    });
    prop_oneof![1 => covered, 2 => loose].boxed()
}

/// Viewport, depth range and clamp, bias, bounds and scissor rectangle. If a depth can leave the viewport's
/// range, the specifications differ, and one rasterizer cannot follow all of them.
fn raster(ground: Ground, written_depth: bool) -> BoxedStrategy<String> {
    let [w, h] = ground.size.map(|v| v as f32);
    let edge = move |length: f32| {
        prop_oneof![
            (0_i32..=16).prop_map(move |i| length * i as f32 / 16.0),
            -2.0_f32..length,
        ]
    };
    let ends = prop_oneof![
        Just([0.0_f32, 1.0]),
        Just([1.0, 0.0]),
        Just([0.25, 0.75]),
        [0.0_f32..=1.0, 0.0_f32..=1.0],
    ];
    let viewport = (edge(w), edge(h), 1.0_f32..w + 2.0, 1.0_f32..h + 2.0, ends);
    let bias = (
        select(vec![0_i32, 1, -1, 16, -300, 70000]),
        select(vec![0.0_f32, 1.0, -1.5, 0.25]),
        select(vec![0.0_f32, 0.0, 0.001, -0.001]),
    );
    let scissor = [0..=ground.size[0], 0..=ground.size[1], 0..=9, 0..=9];
    let bounds = (unit(), unit()).prop_map(|(a, b)| {
        let (x, y): (f32, f32) = (a.parse().unwrap_or(0.0), b.parse().unwrap_or(1.0));
        format!(r#","depth_bounds":[{:?},{:?}]"#, x.min(y), x.max(y))
    });
    (
        proptest::option::of(viewport),
        proptest::option::of(bias),
        proptest::option::of(scissor),
        maybe(true, bounds.boxed()),
        any::<bool>(),
    )
        .prop_map(move |(viewport, bias, scissor, bounds, clamp)| {
            let mut text = bounds;
            let mut narrowed = false;
            if let Some((x, y, w, h, mut depth)) = viewport {
                if (written_depth || bias.is_some()) && !clamp {
                    depth = [0.0, 1.0];
                }
                narrowed = depth != [0.0, 1.0];
                text += &format!(
                    r#","viewport":{{"rect":[{x:?},{y:?},{w:?},{h:?}],"depth":{depth:?}}}"#
                );
            }
            if let Some((constant, slope, most)) = bias {
                text += &format!(
                    r#","depth_bias":{{"constant":{constant},"slope":{slope:?},"clamp":{most:?}}}"#
                );
            }
            if let Some([x, y, w, h]) = scissor {
                text += &format!(r#","scissor":[{x},{y},{w},{h}]"#);
            }
            if clamp || narrowed && written_depth {
                text += r#","depth_clamp":true"#;
            }
            text
        })
        .boxed()
}

/// Blending with two sources.
fn dual() -> BoxedStrategy<String> {
    let part = (
        select(BlendOperation::ALL),
        select(BlendFactor::ALL),
        select(BlendFactor::ALL),
    )
        .prop_map(|(o, s, d)| {
            format!(
                r#"{{"operation":"{}","src_factor":"{}","dst_factor":"{}"}}"#,
                o.name(),
                s.name(),
                d.name()
            )
        });
    (part.clone(), part)
        .prop_map(|(c, a)| format!(r#","blend":{{"color":{c},"alpha":{a}}}"#))
        .boxed()
}

/// Colour output: blending, a logic operation, or a state per target.
fn colors(ground: Ground, dual_source: bool) -> BoxedStrategy<String> {
    if dual_source {
        return dual();
    }
    let logic = select(LogicOperation::ALL)
        .prop_map(|o| format!(r#","logic":"{}""#, o.name()))
        .boxed();
    let mask = select(vec!["rgba", "rgb", "a", "rb", ""]);
    let plain = mask.clone().prop_map(|m| format!(r#","write_mask":"{m}""#));
    if ground.targets == 1 {
        return prop_oneof![2 => blend(Inputs::Any), 1 => logic, 1 => plain].boxed();
    }
    let target = (proptest::option::of(dual_free()), mask)
        .prop_map(|(blend, mask)| {
            let blend = blend.map_or(String::new(), |b| format!(r#""blend":{b},"#));
            format!(r#"{{{blend}"write_mask":"{mask}"}}"#)
        })
        .boxed();
    let each = list(target, ground.targets..=ground.targets)
        .prop_map(|targets| format!(r#","targets":{targets},"blend_constant":[0.2,0.4,0.6,0.8]"#));
    prop_oneof![3 => each, 1 => logic].boxed()
}

fn dual_free() -> BoxedStrategy<String> {
    blend(Inputs::Any)
        .prop_map(|text| {
            let start = text.find('{').unwrap_or(0);
            let end = text.find(r#","blend_constant""#).unwrap_or(text.len());
            text[start..end].to_owned()
        })
        .boxed()
}

fn multisample() -> BoxedStrategy<String> {
    (
        select(vec![u32::MAX, 0, 1, 0b0110, 0b1010_0101]),
        any::<bool>(),
        any::<bool>(),
    )
        .prop_map(|(mask, coverage, to_one)| {
            format!(
                r#","multisample":{{"mask":{mask},"alpha_to_coverage":{coverage},"alpha_to_one":{to_one}}}"#
            )
        })
        .boxed()
}

fn draw(ground: Ground) -> BoxedStrategy<String> {
    let shaders = if ground.targets > 1 {
        vec![
            ("texel_color_all", r#","textures":["source"]"#),
            ("dual_peel", r#","textures":["source","second"]"#),
        ]
    } else {
        vec![
            ("flat_color", ""),
            ("flat_color_depth", ""),
            ("frag_coord_depth", ""),
            ("sample_index", ""),
            ("sample_depth", ""),
            ("counted_color", r#","counters":["runs","passed"]"#),
            (
                "counted_discard",
                r#","textures":["source"],"counters":["passed","runs"]"#,
            ),
            (
                "texel_discard",
                r#","textures":["source"],"counters":["any"]"#,
            ),
            ("front_facing", ""),
            ("depth_grey", ""),
            ("depth_linearized", ""),
            ("depth_range", ""),
            ("edge_alpha", ""),
            ("expensive_color", ""),
            ("expensive_depth", ""),
            ("expensive_discard", ""),
            ("fog", ""),
            ("hashed_color", ""),
            ("linear_depth", ""),
            ("logarithmic_depth", ""),
            ("stochastic", r#","textures":["source"]"#),
            ("weighted_resolve", r#","textures":["source","second"]"#),
            ("texel_color", r#","textures":["source"]"#),
            ("texel_dual_source", r#","textures":["source","second"]"#),
            ("uniform_color", ""),
        ]
    };
    select(shaders)
        .prop_flat_map(move |(shader, textures)| {
            let written = shader.ends_with("depth");
            let depth = (select(CompareFunction::ALL), any::<bool>())
                .prop_map(|(c, w)| format!(r#","depth":{{"compare":"{}","write":{w}}}"#, c.name()));
            let outline = prop_oneof![4 => Just(""), 1 => Just(r#","polygon_mode":"line""#)];
            let thrown = prop_oneof![
                9 => Just(""),
                1 => Just(r#","rasterizer_discard":true"#)
            ];
            let early = prop_oneof![
                3 => Just(""),
                1 => Just(r#","early_tests":"forced""#)
            ];
            let cull = prop_oneof![3 => Just(CullMode::None), 2 => select(CullMode::ALL)];
            (
                mesh(),
                [four(Inputs::Any, true), four(Inputs::Any, true)],
                maybe(ground.has_depth, depth.boxed()),
                maybe(ground.has_stencil, stencil()),
                maybe(true, colors(ground, shader == "texel_dual_source")),
                raster(ground, written),
                maybe(ground.samples > 1, multisample()),
                (cull, select(FrontFace::ALL), outline, thrown, early),
            )
                .prop_map(
                    move |((topology, mesh), [color, back], depth, stencil, colors, raster, samples, state)| {
                        let (cull, front, outline, thrown, early) = state;
                        // Edges that are drawn twice may be blended twice or not, so only opaque ones.
                        let opaque = outline.is_empty() || !colors.contains("blend");
                        let outline = if opaque { outline } else { "" };
                        format!(
                            r#"{{"mesh":{mesh},"topology":"{topology}","shader":"{shader}"{textures},"params":{{"color":{color},"back_color":{back}}},"cull":"{}","front_face":"{}"{outline}{thrown}{early}{depth}{stencil}{colors}{raster}{samples}}}"#,
                            cull.name(),
                            front.name()
                        )
                    },
                )
        })
        .boxed()
}

/// The body of a scene of the whole model.
pub(crate) fn body() -> BoxedStrategy<String> {
    let depths = select(vec![
        ("depth16unorm", true, false),
        ("depth24plus", true, false),
        ("depth32float", true, false),
        ("depth24plus-stencil8", true, true),
        ("depth32float-stencil8", true, true),
        ("stencil8", false, true),
    ]);
    (
        select(vec![[4_u32, 4], [8, 8], [5, 3], [1, 1]]),
        select(vec![1_u32, 1, 2, 4, 8]),
        prop_oneof![3 => Just(1_usize), 1 => 2_usize..=3],
        depths,
    )
        .prop_flat_map(|(size, samples, targets, (format, has_depth, has_stencil))| {
            let ground = Ground {
                size,
                samples,
                targets,
                has_depth,
                has_stencil,
            };
            (
                vec((select(FORMATS.to_vec()), four(Inputs::Any, true)), targets),
                (unit(), any::<u8>()),
                [
                    list(four(Inputs::Any, true), size[0] as usize..=size[0] as usize),
                    list(four(Inputs::Any, true), size[0] as usize..=size[0] as usize),
                ],
                list(draw(ground), 1..=3),
            )
                .prop_map(move |(colors, (depth, stencil), [first, second], draws)| {
                    let clear = match (has_depth, has_stencil) {
                        (true, true) => format!(r#"{{"depth":{depth},"stencil":{stencil}}}"#),
                        (true, false) => depth,
                        _ => stencil.to_string(),
                    };
                    let [w, h] = size;
                    let mut attachments = String::new();
                    let (mut names, mut resolved) = (Vec::new(), Vec::new());
                    for (i, (format, clear)) in colors.iter().enumerate() {
                        attachments += &format!(
                            r#""c{i}":{{"format":"{format}","size":[{w},{h}],"samples":{samples},"clear":{clear}}},
"#
                        );
                        names.push(format!(r#""c{i}""#));
                        if samples > 1 {
                            attachments += &format!(
                                r#""r{i}":{{"format":"{format}","size":[{w},{h}]}},
"#
                            );
                            resolved.push(format!(r#""r{i}""#));
                        }
                    }
                    let read: Vec<String> = names.iter().chain(&resolved).cloned().collect();
                    let (names, resolved) = (names.join(","), resolved.join(","));
                    format!(
                        r#"{{"attachments":{{{attachments}"depth":{{"format":"{format}","size":[{w},{h}],"samples":{samples},"clear":{clear}}},
"second":{{"format":"rgba32float","size":[{w},{h}],"texels":{{"kind":"columns","values":{second}}}}},
"source":{{"format":"rgba32float","size":[{w},{h}],"texels":{{"kind":"columns","values":{first}}}}}}},
"passes":[{{"color":[{names}],"resolve":[{resolved}],"depth_stencil":"depth","draws":{draws}}}],
"counters":{{"any":"any-samples-passed","passed":"samples-passed","runs":"shader-runs"}},
"read":[{},"depth"]}}"#,
                        read.join(",")
                    )
                })
        })
        .boxed()
}
