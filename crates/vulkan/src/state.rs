//! Vulkan's values of pipeline state.

use ash::vk;
use etalon_scene::{
    AdvancedBlend, BlendComponent, BlendFactor, BlendOperation, ColorTarget, CompareFunction,
    CullMode, FrontFace, LogicOperation, PolygonMode, PrimitiveTopology, ResolveMode,
    StencilOperation, Tessellation,
};

pub(crate) fn compare(function: CompareFunction) -> vk::CompareOp {
    match function {
        CompareFunction::Never => vk::CompareOp::NEVER,
        CompareFunction::Less => vk::CompareOp::LESS,
        CompareFunction::Equal => vk::CompareOp::EQUAL,
        CompareFunction::LessEqual => vk::CompareOp::LESS_OR_EQUAL,
        CompareFunction::Greater => vk::CompareOp::GREATER,
        CompareFunction::NotEqual => vk::CompareOp::NOT_EQUAL,
        CompareFunction::GreaterEqual => vk::CompareOp::GREATER_OR_EQUAL,
        CompareFunction::Always => vk::CompareOp::ALWAYS,
    }
}

pub(crate) fn stencil(operation: StencilOperation) -> vk::StencilOp {
    match operation {
        StencilOperation::Keep => vk::StencilOp::KEEP,
        StencilOperation::Zero => vk::StencilOp::ZERO,
        StencilOperation::Replace => vk::StencilOp::REPLACE,
        StencilOperation::Invert => vk::StencilOp::INVERT,
        StencilOperation::IncrementClamp => vk::StencilOp::INCREMENT_AND_CLAMP,
        StencilOperation::DecrementClamp => vk::StencilOp::DECREMENT_AND_CLAMP,
        StencilOperation::IncrementWrap => vk::StencilOp::INCREMENT_AND_WRAP,
        StencilOperation::DecrementWrap => vk::StencilOp::DECREMENT_AND_WRAP,
    }
}

pub(crate) fn blend_operation(operation: BlendOperation) -> vk::BlendOp {
    match operation {
        BlendOperation::Add => vk::BlendOp::ADD,
        BlendOperation::Subtract => vk::BlendOp::SUBTRACT,
        BlendOperation::ReverseSubtract => vk::BlendOp::REVERSE_SUBTRACT,
        BlendOperation::Min => vk::BlendOp::MIN,
        BlendOperation::Max => vk::BlendOp::MAX,
    }
}

/// Returns the blend factor. In the alpha equation, Vulkan's colour factors use the alpha of their operand
/// (Blend Factors), as WebGPU's do, so one table serves both equations.
pub(crate) fn blend_factor(factor: BlendFactor) -> vk::BlendFactor {
    match factor {
        BlendFactor::Zero => vk::BlendFactor::ZERO,
        BlendFactor::One => vk::BlendFactor::ONE,
        BlendFactor::Src => vk::BlendFactor::SRC_COLOR,
        BlendFactor::OneMinusSrc => vk::BlendFactor::ONE_MINUS_SRC_COLOR,
        BlendFactor::SrcAlpha => vk::BlendFactor::SRC_ALPHA,
        BlendFactor::OneMinusSrcAlpha => vk::BlendFactor::ONE_MINUS_SRC_ALPHA,
        BlendFactor::Dst => vk::BlendFactor::DST_COLOR,
        BlendFactor::OneMinusDst => vk::BlendFactor::ONE_MINUS_DST_COLOR,
        BlendFactor::DstAlpha => vk::BlendFactor::DST_ALPHA,
        BlendFactor::OneMinusDstAlpha => vk::BlendFactor::ONE_MINUS_DST_ALPHA,
        BlendFactor::SrcAlphaSaturated => vk::BlendFactor::SRC_ALPHA_SATURATE,
        BlendFactor::Constant => vk::BlendFactor::CONSTANT_COLOR,
        BlendFactor::OneMinusConstant => vk::BlendFactor::ONE_MINUS_CONSTANT_COLOR,
        BlendFactor::ConstantAlpha => vk::BlendFactor::CONSTANT_ALPHA,
        BlendFactor::OneMinusConstantAlpha => vk::BlendFactor::ONE_MINUS_CONSTANT_ALPHA,
        BlendFactor::Src1 => vk::BlendFactor::SRC1_COLOR,
        BlendFactor::OneMinusSrc1 => vk::BlendFactor::ONE_MINUS_SRC1_COLOR,
        BlendFactor::Src1Alpha => vk::BlendFactor::SRC1_ALPHA,
        BlendFactor::OneMinusSrc1Alpha => vk::BlendFactor::ONE_MINUS_SRC1_ALPHA,
    }
}

pub(crate) fn logic(operation: LogicOperation) -> vk::LogicOp {
    match operation {
        LogicOperation::Clear => vk::LogicOp::CLEAR,
        LogicOperation::And => vk::LogicOp::AND,
        LogicOperation::AndReverse => vk::LogicOp::AND_REVERSE,
        LogicOperation::Copy => vk::LogicOp::COPY,
        LogicOperation::AndInverted => vk::LogicOp::AND_INVERTED,
        LogicOperation::Noop => vk::LogicOp::NO_OP,
        LogicOperation::Xor => vk::LogicOp::XOR,
        LogicOperation::Or => vk::LogicOp::OR,
        LogicOperation::Nor => vk::LogicOp::NOR,
        LogicOperation::Equivalent => vk::LogicOp::EQUIVALENT,
        LogicOperation::Invert => vk::LogicOp::INVERT,
        LogicOperation::OrReverse => vk::LogicOp::OR_REVERSE,
        LogicOperation::CopyInverted => vk::LogicOp::COPY_INVERTED,
        LogicOperation::OrInverted => vk::LogicOp::OR_INVERTED,
        LogicOperation::Nand => vk::LogicOp::NAND,
        LogicOperation::Set => vk::LogicOp::SET,
    }
}

