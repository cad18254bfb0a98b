//! The hunt for planted bugs: every mutant draws every case, in this process, on all cores.

use crate::drawing::draw_frames;
use etalon_backend::Backend;
use etalon_case::Case;
use etalon_frame::threads::each;
use etalon_frame::{Frame, WrongTexel};
use etalon_judge::Judge;
use etalon_record::{AreaTally, Catch, MutantInfo, MutantRecord, Sighting, Verdict};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// The planted bugs of a hunt, and the cases that must catch them.
#[derive(Clone, Copy, Debug)]
pub struct HuntPlan<'a> {
    /// The cases. Selftests are left out: they fail on every backend.
    pub cases: &'a [Case],
    /// The planted bugs, in the order of their records.
    pub mutants: &'a [MutantInfo],
    /// True to draw every case with every bug; otherwise an area ends at a bug's first `Fail` there.
    pub full: bool,
    /// The number of threads that draw and judge.
    pub jobs: usize,
}

/// The result of a hunt.
#[derive(Clone, Debug, Default)]
pub struct Hunted {
    /// The record of each bug, in the order of the plan.
    pub records: Vec<MutantRecord>,
    /// The bugs that each case caught, in the order of the plan's cases.
    pub catches: Vec<Catches>,
}

/// The bugs that one case caught.
#[derive(Clone, Debug, Default)]
pub struct Catches {
    /// The indices of the bugs, in the order of the plan, on which the case failed.
    pub bugs: Vec<usize>,
    /// The time to draw and judge the case with one bug; zero if none was drawn.
    pub cost: Duration,
}

/// Draws and judges the cases with every bug planted. `open` returns the backend with the named bug, and each
/// thread calls `drawn` after each case.
///
/// Every thread has its own part of the bugs and draws the cases in order, so that state that a bug carries
/// from one case to the next is always the same.
pub fn hunt(
    plan: HuntPlan<'_>,
    open: &(dyn Fn(&str) -> Option<Box<dyn Backend>> + Sync),
    drawn: &(dyn Fn() + Sync),
) -> Hunted {
    if plan.mutants.is_empty() {
        return Hunted {
            records: Vec::new(),
            catches: vec![Catches::default(); plan.cases.len()],
        };
    }
    let judge = Judge::default();
    let jobs = plan.jobs.clamp(1, plan.mutants.len());
    let numbers: Vec<usize> = (0..jobs).collect();
    let found = each(jobs, &numbers, |job| {
        let mut share: Vec<HuntedMutant> = plan
            .mutants
            .iter()
            .enumerate()
            .skip(*job)
            .step_by(jobs)
            .map(|(number, info)| HuntedMutant::new(number, info, open(&info.name)))
            .collect();
        let mut catches = Vec::with_capacity(plan.cases.len());
        for (number, case) in plan.cases.iter().enumerate() {
            catches.push(match case.judged_as {
                None => try_case(&judge, number, case, &mut share, plan.full),
                Some(_) => Catches::default(),
            });
            drawn();
        }
        let records = share.into_iter().map(|mutant| (mutant.at, mutant.record));
        (records.collect::<Vec<_>>(), catches)
    });
    let mut catches = vec![Catches::default(); plan.cases.len()];
    let mut records = Vec::new();
    for (share, caught) in found {
        records.extend(share);
        for (sum, part) in catches.iter_mut().zip(caught) {
            sum.bugs.extend(part.bugs);
            sum.cost = sum.cost.max(part.cost);
        }
    }
    records.sort_by_key(|(at, _)| *at);
    Hunted {
        records: records.into_iter().map(|(_, record)| record).collect(),
        catches,
    }
}

