//! The step of a depth bias that a frame shows. The specification leaves the step open, but it is the same
//! for a whole attachment. A frame is therefore legal only if all its samples are legal under one step. The
//! search halves the range of steps: the legal set of a part of the range contains every frame of every step
//! in it, so a part whose set refuses the frame is refused as a whole, and the frame is refused only if all
//! parts are.

use crate::legal_sets::{Judgement, Sets, set_by};
use crate::read_back::depth_encoding;
use crate::rules::Rules;
use etalon_frame::{ChannelEncoding, Frame, FrameError, LegalSet, Limits, compare};
use etalon_scene::Scene;
use std::borrow::Cow;
use std::sync::Arc;

/// The relative width below which a part is not halved, because single results can be off by this much
/// anyway.
const NARROW: f64 = 2e-5;

/// The maximum number of legal sets per search. A search that ends early refuses no frame.
const MOST_SETS: u32 = 160;

/// Rules with the step of depth bias that a frame shows, and the legal set under it.
#[derive(Clone, Debug)]
pub struct FittedRules {
    /// The rules.
    pub rules: Rules,
    /// The values that the rules allow.
    pub legal: Arc<LegalSet>,
}

impl Judgement {
    /// Returns the judgement under the depth bias step that a frame of the scene shows; returns this
    /// judgement if its scene leaves no step open.
    ///
    /// # Errors
    /// If the frame does not fit the scene.
    pub fn fitted(
        &self,
        scene: &Scene,
        frame: &Frame,
        sets: &Sets<'_>,
    ) -> Result<Cow<'_, Self>, FrameError> {
        let limits = &self.limits;
        let found = fit(scene, limits, &self.rules, &self.legal, frame, sets)?;
        Ok(match found {
            None => Cow::Borrowed(self),
            Some(FittedRules { rules, legal }) => Cow::Owned(Self {
                ideal: self.ideal_with_step_of(&rules, scene, sets),
                rules,
                legal,
                yardstick: Arc::clone(&self.yardstick),
                limits: limits.clone(),
                ..*self
            }),
        })
    }

    /// Returns the yardstick's values under the depth bias step of some rules. A driver may choose the step, so
    /// another step than the yardstick's is no inaccuracy.
    fn ideal_with_step_of(&self, rules: &Rules, scene: &Scene, sets: &Sets<'_>) -> Arc<LegalSet> {
        match rules.depth_bias_unit.value().assumed {
            None => Arc::clone(&self.yardstick),
            Some(step) => {
                let yardstick = Rules::yardstick(&self.limits).assuming(step);
                set_by(scene, &self.limits, &yardstick, sets)
            }
        }
    }
}

/// Returns the rules and the legal set under the depth bias step that a frame of a scene shows; `None` if the
/// scene leaves no step open, or if the set with an open step refuses the frame.
///
/// # Errors
/// If the frame does not fit the scene.
pub fn fit(
    scene: &Scene,
    limits: &Limits,
    rules: &Rules,
    legal: &LegalSet,
    frame: &Frame,
    sets: &Sets<'_>,
) -> Result<Option<FittedRules>, FrameError> {
    let Some(encoding) = biased_encoding(scene, limits) else {
        return Ok(None);
    };
    let is_fixed = matches!(encoding, ChannelEncoding::Unorm(_));
    // The last part is tried first.
    let mut parts: Vec<_> = rules.depth_bias_unit.value().readings(encoding).to_vec();
    parts.reverse();
    if (!is_fixed && parts.len() < 2) || wrong(legal, frame)? > 0 {
        return Ok(None);
    }
    if is_fixed {
        // Tries the usual steps 2^-n and 2^(1-n) before the whole range.
        let usual = [2.0, 1.0].map(|v: f64| (v * (1.0 - NARROW / 2.0), v * (1.0 + NARROW / 2.0)));
        let legal = parts.clone();
        let is_legal = |u: &(f64, f64)| legal.iter().any(|p| p.0 <= u.0 && u.1 <= p.1);
        parts.extend(usual.into_iter().filter(is_legal));
    }
    let mut best: Option<(u64, FittedRules)> = None;
    let mut tried = 0;
    while let Some(part) = parts.pop() {
        if tried == MOST_SETS {
            return Ok(None);
        }
        tried += 1;
        let rules = rules.assuming(part);
        let legal = set_by(scene, limits, &rules, sets);
        let refused = wrong(&legal, frame)?;
        let fitted = FittedRules { rules, legal };
        let is_narrow = !is_fixed || part.1 <= part.0 * (1.0 + 2.0 * NARROW);
        match (refused, is_narrow) {
            (0, true) => return Ok(Some(fitted)),
            (0, false) => {
                let middle = middle(part);
                parts.extend([(middle, part.1), (part.0, middle)]);
            }
            _ => {
                if best.as_ref().is_none_or(|(least, _)| refused < *least) {
                    best = Some((refused, fitted));
                }
            }
        }
    }
    Ok(best.map(|(_, fitted)| fitted))
}

/// Returns the encoding of the depth attachment that constant biases act on; `None` if there is no such
/// attachment, or several, whose steps can differ.
fn biased_encoding(scene: &Scene, limits: &Limits) -> Option<ChannelEncoding> {
    let biased = scene.passes.iter().filter(|pass| {
        let mut draws = pass.draws.iter();
        draws.any(|draw| draw.depth_bias.constant != 0 && draw.depth.is_some())
    });
    let mut attachments: Vec<usize> = biased.filter_map(|pass| pass.depth_stencil).collect();
    attachments.sort_unstable();
    attachments.dedup();
    match attachments[..] {
        [attachment] if scene.attachments[attachment].format.has_depth() => {
            Some(depth_encoding(scene, limits, attachment))
        }
        _ => None,
    }
}

/// Returns the number of samples of a frame that a set refuses.
fn wrong(legal: &LegalSet, frame: &Frame) -> Result<u64, FrameError> {
    compare(frame, legal, legal, 0).map(|found| found.texels.wrong)
}

/// Returns the mean of a range of steps: the geometric mean if the range is wide.
fn middle((low, high): (f64, f64)) -> f64 {
    if high > low * 4.0 {
        (low * high).sqrt()
    } else {
        (low + high) / 2.0
    }
}
