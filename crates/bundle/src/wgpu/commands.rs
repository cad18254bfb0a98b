//! Recorded commands: of an encoder, of a render pass, of a render bundle.

use super::calls::{Objects, digits, field, part};
use super::code::{Code, Structure, call, defined, defined_to_change, list, option};
use super::descriptors::{Printed, each, extent, held, named};
use super::literals::{format, of, plain, truth};
use crate::error::BundleError;
use etalon_backend::Tree;

/// Returns the statements of a submission. `number` tells its encoder from others.
pub(super) fn submission(
    objects: &Objects,
    commands: &Tree,
    number: u32,
) -> Result<Vec<Code>, BundleError> {
    let encoder = format!("encoder_{number}");
    let begun = call(
        "device",
        "create_command_encoder",
        [Code::new("&Default::default()", "")],
    );
    let mut statements = vec![defined_to_change(&encoder, begun)];
    for command in commands.list() {
        statements.extend(encoded(objects, &encoder, command)?);
    }
    let finished = format!("[{encoder}.finish()]");
    statements.push(call("queue", "submit", [Code::same(finished)]));
    Ok(statements)
}

/// Returns the statements of a command of an encoder.
fn encoded(objects: &Objects, encoder: &str, c: &Tree) -> Result<Vec<Code>, BundleError> {
    let buffer = |name: &str| {
        let buffer = objects.name("buffer", field(c, name)?)?;
        Ok::<_, BundleError>(Code::same(buffer).borrowed())
    };
    let number = |name: &str| plain(field(c, name)?);
    // What a script leaves out at the end of its arguments.
    let size = |value: &Tree| {
        let size = held(value, plain)?;
        Ok::<_, BundleError>(match size {
            None => Code::new("None", "undefined"),
            size => option(size),
        })
    };
    let statement = match c.name() {
        "RunRenderPass" => return pass(objects, encoder, c),
        "ClearBuffer" => call(
            encoder,
            "clear_buffer",
            [buffer("dst")?, number("offset")?, size(field(c, "size")?)?],
        ),
        "CopyBufferToBuffer" => call(
            encoder,
            "copy_buffer_to_buffer",
            [
                buffer("src")?,
                number("src_offset")?,
                buffer("dst")?,
                number("dst_offset")?,
                size(field(c, "size")?)?,
            ],
        ),
        "ResolveQuerySet" => {
            let queries = objects.name("query_set", field(c, "query_set")?)?;
            let [first, count] = range(c, ["start_query", "query_count"])?;
            let range = Code::new(
                format!("{first}..{}", first.saturating_add(count)),
                format!("{first}, {count}"),
            );
            let target = buffer("destination")?;
            let offset = number("destination_offset")?;
            let queries = Code::same(queries).borrowed();
            call(
                encoder,
                "resolve_query_set",
                [queries, range, target, offset],
            )
        }
        name @ ("CopyTextureToBuffer" | "CopyBufferToTexture" | "CopyTextureToTexture") => {
            let method = match name {
                "CopyTextureToBuffer" => "copy_texture_to_buffer",
                "CopyBufferToTexture" => "copy_buffer_to_texture",
                _ => "copy_texture_to_texture",
            };
            let sides = [
                copied(objects, field(c, "src")?)?,
                copied(objects, field(c, "dst")?)?,
                extent(field(c, "size")?)?,
            ];
            call(encoder, method, sides)
        }
        name => return Err(BundleError::Call(name.to_owned())),
    };
    Ok(vec![statement])
}

/// Returns a first number and a count.
fn range(c: &Tree, names: [&str; 2]) -> Result<[u64; 2], BundleError> {
    let [first, count] = names.map(|name| {
        let digits = digits(field(c, name)?)?;
        let unread = |_| BundleError::Call(format!("{name} of {}", c.name()));
        digits.parse().map_err(unread)
    });
    Ok([first?, count?])
}

