//! Vertices to triangles, and triangles to the tiles that they touch.

use super::TILE;
use super::edges::{EdgeFunctions, Touch};
use super::image::TiledImage;
use super::opaque::NARROW;
use super::paint::TexelPaint;
use super::plan::{Behind, DrawKernels, PassKernels, PrimitiveRun, Shading};
use super::texels::FetchTextures;
use super::texture::TexelRows;
use super::triangle::{Placed, Rare, RasterTriangle, TriangleKind, point};
use crate::lanes::LANES;
use crate::linear::UNITS;
use crate::planes::depth_bias;
use crate::steps::{Faithful, Steps};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Plain, front_facing, is_culled, window_position};
use etalon_scene::{ColorTarget, Draw, LogicOperation, Multisample, PrimitiveVertices, Vertex};
use fearless_simd::Simd;
use std::ops::Range;

/// The number of distinct colours of a blending draw for which functions of codes are made.
const FUNCTIONS: usize = 64;

/// The number of paints that later draws of a pass can find.
const KNOWN: usize = 64;

/// The triangles of a range of a pass's primitives. Different threads fill adjacent parts, which must not
/// share a cache line.
#[derive(Debug, Default)]
#[repr(align(128))]
pub(crate) struct RangeTriangles {
    pub(crate) triangles: Vec<RasterTriangle>,
    pub(crate) paints: Vec<TexelPaint>,
    /// The first paints of draws, with everything that they depend on.
    known: Vec<(Ingredients, u32)>,
    /// The properties that few triangles have.
    rare: Vec<Rare>,
    /// The entries of each tile, in drawing order.
    pub(crate) bins: Vec<Vec<TiledTriangle>>,
}

/// A triangle in a tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TiledTriangle(u32);

impl TiledTriangle {
    fn new(triangle: usize, whole: bool) -> Self {
        Self((triangle as u32) << 1 | u32::from(whole))
    }

    /// Returns the index of the triangle in its part.
    pub(crate) fn triangle(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// Returns true if the triangle covers all samples of the tile.
    pub(crate) fn is_whole(self) -> bool {
        self.0 & 1 != 0
    }
}

/// The vertices and primitives of a draw.
#[derive(Debug)]
pub(crate) struct DrawGeometry<'a> {
    pub(crate) draw: &'a Draw,
    pub(crate) plan: &'a DrawKernels,
    /// The index of the first vertex among the pass's vertices.
    pub(crate) base: usize,
    /// The number of the first primitive in the pass.
    pub(crate) first: usize,
    pub(crate) count: usize,
    /// The vertices and the provoking vertex of each primitive; empty if the plan has runs.
    pub(crate) primitives: Vec<([usize; 3], usize)>,
    /// The texture that the draw's shader samples.
    pub(crate) texture: Option<TexelRows>,
    /// The textures that the draw's shader fetches from.
    pub(crate) texels: Option<FetchTextures<'a>>,
}

impl<'a> DrawGeometry<'a> {
    /// Returns the input of a draw. `base` and `first` are the numbers of vertices and primitives before it.
    pub(crate) fn new(
        draw: &'a Draw,
        plan: &'a DrawKernels,
        images: &'a [TiledImage],
        base: usize,
        first: usize,
    ) -> Self {
        let primitives: Vec<_> = match plan.runs {
            Some(_) => Vec::new(),
            None => {
                let primitives = draw.primitives().into_iter().zip(draw.provoking_vertices());
                primitives
                    .filter_map(|(primitive, provoking)| match primitive {
                        PrimitiveVertices::Triangle(triangle) => Some((triangle, provoking)),
                        PrimitiveVertices::Point(_) | PrimitiveVertices::Line(_) => None,
                    })
                    .collect()
            }
        };
        let count = match &plan.runs {
            Some(runs) => runs.last().map_or(0, |run| run.first + run.count),
            None => primitives.len(),
        };
        Self {
            draw,
            plan,
            base,
            first,
            count,
            primitives,
            texture: match plan.shading {
                Shading::Texture { index, .. } => Some(TexelRows::new(&images[index])),
                _ => None,
            },
            texels: match plan.shading {
                Shading::Texels(first, second) => Some(FetchTextures::new(first, second, images)),
                _ => None,
            },
        }
    }

    /// Returns the vertices and the provoking vertex of a primitive in its run.
    #[inline(always)]
    fn primitive(&self, run: &PrimitiveRun, number: usize) -> ([usize; 3], usize) {
        if self.plan.runs.is_none() {
            return self.primitives[number];
        }
        let start = run.at + 3 * (number - run.first);
        let triangle = match &self.draw.mesh.indices {
            Some(indices) => {
                let three = &indices[start..start + 3];
                [three[0], three[1], three[2]].map(|i| i as usize)
            }
            None => [start, start + 1, start + 2],
        };
        (triangle, triangle[0])
    }
}

