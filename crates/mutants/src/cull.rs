//! Bugs of facing and culling.

use crate::fields::{CULL, FRONT_FACE, TOPOLOGY};
use crate::list::bugs;
use crate::plant::{Plant, draws, each, set};
use crate::tables::{pairs, turned};
use etalon_scene::{CullMode, Draw, FrontFace, PrimitiveTopology, PrimitiveVertices, Shader};

/// Converts a strip to a list of triangles. `order` gets each triangle's number and indices.
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

bugs! {
    class "cull", "cull";
    swaps "", "The mode ", CULL, pairs(CullMode::ALL);
    "front-and-back-swapped: Front is culled for back and back for front." =>
        draws(|draw| {
            draw.cull = match draw.cull {
                CullMode::Front => CullMode::Back,
                CullMode::Back => CullMode::Front,
                other => other,
            };
        }), source "SwiftShader: cull sign";
    "front-face-inverted: Clockwise and counter-clockwise are exchanged." =>
        each(FRONT_FACE, |face| *face = turned(*face)), source "lima: front face inverted";
    for (name, face) in [("ccw", FrontFace::Ccw), ("cw", FrontFace::Cw)] {
        "front-face-always-{name}: The front face is always {name}." => set(FRONT_FACE, face);
    }
    "shader-sees-the-other-face: Shaders receive the opposite facing." =>
        draws(|draw| std::mem::swap(&mut draw.params.color, &mut draw.params.back_color)),
        source "lima: front face inverted", when |draw| draw.shader == Shader::FrontFacing;
    "shader-sees-front-always: Shaders receive every face as a front face." =>
        draws(|draw| draw.params.back_color = draw.params.color), when |draw| draw.shader == Shader::FrontFacing;
    "ignored-for-strips: Strips are not culled." =>
        set(CULL, CullMode::None), when |draw| draw.topology == PrimitiveTopology::TriangleStrip;
    "ignored-for-lists: Lists are not culled." =>
        set(CULL, CullMode::None), when |draw| draw.topology == PrimitiveTopology::TriangleList;
    "ignored-with-stencil: Draws with a stencil test are not culled." =>
        set(CULL, CullMode::None), when |draw| draw.stencil.is_some();
    "odd-strip-triangles-reversed: Each odd triangle of a strip is wound the wrong way." =>
        strips(|number, [a, b, c]| Some(if number % 2 == 1 { [b, a, c] } else { [a, b, c] }));
    "even-strip-triangles-reversed: Each even triangle of a strip is wound the wrong way." =>
        strips(|number, [a, b, c]| Some(if number % 2 == 0 { [b, a, c] } else { [a, b, c] }));
    "last-strip-triangle-lost: A strip lacks its last triangle." =>
        draws(|draw| { draw.mesh.vertices.pop(); }), when |draw| draw.topology == PrimitiveTopology::TriangleStrip;
    "strip-as-list: A strip is drawn as a list." => set(TOPOLOGY, PrimitiveTopology::TriangleList);
    "odd-strip-triangles-lost: A strip lacks every other triangle." =>
        strips(|number, triangle| (number % 2 == 0).then_some(triangle));
}
