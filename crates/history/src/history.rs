//! Reading a history.
//!
//! The runs and their adapters are read when the file is opened, and everything else when it is needed.
//! Since rows are never changed, answers stay consistent while other processes add runs, which this history
//! does not see.

use crate::adapter::Adapter;
use crate::case_set::CaseSet;
use crate::connection::{PATIENCE, for_reading};
use crate::error::HistoryError;
use crate::ids::{CaseNumber, MachineId, OutcomeId, RunId};
use crate::kind::Kind;
use crate::outcome::Outcome;
use crate::packing::unpack;
use crate::rows::{OutcomeRow, adapter};
use crate::runs::{AdapterRun, Machines, RunInfo};
use etalon_record::Machine;
use rusqlite::{Connection, OptionalExtension};
use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// An open history.
#[derive(Debug)]
pub struct History {
    path: PathBuf,
    connection: Connection,
    /// Sorted by time; runs of equal time are in the order in which they were added.
    runs: Vec<RunInfo>,
    /// Indices into `runs`.
    places: HashMap<RunId, usize>,
    /// In the order of `runs`, then by timeline.
    adapter_runs: Vec<AdapterRun>,
    /// First index and end in `adapter_runs`, by index in `runs`.
    spans: Vec<[usize; 2]>,
    machines: Machines,
    cases: OnceCell<Cases>,
    outcomes: RefCell<HashMap<u32, Rc<Outcome>>>,
    drawn: RefCell<HashMap<u32, Rc<CaseSet>>>,
}

/// The names of all cases.
#[derive(Debug)]
struct Cases {
    names: Vec<Rc<str>>,
    ids: HashMap<Rc<str>, CaseNumber>,
}

impl History {
    /// Opens a history. An older schema is migrated first.
    ///
    /// # Errors
    /// If the file does not exist, is not a history, has a newer schema, or cannot be read.
    pub fn open_read(path: &Path) -> Result<Self, HistoryError> {
        let connection = for_reading(path, PATIENCE)?;
        let mut history = Self {
            path: path.to_owned(),
            connection,
            runs: Vec::new(),
            places: HashMap::new(),
            adapter_runs: Vec::new(),
            spans: Vec::new(),
            machines: Machines::new(),
            cases: OnceCell::new(),
            outcomes: RefCell::default(),
            drawn: RefCell::default(),
        };
        history.load()?;
        Ok(history)
    }

    fn load(&mut self) -> Result<(), HistoryError> {
        let wrong = HistoryError::database(&self.path);
        // Reads everything in one transaction, so that no run lacks its adapters.
        let reading = self.connection.unchecked_transaction().map_err(&wrong)?;
        let machines = machines(&reading).map_err(&wrong)?;
        let runs = runs(&reading, &self.path)?;
        let parts = adapter_runs(&reading).map_err(&wrong)?;
        reading.finish().map_err(&wrong)?;

        self.places = runs.iter().map(|r| r.id).zip(0..).collect();
        let place = |part: &AdapterRun| self.places.get(&part.run).copied();
        let mut parts = parts;
        parts.sort_by(|a, b| (place(a), &a.timeline).cmp(&(place(b), &b.timeline)));
        let mut from = 0;
        self.spans = runs
            .iter()
            .map(|run| {
                let of_run = parts[from..].iter().take_while(|p| p.run == run.id);
                let span = [from, from + of_run.count()];
                from = span[1];
                span
            })
            .collect();
        self.machines = machines;
        self.runs = runs;
        self.adapter_runs = parts;
        Ok(())
    }

    /// Returns the path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns all runs by time; runs of equal time are in the order in which they were added.
    pub fn runs(&self) -> &[RunInfo] {
        &self.runs
    }

    /// Returns the run with this number.
    pub fn run(&self, id: RunId) -> Option<&RunInfo> {
        self.runs.get(*self.places.get(&id)?)
    }

    /// Returns the index of a run in [`History::runs`].
    pub fn place(&self, id: RunId) -> Option<usize> {
        self.places.get(&id).copied()
    }

    /// Returns the machine with this number.
    pub fn machine(&self, id: MachineId) -> Option<&Machine> {
        self.machines.get(&id.0)
    }

    /// Returns the adapters of a run, by timeline; empty if there is no such run.
    pub fn adapters(&self, run: RunId) -> &[AdapterRun] {
        let span = self.place(run).and_then(|index| self.spans.get(index));
        span.map_or(&[], |[from, to]| &self.adapter_runs[*from..*to])
    }

    /// Returns the adapter of a timeline in a run.
    pub fn adapter(&self, run: RunId, timeline: &str) -> Option<&AdapterRun> {
        let mut adapters = self.adapters(run).iter();
        adapters.find(|part| *part.timeline == *timeline)
    }

    /// Returns the adapters of all runs, in the order of [`History::runs`].
    pub fn adapter_runs(&self) -> &[AdapterRun] {
        &self.adapter_runs
    }

