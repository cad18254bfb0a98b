//! The lowering of a scene, and the tables that it fills.

use crate::attachment::Attached;
use crate::binding::Groups;
use crate::calls::{
    BindGroup, Buffer, CallList, Command, LayoutEntry, PassCommand, RenderBundle, RenderPass,
    Shader, Texture, TextureAspect, TextureDimension, TexturePart, TextureView, buffer_usage,
    texture_usage,
};
use crate::counting::Counting;
use crate::device::{Device, attachment_usages, read_path, texture_usages};
use crate::draw::{Geometry, PreparedDraw, runs};
use crate::format::Format;
use crate::path::{self, Reading as ReadingAbility, Shape};
use crate::pipeline::{Pipeline, PipelineState};
use crate::read;
use etalon_frame::{PathCommands, PathTarget, PathValue, ReadPath, Requirement, TextureFormat};
use etalon_scene::{Sampler, Scene};
use std::borrow::Cow;

/// Returns the calls of a scene on a device.
///
/// # Errors
/// What the device lacks.
pub fn lower(device: &Device, scene: &Scene) -> Result<CallList, Requirement> {
    if let Some(missing) = device.limits.missing(&scene.requirements()) {
        return Err(missing);
    }
    let scene = &*scene.on_path();
    let mut lowering = Lowering {
        device,
        list: CallList::default(),
    };
    let attachments = (0..scene.attachments.len())
        .map(|index| Attached::new(&mut lowering, scene, index))
        .collect::<Result<Vec<_>, _>>()?;
    let (counting, counted) = Counting::new(&mut lowering, scene);
    let pool = scene.pool.map(|pool| {
        let usage = buffer_usage::STORAGE | buffer_usage::COPY_DST;
        (lowering.buffer(usage, pool.bytes()), pool)
    });
    let mut groups = Groups::new(&mut lowering, scene, &attachments, &counting);
    groups.pool = pool.map(|(buffer, pool)| (buffer, pool.bytes()));
    let mut geometry = Geometry::new();
    let mut counted = counted.into_iter();
    let mut passes = Vec::new();
    for pass in &scene.passes {
        let mut draws = Vec::new();
        for (draw, counted) in pass.draws.iter().zip(counted.by_ref()) {
            let bound = groups.bind(&mut lowering, draw, counted.runs);
            let parts = (bound, counted);
            draws.push(PreparedDraw::new(
                &mut lowering,
                scene,
                pass,
                draw,
                parts,
                &mut geometry,
            )?);
        }
        passes.push(draws);
    }
    groups.finish(&mut lowering);
    geometry.finish(&mut lowering);

    let mut first = Vec::new();
    let mut initial = Vec::new();
    for attachment in &attachments {
        attachment.initialise(&mut lowering, &mut first, &mut initial);
    }
    initial.extend(counting.start());
    initial.extend(pool.map(|(buffer, pool)| Command::ClearBuffer {
        buffer,
        size: pool.cleared_bytes(),
    }));
    let mut rendered = Vec::new();
    for (number, draws) in passes.iter().enumerate() {
        let commands = if scene.path.commands == PathCommands::Secondary {
            bundled(&mut lowering, scene, number, draws, &counting)?
        } else {
            each(scene, draws, &counting)
        };
        rendered.push(render_pass(
            &mut lowering,
            scene,
            number,
            &attachments,
            &counting,
            commands,
        ));
    }
    let mut rendered = rendered.into_iter();
    let mut frame: Vec<Vec<Command>> = Vec::new();
    for passes in path::commands(scene) {
        let mut commands = std::mem::take(&mut initial);
        commands.extend(rendered.by_ref().take(passes.len()).map(Command::Pass));
        frame.push(commands);
    }
    if let Some(last) = frame.last_mut() {
        last.extend(counting.finish());
    }
    lowering.list.first = first;
    lowering.list.frame = frame;
    read::plan(&mut lowering, scene, &attachments, &counting)?;
    Ok(lowering.list)
}

/// Returns the commands of a pass, draw by draw.
fn each(scene: &Scene, draws: &[PreparedDraw], counting: &Counting) -> Vec<PassCommand> {
    let mut commands = Vec::new();
    for draw in draws {
        commands.extend(counting.begin(draw.counted));
        commands.extend(draw.state(scene.path.state));
        commands.extend(draw.commands.iter().cloned().map(PassCommand::Draw));
        commands.extend(counting.end(draw.counted));
    }
    commands
}

