//! Paths in WebGPU: the values that a device has, and their meaning for an attachment, a draw or a read.
//!
//! Other modules call the functions here and do not read the path, so a new value changes only these
//! functions.

use crate::calls::{Extent, TextureDimension};
use crate::device::{Abilities, read_path};
use etalon_frame::{
    ChannelEncoding, Feature, PathCommands, PathDraws, PathEnd, PathResults, PathStart, PathState,
    PathTarget, PathValue, PathViews, ReadPath, TextureFormat,
};
use etalon_scene::{ColorTarget, Draw, Multisample, PolygonMode, Scene};
use std::collections::BTreeSet;

/// Returns the path values that a device with these abilities and features has. `indirect` is true if it
/// executes indirect draws. A format can lack some of the values, as `target` and `end` decide.
pub(crate) fn paths(
    indirect: bool,
    abilities: Abilities,
    features: &BTreeSet<Feature>,
) -> BTreeSet<PathValue> {
    let has = |value: &PathValue| match *value {
        PathValue::Start(PathStart::LoadOperation | PathStart::Draw) => true,
        PathValue::Target(target) => target != PathTarget::Renderbuffer,
        // A secondary command buffer is a render bundle.
        PathValue::Commands(commands) => commands != PathCommands::SecondaryEach,
        PathValue::Draws(PathDraws::BaseVertex) => features.contains(&Feature::BaseVertex),
        PathValue::Draws(PathDraws::Indirect) => indirect,
        PathValue::Draws(PathDraws::IndirectCount | PathDraws::IndirectBeside) => false,
        PathValue::Draws(_) => true,
        // A test needs its attachment (10.3.6).
        PathValue::Tests(_) => false,
        PathValue::End(end) => matches!(
            end,
            PathEnd::Store | PathEnd::Copy | PathEnd::ShaderRead | PathEnd::Part
        ),
        PathValue::State(PathState::Overwritten | PathState::OtherPipeline) => true,
        PathValue::Results(PathResults::Twice) | PathValue::Colors(_) => true,
        PathValue::Views(PathViews::Srgb) => abilities.casts,
        // Viewports, scissor rectangles, the blend constant and the stencil reference are never part of a
        // pipeline; everything else always is.
        PathValue::State(
            PathState::Dynamic
            | PathState::Static
            | PathState::ExtendedDynamic3
            | PathState::BeforePipeline
            | PathState::DynamicLogic
            | PathState::Kept
            | PathState::DynamicSamples
            | PathState::DynamicAlphaToOne
            | PathState::DynamicDepthClip
            | PathState::DynamicProvoking
            | PathState::DynamicOrigin
            | PathState::Turns,
        )
        | PathValue::Start(PathStart::Transfer | PathStart::ClearCommand)
        | PathValue::Pass(_)
        // A texture that a pass draws to cannot be bound in it (Resource Usages).
        | PathValue::Reads(_)
        | PathValue::Area(_)
        | PathValue::Clears(_)
        | PathValue::Results(PathResults::Once)
        | PathValue::Clip(_)
        | PathValue::Viewport(_)
        | PathValue::Layers(_)
        | PathValue::Resolves(_)
        | PathValue::Views(PathViews::Same | PathViews::Uint) => false,
    };
    PathValue::all().into_iter().filter(has).collect()
}

/// Returns the part of a texture that the attachment is. An attachment that cannot be the part that the path
/// names is a plain texture: multisampled textures have one level and layer (GPUTextureDescriptor), depth
/// textures are not 3D, and the shaders of scenes read no slice of a 3D texture, and no single layer if the
/// device has no views of one.
pub(crate) fn target(scene: &Scene, index: usize, abilities: Abilities) -> PathTarget {
    let attachment = &scene.attachments[index];
    let read_by_shader = || {
        let mut draws = scene.passes.iter().flat_map(|p| &p.draws);
        let fetched = scene.path.end == PathEnd::ShaderRead
            || read_path(attachment.format, abilities) == ReadPath::Shader;
        fetched && scene.read.contains(&index) || draws.any(|d| d.textures.contains(&index))
    };
    let layered = || abilities.layers || !read_by_shader();
    let resolved = || {
        let mut passes = scene.passes.iter();
        passes.any(|p| p.resolve.contains(&Some(index)))
    };
    let can = attachment.samples == 1
        && match scene.path.target {
            PathTarget::Plain | PathTarget::MipLevel => true,
            PathTarget::ArrayLayer | PathTarget::LevelOfLayer => layered(),
            PathTarget::CubeFace => attachment.size[0] == attachment.size[1] && layered(),
            PathTarget::Slice3d => attachment.format.is_color() && !read_by_shader() && !resolved(),
            PathTarget::Renderbuffer => false,
        };
    if can {
        scene.path.target
    } else {
        PathTarget::Plain
    }
}

