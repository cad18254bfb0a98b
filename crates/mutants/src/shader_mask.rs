//! Bugs of the sample mask that a shader writes, and of draws without a fragment shader.

use crate::fields::{DEPTH_BIAS, DEPTH_COMPARE, DEPTH_WRITE, WRITE_MASK};
use crate::hooks::mask_keeps;
use crate::list::{CONFUSION, List};
use etalon_scene::{CompareFunction, DepthBias, Draw, EarlyTests};

pub(super) fn add(list: &mut List) {
    masks(list);
    shaderless(list);
}

fn bit(mask: u32, sample: usize) -> bool {
    mask & (1 << sample) != 0
}

fn masks(list: &mut List) {
    list.class("shader-mask", "multisample");
    list.bug("ignored: The mask that a shader writes does nothing.")
        .plant(mask_keeps(|_, _, _| true));
    list.bug("inverted: A bit that is set takes its sample away.")
        .plant(mask_keeps(|mask, sample, _| !bit(mask, sample)));
    list.bug("reversed: Bits belong to the samples in reverse.")
        .plant(mask_keeps(|mask, sample, samples| {
            bit(mask, samples - 1 - sample)
        }));
    list.bug("first-bit-for-all: The first bit decides over all samples.")
        .plant(mask_keeps(|mask, _, _| bit(mask, 0)));
    list.bug("any-bit-for-all: A mask that is not 0 keeps all samples.")
        .plant(mask_keeps(|mask, _, samples| {
            mask & ((1 << samples) - 1) != 0
        }));
    list.bug("beyond-keeps-all: Bits beyond the last sample keep all samples.")
        .plant(mask_keeps(|mask, sample, samples| {
            bit(mask, sample) || mask >> samples != 0
        }));
    list.bug("next-bit: Each sample takes the bit of the next.")
        .plant(mask_keeps(|mask, sample, _| bit(mask, sample + 1)));
    list.bug("eight-bits: Bits past the eighth are lost.")
        .plant(mask_keeps(|mask, sample, _| bit(mask & 0xff, sample)));
    list.bug("two-samples-a-bit: A bit counts for two samples.")
        .plant(mask_keeps(|mask, sample, _| bit(mask, sample / 2)));
    list.bug("bits-of-others-count: Under sample shading the next sample's bit counts too.")
        .source("RADV: gl_SampleMask of per-sample shading not combined with the shaded sample")
        .plant(mask_keeps(|mask, sample, samples| {
            bit(mask, sample) && bit(mask, (sample + 1) % samples)
        }));
    list.class("shader-mask", "early-z");
    list.bug(
        "replaces-alpha-to-coverage: A mask that the shader writes turns alpha to coverage off.",
    )
    .source("Direct3D 11.3: alpha to coverage is off where the shader writes oMask")
    .when(|draw| draw.shader.writes_mask())
    .draws(|draw| draw.multisample.alpha_to_coverage = false);
    list.bug("replaces-the-draws-mask: A mask that the shader writes replaces the draw's.")
        .when(|draw| draw.shader.writes_mask())
        .draws(|draw| draw.multisample.mask = u32::MAX);
    list.bug("tested-early: Shaders that write a mask are tested early.")
        .source("llvmpipe, panfrost: early tests despite what a shader does to coverage")
        .when(|draw| draw.shader.writes_mask())
        .draws(|draw| draw.early_tests = EarlyTests::Forced);
    list.bug("forced-as-late: Forced early tests come late where the shader writes a mask.")
        .when(|draw| draw.shader.writes_mask())
        .draws(|draw| draw.early_tests = EarlyTests::Implicit);
    list.bug("ignored-for-one-sample: The mask does nothing where a texel has one sample.")
        .source(
            "Gallium: the mask is lowered away without several samples, as OpenGL wants and Vulkan \
             does not",
        )
        .plant(mask_keeps(|mask, sample, samples| {
            samples == 1 || bit(mask, sample)
        }));
}

fn shaderless(list: &mut List) {
    let without = |draw: &Draw| !draw.shader.has_fragment();
    const SHIPPED: &str = "drivers that skip a pipeline which writes no colour";
    list.class("shaderless", "early-z");
    list.source(SHIPPED);
    list.bug("dropped: Draws without a fragment shader are dropped.")
        .when(without)
        .draws(|draw| draw.rasterizer_discard = true);
    list.bug("depth-write-lost: Draws without a fragment shader write no depth.")
        .when(without)
        .set(DEPTH_WRITE, false);
    list.bug("depth-not-tested: Without a fragment shader the depth test always passes.")
        .when(without)
        .set(DEPTH_COMPARE, CompareFunction::Always);
    list.bug("not-counted: Draws without a fragment shader count no samples.")
        .when(without)
        .draws(|draw| draw.counters.clear());
    list.bug("first-sample-alone: Without a fragment shader the first sample alone is reached.")
        .when(without)
        .draws(|draw| draw.multisample.mask &= 1);
    list.bug("stencil-lost: Without a fragment shader the stencil test is off.")
        .area("stencil")
        .when(without)
        .draws(|draw| draw.stencil = None);
    list.bug("stencil-of-the-front: Without a fragment shader back faces take the front's state.")
        .area("stencil")
        .when(without)
        .draws(|draw| draw.stencil.iter_mut().for_each(|s| s.back = s.front));
    list.bug("bias-lost: Draws without a fragment shader are not biased.")
        .area("depth")
        .when(without)
        .set(DEPTH_BIAS, DepthBias::default());
    list.bug("scissor-lost: Draws without a fragment shader ignore the scissor rectangle.")
        .area("depth")
        .when(without)
        .draws(|draw| draw.scissor = None);
    list.bug("colour-written: Undefined colours, without a fragment shader, pass the write mask.")
        .area("blend")
        .source(CONFUSION)
        .when(without)
        .set(WRITE_MASK, 0b1111);
}
