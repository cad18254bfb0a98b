//! Paths in Vulkan: the values that a device supports, and their meaning for an attachment, a pass or a draw.
//!
//! Other modules call the functions here and do not read the path, so a new value changes only these
//! functions.

use crate::device::Device;
use crate::extended::{self, DynamicLogic, DynamicStates};
use crate::format::{self, Native};
use crate::image::{DRAWN_LAYERS, ImageKey};
use crate::role::Role;
use crate::samples;
use crate::single_state::SingleState;
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::{
    Aspect, ChannelEncoding, PathArea, PathClip, PathDraws, PathEnd, PathLayers, PathReads,
    PathState, PathTarget, PathValue, PathViewport, Requirement, TextureFormat,
};
use etalon_scene::{Attachment, Draw, Multisample, Path, Scene};
use std::collections::BTreeSet;

/// Returns the path values that a device supports. A format can lack some of them, as [`target`] and [`end`]
/// decide.
pub(crate) fn offered(device: &Device) -> BTreeSet<PathValue> {
    let has = |value: &PathValue| match *value {
        PathValue::State(PathState::ExtendedDynamic3 | PathState::BeforePipeline) => {
            device.all_extended
        }
        PathValue::State(PathState::DynamicLogic) => device.dynamic_logic.is_some(),
        PathValue::State(state) => {
            SingleState::of(state).is_none_or(|single| device.singles.contains(&single))
        }
        PathValue::Draws(PathDraws::IndirectCount) => device.indirect_count,
        PathValue::Viewport(PathViewport::Array) => device.second_viewport,
        PathValue::Layers(PathLayers::Written) => device.written_layer,
        PathValue::End(PathEnd::ShaderRead) => device.compute,
        // Only OpenGL has these values.
        PathValue::Target(PathTarget::Renderbuffer)
        | PathValue::Clip(PathClip::Toggled)
        | PathValue::Draws(PathDraws::IndirectBeside)
        | PathValue::End(PathEnd::ReadBuffer) => false,
        PathValue::Reads(PathReads::LocalRead) => device.own_pass.local_read,
        PathValue::Reads(PathReads::FeedbackLoop) => device.own_pass.feedback_loop,
        PathValue::Reads(PathReads::Ordered) => device.own_pass.orders_colors(),
        _ => true,
    };
    PathValue::all().into_iter().filter(has).collect()
}

/// Returns the dynamic states beyond Vulkan 1.3's if state is set in the way of `state`.
pub(crate) fn dynamic_states(device: &Device, state: PathState) -> DynamicStates {
    let extended = matches!(
        state,
        PathState::ExtendedDynamic3 | PathState::BeforePipeline
    );
    let logic = match state {
        PathState::DynamicLogic => DynamicLogic::Operation,
        _ if extended && device.logic_enable => DynamicLogic::All,
        _ => DynamicLogic::Nothing,
    };
    DynamicStates {
        extended,
        logic,
        single: SingleState::of(state),
    }
}

/// Returns the part of a texture that serves as the attachment. If the attachment cannot be the part that the
/// path names, it is a plain image: multisampled images have one level and no cube, and shaders cannot read a
/// slice of a 3D image.
pub(crate) fn target(scene: &Scene, index: usize, attachment: &Attachment) -> PathTarget {
    let single = attachment.samples == 1;
    let read_by_shader = || {
        let mut draws = scene.passes.iter().flat_map(|p| &p.draws);
        let read = scene.path.end == PathEnd::ShaderRead && scene.read.contains(&index);
        read || draws.any(|d| d.textures.contains(&index))
    };
    let can = match scene.path.target {
        PathTarget::MipLevel | PathTarget::LevelOfLayer => single,
        PathTarget::CubeFace => single && attachment.size[0] == attachment.size[1],
        PathTarget::Slice3d => single && attachment.format.is_color() && !read_by_shader(),
        PathTarget::Plain | PathTarget::ArrayLayer | PathTarget::Renderbuffer => true,
    };
    if can {
        scene.path.target
    } else {
        PathTarget::Plain
    }
}

/// Returns the layer that is read of an attachment if passes have several layers. Attachments take turns in
/// it.
pub(crate) fn layer(scene: &Scene, index: usize, role: Role) -> Option<u32> {
    let is_drawn = !matches!(role, Role::Fetched | Role::Idle);
    let layered = is_drawn && scene.layers() != PathLayers::One;
    layered.then(|| DRAWN_LAYERS[(index + 1) % DRAWN_LAYERS.len()])
}

/// Checks that the device can create images of a key that is not plain.
pub(crate) fn check_target(
    device: &Device,
    path: &Path,
    key: &ImageKey,
) -> Result<(), BackendError> {
    let viewed = key.stored != key.format;
    if key.target == PathTarget::Plain && key.layered.is_none() && !viewed {
        return Ok(());
    }
    let shape = key.shape();
    let mutable = if viewed {
        vk::ImageCreateFlags::MUTABLE_FORMAT
    } else {
        vk::ImageCreateFlags::empty()
    };
    // SAFETY: the physical device is of this living instance.
    let properties = unsafe {
        let api = device.instance.raw();
        api.get_physical_device_image_format_properties(
            device.physical,
            key.stored,
            shape.kind,
            vk::ImageTiling::OPTIMAL,
            key.usage,
            shape.flags | mutable,
        )
    };
    let fits = properties.is_ok_and(|p| {
        p.max_extent.width >= shape.extent.width
            && p.max_extent.height >= shape.extent.height
            && p.max_extent.depth >= shape.extent.depth
            && p.max_mip_levels >= shape.levels
            && p.max_array_layers >= shape.layers
            && p.sample_counts.as_raw() & key.samples != 0
    });
    let value = match key.layered {
        _ if viewed => PathValue::Views(path.views),
        None => PathValue::Target(key.target),
        Some(_) => PathValue::Layers(path.layers),
    };
    let value = Requirement::Path(value);
    fits.then_some(()).ok_or(BackendError::NotSupported(value))
}

