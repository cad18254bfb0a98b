//! Fragment shaders that write the stencil reference.
//!
//! WGSL has no such built-in, so the suite's shaders write the reference to a location reserved for it. This
//! module turns that output of naga's SPIR-V into the built-in FragStencilRefEXT, with its capability,
//! extension and execution mode (SPV_EXT_shader_stencil_export).

use crate::spirv::{
    self, BUILT_IN, DECORATE, ENTRY_POINT, EXECUTION_MODE, LOCATION, OUTPUT, VARIABLE, instruction,
    instructions,
};
use etalon_scene::STENCIL_REFERENCE;

/// The capability StencilExportEXT.
const STENCIL_EXPORT: u32 = 5013;
/// The extension of the capability.
const EXTENSION_NAME: &str = "SPV_EXT_shader_stencil_export";
/// The built-in FragStencilRefEXT.
const FRAG_STENCIL_REF: u32 = 5014;
/// The execution mode StencilRefReplacingEXT.
const STENCIL_REF_REPLACING: u32 = 5027;
/// The execution model Fragment.
const FRAGMENT: u32 = 4;

/// Returns the module with the fragment output at [`STENCIL_REFERENCE`] turned into the stencil reference.
pub(crate) fn as_built_in(words: &[u32]) -> Vec<u32> {
    let words = spirv::with_capability(words, STENCIL_EXPORT, EXTENSION_NAME);
    let (header, instructions) = instructions(&words);
    let is = |instruction: &[u32], code: u32| instruction[0] & 0xffff == code;
    let fragment = instructions
        .iter()
        .find(|instruction| is(instruction, ENTRY_POINT) && instruction[1] == FRAGMENT)
        .copied()
        .unwrap_or_default();
    // Vertex shaders have other outputs at the same locations.
    let of_fragment = |variable: &u32| fragment.get(3..).is_some_and(|ids| ids.contains(variable));
    let outputs: Vec<u32> = instructions
        .iter()
        .filter(|instruction| is(instruction, VARIABLE) && instruction[3] == OUTPUT)
        .map(|instruction| instruction[2])
        .filter(of_fragment)
        .collect();
    let mut out = header.to_vec();
    let (mut mode, mut entered) = (false, false);
    for line in instructions {
        // Execution modes follow the entry points.
        if !mode && entered && !is(line, ENTRY_POINT) {
            out.extend(instruction(
                EXECUTION_MODE,
                &[fragment[2], STENCIL_REF_REPLACING],
            ));
            mode = true;
        }
        entered |= is(line, ENTRY_POINT);
        let replaced = is(line, DECORATE)
            && line[2..] == [LOCATION, STENCIL_REFERENCE]
            && outputs.contains(&line[1]);
        if replaced {
            out.extend(instruction(
                DECORATE,
                &[line[1], BUILT_IN, FRAG_STENCIL_REF],
            ))
        } else {
            out.extend(line)
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::translate;
    use crate::spirv::{CAPABILITY, EXTENSION};
    use etalon_scene::{EarlyTests, Shader};

    #[test]
    fn the_location_of_the_reference_becomes_the_built_in() {
        for shader in Shader::ALL.iter().filter(|s| s.writes_reference()) {
            let wgsl = shader.wgsl_with(EarlyTests::Forced);
            let words = translate(shader.name(), &wgsl)
                .expect("our own shader")
                .words;
            let changed = as_built_in(&words);
            let (header, found) = instructions(&changed);
            assert_eq!(header, &words[..5]);
            let count = |code: u32, tail: &[u32]| {
                let same = |instruction: &&&[u32]| {
                    instruction[0] & 0xffff == code && instruction.ends_with(tail)
                };
                found.iter().filter(same).count()
            };
            assert_eq!(count(CAPABILITY, &[STENCIL_EXPORT]), 1);
            assert_eq!(count(EXTENSION, &spirv::extension(EXTENSION_NAME)[1..]), 1);
            assert_eq!(count(EXECUTION_MODE, &[STENCIL_REF_REPLACING]), 1);
            assert_eq!(count(DECORATE, &[BUILT_IN, FRAG_STENCIL_REF]), 1);
            assert_eq!(count(DECORATE, &[LOCATION, STENCIL_REFERENCE]), 0);
            // The order of a module's sections (SPIR-V, Logical Layout of a Module).
            let first = |code: u32| {
                found
                    .iter()
                    .position(|instruction| instruction[0] & 0xffff == code)
            };
            let last = |code: u32| {
                found
                    .iter()
                    .rposition(|instruction| instruction[0] & 0xffff == code)
            };
            assert!(last(CAPABILITY) < first(EXTENSION));
            assert!(last(ENTRY_POINT) < first(EXECUTION_MODE));
            assert!(last(EXECUTION_MODE) < first(DECORATE));
        }
    }
}
