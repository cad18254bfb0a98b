//! Draws: their inputs, their state and their commands.

use crate::binding::Bound;
use crate::calls::{DrawCommand, PassCommand, buffer_usage};
use crate::counting::DrawQueries;
use crate::path;
use crate::pipeline::{self, INSTANCE_SLOT};
use crate::tables::Lowering;
use etalon_frame::{PathDraws, PathState, PathValue, Requirement};
use etalon_scene::{Call, Draw, Pass, Scene, Viewport};
use std::ops::Range;

/// The alignment of what is written to a buffer, in bytes (writeBuffer).
const COPY_ALIGNMENT: usize = 4;

/// The vertices, indices and arguments of a scene, each in one buffer.
pub(crate) struct GeometryBuffers {
    vertices: FilledBuffer,
    indices: FilledBuffer,
    arguments: FilledBuffer,
}

/// A buffer, if it has contents, and the contents.
struct FilledBuffer {
    usage: u32,
    buffer: Option<usize>,
    bytes: Vec<u8>,
}

impl FilledBuffer {
    fn new(usage: u32) -> Self {
        Self {
            usage,
            buffer: None,
            bytes: Vec::new(),
        }
    }

    /// Appends bytes, and zeros up to the alignment of writes. Returns the buffer and the range of the bytes.
    fn append(&mut self, lowering: &mut Lowering<'_>, bytes: &[u8]) -> (usize, Range<u64>) {
        let usage = self.usage | buffer_usage::COPY_DST;
        let buffer = *self.buffer.get_or_insert_with(|| lowering.buffer(usage, 0));
        let first = self.bytes.len() as u64;
        self.bytes.extend_from_slice(bytes);
        let place = first..self.bytes.len() as u64;
        let aligned = self.bytes.len().next_multiple_of(COPY_ALIGNMENT);
        self.bytes.resize(aligned, 0);
        (buffer, place)
    }
}

impl GeometryBuffers {
    pub(crate) fn new() -> Self {
        Self {
            vertices: FilledBuffer::new(buffer_usage::VERTEX),
            indices: FilledBuffer::new(buffer_usage::INDEX),
            arguments: FilledBuffer::new(buffer_usage::INDIRECT),
        }
    }

    /// Fills the buffers.
    pub(crate) fn finish(self, lowering: &mut Lowering<'_>) {
        for input in [self.vertices, self.indices, self.arguments] {
            if let Some(buffer) = input.buffer {
                lowering.fill(buffer, input.bytes);
            }
        }
    }

    /// Adds the arguments of a draw, after other arguments that would draw nothing. Returns the buffer and
    /// the offset of the arguments.
    fn arguments(&mut self, lowering: &mut Lowering<'_>, call: &Call<'_>) -> (usize, u64) {
        let words = match call.indices {
            Some(_) => vec![
                call.count,
                call.instances,
                call.first,
                call.base_vertex.cast_unsigned(),
                call.first_instance,
            ],
            None => vec![call.count, call.instances, call.first, call.first_instance],
        };
        let bytes =
            |words: &[u32]| -> Vec<u8> { words.iter().flat_map(|w| w.to_le_bytes()).collect() };
        let unused = bytes(&vec![0; words.len()]);
        self.arguments.append(lowering, &unused);
        let (buffer, place) = self.arguments.append(lowering, &bytes(&words));
        (buffer, place.start)
    }

    /// Adds the vertices and indices of a draw. Returns the commands that set them.
    fn inputs(&mut self, lowering: &mut Lowering<'_>, call: &Call<'_>) -> Vec<DrawCommand> {
        let mut commands = Vec::new();
        let mut set = |slot, (buffer, place)| {
            commands.push(DrawCommand::SetVertexBuffer {
                slot,
                buffer,
                place,
            });
        };
        set(0, self.vertices.append(lowering, call.vertex_bytes()));
        if !call.colors.is_empty() {
            let colors = self.vertices.append(lowering, call.color_bytes());
            set(INSTANCE_SLOT, colors);
        }
        // Without restarts and incomplete primitives, no index might be left.
        if call
            .indices
            .as_ref()
            .is_some_and(|indices| !indices.is_empty())
        {
            let (buffer, place) = self.indices.append(lowering, &call.index_bytes());
            commands.push(DrawCommand::SetIndexBuffer {
                buffer,
                place,
                format: call.index,
            });
        }
        commands
    }
}

/// A draw, with the facts that its pass needs.
pub(crate) struct PreparedDraw {
    pub(crate) counted: DrawQueries,
    /// The commands that bundles can also contain.
    pub(crate) commands: Vec<DrawCommand>,
    viewport: Viewport,
    scissor: [u32; 4],
    blend_constant: [f32; 4],
    stencil_reference: Option<u32>,
}

