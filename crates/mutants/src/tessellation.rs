//! Bugs of the facing of tessellated triangles.

use crate::list::List;
use crate::plant::{draws, from_draw};
use etalon_scene::{CullMode, DomainOrigin, FrontFace, PolygonMode, Shader, Tessellation};

fn turned(order: FrontFace) -> FrontFace {
    match order {
        FrontFace::Ccw => FrontFace::Cw,
        FrontFace::Cw => FrontFace::Ccw,
    }
}

/// Changes the tessellation of the draws that have one.
fn tessellations(bug: fn(&mut Tessellation)) -> super::plant::Plant {
    draws(move |draw| {
        if let Some(tessellation) = &mut draw.tessellation {
            bug(tessellation);
        }
    })
}

pub(super) fn add(list: &mut List) {
    list.class("tessellation", "cull");

    list.bug("order-inverted: Patches are turned over, whatever the shader declares.")
        .plant(tessellations(|t| t.order = turned(t.order)));
    list.bug("order-always-ccw: The order of the vertices is counter-clockwise, GLSL's default.")
        .plant(tessellations(|t| t.order = FrontFace::Ccw));
    list.bug("order-always-cw: The order of the vertices is clockwise.")
        .plant(tessellations(|t| t.order = FrontFace::Cw));
    list.bug("origin-ignored: The domain's origin is the upper left corner, Vulkan's default.")
        .plant(tessellations(|t| t.origin = DomainOrigin::UpperLeft));
    list.bug("default-origin-lower-left: The domain's origin is the lower left corner, OpenGL's.")
        .plant(tessellations(|t| t.origin = DomainOrigin::LowerLeft));
    list.bug("only-lower-left-inverted: A lower left origin turns patches over twice.")
        .plant(tessellations(|t| {
            if t.origin == DomainOrigin::LowerLeft {
                t.order = turned(t.order);
            }
        }));

    list.bug("order-of-the-patch: Triangles keep the order of their patch.")
        .draws(|draw| draw.tessellation = None);
    list.bug("culling-ignored: Tessellated triangles are not culled.")
        .when(|draw| draw.tessellation.is_some())
        .draws(|draw| draw.cull = CullMode::None);
    list.bug("front-face-ignored: Tessellated triangles face front when counter-clockwise.")
        .when(|draw| draw.tessellation.is_some())
        .draws(|draw| draw.front_face = FrontFace::Ccw);
    list.bug("shader-sees-the-other-face: The shader receives the facing of the patch.")
        .draws(|draw| {
            let turns = draw.tessellation.is_some_and(|t| !t.keeps_order());
            if turns && draw.shader == Shader::FrontFacing {
                std::mem::swap(&mut draw.params.color, &mut draw.params.back_color);
            }
        });
    list.bug("stencil-takes-the-patch: The stencil test takes the state of the patch's face.")
        .draws(|draw| {
            let turns = draw.tessellation.is_some_and(|t| !t.keeps_order());
            if let Some(stencil) = draw.stencil.as_mut().filter(|_| turns) {
                std::mem::swap(&mut stencil.front, &mut stencil.back);
            }
        });
    list.bug("outlines-keep-the-order: Outlines of tessellated triangles face as the patch.")
        .when(|draw| draw.polygon_mode == PolygonMode::Line)
        .draws(|draw| draw.tessellation = None);
    list.bug(
        "order-kept-from-the-draw-before: The order of a tessellated draw holds for the next.",
    )
    .plant(from_draw(|before, draw| {
        if let (Some(before), Some(own)) = (before.tessellation, &mut draw.tessellation) {
            own.order = before.order;
        }
    }));
    list.bug("facing-kept-from-the-draw-before: A draw faces as the tessellated one before it.")
        .plant(from_draw(|before, draw| {
            if draw.tessellation.is_none() && before.tessellation.is_some_and(|t| !t.keeps_order())
            {
                draw.front_face = turned(draw.front_face);
            }
        }));
}
