//! Commands, recorded through wgpu.

use crate::clock::Clock;
use crate::gpu::extent;
use crate::objects::CallObjects;
use crate::state;
use etalon_webgpu::{
    Access, BufferRows, ColorAttachment, DepthStencilAttachment, DrawCommand, EncoderCommand,
    Filled, PassCommand, QueryType, RenderPass, TexturePart,
};
use wgpu::util::RenderEncoder;

/// Records a command. Timed passes write timestamps with the clock.
pub(crate) fn command(
    objects: &CallObjects<'_>,
    encoder: &mut wgpu::CommandEncoder,
    clock: Option<&Clock>,
    command: &EncoderCommand,
) {
    match command {
        EncoderCommand::ClearBuffer { buffer, size } => {
            encoder.clear_buffer(&objects.buffers[*buffer], 0, Some(*size));
        }
        EncoderCommand::CopyBuffer {
            from,
            to,
            offset,
            size,
        } => {
            let (from, to) = (&objects.buffers[*from], &objects.buffers[*to]);
            encoder.copy_buffer_to_buffer(from, 0, to, *offset, *size);
        }
        EncoderCommand::Upload { from, to, size } => {
            let (from, to) = (rows(objects, from), part(objects, to));
            encoder.copy_buffer_to_texture(from, to, extent(*size));
        }
        EncoderCommand::Download { from, to, size } => {
            let (from, to) = (part(objects, from), rows(objects, to));
            encoder.copy_texture_to_buffer(from, to, extent(*size));
        }
        EncoderCommand::CopyTexture { from, to, size } => {
            let (from, to) = (part(objects, from), part(objects, to));
            encoder.copy_texture_to_texture(from, to, extent(*size));
        }
        EncoderCommand::Resolve {
            set,
            buffer,
            offset,
        } => {
            let set = &objects.query_sets[*set];
            encoder.resolve_query_set(set, 0..set.count(), &objects.buffers[*buffer], *offset);
        }
        EncoderCommand::Pass(described) => pass(objects, encoder, clock, described),
    }
}

fn rows<'o>(objects: &'o CallObjects<'_>, rows: &BufferRows) -> wgpu::TexelCopyBufferInfo<'o> {
    wgpu::TexelCopyBufferInfo {
        buffer: &objects.buffers[rows.buffer],
        layout: wgpu::TexelCopyBufferLayout {
            offset: rows.offset,
            bytes_per_row: Some(rows.pitch),
            rows_per_image: None,
        },
    }
}

fn part<'o>(objects: &'o CallObjects<'_>, part: &TexturePart) -> wgpu::TexelCopyTextureInfo<'o> {
    let [x, y, z] = part.origin;
    wgpu::TexelCopyTextureInfo {
        texture: &objects.textures[part.texture].texture,
        mip_level: part.level,
        origin: wgpu::Origin3d { x, y, z },
        aspect: state::aspect(part.aspect),
    }
}

fn pass(
    objects: &CallObjects<'_>,
    encoder: &mut wgpu::CommandEncoder,
    clock: Option<&Clock>,
    pass: &RenderPass,
) {
    let colors = pass
        .color
        .iter()
        .map(|color| color.as_ref().map(|color| as_color(objects, color)));
    let colors: Vec<_> = colors.collect();
    let depth_stencil = pass
        .depth_stencil
        .as_ref()
        .map(|a| as_depth_stencil(objects, a));
    let [begins, ends] = pass.timed;
    let clock = clock.filter(|_| begins || ends);
    let mut encoder = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &colors,
        depth_stencil_attachment: depth_stencil,
        timestamp_writes: clock.map(|clock| wgpu::RenderPassTimestampWrites {
            query_set: &clock.queries,
            beginning_of_pass_write_index: begins.then_some(0),
            end_of_pass_write_index: ends.then_some(1),
        }),
        occlusion_query_set: pass.occlusion.map(|set| &objects.query_sets[set]),
        ..wgpu::RenderPassDescriptor::default()
    });
    for command in &pass.commands {
        in_pass(objects, &mut encoder, command);
    }
}

fn as_color<'o>(
    objects: &'o CallObjects<'_>,
    color: &ColorAttachment,
) -> wgpu::RenderPassColorAttachment<'o> {
    wgpu::RenderPassColorAttachment {
        view: &objects.views[color.view],
        depth_slice: color.depth_slice,
        resolve_target: color.resolve.map(|view| &objects.views[view]),
        ops: operations(color.operations, state::color),
    }
}

