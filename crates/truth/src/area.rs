//! The integral of the picture over a cell.
//!
//! The cell is cut along the edges of the surfaces, along the lines where two of them pass through each
//! other, and where a paint changes its formula, until a single formula applies in every piece. Flat and
//! linear colours are integrated in closed form, others by quadrature, which is exact except for fades and many
//! textures.

use super::cell::{ConvexCell, Cut, PicturePoint, SLACK};
use super::order::{self, Members, Relation};
use super::quadrature;
use super::surface::PreparedSurface;
use smallvec::SmallVec;

/// The maximum number of pieces of a texel before it is halved.
const PIECES: usize = 4096;

/// The maximum recursion depth of cuts before a texel is halved, which bounds the stack.
const DEPTH: usize = 200;

/// The maximum number of halvings of a texel: to 16 by 16 parts.
const HALVINGS: u32 = 8;

/// The maximum number of stacked textured surfaces that are integrated exactly.
const EXACT_TEXTURES: usize = 6;

/// The numbers of points along a side for more textured surfaces: of the rule that is used, and of the
/// coarser rule that the error is estimated with.
const DENSE: [usize; 2] = [6, 4];

/// An integral over a part of the picture.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Integral {
    /// Colour times area.
    pub(super) sum: [f64; 3],
    /// The error of a channel: a bound, or an estimate for more than [`EXACT_TEXTURES`] textures.
    pub(super) error: f64,
}

impl Integral {
    fn add(&mut self, other: Self) {
        for (sum, more) in self.sum.iter_mut().zip(other.sum) {
            *sum += more;
        }
        self.error += other.error;
    }
}

/// The surfaces that can be visible in a part of the picture, over the background.
pub(super) struct Layers<'a> {
    pub(super) surfaces: &'a [PreparedSurface<'a>],
    pub(super) background: [f64; 3],
    /// The surfaces that can be visible there, approximately nearest first.
    pub(super) touching: &'a [usize],
}

impl Layers<'_> {
    /// Returns the integral of the picture over a cell.
    ///
    /// A cell with too many pieces is halved. A 256th of a texel that still has too many is given the colour
    /// at its middle; the error is its area times the widest spread of colours, since `over` returns a colour
    /// between its inputs.
    pub(super) fn integral(&self, low: PicturePoint, high: PicturePoint) -> Integral {
        self.halved(low, high, 0)
    }

    fn halved(&self, low: PicturePoint, high: PicturePoint, halvings: u32) -> Integral {
        let cell = ConvexCell::rectangle(low, high);
        let mut pieces = Pieces {
            layers: self,
            left: (PIECES >> halvings).max(16),
            depth: 0,
            integral: Integral::default(),
        };
        let mut members = Members::new();
        if pieces.cover(cell.clone(), 0, &mut members).is_some() {
            return pieces.integral;
        }
        if halvings == HALVINGS {
            return self.guess(&cell);
        }
        let (mut before, mut after) = (high, low);
        let axis = halvings as usize % 2;
        before[axis] = low[axis] + (high[axis] - low[axis]) / 2.0;
        after[axis] = before[axis];
        let mut both = self.halved(low, before, halvings + 1);
        both.add(self.halved(after, high, halvings + 1));
        both
    }

    fn guess(&self, cell: &ConvexCell) -> Integral {
        let (area, middle) = cell.area_and_centroid();
        let covering = self.touching.iter().copied();
        let mut members: Members = covering
            .filter(|&i| self.surfaces[i].covers(middle))
            .collect();
        order::sort(self.surfaces, &mut members, &[middle]);
        let color = order::compose(self.surfaces, &members, self.background, middle);
        let spread = |c: usize| {
            let tones = self.touching.iter().map(|&i| self.surfaces[i].tones[c]);
            let ground = (self.background[c], self.background[c]);
            let (low, high) = tones.fold(ground, |a, b| (a.0.min(b.0), a.1.max(b.1)));
            high - low
        };
        Integral {
            sum: color.map(|v| v * area),
            error: area * (0..3).map(spread).fold(0.0, f64::max),
        }
    }

    /// Returns the visible ones among surfaces that cover a whole cell, front to back; or two that cross in
    /// it.
    pub(super) fn visible(
        &self,
        cell: &ConvexCell,
        members: &[usize],
    ) -> Result<Members, [usize; 2]> {
        let mut sorted = Members::from_slice(members);
        order::sort(self.surfaces, &mut sorted, cell.corners());
        let crossing = |a: usize, b: usize| {
            order::relation(self.surfaces, a, b, cell.corners()) == Relation::Crossing
        };
        for (i, &member) in sorted.iter().enumerate() {
            if self.surfaces[member].opaque {
                // Surfaces behind an opaque one can be in any order.
                let behind = sorted[i + 1..].iter().find(|&&b| crossing(member, b));
                if let Some(&behind) = behind {
                    return Err([member, behind]);
                }
                sorted.truncate(i + 1);
                break;
            }
            match sorted.get(i + 1) {
                Some(&next) if crossing(member, next) => return Err([member, next]),
                _ => {}
            }
        }
        Ok(sorted)
    }
}

