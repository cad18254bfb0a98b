//! The interface of fragment shaders: inputs, outputs, the discard condition, the sample mask, and the
//! stencil reference.

use etalon_scene::Params;
use std::fmt;

/// The inputs of a fragment shader.
#[derive(Clone, Copy, Debug)]
pub struct FragmentInput<'a, R> {
    /// The vertex colour, flat over the primitive.
    pub color: [R; 4],
    /// True if the primitive faces front.
    pub front: bool,
    /// The fragment's window depth.
    pub depth: R,
    /// The sample being shaded.
    pub sample: u32,
    /// The sample mask, if [`etalon_scene::Shader::reads_mask`].
    pub mask: InputMask<'a, R>,
    /// The fragment's window coordinates, in texels from the left and from the top.
    pub position: [R; 2],
    /// The values of textures 0 and 1, fetched at the fragment or sampled; zeros if the shader reads none.
    pub texels: [[R; 4]; 2],
    /// Texture 0 at the texel beside and at the texel below or above, in the block of two by two texels of the
    /// fragment; `None` if [`etalon_scene::Shader::reads_derivatives`] is false, or if they are not modelled: a result
    /// computed from them can be anything.
    pub neighbours: Option<[[R; 4]; 2]>,
    /// Texture 0 at coordinates that the shader computes, if [`etalon_scene::Shader::taps_texture`].
    pub taps: Taps<'a, R>,
    /// The nodes of the texel, if the shader reads them.
    pub list: List<'a, R>,
    /// 1 over the clip-space w at the fragment, if [`etalon_scene::Shader::reads_w`].
    pub reciprocal_w: R,
    /// The interpolated texture coordinates, if [`etalon_scene::Shader::uses_uv`]; otherwise zeros.
    pub uv: [R; 2],
    /// The parameter block.
    pub params: &'a Params,
}

/// The sample mask that a shader reads.
#[derive(Clone, Copy)]
pub struct InputMask<'a, R>(Option<&'a dyn Fn(u32) -> R>);

impl<'a, R> InputMask<'a, R> {
    /// No mask.
    pub const NONE: Self = Self(None);

    /// Returns a mask with bits from a function of the bit's number.
    pub fn of(bit: &'a dyn Fn(u32) -> R) -> Self {
        Self(Some(bit))
    }

    /// Returns a bit, 0 or 1; `None` without a mask.
    pub fn bit(&self, number: u32) -> Option<R> {
        self.0.map(|bit| bit(number))
    }
}

impl<R> fmt::Debug for InputMask<'_, R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("InputMask").field(&self.0.is_some()).finish()
    }
}

/// A texture that a shader samples at coordinates that it computes.
#[derive(Clone, Copy)]
pub struct Taps<'a, R>(Option<&'a dyn Fn([R; 2]) -> [R; 4]>);

impl<'a, R> Taps<'a, R> {
    /// No texture.
    pub const NONE: Self = Self(None);

    /// Returns a texture that a function samples.
    pub fn of(sample: &'a dyn Fn([R; 2]) -> [R; 4]) -> Self {
        Self(Some(sample))
    }

    /// Returns the value at texture coordinates; `None` without a texture.
    pub fn at(&self, coordinates: [R; 2]) -> Option<[R; 4]> {
        self.0.map(|sample| sample(coordinates))
    }
}

impl<R> fmt::Debug for Taps<'_, R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Taps").field(&self.0.is_some()).finish()
    }
}

/// The fragments that earlier passes, and earlier draws of this one, left for a texel.
#[derive(Clone, Copy, Debug)]
pub enum List<'a, R> {
    /// The fragments are not modelled: a result computed from them can be anything.
    Unknown,
    /// All fragments of a list, the latest first, or the nearest layers, the nearest first; for
    /// [`PoolUse::FillNearest`](etalon_scene::PoolUse::FillNearest), the layers that have no colour yet. A lane with fewer fragments is filled up with fragments behind all
    /// depths, with alpha 0.
    Known(&'a [Node<R>]),
}

