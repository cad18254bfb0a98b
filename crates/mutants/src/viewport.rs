//! Bugs of viewports.

use super::list::{CONFUSION, List, Row, SMALL};
use super::plant::{Plant, draws, sized};

pub(super) fn add(list: &mut List) {
    list.class("viewport", "scissor");
    viewports(list);
}

fn viewports(list: &mut List) {
    type Bug = fn([f32; 4], [f32; 2]) -> [f32; 4];
    fn rects(bug: Bug) -> Plant {
        sized(move |draw, size| {
            draw.viewport.rect = bug(draw.viewport.rect, size.map(|s| s as f32));
        })
    }
    let small: [Row<Bug>; 8] = [
        (
            "one-texel-right",
            "Viewports lie one texel too far right.",
            |[x, y, w, h], _| [x + 1.0, y, w, h],
        ),
        (
            "one-texel-left",
            "Viewports lie one texel too far left.",
            |[x, y, w, h], _| [x - 1.0, y, w, h],
        ),
        (
            "one-texel-down",
            "Viewports lie one texel too far down.",
            |[x, y, w, h], _| [x, y + 1.0, w, h],
        ),
        (
            "one-texel-up",
            "Viewports lie one texel too far up.",
            |[x, y, w, h], _| [x, y - 1.0, w, h],
        ),
        (
            "one-texel-wider",
            "Viewports are one texel too wide.",
            |[x, y, w, h], _| [x, y, w + 1.0, h],
        ),
        (
            "one-texel-narrower",
            "Viewports are one texel too narrow.",
            |[x, y, w, h], _| [x, y, w - 1.0, h],
        ),
        (
            "one-texel-higher",
            "Viewports are one texel too high.",
            |[x, y, w, h], _| [x, y, w, h + 1.0],
        ),
        (
            "one-texel-lower",
            "Viewports are one texel too low.",
            |[x, y, w, h], _| [x, y, w, h - 1.0],
        ),
    ];
    list.rows(SMALL, rects, &small);
    let confused: [Row<Bug>; 7] = [
        (
            "ignored",
            "Viewports are the whole attachment.",
            |_, [w, h]| [0.0, 0.0, w, h],
        ),
        (
            "counted-from-the-bottom",
            "Viewports are counted from the bottom.",
            |r, size| {
                let [x, y, w, h] = r;
                [x, size[1] - y - h, w, h]
            },
        ),
        (
            "counted-from-the-right",
            "Viewports are counted from the right.",
            |r, size| {
                let [x, y, w, h] = r;
                [size[0] - x - w, y, w, h]
            },
        ),
        (
            "transposed",
            "Columns and rows are exchanged.",
            |[x, y, w, h], _| [y, x, h, w],
        ),
        (
            "from-the-origin",
            "Viewports begin at the origin.",
            |[_, _, w, h], _| [0.0, 0.0, w, h],
        ),
        (
            "held-inside",
            "Viewports are moved to begin inside.",
            |[x, y, w, h], _| [x.max(0.0), y.max(0.0), w, h],
        ),
        (
            "cut-to-the-attachment",
            "Viewports are cut to the attachment.",
            |r, size| {
                let [x, y, w, h] = r;
                let (left, top) = (x.max(0.0), y.max(0.0));
                [
                    left,
                    top,
                    (x + w).min(size[0]) - left,
                    (y + h).min(size[1]) - top,
                ]
            },
        ),
    ];
    list.rows("ANGLE: y flip; misread rectangles", rects, &confused);
    list.add(
        "not-clipping",
        "a guard band without clipping",
        "Primitives are not clipped to the viewport.",
        sized(|draw, size| {
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
        }),
    );
    list.add(
        "as-scissor",
        CONFUSION,
        "The scissor rectangle is the viewport's.",
        draws(|draw| {
            if draw.scissor.is_some() {
                let [x, y, w, h] = draw.viewport.rect.map(|v| v.max(0.0) as u32);
                draw.scissor = Some([x, y, w, h]);
            }
        }),
    );
}
