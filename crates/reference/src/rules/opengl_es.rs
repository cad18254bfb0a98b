//! OpenGL ES's permissions (3.2; the sections read the same in 3.1).

use super::{
    BiasUnit, BlendPrecision, DepthOrder, DepthRange, FactorClamp, Resolve, Rounding, Rules,
    SharedEdge, Snap, permit,
};

pub(super) fn rules() -> Rules {
    Rules {
        name: "opengl-es",
        float_error: permit(
            1e-5,
            "OpenGL ES 3.2: 2.3.4 Floating-Point Computation: accurate to about 1 part in 10^5",
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
                unorm: (0.999, 1e9),
                float: (0.499, 1e9),
            },
            "OpenGL ES 3.2: 13.7.2 Depth Offset: the least r that is sure to be resolved; how much more is open",
        ),
        depth_range: permit(
            DepthRange::Either,
            "OpenGL ES 3.2: 15.1.3 Depth Buffer Test: held to 0 and 1; the drivers under it may hold it to the depth range",
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
        alpha_to_coverage: "OpenGL ES 3.2: 15.1.1: intended; dEQP-GLES3 multisample.alpha_to_coverage demands the ends",
        facing: "OpenGL ES 3.2: 13.7.1 Basic Polygon Rasterization: front by the sign of the area",
        stencil: "OpenGL ES 3.2: 15.1.2 Stencil Test: integer operations",
        write_mask: "OpenGL ES 3.2: 15.2.2 Fine Control of Buffer Updates",
    }
}
