//! The tables `records` and `frame_times` in Parquet.
//!
//! Each run of an adapter has its own file, so that only its records are in memory. The partitions `date` and
//! `adapter` are columns to readers of Hive partitions; `adapter` is the timeline.

use crate::error::ExportError;
use crate::folder::part;
use crate::table::{Column, ParquetTable};
use crate::written::ExportSize;
use etalon_frame::CaseId;
use etalon_history::{AdapterRun, History, RunId, RunInfo};
use etalon_record::{Machine, Time};
use parquet::data_type::ByteArray;
use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use std::rc::Rc;

/// The columns that both tables share, which describe a run of an adapter.
const SHARED: &str = "
    required binary run (UTF8);
    required int64 time;
    required binary kind (UTF8);
    required binary etalon (UTF8);
    required binary profile (UTF8);
    required binary commit (UTF8);
    required binary machine (UTF8);
    required binary labels (UTF8);
    required binary name (UTF8);
    required binary driver (UTF8);
    required binary version (UTF8);";

/// The number of texts among the shared columns.
const SHARED_TEXTS: usize = 10;

const RECORDS: &str = "
    required binary area (UTF8);
    required binary case (UTF8);
    required binary verdict (UTF8);
    required boolean expected;
    required boolean unexpected;
    required binary expectation (UTF8);
    required boolean inferred;
    optional double asserted_share;
    optional double rmse;
    optional double max_error;
    optional double flip;
    optional double wrong_share;";

const TIMES: &str = "
    required binary case (UTF8);
    required int64 frames;
    optional double wall;
    optional double cpu;
    optional double gpu;
    optional double read_back;
    optional double ruler;";

/// The number of rows in a row group of frame times.
const GROUP: usize = 65_536;

pub(crate) fn write(
    history: &History,
    runs: &HashSet<RunId>,
    dir: &Path,
) -> Result<ExportSize, ExportError> {
    let places: BTreeMap<Rc<str>, usize> = history.timelines().into_iter().zip(0..).collect();
    let folder = |timeline: &str| {
        let place = places.get(timeline).copied().unwrap_or(0);
        format!("adapter={}", part(timeline, place))
    };
    let mut written = ExportSize::default();
    for run in history.runs().iter().filter(|run| runs.contains(&run.id)) {
        let date = run.day();
        for adapter in history.adapters(run.id).iter().filter(|a| a.records > 0) {
            let path = dir
                .join("records")
                .join(format!("date={date}"))
                .join(folder(&adapter.timeline))
                .join(format!("{}.parquet", run.digest_text()));
            let mut table = ParquetTable::create(path, &schema("records", RECORDS))?;
            let (columns, rows) = records(history, run, adapter)?;
            table.add(&columns)?;
            table.close()?;
            written.files += 1;
            written.rows += rows;
        }
    }
    frame_times(history, runs, dir, &folder, &mut written)?;
    Ok(written)
}

fn schema(name: &str, columns: &str) -> String {
    format!("message {name} {{{SHARED}{columns}\n}}")
}

/// Returns the texts of the shared columns, each as one value.
fn shared(history: &History, run: &RunInfo, adapter: &AdapterRun) -> [ByteArray; SHARED_TEXTS] {
    let machine = history.machine(run.machine).map(machine_text);
    // A map of strings always serializes.
    let labels = serde_json::to_string(&run.labels).unwrap_or_default();
    [
        run.digest_text(),
        run.kind.name().to_owned(),
        run.etalon.clone(),
        run.profile.clone().unwrap_or_default(),
        run.commit.clone().unwrap_or_default(),
        machine.unwrap_or_default(),
        labels,
        adapter.adapter.info.name.clone(),
        adapter.adapter.info.driver.clone(),
        adapter.adapter.shown_version().to_owned(),
    ]
    .map(|text| text.into_bytes().into())
}

/// Returns a description of a machine.
pub(crate) fn machine_text(machine: &Machine) -> String {
    format!("{}, {}, {} cores", machine.os, machine.cpu, machine.cores)
}

