//! Bugs of discarding fragments.

use super::hooks::kept;
use super::list::{List, Row};
use super::plant::Plant;

pub(super) fn add(list: &mut List) {
    list.class("discard", "texture");
    discards(list);
}

fn discards(list: &mut List) {
    type Keeps = fn(f32, f32) -> bool;
    let rows: [Row<Keeps>; 5] = [
        ("discard-off", "No fragment is discarded.", |_, _| true),
        (
            "discard-at-threshold",
            "A fragment whose alpha is the threshold is discarded.",
            |value, limit| value > limit,
        ),
        (
            "discard-inverted",
            "Fragments are discarded from the threshold on.",
            |value, limit| value < limit,
        ),
        (
            "discard-in-8-bits",
            "Alpha and threshold are compared as 8-bit codes.",
            |value, limit| (value * 255.0).round() >= (limit * 255.0).round(),
        ),
        (
            "discard-one-code-late",
            "The threshold lies one 8-bit code too low.",
            |value, limit| value >= limit - 1.0 / 255.0,
        ),
    ];
    fn plant(bug: Keeps) -> Plant {
        kept(bug)
    }
    list.rows("a wrong discard condition", plant, &rows);
}
