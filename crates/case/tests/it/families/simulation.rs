//! A simulation of scenes that shares no code with the pipeline.

use etalon_frame::{ChannelEncoding, TextureFormat};
use etalon_scene::{
    AttachmentContents, BlendComponent, BlendFactor, BlendOperation, CompareFunction, CullMode,
    Draw, EarlyTests, FrontFace, Pass, PolygonMode, PrimitiveVertices, Scene, Shader, StencilFace,
    StencilOperation,
};

/// One attachment's contents; aspects that the format lacks stay empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Plain {
    pub(crate) color: Vec<[f64; 4]>,
    pub(crate) depth: Vec<f64>,
    pub(crate) stencil: Vec<u8>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Path {
    Fail,
    DepthFail,
    Pass,
}

/// The tests of one fragment.
pub(crate) struct Event<'a> {
    pub(crate) draw: &'a Draw,
    pub(crate) front: bool,
    pub(crate) face: Option<StencilFace>,
    pub(crate) stored: u8,
    pub(crate) path: Path,
}

pub(crate) fn draws(scene: &Scene) -> impl Iterator<Item = (&etalon_scene::Pass, &Draw)> {
    let passes = scene.passes.iter();
    passes.flat_map(|p| p.draws.iter().map(move |d| (p, d)))
}

/// The corners of each triangle in texels from the top left.
pub(crate) fn triangles(draw: &Draw, size: [u32; 2]) -> Vec<[[f64; 2]; 3]> {
    let corner = |i: usize| {
        let [x, y, _, w] = draw.mesh.vertices[i].position.map(f64::from);
        let [width, height] = size.map(f64::from);
        [(x / w + 1.0) / 2.0 * width, (1.0 - y / w) / 2.0 * height]
    };
    let triangles = indices(draw).into_iter();
    triangles.map(|t| t.map(corner)).collect()
}

/// The vertices of each triangle.
fn indices(draw: &Draw) -> Vec<[usize; 3]> {
    let primitives = draw.primitives().into_iter();
    let triangles = primitives.filter_map(|p| match p {
        PrimitiveVertices::Triangle(t) => Some(t),
        _ => None,
    });
    triangles.collect()
}

/// True if the simulation has everything that a scene uses: one sample, 8-bit colour, flat
/// triangles over the whole attachment.
pub(crate) fn knows(scene: &Scene) -> bool {
    let formats = scene.attachments.iter().enumerate().all(|(i, a)| {
        // Float attachments are only fetched from.
        let fetched = a.format == TextureFormat::Rgba32Float
            && matches!(a.contents, AttachmentContents::Texels(_))
            && scene.passes.iter().all(|p| !p.color.contains(&i));
        let color = a.format == TextureFormat::Rgba8Unorm || fetched;
        a.samples == 1 && (!a.format.is_color() || color)
    });
    let shaders = [
        Shader::FlatColor,
        Shader::FlatColorDepth,
        Shader::FrontFacing,
        Shader::TexelColor,
        Shader::UniformColor,
    ];
    let plain = |pass: &Pass| pass.operations == Default::default() && pass.clears.is_empty();
    formats
        && scene.passes.iter().all(plain)
        && draws(scene).all(|(pass, draw)| {
            let size = scene.pass_size(pass).map(|s| s as f32);
            let factors = draw.targets.iter().filter_map(|t| t.blend).flat_map(|b| {
                let [color, alpha] = [b.color, b.alpha];
                [
                    color.src_factor,
                    color.dst_factor,
                    alpha.src_factor,
                    alpha.dst_factor,
                ]
            });
            pass.color.len() == 1
                && shaders.contains(&draw.shader)
                && draw.provoking.is_none()
                && draw.primitives().len() == indices(draw).len()
                && draw
                    .mesh
                    .vertices
                    .iter()
                    .all(|v| (0.0..=1.0).contains(&v.position[2]) && v.position[3] == 1.0)
                && draw.viewport.rect == [0.0, 0.0, size[0], size[1]]
                && draw.viewport.depth == [0.0, 1.0]
                && draw.scissor.is_none()
                && draw.early_tests == EarlyTests::Implicit
                && draw.logic.is_none()
                && draw.targets.iter().all(|t| t.advanced.is_none())
                && draw.depth_bounds.is_none()
                && draw.depth_bias == Default::default()
                && !draw.rasterizer_discard
                && draw.polygon_mode == PolygonMode::Fill
                && factors.into_iter().all(|f| !f.is_second_source())
        })
}

pub(crate) fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

