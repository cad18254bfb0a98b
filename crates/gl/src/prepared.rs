//! A scene prepared for drawing.

use crate::attachment::{self, Attachment, SubmitContents};
use crate::clear::{self, ClearCall};
use crate::codes;
use crate::context::Context;
use crate::counters::{self, Counters};
use crate::draw::{self, DrawBuffers, DrawCall, GlPass, ResolveBlit};
use crate::enums::topology;
use crate::objects::Objects;
use crate::own_pass::{self, OwnPassWay};
use crate::path::{self, Variant};
use crate::pool::ObjectPool;
use crate::program::FragmentForm;
use crate::query::QueryObject;
use crate::read::{ReadObjects, ReadSource};
use crate::recording;
use crate::state::{self, DrawState};
use crate::surface::{Surface, SurfaceKind, upload};
use crate::vertices::{Arguments, BufferedGeometry, Fetched};
use etalon_backend::{BackendError, FrameTime, Phase, Prepared};
use etalon_frame::{
    Feature, Frame, PathCommands, PathDraws, PathEnd, PathState, PathTarget, PathValue, PathViews,
    Requirement, TextureFormat,
};
use etalon_scene::{AttachmentContents, Draw, Enclosing, Pass, Path, Scene};
use glow::HasContext;
use std::collections::BTreeSet;
use std::time::{Duration, Instant};

/// A scene's objects. They return to the pool on drop.
pub(crate) struct GlScene<'a> {
    context: &'a Context,
    objects: &'a Objects,
    attachments: Vec<Attachment>,
    passes: Vec<GlPass>,
    path: Path,
    pool: Option<etalon_scene::Pool>,
    /// The attachments that are read, and how each reaches the host.
    read: Vec<(usize, PathEnd)>,
    inputs: DrawBuffers,
    /// The attachments that the path leaves out of passes.
    gaps: BTreeSet<usize>,
    counters: Counters,
    submitted: bool,
    /// True if nothing has failed, so that other scenes can reuse the objects.
    reusable: bool,
}

/// The parts of the shared buffers that draws have not taken yet.
struct Unused {
    /// The geometry and arguments of the draws, in order.
    places: std::vec::IntoIter<(Fetched, Option<Arguments>)>,
    /// The index of the next draw.
    number: usize,
    /// The offset of the next parameter block.
    params: i32,
    /// The queries of the scene.
    queries: Vec<(etalon_scene::Query, QueryObject)>,
}

impl<'a> GlScene<'a> {
    pub(crate) fn new(
        context: &'a Context,
        objects: &'a Objects,
        scene: &Scene,
    ) -> Result<Self, BackendError> {
        let mut prepared = Self {
            context,
            objects,
            attachments: Vec::new(),
            passes: Vec::new(),
            path: scene.path,
            gaps: (0..scene.attachments.len())
                .filter(|i| scene.is_gap(*i))
                .collect(),
            pool: scene.pool,
            read: ends(objects, scene),
            inputs: DrawBuffers::default(),
            counters: Counters::new(context, scene),
            submitted: false,
            reusable: false,
        };
        recording::begin(Phase::Prepare);
        let filled = prepared.fill(scene);
        recording::end();
        filled?;
        context.check("preparing a scene")?;
        prepared.reusable = true;
        Ok(prepared)
    }

    fn fill(&mut self, scene: &Scene) -> Result<(), BackendError> {
        let context = self.context;
        state::reset(context);
        let mut pool = self.objects.pool.borrow_mut();
        for (index, attachment) in scene.attachments.iter().enumerate() {
            let is_drawn = |p: &etalon_scene::Pass| {
                p.color.contains(&index)
                    || p.resolve.contains(&Some(index))
                    || p.depth_stencil == Some(index)
            };
            let drawn = scene.passes.iter().any(is_drawn);
            let support = self.objects.formats.get(&attachment.format);
            let (format, views) = (attachment.format, scene.path.views);
            let kind = match path::layer(scene, index) {
                Some(layer) => SurfaceKind::Layered(format, layer, views),
                None => {
                    let target = path::target(scene, index, support);
                    SurfaceKind::Attachment(format, attachment.samples, target, views)
                }
            };
            self.attachment(&mut pool, attachment, kind, drawn)?;
        }
        let mut unused = Unused {
            places: self.buffers(&mut pool, scene)?.into_iter(),
            number: 0,
            params: 0,
            queries: self.counters.queries(context, &mut pool, scene)?,
        };
        for pass in &scene.passes {
            let reads = own_pass::way(context, scene, pass)?;
            self.pass(
                &mut pool,
                pass,
                (path::is_layered(scene), reads),
                &mut unused,
            )?;
        }
        Ok(())
    }

