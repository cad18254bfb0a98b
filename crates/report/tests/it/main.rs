//! Reports made from recorded folders, read again by third-party parsers, by a browser, and by people:
//! printed reports are kept under `snapshots/`. To change them, run with `INSTA_UPDATE=always` and review the
//! difference.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod areas;
mod bench;
mod browser;
mod damage;
mod deqp;
mod formats;
mod history;
mod history_made;
mod markdown;
mod matrix;
mod printed;
mod report;
mod runs_diff;
mod runs_made;
mod site;
mod synthetic;
mod verdicts;
