//! The judgement of one texel, as `etalon explain` needs it: no other texel is judged, but where counters
//! are sums over all.

use crate::grade::Grades;
use crate::judge::{best, regrade};
use crate::judgement_cache::judged_scene;
use etalon_case::Case;
use etalon_frame::{Band, Comparison, Frame, Limits};
use etalon_reference::{Judgement, Texels, judgements_of};

/// Returns the judgement of a texel of one of a case's scenes, under the encodings that fit the frame best,
/// and the outcome for the frame, if there is one. Violations have the bands of their evidence.
///
/// # Errors
/// When the frame is not one of the case.
pub fn judge_texel(
    case: &Case,
    index: usize,
    limits: &Limits,
    texel: [u32; 2],
    frame: Option<&Frame>,
) -> Result<(Judgement, Option<Comparison>), String> {
    let scene = judged_scene(case, index);
    let of = |texels: Texels| -> Result<(Judgement, Option<Comparison>), String> {
        let mut judgements = judgements_of(scene, limits, texels);
        let Some(frame) = frame else {
            return Ok((judgements.swap_remove(0), None));
        };
        let (mut comparison, judgement) = best(scene, &judgements, frame)?;
        if comparison.worst() == Some(Band::Fail)
            && let Some(grades) = Grades::of(scene, limits, texels, frame)
        {
            regrade(&mut comparison, &grades);
        }
        Ok((judgement.into_owned(), Some(comparison)))
    };
    let (judgement, mut comparison) = of(Texels::One(texel))?;
    if let Some(comparison) = &mut comparison
        && !scene.counters.is_empty()
    {
        comparison.counters = of(Texels::All)?.1.map_or_else(Vec::new, |all| all.counters);
    }
    Ok((judgement, comparison))
}
