//! Vertex shaders that choose the second viewport.
//!
//! WGSL has no viewport index, so the built-in output is added to naga's SPIR-V: a capability with its
//! extension, an output variable, and a store of 1 before each return of the vertex entry point.

use crate::spirv::{
    self, BUILT_IN, CONSTANT, DECORATE, ENTRY_POINT, FUNCTION, FUNCTION_END, OUTPUT, RETURN, STORE,
    TYPE_INT, TYPE_POINTER, VARIABLE, instruction, instructions,
};

/// The capability ShaderViewportIndexLayerEXT of SPV_EXT_shader_viewport_index_layer.
const VIEWPORT_INDEX_LAYER: u32 = 5254;
const VIEWPORT_INDEX: u32 = 10;

/// Returns a module whose vertex entry point draws to the second viewport.
pub(crate) fn choose_second(words: &[u32]) -> Vec<u32> {
    let words = spirv::with_capability(
        words,
        VIEWPORT_INDEX_LAYER,
        "SPV_EXT_shader_viewport_index_layer",
    );
    let (header, instructions) = instructions(&words);
    let opcode = |instruction: &[u32]| instruction[0] & 0xffff;
    let is = |instruction: &[u32], code: u32| opcode(instruction) == code;
    let vertex = instructions
        .iter()
        .find(|instruction| is(instruction, ENTRY_POINT) && instruction[1] == 0)
        .map(|instruction| instruction[2]);
    // Two types of the same integers are not allowed; two pointers to them are.
    let unsigned = instructions
        .iter()
        .find(|instruction| is(instruction, TYPE_INT) && instruction[2..] == [32, 0])
        .map(|instruction| instruction[1]);
    let first = header[3];
    let [variable, pointer, one, made] = [first, first + 1, first + 2, first + 3];
    let integer = unsigned.unwrap_or(made);
    let mut out = header.to_vec();
    out[3] = first + 4;
    let (mut decorated, mut declared) = (false, false);
    let mut function = None;
    for line in instructions {
        if !decorated && (is(line, DECORATE) || opcode(line) == 72) {
            out.extend(instruction(DECORATE, &[variable, BUILT_IN, VIEWPORT_INDEX]));
            decorated = true;
        }
        if !declared && is(line, FUNCTION) {
            if unsigned.is_none() {
                out.extend(instruction(TYPE_INT, &[made, 32, 0]));
            }
            out.extend(instruction(TYPE_POINTER, &[pointer, OUTPUT, integer]));
            out.extend(instruction(CONSTANT, &[integer, one, 1]));
            out.extend(instruction(VARIABLE, &[pointer, variable, OUTPUT]));
            declared = true;
        }
        if is(line, FUNCTION) {
            function = Some(line[2]);
        }
        if is(line, FUNCTION_END) {
            function = None;
        }
        if is(line, RETURN) && function.is_some() && function == vertex {
            out.extend(instruction(STORE, &[variable, one]));
        }
        if is(line, ENTRY_POINT) && Some(line[2]) == vertex {
            let operands = [&line[1..], &[variable]].concat();
            out.extend(instruction(ENTRY_POINT, &operands));
        } else {
            out.extend(line);
        }
    }
    out
}
