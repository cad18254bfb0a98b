//! Vertices: their snapped positions and depths.

use crate::context::PassContext;
use crate::interval::Interval;
use crate::judging::Judging;
use crate::primitive::VertexId;
use crate::range::Range;
use crate::rounding::{ceil, floor};
use crate::rules::Snap;
use crate::snap::{SnapBox, coarsest_step, units_per_texel};
use crate::viewport_bounds;
use etalon_pipeline::{Arithmetic, Point, window_coordinate};
use etalon_scene::{Draw, Pass, Viewport};
use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};

/// The maximum number of kept coordinates of each axis.
const MOST: usize = 4096;

/// The grid to which vertices are snapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Grid {
    /// The coarsest grid, either side: the result contains that of every adapter's grid.
    Coarsest,
    /// The adapter's.
    Adapter,
}

#[derive(Clone, Copy)]
pub(crate) struct SnappedVertex {
    pub(crate) snapped: SnapBox,
    pub(crate) window_z: Interval,
    pub(crate) clip_z: Interval,
    pub(crate) id: VertexId,
}

/// The latest coordinates of a pass's vertices. Neighbouring primitives share positions, meshes repeat
/// coordinates in rows and columns, and draws repeat those of others.
pub(crate) struct Vertices {
    /// The viewport of the kept coordinates.
    viewport: Option<Viewport>,
    /// The viewports, by the bounds of each axis, to which it can be rounded.
    rounded: [Vec<Viewport>; 2],
    /// Columns and rows of each grid: the least and the greatest snapped coordinate.
    snapped: [[Latest<(i64, i64)>; 2]; 2],
    /// The depth in the window and in clip space.
    depths: Latest<[Interval; 2]>,
}

/// The latest values for coordinates, each in the slot that a hash of the coordinate's bits and w's selects.
/// The number of slots is a power of two.
struct Latest<T>(Vec<Option<([u32; 2], T)>>);

impl<T: Copy> Latest<T> {
    #[inline]
    fn get(&mut self, coordinate: [f32; 2], value: impl FnOnce() -> T) -> T {
        let bits = coordinate.map(f32::to_bits);
        let mut hasher = FxHasher::default();
        bits.hash(&mut hasher);
        // The upper half of such a hash depends on all bits.
        let slot = (hasher.finish() >> 32) as usize & (self.0.len() - 1);
        match &self.0[slot] {
            Some((known, value)) if *known == bits => *value,
            _ => {
                let value = value();
                self.0[slot] = Some((bits, value));
                value
            }
        }
    }
}

impl Vertices {
    pub(crate) fn of(pass: &Pass) -> Self {
        let count = pass.draws.iter().map(|draw| draw.mesh.vertices.len());
        let slots = count.sum::<usize>().min(MOST).next_power_of_two();
        Self {
            viewport: None,
            rounded: [Vec::new(), Vec::new()],
            snapped: [(); 2].map(|()| [(); 2].map(|()| Latest(vec![None; slots]))),
            depths: Latest(vec![None; slots]),
        }
    }

    /// Prepares for draws with a viewport.
    pub(crate) fn enter(&mut self, context: &PassContext<'_>, viewport: &Viewport) {
        if self.viewport == Some(*viewport) {
            return;
        }
        if self.viewport.is_some() {
            let axes = self.snapped.iter_mut().flatten();
            axes.for_each(|axis| axis.0.fill(None));
            self.depths.0.fill(None);
        }
        self.viewport = Some(*viewport);
        self.rounded =
            [0, 1].map(|axis| viewport_bounds::rounded(viewport, axis, context.rules).collect());
    }

    /// Returns a vertex of a draw whose viewport was entered.
    pub(crate) fn get(
        &mut self,
        context: &PassContext<'_>,
        draw: &Draw,
        i: usize,
        grid: Grid,
    ) -> SnappedVertex {
        let position = draw.mesh.vertices[i].position;
        let [x, y, z, w] = position;
        let viewport = &draw.viewport;
        let [columns, rows] = &mut self.snapped[grid as usize];
        let [across, down] = &self.rounded;
        let x = columns.get([x, w], || snapped(context, [x, w], 0, across, grid));
        let y = rows.get([y, w], || snapped(context, [y, w], 1, down, grid));
        let [window_z, clip_z] = self.depths.get([z, w], || {
            let mut judging = Judging::new(context.rules);
            let window = window_coordinate(&mut judging, [z, w], 2, viewport);
            [window, judging.constant(z / w)].map(Range::hull)
        });
        SnappedVertex {
            snapped: SnapBox {
                low: Point { x: x.0, y: y.0 },
                high: Point { x: x.1, y: y.1 },
            },
            window_z,
            clip_z,
            id: VertexId::new(position),
        }
    }
}

/// Returns the least and the greatest position along an axis to which a coordinate can be snapped in one of the
/// viewports.
fn snapped(
    context: &PassContext<'_>,
    coordinate: [f32; 2],
    axis: usize,
    viewports: &[Viewport],
    grid: Grid,
) -> (i64, i64) {
    let mut judging = Judging::new(context.rules);
    let windows = viewports
        .iter()
        .map(|viewport| window_coordinate(&mut judging, coordinate, axis, viewport).hull());
    let window = windows.reduce(Interval::hull);
    let Interval { low, high } = window.unwrap_or(Interval::EVERYTHING);
    let units = units_per_texel(context.limits);
    let coarsest = coarsest_step(context.limits);
    let lines = (units / coarsest) as f64;
    if low == high && (low * lines).fract() == 0.0 {
        let position = (low * units as f64) as i64;
        return (position, position);
    }
    let (step, snap) = match grid {
        Grid::Coarsest => (coarsest, Snap::EitherSide),
        Grid::Adapter => (context.step(), context.rules.snap.value()),
    };
    let lines = (units / step) as f64;
    let (low, high) = match snap {
        Snap::EitherSide => (floor(low * lines), ceil(high * lines)),
        Snap::Nearest => (floor(low * lines + 0.5), floor(high * lines + 0.5)),
    };
    (low as i64 * step, high as i64 * step)
}
