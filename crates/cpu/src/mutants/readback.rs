//! Bugs of what comes back.

use super::plant::{Plant, images, moved, nudge};
use super::{CONFUSION, List, SMALL};
use etalon_frame::{Aspect, Image};

const ASPECTS: [(Aspect, &str); 3] = [
    (Aspect::Color, "blend"),
    (Aspect::Depth, "depth"),
    (Aspect::Stencil, "stencil"),
];

/// Moves one channel of every texel by so many codes.
fn channel(aspect: Aspect, channel: usize, steps: i64) -> Plant {
    images(aspect, move |image| {
        let n = image.channels.len();
        for texel in image.codes.chunks_exact_mut(n) {
            texel[channel] = nudge(image.channels[channel], texel[channel], steps);
        }
    })
}

/// Moves the first channel of one texel by so many codes, inwards from an end of its range.
fn one_texel(
    aspect: Aspect,
    steps: i64,
    at: impl Fn(&Image) -> usize + Send + Sync + 'static,
) -> Plant {
    images(aspect, move |image| {
        let place = at(image) * image.channels.len();
        let encoding = image.channels[0];
        let code = image.codes[place];
        let up = nudge(encoding, code, steps);
        image.codes[place] = if up == code {
            nudge(encoding, code, -steps)
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
                image.codes.chunks_exact_mut(4).for_each(|t| t.swap(a, b));
            }),
        );
    }
    for (name, code) in [("alpha-one", 255), ("alpha-zero", 0)] {
        list.add(
            name,
            CONFUSION,
            format!("Every alpha comes back as code {code}."),
            images(Aspect::Color, move |image| {
                image.codes.chunks_exact_mut(4).for_each(|t| t[3] = code);
            }),
        );
    }
    list.class("readback", "stencil");
    list.add(
        "stencil-zero",
        CONFUSION,
        "Stencil comes back as 0.",
        images(Aspect::Stencil, |image| image.codes.fill(0)),
    );
    list.add(
        "stencil-highest-bit-lost",
        SMALL,
        "Stencil comes back without its highest bit.",
        images(Aspect::Stencil, |image| {
            image.codes.iter_mut().for_each(|c| *c &= 0x7f);
        }),
    );
    list.add(
        "stencil-lowest-bit-lost",
        SMALL,
        "Stencil comes back without its lowest bit.",
        images(Aspect::Stencil, |image| {
            image.codes.iter_mut().for_each(|c| *c &= 0xfe);
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
            format!("The {name} image comes back {about}."),
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
