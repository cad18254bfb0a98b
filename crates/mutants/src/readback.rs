//! Bugs of read-back.

use crate::list::{SMALL, STEPS, bugs};
use crate::plant::{Plant, images, move_texels, moved, nudge};
use crate::tables::CHANNELS;
use etalon_frame::{Aspect, ChannelEncoding, Image};

/// Returns the texel to read instead of a texel, given its position and the size.
type From = fn([u32; 2], [u32; 2]) -> [u32; 2];

const RIGHT: From = |[x, y], _| [x.saturating_sub(1), y];
const DOWN: From = |[x, y], _| [x, y.saturating_sub(1)];
const UPSIDE_DOWN: From = |[x, y], [_, h]| [x, h - 1 - y];

/// Moves a code by a number of steps; depths stay at least 0, since no depth is negative.
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
    texels(aspect, move |texel, encodings| {
        if let Some(encoding) = encodings.get(channel) {
            texel[channel] = held(aspect, *encoding, texel[channel], steps);
        }
    })
}

/// Changes the codes of every texel, given the encodings of the channels.
fn texels(
    aspect: Aspect,
    bug: impl Fn(&mut [u32], &[ChannelEncoding]) + Send + Sync + 'static,
) -> Plant {
    images(aspect, move |image| {
        let texels = image.codes.chunks_exact_mut(image.channels.len());
        texels.for_each(|texel| bug(texel, &image.channels));
    })
}

/// Moves a code by a number of steps, in the direction in which its range allows it.
fn inwards(aspect: Aspect, image: &mut Image, place: usize, steps: i64) {
    let (encoding, code) = (image.channels[0], image.codes[place]);
    let ways = [steps, -steps].map(|steps| held(aspect, encoding, code, steps));
    image.codes[place] = if ways[0] == code { ways[1] } else { ways[0] };
}

/// Permutes the samples of every texel: each sample gets the codes of sample `from(sample, samples)`.
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

/// Moves the texels of one sample: each texel gets the codes of texel `from([x, y], size)`.
fn plane(aspect: Aspect, which: fn(usize) -> usize, from: From) -> Plant {
    images(aspect, move |image| {
        let original = image.codes.clone();
        let (n, samples) = (image.channels.len(), image.samples as usize);
        move_texels(image, from);
        let moved = image.codes.chunks_exact_mut(n);
        for (number, (moved, original)) in moved.zip(original.chunks_exact(n)).enumerate() {
            if samples == 1 || number % samples != which(samples) {
                moved.copy_from_slice(original);
            }
        }
    })
}

/// Returns the number of codes per texel.
fn codes(image: &Image) -> usize {
    image.channels.len() * image.samples as usize
}

bugs! {
    for (aspect, area) in [(Aspect::Color, "blend"), (Aspect::Depth, "depth"), (Aspect::Stencil, "stencil")] {
        class "readback", area;
        let name = aspect.name();
        "{name}-upside-down: The {name} image is read back upside down." =>
            moved(aspect, UPSIDE_DOWN), source "ANGLE: y flip breaking depth and stencil";
        source "a shift of one texel, which dEQP's groups do not see in depth and stencil";
        for (bug, about, from as From) in [
            ("one-texel-right", "one texel right", RIGHT),
            ("one-texel-left", "one texel left", |[x, y], _| [x + 1, y]),
            ("one-texel-down", "one texel down", DOWN),
            ("one-texel-up", "one texel up", |[x, y], _| [x, y + 1]),
            ("mirrored", "mirrored", |[x, y], [w, _]| [w - 1 - x, y]),
            ("last-row-repeated", "with the last row repeated", |[x, y], [_, h]| [x, y.min(h.saturating_sub(2))]),
            ("last-column-repeated", "with the last column repeated", |[x, y], [w, _]| [x.min(w.saturating_sub(2)), y]),
        ] {
            "{name}-{bug}: The {name} image is read back {about}." => moved(aspect, from);
        }
        source SMALL;
        for (which, texel as fn(&Image) -> u32) in [
            ("first", |_| 0),
            ("middle", |i| (i.size[1] / 2) * i.size[0] + i.size[0] / 2),
            ("last", |i| i.size[0] * i.size[1] - 1),
        ] {
            for (by, steps) in [("one-lsb", 1), ("three-lsb", 3)] {
                "{name}-{which}-texel-off-by-{by}: The {which} texel of {name} is {steps} codes off." =>
                    images(aspect, move |i| inwards(aspect, i, texel(i) as usize * codes(i), steps));
            }
        }
        if (aspect != Aspect::Color) {
            for (by, steps) in STEPS {
                "{name}-{by}-lsb: Every {name} is {steps} codes off, within its range." => channel(aspect, 0, steps);
            }
        }
        class "readback", "multisample";
        source "a wrong sample index";
        for (bug, about, from as fn(usize, usize) -> usize) in [
            ("neighbouring-samples-swapped", "neighbouring samples swapped", |s, n| (s ^ 1) % n),
            ("samples-reversed", "samples reversed", |s, n| n - 1 - s),
            ("first-sample-for-all", "first sample for all", |_, _| 0),
            ("samples-one-late", "samples one late", |s, n| (s + n - 1) % n),
        ] {
            "{name}-{bug}: The {name} image is read back with {about}." => samples(aspect, from);
        }
        source SMALL;
        "{name}-last-sample-upside-down: The last sample of {name} is read back upside down." =>
            plane(aspect, |n| n - 1, UPSIDE_DOWN);
        "{name}-second-sample-one-texel-right: The second sample of {name} is read back one texel right." =>
            plane(aspect, |_| 1, RIGHT);
        "{name}-first-sample-one-texel-down: The first sample of {name} is read back one texel down." =>
            plane(aspect, |_| 0, DOWN);
        "{name}-last-sample-off-by-one-lsb: The last sample of {name} is one code off." =>
            images(aspect, move |i| if i.samples > 1 { inwards(aspect, i, i.codes.len() - i.channels.len(), 1) });
    }
    class "readback", "blend";
    for c in [0, 1, 2, 3] {
        let name = CHANNELS[c];
        for (by, steps) in STEPS {
            "{name}-{by}-lsb: Every {name} is {steps} codes off, within its range." =>
                channel(Aspect::Color, c, steps), source SMALL;
        }
    }
    for (name, a, b) in [("red-blue", 0, 2), ("red-green", 0, 1), ("green-alpha", 1, 3)] {
        "{name}-swapped: Channels {name} are exchanged." =>
            texels(Aspect::Color, move |t, _| if b < t.len() { t.swap(a, b) });
    }
    for (name, alpha) in [("alpha-one", 1.0), ("alpha-zero", 0.0)] {
        "{name}: Every alpha is read back as {alpha}." =>
            texels(Aspect::Color, move |t, e| if t.len() > 3 { t[3] = e[3].nearest_code(alpha) });
    }
    class "readback", "stencil";
    "stencil-zero: Stencil is read back as 0." => texels(Aspect::Stencil, |s, _| s.fill(0));
    source SMALL;
    "stencil-highest-bit-lost: Stencil is read back without its highest bit." =>
        texels(Aspect::Stencil, |s, _| s[0] &= 0x7f);
    "stencil-lowest-bit-lost: Stencil is read back without its lowest bit." =>
        texels(Aspect::Stencil, |s, _| s[0] &= 0xfe);
}
