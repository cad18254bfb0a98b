//! OpenGL ES's permissions, by version: 3.0, 3.1 and 3.2.

use super::permission::{
    AlphaToCoverage, BiasUnit, BlendPrecision, ConstantClamp, Copies, DepthOrder, DepthRange,
    DepthTerms, EarlyUpdates, FactorClamp, FlushedFloats, FragCoord, InputMaskRule, MaskOfOne,
    NegativeAlpha, Resolve, Rounding, Rules, SameDepth, SamplesCounted, SharedEdge, SignedClamp,
    SmallFloats, Snap, SrgbLogic, narrowed, permit, step,
};
use etalon_frame::{ApiVersion, Grade, Limits, Property};

/// The specification that binds a context.
#[derive(Clone, Copy, PartialEq, Eq)]
enum OpenGlEsText {
    V30,
    V31,
    V32,
}

impl OpenGlEsText {
    fn of(version: ApiVersion) -> Self {
        match (version.major, version.minor) {
            (3, 0) => Self::V30,
            (3, 1) => Self::V31,
            _ => Self::V32,
        }
    }

    /// Returns the citation for this version out of those for 3.0, 3.1 and 3.2.
    fn cite(self, [v30, v31, v32]: [&'static str; 3]) -> &'static str {
        match self {
            Self::V30 => v30,
            Self::V31 => v31,
            Self::V32 => v32,
        }
    }
}

/// Returns the rules of OpenGL ES for an adapter. One entry per permission, with its citation.
pub(super) fn rules(limits: &Limits) -> Rules {
    let text = OpenGlEsText::of(limits.version);
    let only_draws_count = text.cite([
            "OpenGL ES 3.0: 4.1.6 Occlusion Queries: the fragments or samples that pass the depth test; 4.2.3, 4.3.3: clears and blits make none",
            "OpenGL ES 3.1: 15.1.4 Occlusion Queries: the fragments or samples that pass the depth test; 15.2.3, 16.2.1: clears and blits make none",
            "OpenGL ES 3.2: 15.1.4 Occlusion Queries: the fragments or samples that pass the depth test; 15.2.3, 16.2.1: clears and blits make none",
        ]);
    Rules {
        name: "opengl-es",
        text: text.cite(["OpenGL ES 3.0", "OpenGL ES 3.1", "OpenGL ES 3.2"]),
        float_error: permit(
            1e-5,
            text.cite([
                "OpenGL ES 3.0: 2.1.1 Floating-Point Computation: accurate to about 1 part in 10^5",
                "OpenGL ES 3.1: 2.3.3.1 Floating-Point Computation: accurate to about 1 part in 10^5",
                "OpenGL ES 3.2: 2.3.4.1 Floating-Point Computation: accurate to about 1 part in 10^5",
            ]),
        ),
        shader_error: permit(
            3.0 * f64::from(f32::EPSILON),
            text.cite([
                "OpenGL ES Shading Language 3.00: 4.5.1 Range and Precision: sums and products correctly rounded, quotients within 2.5 ULP",
                "OpenGL ES Shading Language 3.10: 4.7.1 Range and Precision: sums and products correctly rounded, quotients within 2.5 ULP",
                "OpenGL ES Shading Language 3.20: 4.7.1 Range and Precision: sums and products correctly rounded, quotients within 2.5 ULP",
            ]),
        ),
        decode_error: permit(
            1e-5,
            text.cite([
                "OpenGL ES 3.0: 2.1.6.1 Conversion from Normalized Fixed-Point to Floating-Point, at the accuracy of 2.1.1",
                "OpenGL ES 3.1: 2.3.4.1 Conversion from Normalized Fixed-Point to Floating-Point, at the accuracy of 2.3.3",
                "OpenGL ES 3.2: 2.3.5.1 Conversion from Normalized Fixed-Point to Floating-Point, at the accuracy of 2.3.4",
            ]),
        ),
        restarts_before_base_vertex: permit(
            true,
            "OpenGL ES 3.2: 10.3.4 Primitive Restart: the index is tested before the base vertex is added",
        ),
        sub_pixel_bits: permit(limits.sub_pixel_bits, text.cite([
                "OpenGL ES 3.0: tables of chapter 6, SUBPIXEL_BITS: at least 4",
                "OpenGL ES 3.1: table 20.40 SUBPIXEL_BITS: at least 4",
                "OpenGL ES 3.2: table 21.40 SUBPIXEL_BITS: at least 4",
            ])),
        viewport_step: permit(
            step(limits.viewport_bits.unwrap_or(0)),
            text.cite([
                "OpenGL ES 3.0: 2.13.1 Controlling the Viewport: bounds are integers",
                "OpenGL ES 3.1: 12.5.1 Controlling the Viewport: bounds are integers; GL_OES_viewport_array: the precision of bounds is VIEWPORT_SUBPIXEL_BITS, which can be 0",
                "OpenGL ES 3.2: 12.6.1 Controlling the Viewport: bounds are integers; GL_OES_viewport_array: the precision of bounds is VIEWPORT_SUBPIXEL_BITS, which can be 0",
            ]),
        ),
        snap: permit(
            Snap::EitherSide,
            text.cite([
                "OpenGL ES 3.0: tables of chapter 6, SUBPIXEL_BITS: the rounding to the grid is not stated",
                "OpenGL ES 3.1: table 20.40 SUBPIXEL_BITS: the rounding to the grid is not stated",
                "OpenGL ES 3.2: table 21.40 SUBPIXEL_BITS: the rounding to the grid is not stated",
            ]),
        ),
        shared_edge: permit(
            SharedEdge::ExactlyOne,
            text.cite([
                "OpenGL ES 3.0: 3.6.1 Basic Polygon Rasterization: a common edge with identical end points gives exactly one fragment",
                "OpenGL ES 3.1: 13.5.1 Basic Polygon Rasterization: a common edge with identical end points gives exactly one fragment",
                "OpenGL ES 3.2: 13.7.1 Basic Polygon Rasterization: a common edge with identical end points gives exactly one fragment",
            ]),
        ),
        covers_at_positions: narrowed(
            true,
            false,
            Grade::Disputed,
            "OpenGL ES: 13.4 Multisampling (3.1: 13.2.1): the locations that are queried are those of shading; those of coverage need not be the same",
        ),
        store: permit(
            Rounding::EitherNeighbour,
            text.cite([
                "OpenGL ES 3.0: 2.1.6.2 Conversion from Floating-Point to Normalized Fixed-Point: one of the two closest values, an integer exactly",
                "OpenGL ES 3.1: 2.3.4.2 Conversion from Floating-Point to Normalized Fixed-Point: one of the two closest values, an integer exactly",
                "OpenGL ES 3.2: 2.3.5.2 Conversion from Floating-Point to Normalized Fixed-Point: one of the two closest values, an integer exactly",
            ]),
        ),
        float32_blend_error: permit(
            f64::from(f32::EPSILON),
            text.cite([
                "OpenGL ES 3.0: 4.1.7.1 Blend Equation: precision and dynamic range no lower than that used to represent destination components",
                "OpenGL ES 3.1: 15.1.5.1 Blend Equation: precision and dynamic range no lower than that used to represent destination components",
                "OpenGL ES 3.2: 15.1.5.1 Blend Equation: precision and dynamic range no lower than that used to represent destination components",
            ]),
        ),
        weights_by_channel: narrowed(
            true,
            false,
            Grade::Disputed,
            "OpenGL ES: 15.1.5.1 Blend Equation (3.0: 4.1.7.1): precision no lower than that used to represent destination components (read as: of the component that is computed)",
        ),
        blends_in_order: narrowed(
            true,
            false,
            Grade::Disputed,
            "OpenGL ES: 15.1.5.1 Blend Equation (3.0: 4.1.7.1): equations of products and their sum (read as the order of computing)",
        ),
        advanced_blend: permit(
            BlendPrecision::DestinationCodes,
            text.cite([
                "OpenGL ES with KHR_blend_equation_advanced: precision and dynamic range no lower than the smaller of the destination's and that of 16-bit floats",
                "OpenGL ES with KHR_blend_equation_advanced: precision and dynamic range no lower than the smaller of the destination's and that of 16-bit floats",
                "OpenGL ES 3.2: 15.1.5.1 Blend Equation: precision and dynamic range no lower than the smaller of the destination's and that of 16-bit floats",
            ]),
        ),
        blend: narrowed(
            BlendPrecision::DestinationCodes,
            BlendPrecision::AnySteps,
            Grade::Disputed,
            text.cite([
                "OpenGL ES 3.0: 4.1.7.1 Blend Equation: precision and dynamic range no lower than that used to represent destination components (read as one representation throughout)",
                "OpenGL ES 3.1: 15.1.5.1 Blend Equation: precision and dynamic range no lower than that used to represent destination components (read as one representation throughout)",
                "OpenGL ES 3.2: 15.1.5.1 Blend Equation: precision and dynamic range no lower than that used to represent destination components (read as one representation throughout)",
            ]),
        ),
        signed_clamp: permit(
            SignedClamp::Signed,
            "OpenGL ES: EXT_render_snorm, which makes signed formats renderable, 15.1.5 Blending: clamped to [-1,1] for signed buffers",
        ),
        signed_result: narrowed(
            SignedClamp::Signed,
            SignedClamp::Either,
            Grade::Disputed,
            "OpenGL ES: EXT_render_snorm: clamped to [-1,1] for signed buffers; 15.1.6 sRGB Conversion (3.0: 4.1.8), which it leaves, clamps every fixed-point result to [0,1]",
        ),
        constant_clamp: permit(ConstantClamp::Never, "OpenGL ES: 15.1.5.4 Blend Color (3.0: 4.1.7.3, 3.1: 15.1.5.3): the constant is stored as it is"),
        one_is_first_output: permit(true, "OpenGL ES: 15.1.1 Alpha To Coverage (3.0: 4.1.3): all alpha values of the section are those of colour number zero"),
        quotients_beyond_one: narrowed(
            true,
            false,
            Grade::Disputed,
            "OpenGL ES with KHR_blend_equation_advanced: the base colours are quotients by alpha; precision and dynamic range are the destination's, which a quotient above 1 exceeds",
        ),
        negative_alpha: narrowed(
            NegativeAlpha::Defined,
            NegativeAlpha::Undefined,
            Grade::Disputed,
            "OpenGL ES: 15.1.5.3 Advanced Blend Equations: no exception for negative alphas (Vulkan's later text makes them undefined)",
        ),
        masks_reference: permit(true, "OpenGL ES: 15.1.2 Stencil Test (3.0: 4.1.4): the mask is applied to both the reference and the stored value"),
        copies: permit(
            Copies::Exact,
            "OpenGL ES: 16.1.5 Final Conversion (3.0: 4.3.2 Reading Pixels): a stored code is read back as its value, which has one code",
        ),
        srgb_logic: permit(
            SrgbLogic::PassesThrough,
            "OpenGL ES: has no logic operations",
        ),
        depth_order: narrowed(
            DepthOrder::WrittenConvertedFirst,
            DepthOrder::Either,
            Grade::Disputed,
            text.cite([
                "OpenGL ES 3.0: 3.9.2.3 Shader Outputs: a written depth is converted as a window z value; 4.1.5 does not state the order for others (a driver can report fixed-point depth and keep floats)",
                "OpenGL ES 3.1: 14.2.3 Shader Outputs: a written depth is converted as a window z value; 15.1.3 does not state the order for others (a driver can report fixed-point depth and keep floats)",
                "OpenGL ES 3.2: 14.2.3 Shader Outputs: a written depth is converted as a window z value; 15.1.3 does not state the order for others (a driver can report fixed-point depth and keep floats)",
            ]),
        ),
        depth_bias_unit: narrowed(
            BiasUnit::open_above(&[(0.999, 1.001)]),
            // For a mantissa below 1, as 8.24 and OpenGL's 8.25 write floats, the exponent is one more.
            BiasUnit::open_above(&[(0.999, 1.001), (1.998, 2.002)]),
            Grade::Disputed,
            text.cite([
                "OpenGL ES 3.0: 3.6.2 Depth Offset: for fixed point one r throughout the depth buffer, sure to be resolved and open above; 2^(e-n) for floats, e and n not defined (read as in 2.1.2, with a mantissa of at least 1)",
                "OpenGL ES 3.1: 13.5.2 Depth Offset: for fixed point one r throughout the depth buffer, sure to be resolved and open above; 2^(e-n) for floats, e and n not defined (read as in 2.3.3.2, with a mantissa of at least 1)",
                "OpenGL ES 3.2: 13.7.2 Depth Offset: for fixed point one r throughout the depth buffer, sure to be resolved and open above; 2^(e-n) for floats, e and n not defined (read as in 2.3.4.2, with a mantissa of at least 1)",
            ]),
        ),
        slope_root: permit(
            true,
            text.cite([
                "OpenGL ES 3.0: 3.6.2 Depth Offset: the root of the squares, which may be approximated by the larger growth",
                "OpenGL ES 3.1: 13.5.2 Depth Offset: the root of the squares, which may be approximated by the larger growth",
                "OpenGL ES 3.2: 13.7.2 Depth Offset: the root of the squares, which may be approximated by the larger growth",
            ]),
        ),
        bias_clamps_fragments: permit(
            true,
            text.cite([
                "OpenGL ES 3.0: 3.6.2 Depth Offset, last paragraph: clamped after the offset is added",
                "OpenGL ES 3.1: 13.5.2 Depth Offset, last paragraph: clamped after the offset is added",
                "OpenGL ES 3.2: 13.7.2 Depth Offset, last paragraph: clamped after the offset is added",
            ]),
        ),
        depth_terms: if limits.properties.contains(&Property::DepthFromZero) {
            permit(
                DepthTerms::NearPlane,
                "OpenGL ES with GL_EXT_clip_control: depth times f - n, and n, with ZERO_TO_ONE",
            )
        } else {
            permit(
                DepthTerms::Middle,
                text.cite([
                    "OpenGL ES 3.0: 2.13.1 Controlling the Viewport: depth times (f - n) / 2, and (n + f) / 2",
                    "OpenGL ES 3.1: 12.5.1 Controlling the Viewport: depth times (f - n) / 2, and (n + f) / 2",
                    "OpenGL ES 3.2: 12.6.1 Controlling the Viewport: depth times (f - n) / 2, and (n + f) / 2",
                ]),
            )
        },
        depth_range: permit(
            DepthRange::Unit,
            text.cite([
                "OpenGL ES 3.0: 3.9.2.3 Shader Outputs, 3.6.2 Depth Offset: a written or offset depth is held to 0 and 1",
                "OpenGL ES 3.1: 14.2.3 Shader Outputs, 13.5.2 Depth Offset: a written or offset depth is held to 0 and 1",
                "OpenGL ES 3.2: 14.2.3 Shader Outputs, 13.7.2 Depth Offset: a written or offset depth is held to 0 and 1",
            ]),
        ),
        factor_clamp: narrowed(
            FactorClamp::Clamped,
            FactorClamp::Either,
            Grade::Disputed,
            text.cite([
                "OpenGL ES 3.0: 4.1.7 Blending: factors are clamped for normalized attachments (the CTS's reference renderer and Direct3D 11.3 17.5 leave signed ones unclamped)",
                "OpenGL ES 3.1: 15.1.5.1 Blend Equation: factors are clamped for normalized attachments (the CTS's reference renderer and Direct3D 11.3 17.5 leave signed ones unclamped)",
                "OpenGL ES 3.2: 15.1.5.1 Blend Equation: factors are clamped for normalized attachments (the CTS's reference renderer and Direct3D 11.3 17.5 leave signed ones unclamped)",
            ]),
        ),
        resolve: permit(
            Resolve::Between,
            text.cite([
                "OpenGL ES 3.0: 4.3.3 Copying Pixels: the resolve is implementation-dependent",
                "OpenGL ES 3.1: 16.2.1 Blitting Pixel Rectangles: the resolve is implementation-dependent",
                "OpenGL ES 3.2: 16.2.1 Blitting Pixel Rectangles: the resolve is implementation-dependent",
            ]),
        ),
        clips_points: permit(
            true,
            text.cite([
                "OpenGL ES 3.0: 2.18 Primitive Clipping: a point outside of the near and far planes is discarded",
                "OpenGL ES 3.1: 12.4 Primitive Clipping: a point outside of the near and far planes is discarded",
                "OpenGL ES 3.2: 12.5 Primitive Clipping: a point outside of the near and far planes is discarded",
            ]),
        ),
        clips_points_at_sides: permit(
            false,
            text.cite([
                "OpenGL ES 3.0: 2.18 Primitive Clipping: a point between the near and far planes passes unchanged; the clip volume has sides",
                "OpenGL ES 3.1: 12.4 Primitive Clipping: a point between the near and far planes passes unchanged; the clip volume has sides",
                "OpenGL ES 3.2: 12.5 Primitive Clipping: a point between the near and far planes passes unchanged; the clip volume has sides",
            ]),
        ),
        clips_lines_at_sides: permit(
            false,
            text.cite([
                "OpenGL ES 3.0: 2.18 Primitive Clipping: lines are clipped at the near and far planes; the clip volume has sides",
                "OpenGL ES 3.1: 12.4 Primitive Clipping: lines are clipped at the near and far planes; the clip volume has sides",
                "OpenGL ES 3.2: 12.5 Primitive Clipping: lines are clipped at the near and far planes; the clip volume has sides",
            ]),
        ),
        clips_lines_by_depth: permit(
            true,
            text.cite([
                "OpenGL ES 3.0: 2.18 Primitive Clipping: lines are clipped at the near and far planes",
                "OpenGL ES 3.1: 12.4 Primitive Clipping: lines are clipped at the near and far planes",
                "OpenGL ES 3.2: 12.5 Primitive Clipping: lines are clipped at the near and far planes",
            ]),
        ),
        keeps_lines_that_end_behind: permit(
            true,
            text.cite([
                "OpenGL ES 3.0: 2.18 Primitive Clipping: lines are clipped at the near and far planes",
                "OpenGL ES 3.1: 12.4 Primitive Clipping: lines are clipped at the near and far planes",
                "OpenGL ES 3.2: 12.5 Primitive Clipping: lines are clipped at the near and far planes",
            ]),
        ),
        clips_lines_by_distance: permit(
            true,
            "OpenGL ES with GL_EXT_clip_cull_distance: clip distances are a part of the clip volume, at which lines are clipped",
        ),
        lines_cover_texels: narrowed(
            true,
            false,
            Grade::Disputed,
            text.cite([
                "OpenGL ES 3.0: 3.5.1 Basic Line Segment Rasterization: a fragment may deviate by one unit from that of the diamond-exit rule, and one may be missing (read as: at the ends, and beside slanted lines)",
                "OpenGL ES 3.1: 13.4.1 Basic Line Segment Rasterization: a fragment may deviate by one unit from that of the diamond-exit rule, and one may be missing (read as: at the ends, and beside slanted lines)",
                "OpenGL ES 3.2: 13.6.1 Basic Line Segment Rasterization: a fragment may deviate by one unit from that of the diamond-exit rule, and one may be missing (read as: at the ends, and beside slanted lines)",
            ]),
        ),
        lines_cover_their_shape: permit(
            false,
            "OpenGL ES: 13.6.1 Basic Line Segment Rasterization (3.0: 3.5.1, 3.1: 13.4.1): a fragment may deviate by one unit from that of the diamond-exit rule",
        ),
        lines_lack: permit(
            Some(1),
            text.cite([
                "OpenGL ES 3.0: 3.5.1 Basic Line Segment Rasterization: the number of fragments differs by at most one from that of the diamond-exit rule",
                "OpenGL ES 3.1: 13.4.1 Basic Line Segment Rasterization: the number of fragments differs by at most one from that of the diamond-exit rule",
                "OpenGL ES 3.2: 13.6.1 Basic Line Segment Rasterization: the number of fragments differs by at most one from that of the diamond-exit rule",
            ]),
        ),
        biases_lines: permit(
            false,
            text.cite([
                "OpenGL ES 3.0: 3.6.2 Depth Offset: of polygons",
                "OpenGL ES 3.1: 13.5.2 Depth Offset: of polygons",
                "OpenGL ES 3.2: 13.7.2 Depth Offset: of polygons",
            ]),
        ),
        points_face_front: permit(
            true,
            text.cite([
                "OpenGL ES 3.0: 4.1.4: points and lines use front state",
                "OpenGL ES 3.1: 15.1.2: points and lines use front state",
                "OpenGL ES 3.2: 15.1.2: points and lines use front state",
            ]),
        ),
        outlines_face_as_polygons: permit(false, text.cite([
            "OpenGL ES 3.0: has no polygon modes",
            "OpenGL ES 3.1: has no polygon modes",
            "OpenGL ES 3.2: has no polygon modes",
        ])),
        early_updates: narrowed(
            EarlyUpdates::Happen,
            EarlyUpdates::Each,
            Grade::Disputed,
            text.cite([
                "OpenGL ES 3.1: 13.6.4 The Early Fragment Test Qualifier: depth and stencil are updated before the shader runs, though its discard is said to update nothing",
                "OpenGL ES 3.1: 13.6.4 The Early Fragment Test Qualifier: depth and stencil are updated before the shader runs, though its discard is said to update nothing",
                "OpenGL ES 3.2: 13.8.4 The Early Fragment Test Qualifier: depth and stencil are updated before the shader runs, though its discard is said to update nothing",
            ]),
        ),
        early_coverage: permit(
            EarlyUpdates::Each,
            text.cite([
                "OpenGL ES 3.1: 13.6.4 The Early Fragment Test Qualifier: depth and stencil may be updated even for fragments discarded afterwards",
                "OpenGL ES 3.1: 13.6.4 The Early Fragment Test Qualifier: depth and stencil may be updated even for fragments discarded afterwards",
                "OpenGL ES 3.2: 13.8.4 The Early Fragment Test Qualifier: depth and stencil may be updated even for fragments discarded afterwards",
            ]),
        ),
        early_mask: permit(
            EarlyUpdates::Each,
            text.cite([
                "OpenGL ES 3.1: 13.6.4 The Early Fragment Test Qualifier: depth and stencil may be updated even for samples discarded afterwards",
                "OpenGL ES 3.1: 13.6.4 The Early Fragment Test Qualifier: depth and stencil may be updated even for samples discarded afterwards",
                "OpenGL ES 3.2: 13.8.4 The Early Fragment Test Qualifier: depth and stencil may be updated even for samples discarded afterwards",
            ]),
        ),
        early_ignores_written: permit(
            true,
            text.cite([
                "OpenGL ES 3.1: 13.6.4 The Early Fragment Test Qualifier: a depth that the shader computes has no effect",
                "OpenGL ES 3.1: 13.6.4 The Early Fragment Test Qualifier: a depth that the shader computes has no effect",
                "OpenGL ES 3.2: 13.8.4 The Early Fragment Test Qualifier: a depth that the shader computes has no effect",
            ]),
        ),
        covers_one_sample: permit(
            false,
            text.cite([
                "OpenGL ES 3.0: 4.1.3 Multisample Fragment Operations: no change where SAMPLE_BUFFERS is not one",
                "OpenGL ES 3.1: 15.1.1 Alpha To Coverage, 13.8.3 Multisample Fragment Operations: no change where SAMPLE_BUFFERS is not one",
                "OpenGL ES 3.2: 15.1.1 Alpha To Coverage, 13.8.3 Multisample Fragment Operations: no change where SAMPLE_BUFFERS is not one",
            ]),
        ),
        mask_of_one: narrowed(
            MaskOfOne::Ignored,
            MaskOfOne::Either,
            Grade::RequiredByCts,
            text.cite([
                "OpenGL ES with GL_OES_sample_variables: the fragment's coverage becomes the AND; dEQP-GLES31.functional.shaders.sample_variables.sample_mask.*.singlesample_* demands that nothing is lost",
                "OpenGL ES with GL_OES_sample_variables: the fragment's coverage becomes the AND; dEQP-GLES31.functional.shaders.sample_variables.sample_mask.*.singlesample_* demands that nothing is lost",
                "OpenGL ES 3.2: 14.2.3 Shader Outputs, 15.1.8 Additional Multisample Fragment Operations: coverage bits act where SAMPLE_BUFFERS is one; dEQP-GLES31.functional.shaders.sample_variables.sample_mask.*.singlesample_* demands that nothing is lost",
            ]),
        ),
        goes_on_unshaded: permit(
            false,
            "OpenGL ES: 7.3 Program Objects (3.0: 2.11.3): a program has a fragment shader, or does not link",
        ),
        input_mask: permit(
            InputMaskRule::OfAnyRun,
            text.cite([
                "OpenGL ES 3.0: OES_sample_variables, Shader Inputs: the samples covered for the run, of which sample shading asks for a least number; the current sample's bit alone where gl_SampleID asks for it; of several runs exactly one has a covered sample's bit",
                "OpenGL ES 3.1: OES_sample_variables, Shader Inputs: the samples covered for the run, of which sample shading asks for a least number; the current sample's bit alone where gl_SampleID asks for it; of several runs exactly one has a covered sample's bit",
                "OpenGL ES 3.2: 14.2.2 Shader Inputs: the samples covered for the run, of which sample shading asks for a least number; the current sample's bit alone where gl_SampleID asks for it; of several runs exactly one has a covered sample's bit",
            ]),
        ),
        input_mask_lacks_masked: permit(
            true,
            text.cite([
                "OpenGL ES 3.0: OES_sample_variables, Shader Inputs: no bits of samples that SAMPLE_COVERAGE or SAMPLE_MASK kills",
                "OpenGL ES 3.1: OES_sample_variables, Shader Inputs: no bits of samples that SAMPLE_COVERAGE or SAMPLE_MASK kills",
                "OpenGL ES 3.2: 14.2.2 Shader Inputs: no bits of samples that SAMPLE_COVERAGE or SAMPLE_MASK kills",
            ]),
        ),
        mask_acts_first: permit(
            true,
            text.cite([
                "OpenGL ES 3.0: 4.1.3 Multisample Fragment Operations: the sample mask is applied before the early tests",
                "OpenGL ES 3.1: 13.6.3 Multisample Fragment Operations: the sample mask is applied before the early tests",
                "OpenGL ES 3.2: 13.8.3 Multisample Fragment Operations: the sample mask is applied before the early tests",
            ]),
        ),
        early_counts: permit(
            EarlyUpdates::Either,
            text.cite([
                "OpenGL ES 3.1: 13.6.4 The Early Fragment Test Qualifier: occlusion counts may be updated even for fragments discarded afterwards",
                "OpenGL ES 3.1: 13.6.4 The Early Fragment Test Qualifier: occlusion counts may be updated even for fragments discarded afterwards",
                "OpenGL ES 3.2: 13.8.4 The Early Fragment Test Qualifier: occlusion counts may be updated even for fragments discarded afterwards",
            ]),
        ),
        samples_counted: permit(
            SamplesCounted::PassingOrAll,
            text.cite([
                "OpenGL ES 3.0: 4.1.6 Occlusion Queries: boolean queries only; OpenGL: the samples that pass, or SAMPLES if any does",
                "OpenGL ES 3.1: 15.1.4 Occlusion Queries: boolean queries only; OpenGL: the samples that pass, or SAMPLES if any does",
                "OpenGL ES 3.2: 15.1.4 Occlusion Queries: boolean queries only; OpenGL: the samples that pass, or SAMPLES if any does",
            ]),
        ),
        clears_count_nothing: permit(
            true,
            only_draws_count,
        ),
        operations_count_nothing: permit(
            true,
            only_draws_count,
        ),
        same_depth: permit(
            SameDepth::Written,
            text.cite([
                "OpenGL ES 3.0: Appendix A, Invariance: shaders that assign gl_FragCoord.z to gl_FragDepth are depth-invariant with respect to each other",
                "OpenGL ES 3.1: Appendix A, Invariance: shaders that assign gl_FragCoord.z to gl_FragDepth are depth-invariant with respect to each other",
                "OpenGL ES 3.2: Appendix A, Invariance: shaders that assign gl_FragCoord.z to gl_FragDepth are depth-invariant with respect to each other",
            ]),
        ),
        filter_step: permit(
            1.0 / 16.0,
            text.cite([
                "OpenGL ES 3.0: silent on the precision of filter weights; Vulkan: at least 4 bits",
                "OpenGL ES 3.1: silent on the precision of filter weights; Vulkan: at least 4 bits",
                "OpenGL ES 3.2: silent on the precision of filter weights; Vulkan: at least 4 bits",
            ]),
        ),
        filters_to_codes: permit(
            true,
            text.cite([
                "OpenGL ES 3.0: silent on the precision of a filtered value (read as: no coarser than the format's codes in any step)",
                "OpenGL ES 3.1: silent on the precision of a filtered value (read as: no coarser than the format's codes in any step)",
                "OpenGL ES 3.2: silent on the precision of a filtered value (read as: no coarser than the format's codes in any step)",
            ]),
        ),
        half_overflows: narrowed(
            true,
            false,
            Grade::Disputed,
            "OpenGL ES: 2.3.4.2 16-Bit Floating-Point Numbers (3.0: 2.1.2, 3.1: 2.3.3.2): infinity stands for magnitudes that are too large; no sentence gives the result of a conversion",
        ),
        flushes_small_floats: permit(
            FlushedFloats::All,
            text.cite([
                "OpenGL ES 3.0: 2.1.2 to 2.1.4 Floating-Point Numbers of 16, 11 and 10 bits: a denormalized value is preserved or forced to zero",
                "OpenGL ES 3.1: 2.3.3.2 to 2.3.3.4 Floating-Point Numbers of 16, 11 and 10 bits: a denormalized value is preserved or forced to zero",
                "OpenGL ES 3.2: 2.3.4.2 to 2.3.4.4 Floating-Point Numbers of 16, 11 and 10 bits: a denormalized value is preserved or forced to zero",
            ]),
        ),
        small_floats: permit(
            SmallFloats::NearestOrTowardsZero,
            text.cite([
                "OpenGL ES 3.0: 2.1.3, 2.1.4 Unsigned 11-Bit and 10-Bit Floating-Point Numbers: the closest finite value, or always towards zero",
                "OpenGL ES 3.1: 2.3.3.3, 2.3.3.4 Unsigned 11-Bit and 10-Bit Floating-Point Numbers: the closest finite value, or always towards zero",
                "OpenGL ES 3.2: 2.3.4.3, 2.3.4.4 Unsigned 11-Bit and 10-Bit Floating-Point Numbers: the closest finite value, or always towards zero",
            ]),
        ),
        runs_for_discarded: narrowed(
            true,
            false,
            Grade::RequiredByCts,
            text.cite([
                "OpenGL ES 3.1: 7.11.1 Shader Memory Access Ordering: a fragment that never contributes to the framebuffer may go without a run; dEQP-GLES31.functional.image_load_store.early_fragment_tests.no_early_fragment_tests_* demands one",
                "OpenGL ES 3.1: 7.11.1 Shader Memory Access Ordering: a fragment that never contributes to the framebuffer may go without a run; dEQP-GLES31.functional.image_load_store.early_fragment_tests.no_early_fragment_tests_* demands one",
                "OpenGL ES 3.2: 7.11.1 Shader Memory Access Ordering: a fragment that never contributes to the framebuffer may go without a run; dEQP-GLES31.functional.image_load_store.early_fragment_tests.no_early_fragment_tests_* demands one",
            ]),
        ),
        runs_for_overwritten: permit(
            false,
            text.cite([
                "OpenGL ES 3.1: 7.11.1 Shader Memory Access Ordering: a fragment that a later one replaces may go without a run",
                "OpenGL ES 3.1: 7.11.1 Shader Memory Access Ordering: a fragment that a later one replaces may go without a run",
                "OpenGL ES 3.2: 7.11.1 Shader Memory Access Ordering: a fragment that a later one replaces may go without a run",
            ]),
        ),
        skips_rejected: permit(
            true,
            text.cite([
                "OpenGL ES 3.1: 7.11.1 Shader Memory Access Ordering: no run for a fragment that early tests discard",
                "OpenGL ES 3.1: 7.11.1 Shader Memory Access Ordering: no run for a fragment that early tests discard",
                "OpenGL ES 3.2: 7.11.1 Shader Memory Access Ordering: no run for a fragment that early tests discard",
            ]),
        ),
        runs_once: permit(
            true,
            text.cite([
                "OpenGL ES 3.1: 7.11.1 Shader Memory Access Ordering: one run per fragment without several samples, else at most one per covered sample",
                "OpenGL ES 3.1: 7.11.1 Shader Memory Access Ordering: one run per fragment without several samples, else at most one per covered sample",
                "OpenGL ES 3.2: 7.11.1 Shader Memory Access Ordering: one run per fragment without several samples, else at most one per covered sample",
            ]),
        ),
        samples_as_told: narrowed(
            true,
            false,
            Grade::Disputed,
            "OpenGL ES: 13.4 Multisampling (3.1: 13.2.1): a pixel's coverage has SAMPLES bits, and the number of sample points may be different from SAMPLES",
        ),
        runs_by_share: narrowed(
            true,
            false,
            Grade::Disputed,
            text.cite([
                "OpenGL ES 3.1 with GL_OES_sample_shading: at least max(ceil(share x samples), 1) sets of inputs; 7.11.1: 1 to N runs where the shader itself does not ask for samples",
                "OpenGL ES 3.1 with GL_OES_sample_shading: at least max(ceil(share x samples), 1) sets of inputs; 7.11.1: 1 to N runs where the shader itself does not ask for samples",
                "OpenGL ES 3.2: 13.4.1 Sample Shading: at least max(ceil(share x samples), 1) sets of inputs; 7.11.1: 1 to N runs where the shader itself does not ask for samples",
            ]),
        ),
        alpha_to_coverage: narrowed(
            AlphaToCoverage::Ends,
            AlphaToCoverage::Any,
            Grade::RequiredByCts,
            text.cite([
                "OpenGL ES 3.0: 4.1.3 Multisample Fragment Operations: intended; dEQP-GLES3.functional.multisample.*.proportionality_alpha_to_coverage demands the ends",
                "OpenGL ES 3.1: 15.1.1 Alpha To Coverage: intended; dEQP-GLES3.functional.multisample.*.proportionality_alpha_to_coverage demands the ends",
                "OpenGL ES 3.2: 15.1.1 Alpha To Coverage: intended; dEQP-GLES3.functional.multisample.*.proportionality_alpha_to_coverage demands the ends",
            ]),
        ),
        colorless_alpha_to_coverage: permit(
            AlphaToCoverage::Any,
            text.cite([
                "OpenGL ES 3.0: 4.1.3 Multisample Fragment Operations: that the ends give none and all is intended; no case of the CTS lacks a colour attachment",
                "OpenGL ES 3.1: 15.1.1 Alpha To Coverage: that the ends give none and all is intended; no case of the CTS lacks a colour attachment",
                "OpenGL ES 3.2: 15.1.1 Alpha To Coverage: that the ends give none and all is intended; no case of the CTS lacks a colour attachment",
            ]),
        ),
        sample_coverage: narrowed(
            AlphaToCoverage::Ends,
            AlphaToCoverage::Any,
            Grade::RequiredByCts,
            text.cite([
                "OpenGL ES 3.0: 4.1.3 Multisample Fragment Operations: a function of the coverage value, inverted bit by bit; dEQP-GLES3.functional.multisample.*.proportionality_sample_coverage demands the ends",
                "OpenGL ES 3.1: 13.6.3 Multisample Fragment Operations: a function of the coverage value, inverted bit by bit; dEQP-GLES3.functional.multisample.*.proportionality_sample_coverage demands the ends",
                "OpenGL ES 3.2: 13.8.3 Multisample Fragment Operations: a function of the coverage value, inverted bit by bit; dEQP-GLES3.functional.multisample.*.proportionality_sample_coverage demands the ends",
            ]),
        ),
        frag_coord: permit(
            FragCoord::Inputs,
            text.cite([
                "OpenGL ES 3.0: 3.3 Multisampling: associated data anywhere within the pixel",
                "OpenGL ES 3.1: 13.2.1 Multisampling: associated data anywhere within the pixel",
                "OpenGL ES 3.2: 13.4 Multisampling: associated data anywhere within the pixel",
            ]),
        ),
        inputs_at_samples: permit(
            true,
            text.cite([
                "OpenGL ES 3.0: OES_sample_shading, 3.3.1: with a share of 1, each sample's inputs are evaluated at its location",
                "OpenGL ES 3.1: OES_sample_shading, 3.3.1: with a share of 1, each sample's inputs are evaluated at its location",
                "OpenGL ES 3.2: 13.4.1 Sample Shading: with a share of 1, each sample's inputs are evaluated at its location",
            ]),
        ),
        facing: text.cite([
            "OpenGL ES 3.0: 3.6.1 Basic Polygon Rasterization: front by the sign of the area",
            "OpenGL ES 3.1: 13.5.1 Basic Polygon Rasterization: front by the sign of the area",
            "OpenGL ES 3.2: 13.7.1 Basic Polygon Rasterization: front by the sign of the area",
        ]),
        own_pass: text.cite([
            "OpenGL ES 3.0: EXT_shader_framebuffer_fetch: 3.9.2 Shader Outputs",
            "OpenGL ES 3.1: EXT_shader_framebuffer_fetch: 3.9.2 Shader Outputs",
            "OpenGL ES 3.2: EXT_shader_framebuffer_fetch: 3.9.2 Shader Outputs",
        ]),
        stencil: text.cite([
            "OpenGL ES 3.0: 4.1.4 Stencil Test: integer operations",
            "OpenGL ES 3.1: 15.1.2 Stencil Test: integer operations",
            "OpenGL ES 3.2: 15.1.2 Stencil Test: integer operations",
        ]),
        write_mask: text.cite([
            "OpenGL ES 3.0: 4.2.2 Fine Control of Buffer Updates",
            "OpenGL ES 3.1: 15.2.2 Fine Control of Buffer Updates",
            "OpenGL ES 3.2: 15.2.2 Fine Control of Buffer Updates",
        ]),
    }
}
