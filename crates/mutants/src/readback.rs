//! Bugs of read-back.

use super::list::{CONFUSION, List, Row, SMALL};
use super::plant::{Plant, images, moved, nudge};
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

/// Moves the first channel of one texel by a number of codes, inwards from an end of its range.
fn one_texel(
    aspect: Aspect,
    steps: i64,
    at: impl Fn(&Image) -> usize + Send + Sync + 'static,
) -> Plant {
    images(aspect, move |image| {
        let place = at(image) * image.channels.len() * image.samples as usize;
        let encoding = image.channels[0];
        let code = image.codes[place];
        let up = held(aspect, encoding, code, steps);
        image.codes[place] = if up == code {
            held(aspect, encoding, code, -steps)
        } else {
            up
        };
    })
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
        for (by, steps) in [
            ("plus-1", 1),
            ("minus-1", -1),
            ("plus-3", 3),
            ("minus-3", -3),
        ] {
            list.add(
                &format!("{name}-{by}-lsb"),
                SMALL,
                format!("Every {name} is {steps} codes off, within its range."),
                channel(Aspect::Color, c, steps),
            );
        }
    }
    let swaps: [(&str, usize, usize); 3] = [
        ("red-blue", 0, 2),
        ("red-green", 0, 1),
        ("green-alpha", 1, 3),
    ];
    for (name, a, b) in swaps {
        list.add(
            &format!("{name}-swapped"),
            CONFUSION,
            format!("Channels {name} are exchanged."),
            images(Aspect::Color, move |image| {
                let n = image.channels.len();
                if b < n {
                    image.codes.chunks_exact_mut(n).for_each(|t| t.swap(a, b));
                }
            }),
        );
    }
    for (name, alpha) in [("alpha-one", 1.0), ("alpha-zero", 0.0)] {
        list.add(
            name,
            CONFUSION,
            format!("Every alpha is read back as {alpha}."),
            images(Aspect::Color, move |image| {
                if let Some(encoding) = image.channels.get(3) {
                    let code = encoding.nearest_code(alpha);
                    image.codes.chunks_exact_mut(4).for_each(|t| t[3] = code);
                }
            }),
        );
    }
    list.class("readback", "stencil");
    list.add(
        "stencil-zero",
        CONFUSION,
        "Stencil is read back as 0.",
        images(Aspect::Stencil, |image| image.codes.fill(0)),
    );
    list.add(
        "stencil-highest-bit-lost",
        SMALL,
        "Stencil is read back without its highest bit.",
        images(Aspect::Stencil, |image| {
            image.codes.iter_mut().for_each(|c| *c &= 0x7f);
        }),
    );
    list.add(
        "stencil-lowest-bit-lost",
        SMALL,
        "Stencil is read back without its lowest bit.",
        images(Aspect::Stencil, |image| {
            image.codes.iter_mut().for_each(|c| *c &= 0xfe);
        }),
    );
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

/// Moves the texels of one sample: each gets the codes of texel `from([x, y], size)`.
fn plane(aspect: Aspect, which: fn(u32) -> u32, from: fn([u32; 2], [u32; 2]) -> [u32; 2]) -> Plant {
    images(aspect, move |image| {
        let original = image.clone();
        let (n, sample) = (image.channels.len(), which(image.samples));
        let [width, height] = image.size;
        if image.samples == 1 {
            return;
        }
        for y in 0..height {
            for x in 0..width {
                let at = ((y * width + x) * image.samples + sample) as usize * n;
                let [from_x, from_y] = from([x, y], image.size);
                let codes = original.sample(from_x.min(width - 1), from_y.min(height - 1), sample);
                image.codes[at..at + n].copy_from_slice(codes);
            }
        }
    })
}

