//! GL's values of the scene model's enumerations.

use etalon_scene::{
    AddressMode, AdvancedBlend, BlendComponent, BlendFactor, BlendOperation, BlendState,
    ColorTarget, CompareFunction, LogicOperation, PrimitiveTopology, StencilOperation,
};

pub(crate) fn topology(topology: PrimitiveTopology) -> u32 {
    match topology {
        PrimitiveTopology::PointList => glow::POINTS,
        PrimitiveTopology::LineList => glow::LINES,
        PrimitiveTopology::LineStrip => glow::LINE_STRIP,
        PrimitiveTopology::TriangleList => glow::TRIANGLES,
        PrimitiveTopology::TriangleFan => glow::TRIANGLE_FAN,
        PrimitiveTopology::TriangleStrip => glow::TRIANGLE_STRIP,
    }
}

pub(crate) fn address(mode: AddressMode) -> u32 {
    match mode {
        AddressMode::ClampToEdge => glow::CLAMP_TO_EDGE,
        AddressMode::Repeat => glow::REPEAT,
        AddressMode::MirrorRepeat => glow::MIRRORED_REPEAT,
    }
}

pub(crate) fn mask(target: &ColorTarget) -> [bool; 4] {
    [0, 1, 2, 3].map(|bit| target.write_mask & (1 << bit) != 0)
}

/// Operation, source factor and destination factor.
pub(crate) type Equation = (u32, u32, u32);

pub(crate) fn equations(blend: BlendState) -> (Equation, Equation) {
    let equation = |c: BlendComponent| {
        (
            blend_operation(c.operation),
            factor(c.src_factor),
            factor(c.dst_factor),
        )
    };
    (equation(blend.color), equation(blend.alpha))
}

pub(crate) fn compare(function: CompareFunction) -> u32 {
    match function {
        CompareFunction::Never => glow::NEVER,
        CompareFunction::Less => glow::LESS,
        CompareFunction::Equal => glow::EQUAL,
        CompareFunction::LessEqual => glow::LEQUAL,
        CompareFunction::Greater => glow::GREATER,
        CompareFunction::NotEqual => glow::NOTEQUAL,
        CompareFunction::GreaterEqual => glow::GEQUAL,
        CompareFunction::Always => glow::ALWAYS,
    }
}

pub(crate) fn operation(operation: StencilOperation) -> u32 {
    match operation {
        StencilOperation::Keep => glow::KEEP,
        StencilOperation::Zero => glow::ZERO,
        StencilOperation::Replace => glow::REPLACE,
        StencilOperation::Invert => glow::INVERT,
        StencilOperation::IncrementClamp => glow::INCR,
        StencilOperation::DecrementClamp => glow::DECR,
        StencilOperation::IncrementWrap => glow::INCR_WRAP,
        StencilOperation::DecrementWrap => glow::DECR_WRAP,
    }
}

pub(crate) fn factor(factor: BlendFactor) -> u32 {
    match factor {
        BlendFactor::Zero => glow::ZERO,
        BlendFactor::One => glow::ONE,
        BlendFactor::Src => glow::SRC_COLOR,
        BlendFactor::OneMinusSrc => glow::ONE_MINUS_SRC_COLOR,
        BlendFactor::SrcAlpha => glow::SRC_ALPHA,
        BlendFactor::OneMinusSrcAlpha => glow::ONE_MINUS_SRC_ALPHA,
        BlendFactor::Dst => glow::DST_COLOR,
        BlendFactor::OneMinusDst => glow::ONE_MINUS_DST_COLOR,
        BlendFactor::DstAlpha => glow::DST_ALPHA,
        BlendFactor::OneMinusDstAlpha => glow::ONE_MINUS_DST_ALPHA,
        BlendFactor::SrcAlphaSaturated => glow::SRC_ALPHA_SATURATE,
        BlendFactor::Constant => glow::CONSTANT_COLOR,
        BlendFactor::OneMinusConstant => glow::ONE_MINUS_CONSTANT_COLOR,
        BlendFactor::ConstantAlpha => glow::CONSTANT_ALPHA,
        BlendFactor::OneMinusConstantAlpha => glow::ONE_MINUS_CONSTANT_ALPHA,
        BlendFactor::Src1 => glow::SRC1_COLOR,
        BlendFactor::OneMinusSrc1 => glow::ONE_MINUS_SRC1_COLOR,
        BlendFactor::Src1Alpha => glow::SRC1_ALPHA,
        BlendFactor::OneMinusSrc1Alpha => glow::ONE_MINUS_SRC1_ALPHA,
    }
}

/// Returns the equation of an advanced blend mode (KHR_blend_equation_advanced, New Tokens).
pub(crate) fn advanced_equation(mode: AdvancedBlend) -> u32 {
    match mode {
        AdvancedBlend::Multiply => 0x9294,
        AdvancedBlend::Screen => 0x9295,
        AdvancedBlend::Overlay => 0x9296,
        AdvancedBlend::Darken => 0x9297,
        AdvancedBlend::Lighten => 0x9298,
        AdvancedBlend::ColorDodge => 0x9299,
        AdvancedBlend::ColorBurn => 0x929A,
        AdvancedBlend::HardLight => 0x929B,
        AdvancedBlend::SoftLight => 0x929C,
        AdvancedBlend::Difference => 0x929E,
        AdvancedBlend::Exclusion => 0x92A0,
    }
}

/// Returns the name of a mode in the layout qualifier that allows the mode (GLSL ES 3.20, 4.4.2.2).
pub(crate) fn blend_support(mode: AdvancedBlend) -> &'static str {
    match mode {
        AdvancedBlend::Multiply => "multiply",
        AdvancedBlend::Screen => "screen",
        AdvancedBlend::Overlay => "overlay",
        AdvancedBlend::Darken => "darken",
        AdvancedBlend::Lighten => "lighten",
        AdvancedBlend::ColorDodge => "colordodge",
        AdvancedBlend::ColorBurn => "colorburn",
        AdvancedBlend::HardLight => "hardlight",
        AdvancedBlend::SoftLight => "softlight",
        AdvancedBlend::Difference => "difference",
        AdvancedBlend::Exclusion => "exclusion",
    }
}

pub(crate) fn blend_operation(operation: BlendOperation) -> u32 {
    match operation {
        BlendOperation::Add => glow::FUNC_ADD,
        BlendOperation::Subtract => glow::FUNC_SUBTRACT,
        BlendOperation::ReverseSubtract => glow::FUNC_REVERSE_SUBTRACT,
        BlendOperation::Min => glow::MIN,
        BlendOperation::Max => glow::MAX,
    }
}

pub(crate) fn logic_operation(operation: LogicOperation) -> u32 {
    match operation {
        LogicOperation::Clear => glow::CLEAR,
        LogicOperation::And => glow::AND,
        LogicOperation::AndReverse => glow::AND_REVERSE,
        LogicOperation::Copy => glow::COPY,
        LogicOperation::AndInverted => glow::AND_INVERTED,
        LogicOperation::Noop => glow::NOOP,
        LogicOperation::Xor => glow::XOR,
        LogicOperation::Or => glow::OR,
        LogicOperation::Nor => glow::NOR,
        LogicOperation::Equivalent => glow::EQUIV,
        LogicOperation::Invert => glow::INVERT,
        LogicOperation::OrReverse => glow::OR_REVERSE,
        LogicOperation::CopyInverted => glow::COPY_INVERTED,
        LogicOperation::OrInverted => glow::OR_INVERTED,
        LogicOperation::Nand => glow::NAND,
        LogicOperation::Set => glow::SET,
    }
}
