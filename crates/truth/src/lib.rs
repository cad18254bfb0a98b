//! The truth mode: what a picture should be, from geometry alone.
//!
//! Every surface that covers a point is kept, sorted by its depth there, and composed over the
//! background in 64-bit floats. Nothing is rasterized, stored or rounded to a format, so that the
//! distance of a device's picture from it is the error of the method that drew it.

mod area;
mod cell;
mod distance;
mod order;
mod paint;
mod quadrature;
mod shown;
mod surface;

use area::Scene;
use cell::{Cell, Point};
use etalon_methods::Coverage;
use order::Members;
use surface::{Overlap, Ready};

pub use distance::distance;
pub use etalon_methods::Truth;
pub use shown::shown;

/// A picture as it should be.
#[derive(Clone, Debug, PartialEq)]
pub struct TruthPicture {
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Red, green and blue of every texel in the attachment's linear values, row by row from the top.
    pub rgb: Vec<[f64; 3]>,
    /// How far any channel of any texel may be off, beside rounding below 1e-8: 0 where all of it is
    /// closed form.
    pub error: f64,
}

/// Computes the picture that a scene should give.
///
/// With [`Coverage::Center`] a texel is what is seen at its centre; where an edge runs through it,
/// the top-left rule gives it to one of the two polygons. With [`Coverage::Area`] it is the mean over
/// the texel's area: exact for flat paints, depth and distance, and for up to six textured surfaces
/// over each other. With more of these, every piece on which their product is one polynomial is
/// integrated by 36 points in each triangle, and the error is estimated as twice what 16 points give
/// otherwise: on one polynomial the error of such rules falls geometrically with the points along a
/// side, so that the difference is several times what is left. A texel whose edges make more than
/// 4096 pieces is halved up to 8 times; what is then still in too many pieces is sampled, and the
/// error is its area times the spread of colours there.
///
/// A surface covers nothing where it has fewer than three corners, no area, a corner or a paint
/// that is not finite, a near or far plane that is not positive or not apart from the other, or a
/// texture whose texels or coordinates do not match its size or corners. Alpha is held to 0 to 1, the
/// depth of a paint that fades likewise. Of a polygon that is not convex only the part is covered from
/// which all of its edges are seen from inside.
pub fn truth(what: &Truth) -> TruthPicture {
    let surfaces: Vec<Ready<'_>> = what.surfaces.iter().filter_map(Ready::new).collect();
    let [width, height] = what.size;
    let mut painter = Painter {
        surfaces: &surfaces,
        background: what.background,
        coverage: what.coverage,
        picture: TruthPicture {
            size: what.size,
            rgb: vec![what.background; width as usize * height as usize],
            error: 0.0,
        },
    };
    let all: Vec<usize> = (0..surfaces.len()).collect();
    if width > 0 && height > 0 {
        painter.block([0, 0], [width, height], &all);
    }
    painter.picture
}

struct Painter<'a> {
    surfaces: &'a [Ready<'a>],
    background: [f64; 3],
    coverage: Coverage,
    picture: TruthPicture,
}

impl Painter<'_> {
    /// Paints the texels from `low` up to but not including `high`, in which no other than these
    /// surfaces are seen: at once where all of them have one colour, else in halves.
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
                Coverage::Center => self.center([from[0] + 0.5, from[1] + 0.5], &touching),
                Coverage::Area => self.mean(from, to, &touching),
            };
            return self.fill(low, high, color);
        }
        let axis = usize::from(height > width);
        let (mut before, mut after) = (high, low);
        before[axis] = low[axis] + (high[axis] - low[axis]) / 2;
        after[axis] = before[axis];
        self.block(low, before, &touching);
        self.block(after, high, &touching);
    }

    fn fill(&mut self, low: [u32; 2], high: [u32; 2], color: [f64; 3]) {
        let width = self.picture.size[0] as usize;
        for y in low[1]..high[1] {
            let row = y as usize * width;
            self.picture.rgb[row + low[0] as usize..row + high[0] as usize].fill(color);
        }
    }

    /// The colour that all of a rectangle has; `None` where it may have several.
    fn only_color(&self, low: Point, high: Point, covering: &[usize]) -> Option<[f64; 3]> {
        let scene = self.scene(covering);
        let visible = scene.visible(&Cell::rectangle(low, high), covering).ok()?;
        let flat = visible.iter().all(|&i| self.surfaces[i].is_flat());
        flat.then(|| order::compose(self.surfaces, &visible, self.background, low))
    }

    fn center(&self, p: Point, touching: &[usize]) -> [f64; 3] {
        let covering = touching.iter().copied();
        let mut members: Members = covering.filter(|&i| self.surfaces[i].covers(p)).collect();
        order::sort(self.surfaces, &mut members, &[p]);
        order::compose(self.surfaces, &members, self.background, p)
    }

    fn mean(&mut self, low: Point, high: Point, touching: &[usize]) -> [f64; 3] {
        let middle = [low[0] + 0.5, low[1] + 0.5];
        let sorted = area::nearest_first(self.surfaces, touching, middle);
        let integral = self.scene(&sorted).integral(low, high);
        self.picture.error = self.picture.error.max(integral.error);
        integral.sum
    }

    fn scene<'b>(&'b self, touching: &'b [usize]) -> Scene<'b> {
        Scene {
            surfaces: self.surfaces,
            background: self.background,
            touching,
        }
    }
}
