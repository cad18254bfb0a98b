//! OpenGL's permissions (4.6 core profile).

use super::permission::{
    BiasUnit, BlendPrecision, DepthOrder, DepthRange, EarlyUpdates, FactorClamp, Resolve, Rounding,
    Rules, SameDepth, SamplesCounted, SharedEdge, Snap, permit,
};

pub(super) fn rules() -> Rules {
    Rules {
        name: "opengl",
        float_error: permit(
            1e-5,
            "OpenGL 4.6: 2.3.4.1 Floating-Point Computation: accurate to about 1 part in 10^5",
        ),
        shader_error: permit(
            1e-5,
            "OpenGL 4.6: 2.3.4.1 Floating-Point Computation: accurate to about 1 part in 10^5",
        ),
        decode_error: permit(
            1e-5,
            "OpenGL 4.6: 2.3.5.1 Conversion from Normalized Fixed-Point to Floating-Point, at the \
             accuracy of 2.3.4.1",
        ),
        snap: permit(
            Snap::EitherSide,
            "OpenGL 4.6: Implementation Dependent Values, SUBPIXEL_BITS: the rounding to the grid is not stated",
        ),
        shared_edge: permit(
            SharedEdge::ExactlyOne,
            "OpenGL 4.6: 14.6.1 Basic Polygon Rasterization: a common edge with identical end \
             points gives exactly one fragment",
        ),
        store: permit(
            Rounding::EitherNeighbour,
            "OpenGL 4.6: 2.3.5.2 Conversion from Floating-Point to Normalized Fixed-Point: one of \
             the two closest values, an integer exactly",
        ),
        blend: permit(
            BlendPrecision::DestinationCodes,
            "OpenGL 4.6: 17.3.6.1 Blend Equation: precision and dynamic range no lower than that \
             used to represent destination components",
        ),
        depth_order: permit(
            DepthOrder::Either,
            "OpenGL 4.6: 17.3.4 Depth Buffer Test: whether the incoming depth is converted first is \
             not stated",
        ),
        depth_bias_unit: permit(
            BiasUnit {
                unorm16: &[(0.999, 1e9)],
                unorm: &[(0.999, 1e9)],
                float: &[(0.999, 1.001)],
                assumed: None,
            },
            "OpenGL 4.6: 14.6.5 Depth Offset: for fixed point one r throughout the depth buffer, sure to be resolved and open above; 2^(e-n) for floats, n the bits of the mantissa (2.3.4.2 counts 10 in a 16-bit float, so 23)",
        ),
        depth_range: permit(
            DepthRange::Unit,
            "OpenGL 4.6: 15.2.3 Shader Outputs, 14.6.5 Depth Offset: a written or offset depth is held to 0 and 1",
        ),
        factor_clamp: permit(
            FactorClamp::Clamped,
            "OpenGL 4.6: 17.3.6.1 Blend Equation: factors are clamped for normalized attachments",
        ),
        resolve: permit(
            Resolve::Between,
            "OpenGL 4.6: 18.3.1 Blitting Pixel Rectangles: the resolve is implementation-dependent",
        ),
        points_face_front: permit(
            true,
            "OpenGL 4.6: 17.3.3 Stencil Test, 15.2.2 Shader Inputs: points and lines are front-facing",
        ),
        outlines_face_as_polygons: permit(
            true,
            "OpenGL 4.6: 17.3.3 Stencil Test: a primitive is still considered a polygon even if it is rasterized as points or lines due to the polygon mode",
        ),
        early_updates: permit(
            EarlyUpdates::Either,
            "OpenGL 4.6: 14.9.4 Early Fragment Tests: depth and stencil may be updated even for fragments discarded afterwards",
        ),
        early_counts: permit(
            EarlyUpdates::Either,
            "OpenGL 4.6: 14.9.4 Early Fragment Tests: occlusion counts may be updated even for fragments discarded afterwards",
        ),
        samples_counted: permit(
            SamplesCounted::PassingOrAll,
            "OpenGL 4.6: 17.3.5 Occlusion Queries: the samples whose coverage bit is set, or at the implementation's discretion SAMPLES if any is",
        ),
        same_depth: permit(
            SameDepth::Written,
            "OpenGL 4.6: Appendix A, Invariance: shaders that assign gl_FragCoord.z to gl_FragDepth are depth-invariant with respect to each other",
        ),
        filter_step: permit(
            1.0 / 16.0,
            "OpenGL 4.6: silent on the precision of filter weights; Vulkan: at least 4 bits",
        ),
        flushes_small_floats: permit(
            true,
            "OpenGL 4.6: 2.3.4 Floating-Point Formats: implementations may encode denormalized 16-bit values as zero; silent on 11 and 10 bits",
        ),
        shader_runs: "OpenGL 4.6: 7.13.1 Shader Memory Access Ordering: the fragment shader is invoked for every fragment; tests come after it unless early tests are forced",
        alpha_to_coverage: "OpenGL 4.6: 17.3.1 Alpha To Coverage: intended; dEQP-GLES3.functional.multisample.*.proportionality_alpha_to_coverage demands the ends",
        facing: "OpenGL 4.6: 14.6.1 Basic Polygon Rasterization: front by the sign of the area",
        stencil: "OpenGL 4.6: 17.3.3 Stencil Test: integer operations",
        write_mask: "OpenGL 4.6: 17.4.2 Fine Control of Buffer Updates",
    }
}
