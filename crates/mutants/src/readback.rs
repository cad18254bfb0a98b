//! Bugs of read-back.

use crate::list::{List, SMALL, STEPS};
use crate::plant::{Plant, images, move_texels, moved, nudge};
use etalon_frame::{Aspect, ChannelEncoding, Image};

const ASPECTS: [(Aspect, &str); 3] = [
    (Aspect::Color, "blend"),
    (Aspect::Depth, "depth"),
    (Aspect::Stencil, "stencil"),
];

/// Returns a code moved by a number of steps; depths stay above 0, since no depth is negative.
fn held(aspect: Aspect, encoding: ChannelEncoding, code: u32, steps: i64) -> u32 {
    let moved = nudge(encoding, code, steps);
    if aspect == Aspect::Depth && encoding.order_of_code(moved) < 0 {
        0
    } else {
        moved
    }
}

/// Moves one channel of every texel by a number of codes.
fn channel(aspect: Aspect, channel: usize, steps: i64) -> Plant {
    images(aspect, move |image| {
        let n = image.channels.len();
        if channel >= n {
            return;
        }
        for texel in image.codes.chunks_exact_mut(n) {
            texel[channel] = held(aspect, image.channels[channel], texel[channel], steps);
        }
    })
}

/// Moves a code by a number of steps, inwards from an end of its range.
fn inwards(aspect: Aspect, image: &mut Image, place: usize, steps: i64) {
    let (encoding, code) = (image.channels[0], image.codes[place]);
    let up = held(aspect, encoding, code, steps);
    image.codes[place] = if up == code {
        held(aspect, encoding, code, -steps)
    } else {
        up
    };
}

pub(super) fn add(list: &mut List) {
    for (aspect, area) in ASPECTS {
        list.class("readback", area);
        places(list, aspect);
    }
    list.class("readback", "multisample");
    for (aspect, _) in ASPECTS {
        multisampled(list, aspect);
    }
    list.class("readback", "blend");
    for (c, name) in ["red", "green", "blue", "alpha"].into_iter().enumerate() {
        for (by, steps) in STEPS {
            list.bug(format!(
                "{name}-{by}-lsb: Every {name} is {steps} codes off, within its range."
            ))
            .source(SMALL)
            .plant(channel(Aspect::Color, c, steps));
        }
    }
    let swaps: [(&str, usize, usize); 3] = [
        ("red-blue", 0, 2),
        ("red-green", 0, 1),
        ("green-alpha", 1, 3),
    ];
    for (name, a, b) in swaps {
        list.bug(format!("{name}-swapped: Channels {name} are exchanged."))
            .plant(images(Aspect::Color, move |image| {
                let n = image.channels.len();
                if b < n {
                    image.codes.chunks_exact_mut(n).for_each(|t| t.swap(a, b));
                }
            }));
    }
    for (name, alpha) in [("alpha-one", 1.0), ("alpha-zero", 0.0)] {
        list.bug(format!("{name}: Every alpha is read back as {alpha}."))
            .plant(images(Aspect::Color, move |image| {
                if let Some(encoding) = image.channels.get(3) {
                    let code = encoding.nearest_code(alpha);
                    image.codes.chunks_exact_mut(4).for_each(|t| t[3] = code);
                }
            }));
    }
    list.class("readback", "stencil");
    list.bug("stencil-zero: Stencil is read back as 0.")
        .plant(images(Aspect::Stencil, |image| image.codes.fill(0)));
    list.bug("stencil-highest-bit-lost: Stencil is read back without its highest bit.")
        .source(SMALL)
        .plant(images(Aspect::Stencil, |image| {
            image.codes.iter_mut().for_each(|c| *c &= 0x7f)
        }));
    list.bug("stencil-lowest-bit-lost: Stencil is read back without its lowest bit.")
        .source(SMALL)
        .plant(images(Aspect::Stencil, |image| {
            image.codes.iter_mut().for_each(|c| *c &= 0xfe)
        }));
}

/// Permutes the samples of every texel: each gets the codes of sample `from(sample, samples)`.
fn samples(aspect: Aspect, from: fn(usize, usize) -> usize) -> Plant {
    images(aspect, move |image| {
        let (n, samples) = (image.channels.len(), image.samples as usize);
        for texel in image.codes.chunks_exact_mut(n * samples) {
            let original = texel.to_vec();
            for (s, codes) in texel.chunks_exact_mut(n).enumerate() {
                let source = from(s, samples);
                codes.copy_from_slice(&original[source * n..(source + 1) * n]);
            }
        }
    })
}

/// A place of a texel, given its own and the size.
type From = fn([u32; 2], [u32; 2]) -> [u32; 2];

