//! The commands of a scene in terms of device handles, recorded again at each submit.

use crate::attached::{ColorPlan, DepthStencilPlan};
use crate::clear::{ClearPlan, Ends, color_value, depth_stencil_value};
use crate::counting::{CounterQueries, PoolQuery};
use crate::dynamic::Dynamic;
use crate::error::internal;
use crate::extended::DynamicValues;
use crate::format;
use crate::gpu::Gpu;
use crate::image::{DeviceImage, ImageKey, ImagePlace};
use crate::inputs::{Arguments, CallNumbers, DrawInputs};
use crate::limits::attachment_usage;
use crate::own_pass;
use crate::path;
use crate::pipeline::Pipeline;
use crate::read::ReadPlan;
use crate::render_pass::RenderPass;
use crate::role::{Role, roles_by};
use crate::single::Single;
use crate::state;
use crate::targets::Targets;
use ash::vk;
use etalon_backend::{BackendError, Blits};
use etalon_frame::{
    PathClears, PathEnd, PathTarget, PathTests, PathValue, Requirement, TextureFormat,
};
use etalon_scene::{Attachment, AttachmentContents, ClearTarget, Draw, Enclosing, Pass, Scene};
use std::rc::Rc;

/// The plan of a scene.
#[derive(Default)]
pub(crate) struct ScenePlan {
    pub(crate) attachments: Vec<AttachmentPlan>,
    pub(crate) passes: Vec<PassPlan>,
    pub(crate) reads: Vec<ReadPlan>,
    pub(crate) counting: CounterQueries,
    /// True if shaders use the scene's pool.
    pub(crate) pool: bool,
}

/// The initial contents of an attachment and its role in the passes.
pub(crate) struct AttachmentPlan {
    pub(crate) image: vk::Image,
    /// The part of the image that serves as the attachment.
    pub(crate) place: ImagePlace,
    /// The route by which the attachment reaches the host.
    pub(crate) end: PathEnd,
    /// The image to which the attachment is copied before it is read.
    pub(crate) copy: Option<vk::Image>,
    /// The intermediate image that blits write, from which it is copied.
    pub(crate) between: Option<vk::Image>,
    pub(crate) aspects: vk::ImageAspectFlags,
    pub(crate) size: [u32; 2],
    pub(crate) samples: u32,
    pub(crate) initial: InitialContents,
    /// The view that a load operation clears, if a transfer would convert the colour to another format.
    pub(crate) cleared: Option<vk::ImageView>,
    /// The role before the first pass and after the last.
    pub(crate) role: Role,
    pub(crate) read: bool,
}

/// The initial contents of an attachment.
pub(crate) enum InitialContents {
    Color(vk::ClearColorValue),
    DepthStencil {
        depth: f32,
        stencil: u8,
    },
    /// Texels at this offset of the input buffer.
    Upload(u64),
}

/// Returns true if a draw has an advanced blend.
pub(crate) fn is_advanced(draw: &Draw) -> bool {
    draw.targets.iter().any(|t| t.advanced.is_some())
}

/// A resolve of an attachment to another through an intermediate image.
#[derive(Clone)]
pub(crate) struct MovedResolve {
    pub(crate) from: usize,
    pub(crate) to: usize,
    /// The intermediate image.
    pub(crate) image: vk::Image,
    /// The part of the intermediate image that is used.
    pub(crate) place: ImagePlace,
}

/// The plan of a pass.
pub(crate) struct PassPlan {
    pub(crate) size: [u32; 2],
    pub(crate) area: vk::Rect2D,
    pub(crate) targets: Targets,
    /// True if a draw has an advanced blend.
    pub(crate) advanced: bool,
    /// The render pass object; `None` for dynamic rendering.
    pub(crate) object: Option<RenderPass>,
    /// The attachments that the pass uses, each once, with their roles.
    pub(crate) roles: Vec<(usize, Role)>,
    pub(crate) color: Vec<ColorPlan>,
    pub(crate) depth_stencil: Option<DepthStencilPlan>,
    pub(crate) draws: Vec<DrawPlan>,
    /// Clear commands in order, each with the index of the draw that it precedes.
    pub(crate) clears: Vec<(usize, ClearPlan)>,
    /// The resolves after the pass.
    pub(crate) resolves: Vec<MovedResolve>,
    /// The queries that begin before the pass, and the queries that end after it.
    pub(crate) queries: Enclosing<PoolQuery>,
}

