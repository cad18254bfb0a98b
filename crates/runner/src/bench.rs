//! Benches: pictures are judged first, then rounds of frame times interleave over cases and adapters.
//!
//! Every round starts new workers, because the memory layout of a process changes its times by several per
//! cent; measured in only one process, that shift would look like a property of the driver. Within a round,
//! each case is timed on one adapter after another, so that drift of the machine affects all of them. All
//! adapters' workers run during a round, but only one works at a time.

mod clock;
mod instructions;
mod round;
mod ruler;

use crate::drawing::Drawing;
use crate::launch::Launch;
use crate::loss::RequestError;
use crate::process::Wait;
use crate::supervisor::{BadEnds, FailedStarts, Supervisor};
use crate::worker::Worker;
use etalon_case::Case;
use etalon_frame::Limits;
use etalon_judge::{Judge, changed_picture};
use etalon_record::{
    AdapterRecord, BenchHeader, BenchLine, BenchRecord, BenchWriter, CellRate, Done, Ended, Enough,
    Expectations, InstructionCounter, Picture, Reason, Record, RecordError, Round, Time, Verdict,
    beside, cell, count_unexpected,
};
use etalon_stats::{MIN_ROUNDS, is_within, median_interval, quantile};
pub use instructions::instruction_counter;
use round::{fingerprint, seconds};
use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use thiserror::Error;

/// The cases and adapters of a bench, and the folder that it is written to.
pub struct BenchPlan<'a> {
    /// The cases, each once.
    pub cases: &'a [Case],
    /// Each adapter's launch command, and its running worker, which draws the pictures that are judged.
    pub adapters: Vec<(Launch, Worker)>,
    /// The approximate total time of a case's timed frames on an adapter in each round; the warm-up may
    /// take the same time again.
    pub budget: Duration,
    /// The time limit for each answer of a worker.
    pub timeout: Duration,
    /// The program that counts the instructions of a frame on software adapters; `None` counts none.
    pub counter: Option<InstructionCounter>,
    /// The bad verdicts that do not count against the bench.
    pub expectations: &'a Expectations,
    /// True to continue the bench in the folder by measuring its missing rounds.
    pub resume: bool,
    /// The bench folder, which the bench creates or, with `resume`, continues.
    pub folder: &'a Path,
    /// The header of the bench, with its number of rounds.
    pub header: BenchHeader,
    /// No picture and no round begins once it is true.
    pub stop: &'a AtomicBool,
}

/// An event of a bench, reported as it happens.
#[derive(Clone, Debug)]
pub enum BenchEvent {
    /// A picture was judged.
    Judged {
        /// The picture, with its verdict.
        picture: Picture,
        /// True if the verdict counts against the bench.
        unexpected: bool,
        /// The number of rounds that the bench already has.
        rounds_done: u32,
    },
    /// The instructions of a case's frame were counted on an adapter.
    Counted {
        /// The case.
        case: String,
        /// The adapter.
        adapter: String,
        /// The reason if they could not be counted.
        failed: Option<String>,
    },
    /// A round of a case on an adapter is complete.
    Timed {
        /// The case.
        case: String,
        /// The adapter.
        adapter: String,
    },
    /// A case needs no more rounds on an adapter.
    Done {
        /// The case and the adapter, with the reason.
        done: Done,
        /// The number of rounds that are not needed.
        spared: u32,
    },
    /// A case has no more rounds on an adapter, although some are missing.
    Ended {
        /// The reason.
        ended: Ended,
        /// The number of missing rounds.
        missing: u32,
    },
}

/// The counts of a bench.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BenchSummary {
    /// Pictures that were judged.
    pub pictures: u64,
    /// Pictures whose frames were timed.
    pub timed: u64,
    /// Unexpected verdicts of pictures, rounds that failed, and workers that failed after their last case.
    pub unexpected: u64,
}

/// The reason why a bench could not be completed.
#[derive(Debug, Error)]
pub enum BenchError {
    /// The bench folder could not be started; nothing was timed.
    #[error(transparent)]
    Folder(RecordError),
    /// The bench folder can no longer be written to; the lines written before are readable.
    #[error("the bench is incomplete: {0}")]
    Write(RecordError),
}

/// Returns a description of this version's ruler, for [`BenchHeader::ruler`].
pub fn ruler() -> &'static str {
    ruler::RULER
}

