//! Recorded calls that make objects.

use super::calls::{Objects, digits, field, part, word};
use super::code::{Code, Structure, call, defined, list, option};
use super::literals::{bits, bytes, format, of, plain, source, text, truth};
use crate::error::BundleError;
use etalon_backend::Tree;

/// A printed part, or why there is none.
pub(super) type Printed = Result<Code, BundleError>;

/// Returns what an option holds, printed.
pub(super) fn held(
    value: &Tree,
    print: impl FnOnce(&Tree) -> Printed,
) -> Result<Option<Code>, BundleError> {
    value.some().map(print).transpose()
}

/// Returns a list, each value printed.
pub(super) fn each(value: &Tree, print: impl FnMut(&Tree) -> Printed) -> Printed {
    let codes: Vec<Code> = value.list().iter().map(print).collect::<Result<_, _>>()?;
    Ok(list(codes))
}

/// Returns the size of a texture or of what is copied.
pub(super) fn extent(value: &Tree) -> Printed {
    Ok(Structure::of("wgpu::Extent3d")
        .with("width", plain(field(value, "width")?)?)
        .with("height", plain(field(value, "height")?)?)
        .with(
            "depth_or_array_layers",
            plain(field(value, "depthOrArrayLayers")?)?,
        )
        .end())
}

/// Returns the definition of an object that the device makes.
fn made(
    objects: &mut Objects,
    kind: &'static str,
    id: &Tree,
    method: &str,
    descriptor: Code,
) -> Printed {
    let name = objects.define(kind, id)?;
    Ok(defined(&name, call("device", method, [descriptor])))
}

/// Returns a call that makes a buffer. `mapped` becomes the variable of one that can be read.
pub(super) fn buffer(objects: &mut Objects, mapped: &mut Option<String>, action: &Tree) -> Printed {
    let d = part(action, 1)?;
    let usage = bits("BufferUsages", field(d, "usage")?)?;
    let is_read = usage.rust.contains("MAP_READ");
    let descriptor = Structure::of("wgpu::BufferDescriptor")
        .of_wgpu("label", "None")
        .with("size", plain(field(d, "size")?)?)
        .with("usage", usage)
        .of_wgpu("mapped_at_creation", "false")
        .end();
    let id = part(action, 0)?;
    let statement = made(
        objects,
        "buffer",
        id,
        "create_buffer",
        descriptor.borrowed(),
    )?;
    if is_read {
        *mapped = Some(objects.name("buffer", id)?.to_owned());
    }
    Ok(statement)
}

/// Returns a call that writes into a buffer.
pub(super) fn write(objects: &Objects, action: &Tree) -> Printed {
    let Tree::Bytes(data) = field(action, "data")? else {
        return Err(BundleError::Call("WriteBuffer".to_owned()));
    };
    let buffer = Code::same(objects.name("buffer", field(action, "id")?)?);
    let offset = plain(field(action, "offset")?)?;
    Ok(call(
        "queue",
        "write_buffer",
        [buffer.borrowed(), offset, bytes(data)],
    ))
}

/// Returns a call that makes a texture.
pub(super) fn texture(objects: &mut Objects, action: &Tree) -> Printed {
    let d = part(action, 1)?;
    let descriptor = Structure::of("wgpu::TextureDescriptor")
        .of_wgpu("label", "None")
        .with("size", extent(field(d, "size")?)?)
        .with("mip_level_count", plain(field(d, "mip_level_count")?)?)
        .with("sample_count", plain(field(d, "sample_count")?)?)
        .with("dimension", of("TextureDimension", field(d, "dimension")?)?)
        .with("format", format(field(d, "format")?)?)
        .with("usage", bits("TextureUsages", field(d, "usage")?)?)
        .with("view_formats", each(field(d, "view_formats")?, format)?)
        .end();
    let id = part(action, 0)?;
    made(
        objects,
        "texture",
        id,
        "create_texture",
        descriptor.borrowed(),
    )
}

