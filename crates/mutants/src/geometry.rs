//! Bugs of coverage, positions and whole draws.

use crate::fields::{FRONT_FACE, Places};
use crate::hooks::covered;
use crate::list::{CONFUSION, List, SMALL};
use crate::plant::in_bits;
use crate::tables::turned;
use etalon_scene::Vertex;

const VERTICES: Places<Vertex> = |d| d.mesh.vertices.iter_mut().collect();

pub(super) fn add(list: &mut List) {
    list.class("geometry", "blend");
    coverage(list);
    draws(list);
    positions(list);
    list.class("geometry", "depth");
    depths(list);
}

fn coverage(list: &mut List) {
    list.source(SMALL);
    list.bug("last-column-missing: The last column is not drawn.")
        .plant(covered(|[x, _], [w, _]| x + 1 < w));
    list.bug("last-row-missing: The last row is not drawn.")
        .plant(covered(|[_, y], [_, h]| y + 1 < h));
    list.bug("first-column-missing: The first column is not drawn.")
        .plant(covered(|[x, _], _| x > 0));
    list.bug("first-row-missing: The first row is not drawn.")
        .plant(covered(|[_, y], _| y > 0));
    list.bug("first-texel-missing: The first texel is not drawn.")
        .plant(covered(|texel, _| texel != [0, 0]));
    list.bug("last-texel-missing: The last texel is not drawn.")
        .plant(covered(|[x, y], [w, h]| x + 1 < w || y + 1 < h));
    list.bug("middle-texel-missing: The middle texel is not drawn.")
        .plant(covered(|texel, size| {
            texel != size.map(|length| length / 2)
        }));
}

fn draws(list: &mut List) {
    list.source(CONFUSION);
    list.bug("first-triangle-lost: The first triangle of every draw is lost.")
        .draws(|draw| {
            let n = draw.mesh.vertices.len().min(3);
            draw.mesh.vertices.drain(..n);
        });
    list.bug("last-triangle-lost: The last triangle of every draw is lost.")
        .draws(|draw| {
            let n = draw.mesh.vertices.len();
            draw.mesh.vertices.truncate(n.saturating_sub(3));
        });
    list.bug("last-draw-lost: The last draw of every pass is lost.")
        .passes(|_, _, pass| drop(pass.draws.pop()));
    list.bug("draws-reversed: Draws are carried out in reverse order.")
        .passes(|_, _, pass| pass.draws.reverse());
    list.bug("last-draw-twice: The last draw of every pass is carried out twice.")
        .passes(|_, _, pass| pass.draws.extend(pass.draws.last().cloned()));
}

fn positions(list: &mut List) {
    for (name, right, down) in [
        ("right", 1.0, 0.0),
        ("left", -1.0, 0.0),
        ("down", 0.0, 1.0),
        ("up", 0.0, -1.0),
    ] {
        for (by, about, texels, source) in [
            ("one-texel", "one texel", 1.0, SMALL),
            (
                "half-texel",
                "half a texel",
                0.51,
                "texel centres at integers, as in Direct3D 9",
            ),
        ] {
            let shift = [right * texels, down * texels];
            list.bug(format!("{by}-{name}: Everything is drawn {about} off."))
                .source(source)
                .passes(move |scene, _, pass| {
                    let Some(target) = pass.color.first().copied().or(pass.depth_stencil) else {
                        return;
                    };
                    let [width, height] = scene.attachments[target].size.map(|s| s as f32);
                    for vertex in pass.draws.iter_mut().flat_map(VERTICES) {
                        vertex.position[0] += 2.0 * shift[0] / width * vertex.position[3];
                        vertex.position[1] -= 2.0 * shift[1] / height * vertex.position[3];
                    }
                });
        }
    }
    list.source("ANGLE: y flip");
    list.bug("upside-down: Everything is drawn upside down, windings kept.")
        .draws(|draw| {
            VERTICES(draw)
                .into_iter()
                .for_each(|v| v.position[1] *= -1.0);
            FRONT_FACE(draw)
                .into_iter()
                .for_each(|face| *face = turned(*face));
        });
    list.bug("upside-down-and-turned: Everything is drawn upside down, and windings turn with it.")
        .each(VERTICES, |v| v.position[1] *= -1.0);
}

fn depths(list: &mut List) {
    let mut add = |text: &str, source, bug: fn(f32) -> f32| {
        let depths = move |v: &mut Vertex| v.position[2] = bug(v.position[2]);
        list.bug(text).source(source).each(VERTICES, depths);
    };
    add(
        "depth-from-minus-one: Vertex depths are mapped from -1 to 1.",
        "OpenGL's depth range of -1 to 1",
        |z| z * 0.5 + 0.5,
    );
    add(
        "depth-reversed: Vertex depths are reversed.",
        "llvmpipe: reversed depth range",
        |z| 1.0 - z,
    );
    add("depth-zero: Vertex depths are 0.", CONFUSION, |_| 0.0);
    add("depth-in-8-bits: Vertex depths keep 8 bits.", SMALL, |z| {
        in_bits(z, 8)
    });
    add(
        "depth-in-16-bits: Vertex depths keep 16 bits.",
        SMALL,
        |z| in_bits(z, 16),
    );
}
