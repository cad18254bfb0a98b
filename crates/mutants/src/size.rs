//! Bugs that only large pictures and many primitives, draws or vertices meet.
//!
//! Each has a condition that no case of 16 by 16 texels fulfils: a tile, a batch or a counter that ends.

mod clears;
mod vertices;

use crate::hooks::covered;
use crate::list::List;
use crate::plant::{Plant, draws, from_draw, passes, sized};
use etalon_scene::{CompareFunction, Draw, PrimitiveTopology, Shader};

pub(super) fn add(list: &mut List) {
    list.class("size", "size");
    texels(list);
    tiles(list);
    primitives(list);
    calls(list);
    vertices::add(list);
    list.class("hierarchy", "size");
    hierarchy(list);
    clears::add(list);
}

fn texels(list: &mut List) {
    list.bug("first-64x64-only: Nothing is drawn but the first 64 by 64 texels.")
        .plant(covered(|[x, y], _| x < 64 && y < 64));
    for n in [128, 256, 1024, 2048] {
        list.bug(format!(
            "past-{n}-columns: Nothing is drawn in columns from {n} on."
        ))
        .plant(covered(move |[x, _], _| x < n));
    }
    for n in [128, 512, 2048] {
        list.bug(format!(
            "past-{n}-rows: Nothing is drawn in rows from {n} on."
        ))
        .plant(covered(move |[_, y], _| y < n));
    }
    list.bug("last-odd-row: The last row of an odd number above 16 is not drawn.")
        .plant(covered(|[_, y], [_, h]| h <= 16 || h % 2 == 0 || y + 1 < h));
    list.bug("last-odd-column: The last column of an odd number above 16 is not drawn.")
        .plant(covered(|[x, _], [w, _]| w <= 16 || w % 2 == 0 || x + 1 < w));
    list.bug("last-texel: The last texel of more than 16 by 16 is not drawn.")
        .plant(covered(|[x, y], [w, h]| {
            w * h <= 256 || x + 1 < w || y + 1 < h
        }));
    list.bug("large-corner: The last 256 by 256 texels of more than 512 by 512 are not drawn.")
        .plant(covered(|[x, y], [w, h]| {
            w.min(h) < 512 || x + 256 < w || y + 256 < h
        }));
    list.bug("thin-from-256: Attachments of one row or column are drawn up to texel 255.")
        .plant(covered(|[x, y], [w, h]| w.min(h) > 1 || x.max(y) < 256));
}

fn tiles(list: &mut List) {
    for side in [8, 16, 32, 64] {
        // True of what lies in whole tiles, or in a first tile that the attachment cuts.
        let whole = move |texel: u32, length: u32| length < side || texel < length / side * side;
        list.bug(format!(
            "cut-columns-{side}: Columns past the last whole tile of {side} are not drawn."
        ))
        .plant(covered(move |[x, _], [w, _]| whole(x, w)));
        list.bug(format!(
            "cut-rows-{side}: Rows past the last whole tile of {side} are not drawn."
        ))
        .plant(covered(move |[_, y], [_, h]| whole(y, h)));
        list.bug(format!(
            "one-tile-{side}: The second tile of {side} in the second row is not drawn."
        ))
        .plant(covered(move |texel, _| texel.map(|v| v / side) != [1, 1]));
        list.bug(format!(
            "tile-border-{side}: The column before the third tile of {side} is not drawn."
        ))
        .plant(covered(move |[x, _], _| x != 2 * side - 1));
    }
}

/// Draws each primitive of long lists as often as is told by its number.
fn times(bug: impl Fn(usize) -> usize + Send + Sync + 'static) -> Plant {
    draws(move |draw| {
        let size = match draw.topology {
            PrimitiveTopology::PointList => 1,
            PrimitiveTopology::LineList => 2,
            PrimitiveTopology::TriangleList => 3,
            _ => return,
        };
        let mesh = &mut draw.mesh;
        let unindexed = || (0..mesh.vertices.len() as u32).collect();
        let order: Vec<u32> = mesh.indices.clone().unwrap_or_else(unindexed);
        if order.len() / size >= 200 {
            let primitives = order.chunks_exact(size).enumerate();
            let drawn =
                primitives.flat_map(|(i, primitive)| std::iter::repeat_n(primitive, bug(i)));
            mesh.indices = Some(drawn.flatten().copied().collect());
        }
    })
}

