//! Bugs of viewports.

use crate::list::{CONFUSION, SMALL, bugs};
use crate::permission::under;
use crate::plant::{Plant, draws, sized};
use crate::tables::ONE_TEXEL;
use etalon_scene::{Draw, PrimitiveTopology};

/// Extends the viewport to the whole attachment, without moving vertices.
fn unclipped(draw: &mut Draw, size: [u32; 2]) {
    let [x, y, w, h] = draw.viewport.rect;
    let [all_w, all_h] = size.map(|s| s as f32);
    draw.viewport.rect = [0.0, 0.0, all_w, all_h];
    for vertex in &mut draw.mesh.vertices {
        let p = &mut vertex.position;
        let across = (p[0] / p[3] + 1.0) * w / 2.0 + x;
        let down = (1.0 - p[1] / p[3]) * h / 2.0 + y;
        p[0] = (across * 2.0 / all_w - 1.0) * p[3];
        p[1] = (1.0 - down * 2.0 / all_h) * p[3];
    }
}

type ViewportBug = fn([f32; 4], [f32; 2]) -> [f32; 4];

fn rects(bug: ViewportBug) -> Plant {
    sized(move |draw, size| draw.viewport.rect = bug(draw.viewport.rect, size.map(|s| s as f32)))
}

fn is_before_the_eye(draw: &Draw) -> bool {
    draw.mesh.vertices.iter().all(|v| v.position[3] > 0.0)
}

bugs! {
    class "viewport", "scissor";
    for (name, about, by) in ONE_TEXEL {
        "one-texel-{name}: Viewports {about}." =>
            draws(move |draw| { for (value, by) in draw.viewport.rect.iter_mut().zip(by) { *value += by as f32; } }),
            source SMALL;
    }
    source "ANGLE: y flip; misread rectangles";
    "ignored: Viewports are the whole attachment." => rects(|_, [w, h]| [0.0, 0.0, w, h]);
    "counted-from-the-bottom: Viewports are counted from the bottom." =>
        rects(|[x, y, w, h], [_, height]| [x, height - y - h, w, h]);
    "counted-from-the-right: Viewports are counted from the right." =>
        rects(|[x, y, w, h], [width, _]| [width - x - w, y, w, h]);
    "transposed: Columns and rows are exchanged." => rects(|[x, y, w, h], _| [y, x, h, w]);
    "from-the-origin: Viewports begin at the origin." => rects(|[_, _, w, h], _| [0.0, 0.0, w, h]);
    "held-inside: Viewports are moved to begin inside." => rects(|[x, y, w, h], _| [x.max(0.0), y.max(0.0), w, h]);
    "cut-to-the-attachment: Viewports are cut to the attachment." =>
        rects(|r, size| {
            let [x, y, w, h] = r;
            let (left, top) = (x.max(0.0), y.max(0.0));
            [left, top, (x + w).min(size[0]) - left, (y + h).min(size[1]) - top]
        });
    source CONFUSION;
    "not-clipping: Primitives are not clipped to the viewport." =>
        sized(unclipped), source "a guard band without clipping";
    "points-not-clipped: Points beside the viewport are drawn." =>
        sized(|draw, size| if draw.topology == PrimitiveTopology::PointList { unclipped(draw, size) }),
        source "a guard band without clipping", permitted vec![under!(clips_points_at_sides: false)];
    "lines-not-clipped: Lines beside the viewport are drawn." =>
        sized(|draw, size| if draw.topology == PrimitiveTopology::LineList && is_before_the_eye(draw) { unclipped(draw, size) }),
        source "a guard band without clipping", permitted vec![under!(clips_lines_at_sides: false)];
    "as-scissor: The scissor rectangle is the viewport's." =>
        draws(|draw| {
            let [x, y, w, h] = draw.viewport.rect.map(|v| v.max(0.0) as u32);
            draw.scissor = Some([x, y, w, h]);
        }), when |draw| draw.scissor.is_some();
}
