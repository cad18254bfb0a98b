//! Vertices: their snapped positions and depths.

use crate::context::PassContext;
use crate::interval::Interval;
use crate::judging::Judging;
use crate::primitive::VertexId;
use crate::range::Range;
use crate::rounding::{ceil, floor};
use crate::rules::Snap;
use crate::snap::{SnapBox, units_per_texel};
use etalon_pipeline::{Arithmetic, Point, window_position};
use etalon_scene::{Draw, Pass, Viewport};
use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};

/// The maximum number of vertices that are kept.
const MOST: usize = 4096;

#[derive(Clone, Copy)]
pub(crate) struct Vertex {
    pub(crate) snapped: SnapBox,
    pub(crate) window_z: Interval,
    pub(crate) clip_z: Interval,
    pub(crate) id: VertexId,
}

/// The latest vertices of a pass. Neighbouring primitives share positions, and draws repeat those of others.
pub(crate) struct Vertices {
    /// The viewport of the kept vertices.
    viewport: Option<Viewport>,
    /// Vertices with the bits of their positions, in the slot that a hash of the bits selects. The length is
    /// a power of two.
    kept: Vec<Option<([u32; 4], Vertex)>>,
}

impl Vertices {
    pub(crate) fn of(pass: &Pass) -> Self {
        let count = pass.draws.iter().map(|draw| draw.mesh.vertices.len());
        let slots = count.sum::<usize>().min(MOST).next_power_of_two();
        Self {
            viewport: None,
            kept: vec![None; slots],
        }
    }

    /// Prepares for draws with a viewport.
    pub(crate) fn enter(&mut self, viewport: &Viewport) {
        if self.viewport.is_some_and(|known| known != *viewport) {
            self.kept.fill(None);
        }
        self.viewport = Some(*viewport);
    }

    /// Returns a vertex of a draw whose viewport was entered.
    pub(crate) fn get(&mut self, context: &PassContext<'_>, draw: &Draw, i: usize) -> Vertex {
        let position = draw.mesh.vertices[i].position;
        let bits = position.map(f32::to_bits);
        let mut hasher = FxHasher::default();
        bits.hash(&mut hasher);
        // The upper half of such a hash depends on all bits.
        let slot = (hasher.finish() >> 32) as usize & (self.kept.len() - 1);
        match &self.kept[slot] {
            Some((known, vertex)) if *known == bits => *vertex,
            _ => {
                let vertex = vertex(context, draw, position);
                self.kept[slot] = Some((bits, vertex));
                vertex
            }
        }
    }
}

fn vertex(context: &PassContext<'_>, draw: &Draw, position: [f32; 4]) -> Vertex {
    let mut judging = Judging::new(context.rules);
    let window = window_position(&mut judging, position, &draw.viewport);
    let clip = judging.constant(position[2] / position[3]);
    let limits = context.limits;
    let grid = f64::from(1_u32 << limits.sub_pixel_bits);
    let step = units_per_texel(limits) >> limits.sub_pixel_bits;
    let snap = |range: Range| -> (i64, i64) {
        let Interval { low, high } = range.hull();
        let (low, high) = match context.rules.snap.value() {
            Snap::EitherSide => (floor(low * grid), ceil(high * grid)),
            Snap::Nearest => (floor(low * grid + 0.5), floor(high * grid + 0.5)),
        };
        (low as i64 * step, high as i64 * step)
    };
    let (x, y) = (snap(window[0]), snap(window[1]));
    Vertex {
        snapped: SnapBox {
            low: Point { x: x.0, y: y.0 },
            high: Point { x: x.1, y: y.1 },
        },
        window_z: window[2].hull(),
        clip_z: clip.hull(),
        id: VertexId::new(position),
    }
}
