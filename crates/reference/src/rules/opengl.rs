//! OpenGL's permissions, by version of the core profile: 3.3, 4.5 and 4.6 were read.

use super::permission::{
    AlphaToCoverage, BiasUnit, BlendPrecision, ConstantClamp, Copies, DepthOrder, DepthRange,
    DepthTerms, EarlyUpdates, FactorClamp, FlushedFloats, FragCoord, InputMaskRule, MaskOfOne,
    NegativeAlpha, Permission, Resolve, Rounding, Rules, SameDepth, SamplesCounted, SharedEdge,
    SignedClamp, SmallFloats, Snap, SrgbLogic, narrowed, permit, step,
};
use etalon_frame::{ApiVersion, Grade, Limits, Property};

/// The specification that binds a context: the newest one that was read and is not newer than the context.
/// Versions 4.2 to 4.4 are judged by 4.5, whose rules on blending came with 4.2.
#[derive(Clone, Copy, PartialEq, Eq)]
enum OpenGlText {
    V33,
    V45,
    V46,
}

impl OpenGlText {
    fn of(version: ApiVersion) -> Self {
        match (version.major, version.minor) {
            (3, _) | (4, 0 | 1) => Self::V33,
            (4, 2..=5) => Self::V45,
            _ => Self::V46,
        }
    }

