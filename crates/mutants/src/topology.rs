//! Bugs of topologies, polygon modes and rasterizer discard.

use crate::fields::{CULL, TOPOLOGY};
use crate::hooks::lines_face_front;
use crate::list::bugs;
use crate::permission::under;
use crate::plant::{draws, set};
use PrimitiveTopology as T;
use etalon_scene::{CullMode, PolygonMode, PrimitiveTopology, RESTART};

bugs! {
    class "topology", "cull";
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
    swaps "", "The topology ", TOPOLOGY, swapped;
    "restart-ignored: A restart is left out of a strip." =>
        draws(|draw| if let Some(indices) = &mut draw.mesh.indices { indices.retain(|i| *i != RESTART) });
    "restart-as-first-vertex: A restart counts as the first vertex." =>
        draws(|draw| { for index in draw.mesh.indices.iter_mut().flatten() { if *index == RESTART { *index = 0; } } });
    "restart-ends-the-draw: Nothing is drawn after a restart." =>
        draws(|draw| {
            if let Some(indices) = &mut draw.mesh.indices {
                let end = indices.iter().position(|i| *i == RESTART);
                indices.truncate(end.unwrap_or(indices.len()));
            }
        });
    "indices-ignored: Vertices are drawn in their own order." => draws(|draw| draw.mesh.indices = None);
    "first-index-lost: Indices begin one late." =>
        draws(|draw| if let Some(indices) = &mut draw.mesh.indices { indices.rotate_left(1) });
    "last-fan-triangle-lost: A fan lacks its last triangle." =>
        draws(|draw| { draw.mesh.vertices.pop(); }), when |draw| draw.topology == T::TriangleFan;
    "first-fan-vertex-lost: A fan turns round its second vertex." =>
        draws(|draw| { draw.mesh.vertices.remove(0); }), when |draw| draw.topology == T::TriangleFan;
    "last-line-lost: The last line is lost." =>
        draws(|draw| { draw.mesh.vertices.pop(); }), when |draw| draw.topology == T::LineList;
    "slanted-lines-lost: Lines along no axis are lost." =>
        draws(|draw| {
            let lines = draw.mesh.vertices.chunks_exact(2);
            let axial = lines.filter(|ends| {
                let [[x0, y0, ..], [x1, y1, ..]] = [ends[0].position, ends[1].position];
                x0 == x1 || y0 == y1
            });
            draw.mesh.vertices = axial.flatten().copied().collect();
        }), when |draw| draw.topology == T::LineList && draw.mesh.indices.is_none();
    "last-point-lost: The last point is lost." =>
        draws(|draw| { draw.mesh.vertices.pop(); }), when |draw| draw.topology == T::PointList;
    "lines-culled: Culling both faces removes lines." =>
        draws(|draw| draw.rasterizer_discard = true),
        when |draw| draw.cull == CullMode::FrontAndBack && draw.topology == T::LineList;
    "points-culled: Culling both faces removes points." =>
        draws(|draw| draw.rasterizer_discard = true),
        when |draw| draw.cull == CullMode::FrontAndBack && draw.topology == T::PointList;
    "outlines-filled: Polygons are always filled." => draws(|draw| draw.polygon_mode = PolygonMode::Fill);
    "outlines-not-culled: Outlines are not culled." =>
        set(CULL, CullMode::None), when |draw| draw.polygon_mode == PolygonMode::Line;
    "discard-ignored: Rasterizer discard is ignored." => draws(|draw| draw.rasterizer_discard = false);
    "all-discarded-with-both-culled: Culling both faces acts as rasterizer discard." =>
        draws(|draw| draw.rasterizer_discard |= draw.cull == CullMode::FrontAndBack);
    "lines-and-points-face-back: Points and lines face back." => lines_face_front(|| false), permitted vec![under!(points_face_front: false)];
    "discarded-still-writes-depth-and-stencil: Rasterizer discard holds back colour alone." =>
        draws(|draw| { draw.rasterizer_discard = false; draw.targets.iter_mut().for_each(|t| t.write_mask = 0); }),
        when |draw| draw.rasterizer_discard;
}
