//! Bugs of clear values.

use super::hooks::{clear_code, code};
use super::list::{CONFUSION, List, SMALL};
use super::plant::{Plant, in_bits, nudge, scene};
use etalon_frame::ChannelEncoding;
use etalon_scene::Contents;

const ROUNDED: &str = "Vulkan: Fundamentals, Conversion from Floating-Point to Normalized \
                       Fixed-Point: one of the two closest values, the nearest only recommended";

fn colors(bug: impl Fn(&mut [f32; 4]) + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        for attachment in &mut scene.attachments {
            if let Contents::Color(color) = &mut attachment.contents {
                bug(color);
            }
        }
    })
}

fn depths_and_stencils(bug: impl Fn(&mut f32, &mut u8) + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        for attachment in &mut scene.attachments {
            if let Contents::DepthStencil { depth, stencil } = &mut attachment.contents {
                bug(depth, stencil);
            }
        }
    })
}

/// True if an encoding is one of depth. Colours of 32-bit floats count as depths too.
fn is_depth(encoding: ChannelEncoding) -> bool {
    matches!(
        encoding,
        ChannelEncoding::Unorm(16 | 24) | ChannelEncoding::Float32
    )
}

pub(super) fn add(list: &mut List) {
    list.class("clear", "blend");
    color(list);
    list.class("clear", "depth");
    depth(list);
    list.class("clear", "stencil");
    stencil(list);
}

fn color(list: &mut List) {
    for (name, lsb) in [
        ("plus-1", 1),
        ("minus-1", -1),
        ("plus-3", 3),
        ("minus-3", -3),
    ] {
        list.add(
            &format!("color-{name}-lsb"),
            SMALL,
            format!("Cleared colours are {lsb} codes off, within their range."),
            clear_code(move |encoding, v| {
                let right = code(encoding, v);
                if is_depth(encoding) {
                    right
                } else {
                    nudge(encoding, right, lsb)
                }
            }),
        );
    }
    list.add(
        "color-ignored",
        CONFUSION,
        "Colour starts from 0.",
        colors(|color| *color = [0.0; 4]),
    );
    list.add(
        "alpha-ignored",
        CONFUSION,
        "Cleared alpha is 1.",
        colors(|color| color[3] = 1.0),
    );
    list.add(
        "alpha-zero",
        CONFUSION,
        "Cleared alpha is 0.",
        colors(|color| color[3] = 0.0),
    );
    list.add(
        "color-red-blue-swapped",
        CONFUSION,
        "Cleared red and blue are exchanged.",
        colors(|color| color.swap(0, 2)),
    );
    list.add(
        "color-channels-reversed",
        CONFUSION,
        "Cleared channels stand in reverse order.",
        colors(|color| color.reverse()),
    );
    list.add(
        "color-green-alpha-swapped",
        CONFUSION,
        "Cleared green and alpha are exchanged.",
        colors(|color| color.swap(1, 3)),
    );
    for bits in [5, 6, 7] {
        list.add(
            &format!("color-in-{bits}-bits"),
            SMALL,
            format!("Cleared colours keep {bits} bits."),
            colors(move |color| *color = color.map(|v| in_bits(v, bits))),
        );
    }
    list.add(
        "color-clamped-late",
        CONFUSION,
        "Cleared colours outside 0 to 1 wrap around instead of being clamped.",
        colors(|color| {
            *color = color.map(|v| {
                if (0.0..=1.0).contains(&v) {
                    v
                } else {
                    v - v.floor()
                }
            });
        }),
    );
    list.add(
        "color-encoded-as-srgb",
        "a linear format treated as sRGB",
        "Cleared colours are encoded as sRGB.",
        colors(|color| {
            for v in &mut color[..3] {
                *v = v.max(0.0).powf(1.0 / 2.2);
            }
        }),
    );
    for (name, up) in [("down", false), ("up", true)] {
        list.add(
            &format!("color-rounded-{name}"),
            "drivers differ in clear rounding: 0.3 becomes 76 or 77",
            format!("Cleared colours are rounded {name}."),
            clear_code(move |encoding, v| {
                let ChannelEncoding::Unorm(1..=10) = encoding else {
                    return code(encoding, v);
                };
                let exact = f64::from(v.clamp(0.0, 1.0)) * encoding.max_order() as f64;
                (if up { exact.ceil() } else { exact.floor() }) as u32
            }),
        )
        .legal(ROUNDED);
    }
}

