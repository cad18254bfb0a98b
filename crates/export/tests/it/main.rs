//! Exports of a history, from outside: the files for other programs contain what was added.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod dashboard;
mod folder;
mod latest;
mod made;
mod openmetrics;
mod random;
mod selection;
mod tables;
