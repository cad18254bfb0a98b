//! The judgement of one texel, for `etalon explain`. Other texels are judged only if this texel depends on
//! them.

use crate::grade::Grades;
use crate::judge::{best, regrade};
use crate::judgement_cache::judged_scene;
use etalon_case::Case;
use etalon_frame::{Band, Comparison, Frame, Limits, compare};
use etalon_reference::{Geometries, Judgement, Texels, judgements_by, shared_sets};
use etalon_scene::Scene;

/// Returns the judgement of a texel of one of a case's scenes. If the API leaves one choice for the whole
/// frame, the judgement is under the choice that fits the frame best. If there is a frame, also returns its
/// outcome: the wrong samples of this texel and all counters, with the bands of their evidence.
///
/// # Errors
/// If the frame does not fit the case.
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
    let geometries = Geometries::default();
    let sets = shared_sets(scene, texels, &geometries);
    let mut judgements = judgements_by(scene, limits, texels, &sets);
    let Some(frame) = frame else {
        return Ok((judgements.swap_remove(0), None));
    };
    let judgement = best(scene, &judgements, frame, &sets)?.1.into_owned();
    let found = compare(frame, &judgement.legal, &judgement.yardstick, usize::MAX);
    let mut comparison = found.map_err(|e| e.to_string())?;
    if comparison.worst() == Some(Band::Fail)
        && let Some(grades) = Grades::of(scene, limits, (frame, comparison.texels.wrong), &sets)
    {
        regrade(&mut comparison, &grades);
    }
    comparison.wrong.retain(|w| [w.x, w.y] == texel);
    Ok((judgement, Some(comparison)))
}

/// Returns true if the legal values of one texel depend on other texels: through counters, the step of a
/// depth bias, or samplers that read what was drawn.
fn is_tied(scene: &Scene) -> bool {
    let mut draws = scene.passes.iter().flat_map(|p| &p.draws);
    let mut later = scene.passes.iter().skip(1).flat_map(|p| &p.draws);
    !scene.counters.is_empty()
        || draws.any(|d| d.depth_bias != Default::default())
        || later.any(|d| d.sampler.is_some())
}
