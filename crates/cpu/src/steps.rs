//! The steps of a draw, which planted bugs override.
//!
//! The rasterizer is generic over [`Steps`], so that the calls of [`Faithful`], which keeps every default,
//! are inlined. Each planted bug, in another crate, overrides one step.

pub use crate::lanes::{LANES, LaneCodes, Mask, Real};

use crate::linear::UNITS;
use crate::sampling::sample;
use crate::surface::CpuSurface;
use etalon_frame::{Aspect, ChannelEncoding, CounterKind};
use etalon_pipeline::shader::{KeepCondition, SampleMask};
use etalon_pipeline::{
    Arithmetic, BlendInput, Plain, Point, advanced_blend, blend, compare, exported_reference,
    is_top_left, slope, stencil_passes, stencil_write,
};
use etalon_scene::{
    AdvancedBlend, BlendState, Clear, CompareFunction, DepthBias, Interpolation,
    InterpolationSampling, LogicOperation, Multisample, ResolveMode, Sampler, Scene, Shader,
    StencilFace, StencilOperation,
};

/// The outcome of a fragment's stencil and depth test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TestOutcome {
    /// The stencil test fails.
    Fail,
    /// The stencil test passes and the depth test fails.
    DepthFail,
    /// Both tests pass.
    Pass,
}

impl TestOutcome {
    /// Returns the face's operation for this outcome.
    #[inline(always)]
    pub fn operation(self, face: &StencilFace) -> StencilOperation {
        match self {
            Self::Fail => face.fail_op,
            Self::DepthFail => face.depth_fail_op,
            Self::Pass => face.pass_op,
        }
    }
}

/// A use of the stencil reference that a shader wrote.
#[derive(Clone, Copy, Debug)]
pub struct ExportedReference {
    /// The state of the fragment's face, with the draw's reference.
    pub face: StencilFace,
    /// True if that face is the front.
    pub front: bool,
    /// The outcome of the tests, for the update; `None` for the stencil test.
    pub outcome: Option<TestOutcome>,
    /// The references that the shader wrote, one per texel.
    pub written: [i32; LANES],
    /// The amount that the shader added to the references for the sample.
    pub plus: i32,
    /// The index of the texel.
    pub lane: usize,
    /// The sample.
    pub sample: usize,
}

/// A bit of the sample mask that a shader reads.
#[derive(Clone, Copy, Debug)]
pub struct InputBit {
    /// The number of the bit.
    pub bit: usize,
    /// The first covered sample of the run.
    pub sample: usize,
    /// The number of samples.
    pub samples: usize,
    /// True if the primitive covers the bit's sample.
    pub covered: bool,
    /// True if the sample mask and sample coverage include the bit's sample.
    pub drawn: bool,
    /// True if the run shades the bit's sample.
    pub shaded: bool,
}

/// The depths that a depth test compares.
#[derive(Clone, Copy, Debug)]
pub struct ComparedDepths {
    /// The encoding of the attachment.
    pub encoding: ChannelEncoding,
    /// The incoming depth, before its conversion.
    pub depth: f32,
    /// The code of the incoming depth.
    pub incoming: u32,
    /// The stored code.
    pub stored: u32,
    /// True if the shader wrote the incoming depth.
    pub written: bool,
}

/// The results of a span's tests. A disabled test passes.
#[derive(Clone, Copy, Debug)]
pub struct Tests {
    /// The covered texels.
    pub covered: Mask,
    /// The texels that pass the stencil test.
    pub stencil: Mask,
    /// The texels that pass the depth test and the depth bounds.
    pub depth: Mask,
}

/// The texels that a span writes.
#[derive(Clone, Copy, Debug)]
pub struct WrittenTexels {
    /// The texels whose colour is written.
    pub color: Mask,
    /// The texels whose depth is written.
    pub depth: Mask,
}

/// A moment of a submission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moment {
    /// The attachments have their initial contents.
    Initial,
    /// A pass begins.
    Begin {
        /// The index of the pass.
        pass: usize,
    },
    /// The load operations of a pass are done.
    Loaded {
        /// The index of the pass.
        pass: usize,
    },
    /// A clear command is done.
    Cleared {
        /// The index of the pass.
        pass: usize,
        /// The clear command.
        clear: Clear,
    },
    /// A draw follows.
    Draw {
        /// The index of the pass.
        pass: usize,
        /// The index of the draw.
        draw: usize,
    },
    /// A draw is done.
    Drawn {
        /// The index of the pass.
        pass: usize,
        /// The index of the draw.
        draw: usize,
    },
    /// A pass has ended, and its attachments are resolved.
    End {
        /// The index of the pass.
        pass: usize,
    },
}

