//! Bugs of clear values.

use crate::hooks::{clear_code, code};
use crate::list::{CONFUSION, List, ROUNDED, SMALL, STEPS};
use crate::plant::{Plant, contents, in_bits, nudge};
use etalon_frame::ChannelEncoding::{self, Float32, Unorm};
use etalon_scene::Contents;

fn colors(bug: impl Fn(&mut [f32; 4]) + Send + Sync + 'static) -> Plant {
    contents(move |attachment| {
        if let Contents::Color(color) = &mut attachment.contents {
            bug(color);
        }
    })
}

fn depths_and_stencils(bug: impl Fn(&mut f32, &mut u8) + Send + Sync + 'static) -> Plant {
    contents(move |attachment| {
        if let Contents::DepthStencil { depth, stencil } = &mut attachment.contents {
            bug(depth, stencil);
        }
    })
}

/// Moves the codes of some encodings and values.
fn off(steps: i64, rounded: fn(ChannelEncoding, f32) -> bool) -> Plant {
    clear_code(move |e, v| nudge(e, code(e, v), if rounded(e, v) { steps } else { 0 }))
}

/// True if an encoding is one of depth. Colours of 32-bit floats count as depths too.
fn is_depth(encoding: ChannelEncoding) -> bool {
    matches!(encoding, Unorm(16 | 24) | Float32)
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
    list.source(SMALL);
    for (name, steps) in STEPS {
        list.bug(format!(
            "color-{name}-lsb: Cleared colours are {steps} codes off, within their range."
        ))
        .plant(off(steps, |encoding, _| !is_depth(encoding)));
    }
    for bits in [5, 6, 7] {
        list.bug(format!(
            "color-in-{bits}-bits: Cleared colours keep {bits} bits."
        ))
        .plant(colors(move |color| {
            *color = color.map(|v| in_bits(v, bits))
        }));
    }
    list.source(CONFUSION);
    list.bug("color-ignored: Colour starts from 0.")
        .plant(colors(|color| *color = [0.0; 4]));
    list.bug("alpha-ignored: Cleared alpha is 1.")
        .plant(colors(|color| color[3] = 1.0));
    list.bug("alpha-zero: Cleared alpha is 0.")
        .plant(colors(|color| color[3] = 0.0));
    list.bug("color-red-blue-swapped: Cleared red and blue are exchanged.")
        .plant(colors(|color| color.swap(0, 2)));
    list.bug("color-channels-reversed: Cleared channels stand in reverse order.")
        .plant(colors(|color| color.reverse()));
    list.bug("color-green-alpha-swapped: Cleared green and alpha are exchanged.")
        .plant(colors(|color| color.swap(1, 3)));
    list.bug("color-clamped-late: Cleared colours outside 0 to 1 wrap around.")
        .plant(colors(|color| {
            let outside = |v: f32| !(0.0..=1.0).contains(&v);
            *color = color.map(|v| if outside(v) { v - v.floor() } else { v });
        }));
    list.bug("color-encoded-as-srgb: Cleared colours are encoded as sRGB.")
        .source("a linear format treated as sRGB")
        .plant(colors(|color| {
            for v in &mut color[..3] {
                *v = v.max(0.0).powf(1.0 / 2.2);
            }
        }));
    type Round = fn(f64) -> f64;
    let rounds: [(&str, Round); 2] = [("down", f64::floor), ("up", f64::ceil)];
    for (name, round) in rounds {
        list.bug(format!(
            "color-rounded-{name}: Cleared colours are rounded {name}."
        ))
        .source("drivers differ in clear rounding: 0.3 becomes 76 or 77")
        .legal(ROUNDED)
        .plant(clear_code(move |encoding, v| match encoding {
            Unorm(1..=10) => {
                round(f64::from(v.clamp(0.0, 1.0)) * encoding.max_order() as f64) as u32
            }
            _ => code(encoding, v),
        }));
    }
}

fn depth(list: &mut List) {
    list.bug("depth-ignored: Depth starts from 1.")
        .plant(depths_and_stencils(|depth, _| *depth = 1.0));
    list.bug("depth-zero: Depth starts from 0.")
        .plant(depths_and_stencils(|depth, _| *depth = 0.0));
    list.bug("depth-inverted: Depth starts from 1 minus its clear value.")
        .plant(depths_and_stencils(|depth, _| *depth = 1.0 - *depth));
    list.bug("depth-halved: Depth starts from its clear value mapped from -1 to 1.")
        .source("a depth range of -1 to 1")
        .plant(depths_and_stencils(|depth, _| *depth = *depth * 0.5 + 0.5));
    list.bug("depth-lost-with-stencil: A clear value of stencil other than 0 resets depth to 1.")
        .plant(depths_and_stencils(|depth, stencil| {
            if *stencil != 0 {
                *depth = 1.0;
            }
        }));
    list.source(SMALL);
    for bits in [8, 15, 16] {
        list.bug(format!(
            "depth-in-{bits}-bits: Cleared depths keep {bits} bits."
        ))
        .plant(depths_and_stencils(move |depth, _| {
            *depth = in_bits(*depth, bits)
        }));
    }
    list.bug("depth-one-code-up: Cleared depths are one code too large.")
        .plant(off(1, |encoding, v| is_depth(encoding) && v < 1.0));
    list.bug("depth-one-code-down: Cleared depths are one code too small.")
        .plant(off(-1, |encoding, v| is_depth(encoding) && v > 0.0));
    list.bug("depth-rounded-down: Cleared depths are rounded down.")
        .source("truncation instead of rounding")
        .legal(ROUNDED)
        .plant(clear_code(|encoding, v| match encoding {
            Unorm(16 | 24) => (f64::from(v) * encoding.max_order() as f64).floor() as u32,
            _ => code(encoding, v),
        }));
}

fn stencil(list: &mut List) {
    fn stencils(bug: fn(u8) -> u8) -> Plant {
        depths_and_stencils(move |_, stencil| *stencil = bug(*stencil))
    }
    list.bug("stencil-ignored: Stencil starts from 0.")
        .plant(stencils(|_| 0));
    list.bug("stencil-in-7-bits: Cleared stencil loses its highest bit.")
        .plant(stencils(|s| s & 0x7f));
    list.bug("stencil-in-4-bits: Cleared stencil loses its upper four bits.")
        .plant(stencils(|s| s & 0x0f));
    list.bug("stencil-plus-1: Cleared stencil is one too large, round the end.")
        .plant(stencils(|s| s.wrapping_add(1)));
    list.bug("stencil-inverted: Cleared stencil's bits are inverted.")
        .plant(stencils(|s| !s));
    list.bug("stencil-all-ones: A cleared stencil other than 0 becomes 255.")
        .plant(stencils(|s| if s == 0 { 0 } else { 255 }));
    list.bug("stencil-lost-with-depth: A clear value of depth other than 1 resets stencil to 0.")
        .plant(depths_and_stencils(|depth, stencil| {
            if *depth != 1.0 {
                *stencil = 0;
            }
        }));
}
