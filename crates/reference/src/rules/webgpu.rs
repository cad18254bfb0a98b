//! WebGPU's permissions, by the draft of 2026-11. If the draft is silent, the permissions of the underlying
//! APIs apply.

use super::permission::{
    AlphaToCoverage, BiasUnit, BlendPrecision, ConstantClamp, Copies, DepthOrder, DepthRange,
    DepthTerms, EarlyUpdates, FactorClamp, FlushedFloats, FragCoord, InputMaskRule, MaskOfOne,
    NegativeAlpha, Resolve, Rounding, Rules, SameDepth, SamplesCounted, SharedEdge, SignedClamp,
    SmallFloats, Snap, SrgbLogic, narrowed, permit,
};
use etalon_frame::{Grade, Limits};

/// Returns the rules of WebGPU for an adapter. One entry per permission, with its citation.
pub(super) fn rules(limits: &Limits) -> Rules {
    Rules {
        name: "webgpu",
        text: "WebGPU (editor's draft of 2026-11)",
        float_error: permit(
            1e-5,
            "WebGPU: silent on fixed-function accuracy; Vulkan and OpenGL: about 1 part in 10^5",
        ),
        shader_error: permit(
            3.0 * f64::from(f32::EPSILON),
            "WGSL: 15.7.4 Floating Point Accuracy: sums and products correctly rounded, quotients within 2.5 ULP",
        ),
        decode_error: permit(
            1e-5,
            "WebGPU: silent on normalized conversions; Vulkan and OpenGL: about 1 part in 10^5",
        ),
        restarts_before_base_vertex: narrowed(
            true,
            false,
            Grade::Disputed,
            "WebGPU: 23.2.1 Index Resolution adds the base vertex, 23.2.3 Primitive Assembly then splits strips; Vulkan and OpenGL compare before",
        ),
        sub_pixel_bits: permit(
            limits.sub_pixel_bits,
            "WebGPU: silent on the grid; Vulkan and OpenGL: at least 4 bits",
        ),
        viewport_step: permit(
            1.0,
            "WebGPU: silent on the precision of viewports; Vulkan: viewportSubPixelBits can be 0",
        ),
        snap: permit(
            Snap::EitherSide,
            "WebGPU: 23.2.5 Rasterization is silent on vertex snapping; Vulkan and OpenGL: at least \
             4 bits, rounding open",
        ),
        shared_edge: permit(
            SharedEdge::Independent,
            "WebGPU: 23.2.5.4 Polygon Rasterization: whether a sample on an edge is inside is not \
             defined",
        ),
        covers_at_positions: narrowed(
            true,
            false,
            Grade::Disputed,
            "WebGPU: 23.2.5 Rasterization: samples must lie at the standard patterns; 23.2.5.4 Polygon Rasterization: their positions are implementation-defined",
        ),
        store: permit(
            Rounding::EitherNeighbour,
            "WebGPU: silent on the rounding of stores; Vulkan and OpenGL: one of the two closest \
             values, an integer exactly",
        ),
        float32_blend_error: narrowed(
            f64::from(f32::EPSILON),
            1e-5,
            Grade::Disputed,
            "WebGPU: silent on blend precision; Vulkan and OpenGL: no lower than the destination's",
        ),
        weights_by_channel: narrowed(
            true,
            false,
            Grade::Disputed,
            "WebGPU: silent on blend precision; Vulkan and OpenGL: no lower than the destination's (read as: of the component that is computed)",
        ),
        blends_in_order: permit(
            false,
            "WebGPU: silent on the order of computing; Direct3D 11.3, 17.5: the operations of a blend may be fused and reordered",
        ),
        advanced_blend: permit(
            BlendPrecision::DestinationCodes,
            "WebGPU: has no advanced blending; Vulkan and OpenGL: no lower than 16-bit floats",
        ),
        blend: narrowed(
            BlendPrecision::DestinationCodes,
            BlendPrecision::AnySteps,
            Grade::Disputed,
            "WebGPU: silent on blend precision; Vulkan and OpenGL: no lower than the destination's (read as one representation throughout)",
        ),
        signed_clamp: permit(
            SignedClamp::Signed,
            "WebGPU: silent on clamping before a blend; Vulkan and OpenGL clamp to [-1,1] for signed formats",
        ),
        signed_result: permit(
            SignedClamp::Signed,
            "WebGPU: silent on stores to signed formats; Vulkan clamps to [-1,1]",
        ),
        constant_clamp: permit(
            ConstantClamp::Never,
            "WebGPU: 23.2.7 Output Merging: the constant is the one that was set",
        ),
        one_is_first_output: permit(
            true,
            "WebGPU: has no alpha to one; Vulkan: the first output's alpha alone",
        ),
        quotients_beyond_one: permit(
            false,
            "WebGPU: has no advanced blending; Vulkan: the dynamic range is the destination's",
        ),
        negative_alpha: permit(
            NegativeAlpha::Undefined,
            "WebGPU: has no advanced blending; Vulkan 1.4: undefined for negative alphas",
        ),
        masks_reference: narrowed(
            true,
            false,
            Grade::Disputed,
            "WebGPU: 10.3.6 Depth/Stencil State: stencilReadMask masks what is read; that the reference is masked too, as in Vulkan and OpenGL, no sentence says",
        ),
        copies: permit(
            Copies::SameNumbers,
            "WebGPU: 11 Copies, Texel Copies: -1 may be either of its codes; only finite, normal values survive",
        ),
        srgb_logic: permit(SrgbLogic::PassesThrough, "WebGPU: has no logic operations"),
        depth_order: permit(
            DepthOrder::Either,
            "WebGPU: 23.2.6 Fragment Processing is silent on the order of conversion and comparison",
        ),
        depth_bias_unit: narrowed(
            BiasUnit {
                unorm16: &[(0.999, 1.001)],
                unorm: &[(0.999, 2.001)],
                // Either as Vulkan, Direct3D and Metal define it, or as WebGPU literally says: 2^(exponent -
                // r) with r the least positive float, which is 2^exponent.
                float: &[(0.999, 1.001), (0.999 * 8_388_608.0, 1.001 * 8_388_608.0)],
                assumed: None,
            },
            // By the specification's "must" clauses alone, depth24plus can be a float, and the step of a
            // float can be any of these values.
            BiasUnit {
                unorm16: &[(0.999, 1.001)],
                unorm: &[(0.499, 16_777_216.0)],
                float: &[(0.499, 1.001 * 8_388_608.0)],
                assumed: None,
            },
            Grade::Disputed,
            "WebGPU: GPUDepthStencilState, biased fragment depth: r is the least positive value of a unorm format; which one depth24plus is, is not told, so as Vulkan has it; of floats 2^(e-23), or 2^e as the text says by its letter (gpuweb#6350)",
        ),
        slope_root: permit(
            false,
            "WebGPU: GPUDepthStencilState, biased fragment depth: the maximum of the horizontal and vertical slopes",
        ),
        bias_clamps_fragments: permit(
            true,
            "WebGPU: 23.2.5 Rasterization: the bias is added to the depth of fragments; Vulkan and OpenGL 4.6: clamped behind",
        ),
        depth_terms: narrowed(
            DepthTerms::NearPlane,
            DepthTerms::Middle,
            Grade::Disputed,
            "WebGPU: 23.2.5 Rasterization: minDepth, and depth times maxDepth - minDepth, with no precision; OpenGL's own clip volume, from -w to w, makes it of terms of a half",
        ),
        depth_range: permit(
            DepthRange::ViewportIfWritten,
            "WebGPU: 23.2.6 Fragment Processing, 23.2.7 Output Merging: held to the viewport's depth range, a biased depth before or after the test",
        ),
        factor_clamp: permit(
            FactorClamp::Either,
            "WebGPU: silent on clamping of blend factors; Vulkan clamps, Direct3D 11.3 does not for SNORM",
        ),
        resolve: permit(
            Resolve::Between,
            "WebGPU: GPURenderPassColorAttachment.resolveTarget: no resolve algorithm is stated",
        ),
        clips_points: permit(
            true,
            "WebGPU: 23.2.4 Primitive Clipping: primitives are clipped to the clip volume",
        ),
        clips_points_at_sides: permit(
            true,
            "WebGPU: 23.2.4 Primitive Clipping: primitives are clipped to the clip volume",
        ),
        clips_lines_at_sides: permit(
            true,
            "WebGPU: 23.2.4 Primitive Clipping: primitives are clipped to the clip volume",
        ),
        clips_lines_by_depth: permit(
            true,
            "WebGPU: 23.2.4 Primitive Clipping: primitives are clipped to the clip volume",
        ),
        keeps_lines_that_end_behind: permit(
            true,
            "WebGPU: 23.2.4 Primitive Clipping: primitives are clipped to the clip volume",
        ),
        clips_lines_by_distance: permit(
            true,
            "WebGPU: 23.2.4 Primitive Clipping: primitives are clipped to the clip volume, of which clip distances are a part",
        ),
        lines_cover_texels: narrowed(
            true,
            false,
            Grade::Disputed,
            "WebGPU: 23.2.5.2 Line Rasterization: the algorithm is not defined; by a rectangle, or by Bresenham's in which a fragment may deviate by one unit",
        ),
        lines_cover_their_shape: permit(
            false,
            "WebGPU: 23.2.5.2 Line Rasterization: the algorithm is not defined",
        ),
        lines_lack: permit(
            None,
            "WebGPU: 23.2.5.2 Line Rasterization: the algorithm is not defined",
        ),
        biases_lines: permit(
            false,
            "WebGPU: GPUDepthStencilState: a bias needs a triangle topology",
        ),
        points_face_front: permit(
            false,
            "WebGPU: 23.2.5: facing of points and lines is not asserted",
        ),
        outlines_face_as_polygons: permit(false, "WebGPU: has no polygon modes"),
        early_updates: permit(
            EarlyUpdates::Each,
            "WebGPU: has no forced early tests; OpenGL: depth and stencil may be updated",
        ),
        early_coverage: permit(
            EarlyUpdates::Each,
            "WebGPU: has no forced early tests; OpenGL: depth and stencil may be updated",
        ),
        early_mask: permit(
            EarlyUpdates::Each,
            "WebGPU: has no forced early tests; OpenGL: depth and stencil may be updated",
        ),
        early_ignores_written: permit(
            false,
            "WebGPU: has no forced early tests; Vulkan: shading may precede them",
        ),
        covers_one_sample: permit(
            true,
            "WebGPU: 23.2.11 Sample Masking: the final mask is that of the rasterization ANDed with multisample.mask; alphaToCoverageEnabled needs several samples",
        ),
        mask_of_one: permit(
            MaskOfOne::Acts,
            "WebGPU: 23.2.11 Sample Masking: the final mask is ANDed with the shader's, of which the lower count bits are considered",
        ),
        goes_on_unshaded: permit(
            true,
            "WebGPU: 23.2.8 No Color Output: depth test and stencil operations use the depth of the vertex position output",
        ),
        input_mask: permit(
            InputMaskRule::AllOrOwn,
            "WebGPU: WGSL, sample_mask: a bit for every sample that the fragment covers, or that of the run's sample alone",
        ),
        input_mask_lacks_masked: permit(
            false,
            "WebGPU: WGSL, sample_mask: the coverage mask of rasterization; silent on the pipeline's mask, which Vulkan applies before shading",
        ),
        mask_acts_first: permit(
            false,
            "WebGPU: has no forced early tests; Vulkan: the sample mask may act after them",
        ),
        early_counts: permit(
            EarlyUpdates::Either,
            "WebGPU: has no forced early tests; Vulkan and OpenGL: counts may be updated",
        ),
        samples_counted: permit(
            SamplesCounted::Passing,
            "WebGPU: queries tell zero from non-zero; a precise count is no part of it",
        ),
        clears_count_nothing: permit(
            true,
            "WebGPU: Occlusion Query: the samples that pass the tests of a set of drawing commands; nothing else is within one",
        ),
        operations_count_nothing: permit(
            true,
            "WebGPU: Occlusion Query: the samples that pass the tests of a set of drawing commands; nothing else is within one",
        ),
        same_depth: narrowed(
            SameDepth::Written,
            SameDepth::WrittenAsFloat,
            Grade::Disputed,
            "WebGPU: silent on invariance; Vulkan and OpenGL: shaders that write the fragment's own depth agree",
        ),
        filter_step: permit(
            1.0 / 16.0,
            "WebGPU: silent on the precision of filter weights; Vulkan: at least 4 bits",
        ),
        filters_to_codes: permit(
            true,
            "WebGPU: silent on the precision of a filtered value; read as Vulkan, no coarser than the format's codes in any step",
        ),
        half_overflows: permit(
            true,
            "WebGPU: silent on overflow; Vulkan: the largest finite value or infinity",
        ),
        flushes_small_floats: permit(
            FlushedFloats::All,
            "WebGPU: silent on small floats; OpenGL ES: those of 16, 11 and 10 bits may be forced to zero",
        ),
        small_floats: permit(
            SmallFloats::EitherNeighbour,
            "WebGPU: silent on conversion to small floats; Vulkan: either neighbour",
        ),
        runs_for_discarded: permit(
            true,
            "WebGPU: 23.2.6 Fragment Processing: skipped only where the shader writes to no storage binding",
        ),
        runs_for_overwritten: permit(
            true,
            "WebGPU: 23.2.6 Fragment Processing: skipped only where the shader writes to no storage binding, overwritten or not",
        ),
        skips_rejected: permit(
            false,
            "WebGPU: has no forced early tests; Vulkan: shading may precede them",
        ),
        runs_once: permit(
            false,
            "WebGPU: silent on additional runs; Vulkan permits them",
        ),
        samples_as_told: permit(
            true,
            "WebGPU: GPUMultisampleState: count is the number of samples",
        ),
        runs_by_share: permit(false, "WebGPU: has no least share of sample shading"),
        alpha_to_coverage: permit(
            AlphaToCoverage::Ends,
            "WebGPU: 23.2.9 Alpha to Coverage: alpha 0 gives no sample and alpha 1 all",
        ),
        colorless_alpha_to_coverage: permit(
            AlphaToCoverage::Ends,
            "WebGPU: 10.3.1 Render Pipeline Creation: alpha to coverage requires a colour target",
        ),
        sample_coverage: permit(
            AlphaToCoverage::Ends,
            "WebGPU: has no sample coverage; as OpenGL 4.6: 14.9.3",
        ),
        frag_coord: permit(
            FragCoord::Inputs,
            "WebGPU: silent on the point of several samples; OpenGL 4.6, 14.3.1 leaves it open",
        ),
        inputs_at_samples: permit(
            false,
            "WebGPU: silent on sample shading by a share; Vulkan leaves the point open",
        ),
        facing: "WebGPU: 23.2.5.4 Polygon Rasterization: front by the sign of the area; zero area \
                 is back",
        own_pass: "WebGPU: Resource Usages: no pass reads what it writes",
        stencil: "WebGPU: 23.2.7 Output Merging: integer operations",
        write_mask: "WebGPU: GPUColorWrite: channels not written keep their value",
    }
}
