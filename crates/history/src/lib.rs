//! A history of runs in one SQLite file: the runs that were added, and how cases and frame times changed.
//!
//! [`read_runs`] reads what `etalon run`, `bench` and `bisect` wrote, and a [`Writer`] adds it. Nothing is
//! ever changed or removed, and adding the same run twice has no effect. A [`History`] reads: its
//! [runs](History::runs) with their [adapters](History::adapters), [one case](History::case_history) across
//! all runs, [counts](History::tallies) by area and verdict,
//! [series](History::series) of frame times with the ruler, and [every record](History::each_record). The
//! same file has a [log](TriageEntry) of what people say about changes.
//!
//! A **timeline** is one adapter across runs. It has the adapter's name, except that all releases that
//! `etalon bisect` drew are in the timeline of the name before the `@`.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod adapter;
mod case_history;
mod case_set;
mod connection;
mod dates;
mod digest;
mod error;
mod every_record;
mod frame_times;
mod history;
mod ids;
mod input;
mod interning;
mod kind;
mod new_run;
mod outcome;
mod packing;
mod rows;
mod runs;
mod schema;
mod series;
mod tally;
mod time;
mod triage;
mod triage_log;
mod writer;

pub use adapter::Adapter;
pub use case_history::{CaseHistory, RunPoint};
pub use dates::ReleaseDates;
pub use error::HistoryError;
pub use frame_times::FrameTimes;
pub use history::History;
pub use ids::{CaseNumber, MachineId, OutcomeId, RunId};
pub use input::read_runs;
pub use kind::Kind;
pub use new_run::{NewAdapter, NewRun};
pub use outcome::{Asserted, Measures, MethodMeasures, Outcome};
pub use runs::{AdapterRun, RunInfo};
pub use schema::SCHEMA;
pub use series::{SeriesKey, TimePoint};
pub use tally::Tally;
pub use time::{format_time, parse_time};
pub use triage::{TimeStep, TriageEntry, TriageState, TriageStates, TriageSubject};
pub use writer::{Added, Writer};
