//! Small random scenes, as the JSON of a case file.

use etalon_scene::{
    BlendFactor, BlendOperation, CompareFunction, CullMode, FrontFace, StencilOperation,
};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{select, subsequence};

/// The inputs from which a scene is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Inputs {
    /// Anything.
    Any,
    /// Inputs that every rule pins: zeros, ones, integers, edges away from samples.
    Pinned,
}

/// Returns a number as JSON. A wild one can be outside 0 to 1, if the inputs are not pinned.
pub(crate) fn number(inputs: Inputs, wild: bool) -> BoxedStrategy<String> {
    let sharp = select(vec![0.0_f32, 1.0]);
    match inputs {
        Inputs::Pinned => sharp.prop_map(|v| format!("{v:?}")).boxed(),
        Inputs::Any => {
            let most = if wild { 2.0_f32 } else { 1.0 };
            let least = if wild { -1.0_f32 } else { 0.0 };
            prop_oneof![
                2 => sharp,
                2 => select(vec![0.25_f32, 0.5, 0.75, 0.2, 0.6]),
                1 => (0_u8..=255).prop_map(|c| f32::from(c) / 255.0),
                2 => least..=most,
            ]
            .prop_map(|v| format!("{v:?}"))
            .boxed()
        }
    }
}

pub(crate) fn four(inputs: Inputs, wild: bool) -> BoxedStrategy<String> {
    let n = || number(inputs, wild);
    [n(), n(), n(), n()]
        .prop_map(|v| format!("[{}]", v.join(",")))
        .boxed()
}

pub(crate) fn list(
    item: BoxedStrategy<String>,
    count: std::ops::RangeInclusive<usize>,
) -> BoxedStrategy<String> {
    vec(item, count)
        .prop_map(|v| format!("[{}]", v.join(",")))
        .boxed()
}

pub(crate) fn winding() -> impl Strategy<Value = String> {
    select(FrontFace::ALL).prop_map(|f| format!("\"{}\"", f.name()))
}

fn depths(inputs: Inputs) -> BoxedStrategy<String> {
    match inputs {
        Inputs::Any => number(inputs, false),
        // The viewport transform may move any other vertex depth.
        Inputs::Pinned => Just("0".to_owned()).boxed(),
    }
}

