//! Bugs that only large pictures or many primitives, draws or vertices show.
//!
//! Each bug has a condition that no case of 16 by 16 texels meets: the end of a tile, a batch or a counter.

mod clears;
mod vertices;

use crate::fields::Take;
use crate::hooks::covered;
use crate::list::bugs;
use crate::plant::{Plant, calls, draws, from_draw, sized};
use etalon_scene::{CompareFunction, Draw, PrimitiveTopology, Shader};

/// Repeats each primitive of long lists; `bug` returns the number of times, given the primitive's index.
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

/// Returns true if a comparison passes smaller depths but not greater ones, and false for the reverse;
/// `None` otherwise.
fn nearer(compare: CompareFunction) -> Option<bool> {
    match compare {
        CompareFunction::Less | CompareFunction::LessEqual => Some(true),
        CompareFunction::Greater | CompareFunction::GreaterEqual => Some(false),
        _ => None,
    }
}

/// Changes draws with a depth test to large attachments.
fn tests(bug: impl Fn(&mut Draw) + Send + Sync + 'static) -> Plant {
    sized(move |draw, [w, h]| {
        if w.max(h) > 64 && draw.depth.is_some() {
            bug(draw);
        }
    })
}

bugs! {
    class "size", "size";
    "first-64x64-only: Nothing is drawn but the first 64 by 64 texels." => covered(|[x, y], _| x < 64 && y < 64);
    for n in [128, 256, 1024, 2048] {
        "past-{n}-columns: Nothing is drawn in columns from {n} on." => covered(move |[x, _], _| x < n);
    }
    for n in [128, 512, 2048] {
        "past-{n}-rows: Nothing is drawn in rows from {n} on." => covered(move |[_, y], _| y < n);
    }
    "last-odd-row: The last row of an odd number above 16 is not drawn." =>
        covered(|[_, y], [_, h]| h <= 16 || h % 2 == 0 || y + 1 < h);
    "last-odd-column: The last column of an odd number above 16 is not drawn." =>
        covered(|[x, _], [w, _]| w <= 16 || w % 2 == 0 || x + 1 < w);
    "last-texel: The last texel of more than 16 by 16 is not drawn." =>
        covered(|[x, y], [w, h]| w * h <= 256 || x + 1 < w || y + 1 < h);
    "large-corner: The last 256 by 256 texels of more than 512 by 512 are not drawn." =>
        covered(|[x, y], [w, h]| w.min(h) < 512 || x + 256 < w || y + 256 < h);
    "thin-from-256: Attachments of one row or column are drawn up to texel 255." =>
        covered(|[x, y], [w, h]| w.min(h) > 1 || x.max(y) < 256);
    for side in [8, 16, 32, 64] {
        // True in whole tiles, and in a first tile that the attachment cuts.
        let in_whole_tile = move |texel: u32, length: u32| length < side || texel < length / side * side;
        "cut-columns-{side}: Columns past the last whole tile of {side} are not drawn." =>
            covered(move |[x, _], [w, _]| in_whole_tile(x, w));
        "cut-rows-{side}: Rows past the last whole tile of {side} are not drawn." =>
            covered(move |[_, y], [_, h]| in_whole_tile(y, h));
        "one-tile-{side}: The second tile of {side} in the second row is not drawn." =>
            covered(move |texel, _| texel.map(|v| v / side) != [1, 1]);
        "tile-border-{side}: The column before the third tile of {side} is not drawn." =>
            covered(move |[x, _], _| x != 2 * side - 1);
    }
    let numbers = [255, 256, 299, 1023, 1024, 4095, 4096, 4999, 21_843, 65_535, 65_536];
    for number in numbers {
        "primitive-{number}-lost: Primitive {number}, counted from 0, is lost." =>
            times(move |i| usize::from(i != number));
    }
    for batch in [256, 1024, 4096, 65_536] {
        "batch-{batch}-lost: Primitives from number {batch} on are lost." => times(move |i| usize::from(i < batch));
    }
    for batch in [256, 1000, 4096] {
        "batch-{batch}-doubled: Each {batch}th primitive but the first is drawn twice." =>
            times(move |i| 1 + usize::from(i > 0 && i % batch == 0));
    }
    for number in [63, 255, 256, 512, 999] {
        "draw-{number}-lost: Draw {number} of a pass, counted from 0, is lost." =>
            calls(move |draws| { if draws.len() > number { draws.remove(number); } });
    }
    "draws-from-512-lost: Draws of a pass from number 512 on are lost." => calls(|draws| draws.truncate(512));
    "draw-256-doubled: The last of a batch of 256 draws is executed again." =>
        calls(|draws| if draws.len() > 256 { draws.insert(256, draws[255].clone()) });
    for (name, take as Take) in [
        ("params", |before, draw| draw.params = before.params),
        ("scissor", |before, draw| draw.scissor = before.scissor),
        ("viewport", |before, draw| draw.viewport = before.viewport),
        ("mesh", |before, draw| draw.mesh = before.mesh.clone()),
    ] {
        "{name}-kept: Each 64th draw of a pass takes the {name} of the one before." =>
            calls(move |draws| {
                for number in (64..draws.len()).step_by(64) {
                    let before = draws[number - 1].clone();
                    take(&before, &mut draws[number]);
                }
            });
    }
    also vertices::add;
    class "hierarchy", "size";
    "direction-kept: A comparison of the other direction acts as the one before." =>
        from_draw(|before, draw| {
            if let (Some(before), Some(depth)) = (before.depth, &mut draw.depth)
                && let (Some(a), Some(b)) = (nearer(before.compare), nearer(depth.compare)) && a != b
            {
                depth.compare = before.compare;
            }
        });
    "not-equal-as-less: Bounds kept for smaller depths reject what is not equal." =>
        tests(|draw| {
            let tests = draw.depth.iter_mut().filter(|d| d.compare == CompareFunction::NotEqual);
            tests.for_each(|depth| depth.compare = CompareFunction::Less);
        });
    "single-texels-unwritten: A draw of points does not write their depths." =>
        tests(|draw| {
            let points = draw.topology == PrimitiveTopology::PointList;
            if let Some(depth) = draw.depth.as_mut().filter(|_| points) { depth.write = false; }
        });
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
        "{name}: {about}" => tests(move |draw| if draw.shader == right { draw.shader = wrong });
    }
    "stencil-only-skipped: A draw without colour and depth writes no stencil." =>
        tests(|draw| {
            let colorless = draw.targets.iter().all(|t| t.write_mask == 0);
            draw.rasterizer_discard |= colorless && !draw.depth.is_some_and(|d| d.write);
        });
    also clears::add;
}
