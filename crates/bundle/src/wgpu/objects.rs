//! The objects of a list, as definitions of variables.

use super::code::{Code, Structure, call, defined, list, option};
use super::literals::{
    BUFFER_USAGES, COLOR_WRITES, Flags, TEXTURE_USAGES, bytes, float, format, of, plain, source,
    string,
};
use etalon_webgpu::{
    BindGroup, Binding, BlendComponent, Buffer, CallList, CullMode, DepthStencil, LayoutEntry,
    LayoutResource, PipelineTarget, Primitive, PrimitiveTopology, QuerySet, QueryType,
    RenderPipeline, SampleType, Sampler, Shader, StencilFace, Texture, TextureAspect,
    TextureDimension, TextureView, VertexAttribute, VertexBuffer,
};

/// Returns the variable of the object with this kind and index.
pub(super) fn variable(kind: &str, place: usize) -> String {
    format!("{kind}_{}", place + 1)
}

/// Returns a reference to the object with this kind and index.
pub(super) fn object(kind: &str, place: usize) -> Code {
    Code::same(variable(kind, place)).borrowed()
}

/// Returns the definitions of all objects except bundles. Buffers include their contents.
pub(super) fn definitions(calls: &CallList) -> Vec<Code> {
    let mut statements = Vec::new();
    let mut define = |kind: &str, place: usize, method: &str, descriptor: Code| {
        let made = call("device", method, [descriptor]);
        statements.push(defined(&variable(kind, place), made));
    };
    for (place, texture_of) in calls.textures.iter().enumerate() {
        define(
            "texture",
            place,
            "create_texture",
            texture(texture_of).borrowed(),
        );
    }
    for (place, shader_of) in calls.shaders.iter().enumerate() {
        define("shader", place, "create_shader_module", shader(shader_of));
    }
    for (place, entries) in calls.layouts.iter().enumerate() {
        let group = (!entries.is_empty()).then_some(place);
        if group.is_some() {
            let layout = group_layout(entries).borrowed();
            define(
                "bind_group_layout",
                place,
                "create_bind_group_layout",
                layout,
            );
        }
        let layout = pipeline_layout(group).borrowed();
        define("pipeline_layout", place, "create_pipeline_layout", layout);
    }
    if calls
        .pipelines
        .iter()
        .any(|pipeline| pipeline.layout.is_none())
    {
        let (place, layout) = (calls.layouts.len(), pipeline_layout(None).borrowed());
        define("pipeline_layout", place, "create_pipeline_layout", layout);
    }
    for (place, sampler_of) in calls.samplers.iter().enumerate() {
        define(
            "sampler",
            place,
            "create_sampler",
            sampler(sampler_of).borrowed(),
        );
    }
    for (place, buffer_of) in calls.buffers.iter().enumerate() {
        define(
            "buffer",
            place,
            "create_buffer",
            buffer(buffer_of).borrowed(),
        );
    }
    for (place, set) in calls.query_sets.iter().enumerate() {
        define(
            "query_set",
            place,
            "create_query_set",
            query_set(set).borrowed(),
        );
    }
    for (place, pipeline_of) in calls.pipelines.iter().enumerate() {
        let layout = pipeline_of.layout.unwrap_or(calls.layouts.len());
        let descriptor = pipeline(pipeline_of, layout).borrowed();
        define("pipeline", place, "create_render_pipeline", descriptor);
    }
    for (place, view_of) in calls.views.iter().enumerate() {
        let texture = variable("texture", view_of.texture);
        let made = call(&texture, "create_view", [view(view_of).borrowed()]);
        statements.push(defined(&variable("view", place), made));
    }
    for (place, group_of) in calls.groups.iter().enumerate() {
        let made = call("device", "create_bind_group", [group(group_of).borrowed()]);
        statements.push(defined(&variable("bind_group", place), made));
    }
    let filled = calls.buffers.iter().enumerate();
    let filled = filled.filter(|(_, buffer)| !buffer.contents.is_empty());
    statements.extend(filled.map(|(place, buffer)| {
        let arguments = [object("buffer", place), plain(0), bytes(&buffer.contents)];
        call("queue", "write_buffer", arguments)
    }));
    statements
}

/// Returns the size of a texture or of a copied part.
pub(super) fn extent([width, height, layers]: [u32; 3]) -> Code {
    Structure::of("wgpu::Extent3d")
        .with("width", plain(width))
        .with("height", plain(height))
        .with("depth_or_array_layers", plain(layers))
        .end()
}

/// Returns the aspects of a view or a copy.
pub(super) fn aspect(aspect: TextureAspect) -> Code {
    let name = match aspect {
        TextureAspect::All => "all",
        TextureAspect::DepthOnly => "depth-only",
        TextureAspect::StencilOnly => "stencil-only",
    };
    of("TextureAspect", name)
}

