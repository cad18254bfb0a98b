//! Frame times: pictures are judged first, then rounds of frames interleave over cases and adapters.
//!
//! Every round starts workers of its own, since where a process lies in memory moves its times by per
//! cents: measured in one process, that shift would look like a property of the driver. Within a round,
//! cases follow one another and each is timed on adapter after adapter, A B C, so that drift of the
//! machine hits all alike. All adapters' workers are up during a round, and one works at a time.

mod round;
mod ruler;

use crate::link::{Link, Patience};
use crate::loss::Loss;
use crate::process::{DRAW_TIMEOUT, Drawn, Launch, StartError, Worker};
use crate::run::adapter_record;
use crate::verdict::Judge;
use etalon_backend::BackendError;
use etalon_case::Case;
use etalon_frame::{Limits, WrongTexel};
use etalon_record::{
    AdapterRecord, BenchHeader, BenchLine, BenchWriter, Ended, Expectations, Picture, Record,
    RecordError, Round, Verdict,
};
use etalon_reference::Rules;
use etalon_scene::Invariance;
use round::{Stopped, fingerprint, seconds};
use std::path::Path;
use std::time::{Duration, Instant};
use thiserror::Error;

/// After so many vain starts in a row an adapter's other cases are not tried.
const MAX_VAIN_STARTS: u32 = 3;

/// What to time.
pub struct BenchPlan<'a> {
    /// The cases, each once.
    pub cases: &'a [Case],
    /// How to start each adapter, and the worker that is already up, which draws the pictures that are
    /// judged.
    pub adapters: Vec<(Launch, Worker)>,
    /// How long the timed frames of a case take together on an adapter in each round, about; warming up
    /// may take as long again.
    pub budget: Duration,
    /// What is known to go wrong.
    pub expectations: &'a Expectations,
    /// Where the bench is written.
    pub folder: &'a Path,
    /// Its first line; its rounds are those of the bench.
    pub header: BenchHeader,
}

/// What happens during a bench, as it happens.
#[derive(Clone, Debug)]
pub enum BenchEvent {
    /// A picture was judged.
    Judged {
        /// How.
        picture: Picture,
        /// Whether that speaks against the bench.
        unexpected: bool,
    },
    /// A case has a round more on an adapter.
    Timed {
        /// The case.
        case: String,
        /// The adapter.
        adapter: String,
    },
    /// A case has its last round on an adapter, before its time.
    Ended {
        /// Why.
        ended: Ended,
        /// How many rounds are missing.
        missing: u32,
    },
}

/// How a bench ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BenchOutcome {
    /// Pictures that were judged.
    pub pictures: u64,
    /// Pictures of which frames were timed.
    pub timed: u64,
    /// Bad verdicts: of pictures that are not selftests' and of rounds that broke.
    pub unexpected: u64,
}

/// Why a bench could not be completed.
#[derive(Debug, Error)]
pub enum BenchError {
    /// The bench folder cannot be begun; nothing was timed.
    #[error(transparent)]
    Folder(RecordError),
    /// The bench folder can no longer be written to; what was written is readable.
    #[error("the bench is incomplete: {0}")]
    Write(RecordError),
}

/// What the ruler of this version does: for [`BenchHeader::ruler`].
pub fn ruler() -> &'static str {
    ruler::RULER
}

/// Judges every case's picture on every adapter and times those that are right.
///
/// # Errors
/// When the bench folder cannot be written to.
pub fn bench(
    plan: BenchPlan<'_>,
    events: &mut dyn FnMut(BenchEvent),
) -> Result<BenchOutcome, BenchError> {
    let writer = BenchWriter::create(plan.folder, &plan.header).map_err(BenchError::Folder)?;
    let adapters = plan
        .adapters
        .into_iter()
        .map(|(launch, worker)| Adapter {
            record: adapter_record(&worker),
            launch,
            link: Some(worker.link),
            vain_starts: 0,
            last_words: String::new(),
        })
        .collect();
    let mut bench = Bench {
        cases: plan.cases,
        adapters,
        expectations: plan.expectations,
        writer,
        events,
        outcome: BenchOutcome::default(),
        start: Instant::now(),
        rounds: plan.header.rounds,
        budget: plan.budget,
    };
    let run = |bench: &mut Bench<'_, '_>| -> Result<(), RecordError> {
        let mut pairs = bench.judge()?;
        for number in 0..bench.rounds {
            bench.round(number, &mut pairs)?;
        }
        Ok(())
    };
    run(&mut bench).map_err(BenchError::Write)?;
    Ok(bench.outcome)
}

