//! The truth of a method's scene as geometry, from which the exact picture is computed.

use etalon_scene::AddressMode;

/// A picture as it should be, independent of any method, format or API.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Red, green and blue behind everything, 0 to 1.
    pub background: [f64; 3],
    /// The part of a texel that counts.
    pub coverage: TexelCoverage,
    /// The surfaces, in any order. Of two surfaces at the same depth, the later one is in front.
    pub surfaces: Vec<FlatSurface>,
}

/// The part of a texel that its colour represents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TexelCoverage {
    /// The texel's centre: for questions in which edges do not matter, or whose methods take one sample.
    Center,
    /// The mean over the texel's area.
    Area,
}

/// A flat convex polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatSurface {
    /// At least three corners in order around it, in either direction: x and y in texels from the top left
    /// corner, and a depth that grows away from the eye and is linear in x and y (a window depth, or
    /// minus 1 over the distance).
    pub corners: Vec<[f64; 3]>,
    /// The surface's colour.
    pub paint: Paint,
}

/// The colours of a surface: straight (not premultiplied), 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Paint {
    /// Red, green, blue and alpha.
    Flat([f64; 4]),
    /// The surface's depth as grey, opaque.
    Depth,
    /// The distance that the surface's depth represents as grey, opaque. The depth is a window depth of a
    /// perspective projection, 0 at the near and 1 at the far plane.
    Distance {
        /// Distance of the near plane.
        near: f64,
        /// Distance of the far plane.
        far: f64,
    },
    /// A colour that fades to another one with the distance, opaque; depths as in [`Paint::Distance`].
    Fog {
        /// Red, green and blue at the near plane.
        color: [f64; 3],
        /// Red, green and blue at the far plane.
        fog: [f64; 3],
        /// Distance of the near plane.
        near: f64,
        /// Distance of the far plane.
        far: f64,
    },
    /// A texture, filtered linearly.
    Texture {
        /// The texture's texels.
        texture: StraightTexture,
        /// Texture coordinates of each corner, linear in x and y.
        uv: Vec<[f64; 2]>,
    },
}

/// A texture of straight colours.
#[derive(Clone, Debug, PartialEq)]
pub struct StraightTexture {
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Red, green, blue and alpha, row by row from the top.
    pub texels: Vec<[f64; 4]>,
    /// The address modes, across and down.
    pub address: [AddressMode; 2],
}
