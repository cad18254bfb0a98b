//! Bugs of facing and culling.

use super::list::{CONFUSION, List};
use super::plant::{Plant, draws};
use etalon_scene::{CullMode, Draw, FrontFace, PrimitiveTopology, PrimitiveVertices, Shader};

const MODES: [CullMode; 4] = [
    CullMode::None,
    CullMode::Front,
    CullMode::Back,
    CullMode::FrontAndBack,
];

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
    for right in MODES {
        for wrong in MODES {
            if right == wrong {
                continue;
            }
            list.add(
                &format!("{}-as-{}", right.name(), wrong.name()),
                CONFUSION,
                format!("Cull mode {} acts as {}.", right.name(), wrong.name()),
                draws(move |draw| {
                    if draw.cull == right {
                        draw.cull = wrong;
                    }
                }),
            );
        }
    }
    list.add(
        "front-and-back-swapped",
        "SwiftShader: cull sign",
        "Front is culled for back and back for front.",
        draws(|draw| {
            draw.cull = match draw.cull {
                CullMode::Front => CullMode::Back,
                CullMode::Back => CullMode::Front,
                other => other,
            };
        }),
    );
    list.add(
        "front-face-inverted",
        "lima: front face inverted",
        "Clockwise and counter-clockwise are exchanged.",
        draws(|draw| {
            draw.front_face = match draw.front_face {
                FrontFace::Ccw => FrontFace::Cw,
                FrontFace::Cw => FrontFace::Ccw,
            };
        }),
    );
    for (name, face) in [("ccw", FrontFace::Ccw), ("cw", FrontFace::Cw)] {
        list.add(
            &format!("front-face-always-{name}"),
            CONFUSION,
            format!("The front face is always {name}."),
            draws(move |draw| draw.front_face = face),
        );
    }
    list.add(
        "shader-sees-the-other-face",
        "lima: front face inverted",
        "Shaders receive the opposite facing.",
        draws(|draw| {
            if draw.shader == Shader::FrontFacing {
                std::mem::swap(&mut draw.params.color, &mut draw.params.back_color);
            }
        }),
    );
    list.add(
        "shader-sees-front-always",
        CONFUSION,
        "Shaders receive every face as a front face.",
        draws(|draw| {
            if draw.shader == Shader::FrontFacing {
                draw.params.back_color = draw.params.color;
            }
        }),
    );
    list.add(
        "ignored-for-strips",
        CONFUSION,
        "Strips are not culled.",
        draws(|draw| {
            if draw.topology == PrimitiveTopology::TriangleStrip {
                draw.cull = CullMode::None;
            }
        }),
    );
    list.add(
        "ignored-for-lists",
        CONFUSION,
        "Lists are not culled.",
        draws(|draw| {
            if draw.topology == PrimitiveTopology::TriangleList {
                draw.cull = CullMode::None;
            }
        }),
    );
    list.add(
        "ignored-with-stencil",
        CONFUSION,
        "Draws with a stencil test are not culled.",
        draws(|draw| {
            if draw.stencil.is_some() {
                draw.cull = CullMode::None;
            }
        }),
    );
    list.add(
        "odd-strip-triangles-reversed",
        CONFUSION,
        "Every other triangle of a strip is wound the wrong way.",
        strips(|number, [a, b, c]| {
            Some(if number % 2 == 1 {
                [b, a, c]
            } else {
                [a, b, c]
            })
        }),
    );
    list.add(
        "even-strip-triangles-reversed",
        CONFUSION,
        "The first triangle of a strip and every other after it are wound the wrong way.",
        strips(|number, [a, b, c]| {
            Some(if number % 2 == 0 {
                [b, a, c]
            } else {
                [a, b, c]
            })
        }),
    );
    list.add(
        "last-strip-triangle-lost",
        CONFUSION,
        "A strip lacks its last triangle.",
        draws(|draw| {
            if draw.topology == PrimitiveTopology::TriangleStrip {
                draw.mesh.vertices.pop();
            }
        }),
    );
    list.add(
        "strip-as-list",
        CONFUSION,
        "A strip is drawn as a list.",
        draws(|draw| draw.topology = PrimitiveTopology::TriangleList),
    );
    list.add(
        "odd-strip-triangles-lost",
        CONFUSION,
        "A strip lacks every other triangle.",
        strips(|number, triangle| (number % 2 == 0).then_some(triangle)),
    );
}