/// A mesh, and whether it consists of loose vertices.
fn mesh(inputs: Inputs, size: [u32; 2]) -> BoxedStrategy<(String, bool)> {
    let [w, h] = size;
    let values = || four(inputs, false);
    let full = (values(), depths(inputs), winding())
        .prop_map(|(v, z, f)| format!(r#"{{"kind":"full","value":{v},"z":{z},"winding":{f}}}"#));
    let rect = (values(), depths(inputs), winding(), 0..w, 0..h).prop_flat_map(
        move |(v, z, f, left, top)| {
            (left + 1..=w, top + 1..=h).prop_map(move |(right, bottom)| {
                format!(
                    r#"{{"kind":"rect","texels":[{left},{top},{right},{bottom}],"value":{v},"z":{z},"winding":{f}}}"#
                )
            })
        },
    );
    let bands = (
        select(vec!["columns", "rows"]),
        list(values(), 1..=w.min(h).min(4) as usize),
        list(depths(inputs), 1..=3),
        list(winding().boxed(), 1..=2),
    )
        .prop_map(|(kind, v, z, f)| {
            format!(r#"{{"kind":"{kind}","values":{v},"z":{z},"windings":{f}}}"#)
        });
    let whole = prop_oneof![1 => full, 2 => rect, 2 => bands].prop_map(|mesh| (mesh, false));
    if inputs == Inputs::Pinned {
        return whole.boxed();
    }
    // Texel corners and centres, snapping ties, and anything.
    let coordinate = prop_oneof![
        (0_i32..=16).prop_map(|i| (i - 8) as f32 / 8.0),
        (-300_i32..=300).prop_map(|i| i as f32 / 256.0),
        -1.5_f32..=1.5,
    ];
    let vertex = ([coordinate.clone(), coordinate], depths(inputs))
        .prop_map(|([x, y], z)| format!("[{x:?},{y:?},{z}]"))
        .boxed();
    let loose = (list(vertex, 3..=7), list(values(), 1..=3))
        .prop_map(|(p, v)| format!(r#"{{"kind":"vertices","positions":{p},"values":{v}}}"#));
    prop_oneof![5 => whole, 2 => loose.prop_map(|mesh| (mesh, true))].boxed()
}

pub(crate) fn blend(inputs: Inputs) -> BoxedStrategy<String> {
    let operations = match inputs {
        Inputs::Any => BlendOperation::ALL.to_vec(),
        // The error of 1 - 1 is relative to its sides, so no rule pins it to 0.
        Inputs::Pinned => vec![
            BlendOperation::Add,
            BlendOperation::Min,
            BlendOperation::Max,
        ],
    };
    let factors: Vec<BlendFactor> = BlendFactor::ALL
        .iter()
        .copied()
        .filter(|f| !f.is_second_source())
        .collect();
    let part =
        (select(operations), select(factors.clone()), select(factors)).prop_map(|(o, s, d)| {
            format!(
                r#"{{"operation":"{}","src_factor":"{}","dst_factor":"{}"}}"#,
                o.name(),
                s.name(),
                d.name()
            )
        });
    (part.clone(), part, four(inputs, false))
        .prop_map(|(c, a, k)| {
            format!(r#","blend":{{"color":{c},"alpha":{a}}},"blend_constant":{k}"#)
        })
        .boxed()
}

pub(crate) fn stencil() -> BoxedStrategy<String> {
    let op = || select(StencilOperation::ALL).prop_map(StencilOperation::name);
    let face = (
        select(CompareFunction::ALL),
        [op(), op(), op()],
        proptest::option::of((any::<u8>(), any::<u8>(), any::<u8>())),
    )
        .prop_map(|(compare, [fail, depth_fail, pass], masks)| {
            let keys = masks.map_or(String::new(), |(r, w, v)| {
                format!(r#","read_mask":{r},"write_mask":{w},"reference":{v}"#)
            });
            format!(
                r#"{{"compare":"{}","fail_op":"{fail}","depth_fail_op":"{depth_fail}","pass_op":"{pass}"{keys}}}"#,
                compare.name()
            )
        });
    (
        face.clone(),
        proptest::option::of(face),
        select(vec![0xff_u8, 0x0f, 0xf0, 0]),
        select(vec![0xff_u8, 0x3c, 0]),
        any::<u8>(),
    )
        .prop_map(|(front, back, read, write, reference)| {
            let back = back.map_or(String::new(), |b| format!(r#","back":{b}"#));
            format!(
                r#","stencil":{{"front":{front}{back},"read_mask":{read},"write_mask":{write},"reference":{reference}}}"#
            )
        })
        .boxed()
}

/// Returns nothing or a value of the strategy, as a piece of JSON.
pub(crate) fn maybe(enabled: bool, some: BoxedStrategy<String>) -> BoxedStrategy<String> {
    if enabled {
        prop_oneof![1 => Just(String::new()), 2 => some].boxed()
    } else {
        Just(String::new()).boxed()
    }
}

fn draw(
    inputs: Inputs,
    size: [u32; 2],
    has_depth: bool,
    has_stencil: bool,
    writes_floats: bool,
) -> BoxedStrategy<String> {
    let shaders = if writes_floats {
        vec![("texel_color_all", r#","textures":["source"]"#)]
    } else {
        vec![
            ("flat_color", ""),
            ("flat_color_depth", ""),
            ("flat_color_depth", ""),
            ("front_facing", ""),
            ("texel_color", r#","textures":["source"]"#),
            ("uniform_color", ""),
        ]
    };
    let depth = (select(CompareFunction::ALL), any::<bool>())
        .prop_map(|(c, w)| format!(r#","depth":{{"compare":"{}","write":{w}}}"#, c.name()))
        .boxed();
    let mask = subsequence(vec!['r', 'g', 'b', 'a'], 0..=4)
        .prop_map(|letters| letters.into_iter().collect::<String>());
    let mask = prop_oneof![Just("rgba".to_owned()), mask];
    let cull = prop_oneof![3 => Just(CullMode::None), 2 => select(CullMode::ALL)];
    (
        mesh(inputs, size),
        select(shaders),
        [four(inputs, true), four(inputs, true)],
        maybe(has_depth, depth),
        maybe(has_stencil, stencil()),
        maybe(true, blend(inputs)),
        mask,
        (cull, select(FrontFace::ALL), any::<bool>()),
    )
        .prop_map(
            |((mesh, is_loose), (shader, textures), [color, back], depth, stencil, blend, mask, state)| {
                let (cull, front, strip) = state;
                let topology = if strip && is_loose {
                    "triangle-strip"
                } else {
                    "triangle-list"
                };
                format!(
                    r#"{{"mesh":{mesh},"topology":"{topology}","shader":"{shader}"{textures},"params":{{"color":{color},"back_color":{back}}},"cull":"{}","front_face":"{}","write_mask":"{mask}"{depth}{stencil}{blend}}}"#,
                    cull.name(),
                    front.name()
                )
            },
        )
        .boxed()
}

/// Returns the body of a scene: one pass of a few draws, with all attachments read back.
pub(crate) fn body(inputs: Inputs) -> BoxedStrategy<String> {
    let sizes = select(vec![[4_u32, 4], [8, 8], [5, 3], [1, 1]]);
    let formats = select(vec![
        ("depth16unorm", true, false),
        ("depth24plus", true, false),
        ("depth32float", true, false),
        ("depth24plus-stencil8", true, true),
        ("depth24plus-stencil8", true, true),
        ("depth32float-stencil8", true, true),
        ("stencil8", false, true),
    ]);
    (sizes, formats, any::<bool>())
        .prop_flat_map(move |(size, (format, has_depth, has_stencil), floats)| {
            let floats = floats && inputs == Inputs::Any;
            let [w, h] = size;
            let codes = match inputs {
                Inputs::Any => (0_u8..=255).boxed(),
                Inputs::Pinned => select(vec![0_u8, 255]).boxed(),
            };
            let texel = [codes.clone(), codes.clone(), codes.clone(), codes]
                .prop_map(|v| format!("{v:?}"))
                .boxed();
            let upload = list(texel, h as usize..=h as usize)
                .prop_map(|rows| format!(r#""texels":{{"kind":"rows","values":{rows}}}"#));
            let clear = four(inputs, true).prop_map(|c| format!(r#""clear":{c}"#));
            let start = prop_oneof![clear, upload];
            let depth_clear = (number(inputs, false), any::<u8>()).prop_map(move |(d, s)| {
                match (has_depth, has_stencil) {
                    (true, true) => format!(r#"{{"depth":{d},"stencil":{s}}}"#),
                    (true, false) => d,
                    _ => s.to_string(),
                }
            });
            let source = list(four(inputs, true), w as usize..=w as usize);
            let draws = list(draw(inputs, size, has_depth, has_stencil, floats), 1..=4);
            (start, depth_clear, source, draws).prop_map(move |(start, clear, source, draws)| {
                let extra = if floats {
                    r#","floats":{"format":"rgba32float"}"#
                } else {
                    ""
                };
                let name = if floats { r#","floats""# } else { "" };
                format!(
                    r#"{{"attachments":{{
"color":{{"format":"rgba8unorm","size":[{w},{h}],{start}}}{extra},
"depth":{{"format":"{format}","size":[{w},{h}],"clear":{clear}}},
"source":{{"format":"rgba32float","size":[{w},{h}],"texels":{{"kind":"columns","values":{source}}}}}}},
"passes":[{{"color":["color"{name}],"depth_stencil":"depth","draws":{draws}}}],
"read":["color"{name},"depth"]}}"#
                )
            })
        })
        .boxed()
}