/// Transforms vertices to the window.
#[inline(always)]
pub(crate) fn place(draw: &Draw, vertices: &[Vertex], placed: &mut [Placed]) {
    for (vertex, placed) in vertices.iter().zip(placed) {
        let [[x], [y], [z]] = window_position(&mut Plain::<1>, vertex.position, &draw.viewport);
        // The plan only has vertices near the window.
        let snap = |v: f32| (v * UNITS as f32 + 0.5).floor() as i32;
        *placed = Placed {
            at: [snap(x), snap(y)],
            z,
        };
    }
}

impl RangeTriangles {
    /// Empties the part for a pass with this many tiles.
    pub(crate) fn clear(&mut self, tiles: usize) {
        self.triangles.clear();
        self.paints.clear();
        self.known.clear();
        self.rare.clear();
        self.bins.iter_mut().for_each(Vec::clear);
        self.bins.resize_with(tiles, Vec::new);
    }

    /// Returns a triangle's properties that few triangles have.
    #[inline(always)]
    pub(crate) fn rare(&self, triangle: &RasterTriangle) -> Rare {
        self.rare
            .get(triangle.rare as usize)
            .copied()
            .unwrap_or_default()
    }

    /// Sets up and sorts the primitives whose numbers in the pass are in a range.
    #[inline(always)]
    pub(crate) fn set_up<S: Simd>(
        &mut self,
        simd: S,
        pass: &PassKernels,
        inputs: &[DrawGeometry<'_>],
        placed: &[Placed],
        range: Range<usize>,
    ) {
        for (number, input) in inputs.iter().enumerate() {
            let start = range.start.clamp(input.first, input.first + input.count);
            let end = range.end.clamp(start, input.first + input.count);
            let mut draw = SetUp::new(simd, pass, input, number, self);
            let (start, end) = (start - input.first, end - input.first);
            // Without runs, all primitives are one run.
            let single_run = [PrimitiveRun {
                first: 0,
                count: input.count,
                at: 0,
            }];
            let runs = input.plan.runs.as_deref().unwrap_or(&single_run);
            let before = runs.partition_point(|run| run.first + run.count <= start);
            for run in &runs[before..] {
                for number in run.first.max(start)..(run.first + run.count).min(end) {
                    let (triangle, provoking) = input.primitive(run, number);
                    draw.triangle(
                        triangle,
                        triangle.map(|i| placed[input.base + i]),
                        provoking,
                    );
                }
            }
        }
    }
}

/// Everything within a pass that a paint depends on.
#[derive(Debug, PartialEq)]
struct Ingredients {
    color: [u32; 4],
    shading: Shading,
    target: Option<ColorTarget>,
    others: Vec<ColorTarget>,
    constant: [u32; 4],
    logic: Option<LogicOperation>,
    multisample: Multisample,
    alpha_to_coverage: bool,
    alpha_to_one: bool,
}

impl Ingredients {
    fn new(draw: &Draw, shading: Shading, color: [u32; 4]) -> Self {
        Self {
            color,
            shading,
            target: draw.targets.first().copied(),
            others: draw.targets.iter().skip(1).copied().collect(),
            constant: draw.blend_constant.map(f32::to_bits),
            logic: draw.logic,
            multisample: draw.multisample,
            alpha_to_coverage: draw.alpha_to_coverage(),
            alpha_to_one: draw.alpha_to_one(),
        }
    }
}

/// The setup of a draw's triangles.
struct SetUp<'a, S> {
    simd: S,
    pass: &'a PassKernels,
    draw: &'a Draw,
    plan: &'a DrawKernels,
    number: usize,
    part: &'a mut RangeTriangles,
    /// The index of the draw's first paint.
    first: usize,
    /// The depth and bias of the last flat triangle, and their code.
    code: Option<([u64; 2], u32)>,
    /// The last paint, with its colour.
    last: Option<([u32; 4], u32)>,
    /// The least and the greatest offset of samples across and down.
    samples: [[i32; 2]; 2],
    across: usize,
}

