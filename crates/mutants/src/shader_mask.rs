//! Bugs of the sample mask that a shader writes, and of draws without a fragment shader.

use super::hooks::mask_keeps;
use super::list::{CONFUSION, List, Row};
use super::plant::draws;
use etalon_scene::{CompareFunction, Draw, EarlyTests};

/// Decides whether a mask, as it is written, keeps a sample, given its index and the number of samples.
type Keeps = fn(u32, usize, usize) -> bool;

pub(super) fn add(list: &mut List) {
    masks(list);
    shaderless(list);
}

fn bit(mask: u32, sample: usize) -> bool {
    mask & (1 << sample) != 0
}

/// A bug of a draw whose shader writes a mask.
fn masked(bug: fn(&mut Draw)) -> super::plant::Plant {
    draws(move |draw| {
        if draw.shader.writes_mask() {
            bug(draw);
        }
    })
}

fn masks(list: &mut List) {
    list.class("shader-mask", "multisample");
    let rows: [Row<Keeps>; 9] = [
        (
            "ignored",
            "The mask that a shader writes does nothing.",
            |_, _, _| true,
        ),
        (
            "inverted",
            "A bit that is set takes its sample away.",
            |mask, sample, _| !bit(mask, sample),
        ),
        (
            "reversed",
            "Bits belong to the samples in reverse.",
            |mask, sample, samples| bit(mask, samples - 1 - sample),
        ),
        (
            "first-bit-for-all",
            "The first bit decides over all samples.",
            |mask, _, _| bit(mask, 0),
        ),
        (
            "any-bit-for-all",
            "A mask that is not 0 keeps all samples.",
            |mask, _, samples| mask & ((1 << samples) - 1) != 0,
        ),
        (
            "beyond-keeps-all",
            "Bits beyond the last sample keep all samples.",
            |mask, sample, samples| bit(mask, sample) || mask >> samples != 0,
        ),
        (
            "next-bit",
            "Each sample takes the bit of the next.",
            |mask, sample, _| bit(mask, sample + 1),
        ),
        (
            "eight-bits",
            "Bits past the eighth are lost.",
            |mask, sample, _| bit(mask & 0xff, sample),
        ),
        (
            "two-samples-a-bit",
            "A bit counts for two samples.",
            |mask, sample, _| bit(mask, sample / 2),
        ),
    ];
    list.rows(CONFUSION, mask_keeps, &rows);
    list.add(
        "bits-of-others-count",
        "RADV: gl_SampleMask of per-sample shading not combined with the shaded sample",
        "Under sample shading the bits of other samples count: one that is 0 takes the sample away.",
        mask_keeps(|mask, sample, samples| {
            bit(mask, sample) && bit(mask, (sample + 1) % samples)
        }),
    );
    list.class("shader-mask", "early-z");
    list.add(
        "replaces-alpha-to-coverage",
        "Direct3D 11.3: alpha to coverage is off where the shader writes oMask",
        "A mask that the shader writes turns alpha to coverage off.",
        masked(|draw| draw.multisample.alpha_to_coverage = false),
    );
    list.add(
        "replaces-the-draws-mask",
        CONFUSION,
        "A mask that the shader writes takes the place of the draw's.",
        masked(|draw| draw.multisample.mask = u32::MAX),
    );
    list.add(
        "tested-early",
        "llvmpipe, panfrost: early tests despite what a shader does to coverage",
        "Shaders that write a mask are tested early.",
        masked(|draw| draw.early_tests = EarlyTests::Forced),
    );
    list.add(
        "forced-as-late",
        CONFUSION,
        "Forced early tests come late where the shader writes a mask.",
        masked(|draw| draw.early_tests = EarlyTests::Implicit),
    );
    list.add(
        "ignored-for-one-sample",
        "Gallium: the mask is lowered away without several samples, as OpenGL wants and Vulkan does not",
        "The mask does nothing where a texel has one sample.",
        mask_keeps(|mask, sample, samples| samples == 1 || bit(mask, sample)),
    );
}

fn shaderless(list: &mut List) {
    fn without(bug: fn(&mut Draw)) -> super::plant::Plant {
        draws(move |draw| {
            if !draw.shader.has_fragment() {
                bug(draw);
            }
        })
    }
    type Bug = fn(&mut Draw);
    list.class("shaderless", "early-z");
    let rows: [Row<Bug>; 5] = [
        (
            "dropped",
            "Draws without a fragment shader are dropped.",
            |draw| draw.rasterizer_discard = true,
        ),
        ("depth-write-lost", "They write no depth.", |draw| {
            if let Some(depth) = &mut draw.depth {
                depth.write = false;
            }
        }),
        (
            "depth-not-tested",
            "Their depth test always passes.",
            |draw| {
                if let Some(depth) = &mut draw.depth {
                    depth.compare = CompareFunction::Always;
                }
            },
        ),
        ("not-counted", "They count no samples.", |draw| {
            draw.counters.clear();
        }),
        (
            "first-sample-alone",
            "They reach the first sample of a texel alone.",
            |draw| draw.multisample.mask &= 1,
        ),
    ];
    const SHIPPED: &str = "drivers that skip a pipeline which writes no colour";
    list.rows(SHIPPED, without, &rows);
    list.class("shaderless", "stencil");
    let rows: [Row<Bug>; 2] = [
        ("stencil-lost", "Their stencil test is off.", |draw| {
            draw.stencil = None;
        }),
        (
            "stencil-of-the-front",
            "Back faces take the front's stencil state.",
            |draw| {
                if let Some(stencil) = &mut draw.stencil {
                    stencil.back = stencil.front;
                }
            },
        ),
    ];
    list.rows(SHIPPED, without, &rows);
    list.class("shaderless", "depth");
    let rows: [Row<Bug>; 2] = [
        ("bias-lost", "They are not biased.", |draw| {
            draw.depth_bias = etalon_scene::DepthBias::default();
        }),
        (
            "scissor-lost",
            "They ignore the scissor rectangle.",
            |draw| {
                draw.scissor = None;
            },
        ),
    ];
    list.rows(SHIPPED, without, &rows);
    list.class("shaderless", "blend");
    let rows: [Row<Bug>; 1] = [(
        "colour-written",
        "Their undefined colours pass the write mask.",
        |draw| draw.targets.iter_mut().for_each(|t| t.write_mask = 0b1111),
    )];
    list.rows(CONFUSION, without, &rows);
}
