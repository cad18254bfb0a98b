//! wgpu's values of pipeline state.

use crate::format;
use etalon_backend::BackendError;
use etalon_scene::{
    AddressMode, BlendComponent, BlendFactor, BlendOperation, BlendState, CompareFunction,
    CullMode, FilterMode, FrontFace, IndexFormat, PrimitiveTopology, Sampler, StencilFace,
    StencilOperation, StencilState,
};
use etalon_webgpu::{
    DepthStencil, LayoutEntry, LayoutResource, PipelineTarget, Primitive, SampleType,
    TextureAspect, VertexAttribute,
};

/// Returns a pipeline's depth and stencil state.
pub(crate) fn depth_stencil(state: &DepthStencil) -> Result<wgpu::DepthStencilState, BackendError> {
    Ok(wgpu::DepthStencilState {
        format: format::known(state.format)?,
        depth_write_enabled: state.depth_write,
        depth_compare: Some(compare(state.depth_compare)),
        stencil: state.stencil.map(stencil).unwrap_or_default(),
        bias: wgpu::DepthBiasState {
            constant: state.bias.constant,
            slope_scale: state.bias.slope(),
            clamp: state.bias.clamp(),
        },
    })
}

/// Returns the stencil state. WebGPU has one pair of masks for both faces; `SeparateStencilMasks` is denied,
/// so both faces have the same masks.
fn stencil(state: StencilState) -> wgpu::StencilState {
    wgpu::StencilState {
        front: stencil_face(&state.front),
        back: stencil_face(&state.back),
        read_mask: state.front.read_mask.into(),
        write_mask: state.front.write_mask.into(),
    }
}

fn stencil_face(face: &StencilFace) -> wgpu::StencilFaceState {
    wgpu::StencilFaceState {
        compare: compare(face.compare),
        fail_op: stencil_operation(face.fail_op),
        depth_fail_op: stencil_operation(face.depth_fail_op),
        pass_op: stencil_operation(face.pass_op),
    }
}

fn compare(function: CompareFunction) -> wgpu::CompareFunction {
    match function {
        CompareFunction::Never => wgpu::CompareFunction::Never,
        CompareFunction::Less => wgpu::CompareFunction::Less,
        CompareFunction::Equal => wgpu::CompareFunction::Equal,
        CompareFunction::LessEqual => wgpu::CompareFunction::LessEqual,
        CompareFunction::Greater => wgpu::CompareFunction::Greater,
        CompareFunction::NotEqual => wgpu::CompareFunction::NotEqual,
        CompareFunction::GreaterEqual => wgpu::CompareFunction::GreaterEqual,
        CompareFunction::Always => wgpu::CompareFunction::Always,
    }
}

fn stencil_operation(operation: StencilOperation) -> wgpu::StencilOperation {
    match operation {
        StencilOperation::Keep => wgpu::StencilOperation::Keep,
        StencilOperation::Zero => wgpu::StencilOperation::Zero,
        StencilOperation::Replace => wgpu::StencilOperation::Replace,
        StencilOperation::Invert => wgpu::StencilOperation::Invert,
        StencilOperation::IncrementClamp => wgpu::StencilOperation::IncrementClamp,
        StencilOperation::DecrementClamp => wgpu::StencilOperation::DecrementClamp,
        StencilOperation::IncrementWrap => wgpu::StencilOperation::IncrementWrap,
        StencilOperation::DecrementWrap => wgpu::StencilOperation::DecrementWrap,
    }
}

fn blend(state: BlendState) -> wgpu::BlendState {
    wgpu::BlendState {
        color: blend_component(state.color),
        alpha: blend_component(state.alpha),
    }
}

fn blend_component(component: BlendComponent) -> wgpu::BlendComponent {
    wgpu::BlendComponent {
        src_factor: factor(component.src_factor),
        dst_factor: factor(component.dst_factor),
        operation: match component.operation {
            BlendOperation::Add => wgpu::BlendOperation::Add,
            BlendOperation::Subtract => wgpu::BlendOperation::Subtract,
            BlendOperation::ReverseSubtract => wgpu::BlendOperation::ReverseSubtract,
            BlendOperation::Min => wgpu::BlendOperation::Min,
            BlendOperation::Max => wgpu::BlendOperation::Max,
        },
    }
}

/// Returns a blend factor. Lists have `constant` instead of `constant-alpha`.
fn factor(factor: BlendFactor) -> wgpu::BlendFactor {
    match factor {
        BlendFactor::Zero => wgpu::BlendFactor::Zero,
        BlendFactor::One => wgpu::BlendFactor::One,
        BlendFactor::Src => wgpu::BlendFactor::Src,
        BlendFactor::OneMinusSrc => wgpu::BlendFactor::OneMinusSrc,
        BlendFactor::SrcAlpha => wgpu::BlendFactor::SrcAlpha,
        BlendFactor::OneMinusSrcAlpha => wgpu::BlendFactor::OneMinusSrcAlpha,
        BlendFactor::Dst => wgpu::BlendFactor::Dst,
        BlendFactor::OneMinusDst => wgpu::BlendFactor::OneMinusDst,
        BlendFactor::DstAlpha => wgpu::BlendFactor::DstAlpha,
        BlendFactor::OneMinusDstAlpha => wgpu::BlendFactor::OneMinusDstAlpha,
        BlendFactor::SrcAlphaSaturated => wgpu::BlendFactor::SrcAlphaSaturated,
        BlendFactor::Constant | BlendFactor::ConstantAlpha => wgpu::BlendFactor::Constant,
        BlendFactor::OneMinusConstant | BlendFactor::OneMinusConstantAlpha => {
            wgpu::BlendFactor::OneMinusConstant
        }
        BlendFactor::Src1 => wgpu::BlendFactor::Src1,
        BlendFactor::OneMinusSrc1 => wgpu::BlendFactor::OneMinusSrc1,
        BlendFactor::Src1Alpha => wgpu::BlendFactor::Src1Alpha,
        BlendFactor::OneMinusSrc1Alpha => wgpu::BlendFactor::OneMinusSrc1Alpha,
    }
}

