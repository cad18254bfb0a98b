//! What to record for a scene, in handles of the device.

use crate::backend::{Pools, VulkanBackend};
use crate::device::Device;
use crate::dynamic::Dynamic;
use crate::inputs::{DrawInputs, PARAMS_BYTES};
use crate::limits::attachment_usage;
use crate::memory::{Image, ImageKey};
use crate::pipeline::{Pipeline, Targets};
use crate::read::ReadPlan;
use crate::slot::Slot;
use ash::vk;
use etalon_backend::BackendError;
use etalon_case::Scene;
use etalon_case::scene::{Attachment, Contents, Draw, Pass};
use etalon_frame::Requirement;
use std::rc::Rc;

/// The whole scene.
#[derive(Default)]
pub(crate) struct Plan {
    pub(crate) attachments: Vec<AttachmentPlan>,
    pub(crate) passes: Vec<PassPlan>,
    pub(crate) reads: Vec<ReadPlan>,
}

/// One attachment's beginning and its place during the passes.
pub(crate) struct AttachmentPlan {
    pub(crate) image: vk::Image,
    pub(crate) aspects: vk::ImageAspectFlags,
    pub(crate) size: [u32; 2],
    pub(crate) samples: u32,
    pub(crate) start: Start,
    pub(crate) role: Role,
    pub(crate) read: bool,
}

/// What an attachment starts from.
pub(crate) enum Start {
    Color([f32; 4]),
    DepthStencil {
        depth: f32,
        stencil: u8,
    },
    /// Texels at this offset of the input buffer.
    Upload(u64),
}

/// What the passes do with an attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// Drawn to, or averaged to.
    Color,
    DepthStencil,
    Fetched,
    /// Nothing; it may be read back all the same.
    Idle,
}

/// One pass.
pub(crate) struct PassPlan {
    pub(crate) size: [u32; 2],
    pub(crate) color: Vec<ColorPlan>,
    pub(crate) depth_stencil: Option<DepthStencilPlan>,
    pub(crate) draws: Vec<DrawPlan>,
}

/// One colour attachment of a pass.
pub(crate) struct ColorPlan {
    pub(crate) view: vk::ImageView,
    /// Where its samples are averaged to at the end.
    pub(crate) resolve: Option<vk::ImageView>,
}

/// The depth-stencil attachment of a pass.
pub(crate) struct DepthStencilPlan {
    /// Its index among the scene's attachments.
    pub(crate) attachment: usize,
    pub(crate) view: vk::ImageView,
    pub(crate) has_depth: bool,
    pub(crate) has_stencil: bool,
    pub(crate) read_only: bool,
}

/// One draw.
pub(crate) struct DrawPlan {
    pub(crate) pipeline: Rc<Pipeline>,
    pub(crate) set: vk::DescriptorSet,
    pub(crate) params: u32,
    pub(crate) vertices: u64,
    /// Where the indices lie, if there are any.
    pub(crate) indices: Option<u64>,
    /// Vertices, or indices where there are any.
    pub(crate) count: u32,
    pub(crate) dynamic: Dynamic,
}

pub(crate) fn internal(message: &str) -> BackendError {
    BackendError::Internal(message.to_owned())
}

impl Role {
    pub(crate) fn of(scene: &Scene, index: usize) -> Self {
        let mut role = Self::Idle;
        for pass in &scene.passes {
            if pass.color.contains(&index) || pass.resolve.contains(&Some(index)) {
                return Self::Color;
            }
            if pass.depth_stencil == Some(index) {
                return Self::DepthStencil;
            }
            if pass.draws.iter().any(|d| d.textures.contains(&index)) {
                role = Self::Fetched;
            }
        }
        role
    }
}

impl Start {
    /// What an attachment starts from, its texels lying at an offset of the input buffer.
    pub(crate) fn of(contents: &Contents, texels: u64) -> Self {
        match contents {
            Contents::Color(color) => Self::Color(*color),
            Contents::DepthStencil { depth, stencil } => Self::DepthStencil {
                depth: *depth,
                stencil: *stencil,
            },
            Contents::Texels(_) => Self::Upload(texels),
        }
    }
}

impl PassPlan {
    /// The pass without its draws.
    pub(crate) fn new(scene: &Scene, pass: &Pass, images: &[Image]) -> Result<Self, BackendError> {
        let image = |index: usize| {
            images
                .get(index)
                .ok_or_else(|| internal("a pass names no attachment"))
        };
        let mut plan = Self {
            size: scene.pass_size(pass),
            color: Vec::with_capacity(pass.color.len()),
            depth_stencil: None,
            draws: Vec::with_capacity(pass.draws.len()),
        };
        for (location, index) in pass.color.iter().enumerate() {
            let resolve = match pass.resolve.get(location).copied().flatten() {
                Some(index) => Some(image(index)?.whole()?),
                None => None,
            };
            plan.color.push(ColorPlan {
                view: image(*index)?.whole()?,
                resolve,
            });
        }
        if let Some(index) = pass.depth_stencil {
            let format = scene.attachments.get(index).map(|a| a.format);
            plan.depth_stencil = Some(DepthStencilPlan {
                attachment: index,
                view: image(index)?.whole()?,
                has_depth: format.is_some_and(|f| f.has_depth()),
                has_stencil: format.is_some_and(|f| f.has_stencil()),
                read_only: pass.depth_stencil_read_only,
            });
        }
        Ok(plan)
    }
}

