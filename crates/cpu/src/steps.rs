//! The steps of a draw that a planted bug may replace.
//!
//! The rasterizer is generic over [`Steps`]. [`Faithful`] takes every default, so that its calls
//! vanish; planted bugs, which are another crate, override one step each.

pub use crate::lanes::{Codes, LANES, Mask, Real};

use crate::sampling::sample;
use crate::surface::Surface;
use etalon_frame::{Aspect, ChannelEncoding, CounterKind};
use etalon_pipeline::shader::Kept;
use etalon_pipeline::{
    Arithmetic, BlendInput, Plain, blend, compare, stencil_passes, stencil_write,
};
use etalon_scene::{
    BlendState, CompareFunction, DepthBias, LogicOperation, Multisample, Sampler, Shader,
    StencilFace, StencilOperation,
};

/// The way of a fragment through the stencil test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// The stencil test fails.
    Fail,
    /// The stencil test passes and the depth test fails.
    DepthFail,
    /// Both pass.
    Pass,
}

impl Path {
    /// The face's operation on this way.
    #[inline(always)]
    pub fn operation(self, face: &StencilFace) -> StencilOperation {
        match self {
            Self::Fail => face.fail_op,
            Self::DepthFail => face.depth_fail_op,
            Self::Pass => face.pass_op,
        }
    }
}

/// What the tests said; a test that is off says yes.
#[derive(Clone, Copy, Debug)]
pub struct Tests {
    /// The covered texels.
    pub covered: Mask,
    /// The texels that pass the stencil test.
    pub stencil: Mask,
    /// The texels that pass the depth test and the depth bounds.
    pub depth: Mask,
}

/// Where a span is written.
#[derive(Clone, Copy, Debug)]
pub struct Written {
    /// The texels whose colour is written.
    pub color: Mask,
    /// The texels whose depth is written.
    pub depth: Mask,
}

/// The replaceable steps, each with what the pipeline really does.
pub trait Steps {
    /// The covered texels of a span that starts at column `x` of row `y`.
    #[inline(always)]
    fn covered(&self, _x: usize, _y: usize, _size: [u32; 2], mask: Mask) -> Mask {
        mask
    }

    /// The texels of a texture under a span.
    #[inline(always)]
    fn fetch(&self, surface: &Surface, x: usize, y: usize) -> [Real; 4] {
        let at = y * surface.stride + x;
        std::array::from_fn(|c| match surface.encodings.get(c) {
            Some(encoding) => {
                let plane = surface.plane(c, 0);
                Plain::<LANES>.decode(*encoding, std::array::from_fn(|i| plane[at + i]))
            }
            // A format without alpha is fetched with alpha 1.
            None => [if c == 3 { 1.0 } else { 0.0 }; LANES],
        })
    }

    /// What a sampler makes of a texture.
    #[inline(always)]
    fn sample(&self, surface: &Surface, sampler: Sampler, u: Real, v: Real) -> [Real; 4] {
        sample(surface, sampler, u, v)
    }

    /// Where a shader that may discard keeps its fragments.
    #[inline(always)]
    fn kept(&self, kept: &Kept<Real>) -> Mask {
        let (value, limit) = (kept.value, kept.limit);
        if kept.strict {
            std::array::from_fn(|i| value[i] > limit[i])
        } else {
            std::array::from_fn(|i| value[i] >= limit[i])
        }
    }

    /// What a counter adds for a span of samples that passed, or of texels whose shader ran.
    #[inline(always)]
    fn counted(&self, _kind: CounterKind, mask: Mask) -> u64 {
        mask.iter().map(|set| u64::from(*set)).sum()
    }

    /// Whether a stored value passes the stencil test.
    #[inline(always)]
    fn stencil_passes(&self, face: &StencilFace, stored: u8) -> bool {
        stencil_passes(face, stored)
    }

    /// The stencil value that a fragment leaves.
    #[inline(always)]
    fn stencil_write(&self, face: &StencilFace, path: Path, stored: u8) -> u8 {
        stencil_write(face, path.operation(face), stored)
    }

    /// Depths as they are compared and stored.
    #[inline(always)]
    fn depth_codes(&self, encoding: ChannelEncoding, depth: Real) -> Codes {
        // Codes of depths in 0..=1 are ordered as the depths are, floats among them. Adding 0 takes
        // the sign off a negative zero.
        Plain::<LANES>.encode(encoding, depth.map(|v| v.clamp(0.0, 1.0) + 0.0))
    }

    /// Whether an incoming depth passes; both are codes.
    #[inline(always)]
    fn depth_passes(&self, function: CompareFunction, incoming: u32, stored: u32) -> bool {
        compare(function, incoming, stored)
    }

    /// Where colour and depth are written.
    #[inline(always)]
    fn written(&self, tests: &Tests) -> Written {
        let all: Mask =
            std::array::from_fn(|i| tests.covered[i] & tests.stencil[i] & tests.depth[i]);
        Written {
            color: all,
            depth: all,
        }
    }

    /// Blends a span.
    #[inline(always)]
    fn blend(
        &self,
        state: &BlendState,
        encodings: [ChannelEncoding; 4],
        input: &BlendInput<Real>,
    ) -> [Real; 4] {
        blend(&mut Plain::<LANES>, state, encodings, input)
    }