impl PreparedDraw {
    pub(crate) fn new(
        lowering: &mut Lowering<'_>,
        scene: &Scene,
        pass: &Pass,
        draw: &Draw,
        (bound, counted): (Option<Bound>, DrawQueries),
        geometry: &mut GeometryBuffers,
    ) -> Result<Self, Requirement> {
        let mut commands = Vec::new();
        if scene.path.state == PathState::OtherPipeline {
            let other = pipeline::of_draw(lowering, scene, pass, &path::other(draw))?;
            commands.push(DrawCommand::SetPipeline(other));
        }
        let pipeline = pipeline::of_draw(lowering, scene, pass, draw)?;
        commands.push(DrawCommand::SetPipeline(pipeline));
        commands.extend(
            bound.map(|Bound { group, offset }| DrawCommand::SetBindGroup { group, offset }),
        );
        // WebGPU restarts only strips.
        let call = draw.call().without_list_restarts(draw.topology);
        commands.extend(geometry.inputs(lowering, &call));
        if scene.path.draws == PathDraws::AfterEmpty {
            commands.extend(drawn(&call, 0, call.instances));
            commands.extend(drawn(&call, call.count, 0));
        }
        if scene.path.draws != PathDraws::Indirect {
            commands.extend(drawn(&call, call.count, call.instances));
        } else if call.first_instance > 0 && !lowering.device.indirect_first_instance {
            let value = PathValue::Draws(PathDraws::Indirect);
            return Err(Requirement::Path(value));
        } else {
            let (buffer, offset) = geometry.arguments(lowering, &call);
            commands.extend(match &call.indices {
                None => Some(DrawCommand::DrawIndirect { buffer, offset }),
                Some(indices) if indices.is_empty() => None,
                Some(_) => Some(DrawCommand::DrawIndexedIndirect { buffer, offset }),
            });
        }
        let [width, height] = scene.pass_size(pass);
        Ok(Self {
            counted,
            commands,
            viewport: draw.viewport,
            scissor: draw.scissor.unwrap_or([0, 0, width, height]),
            blend_constant: draw.blend_constant,
            // WebGPU has one reference for both faces; `SeparateStencilMasks` is denied, so both faces have
            // the same reference.
            stencil_reference: draw.stencil.map(|s| s.front.reference.into()),
        })
    }

    /// Returns the commands that set, on a path, the state that is not in the pipeline.
    pub(crate) fn state(&self, path: PathState) -> Vec<PassCommand> {
        let mut commands = Vec::new();
        if path == PathState::Overwritten {
            commands.extend(self.other_state());
        }
        commands.extend(self.dynamic_state());
        commands
    }

    /// Returns the commands that set the state that is not in the pipeline.
    pub(crate) fn dynamic_state(&self) -> Vec<PassCommand> {
        let Viewport { rect, depth } = self.viewport;
        let mut commands = vec![
            PassCommand::SetViewport { rect, depth },
            PassCommand::SetScissorRect(self.scissor),
            PassCommand::SetBlendConstant(self.blend_constant),
        ];
        commands.extend(self.stencil_reference.map(PassCommand::SetStencilReference));
        commands
    }

    /// Returns commands that set other values of the state that is not in the pipeline.
    fn other_state(&self) -> Vec<PassCommand> {
        let constant = self.blend_constant.map(|v| if v > 0.5 { 0.0 } else { 1.0 });
        let mut commands = vec![
            PassCommand::SetViewport {
                rect: [0.0, 0.0, 1.0, 1.0],
                depth: [0.25, 0.5],
            },
            PassCommand::SetScissorRect([0, 0, 1, 1]),
            PassCommand::SetBlendConstant(constant),
        ];
        let reference = self.stencil_reference.map(|r| !r & 0xff);
        commands.extend(reference.map(PassCommand::SetStencilReference));
        commands
    }

    /// Returns true if the draws have the same state outside the pipeline, and no query begins or ends
    /// between them.
    fn shares_state(&self, other: &Self) -> bool {
        let state = |draw: &Self| {
            (
                draw.viewport,
                draw.scissor,
                draw.blend_constant,
                draw.stencil_reference,
            )
        };
        let counted = [self.counted, other.counted].map(DrawQueries::is_edge);
        state(self) == state(other) && counted == [false, false]
    }
}

/// Returns the command that draws, unless there is nothing to draw.
fn drawn(call: &Call<'_>, count: u32, instances: u32) -> Option<DrawCommand> {
    let vertices = call.first..call.first + count;
    let instances = call.first_instance..call.first_instance + instances;
    match &call.indices {
        None => Some(DrawCommand::Draw {
            vertices,
            instances,
        }),
        Some(indices) if indices.is_empty() => None,
        Some(_) => Some(DrawCommand::DrawIndexed {
            indices: vertices,
            base_vertex: call.base_vertex,
            instances,
        }),
    }
}

/// Returns the longest runs of draws with the same state outside the pipeline.
pub(crate) fn runs(draws: &[PreparedDraw]) -> Vec<Range<usize>> {
    let mut first = 0;
    draws
        .chunk_by(PreparedDraw::shares_state)
        .map(|run| {
            let range = first..first + run.len();
            first = range.end;
            range
        })
        .collect()
}
