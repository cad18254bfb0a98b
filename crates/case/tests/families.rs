//! What the built-in families of cases promise, checked with a plain simulation of the pipeline
//! that shares nothing with the one that judges: single samples, one value per channel, codes
//! rounded to the nearest.

use etalon_case::scene::{Contents, Draw, StencilFace};
use etalon_case::state::{
    BlendComponent, BlendFactor, BlendOperation, CompareFunction, CullMode, FrontFace, Shader,
    StencilOperation,
};
use etalon_case::{Case, Library, Scene};
use etalon_frame::{ChannelEncoding, TextureFormat};
use std::collections::{BTreeMap, BTreeSet};

fn cases(prefix: &str) -> Vec<Case> {
    let library = Library::built_in().expect("built-in files parse");
    library
        .cases()
        .filter(|c| c.id().starts_with(prefix))
        .map(|c| c.build().expect("built-in cases build"))
        .collect()
}

#[test]
fn every_area_holds_its_cases() {
    let library = Library::built_in().expect("built-in files parse");
    let mut counts = BTreeMap::new();
    for case in library.cases() {
        let id = case.id();
        let area = id.split('/').next().expect("an id has an area").to_owned();
        *counts.entry(area).or_insert(0) += 1;
    }
    let due = [
        ("depth", 230),
        ("stencil", 876),
        ("blend", 1363),
        ("cull", 41),
        ("selftest", 48),
    ];
    for (area, least) in due {
        let count = counts.get(area).copied().unwrap_or(0);
        assert!(
            count >= least,
            "{area}: {count} cases, {least} are promised"
        );
    }
    assert!(counts.values().sum::<i32>() >= 1500);
}

#[test]
fn every_file_says_what_it_proves_and_by_which_clauses() {
    let library = Library::built_in().expect("built-in files parse");
    let apis = ["Vulkan", "OpenGL 4.6", "OpenGL ES 3.2", "WebGPU"];
    for file in library.files() {
        let first = file.cases().next().expect("a file holds a case");
        let case = first.build().expect("built-in cases build");
        assert!(case.about.ends_with('.'), "{}: {}", file.name(), case.about);
        assert!(!case.spec.is_empty(), "{} names no clause", file.name());
        for clause in &case.spec {
            let (api, section) = clause.split_once(": ").unwrap_or_default();
            assert!(apis.contains(&api), "{}: {clause}", file.name());
            assert!(!section.is_empty(), "{}: {clause}", file.name());
        }
    }
}

#[test]
fn a_case_needs_few_pipelines() {
    for case in cases("") {
        let mut pipelines: Vec<Draw> = Vec::new();
        for draw in case.scene.passes.iter().flat_map(|p| &p.draws) {
            let mut state = draw.clone();
            state.mesh.vertices.clear();
            state.params = Default::default();
            state.blend_constant = [0.0; 4];
            if let Some(stencil) = &mut state.stencil {
                stencil.front.reference = 0;
                stencil.back.reference = 0;
            }
            if !pipelines.contains(&state) {
                pipelines.push(state);
            }
        }
        assert!(pipelines.len() <= 2, "{}: {}", case.id, pipelines.len());
    }
}

#[test]
fn no_edge_comes_near_a_texel_centre() {
    let mut seen = BTreeSet::new();
    for case in cases("") {
        for (pass, draw) in draws(&case.scene) {
            let size = case.scene.attachments[pass.color[0]].size;
            if !seen.insert((size, draw.mesh.bytes().to_vec())) {
                continue;
            }
            for corners in triangles(draw, size) {
                for i in 0..3 {
                    let least = distance_from_centres(corners[i], corners[(i + 1) % 3], size);
                    assert!(
                        least > 0.17,
                        "{}: an edge passes at {least} texels",
                        case.id
                    );
                }
            }
        }
    }
}

