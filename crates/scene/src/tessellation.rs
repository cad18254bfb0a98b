//! Tessellated triangles: patches that the tessellator leaves unchanged.
//!
//! All levels are 1, so a patch of three vertices becomes one triangle, and the evaluation shader passes on
//! the patch's own positions. The driver can only choose the order of the vertices, and with it the facing:
//! that is what these draws test.

use crate::rasterization::FrontFace;
use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The control shader in GLSL 4.50: all levels are 1.
pub const CONTROL_GLSL: &str = include_str!("../data/tessellation/control.tesc");
/// The evaluation shader in GLSL 4.50: each corner of the domain has the position of its vertex. `ORDER` is a
/// placeholder for the order of the vertices.
pub const EVALUATION_GLSL: &str = include_str!("../data/tessellation/evaluation.tese");
/// The control shader in SPIR-V, made by `shaders/tessellation/compile`.
pub const CONTROL_SPIRV: &[u8] = include_bytes!("../data/tessellation/control.spv");
const CCW_SPIRV: &[u8] = include_bytes!("../data/tessellation/evaluation-ccw.spv");
const CW_SPIRV: &[u8] = include_bytes!("../data/tessellation/evaluation-cw.spv");

state_enum! {
    /// The corner in which the domain's coordinates begin, which determines which order is clockwise.
    DomainOrigin {
        /// v grows upwards (OpenGL 4.6, figure 11.1; Vulkan, Tessellator).
        LowerLeft = "lower-left",
        /// v grows downwards: Vulkan's default.
        UpperLeft = "upper-left",
    }
}

/// The tessellation of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tessellation {
    /// The order of each triangle's vertices in the domain, which the evaluation shader declares.
    pub order: FrontFace,
    /// The corner of the domain's origin; with `order`, it decides whether the facing is reversed.
    pub origin: DomainOrigin,
}

impl Tessellation {
    /// Returns true if a triangle has its vertices in the order of its patch.
    ///
    /// The corners of the patch's first, second and third vertex are u, v and w = 1. In the order first,
    /// second, third, the sum of Vulkan's Tessellator Vertex Winding Order is 1: counter-clockwise with the
    /// origin in the lower left, clockwise in the upper left. OpenGL 4.6, 11.2.2.1, has only the lower left.
    pub fn keeps_order(self) -> bool {
        (self.order == FrontFace::Ccw) == (self.origin == DomainOrigin::LowerLeft)
    }
}

/// Returns the evaluation shader for an order in SPIR-V, made by `shaders/tessellation/compile`.
pub fn evaluation_spirv(order: FrontFace) -> &'static [u8] {
    match order {
        FrontFace::Ccw => CCW_SPIRV,
        FrontFace::Cw => CW_SPIRV,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the sum of Vulkan, Tessellator Vertex Winding Order: twice the signed area in (u, v).
    fn area(corners: [[i32; 2]; 3]) -> i32 {
        let [[u0, v0], [u1, v1], [u2, v2]] = corners;
        u0 * v1 - u1 * v0 + u1 * v2 - u2 * v1 + u2 * v0 - u0 * v2
    }

    #[test]
    fn the_vertex_order_follows_the_domain_origin() {
        for order in FrontFace::ALL {
            for origin in DomainOrigin::ALL {
                let (order, origin) = (*order, *origin);
                let keeps = Tessellation { order, origin }.keeps_order();
                let (first, second, third) = ([1, 0], [0, 1], [0, 0]);
                let corners = if keeps {
                    [first, second, third]
                } else {
                    [first, third, second]
                };
                let counter_clockwise = match origin {
                    DomainOrigin::LowerLeft => area(corners) > 0,
                    DomainOrigin::UpperLeft => area(corners) < 0,
                };
                assert_eq!(counter_clockwise, order == FrontFace::Ccw);
            }
        }
    }

    /// SPIR-V, Execution Mode: opcode 16, VertexOrderCw 4, VertexOrderCcw 5.
    #[test]
    fn the_modules_declare_their_order() {
        let orders = |bytes: &[u8]| -> Vec<u32> {
            let words: Vec<u32> = bytes
                .chunks_exact(4)
                .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
                .collect();
            assert_eq!((words[0], bytes.len() % 4), (0x0723_0203, 0));
            let (mut rest, mut found) = (&words[5..], Vec::new());
            while let [head, ..] = rest {
                if head & 0xffff == 16 && (4..=5).contains(&rest[2]) {
                    found.push(rest[2]);
                }
                rest = &rest[(head >> 16) as usize..];
            }
            found
        };
        assert!(orders(CONTROL_SPIRV).is_empty());
        assert_eq!(orders(evaluation_spirv(FrontFace::Cw)), [4]);
        assert_eq!(orders(evaluation_spirv(FrontFace::Ccw)), [5]);
    }
}
