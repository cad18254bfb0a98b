//! Lines that have too few fragments in a frame.

use etalon_frame::{Band, Comparison, Frame, Grade, LegalSet, Limits, WrongTexel};
use etalon_record::{MAX_WRONG_TEXELS, Reason};
use etalon_reference::{LineGap, Rules, counts_lines, line_gap};
use etalon_scene::Scene;

/// Returns a line with fewer fragments than the "must" clauses of the specification allow, under every depth
/// encoding; `None` if every line has enough, or if the frame fails anyway.
pub(crate) fn proven_line_gap(
    scene: &Scene,
    limits: &Limits,
    (frame, worst): (&Frame, Option<Band>),
    legal: &LegalSet,
) -> Option<LineGap> {
    if worst == Some(Band::Fail) || !counts_lines(scene) {
        return None;
    }
    let rules = Rules::of(limits).bound_by(Grade::Proven);
    let mut gaps = Vec::new();
    for limits in limits.alternatives(&scene.formats()) {
        gaps.push(line_gap(scene, &limits, &rules, frame, legal)?);
    }
    gaps.into_iter().next()
}

/// Adds the texels of a line's gap to a comparison, as proven violations ahead of all others. Returns true if
/// the first texel is also outside its own legal set, so that its story explains the failure.
pub(crate) fn note_gap(comparison: &mut Comparison, gap: &LineGap) -> bool {
    let all_known = comparison.wrong.len() < MAX_WRONG_TEXELS;
    let place = |w: &WrongTexel| (w.x, w.y, w.sample);
    let (mut wrong, mut others) = (Vec::new(), Vec::new());
    for texel in &gap.wrong {
        let mut known = comparison.wrong.iter();
        let known = known.position(|w| place(w) == place(texel));
        let band = known.map(|i| comparison.wrong.remove(i).band);
        match band {
            Some(Band::Imprecise) => {
                comparison.texels.imprecise -= 1;
                comparison.texels.wrong += 1;
            }
            None if all_known => comparison.texels.wrong += 1,
            Some(_) | None => {}
        }
        if band > Some(Band::Imprecise) {
            wrong.push(texel.clone());
        } else {
            others.push(texel.clone());
        }
    }
    let has_story = !wrong.is_empty();
    wrong.append(&mut others);
    wrong.append(&mut comparison.wrong);
    wrong.truncate(MAX_WRONG_TEXELS);
    comparison.wrong = wrong;
    has_story
}

/// Returns the reason for a line with too few fragments.
pub(crate) fn gap_reason(gap: &LineGap) -> Reason {
    Reason::LineGap {
        origin: gap.origin,
        fragments: gap.fragments,
        citation: gap.citation.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use crate::Judge;
    use etalon_backend::Backend;
    use etalon_case::{Library, Profile};
    use etalon_cpu::CpuBackend;
    use etalon_frame::{Api, Band, Frame, Property};
    use etalon_record::{Reason, Record, Verdict};

    /// Returns the record of a case of slanted lines without the pixels of some columns.
    fn lacking(api: Api, columns: std::ops::Range<usize>) -> Record {
        let id = "cull/slanted-lines/blend=opaque/topology=line-list";
        let library = Library::built_in();
        let found = library.cases(Profile::Full).find(|case| case.id() == id);
        let case = found.and_then(|case| case.build().ok()).expect("it builds");
        let backend = CpuBackend::new("cpu");
        let mut prepared = backend.prepare(&case.scene).expect("it prepares");
        prepared.submit().expect("it draws");
        let mut frame: Frame = prepared.read_back().expect("it is read back");
        for image in &mut frame.images {
            let (width, channels) = (image.size[0] as usize, image.channels.len());
            for (i, texel) in image.codes.chunks_exact_mut(channels).enumerate() {
                if columns.contains(&(i % width)) {
                    texel.copy_from_slice(match channels {
                        1 => &[0],
                        _ => &[0, 0, 255, 0],
                    });
                }
            }
        }
        let mut limits = backend.limits().clone();
        limits.api = api;
        // Strict lines are judged sample by sample.
        limits.properties.remove(&Property::LinesAreParallelograms);
        Judge::default()
            .judge(0, &case, "test", &limits, &[frame])
            .record
    }

    #[test]
    fn a_slanted_line_that_is_missing_is_a_fail() {
        for api in [Api::Vulkan, Api::OpenGl, Api::OpenGlEs] {
            let record = lacking(api, 0..36);
            assert_eq!(record.verdict, Verdict::Fail, "{api}");
            assert_eq!(record.wrong[0].band, Band::Fail);
            assert!(
                matches!(
                    record.reasons[..],
                    [Reason::LineGap {
                        fragments: [_, 0],
                        ..
                    }]
                ),
                "{:?}",
                record.reasons
            );
            assert_eq!(lacking(api, 8..9).verdict, Verdict::Pass, "{api}");
        }
    }

    #[test]
    fn a_missing_line_is_no_fail_in_webgpu() {
        assert_ne!(lacking(Api::WebGpu, 0..36).verdict, Verdict::Fail);
    }
}
