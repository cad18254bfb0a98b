//! Bugs of coverage, positions and whole draws.

use crate::fields::VERTICES;
use crate::hooks::covered;
use crate::list::{CONFUSION, SMALL, bugs};
use crate::plant::{calls, draws, each, in_bits, passes};
use crate::tables::turned;

bugs! {
    class "geometry", "blend";
    source SMALL;
    "last-column-missing: The last column is not drawn." => covered(|[x, _], [w, _]| x + 1 < w);
    "last-row-missing: The last row is not drawn." => covered(|[_, y], [_, h]| y + 1 < h);
    "first-column-missing: The first column is not drawn." => covered(|[x, _], _| x > 0);
    "first-row-missing: The first row is not drawn." => covered(|[_, y], _| y > 0);
    "first-texel-missing: The first texel is not drawn." => covered(|texel, _| texel != [0, 0]);
    "last-texel-missing: The last texel is not drawn." => covered(|[x, y], [w, h]| x + 1 < w || y + 1 < h);
    "middle-texel-missing: The middle texel is not drawn." =>
        covered(|texel, size| texel != size.map(|length| length / 2));
    source CONFUSION;
    "first-triangle-lost: The first triangle of every draw is lost." =>
        draws(|draw| { let n = draw.mesh.vertices.len().min(3); draw.mesh.vertices.drain(..n); });
    "last-triangle-lost: The last triangle of every draw is lost." =>
        draws(|draw| { let n = draw.mesh.vertices.len(); draw.mesh.vertices.truncate(n.saturating_sub(3)); });
    "last-draw-lost: The last draw of every pass is lost." => calls(|draws| drop(draws.pop()));
    "draws-reversed: Draws are carried out in reverse order." => calls(|draws| draws.reverse());
    "last-draw-twice: The last draw of every pass is carried out twice." =>
        calls(|draws| draws.extend(draws.last().cloned()));
    for (name, right, down) in [("right", 1.0, 0.0), ("left", -1.0, 0.0), ("down", 0.0, 1.0), ("up", 0.0, -1.0)] {
        for (by, about, texels, source) in [
            ("one-texel", "one texel", 1.0, SMALL),
            ("half-texel", "half a texel", 0.51, "texel centres at integers, as in Direct3D 9"),
        ] {
            let shift = [right * texels, down * texels];
            "{by}-{name}: Everything is drawn {about} off." =>
                passes(move |scene, _, pass| {
                    let Some(target) = pass.color.first().copied().or(pass.depth_stencil) else { return; };
                    let [width, height] = scene.attachments[target].size.map(|s| s as f32);
                    for vertex in pass.draws.iter_mut().flat_map(VERTICES) {
                        vertex.position[0] += 2.0 * shift[0] / width * vertex.position[3];
                        vertex.position[1] -= 2.0 * shift[1] / height * vertex.position[3];
                    }
                }), source source;
        }
    }
    source "ANGLE: y flip";
    "upside-down: Everything is drawn upside down, windings kept." =>
        draws(|draw| {
            VERTICES(draw).into_iter().for_each(|v| v.position[1] *= -1.0);
            draw.front_face = turned(draw.front_face);
        });
    "upside-down-and-turned: Everything is drawn upside down, and windings turn with it." =>
        each(VERTICES, |v| v.position[1] *= -1.0);
    class "geometry", "depth";
    "depth-from-minus-one: Vertex depths are mapped from -1 to 1." =>
        each(VERTICES, |v| v.position[2] = v.position[2] * 0.5 + 0.5), source "OpenGL's depth range of -1 to 1";
    "depth-reversed: Vertex depths are reversed." =>
        each(VERTICES, |v| v.position[2] = 1.0 - v.position[2]), source "llvmpipe: reversed depth range";
    "depth-zero: Vertex depths are 0." => each(VERTICES, |v| v.position[2] = 0.0);
    for bits in [8, 16] {
        "depth-in-{bits}-bits: Vertex depths keep {bits} bits." =>
            each(VERTICES, move |v| v.position[2] = in_bits(v.position[2], bits)), source SMALL;
    }
}