fn depth(list: &mut List) {
    list.add(
        "depth-ignored",
        CONFUSION,
        "Depth starts from 1.",
        depths_and_stencils(|depth, _| *depth = 1.0),
    );
    list.add(
        "depth-zero",
        CONFUSION,
        "Depth starts from 0.",
        depths_and_stencils(|depth, _| *depth = 0.0),
    );
    list.add(
        "depth-inverted",
        CONFUSION,
        "Depth starts from 1 minus its clear value.",
        depths_and_stencils(|depth, _| *depth = 1.0 - *depth),
    );
    list.add(
        "depth-halved",
        "a depth range of -1 to 1",
        "Depth starts from its clear value mapped from -1 to 1.",
        depths_and_stencils(|depth, _| *depth = *depth * 0.5 + 0.5),
    );
    for bits in [8, 15, 16] {
        list.add(
            &format!("depth-in-{bits}-bits"),
            SMALL,
            format!("Cleared depths keep {bits} bits."),
            depths_and_stencils(move |depth, _| *depth = in_bits(*depth, bits)),
        );
    }
    list.add(
        "depth-one-code-up",
        SMALL,
        "Cleared depths are one code too large.",
        clear_code(|encoding, v| {
            let right = code(encoding, v);
            nudge(encoding, right, i64::from(is_depth(encoding) && v < 1.0))
        }),
    );
    list.add(
        "depth-one-code-down",
        SMALL,
        "Cleared depths are one code too small.",
        clear_code(|encoding, v| {
            let right = code(encoding, v);
            nudge(encoding, right, -i64::from(is_depth(encoding) && v > 0.0))
        }),
    );
    list.add(
        "depth-rounded-down",
        "truncation instead of rounding",
        "Cleared depths are rounded down.",
        clear_code(|encoding, v| match encoding {
            ChannelEncoding::Unorm(16 | 24) => {
                (f64::from(v) * encoding.max_order() as f64).floor() as u32
            }
            _ => code(encoding, v),
        }),
    )
    .legal(ROUNDED);
    list.add(
        "depth-lost-with-stencil",
        CONFUSION,
        "A clear value of stencil other than 0 resets depth to 1.",
        depths_and_stencils(|depth, stencil| {
            if *stencil != 0 {
                *depth = 1.0;
            }
        }),
    );
}

fn stencil(list: &mut List) {
    type Bug = (&'static str, &'static str, fn(u8) -> u8);
    let bugs: [Bug; 6] = [
        ("stencil-ignored", "Stencil starts from 0.", |_| 0),
        (
            "stencil-in-7-bits",
            "Cleared stencil loses its highest bit.",
            |s| s & 0x7f,
        ),
        (
            "stencil-in-4-bits",
            "Cleared stencil loses its upper four bits.",
            |s| s & 0x0f,
        ),
        (
            "stencil-plus-1",
            "Cleared stencil is one too large, round the end.",
            |s| s.wrapping_add(1),
        ),
        (
            "stencil-inverted",
            "Cleared stencil's bits are inverted.",
            |s| !s,
        ),
        (
            "stencil-all-ones",
            "A cleared stencil other than 0 becomes 255.",
            |s| {
                if s == 0 { 0 } else { 255 }
            },
        ),
    ];
    for (name, about, bug) in bugs {
        list.add(
            name,
            CONFUSION,
            about,
            depths_and_stencils(move |_, stencil| *stencil = bug(*stencil)),
        );
    }
    list.add(
        "stencil-lost-with-depth",
        CONFUSION,
        "A clear value of depth other than 1 resets stencil to 0.",
        depths_and_stencils(|depth, stencil| {
            if *depth != 1.0 {
                *stencil = 0;
            }
        }),
    );
}