#[test]
fn alpha_is_never_blended_as_colour_is() {
    let cases = cases("blend/factors/");
    assert_eq!(cases.len(), 5 * 15 * 15);
    let mut color = BTreeSet::new();
    let mut alpha = BTreeSet::new();
    let key = |c: BlendComponent| (c.operation, c.src_factor, c.dst_factor);
    for case in &cases {
        let draw = &case.scene.passes[0].draws[0];
        let blend = draw.targets[0].blend.expect("the family blends");
        assert_ne!(blend.color.operation, blend.alpha.operation, "{}", case.id);
        let pairs = [
            (blend.color.src_factor, blend.alpha.src_factor),
            (blend.color.dst_factor, blend.alpha.dst_factor),
        ];
        for (c, a) in pairs {
            assert_ne!(c, a, "{}", case.id);
            let texel = [0.2, 0.4, 0.6, 0.8];
            let other = [0.3, 0.7, 0.1, 0.45];
            let constant = [0.9, 0.35, 0.15, 0.65];
            let [c, a] = [c, a].map(|f| factor(f, texel, other, constant, 3));
            assert_ne!(c, a, "{}: both mean the same for alpha", case.id);
        }
        color.insert(key(blend.color));
        alpha.insert(key(blend.alpha));
        let constant = draw.blend_constant;
        assert!(constant.iter().all(|v| *v > 0.0 && *v < 1.0));
        let distinct: BTreeSet<_> = constant.iter().map(|v| v.to_bits()).collect();
        assert_eq!(distinct.len(), 4, "{}", case.id);
    }
    assert_eq!(color.len(), 1125);
    assert_eq!(alpha.len(), 1125);
}

#[test]
fn stencil_operations_take_every_path_from_every_stored_value() {
    let cases = cases("stencil/operations/");
    assert_eq!(cases.len(), 512);
    let key = |f: &StencilFace| (f.fail_op, f.depth_fail_op, f.pass_op);
    let mut front = BTreeSet::new();
    let mut back = BTreeSet::new();
    for case in &cases {
        let tested = case.scene.passes[0].draws.last().expect("draws");
        let stencil = tested.stencil.expect("the family tests stencil");
        let (f, b) = (key(&stencil.front), key(&stencil.back));
        assert!(f.0 != b.0 && f.1 != b.1 && f.2 != b.2, "{}", case.id);
        let mask = stencil.front.write_mask;
        assert!(mask != 0 && mask != 0xff, "{}", case.id);
        front.insert(f);
        back.insert(b);

        let mut inputs: BTreeMap<(bool, Path), Vec<(u8, u8)>> = BTreeMap::new();
        simulate(&case.scene, &mut |event| {
            if event.draw.depth.is_some() {
                let face = event.face.expect("the family tests stencil");
                let list = inputs.entry((event.front, event.path)).or_default();
                list.push((event.stored, face.reference));
            }
        });
        for is_front in [true, false] {
            for path in [Path::Fail, Path::DepthFail, Path::Pass] {
                let list = inputs.remove(&(is_front, path)).unwrap_or_default();
                let stored: BTreeSet<u8> = list.iter().map(|(stored, _)| *stored).collect();
                let due = BTreeSet::from([0, 1, 90, 127, 128, 165, 254, 255]);
                assert_eq!(stored, due, "{}: {is_front} {path:?}", case.id);
                // Whichever two operations are confused, some texel tells them apart.
                for a in StencilOperation::ALL {
                    for b in StencilOperation::ALL.iter().filter(|b| *b != a) {
                        let told = list.iter().any(|(stored, reference)| {
                            let [a, b] = [a, b].map(|op| operate(*op, *stored, *reference, mask));
                            a != b
                        });
                        assert!(told, "{}: {a:?} and {b:?} look the same", case.id);
                    }
                }
            }
        }
    }
    assert_eq!(front.len(), 512);
    assert_eq!(back.len(), 512);
}

#[test]
fn a_wrong_compare_function_shows() {
    for family in [
        "depth/compare/",
        "depth/depth32float-exact/",
        "depth/fixed-function/",
    ] {
        for case in cases(family) {
            every_other_compare_shows(&case, |draw| {
                &mut draw.depth.as_mut().expect("the family tests depth").compare
            });
        }
    }
    for case in cases("stencil/compare/") {
        // With an empty read mask 0 is compared with 0, and some functions agree.
        if !case.id.ends_with("read_mask=0x00") {
            every_other_compare_shows(&case, |draw| {
                let stencil = draw.stencil.as_mut().expect("the family tests stencil");
                &mut stencil.front.compare
            });
        }
    }
}

