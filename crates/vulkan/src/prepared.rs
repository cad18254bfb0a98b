//! A scene turned into objects of the device.

use crate::backend::{Pools, VulkanBackend};
use crate::device::Device;
use crate::inputs::{Inputs, PARAMS_BYTES};
use crate::limits::attachment_usage;
use crate::memory::{Buffer, BufferUse, Image, ImageKey};
use crate::pipeline::{Pipeline, Targets};
use crate::read::ReadPlan;
use crate::record;
use crate::slot::Slot;
use ash::vk;
use etalon_backend::{Backend, BackendError, FrameTime, Prepared};
use etalon_case::Scene;
use etalon_case::scene::{Attachment, Contents, Draw, Pass, StencilState};
use etalon_frame::{Frame, Requirement};
use std::collections::HashMap;
use std::rc::Rc;
use std::time::Instant;

/// A scene with everything that drawing it takes.
pub(crate) struct PreparedScene<'a> {
    backend: &'a VulkanBackend,
    /// Taken by `drop` alone.
    slot: Option<Slot>,
    input: Option<Buffer>,
    output: Option<Buffer>,
    images: Vec<Image>,
    plan: Plan,
    drawn: Drawn,
}

/// What to record, in handles.
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
    Color,
    DepthStencil,
    Fetched,
    /// Nothing; it may be read back all the same.
    Idle,
}

/// One pass.
pub(crate) struct PassPlan {
    pub(crate) size: [u32; 2],
    pub(crate) color: Vec<vk::ImageView>,
    pub(crate) depth: Option<vk::ImageView>,
    pub(crate) stencil: Option<vk::ImageView>,
    pub(crate) draws: Vec<DrawPlan>,
}

/// One draw.
pub(crate) struct DrawPlan {
    pub(crate) pipeline: Rc<Pipeline>,
    pub(crate) set: vk::DescriptorSet,
    pub(crate) params: u32,
    pub(crate) vertices: u64,
    pub(crate) count: u32,
    pub(crate) blend_constant: [f32; 4],
    pub(crate) stencil: Option<StencilState>,
}

/// Where a scene stands.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Drawn {
    /// Not yet, or a failure came between.
    No,
    /// The attachments are as the passes left them.
    Passes,
    /// The attachments have been read, and lie as reading needs them.
    Read,
}

fn internal(message: &str) -> BackendError {
    BackendError::Internal(message.to_owned())
}

impl<'a> PreparedScene<'a> {
    pub(crate) fn new(backend: &'a VulkanBackend, scene: &Scene) -> Result<Self, BackendError> {
        if let Some(missing) = backend.limits().missing(&scene.requirements()) {
            return Err(BackendError::NotSupported(missing));
        }
        // Filled bit by bit, so that `drop` gives everything back wherever it ends.
        let mut prepared = Self {
            backend,
            slot: None,
            input: None,
            output: None,
            images: Vec::new(),
            plan: Plan::default(),
            drawn: Drawn::No,
        };
        prepared.fill(scene)?;
        Ok(prepared)
    }