/// Returns a call that makes a view.
pub(super) fn view(objects: &mut Objects, action: &Tree) -> Printed {
    let d = field(action, "desc")?;
    let range = field(d, "range")?;
    let dimension = held(field(d, "dimension")?, |v| of("TextureViewDimension", v))?;
    let descriptor = Structure::of("wgpu::TextureViewDescriptor")
        .of_wgpu("label", "None")
        .optional("format", held(field(d, "format")?, format)?)
        .optional("dimension", dimension)
        .of_wgpu("usage", "None")
        .with("aspect", of("TextureAspect", field(range, "aspect")?)?)
        .with("base_mip_level", plain(field(range, "baseMipLevel")?)?)
        .optional(
            "mip_level_count",
            held(field(range, "mipLevelCount")?, plain)?,
        )
        .with("base_array_layer", plain(field(range, "baseArrayLayer")?)?)
        .optional(
            "array_layer_count",
            held(field(range, "arrayLayerCount")?, plain)?,
        )
        .end();
    let parent = objects
        .name("texture", field(action, "parent")?)?
        .to_owned();
    let name = objects.define("view", field(action, "id")?)?;
    let view = call(&parent, "create_view", [descriptor.borrowed()]);
    Ok(defined(&name, view))
}

/// Returns the size of a binding, if it has one.
fn size(value: &Tree) -> Result<Option<[String; 2]>, BundleError> {
    let digits = value.some().map(digits).transpose()?;
    Ok(digits.map(|n| [format!("wgpu::BufferSize::new({n})"), n.to_owned()]))
}

/// Adds the size of a binding.
fn sized(structure: Structure, name: &str, value: &Tree) -> Result<Structure, BundleError> {
    Ok(match size(value)? {
        Some([rust, script]) => structure.with(name, Code::new(rust, script)),
        None => structure.of_wgpu(name, "None"),
    })
}

/// Returns a call that makes the layout of a bind group.
pub(super) fn group_layout(objects: &mut Objects, action: &Tree) -> Printed {
    let entries = each(field(part(action, 1)?, "entries")?, |entry| {
        Ok(Structure::of("wgpu::BindGroupLayoutEntry")
            .with("binding", plain(field(entry, "binding")?)?)
            .with(
                "visibility",
                bits("ShaderStages", field(entry, "visibility")?)?,
            )
            .in_place("ty", binding_type(field(entry, "ty")?)?)
            .of_wgpu("count", "None")
            .end())
    })?;
    let descriptor = Structure::of("wgpu::BindGroupLayoutDescriptor")
        .of_wgpu("label", "None")
        .with("entries", entries)
        .end();
    let id = part(action, 0)?;
    made(
        objects,
        "bind_group_layout",
        id,
        "create_bind_group_layout",
        descriptor.borrowed(),
    )
}

/// Returns the type of a binding, which is a member of its entry in a script.
fn binding_type(ty: &Tree) -> Printed {
    let (member, value) = match ty.name() {
        "Texture" => {
            let sample = field(ty, "sample_type")?;
            let sample = match sample.name() {
                "Float" => {
                    let filterable = word(field(sample, "filterable")?)?;
                    let script = match filterable {
                        "true" => "\"float\"",
                        _ => "\"unfilterable-float\"",
                    };
                    let rust =
                        format!("wgpu::TextureSampleType::Float {{ filterable: {filterable} }}");
                    Code::new(rust, script)
                }
                _ => of("TextureSampleType", sample)?,
            };
            let dimension = of("TextureViewDimension", field(ty, "view_dimension")?)?;
            let texture = Structure::of("wgpu::BindingType::Texture")
                .with("sample_type", sample)
                .with("view_dimension", dimension)
                .with("multisampled", truth(field(ty, "multisampled")?)?);
            ("texture", texture.end())
        }
        "Buffer" => {
            let kind = field(ty, "ty")?;
            let kind = match kind.name() {
                "Storage" => {
                    let read_only = word(field(kind, "read_only")?)?;
                    let script = match read_only {
                        "true" => "type: \"read-only-storage\"",
                        _ => "type: \"storage\"",
                    };
                    let rust =
                        format!("wgpu::BufferBindingType::Storage {{ read_only: {read_only} }}");
                    Code::new(rust, script)
                }
                _ => Code::new(of("BufferBindingType", kind)?.rust, "type: \"uniform\""),
            };
            let dynamic = truth(field(ty, "has_dynamic_offset")?)?;
            let buffer = Structure::of("wgpu::BindingType::Buffer")
                .in_place("ty", kind)
                .with("has_dynamic_offset", dynamic);
            let buffer = sized(buffer, "min_binding_size", field(ty, "min_binding_size")?)?;
            ("buffer", buffer.end())
        }
        other => return Err(BundleError::Call(format!("a binding of {other}"))),
    };
    Ok(Code {
        script: value.script.map(|value| format!("{member}: {value}")),
        ..value
    })
}

