//! The features and extensions that a scene needs.
//!
//! The backend enables everything that it might use. A program that did so would run only on devices that
//! have it all.

use ash::vk;
use etalon_backend::{Argument, RecordedCall, VulkanNeeds};
use etalon_frame::{
    Feature, PathDraws, PathLayers, PathReads, PathState, PathViewport, Requirement, TextureFormat,
};
use etalon_scene::Scene;

/// The features and extensions that a scene's device needs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Needed {
    /// Members of `VkPhysicalDeviceFeatures`.
    features: Vec<&'static str>,
    extensions: Vec<&'static str>,
    pub(super) further: VulkanNeeds,
    /// True if every feature and extension is kept, because the scene's path uses further states.
    all: bool,
}

impl Needed {
    /// Returns what a scene needs. `native` returns the `VkFormat` of a format.
    pub(crate) fn of(scene: &Scene, native: impl Fn(TextureFormat) -> Option<vk::Format>) -> Self {
        let mut needed = Self {
            all: scene.path.state != PathState::default()
                || scene.path.viewport != PathViewport::default()
                || scene.path.layers != PathLayers::default()
                || scene.path.reads != PathReads::default()
                || scene.path.draws == PathDraws::IndirectCount,
            ..Self::default()
        };
        for requirement in scene.requirements() {
            match requirement {
                Requirement::Feature(feature) => {
                    needed.features.extend(member(feature));
                    needed.extensions.extend(extension(feature));
                    resolve(feature, &mut needed.further);
                }
                Requirement::Blending(format) => {
                    let raw = native(format).map(|raw| raw.as_raw().cast_unsigned());
                    needed.further.blended.extend(raw);
                }
                _ => {}
            }
        }
        needed
    }

    /// Removes from the call that creates the device what the scene does not need.
    pub(super) fn narrow(&self, call: &mut RecordedCall) {
        if self.all || call.function != "vkCreateDevice" {
            return;
        }
        if let Some(Argument::Array(infos)) = call.arguments.get_mut(1)
            && let Some(Argument::Struct { members, .. }) = infos.first_mut()
        {
            let mut extensions = 0;
            for member in &mut *members {
                match (member.name.as_str(), &mut member.value) {
                    ("pNext", value) => self.unchain(value),
                    ("ppEnabledExtensionNames", value) => {
                        if let Argument::Array(names) = value {
                            names.retain(|name| matches!(name, Argument::Text(name) if self.extensions.contains(&name.as_str())));
                            extensions = names.len() as u32;
                        }
                        if extensions == 0 {
                            *value = Argument::Null;
                        }
                    }
                    ("pEnabledFeatures", Argument::Array(structures)) => {
                        if let Some(Argument::Struct { members, .. }) = structures.first_mut() {
                            for member in members {
                                if !self.features.contains(&member.name.as_str()) {
                                    member.value = Argument::Unsigned(0);
                                }
                            }
                        }
                    }
                    _ => {}
                }
            }
            for member in members {
                if member.name == "enabledExtensionCount" {
                    member.value = Argument::Unsigned(extensions);
                }
            }
        }
    }

