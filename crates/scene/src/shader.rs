//! The suite's shaders, with one row of facts each.
//!
//! Validation of scenes, requirements, backends and the judge all use these facts. Adding a shader takes one
//! row of the table at the end, one WGSL file and one Rust twin.

use crate::early_tests::EarlyTests;
use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// The location to which shaders write the stencil reference.
pub const STENCIL_REFERENCE: u32 = 1;

/// The facts of one shader.
struct ShaderFacts {
    /// The effect, in a sentence or a few. It begins with a space.
    about: &'static str,
    /// The WGSL source.
    wgsl: &'static str,
    /// False if there is only a vertex shader.
    fragment: bool,
    /// True if the shader reads the parameter block.
    params: bool,
    /// True if the vertex shader outputs only a position.
    position_only: bool,
    /// True if the shader reads interpolated texture coordinates as numbers.
    uv: bool,
    /// The interpolation of these values.
    interpolation: Interpolation,
    /// The points at which these are interpolated.
    sampling: InterpolationSampling,
    /// True if its flat colour can be that of either end of a primitive.
    either: bool,
    /// The number of textures that it reads.
    textures: usize,
    /// True if the shader reads the sample that it shades of a texture with several.
    multisampled: bool,
    /// True if the shader reads a stencil value.
    stencil: bool,
    /// True if the shader samples its texture instead of fetching single texels.
    sampler: bool,
    /// True if the shader also samples at coordinates that it computes.
    taps: bool,
    /// True if the shader reads how its texture changes from texel to texel of the picture.
    derivatives: bool,
    /// The number of colour locations that it writes.
    outputs: usize,
    /// True if the shader writes integers.
    integers: bool,
    /// True if the shader writes a second source for blending.
    second_source: bool,
    /// True if the shader writes a sample mask.
    mask: bool,
    /// True if the shader reads a sample mask.
    reads_mask: bool,
    /// True if the shader writes the stencil reference.
    reference: bool,
    /// The depth that the shader writes.
    depth: WrittenDepth,
    /// True if the shader can discard fragments.
    discards: bool,
    /// The number of clip distances that its vertices output.
    clip_distances: u32,
    /// The number of cull distances that its vertices output.
    cull_distances: u32,
    /// True if the shader counts its runs in a storage buffer.
    counter: bool,
    /// The shader's use of the scene's pool.
    pool: PoolUse,
    /// True if the shader runs once per sample.
    per_sample: bool,
    /// True if the shader reads the fragment's coordinates in the picture.
    coordinates: bool,
    /// True if the shader reads whether the fragment faces front.
    facing: bool,
    /// True if the shader reads the fragment's depth.
    reads_depth: bool,
    /// True if the shader reads 1 over the clip-space w.
    reads_w: bool,
}

/// The interpolation of an attribute over a primitive (WGSL, Interpolation).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// Linear in space.
    Perspective,
    /// Linear in the window.
    Linear,
}

/// The point at which attributes are interpolated (WGSL, Interpolation).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InterpolationSampling {
    /// The centre of the texel.
    Center,
    /// A point inside the part of the texel that the primitive covers.
    Centroid,
    /// The sample that is being shaded.
    Sample,
}

/// A shader's use of the scene's pool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoolUse {
    /// The shader does not use the pool.
    None,
    /// The shader adds its fragments to the lists of their texels.
    Append,
    /// The shader reads the list of its texel.
    ReadList,
    /// The shader stores the depths of its fragments if they are among the nearest of their texels.
    KeepNearest,
    /// The shader stores the colours of fragments whose depths are stored.
    FillNearest,
    /// The shader reads the nearest layers of its texel.
    ReadNearest,
}

/// The depth that a shader writes.
#[derive(PartialEq, Eq)]
enum WrittenDepth {
    /// The shader writes no depth; the fragment's own depth is used.
    Fixed,
    /// The red of the vertex colour.
    VertexRed,
    /// Any other value.
    Computed,
}