    fn attachment(
        &mut self,
        pool: &mut ObjectPool,
        attachment: &etalon_scene::Attachment,
        kind: SurfaceKind,
        drawn: bool,
    ) -> Result<(), BackendError> {
        let context = self.context;
        let format = attachment.format;
        let surface = pool.surface(context, kind, attachment.size)?;
        let texels = attachment.size[0] as usize * attachment.size[1] as usize;
        let complete = surface.is_complete();
        let initial = match &attachment.contents {
            // `rgba32float` is the only supported format that might not be drawable.
            AttachmentContents::Color(color) if !complete => {
                SubmitContents::Upload(codes::pack(format, &color.map(f32::to_bits).repeat(texels)))
            }
            AttachmentContents::Color(color) if format.is_integer() => {
                SubmitContents::Integers(color.map(|value| value as u32))
            }
            AttachmentContents::Color(color) => SubmitContents::Color(*color),
            AttachmentContents::DepthStencil { depth, stencil } => {
                SubmitContents::DepthStencil(*depth, *stencil)
            }
            AttachmentContents::Texels(codes)
                if codes.len() != texels * format.color_channels().len() =>
            {
                return Err(BackendError::internal_of(
                    "an upload does not fill its attachment",
                    format!("{} codes for {texels} texels of {format}", codes.len()),
                ));
            }
            AttachmentContents::Texels(codes) => SubmitContents::Upload(codes::pack(format, codes)),
        };
        let initial = match initial {
            SubmitContents::Upload(bytes) if !drawn => {
                upload(context, format, &surface, &bytes);
                SubmitContents::Uploaded
            }
            initial => initial,
        };
        let layers = if let SurfaceKind::Layered(..) = kind {
            let (color, depth_stencil) = if format.is_color() {
                (vec![Some(&surface)], None)
            } else {
                (Vec::new(), Some(&surface))
            };
            pool.target(context, &color, depth_stencil, true)?
        } else {
            None
        };
        let complete = complete && (layers.is_some() || !matches!(kind, SurfaceKind::Layered(..)));
        self.attachments.push(Attachment {
            name: attachment.name.clone(),
            format,
            drawn: (surface.framebuffer, surface.attachment),
            surface,
            layers,
            initial,
        });
        if !complete && (drawn || format != TextureFormat::Rgba32Float) {
            let requirement = match kind {
                _ if kind.views() != PathViews::Same => {
                    Requirement::Path(PathValue::Views(kind.views()))
                }
                SurfaceKind::Layered(..) => Requirement::Path(PathValue::Layers(self.path.layers)),
                kind => match kind.target() {
                    PathTarget::Plain => Requirement::Format(format),
                    target => Requirement::Path(PathValue::Target(target)),
                },
            };
            return Err(BackendError::NotSupported(requirement));
        }
        Ok(())
    }

    /// Fills one buffer with all vertices, one with all indices, and one with all parameter blocks. Returns
    /// the location of each draw's geometry, and of its arguments if it is indirect.
    fn buffers(
        &mut self,
        pool: &mut ObjectPool,
        scene: &Scene,
    ) -> Result<Vec<(Fetched, Option<Arguments>)>, BackendError> {
        let context = self.context;
        let mut geometry = BufferedGeometry::default();
        let mut places = Vec::new();
        let mut params = Vec::new();
        for draw in scene.passes.iter().flat_map(|pass| &pass.draws) {
            let fetched = geometry.place(draw);
            let draws = scene.path.draws;
            let counted = draws == PathDraws::IndirectCount;
            let beside = draws == PathDraws::IndirectBeside;
            let indirect = counted || beside || draws == PathDraws::Indirect;
            let arguments = indirect.then(|| geometry.place_arguments(&fetched, counted));
            places.push((fetched, arguments));
            if draw.shader.uses_params() {
                params.extend_from_slice(&draw.params.to_bytes());
                params.resize(params.len().next_multiple_of(self.objects.params_stride), 0);
            }
        }
        let mut buffer = |bytes: &[u8]| {
            // Offsets in buffers are 32-bit.
            if bytes.len() > i32::MAX as usize {
                let message = "the scene has too many vertices or draws";
                return Err(BackendError::refused("a buffer", message));
            }
            let made = (!bytes.is_empty()).then(|| pool.buffer(context, bytes));
            Ok(made.transpose()?.map(|buffer| (buffer, bytes.len())))
        };
        self.inputs = DrawBuffers {
            vertices: buffer(&geometry.vertices)?,
            indices: buffer(&geometry.indices)?,
            params: buffer(&params)?,
            arguments: buffer(&geometry.arguments)?,
            zeros: match scene.path.draws {
                PathDraws::IndirectBeside => buffer(&[0; 16])?,
                _ => None,
            },
            runs: buffer(&vec![0; self.counters.storage_size()])?,
            pool: match scene.pool {
                Some(pool) => buffer(&vec![0; pool.bytes() as usize])?,
                None => None,
            },
        };
        Ok(places)
    }

