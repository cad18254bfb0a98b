//! The fragment shaders' twins: each `shaders/<name>.wgsl` written by hand once more, so that a bug
//! in a shader's translation shows instead of being shared by both sides. All vertex shaders pass
//! positions and attributes through.

mod centroid;
mod counted_color;
mod counted_depth;
mod counted_discard;
mod depth_grey;
mod depth_linearized;
mod depth_range;
mod dual_peel;
mod edge_alpha;
mod expensive_color;
mod expensive_depth;
mod expensive_discard;
mod flat_color;
mod flat_color_depth;
mod fog;
mod frag_coord_depth;
mod front_facing;
mod linear_depth;
mod logarithmic_depth;
mod peel;
mod sample_depth;
mod sample_index;
mod sampled_color;
mod sampled_discard;
mod stochastic;
mod texel_color;
mod texel_color_all;
mod texel_discard;
mod texel_dual_source;
mod uint_color;
mod uniform_color;
mod weighted_accumulate;
mod weighted_resolve;

pub use expensive_color::cost;

use crate::arithmetic::Arithmetic;
use etalon_scene::{Params, Shader};

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
    /// The interpolated texture coordinates, where [`Shader::uses_uv`]; zeros elsewhere.
    pub uv: [R; 2],
    /// The parameter block.
    pub params: &'a Params,
}

/// What a fragment shader gives.
#[derive(Clone, Copy, Debug)]
pub struct FragmentOutput<R> {
    /// The colour at location 0, and at all others that the shader writes unless `others` has them.
    pub color: [R; 4],
    /// The colours at locations 1 and 2, where the shader gives each its own.
    pub others: Option<[[R; 4]; 2]>,
    /// The second source for blending, where the shader gives one.
    pub second: Option<[R; 4]>,
    /// The depth, where the shader writes one.
    pub depth: Option<R>,
    /// Which fragments stay, where the shader may discard.
    pub kept: Option<Kept<R>>,
}

impl<R: Copy> FragmentOutput<R> {
    /// A colour and nothing else.
    pub fn of(color: [R; 4]) -> Self {
        Self {
            color,
            others: None,
            second: None,
            depth: None,
            kept: None,
        }
    }

    /// The colour at a location.
    #[inline(always)]
    pub fn at_location(&self, location: usize) -> [R; 4] {
        match (&self.others, location) {
            (Some(others), 1 | 2) => others[location - 1],
            _ => self.color,
        }
    }
}

/// Which fragments a shader that may discard keeps.
#[derive(Clone, Copy, Debug)]
pub struct Kept<R> {
    /// What decides.
    pub value: R,
    /// What it is compared with.
    pub limit: R,
    /// Whether a value that equals the limit goes: fragments are kept whose value is above the limit,
    /// else those whose value is not below it.
    pub strict: bool,
}

impl<R> Kept<R> {
    /// Fragments below a limit are discarded.
    pub fn unless_below(value: R, limit: R) -> Self {
        Self {
            value,
            limit,
            strict: false,
        }
    }

    /// Fragments not above a limit are discarded.
    pub fn above(value: R, limit: R) -> Self {
        Self {
            value,
            limit,
            strict: true,
        }
    }
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
        Shader::DepthGrey => depth_grey::fragment(a, input),
        Shader::DepthLinearized => depth_linearized::fragment(a, input),
        Shader::DepthRange => depth_range::fragment(a, input),
        Shader::DualPeel => dual_peel::fragment(a, input),
        Shader::EdgeAlpha => edge_alpha::fragment(a, input),
        Shader::ExpensiveColor => expensive_color::fragment::<A>(input),
        Shader::ExpensiveDepth => expensive_depth::fragment::<A>(input),
        Shader::ExpensiveDiscard => expensive_discard::fragment(a, input),
        Shader::FlatColor => flat_color::fragment::<A>(input),
        Shader::FlatColorDepth => flat_color_depth::fragment(a, input),
        Shader::Fog => fog::fragment(a, input),
        Shader::FragCoordDepth => frag_coord_depth::fragment::<A>(input),
        Shader::FrontFacing => front_facing::fragment(a, input),
        Shader::LinearDepth => linear_depth::fragment(a, input),
        Shader::LogarithmicDepth => logarithmic_depth::fragment(a, input),
        Shader::Peel => peel::fragment(a, input),
        Shader::SampleDepth => sample_depth::fragment(a, input),
        Shader::SampleIndex => sample_index::fragment(a, input),
        Shader::SampledColor => sampled_color::fragment::<A>(input),
        Shader::SampledDiscard => sampled_discard::fragment(a, input),
        Shader::Stochastic => stochastic::fragment(a, input),
        Shader::TexelColor => texel_color::fragment::<A>(input),
        Shader::TexelColorAll => texel_color_all::fragment::<A>(input),
        Shader::TexelDiscard => texel_discard::fragment(a, input),
        Shader::TexelDualSource => texel_dual_source::fragment::<A>(input),
        Shader::UintColor => uint_color::fragment(a, input),
        Shader::UniformColor => uniform_color::fragment(a, input),
        Shader::WeightedAccumulate => weighted_accumulate::fragment(a, input),
        Shader::WeightedResolve => weighted_resolve::fragment(a, input),
    }
}

/// A channel of a colour times its alpha; alpha itself stays.
fn premultiplied<A: Arithmetic>(a: &mut A, color: [A::Real; 4], c: usize) -> A::Real {
    if c == 3 {
        return color[3];
    }
    let product = a.mul(color[c], color[3]);
    a.rounded(product)
}

/// A value held to 0 and 1.
fn clamp_to_unit<A: Arithmetic>(a: &mut A, value: A::Real) -> A::Real {
    let (zero, one) = (a.constant(0.0), a.constant(1.0));
    let value = a.max(value, zero);
    a.min(value, one)
}

/// How far a value has come from one to another: 0 at the first, 1 at the second.
fn share_between<A: Arithmetic>(a: &mut A, value: A::Real, from: A::Real, to: A::Real) -> A::Real {
    let way = a.sub(value, from);
    let way = a.rounded(way);
    let whole = a.sub(to, from);
    let whole = a.rounded(whole);
    let share = a.div(way, whole);
    a.rounded(share)
}

/// The distance from the eye that a window depth of a perspective projection stands for.
fn distance_behind<A: Arithmetic>(
    a: &mut A,
    depth: A::Real,
    near: A::Real,
    far: A::Real,
) -> A::Real {
    let range = a.sub(far, near);
    let range = a.rounded(range);
    let part = a.mul(depth, range);
    let part = a.rounded(part);
    let below = a.sub(far, part);
    let below = a.rounded(below);
    let product = a.mul(near, far);
    let product = a.rounded(product);
    let distance = a.div(product, below);
    a.rounded(distance)
}
