//! Twins of the fragment shaders: each `shaders/<name>.wgsl` written a second time by hand, so that a bug in
//! a shader's translation shows rather than being shared by both sides. All vertex shaders pass positions and
//! attributes through.

mod arithmetic;
mod centroid;
mod clip_flat;
mod clip_uniform;
mod counted_color;
mod counted_depth;
mod counted_discard;
mod cull_flat;
mod depth_grey;
mod depth_linearized;
mod depth_range;
mod dual_peel;
mod edge_alpha;
mod expensive_color;
mod expensive_depth;
mod expensive_discard;
mod exported_color;
mod exported_depth;
mod exported_discard;
mod exported_facing;
mod exported_sample;
mod flat_color;
mod flat_color_depth;
mod flat_either;
mod fog;
mod frag_coord_color;
mod frag_coord_depth;
mod front_facing;
mod fxaa;
mod hashed_color;
mod hashed_sample;
mod input_mask;
mod input_mask_sample;
mod interface;
mod linear_depth;
mod list_append;
mod list_compose;
mod logarithmic_depth;
mod masked_color;
mod masked_depth;
mod masked_discard;
mod masked_sample;
mod moment_absorbance;
mod moment_resolve;
mod moment_transmittance;
mod nearest_colors;
mod nearest_compose;
mod nearest_depths;
mod peel;
mod sample_depth;
mod sample_index;
mod sampled_color;
mod sampled_discard;
mod sharpened_sample;
mod stepped_frag_coord;
mod stepped_linear;
mod stepped_linear_centroid;
mod stepped_linear_sample;
mod stepped_perspective;
mod stepped_perspective_centroid;
mod stepped_perspective_sample;
mod stochastic;
mod texel_color;
mod texel_color_all;
mod texel_color_eight;
mod texel_discard;
mod texel_dual_source;
mod texel_sample;
mod texel_stencil;
mod uint_color;
mod uniform_color;
mod vertex_only;
mod weighted_accumulate;
mod weighted_resolve;

pub use expensive_color::cost;
pub use interface::{
    FragmentInput, FragmentOutput, InputMask, KeepCondition, List, Node, SampleMask,
    StencilReference, Taps,
};

use crate::arithmetic::Arithmetic;
use etalon_scene::{Shader, Vertex};

