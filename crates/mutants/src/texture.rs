//! Bugs of textures that shaders sample.

use crate::fields::{Places, SAMPLER};
use crate::list::{CONFUSION, List, SMALL};
use crate::plant::{Plant, scene};
use crate::tables::pairs;
use etalon_scene::{AddressMode, Contents, Draw, FilterMode};
use std::collections::BTreeSet;

pub(super) fn add(list: &mut List) {
    list.class("texture", "texture");
    drawn(list);
    list.source(CONFUSION);
    for (right, wrong) in pairs(AddressMode::ALL) {
        for (axis, word) in ["across", "down"].into_iter().enumerate() {
            list.bug(format!(
                "{right}-as-{wrong}-{word}: Going {word}, {right} is {wrong}."
            ))
            .each(SAMPLER, move |sampler| {
                if sampler.address[axis] == right {
                    sampler.address[axis] = wrong;
                }
            });
        }
    }
    list.bug("address-axes-exchanged: The address modes of the two axes are exchanged.")
        .each(SAMPLER, |sampler| sampler.address.reverse());
    list.bug("linear-as-nearest: Every filter is nearest.")
        .each(SAMPLER, |sampler| sampler.filter = FilterMode::Nearest);
    list.bug("nearest-as-linear: Every filter is linear.")
        .each(SAMPLER, |sampler| sampler.filter = FilterMode::Linear);
    list.bug("upside-down: Textures stand upside down.")
        .each(COORDINATES, |[_, v]| *v = 1.0 - *v);
    list.bug("mirrored: Textures are mirrored.")
        .each(COORDINATES, |[u, _]| *u = 1.0 - *u);
    list.bug("axes-exchanged: The texture coordinates are exchanged.")
        .each(COORDINATES, |uv| uv.reverse());
    list.bug("half-texel-of-16: Coordinates lie half a 16th off.")
        .each(COORDINATES, |[u, _]| *u += 1.0 / 32.0);
    list.bug("red-and-blue-exchanged: Red and blue of sampled textures are exchanged.")
        .source("formats mistaken for each other")
        .plant(texels(|_, texel| {
            if texel.len() > 2 {
                texel.swap(0, 2);
            }
        }));
    list.bug("alpha-lost: Sampled textures are opaque.")
        .plant(texels(|_, texel| {
            texel.iter_mut().skip(3).for_each(|alpha| *alpha = 255)
        }));
    list.bug("premultiplied: The colours of sampled textures are multiplied by alpha.")
        .plant(texels(|_, texel| {
            if let [colors @ .., alpha] = texel
                && colors.len() == 3
            {
                colors
                    .iter_mut()
                    .for_each(|color| *color = *color * *alpha / 255);
            }
        }));
    list.bug("one-texel-wrong: The first texel of sampled textures is another.")
        .source(SMALL)
        .plant(texels(|number, texel| {
            texel[0] ^= if number == 0 { 0xff } else { 0 }
        }));
}

/// The texture coordinates of draws that sample.
const COORDINATES: Places<[f32; 2]> = |d| {
    let samples = d.shader.samples_texture();
    let vertices = d.mesh.vertices.iter_mut().filter(|_| samples);
    vertices.map(|v| &mut v.uv).collect()
};

/// Changes draws that sample what an earlier pass drew, given the size of the texture.
fn samplers_of_drawn(bug: fn(&mut Draw, [u32; 2])) -> Plant {
    scene(move |scene| {
        let sizes: Vec<[u32; 2]> = scene.attachments.iter().map(|a| a.size).collect();
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

/// Bugs of textures that were drawn, which those of uploaded ones do not show.
fn drawn(list: &mut List) {
    list.source("a texture of a framebuffer treated unlike an uploaded one");
    list.bug("drawn-upside-down: A sampler sees drawn textures upside down.")
        .plant(samplers_of_drawn(|draw, _| {
            draw.mesh
                .vertices
                .iter_mut()
                .for_each(|v| v.uv[1] = 1.0 - v.uv[1]);
        }));
    list.bug("drawn-next-texel: A sampler takes the texel to the right in drawn textures.")
        .plant(samplers_of_drawn(|draw, [width, _]| {
            draw.mesh
                .vertices
                .iter_mut()
                .for_each(|v| v.uv[0] += 1.0 / width as f32);
        }));
    list.bug("drawn-half-texel: A sampler of drawn textures counts from the first texel's centre.")
        .plant(samplers_of_drawn(|draw, size| {
            for vertex in &mut draw.mesh.vertices {
                vertex.uv[0] -= 0.5 / size[0] as f32;
                vertex.uv[1] -= 0.5 / size[1] as f32;
            }
        }));
    list.bug("drawn-clamped: A sampler clamps drawn textures to their edge.")
        .plant(samplers_of_drawn(|draw, _| {
            let samplers = draw.sampler.iter_mut();
            samplers.for_each(|s| s.address = [AddressMode::ClampToEdge; 2]);
        }));
    list.bug("drawn-filtered: Drawn textures are filtered linearly.")
        .plant(samplers_of_drawn(|draw, _| {
            draw.sampler
                .iter_mut()
                .for_each(|s| s.filter = FilterMode::Linear);
        }));
    list.bug("drawn-too-late: A sampler sees what a texture held before the first pass.")
        .passes(|scene, number, pass| {
            let later = scene.passes.iter().skip(1).flat_map(|p| &p.draws);
            let mut read = later
                .filter(|d| d.sampler.is_some())
                .flat_map(|d| &d.textures);
            if number == 0 && read.any(|t| pass.color.contains(t)) {
                pass.draws.clear();
            }
        });
}

/// Changes every texel of the textures that some draw samples, given its number.
fn texels(bug: fn(usize, &mut [u32])) -> Plant {
    scene(move |scene| {
        let draws = scene.passes.iter().flat_map(|p| &p.draws);
        let sampling = draws.filter(|d| d.shader.samples_texture());
        let sampled: BTreeSet<usize> = sampling.flat_map(|d| d.textures.clone()).collect();
        for texture in sampled {
            let attachment = &mut scene.attachments[texture];
            let channels = attachment.format.color_channels().len();
            if let Contents::Texels(codes) = &mut attachment.contents {
                let texels = codes.chunks_exact_mut(channels).enumerate();
                texels.for_each(|(number, texel)| bug(number, texel));
            }
        }
    })
}
