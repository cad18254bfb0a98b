//! Bugs of coverage, positions and whole draws.

use super::hooks::covered;
use super::list::{CONFUSION, List, SMALL};
use super::plant::{Plant, draws, in_bits, scene};
use etalon_scene::FrontFace;

pub(super) fn add(list: &mut List) {
    list.class("geometry", "blend");
    coverage(list);
    positions(list);
    list.class("geometry", "depth");
    vertex_depth(list);
}

fn coverage(list: &mut List) {
    type Covered = fn([u32; 2], [u32; 2]) -> bool;
    let missing: [(&str, &str, Covered); 7] = [
        (
            "last-column-missing",
            "The last column is not drawn.",
            |[x, _], [w, _]| x + 1 < w,
        ),
        (
            "last-row-missing",
            "The last row is not drawn.",
            |[_, y], [_, h]| y + 1 < h,
        ),
        (
            "first-column-missing",
            "The first column is not drawn.",
            |[x, _], _| x > 0,
        ),
        (
            "first-row-missing",
            "The first row is not drawn.",
            |[_, y], _| y > 0,
        ),
        (
            "first-texel-missing",
            "The first texel is not drawn.",
            |at, _| at != [0, 0],
        ),
        (
            "last-texel-missing",
            "The last texel is not drawn.",
            |[x, y], [w, h]| x + 1 < w || y + 1 < h,
        ),
        (
            "middle-texel-missing",
            "The middle texel is not drawn.",
            |[x, y], [w, h]| x != w / 2 || y != h / 2,
        ),
    ];
    for (name, about, bug) in missing {
        list.add(name, SMALL, about, covered(bug));
    }
    list.add(
        "first-triangle-lost",
        CONFUSION,
        "The first triangle of every draw is lost.",
        draws(|draw| {
            let n = draw.mesh.vertices.len().min(3);
            draw.mesh.vertices.drain(..n);
        }),
    );
    list.add(
        "last-triangle-lost",
        CONFUSION,
        "The last triangle of every draw is lost.",
        draws(|draw| {
            let n = draw.mesh.vertices.len();
            draw.mesh.vertices.truncate(n.saturating_sub(3));
        }),
    );
    list.add(
        "last-draw-lost",
        CONFUSION,
        "The last draw of every pass is lost.",
        scene(|scene| {
            for pass in &mut scene.passes {
                pass.draws.pop();
            }
        }),
    );
    list.add(
        "draws-reversed",
        CONFUSION,
        "Draws are carried out in reverse order.",
        scene(|scene| scene.passes.iter_mut().for_each(|p| p.draws.reverse())),
    );
    list.add(
        "last-draw-twice",
        CONFUSION,
        "The last draw of every pass is carried out twice.",
        scene(|scene| {
            for pass in &mut scene.passes {
                pass.draws.extend(pass.draws.last().cloned());
            }
        }),
    );
}

/// Moves everything by a number of texels to the right and down.
fn shifted(right: f32, down: f32) -> Plant {
    scene(move |scene| {
        for pass in &mut scene.passes {
            let Some(target) = pass.color.first().copied().or(pass.depth_stencil) else {
                continue;
            };
            let [width, height] = scene.attachments[target].size.map(|s| s as f32);
            for vertex in pass.draws.iter_mut().flat_map(|d| &mut d.mesh.vertices) {
                vertex.position[0] += 2.0 * right / width * vertex.position[3];
                vertex.position[1] -= 2.0 * down / height * vertex.position[3];
            }
        }
    })
}

fn positions(list: &mut List) {
    for (name, right, down) in [
        ("one-texel-right", 1.0, 0.0),
        ("one-texel-left", -1.0, 0.0),
        ("one-texel-down", 0.0, 1.0),
        ("one-texel-up", 0.0, -1.0),
    ] {
        list.add(
            name,
            SMALL,
            "Everything is drawn one texel off.",
            shifted(right, down),
        );
    }
    for (name, right, down) in [
        ("half-texel-right", 0.51, 0.0),
        ("half-texel-left", -0.51, 0.0),
        ("half-texel-down", 0.0, 0.51),
        ("half-texel-up", 0.0, -0.51),
    ] {
        list.add(
            name,
            "texel centres at integers, as in Direct3D 9",
            "Everything is drawn half a texel off.",
            shifted(right, down),
        );
    }
    list.add(
        "upside-down",
        "ANGLE: y flip",
        "Everything is drawn upside down, windings kept.",
        draws(|draw| {
            for vertex in &mut draw.mesh.vertices {
                vertex.position[1] = -vertex.position[1];
            }
            draw.front_face = match draw.front_face {
                FrontFace::Ccw => FrontFace::Cw,
                FrontFace::Cw => FrontFace::Ccw,
            };
        }),
    );
    list.add(
        "upside-down-and-turned",
        "ANGLE: y flip",
        "Everything is drawn upside down, and windings turn with it.",
        draws(|draw| {
            for vertex in &mut draw.mesh.vertices {
                vertex.position[1] = -vertex.position[1];
            }
        }),
    );
}

fn vertex_depth(list: &mut List) {
    let depths = |bug: fn(f32) -> f32| {
        draws(move |draw| {
            for vertex in &mut draw.mesh.vertices {
                vertex.position[2] = bug(vertex.position[2]);
            }
        })
    };
    list.add(
        "depth-from-minus-one",
        "OpenGL's depth range of -1 to 1",
        "Vertex depths are mapped from -1 to 1.",
        depths(|z| z * 0.5 + 0.5),
    );
    list.add(
        "depth-reversed",
        "llvmpipe: reversed depth range",
        "Vertex depths are reversed.",
        depths(|z| 1.0 - z),
    );
    list.add(
        "depth-zero",
        CONFUSION,
        "Vertex depths are 0.",
        depths(|_| 0.0),
    );
    list.add(
        "depth-in-8-bits",
        SMALL,
        "Vertex depths keep 8 bits.",
        depths(|z| in_bits(z, 8)),
    );
    list.add(
        "depth-in-16-bits",
        SMALL,
        "Vertex depths keep 16 bits.",
        depths(|z| in_bits(z, 16)),
    );
}