/// A fragment in a list.
#[derive(Clone, Copy, Debug)]
pub struct Node<R> {
    /// The colour, not premultiplied.
    pub color: [R; 4],
    /// The depth.
    pub depth: R,
}

/// The outputs of a fragment shader.
#[derive(Clone, Copy, Debug)]
pub struct FragmentOutput<R> {
    /// The colour at location 0, and at the shader's other locations unless `others` has them.
    pub color: [R; 4],
    /// The colours at locations 1 and 2, if they differ from the colour at location 0.
    pub others: Option<[[R; 4]; 2]>,
    /// The second source of dual-source blending, if the shader writes one.
    pub second: Option<[R; 4]>,
    /// The depth, if the shader writes one.
    pub depth: Option<R>,
    /// The condition under which the fragment is kept, if the shader can discard it.
    pub kept: Option<KeepCondition<R>>,
    /// The sample mask, if the shader writes one.
    pub mask: Option<SampleMask<R>>,
    /// The stencil reference, if the shader writes one.
    pub reference: Option<StencilReference<R>>,
    /// The node that the shader adds to those of its texel, if it does.
    pub node: Option<Node<R>>,
}

impl<R: Copy> FragmentOutput<R> {
    /// Returns outputs with a colour and nothing else.
    pub fn of(color: [R; 4]) -> Self {
        Self {
            color,
            others: None,
            second: None,
            depth: None,
            kept: None,
            mask: None,
            reference: None,
            node: None,
        }
    }

    /// Returns the colour at a location.
    #[inline(always)]
    pub fn at_location(&self, location: usize) -> [R; 4] {
        match (&self.others, location) {
            (Some(others), 1 | 2) => others[location - 1],
            _ => self.color,
        }
    }
}

/// The condition under which a fragment is kept.
#[derive(Clone, Copy, Debug)]
pub struct KeepCondition<R> {
    /// The value that is compared.
    pub value: R,
    /// The limit that it is compared with.
    pub limit: R,
    /// True if values above the limit are kept, false if values equal to the limit are kept as well.
    pub strict: bool,
}

impl<R> KeepCondition<R> {
    /// Discards values below a limit.
    pub fn unless_below(value: R, limit: R) -> Self {
        Self {
            value,
            limit,
            strict: false,
        }
    }

    /// Discards values that are not above a limit.
    pub fn above(value: R, limit: R) -> Self {
        Self {
            value,
            limit,
            strict: true,
        }
    }
}

/// The sample mask that a shader writes.
#[derive(Clone, Copy, Debug)]
pub struct SampleMask<R> {
    /// The bits, as an integer.
    pub bits: R,
    /// The sample whose bit is kept while all others are inverted; `None` to invert none.
    pub turned_but: Option<u32>,
}

impl<R> SampleMask<R> {
    /// Returns a mask of these bits.
    pub fn of(bits: R) -> Self {
        Self {
            bits,
            turned_but: None,
        }
    }

    /// Returns the mask as it is written, given its bits.
    #[inline(always)]
    pub fn written(&self, bits: u32) -> u32 {
        match self.turned_but {
            None => bits,
            Some(kept) => !bits ^ (1 << kept),
        }
    }
}

/// The stencil reference that a shader writes.
#[derive(Clone, Copy, Debug)]
pub struct StencilReference<R> {
    /// An integer.
    pub number: R,
    /// The number that the shader adds to it.
    pub plus: i32,
}

impl<R> StencilReference<R> {
    /// Returns a reference that is this number.
    pub fn of(number: R) -> Self {
        Self { number, plus: 0 }
    }

    /// Returns the reference as it is written, given its number.
    #[inline(always)]
    pub fn written(&self, number: f32) -> i32 {
        (number as i32).wrapping_add(self.plus)
    }
}