impl DrawPlan {
    pub(crate) fn new(
        draw: &Draw,
        inputs: &DrawInputs,
        size: [u32; 2],
        pipeline: Rc<Pipeline>,
        set: vk::DescriptorSet,
    ) -> Result<Self, BackendError> {
        Ok(Self {
            pipeline,
            set,
            params: u32::try_from(inputs.params).map_err(|_| internal("inputs too large"))?,
            vertices: inputs.vertices,
            indices: inputs.index_offset(),
            count: u32::try_from(inputs.count).map_err(|_| internal("too many vertices"))?,
            dynamic: Dynamic::new(draw, size, inputs.restarts())?,
        })
    }
}

/// The image that an attachment needs.
pub(crate) fn image_key(
    backend: &VulkanBackend,
    attachment: &Attachment,
    role: Role,
    read: bool,
) -> Result<ImageKey, BackendError> {
    let format = attachment.format;
    let Some(native) = backend.natives.get(&format) else {
        return Err(BackendError::NotSupported(Requirement::Format(format)));
    };
    let mut usage = vk::ImageUsageFlags::TRANSFER_DST;
    match role {
        Role::Color | Role::DepthStencil if !native.attachment => {
            return Err(BackendError::NotSupported(Requirement::Drawing(format)));
        }
        Role::Color | Role::DepthStencil => usage |= attachment_usage(format),
        Role::Fetched => usage |= vk::ImageUsageFlags::SAMPLED,
        Role::Idle => {}
    }
    match (read, attachment.samples) {
        (false, _) => {}
        (true, 1) => usage |= vk::ImageUsageFlags::TRANSFER_SRC,
        // Multisampled images also need a use that views can have.
        (true, _) => usage |= vk::ImageUsageFlags::SAMPLED | attachment_usage(format),
    }
    Ok(ImageKey {
        format: native.raw,
        size: attachment.size,
        samples: attachment.samples,
        usage,
    })
}

/// What a pass's attachments are to its pipelines.
pub(crate) fn targets(
    backend: &VulkanBackend,
    scene: &Scene,
    pass: &Pass,
) -> Result<Targets, BackendError> {
    let attachment = |index: &usize| {
        let attachment = scene
            .attachments
            .get(*index)
            .ok_or_else(|| internal("a pass names no attachment"))?;
        let format = attachment.format;
        let native = backend
            .natives
            .get(&format)
            .ok_or(BackendError::NotSupported(Requirement::Format(format)))?;
        Ok((format, native.raw))
    };
    let mut targets = Targets {
        color: Vec::with_capacity(pass.color.len()),
        depth: vk::Format::UNDEFINED,
        stencil: vk::Format::UNDEFINED,
        samples: scene.pass_samples(pass),
    };
    for index in &pass.color {
        targets.color.push(attachment(index)?.1);
    }
    if let Some(index) = &pass.depth_stencil {
        let (format, raw) = attachment(index)?;
        if format.has_depth() {
            targets.depth = raw;
        }
        if format.has_stencil() {
            targets.stencil = raw;
        }
    }
    Ok(targets)
}

/// A set of the parameters and the textures of a draw.
pub(crate) fn descriptor_set(
    device: &Device,
    pools: &mut Pools,
    slot: &Slot,
    input: vk::Buffer,
    draw: &Draw,
    images: &[Image],
) -> Result<vk::DescriptorSet, BackendError> {
    let layout = pools.pipelines.layout(device, draw.textures.len())?;
    let set = slot.descriptor_set(device, layout.set)?;
    let buffers = [vk::DescriptorBufferInfo {
        buffer: input,
        offset: 0,
        range: PARAMS_BYTES,
    }];
    let mut infos = Vec::with_capacity(draw.textures.len());
    for index in &draw.textures {
        let image = images
            .get(*index)
            .ok_or_else(|| internal("a draw names no attachment"))?;
        infos.push([vk::DescriptorImageInfo {
            sampler: vk::Sampler::null(),
            image_view: image.whole()?,
            image_layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        }]);
    }
    let mut writes = vec![
        vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(0)
            .descriptor_type(vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC)
            .buffer_info(&buffers),
    ];
    for (binding, info) in (1..).zip(&infos) {
        writes.push(
            vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(binding)
                .descriptor_type(vk::DescriptorType::SAMPLED_IMAGE)
                .image_info(info),
        );
    }
    // SAFETY: the set is new, and buffer and views live as long as the scene.
    unsafe { device.raw.update_descriptor_sets(&writes, &[]) };
    Ok(set)
}
