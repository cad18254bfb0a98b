//! Judging with any limits that an adapter can report.

use crate::Judge;
use etalon_backend::Backend;
use etalon_case::{Case, Library};
use etalon_cpu::CpuBackend;
use etalon_frame::{Api, Frame, Limits};
use etalon_record::Verdict;
use proptest::prelude::*;
use std::sync::LazyLock;

/// Cases whose vertices are on the coarsest grid, so that no grid moves them, and then others.
const EXACT: [&str; 2] = ["depth/compare/", "scissor/rect/"];
const OTHER: [&str; 3] = [
    "cull/slanted-lines/",
    "multisample/edges/",
    "early-z/discard/",
];

/// Cases with the frames that `cpu` draws of them.
static DRAWN: LazyLock<Vec<(Case, Vec<Frame>)>> = LazyLock::new(|| {
    let backend = CpuBackend::new("cpu");
    let drawn = EXACT.into_iter().chain(OTHER).flat_map(|start| {
        let cases = Library::built_in().cases_that_begin(start).take(2);
        cases.map(|case| case.build().expect("it builds"))
    });
    let frames = |case: &Case| -> Vec<Frame> {
        let draw = |scene| {
            let mut prepared = backend.prepare(scene).expect("it prepares");
            prepared.submit().expect("it draws");
            prepared.read_back().expect("it is read back")
        };
        case.scenes().map(draw).collect()
    };
    drawn
        .map(|case| (frames(&case), case))
        .map(|(f, c)| (c, f))
        .collect()
});

fn limits() -> impl Strategy<Value = Limits> {
    let cpu = CpuBackend::new("cpu").limits().clone();
    let api = prop_oneof![
        Just(Api::Vulkan),
        Just(Api::OpenGl),
        Just(Api::OpenGlEs),
        Just(Api::WebGpu)
    ];
    let positions = prop::option::weighted(
        0.3,
        (0..5_u32, prop::collection::vec(any::<[u16; 2]>(), 0..5)),
    );
    let counts = prop::option::weighted(0.2, any::<u32>());
    (
        api,
        any::<u8>(),
        any::<u32>(),
        any::<u32>(),
        positions,
        counts,
    )
        .prop_map(move |(api, bits, size, attachments, positions, count)| {
            let mut limits = cpu.clone();
            limits.api = api;
            limits.sub_pixel_bits = bits;
            limits.max_size = size;
            limits.max_color_attachments = attachments;
            limits.sample_positions.extend(positions);
            if let (Some(count), Some(support)) = (count, limits.formats.values_mut().next()) {
                support.samples.push(count);
            }
            limits
        })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_limit_panics_or_accuses_a_right_picture(reported in limits()) {
        let own = CpuBackend::new("cpu").limits().clone();
        let Ok(limits) = reported.checked() else {
            return Ok(());
        };
        for (number, (case, frames)) in DRAWN.iter().enumerate() {
            let judged = |limits: &Limits| {
                Judge::default().judge(number, case, "cpu", limits, frames).record.verdict
            };
            let verdict = judged(&limits);
            let is_exact = EXACT.iter().any(|start| case.id.starts_with(start));
            // `cpu` does snap to its own grid, and its samples are where its limits say.
            let is_true = limits.sample_positions == own.sample_positions
                && (is_exact || limits.sub_pixel_bits <= own.sub_pixel_bits);
            if is_true && verdict == Verdict::Fail {
                let mut own = own.clone();
                own.api = limits.api;
                prop_assert_eq!(judged(&own), Verdict::Fail, "{}: {:?}", case.id, limits);
            }
        }
    }
}