/// The plan of a draw.
pub(crate) struct DrawPlan {
    pub(crate) pipeline: Rc<Pipeline>,
    /// The pipeline that is bound for a moment between setting the state and drawing.
    pub(crate) other: Option<Rc<Pipeline>>,
    /// The pipeline of a second draw, which repeats the draw to the other of two layers.
    pub(crate) again: Option<Rc<Pipeline>>,
    /// True if the state is first set to other values.
    pub(crate) overwritten: bool,
    /// True if calls without vertices and without instances precede the draw.
    pub(crate) after_empty: bool,
    /// True if the state is set before the pipeline is bound.
    pub(crate) before_pipeline: bool,
    /// The values of the dynamic states beyond Vulkan 1.3's, if the path asks for them.
    pub(crate) beyond: Option<DynamicValues>,
    /// The state that is dynamic alone, if the path asks for one.
    pub(crate) single: Option<Single>,
    /// The arguments of an indirect draw.
    pub(crate) arguments: Option<Arguments>,
    pub(crate) set: vk::DescriptorSet,
    pub(crate) params: u32,
    pub(crate) vertices: u64,
    /// The offset of the indices and their type, in an indexed draw.
    pub(crate) indices: Option<(u64, vk::IndexType)>,
    /// The offset of the colours of instances.
    pub(crate) colors: Option<u64>,
    pub(crate) call: CallNumbers,
    pub(crate) dynamic: Dynamic,
    /// The queries that begin before the draw, and the queries that end after it.
    pub(crate) queries: Enclosing<PoolQuery>,
}

/// Returns true if a shader of another pass than the attachment's own reads it.
pub(crate) fn is_fetched(scene: &Scene, index: usize) -> bool {
    let mut passes = scene.passes.iter().filter(|pass| !pass.attaches(index));
    passes.any(|pass| pass.draws.iter().any(|d| d.textures.contains(&index)))
}

impl InitialContents {
    /// Returns the initial contents of an attachment. `texels` is the offset of its texels in the input
    /// buffer.
    pub(crate) fn of(attachment: &Attachment, texels: u64) -> Self {
        match &attachment.contents {
            AttachmentContents::Color(color) => {
                Self::Color(color_value(*color, attachment.format.is_integer()))
            }
            AttachmentContents::DepthStencil { depth, stencil } => Self::DepthStencil {
                depth: *depth,
                stencil: *stencil,
            },
            AttachmentContents::Texels(_) => Self::Upload(texels),
        }
    }
}

impl PassPlan {
    /// Returns the plan of a pass over an area of its attachments, without its draws and render pass object.
    /// One aspect of the plan after the other.
    pub(crate) fn new(
        scene: &Scene,
        pass: &Pass,
        images: &[DeviceImage],
        area: vk::Rect2D,
        targets: Targets,
    ) -> Result<Self, BackendError> {
        let image = |index: usize| {
            images
                .get(index)
                .ok_or_else(|| internal("a pass names no attachment"))
        };
        let mut plan = Self {
            size: scene.pass_size(pass),
            area,
            targets,
            advanced: pass.draws.iter().any(is_advanced),
            object: None,
            roles: Vec::new(),
            color: Vec::with_capacity(pass.color.len()),
            depth_stencil: None,
            draws: Vec::with_capacity(pass.draws.len()),
            clears: Vec::with_capacity(pass.clears.len()),
            resolves: Vec::new(),
            queries: Enclosing::default(),
        };
        plan.roles = roles_by(pass, plan.targets.reads);
        let layout = |index: usize| {
            let mut roles = plan.roles.iter();
            let role = roles.find(|(attached, _)| *attached == index);
            role.map_or(vk::ImageLayout::UNDEFINED, |(_, role)| role.state().layout)
        };
        let integer = |location: usize| {
            let index = pass.color.get(location);
            let attachment = index.and_then(|i| scene.attachments.get(*i));
            attachment.is_some_and(|a| a.format.is_integer())
        };
        let undefined = scene.path.clears == PathClears::Undefined;
        let loads = if undefined {
            pass.loading_clears()
        } else {
            Vec::new()
        };
        for clear in loads.iter().chain(&pass.clears) {
            let integer =
                matches!(clear.target, ClearTarget::Color { location, .. } if integer(location));
            let layers = scene.layers();
            let Some(planned) = ClearPlan::new(clear, integer, layers, plan.size, area)? else {
                continue;
            };
            let together = scene.path.clears == PathClears::Together;
            let last = plan.clears.last_mut().filter(|_| together);
            let last = last.filter(|(before, _)| *before == clear.before);
            if !last.is_some_and(|(_, last)| last.takes(&planned)) {
                plan.clears.push((clear.before, planned));
            }
        }
        for (location, index) in pass.color.iter().enumerate() {
            let moved = pass.moved_resolves(&scene.path).any(|(l, _)| l == location);
            let target = pass.resolve.get(location).copied().flatten();
            let resolve = match target.filter(|_| !moved) {
                Some(index) => {
                    let integer = scene
                        .attachments
                        .get(index)
                        .is_some_and(|a| a.format.is_integer());
                    // Integers resolve to the value of one sample (VkRenderingAttachmentInfo).
                    let mode = if integer {
                        vk::ResolveModeFlags::SAMPLE_ZERO
                    } else {
                        vk::ResolveModeFlags::AVERAGE
                    };
                    Some((image(index)?.attached()?, mode))
                }
                None => None,
            };
            let value = |color| vk::ClearValue {
                color: color_value(color, integer(location)),
            };
            plan.color.push(ColorPlan {
                view: if scene.is_gap(*index) {
                    vk::ImageView::null()
                } else {
                    image(*index)?.attached()?
                },
                layout: layout(*index),
                ends: Ends::new(pass.color_operations(location), value),
                resolve,
            });
        }
        if let Some(index) = pass.depth_stencil {
            let format = scene.attachments.get(index).map(|a| a.format);
            plan.depth_stencil = Some(DepthStencilPlan {
                view: image(index)?.attached()?,
                layout: layout(index),
                depth: format
                    .is_some_and(|f| f.has_depth())
                    .then(|| Ends::new(pass.operations.depth, |v| depth_stencil_value(v, 0))),
                stencil: format
                    .is_some_and(|f| f.has_stencil())
                    .then(|| Ends::new(pass.operations.stencil, |v| depth_stencil_value(0.0, v))),
                read_only: pass.depth_stencil_read_only,
                resolve: match &pass.depth_stencil_resolve {
                    None => None,
                    Some(resolve) => {
                        let modes = [resolve.depth, resolve.stencil].map(state::resolve_mode);
                        Some((image(resolve.to)?.attached()?, modes))
                    }
                },
            });
        }
        if undefined {
            let colors = plan.color.iter_mut().map(|target| &mut target.ends);
            let tested = plan.depth_stencil.iter_mut();
            let tested = tested.flat_map(|p| p.depth.iter_mut().chain(&mut p.stencil));
            for ends in colors.chain(tested) {
                ends.leave_undefined();
            }
        }
        Ok(plan)
    }
}

