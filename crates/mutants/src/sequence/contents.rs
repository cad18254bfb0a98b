//! Contents that are wrongly lost or kept when a pass or submission begins.

use crate::aspects::{ASPECTS, word};
use crate::list::bugs;
use crate::plant::{Plant, memory};
use etalon_cpu::CpuSurface;
use etalon_cpu::steps::Moment;
use etalon_frame::Aspect;
use etalon_scene::Scene;
use std::collections::HashSet;

/// Copies one aspect of an attachment.
fn restore(aspect: Aspect, from: &CpuSurface, to: &mut CpuSurface) {
    match aspect {
        Aspect::Stencil => to.stencil.clone_from(&from.stencil),
        _ if (aspect == Aspect::Depth) == to.encodings.is_empty() => {
            to.planes.clone_from(&from.planes);
        }
        _ => {}
    }
}

/// Restores one aspect of a pass's attachments, or of all attachments if no pass has begun. At the moment
/// `to`, they get their contents of the moment `from`.
fn restored(
    aspect: Aspect,
    from: impl Fn(Moment, &Scene) -> bool + Copy + Send + Sync + 'static,
    to: impl Fn(Moment, &Scene) -> bool + Copy + Send + Sync + 'static,
) -> Plant {
    memory(move |kept: &mut Vec<CpuSurface>, moment, scene, stored| {
        if to(moment, scene) && !kept.is_empty() {
            let drawn: Vec<usize> = match moment {
                Moment::Begin { pass } | Moment::End { pass } => {
                    let pass = &scene.passes[pass];
                    let color = pass.color.iter();
                    color.chain(&pass.depth_stencil).copied().collect()
                }
                _ => (0..kept.len()).collect(),
            };
            for index in drawn {
                restore(aspect, &kept[index], &mut stored.surfaces[index]);
            }
        }
        if from(moment, scene) {
            *kept = stored.surfaces.to_vec();
        }
    })
}

/// Returns true at the end of the last pass.
fn at_end(moment: Moment, scene: &Scene) -> bool {
    matches!(moment, Moment::End { pass } if pass + 1 == scene.passes.len())
}

/// Undoes draws of submissions after the first.
fn later_submissions(undone: fn(Moment) -> bool) -> Plant {
    memory(
        move |(submissions, kept): &mut (u32, Vec<CpuSurface>), moment, _, stored| match moment {
            Moment::Initial => *submissions += 1,
            Moment::Draw { .. } if *submissions > 1 => *kept = stored.surfaces.to_vec(),
            Moment::Drawn { .. } if *submissions > 1 && undone(moment) => {
                stored.surfaces.clone_from_slice(kept);
            }
            _ => {}
        },
    )
}

bugs! {
    for aspect in ASPECTS {
        let (name, word) = (aspect.name(), word(aspect));
        "{name}-not-stored-by-the-first-pass: The {word} that the first of several passes leaves is lost." =>
            restored(
                aspect,
                |moment, _| moment == Moment::Begin { pass: 0 },
                |moment, scene| moment == Moment::End { pass: 0 } && scene.passes.len() > 1,
            );
        "{name}-not-loaded: A pass after the first finds the {word} that attachments began with." =>
            restored(
                aspect,
                |moment, _| moment == Moment::Initial,
                |moment, _| matches!(moment, Moment::Begin { pass } if pass > 0),
            );
        "{name}-of-the-last-pass-lost: The {word} that the last of several passes leaves is lost." =>
            restored(
                aspect,
                |moment, _| matches!(moment, Moment::Begin { .. }),
                |moment, scene| scene.passes.len() > 1 && at_end(moment, scene),
            );
        "{name}-kept-from-the-submission-before: A submission begins with the {word} that the one before left." =>
            restored(aspect, at_end, |moment, _| moment == Moment::Initial);
    }
    "texture-as-it-began: A texture that earlier passes drew is read as it began." =>
        memory(|began: &mut Vec<CpuSurface>, moment, scene, stored| match moment {
            Moment::Initial => *began = stored.surfaces.to_vec(),
            Moment::Draw { pass, draw } | Moment::Drawn { pass, draw } => {
                let textures = scene.passes[pass].draws[draw].textures.iter().copied();
                for texture in textures.collect::<HashSet<usize>>() {
                    std::mem::swap(&mut began[texture], &mut stored.surfaces[texture]);
                }
            }
            _ => {}
        });
    "later-submissions-draw-nothing: Only the first submission draws." => later_submissions(|_| true);
    "later-submissions-lose-their-first-draw: Submissions after the first lose their first draw." =>
        later_submissions(|moment| moment == Moment::Drawn { pass: 0, draw: 0 });
    "counts-added-over-submissions: Counters go on from the submission before." =>
        memory(|counts: &mut Vec<u64>, moment, scene, stored| {
            if moment == Moment::Initial {
                for (from, (_, to)) in counts.iter().zip(stored.counters.iter_mut()) { *to = *from; }
            }
            if at_end(moment, scene) { *counts = stored.counters.iter().map(|(_, count)| *count).collect(); }
        });
}
