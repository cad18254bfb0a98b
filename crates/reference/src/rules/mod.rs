//! What each specification permits: data with citations, one file per API.
//!
//! A cell on which a text is silent takes the union of what the other APIs permit: never nothing,
//! never the tightest. The yardstick is no permission but the quality band: 32-bit float arithmetic on
//! exact inputs, one conversion within 0.6 codes at the store, the adapter's own sub-pixel bits,
//! the top-left rule.

mod opengl;
mod opengl_es;
mod vulkan;
mod webgpu;
mod yardstick;

use etalon_frame::{Api, Limits};

/// What is permitted, and where it is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Permission<T> {
    /// The permission.
    pub value: T,
    /// The section that grants it.
    pub citation: &'static str,
}

const fn permit<T>(value: T, citation: &'static str) -> Permission<T> {
    Permission { value, citation }
}

/// How vertices are snapped to the sub-pixel grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Snap {
    /// To either grid line beside the position.
    EitherSide,
    /// To the nearest grid line.
    Nearest,
}

/// Who covers a sample that lies on an edge of two triangles, or too near to tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SharedEdge {
    /// Exactly one of two triangles whose edges have identical end points.
    ExactlyOne,
    /// Nothing is said; each triangle decides for itself.
    Independent,
    /// The one whose top or left edge it is.
    TopLeft,
}

/// How a real number becomes a normalized integer code.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rounding {
    /// Either of the two nearest codes; an exactly representable value exactly.
    EitherNeighbour,
    /// Any code within so many codes.
    Within(f64),
}

/// At which precision blending computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlendPrecision {
    /// In floating-point, or with every result rounded to one of the destination's neighbouring
    /// codes.
    DestinationCodes,
    /// In 32-bit floating-point.
    Float32,
}

/// What a depth test compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthOrder {
    /// The incoming value before or after its conversion to the attachment's encoding.
    Either,
    /// Codes with codes.
    ConvertedFirst,
}

/// The least step of depth that a bias counts in, in multiples of `2^-bits` for normalized depth
/// and of `2^(exponent - 23)` for float depth: at least, at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BiasUnit {
    /// For normalized depth of so many bits.
    pub unorm: (f64, f64),
    /// For float depth, by the exponent of the primitive's greatest depth.
    pub float: (f64, f64),
}

/// Whether blend factors of normalized formats are clamped to what the format can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FactorClamp {
    /// They are.
    Clamped,
    /// They are or they are not.
    Either,
}

/// What becomes of a depth outside of the viewport's range that a shader or a bias made, where the
/// draw does not clamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthRange {
    /// Anything from 0 to 1.
    Undefined,
    /// It is held to the viewport's range.
    Viewport,
    /// It is held to the viewport's range or to 0 and 1.
    Either,
}

/// What a resolve makes of a texel's samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resolve {
    /// Anything between the least and the greatest of them.
    Between,
    /// Their average.
    Average,
}

/// One specification's permissions, or the yardstick.
#[derive(Clone, Debug, PartialEq)]
pub struct Rules {
    /// The name: `vulkan`, `opengl`, `opengl-es`, `webgpu`, `yardstick`.
    pub name: &'static str,
    /// Relative error of fixed-function floating-point: viewport, interpolation, blending.
    pub float_error: Permission<f64>,
    /// Relative error of a normalized code read as a float; 0 and 1 are exact.
    pub decode_error: Permission<f64>,
    /// Vertex snapping.
    pub snap: Permission<Snap>,
    /// Samples on edges.
    pub shared_edge: Permission<SharedEdge>,
    /// Conversion at the store and of clear values.
    pub store: Permission<Rounding>,
    /// Blending.
    pub blend: Permission<BlendPrecision>,
    /// What a depth test compares.
    pub depth_order: Permission<DepthOrder>,
    /// What a depth bias counts in.
    pub depth_bias_unit: Permission<BiasUnit>,
    /// Depths outside of the viewport's range.
    pub depth_range: Permission<DepthRange>,
    /// Blend factors beyond a normalized format's range.
    pub factor_clamp: Permission<FactorClamp>,
    /// Averaging samples.
    pub resolve: Permission<Resolve>,
    /// Whether points and lines face front; where not, either is legal.
    pub points_face_front: Permission<bool>,
    /// Whether the edges of a polygon, drawn as lines, face as the polygon does; where not, either is
    /// legal. Culling goes by the polygon in any case.
    pub outlines_face_as_polygons: Permission<bool>,
    /// Alpha to coverage: alpha 0 gives no sample, alpha 1 all, anything between any.
    pub alpha_to_coverage: &'static str,
    /// What is said of zero-area and reversed triangles.
    pub facing: &'static str,
    /// What makes stencil values exact.
    pub stencil: &'static str,
    /// What makes unwritten channels exact.
    pub write_mask: &'static str,
}

impl Rules {
    /// The permissions of an API.
    pub fn of(api: Api) -> Self {
        match api {
            Api::Vulkan => vulkan::rules(),
            Api::OpenGl => opengl::rules(),
            Api::OpenGlEs => opengl_es::rules(),
            Api::WebGpu => webgpu::rules(),
        }
    }

    /// The quality band for an adapter.
    pub fn yardstick(limits: &Limits) -> Self {
        yardstick::rules(limits.api)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_permission_has_a_citation() {
        for api in [Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu] {
            let rules = Rules::of(api);
            assert_eq!(rules.name, api.name());
            for citation in [
                rules.float_error.citation,
                rules.decode_error.citation,
                rules.snap.citation,
                rules.shared_edge.citation,
                rules.store.citation,
                rules.blend.citation,
                rules.depth_order.citation,
                rules.depth_bias_unit.citation,
                rules.depth_range.citation,
                rules.factor_clamp.citation,
                rules.resolve.citation,
                rules.points_face_front.citation,
                rules.outlines_face_as_polygons.citation,
                rules.alpha_to_coverage,
                rules.facing,
                rules.stencil,
                rules.write_mask,
            ] {
                assert!(citation.contains(':'), "{}: {citation:?}", rules.name);
            }
        }
    }
}
