//! Edges of scissor rectangles and viewports that are one texel off where a tile ends.

use super::super::list::{CONFUSION, List};
use super::super::plant::sized;
use super::tiles::TILES;

/// The names of the edges, with the axis, and true for the far one.
const EDGES: [(&str, usize, bool); 4] = [
    ("left", 0, false),
    ("top", 1, false),
    ("right", 0, true),
    ("bottom", 1, true),
];

pub(super) fn add(list: &mut List) {
    for n in TILES {
        for (edge, axis, far) in EDGES {
            list.add(
                &format!("scissor-{edge}-at-{n}"),
                CONFUSION,
                format!(
                    "The {edge} edge of a scissor rectangle at a multiple of {n} is one texel inside."
                ),
                sized(move |draw, size| {
                    let Some(rect) = &mut draw.scissor else { return };
                    let (start, length) = (rect[axis], rect[axis + 2]);
                    let end = start.saturating_add(length);
                    if far && end % n == 0 && end < size[axis] {
                        rect[axis + 2] = length.saturating_sub(1);
                    } else if !far && start % n == 0 && start > 0 && length > 0 {
                        rect[axis] = start + 1;
                        rect[axis + 2] = length - 1;
                    }
                }),
            );
        }
    }
    for n in [16, 64] {
        for (edge, axis, far) in EDGES {
            if far {
                list.add(
                    &format!("scissor-{edge}-grown-at-{n}"),
                    CONFUSION,
                    format!(
                        "The {edge} edge of a scissor rectangle at a multiple of {n} is one texel \
                         outside."
                    ),
                    sized(move |draw, size| {
                        let Some(rect) = &mut draw.scissor else {
                            return;
                        };
                        let end = rect[axis].saturating_add(rect[axis + 2]);
                        if end % n == 0 && end < size[axis] && rect[axis + 2] > 0 {
                            rect[axis + 2] += 1;
                        }
                    }),
                );
            }
            list.add(
                &format!("viewport-{edge}-at-{n}"),
                CONFUSION,
                format!("The {edge} edge of a viewport at a multiple of {n} is one texel inside."),
                sized(move |draw, size| {
                    let rect = &mut draw.viewport.rect;
                    let (start, end) = (rect[axis], rect[axis] + rect[axis + 2]);
                    let inside = |v: f32| v > 0.0 && v < size[axis] as f32 && v % n as f32 == 0.0;
                    if rect[axis + 2] <= 1.0 {
                        return;
                    }
                    if far && inside(end) {
                        rect[axis + 2] -= 1.0;
                    } else if !far && inside(start) {
                        rect[axis] += 1.0;
                        rect[axis + 2] -= 1.0;
                    }
                }),
            );
        }
    }
}