/// Judges every case's picture on every adapter, and times the pictures that are right.
///
/// # Errors
/// If the bench folder cannot be written to.
pub fn bench(
    plan: BenchPlan<'_>,
    events: &mut dyn FnMut(BenchEvent),
) -> Result<BenchSummary, BenchError> {
    let (writer, before) = if plan.resume {
        let resumed = BenchWriter::resume(plan.folder, &plan.header);
        let (writer, before) = resumed.map_err(BenchError::Folder)?;
        (writer, before.records)
    } else {
        let begun = BenchWriter::create(plan.folder, &plan.header);
        (begun.map_err(BenchError::Folder)?, Vec::new())
    };
    let last = before.iter().flat_map(|r| &r.rounds).map(|round| round.at);
    let offset = last.fold(0.0, f64::max);
    let before = before.into_iter().map(|record| {
        let picture = &record.picture;
        ((picture.case.clone(), picture.adapter.clone()), record)
    });
    let adapters = plan
        .adapters
        .into_iter()
        .map(|(launch, worker)| BenchAdapter {
            spent: Duration::ZERO,
            record: AdapterRecord::from(&worker),
            launch: launch.clone(),
            supervisor: Supervisor::new(
                launch,
                None,
                FailedStarts::default(),
                BadEnds::default(),
                Some(worker),
            ),
        })
        .collect();
    let mut bench = RunningBench {
        cases: plan.cases,
        adapters,
        expectations: plan.expectations,
        writer,
        events,
        summary: BenchSummary::default(),
        before: before.collect(),
        offset,
        start: Instant::now(),
        timeout: plan.timeout,
        rounds: plan.header.rounds,
        within: plan.header.settings.within,
        limit: plan.header.settings.limit.map(Duration::from_secs_f64),
        budget: plan.budget,
        counter: plan.counter,
        stop: plan.stop,
    };
    let run = |bench: &mut RunningBench<'_, '_>| -> Result<(), RecordError> {
        let mut pairs = bench.judge()?;
        bench.count(&mut pairs)?;
        for number in 0..bench.rounds {
            bench.finish(number, &mut pairs)?;
            if bench.is_stopped() {
                return Ok(());
            }
            bench.round(number, &mut pairs)?;
        }
        bench.finish(bench.rounds, &mut pairs)?;
        Ok(())
    };
    run(&mut bench).map_err(BenchError::Write)?;
    let mut ends = beside::read(plan.folder).map_err(BenchError::Write)?;
    for BenchAdapter {
        supervisor, record, ..
    } in &mut bench.adapters
    {
        supervisor.stop();
        let bad_ends = supervisor.bad_ends();
        beside::add(&mut ends, bad_ends.take(record, plan.expectations));
    }
    beside::write(plan.folder, &ends).map_err(BenchError::Write)?;
    bench.summary.unexpected += count_unexpected(&ends);
    Ok(bench.summary)
}

/// An adapter and its worker.
struct BenchAdapter {
    record: AdapterRecord,
    launch: Launch,
    supervisor: Supervisor,
    /// The time that the adapter's rounds took.
    spent: Duration,
}

impl BenchAdapter {
    /// Returns true if the adapter's rounds have used up their time.
    fn is_spent(&self, limit: Option<Duration>) -> bool {
        limit.is_some_and(|limit| self.spent >= limit)
    }
}

/// A case and an adapter that draws it correctly, both by index, with the fingerprint of the picture.
struct TimedPair {
    case: usize,
    adapter: usize,
    picture: u64,
    /// The pair's record, with the rounds that it already has.
    record: BenchRecord,
    /// The name of the case's cell in the performance matrix.
    cell: Option<String>,
}

impl TimedPair {
    fn rounds(&self) -> u32 {
        self.record.rounds.len() as u32
    }
}

struct RunningBench<'a, 'e> {
    cases: &'a [Case],
    adapters: Vec<BenchAdapter>,
    expectations: &'a Expectations,
    writer: BenchWriter,
    events: &'e mut dyn FnMut(BenchEvent),
    summary: BenchSummary,
    /// The rounds of the bench that is continued, by case and adapter.
    before: HashMap<(String, String), BenchRecord>,
    /// The time of the last earlier round, in seconds.
    offset: f64,
    start: Instant,
    timeout: Duration,
    rounds: u32,
    within: Option<f64>,
    limit: Option<Duration>,
    budget: Duration,
    counter: Option<InstructionCounter>,
    stop: &'a AtomicBool,
}

