//! Permissions as data: the set of choices that a text leaves open, each with its citation.

use etalon_frame::{ChannelEncoding, Grade};
use std::sync::atomic::{AtomicBool, Ordering};

/// A permission with its citation, and the evidence for what it forbids. It remembers being asked for, so
/// that what was computed under some rules holds under all others that agree on the permissions asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Permission<T> {
    pub(super) value: T,
    /// The section that grants it.
    pub citation: &'static str,
    /// The evidence for what the permission forbids beyond [`Permission::wide`].
    pub grade: Grade,
    /// The permission by the stronger evidence alone; the same as the value where it is proven.
    pub wide: T,
    asked: Asked,
}

impl<T: Copy> Permission<T> {
    /// Returns the permission, by all evidence.
    pub fn value(&self) -> T {
        self.asked.0.store(true, Ordering::Relaxed);
        self.value
    }

    /// Replaces the permission.
    pub fn set(&mut self, value: T) {
        self.value = value;
    }

    /// Returns the permission as evidence of this grade or a stronger one leaves it.
    pub fn bound_by(&self, least: Grade) -> Self {
        let value = if self.grade < least {
            self.wide
        } else {
            self.value
        };
        Self {
            value,
            ..self.clone()
        }
    }
}

/// Permissions that were asked for, by name, with their values as text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AskedValues(Vec<(&'static str, String)>);

impl AskedValues {
    /// Returns the names of the permissions.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.0.iter().map(|(name, _)| *name)
    }
}

/// True if a permission was asked for since it was made or cloned. It is no part of what the permission is.
#[derive(Debug, Default)]
struct Asked(AtomicBool);

impl Asked {
    /// Not asked for.
    const fn not() -> Self {
        Self(AtomicBool::new(false))
    }
}

impl Clone for Asked {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl PartialEq for Asked {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Returns a permission that a must of the text bounds.
pub(super) const fn permit<T: Copy>(value: T, citation: &'static str) -> Permission<T> {
    Permission {
        value,
        citation,
        grade: Grade::Proven,
        wide: value,
        asked: Asked::not(),
    }
}

/// Returns a permission that weaker evidence narrows from `wide` to `value`.
pub(super) const fn narrowed<T: Copy>(
    value: T,
    wide: T,
    grade: Grade,
    citation: &'static str,
) -> Permission<T> {
    Permission {
        value,
        citation,
        grade,
        wide,
        asked: Asked::not(),
    }
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
    /// With every operand and result rounded to one of the destination's neighbouring codes, or to a
    /// neighbouring float with as many bits in its significand, or less coarsely.
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

/// Conversion of a finite value to a float of 11 or 10 bits without a sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SmallFloats {
    /// To either neighbour; past the largest value to that or to infinity.
    EitherNeighbour,
    /// To the nearest, or always towards zero; past the largest value to that. Subnormal values are kept.
    NearestOrTowardsZero,
}

/// Clamping of the blend constant to 0 to 1, whatever the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConstantClamp {
    /// None.
    Never,
    /// When it is set.
    Always,
    /// Either.
    Either,
}

/// Clamping of blend factors to the range of a normalized format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FactorClamp {
    /// Clamped.
    Clamped,
    /// Clamped or not.
    Either,
}

/// The range that blending clamps source, destination and constant of a signed normalized format to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignedClamp {
    /// -1 to 1.
    Signed,
    /// 0 to 1.
    Unit,
    /// Either of both.
    Either,
}

/// The codes that come back where a stored value is copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Copies {
    /// Those that are stored.
    Exact,
    /// Others of the same value, and any for infinities, NaN and subnormal values.
    SameNumbers,
}

/// Logic operations on sRGB attachments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SrgbLogic {
    /// The source is stored as it is.
    PassesThrough,
    /// The operation works on the encoded codes.
    Applies,
    /// Either of both.
    Either,
}

/// Alpha to coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlphaToCoverage {
    /// Alpha 0 gives no sample, alpha 1 all, anything between any.
    Ends,
    /// Any alpha gives any samples.
    Any,
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

/// The terms of which the viewport makes window depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthTerms {
    /// Depth from 0 to 1 times the range, and the near plane's depth: one term if that is 0.
    NearPlane,
    /// Depth from -1 to 1 times half the range, and the middle of the range.
    Middle,
}

/// The effect of a sample mask that a shader writes where a texel has one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaskOfOne {
    /// Its first bit decides.
    Acts,
    /// None.
    Ignored,
    /// Either.
    Either,
}

/// Updates of depth, stencil and counters by fragments that pass forced early tests and are then
/// discarded by the shader or by alpha to coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EarlyUpdates {
    /// They happen.
    Happen,
    /// They happen or not.
    Either,
    /// That of depth happens or not, and that of stencil.
    Each,
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