/// Bugs of images with several samples per texel.
fn multisampled(list: &mut List, aspect: Aspect) {
    let name = aspect.name();
    type Order = fn(usize, usize) -> usize;
    let orders: [Row<Order>; 4] = [
        (
            "neighbouring-samples-swapped",
            "with every two samples exchanged",
            |s, n| (s ^ 1) % n,
        ),
        (
            "samples-reversed",
            "with its samples in reverse order",
            |s, n| n - 1 - s,
        ),
        (
            "first-sample-for-all",
            "with the first sample for all",
            |_, _| 0,
        ),
        (
            "samples-one-late",
            "with each sample in the place of the next",
            |s, n| (s + n - 1) % n,
        ),
    ];
    for (bug, about, from) in orders {
        list.add(
            &format!("{name}-{bug}"),
            "a wrong sample index",
            format!("The {name} image is read back {about}."),
            samples(aspect, from),
        );
    }
    type Plane = (
        &'static str,
        &'static str,
        fn(u32) -> u32,
        fn([u32; 2], [u32; 2]) -> [u32; 2],
    );
    let planes: [Plane; 3] = [
        (
            "last-sample-upside-down",
            "upside down",
            |n| n - 1,
            |[x, y], [_, h]| [x, h - 1 - y],
        ),
        (
            "second-sample-one-texel-right",
            "one texel to the right",
            |_| 1,
            |[x, y], _| [x.saturating_sub(1), y],
        ),
        (
            "first-sample-one-texel-down",
            "one texel down",
            |_| 0,
            |[x, y], _| [x, y.saturating_sub(1)],
        ),
    ];
    for (bug, about, which, from) in planes {
        list.add(
            &format!("{name}-{bug}"),
            SMALL,
            format!("One sample of the {name} image is read back {about}."),
            plane(aspect, which, from),
        );
    }
    list.add(
        &format!("{name}-last-sample-off-by-one-lsb"),
        SMALL,
        format!("The last sample of the {name} image's last texel is one code off."),
        images(aspect, move |image| {
            if image.samples > 1 {
                let at = image.codes.len() - image.channels.len();
                let encoding = image.channels[0];
                let up = held(aspect, encoding, image.codes[at], 1);
                image.codes[at] = if up == image.codes[at] {
                    held(aspect, encoding, up, -1)
                } else {
                    up
                };
            }
        }),
    );
}

fn places(list: &mut List, aspect: Aspect) {
    let name = aspect.name();
    type From = fn([u32; 2], [u32; 2]) -> [u32; 2];
    let moves: [(&str, &str, From); 8] = [
        ("one-texel-right", "one texel to the right", |[x, y], _| {
            [x.saturating_sub(1), y]
        }),
        ("one-texel-left", "one texel to the left", |[x, y], _| {
            [x + 1, y]
        }),
        ("one-texel-down", "one texel down", |[x, y], _| {
            [x, y.saturating_sub(1)]
        }),
        ("one-texel-up", "one texel up", |[x, y], _| [x, y + 1]),
        ("upside-down", "upside down", |[x, y], [_, h]| {
            [x, h - 1 - y]
        }),
        ("mirrored", "mirrored", |[x, y], [w, _]| [w - 1 - x, y]),
        (
            "last-row-repeated",
            "with the row above in place of the last",
            |[x, y], [_, h]| [x, y.min(h - 2)],
        ),
        (
            "last-column-repeated",
            "with the column before in place of the last",
            |[x, y], [w, _]| [x.min(w - 2), y],
        ),
    ];
    for (bug, about, from) in moves {
        list.add(
            &format!("{name}-{bug}"),
            match bug {
                "upside-down" => "ANGLE: y flip breaking depth and stencil",
                _ => "a shift of one texel, which dEQP's groups do not see in depth and stencil",
            },
            format!("The {name} image is read back {about}."),
            moved(aspect, from),
        );
    }
    type At = fn(&Image) -> usize;
    let texels: [(&str, At); 3] = [
        ("first", |_| 0),
        ("middle", |i| {
            ((i.size[1] / 2) * i.size[0] + i.size[0] / 2) as usize
        }),
        ("last", |i| (i.size[0] * i.size[1]) as usize - 1),
    ];
    for (which, at) in texels {
        for (by, steps) in [("one-lsb", 1), ("three-lsb", 3)] {
            list.add(
                &format!("{name}-{which}-texel-off-by-{by}"),
                SMALL,
                format!("The {which} texel of the {name} image is {steps} codes off."),
                one_texel(aspect, steps, at),
            );
        }
    }
    if aspect != Aspect::Color {
        for (by, steps) in [
            ("plus-1", 1),
            ("minus-1", -1),
            ("plus-3", 3),
            ("minus-3", -3),
        ] {
            list.add(
                &format!("{name}-{by}-lsb"),
                SMALL,
                format!("Every {name} is {steps} codes off, within its range."),
                channel(aspect, 0, steps),
            );
        }
    }
}
