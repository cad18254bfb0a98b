//! The step of a depth bias as a frame shows it. A text leaves the step open, but it is one step for all
//! of an attachment, so a frame is legal if there is a step under which all of its samples are. The
//! range of steps is searched by halving: the legal set of a part of the range holds every frame of
//! every step in it, so a part whose set refuses the frame is refused whole, and a frame is refused
//! only if all parts are.

use crate::judge::{Judgement, judge_some};
use crate::walk::depth_encoding;
use etalon_frame::{ChannelEncoding, Frame, FrameError, LegalSet, Limits, compare};
use etalon_scene::Scene;
use std::borrow::Cow;

/// The relative width of a part that is not halved again: what single results may be off by anyway.
const NARROW: f64 = 2e-5;

/// The most legal sets of one search. A search that ends early refuses nothing.
const MOST_SETS: u32 = 160;

/// A judgement under a part of the steps, and the number of samples that it refuses.
struct Candidate {
    judgement: Judgement,
    wrong: u64,
}

impl Judgement {
    /// Returns the judgement under the step of depth bias that a frame of the scene shows; this one if
    /// its scene leaves no step open.
    ///
    /// # Errors
    /// If the frame is not one of the scene.
    pub fn fitted(&self, scene: &Scene, frame: &Frame) -> Result<Cow<'_, Self>, FrameError> {
        let Some(encoding) = biased_encoding(scene, &self.limits) else {
            return Ok(Cow::Borrowed(self));
        };
        if wrong(&self.legal, frame)? > 0 {
            return Ok(Cow::Borrowed(self));
        }
        let is_fixed = matches!(encoding, ChannelEncoding::Unorm(_));
        let mut parts = self.rules.depth_bias_unit.value.readings(encoding).to_vec();
        if !is_fixed && parts.len() < 2 {
            return Ok(Cow::Borrowed(self));
        }
        // The last is tried first: before the whole range the usual steps, 2^-n and twice that.
        parts.reverse();
        if is_fixed {
            let usual =
                [2.0, 1.0].map(|v: f64| (v * (1.0 - NARROW / 2.0), v * (1.0 + NARROW / 2.0)));
            let whole = parts.clone();
            let legal = usual
                .into_iter()
                .filter(|u| whole.iter().any(|p| p.0 <= u.0 && u.1 <= p.1));
            parts.extend(legal);
        }
        let mut best: Option<Candidate> = None;
        let mut sets = 0;
        while let Some(part) = parts.pop() {
            if sets == MOST_SETS {
                return Ok(Cow::Borrowed(self));
            }
            sets += 1;
            let candidate = self.under(scene, frame, part)?;
            let is_narrow = !is_fixed || part.1 <= part.0 * (1.0 + NARROW);
            match (candidate.wrong, is_narrow) {
                (0, true) => return Ok(Cow::Owned(candidate.judgement)),
                (0, false) => {
                    let middle = middle(part);
                    parts.extend([(middle, part.1), (part.0, middle)]);
                }
                _ => {
                    if best.as_ref().is_none_or(|b| candidate.wrong < b.wrong) {
                        best = Some(candidate);
                    }
                }
            }
        }
        Ok(best.map_or(Cow::Borrowed(self), |b| Cow::Owned(b.judgement)))
    }

    /// Returns the judgement under some of the steps.
    fn under(
        &self,
        scene: &Scene,
        frame: &Frame,
        part: (f64, f64),
    ) -> Result<Candidate, FrameError> {
        let mut judgement = self.clone();
        judgement.rules.depth_bias_unit.value.assumed = Some(part);
        judgement.legal = judge_some(scene, &self.limits, &judgement.rules, self.texels);
        let wrong = wrong(&judgement.legal, frame)?;
        Ok(Candidate { judgement, wrong })
    }
}

/// Returns the encoding of the depth attachment that constant biases act on; `None` if there is none,
/// or several, whose steps need not be the same.
fn biased_encoding(scene: &Scene, limits: &Limits) -> Option<ChannelEncoding> {
    let biased = scene.passes.iter().filter(|pass| {
        let mut draws = pass.draws.iter();
        draws.any(|draw| draw.depth_bias.constant != 0 && draw.depth.is_some())
    });
    let mut attachments: Vec<usize> = biased.filter_map(|pass| pass.depth_stencil).collect();
    attachments.sort_unstable();
    attachments.dedup();
    match attachments[..] {
        [one] if scene.attachments[one].format.has_depth() => {
            Some(depth_encoding(scene, limits, one))
        }
        _ => None,
    }
}

/// Returns the number of samples of a frame that a set refuses.
fn wrong(legal: &LegalSet, frame: &Frame) -> Result<u64, FrameError> {
    compare(frame, legal, legal, 0).map(|found| found.texels.wrong)
}

/// Returns the middle of a range of steps; of a wide one that of its logarithms.
fn middle((low, high): (f64, f64)) -> f64 {
    if high > low * 4.0 {
        (low * high).sqrt()
    } else {
        (low + high) / 2.0
    }
}
