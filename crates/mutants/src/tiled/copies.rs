//! Fetches and reads of large pictures.

use super::super::hooks::fetch;
use super::super::list::{CONFUSION, List};
use super::super::plant::moved;
use etalon_frame::Aspect;

pub(super) fn add(list: &mut List) {
    list.add(
        "fetch-in-6-bits",
        CONFUSION,
        "Texels are fetched at coordinates modulo 64.",
        fetch(|[x, y], _| [x % 64, y % 64]),
    );
    for (name, aspect) in [
        ("color", Aspect::Color),
        ("depth", Aspect::Depth),
        ("stencil", Aspect::Stencil),
    ] {
        list.add(
            &format!("{name}-read-at-pitch-of-64"),
            CONFUSION,
            format!("Rows of {name} are read at a pitch of whole blocks of 64 texels."),
            moved(aspect, |[x, y], [width, height]| {
                let at = y * width.next_multiple_of(64) + x;
                let at = at % (width * height);
                [at % width, at / width]
            }),
        );
    }
}
