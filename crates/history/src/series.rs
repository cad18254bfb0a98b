//! Series of frame times: one case on one adapter and one machine across runs.

use crate::error::HistoryError;
use crate::frame_times::FrameTimes;
use crate::history::History;
use crate::ids::{CaseNumber, MachineId, RunId};
use crate::packing::unpack_times;
use rusqlite::Row;
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

/// The subject of a series. Machines differ in speed, so each one has its own series.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SeriesKey {
    /// The case.
    pub case: CaseNumber,
    /// The timeline of the adapter.
    pub timeline: Rc<str>,
    /// The machine.
    pub machine: MachineId,
}

/// The frame times of a series in one run, with the ruler's.
#[derive(Clone, Debug, PartialEq)]
pub struct TimePoint {
    /// The run, which has the driver, the commit and the description of the ruler.
    pub run: RunId,
    /// The frame times of the run.
    pub times: FrameTimes,
}

impl History {
    /// Returns the subjects of all series, sorted.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn series_keys(&self) -> Result<Vec<SeriesKey>, HistoryError> {
        let wrong = HistoryError::database(self.path());
        let chains: HashMap<u32, (Rc<str>, MachineId)> = self
            .adapter_runs()
            .iter()
            .map(|a| (a.chain, (Rc::clone(&a.timeline), a.machine)))
            .collect();
        let mut statement = self
            .connection()
            .prepare_cached("SELECT DISTINCT test_case, chain FROM frame_time")
            .map_err(&wrong)?;
        let rows = statement
            .query_map([], |row| Ok((CaseNumber(row.get(0)?), row.get(1)?)))
            .map_err(&wrong)?;
        let mut keys = Vec::new();
        for row in rows {
            let (case, chain): (CaseNumber, u32) = row.map_err(&wrong)?;
            // An unknown chain was added after this history was opened.
            keys.extend(chains.get(&chain).map(|(timeline, machine)| SeriesKey {
                case,
                timeline: Rc::clone(timeline),
                machine: *machine,
            }));
        }
        keys.sort_unstable();
        Ok(keys)
    }

    /// Returns the points of a series by the times of their runs; empty for an unknown series. Skips runs
    /// that were resumed later.
    ///
    /// # Errors
    /// If the file cannot be read or is damaged.
    pub fn series(&self, key: &SeriesKey) -> Result<Vec<TimePoint>, HistoryError> {
        let of_key =
            |a: &&crate::runs::AdapterRun| a.timeline == key.timeline && a.machine == key.machine;
        let Some(chain) = self.adapter_runs().iter().find(of_key).map(|a| a.chain) else {
            return Ok(Vec::new());
        };
        let wrong = HistoryError::database(self.path());
        let mut statement = self
            .connection()
            .prepare_cached(
                "SELECT run, frames, wall, cpu, gpu, read_back, ruler, low_high FROM frame_time \
                 WHERE test_case = ?1 AND chain = ?2",
            )
            .map_err(&wrong)?;
        let rows = statement
            .query_map([key.case.0, chain], |row| {
                Ok((RunId(row.get(0)?), times(row)?))
            })
            .map_err(&wrong)?;
        let mut points = Vec::new();
        for row in rows {
            let (run, times) = row.map_err(&wrong)?;
            let Some(info) = self.run(run) else {
                continue;
            };
            if info.resumed.is_some() {
                continue;
            }
            let times = times.ok_or_else(|| {
                HistoryError::damaged(self.path(), format!("the times of run {run} do not unpack"))
            })?;
            points.push(TimePoint { run, times });
        }
        points.sort_by_key(|point| self.place(point.run));
        Ok(points)
    }

    /// Returns the points of [`series`](Self::series), split by the description of the ruler, because times
    /// with different rulers cannot be compared.
    ///
    /// # Errors
    /// If the file cannot be read or is damaged.
    pub fn series_by_ruler(
        &self,
        key: &SeriesKey,
    ) -> Result<BTreeMap<Option<&str>, Vec<TimePoint>>, HistoryError> {
        let mut parts: BTreeMap<_, Vec<_>> = BTreeMap::new();
        for point in self.series(key)? {
            let run = self.run(point.run);
            let ruler = run.and_then(|run| run.ruler.as_deref());
            parts.entry(ruler).or_default().push(point);
        }
        Ok(parts)
    }
}

/// Returns the times of a row; `None` if they do not unpack.
fn times(row: &Row<'_>) -> rusqlite::Result<Option<FrameTimes>> {
    let frames = row.get(1)?;
    let list = |column: usize| -> rusqlite::Result<Option<Vec<f32>>> {
        Ok(unpack_times(row.get_ref(column)?.as_blob()?))
    };
    let (wall, cpu, gpu) = (list(2)?, list(3)?, list(4)?);
    let (read_back, ruler, interval) = (list(5)?, list(6)?, list(7)?);
    let points = || {
        Some(FrameTimes {
            frames,
            wall: wall?,
            cpu: cpu?,
            gpu: gpu?,
            read_back: read_back?,
            ruler: ruler?,
            interval: match interval?[..] {
                [] => None,
                [low, high] => Some([low, high]),
                _ => return None,
            },
        })
    };
    Ok(points())
}