    fn fill(&mut self, scene: &Scene) -> Result<(), BackendError> {
        let device = &self.backend.device;
        let mut pools = self.backend.pools.borrow_mut();
        let pools = &mut *pools;

        let inputs = Inputs::place(device, scene);
        let memory = &mut pools.memory;
        let input = memory.buffer(device, BufferUse::Input, inputs.bytes)?;
        let input = self.input.insert(input);
        inputs.write(input, scene)?;
        let input = input.raw;

        for (index, attachment) in scene.attachments.iter().enumerate() {
            if let Contents::Texels(codes) = &attachment.contents {
                let texels = attachment.size[0] as usize * attachment.size[1] as usize;
                if codes.len() != texels * attachment.format.color_channels().len() {
                    return Err(internal("an upload does not fill its attachment"));
                }
            }
            let role = role(scene, index);
            let key = self.image_key(attachment, role, scene.read.contains(&index))?;
            let image = pools.memory.image(device, key)?;
            self.plan.attachments.push(AttachmentPlan {
                image: image.raw,
                aspects: image.aspects(),
                size: attachment.size,
                samples: attachment.samples,
                start: start(&attachment.contents, inputs.texels(index)),
                role,
                read: scene.read.contains(&index),
            });
            self.images.push(image);
        }

        let draws = || scene.passes.iter().flat_map(|p| &p.draws);
        let textures = draws().map(|d| d.textures.len()).max().unwrap_or(0);
        let reads = scene.read.len() * 2;
        let (Ok(sets), Ok(textures)) = (
            u32::try_from(draws().count() + reads),
            u32::try_from(textures),
        ) else {
            return Err(internal("too many draws"));
        };
        let slot = pools.slots.take(device, sets, textures)?;
        let slot = self.slot.insert(slot);

        let mut sets = HashMap::new();
        for (pass, offsets) in scene.passes.iter().zip(&inputs.draws) {
            let targets = self.backend.targets(scene, pass)?;
            let mut planned = pass_plan(scene, pass, &self.images)?;
            for (draw, (vertices, params)) in pass.draws.iter().zip(offsets) {
                if draw.targets.len() != pass.color.len() {
                    return Err(internal("a draw has not one target per colour attachment"));
                }
                if draw.textures.len() != draw.shader.textures() {
                    return Err(internal(
                        "a draw has not the textures its shader fetches from",
                    ));
                }
                let set = match sets.get(&draw.textures) {
                    Some(set) => *set,
                    None => {
                        let set = descriptor_set(device, pools, slot, input, draw, &self.images)?;
                        sets.insert(draw.textures.clone(), set);
                        set
                    }
                };
                planned.draws.push(DrawPlan {
                    pipeline: pools.pipelines.get(device, &targets, draw)?,
                    set,
                    params: u32::try_from(*params).map_err(|_| internal("inputs too large"))?,
                    vertices: *vertices,
                    count: u32::try_from(draw.mesh.vertices.len())
                        .map_err(|_| internal("too many vertices"))?,
                    blend_constant: draw.blend_constant,
                    stencil: draw.stencil,
                });
            }
            self.plan.passes.push(planned);
        }

        let (reads, bytes) = ReadPlan::all(self.backend, scene)?;
        let output = pools.memory.buffer(device, BufferUse::Output, bytes)?;
        let output = self.output.insert(output);
        self.plan.reads = reads;
        for read in &mut self.plan.reads {
            let image = self
                .images
                .get(read.attachment)
                .ok_or_else(|| internal("a read names no attachment"))?;
            read.connect(device, &mut pools.readers, slot, image, output)?;
        }
        Ok(())
    }

    fn image_key(
        &self,
        attachment: &Attachment,
        role: Role,
        read: bool,
    ) -> Result<ImageKey, BackendError> {
        let unsupported = BackendError::NotSupported(Requirement::Format(attachment.format));
        let Some(native) = self.backend.natives.get(&attachment.format) else {
            return Err(unsupported);
        };
        let mut usage = vk::ImageUsageFlags::TRANSFER_DST;
        match role {
            Role::Color | Role::DepthStencil if !native.attachment => return Err(unsupported),
            Role::Color | Role::DepthStencil => usage |= attachment_usage(attachment.format),
            Role::Fetched => usage |= vk::ImageUsageFlags::SAMPLED,
            Role::Idle => {}
        }
        match (read, attachment.samples) {
            (false, _) => {}
            (true, 1) => usage |= vk::ImageUsageFlags::TRANSFER_SRC,
            // Multisampled images also need a use that views can have.
            (true, _) => {
                usage |= vk::ImageUsageFlags::SAMPLED | attachment_usage(attachment.format);
            }
        }
        Ok(ImageKey {
            format: native.raw,
            size: attachment.size,
            samples: attachment.samples,
            usage,
        })
    }
}

impl VulkanBackend {
    fn targets(&self, scene: &Scene, pass: &Pass) -> Result<Targets, BackendError> {
        let attachment = |index: &usize| {
            let attachment = scene
                .attachments
                .get(*index)
                .ok_or_else(|| internal("a pass names no attachment"))?;
            let native = self
                .natives
                .get(&attachment.format)
                .ok_or(BackendError::NotSupported(Requirement::Format(
                    attachment.format,
                )))?;
            Ok((attachment, native.raw))
        };
        let mut targets = Targets {
            color: Vec::with_capacity(pass.color.len()),
            depth: vk::Format::UNDEFINED,
            stencil: vk::Format::UNDEFINED,
            samples: 1,
        };
        for index in &pass.color {
            let (attachment, raw) = attachment(index)?;
            targets.color.push(raw);
            targets.samples = attachment.samples;
        }
        if let Some(index) = &pass.depth_stencil {
            let (attachment, raw) = attachment(index)?;
            if attachment.format.has_depth() {
                targets.depth = raw;
            }
            if attachment.format.has_stencil() {
                targets.stencil = raw;
            }
            targets.samples = attachment.samples;
        }
        let most = self.device.limits.max_color_attachments;
        if targets.color.len() as u64 > u64::from(most) {
            return Err(BackendError::Resource {
                what: format!("{} colour attachments", targets.color.len()),
                message: format!("the device has at most {most}"),
            });
        }
        Ok(targets)
    }
}

