//! OpenGL's permissions (4.6 core profile).

use super::{
    BiasUnit, BlendPrecision, DepthOrder, DepthRange, FactorClamp, Resolve, Rounding, Rules,
    SharedEdge, Snap, permit,
};

pub(super) fn rules() -> Rules {
    Rules {
        name: "opengl",
        float_error: permit(
            1e-5,
            "OpenGL 4.6: 2.3.4 Floating-Point Computation: accurate to about 1 part in 10^5",
        ),
        decode_error: permit(
            1e-5,
            "OpenGL 4.6: 2.3.5.1 Conversion from Normalized Fixed-Point to Floating-Point, at the \
             accuracy of 2.3.4",
        ),
        snap: permit(
            Snap::EitherSide,
            "OpenGL 4.6: table 23.69 SUBPIXEL_BITS: the rounding to the grid is not stated",
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
                unorm: (0.999, 1e9),
                float: (0.499, 1e9),
            },
            "OpenGL 4.6: 14.6.5 Depth Offset: the least r that is sure to be resolved; how much more is open",
        ),
        depth_range: permit(
            DepthRange::Either,
            "OpenGL 4.6: 17.3.4 Depth Buffer Test: held to 0 and 1; the drivers under it may hold it to the depth range",
        ),
        factor_clamp: permit(
            FactorClamp::Clamped,
            "OpenGL 4.6: 17.3.6.1 Blend Equation: factors are clamped for normalized attachments",
        ),
        resolve: permit(
            Resolve::Between,
            "OpenGL 4.6: 18.3.1 Blitting Pixel Rectangles: the resolve is implementation-dependent",
        ),
        points_face_front: permit(true, "OpenGL 4.6: 17.3.3: points and lines use front state"),
        outlines_face_as_polygons: permit(
            false,
            "OpenGL 4.6: 14.6.4 Polygon Rasterization Modes: what gl_FrontFacing is on edges is not stated",
        ),
        alpha_to_coverage: "OpenGL 4.6: 17.3.1 Multisample Fragment Operations: intended; dEQP-GLES3 multisample.alpha_to_coverage demands the ends",
        facing: "OpenGL 4.6: 14.6.1 Basic Polygon Rasterization: front by the sign of the area",
        stencil: "OpenGL 4.6: 17.3.3 Stencil Test: integer operations",
        write_mask: "OpenGL 4.6: 17.4.2 Fine Control of Buffer Updates",
    }
}