fn primitives(list: &mut List) {
    let numbers = [
        255, 256, 299, 1023, 1024, 4095, 4096, 4999, 21_843, 65_535, 65_536,
    ];
    for number in numbers {
        list.bug(format!(
            "primitive-{number}-lost: Primitive {number}, counted from 0, is lost."
        ))
        .plant(times(move |i| usize::from(i != number)));
    }
    for batch in [256, 1024, 4096, 65_536] {
        list.bug(format!(
            "batch-{batch}-lost: Primitives from number {batch} on are lost."
        ))
        .plant(times(move |i| usize::from(i < batch)));
    }
    for batch in [256, 1000, 4096] {
        list.bug(format!(
            "batch-{batch}-doubled: Each {batch}th primitive but the first is drawn twice."
        ))
        .plant(times(move |i| 1 + usize::from(i > 0 && i % batch == 0)));
    }
}

/// Changes the draws of passes that have many.
fn many(bug: impl Fn(&mut Vec<Draw>) + Send + Sync + 'static) -> Plant {
    passes(move |_, _, pass| {
        if pass.draws.len() >= 64 {
            bug(&mut pass.draws);
        }
    })
}

fn calls(list: &mut List) {
    for number in [63, 255, 256, 512, 999] {
        list.bug(format!(
            "draw-{number}-lost: Draw {number} of a pass, counted from 0, is lost."
        ))
        .plant(many(move |draws| {
            if draws.len() > number {
                draws.remove(number);
            }
        }));
    }
    list.bug("draws-from-512-lost: Draws of a pass from number 512 on are lost.")
        .plant(many(|draws| draws.truncate(512)));
    list.bug("draw-256-doubled: The last of a batch of 256 draws is executed again.")
        .plant(many(|draws| {
            if draws.len() > 256 {
                draws.insert(256, draws[255].clone());
            }
        }));
    type Take = fn(&Draw, &mut Draw);
    let kept: [(&str, Take); 4] = [
        ("params", |before, draw| draw.params = before.params),
        ("scissor", |before, draw| draw.scissor = before.scissor),
        ("viewport", |before, draw| draw.viewport = before.viewport),
        ("mesh", |before, draw| draw.mesh = before.mesh.clone()),
    ];
    for (name, take) in kept {
        list.bug(format!(
            "{name}-kept: Each 64th draw of a pass takes the {name} of the one before."
        ))
        .plant(many(move |draws| {
            for number in (64..draws.len()).step_by(64) {
                let before = draws[number - 1].clone();
                take(&before, &mut draws[number]);
            }
        }));
    }
}

/// True if a comparison lets smaller depths pass, and not greater ones.
fn nearer(compare: CompareFunction) -> Option<bool> {
    match compare {
        CompareFunction::Less | CompareFunction::LessEqual => Some(true),
        CompareFunction::Greater | CompareFunction::GreaterEqual => Some(false),
        _ => None,
    }
}

/// Changes large draws that test depth.
fn tests(bug: impl Fn(&mut Draw) + Send + Sync + 'static) -> Plant {
    sized(move |draw, [w, h]| {
        if w.max(h) > 64 && draw.depth.is_some() {
            bug(draw);
        }
    })
}

fn hierarchy(list: &mut List) {
    list.bug("direction-kept: A comparison of the other direction acts as the one before.")
        .plant(from_draw(|before, draw| {
            if let (Some(before), Some(depth)) = (before.depth, &mut draw.depth)
                && let (Some(a), Some(b)) = (nearer(before.compare), nearer(depth.compare))
                && a != b
            {
                depth.compare = before.compare;
            }
        }));
    list.bug("not-equal-as-less: Bounds kept for smaller depths reject what is not equal.")
        .plant(tests(|draw| {
            if let Some(depth) = &mut draw.depth
                && depth.compare == CompareFunction::NotEqual
            {
                depth.compare = CompareFunction::Less;
            }
        }));
    list.bug("single-texels-unwritten: A draw of points does not write their depths.")
        .plant(tests(|draw| {
            let points = draw.topology == PrimitiveTopology::PointList;
            if let Some(depth) = draw.depth.as_mut().filter(|_| points) {
                depth.write = false;
            }
        }));
    for (name, about, right, wrong) in [
        (
            "discarded-written",
            "A block has depths written whose fragments are discarded.",
            Shader::TexelDiscard,
            Shader::TexelColor,
        ),
        (
            "plane-for-written",
            "The plane's depth is tested where the shader writes another.",
            Shader::FlatColorDepth,
            Shader::UniformColor,
        ),
    ] {
        list.bug(format!("{name}: {about}"))
            .plant(tests(move |draw| {
                if draw.shader == right {
                    draw.shader = wrong;
                }
            }));
    }
    list.bug("stencil-only-skipped: A draw without colour and depth writes no stencil.")
        .plant(tests(|draw| {
            let colorless = draw.targets.iter().all(|t| t.write_mask == 0);
            draw.rasterizer_discard |= colorless && !draw.depth.is_some_and(|d| d.write);
        }));
}
