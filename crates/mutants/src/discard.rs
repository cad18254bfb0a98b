//! Bugs of discarding fragments.

use crate::hooks::kept;
use crate::list::{CONFUSION, List};
use crate::plant::Plant;

pub(super) fn add(list: &mut List) {
    list.class("discard", "texture");
    type Keeps = fn(f32, f32) -> bool;

    fn plant(bug: Keeps) -> Plant {
        kept(bug)
    }
    list.source("a wrong discard condition");
    list.bug("discard-off: No fragment is discarded.")
        .plant(plant(|_, _| true));
    list.bug("discard-at-threshold: A fragment whose alpha is the threshold is discarded.")
        .plant(plant(|value, limit| value > limit));
    list.bug("discard-inverted: Fragments are discarded from the threshold on.")
        .plant(plant(|value, limit| value < limit));
    list.bug("discard-in-8-bits: Alpha and threshold are compared as 8-bit codes.")
        .plant(plant(|value, limit| {
            (value * 255.0).round() >= (limit * 255.0).round()
        }));
    list.bug("discard-one-code-late: The threshold lies one 8-bit code too low.")
        .plant(plant(|value, limit| value >= limit - 1.0 / 255.0));
    list.source(CONFUSION);
}
