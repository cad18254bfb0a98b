//! Contents that a pass change or a submission loses or keeps.

use super::super::list::{CONFUSION, List};
use super::super::memory::Memory;
use super::super::plant::{Plant, memory};
use etalon_cpu::Surface;
use etalon_cpu::steps::Moment;
use etalon_frame::Aspect;
use etalon_scene::Scene;
use std::collections::HashSet;

const ASPECTS: [(Aspect, &str); 3] = [
    (Aspect::Color, "color"),
    (Aspect::Depth, "depth"),
    (Aspect::Stencil, "stencil"),
];

/// Copies one aspect of an attachment.
fn restore(aspect: Aspect, from: &Surface, to: &mut Surface) {
    match aspect {
        Aspect::Stencil => to.stencil.clone_from(&from.stencil),
        Aspect::Color if !to.encodings.is_empty() => to.planes.clone_from(&from.planes),
        Aspect::Depth if to.encodings.is_empty() => to.planes.clone_from(&from.planes),
        _ => {}
    }
}

/// Restores one aspect of what a pass draws to, at `to`, as it was at `from`.
fn restored(
    aspect: Aspect,
    from: impl Fn(Moment) -> bool + Copy + Send + Sync + 'static,
    to: impl Fn(Moment, &Scene) -> bool + Copy + Send + Sync + 'static,
) -> Plant {
    memory(move || {
        let mut kept: Vec<Surface> = Vec::new();
        Memory::new(move |moment, scene, stored| {
            if to(moment, scene) && !kept.is_empty() {
                let (Moment::Begin { pass } | Moment::End { pass }) = moment else {
                    return;
                };
                let pass = &scene.passes[pass];
                for index in pass.color.iter().chain(&pass.depth_stencil) {
                    restore(aspect, &kept[*index], &mut stored.surfaces[*index]);
                }
            }
            if from(moment) {
                kept = stored.surfaces.to_vec();
            }
        })
    })
}

/// Keeps one aspect of all attachments from one submission to the next.
fn from_submission(aspect: Aspect) -> Plant {
    memory(move || {
        let mut kept: Vec<Surface> = Vec::new();
        Memory::new(move |moment, scene, stored| match moment {
            Moment::Initial => {
                for (from, to) in kept.iter().zip(stored.surfaces) {
                    restore(aspect, from, to);
                }
            }
            Moment::End { pass } if pass + 1 == scene.passes.len() => {
                kept = stored.surfaces.to_vec();
            }
            _ => {}
        })
    })
}

/// Textures that earlier passes drew are read as they began.
pub(super) fn textures_as_they_began() -> Plant {
    memory(|| {
        let mut began: Vec<Surface> = Vec::new();
        Memory::new(move |moment, scene, stored| match moment {
            Moment::Initial => began = stored.surfaces.to_vec(),
            Moment::Draw { pass, draw } | Moment::Drawn { pass, draw } => {
                let textures: HashSet<usize> = scene.passes[pass].draws[draw]
                    .textures
                    .iter()
                    .copied()
                    .collect();
                for texture in textures {
                    std::mem::swap(&mut began[texture], &mut stored.surfaces[texture]);
                }
            }
            _ => {}
        })
    })
}

pub(super) fn add(list: &mut List) {
    for (aspect, name) in ASPECTS {
        list.add(
            &format!("{name}-not-stored-by-the-first-pass"),
            CONFUSION,
            format!("The {name} that the first of several passes leaves is lost."),
            restored(
                aspect,
                |moment| moment == Moment::Begin { pass: 0 },
                |moment, scene| moment == Moment::End { pass: 0 } && scene.passes.len() > 1,
            ),
        );
        list.add(
            &format!("{name}-not-loaded"),
            CONFUSION,
            format!("A pass after the first finds the {name} that attachments began with."),
            restored(
                aspect,
                |moment| moment == Moment::Initial,
                |moment, _| matches!(moment, Moment::Begin { pass } if pass > 0),
            ),
        );
        list.add(
            &format!("{name}-of-the-last-pass-lost"),
            CONFUSION,
            format!("The {name} that the last of several passes leaves is lost."),
            restored(
                aspect,
                |moment| matches!(moment, Moment::Begin { .. }),
                |moment, scene| {
                    let last = scene.passes.len().saturating_sub(1);
                    last > 0 && moment == Moment::End { pass: last }
                },
            ),
        );
        list.add(
            &format!("{name}-kept-from-the-submission-before"),
            CONFUSION,
            format!("A submission begins with the {name} that the one before left."),
            from_submission(aspect),
        );
    }
    list.add(
        "later-submissions-draw-nothing",
        CONFUSION,
        "Only the first submission draws.",
        later_submissions(|_| true),
    );
    list.add(
        "later-submissions-lose-their-first-draw",
        CONFUSION,
        "Submissions after the first lose the first draw.",
        later_submissions(|moment| moment == Moment::Drawn { pass: 0, draw: 0 }),
    );
    list.add(
        "counts-added-over-submissions",
        CONFUSION,
        "Counters go on from the submission before.",
        memory(|| {
            let mut counts: Vec<u64> = Vec::new();
            Memory::new(move |moment, scene, stored| {
                if moment == Moment::Initial {
                    for (from, (_, to)) in counts.iter().zip(stored.counters.iter_mut()) {
                        *to = *from;
                    }
                }
                if matches!(moment, Moment::End { pass } if pass + 1 == scene.passes.len()) {
                    counts = stored.counters.iter().map(|(_, count)| *count).collect();
                }
            })
        }),
    );
}

/// Undoes draws of submissions after the first.
fn later_submissions(undone: fn(Moment) -> bool) -> Plant {
    memory(move || {
        let mut submissions = 0;
        let mut kept: Vec<Surface> = Vec::new();
        Memory::new(move |moment, _, stored| match moment {
            Moment::Initial => submissions += 1,
            Moment::Draw { .. } if submissions > 1 => kept = stored.surfaces.to_vec(),
            Moment::Drawn { .. } if submissions > 1 && undone(moment) => {
                stored.surfaces.clone_from_slice(&kept);
            }
            _ => {}
        })
    })
}
