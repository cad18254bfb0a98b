//! Bugs of early fragment tests.

use crate::fields::{DEPTH_WRITE, EARLY_TESTS};
use crate::list::{CONFUSION, List};
use crate::plant::from_draw;
use etalon_scene::{Draw, EarlyTests};

/// Adds a bug that tests some draws early.
fn early(list: &mut List, text: &str, source: &'static str, strikes: fn(&Draw) -> bool) {
    let mutant = list.bug(text).source(source).when(strikes);
    mutant.set(EARLY_TESTS, EarlyTests::Forced);
}

pub(super) fn add(list: &mut List) {
    list.class("early", "early-z");
    let forced = |draw: &Draw| draw.early_tests == EarlyTests::Forced;
    list.bug("forced-as-implicit: Forced early tests come late.")
        .when(forced)
        .set(EARLY_TESTS, EarlyTests::Implicit);
    early(
        list,
        "tested-before-discard: Shaders that discard are tested early.",
        "panfrost: early tests despite alpha test; Adreno, Mali: discard still touching depth and \
         stencil",
        |draw| draw.shader.discards(),
    );
    early(
        list,
        "tested-before-written-depth: Shaders that write depth are tested by the fragment's own.",
        CONFUSION,
        |draw| draw.shader.writes_depth(),
    );
    early(
        list,
        "tested-before-alpha-to-coverage: Draws with alpha to coverage are tested early.",
        "ANGLE, turnip: early tests despite alpha to coverage",
        |draw| draw.multisample.alpha_to_coverage,
    );
    early(
        list,
        "tested-before-discard-without-depth: Without a depth test, discards are tested early.",
        "a late test decided by the depth test alone",
        |draw| draw.depth.is_none() && draw.shader.discards(),
    );
    early(
        list,
        "tested-before-side-effects: Shaders that count their runs are tested early.",
        "softpipe: late tests performed early",
        |draw| draw.shader.counts_runs(),
    );
    early(
        list,
        "promise-as-order: A layout qualifier on the written depth makes tests early.",
        CONFUSION,
        |draw| draw.early_tests.is_conservative(),
    );
    list.bug("forced-writes-nothing: Forced early tests store no depth.")
        .when(forced)
        .set(DEPTH_WRITE, false);
    list.bug("forced-skips-stencil: Forced early tests leave the stencil test out.")
        .source("v3d: early tests against stencil writes")
        .when(forced)
        .draws(|draw| draw.stencil = None);
    list.bug("sticky-forced: A draw after one with forced early tests has them too.")
        .source("state of the previous draw")
        .plant(from_draw(|before, draw| {
            if before.early_tests == EarlyTests::Forced {
                draw.early_tests = EarlyTests::Forced;
            }
        }));
}
