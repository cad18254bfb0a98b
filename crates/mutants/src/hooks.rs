//! The rasterizer's steps, with one of them replaced.

use etalon_cpu::CpuSurface;
use etalon_cpu::steps::{
    ComparedDepths, ExportedReference, Faithful, InputBit, LANES, LaneCodes, Mask, Real, Steps,
    TestOutcome, Tests, WrittenTexels,
};
use etalon_frame::{Aspect, ChannelEncoding};
use etalon_pipeline::shader::{KeepCondition, SampleMask};
use etalon_pipeline::{Arithmetic, BlendInput, Plain, Point, advanced_blend, blend};
use etalon_scene::{
    AdvancedBlend, BlendState, CompareFunction, DepthBias, Interpolation, InterpolationSampling,
    LogicOperation, Multisample, Sampler, Shader, StencilFace,
};
use std::array::from_fn;

/// Declares the replaceable steps: for each, a field of [`Hooks`] and a function that replaces it. The
/// function returns anything that can be made from hooks, so that this file does not depend on `plant`. A
/// replacement has the arguments of its step, or works on single texels.
macro_rules! hooks {
    (
        whole { $($(#[$doc:meta])* $name:ident($($argument:ident: $type:ty),*) -> $result:ty;)+ }
        texels { $(
            $(#[$texel_doc:meta])* $texel:ident($($texel_type:ty),*) -> $texel_result:ty:
            $step:ident($($step_argument:ident: $step_type:ty),*) -> $step_result:ty = |$bug:ident| $replaced:expr;
        )+ }
    ) => {
        /// Replacements of single steps, one texel at a time. Planted bugs need not be fast.
        #[derive(Default)]
        pub(super) struct Hooks {
            $($name: Option<Box<dyn Fn($($type),*) -> $result + Send + Sync>>,)+
            $($texel: Option<Box<dyn Fn($($texel_type),*) -> $texel_result + Send + Sync>>,)+
        }

        $(hooks! { $(#[$doc])* $name($($type),*) -> $result })+
        $(hooks! { $(#[$texel_doc])* $texel($($texel_type),*) -> $texel_result })+

        impl Steps for CombinedHooks {
            $(fn $name(&self, $($argument: $type),*) -> $result {
                match self.find(|hooks| hooks.$name.as_ref()) {
                    None => Faithful.$name($($argument),*),
                    Some(bug) => bug($($argument),*),
                }
            })+
            $(fn $step(&self, $($step_argument: $step_type),*) -> $step_result {
                match self.find(|hooks| hooks.$texel.as_ref()) {
                    None => Faithful.$step($($step_argument),*),
                    Some($bug) => $replaced,
                }
            })+
        }
    };
    ($(#[$doc:meta])* $name:ident($($type:ty),*) -> $result:ty) => {
        $(#[$doc])*
        pub(super) fn $name<P: From<Hooks>>(
            bug: impl Fn($($type),*) -> $result + Send + Sync + 'static,
        ) -> P {
            P::from(Hooks { $name: Some(Box::new(bug)), ..Hooks::default() })
        }
    };
}

hooks! {
    whole {
        /// The stencil reference of a fragment whose shader writes one.
        exported(fragment: &ExportedReference) -> u8;
        /// Returns true if a bit of the sample mask that a shader reads is set.
        input_bit(bit: &InputBit) -> bool;
        /// The stencil test.
        stencil_passes(face: &StencilFace, stored: u8) -> bool;
        /// The stencil update, including the write mask.
        stencil_write(face: &StencilFace, outcome: TestOutcome, stored: u8) -> u8;
        /// The depth comparison.
        depth_passes(function: CompareFunction, depths: &ComparedDepths) -> bool;
        /// The conversion of clear values, colour and depth.
        clear_code(encoding: ChannelEncoding, value: f32) -> u32;
        /// The destination alpha of formats without alpha.
        missing_alpha(state: &BlendState) -> f32;
        /// The least step of a depth bias, given the largest depth of a primitive.
        bias_unit(encoding: ChannelEncoding, largest: f64) -> f64;
        /// The depth of a vertex in the window, given that depth, the depth before the viewport, and its range.
        window_depth(depth: f32, clip_depth: f32, range: [f32; 2]) -> f32;
        /// True if samples on an edge belong to the triangle clockwise of it.
        owns_edge(from: Point, to: Point) -> bool;
        /// True if forced early tests precede the sample mask.
        tests_before_mask() -> bool;
        /// True if a fragment counts all its samples if one passes.
        counts_all_samples() -> bool;
        /// The slope of a polygon, given the growth of its depth per texel.
        slope(dx: f64, dy: f64) -> f64;
        /// A window coordinate, in texels, on the grid of vertices, in its units.
        snap(coordinate: f32) -> i64;
        /// The depth bias, given the least step and the slope.
        bias(state: &DepthBias, unit: f64, slope: f64) -> f64;
        /// True if points and lines are biased.
        biases_lines() -> bool;
        /// True if points and lines face front.
        lines_face_front() -> bool;
        /// The clamping of a depth to the viewport's range, whether or not the draw clamps depths.
        held_to_range(depth: f32, range: [f32; 2], clamps: bool) -> f32;
        /// The depth bounds test, given the bounds, the stored and the incoming depth.
        in_bounds(bounds: [f32; 2], stored: f32, incoming: f32) -> bool;
        /// True if fragments outside the depth bounds count as failing the depth test.
        bounds_fail_as_depth() -> bool;
        /// The positions at which coverage is tested, in 1/256 texel, given those of shading.
        coverage_positions(shading: Vec<[u16; 2]>) -> Vec<[u16; 2]>;
        /// The positions of samples, in 1/256 texel.
        sample_positions(standard: Vec<[u16; 2]>) -> Vec<[u16; 2]>;
        /// Returns true if a sample is drawn, given its index and the number of samples.
        sample_drawn(state: &Multisample, sample: usize, samples: usize) -> bool;
        /// The sample at whose position a shader run takes its inputs, given its first sample and the
        /// number of samples; `None` for the centre.
        shaded_at(state: &Multisample, first: usize, samples: usize) -> Option<usize>;
        /// The sample whose stored value a sample's test or blend reads.
        stored_sample(aspect: Aspect, sample: usize) -> usize;
        /// The sample at whose position a sample's depth is taken, given the number of samples.
        depth_sample(sample: usize, samples: usize) -> usize;
        /// The interpolation of a shader's texture coordinates, and the points at which they are sampled.
        interpolation(shader: Shader, state: &Multisample) -> (Interpolation, InterpolationSampling);
        /// A channel of a resolved texel.
        resolve(encoding: ChannelEncoding, codes: &[u32]) -> u32;
    }
    texels {
        /// Coverage, restricted to texels for which `bug([x, y], [width, height])` is true.
        covered([u32; 2], [u32; 2]) -> bool:
        covered(x: usize, y: usize, size: [u32; 2], mask: Mask) -> Mask =
            |bug| from_fn(|i| mask[i] && bug([(x + i) as u32, y as u32], size));

        /// Fetches, redirected to `bug([x, y], [width, height])`.
        fetch([u32; 2], [u32; 2]) -> [u32; 2]:
        fetch(surface: &CpuSurface, x: usize, y: usize) -> [Real; 4] = |bug| {
            let size = [surface.width as u32, surface.height as u32];
            planes(from_fn(|i| {
                let [x, y] = bug([(x + i) as u32, y as u32], size);
                let (x, y) = (x.min(size[0] - 1) as usize, y.min(size[1] - 1) as usize);
                Faithful.fetch(surface, x - x % LANES, y).map(|plane| plane[x % LANES])
            }))
        };

        /// Fetches of attachments of the pass, redirected to `bug(([x, y], sample), [width, height])`.
        own_texel(([u32; 2], usize), [u32; 2]) -> ([u32; 2], usize):
        fetch_own(surface: &CpuSurface, x: usize, y: usize, sample: usize) -> [Real; 4] = |bug| {
            let size = [surface.width as u32, surface.height as u32];
            planes(from_fn(|i| {
                let ([x, y], sample) = bug(([(x + i) as u32, y as u32], sample), size);
                let (x, y) = (x.min(size[0] - 1) as usize, y.min(size[1] - 1) as usize);
                Faithful.fetch_own(surface, x - x % LANES, y, sample).map(|plane| plane[x % LANES])
            }))
        };

        /// Sampled textures, given the right sampling, the texture, the sampler and the coordinates.
        sampled(&dyn Fn([f32; 2]) -> [f32; 4], &CpuSurface, Sampler, [f32; 2]) -> [f32; 4]:
        sample(surface: &CpuSurface, sampler: Sampler, u: Real, v: Real) -> [Real; 4] = |bug| {
            let right = |[u, v]: [f32; 2]| Faithful.sample(surface, sampler, [u; LANES], [v; LANES]).map(|plane| plane[0]);
            planes(from_fn(|i| bug(&right, surface, sampler, [u[i], v[i]])))
        };

        /// The conversion of depths in 0..1.
        depth_code(ChannelEncoding, f32) -> u32:
        depth_codes(encoding: ChannelEncoding, depth: Real) -> LaneCodes =
            |bug| depth.map(|v| bug(encoding, v.clamp(0.0, 1.0)));

        /// Returns which of colour and depth are written, given whether a texel is covered, passes the
        /// stencil test and passes the depth test.
        written([bool; 3]) -> [bool; 2]:
        written(tests: &Tests) -> WrittenTexels = |bug| {
            let both: [_; LANES] = from_fn(|i| bug([tests.covered[i], tests.stencil[i], tests.depth[i]]));
            WrittenTexels { color: both.map(|[color, _]| color), depth: both.map(|[_, depth]| depth) }
        };

        /// Blending.
        blending(&BlendState, [ChannelEncoding; 4], &BlendInput<[f32; 1]>) -> [f32; 4]:
        blend(state: &BlendState, encodings: [ChannelEncoding; 4], input: &BlendInput<Real>) -> [Real; 4] =
            |bug| planes(from_fn(|i| {
                let single = |color: [Real; 4]| color.map(|plane| [plane[i]]);
                let (src, src1, dst) = (single(input.src), single(input.src1), single(input.dst));
                bug(state, encodings, &BlendInput { src, src1, dst, constant: single(input.constant) })
            }));

        /// Advanced blending of source and destination.
        advanced_blending(AdvancedBlend, [ChannelEncoding; 4], [[f32; 4]; 2]) -> [f32; 4]:
        advanced_blend(
            mode: AdvancedBlend, encodings: [ChannelEncoding; 4], src: [Real; 4], dst: [Real; 4]
        ) -> [Real; 4] =
            |bug| planes(from_fn(|i| bug(mode, encodings, [src, dst].map(|color| color.map(|plane| plane[i])))));

        /// The conversion of colours at the store, given the texel's number in the lanes that are drawn at once.
        color_code(ChannelEncoding, f32, usize) -> u32:
        color_codes(encoding: ChannelEncoding, value: Real) -> LaneCodes = |bug| from_fn(|i| bug(encoding, value[i], i));

        /// The conversion of stored colours to blend operands.
        color_value(ChannelEncoding, u32) -> f32:
        color_value(encoding: ChannelEncoding, codes: LaneCodes) -> Real = |bug| codes.map(|c| bug(encoding, c));

        /// The second source after alpha to one.
        second_source(&Multisample, [f32; 4]) -> [f32; 4]:
        second_source(state: &Multisample, second: [Real; 4]) -> [Real; 4] =
            |bug| planes(from_fn(|i| bug(state, second.map(|plane| plane[i]))));

        /// Logic operations, given whether they apply to the attachment, the encoding, and the codes of
        /// source and destination.
        logic(bool, ChannelEncoding, LogicOperation, u32, u32) -> u32:
        logic(
            obeys: bool, encoding: ChannelEncoding, operation: LogicOperation, src: LaneCodes, dst: LaneCodes
        ) -> LaneCodes = |bug| from_fn(|i| bug(obeys, encoding, operation, src[i], dst[i]));

        /// Returns true if a fragment's alpha covers a sample, given its index and the number of samples.
        alpha_covers(f32, usize, usize) -> bool:
        alpha_covers(alpha: Real, sample: usize, samples: usize) -> Mask = |bug| alpha.map(|a| bug(a, sample, samples));

        /// The number of shader runs per texel, given the number of samples.
        shader_runs(Shader, &Multisample, usize) -> usize:
        shader_runs(shader: Shader, state: &Multisample, samples: usize) -> usize =
            |bug| bug(shader, state, samples).clamp(1, samples);

        /// Whether a shader's sample mask keeps a sample, given the written mask, the sample's index and
        /// the number of samples.
        mask_keeps(u32, usize, usize) -> bool:
        mask_keeps(mask: &SampleMask<Real>, sample: usize, samples: usize) -> Mask =
            |bug| mask.bits.map(|bits| bug(mask.written(bits as u32), sample, samples));

        /// Returns true if a shader keeps a fragment, given the value and its limit.
        kept(f32, f32) -> bool:
        kept(kept: &KeepCondition<Real>) -> Mask = |bug| from_fn(|i| bug(kept.value[i], kept.limit[i]));
    }
}

/// The replacements of several changes: the first one's of each step.
#[derive(Default)]
pub(super) struct CombinedHooks(pub(super) Vec<&'static Hooks>);

impl CombinedHooks {
    #[inline(always)]
    fn find<T: ?Sized>(
        &self,
        step: impl Fn(&'static Hooks) -> Option<&'static T>,
    ) -> Option<&'static T> {
        self.0.iter().find_map(|hooks| step(hooks))
    }
}

/// Transposes the colours of texels into planes.
fn planes(texels: [[f32; 4]; LANES]) -> [Real; 4] {
    from_fn(|c| texels.map(|texel| texel[c]))
}

/// Returns the correct code of a value.
pub(super) fn code(encoding: ChannelEncoding, value: f32) -> u32 {
    let [code] = Plain::<1>.encode(encoding, [value]);
    code
}

/// Returns the correct result of blending.
pub(super) fn faithful_blend(
    state: &BlendState,
    encodings: [ChannelEncoding; 4],
    input: &BlendInput<[f32; 1]>,
) -> [f32; 4] {
    blend(&mut Plain::<1>, state, encodings, input).map(|[v]| v)
}

/// Returns the correct result of advanced blending.
pub(super) fn faithful_advanced(
    mode: AdvancedBlend,
    encodings: [ChannelEncoding; 4],
    [src, dst]: [[f32; 4]; 2],
) -> [f32; 4] {
    let lanes = |color: [f32; 4]| color.map(|v| [v]);
    advanced_blend(&mut Plain::<1>, mode, encodings, lanes(src), lanes(dst)).map(|[v]| v)
}
