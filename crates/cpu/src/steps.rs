//! The steps of a draw that a planted bug may replace.
//!
//! The rasterizer is generic over [`Steps`]. [`Faithful`] takes every default, so that its calls
//! vanish; the planted bugs of [`crate::mutants`] override one step each.

use crate::sampling::sample;
use crate::span::LANES;
use crate::surface::Surface;
use etalon_case::scene::StencilFace;
use etalon_case::state::{BlendState, CompareFunction, Sampler, StencilOperation};
use etalon_frame::{ChannelEncoding, CounterKind};
use etalon_pipeline::{
    Arithmetic, BlendInput, Plain, blend, compare, stencil_passes, stencil_write,
};

pub(crate) type Real = [f32; LANES];
pub(crate) type Codes = [u32; LANES];
pub(crate) type Mask = [bool; LANES];

/// The way of a fragment through the stencil test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Path {
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
    pub(crate) fn operation(self, face: &StencilFace) -> StencilOperation {
        match self {
            Self::Fail => face.fail_op,
            Self::DepthFail => face.depth_fail_op,
            Self::Pass => face.pass_op,
        }
    }
}

/// What the tests said; a test that is off says yes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tests {
    pub(crate) covered: Mask,
    pub(crate) stencil: Mask,
    pub(crate) depth: Mask,
}

/// Where a span is written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Written {
    pub(crate) color: Mask,
    pub(crate) depth: Mask,
}

/// The replaceable steps, each with what the pipeline really does.
pub(crate) trait Steps {
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
    fn kept(&self, value: Real, limit: Real) -> Mask {
        std::array::from_fn(|i| value[i] >= limit[i])
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
}

/// The pipeline as it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Faithful;

impl Steps for Faithful {}
