//! Bugs that only large pictures and many primitives, draws or vertices meet.
//!
//! Each has a condition that no case of 16 by 16 texels fulfils: a tile, a batch or a counter that ends.

mod clears;
mod vertices;

use super::hooks::covered;
use super::list::{CONFUSION, List};
use super::plant::{Plant, draws, from_draw, scene};
use etalon_scene::{CompareFunction, Draw, Mesh, PrimitiveTopology, Scene};

pub(super) fn add(list: &mut List) {
    list.class("size", "size");
    texels(list);
    tiles(list);
    primitives(list);
    passes(list);
    vertices::add(list);
    list.class("hierarchy", "size");
    hierarchy(list);
    clears::add(list);
}

fn texels(list: &mut List) {
    type Drawn = fn([u32; 2], [u32; 2]) -> bool;
    let rows: [(&str, &str, Drawn); 13] = [
        (
            "first-64x64-only",
            "Nothing is drawn but the first 64 by 64 texels.",
            |[x, y], _| x < 64 && y < 64,
        ),
        (
            "past-128-columns",
            "Nothing is drawn in columns from 128 on.",
            |[x, _], _| x < 128,
        ),
        (
            "past-256-columns",
            "Nothing is drawn in columns from 256 on.",
            |[x, _], _| x < 256,
        ),
        (
            "past-1024-columns",
            "Nothing is drawn in columns from 1,024 on.",
            |[x, _], _| x < 1024,
        ),
        (
            "past-2048-columns",
            "Nothing is drawn in columns from 2,048 on.",
            |[x, _], _| x < 2048,
        ),
        (
            "past-128-rows",
            "Nothing is drawn in rows from 128 on.",
            |[_, y], _| y < 128,
        ),
        (
            "past-512-rows",
            "Nothing is drawn in rows from 512 on.",
            |[_, y], _| y < 512,
        ),
        (
            "past-2048-rows",
            "Nothing is drawn in rows from 2,048 on.",
            |[_, y], _| y < 2048,
        ),
        (
            "last-odd-row",
            "The last row of an odd number above 16 is not drawn.",
            |[_, y], [_, h]| h <= 16 || h % 2 == 0 || y + 1 < h,
        ),
        (
            "last-odd-column",
            "The last column of an odd number above 16 is not drawn.",
            |[x, _], [w, _]| w <= 16 || w % 2 == 0 || x + 1 < w,
        ),
        (
            "last-texel",
            "The last texel of more than 16 by 16 is not drawn.",
            |[x, y], [w, h]| w * h <= 256 || x + 1 < w || y + 1 < h,
        ),
        (
            "large-corner",
            "The last 256 by 256 texels of more than 512 by 512 are not drawn.",
            |[x, y], [w, h]| w < 512 || h < 512 || x + 256 < w || y + 256 < h,
        ),
        (
            "thin-from-256",
            "Attachments of one row or column are drawn up to texel 255.",
            |[x, y], [w, h]| w.min(h) > 1 || x.max(y) < 256,
        ),
    ];
    for (name, about, bug) in rows {
        list.add(name, CONFUSION, about, covered(bug));
    }
}

fn tiles(list: &mut List) {
    for side in [8, 16, 32, 64] {
        let of = move |at: [u32; 2]| at.map(|v| v / side);
        list.add(
            &format!("cut-columns-{side}"),
            CONFUSION,
            format!("Columns past the last whole tile of {side} texels are not drawn."),
            covered(move |[x, _], [w, _]| w < side || x < w / side * side),
        );
        list.add(
            &format!("cut-rows-{side}"),
            CONFUSION,
            format!("Rows past the last whole tile of {side} texels are not drawn."),
            covered(move |[_, y], [_, h]| h < side || y < h / side * side),
        );
        list.add(
            &format!("one-tile-{side}"),
            CONFUSION,
            format!("The second tile of {side} by {side} texels in the second row is not drawn."),
            covered(move |at, _| of(at) != [1, 1]),
        );
        list.add(
            &format!("tile-border-{side}"),
            CONFUSION,
            format!("The column before the third tile of {side} texels is not drawn."),
            covered(move |[x, _], _| x != 2 * side - 1),
        );
    }
}

/// The least number of vertices in one primitive of a list.
fn per_primitive(topology: PrimitiveTopology) -> Option<usize> {
    match topology {
        PrimitiveTopology::PointList => Some(1),
        PrimitiveTopology::LineList => Some(2),
        PrimitiveTopology::TriangleList => Some(3),
        _ => None,
    }
}

/// Draws each primitive of long lists as often as is told by its number.
fn times(bug: impl Fn(usize) -> usize + Send + Sync + 'static) -> Plant {
    draws(move |draw| {
        let Some(size) = per_primitive(draw.topology) else {
            return;
        };
        let order: Vec<u32> = match &draw.mesh.indices {
            Some(indices) => indices.clone(),
            None => (0..draw.mesh.vertices.len() as u32).collect(),
        };
        if order.len() / size < 200 {
            return;
        }
        let all = order.chunks_exact(size).enumerate();
        let drawn = all.flat_map(|(i, primitive)| std::iter::repeat_n(primitive, bug(i)));
        draw.mesh = Mesh {
            indices: Some(drawn.flatten().copied().collect()),
            vertices: std::mem::take(&mut draw.mesh.vertices),
        };
    })
}