    /// Returns the names of all timelines, sorted.
    pub fn timelines(&self) -> Vec<Rc<str>> {
        let mut timelines: Vec<Rc<str>> = self
            .adapter_runs
            .iter()
            .map(|a| Rc::clone(&a.timeline))
            .collect();
        timelines.sort_unstable();
        timelines.dedup();
        timelines
    }

    /// Returns the ids of all cases, in the order of their numbers, which begin at 1.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn cases(&self) -> Result<&[Rc<str>], HistoryError> {
        Ok(&self.all_cases()?.names)
    }

    /// Returns the number of a case; `None` if the history has no case with this id.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn case_id(&self, case: &str) -> Result<Option<CaseNumber>, HistoryError> {
        if let Some(cases) = self.cases.get() {
            return Ok(cases.ids.get(case).copied());
        }
        self.connection
            .prepare_cached("SELECT id FROM test_case WHERE name = ?1")
            .and_then(|mut find| find.query_row([case], |row| row.get(0)).optional())
            .map(|id| id.map(CaseNumber))
            .map_err(HistoryError::database(&self.path))
    }

    /// Returns the id of a case of this history.
    ///
    /// # Errors
    /// If the file cannot be read, or has no such case.
    pub fn case_name(&self, case: CaseNumber) -> Result<Rc<str>, HistoryError> {
        let index = (case.0 as usize).wrapping_sub(1);
        let name = self.all_cases()?.names.get(index).cloned();
        name.ok_or_else(|| HistoryError::damaged(&self.path, format!("no case {case}")))
    }

    fn all_cases(&self) -> Result<&Cases, HistoryError> {
        if let Some(cases) = self.cases.get() {
            return Ok(cases);
        }
        let wrong = HistoryError::database(&self.path);
        let mut statement = self
            .connection
            .prepare("SELECT id, name FROM test_case ORDER BY id")
            .map_err(&wrong)?;
        let rows = statement
            .query_map([], |row| Ok((row.get(0)?, row.get::<_, String>(1)?)))
            .map_err(&wrong)?;
        let mut cases = Cases {
            names: Vec::new(),
            ids: HashMap::new(),
        };
        for row in rows {
            let (id, name): (u32, String) = row.map_err(&wrong)?;
            let name: Rc<str> = name.into();
            cases.names.push(Rc::clone(&name));
            cases.ids.insert(name, CaseNumber(id));
            if id as usize != cases.names.len() {
                return Err(HistoryError::damaged(
                    &self.path,
                    format!("no case before {id}"),
                ));
            }
        }
        Ok(self.cases.get_or_init(|| cases))
    }

    /// Returns an outcome of this history.
    ///
    /// # Errors
    /// If the file cannot be read, or has no such outcome.
    pub fn outcome(&self, outcome: OutcomeId) -> Result<Rc<Outcome>, HistoryError> {
        if let Some(known) = self.outcomes.borrow().get(&outcome.0) {
            return Ok(Rc::clone(known));
        }
        let row = self
            .connection
            .prepare_cached(
                "SELECT verdict, expected, improves, due_fail, inferred, measures FROM outcome WHERE id = ?1",
            )
            .and_then(|mut find| find.query_row([outcome.0], OutcomeRow::new).optional())
            .map_err(HistoryError::database(&self.path))?;
        let row =
            row.ok_or_else(|| HistoryError::damaged(&self.path, format!("no outcome {outcome}")))?;
        let found = Rc::new(row.outcome(&self.path)?);
        self.outcomes
            .borrow_mut()
            .insert(outcome.0, Rc::clone(&found));
        Ok(found)
    }

    /// Returns all records of an adapter in a run, by the numbers of their cases.
    ///
    /// # Errors
    /// If the file cannot be read or is damaged.
    pub fn records(
        &self,
        adapter: &AdapterRun,
    ) -> Result<Vec<(CaseNumber, OutcomeId)>, HistoryError> {
        let packed: Vec<u8> = self
            .connection
            .prepare_cached("SELECT outcomes FROM state WHERE id = ?1")
            .and_then(|mut find| find.query_row([adapter.state], |row| row.get(0)))
            .map_err(HistoryError::database(&self.path))?;
        let outcomes = unpack(&packed, adapter.records as usize);
        let drawn = self.drawn(adapter.drawn)?;
        let cases: Vec<u32> = drawn.iter().collect();
        let known = self.all_cases()?.names.len();
        if let Some(case) = cases
            .iter()
            .find(|case| **case == 0 || **case as usize > known)
        {
            let message = format!("no case {case}");
            return Err(HistoryError::damaged(&self.path, message));
        }
        match outcomes {
            Some(outcomes) if outcomes.len() == cases.len() => Ok(cases
                .into_iter()
                .map(CaseNumber)
                .zip(outcomes.into_iter().map(OutcomeId))
                .collect()),
            _ => {
                let (run, name) = (adapter.run, &adapter.timeline);
                let message = format!("the records of {name} in run {run} do not unpack");
                Err(HistoryError::damaged(&self.path, message))
            }
        }
    }

    /// Returns true if an adapter has a record of this case in a run.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn has_record(&self, adapter: &AdapterRun, case: CaseNumber) -> Result<bool, HistoryError> {
        Ok(self.drawn(adapter.drawn)?.contains(case.0))
    }

    fn drawn(&self, id: u32) -> Result<Rc<CaseSet>, HistoryError> {
        if let Some(known) = self.drawn.borrow().get(&id) {
            return Ok(Rc::clone(known));
        }
        let bytes: Vec<u8> = self
            .connection
            .prepare_cached("SELECT cases FROM drawn WHERE id = ?1")
            .and_then(|mut find| find.query_row([id], |row| row.get(0)))
            .map_err(HistoryError::database(&self.path))?;
        let set = Rc::new(CaseSet::from_bytes(bytes));
        self.drawn.borrow_mut().insert(id, Rc::clone(&set));
        Ok(set)
    }

    pub(crate) fn connection(&self) -> &Connection {
        &self.connection
    }
}

