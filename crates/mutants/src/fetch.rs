//! Bugs of fetches.

use crate::hooks::fetch;
use crate::list::List;

pub(super) fn add(list: &mut List) {
    list.class("fetch", "blend");
    list.bug("one-texel-right: Texels are fetched one too far to the right.")
        .plant(fetch(|[x, y], _| [x + 1, y]));
    list.bug("one-texel-down: Texels are fetched one too far down.")
        .plant(fetch(|[x, y], _| [x, y + 1]));
    list.bug("upside-down: Texels are fetched upside down.")
        .plant(fetch(|[x, y], [_, h]| [x, (h - 1).saturating_sub(y)]));
    list.bug("first-texel-alone: The first texel is fetched everywhere.")
        .plant(fetch(|_, _| [0, 0]));
    list.bug("transposed: Columns are fetched for rows.")
        .plant(fetch(|[x, y], _| [y, x]));
}
