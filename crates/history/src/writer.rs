//! Adding runs to a history.
//!
//! For each adapter of a run, the full state is stored, once if several runs share it. Comparisons of two
//! runs read these states. In addition, each case whose outcome differs from the previously added run has a
//! row, from which the history of one case is read. Both follow the order in which runs were added, which
//! only grows at its end, not the order of their times: adding an old run late changes no other rows.

use crate::case_set::CaseSet;
use crate::connection::{PATIENCE, for_writing};
use crate::error::HistoryError;
use crate::frame_times::FrameTimes;
use crate::ids::RunId;
use crate::interning::{self, Interning};
use crate::new_run::{NewAdapter, NewRun};
use crate::outcome::Outcome;
use crate::packing::{pack_times, unpack};
use crate::triage::TriageEntry;
use etalon_frame::CaseId;
use rusqlite::{Connection, OptionalExtension, Transaction, TransactionBehavior, params};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A history to which runs are added.
#[derive(Debug)]
pub struct Writer {
    path: PathBuf,
    connection: Connection,
}

/// The number of a run, and whether it was added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Added {
    /// The run was added.
    New(RunId),
    /// The history already had the run, and is unchanged.
    Already(RunId),
}

impl Writer {
    /// Opens a history, and creates it if it does not exist. An older schema is migrated first.
    ///
    /// # Errors
    /// If the file is not a history, has a newer schema, or cannot be written to.
    pub fn open(path: &Path) -> Result<Self, HistoryError> {
        Self::open_with(path, PATIENCE)
    }

    /// Like [`Writer::open`], but waits for other processes for `patience` instead of a minute.
    ///
    /// # Errors
    /// As [`Writer::open`].
    pub fn open_with(path: &Path, patience: Duration) -> Result<Self, HistoryError> {
        Ok(Self {
            path: path.to_owned(),
            connection: for_writing(path, patience)?,
        })
    }

    /// Adds a run in one transaction, unless the history already has it.
    ///
    /// # Errors
    /// If the file is in use for too long, if the disk is full, or if the run has a timeline twice; the
    /// history is then unchanged.
    pub fn add(&mut self, run: &NewRun) -> Result<Added, HistoryError> {
        let mut timelines = HashSet::new();
        if let Some(twice) = run.adapters.iter().find(|a| !timelines.insert(&a.timeline)) {
            return Err(HistoryError::Twice {
                adapter: twice.timeline.clone(),
            });
        }
        let wrong = HistoryError::database(&self.path);
        let transaction = Transaction::new(&mut self.connection, TransactionBehavior::Immediate)
            .map_err(&wrong)?;
        let found = transaction
            .query_row(
                "SELECT id FROM run WHERE digest = ?1",
                [run.digest],
                |row| row.get(0),
            )
            .optional()
            .map_err(&wrong)?;
        if let Some(found) = found {
            return Ok(Added::Already(RunId(found)));
        }
        let id = Addition::new(&transaction).run(run).map_err(&wrong)?;
        transaction.commit().map_err(&wrong)?;
        Ok(Added::New(RunId(id)))
    }

    /// Returns the number of pages of the file.
    ///
    /// # Errors
    /// If the file cannot be read.
    #[doc(hidden)]
    pub fn pages(&self) -> Result<i64, HistoryError> {
        self.connection
            .query_row("PRAGMA page_count", [], |row| row.get(0))
            .map_err(HistoryError::database(&self.path))
    }

    /// Limits the file to this number of pages, to simulate a full disk.
    ///
    /// # Errors
    /// If the file cannot be read.
    #[doc(hidden)]
    pub fn limit_pages(&self, pages: i64) -> Result<(), HistoryError> {
        self.connection
            .query_row(&format!("PRAGMA max_page_count = {pages}"), [], |_| Ok(()))
            .map_err(HistoryError::database(&self.path))
    }

    /// Adds an entry to the triage log.
    ///
    /// # Errors
    /// If the file is in use for too long, or the disk is full.
    pub fn triage(&mut self, entry: &TriageEntry) -> Result<(), HistoryError> {
        let step = entry.subject.step;
        self.connection
            .execute(
                "INSERT INTO triage (at, author, test_case, timeline, machine, time, run, state, reason) \
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)",
                params![
                    entry.at,
                    entry.author,
                    entry.subject.case,
                    entry.subject.timeline,
                    step.map(|s| s.machine.0),
                    step.map(|s| s.time.name()),
                    step.map(|s| s.run.0),
                    entry.state.name(),
                    entry.reason
                ],
            )
            .map_err(HistoryError::database(&self.path))?;
        Ok(())
    }
}

/// A run that is being added.
struct Addition<'a> {
    connection: &'a Connection,
    interning: Interning,
}

impl<'a> Addition<'a> {
    fn new(connection: &'a Connection) -> Self {
        Self {
            connection,
            interning: Interning::default(),
        }
    }

    fn run(mut self, run: &NewRun) -> rusqlite::Result<u32> {
        let machine = interning::machine(self.connection, &run.machine)?;
        let labels = serde_json::to_string(&run.labels)
            .map_err(|e| rusqlite::Error::ToSqlConversionFailure(Box::new(e)))?;
        let id = self.connection.query_row(
            "INSERT INTO run (digest, header, kind, etalon, suite_commit, machine, started, released, profile, ruler, \
             missing, labels) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12) RETURNING id",
            params![
                run.digest,
                run.header,
                run.kind.name(),
                run.etalon,
                run.commit,
                machine,
                run.started,
                run.released,
                run.profile,
                run.ruler,
                i64::try_from(run.missing).unwrap_or(i64::MAX),
                labels
            ],
            |row| row.get(0),
        )?;
        for adapter in &run.adapters {
            let chain = interning::chain(self.connection, &adapter.timeline, machine)?;
            self.adapter(id, chain, adapter)?;
        }
        Ok(id)
    }