pub(crate) fn distance_from_centres(a: [f64; 2], b: [f64; 2], size: [u32; 2]) -> f64 {
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

pub(crate) fn plain(scene: &Scene) -> Vec<Plain> {
    simulate(scene, &mut |_| {})
}

pub(crate) fn simulate(scene: &Scene, observe: &mut dyn FnMut(Event<'_>)) -> Vec<Plain> {
    let mut frame: Vec<Plain> = Vec::new();
    for a in &scene.attachments {
        let texels = a.size[0] as usize * a.size[1] as usize;
        frame.push(match &a.contents {
            AttachmentContents::Color(color) => Plain {
                color: vec![store(color.map(f64::from), a.format); texels],
                ..Plain::default()
            },
            AttachmentContents::DepthStencil { depth, stencil } => Plain {
                color: Vec::new(),
                depth: vec![f64::from(*depth); if a.format.has_depth() { texels } else { 0 }],
                stencil: vec![*stencil; if a.format.has_stencil() { texels } else { 0 }],
            },
            AttachmentContents::Texels(codes) => Plain {
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
        for (t, p) in indices(draw).iter().zip(corners) {
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
                    let texel = (y * attachment.size[0] + x) as usize;
                    let mut z = f64::from(vertex.position[2]);
                    let source = match draw.shader {
                        Shader::FlatColor => vertex.color.map(f64::from),
                        Shader::FlatColorDepth => {
                            z = f64::from(vertex.color[0]);
                            draw.params.color.map(f64::from)
                        }
                        Shader::FrontFacing if front => draw.params.color.map(f64::from),
                        Shader::FrontFacing => draw.params.back_color.map(f64::from),
                        Shader::TexelColor => frame[draw.textures[0]].color[texel],
                        Shader::UniformColor => draw.params.color.map(f64::from),
                        other => panic!("the plain simulation lacks {other:?}"),
                    };
                    let path = match pass.depth_stencil {
                        None => Path::Pass,
                        Some(index) => {
                            depth_stencil(draw, front, z, texel, &mut frame[index], observe)
                        }
                    };
                    if path == Path::Pass {
                        let stored = frame[target].color[texel];
                        let blended = store(blend(draw, source, stored), attachment.format);
                        for (channel, value) in blended.into_iter().enumerate() {
                            if draw.targets[0].write_mask >> channel & 1 == 1 {
                                frame[target].color[texel][channel] = value;
                            }
                        }
                    }
                }
            }
        }
    }
    frame
}

pub(crate) fn depth_stencil(
    draw: &Draw,
    front: bool,
    z: f64,
    texel: usize,
    stored: &mut Plain,
    observe: &mut dyn FnMut(Event<'_>),
) -> Path {
    let face = draw.stencil.map(|s| if front { s.front } else { s.back });
    let stencil = stored.stencil.get(texel).copied().unwrap_or(0);
    let stencil_passes =
        face.is_none_or(|f| compare(f.compare, f.reference & f.read_mask, stencil & f.read_mask));
    let depth_passes = draw
        .depth
        .is_none_or(|d| compare(d.compare, z, stored.depth[texel]));
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
        stored.stencil[texel] = operate(op, stencil, f.reference, f.write_mask);
    }
    if path == Path::Pass && draw.depth.is_some_and(|d| d.write) {
        stored.depth[texel] = z;
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

pub(crate) fn compare<T: PartialOrd>(function: CompareFunction, incoming: T, stored: T) -> bool {
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

pub(crate) fn operate(operation: StencilOperation, stored: u8, reference: u8, mask: u8) -> u8 {
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

pub(crate) fn value(encoding: ChannelEncoding, code: u32) -> f64 {
    match encoding {
        ChannelEncoding::Unorm(bits) => f64::from(code) / f64::from((1_u32 << bits) - 1),
        ChannelEncoding::Float32 => f64::from(f32::from_bits(code)),
        other => panic!("the plain simulation lacks {other:?}"),
    }
}

pub(crate) fn store(color: [f64; 4], format: TextureFormat) -> [f64; 4] {
    assert_eq!(format, TextureFormat::Rgba8Unorm);
    color.map(|v| (v.clamp(0.0, 1.0) * 255.0).round() / 255.0)
}

pub(crate) fn factor(f: BlendFactor, s: [f64; 4], d: [f64; 4], k: [f64; 4], channel: usize) -> f64 {
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
        other => panic!("the plain simulation lacks {other:?}"),
    }
}

pub(crate) fn blend(draw: &Draw, source: [f64; 4], stored: [f64; 4]) -> [f64; 4] {
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

pub(crate) fn equation(
    c: BlendComponent,
    s: [f64; 4],
    d: [f64; 4],
    k: [f64; 4],
    channel: usize,
) -> f64 {
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
