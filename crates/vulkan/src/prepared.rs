//! A scene prepared for drawing.

use crate::buffer::{BufferUse, MappedBuffer};
use crate::counting::{CounterQueries, PoolQuery};
use crate::descriptors::Descriptors;
use crate::device::Device;
use crate::dynamic::{Dynamic, Setting};
use crate::error::internal;
use crate::extended::{self, DynamicValues};
use crate::format;
use crate::gpu::{Gpu, Pools};
use crate::image::{DRAWN_LAYERS, DeviceImage};
use crate::input_attachment;
use crate::inputs::{DrawInputs, Inputs};
use crate::own_pass;
use crate::path;
use crate::pipeline::{Pipelines, Way};
use crate::plan::{
    AttachmentPlan, DrawPlan, InitialContents, MovedResolve, PassPlan, ScenePlan, between_key,
    copy_key, image_key, is_advanced, resolve_key, targets,
};
use crate::read::ReadPlan;
use crate::record::{self, CommandRecorder};
use crate::recording::{self, Needed};
use crate::render_pass::RenderPass;
use crate::role::Role;
use crate::single::Single;
use crate::single_state::SingleState;
use crate::slot::{Needs, Slot};
use crate::storage;
use crate::targets::Targets;
use ash::vk;
use etalon_backend::{BackendError, FrameTime, Phase, Prepared};
use etalon_frame::{
    Feature, Frame, PathCommands, PathDraws, PathEnd, PathLayers, PathPass, PathReads, PathState,
    PathValue, Requirement,
};
use etalon_scene::{AttachmentContents, Draw, Enclosing, Pass, Path, Pool, Scene};
use std::cell::Cell;
use std::time::Instant;

/// A scene with all objects needed to draw it.
pub(crate) struct VulkanScene<'a> {
    gpu: &'a Gpu,
    /// Always present until `drop` takes it.
    slot: Option<Slot>,
    input: Option<MappedBuffer>,
    output: Option<MappedBuffer>,
    /// The buffer of the shaders' counts, if any shader counts.
    counts: Option<MappedBuffer>,
    /// The scene's pool.
    pool: Option<(MappedBuffer, Pool)>,
    /// The images of the attachments, then the images that they are copied to.
    images: Vec<DeviceImage>,
    plan: ScenePlan,
    kind: PathCommands,
    /// True if state that does not change between draws is set only once.
    keeps_state: bool,
    /// True if the number of samples is dynamic.
    dynamic_samples: bool,
    progress: Progress,
}

/// The state of the attachments and the output buffer.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Progress {
    /// The scene was not drawn yet, or the last attempt failed.
    NotDrawn,
    /// Drawn.
    Drawn,
    /// Drawn and copied to the output buffer.
    Read,
}

impl<'a> VulkanScene<'a> {
    pub(crate) fn new(gpu: &'a Gpu, scene: &Scene) -> Result<Self, BackendError> {
        if let Some(missing) = gpu.limits.missing(&scene.requirements()) {
            return Err(BackendError::NotSupported(missing));
        }
        // Filled step by step, so that `drop` returns everything if a step fails.
        let mut prepared = Self {
            gpu,
            slot: None,
            input: None,
            output: None,
            counts: None,
            pool: None,
            images: Vec::new(),
            plan: ScenePlan::default(),
            kind: PathCommands::One,
            keeps_state: scene.path.state == PathState::Kept,
            dynamic_samples: scene.path.state == PathState::DynamicSamples,
            progress: Progress::NotDrawn,
        };
        prepared.kind = scene.path.commands;
        if recording::is_installed() {
            let native = |format| gpu.natives.get(&format).map(|native| native.raw);
            recording::needs(Needed::of(scene, native));
        }
        let instance = &gpu.device.instance;
        instance.samples_are_dynamic(prepared.dynamic_samples);
        prepared.fill(&scene.on_path())?;
        Ok(prepared)
    }