impl<'a, S: Simd> SetUp<'a, S> {
    fn new(
        simd: S,
        pass: &'a PassKernels,
        input: &'a DrawGeometry<'_>,
        number: usize,
        part: &'a mut RangeTriangles,
    ) -> Self {
        let ends = |axis: usize| {
            let positions = || pass.positions.iter().map(|p| p[axis]);
            [
                positions().min().unwrap_or(0),
                positions().max().unwrap_or(0),
            ]
        };
        Self {
            simd,
            pass,
            draw: input.draw,
            plan: input.plan,
            number,
            first: part.paints.len(),
            part,
            code: None,
            last: None,
            samples: [ends(0), ends(1)],
            across: pass.size[0].div_ceil(TILE),
        }
    }

    #[inline(always)]
    fn triangle(&mut self, vertices: [usize; 3], corners: [Placed; 3], provoking: usize) {
        let [a, b, c] = corners.map(|v| v.at);
        // The extents of small triangles, and of most others, are small enough that the product fits.
        let area = (i64::from(b[1]) - i64::from(a[1])) * (i64::from(c[0]) - i64::from(a[0]))
            - (i64::from(b[0]) - i64::from(a[0])) * (i64::from(c[1]) - i64::from(a[1]));
        if area == 0 || self.plan.rejects && self.is_behind(vertices) {
            return;
        }
        let front = front_facing(area, self.draw.front_face);
        if is_culled(self.draw.cull, front) {
            return;
        }
        let units = UNITS as i32;
        let extent = |axis: usize| {
            let [a, b, c] = [a[axis], b[axis], c[axis]];
            [a.min(b).min(c), a.max(b).max(c)]
        };
        let (wide, high) = (extent(0), extent(1));
        // The first texel with a sample at or after the least coordinate, and the last texel with a sample
        // before the greatest.
        let texels = |[low, high]: [i32; 2], [first, last]: [i32; 2]| {
            [
                -(last - low).div_euclid(units),
                (high - first).div_euclid(units),
            ]
        };
        let [left, right] = texels(wide, self.samples[0]);
        let [top, bottom] = texels(high, self.samples[1]);
        let bounds = self.plan.bounds;
        let around = [
            left.max(bounds[0]),
            top.max(bounds[1]),
            right.min(bounds[2] - 1),
            bottom.min(bounds[3] - 1),
        ];
        if around[0] > around[2] || around[1] > around[3] {
            return;
        }
        let paint = self.paint(front, provoking);
        let exported = self.exported(provoking);
        let depth = exported.unwrap_or(corners[0].z);
        let flat =
            exported.is_some() || corners[0].z == corners[1].z && corners[0].z == corners[2].z;
        let bias = if exported.is_some() {
            0.0
        } else {
            self.bias(&corners)
        };
        let around = around.map(|v| v as i16);
        // Each sample of a texel has its own rectangle; they differ by at most one texel.
        let cut = left <= bounds[0] + 1
            || top <= bounds[1] + 1
            || right >= bounds[2] - 2
            || bottom >= bounds[3] - 2;
        let textured = matches!(self.plan.shading, Shading::Texture { .. });
        let rare = if textured || bias != 0.0 {
            let vertices = vertices.map(|i| i as u32);
            self.part.rare.push(Rare { bias, vertices });
            self.part.rare.len() as u32 - 1
        } else {
            u32::MAX
        };
        // A triangle that covers a tile is wider and higher than the tile.
        let side = TILE as i32 * units;
        let covers = wide[1] - wide[0] > side && high[1] - high[0] > side;
        let tiles = around.map(|v| v as usize / TILE);
        let narrow = i32::from(around[2] - around[0]) < NARROW;
        let near = wide[1] - wide[0] <= side && high[1] - high[0] <= side;
        let shape = match (flat, near) {
            (true, true) if narrow && !cut && tiles[..2] == tiles[2..] => TriangleKind::Small,
            (true, true) => TriangleKind::FlatNear,
            (true, false) => TriangleKind::Flat,
            (false, true) => TriangleKind::SlopedNear,
            (false, false) => TriangleKind::Sloped,
        };
        let triangle = RasterTriangle {
            corners,
            rare,
            code: match (flat, self.pass.depth) {
                (true, Some(encoding)) => self.code(encoding, depth, bias),
                _ => 0,
            },
            draw: self.number as u32,
            paint,
            around,
            front,
            shape,
            counter: area > 0,
            cut,
        };
        let index = self.part.triangles.len();
        self.part.triangles.push(triangle);
        self.sort(index, &triangle, covers);
    }

    /// Returns true if a triangle is in front of the near plane or behind the far plane. The plan has no
    /// triangle that they cut.
    fn is_behind(&self, [vertex, ..]: [usize; 3]) -> bool {
        Behind::of(&self.draw.mesh.vertices[vertex]).is_some()
    }

