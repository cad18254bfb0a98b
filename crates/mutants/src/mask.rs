//! Bugs of the colour write mask.

use crate::list::bugs;
use crate::plant::{Plant, draws};

fn masks(bug: impl Fn(u8) -> u8 + Send + Sync + 'static) -> Plant {
    draws(move |draw| {
        for target in &mut draw.targets {
            target.write_mask = bug(target.write_mask) & 0xf;
        }
    })
}

/// Returns the mask with two of its bits exchanged.
fn exchanged(mask: u8, a: u8, b: u8) -> u8 {
    let bit = |n: u8| mask >> n & 1;
    (mask & !(1 << a | 1 << b)) | bit(a) << b | bit(b) << a
}

bugs! {
    class "write-mask", "blend";
    for (name, a, b) in [
        ("red-blue-swapped", 0, 2),
        ("red-green-swapped", 0, 1),
        ("green-blue-swapped", 1, 2),
        ("red-alpha-swapped", 0, 3),
        ("green-alpha-swapped", 1, 3),
        ("blue-alpha-swapped", 2, 3),
    ] {
        "{name}: Two channels' bits of the write mask are exchanged." => masks(move |mask| exchanged(mask, a, b));
    }
    "ignored: All channels are written." => masks(|_| 0xf);
    "zero-still-writes: A write mask of 0 writes all channels." =>
        masks(|mask| if mask == 0 { 0xf } else { mask }), source "SwiftShader: write mask 0 still writing";
    "alpha-always: Alpha is always written." => masks(|mask| mask | 8);
    "alpha-never: Alpha is never written." => masks(|mask| mask & 7);
    "inverted: The bits mean their opposite." => masks(|mask| !mask);
    "any-is-all-colors: Any of red, green and blue writes all three." =>
        masks(|mask| if mask & 7 == 0 { mask } else { mask | 7 }), source "one bit for all three colour channels";
    "partial-is-nothing: A partial mask writes nothing." => masks(|mask| if mask == 0xf { mask } else { 0 });
    "ignored-without-blending: All channels are written where nothing is blended." =>
        draws(|draw| {
            for target in draw.targets.iter_mut().filter(|t| t.blend.is_none()) { target.write_mask = 0xf; }
        });
    "ignored-with-blending: All channels are written where something is blended." =>
        draws(|draw| {
            for target in draw.targets.iter_mut().filter(|t| t.blend.is_some()) { target.write_mask = 0xf; }
        });
}
