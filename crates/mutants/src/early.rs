//! Bugs of early fragment tests.

use crate::fields::{DEPTH_WRITE, EARLY_TESTS, STENCIL_TEST};
use crate::list::bugs;
use crate::permission::under;
use crate::plant::{from_draw, set};
use etalon_reference::rules::EarlyUpdates;
use etalon_scene::{Draw, EarlyTests};

fn is_forced(draw: &Draw) -> bool {
    draw.early_tests == EarlyTests::Forced
}

bugs! {
    class "early", "early-z";
    "forced-as-implicit: Forced early tests come late." => set(EARLY_TESTS, EarlyTests::Implicit), when is_forced, permitted vec![under!(early_updates: EarlyUpdates::Either | EarlyUpdates::Each), under!(early_coverage: EarlyUpdates::Either | EarlyUpdates::Each), under!(early_mask: EarlyUpdates::Either | EarlyUpdates::Each), under!(early_counts: EarlyUpdates::Either | EarlyUpdates::Each), under!(early_ignores_written: false), under!(skips_rejected: false)];
    "tested-before-discard: Shaders that discard are tested early." =>
        set(EARLY_TESTS, EarlyTests::Forced), when |draw| draw.shader.discards(),
        source "panfrost: early tests despite alpha test; Adreno, Mali: discard still touching depth and stencil";
    "tested-before-written-depth: Shaders that write depth are tested by the fragment's own." =>
        set(EARLY_TESTS, EarlyTests::Forced), when |draw| draw.shader.writes_depth();
    "tested-before-alpha-to-coverage: Draws with alpha to coverage are tested early." =>
        set(EARLY_TESTS, EarlyTests::Forced), when |draw| draw.multisample.alpha_to_coverage,
        source "ANGLE, turnip: early tests despite alpha to coverage";
    "tested-before-discard-without-depth: Without a depth test, discards are tested early." =>
        set(EARLY_TESTS, EarlyTests::Forced), when |draw| draw.depth.is_none() && draw.shader.discards(),
        source "a late test decided by the depth test alone";
    "tested-before-side-effects: Shaders that count their runs are tested early." =>
        set(EARLY_TESTS, EarlyTests::Forced), when |draw| draw.shader.counts_runs(),
        source "softpipe: late tests performed early";
    "runs-of-the-rejected-skipped: Shaders that only count their runs are tested early." =>
        set(EARLY_TESTS, EarlyTests::Forced), source "softpipe: late tests performed early",
        when |draw| draw.shader.counts_runs() && !draw.shader.discards() && !draw.shader.writes_depth(),
        permitted vec![under!(runs_for_discarded: false)];
    "promise-as-order: A layout qualifier on the written depth makes tests early." =>
        set(EARLY_TESTS, EarlyTests::Forced), when |draw| draw.early_tests.is_conservative();
    "forced-writes-nothing: Forced early tests store no depth." => set(DEPTH_WRITE, false), when is_forced;
    "forced-skips-stencil: Forced early tests leave the stencil test out." =>
        set(STENCIL_TEST, None), source "v3d: early tests against stencil writes", when is_forced;
    "sticky-forced: A draw after one with forced early tests has them too." =>
        from_draw(|before, draw| if is_forced(before) { draw.early_tests = EarlyTests::Forced }),
        source "state of the previous draw";
}
