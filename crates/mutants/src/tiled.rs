//! Bugs of the tiles and batches in which drivers work: texels that draws and clears miss, edges that are
//! one texel off at the end of a tile, and draws and primitives that are lost at the end of a batch.

use crate::aspects::{ASPECTS, word};
use crate::hooks::{code, covered, fetch};
use crate::list::bugs;
use crate::memory::{Area, texel_rows};
use crate::plant::{Plant, all_draws, calls, draws, memory, moved, scene, sized};
use PrimitiveTopology::{LineList, LineStrip, PointList, TriangleFan};
use etalon_cpu::CpuSurface;
use etalon_cpu::steps::Moment;
use etalon_frame::{Aspect, ChannelEncoding};
use etalon_scene::{
    Attachment, AttachmentContents, Draw, PolygonMode, PrimitiveTopology, PrimitiveVertices,
};

/// The sides of tiles, in texels.
const TILES: [u32; 4] = [8, 16, 32, 64];

/// The edges: name, axis, and true for the far edge.
const EDGES: [(&str, usize, bool); 4] = [
    ("left", 0, false),
    ("top", 1, false),
    ("right", 0, true),
    ("bottom", 1, true),
];

/// Draws nothing at texels for which `bug([x, y], [width, height])` is true.
fn lost(bug: impl Fn([u32; 2], [u32; 2]) -> bool + Send + Sync + 'static) -> Plant {
    covered(move |texel, size| !bug(texel, size))
}

/// Changes the primitives of each draw that has more than this many and meets the condition.
fn long(
    more_than: usize,
    strikes: fn(&Draw) -> bool,
    bug: impl Fn(&mut Vec<PrimitiveVertices>) + Send + Sync + 'static,
) -> Plant {
    draws(move |draw| {
        let indices = draw.mesh.indices.as_ref().map(Vec::len);
        if indices.unwrap_or(draw.mesh.vertices.len()) <= more_than || !strikes(draw) {
            return;
        }
        let mut primitives = draw.mesh.primitives(draw.topology);
        if primitives.len() <= more_than {
            return;
        }
        bug(&mut primitives);
        let mut indices: Vec<usize> = Vec::with_capacity(primitives.len() * 3);
        for primitive in primitives {
            let (topology, vertices): (_, &[usize]) = match &primitive {
                PrimitiveVertices::Point(vertex) => (PrimitiveTopology::PointList, &[*vertex]),
                PrimitiveVertices::Line(ends) => (PrimitiveTopology::LineList, ends),
                PrimitiveVertices::Triangle(corners) => (PrimitiveTopology::TriangleList, corners),
            };
            draw.topology = topology;
            indices.extend(vertices);
        }
        draw.mesh.indices = Some(indices.into_iter().map(|vertex| vertex as u32).collect());
    })
}

/// Changes the codes of the texels in an area, in one aspect.
fn spoil(surface: &mut CpuSurface, attachment: &Attachment, aspect: Aspect, area: Area) {
    let encodings: &[ChannelEncoding] = match aspect {
        Aspect::Color => attachment.format.color_channels(),
        _ => attachment.format.depth_encodings(),
    };
    for texels in texel_rows(surface, area) {
        if aspect == Aspect::Stencil {
            let planes = surface.stencil.iter_mut();
            let codes = planes.flat_map(|plane| &mut plane[texels.clone()]);
            codes.for_each(|code| *code = if *code == 0 { 255 } else { 0 });
            continue;
        }
        for (number, plane) in surface.planes.iter_mut().enumerate() {
            let largest = code(encodings[number / surface.samples], 1.0);
            let codes = plane[texels.clone()].iter_mut();
            codes.for_each(|code| *code = if *code == 0 { largest } else { 0 });
        }
    }
}

