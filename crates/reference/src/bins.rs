//! The primitives of a pass in bins: by row for a picture, which is walked from top to bottom, and by texel
//! for a story. The bins respect scissor rectangles, so that a row of a pass with thousands of draws meets
//! only the primitives that reach it.

use crate::clip::Clip;
use crate::context::PassContext;
use crate::primitive::{Bounds, EdgeSide, Shape, SnappedPrimitive, misses};
use crate::sample::Sample;
use crate::setup::{self, Filter};
use crate::sides::sides;
use crate::snap::{SnapBox, units_per_texel};
use crate::vertex::Vertices;
use etalon_pipeline::Point;
use etalon_scene::{Draw, Pass};
use std::ops::Range;

/// The number of texels beyond a viewport that a primitive clipped by it can still touch.
const BEYOND_VIEWPORT: i64 = 4;

/// The maximum number of texels whose samples are tried before a triangle is kept.
const MOST_TRIED: usize = 4;

/// The number of successive primitives of a draw that share bounds.
const RUN: usize = 32;

/// A primitive of a pass, and the texels that it can touch.
#[derive(Clone, Debug)]
struct PrimitiveReach {
    /// The draw within the pass.
    draw: u32,
    /// The primitive within the draw's setup.
    primitive: u32,
    /// The columns of these texels.
    columns: Range<u32>,
    /// The rows of these texels.
    rows: Range<u32>,
}

/// The primitives of all draws of a pass, in drawing order.
#[derive(Clone, Debug)]
pub(crate) struct PassSetup {
    draws: Vec<Vec<SnappedPrimitive>>,
    /// For each draw, the common bounds of each [`RUN`] of its primitives.
    bounds: Vec<Vec<Bounds>>,
    clips: Vec<Clip>,
    reaches: Vec<PrimitiveReach>,
    /// The box around the samples of the texel at the upper left.
    samples: SnapBox,
    /// Sub-texel units per texel.
    units: i64,
}

impl PassSetup {
    pub(crate) fn new(context: &PassContext<'_>, pass: &Pass) -> Self {
        let mut setup = Self {
            draws: Vec::new(),
            bounds: Vec::new(),
            clips: Vec::new(),
            reaches: Vec::new(),
            samples: around_samples(context),
            units: units_per_texel(context.limits),
        };
        let mut vertices = Vertices::of(pass);
        for (d, draw) in pass.draws.iter().enumerate() {
            let touched = |shape: &Shape| texels(context.size, draw, shape, setup.units);
            let filter = Filter {
                keeps: &|shape| context.keeps_misses || reaches(context, shape, touched(shape)),
                decides: &|shape| decides(context, shape, touched(shape), setup.samples),
            };
            let primitives = setup::draw(context, draw, &mut vertices, &filter);
            for (i, primitive) in primitives.iter().enumerate() {
                let [columns, rows] = touched(&primitive.shape);
                if !columns.is_empty() && !rows.is_empty() {
                    setup.reaches.push(PrimitiveReach {
                        draw: d as u32,
                        primitive: i as u32,
                        columns,
                        rows,
                    });
                }
            }
            let bounds = primitives.chunks(RUN).map(|run| {
                let each = run
                    .iter()
                    .map(|primitive| primitive.shape.bounds(setup.units));
                each.reduce(common).unwrap_or_default()
            });
            setup.bounds.push(bounds.collect());
            setup.draws.push(primitives);
            setup.clips.push(Clip::new(context, &draw.viewport));
        }
        setup
    }

    pub(crate) fn primitives_of(&self, draw: usize) -> &[SnappedPrimitive] {
        &self.draws[draw]
    }

    /// Returns the edges of a draw's viewport.
    pub(crate) fn clip(&self, draw: usize) -> &Clip {
        &self.clips[draw]
    }

    pub(crate) fn primitives_mut(&mut self) -> impl Iterator<Item = &mut SnappedPrimitive> {
        self.draws.iter_mut().flatten()
    }

    fn primitive(&self, reach: &PrimitiveReach) -> &SnappedPrimitive {
        &self.draws[reach.draw as usize][reach.primitive as usize]
    }

    /// Returns a primitive's draw and its index in the draw's setup.
    pub(crate) fn member(&self, number: u32) -> (u32, u32) {
        let reach = &self.reaches[number as usize];
        (reach.draw, reach.primitive)
    }

