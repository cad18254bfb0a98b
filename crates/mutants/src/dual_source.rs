//! Bugs of the second source.

use super::hooks::{blending, faithful_blend};
use super::list::{CONFUSION, List, Row};
use super::plant::{Plant, alpha_blend, color_blend};
use super::tables;
use etalon_pipeline::BlendInput;
use etalon_scene::BlendComponent;

pub(super) fn add(list: &mut List) {
    list.class("dual-source", "blend");
    second_sources(list);
}

fn second_sources(list: &mut List) {
    for (right, wrong) in tables::second_source_neighbours() {
        let swap = move |component: &mut BlendComponent| {
            for factor in [&mut component.src_factor, &mut component.dst_factor] {
                if *factor == right {
                    *factor = wrong;
                }
            }
        };
        let (is, was) = (wrong.name(), right.name());
        list.add(
            &format!("color-factor-{was}-as-{is}"),
            CONFUSION,
            format!("For colour, factor {was} acts as {is}."),
            color_blend(swap),
        );
        if !tables::same_for_alpha(right, wrong) {
            list.add(
                &format!("alpha-factor-{was}-as-{is}"),
                CONFUSION,
                format!("For alpha, factor {was} acts as {is}."),
                alpha_blend(swap),
            );
        }
    }
    type Bug = fn(&mut BlendInput<[f32; 1]>);
    let rows: [Row<Bug>; 7] = [
        (
            "second-is-the-first",
            "The first source is used for both.",
            |i| {
                i.src1 = i.src;
            },
        ),
        (
            "first-is-the-second",
            "The second source is used for both.",
            |i| {
                i.src = i.src1;
            },
        ),
        ("exchanged", "The two sources are exchanged.", |i| {
            std::mem::swap(&mut i.src, &mut i.src1);
        }),
        ("zero", "The second source is 0.", |i| i.src1 = [[0.0]; 4]),
        ("alpha-zero", "The second source's alpha is 0.", |i| {
            i.src1[3] = [0.0];
        }),
        ("alpha-one", "The second source's alpha is 1.", |i| {
            i.src1[3] = [1.0];
        }),
        (
            "alpha-from-the-first",
            "The second source has the first's alpha.",
            |i| {
                i.src1[3] = i.src[3];
            },
        ),
    ];
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
    list.rows("a lost second source", sources, &rows);
}
