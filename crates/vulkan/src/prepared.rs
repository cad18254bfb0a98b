//! A scene prepared for drawing.

use crate::buffer::{Buffer, BufferUse};
use crate::counting::Counting;
use crate::descriptors::Descriptors;
use crate::error::internal;
use crate::gpu::Gpu;
use crate::image::Image;
use crate::inputs::Inputs;
use crate::plan::{
    AttachmentPlan, DrawPlan, InitialContents, PassPlan, Plan, Role, image_key, is_fetched, targets,
};
use crate::read::ReadPlan;
use crate::record;
use crate::slot::{Needs, Slot};
use etalon_backend::{BackendError, FrameTime, Prepared};
use etalon_frame::Frame;
use etalon_scene::{Contents, Scene};
use std::time::Instant;

/// A scene with all objects that drawing it needs.
pub(crate) struct PreparedScene<'a> {
    gpu: &'a Gpu,
    /// Always present until `drop` takes it.
    slot: Option<Slot>,
    input: Option<Buffer>,
    output: Option<Buffer>,
    /// The buffer that shaders count in, if any shader counts.
    counts: Option<Buffer>,
    images: Vec<Image>,
    plan: Plan,
    progress: Progress,
}

/// The state of the attachments and the output buffer.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Progress {
    /// Not drawn since the start or the last failure.
    NotDrawn,
    /// Drawn.
    Drawn,
    /// Drawn and copied to the output buffer.
    Read,
}

impl<'a> PreparedScene<'a> {
    pub(crate) fn new(gpu: &'a Gpu, scene: &Scene) -> Result<Self, BackendError> {
        if let Some(missing) = gpu.limits.missing(&scene.requirements()) {
            return Err(BackendError::NotSupported(missing));
        }
        // Filled step by step, so that `drop` returns everything wherever a step fails.
        let mut prepared = Self {
            gpu,
            slot: None,
            input: None,
            output: None,
            counts: None,
            images: Vec::new(),
            plan: Plan::default(),
            progress: Progress::NotDrawn,
        };
        prepared.fill(scene)?;
        Ok(prepared)
    }

    fn fill(&mut self, scene: &Scene) -> Result<(), BackendError> {
        let device = &self.gpu.device;
        let mut pools = self.gpu.pools.borrow_mut();
        let pools = &mut *pools;

        let inputs = Inputs::place(device, &self.gpu.natives, scene);
        let memory = &mut pools.memory;
        let input = memory.buffer(device, BufferUse::Input, inputs.bytes)?;
        let input = self.input.insert(input);
        inputs.write(input, scene)?;

        for (index, attachment) in scene.attachments.iter().enumerate() {
            if let Contents::Texels(codes) = &attachment.contents {
                let texels = attachment.size[0] as usize * attachment.size[1] as usize;
                if codes.len() != texels * attachment.format.color_channels().len() {
                    return Err(internal("an upload does not fill its attachment"));
                }
            }
            let role = Role::of(scene, index);
            let (fetched, read) = (is_fetched(scene, index), scene.read.contains(&index));
            let key = image_key(self.gpu, attachment, role, (fetched, read))?;
            let image = pools.memory.image(device, key)?;
            self.plan.attachments.push(AttachmentPlan {
                image: image.raw,
                aspects: image.aspects(),
                size: attachment.size,
                samples: attachment.samples,
                initial: InitialContents::of(attachment, inputs.texels(index)),
                role,
                read,
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
        let mut needs = Needs {
            sets,
            images: textures,
            ..Needs::default()
        };
        self.plan.counting = Counting::new(device, scene);
        let counting = &mut self.plan.counting;
        counting.add_needs(scene, &mut needs);
        let slot = pools.slots.take(device, needs)?;
        let slot = self.slot.insert(slot);
        if counting.bytes > 0 {
            let counts = pools
                .memory
                .buffer(device, BufferUse::Counts, counting.bytes)?;
            self.counts = Some(counts);
        }

        let mut sets = Descriptors::new(input, self.counts.as_ref(), &self.images);
        for (pass, places) in scene.passes.iter().zip(&inputs.draws) {
            let targets = targets(self.gpu, scene, pass)?;
            let mut planned = PassPlan::new(scene, pass, &self.images)?;
            for (draw, place) in pass.draws.iter().zip(places) {
                if draw.targets.len() != pass.color.len() {
                    return Err(internal("a draw lacks a target for each colour attachment"));
                }
                let pipelines = &mut pools.pipelines;
                let made = (&mut *pipelines, &mut pools.samplers);
                let set = sets.get(device, made, slot, counting, draw)?;
                let pipeline = pipelines.get(device, &targets, draw)?;
                let queries = counting.queries(slot, draw)?;
                let drawn = DrawPlan::new(draw, place, planned.size, pipeline, set, queries)?;
                planned.draws.push(drawn);
            }
            self.plan.passes.push(planned);
        }

        let (reads, bytes) = ReadPlan::all(self.gpu, scene)?;
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
}

impl Prepared for PreparedScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let device = &self.gpu.device;
        let (Some(slot), Some(input)) = (&mut self.slot, &self.input) else {
            return Err(internal("the scene is not prepared"));
        };
        self.progress = Progress::NotDrawn;
        let start = Instant::now();
        let commands = slot.begin(device)?;
        slot.reset_timestamps(device);
        let counting = &self.plan.counting;
        counting.reset(device, commands, slot, self.counts.as_ref())?;
        record::initial_contents(device, commands, &self.plan, input.raw);
        slot.timestamp(device, 0);
        record::passes(device, commands, &self.plan, input.raw);
        slot.timestamp(device, 1);
        counting.end(device, commands);
        let (cpu, wall) = slot.submit(device, start)?;
        self.progress = Progress::Drawn;
        let gpu = slot.gpu_time(device)?;
        Ok(FrameTime { cpu, gpu, wall })
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let device = &self.gpu.device;
        let (Some(slot), Some(output)) = (&mut self.slot, &self.output) else {
            return Err(internal("the scene is not prepared"));
        };
        match self.progress {
            Progress::NotDrawn => return Err(internal("read back before anything was drawn")),
            Progress::Drawn => {
                let start = Instant::now();
                let commands = slot.begin(device)?;
                record::reads(device, commands, &self.plan, output.raw);
                self.progress = Progress::NotDrawn;
                slot.submit(device, start)?;
                self.progress = Progress::Read;
            }
            // The codes are still in the output buffer.
            Progress::Read => {}
        }
        let mut frame = Frame {
            images: Vec::with_capacity(self.plan.reads.len()),
            counters: self
                .plan
                .counting
                .read(device, slot, self.counts.as_ref())?,
        };
        for read in &self.plan.reads {
            frame.images.push(read.image(output, self.gpu.read_fault)?);
        }
        Ok(frame)
    }
}

impl Drop for PreparedScene<'_> {
    fn drop(&mut self) {
        let device = &self.gpu.device;
        let mut pools = self.gpu.pools.borrow_mut();
        // The slot first, since it waits for the device if work is in flight.
        if let Some(slot) = self.slot.take() {
            pools.slots.give_back(device, slot);
        }
        let buffers = [self.input.take(), self.output.take(), self.counts.take()];
        pools
            .memory
            .give_back(device, buffers.into_iter().flatten(), self.images.drain(..));
    }
}
