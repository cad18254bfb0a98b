//! Drawing with innocents, and judging their frames under every specification.

use crate::drawing::draw_frames;
use crate::hunt::{broken, draw, sighting};
use etalon_backend::Backend;
use etalon_case::Case;
use etalon_frame::threads::each;
use etalon_frame::{Frame, Limits};
use etalon_judge::Judge;
use etalon_record::{InnocentRecord, Sighting, shard_of};
use std::collections::{HashMap, HashSet};

/// One innocent, and the limits and backends by which it is judged and drawn.
#[derive(Clone, Debug)]
pub struct PlannedInnocent {
    /// Its record without verdicts, with a tally for each specification.
    pub record: InnocentRecord,
    /// The limits that it reports under each specification, in the same order.
    pub limits: Vec<Limits>,
    /// The name of its backend under each specification.
    pub backends: Vec<String>,
}

/// Innocents, and the cases that must not accuse them.
#[derive(Clone, Copy, Debug)]
pub struct InnocentPlan<'a> {
    /// The cases. Selftests are left out: they fail on every backend.
    pub cases: &'a [Case],
    /// The innocents; profiles and the rasterizer itself are drawn with all cases.
    pub innocents: &'a [PlannedInnocent],
    /// The number of threads that draw and judge.
    pub jobs: usize,
}

/// The number of cases of a large file that are drawn with every single behaviour.
const SAMPLES: usize = 16;

/// The largest number of cases with which a file is drawn as a whole. A behaviour can show in one case alone, as a
/// format with a source.
const WHOLE_FILE: usize = 64;

/// Draws and judges cases with every innocent. `open` returns the backend of a name, `faithful` the rasterizer itself,
/// and each thread calls `drawn` after each case.
///
/// Frames that equal the rasterizer's are judged for the rasterizer itself alone. A single behaviour is drawn with
/// some cases of each file, and with the others of the file if a frame differs; the rasterizer itself and
/// profiles are drawn with all.
pub fn try_innocents(
    plan: InnocentPlan<'_>,
    faithful: &(dyn Fn() -> Box<dyn Backend> + Sync),
    open: &(dyn Fn(&str) -> Option<Box<dyn Backend>> + Sync),
    drawn: &(dyn Fn() + Sync),
) -> Vec<InnocentRecord> {
    if plan.innocents.is_empty() {
        return Vec::new();
    }
    let samples = samples(plan.cases);
    let draws_all = |number: usize| {
        let innocent = &plan.innocents[number].record.innocent;
        innocent.is_itself || innocent.is_profile
    };
    let first = |innocent: usize, case: usize| draws_all(innocent) || samples.contains(&case);
    let trial = Trial {
        plan,
        judge: Judge::default(),
        faithful,
        open,
    };
    let (mut records, changed) = trial.run(&first, drawn);
    let rest = |innocent: usize, case: usize| {
        let file = plan.cases[case].parts().file();
        !first(innocent, case) && changed.contains(&(innocent, file))
    };
    let (others, _) = trial.run(&rest, &|| {});
    let sums = records.iter_mut().zip(others);
    sums.for_each(|(sum, part)| sum.add(part));
    records
}

/// Returns the numbers of the cases that are drawn with every behaviour: some of each file, scattered over it.
fn samples(cases: &[Case]) -> HashSet<usize> {
    let mut files: HashMap<&str, Vec<(u32, usize)>> = HashMap::new();
    for (number, case) in cases.iter().enumerate() {
        let file = files.entry(case.parts().file()).or_default();
        file.push((shard_of(&case.id, u32::MAX), number));
    }
    let chosen = files.into_values().flat_map(|mut file| {
        file.sort_unstable();
        let count = if file.len() > WHOLE_FILE {
            SAMPLES
        } else {
            file.len()
        };
        file.into_iter().take(count)
    });
    chosen.map(|(_, number)| number).collect()
}

/// What both rounds share.
struct Trial<'a> {
    plan: InnocentPlan<'a>,
    judge: Judge,
    faithful: &'a (dyn Fn() -> Box<dyn Backend> + Sync),
    open: &'a (dyn Fn(&str) -> Option<Box<dyn Backend>> + Sync),
}

/// The innocents, by number, and the files in which their frames differ from the rasterizer's.
type ChangedFiles<'a> = HashSet<(usize, &'a str)>;

impl<'a> Trial<'a> {
    /// Draws the wanted pairs of innocent and case.
    fn run(
        &self,
        wanted: &(dyn Fn(usize, usize) -> bool + Sync),
        drawn: &(dyn Fn() + Sync),
    ) -> (Vec<InnocentRecord>, ChangedFiles<'a>) {
        let plan = self.plan;
        let jobs = plan.jobs.clamp(1, plan.cases.len().max(1));
        let numbers: Vec<usize> = (0..jobs).collect();
        let parts = each(jobs, &numbers, |job| {
            let faithful = (self.faithful)();
            let innocents = plan.innocents.iter().enumerate();
            let mut tried: Vec<_> = innocents
                .map(|(number, planned)| TriedInnocent::new(number, planned, self.open))
                .collect();
            let share = plan.cases.iter().enumerate().skip(*job).step_by(jobs);
            for (number, case) in share.filter(|(_, case)| case.judged_as.is_none()) {
                let chosen = tried.iter_mut().filter(|t| wanted(t.number, number));
                let chosen: Vec<_> = chosen.collect();
                if !chosen.is_empty() {
                    self.try_case((number, case), faithful.as_ref(), chosen);
                }
                drawn();
            }
            let changed = tried
                .iter_mut()
                .flat_map(|t| std::mem::take(&mut t.changed));
            let changed: Vec<(usize, &str)> = changed.collect();
            let records = tried.into_iter().map(|t| t.record);
            (records.collect::<Vec<_>>(), changed)
        });
        let mut records: Vec<InnocentRecord> =
            plan.innocents.iter().map(|p| p.record.clone()).collect();
        let mut files = ChangedFiles::new();
        for (part, changed) in parts {
            records
                .iter_mut()
                .zip(part)
                .for_each(|(sum, part)| sum.add(part));
            files.extend(changed);
        }
        (records, files)
    }