fn texture(texture: &Texture) -> Code {
    let dimension = match texture.dimension {
        TextureDimension::D2 => "2d",
        TextureDimension::D3 => "3d",
    };
    Structure::of("wgpu::TextureDescriptor")
        .of_wgpu("label", "None")
        .with("size", extent(texture.size))
        .with("mip_level_count", plain(texture.levels))
        .with("sample_count", plain(texture.samples))
        .with("dimension", of("TextureDimension", dimension))
        .with("format", format(texture.format))
        .with("usage", TEXTURE_USAGES.union(texture.usage))
        .with("view_formats", list(texture.view_format.map(format)))
        .end()
}

fn view(view: &TextureView) -> Code {
    let descriptor = Structure::of("wgpu::TextureViewDescriptor")
        .of_wgpu("label", "None")
        .optional("format", view.format.map(format));
    let range = match view.part {
        Some([level, layer]) => descriptor
            .optional("dimension", Some(of("TextureViewDimension", "2d")))
            .with("base_mip_level", plain(level))
            .optional("mip_level_count", Some(plain(1)))
            .with("base_array_layer", plain(layer))
            .optional("array_layer_count", Some(plain(1))),
        None => descriptor
            .optional("dimension", None)
            .of_wgpu("base_mip_level", "0")
            .optional("mip_level_count", None)
            .of_wgpu("base_array_layer", "0")
            .optional("array_layer_count", None),
    };
    range
        .of_wgpu("usage", "None")
        .with("aspect", aspect(view.aspect))
        .end()
}

fn shader(shader: &Shader) -> Code {
    let wgsl = source(&shader.code);
    let code = Code {
        rust: format!("wgpu::ShaderSource::Wgsl({}.into())", wgsl.rust),
        script: wgsl.script.map(|wgsl| format!("code: {wgsl}")),
    };
    Structure::of("wgpu::ShaderModuleDescriptor")
        .of_wgpu("label", "None")
        .in_place("source", code)
        .end()
}

fn group_layout(entries: &[LayoutEntry]) -> Code {
    const STAGES: Flags = Flags::of_fragment_stage();
    let entries = entries.iter().map(|entry| {
        Structure::of("wgpu::BindGroupLayoutEntry")
            .with("binding", plain(entry.binding))
            .with("visibility", STAGES.union(1))
            .in_place("ty", resource_type(entry.resource))
            .of_wgpu("count", "None")
            .end()
    });
    Structure::of("wgpu::BindGroupLayoutDescriptor")
        .of_wgpu("label", "None")
        .with("entries", list(entries))
        .end()
}

/// Returns the type of a resource; in a script, a member of its entry.
fn resource_type(resource: LayoutResource) -> Code {
    let buffer = |rust: &str, script: &str, dynamic: bool, size| {
        let ty = Code::new(
            format!("wgpu::BufferBindingType::{rust}"),
            format!("type: \"{script}\""),
        );
        let buffer = Structure::of("wgpu::BindingType::Buffer")
            .in_place("ty", ty)
            .with("has_dynamic_offset", plain(dynamic))
            .with("min_binding_size", buffer_size(size));
        ("buffer", buffer.end())
    };
    let (member, value) = match resource {
        LayoutResource::Uniform(size) => buffer("Uniform", "uniform", true, size),
        LayoutResource::Storage(size) => {
            buffer("Storage { read_only: false }", "storage", false, size)
        }
        LayoutResource::Texture {
            sample_type,
            multisampled,
        } => {
            let (rust, script) = match sample_type {
                SampleType::Float => ("Float { filterable: true }", "float"),
                SampleType::UnfilterableFloat => {
                    ("Float { filterable: false }", "unfilterable-float")
                }
                SampleType::Uint => ("Uint", "uint"),
            };
            let sample_type = Code::new(
                format!("wgpu::TextureSampleType::{rust}"),
                format!("\"{script}\""),
            );
            let texture = Structure::of("wgpu::BindingType::Texture")
                .with("sample_type", sample_type)
                .with("view_dimension", of("TextureViewDimension", "2d"))
                .with("multisampled", plain(multisampled));
            ("texture", texture.end())
        }
        LayoutResource::Sampler => {
            let kind = "wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)";
            ("sampler", Code::new(kind, "{ type: \"filtering\" }"))
        }
    };
    named(member, value)
}

fn buffer_size(size: u64) -> Code {
    Code::new(format!("wgpu::BufferSize::new({size})"), size.to_string())
}

fn pipeline_layout(group: Option<usize>) -> Code {
    let groups = group.map(|place| option(Some(object("bind_group_layout", place))));
    Structure::of("wgpu::PipelineLayoutDescriptor")
        .of_wgpu("label", "None")
        .with("bind_group_layouts", list(groups))
        .of_wgpu("immediate_size", "0")
        .end()
}

