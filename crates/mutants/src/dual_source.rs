//! Bugs of the second source.

use crate::blend::{Input, before, factors};
use crate::list::bugs;
use crate::plant::Plant;
use crate::tables::second_source_neighbours;

/// Changes the sources of blends that use the second source.
fn sources(bug: fn(&mut Input)) -> Plant {
    before(move |state, _, input| {
        let factors = [state.color, state.alpha].map(|c| [c.src_factor, c.dst_factor]);
        if factors.as_flattened().iter().any(|f| f.is_second_source()) {
            bug(input);
        }
    })
}

bugs! {
    class "dual-source", "blend";
    also |list| factors(list, &second_source_neighbours());
    source "a lost second source";
    "second-is-the-first: The first source is used for both." => sources(|i| i.src1 = i.src);
    "first-is-the-second: The second source is used for both." => sources(|i| i.src = i.src1);
    "exchanged: The two sources are exchanged." => sources(|i| std::mem::swap(&mut i.src, &mut i.src1));
    "zero: The second source is 0." => sources(|i| i.src1 = [[0.0]; 4]);
    "alpha-zero: The second source's alpha is 0." => sources(|i| i.src1[3] = [0.0]);
    "alpha-one: The second source's alpha is 1." => sources(|i| i.src1[3] = [1.0]);
    "alpha-from-the-first: The second source has the first's alpha." => sources(|i| i.src1[3] = i.src[3]);
}
