//! Commands of an encoder, a render pass or a render bundle.

use super::code::{Code, Structure, call, defined, defined_to_change, list, option};
use super::literals::{float, format, number, of, plain};
use super::objects::{aspect, extent, named, object, variable};
use etalon_webgpu::{
    Access, BufferRows, CallList, ColorAttachment, DepthStencilAttachment, DrawCommand,
    EncoderCommand, Filled, PassCommand, QueryType, RenderBundle, RenderPass, TexturePart,
};
use std::ops::Range;

/// Returns the statements that submit one command buffer. `number` distinguishes its encoder from others.
pub(super) fn submission<'c>(
    calls: &CallList,
    commands: impl IntoIterator<Item = &'c EncoderCommand>,
    number: usize,
) -> Vec<Code> {
    let encoder = format!("encoder_{number}");
    let begun = call(
        "device",
        "create_command_encoder",
        [Code::new("&Default::default()", "")],
    );
    let mut statements = vec![defined_to_change(&encoder, begun)];
    for command in commands {
        statements.extend(encoded(calls, &encoder, command));
    }
    let finished = format!("[{encoder}.finish()]");
    statements.push(call("queue", "submit", [Code::same(finished)]));
    statements
}

/// Returns the statements of an encoder's command.
fn encoded(calls: &CallList, encoder: &str, command: &EncoderCommand) -> Vec<Code> {
    let copy = |method: &str, from: Code, to: Code, [width, height]: [u32; 2]| {
        call(encoder, method, [from, to, extent([width, height, 1])])
    };
    vec![match command {
        EncoderCommand::Pass(described) => return pass(encoder, described),
        EncoderCommand::ClearBuffer { buffer, size } => {
            let size = option(Some(plain(size)));
            call(
                encoder,
                "clear_buffer",
                [object("buffer", *buffer), plain(0), size],
            )
        }
        EncoderCommand::CopyBuffer {
            from,
            to,
            offset,
            size,
        } => call(
            encoder,
            "copy_buffer_to_buffer",
            [
                object("buffer", *from),
                plain(0),
                object("buffer", *to),
                plain(offset),
                option(Some(plain(size))),
            ],
        ),
        EncoderCommand::Upload { from, to, size } => {
            copy("copy_buffer_to_texture", rows(from), part(to), *size)
        }
        EncoderCommand::Download { from, to, size } => {
            copy("copy_texture_to_buffer", part(from), rows(to), *size)
        }
        EncoderCommand::CopyTexture { from, to, size } => {
            copy("copy_texture_to_texture", part(from), part(to), *size)
        }
        EncoderCommand::Resolve {
            set,
            buffer,
            offset,
        } => {
            let count = calls.query_sets[*set].count;
            let queries = Code::new(format!("0..{count}"), format!("0, {count}"));
            let (set, buffer) = (object("query_set", *set), object("buffer", *buffer));
            call(
                encoder,
                "resolve_query_set",
                [set, queries, buffer, plain(offset)],
            )
        }
    }]
}

fn rows(rows: &BufferRows) -> Code {
    let layout = Structure::of("wgpu::TexelCopyBufferLayout")
        .with("offset", plain(rows.offset))
        .optional("bytes_per_row", Some(plain(rows.pitch)))
        .optional("rows_per_image", None);
    Structure::of("wgpu::TexelCopyBufferInfo")
        .with("buffer", object("buffer", rows.buffer))
        .in_place("layout", layout.end().members())
        .end()
}

fn part(part: &TexturePart) -> Code {
    let [x, y, z] = part.origin.map(plain);
    let origin = Structure::of("wgpu::Origin3d")
        .with("x", x)
        .with("y", y)
        .with("z", z);
    Structure::of("wgpu::TexelCopyTextureInfo")
        .with("texture", object("texture", part.texture))
        .with("mip_level", plain(part.level))
        .with("origin", origin.end())
        .with("aspect", aspect(part.aspect))
        .end()
}

/// Returns the statements of a render pass.
fn pass(encoder: &str, pass: &RenderPass) -> Vec<Code> {
    let colors = pass.color.iter().map(|c| option(c.as_ref().map(as_color)));
    let queries = pass.occlusion.map(|set| object("query_set", set));
    let descriptor = Structure::of("wgpu::RenderPassDescriptor")
        .of_wgpu("label", "None")
        .with("color_attachments", list(colors))
        .optional(
            "depth_stencil_attachment",
            pass.depth_stencil.as_ref().map(as_depth_stencil),
        )
        .of_wgpu("timestamp_writes", "None")
        .optional("occlusion_query_set", queries)
        .of_wgpu("multiview_mask", "None")
        .end();
    let begun = call(encoder, "begin_render_pass", [descriptor.borrowed()]);
    if pass.commands.is_empty() {
        // In Rust, the pass ends when it is dropped.
        return vec![Code {
            script: begun.script.map(|begun| format!("{begun}.end()")),
            ..begun
        }];
    }
    let mut statements = vec![Code::same("{"), defined_to_change("pass", begun)];
    statements.extend(pass.commands.iter().map(in_pass));
    statements.push(Code::new("drop(pass)", "pass.end()"));
    statements.push(Code::same("}"));
    statements
}