    fn pass(
        &mut self,
        pool: &mut ObjectPool,
        pass: &Pass,
        (layered, reads): (bool, Option<OwnPassWay>),
        unused: &mut Unused,
    ) -> Result<(), BackendError> {
        let context = self.context;
        let attachment = |index: usize| {
            let missing =
                || BackendError::internal_of("a pass names no attachment", index.to_string());
            self.attachments.get(index).ok_or_else(missing)
        };
        let color: Vec<&Attachment> = pass
            .color
            .iter()
            .map(|i| attachment(*i))
            .collect::<Result<_, _>>()?;
        let depth = pass.depth_stencil.map(attachment).transpose()?;
        let Some(any) = depth.or(color.first().copied()) else {
            return Err(BackendError::internal("a pass has no attachment"));
        };
        let format = any.format;
        let mut resolves = Vec::new();
        let moved: Vec<usize> = pass.moved_resolves(&self.path).map(|(l, _)| l).collect();
        for (location, (from, to)) in pass.color.iter().zip(&pass.resolve).enumerate() {
            let (from, Some(to)) = (*from, *to) else {
                continue;
            };
            let surface = &attachment(to)?.surface;
            let between = moved.contains(&location);
            let between = between.then(|| pool.surface(context, surface.kind, surface.size()));
            resolves.push(ResolveBlit {
                from,
                to,
                between: between.transpose()?,
            });
        }
        let surfaces = color.iter().zip(&pass.color);
        let surfaces: Vec<Option<&Surface>> = surfaces
            .map(|(a, index)| (!self.gaps.contains(index)).then_some(&a.surface))
            .collect();
        let target = pool
            .target(context, &surfaces, depth.map(|a| &a.surface), layered)?
            .ok_or(BackendError::NotSupported(Requirement::Drawing(format)))?;
        let integers: Vec<bool> = color.iter().map(|a| a.format.is_integer()).collect();
        let packed = depth.is_some_and(|a| a.format.has_depth() && a.format.has_stencil());
        let clears = pass.clears.iter();
        let mut draws = Vec::new();
        let number = self.passes.len();
        for (index, draw) in pass.draws.iter().enumerate() {
            // If this fails, the target is not returned to the pool, and is deleted with the context.
            draws.push(DrawCall {
                queries: Enclosing::draw(&unused.queries, (number, index)),
                ..self.draw(pool, draw, (pass, layered, reads), unused)?
            });
        }
        // Reading a framebuffer with layers would read the first layer.
        if !layered {
            for (index, point) in pass.color.iter().zip(glow::COLOR_ATTACHMENT0..) {
                self.attachments[*index].drawn = (target.framebuffer, point);
            }
            if let Some(index) = pass.depth_stencil {
                self.attachments[index].drawn.0 = target.framebuffer;
            }
        }
        self.passes.push(GlPass {
            target,
            draws,
            loads: ClearCall::loads(pass, &integers, self.path.clears, packed),
            clears: clear::commands(clears, &integers, self.path.clears, packed),
            keeps_state: self.path.state == PathState::Kept,
            reads,
            discards: clear::discards(pass, packed),
            resolves,
            queries: Enclosing::pass(&unused.queries, number),
        });
        Ok(())
    }

