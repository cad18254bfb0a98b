//! Bugs of discarding fragments.

use crate::hooks::kept;
use crate::list::bugs;

bugs! {
    class "discard", "texture";
    source "a wrong discard condition";
    "discard-off: No fragment is discarded." => kept(|_, _| true);
    "discard-at-threshold: A fragment whose alpha is the threshold is discarded." => kept(|value, limit| value > limit);
    "discard-inverted: Fragments are discarded from the threshold on." => kept(|value, limit| value < limit);
    "discard-in-8-bits: Alpha and threshold are compared as 8-bit codes." =>
        kept(|value, limit| (value * 255.0).round() >= (limit * 255.0).round());
    "discard-one-code-late: The threshold lies one 8-bit code too low." =>
        kept(|value, limit| value >= limit - 1.0 / 255.0);
}