fn as_color(color: &ColorAttachment) -> Code {
    let resolve = color.resolve.map(|view| object("view", view));
    Structure::of("wgpu::RenderPassColorAttachment")
        .with("view", object("view", color.view))
        .optional("depth_slice", color.depth_slice.map(plain))
        .optional("resolve_target", resolve)
        .in_place("ops", operations("", color.operations, clear_color))
        .end()
}

fn as_depth_stencil(attachment: &DepthStencilAttachment) -> Code {
    Structure::of("wgpu::RenderPassDepthStencilAttachment")
        .with("view", object("view", attachment.view))
        .in_place("depth_ops", accessed("depth", attachment.depth, float))
        .in_place(
            "stencil_ops",
            accessed("stencil", attachment.stencil, plain),
        )
        .end()
}

/// Returns the access to an aspect. In Rust, `None` means read-only or absent.
fn accessed<V>(aspect: &str, access: Access<V>, value: impl FnOnce(V) -> Code) -> Code {
    match access {
        Access::Absent => Code::new("None", ""),
        Access::ReadOnly => Code::new("None", format!("{aspect}ReadOnly: true")),
        Access::Written(filled) => option(Some(operations(aspect, filled, value))),
    }
}

/// Returns how an attachment is loaded and stored, as members of its dictionary whose names begin with
/// `prefix`.
fn operations<V>(prefix: &str, filled: Filled<V>, value: impl FnOnce(V) -> Code) -> Code {
    let member = |name: &str| match prefix {
        "" => format!("{}{}", name[..1].to_ascii_lowercase(), &name[1..]),
        prefix => format!("{prefix}{name}"),
    };
    let store = of("StoreOp", if filled.store { "store" } else { "discard" });
    let load = match filled.clear {
        None => named(&member("LoadOp"), of("LoadOp", "load")),
        Some(clear) => {
            let clear = value(clear);
            let names = [member("LoadOp"), member("ClearValue")];
            let script = |value| format!("{}: \"clear\", {}: {value}", names[0], names[1]);
            Code {
                rust: format!("wgpu::LoadOp::Clear({})", clear.rust),
                script: clear.script.map(script),
            }
        }
    };
    let rust = format!(
        "wgpu::Operations {{ load: {}, store: {} }}",
        load.rust, store.rust
    );
    let members = load.script.zip(named(&member("StoreOp"), store).script);
    Code {
        rust,
        script: members.map(|(load, store)| format!("{load}, {store}")),
    }
}

/// Returns a clear colour.
fn clear_color(color: [f32; 4]) -> Code {
    let [r, g, b, a] = color.map(|channel| number(channel.into()));
    Structure::of("wgpu::Color")
        .with("r", r)
        .with("g", g)
        .with("b", b)
        .with("a", a)
        .end()
}

fn in_pass(command: &PassCommand) -> Code {
    let on = "pass";
    match command {
        PassCommand::SetViewport { rect, depth } => call(
            on,
            "set_viewport",
            rect.iter().chain(depth).copied().map(float),
        ),
        PassCommand::SetScissorRect(rect) => call(on, "set_scissor_rect", rect.map(plain)),
        PassCommand::SetBlendConstant(color) => {
            call(on, "set_blend_constant", [clear_color(*color)])
        }
        PassCommand::SetStencilReference(reference) => {
            call(on, "set_stencil_reference", [plain(reference)])
        }
        PassCommand::Begin(query) if query.ty == QueryType::Occlusion => {
            call(on, "begin_occlusion_query", [plain(query.index)])
        }
        PassCommand::Begin(query) => Code::of_wgpu(format!(
            "{on}.begin_pipeline_statistics_query(&{}, {})",
            variable("query_set", query.set),
            query.index
        )),
        PassCommand::End(QueryType::Occlusion) => call(on, "end_occlusion_query", []),
        PassCommand::End(QueryType::FragmentInvocations) => {
            Code::of_wgpu(format!("{on}.end_pipeline_statistics_query()"))
        }
        PassCommand::Execute(bundle) => {
            let bundle = variable("render_bundle", *bundle);
            let bundles = Code::new(format!("[&{bundle}]"), format!("[{bundle}]"));
            call(on, "execute_bundles", [bundles])
        }
        PassCommand::Draw(command) => drawn(on, command),
    }
}