/// The tested draws of these families are red, the ones before them blue.
fn every_other_compare_shows(case: &Case, compare: fn(&mut Draw) -> &mut CompareFunction) {
    let right = plain(&case.scene);
    for other in CompareFunction::ALL {
        let mut wrong = case.scene.clone();
        let tested = wrong.passes[0].draws.iter_mut();
        for draw in tested.filter(|d| d.params.color[0] == 1.0) {
            *compare(draw) = *other;
        }
        if wrong != case.scene {
            assert!(
                right != plain(&wrong),
                "{}: {other:?} looks the same",
                case.id
            );
        }
    }
}

#[test]
fn a_wrong_bit_of_a_stencil_write_mask_shows() {
    for case in cases("stencil/write-mask/") {
        let right = plain(&case.scene);
        for bit in 0..8 {
            let mut wrong = case.scene.clone();
            for draw in &mut wrong.passes[0].draws {
                let stencil = draw.stencil.as_mut().expect("the family tests stencil");
                if stencil.front.compare != CompareFunction::Always {
                    stencil.front.write_mask ^= 1 << bit;
                }
            }
            assert!(right != plain(&wrong), "{}: bit {bit}", case.id);
        }
    }
}

#[test]
fn a_wrong_blend_factor_shows() {
    let mut shown = 0;
    for case in cases("blend/factors/") {
        let right = plain(&case.scene);
        let draw = &case.scene.passes[0].draws[0];
        let state = draw.targets[0].blend.expect("the family blends");
        let constant = draw.blend_constant.map(f64::from);
        for (channel, used) in [(0, state.color), (3, state.alpha)] {
            let others = BlendFactor::ALL.iter().flat_map(|f| {
                let (mut src, mut dst) = (used, used);
                (src.src_factor, dst.dst_factor) = (*f, *f);
                [src, dst]
            });
            for other in others.filter(|o| !agree(*o, used, constant, channel)) {
                let mut wrong = case.scene.clone();
                let blend = wrong.passes[0].draws[0].targets[0].blend.as_mut();
                let blend = blend.expect("the family blends");
                *(if channel == 3 {
                    &mut blend.alpha
                } else {
                    &mut blend.color
                }) = other;
                let most = most_codes(&right[0], &plain(&wrong)[0]);
                assert!(most > 7.5, "{}: {other:?} shows by {most} codes", case.id);
                shown += 1;
            }
        }
    }
    assert!(shown > 30_000, "{shown} wrong factors were tried");
}

/// Whether two equations give the same for whatever source and destination.
fn agree(a: BlendComponent, b: BlendComponent, constant: [f64; 4], channel: usize) -> bool {
    let steps = [0.0, 0.25, 0.5, 1.0];
    let each = (0..256).map(|i| [i & 3, i >> 2 & 3, i >> 4 & 3, i >> 6].map(|n| steps[n]));
    each.into_iter().all(|[s, s_alpha, d, d_alpha]| {
        let (s, d) = ([s, s, s, s_alpha], [d, d, d, d_alpha]);
        let [a, b] = [a, b].map(|c| equation(c, s, d, constant, channel).clamp(0.0, 1.0));
        a == b
    })
}

/// The largest difference of any colour channel in codes of 8 bits.
fn most_codes(a: &Plain, b: &Plain) -> f64 {
    let channels = a.color.iter().flatten().zip(b.color.iter().flatten());
    let differences = channels.map(|(a, b)| (a - b).abs() * 255.0);
    differences.fold(0.0, f64::max)
}

#[test]
fn exchanged_stencil_faces_show() {
    for family in ["operations", "faces", "separate-faces"] {
        for case in cases(&format!("stencil/{family}/")) {
            let mut exchanged = case.scene.clone();
            for draw in &mut exchanged.passes[0].draws {
                if let Some(stencil) = &mut draw.stencil {
                    std::mem::swap(&mut stencil.front, &mut stencil.back);
                }
            }
            let (a, b) = (plain(&case.scene), plain(&exchanged));
            assert!(a != b, "{} does not tell the faces apart", case.id);
        }
    }
}

