//! Draws, primitives and indices that are lost, doubled or exchanged where a batch or a number ends.

use super::super::list::{CONFUSION, List};
use super::super::plant::{Plant, draws, scene};
use etalon_scene::{Draw, PolygonMode, PrimitiveTopology, PrimitiveVertices};

/// Changes the draws of each pass that has more than this many.
fn calls(more_than: usize, bug: impl Fn(&mut Vec<Draw>) + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        for pass in &mut scene.passes {
            if pass.draws.len() > more_than {
                bug(&mut pass.draws);
            }
        }
    })
}

/// Changes the primitives of each draw that has more than this many and fits the condition.
fn primitives(
    more_than: usize,
    of: impl Fn(&Draw) -> bool + Send + Sync + 'static,
    bug: impl Fn(&mut Vec<PrimitiveVertices>) + Send + Sync + 'static,
) -> Plant {
    draws(move |draw| {
        let indices = draw.mesh.indices.as_ref().map(Vec::len);
        if indices.unwrap_or(draw.mesh.vertices.len()) <= more_than || !of(draw) {
            return;
        }
        let mut all = draw.mesh.primitives(draw.topology);
        if all.len() <= more_than {
            return;
        }
        bug(&mut all);
        let mut indices = Vec::with_capacity(all.len() * 3);
        for primitive in all {
            draw.topology = match primitive {
                PrimitiveVertices::Point(at) => {
                    indices.push(at as u32);
                    PrimitiveTopology::PointList
                }
                PrimitiveVertices::Line(ends) => {
                    indices.extend(ends.map(|at| at as u32));
                    PrimitiveTopology::LineList
                }
                PrimitiveVertices::Triangle(corners) => {
                    indices.extend(corners.map(|at| at as u32));
                    PrimitiveTopology::TriangleList
                }
            };
        }
        draw.mesh.indices = Some(indices);
    })
}

fn any(_: &Draw) -> bool {
    true
}

pub(super) fn add(list: &mut List) {
    numbers_of_draws(list);
    numbers_of_primitives(list);
    indices(list);
}

fn numbers_of_draws(list: &mut List) {
    let n = 256;
    list.add(
        &format!("draws-past-{n}-lost"),
        CONFUSION,
        format!("Draws of a pass past {n} are lost."),
        calls(n, move |all| all.truncate(n)),
    );
    list.add(
        &format!("params-kept-past-{n}"),
        CONFUSION,
        format!("Draws of a pass past {n} use the parameters of draw number {n}."),
        calls(n, move |all| {
            let params = all[n - 1].params;
            for draw in &mut all[n..] {
                draw.params = params;
            }
        }),
    );
    list.add(
        &format!("params-wrap-at-{n}"),
        CONFUSION,
        format!("Parameters of draws wrap at {n}."),
        calls(n, move |all| {
            let first: Vec<_> = all[..n].iter().map(|d| d.params).collect();
            for (at, draw) in all.iter_mut().enumerate() {
                draw.params = first[at % n];
            }
        }),
    );
}

fn numbers_of_primitives(list: &mut List) {
    let n = 1_usize << 16;
    list.add(
        &format!("primitive-{n}-doubled"),
        CONFUSION,
        format!("Primitive number {n} is drawn twice."),
        primitives(n, any, move |all| {
            let twice = all[n - 1];
            all.insert(n, twice);
        }),
    );
    for n in [4096, 16384, 65535] {
        list.add(
            &format!("primitives-past-{n}-lost"),
            CONFUSION,
            format!("Primitives past {n} are lost."),
            primitives(n, any, move |all| all.truncate(n)),
        );
    }
    type Kind = (&'static str, fn(&Draw) -> bool);
    let kinds: [Kind; 3] = [
        ("points", |draw| {
            draw.topology == PrimitiveTopology::PointList
        }),
        ("lines", |draw| {
            let topology = draw.topology;
            topology == PrimitiveTopology::LineList || topology == PrimitiveTopology::LineStrip
        }),
        ("outlines", |draw| draw.polygon_mode == PolygonMode::Line),
    ];
    for (kind, of) in kinds {
        // Cases have so many points, and fewer of the others.
        let batches: &[usize] = if kind == "points" {
            &[64, 256, 1024]
        } else {
            &[64, 256]
        };
        for n in batches.iter().copied() {
            list.add(
                &format!("{kind}-past-{n}-lost"),
                CONFUSION,
                format!("Of {kind}, primitives past {n} are lost."),
                primitives(n, of, move |all| all.truncate(n)),
            );
        }
    }
}

fn indices(list: &mut List) {
    const WRAP: u32 = 1 << 16;
    list.add(
        "vertices-in-16-bits",
        CONFUSION,
        "Vertices past 65,536 are the first ones again.",
        draws(|draw| {
            let mesh = &mut draw.mesh;
            let n = WRAP as usize;
            for at in n..mesh.vertices.len() {
                mesh.vertices[at] = mesh.vertices[at % n];
            }
        }),
    );
    list.add(
        "vertex-buffer-in-16-bits",
        CONFUSION,
        "Draws whose vertices lie past 65,536 in a common buffer are lost.",
        scene(|scene| {
            let mut used = 0;
            for draw in scene.passes.iter_mut().flat_map(|p| &mut p.draws) {
                let first = used;
                used += draw.mesh.vertices.len();
                if first >= WRAP as usize {
                    draw.rasterizer_discard = true;
                }
            }
        }),
    );
}
