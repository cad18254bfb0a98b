//! The suite's shaders and what each asks of a draw.

use crate::state::EarlyTests;
use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

state_enum! {
    /// The suite's shaders. Each has a WGSL file in `shaders/` and a twin in the reference.
    Shader {
        /// `params.color` where the first texture coordinate, interpolated inside the primitive, is
        /// not negative; `params.back_color` where it is.
        Centroid = "centroid",
        /// `params.color`; counts its runs.
        CountedColor = "counted_color",
        /// As `flat_color_depth`; counts its runs.
        CountedDepth = "counted_depth",
        /// As `texel_discard`; counts its runs.
        CountedDiscard = "counted_discard",
        /// The fragment's own window depth as grey.
        DepthGrey = "depth_grey",
        /// The distance behind the window depth of a perspective projection as grey, between the near
        /// and far planes in `params.color`'s red and green.
        DepthLinearized = "depth_linearized",
        /// Minus the fragment's depth, its depth, 0 and 1.
        DepthRange = "depth_range",
        /// One step of dual depth peeling: depths, front and back to locations 0 to 2.
        DualPeel = "dual_peel",
        /// The vertex colour with its alpha weighted by the first texture coordinate, the distance from
        /// an edge in texels, plus a half, held to 0 and 1.
        EdgeAlpha = "edge_alpha",
        /// The vertex colour, after `params.back_color`'s red steps of work.
        ExpensiveColor = "expensive_color",
        /// As `expensive_color`; writes the fragment's own window depth as depth.
        ExpensiveDepth = "expensive_depth",
        /// As `expensive_color`; discards where the vertex colour's alpha is below `params.color`'s.
        ExpensiveDiscard = "expensive_discard",
        /// The vertex colour, flat.
        FlatColor = "flat_color",
        /// `params.color`; writes the vertex colour's red as depth.
        FlatColorDepth = "flat_color_depth",
        /// The vertex colour, faded to `params.back_color` with the distance between the near and far
        /// planes in `params.color`'s red and green.
        Fog = "fog",
        /// The vertex colour, flat; writes the fragment's own window depth as depth.
        FragCoordDepth = "frag_coord_depth",
        /// `params.color` on front faces, `params.back_color` on back faces.
        FrontFacing = "front_facing",
        /// The vertex colour; writes a depth that grows linearly with the distance, 1 over the first
        /// texture coordinate, between the planes in `params.color`'s red and green.
        LinearDepth = "linear_depth",
        /// The vertex colour; writes as depth the binary logarithm of the distance, 1 over the first
        /// texture coordinate, over `params.color`'s red, times its blue.
        LogarithmicDepth = "logarithmic_depth",
        /// One step of depth peeling: the vertex colour and, to location 1, the depth of fragments behind
        /// the depth in texture 0; discards all others.
        Peel = "peel",
        /// `params.color`; writes the number of the sample being shaded plus 1, in 32nds, as depth. Runs
        /// once per sample.
        SampleDepth = "sample_depth",
        /// The number of the sample being shaded in binary: red its lowest bit, alpha 1. Runs once
        /// per sample.
        SampleIndex = "sample_index",
        /// Texture 0 sampled at the interpolated texture coordinates.
        SampledColor = "sampled_color",
        /// As `sampled_color`; discards where the alpha is below `params.color`'s.
        SampledDiscard = "sampled_discard",
        /// The vertex colour, opaque; discards where its alpha is below the channel of texture 0 that
        /// belongs to the sample. Runs once per sample.
        Stochastic = "stochastic",
        /// The texel of texture 0 under the fragment.
        TexelColor = "texel_color",
        /// The texel of texture 0 under the fragment, to colour locations 0 to 3 alike.
        TexelColorAll = "texel_color_all",
        /// The texel of texture 0 under the fragment; discards where its alpha is below
        /// `params.color`'s.
        TexelDiscard = "texel_discard",
        /// The texel of texture 0 under the fragment as source, that of texture 1 as second source.
        TexelDualSource = "texel_dual_source",
        /// `params.color` as integers.
        UintColor = "uint_color",
        /// `params.color`.
        UniformColor = "uniform_color",
        /// Weighted blended transparency: weighted colour to location 0, alpha to location 1.
        WeightedAccumulate = "weighted_accumulate",
        /// Weighted blended transparency: the mean of texture 0's sums, and texture 1's red as alpha.
        WeightedResolve = "weighted_resolve",
    }
}

