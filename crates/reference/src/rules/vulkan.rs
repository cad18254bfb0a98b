//! Vulkan's permissions, by version and by the properties that change them.

use super::permission::{
    AlphaToCoverage, BiasUnit, BlendPrecision, ConstantClamp, Copies, DepthOrder, DepthRange,
    DepthTerms, EarlyUpdates, FactorClamp, FlushedFloats, FragCoord, InputMaskRule, MaskOfOne,
    NegativeAlpha, Resolve, Rounding, Rules, SameDepth, SamplesCounted, SharedEdge, SignedClamp,
    SmallFloats, Snap, SrgbLogic, narrowed, permit, step,
};
use etalon_frame::{Grade, Limits, Property};

/// Returns the name of the specification that binds a version.
fn text(limits: &Limits) -> &'static str {
    match (limits.version.major, limits.version.minor) {
        (1, 0) => "Vulkan 1.0",
        (1, 1) => "Vulkan 1.1",
        (1, 2) => "Vulkan 1.2",
        (1, 3) => "Vulkan 1.3",
        _ => "Vulkan 1.4",
    }
}

/// Returns the rules of Vulkan for an adapter. One entry per permission, with its citation.
pub(super) fn rules(limits: &Limits) -> Rules {
    // Whether the promises of these apply: maintenance5 and Vulkan 1.4; specifications up to 1.3.216;
    // maintenance2 and Vulkan 1.1.
    let coverage_last = limits.properties.contains(&Property::CoverageAfterCounting);
    let shades_last = limits.properties.contains(&Property::ShadesAfterCounting);
    let mask_first = limits.properties.contains(&Property::MaskBeforeCounting);
    let discards_points = limits.properties.contains(&Property::DiscardsPointsOutside);
    let outside = if discards_points {
        "Vulkan: Primitive Clipping, VK_POINT_CLIPPING_BEHAVIOR_ALL_CLIP_PLANES: a point outside of any clip plane is discarded"
    } else {
        "Vulkan: Primitive Clipping: a point outside of the clip volume may be discarded"
    };
    let happens = |cited: &'static str| {
        if coverage_last {
            permit(
                EarlyUpdates::Happen,
                "Vulkan: Fragment Operations, earlyFragmentMultisampleCoverageAfterSampleCounting is true: with EarlyFragmentTests shading and multisample coverage follow sample counting",
            )
        } else if shades_last {
            narrowed(
                EarlyUpdates::Happen,
                EarlyUpdates::Either,
                Grade::Disputed,
                "Vulkan: Fragment Operations: up to 1.3.216 shading and multisample coverage are performed after sample counting with EarlyFragmentTests; later they should be, and may precede it",
            )
        } else {
            permit(EarlyUpdates::Either, cited)
        }
    };
    let strict_lines = limits
        .properties
        .contains(&Property::LinesAreParallelograms);
    Rules {
        name: "vulkan",
        text: text(limits),
        float_error: permit(
            1e-5,
            "Vulkan: Fundamentals, Floating-Point Computation: accurate to about 1 part in 10^5",
        ),
        shader_error: permit(
            3.0 * f64::from(f32::EPSILON),
            "Vulkan: Precision and Operation of SPIR-V Instructions: sums and products correctly rounded, quotients within 2.5 ULP",
        ),
        decode_error: permit(
            1e-5,
            "Vulkan: Fundamentals, Conversion from Normalized Fixed-Point to Floating-Point, at the \
             accuracy of Floating-Point Computation",
        ),
        restarts_before_base_vertex: permit(
            true,
            "Vulkan: Drawing Commands, primitiveRestartEnable: the index is compared before vertexOffset is added",
        ),
        sub_pixel_bits: permit(
            limits.sub_pixel_bits,
            "Vulkan: Limits, subPixelPrecisionBits: at least 4",
        ),
        viewport_step: permit(
            step(limits.viewport_bits.unwrap_or(0)),
            "Vulkan: Limits, viewportSubPixelBits: the bits of precision in the bounds of viewports, which can be 0",
        ),
        snap: permit(
            Snap::EitherSide,
            "Vulkan: Limits, subPixelPrecisionBits: the rounding to the grid is not stated",
        ),
        shared_edge: permit(
            SharedEdge::ExactlyOne,
            "Vulkan: Basic Polygon Rasterization: a common edge with identical end points gives \
             exactly one fragment per sample",
        ),
        covers_at_positions: permit(
            true,
            "Vulkan: Multisampling: with standardSampleLocations samples lie at the standard locations",
        ),
        store: permit(
            Rounding::EitherNeighbour,
            "Vulkan: Fundamentals, Conversion from Floating-Point to Normalized Fixed-Point: one of \
             the two closest values, an integer exactly",
        ),
        float32_blend_error: permit(
            f64::from(f32::EPSILON),
            "Vulkan: Blending: precision and dynamic range no lower than that used to represent destination components",
        ),
        weights_by_channel: narrowed(
            true,
            false,
            Grade::Disputed,
            "Vulkan: Blending: precision no lower than that used to represent destination components (read as: of the component that is computed)",
        ),
        blends_in_order: narrowed(
            true,
            false,
            Grade::Disputed,
            "Vulkan: Blend Factors, Blend Operations: equations of products and their sum (read as the order of computing)",
        ),
        advanced_blend: permit(
            BlendPrecision::DestinationCodes,
            "Vulkan: Blending: advanced operations with precision and dynamic range no lower than the \
             smaller of the destination's and that of 16-bit floats",
        ),
        blend: narrowed(
            BlendPrecision::DestinationCodes,
            BlendPrecision::AnySteps,
            Grade::Disputed,
            "Vulkan: Blending: precision and dynamic range no lower than that used to represent destination components (read as one representation throughout)",
        ),
        signed_clamp: permit(
            SignedClamp::Signed,
            "Vulkan: Blending: clamped to [0,1] or [-1,1], as the attachment is unsigned or signed",
        ),
        signed_result: permit(
            SignedClamp::Signed,
            "Vulkan: Fundamentals, Conversion from Floating-Point to Normalized Fixed-Point: clamped to [-1,1] for signed formats",
        ),
        constant_clamp: permit(
            ConstantClamp::Never,
            "Vulkan: Blend Factors: the constant is clamped for normalized attachments alone",
        ),
        one_is_first_output: permit(
            true,
            "Vulkan: Multisample Coverage: all alpha values of the section are those of the output at location 0, index 0",
        ),
        quotients_beyond_one: narrowed(
            true,
            false,
            Grade::Disputed,
            "Vulkan: Advanced Blend Operations: the base colours are quotients by alpha; precision and dynamic range are the destination's, which a quotient above 1 exceeds",
        ),
        negative_alpha: narrowed(
            NegativeAlpha::IfNormalized,
            NegativeAlpha::Undefined,
            Grade::Disputed,
            "Vulkan: Advanced Blend Operations (since 1.1.120): undefined if any input or result alpha is negative; whether before or after the clamp of normalized attachments is not stated",
        ),
        masks_reference: permit(
            true,
            "Vulkan: Stencil Test: reference and stored value are both masked",
        ),
        copies: permit(
            Copies::Exact,
            "Vulkan: Copy Commands: texels are copied as they are stored",
        ),
        srgb_logic: permit(
            SrgbLogic::PassesThrough,
            "Vulkan: Logical Operations: not applied to sRGB and floating-point attachments",
        ),
        depth_order: permit(
            DepthOrder::Either,
            "Vulkan: Depth Comparison: whether the incoming depth is converted first is not stated",
        ),
        depth_bias_unit: permit(
            BiasUnit {
                unorm16: &[(0.999, 2.001)],
                unorm: &[(0.999, 2.001)],
                float: &[(0.999, 1.001)],
                assumed: None,
            },
            "Vulkan: Depth Bias Computation: for fixed point one r for the whole attachment, at most 2 * 2^-n; for floats 2^(e-n), n the bits of the mantissa, 23 (where fixed-point steps stand in for floats, the text takes one bit more than the mantissa's)",
        ),
        slope_root: permit(
            true,
            "Vulkan: Depth Bias Computation: the root of the squares, which may be approximated by the larger growth",
        ),
        bias_clamps_fragments: permit(
            true,
            "Vulkan: Depth Bias, Depth Clamping and Range Adjustment: fragments are biased, and clamped behind",
        ),
        depth_terms: permit(
            DepthTerms::NearPlane,
            "Vulkan: Controlling the Viewport: depth times maxDepth - minDepth, and minDepth",
        ),
        depth_range: permit(
            DepthRange::Undefined,
            "Vulkan: Depth Clamping and Range Adjustment: outside of the range of minDepth and maxDepth it is undefined",
        ),
        factor_clamp: narrowed(
            FactorClamp::Clamped,
            FactorClamp::Either,
            Grade::Disputed,
            "Vulkan: Blending: factors are clamped for fixed-point attachments (the CTS's reference renderer and Direct3D 11.3 17.5 leave signed ones unclamped)",
        ),
        resolve: narrowed(
            // Render passes resolve by a mode. `vkCmdResolveImage` may choose one, which makes no difference
            // if all samples of a texel are equal: paths that call it require that.
            Resolve::CoarseAverage,
            Resolve::BetweenOrFirst,
            Grade::Disputed,
            "Vulkan: VkResolveModeFlagBits: VK_RESOLVE_MODE_AVERAGE_BIT gives the average of the samples, its precision implementation-defined (read as: no coarser than the format's codes in any halving), sRGB samples made linear first if the implementation does as it should; VK_RESOLVE_MODE_SAMPLE_ZERO_BIT, of integers, gives sample 0",
        ),
        clips_points: permit(discards_points, outside),
        clips_points_at_sides: permit(discards_points, outside),
        clips_lines_at_sides: permit(
            false,
            "Vulkan: Primitive Clipping: a line with an end outside of the clip volume may be clipped",
        ),
        clips_lines_by_depth: narrowed(
            true,
            false,
            Grade::RequiredByCts,
            "Vulkan: Primitive Clipping: a line with an end outside of the clip volume may be clipped; dEQP-VK.clipping.clip_volume.outside.line_list and depth_clamp.line_list demand that nothing beyond the near and far planes is drawn",
        ),
        keeps_lines_that_end_behind: narrowed(
            true,
            false,
            Grade::Disputed,
            "Vulkan: Primitive Clipping: primitives are clipped to the clip volume; a line with an end outside of it may be clipped, and without clipping the division by a negative w gives another line",
        ),
        clips_lines_by_distance: narrowed(
            true,
            false,
            Grade::Disputed,
            "Vulkan: Primitive Clipping: primitives are clipped to the clip volume, of which clip distances are a part; a line with an end outside of it may be clipped",
        ),
        lines_cover_texels: if strict_lines {
            permit(
                true,
                "Vulkan: Basic Line Segment Rasterization: with strictLines, or nonStrictSinglePixelWideLinesUseParallelogram, a line covers the samples of its rectangle or parallelogram",
            )
        } else {
            narrowed(
                true,
                false,
                Grade::Disputed,
                "Vulkan: Bresenham Line Segment Rasterization, which lines that are not strict may follow: a fragment may deviate by one unit from that of the diamond-exit rule, and one may be missing (read as: at the ends, and beside slanted lines)",
            )
        },
        lines_cover_their_shape: if strict_lines {
            permit(
                true,
                "Vulkan: Basic Line Segment Rasterization: with strictLines, or nonStrictSinglePixelWideLinesUseParallelogram, coverage bits of samples in the rectangle or parallelogram are 1, others are 0",
            )
        } else {
            permit(
                false,
                "Vulkan: Bresenham Line Segment Rasterization, which lines that are not strict may follow: a fragment may deviate by one unit from that of the diamond-exit rule",
            )
        },
        lines_lack: permit(
            Some(1),
            "Vulkan: Bresenham Line Segment Rasterization: the number of fragments differs by at most one from that of the diamond-exit rule; rectangles and parallelograms have one in each column",
        ),
        biases_lines: permit(
            true,
            "Vulkan: Depth Bias Computation: may also be applied to line and point topology primitives",
        ),
        points_face_front: permit(
            true,
            "Vulkan: Fragment Shading, FrontFacing: fragments of other primitives than polygons are front-facing",
        ),
        outlines_face_as_polygons: permit(
            true,
            "Vulkan: FrontFacing, Stencil Test: a fragment that a polygon generates faces as the polygon, whatever the polygon mode",
        ),
        early_updates: if coverage_last {
            happens("")
        } else {
            narrowed(
                EarlyUpdates::Happen,
                EarlyUpdates::Either,
                Grade::RequiredByCts,
                "Vulkan: Fragment Operations: with EarlyFragmentTests shading should follow sample counting, but may precede it; dEQP-VK.fragment_operations.early_fragment.discard_early_fragment_tests_depth demands the updates",
            )
        },
        early_coverage: happens(
            "Vulkan: Fragment Operations: with EarlyFragmentTests multisample coverage should follow sample counting, but may precede it",
        ),
        early_mask: if coverage_last {
            happens("")
        } else {
            narrowed(
                EarlyUpdates::Happen,
                EarlyUpdates::Either,
                Grade::RequiredByCts,
                "Vulkan: Fragment Operations: with EarlyFragmentTests multisample coverage should follow sample counting, but may precede it; dEQP-VK.fragment_operations.early_fragment.samplemask_early_fragment_tests_depth_samples_* demands the updates",
            )
        },
        early_ignores_written: if coverage_last {
            permit(
                true,
                "Vulkan: Fragment Operations, earlyFragmentMultisampleCoverageAfterSampleCounting is true: with EarlyFragmentTests shading follows the tests",
            )
        } else {
            narrowed(
                true,
                false,
                Grade::Disputed,
                "Vulkan: Fragment Operations: up to 1.3.216 shading is performed after sample counting with EarlyFragmentTests; later it should be, and may precede the tests",
            )
        },
        covers_one_sample: permit(
            true,
            "Vulkan: Sample Mask Test, Multisample Coverage: for every fragment, whatever the number of samples",
        ),
        mask_of_one: permit(
            MaskOfOne::Acts,
            "Vulkan: Multisample Coverage: the coverage mask is ANDed with SampleMask, whatever the number of samples",
        ),
        goes_on_unshaded: permit(
            true,
            "Vulkan: Fragment Shading: without a fragment shader none is executed, and the values of colour attachments alone are undefined",
        ),
        input_mask: permit(
            InputMaskRule::OfRun,
            "Vulkan: Sample Mask: the coverage mask of the fragment, with sample shading of the samples being shaded alone",
        ),
        input_mask_lacks_masked: narrowed(
            true,
            false,
            Grade::RequiredByCts,
            "Vulkan: Sample Mask: coverage as calculated by the operations before shading, among them the sample mask test; SampleMask: the samples covered during rasterization; dEQP-VK.pipeline.*.multisample_shader_builtin.sample_mask.pattern demands that bits are lost",
        ),
        mask_acts_first: if mask_first {
            permit(
                true,
                "Vulkan: Fragment Operations, earlyFragmentSampleMaskTestBeforeSampleCounting is true: the sample mask test keeps its place before all tests",
            )
        } else if shades_last {
            narrowed(
                true,
                false,
                Grade::Disputed,
                "Vulkan: Fragment Operations: up to 1.3.216 the sample mask test precedes all tests, early ones too; later it may follow sample counting",
            )
        } else {
            permit(
                false,
                "Vulkan: Fragment Operations: with EarlyFragmentTests the sample mask test may follow sample counting",
            )
        },
        early_counts: happens(
            "Vulkan: Fragment Operations: with EarlyFragmentTests shading and multisample coverage should follow sample counting, but may precede it",
        ),
        samples_counted: permit(
            SamplesCounted::Passing,
            "Vulkan: Sample Counting: each sample with a coverage of 1 that survives all tests, with VK_QUERY_CONTROL_PRECISE_BIT",
        ),
        clears_count_nothing: narrowed(
            true,
            false,
            Grade::RequiredByCts,
            "Vulkan: Queries: clears may count towards the results of queries; dEQP-VK.query_pool.occlusion_query.clear_attachments_only (mustpass) demands 0",
        ),
        operations_count_nothing: permit(
            false,
            "Vulkan: Queries: resolves, and load and store operations may count towards the results of queries",
        ),
        same_depth: narrowed(
            SameDepth::Written,
            SameDepth::WrittenAsFloat,
            Grade::Disputed,
            "Vulkan: Invariance, Rule 5: shaders that assign FragCoord.z to FragDepth are depth-invariant with respect to each other (read as: such depths compare as equal; Depth Comparison does not say that an incoming depth is converted first)",
        ),
        filter_step: permit(
            step(limits.texel_bits.unwrap_or(4)),
            "Vulkan: Limits, subTexelPrecisionBits (at least 4) is the number of divisions that coordinates snap to; the rounding to them is not stated",
        ),
        filters_to_codes: permit(
            true,
            "Vulkan: Texel Filtering, silent on the precision of a filtered value (read as: no coarser than the format's codes in any step)",
        ),
        half_overflows: permit(
            true,
            "Vulkan: Fundamentals, Floating-Point Format Conversions: the largest finite value or infinity",
        ),
        flushes_small_floats: permit(
            FlushedFloats::None,
            "Vulkan: Fundamentals, Floating-Point Format Conversions: representable finite values are kept; Blending: dynamic range no lower than that used to represent destination components",
        ),
        small_floats: permit(
            SmallFloats::EitherNeighbour,
            "Vulkan: Fundamentals, Floating-Point Format Conversions: either neighbour; past the largest value that or infinity",
        ),
        runs_for_discarded: permit(
            true,
            "Vulkan: Fragment Shading: at least one run for every fragment that no operation before shading discards, where the shader writes storage",
        ),
        runs_for_overwritten: permit(
            true,
            "Vulkan: Fragment Shading: a fragment may go without a run if a later one overwrites all its results, storage too; an atomic addition is not overwritten",
        ),
        skips_rejected: if coverage_last {
            permit(
                true,
                "Vulkan: Fragment Shading: no run for a fragment that an operation before shading discards; earlyFragmentMultisampleCoverageAfterSampleCounting puts the tests first",
            )
        } else {
            narrowed(
                true,
                false,
                Grade::RequiredByCts,
                "Vulkan: Fragment Operations: with EarlyFragmentTests shading should follow sample counting, but may precede it; dEQP-VK.fragment_operations.early_fragment.early_fragment_tests_depth demands that no run precedes it",
            )
        },
        runs_once: permit(
            false,
            "Vulkan: Fragment Shading: more runs than one for implementation-dependent reasons",
        ),
        samples_as_told: permit(
            true,
            "Vulkan: Multisampling: rasterizationSamples is the number of samples",
        ),
        runs_by_share: permit(
            true,
            "Vulkan: Sample Shading: at least ceil(minSampleShading x rasterizationSamples) runs per fragment",
        ),
        alpha_to_coverage: narrowed(
            AlphaToCoverage::Ends,
            AlphaToCoverage::Any,
            Grade::RequiredByCts,
            "Vulkan: Multisample Coverage: intended that alpha 0 gives no sample and alpha 1 all; dEQP-VK.pipeline.*.multisample.alpha_to_coverage.* demands the ends",
        ),
        colorless_alpha_to_coverage: narrowed(
            AlphaToCoverage::Opaque,
            AlphaToCoverage::Any,
            Grade::RequiredByCts,
            "Vulkan: Multisample Coverage: intended that alpha 0 gives no sample and alpha 1 all; dEQP-VK.pipeline.*.multisample.alpha_to_coverage_no_color_attachment.* demands that alpha 1 gives all",
        ),
        sample_coverage: permit(
            AlphaToCoverage::Ends,
            "Vulkan: has no sample coverage; as OpenGL 4.6: 14.9.3",
        ),
        frag_coord: permit(
            FragCoord::Sample,
            "Vulkan: FragCoord: the centre of the fragment, or with sample shading the location of one of the samples of the run",
        ),
        inputs_at_samples: permit(
            false,
            "Vulkan: Interpolation Decorations: an implementation-defined position within the fragment, unless decorated",
        ),
        facing: "Vulkan: Basic Polygon Rasterization: front by the sign of the area; zero area is \
                 not front",
        own_pass: "Vulkan: Render Pass, Synchronization Options: a barrier within a subpass, a dependency between two, or \
            rasterization order puts earlier attachment writes before the reads of the same sample",
        stencil: "Vulkan: Stencil Test: integer operations",
        write_mask: "Vulkan: Color Write Mask: components not written keep their value",
    }
}