fn records(
    history: &History,
    run: &RunInfo,
    adapter: &AdapterRun,
) -> Result<(Vec<Column>, u64), ExportError> {
    let rows = history.records(adapter)?;
    let n = rows.len();
    let (mut areas, mut cases, mut verdicts) = (Vec::new(), Vec::new(), Vec::new());
    let (mut expected, mut unexpected, mut inferred) = (Vec::new(), Vec::new(), Vec::new());
    let mut expectations = Vec::new();
    let mut numbers: [Vec<Option<f64>>; 5] = Default::default();
    for (case, outcome) in rows {
        let case = history.case_name(case)?;
        let outcome = history.outcome(outcome)?;
        areas.push(ByteArray::from(CaseId::new(&case).area()));
        cases.push(ByteArray::from(&*case));
        verdicts.push(ByteArray::from(outcome.verdict.to_string().as_str()));
        expected.push(outcome.expected.is_some());
        unexpected.push(outcome.unexpected());
        expectations.push(ByteArray::from(
            outcome.expected.as_deref().unwrap_or_default(),
        ));
        inferred.push(outcome.inferred);
        let method = outcome.measures.method.as_ref();
        let values = [
            outcome.asserted_share(),
            method.map(|m| f64::from(m.rmse)),
            method.map(|m| f64::from(m.max)),
            method.map(|m| f64::from(m.flip)),
            method.map(|m| f64::from(m.wrong)),
        ];
        for (column, value) in numbers.iter_mut().zip(values) {
            column.push(value);
        }
    }
    let mut columns = repeated(&shared(history, run, adapter), run.time(), n);
    columns.extend([areas, cases, verdicts].map(Column::Text));
    columns.extend([expected, unexpected].map(Column::Flag));
    columns.push(Column::Text(expectations));
    columns.push(Column::Flag(inferred));
    columns.extend(numbers.map(Column::Number));
    Ok((columns, n as u64))
}

/// Returns the shared columns for `n` rows of one run.
fn repeated(values: &[ByteArray; SHARED_TEXTS], time: i64, n: usize) -> Vec<Column> {
    let mut columns: Vec<Column> = values
        .iter()
        .map(|value| Column::Text(vec![value.clone(); n]))
        .collect();
    columns.insert(1, Column::Integer(vec![time; n]));
    columns
}

/// Rows of frame times that are not in a row group yet.
#[derive(Default)]
struct TimeRows {
    texts: [Vec<ByteArray>; SHARED_TEXTS],
    time: Vec<i64>,
    cases: Vec<ByteArray>,
    frames: Vec<i64>,
    numbers: [Vec<Option<f64>>; 5],
}

impl TimeRows {
    fn flush(&mut self, table: &mut ParquetTable) -> Result<(), ExportError> {
        let times = std::mem::take(self);
        let mut columns: Vec<Column> = times.texts.map(Column::Text).into();
        columns.insert(1, Column::Integer(times.time));
        columns.push(Column::Text(times.cases));
        columns.push(Column::Integer(times.frames));
        columns.extend(times.numbers.map(Column::Number));
        table.add(&columns)
    }
}

/// Writes the table of frame times, with one file per adapter, since a history returns times by series.
fn frame_times(
    history: &History,
    runs: &HashSet<RunId>,
    dir: &Path,
    folder: &impl Fn(&str) -> String,
    written: &mut ExportSize,
) -> Result<(), ExportError> {
    let mut keys = history.series_keys()?;
    // The sort is stable, so the cases of an adapter stay sorted.
    keys.sort_by(|a, b| a.timeline.cmp(&b.timeline));
    for of_adapter in keys.chunk_by(|a, b| a.timeline == b.timeline) {
        let mut table = None;
        let mut rows = TimeRows::default();
        for key in of_adapter {
            let case = history.case_name(key.case)?;
            for point in history
                .series(key)?
                .iter()
                .filter(|p| runs.contains(&p.run))
            {
                let adapter = history.adapter(point.run, &key.timeline);
                let (Some(run), Some(adapter)) = (history.run(point.run), adapter) else {
                    continue;
                };
                for (column, value) in rows.texts.iter_mut().zip(shared(history, run, adapter)) {
                    column.push(value);
                }
                rows.time.push(run.time());
                rows.cases.push(ByteArray::from(&*case));
                rows.frames.push(i64::from(point.times.frames));
                let values = [
                    point.times.median(Time::Wall),
                    point.times.median(Time::Cpu),
                    point.times.median(Time::Gpu),
                    point.times.median(Time::ReadBack),
                    point.times.ruler_median(),
                ];
                for (column, value) in rows.numbers.iter_mut().zip(values) {
                    column.push(value);
                }
                written.rows += 1;
                if table.is_none() {
                    let folder = dir.join("frame_times").join(folder(&key.timeline));
                    table = Some(ParquetTable::create(
                        folder.join("times.parquet"),
                        &schema("frame_times", TIMES),
                    )?);
                    written.files += 1;
                }
                if let Some(table) = table.as_mut()
                    && rows.time.len() >= GROUP
                {
                    rows.flush(table)?;
                }
            }
        }
        if let Some(mut table) = table {
            if !rows.time.is_empty() {
                rows.flush(&mut table)?;
            }
            table.close()?;
        }
    }
    Ok(())
}
