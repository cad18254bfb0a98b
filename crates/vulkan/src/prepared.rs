//! A scene prepared for drawing.

use crate::buffer::{Buffer, BufferUse};
use crate::counting::{Counting, Enclosing};
use crate::descriptors::Descriptors;
use crate::device::Device;
use crate::dynamic::{Dynamic, Setting};
use crate::error::internal;
use crate::extended::{self, Extended};
use crate::format;
use crate::gpu::Gpu;
use crate::image::Image;
use crate::inputs::Inputs;
use crate::path;
use crate::pipeline::Way;
use crate::plan::{
    AttachmentPlan, DrawPlan, InitialContents, PassPlan, Plan, Role, between_key, copy_key,
    image_key, is_advanced, targets,
};
use crate::read::ReadPlan;
use crate::record::{self, Recorder};
use crate::recording::{self, Needed};
use crate::render_pass::RenderPass;
use crate::single::Single;
use crate::single_state::SingleState;
use crate::slot::{Needs, Slot};
use crate::storage;
use etalon_backend::{BackendError, FrameTime, Phase, Prepared};
use etalon_frame::{
    Feature, Frame, PathCommands, PathEnd, PathPass, PathState, PathValue, Requirement,
};
use etalon_scene::{Contents, Draw, Pass, Pool, Scene};
use std::cell::RefCell;
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
    /// The scene's pool.
    pool: Option<(Buffer, Pool)>,
    /// The attachments' images, then those that they are copied to.
    images: Vec<Image>,
    plan: Plan,
    kind: PathCommands,
    /// True if state that does not change is not set again.
    keeps_state: bool,
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
            pool: None,
            images: Vec::new(),
            plan: Plan::default(),
            kind: PathCommands::One,
            keeps_state: scene.path.state == PathState::Kept,
            progress: Progress::NotDrawn,
        };
        prepared.kind = scene.path.commands;
        if recording::is_installed() {
            let native = |format| gpu.natives.get(&format).map(|native| native.raw);
            recording::needs(Needed::of(scene, native));
        }
        prepared.fill(&scene.on_path())?;
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
            let read = scene.read.contains(&index);
            let native = format::native(&self.gpu.natives, attachment.format)?;
            let end = path::end(device, &scene.path, attachment, native)?;
            let key = image_key(self.gpu, scene, index, role, end)?;
            path::check_target(device, &key)?;
            let image = pools.memory.image(device, key)?;
            self.plan.attachments.push(AttachmentPlan {
                image: image.raw,
                place: image.place(),
                end,
                copy: None,
                between: None,
                aspects: image.aspects(),
                size: attachment.size,
                samples: attachment.samples,
                initial: InitialContents::of(attachment, inputs.texels(index)),
                role,
                read,
            });
            self.images.push(image);
        }
        // The images that are read back, by attachment.
        let mut sources: Vec<usize> = (0..self.images.len()).collect();
        let plans = self.plan.attachments.iter_mut().zip(&scene.attachments);
        for (source, (plan, attachment)) in sources.iter_mut().zip(plans) {
            if plan.read && path::is_copied(plan.end) {
                let own = self.images[*source].key;
                if let Some(key) = between_key(own, plan.end) {
                    let image = pools.memory.image(device, key)?;
                    plan.between = Some(image.raw);
                    self.images.push(image);
                }
                let key = copy_key(own, attachment);
                let image = pools.memory.image(device, key)?;
                plan.copy = Some(image.raw);
                *source = self.images.len();
                self.images.push(image);
            }
        }

        let areas = |pass: &Pass| path::areas(&scene.path, scene.pass_size(pass));
        let draws = || {
            let often = |p| areas(p).into_iter().flat_map(move |_| &p.draws);
            scene.passes.iter().flat_map(often)
        };
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
                .buffer(device, BufferUse::Storage, counting.bytes)?;
            self.counts = Some(counts);
        }
        if let Some(pool) = scene.pool {
            let memory = &mut pools.memory;
            let buffer = memory.buffer(device, BufferUse::Storage, pool.bytes())?;
            self.pool = Some((buffer, pool));
            self.plan.pool = true;
        }

        let setting = Setting {
            fixed: scene.path.state == PathState::Static,
            further: path::further(device, scene.path.state),
            viewport: scene.path.viewport,
        };
        let pool = self.pool.as_ref().map(|(b, pool)| (b, pool.bytes()));
        let mut sets = Descriptors::new(input, self.counts.as_ref(), pool, &self.images);
        let queries = counting.queries(slot, scene)?;
        let parts = scene.passes.iter().zip(&inputs.draws).enumerate();
        let parts = parts.flat_map(|(number, (pass, places))| {
            let areas = areas(pass);
            let whole = areas.len() == 1;
            areas
                .into_iter()
                .map(move |area| (number, pass, places, area, whole))
        });
        for (number, pass, places, area, whole) in parts {
            let targets = targets(self.gpu, scene, pass)?;
            check_advanced(device, pass, setting)?;
            let planned = PassPlan::new(scene, pass, &self.images, area, targets.clone())?;
            self.plan.passes.push(planned);
            let Some(planned) = self.plan.passes.last_mut() else {
                continue;
            };
            planned.queries = Enclosing::new(
                &queries,
                |query| query.begins_before(number),
                |query| query.ends_behind(number),
            );
            if scene.path.pass != PathPass::DynamicRendering {
                let second = scene.path.pass == PathPass::SecondSubpass;
                let attached = (&planned.color[..], planned.depth_stencil.as_ref());
                let object = RenderPass::new(device, planned.size, attached, &targets, second)?;
                planned.object = Some(object);
            }
            for (index, (draw, place)) in pass.draws.iter().zip(places).enumerate() {
                if draw.targets.len() != pass.color.len() {
                    return Err(internal("a draw lacks a target for each colour attachment"));
                }
                let pipelines = &mut pools.pipelines;
                let made = (&mut *pipelines, &mut pools.samplers);
                let set = sets.get(device, made, slot, counting, draw)?;
                let dynamic = Dynamic::new(draw, area, whole, place.restarts, setting)?;
                let way = Way {
                    pass: planned.object.as_ref(),
                    setting,
                    state: &dynamic,
                };
                let mut get = |draw: &Draw| pipelines.get(device, &targets, draw, way);
                let extended = setting
                    .further
                    .any()
                    .then(|| Extended::new(draw, targets.samples, setting.further));
                let pipeline = match extended {
                    Some(_) => get(&extended::held_by(setting.further, draw))?,
                    None => get(draw)?,
                };
                let other = match scene.path.state {
                    PathState::OtherPipeline => Some(get(&path::other(draw))?),
                    state if SingleState::of(state).is_some() => Some(get(&path::other(draw))?),
                    _ => None,
                };
                let enclosing = Enclosing::new(
                    &queries,
                    |query| query.begins_at((number, index)),
                    |query| query.ends_at((number, index)),
                );
                let mut drawn = DrawPlan::new(place, dynamic, pipeline, set, enclosing)?;
                drawn.overwritten = scene.path.state == PathState::Overwritten;
                (drawn.other, drawn.extended) = (other, extended);
                drawn.single = setting
                    .further
                    .single
                    .map(|state| Single::new(state, draw, targets.samples));
                planned.draws.push(drawn);
            }
        }

        let attachments = self.plan.attachments.iter();
        let by_shader: Vec<bool> = attachments.map(AttachmentPlan::is_read_by_shader).collect();
        let (reads, bytes) = ReadPlan::all(self.gpu, scene, &by_shader)?;
        let output = pools.memory.buffer(device, BufferUse::Output, bytes)?;
        let output = self.output.insert(output);
        self.plan.reads = reads;
        for read in &mut self.plan.reads {
            let image = self
                .images
                .get(sources.get(read.attachment).copied().unwrap_or(usize::MAX))
                .ok_or_else(|| internal("a read names no attachment"))?;
            read.connect(device, &mut pools.readers, slot, image, output)?;
        }
        Ok(())
    }
}

