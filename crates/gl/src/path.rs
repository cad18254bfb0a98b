//! Paths in OpenGL: the values that a context supports, and their meaning for an attachment, a draw or a read.
//!
//! Other modules call the functions here and do not read the path, so a new value changes only these
//! functions.

use crate::context::Context;
use crate::own_pass;
use crate::support::{ReadBackPath, Support};
use etalon_frame::{
    ChannelEncoding, Feature, PathArea, PathClears, PathClip, PathCommands, PathDraws, PathEnd,
    PathLayers, PathPass, PathResolves, PathResults, PathState, PathTarget, PathValue,
    PathViewport, PathViews,
};
use etalon_scene::{
    AttachmentContents, BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTarget,
    CompareFunction, CullMode, DepthBias, DepthState, Draw, FrontFace, LogicOperation, Multisample,
    Path, SampleCoverage, Scene, StencilFace, StencilOperation, StencilState, Viewport,
};
use std::collections::BTreeSet;

/// Returns the path values that a context with these features supports. A format can lack some of them, as
/// [`target`] and [`end`] decide.
pub(crate) fn offered(context: &Context, features: &BTreeSet<Feature>) -> BTreeSet<PathValue> {
    let caps = &context.caps;
    let arrays = context.entry_points.viewport_array.is_some();
    let has = |value: &PathValue| match *value {
        PathValue::Start(_) | PathValue::Target(_) | PathValue::Commands(PathCommands::Several) => {
            true
        }
        PathValue::Draws(PathDraws::BaseVertex) => features.contains(&Feature::BaseVertex),
        PathValue::Draws(PathDraws::Indirect) => caps.indirect,
        PathValue::Draws(PathDraws::IndirectCount | PathDraws::IndirectBeside) => {
            context.entry_points.draw_arrays_indirect_count.is_some()
        }
        // Before 4.5, an index also restarts draws without indices (OpenGL 4.2, 2.8.1).
        PathValue::Draws(PathDraws::RestartUnindexed) => caps.es || caps.version >= (4, 5),
        PathValue::Tests(_) | PathValue::Colors(_) => true,
        PathValue::Draws(_) => true,
        PathValue::End(PathEnd::Copy) => caps.copy_image,
        PathValue::End(_) => true,
        PathValue::Clip(PathClip::Toggled) => caps.clip_control,
        PathValue::State(PathState::Overwritten | PathState::Kept) => true,
        PathValue::Clears(PathClears::Together) | PathValue::Results(PathResults::Twice) => true,
        PathValue::Clears(PathClears::Undefined) => caps.invalidate,
        PathValue::Viewport(PathViewport::Array) => arrays && caps.second_viewport,
        PathValue::Viewport(_) => arrays,
        PathValue::Layers(PathLayers::Written) => caps.vertex_layer.is_some(),
        // In ES, multisampled resolves cannot move texels (OpenGL ES 3.2, 16.2.1).
        PathValue::Resolves(PathResolves::Moved) => !caps.es,
        PathValue::Views(PathViews::Srgb | PathViews::Uint) => {
            context.entry_points.texture_view.is_some()
        }
        PathValue::Reads(reads) => own_pass::offers(context, reads),
        // OpenGL has no pass objects, pipelines, command buffers or render areas.
        PathValue::Pass(
            PathPass::DynamicRendering | PathPass::RenderPass | PathPass::SecondSubpass,
        )
        | PathValue::State(
            PathState::Dynamic
            | PathState::Static
            | PathState::ExtendedDynamic3
            | PathState::BeforePipeline
            | PathState::DynamicLogic
            | PathState::OtherPipeline
            | PathState::DynamicSamples
            | PathState::DynamicAlphaToOne
            | PathState::DynamicDepthClip
            | PathState::DynamicProvoking
            | PathState::DynamicOrigin
            | PathState::Turns,
        )
        | PathValue::Commands(
            PathCommands::One | PathCommands::Secondary | PathCommands::SecondaryEach,
        )
        | PathValue::Area(PathArea::Full | PathArea::Part | PathArea::Quarters)
        | PathValue::Clears(PathClears::Each)
        | PathValue::Results(PathResults::Once)
        | PathValue::Clip(PathClip::Constant)
        | PathValue::Layers(PathLayers::One | PathLayers::Multiview)
        | PathValue::Resolves(PathResolves::Attached)
        | PathValue::Views(PathViews::Same) => false,
    };
    PathValue::all().into_iter().filter(has).collect()
}

