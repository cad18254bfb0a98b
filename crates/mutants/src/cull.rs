//! Bugs of facing and culling.

use crate::fields::{CULL, FRONT_FACE};
use crate::list::List;
use crate::plant::{Plant, draws};
use crate::tables::{pairs, turned};
use etalon_scene::{CullMode, Draw, FrontFace, PrimitiveTopology, PrimitiveVertices, Shader};

/// Turns a strip into a list of triangles, given each one's number and indices.
fn unstripped(draw: &mut Draw, order: impl Fn(usize, [usize; 3]) -> Option<[usize; 3]>) {
    if draw.topology != PrimitiveTopology::TriangleStrip {
        return;
    }
    let primitives = draw.mesh.primitives(draw.topology);
    let old = std::mem::take(&mut draw.mesh.vertices);
    draw.mesh.indices = None;
    for (number, primitive) in primitives.into_iter().enumerate() {
        let PrimitiveVertices::Triangle(triangle) = primitive else {
            continue;
        };
        if let Some(corners) = order(number, triangle) {
            draw.mesh.vertices.extend(corners.map(|i| old[i]));
        }
    }
    draw.topology = PrimitiveTopology::TriangleList;
}

fn strips(
    order: impl Fn(usize, [usize; 3]) -> Option<[usize; 3]> + Send + Sync + 'static,
) -> Plant {
    draws(move |draw| unstripped(draw, &order))
}

pub(super) fn add(list: &mut List) {
    list.class("cull", "cull");
    list.swaps("", "The mode ", CULL, pairs(CullMode::ALL));
    list.bug("front-and-back-swapped: Front is culled for back and back for front.")
        .source("SwiftShader: cull sign")
        .draws(|draw| {
            draw.cull = match draw.cull {
                CullMode::Front => CullMode::Back,
                CullMode::Back => CullMode::Front,
                other => other,
            };
        });
    list.bug("front-face-inverted: Clockwise and counter-clockwise are exchanged.")
        .source("lima: front face inverted")
        .each(FRONT_FACE, |face| *face = turned(*face));
    for (name, face) in [("ccw", FrontFace::Ccw), ("cw", FrontFace::Cw)] {
        list.bug(format!(
            "front-face-always-{name}: The front face is always {name}."
        ))
        .draws(move |draw| draw.front_face = face);
    }
    list.bug("shader-sees-the-other-face: Shaders receive the opposite facing.")
        .source("lima: front face inverted")
        .when(|draw| draw.shader == Shader::FrontFacing)
        .draws(|draw| std::mem::swap(&mut draw.params.color, &mut draw.params.back_color));
    list.bug("shader-sees-front-always: Shaders receive every face as a front face.")
        .when(|draw| draw.shader == Shader::FrontFacing)
        .draws(|draw| draw.params.back_color = draw.params.color);
    list.bug("ignored-for-strips: Strips are not culled.")
        .when(|draw| draw.topology == PrimitiveTopology::TriangleStrip)
        .draws(|draw| draw.cull = CullMode::None);
    list.bug("ignored-for-lists: Lists are not culled.")
        .when(|draw| draw.topology == PrimitiveTopology::TriangleList)
        .draws(|draw| draw.cull = CullMode::None);
    list.bug("ignored-with-stencil: Draws with a stencil test are not culled.")
        .when(|draw| draw.stencil.is_some())
        .draws(|draw| draw.cull = CullMode::None);
    list.bug("odd-strip-triangles-reversed: Each odd triangle of a strip is wound the wrong way.")
        .plant(strips(|number, [a, b, c]| {
            Some(if number % 2 == 1 {
                [b, a, c]
            } else {
                [a, b, c]
            })
        }));
    list.bug(
        "even-strip-triangles-reversed: Each even triangle of a strip is wound the wrong way.",
    )
    .plant(strips(|number, [a, b, c]| {
        Some(if number % 2 == 0 {
            [b, a, c]
        } else {
            [a, b, c]
        })
    }));
    list.bug("last-strip-triangle-lost: A strip lacks its last triangle.")
        .when(|draw| draw.topology == PrimitiveTopology::TriangleStrip)
        .draws(|draw| {
            draw.mesh.vertices.pop();
        });
    list.bug("strip-as-list: A strip is drawn as a list.")
        .draws(|draw| draw.topology = PrimitiveTopology::TriangleList);
    list.bug("odd-strip-triangles-lost: A strip lacks every other triangle.")
        .plant(strips(|number, triangle| {
            (number % 2 == 0).then_some(triangle)
        }));
}