/// Refuses advanced blends of what is written in the same pass, if nothing orders the two, and those that
/// would have to be dynamic.
fn check_advanced(device: &Device, pass: &Pass, setting: Setting) -> Result<(), BackendError> {
    let Some(last) = pass.draws.iter().rposition(is_advanced) else {
        return Ok(());
    };
    let written = last > 0 || pass.clears.iter().any(|c| c.before <= last);
    if written && device.advanced_blend != Some(true) {
        let needed = Requirement::Feature(Feature::AdvancedBlendCoherent);
        return Err(BackendError::NotSupported(needed));
    }
    if setting.further.extended {
        // Such a blend is another state than the equation (VUID-VkColorBlendEquationEXT-colorBlendOp-07361).
        let path = PathValue::State(PathState::ExtendedDynamic3);
        return Err(BackendError::NotSupported(Requirement::Path(path)));
    }
    Ok(())
}

impl Prepared for PreparedScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let device = &self.gpu.device;
        let (Some(slot), Some(input)) = (&mut self.slot, &self.input) else {
            return Err(internal("the scene is not prepared"));
        };
        self.progress = Progress::NotDrawn;
        recording::phase(Phase::Submit);
        let start = Instant::now();
        let commands = slot.begin(device)?;
        slot.reset_timestamps(device);
        let counting = &self.plan.counting;
        counting.reset(device, commands, slot, self.counts.as_ref())?;
        if let Some((buffer, pool)) = &self.pool {
            storage::zero(device, commands, buffer.raw, pool.cleared_bytes());
        }
        record::initial_contents(device, commands, &self.plan, input.raw);
        slot.timestamp(device, 0);
        let kind = self.kind;
        let kept = self.keeps_state.then(RefCell::default);
        let over_passes = self.plan.passes.iter().any(|pass| !pass.queries.is_empty());
        let mut recorder = Recorder {
            slot,
            kind,
            kept,
            over_passes,
        };
        record::passes(device, &mut recorder, &self.plan, input.raw)?;
        slot.timestamp(device, 1);
        counting.end(device, slot.commands());
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
        recording::phase(Phase::Read);
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
            let attachment = self.plan.attachments.get(read.attachment);
            let halved = attachment.is_some_and(|a| a.end == PathEnd::BlitLinear);
            frame
                .images
                .push(read.image(output, halved, self.gpu.fault)?);
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
        for object in self.plan.passes.iter().filter_map(|p| p.object.as_ref()) {
            object.destroy(device);
        }
        let pool = self.pool.take().map(|(buffer, _)| buffer);
        let buffers = [
            self.input.take(),
            self.output.take(),
            self.counts.take(),
            pool,
        ];
        pools
            .memory
            .give_back(device, buffers.into_iter().flatten(), self.images.drain(..));
    }
}