/// Leaves an area of cleared attachments uncleared, given their size; `None` leaves nothing uncleared.
fn uncleared(
    aspect: Aspect,
    area: impl Fn([usize; 2]) -> Option<Area> + Clone + Send + Sync + 'static,
) -> Plant {
    memory(move |(), moment, scene, stored| {
        for (surface, attachment) in stored.surfaces.iter_mut().zip(&scene.attachments) {
            let cleared = !matches!(attachment.contents, AttachmentContents::Texels(_));
            let has = attachment.format.aspects().contains(&aspect);
            if moment == Moment::Initial
                && cleared
                && has
                && let Some(area) = area([surface.width, surface.height])
            {
                spoil(surface, attachment, aspect, area);
            }
        }
    })
}

bugs! {
    class "size", "size";
    for n in [16, 32] {
        "only-first-{n}: Only the first {n}×{n} texels are drawn." => lost(move |[x, y], _| x >= n || y >= n);
    }
    "last-column: The last column is not drawn." => lost(|[x, _], [w, _]| x + 1 == w);
    "last-row: The last row is not drawn." => lost(|[_, y], [_, h]| y + 1 == h);
    for n in TILES {
        let tile = move |texel: [u32; 2]| texel.map(|v| v / n);
        let several = move |size: [u32; 2]| size.iter().any(|length| *length > n);
        "first-tile-of-{n}: Of several tiles of {n}×{n}, the first is not drawn." =>
            lost(move |texel, size| several(size) && tile(texel) == [0, 0]);
        "second-tile-of-{n}: The second tile of {n}×{n} in the first row is not drawn." =>
            lost(move |texel, _| tile(texel) == [1, 0]);
        "last-tile-of-{n}: Of several tiles of {n}×{n}, the last is not drawn." =>
            lost(move |texel, size| several(size) && tile(texel) == tile(size.map(|length| length - 1)));
        "second-row-of-tiles-of-{n}: The second row of tiles of {n}×{n} is not drawn." =>
            lost(move |[_, y], _| y / n == 1);
    }
    for n in [16, 32, 64, 128, 256, 1024] {
        "column-{n}: Column {n} is not drawn." => lost(move |[x, _], _| x == n);
        "row-{n}: Row {n} is not drawn." => lost(move |[_, y], _| y == n);
    }
    for n in TILES {
        for (edge, axis, far) in EDGES {
            "scissor-{edge}-at-{n}: A scissor's {edge} edge at a multiple of {n} is one texel inside." =>
                sized(move |draw, size| {
                    let Some(rect) = &mut draw.scissor else { return };
                    let (start, length) = (rect[axis], rect[axis + 2]);
                    let end = start.saturating_add(length);
                    if far && end % n == 0 && end < size[axis] {
                        rect[axis + 2] = length.saturating_sub(1);
                    } else if !far && start % n == 0 && start > 0 && length > 0 {
                        (rect[axis], rect[axis + 2]) = (start + 1, length - 1);
                    }
                });
        }
    }
    for n in [16, 64] {
        for (edge, axis, far) in EDGES {
            if (far) {
                "scissor-{edge}-grown-at-{n}: A scissor's {edge} edge at a multiple of {n} is one texel outside." =>
                    sized(move |draw, size| {
                        let Some(rect) = &mut draw.scissor else { return };
                        let end = rect[axis].saturating_add(rect[axis + 2]);
                        rect[axis + 2] += u32::from(end % n == 0 && end < size[axis] && rect[axis + 2] > 0);
                    });
            }
            "viewport-{edge}-at-{n}: A viewport's {edge} edge at a multiple of {n} is one texel inside." =>
                sized(move |draw, size| {
                    let rect = &mut draw.viewport.rect;
                    let edge = rect[axis] + if far { rect[axis + 2] } else { 0.0 };
                    let inside = edge > 0.0 && edge < size[axis] as f32 && edge % n as f32 == 0.0;
                    if inside && rect[axis + 2] > 1.0 {
                        rect[axis] += if far { 0.0 } else { 1.0 };
                        rect[axis + 2] -= 1.0;
                    }
                });
        }
    }
    "draws-past-256-lost: Draws of a pass past 256 are lost." => calls(|draws| draws.truncate(256));
    "params-kept-past-256: Draws of a pass past 256 have that one's parameters." =>
        calls(|draws| (256..draws.len()).for_each(|n| draws[n].params = draws[255].params));
    "params-wrap-at-256: Parameters of draws wrap at 256." =>
        calls(|draws| (256..draws.len()).for_each(|n| draws[n].params = draws[n - 256].params));
    "vertices-in-16-bits: Vertices past 65,536 are the first ones again." =>
        draws(|draw| {
            let vertices = &mut draw.mesh.vertices;
            for number in 1 << 16..vertices.len() { vertices[number] = vertices[number - (1 << 16)]; }
        });
    "vertex-buffer-in-16-bits: Draws are lost whose vertices lie past 65,536 of all." =>
        scene(|scene| {
            let mut used = 0;
            for draw in all_draws(scene) {
                draw.rasterizer_discard |= used >= 1 << 16;
                used += draw.mesh.vertices.len();
            }
        });
    "primitive-65536-doubled: Primitive number 65536 is drawn twice." =>
        long(65_536, |_| true, |indices| indices.insert(65_536, indices[65_535]));
    for n in [4096, 16384, 65535] {
        "primitives-past-{n}-lost: Primitives past {n} are lost." =>
            long(n, |_| true, move |indices| indices.truncate(n));
    }
    // The batch sizes that cases reach: most with points, fewer with other primitives.
    for (kind, batches, strikes as fn(&Draw) -> bool) in [
        ("points", &[64, 256, 1024][..], |draw| draw.topology == PointList),
        ("lines", &[64, 256], |draw| [LineList, LineStrip].contains(&draw.topology)),
        ("outlines", &[64, 256], |draw| draw.polygon_mode == PolygonMode::Line),
    ] {
        for n in batches {
            "{kind}-past-{n}-lost: Of {kind}, primitives past {n} are lost." =>
                long(*n, strikes, |indices| indices.truncate(*n));
        }
    }
    for n in [256, 1024, 3000] {
        "fan-split-at-{n}: The triangles of a fan past {n} begin at vertex {n} instead of the first." =>
            long(n, |draw| draw.topology == TriangleFan, move |primitives| {
                for primitive in primitives.iter_mut().skip(n) {
                    if let PrimitiveVertices::Triangle(corners) = primitive {
                        corners.iter_mut().filter(|c| **c == 0).for_each(|c| *c = n);
                    }
                }
            });
    }
    for aspect in ASPECTS {
        let (name, word) = (aspect.name(), word(aspect));
        for n in TILES {
            let side = n as usize;
            "{name}-clear-leaves-second-tile-of-{n}: The second tile of {n}×{n} keeps its old {word}." =>
                uncleared(aspect, move |[w, _]| (w > side).then_some([side, 0, side * 2, side]));
            "{name}-clear-leaves-last-tile-of-{n}: The last tile of {n}×{n} keeps its old {word}." =>
                uncleared(aspect, move |[w, h]| {
                    let last = |length: usize| (length - 1) / side * side;
                    (w.max(h) > side).then_some([last(w), last(h), w, h])
                });
        }
        for (what, about, area as fn([usize; 2]) -> Option<Area>) in [
            ("only-first-64-columns", "What is right of column 63", |[w, h]| (w > 64).then_some([64, 0, w, h])),
            ("leaves-last-odd-row", "The last row of an odd height", |[w, h]| (h % 2 == 1).then_some([0, h - 1, w, h])),
            ("leaves-last-odd-column", "The last column of an odd width",
                |[w, h]| (w % 2 == 1).then_some([w - 1, 0, w, h])),
        ] {
            "{name}-clear-{what}: {about} keeps its old {word}." => uncleared(aspect, area);
        }
    }
    "fetch-in-6-bits: Texels are fetched at coordinates modulo 64." => fetch(|[x, y], _| [x % 64, y % 64]);
    for aspect in ASPECTS {
        let (name, word) = (aspect.name(), word(aspect));
        "{name}-read-at-pitch-of-64: Rows of {word} are read at a pitch of 64 texels." =>
            moved(aspect, |[x, y], [w, h]| {
                let texel = (y * w.next_multiple_of(64) + x) % (w * h);
                [texel % w, texel / w]
            });
    }
}