    /// Takes or creates everything that the scene needs.
    fn fill(&mut self, scene: &Scene) -> Result<(), BackendError> {
        let gpu = self.gpu;
        let pools = &mut *gpu.pools.borrow_mut();
        let inputs = Inputs::place(&gpu.device, &gpu.natives, scene);
        let input = pools
            .memory
            .buffer(&gpu.device, BufferUse::Input, inputs.bytes)?;
        inputs.write(self.input.insert(input), scene)?;
        self.attach(pools, scene, &inputs)?;
        let sources = self.attach_copies(pools, scene)?;
        let resolves = self.attach_resolves(pools, scene)?;
        self.take_slot(pools, scene)?;
        self.plan_passes(pools, scene, &inputs, &resolves)?;
        self.plan_reads(pools, scene, &sources)
    }

    /// Takes the images of the attachments.
    fn attach(
        &mut self,
        pools: &mut Pools,
        scene: &Scene,
        inputs: &Inputs,
    ) -> Result<(), BackendError> {
        let device = &self.gpu.device;
        for (index, attachment) in scene.attachments.iter().enumerate() {
            if let AttachmentContents::Texels(codes) = &attachment.contents {
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
            path::check_target(device, &scene.path, &key)?;
            let image = pools.memory.image(device, key)?;
            let converts = key.stored != key.format;
            let cleared = match attachment.contents {
                AttachmentContents::Color(_) if converts => Some(image.attached()?),
                _ => None,
            };
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
                cleared,
                role,
                read,
            });
            self.images.push(image);
        }
        Ok(())
    }

    /// Takes the images that attachments are copied to before they are read. Returns the index of the image
    /// that is read, by attachment.
    fn attach_copies(
        &mut self,
        pools: &mut Pools,
        scene: &Scene,
    ) -> Result<Vec<usize>, BackendError> {
        let device = &self.gpu.device;
        let mut sources: Vec<usize> = (0..self.images.len()).collect();
        let plans = self.plan.attachments.iter_mut().zip(&scene.attachments);
        for (source, (plan, attachment)) in sources.iter_mut().zip(plans) {
            if plan.read && path::is_copied(plan.end) {
                let drawn = self.images[*source].key;
                if let Some(key) = between_key(drawn, plan.end) {
                    let image = pools.memory.image(device, key)?;
                    plan.between = Some(image.raw);
                    self.images.push(image);
                }
                let image = pools.memory.image(device, copy_key(drawn, attachment))?;
                plan.copy = Some(image.raw);
                *source = self.images.len();
                self.images.push(image);
            }
        }
        Ok(sources)
    }

    /// Takes the intermediate images of resolves. Returns the resolves after each pass.
    fn attach_resolves(
        &mut self,
        pools: &mut Pools,
        scene: &Scene,
    ) -> Result<Vec<Vec<MovedResolve>>, BackendError> {
        let mut resolves = Vec::with_capacity(scene.passes.len());
        for pass in &scene.passes {
            let mut moved = Vec::new();
            for (location, to) in pass.moved_resolves(&scene.path) {
                let key = resolve_key(self.images[to].key);
                let image = pools.memory.image(&self.gpu.device, key)?;
                moved.push(MovedResolve {
                    from: pass.color[location],
                    to,
                    image: image.raw,
                    place: image.place(),
                });
                self.images.push(image);
            }
            resolves.push(moved);
        }
        Ok(resolves)
    }

    /// Takes the slot and the buffers that shaders write to.
    fn take_slot(&mut self, pools: &mut Pools, scene: &Scene) -> Result<(), BackendError> {
        let device = &self.gpu.device;
        let draws = || {
            let areas = |pass: &Pass| path::areas(&scene.path, scene.pass_size(pass));
            let often = move |p| areas(p).into_iter().flat_map(move |_| &p.draws);
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
        self.plan.counting = CounterQueries::new(device, scene);
        self.plan.counting.add_needs(scene, &mut needs);
        self.slot = Some(pools.slots.take(device, needs)?);
        let bytes = self.plan.counting.bytes;
        if bytes > 0 {
            self.counts = Some(pools.memory.buffer(device, BufferUse::Storage, bytes)?);
        }
        if let Some(pool) = scene.pool {
            let buffer = pools
                .memory
                .buffer(device, BufferUse::Storage, pool.bytes())?;
            self.pool = Some((buffer, pool));
            self.plan.pool = true;
        }
        Ok(())
    }

    /// Plans the passes, once for each of their areas.
    fn plan_passes(
        &mut self,
        pools: &mut Pools,
        scene: &Scene,
        inputs: &Inputs,
        resolves: &[Vec<MovedResolve>],
    ) -> Result<(), BackendError> {
        let device = &self.gpu.device;
        let (Some(input), Some(slot)) = (&self.input, &mut self.slot) else {
            return Err(internal("a scene has no slot"));
        };
        let setting = Setting {
            fixed: scene.path.state == PathState::Static,
            beyond: path::dynamic_states(device, scene.path.state),
            viewport: scene.path.viewport,
        };
        let counting = &mut self.plan.counting;
        let queries = counting.queries(slot, scene)?;
        let pool = self.pool.as_ref().map(|(b, pool)| (b, pool.bytes()));
        let mut sets = Descriptors::new(input, self.counts.as_ref(), pool, &self.images);
        let parts = scene.passes.iter().zip(&inputs.draws).zip(resolves);
        for (number, ((pass, places), resolves)) in parts.enumerate() {
            let areas = path::areas(&scene.path, scene.pass_size(pass));
            let whole = areas.len() == 1;
            let targets = targets(self.gpu, scene, pass)?;
            check_advanced(device, pass, setting)?;
            for area in areas {
                let planned = PassPlan::new(scene, pass, &self.images, area, targets.clone())?;
                // From here on, `drop` finds what is created.
                let planned = self.plan.passes.push_mut(planned);
                planned.resolves.clone_from(resolves);
                planned.queries = Enclosing::pass(&queries, number);
                if own_pass::has_object(targets.reads, scene.path.pass) {
                    let first = u32::from(scene.path.pass == PathPass::SecondSubpass);
                    let attached = (&planned.color[..], planned.depth_stencil.as_ref());
                    let (size, draws) = (planned.size, pass.draws.len());
                    let object = RenderPass::new(device, size, attached, &targets, first, draws)?;
                    planned.object = Some(object);
                }
                let drawing = SceneDrawing {
                    device,
                    path: scene.path,
                    setting,
                    targets: &targets,
                    object: planned.object.as_ref(),
                    area: (area, whole),
                    queries: &queries,
                    pass: number,
                };
                for (index, (draw, place)) in pass.draws.iter().zip(places).enumerate() {
                    if draw.targets.len() != pass.color.len() {
                        return Err(internal("a draw lacks a target for each colour attachment"));
                    }
                    let made = (&mut pools.pipelines, &mut pools.samplers);
                    let own = targets.reads.filter(|_| draw.reads_own(pass));
                    let set = sets.get(device, made, slot, counting, (draw, own))?;
                    let inputs = own_pass::inputs(own, pass, draw)?;
                    let place = (place, set, inputs);
                    let drawn = drawing.plan(&mut pools.pipelines, index, draw, place)?;
                    planned.draws.push(drawn);
                }
            }
        }
        Ok(())
    }

    /// Plans the reads; each reads the image that its attachment is copied to, if any.
    fn plan_reads(
        &mut self,
        pools: &mut Pools,
        scene: &Scene,
        sources: &[usize],
    ) -> Result<(), BackendError> {
        let device = &self.gpu.device;
        let attachments = self.plan.attachments.iter();
        let by_shader: Vec<bool> = attachments.map(AttachmentPlan::is_read_by_shader).collect();
        let (reads, bytes) = ReadPlan::all(self.gpu, scene, &by_shader)?;
        let output = pools.memory.buffer(device, BufferUse::Output, bytes)?;
        let output = self.output.insert(output);
        let Some(slot) = &mut self.slot else {
            return Err(internal("a scene has no slot"));
        };
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

/// Data that the draws of a pass share within one of its areas.
struct SceneDrawing<'a> {
    device: &'a Device,
    path: Path,
    setting: Setting,
    targets: &'a Targets,
    object: Option<&'a RenderPass>,
    /// The area, and whether it is the only one.
    area: (vk::Rect2D, bool),
    queries: &'a [(etalon_scene::Query, PoolQuery)],
    /// The number of the pass.
    pass: usize,
}

impl SceneDrawing<'_> {
    /// Returns the plan of a draw with these inputs and descriptors.
    fn plan(
        &self,
        pipelines: &mut Pipelines,
        index: usize,
        draw: &Draw,
        (place, set, inputs): (&DrawInputs, vk::DescriptorSet, input_attachment::Inputs),
    ) -> Result<DrawPlan, BackendError> {
        let (device, mut setting, targets) = (self.device, self.setting, self.targets);
        let state = self.path.state;
        setting.fixed |= state == PathState::Turns && index % 2 == 1;
        let (area, whole) = self.area;
        let dynamic = Dynamic::new(draw, area, whole, place.restarts, setting)?;
        let [again, layer] = match targets.layers {
            PathLayers::One | PathLayers::Multiview => [None; 2],
            PathLayers::Written => DRAWN_LAYERS.map(Some),
        };
        let way = Way {
            pass: self.object,
            subpass: self.object.map_or(0, |object| {
                let each = targets.reads == Some(PathReads::Subpasses);
                object.first_subpass + if each { index as u32 } else { 0 }
            }),
            inputs,
            layer,
            setting,
            state: &dynamic,
        };
        let mut get =
            |draw: &Draw, layer| pipelines.get(device, targets, draw, Way { layer, ..way });
        let states = setting.beyond;
        let is_dynamic = states.any();
        let values = is_dynamic.then(|| DynamicValues::new(draw, targets.samples, states));
        let pipeline_draw = is_dynamic.then(|| extended::pipeline_draw(states, draw));
        let pipeline_draw = pipeline_draw.as_ref().unwrap_or(draw);
        let pipeline = get(pipeline_draw, layer)?;
        let again = again.map(|_| get(pipeline_draw, again)).transpose()?;
        let single = SingleState::of(state).is_some();
        let before_pipeline = state == PathState::BeforePipeline;
        let other = if single || before_pipeline || state == PathState::OtherPipeline {
            Some(get(&path::other(draw), layer)?)
        } else {
            None
        };
        let enclosing = Enclosing::draw(self.queries, (self.pass, index));
        let mut drawn = DrawPlan::new(place, dynamic, pipeline, set, enclosing)?;
        drawn.overwritten = state == PathState::Overwritten;
        drawn.after_empty = self.path.draws == PathDraws::AfterEmpty;
        drawn.before_pipeline = before_pipeline;
        (drawn.other, drawn.again, drawn.beyond) = (other, again, values);
        let state = setting.beyond.single;
        drawn.single = state.map(|state| Single::new(state, draw, targets.samples));
        Ok(drawn)
    }
}