/// Runs a fragment shader.
#[inline(always)]
pub fn fragment<A: Arithmetic>(
    a: &mut A,
    shader: Shader,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    match shader {
        Shader::Centroid => centroid::fragment(a, input),
        Shader::ClipFlat => clip_flat::fragment::<A>(input),
        Shader::ClipUniform => clip_uniform::fragment(a, input),
        Shader::CountedColor => counted_color::fragment(a, input),
        Shader::CountedDepth => counted_depth::fragment(a, input),
        Shader::CountedDiscard => counted_discard::fragment(a, input),
        Shader::CullFlat => cull_flat::fragment::<A>(input),
        Shader::DepthGrey => depth_grey::fragment(a, input),
        Shader::DepthLinearized => depth_linearized::fragment(a, input),
        Shader::DepthRange => depth_range::fragment(a, input),
        Shader::DualPeel => dual_peel::fragment(a, input),
        Shader::EdgeAlpha => edge_alpha::fragment(a, input),
        Shader::ExpensiveColor => expensive_color::fragment::<A>(input),
        Shader::ExpensiveDepth => expensive_depth::fragment::<A>(input),
        Shader::ExpensiveDiscard => expensive_discard::fragment(a, input),
        Shader::ExportedColor => exported_color::fragment(a, input),
        Shader::ExportedDepth => exported_depth::fragment(a, input),
        Shader::ExportedDiscard => exported_discard::fragment(a, input),
        Shader::ExportedFacing => exported_facing::fragment(a, input),
        Shader::ExportedSample => exported_sample::fragment(a, input),
        Shader::FlatColor => flat_color::fragment::<A>(input),
        Shader::FlatColorDepth => flat_color_depth::fragment(a, input),
        Shader::FlatEither => flat_either::fragment::<A>(input),
        Shader::Fog => fog::fragment(a, input),
        Shader::FragCoordColor => frag_coord_color::fragment(a, input),
        Shader::FragCoordDepth => frag_coord_depth::fragment::<A>(input),
        Shader::FrontFacing => front_facing::fragment(a, input),
        Shader::Fxaa => fxaa::fragment(a, input),
        Shader::HashedColor => hashed_color::fragment(a, input),
        Shader::HashedSample => hashed_sample::fragment(a, input),
        Shader::InputMask => input_mask::fragment(a, input),
        Shader::InputMaskSample => input_mask_sample::fragment(a, input),
        Shader::LinearDepth => linear_depth::fragment(a, input),
        Shader::ListAppend => list_append::fragment(a, input),
        Shader::ListCompose => list_compose::fragment(a, input),
        Shader::LogarithmicDepth => logarithmic_depth::fragment(a, input),
        Shader::MaskedColor => masked_color::fragment(a, input),
        Shader::MaskedDepth => masked_depth::fragment(a, input),
        Shader::MaskedDiscard => masked_discard::fragment(a, input),
        Shader::MaskedSample => masked_sample::fragment(a, input),
        Shader::MomentAbsorbance => moment_absorbance::fragment(a, input),
        Shader::MomentResolve => moment_resolve::fragment(a, input),
        Shader::MomentTransmittance => moment_transmittance::fragment(a, input),
        Shader::NearestColors => nearest_colors::fragment(a, input),
        Shader::NearestCompose => nearest_compose::fragment(a, input),
        Shader::NearestDepths => nearest_depths::fragment(a, input),
        Shader::Peel => peel::fragment(a, input),
        Shader::SampleDepth => sample_depth::fragment(a, input),
        Shader::SampleIndex => sample_index::fragment(a, input),
        Shader::SampledColor => sampled_color::fragment::<A>(input),
        Shader::SampledDiscard => sampled_discard::fragment(a, input),
        Shader::SharpenedSample => sharpened_sample::fragment(a, input),
        Shader::SteppedFragCoord => stepped_frag_coord::fragment(a, input),
        Shader::SteppedLinear => stepped_linear::fragment(a, input),
        Shader::SteppedLinearCentroid => stepped_linear_centroid::fragment(a, input),
        Shader::SteppedLinearSample => stepped_linear_sample::fragment(a, input),
        Shader::SteppedPerspective => stepped_perspective::fragment(a, input),
        Shader::SteppedPerspectiveCentroid => stepped_perspective_centroid::fragment(a, input),
        Shader::SteppedPerspectiveSample => stepped_perspective_sample::fragment(a, input),
        Shader::Stochastic => stochastic::fragment(a, input),
        Shader::TexelColor => texel_color::fragment::<A>(input),
        Shader::TexelColorAll => texel_color_all::fragment::<A>(input),
        Shader::TexelColorEight => texel_color_eight::fragment::<A>(input),
        Shader::TexelDiscard => texel_discard::fragment(a, input),
        Shader::TexelDualSource => texel_dual_source::fragment::<A>(input),
        Shader::TexelSample => texel_sample::fragment::<A>(input),
        Shader::TexelStencil => texel_stencil::fragment(a, input),
        Shader::UintColor => uint_color::fragment(a, input),
        Shader::UniformColor => uniform_color::fragment(a, input),
        Shader::VertexOnly => vertex_only::fragment(a),
        Shader::WeightedAccumulate => weighted_accumulate::fragment(a, input),
        Shader::WeightedResolve => weighted_resolve::fragment(a, input),
    }
}

/// Returns the clip distances of a vertex.
pub fn clip_distances(shader: Shader, vertex: &Vertex) -> Vec<f32> {
    match shader {
        Shader::ClipFlat => clip_flat::distances(vertex).to_vec(),
        Shader::ClipUniform => clip_uniform::distances(vertex).to_vec(),
        _ => Vec::new(),
    }
}

/// Returns the cull distances of a vertex.
pub fn cull_distances(shader: Shader, vertex: &Vertex) -> Vec<f32> {
    match shader {
        Shader::CullFlat => cull_flat::distances(vertex).to_vec(),
        _ => Vec::new(),
    }
}