/// Returns the commands of a pass whose draws are bundles. These set no dynamic state and no queries: a bundle holds
/// draws that share theirs.
fn bundled(
    lowering: &mut Lowering<'_>,
    scene: &Scene,
    number: usize,
    draws: &[PreparedDraw],
    counting: &Counting,
) -> Result<Vec<PassCommand>, Requirement> {
    let pass = &scene.passes[number];
    let known = |i: &usize| Format::of(scene.attachments[*i].format);
    let color: Vec<Format> = pass.color.iter().map(known).collect::<Result<_, _>>()?;
    let depth_stencil = pass.depth_stencil.as_ref().map(known).transpose()?;
    let mut commands = Vec::new();
    for run in runs(draws) {
        let shared = &draws[run.start];
        let bundle = RenderBundle {
            color: color.clone(),
            depth_stencil,
            read_only: pass.depth_stencil_read_only,
            samples: scene.pass_samples(pass),
            commands: draws[run].iter().flat_map(|d| d.commands.clone()).collect(),
        };
        lowering.list.bundles.push(bundle);
        commands.extend(counting.begin(shared.counted));
        commands.extend(shared.dynamic_state());
        commands.push(PassCommand::Execute(lowering.list.bundles.len() - 1));
        commands.extend(counting.end(shared.counted));
    }
    Ok(commands)
}

/// Returns a pass with these commands.
fn render_pass(
    lowering: &mut Lowering<'_>,
    scene: &Scene,
    number: usize,
    attachments: &[Attached],
    counting: &Counting,
    commands: Vec<PassCommand>,
) -> RenderPass {
    let pass = &scene.passes[number];
    let mut color = Vec::new();
    for (location, (index, resolve)) in pass.color.iter().zip(&pass.resolve).enumerate() {
        let resolve = resolve.map(|target| lowering.view(attachments[target].target));
        let operations = pass.color_operations(location);
        color.push(attachments[*index].as_color(lowering, Some(number), resolve, operations));
    }
    let depth_stencil = pass.depth_stencil.map(|index| {
        let attachment = &attachments[index];
        if pass.depth_stencil_read_only {
            attachment.as_read_only(lowering)
        } else {
            attachment.as_depth_stencil(lowering, Some(number), &pass.operations)
        }
    });
    RenderPass {
        color,
        depth_stencil,
        occlusion: counting.occlusion(),
        timed: [number == 0, number + 1 == scene.passes.len()],
        commands,
    }
}

/// A texture, or the part of one that an attachment is.
#[derive(Clone, Copy)]
pub(crate) struct Target {
    pub(crate) texture: usize,
    pub(crate) format: Format,
    pub(crate) samples: u32,
    shape: Shape,
}

impl Target {
    /// The slice of a three-dimensional texture that passes draw to.
    pub(crate) fn slice(&self) -> Option<u32> {
        self.shape.slice()
    }

    /// Returns the part for copies, from texels on.
    pub(crate) fn copied(&self, aspect: TextureAspect, [x, y]: [u32; 2]) -> TexturePart {
        TexturePart {
            texture: self.texture,
            level: self.shape.level,
            origin: [x, y, self.shape.layer],
            aspect,
        }
    }
}

/// The tables of a list while they are filled.
pub(crate) struct Lowering<'a> {
    pub(crate) device: &'a Device,
    pub(crate) list: CallList,
}

/// Returns the place of an item in a table, at the end of which it is put if it is new.
fn place<T: PartialEq>(table: &mut Vec<T>, item: T) -> usize {
    table
        .iter()
        .position(|known| *known == item)
        .unwrap_or_else(|| {
            table.push(item);
            table.len() - 1
        })
}

