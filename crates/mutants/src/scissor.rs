//! Bugs of scissor rectangles.

use super::list::{CONFUSION, List, Row, SMALL};
use super::plant::{Plant, scene, sized};
use etalon_scene::{
    CompareFunction, Contents, DepthState, Draw, Pass, Scene, StencilFace, StencilOperation,
};

pub(super) fn add(list: &mut List) {
    list.class("scissor", "scissor");
    rects(list);
    kinds(list);
    clears(list);
}

/// Changes scissor rectangles, given the size of the attachments.
fn scissors(bug: fn([u32; 4], [u32; 2]) -> Option<[u32; 4]>) -> Plant {
    sized(move |draw, size| draw.scissor = draw.scissor.and_then(|rect| bug(rect, size)))
}

fn rects(list: &mut List) {
    type Bug = fn([u32; 4], [u32; 2]) -> Option<[u32; 4]>;
    let small: [Row<Bug>; 8] = [
        (
            "one-texel-right",
            "Rectangles lie one texel too far right.",
            |[x, y, w, h], _| Some([x + 1, y, w, h]),
        ),
        (
            "one-texel-left",
            "Rectangles lie one texel too far left.",
            |[x, y, w, h], _| Some([x.saturating_sub(1), y, w, h]),
        ),
        (
            "one-texel-down",
            "Rectangles lie one texel too far down.",
            |[x, y, w, h], _| Some([x, y + 1, w, h]),
        ),
        (
            "one-texel-up",
            "Rectangles lie one texel too far up.",
            |[x, y, w, h], _| Some([x, y.saturating_sub(1), w, h]),
        ),
        (
            "one-texel-wider",
            "Rectangles are one texel too wide.",
            |[x, y, w, h], _| Some([x, y, w + 1, h]),
        ),
        (
            "one-texel-narrower",
            "Rectangles are one texel too narrow.",
            |[x, y, w, h], _| Some([x, y, w.saturating_sub(1), h]),
        ),
        (
            "one-texel-higher",
            "Rectangles are one texel too high.",
            |[x, y, w, h], _| Some([x, y, w, h + 1]),
        ),
        (
            "one-texel-lower",
            "Rectangles are one texel too low.",
            |[x, y, w, h], _| Some([x, y, w, h.saturating_sub(1)]),
        ),
    ];
    list.rows(SMALL, scissors, &small);
    let confused: [Row<Bug>; 9] = [
        ("ignored", "There is no scissor test.", |_, _| None),
        (
            "empty-as-all",
            "An empty rectangle counts as no scissor test.",
            |rect, _| (rect[2] > 0 && rect[3] > 0).then_some(rect),
        ),
        (
            "empty-as-one-texel",
            "An empty rectangle holds one texel.",
            |[x, y, w, h], _| Some([x, y, w.max(1), h.max(1)]),
        ),
        (
            "upside-down",
            "Rectangles are counted from the bottom.",
            |[x, y, w, h], [_, all]| Some([x, all.saturating_sub(y.saturating_add(h)), w, h]),
        ),
        (
            "mirrored",
            "Rectangles are counted from the right.",
            |[x, y, w, h], [all, _]| Some([all.saturating_sub(x.saturating_add(w)), y, w, h]),
        ),
        (
            "transposed",
            "Columns and rows are exchanged.",
            |[x, y, w, h], _| Some([y, x, h, w]),
        ),
        (
            "size-as-end",
            "Width and height are read as the last column and row.",
            |r, _| {
                let [x, y, w, h] = r;
                Some([x, y, w.saturating_sub(x), h.saturating_sub(y)])
            },
        ),
        (
            "from-the-origin",
            "Rectangles begin at the origin.",
            |[_, _, w, h], _| Some([0, 0, w, h]),
        ),
        (
            "lost-when-partly-outside",
            "Rectangles that reach outside count as no scissor test.",
            |r, s| {
                let [x, y, w, h] = r;
                (x + w <= s[0] && y + h <= s[1]).then_some(r)
            },
        ),
    ];
    list.rows("ANGLE: y flip; misread rectangles", scissors, &confused);
    list.add(
        "kept-where-none-is-set",
        CONFUSION,
        "Without a rectangle, the last one stays.",
        scene(|scene| {
            let mut last = None;
            for draw in scene.passes.iter_mut().flat_map(|p| &mut p.draws) {
                draw.scissor = draw.scissor.or(last);
                last = draw.scissor;
            }
        }),
    );
}

/// The up to four rectangles around another.
fn around([x, y, w, h]: [u32; 4], size: [u32; 2]) -> Vec<[u32; 4]> {
    let (left, top) = (x.min(size[0]), y.min(size[1]));
    let (right, bottom) = ((x + w).min(size[0]), (y + h).min(size[1]));
    if left >= right || top >= bottom {
        return vec![[0, 0, size[0], size[1]]];
    }
    vec![
        [0, 0, size[0], top],
        [0, bottom, size[0], size[1] - bottom],
        [0, top, left, bottom - top],
        [right, top, size[0] - right, bottom - top],
    ]
}

