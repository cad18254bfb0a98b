//! Bugs of the sample mask that a shader reads.

use crate::hooks::input_bit;
use crate::list::bugs;
use etalon_cpu::steps::InputBit;

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
        input_bit(|bit| bit.covered && bit.drawn);
    "masked-samples-stay: The mask has samples that the draw's own mask removes." =>
        input_bit(|bit| bit.covered && bit.shaded);
    source "AMDVLK: a shader that reads the mask runs once per sample";
    "own-bit-alone: The mask has one bit also without sample shading." =>
        input_bit(|bit| is_set(bit) && bit.bit == bit.sample);
}
