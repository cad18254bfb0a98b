//! Bugs of early fragment tests.

use super::list::{CONFUSION, List};
use super::plant::{draws, from_draw};
use etalon_scene::{Draw, EarlyTests};

pub(super) fn add(list: &mut List) {
    list.class("early", "early-z");
    tests(list);
}

/// Tests that come at the wrong time.
fn tests(list: &mut List) {
    list.add(
        "forced-as-implicit",
        CONFUSION,
        "Forced early tests come late.",
        draws(|draw| {
            if draw.early_tests == EarlyTests::Forced {
                draw.early_tests = EarlyTests::Implicit;
            }
        }),
    );
    type When = fn(&Draw) -> bool;
    let early: [(&str, &'static str, &str, When); 6] = [
        (
            "tested-before-discard",
            "panfrost: early tests despite alpha test; Adreno, Mali: discard still touching depth and stencil",
            "Shaders that discard are tested early.",
            |draw| draw.shader.discards(),
        ),
        (
            "tested-before-written-depth",
            CONFUSION,
            "Shaders that write depth are tested early, with the fragment's own.",
            |draw| draw.shader.writes_depth(),
        ),
        (
            "tested-before-alpha-to-coverage",
            "ANGLE, turnip: early tests despite alpha to coverage",
            "Draws with alpha to coverage are tested early.",
            |draw| draw.multisample.alpha_to_coverage,
        ),
        (
            "tested-before-discard-without-depth",
            "a late test decided by the depth test alone",
            "Shaders that discard are tested early where the depth test is off.",
            |draw| draw.depth.is_none() && draw.shader.discards(),
        ),
        (
            "tested-before-side-effects",
            "softpipe: late tests performed early",
            "Shaders that count their runs are tested early.",
            |draw| draw.shader.counts_runs(),
        ),
        (
            "promise-as-order",
            CONFUSION,
            "A layout qualifier on the written depth makes tests early, with the fragment's own depth.",
            |draw| draw.early_tests.is_conservative(),
        ),
    ];
    for (name, source, about, when) in early {
        list.add(
            name,
            source,
            about,
            draws(move |draw| {
                if when(draw) {
                    draw.early_tests = EarlyTests::Forced;
                }
            }),
        );
    }
    list.add(
        "forced-writes-nothing",
        CONFUSION,
        "Forced early tests store no depth.",
        draws(|draw| {
            if let (EarlyTests::Forced, Some(depth)) = (draw.early_tests, &mut draw.depth) {
                depth.write = false;
            }
        }),
    );
    list.add(
        "forced-skips-stencil",
        "v3d: early tests against stencil writes",
        "Forced early tests leave the stencil test out.",
        draws(|draw| {
            if draw.early_tests == EarlyTests::Forced {
                draw.stencil = None;
            }
        }),
    );
    list.add(
        "sticky-forced",
        "state of the previous draw",
        "A draw after one with forced early tests has them too.",
        from_draw(|before, draw| {
            if before.early_tests == EarlyTests::Forced {
                draw.early_tests = EarlyTests::Forced;
            }
        }),
    );
}
