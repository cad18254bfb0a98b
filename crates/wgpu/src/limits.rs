//! What an adapter can do.

use crate::format;
use etalon_case::Scene;
use etalon_case::scene::Contents;
use etalon_frame::{Api, FormatSupport, Limits, ReadPath, Requirement, TextureFormat};
use std::collections::{BTreeMap, BTreeSet};
use wgpu::{DownlevelFlags, Features, TextureUsages};

/// WebGPU does not tell; 4 is the least that any API under it allows.
const SUB_PIXEL_BITS: u8 = 4;

/// The optional features of a device that this backend makes use of.
pub(crate) fn wanted_features() -> Features {
    Features::TIMESTAMP_QUERY | Features::DEPTH32FLOAT_STENCIL8 | Features::FLOAT32_BLENDABLE
}

/// What a texture of this format must serve for.
fn needed(format: TextureFormat) -> TextureUsages {
    let fetched = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
    match format {
        TextureFormat::Rgba8Unorm => {
            fetched | TextureUsages::COPY_DST | TextureUsages::RENDER_ATTACHMENT
        }
        // Uploaded and fetched; whether it can be drawn to besides is the adapter's choice.
        TextureFormat::Rgba32Float => fetched | TextureUsages::COPY_DST,
        _ => fetched | TextureUsages::RENDER_ATTACHMENT,
    }
}

/// What a texture of this format serves for on this adapter.
pub(crate) fn usages(format: TextureFormat, drawable_floats: bool) -> TextureUsages {
    let drawn = format == TextureFormat::Rgba32Float && drawable_floats;
    needed(format)
        | if drawn {
            TextureUsages::RENDER_ATTACHMENT
        } else {
            TextureUsages::empty()
        }
}

/// How the depth aspect, or colour, of a format is read back. `copies` tells whether the adapter
/// copies depth at all; WebGPU never copies the depth of `depth24plus` (26.1.2).
pub(crate) fn read_path(format: TextureFormat, copies: bool) -> ReadPath {
    match format {
        TextureFormat::Rgba8Unorm | TextureFormat::Rgba32Float | TextureFormat::Stencil8 => {
            ReadPath::Copy
        }
        TextureFormat::Depth24Plus | TextureFormat::Depth24PlusStencil8 => ReadPath::Shader,
        TextureFormat::Depth16Unorm
        | TextureFormat::Depth32Float
        | TextureFormat::Depth32FloatStencil8 => {
            if copies {
                ReadPath::Copy
            } else {
                ReadPath::Shader
            }
        }
    }
}

/// What matters here of an adapter and is not said by its limits.
#[derive(Clone, Copy)]
pub(crate) struct Abilities {
    /// Depth and stencil can be copied to buffers.
    pub(crate) copies: bool,
    /// `rgba32float` can be drawn to.
    pub(crate) draws_floats: bool,
    /// `rgba32float` can be blended.
    pub(crate) blends_floats: bool,
}

impl Abilities {
    pub(crate) fn of(adapter: &wgpu::Adapter) -> Self {
        let flags = adapter.get_downlevel_capabilities().flags;
        let floats = adapter.get_texture_format_features(wgpu::TextureFormat::Rgba32Float);
        Self {
            copies: flags.contains(DownlevelFlags::DEPTH_TEXTURE_AND_BUFFER_COPIES),
            draws_floats: floats
                .allowed_usages
                .contains(TextureUsages::RENDER_ATTACHMENT),
            blends_floats: adapter.features().contains(Features::FLOAT32_BLENDABLE),
        }
    }
}

/// What a scene asks for and the adapter's limits cannot say that it lacks: `rgba32float` is
/// promised as a source of values only.
pub(crate) fn missing(scene: &Scene, abilities: Abilities) -> Option<Requirement> {
    let float = |index: usize| scene.attachments[index].format == TextureFormat::Rgba32Float;
    let cleared = scene.attachments.iter().any(|a| {
        a.format == TextureFormat::Rgba32Float && !matches!(a.contents, Contents::Texels(_))
    });
    let drawn = scene
        .passes
        .iter()
        .flat_map(|p| &p.color)
        .any(|i| float(*i));
    let blended = scene.passes.iter().any(|pass| {
        pass.draws.iter().any(|draw| {
            let targets = pass.color.iter().zip(&draw.targets);
            targets
                .into_iter()
                .any(|(i, t)| float(*i) && t.blend.is_some())
        })
    });
    let lacks =
        (cleared || drawn) && !abilities.draws_floats || blended && !abilities.blends_floats;
    lacks.then_some(Requirement::Format(TextureFormat::Rgba32Float))
}

/// The adapter's limits, of a device with these features.
///
/// Attachments have one sample: WebGPU reads a multisampled attachment back only through a shader,
/// and wgpu advertises four samples on drivers that have one.
pub(crate) fn limits(adapter: &wgpu::Adapter, features: Features, copies: bool) -> Limits {
    let mut formats = BTreeMap::new();
    for texture in TextureFormat::ALL {
        let real = format::texture(texture);
        let allowed = adapter.get_texture_format_features(real).allowed_usages;
        if features.contains(real.required_features()) && allowed.contains(needed(texture)) {
            let support = FormatSupport {
                samples: vec![1],
                // Which of them it is stays the driver's secret.
                depth: texture.depth_encodings().to_vec(),
                read: read_path(texture, copies),
            };
            formats.insert(texture, support);
        }
    }
    Limits {
        api: Api::WebGpu,
        sub_pixel_bits: SUB_PIXEL_BITS,
        max_size: adapter.limits().max_texture_dimension_2d,
        formats,
        features: BTreeSet::new(),
        sample_positions: BTreeMap::from([(1, vec![[128, 128]])]),
    }
}
