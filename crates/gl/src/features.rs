//! The features of a context.

use crate::context::Context;
use crate::own_pass;
use etalon_frame::Feature;
use std::collections::BTreeSet;

/// Returns the features that a context's version and extensions define.
pub(crate) fn features(context: &Context) -> BTreeSet<Feature> {
    let (caps, entry_points) = (&context.caps, &context.entry_points);
    let known = |feature: &Feature| match feature {
        Feature::ClipDistances | Feature::ClipDistanceMask => caps.clip_distances,
        Feature::CullDistances => caps.cull_distances,
        // OpenGL has no command buffers.
        Feature::InheritedQueries => false,
        // These are part of version 3.
        Feature::CentroidInterpolation
        | Feature::ClearCommands
        | Feature::ConstantAlphaBlendFactor
        | Feature::DepthOutputWithoutDepth
        | Feature::FrontAndBackCulling
        | Feature::AlphaToCoverageOfOneSample
        | Feature::AlphaToCoverageWithoutAlpha
        | Feature::LastProvokingVertex
        | Feature::MaskedClears
        | Feature::MinMaxBlendFactors
        | Feature::QueriesOverPasses
        | Feature::RasterizerDiscard
        | Feature::ReversedDepthRange
        | Feature::SampleCoverage
        | Feature::ScissorOutside
        | Feature::SeparateStencilMasks
        | Feature::TriangleFans
        | Feature::ViewportOutside => true,
        Feature::BaseVertex => entry_points.draw_elements_base_vertex.is_some(),
        Feature::FirstInstance => entry_points.draw_arrays_instanced_base_instance.is_some(),
        Feature::AdvancedBlend => entry_points.blend_barrier.is_some(),
        Feature::AdvancedBlendCoherent => caps.coherent_blend,
        Feature::AlphaToOne => caps.alpha_to_one,
        Feature::ConservativeDepth => caps.conservative_depth,
        Feature::DepthBiasClamp => entry_points.polygon_offset_clamp.is_some(),
        Feature::DepthBounds => entry_points.depth_bounds.is_some(),
        Feature::DepthClamp => caps.depth_clamp,
        Feature::DualSourceBlending => caps.dual_source,
        Feature::ForcedEarlyTests => caps.early_tests,
        // In ES, such a shader must not write `gl_FragDepth` (GLSL ES 3.20, 4.4.1, Fragment Shader Inputs).
        Feature::ForcedEarlyTestsWithDepth => caps.early_tests && !caps.es,
        // Without viewport arrays, the place and size of a viewport are integers.
        Feature::FractionalViewport => caps.viewport_bits.is_some(),
        Feature::FragmentInvocations => caps.fragment_invocations,
        Feature::IndependentBlend => caps.indexed_blend,
        Feature::FirstProvokingVertex | Feature::MixedProvokingVertices => {
            entry_points.provoking_vertex.is_some()
        }
        // ES has no `noperspective` (GLSL ES 3.20, 4.5).
        Feature::LinearInterpolation => !caps.es,
        Feature::LogicOperations => entry_points.logic_op.is_some(),
        Feature::MinSampleShading => entry_points.min_sample_shading.is_some(),
        Feature::Tessellation => caps.tessellation.is_some(),
        // The origin of the domain is always its lower left corner (OpenGL 4.6, figure 11.1).
        Feature::UpperLeftDomain => false,
        // Viewport heights are positive.
        Feature::MirroredViewport => false,
        // A blit leaves open which sample it takes (OpenGL 4.6, 18.3.1; ES 3.2, 16.2.1).
        Feature::DepthResolveAverage
        | Feature::DepthResolveMax
        | Feature::DepthResolveMin
        | Feature::DepthStencilResolve
        | Feature::IndependentResolve
        | Feature::IndependentResolveNone
        | Feature::StencilResolveMax
        | Feature::StencilResolveMin => false,
        Feature::OwnPassReads
        | Feature::OwnPassReadsInOrder
        | Feature::OwnPassDepthReads
        | Feature::OwnPassStencilReads => own_pass::supports(context, *feature),
        // ES has no `glPolygonMode`.
        Feature::PolygonModeLine => !caps.es,
        Feature::PreciseOcclusion => caps.samples_passed,
        Feature::SampleInterpolation
        | Feature::SampleMaskInput
        | Feature::SampleMaskOutput
        | Feature::SampleMaskOutputWithAlphaToCoverage
        | Feature::SampleShading => caps.sample_variables,
        // In ES, a program without a fragment shader does not link (OpenGL ES 3.2, 7.3).
        Feature::FragmentShaderAbsent | Feature::FragmentShaderAbsentWithColor => !caps.es,
        Feature::StencilExport => caps.stencil_export,
        Feature::FragmentStorage | Feature::StorageCounters => caps.storage_alignment.is_some(),
    };
    Feature::ALL.into_iter().filter(known).collect()
}
