//! The colour of a surface at a point, and the lines along which its formula changes.

use super::cell::{ConvexCell, Cut, PicturePoint};
use super::surface::PreparedSurface;
use etalon_methods::{Paint, StraightTexture};
use etalon_pipeline::texel_position;
use etalon_scene::AddressMode;

impl PreparedSurface<'_> {
    /// Returns the colour at a point: red, green, blue, not premultiplied, and alpha.
    pub(super) fn color(&self, p: PicturePoint) -> [f64; 4] {
        let grey = |v: f64| [v, v, v, 1.0];
        match self.paint {
            Paint::Flat([r, g, b, a]) => [*r, *g, *b, a.clamp(0.0, 1.0)],
            Paint::Depth => grey(self.depth.at(p)),
            Paint::Distance { near, far } => grey(fade(self.depth.at(p), *near, *far)),
            Paint::Fog {
                color,
                fog,
                near,
                far,
            } => {
                let fade = fade(self.depth.at(p), *near, *far);
                let mix = |c: usize| color[c] * (1.0 - fade) + fog[c] * fade;
                [mix(0), mix(1), mix(2), 1.0]
            }
            Paint::Texture { texture, .. } => {
                let [u, v] = self.positions(texture, p);
                let [r, g, b, a] = filtered(texture, [u, v]);
                [r, g, b, a.clamp(0.0, 1.0)]
            }
        }
    }

    /// Returns true if the colour is constant.
    pub(super) fn is_flat(&self) -> bool {
        matches!(self.paint, Paint::Flat(_))
    }

    /// Returns true if the surface is textured.
    pub(super) fn is_textured(&self) -> bool {
        matches!(self.paint, Paint::Texture { .. })
    }

    /// Returns true if the colour depends on the distance.
    pub(super) fn fades(&self) -> bool {
        matches!(self.paint, Paint::Distance { .. } | Paint::Fog { .. })
    }

    /// Cuts a cell in two if no single smooth formula describes the colour in all of it; otherwise returns
    /// `None`.
    ///
    /// A textured cell is cut along texel centres, so that each part's colour and alpha are of degree 2. A
    /// cell with a colour that fades is cut where the depth leaves 0 to 1, and halved until the distance at
    /// most doubles within it.
    pub(super) fn kink(&self, cell: &ConvexCell) -> Option<(ConvexCell, ConvexCell)> {
        let cut = |function: &dyn Fn(PicturePoint) -> f64, range: (f64, f64)| match cell
            .cut(function, 1e-9 * (range.1 - range.0))
        {
            Cut::Both(first, second) => Some((first, second)),
            Cut::Positive | Cut::Negative => None,
        };
        match self.paint {
            Paint::Flat(_) | Paint::Depth => None,
            Paint::Distance { near, far } | Paint::Fog { near, far, .. } => {
                let range = cell.range(|p| self.depth.at(p));
                let cut_at = |stop: f64| cut(&|p| self.depth.at(p) - stop, range);
                if let Some(parts) = [0.0, 1.0].into_iter().find_map(cut_at) {
                    return Some(parts);
                }
                let [a, b] = [range.0, range.1].map(|z| far - z.clamp(0.0, 1.0) * (far - near));
                if a.max(b) <= 2.0 * a.min(b) {
                    return None;
                }
                let middle = (far - (a * b).sqrt()) / (far - near);
                cut_at(middle)
            }
            Paint::Texture { texture, .. } => (0..2).find_map(|axis| {
                let position = |p| self.positions(texture, p)[axis];
                let range = cell.range(position);
                let room = 1e-9 * (1.0 + range.1 - range.0);
                let (mut first, mut last) = ((range.0 + room).ceil(), (range.1 - room).floor());
                if texture.address[axis] == AddressMode::ClampToEdge {
                    first = first.max(0.0);
                    last = last.min(f64::from(texture.size[axis]) - 1.0);
                }
                let middle = ((first + last) / 2.0).floor();
                (first <= last)
                    .then(|| cut(&|p| position(p) - middle, range))
                    .flatten()
            }),
        }
    }

    /// Returns the position of a point in the texture, in texels from the centre of the first one.
    fn positions(&self, texture: &StraightTexture, p: PicturePoint) -> [f64; 2] {
        std::array::from_fn(|axis| {
            let coordinate = self.uv.as_ref().map_or(0.0, |uv| uv[axis].at(p));
            coordinate * f64::from(texture.size[axis]) - 0.5
        })
    }
}

/// Returns the distance of a window depth: 0 at the near plane, 1 at the far plane and beyond.
fn fade(depth: f64, near: f64, far: f64) -> f64 {
    let distance = near * far / (far - depth.clamp(0.0, 1.0) * (far - near));
    ((distance - near) / (far - near)).clamp(0.0, 1.0)
}

/// Returns the weighted mean of the four texels around a position (Vulkan, Texel Filtering).
fn filtered(texture: &StraightTexture, position: [f64; 2]) -> [f64; 4] {
    let first = position.map(f64::floor);
    let weight = [position[0] - first[0], position[1] - first[1]];
    let taps: [[usize; 2]; 2] = std::array::from_fn(|axis| {
        let (mode, size, texel) = (
            texture.address[axis],
            texture.size[axis],
            first[axis] as i64,
        );
        [texel, texel.saturating_add(1)].map(|texel| texel_position(mode, texel, size))
    });
    let texel =
        |x: usize, y: usize| texture.texels[taps[1][y] * texture.size[0] as usize + taps[0][x]];
    let [top_left, top_right, left, right] = [texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1)];
    std::array::from_fn(|c| {
        let top = top_left[c] * (1.0 - weight[0]) + top_right[c] * weight[0];
        let bottom = left[c] * (1.0 - weight[0]) + right[c] * weight[0];
        top * (1.0 - weight[1]) + bottom * weight[1]
    })
}