fn as_depth_stencil<'o>(
    objects: &'o CallObjects<'_>,
    attachment: &DepthStencilAttachment,
) -> wgpu::RenderPassDepthStencilAttachment<'o> {
    wgpu::RenderPassDepthStencilAttachment {
        view: &objects.views[attachment.view],
        depth_ops: accessed(attachment.depth),
        stencil_ops: accessed(attachment.stencil),
    }
}

/// Returns wgpu's operations of an aspect, if the pass can write it.
fn accessed<V>(access: Access<V>) -> Option<wgpu::Operations<V>> {
    match access {
        Access::Absent | Access::ReadOnly => None,
        Access::Written(filled) => Some(operations(filled, |value| value)),
    }
}

fn operations<V, W>(filled: Filled<V>, value: impl Fn(V) -> W) -> wgpu::Operations<W> {
    wgpu::Operations {
        load: match filled.clear {
            Some(clear) => wgpu::LoadOp::Clear(value(clear)),
            None => wgpu::LoadOp::Load,
        },
        store: if filled.store {
            wgpu::StoreOp::Store
        } else {
            wgpu::StoreOp::Discard
        },
    }
}

fn in_pass<'o>(
    objects: &'o CallObjects<'_>,
    encoder: &mut wgpu::RenderPass<'o>,
    command: &PassCommand,
) {
    match command {
        PassCommand::SetViewport { rect, depth } => {
            let ([x, y, w, h], [near, far]) = (*rect, *depth);
            encoder.set_viewport(x, y, w, h, near, far);
        }
        PassCommand::SetScissorRect([x, y, w, h]) => encoder.set_scissor_rect(*x, *y, *w, *h),
        PassCommand::SetBlendConstant(color) => encoder.set_blend_constant(state::color(*color)),
        PassCommand::SetStencilReference(reference) => encoder.set_stencil_reference(*reference),
        PassCommand::Begin(query) if query.ty == QueryType::Occlusion => {
            encoder.begin_occlusion_query(query.index);
        }
        PassCommand::Begin(query) => {
            let set = &objects.query_sets[query.set];
            encoder.begin_pipeline_statistics_query(set, query.index);
        }
        PassCommand::End(QueryType::Occlusion) => encoder.end_occlusion_query(),
        PassCommand::End(QueryType::FragmentInvocations) => {
            encoder.end_pipeline_statistics_query();
        }
        PassCommand::Execute(bundle) => encoder.execute_bundles([&objects.bundles[*bundle]]),
        PassCommand::Draw(command) => draw(objects, encoder, command),
    }
}

/// Records a command in a pass or a bundle.
pub(crate) fn draw<'o>(
    objects: &'o CallObjects<'_>,
    encoder: &mut impl RenderEncoder<'o>,
    command: &DrawCommand,
) {
    match command {
        DrawCommand::SetPipeline(pipeline) => encoder.set_pipeline(&objects.pipelines[*pipeline]),
        DrawCommand::SetBindGroup { group, offset } => {
            encoder.set_bind_group(0, Some(&objects.groups[*group]), offset.as_slice());
        }
        DrawCommand::SetVertexBuffer {
            slot,
            buffer,
            place,
        } => {
            let vertices = objects.buffers[*buffer].slice(place.clone());
            encoder.set_vertex_buffer(*slot, Some(vertices));
        }
        DrawCommand::SetIndexBuffer {
            buffer,
            place,
            format,
        } => {
            let indices = objects.buffers[*buffer].slice(place.clone());
            encoder.set_index_buffer(indices, state::index_format(*format));
        }
        DrawCommand::Draw {
            vertices,
            instances,
        } => encoder.draw(vertices.clone(), instances.clone()),
        DrawCommand::DrawIndexed {
            indices,
            base_vertex,
            instances,
        } => encoder.draw_indexed(indices.clone(), *base_vertex, instances.clone()),
        DrawCommand::DrawIndirect { buffer, offset } => {
            encoder.draw_indirect(&objects.buffers[*buffer], *offset);
        }
        DrawCommand::DrawIndexedIndirect { buffer, offset } => {
            encoder.draw_indexed_indirect(&objects.buffers[*buffer], *offset);
        }
    }
}
