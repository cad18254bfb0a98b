//! Bugs of topologies, polygon modes and rasterizer discard.

use super::hooks::lines_face_front;
use super::list::{CONFUSION, List, Row};
use super::plant::draws;
use etalon_scene::{CullMode, Draw, PolygonMode, PrimitiveTopology, RESTART};

pub(super) fn add(list: &mut List) {
    use PrimitiveTopology as T;
    list.class("topology", "cull");
    for (right, wrong) in [
        (T::TriangleFan, T::TriangleStrip),
        (T::TriangleFan, T::TriangleList),
        (T::TriangleStrip, T::TriangleFan),
        (T::TriangleList, T::TriangleStrip),
        (T::TriangleList, T::TriangleFan),
        (T::LineList, T::LineStrip),
        (T::LineList, T::PointList),
        (T::PointList, T::LineList),
    ] {
        let (is, was) = (wrong.name(), right.name());
        list.add(
            &format!("{was}-as-{is}"),
            CONFUSION,
            format!("A {was} is drawn as a {is}."),
            draws(move |draw| {
                if draw.topology == right {
                    draw.topology = wrong;
                }
            }),
        );
    }
    let rows: [Row<fn(&mut Draw)>; 15] = [
        (
            "restart-ignored",
            "A restart is left out of a strip.",
            |draw| {
                if let Some(indices) = &mut draw.mesh.indices {
                    indices.retain(|i| *i != RESTART);
                }
            },
        ),
        (
            "restart-as-first-vertex",
            "A restart counts as the first vertex.",
            |draw| {
                for index in draw.mesh.indices.iter_mut().flatten() {
                    if *index == RESTART {
                        *index = 0;
                    }
                }
            },
        ),
        (
            "restart-ends-the-draw",
            "Nothing is drawn after a restart.",
            |draw| {
                if let Some(indices) = &mut draw.mesh.indices {
                    let end = indices.iter().position(|i| *i == RESTART);
                    indices.truncate(end.unwrap_or(indices.len()));
                }
            },
        ),
        (
            "indices-ignored",
            "Vertices are drawn in their own order.",
            |draw| {
                draw.mesh.indices = None;
            },
        ),
        ("first-index-lost", "Indices begin one late.", |draw| {
            if let Some(indices) = &mut draw.mesh.indices {
                indices.rotate_left(1);
            }
        }),
        (
            "last-fan-triangle-lost",
            "A fan lacks its last triangle.",
            |draw| {
                if draw.topology == T::TriangleFan {
                    draw.mesh.vertices.pop();
                }
            },
        ),
        (
            "first-fan-vertex-lost",
            "A fan turns round its second vertex.",
            |draw| {
                if draw.topology == T::TriangleFan {
                    draw.mesh.vertices.remove(0);
                }
            },
        ),
        ("last-line-lost", "The last line is lost.", |draw| {
            if draw.topology == T::LineList {
                draw.mesh.vertices.pop();
            }
        }),
        ("last-point-lost", "The last point is lost.", |draw| {
            if draw.topology == T::PointList {
                draw.mesh.vertices.pop();
            }
        }),
        (
            "lines-culled",
            "Culling both faces removes lines.",
            |draw| {
                if draw.cull == CullMode::FrontAndBack && draw.topology == T::LineList {
                    draw.rasterizer_discard = true;
                }
            },
        ),
        (
            "points-culled",
            "Culling both faces removes points.",
            |draw| {
                if draw.cull == CullMode::FrontAndBack && draw.topology == T::PointList {
                    draw.rasterizer_discard = true;
                }
            },
        ),
        ("outlines-filled", "Polygons are always filled.", |draw| {
            draw.polygon_mode = PolygonMode::Fill;
        }),
        ("outlines-not-culled", "Outlines are not culled.", |draw| {
            if draw.polygon_mode == PolygonMode::Line {
                draw.cull = CullMode::None;
            }
        }),
        (
            "discard-ignored",
            "Rasterizer discard is ignored.",
            |draw| {
                draw.rasterizer_discard = false;
            },
        ),
        (
            "all-discarded-with-both-culled",
            "Culling both faces acts as rasterizer discard.",
            |draw| {
                draw.rasterizer_discard |= draw.cull == CullMode::FrontAndBack;
            },
        ),
    ];
    list.rows(CONFUSION, draws, &rows);
    list.add(
        "lines-and-points-face-back",
        CONFUSION,
        "Points and lines face back.",
        lines_face_front(|| false),
    );
    list.add(
        "discarded-still-writes-depth-and-stencil",
        CONFUSION,
        "Rasterizer discard still changes depth and stencil.",
        draws(|draw| {
            if std::mem::take(&mut draw.rasterizer_discard) {
                draw.targets.iter_mut().for_each(|t| t.write_mask = 0);
            }
        }),
    );
}
