//! This suite's words in wgpu's.

use etalon_case::scene::{StencilFace, StencilState};
use etalon_case::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, CompareFunction, CullMode, DepthState,
    FrontFace, PrimitiveTopology, StencilOperation,
};
use etalon_frame::TextureFormat;

pub(crate) fn texture(format: TextureFormat) -> wgpu::TextureFormat {
    match format {
        TextureFormat::Rgba8Unorm => wgpu::TextureFormat::Rgba8Unorm,
        TextureFormat::Rgba32Float => wgpu::TextureFormat::Rgba32Float,
        TextureFormat::Depth16Unorm => wgpu::TextureFormat::Depth16Unorm,
        TextureFormat::Depth24Plus => wgpu::TextureFormat::Depth24Plus,
        TextureFormat::Depth24PlusStencil8 => wgpu::TextureFormat::Depth24PlusStencil8,
        TextureFormat::Depth32Float => wgpu::TextureFormat::Depth32Float,
        TextureFormat::Depth32FloatStencil8 => wgpu::TextureFormat::Depth32FloatStencil8,
        TextureFormat::Stencil8 => wgpu::TextureFormat::Stencil8,
    }
}

/// A pipeline's depth and stencil state. A test that is off passes always and writes nothing.
pub(crate) fn depth_stencil(
    format: TextureFormat,
    depth: Option<DepthState>,
    stencil: Option<StencilState>,
) -> wgpu::DepthStencilState {
    let has_depth = format.has_depth();
    wgpu::DepthStencilState {
        format: texture(format),
        depth_write_enabled: has_depth.then(|| depth.is_some_and(|d| d.write)),
        depth_compare: Some(depth.map_or(wgpu::CompareFunction::Always, |d| compare(d.compare))),
        stencil: stencil.map(self::stencil).unwrap_or_default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

/// WebGPU has one pair of masks for both faces; `SeparateStencilMasks` is denied, so they agree.
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

/// `constant-alpha` arrives only in the alpha equation, where it is `constant`: for colour it needs
/// a feature that is denied.
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
    }
}

pub(crate) fn primitive(
    topology: PrimitiveTopology,
    front_face: FrontFace,
    cull: CullMode,
) -> wgpu::PrimitiveState {
    wgpu::PrimitiveState {
        topology: match topology {
            PrimitiveTopology::TriangleList => wgpu::PrimitiveTopology::TriangleList,
            PrimitiveTopology::TriangleStrip => wgpu::PrimitiveTopology::TriangleStrip,
        },
        front_face: match front_face {
            FrontFace::Ccw => wgpu::FrontFace::Ccw,
            FrontFace::Cw => wgpu::FrontFace::Cw,
        },
        cull_mode: match cull {
            // Both faces together need a feature that is denied.
            CullMode::None | CullMode::FrontAndBack => None,
            CullMode::Front => Some(wgpu::Face::Front),
            CullMode::Back => Some(wgpu::Face::Back),
        },
        ..wgpu::PrimitiveState::default()
    }
}

/// A value that WebGPU takes as a double and hands on as a float.
pub(crate) fn color(value: [f32; 4]) -> wgpu::Color {
    let [r, g, b, a] = value.map(f64::from);
    wgpu::Color { r, g, b, a }
}
