//! Bugs of the sample mask that a shader writes, and of draws without a fragment shader.

use crate::fields::{
    DEPTH_BIAS, DEPTH_COMPARE, DEPTH_WRITE, EARLY_TESTS, SCISSOR, STENCIL_TEST, WRITE_MASK,
};
use crate::hooks::mask_keeps;
use crate::list::{CONFUSION, bugs};
use crate::permission::under;
use crate::plant::{draws, passes, set};
use etalon_reference::rules::MaskOfOne;
use etalon_scene::{CompareFunction, DepthBias, Draw, EarlyTests};

fn bit(mask: u32, sample: usize) -> bool {
    mask & (1 << sample) != 0
}

const COLORLESS_SKIPPED: &str = "drivers that skip a pipeline which writes no colour";

bugs! {
    class "shader-mask", "multisample";
    "ignored: The mask that a shader writes does nothing." => mask_keeps(|_, _, _| true);
    "inverted: A bit that is set takes its sample away." => mask_keeps(|mask, sample, _| !bit(mask, sample));
    "reversed: Bits belong to the samples in reverse." =>
        mask_keeps(|mask, sample, samples| bit(mask, samples - 1 - sample));
    "first-bit-for-all: The first bit decides over all samples." => mask_keeps(|mask, _, _| bit(mask, 0));
    "any-bit-for-all: A mask that is not 0 keeps all samples." =>
        mask_keeps(|mask, _, samples| mask & ((1 << samples) - 1) != 0);
    "beyond-keeps-all: Bits beyond the last sample keep all samples." =>
        mask_keeps(|mask, sample, samples| bit(mask, sample) || mask >> samples != 0);
    "next-bit: Each sample takes the bit of the next." => mask_keeps(|mask, sample, _| bit(mask, sample + 1));
    "eight-bits: Bits past the eighth are lost." => mask_keeps(|mask, sample, _| bit(mask & 0xff, sample));
    "two-samples-a-bit: A bit counts for two samples." => mask_keeps(|mask, sample, _| bit(mask, sample / 2));
    "bits-of-others-count: The next sample's bit counts too." =>
        mask_keeps(|mask, sample, samples| bit(mask, sample) && bit(mask, (sample + 1) % samples)),
        source "RADV: gl_SampleMask of per-sample shading not combined with the shaded sample";
    class "shader-mask", "early-z";
    "replaces-alpha-to-coverage: A mask that the shader writes turns alpha to coverage off." =>
        draws(|draw| draw.multisample.alpha_to_coverage = false),
        source "Direct3D 11.3: alpha to coverage is off where the shader writes oMask",
        when |draw| draw.shader.writes_mask();
    "replaces-the-draws-mask: A mask that the shader writes replaces the draw's." =>
        draws(|draw| draw.multisample.mask = u32::MAX), when |draw| draw.shader.writes_mask();
    "tested-early: Shaders that write a mask are tested early." =>
        set(EARLY_TESTS, EarlyTests::Forced),
        source "llvmpipe, panfrost: early tests despite what a shader does to coverage",
        when |draw| draw.shader.writes_mask();
    "forced-as-late: Forced early tests come late where the shader writes a mask." =>
        set(EARLY_TESTS, EarlyTests::Implicit), when |draw| draw.shader.writes_mask();
    "ignored-for-one-sample: The mask does nothing where a texel has one sample." =>
        mask_keeps(|mask, sample, samples| samples == 1 || bit(mask, sample)),
        source "Gallium: the mask is lowered away without several samples, as OpenGL wants and Vulkan does not", permitted vec![under!(mask_of_one: MaskOfOne::Ignored | MaskOfOne::Either)];
    "of-the-draw-ignored-for-one-sample: The draw's own mask does nothing where a texel has one sample." =>
        passes(|scene, number, pass| {
            let single = scene.pass_samples(&scene.passes[number]) == 1;
            for draw in pass.draws.iter_mut().filter(|_| single) { draw.multisample.mask = u32::MAX; }
        }), source "lavapipe", permitted vec![under!(covers_one_sample: false)];
    let no_fragment_shader = |draw: &Draw| !draw.shader.has_fragment();
    class "shaderless", "early-z";
    source COLORLESS_SKIPPED;
    "dropped: Draws without a fragment shader are dropped." =>
        draws(|draw| draw.rasterizer_discard = true), when no_fragment_shader, permitted vec![under!(goes_on_unshaded: false)];
    "depth-write-lost: Draws without a fragment shader write no depth." =>
        set(DEPTH_WRITE, false), when no_fragment_shader, permitted vec![under!(goes_on_unshaded: false)];
    "depth-not-tested: Without a fragment shader the depth test always passes." =>
        set(DEPTH_COMPARE, CompareFunction::Always), when no_fragment_shader;
    "not-counted: Draws without a fragment shader count no samples." =>
        draws(|draw| draw.counters.clear()), when no_fragment_shader;
    "first-sample-alone: Without a fragment shader the first sample alone is reached." =>
        draws(|draw| draw.multisample.mask &= 1), when no_fragment_shader;
    "stencil-lost: Without a fragment shader the stencil test is off." =>
        set(STENCIL_TEST, None), area "stencil", when no_fragment_shader;
    "stencil-of-the-front: Without a fragment shader back faces take the front's state." =>
        draws(|draw| draw.stencil.iter_mut().for_each(|s| s.back = s.front)), area "stencil", when no_fragment_shader;
    "bias-lost: Draws without a fragment shader are not biased." =>
        set(DEPTH_BIAS, DepthBias::default()), area "depth", when no_fragment_shader;
    "scissor-lost: Draws without a fragment shader ignore the scissor rectangle." =>
        set(SCISSOR, None), area "depth", when no_fragment_shader;
    "colour-written: Undefined colours, without a fragment shader, pass the write mask." =>
        set(WRITE_MASK, 0b1111), area "blend", source CONFUSION, when no_fragment_shader;
}
