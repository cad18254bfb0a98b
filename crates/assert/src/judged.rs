//! The judgement of frames that somebody drew.

use crate::any_device;
use crate::error::AssertError;
use crate::explain::AskedTexel;
use etalon_case::Case;
use etalon_frame::{Api, Frame, Limits};
use etalon_judge::Judge;
use etalon_record::{Record, Verdict};
use etalon_report::{message, sentence};
use std::fmt;

/// The judgement of a case's frames.
#[derive(Debug)]
pub struct Judged<'a> {
    /// The verdict with its evidence, as `etalon run` records it.
    pub record: Record,
    case: &'a Case,
    frames: &'a [Frame],
    limits: Limits,
}

/// Judges the frames of a case by the rules of an API: that of the case's scene first, then those of its variants, in
/// the order of [`Case::scenes`]. Without `limits`, they may come from [any device](any_device) of the API; those of your own
/// device, such as its sub-pixel bits, allow less: `Limits { sub_pixel_bits: 8, ..any_device(rules) }`.
///
/// # Errors
/// If the limits do not hold together, or if a frame does not fit the case.
pub fn judge_frame<'a>(
    case: &'a Case,
    frames: &'a [Frame],
    rules: Api,
    limits: Option<&Limits>,
) -> Result<Judged<'a>, AssertError> {
    let limits = limits.map_or_else(
        || any_device(rules),
        |limits| Limits {
            api: rules,
            ..limits.clone()
        },
    );
    let limits = limits
        .checked()
        .map_err(|why| AssertError::Limits(why.to_string()))?;
    let scenes = case.scenes().count();
    if frames.len() != scenes {
        return Err(AssertError::Unfit(format!(
            "{} has {scenes} scenes, but {} frames were given",
            case.id,
            frames.len()
        )));
    }
    let record = Judge::default().judge(0, case, "", &limits, frames).record;
    if record.verdict == Verdict::InternalError {
        return Err(AssertError::Unfit(message(&record)));
    }
    Ok(Judged {
        record,
        case,
        frames,
        limits,
    })
}

impl Judged<'_> {
    /// Returns the verdict.
    pub fn verdict(&self) -> Verdict {
        self.record.verdict
    }

    /// Returns true if the specification allows every texel and every counter. It also is if nothing could be asserted
    /// ([`Verdict::Open`]).
    pub fn is_allowed(&self) -> bool {
        !self.record.verdict.is_violation()
    }

    /// Explains the first wrong texel, operation by operation, with rules and citations.
    ///
    /// # Errors
    /// If no texel is wrong.
    pub fn explain(&self) -> Result<String, AssertError> {
        let texel = match self.record.wrong.first() {
            Some(wrong) => [wrong.x, wrong.y],
            // Only a counter or a relation is wrong.
            None if !self.is_allowed() => [0, 0],
            None => {
                return Err(AssertError::NothingWrong {
                    case: self.case.id.clone(),
                    verdict: self.record.verdict.to_string(),
                });
            }
        };
        self.explain_texel(texel)
    }

    /// Explains a texel by column and row from the top left corner, wrong or not.
    ///
    /// # Errors
    /// If it is in no attachment that the case reads back.
    pub fn explain_texel(&self, texel: [u32; 2]) -> Result<String, AssertError> {
        let asked = AskedTexel {
            case: self.case,
            texel,
            sample: None,
            frames: self.frames,
        };
        Ok(asked.explain(&self.limits, false)?.text(self.case))
    }
}

/// Displays the verdict and its reason in one line: `fail: texel 0,0 must be red …`.
impl fmt::Display for Judged<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.record.verdict)?;
        let told = self.record.story.as_ref().and_then(sentence);
        match told.unwrap_or_else(|| message(&self.record)) {
            reason if reason.is_empty() => Ok(()),
            reason => write!(f, ": {reason}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{case, frame};
    use etalon_backend::Backend;
    use etalon_cpu::CpuBackend;

    const BLEND: &str = "blend/formats/equation=over/format=bgra8unorm";

    fn drawn(case: &Case) -> Vec<Frame> {
        let backend = CpuBackend::new("cpu");
        let draw = |scene| {
            let mut prepared = backend.prepare(scene).expect("it is supported");
            prepared.submit().expect("it is drawn");
            prepared.read_back().expect("it is read back")
        };
        case.scenes().map(draw).collect()
    }

    #[test]
    fn what_the_rasterizer_draws_is_allowed_by_every_api() {
        let case = case(BLEND).expect("it is built in");
        let frames = drawn(&case);
        for api in [Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu] {
            let judged = judge_frame(&case, &frames, api, None).expect("the frames fit");
            assert!(judged.is_allowed(), "{judged}");
            assert!(matches!(
                judged.explain(),
                Err(AssertError::NothingWrong { .. })
            ));
            let text = judged.explain_texel([3, 4]).expect("it is inside");
            assert!(text.contains("blend"), "{text}");
        }
    }

    #[test]
    fn a_wrong_texel_is_named_and_explained() {
        let case = case(BLEND).expect("it is built in");
        let mut frames = drawn(&case);
        frames[0].images[0].codes[0] ^= 0x80;
        let judged = judge_frame(&case, &frames, Api::WebGpu, None).expect("the frames fit");
        assert_eq!(
            (judged.verdict(), judged.is_allowed()),
            (Verdict::Fail, false)
        );
        assert!(
            judged.to_string().starts_with("fail: texel 0,0 "),
            "{judged}"
        );
        let text = judged.explain().expect("a texel is wrong");
        assert!(
            text.contains("the driver wrote [128, 0, 0, 0]") && text.contains("WebGPU"),
            "{text}"
        );
        let outside = judged.explain_texel([16, 0]);
        assert!(matches!(outside, Err(AssertError::Outside(_))));
    }

    #[test]
    fn frames_that_do_not_fit_are_refused() {
        let case = case(BLEND).expect("it is built in");
        let none = judge_frame(&case, &[], Api::Vulkan, None);
        assert!(matches!(none, Err(AssertError::Unfit(_))));
        let mut frames = drawn(&case);
        frames[0].images.clear();
        let empty = judge_frame(&case, &frames, Api::Vulkan, None);
        assert!(matches!(empty, Err(AssertError::Unfit(_))));
        let short = frame(&case.scene, &[], |_| vec![0; 3]);
        assert!(matches!(short, Err(AssertError::Unfit(_))));
    }

    #[test]
    fn a_case_that_does_not_exist_has_a_suggestion() {
        let unknown = crate::case("blend/formats/equation=over/format=bgra8unrom")
            .expect_err("there is none");
        assert!(
            unknown.to_string().contains("format=bgra8unorm"),
            "{unknown}"
        );
    }
}