/// Draws one case with each of a thread's bugs. Most bugs give one of a few frames, and each distinct frame
/// is judged only once.
fn try_case(
    judge: &Judge,
    number: usize,
    case: &Case,
    share: &mut [HuntedMutant],
    full: bool,
) -> Catches {
    let mut catches = Catches::default();
    let mut seen: Vec<(Vec<Frame>, Sighting)> = Vec::new();
    let large = is_large(case);
    for mutant in share {
        let foreign = mutant.record.mutant.area != case.parts().area();
        if large && foreign {
            continue;
        }
        let area = mutant.area(case.parts().area());
        let tally = &mutant.record.areas[area];
        if !full && tally.fail > 0 {
            continue;
        }
        let Some(backend) = &mutant.backend else {
            continue;
        };
        let start = Instant::now();
        let sighting = match draw(backend.as_ref(), case) {
            Err(message) => broken(case, message),
            Ok(frames) => match seen.iter().find(|(known, _)| *known == frames) {
                Some((_, sighting)) => sighting.clone(),
                None => {
                    let limits = backend.limits();
                    let sighting = match judge.verdict(number, case, limits, &frames) {
                        Err(message) => broken(case, message),
                        Ok((verdict, texel)) => sighting(case, verdict, texel),
                    };
                    seen.push((frames, sighting.clone()));
                    sighting
                }
            },
        };
        // A bug that panics in a scene that it was not made for proves nothing.
        if foreign && sighting.verdict == Verdict::InternalError {
            continue;
        }
        if catches.cost.is_zero() {
            catches.cost = start.elapsed();
        }
        if sighting.verdict.is_violation() {
            catches.bugs.push(mutant.at);
        }
        mutant.note(area, sighting);
    }
    catches
}

/// Returns true if a case takes as long as hundreds of typical cases: it draws to more than 64 by 64 texels,
/// has many draws or vertices, or is submitted often. Such cases are drawn only with the bugs of their own
/// area.
fn is_large(case: &Case) -> bool {
    let texels = |size: [u32; 2]| u64::from(size[0]) * u64::from(size[1]);
    let sizes = case.scene.attachments.iter().map(|a| texels(a.size));
    let draws = || case.scene.passes.iter().flat_map(|pass| &pass.draws);
    let submissions: u32 = case.preparations().flat_map(|(_, readings)| readings).sum();
    sizes.max().is_some_and(|most| most > 64 * 64)
        || draws().count() > 500
        || draws().map(|draw| draw.mesh.vertices.len()).sum::<usize>() > 5_000
        || submissions > 20
}

pub(crate) fn sighting(case: &Case, verdict: Verdict, texel: Option<WrongTexel>) -> Sighting {
    Sighting {
        case: case.id.clone(),
        verdict,
        texel,
        message: String::new(),
    }
}

pub(crate) fn broken(case: &Case, message: String) -> Sighting {
    Sighting {
        message,
        ..sighting(case, Verdict::InternalError, None)
    }
}

/// Draws a case's scenes once each. If the mutant panics, it is reported as broken, and the hunt continues.
pub(crate) fn draw(backend: &dyn Backend, case: &Case) -> Result<Vec<Frame>, String> {
    match catch_unwind(AssertUnwindSafe(|| draw_frames(backend, case))) {
        Ok(outcome) => outcome.map_err(|e| e.to_string()),
        Err(_) => Err("it panicked".to_owned()),
    }
}

/// A planted bug that is being hunted.
struct HuntedMutant {
    at: usize,
    backend: Option<Box<dyn Backend>>,
    record: MutantRecord,
}

impl HuntedMutant {
    fn new(number: usize, info: &MutantInfo, backend: Option<Box<dyn Backend>>) -> Self {
        Self {
            at: number,
            record: MutantRecord {
                mutant: info.clone(),
                outcome: if backend.is_some() {
                    Catch::Survived
                } else {
                    Catch::Broken
                },
                areas: Vec::new(),
                first: None,
            },
            backend,
        }
    }

    /// Returns the index of an area's tally.
    fn area(&mut self, name: &str) -> usize {
        let areas = &mut self.record.areas;
        if let Some(index) = areas.iter().position(|a| a.area == name) {
            return index;
        }
        areas.push(AreaTally {
            area: name.to_owned(),
            pass: 0,
            imprecise: 0,
            fail: 0,
            broken: 0,
        });
        areas.len() - 1
    }

    fn note(&mut self, area: usize, sighting: Sighting) {
        let tally = &mut self.record.areas[area];
        let (count, outcome) = match sighting.verdict {
            Verdict::Pass => (&mut tally.pass, Catch::Survived),
            Verdict::Imprecise => (&mut tally.imprecise, Catch::Noticed),
            verdict if verdict.is_violation() => (&mut tally.fail, Catch::Caught),
            _ => (&mut tally.broken, Catch::Broken),
        };
        *count += 1;
        let weight = |outcome| match outcome {
            Catch::Survived => 0,
            Catch::Noticed => 1,
            Catch::Caught => 2,
            Catch::Broken => 3,
        };
        if weight(outcome) > weight(self.record.outcome) {
            self.record.outcome = outcome;
            self.record.first = Some(sighting);
        }
    }
}
