//! Drawing with innocents: every case is drawn with every legal behaviour, and judged under every specification.

use crate::drawing::draw_frames;
use crate::hunt::{broken, draw, sighting};
use etalon_backend::Backend;
use etalon_case::Case;
use etalon_frame::threads::each;
use etalon_frame::{Frame, Limits};
use etalon_judge::Judge;
use etalon_record::{InnocentRecord, Sighting};
use std::collections::HashMap;

/// One innocent and what judges it.
#[derive(Clone, Debug)]
pub struct PlannedInnocent {
    /// Its record without verdicts, with a tally for each specification.
    pub record: InnocentRecord,
    /// The limits that it reports under each specification, in the same order.
    pub limits: Vec<Limits>,
}

/// Innocents, and the cases that must not accuse them.
#[derive(Clone, Copy, Debug)]
pub struct InnocentPlan<'a> {
    /// The cases. Selftests are left out: they fail on every backend.
    pub cases: &'a [Case],
    /// The innocents.
    pub innocents: &'a [PlannedInnocent],
    /// The number of threads.
    pub jobs: usize,
}

/// Draws and judges the cases with every innocent. `open` returns the backend of a name, `faithful` the rasterizer
/// itself, and each thread calls `drawn` after each case.
///
/// Frames that equal the rasterizer's are judged for the rasterizer itself alone. A single change is drawn with some
/// cases of each file, and with all that follow once a frame differs; the rasterizer itself and profiles with all.
pub fn try_innocents(
    plan: InnocentPlan<'_>,
    faithful: &(dyn Fn() -> Box<dyn Backend> + Sync),
    open: &(dyn Fn(&str) -> Option<Box<dyn Backend>> + Sync),
    drawn: &(dyn Fn() + Sync),
) -> Vec<InnocentRecord> {
    let judge = Judge::default();
    let jobs = plan.jobs.clamp(1, plan.cases.len().max(1));
    let mut file_sizes: HashMap<&str, usize> = HashMap::new();
    for case in plan.cases {
        *file_sizes.entry(case.parts().file()).or_default() += 1;
    }
    let numbers: Vec<usize> = (0..jobs).collect();
    let parts = each(jobs, &numbers, |job| {
        let faithful = faithful();
        let mut tried: Vec<TriedInnocent<'_>> = plan
            .innocents
            .iter()
            .map(|planned| TriedInnocent {
                planned,
                backend: open(&planned.record.innocent.name),
                record: planned.record.clone(),
                changed_in_file: 0,
            })
            .collect();
        let mut file = "";
        let mut number_in_file = 0;
        let share = plan.cases.iter().enumerate().skip(*job).step_by(jobs);
        for (number, case) in share {
            if std::mem::replace(&mut file, case.parts().file()) != file {
                number_in_file = 0;
                tried
                    .iter_mut()
                    .for_each(|innocent| innocent.changed_in_file = 0);
            }
            let step = file_sizes[file].div_ceil(jobs * LEAST).max(1);
            let is_sample = number_in_file % step == 0;
            number_in_file += 1;
            if case.judged_as.is_none() {
                let chosen = tried
                    .iter_mut()
                    .filter(|innocent| is_sample || innocent.draws_all());
                try_case(&judge, (number, case), faithful.as_ref(), chosen);
            }
            drawn();
        }
        tried
            .into_iter()
            .map(|tried| tried.record)
            .collect::<Vec<_>>()
    });
    let sum = parts.into_iter().reduce(|mut sum, part| {
        sum.iter_mut()
            .zip(part)
            .for_each(|(sum, part)| sum.add(part));
        sum
    });
    sum.unwrap_or_default()
}

/// The least number of cases of a file that a thread draws with a single change, if there are as many.
const LEAST: usize = 8;

/// An innocent on one thread.
struct TriedInnocent<'a> {
    planned: &'a PlannedInnocent,
    backend: Option<Box<dyn Backend>>,
    record: InnocentRecord,
    /// The number of cases of the current file whose frames differ from the rasterizer's.
    changed_in_file: usize,
}

impl TriedInnocent<'_> {
    /// Returns true if it is drawn with every case of the current file.
    fn draws_all(&self) -> bool {
        let innocent = &self.record.innocent;
        innocent.is_itself || innocent.is_profile || self.changed_in_file > 0
    }
}

/// A verdict on frames under some limits.
type KnownSighting<'a> = (&'a Limits, Vec<Frame>, Sighting);

fn try_case<'t, 'p: 't>(
    judge: &Judge,
    (number, case): (usize, &Case),
    faithful: &dyn Backend,
    tried: impl Iterator<Item = &'t mut TriedInnocent<'p>>,
) {
    let Ok(right) = draw_frames(faithful, case) else {
        return;
    };
    let mut known: Vec<KnownSighting<'_>> = Vec::new();
    for innocent in tried {
        let is_itself = innocent.planned.record.innocent.is_itself;
        let frames = match &innocent.backend {
            Some(backend) => draw(backend.as_ref(), case),
            None => Err("there is no such innocent".to_owned()),
        };
        let tallies = innocent.record.specifications.iter_mut();
        let judged = tallies.zip(&innocent.planned.limits);
        match frames {
            Err(message) => judged.for_each(|(tally, _)| tally.add(broken(case, message.clone()))),
            Ok(frames) if frames == right && !is_itself => {}
            Ok(frames) => {
                innocent.record.changed += u64::from(frames != right);
                innocent.changed_in_file += usize::from(frames != right);
                for (tally, limits) in judged {
                    if limits.missing(&case.requirements()).is_some() {
                        continue;
                    }
                    let same = known.iter().find(|(l, f, _)| *l == limits && *f == frames);
                    let sighting = match same {
                        Some((_, _, sighting)) => sighting.clone(),
                        None => judged_as(judge, (number, case), limits, &frames),
                    };
                    known.push((limits, frames.clone(), sighting.clone()));
                    let is_shared = !is_itself && sighting.verdict.is_violation() && {
                        let own = judged_as(judge, (number, case), limits, &right);
                        own.verdict.severity() >= sighting.verdict.severity()
                    };
                    if is_shared {
                        tally.shared += 1;
                    } else {
                        tally.add(sighting);
                    }
                }
            }
        }
    }
}

/// Judges frames. Only a violation is graded, which takes longer.
fn judged_as(
    judge: &Judge,
    (number, case): (usize, &Case),
    limits: &Limits,
    frames: &[Frame],
) -> Sighting {
    match judge.verdict(number, case, limits, frames) {
        Err(message) => broken(case, message),
        Ok((verdict, texel)) if verdict.is_violation() => {
            let graded = judge
                .judge(number, case, "cpu", limits, frames)
                .record
                .verdict;
            sighting(case, graded, texel)
        }
        Ok((verdict, texel)) => sighting(case, verdict, texel),
    }
}