impl RunningBench<'_, '_> {
    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Judges all pictures. Returns the pairs that may be timed, in the order of timing.
    fn judge(&mut self) -> Result<Vec<TimedPair>, RecordError> {
        let judge = Judge::default();
        let mut pairs = Vec::new();
        for (number, case) in self.cases.iter().enumerate() {
            for index in 0..self.adapters.len() {
                if self.is_stopped() {
                    return Ok(pairs);
                }
                let key = (
                    case.id.clone(),
                    self.adapters[index].record.info.name.clone(),
                );
                let known = self.before.remove(&key);
                if let Some(known) = &known
                    && !self.lacks_rounds(known)
                    && !self.lacks_count(known, index)
                {
                    self.skip(known);
                    continue;
                }
                let (mut record, picture) = self.draw(&judge, number, case, index);
                record.expect(self.expectations, &self.adapters[index].record);
                let channels: u64 = record.assertions.iter().map(|a| a.channels).sum();
                let asserted: u64 = record.assertions.iter().map(|a| a.asserted).sum();
                let unexpected = record.unexpected();
                let judged = Picture {
                    case: case.id.clone(),
                    adapter: record.adapter.clone(),
                    verdict: record.verdict,
                    asserted: asserted as f64 / channels.max(1) as f64,
                    accuracy: record.accuracy.clone(),
                    reasons: reasons(record),
                    work: Some(case.scene.work()),
                };
                let rounds = known.as_ref().map_or(0, |k| k.rounds.len() as u32);
                if known.is_none() {
                    self.writer.append(&BenchLine::Picture(judged.clone()))?;
                } else if !judged.may_be_timed() {
                    self.end(&judged, rounds)?;
                }
                self.summary.pictures += 1;
                self.summary.unexpected += u64::from(unexpected);
                if let Some(picture) = picture
                    && judged.may_be_timed()
                {
                    self.summary.timed += 1;
                    pairs.push(TimedPair {
                        case: number,
                        adapter: index,
                        picture,
                        cell: cell(&case.id),
                        record: known.unwrap_or_else(|| BenchRecord {
                            picture: judged.clone(),
                            counted: None,
                            rounds: Vec::new(),
                            ended: None,
                            enough: None,
                        }),
                    });
                }
                (self.events)(BenchEvent::Judged {
                    picture: judged,
                    unexpected,
                    rounds_done: rounds,
                });
            }
        }
        Ok(pairs)
    }

    /// Returns true if a case on an adapter is not complete.
    fn lacks_rounds(&self, known: &BenchRecord) -> bool {
        known.is_open() && known.rounds.len() < self.rounds as usize
    }

    /// Returns true if the instructions of a case on an adapter must still be counted.
    fn lacks_count(&self, known: &BenchRecord, adapter: usize) -> bool {
        self.counter.is_some()
            && self.adapters[adapter].record.info.software
            && known.picture.may_be_timed()
            && known.counted.is_none()
    }

    /// Counts the instructions of all pairs on software adapters, before their frames are timed, and keeps the
    /// pairs that may still be timed.
    fn count(&mut self, pairs: &mut Vec<TimedPair>) -> Result<(), RecordError> {
        let Some(counter) = self.counter else {
            return Ok(());
        };
        for pair in pairs.iter_mut() {
            if !self.lacks_count(&pair.record, pair.adapter) {
                continue;
            }
            let case = &self.cases[pair.case];
            let adapter = &self.adapters[pair.adapter];
            let names = [case.id.as_str(), adapter.record.info.name.as_str()];
            let (launch, scene) = (&adapter.launch, &case.scene);
            let counted = instructions::count(counter, launch, names, scene, self.timeout);
            let failed = match counted {
                Ok(counted) => {
                    self.writer.append(&BenchLine::Counted(counted.clone()))?;
                    pair.record.counted = Some(counted);
                    None
                }
                Err(reason) => Some(reason),
            };
            (self.events)(BenchEvent::Counted {
                case: case.id.clone(),
                adapter: adapter.record.info.name.clone(),
                failed,
            });
        }
        pairs.retain(|pair| pair.record.is_open());
        Ok(())
    }

    /// Counts a case on an adapter that is already complete.
    fn skip(&mut self, known: &BenchRecord) {
        self.summary.pictures += 1;
        self.summary.timed += u64::from(known.picture.may_be_timed());
        let ended = known.ended.as_ref().is_some_and(|e| e.verdict.is_bad());
        self.summary.unexpected += u64::from(ended);
        (self.events)(BenchEvent::Judged {
            picture: known.picture.clone(),
            unexpected: false,
            rounds_done: self.rounds,
        });
    }

