//! The judgement of one texel, as `etalon explain` needs it. No other texel is judged, unless the scene
//! ties them together.

use crate::grade::Grades;
use crate::judge::{best, regrade};
use crate::judgement_cache::judged_scene;
use etalon_case::Case;
use etalon_frame::{Band, Comparison, Frame, Limits, compare};
use etalon_reference::{Judgement, Texels, judgements_by, shared_sets};
use etalon_scene::Scene;

/// Returns the judgement of a texel of one of a case's scenes, under what the frame fits best where the API
/// leaves one choice for all of it, and the outcome for the frame, if there is one: the wrong samples of
/// this texel and all counters, with the bands of their evidence.
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
    let texels = if is_tied(scene) {
        Texels::All
    } else {
        Texels::One(texel)
    };
    let sets = shared_sets(scene, texels);
    let mut judgements = judgements_by(scene, limits, texels, &sets);
    let Some(frame) = frame else {
        return Ok((judgements.swap_remove(0), None));
    };
    let judgement = best(scene, &judgements, frame, &sets)?.1.into_owned();
    let found = compare(frame, &judgement.legal, &judgement.yardstick, usize::MAX);
    let mut comparison = found.map_err(|e| e.to_string())?;
    if comparison.worst() == Some(Band::Fail)
        && let Some(grades) = Grades::of(scene, limits, frame, &sets)
    {
        regrade(&mut comparison, &grades);
    }
    comparison.wrong.retain(|w| [w.x, w.y] == texel);
    Ok((judgement, Some(comparison)))
}

/// True if other texels decide what is legal at one: counters, the step of a depth bias, and samplers that
/// read what was drawn.
fn is_tied(scene: &Scene) -> bool {
    let mut draws = scene.passes.iter().flat_map(|p| &p.draws);
    let mut later = scene.passes.iter().skip(1).flat_map(|p| &p.draws);
    !scene.counters.is_empty()
        || draws.any(|d| d.depth_bias != Default::default())
        || later.any(|d| d.sampler.is_some())
}
