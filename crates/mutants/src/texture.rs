//! Bugs of textures that shaders sample.

use super::list::{CONFUSION, List, SMALL};
use super::plant::{Plant, draws, scene};
use etalon_scene::{AddressMode, Contents, FilterMode};

pub(super) fn add(list: &mut List) {
    list.class("texture", "texture");
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