fn sampler(sampler: &Sampler) -> Code {
    let address = |axis: usize| of("AddressMode", sampler.address[axis].name());
    let filter = || of("FilterMode", sampler.filter.name());
    Structure::of("wgpu::SamplerDescriptor")
        .of_wgpu("label", "None")
        .with("address_mode_u", address(0))
        .with("address_mode_v", address(1))
        .of_wgpu("address_mode_w", "Default::default()")
        .with("mag_filter", filter())
        .with("min_filter", filter())
        .of_wgpu("mipmap_filter", "Default::default()")
        .of_wgpu("lod_min_clamp", "0.0")
        .of_wgpu("lod_max_clamp", "32.0")
        .of_wgpu("compare", "None")
        .of_wgpu("anisotropy_clamp", "1")
        .of_wgpu("border_color", "None")
        .end()
}

fn buffer(buffer: &Buffer) -> Code {
    Structure::of("wgpu::BufferDescriptor")
        .of_wgpu("label", "None")
        .with("size", plain(buffer.size))
        .with("usage", BUFFER_USAGES.union(buffer.usage))
        .of_wgpu("mapped_at_creation", "false")
        .end()
}

fn group(group: &BindGroup) -> Code {
    let entries = group.entries.iter().map(|(binding, resource)| {
        let resource = match *resource {
            Binding::View(view) => {
                let view = variable("view", view);
                Code::new(format!("wgpu::BindingResource::TextureView(&{view})"), view)
            }
            Binding::Sampler(sampler) => {
                let sampler = variable("sampler", sampler);
                Code::new(
                    format!("wgpu::BindingResource::Sampler(&{sampler})"),
                    sampler,
                )
            }
            Binding::Buffer {
                buffer,
                offset,
                size,
            } => {
                let part = Structure::of("wgpu::BufferBinding")
                    .with("buffer", object("buffer", buffer))
                    .with("offset", plain(offset))
                    .with("size", buffer_size(size))
                    .end();
                Code {
                    rust: format!("wgpu::BindingResource::Buffer({})", part.rust),
                    ..part
                }
            }
        };
        Structure::of("wgpu::BindGroupEntry")
            .with("binding", plain(*binding))
            .with("resource", resource)
            .end()
    });
    Structure::of("wgpu::BindGroupDescriptor")
        .of_wgpu("label", "None")
        .with("layout", object("bind_group_layout", group.layout))
        .with("entries", list(entries))
        .end()
}

fn query_set(set: &QuerySet) -> Code {
    let ty = match set.ty {
        QueryType::Occlusion => named("type", of("QueryType", "occlusion")),
        QueryType::FragmentInvocations => Code::of_wgpu(
            "wgpu::QueryType::PipelineStatistics(wgpu::PipelineStatisticsTypes::FRAGMENT_SHADER_INVOCATIONS)",
        ),
    };
    Structure::of("wgpu::QuerySetDescriptor")
        .of_wgpu("label", "None")
        .in_place("ty", ty)
        .with("count", plain(set.count))
        .end()
}

fn pipeline(pipeline: &RenderPipeline, layout: usize) -> Code {
    let state = &pipeline.state;
    let stage = |kind: &str, entry: &str| {
        Structure::of(kind)
            .with("module", object("shader", pipeline.shader))
            .optional("entry_point", Some(string(entry)))
            .of_wgpu("compilation_options", "Default::default()")
    };
    let buffers = list(state.buffers.iter().map(|b| option(Some(vertex_buffer(b)))));
    let fragment = state.fragment.as_ref().map(|entry| {
        let targets = state
            .targets
            .iter()
            .map(|t| option(t.as_ref().map(color_target)));
        let stage = stage("wgpu::FragmentState", entry);
        stage.with("targets", list(targets)).end()
    });
    let multisample = Structure::of("wgpu::MultisampleState")
        .with("count", plain(state.samples))
        .with("mask", plain(state.mask))
        .with("alpha_to_coverage_enabled", plain(state.alpha_to_coverage));
    Structure::of("wgpu::RenderPipelineDescriptor")
        .of_wgpu("label", "None")
        .with("layout", option(Some(object("pipeline_layout", layout))))
        .with(
            "vertex",
            stage("wgpu::VertexState", &state.vertex)
                .with("buffers", buffers)
                .end(),
        )
        .with("primitive", primitive(&state.primitive))
        .optional(
            "depth_stencil",
            state.depth_stencil.as_ref().map(depth_stencil),
        )
        .with("multisample", multisample.end())
        .optional("fragment", fragment)
        .of_wgpu("multiview_mask", "None")
        .of_wgpu("cache", "None")
        .end()
}

