//! Bugs of fetches.

use super::hooks::fetch;
use super::list::{CONFUSION, List};

pub(super) fn add(list: &mut List) {
    list.class("fetch", "blend");
    type From = fn([u32; 2], [u32; 2]) -> [u32; 2];
    let fetches: [(&str, &str, From); 5] = [
        (
            "one-texel-right",
            "Texels are fetched one too far to the right.",
            |[x, y], _| [x + 1, y],
        ),
        (
            "one-texel-down",
            "Texels are fetched one too far down.",
            |[x, y], _| [x, y + 1],
        ),
        (
            "upside-down",
            "Texels are fetched upside down.",
            |[x, y], [_, h]| [x, (h - 1).saturating_sub(y)],
        ),
        (
            "first-texel-alone",
            "The first texel is fetched everywhere.",
            |_, _| [0, 0],
        ),
        (
            "transposed",
            "Columns are fetched for rows.",
            |[x, y], _| [y, x],
        ),
    ];
    for (name, about, bug) in fetches {
        list.add(name, CONFUSION, about, fetch(bug));
    }
}
