//! Bugs of clear values.

use crate::hooks::{clear_code, code};
use crate::list::{CONFUSION, SMALL, STEPS, bugs, rounded};
use crate::plant::{Plant, contents, in_bits, nudge};
use etalon_frame::ChannelEncoding::{self, Float32, Unorm};
use etalon_scene::AttachmentContents;

fn colors(bug: impl Fn(&mut [f32; 4]) + Send + Sync + 'static) -> Plant {
    contents(move |attachment| {
        if let AttachmentContents::Color(color) = &mut attachment.contents {
            bug(color);
        }
    })
}

fn depths_and_stencils(bug: impl Fn(&mut f32, &mut u8) + Send + Sync + 'static) -> Plant {
    contents(move |attachment| {
        if let AttachmentContents::DepthStencil { depth, stencil } = &mut attachment.contents {
            bug(depth, stencil);
        }
    })
}

/// Moves the codes of some encodings and values by a number of steps.
fn off(steps: i64, rounded: fn(ChannelEncoding, f32) -> bool) -> Plant {
    clear_code(move |e, v| nudge(e, code(e, v), if rounded(e, v) { steps } else { 0 }))
}

/// Returns true for encodings of depth. Colours of 32-bit floats count as depths too.
fn is_depth(encoding: ChannelEncoding) -> bool {
    matches!(encoding, Unorm(16 | 24) | Float32)
}

fn stencils(bug: fn(u8) -> u8) -> Plant {
    depths_and_stencils(move |_, stencil| *stencil = bug(*stencil))
}

bugs! {
    class "clear", "blend";
    source SMALL;
    for (name, steps) in STEPS {
        "color-{name}-lsb: Cleared colours are {steps} codes off, within their range." =>
            off(steps, |encoding, _| !is_depth(encoding));
    }
    for bits in [5, 6, 7] {
        "color-in-{bits}-bits: Cleared colours keep {bits} bits." =>
            colors(move |color| *color = color.map(|v| in_bits(v, bits)));
    }
    source CONFUSION;
    "color-ignored: Colour starts from 0." => colors(|color| *color = [0.0; 4]);
    "alpha-ignored: Cleared alpha is 1." => colors(|color| color[3] = 1.0);
    "alpha-zero: Cleared alpha is 0." => colors(|color| color[3] = 0.0);
    "color-red-blue-swapped: Cleared red and blue are exchanged." => colors(|color| color.swap(0, 2));
    "color-channels-reversed: Cleared channels stand in reverse order." => colors(|color| color.reverse());
    "color-green-alpha-swapped: Cleared green and alpha are exchanged." => colors(|color| color.swap(1, 3));
    "color-clamped-late: Cleared colours outside 0 to 1 wrap around." =>
        colors(|color| {
            let outside = |v: f32| !(0.0..=1.0).contains(&v);
            *color = color.map(|v| if outside(v) { v - v.floor() } else { v });
        });
    "color-encoded-as-srgb: Cleared colours are encoded as sRGB." =>
        colors(|color| { for v in &mut color[..3] { *v = v.max(0.0).powf(1.0 / 2.2); } }),
        source "a linear format treated as sRGB";
    for (name, round as fn(f64) -> f64) in [("down", f64::floor), ("up", f64::ceil)] {
        "color-rounded-{name}: Cleared colours are rounded {name}." =>
            clear_code(move |encoding, v| match encoding {
                Unorm(1..=10) => {
                    round(f64::from(v.clamp(0.0, 1.0)) * encoding.max_order() as f64) as u32
                }
                _ => code(encoding, v),
            }), source "drivers differ in clear rounding: 0.3 becomes 76 or 77", permitted rounded();
    }
    class "clear", "depth";
    "depth-ignored: Depth starts from 1." => depths_and_stencils(|depth, _| *depth = 1.0);
    "depth-zero: Depth starts from 0." => depths_and_stencils(|depth, _| *depth = 0.0);
    "depth-inverted: Depth starts from 1 minus its clear value." =>
        depths_and_stencils(|depth, _| *depth = 1.0 - *depth);
    "depth-halved: Depth starts from its clear value mapped from -1 to 1." =>
        depths_and_stencils(|depth, _| *depth = *depth * 0.5 + 0.5), source "a depth range of -1 to 1";
    "depth-lost-with-stencil: A clear value of stencil other than 0 resets depth to 1." =>
        depths_and_stencils(|depth, stencil| if *stencil != 0 { *depth = 1.0 });
    source SMALL;
    for bits in [8, 15, 16] {
        "depth-in-{bits}-bits: Cleared depths keep {bits} bits." =>
            depths_and_stencils(move |depth, _| *depth = in_bits(*depth, bits));
    }
    "depth-one-code-up: Cleared depths are one code too large." => off(1, |encoding, v| is_depth(encoding) && v < 1.0);
    "depth-one-code-down: Cleared depths are one code too small." =>
        off(-1, |encoding, v| is_depth(encoding) && v > 0.0);
    "depth-rounded-down: Cleared depths are rounded down." =>
        clear_code(|encoding, v| match encoding {
            Unorm(16 | 24) => (f64::from(v) * encoding.max_order() as f64).floor() as u32,
            _ => code(encoding, v),
        }), source "truncation instead of rounding", permitted rounded();
    class "clear", "stencil";
    "stencil-ignored: Stencil starts from 0." => stencils(|_| 0);
    "stencil-in-7-bits: Cleared stencil loses its highest bit." => stencils(|s| s & 0x7f);
    "stencil-in-4-bits: Cleared stencil loses its upper four bits." => stencils(|s| s & 0x0f);
    "stencil-plus-1: Cleared stencil is one too large, round the end." => stencils(|s| s.wrapping_add(1));
    "stencil-inverted: Cleared stencil's bits are inverted." => stencils(|s| !s);
    "stencil-all-ones: A cleared stencil other than 0 becomes 255." => stencils(|s| if s == 0 { 0 } else { 255 });
    "stencil-lost-with-depth: A clear value of depth other than 1 resets stencil to 0." =>
        depths_and_stencils(|depth, stencil| if *depth != 1.0 { *stencil = 0 });
}