/// Returns one side of a copy.
fn copied(objects: &Objects, side: &Tree) -> Printed {
    if let Some(buffer) = side.field("buffer") {
        let layout = field(side, "layout")?;
        let rows = held(field(layout, "rows_per_image")?, plain)?;
        let layout = Structure::of("wgpu::TexelCopyBufferLayout")
            .with("offset", plain(field(layout, "offset")?)?)
            .optional(
                "bytes_per_row",
                held(field(layout, "bytes_per_row")?, plain)?,
            )
            .optional("rows_per_image", rows);
        let buffer = Code::same(objects.name("buffer", buffer)?).borrowed();
        return Ok(Structure::of("wgpu::TexelCopyBufferInfo")
            .with("buffer", buffer)
            .in_place("layout", layout.end().members())
            .end());
    }
    let origin = field(side, "origin")?;
    let origin = Structure::of("wgpu::Origin3d")
        .with("x", plain(field(origin, "x")?)?)
        .with("y", plain(field(origin, "y")?)?)
        .with("z", plain(field(origin, "z")?)?);
    let texture = objects.name("texture", field(side, "texture")?)?;
    Ok(Structure::of("wgpu::TexelCopyTextureInfo")
        .with("texture", Code::same(texture).borrowed())
        .with("mip_level", plain(field(side, "mip_level")?)?)
        .with("origin", origin.end())
        .with("aspect", of("TextureAspect", field(side, "aspect")?)?)
        .end())
}

/// Returns the statements of a render pass.
fn pass(objects: &Objects, encoder: &str, c: &Tree) -> Result<Vec<Code>, BundleError> {
    let view = |id: &Tree| Ok(Code::same(objects.name("view", id)?).borrowed());
    let colors = each(field(c, "color_attachments")?, |attachment| {
        let attachment = held(attachment, |a| {
            let operations =
                operations("", field(a, "load_op")?, field(a, "store_op")?, clear_color)?;
            Ok(Structure::of("wgpu::RenderPassColorAttachment")
                .with("view", view(field(a, "view")?)?)
                .optional("depth_slice", held(field(a, "depth_slice")?, plain)?)
                .optional("resolve_target", held(field(a, "resolve_target")?, view)?)
                .in_place("ops", operations)
                .end())
        })?;
        Ok(option(attachment))
    })?;
    let depth_stencil = held(field(c, "depth_stencil_attachment")?, |a| {
        Ok(Structure::of("wgpu::RenderPassDepthStencilAttachment")
            .with("view", view(field(a, "view")?)?)
            .in_place("depth_ops", channel("depth", field(a, "depth")?)?)
            .in_place("stencil_ops", channel("stencil", field(a, "stencil")?)?)
            .end())
    })?;
    let queries = held(field(c, "occlusion_query_set")?, |id| {
        Ok(Code::same(objects.name("query_set", id)?).borrowed())
    })?;
    let descriptor = Structure::of("wgpu::RenderPassDescriptor")
        .of_wgpu("label", "None")
        .with("color_attachments", colors)
        .optional("depth_stencil_attachment", depth_stencil)
        .of_wgpu("timestamp_writes", "None")
        .optional("occlusion_query_set", queries)
        .of_wgpu("multiview_mask", "None")
        .end();
    let begun = call(encoder, "begin_render_pass", [descriptor.borrowed()]);
    let commands = drawn(objects, "pass", field(c, "pass")?)?;
    if commands.is_empty() {
        // It ends where Rust drops it.
        return Ok(vec![Code {
            script: begun.script.map(|begun| format!("{begun}.end()")),
            ..begun
        }]);
    }
    let mut statements = vec![Code::same("{")];
    statements.push(defined_to_change("pass", begun));
    statements.extend(commands);
    statements.push(Code::new("drop(pass)", "pass.end()"));
    statements.push(Code::same("}"));
    Ok(statements)
}

/// Returns the statements that make a render bundle.
pub(super) fn bundle(objects: &mut Objects, action: &Tree) -> Result<Vec<Code>, BundleError> {
    let d = field(action, "desc")?;
    let formats = each(field(d, "color_formats")?, |format_of| {
        Ok(option(held(format_of, format)?))
    })?;
    let depth_stencil = held(field(d, "depth_stencil")?, |state| {
        let read_only = |name| truth(field(state, name)?);
        Ok(Structure::of("wgpu::RenderBundleDepthStencil")
            .in_place(
                "format",
                named("depthStencilFormat", format(field(state, "format")?)?),
            )
            .with("depth_read_only", read_only("depth_read_only")?)
            .with("stencil_read_only", read_only("stencil_read_only")?)
            .end())
    })?;
    let depth_stencil = match depth_stencil {
        Some(state) => option(Some(state.members())),
        None => Code::new("None", ""),
    };
    let descriptor = Structure::of("wgpu::RenderBundleEncoderDescriptor")
        .of_wgpu("label", "None")
        .with("color_formats", formats)
        .in_place("depth_stencil", depth_stencil)
        .with("sample_count", plain(field(d, "sample_count")?)?)
        .of_wgpu("multiview", "None")
        .end();
    let begun = call(
        "device",
        "create_render_bundle_encoder",
        [descriptor.borrowed()],
    );
    let name = objects.define("render_bundle", field(action, "id")?)?;
    let encoder = format!("{name}_encoder");
    let mut statements = vec![defined_to_change(&encoder, begun)];
    statements.extend(drawn(objects, &encoder, field(action, "base")?)?);
    let finished = call(&encoder, "finish", [Code::new("&Default::default()", "")]);
    statements.push(defined(&name, finished));
    Ok(statements)
}