impl DrawPlan {
    pub(crate) fn new(
        inputs: &DrawInputs,
        dynamic: Dynamic,
        pipeline: Rc<Pipeline>,
        set: vk::DescriptorSet,
        queries: Enclosing<PoolQuery>,
    ) -> Result<Self, BackendError> {
        Ok(Self {
            pipeline,
            other: None,
            again: None,
            overwritten: false,
            after_empty: false,
            before_pipeline: false,
            beyond: None,
            single: None,
            set,
            params: u32::try_from(inputs.params).map_err(|_| internal("inputs too large"))?,
            vertices: inputs.vertices,
            indices: inputs.indices,
            colors: inputs.colors,
            arguments: inputs.arguments,
            call: inputs.call,
            dynamic,
            queries,
        })
    }
}

/// Returns the key of an attachment's image. Its usage allows what the scene does with it: fetches by
/// shaders, and reading back.
pub(crate) fn image_key(
    gpu: &Gpu,
    scene: &Scene,
    index: usize,
    role: Role,
    end: PathEnd,
) -> Result<ImageKey, BackendError> {
    let attachment = &scene.attachments[index];
    let (fetched, read) = (is_fetched(scene, index), scene.read.contains(&index));
    let format = attachment.format;
    let native = format::native(&gpu.natives, format)?;
    let mut usage = vk::ImageUsageFlags::TRANSFER_DST;
    match role {
        Role::Color
        | Role::DepthStencil
        | Role::DepthStencilReadOnly
        | Role::DepthStencilResolve
            if !native.attachment =>
        {
            return Err(BackendError::NotSupported(Requirement::Drawing(format)));
        }
        Role::Color
        | Role::DepthStencil
        | Role::DepthStencilReadOnly
        | Role::DepthStencilResolve => usage |= attachment_usage(format),
        Role::Fetched | Role::Own(_) | Role::Idle => {}
    }
    if fetched {
        usage |= vk::ImageUsageFlags::SAMPLED;
    }
    for pass in scene
        .passes
        .iter()
        .filter(|_| own_pass::is_read(scene, index))
    {
        if let Some(way) = own_pass::way(gpu.device.own_pass, scene, pass)? {
            usage |= own_pass::usage(way);
        }
    }
    if read && end == PathEnd::ShaderRead {
        usage |= vk::ImageUsageFlags::SAMPLED;
    }
    if read && path::is_copied(end) {
        usage |= vk::ImageUsageFlags::TRANSFER_SRC;
    }
    let resolved = |pass: &Pass| {
        let mut moved = pass.moved_resolves(&scene.path);
        moved.any(|(location, _)| pass.color.get(location) == Some(&index))
    };
    if scene.passes.iter().any(resolved) {
        usage |= vk::ImageUsageFlags::TRANSFER_SRC;
    }
    let stored = format::viewed(native.raw, scene.path.views).unwrap_or(native.raw);
    if stored != native.raw && matches!(attachment.contents, AttachmentContents::Color(_)) {
        if !native.attachment {
            return Err(BackendError::NotSupported(Requirement::Drawing(format)));
        }
        usage |= attachment_usage(format);
    }
    match (read, attachment.samples) {
        (false, _) => {}
        (true, 1) => usage |= vk::ImageUsageFlags::TRANSFER_SRC,
        // A multisampled image is viewed, which needs a usage that allows views.
        (true, _) => usage |= vk::ImageUsageFlags::SAMPLED | attachment_usage(format),
    }
    Ok(ImageKey {
        format: native.raw,
        stored,
        size: attachment.size,
        samples: attachment.samples,
        usage,
        target: path::target(scene, index, attachment),
        layered: path::layer(scene, index, role),
    })
}