    /// Returns the primitives of a draw whose bounds contain a texel, inside its viewport or not.
    pub(crate) fn at(
        &self,
        draw: usize,
        x: u32,
        y: u32,
    ) -> impl Iterator<Item = &SnappedPrimitive> {
        let (x, y) = (i64::from(x), i64::from(y));
        let holds = move |[left, top, right, bottom]: Bounds| {
            x >= left && x < right && y >= top && y < bottom
        };
        let runs = self.draws[draw].chunks(RUN).zip(&self.bounds[draw]);
        let runs = runs.filter(move |(_, bounds)| holds(**bounds));
        let primitives = runs.flat_map(|(run, _)| run);
        primitives.filter(move |primitive| holds(primitive.shape.bounds(self.units)))
    }

    /// Returns the rows of the pass's attachments, from the top, with the primitives of a range of draws.
    pub(crate) fn rows(&self, draws: Range<usize>) -> Rows<'_> {
        let first = |draw: usize| {
            let before = |reach: &PrimitiveReach| (reach.draw as usize) < draw;
            self.reaches.partition_point(before) as u32
        };
        let mut coming: Vec<u32> = (first(draws.start)..first(draws.end)).collect();
        coming.sort_by_key(|number| self.reaches[*number as usize].rows.start);
        Rows {
            setup: self,
            coming,
            begun: 0,
            active: Vec::new(),
        }
    }
}

/// Returns the smallest bounds that contain both.
fn common(a: Bounds, b: Bounds) -> Bounds {
    [
        a[0].min(b[0]),
        a[1].min(b[1]),
        a[2].max(b[2]),
        a[3].max(b[3]),
    ]
}

/// Returns a sample of a pass's attachments.
fn sample_of(context: &PassContext<'_>, [x, y]: [u32; 2], sample: u32) -> Sample {
    Sample {
        size: context.size,
        samples: context.samples,
        x,
        y,
        sample,
    }
}

/// Returns the box around the points at which the samples of the texel at the upper left can be.
fn around_samples(context: &PassContext<'_>) -> SnapBox {
    let units = units_per_texel(context.limits);
    let texel = SnapBox {
        low: Point { x: 0, y: 0 },
        high: Point { x: units, y: units },
    };
    if context.samples > 1 && !context.rules.covers_at_positions.value() {
        return texel;
    }
    let points = (0..context.samples).map(|sample| {
        let point = sample_of(context, [0, 0], sample).point(context.limits);
        SnapBox {
            low: point,
            high: point,
        }
    });
    points.reduce(SnapBox::hull).unwrap_or(texel)
}

/// Returns false if a small triangle misses all judged samples of the texels that it can touch.
fn reaches(context: &PassContext<'_>, shape: &Shape, [columns, mut rows]: [Range<u32>; 2]) -> bool {
    let Shape::Triangle(triangle) = shape else {
        return true;
    };
    if columns.len() * rows.len() > MOST_TRIED {
        return true;
    }
    let units = units_per_texel(context.limits);
    let covers = |x: u32, y: u32, sample: u32| {
        let at = sample_of(context, [x, y], sample);
        let point = at.point(context.limits);
        !misses(triangle, sides(context.rules, triangle, at, point, units))
    };
    rows.any(|y| {
        let judged = columns.clone().filter(|x| context.lattice.contains(*x, y));
        judged
            .into_iter()
            .any(|x| (0..context.samples).any(|sample| covers(x, y, sample)))
    })
}

/// Returns true if a triangle covers or misses each judged sample of the texels that it can touch, wherever its
/// vertices are snapped.
fn decides(
    context: &PassContext<'_>,
    shape: &Shape,
    [columns, mut rows]: [Range<u32>; 2],
    samples: SnapBox,
) -> bool {
    let Shape::Triangle(triangle) = shape else {
        return false;
    };
    if triangle.area.0 <= 0 && triangle.area.1 >= 0 {
        return false;
    }
    let units = units_per_texel(context.limits);
    let is_sure = |x: u32, y: u32, sample: u32| {
        let at = sample_of(context, [x, y], sample);
        let point = at.point(context.limits);
        let sides = sides(context.rules, triangle, at, point, units);
        misses(triangle, sides) || !sides.contains(&EdgeSide::Unknown)
    };
    rows.all(|y| {
        let [mut outer, inner] = triangle.columns(y, columns.clone(), samples, units);
        outer.all(|x| {
            inner.contains(&x)
                || !context.lattice.contains(x, y)
                || (0..context.samples).all(|sample| is_sure(x, y, sample))
        })
    })
}