/// The pieces of a cell; every function returns `None` if there are too many, or if a crossing cannot be cut.
struct Pieces<'a> {
    layers: &'a Layers<'a>,
    left: usize,
    depth: usize,
    integral: Integral,
}

impl Pieces<'_> {
    /// Recurses one cut deeper.
    fn deeper(&mut self, what: impl FnOnce(&mut Self) -> Option<()>) -> Option<()> {
        self.left = self.left.checked_sub(1)?;
        self.depth = (self.depth < DEPTH).then_some(self.depth + 1)?;
        what(self)?;
        self.depth -= 1;
        Some(())
    }

    /// Adds a cell that `members` cover, and that the surfaces from `next` on can partly cover.
    fn cover(&mut self, cell: ConvexCell, next: usize, members: &mut Members) -> Option<()> {
        let (known, layers) = (members.len(), self.layers);
        let mut rest = cell;
        for (i, &candidate) in layers.touching.iter().enumerate().skip(next) {
            let surface = &layers.surfaces[candidate];
            if surface.misses(&rest) || self.hidden(candidate, members, &rest) {
                continue;
            }
            let mut covered = true;
            for edge in 0..surface.edges() {
                match rest.cut(|p| surface.inside(edge, p), SLACK) {
                    Cut::Positive => {}
                    Cut::Negative => {
                        covered = false;
                        break;
                    }
                    Cut::Both(inside, outside) => {
                        self.deeper(|pieces| pieces.cover(outside, i + 1, members))?;
                        rest = inside;
                    }
                }
            }
            if covered {
                members.push(candidate);
            }
        }
        self.arrange(&rest, members)?;
        members.truncate(known);
        Some(())
    }

    /// Returns true if a surface is behind an opaque one in all of a cell.
    fn hidden(&self, candidate: usize, members: &[usize], cell: &ConvexCell) -> bool {
        let surfaces = self.layers.surfaces;
        members.iter().any(|&member| {
            surfaces[member].opaque
                && order::relation(surfaces, member, candidate, cell.corners()) == Relation::Front
        })
    }

    /// Adds a cell that all of `members` and no other surface cover.
    fn arrange(&mut self, cell: &ConvexCell, members: &[usize]) -> Option<()> {
        let surfaces = self.layers.surfaces;
        match self.layers.visible(cell, members) {
            Ok(visible) => self.paint(cell, &visible),
            Err([a, b]) => {
                let slack = order::slack(surfaces, a, b);
                match cell.cut(|p| order::gap(surfaces, a, b, p), slack) {
                    Cut::Both(first, second) => self.deeper(|pieces| {
                        pieces.arrange(&first, members)?;
                        pieces.arrange(&second, members)
                    }),
                    Cut::Positive | Cut::Negative => None,
                }
            }
        }
    }

    /// Adds a cell in which these surfaces are visible, in this order.
    fn paint(&mut self, cell: &ConvexCell, visible: &[usize]) -> Option<()> {
        let layers = self.layers;
        let seen = |p| order::compose(layers.surfaces, visible, layers.background, p);
        let surfaces = || visible.iter().map(|&i| &layers.surfaces[i]);
        let textures = surfaces().filter(|s| s.is_textured()).count();
        let fades = surfaces().any(PreparedSurface::fades);
        if let Some((first, second)) = surfaces().find_map(|s| s.kink(cell)) {
            return self.deeper(|pieces| {
                pieces.paint(&first, visible)?;
                pieces.paint(&second, visible)
            });
        }
        if textures == 0 && !fades {
            // At most linear: the mean is the colour at the centroid.
            let (area, centroid) = cell.area_and_centroid();
            self.integral.add(Integral {
                sum: seen(centroid).map(|v| v * area),
                error: 0.0,
            });
            return Some(());
        }
        let by = |points: usize| {
            let mut sum = [0.0; 3];
            for triangle in cell.triangles() {
                let part = quadrature::integral(triangle, points, seen);
                sum.iter_mut()
                    .zip(part)
                    .for_each(|(sum, part)| *sum += part);
            }
            sum
        };
        // Each texture multiplies the colour behind it by (1 - alpha), of degree 2, and adds colour times
        // alpha, of degree 4: together `2 * textures + 2`. Between a distance and its double, 8 points
        // approximate its reciprocal to 1e-10.
        let fading = if fades { 6 } else { 0 };
        self.integral.add(if textures <= EXACT_TEXTURES {
            Integral {
                sum: by(textures + 2 + fading),
                error: 0.0,
            }
        } else {
            let [fine, coarse] = DENSE.map(by);
            let off = fine.iter().zip(coarse).map(|(a, b)| (a - b).abs());
            Integral {
                sum: fine,
                error: 2.0 * off.fold(0.0, f64::max),
            }
        });
        Some(())
    }
}

/// Returns the surfaces sorted by their depth at a point, nearest first.
pub(super) fn nearest_first(
    surfaces: &[PreparedSurface<'_>],
    touching: &[usize],
    p: PicturePoint,
) -> Vec<usize> {
    let mut depths: SmallVec<[(f64, usize); 16]> = touching
        .iter()
        .map(|&i| (surfaces[i].depth.at(p), i))
        .collect();
    depths.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    depths.into_iter().map(|(_, i)| i).collect()
}