/// Moves the texels of one sample: each gets the codes of texel `from([x, y], size)`.
fn plane(aspect: Aspect, which: fn(usize) -> usize, from: From) -> Plant {
    images(aspect, move |image| {
        let original = image.codes.clone();
        let (n, samples) = (image.channels.len(), image.samples as usize);
        move_texels(image, from);
        let texels = image
            .codes
            .chunks_exact_mut(n)
            .zip(original.chunks_exact(n));
        for (number, (moved, original)) in texels.enumerate() {
            if samples == 1 || number % samples != which(samples) {
                moved.copy_from_slice(original);
            }
        }
    })
}

/// Bugs of images with several samples per texel.
fn multisampled(list: &mut List, aspect: Aspect) {
    let name = aspect.name();
    type Order = fn(usize, usize) -> usize;
    let orders: [(&str, Order); 4] = [
        ("neighbouring-samples-swapped", |s, n| (s ^ 1) % n),
        ("samples-reversed", |s, n| n - 1 - s),
        ("first-sample-for-all", |_, _| 0),
        ("samples-one-late", |s, n| (s + n - 1) % n),
    ];
    for (bug, from) in orders {
        let words = bug.replace('-', " ");
        list.bug(format!(
            "{name}-{bug}: The {name} image is read back with {words}."
        ))
        .source("a wrong sample index")
        .plant(samples(aspect, from));
    }
    type Plane = (&'static str, &'static str, fn(usize) -> usize, From);
    let planes: [Plane; 3] = [
        ("last", "upside-down", |n| n - 1, upside_down),
        ("second", "one-texel-right", |_| 1, right),
        ("first", "one-texel-down", |_| 0, down),
    ];
    for (sample, bug, which, from) in planes {
        let words = bug.replace('-', " ");
        list.bug(format!(
            "{name}-{sample}-sample-{bug}: The {sample} sample of {name} is read back {words}."
        ))
        .source(SMALL)
        .plant(plane(aspect, which, from));
    }
    list.bug(format!(
        "{name}-last-sample-off-by-one-lsb: The last sample of {name} is one code off."
    ))
    .source(SMALL)
    .plant(images(aspect, move |image| {
        if image.samples > 1 {
            inwards(aspect, image, image.codes.len() - image.channels.len(), 1);
        }
    }));
}

fn right([x, y]: [u32; 2], _: [u32; 2]) -> [u32; 2] {
    [x.saturating_sub(1), y]
}

fn down([x, y]: [u32; 2], _: [u32; 2]) -> [u32; 2] {
    [x, y.saturating_sub(1)]
}

fn upside_down([x, y]: [u32; 2], [_, h]: [u32; 2]) -> [u32; 2] {
    [x, h - 1 - y]
}

fn places(list: &mut List, aspect: Aspect) {
    let name = aspect.name();
    let moves: [(&str, From); 8] = [
        ("one-texel-right", right),
        ("one-texel-left", |[x, y], _| [x + 1, y]),
        ("one-texel-down", down),
        ("one-texel-up", |[x, y], _| [x, y + 1]),
        ("upside-down", upside_down),
        ("mirrored", |[x, y], [w, _]| [w - 1 - x, y]),
        ("last-row-repeated", |[x, y], [_, h]| {
            [x, y.min(h.saturating_sub(2))]
        }),
        ("last-column-repeated", |[x, y], [w, _]| {
            [x.min(w.saturating_sub(2)), y]
        }),
    ];
    for (bug, from) in moves {
        let words = bug.replace('-', " ").replace("last", "with the last");
        list.bug(format!(
            "{name}-{bug}: The {name} image is read back {words}."
        ))
        .source(match bug {
            "upside-down" => "ANGLE: y flip breaking depth and stencil",
            _ => "a shift of one texel, which dEQP's groups do not see in depth and stencil",
        })
        .plant(moved(aspect, from));
    }
    type At = fn([u32; 2]) -> u32;
    let texels: [(&str, At); 3] = [
        ("first", |_| 0),
        ("middle", |[w, h]| (h / 2) * w + w / 2),
        ("last", |[w, h]| w * h - 1),
    ];
    for (which, texel) in texels {
        for (by, steps) in [("one-lsb", 1), ("three-lsb", 3)] {
            list.bug(format!(
                "{name}-{which}-texel-off-by-{by}: The {which} texel of {name} is {steps} codes off."
            ))
            .source(SMALL)
            .plant(images(aspect, move |image| {
                let place = texel(image.size) as usize * image.channels.len() * image.samples as usize;
                inwards(aspect, image, place, steps);
            }));
        }
    }
    if aspect != Aspect::Color {
        for (by, steps) in STEPS {
            list.bug(format!(
                "{name}-{by}-lsb: Every {name} is {steps} codes off, within its range."
            ))
            .source(SMALL)
            .plant(channel(aspect, 0, steps));
        }
    }
}