fn primitives(list: &mut List) {
    for number in [
        255, 256, 299, 1023, 1024, 4095, 4096, 4999, 21_843, 65_535, 65_536,
    ] {
        list.add(
            &format!("primitive-{number}-lost"),
            CONFUSION,
            format!("The primitive of number {number}, counted from 0, is lost."),
            times(move |i| usize::from(i != number)),
        );
    }
    for batch in [256, 1024, 4096, 65_536] {
        list.add(
            &format!("batch-{batch}-lost"),
            CONFUSION,
            format!("Primitives from number {batch} on are lost."),
            times(move |i| usize::from(i < batch)),
        );
    }
    for batch in [256, 1000, 4096] {
        list.add(
            &format!("batch-{batch}-doubled"),
            CONFUSION,
            format!("The first primitive of each batch of {batch} but the first is drawn twice."),
            times(move |i| 1 + usize::from(i > 0 && i % batch == 0)),
        );
    }
}

/// Changes the draws of passes that have many.
fn many(bug: impl Fn(&mut Vec<Draw>) + Send + Sync + 'static) -> Plant {
    scene(move |scene: &mut Scene| {
        for pass in &mut scene.passes {
            if pass.draws.len() >= 64 {
                bug(&mut pass.draws);
            }
        }
    })
}

fn passes(list: &mut List) {
    for number in [63, 255, 256, 512, 999] {
        list.add(
            &format!("draw-{number}-lost"),
            CONFUSION,
            format!("The draw of number {number} of a pass, counted from 0, is lost."),
            many(move |draws| {
                if draws.len() > number {
                    draws.remove(number);
                }
            }),
        );
    }
    list.add(
        "draws-from-512-lost",
        CONFUSION,
        "Draws of a pass from number 512 on are lost.",
        many(|draws| draws.truncate(512)),
    );
    list.add(
        "draw-256-doubled",
        CONFUSION,
        "Where a batch of 256 draws ends, the last of them is executed again.",
        many(|draws| {
            if draws.len() > 256 {
                let again = draws[255].clone();
                draws.insert(256, again);
            }
        }),
    );
    type Bug = fn(&Draw, &mut Draw);
    let kept: [(&str, &str, Bug); 4] = [
        (
            "params-kept",
            "Each 64th draw of a pass takes the parameters of the one before.",
            |before, draw| draw.params = before.params,
        ),
        (
            "scissor-kept",
            "Each 64th draw of a pass takes the scissor rectangle of the one before.",
            |before, draw| draw.scissor = before.scissor,
        ),
        (
            "viewport-kept",
            "Each 64th draw of a pass takes the viewport of the one before.",
            |before, draw| draw.viewport = before.viewport,
        ),
        (
            "mesh-kept",
            "Each 64th draw of a pass takes the vertices of the one before.",
            |before, draw| draw.mesh = before.mesh.clone(),
        ),
    ];
    for (name, about, bug) in kept {
        let plant = many(move |draws| {
            for number in (64..draws.len()).step_by(64) {
                let before = draws[number - 1].clone();
                bug(&before, &mut draws[number]);
            }
        });
        list.add(name, CONFUSION, about, plant);
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

/// Changes the depth test of large draws.
fn tests(bug: impl Fn(&mut Draw) + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        for at in 0..scene.passes.len() {
            let [w, h] = scene.pass_size(&scene.passes[at]);
            if w.max(h) > 64 {
                let draws = scene.passes[at].draws.iter_mut();
                draws.filter(|d| d.depth.is_some()).for_each(&bug);
            }
        }
    })
}

fn hierarchy(list: &mut List) {
    list.add(
        "direction-kept",
        CONFUSION,
        "A comparison of the other direction than that of the draw before is executed in its direction.",
        from_draw(|before, draw| {
            if let (Some(before), Some(depth)) = (before.depth, &mut draw.depth)
                && let (Some(a), Some(b)) = (nearer(before.compare), nearer(depth.compare))
                && a != b
            {
                depth.compare = before.compare;
            }
        }),
    );
    type Bug = fn(&mut Draw);
    let rows: [(&str, &str, Bug); 5] = [
        (
            "not-equal-as-less",
            "Bounds that are kept for smaller depths reject what is not equal.",
            |draw| {
                if let Some(depth) = &mut draw.depth
                    && depth.compare == CompareFunction::NotEqual
                {
                    depth.compare = CompareFunction::Less;
                }
            },
        ),
        (
            "single-texels-unwritten",
            "A draw that touches single texels of a block does not write their depths.",
            |draw| {
                if let Some(depth) = &mut draw.depth
                    && draw.topology == PrimitiveTopology::PointList
                {
                    depth.write = false;
                }
            },
        ),
        (
            "discarded-written",
            "The depth of a block is written although fragments in it are discarded.",
            |draw| {
                if draw.shader == etalon_scene::Shader::TexelDiscard {
                    draw.shader = etalon_scene::Shader::TexelColor;
                }
            },
        ),
        (
            "plane-for-written",
            "The depth of the triangle's plane is tested where the shader writes another.",
            |draw| {
                if draw.shader == etalon_scene::Shader::FlatColorDepth {
                    draw.shader = etalon_scene::Shader::UniformColor;
                }
            },
        ),
        (
            "stencil-only-skipped",
            "A draw that writes neither colour nor depth writes no stencil.",
            |draw| {
                let colorless = draw.targets.iter().all(|t| t.write_mask == 0);
                if colorless && !draw.depth.is_some_and(|d| d.write) {
                    draw.rasterizer_discard = true;
                }
            },
        ),
    ];
    for (name, about, bug) in rows {
        list.add(name, CONFUSION, about, tests(bug));
    }
}