/// Returns the statements that make a render bundle.
pub(super) fn bundle(bundle: &RenderBundle, place: usize) -> Vec<Code> {
    let depth_stencil = match bundle.depth_stencil {
        None => Code::new("None", ""),
        Some(known) => {
            let state = Structure::of("wgpu::RenderBundleDepthStencil")
                .in_place("format", named("depthStencilFormat", format(known)))
                .with("depth_read_only", plain(bundle.read_only))
                .with("stencil_read_only", plain(bundle.read_only))
                .end();
            option(Some(state.members()))
        }
    };
    let colors = bundle.color.iter().map(|known| option(known.map(format)));
    let descriptor = Structure::of("wgpu::RenderBundleEncoderDescriptor")
        .of_wgpu("label", "None")
        .with("color_formats", list(colors))
        .in_place("depth_stencil", depth_stencil)
        .with("sample_count", plain(bundle.samples))
        .of_wgpu("multiview", "None")
        .end();
    let begun = call(
        "device",
        "create_render_bundle_encoder",
        [descriptor.borrowed()],
    );
    let name = variable("render_bundle", place);
    let encoder = format!("{name}_encoder");
    let mut statements = vec![defined_to_change(&encoder, begun)];
    statements.extend(
        bundle
            .commands
            .iter()
            .map(|command| drawn(&encoder, command)),
    );
    let finished = call(&encoder, "finish", [Code::new("&Default::default()", "")]);
    statements.push(defined(&name, finished));
    statements
}

/// Returns a command of a pass or a bundle, called on the variable `on`.
fn drawn(on: &str, command: &DrawCommand) -> Code {
    match command {
        DrawCommand::SetPipeline(pipeline) => {
            call(on, "set_pipeline", [object("pipeline", *pipeline)])
        }
        DrawCommand::SetBindGroup { group, offset } => {
            let group = option(Some(object("bind_group", *group)));
            call(
                on,
                "set_bind_group",
                [plain(0), group, list(offset.map(plain))],
            )
        }
        DrawCommand::SetVertexBuffer {
            slot,
            buffer,
            place,
        } => {
            let (rust, script) = slice(*buffer, place);
            Code::new(
                format!("{on}.set_vertex_buffer({slot}, Some({rust}))"),
                format!(
                    "{on}.setVertexBuffer({slot}, {}, {script})",
                    variable("buffer", *buffer)
                ),
            )
        }
        DrawCommand::SetIndexBuffer {
            buffer,
            place,
            format,
        } => {
            let (rust, script) = slice(*buffer, place);
            let (buffer, format) = (
                variable("buffer", *buffer),
                of("IndexFormat", format.name()),
            );
            Code {
                rust: format!("{on}.set_index_buffer({rust}, {})", format.rust),
                script: format
                    .script
                    .map(|format| format!("{on}.setIndexBuffer({buffer}, {format}, {script})")),
            }
        }
        DrawCommand::Draw {
            vertices,
            instances,
        } => Code::new(
            format!("{on}.draw({vertices:?}, {instances:?})"),
            format!(
                "{on}.draw({}, {}, {}, {})",
                vertices.len(),
                instances.len(),
                vertices.start,
                instances.start
            ),
        ),
        DrawCommand::DrawIndexed {
            indices,
            base_vertex,
            instances,
        } => Code::new(
            format!("{on}.draw_indexed({indices:?}, {base_vertex}, {instances:?})"),
            format!(
                "{on}.drawIndexed({}, {}, {}, {base_vertex}, {})",
                indices.len(),
                instances.len(),
                indices.start,
                instances.start
            ),
        ),
        DrawCommand::DrawIndirect { buffer, offset } => {
            let arguments = [object("buffer", *buffer), plain(offset)];
            call(on, "draw_indirect", arguments)
        }
        DrawCommand::DrawIndexedIndirect { buffer, offset } => {
            let arguments = [object("buffer", *buffer), plain(offset)];
            call(on, "draw_indexed_indirect", arguments)
        }
    }
}

/// Returns a part of a buffer in Rust, and the corresponding arguments in a script.
fn slice(buffer: usize, place: &Range<u64>) -> (String, String) {
    let size = place.end.saturating_sub(place.start);
    (
        format!("{}.slice({place:?})", variable("buffer", buffer)),
        format!("{}, {size}", place.start),
    )
}