/// Refuses advanced blends that read what the same pass writes, unless the device orders the two, and
/// advanced blends whose state would have to be dynamic.
fn check_advanced(device: &Device, pass: &Pass, setting: Setting) -> Result<(), BackendError> {
    let Some(last) = pass.draws.iter().rposition(is_advanced) else {
        return Ok(());
    };
    let written = last > 0 || pass.clears.iter().any(|c| c.before <= last);
    if written && device.advanced_blend != Some(true) {
        let needed = Requirement::Feature(Feature::AdvancedBlendCoherent);
        return Err(BackendError::NotSupported(needed));
    }
    if setting.beyond.extended {
        // Extended dynamic state sets the equation, which cannot be an advanced blend
        // (VUID-VkColorBlendEquationEXT-colorBlendOp-07361).
        let path = PathValue::State(PathState::ExtendedDynamic3);
        return Err(BackendError::NotSupported(Requirement::Path(path)));
    }
    Ok(())
}

impl Prepared for VulkanScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let device = &self.gpu.device;
        let (Some(slot), Some(input)) = (&mut self.slot, &self.input) else {
            return Err(internal("the scene is not prepared"));
        };
        self.progress = Progress::NotDrawn;
        let instance = &device.instance;
        instance.samples_are_dynamic(self.dynamic_samples);
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
        let current_state = self.keeps_state.then(Cell::default);
        let over_passes = self.plan.passes.iter().any(|pass| !pass.queries.is_empty());
        let mut recorder = CommandRecorder {
            slot,
            kind,
            current_state,
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
                record::reads(device, commands, &self.plan, output.raw)?;
                self.progress = Progress::NotDrawn;
                slot.submit(device, start)?;
                self.progress = Progress::Read;
            }
            // The output buffer still has the codes.
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

impl Drop for VulkanScene<'_> {
    fn drop(&mut self) {
        let device = &self.gpu.device;
        let mut pools = self.gpu.pools.borrow_mut();
        // The slot comes first, since it waits for the device if work is in flight.
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
