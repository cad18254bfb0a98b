//! The picture, by halving down to texels.

use super::area::{self, Layers};
use super::cell::{ConvexCell, PicturePoint};
use super::order::{self, Members};
use super::picture::TruthPicture;
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
    let surfaces: Vec<PreparedSurface<'_>> = scene
        .surfaces
        .iter()
        .filter_map(PreparedSurface::new)
        .collect();
    let indices: Vec<usize> = (0..surfaces.len()).collect();
    let (blocks, next) = (blocks(scene.size), AtomicUsize::new(0));
    let work = || {
        let mut renderer = Renderer {
            surfaces: &surfaces,
            background: scene.background,
            coverage: scene.coverage,
            picture: empty(scene),
        };
        let mut done = Vec::new();
        while let Some([low, high]) = blocks.get(next.fetch_add(1, Ordering::Relaxed)) {
            renderer.block(*low, *high, &indices);
            done.push([*low, *high]);
        }
        (renderer.picture, done)
    };
    let threads = available_parallelism().map_or(1, usize::from);
    let parts = share(threads.min(blocks.len()), work);
    let mut picture = empty(scene);
    for (part, done) in parts {
        picture.error = picture.error.max(part.error);
        for [low, high] in done {
            for y in low[1]..high[1] {
                let row = y as usize * scene.size[0] as usize;
                let texels = row + low[0] as usize..row + high[0] as usize;
                picture.rgb[texels.clone()].copy_from_slice(&part.rgb[texels]);
            }
        }
    }
    picture
}

/// Returns a picture of the background alone.
fn empty(scene: &Truth) -> TruthPicture {
    let [width, height] = scene.size;
    TruthPicture {
        size: scene.size,
        rgb: vec![scene.background; width as usize * height as usize],
        error: 0.0,
    }
}

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
    picture: TruthPicture,
}

impl Renderer<'_> {
    /// Fills the texels from `low` to `high`, the latter excluded, in which only these surfaces can be
    /// visible: at once if all texels have one colour, otherwise by halves.
    fn block(&mut self, low: [u32; 2], high: [u32; 2], surfaces: &[usize]) {
        let [from, to] = [low, high].map(|corner| corner.map(f64::from));
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
                TexelCoverage::Center => self.center([from[0] + 0.5, from[1] + 0.5], &touching),
                TexelCoverage::Area => self.mean(from, to, &touching),
            };
            return self.fill(low, high, color);
        }
        for [low, high] in halves(low, high) {
            self.block(low, high, &touching);
        }
    }

    fn fill(&mut self, low: [u32; 2], high: [u32; 2], color: [f64; 3]) {
        let width = self.picture.size[0] as usize;
        for y in low[1]..high[1] {
            let row = y as usize * width;
            self.picture.rgb[row + low[0] as usize..row + high[0] as usize].fill(color);
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
        self.picture.error = self.picture.error.max(integral.error);
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