/// The texture that an attachment is a part of.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct AttachmentTexture {
    pub(crate) size: Extent,
    pub(crate) dimension: TextureDimension,
    pub(crate) levels: u32,
    /// The level of the attachment.
    pub(crate) level: u32,
    /// The layer, face or slice of the attachment.
    pub(crate) layer: u32,
}

impl AttachmentTexture {
    pub(crate) fn of(target: PathTarget, [width, height]: [u32; 2]) -> Self {
        let plain = Self {
            size: [width, height, 1],
            dimension: TextureDimension::D2,
            levels: 1,
            level: 0,
            layer: 0,
        };
        match target {
            PathTarget::Plain | PathTarget::Renderbuffer => plain,
            PathTarget::MipLevel => Self {
                // Odd sizes: each level's size is rounded down.
                size: [2 * width + 1, 2 * height + 1, 1],
                levels: 2,
                level: 1,
                ..plain
            },
            PathTarget::LevelOfLayer => Self {
                size: [2 * width + 1, 2 * height + 1, 3],
                levels: 2,
                level: 1,
                layer: 2,
                ..plain
            },
            PathTarget::ArrayLayer => Self {
                size: [width, height, 3],
                layer: 2,
                ..plain
            },
            PathTarget::CubeFace => Self {
                size: [width, height, 6],
                layer: 4,
                ..plain
            },
            PathTarget::Slice3d => Self {
                size: [width, height, 4],
                dimension: TextureDimension::D3,
                layer: 3,
                ..plain
            },
        }
    }

    /// Returns the slice, if the texture is a 3D texture.
    pub(crate) fn slice(self) -> Option<u32> {
        (self.dimension == TextureDimension::D3).then_some(self.layer)
    }
}

/// The default way to read attachments of a format.
#[derive(Clone, Copy)]
pub(crate) struct ReadingPath {
    /// True if depth and stencil can be copied.
    pub(crate) copies: bool,
    /// True if a shader fetches depth.
    pub(crate) fetches: bool,
}

/// Returns how an attachment reaches the host. Depth and stencil are copied only as a whole (11.2.4), and a
/// fetch does not determine the codes of some formats; these are read in the default way.
pub(crate) fn end(scene: &Scene, index: usize, reading: ReadingPath) -> PathEnd {
    let attachment = &scene.attachments[index];
    let format = attachment.format;
    let can = attachment.samples == 1
        && match scene.path.end {
            PathEnd::Store => true,
            PathEnd::Copy => format.is_color() || reading.copies,
            PathEnd::Part => format.is_color(),
            PathEnd::ShaderRead => is_fetched_exactly(format, reading),
            PathEnd::Blit
            | PathEnd::BlitMirrored
            | PathEnd::BlitScaled
            | PathEnd::BlitPart
            | PathEnd::BlitLinear
            | PathEnd::ReadBuffer => false,
        };
    if can { scene.path.end } else { PathEnd::Store }
}

/// Returns true if a fetch determines the codes. The rule is that of multisampled attachments, but views of
/// one sample convert sRGB, and stencil is never fetched.
fn is_fetched_exactly(format: TextureFormat, reading: ReadingPath) -> bool {
    let exact = |encoding: &ChannelEncoding| match encoding {
        ChannelEncoding::Snorm(_) | ChannelEncoding::Srgb8 => false,
        ChannelEncoding::Unorm(bits) => *bits <= 10,
        _ => true,
    };
    let floats = format.depth_encodings() == [ChannelEncoding::Float32];
    if format.is_color() {
        format.color_channels().iter().all(exact)
    } else {
        format.has_depth() && (floats || reading.fetches)
    }
}

/// Returns a draw whose pipeline differs from this draw's.
pub(crate) fn other(draw: &Draw) -> Draw {
    Draw {
        targets: draw
            .targets
            .iter()
            .map(|_| ColorTarget {
                blend: None,
                advanced: None,
                write_mask: 0,
            })
            .collect(),
        polygon_mode: PolygonMode::Fill,
        depth_clamp: false,
        multisample: Multisample::default(),
        ..draw.clone()
    }
}

