//! The picture, or its texels on a lattice, by halving down to texels.

use super::area::{self, Layers};
use super::cell::{ConvexCell, PicturePoint};
use super::order::{self, Members};
use super::picture::{Lattice, LatticeTruth, TruthPicture};
use super::surface::{Overlap, PreparedSurface};
use etalon_frame::threads::share;
use etalon_methods::{TexelCoverage, Truth};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::available_parallelism;

/// Returns the true picture of a scene.
///
/// With [`TexelCoverage::Center`], a texel has the colour at its centre; if an edge runs through the centre, the
/// top-left rule gives it to one of the two polygons. With [`TexelCoverage::Area`], it has the mean over its area:
/// exact for flat paints, depth and distance, and for up to six stacked textured surfaces. With more textured
/// surfaces, every piece on which their product is one polynomial is integrated with 36 points per triangle.
/// The error is then estimated as twice the difference from the result with 16 points: on one polynomial, the
/// error of such rules falls geometrically with the number of points along a side, so the difference is
/// several times the remaining error. A texel whose edges make more than 4096 pieces is halved up to 8 times;
/// a part that still has too many pieces is sampled, and the error is its area times the spread of colours
/// there.
///
/// A surface covers nothing if it has fewer than three corners, no area, a corner or a paint that is not
/// finite, near and far planes that are not positive and distinct, or a texture whose texels or coordinates
/// do not match its size or corners. Alpha is clamped to 0 to 1, and so is the depth of a paint that fades. A
/// polygon that is not convex covers only the points that are inside all its edges.
pub fn truth(scene: &Truth) -> TruthPicture {
    let lattice = Lattice {
        size: scene.size,
        step: 1,
    };
    truth_on(scene, lattice).picture
}

/// Returns the true colours of a frame on a lattice, each as [`truth`] has it.
pub fn truth_on(scene: &Truth, lattice: Lattice) -> LatticeTruth {
    let surfaces: Vec<PreparedSurface<'_>> = scene
        .surfaces
        .iter()
        .filter_map(PreparedSurface::new)
        .collect();
    let indices: Vec<usize> = (0..surfaces.len()).collect();
    let count = lattice.count();
    let (blocks, next) = (blocks(count), AtomicUsize::new(0));
    let empty = || LatticeTruth {
        lattice,
        picture: empty(count, scene.background),
        compared: vec![true; count[0] as usize * count[1] as usize],
    };
    let work = || {
        let mut renderer = Renderer {
            surfaces: &surfaces,
            background: scene.background,
            coverage: scene.coverage,
            truth: empty(),
        };
        let mut done = Vec::new();
        while let Some([low, high]) = blocks.get(next.fetch_add(1, Ordering::Relaxed)) {
            renderer.block(*low, *high, &indices);
            done.push([*low, *high]);
        }
        (renderer.truth, done)
    };
    let threads = available_parallelism().map_or(1, usize::from);
    let parts = share(threads.min(blocks.len()), work);
    let LatticeTruth {
        mut picture,
        mut compared,
        ..
    } = empty();
    for (part, done) in parts {
        picture.error = picture.error.max(part.picture.error);
        for [low, high] in done {
            for y in low[1]..high[1] {
                let row = y as usize * count[0] as usize;
                let texels = row + low[0] as usize..row + high[0] as usize;
                picture.rgb[texels.clone()].copy_from_slice(&part.picture.rgb[texels.clone()]);
                compared[texels.clone()].copy_from_slice(&part.compared[texels]);
            }
        }
    }
    LatticeTruth {
        lattice,
        picture,
        compared,
    }
}

/// Returns a picture of one colour.
fn empty(size: [u32; 2], color: [f64; 3]) -> TruthPicture {
    TruthPicture {
        size,
        rgb: vec![color; size[0] as usize * size[1] as usize],
        error: 0.0,
    }
}

/// The distance in texels from a texel's centre beyond which an edge does not cross it: half of its diagonal. Where an
/// edge crosses a texel, methods with several samples show the edge, and rounding a vertex can decide which surface
/// covers the centre; both are no error of a method that composes surfaces.
const CROSSING: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Returns parts of a picture for threads, as their corners; several times as many as there are cores, since
/// some take longer. The parts are the halves that [`Renderer::block`] would make, so that no texel depends
/// on the number of threads.
fn blocks([width, height]: [u32; 2]) -> Vec<[[u32; 2]; 2]> {
    const TEXELS: u64 = 1024;
    let mut blocks = Vec::new();
    let mut open = if width > 0 && height > 0 {
        vec![[[0, 0], [width, height]]]
    } else {
        Vec::new()
    };
    while let Some([low, high]) = open.pop() {
        if u64::from(high[0] - low[0]) * u64::from(high[1] - low[1]) <= TEXELS {
            blocks.push([low, high]);
            continue;
        }
        open.extend(halves(low, high));
    }
    blocks
}

