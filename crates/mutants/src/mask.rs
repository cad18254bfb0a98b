//! Bugs of the colour write mask.

use super::list::{CONFUSION, List};
use super::plant::{Plant, draws};

fn masks(bug: impl Fn(u8) -> u8 + Send + Sync + 'static) -> Plant {
    draws(move |draw| {
        for target in &mut draw.targets {
            target.write_mask = bug(target.write_mask) & 0xf;
        }
    })
}

/// The mask with two of its bits exchanged.
fn exchanged(mask: u8, a: u8, b: u8) -> u8 {
    let bit = |n: u8| mask >> n & 1;
    (mask & !(1 << a | 1 << b)) | bit(a) << b | bit(b) << a
}

pub(super) fn add(list: &mut List) {
    list.class("write-mask", "blend");
    for (name, a, b) in [
        ("red-blue-swapped", 0, 2),
        ("red-green-swapped", 0, 1),
        ("green-blue-swapped", 1, 2),
        ("red-alpha-swapped", 0, 3),
        ("green-alpha-swapped", 1, 3),
        ("blue-alpha-swapped", 2, 3),
    ] {
        list.add(
            name,
            CONFUSION,
            "Two channels' bits of the write mask are exchanged.",
            masks(move |mask| exchanged(mask, a, b)),
        );
    }
    list.add(
        "ignored",
        CONFUSION,
        "All channels are written.",
        masks(|_| 0xf),
    );
    list.add(
        "zero-still-writes",
        "SwiftShader: write mask 0 still writing",
        "A write mask of 0 writes all channels.",
        masks(|mask| if mask == 0 { 0xf } else { mask }),
    );
    list.add(
        "alpha-always",
        CONFUSION,
        "Alpha is always written.",
        masks(|mask| mask | 8),
    );
    list.add(
        "alpha-never",
        CONFUSION,
        "Alpha is never written.",
        masks(|mask| mask & 7),
    );
    list.add(
        "inverted",
        CONFUSION,
        "The bits mean their opposite.",
        masks(|mask| !mask),
    );
    list.add(
        "any-is-all-colors",
        "one bit for all three colour channels",
        "Any of red, green and blue writes all three.",
        masks(|mask| if mask & 7 == 0 { mask } else { mask | 7 }),
    );
    list.add(
        "partial-is-nothing",
        CONFUSION,
        "A partial mask writes nothing.",
        masks(|mask| if mask == 0xf { mask } else { 0 }),
    );
    list.add(
        "ignored-without-blending",
        CONFUSION,
        "All channels are written where nothing is blended.",
        draws(|draw| {
            for target in draw.targets.iter_mut().filter(|t| t.blend.is_none()) {
                target.write_mask = 0xf;
            }
        }),
    );
    list.add(
        "ignored-with-blending",
        CONFUSION,
        "All channels are written where something is blended.",
        draws(|draw| {
            for target in draw.targets.iter_mut().filter(|t| t.blend.is_some()) {
                target.write_mask = 0xf;
            }
        }),
    );
}
