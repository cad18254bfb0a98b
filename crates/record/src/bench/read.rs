//! Reading a bench folder.

use super::counted::CountedInstructions;
use super::header::{BENCH_FORMAT, BenchHeader};
use super::line::{BenchLine, Done, Ended, Picture, Round};
use super::record::BenchRecord;
use crate::error::RecordError;
use crate::folder::BENCH_FILE;
use crate::json_lines::JsonLines;
use crate::paths::open_below;
use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

/// A recorded bench.
#[derive(Clone, Debug, PartialEq)]
pub struct Bench {
    /// The first line.
    pub header: BenchHeader,
    /// One record per case and adapter, in the order in which their pictures were judged.
    pub records: Vec<BenchRecord>,
    /// True if the last line was cut off, as a killed bench leaves it; the line is dropped.
    pub truncated: bool,
}

/// The remedy for a damaged line.
const REMEDY: &str = "remove the line, or record the bench again";

impl Bench {
    /// Reads `bench.jsonl` in a bench folder. A last line that is not whole JSON is dropped and
    /// noted; any other line must parse and fit the lines before it.
    ///
    /// # Errors
    /// If the folder holds no bench, if its format is unknown, or if a line is damaged or impossible: a
    /// time that is not above zero, a round of a picture that was not judged or is wrong, or an adapter
    /// that the header does not name.
    pub fn read(folder: &Path) -> Result<Self, RecordError> {
        Ok(Self::read_prefix(folder)?.0)
    }

    /// [`Bench::read`], with the number of bytes that the header and the whole lines take.
    pub(crate) fn read_prefix(folder: &Path) -> Result<(Self, u64), RecordError> {
        let path = folder.join(BENCH_FILE);
        let file = open_below(folder, BENCH_FILE).map_err(|e| match e {
            e if e.is_missing() => RecordError::NoBench {
                path: folder.to_owned(),
            },
            e => e,
        })?;
        Self::parse_prefix(&path, file)
    }

    /// Reads the lines of a `bench.jsonl` from any source. Errors name `path`.
    ///
    /// # Errors
    /// As [`Bench::read`].
    pub fn parse(path: &Path, text: impl Read) -> Result<Self, RecordError> {
        Ok(Self::parse_prefix(path, text)?.0)
    }

    fn parse_prefix(path: &Path, text: impl Read) -> Result<(Self, u64), RecordError> {
        let lines = JsonLines {
            path,
            format: BENCH_FORMAT,
            max_header: u64::MAX,
            max_line: u64::MAX,
            remedy: REMEDY,
        };
        let begin = |header| Assembly {
            header,
            records: Vec::new(),
            places: HashMap::new(),
        };
        let (assembly, extent) = lines.read(text, begin, Assembly::take)?;
        let bench = Self {
            header: assembly.header,
            records: assembly.records,
            truncated: extent.truncated,
        };
        Ok((bench, extent.bytes))
    }

    /// Returns the record of a case on an adapter.
    pub fn record(&self, case: &str, adapter: &str) -> Option<&BenchRecord> {
        let mut records = self.records.iter();
        records.find(|r| r.picture.case == case && r.picture.adapter == adapter)
    }

    /// Returns the number of rounds that this bench lacks to be complete. A case lacks none if its picture
    /// may not be timed, or if its rounds ended early.
    pub fn missing(&self) -> u64 {
        let rounds = u64::from(self.header.rounds);
        let pairs = self
            .header
            .cases
            .saturating_mul(self.header.adapters.len() as u64);
        let unseen = pairs.saturating_sub(self.records.len() as u64);
        let short = |r: &BenchRecord| {
            if r.is_open() {
                rounds.saturating_sub(r.rounds.len() as u64)
            } else {
                0
            }
        };
        let seen: u64 = self.records.iter().map(short).sum();
        unseen.saturating_mul(rounds).saturating_add(seen)
    }
}

/// The part of a bench read so far.
struct Assembly {
    header: BenchHeader,
    records: Vec<BenchRecord>,
    /// The index of each record by case and adapter.
    places: HashMap<(String, String), usize>,
}

impl Assembly {
    /// Adds a line, or returns why it cannot follow the lines before it.
    fn take(&mut self, line: BenchLine) -> Result<(), String> {
        match line {
            BenchLine::Picture(picture) => self.picture(picture),
            BenchLine::Counted(counted) => self.counted(counted),
            BenchLine::Round(round) => self.round(round),
            BenchLine::Ended(ended) => self.ended(ended),
            BenchLine::Done(done) => self.done(done),
        }
    }

