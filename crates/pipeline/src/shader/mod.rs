//! The fragment shaders' twins: each `shaders/<name>.wgsl` written by hand once more, so that a bug
//! in a shader's translation shows instead of being shared by both sides. All vertex shaders pass
//! positions and attributes through.

mod flat_color;
mod flat_color_depth;
mod front_facing;
mod texel_color;
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
    /// The texel of texture 0 under the fragment; zeros where the shader fetches none.
    pub texel: [R; 4],
    /// The parameter block.
    pub params: &'a Params,
}

/// What a fragment shader gives.
#[derive(Clone, Copy, Debug)]
pub struct FragmentOutput<R> {
    /// The colour at location 0.
    pub color: [R; 4],
    /// The depth, where the shader writes one.
    pub depth: Option<R>,
}

/// Runs a fragment shader.
#[inline(always)]
pub fn fragment<A: Arithmetic>(
    a: &mut A,
    shader: Shader,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    match shader {
        Shader::FlatColor => flat_color::fragment::<A>(input),
        Shader::FlatColorDepth => flat_color_depth::fragment(a, input),
        Shader::FrontFacing => front_facing::fragment(a, input),
        Shader::TexelColor => texel_color::fragment::<A>(input),
        Shader::UniformColor => uniform_color::fragment(a, input),
    }
}