impl ShaderFacts {
    /// A shader that reads only vertex attributes and writes one colour.
    const PLAIN: Self = Self {
        about: "",
        wgsl: "",
        fragment: true,
        params: false,
        position_only: false,
        uv: false,
        interpolation: Interpolation::Perspective,
        sampling: InterpolationSampling::Center,
        either: false,
        textures: 0,
        multisampled: false,
        stencil: false,
        sampler: false,
        taps: false,
        derivatives: false,
        outputs: 1,
        integers: false,
        second_source: false,
        mask: false,
        reads_mask: false,
        reference: false,
        depth: WrittenDepth::Fixed,
        discards: false,
        clip_distances: 0,
        cull_distances: 0,
        counter: false,
        pool: PoolUse::None,
        per_sample: false,
        coordinates: false,
        facing: false,
        reads_depth: false,
        reads_w: false,
    };
}

/// Declares [`Shader`] and the facts of each shader from one table. A row lists only the facts that differ
/// from [`ShaderFacts::PLAIN`]; its source is `shaders/<name>.wgsl`.
macro_rules! shaders {
    ($($(#[doc = $doc:literal])* $variant:ident = $name:literal { $($fact:ident: $value:expr),* }),+ $(,)?) => {
        state_enum! {
            /// The suite's shaders. Each has a WGSL file in `shaders/` and a twin in the reference.
            Shader { $($(#[doc = $doc])* $variant = $name),+ }
        }

        /// A row per shader, in declaration order.
        static FACTS: [ShaderFacts; [$($name),+].len()] = [
            $(ShaderFacts {
                about: concat!($($doc),*),
                wgsl: include_str!(concat!("../data/", $name, ".wgsl")),
                $($fact: $value,)*
                ..ShaderFacts::PLAIN
            }),+
        ];
    };
}

impl Shader {
    fn facts(self) -> &'static ShaderFacts {
        &FACTS[self as usize]
    }

    /// Returns what the shader does: the colour that it writes, then its other effects.
    pub fn about(self) -> &'static str {
        self.facts().about.trim_start()
    }

    /// Returns the WGSL source: a vertex entry point `vs` and, unless there is only a vertex shader, a
    /// fragment entry point `fs`. Vertex inputs are location 0 position, 1 colour, 2 uv; group 0 has the
    /// parameters at binding 0, textures at bindings 1 and 2, the counter of runs or the pool at binding 3
    /// and a sampler at binding 4.
    pub fn wgsl(self) -> &'static str {
        self.facts().wgsl
    }

    /// Returns the WGSL source with the attribute that sets when the fragment tests happen.
    pub fn wgsl_with(self, tests: EarlyTests) -> Cow<'static, str> {
        let text = self.wgsl();
        match tests.attribute() {
            None => Cow::Borrowed(text),
            Some(word) => {
                let attributes = format!("@fragment @early_depth_test({word})");
                Cow::Owned(text.replacen("@fragment", &attributes, 1))
            }
        }
    }

    /// Returns the number of textures that the shader reads.
    pub fn textures(self) -> usize {
        self.facts().textures
    }

    /// Returns true if the shader reads the sample that it shades of a texture with several.
    pub fn reads_sample(self) -> bool {
        self.facts().multisampled
    }

    /// Returns true if the shader reads a stencil value. It can only read attachments of its own pass.
    pub fn reads_stencil(self) -> bool {
        self.facts().stencil
    }

    /// Returns true if the shader samples its texture instead of fetching single texels.
    pub fn samples_texture(self) -> bool {
        self.facts().sampler
    }

    /// Returns true if the shader samples texture 0 at coordinates that it computes.
    pub fn taps_texture(self) -> bool {
        self.facts().taps
    }

    /// Returns true if the shader reads how texture 0 changes from texel to texel of the picture.
    pub fn reads_derivatives(self) -> bool {
        self.facts().derivatives
    }

    /// Returns true if the fragment shader replaces the fragment's depth.
    pub fn writes_depth(self) -> bool {
        self.facts().depth != WrittenDepth::Fixed
    }

    /// Returns true if the depth that the shader writes is the vertex colour's red.
    pub fn depth_from_vertex_color(self) -> bool {
        self.facts().depth == WrittenDepth::VertexRed
    }

    /// Returns true if the shader writes a sample mask: the red of texture 0.
    pub fn writes_mask(self) -> bool {
        self.facts().mask
    }

    /// Returns true if the shader reads the sample mask of its fragment.
    pub fn reads_mask(self) -> bool {
        self.facts().reads_mask
    }

    /// Returns true if the shader writes the stencil reference of its fragments. WGSL has no built-in for it:
    /// the shader writes it as an integer to [`STENCIL_REFERENCE`], and backends replace that location.
    pub fn writes_reference(self) -> bool {
        self.facts().reference
    }

    /// Returns true if there is a fragment shader, false if only a vertex shader.
    pub fn has_fragment(self) -> bool {
        self.facts().fragment
    }

    /// Returns true if the shader can discard fragments.
    pub fn discards(self) -> bool {
        self.facts().discards
    }

    /// Returns the number of clip distances that the shader's vertices output.
    pub fn clip_distances(self) -> u32 {
        self.facts().clip_distances
    }

    /// Returns the number of cull distances that the shader's vertices output. Its WGSL calls them clip
    /// distances.
    pub fn cull_distances(self) -> u32 {
        self.facts().cull_distances
    }

    /// Returns true if the shader counts its runs in a storage buffer.
    pub fn counts_runs(self) -> bool {
        self.facts().counter
    }

    /// Returns the shader's use of the scene's pool.
    pub fn pool_use(self) -> PoolUse {
        self.facts().pool
    }

    /// Returns true if the shader stores its fragments in the scene's pool.
    pub fn adds_to_pool(self) -> bool {
        let uses = [PoolUse::Append, PoolUse::KeepNearest, PoolUse::FillNearest];
        uses.contains(&self.pool_use())
    }

    /// Returns true if the shader reads nodes from the scene's pool.
    pub fn reads_pool(self) -> bool {
        let uses = [
            PoolUse::ReadList,
            PoolUse::FillNearest,
            PoolUse::ReadNearest,
        ];
        uses.contains(&self.pool_use())
    }

    /// Returns true if the shader needs a pool with layers.
    pub fn uses_layers(self) -> bool {
        !matches!(
            self.pool_use(),
            PoolUse::None | PoolUse::Append | PoolUse::ReadList
        )
    }

    /// Returns true if the shader uses the scene's pool. The red and green of `params.color` are then the
    /// pool's size, and its blue the number of layers.
    pub fn uses_pool(self) -> bool {
        self.facts().pool != PoolUse::None
    }

    /// Returns true if the shader uses a storage buffer: a counter, or the scene's pool.
    pub fn uses_storage(self) -> bool {
        self.counts_runs() || self.uses_pool()
    }

    /// Returns true if the shader writes integers.
    pub fn writes_integers(self) -> bool {
        self.facts().integers
    }

    /// Returns the number of colour locations that the shader writes.
    pub fn outputs(self) -> usize {
        self.facts().outputs
    }

    /// Returns true if the vertex shader outputs only a position, so that no attribute reaches the fragments.
    pub fn passes_position_alone(self) -> bool {
        self.facts().position_only
    }

    /// Returns true if the shader reads the interpolated texture coordinates, to sample a texture or as
    /// numbers.
    pub fn uses_uv(self) -> bool {
        self.facts().uv || self.facts().sampler
    }

    /// Returns the interpolation of the texture coordinates.
    pub fn interpolation(self) -> Interpolation {
        self.facts().interpolation
    }

    /// Returns the points at which the texture coordinates are interpolated.
    pub fn interpolation_sampling(self) -> InterpolationSampling {
        self.facts().sampling
    }

    /// Returns true if the flat vertex colour can be that of either end of a primitive, whichever vertex
    /// provokes.
    pub fn flat_from_either(self) -> bool {
        self.facts().either
    }

    /// Returns true if the shader writes a second source for blending.
    pub fn has_second_source(self) -> bool {
        self.facts().second_source
    }

    /// Returns true if the shader runs once per sample.
    pub fn runs_per_sample(self) -> bool {
        self.facts().per_sample
    }

    /// Returns true if the shader computes with the fragment's coordinates in the picture. Coordinates that
    /// only fetch a texel do not count.
    pub fn reads_coordinates(self) -> bool {
        self.facts().coordinates
    }

    /// Returns true if the shader reads whether the fragment faces front.
    pub fn reads_facing(self) -> bool {
        self.facts().facing
    }

    /// Returns true if the shader reads the fragment's own depth.
    pub fn reads_depth(self) -> bool {
        self.facts().reads_depth
    }

    /// Returns true if the shader reads 1 over the clip-space w, the last component of the fragment
    /// coordinate.
    pub fn reads_w(self) -> bool {
        self.facts().reads_w
    }

    /// Returns true if the shader reads the parameter block.
    pub fn uses_params(self) -> bool {
        self.facts().params
    }
}

shaders! {
    /// `params.color` if the first texture coordinate, interpolated inside the primitive, is not negative;
    /// otherwise `params.back_color`.
    Centroid = "centroid" { params: true, uv: true, sampling: InterpolationSampling::Centroid },
    /// The vertex colour, flat; clipped by both texture coordinates.
    ClipFlat = "clip_flat" { clip_distances: 2 },
    /// `params.color`, clipped by eight distances: the vertex colour, the texture coordinates, alpha minus
    /// the first and blue minus the second.
    ClipUniform = "clip_uniform" { params: true, clip_distances: 8 },
    /// `params.color`; counts its runs.
    CountedColor = "counted_color" { params: true, counter: true, position_only: true },
    /// Like `flat_color_depth`, and counts its runs.
    CountedDepth = "counted_depth" { params: true, depth: WrittenDepth::VertexRed, counter: true },
    /// Like `texel_discard`, and counts its runs.
    CountedDiscard = "counted_discard" { params: true, textures: 1, discards: true, counter: true, position_only: true },
    /// The vertex colour, flat; culled by both texture coordinates.
    CullFlat = "cull_flat" { cull_distances: 2 },
    /// The fragment's own window depth as grey.
    DepthGrey = "depth_grey" { reads_depth: true, position_only: true },
    /// The distance that belongs to the window depth of a perspective projection, as grey, between the near
    /// and far planes in `params.color`'s red and green.
    DepthLinearized = "depth_linearized" { params: true, reads_depth: true, position_only: true },
    /// Minus the fragment's depth, its depth, 0 and 1.
    DepthRange = "depth_range" { reads_depth: true, position_only: true },
    /// A step of dual depth peeling: depths, front and back colours to locations 0 to 2.
    DualPeel = "dual_peel" { textures: 2, outputs: 3, reads_depth: true },
    /// The vertex colour with its alpha weighted by the first texture coordinate (the distance from an edge
    /// in texels) plus a half, clamped to 0 to 1.
    EdgeAlpha = "edge_alpha" { uv: true },
    /// The vertex colour; first does as many steps of work as `params.back_color`'s red says.
    ExpensiveColor = "expensive_color" { params: true },
    /// Like `expensive_color`, and writes the fragment's own window depth as depth.
    ExpensiveDepth = "expensive_depth" { params: true, depth: WrittenDepth::Computed, reads_depth: true },
    /// Like `expensive_color`, and discards if the vertex colour's alpha is below `params.color`'s.
    ExpensiveDiscard = "expensive_discard" { params: true, discards: true },
    /// `params.color`; writes the red of the texel of texture 0 under the fragment as stencil reference.
    ExportedColor = "exported_color" { params: true, textures: 1, reference: true, position_only: true },
    /// Like `exported_color`, and writes the texel's green as depth.
    ExportedDepth = "exported_depth" { params: true, textures: 1, reference: true, depth: WrittenDepth::Computed, position_only: true },
    /// Like `exported_color`, and discards if the texel's blue is below `params.color`'s.
    ExportedDiscard = "exported_discard" { params: true, textures: 1, reference: true, discards: true, position_only: true },
    /// Like `exported_color` on front faces; `params.back_color` and the texel's alpha on back faces.
    ExportedFacing = "exported_facing" { params: true, facing: true, textures: 1, reference: true, position_only: true },
    /// Like `sample_index`, and writes the red of the texel of texture 0 under the fragment plus the number
    /// of the sample as stencil reference. Runs once per sample.
    ExportedSample = "exported_sample" { textures: 1, reference: true, per_sample: true, position_only: true },
    /// The vertex colour, flat.
    FlatColor = "flat_color" {},
    /// `params.color`; writes the vertex colour's red as depth.
    FlatColorDepth = "flat_color_depth" { params: true, depth: WrittenDepth::VertexRed },
    /// The vertex colour of either the first or the last vertex of a primitive, flat.
    FlatEither = "flat_either" { either: true },
    /// The vertex colour, faded to `params.back_color` with the distance between the near and far
    /// planes in `params.color`'s red and green.
    Fog = "fog" { params: true, reads_depth: true },
    /// The fragment's window coordinates times `params.color`'s red and green; its blue and alpha.
    FragCoordColor = "frag_coord_color" { params: true, coordinates: true, position_only: true },
    /// The vertex colour, flat; writes the fragment's own window depth as depth.
    FragCoordDepth = "frag_coord_depth" { depth: WrittenDepth::Computed, reads_depth: true },
    /// `params.color` on front faces, `params.back_color` on back faces.
    FrontFacing = "front_facing" { params: true, facing: true, position_only: true },
    /// Texture 0, blended along edges of luma. `params.color`: width and height of a texel in texture
    /// coordinates, minimum contrast of an edge relative to the brightest neighbour, and absolute minimum
    /// contrast; `params.back_color`'s red: the weight of single texels.
    Fxaa = "fxaa" { params: true, textures: 1, sampler: true, taps: true },
    /// The vertex colour, opaque; discards if its alpha is below the hash of the cell of the texture coordinates
    /// times `params.color`'s red and green.
    HashedColor = "hashed_color" { params: true, uv: true, discards: true },
    /// Texture 0, opaque; discards if its alpha is below the hash of the cell of a place, times `params.color`'s red
    /// and green. The place is the texture coordinates times the vertex colour's red and green, plus its blue
    /// and alpha.
    HashedSample = "hashed_sample" { params: true, textures: 1, sampler: true, discards: true },
    /// Four bits of its input sample mask, starting from the bit number in `params.color`'s red.
    InputMask = "input_mask" { params: true, reads_mask: true, position_only: true },
    /// Like `input_mask`, with the sample's own bit inverted. Runs once per sample.
    InputMaskSample = "input_mask_sample" { params: true, reads_mask: true, per_sample: true, position_only: true },
    /// The vertex colour; writes a depth that grows linearly with the distance, the clip-space w,
    /// between the planes in `params.color`'s red and green.
    LinearDepth = "linear_depth" { params: true, reads_w: true, depth: WrittenDepth::Computed },
    /// Adds the vertex colour and the fragment's depth to the list of its texel. `params.color`: width and
    /// height of the picture.
    ListAppend = "list_append" { params: true, pool: PoolUse::Append, reads_depth: true },
    /// The list of the texel, composed nearest first, premultiplied, with the transmittance as alpha.
    /// `params.color`: width and height of the picture.
    ListCompose = "list_compose" { params: true, pool: PoolUse::ReadList, position_only: true },
    /// The vertex colour; writes as depth the binary logarithm of the distance (the clip-space w) over
    /// `params.color`'s red, times its blue.
    LogarithmicDepth = "logarithmic_depth" { params: true, reads_w: true, depth: WrittenDepth::Computed },
    /// `params.color` with the alpha of the texel of texture 0 under the fragment; writes the texel's red as
    /// sample mask.
    MaskedColor = "masked_color" { params: true, textures: 1, mask: true, position_only: true },
    /// Like `masked_color`, and writes the texel's green as depth.
    MaskedDepth = "masked_depth" { params: true, textures: 1, mask: true, depth: WrittenDepth::Computed, position_only: true },
    /// Like `masked_color`, and discards if the texel's blue is below `params.color`'s.
    MaskedDiscard = "masked_discard" { params: true, textures: 1, discards: true, mask: true, position_only: true },
    /// Like `sample_index`, and writes the red of the texel of texture 0 under the fragment as sample mask,
    /// with all bits except the sample's own inverted. Runs once per sample.
    MaskedSample = "masked_sample" { textures: 1, mask: true, per_sample: true, position_only: true },
    /// Moment-based transparency: absorbance to location 0, its moments along depth to location 1.
    MomentAbsorbance = "moment_absorbance" { outputs: 2, reads_depth: true },
    /// Moment-based transparency: the mean of texture 0's sums, with the transmittance of the absorbance in
    /// texture 1's red as alpha.
    MomentResolve = "moment_resolve" { textures: 2, position_only: true },
    /// Moment-based transparency: the vertex colour, premultiplied, times the transmittance in front of the
    /// fragment, from the absorbance in texture 0 and its moments in texture 1.
    MomentTransmittance = "moment_transmittance" { textures: 2, reads_depth: true },
    /// Stores the vertex colour in a node of its texel that has the fragment's depth. Otherwise the colour,
    /// premultiplied, to location 0, and alpha to location 1; zeros if it is stored. `params.color`: width and
    /// height of the picture, and the number of layers.
    NearestColors = "nearest_colors" { params: true, outputs: 2, pool: PoolUse::FillNearest, reads_depth: true },
    /// The nearest layers of the texel over the mean of texture 0's sums, whose transmittance is texture 1's
    /// red; premultiplied, with the transmittance of everything as alpha. `params.color` as for `nearest_colors`.
    NearestCompose = "nearest_compose" { params: true, textures: 2, pool: PoolUse::ReadNearest, position_only: true },
    /// Stores the fragment's depth if it is among the nearest of its texel. `params.color` as for
    /// `nearest_colors`.
    NearestDepths = "nearest_depths" { params: true, pool: PoolUse::KeepNearest, reads_depth: true, position_only: true },
    /// A step of depth peeling: writes the vertex colour, and the depth to location 1. Discards fragments
    /// that are not behind the depth in texture 0.
    Peel = "peel" { textures: 1, outputs: 2, discards: true, reads_depth: true },
    /// `params.color`; writes the number of the sample being shaded plus 1, in 32nds, as depth. Runs
    /// once per sample.
    SampleDepth = "sample_depth" { params: true, depth: WrittenDepth::Computed, per_sample: true, position_only: true },
    /// The number of the sample being shaded in binary: red its lowest bit, alpha 1. Runs once
    /// per sample.
    SampleIndex = "sample_index" { per_sample: true, position_only: true },
    /// Texture 0 sampled at the interpolated texture coordinates.
    SampledColor = "sampled_color" { textures: 1, sampler: true },
    /// Like `sampled_color`, and discards if the alpha is below `params.color`'s.
    SampledDiscard = "sampled_discard" { params: true, textures: 1, sampler: true, discards: true },
    /// Like `sampled_color`, with sharpened alpha: a half where it is `params.color`'s alpha, and 0 and 1 half a texel
    /// of the picture away from there.
    SharpenedSample = "sharpened_sample" { params: true, textures: 1, sampler: true, derivatives: true },
    /// The whole steps of the fragment coordinate's w and depth, times `params.color`'s red and green, as
    /// colours: see `stepped_perspective`.
    SteppedFragCoord = "stepped_frag_coord" { params: true, reads_depth: true, reads_w: true, position_only: true },
    /// Like `stepped_perspective`, interpolated linearly in the window.
    SteppedLinear = "stepped_linear" { uv: true, interpolation: Interpolation::Linear },
    /// Like `stepped_linear`, inside the part of the texel that the primitive covers.
    SteppedLinearCentroid = "stepped_linear_centroid" { uv: true, interpolation: Interpolation::Linear, sampling: InterpolationSampling::Centroid },
    /// Like `stepped_linear`, at each sample. Runs once per sample.
    SteppedLinearSample = "stepped_linear_sample" { uv: true, interpolation: Interpolation::Linear, sampling: InterpolationSampling::Sample, per_sample: true },
    /// The whole steps of the texture coordinates, 0 to 7, as colours. The first coordinate gives red, green
    /// and blue such that neighbouring steps differ in one channel; the second gives alpha, which is 1 for
    /// odd steps.
    SteppedPerspective = "stepped_perspective" { uv: true },
    /// Like `stepped_perspective`, interpolated inside the part of the texel that the primitive covers.
    SteppedPerspectiveCentroid = "stepped_perspective_centroid" { uv: true, sampling: InterpolationSampling::Centroid },
    /// Like `stepped_perspective`, interpolated at each sample. Runs once per sample.
    SteppedPerspectiveSample = "stepped_perspective_sample" { uv: true, sampling: InterpolationSampling::Sample, per_sample: true },
    /// The vertex colour, opaque; discards if its alpha is below the sample's channel of texture 0. Runs once
    /// per sample.
    Stochastic = "stochastic" { textures: 1, discards: true, per_sample: true },
    /// The texel of texture 0 under the fragment.
    TexelColor = "texel_color" { textures: 1, position_only: true },
    /// The texel of texture 0 under the fragment, written to all colour locations 0 to 3.
    TexelColorAll = "texel_color_all" { textures: 1, outputs: 4, position_only: true },
    /// The texel of texture 0 under the fragment, written to all colour locations 0 to 7.
    TexelColorEight = "texel_color_eight" { textures: 1, outputs: 8, position_only: true },
    /// The texel of texture 0 under the fragment; discards if its alpha is below `params.color`'s.
    TexelDiscard = "texel_discard" { params: true, textures: 1, discards: true, position_only: true },
    /// The texel of texture 0 under the fragment as source, the texel of texture 1 as second source.
    TexelDualSource = "texel_dual_source" { textures: 2, second_source: true, position_only: true },
    /// The texel of texture 0 under the fragment, of the sample that is being shaded. Runs once per sample.
    TexelSample = "texel_sample" { textures: 1, multisampled: true, per_sample: true, position_only: true },
    /// The stencil value of texture 0 under the fragment as red, with alpha 1.
    TexelStencil = "texel_stencil" { textures: 1, stencil: true, position_only: true },
    /// `params.color` as integers.
    UintColor = "uint_color" { params: true, integers: true, position_only: true },
    /// `params.color`.
    UniformColor = "uniform_color" { params: true, position_only: true },
    /// No fragment shader, and therefore no colour.
    VertexOnly = "vertex_only" { fragment: false, outputs: 0, position_only: true },
    /// Weighted blended transparency: weighted colour to location 0, alpha to location 1.
    WeightedAccumulate = "weighted_accumulate" { outputs: 2, reads_depth: true },
    /// Weighted blended transparency: the mean of texture 0's sums, with texture 1's red as alpha.
    WeightedResolve = "weighted_resolve" { textures: 2, position_only: true },
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The variable that lets the test write the page.
    const WRITE: &str = "ETALON_WRITE_SHADERS";

    #[test]
    #[expect(clippy::unwrap_used, reason = "a test that panics has failed")]
    fn the_page_of_keys_lists_the_shaders() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/keys.md");
        let page = std::fs::read_to_string(&path).unwrap();
        let (before, rest) = page.split_once("<!-- shaders: ").unwrap();
        let (command, rest) = rest.split_once(" -->\n").unwrap();
        let (_, after) = rest.split_once("<!-- end -->\n").unwrap();
        let rows = Shader::ALL
            .iter()
            .map(|s| format!("| `{}` | {} |\n", s.name(), s.about()));
        let table = rows.collect::<String>();
        let expected = format!(
            "{before}<!-- shaders: {command} -->\n\n| shader | effect |\n|---|---|\n{table}\n<!-- end -->\n{after}"
        );
        if std::env::var_os(WRITE).is_some() {
            std::fs::write(&path, &expected).unwrap();
        }
        assert!(
            page == expected,
            "{} differs; {WRITE}=1 writes it",
            path.display()
        );
    }

    #[test]
    fn facts_about_a_shader_agree_with_its_source() {
        for shader in Shader::ALL {
            let text = shader.wgsl();
            let has = |word: &str| text.contains(word);
            let name = shader.name();
            assert_eq!(shader.uses_params(), has("@binding(0)"), "{name}");
            assert_eq!(
                shader.textures(),
                text.matches(": texture_").count(),
                "{name}"
            );
            assert_eq!(
                shader.reads_sample(),
                has("texture_multisampled_2d<f32>"),
                "{name}"
            );
            assert_eq!(shader.reads_stencil(), has("texture_2d<u32>"), "{name}");
            assert_eq!(shader.uses_storage(), has("@binding(3)"), "{name}");
            assert_eq!(
                shader.reads_facing(),
                has("builtin(front_facing)"),
                "{name}"
            );
            assert_eq!(shader.uses_pool(), has("array<atomic<u32>>"), "{name}");
            let adds = has("atomicExchange") || has("atomicMax");
            assert_eq!(shader.adds_to_pool(), adds, "{name}");
            assert_eq!(
                shader.passes_position_alone(),
                has("-> @builtin(position) vec4f"),
                "{name}"
            );
            assert_eq!(shader.samples_texture(), has("@binding(4)"), "{name}");
            assert_eq!(shader.reads_derivatives(), has("fwidth("), "{name}");
            assert_eq!(shader.writes_depth(), has("@builtin(frag_depth)"), "{name}");
            assert_eq!(shader.discards(), has("discard;"), "{name}");
            assert_eq!(
                shader.writes_mask(),
                has("@builtin(sample_mask) mask"),
                "{name}"
            );
            assert_eq!(
                shader.reads_mask(),
                has("@builtin(sample_mask) covered"),
                "{name}"
            );
            assert_eq!(
                shader.writes_reference(),
                has("@location(1) stencil_reference: i32"),
                "{name}"
            );
            assert_eq!(shader.has_fragment(), has("@fragment"), "{name}");
            assert_eq!(shader.has_second_source(), has("@blend_src(1)"), "{name}");
            let count = shader.clip_distances() + shader.cull_distances();
            let distances = format!("distances: array<f32, {count}>,");
            let clips = has("@builtin(clip_distances)");
            assert_eq!((clips, has(&distances)), (clips, clips), "{name}");
            assert_eq!(clips, count > 0, "{name}");
            let sampling = match (has(", centroid)"), has(", sample)")) {
                (true, _) => InterpolationSampling::Centroid,
                (_, true) => InterpolationSampling::Sample,
                _ => InterpolationSampling::Center,
            };
            assert_eq!(shader.interpolation_sampling(), sampling, "{name}");
            let linear = shader.interpolation() == Interpolation::Linear;
            assert_eq!(linear, has("@interpolate(linear"), "{name}");
            assert_eq!(shader.flat_from_either(), has(", either)"), "{name}");
            assert_eq!(shader.reads_w(), has("position.w"), "{name}");
            let z = has("position.z") || has("position.wz");
            assert_eq!(shader.reads_depth(), z, "{name}");
            assert_eq!(
                shader.runs_per_sample(),
                has("@builtin(sample_index)") || sampling == InterpolationSampling::Sample,
                "{name}"
            );
        }
    }
}