/// An adapter and its worker, where it has one.
struct Adapter {
    launch: Launch,
    record: AdapterRecord,
    link: Option<Link>,
    vain_starts: u32,
    last_words: String,
}

impl Adapter {
    /// The worker; a new one where there is none.
    fn link(&mut self) -> Option<&mut Link> {
        while self.link.is_none() && self.vain_starts < MAX_VAIN_STARTS {
            match Worker::start(&self.launch) {
                Ok(worker) => {
                    self.vain_starts = 0;
                    self.link = Some(worker.link);
                }
                Err(error) => {
                    self.vain_starts += 1;
                    self.last_words = restart_words(&error);
                }
            }
        }
        self.link.as_mut()
    }

    /// Takes note of how a worker stumbled: the verdict and the message.
    fn stumbled(&mut self, stopped: Stopped) -> (Verdict, String) {
        match stopped {
            Stopped::Backend(error) => {
                let broken = matches!(
                    error,
                    BackendError::DeviceLost(_) | BackendError::Internal(_)
                );
                if broken {
                    // After a panic, too, nobody knows in what state the worker is.
                    self.link = None;
                }
                (verdict(&error), error.to_string())
            }
            Stopped::Lost(loss) => {
                let verdict = loss.verdict();
                let message = match self.link.take() {
                    Some(mut link) => link.obituary(loss).message,
                    None => self.last_words.clone(),
                };
                (verdict, message)
            }
        }
    }
}

fn restart_words(error: &StartError) -> String {
    format!("the worker could not be started again: {error}")
}

fn verdict(error: &BackendError) -> Verdict {
    match error {
        BackendError::NotSupported(_) => Verdict::NotSupported,
        BackendError::DeviceLost(_) => Verdict::DeviceLost,
        BackendError::Resource { .. } => Verdict::ResourceError,
        BackendError::Shader { .. } | BackendError::Internal(_) => Verdict::InternalError,
    }
}

/// A case on an adapter whose picture is right: its numbers, and what its picture is told by.
struct Pair {
    case: usize,
    adapter: usize,
    picture: u64,
}

struct Bench<'a, 'e> {
    cases: &'a [Case],
    adapters: Vec<Adapter>,
    expectations: &'a Expectations,
    writer: BenchWriter,
    events: &'e mut dyn FnMut(BenchEvent),
    outcome: BenchOutcome,
    start: Instant,
    rounds: u32,
    budget: Duration,
}

impl Bench<'_, '_> {
    /// Judges all pictures; those that may be timed, in the order in which they will be.
    fn judge(&mut self) -> Result<Vec<Pair>, RecordError> {
        let judge = Judge::default();
        let mut pairs = Vec::new();
        for (number, case) in self.cases.iter().enumerate() {
            for index in 0..self.adapters.len() {
                let (mut record, picture) = self.draw(&judge, number, case, index);
                record.expect(self.expectations, &self.adapters[index].record);
                let channels: u64 = record.assertions.iter().map(|a| a.channels).sum();
                let asserted: u64 = record.assertions.iter().map(|a| a.asserted).sum();
                let judged = Picture {
                    case: case.id.clone(),
                    adapter: record.adapter.clone(),
                    verdict: record.verdict,
                    asserted: asserted as f64 / channels.max(1) as f64,
                    message: message(&record),
                };
                self.writer.append(&BenchLine::Picture(judged.clone()))?;
                self.outcome.pictures += 1;
                self.outcome.unexpected += u64::from(record.unexpected());
                if let Some(picture) = picture
                    && judged.may_be_timed()
                {
                    self.outcome.timed += 1;
                    pairs.push(Pair {
                        case: number,
                        adapter: index,
                        picture,
                    });
                }
                (self.events)(BenchEvent::Judged {
                    picture: judged,
                    unexpected: record.unexpected(),
                });
            }
        }
        Ok(pairs)
    }

