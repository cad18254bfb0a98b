//! Counters: the legal range of each, given the worlds of all samples.

use crate::rules::{Rules, SamplesCounted};
use crate::world::{Increment, World};
use etalon_frame::{CountRange, CounterKind, CounterSet};
use etalon_scene::{Query, Scene};

/// The count of a counter over the texels walked so far, and over the samples of the current texel.
#[derive(Clone, Debug)]
struct Count {
    low: u64,
    /// `None` if unlimited.
    high: Option<u64>,
    /// The certain events at this texel, summed over samples.
    certain: u64,
    /// The possible events at this texel, summed over samples; `None` if a sample is open.
    possible: Option<u64>,
    /// This texel's fragments with samples that certainly count, with the number of these samples; and its
    /// fragments with samples that can count.
    must: Vec<((u32, u32), u32)>,
    may: Vec<(u32, u32)>,
}

/// Sums of events, texel by texel.
pub(crate) struct EventTally<'a> {
    scene: &'a Scene,
    rules: &'a Rules,
    counts: Vec<Count>,
    /// For each draw of the scene, the least number of shader runs for a fully covered texel.
    least_runs: Vec<u32>,
}

impl<'a> EventTally<'a> {
    pub(crate) fn new(scene: &'a Scene, rules: &'a Rules) -> Self {
        let count = Count {
            low: 0,
            high: Some(0),
            certain: 0,
            possible: Some(0),
            must: Vec::new(),
            may: Vec::new(),
        };
        Self {
            scene,
            rules,
            counts: vec![count; scene.counters.len()],
            least_runs: scene
                .passes
                .iter()
                .flat_map(|pass| {
                    let samples = scene.pass_samples(pass);
                    let draws = pass.draws.iter();
                    draws.map(move |draw| {
                        let asked = draw.multisample.least_runs(samples);
                        // Either the shader runs per sample, or the minimum sample shading demands it.
                        if asked > 1
                            && !draw.shader.runs_per_sample()
                            && !rules.runs_by_share.value()
                        {
                            1
                        } else {
                            asked
                        }
                    })
                })
                .collect(),
        }
    }

    /// Adds `times` texels whose samples have these worlds; `None` for an open sample.
    pub(crate) fn texel<'w>(
        &mut self,
        samples: impl ExactSizeIterator<Item = Option<&'w [World]>>,
        times: u64,
    ) {
        let count = samples.len() as u32;
        samples.for_each(|worlds| self.sample(worlds));
        self.end_texel(count, times);
    }

    fn sample(&mut self, worlds: Option<&[World]>) {
        for (index, count) in self.counts.iter_mut().enumerate() {
            let Some(worlds) = worlds else {
                count.possible = None;
                continue;
            };
            let increments = |world: &World| -> Vec<Increment> {
                let events = world.events.iter().copied();
                events.filter(|e| usize::from(e.counter) == index).collect()
            };
            let each: Vec<Vec<Increment>> = worlds.iter().map(increments).collect();
            let certain =
                |events: &Vec<Increment>| events.iter().filter(|e| e.certain).count() as u64;
            count.certain += each.iter().map(certain).min().unwrap_or(0);
            let most = each.iter().map(|events| events.len() as u64).max();
            count.possible = count.possible.map(|p| p + most.unwrap_or(0));
            let mut here: Vec<(u32, u32)> = Vec::new();
            for event in each.iter().flatten() {
                if !count.may.contains(&event.fragment) {
                    count.may.push(event.fragment);
                }
                let sure = |events: &Vec<Increment>| {
                    let same = |e: &Increment| e.certain && e.fragment == event.fragment;
                    events.iter().any(same)
                };
                if !here.contains(&event.fragment) && each.iter().all(sure) {
                    here.push(event.fragment);
                }
            }
            for fragment in here {
                match count.must.iter_mut().find(|(f, _)| *f == fragment) {
                    Some((_, samples)) => *samples += 1,
                    None => count.must.push((fragment, 1)),
                }
            }
        }
    }

    /// Ends a texel of `samples` samples that stands for `times` equal texels.
    fn end_texel(&mut self, samples: u32, times: u64) {
        for (counter, count) in self.scene.counters.iter().zip(&mut self.counts) {
            let (low, high) = match counter.kind {
                CounterKind::SamplesPassed | CounterKind::AnySamplesPassed => {
                    let all_samples = count.may.len() as u64 * u64::from(samples);
                    let high = match self.rules.samples_counted.value() {
                        SamplesCounted::Passing => count.possible,
                        SamplesCounted::PassingOrAll => count.possible.map(|p| p.max(all_samples)),
                    };
                    (count.certain, high)
                }
                // The shader never runs without a fragment. The rules decide how often it runs for a
                // fragment: at most once for each covered sample, or without a limit.
                CounterKind::ShaderRuns => {
                    let none = count.possible == Some(0);
                    let is_told = || samples == 1 || self.rules.samples_as_told.value();
                    let high = if self.rules.runs_once.value() && is_told() {
                        count.possible
                    } else {
                        none.then_some(0)
                    };
                    // Each run is for a sample of its own, but some of the runs can be for uncovered samples.
                    let runs = |((draw, _), covered): &((u32, u32), u32)| {
                        let least = self.least_runs[*draw as usize - 1];
                        u64::from((least + covered).saturating_sub(samples).max(1))
                    };
                    (count.must.iter().map(runs).sum(), high)
                }
                // Statistics are only meant to compare a driver with itself (Vulkan, Pipeline Statistics
                // Queries).
                CounterKind::FragmentInvocations => (0, None),
            };
            count.low += low * times;
            count.high = count.high.zip(high).map(|(a, b)| a + b * times);
            (count.certain, count.possible) = (0, Some(0));
            count.must.clear();
            count.may.clear();
        }
    }

    /// Returns the legal range of each counter.
    pub(crate) fn finish(self) -> impl Iterator<Item = CounterSet> + use<'a> {
        let queries = self.scene.queries();
        let each = self.scene.counters.iter().zip(self.counts).enumerate();
        each.map(move |(index, (counter, count))| {
            let counts_more = |query: &Query| {
                query.over_passes && !self.rules.operations_count_nothing.value()
                    || query.encloses_clears(self.scene) && !self.rules.clears_count_nothing.value()
            };
            let mut own = queries.iter().filter(|q| q.counter == index);
            let unlimited = counter.kind.is_occlusion() && own.any(counts_more);
            let range = CountRange {
                low: count.low,
                high: count.high.filter(|_| !unlimited),
            };
            CounterSet {
                name: counter.name.clone(),
                kind: counter.kind,
                range: match counter.kind {
                    CounterKind::AnySamplesPassed => CountRange {
                        low: range.low.min(1),
                        high: range.high.map(|high| high.min(1)),
                    },
                    _ => range,
                },
            }
        })
    }
}
