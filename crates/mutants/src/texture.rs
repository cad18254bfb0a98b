//! Bugs of textures that shaders sample.

use crate::fields::{FieldPlaces, SAMPLER};
use crate::list::{CONFUSION, SMALL, bugs};
use crate::plant::{Plant, each, passes, scene};
use crate::tables::pairs;
use etalon_scene::{AddressMode, AttachmentContents, Draw, FilterMode};
use std::collections::BTreeSet;

/// The texture coordinates of draws that sample textures.
const COORDINATES: FieldPlaces<[f32; 2]> = |d| {
    let samples = d.shader.samples_texture();
    let vertices = d.mesh.vertices.iter_mut().filter(|_| samples);
    vertices.map(|v| &mut v.uv).collect()
};

/// Changes draws that sample a texture that an earlier pass drew, given its size.
fn of_drawn(bug: fn(&mut Draw, [f32; 2])) -> Plant {
    scene(move |scene| {
        let sizes = scene.attachments.iter().map(|a| a.size.map(|s| s as f32));
        let sizes: Vec<[f32; 2]> = sizes.collect();
        let mut drawn: Vec<usize> = Vec::new();
        for pass in &mut scene.passes {
            for draw in &mut pass.draws {
                let read = draw.textures.iter().find(|t| drawn.contains(t));
                if let (Some(texture), true) = (read, draw.sampler.is_some()) {
                    bug(draw, sizes[*texture]);
                }
            }
            drawn.extend(&pass.color);
        }
    })
}

/// Changes every texel of the textures that a draw samples, given its index.
fn texels(bug: fn(usize, &mut [u32])) -> Plant {
    scene(move |scene| {
        let draws = scene.passes.iter().flat_map(|p| &p.draws);
        let sampling = draws.filter(|d| d.shader.samples_texture());
        let sampled: BTreeSet<usize> = sampling.flat_map(|d| d.textures.clone()).collect();
        for texture in sampled {
            let attachment = &mut scene.attachments[texture];
            let channels = attachment.format.color_channels().len();
            if let AttachmentContents::Texels(codes) = &mut attachment.contents {
                let texels = codes.chunks_exact_mut(channels).enumerate();
                texels.for_each(|(number, texel)| bug(number, texel));
            }
        }
    })
}

bugs! {
    class "texture", "texture";

    // Bugs of drawn textures, which uploaded textures do not show.
    source "a texture of a framebuffer treated unlike an uploaded one";
    "drawn-upside-down: A sampler sees drawn textures upside down." =>
        of_drawn(|draw, _| draw.mesh.vertices.iter_mut().for_each(|v| v.uv[1] = 1.0 - v.uv[1]));
    "drawn-next-texel: A sampler takes the texel to the right in drawn textures." =>
        of_drawn(|draw, [width, _]| draw.mesh.vertices.iter_mut().for_each(|v| v.uv[0] += 1.0 / width));
    "drawn-half-texel: A sampler of drawn textures counts from the first texel's centre." =>
        of_drawn(|draw, [w, h]| draw.mesh.vertices.iter_mut().for_each(|v| {
            v.uv = [v.uv[0] - 0.5 / w, v.uv[1] - 0.5 / h];
        }));
    "drawn-clamped: A sampler clamps drawn textures to their edge." =>
        of_drawn(|draw, _| draw.sampler.iter_mut().for_each(|s| s.address = [AddressMode::ClampToEdge; 2]));
    "drawn-filtered: Drawn textures are filtered linearly." =>
        of_drawn(|draw, _| draw.sampler.iter_mut().for_each(|s| s.filter = FilterMode::Linear));
    "drawn-too-late: A sampler sees what a texture held before the first pass." =>
        passes(|scene, number, pass| {
            let later = scene.passes.iter().skip(1).flat_map(|p| &p.draws);
            let mut read = later.filter(|d| d.sampler.is_some()).flat_map(|d| &d.textures);
            if number == 0 && read.any(|t| pass.color.contains(t)) { pass.draws.clear(); }
        });
    source CONFUSION;
    for (axis, word) in [(0, "across"), (1, "down")] {
        let pairs = pairs(AddressMode::ALL);
        for (right, wrong) in pairs {
            "{right}-as-{wrong}-{word}: Going {word}, {right} is {wrong}." =>
                each(SAMPLER, move |sampler| if sampler.address[axis] == right { sampler.address[axis] = wrong });
        }
    }
    "address-axes-exchanged: The address modes of the two axes are exchanged." =>
        each(SAMPLER, |sampler| sampler.address.reverse());
    "linear-as-nearest: Every filter is nearest." => each(SAMPLER, |sampler| sampler.filter = FilterMode::Nearest);
    "nearest-as-linear: Every filter is linear." => each(SAMPLER, |sampler| sampler.filter = FilterMode::Linear);
    "upside-down: Textures stand upside down." => each(COORDINATES, |[_, v]| *v = 1.0 - *v);
    "mirrored: Textures are mirrored." => each(COORDINATES, |[u, _]| *u = 1.0 - *u);
    "axes-exchanged: The texture coordinates are exchanged." => each(COORDINATES, |uv| uv.reverse());
    "half-texel-of-16: Coordinates lie half a 16th off." => each(COORDINATES, |[u, _]| *u += 1.0 / 32.0);
    "red-and-blue-exchanged: Red and blue of sampled textures are exchanged." =>
        texels(|_, texel| if texel.len() > 2 { texel.swap(0, 2) }), source "formats mistaken for each other";
    "alpha-lost: Sampled textures are opaque." =>
        texels(|_, texel| texel.iter_mut().skip(3).for_each(|alpha| *alpha = 255));
    "premultiplied: The colours of sampled textures are multiplied by alpha." =>
        texels(|_, texel| if let [r, g, b, alpha] = texel {
            [r, g, b].into_iter().for_each(|color| *color = *color * *alpha / 255);
        });
    "one-texel-wrong: The first texel of sampled textures is another." =>
        texels(|number, texel| texel[0] ^= if number == 0 { 0xff } else { 0 }), source SMALL;
}
