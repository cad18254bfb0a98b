//! The shader stages that tessellate, and the state of their patches.
//!
//! naga does not support tessellation, so the repository has the modules as SPIR-V, with their GLSL.

use crate::device::Device;
use crate::shader::create_module;
use ash::vk;
use etalon_backend::BackendError;
use etalon_scene::{CONTROL_SPIRV, DomainOrigin, FrontFace, Tessellation, evaluation_spirv};
use std::collections::HashMap;

/// The number of vertices of a patch.
pub(crate) const PATCH_VERTICES: u32 = 3;

/// The modules of both stages, created on first use.
#[derive(Debug, Default)]
pub(crate) struct Stages {
    control: Option<vk::ShaderModule>,
    evaluation: HashMap<FrontFace, vk::ShaderModule>,
}

impl Stages {
    /// Returns the control stage and the evaluation stage.
    pub(crate) fn get(
        &mut self,
        device: &Device,
        tessellation: Tessellation,
    ) -> Result<[vk::PipelineShaderStageCreateInfo<'static>; 2], BackendError> {
        let control = match self.control {
            Some(module) => module,
            None => *self.control.insert(create_module(
                device,
                "tessellation control",
                &words(CONTROL_SPIRV),
            )?),
        };
        let order = tessellation.order;
        let evaluation = match self.evaluation.get(&order) {
            Some(module) => *module,
            None => {
                let code = words(evaluation_spirv(order));
                let module = create_module(device, "tessellation evaluation", &code)?;
                self.evaluation.insert(order, module);
                module
            }
        };
        let stage = |stage, module| {
            vk::PipelineShaderStageCreateInfo::default()
                .stage(stage)
                .module(module)
                .name(c"main")
        };
        Ok([
            stage(vk::ShaderStageFlags::TESSELLATION_CONTROL, control),
            stage(vk::ShaderStageFlags::TESSELLATION_EVALUATION, evaluation),
        ])
    }

    /// Destroys everything. The device must still exist.
    pub(crate) fn destroy(&mut self, device: &Device) {
        let evaluation = self.evaluation.drain().map(|(_, module)| module);
        for module in self.control.take().into_iter().chain(evaluation) {
            // SAFETY: modules are needed only while pipelines are created.
            unsafe { device.raw.destroy_shader_module(module, None) };
        }
    }
}

/// Returns SPIR-V as words. The files store them with the low byte first.
fn words(bytes: &[u8]) -> Vec<u32> {
    let word = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    bytes.chunks_exact(4).map(word).collect()
}

/// Returns the state of the domain's origin, or `None` for the upper left, which is the default.
pub(crate) fn origin(
    tessellation: Tessellation,
) -> Option<vk::PipelineTessellationDomainOriginStateCreateInfo<'static>> {
    let lower = tessellation.origin == DomainOrigin::LowerLeft;
    lower.then(|| {
        vk::PipelineTessellationDomainOriginStateCreateInfo::default()
            .domain_origin(vk::TessellationDomainOrigin::LOWER_LEFT)
    })
}
