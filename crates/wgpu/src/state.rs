//! wgpu's values of pipeline state.

use crate::format;
use etalon_backend::BackendError;
use etalon_frame::TextureFormat;
use etalon_scene::{
    AddressMode, BlendComponent, BlendFactor, BlendOperation, BlendState, CompareFunction,
    CullMode, DepthBias, DepthState, FilterMode, FrontFace, IndexFormat, PolygonMode,
    PrimitiveTopology, Sampler, StencilFace, StencilOperation, StencilState,
};

/// Returns a pipeline's depth and stencil state. A disabled test always passes and writes nothing.
pub(crate) fn depth_stencil(
    format: TextureFormat,
    depth: Option<DepthState>,
    stencil: Option<StencilState>,
    bias: wgpu::DepthBiasState,
) -> Result<wgpu::DepthStencilState, BackendError> {
    let has_depth = format.has_depth();
    Ok(wgpu::DepthStencilState {
        format: format::known(format)?,
        depth_write_enabled: has_depth.then(|| depth.is_some_and(|d| d.write)),
        depth_compare: Some(depth.map_or(wgpu::CompareFunction::Always, |d| compare(d.compare))),
        stencil: stencil.map(self::stencil).unwrap_or_default(),
        bias,
    })
}

/// Only polygons have a bias, and WebGPU refuses it for other topologies (GPUDepthStencilState).
pub(crate) fn bias(bias: DepthBias, topology: PrimitiveTopology) -> wgpu::DepthBiasState {
    match topology {
        PrimitiveTopology::PointList
        | PrimitiveTopology::LineList
        | PrimitiveTopology::LineStrip => wgpu::DepthBiasState::default(),
        PrimitiveTopology::TriangleList
        | PrimitiveTopology::TriangleStrip
        | PrimitiveTopology::TriangleFan => wgpu::DepthBiasState {
            constant: bias.constant,
            slope_scale: bias.slope,
            clamp: bias.clamp,
        },
    }
}

/// WebGPU has one pair of masks for both faces; `SeparateStencilMasks` is denied, so they are
/// equal.
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

pub(crate) fn blend(state: BlendState) -> wgpu::BlendState {
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

/// `constant-alpha` occurs only in the alpha equation, where it equals `constant`: for colour it
/// needs a feature that is denied.
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

/// The primitive state of a draw.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Shape {
    pub(crate) topology: PrimitiveTopology,
    /// The size of the indices of an indexed strip.
    pub(crate) strip_indices: Option<IndexFormat>,
    pub(crate) front_face: FrontFace,
    pub(crate) cull: CullMode,
    pub(crate) polygon_mode: PolygonMode,
    pub(crate) depth_clamp: bool,
}

/// Returns the size of an index.
pub(crate) fn index_format(index: IndexFormat) -> wgpu::IndexFormat {
    match index {
        IndexFormat::Uint16 => wgpu::IndexFormat::Uint16,
        IndexFormat::Uint32 => wgpu::IndexFormat::Uint32,
    }
}

/// Returns true for a strip.
pub(crate) fn is_strip(topology: PrimitiveTopology) -> bool {
    matches!(
        topology,
        PrimitiveTopology::LineStrip | PrimitiveTopology::TriangleStrip
    )
}

pub(crate) fn primitive(shape: Shape) -> wgpu::PrimitiveState {
    wgpu::PrimitiveState {
        topology: match shape.topology {
            PrimitiveTopology::PointList => wgpu::PrimitiveTopology::PointList,
            PrimitiveTopology::LineList => wgpu::PrimitiveTopology::LineList,
            PrimitiveTopology::LineStrip => wgpu::PrimitiveTopology::LineStrip,
            // Fans need a feature that is denied.
            PrimitiveTopology::TriangleList | PrimitiveTopology::TriangleFan => {
                wgpu::PrimitiveTopology::TriangleList
            }
            PrimitiveTopology::TriangleStrip => wgpu::PrimitiveTopology::TriangleStrip,
        },
        strip_index_format: shape.strip_indices.map(index_format),
        front_face: match shape.front_face {
            FrontFace::Ccw => wgpu::FrontFace::Ccw,
            FrontFace::Cw => wgpu::FrontFace::Cw,
        },
        cull_mode: match shape.cull {
            // Both faces together need a feature that is denied.
            CullMode::None | CullMode::FrontAndBack => None,
            CullMode::Front => Some(wgpu::Face::Front),
            CullMode::Back => Some(wgpu::Face::Back),
        },
        unclipped_depth: shape.depth_clamp,
        polygon_mode: match shape.polygon_mode {
            PolygonMode::Fill => wgpu::PolygonMode::Fill,
            PolygonMode::Line => wgpu::PolygonMode::Line,
        },
        conservative: false,
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

/// Returns four values as WebGPU's doubles.
pub(crate) fn color(value: [f32; 4]) -> wgpu::Color {
    let [r, g, b, a] = value.map(f64::from);
    wgpu::Color { r, g, b, a }
}