    /// Returns the citation for this version out of those for 3.3, 4.5 and 4.6.
    fn cite(self, [v33, v45, v46]: [&'static str; 3]) -> &'static str {
        match self {
            Self::V33 => v33,
            Self::V45 => v45,
            Self::V46 => v46,
        }
    }
}

/// Returns a rule on the runs of shaders. On this, 4.6 contradicts itself, but 4.5 does not. Older contexts
/// get storage from an extension whose specification matches 4.5.
fn run_rule(text: OpenGlText, v45: &'static str, v46: &'static str) -> Permission<bool> {
    match text {
        OpenGlText::V46 => narrowed(true, false, Grade::Disputed, v46),
        OpenGlText::V33 | OpenGlText::V45 => permit(true, v45),
    }
}

/// Returns the rules of OpenGL for an adapter. One entry per permission, with its citation.
pub(super) fn rules(limits: &Limits) -> Rules {
    let text = OpenGlText::of(limits.version);
    let old = text == OpenGlText::V33;
    let only_draws_count = text.cite([
            "OpenGL 3.3: 4.1.6 Occlusion Queries: the fragments that pass the depth test; 4.2.3, 4.3.2: clears and blits make none",
            "OpenGL 4.5: 17.3.5 Occlusion Queries: the fragments still processed after the depth test; 17.4.3, 18.3.1: clears and blits make none",
            "OpenGL 4.6: 17.3.5 Occlusion Queries: the fragments still processed after the depth test; 17.4.3, 18.3.1: clears and blits make none",
        ]);
    Rules {
        name: "opengl",
        text: text.cite([
            "OpenGL 3.3 (core profile)",
            "OpenGL 4.5 (core profile)",
            "OpenGL 4.6 (core profile)",
        ]),
        float_error: permit(
            1e-5,
            text.cite([
                "OpenGL 3.3: 2.1.1 Floating-Point Computation: accurate to about 1 part in 10^5",
                "OpenGL 4.5: 2.3.4.1 Floating-Point Computation: accurate to about 1 part in 10^5",
                "OpenGL 4.6: 2.3.4.1 Floating-Point Computation: accurate to about 1 part in 10^5",
            ]),
        ),
        shader_error: permit(
            1e-5,
            text.cite([
                "OpenGL 3.3: 2.1.1 Floating-Point Computation: accurate to about 1 part in 10^5",
                "OpenGL 4.5: 2.3.4.1 Floating-Point Computation: accurate to about 1 part in 10^5",
                "OpenGL 4.6: 2.3.4.1 Floating-Point Computation: accurate to about 1 part in 10^5",
            ]),
        ),
        decode_error: permit(
            1e-5,
            text.cite([
                "OpenGL 3.3: 2.1.5 Conversion from Normalized Fixed-Point to Floating-Point, at the accuracy of 2.1.1",
                "OpenGL 4.5: 2.3.5.1 Conversion from Normalized Fixed-Point to Floating-Point, at the accuracy of 2.3.4.1",
                "OpenGL 4.6: 2.3.5.1 Conversion from Normalized Fixed-Point to Floating-Point, at the accuracy of 2.3.4.1",
            ]),
        ),
        restarts_before_base_vertex: permit(
            true,
            text.cite([
                "OpenGL 3.3: 2.8.1 Transferring Array Elements: the index is compared before the base vertex is added",
                "OpenGL 4.5: 10.3.6 Primitive Restart: the index is tested before the base vertex is added",
                "OpenGL 4.6: 10.3.6 Primitive Restart: the index is tested before the base vertex is added",
            ]),
        ),
        sub_pixel_bits: permit(limits.sub_pixel_bits, text.cite([
                "OpenGL 3.3: table 6.38, SUBPIXEL_BITS: at least 4",
                "OpenGL 4.5: Implementation Dependent Values, SUBPIXEL_BITS: at least 4",
                "OpenGL 4.6: Implementation Dependent Values, SUBPIXEL_BITS: at least 4",
            ])),
        viewport_step: permit(
            step(limits.viewport_bits.unwrap_or(0)),
            text.cite([
                "OpenGL 3.3: 2.13.1 Controlling the Viewport: bounds are integers; GL_ARB_viewport_array: the precision of bounds is VIEWPORT_SUBPIXEL_BITS, which can be 0",
                "OpenGL 4.5: 13.6.1 Controlling the Viewport: the precision of bounds is VIEWPORT_SUBPIXEL_BITS, which can be 0",
                "OpenGL 4.6: 13.8.1 Controlling the Viewport: the precision of bounds is VIEWPORT_SUBPIXEL_BITS, which can be 0",
            ]),
        ),
        snap: permit(
            Snap::EitherSide,
            text.cite([
                "OpenGL 3.3: table 6.38, SUBPIXEL_BITS: the rounding to the grid is not stated",
                "OpenGL 4.5: Implementation Dependent Values, SUBPIXEL_BITS: the rounding to the grid is not stated",
                "OpenGL 4.6: Implementation Dependent Values, SUBPIXEL_BITS: the rounding to the grid is not stated",
            ]),
        ),
        shared_edge: permit(
            SharedEdge::ExactlyOne,
            text.cite([
                "OpenGL 3.3: 3.6.1 Basic Polygon Rasterization: a common edge with identical end points gives exactly one fragment",
                "OpenGL 4.5: 14.6.1 Basic Polygon Rasterization: a common edge with identical end points gives exactly one fragment",
                "OpenGL 4.6: 14.6.1 Basic Polygon Rasterization: a common edge with identical end points gives exactly one fragment",
            ]),
        ),
        covers_at_positions: narrowed(
            true,
            false,
            Grade::Disputed,
            text.cite([
                "OpenGL 3.3: 3.3.1 Multisampling: the location that is queried is the sample's (OpenGL 4.5 of May 28, 2015 corrects the sentence, I.3)",
                "OpenGL 4.5: 14.3.1 Multisampling: the locations that are queried are those of shading; those of coverage need not be the same",
                "OpenGL 4.6: 14.3.1 Multisampling: the locations that are queried are those of shading; those of coverage need not be the same",
            ]),
        ),
        store: permit(
            Rounding::EitherNeighbour,
            text.cite([
                "OpenGL 3.3: 2.1.5 Conversion from Floating-Point to Normalized Fixed-Point: one of the two closest values, an integer exactly",
                "OpenGL 4.5: 2.3.5.2 Conversion from Floating-Point to Normalized Fixed-Point: one of the two closest values, an integer exactly",
                "OpenGL 4.6: 2.3.5.2 Conversion from Floating-Point to Normalized Fixed-Point: one of the two closest values, an integer exactly",
            ]),
        ),
        float32_blend_error: if old {
            narrowed(
                f64::from(f32::EPSILON),
                1e-5,
                Grade::Disputed,
                "OpenGL 3.3: 4.1.7 Blending: no precision is named; OpenGL 4.2: no lower than that used to represent destination components",
            )
        } else {
            permit(
                f64::from(f32::EPSILON),
                text.cite([
                    "",
                    "OpenGL 4.5: 17.3.6.1 Blend Equation: precision and dynamic range no lower than that used to represent destination components",
                    "OpenGL 4.6: 17.3.6.1 Blend Equation: precision and dynamic range no lower than that used to represent destination components",
                ]),
            )
        },
        weights_by_channel: narrowed(
            true,
            false,
            Grade::Disputed,
            "OpenGL: 17.3.6.1 Blend Equation (3.3: 4.1.7): precision no lower than that used to represent destination components (read as: of the component that is computed)",
        ),
        blends_in_order: narrowed(
            true,
            false,
            Grade::Disputed,
            "OpenGL: 17.3.6.1 Blend Equation (3.3: 4.1.7): equations of products and their sum (read as the order of computing)",
        ),
        advanced_blend: permit(
            BlendPrecision::DestinationCodes,
            "OpenGL with KHR_blend_equation_advanced: precision and dynamic range no lower than the smaller of the destination's and that of 16-bit floats",
        ),
        blend: narrowed(
            BlendPrecision::DestinationCodes,
            BlendPrecision::AnySteps,
            Grade::Disputed,
            text.cite([
                "OpenGL 3.3: 4.1.7 Blending: no precision is named; OpenGL 4.2: no lower than that used to represent destination components (read as one representation throughout)",
                "OpenGL 4.5: 17.3.6.1 Blend Equation: precision and dynamic range no lower than that used to represent destination components (read as one representation throughout)",
                "OpenGL 4.6: 17.3.6.1 Blend Equation: precision and dynamic range no lower than that used to represent destination components (read as one representation throughout)",
            ]),
        ),
        signed_clamp: if old { narrowed(
                SignedClamp::Unit,
                SignedClamp::Either,
                Grade::Disputed,
                "OpenGL 3.3: 4.1.7 Blending: clamped to [0,1] for every fixed-point buffer; later versions clamp to [-1,1] for signed ones",
            ) } else { permit(
                SignedClamp::Signed,
                text.cite([
                    "OpenGL 3.3: 4.1.7 Blending: clamped to [0,1] or [-1,1], as the buffer is unsigned or signed",
                    "OpenGL 4.5: 17.3.6 Blending: clamped to [0,1] or [-1,1], as the buffer is unsigned or signed",
                    "OpenGL 4.6: 17.3.6 Blending: clamped to [0,1] or [-1,1], as the buffer is unsigned or signed",
                ]),
            ) },
        signed_result: if old { permit(
                SignedClamp::Either,
                "OpenGL 3.3: 4.1.8 sRGB Conversion: clamped to [0,1] for every fixed-point buffer; 2.1.5 has signed ones",
            ) } else { narrowed(
                SignedClamp::Signed,
                SignedClamp::Either,
                Grade::Disputed,
                "OpenGL 4.5, 4.6: 17.3.6 Blending, 2.3.5.2: signed buffers hold [-1,1]; 17.3.7 sRGB Conversion clamps every fixed-point result to [0,1]",
            ) },
        constant_clamp: if old { narrowed(
                ConstantClamp::Always,
                ConstantClamp::Either,
                Grade::Disputed,
                "OpenGL 3.3: 4.1.7 Blend Color, table 2.2: the constant is a clampf; later versions store it as it is",
            ) } else { permit(ConstantClamp::Never, "OpenGL: 17.3.6.5 Blend Color: the constant is stored as it is") },
        one_is_first_output: permit(true, "OpenGL: 17.3.1 Alpha To Coverage (3.3: 4.1.3): all alpha values of the section are those of colour number zero, index zero"),
        quotients_beyond_one: narrowed(
            true,
            false,
            Grade::Disputed,
            "OpenGL with KHR_blend_equation_advanced: the base colours are quotients by alpha; precision and dynamic range are the destination's, which a quotient above 1 exceeds",
        ),
        negative_alpha: narrowed(
            NegativeAlpha::Defined,
            NegativeAlpha::Undefined,
            Grade::Disputed,
            "OpenGL with KHR_blend_equation_advanced: no exception for negative alphas (Vulkan's later text makes them undefined)",
        ),
        masks_reference: permit(true, "OpenGL: 17.3.3 Stencil Test (3.3: 4.1.4): the mask is applied to both the reference and the stored value"),
        copies: permit(
            Copies::Exact,
            "OpenGL: 18.2.8 Final Conversion (3.3: 4.3.1 Reading Pixels): a stored code is read back as its value, which has one code",
        ),
        srgb_logic: if old { narrowed(
                SrgbLogic::Applies,
                SrgbLogic::Either,
                Grade::Disputed,
                "OpenGL 3.3: 4.1.10 Logical Operation: no effect on floating-point buffers alone; later versions exempt sRGB too",
            ) } else { permit(
                SrgbLogic::PassesThrough,
                text.cite([
                    "OpenGL 3.3: 4.1.10 Logical Operation: no effect on floating-point and sRGB buffers",
                    "OpenGL 4.5: 17.3.9 Logical Operation: no effect on floating-point and sRGB buffers",
                    "OpenGL 4.6: 17.3.9 Logical Operation: no effect on floating-point and sRGB buffers",
                ]),
            ) },
        depth_order: narrowed(
            DepthOrder::WrittenConvertedFirst,
            DepthOrder::Either,
            Grade::Disputed,
            text.cite([
                "OpenGL 3.3: 3.9.2 Shader Outputs: a written depth is converted as a window z value; 4.1.5 does not state the order for others (a driver can report fixed-point depth and keep floats)",
                "OpenGL 4.5: 15.2.3 Shader Outputs: a written depth is converted as a window z value; 17.3.4 does not state the order for others (a driver can report fixed-point depth and keep floats)",
                "OpenGL 4.6: 15.2.3 Shader Outputs: a written depth is converted as a window z value; 17.3.4 does not state the order for others (a driver can report fixed-point depth and keep floats)",
            ]),
        ),
        depth_bias_unit: narrowed(
            BiasUnit::open_above(&[(0.999, 1.001)]),
            // For a mantissa below 1, as 8.25 writes floats, the exponent is one more.
            BiasUnit::open_above(&[(0.999, 1.001), (1.998, 2.002)]),
            Grade::Disputed,
            text.cite([
                "OpenGL 3.3: 3.6.4 Depth Offset: for fixed point one r throughout the depth buffer, sure to be resolved and open above; 2^(e-n) for floats, e and n not defined (read as in 2.1.2, with a mantissa of at least 1)",
                "OpenGL 4.5: 14.6.5 Depth Offset: for fixed point one r throughout the depth buffer, sure to be resolved and open above; 2^(e-n) for floats, e and n not defined (read as in 2.3.4.2, with a mantissa of at least 1)",
                "OpenGL 4.6: 14.6.5 Depth Offset: for fixed point one r throughout the depth buffer, sure to be resolved and open above; 2^(e-n) for floats, e and n not defined (read as in 2.3.4.2, with a mantissa of at least 1)",
            ]),
        ),
        slope_root: permit(
            true,
            text.cite([
                "OpenGL 3.3: 3.6.4 Depth Offset: the root of the squares, which may be approximated by the larger growth",
                "OpenGL 4.5: 14.6.5 Depth Offset: the root of the squares, which may be approximated by the larger growth",
                "OpenGL 4.6: 14.6.5 Depth Offset: the root of the squares, which may be approximated by the larger growth",
            ]),
        ),
        bias_clamps_fragments: permit(
            !old,
            text.cite([
                "OpenGL 3.3: 3.6.4 Depth Offset, last paragraph: clamped after the offset is added, or at the vertices",
                "OpenGL 4.5: 14.6.5 Depth Offset, last paragraph: clamped after the offset is added",
                "OpenGL 4.6: 14.6.5 Depth Offset, last paragraph: clamped after the offset is added",
            ]),
        ),
        depth_terms: if limits.properties.contains(&Property::DepthFromZero) {
            permit(
                DepthTerms::NearPlane,
                "OpenGL 4.5, 4.6: Controlling the Viewport (13.6.1, 13.8.1), GL_ARB_clip_control: depth times f - n, and n, with ZERO_TO_ONE",
            )
        } else {
            permit(
                DepthTerms::Middle,
                text.cite([
                    "OpenGL 3.3: 2.13.1 Controlling the Viewport: depth times (f - n) / 2, and (n + f) / 2",
                    "OpenGL 4.5: 13.6.1 Controlling the Viewport: depth times (f - n) / 2, and (n + f) / 2, with NEGATIVE_ONE_TO_ONE",
                    "OpenGL 4.6: 13.8.1 Controlling the Viewport: depth times (f - n) / 2, and (n + f) / 2, with NEGATIVE_ONE_TO_ONE",
                ]),
            )
        },
        depth_range: permit(
            DepthRange::Unit,
            text.cite([
                "OpenGL 3.3: 3.9.2 Shader Execution, 3.6.4 Depth Offset: a written or offset depth is held to 0 and 1",
                "OpenGL 4.5: 15.2.3 Shader Outputs, 14.6.5 Depth Offset: a written or offset depth is held to 0 and 1",
                "OpenGL 4.6: 15.2.3 Shader Outputs, 14.6.5 Depth Offset: a written or offset depth is held to 0 and 1",
            ]),
        ),
        factor_clamp: narrowed(
            FactorClamp::Clamped,
            FactorClamp::Either,
            Grade::Disputed,
            text.cite([
                "OpenGL 3.3: 4.1.7 Blending: factors are clamped for normalized attachments (the CTS's reference renderer and Direct3D 11.3 17.5 leave signed ones unclamped)",
                "OpenGL 4.5: 17.3.6.1 Blend Equation: factors are clamped for normalized attachments (the CTS's reference renderer and Direct3D 11.3 17.5 leave signed ones unclamped)",
                "OpenGL 4.6: 17.3.6.1 Blend Equation: factors are clamped for normalized attachments (the CTS's reference renderer and Direct3D 11.3 17.5 leave signed ones unclamped)",
            ]),
        ),
        resolve: permit(
            Resolve::Between,
            text.cite([
                "OpenGL 3.3: 4.3.2 Copying Pixels: the resolve is implementation-dependent",
                "OpenGL 4.5: 18.3.1 Blitting Pixel Rectangles: the resolve is implementation-dependent",
                "OpenGL 4.6: 18.3.1 Blitting Pixel Rectangles: the resolve is implementation-dependent",
            ]),
        ),
        clips_points: permit(
            true,
            text.cite([
                "OpenGL 3.3: 2.19 Primitive Clipping: a point outside of the clip volume is discarded",
                "OpenGL 4.5: 13.5 Primitive Clipping: a point outside of the clip volume is discarded",
                "OpenGL 4.6: 13.7 Primitive Clipping: a point outside of the near and far planes is discarded",
            ]),
        ),
        clips_points_at_sides: if text == OpenGlText::V46 { permit(
                false,
                "OpenGL 4.6: 13.7 Primitive Clipping: points outside of the view volume may be discarded",
            ) } else { narrowed(
                true,
                false,
                Grade::Disputed,
                "OpenGL 3.3: 2.19, 4.5: 13.5 Primitive Clipping: a point outside of the clip volume is discarded (4.6 of October 22, 2019 corrects the sentence, J.4)",
            ) },
        clips_lines_at_sides: permit(
            true,
            text.cite([
                "OpenGL 3.3: 2.19 Primitive Clipping: a line outside of the clip volume is discarded, one that leaves it is clipped",
                "OpenGL 4.5: 13.5 Primitive Clipping: a line outside of the clip volume is discarded, one that leaves it is clipped",
                "OpenGL 4.6: 13.7 Primitive Clipping: a line outside of the clip volume is discarded, one that leaves it is clipped",
            ]),
        ),
        clips_lines_by_depth: permit(
            true,
            text.cite([
                "OpenGL 3.3: 2.19 Primitive Clipping: a line outside of the clip volume is discarded, one that leaves it is clipped",
                "OpenGL 4.5: 13.5 Primitive Clipping: a line outside of the clip volume is discarded, one that leaves it is clipped",
                "OpenGL 4.6: 13.7 Primitive Clipping: a line outside of the clip volume is discarded, one that leaves it is clipped",
            ]),
        ),
        keeps_lines_that_end_behind: permit(
            true,
            text.cite([
                "OpenGL 3.3: 2.19 Primitive Clipping: a line outside of the clip volume is discarded, one that leaves it is clipped",
                "OpenGL 4.5: 13.5 Primitive Clipping: a line outside of the clip volume is discarded, one that leaves it is clipped",
                "OpenGL 4.6: 13.7 Primitive Clipping: a line outside of the clip volume is discarded, one that leaves it is clipped",
            ]),
        ),
        clips_lines_by_distance: permit(
            true,
            text.cite([
                "OpenGL 3.3: 2.19 Primitive Clipping: clip distances are a part of the clip volume, at which lines are clipped",
                "OpenGL 4.5: 13.5 Primitive Clipping: clip distances are a part of the clip volume, at which lines are clipped",
                "OpenGL 4.6: 13.7 Primitive Clipping: clip distances are a part of the clip volume, at which lines are clipped",
            ]),
        ),
        lines_cover_texels: narrowed(
            true,
            false,
            Grade::Disputed,
            text.cite([
                "OpenGL 3.3: 3.5.1 Basic Line Segment Rasterization: a fragment may deviate by one unit from that of the diamond-exit rule, and one may be missing (read as: at the ends, and beside slanted lines)",
                "OpenGL 4.5: 14.5.1 Basic Line Segment Rasterization: a fragment may deviate by one unit from that of the diamond-exit rule, and one may be missing (read as: at the ends, and beside slanted lines)",
                "OpenGL 4.6: 14.5.1 Basic Line Segment Rasterization: a fragment may deviate by one unit from that of the diamond-exit rule, and one may be missing (read as: at the ends, and beside slanted lines)",
            ]),
        ),
        lines_cover_their_shape: permit(
            false,
            "OpenGL: 14.5.1 Basic Line Segment Rasterization (3.3: 3.5.1): a fragment may deviate by one unit from that of the diamond-exit rule",
        ),
        lines_lack: permit(
            Some(1),
            text.cite([
                "OpenGL 3.3: 3.5.1 Basic Line Segment Rasterization: the number of fragments differs by at most one from that of the diamond-exit rule",
                "OpenGL 4.5: 14.5.1 Basic Line Segment Rasterization: the number of fragments differs by at most one from that of the diamond-exit rule",
                "OpenGL 4.6: 14.5.1 Basic Line Segment Rasterization: the number of fragments differs by at most one from that of the diamond-exit rule",
            ]),
        ),
        biases_lines: permit(
            false,
            text.cite([
                "OpenGL 3.3: 3.6.5 Depth Offset: of polygons",
                "OpenGL 4.5: 14.6.5 Depth Offset: of polygons",
                "OpenGL 4.6: 14.6.5 Depth Offset: of polygons",
            ]),
        ),
        points_face_front: permit(
            true,
            text.cite([
                "OpenGL 3.3: 4.1.4 Stencil Test, 3.9.2 Shader Execution: points and lines are front-facing",
                "OpenGL 4.5: 17.3.3 Stencil Test, 15.2.2 Shader Inputs: points and lines are front-facing",
                "OpenGL 4.6: 17.3.3 Stencil Test, 15.2.2 Shader Inputs: points and lines are front-facing",
            ]),
        ),
        outlines_face_as_polygons: permit(
            true,
            text.cite([
                "OpenGL 3.3: 3.9.2 Shader Execution, 4.1.4 Stencil Test: a triangle's fragments face by its area, also if it is drawn as points or lines",
                "OpenGL 4.5: 15.2.2 Shader Inputs, 17.3.3 Stencil Test: a triangle's fragments face by its area, also if it is drawn as points or lines",
                "OpenGL 4.6: 15.2.2 Shader Inputs, 17.3.3 Stencil Test: a triangle's fragments face by its area, also if it is drawn as points or lines",
            ]),
        ),
        early_updates: narrowed(
            EarlyUpdates::Happen,
            EarlyUpdates::Each,
            Grade::Disputed,
            text.cite([
                "OpenGL 4.6: 14.9.4 The Early Fragment Test Qualifier: depth and stencil are updated before the shader runs, though GLSL has discard update nothing",
                "OpenGL 4.5: 14.9.4 The Early Fragment Test Qualifier: depth and stencil are updated before the shader runs, though GLSL has discard update nothing",
                "OpenGL 4.6: 14.9.4 The Early Fragment Test Qualifier: depth and stencil are updated before the shader runs, though GLSL has discard update nothing",
            ]),
        ),
        early_coverage: permit(
            EarlyUpdates::Each,
            text.cite([
                "OpenGL 4.6: 14.9.4 The Early Fragment Test Qualifier: depth and stencil may be updated even for fragments discarded afterwards",
                "OpenGL 4.5: 14.9.4 The Early Fragment Test Qualifier: depth and stencil may be updated even for fragments discarded afterwards",
                "OpenGL 4.6: 14.9.4 The Early Fragment Test Qualifier: depth and stencil may be updated even for fragments discarded afterwards",
            ]),
        ),
        early_mask: permit(
            EarlyUpdates::Each,
            text.cite([
                "OpenGL 4.6: 14.9.4 The Early Fragment Test Qualifier: depth and stencil may be updated even for samples discarded afterwards",
                "OpenGL 4.5: 14.9.4 The Early Fragment Test Qualifier: depth and stencil may be updated even for samples discarded afterwards",
                "OpenGL 4.6: 14.9.4 The Early Fragment Test Qualifier: depth and stencil may be updated even for samples discarded afterwards",
            ]),
        ),
        early_ignores_written: permit(
            true,
            text.cite([
                "OpenGL 4.6: 14.9.4 The Early Fragment Test Qualifier: a depth that the shader computes has no effect",
                "OpenGL 4.5: 14.9.4 The Early Fragment Test Qualifier: a depth that the shader computes has no effect",
                "OpenGL 4.6: 14.9.4 The Early Fragment Test Qualifier: a depth that the shader computes has no effect",
            ]),
        ),
        covers_one_sample: permit(
            false,
            text.cite([
                "OpenGL 3.3: 4.1.3 Multisample Fragment Operations: no change where SAMPLE_BUFFERS is not one",
                "OpenGL 4.5: 14.9.3 Multisample Fragment Operations, 17.3.1 Alpha To Coverage: skipped where SAMPLE_BUFFERS is not one",
                "OpenGL 4.6: 14.9.3 Multisample Fragment Operations, 17.3.1 Alpha To Coverage: skipped where SAMPLE_BUFFERS is not one",
            ]),
        ),
        mask_of_one: narrowed(
            MaskOfOne::Ignored,
            MaskOfOne::Either,
            Grade::RequiredByCts,
            text.cite([
                "OpenGL 3.3 with GL_ARB_sample_shading: Multisample Fragment Operations: skipped where SAMPLE_BUFFERS is not one; GLSL: coverage becomes the AND; dEQP-GL45-ES31.functional.shaders.sample_variables.sample_mask.*.singlesample_* demands that nothing is lost",
                "OpenGL 4.5: 14.9.3 Multisample Fragment Operations, with the mask that a shader writes, is skipped where SAMPLE_BUFFERS is not one; GLSL 4.50 7.1: coverage becomes the AND; dEQP-GL45-ES31.functional.shaders.sample_variables.sample_mask.*.singlesample_* demands that nothing is lost",
                "OpenGL 4.6: 14.9.3 Multisample Fragment Operations, with the mask that a shader writes, is skipped where SAMPLE_BUFFERS is not one; GLSL 4.60 7.1.5: coverage becomes the AND; dEQP-GL45-ES31.functional.shaders.sample_variables.sample_mask.*.singlesample_* demands that nothing is lost",
            ]),
        ),
        goes_on_unshaded: narrowed(
            true,
            false,
            Grade::Disputed,
            text.cite([
                "OpenGL 3.3: 3.9 Fragment Shaders: without a fragment shader the results of its execution are undefined, read as those that a shader would write: colours, not the depth that rasterization made",
                "OpenGL 4.5: chapter 15: without a fragment shader the results of its execution are undefined, read as those that a shader would write: 14.9.4 has the tests performed, 15.2.3 with the depth of rasterization",
                "OpenGL 4.6: chapter 15: without a fragment shader the results of its execution are undefined, read as those that a shader would write: 14.9.4 has the tests performed, 15.2.3 with the depth of rasterization",
            ]),
        ),
        input_mask: permit(
            match text {
                OpenGlText::V33 | OpenGlText::V45 => InputMaskRule::OfRunIfAsked,
                OpenGlText::V46 => InputMaskRule::OfAnyRun,
            },
            text.cite([
                "OpenGL 3.3 with GL_ARB_gpu_shader5: 3.12.2 Shader Inputs: a bit if its sample is covered for the run, of which 3.3.1 asks for a least number",
                "OpenGL 4.5: 15.2.2 Shader Inputs: the samples covered for the run, of which 14.3.1.1 asks for a least number; the current sample's bit alone where gl_SampleID asks for it",
                "OpenGL 4.6: 15.2.2 Shader Inputs: the samples covered for the run, of which 14.3.1.1 asks for a least number; the current sample's bit alone where gl_SampleID asks for it; of several runs exactly one has a covered sample's bit",
            ]),
        ),
        input_mask_lacks_masked: permit(
            true,
            text.cite([
                "OpenGL 3.3 with GL_ARB_gpu_shader5: 3.12.2 Shader Inputs: no bits of samples that SAMPLE_COVERAGE or SAMPLE_MASK kills",
                "OpenGL 4.5: 15.2.2 Shader Inputs: no bits of samples that SAMPLE_COVERAGE or SAMPLE_MASK kills",
                "OpenGL 4.6: 15.2.2 Shader Inputs: no bits of samples that SAMPLE_COVERAGE or SAMPLE_MASK kills",
            ]),
        ),
        mask_acts_first: permit(
            true,
            text.cite([
                "OpenGL 3.3: 4.1.3 Multisample Fragment Operations: the sample mask is applied before the early tests",
                "OpenGL 4.5: 14.9.3 Multisample Fragment Operations: the sample mask is applied before the early tests",
                "OpenGL 4.6: 14.9.3 Multisample Fragment Operations: the sample mask is applied before the early tests",
            ]),
        ),
        early_counts: permit(
            EarlyUpdates::Either,
            text.cite([
                "OpenGL 4.6: 14.9.4 The Early Fragment Test Qualifier: occlusion counts may be updated even for fragments discarded afterwards",
                "OpenGL 4.5: 14.9.4 The Early Fragment Test Qualifier: occlusion counts may be updated even for fragments discarded afterwards",
                "OpenGL 4.6: 14.9.4 The Early Fragment Test Qualifier: occlusion counts may be updated even for fragments discarded afterwards",
            ]),
        ),
        samples_counted: permit(
            SamplesCounted::PassingOrAll,
            text.cite([
                "OpenGL 3.3: 4.1.6 Occlusion Queries: the samples whose coverage bit is set, or at the implementation's discretion SAMPLES if any is",
                "OpenGL 4.5: 17.3.5 Occlusion Queries: the samples whose coverage bit is set, or at the implementation's discretion SAMPLES if any is",
                "OpenGL 4.6: 17.3.5 Occlusion Queries: the samples whose coverage bit is set, or at the implementation's discretion SAMPLES if any is",
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
                "OpenGL 3.3: Appendix A, Invariance: shaders that assign gl_FragCoord.z to gl_FragDepth are depth-invariant with respect to each other",
                "OpenGL 4.5: Appendix A, Invariance: shaders that assign gl_FragCoord.z to gl_FragDepth are depth-invariant with respect to each other",
                "OpenGL 4.6: Appendix A, Invariance: shaders that assign gl_FragCoord.z to gl_FragDepth are depth-invariant with respect to each other",
            ]),
        ),
        filter_step: permit(
            1.0 / 16.0,
            text.cite([
                "OpenGL 3.3: silent on the precision of filter weights; Vulkan: at least 4 bits",
                "OpenGL 4.5: silent on the precision of filter weights; Vulkan: at least 4 bits",
                "OpenGL 4.6: silent on the precision of filter weights; Vulkan: at least 4 bits",
            ]),
        ),
        filters_to_codes: permit(
            true,
            text.cite([
                "OpenGL 3.3: silent on the precision of a filtered value (read as: no coarser than the format's codes in any step)",
                "OpenGL 4.5: silent on the precision of a filtered value (read as: no coarser than the format's codes in any step)",
                "OpenGL 4.6: silent on the precision of a filtered value (read as: no coarser than the format's codes in any step)",
            ]),
        ),
        half_overflows: narrowed(
            true,
            false,
            Grade::Disputed,
            "OpenGL: 2.3.4.2 16-Bit Floating-Point Numbers (3.3: 2.1.2): infinity stands for magnitudes that are too large; no sentence gives the result of a conversion",
        ),
        flushes_small_floats: permit(
            FlushedFloats::Half,
            text.cite([
                "OpenGL 3.3: 2.1.2 16-Bit Floating-Point Numbers: denormalized numbers give predictable results, and no conversion to these floats is stated",
                "OpenGL 4.5: 2.3.4.2 16-Bit Floating-Point Numbers: denormalized numbers give predictable results, and no conversion to these floats is stated",
                "OpenGL 4.6: 2.3.4.2 16-Bit Floating-Point Numbers: denormalized numbers give predictable results, and no conversion to these floats is stated",
            ]),
        ),
        small_floats: permit(
            SmallFloats::NearestOrTowardsZero,
            text.cite([
                "OpenGL 3.3: 2.1.3, 2.1.4 Unsigned 11-Bit and 10-Bit Floating-Point Numbers: the closest finite value, or always towards zero",
                "OpenGL 4.5: 2.3.4.3, 2.3.4.4 Unsigned 11-Bit and 10-Bit Floating-Point Numbers: the closest finite value, or always towards zero",
                "OpenGL 4.6: 2.3.4.3, 2.3.4.4 Unsigned 11-Bit and 10-Bit Floating-Point Numbers: the closest finite value, or always towards zero",
            ]),
        ),
        runs_for_discarded: run_rule(
            text,
            "OpenGL 4.5: 7.12.1 Shader Memory Access Ordering: a run for every fragment that reaches the shader",
            "OpenGL 4.6: 7.13.1 Shader Memory Access Ordering: a run for every fragment that reaches the shader; 15.2 Shader Execution lets runs be skipped if rendering is otherwise the same",
        ),
        runs_for_overwritten: run_rule(
            text,
            "OpenGL 4.5: 7.12.1 Shader Memory Access Ordering: a run for every fragment that reaches the shader",
            "OpenGL 4.6: 7.13.1 Shader Memory Access Ordering: a run for every fragment that reaches the shader; 15.2 Shader Execution lets runs be skipped if rendering is otherwise the same",
        ),
        skips_rejected: run_rule(
            text,
            "OpenGL 4.5: 7.12.1 Shader Memory Access Ordering: no run for a fragment that early tests discard",
            "OpenGL 4.6: 7.13.1 Shader Memory Access Ordering: no run for a fragment that early tests discard; 15.2 Shader Execution lets additional ones happen if rendering is otherwise the same",
        ),
        runs_once: run_rule(
            text,
            "OpenGL 4.5: 7.12.1 Shader Memory Access Ordering: exactly one run per fragment without several samples, else at most one per covered sample",
            "OpenGL 4.6: 7.13.1 Shader Memory Access Ordering: exactly one run per fragment without several samples, else at most one per covered sample; 15.2 Shader Execution lets additional ones happen if rendering is otherwise the same",
        ),
        samples_as_told: if old {
            permit(true, "OpenGL 3.3: 3.3.1 Multisampling: SAMPLES is the number of samples")
        } else {
            narrowed(
                true,
                false,
                Grade::Disputed,
                "OpenGL 4.5, 4.6: 14.3.1 Multisampling: a pixel's coverage has SAMPLES bits, and the number of sample points may be different from SAMPLES",
            )
        },
        runs_by_share: narrowed(
            true,
            false,
            Grade::Disputed,
            text.cite([
                "OpenGL 4.6: 14.3.1.1 Sample Shading: at least max(ceil(share x samples), 1) sets of inputs; 7.13.1: 1 to N runs where the shader itself does not ask for samples",
                "OpenGL 4.5: 14.3.1.1 Sample Shading: at least max(ceil(share x samples), 1) sets of inputs; 7.12.1: 1 to N runs where the shader itself does not ask for samples",
                "OpenGL 4.6: 14.3.1.1 Sample Shading: at least max(ceil(share x samples), 1) sets of inputs; 7.13.1: 1 to N runs where the shader itself does not ask for samples",
            ]),
        ),
        alpha_to_coverage: if old { permit(
                AlphaToCoverage::Any,
                "OpenGL 3.3: 4.1.3 Multisample Fragment Operations: no particular algorithm; that the ends give none and all is intended",
            ) } else { narrowed(
                AlphaToCoverage::Ends,
                AlphaToCoverage::Any,
                Grade::RequiredByCts,
                text.cite([
                    "OpenGL 3.3: 4.1.3 Multisample Fragment Operations: intended; dEQP-GL45-ES3.functional.multisample.*.proportionality_alpha_to_coverage demands the ends",
                    "OpenGL 4.5: 17.3.1 Alpha To Coverage: intended; dEQP-GL45-ES3.functional.multisample.*.proportionality_alpha_to_coverage demands the ends",
                    "OpenGL 4.6: 17.3.1 Alpha To Coverage: intended; dEQP-GL45-ES3.functional.multisample.*.proportionality_alpha_to_coverage demands the ends",
                ]),
            ) },
        colorless_alpha_to_coverage: permit(
            AlphaToCoverage::Any,
            text.cite([
                "OpenGL 3.3: 4.1.3 Multisample Fragment Operations: no particular algorithm; that the ends give none and all is intended",
                "OpenGL 4.5: 17.3.1 Alpha To Coverage: that the ends give none and all is intended; no case of the CTS lacks a colour attachment",
                "OpenGL 4.6: 17.3.1 Alpha To Coverage: that the ends give none and all is intended; no case of the CTS lacks a colour attachment",
            ]),
        ),
        sample_coverage: if old { permit(
                AlphaToCoverage::Any,
                "OpenGL 3.3: 4.1.3 Multisample Fragment Operations: a function of the coverage value, inverted bit by bit; that the ends give none and all is intended",
            ) } else { narrowed(
                AlphaToCoverage::Ends,
                AlphaToCoverage::Any,
                Grade::RequiredByCts,
                text.cite([
                    "OpenGL 3.3: 4.1.3 Multisample Fragment Operations",
                    "OpenGL 4.5: 14.9.3 Multisample Fragment Operations: a function of the coverage value, inverted bit by bit; dEQP-GL45-ES3.functional.multisample.*.proportionality_sample_coverage demands the ends",
                    "OpenGL 4.6: 14.9.3 Multisample Fragment Operations: a function of the coverage value, inverted bit by bit; dEQP-GL45-ES3.functional.multisample.*.proportionality_sample_coverage demands the ends",
                ]),
            ) },
        frag_coord: permit(
            FragCoord::Inputs,
            text.cite([
                "OpenGL 3.3: 3.3.1 Multisampling: associated data anywhere within the pixel",
                "OpenGL 4.5: 14.3.1 Multisampling: associated data anywhere within the pixel",
                "OpenGL 4.6: 14.3.1 Multisampling: associated data anywhere within the pixel",
            ]),
        ),
        inputs_at_samples: permit(
            true,
            text.cite([
                "OpenGL 3.3: ARB_sample_shading, 3.3.1: with a share of 1, each sample's data is evaluated at its location",
                "OpenGL 4.5: 14.3.1.1 Sample Shading: with a share of 1, each sample's data is evaluated at its location",
                "OpenGL 4.6: 14.3.1.1 Sample Shading: with a share of 1, each sample's data is evaluated at its location",
            ]),
        ),
        facing: text.cite([
            "OpenGL 3.3: 3.6.1 Basic Polygon Rasterization: front by the sign of the area",
            "OpenGL 4.5: 14.6.1 Basic Polygon Rasterization: front by the sign of the area",
            "OpenGL 4.6: 14.6.1 Basic Polygon Rasterization: front by the sign of the area",
        ]),
        own_pass: text.cite([
            "OpenGL 3.3: ARB_texture_barrier: TextureBarrier",
            "OpenGL 4.5: 9.3.1 Rendering Feedback Loops: TextureBarrier",
            "OpenGL 4.6: 9.3.1 Rendering Feedback Loops: TextureBarrier",
        ]),
        stencil: text.cite([
            "OpenGL 3.3: 4.1.4 Stencil Test: integer operations",
            "OpenGL 4.5: 17.3.3 Stencil Test: integer operations",
            "OpenGL 4.6: 17.3.3 Stencil Test: integer operations",
        ]),
        write_mask: text.cite([
            "OpenGL 3.3: 4.2.2 Fine Control of Buffer Updates",
            "OpenGL 4.5: 17.4.2 Fine Control of Buffer Updates",
            "OpenGL 4.6: 17.4.2 Fine Control of Buffer Updates",
        ]),
    }
}