    /// Returns the texture of an attachment that a draw of the pass fetches, with its target.
    fn texture(&self, index: usize, pass: &Pass) -> Result<(u32, glow::Texture), BackendError> {
        let attachment = self.attachments.get(index);
        let surface = attachment.map(|attachment| &attachment.surface);
        match surface.and_then(|surface| Some((surface.samples(), surface.texture()?))) {
            Some((1, texture)) => Ok((glow::TEXTURE_2D, texture)),
            Some((_, texture)) => Ok((glow::TEXTURE_2D_MULTISAMPLE, texture)),
            // Stencil alone can be a renderbuffer.
            None if pass.depth_stencil == Some(index) => {
                let needed = Requirement::Feature(Feature::OwnPassStencilReads);
                Err(BackendError::NotSupported(needed))
            }
            None => Err(BackendError::internal_of(
                "an attachment is no texture",
                index.to_string(),
            )),
        }
    }

    fn draw(
        &mut self,
        pool: &mut ObjectPool,
        draw: &Draw,
        (pass, layered, reads): (&Pass, bool, Option<OwnPassWay>),
        unused: &mut Unused,
    ) -> Result<DrawCall, BackendError> {
        let context = self.context;
        let fetched = unused.places.next();
        let (fetched, arguments) =
            fetched.ok_or_else(|| BackendError::internal("a draw has no place"))?;
        let variant = path::variant(&self.path, unused.number);
        let block = draw.shader.uses_params().then_some(unused.params);
        let fetch = own_pass::fetch(reads, pass, draw);
        let mut textures = Vec::new();
        // What is fetched from the framebuffer is not bound.
        for index in draw.textures.iter().filter(|_| fetch.is_none()) {
            textures.push(self.texture(*index, pass)?);
        }
        let read_only = pass.depth_stencil_read_only;
        let sampler = draw.sampler.map(|sampler| pool.sampler(context, sampler));
        let form = FragmentForm {
            tests: draw.early_tests,
            blend: draw.targets.iter().find_map(|t| t.advanced),
            fetch,
        };
        let program = |layer| {
            let mut programs = self.objects.programs.borrow_mut();
            let variant = Variant { layer, ..variant };
            programs.shader(context, draw.shader, form, variant, draw.tessellation)
        };
        let [again, layer] = if layered {
            path::DRAWN_LAYERS.map(Some)
        } else {
            [None; 2]
        };
        let call = DrawCall {
            program: program(layer)?,
            again: again.map(|_| program(again)).transpose()?,
            state: DrawState::new(context, draw, read_only, &self.path, variant)?,
            other: match self.path.state {
                PathState::Overwritten => {
                    let other = path::other(draw);
                    Some(DrawState::new(
                        context, &other, read_only, &self.path, variant,
                    )?)
                }
                _ => None,
            },
            fetches_stencil: draw.shader.reads_stencil() && fetch.is_none(),
            textures,
            sampler: sampler.transpose()?,
            queries: Enclosing::default(),
            runs: self.counters.runs(draw),
            uses_pool: draw.shader.uses_pool(),
            params: block,
            mode: match draw.tessellation {
                None => topology(draw.topology),
                Some(_) => glow::PATCHES,
            },
            fetched,
            restarts_unindexed: self.path.draws == PathDraws::RestartUnindexed
                && draw.is_unindexed_strip(),
            arguments,
            after_empty: self.path.draws == PathDraws::AfterEmpty,
            flushed: self.path.commands == PathCommands::Several,
        };
        unused.number += 1;
        if block.is_some() {
            unused.params += self.objects.params_stride as i32;
        }
        Ok(call)
    }

    fn try_submit(&self) -> Result<FrameTime, BackendError> {
        let (context, objects) = (self.context, self.objects);
        let gl = &context.gl;
        context.make_current()?;
        recording::begin(Phase::Submit);
        let start = Instant::now();
        state::reset(context);
        attachment::set_initial_contents(context, &self.attachments);
        let pool = self.inputs.pool.zip(self.pool);
        let pool = pool.map(|((buffer, _), pool)| (buffer, pool.cleared_bytes() as usize));
        for (buffer, size) in self.inputs.runs.into_iter().chain(pool) {
            counters::zero(context, buffer, size);
        }
        // SAFETY: the context is current; the query exists only if timers count.
        let (cpu, wall) = unsafe {
            if let Some(query) = objects.timer {
                gl.begin_query(glow::TIME_ELAPSED, query);
            }
            draw::draw_all(
                context,
                objects.vertex_array,
                &self.inputs,
                &self.passes,
                &self.attachments,
            );
            if objects.timer.is_some() {
                gl.end_query(glow::TIME_ELAPSED);
            }
            let cpu = start.elapsed();
            // Without a flush before it: zink of Mesa 22.3.6 returns from the second of the two while it still draws.
            gl.finish();
            (cpu, start.elapsed())
        };
        recording::end();
        context.check("drawing a scene")?;
        let gpu = objects.timer.and_then(|query| context.elapsed(query));
        Ok(FrameTime {
            cpu,
            gpu: gpu.map(Duration::from_nanos),
            wall,
        })
    }