    fn try_case(
        &self,
        (number, case): (usize, &'a Case),
        faithful: &dyn Backend,
        tried: Vec<&mut TriedInnocent<'a>>,
    ) {
        let Ok(right) = draw_frames(faithful, case) else {
            return;
        };
        let requirements = case.requirements();
        let mut known = KnownSightings::default();
        for innocent in tried {
            let is_itself = innocent.record.innocent.is_itself;
            let mut differs = false;
            for SharedBackend {
                backend,
                specifications,
            } in &innocent.backends
            {
                let frames = match backend {
                    Some(backend) => draw(backend.as_ref(), case),
                    None => Err("there is no such innocent".to_owned()),
                };
                let tallies = &mut innocent.record.specifications;
                let frames = match frames {
                    Ok(frames) => frames,
                    Err(message) => {
                        for index in specifications {
                            tallies[*index].add(broken(case, message.clone()));
                        }
                        continue;
                    }
                };
                differs |= frames != right;
                if frames == right && !is_itself {
                    continue;
                }
                for index in specifications {
                    let limits = &innocent.planned.limits[*index];
                    if limits.missing(&requirements).is_some() {
                        continue;
                    }
                    let sighting = known.get(limits, &frames, || {
                        self.judged((number, case), limits, &frames)
                    });
                    let tally = &mut tallies[*index];
                    let is_shared = !is_itself && sighting.verdict.is_violation() && {
                        let own = known.get(limits, &right, || {
                            self.judged((number, case), limits, &right)
                        });
                        own.verdict.severity() >= sighting.verdict.severity()
                    };
                    if is_shared {
                        tally.share(Some(sighting.verdict));
                    } else {
                        tally.add(sighting);
                    }
                }
            }
            if differs {
                innocent.record.changed += 1;
                innocent
                    .changed
                    .insert((innocent.number, case.parts().file()));
            }
        }
    }

    /// Judges frames. Only a violation is graded, which takes longer.
    fn judged(
        &self,
        (number, case): (usize, &Case),
        limits: &Limits,
        frames: &[Frame],
    ) -> Sighting {
        match self.judge.verdict(number, case, limits, frames) {
            Err(message) => broken(case, message),
            Ok((verdict, texel)) if verdict.is_violation() => {
                let graded = self.judge.judge(number, case, "cpu", limits, frames);
                sighting(case, graded.record.verdict, texel)
            }
            Ok((verdict, texel)) => sighting(case, verdict, texel),
        }
    }
}

/// A backend of an innocent, and the specifications that judge it.
struct SharedBackend {
    /// The backend; `None` if its name is unknown.
    backend: Option<Box<dyn Backend>>,
    /// The indices of the specifications.
    specifications: Vec<usize>,
}

/// An innocent on one thread.
struct TriedInnocent<'a> {
    number: usize,
    planned: &'a PlannedInnocent,
    backends: Vec<SharedBackend>,
    record: InnocentRecord,
    changed: ChangedFiles<'a>,
}

impl<'a> TriedInnocent<'a> {
    fn new(
        number: usize,
        planned: &'a PlannedInnocent,
        open: &dyn Fn(&str) -> Option<Box<dyn Backend>>,
    ) -> Self {
        let mut names: Vec<(&str, Vec<usize>)> = Vec::new();
        for (index, name) in planned.backends.iter().enumerate() {
            match names.iter_mut().find(|(known, _)| known == name) {
                Some((_, specifications)) => specifications.push(index),
                None => names.push((name, vec![index])),
            }
        }
        let backends = names.into_iter();
        Self {
            number,
            planned,
            backends: backends
                .map(|(name, specifications)| SharedBackend {
                    backend: open(name),
                    specifications,
                })
                .collect(),
            record: planned.record.clone(),
            changed: ChangedFiles::new(),
        }
    }
}

/// The verdicts on the frames of one case.
#[derive(Default)]
struct KnownSightings<'a>(Vec<(&'a Limits, Vec<Frame>, Sighting)>);

impl<'a> KnownSightings<'a> {
    /// Returns the verdict on frames under some limits, which is computed if it is not known.
    fn get(
        &mut self,
        limits: &'a Limits,
        frames: &[Frame],
        judge: impl FnOnce() -> Sighting,
    ) -> Sighting {
        let known = self.0.iter().find(|(l, f, _)| *l == limits && f == frames);
        if let Some((_, _, sighting)) = known {
            return sighting.clone();
        }
        let sighting = judge();
        self.0.push((limits, frames.to_vec(), sighting.clone()));
        sighting
    }
}
