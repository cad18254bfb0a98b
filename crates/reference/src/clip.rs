//! Clipping by a viewport's edges, which legal snapping leaves partly open.

use crate::context::PassContext;
use crate::possible::Possible;
use crate::primitive::{Shape, SnappedPrimitive};
use crate::rules::Rules;
use crate::snap::{SnapBox, SubTexels, coarsest_step, units_per_texel};
use crate::viewport_bounds;
use etalon_pipeline::Point;
use etalon_scene::Viewport;

/// The edges of a draw's viewport. They are clip planes and may be snapped. Points and lines are clipped
/// before they get a width (Vulkan, Primitive Clipping; OpenGL 4.6, 13.7): the remaining part can reach one
/// texel beyond an edge, and the texels at a clipped end, or an outside point, can be missing. If the rules
/// permit unclipped points or lines, these can reach any texel beyond the edge.
#[derive(Clone, Debug)]
pub(crate) struct Clip {
    /// Left, top, width and height in sub-texel units.
    rect: [f64; 4],
    /// The distance in sub-texel units by which rounding the viewport can move an edge.
    moved: f64,
    /// The samples that are inside wherever edges are snapped, on any adapter's grid.
    inside: SnapBox,
}

impl Clip {
    pub(crate) fn new(context: &PassContext<'_>, viewport: &Viewport) -> Self {
        let units = units_per_texel(context.limits) as f64;
        let rect = viewport.area().map(|v| f64::from(v) * units);
        let moved = viewport_bounds::slack(viewport, context.rules) * units;
        let slack = coarsest_step(context.limits) as f64 + rounding(context.rules, units) + moved;
        Self {
            rect,
            moved,
            inside: within(rect, -slack),
        }
    }

    /// Returns true if all vertices of a primitive are inside the edges.
    pub(crate) fn holds_all_of(&self, primitive: &SnappedPrimitive) -> bool {
        primitive.inside_rect(self.rect)
    }

    /// Returns whether a sample that a primitive may cover is inside, from the box in which it lies.
    pub(crate) fn holds(
        &self,
        primitive: &SnappedPrimitive,
        sample: SnapBox,
        rules: &Rules,
        units: i64,
    ) -> Possible {
        let clips = match primitive.shape {
            Shape::Triangle(_) if self.inside.holds(sample) => return Possible::Always,
            Shape::Triangle(_) => true,
            Shape::Point {
                is_inside: true, ..
            }
            | Shape::Line(_)
            | Shape::Outline(_)
                if primitive.inside_rect(self.rect) =>
            {
                return Possible::Always;
            }
            Shape::Point { .. } => rules.clips_points_at_sides.value(),
            Shape::Line(_) => rules.clips_lines_at_sides.value(),
            Shape::Outline(_) => true,
        };
        let bits = &rules.sub_pixel_bits;
        let step = SubTexels { units, bits }.step() as f64;
        let units = units as f64;
        // The distance from an edge at which a vertex is certainly outside.
        let slack = step + rounding(rules, units) + self.moved;
        let wide = match primitive.shape {
            Shape::Triangle(_) => 0.0,
            _ => units,
        };
        let reach = slack + wide;
        let discarded = clips && primitive.beyond_rect(self.rect, slack);
        let can = !discarded && (!clips || within(self.rect, reach).meets(sample));
        let must = !discarded && within(self.rect, -reach).holds(sample);
        Possible::of(can, must)
    }
}

/// Returns the error of an edge through rounding.
fn rounding(rules: &Rules, units: f64) -> f64 {
    units * rules.float_error.value() * 16.0
}

/// Returns the integer points strictly between edges that are moved outwards.
fn within(rect: [f64; 4], outwards: f64) -> SnapBox {
    // The casts saturate.
    let first = |axis: usize| ((rect[axis] - outwards).floor() as i64).saturating_add(1);
    let end = |axis: usize| rect[axis] + rect[axis + 2] + outwards;
    let last = |axis: usize| (end(axis).ceil() as i64).saturating_sub(1);
    SnapBox {
        low: Point {
            x: first(0),
            y: first(1),
        },
        high: Point {
            x: last(0),
            y: last(1),
        },
    }
}