/// Returns the part of a texture that serves as the attachment. If the attachment cannot be the part that the
/// path names, it is a plain texture: multisampled attachments, since only textures with one layer guarantee
/// sample positions; depth in a 3D texture; and renderbuffers whose texels are uploaded or read by a shader.
pub(crate) fn target(scene: &Scene, index: usize, support: Option<&Support>) -> PathTarget {
    let attachment = &scene.attachments[index];
    let mut draws = scene.passes.iter().flat_map(|p| &p.draws);
    // The shaders of scenes read only 2D textures.
    let sampled = draws.any(|d| d.textures.contains(&index));
    let fetched = scene.read.contains(&index)
        && support.is_some_and(|s| by_shader(s.read) || reads_by_shader(scene, index, s));
    let uploaded = matches!(attachment.contents, AttachmentContents::Texels(_));
    let can = attachment.samples == 1
        && match scene.path.target {
            PathTarget::Plain | PathTarget::MipLevel => true,
            PathTarget::ArrayLayer | PathTarget::LevelOfLayer => !sampled,
            PathTarget::Slice3d => !sampled && attachment.format.is_color(),
            // No shader fetches texels of a cube map.
            PathTarget::CubeFace => {
                !sampled && !fetched && attachment.size[0] == attachment.size[1]
            }
            PathTarget::Renderbuffer => {
                let renders = support.is_some_and(|s| !s.limits.samples.is_empty());
                !sampled && !fetched && !uploaded && renders
            }
        };
    if can {
        scene.path.target
    } else {
        PathTarget::Plain
    }
}

/// The layers that passes draw to if they have three; one of them is read.
pub(crate) const DRAWN_LAYERS: [u8; 2] = [1, 2];

/// Returns true if passes draw to several layers. They do not if a shader reads a drawn attachment, since a
/// layer needs a different sampler type, or if an attachment is multisampled, since only textures with one
/// layer guarantee sample positions.
pub(crate) fn is_layered(scene: &Scene) -> bool {
    let mut draws = scene.passes.iter().flat_map(|p| &p.draws);
    let fetched = draws.any(|d| d.textures.iter().any(|index| is_drawn(scene, *index)));
    let mut attachments = scene.attachments.iter();
    scene.layers() == PathLayers::Written && !fetched && attachments.all(|a| a.samples == 1)
}

/// Returns true if a pass draws to the attachment.
fn is_drawn(scene: &Scene, index: usize) -> bool {
    let mut passes = scene.passes.iter();
    passes.any(|p| p.color.contains(&index) || p.depth_stencil == Some(index))
}

/// Returns the layer of an attachment that is read, if passes have several layers. It alternates from one
/// attachment to the next.
pub(crate) fn layer(scene: &Scene, index: usize) -> Option<u8> {
    let layered = is_layered(scene) && is_drawn(scene, index);
    layered.then(|| DRAWN_LAYERS[(index + 1) % DRAWN_LAYERS.len()])
}

fn by_shader(plan: ReadBackPath) -> bool {
    matches!(plan, ReadBackPath::Fetched | ReadBackPath::Shader { .. })
}

fn reads_by_shader(scene: &Scene, index: usize, support: &Support) -> bool {
    end(scene, index, support) == PathEnd::ShaderRead
}

/// Returns how an attachment reaches the host. Formats whose values a blit can round, or whose codes a fetch
/// does not determine, are read in the default way.
pub(crate) fn end(scene: &Scene, index: usize, support: &Support) -> PathEnd {
    let attachment = &scene.attachments[index];
    let format = attachment.format;
    let exact = |e: &ChannelEncoding| e.is_float() || matches!(e, ChannelEncoding::Uint(_));
    let twofold = |e: &ChannelEncoding| matches!(e, ChannelEncoding::Snorm(_));
    let halved = |e: &ChannelEncoding| e.is_float() || matches!(e, ChannelEncoding::Unorm(_));
    let channels = format.color_channels();
    let can = attachment.samples == 1
        && match scene.path.end {
            PathEnd::Store | PathEnd::Copy | PathEnd::Part => true,
            PathEnd::Blit | PathEnd::BlitMirrored | PathEnd::BlitScaled | PathEnd::BlitPart => {
                channels.iter().all(exact)
            }
            PathEnd::BlitLinear => format.is_color() && channels.iter().all(halved),
            PathEnd::ReadBuffer => format.is_color(),
            // Stencil alone is a renderbuffer unless a shader must read it.
            PathEnd::ShaderRead if format.has_stencil() && !format.has_depth() => {
                by_shader(support.read)
            }
            PathEnd::ShaderRead => support.fetched_exactly && !channels.iter().any(twofold),
        };
    if can { scene.path.end } else { PathEnd::Store }
}

