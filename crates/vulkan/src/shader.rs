//! Shader modules, translated from WGSL by naga.

use crate::cull_distance;
use crate::device::Device;
use crate::error::Check;
use crate::input_attachment::{self, Inputs};
use crate::mask_array;
use crate::stencil_export;
use crate::viewport::{self, Chosen};
use ash::vk;
use etalon_backend::BackendError;
use etalon_scene::{EarlyTests, Shader};
use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::HashMap;

/// SPIR-V with the facts that a pipeline needs.
#[derive(Debug)]
pub(crate) struct Translated {
    pub(crate) words: Vec<u32>,
    /// The locations of the vertex attributes that the vertex entry point reads.
    pub(crate) attributes: Vec<u32>,
}

/// A shader module with all entry points of its file.
#[derive(Clone, Debug)]
pub(crate) struct Module {
    pub(crate) raw: vk::ShaderModule,
    pub(crate) attributes: Vec<u32>,
}

/// The properties that a module depends on.
type ModuleKey = (Shader, EarlyTests, Inputs, Chosen);

/// The modules by shader, early-test mode, input attachments, and chosen viewport and layer. There are few, so all are kept.
#[derive(Debug, Default)]
pub(crate) struct Modules {
    modules: HashMap<ModuleKey, Module>,
}

/// Translates a WGSL file.
pub(crate) fn translate(name: &str, source: &str) -> Result<Translated, BackendError> {
    let fail = |message: String| BackendError::shader(name, message);
    let module =
        naga::front::wgsl::parse_str(source).map_err(|e| fail(e.emit_to_string(source)))?;
    let capabilities = Capabilities::DUAL_SOURCE_BLENDING
        | Capabilities::CLIP_DISTANCES
        | Capabilities::MULTISAMPLED_SHADING
        | Capabilities::EARLY_DEPTH_TEST;
    let info = Validator::new(ValidationFlags::all(), capabilities)
        .validate(&module)
        .map_err(|e| fail(e.emit_to_string(source)))?;
    // The viewport turns y up, so the shader does not, and a written depth is unchanged. WGSL has no point
    // size; SPIR-V must write it for points, and other topologies ignore it.
    let options = spv::Options {
        lang_version: (1, 3),
        flags: spv::WriterFlags::FORCE_POINT_SIZE,
        ..spv::Options::default()
    };
    let words = spv::write_vec(&module, &info, &options, None).map_err(|e| fail(e.to_string()))?;
    let mut attributes = Vec::new();
    let vertex = |e: &&naga::EntryPoint| e.stage == naga::ShaderStage::Vertex;
    for entry in module.entry_points.iter().filter(vertex) {
        for argument in &entry.function.arguments {
            if let Some(naga::Binding::Location { location, .. }) = argument.binding {
                attributes.push(location);
            }
        }
    }
    Ok(Translated { words, attributes })
}

/// Creates a module from SPIR-V.
pub(crate) fn create_module(
    device: &Device,
    name: &str,
    words: &[u32],
) -> Result<vk::ShaderModule, BackendError> {
    let info = vk::ShaderModuleCreateInfo::default().code(words);
    // SAFETY: naga writes valid SPIR-V of Vulkan 1.1 from a validated module.
    unsafe { device.raw.create_shader_module(&info, None) }.check(&format!("shader {name}"))
}

impl Modules {
    /// Returns the module of a shader, created on first use.
    pub(crate) fn get(
        &mut self,
        device: &Device,
        shader: Shader,
        tests: EarlyTests,
        inputs: Inputs,
        chosen: Chosen,
    ) -> Result<Module, BackendError> {
        let key = (shader, tests, inputs, chosen);
        if let Some(module) = self.modules.get(&key) {
            return Ok(module.clone());
        }
        let mut translated = translate(shader.name(), &shader.wgsl_with(tests))?;
        if shader.writes_mask() || shader.reads_mask() {
            translated.words = mask_array::as_array(&translated.words);
        }
        if shader.writes_reference() {
            translated.words = stencil_export::as_built_in(&translated.words);
        }
        if shader.cull_distances() > 0 {
            translated.words = cull_distance::as_cull_distances(&translated.words);
        }
        if inputs != [None; 2] {
            translated.words = input_attachment::as_inputs(&translated.words, inputs);
        }
        if chosen != Chosen::default() {
            translated.words = viewport::choose(&translated.words, chosen);
        }
        let module = Module {
            raw: create_module(device, shader.name(), &translated.words)?,
            attributes: translated.attributes,
        };
        self.modules.insert(key, module.clone());
        Ok(module)
    }

    /// Destroys everything. The device must still exist.
    pub(crate) fn destroy(&mut self, device: &Device) {
        for (_, module) in self.modules.drain() {
            // SAFETY: modules are needed only while pipelines are created.
            unsafe { device.raw.destroy_shader_module(module.raw, None) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shader_translates_and_reads_the_position() {
        for shader in Shader::ALL {
            let translated = translate(shader.name(), shader.wgsl()).expect("our own shader");
            assert!(translated.attributes.contains(&0), "{}", shader.name());
        }
    }

    /// Returns the execution modes of a module's entry points (SPIR-V, Mode Setting Instructions: opcode 16,
    /// the mode in the third word).
    fn execution_modes(words: &[u32]) -> Vec<u32> {
        let (mut words_left, mut modes) = (&words[5..], Vec::new());
        while let [head, ..] = words_left {
            if head & 0xffff == 16 {
                modes.push(words_left[2]);
            }
            words_left = &words_left[(head >> 16) as usize..];
        }
        modes
    }

    /// SPIR-V, Execution Mode: EarlyFragmentTests, DepthReplacing, DepthGreater, DepthLess,
    /// DepthUnchanged.
    #[test]
    fn early_test_modes_become_execution_modes() {
        let expected = |tests| match tests {
            EarlyTests::Implicit => None,
            EarlyTests::Forced => Some(9),
            EarlyTests::GreaterEqual => Some(14),
            EarlyTests::LessEqual => Some(15),
            EarlyTests::Unchanged => Some(16),
        };
        for shader in Shader::ALL {
            for tests in EarlyTests::ALL {
                let without = !shader.has_fragment() && *tests != EarlyTests::Implicit;
                if without || tests.is_conservative() && !shader.writes_depth() {
                    continue;
                }
                let source = shader.wgsl_with(*tests);
                let translated = translate(shader.name(), &source).expect("our own shader");
                let mut modes = execution_modes(&translated.words);
                modes.retain(|m| matches!(m, 9 | 12 | 14 | 15 | 16));
                let replaces = shader.writes_depth().then_some(12);
                let expected: Vec<u32> = expected(*tests).into_iter().chain(replaces).collect();
                assert_eq!(modes, expected, "{} {}", shader.name(), tests.name());
            }
        }
    }
}
