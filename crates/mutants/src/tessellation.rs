//! Bugs of the facing of tessellated triangles.

use super::list::{CONFUSION, List, Row};
use super::plant::{draws, from_draw};
use etalon_scene::{CullMode, DomainOrigin, Draw, FrontFace, PolygonMode, Shader, Tessellation};

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
    let rows: [Row<fn(&mut Tessellation)>; 6] = [
        (
            "order-inverted",
            "Patches are turned over, whatever the shader declares.",
            |t| t.order = turned(t.order),
        ),
        (
            "order-always-ccw",
            "The order of the vertices is counter-clockwise, the default of GLSL.",
            |t| t.order = FrontFace::Ccw,
        ),
        (
            "order-always-cw",
            "The order of the vertices is clockwise.",
            |t| t.order = FrontFace::Cw,
        ),
        (
            "origin-ignored",
            "The domain's origin is the upper left corner, Vulkan's default.",
            |t| t.origin = DomainOrigin::UpperLeft,
        ),
        (
            "default-origin-lower-left",
            "The domain's origin is the lower left corner, OpenGL's.",
            |t| t.origin = DomainOrigin::LowerLeft,
        ),
        (
            "only-lower-left-inverted",
            "A lower left origin turns patches over twice.",
            |t| {
                if t.origin == DomainOrigin::LowerLeft {
                    t.order = turned(t.order);
                }
            },
        ),
    ];
    list.rows(CONFUSION, tessellations, &rows);
    let rows: [Row<fn(&mut Draw)>; 6] = [
        (
            "order-of-the-patch",
            "Triangles keep the order of their patch, as if nothing tessellated them.",
            |draw| draw.tessellation = None,
        ),
        (
            "culling-ignored",
            "Tessellated triangles are not culled.",
            |draw| {
                if draw.tessellation.is_some() {
                    draw.cull = CullMode::None;
                }
            },
        ),
        (
            "front-face-ignored",
            "Tessellated triangles face front when counter-clockwise, whatever the state says.",
            |draw| {
                if draw.tessellation.is_some() {
                    draw.front_face = FrontFace::Ccw;
                }
            },
        ),
        (
            "shader-sees-the-other-face",
            "The shader receives the facing of the patch, culling that of the triangle.",
            |draw| {
                let turns = draw.tessellation.is_some_and(|t| !t.keeps_order());
                if turns && draw.shader == Shader::FrontFacing {
                    std::mem::swap(&mut draw.params.color, &mut draw.params.back_color);
                }
            },
        ),
        (
            "stencil-takes-the-patch",
            "The stencil test takes the state of the face that the patch shows.",
            |draw| {
                let turns = draw.tessellation.is_some_and(|t| !t.keeps_order());
                if let Some(stencil) = draw.stencil.as_mut().filter(|_| turns) {
                    std::mem::swap(&mut stencil.front, &mut stencil.back);
                }
            },
        ),
        (
            "outlines-keep-the-order",
            "Outlines of tessellated triangles face as the patch.",
            |draw| {
                if draw.polygon_mode == PolygonMode::Line {
                    draw.tessellation = None;
                }
            },
        ),
    ];
    list.rows(CONFUSION, draws, &rows);
    list.add(
        "order-kept-from-the-draw-before",
        CONFUSION,
        "The order of the first tessellated draw holds for the next.",
        from_draw(|before, draw| {
            if let (Some(before), Some(own)) = (before.tessellation, &mut draw.tessellation) {
                own.order = before.order;
            }
        }),
    );
    list.add(
        "facing-kept-from-the-draw-before",
        CONFUSION,
        "A draw without tessellation faces as the tessellated one before it.",
        from_draw(|before, draw| {
            if draw.tessellation.is_none() && before.tessellation.is_some_and(|t| !t.keeps_order())
            {
                draw.front_face = turned(draw.front_face);
            }
        }),
    );
}