/// Returns the size of the intermediate image between an attachment of this size and its copy, or `None` if
/// the path has no intermediate image.
fn between(end: PathEnd, size: [u32; 2]) -> Option<[u32; 2]> {
    match end {
        PathEnd::BlitLinear => Some([2 * size[0], size[1]]),
        _ => Blits::new(end, size).map(|blits| blits.size()),
    }
}

/// Returns the key of the intermediate image that blits move an attachment to, if the path has one.
pub(crate) fn between_key(key: ImageKey, end: PathEnd) -> Option<ImageKey> {
    let size = between(end, key.size)?;
    Some(ImageKey {
        size,
        stored: key.format,
        usage: vk::ImageUsageFlags::TRANSFER_DST | vk::ImageUsageFlags::TRANSFER_SRC,
        target: PathTarget::Plain,
        layered: None,
        ..key
    })
}

/// Returns the key of the intermediate image of a resolve. `key` is that of the resolve's target, whose level
/// and layer it takes.
pub(crate) fn resolve_key(key: ImageKey) -> ImageKey {
    ImageKey {
        usage: vk::ImageUsageFlags::TRANSFER_DST | vk::ImageUsageFlags::TRANSFER_SRC,
        ..key
    }
}

/// Returns the key of the image that an attachment is copied to before it is read.
pub(crate) fn copy_key(key: ImageKey, attachment: &Attachment) -> ImageKey {
    ImageKey {
        usage: match attachment.samples {
            1 => vk::ImageUsageFlags::TRANSFER_DST | vk::ImageUsageFlags::TRANSFER_SRC,
            _ => {
                vk::ImageUsageFlags::TRANSFER_DST
                    | vk::ImageUsageFlags::SAMPLED
                    | attachment_usage(attachment.format)
            }
        },
        target: PathTarget::Plain,
        layered: None,
        stored: key.format,
        ..key
    }
}

/// Returns the formats and sample count of a pass's attachments.
pub(crate) fn targets(gpu: &Gpu, scene: &Scene, pass: &Pass) -> Result<Targets, BackendError> {
    let attachment = |index: &usize| {
        let attachment = scene
            .attachments
            .get(*index)
            .ok_or_else(|| internal("a pass names no attachment"))?;
        let format = attachment.format;
        Ok((format, format::native(&gpu.natives, format)?.raw))
    };
    let mut targets = Targets {
        color: Vec::with_capacity(pass.color.len()),
        depth: vk::Format::UNDEFINED,
        stencil: vk::Format::UNDEFINED,
        samples: scene.pass_samples(pass),
        layers: scene.layers(),
        reads: own_pass::way(gpu.device.own_pass, scene, pass)?,
    };
    for index in &pass.color {
        targets.color.push(if scene.is_gap(*index) {
            vk::Format::UNDEFINED
        } else {
            attachment(index)?.1
        });
    }
    if let Some(index) = &pass.depth_stencil {
        let (format, raw) = attachment(index)?;
        // In a render pass object, a native aspect that the format lacks would be attached.
        let tests = scene.path.tests;
        if tests != PathTests::Off && format::aspect_mask(raw) != aspects(format) {
            let value = Requirement::Path(PathValue::Tests(tests));
            return Err(BackendError::NotSupported(value));
        }
        if format.has_depth() {
            targets.depth = raw;
        }
        if format.has_stencil() {
            targets.stencil = raw;
        }
    }
    Ok(targets)
}

/// Returns the aspects of a format.
fn aspects(format: TextureFormat) -> vk::ImageAspectFlags {
    let flags = format.aspects().iter().map(|a| format::aspect_flag(*a));
    flags.fold(vk::ImageAspectFlags::empty(), |aspects, flag| {
        aspects | flag
    })
}
