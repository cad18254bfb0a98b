//! Vertex shaders that select the second viewport, or a layer.
//!
//! WGSL has neither a viewport index nor a layer, so this module adds the built-in outputs to naga's SPIR-V:
//! a capability with its extension, output variables, and a store to each before each return of the vertex
//! entry point.

use crate::spirv::{
    self, BUILT_IN, CONSTANT, DECORATE, ENTRY_POINT, FUNCTION, FUNCTION_END, OUTPUT, RETURN, STORE,
    TYPE_INT, TYPE_POINTER, VARIABLE, instruction, instructions,
};

/// The capability ShaderViewportIndexLayerEXT of SPV_EXT_shader_viewport_index_layer.
const VIEWPORT_INDEX_LAYER: u32 = 5254;
/// The built-in Layer.
pub(crate) const LAYER: u32 = 9;
const VIEWPORT_INDEX: u32 = 10;

/// The viewport and the layer that a vertex shader selects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Chosen {
    pub(crate) second_viewport: bool,
    pub(crate) layer: Option<u32>,
}

/// An added output: the ids of its variable and its constant, the built-in and its value.
struct Output {
    variable: u32,
    constant: u32,
    built_in: u32,
    value: u32,
}

/// Returns the module with a vertex entry point that selects a viewport, a layer or both.
pub(crate) fn choose(words: &[u32], chosen: Chosen) -> Vec<u32> {
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
    // SPIR-V forbids two equal integer types, but allows two pointers to one type.
    let unsigned = instructions
        .iter()
        .find(|instruction| is(instruction, TYPE_INT) && instruction[2..] == [32, 0])
        .map(|instruction| instruction[1]);
    let first = header[3];
    let [made, pointer] = [first, first + 1];
    let viewport = chosen.second_viewport.then_some((VIEWPORT_INDEX, 1));
    let built_ins = viewport
        .into_iter()
        .chain(chosen.layer.map(|layer| (LAYER, layer)));
    let outputs: Vec<Output> = (first + 2..)
        .step_by(2)
        .zip(built_ins)
        .map(|(variable, (built_in, value))| Output {
            variable,
            constant: variable + 1,
            built_in,
            value,
        })
        .collect();
    let integer = unsigned.unwrap_or(made);
    let mut out = header.to_vec();
    out[3] = first + 2 + 2 * outputs.len() as u32;
    let (mut decorated, mut declared) = (false, false);
    let mut function = None;
    for line in instructions {
        if !decorated && (is(line, DECORATE) || opcode(line) == 72) {
            for output in &outputs {
                let operands = [output.variable, BUILT_IN, output.built_in];
                out.extend(instruction(DECORATE, &operands));
            }
            decorated = true;
        }
        if !declared && is(line, FUNCTION) {
            if unsigned.is_none() {
                out.extend(instruction(TYPE_INT, &[made, 32, 0]));
            }
            out.extend(instruction(TYPE_POINTER, &[pointer, OUTPUT, integer]));
            for output in &outputs {
                let constant = [integer, output.constant, output.value];
                out.extend(instruction(CONSTANT, &constant));
                out.extend(instruction(VARIABLE, &[pointer, output.variable, OUTPUT]));
            }
            declared = true;
        }
        if is(line, FUNCTION) {
            function = Some(line[2]);
        }
        if is(line, FUNCTION_END) {
            function = None;
        }
        if is(line, RETURN) && function.is_some() && function == vertex {
            for output in &outputs {
                out.extend(instruction(STORE, &[output.variable, output.constant]));
            }
        }
        if is(line, ENTRY_POINT) && Some(line[2]) == vertex {
            let variables = outputs.iter().map(|output| output.variable);
            let operands: Vec<u32> = line[1..].iter().copied().chain(variables).collect();
            out.extend(instruction(ENTRY_POINT, &operands));
        } else {
            out.extend(line);
        }
    }
    out
}