    fn picture(&mut self, picture: Picture) -> Result<(), String> {
        if self.header.adapter(&picture.adapter).is_none() {
            let adapter = &picture.adapter;
            return Err(format!("the header names no adapter {adapter:?}"));
        }
        if !(0.0..=1.0).contains(&picture.asserted) {
            let share = picture.asserted;
            return Err(format!("the asserted share {share} is not in 0 to 1"));
        }
        let key = (picture.case.clone(), picture.adapter.clone());
        if self.places.insert(key, self.records.len()).is_some() {
            let (case, adapter) = (&picture.case, &picture.adapter);
            return Err(format!("a second picture of {case:?} on {adapter:?}"));
        }
        self.records.push(BenchRecord {
            picture,
            counted: None,
            rounds: Vec::new(),
            ended: None,
            enough: None,
        });
        Ok(())
    }

    /// Returns the record that a line belongs to.
    fn right(&mut self, case: &str, adapter: &str) -> Result<&mut BenchRecord, String> {
        let key = (case.to_owned(), adapter.to_owned());
        let place = self.places.get(&key).copied();
        let record = place.and_then(|place| self.records.get_mut(place));
        let record = record.ok_or_else(|| {
            format!("no picture of {case:?} on {adapter:?} was judged before this")
        })?;
        if !record.picture.may_be_timed() {
            let verdict = record.picture.verdict;
            return Err(format!(
                "{case:?} on {adapter:?} has the verdict {verdict} and so no frame times"
            ));
        }
        Ok(record)
    }

    /// Returns the record that a line belongs to, which must not have ended.
    fn open(&mut self, case: &str, adapter: &str) -> Result<&mut BenchRecord, String> {
        let record = self.right(case, adapter)?;
        if record.ended.is_some() || record.enough.is_some() {
            return Err(format!(
                "{case:?} on {adapter:?} already ended before this line"
            ));
        }
        Ok(record)
    }

    fn counted(&mut self, counted: CountedInstructions) -> Result<(), String> {
        if let Some(wrong) = counted.wrong() {
            return Err(wrong.to_owned());
        }
        let record = self.right(&counted.case, &counted.adapter)?;
        record.counted = Some(counted);
        Ok(())
    }

    fn round(&mut self, round: Round) -> Result<(), String> {
        check(&round)?;
        let record = self.open(&round.case, &round.adapter)?;
        let expected = record.rounds.len();
        if round.round as usize != expected {
            return Err(format!("round {} instead of round {expected}", round.round));
        }
        record.rounds.push(round);
        Ok(())
    }

    fn ended(&mut self, ended: Ended) -> Result<(), String> {
        let record = self.open(&ended.case, &ended.adapter)?;
        record.ended = Some(ended);
        Ok(())
    }

    fn done(&mut self, done: Done) -> Result<(), String> {
        let record = self.open(&done.case, &done.adapter)?;
        record.enough = Some(done.enough);
        Ok(())
    }
}

/// Checks that the numbers of a round are possible.
fn check(round: &Round) -> Result<(), String> {
    let frames = round.wall.len();
    if frames == 0 {
        return Err("a round without a sample".to_owned());
    }
    let as_many = |times: &[f64]| times.len() == frames;
    if !as_many(&round.cpu) || !(round.gpu.is_empty() || as_many(&round.gpu)) {
        return Err(format!(
            "{frames} wall times, {} cpu times and {} gpu times of the same frames",
            round.cpu.len(),
            round.gpu.len()
        ));
    }
    let fine = |t: &f64| t.is_finite() && *t > 0.0;
    let times = [&round.wall, &round.cpu, &round.gpu, &round.read_back];
    let single = [round.prepare, round.first];
    let mut seconds = times
        .into_iter()
        .flatten()
        .chain(&single)
        .chain(&round.ruler);
    if let Some(wrong) = seconds.find(|t| !fine(t)) {
        return Err(format!("a time of {wrong} s"));
    }
    if let Some(wrong) = round.clock.iter().flatten().find(|c| !fine(c)) {
        return Err(format!("a clock of {wrong} MHz"));
    }
    if !round.at.is_finite() || round.at < 0.0 {
        return Err(format!("a round that began at {} s", round.at));
    }
    Ok(())
}