/// Returns a call that makes the layout of a pipeline.
pub(super) fn pipeline_layout(objects: &mut Objects, action: &Tree) -> Printed {
    let layouts = each(field(part(action, 1)?, "bind_group_layouts")?, |layout| {
        let layout = held(layout, |id| {
            let name = objects.name("bind_group_layout", id)?;
            Ok(Code::same(name).borrowed())
        })?;
        Ok(option(layout))
    })?;
    let descriptor = Structure::of("wgpu::PipelineLayoutDescriptor")
        .of_wgpu("label", "None")
        .with("bind_group_layouts", layouts)
        .of_wgpu("immediate_size", "0")
        .end();
    let id = part(action, 0)?;
    made(
        objects,
        "pipeline_layout",
        id,
        "create_pipeline_layout",
        descriptor.borrowed(),
    )
}

/// Returns a call that makes a bind group.
pub(super) fn group(objects: &mut Objects, action: &Tree) -> Printed {
    let d = part(action, 1)?;
    let entries = each(field(d, "entries")?, |entry| {
        let resource = field(entry, "resource")?;
        let inner = part(resource, 0)?;
        let resource = match resource.name() {
            "TextureView" => {
                let view = objects.name("view", inner)?;
                let rust = format!("wgpu::BindingResource::TextureView(&{view})");
                Code::new(rust, view)
            }
            "Buffer" => {
                let buffer = objects.name("buffer", field(inner, "buffer")?)?;
                let binding = Structure::of("wgpu::BufferBinding")
                    .with("buffer", Code::same(buffer).borrowed())
                    .with("offset", plain(field(inner, "offset")?)?);
                let binding = sized(binding, "size", field(inner, "size")?)?.end();
                Code {
                    rust: format!("wgpu::BindingResource::Buffer({})", binding.rust),
                    ..binding
                }
            }
            other => return Err(BundleError::Call(format!("a binding of {other}"))),
        };
        Ok(Structure::of("wgpu::BindGroupEntry")
            .with("binding", plain(field(entry, "binding")?)?)
            .with("resource", resource)
            .end())
    })?;
    let layout = objects.name("bind_group_layout", field(d, "layout")?)?;
    let descriptor = Structure::of("wgpu::BindGroupDescriptor")
        .of_wgpu("label", "None")
        .with("layout", Code::same(layout).borrowed())
        .with("entries", entries)
        .end();
    let id = part(action, 0)?;
    made(
        objects,
        "bind_group",
        id,
        "create_bind_group",
        descriptor.borrowed(),
    )
}

/// Returns a call that makes a shader.
pub(super) fn shader(objects: &mut Objects, action: &Tree) -> Printed {
    let Tree::Text(wgsl) = field(action, "data")? else {
        return Err(BundleError::Call("a shader that is no WGSL".to_owned()));
    };
    let wgsl = source(wgsl);
    let code = Code {
        rust: format!("wgpu::ShaderSource::Wgsl({}.into())", wgsl.rust),
        script: wgsl.script.map(|wgsl| format!("code: {wgsl}")),
    };
    let descriptor = Structure::of("wgpu::ShaderModuleDescriptor")
        .of_wgpu("label", "None")
        .in_place("source", code)
        .end();
    let id = field(action, "id")?;
    made(objects, "shader", id, "create_shader_module", descriptor)
}

/// Returns a call that makes a query set.
pub(super) fn query_set(objects: &mut Objects, action: &Tree) -> Printed {
    let d = part(action, 1)?;
    let kind = field(d, "ty").or_else(|_| field(d, "type"))?;
    let kind = match kind {
        Tree::Name(_) => {
            let kind = of("QueryType", kind)?;
            Code {
                script: kind.script.map(|kind| format!("type: {kind}")),
                ..kind
            }
        }
        kind => Code::of_wgpu(format!(
            "wgpu::QueryType::PipelineStatistics({})",
            bits("PipelineStatisticsTypes", part(kind, 0)?)?.rust
        )),
    };
    let descriptor = Structure::of("wgpu::QuerySetDescriptor")
        .of_wgpu("label", "None")
        .in_place("ty", kind)
        .with("count", plain(field(d, "count")?)?)
        .end();
    let id = part(action, 0)?;
    made(
        objects,
        "query_set",
        id,
        "create_query_set",
        descriptor.borrowed(),
    )
}

