//! Pipeline state in GL's words. All of it is set for every draw; there is no cache to go stale.

use crate::context::Context;
use etalon_backend::BackendError;
use etalon_case::scene::{ColorTarget, Draw, StencilFace, StencilState};
use etalon_case::state::{
    BlendFactor, BlendOperation, BlendState, CompareFunction, CullMode, DepthState, FrontFace,
    PrimitiveTopology, StencilOperation,
};
use glow::HasContext;

/// A draw's state, ready to be set.
#[derive(Clone, Debug)]
pub(crate) struct DrawState {
    cull: Option<u32>,
    front_face: u32,
    depth: Option<DepthState>,
    stencil: Option<StencilState>,
    targets: Vec<ColorTarget>,
    blend_constant: [f32; 4],
}

impl DrawState {
    /// Takes a draw's state, or says that the context cannot have it.
    pub(crate) fn new(context: &Context, draw: &Draw) -> Result<Self, BackendError> {
        let differ = draw.targets.windows(2).any(|pair| pair[0] != pair[1]);
        if differ && !context.caps.indexed_blend {
            return Err(BackendError::Resource {
                what: "blend state for each colour target".to_owned(),
                message: "the context lacks indexed blend functions".to_owned(),
            });
        }
        // Without clip control shaders mirror y, which turns every winding over.
        let ccw = (draw.front_face == FrontFace::Ccw) == context.caps.clip_control;
        Ok(Self {
            cull: match draw.cull {
                CullMode::None => None,
                CullMode::Front => Some(glow::FRONT),
                CullMode::Back => Some(glow::BACK),
                CullMode::FrontAndBack => Some(glow::FRONT_AND_BACK),
            },
            front_face: if ccw { glow::CCW } else { glow::CW },
            depth: draw.depth,
            stencil: draw.stencil,
            targets: if differ {
                draw.targets.clone()
            } else {
                draw.targets.iter().take(1).copied().collect()
            },
            blend_constant: draw.blend_constant,
        })
    }

    /// Sets the state.
    pub(crate) fn apply(&self, gl: &glow::Context) {
        // SAFETY: the context is current; the entry points are of version 3, and indexed blend
        // functions were asked for in `new`.
        unsafe {
            match self.cull {
                Some(face) => {
                    gl.enable(glow::CULL_FACE);
                    gl.cull_face(face);
                }
                None => gl.disable(glow::CULL_FACE),
            }
            gl.front_face(self.front_face);
            match self.depth {
                Some(depth) => {
                    gl.enable(glow::DEPTH_TEST);
                    gl.depth_func(compare(depth.compare));
                    gl.depth_mask(depth.write);
                }
                None => gl.disable(glow::DEPTH_TEST),
            }
            match self.stencil {
                Some(stencil) => {
                    gl.enable(glow::STENCIL_TEST);
                    stencil_face(gl, glow::FRONT, stencil.front);
                    stencil_face(gl, glow::BACK, stencil.back);
                }
                None => gl.disable(glow::STENCIL_TEST),
            }
            let [r, g, b, a] = self.blend_constant;
            gl.blend_color(r, g, b, a);
            if let [target] = self.targets.as_slice() {
                let [r, g, b, a] = mask(target);
                gl.color_mask(r, g, b, a);
                match target.blend {
                    Some(blend) => {
                        gl.enable(glow::BLEND);
                        let (color, alpha) = equations(blend);
                        gl.blend_equation_separate(color.0, alpha.0);
                        gl.blend_func_separate(color.1, color.2, alpha.1, alpha.2);
                    }
                    None => gl.disable(glow::BLEND),
                }
                return;
            }
            for (i, target) in (0..).zip(&self.targets) {
                let [r, g, b, a] = mask(target);
                gl.color_mask_draw_buffer(i, r, g, b, a);
                match target.blend {
                    Some(blend) => {
                        gl.enable_draw_buffer(glow::BLEND, i);
                        let (color, alpha) = equations(blend);
                        gl.blend_equation_separate_draw_buffer(i, color.0, alpha.0);
                        gl.blend_func_separate_draw_buffer(i, color.1, color.2, alpha.1, alpha.2);
                    }
                    None => gl.disable_draw_buffer(glow::BLEND, i),
                }
            }
        }
    }
}

