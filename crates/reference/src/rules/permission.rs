//! Permissions as data: the choices that a specification leaves open, each with its citation.

use etalon_frame::{ChannelEncoding, Grade};
use etalon_scene::Pass;
use std::sync::atomic::{AtomicBool, Ordering};

/// A permission with its citation and the evidence for what it forbids. It records whether it was asked for,
/// so that results can be reused under all rules that agree on the permissions that were asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Permission<T> {
    pub(super) value: T,
    /// The section that grants it.
    pub citation: &'static str,
    /// The evidence for what the permission forbids beyond [`Permission::wide`].
    pub grade: Grade,
    /// The permission without this evidence; equal to the value if the grade is proven.
    pub wide: T,
    asked: Asked,
}

impl<T: Copy> Permission<T> {
    /// Returns the permission, by all evidence.
    pub fn value(&self) -> T {
        self.asked.0.store(true, Ordering::Relaxed);
        self.value
    }

    fn was_asked(&self) -> bool {
        self.asked.0.load(Ordering::Relaxed)
    }

    /// Replaces the permission.
    pub fn set(&mut self, value: T) {
        self.value = value;
    }

    /// Returns the permission that evidence of at least this grade supports.
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

/// True if a permission was asked for since it was made or cloned. Ignored when permissions are compared.
#[derive(Debug, Default)]
struct Asked(AtomicBool);

impl Asked {
    /// Returns the state of a permission that was not asked for.
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

/// Returns a permission that is bounded by a "must" of the specification.
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

/// Returns the step of a grid with this many bits.
pub(super) fn step(bits: u8) -> f64 {
    (-f64::from(bits)).exp2()
}

/// Snapping of vertices to the sub-pixel grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Snap {
    /// To the grid line on either side of the position.
    EitherSide,
    /// To the nearest grid line.
    Nearest,
}

/// Coverage of a sample on the shared edge of two triangles, or so close to it that either may cover it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SharedEdge {
    /// Exactly one of two triangles whose edges have identical end points covers it.
    ExactlyOne,
    /// Unspecified: either triangle, both or neither may cover the sample.
    Independent,
    /// The triangle for which the edge is a top or left edge covers it.
    TopLeft,
}

/// Conversion of a real number to a normalized integer code.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rounding {
    /// Either of the two nearest codes; an exactly representable value is exact.
    EitherNeighbour,
    /// Any code within this distance, in codes.
    Within(f64),
}

/// The precision of blending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlendPrecision {
    /// Every operand and result may be rounded to one of the destination's neighbouring codes, to a neighbouring
    /// float with as many significand bits, or to a neighbouring binary fraction with as many bits.
    DestinationCodes,
    /// Like `DestinationCodes`; into normalized formats, every operand and product may also be off by less than one
    /// code by itself. 0 and ±1 are exact, and so are sums.
    AnySteps,
    /// Like `DestinationCodes`, and in channels of at most 8 bits with any number of even steps between 0 and 1, from
    /// that of the codes to four times as many, or with operands in codes and floats after that. It takes hundreds of blends, so only frames that violate `DestinationCodes` are judged by it.
    UniformSteps,
    /// Blending is computed in 32-bit floating-point.
    Float32,
}

/// The values that a depth test compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthOrder {
    /// The incoming value is compared before or after its conversion to the attachment's encoding.
    Either,
    /// A depth that the shader writes is converted first; others may be compared before or after.
    WrittenConvertedFirst,
    /// The converted codes are compared.
    ConvertedFirst,
}

/// The least step of depth that a bias counts in, in multiples of `2^-bits` for normalized depth and of
/// `2^(exponent - 23)` for float depth: a least and a greatest value for each reading of the specification.
/// The implementation chooses one reading and, for normalized depth, one step for a whole attachment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BiasUnit {
    /// For normalized depth of 16 bits.
    pub unorm16: &'static [(f64, f64)],
    /// For normalized depth of other bits.
    pub unorm: &'static [(f64, f64)],
    /// For float depth, by the exponent of the primitive's greatest depth.
    pub float: &'static [(f64, f64)],
    /// The assumed part of the range; `None` for the whole range.
    pub assumed: Option<(f64, f64)>,
}

