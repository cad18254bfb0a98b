//! OpenGL ES's permissions (3.2; the sections read the same in 3.1).

use super::permission::{
    BiasUnit, BlendPrecision, DepthOrder, DepthRange, EarlyUpdates, FactorClamp, Resolve, Rounding,
    Rules, SameDepth, SamplesCounted, SharedEdge, Snap, permit,
};

pub(super) fn rules() -> Rules {
    Rules {
        name: "opengl-es",
        float_error: permit(
            1e-5,
            "OpenGL ES 3.2: 2.3.4.1 Floating-Point Computation: accurate to about 1 part in 10^5",
        ),
        shader_error: permit(
            3.0 * f64::from(f32::EPSILON),
            "OpenGL ES Shading Language 3.20: 4.7.1 Range and Precision: sums and products correctly rounded, quotients within 2.5 ULP",
        ),
        decode_error: permit(
            1e-5,
            "OpenGL ES 3.2: 2.3.5.1 Conversion from Normalized Fixed-Point to Floating-Point, at \
             the accuracy of 2.3.4",
        ),
        snap: permit(
            Snap::EitherSide,
            "OpenGL ES 3.2: table 21.40 SUBPIXEL_BITS: the rounding to the grid is not stated",
        ),
        shared_edge: permit(
            SharedEdge::ExactlyOne,
            "OpenGL ES 3.2: 13.7.1 Basic Polygon Rasterization: a common edge with identical end \
             points gives exactly one fragment",
        ),
        store: permit(
            Rounding::EitherNeighbour,
            "OpenGL ES 3.2: 2.3.5.2 Conversion from Floating-Point to Normalized Fixed-Point: one \
             of the two closest values, an integer exactly",
        ),
        blend: permit(
            BlendPrecision::DestinationCodes,
            "OpenGL ES 3.2: 15.1.5.1 Blend Equation: precision and dynamic range no lower than that \
             used to represent destination components",
        ),
        depth_order: permit(
            DepthOrder::Either,
            "OpenGL ES 3.2: 15.1.3 Depth Buffer Test: whether the incoming depth is converted first \
             is not stated",
        ),
        depth_bias_unit: permit(
            BiasUnit {
                unorm16: &[(0.999, 1e9)],
                unorm: &[(0.999, 1e9)],
                float: &[(0.999, 1.001)],
                assumed: None,
            },
            "OpenGL ES 3.2: 13.7.2 Depth Offset: for fixed point one r throughout the depth buffer, sure to be resolved and open above; 2^(e-n) for floats, n the bits of the mantissa (2.3.4.2 counts 10 in a 16-bit float, so 23)",
        ),
        depth_range: permit(
            DepthRange::Unit,
            "OpenGL ES 3.2: 14.2.3 Shader Outputs, 13.7.2 Depth Offset: a written or offset depth is held to 0 and 1",
        ),
        factor_clamp: permit(
            FactorClamp::Clamped,
            "OpenGL ES 3.2: 15.1.5.1 Blend Equation: factors are clamped for normalized attachments",
        ),
        resolve: permit(
            Resolve::Between,
            "OpenGL ES 3.2: 16.2.1 Blitting Pixel Rectangles: the resolve is implementation-dependent",
        ),
        points_face_front: permit(
            true,
            "OpenGL ES 3.2: 15.1.2: points and lines use front state",
        ),
        outlines_face_as_polygons: permit(false, "OpenGL ES 3.2: has no polygon modes"),
        early_updates: permit(
            EarlyUpdates::Either,
            "OpenGL ES 3.2: 13.8.4 Early Fragment Tests: depth and stencil may be updated even for fragments discarded afterwards",
        ),
        early_counts: permit(
            EarlyUpdates::Either,
            "OpenGL ES 3.2: 13.8.4 Early Fragment Tests: occlusion counts may be updated even for fragments discarded afterwards",
        ),
        samples_counted: permit(
            SamplesCounted::PassingOrAll,
            "OpenGL ES 3.2: 15.1.4 Occlusion Queries: the samples whose coverage bit is set, or at the implementation's discretion SAMPLES if any is",
        ),
        same_depth: permit(
            SameDepth::Written,
            "OpenGL ES 3.2: Appendix A, Invariance: shaders that assign gl_FragCoord.z to gl_FragDepth are depth-invariant with respect to each other",
        ),
        filter_step: permit(
            1.0 / 16.0,
            "OpenGL ES 3.2: silent on the precision of filter weights; Vulkan: at least 4 bits",
        ),
        flushes_small_floats: permit(
            true,
            "OpenGL ES 3.2: 2.3.4 Floating-Point Formats: implementations may encode denormalized 16-bit values as zero; silent on 11 and 10 bits",
        ),
        shader_runs: "OpenGL ES 3.2: 7.11.1 Shader Memory Access Ordering: the fragment shader is invoked for every fragment; dEQP-GLES31.functional.image_load_store.early_fragment_tests.no_early_fragment_tests_* demands it",
        alpha_to_coverage: "OpenGL ES 3.2: 15.1.1 Alpha To Coverage: intended; dEQP-GLES3.functional.multisample.*.proportionality_alpha_to_coverage demands the ends",
        facing: "OpenGL ES 3.2: 13.7.1 Basic Polygon Rasterization: front by the sign of the area",
        stencil: "OpenGL ES 3.2: 15.1.2 Stencil Test: integer operations",
        write_mask: "OpenGL ES 3.2: 15.2.2 Fine Control of Buffer Updates",
    }
}