/// Returns the type of an index.
pub(crate) fn index_format(index: IndexFormat) -> wgpu::IndexFormat {
    match index {
        IndexFormat::Uint16 => wgpu::IndexFormat::Uint16,
        IndexFormat::Uint32 => wgpu::IndexFormat::Uint32,
    }
}

pub(crate) fn primitive(primitive: Primitive) -> wgpu::PrimitiveState {
    wgpu::PrimitiveState {
        topology: match primitive.topology {
            PrimitiveTopology::PointList => wgpu::PrimitiveTopology::PointList,
            PrimitiveTopology::LineList => wgpu::PrimitiveTopology::LineList,
            PrimitiveTopology::LineStrip => wgpu::PrimitiveTopology::LineStrip,
            // Fans need a feature that is denied.
            PrimitiveTopology::TriangleList | PrimitiveTopology::TriangleFan => {
                wgpu::PrimitiveTopology::TriangleList
            }
            PrimitiveTopology::TriangleStrip => wgpu::PrimitiveTopology::TriangleStrip,
        },
        strip_index_format: primitive.strip_index.map(index_format),
        front_face: match primitive.front_face {
            FrontFace::Ccw => wgpu::FrontFace::Ccw,
            FrontFace::Cw => wgpu::FrontFace::Cw,
        },
        cull_mode: match primitive.cull {
            // Culling both faces needs a feature that is denied.
            CullMode::None | CullMode::FrontAndBack => None,
            CullMode::Front => Some(wgpu::Face::Front),
            CullMode::Back => Some(wgpu::Face::Back),
        },
        unclipped_depth: primitive.unclipped_depth,
        ..wgpu::PrimitiveState::default()
    }
}

/// Returns a colour attachment of a pipeline.
pub(crate) fn target(target: &PipelineTarget) -> Result<wgpu::ColorTargetState, BackendError> {
    Ok(wgpu::ColorTargetState {
        format: format::known(target.format)?,
        blend: target.blend.map(blend),
        // Bit 0 is red in both APIs.
        write_mask: wgpu::ColorWrites::from_bits_truncate(target.write_mask.into()),
    })
}

/// Returns an attribute of a vertex buffer.
pub(crate) fn attribute(attribute: &VertexAttribute) -> wgpu::VertexAttribute {
    wgpu::VertexAttribute {
        format: if attribute.floats == 2 {
            wgpu::VertexFormat::Float32x2
        } else {
            wgpu::VertexFormat::Float32x4
        },
        offset: attribute.offset,
        shader_location: attribute.location,
    }
}

/// Returns a binding of a layout.
pub(crate) fn layout_entry(entry: &LayoutEntry) -> wgpu::BindGroupLayoutEntry {
    let buffer = |ty, dynamic, bytes| wgpu::BindingType::Buffer {
        ty,
        has_dynamic_offset: dynamic,
        min_binding_size: wgpu::BufferSize::new(bytes),
    };
    wgpu::BindGroupLayoutEntry {
        binding: entry.binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: match entry.resource {
            LayoutResource::Uniform(bytes) => buffer(wgpu::BufferBindingType::Uniform, true, bytes),
            LayoutResource::Storage(bytes) => {
                let storage = wgpu::BufferBindingType::Storage { read_only: false };
                buffer(storage, false, bytes)
            }
            LayoutResource::Texture {
                sample_type,
                multisampled,
            } => wgpu::BindingType::Texture {
                sample_type: match sample_type {
                    SampleType::Float => wgpu::TextureSampleType::Float { filterable: true },
                    SampleType::UnfilterableFloat => {
                        wgpu::TextureSampleType::Float { filterable: false }
                    }
                    SampleType::Uint => wgpu::TextureSampleType::Uint,
                },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled,
            },
            LayoutResource::Sampler => {
                wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)
            }
        },
        count: None,
    }
}

/// Returns the aspects of a view or a copy.
pub(crate) fn aspect(aspect: TextureAspect) -> wgpu::TextureAspect {
    match aspect {
        TextureAspect::All => wgpu::TextureAspect::All,
        TextureAspect::DepthOnly => wgpu::TextureAspect::DepthOnly,
        TextureAspect::StencilOnly => wgpu::TextureAspect::StencilOnly,
    }
}

/// Returns a sampler of textures with one mip level.
pub(crate) fn sampler(sampler: Sampler) -> wgpu::SamplerDescriptor<'static> {
    let filter = match sampler.filter {
        FilterMode::Nearest => wgpu::FilterMode::Nearest,
        FilterMode::Linear => wgpu::FilterMode::Linear,
    };
    let [across, down] = sampler.address.map(|address| match address {
        AddressMode::ClampToEdge => wgpu::AddressMode::ClampToEdge,
        AddressMode::Repeat => wgpu::AddressMode::Repeat,
        AddressMode::MirrorRepeat => wgpu::AddressMode::MirrorRepeat,
    });
    wgpu::SamplerDescriptor {
        address_mode_u: across,
        address_mode_v: down,
        mag_filter: filter,
        min_filter: filter,
        ..wgpu::SamplerDescriptor::default()
    }
}

/// Returns a colour in WebGPU's doubles.
pub(crate) fn color(value: [f32; 4]) -> wgpu::Color {
    let [r, g, b, a] = value.map(f64::from);
    wgpu::Color { r, g, b, a }
}