    /// Draws a case once and judges it: the record, and the fingerprint of the picture.
    fn draw(
        &mut self,
        judge: &Judge,
        number: usize,
        case: &Case,
        index: usize,
    ) -> (Record, Option<u64>) {
        let adapter = &mut self.adapters[index];
        let limits: Limits = adapter.record.limits.clone();
        let name = adapter.record.name.clone();
        let failed = |verdict, message| {
            let mut record = Record::new(&case.id, &name, verdict);
            record.due_fail = case.judged_as.is_some();
            record.message = message;
            (record, None)
        };
        if let Some(missing) = limits.missing(&case.requirements()) {
            return failed(Verdict::NotSupported, missing.to_string());
        }
        let Some(link) = adapter.link() else {
            return failed(Verdict::Crash, adapter.last_words.clone());
        };
        let asked = Instant::now();
        for scene in case.scenes() {
            link.draw(0, scene);
        }
        let patience = Patience::of(DRAW_TIMEOUT);
        let drawing = link.drawn(0, case.scene_count(), asked, patience);
        let stopped = match drawing.drawn {
            Drawn::Frames(frames) => {
                let judged = judge.judge(number, case, &name, &limits, &frames);
                return (judged.record, frames.first().map(fingerprint));
            }
            Drawn::Error(error) => Stopped::Backend(error),
            Drawn::Lost(loss) => Stopped::Lost(loss),
        };
        let (verdict, message) = adapter.stumbled(stopped);
        failed(verdict, message)
    }

    /// One round of all cases that still have rounds; those that break are taken out.
    fn round(&mut self, number: u32, pairs: &mut Vec<Pair>) -> Result<(), RecordError> {
        for adapter in &mut self.adapters {
            adapter.link = None;
        }
        for index in 0..self.adapters.len() {
            if pairs.iter().any(|p| p.adapter == index) {
                self.adapters[index].link();
            }
        }
        let mut kept = Vec::new();
        let mut before = ruler::measure();
        for pair in pairs.drain(..) {
            let at = self.start.elapsed().as_secs_f64();
            let case = &self.cases[pair.case];
            let adapter = &mut self.adapters[pair.adapter];
            let name = adapter.record.name.clone();
            let measured = match adapter.link() {
                Some(link) => link.round(&case.scene, self.budget),
                None => Err(Stopped::Lost(Loss::Died)),
            };
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
                        at,
                        ruler: [before, after],
                        prepare: measured.prepare,
                        first: measured.first,
                        warm_up: measured.warm_up,
                        wall: measured.frames.iter().map(|f| seconds(f.wall)).collect(),
                        cpu: measured.frames.iter().map(|f| seconds(f.cpu)).collect(),
                        gpu: if all_timed { gpu } else { Vec::new() },
                        read_back: measured.read_back,
                    };
                    self.writer.append(&BenchLine::Round(line))?;
                    (self.events)(BenchEvent::Timed {
                        case: case.id.clone(),
                        adapter: name.clone(),
                    });
                    let api = adapter.record.limits.api;
                    (measured.picture != pair.picture)
                        .then(|| changed(api))
                        .flatten()
                        .map(|message| (number + 1, Verdict::Flaky, message))
                }
                Err(stopped) => {
                    let (verdict, message) = adapter.stumbled(stopped);
                    Some((number, verdict, message))
                }
            };
            before = after;
            let Some((had, verdict, message)) = ended.take() else {
                kept.push(pair);
                continue;
            };
            let ended = Ended {
                case: case.id.clone(),
                adapter: name,
                verdict,
                message,
            };
            self.writer.append(&BenchLine::Ended(ended.clone()))?;
            self.outcome.unexpected += u64::from(verdict.is_bad());
            (self.events)(BenchEvent::Ended {
                ended,
                missing: self.rounds - had,
            });
        }
        *pairs = kept;
        Ok(())
    }
}

/// What it means that a frame differs from the one that was judged; `None` where the API lets it.
fn changed(api: etalon_frame::Api) -> Option<String> {
    let promise = Rules::invariance(api, Invariance::Repeat);
    promise.value.map(|_| {
        format!(
            "the picture after a round is not the one that was judged: {}",
            promise.citation
        )
    })
}

/// What is wrong with a picture: the record's message, and where it is wrong first.
fn message(record: &Record) -> String {
    let first = record.wrong.first().map(|wrong: &WrongTexel| {
        let count = record.texels.wrong + record.texels.imprecise;
        format!("{count} samples, the first at ({}, {})", wrong.x, wrong.y)
    });
    match (first, record.message.as_str()) {
        (Some(first), "") => first,
        (Some(first), message) => format!("{message}; {first}"),
        (None, message) => message.to_owned(),
    }
}
