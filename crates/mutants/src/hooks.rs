//! The rasterizer's steps with one of them replaced.

use etalon_cpu::Surface;
use etalon_cpu::steps::{
    Codes, Exported, Faithful, InputBit, LANES, Mask, Path, Real, Steps, Tests, WrittenTexels,
};
use etalon_frame::{Aspect, ChannelEncoding};
use etalon_pipeline::shader::{Kept, SampleMask};
use etalon_pipeline::{Arithmetic, BlendInput, Plain, advanced_blend, blend};
use etalon_scene::{
    AdvancedBlend, BlendState, CompareFunction, DepthBias, Interpolation, InterpolationSampling,
    LogicOperation, Multisample, Shader, StencilFace,
};

/// Declares the replaceable steps: each is a field of [`Hooks`] and a function that replaces it. The
/// function returns anything made from hooks, so that this file does not depend on `plant`.
macro_rules! hooks {
    ($($(#[$doc:meta])* $name:ident($($argument:ty),*) -> $result:ty;)+) => {
        /// Replacements of single steps, one texel at a time: planted bugs need not be fast.
        #[derive(Default)]
        pub(super) struct Hooks {
            $($name: Option<Box<dyn Fn($($argument),*) -> $result + Send + Sync>>,)+
        }

        $($(#[$doc])*
        pub(super) fn $name<P: From<Hooks>>(
            bug: impl Fn($($argument),*) -> $result + Send + Sync + 'static,
        ) -> P {
            P::from(Hooks {
                $name: Some(Box::new(bug)),
                ..Hooks::default()
            })
        })+
    };
}

hooks! {
    /// Coverage, restricted to texels of which `bug([x, y], [width, height])` is true.
    covered([u32; 2], [u32; 2]) -> bool;
    /// Texels are fetched from `bug([x, y], [width, height])`.
    fetch([u32; 2], [u32; 2]) -> [u32; 2];
    /// The stencil reference of a fragment whose shader writes one.
    exported(&Exported) -> u8;
    /// The stencil test.
    stencil_passes(&StencilFace, u8) -> bool;
    /// The stencil update, write mask and all.
    stencil_write(&StencilFace, Path, u8) -> u8;
    /// The conversion of depths in 0..1.
    depth_code(ChannelEncoding, f32) -> u32;
    /// The depth comparison of codes, incoming first.
    depth_passes(CompareFunction, u32, u32) -> bool;
    /// Returns which of colour and depth are written, given whether a texel is covered, passes the
    /// stencil test and passes the depth test.
    written([bool; 3]) -> [bool; 2];
    /// Blending.
    blending(&BlendState, [ChannelEncoding; 4], &BlendInput<[f32; 1]>) -> [f32; 4];
    /// Advanced blending of source and destination.
    advanced_blending(AdvancedBlend, [ChannelEncoding; 4], [[f32; 4]; 2]) -> [f32; 4];
    /// The conversion of colours at the store.
    color_code(ChannelEncoding, f32) -> u32;
    /// The conversion of clear values, colour and depth.
    clear_code(ChannelEncoding, f32) -> u32;
    /// The conversion of stored colours to blend operands.
    color_value(ChannelEncoding, u32) -> f32;
    /// The destination alpha of formats without alpha.
    missing_alpha(&BlendState) -> f32;
    /// The second source after alpha to one.
    second_source(&Multisample, [f32; 4]) -> [f32; 4];
    /// Logic operations, given whether they apply to the attachment, and the codes of source and
    /// destination.
    logic(bool, ChannelEncoding, LogicOperation, u32, u32) -> u32;
    /// The least step of a depth bias, given the largest depth of a primitive.
    bias_unit(ChannelEncoding, f64) -> f64;
    /// The depth bias, given the least step and the slope.
    bias(&DepthBias, f64, f64) -> f64;
    /// True if points and lines are biased.
    biases_lines() -> bool;
    /// True if points and lines face front.
    lines_face_front() -> bool;
    /// The clamping of a depth to the viewport's range.
    held_to_range(f32, [f32; 2]) -> f32;
    /// The depth bounds test, given the bounds, the stored and the incoming depth.
    in_bounds([f32; 2], f32, f32) -> bool;
    /// True if fragments outside the depth bounds count as failing the depth test.
    bounds_fail_as_depth() -> bool;
    /// The positions of samples, in 1/256 texel.
    sample_positions(Vec<[u16; 2]>) -> Vec<[u16; 2]>;
    /// True if a fragment's alpha covers a sample, given its index and the number of samples.
    alpha_covers(f32, usize, usize) -> bool;
    /// True if a sample is drawn, given its index and the number of samples.
    sample_drawn(&Multisample, usize, usize) -> bool;
    /// The number of runs of a shader that share a texel, given the number of samples.
    shader_runs(Shader, &Multisample, usize) -> usize;
    /// The sample at whose position a run takes its inputs, given its first sample and the number of
    /// samples; `None` for the centre.
    shaded_at(&Multisample, usize, usize) -> Option<usize>;
    /// The sample whose stored value a sample's test or blend reads.
    stored_sample(Aspect, usize) -> usize;
    /// The sample at whose position a sample's depth is taken, given the number of samples.
    depth_sample(usize, usize) -> usize;
    /// True if a shader keeps a fragment, given the value and its limit.
    kept(f32, f32) -> bool;
    /// True if the sample mask of a shader keeps a sample, given the mask as it is written, the sample's
    /// index and the number of samples.
    mask_keeps(u32, usize, usize) -> bool;
    /// True if a bit of the sample mask that a shader reads is set.
    input_bit(&InputBit) -> bool;
    /// The interpolation of a shader's texture coordinates, and the points at which they are taken.
    interpolation(Shader) -> (Interpolation, InterpolationSampling);
    /// A channel of a resolved texel.
    resolve(ChannelEncoding, &[u32]) -> u32;
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

/// Declares the steps that take what their replacement does.
macro_rules! replaced {
    ($($name:ident($($argument:ident: $type:ty),*) -> $result:ty;)+) => {
        $(fn $name(&self, $($argument: $type),*) -> $result {
            match &self.$name {
                None => Faithful.$name($($argument),*),
                Some(bug) => bug($($argument),*),
            }
        })+
    };
}

impl Steps for &Hooks {
    replaced! {
        exported(of: &Exported) -> u8;
        input_bit(of: &InputBit) -> bool;
        stencil_passes(face: &StencilFace, stored: u8) -> bool;
        stencil_write(face: &StencilFace, path: Path, stored: u8) -> u8;
        depth_passes(function: CompareFunction, incoming: u32, stored: u32) -> bool;
        clear_code(encoding: ChannelEncoding, value: f32) -> u32;
        missing_alpha(state: &BlendState) -> f32;
        bias_unit(encoding: ChannelEncoding, largest: f64) -> f64;
        bias(state: &DepthBias, unit: f64, slope: f64) -> f64;
        biases_lines() -> bool;
        lines_face_front() -> bool;
        held_to_range(depth: f32, range: [f32; 2]) -> f32;
        in_bounds(bounds: [f32; 2], stored: f32, incoming: f32) -> bool;
        bounds_fail_as_depth() -> bool;
        sample_positions(standard: Vec<[u16; 2]>) -> Vec<[u16; 2]>;
        sample_drawn(state: &Multisample, sample: usize, samples: usize) -> bool;
        shaded_at(state: &Multisample, first: usize, samples: usize) -> Option<usize>;
        stored_sample(aspect: Aspect, sample: usize) -> usize;
        depth_sample(sample: usize, samples: usize) -> usize;
        interpolation(shader: Shader) -> (Interpolation, InterpolationSampling);
        resolve(encoding: ChannelEncoding, codes: &[u32]) -> u32;
    }

    fn covered(&self, x: usize, y: usize, size: [u32; 2], mask: Mask) -> Mask {
        match &self.covered {
            None => mask,
            Some(bug) => std::array::from_fn(|i| mask[i] && bug([(x + i) as u32, y as u32], size)),
        }
    }

    fn fetch(&self, surface: &Surface, x: usize, y: usize) -> [Real; 4] {
        let Some(bug) = &self.fetch else {
            return Faithful.fetch(surface, x, y);
        };
        let size = [surface.width as u32, surface.height as u32];
        let from: [usize; LANES] = std::array::from_fn(|i| {
            let [x, y] = bug([(x + i) as u32, y as u32], size);
            let (x, y) = (x.min(size[0] - 1), y.min(size[1] - 1));
            y as usize * surface.stride + x as usize
        });
        std::array::from_fn(|c| match surface.encodings.get(c) {
            Some(encoding) => {
                let plane = surface.plane(c, 0);
                Plain::<LANES>.decode(*encoding, from.map(|texel| plane[texel]))
            }
            None => [if c == 3 { 1.0 } else { 0.0 }; LANES],
        })
    }

    fn depth_codes(&self, encoding: ChannelEncoding, depth: Real) -> Codes {
        match &self.depth_code {
            None => Faithful.depth_codes(encoding, depth),
            Some(bug) => depth.map(|v| bug(encoding, v.clamp(0.0, 1.0))),
        }
    }

    fn written(&self, tests: &Tests) -> WrittenTexels {
        let Some(bug) = &self.written else {
            return Faithful.written(tests);
        };
        let both: [[bool; 2]; LANES] =
            std::array::from_fn(|i| bug([tests.covered[i], tests.stencil[i], tests.depth[i]]));
        WrittenTexels {
            color: both.map(|[color, _]| color),
            depth: both.map(|[_, depth]| depth),
        }
    }

    fn blend(
        &self,
        state: &BlendState,
        encodings: [ChannelEncoding; 4],
        input: &BlendInput<Real>,
    ) -> [Real; 4] {
        let Some(bug) = &self.blending else {
            return Faithful.blend(state, encodings, input);
        };
        let mut result = [[0.0; LANES]; 4];
        for lane in 0..LANES {
            let single = BlendInput {
                src: input.src.map(|v| [v[lane]]),
                src1: input.src1.map(|v| [v[lane]]),
                dst: input.dst.map(|v| [v[lane]]),
                constant: input.constant.map(|v| [v[lane]]),
            };
            for (c, value) in bug(state, encodings, &single).into_iter().enumerate() {
                result[c][lane] = value;
            }
        }
        result
    }

    fn advanced_blend(
        &self,
        mode: AdvancedBlend,
        encodings: [ChannelEncoding; 4],
        src: [Real; 4],
        dst: [Real; 4],
    ) -> [Real; 4] {
        let Some(bug) = &self.advanced_blending else {
            return Faithful.advanced_blend(mode, encodings, src, dst);
        };
        let lanes: [[f32; 4]; LANES] = std::array::from_fn(|lane| {
            bug(
                mode,
                encodings,
                [src, dst].map(|color| color.map(|v| v[lane])),
            )
        });
        std::array::from_fn(|c| lanes.map(|texel| texel[c]))
    }

    fn color_codes(&self, encoding: ChannelEncoding, value: Real) -> Codes {
        match &self.color_code {
            None => Faithful.color_codes(encoding, value),
            Some(bug) => value.map(|v| bug(encoding, v)),
        }
    }

    fn color_value(&self, encoding: ChannelEncoding, codes: Codes) -> Real {
        match &self.color_value {
            None => Faithful.color_value(encoding, codes),
            Some(bug) => codes.map(|c| bug(encoding, c)),
        }
    }

    fn second_source(&self, multisample: &Multisample, second: [Real; 4]) -> [Real; 4] {
        let Some(bug) = &self.second_source else {
            return Faithful.second_source(multisample, second);
        };
        let lanes: [[f32; 4]; LANES] =
            std::array::from_fn(|lane| bug(multisample, second.map(|v| v[lane])));
        std::array::from_fn(|c| lanes.map(|texel| texel[c]))
    }

    fn logic(
        &self,
        obeys: bool,
        encoding: ChannelEncoding,
        operation: LogicOperation,
        src: Codes,
        dst: Codes,
    ) -> Codes {
        match &self.logic {
            None => Faithful.logic(obeys, encoding, operation, src, dst),
            Some(bug) => std::array::from_fn(|i| bug(obeys, encoding, operation, src[i], dst[i])),
        }
    }

    fn alpha_covers(&self, alpha: Real, sample: usize, samples: usize) -> Mask {
        match &self.alpha_covers {
            None => Faithful.alpha_covers(alpha, sample, samples),
            Some(bug) => alpha.map(|a| bug(a, sample, samples)),
        }
    }

    fn shader_runs(&self, shader: Shader, state: &Multisample, samples: usize) -> usize {
        match &self.shader_runs {
            None => Faithful.shader_runs(shader, state, samples),
            Some(bug) => bug(shader, state, samples).clamp(1, samples),
        }
    }

    fn mask_keeps(&self, mask: &SampleMask<Real>, sample: usize, samples: usize) -> Mask {
        match &self.mask_keeps {
            None => Faithful.mask_keeps(mask, sample, samples),
            Some(bug) => mask
                .bits
                .map(|bits| bug(mask.written(bits as u32), sample, samples)),
        }
    }

    fn kept(&self, kept: &Kept<Real>) -> Mask {
        match &self.kept {
            None => Faithful.kept(kept),
            Some(bug) => std::array::from_fn(|i| bug(kept.value[i], kept.limit[i])),
        }
    }
}