    /// Returns the depth that the shader writes, if it writes depth.
    #[inline(always)]
    fn exported(&self, provoking: usize) -> Option<f32> {
        match self.plan.shading {
            Shading::Depth => Some(self.draw.mesh.vertices[provoking].color[0]),
            _ => None,
        }
    }

    /// Returns the depth code of a flat triangle.
    #[inline(always)]
    fn code(&mut self, encoding: ChannelEncoding, depth: f32, bias: f64) -> u32 {
        let key = [u64::from(depth.to_bits()), bias.to_bits()];
        if let Some((last, code)) = self.code
            && last == key
        {
            return code;
        }
        let depth = super::depth::biased(self.draw, depth, bias);
        let code = Faithful.depth_codes(encoding, [depth; LANES])[0];
        self.code = Some((key, code));
        code
    }

    /// Returns the depth bias of a triangle.
    #[inline(always)]
    fn bias(&self, corners: &[Placed; 3]) -> f64 {
        let state = &self.draw.depth_bias;
        if state.constant == 0 && state.slope == 0.0 {
            return 0.0;
        }
        let points = corners.map(|v| point(v.at));
        depth_bias(
            self.draw,
            points,
            corners.map(|v| v.z),
            self.pass.depth,
            &Faithful,
        )
    }

    /// Returns the index of a triangle's paint.
    #[inline(always)]
    fn paint(&mut self, front: bool, provoking: usize) -> u32 {
        let params = &self.draw.params;
        let color = match self.plan.shading {
            Shading::Vertex => self.draw.mesh.vertices[provoking].color,
            // The shader's work adds 0.
            Shading::Expensive(_) | Shading::Kept(_) => {
                self.draw.mesh.vertices[provoking].color.map(|v| v + 0.0)
            }
            Shading::Facing if !front => params.back_color,
            Shading::Depth | Shading::Facing | Shading::Uniform => params.color,
            Shading::Nothing | Shading::Texture { .. } | Shading::Texels(..) => [0.0; 4],
        };
        let bits = color.map(f32::to_bits);
        match self.last {
            Some((last, paint)) if last == bits => paint,
            _ => self.new_paint(color),
        }
    }

    fn new_paint(&mut self, color: [f32; 4]) -> u32 {
        let bits = color.map(f32::to_bits);
        // Most draws have one colour, and few different states.
        let first = self.last.is_none();
        let ingredients = Ingredients::new(self.draw, self.plan.shading, bits);
        if first {
            let mut known = self.part.known.iter();
            if let Some((_, paint)) = known.find(|(i, _)| *i == ingredients) {
                self.last = Some((bits, *paint));
                return *paint;
            }
        }
        let quick = self.part.paints.len() - self.first > FUNCTIONS;
        let paint = TexelPaint::new(
            self.simd,
            self.draw,
            self.plan.shading,
            color,
            self.pass,
            quick,
        );
        let place = self.part.paints.len() as u32;
        self.part.paints.push(paint);
        if first && self.part.known.len() < KNOWN {
            self.part.known.push((ingredients, place));
        }
        self.last = Some((bits, place));
        place
    }

    /// Adds a triangle to the tiles that it touches. `covers` is true if it might cover whole tiles.
    #[inline(always)]
    fn sort(&mut self, index: usize, triangle: &RasterTriangle, covers: bool) {
        let [left, top, right, bottom] = triangle.around.map(|v| v as usize / TILE);
        if left == right && top == bottom && !covers {
            self.part.bins[top * self.across + left].push(TiledTriangle::new(index, false));
            return;
        }
        let edges = EdgeFunctions::new(triangle);
        for y in top..=bottom {
            for x in left..=right {
                let texels = tile_texels(self.pass, [x, y]);
                let touch = edges.touch(&texels, &self.samples);
                let whole = match touch {
                    Touch::None => continue,
                    Touch::Part => false,
                    Touch::Whole => self.plan.rects.iter().all(|rect| {
                        let [a, b, c, d] = texels;
                        rect[0] <= a && rect[1] <= b && c <= rect[2] && d <= rect[3]
                    }),
                };
                self.part.bins[y * self.across + x].push(TiledTriangle::new(index, whole));
            }
        }
    }
}

/// Returns the left, top, right and bottom edges of a tile's texels in the attachment. Right and bottom are
/// exclusive.
pub(crate) fn tile_texels(pass: &PassKernels, [x, y]: [usize; 2]) -> [i32; 4] {
    let [width, height] = pass.size;
    let (left, top) = (x * TILE, y * TILE);
    let bounds = [
        left,
        top,
        (left + TILE).min(width),
        (top + TILE).min(height),
    ];
    bounds.map(|v| v as i32)
}