/// The coordinates that a shader reads of a fragment of several samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FragCoord {
    /// The centre of the texel, or with sample shading the position of one of the samples of the run.
    Sample,
    /// The point at which other inputs are interpolated.
    Inputs,
}

/// The sample mask that a shader reads, of the samples that a primitive covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputMask {
    /// The samples of the run with sample shading, all otherwise.
    OfRun,
    /// The samples of the run, of which there may be more than state asks for: without sample shading, the sample and
    /// any others.
    OfAnyRun,
    /// As `OfAnyRun`, and with a share the sample and any others too.
    OfRunIfAsked,
    /// All of them, or the sample alone.
    AllOrOwn,
}

/// Declares the permissions of [`Rules`], so that none is forgotten where all are narrowed or listed.
macro_rules! rules {
    ($($(#[$doc:meta])* $field:ident: $kind:ty,)+) => {
        /// One specification's permissions, or the yardstick.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Rules {
            /// The name: `vulkan`, `opengl`, `opengl-es`, `webgpu`, `yardstick`.
            pub name: &'static str,
            /// The text and its version: `OpenGL 3.3 (core profile)`.
            pub text: &'static str,
            $($(#[$doc])* pub $field: Permission<$kind>,)+
            /// The clause on zero-area and reversed triangles.
            pub facing: &'static str,
            /// The clause that makes stencil values exact.
            pub stencil: &'static str,
            /// The clause that makes unwritten channels exact.
            pub write_mask: &'static str,
        }

        impl Rules {
            /// Returns the rules as evidence of this grade or a stronger one leaves them.
            pub fn bound_by(&self, least: Grade) -> Self {
                Self {
                    $($field: self.$field.bound_by(least),)+
                    ..*self
                }
            }

            /// Returns the permissions that were asked for since these rules were made or cloned.
            pub fn asked(&self) -> AskedValues {
                let mut asked = AskedValues::default();
                $(if self.$field.asked.0.load(Ordering::Relaxed) {
                    asked.0.push((stringify!($field), format!("{:?}", self.$field.value)));
                })+
                asked
            }

            /// True if the values that were asked for of other rules are these rules' too. What was computed
            /// by those then holds by these, whatever they cite.
            pub fn agree_on(&self, asked: &AskedValues) -> bool {
                asked.0.iter().all(|(name, value)| match *name {
                    $(stringify!($field) => format!("{:?}", self.$field.value) == *value,)+
                    _ => false,
                })
            }

            /// Returns every permission's name, citation and grade.
            pub fn permissions(&self) -> Vec<(&'static str, &'static str, Grade)> {
                vec![
                    $((stringify!($field), self.$field.citation, self.$field.grade),)+
                    ("facing", self.facing, Grade::Proven),
                    ("stencil", self.stencil, Grade::Proven),
                    ("write_mask", self.write_mask, Grade::Proven),
                ]
            }
        }
    };
}

rules! {
    /// Relative error of fixed-function floating-point: viewport, interpolation, blending.
    float_error: f64,
    /// Relative error of each result that a shader computes.
    shader_error: f64,
    /// Relative error of a normalized code read as a float; 0 and 1 are exact.
    decode_error: f64,
    /// True if the index that restarts a strip is found before the base vertex is added; otherwise there or after.
    restarts_before_base_vertex: bool,
    /// Vertex snapping.
    snap: Snap,
    /// Samples on edges.
    shared_edge: SharedEdge,
    /// True if a sample is covered at the position that the adapter tells for it; otherwise anywhere in its
    /// texel.
    covers_at_positions: bool,
    /// Conversion at the store and of clear values.
    store: Rounding,
    /// Blending.
    blend: BlendPrecision,
    /// Advanced blending, which 16-bit floats are precise enough for.
    advanced_blend: BlendPrecision,
    /// Clamping of what is blended into signed normalized formats.
    signed_clamp: SignedClamp,
    /// Clamping of what a shader or a blend stores into signed normalized formats.
    signed_result: SignedClamp,
    /// Clamping of the blend constant.
    constant_clamp: ConstantClamp,
    /// True if alpha to one may leave all alphas but that of the first output as they are.
    one_is_first_output: bool,
    /// True if an advanced blend of a negative alpha has a result; otherwise it is undefined.
    blends_negative_alpha: bool,
    /// True if the stencil read mask also masks the reference; otherwise it may.
    masks_reference: bool,
    /// Codes of colours read back by a copy.
    copies: Copies,
    /// Logic operations on sRGB attachments.
    srgb_logic: SrgbLogic,
    /// The values that a depth test compares.
    depth_order: DepthOrder,
    /// The unit of a constant depth bias.
    depth_bias_unit: BiasUnit,
    /// True if the slope of a biased polygon may be the root of the squares; otherwise it is the larger growth.
    slope_root: bool,
    /// True if biased depths are clamped at fragments; otherwise there or at vertices.
    bias_clamps_fragments: bool,
    /// The terms of window depth.
    depth_terms: DepthTerms,
    /// Depths outside of the viewport's range.
    depth_range: DepthRange,
    /// Blend factors beyond a normalized format's range.
    factor_clamp: FactorClamp,
    /// Averaging samples.
    resolve: Resolve,
    /// True if a point before the near or beyond the far plane is discarded; otherwise it may be.
    clips_points: bool,
    /// True if a point beyond a side of the view volume is discarded; otherwise it may be.
    clips_points_at_sides: bool,
    /// True if lines are clipped at the sides of the view volume; otherwise they may be.
    clips_lines_at_sides: bool,
    /// True if lines are clipped at the near and far planes; otherwise they may be.
    clips_lines_by_depth: bool,
    /// True if clip distances clip lines; otherwise they may.
    clips_lines_by_distance: bool,
    /// True if a line along an axis covers the texels that it runs through; otherwise it may miss any.
    lines_cover_texels: bool,
    /// The number of fragments that a line may have less than by the diamond-exit rule; `None` if no text counts them.
    lines_lack: Option<usize>,
    /// True if points and lines face front; otherwise either is legal.
    points_face_front: bool,
    /// True if the edges of a polygon drawn as lines face as the polygon; otherwise either is legal.
    /// Culling always follows the polygon.
    outlines_face_as_polygons: bool,
    /// Updates of depth and stencil by fragments that the shader discards after forced early tests.
    early_updates: EarlyUpdates,
    /// Updates of depth and stencil by samples that alpha to coverage removes after forced early tests.
    early_coverage: EarlyUpdates,
    /// Updates of depth and stencil by samples that the shader's own mask removes after forced early tests.
    early_mask: EarlyUpdates,
    /// True if forced early tests ignore the depth and the stencil reference that the shader writes; otherwise
    /// they may.
    early_ignores_written: bool,
    /// The sample mask that a shader writes for a single sample.
    mask_of_one: MaskOfOne,
    /// True if without a fragment shader fragments go on as they were rasterized; otherwise they may be
    /// lost or have any depth.
    goes_on_unshaded: bool,
    /// The sample mask that a shader reads.
    input_mask: InputMask,
    /// True if it lacks the samples that the draw's sample mask and sample coverage remove; otherwise it may have
    /// them.
    input_mask_lacks_masked: bool,
    /// True if the sample mask excludes samples before forced early tests; otherwise before or after.
    mask_acts_first: bool,
    /// Counting of fragments discarded after forced early tests.
    early_counts: EarlyUpdates,
    /// Precise occlusion queries over several samples.
    samples_counted: SamplesCounted,
    /// True if clears, load and store operations, and resolves count nothing in an occlusion query that encloses them;
    /// otherwise they may count.
    operations_count_nothing: bool,
    /// The redraws with the same depths.
    same_depth: SameDepth,
    /// The coarsest step, in texels, to which coordinates may be rounded in filtering.
    filter_step: f64,
    /// True if each step of filtering a normalized format may be rounded to a neighbouring code.
    filters_to_codes: bool,
    /// True if a value beyond 16-bit floats is stored as the largest one or as infinity; otherwise as
    /// anything.
    half_overflows: bool,
    /// True if subnormal floats of 16 bits, and of 11 and 10 where [`Rules::small_floats`] leaves them open, may be
    /// stored as zero.
    flushes_small_floats: bool,
    /// Floats of 11 and 10 bits.
    small_floats: SmallFloats,
    /// True if a shader that counts in storage runs for a fragment that never contributes to the
    /// attachments; otherwise it may.
    runs_for_discarded: bool,
    /// True if it runs for a fragment that a later one overwrites; otherwise it may.
    runs_for_overwritten: bool,
    /// True if it does not run for a fragment that forced early tests reject; otherwise it may.
    skips_rejected: bool,
    /// True if it runs at most once per fragment, or per covered sample of several; otherwise as often as
    /// the implementation likes.
    runs_once: bool,
    /// True if the least share of sample shading sets the least number of runs; otherwise one run may serve all
    /// samples.
    runs_by_share: bool,
    /// Alpha to coverage.
    alpha_to_coverage: AlphaToCoverage,
    /// Sample coverage, as alpha to coverage. The same value covers the same samples again, and its
    /// inverse the others.
    sample_coverage: AlphaToCoverage,
    /// The fragment's coordinates that a shader of several samples reads.
    frag_coord: FragCoord,
    /// True if with sample shading of a share of 1 each sample's inputs are those at its position;
    /// otherwise at any point of the texel.
    inputs_at_samples: bool,
}

impl Rules {
    /// Returns the rules with an assumption about the step of depth bias, in the unit of [`BiasUnit`].
    pub(crate) fn assuming(&self, step: (f64, f64)) -> Self {
        let mut rules = self.clone();
        rules.depth_bias_unit.value.assumed = Some(step);
        rules
    }
}