impl BiasUnit {
    /// Returns the unit of an API that leaves the step of normalized depth open above.
    pub(super) const fn open_above(float: &'static [(f64, f64)]) -> Self {
        Self {
            unorm16: &[(0.999, 1e9)],
            unorm: &[(0.999, 1e9)],
            float,
            assumed: None,
        }
    }

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
        let readings = self.readings(encoding).iter().copied();
        let hull = readings.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        self.assumed.or(hull).unwrap_or((1.0, 1.0))
    }
}

/// Conversion of a finite value to an unsigned float of 11 or 10 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SmallFloats {
    /// Rounds to either neighbour. Values above the largest become the largest value or infinity.
    EitherNeighbour,
    /// Rounds to nearest, or always towards zero. Values above the largest become the largest value.
    NearestOrTowardsZero,
}

/// The floats whose subnormal values may be stored as zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlushedFloats {
    /// None.
    None,
    /// Those of 16 bits.
    Half,
    /// Those of 16, 11 and 10 bits.
    All,
}

/// Clamping of the blend constant to 0 to 1, whatever the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConstantClamp {
    /// Never clamped.
    Never,
    /// Clamped when it is set.
    Always,
    /// Clamped or not.
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

/// The range to which blending clamps source, destination and constant for a signed normalized format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignedClamp {
    /// -1 to 1.
    Signed,
    /// 0 to 1.
    Unit,
    /// Either range.
    Either,
}

/// The advanced blends of a negative alpha that are defined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NegativeAlpha {
    /// All.
    Defined,
    /// Those into normalized attachments, whose inputs are clamped.
    IfNormalized,
    /// None.
    Undefined,
}

/// The codes that a copy of stored values returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Copies {
    /// The stored codes.
    Exact,
    /// Possibly other codes of the same value; any codes for infinities, NaN and subnormal values.
    SameNumbers,
}

/// Logic operations on sRGB attachments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SrgbLogic {
    /// The source is stored unchanged.
    PassesThrough,
    /// The operation works on the encoded codes.
    Applies,
    /// Either behaviour.
    Either,
}

/// Alpha to coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlphaToCoverage {
    /// Alpha 0 gives no samples, alpha 1 all samples, and any alpha in between any samples.
    Ends,
    /// Alpha 1 gives all samples, and any other alpha any samples.
    Opaque,
    /// Any alpha gives any samples.
    Any,
}

/// The result of a depth outside the viewport's range that a shader or a bias produced, if the draw does not
/// clamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthRange {
    /// Any depth from 0 to 1.
    Undefined,
    /// The depth clamped to 0 to 1.
    Unit,
    /// The depth clamped to the viewport's range or to 0 to 1.
    Either,
    /// A shader's depth is clamped to the viewport's range, a biased depth to that range or to 0 to 1.
    ViewportIfWritten,
}

/// The result of resolving a texel's samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resolve {
    /// Any value between the least and the greatest sample; for integers, one of the samples.
    Between,
    /// Any value between the least and the greatest sample; for integers, the first sample.
    BetweenOrFirst,
    /// The average, computed in halvings that may each be rounded to a neighbouring code; for sRGB, of the
    /// codes or of the linear values; for integers, the first sample.
    CoarseAverage,
    /// The average; for integers, one of the samples.
    Average,
}

impl Resolve {
    /// Returns true if integers resolve to their first sample.
    pub(crate) fn takes_first(self) -> bool {
        matches!(self, Self::BetweenOrFirst | Self::CoarseAverage)
    }
}

/// The terms from which the viewport computes window depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthTerms {
    /// Depth from 0 to 1 times the range, plus the near plane's depth. If the latter is 0, there is only one
    /// term.
    NearPlane,
    /// Depth from -1 to 1 times half the range, plus the middle of the range.
    Middle,
}

/// The effect of a shader's sample mask on a texel with one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaskOfOne {
    /// The first bit of the mask decides.
    Acts,
    /// No effect.
    Ignored,
    /// Either behaviour.
    Either,
}

/// Updates of depth, stencil and counters by fragments that pass forced early tests and are then
/// discarded by the shader or by alpha to coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EarlyUpdates {
    /// The updates happen.
    Happen,
    /// The updates may or may not happen.
    Either,
    /// Depth and stencil are each updated or not.
    Each,
}

