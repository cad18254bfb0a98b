//! Bugs of fetches.

use crate::hooks::fetch;
use crate::list::bugs;

bugs! {
    class "fetch", "blend";
    "one-texel-right: Texels are fetched one too far to the right." => fetch(|[x, y], _| [x + 1, y]);
    "one-texel-down: Texels are fetched one too far down." => fetch(|[x, y], _| [x, y + 1]);
    "upside-down: Texels are fetched upside down." => fetch(|[x, y], [_, h]| [x, (h - 1).saturating_sub(y)]);
    "first-texel-alone: The first texel is fetched everywhere." => fetch(|_, _| [0, 0]);
    "transposed: Columns are fetched for rows." => fetch(|[x, y], _| [y, x]);
}