/// Returns the structure of a stage, with its shader.
fn stage(objects: &Objects, kind: &str, stage: &Tree) -> Result<Structure, BundleError> {
    if !field(stage, "constants")?.list().is_empty() {
        return Err(BundleError::Call("constants of a shader".to_owned()));
    }
    let module = objects.name("shader", field(stage, "module")?)?;
    Ok(Structure::of(kind)
        .with("module", Code::same(module).borrowed())
        .optional("entry_point", held(field(stage, "entry_point")?, text)?)
        .of_wgpu("compilation_options", "Default::default()"))
}

/// Returns a call that makes a render pipeline.
pub(super) fn pipeline(objects: &mut Objects, action: &Tree) -> Printed {
    let d = field(action, "desc")?;
    let vertex = part(field(d, "vertex")?, 0)?;
    let buffers = each(field(vertex, "buffers")?, |layout| {
        Ok(option(held(layout, vertex_buffer)?))
    })?;
    let fragment = held(field(d, "fragment")?, |fragment| {
        let targets = each(field(fragment, "targets")?, |target| {
            Ok(option(held(target, color_target)?))
        })?;
        let state = stage(objects, "wgpu::FragmentState", field(fragment, "stage")?)?;
        Ok(state.with("targets", targets).end())
    })?;
    let layout = held(field(d, "layout")?, |id| {
        Ok(Code::same(objects.name("pipeline_layout", id)?).borrowed())
    })?;
    let layout = match layout {
        Some(_) => option(layout),
        None => Code::new("None", "\"auto\""),
    };
    let vertex = stage(objects, "wgpu::VertexState", field(vertex, "stage")?)?;
    let multisample = field(d, "multisample")?;
    let covered = field(multisample, "alphaToCoverageEnabled")?;
    let multisample = Structure::of("wgpu::MultisampleState")
        .with("count", plain(field(multisample, "count")?)?)
        .with("mask", sample_mask(field(multisample, "mask")?)?)
        .with("alpha_to_coverage_enabled", truth(covered)?);
    let depth_stencil = held(field(d, "depth_stencil")?, depth_stencil)?;
    let descriptor = Structure::of("wgpu::RenderPipelineDescriptor")
        .of_wgpu("label", "None")
        .with("layout", layout)
        .with("vertex", vertex.with("buffers", buffers).end())
        .with("primitive", primitive(field(d, "primitive")?)?)
        .optional("depth_stencil", depth_stencil)
        .with("multisample", multisample.end())
        .optional("fragment", fragment)
        .of_wgpu("multiview_mask", "None")
        .of_wgpu("cache", "None")
        .end();
    let id = field(action, "id")?;
    made(
        objects,
        "pipeline",
        id,
        "create_render_pipeline",
        descriptor.borrowed(),
    )
}

/// Returns a sample mask, of which WebGPU has 32 bits.
fn sample_mask(value: &Tree) -> Printed {
    let digits = digits(value)?;
    let unread = |_| BundleError::Call(format!("a sample mask {digits}"));
    let mask: u64 = digits.parse().map_err(unread)?;
    Ok(Code::new(digits, (mask & u64::from(u32::MAX)).to_string()))
}

fn vertex_buffer(layout: &Tree) -> Printed {
    let attributes = each(field(layout, "attributes")?, |attribute| {
        Ok(Structure::of("wgpu::VertexAttribute")
            .with("format", of("VertexFormat", field(attribute, "format")?)?)
            .with("offset", plain(field(attribute, "offset")?)?)
            .with(
                "shader_location",
                plain(field(attribute, "shaderLocation")?)?,
            )
            .end())
    })?;
    Ok(Structure::of("wgpu::VertexBufferLayout")
        .with("array_stride", plain(field(layout, "arrayStride")?)?)
        .with(
            "step_mode",
            of("VertexStepMode", field(layout, "stepMode")?)?,
        )
        .with("attributes", attributes)
        .end())
}