/// Returns the columns and rows of the texels that a primitive can touch.
fn texels(size: [u32; 2], draw: &Draw, shape: &Shape, units: i64) -> [Range<u32>; 2] {
    let viewport = draw.viewport.area();
    let bounds = shape.bounds(units);
    [0, 1].map(|axis| {
        let most = i64::from(size[axis]);
        let (mut low, mut high) = (bounds[axis], bounds[axis + 2]);
        if let Shape::Triangle(_) = shape {
            let (start, length) = (viewport[axis], viewport[axis + 2]);
            // The cast saturates.
            low = low.max((start.floor() as i64).saturating_sub(BEYOND_VIEWPORT));
            high = high.min(((start + length).ceil() as i64).saturating_add(BEYOND_VIEWPORT));
        }
        if let Some(scissor) = draw.scissor {
            let (start, length) = (i64::from(scissor[axis]), i64::from(scissor[axis + 2]));
            low = low.max(start);
            high = high.min(start + length);
        }
        low.clamp(0, most) as u32..high.clamp(0, most) as u32
    })
}

/// The rows of a pass from top to bottom, with the primitives that can touch each.
pub(crate) struct Rows<'s> {
    setup: &'s PassSetup,
    /// All primitives, sorted by first row.
    coming: Vec<u32>,
    /// The number of primitives in `coming` whose first row has been reached.
    begun: usize,
    active: Vec<u32>,
}

impl Rows<'_> {
    /// Returns the primitives of a row in drawing order. The caller must ask for rows from top to bottom.
    pub(crate) fn row(&mut self, row: u32) -> &[u32] {
        let rows = |number: &u32| &self.setup.reaches[*number as usize].rows;
        self.active.retain(|number| rows(number).end > row);
        let before = self.active.len();
        let coming = self.coming[self.begun..].iter();
        let begun = coming.take_while(|number| rows(number).start <= row);
        self.active.extend(begun.copied());
        self.begun += self.active.len() - before;
        if before > 0 && self.active.len() > before {
            self.active.sort_unstable();
        }
        &self.active
    }
}

/// The parts of a row. The same primitives can touch all texels of a part.
#[derive(Default)]
pub(crate) struct Segments {
    /// Primitives with their columns in the row, sorted by first column.
    coming: Vec<RowMember>,
    members: Vec<RowMember>,
    numbers: Vec<u32>,
    /// Columns at which a triangle starts or stops certainly covering texels.
    breaks: Vec<u32>,
}

/// A primitive in a row.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct RowMember {
    start: u32,
    number: u32,
    end: u32,
}

impl Segments {
    /// Calls `found` with the columns and primitives of each part of a row that a primitive can touch.
    pub(crate) fn of_row(
        &mut self,
        setup: &PassSetup,
        row: u32,
        active: &[u32],
        mut found: impl FnMut(Range<u32>, &[u32]),
    ) {
        self.coming.clear();
        self.breaks.clear();
        for number in active {
            let reach = &setup.reaches[*number as usize];
            let mut columns = reach.columns.clone();
            if let Shape::Triangle(triangle) = &setup.primitive(reach).shape {
                let [outer, inner] = triangle.columns(row, columns, setup.samples, setup.units);
                columns = outer;
                if !inner.is_empty() {
                    self.breaks.extend([inner.start, inner.end]);
                }
            }
            if !columns.is_empty() {
                self.coming.push(RowMember {
                    start: columns.start,
                    number: *number,
                    end: columns.end,
                });
            }
        }
        self.coming.sort_unstable();
        self.breaks.sort_unstable();
        self.members.clear();
        let (mut coming, mut breaks) =
            (self.coming.iter().peekable(), self.breaks.iter().peekable());
        let mut column = 0;
        loop {
            if self.members.is_empty() {
                let Some(next) = coming.peek() else { return };
                column = next.start;
            }
            let before = self.members.len();
            while let Some(next) = coming.next_if(|next| next.start <= column) {
                self.members.push(*next);
            }
            if before > 0 && self.members.len() > before {
                self.members.sort_unstable_by_key(|member| member.number);
            }
            while breaks.next_if(|b| **b <= column).is_some() {}
            let ends = self.members.iter().map(|member| member.end);
            let begins = coming.peek().map(|next| next.start);
            let stops = begins.into_iter().chain(breaks.peek().map(|b| **b));
            let Some(end) = ends.chain(stops).min() else {
                return;
            };
            self.numbers.clear();
            self.numbers.extend(self.members.iter().map(|m| m.number));
            found(column..end, &self.numbers);
            column = end;
            self.members.retain(|member| member.end > column);
        }
    }
}