impl Shader {
    /// The WGSL text: a vertex entry point `vs` and a fragment entry point `fs`. Vertex inputs are
    /// location 0 position, 1 colour, 2 uv; group 0 holds the parameters at binding 0, textures at
    /// bindings 1 and 2, the counter of runs at binding 3 and a sampler at binding 4.
    pub fn wgsl(self) -> &'static str {
        match self {
            Self::Centroid => include_str!("../../../shaders/centroid.wgsl"),
            Self::CountedColor => include_str!("../../../shaders/counted_color.wgsl"),
            Self::CountedDepth => include_str!("../../../shaders/counted_depth.wgsl"),
            Self::CountedDiscard => include_str!("../../../shaders/counted_discard.wgsl"),
            Self::DepthGrey => include_str!("../../../shaders/depth_grey.wgsl"),
            Self::DepthLinearized => include_str!("../../../shaders/depth_linearized.wgsl"),
            Self::DepthRange => include_str!("../../../shaders/depth_range.wgsl"),
            Self::DualPeel => include_str!("../../../shaders/dual_peel.wgsl"),
            Self::EdgeAlpha => include_str!("../../../shaders/edge_alpha.wgsl"),
            Self::ExpensiveColor => include_str!("../../../shaders/expensive_color.wgsl"),
            Self::ExpensiveDepth => include_str!("../../../shaders/expensive_depth.wgsl"),
            Self::ExpensiveDiscard => include_str!("../../../shaders/expensive_discard.wgsl"),
            Self::FlatColor => include_str!("../../../shaders/flat_color.wgsl"),
            Self::FlatColorDepth => include_str!("../../../shaders/flat_color_depth.wgsl"),
            Self::Fog => include_str!("../../../shaders/fog.wgsl"),
            Self::FragCoordDepth => include_str!("../../../shaders/frag_coord_depth.wgsl"),
            Self::FrontFacing => include_str!("../../../shaders/front_facing.wgsl"),
            Self::LinearDepth => include_str!("../../../shaders/linear_depth.wgsl"),
            Self::LogarithmicDepth => include_str!("../../../shaders/logarithmic_depth.wgsl"),
            Self::Peel => include_str!("../../../shaders/peel.wgsl"),
            Self::SampleDepth => include_str!("../../../shaders/sample_depth.wgsl"),
            Self::SampleIndex => include_str!("../../../shaders/sample_index.wgsl"),
            Self::SampledColor => include_str!("../../../shaders/sampled_color.wgsl"),
            Self::SampledDiscard => include_str!("../../../shaders/sampled_discard.wgsl"),
            Self::Stochastic => include_str!("../../../shaders/stochastic.wgsl"),
            Self::TexelColor => include_str!("../../../shaders/texel_color.wgsl"),
            Self::TexelColorAll => include_str!("../../../shaders/texel_color_all.wgsl"),
            Self::TexelDiscard => include_str!("../../../shaders/texel_discard.wgsl"),
            Self::TexelDualSource => include_str!("../../../shaders/texel_dual_source.wgsl"),
            Self::UintColor => include_str!("../../../shaders/uint_color.wgsl"),
            Self::UniformColor => include_str!("../../../shaders/uniform_color.wgsl"),
            Self::WeightedAccumulate => include_str!("../../../shaders/weighted_accumulate.wgsl"),
            Self::WeightedResolve => include_str!("../../../shaders/weighted_resolve.wgsl"),
        }
    }

    /// The WGSL text with the attribute that tells when the fragment tests happen.
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

    /// How many textures the shader reads.
    pub fn textures(self) -> usize {
        match self {
            Self::TexelColor
            | Self::TexelColorAll
            | Self::TexelDiscard
            | Self::CountedDiscard
            | Self::Peel
            | Self::SampledColor
            | Self::SampledDiscard
            | Self::Stochastic => 1,
            Self::DualPeel | Self::TexelDualSource | Self::WeightedResolve => 2,
            _ => 0,
        }
    }

    /// Whether the shader samples its texture instead of fetching single texels.
    pub fn samples_texture(self) -> bool {
        matches!(self, Self::SampledColor | Self::SampledDiscard)
    }

    /// Whether the fragment shader replaces the fragment's depth.
    pub fn writes_depth(self) -> bool {
        matches!(
            self,
            Self::FlatColorDepth
                | Self::CountedDepth
                | Self::ExpensiveDepth
                | Self::FragCoordDepth
                | Self::LinearDepth
                | Self::LogarithmicDepth
                | Self::SampleDepth
        )
    }

    /// Whether the depth that the shader writes is the vertex colour's red.
    pub fn depth_from_vertex_color(self) -> bool {
        matches!(self, Self::FlatColorDepth | Self::CountedDepth)
    }

    /// Whether the shader may discard fragments.
    pub fn discards(self) -> bool {
        matches!(
            self,
            Self::CountedDiscard
                | Self::ExpensiveDiscard
                | Self::Peel
                | Self::SampledDiscard
                | Self::Stochastic
                | Self::TexelDiscard
        )
    }

    /// Whether the shader counts its runs in a storage buffer.
    pub fn counts_runs(self) -> bool {
        matches!(
            self,
            Self::CountedColor | Self::CountedDepth | Self::CountedDiscard
        )
    }

    /// Whether the shader writes integers.
    pub fn writes_integers(self) -> bool {
        self == Self::UintColor
    }

    /// How many colour locations the shader writes.
    pub fn outputs(self) -> usize {
        match self {
            Self::TexelColorAll => 4,
            Self::DualPeel => 3,
            Self::Peel | Self::WeightedAccumulate => 2,
            _ => 1,
        }
    }

    /// Whether the shader reads the interpolated texture coordinates, be it to sample a texture or
    /// as numbers.
    pub fn uses_uv(self) -> bool {
        self.samples_texture()
            || matches!(
                self,
                Self::Centroid | Self::EdgeAlpha | Self::LinearDepth | Self::LogarithmicDepth
            )
    }

    /// Whether the shader gives a second source for blending.
    pub fn has_second_source(self) -> bool {
        self == Self::TexelDualSource
    }

    /// Whether the shader runs once per sample.
    pub fn runs_per_sample(self) -> bool {
        matches!(
            self,
            Self::SampleDepth | Self::SampleIndex | Self::Stochastic
        )
    }

    /// Whether the shader reads the parameter block.
    pub fn uses_params(self) -> bool {
        matches!(
            self,
            Self::Centroid
                | Self::CountedColor
                | Self::CountedDepth
                | Self::CountedDiscard
                | Self::DepthLinearized
                | Self::ExpensiveColor
                | Self::ExpensiveDepth
                | Self::ExpensiveDiscard
                | Self::FlatColorDepth
                | Self::Fog
                | Self::FrontFacing
                | Self::LinearDepth
                | Self::LogarithmicDepth
                | Self::SampleDepth
                | Self::SampledDiscard
                | Self::TexelDiscard
                | Self::UintColor
                | Self::UniformColor
        )
    }
}