fn role(scene: &Scene, index: usize) -> Role {
    let mut role = Role::Idle;
    for pass in &scene.passes {
        if pass.color.contains(&index) {
            return Role::Color;
        }
        if pass.depth_stencil == Some(index) {
            return Role::DepthStencil;
        }
        if pass.draws.iter().any(|d| d.textures.contains(&index)) {
            role = Role::Fetched;
        }
    }
    role
}

/// What an attachment starts from, its texels lying at an offset of the input buffer.
fn start(contents: &Contents, texels: u64) -> Start {
    match contents {
        Contents::Color(color) => Start::Color(*color),
        Contents::DepthStencil { depth, stencil } => Start::DepthStencil {
            depth: *depth,
            stencil: *stencil,
        },
        Contents::Texels(_) => Start::Upload(texels),
    }
}

fn pass_plan(scene: &Scene, pass: &Pass, images: &[Image]) -> Result<PassPlan, BackendError> {
    let image = |index: usize| {
        images
            .get(index)
            .ok_or_else(|| internal("a pass names no attachment"))
    };
    let mut plan = PassPlan {
        size: [0; 2],
        color: Vec::with_capacity(pass.color.len()),
        depth: None,
        stencil: None,
        draws: Vec::with_capacity(pass.draws.len()),
    };
    for index in &pass.color {
        let image = image(*index)?;
        plan.color.push(image.whole()?);
        plan.size = image.key.size;
    }
    if let Some(index) = pass.depth_stencil {
        let image = image(index)?;
        let format = scene.attachments.get(index).map(|a| a.format);
        let view = image.whole()?;
        plan.depth = format.is_some_and(|f| f.has_depth()).then_some(view);
        plan.stencil = format.is_some_and(|f| f.has_stencil()).then_some(view);
        plan.size = image.key.size;
    }
    Ok(plan)
}

fn descriptor_set(
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

impl Prepared for PreparedScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let device = &self.backend.device;
        let (Some(slot), Some(input)) = (&mut self.slot, &self.input) else {
            return Err(internal("the scene is not prepared"));
        };
        self.drawn = Drawn::No;
        let start = Instant::now();
        let commands = slot.begin(device)?;
        slot.reset_timestamps(device);
        record::start(device, commands, &self.plan, input.raw);
        slot.timestamp(device, 0);
        record::passes(device, commands, &self.plan, input.raw);
        slot.timestamp(device, 1);
        let (cpu, wall) = slot.submit(device, start)?;
        self.drawn = Drawn::Passes;
        let gpu = slot.gpu_time(device)?;
        Ok(FrameTime { cpu, gpu, wall })
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let device = &self.backend.device;
        let (Some(slot), Some(output)) = (&mut self.slot, &self.output) else {
            return Err(internal("the scene is not prepared"));
        };
        match self.drawn {
            Drawn::No => return Err(internal("read back before anything was drawn")),
            Drawn::Passes => {
                let start = Instant::now();
                let commands = slot.begin(device)?;
                record::reads(device, commands, &self.plan, output.raw);
                self.drawn = Drawn::No;
                slot.submit(device, start)?;
                self.drawn = Drawn::Read;
            }
            // The codes still lie in the output buffer.
            Drawn::Read => {}
        }
        let mut frame = Frame::default();
        for read in &self.plan.reads {
            frame.images.push(read.image(output)?);
        }
        Ok(frame)
    }
}

impl Drop for PreparedScene<'_> {
    fn drop(&mut self) {
        let device = &self.backend.device;
        let mut pools = self.backend.pools.borrow_mut();
        // The slot first: it waits for the device where that is still due.
        if let Some(slot) = self.slot.take() {
            pools.slots.give_back(device, slot);
        }
        let buffers = self.input.take().into_iter().chain(self.output.take());
        pools
            .memory
            .give_back(device, buffers, self.images.drain(..));
    }
}