    /// Removes from a chain the structures of extensions that the scene does not need.
    fn unchain(&self, chain: &mut Argument) {
        let Argument::Array(structures) = chain else {
            return;
        };
        let Some(Argument::Struct { kind, members, .. }) = structures.first_mut() else {
            return;
        };
        let owner = match kind.as_str() {
            "VkPhysicalDeviceExtendedDynamicState3FeaturesEXT" => "VK_EXT_extended_dynamic_state3",
            "VkPhysicalDeviceExtendedDynamicState2FeaturesEXT" => "VK_EXT_extended_dynamic_state2",
            "VkPhysicalDeviceDepthClipEnableFeaturesEXT" => "VK_EXT_depth_clip_enable",
            "VkPhysicalDeviceProvokingVertexFeaturesEXT" => "VK_EXT_provoking_vertex",
            "VkPhysicalDeviceDynamicRenderingLocalReadFeaturesKHR" => {
                "VK_KHR_dynamic_rendering_local_read"
            }
            "VkPhysicalDeviceAttachmentFeedbackLoopLayoutFeaturesEXT" => {
                "VK_EXT_attachment_feedback_loop_layout"
            }
            "VkPhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT" => {
                "VK_EXT_rasterization_order_attachment_access"
            }
            "VkPhysicalDeviceVulkan11Features" => "VK_KHR_multiview",
            "VkPhysicalDeviceVulkan12Features" => "VK_KHR_draw_indirect_count",
            "VkPhysicalDeviceBlendOperationAdvancedFeaturesEXT" => {
                "VK_EXT_blend_operation_advanced"
            }
            _ => "",
        };
        let mut successor = Argument::Null;
        for member in members {
            if member.name == "pNext" {
                self.unchain(&mut member.value);
                successor = member.value.clone();
            }
        }
        if !owner.is_empty() && !self.extensions.contains(&owner) {
            *chain = successor;
        }
    }
}

/// Returns the member of `VkPhysicalDeviceFeatures` that a scene's feature needs.
fn member(feature: Feature) -> Option<&'static str> {
    Some(match feature {
        Feature::AlphaToOne => "alphaToOne",
        Feature::ClipDistances => "shaderClipDistance",
        Feature::CullDistances => "shaderCullDistance",
        Feature::DepthBiasClamp => "depthBiasClamp",
        Feature::DepthBounds => "depthBounds",
        Feature::DepthClamp => "depthClamp",
        Feature::DualSourceBlending => "dualSrcBlend",
        Feature::FirstInstance => "drawIndirectFirstInstance",
        Feature::FragmentInvocations => "pipelineStatisticsQuery",
        Feature::FragmentStorage | Feature::StorageCounters => "fragmentStoresAndAtomics",
        Feature::IndependentBlend => "independentBlend",
        Feature::InheritedQueries => "inheritedQueries",
        Feature::LogicOperations => "logicOp",
        Feature::MinSampleShading | Feature::SampleShading => "sampleRateShading",
        Feature::PolygonModeLine => "fillModeNonSolid",
        Feature::PreciseOcclusion => "occlusionQueryPrecise",
        Feature::Tessellation | Feature::UpperLeftDomain => "tessellationShader",
        _ => return None,
    })
}

/// Adds the resolve mode of depth or stencil that a scene's feature needs.
fn resolve(feature: Feature, needs: &mut VulkanNeeds) {
    match feature {
        Feature::DepthResolveAverage => {
            needs.depth_resolve |= vk::ResolveModeFlags::AVERAGE.as_raw();
        }
        Feature::DepthResolveMin => needs.depth_resolve |= vk::ResolveModeFlags::MIN.as_raw(),
        Feature::DepthResolveMax => needs.depth_resolve |= vk::ResolveModeFlags::MAX.as_raw(),
        Feature::StencilResolveMin => needs.stencil_resolve |= vk::ResolveModeFlags::MIN.as_raw(),
        Feature::StencilResolveMax => needs.stencil_resolve |= vk::ResolveModeFlags::MAX.as_raw(),
        Feature::IndependentResolve => needs.independent_resolve = true,
        Feature::IndependentResolveNone => needs.independent_resolve_none = true,
        _ => {}
    }
}

/// Returns the extension that a scene's feature needs.
fn extension(feature: Feature) -> Option<&'static str> {
    Some(match feature {
        Feature::AdvancedBlend | Feature::AdvancedBlendCoherent => {
            "VK_EXT_blend_operation_advanced"
        }
        Feature::LastProvokingVertex | Feature::MixedProvokingVertices => "VK_EXT_provoking_vertex",
        Feature::OwnPassReadsInOrder => "VK_EXT_rasterization_order_attachment_access",
        Feature::StencilExport => "VK_EXT_shader_stencil_export",
        _ => return None,
    })
}