/// The increment of a precise occlusion query for a fragment of several samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplesCounted {
    /// The samples that pass.
    Passing,
    /// The samples that pass, or all of the texel's samples if any passes.
    PassingOrAll,
}

/// The redraws of the same geometry that have bit-identical depths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SameDepth {
    /// Redraws whose shaders write the fragment's own depth.
    Written,
    /// Like `Written` for float attachments; the codes of others may be compared with depths that are not converted.
    WrittenAsFloat,
    /// All redraws that keep the fragment's own depth, whether their shaders write it or not.
    All,
}

/// The coordinates that a shader reads for a fragment with several samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FragCoord {
    /// The centre of the texel, or with sample shading the position of one of the run's samples.
    Sample,
    /// The point at which other inputs are interpolated.
    Inputs,
}

/// The sample mask that a shader reads, out of the samples that a primitive covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputMaskRule {
    /// With sample shading, the samples of the run; otherwise all samples.
    OfRun,
    /// The samples of the run. There can be more runs than the state demands: without sample shading, a run
    /// can have the sample and any others.
    OfAnyRun,
    /// Like `OfAnyRun`; with sample shading, also the sample together with any others.
    OfRunIfAsked,
    /// All samples, or only the run's own sample.
    AllOrOwn,
}

/// Declares the permissions of [`Rules`], so that code that narrows or lists them covers all.
macro_rules! rules {
    ($($(#[$doc:meta])* $field:ident: $kind:ty,)+) => {
        /// The permissions of a specification, or of the yardstick.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Rules {
            /// The name: `vulkan`, `opengl`, `opengl-es`, `webgpu`, `yardstick`.
            pub name: &'static str,
            /// The specification and its version: `OpenGL 3.3 (core profile)`.
            pub text: &'static str,
            $($(#[$doc])* pub $field: Permission<$kind>,)+
            /// The clause on zero-area and reversed triangles.
            pub facing: &'static str,
            /// The clause that makes stencil values exact.
            pub stencil: &'static str,
            /// The clause of reads of attachments of the own pass.
            pub own_pass: &'static str,
            /// The clause that makes unwritten channels exact.
            pub write_mask: &'static str,
        }

        impl Rules {
            /// Returns the rules that evidence of at least this grade supports.
            pub fn bound_by(&self, least: Grade) -> Self {
                Self {
                    $($field: self.$field.bound_by(least),)+
                    ..*self
                }
            }

            /// Returns the names of the permissions that were asked for since these rules were made or cloned.
            pub fn asked(&self) -> Vec<&'static str> {
                let each = [$((stringify!($field), self.$field.was_asked()),)+];
                let asked = each.into_iter().filter(|(_, asked)| *asked);
                asked.map(|(name, _)| name).collect()
            }

            /// Returns true if these rules have the same values for everything that was asked of other rules.
            /// Results computed by those rules then hold under these too, whatever the citations.
            pub fn agree_on_asked(&self, other: &Self) -> bool {
                $((!other.$field.was_asked() || self.$field.value == other.$field.value))&&+
            }

            /// Asks for the permissions that other rules were asked for.
            pub(crate) fn ask(&self, other: &Self) {
                $(if other.$field.was_asked() {
                    self.$field.value();
                })+
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
    /// Relative error of reading a normalized code as a float; 0 and 1 are exact.
    decode_error: f64,
    /// True if the restart index of a strip is detected before the base vertex is added; otherwise it may be
    /// detected before or after.
    restarts_before_base_vertex: bool,
    /// The step, in texels, to which the bounds of viewports may be rounded; 0 for none.
    viewport_step: f64,
    /// Vertex snapping.
    snap: Snap,
    /// Bits of the adapter's sub-pixel grid.
    sub_pixel_bits: u8,
    /// Coverage of samples on edges.
    shared_edge: SharedEdge,
    /// True if coverage is tested at the sample positions that the adapter reports; otherwise it may be
    /// tested anywhere in the texel, and the depth is that of the same place.
    covers_at_positions: bool,
    /// Rounding of stores and of clear values.
    store: Rounding,
    /// The precision of blending.
    blend: BlendPrecision,
    /// Relative error of each step of a blend into 32-bit floats, advanced ones aside.
    float32_blend_error: f64,
    /// True if a source alpha that weighs another channel is rounded to that channel's precision; otherwise it may be
    /// rounded to alpha's own.
    weights_by_channel: bool,
    /// True if a blend into floats that weighs source and destination by a factor and its complement is computed as
    /// the equation is written; otherwise it may be computed from their difference.
    blends_in_order: bool,
    /// The precision of advanced blending, for which 16-bit floats suffice.
    advanced_blend: BlendPrecision,
    /// Clamping of operands of blends into signed normalized formats.
    signed_clamp: SignedClamp,
    /// Clamping of results that a shader or a blend stores into signed normalized formats.
    signed_result: SignedClamp,
    /// Clamping of the blend constant.
    constant_clamp: ConstantClamp,
    /// True if alpha to one may leave all alphas except that of the first output unchanged.
    one_is_first_output: bool,
    /// True if an advanced blend into a normalized attachment is defined for a colour above its alpha.
    quotients_beyond_one: bool,
    /// Advanced blends of negative alphas, of inputs and of results.
    negative_alpha: NegativeAlpha,
    /// True if the stencil read mask also masks the reference; otherwise it may or may not.
    masks_reference: bool,
    /// Codes of colours that a copy reads back.
    copies: Copies,
    /// Logic operations on sRGB attachments.
    srgb_logic: SrgbLogic,
    /// The values that a depth test compares.
    depth_order: DepthOrder,
    /// The unit of a constant depth bias.
    depth_bias_unit: BiasUnit,
    /// True if the slope of a biased polygon may be the root of the squares; otherwise it is the larger of
    /// the two.
    slope_root: bool,
    /// True if biased depths are clamped at fragments; otherwise they may be clamped at fragments or at
    /// vertices.
    bias_clamps_fragments: bool,
    /// The terms of window depth.
    depth_terms: DepthTerms,
    /// The result of depths outside the viewport's range.
    depth_range: DepthRange,
    /// Clamping of blend factors beyond a normalized format's range.
    factor_clamp: FactorClamp,
    /// Averaging samples.
    resolve: Resolve,
    /// True if a point before the near or beyond the far plane must be discarded.
    clips_points: bool,
    /// True if a point beyond a side of the view volume must be discarded.
    clips_points_at_sides: bool,
    /// True if lines are clipped at the sides of the view volume; otherwise they may or may not be.
    clips_lines_at_sides: bool,
    /// True if lines are clipped at the near and far planes; otherwise they may or may not be.
    clips_lines_by_depth: bool,
    /// True if the visible part of a line that ends behind the eye is drawn; otherwise it may be missing.
    keeps_lines_that_end_behind: bool,
    /// True if clip distances clip lines; otherwise they may or may not.
    clips_lines_by_distance: bool,
    /// True if a line along an axis covers the texels that it runs through; otherwise it may miss any.
    lines_cover_texels: bool,
    /// True if a line covers exactly the samples in its rectangle or its parallelogram; otherwise it may cover any
    /// near it.
    lines_cover_their_shape: bool,
    /// The number of fragments that a line may lack, compared with the diamond-exit rule; `None` if no
    /// specification counts fragments.
    lines_lack: Option<usize>,
    /// True if points and lines may have their own depth bias or none; otherwise they have none.
    biases_lines: bool,
    /// True if points and lines face front; otherwise either is legal.
    points_face_front: bool,
    /// True if the edges of a polygon drawn as lines face like the polygon; otherwise either facing is legal.
    /// Culling always follows the polygon.
    outlines_face_as_polygons: bool,
    /// Updates of depth and stencil by fragments that the shader discards after forced early tests.
    early_updates: EarlyUpdates,
    /// Updates of depth and stencil by samples that alpha to coverage removes after forced early tests.
    early_coverage: EarlyUpdates,
    /// Updates of depth and stencil by samples that the shader's sample mask removes after forced early
    /// tests.
    early_mask: EarlyUpdates,
    /// True if forced early tests ignore the depth and the stencil reference that the shader writes;
    /// otherwise they may use them.
    early_ignores_written: bool,
    /// True if the draw's sample mask, alpha to coverage and alpha to one act with a single sample per texel;
    /// otherwise they are skipped.
    covers_one_sample: bool,
    /// The effect of a shader's sample mask with a single sample per texel.
    mask_of_one: MaskOfOne,
    /// True if fragments without a fragment shader pass unchanged; otherwise they may be lost or have any
    /// depth.
    goes_on_unshaded: bool,
    /// The sample mask that a shader reads.
    input_mask: InputMaskRule,
    /// True if the mask that a shader reads lacks the samples that the draw's sample mask and sample coverage
    /// remove; otherwise it may have them.
    input_mask_lacks_masked: bool,
    /// True if the sample mask excludes samples before forced early tests; otherwise it may do so before or
    /// after.
    mask_acts_first: bool,
    /// Counting of fragments discarded after forced early tests.
    early_counts: EarlyUpdates,
    /// The samples that a precise occlusion query counts, if there are several.
    samples_counted: SamplesCounted,
    /// True if clears within a pass count nothing in an enclosing occlusion query; otherwise they may count.
    clears_count_nothing: bool,
    /// True if load and store operations and resolves count nothing in an enclosing occlusion query; otherwise
    /// they may count.
    operations_count_nothing: bool,
    /// The redraws that have identical depths.
    same_depth: SameDepth,
    /// The coarsest step, in texels, to which coordinates may be rounded in filtering.
    filter_step: f64,
    /// True if each step of filtering a normalized format may be rounded to a neighbouring code.
    filters_to_codes: bool,
    /// True if a value beyond 16-bit floats is stored as the largest one or as infinity; otherwise it may be
    /// stored as anything.
    half_overflows: bool,
    /// The floats whose subnormal values may be stored as zero.
    flushes_small_floats: FlushedFloats,
    /// Conversion to floats of 11 and 10 bits.
    small_floats: SmallFloats,
    /// True if a shader that counts in storage runs for a fragment that never contributes to the attachments;
    /// otherwise it may not run.
    runs_for_discarded: bool,
    /// True if such a shader runs for a fragment that a later one overwrites; otherwise it may not run.
    runs_for_overwritten: bool,
    /// True if such a shader does not run for a fragment that forced early tests reject; otherwise it may
    /// run.
    skips_rejected: bool,
    /// True if such a shader runs at most once per fragment, or per covered sample if there are several;
    /// otherwise it may run any number of times.
    runs_once: bool,
    /// True if texels have as many samples as their state says; otherwise there can be more, and a shader runs for each.
    samples_as_told: bool,
    /// True if the sample shading fraction requires a minimum number of shader runs; otherwise one run may
    /// serve all samples.
    runs_by_share: bool,
    /// Alpha to coverage in passes with colour attachments.
    alpha_to_coverage: AlphaToCoverage,
    /// Alpha to coverage in passes without colour attachments.
    colorless_alpha_to_coverage: AlphaToCoverage,
    /// Sample coverage, with the permissions of alpha to coverage. The same value always covers the same
    /// samples, and the inverted value covers the others.
    sample_coverage: AlphaToCoverage,
    /// The fragment coordinates that a shader reads with several samples.
    frag_coord: FragCoord,
    /// True if, with a sample shading fraction of 1, each sample's inputs are evaluated at its position;
    /// otherwise they may be evaluated at any point of the texel. If the positions of coverage are open too, so are
    /// those of inputs that are interpolated at samples.
    inputs_at_samples: bool,
}

impl Rules {
    /// Returns the permission of alpha to coverage in a pass.
    pub(crate) fn alpha_to_coverage_in(&self, pass: &Pass) -> &Permission<AlphaToCoverage> {
        if pass.color.is_empty() {
            &self.colorless_alpha_to_coverage
        } else {
            &self.alpha_to_coverage
        }
    }

    /// Returns the rules with an assumed step of depth bias, in the unit of [`BiasUnit`].
    pub(crate) fn assuming(&self, step: (f64, f64)) -> Self {
        let mut rules = self.clone();
        rules.depth_bias_unit.value.assumed = Some(step);
        rules
    }
}
