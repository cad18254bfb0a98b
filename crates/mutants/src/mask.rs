//! Bugs of the colour write mask.

use crate::list::List;
use crate::plant::{Plant, draws};

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
        list.bug(format!(
            "{name}: Two channels' bits of the write mask are exchanged."
        ))
        .plant(masks(move |mask| exchanged(mask, a, b)));
    }
    list.bug("ignored: All channels are written.")
        .plant(masks(|_| 0xf));
    list.bug("zero-still-writes: A write mask of 0 writes all channels.")
        .source("SwiftShader: write mask 0 still writing")
        .plant(masks(|mask| if mask == 0 { 0xf } else { mask }));
    list.bug("alpha-always: Alpha is always written.")
        .plant(masks(|mask| mask | 8));
    list.bug("alpha-never: Alpha is never written.")
        .plant(masks(|mask| mask & 7));
    list.bug("inverted: The bits mean their opposite.")
        .plant(masks(|mask| !mask));
    list.bug("any-is-all-colors: Any of red, green and blue writes all three.")
        .source("one bit for all three colour channels")
        .plant(masks(|mask| if mask & 7 == 0 { mask } else { mask | 7 }));
    list.bug("partial-is-nothing: A partial mask writes nothing.")
        .plant(masks(|mask| if mask == 0xf { mask } else { 0 }));
    list.bug("ignored-without-blending: All channels are written where nothing is blended.")
        .draws(|draw| {
            for target in draw.targets.iter_mut().filter(|t| t.blend.is_none()) {
                target.write_mask = 0xf;
            }
        });
    list.bug("ignored-with-blending: All channels are written where something is blended.")
        .draws(|draw| {
            for target in draw.targets.iter_mut().filter(|t| t.blend.is_some()) {
                target.write_mask = 0xf;
            }
        });
}
