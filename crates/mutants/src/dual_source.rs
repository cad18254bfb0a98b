//! Bugs of the second source.

use crate::hooks::{blending, faithful_blend};
use crate::list::{CONFUSION, List};
use crate::plant::Plant;
use crate::tables;
use etalon_pipeline::BlendInput;

pub(super) fn add(list: &mut List) {
    list.class("dual-source", "blend");
    super::blend::factors(list, &tables::second_source_neighbours());
    type Bug = fn(&mut BlendInput<[f32; 1]>);

    fn sources(bug: Bug) -> Plant {
        blending(move |state, encodings, input| {
            let factors = [state.color, state.alpha].map(|c| [c.src_factor, c.dst_factor]);
            let mut changed = *input;
            if factors.as_flattened().iter().any(|f| f.is_second_source()) {
                bug(&mut changed);
            }
            faithful_blend(state, encodings, &changed)
        })
    }
    list.source("a lost second source");
    list.bug("second-is-the-first: The first source is used for both.")
        .plant(sources(|i| i.src1 = i.src));
    list.bug("first-is-the-second: The second source is used for both.")
        .plant(sources(|i| i.src = i.src1));
    list.bug("exchanged: The two sources are exchanged.")
        .plant(sources(|i| std::mem::swap(&mut i.src, &mut i.src1)));
    list.bug("zero: The second source is 0.")
        .plant(sources(|i| i.src1 = [[0.0]; 4]));
    list.bug("alpha-zero: The second source's alpha is 0.")
        .plant(sources(|i| i.src1[3] = [0.0]));
    list.bug("alpha-one: The second source's alpha is 1.")
        .plant(sources(|i| i.src1[3] = [1.0]));
    list.bug("alpha-from-the-first: The second source has the first's alpha.")
        .plant(sources(|i| i.src1[3] = i.src[3]));
    list.source(CONFUSION);
}
