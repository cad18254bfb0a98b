//! Clipping by a viewport's edges, which legal snapping leaves partly open.

use crate::possible::Possible;
use crate::primitive::{Shape, SnappedPrimitive};
use crate::rules::Rules;
use crate::snap::{SnapBox, units_per_texel};
use etalon_frame::Limits;
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
    /// The distance from an edge at which a vertex is certainly outside.
    slack: f64,
    triangles: Reach,
    wide: Reach,
    points_at_sides: bool,
    lines_at_sides: bool,
}

/// The samples that can be inside, and the samples that must be.
#[derive(Clone, Debug)]
struct Reach {
    can: SnapBox,
    must: SnapBox,
}

impl Clip {
    pub(crate) fn new(rules: &Rules, limits: &Limits, viewport: &Viewport) -> Self {
        let units = units_per_texel(limits) as f64;
        let rect = viewport.area().map(|v| f64::from(v) * units);
        let slack = units / f64::from(1_u32 << limits.sub_pixel_bits)
            + units * rules.float_error.value() * 16.0;
        Self {
            rect,
            slack,
            triangles: Reach::new(rect, slack),
            wide: Reach::new(rect, slack + units),
            points_at_sides: rules.clips_points_at_sides.value(),
            lines_at_sides: rules.clips_lines_at_sides.value(),
        }
    }

    /// Returns true if all vertices of a primitive are inside the edges.
    pub(crate) fn holds_all_of(&self, primitive: &SnappedPrimitive) -> bool {
        primitive.inside_rect(self.rect)
    }

    /// Returns whether a sample is inside.
    pub(crate) fn holds(&self, primitive: &SnappedPrimitive, point: Point) -> Possible {
        let (reach, clips) = match primitive.shape {
            Shape::Triangle(_) => (&self.triangles, true),
            _ if primitive.inside_rect(self.rect) => return Possible::Always,
            Shape::Point(_) => (&self.wide, self.points_at_sides),
            Shape::Line(_) => (&self.wide, self.lines_at_sides),
            Shape::Outline(_) => (&self.wide, true),
        };
        let discarded = clips && primitive.beyond_rect(self.rect, self.slack);
        let can = !discarded && (!clips || reach.can.contains(point));
        Possible::of(can, !discarded && reach.must.contains(point))
    }
}

impl Reach {
    fn new(rect: [f64; 4], slack: f64) -> Self {
        // The integers strictly between the edges. The casts saturate.
        let within = |slack: f64| {
            let first = |axis: usize| ((rect[axis] - slack).floor() as i64).saturating_add(1);
            let end = |axis: usize| rect[axis] + rect[axis + 2] + slack;
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
        };
        Self {
            can: within(slack),
            must: within(-slack),
        }
    }
}