    /// One colour channel as it is stored.
    #[inline(always)]
    fn color_codes(&self, encoding: ChannelEncoding, value: Real) -> Codes {
        Plain::<LANES>.encode(encoding, value)
    }

    /// One channel of a clear value, colour or depth.
    #[inline(always)]
    fn clear_code(&self, encoding: ChannelEncoding, value: f32) -> u32 {
        let [code] = Plain::<1>.encode(encoding, [value]);
        code
    }

    /// A stored colour as it enters a blend.
    #[inline(always)]
    fn color_value(&self, encoding: ChannelEncoding, codes: Codes) -> Real {
        Plain::<LANES>.decode(encoding, codes)
    }

    /// What a blend takes for the alpha of a format without one.
    #[inline(always)]
    fn missing_alpha(&self, _state: &BlendState) -> f32 {
        1.0
    }

    /// The second source, alpha to one applied.
    #[inline(always)]
    fn second_source(&self, multisample: &Multisample, mut second: [Real; 4]) -> [Real; 4] {
        if multisample.alpha_to_one {
            second[3] = [1.0; LANES];
        }
        second
    }

    /// What a logic operation leaves; `obeys` tells whether the attachment takes any.
    #[inline(always)]
    fn logic(
        &self,
        obeys: bool,
        encoding: ChannelEncoding,
        operation: LogicOperation,
        src: Codes,
        dst: Codes,
    ) -> Codes {
        if obeys {
            Plain::<LANES>.logic(encoding, operation, src, dst)
        } else {
            src
        }
    }

    /// The least step of a depth bias on a primitive whose largest depth is this.
    #[inline(always)]
    fn bias_unit(&self, encoding: ChannelEncoding, largest: f64) -> f64 {
        match encoding {
            ChannelEncoding::Unorm(bits) => 2_f64.powi(-i32::from(bits)),
            _ => {
                let largest = largest.max(f64::from(f32::MIN_POSITIVE));
                2_f64.powi(largest.log2().floor() as i32 - 23)
            }
        }
    }

    /// `constant * r + slope * m`, held to the clamp (Vulkan, Depth Bias; Direct3D 11.3, 15.10).
    #[inline(always)]
    fn bias(&self, state: &DepthBias, unit: f64, slope: f64) -> f64 {
        let sum = f64::from(state.constant) * unit + f64::from(state.slope) * slope;
        let clamp = f64::from(state.clamp);
        if clamp > 0.0 {
            sum.min(clamp)
        } else if clamp < 0.0 {
            sum.max(clamp)
        } else {
            sum
        }
    }

    /// Whether points and lines are biased as polygons are.
    #[inline(always)]
    fn biases_lines(&self) -> bool {
        false
    }

    /// Whether points and lines face front.
    #[inline(always)]
    fn lines_face_front(&self) -> bool {
        true
    }

    /// Holds a depth to the viewport's range.
    #[inline(always)]
    fn held_to_range(&self, depth: f32, [near, far]: [f32; 2]) -> f32 {
        depth.clamp(near.min(far), near.max(far))
    }

    /// Whether the depth bounds let a fragment through.
    #[inline(always)]
    fn in_bounds(&self, [low, high]: [f32; 2], stored: f32, _incoming: f32) -> bool {
        low <= stored && stored <= high
    }

    /// Whether fragments that the depth bounds reject count as failing the depth test.
    #[inline(always)]
    fn bounds_fail_as_depth(&self) -> bool {
        false
    }

    /// Where samples lie in a texel, in 1/256 of it.
    #[inline(always)]
    fn sample_positions(&self, standard: Vec<[u16; 2]>) -> Vec<[u16; 2]> {
        standard
    }

    /// Which texels' sample alpha to coverage draws: the first samples, as many as alpha's share.
    #[inline(always)]
    fn alpha_covers(&self, alpha: Real, sample: usize, samples: usize) -> Mask {
        let count = samples as f32;
        alpha.map(|a| (sample as f32) < (a.clamp(0.0, 1.0) * count).round())
    }

    /// Whether a shader runs once per sample.
    #[inline(always)]
    fn runs_per_sample(&self, shader: Shader) -> bool {
        shader.runs_per_sample()
    }

    /// Whose stored value a sample's test or blend sees.
    #[inline(always)]
    fn stored_sample(&self, _aspect: Aspect, sample: usize) -> usize {
        sample
    }

    /// At whose position, of so many samples, a sample's depth is taken.
    #[inline(always)]
    fn depth_sample(&self, sample: usize, _samples: usize) -> usize {
        sample
    }

    /// One channel of a resolved texel: the average of its samples, rounded to the nearest code.
    #[inline(always)]
    fn resolve(&self, encoding: ChannelEncoding, codes: &[u32]) -> u32 {
        let share = 1.0 / codes.len() as f32;
        let values = codes.iter().map(|c| Plain::<1>.decode(encoding, [*c])[0]);
        let sum: f32 = values.sum();
        Plain::<1>.encode(encoding, [sum * share])[0]
    }
}

/// The pipeline as it is.
#[derive(Clone, Copy, Debug)]
pub struct Faithful;

impl Steps for Faithful {}
