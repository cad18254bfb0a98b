//! Bugs of the sample mask that a shader reads.

use crate::hooks::input_bit;
use crate::list::{CONFUSION, List};
use etalon_cpu::steps::InputBit;

pub(super) fn add(list: &mut List) {
    fn is_set(bit: &InputBit) -> bool {
        bit.covered && bit.drawn && bit.shaded
    }
    list.class("input-mask", "multisample");
    list.bug("full: The mask has the bits of all samples.")
        .plant(input_bit(|bit| bit.bit < bit.samples));
    list.bug("own-bit-missing: The mask lacks the bit of the sample that is shaded.")
        .plant(input_bit(|bit| is_set(bit) && bit.bit != bit.sample));
    list.bug("beyond: Bits beyond the last sample are set.")
        .plant(input_bit(|bit| is_set(bit) || bit.bit >= bit.samples));
    list.bug("zero-for-one-sample: The mask is 0 where a texel has one sample.")
        .plant(input_bit(|bit| is_set(bit) && bit.samples > 1));
    list.bug("eight-bits: Bits past the eighth are lost.")
        .plant(input_bit(|bit| is_set(bit) && bit.bit < 8));
    list.source("SPIRV-Cross on Metal: gl_SampleMaskIn as the rasterizer has it");
    list.bug("of-all-runs: With sample shading the mask has the bits of other runs.")
        .plant(input_bit(|bit| bit.covered && bit.drawn));
    list.bug("masked-samples-stay: The mask has samples that the draw's own mask removes.")
        .plant(input_bit(|bit| bit.covered && bit.shaded));
    list.source("AMDVLK: a shader that reads the mask runs once per sample");
    list.bug("own-bit-alone: The mask has one bit also without sample shading.")
        .plant(input_bit(|bit| is_set(bit) && bit.bit == bit.sample));
    list.source(CONFUSION);
}