impl Lowering<'_> {
    /// Returns the texture of an attachment, with undefined contents.
    pub(crate) fn attachment(
        &mut self,
        format: TextureFormat,
        size: [u32; 2],
        samples: u32,
        target: PathTarget,
    ) -> Result<Target, Requirement> {
        let shape = Shape::of(target, size);
        let most = match shape.dimension {
            TextureDimension::D2 => self.device.max_texture_2d,
            TextureDimension::D3 => self.device.max_texture_3d,
        };
        if target != PathTarget::Plain && shape.size[0].max(shape.size[1]) > most {
            return Err(Requirement::Path(PathValue::Target(target)));
        }
        let usage = attachment_usages(self.device, format, samples);
        Ok(self.texture(Format::of(format)?, shape, samples, usage))
    }

    /// Returns a texture that a fetch renders to, with undefined contents.
    pub(crate) fn scratch(&mut self, format: Format, size: [u32; 2]) -> Target {
        let usage = texture_usages(TextureFormat::Rgba8Unorm) | texture_usage::RENDER_ATTACHMENT;
        self.texture(format, Shape::of(PathTarget::Plain, size), 1, usage)
    }

    fn texture(&mut self, format: Format, shape: Shape, samples: u32, usage: u32) -> Target {
        self.list.textures.push(Texture {
            size: shape.size,
            levels: shape.levels,
            samples,
            dimension: shape.dimension,
            format,
            usage,
            view_format: format.without_srgb().filter(|_| samples > 1),
        });
        Target {
            texture: self.list.textures.len() - 1,
            format,
            samples,
            shape,
        }
    }

    /// Returns the view of all aspects, for passes.
    pub(crate) fn view(&mut self, target: Target) -> usize {
        self.seen(target, TextureAspect::All, None)
    }

    /// Returns the view of colour or depth, for fetches.
    pub(crate) fn fetched(&mut self, target: Target) -> usize {
        let aspect = if target.format.has_depth() {
            TextureAspect::DepthOnly
        } else {
            TextureAspect::All
        };
        // The samples of an sRGB texture are fetched without conversion, as codes.
        let codes = target.format.without_srgb().filter(|_| target.samples > 1);
        self.seen(target, aspect, codes)
    }

    /// Returns the view of stencil, for fetches.
    pub(crate) fn fetched_stencil(&mut self, target: Target) -> usize {
        self.seen(target, TextureAspect::StencilOnly, None)
    }

    fn seen(&mut self, target: Target, aspect: TextureAspect, format: Option<Format>) -> usize {
        let shape = target.shape;
        let flat = shape.dimension == TextureDimension::D2;
        let view = TextureView {
            texture: target.texture,
            part: flat.then_some([shape.level, shape.layer]),
            aspect,
            format,
        };
        place(&mut self.list.views, view)
    }

    /// Returns a buffer with undefined contents.
    pub(crate) fn buffer(&mut self, usage: u32, size: u64) -> usize {
        self.list.buffers.push(Buffer {
            size,
            usage,
            contents: Vec::new(),
        });
        self.list.buffers.len() - 1
    }

    /// Gives a buffer its contents, whose length is a multiple of four.
    pub(crate) fn fill(&mut self, buffer: usize, contents: Vec<u8>) {
        let filled = &mut self.list.buffers[buffer];
        filled.size = filled.size.max(contents.len() as u64);
        filled.contents = contents;
    }

    /// Returns a buffer with these contents, whose length is a multiple of four.
    pub(crate) fn filled(&mut self, usage: u32, contents: Vec<u8>) -> usize {
        let buffer = self.buffer(usage | buffer_usage::COPY_DST, 0);
        self.fill(buffer, contents);
        buffer
    }

    pub(crate) fn shader(&mut self, label: &'static str, code: Cow<'static, str>) -> usize {
        let label = label.into();
        place(&mut self.list.shaders, Shader { label, code })
    }

    pub(crate) fn layout(&mut self, entries: Vec<LayoutEntry>) -> usize {
        place(&mut self.list.layouts, entries)
    }

    pub(crate) fn sampler(&mut self, sampler: Sampler) -> usize {
        place(&mut self.list.samplers, sampler)
    }

    pub(crate) fn group(&mut self, group: BindGroup) -> usize {
        place(&mut self.list.groups, group)
    }

    pub(crate) fn pipeline(
        &mut self,
        shader: usize,
        layout: Option<usize>,
        state: PipelineState,
    ) -> usize {
        let pipeline = Pipeline {
            shader,
            layout,
            state,
        };
        place(&mut self.list.pipelines, pipeline)
    }

    /// Returns how attachments of a format are read by default.
    pub(crate) fn reading(&self, format: TextureFormat) -> ReadingAbility {
        let abilities = self.device.abilities;
        ReadingAbility {
            copies: abilities.copies,
            fetches: read_path(format, abilities) == ReadPath::Shader,
        }
    }
}