#[test]
fn textbook_values_are_what_the_equations_give() {
    let textbook = cases("blend/textbook/");
    assert!(textbook.len() >= 20);
    for case in textbook {
        assert!(!case.expect.is_empty(), "{} expects nothing", case.id);
        let frame = plain(&case.scene);
        for expect in &case.expect {
            let width = case.scene.attachments[expect.attachment].size[0];
            let at = (expect.texel[1] * width + expect.texel[0]) as usize;
            let found = frame[expect.attachment].color[at];
            for (found, due) in found.iter().zip(&expect.value) {
                let due = (due * 255.0).round() / 255.0;
                assert!((found - due).abs() < 1e-6, "{}: {found} for {due}", case.id);
            }
        }
    }
}

#[test]
fn culling_shows_each_face_alone() {
    for case in cases("cull/") {
        let draw = &case.scene.passes[0].draws[0];
        let frame = plain(&case.scene);
        let colors = &frame[case.scene.passes[0].color[0]].color;
        let shows = |color: [f32; 4]| colors.contains(&color.map(f64::from));
        let (front, back) = (shows(draw.params.color), shows(draw.params.back_color));
        let due = match draw.cull {
            CullMode::None => (true, true),
            CullMode::Front => (false, true),
            CullMode::Back => (true, false),
            CullMode::FrontAndBack => (false, false),
        };
        assert_eq!((front, back), due, "{}", case.id);
    }
}

#[test]
fn every_selftest_differs_beyond_what_any_rule_allows() {
    let selftests = cases("selftest/");
    assert!(selftests.len() >= 20);
    for case in selftests {
        let (drawn, judged) = (plain(&case.scene), plain(case.judged_scene()));
        let proven = case.scene.read.iter().any(|index| {
            let (a, b) = (&drawn[*index], &judged[*index]);
            let format = case.scene.attachments[*index].format;
            // A written depth is exact on a float format; elsewhere only 0 and 1 are.
            let depth = if format == TextureFormat::Depth32Float {
                0.0
            } else {
                0.5
            };
            a.stencil != b.stencil
                || a.depth
                    .iter()
                    .zip(&b.depth)
                    .any(|(a, b)| (a - b).abs() > depth)
                || most_codes(a, b) > 7.5
        });
        assert!(proven, "{} would not have to fail", case.id);
    }
}

// The plain simulation.

/// One attachment's contents; what the format lacks stays empty.
#[derive(Clone, Debug, Default, PartialEq)]
struct Plain {
    color: Vec<[f64; 4]>,
    depth: Vec<f64>,
    stencil: Vec<u8>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Path {
    Fail,
    DepthFail,
    Pass,
}

/// What happened to one fragment.
struct Event<'a> {
    draw: &'a Draw,
    front: bool,
    face: Option<StencilFace>,
    stored: u8,
    path: Path,
}

fn draws(scene: &Scene) -> impl Iterator<Item = (&etalon_case::scene::Pass, &Draw)> {
    let passes = scene.passes.iter();
    passes.flat_map(|p| p.draws.iter().map(move |d| (p, d)))
}

/// The corners of each triangle in texels from the top left.
fn triangles(draw: &Draw, size: [u32; 2]) -> Vec<[[f64; 2]; 3]> {
    let corner = |i: usize| {
        let [x, y, _, w] = draw.mesh.vertices[i].position.map(f64::from);
        let [width, height] = size.map(f64::from);
        [(x / w + 1.0) / 2.0 * width, (1.0 - y / w) / 2.0 * height]
    };
    let triangles = draw.mesh.triangles(draw.topology);
    triangles.into_iter().map(|t| t.map(corner)).collect()
}

fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn distance_from_centres(a: [f64; 2], b: [f64; 2], size: [u32; 2]) -> f64 {
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let length = dx * dx + dy * dy;
    let mut least = f64::MAX;
    for i in 0..size[0] * size[1] {
        let (x, y) = (f64::from(i % size[0]) + 0.5, f64::from(i / size[0]) + 0.5);
        let t = (((x - a[0]) * dx + (y - a[1]) * dy) / length).clamp(0.0, 1.0);
        least = least.min((a[0] + t * dx - x).hypot(a[1] + t * dy - y));
    }
    least
}

fn plain(scene: &Scene) -> Vec<Plain> {
    simulate(scene, &mut |_| {})
}

