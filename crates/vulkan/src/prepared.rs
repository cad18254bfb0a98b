//! A scene turned into objects of the device.

use crate::counting::Counting;
use crate::descriptors::Descriptors;
use crate::error::internal;
use crate::gpu::Gpu;
use crate::inputs::Inputs;
use crate::memory::{Buffer, BufferUse, Image};
use crate::plan::{
    AttachmentPlan, DrawPlan, PassPlan, Plan, Role, Start, image_key, is_fetched, targets,
};
use crate::read::ReadPlan;
use crate::record;
use crate::slot::{Needs, Slot};
use etalon_backend::{BackendError, FrameTime, Prepared};
use etalon_frame::Frame;
use etalon_scene::{Contents, Scene};
use std::time::Instant;

/// A scene with everything that drawing it takes.
pub(crate) struct PreparedScene<'a> {
    gpu: &'a Gpu,
    /// Taken by `drop` alone.
    slot: Option<Slot>,
    input: Option<Buffer>,
    output: Option<Buffer>,
    /// What shaders count in, where any do.
    counts: Option<Buffer>,
    images: Vec<Image>,
    plan: Plan,
    drawn: Drawn,
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

impl<'a> PreparedScene<'a> {
    pub(crate) fn new(gpu: &'a Gpu, scene: &Scene) -> Result<Self, BackendError> {
        if let Some(missing) = gpu.limits.missing(&scene.requirements()) {
            return Err(BackendError::NotSupported(missing));
        }
        // Filled bit by bit, so that `drop` gives everything back wherever it ends.
        let mut prepared = Self {
            gpu,
            slot: None,
            input: None,
            output: None,
            counts: None,
            images: Vec::new(),
            plan: Plan::default(),
            drawn: Drawn::No,
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
                start: Start::of(attachment, inputs.texels(index)),
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
                    return Err(internal("a draw has not one target per colour attachment"));
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
        self.drawn = Drawn::No;
        let start = Instant::now();
        let commands = slot.begin(device)?;
        slot.reset_timestamps(device);
        let counting = &self.plan.counting;
        counting.start(device, commands, slot, self.counts.as_ref())?;
        record::start(device, commands, &self.plan, input.raw);
        slot.timestamp(device, 0);
        record::passes(device, commands, &self.plan, input.raw);
        slot.timestamp(device, 1);
        counting.end(device, commands);
        let (cpu, wall) = slot.submit(device, start)?;
        self.drawn = Drawn::Passes;
        let gpu = slot.gpu_time(device)?;
        Ok(FrameTime { cpu, gpu, wall })
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let device = &self.gpu.device;
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
        let mut frame = Frame {
            images: Vec::with_capacity(self.plan.reads.len()),
            counters: self
                .plan
                .counting
                .read(device, slot, self.counts.as_ref())?,
        };
        for read in &self.plan.reads {
            frame.images.push(read.image(output)?);
        }
        Ok(frame)
    }
}

impl Drop for PreparedScene<'_> {
    fn drop(&mut self) {
        let device = &self.gpu.device;
        let mut pools = self.gpu.pools.borrow_mut();
        // The slot first: it waits for the device where that is still due.
        if let Some(slot) = self.slot.take() {
            pools.slots.give_back(device, slot);
        }
        let buffers = [self.input.take(), self.output.take(), self.counts.take()];
        pools
            .memory
            .give_back(device, buffers.into_iter().flatten(), self.images.drain(..));
    }
}
