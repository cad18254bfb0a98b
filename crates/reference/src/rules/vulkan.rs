//! Vulkan's permissions.

use super::{BlendPrecision, DepthOrder, Rounding, Rules, SharedEdge, Snap, permit};

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
        facing: "Vulkan: Basic Polygon Rasterization: front by the sign of the area; zero area is \
                 not front",
        stencil: "Vulkan: Stencil Test: integer operations",
        write_mask: "Vulkan: Color Write Mask: components not written keep their value",
    }
}