fn simulate(scene: &Scene, observe: &mut dyn FnMut(Event<'_>)) -> Vec<Plain> {
    let mut frame: Vec<Plain> = Vec::new();
    for a in &scene.attachments {
        let texels = a.size[0] as usize * a.size[1] as usize;
        frame.push(match &a.contents {
            Contents::Color(color) => Plain {
                color: vec![store(color.map(f64::from), a.format); texels],
                ..Plain::default()
            },
            Contents::DepthStencil { depth, stencil } => Plain {
                color: Vec::new(),
                depth: vec![f64::from(*depth); if a.format.has_depth() { texels } else { 0 }],
                stencil: vec![*stencil; if a.format.has_stencil() { texels } else { 0 }],
            },
            Contents::Texels(codes) => Plain {
                color: codes
                    .chunks_exact(4)
                    .map(|c| std::array::from_fn(|i| value(a.format.color_channels()[i], c[i])))
                    .collect(),
                ..Plain::default()
            },
        });
    }
    for (pass, draw) in draws(scene) {
        let target = pass.color[0];
        let attachment = &scene.attachments[target];
        let corners = triangles(draw, attachment.size);
        for (t, p) in draw.mesh.triangles(draw.topology).iter().zip(corners) {
            // With y down, a counter-clockwise triangle has a negative cross product.
            let area = cross(p[0], p[1], p[2]);
            let front = (area < 0.0) == (draw.front_face == FrontFace::Ccw);
            let culled = match draw.cull {
                CullMode::None => false,
                CullMode::Front => front,
                CullMode::Back => !front,
                CullMode::FrontAndBack => true,
            };
            if culled {
                continue;
            }
            let vertex = &draw.mesh.vertices[t[0]];
            for y in 0..attachment.size[1] {
                for x in 0..attachment.size[0] {
                    let c = [f64::from(x) + 0.5, f64::from(y) + 0.5];
                    let inside = |a, b| cross(a, b, c) * area > 0.0;
                    if !(inside(p[0], p[1]) && inside(p[1], p[2]) && inside(p[2], p[0])) {
                        continue;
                    }
                    let at = (y * attachment.size[0] + x) as usize;
                    let mut z = f64::from(vertex.position[2]);
                    let source = match draw.shader {
                        Shader::FlatColor => vertex.color.map(f64::from),
                        Shader::FlatColorDepth => {
                            z = f64::from(vertex.color[0]);
                            draw.params.color.map(f64::from)
                        }
                        Shader::FrontFacing if front => draw.params.color.map(f64::from),
                        Shader::FrontFacing => draw.params.back_color.map(f64::from),
                        Shader::TexelColor => frame[draw.textures[0]].color[at],
                        Shader::UniformColor => draw.params.color.map(f64::from),
                    };
                    let path = match pass.depth_stencil {
                        None => Path::Pass,
                        Some(index) => {
                            depth_stencil(draw, front, z, at, &mut frame[index], observe)
                        }
                    };
                    if path == Path::Pass {
                        let stored = frame[target].color[at];
                        let blended = store(blend(draw, source, stored), attachment.format);
                        for (channel, value) in blended.into_iter().enumerate() {
                            if draw.targets[0].write_mask >> channel & 1 == 1 {
                                frame[target].color[at][channel] = value;
                            }
                        }
                    }
                }
            }
        }
    }
    frame
}

fn depth_stencil(
    draw: &Draw,
    front: bool,
    z: f64,
    at: usize,
    stored: &mut Plain,
    observe: &mut dyn FnMut(Event<'_>),
) -> Path {
    let face = draw.stencil.map(|s| if front { s.front } else { s.back });
    let stencil = stored.stencil.get(at).copied().unwrap_or(0);
    let stencil_passes =
        face.is_none_or(|f| compare(f.compare, f.reference & f.read_mask, stencil & f.read_mask));
    let depth_passes = draw
        .depth
        .is_none_or(|d| compare(d.compare, z, stored.depth[at]));
    let path = match (stencil_passes, depth_passes) {
        (false, _) => Path::Fail,
        (true, false) => Path::DepthFail,
        (true, true) => Path::Pass,
    };
    if let Some(f) = face {
        let op = match path {
            Path::Fail => f.fail_op,
            Path::DepthFail => f.depth_fail_op,
            Path::Pass => f.pass_op,
        };
        stored.stencil[at] = operate(op, stencil, f.reference, f.write_mask);
    }
    if path == Path::Pass && draw.depth.is_some_and(|d| d.write) {
        stored.depth[at] = z;
    }
    observe(Event {
        draw,
        front,
        face,
        stored: stencil,
        path,
    });
    path
}

fn compare<T: PartialOrd>(function: CompareFunction, incoming: T, stored: T) -> bool {
    match function {
        CompareFunction::Never => false,
        CompareFunction::Less => incoming < stored,
        CompareFunction::Equal => incoming == stored,
        CompareFunction::LessEqual => incoming <= stored,
        CompareFunction::Greater => incoming > stored,
        CompareFunction::NotEqual => incoming != stored,
        CompareFunction::GreaterEqual => incoming >= stored,
        CompareFunction::Always => true,
    }
}

fn operate(operation: StencilOperation, stored: u8, reference: u8, mask: u8) -> u8 {
    let new = match operation {
        StencilOperation::Keep => stored,
        StencilOperation::Zero => 0,
        StencilOperation::Replace => reference,
        StencilOperation::Invert => !stored,
        StencilOperation::IncrementClamp => stored.saturating_add(1),
        StencilOperation::DecrementClamp => stored.saturating_sub(1),
        StencilOperation::IncrementWrap => stored.wrapping_add(1),
        StencilOperation::DecrementWrap => stored.wrapping_sub(1),
    };
    stored & !mask | new & mask
}

fn value(encoding: ChannelEncoding, code: u32) -> f64 {
    match encoding {
        ChannelEncoding::Unorm(bits) => f64::from(code) / f64::from((1_u32 << bits) - 1),
        ChannelEncoding::Float32 => f64::from(f32::from_bits(code)),
        other => panic!("the plain simulation lacks {other:?}"),
    }
}

fn store(color: [f64; 4], format: TextureFormat) -> [f64; 4] {
    assert_eq!(format, TextureFormat::Rgba8Unorm);
    color.map(|v| (v.clamp(0.0, 1.0) * 255.0).round() / 255.0)
}

fn factor(f: BlendFactor, s: [f64; 4], d: [f64; 4], k: [f64; 4], channel: usize) -> f64 {
    match f {
        BlendFactor::Zero => 0.0,
        BlendFactor::One => 1.0,
        BlendFactor::Src => s[channel],
        BlendFactor::OneMinusSrc => 1.0 - s[channel],
        BlendFactor::SrcAlpha => s[3],
        BlendFactor::OneMinusSrcAlpha => 1.0 - s[3],
        BlendFactor::Dst => d[channel],
        BlendFactor::OneMinusDst => 1.0 - d[channel],
        BlendFactor::DstAlpha => d[3],
        BlendFactor::OneMinusDstAlpha => 1.0 - d[3],
        BlendFactor::SrcAlphaSaturated if channel == 3 => 1.0,
        BlendFactor::SrcAlphaSaturated => s[3].min(1.0 - d[3]),
        BlendFactor::Constant => k[channel],
        BlendFactor::OneMinusConstant => 1.0 - k[channel],
        BlendFactor::ConstantAlpha => k[3],
        BlendFactor::OneMinusConstantAlpha => 1.0 - k[3],
    }
}

fn blend(draw: &Draw, source: [f64; 4], stored: [f64; 4]) -> [f64; 4] {
    let Some(state) = draw.targets[0].blend else {
        return source;
    };
    let source = source.map(|v| v.clamp(0.0, 1.0));
    let constant = draw.blend_constant.map(|v| f64::from(v).clamp(0.0, 1.0));
    std::array::from_fn(|channel| {
        let component = if channel == 3 {
            state.alpha
        } else {
            state.color
        };
        equation(component, source, stored, constant, channel)
    })
}

fn equation(c: BlendComponent, s: [f64; 4], d: [f64; 4], k: [f64; 4], channel: usize) -> f64 {
    let source = s[channel] * factor(c.src_factor, s, d, k, channel);
    let stored = d[channel] * factor(c.dst_factor, s, d, k, channel);
    match c.operation {
        BlendOperation::Add => source + stored,
        BlendOperation::Subtract => source - stored,
        BlendOperation::ReverseSubtract => stored - source,
        BlendOperation::Min => s[channel].min(d[channel]),
        BlendOperation::Max => s[channel].max(d[channel]),
    }
}