/// Returns the indices of the passes of each command buffer.
pub(crate) fn commands(scene: &Scene) -> Vec<std::ops::Range<usize>> {
    let passes = scene.passes.len();
    match scene.path.commands {
        PathCommands::Several if passes > 0 => (0..passes).map(|n| n..n + 1).collect(),
        PathCommands::One
        | PathCommands::Several
        | PathCommands::Secondary
        | PathCommands::SecondaryEach => std::iter::once(0..passes).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_scene::{Attachment, AttachmentContents, Pass, Path, QueryScope};

    const ABILITIES: Abilities = Abilities {
        copies: true,
        casts: true,
        layers: true,
    };

    const READING: ReadingPath = ReadingPath {
        copies: true,
        fetches: false,
    };

    /// Returns a scene with two passes that reads one attachment, on a path.
    fn scene(format: TextureFormat, samples: u32, path: Path) -> Scene {
        Scene {
            attachments: vec![Attachment {
                name: String::new(),
                format,
                size: [8, 8],
                samples,
                contents: AttachmentContents::Color([0.0; 4]),
            }],
            passes: vec![Pass::default(), Pass::default()],
            read: vec![0],
            counters: Vec::new(),
            query_scope: QueryScope::Draw,
            pool: None,
            path,
        }
    }

    #[test]
    fn offered_path_values_are_those_that_the_adapter_has() {
        let base = PathValue::Draws(PathDraws::BaseVertex);
        let indirect = PathValue::Draws(PathDraws::Indirect);
        let views = PathValue::Views(PathViews::Srgb);
        let abilities = |casts| Abilities { casts, ..ABILITIES };
        let none = paths(false, abilities(false), &BTreeSet::new());
        assert!([base, indirect, views].iter().all(|v| !none.contains(v)));
        let features = BTreeSet::from([Feature::BaseVertex]);
        let offered = paths(true, abilities(true), &features);
        assert!([base, indirect, views].iter().all(|v| offered.contains(v)));
        assert!(!offered.contains(&PathValue::Target(PathTarget::Renderbuffer)));
    }

    #[test]
    fn an_attachment_is_the_wanted_part_of_a_texture_if_it_can_be() {
        let found_target = |format, samples, wanted| {
            let path = Path {
                target: wanted,
                ..Path::default()
            };
            target(&scene(format, samples, path), 0, ABILITIES)
        };
        let (color, depth) = (TextureFormat::Rgba8Unorm, TextureFormat::Depth32Float);
        assert_eq!(
            found_target(color, 1, PathTarget::Slice3d),
            PathTarget::Slice3d
        );
        assert_eq!(
            found_target(depth, 1, PathTarget::Slice3d),
            PathTarget::Plain
        );
        assert_eq!(
            found_target(depth, 1, PathTarget::CubeFace),
            PathTarget::CubeFace
        );
        assert_eq!(
            found_target(color, 4, PathTarget::ArrayLayer),
            PathTarget::Plain
        );
        let mip = AttachmentTexture::of(PathTarget::MipLevel, [8, 5]);
        assert_eq!((mip.size[0] >> mip.level, mip.size[1] >> mip.level), (8, 5));
        assert_eq!(
            AttachmentTexture::of(PathTarget::Slice3d, [8, 8]).slice(),
            Some(3)
        );
        assert_eq!(
            AttachmentTexture::of(PathTarget::ArrayLayer, [8, 8]).slice(),
            None
        );
    }

    #[test]
    fn a_layer_that_a_shader_reads_is_a_texture_if_views_have_all_layers() {
        let abilities = Abilities {
            layers: false,
            ..ABILITIES
        };
        let found_target = |format, end| {
            let path = Path {
                target: PathTarget::ArrayLayer,
                end,
                ..Path::default()
            };
            target(&scene(format, 1, path), 0, abilities)
        };
        let (color, depth) = (TextureFormat::Rgba8Unorm, TextureFormat::Depth24Plus);
        let [layer, plain] = [PathTarget::ArrayLayer, PathTarget::Plain];
        assert_eq!(found_target(color, PathEnd::Store), layer);
        assert_eq!(found_target(color, PathEnd::ShaderRead), plain);
        // The attachment's depth is never copied.
        assert_eq!(found_target(depth, PathEnd::Store), plain);
    }

    #[test]
    fn a_read_back_that_would_round_is_replaced_by_the_default() {
        let found_end = |format, wanted| {
            let path = Path {
                end: wanted,
                ..Path::default()
            };
            end(&scene(format, 1, path), 0, READING)
        };
        let color = TextureFormat::Rgba8Unorm;
        assert_eq!(found_end(color, PathEnd::ShaderRead), PathEnd::ShaderRead);
        let srgb = TextureFormat::Rgba8UnormSrgb;
        assert_eq!(found_end(srgb, PathEnd::ShaderRead), PathEnd::Store);
        let short = TextureFormat::Depth16Unorm;
        assert_eq!(found_end(short, PathEnd::ShaderRead), PathEnd::Store);
        let depth = TextureFormat::Depth32Float;
        assert_eq!(found_end(depth, PathEnd::ShaderRead), PathEnd::ShaderRead);
        assert_eq!(found_end(depth, PathEnd::Part), PathEnd::Store);
    }

    #[test]
    fn each_pass_has_a_command_buffer() {
        let found_commands = |wanted| {
            let path = Path {
                commands: wanted,
                ..Path::default()
            };
            commands(&scene(TextureFormat::Rgba8Unorm, 1, path))
        };
        assert_eq!(found_commands(PathCommands::One).first(), Some(&(0..2)));
        assert_eq!(found_commands(PathCommands::Several), [0..1, 1..2]);
    }
}