fn primitive(state: &Tree) -> Printed {
    let strip = held(field(state, "stripIndexFormat")?, |v| of("IndexFormat", v))?;
    let culled = held(field(state, "cullMode")?, |v| of("Face", v))?;
    // WebGPU has no such modes.
    let mode = of("PolygonMode", field(state, "polygonMode")?)?.rust;
    let conservative = word(field(state, "conservative")?)?;
    let is_web = mode.ends_with("::Fill") && conservative == "false";
    let primitive = Structure::of("wgpu::PrimitiveState")
        .with(
            "topology",
            of("PrimitiveTopology", field(state, "topology")?)?,
        )
        .optional("strip_index_format", strip)
        .with("front_face", of("FrontFace", field(state, "frontFace")?)?)
        .optional("cull_mode", culled)
        .with("unclipped_depth", truth(field(state, "unclippedDepth")?)?)
        .of_wgpu("polygon_mode", &mode)
        .of_wgpu("conservative", conservative)
        .end();
    Ok(if is_web {
        primitive
    } else {
        Code::of_wgpu(primitive.rust)
    })
}

fn color_target(target: &Tree) -> Printed {
    let blend = held(field(target, "blend")?, |blend| {
        let component = |name: &str| {
            let component = field(blend, name)?;
            let factor = |name| of("BlendFactor", field(component, name)?);
            let operation = of("BlendOperation", field(component, "operation")?)?;
            Ok::<_, BundleError>(
                Structure::of("wgpu::BlendComponent")
                    .with("src_factor", factor("srcFactor")?)
                    .with("dst_factor", factor("dstFactor")?)
                    .with("operation", operation)
                    .end(),
            )
        };
        Ok(Structure::of("wgpu::BlendState")
            .with("color", component("color")?)
            .with("alpha", component("alpha")?)
            .end())
    })?;
    let mask = field(target, "writeMask").or_else(|_| field(target, "write_mask"))?;
    Ok(Structure::of("wgpu::ColorTargetState")
        .with("format", format(field(target, "format")?)?)
        .optional("blend", blend)
        .with("write_mask", bits("ColorWrites", mask)?)
        .end())
}

fn depth_stencil(state: &Tree) -> Printed {
    let (stencil, bias) = (field(state, "stencil")?, field(state, "bias")?);
    let face = |name: &str| {
        let face = field(stencil, name)?;
        let operation = |name| of("StencilOperation", field(face, name)?);
        let compare = of("CompareFunction", field(face, "compare")?)?;
        Ok::<_, BundleError>(
            Structure::of("wgpu::StencilFaceState")
                .with("compare", compare)
                .with("fail_op", operation("failOp")?)
                .with("depth_fail_op", operation("depthFailOp")?)
                .with("pass_op", operation("passOp")?)
                .end(),
        )
    };
    let stencil = Structure::of("wgpu::StencilState")
        .in_place("front", named("stencilFront", face("front")?))
        .in_place("back", named("stencilBack", face("back")?))
        .in_place(
            "read_mask",
            named("stencilReadMask", plain(field(stencil, "read_mask")?)?),
        )
        .in_place(
            "write_mask",
            named("stencilWriteMask", plain(field(stencil, "write_mask")?)?),
        );
    let bias = Structure::of("wgpu::DepthBiasState")
        .in_place(
            "constant",
            named("depthBias", plain(field(bias, "constant")?)?),
        )
        .in_place(
            "slope_scale",
            named("depthBiasSlopeScale", plain(field(bias, "slope_scale")?)?),
        )
        .in_place(
            "clamp",
            named("depthBiasClamp", plain(field(bias, "clamp")?)?),
        );
    let written = held(field(state, "depth_write_enabled")?, truth)?;
    let compare = held(field(state, "depth_compare")?, |v| of("CompareFunction", v))?;
    Ok(Structure::of("wgpu::DepthStencilState")
        .with("format", format(field(state, "format")?)?)
        .optional("depth_write_enabled", written)
        .optional("depth_compare", compare)
        .in_place("stencil", stencil.end().members())
        .in_place("bias", bias.end().members())
        .end())
}

/// Returns a value that is a member of this name in a script.
pub(super) fn named(name: &str, value: Code) -> Code {
    Code {
        script: value.script.map(|value| format!("{name}: {value}")),
        ..value
    }
}