/// The data that a submission has stored so far: the attachments, and the counters with their kinds.
#[derive(Debug)]
pub struct Stored<'a> {
    /// The attachments, in the scene's order.
    pub surfaces: &'a mut [CpuSurface],
    /// The counters, in the scene's order.
    pub counters: &'a mut [(CounterKind, u64)],
}

/// The steps that a planted bug can override. The defaults are the pipeline's.
pub trait Steps {
    /// Does nothing. A planted memory bug overrides this to change what is stored.
    #[inline(always)]
    fn reached(&self, _moment: Moment, _scene: &Scene, _stored: Stored<'_>) {}

    /// Returns the covered texels of a span that starts at column `x` of row `y`.
    #[inline(always)]
    fn covered(&self, _x: usize, _y: usize, _size: [u32; 2], mask: Mask) -> Mask {
        mask
    }

    /// Returns the texels of a texture at a span.
    #[inline(always)]
    fn fetch(&self, surface: &CpuSurface, x: usize, y: usize) -> [Real; 4] {
        self.fetch_own(surface, x, y, 0)
    }

    /// Returns the texels of an attachment of the pass at a sample of a span. Depth is red.
    #[inline(always)]
    fn fetch_own(&self, surface: &CpuSurface, x: usize, y: usize, sample: usize) -> [Real; 4] {
        let offset = y * surface.stride + x;
        let encodings = surface
            .depth
            .as_ref()
            .map_or(surface.encodings, std::slice::from_ref);
        std::array::from_fn(|c| match encodings.get(c) {
            Some(encoding) => {
                let plane = surface.plane(c, sample);
                Plain::<LANES>.decode(*encoding, std::array::from_fn(|i| plane[offset + i]))
            }
            // A format without alpha is fetched with alpha 1.
            None => [if c == 3 { 1.0 } else { 0.0 }; LANES],
        })
    }

    /// Returns the sampled values of a texture.
    #[inline(always)]
    fn sample(&self, surface: &CpuSurface, sampler: Sampler, u: Real, v: Real) -> [Real; 4] {
        sample(surface, sampler, u, v)
    }

    /// Returns the texels whose fragments the shader does not discard.
    #[inline(always)]
    fn kept(&self, kept: &KeepCondition<Real>) -> Mask {
        let (value, limit) = (kept.value, kept.limit);
        if kept.strict {
            std::array::from_fn(|i| value[i] > limit[i])
        } else {
            std::array::from_fn(|i| value[i] >= limit[i])
        }
    }

    /// Returns the texels for which the mask that a shader writes keeps the sample. With one sample, bit 0
    /// counts.
    #[inline(always)]
    fn mask_keeps(&self, mask: &SampleMask<Real>, sample: usize, _samples: usize) -> Mask {
        mask.bits
            .map(|bits| mask.written(bits as u32) & (1 << sample) != 0)
    }

    /// Returns the increment of a counter for a span: the number of samples that passed, or of texels whose
    /// shader ran.
    #[inline(always)]
    fn counted(&self, _kind: CounterKind, mask: Mask) -> u64 {
        mask.iter().map(|set| u64::from(*set)).sum()
    }

    /// Returns the stencil reference of a fragment whose shader writes one.
    #[inline(always)]
    fn exported(&self, fragment: &ExportedReference) -> u8 {
        exported_reference(fragment.written[fragment.lane])
    }

    /// Returns true if a stored value passes the stencil test.
    #[inline(always)]
    fn stencil_passes(&self, face: &StencilFace, stored: u8) -> bool {
        stencil_passes(face, stored)
    }

    /// Returns the stencil value that a fragment leaves.
    #[inline(always)]
    fn stencil_write(&self, face: &StencilFace, outcome: TestOutcome, stored: u8) -> u8 {
        stencil_write(face, outcome.operation(face), stored)
    }

    /// Returns the codes of depths, for comparing and storing.
    #[inline(always)]
    fn depth_codes(&self, encoding: ChannelEncoding, depth: Real) -> LaneCodes {
        // For depths in 0..=1, codes have the order of the depths, also for floats. Adding 0 removes the sign
        // of a negative zero.
        Plain::<LANES>.encode(encoding, depth.map(|v| v.clamp(0.0, 1.0) + 0.0))
    }

    /// Returns true if an incoming depth passes.
    #[inline(always)]
    fn depth_passes(&self, function: CompareFunction, depths: &ComparedDepths) -> bool {
        compare(function, depths.incoming, depths.stored)
    }

    /// Returns the texels whose colour is written, and the texels whose depth is written.
    #[inline(always)]
    fn written(&self, tests: &Tests) -> WrittenTexels {
        let passing: Mask =
            std::array::from_fn(|i| tests.covered[i] & tests.stencil[i] & tests.depth[i]);
        WrittenTexels {
            color: passing,
            depth: passing,
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

    /// Returns the codes to store in one colour channel.
    #[inline(always)]
    fn color_codes(&self, encoding: ChannelEncoding, value: Real) -> LaneCodes {
        Plain::<LANES>.encode(encoding, value)
    }

    /// Returns the code to store in one channel, colour or depth, for a clear value.
    #[inline(always)]
    fn clear_code(&self, encoding: ChannelEncoding, value: f32) -> u32 {
        let [code] = Plain::<1>.encode(encoding, [value]);
        code
    }

    /// Returns the values of one stored colour channel for blending.
    #[inline(always)]
    fn color_value(&self, encoding: ChannelEncoding, codes: LaneCodes) -> Real {
        Plain::<LANES>.decode(encoding, codes)
    }

    /// Blends colours by an advanced mode.
    #[inline(always)]
    fn advanced_blend(
        &self,
        mode: AdvancedBlend,
        encodings: [ChannelEncoding; 4],
        src: [Real; 4],
        dst: [Real; 4],
    ) -> [Real; 4] {
        advanced_blend(&mut Plain::<LANES>, mode, encodings, src, dst)
    }

    /// Returns the alpha of a format without alpha, for blending.
    #[inline(always)]
    fn missing_alpha(&self, _state: &BlendState) -> f32 {
        1.0
    }

    /// Returns the second source after alpha-to-one.
    #[inline(always)]
    fn second_source(&self, multisample: &Multisample, mut second: [Real; 4]) -> [Real; 4] {
        if multisample.alpha_to_one {
            second[3] = [1.0; LANES];
        }
        second
    }

    /// Returns the codes after a logic operation. `obeys` is false for attachments that ignore it.
    #[inline(always)]
    fn logic(
        &self,
        obeys: bool,
        encoding: ChannelEncoding,
        operation: LogicOperation,
        src: LaneCodes,
        dst: LaneCodes,
    ) -> LaneCodes {
        if obeys {
            Plain::<LANES>.logic(encoding, operation, src, dst)
        } else {
            src
        }
    }

    /// Returns the unit of the constant depth bias for a primitive with this greatest depth.
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

    /// Returns the slope of a polygon whose depth grows by this much per texel.
    #[inline(always)]
    fn slope(&self, dx: f64, dy: f64) -> f64 {
        slope(dx, dy).0
    }

    /// Returns a window coordinate, in texels, on the grid of vertices, in its units.
    #[inline(always)]
    fn snap(&self, coordinate: f32) -> i64 {
        (coordinate * UNITS as f32 + 0.5).floor() as i64
    }

    /// Returns the depth of a vertex in the window, given that depth, the depth before the viewport, and the
    /// viewport's range.
    #[inline(always)]
    fn window_depth(&self, depth: f32, _clip_depth: f32, _range: [f32; 2]) -> f32 {
        depth
    }

    /// Returns true if samples on an edge belong to the triangle clockwise of it.
    #[inline(always)]
    fn owns_edge(&self, from: Point, to: Point) -> bool {
        is_top_left(from, to)
    }

    /// Returns true if forced early tests precede the sample mask.
    #[inline(always)]
    fn tests_before_mask(&self) -> bool {
        false
    }

    /// Returns true if a fragment counts all its samples if one passes.
    #[inline(always)]
    fn counts_all_samples(&self) -> bool {
        false
    }

    /// Returns `constant * r + slope * m`, clamped (Vulkan, Depth Bias; Direct3D 11.3, 15.10).
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

    /// Returns true if points and lines are biased like polygons.
    #[inline(always)]
    fn biases_lines(&self) -> bool {
        false
    }

    /// Returns true if points and lines are front-facing.
    #[inline(always)]
    fn lines_face_front(&self) -> bool {
        true
    }

    /// Clamps a depth to the viewport's range, whether or not the draw clamps depths.
    #[inline(always)]
    fn held_to_range(&self, depth: f32, [near, far]: [f32; 2], _clamps: bool) -> f32 {
        depth.clamp(near.min(far), near.max(far))
    }

    /// Returns true if a fragment passes the depth bounds test.
    #[inline(always)]
    fn in_bounds(&self, [low, high]: [f32; 2], stored: f32, _incoming: f32) -> bool {
        low <= stored && stored <= high
    }

    /// Returns true if failing the depth bounds counts as failing the depth test.
    #[inline(always)]
    fn bounds_fail_as_depth(&self) -> bool {
        false
    }

    /// Returns the positions at which the coverage of samples is tested, in 1/256 texel, given those of shading.
    #[inline(always)]
    fn coverage_positions(&self, shading: Vec<[u16; 2]>) -> Vec<[u16; 2]> {
        shading
    }

    /// Returns the sample positions in 1/256 texel.
    #[inline(always)]
    fn sample_positions(&self, standard: Vec<[u16; 2]>) -> Vec<[u16; 2]> {
        standard
    }

    /// Returns the texels for which alpha-to-coverage covers the sample. It covers the first samples, in
    /// proportion to alpha.
    #[inline(always)]
    fn alpha_covers(&self, alpha: Real, sample: usize, samples: usize) -> Mask {
        let count = samples as f32;
        alpha.map(|a| (sample as f32) < (a.clamp(0.0, 1.0) * count).round())
    }

    /// Returns true if the sample mask and sample coverage include a sample. The coverage includes the first
    /// samples, in proportion to its value, or, if inverted, the others.
    #[inline(always)]
    fn sample_drawn(&self, state: &Multisample, sample: usize, samples: usize) -> bool {
        let covered = match state.sample_coverage {
            Some(share) if samples > 1 => {
                let count = (share.value.clamp(0.0, 1.0) * samples as f32).round();
                ((sample as f32) < count) != share.invert
            }
            _ => true,
        };
        covered && state.mask & (1 << sample) != 0
    }

    /// Returns true if a bit of the sample mask that a shader reads is set.
    #[inline(always)]
    fn input_bit(&self, bit: &InputBit) -> bool {
        bit.covered && bit.drawn && bit.shaded
    }

    /// Returns the number of shader runs that share a texel's samples. The samples of a run are consecutive.
    #[inline(always)]
    fn shader_runs(&self, shader: Shader, state: &Multisample, samples: usize) -> usize {
        if shader.runs_per_sample() {
            samples
        } else {
            state.least_runs(samples as u32) as usize
        }
    }

    /// Returns the sample at which a shader run takes its inputs, given the run's first covered sample.
    /// `None` for the texel's centre.
    #[inline(always)]
    fn shaded_at(&self, state: &Multisample, first: usize, _samples: usize) -> Option<usize> {
        state.min_sample_shading.map(|_| first)
    }

    /// Returns how a shader's texture coordinates are interpolated, and at which points.
    #[inline(always)]
    fn interpolation(
        &self,
        shader: Shader,
        _state: &Multisample,
    ) -> (Interpolation, InterpolationSampling) {
        (shader.interpolation(), shader.interpolation_sampling())
    }

    /// Returns the sample whose stored value the test or blend of a sample reads.
    #[inline(always)]
    fn stored_sample(&self, _aspect: Aspect, sample: usize) -> usize {
        sample
    }

    /// Returns the sample at which the depth of a sample is interpolated.
    #[inline(always)]
    fn depth_sample(&self, sample: usize, _samples: usize) -> usize {
        sample
    }

    /// Returns the depth of a resolved texel. Codes have the order of the depths.
    #[inline(always)]
    fn resolve_depth(&self, mode: ResolveMode, encoding: ChannelEncoding, codes: &[u32]) -> u32 {
        match mode {
            ResolveMode::Average => self.resolve(encoding, codes),
            ResolveMode::Min => codes.iter().copied().min().unwrap_or_default(),
            ResolveMode::Max => codes.iter().copied().max().unwrap_or_default(),
            ResolveMode::None | ResolveMode::SampleZero => codes[0],
        }
    }

    /// Returns the stencil value of a resolved texel.
    #[inline(always)]
    fn resolve_stencil(&self, mode: ResolveMode, values: &[u8]) -> u8 {
        match mode {
            ResolveMode::Min => values.iter().copied().min().unwrap_or_default(),
            ResolveMode::Max => values.iter().copied().max().unwrap_or_default(),
            ResolveMode::None | ResolveMode::SampleZero | ResolveMode::Average => values[0],
        }
    }

    /// Returns one channel of a resolved texel: the average of its samples, rounded to the nearest code.
    #[inline(always)]
    fn resolve(&self, encoding: ChannelEncoding, codes: &[u32]) -> u32 {
        let share = 1.0 / codes.len() as f32;
        let values = codes.iter().map(|c| Plain::<1>.decode(encoding, [*c])[0]);
        let sum: f32 = values.sum();
        Plain::<1>.encode(encoding, [sum * share])[0]
    }
}

/// The pipeline without bugs.
#[derive(Clone, Copy, Debug)]
pub struct Faithful;

impl Steps for Faithful {}
