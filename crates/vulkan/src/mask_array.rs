//! Sample masks as arrays.
//!
//! naga declares the built-in SampleMask, input or output, as one integer. Vulkan requires an array of
//! integers (VUID-SampleMask-SampleMask-04359), so this module turns the variable into an array of one
//! element, and makes each load and store access that element.

use crate::spirv::{
    ACCESS_CHAIN, BUILT_IN, CONSTANT, DECORATE, LOAD, STORE, TYPE_ARRAY, TYPE_POINTER, VARIABLE,
    instruction, instructions,
};

/// The built-in SampleMask.
const SAMPLE_MASK: u32 = 20;

/// Returns the module with its sample mask as an array. A module without a sample mask, or with an array, is
/// returned unchanged.
pub(crate) fn as_array(words: &[u32]) -> Vec<u32> {
    let (header, instructions) = instructions(words);
    let is = |instruction: &[u32], code: u32| instruction[0] & 0xffff == code;
    let mask = instructions
        .iter()
        .find(|instruction| {
            is(instruction, DECORATE) && instruction[2..] == [BUILT_IN, SAMPLE_MASK]
        })
        .map(|instruction| instruction[1]);
    let variable = instructions
        .iter()
        .find(|instruction| is(instruction, VARIABLE) && Some(instruction[2]) == mask)
        .map(|instruction| (instruction[1], instruction[3]));
    let integer = instructions
        .iter()
        .find(|instruction| {
            is(instruction, TYPE_POINTER) && Some(instruction[1]) == variable.map(|v| v.0)
        })
        .map(|instruction| instruction[3]);
    let (Some(mask), Some((pointer, class)), Some(integer)) = (mask, variable, integer) else {
        return words.to_vec();
    };
    if instructions
        .iter()
        .any(|instruction| is(instruction, TYPE_ARRAY) && instruction[1] == integer)
    {
        return words.to_vec();
    }
    let first = header[3];
    let [zero, one, array, to_array] = [first, first + 1, first + 2, first + 3];
    let mut next = first + 4;
    let mut out = header.to_vec();
    for line in instructions {
        if is(line, VARIABLE) && line[2] == mask {
            out.extend(instruction(CONSTANT, &[integer, zero, 0]));
            out.extend(instruction(CONSTANT, &[integer, one, 1]));
            out.extend(instruction(TYPE_ARRAY, &[array, integer, one]));
            out.extend(instruction(TYPE_POINTER, &[to_array, class, array]));
            out.extend(instruction(VARIABLE, &[to_array, mask, class]));
        } else if is(line, STORE) && line[1] == mask {
            out.extend(instruction(ACCESS_CHAIN, &[pointer, next, mask, zero]));
            out.extend(instruction(STORE, &[next, line[2]]));
            next += 1;
        } else if is(line, LOAD) && line[3] == mask {
            out.extend(instruction(ACCESS_CHAIN, &[pointer, next, mask, zero]));
            out.extend(instruction(LOAD, &[line[1], line[2], next]));
            next += 1;
        } else {
            out.extend(line);
        }
    }
    out[3] = next;
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spirv::{INPUT, OUTPUT};

    #[test]
    fn a_mask_is_stored_to_the_element_of_an_array() {
        let lines = [
            instruction(DECORATE, &[4, BUILT_IN, SAMPLE_MASK]),
            instruction(TYPE_POINTER, &[2, OUTPUT, 1]),
            instruction(VARIABLE, &[2, 4, OUTPUT]),
            instruction(STORE, &[4, 9]),
            instruction(STORE, &[5, 9]),
        ];
        let words = [vec![0, 0, 0, 10, 0], lines.concat()].concat();
        let changed = as_array(&words);
        let (header, instructions) = instructions(&changed);
        assert_eq!(header[3], 15);
        assert_eq!(instructions[4], instruction(TYPE_ARRAY, &[12, 1, 11]));
        assert_eq!(instructions[6], instruction(VARIABLE, &[13, 4, OUTPUT]));
        assert_eq!(instructions[7], instruction(ACCESS_CHAIN, &[2, 14, 4, 10]));
        assert_eq!(instructions[8], instruction(STORE, &[14, 9]));
        assert_eq!(instructions[9], instruction(STORE, &[5, 9]));
        assert_eq!(as_array(&changed), changed);
        let none = [vec![0, 0, 0, 10, 0], instruction(STORE, &[5, 9])].concat();
        assert_eq!(as_array(&none), none);
    }
    #[test]
    fn a_mask_is_loaded_from_the_element_of_an_array() {
        let lines = [
            instruction(DECORATE, &[4, BUILT_IN, SAMPLE_MASK]),
            instruction(TYPE_POINTER, &[2, INPUT, 1]),
            instruction(VARIABLE, &[2, 4, INPUT]),
            instruction(LOAD, &[1, 9, 4]),
            instruction(LOAD, &[1, 8, 5]),
        ];
        let words = [vec![0, 0, 0, 10, 0], lines.concat()].concat();
        let changed = as_array(&words);
        let (header, instructions) = instructions(&changed);
        assert_eq!(header[3], 15);
        assert_eq!(instructions[5], instruction(TYPE_POINTER, &[13, INPUT, 12]));
        assert_eq!(instructions[6], instruction(VARIABLE, &[13, 4, INPUT]));
        assert_eq!(instructions[7], instruction(ACCESS_CHAIN, &[2, 14, 4, 10]));
        assert_eq!(instructions[8], instruction(LOAD, &[1, 9, 14]));
        assert_eq!(instructions[9], instruction(LOAD, &[1, 8, 5]));
        assert_eq!(as_array(&changed), changed);
    }
}
