//! Bugs of textures that shaders sample.

use super::list::{CONFUSION, List, SMALL};
use super::plant::{Plant, draws, scene};
use etalon_scene::{AddressMode, Contents, Draw, FilterMode};

pub(super) fn add(list: &mut List) {
    list.class("texture", "texture");
    drawn(list);
    for right in AddressMode::ALL {
        for wrong in AddressMode::ALL.iter().filter(|w| *w != right) {
            for (axis, word) in ["across", "down"].into_iter().enumerate() {
                list.add(
                    &format!("{}-as-{}-{word}", right.name(), wrong.name()),
                    CONFUSION,
                    format!("Going {word}, {} is {}.", right.name(), wrong.name()),
                    draws(move |draw| {
                        if let Some(sampler) = &mut draw.sampler
                            && sampler.address[axis] == *right
                        {
                            sampler.address[axis] = *wrong;
                        }
                    }),
                );
            }
        }
    }
    list.add(
        "address-axes-exchanged",
        CONFUSION,
        "The address modes of the two axes are exchanged.",
        draws(|draw| {
            if let Some(sampler) = &mut draw.sampler {
                sampler.address.reverse();
            }
        }),
    );
    for (name, wrong) in [
        ("linear-as-nearest", FilterMode::Nearest),
        ("nearest-as-linear", FilterMode::Linear),
    ] {
        list.add(
            name,
            CONFUSION,
            format!("Every filter is {}.", wrong.name()),
            draws(move |draw| {
                if let Some(sampler) = &mut draw.sampler {
                    sampler.filter = wrong;
                }
            }),
        );
    }
    let turn = |name: &str, list: &mut List, about: &str, bug: fn([f32; 2]) -> [f32; 2]| {
        list.add(name, CONFUSION, about, coordinates(bug));
    };
    turn(
        "upside-down",
        list,
        "Textures stand upside down.",
        |[u, v]| [u, 1.0 - v],
    );
    turn("mirrored", list, "Textures are mirrored.", |[u, v]| {
        [1.0 - u, v]
    });
    turn(
        "axes-exchanged",
        list,
        "The texture coordinates are exchanged.",
        |[u, v]| [v, u],
    );
    turn(
        "half-texel-of-16",
        list,
        "Coordinates lie half a 16th off.",
        |[u, v]| [u + 1.0 / 32.0, v],
    );
    list.add(
        "red-and-blue-exchanged",
        "formats mistaken for each other",
        "Red and blue of sampled textures are exchanged.",
        texels(|texel| {
            if texel.len() > 2 {
                texel.swap(0, 2);
            }
        }),
    );
    list.add(
        "alpha-lost",
        CONFUSION,
        "Sampled textures are opaque.",
        texels(|texel| {
            if let Some(alpha) = texel.get_mut(3) {
                *alpha = 255;
            }
        }),
    );
    list.add(
        "premultiplied",
        CONFUSION,
        "The colours of sampled textures are multiplied by alpha.",
        texels(|texel| {
            if let [r, g, b, a] = texel {
                for color in [r, g, b] {
                    *color = *color * *a / 255;
                }
            }
        }),
    );
    list.add(
        "one-texel-wrong",
        SMALL,
        "The first texel of sampled textures is another.",
        scene(|scene| {
            for texture in sampled(scene) {
                if let Contents::Texels(codes) = &mut scene.attachments[texture].contents {
                    codes[0] ^= 0xff;
                }
            }
        }),
    );
}

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
    let source = "a texture of a framebuffer treated unlike an uploaded one";
    list.add(
        "drawn-upside-down",
        source,
        "A sampler sees drawn textures upside down.",
        samplers_of_drawn(|draw, _| {
            for vertex in &mut draw.mesh.vertices {
                vertex.uv[1] = 1.0 - vertex.uv[1];
            }
        }),
    );
    list.add(
        "drawn-next-texel",
        source,
        "A sampler takes the texel to the right of the nearest one of drawn textures.",
        samplers_of_drawn(|draw, [width, _]| {
            for vertex in &mut draw.mesh.vertices {
                vertex.uv[0] += 1.0 / width as f32;
            }
        }),
    );
    list.add(
        "drawn-half-texel",
        source,
        "A sampler of drawn textures counts from the first texel's centre.",
        samplers_of_drawn(|draw, [width, height]| {
            for vertex in &mut draw.mesh.vertices {
                vertex.uv[0] -= 0.5 / width as f32;
                vertex.uv[1] -= 0.5 / height as f32;
            }
        }),
    );
    list.add(
        "drawn-clamped",
        source,
        "A sampler clamps drawn textures to their edge.",
        samplers_of_drawn(|draw, _| {
            if let Some(sampler) = &mut draw.sampler {
                sampler.address = [AddressMode::ClampToEdge; 2];
            }
        }),
    );
    list.add(
        "drawn-filtered",
        source,
        "Drawn textures are filtered linearly.",
        samplers_of_drawn(|draw, _| {
            if let Some(sampler) = &mut draw.sampler {
                sampler.filter = FilterMode::Linear;
            }
        }),
    );
    list.add(
        "drawn-too-late",
        source,
        "A sampler sees what a texture held before the first pass drew to it.",
        scene(|scene| {
            let Some(first) = scene.passes.first().map(|p| p.color.clone()) else {
                return;
            };
            let mut later = scene.passes.iter().skip(1).flat_map(|p| &p.draws);
            if later.any(|d| d.sampler.is_some() && d.textures.iter().any(|t| first.contains(t))) {
                scene.passes[0].draws.clear();
            }
        }),
    );
}

/// Changes the texture coordinates of sampled textures.
fn coordinates(bug: fn([f32; 2]) -> [f32; 2]) -> Plant {
    draws(move |draw| {
        if draw.shader.samples_texture() {
            for vertex in &mut draw.mesh.vertices {
                vertex.uv = bug(vertex.uv);
            }
        }
    })
}

/// The attachments that some draw samples.
fn sampled(scene: &etalon_scene::Scene) -> Vec<usize> {
    let draws = scene.passes.iter().flat_map(|p| &p.draws);
    let mut all: Vec<usize> = draws
        .filter(|d| d.shader.samples_texture())
        .flat_map(|d| d.textures.iter().copied())
        .collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Changes every texel of sampled textures.
fn texels(bug: fn(&mut [u32])) -> Plant {
    scene(move |scene| {
        for texture in sampled(scene) {
            let attachment = &mut scene.attachments[texture];
            let channels = attachment.format.color_channels().len();
            if let Contents::Texels(codes) = &mut attachment.contents {
                codes.chunks_exact_mut(channels).for_each(bug);
            }
        }
    })
}
