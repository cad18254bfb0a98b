//! Bugs of the facing of tessellated triangles.

use crate::fields::{Places, STENCIL};
use crate::list::List;
use crate::plant::from_draw;
use crate::tables::turned;
use etalon_scene::{CullMode, DomainOrigin, Draw, FrontFace, PolygonMode, Shader, Tessellation};

const TESSELLATION: Places<Tessellation> = |d| d.tessellation.iter_mut().collect();

/// True of draws whose triangles face other than their patch.
fn turns(draw: &Draw) -> bool {
    draw.tessellation.is_some_and(|t| !t.keeps_order())
}

pub(super) fn add(list: &mut List) {
    list.class("tessellation", "cull");
    list.bug("order-inverted: Patches are turned over, whatever the shader declares.")
        .each(TESSELLATION, |t| t.order = turned(t.order));
    list.bug("order-always-ccw: The order of the vertices is counter-clockwise, GLSL's default.")
        .each(TESSELLATION, |t| t.order = FrontFace::Ccw);
    list.bug("order-always-cw: The order of the vertices is clockwise.")
        .each(TESSELLATION, |t| t.order = FrontFace::Cw);
    list.bug("origin-ignored: The domain's origin is the upper left corner, Vulkan's default.")
        .each(TESSELLATION, |t| t.origin = DomainOrigin::UpperLeft);
    list.bug("default-origin-lower-left: The domain's origin is the lower left corner, OpenGL's.")
        .each(TESSELLATION, |t| t.origin = DomainOrigin::LowerLeft);
    list.bug("only-lower-left-inverted: A lower left origin turns patches over twice.")
        .each(TESSELLATION, |t| {
            if t.origin == DomainOrigin::LowerLeft {
                t.order = turned(t.order);
            }
        });
    list.bug("order-of-the-patch: Triangles keep the order of their patch.")
        .draws(|draw| draw.tessellation = None);
    list.bug("culling-ignored: Tessellated triangles are not culled.")
        .when(|draw| draw.tessellation.is_some())
        .draws(|draw| draw.cull = CullMode::None);
    list.bug("front-face-ignored: Tessellated triangles face front when counter-clockwise.")
        .when(|draw| draw.tessellation.is_some())
        .draws(|draw| draw.front_face = FrontFace::Ccw);
    list.bug("shader-sees-the-other-face: The shader receives the facing of the patch.")
        .when(|draw| turns(draw) && draw.shader == Shader::FrontFacing)
        .draws(|draw| std::mem::swap(&mut draw.params.color, &mut draw.params.back_color));
    list.bug("stencil-takes-the-patch: The stencil test takes the state of the patch's face.")
        .when(turns)
        .each(STENCIL, |stencil| {
            std::mem::swap(&mut stencil.front, &mut stencil.back)
        });
    list.bug("outlines-keep-the-order: Outlines of tessellated triangles face as the patch.")
        .when(|draw| draw.polygon_mode == PolygonMode::Line)
        .draws(|draw| draw.tessellation = None);
    list.bug(
        "order-kept-from-the-draw-before: The order of a tessellated draw holds for the next.",
    )
    .plant(from_draw(|before, draw| {
        if let (Some(before), Some(asked)) = (before.tessellation, &mut draw.tessellation) {
            asked.order = before.order;
        }
    }));
    list.bug("facing-kept-from-the-draw-before: A draw faces as the tessellated one before it.")
        .plant(from_draw(|before, draw| {
            if draw.tessellation.is_none() && turns(before) {
                draw.front_face = turned(draw.front_face);
            }
        }));
}