/// The vertex shader's part of a draw's path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Variant {
    /// The shader mirrors y because the clip volume's origin is the lower left.
    pub(crate) mirrored: bool,
    /// The shader selects the second viewport.
    pub(crate) second_viewport: bool,
    /// The layer that the shader selects, if any.
    pub(crate) layer: Option<u8>,
}

/// Returns the variant of a pass's draw with this index. If the path toggles the origin, every second draw
/// has the other origin.
pub(crate) fn variant(path: &Path, number: usize) -> Variant {
    Variant {
        mirrored: path.clip == PathClip::Toggled && number % 2 == 1,
        second_viewport: path.viewport == PathViewport::Array,
        layer: None,
    }
}

/// Returns a draw that has the same shape but differs in all state that every context can set.
pub(crate) fn other(draw: &Draw) -> Draw {
    let face = StencilFace {
        compare: CompareFunction::Never,
        fail_op: StencilOperation::Invert,
        depth_fail_op: StencilOperation::Invert,
        pass_op: StencilOperation::Invert,
        read_mask: 0x55,
        write_mask: 0x55,
        reference: 0xaa,
    };
    let sum = BlendComponent {
        operation: BlendOperation::ReverseSubtract,
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::One,
    };
    let opposite = |target: &ColorTarget| ColorTarget {
        blend: Some(BlendState {
            color: sum,
            alpha: sum,
        }),
        advanced: None,
        write_mask: !target.write_mask & 0b1111,
    };
    Draw {
        cull: match draw.cull {
            CullMode::Front => CullMode::Back,
            CullMode::Back => CullMode::Front,
            CullMode::None | CullMode::FrontAndBack => CullMode::FrontAndBack,
        },
        front_face: match draw.front_face {
            FrontFace::Ccw => FrontFace::Cw,
            FrontFace::Cw => FrontFace::Ccw,
        },
        rasterizer_discard: true,
        viewport: Viewport {
            rect: [0.0, 0.0, 1.0, 1.0],
            depth: [0.5, 0.5],
        },
        scissor: Some([0, 0, 1, 1]),
        depth_bias: DepthBias {
            constant: 1000,
            slope: 2.0,
            clamp: 0.0,
        },
        depth_clamp: !draw.depth_clamp,
        depth_bounds: Some([0.999_999, 0.999_999_5]),
        depth: Some(DepthState {
            compare: CompareFunction::Never,
            write: draw.depth.is_none_or(|d| !d.write),
        }),
        stencil: Some(StencilState {
            front: face,
            back: face,
        }),
        targets: draw.targets.iter().map(opposite).collect(),
        logic: Some(LogicOperation::Clear),
        multisample: Multisample {
            mask: 0,
            alpha_to_coverage: !draw.multisample.alpha_to_coverage,
            alpha_to_one: !draw.multisample.alpha_to_one,
            min_sample_shading: Some(1.0),
            sample_coverage: Some(SampleCoverage {
                value: 0.0,
                invert: false,
            }),
        },
        blend_constant: draw.blend_constant.map(|v| if v > 0.5 { 0.0 } else { 1.0 }),
        ..draw.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::ShaderStencil;
    use etalon_frame::{FormatSupport, ReadPath, TextureFormat};
    use etalon_scene::{Attachment, Mesh, Pass, QueryScope, Shader};

    fn support(read: ReadBackPath) -> Support {
        Support {
            limits: FormatSupport {
                samples: vec![1, 4],
                blendable: true,
                depth: Vec::new(),
                read: ReadPath::Copy,
            },
            read,
            fetched_exactly: true,
        }
    }

    /// Returns a scene that reads one attachment, on a path with this target and end.
    fn scene(format: TextureFormat, samples: u32, target: PathTarget, end: PathEnd) -> Scene {
        Scene {
            attachments: vec![Attachment {
                name: String::new(),
                format,
                size: [8, 8],
                samples,
                contents: AttachmentContents::Color([0.0; 4]),
            }],
            passes: vec![Pass::default()],
            read: vec![0],
            counters: Vec::new(),
            query_scope: QueryScope::Draw,
            pool: None,
            path: Path {
                target,
                end,
                ..Path::default()
            },
        }
    }

    #[test]
    fn an_attachment_is_the_wanted_part_of_a_texture_if_it_can_be() {
        let copied = support(ReadBackPath::Packed);
        let depth = true;
        let fetched = support(ReadBackPath::Shader {
            depth,
            stencil: ShaderStencil::None,
        });
        let color = TextureFormat::Rgba8Unorm;
        let found_target = |format, samples, wanted, support| {
            target(
                &scene(format, samples, wanted, PathEnd::Store),
                0,
                Some(support),
            )
        };
        for wanted in PathTarget::ALL.iter().copied() {
            assert_eq!(found_target(color, 1, wanted, &copied), wanted);
            assert_eq!(found_target(color, 4, wanted, &copied), PathTarget::Plain);
        }
        let near = TextureFormat::Depth24Plus;
        for (wanted, found) in [
            (PathTarget::ArrayLayer, PathTarget::ArrayLayer),
            (PathTarget::Slice3d, PathTarget::Plain),
            (PathTarget::CubeFace, PathTarget::Plain),
            (PathTarget::Renderbuffer, PathTarget::Plain),
        ] {
            assert_eq!(found_target(near, 1, wanted, &fetched), found);
        }
    }

    #[test]
    fn a_read_back_that_would_round_is_replaced_by_the_default() {
        let found_end = |format, samples, wanted| {
            let scene = scene(format, samples, PathTarget::Plain, wanted);
            end(&scene, 0, &support(ReadBackPath::Packed))
        };
        let unorm = TextureFormat::Rgba8Unorm;
        assert_eq!(found_end(unorm, 1, PathEnd::Blit), PathEnd::Store);
        let float = TextureFormat::Rgba16Float;
        assert_eq!(found_end(float, 1, PathEnd::Blit), PathEnd::Blit);
        assert_eq!(found_end(float, 4, PathEnd::Blit), PathEnd::Store);
        assert_eq!(
            found_end(unorm, 1, PathEnd::ShaderRead),
            PathEnd::ShaderRead
        );
        let snorm = TextureFormat::Rgba8Snorm;
        assert_eq!(found_end(snorm, 1, PathEnd::ShaderRead), PathEnd::Store);
        assert_eq!(found_end(snorm, 1, PathEnd::Part), PathEnd::Part);
        let stencil = TextureFormat::Stencil8;
        assert_eq!(found_end(stencil, 1, PathEnd::ShaderRead), PathEnd::Store);
    }

    #[test]
    fn every_second_draw_takes_the_other_origin() {
        let path = Path {
            clip: PathClip::Toggled,
            ..Path::default()
        };
        let mirrored = [0, 1, 2].map(|number| variant(&path, number).mirrored);
        assert_eq!(mirrored, [false, true, false]);
        assert_eq!(variant(&Path::default(), 1), Variant::default());
    }

    #[test]
    fn all_state_of_another_draw_differs() {
        let mesh = Mesh {
            vertices: Vec::new(),
            indices: None,
        };
        let draw = Draw::new(Shader::FlatColor, mesh, Viewport::whole([8, 8]));
        let other = other(&draw);
        assert_ne!(other.cull, draw.cull);
        assert_ne!(other.front_face, draw.front_face);
        assert_ne!(other.rasterizer_discard, draw.rasterizer_discard);
        assert_ne!(other.viewport, draw.viewport);
        assert_ne!(other.scissor, draw.scissor);
        assert_ne!(other.depth_bias, draw.depth_bias);
        assert_ne!(other.depth_clamp, draw.depth_clamp);
        assert_ne!(other.depth_bounds, draw.depth_bounds);
        assert_ne!(other.depth, draw.depth);
        assert_ne!(other.stencil, draw.stencil);
        assert_ne!(other.logic, draw.logic);
        assert_ne!(other.blend_constant, draw.blend_constant);
        assert_ne!(other.multisample, draw.multisample);
        assert_eq!(other.mesh, draw.mesh);
    }
}
