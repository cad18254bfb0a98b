//! Bugs of the facing of tessellated triangles.

use crate::fields::{CULL, FRONT_FACE, FieldPlaces, STENCIL};
use crate::list::bugs;
use crate::plant::{draws, each, from_draw, set};
use crate::tables::turned;
use etalon_scene::{CullMode, DomainOrigin, Draw, FrontFace, PolygonMode, Shader, Tessellation};

const TESSELLATION: FieldPlaces<Tessellation> = |d| d.tessellation.iter_mut().collect();

/// Returns true for draws whose triangles face the opposite way to their patch.
fn turns(draw: &Draw) -> bool {
    draw.tessellation.is_some_and(|t| !t.keeps_order())
}

bugs! {
    class "tessellation", "cull";
    "order-inverted: Patches are turned over, whatever the shader declares." =>
        each(TESSELLATION, |t| t.order = turned(t.order));
    "order-always-ccw: The order of the vertices is counter-clockwise, GLSL's default." =>
        each(TESSELLATION, |t| t.order = FrontFace::Ccw);
    "order-always-cw: The order of the vertices is clockwise." => each(TESSELLATION, |t| t.order = FrontFace::Cw);
    "origin-ignored: The domain's origin is the upper left corner, Vulkan's default." =>
        each(TESSELLATION, |t| t.origin = DomainOrigin::UpperLeft);
    "default-origin-lower-left: The domain's origin is the lower left corner, OpenGL's." =>
        each(TESSELLATION, |t| t.origin = DomainOrigin::LowerLeft);
    "only-lower-left-inverted: A lower left origin turns patches over twice." =>
        each(TESSELLATION, |t| if t.origin == DomainOrigin::LowerLeft { t.order = turned(t.order) });
    "order-of-the-patch: Triangles keep the order of their patch." => draws(|draw| draw.tessellation = None);
    "culling-ignored: Tessellated triangles are not culled." =>
        set(CULL, CullMode::None), when |draw| draw.tessellation.is_some();
    "front-face-ignored: Tessellated triangles face front when counter-clockwise." =>
        set(FRONT_FACE, FrontFace::Ccw), when |draw| draw.tessellation.is_some();
    "shader-sees-the-other-face: The shader receives the facing of the patch." =>
        draws(|draw| std::mem::swap(&mut draw.params.color, &mut draw.params.back_color)),
        when |draw| turns(draw) && draw.shader == Shader::FrontFacing;
    "stencil-takes-the-patch: The stencil test takes the state of the patch's face." =>
        each(STENCIL, |stencil| std::mem::swap(&mut stencil.front, &mut stencil.back)), when turns;
    "outlines-keep-the-order: Outlines of tessellated triangles face as the patch." =>
        draws(|draw| draw.tessellation = None), when |draw| draw.polygon_mode == PolygonMode::Line;
    "order-kept-from-the-draw-before: The order of a tessellated draw holds for the next." =>
        from_draw(|before, draw| {
            if let (Some(before), Some(asked)) = (before.tessellation, &mut draw.tessellation) {
                asked.order = before.order;
            }
        });
    "facing-kept-from-the-draw-before: A draw faces as the tessellated one before it." =>
        from_draw(|before, draw| {
            if draw.tessellation.is_none() && turns(before) { draw.front_face = turned(draw.front_face); }
        });
}