    /// Ends a case whose picture was right before the bench was stopped but no longer is.
    fn end(&mut self, judged: &Picture, had: u32) -> Result<(), RecordError> {
        let ended = Ended {
            case: judged.case.clone(),
            adapter: judged.adapter.clone(),
            verdict: judged.verdict,
            reasons: [vec![Reason::WhenResumed], judged.reasons.clone()].concat(),
        };
        self.writer.append(&BenchLine::Ended(ended.clone()))?;
        (self.events)(BenchEvent::Ended {
            ended,
            missing: self.rounds - had,
        });
        Ok(())
    }

    /// Draws a case once and judges it. Returns the record and the fingerprint of the picture.
    fn draw(
        &mut self,
        judge: &Judge,
        number: usize,
        case: &Case,
        index: usize,
    ) -> (Record, Option<u64>) {
        let adapter = &mut self.adapters[index];
        let limits: Limits = adapter.record.limits.clone();
        let name = adapter.record.info.name.clone();
        let undrawn = |mut record: Record| {
            record.due_fail = case.judged_as.is_some();
            (record, None)
        };
        if let Some(missing) = limits.missing(&case.requirements()) {
            let mut record = Record::new(&case.id, &name, Verdict::NotSupported);
            record.reasons = vec![Reason::Missing(missing)];
            return undrawn(record);
        }
        let drawing = match adapter.supervisor.worker() {
            Ok(worker) => worker.draw_case(0, case, Wait::of(self.timeout)),
            Err(loss) => Drawing::failed(loss.into()),
        };
        match drawing.frames {
            Ok(frames) => {
                let judged = judge.judge(number, case, &name, &limits, &frames);
                (judged.record, frames.first().map(fingerprint))
            }
            Err(failure) => {
                let report = adapter.supervisor.report(failure);
                undrawn(report.record(&case.id, &name))
            }
        }
    }

    /// Removes the pairs that need no further round: all pairs of an adapter whose time has run out, and
    /// pairs whose intervals are narrow enough.
    fn finish(&mut self, number: u32, pairs: &mut Vec<TimedPair>) -> Result<(), RecordError> {
        let within = self.within.filter(|_| number as usize >= MIN_ROUNDS);
        let enough: Vec<Option<Enough>> = pairs
            .iter()
            .map(|pair| {
                let adapter = &self.adapters[pair.adapter];
                if pair.rounds() >= self.rounds {
                    return None;
                }
                if adapter.is_spent(self.limit) {
                    return Some(Enough::Limit);
                }
                let narrow = |share| is_narrow(pair, pairs, adapter.record.info.software, share);
                within
                    .filter(|share| narrow(*share))
                    .map(|_| Enough::Within)
            })
            .collect();
        let mut enough = enough.into_iter();
        let mut done = Vec::new();
        pairs.retain(|pair| match enough.next().flatten() {
            None => true,
            Some(enough) => {
                let line = Done {
                    case: pair.record.picture.case.clone(),
                    adapter: pair.record.picture.adapter.clone(),
                    enough,
                };
                done.push((line, pair.rounds()));
                false
            }
        });
        for (done, had) in done {
            self.writer.append(&BenchLine::Done(done.clone()))?;
            let spared = self.rounds.saturating_sub(had);
            (self.events)(BenchEvent::Done { done, spared });
        }
        Ok(())
    }

