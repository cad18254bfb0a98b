//! Bugs of the sample mask that a shader reads.

use crate::hooks::{input_bit, shader_runs};
use crate::list::bugs;
use crate::permission::under;
use etalon_cpu::steps::InputBit;
use etalon_reference::rules::InputMaskRule;

fn is_set(bit: &InputBit) -> bool {
    bit.covered && bit.drawn && bit.shaded
}

bugs! {
    class "input-mask", "multisample";
    "full: The mask has the bits of all samples." => input_bit(|bit| bit.bit < bit.samples);
    "own-bit-missing: The mask lacks the bit of the sample that is shaded." =>
        input_bit(|bit| is_set(bit) && bit.bit != bit.sample);
    "beyond: Bits beyond the last sample are set." => input_bit(|bit| is_set(bit) || bit.bit >= bit.samples);
    "zero-for-one-sample: The mask is 0 where a texel has one sample." =>
        input_bit(|bit| is_set(bit) && bit.samples > 1);
    "eight-bits: Bits past the eighth are lost." => input_bit(|bit| is_set(bit) && bit.bit < 8);
    source "SPIRV-Cross on Metal: gl_SampleMaskIn as the rasterizer has it";
    "of-all-runs: With sample shading the mask has the bits of other runs." =>
        input_bit(|bit| bit.covered && bit.drawn), permitted vec![under!(input_mask: InputMaskRule::AllOrOwn)];
    "masked-samples-stay: The mask has samples that the draw's own mask removes." =>
        input_bit(|bit| bit.covered && bit.shaded), permitted vec![under!(input_mask_lacks_masked: false)];
    source "AMDVLK: a shader that reads the mask runs once per sample";
    "own-bit-alone: The mask has one bit also without sample shading." =>
        input_bit(|bit| is_set(bit) && bit.bit == bit.sample);
    "readers-run-per-sample: A shader that reads the mask runs for each sample." =>
        shader_runs(|shader, state, n| if shader.reads_mask() || shader.runs_per_sample() { n } else { state.least_runs(n as u32) as usize }),
        permitted vec![under!(input_mask: InputMaskRule::OfAnyRun | InputMaskRule::OfRunIfAsked | InputMaskRule::AllOrOwn)];
}