pub(crate) fn polygon_mode(mode: PolygonMode) -> vk::PolygonMode {
    match mode {
        PolygonMode::Fill => vk::PolygonMode::FILL,
        PolygonMode::Line => vk::PolygonMode::LINE,
    }
}

pub(crate) fn cull(mode: CullMode) -> vk::CullModeFlags {
    match mode {
        CullMode::None => vk::CullModeFlags::NONE,
        CullMode::Front => vk::CullModeFlags::FRONT,
        CullMode::Back => vk::CullModeFlags::BACK,
        CullMode::FrontAndBack => vk::CullModeFlags::FRONT_AND_BACK,
    }
}

pub(crate) fn front_face(face: FrontFace) -> vk::FrontFace {
    match face {
        FrontFace::Ccw => vk::FrontFace::COUNTER_CLOCKWISE,
        FrontFace::Cw => vk::FrontFace::CLOCKWISE,
    }
}

/// Returns the topology. A tessellated triangle list is a list of patches.
pub(crate) fn topology(
    topology: PrimitiveTopology,
    tessellation: Option<Tessellation>,
) -> vk::PrimitiveTopology {
    match topology {
        _ if tessellation.is_some() => vk::PrimitiveTopology::PATCH_LIST,
        PrimitiveTopology::PointList => vk::PrimitiveTopology::POINT_LIST,
        PrimitiveTopology::LineList => vk::PrimitiveTopology::LINE_LIST,
        PrimitiveTopology::LineStrip => vk::PrimitiveTopology::LINE_STRIP,
        PrimitiveTopology::TriangleList => vk::PrimitiveTopology::TRIANGLE_LIST,
        PrimitiveTopology::TriangleStrip => vk::PrimitiveTopology::TRIANGLE_STRIP,
        PrimitiveTopology::TriangleFan => vk::PrimitiveTopology::TRIANGLE_FAN,
    }
}

/// Returns the write mask. Bit 0 is red in both.
pub(crate) fn write_mask(mask: u8) -> vk::ColorComponentFlags {
    vk::ColorComponentFlags::from_raw(u32::from(mask & 0xf))
}

/// Returns the flag of a sample count up to 64, which is the count itself.
pub(crate) fn samples(count: u32) -> vk::SampleCountFlags {
    vk::SampleCountFlags::from_raw(count)
}

/// Returns Vulkan's resolve mode.
pub(crate) fn resolve_mode(mode: ResolveMode) -> vk::ResolveModeFlags {
    match mode {
        ResolveMode::None => vk::ResolveModeFlags::NONE,
        ResolveMode::SampleZero => vk::ResolveModeFlags::SAMPLE_ZERO,
        ResolveMode::Average => vk::ResolveModeFlags::AVERAGE,
        ResolveMode::Min => vk::ResolveModeFlags::MIN,
        ResolveMode::Max => vk::ResolveModeFlags::MAX,
    }
}

/// Returns Vulkan's operation of an advanced blend mode.
fn advanced_operation(mode: AdvancedBlend) -> vk::BlendOp {
    match mode {
        AdvancedBlend::Multiply => vk::BlendOp::MULTIPLY_EXT,
        AdvancedBlend::Screen => vk::BlendOp::SCREEN_EXT,
        AdvancedBlend::Overlay => vk::BlendOp::OVERLAY_EXT,
        AdvancedBlend::Darken => vk::BlendOp::DARKEN_EXT,
        AdvancedBlend::Lighten => vk::BlendOp::LIGHTEN_EXT,
        AdvancedBlend::ColorDodge => vk::BlendOp::COLORDODGE_EXT,
        AdvancedBlend::ColorBurn => vk::BlendOp::COLORBURN_EXT,
        AdvancedBlend::HardLight => vk::BlendOp::HARDLIGHT_EXT,
        AdvancedBlend::SoftLight => vk::BlendOp::SOFTLIGHT_EXT,
        AdvancedBlend::Difference => vk::BlendOp::DIFFERENCE_EXT,
        AdvancedBlend::Exclusion => vk::BlendOp::EXCLUSION_EXT,
    }
}

/// Returns the blend state of a colour attachment. Without a structure that says otherwise, an advanced
/// operation takes premultiplied colours with uncorrelated coverage, as OpenGL's does.
pub(crate) fn color_target(target: &ColorTarget) -> vk::PipelineColorBlendAttachmentState {
    let mut native = vk::PipelineColorBlendAttachmentState::default()
        .color_write_mask(write_mask(target.write_mask));
    if let Some(blend) = target.blend {
        let parts = |c: BlendComponent| {
            (
                blend_factor(c.src_factor),
                blend_factor(c.dst_factor),
                blend_operation(c.operation),
            )
        };
        let (src, dst, operation) = parts(blend.color);
        let (src_alpha, dst_alpha, alpha_operation) = parts(blend.alpha);
        native = native
            .blend_enable(true)
            .src_color_blend_factor(src)
            .dst_color_blend_factor(dst)
            .color_blend_op(operation)
            .src_alpha_blend_factor(src_alpha)
            .dst_alpha_blend_factor(dst_alpha)
            .alpha_blend_op(alpha_operation);
    }
    if let Some(mode) = target.advanced {
        let operation = advanced_operation(mode);
        native = native
            .blend_enable(true)
            .color_blend_op(operation)
            .alpha_blend_op(operation);
    }
    native
}
