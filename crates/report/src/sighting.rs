//! A case that shows a planted bug, or accuses an innocent, on a page.

use etalon_record::Sighting;
use maud::{Markup, html};

/// Returns the case, with its first wrong texel.
pub(super) fn sighting(first: &Sighting) -> Markup {
    html! {
        code { (first.case) }
        @if let Some(texel) = &first.texel {
            small {
                " (" (texel.x) ", " (texel.y) ")"
                @if let Some(c) = texel.channels.first() {
                    " " (c.attachment) " " (c.aspect) " channel " (c.channel) ": " (c.actual)
                    ", due "
                    @if c.low == c.high { (c.low) } @else { (c.low) " to " (c.high) }
                }
            }
        }
        @if !first.message.is_empty() { small { " " (first.message) } }
    }
}