/// Returns how an attachment reaches the host. Formats whose values a blit can round, or whose codes a shader
/// cannot recover, are read in the default way.
pub(crate) fn end(
    device: &Device,
    path: &Path,
    attachment: &Attachment,
    native: Native,
) -> Result<PathEnd, BackendError> {
    let format = attachment.format;
    let single = attachment.samples == 1;
    let can = match path.end {
        PathEnd::Blit | PathEnd::BlitMirrored | PathEnd::BlitScaled | PathEnd::BlitPart => {
            single && is_blitted_exactly(format)
        }
        PathEnd::BlitLinear => single && is_filtered(format),
        PathEnd::ReadBuffer => false,
        PathEnd::ShaderRead => single && is_fetched_exactly(format, native),
        PathEnd::Part => single,
        PathEnd::Store | PathEnd::Copy => true,
    };
    if !can {
        return Ok(PathEnd::Store);
    }
    let needed = match path.end {
        PathEnd::Blit | PathEnd::BlitMirrored | PathEnd::BlitScaled | PathEnd::BlitPart => BLITS,
        PathEnd::BlitLinear => BLITS | vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR,
        PathEnd::Store
        | PathEnd::Copy
        | PathEnd::ShaderRead
        | PathEnd::Part
        | PathEnd::ReadBuffer => vk::FormatFeatureFlags::empty(),
    };
    if !device.has(native.raw, needed) {
        let value = PathValue::End(path.end);
        return Err(BackendError::NotSupported(Requirement::Path(value)));
    }
    Ok(path.end)
}

/// The format features of a blit's source and destination.
const BLITS: vk::FormatFeatureFlags = vk::FormatFeatureFlags::from_raw(
    vk::FormatFeatureFlags::BLIT_SRC.as_raw() | vk::FormatFeatureFlags::BLIT_DST.as_raw(),
);

/// Returns true if an attachment is copied to another image before it is read.
pub(crate) fn is_copied(end: PathEnd) -> bool {
    match end {
        PathEnd::Copy
        | PathEnd::Blit
        | PathEnd::BlitMirrored
        | PathEnd::BlitScaled
        | PathEnd::BlitPart
        | PathEnd::BlitLinear => true,
        PathEnd::Store | PathEnd::ShaderRead | PathEnd::Part | PathEnd::ReadBuffer => false,
    }
}

/// Returns true if a linear filter supports the format, and half the value of a code, doubled, is that code
/// again.
fn is_filtered(format: TextureFormat) -> bool {
    let halved = |e: &ChannelEncoding| e.is_float() || matches!(e, ChannelEncoding::Unorm(_));
    format.is_color() && format.color_channels().iter().all(halved)
}

fn is_blitted_exactly(format: TextureFormat) -> bool {
    let exact = |e: &ChannelEncoding| e.is_float() || matches!(e, ChannelEncoding::Uint(_));
    format.color_channels().iter().all(exact)
}

fn is_fetched_exactly(format: TextureFormat, native: Native) -> bool {
    let aspects: &[Aspect] = format.aspects();
    aspects.iter().all(|aspect| {
        let channels = format::channels(format, native.raw, *aspect);
        channels.iter().all(|encoding| {
            let twofold = matches!(encoding, ChannelEncoding::Srgb8 | ChannelEncoding::Snorm(_));
            samples::can_read(*encoding) && !twofold
        })
    })
}

/// Returns the render areas of a pass. The pass is recorded once for each.
pub(crate) fn areas(path: &Path, [width, height]: [u32; 2]) -> Vec<vk::Rect2D> {
    let rect = |[x, y]: [u32; 2], [width, height]: [u32; 2]| vk::Rect2D {
        offset: vk::Offset2D {
            x: x.cast_signed(),
            y: y.cast_signed(),
        },
        extent: vk::Extent2D { width, height },
    };
    let columns = |left: u32, width: u32| rect([left, 0], [width, height]);
    // The first odd number from a third on, and its rest.
    let cut = |length: u32| match (length / 3) | 1 {
        first if first < length => vec![(0, first), (first, length - first)],
        _ => vec![(0, length)],
    };
    match path.area {
        PathArea::Quarters => {
            let rows = cut(height).into_iter();
            let each =
                rows.flat_map(|(y, h)| cut(width).into_iter().map(move |(x, w)| [x, y, w, h]));
            each.map(|[x, y, w, h]| rect([x, y], [w, h])).collect()
        }
        PathArea::Part if width > 1 => {
            // Avoids the middle, where tile boundaries often are.
            let left = (width * 2 / 5).max(1);
            vec![columns(0, left), columns(left, width - left)]
        }
        PathArea::Part | PathArea::Full => vec![columns(0, width)],
    }
}

/// Returns a draw whose pipeline differs from this draw's in the state that a pipeline always holds.
pub(crate) fn other(draw: &Draw) -> Draw {
    Draw {
        logic: None,
        multisample: Multisample::default(),
        ..extended::pipeline_draw_of_extended(draw)
    }
}
