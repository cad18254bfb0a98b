//! Permissions as data: the set of choices that a text leaves open, each with its citation.

/// What is permitted, and where it is written.
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
    /// For normalized depth of 16 bits.
    pub unorm16: (f64, f64),
    /// For normalized depth of other bits.
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
    /// It is held to 0 and 1.
    Unit,
    /// It is held to the viewport's range or to 0 and 1.
    Either,
    /// A shader's is held to the viewport's range; one that a bias made is held to that or to 0 and 1.
    ViewportIfWritten,
}

/// What a resolve makes of a texel's samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resolve {
    /// Anything between the least and the greatest of them.
    Between,
    /// Their average.
    Average,
}

/// Whether depth, stencil and counts change for fragments that forced early tests let through and that
/// the shader discards or alpha to coverage takes away afterwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EarlyUpdates {
    /// They do.
    Happen,
    /// They do or they do not.
    Either,
}

/// What a precise occlusion query adds for a fragment of several samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplesCounted {
    /// Its samples that pass.
    Passing,
    /// Those, or all of the texel's samples when any passes.
    PassingOrAll,
}

/// Which redraws of the same geometry have the same depths, bit for bit.
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
    /// What forced early tests change for fragments that go away afterwards: depth and stencil.
    pub early_updates: Permission<EarlyUpdates>,
    /// What forced early tests count of fragments that go away afterwards.
    pub early_counts: Permission<EarlyUpdates>,
    /// Precise occlusion queries over several samples.
    pub samples_counted: Permission<SamplesCounted>,
    /// Which redraws have the same depths.
    pub same_depth: Permission<SameDepth>,
    /// The coarsest step, in texels, to which coordinates may be rounded in filtering.
    pub filter_step: Permission<f64>,
    /// Whether floats below the normal ones may be stored as zero.
    pub flushes_small_floats: Permission<bool>,
    /// What makes a shader run for each fragment that it has to run for.
    pub shader_runs: &'static str,
    /// Alpha to coverage: alpha 0 gives no sample, alpha 1 all, anything between any.
    pub alpha_to_coverage: &'static str,
    /// What is said of zero-area and reversed triangles.
    pub facing: &'static str,
    /// What makes stencil values exact.
    pub stencil: &'static str,
    /// What makes unwritten channels exact.
    pub write_mask: &'static str,
}