/// Masks all colours.
fn without_color(draw: &mut Draw) {
    draw.targets.iter_mut().for_each(|t| t.write_mask = 0);
}

fn without_depth(draw: &mut Draw) {
    if let Some(depth) = &mut draw.depth {
        depth.write = false;
    }
}

fn without_stencil(draw: &mut Draw) {
    if let Some(stencil) = &mut draw.stencil {
        stencil.front.write_mask = 0;
        stencil.back.write_mask = 0;
    }
}

/// The scissor test is not done for one kind of attachment: the draw is repeated around the
/// rectangle with the writes of the other two kinds masked.
fn kinds(list: &mut List) {
    type Others = [fn(&mut Draw); 2];
    fn beyond(others: Others) -> Plant {
        scene(move |scene| {
            for at in 0..scene.passes.len() {
                let size = scene.pass_size(&scene.passes[at]);
                let draws = std::mem::take(&mut scene.passes[at].draws);
                for draw in draws {
                    let rects = draw.scissor.map_or(Vec::new(), |r| around(r, size));
                    let copies = rects.into_iter().map(|rect| {
                        let mut copy = draw.clone();
                        copy.scissor = Some(rect);
                        others.iter().for_each(|hold| hold(&mut copy));
                        copy
                    });
                    let copies: Vec<Draw> = copies.collect();
                    scene.passes[at].draws.push(draw);
                    scene.passes[at].draws.extend(copies);
                }
            }
        })
    }
    let rows: [Row<Others>; 3] = [
        (
            "ignored-for-color",
            "Colour is written outside the rectangle.",
            [without_depth, without_stencil],
        ),
        (
            "ignored-for-depth",
            "Depth is written outside the rectangle.",
            [without_color, without_stencil],
        ),
        (
            "ignored-for-stencil",
            "Stencil is written outside the rectangle.",
            [without_color, without_depth],
        ),
    ];
    list.rows(CONFUSION, beyond, &rows);
}

/// The first draw's scissor rectangle applies to the clears before it: outside of it, attachments
/// start from 0.
fn clears(list: &mut List) {
    list.add(
        "clears-color",
        "clears that obey the scissor test",
        "The first draw's rectangle also holds back the clear of colour.",
        scene(|scene| {
            let Some((rect, size)) = first_rect(scene) else {
                return;
            };
            let first = &scene.passes[0];
            for index in first.color.clone() {
                let attachment = &mut scene.attachments[index];
                let Contents::Color(color) = attachment.contents else {
                    continue;
                };
                if attachment.samples > 1 {
                    continue;
                }
                let channels = attachment.format.color_channels();
                let codes: Vec<u32> = (channels.iter().zip(color))
                    .map(|(e, v)| e.nearest_code(f64::from(v)))
                    .collect();
                let inside = |at: u32| {
                    let (x, y) = (at % size[0], at / size[0]);
                    (rect[0]..rect[0] + rect[2]).contains(&x)
                        && (rect[1]..rect[1] + rect[3]).contains(&y)
                };
                let texels = (0..size[0] * size[1]).flat_map(|at| {
                    let share = u32::from(inside(at));
                    codes.iter().map(move |c| c * share)
                });
                attachment.contents = Contents::Texels(texels.collect());
            }
        }),
    );
    list.add(
        "clears-depth-and-stencil",
        "clears that obey the scissor test",
        "The first draw's rectangle also holds back the clear of depth and stencil.",
        scene(|scene| {
            let Some((rect, size)) = first_rect(scene) else {
                return;
            };
            let pass = &mut scene.passes[0];
            let fillers: Vec<Draw> = around(rect, size)
                .into_iter()
                .filter_map(|rect| filler(pass, rect))
                .collect();
            pass.draws.splice(0..0, fillers);
        }),
    );
}

fn first_rect(scene: &Scene) -> Option<([u32; 4], [u32; 2])> {
    let pass = scene.passes.first()?;
    let rect = pass.draws.first()?.scissor?;
    Some((rect, scene.pass_size(pass)))
}

/// A draw that fills a rectangle with depth 0 and stencil 0.
fn filler(pass: &Pass, rect: [u32; 4]) -> Option<Draw> {
    let mut draw = pass.draws.first()?.clone();
    draw.scissor = Some(rect);
    draw.viewport.depth = [0.0, 0.0];
    draw.viewport.rect = [-64.0, -64.0, 256.0, 256.0];
    without_color(&mut draw);
    let face = StencilFace {
        compare: CompareFunction::Always,
        fail_op: StencilOperation::Zero,
        depth_fail_op: StencilOperation::Zero,
        pass_op: StencilOperation::Zero,
        read_mask: 0xff,
        write_mask: 0xff,
        reference: 0,
    };
    if let Some(stencil) = &mut draw.stencil {
        stencil.front = face;
        stencil.back = face;
    }
    draw.depth = Some(DepthState {
        compare: CompareFunction::Always,
        write: true,
    });
    Some(draw)
}