/// Returns the two halves of a block, cut across its longer side.
fn halves(low: [u32; 2], high: [u32; 2]) -> [[[u32; 2]; 2]; 2] {
    let axis = usize::from(high[1] - low[1] > high[0] - low[0]);
    let (mut before, mut after) = (high, low);
    before[axis] = low[axis] + (high[axis] - low[axis]) / 2;
    after[axis] = before[axis];
    [[low, before], [after, high]]
}

/// A picture whose blocks are being filled.
struct Renderer<'a> {
    surfaces: &'a [PreparedSurface<'a>],
    background: [f64; 3],
    coverage: TexelCoverage,
    truth: LatticeTruth,
}

impl Renderer<'_> {
    /// Fills the texels of the lattice from `low` to `high`, the latter excluded, in which only these surfaces can
    /// be visible: at once if all texels have one colour, otherwise by halves.
    fn block(&mut self, low: [u32; 2], high: [u32; 2], surfaces: &[usize]) {
        let lattice = self.truth.lattice;
        let from = low.map(|first| f64::from(lattice.place(first)));
        let to = high.map(|end| f64::from(lattice.place(end - 1) + 1));
        let mut whole = true;
        let mut touching = Vec::with_capacity(surfaces.len());
        for &i in surfaces {
            match self.surfaces[i].overlap(from, to) {
                Overlap::None => continue,
                Overlap::Part => whole = false,
                Overlap::Whole => {}
            }
            touching.push(i);
        }
        if whole && let Some(color) = self.only_color(from, to, &touching) {
            return self.fill(low, high, color);
        }
        let [width, height] = [high[0] - low[0], high[1] - low[1]];
        if width == 1 && height == 1 {
            let color = match self.coverage {
                TexelCoverage::Center => {
                    let center = [from[0] + 0.5, from[1] + 0.5];
                    let near = |i: &usize| self.surfaces[*i].edge_is_near(center, CROSSING);
                    let index = low[1] as usize * self.truth.picture.size[0] as usize;
                    self.truth.compared[index + low[0] as usize] = !touching.iter().any(near);
                    self.center(center, &touching)
                }
                TexelCoverage::Area => self.mean(from, to, &touching),
            };
            return self.fill(low, high, color);
        }
        for [low, high] in halves(low, high) {
            self.block(low, high, &touching);
        }
    }

    fn fill(&mut self, low: [u32; 2], high: [u32; 2], color: [f64; 3]) {
        let width = self.truth.picture.size[0] as usize;
        for y in low[1]..high[1] {
            let row = y as usize * width;
            self.truth.picture.rgb[row + low[0] as usize..row + high[0] as usize].fill(color);
        }
    }

    /// Returns the colour of a rectangle; `None` if it can have several.
    fn only_color(
        &self,
        low: PicturePoint,
        high: PicturePoint,
        covering: &[usize],
    ) -> Option<[f64; 3]> {
        let layers = self.layers(covering);
        let visible = layers
            .visible(&ConvexCell::rectangle(low, high), covering)
            .ok()?;
        let flat = visible.iter().all(|&i| self.surfaces[i].is_flat());
        flat.then(|| order::compose(self.surfaces, &visible, self.background, low))
    }

    fn center(&self, p: PicturePoint, touching: &[usize]) -> [f64; 3] {
        let covering = touching.iter().copied();
        let mut members: Members = covering.filter(|&i| self.surfaces[i].covers(p)).collect();
        order::sort(self.surfaces, &mut members, &[p]);
        order::compose(self.surfaces, &members, self.background, p)
    }

    fn mean(&mut self, low: PicturePoint, high: PicturePoint, touching: &[usize]) -> [f64; 3] {
        let middle = [low[0] + 0.5, low[1] + 0.5];
        let sorted = area::nearest_first(self.surfaces, touching, middle);
        let integral = self.layers(&sorted).integral(low, high);
        let error = &mut self.truth.picture.error;
        *error = error.max(integral.error);
        integral.sum
    }

    fn layers<'b>(&'b self, touching: &'b [usize]) -> Layers<'b> {
        Layers {
            surfaces: self.surfaces,
            background: self.background,
            touching,
        }
    }
}