fn vertex_buffer(buffer: &VertexBuffer) -> Code {
    let attribute = |attribute: &VertexAttribute| {
        let format = format!("float32x{}", attribute.floats);
        let format = Code::new(
            format!("wgpu::VertexFormat::Float32x{}", attribute.floats),
            format!("\"{format}\""),
        );
        Structure::of("wgpu::VertexAttribute")
            .with("format", format)
            .with("offset", plain(attribute.offset))
            .with("shader_location", plain(attribute.location))
            .end()
    };
    let step = if buffer.per_instance {
        "instance"
    } else {
        "vertex"
    };
    Structure::of("wgpu::VertexBufferLayout")
        .with("array_stride", plain(buffer.stride))
        .with("step_mode", of("VertexStepMode", step))
        .with("attributes", list(buffer.attributes.iter().map(attribute)))
        .end()
}

fn primitive(primitive: &Primitive) -> Code {
    let topology = match primitive.topology {
        PrimitiveTopology::TriangleFan => PrimitiveTopology::TriangleList,
        topology => topology,
    };
    let culled = match primitive.cull {
        CullMode::Front | CullMode::Back => Some(of("Face", primitive.cull.name())),
        CullMode::None | CullMode::FrontAndBack => None,
    };
    let strip = primitive
        .strip_index
        .map(|index| of("IndexFormat", index.name()));
    Structure::of("wgpu::PrimitiveState")
        .with("topology", of("PrimitiveTopology", topology.name()))
        .optional("strip_index_format", strip)
        .with("front_face", of("FrontFace", primitive.front_face.name()))
        .optional("cull_mode", culled)
        .with("unclipped_depth", plain(primitive.unclipped_depth))
        .of_wgpu("polygon_mode", "wgpu::PolygonMode::Fill")
        .of_wgpu("conservative", "false")
        .end()
}

fn color_target(target: &PipelineTarget) -> Code {
    let component = |component: BlendComponent| {
        // A constant alpha is only used in the equation of alpha, where it equals the constant.
        let factor = |name: &'static str| {
            let name = match name {
                "constant-alpha" => "constant",
                "one-minus-constant-alpha" => "one-minus-constant",
                name => name,
            };
            of("BlendFactor", name)
        };
        Structure::of("wgpu::BlendComponent")
            .with("src_factor", factor(component.src_factor.name()))
            .with("dst_factor", factor(component.dst_factor.name()))
            .with(
                "operation",
                of("BlendOperation", component.operation.name()),
            )
            .end()
    };
    let blend = target.blend.map(|blend| {
        Structure::of("wgpu::BlendState")
            .with("color", component(blend.color))
            .with("alpha", component(blend.alpha))
            .end()
    });
    Structure::of("wgpu::ColorTargetState")
        .with("format", format(target.format))
        .optional("blend", blend)
        .with("write_mask", COLOR_WRITES.union(target.write_mask.into()))
        .end()
}

fn depth_stencil(state: &DepthStencil) -> Code {
    let stencil = match &state.stencil {
        None => Code::new("Default::default()", ""),
        Some(stencil) => Structure::of("wgpu::StencilState")
            .in_place("front", named("stencilFront", stencil_face(&stencil.front)))
            .in_place("back", named("stencilBack", stencil_face(&stencil.back)))
            .in_place(
                "read_mask",
                named("stencilReadMask", plain(stencil.front.read_mask)),
            )
            .in_place(
                "write_mask",
                named("stencilWriteMask", plain(stencil.front.write_mask)),
            )
            .end()
            .members(),
    };
    let bias = Structure::of("wgpu::DepthBiasState")
        .in_place("constant", named("depthBias", plain(state.bias.constant)))
        .in_place(
            "slope_scale",
            named("depthBiasSlopeScale", float(state.bias.slope())),
        )
        .in_place("clamp", named("depthBiasClamp", float(state.bias.clamp())));
    let compare = of("CompareFunction", state.depth_compare.name());
    Structure::of("wgpu::DepthStencilState")
        .with("format", format(state.format))
        .optional("depth_write_enabled", state.depth_write.map(plain))
        .optional("depth_compare", Some(compare))
        .in_place("stencil", stencil)
        .in_place("bias", bias.end().members())
        .end()
}

fn stencil_face(face: &StencilFace) -> Code {
    Structure::of("wgpu::StencilFaceState")
        .with("compare", of("CompareFunction", face.compare.name()))
        .with("fail_op", of("StencilOperation", face.fail_op.name()))
        .with(
            "depth_fail_op",
            of("StencilOperation", face.depth_fail_op.name()),
        )
        .with("pass_op", of("StencilOperation", face.pass_op.name()))
        .end()
}

/// Returns a value; in a script, a member with this name.
pub(super) fn named(name: &str, value: Code) -> Code {
    Code {
        script: value.script.map(|value| format!("{name}: {value}")),
        ..value
    }
}