/// Returns what happens to an aspect of the attachment of depth and stencil. `None` in Rust is read-only.
fn channel(aspect: &str, channel: &Tree) -> Printed {
    if channel.name() != "Operational" {
        return Ok(Code::new("None", format!("{aspect}ReadOnly: true")));
    }
    let operations_of = part(channel, 0)?;
    let (load, store) = (
        field(operations_of, "load")?,
        field(operations_of, "store")?,
    );
    Ok(option(Some(operations(aspect, load, store, plain)?)))
}

/// Returns how an attachment is loaded and stored, as members of its dictionary whose names begin with `prefix`.
fn operations(
    prefix: &str,
    load: &Tree,
    store: &Tree,
    print: impl FnOnce(&Tree) -> Printed,
) -> Printed {
    let member = |name: &str| match prefix {
        "" => format!("{}{}", name[..1].to_ascii_lowercase(), &name[1..]),
        prefix => format!("{prefix}{name}"),
    };
    let store = of("StoreOp", store)?;
    let store_member = named(&member("StoreOp"), store.clone()).script;
    let (load, load_members) = match load.name() {
        "clear" => {
            let value = print(part(load, 0)?)?;
            let members = value.script.map(|value| {
                format!(
                    "{}: \"clear\", {}: {value}",
                    member("LoadOp"),
                    member("ClearValue")
                )
            });
            (format!("wgpu::LoadOp::Clear({})", value.rust), members)
        }
        _ => {
            let load = of("LoadOp", load)?;
            let members = named(&member("LoadOp"), load.clone()).script;
            (load.rust, members)
        }
    };
    Ok(Code {
        rust: format!("wgpu::Operations {{ load: {load}, store: {} }}", store.rust),
        script: load_members
            .zip(store_member)
            .map(|(load, store)| format!("{load}, {store}")),
    })
}

/// Returns a color that clears.
fn clear_color(value: &Tree) -> Printed {
    let channel = |name| plain(field(value, name)?);
    Ok(Structure::of("wgpu::Color")
        .with("r", channel("r")?)
        .with("g", channel("g")?)
        .with("b", channel("b")?)
        .with("a", channel("a")?)
        .end())
}

/// Returns the statements of the commands of a pass or a bundle, made on the variable `on`.
fn drawn(objects: &Objects, on: &str, base: &Tree) -> Result<Vec<Code>, BundleError> {
    let mut offsets = field(base, "dynamic_offsets")?.list().iter();
    let commands = field(base, "commands")?.list().iter();
    commands
        .map(|command| drawing(objects, on, command, &mut offsets))
        .collect()
}

