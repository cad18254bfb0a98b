//! The fragment shaders' twins: each `shaders/<name>.wgsl` written by hand once more, so that a bug
//! in a shader's translation shows instead of being shared by both sides. All vertex shaders pass
//! positions and attributes through.

mod centroid;
mod counted_color;
mod counted_depth;
mod counted_discard;
mod flat_color;
mod flat_color_depth;
mod frag_coord_depth;
mod front_facing;
mod sample_depth;
mod sample_index;
mod sampled_color;
mod texel_color;
mod texel_color_all;
mod texel_discard;
mod texel_dual_source;
mod uint_color;
mod uniform_color;

use crate::arithmetic::Arithmetic;
use etalon_case::scene::Params;
use etalon_case::state::Shader;

/// What a fragment shader sees.
#[derive(Clone, Copy, Debug)]
pub struct FragmentInput<'a, R> {
    /// The vertex colour, flat over the primitive.
    pub color: [R; 4],
    /// Whether the primitive faces front.
    pub front: bool,
    /// The fragment's window depth.
    pub depth: R,
    /// The sample being shaded.
    pub sample: u32,
    /// The texels of textures 0 and 1 under the fragment, or what sampling them gives; zeros where the
    /// shader reads none.
    pub texels: [[R; 4]; 2],
    /// The parameter block.
    pub params: &'a Params,
}

/// What a fragment shader gives.
#[derive(Clone, Copy, Debug)]
pub struct FragmentOutput<R> {
    /// The colour at location 0, and at all others that the shader writes.
    pub color: [R; 4],
    /// The second source for blending, where the shader gives one.
    pub second: Option<[R; 4]>,
    /// The depth, where the shader writes one.
    pub depth: Option<R>,
    /// Where the shader may discard: the fragment is kept when the first is not below the second.
    pub kept: Option<[R; 2]>,
}

/// Runs a fragment shader.
#[inline(always)]
pub fn fragment<A: Arithmetic>(
    a: &mut A,
    shader: Shader,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    match shader {
        Shader::Centroid => centroid::fragment(a, input),
        Shader::CountedColor => counted_color::fragment(a, input),
        Shader::CountedDepth => counted_depth::fragment(a, input),
        Shader::CountedDiscard => counted_discard::fragment(a, input),
        Shader::FlatColor => flat_color::fragment::<A>(input),
        Shader::FlatColorDepth => flat_color_depth::fragment(a, input),
        Shader::FragCoordDepth => frag_coord_depth::fragment::<A>(input),
        Shader::FrontFacing => front_facing::fragment(a, input),
        Shader::SampleDepth => sample_depth::fragment(a, input),
        Shader::SampleIndex => sample_index::fragment(a, input),
        Shader::SampledColor => sampled_color::fragment::<A>(input),
        Shader::TexelColor => texel_color::fragment::<A>(input),
        Shader::TexelColorAll => texel_color_all::fragment::<A>(input),
        Shader::TexelDiscard => texel_discard::fragment(a, input),
        Shader::TexelDualSource => texel_dual_source::fragment::<A>(input),
        Shader::UintColor => uint_color::fragment(a, input),
        Shader::UniformColor => uniform_color::fragment(a, input),
    }
}