fn stencil_face(gl: &glow::Context, face: u32, state: StencilFace) {
    // SAFETY: the context is current.
    unsafe {
        gl.stencil_func_separate(
            face,
            compare(state.compare),
            i32::from(state.reference),
            u32::from(state.read_mask),
        );
        gl.stencil_op_separate(
            face,
            operation(state.fail_op),
            operation(state.depth_fail_op),
            operation(state.pass_op),
        );
        gl.stencil_mask_separate(face, u32::from(state.write_mask));
    }
}

/// State that no scene changes, and an end to all that one did: clears and uploads after this do
/// what they say.
pub(crate) fn reset(context: &Context) {
    let gl = &context.gl;
    // SAFETY: the context is current; what only one profile knows is set in that one.
    unsafe {
        for capability in [
            glow::SCISSOR_TEST,
            glow::DITHER,
            glow::BLEND,
            glow::CULL_FACE,
            glow::DEPTH_TEST,
            glow::STENCIL_TEST,
            glow::POLYGON_OFFSET_FILL,
            glow::SAMPLE_ALPHA_TO_COVERAGE,
            glow::SAMPLE_COVERAGE,
            glow::RASTERIZER_DISCARD,
        ] {
            gl.disable(capability);
        }
        if !context.caps.es {
            for capability in [
                glow::FRAMEBUFFER_SRGB,
                glow::COLOR_LOGIC_OP,
                glow::DEPTH_CLAMP,
                glow::SAMPLE_ALPHA_TO_ONE,
                glow::PRIMITIVE_RESTART,
            ] {
                gl.disable(capability);
            }
            gl.enable(glow::MULTISAMPLE);
            gl.polygon_mode(glow::FRONT_AND_BACK, glow::FILL);
        }
        if !context.caps.es || context.caps.version >= (3, 1) {
            gl.disable(glow::SAMPLE_MASK);
        }
        gl.color_mask(true, true, true, true);
        gl.depth_mask(true);
        gl.stencil_mask(0xff);
        if context.caps.es {
            gl.depth_range_f32(0.0, 1.0);
        } else {
            gl.depth_range_f64(0.0, 1.0);
        }
        gl.pixel_store_i32(glow::PACK_ALIGNMENT, 1);
        gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
    }
    context.set_clip_control();
}

pub(crate) fn topology(topology: PrimitiveTopology) -> u32 {
    match topology {
        PrimitiveTopology::TriangleList => glow::TRIANGLES,
        PrimitiveTopology::TriangleStrip => glow::TRIANGLE_STRIP,
    }
}

fn mask(target: &ColorTarget) -> [bool; 4] {
    [0, 1, 2, 3].map(|bit| target.write_mask & (1 << bit) != 0)
}

type Equation = (u32, u32, u32);

fn equations(blend: BlendState) -> (Equation, Equation) {
    let one = |c: etalon_case::state::BlendComponent| {
        (
            blend_operation(c.operation),
            factor(c.src_factor),
            factor(c.dst_factor),
        )
    };
    (one(blend.color), one(blend.alpha))
}

fn compare(function: CompareFunction) -> u32 {
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

fn operation(operation: StencilOperation) -> u32 {
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

fn factor(factor: BlendFactor) -> u32 {
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
    }
}

fn blend_operation(operation: BlendOperation) -> u32 {
    match operation {
        BlendOperation::Add => glow::FUNC_ADD,
        BlendOperation::Subtract => glow::FUNC_SUBTRACT,
        BlendOperation::ReverseSubtract => glow::FUNC_REVERSE_SUBTRACT,
        BlendOperation::Min => glow::MIN,
        BlendOperation::Max => glow::MAX,
    }
}