fn drawing<'t>(
    objects: &Objects,
    on: &str,
    c: &Tree,
    offsets: &mut impl Iterator<Item = &'t Tree>,
) -> Printed {
    let number = |name: &str| plain(field(c, name)?);
    let rect = |rect: &Tree| {
        let sides = ["x", "y", "w", "h"].map(|name| plain(field(rect, name)?));
        sides
            .into_iter()
            .collect::<Result<Vec<Code>, BundleError>>()
    };
    let command = |method: &str, argument: Code| call(on, method, [argument]);
    Ok(match c.name() {
        "SetPipeline" => {
            let pipeline = objects.name("pipeline", part(c, 0)?)?;
            command("set_pipeline", Code::same(pipeline).borrowed())
        }
        "SetBindGroup" => {
            let count: usize = digits(field(c, "num_dynamic_offsets")?)?
                .parse()
                .unwrap_or(0);
            let values: Vec<Code> = offsets.take(count).map(plain).collect::<Result<_, _>>()?;
            let group = held(field(c, "bind_group")?, |id| {
                Ok(Code::same(objects.name("bind_group", id)?).borrowed())
            })?;
            let arguments = [number("index")?, option(group), list(values)];
            call(on, "set_bind_group", arguments)
        }
        "SetIndexBuffer" => {
            let format = of("IndexFormat", field(c, "index_format")?)?;
            let Slice { rust, buffer, rest } = slice(objects, c, field(c, "buffer")?)?;
            Code {
                rust: format!("{on}.set_index_buffer({rust}, {})", format.rust),
                script: format
                    .script
                    .map(|format| format!("{on}.setIndexBuffer({buffer}, {format}{rest})")),
            }
        }
        "SetVertexBuffer" => {
            let slot = digits(field(c, "slot")?)?;
            match field(c, "buffer")?.some() {
                None => Code::new(
                    format!("{on}.set_vertex_buffer({slot}, None)"),
                    format!("{on}.setVertexBuffer({slot}, null)"),
                ),
                Some(buffer) => {
                    let Slice { rust, buffer, rest } = slice(objects, c, buffer)?;
                    Code::new(
                        format!("{on}.set_vertex_buffer({slot}, Some({rust}))"),
                        format!("{on}.setVertexBuffer({slot}, {buffer}{rest})"),
                    )
                }
            }
        }
        "SetBlendConstant" => command("set_blend_constant", clear_color(part(c, 0)?)?),
        "SetStencilReference" => command("set_stencil_reference", plain(part(c, 0)?)?),
        "SetViewport" => {
            let mut arguments = rect(field(c, "rect")?)?;
            arguments.extend([number("depth_min")?, number("depth_max")?]);
            call(on, "set_viewport", arguments)
        }
        "SetScissor" => call(on, "set_scissor_rect", rect(part(c, 0)?)?),
        "Draw" => {
            let [first, count] = range(c, ["first_vertex", "vertex_count"])?;
            let [instance, instances] = range(c, ["first_instance", "instance_count"])?;
            Code::new(
                format!(
                    "{on}.draw({first}..{}, {instance}..{})",
                    first.saturating_add(count),
                    instance.saturating_add(instances)
                ),
                format!("{on}.draw({count}, {instances}, {first}, {instance})"),
            )
        }
        "DrawIndexed" => {
            let [first, count] = range(c, ["first_index", "index_count"])?;
            let [instance, instances] = range(c, ["first_instance", "instance_count"])?;
            let base = digits(field(c, "base_vertex")?)?;
            Code::new(
                format!(
                    "{on}.draw_indexed({first}..{}, {base}, {instance}..{})",
                    first.saturating_add(count),
                    instance.saturating_add(instances)
                ),
                format!("{on}.drawIndexed({count}, {instances}, {first}, {base}, {instance})"),
            )
        }
        "DrawIndirect" if digits(field(c, "count")?)? == "1" => {
            let method = match field(c, "family")?.name() {
                "DrawIndexed" => "draw_indexed_indirect",
                _ => "draw_indirect",
            };
            let buffer = objects.name("buffer", field(c, "buffer")?)?;
            call(
                on,
                method,
                [Code::same(buffer).borrowed(), number("offset")?],
            )
        }
        "BeginOcclusionQuery" => command("begin_occlusion_query", number("query_index")?),
        "EndOcclusionQuery" => call(on, "end_occlusion_query", []),
        "BeginPipelineStatisticsQuery" => Code::of_wgpu(format!(
            "{on}.begin_pipeline_statistics_query(&{}, {})",
            objects.name("query_set", field(c, "query_set")?)?,
            digits(field(c, "query_index")?)?
        )),
        "EndPipelineStatisticsQuery" => {
            Code::of_wgpu(format!("{on}.end_pipeline_statistics_query()"))
        }
        "ExecuteBundle" => {
            let bundle = objects.name("render_bundle", part(c, 0)?)?;
            command(
                "execute_bundles",
                Code::new(format!("[&{bundle}]"), format!("[{bundle}]")),
            )
        }
        name => return Err(BundleError::Call(name.to_owned())),
    })
}

/// A part of a buffer.
struct Slice {
    /// The expression in Rust.
    rust: String,
    /// The variable of the buffer.
    buffer: String,
    /// The arguments that follow in a script.
    rest: String,
}

/// Returns the part of a buffer that a command names.
fn slice(objects: &Objects, c: &Tree, buffer: &Tree) -> Result<Slice, BundleError> {
    let buffer = objects.name("buffer", buffer)?.to_owned();
    let first = digits(field(c, "offset")?)?;
    let size = field(c, "size")?.some().map(digits).transpose()?;
    let end = match size {
        Some(size) => {
            let [first, size] = [first, size].map(|digits| digits.parse().unwrap_or(0_u64));
            first.saturating_add(size).to_string()
        }
        None => String::new(),
    };
    Ok(Slice {
        rust: format!("{buffer}.slice({first}..{end})"),
        rest: match size {
            Some(size) => format!(", {first}, {size}"),
            None => format!(", {first}"),
        },
        buffer,
    })
}
