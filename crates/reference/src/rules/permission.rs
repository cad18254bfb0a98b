//! Permissions as data: the set of choices that a text leaves open, each with its citation.

use etalon_frame::ChannelEncoding;

/// A permission with its citation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Permission<T> {
    /// The permission.
    pub value: T,
    /// The section that grants it.
    pub citation: &'static str,
}

/// Returns a permission.
pub(super) const fn permit<T>(value: T, citation: &'static str) -> Permission<T> {
    Permission { value, citation }
}

/// Snapping of vertices to the sub-pixel grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Snap {
    /// To either grid line beside the position.
    EitherSide,
    /// To the nearest grid line.
    Nearest,
}

/// Coverage of a sample on the shared edge of two triangles, or too near to it to tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SharedEdge {
    /// Exactly one of two triangles whose edges have identical end points.
    ExactlyOne,
    /// Unspecified; each triangle decides for itself.
    Independent,
    /// The one whose top or left edge it is.
    TopLeft,
}

/// Conversion of a real number to a normalized integer code.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rounding {
    /// Either of the two nearest codes; an exactly representable value exactly.
    EitherNeighbour,
    /// Any code within this distance in codes.
    Within(f64),
}

/// The precision of blending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlendPrecision {
    /// In floating-point, or with every result rounded to one of the destination's neighbouring
    /// codes.
    DestinationCodes,
    /// In 32-bit floating-point.
    Float32,
}

/// The values that a depth test compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthOrder {
    /// The incoming value before or after its conversion to the attachment's encoding.
    Either,
    /// Codes with codes.
    ConvertedFirst,
}

/// The least step of depth that a bias counts in, in multiples of `2^-bits` for normalized depth and of
/// `2^(exponent - 23)` for float depth: at least, at most, once per reading of the text. Of these the
/// implementation chooses one reading and, for normalized depth, one step for all of an attachment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BiasUnit {
    /// For normalized depth of 16 bits.
    pub unorm16: &'static [(f64, f64)],
    /// For normalized depth of other bits.
    pub unorm: &'static [(f64, f64)],
    /// For float depth, by the exponent of the primitive's greatest depth.
    pub float: &'static [(f64, f64)],
    /// The part of these that is assumed; none: all of them.
    pub assumed: Option<(f64, f64)>,
}

impl BiasUnit {
    /// Returns the readings for an encoding.
    pub(crate) fn readings(&self, encoding: ChannelEncoding) -> &'static [(f64, f64)] {
        match encoding {
            ChannelEncoding::Unorm(16) => self.unorm16,
            ChannelEncoding::Unorm(_) => self.unorm,
            _ => self.float,
        }
    }

    /// Returns the least and the greatest step for an encoding.
    pub(crate) fn range(&self, encoding: ChannelEncoding) -> (f64, f64) {
        let all = self.readings(encoding).iter().copied();
        let hull = all.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        self.assumed.or(hull).unwrap_or((1.0, 1.0))
    }
}

/// Clamping of blend factors to the range of a normalized format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FactorClamp {
    /// Clamped.
    Clamped,
    /// Clamped or not.
    Either,
}

/// The result for a depth outside of the viewport's range that a shader or a bias produced, if the draw
/// does not clamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthRange {
    /// Anything from 0 to 1.
    Undefined,
    /// It is clamped to 0..1.
    Unit,
    /// It is clamped to the viewport's range or to 0..1.
    Either,
    /// A shader's depth is clamped to the viewport's range, a biased one to that or to 0..1.
    ViewportIfWritten,
}

/// The result of resolving a texel's samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resolve {
    /// Anything between the least and the greatest of them; of integers one of them.
    Between,
    /// Their average, computed by halvings that may each be rounded to a neighbouring code, of sRGB the
    /// codes' or the linear values'; of integers the first of them.
    CoarseAverage,
    /// Their average; of integers one of them.
    Average,
}

/// Updates of depth, stencil and counters by fragments that pass forced early tests and are then
/// discarded by the shader or by alpha to coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EarlyUpdates {
    /// They happen.
    Happen,
    /// They happen or not.
    Either,
}

/// The increment of a precise occlusion query for a fragment of several samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplesCounted {
    /// Its samples that pass.
    Passing,
    /// Those, or all of the texel's samples when any passes.
    PassingOrAll,
}

/// The redraws of the same geometry that have the same depths, bit for bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SameDepth {
    /// Those whose shaders write the fragment's own depth.
    Written,
    /// All whose depth is the fragment's own, written or not.
    All,
}

/// One specification's permissions, or the yardstick.
#[derive(Clone, Debug, PartialEq)]
pub struct Rules {
    /// The name: `vulkan`, `opengl`, `opengl-es`, `webgpu`, `yardstick`.
    pub name: &'static str,
    /// Relative error of fixed-function floating-point: viewport, interpolation, blending.
    pub float_error: Permission<f64>,
    /// Relative error of each result that a shader computes.
    pub shader_error: Permission<f64>,
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
    /// The values that a depth test compares.
    pub depth_order: Permission<DepthOrder>,
    /// The unit of a constant depth bias.
    pub depth_bias_unit: Permission<BiasUnit>,
    /// Depths outside of the viewport's range.
    pub depth_range: Permission<DepthRange>,
    /// Blend factors beyond a normalized format's range.
    pub factor_clamp: Permission<FactorClamp>,
    /// Averaging samples.
    pub resolve: Permission<Resolve>,
    /// True if points and lines face front; otherwise either is legal.
    pub points_face_front: Permission<bool>,
    /// True if the edges of a polygon drawn as lines face as the polygon; otherwise either is legal.
    /// Culling always follows the polygon.
    pub outlines_face_as_polygons: Permission<bool>,
    /// Updates of depth and stencil by fragments discarded after forced early tests.
    pub early_updates: Permission<EarlyUpdates>,
    /// Counting of fragments discarded after forced early tests.
    pub early_counts: Permission<EarlyUpdates>,
    /// Precise occlusion queries over several samples.
    pub samples_counted: Permission<SamplesCounted>,
    /// The redraws with the same depths.
    pub same_depth: Permission<SameDepth>,
    /// The coarsest step, in texels, to which coordinates may be rounded in filtering.
    pub filter_step: Permission<f64>,
    /// True if subnormal floats may be stored as zero.
    pub flushes_small_floats: Permission<bool>,
    /// The clause that requires a shader to run for a fragment.
    pub shader_runs: &'static str,
    /// Alpha to coverage: alpha 0 gives no sample, alpha 1 all, anything between any.
    pub alpha_to_coverage: &'static str,
    /// The clause on zero-area and reversed triangles.
    pub facing: &'static str,
    /// The clause that makes stencil values exact.
    pub stencil: &'static str,
    /// The clause that makes unwritten channels exact.
    pub write_mask: &'static str,
}