    /// Times one round of all cases that still have rounds, and removes cases that fail.
    fn round(&mut self, number: u32, pairs: &mut Vec<TimedPair>) -> Result<(), RecordError> {
        for adapter in &mut self.adapters {
            adapter.supervisor.stop();
        }
        for index in 0..self.adapters.len() {
            if pairs
                .iter()
                .any(|p| p.adapter == index && p.rounds() <= number)
            {
                // If the start fails, the adapter's first case reports it.
                let _ = self.adapters[index].supervisor.worker();
            }
        }
        let mut kept = Vec::new();
        let mut before = ruler::measure();
        for mut pair in pairs.drain(..) {
            // The first round is always complete, so that every case has a round.
            let spent = number > 0 && self.adapters[pair.adapter].is_spent(self.limit);
            if number < pair.rounds() || spent {
                kept.push(pair);
                continue;
            }
            let clock = clock::measure();
            let began = Instant::now();
            let began_at = self.offset + self.start.elapsed().as_secs_f64();
            let case = &self.cases[pair.case];
            let adapter = &mut self.adapters[pair.adapter];
            let name = adapter.record.info.name.clone();
            let measured = match adapter.supervisor.worker() {
                Ok(worker) => worker.round(&case.scene, self.budget, self.timeout),
                Err(loss) => Err(RequestError::Lost(loss)),
            };
            adapter.spent += began.elapsed();
            let clock = clock.zip(clock::measure()).map(|(a, b)| [a, b]);
            let after = ruler::measure();
            let mut ended = match measured {
                Ok(measured) => {
                    let gpu: Vec<f64> = measured
                        .frames
                        .iter()
                        .filter_map(|f| f.gpu.filter(|t| !t.is_zero()).map(seconds))
                        .collect();
                    let all_timed = gpu.len() == measured.frames.len();
                    let line = Round {
                        case: case.id.clone(),
                        adapter: name.clone(),
                        round: number,
                        at: began_at,
                        ruler: [before, after],
                        prepare: measured.prepare,
                        first: measured.first,
                        warm_up: measured.warm_up,
                        wall: measured.frames.iter().map(|f| seconds(f.wall)).collect(),
                        cpu: measured.frames.iter().map(|f| seconds(f.cpu)).collect(),
                        gpu: if all_timed { gpu } else { Vec::new() },
                        clock,
                        read_back: measured.read_back,
                    };
                    self.writer.append(&BenchLine::Round(line.clone()))?;
                    pair.record.rounds.push(line);
                    (self.events)(BenchEvent::Timed {
                        case: case.id.clone(),
                        adapter: name.clone(),
                    });
                    // The order of atomics in shaders is not specified, so a pool can be filled differently
                    // each time.
                    let repeats = case.scene.pool.is_none();
                    (repeats && measured.picture != pair.picture)
                        .then(|| changed_picture(&adapter.record.limits))
                        .flatten()
                        .map(|reason| (number + 1, Verdict::Flaky, vec![reason]))
                }
                Err(failure) => {
                    let report = adapter.supervisor.report(failure);
                    Some((number, report.verdict, report.reasons()))
                }
            };
            before = after;
            let Some((had, verdict, reasons)) = ended.take() else {
                kept.push(pair);
                continue;
            };
            let ended = Ended {
                case: case.id.clone(),
                adapter: name,
                verdict,
                reasons,
            };
            self.writer.append(&BenchLine::Ended(ended.clone()))?;
            self.summary.unexpected += u64::from(verdict.is_bad());
            (self.events)(BenchEvent::Ended {
                ended,
                missing: self.rounds - had,
            });
        }
        *pairs = kept;
        Ok(())
    }
}

/// Returns true if the interval of a pair's value is narrow enough, relative to the value. The value is the
/// rate of its cell, or otherwise its wall time.
fn is_narrow(pair: &TimedPair, pairs: &[TimedPair], software: bool, share: f64) -> bool {
    if let Some(cell) = &pair.cell {
        let other = pairs.iter().find(|other| {
            let same = other.cell.as_ref() == Some(cell) && other.adapter == pair.adapter;
            same && other.case != pair.case
        });
        let rate = other.and_then(|other| CellRate::new(&pair.record, &other.record, software));
        return rate.is_some_and(|rate| rate.slope.is_within(share));
    }
    let mut medians: Vec<f64> = pair
        .record
        .samples(Time::Wall)
        .into_iter()
        .map(middle)
        .collect();
    medians.sort_unstable_by(f64::total_cmp);
    let both = quantile(&medians, 0.5).zip(median_interval(&medians));
    both.is_some_and(|(median, interval)| is_within(median, interval, share))
}

fn middle(times: &[f64]) -> f64 {
    let mut sorted = times.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    quantile(&sorted, 0.5).unwrap_or(f64::NAN)
}

/// Returns the record's reasons, and among them what a bench has no fields for.
fn reasons(mut record: Record) -> Vec<Reason> {
    let end = record.process.take();
    let end = end.map(|end| Reason::Process(Box::new(end)));
    let first = record.wrong.first().map(|wrong| Reason::FirstWrong {
        samples: record.texels.wrong + record.texels.imprecise,
        at: [wrong.x, wrong.y],
    });
    let reasons = end.into_iter().chain(record.reasons);
    reasons.chain(first).collect()
}
