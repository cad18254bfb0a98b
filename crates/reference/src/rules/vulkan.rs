//! Vulkan's permissions.

use super::{
    BiasUnit, BlendPrecision, DepthOrder, DepthRange, FactorClamp, Resolve, Rounding, Rules,
    SharedEdge, Snap, permit,
};

pub(super) fn rules() -> Rules {
    Rules {
        name: "vulkan",
        float_error: permit(
            1e-5,
            "Vulkan: Fundamentals, Floating-Point Computation: accurate to about 1 part in 10^5",
        ),
        decode_error: permit(
            1e-5,
            "Vulkan: Fundamentals, Conversion from Normalized Fixed-Point to Floating-Point, at the \
             accuracy of Floating-Point Computation",
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
        store: permit(
            Rounding::EitherNeighbour,
            "Vulkan: Fundamentals, Conversion from Floating-Point to Normalized Fixed-Point: one of \
             the two closest values, an integer exactly",
        ),
        blend: permit(
            BlendPrecision::DestinationCodes,
            "Vulkan: Blending: precision and dynamic range no lower than that used to represent \
             destination components",
        ),
        depth_order: permit(
            DepthOrder::Either,
            "Vulkan: Depth Comparison: whether the incoming depth is converted first is not stated",
        ),
        depth_bias_unit: permit(
            BiasUnit {
                unorm: (0.999, 2.001),
                float: (0.499, 1.001),
            },
            "Vulkan: Depth Bias: r at most 2 * 2^-n for fixed point, 2^(e-n) for floats, whose n may count the hidden bit",
        ),
        depth_range: permit(
            DepthRange::Undefined,
            "Vulkan: Depth Clamping and Range Adjustment: outside of the range of minDepth and maxDepth it is undefined",
        ),
        factor_clamp: permit(
            FactorClamp::Clamped,
            "Vulkan: Blending: factors are clamped for fixed-point attachments",
        ),
        resolve: permit(
            Resolve::Between,
            "Vulkan: Multisample Resolve: the average's precision is not stated",
        ),
        points_face_front: permit(true, "Vulkan: Points, Line Segments: always front-facing"),
        outlines_face_as_polygons: permit(
            false,
            "Vulkan: Polygon Mode: affects the final rasterization alone, yet lines face front; what a shader sees is not stated",
        ),
        alpha_to_coverage: "Vulkan: Multisample Coverage: alpha 0 gives no sample and alpha 1 all; dEQP-VK.pipeline.*.alpha_to_coverage demands the ends",
        facing: "Vulkan: Basic Polygon Rasterization: front by the sign of the area; zero area is \
                 not front",
        stencil: "Vulkan: Stencil Test: integer operations",
        write_mask: "Vulkan: Color Write Mask: components not written keep their value",
    }
}