fn machines(connection: &Connection) -> rusqlite::Result<Machines> {
    connection
        .prepare("SELECT id, os, cpu, cores FROM machine")?
        .query_map([], |row| {
            let machine = Machine {
                os: row.get(1)?,
                cpu: row.get(2)?,
                cores: row.get(3)?,
            };
            Ok((row.get(0)?, machine))
        })?
        .collect()
}

fn runs(connection: &Connection, path: &Path) -> Result<Vec<RunInfo>, HistoryError> {
    let wrong = HistoryError::database(path);
    let mut statement = connection
        .prepare(
            "SELECT id, digest, kind, etalon, suite_commit, machine, started, released, profile, ruler, missing, labels, \
             header FROM run ORDER BY id",
        )
        .map_err(&wrong)?;
    let rows = statement
        .query_map([], |row| {
            let run = RunInfo {
                id: RunId(row.get(0)?),
                digest: row.get(1)?,
                kind: Kind::Run,
                etalon: row.get(3)?,
                commit: row.get(4)?,
                machine: MachineId(row.get(5)?),
                started: row.get(6)?,
                released: row.get(7)?,
                profile: row.get(8)?,
                ruler: row.get(9)?,
                missing: row.get::<_, i64>(10)?.unsigned_abs(),
                labels: BTreeMap::new(),
                resumed: None,
            };
            let header: [u8; 32] = row.get(12)?;
            Ok((run, row.get(2)?, row.get(11)?, header))
        })
        .map_err(&wrong)?;
    let mut runs: Vec<RunInfo> = Vec::new();
    let mut headers: HashMap<[u8; 32], usize> = HashMap::new();
    for row in rows {
        let (mut run, kind, labels, header): (_, String, String, _) = row.map_err(&wrong)?;
        let damaged = |what: &str| HistoryError::damaged(path, format!("run {}: {what}", run.id));
        run.kind = Kind::of(&kind).ok_or_else(|| damaged("no such kind"))?;
        run.labels = serde_json::from_str(&labels).map_err(|_| damaged("labels"))?;
        if let Some(before) = headers.insert(header, runs.len()) {
            runs[before].resumed = Some(run.id);
        }
        runs.push(run);
    }
    runs.sort_by_key(|run| (run.time(), run.id));
    Ok(runs)
}

fn adapter_runs(connection: &Connection) -> rusqlite::Result<Vec<AdapterRun>> {
    let adapters: HashMap<u32, Rc<Adapter>> = connection
        .prepare(
            "SELECT id, name, backend, device, driver, driver_version, driver_id, api_version, software, line, version \
             FROM adapter",
        )?
        .query_map([], |row| Ok((row.get(0)?, Rc::new(adapter(row, 1)?))))?
        .collect::<rusqlite::Result<_>>()?;
    let chains: HashMap<u32, (Rc<str>, MachineId)> = connection
        .prepare("SELECT id, timeline, machine FROM chain")?
        .query_map([], |row| {
            let timeline: String = row.get(1)?;
            Ok((row.get(0)?, (timeline.into(), MachineId(row.get(2)?))))
        })?
        .collect::<rusqlite::Result<_>>()?;
    let missing = || rusqlite::Error::QueryReturnedNoRows;
    connection
        .prepare("SELECT chain, run, adapter, drawn, state, records FROM part")?
        .query_map([], |row| {
            let chain: u32 = row.get(0)?;
            let (timeline, machine) = chains.get(&chain).ok_or_else(missing)?;
            Ok(AdapterRun {
                run: RunId(row.get(1)?),
                timeline: Rc::clone(timeline),
                machine: *machine,
                adapter: adapters.get(&row.get(2)?).cloned().ok_or_else(missing)?,
                records: row.get(5)?,
                chain,
                state: row.get(4)?,
                drawn: row.get(3)?,
            })
        })?
        .collect()
}
