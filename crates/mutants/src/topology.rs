//! Bugs of topologies, polygon modes and rasterizer discard.

use crate::fields::TOPOLOGY;
use crate::hooks::lines_face_front;
use crate::list::List;
use etalon_scene::{CullMode, PolygonMode, PrimitiveTopology, RESTART};

pub(super) fn add(list: &mut List) {
    use PrimitiveTopology as T;
    list.class("topology", "cull");
    let swapped = [
        (T::TriangleFan, T::TriangleStrip),
        (T::TriangleFan, T::TriangleList),
        (T::TriangleStrip, T::TriangleFan),
        (T::TriangleList, T::TriangleStrip),
        (T::TriangleList, T::TriangleFan),
        (T::LineList, T::LineStrip),
        (T::LineList, T::PointList),
        (T::PointList, T::LineList),
    ];
    list.swaps("", "The topology ", TOPOLOGY, swapped);
    list.bug("restart-ignored: A restart is left out of a strip.")
        .draws(|draw| {
            if let Some(indices) = &mut draw.mesh.indices {
                indices.retain(|i| *i != RESTART);
            }
        });
    list.bug("restart-as-first-vertex: A restart counts as the first vertex.")
        .draws(|draw| {
            for index in draw.mesh.indices.iter_mut().flatten() {
                if *index == RESTART {
                    *index = 0;
                }
            }
        });
    list.bug("restart-ends-the-draw: Nothing is drawn after a restart.")
        .draws(|draw| {
            if let Some(indices) = &mut draw.mesh.indices {
                let end = indices.iter().position(|i| *i == RESTART);
                indices.truncate(end.unwrap_or(indices.len()));
            }
        });
    list.bug("indices-ignored: Vertices are drawn in their own order.")
        .draws(|draw| draw.mesh.indices = None);
    list.bug("first-index-lost: Indices begin one late.")
        .draws(|draw| {
            if let Some(indices) = &mut draw.mesh.indices {
                indices.rotate_left(1);
            }
        });
    list.bug("last-fan-triangle-lost: A fan lacks its last triangle.")
        .when(|draw| draw.topology == T::TriangleFan)
        .draws(|draw| {
            draw.mesh.vertices.pop();
        });
    list.bug("first-fan-vertex-lost: A fan turns round its second vertex.")
        .when(|draw| draw.topology == T::TriangleFan)
        .draws(|draw| {
            draw.mesh.vertices.remove(0);
        });
    list.bug("last-line-lost: The last line is lost.")
        .when(|draw| draw.topology == T::LineList)
        .draws(|draw| {
            draw.mesh.vertices.pop();
        });
    list.bug("slanted-lines-lost: Lines along no axis are lost.")
        .when(|draw| draw.topology == T::LineList && draw.mesh.indices.is_none())
        .draws(|draw| {
            let lines = draw.mesh.vertices.chunks_exact(2);
            let axial = lines.filter(|ends| {
                let [[x0, y0, ..], [x1, y1, ..]] = [ends[0].position, ends[1].position];
                x0 == x1 || y0 == y1
            });
            draw.mesh.vertices = axial.flatten().copied().collect();
        });
    list.bug("last-point-lost: The last point is lost.")
        .when(|draw| draw.topology == T::PointList)
        .draws(|draw| {
            draw.mesh.vertices.pop();
        });
    list.bug("lines-culled: Culling both faces removes lines.")
        .when(|draw| draw.cull == CullMode::FrontAndBack && draw.topology == T::LineList)
        .draws(|draw| draw.rasterizer_discard = true);
    list.bug("points-culled: Culling both faces removes points.")
        .when(|draw| draw.cull == CullMode::FrontAndBack && draw.topology == T::PointList)
        .draws(|draw| draw.rasterizer_discard = true);
    list.bug("outlines-filled: Polygons are always filled.")
        .draws(|draw| draw.polygon_mode = PolygonMode::Fill);
    list.bug("outlines-not-culled: Outlines are not culled.")
        .when(|draw| draw.polygon_mode == PolygonMode::Line)
        .draws(|draw| draw.cull = CullMode::None);
    list.bug("discard-ignored: Rasterizer discard is ignored.")
        .draws(|draw| draw.rasterizer_discard = false);
    list.bug("all-discarded-with-both-culled: Culling both faces acts as rasterizer discard.")
        .draws(|draw| draw.rasterizer_discard |= draw.cull == CullMode::FrontAndBack);
    list.bug("lines-and-points-face-back: Points and lines face back.")
        .plant(lines_face_front(|| false));
    list.bug(
        "discarded-still-writes-depth-and-stencil: Rasterizer discard holds back colour alone.",
    )
    .when(|draw| draw.rasterizer_discard)
    .draws(|draw| {
        draw.rasterizer_discard = false;
        draw.targets.iter_mut().for_each(|t| t.write_mask = 0);
    });
}