    fn try_read_back(&self) -> Result<Frame, BackendError> {
        self.context.make_current()?;
        recording::begin(Phase::Read);
        let frame = self.frame();
        recording::end();
        let frame = frame?;
        self.context.check("reading a frame back")?;
        Ok(frame)
    }

    fn frame(&self) -> Result<Frame, BackendError> {
        let (context, objects) = (self.context, self.objects);
        let mut reading = ReadObjects {
            context,
            pool: &mut objects.pool.borrow_mut(),
            programs: &mut objects.programs.borrow_mut(),
            no_vertices: objects.no_vertices,
        };
        let mut frame = Frame {
            counters: self.counters.read(context, self.inputs.runs)?,
            ..Frame::default()
        };
        for (index, end) in &self.read {
            let attachment = self.attachments.get(*index);
            let known = attachment.and_then(|a| Some((a, objects.formats.get(&a.format)?)));
            let Some((attachment, support)) = known else {
                return Err(BackendError::internal_of(
                    "an attachment cannot be read",
                    index.to_string(),
                ));
            };
            frame.images.extend(reading.images(&ReadSource {
                name: &attachment.name,
                format: attachment.format,
                plan: support.read,
                depth: &support.limits.depth,
                surface: &attachment.surface,
                size: attachment.surface.size(),
                drawn: attachment.drawn,
                end: *end,
                blits: None,
            })?);
        }
        Ok(frame)
    }
}

/// Returns the attachments that a scene reads, and how each reaches the host.
fn ends(objects: &Objects, scene: &Scene) -> Vec<(usize, PathEnd)> {
    let end = |index: &usize| {
        let format = scene.attachments.get(*index).map(|a| a.format);
        let support = format.and_then(|format| objects.formats.get(&format));
        support.map_or(PathEnd::Store, |support| path::end(scene, *index, support))
    };
    scene.read.iter().map(|i| (*i, end(i))).collect()
}

impl Prepared for GlScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let result = self.try_submit();
        self.reusable &= result.is_ok();
        self.submitted |= result.is_ok();
        result
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        if !self.submitted {
            return Err(BackendError::internal(
                "read back before anything was drawn",
            ));
        }
        let result = self.try_read_back();
        if result.is_err() {
            self.reusable = false;
            // The failure might come from the objects used for reading.
            self.objects.pool.borrow_mut().delete_surfaces(self.context);
        }
        result
    }
}

impl Drop for GlScene<'_> {
    fn drop(&mut self) {
        let context = self.context;
        if context.make_current().is_err() {
            // The objects ended with the context.
            return;
        }
        let mut pool = self.objects.pool.borrow_mut();
        for pass in self.passes.drain(..) {
            if self.reusable {
                pool.put_target(context, pass.target);
            } else {
                pass.target.delete(context);
            }
            for between in pass.resolves.into_iter().filter_map(|r| r.between) {
                if self.reusable {
                    pool.put_surface(context, between);
                } else {
                    between.delete(context);
                }
            }
        }
        for attachment in self.attachments.drain(..) {
            if let Some(layers) = attachment.layers {
                if self.reusable {
                    pool.put_target(context, layers);
                } else {
                    layers.delete(context);
                }
            }
            if self.reusable {
                pool.put_surface(context, attachment.surface);
            } else {
                // The surface's storage might not exist.
                attachment.surface.delete(context);
            }
        }
        std::mem::take(&mut self.counters).give_back(context, &mut pool, self.reusable);
        for (buffer, size) in std::mem::take(&mut self.inputs).into_buffers() {
            pool.put_buffer(context, buffer, size);
        }
    }
}