    fn adapter(&mut self, run: u32, chain: u32, new: &NewAdapter) -> rusqlite::Result<()> {
        let mut outcomes: Vec<(u32, u32)> = Vec::with_capacity(new.outcomes.len());
        for (case, outcome) in &new.outcomes {
            let case = self.interning.case(self.connection, case)?;
            let outcome = self.interning.outcome(self.connection, outcome)?;
            outcomes.push((case, outcome));
        }
        outcomes.sort_unstable();
        self.changes(run, chain, &outcomes)?;

        let set = CaseSet::new(outcomes.iter().map(|(case, _)| *case));
        let drawn = interning::drawn(self.connection, set.bytes())?;
        let numbers: Vec<u32> = outcomes.iter().map(|(_, outcome)| *outcome).collect();
        let (state, is_new) = interning::state(self.connection, drawn, &numbers)?;
        if is_new {
            self.tallies(state, &new.outcomes)?;
        }
        let adapter = interning::adapter(self.connection, &new.adapter)?;
        self.connection
            .prepare_cached(
                "INSERT INTO part (chain, run, adapter, drawn, state, records) VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
            )?
            .execute(params![chain, run, adapter, drawn, state, numbers.len() as i64])?;
        for (case, times) in &new.times {
            self.times(run, chain, case, times)?;
        }
        Ok(())
    }

    /// Inserts a row for each outcome that differs from the case's last one in the chain.
    fn changes(&self, run: u32, chain: u32, outcomes: &[(u32, u32)]) -> rusqlite::Result<()> {
        let before = self.last_state(chain)?;
        let mut last = self.connection.prepare_cached(
            "SELECT outcome FROM change WHERE test_case = ?1 AND chain = ?2 ORDER BY run DESC LIMIT 1",
        )?;
        let mut insert = self.connection.prepare_cached(
            "INSERT INTO change (test_case, chain, run, outcome) VALUES (?1, ?2, ?3, ?4)",
        )?;
        for (case, outcome) in outcomes {
            let known = match before.get(case) {
                Some(known) => Some(*known),
                None => last
                    .query_row([case, &chain], |row| row.get(0))
                    .optional()?,
            };
            if known != Some(*outcome) {
                insert.execute([case, &chain, &run, outcome])?;
            }
        }
        Ok(())
    }

    /// Returns the outcomes of the run that was last added to a chain. They are the last outcomes of their
    /// cases.
    fn last_state(&self, chain: u32) -> rusqlite::Result<HashMap<u32, u32>> {
        let row = self
            .connection
            .prepare_cached(
                "SELECT drawn.cases, part.records, state.outcomes FROM part JOIN state ON state.id = part.state \
                 JOIN drawn ON drawn.id = part.drawn WHERE part.chain = ?1 ORDER BY part.run DESC LIMIT 1",
            )?
            .query_row([chain], |row| {
                Ok((row.get(0)?, row.get::<_, u32>(1)?, row.get::<_, Vec<u8>>(2)?))
            })
            .optional()?;
        let Some((cases, records, packed)) = row else {
            return Ok(HashMap::new());
        };
        // Without it, each case's last row is looked up.
        let outcomes = unpack(&packed, records as usize).unwrap_or_default();
        Ok(CaseSet::from_bytes(cases).iter().zip(outcomes).collect())
    }

    fn tallies(&self, state: u32, outcomes: &BTreeMap<String, Outcome>) -> rusqlite::Result<()> {
        let mut counts: BTreeMap<(&str, &str, bool), u32> = BTreeMap::new();
        for (case, outcome) in outcomes {
            let key = (
                CaseId::new(case).area(),
                outcome.verdict.name(),
                outcome.unexpected(),
            );
            *counts.entry(key).or_default() += 1;
        }
        let mut insert = self.connection.prepare_cached(
            "INSERT INTO tally (state, area, verdict, unexpected, records) VALUES (?1, ?2, ?3, ?4, ?5)",
        )?;
        for ((area, verdict, unexpected), records) in counts {
            insert.execute(params![state, area, verdict, unexpected, records])?;
        }
        Ok(())
    }

    fn times(
        &mut self,
        run: u32,
        chain: u32,
        case: &str,
        times: &FrameTimes,
    ) -> rusqlite::Result<()> {
        let case = self.interning.case(self.connection, case)?;
        let interval = times.interval.as_ref().map_or(&[][..], |both| &both[..]);
        self.connection
            .prepare_cached(
                "INSERT INTO frame_time (test_case, chain, run, frames, wall, cpu, gpu, read_back, ruler, low_high) \
                 VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10)",
            )?
            .execute(params![
                case,
                chain,
                run,
                times.frames,
                pack_times(&times.wall),
                pack_times(&times.cpu),
                pack_times(&times.gpu),
                pack_times(&times.read_back),
                pack_times(&times.ruler),
                pack_times(interval)
            ])?;
        Ok(())
    }
}
